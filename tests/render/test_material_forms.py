#!/usr/bin/env python3
"""Materials against closed forms in double precision, written from the papers and the extensions'
texts.

Under a directional light, seen along parallel rays, a flat surface has one pair of directions and
no noise: f cos is asked for to 1e-4 of itself. Skies of two halves separate what is reflected from
what passes."""
import numpy as np

from support.cells import Cells, direction, front_and_back, layers, tilted
from support.color import TO_RGB, matching_functions
from support.optics import fresnel_dielectric, ggx_density, gltf_below, hemisphere
from support.shapes import quad
from support.verdict import main, near

SUN = 50          # degrees to the right of the camera
BEHIND = 130
SQUARE = quad((0, 0, 0), (0.9, 0, 0), (0, 0.9, 0))
BLACK = dict(base=(0, 0, 0), metallic=0.0)
NO_SPECULAR = {"specularFactor": 0}


class Lit(Cells):
    """Squares under a light of irradiance pi; `want` is f pi cos."""

    def __init__(self, columns, rows, degrees=SUN):
        super().__init__(columns, rows, 4)
        self.sun(degrees, np.pi)
        self.environment(radiance=0)
        self.degrees, self.cases = degrees, []

    def expect(self, name, material, tilt, f):
        """f(wo, wi): in the frame of the square, whose normal is +Z and whose tangent is +X."""
        self.hold(name, material, tilt, self.lit(tilt, f))

    def lit(self, tilt, f):
        back = tilted(-tilt)[:3, :3]
        wo, wi = back @ direction(0), back @ direction(self.degrees)
        return np.pi * np.asarray(f(wo, wi), float) * abs(wi[2])

    def hold(self, name, material, tilt, want):
        wide = quad((0, 0, 0), (0.9 / np.cos(np.radians(tilt)), 0, 0), (0, 0.9, 0))
        cell = self.show(wide, self.material(**material), tilted(tilt))
        self.cases.append(("%s, tilted by %d" % (name, tilt), cell, want))

    def judge(self, tolerance=1e-4):
        picture = self.render(16)
        for name, cell, want in self.cases:
            got = picture.rgb[self.region(cell, 0.25, 0.75, 0.25, 0.75)]
            near(name, (got - want) / (np.abs(want) + 1e-4), 0, tolerance)


def half(wo, wi):
    h = wo + wi
    return h / np.linalg.norm(h)


def schlick(f0, cosine, f90=1.0):
    return f0 + (f90 - f0) * (1 - cosine) ** 5


def ggx_separable(wo, wi, alpha_x, alpha_y=None):
    """D G / (4 cos cos), masking of both directions multiplied (Burley 2012, Heitz 2014)."""
    alpha_y = alpha_x if alpha_y is None else alpha_y
    h = half(wo, wi)
    q = (h[0] / alpha_x) ** 2 + (h[1] / alpha_y) ** 2 + h[2] ** 2
    d = 1 / (np.pi * alpha_x * alpha_y * q * q)

    def masking(w):
        t2 = ((alpha_x * w[0]) ** 2 + (alpha_y * w[1]) ** 2) / w[2] ** 2
        return 2 / (1 + np.sqrt(1 + t2))
    return d * masking(wo) * masking(wi) / (4 * wo[2] * wi[2])


# --- Sheen (Estevez and Kulla 2017).

def charlie(wo, wi, roughness):
    """D / (4 cos cos (1 + Lambda + Lambda)), white; directions may be arrays."""
    alpha = roughness ** 2
    h = wo + wi
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    sine = np.sqrt(np.maximum(1 - h[..., 2] ** 2, 0))
    d = (2 + 1 / alpha) * sine ** (1 / alpha) / (2 * np.pi)
    t = (1 - alpha) ** 2
    a, b, c, e, g = [(1 - t) * q + t * p for p, q in (
        (25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760),
        (-4.85967, -4.32054))]

    def exponent(x):
        return a / (1 + b * x ** c) + e * x + g

    def smith(x):
        return np.where(x < 0.5, np.exp(exponent(x)),
                        np.exp(2 * exponent(0.5) - exponent(1 - x)))
    cos_o, cos_i = wo[..., 2], wi[..., 2]
    return d / (1 + smith(cos_o) + smith(cos_i)) / (4 * cos_o * cos_i)


