#!/usr/bin/env python3
"""What counts as an event on a path, and surfaces that a path may go straight through.

Closed rooms in which every point is alike have a closed form at every depth, and holes in an
opaque sheet dim a plane by their share alone, whether a path, a shadow ray or a light sample
meets them. Power: a third of 0.3 % to 1 % (as said there) in three standard errors."""
import numpy as np

from support.optics import fresnel_dielectric, polygon_irradiance
from support.render import render
from support.scene import Scene
from support.shapes import box, inside_out, look_at, move, quad, sphere
from support.verdict import agrees, check, main, near


def room(material, extra=None):
    s = Scene()
    s.use_every_feature()
    s.add(inside_out(sphere(1)), material(s))
    if extra:
        extra(s)
    s.camera(look_at((0, 0, 0), (1, 0.3, -0.2)), yfov=60)
    s.environment(radiance=0)
    return s


def test_depth_counts_events():
    """A sphere of albedo 0.5 that glows at 0.5: each event adds half of the one before."""
    s = room(lambda s: s.diffuse(0.5, emission=0.5))
    for depth, want in ((0, 0.5), (1, 0.75), (2, 0.875), (5, 0.984375), (7, 0.99609375)):
        agrees("%d events" % depth, render(s, (16, 16), 256, depth), want)


def test_boundaries_are_no_events():
    def shells(s):
        for radius in (0.9, 0.8, 0.7):
            s.add(sphere(radius, columns=16, rows=8), s.interface({"absorption": [0, 0, 0]}))
    s = room(lambda s: s.diffuse(0.5, emission=0.5), shells)
    for depth, want in ((0, 0.5), (2, 0.875)):
        agrees("%d events behind three boundaries" % depth, render(s, (16, 16), 256, depth), want)


def test_mirrors_and_glass_are_events():
    s = Scene()
    s.use_every_feature()
    s.environment(radiance=2)
    s.add(quad((-0.5, 0, 0), (0.5, 0, 0), (0, 1, 0)), s.material({"model": "mirror"}))
    s.add(box((0, -1, -0.1), (1, 1, 0)), s.material({"model": "dielectric", "ior": 1.5}))
    s.camera(look_at((0, 0, 5), (0, 0, 0)), half_height=0.5)
    f = float(fresnel_dielectric(1.0, 1.5))
    # Through the plate: reflected once; in and out; in, back and out in front; and so on.
    glass = {0: 0, 1: f, 2: f + (1 - f) ** 2, 3: f + (1 - f) ** 2 * (1 + f)}
    for depth, want in glass.items():
        picture = render(s, (16, 16), 256, depth)
        left = np.zeros((16, 16), bool)
        left[:, :8] = True
        near("a mirror at %d events" % depth, picture.rgb[left], 2.0 if depth else 0.0, 1e-5)
        agrees("a plate of glass at %d events" % depth, picture, 2 * want, 0.06 if depth == 1
               else 0.003, region=~left)


def test_roulette_is_unbiased():
    """Dark walls, from which few paths come back: red is nearly black, blue nearly white."""
    albedo = np.array((0.05, 0.5, 0.8))
    s = room(lambda s: s.diffuse(list(albedo), emission=list(1 - albedo)))
    agrees("walls of three albedos", render(s, (32, 32), 512, 1000), 1)


# --- Alpha: a sheet above a plane, half of it away.

def stripes(share):
    """A texture of 16 columns whose alpha is 255 in this share of them, and 0 in the others."""
    pixels = np.full((1, 16, 4), 255, np.uint8)
    pixels[:, int(16 * share):, 3] = 0
    return pixels


def black(scene, kind, share, unlit=False, **members):
    """A material that is there by `share` alone and reflects nothing: glTF's of index 1 (but for
    grazing light), or an unlit one."""
    pbr = {"metallicFactor": 0, "roughnessFactor": 1}
    if kind == "mask":
        pbr["baseColorTexture"] = scene.texture(stripes(share), nearest=True)
    extensions = {"KHR_materials_unlit": {}} if unlit else {"KHR_materials_ior": {"ior": 1.0}}
    return scene.material(base=(0, 0, 0, 1 if kind == "mask" else share), alphaMode=kind.upper(),
                          pbrMetallicRoughness=pbr, extensions=extensions, **members)


