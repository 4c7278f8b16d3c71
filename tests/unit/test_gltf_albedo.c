/* test_gltf_albedo.c: the fits of bsdf/gltf_albedo.h against a quadrature in double over the slopes
 * of facets: above it, by no more than its header says. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "lib/portable.h"

#include "bsdf/gltf_albedo.h"

typedef struct Exact {
  double white, edge;
} Exact;

static double lambda(double ax, double ay, const double w[3]) {
  double t2 = (ax * ax * w[0] * w[0] + ay * ay * w[1] * w[1]) / (w[2] * w[2]);
  return 0.5 * (sqrt(1 + t2) - 1);
}

/* A facet of slopes ax p and ay q: adds what it returns of light from wo, times `share`. */
static void add_facet(double ax, double ay, const double wo[3], double p, double q, double share,
                      Exact *sum) {
  double n[3] = {-ax * p, -ay * q, 1}, up[3], length = sqrt(n[0] * n[0] + n[1] * n[1] + 1);
  double area = wo[0] * n[0] + wo[1] * n[1] + wo[2], c = area / length;
  for (int i = 0; i < 3; i++) up[i] = 2 * c * n[i] / length - wo[i];
  if (area <= 0 || up[2] <= 0) return;
  double returned = share * area / (1 + lambda(ax, ay, up));
  sum->white += returned;
  sum->edge += returned * pow(1 - fmin(c, 1), 5);
}

static Exact integrate(double ax, double ay, const double wo[3]) {
  enum { RADII = 1000, TURNS = 360 };
  Exact sum = {0, 0};
  for (int i = 0; i < RADII; i++) {
    double radius = tan(0.5 * M_PI * (i + 0.5) / RADII), r2 = radius * radius;
    double share = radius / (RADII * (1 + r2)) / TURNS; /* of GGX's slopes, the Jacobian in it */
    for (int k = 0; k < TURNS; k++) {
      double angle = 2 * M_PI * (k + 0.5) / TURNS;
      add_facet(ax, ay, wo, radius * cos(angle), radius * sin(angle), M_PI * share, &sum);
    }
  }
  double seen = (1 + lambda(ax, ay, wo)) * wo[2];
  return (Exact){sum.white / seen, sum.edge / seen};
}

static const double cosines[] = {1, 0.9, 0.7, 0.5, 0.3, 0.2, 0.12};
static const double f0s[] = {0, 0.04, 0.25, 1};

/* The most that E may be too high, by f0. */
static const double isotropic[] = {0.006, 0.006, 0.0075, 0.0175};
static const double anisotropic[] = {0.4, 0.4, 0.45, 0.6};

static void check(double ax, double ay, double cosine, double turn, const double *most) {
  double sine = sqrt(1 - cosine * cosine), wo[3] = {sine * cos(turn), sine * sin(turn), cosine};
  Microfacets m = microfacet_surface((float)ax, (float)ay, 0, 1);
  vec3 w = v3((float)wo[0], (float)wo[1], (float)wo[2]);
  GltfFacets facets = ax == ay ? gltf_facets(sqrtf((float)ax)) : gltf_facets_toward(m, w);
  GltfAlbedo found = gltf_albedo(facets, w.z);
  Exact exact = integrate(ax, ay, wo);
  for (int i = 0; i < 4; i++) {
    double over = gltf_reflected(found, (float)f0s[i], 1) -
                  (f0s[i] * exact.white + (1 - f0s[i]) * exact.edge);
    if (!(over > -3e-4 && over < most[i]))
      fail_msg("alpha %g %g, cosine %g, f0 %g: too high by %g", ax, ay, cosine, f0s[i], over);
  }
}

static void test_isotropic(void **state) {
  (void)state;
  for (double roughness = 0.3; roughness < 1.01; roughness += 0.1)
    for (size_t i = 0; i < sizeof cosines / sizeof *cosines; i++)
      check(roughness * roughness, roughness * roughness, cosines[i], 0, isotropic);
}

static void test_anisotropic(void **state) {
  (void)state;
  for (int i = 0; i < 7; i++)
    for (int turn = 0; turn < 3; turn++) {
      check(1, 0.3, cosines[i], turn * M_PI / 4, anisotropic);
      check(0.5, 0.15, cosines[i], turn * M_PI / 4, anisotropic);
    }
}

/* The mean is not above that of the fit, and not far below; by Simpson's rule. */
static void test_means(void **state) {
  (void)state;
  enum { STEPS = 4000 };
  for (double roughness = 0.04; roughness < 1.001; roughness += 0.04) {
    GltfFacets facets = gltf_facets((float)roughness);
    GltfAlbedo mean = gltf_albedo_mean(facets);
    double white = 0, edge = 0;
    for (int i = 0; i <= STEPS; i++) {
      double root = (double)i / STEPS, weight = i % STEPS == 0 ? 1 : i % 2 ? 4 : 2;
      GltfAlbedo at = gltf_albedo(facets, (float)(root * root));
      white += at.white * weight / (3.0 * STEPS) * 4 * root * root * root;
      edge += at.edge * weight / (3.0 * STEPS) * 4 * root * root * root;
    }
    assert_true(mean.white < white + 1e-5 && mean.white > white - 0.004);
    assert_true(mean.edge < edge + 1e-5 && mean.edge > edge - 0.001);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_isotropic),
      cmocka_unit_test(test_anisotropic),
      cmocka_unit_test(test_means),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
