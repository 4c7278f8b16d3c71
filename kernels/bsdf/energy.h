/* energy.h: how much light single scattering between rough facets loses, for models that give it
 * back (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks").
 *
 * 1 - E(w) is what a surface that absorbs nothing keeps back of light from w. It is interpolated
 * from a table that the host makes when a scene needs it (host/scene/pack_energy.c), and so is its
 * mean over the cosine, which is that of the interpolant, so that all of it comes back:
 * f = (1 - E(wo)) (1 - E(wi)) / (pi mean).
 *
 * The axes follow what the loss depends on: the direction where the surface is stretched to
 * roughness 1, both alphas, and for glass the index by its critical angle, in the scale of cosine
 * plus alpha, because all happens near that where the index is near 1.
 *
 * What white surfaces return, alpha from 0.001 to 1, cosine from 0.01, relative index from 0.4 to
 * 2.5 from either side: metal and sheets 0.991 to 1.0005 (Beckmann of very unlike alphas 1.002);
 * isotropic glass 0.984 to 1.006, and 0.99 to 1.0005 in 98 of 100 cases. Anisotropic glass counts
 * as isotropic glass of the alpha along the view, which misses what happens across it: 0.76 to 1.19
 * for alphas of up to 1 to 4, 0.64 to 1.21 for any, off by 0.01 to 0.04 on average.
 *
 * A kernel built with CDL_ENERGY_COMPENSATION 0 does without; its results are those with
 * compensation off. */
#ifndef CDL_BSDF_ENERGY_H
#define CDL_BSDF_ENERGY_H

#include "bsdf/dielectric.h"
#include "bsdf/microfacet.h"

#ifndef CDL_ENERGY_COMPENSATION
#define CDL_ENERGY_COMPENSATION 1
#endif

/* Nodes of the axes, from 0 to 1; the first of each list is the innermost. */
#define ENERGY_SLANTS 28u
#define ENERGY_TURNS 6u
#define ENERGY_ALPHAS 16u      /* along X, along Y */
#define ENERGY_MEAN_ALPHAS 61u /* whole cells to each of the above */
#define ENERGY_BENDS 65u
#define ENERGY_MEAN_BENDS 193u

/* The table of one kind of facets, and where in it the parts begin: loss of metal by slant, turn,
 * alpha along X and along Y; its mean by those alphas; loss of glass by slant, alpha and bend; its
 * mean by alpha and bend. Means are over energy_spread. */
#define ENERGY_METAL_MEAN_AT (ENERGY_SLANTS * ENERGY_TURNS * ENERGY_ALPHAS * ENERGY_ALPHAS)
#define ENERGY_GLASS_AT (ENERGY_METAL_MEAN_AT + ENERGY_MEAN_ALPHAS * ENERGY_MEAN_ALPHAS)
#define ENERGY_GLASS_MEAN_AT (ENERGY_GLASS_AT + ENERGY_SLANTS * ENERGY_ALPHAS * ENERGY_BENDS)
#define ENERGY_KIND_WORDS (ENERGY_GLASS_MEAN_AT + ENERGY_MEAN_ALPHAS * ENERGY_MEAN_BENDS)
#define ENERGY_KINDS 4u /* GGX, Beckmann; the same with separable masking */

#define ENERGY_ALPHA_MIN 1e-3f /* smoother ones differ by the scale of the cosine alone */
#define ENERGY_ETA_MAX 4.0f
#define ENERGY_BEND_MAX 0.968245837f /* sine of the angle whose cosine is 1 / ENERGY_ETA_MAX */
#define ENERGY_MEAN_MIN 1e-9f

CDL_INLINE uint energy_kind(int beckmann, int separable) {
  return (beckmann ? 1u : 0u) + (separable ? 2u : 0u);
}

/* ---- coordinates ---- */

/* A direction where the surface is stretched to roughness 1. */
typedef struct EnergyView {
  float slant; /* r / (1 + r), r the root of the cotangent */
  float turn;  /* y / (x + y) of its azimuth */
  float along; /* alpha of the surface along it */
  float pad0, pad1;
} EnergyView;

CDL_INLINE EnergyView energy_view(Microfacets m, vec3 w) {
  EnergyView view;
  float x = math_abs(m.alpha_x * w.x);
  float y = math_abs(m.alpha_y * w.y);
  float stretched = sqrt(fma(x, x, y * y));
  float sine = sqrt(fma(w.x, w.x, w.y * w.y));
  float root = sqrt(math_max(w.z, 1e-12f));
  view.slant = root / (root + sqrt(stretched));
  view.turn = y / math_max(x + y, 1e-30f);
  view.along = sine > 1e-12f ? stretched / math_max(sine, 1e-12f) : m.alpha_x;
  view.pad0 = 0.0f;
  view.pad1 = 0.0f;
  return view;
}

