/* state.h: reading and writing the path state; see abi/path_fields.h for the fields.
 *
 * Indices are size_t: with 32 bits the compiler would have to allow for wrap-around and could not
 * see that neighbouring work-items touch neighbouring words. */
#ifndef CDL_STATE_H
#define CDL_STATE_H

#include "abi/path.h"
#include "lib/vec.h"

CDL_INLINE uint state_uint(CDL_GLOBAL const uint *state, uint field, size_t stride, size_t i) {
  return state[field * stride + i];
}

CDL_INLINE float state_float(CDL_GLOBAL const uint *state, uint field, size_t stride, size_t i) {
  return as_float(state[field * stride + i]);
}

CDL_INLINE vec3 state_vec3(CDL_GLOBAL const uint *state, uint field, size_t stride, size_t i) {
  return v3(state_float(state, field, stride, i), state_float(state, field + 1u, stride, i),
            state_float(state, field + 2u, stride, i));
}

CDL_INLINE void state_set_uint(CDL_GLOBAL uint *state, uint field, size_t stride, size_t i,
                               uint value) {
  state[field * stride + i] = value;
}

CDL_INLINE void state_set_float(CDL_GLOBAL uint *state, uint field, size_t stride, size_t i,
                                float value) {
  state[field * stride + i] = as_uint(value);
}

CDL_INLINE void state_set_vec3(CDL_GLOBAL uint *state, uint field, size_t stride, size_t i,
                               vec3 value) {
  state_set_float(state, field, stride, i, value.x);
  state_set_float(state, field + 1u, stride, i, value.y);
  state_set_float(state, field + 2u, stride, i, value.z);
}

/* Adds to a slot's radiance. No two paths share a slot, so there is no race. */
CDL_INLINE void state_add_radiance(CDL_GLOBAL uint *slots, size_t stride, uint slot,
                                   vec3 radiance) {
  vec3 sum = state_vec3(slots, CDL_SLOT_RADIANCE, stride, slot);
  state_set_vec3(slots, CDL_SLOT_RADIANCE, stride, slot, v3_add(sum, radiance));
}

/* CDL_PATH_COUNTS */
CDL_INLINE uint counts_depth(uint counts) { return counts & 0xffffu; }

CDL_INLINE uint counts_vertex(uint counts) { return counts >> 16; }

CDL_INLINE uint counts_scattered(uint counts) { return counts + 0x10001u; }

CDL_INLINE uint counts_passed(uint counts) { return counts + 0x10000u; }

/* Surfaces that the path went straight through: vertices at which it did not scatter. */
CDL_INLINE uint counts_passes(uint counts) { return counts_vertex(counts) - counts_depth(counts); }

#endif
