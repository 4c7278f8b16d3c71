#!/usr/bin/env python3
"""A texture on every parameter of every material: a square with a texture of two texels against
two halves of a square with plain factors, which are the texels' values multiplied by hand.

Channels, decoding and multiplication are those of the extensions' texts; all other channels of the
texels hold something else. Both pictures draw the same random numbers, so they are the same but
for rounding, for which 1e-5 is left. A texture that had no effect, or the same on both halves, is
found by the difference of the halves and by a picture without textures."""
import numpy as np

from support.cells import Cells, front_and_back, layers, tilted
from support.shapes import quad
from support.verdict import check, main

CODES = (51, 204)                         # of numbers: 0.2 and 0.8
COLORS = ((51, 128, 204), (230, 188, 30))  # of colours
OTHER = 96                                 # what channels hold that do not count


def decoded(codes):
    """Linear values of sRGB codes (IEC 61966-2-1)."""
    x = np.asarray(codes, float) / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


class Case:
    """One parameter. `path`: where in the material it stands; `factor`: its value beside the
    texture; `channels`: "RGB" for colours, or the one that counts."""

    def __init__(self, name, path, key, factor, channels, material, texture=None):
        self.name, self.path, self.key, self.factor = name, path, key, factor
        self.channels, self.base = channels, material
        self.texture = texture or key.replace("Factor", "") + "Texture"

    def material(self, value, texture=None):
        """A copy of the material with this value of the parameter and this texture on it."""
        copy = _copy(self.base)
        owner = copy
        for step in self.path:
            owner = owner.setdefault(step, {})
        owner[self.key] = np.asarray(value, float).tolist()
        if texture:
            owner[self.texture] = texture
        return copy

    def texels(self):
        pixels = np.full((1, 2, 4), OTHER, np.uint8)
        for i in range(2):
            if self.key == "metallicFactor":
                pixels[0, i, 1] = 255  # green is the roughness
            if self.channels == "RGB":
                pixels[0, i, :3] = COLORS[i]
            else:
                pixels[0, i, "RGBA".index(self.channels)] = CODES[i]
        return pixels

    def values(self):
        """Of the left and the right half: factor times texel."""
        texels = decoded(COLORS) if self.channels == "RGB" else np.array(CODES) / 255
        factor = np.asarray(self.factor, float)
        if factor.size == 4:  # opacity, which the textures here leave alone
            texels = np.concatenate([texels, [[1], [1]]], 1)
        return [factor * texel for texel in texels]


def _copy(value):
    return {k: _copy(v) for k, v in value.items()} if isinstance(value, dict) else value


def cdl(model, key, factor, **members):
    channels = "RGB" if key in ("reflectance", "transmittance", "baseColor") else "R"
    return Case("%s's %s" % (model, key), ("cdl",), key, factor, channels,
                {"cdl": dict(members, model=model)})


def khr(name, key, factor, channels, base=None, more=None, **members):
    extensions = {"KHR_materials_" + name: members}
    extensions.update({"KHR_materials_" + k: v for k, v in (more or {}).items()})
    material = dict(base or {"base": (0.8, 0.5, 0.3), "metallic": 0.0, "roughness": 0.5},
                    extensions=extensions)
    return Case("%s's %s" % (name, key), ("extensions", "KHR_materials_" + name), key, factor,
                channels, material)


WHITE, TINT = [0.9, 0.9, 0.9], [0.9, 0.6, 0.7]
METAL = {"base": (0.9, 0.7, 0.5), "metallic": 1.0, "roughness": 0.4}
DULL = {"base": (0.1, 0.1, 0.1), "metallic": 0.0, "roughness": 0.5}


def cdl_cases():
    for model in ("diffuse", "oren_nayar", "mirror", "retroreflector", "plastic"):
        yield cdl(model, "reflectance", TINT)
    yield cdl("oren_nayar", "roughness", 0.9, reflectance=WHITE)
    yield cdl("retroreflector", "alpha", 0.9)
    yield cdl("plastic", "alpha", 0.6, reflectance=[0.1, 0.1, 0.1])
    yield cdl("conductor", "alpha", 0.8, metal="Cu", distribution="beckmann")
    yield cdl("conductor", "alpha", [0.9, 0.4], metal="Au")
    yield cdl("dielectric", "transmittance", TINT)
    yield cdl("dielectric", "transmittance", TINT, alpha=0.3, thin=True)
    yield cdl("dielectric", "alpha", 0.8)
    yield cdl("disney", "baseColor", TINT)
    shiny = dict(baseColor=[0.8, 0.4, 0.2], roughness=0.4)
    dark = dict(baseColor=[0.002, 0.001, 0.0005], specular=0.0)
    for key, more in (("metallic", shiny), ("roughness", dict(baseColor=[.1, .1, .1])),
                      ("anisotropic", dict(shiny, metallic=1.0)), ("specular", shiny),
                      ("specularTint", dict(shiny, specular=1.0)), ("sheen", dark),
                      ("sheenTint", dict(dark, sheen=1.0)), ("clearcoat", dark),
                      ("clearcoatGloss", dict(dark, clearcoat=1.0)),
                      ("subsurface", shiny), ("specTrans", shiny),
                      ("diffTrans", dict(shiny, thin=True)),
                      ("flatness", dict(shiny, thin=True))):
        yield cdl("disney", key, 0.9, **more)


