/* tangent.c: tangents from texture coordinates.
 *
 * glTF asks for MikkTSpace. This takes its measure (the direction in which u grows, weighted by the
 * angle of each corner, made perpendicular to the normal) but keeps the file's vertices: where
 * triangles of opposite handedness share one, the larger angle wins, where MikkTSpace would split
 * it. Files that texture mirrored halves have split such vertices already. */
#include <math.h>
#include <stdlib.h>

#include "core/angle.h"
#include "scene/build.h"

typedef struct Vec {
  double x, y, z;
} Vec;

static Vec vec_of(const float *p) { return (Vec){p[0], p[1], p[2]}; }
static Vec sub(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vec along(Vec a, double s, Vec b) {
  return (Vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static Vec unit(Vec a) {
  double n = sqrt(dot(a, a));
  return n > 0 ? (Vec){a.x / n, a.y / n, a.z / n} : (Vec){0, 0, 0};
}

static Vec cross(Vec a, Vec b) {
  return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The direction of growing u in a triangle, and the handedness of its texture; 0: degenerate. */
static int triangle_tangent(const cdl_SceneMesh *mesh, const float *uv, const uint32_t *v,
                            Vec *tangent, double *sign) {
  Vec p = vec_of(mesh->positions + 3 * v[0]);
  Vec e1 = sub(vec_of(mesh->positions + 3 * v[1]), p);
  Vec e2 = sub(vec_of(mesh->positions + 3 * v[2]), p);
  double u1 = uv[2 * v[1]] - uv[2 * v[0]], w1 = uv[2 * v[1] + 1] - uv[2 * v[0] + 1];
  double u2 = uv[2 * v[2]] - uv[2 * v[0]], w2 = uv[2 * v[2] + 1] - uv[2 * v[0] + 1];
  double det = u1 * w2 - u2 * w1;
  if (det == 0 || !isfinite(det)) return 0;
  double s = det > 0 ? 1 : -1;
  Vec t = {s * (e1.x * w2 - e2.x * w1), s * (e1.y * w2 - e2.y * w1), s * (e1.z * w2 - e2.z * w1)};
  *tangent = unit(t);
  /* v grows downwards, and the bitangent cross(n, t) w points up the picture: where a picture lies
   * on a front face the right way round, det is negative and w is 1. */
  *sign = -s;
  return dot(*tangent, *tangent) > 0;
}

/* A right angle where one side has no length. */
static double corner_angle(const cdl_SceneMesh *mesh, const uint32_t *v, int k) {
  Vec p = vec_of(mesh->positions + 3 * v[k]);
  Vec a = unit(sub(vec_of(mesh->positions + 3 * v[(k + 1) % 3]), p));
  Vec b = unit(sub(vec_of(mesh->positions + 3 * v[(k + 2) % 3]), p));
  Vec difference = sub(a, b), sum = along(a, 1, b);
  return angle_between(sqrt(dot(difference, difference)), sqrt(dot(sum, sum)));
}

/* Sums for one vertex: tangents by angle, and angles by handedness. */
typedef struct Sum {
  Vec tangent;
  double sign;
} Sum;

static void accumulate(const cdl_SceneMesh *mesh, const float *uv, Sum *sums) {
  for (uint32_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *v = mesh->indices + 3 * (size_t)t;
    Vec tangent;
    double sign;
    if (!triangle_tangent(mesh, uv, v, &tangent, &sign)) continue;
    for (int k = 0; k < 3; k++) {
      double angle = corner_angle(mesh, v, k);
      Vec flat = tangent;
      if (mesh->normals) {
        Vec n = vec_of(mesh->normals + 3 * v[k]);
        flat = unit(along(tangent, -dot(tangent, n), n));
      }
      sums[v[k]].tangent = along(sums[v[k]].tangent, angle, flat);
      sums[v[k]].sign += angle * sign;
    }
  }
}

/* Any direction perpendicular to n, for vertices whose texture coordinates say nothing. */
static Vec any_tangent(Vec n) {
  Vec axis = fabs(n.x) < 0.6 ? (Vec){1, 0, 0} : (Vec){0, 1, 0};
  Vec t = unit(cross(axis, n));
  return dot(t, t) > 0 ? t : (Vec){1, 0, 0};
}

cdl_Status mesh_make_tangents(cdl_SceneMesh *mesh, uint32_t uv_set) {
  Sum *sums = calloc(mesh->vertex_count, sizeof *sums);
  float *out = malloc(4 * sizeof *out * (size_t)mesh->vertex_count);
  if (!sums || !out) {
    free(sums);
    free(out);
    return CDL_BAD_INPUT;
  }
  accumulate(mesh, mesh->uv[uv_set], sums);
  for (uint32_t i = 0; i < mesh->vertex_count; i++) {
    Vec t = unit(sums[i].tangent);
    Vec n = mesh->normals ? vec_of(mesh->normals + 3 * (size_t)i) : (Vec){0, 0, 1};
    if (dot(t, t) == 0) t = any_tangent(n);
    float *o = out + 4 * (size_t)i;
    o[0] = (float)t.x, o[1] = (float)t.y, o[2] = (float)t.z;
    o[3] = sums[i].sign < 0 ? -1.0f : 1.0f;
  }
  free(sums);
  mesh->tangents = out;
  return CDL_OK;
}
