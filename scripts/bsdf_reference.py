#!/usr/bin/env python3
"""What the papers say that a material returns, in double precision and apart from the kernels.

    candela bsdf SCENE --material NAME --pairs PAIRS.csv > VALUES.csv
    scripts/bsdf_reference.py MATERIAL.json PAIRS.csv VALUES.csv

MATERIAL.json is the material's CDL_material object, without textures; PAIRS.csv holds wo and wi,
VALUES.csv f and the density, as the command reads and prints them. Exit status 1 if any f is off by
more than 1e-3 of itself; the worst pair is named. Models: oren_nayar, plastic, disney.

As a module: evaluate(material, wo, wi) -> f, with wo and wi of shape (n, 3), f of shape (n, 3), and
members of `material` numbers, colours or arrays of n of them.
"""

import argparse
import json
import math
import sys

import numpy as np


def dot(a, b):
    return (a * b).sum(-1)


def column(x):
    return np.asarray(x, float)[..., None]


def scalar(material, name, default):
    return np.asarray(material.get(name, default), float)


def color(material, name, default):
    return np.asarray(material.get(name, [default] * 3), float)


def alpha_pair(material, default):
    alpha = np.asarray(material.get("alpha", default), float)
    return (alpha, alpha) if alpha.ndim == 0 else (alpha[..., 0], alpha[..., 1])


def fresnel(cosine, eta):
    """Unpolarised reflectance, by Snell's law and the two amplitudes."""
    sine = np.sqrt(np.maximum(1 - cosine**2, 0)) / eta
    inside = np.sqrt(np.maximum(1 - sine**2, 0))
    s = (cosine - eta * inside) / (cosine + eta * inside)
    p = (eta * cosine - inside) / (eta * cosine + inside)
    return np.where(sine >= 1, 1.0, (s**2 + p**2) / 2)


# ---- Portsmouth, Kutz and Hill 2025 ----


def oren_nayar(material, wo, wi):
    rho = color(material, "reflectance", 0.5)
    r = scalar(material, "roughness", 0.5)
    mu_o, mu_i = wo[:, 2], wi[:, 2]
    scale = 1 / (1 + (0.5 - 2 / (3 * np.pi)) * r)
    s = dot(wo, wi) - mu_o * mu_i
    ratio = np.where(s > 0, s / np.maximum(mu_o, mu_i), s)
    single = scale * (1 + r * ratio) / np.pi

    def albedo(mu):
        sine = np.sqrt(1 - mu**2)
        g = sine * (np.arccos(mu) - sine * mu) + 2 / 3 * (sine / mu * (1 - sine**3) - sine)
        return scale * (1 + r * g / np.pi)

    average = scale * (1 + (2 / 3 - 28 / (15 * np.pi)) * r)
    lost = np.where(
        r > 0,
        (1 - albedo(mu_o)) * (1 - albedo(mu_i)) / np.where(r > 0, 1 - average, 1),
        0,
    )
    average = column(average)
    multiple = rho**2 * average / (1 - rho * (1 - average)) / np.pi
    return np.where(column(mu_i > 0), rho * column(single) + multiple * column(lost), 0)


# ---- microfacets (Walter et al. 2007; Heitz 2014) ----


def ggx_density(h, ax, ay):
    cos2 = h[:, 2] ** 2
    tan2 = (h[:, 0] / ax) ** 2 / cos2 + (h[:, 1] / ay) ** 2 / cos2
    return 1 / (np.pi * ax * ay * cos2**2 * (1 + tan2) ** 2)


def beckmann_density(h, ax, ay):
    cos2 = h[:, 2] ** 2
    tan2 = (h[:, 0] / ax) ** 2 / cos2 + (h[:, 1] / ay) ** 2 / cos2
    return np.exp(-tan2) / (np.pi * ax * ay * cos2**2)


def slope_along(w, ax, ay):
    """alpha tan(theta) in the direction of w."""
    return np.sqrt((ax * w[:, 0]) ** 2 + (ay * w[:, 1]) ** 2) / np.abs(w[:, 2])


def ggx_lambda(w, ax, ay):
    return (np.sqrt(1 + slope_along(w, ax, ay) ** 2) - 1) / 2


erfc = np.vectorize(math.erfc)


def beckmann_lambda(w, ax, ay):
    a = 1 / np.maximum(slope_along(w, ax, ay), 1e-12)
    return (np.exp(-(a**2)) / (a * np.sqrt(np.pi)) - erfc(a)) / 2


# ---- plastic ----

# Fits of kernels/bsdf/plastic.h, which no paper has: powers of alpha, for GGX and Beckmann.
PLASTIC_FIT = {
    "cosine": (
        [
            0.69094, 0.70786, -1.14668, -3.71297, -2.15286, -0.09828, 0.55224, -2.379,
            6.34862, -20.2424, 23.4244, -0.46944, 11.921, -12.3677,
        ],
        [
            0.27866, 0.23418, -0.44979, -3.71368, -0.05577, -0.04584, -0.59137,
            -1.36259, 4.21358, -4.28429, 5.56986, -0.31916, 2.24552, -3.21751,
        ],
    ),
    "average": (
        [
            0.4012, -2.2138, 1.8279, 0.6056, 6.4046, -7.0347, -1.9781, -7.4566, 10.4591,
            2.0074, 3.6709, -5.7047,
        ],
        [
            0.6757, -2.5054, 1.3019, -0.9017, 8.3478, -4.5912, 0.7664, -9.5924, 4.6205,
            0.3703, 3.5106, -0.7218,
        ],
    ),
}


