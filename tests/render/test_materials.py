#!/usr/bin/env python3
"""White furnaces for every material: convex white bodies under a sky of 1.

Nothing is seen brighter than the sky, the body as a whole and its rim alone, but for three models
whose published formulas add their lobes up as they are: Disney's, glTF's dielectric (its diffuse
part is weighed by 1 - F of the half vector) and all that lies over that. Those keep to the figures
that the headers of their kernels give, and layers never raise what lies below them."""
import numpy as np

from support.cells import Cells, layers
from support.shapes import sphere
from support.verdict import check, main, within

WHITE = [1, 1, 1]
PLATE = dict(base=(1, 1, 1), metallic=0.0)
COAT = {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.3}
SHEEN = {"sheenColorFactor": WHITE, "sheenRoughnessFactor": 0.4}
FILM = {"iridescenceFactor": 1, "iridescenceThicknessMaximum": 350}
BRUSHED = {"anisotropyStrength": 0.7, "anisotropyRotation": 0.5}
BACK = {"retroreflectionFactor": 0.6}
THROUGH, VOLUME = {"transmissionFactor": 1}, {"thicknessFactor": 1}
LEAF = {"diffuseTransmissionFactor": 0.4}
SPREAD = {"dispersion": 4}


def cdl(model, **members):
    return {"cdl": dict(members, model=model)}


# Name, material, and how near to 1 its picture can be held: little light stays in dispersive glass
# for long, but that has large weights.
EXACT = [
    ("diffuse", cdl("diffuse", reflectance=WHITE), 0.004),
    ("oren_nayar, roughness 0", cdl("oren_nayar", reflectance=WHITE, roughness=0), 0.004),
    ("oren_nayar, roughness 1", cdl("oren_nayar", reflectance=WHITE, roughness=1), 0.004),
    ("mirror", cdl("mirror"), 1e-5),
    ("smooth metal without loss", cdl("conductor", eta=[0, 0, 0], k=[1, 3, 9]), 1e-4),
    ("smooth plastic", cdl("plastic", reflectance=WHITE, alpha=0), 0.004),
    ("thin glass", cdl("dielectric", thin=True), 0.002),
    ("a leaf of glTF", dict(PLATE, **layers(diffuse_transmission=LEAF, specular={
        "specularFactor": 0})), 0.01),
    ("glass", cdl("dielectric"), 0.01),
    ("dispersive glass", cdl("dielectric", ior=1.4, abbe=20), 0.03),
    ("glass of glTF", dict(PLATE, roughness=0.0, **layers(transmission=THROUGH, volume=VOLUME)),
     0.01),
    ("dispersive glass of glTF", dict(PLATE, roughness=0.0, **layers(
        transmission=THROUGH, volume=VOLUME, dispersion=SPREAD, ior={"ior": 1.4})), 0.03),
]
METAL = dict(base=(1, 1, 1), metallic=1.0)
LOSSLESS = dict(eta=[0, 0, 0], k=[3, 3, 3])
BOUNDED = [
    ("rough metal", cdl("conductor", alpha=0.5, **LOSSLESS)),
    ("brushed Beckmann metal", cdl("conductor", alpha=[0.6, 0.1], distribution="beckmann",
                                   **LOSSLESS)),
    ("rough glass", cdl("dielectric", alpha=0.4)),
    ("thin rough glass", cdl("dielectric", alpha=0.4, thin=True)),
    ("Beckmann glass", cdl("dielectric", alpha=[0.1, 0.4], distribution="beckmann")),
    ("dispersive rough glass", cdl("dielectric", alpha=0.3, abbe=25)),
    ("plastic", cdl("plastic", reflectance=WHITE)),
    ("rough plastic", cdl("plastic", reflectance=WHITE, alpha=0.6)),
    ("retroreflector", cdl("retroreflector", alpha=0.2)),
    ("retroreflector without a coat", cdl("retroreflector", alpha=0.2, ior=1)),
    ("metal of Disney", cdl("disney", baseColor=WHITE, metallic=1)),
    ("glass of Disney", cdl("disney", baseColor=WHITE, specTrans=1, specular=0, roughness=0.3)),
    ("metal of glTF", dict(METAL, roughness=0.5)),
    ("under a film", dict(METAL, roughness=0.3, **layers(iridescence=FILM))),
    ("brushed", dict(METAL, roughness=0.2, **layers(anisotropy=BRUSHED))),
    ("turned back", dict(METAL, roughness=0.3, **layers(retroreflection=BACK))),
    ("under a coat", dict(METAL, roughness=0.4, **layers(clearcoat=COAT))),
    ("under sheen", dict(METAL, roughness=0.4, **layers(sheen=SHEEN))),
    ("under all of it", dict(METAL, roughness=0.4, **layers(
        clearcoat=COAT, sheen=SHEEN, iridescence=FILM, anisotropy=BRUSHED,
        retroreflection=BACK))),
    ("rough glass of glTF", dict(PLATE, roughness=0.5, **layers(
        transmission=THROUGH, volume=VOLUME, dispersion=SPREAD))),
    ("a rough pane of glTF", dict(PLATE, roughness=0.5, **layers(transmission=THROUGH))),
    ("a coated pane of glTF", dict(PLATE, roughness=0.3, **layers(
        transmission=THROUGH, clearcoat=COAT, sheen=SHEEN))),
]


