#!/usr/bin/env python3
"""The layers beside the picture, pixel by pixel against a scene whose every point is known, and
what the header of an EXR file says. Only the variance is a matter of chance: it is held against
the spread of many renders, to 10 %."""
import json

import numpy as np

from support.images import read_exr
from support.render import render, run, scratch
from support.scene import Scene
from support.shapes import look_at, move, quad, scale, sphere
from support.verdict import check, main, near

SKY = (0.25, 0.5, 2.0)
PIXELS = 24


def known():
    """Four squares of 1 x 1 at depths of their own in front of a camera without perspective at z
    = 5 that sees x, y from -1 to 1; above right is the sky. Ids count from 1."""
    s = Scene()
    s.environment(radiance=SKY)
    unused = s.diffuse(0.1)
    left = s.material(base=(0.2, 0.4, 0.6), metallic=0, roughness=1)
    glow = s.emitter((3, 2, 1))
    behind = s.emitter((7, 7, 7))
    leaf = s.material(base=(1, 1, 1, 0.0), alphaMode="BLEND")
    s.expected = []
    front = quad((-0.5, 0.5, 0), (0.5, 0, 0), (0, 0.5, 0))
    tilted = quad((-0.5, -0.5, 0), (0.5, 0, 0), (0, 0.5, 0))
    tilted["positions"][:, 2] = tilted["positions"][:, 0]  # its normal is (-1, 0, 1) / sqrt 2
    turned = quad((0.5, -0.5, -1), (0, 0.5, 0), (0.5, 0, 0))  # shows its back
    s.add(front, left)                                      # object 1, material 2
    s.add(tilted, glow, move(0, 0, 0.5))                    # object 2, material 3
    s.add(turned, behind)                                   # object 3, material 4
    s.add(quad((0, 0, 3), (2, 0, 0), (0, 2, 0)), leaf)      # not there at all
    s.add(quad((0, 0, 2), (2, 0, 0), (0, 2, 0)), s.interface())  # the boundary of nothing
    assert unused == 0
    s.camera(look_at((0, 0, 5), (0, 0, 0)), half_height=1)
    return s


def quarters(top_left, top_right, bottom_left, bottom_right):
    """A picture of four constant quarters."""
    half = PIXELS // 2

    def plane(value):
        return np.broadcast_to(np.asarray(value, float), (half, half, np.size(value)))
    return np.concatenate([np.concatenate([plane(top_left), plane(top_right)], 1),
                           np.concatenate([plane(bottom_left), plane(bottom_right)], 1)])


def layers(depth):
    return render(known(), (PIXELS, PIXELS), 40, depth, aov="all")


def test_layers():
    for depth in (0, 3):
        p, nothing = layers(depth), (0, 0, 0)
        at = "at depth %d" % depth
        near("albedo " + at, p.layer("albedo", "RGB"),
             quarters((0.2, 0.4, 0.6), nothing, nothing, nothing), 1e-6)
        tilt = np.array((-1, 0, 1)) / np.sqrt(2)
        near("normal " + at, p.layer("normal", "XYZ"),
             quarters((0, 0, 1), nothing, tilt, (0, 0, 1)), 1e-6)
        # What has a mesh is counted.
        near("object " + at, p.layer("object", ["id"]), quarters(1, 0, 2, 3), 0)
        near("material " + at, p.layer("material", ["id"]), quarters(2, 0, 3, 4), 0)
        near("samples " + at, p.layer("samples", ["count"]), np.full((PIXELS, PIXELS, 1), 40), 0)
        # The emitter's back gives nothing, and the sky is no surface.
        near("emission of surfaces " + at, p.layer("emission", "RGB"),
             quarters(nothing, nothing, (3, 2, 1), nothing), 1e-6)
        near("beauty of the sky " + at, p.rgb[:12, 12:], np.broadcast_to(SKY, (12, 12, 3)), 1e-6)
        depths = p.layer("depth", "Z")[..., 0]
        check("depth of the sky is infinite " + at, np.isposinf(depths[:12, 12:]).all())
        near("depth of flat squares " + at, depths[:12, :12], 5, 1e-5)
        near("depth of the back " + at, depths[12:, 12:], 6, 1e-5)
        # Depth and position are those of the first sample, which falls anywhere in its pixel.
        position = p.layer("position", "XYZ")
        x, y = np.meshgrid((np.arange(PIXELS) + 0.5) / 12 - 1, 1 - (np.arange(PIXELS) + 0.5) / 12)
        seen = np.isfinite(depths)
        near("positions across " + at, position[seen][:, :2], np.stack([x, y], -1)[seen],
             1 / PIXELS + 1e-6)
        near("positions along " + at, position[seen][:, 2], 5 - depths[seen], 1e-5)
        slope = position[12:, :12]
        near("positions on the slope " + at, slope[..., 2], slope[..., 0] + 0.5, 1e-5)
        near("positions of the sky " + at, position[:12, 12:], 0, 0)


