/* pack_energy.c: the tables of kernels/bsdf/energy.h, made when a scene has materials that use
 * them.
 *
 * The loss of a direction is the mean over the facets that it sees, by the kernels' own sampling
 * and masking: exact arithmetic, so that tables have the same bits on every machine and at any
 * number of threads. */
#include "bsdf/energy.h"
#include "scene/pack_parts.h"

/* Facets of a direction, a rank-1 lattice of consecutive Fibonacci numbers. */
enum { METAL_FACETS = 377, METAL_STEP = 233, GLASS_FACETS = 144, GLASS_STEP = 89 };

/* Taken off each node, but no more than BIAS_SHARE of it: interpolation errs by as much, and
 * surfaces must return no more than they get. */
#define BIAS 0.0045f
#define BIAS_SHARE 0.3f

/* The least slant: at 0 directions would have no masking that is finite. */
#define SLANT_MIN 0.02f

/* Steps of the quadrature of means over slant and azimuth. */
enum { METAL_COSINES = 54, METAL_AZIMUTHS = 12, GLASS_COSINES = 108 };

/* As one instruction where the processor has fused multiply-add: as calls they take most of the
 * time. The bits are the same. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("default", "arch=haswell")))
#else
#define CLONES
#endif

static float node(uint i, uint nodes) { return (float)i / (float)(nodes - 1u); }

static Microfacets facets(uint kind, float alpha_x, float alpha_y) {
  return microfacet_surface(alpha_x, alpha_y, (kind & 1u) != 0u, (kind & 2u) != 0u);
}

/* Inverse of energy_alpha_coordinate. */
static float alpha_at(uint i, uint nodes) {
  return math_max(math_sqr(node(i, nodes)), ENERGY_ALPHA_MIN);
}

/* Inverse of energy_view. */
static vec3 direction_at(Microfacets m, float slant, float turn) {
  float x = 1.0f - turn, y = turn, flat = math_sqr(1.0f - slant) / sqrtf(x * x + y * y);
  return v3_normalize(v3(flat * x / m.alpha_x, flat * y / m.alpha_y, slant * slant));
}

/* Inverse of energy_bend_coordinate and energy_bend. */
static float index_at(float x, float about) {
  float y = math_abs(2.0f * x - 1.0f);
  float bend = ENERGY_BEND_MAX * math_min(about * y / (1.0f + about - y), 1.0f);
  float ratio = sqrtf((1.0f - bend) * (1.0f + bend));
  return x < 0.5f ? ratio : 1.0f / ratio;
}

/* ---- losses ---- */

/* Facets that a direction in the plane of X sees on a surface of roughness 1. */
typedef struct Normals {
  float x[METAL_FACETS], y[METAL_FACETS], z[METAL_FACETS];
  uint count;
} Normals;

/* Half of them where the other half, mirrored in that plane, would say the same. */
static void see_normals(int beckmann, int half, float slant, uint count, uint step, Normals *seen) {
  vec3 w = v3_normalize(v3(math_sqr(1.0f - slant), 0.0f, slant * slant));
  seen->count = count;
  for (uint i = 0; i < count; i++) {
    float u = ((float)i + 0.5f) / (float)count;
    float v = ((float)(i * step % count) + 0.5f) / (float)count;
    float across = half ? 0.5f : 1.0f;
    vec3 n = beckmann ? beckmann_visible_normal(w, u, v * across)
                      : microfacet_ggx_visible_normal(w, u * across, v);
    seen->x[i] = n.x;
    seen->y[i] = n.y;
    seen->z[i] = n.z;
  }
}

/* What other facets keep back of light that goes to w, which a facet seen from where Lambda is
 * lambda_o sends there. */
CDL_INLINE float kept_back(Microfacets m, float lambda_o, vec3 w) {
  float lambda = microfacet_lambda(m, w);
  float masked = lambda / (1.0f + lambda + (m.separable ? 0.0f : lambda_o));
  return w.z > 0.0f ? masked : 1.0f;
}

/* The same of all that facet h sends; eta 0: a mirror. */
CDL_INLINE float facet_loss(Microfacets m, vec3 wo, float lambda_o, vec3 h, float eta) {
  float reflected = kept_back(m, lambda_o, fresnel_reflect(wo, h));
  if (eta == 0.0f) return reflected;
  float cosine = math_saturate(v3_dot(wo, h));
  DielectricFresnel f = fresnel_dielectric(cosine, eta);
  vec3 through = v3_normalize(fresnel_refract(wo, h, cosine, f.cos_t, eta));
  float passed = kept_back(m, lambda_o, v3(through.x, through.y, -through.z));
  return math_lerp(passed, reflected, f.reflectance);
}

