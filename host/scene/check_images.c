/* check_images.c: encoded pictures: where they lie, and of what kind they are. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scene/check.h"

typedef enum Kind { KIND_OTHER, KIND_PNG, KIND_JPEG, KIND_WEBP, KIND_KTX2 } Kind;

static const char *const media_types[] = {"", "image/png", "image/jpeg", "image/webp",
                                          "image/ktx2"};

static Kind image_kind(const Bytes *bytes) {
  const uint8_t *d = bytes->data;
  if (bytes->size >= 8 && memcmp(d, "\x89PNG\r\n\x1a\n", 8) == 0) return KIND_PNG;
  if (bytes->size >= 3 && memcmp(d, "\xff\xd8\xff", 3) == 0) return KIND_JPEG;
  if (bytes->size >= 12 && memcmp(d, "RIFF", 4) == 0 && memcmp(d + 8, "WEBP", 4) == 0)
    return KIND_WEBP;
  if (bytes->size >= 12 && memcmp(d, "\xabKTX 20\xbb\r\n\x1a\n", 12) == 0) return KIND_KTX2;
  return KIND_OTHER;
}

/* The segments of a JPEG up to its frame header: each must be as long as it says. */
static int jpeg_header_holds(const Bytes *bytes) {
  const uint8_t *d = bytes->data;
  for (size_t at = 2; at + 4 <= bytes->size;) {
    if (d[at] != 0xff) return 0;
    uint8_t marker = d[at + 1];
    if (marker == 0xff) {
      at++;
      continue;
    }
    size_t length = (size_t)d[at + 2] << 8 | d[at + 3];
    if (length < 2 || length > bytes->size - at - 2) return 0;
    int frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return length >= 8;
    at += 2 + length;
  }
  return 0;
}

static int header_holds(Kind kind, const Bytes *bytes) {
  if (kind == KIND_JPEG) return jpeg_header_holds(bytes);
  if (kind == KIND_PNG) return bytes->size >= 33 && memcmp(bytes->data + 12, "IHDR", 4) == 0;
  return 1;
}

static cdl_Status read_embedded(Document *doc, uint32_t i, uint32_t view, Bytes *bytes) {
  if (doc->views[view].stride)
    return document_fail(doc, AT("/images/%u/bufferView", i), "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE",
                         "a bufferView with an image cannot have a stride.");
  const BufferView *v = &doc->views[view];
  if (v->data) *bytes = (Bytes){v->data, v->length, NULL};
  return CDL_OK;
}

static cdl_Status check_kind(Document *doc, uint32_t i, const json_t *json, const char *uri_type,
                             Bytes *bytes) {
  Kind kind = bytes->data ? image_kind(bytes) : KIND_OTHER;
  const char *declared = json_get_string(json, "mimeType", ""), *actual = media_types[kind];
  if (!bytes->data) return CDL_OK;
  if (kind == KIND_OTHER) {
    document_note(doc, NULL, AT("/images/%u", i),
                  "IMAGE_UNRECOGNIZED_FORMAT: it is none of PNG, JPEG, WebP and KTX2.");
    free(bytes->owned);
    *bytes = (Bytes){0};
    return CDL_OK;
  }
  if (*uri_type && strcasecmp(uri_type, actual) != 0)
    return document_fail(doc, AT("/images/%u/uri", i), "INVALID_URI",
                         "the media type is %s, but the data are %s.", uri_type, actual);
  if (*declared && strcasecmp(declared, actual) != 0)
    return document_fail(doc, AT("/images/%u/mimeType", i), "IMAGE_MIME_TYPE_INVALID",
                         "it is %s, but the data are %s.", declared, actual);
  if (!header_holds(kind, bytes))
    return document_fail(doc, AT("/images/%u", i), "IMAGE_DATA_INVALID",
                         "the header of the picture is damaged.");
  if (kind == KIND_KTX2) {
    free(bytes->owned);
    *bytes = (Bytes){.size = bytes->size};
  }
  return CDL_OK;
}

static cdl_Status read_image(Document *doc, uint32_t i) {
  const json_t *json = json_array_get(json_object_get(doc->root, "images"), i);
  const char *uri = json_get_string(json, "uri", NULL), *at = AT("/images/%u/uri", i);
  uint32_t view = json_get_index(json, "bufferView");
  char type[64] = "";
  if ((uri != NULL) == (view != DOCUMENT_NONE))
    return document_fail(doc, AT("/images/%u", i), uri ? "ONE_OF_MISMATCH" : "UNDEFINED_PROPERTY",
                         "either uri or bufferView must be given.");
  if (view != DOCUMENT_NONE && !json_object_get(json, "mimeType"))
    return document_fail(doc, AT("/images/%u/bufferView", i), "UNSATISFIED_DEPENDENCY",
                         "it needs a mimeType.");
  if (uri && uri_is_remote(uri)) {
    document_note(doc, NULL, at, "NON_RELATIVE_URI: nothing is fetched from the network.");
    return CDL_OK;
  }
  cdl_Status status = uri ? document_read_uri(doc, at, uri, &doc->images[i], type)
                          : read_embedded(doc, i, view, &doc->images[i]);
  return status ? status : check_kind(doc, i, json, type, &doc->images[i]);
}

cdl_Status check_images(Document *doc) {
  uint32_t count = (uint32_t)json_array_size(json_object_get(doc->root, "images"));
  doc->images = calloc(count + 1, sizeof *doc->images);
  if (!doc->images) return document_out_of_memory(doc);
  doc->image_count = count;
  cdl_Status status = CDL_OK;
  for (uint32_t i = 0; i < count && !status; i++) status = read_image(doc, i);
  return status;
}
