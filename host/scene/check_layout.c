/* check_layout.c: buffers, their views, and accessors: that every byte they promise is there. */
#include <stdlib.h>
#include <string.h>

#include "scene/accessor.h"
#include "scene/check.h"
#include "scene/compression.h"

/* What compressed data may take in memory: so much in any case, and so many times their own size.
 */
#define DECODE_FLOOR ((size_t)256 << 20)
#define DECODE_RATIO 64

/* An accessor without bytes behind it is zeros; this many are enough for anyone. */
#define MOST_ZEROS ((size_t)1 << 24)

static cdl_Status read_embedded(Document *doc, uint32_t i, Bytes *bytes) {
  if (!doc->bin.data)
    return document_fail(doc, AT("/buffers/%u", i), "BUFFER_MISSING_GLB_DATA",
                         "the file has no binary chunk.");
  *bytes = (Bytes){doc->bin.data, doc->bin.size, NULL};
  return CDL_OK;
}

static cdl_Status read_buffer(Document *doc, uint32_t i) {
  const json_t *buffer = json_array_get(json_object_get(doc->root, "buffers"), i);
  const char *uri = json_get_string(buffer, "uri", NULL), *at = AT("/buffers/%u/uri", i);
  double length = json_get_number(buffer, "byteLength", 0);
  Bytes *bytes = &doc->buffers[i];
  char type[64] = "";
  if (compression_is_fallback(buffer)) {
    bytes->size = (size_t)length;
    return CDL_OK;
  }
  if (uri && uri_is_remote(uri)) {
    document_note(doc, NULL, at, "NON_RELATIVE_URI: nothing is fetched from the network.");
    bytes->size = (size_t)length;
    return CDL_OK;
  }
  /* A buffer may come without data, for an extension to fill. */
  if (!uri && (i > 0 || !doc->is_binary)) {
    bytes->size = (size_t)length;
    return CDL_OK;
  }
  cdl_Status status =
      uri ? document_read_uri(doc, at, uri, bytes, type) : read_embedded(doc, i, bytes);
  if (status) return status;
  if (*type && strcasecmp(type, "application/octet-stream") != 0 &&
      strcasecmp(type, "application/gltf-buffer") != 0)
    return document_fail(doc, at, "BUFFER_DATA_URI_MIME_TYPE_INVALID",
                         "the media type %s is not one for buffers.", type);
  if ((double)bytes->size < length || (!uri && (double)bytes->size > length + 3))
    return document_fail(doc, AT("/buffers/%u", i), "BUFFER_BYTE_LENGTH_MISMATCH",
                         "byteLength is %.0f, but there are %zu bytes.", length, bytes->size);
  bytes->size = (size_t)length;
  return CDL_OK;
}

static cdl_Status check_stride(Document *doc, uint32_t i, const BufferView *view) {
  const char *at = AT("/bufferViews/%u/byteStride", i);
  if (view->stride % 4)
    return document_fail(doc, at, "VALUE_MULTIPLE_OF", "%u is not a multiple of 4.", view->stride);
  if (view->stride && view->target == 34963)
    return document_fail(doc, at, "BUFFER_VIEW_INVALID_BYTE_STRIDE",
                         "only vertex attributes may have a stride.");
  return CDL_OK;
}

static cdl_Status read_view(Document *doc, uint32_t i) {
  const json_t *json = json_array_get(json_object_get(doc->root, "bufferViews"), i);
  BufferView *view = &doc->views[i];
  view->buffer = json_get_index(json, "buffer");
  view->offset = (size_t)json_get_number(json, "byteOffset", 0);
  view->length = (size_t)json_get_number(json, "byteLength", 0);
  view->stride = (uint32_t)json_get_number(json, "byteStride", 0);
  view->target = (uint32_t)json_get_number(json, "target", 0);
  const Bytes *buffer = &doc->buffers[view->buffer];
  if (view->offset > buffer->size || view->length > buffer->size - view->offset) {
    const char *member = view->offset > buffer->size ? "byteOffset" : "byteLength";
    return document_fail(doc, AT("/bufferViews/%u/%s", i, member), "BUFFER_VIEW_TOO_LONG",
                         "bytes %zu to %zu lie beyond buffer %u of %zu bytes.", view->offset,
                         view->offset + view->length, view->buffer, buffer->size);
  }
  view->data = buffer->data ? buffer->data + view->offset : NULL;
  cdl_Status status = check_stride(doc, i, view);
  return status ? status : meshopt_view(doc, i, json, view);
}