CDL_INLINE float energy_alpha_coordinate(float alpha) { return sqrt(alpha); }

/* Half the mean square of the alpha along all azimuths: what the mean loss is in proportion to. */
CDL_INLINE float energy_spread(Microfacets m) {
  return 0.5f * fma(m.alpha_x, m.alpha_x, m.alpha_y * m.alpha_y);
}

/* The cosine of the critical angle over the greatest: of total reflection and negative for eta < 1,
 * of the directions beyond for eta > 1. */
CDL_INLINE float energy_bend(float eta) {
  float ratio = math_max(math_min(eta, 1.0f / eta), 1.0f / ENERGY_ETA_MAX);
  float bend = sqrt((1.0f - ratio) * (1.0f + ratio)) * (1.0f / ENERGY_BEND_MAX);
  return eta < 1.0f ? -bend : bend;
}

/* In the scale of `about` > 0, cosine plus alpha. */
CDL_INLINE float energy_bend_coordinate(float bend, float about) {
  return fma(0.5f * (1.0f + about), bend / (math_abs(bend) + about), 0.5f);
}

/* ---- interpolation ---- */

typedef struct EnergyCell {
  uint node; /* below */
  float part;
  float pad0, pad1, pad2;
} EnergyCell;

CDL_INLINE EnergyCell energy_cell(float x, uint nodes) {
  EnergyCell cell;
  float last = (float)(nodes - 1u);
  float at = (x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f) * last;
  cell.node = (uint)math_min(at, last - 1.0f);
  cell.part = at - (float)cell.node;
  cell.pad0 = 0.0f;
  cell.pad1 = 0.0f;
  cell.pad2 = 0.0f;
  return cell;
}

CDL_INLINE float energy_mix(float a, float b, EnergyCell x) { return fma(x.part, b - a, a); }

CDL_INLINE float energy_line(CDL_GLOBAL const float *table, uint at, EnergyCell x) {
  return energy_mix(table[at + x.node], table[at + x.node + 1u], x);
}

CDL_INLINE float energy_plane(CDL_GLOBAL const float *table, uint at, EnergyCell x, EnergyCell y,
                              uint row) {
  uint from = at + row * y.node;
  return energy_mix(energy_line(table, from, x), energy_line(table, from + row, x), y);
}

CDL_INLINE float energy_cube(CDL_GLOBAL const float *table, uint at, EnergyCell x, EnergyCell y,
                             EnergyCell z, uint row, uint plane) {
  uint from = at + plane * z.node;
  return energy_mix(energy_plane(table, from, x, y, row),
                    energy_plane(table, from + plane, x, y, row), z);
}

/* ---- look-ups; `table` is that of the kind of facets ---- */

CDL_INLINE CDL_GLOBAL const float *energy_table(CDL_GLOBAL const float *all, Microfacets m) {
  return all + ENERGY_KIND_WORDS * energy_kind(m.beckmann, m.separable);
}

/* 1 - E(w) of white metal and of clear sheets, w.z > 0. */
CDL_INLINE float energy_metal_missing(CDL_GLOBAL const float *table, Microfacets m, vec3 w) {
  EnergyView view = energy_view(m, w);
  EnergyCell slant = energy_cell(view.slant, ENERGY_SLANTS);
  EnergyCell turn = energy_cell(view.turn, ENERGY_TURNS);
  EnergyCell x = energy_cell(energy_alpha_coordinate(m.alpha_x), ENERGY_ALPHAS);
  EnergyCell y = energy_cell(energy_alpha_coordinate(m.alpha_y), ENERGY_ALPHAS);
  uint plane = ENERGY_SLANTS * ENERGY_TURNS;
  uint cube = plane * ENERGY_ALPHAS;
  uint at = cube * y.node;
  float low = energy_cube(table, at, slant, turn, x, ENERGY_SLANTS, plane);
  float high = energy_cube(table, at + cube, slant, turn, x, ENERGY_SLANTS, plane);
  return energy_mix(low, high, y);
}

/* Its mean over the cosine, > 0. */
CDL_INLINE float energy_metal_missing_mean(CDL_GLOBAL const float *table, Microfacets m) {
  EnergyCell x = energy_cell(energy_alpha_coordinate(m.alpha_x), ENERGY_MEAN_ALPHAS);
  EnergyCell y = energy_cell(energy_alpha_coordinate(m.alpha_y), ENERGY_MEAN_ALPHAS);
  float ratio = energy_plane(table, ENERGY_METAL_MEAN_AT, x, y, ENERGY_MEAN_ALPHAS);
  return math_max(energy_spread(m) * ratio, ENERGY_MEAN_MIN);
}

/* 1 - E(w) of a boundary seen from where the other side has the relative index eta: that of
 * isotropic glass with the alpha along w. */
