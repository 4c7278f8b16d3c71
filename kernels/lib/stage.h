/* stage.h: how the kernel of a stage goes over its items.
 *
 * On CPUs a work-item does a strip of CDL_STRIP neighbours in a loop that the compiler is told to
 * vectorise. PoCL can also vectorise its own loop over work-items, but runs a pass before it that
 * packs pairs of like operations, x with y, sine with cosine, and what has been packed is not
 * vectorised any more. On GPUs CDL_STRIP is 1 and a work-item does one item.
 *
 * Queues begin at and are padded to multiples of CDL_QUEUE_ALIGNMENT, which strips divide, so there
 * is no bound to check. The body must be straight-line code. */
#ifndef CDL_STAGE_H
#define CDL_STAGE_H

#include "lib/portable.h"

#ifndef CDL_STRIP
#define CDL_STRIP 1
#endif

#if CDL_STRIP > 1
#ifdef __clang__ /* warns when an early pass leaves the loop to a later one */
#pragma clang diagnostic ignored "-Wpass-failed"
#endif
#define CDL_FOR_EACH_ITEM(i)                                                                       \
  _Pragma("clang loop vectorize(assume_safety)") for (size_t i = get_global_id(0) * CDL_STRIP,     \
                                                      i##_end = i + CDL_STRIP;                     \
                                                      i < i##_end; i++)
#else
/* No comparison of sizes: it could overflow for all that compilers know, and would stay as a
 * branch. */
#define CDL_FOR_EACH_ITEM(i) for (size_t i = get_global_id(0), i##_once = 1; i##_once; i##_once = 0)
#endif

#endif
