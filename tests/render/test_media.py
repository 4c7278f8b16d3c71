#!/usr/bin/env python3
"""Homogeneous media against closed forms: Beer and Lambert, single scattering, furnaces,
emission; and which medium a path is in: nested, overlapping and touching ones, with the camera
inside.

Where nothing is scattered there is no noise, and values are asked for to 3e-4 of themselves (a
ray starts a hair beyond each boundary that it crosses); else to 0.3 % with three standard errors
below that."""
import numpy as np

from support.optics import fresnel_dielectric
from support.render import render
from support.scene import Scene
from support.shapes import box, look_at, move, quad, sphere
from support.verdict import agrees, check, main, near

RED, AMBER = (0.3, 0.8, 1.7), (0.05, 0.4, 1.1)


def beer(sigma, length):
    return np.exp(-np.asarray(sigma) * length)


def slab(low, high, half=50):
    """A box so wide that it is a layer between z = low and z = high."""
    return box((-half, -half, low), (half, half, high))


def stage(sky=1.0, sink=(0, 0, -60)):
    s = Scene()
    s.use_every_feature(sink)
    s.environment(radiance=sky)
    return s


def straight(scene, eye=(0, 0, 8), target=(0, 0, 0), size=(4, 4), spp=32, depth=0, **options):
    """Rays that are all parallel, from a camera of their own."""
    scene.camera(look_at(eye, target), half_height=0.01)
    last = len(scene.json["cameras"]) - 1
    return render(scene, size, spp, depth, options=("--camera", str(last)), **options)


def exact(what, picture, want, tolerance=3e-4):
    near(what, picture.rgb / np.maximum(want, 1e-30), 1, tolerance)


def test_absorbing_slab():
    for degrees in (0, 50):
        s, angle = stage((2, 1, 0.5)), np.radians(degrees)
        s.add(slab(-1, 1), s.interface({"absorption": RED, "scale": 0.5}))
        picture = straight(s, (9 * np.sin(angle), 0, 9 * np.cos(angle)))
        exact("an absorbing slab at %d degrees" % degrees, picture,
              (2, 1, 0.5) * beer(RED, 0.5 * 2 / np.cos(angle)))


def test_scale_of_the_node():
    """Cross-sections are per metre of the world, whatever the node's scale."""
    s = stage()
    s.add(slab(-1, 1), s.interface({"absorption": RED}), np.diag([3, -2, 0.5, 1]))
    exact("a slab of a node scaled by 0.5 and mirrored", straight(s), beer(RED, 1))


def test_shadow_through_media():
    """Light through an absorbing and through a scattering slab on its way to a plane, direct
    light alone."""
    for name, medium in (("absorbing", {"absorption": RED}), ("scattering", {"scattering": RED})):
        for kind, color, matrix, want in (
                ("directional", 3, look_at((3, 0, 4), (0, 0, 0)), 3 * 0.8 * beer(RED, 0.7 / 0.8)),
                ("point", 2, move(0, 0, 4), 2 / 16 * beer(RED, 0.7))):
            s = stage(0)
            s.add(quad((0, 0, 0), (0, 5, 0), (-5, 0, 0)), s.diffuse(0.5))
            s.add(slab(1, 1.7), s.interface(medium))
            s.light(kind, color, matrix)
            picture = straight(s, (0, 0, 0.5), depth=1)
            exact("%s light through an %s slab" % (kind, name), picture, want * 0.5 / np.pi)


