#!/usr/bin/env python3
"""Fits kernels/bsdf/gltf_albedo.h: what glTF's specular lobe reflects in all, from above.

The lobe is GGX of alpha = roughness^2 with separable masking and Schlick's Fresnel. Its albedo is
f0 white + (f90 - f0) edge, white that of facets that reflect all and edge that of Schlick's weight
(1 - wo.h)^5. Fitted are 1 - white, and the cosine at which white (1 - cosine)^5 is edge, as sums
of monomials cosine^i y^j roughness^k with y = alpha / (alpha + cosine). Both end above the
quadrature's values; their means over the hemisphere, weighted by the cosine, are polynomials of
roughness below those of the fits.

Prints the coefficients, and how far the fits are off on other nodes than those of the fit, those of
anisotropic surfaces included. Takes a minute."""
import numpy as np

ALPHA_MIN = 1e-3
LOSS = [(0, 0, 2), (0, 0, 3), (0, 1, 0), (0, 2, 0), (0, 2, 3), (0, 3, 4), (0, 4, 0), (0, 5, 0),
        (0, 6, 0), (1, 1, 4), (1, 4, 4), (2, 3, 4)]
COSINE = [(0, 0, 2), (0, 0, 4), (0, 1, 3), (0, 2, 0), (0, 2, 1), (0, 3, 1), (0, 3, 2), (1, 0, 3),
          (1, 1, 1), (1, 1, 3), (1, 2, 0), (1, 3, 1)]
MEAN_LOSS = [0, 2, 3, 4, 5]
MEAN_EDGE = [0, 1, 2, 3, 4]
NARROW, KEEP, RAISE = 0.25, 0.35, 0.003


def schlick_weight(cosine):
    return np.clip(1 - cosine, 0, 1) ** 5


def quadrature(cosine, alpha_x, alpha_y, azimuth=0.0, nodes=256):
    """white and edge: a mean over the visible normals, from even nodes of the spherical cap
    that they are drawn from (Dupuy and Benyoub 2023)."""
    sine = np.sqrt(max(1 - cosine**2, 0))
    wo = np.array([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine])
    w = wo * (alpha_x, alpha_y, 1)
    w /= np.linalg.norm(w)
    turn = (np.arange(nodes) + 0.5) / nodes * (0.5 if alpha_x == alpha_y else 1)
    drop = (np.arange(2 * nodes) + 0.5) / (2 * nodes) * (1 + w[2])
    angle, drop = np.meshgrid(2 * np.pi * turn + np.arctan2(w[1], w[0]), drop)
    radius = np.sqrt(np.maximum(drop * (2 - drop), 0))
    h = np.stack([alpha_x * (radius * np.cos(angle) + w[0]),
                  alpha_y * (radius * np.sin(angle) + w[1]), 1 - drop + w[2]])
    h /= np.sqrt((h**2).sum(axis=0))
    cos_h = np.tensordot(wo, h, 1)
    wi = 2 * cos_h * h - wo[:, None, None]
    slope2 = ((alpha_x * wi[0]) ** 2 + (alpha_y * wi[1]) ** 2) / np.maximum(wi[2], 1e-12) ** 2
    passes = np.where(wi[2] > 0, 2 / (1 + np.sqrt(1 + slope2)), 0)
    return passes.mean(), (passes * schlick_weight(cos_h)).mean()


def table(cosines, roughnesses):
    """Flat arrays: cosine, alpha, white, edge."""
    rows = [(c, r * r) + quadrature(c, r * r, r * r) for r in roughnesses for c in cosines]
    return np.array(rows).T


def monomials(powers, cosine, alpha):
    y, roughness = alpha / (alpha + cosine), np.sqrt(alpha)
    return np.stack([cosine**i * y**j * roughness**k for i, j, k in powers], axis=-1)


def as_written(coefficients):
    return np.array([float("%.7g" % c) for c in coefficients])


