/* Decoding what is damaged, unusual or hostile: one message with the validator's code, no picture,
 * nothing printed, little memory; and PNG's many layouts, made here byte by byte. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "image/aov.h"
#include "image/image.h"
#include "image/image_file.h"
#include "image/image_write.h"

#define SIDE 48
#define FIXTURES "../shared/badinput/validator/"

typedef struct {
  unsigned char bytes[4096];
  size_t size;
} Bytes;

static char last_message[2048];
static int message_count;

static void keep_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  (void)level;
  snprintf(last_message, sizeof last_message, "%s", message);
  message_count++;
}

static const cdl_Log test_log = {keep_message, NULL};

static void expect_refused(const void *bytes, size_t size, const char *code) {
  cdl_Image *image = (cdl_Image *)&test_log;
  message_count = 0;
  assert_int_equal(image_decode(&test_log, "scene.gltf: /images/0", bytes, size, &image),
                   CDL_BAD_INPUT);
  assert_null(image);
  assert_int_equal(message_count, 1);
  assert_ptr_equal(strstr(last_message, "scene.gltf: /images/0: "), last_message);
  assert_non_null(strstr(last_message, code));
}

/* Standard error goes into a file meanwhile. */
static int saved_stderr;
static FILE *captured;

static void capture_stderr(void) {
  fflush(stderr);
  captured = tmpfile();
  assert_non_null(captured);
  saved_stderr = dup(STDERR_FILENO);
  dup2(fileno(captured), STDERR_FILENO);
}

static long release_stderr(void) {
  fflush(stderr);
  dup2(saved_stderr, STDERR_FILENO);
  close(saved_stderr);
  const long printed = lseek(fileno(captured), 0, SEEK_END);
  fclose(captured);
  return printed;
}

/* A noisy picture, so that every format needs a few thousand bytes. */
static unsigned char *encode(const char *suffix, size_t *size) {
  static float rgb[SIDE * SIDE * 3];
  char path[64];
  unsigned char *bytes;
  uint32_t seed = 1;
  for (int i = 0; i < SIDE * SIDE * 3; i++)
    rgb[i] = (float)((seed = seed * 1664525u + 1013904223u) >> 8) / 16777216.0f;
  snprintf(path, sizeof path, "/tmp/candela_damage_%ld%s", (long)getpid(), suffix);
  assert_int_equal(image_write(&test_log, path, SIDE, SIDE, rgb, NULL, NULL, 0), CDL_OK);
  assert_int_equal(image_file_read(&test_log, path, 1 << 20, &bytes, size), CDL_OK);
  remove(path);
  return bytes;
}

/* A copy of exactly `size` bytes, so that a sanitizer sees a read past its end. */
static void expect_truncation_refused(const unsigned char *bytes, size_t size) {
  unsigned char *copy = malloc(size);
  assert_non_null(copy);
  memcpy(copy, bytes, size);
  expect_refused(copy, size, "IMAGE_");
  free(copy);
}

static void truncations_are_refused(void **state) {
  (void)state;
  static const char *const suffixes[] = {".png", ".jpg", ".exr", ".hdr"};
  for (int f = 0; f < 4; f++) {
    size_t size;
    unsigned char *bytes = encode(suffixes[f], &size);
    assert_true(size > 2000);
    capture_stderr();
    for (size_t at = 1; at < size; at += at < 64 ? 1 : 64) expect_truncation_refused(bytes, at);
    expect_truncation_refused(bytes, size - 1);
    assert_int_equal(release_stderr(), 0);
    free(bytes);
  }
}

