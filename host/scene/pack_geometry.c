#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/pack_parts.h"

/* The two trees of what stands in the scene once. */
enum { BAKED_OPAQUE, BAKED_PASSABLE, BAKED_COUNT };

/* Everything that lasts only while geometry is packed. */
typedef struct Geometry {
  const cdl_Log *log;
  const cdl_Scene *scene;
  cdl_Pack *pack;
  uint32_t *uses;        /* per mesh: instances of it */
  uint32_t *mesh_number; /* per mesh: of its tree, CDL_NONE while it has none */
  cdl_BvhPart *parts;    /* per shape */
  uint32_t **indices;    /* per shape: indices turned around, or NULL */
  cdl_BvhMesh *meshes;
  cdl_BvhPlacement *placements;
  cdl_BvhPart *baked[BAKED_COUNT];
  uint32_t baked_count[BAKED_COUNT];
  uint32_t mesh_count, placement_count;
} Geometry;

static int material_passable(const cdl_Material *m) {
  return m->model == CDL_MODEL_INTERFACE ||
         (m->flags & (CDL_MATERIAL_MASK | CDL_MATERIAL_BLEND)) != 0;
}

static void normalize(float v[3]) {
  double l = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
  for (int i = 0; i < 3; i++) v[i] = l > 0.0 ? (float)(v[i] / l) : 0.0f;
}

static void bake_direction(const float m[12], const float *d, float *out) {
  for (int r = 0; r < 3; r++)
    out[r] = (float)((double)m[4 * r] * d[0] + (double)m[4 * r + 1] * d[1] +
                     (double)m[4 * r + 2] * d[2]);
  normalize(out);
}

/* Normals turn by the cofactors of the matrix, which are its inverse transpose times its
 * determinant; the sign of that is taken out again. */
static void bake_normal(const float m[12], const float *n, float *out) {
  double sign = pack_mirrors(m) ? -1.0 : 1.0;
  for (int r = 0; r < 3; r++) {
    const float *a = m + 4 * ((r + 1) % 3), *b = m + 4 * ((r + 2) % 3);
    double x = (double)a[1] * b[2] - (double)a[2] * b[1];
    double y = (double)a[2] * b[0] - (double)a[0] * b[2];
    double z = (double)a[0] * b[1] - (double)a[1] * b[0];
    out[r] = (float)(sign * (x * n[0] + y * n[1] + z * n[2]));
  }
  normalize(out);
}

/* Appends `width` floats a vertex; CDL_NONE where the mesh has none. */
static uint32_t append(Geometry *g, const cdl_SceneMesh *mesh, const float *from, uint32_t width) {
  if (!from) return CDL_NONE;
  size_t at = g->pack->attribute_count, count = (size_t)mesh->vertex_count * width;
  memcpy(g->pack->attributes + at, from, count * sizeof *from);
  g->pack->attribute_count += count;
  return (uint32_t)at;
}

static void bake_attributes(const cdl_SceneMesh *mesh, const float m[12], const cdl_Shape *shape,
                            float *attributes) {
  float mirror = pack_mirrors(m) ? -1.0f : 1.0f;
  for (uint32_t i = 0; i < mesh->vertex_count; i++) {
    pack_point(m, mesh->positions + 3 * (size_t)i, attributes + shape->positions + 3 * (size_t)i);
    if (mesh->normals)
      bake_normal(m, mesh->normals + 3 * (size_t)i, attributes + shape->normals + 3 * (size_t)i);
    if (!mesh->tangents) continue;
    float *tangent = attributes + shape->tangents + 4 * (size_t)i;
    bake_direction(m, mesh->tangents + 4 * (size_t)i, tangent);
    tangent[3] *= mirror;
  }
}

/* Mirroring turns triangles around; their corners are swapped so that the front stays the front. */
static cdl_Status turn_triangles(Geometry *g, const cdl_SceneMesh *mesh, uint32_t shape) {
  size_t count = 3 * (size_t)mesh->triangle_count;
  uint32_t *turned = pack_array(g->log, "indices", count, sizeof *turned);
  if (!turned) return CDL_BAD_INPUT;
  for (size_t i = 0; i < count; i += 3) {
    turned[i] = mesh->indices[i];
    turned[i + 1] = mesh->indices[i + 2];
    turned[i + 2] = mesh->indices[i + 1];
  }
  g->indices[shape] = turned;
  return CDL_OK;
}