def charlie_albedo(cosine, roughness):
    wi, weight = hemisphere(512)
    wo = np.array([np.sqrt(1 - cosine ** 2), 0, cosine])
    return float(np.sum(charlie(wo, wi, roughness)) * weight)


def test_sheen():
    """The lobe over black, and by albedo scaling over white, which is seen to 0.5 %: what is below
    keeps 1 less the greater of both directions' albedos, fitted to 0.003."""
    color = np.array((0.9, 0.5, 0.2))
    lobe, over = Lit(4, 2), Lit(3, 1)
    for roughness in (0.3, 0.7):
        for tilt in (0, 20, -20, 60):
            sheen = {"sheenColorFactor": list(color), "sheenRoughnessFactor": roughness}
            lobe.expect("sheen of roughness %g" % roughness,
                        dict(BLACK, **layers(sheen=sheen, specular=NO_SPECULAR)), tilt,
                        lambda wo, wi, r=roughness: color * charlie(wo, wi, r))
    lobe.judge()
    for roughness in (0.3, 0.5, 1.0):
        def both(wo, wi, r=roughness):
            taken = max(charlie_albedo(w[2], r) for w in (wo, wi))
            return color * charlie(wo, wi, r) + (1 - color.max() * taken) * 0.8 / np.pi
        sheen = {"sheenColorFactor": list(color), "sheenRoughnessFactor": roughness}
        over.expect("sheen of roughness %g over white" % roughness, dict(
            base=(0.8, 0.8, 0.8), metallic=0.0, **layers(sheen=sheen, specular=NO_SPECULAR)), 0,
            both)
    over.judge(0.005)


def test_clearcoat():
    """Where both directions are equally steep the coat is the extension's own."""
    lit, alpha = Lit(3, 1), 0.4 ** 2
    for strength in (1.0, 0.6):
        coat = {"clearcoatFactor": strength, "clearcoatRoughnessFactor": 0.4}

        def over(below, strength=strength):
            def f(wo, wi):
                fresnel = strength * schlick(0.04, wo[2])
                return fresnel * ggx_separable(wo, wi, alpha) + (1 - fresnel) * below / np.pi
            return f
        lit.expect("a coat of %g over black" % strength,
                   dict(BLACK, **layers(clearcoat=coat, specular=NO_SPECULAR)), 25, over(0))
    lit.expect("a coat of 0.6 over white", dict(
        base=(0.8, 0.8, 0.8), metallic=0.0, **layers(clearcoat=coat, specular=NO_SPECULAR)), 25,
        over(0.8))
    lit.judge()


def bent(scene, degrees):
    """A normal map that turns the normal from the camera to the right."""
    n = np.array([np.sin(np.radians(degrees)), 0, np.cos(np.radians(degrees))])
    return scene.texture(np.rint((n + 1) / 2 * 65535).astype(np.uint16)[None, None])


