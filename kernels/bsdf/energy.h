/* energy.h: what light loses between microfacets; nothing is made up for yet. */
#ifndef CDL_BSDF_ENERGY_H
#define CDL_BSDF_ENERGY_H
#include "bsdf/microfacet.h"
typedef struct GlassEnergy {
  float compensated;
  float reflected, mean_here, mean_beyond;
  float pad[4];
} GlassEnergy;
CDL_INLINE float energy_metal_missing_mean(Microfacets m) { (void)m; return 1e-3f; }
CDL_INLINE float energy_metal_missing(Microfacets m, vec3 w) { (void)m; (void)w; return 0.0f; }
CDL_INLINE GlassEnergy energy_glass(Microfacets m, float eta, int thin, int compensated) {
  GlassEnergy e;
  (void)m; (void)eta; (void)thin; (void)compensated;
  e.compensated = 0.0f;
  e.reflected = 0.5f;
  e.mean_here = e.mean_beyond = 1e-3f;
  return e;
}
CDL_INLINE float energy_glass_missing(GlassEnergy e, Microfacets m, vec3 w, float eta) {
  (void)e; (void)m; (void)w; (void)eta; return 0.0f;
}
#endif
