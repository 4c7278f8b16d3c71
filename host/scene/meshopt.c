/* meshopt.c: buffer views compressed by EXT_meshopt_compression or KHR_meshopt_compression. */
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "scene/compression.h"
#include "scene/meshopt_filter.h"

#define HEADER_ATTRIBUTES_0 0xa0
#define HEADER_ATTRIBUTES_1 0xa1
#define HEADER_TRIANGLES 0xe1
#define HEADER_INDICES 0xd1

typedef enum Mode { MODE_ATTRIBUTES, MODE_TRIANGLES, MODE_INDICES } Mode;
typedef enum Filter {
  FILTER_NONE,
  FILTER_OCTAHEDRAL,
  FILTER_QUATERNION,
  FILTER_EXPONENTIAL,
  FILTER_COLOR
} Filter;

static const char *const names[] = {"KHR_meshopt_compression", "EXT_meshopt_compression"};
static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES", NULL};
static const char *const filters[] = {"NONE",        "OCTAHEDRAL", "QUATERNION",
                                      "EXPONENTIAL", "COLOR",      NULL};

typedef struct Stream {
  const uint8_t *data; /* NULL: not here */
  size_t size, count, stride;
  Mode mode;
  Filter filter;
  const char *at; /* JSON pointer of the extension's object */
  int is_khr;
} Stream;

static int find_name(const char *const *list, const char *name) {
  int i = 0;
  while (list[i] && strcmp(list[i], name) != 0) i++;
  return i;
}

int compression_is_fallback(const json_t *buffer) {
  for (int i = 0; i < 2; i++)
    if (json_is_true(json_object_get(json_get_extension(buffer, names[i]), "fallback"))) return 1;
  return 0;
}

/* What the extension allows of strides; 0 when one is not among it. */
static int stride_allowed(const Stream *s) {
  if (s->mode != MODE_ATTRIBUTES) return s->stride == 2 || s->stride == 4;
  switch (s->filter) {
  case FILTER_OCTAHEDRAL:
  case FILTER_COLOR:
    return s->stride == 4 || s->stride == 8;
  case FILTER_QUATERNION:
    return s->stride == 8;
  default:
    return s->stride % 4 == 0 && s->stride <= 256;
  }
}

static cdl_Status check_stream(Document *doc, const Stream *s, const BufferView *view) {
  char at[256];
  if (!stride_allowed(s))
    return document_fail(doc, pointer_format(at, "%s/byteStride", s->at), "VALUE_NOT_IN_LIST",
                         "%zu is no stride for the mode %s with the filter %s.", s->stride,
                         modes[s->mode], filters[s->filter]);
  if (s->mode != MODE_ATTRIBUTES && s->filter != FILTER_NONE)
    return document_fail(doc, pointer_format(at, "%s/filter", s->at), "VALUE_NOT_IN_LIST",
                         "indices cannot be filtered.");
  if (s->mode == MODE_TRIANGLES && s->count % 3)
    return document_fail(doc, pointer_format(at, "%s/count", s->at), "VALUE_MULTIPLE_OF",
                         "%zu is not a multiple of 3.", s->count);
  if (s->count != view->length / s->stride || view->length % s->stride)
    return document_fail(doc, pointer_format(at, "%s/count", s->at), "VALUE_NOT_IN_RANGE",
                         "%zu elements of %zu bytes are not the byteLength %zu.", s->count,
                         s->stride, view->length);
  return CDL_OK;
}

static cdl_Status read_stream(Document *doc, const json_t *json, Stream *s) {
  uint32_t buffer = json_get_index(json, "buffer");
  size_t offset = (size_t)json_get_number(json, "byteOffset", 0);
  const Bytes *bytes = &doc->buffers[buffer];
  s->size = (size_t)json_get_number(json, "byteLength", 0);
  s->stride = (size_t)json_get_number(json, "byteStride", 0);
  s->count = (size_t)json_get_number(json, "count", 0);
  s->mode = (Mode)find_name(modes, json_get_string(json, "mode", "ATTRIBUTES"));
  s->filter = (Filter)find_name(filters, json_get_string(json, "filter", "NONE"));
  if (offset > bytes->size || s->size > bytes->size - offset)
    return document_fail(doc, AT("%s/byteLength", s->at), "BUFFER_VIEW_TOO_LONG",
                         "bytes %zu to %zu lie beyond buffer %u of %zu bytes.", offset,
                         offset + s->size, buffer, bytes->size);
  s->data = bytes->data ? bytes->data + offset : NULL;
  return CDL_OK;
}

/* The library decodes older versions of index streams as well; the extension has one alone. */
static int decode_stream(const Stream *s, uint8_t *out) {
  uint8_t header = s->data[0];
  switch (s->mode) {
  case MODE_TRIANGLES:
    return header == HEADER_TRIANGLES &&
           meshopt_decodeIndexBuffer(out, s->count, s->stride, s->data, s->size) == 0;
  case MODE_INDICES:
    return header == HEADER_INDICES &&
           meshopt_decodeIndexSequence(out, s->count, s->stride, s->data, s->size) == 0;
  default:
    if (header == HEADER_ATTRIBUTES_1 && s->is_khr)
      return meshopt_attributes(s->data, s->size, s->count, s->stride, out);
    return header == HEADER_ATTRIBUTES_0 &&
           meshopt_decodeVertexBuffer(out, s->count, s->stride, s->data, s->size) == 0;
  }
}

static void apply_filter(const Stream *s, uint8_t *data) {
  switch (s->filter) {
  case FILTER_OCTAHEDRAL:
    meshopt_octahedral(data, s->count, s->stride);
    break;
  case FILTER_QUATERNION:
    meshopt_quaternions(data, s->count);
    break;
  case FILTER_EXPONENTIAL:
    meshopt_exponential(data, s->count, s->stride);
    break;
  case FILTER_COLOR:
    meshopt_colors(data, s->count, s->stride);
    break;
  default:
    break;
  }
}

static cdl_Status decode_view(Document *doc, const Stream *s, BufferView *view) {
  cdl_Status status = document_charge(doc, s->at, s->size + view->length);
  if (status) return status;
  view->owned = malloc(view->length);
  if (!view->owned) return document_out_of_memory(doc);
  if (!decode_stream(s, view->owned))
    return document_fail(doc, s->at, "MESHOPT_DATA_INVALID",
                         "the compressed data are damaged, or not %zu elements in the mode %s.",
                         s->count, modes[s->mode]);
  apply_filter(s, view->owned);
  view->data = view->owned;
  view->lossy = s->filter != FILTER_NONE;
  return CDL_OK;
}

cdl_Status meshopt_view(Document *doc, uint32_t i, const json_t *json, BufferView *view) {
  for (int k = 0; k < 2; k++) {
    const json_t *extension = json_get_extension(json, names[k]);
    Stream stream = {.is_khr = k == 0, .at = AT("/bufferViews/%u/extensions/%s", i, names[k])};
    if (!extension) continue;
    cdl_Status status = read_stream(doc, extension, &stream);
    if (!status) status = check_stream(doc, &stream, view);
    return status || !stream.data ? status : decode_view(doc, &stream, view);
  }
  return CDL_OK;
}
