#!/usr/bin/env python3
"""Textures, texture coordinates and vertex colours on squares that fill the picture, against
values worked out here from the glTF specification.

An unlit square has no noise but that of where in the pixel a sample falls. Where a pixel lies in
one texel the value is asked for to 1e-6; where texels blend, to what 64 stratified samples a
pixel leave (0.01)."""
import numpy as np

from support.render import render
from support.scene import CLAMP, MIRROR, REPEAT, Scene
from support.shapes import look_at, move, quad, scale, turn
from support.verdict import agrees, check, main, near

RANDOM = np.random.default_rng(11)
CODES = RANDOM.integers(0, 256, (8, 8, 4)).astype(np.uint8)
CODES[..., 3] = 255


def decoded(codes):
    """Linear values of sRGB codes of 8 or 16 bits (IEC 61966-2-1)."""
    x = np.asarray(codes, float) / np.iinfo(codes.dtype).max
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def screen(scene, shape, material):
    """Fills the picture with a square of two by two units seen straight from the front."""
    scene.use_every_feature(at=(30, 40, -20))
    scene.environment(radiance=0)
    scene.add(shape, material)
    scene.camera(look_at((0, 0, 3), (0, 0, 0)), half_height=1)
    return scene


def square(uv=lambda s, t: (s, t)):
    """The square; its texture coordinates are functions of those from the top left corner."""
    shape = quad((0, 0, 0), (1, 0, 0), (0, 1, 0))
    shape["uv0"] = np.stack(uv(shape["uv0"][:, 0], shape["uv0"][:, 1]), 1)
    return shape


def coordinates(pixels, across=8):
    """s, t in [0, 1] of across x across points in each pixel, from the top left."""
    at = (np.arange(pixels * across) + 0.5) / (pixels * across)
    return np.meshgrid(at, at)


def wrapped(index, size, mode):
    if mode == REPEAT:
        return index % size
    if mode == CLAMP:
        return np.clip(index, 0, size - 1)
    period = index % (2 * size)
    return np.where(period < size, period, 2 * size - 1 - period)


def looked_up(values, s, t, wrap=(REPEAT, REPEAT), nearest=False):
    height, width = values.shape[:2]
    x, y = s * width - (0 if nearest else 0.5), t * height - (0 if nearest else 0.5)
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = ((0 * x if nearest else x - i)[..., None], (0 * y if nearest else y - j)[..., None])

    def texel(p, q):
        return values[wrapped(q, height, wrap[1]), wrapped(p, width, wrap[0])]
    return ((1 - b) * ((1 - a) * texel(i, j) + a * texel(i + 1, j)) +
            b * ((1 - a) * texel(i, j + 1) + a * texel(i + 1, j + 1)))