def minimax(terms, target, rounds=300):
    """Lawson's iteration: the least greatest residual."""
    weights, best = np.ones(len(target)), None
    for _ in range(rounds):
        root = np.sqrt(weights)
        found = np.linalg.lstsq(terms * root[:, None], target * root, rcond=None)[0]
        error = np.abs(terms @ found - target)
        if best is None or error.max() < best[0]:
            best = error.max(), found
        weights = weights * (error / error.max() + 1e-3)
        weights /= weights.mean()
    return as_written(best[1]), best[0]


def minimax_power(terms, cosine, scale, target, rounds=400):
    """The same for scale (1 - cosine - sum)^5, by Gauss and Newton."""
    weights, best = np.ones(len(target)), None
    found = np.zeros(terms.shape[1])
    for _ in range(rounds):
        base = np.maximum(1 - cosine - terms @ found, 1e-3)
        error = scale * base**5 - target
        if best is None or np.abs(error).max() < best[0]:
            best = np.abs(error).max(), found
        weights = weights * (np.abs(error) / np.abs(error).max() + 1e-3)
        weights /= weights.mean()
        root = np.sqrt(weights)
        steps = terms * (5 * scale * base**4 * root)[:, None]
        found = found + np.linalg.lstsq(steps, error * root, rcond=None)[0]
    return as_written(best[1])


class Fit:
    """As the header evaluates it."""

    def __init__(self, loss, cosine, raise_edge):
        self.loss, self.cosine, self.raise_edge = loss, cosine, raise_edge

    def white(self, cosine, alpha, scale=1.0):
        loss = monomials(LOSS, cosine, alpha) @ self.loss
        return 1 - scale * np.clip(loss, 0, 1)

    def edge(self, cosine, alpha, white, rise=0.0):
        bent = cosine + monomials(COSINE, cosine, alpha) @ self.cosine
        return np.minimum(white * schlick_weight(bent) + self.raise_edge + rise, white)


def raised(terms, target, weight):
    """A fit of a target that is lowered by its own greatest residual over `weight`."""
    margin = 0.0
    for _ in range(30):
        found, worst = minimax(terms * weight[:, None], (target - margin / weight) * weight)
        if worst <= margin:
            break
        margin = 1.02 * worst
    return found


def fit_lobe(cosine, alpha, white, edge):
    """White is weighted by what it counts at f0 = 0.25, the index 3; edge takes a constant."""
    weight = 0.25 + 0.75 * edge / white
    fit = Fit(raised(monomials(LOSS, cosine, alpha), 1 - white, weight), None, 0)
    fitted = fit.white(cosine, alpha)
    fit.cosine = minimax_power(monomials(COSINE, cosine, alpha), cosine, fitted, edge)
    short = edge - fit.edge(cosine, alpha, fitted)
    fit.raise_edge = float("%.2g" % (1.03 * short.max()))
    return fit


def gauss_means(fit, roughness, nodes=200):
    """Means of white and edge; the cosine is the square of the variable of integration."""
    x, weights = np.polynomial.legendre.leggauss(nodes)
    x, weights = (x + 1) / 2, weights / 2
    alpha = np.maximum(roughness**2, ALPHA_MIN)[:, None]
    cosine = np.broadcast_to(x**2, (len(roughness), nodes))
    white = fit.white(cosine, alpha)
    spread = 4 * x**3 * weights
    edge = fit.edge(cosine, alpha, white)
    return (white * spread).sum(axis=1), (edge * spread).sum(axis=1)


def polynomial(powers, coefficients, roughness):
    return sum(c * roughness**k for k, c in zip(powers, coefficients))


def fit_below(powers, roughness, target):
    """A polynomial below the target by as little as can be."""
    terms = np.stack([roughness**k for k in powers], axis=1)
    margin = 0.0
    for _ in range(30):
        found, _ = minimax(terms, target - margin)
        short = (terms @ found - target).max()
        if short <= 0:
            break
        margin += 1.02 * short
    return found


