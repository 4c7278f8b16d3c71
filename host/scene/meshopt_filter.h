/* meshopt_filter.h: what turns decoded attributes into values (KHR_meshopt_compression,
 * appendix B; all but COLOR are EXT_meshopt_compression's as well).
 *
 * The library's filters round as the processor's vectors do; these take the specification's steps
 * in its order, in float, and halves go away from zero, so that values are the same everywhere.
 * `count` elements of `stride` bytes, in place. What is out of range of its filter gives some
 * value. */
#ifndef CANDELA_SCENE_MESHOPT_FILTER_H
#define CANDELA_SCENE_MESHOPT_FILTER_H

#include <stddef.h>
#include <stdint.h>

/* Four signed bytes or shorts: X and Y of an octahedron and its 1 in their bits, to a unit vector.
 * The fourth stays. Stride 4 or 8. */
void meshopt_octahedral(uint8_t *data, size_t count, size_t stride);

/* Three components of a unit quaternion, the largest left out, and their 1 with the place of the
 * largest in its low two bits, to four signed shorts. Stride 8. */
void meshopt_quaternions(uint8_t *data, size_t count);

/* A signed mantissa of 24 bits and a signed exponent of 8, to a float: exact but beyond its range.
 * Stride a multiple of 4. */
void meshopt_exponential(uint8_t *data, size_t count, size_t stride);

/* YCoCg with alpha in 8 or 16 bits, to RGBA. Stride 4 or 8. */
void meshopt_colors(uint8_t *data, size_t count, size_t stride);

#endif