cdl_Status check_buffers(Document *doc) {
  uint32_t buffers = (uint32_t)json_array_size(json_object_get(doc->root, "buffers"));
  uint32_t views = (uint32_t)json_array_size(json_object_get(doc->root, "bufferViews"));
  doc->buffers = calloc(buffers + 1, sizeof *doc->buffers);
  doc->views = calloc(views + 1, sizeof *doc->views);
  if (!doc->buffers || !doc->views) return document_out_of_memory(doc);
  doc->buffer_count = buffers;
  doc->view_count = views;
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < buffers && !status; i++) status = read_buffer(doc, i);
  doc->decode_left = DECODE_FLOOR;
  for (uint32_t i = 0; i < buffers; i++)
    if (doc->buffers[i].data) doc->decode_left += DECODE_RATIO * doc->buffers[i].size;
  for (uint32_t i = 0; i < views && !status; i++) status = read_view(doc, i);
  return status;
}

/* Whether `count` elements `stride` apart, the last of them `size` long, fit into a view. */
static cdl_Status check_range(Document *doc, const char *at, uint32_t view, size_t offset,
                              size_t count, size_t stride, size_t size) {
  size_t length = doc->views[view].length, room = length - offset;
  if (offset <= length && size <= room && count - 1 <= (room - size) / stride) return CDL_OK;
  return document_fail(doc, at, "ACCESSOR_TOO_LONG",
                       "%zu elements of %zu bytes, %zu apart from byte %zu, run past bufferView "
                       "%u of %zu bytes.",
                       count, size, stride, offset, view, length);
}

static cdl_Status check_dense(Document *doc, uint32_t i, Accessor *a) {
  const BufferView *view = &doc->views[a->view];
  size_t size = accessor_element_size(a), component = component_size(a->component);
  size_t packed = accessor_packed_size(a);
  if (view->stride && view->stride < packed)
    return document_fail(doc, AT("/accessors/%u", i), "ACCESSOR_SMALL_BYTESTRIDE",
                         "the stride %u is smaller than an element of %zu bytes.", view->stride,
                         size);
  if (a->offset % component)
    return document_fail(doc, AT("/accessors/%u/byteOffset", i), "ACCESSOR_OFFSET_ALIGNMENT",
                         "%zu is not a multiple of the component's %zu bytes.", a->offset,
                         component);
  if ((a->offset + view->offset) % component)
    return document_fail(doc, AT("/accessors/%u", i), "ACCESSOR_TOTAL_OFFSET_ALIGNMENT",
                         "its first byte is not at a multiple of the component's %zu bytes.",
                         component);
  a->stride = view->stride ? view->stride : packed;
  a->data = view->data ? view->data + a->offset : NULL;
  a->lossy = view->lossy;
  return check_range(doc, AT("/accessors/%u", i), a->view, a->offset, a->count, a->stride, size);
}

static cdl_Status check_sparse_order(Document *doc, uint32_t i, const Accessor *a) {
  const uint8_t *data = doc->views[a->sparse_view].data + a->sparse_offset;
  const char *at = AT("/accessors/%u/sparse/indices", i);
  for (size_t k = 0; k < a->sparse_count; k++) {
    uint32_t index = read_unsigned(data, a->sparse_component, k);
    if (index >= a->count)
      return document_fail(doc, at, "ACCESSOR_SPARSE_INDEX_OOB",
                           "index %zu is %u, but there are %zu elements.", k, index, a->count);
    if (k && index <= read_unsigned(data, a->sparse_component, k - 1))
      return document_fail(doc, at, "ACCESSOR_SPARSE_INDICES_NON_INCREASING",
                           "index %zu is %u, no more than the one before.", k, index);
  }
  return CDL_OK;
}

