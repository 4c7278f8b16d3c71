/* query.h: one material alone, asked about directions in its local frame: +Z the normal of its
 * front, X the tangent. The kernels are built for the material's model, -DCDL_SHADE_MODEL=…. */
#ifndef CDL_BSDF_QUERY_H
#define CDL_BSDF_QUERY_H

#include "lib/portable.h"

#include "abi/bsdf.h"
#include "abi/material.h"

#ifndef CDL_SHADE_MODEL /* so that they compile by themselves */
#define CDL_SHADE_MODEL CDL_MODEL_DIFFUSE
#endif

#include "bsdf/all_layers.h" /* one material costs little */
#include "bsdf/model.h"
#include "lib/frame.h"

CDL_INLINE vec3 query_vec3(CDL_GLOBAL const float *from, size_t i) {
  return v3(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
}

/* A direction in the frame that models see, whose Z is on the side of wo: as renders turn the
 * frame, about the tangent. */
CDL_INLINE vec3 query_turn(int front, vec3 w) { return v3_select(front, w, v3(w.x, -w.y, -w.z)); }

/* The material at a point of factors alone, seen by white light. */
CDL_INLINE BsdfParams query_params(CDL_GLOBAL const cdl_Material *material,
                                   CDL_GLOBAL const float *energy_table, int front,
                                   float wavelength, float channel_choice) {
  BsdfPoint point;
  point.base = v3(material->base[0], material->base[1], material->base[2]);
  point.throughput = v3_all(1.0f);
  point.coat_normal = v3(0.0f, 0.0f, 1.0f);
  point.wavelength = wavelength;
  point.channel_choice = channel_choice;
  point.flags = material->flags;
  point.front = front;
  point.mirrored = !front;
  point.energy = energy_table;
  return bsdf_params(point, (CDL_GLOBAL const uint *)material->param, 1, 0);
}

#endif
