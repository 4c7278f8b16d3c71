/* geometry.h: what a hit is looked up in: triangle -> shape -> attributes and material. */
#ifndef CDL_ABI_GEOMETRY_H
#define CDL_ABI_GEOMETRY_H

#include "abi/types.h"

/* Visibility masks of instances: what stops light, and what it may pass straight through. */
#define CDL_MASK_OPAQUE 1u
#define CDL_MASK_PASSABLE 2u

/* A triangle: corners count from its shape's first vertex. */
typedef struct cdl_Triangle {
  uint corner[3];
  uint shape;
} cdl_Triangle;
CDL_ABI_SIZE(cdl_Triangle, 16);

/* One glTF primitive: where its vertices' attributes begin in the attribute buffer (in floats), or
 * CDL_NONE where it has none. Baked shapes are in world space, those of instances in their own. */
typedef struct cdl_Shape {
  uint material;
  uint object;         /* node number; CDL_NONE: the instance says it */
  uint first_triangle; /* global number of its first triangle */
  uint first_light; /* light of its first triangle; CDL_NONE: the instance says it, or no light */
  uint positions;   /* 3 floats a vertex; never CDL_NONE */
  uint normals;     /* 3 floats a vertex, unit */
  uint tangents;    /* 4 floats a vertex: unit tangent and handedness */
  uint uv[2];       /* 2 floats a vertex */
  uint colors;      /* 4 floats a vertex: linear RGB and opacity */
  uint key_stride;  /* vertices from one key of its motion to the next; 0: it stands still */
  uint medium; /* what it holds when closed: index into the media; CDL_NONE: the instance says it */
} cdl_Shape;
CDL_ABI_SIZE(cdl_Shape, 48);

#endif
