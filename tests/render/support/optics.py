"""Closed forms and quadrature in double precision, written from the literature and apart from
the kernels."""
import numpy as np


def fresnel_dielectric(cosine, eta):
    """Unpolarised reflectance; eta: index beyond the boundary over that before it."""
    cosine = np.asarray(cosine, float)
    sine_t2 = (1 - cosine ** 2) / eta ** 2
    cosine_t = np.sqrt(np.maximum(0, 1 - sine_t2))
    s = (cosine - eta * cosine_t) / (cosine + eta * cosine_t)
    p = (eta * cosine - cosine_t) / (eta * cosine + cosine_t)
    return np.where(sine_t2 >= 1, 1.0, 0.5 * (s * s + p * p))


def fresnel_conductor(cosine, eta, k):
    """Unpolarised reflectance of a metal of index eta + i k, with complex numbers."""
    cosine = np.asarray(cosine, complex)
    n = complex(eta, k)
    t = np.sqrt(n * n - (1 - cosine ** 2))
    s = (cosine - t) / (cosine + t)
    p = (n * n * cosine - t) / (n * n * cosine + t)
    return 0.5 * (np.abs(s) ** 2 + np.abs(p) ** 2)


def polygon_irradiance(points, normals, corners):
    """Irradiance at points from polygons of radiance 1 seen from their front (Lambert's
    formula); points and normals: N x 3, corners: polygons x corners x 3, counter-clockwise seen
    from the front, all above the points' horizons. A polygon that shows its back gives nothing."""
    total = np.zeros(len(points))
    for polygon in np.asarray(corners, float):
        front = np.cross(polygon[1] - polygon[0], polygon[2] - polygon[0])
        to = polygon[None] - points[:, None]
        unit = to / np.linalg.norm(to, axis=2, keepdims=True)
        following = np.roll(unit, -1, 1)
        edge = np.cross(unit, following)
        length = np.maximum(np.linalg.norm(edge, axis=2), 1e-300)
        angle = np.arctan2(length, np.sum(unit * following, 2))
        gamma = np.sum(edge * normals[:, None], 2) / length
        faces = np.sum(to[:, 0] * front, 1) < 0
        total += np.where(faces, -0.5 * np.sum(angle * gamma, 1), 0.0)
    return total


def hemisphere(count=256):
    """Directions about +Z on a grid of count x 2 count cells of equal projected solid angle, and
    the weight of each: the sum of f weight is the integral of f cos over the hemisphere."""
    u = (np.arange(count) + 0.5) / count
    phi = 2 * np.pi * (np.arange(2 * count) + 0.5) / (2 * count)
    r, z = np.sqrt(u)[:, None], np.sqrt(1 - u)[:, None] + 0 * phi
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), np.pi / (2 * count * count)


def ggx_density(cosine, alpha):
    """D(h) (Walter et al. 2007, eq. 33)."""
    c2 = cosine * cosine
    return alpha ** 2 / (np.pi * (c2 * (alpha ** 2 - 1) + 1) ** 2)


def ggx_lambda(cosine, alpha):
    """Smith's Lambda (Heitz 2014, eq. 72)."""
    tangent2 = np.maximum(0, 1 - cosine ** 2) / cosine ** 2
    return 0.5 * (np.sqrt(1 + alpha ** 2 * tangent2) - 1)


def beckmann_density(cosine, alpha):
    """D(h) (Walter et al. 2007, eq. 25)."""
    c2 = np.maximum(cosine * cosine, 1e-12)
    return np.exp(-(1 - c2) / c2 / alpha ** 2) / (np.pi * alpha ** 2 * c2 * c2)


def beckmann_lambda(cosine, alpha):
    """Smith's Lambda, exact (Walter et al. 2007, eq. 26 for G1 = 1 / (1 + Lambda))."""
    from math import erf
    a = cosine / (alpha * np.sqrt(np.maximum(1 - cosine ** 2, 1e-12)))
    error = np.vectorize(erf)(a)
    return 0.5 * (error - 1) + np.exp(-a * a) / (2 * a * np.sqrt(np.pi))


def reflected(brdf, wo, count=256):
    """What a surface with normal +Z sends towards wo under a sky of radiance 1: the integral of
    brdf(wo, wi, h) cos over wi. For lobes that the grid resolves: alpha of 0.1 and more."""
    wi, weight = hemisphere(count)
    h = wi + wo
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    return float(np.sum(brdf(np.asarray(wo, float), wi, h)) * weight)


def microfacet_brdf(density, smith, fresnel, alpha, correlated):
    """D G F / (4 cos cos) of a microfacet surface; fresnel: a function of the cosine to h."""
    def brdf(wo, wi, h):
        lo, li = smith(wo[2], alpha), smith(wi[..., 2], alpha)
        g = 1 / (1 + lo + li) if correlated else 1 / ((1 + lo) * (1 + li))
        cos_h = np.sum(wi * h, -1)
        return density(h[..., 2], alpha) * g * fresnel(cos_h) / (4 * wo[2] * wi[..., 2])
    return brdf


def specular_albedo(wo, alpha, f0, f90=1.0):
    """One channel of what glTF's specular lobe returns: GGX, separable masking, Schlick."""
    def fresnel(cosine):
        return f0 + (f90 - f0) * (1 - cosine) ** 5
    return reflected(microfacet_brdf(ggx_density, ggx_lambda, fresnel, alpha, False), wo)


def gltf_below(wo, wi, alpha, f0, f90=1.0):
    """What the diffuse part below that lobe is multiplied by, ideally: what the lobe leaves of both
    directions, over the mean."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    cosines, weights = (nodes + 1) / 2, weights / 2
    at = [specular_albedo(np.array([np.sqrt(1 - c * c), 0, c]), alpha, f0, f90) for c in cosines]
    mean = np.sum(2 * cosines * weights * (1 - np.array(at)))
    return np.prod([1 - specular_albedo(w, alpha, f0, f90) for w in (wo, wi)]) / mean


def gltf_albedo(base, metallic, roughness, ior, wo):
    """One channel of metallic-roughness under a sky of 1: the base gets what specular leaves."""
    dielectric = specular_albedo(wo, roughness ** 2, ((ior - 1) / (ior + 1)) ** 2)
    metal = specular_albedo(wo, roughness ** 2, base)
    return (1 - metallic) * (dielectric + base * (1 - dielectric)) + metallic * metal
