/* path.h: the layout of the path state and the queues that paths are sorted into. */
#ifndef CDL_ABI_PATH_H
#define CDL_ABI_PATH_H

#include "abi/material.h"
#include "abi/types.h"

/* CDL_PATH_ORIGIN, … : first word-array of each field; CDL_PATH_FIELDS: how many there are. */
#define CDL_FIELD(set, name, words) CDL_FIELD_##set(name, words)
#define CDL_FIELD_NONE(name, words)
#define CDL_FIELD_ENUM(prefix, name, words)                                                        \
  prefix##name, prefix##name##_END = prefix##name + (words)-1,

#define CDL_FIELD_PATH(name, words) CDL_FIELD_ENUM(CDL_PATH_, name, words)
#define CDL_FIELD_WORK(name, words)
#define CDL_FIELD_SLOT(name, words)
enum {
#include "abi/path_fields.h"
  CDL_PATH_FIELDS
};
#undef CDL_FIELD_PATH
#undef CDL_FIELD_WORK

#define CDL_FIELD_PATH(name, words)
#define CDL_FIELD_WORK(name, words) CDL_FIELD_ENUM(CDL_WORK_, name, words)
enum {
#include "abi/path_fields.h"
  CDL_WORK_FIELDS
};
#undef CDL_FIELD_WORK
#undef CDL_FIELD_SLOT

#define CDL_FIELD_WORK(name, words)
#define CDL_FIELD_SLOT(name, words) CDL_FIELD_ENUM(CDL_SLOT_, name, words)
enum {
#include "abi/path_fields.h"
  CDL_SLOT_FIELDS
};
#undef CDL_FIELD

/* Bits of CDL_WORK_VERTEX. */
#define CDL_VERTEX_FRONT 1u     /* the path comes from the geometric front side */
#define CDL_VERTEX_INTERFACE 2u /* the material is the boundary of a medium and nothing else */
#define CDL_VERTEX_MIRRORED 4u  /* the bitangent is tangent x normal, seen from the path's side */
#define CDL_VERTEX_FLAGS 8u     /* from this bit on: the material's flags, CDL_MATERIAL_* */

/* Queues, in the order in which they lie after a sort. Each model has two, the second for emissive
 * materials, so that a model's paths lie together and its emitters together within them. All
 * surfaces are neighbours, and so are all vertices that sample lights. */
#define CDL_QUEUE_ESCAPED 0u
#define CDL_QUEUE_PASS 1u   /* surfaces that let the path through: interfaces, holes */
#define CDL_QUEUE_MODELS 2u /* + 2 model + emissive */
#define CDL_QUEUE_MEDIUM (CDL_QUEUE_MODELS + 2u * CDL_MODEL_COUNT)
#define CDL_QUEUE_WALK (CDL_QUEUE_MEDIUM + 1u) /* scattered under a surface */
#define CDL_QUEUE_ENDED (CDL_QUEUE_WALK + 1u)  /* counted, but not moved: too deep to go on */
#define CDL_QUEUE_COUNT (CDL_QUEUE_ENDED + 1u)
#define CDL_QUEUE_SHADOWS CDL_QUEUE_COUNT /* no queue: its count is that of the shadow rays */
#define CDL_QUEUE_LIVE 0u                 /* written by shading: to be traced */
#define CDL_QUEUE_PROBE 0xfffffffeu       /* by shading: gone under the surface */
#define CDL_QUEUE_EXIT (CDL_QUEUE_MODELS + 2u * CDL_MODEL_SUBSURFACE_EXIT) /* and come out */
#define CDL_QUEUE_DEAD 0xffffffffu

/* Queues begin at multiples of this and are padded to it, so that work-groups are full. The first
 * begins after as many pads, because PoCL compiles a kernel anew for launches with an offset of 0.
 */
#define CDL_QUEUE_ALIGNMENT 64u
#define CDL_QUEUE_PADDING ((CDL_QUEUE_COUNT + 1u) * CDL_QUEUE_ALIGNMENT)

/* Paths that one work-item of the counting kernels looks at. */
#define CDL_QUEUE_CHUNK 256u

/* Where a queue lies after sorting. */
typedef struct cdl_QueueRange {
  uint begin; /* multiple of CDL_QUEUE_ALIGNMENT */
  uint count; /* without pads */
  uint pad[2];
} cdl_QueueRange;
CDL_ABI_SIZE(cdl_QueueRange, 16);

/* Entries of the source table of a sort: where the path comes from; a pad has this bit and its
 * slot. */
#define CDL_SOURCE_PAD 0x80000000u

#endif
