#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"
#include "scene/motion.h"
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
  uint32_t keys;  /* of the motion; 1: everything stands still */
  uint8_t *moves; /* per instance */
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

/* Appends `width` floats a vertex, with room for `keys` times as many; CDL_NONE where the mesh has
 * none. */
static uint32_t append(Geometry *g, const cdl_SceneMesh *mesh, const float *from, uint32_t width,
                       uint32_t keys) {
  if (!from) return CDL_NONE;
  size_t at = g->pack->attribute_count, count = (size_t)mesh->vertex_count * width;
  memcpy(g->pack->attributes + at, from, count * sizeof *from);
  g->pack->attribute_count += count * keys;
  return (uint32_t)at;
}

/* Where the mesh's vertices are in the world at a key of the motion. */
static void bake_attributes(const cdl_SceneMesh *mesh, const float m[12], const cdl_Shape *shape,
                            uint32_t key, float *attributes) {
  float mirror = pack_mirrors(m) ? -1.0f : 1.0f;
  size_t first = (size_t)key * mesh->vertex_count;
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    size_t to = first + i;
    pack_point(m, mesh->positions + 3 * i, attributes + shape->positions + 3 * to);
    if (mesh->normals) bake_normal(m, mesh->normals + 3 * i, attributes + shape->normals + 3 * to);
    if (!mesh->tangents) continue;
    float *tangent = attributes + shape->tangents + 4 * to;
    bake_direction(m, mesh->tangents + 4 * i, tangent);
    tangent[3] = mesh->tangents[4 * i + 3] * mirror;
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

/* Appends a shape; `to_world` bakes it, NULL leaves it in its own space. There is room for `keys`
 * times of its vertices, of which the first is filled. */
static cdl_Status add_shape(Geometry *g, const cdl_SceneMesh *mesh, const float *to_world,
                            uint32_t object, uint32_t keys) {
  cdl_Pack *pack = g->pack;
  uint32_t index = (uint32_t)pack->shape_count++;
  cdl_Shape *shape = &pack->shapes[index];
  shape->material = mesh->material;
  shape->object = object;
  shape->first_triangle = (uint32_t)pack->triangle_count;
  shape->first_light = CDL_NONE;
  shape->positions = append(g, mesh, mesh->positions, 3, keys);
  shape->normals = append(g, mesh, mesh->normals, 3, keys);
  shape->tangents = append(g, mesh, mesh->tangents, 4, keys);
  for (int i = 0; i < 2; i++) shape->uv[i] = append(g, mesh, mesh->uv[i], 2, 1);
  shape->colors = append(g, mesh, mesh->colors, 4, 1);
  shape->key_stride = keys > 1 ? mesh->vertex_count : 0;
  pack->features.vertex_colors |= mesh->colors != NULL;
  if (to_world) bake_attributes(mesh, to_world, shape, 0, pack->attributes);
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
                                  .first_primitive = shape->first_triangle,
                                  .keys = keys,
                                  .key_stride = 3 * (size_t)mesh->vertex_count};
  return CDL_OK;
}

/* A clear coat over an emitter makes its radiance depend on the direction. */
static int is_coated(const cdl_Material *m) {
  return m->model == CDL_MODEL_GLTF_LAYERED && m->param[CDL_GLTF_LAYERED_CLEARCOAT] > 0;
}

/* Notes what the kernels will meet; emissive shapes get a light a triangle, per instance. Those
 * that move or are coated get none: paths find them. */
static void note_instance(Geometry *g, const cdl_SceneMesh *mesh, int moves,
                          uint32_t *first_light) {
  const cdl_Material *material = &g->pack->materials[mesh->material];
  cdl_PackFeatures *features = &g->pack->features;
  int emissive = (material->flags & CDL_MATERIAL_EMISSIVE) != 0;
  features->models[material->model] |= emissive ? 3 : 1;
  if (material->model == CDL_MODEL_SUBSURFACE) features->models[CDL_MODEL_SUBSURFACE_EXIT] = 1;
  features->passable |= material_passable(material);
  features->opacity |= material_passable(material) && material->model != CDL_MODEL_INTERFACE;
  *first_light = CDL_NONE;
  if (!emissive || moves || is_coated(material)) return;
  *first_light = (uint32_t)g->pack->light_count;
  g->pack->light_count += mesh->triangle_count;
  features->triangle_lights = 1;
}

/* The later keys of an instance that moves. */
static void bake_later(Geometry *g, uint32_t number, const cdl_Shape *shape) {
  for (uint32_t key = 1; key < g->keys; key++) {
    const cdl_Scene *scene = g->scene->later[key - 1];
    const cdl_SceneInstance *instance = &scene->instances[number];
    bake_attributes(&scene->meshes[instance->mesh], instance->to_world, shape, key,
                    g->pack->attributes);
  }
}

static cdl_Status bake_instance(Geometry *g, uint32_t number) {
  const cdl_SceneInstance *instance = &g->scene->instances[number];
  const cdl_SceneMesh *mesh = &g->scene->meshes[instance->mesh];
  uint32_t index = (uint32_t)g->pack->shape_count, first_light;
  uint32_t keys = g->moves[number] ? g->keys : 1;
  if (add_shape(g, mesh, instance->to_world, instance->object, keys)) return CDL_BAD_INPUT;
  if (keys > 1) bake_later(g, number, &g->pack->shapes[index]);
  note_instance(g, mesh, keys > 1, &first_light);
  g->pack->shapes[index].first_light = first_light;
  g->pack->shapes[index].medium = g->pack->instance_media[number];
  int group =
      material_passable(&g->pack->materials[mesh->material]) ? BAKED_PASSABLE : BAKED_OPAQUE;
  g->baked[group][g->baked_count[group]++] = g->parts[index];
  return CDL_OK;
}