def narrowed(alpha_x, alpha_y, azimuth):
    """Of anisotropic facets: alpha that counts along one azimuth, the scale of the loss, and what
    edge is raised by."""
    least, most = np.minimum(alpha_x, alpha_y), np.maximum(alpha_x, alpha_y)
    along2 = (alpha_x * np.cos(azimuth)) ** 2 + (alpha_y * np.sin(azimuth)) ** 2
    unlike = 1 - least / most
    alpha = np.sqrt((along2 + least**2) / 2) * (1 - NARROW * unlike)
    return np.maximum(alpha, ALPHA_MIN), 1 - KEEP * unlike, RAISE * unlike


def report(name, values):
    print("%s: %.4f to %.4f, mean %.4f" % (name, values.min(), values.max(), values.mean()))


def check_isotropic(fit, mean_loss, mean_edge):
    """On other nodes: what the fits are above the quadrature, and what a white dielectric returns
    of uniform light."""
    roughness = np.append(np.linspace(0.04, 0.99, 24), 1)
    cosine, alpha, white, edge = table(np.linspace(0.1, 1, 28) ** 2, roughness)
    fitted = fit.white(cosine, alpha)
    fitted_edge = fit.edge(cosine, alpha, fitted)
    white_mean, edge_mean = (np.repeat(m, 28) for m in gauss_means(fit, roughness))
    spared = polynomial(MEAN_LOSS, mean_loss, np.sqrt(alpha))
    kept = polynomial(MEAN_EDGE, mean_edge, np.sqrt(alpha))
    for f0 in (0, 0.04, 0.25, 1):
        share = f0 * fitted + (1 - f0) * fitted_edge
        true = f0 * white + (1 - f0) * edge
        mean = 1 - f0 * white_mean - (1 - f0) * edge_mean
        report("f0 %g: above by" % f0, share - true)
        returned = true + (1 - share) * mean / (1 - f0 * (1 - spared) - (1 - f0) * kept)
        report("  white returns", returned)


def check_anisotropic(fit):
    rows = []
    for alpha_x in (0.05, 0.2, 0.5, 1):
        for ratio in (0.02, 0.1, 0.3, 0.7, 0.95):
            alpha_y = max(alpha_x * ratio, ALPHA_MIN)
            rows += [(c, alpha_x, alpha_y, t) + quadrature(c, alpha_x, alpha_y, t, 128)
                     for c in (0.01, 0.03, 0.1, 0.3, 0.6, 0.9)
                     for t in np.linspace(0, np.pi / 2, 5)]
    cosine, alpha_x, alpha_y, azimuth, white, edge = np.array(rows).T
    alpha, scale, rise = narrowed(alpha_x, alpha_y, azimuth)
    fitted = fit.white(cosine, alpha, scale)
    fitted_edge = fit.edge(cosine, alpha, fitted, rise)
    for f0 in (0, 0.04, 0.25, 1):
        off = f0 * (fitted - white) + (1 - f0) * (fitted_edge - edge)
        report("anisotropic, f0 %g: above by" % f0, off)


def show(name, powers, coefficients):
    print(name, ", ".join("%s: %.7g" % pair for pair in zip(powers, coefficients)))


def main():
    cosines = np.unique(np.append([1e-4, 1e-3, 3e-3], np.linspace(0, 1, 61)[1:] ** 2.2))
    roughnesses = np.append(ALPHA_MIN**0.5, np.linspace(0.05, 1, 39))
    fit = fit_lobe(*table(cosines, roughnesses))
    nodes = np.linspace(ALPHA_MIN**0.5, 1, 60)
    white_mean, edge_mean = gauss_means(fit, nodes)
    mean_loss = -fit_below(MEAN_LOSS, nodes, white_mean - 1)
    mean_edge = fit_below(MEAN_EDGE, nodes, edge_mean)
    show("loss", LOSS, fit.loss)
    show("cosine", COSINE, fit.cosine)
    show("mean loss", MEAN_LOSS, mean_loss)
    show("mean edge", MEAN_EDGE, mean_edge)
    print("edge is raised by %g" % fit.raise_edge)
    check_isotropic(fit, mean_loss, mean_edge)
    check_anisotropic(fit)


if __name__ == "__main__":
    main()
