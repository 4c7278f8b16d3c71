#!/usr/bin/env python3
"""Light that is scattered many times in a half space: media against Chandrasekhar's H-function;
the subsurface material's colour, furnaces, and that its walk counts as one event."""
import numpy as np

from support.render import render
from support.scene import Scene
from support.shapes import box, look_at, sphere
from support.verdict import check, main, near, within

NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)
NODES, WEIGHTS = 0.5 * (NODES + 1), 0.5 * WEIGHTS


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
    s = Scene()
    s.add(box((-40, -40, -4), (40, 40, 0)), s.material(cdl=dict(material, model="subsurface")))
    return seen(s, degrees, spp, depth)


def seen(s, degrees, spp, depth):
    """The mean over a few pixels at the origin under a white sky, with its standard error."""
    s.environment(radiance=1)
    angle = np.radians(degrees)
    s.camera(look_at((9 * np.sin(angle), 0, 9 * np.cos(angle)), (0, 0, 0)), half_height=0.01)
    picture = render(s, (16, 16), spp, depth)
    pixels = picture.rgb.reshape(-1, 3)
    return pixels.mean(0), pixels.std(0) / np.sqrt(len(pixels))


def test_half_spaces():
    """A half space of isotropic scattering under a constant sky, with nothing that refracts, seen at
    cosine mu, reflects 1 - sqrt(1 - albedo) H(mu)."""
    albedo = np.array((0.5, 0.8, 0.95))
    for degrees in (0, 45, 80):
        s = Scene()
        s.add(box((-40, -40, -4), (40, 40, 0)),
              s.interface({"scattering": list(50 * albedo), "absorption": list(50 - 50 * albedo)}))
        mean, error = seen(s, degrees, 128, 3000)
        for c in range(3):
            want = 1 - np.sqrt(1 - albedo[c]) * h_function(albedo[c], np.cos(np.radians(degrees)))
            within("albedo %g at %d degrees" % (albedo[c], degrees), mean[c], want, error[c], 0.01,
                   power=False)


def test_colours():
    """What `albedo` says is what comes out of all the light that came in, from wherever it is seen;
    scattering that favours one direction follows its similarity to isotropic scattering."""
    colour = np.array((0.2, 0.5, 0.8))
    for name, more, tolerance in (("ior 1", dict(alpha=0, ior=1), 0.012),
                                  ("smooth", dict(alpha=0), 0.015), ("rough", dict(alpha=0.3), 0.03),
                                  ("forward", dict(alpha=0.1, g=0.5), 0.06)):
        for degrees in (15, 60):
            material = dict(dict(radius=0.02, ior=1.4, albedo=list(colour)), **more)
            mean, _ = half_space(material, degrees, 256, 12)
            black, _ = half_space(dict(material, albedo=0), degrees, 32, 12)
            # The boundary passes 1 - black; of the body's light the same share of its mean leaves.
            near("%s at %d degrees: colour of the body" % (name, degrees),
                 (mean - black) / (1 - black), colour, tolerance)


def test_depth():
    """Entering, walking and leaving are one event."""
    material = dict(albedo=0.9, radius=0.02, ior=1, alpha=0)
    deep, _ = half_space(material, 0, 64, 30)
    one, error = half_space(material, 0, 64, 1)
    within("a walk within one event", one[1], deep[1], error[1], 0.002, power=False)
    none, _ = half_space(material, 0, 16, 0)
    check("no walk without an event", none.max() == 0, str(none))


def test_furnace():
    """Nothing is lost or gained where nothing is absorbed; rough boundaries keep back a little
    (bsdf/plastic.h)."""
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
