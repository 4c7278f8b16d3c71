/* Parts, merging and checkpoints, with films of random numbers: whatever way a film was cut, its
 * bits are those of the whole. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "candela.h"
#include "image/image_file.h"
#include "image/image_layers.h"
#include "render/checkpoint.h"
#include "render/film.h"
#include "render/picture.h"

enum { WIDTH = 13, HEIGHT = 7, PIXELS = WIDTH * HEIGHT, SAMPLES = 100, BLOCKS = 7 };

static const uint32_t aovs = AOV_BIT(CDL_AOV_ALBEDO) | AOV_BIT(CDL_AOV_DEPTH) |
                             AOV_BIT(CDL_AOV_OBJECT) | AOV_BIT(CDL_AOV_VARIANCE);
static char folder[] = "/tmp/candela_merge_XXXXXX";
static char last_message[2048];

static void keep_message(void *user, cdl_LogLevel level, const char *message) {
  (void)user;
  if (level == CDL_LOG_ERROR) snprintf(last_message, sizeof last_message, "%s", message);
}
static const cdl_Log test_log = {keep_message, NULL};

static char *path_of(const char *name) {
  static char paths[16][128];
  static int next;
  char *path = paths[next++ % 16];
  snprintf(path, 128, "%s/%s", folder, name);
  return path;
}

/* A block's sums depend on its number alone; exponents vary, so that the order of adding matters.
 */
static void block_sums(uint32_t block, uint32_t channels, float *sums) {
  srand48(block + 1);
  for (uint32_t i = 0; i < channels * PIXELS; i++)
    sums[i] = (float)(drand48() * (1 << (lrand48() % 24)));
  for (uint32_t i = 0; i < PIXELS; i++) sums[(channels - 1) * PIXELS + i] = (float)(i + block);
}

static cdl_Film *film_of(uint32_t first, uint32_t count, int keep) {
  cdl_Film *film;
  assert_int_equal(film_create(&test_log, WIDTH, HEIGHT, aovs, keep, &film), CDL_OK);
  float *sums = malloc(sizeof *sums * film->channels * PIXELS);
  for (uint32_t b = first; b < first + count; b++) {
    block_sums(b, film->channels, sums);
    const uint32_t rest = SAMPLES - 16 * b;
    film_add(film, b, rest < 16 ? rest : 16, 0, PIXELS, sums, PIXELS);
  }
  free(sums);
  return film;
}

static json_t *job_of(int seed) {
  return json_pack("{s:s, s:i, s:i, s:i}", "version", CDL_VERSION, "samples", SAMPLES, "seed", seed,
                   "aovs", (int)(aovs | 1));
}

static char *write_part(const char *name, uint32_t first, uint32_t count, int seed) {
  cdl_Film *film = film_of(first, count, 1);
  cdl_Picture picture = {
      .log = &test_log,
      .film = film,
      .job = job_of(seed),
      .header = json_pack("{s:s, s:s, s:i}", "scene", "a.gltf", "film_sha256", "?", "spp", SAMPLES),
      .statistics =
          json_pack("{s:i, s:{s:i, s:i, s:i}, s:{s:f, s:f}, s:i, s:[{s:s, s:i, s:f}], s:{s:i}}",
                    "paths", (int)count, "rays", "camera", 1, "bounce", 2, "shadow", 3, "times",
                    "render_s", 0.5, "wall_s", 1.0, "peak_rss_bytes", (int)first, "kernels", "name",
                    "intersect", "launches", 2, "total_s", 0.25, "settings", "first_sample", 0)};
  char *path = path_of(name);
  assert_int_equal(picture_write(&picture, path, NULL), CDL_OK);
  picture_clear(&picture);
  film_free(film);
  return path;
}

static void assert_same_film(const cdl_Film *a, const cdl_Film *b) {
  assert_int_equal(a->channels, b->channels);
  assert_memory_equal(a->sums, b->sums, sizeof *a->sums * a->channels * PIXELS);
  assert_memory_equal(a->squares, b->squares, sizeof *a->squares * 3 * PIXELS);
  assert_memory_equal(a->samples, b->samples, sizeof *a->samples * PIXELS);
  assert_memory_equal(a->blocks, b->blocks, sizeof *a->blocks * PIXELS);
  char x[65], y[65];
  film_sha256(a, x);
  film_sha256(b, y);
  assert_string_equal(x, y);
}

