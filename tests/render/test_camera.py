#!/usr/bin/env python3
"""Cameras: where a point of the world lands in the picture, how blurred it is, and which pixels
a crop is.

Sizes and places are read off pictures of small lamps by their moments: the centre of their light
to 0.01 to 0.05 pixels, the spread of a blur to 0.5 to 1 % (as said there)."""
import numpy as np

from support.images import read_exr
from support.render import Failed, render, run, scratch
from support.scene import Scene
from support.shapes import look_at, move, quad, sphere, turn
from support.verdict import check, main, near

EYE = look_at((1, 2, 4), (0.2, 0.3, -0.5))


def lamps(points, radius=0.06):
    s = Scene()
    s.use_every_feature(at=(50, 30, 40))
    s.environment(radiance=0)
    for color, point in zip(np.eye(3), points):
        s.add(sphere(radius, point, 16, 8), s.emitter(color))
    return s


def centers(picture):
    """Of the light of each channel, in pixels from the top left corner."""
    height, width = picture.rgb.shape[:2]
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    total = np.maximum(picture.rgb.sum((0, 1)), 1e-30)
    return np.stack([(picture.rgb * x[..., None]).sum((0, 1)) / total,
                     (picture.rgb * y[..., None]).sum((0, 1)) / total], 1)


def in_camera(points):
    inverse = np.linalg.inv(EYE)
    return np.asarray(points) @ inverse[:3, :3].T + inverse[:3, 3]


POINTS = [(0.1, 0.6, -0.4), (-0.5, 0.2, 0.3), (0.7, 0.1, 0.2)]


def test_perspective():
    s = lamps(POINTS)
    s.camera(EYE, yfov=35, aspect=1.5)
    local = in_camera(POINTS)
    for width, height in ((96, 64), (64, 96)):
        t = np.tan(np.radians(35) / 2)
        x = local[:, 0] / -local[:, 2] / t * height / 2 + width / 2
        y = height / 2 - local[:, 1] / -local[:, 2] / t * height / 2
        picture = render(s, (width, height), 256, 0)
        near("three points in %d x %d" % (width, height), centers(picture),
             np.stack([x, y], 1), 0.02)


def test_orthographic():
    s = lamps(POINTS)
    s.camera(EYE, half_height=0.9, aspect=1.5)
    local = in_camera(POINTS)
    x, y = 48 + local[:, 0] / 0.9 * 32, 32 - local[:, 1] / 0.9 * 32
    picture = render(s, (96, 64), 256, 0)
    near("three points without perspective", centers(picture), np.stack([x, y], 1), 0.02)


def test_moved_and_mirrored_nodes():
    """A camera below turned, scaled nodes looks along the -Z that is left; scale does not zoom."""
    s = lamps([(0, 0, -3)], 0.1)
    child = s.node(turn((0, 1, 0), 90), root=False, camera=0)
    s._list("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01,
                                                               "aspectRatio": 1.0}})
    s.node(turn((0, 1, 0), -90) @ np.diag([2.0, 2, 2, 1]), children=[child])
    picture = render(s, (32, 32), 64, 0)
    near("a lamp ahead", centers(picture)[0], (16, 16), 0.02)
    area = picture.rgb[..., 0].sum() / 1024 * (2 * 3 * np.tan(0.3)) ** 2
    # A sphere of 16 x 8 facets, 0.1 in radius: 5 % less than its disk.
    near("of the right size", area / (np.pi * 0.01), 0.95, 0.04)


def spread(picture):
    """Mean square distance from the centre of the light, in pixels squared."""
    height, width = picture.rgb.shape[:2]
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    light = picture.rgb[..., 0] / picture.rgb[..., 0].sum()
    cx, cy = (light * x).sum(), (light * y).sum()
    return (light * ((x - cx) ** 2 + (y - cy) ** 2)).sum(), (cx, cy)


