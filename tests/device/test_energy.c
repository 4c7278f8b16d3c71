/* test_energy.c: what rough facets lose comes back. White metal, sheets and glass on the device
 * return all light but for what bsdf/energy.h says; the tables agree with a quadrature in double
 * over slopes, which shares nothing with them; reciprocity; the same bits at any number of threads.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "bsdf/rough_dielectric.h"
#include "lib/rng.h"
#include "scene/pack_parts.h"
#include "tests/device/harness.h"

#define BECKMANN CDL_MATERIAL_BECKMANN
#define SEPARABLE CDL_MATERIAL_SEPARABLE
#define THIN CDL_MATERIAL_THIN

static float table[ENERGY_KINDS * ENERGY_KIND_WORDS];

/* Numbers as the kernel below reads them. */
typedef struct Surface {
  float alpha_x, alpha_y, ior; /* ior 0: metal */
  uint flags;
  float low, high; /* bounds of the albedo */
} Surface;

#define METAL(x, y, flags)                                                                         \
  { x, y, 0, flags, 0.99f, 1.0005f }
#define SHEET(x, y, flags)                                                                         \
  { x, y, 1.5f, (flags) | THIN, 0.99f, 1.0005f }
#define GLASS(alpha, ior, flags)                                                                   \
  { alpha, alpha, ior, flags, 0.983f, 1.005f }
#define ANISOTROPIC_GLASS(x, y, ior, flags)                                                        \
  { x, y, ior, flags, 0.8f, 1.1f }

static const Surface surfaces[] = {
    METAL(0.001f, 0.001f, 0),
    METAL(0.02f, 0.02f, 0),
    METAL(0.1f, 0.1f, 0),
    METAL(0.35f, 0.35f, 0),
    METAL(0.6f, 0.6f, 0),
    METAL(1.0f, 1.0f, 0),
    METAL(0.05f, 0.05f, BECKMANN),
    METAL(0.25f, 0.25f, BECKMANN),
    METAL(0.7f, 0.7f, BECKMANN),
    METAL(1.0f, 1.0f, BECKMANN | SEPARABLE),
    METAL(0.03f, 0.03f, SEPARABLE),
    METAL(0.5f, 0.5f, SEPARABLE),
    METAL(0.4f, 0.1f, 0),
    METAL(0.01f, 0.8f, 0),
    METAL(1.0f, 0.2f, SEPARABLE),
    METAL(0.001f, 1.0f, 0),
    METAL(0.3f, 0.06f, BECKMANN),
    METAL(0.002f, 0.9f, BECKMANN | SEPARABLE),
    SHEET(0.3f, 0.3f, 0),
    SHEET(0.8f, 0.2f, BECKMANN),
    GLASS(0.01f, 1.5f, 0),
    GLASS(0.1f, 1.5f, 0),
    GLASS(0.3f, 1.33f, 0),
    GLASS(0.5f, 1.5f, SEPARABLE),
    GLASS(0.7f, 2.4f, 0),
    GLASS(1.0f, 1.5f, 0),
    GLASS(1.0f, 1.05f, 0),
    GLASS(0.4f, 0.7f, 0),
    GLASS(0.9f, 0.45f, SEPARABLE),
    GLASS(0.1f, 1.5f, BECKMANN),
    GLASS(0.45f, 1.8f, BECKMANN),
    GLASS(1.0f, 1.3f, BECKMANN | SEPARABLE),
    GLASS(0.6f, 0.6f, BECKMANN),
    ANISOTROPIC_GLASS(0.2f, 0.4f, 1.5f, 0),
    ANISOTROPIC_GLASS(0.5f, 0.2f, 1.33f, BECKMANN),
};
enum { SURFACES = sizeof surfaces / sizeof *surfaces };

/* cosine, azimuth */
static const double views[][2] = {{1, 0},      {0.85, 0.3}, {0.5, 1.2},
                                  {0.2, 0.75}, {0.06, 1.5}, {0.01, 0.1}};
enum { VIEWS = sizeof views / sizeof *views, PARTS = 16, PER_PART = 8192 };

/* ---- the device's albedo ---- */

