#include "tests/device/bsdf_device.h"

#include <stdarg.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/energy.h"
#include "scene/pack_parts.h"

enum { MAX_BUFFERS = 8 };

static Harness *harness;
static int built = -1; /* the model whose kernels the harness has */
static float energy[ENERGY_KINDS * ENERGY_KIND_WORDS];

int bsdf_device_open(void **state) {
  (void)state;
  harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  if (!harness) return -1;
  for (uint kind = 0; kind < ENERGY_KINDS; kind++) {
    pack_energy_metal(kind, energy);
    pack_energy_glass(kind, energy);
  }
  print_message("%s\n", harness_name(harness));
  return 0;
}

int bsdf_device_close(void **state) {
  (void)state;
  harness_close(harness);
  return 0;
}

int bsdf_is_soak(void) {
  const char *value = getenv("CDL_SOAK");
  return value && *value && *value != '0';
}

static void read_text(const char *path, char *text, size_t size) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened; run the tests from the top folder", path);
  text[fread(text, 1, size - 1, file)] = 0;
  fclose(file);
}

/* One program for each model: all together take longer to compile than they take to run. */
static void build(int model) {
  static char setup[1 << 13], kernels[1 << 15], text[1 << 16];
  if (built == model) return;
  const char *name = bsdf_models[model].name;
  read_text("tests/device/bsdf_setup.h", setup, sizeof setup);
  read_text("tests/device/bsdf.cl", kernels, sizeof kernels);
  snprintf(text, sizeof text,
           "%s\n#include \"bsdf/%s.h\"\n#define ModelParams %s\n#define model_params %s_params\n"
           "#define model_evaluate %s_evaluate\n#define model_sample %s_sample\n%s",
           setup, name, bsdf_models[model].type, name, name, name, kernels);
  harness_build(harness, text);
  built = model;
}

/* Dispersion leaves a path one channel, here the case's. */
static vec3 throughput_of(const BsdfCase *c) {
  if (c->abbe <= 0) return v3_all(1);
  return v3(c->channel == 0, c->channel == 1, c->channel == 2);
}

BsdfPoint bsdf_point_of(const BsdfCase *c) {
  const float *n = c->coat_normal;
  return (BsdfPoint){.base = v3(c->base[0], c->base[1], c->base[2]),
                     .throughput = throughput_of(c),
                     .coat_normal = v3(n[0], n[1], sqrtf(1 - n[0] * n[0] - n[1] * n[1])),
                     .wavelength = c->wavelength,
                     .flags = c->flags,
                     .front = !c->inside,
                     .energy = energy};
}

BsdfSetup bsdf_setup_of(const BsdfCase *c, vec3 wo, uint seed) {
  BsdfPoint p = bsdf_point_of(c);
  return (BsdfSetup){.base = {p.base.x, p.base.y, p.base.z},
                     .throughput = {p.throughput.x, p.throughput.y, p.throughput.z},
                     .coat_normal = {p.coat_normal.x, p.coat_normal.y, p.coat_normal.z},
                     .wavelength = p.wavelength,
                     .flags = p.flags,
                     .front = p.front,
                     .wo = {wo.x, wo.y, wo.z},
                     .seed = seed,
                     .weight_max = bsdf_models[c->model].weight_max,
                     .tolerance = 1e-4f};
}

void bsdf_run_with(const BsdfCase *c, const char *kernel, size_t items, BsdfSetup *setup,
                   HarnessBuffer params, const HarnessBuffer *buffers, size_t count) {
  assert_true(count + 3 <= MAX_BUFFERS && items % BSDF_STRIP == 0);
  HarnessBuffer all[MAX_BUFFERS] = {{setup, sizeof *setup}, params, {energy, sizeof energy}};
  memcpy(all + 3, buffers, count * sizeof *buffers);
  build(c->model);
  harness_run(harness, kernel, items / BSDF_STRIP, all, count + 3);
}

void bsdf_run(const BsdfCase *c, const char *kernel, size_t items, BsdfSetup *setup,
              const HarnessBuffer *buffers, size_t count) {
  static float words[CDL_PARAM_MAX]; /* the harness writes back what it was given */
  memcpy(words, c->words, sizeof words);
  bsdf_run_with(c, kernel, items, setup, (HarnessBuffer){words, sizeof words}, buffers, count);
}

void bsdf_name_faults(const BsdfCase *c, const char *what, size_t item, uint faults) {
  static const char *const names[] = {"weight out of range",       "pdf out of range",
                                      "direction not of length 1", "evaluation not sound",
                                      "weight on the wrong side",  "sample's pdf is not evaluate's",
                                      "weight pdf is not f cos",   "weight without a pdf"};
  char text[512] = "";
  for (int i = 0; i < 8; i++)
    if (faults >> i & 1)
      snprintf(text + strlen(text), sizeof text - strlen(text), "; %s", names[i]);
  fail_msg("%s, %s, item %zu%s", c->name, what, item, text);
}