def covered(kind, share, plane, unlit=False):
    """A plane below a black sheet so wide and low that it covers the sky, with stripes that
    repeat every 2 cm; cameras 0 below and 1 above the sheet show 20 of them."""
    s = Scene()
    s.use_every_feature()
    s.add(quad((0, 0, 0), (0, 0, 12), (12, 0, 0)), plane(s))
    sheet = quad((0, 0.05, 0), (0, 0, 10), (10, 0, 0))
    sheet["uv0"] = sheet["uv0"] * 1000
    s.add(sheet, black(s, kind, share, unlit))
    for height in (0.02, 3):
        s.camera(look_at((0, height, 0), (0, 0, 0), up=(0, 0, 1)), half_height=0.2)
    return s


def test_holes_in_shadow():
    """A sheet of which a share is there dims a plane by that share, for light from the sky and from
    lamps, and at the last event of a path as well."""
    sun = np.array((0.3, 1, 0.1))
    for kind in ("mask", "blend"):
        for depth, unlit in ((1, False), (3, True)):
            s = covered(kind, 0.25, lambda s: s.diffuse(0.5), unlit)
            s.environment(radiance=1)
            agrees("a sky under a sheet with %s at depth %d" % (kind, depth),
                   render(s, (32, 32), 512, depth), 0.5 * 0.75, 0.004)
            s.environment(radiance=0)
            s.light("directional", np.pi, look_at(sun, (0, 0, 0)))
            agrees("a distant light under a sheet with %s at depth %d" % (kind, depth),
                   render(s, (32, 32), 512, depth), 0.5 * 0.75 / np.linalg.norm(sun), 0.004)


def test_holes_before_the_camera():
    """Seen through: the share that is away shows what is behind."""
    for kind in ("mask", "blend"):
        s = covered(kind, 0.25, lambda s: s.emitter((1, 2, 4)))
        s.environment(radiance=0)
        for depth in (0, 2):
            picture = render(s, (16, 16), 256, depth, options=("--camera", "1"))
            agrees("through a sheet with %s at depth %d" % (kind, depth), picture,
                   0.75 * np.array((1, 2, 4)), 0.006)


def test_lamps_with_holes():
    """A lamp of which a share is there gives that share of its light, however it is found."""
    lamp = quad((0, 1.5, 0), (0.5, 0, 0), (0, 0, 0.5))
    for kind in ("mask", "blend"):
        s = Scene()
        s.use_every_feature()
        s.environment(radiance=0)
        s.add(quad((0, 0, 0), (0, 0, 5), (5, 0, 0)), s.diffuse(0.8))
        s.add(dict(lamp, uv0=lamp["uv0"] * 40), black(s, kind, 0.25, emission=8))
        s.camera(look_at((0, 0.5, 0), (0, 0, 0), up=(0, 0, 1)), half_height=0.01)
        point, normal = np.zeros((1, 3)), np.array([[0.0, 1, 0]])
        p = lamp["positions"]
        whole = polygon_irradiance(point, normal, [[p[0], p[2], p[3], p[1]]])[0]
        picture = render(s, (32, 32), 1280, 1)
        agrees("a lamp with %s" % kind, picture, 8 * 0.25 * whole * 0.8 / np.pi, 0.005)


def test_every_sheet_counts():
    """Ten half transparent sheets behind each other; all of them one material and mesh."""
    s = Scene()
    s.use_every_feature()
    s.environment(radiance=1)
    mesh = s.mesh(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), black(s, "blend", 0.1))
    for i in range(10):
        s.node(move(0, 0, -0.1 * i), mesh=mesh)
    s.camera(look_at((0, 0, 2), (0, 0, 0)), half_height=0.5)
    picture = render(s, (32, 32), 256, 0)
    agrees("ten sheets of opacity 0.1", picture, 0.9 ** 10, 0.006)
    check("no bad samples", picture.stats["bad_samples"] == 0)


if __name__ == "__main__":
    main(test_depth_counts_events, test_boundaries_are_no_events, test_mirrors_and_glass_are_events,
         test_roulette_is_unbiased, test_holes_in_shadow, test_holes_before_the_camera,
         test_lamps_with_holes, test_every_sheet_counts)
