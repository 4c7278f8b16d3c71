/* test_bssrdf.c: kernels/bsdf/profile.h and the probes of bsdf/subsurface.h against the published
 * formulas in double precision, and on a plane and a sphere against integrals. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "bsdf/subsurface.h"
#include "random.h"

enum { SAMPLES = 1000000, BINS = 200 };

static const double PI = 3.14159265358979323846;

typedef struct Case {
  double albedo, radius, eta;
  int dipole;
} Case;

static const Case cases[] = {
    {0.05, 1, 1.4, 0},    {0.3, 0.02, 1, 0}, {0.8, 1e-3, 1.4, 0}, {1, 3, 1.4, 0},
    {0, 1, 1.4, 0},       {0.05, 1, 1.4, 1}, {0.3, 0.02, 1, 1},   {0.7, 1, 1.3, 1},
    {0.9, 1e-3, 1.4, 1},  {0.99, 5, 1.5, 1}, {1, 1, 1.4, 1},      {0, 1, 1.4, 1},
    {0.5, 1e-10, 1.4, 1}, {0.5, 1, 3, 1},
};
enum { CASES = sizeof cases / sizeof *cases };

static Profile profile_of(Case c) {
  float depth = profile_depth((float)c.eta);
  return profile_make((float)c.albedo, (float)c.radius, depth, c.dipole);
}

/* ---- the formulas ---- */

static double diffusion_formula(Case c, double r) {
  double s = 1.9 - c.albedo + 3.5 * pow(c.albedo - 0.8, 2), d = c.radius / s;
  return (exp(-r / d) + exp(-r / (3 * d))) / (8 * PI * d * r);
}

typedef struct Dipole {
  double alpha, sigma, real, virtual, albedo;
} Dipole;

static double boundary(double eta) {
  double f = -1.4399 / (eta * eta) + 0.7099 / eta + 0.6681 + 0.0636 * eta;
  return (1 + f) / (1 - f);
}

/* Jensen et al.'s quantities for a reduced albedo. */
static Dipole dipole_of(double alpha, double radius, double eta) {
  double a = boundary(eta), extinction = 1 / radius, root = sqrt(3 * (1 - alpha));
  Dipole d = {alpha, extinction * root, radius, radius * (1 + 4 * a / 3), 0};
  d.albedo = 0.5 * alpha * (1 + exp(-4.0 / 3 * a * root)) * exp(-root);
  return d;
}

static Dipole dipole_with(Case c) {
  double low = 0, high = 1;
  for (int i = 0; i < 100; i++) {
    double middle = 0.5 * (low + high);
    if (dipole_of(middle, c.radius, c.eta).albedo < c.albedo)
      low = middle;
    else
      high = middle;
  }
  return dipole_of(0.5 * (low + high), c.radius, c.eta);
}

static double dipole_source(double z, double sigma, double r) {
  double d = sqrt(r * r + z * z);
  return z * (1 + sigma * d) * exp(-sigma * d) / (d * d * d);
}

/* Their diffuse reflectance at r over its integral over the plane. */
static double dipole_formula(Dipole d, double r) {
  double sum = dipole_source(d.real, d.sigma, r) + dipole_source(d.virtual, d.sigma, r);
  return sum / (2 * PI * (exp(-d.sigma * d.real) + exp(-d.sigma * d.virtual)));
}

static void profiles_are_the_formulas(void **state) {
  (void)state;
  for (int i = 0; i < CASES; i++) {
    Case c = cases[i];
    Profile p = profile_of(c);
    Dipole d = dipole_with(c);
    double worst = 0;
    for (double r = 1e-3 * c.radius; r < 30 * c.radius && r < p.reach; r *= 1.1) {
      double want = c.dipole ? dipole_formula(d, r) : diffusion_formula(c, r);
      double got = profile_density(p, (float)r);
      worst = fmax(worst, fabs(got / want - 1));
    }
    printf("albedo %g, eta %g, %s: %.1e\n", c.albedo, c.eta, c.dipole ? "dipole" : "diffusion",
           worst);
    assert_true(worst < (c.eta < 2 ? 2e-3 : 2e-2));
  }
}

/* ---- integrals and sampling ---- */