def test_camera_inside():
    s = stage()
    s.add(slab(-3, 3), s.interface({"absorption": RED}))
    exact("a camera inside a medium", straight(s, (0, 0, 1), (0, 0, 0)), beer(RED, 4))
    s = stage()
    s.add(slab(-3, 3), s.interface({"absorption": RED}))
    s.add(slab(-2, 2), s.interface({"absorption": AMBER}))
    s.add(slab(-1, 1), s.interface())
    exact("a camera inside three nested media", straight(s, (0, 0, 0.5), (0, 0, 0)),
          beer(AMBER, 1) * beer(RED, 1))
    exact("and from outside", straight(s), beer(AMBER, 2) * beer(RED, 2))
    for name, wall in (("diffuse", lambda s, m: s.diffuse(0, emission=1, medium=m)),
                       ("glTF", lambda s, m: s.material(base=0, metallic=0, emission=1, medium=m))):
        s = stage(0)
        s.add(box((-2, -2, -2), (2, 2, 2)), wall(s, {"absorption": RED}))
        s.json["materials"][-1]["doubleSided"] = True
        exact("a camera inside what a closed %s surface holds" % name,
              straight(s, (0, 0, 1), (0, 0, 0)), beer(RED, 3))


def test_wide_cameras():
    """A camera that stands on a boundary knows for every ray on which side it begins."""
    s = stage()
    s.add(box((0, -9, -3), (9, 9, 3)), s.interface({"absorption": RED}))
    s.camera(look_at((0.0001, 0, 1), (0.0001, 0, 0)), half_height=1)
    picture = render(s, (16, 16), 32, 0)
    want = np.ones((16, 16, 3))
    want[:, 8:] = beer(RED, 4)
    exact("half of a camera in a medium", picture, want)


def test_overlapping_media():
    """The one entered last counts; leaving one leaves the other."""
    s = stage()
    s.add(slab(-2, 1), s.interface({"absorption": RED}))
    s.add(slab(-1, 2), s.interface({"absorption": AMBER}))
    # From +Z: AMBER 2 ... 1, then RED until it ends at -2.
    exact("overlapping media from the front", straight(s), beer(AMBER, 1) * beer(RED, 3))
    exact("and from behind", straight(s, (0, 0, -8)), beer(RED, 1) * beer(AMBER, 3))
    s = stage(0)
    s.add(slab(-2, 1), s.interface({"absorption": RED}))
    s.add(slab(-1, 2), s.interface({"absorption": AMBER}))
    s.add(quad((0, 0, -5), (0, 5, 0), (-5, 0, 0)), s.diffuse(1))
    s.light("directional", np.pi, look_at((0, 0, 1), (0, 0, 0)))
    # A shadow ray starts at the plane, so it enters RED first.
    exact("and on a shadow ray", straight(s, (0, 0, -4), (0, 0, -5), depth=1),
          beer(RED, 1) * beer(AMBER, 3))


def test_touching_media():
    """Two slabs that share a face, as two boxes or with a gap of nothing."""
    s = stage()
    s.add(slab(0, 1), s.interface({"absorption": RED}))
    s.add(slab(-1, 0), s.interface({"absorption": AMBER}))
    exact("touching media", straight(s), beer(RED, 1) * beer(AMBER, 1))
    s = stage()
    s.add(slab(-1, 0), s.interface({"absorption": AMBER}))
    s.add(slab(0, 1), s.interface({"absorption": RED}))
    exact("touching media in the other order", straight(s), beer(RED, 1) * beer(AMBER, 1))


def test_medium_of_the_scene():
    """It fills what no closed surface encloses; a closed surface without a medium holds nothing."""
    s = stage(0)
    s.medium(absorption=RED)
    s.add(quad((0, 0, -2), (5, 0, 0), (0, 5, 0)), s.emitter((1, 2, 3)))
    exact("fog between camera and lamp", straight(s, (0, 0, 3)), (1, 2, 3) * beer(RED, 5))
    s.add(box((-3, -3, 0), (3, 3, 2)), s.interface())
    exact("with a box of nothing in it", straight(s, (0, 0, 3)), (1, 2, 3) * beer(RED, 3))
    exact("in which the camera stands", straight(s, (0, 0, 1)), (1, 2, 3) * beer(RED, 2))


