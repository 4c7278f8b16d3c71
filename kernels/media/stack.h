/* stack.h: which media a path is inside of.
 *
 * A list of up to four media, innermost first, 16 bits each: index + 1; 0 ends it. Entering puts
 * one in front (a fifth pushes the outermost out), leaving takes the innermost of that medium out,
 * wherever it is in the list: so overlapping media work, and leaving what was never entered changes
 * nothing. */
#ifndef CDL_MEDIA_STACK_H
#define CDL_MEDIA_STACK_H

#include "abi/medium.h"
#include "lib/portable.h"

typedef struct MediaStack {
  uint inner; /* entries 0 (low half) and 1 */
  uint outer; /* entries 2 and 3 */
  uint pad[3];
} MediaStack;

CDL_INLINE MediaStack media_make(uint inner, uint outer) {
  MediaStack stack;
  stack.inner = inner;
  stack.outer = outer;
  stack.pad[0] = 0u;
  stack.pad[1] = 0u;
  stack.pad[2] = 0u;
  return stack;
}

/* The medium that counts here; `outside` is the scene's. */
CDL_INLINE uint media_current(MediaStack stack, uint outside) {
  uint entry = stack.inner & 0xffffu;
  return entry ? entry - 1u : outside;
}

/* Crossing a surface: in through its front, or out through its back. Entry by entry, because whole
 * words would be rotated, which is lost on the way through SPIR. */
CDL_INLINE MediaStack media_crossed(MediaStack stack, uint medium, int entering) {
  uint entry = medium + 1u;
  uint e0 = stack.inner & 0xffffu;
  uint e1 = stack.inner >> 16;
  uint e2 = stack.outer & 0xffffu;
  uint e3 = stack.outer >> 16;
  int in0 = e0 == entry;
  int in1 = in0 | (e1 == entry);
  int in2 = in1 | (e2 == entry);
  int in3 = in2 | (e3 == entry);
  uint n0 = entering ? entry : in0 ? e1 : e0;
  uint n1 = entering ? e0 : in1 ? e2 : e1;
  uint n2 = entering ? e1 : in2 ? e3 : e2;
  uint n3 = entering ? e2 : in3 ? 0u : e3;
  return media_make(n0 | (n1 << 16), n2 | (n3 << 16));
}

#endif