/* The integral of the density over the plane between two radii, by the trapezoidal rule in log r.
 */
static double ring(Profile p, double from, double to) {
  enum { STEPS = 400 };
  double sum = 0, step = log(to / from) / STEPS;
  for (int k = 0; k <= STEPS; k++) {
    double r = fmin(from * exp(step * k), p.reach);
    double weight = k == 0 || k == STEPS ? 0.5 : 1;
    sum += weight * 2 * PI * r * r * profile_density(p, (float)r);
  }
  return sum * step;
}

static double disk(Profile p, double radius) {
  double inner = 1e-5 * p.radius;
  double core = 2 * PI * inner * inner * profile_density(p, (float)inner);
  core *= p.dipole ? 0.5 : 1; /* the one is flat there, the other is 1/r */
  return core + ring(p, inner, 0.1 * p.radius) + ring(p, 0.1 * p.radius, 10 * p.radius) +
         (radius > 10 * p.radius ? ring(p, 10 * p.radius, radius)
                                 : -ring(p, radius, 10 * p.radius));
}

static void profiles_are_normalised(void **state) {
  (void)state;
  for (int i = 0; i < CASES; i++) {
    Profile p = profile_of(cases[i]);
    double whole = disk(p, p.reach) * profile_gain(p);
    printf("case %d: %.6f, to %.3g mean free paths\n", i, whole, p.reach / p.radius);
    assert_true(whole < 1.0003 && whole > 0.9994);
  }
}

static void samples_follow_the_density(void **state) {
  (void)state;
  random_start(11);
  for (int i = 0; i < CASES; i++) {
    Profile p = profile_of(cases[i]);
    double count[BINS + 1] = {0}, chi2 = 0, low = 1e-3 * p.radius, step = log(p.reach / low) / BINS;
    for (int n = 0; n < SAMPLES; n++) {
      float u = random_unit(), w = random_unit();
      double r = profile_sample(p, u, w);
      if (r > low && r <= p.reach) count[(int)fmin(log(r / low) / step, BINS - 1)] += 1;
    }
    int used = 0;
    for (int k = 0; k < BINS; k++) {
      double want = SAMPLES * ring(p, low * exp(step * k), low * exp(step * (k + 1)));
      if (want < 20) continue;
      chi2 += (count[k] - want) * (count[k] - want) / want;
      used++;
    }
    double spread = 2.0 / (9.0 * used);
    double deviate = (cbrt(chi2 / used) - (1 - spread)) / sqrt(spread);
    printf("case %d: chi2 %.1f of %d bins, deviate %.2f\n", i, chi2, used, deviate);
    assert_true(deviate < 3.3);
  }
}

/* ---- probes ---- */

static SubsurfaceProfiles three(double x, double y, double z, int dipole) {
  SubsurfaceParams p = {.albedo = v3(0.9f, 0.6f, 0.3f), .dipole = dipole};
  p.coat.eta = 1.4f;
  p.radius = v3((float)x, (float)y, (float)z);
  return subsurface_profiles(p, v3(0, 0, 0));
}

typedef struct Mean {
  double sum[3], square[3];
} Mean;

static void mean_add(Mean *m, vec3 a) {
  double v[3] = {a.x, a.y, a.z};
  for (int c = 0; c < 3; c++) {
    m->sum[c] += v[c];
    m->square[c] += v[c] * v[c];
  }
}

static void mean_check(const Mean *m, const double want[3], double slack, const char *what) {
  for (int c = 0; c < 3; c++) {
    double mean = m->sum[c] / SAMPLES;
    double error = sqrt(fmax(m->square[c] / SAMPLES - mean * mean, 0) / SAMPLES);
    printf("%s, channel %d: %.5f +- %.5f, expected %.5f\n", what, c, mean, error, want[c]);
    assert_true(fabs(mean - want[c]) < 4 * error + slack);
  }
}

static SubsurfaceProbe draw_probe(SubsurfaceProfiles profiles, vec3 channels, vec3 at, Frame frame,
                                  float share) {
  float u = random_unit(), v = random_unit(), axis = random_unit(), choice = random_unit();
  return subsurface_probe(profiles, channels, at, frame, share, u, v, axis, choice);
}

