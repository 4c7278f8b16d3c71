/* compression.h: geometry and other data that a file holds compressed.
 *
 * Both extensions are dealt with while a document is checked (check_layout.c): afterwards views and
 * accessors point at plain data, and no other code knows of them. Everything decompressed is
 * charged to document_charge() before memory is taken for it. */
#ifndef CANDELA_SCENE_COMPRESSION_H
#define CANDELA_SCENE_COMPRESSION_H

#include "scene/document.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a buffer only stands in for compressed data (EXT_ and KHR_meshopt_compression): nothing
 * is read from it. */
int compression_is_fallback(const json_t *buffer);

/* EXT_meshopt_compression, KHR_meshopt_compression: decompresses view `i` where it says so. Where
 * the compressed bytes are not here, the view stays what it is without the extension. */
cdl_Status meshopt_view(Document *doc, uint32_t i, const json_t *json, BufferView *view);

/* Decodes `count` elements of `stride` bytes (a multiple of 4, 4 to 256) from an attribute stream
 * of version 0 or 1 (KHR_meshopt_compression, appendix A, mode 0). Returns 0 when the stream is not
 * valid. Of version 0 the library's decoder is faster and gives the same. */
int meshopt_attributes(const uint8_t *stream, size_t size, size_t count, size_t stride,
                       uint8_t *out);

/* KHR_draco_mesh_compression: decompresses the accessors of all primitives that say so. Their mode
 * becomes TRIANGLES in doc->root, as that is what the decoder makes of strips. */
cdl_Status draco_primitives(Document *doc);

/* An attribute to be had from a Draco stream. */
typedef struct DracoAttribute {
  uint32_t id;               /* its number in the stream */
  uint32_t component, width; /* GL component type and number of components wanted */
  uint8_t *data;             /* out: points x width, packed; free it */
} DracoAttribute;

/* A Draco stream and what it must hold. */
typedef struct DracoMesh {
  const uint8_t *stream;
  size_t size;
  size_t points, most_faces;  /* declared: as many points, no more faces */
  size_t budget;              /* bytes that decoding may take, roughly; out: what it took */
  uint32_t index_component;   /* GL type of the indices wanted */
  DracoAttribute *attributes; /* attribute_count of them */
  uint32_t attribute_count;
  uint8_t *indices; /* out: 3 x faces; free it */
  size_t faces;     /* out */
  char error[160];  /* out: why it failed */
} DracoMesh;

/* draco.cpp, which alone sees that library. Returns 0 when decoding failed, with `error` set; what
 * was allocated by then is in `mesh` all the same. */
int draco_decode(DracoMesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