def plastic(material, wo, wi):
    rho = color(material, "reflectance", 0.5)
    eta = scalar(material, "ior", 1.5)
    ax, ay = alpha_pair(material, 0.1)
    beckmann = np.asarray(material.get("distribution", "ggx")) == "beckmann"
    h = (wo + wi) / np.linalg.norm(wo + wi, axis=1)[:, None]
    density = np.where(beckmann, beckmann_density(h, ax, ay), ggx_density(h, ax, ay))
    lam = [np.where(beckmann, beckmann_lambda(w, ax, ay), ggx_lambda(w, ax, ay)) for w in (wo, wi)]
    product = (1 + lam[0]) * (1 + lam[1])
    masking = 1 / (1 + lam[0] + lam[1])
    if material.get("masking", "correlated") == "separable":
        masking = 1 / product
    coat = density * masking * fresnel(dot(wo, h), eta) / (4 * wo[:, 2] * np.abs(wi[:, 2]))

    def fitted(key, i):
        return np.where(beckmann, PLASTIC_FIT[key][1][i], PLASTIC_FIT[key][0][i])

    def passes(w):
        mu = w[:, 2]
        least = np.minimum(ax, ay) ** 2
        along = ((ax * w[:, 0]) ** 2 + (ay * w[:, 1]) ** 2) / np.maximum(1 - mu**2, 1e-12)
        a = np.sqrt((np.maximum(along, least) + least) / 2)
        y, z = a / (a + mu), a / (a + 4 * mu)
        terms = [a * y, a * z, a * y * y, a * a * y, a * a * z, a, a * mu, a * mu**2, a**2]
        terms += [a**2 * mu, a**2 * mu**2, a**3, a**3 * mu, a**3 * mu**2]
        g = sum(fitted("cosine", i) * t for i, t in enumerate(terms))
        cos2 = mu**2 + g * (eta - 1) / (eta - 1 + 0.04)
        return 1 - fresnel(np.sqrt(np.clip(cos2, 0, 1)), eta)

    a = np.sqrt((ax**2 + ay**2) / 2)
    s = (eta - 1) / (eta + 1)
    average = sum(
        fitted("average", 3 * i + j) * s ** (1 + i / 2) * a**j for i in range(4) for j in range(3)
    )
    inside = column(1 - (1 - np.clip(average, 0, 1)) / eta**2)
    base = rho / (np.pi * column(eta) ** 2 * (1 - rho * inside))
    f = column(coat) + base * column(passes(wo) * passes(wi))
    return np.where(wi[:, 2:] > 0, f, 0)


# ---- Burley 2012 and 2015 ----


def mix(a, b, t):
    return a + (b - a) * t


def schlick(x):
    return np.clip(1 - x, 0, 1) ** 5


def smith_g(w, ax, ay):
    """Masking of one direction over twice its cosine, as in the 2012 model."""
    c = np.abs(w[:, 2])
    return 1 / (c + np.sqrt((w[:, 0] * ax) ** 2 + (w[:, 1] * ay) ** 2 + c**2))


def disney_tints(base, specular_tint, sheen_tint):
    luminance = base @ np.array([0.3, 0.6, 0.1])
    tint = np.where(column(luminance > 0), base / column(np.maximum(luminance, 1e-30)), 1)
    return mix(1, tint, column(specular_tint)), mix(1, tint, column(sheen_tint))


def disney_alphas(roughness, anisotropic):
    aspect = np.sqrt(1 - 0.9 * anisotropic)
    return np.maximum(0.001, roughness**2 / aspect), np.maximum(0.001, roughness**2 * aspect)