def test_thin_lens():
    """A small lamp off the plane in focus is blurred to the shape of the lens: on that plane its
    picture has the lens's size times |d - f| / d. A disk's mean square radius is R^2 / 2, a
    regular n-gon's with corners at R is R^2 (2 + cos(2 pi / n)) / 6."""
    focus, lens, half, pixels = 2.0, 0.05, 0.125, 64
    for blades, share in ((0, 0.5), (5, (2 + np.cos(2 * np.pi / 5)) / 6),
                          (3, (2 + np.cos(2 * np.pi / 3)) / 6)):
        for distance in (1.0, 5.0):
            s = Scene()
            s.use_every_feature(at=(50, 30, 40))
            s.environment(radiance=0)
            side = 4e-3 * distance
            s.add(quad((0, 0, -distance), (side, 0, 0), (0, side, 0)), s.emitter(1000))
            s.camera(move(0, 0, 0), yfov=2 * np.degrees(np.arctan(half / focus)),
                     apertureRadius=lens, focusDistance=focus, blades=blades)
            picture = render(s, (pixels, pixels), 512, 0)
            scale = pixels / (2 * half)
            blur = lens * abs(distance - focus) / distance * scale
            lamp = 2 * side ** 2 / 3 * (focus / distance * scale) ** 2  # a square: s^2 / 3 an axis
            pixel = 1 / 6  # a light falls anywhere in the pixel that counts it
            got, center = spread(picture)
            want = share * blur ** 2 + lamp + pixel
            near("blur at %g m, %d blades" % (distance, blades), got / want, 1, 0.02)
            near("its centre", center, (pixels / 2, pixels / 2), 0.1)
            if blades == 3:
                # A corner at the top of the lens: nearer than the focus its picture is upside down.
                row = np.nonzero(picture.rgb[..., 0].sum(1))[0]
                above, below = pixels / 2 - row[0], row[-1] + 1 - pixels / 2
                check("the lens's corner at %g m" % distance,
                      (above > 1.5 * below) == (distance > focus), "%g, %g" % (above, below))


def test_focus():
    """What lies in the plane in focus is as sharp as by a pinhole."""
    pictures = []
    for lens in (0.0, 0.3):
        s = Scene()
        s.use_every_feature(at=(50, 30, 40))
        s.environment(radiance=0)
        s.add(quad((0, 0.013, -2), (0.3, 0, 0), (0, 0.2, 0)), s.emitter(1))
        s.camera(move(0, 0, 0), yfov=20, apertureRadius=lens, focusDistance=2)
        pictures.append(render(s, (32, 32), 64, 0).rgb)
    near("a lamp in focus", pictures[1], pictures[0], 1e-6)


def crowded():
    s = lamps(POINTS, 0.2)
    s.add(quad((0, 0, 0), (0, 0, 2), (2, 0, 0)), s.diffuse((0.8, 0.5, 0.3)))
    s.environment(radiance=0.4)
    s.camera(EYE, yfov=40, aspect=1.5, name="first", apertureRadius=0.05, focusDistance=4)
    s.camera(look_at((0, 5, 0.1), (0, 0, 0)), half_height=1, name="second")
    return s


def test_crop():
    """A crop is those very pixels, bit for bit, with all their layers; --size may leave a side
    out."""
    s = crowded()
    whole = render(s, (48, 32), 20, 4, aov="all")
    for x, y, w, h in ((0, 0, 7, 5), (13, 9, 22, 17), (47, 31, 1, 1)):
        crop = "%d,%d,%d,%d" % (x, y, w, h)
        part = render(s, (48, 32), 20, 4, aov="all", options=("--crop", crop))
        same = all(np.array_equal(part.channels[name], plane[y:y + h, x:x + w], equal_nan=True)
                   for name, plane in whole.channels.items())
        check("a crop of %d x %d at %d, %d" % (w, h, x, y), same)
    path = s.write(scratch(".gltf"))
    for given, want in (("48x", (32, 48)), ("x30", (30, 45))):
        out = scratch(".exr")
        run("render", path, "-o", out, "--size", given, "--spp", 1)
        check("--size %s" % given, read_exr(out)[0]["R"].shape == want)


def test_choice():
    s = crowded()
    first = render(s, (24, 16), 4, 2)
    second = render(s, (24, 16), 4, 2, options=("--camera", "second"))
    check("cameras differ", first.sha256 != second.sha256)
    for how, choice, same in (("index", "1", second), ("name", "first", first)):
        picture = render(s, (24, 16), 4, 2, options=("--camera", choice))
        check("by %s" % how, picture.sha256 == same.sha256)
    try:
        render(s, (24, 16), 4, options=("--camera", "third"))
        check("an unknown camera is refused", False)
    except Failed as failure:
        check("an unknown camera is refused", failure.status == 2 and "third" in failure.message and
              "second" in failure.message, failure.message)


def test_default_camera():
    """A scene without a camera is framed, from front-right and above."""
    for size in (0.01, 100.0):
        s = Scene()
        s.use_every_feature(at=(0, 0, 0))
        s.environment(radiance=0)
        corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
        for corner in corners:
            s.add(sphere(0.1 * size, corner * size, 8, 4), s.emitter(1))
        picture = render(s, (64, 64), 16, 0)
        seen = picture.rgb[..., 0] > 0
        border = np.concatenate([seen[0], seen[-1], seen[:, 0], seen[:, -1]])
        check("all of a scene of %g m is in view" % size, seen.any() and not border.any())
        rows, columns = np.nonzero(seen)
        wide = max(np.ptp(rows), np.ptp(columns))
        check("and fills it", wide > 40, "%d of 64 pixels" % wide)


if __name__ == "__main__":
    main(test_perspective, test_orthographic, test_moved_and_mirrored_nodes, test_thin_lens,
         test_focus, test_crop, test_choice, test_default_camera)