def khr_cases():
    yield khr("specular", "specularFactor", 0.9, "A", DULL)
    yield khr("specular", "specularColorFactor", TINT, "RGB", DULL)
    yield khr("clearcoat", "clearcoatFactor", 0.9, "R")
    yield khr("clearcoat", "clearcoatRoughnessFactor", 0.9, "G", DULL, clearcoatFactor=1)
    yield khr("sheen", "sheenColorFactor", TINT, "RGB", sheenRoughnessFactor=0.4)
    yield khr("sheen", "sheenRoughnessFactor", 0.9, "A", sheenColorFactor=[0.9, 0.5, 0.7])
    yield khr("iridescence", "iridescenceFactor", 0.9, "R", METAL)
    yield khr("transmission", "transmissionFactor", 0.9, "R")
    yield khr("transmission", "transmissionFactor", 0.9, "R", more={"volume": {
        "thicknessFactor": 1}})
    yield khr("diffuse_transmission", "diffuseTransmissionFactor", 0.9, "A")
    yield khr("diffuse_transmission", "diffuseTransmissionColorFactor", TINT, "RGB",
              diffuseTransmissionFactor=0.9)
    yield khr("retroreflection", "retroreflectionFactor", 0.9, "R", METAL)
    # The base's own parameters once there are layers over it.
    layered = layers(clearcoat={"clearcoatFactor": 0.2})
    pbr = ("pbrMetallicRoughness",)
    for name, key, factor, channels, texture in (
            ("base colour", "baseColorFactor", TINT + [1], "RGB", "baseColorTexture"),
            ("metallic", "metallicFactor", 0.9, "B", "metallicRoughnessTexture"),
            ("roughness", "roughnessFactor", 0.9, "G", "metallicRoughnessTexture")):
        plain = {"baseColorFactor": [0.8, 0.4, 0.2, 1], "roughnessFactor": 0.4,
                 "metallicFactor": 0.0}
        for over in ({}, layered):
            yield Case("glTF's " + name, pbr, key, factor, channels,
                       dict(over, pbrMetallicRoughness=plain), texture)


def special_cases():
    """Name, material without the texture, where it goes, its texels, and the two materials that do
    without it."""
    film = dict(METAL, **layers(iridescence={
        "iridescenceFactor": 1, "iridescenceThicknessMinimum": 150,
        "iridescenceThicknessMaximum": 550}))

    def thick(value):
        return dict(METAL, **layers(iridescence={"iridescenceFactor": 1,
                                                 "iridescenceThicknessMaximum": value}))
    yield ("a film's thickness", film, ("iridescence", "iridescenceThicknessTexture"),
           [(OTHER, code, OTHER) for code in CODES], [thick(150 + 400 * c / 255) for c in CODES])
    # Red and green are the direction, blue the strength; the rotation turns the direction.
    texels = [(255, 128, 204), (60, 230, 51)]

    def brushed(strength, rotation):
        return dict(METAL, **layers(anisotropy={"anisotropyStrength": strength,
                                                "anisotropyRotation": float(rotation)}))
    angles = [np.arctan2(2 * g / 255 - 1, 2 * r / 255 - 1) for r, g, _ in texels]
    yield ("the direction of anisotropy", brushed(0.9, 0.6), ("anisotropy", "anisotropyTexture"),
           texels, [brushed(0.9 * t[2] / 255, 0.6 + a) for t, a in zip(texels, angles)])


def opaque(texels):
    return np.array([[tuple(t) + (255,) for t in texels]], np.uint8)


class Comparison:
    """Three scenes alike: with textures, with their values, and with factors alone."""

    def __init__(self, columns, rows):
        self.scenes, self.names = [Cells(columns, rows) for _ in range(3)], []
        for s in self.scenes:
            s.sun(40, 3.0, up=0.3)
            s.environment(image=front_and_back((1, 0.5, 0.2), (0.3, 1, 2)))

    def add(self, name, textured, halves, plain):
        """The materials' descriptions; textured is a function of the scene."""
        whole = quad((0, 0, 0), (0.9, 0, 0), (0, 0.9, 0))
        a, b, c = self.scenes
        turned = tilted(25)
        a.show(whole, a.material(**textured(a)), turned)
        b.next()
        for x, half in zip((-0.45, 0.45), halves):
            b.put(quad((x, 0, 0), (0.45, 0, 0), (0, 0.9, 0)), b.material(**half), turned)
        c.show(whole, c.material(**plain), turned)
        self.names.append(name)

    def judge(self):
        pictures = [s.render(64) for s in self.scenes]
        for i, name in enumerate(self.names):
            means = np.array([[p.rgb[self.scenes[0].region(i, left, left + 0.5)].mean(0)
                               for left in (0, 0.5)] for p in pictures])
            textured, by_hand, plain = means
            off = np.abs(textured / by_hand - 1).max()
            check("a texture on " + name, off < 1e-5, "%s instead of %s" % (textured, by_hand))
            halves = np.abs(textured[0] / textured[1] - 1).max()
            effect = np.abs(textured / plain - 1).max(1).min()
            check("halves differ: " + name, halves > 2e-4, "by %g" % halves)
            check("a difference by " + name, effect > 2e-4, "of %g" % effect)


def compare(cases, columns, rows):
    comparison = Comparison(columns, rows)
    for case in cases:
        def textured(scene, case=case):
            return case.material(case.factor, scene.texture(case.texels(), nearest=True))
        comparison.add(case.name, textured, [case.material(v) for v in case.values()],
                       case.material(case.factor))
    return comparison


def test_cdl_textures():
    compare(cdl_cases(), 6, 5).judge()


def test_khr_textures():
    comparison = compare(khr_cases(), 6, 4)
    for name, material, (extension, key), texels, halves in special_cases():
        def textured(scene, material=material, extension=extension, key=key, texels=texels):
            copy = _copy(material)
            copy["extensions"]["KHR_materials_" + extension][key] = scene.texture(
                opaque(texels), nearest=True)
            return copy
        comparison.add(name, textured, halves, material)
    comparison.judge()


if __name__ == "__main__":
    main(test_cdl_textures, test_khr_textures)