/* Damage in the middle may go unnoticed by a format without checksums; it never does worse. */
static void flipped_bits_do_no_harm(void **state) {
  (void)state;
  static const char *const suffixes[] = {".png", ".jpg", ".exr", ".hdr"};
  uint32_t seed = 7;
  for (int f = 0; f < 4; f++) {
    size_t size;
    unsigned char *bytes = encode(suffixes[f], &size);
    capture_stderr();
    for (int trial = 0; trial < 400; trial++) {
      seed = seed * 1664525u + 1013904223u;
      const size_t range = trial & 1 && size > 400 ? 400 : size, at = (seed >> 8) % range;
      const unsigned char bit = (unsigned char)(1u << (seed >> 5 & 7));
      cdl_Image *image;
      message_count = 0;
      bytes[at] ^= bit;
      const cdl_Status status = image_decode(&test_log, "x", bytes, size, &image);
      bytes[at] ^= bit;
      assert_int_equal(status, image ? CDL_OK : CDL_BAD_INPUT);
      assert_int_equal(message_count, image ? 0 : 1);
      image_free(image);
    }
    assert_int_equal(release_stderr(), 0);
    free(bytes);
  }
}

/* ---- PNG by hand: stored deflate blocks, CRC 32 and Adler 32 as RFC 1950 and the PNG say ---- */

static void put(Bytes *out, const void *bytes, size_t size) {
  assert_true(out->size + size <= sizeof out->bytes);
  memcpy(out->bytes + out->size, bytes, size);
  out->size += size;
}

static void put32(Bytes *out, uint32_t x) {
  const unsigned char bytes[4] = {(unsigned char)(x >> 24), (unsigned char)(x >> 16),
                                  (unsigned char)(x >> 8), (unsigned char)x};
  put(out, bytes, 4);
}

