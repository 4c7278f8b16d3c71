/* medium.c: what fills a surface or the scene. */
#include <math.h>

#include "bsdf/fresnel.h"
#include "lib/math.h"
#include "scene/build.h"

static cdl_Status add_medium(Builder *builder, const cdl_SceneMedium *medium, uint32_t *index) {
  struct cdl_Scene *scene = builder->scene;
  cdl_SceneMedium *slot = array_push((void **)&scene->media, scene->medium_count, sizeof *slot);
  if (!slot) return document_out_of_memory(builder->doc);
  *slot = *medium;
  *index = scene->medium_count++;
  return CDL_OK;
}

cdl_Status build_medium(Builder *builder, const char *pointer, const json_t *json,
                        uint32_t *index) {
  cdl_SceneMedium medium = {.density = CDL_NONE, .temperature = CDL_NONE, .color = CDL_NONE};
  *index = CDL_NONE;
  cdl_Status status = build_phase(builder, pointer, json_object_get(json, "phase"), &medium.phase);
  if (status) return status;
  json_get_numbers(json, "absorption", 3, medium.absorption);
  json_get_numbers(json, "scattering", 3, medium.scattering);
  json_get_numbers(json, "emission", 3, medium.emission);
  float scale = (float)json_get_number(json, "scale", 1);
  for (int c = 0; c < 3; c++) {
    medium.absorption[c] *= scale;
    medium.scattering[c] *= scale;
    if (!isfinite(medium.absorption[c] + medium.scattering[c]))
      return document_fail(builder->doc, pointer, "VALUE_NOT_IN_RANGE",
                           "scale times the coefficients is beyond single precision.");
  }
  status = build_medium_grid(builder, pointer, json_object_get(json, "grid"), &medium);
  return status ? status : add_medium(builder, &medium, index);
}

/* Albedo of one collision for the colour that many give (Kulla and Conty 2017). */
static float single_albedo(float many) {
  double m = fmin(fmax(many, 0), 1);
  double s = 4.09712 + 4.20863 * m - sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
  return (float)fmin(fmax(1 - s * s, 0), 1);
}

/* Albedo of one isotropic collision under a boundary such that the body reflects `albedo` of the
 * light that has entered it: what the boundary sends back in from below is made up for. A half
 * space reflects (1 - s) (1 - 0.139 s) / (1 + 1.17 s) of diffuse light, s^2 = 1 - albedo of a
 * collision (van de Hulst 1980), which is solved for s. */
static double body_albedo(double albedo, double ior) {
  double inner = fresnel_inner_mean(fminf(fmaxf((float)ior, 1), 3));
  double body = albedo / (1 - inner + inner * albedo);
  double b = 1.139 + 1.17 * body;
  double s = (b - sqrt(b * b - 4 * 0.139 * (1 - body))) / (2 * 0.139);
  return fmin(fmax(1 - s * s, 0), 1);
}

/* Scattering that favours one direction needs as much more of it as leaves the diffusion the same
 * (similarity relation); profiles know it as a longer way. */
void subsurface_stretch(const json_t *json, const float albedo[3], float radius[3]) {
  double ior = json_get_number(json, "ior", 1.4), g = phase_hg(json_get_number(json, "g", 0)).g[0];
  for (int c = 0; c < 3; c++)
    radius[c] *= (float)((1 - g + g * body_albedo(albedo[c], ior)) / (1 - g));
}

/* The inside of a subsurface material. */
cdl_Status build_subsurface_medium(Builder *builder, const json_t *json, uint32_t *index) {
  cdl_SceneMedium medium = {.density = CDL_NONE,
                            .temperature = CDL_NONE,
                            .color = CDL_NONE,
                            .walk = 1,
                            .phase = phase_hg(json_get_number(json, "g", 0))};
  float albedo[3] = {0.5f, 0.5f, 0.5f}, radius[3] = {1e-3f, 1e-3f, 1e-3f};
  double ior = json_get_number(json, "ior", 1.4), g = medium.phase.g[0];
  json_get_numbers(json, "albedo", 3, albedo);
  json_get_numbers(json, "radius", 3, radius);
  for (int c = 0; c < 3; c++) {
    double isotropic = body_albedo(albedo[c], ior);
    double single = isotropic / (1 - g + g * isotropic);
    double sigma = 1 / fmax(radius[c], 1e-6); /* smaller ones are opaque */
    medium.scattering[c] = (float)(single * sigma);
    medium.absorption[c] = (float)(fmax(1 - single, 0) * sigma);
  }
  return add_medium(builder, &medium, index);
}

/* KHR_materials_volume: attenuationColor is what is left after attenuationDistance, so that the
 * extinction is -ln(colour) / distance. A black channel is taken as 1e-6: it has no logarithm.
 * KHR_materials_volume_scatter says which part of the extinction is scattering. */
cdl_Status build_volume(Builder *builder, const json_t *volume, const json_t *scatter,
                        uint32_t *index) {
  cdl_SceneMedium medium = {.density = CDL_NONE, .temperature = CDL_NONE, .color = CDL_NONE};
  float colour[3] = {1, 1, 1}, many[3] = {0, 0, 0}, most = 0;
  double distance = json_get_number(volume, "attenuationDistance", INFINITY);
  *index = CDL_NONE;
  json_get_numbers(volume, "attenuationColor", 3, colour);
  json_get_numbers(scatter, "multiscatterColor", 3, many);
  json_get_numbers(scatter, "multiscatterColorFactor", 3, many);
  double g = json_get_number(scatter, "scatterAnisotropy", 0);
  medium.phase = phase_hg(g);
  for (int c = 0; c < 3; c++) {
    medium.walk |= many[c] > 0;
    double depth = -math_log(fmaxf(colour[c], 1e-6f));
    double sigma = fmin(depth / fmax(distance, 1e-30), 1e30);
    medium.scattering[c] = single_albedo(many[c]) * (float)sigma;
    medium.absorption[c] = (float)sigma - medium.scattering[c];
    most = fmaxf(most, (float)sigma);
  }
  return most > 0 ? add_medium(builder, &medium, index) : CDL_OK;
}