static cdl_Status read_sparse(Document *doc, uint32_t i, const json_t *sparse, Accessor *a) {
  const json_t *indices = json_object_get(sparse, "indices");
  const json_t *values = json_object_get(sparse, "values");
  double count = json_get_number(sparse, "count", 0);
  if (count > (double)a->count)
    return document_fail(doc, AT("/accessors/%u/sparse/count", i),
                         "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
                         "%.0f is more than the accessor's %zu elements.", count, a->count);
  a->sparse_count = (size_t)count;
  a->sparse_view = json_get_index(indices, "bufferView");
  a->sparse_offset = (size_t)json_get_number(indices, "byteOffset", 0);
  a->sparse_component = json_get_index(indices, "componentType");
  a->values_view = json_get_index(values, "bufferView");
  a->values_offset = (size_t)json_get_number(values, "byteOffset", 0);
  size_t size = component_size(a->sparse_component), element = accessor_element_size(a);
  size_t packed = accessor_packed_size(a);
  cdl_Status status = check_range(doc, AT("/accessors/%u/sparse/indices", i), a->sparse_view,
                                  a->sparse_offset, a->sparse_count, size, size);
  if (!status)
    status = check_range(doc, AT("/accessors/%u/sparse/values", i), a->values_view,
                         a->values_offset, a->sparse_count, packed, element);
  if (status || !accessor_has_data(doc, a)) return status;
  return check_sparse_order(doc, i, a);
}

static void read_type(const char *type, Accessor *a) {
  static const struct {
    const char *name;
    uint32_t width, columns;
  } types[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
               {"MAT2", 4, 2},   {"MAT3", 9, 3}, {"MAT4", 16, 4}};
  for (size_t k = 0; k < sizeof types / sizeof *types; k++)
    if (strcmp(type, types[k].name) == 0) a->width = types[k].width, a->columns = types[k].columns;
}

static cdl_Status check_bounds(Document *doc, uint32_t i, const json_t *json, const Accessor *a) {
  static const char *const names[] = {"min", "max"};
  for (int k = 0; k < 2; k++) {
    const json_t *bound = json_object_get(json, names[k]);
    if (bound && json_array_size(bound) != a->width)
      return document_fail(doc, AT("/accessors/%u/%s", i, names[k]), "ARRAY_LENGTH_NOT_IN_LIST",
                           "it must have %u numbers.", a->width);
  }
  return CDL_OK;
}

static cdl_Status read_accessor(Document *doc, uint32_t i) {
  const json_t *json = json_array_get(json_object_get(doc->root, "accessors"), i);
  const json_t *sparse = json_object_get(json, "sparse");
  Accessor *a = &doc->accessors[i];
  read_type(json_get_string(json, "type", ""), a);
  a->view = json_get_index(json, "bufferView");
  a->component = json_get_index(json, "componentType");
  a->count = (size_t)json_get_number(json, "count", 0);
  a->offset = (size_t)json_get_number(json, "byteOffset", 0);
  a->source = DOCUMENT_NONE;
  a->normalized = json_is_true(json_object_get(json, "normalized"));
  const char *at = AT("/accessors/%u", i);
  if (a->normalized && a->component >= GL_UNSIGNED_INT)
    return document_fail(doc, at, "ACCESSOR_NORMALIZED_INVALID",
                         "only 8 and 16 bit integers can be normalised.");
  if (a->view == DOCUMENT_NONE && json_object_get(json, "byteOffset"))
    return document_fail(doc, AT("/accessors/%u/byteOffset", i), "UNSATISFIED_DEPENDENCY",
                         "it needs a bufferView.");
  cdl_Status status = check_bounds(doc, i, json, a);
  if (!status && a->view != DOCUMENT_NONE) status = check_dense(doc, i, a);
  if (!status && sparse) status = read_sparse(doc, i, sparse, a);
  return status;
}

static cdl_Status check_zeros(Document *doc) {
  for (uint32_t i = 0; i < doc->accessor_count; i++) {
    const Accessor *a = &doc->accessors[i];
    if (a->view == DOCUMENT_NONE && !a->data && a->count > MOST_ZEROS)
      return document_fail(doc, AT("/accessors/%u", i), "ACCESSOR_TOO_LONG",
                           "%zu elements without a bufferView are too many.", a->count);
  }
  return CDL_OK;
}

cdl_Status check_accessors(Document *doc) {
  uint32_t count = (uint32_t)json_array_size(json_object_get(doc->root, "accessors"));
  doc->accessors = calloc(count + 1, sizeof *doc->accessors);
  if (!doc->accessors) return document_out_of_memory(doc);
  doc->accessor_count = count;
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < count && !status; i++) status = read_accessor(doc, i);
  if (!status) status = draco_primitives(doc);
  return status ? status : check_zeros(doc);
}