static void merges_any_order(void **state) {
  (void)state;
  const char *parts[3] = {write_part("a.exr", 0, 2, 1), write_part("b.exr", 2, 1, 1),
                          write_part("c.exr", 3, 4, 1)};
  static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  cdl_Film *whole = film_of(0, BLOCKS, 0);
  for (int i = 0; i < 6; i++) {
    const char *paths[3];
    for (int k = 0; k < 3; k++) paths[k] = parts[orders[i][k]];
    cdl_Picture *picture;
    assert_int_equal(cdl_merge(&test_log, paths, 3, &picture), CDL_OK);
    assert_same_film(picture->film, whole);
    cdl_picture_free(picture);
  }
  film_free(whole);
}

static double number(const json_t *json, const char *a, const char *b) {
  return json_number_value(json_object_get(json_object_get(json, a), b));
}

static void merges_statistics(void **state) {
  (void)state;
  const char *parts[2] = {write_part("a.exr", 0, 5, 1), write_part("b.exr", 5, 2, 1)};
  cdl_Picture *picture;
  char digest[65];
  assert_int_equal(cdl_merge(&test_log, parts, 2, &picture), CDL_OK);
  const json_t *s = picture->statistics;
  assert_int_equal(json_integer_value(json_object_get(s, "paths")), 7);
  assert_true(number(s, "rays", "shadow") == 6 && number(s, "times", "render_s") == 1.0);
  assert_true(number(s, "settings", "sample_count") == SAMPLES);
  assert_int_equal(json_integer_value(json_object_get(s, "peak_rss_bytes")), 5);
  const json_t *kernel = json_array_get(json_object_get(s, "kernels"), 0);
  assert_int_equal(json_integer_value(json_object_get(kernel, "launches")), 4);
  assert_true(json_real_value(json_object_get(s, "mrays_per_s")) == 12e-6);
  film_sha256(picture->film, digest);
  assert_string_equal(json_string_value(json_object_get(s, "film_sha256")), digest);
  assert_string_equal(json_string_value(json_object_get(picture->header, "film_sha256")), digest);
  cdl_picture_free(picture);
}

/* The picture in a part's main layer is the mean of its own samples. */
static void part_is_a_picture(void **state) {
  (void)state;
  cdl_ExrImage *image;
  cdl_Film *film = film_of(2, 3, 0);
  assert_int_equal(image_read_exr_layers(&test_log, write_part("p.exr", 2, 3, 1), &image), CDL_OK);
  float *rgb = film_resolve(film);
  const float *green = image_exr_channel(image, "G")->f32;
  for (int i = 0; i < PIXELS; i++) assert_true(green[i] == rgb[3 * i + 1]);
  assert_non_null(image_exr_channel(image, "block.000004.albedo.B"));
  assert_int_equal(image_exr_attribute(image, "candela.spp")->integer, SAMPLES);
  assert_string_equal(image_exr_attribute(image, "candela.scene")->string, "a.gltf");
  free(rgb);
  image_exr_free(image);
  film_free(film);
}

static void assert_refused(const char *a, const char *b, const char *words) {
  const char *paths[2] = {a, b};
  cdl_Picture *picture;
  assert_int_equal(cdl_merge(&test_log, paths, b ? 2 : 1, &picture), CDL_BAD_INPUT);
  assert_null(picture);
  if (!strstr(last_message, words)) fail_msg("'%s' lacks '%s'", last_message, words);
}

