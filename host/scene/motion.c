#include "scene/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"

enum { MOST_KEYS = 33 };

/* Of straight lines, over the size of the scene. */
#define TOLERANCE 5e-4

typedef struct Keys {
  struct cdl_Scene *at[MOST_KEYS];
  int count;
} Keys;

static int mesh_alike(const cdl_SceneMesh *a, const cdl_SceneMesh *b) {
  return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
         !a->normals == !b->normals && !a->tangents == !b->tangents;
}

static int scenes_alike(const struct cdl_Scene *a, const struct cdl_Scene *b) {
  int alike = a->mesh_count == b->mesh_count && a->instance_count == b->instance_count &&
              a->camera_count == b->camera_count;
  for (uint32_t i = 0; alike && i < a->instance_count; i++) {
    uint32_t mesh = a->instances[i].mesh;
    alike = mesh == b->instances[i].mesh && a->instances[i].object == b->instances[i].object &&
            mesh_alike(&a->meshes[mesh], &b->meshes[mesh]);
  }
  return alike;
}

static void place(const struct cdl_Scene *scene, uint32_t instance, size_t vertex, double out[3]) {
  const float *m = scene->instances[instance].to_world;
  const float *p = scene->meshes[scene->instances[instance].mesh].positions + 3 * vertex;
  for (int r = 0; r < 3; r++)
    out[r] = (double)m[4 * r] * p[0] + (double)m[4 * r + 1] * p[1] + (double)m[4 * r + 2] * p[2] +
             m[4 * r + 3];
}

static int same(const float *a, const float *b, size_t count) {
  return !a || memcmp(a, b, count * sizeof *a) == 0;
}

static int differ(const struct cdl_Scene *a, const struct cdl_Scene *b, uint32_t instance) {
  const cdl_SceneInstance *i = &a->instances[instance], *j = &b->instances[instance];
  const cdl_SceneMesh *m = &a->meshes[i->mesh], *n = &b->meshes[j->mesh];
  size_t count = m->vertex_count;
  return !same(i->to_world, j->to_world, 12) || !same(m->positions, n->positions, 3 * count) ||
         !same(m->normals, n->normals, 3 * count) || !same(m->tangents, n->tangents, 4 * count);
}

int motion_moves(const struct cdl_Scene *scene, uint32_t instance) {
  for (uint32_t i = 0; i < scene->later_count; i++)
    if (differ(scene, scene->later[i], instance)) return 1;
  return 0;
}

static double scene_size(const struct cdl_Scene *scene) {
  double sum = 0;
  for (int c = 0; c < 3; c++) {
    double side = (double)scene->bounds[1][c] - scene->bounds[0][c];
    sum += side * side;
  }
  return isfinite(sum) && sum > 0 ? sqrt(sum) : 1;
}

/* How far the middle is from the straight line between both ends, over the scene's size. */
static double line_error(const struct cdl_Scene *a, const struct cdl_Scene *middle,
                         const struct cdl_Scene *b) {
  double most = 0, size = scene_size(a);
  for (uint32_t i = 0; i < a->instance_count; i++) {
    if (!differ(a, middle, i) && !differ(b, middle, i)) continue;
    for (size_t v = 0; v < a->meshes[a->instances[i].mesh].vertex_count; v++) {
      double p[3], q[3], r[3];
      place(a, i, v, p);
      place(middle, i, v, q);
      place(b, i, v, r);
      for (int c = 0; c < 3; c++) most = fmax(most, fabs(q[c] - 0.5 * (p[c] + r[c])) / size);
    }
  }
  for (uint32_t i = 0; i < a->camera_count; i++)
    for (int k = 0; k < 12; k++) {
      double off = middle->cameras[i].to_world[k] -
                   0.5 * ((double)a->cameras[i].to_world[k] + b->cameras[i].to_world[k]);
      most = fmax(most, fabs(off) / (k % 4 == 3 ? size : 1));
    }
  return most;
}

static void free_keys(Keys *keys) {
  for (int i = 0; i < keys->count; i++) scene_free(keys->at[i]);
  keys->count = 0;
}

/* Puts a key between any two; *error is how far the new ones are from straight lines. */
static cdl_Status refine(const cdl_MotionSource *source, double open, double close, Keys *keys,
                         double *error) {
  Keys finer = {.count = 2 * keys->count - 1};
  cdl_Status status = CDL_OK;
  *error = 0;
  for (int i = 0; i < keys->count; i++) finer.at[2 * i] = keys->at[i];
  for (int i = 1; i < finer.count && !status; i += 2) {
    double time = open + (close - open) * i / (finer.count - 1);
    status = source->build(source->user, time, 0, &finer.at[i]);
    if (status) break;
    if (!scenes_alike(finer.at[0], finer.at[i]))
      *error = INFINITY;
    else
      *error = fmax(*error, line_error(finer.at[i - 1], finer.at[i], finer.at[i + 1]));
  }
  if (status)
    for (int i = 1; i < finer.count; i += 2) scene_free(finer.at[i]);
  else
    *keys = finer;
  return status;
}

/* The keys after the first become part of it. */
static cdl_Status adopt(const cdl_Log *log, Keys *keys, struct cdl_Scene **scene) {
  struct cdl_Scene *first = keys->at[0];
  int moving = 0;
  for (int k = 1; k < keys->count; k++) {
    for (uint32_t i = 0; i < first->instance_count; i++) moving |= differ(first, keys->at[k], i);
    for (uint32_t i = 0; i < first->camera_count; i++)
      moving |= !same(first->cameras[i].to_world, keys->at[k]->cameras[i].to_world, 12);
  }
  first->later = moving ? calloc((size_t)keys->count, sizeof *first->later) : NULL;
  if (moving && !first->later)
    return log_fail(log, CDL_BAD_INPUT, "%s: not enough memory for what moves", first->path);
  for (int k = 1; k < keys->count; k++) {
    if (first->later)
      first->later[first->later_count++] = keys->at[k];
    else
      scene_free(keys->at[k]);
  }
  keys->count = 0;
  *scene = first;
  return CDL_OK;
}

cdl_Status motion_build(const cdl_MotionSource *source, double open, double close, int *changes,
                        struct cdl_Scene **scene) {
  Keys keys = {.count = 2};
  double error = INFINITY;
  *changes = 0;
  cdl_Status status = source->build(source->user, open, 1, &keys.at[0]);
  if (!status) status = source->build(source->user, close, 0, &keys.at[1]);
  if (!status && !scenes_alike(keys.at[0], keys.at[1])) *changes = 1;
  while (!status && !*changes && error > TOLERANCE && 2 * keys.count - 1 <= MOST_KEYS) {
    status = refine(source, open, close, &keys, &error);
    *changes |= isinf(error) && !status;
    if (keys.count == 3 && !status && !*changes && error <= TOLERANCE) error = 2 * TOLERANCE;
  }
  for (int i = 1; *changes && i < keys.count; i++) {
    scene_free(keys.at[i]);
    keys.at[i] = NULL;
  }
  if (*changes) keys.count = 1;
  if (!status) status = adopt(source->log, &keys, scene);
  if (status) free_keys(&keys);
  return status;
}
