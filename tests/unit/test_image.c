/* Writing every format and decoding it back; failing to write. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include "image/image.h"
#include "image/image_file.h"
#include "image/image_write.h"
#include "test_image_folder.h"

static cdl_Image *write_and_load(const char *name, const float *rgb, const cdl_ToneSettings *tone) {
  cdl_Image *image = NULL;
  assert_int_equal(image_write(&test_log, in_folder(name), WIDTH, HEIGHT, rgb, tone, NULL, 0),
                   CDL_OK);
  assert_int_equal(files_in_folder(), 1);
  assert_int_equal(image_load(&test_log, in_folder(name), &image), CDL_OK);
  assert_int_equal(image->width, WIDTH);
  assert_int_equal(image->height, HEIGHT);
  assert_int_equal(image->channels, 4);
  assert_int_equal(!image->u8 + !image->f32, 1);
  return image;
}

static void png_holds_srgb_codes(void **state) {
  (void)state;
  const cdl_ToneSettings tone = {1.0f, CDL_TONEMAP_NONE};
  float *rgb = make_ramp();
  cdl_Image *image = write_and_load("a.png", rgb, &tone);
  assert_non_null(image->u8);
  assert_true(image->encoded);
  for (int i = 0; i < PIXELS; i++) {
    for (int c = 0; c < 3; c++) {
      const double x = fmin(2.0 * (double)rgb[3 * i + c], 1.0);
      const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
      assert_true(fabs(image->u8[4 * i + c] - 255.0 * code) <= 0.501);
    }
    assert_int_equal(image->u8[4 * i + 3], 255);
  }
  image_free(image);
  free(rgb);
}

static void jpeg_is_close(void **state) {
  (void)state;
  float *rgb = make_ramp();
  cdl_Image *image = write_and_load("a.JPG", rgb, NULL);
  double sum = 0.0;
  assert_non_null(image->u8);
  for (int i = 0; i < PIXELS; i++)
    for (int c = 0; c < 3; c++) {
      const double linear = (double)tonemap_srgb_decode((float)image->u8[4 * i + c] / 255.0f);
      sum += pow(linear - (double)rgb[3 * i + c], 2.0);
    }
  assert_true(sqrt(sum / (3.0 * PIXELS)) < 0.02);
  image_free(image);
  free(rgb);
}

static void exr_keeps_every_bit(void **state) {
  (void)state;
  const uint32_t odd[4] = {0x7f800000u, 0x7fc00001u, 0x00000001u, 0x80000000u};
  float *rgb = make_ramp();
  memcpy(rgb + 30, odd, sizeof odd);
  cdl_Image *image = write_and_load("a.exr", rgb, NULL);
  assert_non_null(image->f32);
  assert_false(image->encoded);
  for (int i = 0; i < PIXELS; i++) {
    assert_memory_equal(image->f32 + 4 * i, rgb + 3 * i, 12);
    assert_true(image->f32[4 * i + 3] == 1.0f);
  }
  image_free(image);
  free(rgb);
}

/* Radiance stores 8 bits of the largest channel: 1/256 of it at the worst. */
static void hdr_keeps_the_range(void **state) {
  (void)state;
  float *rgb = make_ramp();
  for (int i = 0; i < PIXELS * 3; i++) rgb[i] *= 1e4f;
  rgb[0] = NAN;
  rgb[1] = -5.0f;
  cdl_Image *image = write_and_load("a.hdr", rgb, NULL);
  assert_non_null(image->f32);
  assert_true(image->f32[0] == 0.0f && image->f32[1] == 0.0f);
  for (int i = 1; i < PIXELS; i++) {
    const float *p = rgb + 3 * i, largest = fmaxf(p[0], fmaxf(p[1], p[2]));
    for (int c = 0; c < 3; c++)
      assert_true(fabsf(image->f32[4 * i + c] - p[c]) <= largest / 128.0f);
  }
  image_free(image);
  free(rgb);
}

/* The decoder refuses TIFF, so that the header is looked at here: 32-bit IEEE samples, 3 of them.
 */
static void tiff_is_float(void **state) {
  (void)state;
  float *rgb = make_ramp();
  unsigned char *bytes;
  size_t size;
  assert_int_equal(image_write(&test_log, in_folder("a.tif"), WIDTH, HEIGHT, rgb, NULL, NULL, 0),
                   CDL_OK);
  assert_int_equal(image_file_read(&test_log, in_folder("a.tif"), 1 << 20, &bytes, &size), CDL_OK);
  assert_memory_equal(bytes, "II*\0", 4);
  uint32_t at;
  uint16_t entries, found = 0;
  memcpy(&at, bytes + 4, 4);
  assert_true(at + 2 < size);
  memcpy(&entries, bytes + at, 2);
  for (int e = 0; e < entries; e++) {
    uint16_t tag, value;
    memcpy(&tag, bytes + at + 2 + 12 * e, 2);
    memcpy(&value, bytes + at + 2 + 12 * e + 8, 2);
    if (tag == 256) found += value == WIDTH;  /* ImageWidth */
    if (tag == 257) found += value == HEIGHT; /* ImageLength */
    if (tag == 277) found += value == 3;      /* SamplesPerPixel */
    if (tag == 339) found += 1;               /* SampleFormat, three of them elsewhere */
  }
  assert_int_equal(found, 4);
  free(bytes);
  free(rgb);
  cdl_Image *image;
  assert_int_equal(image_load(&test_log, in_folder("a.tif"), &image), CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "TIFF textures are not supported"));
}