def test_instances_have_their_nodes():
    """A mesh placed twice, and under a mirror: number, normals and depth are the place's."""
    s = Scene()
    s.environment(radiance=1)
    mesh = s.mesh(sphere(0.4, columns=64, rows=32, smooth=True), s.diffuse((0.9, 0.1, 0.2)))
    s.node(move(-0.5, 0, 0), mesh=mesh)
    s.node(move(0.5, 0, -3) @ scale(-1, 1, 1), mesh=mesh)
    s.camera(look_at((0, 0, 5), (0, 0, 0)), half_height=0.5, aspect=2.0)
    p = render(s, (48, 24), 16, 1, aov="all")
    ids = p.layer("object", ["id"])[..., 0]
    near("objects", [ids[12, 12], ids[12, 36], ids[0, 24]], [1, 2, 0], 0)
    depths = p.layer("depth", "Z")[..., 0]
    near("depths", [depths[12, 12], depths[12, 36]], [4.6, 7.6], 0.005)
    normals = p.layer("normal", "XYZ")
    near("normals", normals[12, [8, 32]], np.broadcast_to(normals[12, 8], (2, 3)), 0.02)
    check("normals point to the left on the left", np.all(normals[12, [6, 30], 0] < -0.5))


def test_variance():
    """What one render says of its own noise is the spread of many. The samples of a block are
    stratified together, and blocks among each other, so that it may say too much, never too
    little."""
    s = Scene()
    s.use_every_feature()
    s.environment(radiance=0)
    s.add(quad((0, 0, 0), (0, 0, 5), (5, 0, 0)), s.diffuse(0.8))
    s.add(quad((0, 1, 0), (0.5, 0, 0), (0, 0, 0.5)), s.emitter((8, 2, 1)))
    s.camera(look_at((0, 0.5, 0), (0, 0, 0), up=(0, 0, 1)), half_height=1)
    pictures = [render(s, (16, 16), 32, 1, seed=seed) for seed in range(12)]
    found = np.stack([p.rgb for p in pictures]).var(0, ddof=1).mean((0, 1))
    said = np.stack([p.variance for p in pictures]).mean((0, 1, 2))
    check("variance against the spread of 12 renders", np.all(said > 0.9 * found) and
          np.all(said < 3 * found), "says %s, found %s" % (said, found))
    one_block = render(s, (4, 4), 16, 1)
    check("one block tells nothing of its variance", np.isposinf(one_block.variance).all())


def test_header():
    """Scene, device, settings, seed, samples and version, and the hash of the film, as strings
    or numbers."""
    path, out, stats = known().write(scratch(".gltf")), scratch(".exr"), scratch(".json")
    run("render", path, "-o", out, "--size", "24x24", "--spp", 48, "--seed", 4000000000,
        "--max-depth", 3, "--stats", stats, "--crop", "1,2,3,4")
    _, header = read_exr(out)
    with open(stats) as file:
        said = json.load(file)
    want = {"scene": path, "version": said["version"], "device": said["device"]["name"],
            "platform": said["device"]["platform"], "driver": said["device"]["driver"],
            "seed": "4000000000", "spp": 48, "samples.least": 48, "samples.most": 48,
            "max_depth": 3, "crop": "1,2,3,4", "math": "exact", "film_sha256": said["film_sha256"],
            "scene_sha256": said["scene_sha256"]}
    for name, value in want.items():
        got = header.get("candela." + name)
        check("header: %s" % name, str(got) == str(value), "%r instead of %r" % (got, value))
    check("header: kernels_sha256", len(header.get("candela.kernels_sha256", "")) == 64)


def test_film_hash():
    """film_sha256 is the SHA-256 of the picture's floats, RGB, rows from the top, little-endian."""
    import hashlib
    picture = render(known(), (PIXELS, PIXELS), 20, 3)
    floats = np.stack([picture.channels[c] for c in "RGB"], -1).astype("<f4")
    check("film_sha256", hashlib.sha256(floats.tobytes()).hexdigest() == picture.sha256)


if __name__ == "__main__":
    main(test_layers, test_instances_have_their_nodes, test_variance,
         test_header, test_film_hash)
