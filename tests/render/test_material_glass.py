#!/usr/bin/env python3
"""What passes through surfaces: refraction by colour, sheets, tints, interiors, and light that is
sampled across rough boundaries, against closed forms and against pictures that find the same light
by another way."""
import numpy as np

from support.cells import Cells, front_and_back, layers, tilted
from support.color import TO_RGB, matching_functions
from support.optics import fresnel_dielectric
from support.render import render
from support.scene import Scene
from support.shapes import box, joined, look_at, quad, sphere
from support.verdict import agrees, check, main, near, within

SQUARE = quad((0, 0, 0), (0.95, 0, 0), (0, 0.95, 0))
WEDGE = np.radians(25)
RED_BLUE = front_and_back((1, 0, 0), (0, 0, 1))
PLATE = dict(base=(1, 1, 1), metallic=0.0, roughness=0.0)
CLEAR = dict(transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1})


def inner(cells, i):
    return cells.region(i, 0.1, 0.9, 0.1, 0.9)


def glass(**members):
    return {"cdl": dict(members, model="dielectric")}


# --- Prisms.

def prism():
    """A ray from the camera enters it straight and leaves by a face tilted by WEDGE."""
    rise = 1.8 * np.tan(WEDGE)
    a, b, c = np.array([(-0.9, 0, 0.4), (0.9, 0, 0.4), (0.9, 0, 0.4 - rise)])
    up = np.array((0, 0.95, 0))

    def face(p, q):
        """From p to q to the right, seen from outside with +Y above."""
        return quad((p + q) / 2, (q - p) / 2, up)

    def cap(y, order):
        corners = np.array([a, b, c]) + (0, y, 0)
        return dict(positions=corners, indices=np.array([order]))
    return joined(face(a, b), face(b, c), face(c, a), cap(0.95, (0, 1, 2)), cap(-0.95, (2, 1, 0)))