static void refuses_strangers(void **state) {
  (void)state;
  const char *a = write_part("a.exr", 0, 4, 1);
  assert_refused(a, write_part("other.exr", 4, 3, 2), "other.exr: does not belong to");
  assert_refused(a, write_part("other.exr", 4, 3, 2), "--seed is 2 there and 1 here");
  assert_refused(a, write_part("late.exr", 5, 2, 1),
                 "lack samples 64 to 79; render them with "
                 "--samples 64:16");
  assert_refused(write_part("mid.exr", 3, 4, 1), a, "mid.exr: overlaps ");
  assert_refused(a, NULL, "--samples 64:36");
  assert_refused(a, a, "overlaps");
  assert_refused(path_of("none.exr"), NULL, "none.exr");
}

static void refuses_plain_pictures(void **state) {
  (void)state;
  cdl_Film *film = film_of(0, BLOCKS, 0);
  cdl_Picture picture = {&test_log, film, job_of(1), json_object(), json_object()};
  char *path = path_of("plain.exr");
  assert_int_equal(picture_write(&picture, path, NULL), CDL_OK);
  assert_refused(path, NULL, "plain.exr: is no partial film");
  picture_clear(&picture);
  film_free(film);
}

/* A block that some pixels lack stays out of the part. */
static void drops_unfinished_blocks(void **state) {
  (void)state;
  cdl_Film *film = film_of(0, 3, 1);
  float *sums = calloc(film->channels * PIXELS, sizeof *sums);
  film_add(film, 3, 16, 0, 10, sums, PIXELS);
  free(sums);
  cdl_Picture picture = {&test_log, film, job_of(1), json_object(), json_object()};
  char *path = path_of("stopped.exr");
  assert_int_equal(picture_write(&picture, path, NULL), CDL_OK);
  assert_refused(path, NULL, "--samples 48:52");
  picture_clear(&picture);
  film_free(film);
}

/* As many channels as settings allow survive writing and reading. */
static void large_parts(void **state) {
  (void)state;
  enum { MANY = 333 };
  cdl_Film *film;
  assert_int_equal(film_create(&test_log, 2, 1, 0, 1, &film), CDL_OK);
  for (uint32_t b = 0; b < MANY; b++) film_add(film, b, 16, 0, 2, (float[6]){(float)b}, 2);
  cdl_Picture picture = {&test_log, film, json_pack("{s:i, s:i}", "samples", MANY * 16, "aovs", 1),
                         json_object(), json_object()};
  const char *path = path_of("large.exr");
  assert_int_equal(picture_write(&picture, path, NULL), CDL_OK);
  cdl_Picture *merged;
  assert_int_equal(cdl_merge(&test_log, &path, 1, &merged), CDL_OK);
  assert_true(merged->film->sums[0] == MANY * (MANY - 1) / 2.0);
  cdl_picture_free(merged);
  picture_clear(&picture);
  film_free(film);
}

static void checkpoint_goes_on(void **state) {
  (void)state;
  for (int keep = 0; keep < 2; keep++) {
    cdl_Film *whole = film_of(0, BLOCKS, keep), *half = film_of(0, 3, keep), *again;
    json_t *job = job_of(1), *at = json_pack("{s:i}", "next_block", 3), *back = NULL;
    char *path = path_of("c.checkpoint");
    assert_int_equal(checkpoint_write(&test_log, path, job, at, half), CDL_OK);
    assert_int_equal(film_create(&test_log, WIDTH, HEIGHT, aovs, keep, &again), CDL_OK);
    assert_int_equal(checkpoint_read(&test_log, path, job, again, NULL, NULL, &back), CDL_OK);
    assert_true(json_equal(at, back));
    assert_same_film(half, again);
    float *sums = malloc(sizeof *sums * again->channels * PIXELS);
    for (uint32_t b = 3; b < BLOCKS; b++) {
      block_sums(b, again->channels, sums);
      film_add(again, b, b == 6 ? 4 : 16, 0, PIXELS, sums, PIXELS);
    }
    assert_same_film(whole, again);
    assert_int_equal(again->part_count, keep ? BLOCKS : 0);
    for (uint32_t b = 0; b < again->part_count; b++)
      assert_memory_equal(again->parts[b].sums, whole->parts[b].sums,
                          sizeof(float) * again->channels * PIXELS);
    free(sums);
    json_decref(job);
    json_decref(at);
    json_decref(back);
    film_free(whole);
    film_free(half);
    film_free(again);
  }
}