static void outputs_are_checked_beforehand(void **state) {
  (void)state;
  assert_int_equal(image_check_output(&test_log, in_folder("a.png")), CDL_OK);
  assert_int_equal(files_in_folder(), 0);
  assert_int_equal(message_count, 0);
  assert_int_equal(image_check_output(&test_log, in_folder("a.gif")), CDL_USAGE);
  assert_non_null(strstr(last_message, ".exr, .hdr, .tif"));
  assert_int_equal(image_check_output(&test_log, in_folder("none")), CDL_USAGE);
  assert_int_equal(image_check_output(&test_log, in_folder("no/a.exr")), CDL_OUTPUT);
  assert_int_equal(message_count, 3);
  assert_int_equal(mkdir(in_folder("d.exr"), 0777), 0);
  assert_int_equal(image_check_output(&test_log, in_folder("d.exr")), CDL_OUTPUT);
  assert_non_null(strstr(last_message, "not a regular file"));
  assert_int_equal(image_check_output(&test_log, "/proc/candela.exr"), CDL_OUTPUT);
}

/* A disk that fills up, played by a limit on file sizes. */
static void failed_writes_leave_the_old_file(void **state) {
  (void)state;
  static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.hdr", "a.tif"};
  float *rgb = make_ramp();
  struct rlimit old, small;
  unsigned char *bytes;
  size_t size;
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 100;
  for (int i = 0; i < 5; i++) {
    message_count = 0;
    assert_int_equal(image_file_write(&test_log, in_folder(names[i]), "old", 3), CDL_OK);
    setrlimit(RLIMIT_FSIZE, &small);
    const cdl_Status status =
        image_write(&test_log, in_folder(names[i]), WIDTH, HEIGHT, rgb, NULL, NULL, 0);
    setrlimit(RLIMIT_FSIZE, &old);
    assert_int_equal(status, CDL_OUTPUT);
    assert_int_equal(message_count, 1);
    assert_non_null(strstr(last_message, names[i]));
    assert_int_equal(files_in_folder(), i + 1);
    assert_int_equal(image_file_read(&test_log, in_folder(names[i]), 100, &bytes, &size), CDL_OK);
    assert_int_equal(size, 3);
    free(bytes);
  }
  assert_int_equal(image_write(&test_log, in_folder("no/a.exr"), WIDTH, HEIGHT, rgb, NULL, NULL, 0),
                   CDL_OUTPUT);
  assert_int_equal(image_write(&test_log, in_folder("a.bmp"), WIDTH, HEIGHT, rgb, NULL, NULL, 0),
                   CDL_USAGE);
  free(rgb);
}

static void attributes_become_a_description(void **state) {
  (void)state;
  static const char *const names[] = {"a.png", "a.jpg", "a.tif"};
  const cdl_ImageAttribute attributes[] = {
      {.name = "candela.scene", .type = CDL_ATTRIBUTE_STRING, .string = "box.gltf"},
      {.name = "candela.spp", .type = CDL_ATTRIBUTE_INT, .integer = 64}};
  float *rgb = make_ramp();
  for (int i = 0; i < 3; i++) {
    unsigned char *bytes;
    size_t size;
    assert_int_equal(
        image_write(&test_log, in_folder(names[i]), WIDTH, HEIGHT, rgb, NULL, attributes, 2),
        CDL_OK);
    assert_int_equal(image_file_read(&test_log, in_folder(names[i]), 1 << 20, &bytes, &size),
                     CDL_OK);
    static const char text[] = "candela.scene=box.gltf; candela.spp=64";
    int found = 0;
    for (size_t at = 0; at + sizeof text <= size; at++)
      found |= memcmp(bytes + at, text, sizeof text - 1) == 0;
    assert_true(found);
    free(bytes);
  }
  free(rgb);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      TEST(png_holds_srgb_codes),
      TEST(jpeg_is_close),
      TEST(exr_keeps_every_bit),
      TEST(hdr_keeps_the_range),
      TEST(tiff_is_float),
      TEST(outputs_are_checked_beforehand),
      TEST(failed_writes_leave_the_old_file),
      TEST(attributes_become_a_description),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
