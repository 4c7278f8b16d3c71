/* probe_subsurface: where light that went under a surface comes out again. Follows the probe
 * through all of the same body (one node's surfaces of one material) and chooses one of the places
 * that it finds, by what each would carry. The path goes on from there as from any surface. */
#include "lib/portable.h"

#include "abi/geometry.h"
#include "abi/params.h"
#include "bsdf/subsurface.h"
#include "bvh/traverse.h"
#include "lib/dimensions.h"
#include "lib/passable.h"
#include "lib/state.h"

/* Where the path went under. */
typedef struct Entry {
  vec3 position;
  Frame frame;
  SubsurfaceProfiles profiles;
  vec3 channels;
  float carries; /* the sum of the throughput, of which `channels` are shares */
  uint material, object;
  int front;
} Entry;

/* A place where it may come out. */
typedef struct Exit {
  Hit hit;
  vec3 normal; /* unit, on the side that it went under from */
  vec3 throughput;
  float carries;
  float pad;
} Exit;

CDL_INLINE Entry load_entry(CDL_CONSTANT cdl_Wave *wave,
                            CDL_GLOBAL const cdl_BvhInstance *instances,
                            CDL_GLOBAL const cdl_Triangle *triangles,
                            CDL_GLOBAL const cdl_Shape *shapes, CDL_GLOBAL const uint *path,
                            CDL_GLOBAL const uint *work, size_t i) {
  size_t stride = wave->stride;
  Entry at;
  at.position = state_vec3(work, CDL_WORK_POSITION, stride, i);
  at.frame = frame_from_tangent(state_vec3(work, CDL_WORK_GEOMETRIC_NORMAL, stride, i),
                                state_vec3(work, CDL_WORK_TANGENT, stride, i));
  uint vertex = state_uint(work, CDL_WORK_VERTEX, stride, i);
  int dipole = ((vertex >> CDL_VERTEX_FLAGS) & CDL_MATERIAL_DIPOLE) != 0u;
  at.profiles = subsurface_load_all(work + CDL_WORK_PARAM * stride, dipole, stride, i);
  vec3 throughput = state_vec3(path, CDL_PATH_THROUGHPUT, stride, i);
  at.channels = subsurface_channels(throughput);
  at.carries = throughput.x + throughput.y + throughput.z;
  at.material = state_uint(work, CDL_WORK_MATERIAL, stride, i);
  at.front = (vertex & CDL_VERTEX_FRONT) != 0u;
  uint shape = triangles[state_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i)].shape;
  uint instance = state_uint(path, CDL_PATH_HIT_INSTANCE, stride, i);
  at.object = surface_object(shapes + shape, instances + instance);
  return at;
}

/* What the place that the probe meets would carry; nothing where it is another body's. */
CDL_INLINE Exit weigh_exit(Entry at, Hit hit, vec3 origin, vec3 direction,
                           CDL_GLOBAL const cdl_BvhInstance *instances,
                           CDL_GLOBAL const cdl_Triangle *triangles,
                           CDL_GLOBAL const cdl_Shape *shapes,
                           CDL_GLOBAL const float *attributes CDL_TIME_PARAM) {
  CDL_GLOBAL const cdl_Shape *shape = shapes + triangles[hit.primitive].shape;
  Exit place;
  place.hit = hit;
  place.normal = at.frame.z;
  place.throughput = v3_all(0.0f);
  place.carries = place.pad = 0.0f;
  if (shape->material != at.material ||
      surface_object(shape, instances + hit.instance) != at.object)
    return place;
  vec3 normal =
      v3_normalize(hit_normal(hit, instances, triangles, shapes, attributes CDL_TIME(time)));
  place.normal = at.front ? normal : v3_neg(normal);
  vec3 offset = v3_sub(v3_madd(origin, hit.t, direction), at.position);
  vec3 carried =
      subsurface_carry(at.profiles, at.channels, at.frame, SUBSURFACE_NORMAL_SHARE, offset, normal);
  place.throughput = v3_scale(carried, at.carries);
  place.carries = v3_max(place.throughput);
  return place;
}

