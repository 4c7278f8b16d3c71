/* uri.c: reads what a scene names: data URIs, and files below its own folder. */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <nettle/base64.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene/document.h"

#define FILE_LIMIT ((size_t)4 << 30)

static int read_all(int file, uint8_t *data, size_t size) {
  for (size_t at = 0; at < size;) {
    ssize_t n = read(file, data + at, size - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : EIO;
    at += (size_t)n;
  }
  return 0;
}

uint8_t *file_read(const char *path, size_t limit, size_t *size, int *error) {
  uint8_t *data = NULL;
  struct stat about;
  *error = 0;
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0 || fstat(file, &about)) {
    *error = errno;
  } else if (!S_ISREG(about.st_mode)) {
    *error = S_ISDIR(about.st_mode) ? EISDIR : EINVAL;
  } else if ((uint64_t)about.st_size > limit) {
    *error = EFBIG;
  } else {
    *size = (size_t)about.st_size;
    data = malloc(*size + 1);
    *error = data ? read_all(file, data, *size) : ENOMEM;
  }
  if (*error) {
    free(data);
    data = NULL;
  }
  if (file >= 0) close(file);
  return data;
}

/* A scheme is a letter, then letters, digits, + - . up to a colon (RFC 3986, section 3.1). */
int uri_is_remote(const char *uri) {
  if (strncasecmp(uri, "data:", 5) == 0) return 0;
  if (strncmp(uri, "//", 2) == 0) return 1;
  if (!isalpha((unsigned char)uri[0])) return 0;
  const char *c = uri;
  while (isalnum((unsigned char)*c) || *c == '+' || *c == '-' || *c == '.') c++;
  return *c == ':';
}

static int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  c = (char)tolower((unsigned char)c);
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Percent-decodes; returns NULL for a broken escape or an encoded NUL. Free the result. */
static char *uri_decode(const char *uri) {
  char *text = malloc(strlen(uri) + 1), *to = text;
  for (const char *c = uri; text && *c; c++) {
    if (*c != '%') {
      *to++ = *c;
      continue;
    }
    int high = hex_digit(c[1]), low = high < 0 ? -1 : hex_digit(c[2]);
    if (low < 0 || high * 16 + low == 0) {
      free(text);
      return NULL;
    }
    *to++ = (char)(high * 16 + low);
    c += 2;
  }
  if (text) *to = 0;
  return text;
}

static cdl_Status read_data_uri(Document *doc, const char *pointer, const char *uri, Bytes *bytes,
                                char media_type[64]) {
  const char *comma = strchr(uri, ','), *type = uri + 5;
  if (!comma || comma - uri < 12 || strncasecmp(comma - 7, ";base64", 7) != 0)
    return document_fail(doc, pointer, "INVALID_URI", "only data URIs in base64 are read.");
  if (media_type) snprintf(media_type, 64, "%.*s", (int)(strcspn(type, ";,")), type);
  const char *text = comma + 1;
  size_t length = strlen(text), size = BASE64_DECODE_LENGTH(length);
  struct base64_decode_ctx context;
  base64_decode_init(&context);
  uint8_t *data = malloc(size + 1);
  if (!data) return document_out_of_memory(doc);
  if (!base64_decode_update(&context, &size, data, length, text) ||
      !base64_decode_final(&context)) {
    free(data);
    return document_fail(doc, pointer, "INVALID_URI", "the data URI is not valid base64.");
  }
  *bytes = (Bytes){data, size, data};
  return CDL_OK;
}

/* realpath() resolves .. and symbolic links, so that comparing prefixes is enough. */
static cdl_Status contained_path(Document *doc, const char *pointer, const char *uri,
                                 char **resolved) {
  char joined[PATH_MAX], *decoded = uri_decode(uri);
  if (!decoded) return document_fail(doc, pointer, "INVALID_URI", "a percent escape is broken.");
  int length = snprintf(joined, sizeof joined, "%s/%s", doc->folder, decoded);
  int absolute = decoded[0] == '/';
  free(decoded);
  if (absolute || (size_t)length >= sizeof joined)
    return document_fail(doc, pointer, "INVALID_URI",
                         "only paths relative to the scene's folder are read.");
  *resolved = realpath(joined, NULL);
  if (!*resolved)
    return document_fail(doc, pointer, "IO_ERROR", "%.200s cannot be found: %s.", uri,
                         strerror(errno));
  size_t n = strlen(doc->folder);
  if (strncmp(*resolved, doc->folder, n) == 0 && ((*resolved)[n] == '/' || n == 1)) return CDL_OK;
  free(*resolved);
  *resolved = NULL;
  return document_fail(doc, pointer, "INVALID_URI",
                       "%.200s lies outside the scene's folder; move it below.", uri);
}

static cdl_Status read_relative(Document *doc, const char *pointer, const char *uri, Bytes *bytes) {
  char *path = NULL;
  cdl_Status status = contained_path(doc, pointer, uri, &path);
  if (status) return status;
  int error = 0;
  bytes->owned = file_read(path, FILE_LIMIT, &bytes->size, &error);
  bytes->data = bytes->owned;
  free(path);
  if (!bytes->data)
    return document_fail(doc, pointer, "IO_ERROR", "%.200s cannot be read: %s.", uri,
                         strerror(error));
  uint8_t length[8];
  for (int i = 0; i < 8; i++) length[i] = (uint8_t)((uint64_t)bytes->size >> 8 * i);
  sha256_update(&doc->hash, sizeof length, length);
  sha256_update(&doc->hash, bytes->size, bytes->data);
  return CDL_OK;
}

cdl_Status document_read_uri(Document *doc, const char *pointer, const char *uri, Bytes *bytes,
                             char media_type[64]) {
  *bytes = (Bytes){0};
  if (media_type) media_type[0] = 0;
  if (strncasecmp(uri, "data:", 5) == 0) return read_data_uri(doc, pointer, uri, bytes, media_type);
  if (strcspn(uri, ":") < strcspn(uri, "/") && !uri_is_remote(uri))
    return document_fail(doc, pointer, "INVALID_URI", "its scheme is empty or malformed.");
  if (uri_is_remote(uri))
    return document_fail(doc, pointer, "NON_RELATIVE_URI",
                         "%.200s is not read: only files beside the scene are.", uri);
  return read_relative(doc, pointer, uri, bytes);
}
