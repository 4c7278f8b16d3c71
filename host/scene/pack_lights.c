#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/angle.h"
#include "core/log.h"
#include "scene/alias.h"
#include "scene/pack_parts.h"

#define CDL_TEXTURES
#define CDL_EMISSION_TEXTURES
#define CDL_FLOAT_TEXTURES
#define CDL_VERTEX_COLORS
#include "lib/color.h"
#include "lib/material.h"

/* Points a side at which a textured triangle's emission is looked up to guess its power. */
enum { POWER_POINTS = 5 };

static double luminance(const float c[3]) { return color_luminance(v3(c[0], c[1], c[2])); }

static vec3 world_point(const float to_world[12], const float *p) {
  float out[3];
  pack_point(to_world, p, out);
  return v3(out[0], out[1], out[2]);
}

/* Mean luminance over the triangle. A guess will do: what it misses is found by hitting it. */
static double triangle_luminance(const cdl_Pack *pack, const cdl_Shape *shape,
                                 const cdl_Triangle *triangle) {
  const cdl_Material *material = &pack->materials[shape->material];
  if (material->emission_texture.texture == CDL_NONE) return luminance(material->emission);
  double sum = 0.0;
  int points = 0;
  for (int j = 0; j < POWER_POINTS; j++)
    for (int i = 0; i + j < POWER_POINTS; i++, points++) {
      float u = ((float)i + 1.0f / 3.0f) / POWER_POINTS,
            v = ((float)j + 1.0f / 3.0f) / POWER_POINTS;
      TextureCoords uv = shape_texture_coords(shape, pack->attributes, triangle, u, v);
      vec3 e = material_emission(material, uv, pack->textures, pack->texels, pack->srgb);
      sum += color_luminance(e);
    }
  return sum / points;
}

static void set_vec(float out[3], vec3 v) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

/* The light of one triangle of an instance, and its power. */
static double pack_triangle_light(const cdl_Pack *pack, const float to_world[12], uint32_t number,
                                  cdl_Light *light) {
  const cdl_Triangle *triangle = &pack->triangles[number];
  const cdl_Shape *shape = &pack->shapes[triangle->shape];
  const cdl_Material *material = &pack->materials[shape->material];
  const float *p = pack->attributes + shape->positions;
  vec3 corner[3];
  for (int i = 0; i < 3; i++)
    corner[i] = world_point(to_world, p + 3 * (size_t)triangle->corner[i]);
  vec3 e1 = v3_sub(corner[1], corner[0]);
  vec3 e2 = v3_sub(corner[2], corner[0]);
  int double_sided = (material->flags & CDL_MATERIAL_DOUBLE_SIDED) != 0;
  memset(light, 0, sizeof *light);
  light->type = CDL_LIGHT_TRIANGLE;
  light->triangle = number;
  light->material = shape->material;
  light->flags = (double_sided ? CDL_LIGHT_DOUBLE_SIDED : 0u) |
                 (pack_mirrors(to_world) ? CDL_LIGHT_MIRRORED : 0u);
  light->area = 0.5f * v3_length(v3_cross(e1, e2));
  set_vec(light->p, corner[0]);
  set_vec(light->e1, e1);
  set_vec(light->e2, e2);
  memcpy(light->radiance, material->emission, sizeof light->radiance);
  double power =
      (double_sided ? 2.0 : 1.0) * M_PI * light->area * triangle_luminance(pack, shape, triangle);
  return isfinite(power) ? power : 0.0;
}

static uint32_t shape_triangles(const cdl_Pack *pack, size_t shape) {
  size_t end =
      shape + 1 < pack->shape_count ? pack->shapes[shape + 1].first_triangle : pack->triangle_count;
  return (uint32_t)(end - pack->shapes[shape].first_triangle);
}

static void pack_shape_lights(cdl_Pack *pack, size_t shape, const float to_world[12],
                              uint32_t first_light, double *power) {
  uint32_t first = pack->shapes[shape].first_triangle, count = shape_triangles(pack, shape);
  for (uint32_t i = 0; i < count; i++)
    power[first_light + i] =
        pack_triangle_light(pack, to_world, first + i, &pack->lights[first_light + i]);
}