def furnace(kinds, columns, spp, shape, pixels=16, depth=400):
    """Mean and standard error, for each material, of the whole body and of its rim."""
    cells = Cells(columns, -(-len(kinds) // columns), pixels)
    cells.environment(radiance=1)
    for kind in kinds:
        cells.show(shape, cells.material(**kind[1]))
    picture = cells.render(spp, depth)
    y, x = np.mgrid[:picture.rgb.shape[0], :picture.rgb.shape[1]] % pixels + 0.5
    radius = np.hypot(x / pixels - 0.5, y / pixels - 0.5) * 2
    out = []
    for i in range(len(kinds)):
        body = cells.region(i) & (radius < 0.9)
        out.append([(picture.rgb[r].mean(0), np.sqrt(picture.variance[r].sum(0)) / r.sum())
                    for r in (body, body & (radius > 0.7))])
    return out


BALL = sphere(0.97, columns=48, rows=24)
FINE = sphere(0.97, columns=128, rows=64)  # traps less light than coarse facets do


def test_lossless():
    for (name, _, tolerance), parts in zip(EXACT, furnace(EXACT, 4, 256, FINE)):
        for part, (mean, error) in zip(("", ", the rim"), parts):
            within(name + part, mean, 1, error, tolerance * (3 if part else 1))


def test_no_gain():
    for (name, _), parts in zip(BOUNDED, furnace(BOUNDED, 6, 128, BALL)):
        for part, (mean, error) in zip(("", ", the rim"), parts):
            check(name + part, np.all(mean <= 1 + 3 * error) and np.all(mean > 0.5) and
                  np.all(error < 0.01), "%s +- %s, not 0.5 to 1" % (mean, error))


def test_compensation():
    """What one event between facets loses is given back."""
    kinds = []
    for alpha in (0.1, 0.5, 1.0, [0.7, 0.2]):
        more = dict(alpha=alpha, energyCompensation=True)
        kinds += [("metal %s" % alpha, cdl("conductor", **LOSSLESS, **more)),
                  ("Beckmann metal %s" % alpha, cdl("conductor", distribution="beckmann",
                                                    **LOSSLESS, **more)),
                  ("thin glass %s" % alpha, cdl("dielectric", thin=True, **more))]
        if alpha in (0.1, 0.5):
            kinds.append(("glass %s" % alpha, cdl("dielectric", **more)))
    for (name, _), parts in zip(kinds, furnace(kinds, 4, 256, FINE)):
        for part, (mean, error) in zip(("", ", the rim"), parts):
            check("compensated %s%s" % (name, part), np.all(mean <= 1.0005 + 3 * error) and
                  np.all(mean >= 0.99 - 3 * error) and np.all(error < (0.012 if part else 0.008)),
                  "%s +- %s, not 0.99 to 1" % (mean, error))


# What is known to return more than it gets, and how much at most: headers of disney.h and gltf.h.
KNOWN = [
    ("Disney", cdl("disney", baseColor=WHITE), 1.6),
    ("Disney with all its lobes", cdl("disney", baseColor=WHITE, sheen=1, clearcoat=1, specular=1,
                                      subsurface=0.5), 1.73),
    ("a leaf of Disney", cdl("disney", baseColor=WHITE, thin=True, diffTrans=1, flatness=1), 1.79),
    ("glTF, roughness 0.2", dict(PLATE, roughness=0.2), 1.4),
    ("glTF, roughness 0.9", dict(PLATE, roughness=0.9), 1.0),
]


def test_known_gains():
    for (name, _, most), parts in zip(KNOWN, furnace(KNOWN, 6, 128, BALL)):
        for part, (mean, error) in zip(("", ", the rim"), parts):
            limit = most if part else 1 + (most - 1) / 3
            check(name + part, np.all(mean <= limit + 3 * error) and np.all(mean > 0.5),
                  "%s of at most %g" % (mean, limit))


def test_layers_take():
    """No layer over glTF's white dielectric raises what that returns."""
    over = [("specular 0", dict(specular={"specularFactor": 0})),
            ("a film", dict(iridescence=FILM)), ("a coat", dict(clearcoat=COAT)),
            ("sheen", dict(sheen=SHEEN)),
            ("brushing", dict(anisotropy=BRUSHED)), ("retroreflection", dict(retroreflection=BACK)),
            ("coat, sheen and film", dict(clearcoat=COAT, sheen=SHEEN, iridescence=FILM))]
    rough = dict(PLATE, roughness=0.5)
    kinds = [("plain", rough)] + [(name, dict(rough, **layers(**more))) for name, more in over]
    plain, *rest = furnace(kinds, 6, 128, BALL)
    for (name, _), parts in zip(kinds[1:], rest):
        for part, (mean, error), (most, its) in zip(("", ", the rim"), parts, plain):
            check("%s over glTF%s" % (name, part), np.all(mean > 0.6) and
                  np.all(mean <= np.maximum(most, 1) + 3 * np.hypot(error, its)),
                  "%s, and without %s" % (mean, most))


if __name__ == "__main__":
    main(test_lossless, test_no_gain, test_compensation, test_known_gains, test_layers_take)