CDL_INLINE float mean_loss(Microfacets m, vec3 wo, float eta, const Normals *seen) {
  float loss[METAL_FACETS];
  float lambda = microfacet_lambda(m, wo), x = m.alpha_x * wo.x, y = m.alpha_y * wo.y;
  float r = sqrtf(x * x + y * y), c = r > 0.0f ? x / r : 1.0f, s = r > 0.0f ? y / r : 0.0f;
  for (uint i = 0; i < seen->count; i++) {
    float along = c * seen->x[i] - s * seen->y[i], across = s * seen->x[i] + c * seen->y[i];
    vec3 h = v3(m.alpha_x * along, m.alpha_y * across, math_max(seen->z[i], 0.0f));
    loss[i] = facet_loss(m, wo, lambda, v3_normalize(h), eta);
  }
  double sum = 0.0;
  for (uint i = 0; i < seen->count; i++) sum += loss[i];
  float mean = (float)(sum / seen->count);
  return mean - math_min(BIAS, BIAS_SHARE * mean);
}

CLONES static float metal_loss(Microfacets m, vec3 wo, const Normals *seen) {
  if (m.beckmann) return mean_loss(m, wo, 0.0f, seen);
  m.beckmann = 0; /* known to the compiler, which then leaves out the half not taken */
  return mean_loss(m, wo, 0.0f, seen);
}

CLONES static float glass_loss(Microfacets m, vec3 wo, float eta, const Normals *seen) {
  if (m.beckmann) return mean_loss(m, wo, eta, seen);
  m.beckmann = 0;
  return mean_loss(m, wo, eta, seen);
}

static float slant_at(uint i) { return math_max(node(i, ENERGY_SLANTS), SLANT_MIN); }

/* Alphas may change places; the half where that along Y is the greater gives the other. */
static void metal_losses(uint kind, uint j, uint k, const Normals *seen, float *table) {
  Microfacets m = facets(kind, alpha_at(j, ENERGY_ALPHAS), alpha_at(k, ENERGY_ALPHAS));
  float *one = table + (k * ENERGY_ALPHAS + j) * ENERGY_TURNS * ENERGY_SLANTS;
  float *other = table + (j * ENERGY_ALPHAS + k) * ENERGY_TURNS * ENERGY_SLANTS;
  for (uint t = 0; t < ENERGY_TURNS; t++)
    for (uint s = 0; s < ENERGY_SLANTS; s++) {
      vec3 wo = direction_at(m, slant_at(s), node(t, ENERGY_TURNS));
      float loss = metal_loss(m, wo, &seen[s]);
      one[t * ENERGY_SLANTS + s] = loss;
      if (j != k) other[(ENERGY_TURNS - 1 - t) * ENERGY_SLANTS + s] = loss;
    }
}

static void glass_losses(uint kind, uint j, uint b, const Normals *seen, float *table) {
  float alpha = alpha_at(j, ENERGY_ALPHAS);
  Microfacets m = facets(kind, alpha, alpha);
  float *row = table + ENERGY_GLASS_AT + (b * ENERGY_ALPHAS + j) * ENERGY_SLANTS;
  for (uint s = 0; s < ENERGY_SLANTS; s++) {
    vec3 wo = direction_at(m, slant_at(s), 0.0f);
    row[s] = glass_loss(m, wo, index_at(node(b, ENERGY_BENDS), wo.z + alpha), &seen[s]);
  }
}

/* ---- means ---- */

/* Mean over the cosine of what kernels look up, over its spread; eta 0: metal. The midpoints are of
 * the slant, whatever the azimuth's alpha. */
CDL_INLINE float looked_up_mean(const float *table, Microfacets m, float eta, int cosines,
                                int azimuths) {
  double sum = 0.0;
  for (int a = 0; a < azimuths; a++) {
    float sine, cosine;
    math_sincos_2pi(0.25f * ((float)a + 0.5f) / (float)azimuths, &sine, &cosine);
    float x = m.alpha_x * cosine, y = m.alpha_y * sine, along2 = x * x + y * y, before = 0.0f;
    for (int i = 0; i < cosines; i++) {
      float middle = ((float)i + 0.5f) / (float)cosines, end = ((float)i + 1.0f) / (float)cosines;
      float up = math_sqr(middle * middle), flat = math_sqr(math_sqr(1.0f - middle));
      float cos2 = up * along2 / (up * along2 + flat);
      float end_up = math_sqr(end * end), end_flat = math_sqr(math_sqr(1.0f - end));
      float after = end_up * along2 / (end_up * along2 + end_flat); /* squared cosine */
      float s = sqrtf(1.0f - cos2);
      vec3 w = v3(s * cosine, s * sine, sqrtf(cos2));
      float loss = eta == 0.0f ? energy_metal_missing(table, m, w)
                               : energy_boundary_missing(table, m, w, eta);
      sum += (double)loss * ((double)after - before);
      before = after;
    }
  }
  return (float)(sum / azimuths) / energy_spread(m);
}