static cdl_Status read_checkpoint(const char *path, int seed) {
  cdl_Film *film = film_of(0, 1, 1), *before = film_of(0, 1, 1);
  json_t *job = job_of(seed), *at = NULL;
  cdl_Status status = checkpoint_read(&test_log, path, job, film, NULL, NULL, &at);
  if (status) assert_same_film(film, before);
  if (status) assert_null(at);
  json_decref(at);
  json_decref(job);
  film_free(film);
  film_free(before);
  return status;
}

/* Every damaged byte and every length is noticed, and the film stays as it was. */
static void checkpoint_damage(void **state) {
  (void)state;
  cdl_Film *film = film_of(0, 2, 1);
  json_t *job = job_of(1), *at = json_pack("{s:i}", "next_block", 2);
  char *path = path_of("d.checkpoint"), *bad = path_of("bad.checkpoint");
  unsigned char *bytes;
  size_t size;
  assert_int_equal(checkpoint_write(&test_log, path, job, at, film), CDL_OK);
  assert_int_equal(image_file_read(&test_log, path, 1 << 24, &bytes, &size), CDL_OK);
  for (size_t i = 0; i < size; i += 1 + size / 100) {
    bytes[i] ^= 4;
    image_file_write(&test_log, bad, bytes, size);
    bytes[i] ^= 4;
    assert_int_equal(read_checkpoint(bad, 1), CDL_BAD_INPUT);
    image_file_write(&test_log, bad, bytes, i);
    assert_int_equal(read_checkpoint(bad, 1), CDL_BAD_INPUT);
  }
  assert_int_equal(read_checkpoint(path, 1), CDL_OK);
  assert_int_equal(read_checkpoint(path, 2), CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "does not belong to this render: --seed is 1 there and 2"));
  bytes[sizeof "candela checkpoint" - 1 + 1]++; /* the format's version */
  image_file_write(&test_log, bad, bytes, size);
  assert_int_equal(read_checkpoint(bad, 1), CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "another version"));
  free(bytes);
  json_decref(job);
  json_decref(at);
  film_free(film);
}

static int takes_later_blocks(const void *user, const json_t *state) {
  assert_ptr_equal(user, &test_log);
  return json_integer_value(json_object_get(state, "next_block")) > 1;
}

/* Its checksum is right, but its blocks are not the first ones, or its state is none of ours. */
static void checkpoint_out_of_order(void **state) {
  (void)state;
  cdl_Film *film = film_of(1, 2, 1), *into = film_of(0, 1, 1), *before = film_of(0, 1, 1);
  json_t *job = job_of(1), *at = json_pack("{s:i}", "next_block", 1), *back = NULL;
  char *path = path_of("e.checkpoint");
  assert_int_equal(checkpoint_write(&test_log, path, job, at, film), CDL_OK);
  assert_int_equal(checkpoint_read(&test_log, path, job, into, NULL, NULL, &back), CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "its blocks are not those of its samples"));
  assert_int_equal(checkpoint_write(&test_log, path, job, at, before), CDL_OK);
  assert_int_equal(
      checkpoint_read(&test_log, path, job, into, takes_later_blocks, &test_log, &back),
      CDL_BAD_INPUT);
  assert_non_null(strstr(last_message, "goes on where this render never is"));
  assert_same_film(into, before);
  assert_null(back);
  json_decref(job);
  json_decref(at);
  film_free(film);
  film_free(into);
  film_free(before);
}

static int set_up(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state) {
  (void)state;
  char command[160];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(merges_any_order),
      cmocka_unit_test(merges_statistics),
      cmocka_unit_test(part_is_a_picture),
      cmocka_unit_test(refuses_strangers),
      cmocka_unit_test(refuses_plain_pictures),
      cmocka_unit_test(drops_unfinished_blocks),
      cmocka_unit_test(large_parts),
      cmocka_unit_test(checkpoint_goes_on),
      cmocka_unit_test(checkpoint_damage),
      cmocka_unit_test(checkpoint_out_of_order),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
