/* phase.c: the phase functions of media, each as two lobes of Draine's (media/phase.h). */
#include <math.h>
#include <string.h>

#include "lib/math.h"
#include "scene/build.h"

enum { PHASE_HG, PHASE_TWO_TERM, PHASE_RAYLEIGH, PHASE_DRAINE, PHASE_DROPLETS, PHASE_ISOTROPIC };
static const char *const types[] = {"hg",     "two_term_hg", "rayleigh",
                                    "draine", "droplets",    "isotropic"};

/* Lobes narrower than a few floats of the cosine are none. */
static float limited(double g) { return (float)fmin(fmax(g, -0.99999), 0.99999); }

static void one_lobe(cdl_ScenePhase *phase, double g, double alpha) {
  phase->g[0] = limited(g);
  phase->alpha[0] = (float)fmin(alpha, 1e6); /* from there on alpha changes nothing any more */
}

cdl_ScenePhase phase_hg(double g) {
  cdl_ScenePhase phase = {.type = types[g == 0 ? PHASE_ISOTROPIC : PHASE_HG]};
  phase.g[0] = limited(g);
  return phase;
}

static void henyey_and_draine(cdl_ScenePhase *phase, float hg, float draine, float alpha,
                              float weight) {
  phase->g[0] = limited(hg);
  phase->g[1] = limited(draine);
  phase->alpha[1] = alpha;
  phase->second = weight;
}

/* Droplets of water in air by their diameter d in micrometres, 0 < d <= 50: the fits of Jendersie
 * and d'Eon 2023, An Approximate Mie Scattering Function for Fog and Cloud Rendering, which change
 * at 0.1, 1.5 and 5. */
static void fit_large(float d, cdl_ScenePhase *phase) {
  henyey_and_draine(phase, math_exp(-0.0990567f / (d - 1.67154f)),
                    math_exp(-2.20679f / (d + 3.91029f) - 0.428934f),
                    math_exp(3.62489f - 8.29288f / (d + 5.52825f)),
                    math_exp(-0.599085f / (d - 0.641583f) - 0.665888f));
}

static void fit_middle(float d, cdl_ScenePhase *phase) {
  float l = math_log(d), ll = math_log(l), sine, cosine;
  math_sincos(l, &sine, &cosine); /* for the tangent of l, of which 4.81 is a pole */
  float part = cosine / (fmaf(-2.0f, l, 1.27551f) * cosine + sine);
  henyey_and_draine(phase, 0.0604931f * ll + 0.940256f, 0.500411f - 0.081287f * part,
                    7.30354f * l + 6.31675f,
                    0.026914f * (l - math_cos(5.68947f * (ll - 0.0292149f))) + 0.376475f);
}

static void fit_small(float d, cdl_ScenePhase *phase) {
  float l = math_log(d);
  float inner = math_cos((l - 0.238604f) * (l + 1.00667f) / (0.507522f - 0.15677f * l));
  float draine = math_cos(1.19692f * inner + 1.37932f * l + 0.0625835f);
  henyey_and_draine(phase, 0.862f - 0.143f * l * l, 0.379685f * draine + 0.344213f, 250.0f,
                    0.146209f * math_cos(3.38707f * l + 2.11193f) + 0.316072f + 0.0778917f * l);
}

static void fit_tiny(float d, cdl_ScenePhase *phase) {
  henyey_and_draine(phase, 13.8f * d * d, 1.1456f * d * math_sin(9.29044f * d), 250.0f,
                    0.252977f - 312.983f * math_pow(d, 4.3f));
}

static void fit_droplets(float d, cdl_ScenePhase *phase) {
  if (d >= 5.0f)
    fit_large(d, phase);
  else if (d >= 1.5f)
    fit_middle(d, phase);
  else if (d > 0.1f)
    fit_small(d, phase);
  else
    fit_tiny(d, phase);
}

static int type_index(const char *name) {
  int type = 0;
  while (type < PHASE_ISOTROPIC && strcmp(types[type], name) != 0) type++;
  return type;
}

/* What the schema does not say: members that a type cannot do without, or does not take. */
static cdl_Status check_phase(Builder *builder, const char *pointer, const json_t *json, int type,
                              const float g[2]) {
  if (g[0] >= 1 || g[1] >= 1)
    return document_fail(builder->doc, AT("%.200s/phase/g", pointer), "VALUE_NOT_IN_RANGE",
                         "an asymmetry must be between -1 and 1.");
  if (type != PHASE_TWO_TERM && json_is_array(json_object_get(json, "g")))
    return document_fail(builder->doc, AT("%.200s/phase/g", pointer), "TYPE_MISMATCH",
                         "only two_term_hg has two asymmetries; give one number.");
  if (type == PHASE_DROPLETS && !json_object_get(json, "diameter"))
    return document_fail(builder->doc, AT("%.200s/phase", pointer), "UNDEFINED_PROPERTY",
                         "droplets need a diameter, in micrometres.");
  return CDL_OK;
}

cdl_Status build_phase(Builder *builder, const char *pointer, const json_t *json,
                       cdl_ScenePhase *phase) {
  int type = type_index(json_get_string(json, "type", "isotropic"));
  float g[2] = {0, 0};
  json_get_numbers(json, "g", 2, g);
  cdl_Status status = check_phase(builder, pointer, json, type, g);
  *phase = (cdl_ScenePhase){.type = types[type]};
  if (type == PHASE_HG || type == PHASE_TWO_TERM) one_lobe(phase, g[0], 0);
  if (type == PHASE_RAYLEIGH) one_lobe(phase, 0, 1);
  if (type == PHASE_DRAINE) one_lobe(phase, g[0], json_get_number(json, "alpha", 1));
  if (type == PHASE_TWO_TERM) {
    phase->g[1] = limited(g[1]);
    phase->second = (float)json_get_number(json, "weight", 0.5);
  }
  if (type == PHASE_DROPLETS && !status)
    fit_droplets(fmaxf((float)json_get_number(json, "diameter", 0), 1e-6f), phase);
  return status;
}
