#include "bvh/instances.h"

#include <float.h>

/* Levels of the mesh's tree whose boxes are transformed: nearly as tight as all the vertices. */
enum { PLACE_LEVELS = 6 };

static int is_identity(const float m[12]) {
  for (int i = 0; i < 12; i++)
    if (m[i] != (i % 5 == 0 ? 1.0f : 0.0f)) return 0;
  return 1;
}

/* Inverts a 3x4 matrix by cofactors, in double. False if it is singular or the inverse overflows.
 */
static int invert(const float m[12], float inverse[12]) {
  double a[3][4], c[3][3];
  for (int i = 0; i < 12; i++) a[i / 4][i % 4] = m[i];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  double determinant = a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
  for (int i = 0; i < 3; i++) {
    double moved = 0.0;
    for (int j = 0; j < 3; j++) {
      inverse[4 * i + j] = (float)(c[j][i] / determinant);
      moved -= c[j][i] / determinant * a[j][3];
    }
    inverse[4 * i + 3] = (float)moved;
  }
  for (int i = 0; i < 12; i++)
    if (!isfinite(inverse[i])) return 0;
  return determinant != 0.0;
}

/* Grows the box of the world by a transformed box: center and half size, each per axis, go through
 * the matrix and its absolute value. Padded for the rounding of the rays' transform, of which
 * BVH_PAD_INSTANCES covers the part that depends on the ray. */
static void grow_transformed(const float m[12], const Box *box, Box *world) {
  Box moved;
  for (int i = 0; i < 3; i++) {
    double center = m[4 * i + 3], half = 0.0, size = fabs(m[4 * i + 3]);
    for (int j = 0; j < 3; j++) {
      double low = box->side[j], high = -(double)box->side[j + 4];
      center += m[4 * i + j] * 0.5 * (low + high);
      half += fabs(m[4 * i + j]) * 0.5 * (high - low);
      size += fabs(m[4 * i + j]) * fmax(fabs(low), fabs(high));
    }
    double pad = size * 0x1p-19;
    moved.side[i] = (float)(center - half - pad);
    moved.side[i + 4] = -(float)(center + half + pad);
  }
  moved.side[3] = moved.side[7] = 0.0f;
  box_grow(world, &moved);
}

static void grow_subtree(const float m[12], const Tree *mesh, uint32_t at, int levels, Box *world) {
  const TreeNode *node = mesh->nodes + at;
  if (node->count || levels == 0) {
    grow_transformed(m, &node->box, world);
    return;
  }
  grow_subtree(m, mesh, at + 1, levels - 1, world);
  grow_subtree(m, mesh, node->next, levels - 1, world);
}

int instance_place(const cdl_BvhPlacement *placement, const Tree *mesh, cdl_BvhInstance *instance) {
  Box box = mesh->nodes ? mesh->nodes[0].box : box_empty(), world = box;
  *instance = (cdl_BvhInstance){.mask = placement->mask,
                                .mesh = placement->mesh,
                                .object = placement->object,
                                .first_light = placement->first_light,
                                .medium = placement->medium};
  memcpy(instance->to_world, placement->to_world, sizeof instance->to_world);
  int usable = mesh->nodes && invert(placement->to_world, instance->to_object);
  if (is_identity(placement->to_world)) {
    instance->flags |= CDL_INSTANCE_IDENTITY;
  } else if (usable) {
    world = box_empty();
    grow_subtree(placement->to_world, mesh, 0, PLACE_LEVELS, &world);
  }
  box_store(&box, instance->object_bounds);
  box_store(&world, instance->world_bounds);
  for (int i = 0; i < 6; i++) usable &= isfinite(instance->world_bounds[i]) != 0;
  return usable;
}
