/* draco_encode.h: meshes made into Draco streams by the library's own encoder. */
#ifndef CANDELA_TESTS_DRACO_ENCODE_H
#define CANDELA_TESTS_DRACO_ENCODE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* An attribute of a mesh: `type` is Draco's (0 position, 1 normal, 2 colour, 3 texture coordinate,
 * 4 any), `component` GL's; `bits` of quantisation, 0: none. */
typedef struct DracoSource {
  int type;
  uint32_t component, width;
  int normalized, bits;
  const void *data;
  uint32_t id; /* out: its number in the stream */
} DracoSource;

/* Encodes triangles with one vertex for each corner value, and some metadata where asked for.
 * Returns the stream's size, 0 when that fails or does not fit into `room`. */
size_t draco_encode(const uint32_t (*faces)[3], uint32_t face_count, uint32_t points,
                    DracoSource *sources, int source_count, int edgebreaker, int with_metadata,
                    uint8_t *out, size_t room);

#ifdef __cplusplus
}
#endif
#endif