static Frame tilted(vec3 normal) { return frame_from_tangent(normal, v3(0.3f, 0.9f, 0.2f)); }

/* On a plane each channel gets all of its profile. */
static void planes_return_everything(void **state) {
  (void)state;
  random_start(12);
  vec3 channels = v3(0.5f, 0.3f, 0.2f), normal = v3_normalize(v3(0.2f, -0.3f, 0.9f));
  for (int k = 0; k < 4; k++) {
    float share = k & 1 ? 1.0f : SUBSURFACE_NORMAL_SHARE;
    SubsurfaceProfiles profiles = three(0.01, 0.003, 0.001, k >> 1);
    Frame frame = tilted(normal);
    Mean mean = {{0}, {0}};
    for (int n = 0; n < SAMPLES; n++) {
      SubsurfaceProbe probe = draw_probe(profiles, channels, v3(0, 0, 0), frame, share);
      float down = v3_dot(probe.direction, normal);
      float t = -v3_dot(probe.origin, normal) / down;
      int hit = probe.length > 0 && fabs(down) > 0.1f && t > 0 && t <= probe.length;
      vec3 offset = v3_madd(probe.origin, hit ? t : 0.0f, probe.direction);
      vec3 carried = subsurface_carry(profiles, channels, frame, share, offset, normal);
      mean_add(&mean, v3_select(hit, carried, v3_all(0.0f)));
    }
    const double all[3] = {channels.x, channels.y, channels.z};
    mean_check(&mean, all, 6e-4, k & 1 ? "plane, along the normal" : "plane, three axes");
  }
}

/* The integral of a profile over a sphere of radius 1 from a point of it: rings at the chord d have
 * the area 2 pi d dd, as on a plane. */
static double over_sphere(Profile p) { return profile_gain(p) * disk(p, fmin(2, p.reach)); }

static vec3 sphere_sum(SubsurfaceProfiles profiles, vec3 channels, Frame frame, float share,
                       SubsurfaceProbe probe, vec3 at) {
  vec3 sum = v3_all(0.0f);
  double b = v3_dot(probe.origin, probe.direction), c = v3_length2(probe.origin) - 1.0;
  double root = b * b - c;
  for (int side = -1; side <= 1 && root > 0; side += 2) {
    double t = -b + side * sqrt(root);
    if (!(t > 0) || t > probe.length) continue;
    vec3 x = v3_madd(probe.origin, (float)t, probe.direction);
    vec3 carried = subsurface_carry(profiles, channels, frame, share, v3_sub(x, at), x);
    sum = v3_add(sum, carried);
  }
  return sum;
}

/* Probes along all axes and along the normal alone find the same on a sphere, which the profile may
 * be small or large for. */
static void spheres_return_their_integral(void **state) {
  (void)state;
  random_start(13);
  vec3 channels = v3(0.2f, 0.3f, 0.5f), at = v3_normalize(v3(0.5f, 0.6f, -0.7f));
  for (int k = 0; k < 8; k++) {
    float share = k & 1 ? 1.0f : SUBSURFACE_NORMAL_SHARE;
    SubsurfaceProfiles profiles =
        k & 4 ? three(5, 1, 0.1, k >> 1 & 1) : three(0.1, 0.03, 0.01, k >> 1 & 1);
    Frame frame = tilted(at);
    Mean mean = {{0}, {0}};
    for (int n = 0; n < SAMPLES; n++) {
      SubsurfaceProbe probe = draw_probe(profiles, channels, at, frame, share);
      vec3 found = v3_all(0.0f);
      if (probe.length > 0) found = sphere_sum(profiles, channels, frame, share, probe, at);
      mean_add(&mean, found);
    }
    double want[3] = {channels.x * over_sphere(profiles.x), channels.y * over_sphere(profiles.y),
                      channels.z * over_sphere(profiles.z)};
    mean_check(&mean, want, 2e-3, k & 1 ? "sphere, along the normal" : "sphere, three axes");
  }
}