__kernel void
probe_subsurface(CDL_CONSTANT cdl_Params *restrict params, CDL_CONSTANT cdl_Wave *restrict wave,
                 CDL_GLOBAL const BvhNode *bvh_nodes, CDL_GLOBAL const BvhTriangle *bvh_triangles,
                 CDL_GLOBAL const cdl_BvhInstance *bvh_instances,
                 CDL_GLOBAL const cdl_Triangle *triangles, CDL_GLOBAL const cdl_Shape *shapes,
                 CDL_GLOBAL const float *attributes, CDL_GLOBAL uint *path, CDL_GLOBAL uint *work) {
  size_t i = get_global_id(0);
  size_t stride = wave->stride;
  if (state_uint(work, CDL_WORK_QUEUE, stride, i) != CDL_QUEUE_PROBE) return;
  uint slot = state_uint(path, CDL_PATH_SLOT, stride, i);
  Entry at = load_entry(wave, bvh_instances, triangles, shapes, path, work, i);
  vec3 origin = state_vec3(path, CDL_PATH_ORIGIN, stride, i);
  vec3 direction = state_vec3(path, CDL_PATH_DIRECTION, stride, i);
  float length = state_float(path, CDL_PATH_HIT_T, stride, i);
#ifdef CDL_MOTION
  MotionTime time = path_time(params, wave, slot);
#endif
  /* The vertex's number has been counted on. */
  uint vertex = counts_vertex(state_uint(path, CDL_PATH_COUNTS, stride, i)) - 1u;
  float unused, choice;
  vertex_random(path_random(params, wave, slot), vertex, CDL_PAIR_CHANNEL, &unused, &choice);

  Exit chosen;
  chosen.hit = hit_none(0.0f);
  chosen.normal = chosen.throughput = v3_all(0.0f);
  chosen.carries = chosen.pad = 0.0f;
  float sum = 0.0f;
  Hit last = hit_none(0.0f);
  while (length > 0.0f) {
    last = bvh_closest_after(bvh_nodes, bvh_triangles, bvh_instances, params->top_root, origin,
                             direction, length, CDL_MASK_ALL, last CDL_TIME(time));
    if (!hit_is_some(last)) break;
    Exit place = weigh_exit(at, last, origin, direction, bvh_instances, triangles, shapes,
                            attributes CDL_TIME(time));
    if (!(place.carries > 0.0f)) continue;
    /* One of those so far, each with the probability of its share; `choice` stays uniform. */
    sum += place.carries;
    float share = place.carries / sum;
    int takes = choice < share;
    choice = takes ? choice / share : (choice - share) / (1.0f - share);
    if (takes) chosen = place;
  }
  int found = hit_is_some(chosen.hit);
  float scale = found ? sum / chosen.carries : 0.0f;
  vec3 next = v3_scale(chosen.throughput, scale);
  state_set_uint(work, CDL_WORK_QUEUE, stride, i, found ? CDL_QUEUE_EXIT : CDL_QUEUE_DEAD);
  if (!found) return;
  state_set_vec3(path, CDL_PATH_THROUGHPUT, stride, i, next);
  state_set_vec3(path, CDL_PATH_DIRECTION, stride, i, v3_neg(chosen.normal));
  state_set_float(path, CDL_PATH_HIT_T, stride, i, 0.0f); /* no way through air */
  state_set_float(path, CDL_PATH_HIT_U, stride, i, chosen.hit.u);
  state_set_float(path, CDL_PATH_HIT_V, stride, i, chosen.hit.v);
  state_set_uint(path, CDL_PATH_HIT_TRIANGLE, stride, i, chosen.hit.primitive);
  state_set_uint(path, CDL_PATH_HIT_INSTANCE, stride, i, chosen.hit.instance);
}