def deviations(materials, spp):
    """By how many degrees each prism turns what the camera sees, by channel: the mean of what
    comes through. A sky that grows linearly with the angle, over one that is constant."""
    pictures = []
    for ramp in (True, False):
        cells = Cells(len(materials), 1)
        columns = 256
        image = np.zeros((4, columns, 3))
        image[:, :columns // 2] = 1
        if ramp:
            image *= ((np.arange(columns) + 0.5) / columns)[None, :, None]
        cells.environment(image=image)
        for material in materials:
            cells.show(prism(), cells.material(**material))
        pictures.append(cells.render(spp, 2))
    out = []
    for i in range(len(materials)):
        ramp, flat = [p.rgb[inner(cells, i)].mean(0) for p in pictures]
        out.append((ramp / flat - 0.25) * 360)  # -Z is a quarter of the way round
    return out


def deviation(index):
    return np.degrees(np.arcsin(index * np.sin(WEDGE)) - WEDGE)


def sensitivities():
    """Wavelengths in um and how much each channel of Rec. 709 sees of them: the positive parts of
    its matching functions, red without the violet."""
    w = np.arange(380, 781, 1.0)
    rgb = TO_RGB @ matching_functions(w)
    rgb[0] *= w > 500
    return w / 1000, np.maximum(rgb, 0)


def cauchy(ior, abbe, w):
    """A + B / w^2 with n_d = ior and (n_d - 1) / (n_F - n_C) = abbe (Fraunhofer's lines)."""
    d, f, c = 0.5875618, 0.4861327, 0.6562725
    b = (ior - 1) / abbe / (1 / f ** 2 - 1 / c ** 2)
    return ior + b * (1 / w ** 2 - 1 / d ** 2)


def test_prisms():
    w, seen = sensitivities()
    plain = layers(dispersion={"dispersion": 3}, **CLEAR)
    layered = layers(dispersion={"dispersion": 3}, specular={"specularFactor": 0.999}, **CLEAR)
    cases = [("glass", glass(ior=1.6), deviation(1.6), 1e-3),
             ("nearly smooth glass", glass(ior=1.6, alpha=1e-4), deviation(1.6), 0.015),
             ("glass of Abbe number 20", glass(ior=1.6, abbe=20), (1.6, 20), 0.02),
             ("nearly smooth glass of Abbe number 20", glass(ior=1.6, alpha=1e-4, abbe=20),
              (1.6, 20), 0.02),
             ("glass of dispersion 3", dict(PLATE, **plain), (1.5, 20 / 3), 0.04),
             ("glass of dispersion 3 with a layer", dict(PLATE, **layered), (1.5, 20 / 3), 0.04),
             ("Disney's glass", {"cdl": {"model": "disney", "baseColor": [1, 1, 1], "specTrans": 1,
                                         "roughness": 0.001, "specular": 0, "ior": 1.4}},
              deviation(1.4), 0.02)]
    got = deviations([material for _, material, _, _ in cases], 1024)
    for (name, _, want, tolerance), value in zip(cases, got):
        if isinstance(want, tuple):
            index = cauchy(*want, w)
            passed = seen * (1 - fresnel_dielectric(np.cos(WEDGE), 1 / index))
            want = (passed * deviation(index)).sum(1) / passed.sum(1)
        near("a prism of " + name, value, want, tolerance)


# --- Sheets and interiors.

def test_thin_sheets():
    """2 r / (1 + r) is reflected and the rest passes, tinted once. glTF's thin sheet reflects by
    Schlick and is tinted once as well."""
    cells, wants = Cells(3, 3, depth=1000), []
    cells.environment(image=RED_BLUE)
    # Rough ones are behind the others, so that none stands in what passes beside straight on.
    for roughness, tilt in [(r, t) for r in (0.1, 0.0, None) for t in (10, 25, 40)]:
        cosine = np.cos(np.radians(tilt))
        r = float(fresnel_dielectric(cosine, 1.5))
        reflected = 2 * r / (1 + r)
        material = glass(thin=True, transmittance=[1, 1, 0.6])
        if roughness is not None:
            reflected = 0.04 + 0.96 * (1 - cosine) ** 5
            material = dict(base=(1, 1, 0.6), metallic=0.0, roughness=roughness,
                            **layers(transmission=CLEAR["transmission"]))
        wide = quad((0, 0, 0), (0.95 / cosine, 0, 0), (0, 0.95, 0))
        cells.show(wide, cells.material(**material), tilted(tilt))
        wants.append((reflected, (1 - reflected) * 0.6))
    picture = cells.render(3072)
    for i, (reflected, passed) in enumerate(wants):
        # A few rays that rough sheets spread meet other sheets.
        few = i < 3
        agrees("sheet %d" % i, picture, (reflected, 0, passed), 0.01 if few else 0.035,
               9 if few else 3, inner(cells, i), power=not few)


def test_interiors():
    """Boxes of index 1: tinted at both faces, weakened on the way by color^(length / distance)."""
    tint, color = np.array((0.9, 0.8, 0.5)), np.array((0.8, 0.5, 0.3))
    interior = {"thicknessFactor": 0.1, "attenuationDistance": 0.4, "attenuationColor": list(color)}
    cells = Cells(2, 1)
    cells.environment(image=front_and_back((0, 0, 0), (1, 1, 1)))
    for more in ({}, dict(specular={"specularFactor": 0.99})):
        parts = layers(transmission=CLEAR["transmission"], volume=interior, ior={"ior": 1.0},
                       **more)
        cells.show(box((-0.9, -0.9, -0.4), (0.9, 0.9, 0.2)),
                   cells.material(base=tint, metallic=0.0, roughness=0.0, **parts))
    picture = cells.render(1024, 4)
    for i, name in enumerate(("plain", "layered")):
        want = tint ** 2 * color ** (0.6 / 0.4)
        agrees("a box of " + name + " glass", picture, want, 0.01, region=inner(cells, i))


def test_plastic():
    """Smooth plastic seen straight, under a sky of 1: F + (1 - F) r T / (n^2 (1 - r K)), where T is
    what passes of diffuse light and K what is reflected from inside, total reflection included."""
    cosine = (np.arange(200000) + 0.5) / 200000
    cells, wants = Cells(3, 1), []
    cells.environment(radiance=1)
    for ior, r in ((1.5, np.array((0.9, 0.5, 0.1))), (1.3, np.array((1, 0.8, 0.2))),
                   (1.9, np.array((0.95, 0.6, 0.3)))):
        enters = 2 * np.mean((1 - fresnel_dielectric(cosine, ior)) * cosine)
        inside = 2 * np.mean(fresnel_dielectric(cosine, 1 / ior) * cosine)
        f = float(fresnel_dielectric(1.0, ior))
        # Radiance leaves weakened by the square of the index.
        wants.append(f + (1 - f) * r * enters / ior ** 2 / (1 - r * inside))
        cells.show(SQUARE, cells.material({"model": "plastic", "ior": ior, "alpha": 0,
                                           "reflectance": list(r)}))
    picture = cells.render(1024)
    for i, want in enumerate(wants):
        agrees("plastic %d" % i, picture, want, 0.004, region=inner(cells, i), power=False)


# --- Light found by two ways.

def sheets():
    """What lets light through and has no delta lobe; whether it is a sheet or a slab."""
    rough = dict(PLATE, base=(0.9, 0.7, 0.5), roughness=0.55)
    disney = {"model": "disney", "baseColor": [0.9, 0.7, 0.5], "roughness": 0.5}
    coat = {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4}
    return [("rough glass", glass(alpha=0.3), False),
            ("compensated Beckmann glass", glass(alpha=[0.5, 0.3], distribution="beckmann",
                                                 energyCompensation=True), False),
            ("dispersive rough glass", glass(alpha=0.3, abbe=15), False),
            ("thin rough glass", glass(alpha=0.3, thin=True, transmittance=[0.9, 0.7, 0.5]), True),
            ("Disney's glass", {"cdl": dict(disney, specTrans=0.8)}, False),
            ("a leaf of Disney", {"cdl": dict(disney, thin=True, diffTrans=1.2, flatness=0.5)},
             True),
            ("glTF's rough glass", dict(rough, **layers(**CLEAR)), False),
            ("glTF's dispersive rough glass", dict(rough, **layers(
                dispersion={"dispersion": 3}, **CLEAR)), False),
            ("glTF's frosted sheet", dict(rough, **layers(
                transmission=CLEAR["transmission"], clearcoat=coat)), True),
            ("a leaf of glTF", dict(rough, **layers(
                diffuse_transmission={"diffuseTransmissionFactor": 0.6}, sheen={
                    "sheenColorFactor": [0.5, 0.5, 0.5], "sheenRoughnessFactor": 0.5})), True)]


def put(cells, material, thin):
    shape = SQUARE if thin else box((-0.95, -0.95, -0.05), (0.95, 0.95, 0.05))
    return cells.show(shape, cells.material(**material))


def same_light(what, pictures, cells, names):
    for i, name in enumerate(names):
        region = cells.region(i)
        (a, va), (b, vb) = [(p.rgb[region].mean(0), p.variance[region].sum(0) / region.sum() ** 2)
                            for p in pictures]
        within("%s: %s" % (name, what), a, b, np.sqrt(va + vb), 0.01, power=False)
        check("%s lets light through" % name, np.all(b > 0.01), str(b))


def test_lamps_behind_glass():
    """A lamp that is sampled as a light, and an unlit square of the same radiance, which only
    scattered rays can find."""
    pictures = []
    for sampled in (True, False):
        cells = Cells(6, 2)
        cells.environment(radiance=0)
        lamp = cells.emitter(1, doubleSided=True) if sampled else cells.unlit()
        lamps = quad((-0.45, 0.1, -0.7), (0.35, 0, 0), (0, 0.5, 0))
        for _, material, thin in sheets():
            put(cells, material, thin)
            cells.put(lamps, lamp)
        # A wall to the right that a lamp lights through a sheet to the left of it.
        cells.show(quad((0.4, 0, 0), (0, 0, 0.9), (0, -0.9, 0)), cells.diffuse(0.8))
        cells.put(box((-0.1, -0.9, -0.9), (-0.05, 0.9, 0.9)), cells.material(**glass(alpha=0.3)))
        cells.put(lamps, lamp)
        pictures.append(cells.render(1024, 6))
    same_light("a sampled lamp as a found one", pictures, cells,
               [name for name, _, _ in sheets()] + ["a wall behind rough glass"])


def test_suns_behind_glass():
    """A directional light, which nothing but light sampling finds, and one texel of a sky, which
    both find, as large as 1.4 degrees."""
    columns, rows, column = 512, 257, 198
    degrees = (0.75 - (column + 0.5) / columns) * 360  # +Z is three quarters of the way round
    thin = [(name, material) for name, material, thin in sheets() if thin]
    pictures = []
    for punctual in (True, False):
        cells = Cells(len(thin), 1)
        image = np.zeros((rows, columns, 3))
        if punctual:
            cells.sun(degrees, 3)
        else:
            image[rows // 2, column] = 3 / (2 * np.pi / columns * np.pi / rows)
        cells.environment(image=image)
        for _, material in thin:
            put(cells, material, True)
        pictures.append(cells.render(1024, 1))
    same_light("a directional light as a texel", pictures, cells, [name for name, _ in thin])


def test_light_outside_from_within():
    """A shadow ray that leaves rough glass is in what is outside, where the path stays within: an
    interior that absorbs nothing that could be seen, in red alone, leaves red like green."""
    s = Scene()
    s.add(sphere(0.8, (0, 0, 0), 24, 12, smooth=True),
          s.material(cdl={"model": "dielectric", "ior": 1.5, "alpha": 0.4},
                     medium={"absorption": [1e-9, 0, 0]}))
    s.environment(radiance=1)
    s.camera(look_at((0, 0, 3), (0, 0, 0)), yfov=30)
    mean = render(s, (32, 32), 64, 8).rgb.reshape(-1, 3).mean(0)
    near("red beside green through rough glass", mean[0] / mean[1], 1, 1e-4)


def test_layered_dispersion_alone():
    """KHR_materials_dispersion of rough glass needs no other dispersive material in the scene."""
    films = []
    for dispersion in (0, 5):
        s = Scene()
        glass = {"KHR_materials_transmission": {"transmissionFactor": 1},
                 "KHR_materials_volume": {"thicknessFactor": 1},
                 "KHR_materials_dispersion": {"dispersion": dispersion}}
        s.add(sphere(0.8, (0, 0, 0), 24, 12, smooth=True),
              s.material(base=(1, 1, 1), metallic=0, roughness=0.1, extensions=glass))
        s.environment(radiance=1)
        s.camera(look_at((0, 0, 3), (0, 0, 0)), yfov=40)
        films.append(render(s, (32, 32), 16, 6).sha256)
    check("rough layered glass disperses", films[0] != films[1])


if __name__ == "__main__":
    main(test_prisms, test_thin_sheets, test_interiors, test_plastic, test_lamps_behind_glass,
         test_suns_behind_glass, test_light_outside_from_within,
         test_layered_dispersion_alone)
