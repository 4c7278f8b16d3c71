#!/usr/bin/env python3
"""Writes host/scene/metals.c: the complex index of refraction of metals as linear Rec. 709 RGB.

    metals.py FOLDER > host/scene/metals.c

FOLDER holds NAME.eta.spd and NAME.k.spd (the folder data/ior of the Python package mitsuba). Needs
numpy and colour-science. Iron, nickel, titanium and platinum, which are not there, stand below.

The spectrum s of eta or of k becomes RGB as a reflectance-like spectrum does in renderers that take
RGB for spectra: XYZ = sum(s * cmf) / sum(ybar) over 360 to 830 nm with the CIE 1931 observer, and
RGB = M XYZ with the Rec. 709 matrix for D65, without adaptation.
"""
import sys
import numpy as np

MATRIX = np.array([[3.240479, -1.537150, -0.498535], [-0.969256, 1.875991, 0.041556],
                   [0.055648, -0.204043, 1.057311]])

FROM_FOLDER = {"Ag": "silver", "Al": "aluminium", "Au": "gold", "Cr": "chromium", "Cu": "copper",
               "Hg": "mercury", "Ir": "iridium", "Mo": "molybdenum", "Nb": "niobium",
               "Rh": "rhodium", "Ta": "tantalum", "W": "tungsten"}

# Johnson and Christy, Phys. Rev. B 9, 5056 (1974): wavelength in um, eta and k.
JOHNSON = np.array([.354, .368, .381, .397, .413, .431, .451, .471, .496, .521, .549, .582, .617,
                    .659, .704, .756, .821, .892])
IRON = ([1.93, 2.02, 2.12, 2.24, 2.35, 2.48, 2.59, 2.67, 2.74, 2.86, 2.95, 2.94, 2.88, 2.92, 2.86,
         2.87, 2.94, 2.96],
        [2.35, 2.43, 2.50, 2.58, 2.65, 2.71, 2.77, 2.82, 2.88, 2.91, 2.93, 2.99, 3.05, 3.10, 3.19,
         3.28, 3.39, 3.56])
NICKEL = ([1.74, 1.70, 1.72, 1.72, 1.70, 1.71, 1.73, 1.78, 1.82, 1.85, 1.92, 1.96, 1.99, 1.99,
           2.06, 2.13, 2.26, 2.40],
          [2.32, 2.40, 2.48, 2.57, 2.69, 2.82, 2.95, 3.09, 3.25, 3.42, 3.61, 3.80, 4.02, 4.26,
           4.50, 4.73, 4.97, 5.23])
TITANIUM = ([1.82, 1.90, 1.99, 2.08, 2.14, 2.21, 2.27, 2.32, 2.36, 2.44, 2.54, 2.60, 2.67, 2.76,
             2.86, 3.00, 3.21, 3.29],
            [2.87, 2.90, 2.93, 2.95, 2.98, 3.01, 3.04, 3.10, 3.19, 3.30, 3.43, 3.58, 3.72, 3.84,
             3.96, 4.01, 4.01, 3.96])
# Rakic et al., Appl. Opt. 37, 5271 (1998), Lorentz-Drude fit, read off about every 25 nm.
RAKIC = np.array([.35972, .38299, .40456, .43072, .45499, .48063, .50573, .53006, .55556, .58002,
                  .60555, .63220, .65745, .68103, .70546, .73077, .75699, .78108, .80593, .83158])
PLATINUM = ([1.6142, 1.6780, 1.7363, 1.8037, 1.8631, 1.9238, 1.9829, 2.0413, 2.1049, 2.1690, 2.2393,
             2.3165, 2.3927, 2.4661, 2.5439, 2.6257, 2.7110, 2.7893, 2.8696, 2.9513],
            [2.6009, 2.7494, 2.8794, 3.0306, 3.1678, 3.3120, 3.4534, 3.5909, 3.7351, 3.8725, 4.0141,
             4.1590, 4.2927, 4.4139, 4.5353, 4.6567, 4.7775, 4.8844, 4.9907, 5.0967])

HEAD = '''/* metals.c: complex indices of refraction of metals, written by scripts/metals.py.
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
'''
TAIL = '''};

int metal_index(const char *name, float eta[3], float k[3]) {
  for (size_t i = 0; i < sizeof metals / sizeof *metals; i++) {
    if (strcmp(metals[i].name, name) != 0) continue;
    memcpy(eta, metals[i].eta, sizeof metals[i].eta);
    memcpy(k, metals[i].k, sizeof metals[i].k);
    return 1;
  }
  return 0;
}
'''


def observer():
    import colour
    cmf = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    return cmf.wavelengths, cmf.values


def to_rgb(wavelengths, values):
    nm = np.arange(360.0, 831.0)
    at, cmf = observer()
    cmf = np.stack([np.interp(nm, at, cmf[:, i]) for i in range(3)], 1)
    s = np.interp(nm, wavelengths, values)
    return MATRIX @ ((cmf * s[:, None]).sum(0) / cmf[:, 1].sum())


def main():
    folder = sys.argv[1]
    spectra = {}
    for name in FROM_FOLDER:
        spectra[name] = [tuple(np.loadtxt("%s/%s.%s.spd" % (folder, name, part)).T)
                         for part in ("eta", "k")]
    for name, (eta, k) in {"Fe": IRON, "Ni": NICKEL, "Ti": TITANIUM}.items():
        spectra[name] = [(JOHNSON * 1000, eta), (JOHNSON * 1000, k)]
    spectra["Pt"] = [(RAKIC * 1000, part) for part in PLATINUM]
    print(HEAD, end="")
    for name in sorted(spectra):
        rgb = ["{%.4ff, %.4ff, %.4ff}" % tuple(to_rgb(*s)) for s in spectra[name]]
        print('    {"%s", %s, %s},' % (name, rgb[0], rgb[1]))
    print(TAIL, end="")


if __name__ == "__main__":
    main()