CDL_INLINE float energy_boundary_missing(CDL_GLOBAL const float *table, Microfacets m, vec3 w,
                                         float eta) {
  EnergyView view = energy_view(m, w);
  EnergyCell slant = energy_cell(view.slant, ENERGY_SLANTS);
  EnergyCell x = energy_cell(energy_alpha_coordinate(view.along), ENERGY_ALPHAS);
  float about = math_max(w.z, 0.0f) + view.along;
  EnergyCell b = energy_cell(energy_bend_coordinate(energy_bend(eta), about), ENERGY_BENDS);
  return energy_cube(table, ENERGY_GLASS_AT, slant, x, b, ENERGY_SLANTS,
                     ENERGY_SLANTS * ENERGY_ALPHAS);
}

/* Its mean over the cosine at all azimuths where the square of alpha is alpha2. */
CDL_INLINE float energy_boundary_mean_at(CDL_GLOBAL const float *table, float alpha2, float bend) {
  float root = energy_alpha_coordinate(sqrt(alpha2));
  EnergyCell x = energy_cell(root, ENERGY_MEAN_ALPHAS);
  EnergyCell b = energy_cell(energy_bend_coordinate(bend, root), ENERGY_MEAN_BENDS);
  return alpha2 * energy_plane(table, ENERGY_GLASS_MEAN_AT, x, b, ENERGY_MEAN_ALPHAS);
}

/* Its mean over the cosine, > 0, by four azimuths in the middle of eighths of half a turn. */
CDL_INLINE float energy_boundary_missing_mean(CDL_GLOBAL const float *table, Microfacets m,
                                              float eta) {
  float bend = energy_bend(eta);
  float x = m.alpha_x * m.alpha_x;
  float y = m.alpha_y * m.alpha_y;
  float a = energy_boundary_mean_at(table, fma(0.961939766f, x, 0.0380602337f * y), bend);
  float b = energy_boundary_mean_at(table, fma(0.691341716f, x, 0.308658284f * y), bend);
  float c = energy_boundary_mean_at(table, fma(0.308658284f, x, 0.691341716f * y), bend);
  float d = energy_boundary_mean_at(table, fma(0.0380602337f, x, 0.961939766f * y), bend);
  return math_max(0.25f * (a + b + c + d), ENERGY_MEAN_MIN);
}

/* ---- glass ---- */

/* What a dielectric boundary, or a thin sheet, keeps back, and how it shares it out. */
typedef struct GlassEnergy {
  float compensated;            /* 1, else 0 */
  float mean_here, mean_beyond; /* mean of 1 - E over the cosine, on the side of wo and beyond */
  float reflected;              /* share of it that comes back on the side of wo */
  int thin;
#if CDL_ENERGY_COMPENSATION
  CDL_GLOBAL const float *table;
#endif
} GlassEnergy;

#if CDL_ENERGY_COMPENSATION

/* Reflected share x of side o, with 1 - x_o = (1 - F_o) mean_t / max(mean_o, mean_t): reciprocal,
 * because n_o^2 (1 - F_o) = n_t^2 (1 - F_t) for Fresnel's means over the cosine (Kulla and Conty
 * 2017; their fit of F for the denser side, the other from that identity). */
CDL_INLINE GlassEnergy energy_glass(CDL_GLOBAL const float *all, Microfacets m, float eta, int thin,
                                    int compensated) {
  GlassEnergy e;
  e.table = energy_table(all, m);
  float metal = energy_metal_missing_mean(e.table, m);
  float here = energy_boundary_missing_mean(e.table, m, eta);
  float beyond = energy_boundary_missing_mean(e.table, m, 1.0f / eta);
  float denser = math_max(eta, 1.0f / eta);
  float fresnel = (denser - 1.0f) / fma(1.00071f, denser, 4.08567f);
  float passes = (1.0f - fresnel) * (eta < 1.0f ? eta * eta : 1.0f);
  float share = 1.0f - passes * beyond / math_max(here, beyond);
  e.compensated = compensated ? 1.0f : 0.0f;
  e.mean_here = thin ? metal : here;
  e.mean_beyond = thin ? metal : beyond;
  e.reflected = thin ? dielectric_sheet(fresnel) : share;
  e.thin = thin;
  return e;
}

/* 1 - E(w), w.z > 0, on the side from which the other has the relative index eta. */
CDL_INLINE float energy_glass_missing(GlassEnergy e, Microfacets m, vec3 w, float eta) {
  float metal = energy_metal_missing(e.table, m, w);
  float glass = energy_boundary_missing(e.table, m, w, eta);
  return e.thin ? metal : glass;
}

#else

CDL_INLINE GlassEnergy energy_glass_none(int thin) {
  GlassEnergy e;
  e.compensated = 0.0f;
  e.mean_here = 1.0f;
  e.mean_beyond = 1.0f;
  e.reflected = 0.5f;
  e.thin = thin;
  return e;
}

#endif

#endif
