#!/usr/bin/env python3
"""Motion blur: what moves while the shutter is open, against closed forms and against the mean of
still pictures at many times of the exposure.

The stills are the same file with a closed shutter, so they know nothing of how motion is stored;
that they are right is what test_animation.py proves."""
import numpy as np

import test_animation as moving
from support.render import render, scratch
from support.scene import FLOAT
from support.shapes import box, look_at, move, quad, sphere
from support.verdict import blocks_agree, check, main, near

STILLS = 24


def film(shutter, camera=None, **lens):
    """An empty scene whose camera has this shutter; `camera` is its node's place."""
    s = moving.Moving()
    place = look_at((0, 0, 5), (0, 0, 0)) if camera is None else camera
    s.camera(place, half_height=2, shutter=shutter, **lens)
    s.animation()
    return s


def sliding(shutter):
    s = film(shutter)
    node = s.add(quad((0, 0, 0), (0.5, 0, 0), (0, 0.5, 0)), s.unlit((1, 1, 1, 1)))
    s.environment(radiance=0)
    s.channel((node, "translation"), [0, 1], s.values([[-1, 0, 0], [1, 0, 0]], "VEC3"))
    return s


def compare(what, make, options=(), begin=0.0, length=1.0, size=(24, 24), relative=0.02):
    """`make(shutter)` writes the scene; blurred, and as the mean of stills."""
    path = make([0.0, length]).write(scratch(".gltf"))
    still = make([0.0, 0.0]).write(scratch(".gltf"))
    blurred = render(path, size, 16 * STILLS, options=["--at", begin, *options])
    mean, variance = 0, 0
    for i in range(STILLS):
        time = begin + length * (i + 0.5) / STILLS
        picture = render(still, size, 16, seed=i, options=["--at", time, *options])
        mean, variance = mean + picture.rgb / STILLS, variance + picture.variance / STILLS ** 2
    blurred.variance = blurred.variance + variance
    # Moved: what stands still would pass as well.
    middle = render(still, size, 16, options=["--at", begin, *options])
    check("%s: it moves" % what, np.abs(middle.rgb - blurred.rgb).mean() > 0.02 * mean.mean())
    blocks_agree(what, blurred, mean, relative=relative, side=4)
    return blurred


def test_sliding_square():
    """The square covers a pixel for a part of the exposure that is known."""
    s = sliding([0, 1])
    # At x the square is there while its centre, which runs from -1 to 1, is within 0.5.
    x = (np.arange(1600) + 0.5) / 400 - 2
    there = np.minimum(1, (x + 1.5) / 2) - np.maximum(0, (x + 0.5) / 2)
    want = np.maximum(there, 0).reshape(16, 100).mean(1)
    hashes = []
    for width in (2, 8):
        picture = render(s, (16, 16), 1024, 1, options=["--bvh", width])
        near("covered part of the time, %d wide" % width, picture.rgb[7:9, :, 0].mean(0), want, 0.03)
        hashes.append(picture.sha256)
    check("both trees give the same bits", hashes[0] == hashes[1])
    still = render(sliding([0.5, 0.5]), (16, 16), 16, 1, options=["--at", 0.5])
    near("a closed shutter is a still", still.rgb[8, :, 0], np.r_[[0] * 6, [1] * 4, [0] * 6], 1e-6)


def lit(s):
    """Light from two sides, and a floor for the shadows."""
    s.environment(radiance=0.3)
    s.light("directional", 2, look_at((2, 3, 4), (0, 0, 0)))
    s.add(quad((0, 0, -1.2), (4, 0, 0), (0, 4, 0)), s.diffuse((0.6, 0.5, 0.4)))


def test_turning_node():
    """Two instances of one mesh on an arm that turns by a third of a turn, unevenly scaled; a third
    instance stands still."""
    def make(shutter):
        s = film(shutter)
        mesh = s.mesh(box((-0.4, -0.2, -0.3), (0.4, 0.2, 0.3)), s.diffuse((0.7, 0.3, 0.2)))
        blades = [s.node(move(x, 0, 0), root=False, mesh=mesh) for x in (-1, 1)]
        arm = s.node(children=blades, scale=[1.0, 1.5, 0.7])
        s.node(move(0, 1.5, 0), mesh=mesh)
        s.channel((arm, "rotation"), [0, 1],
                  s.values([moving.turned(0), moving.turned(120, (0.2, 0.3, 1))], "VEC4"))
        lit(s)
        return s

    hashes = [compare("turning node, %d wide" % w, make, ["--bvh", w]).sha256 for w in (2, 8)]
    check("both trees give the same bits", hashes[0] == hashes[1])


