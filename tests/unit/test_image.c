/* Writing every format and decoding it back; what lands in an EXR, read here byte by byte. */
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <dirent.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/aov.h"
#include "image/image.h"
#include "image/image_file.h"
#include "image/image_write.h"

#define WIDTH 37
#define HEIGHT 70 /* more than one run of 64 lines */
#define PIXELS (WIDTH * HEIGHT)

static char folder[64];
static char last_message[2048];
static int message_count;

static void keep_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  (void)level;
  snprintf(last_message, sizeof last_message, "%s", message);
  message_count++;
}

static const cdl_Log test_log = {keep_message, NULL};

static const char *in_folder(const char *name) {
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static int files_in_folder(void) {
  int count = 0;
  DIR *entries = opendir(folder);
  assert_non_null(entries);
  for (struct dirent *entry; (entry = readdir(entries));)
    count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
  closedir(entries);
  return count;
}

static int setup(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/candela_image_XXXXXX");
  message_count = 0;
  last_message[0] = '\0';
  return mkdtemp(folder) ? 0 : -1;
}

static int teardown(void **state) {
  (void)state;
  DIR *entries = opendir(folder);
  for (struct dirent *entry; entries && (entry = readdir(entries));)
    remove(in_folder(entry->d_name));
  if (entries) closedir(entries);
  return rmdir(folder);
}

/* Smooth, within 0..0.9, different in every channel and pixel. */
static float *make_ramp(void) {
  float *rgb = malloc(PIXELS * 3 * sizeof *rgb);
  assert_non_null(rgb);
  for (int i = 0; i < PIXELS; i++) {
    rgb[3 * i] = 0.9f * (float)(i % WIDTH) / (WIDTH - 1);
    rgb[3 * i + 1] = 0.9f * (float)(i / WIDTH) / (HEIGHT - 1);
    rgb[3 * i + 2] = 0.9f * (float)i / PIXELS;
  }
  return rgb;
}

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

static void layers_come_back_with_names_types_and_header(void **state) {
  (void)state;
  float *rgb = make_ramp(), depth[PIXELS], half[PIXELS * 2];
  uint32_t id[PIXELS];
  for (int i = 0; i < PIXELS; i++) {
    depth[i] = i ? 1.0f / (float)i : INFINITY;
    id[i] = 0xffffffffu - (uint32_t)i * 1000003u;
    half[2 * i] = 0.5f * (float)(i % 64);
    half[2 * i + 1] = 1.0f + 1.0f / 4096.0f;
  }
  const cdl_ImageLayer layers[] = {aov_layer(CDL_AOV_OBJECT, id),
                                   aov_layer(CDL_AOV_BEAUTY, rgb),
                                   aov_layer(CDL_AOV_DEPTH, depth),
                                   {"uv.first", 2, {"u", "v"}, CDL_CHANNEL_HALF, half}};
  static char text[5000];
  memset(text, 'x', sizeof text - 1);
  const cdl_ImageAttribute attributes[] = {
      {.name = "candela.scene", .type = CDL_ATTRIBUTE_STRING, .string = "a b; c=\"d\" é"},
      {.name = "candela.spp", .type = CDL_ATTRIBUTE_INT, .integer = -7},
      {.name = "candela.exposure", .type = CDL_ATTRIBUTE_FLOAT, .real = 0.1f},
      {.name = "candela.settings.of.a.long.name.over.thirty.one.bytes",
       .type = CDL_ATTRIBUTE_STRING,
       .string = text}};
  const cdl_ImagePicture picture = {WIDTH, HEIGHT, layers, 4, attributes, 4};
  assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OK);
  cdl_ExrImage *image;
  assert_int_equal(image_read_exr_layers(&test_log, in_folder("l.exr"), &image), CDL_OK);
  assert_int_equal(image->width, WIDTH);
  assert_int_equal(image->height, HEIGHT);
  assert_int_equal(image->channel_count, 7);
  const cdl_ExrChannel *ids = image_exr_channel(image, "object.id");
  assert_int_equal(ids->type, CDL_CHANNEL_UINT);
  assert_null(ids->f32);
  assert_memory_equal(ids->u32, id, sizeof id);
  assert_memory_equal(image_exr_channel(image, "depth.Z")->f32, depth, sizeof depth);
  for (int i = 0; i < PIXELS; i++) {
    assert_true(image_exr_channel(image, "G")->f32[i] == rgb[3 * i + 1]);
    assert_true(image_exr_channel(image, "uv.first.u")->f32[i] == half[2 * i]);
    assert_true(image_exr_channel(image, "uv.first.v")->f32[i] == 1.0f); /* 11 bits of mantissa */
  }
  assert_int_equal(image_exr_channel(image, "uv.first.u")->type, CDL_CHANNEL_HALF);
  assert_null(image_exr_channel(image, "A"));
  assert_string_equal(image_exr_attribute(image, "candela.scene")->string, attributes[0].string);
  assert_int_equal(image_exr_attribute(image, "candela.spp")->integer, -7);
  assert_true(image_exr_attribute(image, "candela.exposure")->real == 0.1f);
  assert_string_equal(image_exr_attribute(image, attributes[3].name)->string, text);
  assert_null(image_exr_attribute(image, "candela.seed"));
  image_exr_free(image);
  free(rgb);
}

/* OpenEXR's header layout: name, type, size, value; the channel list holds name, type (0 uint,
 * 1 half, 2 float) and 12 bytes more, sorted by name. */
static const unsigned char *exr_header(const unsigned char *bytes, const char *name) {
  const unsigned char *at = bytes + 8;
  while (*at) {
    const char *entry = (const char *)at, *type = entry + strlen(entry) + 1;
    const unsigned char *size = (const unsigned char *)type + strlen(type) + 1;
    uint32_t length;
    memcpy(&length, size, 4);
    if (strcmp(entry, name) == 0) return size + 4;
    at = size + 4 + length;
  }
  return NULL;
}

