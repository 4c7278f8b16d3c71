/* Layers, types and header entries of an EXR, read back and looked at byte by byte; the AOV table.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "image/aov.h"
#include "image/image.h"
#include "image/image_file.h"
#include "test_image_folder.h"

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

int main(void) {
  const struct CMUnitTest tests[] = {
      TEST(layers_come_back_with_names_types_and_header),
      TEST(exr_bytes_are_plain),
      TEST(two_channels_of_one_name_are_refused),
      TEST(exr_layers_and_luminance_decode),
      TEST(aovs_are_parsed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
