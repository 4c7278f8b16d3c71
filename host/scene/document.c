#include "scene/document.h"

#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/log.h"

#define FILE_LIMIT ((size_t)4 << 30)
#define GLB_JSON 0x4e4f534au
#define GLB_BIN 0x004e4942u

cdl_Status document_fail(const Document *doc, const char *pointer, const char *code,
                         const char *format, ...) {
  char words[1024];
  va_list args;
  va_start(args, format);
  vsnprintf(words, sizeof words, format, args);
  va_end(args);
  return log_fail(doc->log, CDL_BAD_INPUT, "%s: %s: %s: %s", doc->path, *pointer ? pointer : "/",
                  code, words);
}

void document_note(const Document *doc, const char *key, const char *pointer, const char *format,
                   ...) {
  if (key && json_object_get(doc->seen, key)) return;
  if (key) json_object_set_new(doc->seen, key, json_true());
  char words[1024];
  va_list args;
  va_start(args, format);
  vsnprintf(words, sizeof words, format, args);
  va_end(args);
  log_note(doc->log, "%s: %s: %s", doc->path, *pointer ? pointer : "/", words);
}

cdl_Status document_charge(Document *doc, const char *pointer, size_t bytes) {
  if (bytes > doc->decode_left)
    return document_fail(doc, pointer, "DECOMPRESSED_DATA_TOO_LARGE",
                         "%zu bytes more than the %zu that the compressed data of this file may "
                         "still take; split it, or export it without compression.",
                         bytes - doc->decode_left, doc->decode_left);
  doc->decode_left -= bytes;
  return CDL_OK;
}

cdl_Status document_out_of_memory(const Document *doc) {
  return log_fail(doc->log, CDL_BAD_INPUT, "%s: there is not enough memory for this scene.",
                  doc->path);
}

char *pointer_format(char *text, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(text, 256, format, args);
  va_end(args);
  return text;
}