CLONES static float metal_mean(const float *table, Microfacets m) {
  return looked_up_mean(table, m, 0.0f, METAL_COSINES, METAL_AZIMUTHS);
}

CLONES static float glass_mean(const float *table, Microfacets m, float eta) {
  return looked_up_mean(table, m, eta, GLASS_COSINES, 1);
}

/* Of isotropic glass; kernels take the others' from that. */
static void glass_means(uint kind, uint j, float *table) {
  float alpha = alpha_at(j, ENERGY_MEAN_ALPHAS);
  Microfacets m = facets(kind, alpha, alpha);
  for (uint b = 0; b < ENERGY_MEAN_BENDS; b++) {
    float eta = index_at(node(b, ENERGY_MEAN_BENDS), energy_alpha_coordinate(alpha));
    table[ENERGY_GLASS_MEAN_AT + b * ENERGY_MEAN_ALPHAS + j] = glass_mean(table, m, eta);
  }
}

static void metal_means(uint kind, uint j, uint k, float *table) {
  const uint n = ENERGY_MEAN_ALPHAS;
  float mean = metal_mean(table, facets(kind, alpha_at(j, n), alpha_at(k, n)));
  table[ENERGY_METAL_MEAN_AT + k * n + j] = mean;
  table[ENERGY_METAL_MEAN_AT + j * n + k] = mean;
}

/* ---- tables ---- */

static void see_all(uint kind, int half, uint count, uint step, Normals *seen) {
  for (uint s = 0; s < ENERGY_SLANTS; s++)
    see_normals((kind & 1u) != 0u, half, slant_at(s), count, step, &seen[s]);
}

void pack_energy_metal(uint kind, float *all) {
  float *table = all + kind * ENERGY_KIND_WORDS;
  Normals seen[ENERGY_SLANTS];
  see_all(kind, 0, METAL_FACETS, METAL_STEP, seen);
#pragma omp parallel for schedule(dynamic)
  for (uint k = 0; k < ENERGY_ALPHAS; k++)
    for (uint j = 0; j <= k; j++) metal_losses(kind, j, k, seen, table);
#pragma omp parallel for schedule(dynamic)
  for (uint k = 0; k < ENERGY_MEAN_ALPHAS; k++)
    for (uint j = 0; j <= k; j++) metal_means(kind, j, k, table);
}

void pack_energy_glass(uint kind, float *all) {
  float *table = all + kind * ENERGY_KIND_WORDS;
  Normals seen[ENERGY_SLANTS];
  see_all(kind, 1, GLASS_FACETS, GLASS_STEP, seen);
#pragma omp parallel for schedule(dynamic)
  for (uint b = 0; b < ENERGY_BENDS; b++)
    for (uint j = 0; j < ENERGY_ALPHAS; j++) glass_losses(kind, j, b, seen, table);
#pragma omp parallel for schedule(dynamic)
  for (uint j = 0; j < ENERGY_MEAN_ALPHAS; j++) glass_means(kind, j, table);
}

/* Metal's tables for metal and sheets; glass needs them only where it is a sheet. */
cdl_Status pack_energy(const cdl_Log *log, cdl_Pack *pack) {
  int metal[ENERGY_KINDS] = {0}, glass[ENERGY_KINDS] = {0};
  if (!pack->features.energy_compensation) return CDL_OK;
  pack->energy_count = (size_t)ENERGY_KINDS * ENERGY_KIND_WORDS;
  pack->energy_table =
      pack_array(log, "energy tables", pack->energy_count, sizeof *pack->energy_table);
  if (!pack->energy_table) return CDL_BAD_INPUT;
  for (size_t i = 0; i < pack->material_count; i++) {
    const uint32_t flags = pack->materials[i].flags, model = pack->materials[i].model;
    const uint32_t kind =
        energy_kind((flags & CDL_MATERIAL_BECKMANN) != 0, (flags & CDL_MATERIAL_SEPARABLE) != 0);
    if (!(flags & CDL_MATERIAL_ENERGY_COMPENSATED)) continue;
    int sheet = model == CDL_MODEL_ROUGH_DIELECTRIC && (flags & CDL_MATERIAL_THIN);
    metal[kind] |= model == CDL_MODEL_CONDUCTOR || sheet;
    glass[kind] |= model == CDL_MODEL_ROUGH_DIELECTRIC && !sheet;
  }
  for (uint32_t kind = 0; kind < ENERGY_KINDS; kind++) {
    if (metal[kind]) pack_energy_metal(kind, pack->energy_table);
    if (glass[kind]) pack_energy_glass(kind, pack->energy_table);
  }
  return CDL_OK;
}