def test_glowing_medium():
    """Emission per metre, seen through the medium itself, with and without absorption."""
    for name, absorption in (("absorbing", RED), ("clear", (0, 0, 0))):
        s = stage(0)
        s.add(slab(-1, 1), s.interface({"absorption": absorption, "emission": [0.5, 1, 2]}))
        sigma = np.asarray(absorption)
        length = np.where(sigma > 0, (1 - beer(sigma, 2)) / np.maximum(sigma, 1e-30), 2)
        exact("a glowing %s slab" % name, straight(s), (0.5, 1, 2) * length)


def phase(cosine, g, alpha=0):
    """Draine's, and with alpha 0 Henyey and Greenstein's; the cosine is 1 straight on."""
    hg = (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * cosine) ** 1.5)
    return hg * (1 + alpha * cosine * cosine) / (1 + alpha * (1 + 2 * g * g) / 3)


# with their values where light turns to a cosine of -0.8
PHASES = (({"type": "hg", "g": 0.6}, phase(-0.8, 0.6)),
          ({"type": "hg", "g": -0.4}, phase(-0.8, -0.4)),
          ({"type": "rayleigh"}, 3 / (16 * np.pi) * 1.64),
          ({"type": "draine", "g": 0.5, "alpha": 12}, phase(-0.8, 0.5, 12)),
          ({"type": "two_term_hg", "g": [0.8, -0.6], "weight": 0.3},
           0.7 * phase(-0.8, 0.8) + 0.3 * phase(-0.8, -0.6)))


def test_single_scattering():
    """A slab under a distant light, one event: the light enters at 1 / mu per metre of depth,
    the view straight; L = E p s_s (1 - exp(-(1 + 1 / mu) s_t d)) / ((1 + 1 / mu) s_t)."""
    scattering, absorption, depth = np.array((0.2, 0.5, 1.0)), np.array((0.1, 0.3, 0.05)), 0.8
    for function, value in PHASES:
        s = stage(0)
        s.add(slab(-depth, 0), s.interface({"scattering": list(scattering), "absorption":
                                            list(absorption), "phase": function}))
        s.light("directional", 5, look_at((3, 0, 4), (0, 0, 0)))  # mu = 0.8
        picture = straight(s, size=(16, 16), spp=2048, depth=1)
        total, way = scattering + absorption, 1 + 1 / 0.8
        # Seen from +Z, the light turns by the angle between (-0.6, 0, -0.8) and +Z.
        want = 5 * value * scattering * (1 - np.exp(-way * total * depth)) / (way * total)
        agrees("single scattering, %s" % function, picture, want)


def test_forward_scattering():
    """At g near 1 light goes straight on, so that only absorption weakens it."""
    s = stage((1, 2, 3))
    s.add(slab(-0.5, 0.5), s.interface({"scattering": [3, 3, 3], "absorption": RED,
                                        "phase": {"type": "hg", "g": 0.99999}}))
    picture = straight(s, size=(32, 32), spp=256, depth=200)
    agrees("a slab that scatters forward alone", picture, (1, 2, 3) * beer(RED, 1))


def test_white_medium():
    """Scattering without absorption, under a sky of 1: invisible, whatever its shape and phase."""
    cube = box((-1, -1, -1), (1, 1, 1))
    for function, shape in (({"type": "hg", "g": 0.0}, cube),
                            ({"type": "hg", "g": 0.8}, sphere(1, columns=16, rows=8)),
                            ({"type": "droplets", "diameter": 12}, cube)):
        s = stage()
        s.add(shape, s.interface({"scattering": [0.5, 1, 2], "phase": function}))
        s.camera(look_at((2, 3, 4), (0, 0, 0)), half_height=0.5)
        agrees("a white cloud, %s" % function, render(s, (32, 32), 1280, 1000), 1)