static uint32_t read_u32(const uint8_t *p) {
  return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

/* One chunk of a GLB at *at; moves *at past it. */
static cdl_Status glb_chunk(Document *doc, size_t *at, int first, Bytes *json) {
  const uint8_t *data = doc->file.data;
  size_t left = doc->file.size - *at, offset = *at;
  if (left < 8)
    return document_fail(doc, AT("@%zu", doc->file.size), "GLB_UNEXPECTED_END_OF_CHUNK_HEADER",
                         "the file ends within a chunk header; it is cut short.");
  uint32_t length = read_u32(data + offset), type = read_u32(data + offset + 4);
  if (first && type != GLB_JSON)
    return document_fail(doc, AT("@%zu", offset), "GLB_UNEXPECTED_FIRST_CHUNK",
                         "the first chunk has type 0x%08x, not JSON.", type);
  if (type == GLB_JSON && length == 0)
    return document_fail(doc, AT("@%zu", offset), "GLB_EMPTY_CHUNK", "the JSON chunk is empty.");
  if (length > left - 8)
    return document_fail(doc, AT("@%zu", doc->file.size), "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
                         "a chunk of %u bytes runs past the end; the file is cut short.", length);
  if (length % 4)
    return document_fail(doc, AT("@%zu", offset), "GLB_CHUNK_LENGTH_UNALIGNED",
                         "the chunk length %u is not a multiple of 4.", length);
  Bytes *slot = type == GLB_JSON ? json : type == GLB_BIN ? &doc->bin : NULL;
  if (slot && slot->data)
    return document_fail(doc, AT("@%zu", offset), "GLB_DUPLICATE_CHUNK",
                         "a chunk of type 0x%08x came before.", type);
  if (slot)
    *slot = (Bytes){data + offset + 8, length, NULL};
  else
    document_note(doc, NULL, AT("@%zu", offset), "a chunk of type 0x%08x is left out.", type);
  *at = offset + 8 + length;
  return CDL_OK;
}

/* The frame of a GLB: glTF 2.0, section 4.4. */
static cdl_Status glb_open(Document *doc, Bytes *json) {
  const uint8_t *data = doc->file.data;
  size_t size = doc->file.size;
  if (size < 12)
    return document_fail(doc, AT("@%zu", size), "GLB_UNEXPECTED_END_OF_HEADER",
                         "the file ends within its header.");
  if (memcmp(data, "glTF", 4) != 0)
    return document_fail(doc, "@0", "GLB_INVALID_MAGIC",
                         "the file does not begin with \"glTF\"; it is no GLB.");
  if (read_u32(data + 4) != 2)
    return document_fail(doc, "@4", "GLB_INVALID_VERSION", "version %u of GLB is not supported.",
                         read_u32(data + 4));
  uint32_t length = read_u32(data + 8);
  if (length < 12)
    return document_fail(doc, "@8", "GLB_LENGTH_TOO_SMALL", "the declared length is %u.", length);
  cdl_Status status = CDL_OK;
  size_t at = 12;
  for (int first = 1; first || (at < size && at < length); first = 0) {
    status = glb_chunk(doc, &at, first, json);
    if (status) return status;
  }
  if (length != size)
    return document_fail(doc, AT("@%zu", size), "GLB_LENGTH_MISMATCH",
                         "the declared length is %u, the file has %zu bytes.", length, size);
  return CDL_OK;
}

/* A parser that refuses numbers beyond double says so with the code for a range. */
static cdl_Status parse_json(Document *doc, Bytes text) {
  json_error_t error;
  doc->root = json_loadb((const char *)text.data, text.size, JSON_DECODE_INT_AS_REAL, &error);
  if (!doc->root) {
    int range = json_error_code(&error) == json_error_numeric_overflow;
    return document_fail(doc, "", range ? "VALUE_NOT_IN_RANGE" : "INVALID_JSON",
                         "line %d, column %d: %s.", error.line, error.column, error.text);
  }
  if (!json_is_object(doc->root))
    return document_fail(doc, "", "TYPE_MISMATCH", "the JSON is not an object.");
  return CDL_OK;
}

static int has_suffix(const char *path, const char *suffix) {
  size_t n = strlen(path), m = strlen(suffix);
  return n >= m && strcasecmp(path + n - m, suffix) == 0;
}

static char *canonical_folder(const char *path) {
  char *copy = strdup(path), *folder = NULL;
  if (copy) folder = realpath(dirname(copy), NULL);
  free(copy);
  return folder;
}

cdl_Status document_open(const cdl_Log *log, const char *path, Document *doc) {
  *doc = (Document){.log = log, .path = strdup(path), .seen = json_object()};
  int error = 0;
  if (!doc->path || !doc->seen)
    return log_fail(log, CDL_BAD_INPUT, "%s: there is not enough memory.", path);
  doc->file.owned = file_read(path, FILE_LIMIT, &doc->file.size, &error);
  doc->file.data = doc->file.owned;
  if (!doc->file.data)
    return document_fail(doc, "", "IO_ERROR", "it cannot be read: %s.",
                         error == EINVAL ? "not a regular file" : strerror(error));
  doc->folder = canonical_folder(path);
  if (!doc->folder)
    return document_fail(doc, "", "IO_ERROR", "its folder cannot be found: %s.", strerror(errno));
  sha256_init(&doc->hash);
  sha256_update(&doc->hash, doc->file.size, doc->file.data);
  Bytes text = doc->file;
  doc->is_binary =
      has_suffix(path, ".glb") || (text.size >= 4 && memcmp(text.data, "glTF", 4) == 0);
  if (doc->is_binary) {
    text = (Bytes){0};
    cdl_Status status = glb_open(doc, &text);
    if (status) return status;
  }
  return parse_json(doc, text);
}

static void free_bytes(Bytes *list, uint32_t count) {
  for (uint32_t i = 0; list && i < count; i++) free(list[i].owned);
  free(list);
}

void document_close(Document *doc) {
  free_bytes(doc->buffers, doc->buffer_count);
  free_bytes(doc->images, doc->image_count);
  for (uint32_t i = 0; i < doc->view_count; i++) free(doc->views[i].owned);
  for (uint32_t i = 0; i < doc->accessor_count; i++) free(doc->accessors[i].owned);
  free(doc->views);
  free(doc->accessors);
  free(doc->file.owned);
  free(doc->folder);
  free(doc->path);
  json_decref(doc->root);
  json_decref(doc->seen);
  *doc = (Document){0};
}

double json_get_number(const json_t *object, const char *name, double otherwise) {
  const json_t *value = json_object_get(object, name);
  return json_is_number(value) ? json_number_value(value) : otherwise;
}

uint32_t json_get_index(const json_t *object, const char *name) {
  const json_t *value = json_object_get(object, name);
  return json_is_number(value) ? (uint32_t)json_number_value(value) : DOCUMENT_NONE;
}

const char *json_get_string(const json_t *object, const char *name, const char *otherwise) {
  const json_t *value = json_object_get(object, name);
  return json_is_string(value) ? json_string_value(value) : otherwise;
}

json_t *json_get_extension(const json_t *object, const char *name) {
  return json_object_get(json_object_get(object, "extensions"), name);
}

void json_get_numbers(const json_t *object, const char *name, unsigned count, float *values) {
  const json_t *value = json_object_get(object, name);
  for (unsigned i = 0; i < count; i++) {
    const json_t *one = json_is_array(value) ? json_array_get(value, i) : value;
    if (json_is_number(one)) values[i] = (float)json_number_value(one);
  }
}
