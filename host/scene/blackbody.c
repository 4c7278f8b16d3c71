#include "scene/blackbody.h"

#include "lib/math.h"

/* A Gauss curve of two unlike sides; `below` and `above` are one over their widths, 1/nm. */
static float lobe(float wavelength, float middle, float below, float above) {
  float t = (wavelength - middle) * (wavelength < middle ? below : above);
  return math_exp(-0.5f * t * t);
}

/* The colour matching functions of CIE 1931 (Wyman, Sloan and Shirley 2013, "Simple Analytic
 * Approximations to the CIE XYZ Color Matching Functions", multi-lobe fit); nm. */
static void matching(float w, float xyz[3]) {
  xyz[0] = 0.362f * lobe(w, 442.0f, 0.0624f, 0.0374f) + 1.056f * lobe(w, 599.8f, 0.0264f, 0.0323f) -
           0.065f * lobe(w, 501.1f, 0.0490f, 0.0382f);
  xyz[1] = 0.821f * lobe(w, 568.8f, 0.0213f, 0.0247f) + 0.286f * lobe(w, 530.9f, 0.0613f, 0.0322f);
  xyz[2] = 1.217f * lobe(w, 437.0f, 0.0845f, 0.0278f) + 0.681f * lobe(w, 459.0f, 0.0385f, 0.0725f);
}

/* Planck's law over the wavelength, up to a factor. */
static float planck(float wavelength, float kelvin) {
  float um = wavelength * 1e-3f;
  float depth = 14387.77f / (um * kelvin);
  if (!(depth < 85.0f)) return 0.0f;
  return 1.0f / (um * um * um * um * um * math_expm1(depth));
}

static void integrate(float kelvin, float xyz[3]) {
  xyz[0] = xyz[1] = xyz[2] = 0.0f;
  for (int w = 380; w <= 780; w += 5) {
    float to[3], power = planck((float)w, kelvin);
    matching((float)w, to);
    for (int c = 0; c < 3; c++) xyz[c] += power * to[c];
  }
}

void blackbody_radiance(float kelvin, float rgb[3]) {
  static const float to_rgb[3][3] = {{3.2404542f, -1.5371385f, -0.4985314f},
                                     {-0.9692660f, 1.8760108f, 0.0415560f},
                                     {0.0556434f, -0.2040259f, 1.0572252f}};
  float xyz[3] = {0.0f, 0.0f, 0.0f}, unit[3];
  integrate(1500.0f, unit);
  if (kelvin > 0.0f) integrate(kelvin, xyz);
  for (int c = 0; c < 3; c++) {
    float sum = to_rgb[c][0] * xyz[0] + to_rgb[c][1] * xyz[1] + to_rgb[c][2] * xyz[2];
    rgb[c] = math_max(sum / unit[1], 0.0f);
  }
}