/* What a shape of several instances holds, unless a grid makes that differ among them. */
static uint32_t shared_medium(const Geometry *g, uint32_t number) {
  uint32_t medium = g->pack->instance_media[number];
  return g->pack->media[medium].density == CDL_NONE ? medium : CDL_NONE;
}

static cdl_Status place_instance(Geometry *g, uint32_t number) {
  const cdl_SceneInstance *instance = &g->scene->instances[number];
  const cdl_SceneMesh *mesh = &g->scene->meshes[instance->mesh];
  if (g->mesh_number[instance->mesh] == CDL_NONE) {
    uint32_t shape = (uint32_t)g->pack->shape_count;
    if (add_shape(g, mesh, NULL, CDL_NONE, 1)) return CDL_BAD_INPUT;
    g->pack->shapes[shape].medium = shared_medium(g, number);
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
  placement->medium = g->pack->instance_media[number];
  note_instance(g, mesh, 0, &placement->first_light);
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

static size_t mesh_floats(const cdl_SceneMesh *mesh, uint32_t keys) {
  size_t moving = 3 + (mesh->normals ? 3 : 0) + (mesh->tangents ? 4 : 0);
  size_t still = (mesh->uv[0] ? 2 : 0) + (mesh->uv[1] ? 2 : 0) + (mesh->colors ? 4 : 0);
  return (moving * keys + still) * mesh->vertex_count;
}

/* What a scene needs of each array. */
typedef struct Need {
  size_t floats, triangles, shapes;
} Need;

static void need_shape(const cdl_SceneMesh *mesh, uint32_t keys, Need *need) {
  need->floats += mesh_floats(mesh, keys);
  need->triangles += mesh->triangle_count;
  need->shapes++;
}

/* An instance that moves is a shape of its own, others share that of their mesh. */
static Need count_needs(Geometry *g) {
  const cdl_Scene *scene = g->scene;
  Need need = {.floats = 4 + (g->keys > 1 ? 12 * (size_t)g->keys * scene->camera_count : 0)};
  for (uint32_t i = 0; i < scene->instance_count; i++) {
    uint32_t mesh = scene->instances[i].mesh;
    if (g->moves[i])
      need_shape(&scene->meshes[mesh], g->keys, &need);
    else
      g->uses[mesh]++;
  }
  for (uint32_t i = 0; i < scene->mesh_count; i++) {
    g->mesh_number[i] = CDL_NONE;
    if (g->uses[i]) need_shape(&scene->meshes[i], 1, &need);
  }
  return need;
}

/* Makes room for all that the scene's instances need, and counts how often each mesh is used. */
static cdl_Status reserve(Geometry *g) {
  const cdl_Scene *scene = g->scene;
  cdl_Pack *pack = g->pack;
  g->keys = scene->later_count + 1;
  g->moves = pack_array(g->log, "instances", scene->instance_count, sizeof *g->moves);
  g->uses = pack_array(g->log, "meshes", scene->mesh_count, sizeof *g->uses);
  g->mesh_number = pack_array(g->log, "meshes", scene->mesh_count, sizeof *g->mesh_number);
  if (!g->moves || !g->uses || !g->mesh_number) return CDL_BAD_INPUT;
  for (uint32_t i = 0; g->keys > 1 && i < scene->instance_count; i++)
    g->moves[i] = motion_moves(scene, i) != 0;
  Need need = count_needs(g);
  size_t floats = need.floats, triangles = need.triangles, shapes = need.shapes;
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
  free(g->moves);
  free(g->uses);
  free(g->mesh_number);
  free(g->parts);
  free(g->indices);
  free(g->meshes);
  free(g->placements);
}

/* All cameras' matrices, key after key, behind all attributes. */
static void append_cameras(Geometry *g) {
  cdl_Pack *pack = g->pack;
  pack->motion_keys = g->keys;
  pack->features.motion = 1;
  pack->camera_keys = (uint32_t)pack->attribute_count;
  for (uint32_t i = 0; i < g->scene->camera_count; i++)
    for (uint32_t key = 0; key < g->keys; key++) {
      const cdl_Scene *scene = key ? g->scene->later[key - 1] : g->scene;
      memcpy(pack->attributes + pack->attribute_count, scene->cameras[i].to_world,
             sizeof scene->cameras[i].to_world);
      pack->attribute_count += 12;
    }
}

cdl_Status pack_geometry(const cdl_Log *log, const cdl_Scene *scene, int bvh_width,
                         cdl_Pack *pack) {
  Geometry g = {.log = log, .scene = scene, .pack = pack};
  cdl_Status status = reserve(&g);
  for (uint32_t i = 0; !status && i < scene->instance_count; i++) {
    const cdl_SceneInstance *instance = &scene->instances[i];
    int alone = g.moves[i] || g.uses[instance->mesh] == 1;
    status = alone ? bake_instance(&g, i) : place_instance(&g, i);
  }
  if (!status) {
    if (g.keys > 1) append_cameras(&g);
    place_baked(&g);
    cdl_BvhOptions options = {.width = bvh_width};
    status = bvh_build(log, g.meshes, g.mesh_count, g.placements, g.placement_count, &options,
                       &pack->bvh);
  }
  release(&g);
  return status;
}