def disney(material, wo, wi):
    base = color(material, "baseColor", 0.5)

    def get(name, default=0.0):
        return scalar(material, name, default)

    metallic, roughness, through = get("metallic"), get("roughness", 0.5), get("specTrans")
    thin = np.asarray(material.get("thin", False)) != 0
    ior = get("ior", 1.5)
    dielectric, glass = (1 - metallic) * (1 - through), (1 - metallic) * through
    diff_trans = np.where(thin, get("diffTrans") / 2, 0)
    flat = np.where(thin, get("flatness"), get("subsurface"))
    specular_tint, sheen_tint = disney_tints(base, get("specularTint"), get("sheenTint", 0.5))
    eta = np.where(thin | (np.asarray(material.get("front", True)) != 0), ior, 1 / ior)
    cos_o, cos_i = wo[:, 2], np.abs(wi[:, 2])

    # Reflection.
    h = (wo + wi) / np.linalg.norm(wo + wi, axis=1)[:, None]
    cos_d = dot(wi, h)
    f_l, f_v, f_h = schlick(cos_i), schlick(cos_o), schlick(cos_d)
    r_r = 2 * roughness * cos_d**2
    lambert = (1 - 0.5 * f_l) * (1 - 0.5 * f_v)
    retro = r_r * (f_l + f_v + f_l * f_v * (r_r - 1))
    f_ss = mix(1, r_r / 2, f_l) * mix(1, r_r / 2, f_v)
    subsurface = 1.25 * (f_ss * (1 / (cos_i + cos_o) - 0.5) + 0.5)
    diffuse = mix(lambert + retro, subsurface, flat) * (1 - diff_trans) / np.pi
    f = column(dielectric * diffuse) * base
    f = f + column(dielectric * get("sheen") * f_h) * sheen_tint
    ax, ay = disney_alphas(roughness, get("anisotropic"))
    schlick_h = column(f_h)
    reflectance = column(metallic) * mix(base, 1, schlick_h)
    dark = column(0.08 * get("specular", 0.5)) * specular_tint
    reflectance = reflectance + column(dielectric) * mix(dark, 1, schlick_h)
    reflectance = reflectance + column(glass * fresnel(cos_d, eta))
    facets = ggx_density(h, ax, ay) * smith_g(wo, ax, ay) * smith_g(wi, ax, ay)
    f = f + reflectance * column(facets)
    a2 = mix(0.1, 0.001, get("clearcoatGloss", 1.0)) ** 2
    gtr1 = (a2 - 1) / (np.pi * np.log(a2) * (1 + (a2 - 1) * h[:, 2] ** 2))
    coat = gtr1 * mix(0.04, 1, f_h) * smith_g_coat(cos_o) * smith_g_coat(cos_i)
    f = f + column(0.25 * get("clearcoat") * coat)

    # Transmission.
    scale = np.where(thin, np.clip(0.65 * ior - 0.35, 0, 1), 1)
    ax, ay = disney_alphas(roughness * scale, get("anisotropic"))
    flipped = wi * np.array([1, 1, -1])
    bent = -(wo + column(eta) * wi)
    bent = bent * np.sign(bent[:, 2:])
    h = np.where(column(thin), wo + flipped, bent)
    h = h / np.linalg.norm(h, axis=1)[:, None]
    oh, ih = dot(wo, h), dot(wi, h)
    dgg = ggx_density(h, ax, ay) * smith_g(wo, ax, ay) * smith_g(wi, ax, ay)
    straight = base * column(dgg * (1 - fresnel(oh, eta)))
    walter = 4 * np.abs(oh * ih) * dgg * (1 - fresnel(oh, eta)) / (oh + eta * ih) ** 2
    faces = (oh > 0) & (ih < 0)
    refracted = np.sqrt(base) * column(np.where(faces, walter, 0))
    t = column(glass) * np.where(column(thin), straight, refracted)
    t = t + column(dielectric * diff_trans / np.pi) * base
    return np.where(wi[:, 2:] > 0, f, t)


def smith_g_coat(c):
    return 1 / (c + np.sqrt(0.0625 + c**2 - 0.0625 * c**2))


# ---- from files ----

MODELS = {"oren_nayar": oren_nayar, "plastic": plastic, "disney": disney}


def evaluate(material, wo, wi):
    """f(wo, wi). Where wo is below the surface, it is the inside, and all is seen from there."""
    below = wo[:, 2] < 0
    material = dict(material)
    material.setdefault("front", ~below)
    turn = np.where(below, -1.0, 1.0)[:, None] * np.array([0, 0, 1.0]) + np.array([1, 1, 0.0])
    return MODELS[material["model"]](material, wo * turn, wi * turn)


def compare(material, wo, wi, got):
    """What is expected, and by how much of itself each row of `got` is off. Beyond that counts only
    what is more than the rounding of the directions to single precision explains, for what little
    passes near the critical angle has few digits; values below 1e-6 count as 1e-6."""
    want = evaluate(material, wo, wi)
    moved = [evaluate(material, wo, wi * (1 + step)) for step in (-1e-7, 1e-7)]
    rounding = sum(np.abs(m - want) for m in moved)
    size = np.maximum(np.maximum(np.abs(got), np.abs(want)), 1e-6)
    return want, (np.maximum(np.abs(got - want) - 2 * rounding, 0) / size).max(axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("material")
    parser.add_argument("pairs")
    parser.add_argument("values")
    parser.add_argument("--tolerance", type=float, default=1e-3)
    args = parser.parse_args()
    with open(args.material, encoding="utf-8") as file:
        material = json.load(file)
    pairs = np.loadtxt(args.pairs, delimiter=",", ndmin=2)
    got = np.loadtxt(args.values, delimiter=",", ndmin=2)[:, :3]
    want, error = compare(material, pairs[:, :3], pairs[:, 3:6], got)
    worst = int(error.argmax())
    print(f"{material['model']}: {len(error)} pairs, worst {error[worst]:.2e}")
    if not error[worst] <= args.tolerance:
        print(f"pair {worst}: {pairs[worst]}: {got[worst]}, expected {want[worst]}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
