#!/usr/bin/env python3
"""Furnaces: scenes in which every point must have the same radiance, and materials under a sky
of 1 against their formulas by quadrature.

Power: the noise of each mean is asked to be below a third of what is allowed, so a loss of
energy of 1 % (closed sphere), 0.2 % (white under a sky) or 0.3 % (materials) does not pass.
Depth and Russian roulette are in it: at albedo 0.9 half of the light has been through seven
events and more."""
import numpy as np

from support.optics import (beckmann_density, beckmann_lambda, fresnel_conductor, ggx_density,
                            ggx_lambda, gltf_albedo, microfacet_brdf, reflected)
from support.render import render
from support.scene import Scene
from support.shapes import box, inside_out, look_at, move, quad, sphere
from support.verdict import agrees, check, main, near

GOLD = dict(eta=[0.143, 0.375, 1.442], k=[3.983, 2.386, 1.603])


def inside(shape, material, lights=(), depth=64, spp=32):
    """The inside of a closed surface, seen from near its centre."""
    s = Scene()
    s.use_every_feature()
    s.add(inside_out(shape), material(s))
    for position, intensity in lights:
        s.light("point", intensity, move(*position))
    s.camera(look_at((0.1, 0.05, 0.2), (1, 0.3, -0.2)), yfov=90)
    s.environment(radiance=0)
    return render(s, (32, 32), spp, depth)


def test_closed_sphere():
    # Radiance e + rho L = L, whatever the shape: e = 1 - rho gives 1.
    glowing = inside(sphere(1), lambda s: s.diffuse(0.5, emission=0.5))
    agrees("a sphere of albedo 0.5 that glows at 0.5", glowing, 1, 0.01)
    glowing = inside(box((-1, -1, -1), (1, 2, 1)), lambda s: s.diffuse(0.9, emission=0.1),
                     depth=400, spp=128)
    agrees("a box of albedo 0.9 that glows at 0.1, by roulette", glowing, 1, 0.01)
    # A point light of intensity pi in the centre of a sphere of radius 1: irradiance pi from it,
    # of which a half comes back, and a half of that: 1/2 + 1/4 + ... = 1. The facets of the sphere
    # stand at a distance of 1 less 0.1 % and are a little tilted.
    lit = inside(sphere(1, columns=128, rows=64), lambda s: s.diffuse(0.5), [((0, 0, 0), np.pi)])
    agrees("a sphere of albedo 0.5 about a point light", lit, 1, 0.01)


def under_sky(shape, material, depth, size=(32, 32), spp=64, eye=(3, 2, 4), width=0.4):
    s = Scene()
    s.use_every_feature()
    s.add(shape, material(s))
    s.camera(look_at(eye, (0, 0, 0)), half_height=width)
    s.environment(radiance=1)
    return render(s, size, spp, depth)


def test_white_under_sky():
    white = {"model": "diffuse", "reflectance": [1, 1, 1]}
    for name, shape in (("sphere", sphere(1)), ("box", box((-.6, -.6, -.6), (.6, .6, .6)))):
        picture = under_sky(shape, lambda s: s.material(white), 64, spp=256)
        agrees("a white %s under a sky" % name, picture, 1, 0.002)
    # A cup, into which paths go again and again: white as well when paths may be long.
    cup = box((-1, -1, -1), (1, 1, 1))
    cup["indices"] = np.delete(cup["indices"], (8, 9), 0)  # its +Z side
    picture = under_sky(cup, lambda s: s.material(white), 1000, spp=512, eye=(0.5, 0.3, 4))
    agrees("a white cup under a sky", picture, 1, 0.003)


def test_lossless_materials():
    ball = sphere(1)
    mirror = under_sky(ball, lambda s: s.material({"model": "mirror"}), 4, spp=16)
    near("a mirror under a sky", mirror.rgb, 1, 1e-5)
    glass = under_sky(ball, lambda s: s.material({"model": "dielectric", "ior": 1.5}), 1000,
                      spp=256)
    agrees("a glass ball under a sky", glass, 1, 0.003)
    thick = under_sky(box((-.6, -.6, -.6), (.6, .6, .6)),
                      lambda s: s.material({"model": "dielectric", "ior": 1.2}), 1000, spp=256)
    agrees("a glass cube of index 1.2 under a sky", thick, 1, 0.003)
    # An index without a real part reflects everything at every angle.
    lossless = {"model": "conductor", "eta": [0, 0, 0], "k": [1, 3, 9]}
    metal = under_sky(ball, lambda s: s.material(lossless), 4, spp=16)
    near("a smooth metal without loss under a sky", metal.rgb, 1, 1e-4)