static const char kernel[] =
    "#include \"lib/portable.h\"\n"
    "#include \"bsdf/conductor.h\"\n"
    "#include \"bsdf/rough_dielectric.h\"\n"
    "#include \"lib/rng.h\"\n"
    "typedef struct Item { float alpha_x, alpha_y, ior; uint flags; float wo[3]; uint back; } "
    "Item;\n"
    "__kernel void albedo(__global const Item *items, __global const float *energy,\n"
    "                     __global const uint *sizes, __global float *out) {\n"
    "  uint parts = sizes[0], count = sizes[1], id = (uint)get_global_id(0);\n"
    "  __global const Item *item = items + id / parts;\n"
    "  vec3 wo = v3(item->wo[0], item->wo[1], item->wo[2]);\n"
    "  BsdfPoint point;\n"
    "  point.base = v3_all(1.0f);\n"
    "  point.throughput = v3_all(1.0f);\n"
    "  point.coat_normal = v3(0.0f, 0.0f, 1.0f);\n"
    "  point.wavelength = 0.0f;\n"
    "  point.channel_choice = 0.0f;\n"
    "  point.flags = item->flags | CDL_MATERIAL_ENERGY_COMPENSATED;\n"
    "  point.front = item->back == 0u;\n"
    "  point.energy = energy;\n"
    "  ConductorParams metal = conductor_make(point, item->alpha_x, item->alpha_y, v3_all(0.0f),\n"
    "                                         v3_all(1.0f));\n"
    "  RoughDielectricParams glass = rough_dielectric_make(point, item->alpha_x, item->alpha_y,\n"
    "                                item->ior > 0.0f ? item->ior : 1.5f, 0.0f);\n"
    "  float sum = 0.0f;\n"
    "  for (uint k = 0; k < count; k++) {\n"
    "    uint n = rng_hash2(id, k);\n"
    "    float u = rng_to_unit(rng_hash2(n, 0u)), v = rng_to_unit(rng_hash2(n, 1u));\n"
    "    float w = rng_to_unit(rng_hash2(n, 2u));\n"
    "    BsdfSample s = item->ior > 0.0f ? rough_dielectric_sample(glass, wo, u, v, w)\n"
    "                                    : conductor_sample(metal, wo, u, v, w);\n"
    "    sum += s.weight.x * s.eta * s.eta;\n"
    "  }\n"
    "  out[id] = sum / (float)count;\n"
    "}\n";

typedef struct Item {
  float alpha_x, alpha_y, ior;
  uint flags;
  float wo[3];
  uint back;
} Item;

static vec3 view_of(const double view[2]) {
  double sine = sqrt(1 - view[0] * view[0]);
  return v3((float)(sine * cos(view[1])), (float)(sine * sin(view[1])), (float)view[0]);
}

/* Which item a number is of: side, view and surface. */
static void item_of(size_t i, Item *item) {
  const Surface *s = &surfaces[i / 2 / VIEWS];
  vec3 wo = view_of(views[i / 2 % VIEWS]);
  *item = (Item){s->alpha_x, s->alpha_y, s->ior, s->flags, {wo.x, wo.y, wo.z}, i % 2};
}

static void test_albedo(void **state) {
  (void)state;
  static Item items[SURFACES * VIEWS * 2];
  static float out[SURFACES * VIEWS * 2 * PARTS];
  uint sizes[2] = {PARTS, PER_PART};
  float least = 1, most = 1;
  enum { COUNT = SURFACES * VIEWS * 2 };
  Harness *harness = harness_open("Portable");
  if (!harness) harness = harness_open(NULL);
  assert_non_null(harness);
  print_message("%s\n", harness_name(harness));
  for (size_t i = 0; i < COUNT; i++) item_of(i, &items[i]);
  const HarnessBuffer buffers[] = {
      {items, sizeof items}, {table, sizeof table}, {sizes, sizeof sizes}, {out, sizeof out}};
  harness_build(harness, kernel);
  harness_run(harness, "albedo", COUNT * PARTS, buffers, 4);
  harness_close(harness);
  for (size_t i = 0; i < COUNT; i++) {
    const Surface *s = &surfaces[i / 2 / VIEWS];
    double sum = 0, squares = 0;
    for (size_t k = 0; k < PARTS; k++) {
      sum += out[i * PARTS + k];
      squares += (double)out[i * PARTS + k] * out[i * PARTS + k];
    }
    float albedo = (float)(sum / PARTS);
    float error = (float)sqrt(fmax(squares / PARTS - (double)albedo * albedo, 0) / (PARTS - 1));
    if (!(albedo + 3 * error >= s->low && albedo - 3 * error <= s->high))
      fail_msg("alpha %g %g, index %g, flags %u, %s, view %zu: albedo %g +- %g, not in %g to %g",
               s->alpha_x, s->alpha_y, s->ior, s->flags, i % 2 ? "back" : "front", i / 2 % VIEWS,
               albedo, error, s->low, s->high);
    int exact = s->low > 0.98f && error < 4e-4f;
    least = exact ? fminf(least, albedo) : least;
    most = exact ? fmaxf(most, albedo) : most;
  }
  print_message("%d albedos; but for noisy ones and anisotropic glass %.4f to %.4f\n", COUNT, least,
                most);
}

