/* Measures whether a device computes the host's bits: kernels/stages/probe.cl. */
#include "device/device.h"

#include "core/log.h"
#include "device/internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PROBES = 16384, INPUTS = 3, OUTPUTS = 12 };

static const char *const operations[OUTPUTS] = {"a + b",
                                                "a - b",
                                                "a * b",
                                                "a / b",
                                                "sqrt",
                                                "fma",
                                                "a * b + c (two roundings)",
                                                "floor",
                                                "rint",
                                                "integer to float",
                                                "fmin and fmax",
                                                "integer arithmetic"};

static uint32_t float_bits(float x) {
  uint32_t u;
  memcpy(&u, &x, 4);
  return u;
}

/* Finite and not zero, of all magnitudes, every eighth a denormal: infinities would meet in
 * differences, and which zero fmin returns is not laid down. */
static float probe_value(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  uint32_t random = *state ^ *state >> 16;
  uint32_t sign_and_fraction = random & 0x807fffffu;
  *state = *state * 1664525u + 1013904223u;
  uint32_t pick = *state >> 16;
  uint32_t exponent = pick % 8 == 0 ? 0 : pick % 8 < 5 ? 117 + pick / 8 % 20 : 1 + pick / 8 % 254;
  uint32_t bits = sign_and_fraction | exponent << 23 | 1;
  float x;
  memcpy(&x, &bits, 4);
  return x;
}

static void fill_inputs(float *in) {
  uint32_t state = 1;
  for (size_t i = 0; i < PROBES * INPUTS; i++) in[i] = probe_value(&state);
}

/* As the kernel does; built with -ffp-contract=off, and the products go through a variable. */
static void expected(const float in[INPUTS], uint32_t out[OUTPUTS]) {
  float a = in[0], b = in[1], c = in[2];
  uint32_t bits = float_bits(a);
  volatile float product = a * b;
  out[0] = float_bits(a + b);
  out[1] = float_bits(a - b);
  out[2] = float_bits(product);
  out[3] = float_bits(a / b);
  out[4] = float_bits(sqrtf(fabsf(a)));
  out[5] = float_bits(fmaf(a, b, c));
  out[6] = float_bits(product + c);
  out[7] = float_bits(floorf(c));
  out[8] = float_bits(rintf(c));
  out[9] = float_bits((float)bits + (float)(int32_t)float_bits(b));
  out[10] = float_bits(fminf(a, fmaxf(b, c)));
  out[11] = (bits * 0x9e3779b9u) ^ (bits >> 15);
}

typedef struct Differences {
  size_t normal[OUTPUTS], denormal[OUTPUTS];
} Differences;

static int is_denormal(uint32_t bits) { return !(bits & 0x7f800000u) && (bits & 0x7fffffu); }

/* Drivers that compute in software or flush denormals go wrong in these cases alone, which renders
 * hardly ever meet; so they are counted apart. */
static int meets_denormals(const float in[INPUTS], const uint32_t right[OUTPUTS], int operation) {
  for (int i = 0; i < INPUTS; i++)
    if (is_denormal(float_bits(in[i]))) return 1;
  return is_denormal(right[2]) || is_denormal(right[operation]); /* the product, the result */
}

static void compare(const float *in, const uint32_t *out, Differences *differences) {
  for (size_t i = 0; i < PROBES; i++) {
    uint32_t right[OUTPUTS];
    expected(in + INPUTS * i, right);
    for (int k = 0; k < OUTPUTS; k++) {
      if (right[k] == out[OUTPUTS * i + k]) continue;
      if (meets_denormals(in + INPUTS * i, right, k))
        differences->denormal[k]++;
      else
        differences->normal[k]++;
    }
  }
}

static int worst_operation(const size_t counts[OUTPUTS]) {
  int worst = 0;
  for (int k = 1; k < OUTPUTS; k++)
    if (counts[k] > counts[worst]) worst = k;
  return worst;
}

static void judge(cdl_DeviceInfo *info, const float *in, const uint32_t *out) {
  Differences differences = {0};
  compare(in, out, &differences);
  int normal = worst_operation(differences.normal), tiny = worst_operation(differences.denormal);
  char *text = info->exactness;
  size_t size = sizeof info->exactness;
  if (differences.normal[normal]) {
    info->exact = CDL_EXACT_NO;
    snprintf(text, size,
             "%s differs from the host in %zu of %d values: its images differ in their last bits "
             "from those of exact devices",
             operations[normal], differences.normal[normal], PROBES);
  } else if (differences.denormal[tiny]) {
    info->exact = CDL_EXACT_NORMALS;
    snprintf(text, size,
             "%s differs from the host for denormal numbers (below 1.2e-38) only: its images are "
             "those of exact devices unless a path meets such numbers",
             operations[tiny]);
  } else {
    info->exact = CDL_EXACT_MEASURED;
    snprintf(text, size, "agrees with the host on %d values of each operation", PROBES);
  }
}

static cdl_Status run_probe(cdl_Device *device, const float *in, uint32_t *out) {
  cdl_Buffer input = {0}, output = {0};
  cdl_Bindings bindings = {0};
  size_t out_size = sizeof(uint32_t) * PROBES * OUTPUTS;
  cdl_Status status =
      buffer_create(device, "probe_in", sizeof(float) * PROBES * INPUTS, in, &input);
  if (!status) status = buffer_create(device, "probe_out", out_size, NULL, &output);
  bindings_set(&bindings, "probe_in", &input);
  bindings_set(&bindings, "probe_out", &output);
  if (!status) status = device_run(device, CDL_KERNEL_probe_arithmetic, &bindings, 0, PROBES);
  if (!status) status = buffer_read(&output, 0, out_size, out);
  buffer_free(&input);
  buffer_free(&output);
  return status;
}

cdl_Status device_measure_exactness(cdl_Device *device) {
  float *in = malloc(sizeof(float) * PROBES * INPUTS);
  uint32_t *out = calloc(PROBES * OUTPUTS, sizeof *out);
  cdl_Status status = CDL_OK;
  if (!in || !out) {
    status =
        log_fail(device->log, CDL_DEVICE, "not enough memory to measure %s", device->info.name);
  } else {
    fill_inputs(in);
    status = run_probe(device, in, out);
  }
  if (!status) judge(&device->info, in, out);
  free(in);
  free(out);
  return status;
}