/* Appends a shape; `to_world` bakes it, NULL leaves it in its own space. */
static cdl_Status add_shape(Geometry *g, const cdl_SceneMesh *mesh, const float *to_world,
                            uint32_t object) {
  cdl_Pack *pack = g->pack;
  uint32_t index = (uint32_t)pack->shape_count++;
  cdl_Shape *shape = &pack->shapes[index];
  shape->material = mesh->material;
  shape->object = object;
  shape->first_triangle = (uint32_t)pack->triangle_count;
  shape->first_light = CDL_NONE;
  shape->positions = append(g, mesh, mesh->positions, 3);
  shape->normals = append(g, mesh, mesh->normals, 3);
  shape->tangents = append(g, mesh, mesh->tangents, 4);
  for (int i = 0; i < 2; i++) shape->uv[i] = append(g, mesh, mesh->uv[i], 2);
  shape->colors = append(g, mesh, mesh->colors, 4);
  pack->features.vertex_colors |= mesh->colors != NULL;
  if (to_world) bake_attributes(mesh, to_world, shape, pack->attributes);
  if (to_world && pack_mirrors(to_world) && turn_triangles(g, mesh, index)) return CDL_BAD_INPUT;

  const uint32_t *indices = g->indices[index] ? g->indices[index] : mesh->indices;
  for (uint32_t i = 0; i < mesh->triangle_count; i++) {
    cdl_Triangle *triangle = &pack->triangles[pack->triangle_count++];
    memcpy(triangle->corner, indices + 3 * (size_t)i, sizeof triangle->corner);
    triangle->shape = index;
  }
  g->parts[index] = (cdl_BvhPart){.positions = pack->attributes + shape->positions,
                                  .indices = indices,
                                  .triangle_count = mesh->triangle_count,
                                  .first_primitive = shape->first_triangle};
  return CDL_OK;
}

/* Notes what the kernels will meet; emissive shapes get a light a triangle, per instance. */
static void note_instance(Geometry *g, const cdl_SceneMesh *mesh, uint32_t *first_light) {
  const cdl_Material *material = &g->pack->materials[mesh->material];
  cdl_PackFeatures *features = &g->pack->features;
  int emissive = (material->flags & CDL_MATERIAL_EMISSIVE) != 0;
  features->models[material->model] |= emissive ? 3 : 1;
  features->passable |= material_passable(material);
  features->opacity |= material_passable(material) && material->model != CDL_MODEL_INTERFACE;
  *first_light = CDL_NONE;
  if (!emissive) return;
  *first_light = (uint32_t)g->pack->light_count;
  g->pack->light_count += mesh->triangle_count;
  features->triangle_lights = 1;
}

static cdl_Status bake_instance(Geometry *g, const cdl_SceneInstance *instance) {
  const cdl_SceneMesh *mesh = &g->scene->meshes[instance->mesh];
  uint32_t index = (uint32_t)g->pack->shape_count, first_light;
  if (add_shape(g, mesh, instance->to_world, instance->object)) return CDL_BAD_INPUT;
  note_instance(g, mesh, &first_light);
  g->pack->shapes[index].first_light = first_light;
  int group =
      material_passable(&g->pack->materials[mesh->material]) ? BAKED_PASSABLE : BAKED_OPAQUE;
  g->baked[group][g->baked_count[group]++] = g->parts[index];
  return CDL_OK;
}

static cdl_Status place_instance(Geometry *g, const cdl_SceneInstance *instance) {
  const cdl_SceneMesh *mesh = &g->scene->meshes[instance->mesh];
  if (g->mesh_number[instance->mesh] == CDL_NONE) {
    uint32_t shape = (uint32_t)g->pack->shape_count;
    if (add_shape(g, mesh, NULL, CDL_NONE)) return CDL_BAD_INPUT;
    g->mesh_number[instance->mesh] = g->mesh_count;
    g->pack->mesh_shapes[g->mesh_count] = shape;
    g->meshes[g->mesh_count++] = (cdl_BvhMesh){&g->parts[shape], 1};
  }
  cdl_BvhPlacement *placement = &g->placements[g->placement_count++];
  placement->mesh = g->mesh_number[instance->mesh];
  memcpy(placement->to_world, instance->to_world, sizeof placement->to_world);
  placement->mask =
      material_passable(&g->pack->materials[mesh->material]) ? CDL_MASK_PASSABLE : CDL_MASK_OPAQUE;
  placement->object = instance->object;
  note_instance(g, mesh, &placement->first_light);
  return CDL_OK;
}

