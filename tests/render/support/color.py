"""How the eye sees spectra."""
import numpy as np

# Linear Rec. 709 of XYZ (IEC 61966-2-1).
TO_RGB = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                   [0.0556434, -0.2040259, 1.0572252]])


def matching_functions(wavelengths):
    """CIE 1931 x, y, z at wavelengths in nm (Wyman, Sloan and Shirley 2013, the fit of several
    lobes)."""
    def lobe(height, middle, below, above):
        t = (wavelengths - middle) * np.where(wavelengths < middle, below, above)
        return height * np.exp(-0.5 * t * t)
    x = (lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) -
         lobe(0.065, 501.1, 0.0490, 0.0382))
    y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322)
    z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)
    return np.stack([x, y, z])