def test_normals_of_layers():
    """clearcoatNormalTexture bends the coat alone and normalTexture the base alone: a bent lobe is
    that of a square which is tilted as much. The base's is so within 1 % only: what would leave
    into the surface is reflected there."""
    lit, turned = Lit(4, 2), 15
    coat = {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4}
    fresnel = schlick(0.04, np.cos(np.radians(25)))
    glossy = lit.lit(25, lambda wo, wi: fresnel * ggx_separable(wo, wi, 0.16))
    for sign in (1, -1):
        tilt, bend = 25 - sign * turned, sign * turned
        bent_coat = dict(coat, clearcoatNormalTexture=bent(lit, bend))
        lit.hold("a coat bent by %d" % bend, dict(BLACK, **layers(
            clearcoat=bent_coat, specular=NO_SPECULAR)), tilt, glossy)
        below = lit.lit(tilt, lambda wo, wi: (1 - fresnel) * 0.8 / np.pi)
        lit.hold("a coat bent by %d over white" % bend, dict(
            base=(0.8, 0.8, 0.8), metallic=0.0, **layers(
                clearcoat=bent_coat, specular=NO_SPECULAR)), tilt, glossy + below)
        lit.hold("a coat over what is bent by %d" % bend, dict(BLACK, normalTexture=bent(
            lit, bend), **layers(clearcoat=coat, specular=NO_SPECULAR)), 25, glossy)
    lit.judge(5e-4)
    bases = Lit(2, 1)
    for bend in (turned, -turned):
        bases.hold("metal bent by %d" % bend, dict(
            base=(0.9, 0.9, 0.9), metallic=1.0, roughness=0.4, normalTexture=bent(bases, bend),
            **layers(clearcoat={"clearcoatFactor": 0.0})), 25 - bend, bases.lit(25, lambda wo, wi:
                schlick(0.9, wo[2]) * ggx_separable(wo, wi, 0.16)))
    bases.judge(0.01)


def test_anisotropy():
    """alpha along the turned tangent is mix(alpha, 1, strength^2), of metal with Schlick's
    Fresnel."""
    lit, base = Lit(4, 1), np.array((0.9, 0.6, 0.4))
    for rotation, tilt in ((0, 25), (90, 40), (90, 10), (35, 40)):
        angle = np.radians(rotation)
        brushed = {"anisotropyStrength": 0.6, "anisotropyRotation": float(angle)}
        along = 0.16 + (1 - 0.16) * 0.36

        def f(wo, wi, angle=angle):
            c, s = np.cos(angle), np.sin(angle)
            turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
            fresnel = schlick(base, float(half(wo, wi) @ wo))
            return fresnel * ggx_separable(turn @ wo, turn @ wi, along, 0.16)
        lit.expect("brushed along %d degrees" % rotation, dict(
            base=base, metallic=1.0, roughness=0.4, **layers(anisotropy=brushed)), tilt, f)
    lit.judge()


def test_specular():
    """F0 = min(((ior - 1)/(ior + 1))^2 color, 1) factor and F90 = factor; the base gets what is
    left of the channel that reflects most, but for the error of a fit."""
    color = np.array((1.0, 0.4, 0.1))
    for base, tolerance in ((0, 1e-4), (0.6, 0.01)):
        lit = Lit(3, 1)
        for factor, ior, tilt in ((0.7, 1.5, 25), (1.0, 1.8, 60), (0.3, 1.33, 0)):
            def f(wo, wi, factor=factor, ior=ior):
                f0 = np.minimum(((ior - 1) / (ior + 1)) ** 2 * color, 1) * factor
                fresnel = schlick(f0, float(half(wo, wi) @ wo), factor)
                left = gltf_below(wo, wi, 0.25, f0.max(), factor) if base else 0
                return fresnel * ggx_separable(wo, wi, 0.25) + left * base / np.pi
            lit.expect("specular %g, ior %g, base %g" % (factor, ior, base), dict(
                base=(base,) * 3, metallic=0.0, roughness=0.5,
                **layers(ior={"ior": ior}, specular={"specularFactor": factor,
                                                     "specularColorFactor": list(color)})), tilt, f)
        lit.judge(tolerance)