/* ---- the tables against a quadrature over slopes ---- */

typedef struct Rough {
  double ax, ay;
  int beckmann, separable;
} Rough;

static double smith(const Rough *r, const double w[3]) {
  double t2 = (r->ax * r->ax * w[0] * w[0] + r->ay * r->ay * w[1] * w[1]) / (w[2] * w[2]);
  double a = 1 / sqrt(fmax(t2, 1e-30));
  if (r->beckmann) return a > 20 ? 0 : 0.5 * (exp(-a * a) / (a * sqrt(M_PI)) - erfc(a));
  return 0.5 * (sqrt(1 + t2) - 1);
}

/* What becomes of light of Lambda `lo` that leaves along w. */
static double passes(const Rough *r, double lo, const double w[3]) {
  if (w[2] <= 0) return 0;
  double li = smith(r, w);
  return r->separable ? 1 / ((1 + lo) * (1 + li)) : 1 / (1 + lo + li);
}

/* What a facet of slopes p, q returns of light from wo, times the area that wo sees of it. */
static double facet(const Rough *r, const double wo[3], double lo, double p, double q, double eta) {
  double n[3] = {-r->ax * p, -r->ay * q, 1}, length = sqrt(n[0] * n[0] + n[1] * n[1] + 1);
  double area = wo[0] * n[0] + wo[1] * n[1] + wo[2], c = area / length;
  if (area <= 0) return 0;
  double up[3], down[3], f = 1;
  for (int i = 0; i < 3; i++) up[i] = 2 * c * n[i] / length - wo[i];
  double back = passes(r, lo, up), sine2 = (1 - c * c) / (eta * eta);
  if (eta <= 0) return area * back;
  if (sine2 < 1) {
    double ct = sqrt(1 - sine2), s = (c - eta * ct) / (c + eta * ct);
    double t = (eta * c - ct) / (eta * c + ct);
    f = 0.5 * (s * s + t * t);
    for (int i = 0; i < 3; i++) down[i] = wo[i] / eta - (c / eta - ct) * n[i] / length;
    double through[3] = {down[0], down[1], down[2]}; /* the far side, turned up */
    return area * (f * back + (1 - f) * passes(r, lo, through));
  }
  return area * back;
}

/* 1 - E(wo): slopes in polar coordinates, their radius by the tangent of a half turn's part. */
static double loss_over_slopes(const Rough *r, const double wo[3], double eta) {
  enum { RADII = 400, TURNS = 240 };
  double sum = 0, lo = smith(r, wo);
  for (int i = 0; i < RADII; i++) {
    double x = (i + 0.5) / RADII, radius = tan(0.5 * M_PI * x), r2 = radius * radius;
    double spread = 0.5 * M_PI * (1 + r2) / RADII * radius * 2 * M_PI / TURNS;
    double density = r->beckmann ? exp(-r2) / M_PI : 1 / (M_PI * (1 + r2) * (1 + r2));
    for (int k = 0; k < TURNS; k++) {
      double angle = 2 * M_PI * (k + 0.5) / TURNS;
      sum += density * spread * facet(r, wo, lo, radius * cos(angle), radius * sin(angle), eta);
    }
  }
  return 1 - sum / wo[2];
}

