/* sample_light: chooses a point on a light for every vertex that scatters light. */
#include "lib/stage.h"

#include "lib/dimensions.h"
#include "lib/material.h"
#include "lib/state.h"
#include "light/environment.h"
#include "light/punctual.h"
#include "light/select.h"

/* What an emissive triangle emits at these barycentrics; holes emit nothing. */
CDL_INLINE vec3 triangle_radiance(CDL_GLOBAL const cdl_Light *light, float b1, float b2,
                                  CDL_GLOBAL const cdl_Triangle *triangles,
                                  CDL_GLOBAL const cdl_Shape *shapes,
                                  CDL_GLOBAL const float *attributes,
                                  CDL_GLOBAL const cdl_Material *materials, CDL_TEXTURE_ARGS) {
#if defined(CDL_EMISSION_TEXTURES) || defined(CDL_PASSABLE)
  int is_triangle = light->type == CDL_LIGHT_TRIANGLE;
  CDL_GLOBAL const cdl_Triangle *triangle = triangles + (is_triangle ? light->triangle : 0u);
  CDL_GLOBAL const cdl_Material *material = materials + (is_triangle ? light->material : 0u);
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangle->shape;
  TextureCoords uv = shape_texture_coords(shape, attributes, triangle, b1, b2);
  vec3 radiance = material_emission(material, uv, textures, texels, srgb);
  Texel base =
      material_base(material, shape, attributes, triangle, b1, b2, uv, textures, texels, srgb);
  return v3_scale(radiance, material_opacity(material, base.a));
#else
  return light_vec3(light->radiance);
#endif
}

__kernel void
sample_light(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
             CDL_GLOBAL const cdl_Light *lights, CDL_GLOBAL const cdl_AliasEntry *light_table,
             CDL_GLOBAL const float *environment,
             CDL_GLOBAL const cdl_AliasEntry *environment_cells,
             CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
             CDL_GLOBAL const float *attributes, CDL_GLOBAL const cdl_Material *materials,
             CDL_GLOBAL const cdl_Texture *textures, CDL_GLOBAL const uint *texels,
             CDL_GLOBAL const float *srgb, CDL_GLOBAL const uint *path, CDL_GLOBAL uint *work) {
  CDL_FOR_EACH_ITEM(i) {
    size_t stride = wave->stride;
    vec3 position = state_vec3(work, CDL_WORK_POSITION, stride, i);
    PathRandom random = path_random(params, wave, state_uint(path, CDL_PATH_SLOT, stride, i));
    uint vertex = counts_vertex(state_uint(path, CDL_PATH_COUNTS, stride, i));
    uint slot_bits, keep_bits, u_bits, v_bits;
    vertex_random_bits(random, vertex, CDL_PAIR_SELECT, &slot_bits, &keep_bits);
    vertex_random_bits(random, vertex, CDL_PAIR_LIGHT, &u_bits, &v_bits);
    float u = rng_to_unit(u_bits);
    float v = rng_to_unit(v_bits);
    uint chosen = alias_pick(light_table, params->light_count, slot_bits, rng_to_unit(keep_bits));
    CDL_GLOBAL const cdl_Light *light = lights + chosen;
    uint type = light->type;

    LightSample sample = light_sample_make(v3(0.0f, 0.0f, 1.0f), CDL_INFINITY, v3_all(0.0f), 0.0f);
#ifdef CDL_TRIANGLE_LIGHTS
    float b1, b2;
    sample_triangle(u, v, &b1, &b2);
    vec3 radiance = triangle_radiance(light, b1, b2, triangles, shapes, attributes, materials,
                                      textures, texels, srgb);
    LightSample on_triangle = light_triangle_sample(light, position, b1, b2, radiance);
    sample = light_sample_select(type == CDL_LIGHT_TRIANGLE, on_triangle, sample);
#endif
#ifdef CDL_PUNCTUAL_LIGHTS
    sample =
        light_sample_select(type == CDL_LIGHT_POINT, light_point_sample(light, position), sample);
    sample =
        light_sample_select(type == CDL_LIGHT_DIRECTIONAL, light_directional_sample(light), sample);
#endif
#ifdef CDL_ENVIRONMENT_LIGHT
    float s, t;
    vertex_random(random, vertex, CDL_PAIR_TEXEL, &s, &t);
    LightSample sky =
        environment_sample(&params->environment, environment, environment_cells, u_bits, v, s, t);
    sample = light_sample_select(type == CDL_LIGHT_ENVIRONMENT, sky, sample);
#endif
    state_set_vec3(work, CDL_WORK_LIGHT_DIRECTION, stride, i, sample.direction);
    state_set_float(work, CDL_WORK_LIGHT_DISTANCE, stride, i, sample.distance);
    state_set_vec3(work, CDL_WORK_LIGHT_WEIGHT, stride, i, sample.weight);
    state_set_float(work, CDL_WORK_LIGHT_PDF, stride, i, sample.pdf);
  }
}