/* Whatever a file says, probes and weights are numbers. */
static void hostile_values_stay_finite(void **state) {
  (void)state;
  static const float albedos[] = {0, 1e-30f, 0.5f, 1, 7, -3};
  static const float radii[] = {0, 1e-38f, 1e-12f, 1, 1e12f, 3e38f};
  random_start(14);
  for (int n = 0; n < SAMPLES; n++) {
    SubsurfaceParams p = {.dipole = n & 1};
    p.coat.eta = n & 2 ? 1.0f : 3.0f;
    p.albedo = v3_all(albedos[n % 6]);
    p.radius = v3(radii[n / 6 % 6], radii[n / 36 % 6], radii[n / 216 % 6]);
    vec3 at = v3_scale(random_normal(), n & 4 ? 1e4f : 0.0f), normal = random_normal();
    SubsurfaceProfiles profiles = subsurface_profiles(p, at);
    Frame frame = tilted(normal);
    vec3 channels = subsurface_channels(v3(n & 8 ? 0 : 1, 0, n & 16 ? 1e30f : 1e-30f));
    SubsurfaceProbe probe = draw_probe(profiles, channels, at, frame, 0.5f);
    assert_true(isfinite(probe.length));
    vec3 offset = v3_scale(random_normal(), n & 32 ? 0.0f : powf(10, 54 * random_unit() - 40));
    vec3 carried = subsurface_carry(profiles, channels, frame, 0.5f, offset, random_normal());
    assert_true(isfinite(v3_max(carried)) && carried.x >= 0 && carried.y >= 0 && carried.z >= 0);
  }
}

/* ---- the coat ---- */

/* Seen from wo, the coat and a white body return no more than arrives, and little less; where they
 * have densities, samples and values agree. */
static void check_coat(float alpha, float ior, float mu) {
  enum { DRAWS = 40000 };
  uint words[CDL_SUBSURFACE_PARAMS] = {as_uint(alpha), as_uint(alpha), as_uint(ior)};
  BsdfPoint point = {.base = v3_all(1.0f), .front = 1};
  SubsurfaceParams p = subsurface_params(point, words, 1, 0);
  SubsurfaceExitParams out = subsurface_exit_params(point, words, 1, 0);
  vec3 wo = v3(sqrtf(1 - mu * mu), 0, mu);
  double back = 0, under = 0, leaves = 0;
  for (int n = 0; n < DRAWS; n++) {
    float u = random_unit(), v = random_unit(), w = random_unit();
    BsdfSample sample = subsurface_sample(p, wo, u, v, w);
    BsdfValue value = subsurface_evaluate(p, wo, sample.wi);
    if (sample.transmitted)
      under += sample.weight.x;
    else
      back += sample.wi.z > 0 ? sample.weight.x : 0;
    float rest = subsurface_rest(p, wo, w);
    assert_true(rest >= 0 && rest < 1);
    if (!sample.transmitted && !sample.delta && sample.weight.x > 0)
      assert_true(fabsf(sample.weight.x * sample.pdf / value.f_cos.x - 1) < 1e-4f);
    BsdfSample exit = subsurface_exit_sample(out, wo, u, v, w);
    assert_true(fabsf(exit.pdf - subsurface_exit_evaluate(out, wo, exit.wi).pdf) < 1e-6f);
    leaves += exit.weight.x;
  }
  double all = back / DRAWS + under / DRAWS * leaves / DRAWS;
  if (all > 1.003 || all < 0.8)
    printf("alpha %g, index %g, cosine %g: %.4f\n", alpha, ior, mu, all);
  assert_true(all < 1.006 && all > 0.8); /* noise: 0.0015 */
}

static void coats_return_what_arrives(void **state) {
  (void)state;
  static const float alphas[] = {0, 1e-3f, 0.1f, 0.3f, 1}, iors[] = {1, 1.33f, 1.5f, 3},
                     cosines[] = {0.02f, 0.3f, 1};
  random_start(15);
  for (int a = 0; a < 5; a++)
    for (int i = 0; i < 4; i++)
      for (int c = 0; c < 3; c++) check_coat(alphas[a], iors[i], cosines[c]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(profiles_are_the_formulas),     cmocka_unit_test(profiles_are_normalised),
      cmocka_unit_test(samples_follow_the_density),    cmocka_unit_test(planes_return_everything),
      cmocka_unit_test(spheres_return_their_integral), cmocka_unit_test(hostile_values_stay_finite),
      cmocka_unit_test(coats_return_what_arrives),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
