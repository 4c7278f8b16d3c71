"""Small scenes that between them reach every kernel, for tests that ask for equal bits."""
import numpy as np

from .scene import CLAMP, MIRROR, REPEAT, Scene
from .shapes import box, look_at, move, quad, scale, sphere, turn
from .vdb import vdb_uri


def _codes(seed, shape=(8, 8, 4), alpha=None):
    codes = np.random.default_rng(seed).integers(0, 256, shape).astype(np.uint8)
    if alpha is not None:
        codes[..., 3] = alpha
    return codes


def _glossy(s):
    """Microfacets of all kinds, and glTF's own model with all its textures."""
    metal = dict(model="conductor", metal="Au")
    textured = s.material(
        base=(0.9, 0.8, 0.7), metallic=0.6, roughness=0.7,
        pbrMetallicRoughness={
            "baseColorTexture": s.texture(_codes(1), (REPEAT, MIRROR)),
            "metallicRoughnessTexture": s.texture(_codes(2), uv=1)},
        normalTexture=s.texture(_codes(3) // 4 + 160, scale=0.7),
        emission=(0.2, 0.1, 0), emissiveTexture=s.texture(_codes(4), (CLAMP, CLAMP), nearest=True))
    return [
        s.material(metal), s.material(dict(metal, alpha=0.2)),
        s.material(dict(metal, metal="Cu", alpha=0.3, distribution="beckmann")),
        s.material(dict(metal, metal="Ag", alpha=0.4, masking="separable")),
        s.material(dict(metal, metal="Al", alpha=0.1, distribution="beckmann",
                        masking="separable")),
        s.material({"model": "retroreflector", "alpha": 0.1}), textured,
        s.material(base=(0.9, 0.2, 0.1), metallic=1, roughness=0.3),
        s.material(base=(0.5, 0.9, 0.5, 1), metallic=0, roughness=0.5, alphaMode="MASK",
                   pbrMetallicRoughness={"baseColorTexture": s.texture(_codes(6))}),
        s.material(base=(0.9, 0.9, 0.2, 0.5), metallic=0, roughness=0.8, alphaMode="BLEND",
                   doubleSided=True)]


def _models(s):
    """The models that CDL_material adds, and energy given back."""
    red = [0.8, 0.3, 0.2]
    glass = {"model": "dielectric", "ior": 1.5}
    disney = {"model": "disney", "baseColor": red}
    under = {"model": "subsurface", "albedo": red, "radius": [0.1, 0.05, 0.02], "g": 0.3}
    return [
        s.material({"model": "oren_nayar", "reflectance": red, "roughness": 0.7}),
        s.material({"model": "plastic", "reflectance": red, "alpha": 0.1}),
        s.material(dict(disney, roughness=0.4, clearcoat=1, sheen=1, subsurface=0.5)),
        s.material(dict(disney, specTrans=0.8, roughness=0.3)),
        s.material(dict(disney, thin=True, diffTrans=1, specTrans=0.3)),
        s.material(dict(glass, alpha=0.2), {"absorption": [2, 1, 0.5]}),
        s.material(dict(glass, alpha=[0.1, 0.3], distribution="beckmann", thin=True)),
        s.material(dict(glass, abbe=20)), s.material(dict(glass, abbe=20, alpha=0.05)),
        s.material(dict(glass, alpha=0.5, energyCompensation=True)),
        s.material({"model": "conductor", "metal": "Ag", "alpha": [0.5, 0.2],
                    "energyCompensation": True}),
        s.material(dict(under, method="random_walk")),
        s.material(dict(under, method="diffusion", alpha=0)),
        s.material(dict(under, method="dipole", albedoTexture=s.texture(_codes(9)),
                        radiusTexture=s.texture(_codes(10))))]


def _layers(s):
    """glTF's layers."""
    def layered(roughness=0.4, **extensions):
        return s.material(base=(0.8, 0.5, 0.3), metallic=0.2, roughness=roughness, extensions={
            "KHR_materials_" + name: value for name, value in extensions.items()})

    through = {"transmissionFactor": 0.9}
    volume = {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [0.5, 0.8, 1]}
    return [
        layered(clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1,
                           "clearcoatNormalTexture": s.texture(_codes(8) // 4 + 160)},
                sheen={"sheenColorFactor": [0.2, 0.5, 0.9], "sheenRoughnessFactor": 0.4}),
        layered(iridescence={"iridescenceFactor": 1}, specular={"specularFactor": 0.7}),
        layered(anisotropy={"anisotropyStrength": 0.8, "anisotropyRotation": 0.7}),
        layered(transmission=through), layered(transmission=through, volume=volume),
        layered(0.1, transmission=through, volume=volume, dispersion={"dispersion": 3}),
        layered(diffuse_transmission={"diffuseTransmissionFactor": 0.6}),
        layered(retroreflection={"retroreflectionFactor": 0.7})]


def _others(s):
    """All the rest: what is smooth or ideal, holes, and media."""
    glass = {"model": "dielectric", "ior": 1.5}
    sixteen = s.texture(_codes(5).astype(np.uint16) * 257, transform={
        "offset": [0.2, 0.1], "rotation": 0.5, "scale": [2, 3]})
    leaf = {"pbrMetallicRoughness": {"baseColorTexture": s.texture(_codes(7))}}
    unlit = {"KHR_materials_unlit": {}}
    return [
        s.diffuse((0.7, 0.4, 0.2), normalTexture=s.texture(_codes(3) // 4 + 160)),
        s.material({"model": "mirror", "reflectance": [0.9, 0.8, 0.9]}),
        s.material(glass), s.material(glass, {"absorption": [0.5, 2, 4]}),
        s.unlit((0.3, 0.6, 0.9, 1), sixteen),
        s.material(extensions=dict(unlit), alphaMode="MASK", alphaCutoff=0.4, **leaf),
        s.material(extensions=dict(unlit), alphaMode="BLEND", **leaf),
        s.diffuse(0.2, emission=(0.2, 0.1, 0), emissiveTexture=s.texture(_codes(4), nearest=True)),
        s.interface({"scattering": [4, 6, 9], "absorption": [0.5, 0.2, 0.1],
                     "phase": {"type": "hg", "g": 0.6}}),
        s.interface({"absorption": [0, 1, 1], "emission": [0.5, 0.3, 0.1]})]


def _body(number):
    """A ball, smooth or not, with all attributes."""
    shape = sphere(0.32, (0, 0, 0), 12, 6, smooth=number % 2 == 0)
    p = shape["positions"]
    shape["uv0"] = p[:, :2] * 3
    shape["uv1"] = p[:, 1:] * 2 + 0.3
    shape["colors"] = np.concatenate([0.5 + p, np.ones((len(p), 1))], 1)
    return shape


def _stage(materials):
    """Bodies of these materials, all kinds of lights, instances, a lens, an environment."""
    s = Scene()
    for number, material in enumerate(materials(s)):
        x, z = number % 6 - 2.5, 1 - number // 6
        place = move(0.75 * x, 0.35, 0.9 * z) @ turn((1, 2, 3), 40 * number)
        s.add(_body(number), material, place @ scale(1 if number % 3 else -1, 1, 1))
    mesh = s.mesh(box((-0.1, 0, -0.1), (0.1, 0.2, 0.1)), s.diffuse((0.2, 0.7, 0.3)))
    for x in (-1, 0, 1):
        s.node(move(x, 0, 1.6) @ turn((0, 1, 0), 30 * x) @ scale(1 + 0.3 * x, 1, -1), mesh=mesh)
    s.add(quad((0, 0, 0), (0, 0, 3), (3, 0, 0)), s.diffuse((0.6, 0.6, 0.6)))
    s.add(quad((0.5, 2.5, 0), (0.4, 0, 0), (0, 0, 0.3)), s.emitter((9, 8, 6)))
    s.light("point", (2, 1, 1), move(-1, 1.5, 1))
    s.light("spot", (8, 9, 9), look_at((2, 2, 2), (0, 0, 0)),
            spot={"innerConeAngle": 0.1, "outerConeAngle": 0.5}, range=6.0)
    s.light("directional", (0.5, 0.4, 0.3), look_at((1, 2, -1), (0, 0, 0)))
    sky = np.random.default_rng(9).uniform(0, 0.6, (8, 16, 3))
    sky[2, 5] = 40
    s.environment(image=sky, rotation=30)
    s.camera(look_at((1, 2.2, 4.5), (0, 0.2, 0.1)), yfov=45, aspect=1.5, apertureRadius=0.03,
             focusDistance=4.6, blades=6)
    return s


def everything():
    return _stage(lambda s: _glossy(s) + _others(s))


def layers():
    """All models that `everything` has not."""
    return _stage(lambda s: _models(s) + _layers(s))


def without_gloss():
    """Everything but microfacets, which Mesa takes a minute or two to compile."""
    return _stage(_others)


def _smoke(s):
    """Smoke in a grid of several blocks, tinted, that is denser in some and missing in others, and
    glows by its temperature; in a turned and mirrored node, and again in a smaller one."""
    random, size = np.random.default_rng(12), (20, 12, 12)
    dense = random.random(size) * np.linspace(0.1, 1, size[0])[:, None, None] ** 2
    dense[8:12, :, :6] = 0
    smoke = s.interface({
        "scattering": [6, 8, 9], "absorption": [2, 1, 0.5], "emission": [0.2, 0.3, 0.4],
        "phase": {"type": "hg", "g": 0.5},
        "grid": {"uri": vdb_uri({"density": dense, "color": random.random(size + (3,)),
                                 "temperature": 0.4 + random.random(size)}, 0.05),
                 "density": "density", "color": "color", "temperature": "temperature",
                 "temperatureScale": 1500}})
    around = box((-0.026, -0.026, -0.026), (0.976, 0.576, 0.576))
    turned = turn((1, 2, 3), 40)
    s.add(around, smoke, move(0.2, 0.5, 0.3) @ turned @ scale(1, -1, 1.2))
    s.add(around, smoke, move(-1.4, -0.8, 0.9) @ turned @ scale(0.5, 0.5, 0.7))


def fog():
    """A scene's medium, balls of media in it that overlap and nest, smoke in a grid, glass, no
    texture anywhere."""
    s = Scene()
    s.medium(scattering=[0.1, 0.12, 0.15], absorption=[0.02, 0.01, 0.01],
             phase={"type": "hg", "g": -0.3})
    s.add(quad((0, -1, 0), (0, 0, 4), (4, 0, 0)), s.diffuse((0.5, 0.5, 0.6)))
    cloud = s.interface({"scattering": [3, 2, 1], "phase": {"type": "droplets", "diameter": 12}})
    s.add(sphere(0.8, (-0.5, 0, 0), 12, 6), cloud)
    s.add(sphere(0.6, (0.3, 0.1, 0.2), 12, 6),
          s.interface({"absorption": [0.3, 1, 2], "scattering": 0.5,
                       "phase": {"type": "rayleigh"}}))
    s.add(sphere(0.3, (-0.6, 0, 0), 12, 6), s.interface())
    s.add(sphere(0.5, (1.2, -0.4, 0.5), 12, 6, smooth=True),
          s.material({"model": "dielectric", "ior": 1.33}, {"absorption": [1, 0.3, 0.1]}))
    _smoke(s)
    s.light("spot", (30, 25, 20), look_at((-2, 3, 2), (0, 0, 0)), spot={})
    s.add(quad((2, 2, -1), (0.3, 0, 0), (0, 0, 0.3)), s.emitter((20, 20, 25)))
    s.environment(radiance=0)
    s.camera(look_at((0.5, 0.6, 4), (0, 0, 0)), yfov=40, aspect=1.5)
    return s


def plain():
    """A room of three colours with a lamp: the least of kernels."""
    s = Scene()
    s.add(quad((0, -1, 0), (0, 0, 1), (1, 0, 0)), s.diffuse(0.7))
    s.add(quad((-1, 0, 0), (0, 1, 0), (0, 0, 1)), s.diffuse((0.8, 0.2, 0.2)))
    s.add(quad((0, 0, -1), (1, 0, 0), (0, 1, 0)), s.diffuse((0.3, 0.8, 0.4)))
    s.add(box((-0.4, -1, -0.5), (0.1, -0.2, 0.1)), s.diffuse((0.4, 0.5, 0.9)))
    s.add(quad((0, 0.99, 0), (0.3, 0, 0), (0, 0, 0.3)), s.emitter((12, 10, 7)))
    s.environment(radiance=0)
    s.camera(look_at((0.6, 0.3, 3.2), (0, -0.1, 0)), yfov=40, aspect=1.5)
    return s
