#!/usr/bin/env python3
"""Environment maps: where each texel stands in the sky, blending, rotation, strength, mending,
and the light that they give, against the formulas of SCENES written down a second time here.

Pictures of the sky are compared pixel by pixel (its map is smooth enough for 8 x 8 points a
pixel to stand for it, to 0.02), light on a plane to 0.3 % with three standard errors below that."""
import numpy as np

from support.images import exr_bytes
from support.render import render, run, scratch
from support.scene import Scene
from support.shapes import look_at, quad
from support.verdict import agrees, check, main, near

WIDTH, HEIGHT = 16, 8
RANDOM = np.random.default_rng(7)
MAP = RANDOM.uniform(0.2, 1.0, (HEIGHT, WIDTH, 3))
AXES = {"+X": (1, 0, 0), "-X": (-1, 0, 0), "+Y": (0, 1, 0), "-Y": (0, -1, 0), "+Z": (0, 0, 1),
        "-Z": (0, 0, -1)}


def lookup(image, directions, rotation=0.0):
    """Radiance from unit directions: the centre column towards +X, +Z a quarter of the width to its
    right, the top row +Y, turned counter-clockwise (seen from above) by `rotation` degrees."""
    height, width = image.shape[:2]
    # Counter-clockwise seen from +Y takes +X towards -Z: the sky's own direction is turned back.
    a = np.radians(rotation)
    x = np.cos(a) * directions[..., 0] - np.sin(a) * directions[..., 2]
    z = np.sin(a) * directions[..., 0] + np.cos(a) * directions[..., 2]
    column = (0.5 + np.arctan2(z, x) / (2 * np.pi)) * width - 0.5
    row = np.arccos(np.clip(directions[..., 1], -1, 1)) / np.pi * height - 0.5
    i, j = np.floor(column).astype(int), np.floor(row).astype(int)
    s, t = (column - i)[..., None], (row - j)[..., None]
    left, right = i % width, (i + 1) % width
    top, bottom = np.clip(j, 0, height - 1), np.clip(j + 1, 0, height - 1)
    return ((1 - t) * ((1 - s) * image[top, left] + s * image[top, right]) +
            t * ((1 - s) * image[bottom, left] + s * image[bottom, right]))


def view(matrix, yfov, pixels, across=8):
    """Unit directions of a square picture, across x across in each pixel."""
    at = 2 * (np.arange(pixels * across) + 0.5) / (pixels * across) - 1
    x, y = np.meshgrid(at, -at)
    t = np.tan(np.radians(yfov) / 2)
    local = np.stack([x * t, y * t, -np.ones_like(x)], -1)
    local /= np.linalg.norm(local, axis=-1, keepdims=True)
    return local @ np.asarray(matrix)[:3, :3].T


def seen(image, matrix, yfov, pixels, rotation=0.0, across=8):
    radiance = lookup(image, view(matrix, yfov, pixels, across), rotation)
    return radiance.reshape(pixels, across, pixels, across, 3).mean((1, 3))


def sky(**environment):
    s = Scene()
    s.use_every_feature(at=(37, 21, -11))
    s.environment(**environment)
    return s