static void put_chunk(Bytes *out, const char *type, const void *body, size_t size) {
  put32(out, (uint32_t)size);
  const size_t start = out->size;
  put(out, type, 4);
  put(out, body, size);
  uint32_t crc = 0xffffffffu;
  for (size_t i = start; i < out->size; i++) {
    crc ^= out->bytes[i];
    for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  put32(out, ~crc);
}

static void put_stored(Bytes *out, const unsigned char *data, size_t size) {
  Bytes stream = {.size = 0};
  const unsigned char head[7] = {0x78,
                                 0x01,
                                 1,
                                 (unsigned char)size,
                                 (unsigned char)(size >> 8),
                                 (unsigned char)~size,
                                 (unsigned char)(~size >> 8)};
  uint32_t a = 1, b = 0;
  for (size_t i = 0; i < size; i++) {
    a = (a + data[i]) % 65521;
    b = (b + a) % 65521;
  }
  put(&stream, head, 7);
  put(&stream, data, size);
  put32(&stream, b << 16 | a);
  put_chunk(out, "IDAT", stream.bytes, stream.size);
}

static void put_png_header(Bytes *out, uint32_t width, uint32_t height, int depth, int colour) {
  Bytes header = {.size = 0};
  const unsigned char rest[5] = {(unsigned char)depth, (unsigned char)colour, 0, 0, 0};
  put32(&header, width);
  put32(&header, height);
  put(&header, rest, 5);
  put(out, "\x89PNG\r\n\x1a\n", 8);
  put_chunk(out, "IHDR", header.bytes, header.size);
}

/* One row of pixels: `row` starts with its filter byte, 0. `key` is a tRNS chunk, `palette` PLTE.
 */
static cdl_Image *decode_row(uint32_t width, int depth, int colour, const Bytes *palette,
                             const Bytes *key, const unsigned char *row, size_t size) {
  Bytes png = {.size = 0};
  cdl_Image *image;
  put_png_header(&png, width, 1, depth, colour);
  if (palette) put_chunk(&png, "PLTE", palette->bytes, palette->size);
  if (key) put_chunk(&png, "tRNS", key->bytes, key->size);
  put_stored(&png, row, size);
  put_chunk(&png, "IEND", "", 0);
  assert_int_equal(image_decode(&test_log, "x.png", png.bytes, png.size, &image), CDL_OK);
  assert_int_equal(image->width, width);
  assert_int_equal(image->height, 1);
  return image;
}

static void png_layouts_become_rgba(void **state) {
  (void)state;
  const Bytes palette = {{10, 20, 30, 40, 50, 60}, 6}, alphas = {{128}, 1}, key = {{0, 7}, 2};
  /* 1-bit grey */
  cdl_Image *image = decode_row(3, 1, 0, NULL, NULL, (const unsigned char[]){0, 0xa0}, 2);
  assert_memory_equal(image->u8, "\xff\xff\xff\xff\0\0\0\xff\xff\xff\xff\xff", 12);
  image_free(image);
  /* palette of two, the first half transparent */
  image = decode_row(2, 8, 3, &palette, &alphas, (const unsigned char[]){0, 1, 0}, 3);
  assert_memory_equal(image->u8, "\x28\x32\x3c\xff\x0a\x14\x1e\x80", 8);
  image_free(image);
  /* grey 7 is transparent */
  image = decode_row(2, 8, 0, NULL, &key, (const unsigned char[]){0, 7, 8}, 3);
  assert_memory_equal(image->u8, "\7\7\7\0\x8\x8\x8\xff", 8);
  image_free(image);
  /* grey and alpha */
  image = decode_row(1, 8, 4, NULL, NULL, (const unsigned char[]){0, 9, 0}, 3);
  assert_memory_equal(image->u8, "\x9\x9\x9\0", 4);
  image_free(image);
  /* RGBA keeps its colours where it is transparent */
  image = decode_row(1, 8, 6, NULL, NULL, (const unsigned char[]){0, 200, 100, 50, 0}, 5);
  assert_memory_equal(image->u8, "\xc8\x64\x32\0", 4);
  image_free(image);
}

static void png_of_16_bits_becomes_float(void **state) {
  (void)state;
  const unsigned char row[] = {0, 0x80, 0x01, 0xff, 0xff, 0x00, 0x01};
  cdl_Image *image = decode_row(1, 16, 2, NULL, NULL, row, sizeof row);
  assert_null(image->u8);
  assert_true(image->encoded);
  assert_true(image->f32[0] == 32769.0f / 65535.0f && image->f32[1] == 1.0f);
  assert_true(image->f32[2] == 1.0f / 65535.0f && image->f32[3] == 1.0f);
  image_free(image);
}

/* ---- hostile headers ---- */

static void huge_pictures_are_refused_cheaply(void **state) {
  (void)state;
  static const uint32_t sides[3] = {65535, 22000, 0x7fffffff};
  for (int i = 0; i < 3; i++) {
    Bytes png = {.size = 0};
    put_png_header(&png, sides[i], sides[i], 8, 6);
    put_stored(&png, (const unsigned char *)"", 0);
    put_chunk(&png, "IEND", "", 0);
    expect_refused(png.bytes, png.size, "IMAGE_DATA_INVALID");
  }
  size_t size, patched = 0;
  unsigned char *bytes = encode(".jpg", &size);
  for (size_t at = 2; at + 9 < size; at++) /* the frame header, SOF0 */
    if (bytes[at] == 0xff && bytes[at + 1] == 0xc0) {
      memset(bytes + at + 5, 0xff, 4);
      expect_refused(bytes, size, "IMAGE_DATA_INVALID");
      memcpy(bytes + at + 5, "\x55\xf0\x55\xf0", 4); /* 22000 squared */
      expect_refused(bytes, size, "IMAGE_DATA_INVALID");
      patched++;
      break;
    }
  free(bytes);
  bytes = encode(".exr", &size);
  for (size_t at = 8; at + 40 < 600; at++) {
    static const int32_t corner[3][2] = {{65535, 65535}, {60000, 8000}, {8000, 60000}};
    if (memcmp(bytes + at, "dataWindow\0box2i", 16) != 0) continue;
    patched++;
    for (int i = 0; i < 3; i++) {
      memcpy(bytes + at + 21 + 8, corner[i], 8);
      expect_refused(bytes, size, "IMAGE_DATA_INVALID");
    }
  }
  free(bytes);
  assert_int_equal(patched, 2);
#ifndef __SANITIZE_ADDRESS__
  struct rusage usage;
  assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
  assert_true(usage.ru_maxrss < 1L << 20); /* in KiB: 1 GiB */
#endif
}

static void other_formats_are_refused_by_name(void **state) {
  (void)state;
  expect_refused("\xabKTX 20\xbb\r\n\x1a\n....", 16, "KTX2 textures are not supported");
  expect_refused("DDS |...........", 16, "DDS textures are not supported");
  expect_refused("GIF89a..........", 16, "GIF textures are not supported");
  expect_refused("\x90PNG\r\n\x1a\n", 9, "IMAGE_UNRECOGNIZED_FORMAT");
  expect_refused("", 0, "IMAGE_DATA_INVALID");
  expect_refused("\xff\xd8\xff\0\0\0\0\0\0\0\0\0\0\0\0", 16, "IMAGE_DATA_INVALID");
}

static void paths_that_are_no_files_are_refused(void **state) {
  (void)state;
  static const char *const paths[] = {"/", "/dev/null", "/nowhere/a.png"};
  for (int i = 0; i < 3; i++) {
    cdl_Image *image;
    message_count = 0;
    assert_int_equal(image_load(&test_log, paths[i], &image), CDL_BAD_INPUT);
    assert_int_equal(message_count, 1);
    assert_null(image);
  }
}

static void expect_first_pixel(const char *path, const unsigned char rgba[4], int tolerance) {
  char whole[256];
  cdl_Image *image;
  snprintf(whole, sizeof whole, FIXTURES "%s", path);
  assert_int_equal(image_load(&test_log, whole, &image), CDL_OK);
  assert_non_null(image->u8);
  for (int c = 0; c < 4; c++) assert_true(abs(image->u8[c] - rgba[c]) <= tolerance);
  image_free(image);
}

/* Files by others whose names say what they show. */
static void fixtures_have_their_colours(void **state) {
  (void)state;
  if (access(FIXTURES, R_OK) != 0) {
    print_message("skipped: " FIXTURES " is not here\n");
    skip();
  }
#define WEBP "ext/EXT_texture_webp/image/"
  expect_first_pixel("base/image/magenta.png", (const unsigned char[]){255, 0, 255, 255}, 0);
  expect_first_pixel("base/image/cyan.jpg", (const unsigned char[]){0, 255, 255, 255}, 1);
  expect_first_pixel(WEBP "VP8L_red.webp", (const unsigned char[]){255, 0, 0, 255}, 0);
  expect_first_pixel(WEBP "VP8_red.webp", (const unsigned char[]){255, 0, 0, 255}, 3);
  expect_first_pixel(WEBP "VP8L_red_transparent.webp", (const unsigned char[]){255, 0, 0, 128}, 0);
  expect_first_pixel(WEBP "VP8X_red_transparent.webp", (const unsigned char[]){255, 0, 0, 128}, 3);
}

static void truncated_webp_is_refused(void **state) {
  (void)state;
  static const char *const names[] = {"VP8L_red_transparent", "VP8X_red_transparent", "VP8_red"};
  for (int f = 0; f < 3; f++) {
    char path[256];
    unsigned char *bytes;
    size_t size;
    snprintf(path, sizeof path, FIXTURES WEBP "%s.webp", names[f]);
    if (access(path, R_OK) != 0) {
      print_message("skipped: %s is not here\n", path);
      skip();
    }
    assert_int_equal(image_file_read(&test_log, path, 1 << 20, &bytes, &size), CDL_OK);
    capture_stderr();
    for (size_t at = 1; at < size; at++) expect_truncation_refused(bytes, at);
    assert_int_equal(release_stderr(), 0);
    free(bytes);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(truncations_are_refused),
      cmocka_unit_test(flipped_bits_do_no_harm),
      cmocka_unit_test(png_layouts_become_rgba),
      cmocka_unit_test(png_of_16_bits_becomes_float),
      cmocka_unit_test(huge_pictures_are_refused_cheaply),
      cmocka_unit_test(other_formats_are_refused_by_name),
      cmocka_unit_test(paths_that_are_no_files_are_refused),
      cmocka_unit_test(fixtures_have_their_colours),
      cmocka_unit_test(truncated_webp_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