static void check_loss(const Surface *s, const double view[2], int back, double *worst) {
  Rough rough = {s->alpha_x, s->alpha_y, (s->flags & BECKMANN) != 0, (s->flags & SEPARABLE) != 0};
  Microfacets m = microfacet_surface(s->alpha_x, s->alpha_y, rough.beckmann, rough.separable);
  const float *of_kind = energy_table(table, m);
  int glass = s->ior > 0 && !(s->flags & THIN);
  float eta = !glass ? 0 : back ? 1 / s->ior : s->ior;
  vec3 wo = view_of(view);
  const double exact[3] = {sqrt(1 - view[0] * view[0]) * cos(view[1]),
                           sqrt(1 - view[0] * view[0]) * sin(view[1]), view[0]};
  double expected = loss_over_slopes(&rough, exact, eta);
  double found =
      glass ? energy_boundary_missing(of_kind, m, wo, eta) : energy_metal_missing(of_kind, m, wo);
  double error = found - expected;
  *worst = fmax(*worst, fabs(error));
  if (error > 0.004 || error < -0.016)
    fail_msg("alpha %g %g, eta %g, flags %u, cosine %g: loses %g, the table says %g", s->alpha_x,
             s->alpha_y, eta, s->flags, view[0], expected, found);
}

/* Slopes of smooth surfaces seen at grazing angles are beyond this quadrature. */
static void test_tables(void **state) {
  (void)state;
  double worst = 0;
  for (size_t i = 0; i < SURFACES; i++)
    for (size_t v = 0; v < VIEWS; v++)
      for (int back = 0; back < 2; back++) {
        const Surface *s = &surfaces[i];
        int isotropic_glass = s->low > 0.98f && s->low < 0.985f;
        if (s->low < 0.98f || fminf(s->alpha_x, s->alpha_y) < 0.05f) continue;
        if (views[v][0] < 0.05 || (back && !isotropic_glass)) continue;
        check_loss(s, views[v], back, &worst);
      }
  print_message("tables err by %.4f at most\n", worst);
}

/* ---- reciprocity ---- */

static vec3 random_direction(uint seed) {
  float u = rng_to_unit(rng_hash2(seed, 1)), v = rng_to_unit(rng_hash2(seed, 2));
  vec3 w = sample_sphere(u, v);
  return v3_normalize(v3(w.x, w.y, math_max(math_abs(w.z), 1e-3f)));
}

static void check_reciprocity(const Surface *s, uint seed) {
  BsdfPoint point = {.base = v3_all(1),
                     .throughput = v3_all(1),
                     .flags = s->flags | CDL_MATERIAL_ENERGY_COMPENSATED,
                     .front = 1,
                     .energy = table};
  vec3 wo = random_direction(2 * seed), wi = random_direction(2 * seed + 1);
  int through = seed % 2 && !(s->flags & THIN);
  RoughDielectricParams here = rough_dielectric_make(point, s->alpha_x, s->alpha_y, s->ior, 0);
  point.front = !through;
  RoughDielectricParams there = rough_dielectric_make(point, s->alpha_x, s->alpha_y, s->ior, 0);
  float side = seed % 2 ? -1 : 1;
  vec3 in = v3(wi.x, wi.y, side * wi.z), out = v3(wo.x, wo.y, side * wo.z);
  double a = rough_dielectric_evaluate(here, wo, in).f_cos.x / wi.z;
  double b = rough_dielectric_evaluate(there, wi, out).f_cos.x / wo.z;
  if (through) a *= (double)s->ior * s->ior;
  if (fabs(a - b) > 1e-3 * fmax(a, b) + 1e-9)
    fail_msg("alpha %g %g, index %g: %g there, %g back", s->alpha_x, s->alpha_y, s->ior, a, b);
}

static void test_reciprocity(void **state) {
  (void)state;
  for (size_t i = 0; i < SURFACES; i++)
    for (uint k = 0; k < 4000 && surfaces[i].ior > 0; k++) check_reciprocity(&surfaces[i], k);
}

/* ---- threads ---- */

static void test_threads(void **state) {
  (void)state;
  static float again[ENERGY_KINDS * ENERGY_KIND_WORDS];
  int threads = omp_get_max_threads();
  omp_set_num_threads(threads > 1 ? 1 : 3);
  pack_energy_metal(0, again);
  pack_energy_glass(0, again);
  omp_set_num_threads(threads);
  assert_memory_equal(again, table, ENERGY_KIND_WORDS * sizeof *again);
}

static int make_tables(void **state) {
  (void)state;
  for (uint kind = 0; kind < ENERGY_KINDS; kind++) {
    pack_energy_metal(kind, table);
    pack_energy_glass(kind, table);
  }
  return 0;
}

int main(void) {
  harness_prepare();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_albedo),
      cmocka_unit_test(test_tables),
      cmocka_unit_test(test_reciprocity),
      cmocka_unit_test(test_threads),
  };
  return cmocka_run_group_tests(tests, make_tables, NULL);
}