static void pack_triangle_lights(cdl_Pack *pack, double *power) {
  const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (size_t i = 0; i < pack->shape_count; i++)
    if (pack->shapes[i].first_light != CDL_NONE)
      pack_shape_lights(pack, i, identity, pack->shapes[i].first_light, power);
  for (uint32_t i = 0; i < pack->bvh.instance_count; i++) {
    const cdl_BvhInstance *instance = &pack->bvh.instances[i];
    if (instance->first_light != CDL_NONE)
      pack_shape_lights(pack, pack->mesh_shapes[instance->mesh], instance->to_world,
                        instance->first_light, power);
  }
}

/* The spot's formula in KHR_lights_punctual: cos scale + offset, clamped, squared. The difference
 * of the cosines is 2 sin sin, as they cancel where cones are narrow or alike. */
static void set_cone(const cdl_SceneLight *from, cdl_Light *to) {
  to->cone_scale = 0.0f;
  to->cone_offset = 1.0f;
  if (from->type != CDL_PUNCTUAL_SPOT) return;
  double inner = from->inner_cone, outer = from->outer_cone;
  double difference = 2.0 * angle_sin((outer + inner) / 2) * angle_sin((outer - inner) / 2);
  double scale = 1.0 / fmax(0.001, difference);
  to->cone_scale = (float)scale;
  to->cone_offset = (float)((angle_versine(outer) - 1.0) * scale);
}

static double pack_punctual_light(const cdl_SceneLight *from, double radius, cdl_Light *to) {
  memset(to, 0, sizeof *to);
  to->type = from->type == CDL_PUNCTUAL_DIRECTIONAL ? CDL_LIGHT_DIRECTIONAL : CDL_LIGHT_POINT;
  to->triangle = to->material = CDL_NONE;
  memcpy(to->p, from->position, sizeof to->p);
  memcpy(to->e1, from->direction, sizeof to->e1);
  memcpy(to->radiance, from->intensity, sizeof to->radiance);
  to->range = from->range;
  set_cone(from, to);
  double solid_angle = 4.0 * M_PI;
  if (from->type == CDL_PUNCTUAL_SPOT)
    solid_angle = M_PI * (angle_versine(from->inner_cone) + angle_versine(from->outer_cone));
  if (from->type == CDL_PUNCTUAL_DIRECTIONAL) solid_angle = M_PI * radius * radius;
  return solid_angle * luminance(from->intensity);
}

static cdl_Status build_table(const cdl_Log *log, const double *power, cdl_Pack *pack) {
  pack->light_table = pack_array(log, "lights", pack->light_count, sizeof *pack->light_table);
  if (!pack->light_table) return CDL_BAD_INPUT;
  if (!pack->light_count) return CDL_OK;
  cdl_Status status = alias_build(log, power, pack->light_count, pack->light_table);
  for (size_t i = 0; i < pack->light_count; i++)
    pack->lights[i].select_pdf = pack->light_table[i].pdf;
  return status;
}

/* Triangles first, as pack_geometry() numbered them, then punctual lights, then the environment. */
cdl_Status pack_lights(const cdl_Log *log, const cdl_Scene *scene, double environment_power,
                       cdl_Pack *pack) {
  size_t triangles = pack->light_count;
  size_t count = triangles + scene->light_count + (environment_power > 0.0);
  double *power = pack_array(log, "lights", count, sizeof *power);
  pack->lights = pack_array(log, "lights", count, sizeof *pack->lights);
  cdl_Status status = power && pack->lights ? CDL_OK : CDL_BAD_INPUT;
  if (status) goto done;
  pack_triangle_lights(pack, power);
  double radius = pack_scene_radius(pack);
  for (uint32_t i = 0; i < scene->light_count; i++)
    power[triangles + i] =
        pack_punctual_light(&scene->lights[i], radius, &pack->lights[triangles + i]);
  pack->features.punctual_lights = scene->light_count > 0;
  if (environment_power > 0.0) {
    pack->lights[count - 1].type = CDL_LIGHT_ENVIRONMENT;
    power[count - 1] = environment_power;
  }
  pack->light_count = count;
  status = build_table(log, power, pack);
  if (environment_power > 0.0)
    pack->environment_params.select_pdf = pack->lights[count - 1].select_pdf;
done:
  free(power);
  return status;
}