def test_retroreflection():
    """The lobe is that of the mirrored view: brightest where the light is."""
    lit = Lit(4, 2, degrees=6)
    for tilt in (0, 30, 50, -45):
        def cdl(wo, wi):
            passed = [1 - fresnel_dielectric(w[2], 1.5) for w in (wo, wi)]
            mirrored = wo * (-1, -1, 1)
            lo, li = [0.5 * (np.sqrt(1 + 0.04 * (1 / w[2] ** 2 - 1)) - 1) for w in (wo, wi)]
            d = ggx_density(half(mirrored, wi)[2], 0.2)
            return 0.8 * passed[0] * passed[1] * d / (1 + lo + li) / (4 * wo[2] * wi[2])

        def khr(wo, wi):
            mirrored = wo * (-1, -1, 1)
            total = 0
            for view, share in ((mirrored, 0.75), (wo, 0.25)):
                fresnel = schlick(np.array((0.9, 0.6, 0.4)), float(half(view, wi) @ view))
                total = total + share * fresnel * ggx_separable(view, wi, 0.25)
            return total
        lit.expect("the retroreflector", {"cdl": {
            "model": "retroreflector", "alpha": 0.2, "reflectance": [0.8, 0.8, 0.8]}}, tilt, cdl)
        lit.expect("glTF's retroreflection", dict(
            base=(0.9, 0.6, 0.4), metallic=1.0, roughness=0.5,
            **layers(retroreflection={"retroreflectionFactor": 0.75})), tilt, khr)
    lit.judge()


def test_diffuse_transmission():
    """From behind: factor color / pi; from the front what is left of the base."""
    tint = np.array((0.2, 0.7, 0.9))
    leaf = {"diffuseTransmissionFactor": 0.6, "diffuseTransmissionColorFactor": list(tint)}
    material = dict(base=(0.8, 0.5, 0.3), metallic=0.0, **layers(
        diffuse_transmission=leaf, specular=NO_SPECULAR))
    for degrees, value in ((BEHIND, 0.6 * tint), (SUN, 0.4 * np.array((0.8, 0.5, 0.3)))):
        lit = Lit(2, 1, degrees)
        for tilt in (0, 20):
            lit.expect("a leaf lit at %d" % degrees, material, tilt, lambda wo, wi: value / np.pi)
        lit.judge()


# --- Under skies.

def film_reflectance(wavelengths, film, thickness, beyond):
    """Airy's sum at normal incidence, amplitudes of one polarisation (both are the same)."""
    first, second = (1 - film) / (1 + film), (film - beyond) / (film + beyond)
    wave = np.exp(4j * np.pi * film * thickness / wavelengths)
    return np.abs((first + second * wave) / (1 + first * second * wave)) ** 2


def film_color(f0, film, thickness):
    """Belcour and Barla's color: the mean over all phases as it is, what interferes by the eye's
    response to light of equal energy."""
    w = np.arange(360, 831, 0.5)
    response = matching_functions(w)
    beyond = (1 + np.sqrt(f0)) / (1 - np.sqrt(f0))
    r1, r2 = ((1 - film) / (1 + film)) ** 2, ((film - beyond) / (film + beyond)) ** 2
    mean = r1 + (1 - r1) ** 2 * r2 / (1 - r1 * r2)
    waves = response @ (film_reflectance(w, film, thickness, beyond) - mean) / response[1].sum()
    return np.clip(mean + TO_RGB @ waves, 0, 1)


def test_iridescence():
    """A film on smooth metal seen straight under a sky of 1. Belcour and Barla's Gaussians and two
    orders are within 0.03 of the whole sum."""
    cells, kinds = Cells(5, 2, 6), []
    cells.environment(radiance=1)
    for base in (0.25, 0.8):
        for film, thickness in ((1.3, 120), (1.3, 250), (1.5, 340), (1.8, 400), (1.8, 600)):
            kinds.append((base, film, thickness))
            members = {"iridescenceFactor": 1, "iridescenceIor": film,
                       "iridescenceThicknessMaximum": thickness}
            cells.show(SQUARE, cells.material(base=(base,) * 3, metallic=1.0, roughness=0.0,
                                              **layers(iridescence=members)))
    picture = cells.render(32)
    for i, (base, film, thickness) in enumerate(kinds):
        got = picture.rgb[cells.region(i, 0.2, 0.8, 0.2, 0.8)].mean(0)
        near("a film of index %g, %d nm on %g" % (film, thickness, base), got,
             film_color(base, film, thickness), 0.03)


if __name__ == "__main__":
    main(test_sheen, test_clearcoat, test_normals_of_layers, test_anisotropy, test_specular,
         test_retroreflection, test_diffuse_transmission, test_iridescence)