def averaged(values, pixels):
    return values.reshape(pixels, -1, pixels, values.shape[0] // pixels, 3).mean((1, 3))


def test_texels():
    """Each texel where it belongs: row 0 at the top, decoded from sRGB; 8 and 16 bits."""
    for kind, codes in (("8", CODES), ("16", CODES.astype(np.uint16) * 251 + 17)):
        s = Scene()
        screen(s, square(), s.unlit(texture=s.texture(codes, nearest=True)))
        want = decoded(codes[..., :3]).repeat(2, 0).repeat(2, 1)
        near("texels of %s bits" % kind, render(s, (16, 16), 4, 0).rgb, want, 1e-6)
    s = Scene()
    screen(s, square(), s.unlit((0.5, 0.25, 0.125, 1), s.texture(CODES, nearest=True)))
    near("texels by a factor", render(s, (8, 8), 4, 0).rgb,
         decoded(CODES[..., :3]) * (0.5, 0.25, 0.125), 1e-6)


def test_wrapping():
    """Three rounds of the texture each way, in all modes, blended and nearest."""
    s, t = coordinates(48)
    s, t = 3 * s - 1.25, 3 * t - 0.75
    for wrap in ((REPEAT, MIRROR), (MIRROR, CLAMP), (CLAMP, REPEAT)):
        for nearest in (False, True):
            scene = Scene()
            info = scene.texture(CODES, wrap, nearest)
            screen(scene, square(lambda u, v: (3 * u - 1.25, 3 * v - 0.75)),
                   scene.unlit(texture=info))
            picture = render(scene, (48, 48), 64, 0)
            # The renderer blends what it has decoded.
            want = averaged(looked_up(decoded(CODES[..., :3]), s, t, wrap, nearest), 48)
            name = "wrap %s, %s" % (wrap, "nearest" if nearest else "blended")
            near(name, picture.rgb, want, 0.02)


def test_transform():
    """KHR_texture_transform: the example of its specification (the lower left quadrant, turned),
    and offset, rotation and scale together."""
    corners = np.zeros((2, 2, 4), np.uint8)
    corners[..., 3], corners[1, 0, 0] = 255, 255
    example = {"offset": [0, 1], "rotation": float(np.pi / 2), "scale": [0.5, 0.5]}
    s = Scene()
    screen(s, square(), s.unlit(texture=s.texture(corners, nearest=True, transform=example)))
    near("the specification's example", render(s, (8, 8), 4, 0).rgb[..., 0], 1, 1e-6)
    # Turned counter-clockwise in texture space, whose second axis points down.
    u, v = coordinates(48)
    angle, offset, factor = 0.4, (0.3, -0.2), (1.5, 0.75)
    c, d = np.cos(angle), np.sin(angle)
    moved = (c * factor[0] * u + d * factor[1] * v + offset[0],
             -d * factor[0] * u + c * factor[1] * v + offset[1])
    transform = {"offset": list(offset), "rotation": angle, "scale": list(factor)}
    s = Scene()
    screen(s, square(), s.unlit(texture=s.texture(CODES, transform=transform)))
    want = averaged(looked_up(decoded(CODES[..., :3]), *moved), 48)
    near("offset, rotation and scale", render(s, (48, 48), 64, 0).rgb, want, 0.02)


def test_second_coordinates():
    for how in ("texCoord", "KHR_texture_transform"):
        s, shape = Scene(), square()
        shape["uv1"] = shape["uv0"][:, ::-1].copy()
        if how == "texCoord":
            info = s.texture(CODES, nearest=True, uv=1)
        else:
            info = s.texture(CODES, nearest=True, transform={"texCoord": 1})
        screen(s, shape, s.unlit(texture=info))
        want = decoded(CODES[..., :3]).swapaxes(0, 1)
        near("TEXCOORD_1 by %s" % how, render(s, (8, 8), 4, 0).rgb, want, 1e-6)


def test_vertex_colors():
    """They blend linearly and multiply base colour and texture; opacity too."""
    shape = square()
    s, t = shape["uv0"].T
    shape["colors"] = np.stack([s, t, (1 - s) * 0.5, 0 * s + 1], 1)
    u, v = coordinates(32)
    want = averaged(np.stack([u, v, (1 - u) * 0.5], -1), 32)
    scene = Scene()
    screen(scene, shape, scene.unlit((0.5, 1, 1, 1)))
    near("vertex colours", render(scene, (32, 32), 64, 0).rgb, want * (0.5, 1, 1), 0.005)
    scene = Scene()
    screen(scene, shape, scene.unlit(texture=scene.texture(CODES, nearest=True)))
    picture = render(scene, (32, 32), 64, 0)
    near("vertex colours by texels", picture.rgb,
         want * decoded(CODES[..., :3]).repeat(4, 0).repeat(4, 1), 0.005)
    shape["colors"][:, 3] = t
    scene = Scene()
    screen(scene, shape, scene.unlit(alphaMode="MASK", alphaCutoff=0.5))
    picture = render(scene, (32, 32), 64, 0)
    near("below a vertex opacity of 0.5", picture.rgb[:15], 0, 0)
    near("and above", picture.rgb[17:], want[17:], 0.005)
    scene = Scene()
    screen(scene, shape, scene.diffuse((0.2, 0.4, 0.8)))
    scene.environment(radiance=1)
    near("CDL_material takes no vertex colours", render(scene, (8, 8), 16, 1, aov="albedo").layer(
        "albedo", "RGB"), np.broadcast_to((0.2, 0.4, 0.8), (8, 8, 3)), 1e-6)


def test_alpha_cutoff():
    """Opacity at the cutoff is whole, one code below it is a hole; code 128 is 0.50196."""
    codes = np.full((1, 4, 4), 255, np.uint8)
    codes[0, :, 3] = (127, 128, 0, 255)
    for cutoff, seen in ((0.5, (0, 1, 0, 1)), (128 / 255, (0, 1, 0, 1)), (0.503, (0, 0, 0, 1))):
        s = Scene()
        screen(s, square(), s.unlit(texture=s.texture(codes, nearest=True), alphaMode="MASK",
                                    alphaCutoff=cutoff))
        near("cutoff %.3f" % cutoff, render(s, (8, 8), 4, 0).rgb[4, ::2, 1], seen, 1e-6)
    s = Scene()
    screen(s, square(), s.unlit(texture=s.texture(codes, nearest=True)))
    near("alpha means nothing where it is opaque", render(s, (8, 8), 4, 0).rgb, 1, 1e-6)


def test_data_textures():
    """Metallic and roughness are data, not colours: as a texture they are what they are as
    factors."""
    codes = np.zeros((1, 1, 4), np.uint8)
    codes[0, 0] = (13, 128, 51, 255)  # green: roughness, blue: metallic
    films = []
    for textured in (True, False):
        s = Scene()
        if textured:
            pbr = {"metallicRoughnessTexture": s.texture(codes)}
            material = s.material(base=(0.9, 0.6, 0.3), pbrMetallicRoughness=pbr)
        else:
            material = s.material(base=(0.9, 0.6, 0.3), metallic=51 / 255, roughness=128 / 255)
        screen(s, square(), material)
        s.environment(radiance=1)
        s.light("directional", 2, look_at((1, 1, 2), (0, 0, 0)))
        films.append(render(s, (16, 16), 16, 2).rgb)
    near("metallic and roughness from a texture", films[0], films[1], 1e-5)
    films = []
    for textured in (True, False):
        s = Scene()
        cdl = {"model": "conductor", "metal": "Cu", "alpha": 0.4 if textured else 0.4 * 128 / 255}
        if textured:
            cdl["alphaTexture"] = s.texture(np.full((1, 1, 4), 128, np.uint8))
        screen(s, square(), s.material(cdl))
        s.environment(radiance=1)
        films.append(render(s, (16, 16), 64, 2).rgb)
    near("alpha from a texture", films[0], films[1], 1e-4)


def test_emissive_texture():
    s = Scene()
    material = s.material(base=0, metallic=0, roughness=1, emission=(4, 2, 1),
                          emissiveTexture=s.texture(CODES, nearest=True))
    screen(s, square(), material)
    near("an emissive texture", render(s, (8, 8), 4, 0).rgb,
         decoded(CODES[..., :3]) * (4, 2, 1), 1e-5)


SUN = np.array((1.0, 2.0, 3.0)) / np.sqrt(14)


def lit(normal_scale, matrix, tangents):
    """Mean of the picture of a white square with a constant normal map under a distant light of
    pi."""
    codes = np.array([[[178, 102, 230]]], np.uint8)
    s, shape = Scene(), square()
    if tangents is not None:  # which count only beside normals
        shape["normals"] = np.broadcast_to((0.0, 0, 1), (4, 3))
        shape["tangents"] = np.broadcast_to(np.asarray(tangents, float), (4, 4))
    info = s.texture(codes, scale=normal_scale)
    white = s.material({"model": "diffuse", "reflectance": [1, 1, 1]}, normalTexture=info)
    s.use_every_feature(at=(30, 40, -20))
    s.environment(radiance=0)
    s.add(shape, white, matrix)
    s.light("directional", np.pi, look_at(SUN, (0, 0, 0)))
    s.camera(look_at(matrix[:3, :3] @ (0, 0, 3), (0, 0, 0), up=(0, 1, 0.1)), half_height=0.2)
    return render(s, (8, 8), 32, 1).rgb.mean()


def test_normal_map():
    """One tilted normal: right is along growing u, up against growing v (glTF 2.0, 3.9.3), by
    tangents from the texture coordinates and given ones, in turned and mirrored nodes."""
    texel = 2 * np.array((178, 102, 230)) / 255 - 1
    cases = [("a normal map", 1.0, np.eye(4), None),
             ("of scale 0.5", 0.5, np.eye(4), None),
             ("with a tangent along -Y", 1.0, np.eye(4), (0, -1, 0, 1)),
             ("with a left-handed tangent", 1.0, np.eye(4), (1, 0, 0, -1)),
             ("in a turned node", 1.0, turn((1, 2, 0.5), 35), None),
             ("in a mirrored node", 1.0, scale(-1, 1, 1), None),
             ("in a mirrored and turned node", 1.0, turn((0, 0, 1), 25) @ scale(1, -1, 1), None)]
    for name, strength, matrix, given in cases:
        tangent = np.array((1.0, 0, 0)) if given is None else np.array(given[:3], float)
        bitangent = np.cross((0, 0, 1), tangent) * (1 if given is None else given[3])
        local = strength * (texel[0] * tangent + texel[1] * bitangent) + (0, 0, texel[2])
        m = matrix[:3, :3]
        world = m @ local  # rotations and mirrors: normals turn as directions do
        want = world @ SUN / np.linalg.norm(world)
        near(name, lit(strength, matrix, given) / want, 1, 2e-3)


def bumps(material, sky=1.0):
    """A picture of a square whose normals point anywhere, up to 70 degrees off, seen aslant."""
    rng = np.random.default_rng(5)
    tilt, turned = np.radians(rng.uniform(0, 70, (16, 16))), rng.uniform(0, 2 * np.pi, (16, 16))
    normals = np.stack([np.sin(tilt) * np.cos(turned), np.sin(tilt) * np.sin(turned),
                        np.cos(tilt), np.ones_like(tilt)], -1)
    s = Scene()
    codes = np.round((normals + 1) / 2 * 255).astype(np.uint8)
    s.add(square(), material(s, s.texture(codes, nearest=True)))
    pane = {"KHR_materials_transmission": {"transmissionFactor": 1}}  # elsewhere, and of no effect
    s.add(quad((0, 0, -9), (0.1, 0, 0), (0, 0.1, 0)),
          s.material(base=(1, 1, 1), metallic=0, roughness=0.5, extensions=pane))
    s.environment(radiance=sky)
    s.camera(look_at((2, 0.5, 1), (0, 0, 0)), half_height=0.2)
    return render(s, (32, 32), 256, 1)


def test_normal_maps_keep_the_light():
    """However steep: white under a sky of 1 is 1 everywhere, for lobes wide and narrow, and by
    light sampling as well as without."""
    def white(s, normals):
        return s.material({"model": "diffuse", "reflectance": [1, 1, 1]}, normalTexture=normals)

    def mirror(s, normals):
        return s.material({"model": "mirror"}, normalTexture=normals)

    def metal(s, normals):  # of an index that reflects all, and what facets lose is given back
        return s.material({"model": "conductor", "eta": 0, "k": 1, "alpha": 0.3,
                           "energyCompensation": True}, normalTexture=normals)

    def layered(s, normals):  # a faint coat over white metal
        return s.material(base=(1, 1, 1), metallic=1, roughness=0.1, normalTexture=normals,
                          extensions={"KHR_materials_iridescence": {"iridescenceFactor": 0.0},
                                      "KHR_materials_clearcoat": {"clearcoatFactor": 0.01}})

    for name, material, loss in (("diffuse", white, 0.002), ("a mirror", mirror, 1e-6),
                                 ("metal", metal, 0.01), ("a layered metal", layered, 0.03)):
        picture = bumps(material)
        mean = picture.rgb.mean()
        check("%s with bumps" % name, 1 - loss < mean < 1.002, "%g" % mean)
        check("%s has no dark fringe" % name, picture.rgb.min() > 0.75, "%g" % picture.rgb.min())


def test_mirrored_instances():
    """A mirrored node shows its normal map alike whether it shares its mesh or not."""
    pictures = []
    for shared in (False, True):
        s = Scene()
        codes = np.array([[[150, 220, 200]]], np.uint8)
        white = s.material({"model": "diffuse", "reflectance": [1, 1, 1]},
                           normalTexture=s.texture(codes))
        mesh = s.mesh(square(), white)
        for matrix in ([scale(1, -1, 1)] + ([move(0, 0, -50)] if shared else [])):
            s.node(matrix, mesh=mesh)
        s.light("directional", (1, 1, 1), look_at(SUN, (0, 0, 0)))
        s.camera(look_at((0, 0, 3), (0, 0, 0)), half_height=0.9)
        pictures.append(render(s, (8, 8), 16, 1).rgb)
    near("mirrored instances", pictures[1] / pictures[0], 1, 1e-4)


def test_anisotropy_of_mirrored_textures():
    """Where the picture lies mirrored the rotation turns the other way, seen from either side."""
    for side in (1, -1):
        pictures = []
        for hand, angle in ((1, 0.6), (-1, -0.6)):
            s = Scene()
            brushed = s.material(base=(1, 1, 1), metallic=1, roughness=0.4, doubleSided=True,
                                 extensions={"KHR_materials_anisotropy": {
                                     "anisotropyStrength": 0.9, "anisotropyRotation": angle}})
            shape = square()
            shape["normals"] = np.broadcast_to((0.0, 0, 1), (4, 3))
            shape["tangents"] = np.broadcast_to((1.0, 0, 0, hand), (4, 4))
            s.add(shape, brushed)
            s.light("directional", (1, 1, 1), look_at((1, 2, 2 * side), (0, 0, 0)))
            s.camera(look_at((0.5, -0.5, 3 * side), (0, 0, 0)), half_height=0.5)
            pictures.append(render(s, (8, 8), 16, 1).rgb)
        near("anisotropy, side %d" % side, pictures[1] / pictures[0], 1, 1e-3)
        if side == 1:
            front = pictures[0].mean()
        else:  # the same grooves seen through the plane: light and view mirrored by it
            near("anisotropy from behind", pictures[0].mean(), front, 1e-3)


def test_normal_map_from_below():
    """Light that a steep facet sees in the mirror of the surface counts as if from there."""
    codes = np.array([[[255, 128, 160]]], np.uint8)
    texel = 2 * np.array((255, 128, 160)) / 255 - 1
    normal = texel / np.linalg.norm(texel)
    sun = np.array((np.sin(1.4), 0, np.cos(1.4)))
    s = Scene()
    white = s.material({"model": "diffuse", "reflectance": [1, 1, 1]},
                       normalTexture=s.texture(codes))
    screen(s, square(), white)
    s.light("directional", (np.pi, np.pi, np.pi), look_at(sun, (0, 0, 0)))
    want = max(normal @ sun, 0) + max(normal @ (sun * (1, 1, -1)), 0)
    near("light from both sides of the plane", render(s, (32, 32), 16, 1).rgb.mean(), want, 2e-3)


if __name__ == "__main__":
    main(test_texels, test_wrapping, test_transform, test_second_coordinates, test_vertex_colors,
         test_alpha_cutoff, test_data_textures, test_emissive_texture, test_normal_map,
         test_normal_maps_keep_the_light, test_mirrored_instances,
         test_anisotropy_of_mirrored_textures, test_normal_map_from_below)
