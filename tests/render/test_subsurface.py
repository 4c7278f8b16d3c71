#!/usr/bin/env python3
"""Light that walks under a surface: semi-infinite media against Chandrasekhar's H-function, the
colour asked for, furnaces, and that the walk counts as one event."""
import numpy as np

from support.render import render
from support.scene import Scene
from support.shapes import box, look_at, sphere
from support.verdict import check, main, near, within

NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)
NODES, WEIGHTS = 0.5 * (NODES + 1), 0.5 * WEIGHTS


def single_albedo(many):
    """Of a collision, for the colour that many of them give (Kulla and Conty 2017)."""
    return 1 - (4.09712 + 4.20863 * many - np.sqrt(
        9.59217 + 41.6808 * many + 17.7126 * many * many)) ** 2


def h_function(albedo, mu):
    """Chandrasekhar's, isotropic, by iteration of his second form, which converges for albedo 1."""
    h = np.ones_like(NODES)
    root = np.sqrt(1 - albedo)

    def kernel(at):
        x = np.asarray(at)[..., None]
        return 1 / (root + 0.5 * albedo * (WEIGHTS * NODES * h / (x + NODES)).sum(-1))
    for _ in range(400):
        h = kernel(NODES)
    return float(kernel(mu))


def half_space(material, degrees, spp=128, depth=6):
    """The mean over a few pixels of a wide slab under a white sky, with its standard error."""
    s = Scene()
    s.add(box((-40, -40, -4), (40, 40, 0)), s.material(cdl=dict(material, model="subsurface")))
    s.environment(radiance=1)
    angle = np.radians(degrees)
    s.camera(look_at((9 * np.sin(angle), 0, 9 * np.cos(angle)), (0, 0, 0)), half_height=0.01)
    picture = render(s, (16, 16), spp, depth)
    pixels = picture.rgb.reshape(-1, 3)
    return pixels.mean(0), pixels.std(0) / np.sqrt(len(pixels))


def test_half_spaces():
    """Seen at cosine mu under a constant sky it reflects 1 - sqrt(1 - albedo) H(mu)."""
    colour = np.array((0.3, 0.6, 0.9))
    for degrees in (0, 45, 80):
        mean, error = half_space(dict(albedo=list(colour), radius=0.02, ior=1, alpha=0), degrees)
        for c in range(3):
            # An index of 1 leaves 0.17 % of Egan and Hilgeman's fit of the inner reflectance.
            inner = -1.4399 + 0.7099 + 0.6681 + 0.0636
            single = single_albedo(colour[c] / (1 - inner + inner * colour[c]))
            want = 1 - np.sqrt(1 - single) * h_function(single, np.cos(np.radians(degrees)))
            within("colour %g at %d degrees" % (colour[c], degrees), mean[c], want, error[c], 0.01,
                   power=False)


def test_colours():
    """What `albedo` says is what comes out of all the light that came in, whatever the boundary."""
    colour = np.array((0.2, 0.5, 0.8))
    for name, more in (("smooth", dict(alpha=0)), ("rough", dict(alpha=0.3)),
                       ("forward", dict(alpha=0.1, g=0.5))):
        material = dict(more, albedo=list(colour), radius=0.02, ior=1.4)
        total = np.zeros(3)
        for mu, weight in ((0.211325, 0.5), (0.788675, 0.5)):  # two nodes of Gauss and Legendre
            mean, _ = half_space(material, np.degrees(np.arccos(mu)), 128, 12)
            black, _ = half_space(dict(material, albedo=0), np.degrees(np.arccos(mu)), 16, 12)
            total += 2 * mu * weight * (mean - black) / (1 - black)
        near("%s: colour of the body" % name, total, colour, 0.06)


def test_depth():
    """The walk is one event, entering and leaving are one each."""
    material = dict(albedo=0.9, radius=0.02, ior=1, alpha=0)
    deep, _ = half_space(material, 0, 64, 30)
    two, error = half_space(material, 0, 64, 2)
    within("a walk within two events", two[1], deep[1], error[1], 0.002, power=False)
    one, _ = half_space(material, 0, 16, 1)
    check("no walk without leaving", one.max() < 1e-3, str(one))


def test_furnace():
    """Nothing is lost or gained where nothing is absorbed; rough boundaries give back what their
    facets lose to within a hundredth (bsdf/energy.h)."""
    for name, more, tolerance in (("smooth", dict(alpha=0), 0.006), ("rough", dict(alpha=0.4), 0.012),
                                  ("backward", dict(alpha=0, g=-0.8), 0.006),
                                  ("ior 1", dict(alpha=0, ior=1), 0.006)):
        s = Scene()
        s.add(sphere(0.8, (0, 0, 0), 48, 24, smooth=True),
              s.material(cdl=dict(more, model="subsurface", albedo=1, radius=0.2)))
        s.environment(radiance=1)
        s.camera(look_at((0, 0, 3), (0, 0, 0)), yfov=36)
        mean = render(s, (32, 32), 64, 400).rgb.reshape(-1, 3).mean(0)
        near("%s: a white body in a white sky" % name, mean, (1, 1, 1), tolerance)


if __name__ == "__main__":
    main(test_half_spaces, test_colours, test_depth, test_furnace)
