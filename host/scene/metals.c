/* metals.c: complex indices of refraction of metals, written by scripts/metals.py.
 *
 * Each is a measured spectrum, integrated against the CIE 1931 observer to linear Rec. 709 RGB. Fe,
 * Ni and Ti are those of Johnson and Christy (Phys. Rev. B 9, 5056, 1974), Pt that of Rakic et al.
 * (Appl. Opt. 37, 5271, 1998); the others are the spectra that the Python package mitsuba ships. */
#include <string.h>

#include "scene/build.h"

static const struct {
  const char *name;
  float eta[3], k[3];
} metals[] = {
    {"Ag", {0.1553f, 0.1167f, 0.1384f}, {4.8283f, 3.1222f, 2.1470f}},
    {"Al", {1.6575f, 0.8804f, 0.5212f}, {9.2239f, 6.2695f, 4.8370f}},
    {"Au", {0.1431f, 0.3749f, 1.4425f}, {3.9832f, 2.3857f, 1.6032f}},
    {"Cr", {4.3697f, 2.9167f, 1.6547f}, {5.2064f, 4.2314f, 3.7550f}},
    {"Cu", {0.2004f, 0.9240f, 1.1022f}, {3.9129f, 2.4528f, 2.1422f}},
    {"Fe", {3.5144f, 2.7699f, 2.3018f}, {3.6950f, 2.7861f, 2.4930f}},
    {"Hg", {2.3989f, 1.4400f, 0.9096f}, {6.3276f, 4.3719f, 3.4218f}},
    {"Ir", {3.0864f, 2.0822f, 1.6179f}, {5.5922f, 4.0672f, 3.2673f}},
    {"Mo", {4.4837f, 3.5255f, 2.7761f}, {4.1111f, 3.4209f, 3.1506f}},
    {"Nb", {3.4201f, 2.7902f, 2.3956f}, {3.4414f, 2.7376f, 2.5799f}},
    {"Ni", {2.4232f, 1.8045f, 1.5635f}, {4.9730f, 3.3846f, 2.6033f}},
    {"Pt", {2.7964f, 1.9675f, 1.6543f}, {5.0332f, 3.4786f, 2.7901f}},
    {"Rh", {2.5858f, 1.8602f, 1.5544f}, {6.7823f, 4.7029f, 3.9761f}},
    {"Ta", {2.0626f, 2.3931f, 2.6281f}, {2.4080f, 1.7414f, 1.9470f}},
    {"Ti", {3.2754f, 2.3798f, 2.0248f}, {4.5724f, 3.2245f, 2.7277f}},
    {"W", {4.3707f, 3.3003f, 2.9983f}, {3.5007f, 2.6049f, 2.2732f}},
};

int metal_index(const char *name, float eta[3], float k[3]) {
  for (size_t i = 0; i < sizeof metals / sizeof *metals; i++) {
    if (strcmp(metals[i].name, name) != 0) continue;
    memcpy(eta, metals[i].eta, sizeof metals[i].eta);
    memcpy(k, metals[i].k, sizeof metals[i].k);
    return 1;
  }
  return 0;
}