def test_skin_and_morph():
    def make(shutter):
        s = moving.skinned(component=FLOAT)
        s.camera(look_at((1.5, 0, 6), (1.5, 0, 0)), half_height=2.2, shutter=shutter)
        s.animation()
        for skin in s.json["skins"]:
            s.channel((skin["joints"][2], "rotation"), [0, 1],
                      s.values([moving.turned(0), moving.turned(60)], "VEC4"))
        lit(s)
        return s

    compare("skins", make)

    def morph(shutter):
        s, _, child = moving.morphing([0.0, 0.0])
        s.camera(look_at((0, 0, 6), (0, 0, 0)), half_height=2, shutter=shutter)
        s.channel((child, "weights"), [0, 1], s.values([0, 0, 1.5, 0.7], "SCALAR"))
        lit(s)
        return s

    compare("morph targets, in the second half", morph, begin=0.5, length=0.5)


def test_moving_camera():
    """A camera that pans and dollies past boxes, with a lens."""
    def make(shutter):
        s = moving.Moving()
        camera = s.camera(look_at((0, 0, 5), (0, 0, 0)), yfov=40, shutter=shutter,
                          apertureRadius=0.05, focusDistance=5.0)
        node = s.json["nodes"][camera]
        node.pop("matrix")
        node["translation"] = [0.0, 0.0, 5.0]
        s.animation()
        s.channel((camera, "translation"), [0, 1], s.values([[-1, 0, 5], [1, 0.5, 4]], "VEC3"))
        s.channel((camera, "rotation"), [0, 1],
                  s.values([moving.turned(0, (0, 1, 0)), moving.turned(20, (0, 1, 0))], "VEC4"))
        for x in (-1.2, 0, 1.2):
            s.add(box((-0.4, -0.4, -0.4), (0.4, 0.4, 0.4)), s.diffuse((0.2, 0.5, 0.3)), move(x, 0, 0))
        lit(s)
        return s

    compare("camera", make)


def test_moving_lamp_glass_and_fog():
    """An emitter that moves (found by paths alone), and a ball of fog that moves: its boundary
    weakens shadow rays."""
    def make(shutter):
        s = film(shutter)
        lamp = s.add(sphere(0.5, columns=16, rows=8), s.emitter((6, 4, 2)))
        s.channel((lamp, "translation"), [0, 1], s.values([[-1.5, 1, 0], [1.5, 1, 0]], "VEC3"))
        fog = s.add(sphere(0.8, columns=24, rows=12),
                    s.interface({"absorption": [1, 2, 3], "scattering": [1, 1, 1]}))
        s.channel((fog, "translation"), [0, 1], s.values([[1, -1, 0], [-1, -0.5, 0]], "VEC3"))
        lit(s)
        return s

    compare("lamp and fog", make, relative=0.05)


def test_what_is_not_blurred():
    """Things that vanish meanwhile: a picture of the opening, and a note."""
    s = sliding([0, 1])
    s.used.add("KHR_node_visibility")
    s.json["nodes"][1]["extensions"] = {"KHR_node_visibility": {"visible": True}}
    s.channel("/nodes/1/extensions/KHR_node_visibility/visible", [0, 0.6],
              s.values([1, 0], "SCALAR", 5121), "STEP")
    picture = render(s, (16, 16), 16, 1)
    check("a note says so", "vanish" in picture.notes, picture.notes)
    near("as it opens", picture.rgb[8, :, 0], np.r_[[0] * 2, [1] * 4, [0] * 10], 1e-6)


if __name__ == "__main__":
    main(test_sliding_square, test_turning_node, test_skin_and_morph, test_moving_camera,
         test_moving_lamp_glass_and_fog, test_what_is_not_blurred)