def test_named_directions():
    """One texel that shines, at each place that SCENES names, seen along an axis from the
    origin."""
    places = {"+X": (3, WIDTH // 2), "+Z": (3, 3 * WIDTH // 4), "-Z": (3, WIDTH // 4), "-X": (3, 0),
              "+Y": (0, slice(None)), "-Y": (HEIGHT - 1, slice(None))}
    image = np.zeros((HEIGHT, WIDTH, 3))
    for number, (row, column) in enumerate(places.values()):
        # Both texels and both rows that meet in that direction.
        rows = slice(row, row + 2) if row == 3 else row
        columns = [column - 1, column] if row == 3 else column
        image[rows, columns] = 1 + number
    for number, (name, axis) in enumerate((n, AXES[n]) for n in places):
        s = sky(image=image)
        s.camera(look_at((0, 0, 0), axis, up=(0.1, 0.2, 0.3)), yfov=0.5)
        near("the sky towards %s" % name, render(s, (4, 4), 4, 0).rgb, 1 + number, 1e-4)


def test_whole_sky():
    """Six views that cover the sky, and two of them with the map turned and scaled."""
    for name, axis in AXES.items():
        s, camera = sky(image=MAP), look_at((0, 0, 0), axis, up=(0.3, 0.5, 0.4))
        s.camera(camera, yfov=90)
        picture = render(s, (32, 32), 64, 0)
        near("the map towards %s" % name, picture.rgb, seen(MAP, camera, 90, 32), 0.02)
        agrees("its mean towards %s" % name, picture, seen(MAP, camera, 90, 32))
    for degrees in (90, 37):
        s = sky(image=MAP, rotation=degrees, strength=2.5)
        s.camera(camera, yfov=90)
        picture = render(s, (32, 32), 64, 0)
        want = 2.5 * seen(MAP, camera, 90, 32, degrees)
        near("the map turned by %d degrees" % degrees, picture.rgb, want, 0.03)


def irradiance(image, normal, rotation=0.0):
    """By quadrature over the sphere."""
    cosine = 1 - 2 * (np.arange(1024) + 0.5) / 1024
    phi = 2 * np.pi * (np.arange(2048) + 0.5) / 2048
    ring = np.sqrt(1 - cosine ** 2)
    directions = np.stack([np.outer(ring, np.cos(phi)), np.repeat(cosine[:, None], 2048, 1),
                           np.outer(ring, np.sin(phi))], -1)
    lit = np.maximum(directions @ np.asarray(normal, float), 0)
    total = np.sum(lookup(image, directions, rotation) * lit[..., None], (0, 1))
    return total * 4 * np.pi / lit.size


def test_light_of_the_sky():
    """A plane that faces this way and that, under the random map and under a small sun."""
    sun = np.full((32, 64, 3), 0.05)
    sun[9, 40] = (300, 200, 100)
    for name, image, normal, rotation, spp in (("map", MAP, (0.3, 0.8, -0.5), 0, 256),
                                               ("map, turned", MAP, (0.9, 0.1, 0.4), 200, 256),
                                               ("sun", sun, (-0.6, 0.6, 0.5), 0, 1536)):
        n = np.array(normal) / np.linalg.norm(normal)
        u = np.cross(n, (1, 2, 3)) / np.linalg.norm(np.cross(n, (1, 2, 3)))
        s = Scene()
        s.use_every_feature(at=-0.1 * n)
        s.environment(image=image, rotation=rotation)
        s.add(quad((0, 0, 0), u, np.cross(n, u)), s.diffuse((0.9, 0.6, 0.3)))
        s.camera(look_at(n, (0, 0, 0), up=u), half_height=0.3)
        picture = render(s, (32, 32), spp, 1)
        want = irradiance(image, n, rotation) * (0.9, 0.6, 0.3) / np.pi
        agrees("a plane under the %s" % name, picture, want)


def test_broken_texels():
    """Negative and not-a-number count as 0, infinite as the largest finite value; a note says
    how many."""
    image = np.ones((4, 8, 3))
    image[1:3, 3:5] = -5, np.nan, 2
    image[1:3, 1:3] = np.inf, 3, 1
    s = sky(image=image)
    for name, axis in (("+X", AXES["+X"]), ("-Z", AXES["-Z"])):
        s.camera(look_at((0, 0, 0), axis), yfov=0.5, name=name)
    toward_x = render(s, (4, 4), 4, 0, options=("--camera", "+X"))
    near("texels below 0 and not numbers", toward_x.rgb[0, 0], (0, 0, 2), 1e-4)
    toward_z = render(s, (4, 4), 4, 0, options=("--camera", "-Z"))
    near("infinite texels", toward_z.rgb[0, 0], (3, 3, 1), 1e-4)
    check("a note tells of 8 texels", "8 texels" in toward_x.notes, toward_x.notes)


def test_options():
    """--env, --env-strength and --background take the scene's place; without a light there is a
    sky."""
    s, camera = sky(radiance=(9, 9, 9)), look_at((0, 0, 0), (1, 0.2, 0.3))
    s.camera(camera, yfov=60)
    path = scratch(".exr")
    with open(path, "wb") as file:
        file.write(exr_bytes(MAP))
    picture = render(s, (16, 16), 16, 0, options=("--env", path))
    near("--env", picture.rgb, seen(MAP, camera, 60, 16), 0.02)
    picture = render(s, (16, 16), 16, 0, options=("--env", path, "--env-strength", "3"))
    near("--env with --env-strength", picture.rgb, 3 * seen(MAP, camera, 60, 16), 0.06)
    picture = render(s, (4, 4), 4, 0, options=("--env-strength", "0.5"))
    near("--env-strength alone", picture.rgb, 4.5, 1e-5)
    picture = render(s, (4, 4), 4, 0, options=("--background", "0.25,0.5,2"))
    near("--background", picture.rgb[1, 2], (0.25, 0.5, 2), 1e-6)
    dark = Scene()
    dark.add(quad((0, 0, -1), (0.1, 0, 0), (0, 0.1, 0)), dark.diffuse(0.5))
    dark.camera(look_at((0, 0, 0), (0, 0, 1)), yfov=60)
    picture = render(dark, (4, 4), 4, 0)
    near("a scene without any light", picture.rgb, 1, 1e-6)
    check("says so in a note", "light" in picture.notes, picture.notes)
    info, _ = run("info", dark.write(scratch(".gltf")))
    check("candela info reads it", "triangles" in info)


if __name__ == "__main__":
    main(test_named_directions, test_whole_sky, test_light_of_the_sky, test_broken_texels,
         test_options)