def test_no_material_gains():
    """Rough surfaces lose what is scattered twice between facets; none may gain."""
    rough = [("conductor", dict(eta=[0, 0, 0], k=[3, 3, 3])), ("retroreflector", dict(ior=1.0))]
    for model, more in rough:
        for distribution in ("ggx", "beckmann"):
            for masking in ("correlated", "separable"):
                cdl = dict(more, model=model, alpha=0.5, distribution=distribution, masking=masking)
                picture = under_sky(sphere(1), lambda s, cdl=cdl: s.material(cdl), 2, (16, 16), 64)
                mean = picture.rgb.mean()
                check("%s, %s, %s: albedo %.4f of at most 1" % (model, distribution, masking, mean),
                      0.5 < mean <= 1.002)


def seen_at(degrees, materials, spp):
    """What squares return of a sky of 1, seen at an angle to their normal: for each material the
    part of the picture that shows it. They lie in one plane, above each other."""
    s = Scene()
    s.use_every_feature()
    for i, material in enumerate(materials):
        s.add(quad((0, 0.2 * i, 0), (1, 0, 0), (0, 0.1, 0)), s.material(**material))
    angle, height = np.radians(degrees), 0.1 * (len(materials) - 1)
    s.camera(look_at((5 * np.sin(angle), height, 5 * np.cos(angle)), (0, height, 0)),
             half_height=0.1 * len(materials))
    s.environment(radiance=1)
    rows = 16 * len(materials)
    picture = render(s, (16, rows), spp, 1)
    row = np.arange(rows)[:, None] // 16 + np.zeros((1, 16), int)
    return picture, [row == len(materials) - 1 - i for i in range(len(materials))]


def direction(degrees):
    return np.array([np.sin(np.radians(degrees)), 0, np.cos(np.radians(degrees))])


def gold(density, smith, alpha, correlated, degrees):
    """What quadrature says that gold returns, by channel."""
    return [reflected(microfacet_brdf(density, smith, lambda c: fresnel_conductor(c, eta, k), alpha,
                                      correlated), direction(degrees))
            for eta, k in zip(GOLD["eta"], GOLD["k"])]


def test_metals_against_quadrature():
    """Gold by channel, at three angles, against D G F / 4 cos cos integrated in double
    precision."""
    lobes = [("ggx", ggx_density, ggx_lambda), ("beckmann", beckmann_density, beckmann_lambda)]
    kinds = [lobe + (masking,) for lobe in lobes for masking in ("correlated", "separable")]
    for degrees, alpha in ((0, 0.2), (60, 0.4), (80, 0.3)):
        materials = [{"cdl": dict(GOLD, model="conductor", alpha=alpha, distribution=name,
                                  masking=masking)} for name, _, _, masking in kinds]
        picture, regions = seen_at(degrees, materials, 256)
        for region, (name, density, smith, masking) in zip(regions, kinds):
            agrees("gold, %s %s, alpha %g at %d degrees" % (name, masking, alpha, degrees), picture,
                   gold(density, smith, alpha, masking == "correlated", degrees), region=region)


def test_gltf_against_quadrature():
    """glTF's metallic-roughness against its specular lobe integrated. What is below loses up to
    0.7 % to a fit that stays on the safe side, and gains nothing."""
    base = (0.9, 0.5, 0.1)
    index = {"KHR_materials_ior": {"ior": 1.7}}
    for degrees, kinds in ((0, [(0, 0.4), (1, 0.5)]), (70, [(0, 0.7), (0.5, 0.6)])):
        materials = [dict(base=base, metallic=m, roughness=r, extensions=dict(index))
                     for m, r in kinds]
        picture, regions = seen_at(degrees, materials, 1024)
        for region, (metallic, roughness) in zip(regions, kinds):
            want = np.array([gltf_albedo(b, metallic, roughness, 1.7, direction(degrees))
                             for b in base])
            name = "glTF metallic %g, roughness %g at %d degrees" % (metallic, roughness, degrees)
            if metallic == 1:
                agrees(name, picture, want, region=region)
                continue
            got = picture.rgb[region].mean(0)
            noise = 3 * np.sqrt(picture.variance[region].sum(0)) / region.sum()
            check(name, (noise < 0.003).all() and (got < want + noise + 2e-4).all()
                  and (got > want - noise - 0.007 * np.array(base)).all(),
                  "%s instead of %s" % (got, want))


if __name__ == "__main__":
    main(test_closed_sphere, test_white_under_sky, test_lossless_materials, test_no_material_gains,
         test_metals_against_quadrature, test_gltf_against_quadrature)