static void exr_bytes_are_plain(void **state) {
  (void)state;
  float *rgb = make_ramp();
  uint32_t id[PIXELS] = {0};
  const cdl_ImageLayer layers[] = {aov_layer(CDL_AOV_MATERIAL, id), aov_layer(CDL_AOV_BEAUTY, rgb)};
  const cdl_ImagePicture picture = {WIDTH, HEIGHT, layers, 2, NULL, 0};
  unsigned char *bytes[2];
  size_t size[2];
  for (int i = 0; i < 2; i++) {
    assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OK);
    assert_int_equal(image_file_read(&test_log, in_folder("l.exr"), 1 << 20, &bytes[i], &size[i]),
                     CDL_OK);
  }
  assert_int_equal(size[0], size[1]);
  assert_memory_equal(bytes[0], bytes[1], size[0]);
  assert_memory_equal(bytes[0], "\x76\x2f\x31\x01\x02", 5);
  assert_int_equal(bytes[0][5] & 0x1a, 0);                   /* not tiled, deep or of many parts */
  assert_int_equal(*exr_header(bytes[0], "compression"), 3); /* ZIP, 16 lines a block */
  const unsigned char *channels = exr_header(bytes[0], "channels");
  const char *const names[4] = {"B", "G", "R", "material.id"};
  for (int c = 0; c < 4; c++) {
    assert_string_equal((const char *)channels, names[c]);
    assert_int_equal(channels[strlen(names[c]) + 1], c < 3 ? 2 : 0);
    channels += strlen(names[c]) + 1 + 16;
  }
  assert_int_equal(*channels, 0);
  assert_null(exr_header(bytes[0], "capDate"));
  free(bytes[0]);
  free(bytes[1]);
  free(rgb);
}

static void two_channels_of_one_name_are_refused(void **state) {
  (void)state;
  float *rgb = make_ramp();
  const cdl_ImageLayer layers[] = {aov_layer(CDL_AOV_BEAUTY, rgb), aov_layer(CDL_AOV_BEAUTY, rgb)};
  const cdl_ImagePicture picture = {WIDTH, HEIGHT, layers, 2, NULL, 0};
  assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OUTPUT);
  assert_int_equal(files_in_folder(), 0);
  free(rgb);
}

/* The colours of an EXR that has only a layer, or only luminance. */
static void exr_layers_and_luminance_decode(void **state) {
  (void)state;
  float *rgb = make_ramp();
  cdl_ImageLayer layer = aov_layer(CDL_AOV_ALBEDO, rgb);
  cdl_ImagePicture picture = {WIDTH, HEIGHT, &layer, 1, NULL, 0};
  cdl_Image *image;
  assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OK);
  assert_int_equal(image_load(&test_log, in_folder("l.exr"), &image), CDL_OK);
  for (int i = 0; i < PIXELS; i++) assert_memory_equal(image->f32 + 4 * i, rgb + 3 * i, 12);
  image_free(image);
  const cdl_ImageLayer grey = {"", 2, {"Y", "A"}, CDL_CHANNEL_FLOAT, rgb};
  picture.layers = &grey;
  assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OK);
  assert_int_equal(image_load(&test_log, in_folder("l.exr"), &image), CDL_OK);
  for (int i = 0; i < PIXELS; i++) {
    for (int c = 0; c < 3; c++) assert_true(image->f32[4 * i + c] == rgb[2 * i]);
    assert_true(image->f32[4 * i + 3] == rgb[2 * i + 1]);
  }
  image_free(image);
  layer = aov_layer(CDL_AOV_DEPTH, rgb);
  picture.layers = &layer;
  assert_int_equal(image_write_exr_layers(&test_log, in_folder("l.exr"), &picture), CDL_OK);
  assert_int_equal(image_load(&test_log, in_folder("l.exr"), &image), CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "IMAGE_DATA_INVALID: no channels R, G, B or Y"));
  assert_null(image);
  free(rgb);
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

static void aovs_are_parsed(void **state) {
  (void)state;
  uint32_t set;
  assert_int_equal(aov_parse(&test_log, "albedo,depth", &set), CDL_OK);
  assert_int_equal(set, AOV_BIT(CDL_AOV_BEAUTY) | AOV_BIT(CDL_AOV_ALBEDO) | AOV_BIT(CDL_AOV_DEPTH));
  assert_int_equal(aov_parse(&test_log, "all", &set), CDL_OK);
  assert_int_equal(set, 0x3ff);
  assert_int_equal(aov_parse(&test_log, "albedo,,depth", &set), CDL_USAGE);
  assert_int_equal(aov_parse(&test_log, "depths", &set), CDL_USAGE);
  for (int i = 0; i < CDL_AOV_COUNT; i++) assert_non_null(strstr(last_message, aov_table[i].name));
  assert_int_equal(aov_parse(&test_log, "", &set), CDL_USAGE);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void) {
  const struct CMUnitTest tests[] = {
      TEST(png_holds_srgb_codes),
      TEST(jpeg_is_close),
      TEST(exr_keeps_every_bit),
      TEST(hdr_keeps_the_range),
      TEST(tiff_is_float),
      TEST(layers_come_back_with_names_types_and_header),
      TEST(exr_bytes_are_plain),
      TEST(two_channels_of_one_name_are_refused),
      TEST(exr_layers_and_luminance_decode),
      TEST(outputs_are_checked_beforehand),
      TEST(failed_writes_leave_the_old_file),
      TEST(attributes_become_a_description),
      TEST(aovs_are_parsed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
