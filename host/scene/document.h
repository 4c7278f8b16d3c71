/* document.h: a glTF file on its way in: its bytes, its JSON, and the buffers and images it names.
 *
 * Nothing in a Document is trusted before the checks of check.h have passed. Everything is owned by
 * the Document and freed by document_close(). Failures are reported as `FILE: POINTER: CODE:
 * words`, with the JSON pointer (or `@OFFSET` in a GLB's frame) and the code that the Khronos
 * validator uses. */
#ifndef CANDELA_SCENE_DOCUMENT_H
#define CANDELA_SCENE_DOCUMENT_H

#include <jansson.h>
#include <nettle/sha2.h>
#include <stddef.h>
#include <stdint.h>

#include "candela.h"

#ifdef __cplusplus
extern "C" {
#endif

#define DOCUMENT_NONE 0xffffffffu

/* Bytes in memory; `owned` is what to free (NULL when they lie in something larger). */
typedef struct Bytes {
  const uint8_t *data;
  size_t size;
  uint8_t *owned;
} Bytes;

typedef struct BufferView {
  uint32_t buffer, stride; /* stride in bytes; 0: none given */
  size_t offset, length;
  uint32_t target;     /* 0: none given */
  const uint8_t *data; /* its first byte; NULL: its buffer is not here */
  uint8_t *owned;      /* what was decompressed, to free */
  uint32_t lossy;      /* decompressed to less than full precision */
} BufferView;

/* Where an accessor's elements lie; ranges are proven by check_layout(). */
typedef struct Accessor {
  uint32_t view;                      /* DOCUMENT_NONE: zeros */
  uint32_t component, width, columns; /* GL component type; components; matrix columns (1: none) */
  uint32_t normalized;
  size_t offset, count;
  const uint8_t *data; /* its first element, sparse values aside; NULL: zeros, or not here */
  size_t stride;       /* bytes from one element to the next */
  uint8_t *owned;      /* what was decompressed, to free */
  uint32_t source;     /* the buffer view that this was decompressed from, or DOCUMENT_NONE */
  uint32_t lossy;      /* as of BufferView */
  size_t sparse_count; /* 0: not sparse */
  uint32_t sparse_view, sparse_component, values_view;
  size_t sparse_offset, values_offset;
} Accessor;

typedef struct Document {
  const cdl_Log *log;
  char *path;   /* as the caller gave it */
  char *folder; /* canonical; nothing outside is read */
  Bytes file, bin;
  int is_binary;
  json_t *root;
  json_t *seen; /* what has been noted already */
  Bytes *buffers, *images;
  BufferView *views;
  Accessor *accessors;
  uint32_t buffer_count, image_count, view_count, accessor_count;
  size_t decode_left;     /* bytes that compressed data may still grow to; see document_charge() */
  struct sha256_ctx hash; /* over every file read, in order, each with its length before it */
} Document;

/* Reads a .gltf or .glb, takes a GLB apart and parses the JSON. Call document_close() in any case.
 */
cdl_Status document_open(const cdl_Log *log, const char *path, Document *doc);

void document_close(Document *doc);

/* Reports `FILE: POINTER: CODE: words` and returns CDL_BAD_INPUT. */
cdl_Status document_fail(const Document *doc, const char *pointer, const char *code,
                         const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Notes `FILE: POINTER: words`, once for each `key`; NULL is always new. */
void document_note(const Document *doc, const char *key, const char *pointer, const char *format,
                   ...) __attribute__((format(printf, 4, 5)));

cdl_Status document_out_of_memory(const Document *doc);

/* Takes `bytes` off what compressed data of this document may take in memory; fails, with `pointer`
 * in the message, when not so much is left. What small files can blow up to is bounded by it. */
cdl_Status document_charge(Document *doc, const char *pointer, size_t bytes);

/* Resolves a URI (data: or a relative path) to bytes of its own. `pointer` says where the URI
 * stands. *media_type, unless NULL, gets a data URI's type, or "". Files outside the scene's
 * folder, over 4 GiB, or not regular are refused. */
cdl_Status document_read_uri(Document *doc, const char *pointer, const char *uri, Bytes *bytes,
                             char media_type[64]);

/* Whether a URI has a scheme other than data:, or names a host: nothing that we would read. */
int uri_is_remote(const char *uri);

/* Reads a whole regular file of at most `limit` bytes. Returns NULL and an errno value in *error
 * when that fails (EFBIG when it is larger). Free the result. */
uint8_t *file_read(const char *path, size_t limit, size_t *size, int *error);

/* Formats a JSON pointer into `text` (256 bytes) and returns it. */
char *pointer_format(char *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
#define AT(...) pointer_format((char[256]){0}, __VA_ARGS__)

/* Members of JSON objects that the schema has already checked, with the default where absent. */
double json_get_number(const json_t *object, const char *name, double otherwise);
uint32_t json_get_index(const json_t *object, const char *name);
const char *json_get_string(const json_t *object, const char *name, const char *otherwise);
json_t *json_get_extension(const json_t *object, const char *name);

/* Fills `values` from an array of `count` numbers; leaves them as they are when it is absent. A
 * single number fills all. */
void json_get_numbers(const json_t *object, const char *name, unsigned count, float *values);

#ifdef __cplusplus
}
#endif
#endif
