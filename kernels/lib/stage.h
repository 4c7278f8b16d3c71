/* stage.h: how the kernel of a stage goes over its items.
 *
 * On CPUs a work-item does a strip of CDL_STRIP neighbours in a loop that the compiler is told to
 * vectorise; the loop is a CDL_FUNCTION, which the kernel calls. PoCL can also vectorise its own
 * loop over work-items, but runs a pass before it that packs pairs of like operations, x with y,
 * sine with cosine, and what has been packed is not vectorised any more (math_after keeps pairs
 * apart). Stages that look things up by index do one item by CDL_FOR_EACH_ITEM all the same: for
 * them the loop over work-items is the faster one. On GPUs CDL_STRIP is 1.
 *
 * Queues begin at and are padded to multiples of CDL_QUEUE_ALIGNMENT, which strips divide, so there
 * is no bound to check. The body must be straight-line code. */
#ifndef CDL_STAGE_H
#define CDL_STAGE_H

#include "lib/portable.h"

#ifndef CDL_STRIP
#define CDL_STRIP 1
#endif

/* A strip counts what is done, so that the number of turns is known: were the end compared, it
 * could overflow, and the compiler would add a loop that is not vectorised. */
#if CDL_STRIP > 1
#ifdef __clang__ /* warns when an early pass leaves the loop to a later one */
#pragma clang diagnostic ignored "-Wpass-failed"
#endif
#define CDL_FOR_STRIP(i, first)                                                                    \
  _Pragma("clang loop vectorize(assume_safety)") for (size_t i##_done = 0, i = (first);            \
                                                      i##_done < CDL_STRIP; i##_done++, i++)
#else
#define CDL_FOR_STRIP(i, first) for (size_t i = (first), i##_once = 1; i##_once; i##_once = 0)
#endif

/* No comparison of sizes: it could overflow for all that compilers know, and would stay as a
 * branch. */
#define CDL_FOR_EACH_ITEM(i) for (size_t i = get_global_id(0), i##_once = 1; i##_once; i##_once = 0)

#endif