def test_glass_slab():
    """Plates of glass with a coloured inside: the sum over all reflections in it, at two angles."""
    for degrees in (0, 40):
        s, angle = stage(), np.radians(degrees)
        glass = {"model": "dielectric", "ior": 1.5}
        s.add(slab(-0.25, 0.25, 500), s.material(glass, {"absorption": RED}))
        picture = straight(s, (9 * np.sin(angle), 0, 9 * np.cos(angle)), size=(16, 16), spp=1024,
                           depth=100)
        f = fresnel_dielectric(np.cos(angle), 1.5)
        t = beer(RED, 0.5 / np.sqrt(1 - (np.sin(angle) / 1.5) ** 2))
        # Towards the eye: f, and what has passed once or again and again; both sides see the sky.
        want = f + (1 - f) ** 2 * t / (1 - f * t)
        agrees("a coloured plate of glass at %d degrees" % degrees, picture, want)


def test_glass_ball():
    """Along the axis of a ball, where the surface stands across the ray; by CDL_medium and by
    KHR_materials_volume."""
    f, pale = float(fresnel_dielectric(1.0, 1.5)), [0.1, 0.2, 0.4]
    t = beer(pale, 2)
    want = f + (1 - f) ** 2 * t / (1 - f * t)
    s = stage()
    s.add(sphere(1, columns=96, rows=48, smooth=True),
          s.material({"model": "dielectric", "ior": 1.5}, {"absorption": pale}))
    s.camera(look_at((0, 4, 0), (0, 0, 0), up=(1, 0, 0)), half_height=0.003)
    agrees("a ball of coloured glass", render(s, (16, 16), 1024, 100), want)
    s = stage()
    color = [float(c) for c in beer(pale, 0.5)]
    volume = {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": color}
    s.add(box((-1, -1, -1), (1, 1, 1)), s.material(
        base=1, metallic=0, roughness=0,
        extensions={"KHR_materials_transmission": {"transmissionFactor": 1},
                    "KHR_materials_volume": volume, "KHR_materials_ior": {"ior": 1.5}}))
    agrees("a cube of glTF's coloured glass", straight(s, size=(16, 16), spp=1024, depth=100), want)


def test_interface_of_nothing():
    """The boundary of an empty medium changes nothing, on rays and on shadow rays."""
    pictures = []
    for with_boundary in (False, True):
        s = stage(0.3, sink=(0, -3, 0))
        s.add(quad((0, 0, 0), (0, 0, 5), (5, 0, 0)), s.diffuse(0.7))
        s.add(box((-0.3, 0, -0.3), (0.3, 0.4, 0.3)), s.diffuse((0.2, 0.5, 0.9)))
        s.add(quad((0, 2, 0), (0.5, 0, 0), (0, 0, 0.5)), s.emitter(8))
        if with_boundary:
            s.add(sphere(0.9, (0, 0.5, 0), 16, 8), s.interface({"absorption": [0, 0, 0]}))
            s.add(sphere(0.8, (0.2, 0.5, 0), 16, 8), s.interface())
        s.camera(look_at((2, 1.5, 3), (0, 0.2, 0)), yfov=30)
        pictures.append(render(s, (32, 32), 512, 8))
    without, through = pictures
    through.variance = through.variance + without.variance
    agrees("a picture through empty boundaries", through, without.rgb, 0.01)
    z = (through.rgb - without.rgb) / np.sqrt(np.maximum(through.variance, 1e-8))
    check("pixel by pixel", np.mean(np.abs(z) > 4) < 0.0025, "%g of the pixels differ" %
          np.mean(np.abs(z) > 4))


if __name__ == "__main__":
    main(test_absorbing_slab, test_scale_of_the_node, test_shadow_through_media, test_camera_inside,
         test_wide_cameras, test_overlapping_media, test_touching_media, test_medium_of_the_scene,
         test_glowing_medium, test_single_scattering, test_forward_scattering, test_white_medium,
         test_glass_slab, test_glass_ball, test_interface_of_nothing)