/* The baked meshes come last, where they hold anything. */
static void place_baked(Geometry *g) {
  const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (int group = 0; group < BAKED_COUNT; group++) {
    if (!g->baked_count[group]) continue;
    cdl_BvhPlacement *placement = &g->placements[g->placement_count++];
    g->meshes[g->mesh_count] = (cdl_BvhMesh){g->baked[group], g->baked_count[group]};
    placement->mesh = g->mesh_count++;
    memcpy(placement->to_world, identity, sizeof identity);
    placement->mask = group == BAKED_PASSABLE ? CDL_MASK_PASSABLE : CDL_MASK_OPAQUE;
    placement->object = CDL_NONE;
    placement->first_light = CDL_NONE;
  }
}

static size_t mesh_floats(const cdl_SceneMesh *mesh) {
  size_t width = 3 + (mesh->normals ? 3 : 0) + (mesh->tangents ? 4 : 0) + (mesh->uv[0] ? 2 : 0) +
                 (mesh->uv[1] ? 2 : 0) + (mesh->colors ? 4 : 0);
  return width * mesh->vertex_count;
}

/* Makes room for all that the scene's instances need, and counts how often each mesh is used. */
static cdl_Status reserve(Geometry *g) {
  const cdl_Scene *scene = g->scene;
  cdl_Pack *pack = g->pack;
  size_t floats = 4, triangles = 0, shapes = 0;
  g->uses = pack_array(g->log, "meshes", scene->mesh_count, sizeof *g->uses);
  g->mesh_number = pack_array(g->log, "meshes", scene->mesh_count, sizeof *g->mesh_number);
  if (!g->uses || !g->mesh_number) return CDL_BAD_INPUT;
  for (uint32_t i = 0; i < scene->instance_count; i++) g->uses[scene->instances[i].mesh]++;
  for (uint32_t i = 0; i < scene->mesh_count; i++) {
    g->mesh_number[i] = CDL_NONE;
    if (!g->uses[i]) continue;
    floats += mesh_floats(&scene->meshes[i]);
    triangles += scene->meshes[i].triangle_count;
    shapes++;
  }
  if (floats > UINT32_MAX || triangles > CDL_BVH_INDEX)
    return log_fail(g->log, CDL_BAD_INPUT,
                    "%s: %zu triangles with %zu numbers at their vertices are more than fit; split "
                    "the scene",
                    scene->path, triangles, floats);
  pack->attributes = pack_array(g->log, "attributes", floats, sizeof *pack->attributes);
  pack->triangles = pack_array(g->log, "triangles", triangles, sizeof *pack->triangles);
  pack->shapes = pack_array(g->log, "shapes", shapes, sizeof *pack->shapes);
  pack->mesh_shapes = pack_array(g->log, "shapes", shapes, sizeof *pack->mesh_shapes);
  g->parts = pack_array(g->log, "shapes", shapes, sizeof *g->parts);
  g->indices = pack_array(g->log, "shapes", shapes, sizeof *g->indices);
  g->meshes = pack_array(g->log, "meshes", shapes + BAKED_COUNT, sizeof *g->meshes);
  g->placements = pack_array(g->log, "instances", (size_t)scene->instance_count + BAKED_COUNT,
                             sizeof *g->placements);
  for (int i = 0; i < BAKED_COUNT; i++)
    g->baked[i] = pack_array(g->log, "shapes", shapes, sizeof *g->baked[i]);
  int complete = pack->attributes && pack->triangles && pack->shapes && pack->mesh_shapes &&
                 g->parts && g->indices && g->meshes && g->placements && g->baked[BAKED_OPAQUE] &&
                 g->baked[BAKED_PASSABLE];
  return complete ? CDL_OK : CDL_BAD_INPUT;
}

static void release(Geometry *g) {
  for (size_t i = 0; g->indices && i < g->pack->shape_count; i++) free(g->indices[i]);
  for (int i = 0; i < BAKED_COUNT; i++) free(g->baked[i]);
  free(g->uses);
  free(g->mesh_number);
  free(g->parts);
  free(g->indices);
  free(g->meshes);
  free(g->placements);
}

cdl_Status pack_geometry(const cdl_Log *log, const cdl_Scene *scene, int bvh_width,
                         cdl_Pack *pack) {
  Geometry g = {.log = log, .scene = scene, .pack = pack};
  cdl_Status status = reserve(&g);
  for (uint32_t i = 0; !status && i < scene->instance_count; i++) {
    const cdl_SceneInstance *instance = &scene->instances[i];
    status =
        g.uses[instance->mesh] == 1 ? bake_instance(&g, instance) : place_instance(&g, instance);
  }
  if (!status) {
    place_baked(&g);
    cdl_BvhOptions options = {.width = bvh_width};
    status = bvh_build(log, g.meshes, g.mesh_count, g.placements, g.placement_count, &options,
                       &pack->bvh);
  }
  release(&g);
  return status;
}
