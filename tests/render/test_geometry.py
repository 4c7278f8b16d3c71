#!/usr/bin/env python3
"""Shapes and where they are placed, seen in pictures: instances, stretched and mirrored nodes,
normals, both sides of a surface, closed surfaces that let nothing through.

Shading by a distant light has no noise but that of the pixel's own area: ellipsoids are compared
pixel by pixel with the normal of the ellipsoid itself, to what their facets leave (1 %)."""
import numpy as np

from support.render import render
from support.scene import Scene
from support.shapes import box, inside_out, look_at, move, quad, scale, sphere, turn
from support.verdict import agrees, check, main, near


def ellipsoid_picture(matrix, to_light, to_eye, half, pixels, across=8):
    """pi times the radiance of a white ellipsoid, the image of the unit sphere under `matrix`
    (without translation), lit by a distant light of 1, seen without perspective; NaN at pixels
    not wholly in it."""
    inverse = np.linalg.inv(matrix[:3, :3])
    view = look_at(to_eye, (0, 0, 0), up=(0, 1, 0.1))
    at = (2 * (np.arange(pixels * across) + 0.5) / (pixels * across) - 1) * half
    x, y = np.meshgrid(at, -at)
    origin = x[..., None] * view[:3, 0] + y[..., None] * view[:3, 1] + 10 * view[:3, 2]
    o, d = origin @ inverse.T, -view[:3, 2] @ inverse.T
    b, a = o @ d, d @ d
    root = b * b - a * (np.sum(o * o, -1) - 1)
    with np.errstate(invalid="ignore"):
        point = o + ((-b - np.sqrt(root)) / a)[..., None] * d
    normal = point @ inverse  # the inverse transpose takes normals along
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    lit = np.maximum(normal @ to_light, 0)
    return lit.reshape(pixels, across, pixels, across).mean((1, 3))


def test_normals_of_stretched_spheres():
    """Smooth spheres in stretched, sheared (by two nodes) and mirrored places, alone and as
    instances."""
    to_light, to_eye = np.array((0.6, 0.64, 0.48)), np.array((0.2, 0.3, 1.0))
    outer = [np.eye(4), scale(1.5, 0.6, 0.9), scale(-0.7, 1.3, 1),
             turn((1, 1, 0), 20) @ scale(0.5, -1.2, -1)]
    inner = [np.eye(4), turn((0, 0, 1), 40), turn((1, 0, 0), 70) @ scale(0.6, 1, 1.4),
             scale(1, 1, -1)]
    for shared in (False, True):
        for number, (a, b) in enumerate(zip(outer, inner)):
            s = Scene()
            s.use_every_feature(at=(0, -20, -20))
            s.environment(radiance=0)
            mesh = s.mesh(sphere(1, columns=128, rows=64, smooth=True), s.diffuse(1))
            nodes = [s.node(a, children=[s.node(b, root=False, mesh=mesh)])]
            if shared:
                nodes.append(s.node(move(0, 0, -30), mesh=mesh))
            s.light("directional", np.pi, look_at(to_light, (0, 0, 0)))
            s.camera(look_at(10 * to_eye / np.linalg.norm(to_eye), (0, 0, 0), up=(0, 1, 0.1)),
                     half_height=0.7)
            picture = render(s, (24, 24), 32, 1)
            want = ellipsoid_picture(a @ b, to_light, to_eye, 0.7, 24)
            inside = np.isfinite(want)
            name = "sphere %d, %s" % (number, "an instance" if shared else "alone")
            off = np.abs(picture.rgb[inside] - want[inside][:, None]).max(-1)
            # Facets shadow each other where the light grazes.
            check(name, np.mean(off > 0.015) < 0.01, "%d of %d pixels are off" %
                  (np.sum(off > 0.015), off.size))
            near("its mean", picture.rgb[inside].mean(0) / want[inside].mean(), 1, 0.003)


def corners():
    """A scene in which much depends on where things stand."""
    s = Scene()
    s.use_every_feature()
    s.environment(radiance=0.2)
    s.add(quad((0, -0.5, 0), (0, 0, 3), (3, 0, 0)), s.diffuse((0.7, 0.5, 0.3)))
    s.light("point", 3, move(1, 2, 1))
    s.camera(look_at((2, 2, 4), (0, 0, 0)), yfov=40)
    return s


PLACES = [((-0.8, 0, 0.3), (0, 0.2588190451, 0, 0.9659258263), (0.4, 0.6, 0.4)),
          ((0.5, 0.1, -0.2), (0.1736481777, 0, 0, 0.984807753), (0.5, 0.3, 0.7)),
          ((0.3, -0.2, 0.9), (0, 0, 0.5, 0.8660254038), (0.3, 0.3, 0.3))]


def test_instances_are_copies():
    """A mesh placed three times looks as three meshes do, and as EXT_mesh_gpu_instancing does."""
    pictures = []
    for how in ("copies", "shared", "gpu"):
        s = corners()
        body, material = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), s.diffuse((0.3, 0.6, 0.9))
        mesh = s.mesh(body, material)
        if how == "gpu":
            t, r, z = (s._accessor([p[i] for p in PLACES], kind) for i, kind in
                       enumerate(("VEC3", "VEC4", "VEC3")))
            s.used.add("EXT_mesh_gpu_instancing")
            s.node(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {
                "attributes": {"TRANSLATION": t, "ROTATION": r, "SCALE": z}}})
        for t, r, z in PLACES if how != "gpu" else ():
            s.node(mesh=mesh if how == "shared" else s.mesh(body, material), translation=list(t),
                   rotation=list(r), scale=list(z))
        pictures.append(render(s, (48, 48), 256, 4))
    copies, shared, gpu = pictures
    check("instances count", shared.stats["instances"] == copies.stats["instances"])
    for name, picture in (("instances", shared), ("EXT_mesh_gpu_instancing", gpu)):
        difference = np.abs(picture.rgb - copies.rgb).max(-1)
        # Single precision rounds both in its own way, which a sample at an edge may notice.
        check("%s look as copies do" % name, np.mean(difference > 2e-3) < 0.01,
              "%g of the pixels differ" % np.mean(difference > 2e-3))
        agrees("the mean of %s" % name, picture, copies.rgb, 0.002, power=False)


def test_strips_and_fans():
    """Triangle strips and fans, with and without indices, are the triangles that glTF says."""
    p = [(-1, -1, 0), (1, -1, 0), (-1, 0, 0.3), (1, 0, 0.3), (-1, 1, 0), (1, 1, 0.6)]
    fan = [(0, 0, 0.5), (-1, -1, 0), (1, -1, 0), (1, 1, 0.3), (-1, 1, 0)]
    cases = [(5, p, None, [(0, 1, 2), (1, 3, 2), (2, 3, 4), (3, 5, 4)]),
             (5, p, (2, 3, 4, 5, 0), [(2, 3, 4), (3, 5, 4), (4, 5, 0)]),
             (6, fan, None, [(1, 2, 0), (2, 3, 0), (3, 4, 0)]),
             (6, fan, (0, 2, 3, 4, 1), [(2, 3, 0), (3, 4, 0), (4, 1, 0)])]
    for number, (mode, points, order, triangles) in enumerate(cases):
        films = []
        for plain in (True, False):
            s = Scene()
            s.environment(radiance=0)
            primitive = {"attributes": {"POSITION": s._accessor(points, "VEC3")},
                         "material": s.emitter((1, 2, 3))}  # seen from the front alone
            if plain:
                primitive["indices"] = s._accessor(triangles, "SCALAR", 5125)
            else:
                primitive["mode"] = mode
                if order:
                    primitive["indices"] = s._accessor(order, "SCALAR", 5123)
            s.node(mesh=s._list("meshes", {"primitives": [primitive]}))
            s.camera(look_at((0.1, 0.2, 4), (0, 0, 0)), half_height=1.2)
            films.append(render(s, (24, 24), 4, 0).rgb)
        check("strips and fans %d" % number, films[0].any() and np.array_equal(*films))


def test_both_sides_are_shaded():
    """Geometry is never culled: an opaque surface scatters on both sides, single-sided or not."""
    for double in (False, True):
        for z in (2, -2):
            s = Scene()
            s.use_every_feature(at=(0, -20, 0))
            s.environment(radiance=0)
            s.add(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), s.diffuse(0.6, doubleSided=double))
            s.light("directional", np.pi, look_at((0, 0, z), (0, 0, 0)))
            s.camera(look_at((0, 0, z), (0, 0, 0)), half_height=0.5)
            near("from %+d, doubleSided %s" % (z, double), render(s, (8, 8), 32, 1).rgb, 0.6, 1e-5)


def test_nothing_leaks():
    """Inside a closed surface it is dark however bright it is outside, in its corners, too."""
    # Edges of 60 degrees, a tip of 20. A ray starts a hair off its surface (1e-5 m and more), and
    # may so start beyond the other side of an acute edge: that happens to one path in 10^4 at the
    # most.
    tips = [(0, 0, -3), (0.5, 0, 0), (-0.3, 0.4, 0), (-0.3, -0.4, 0)]
    needle = dict(positions=np.array(tips, float),
                  indices=np.array([(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]))
    cases = [("sphere", sphere(1, columns=24, rows=12), (0.3, 0.1, 0.2), (-1, 0, 0), 0),
             ("box", box((-1, -1, -1), (1, 1, 1)), (0, 0, 0.9), (-1, -1, -1), 0),
             ("sphere far away", sphere(1, (1000, 500, -700), 24, 12), (1000, 500, -700.3),
              (1001, 500, -700), 0),
             ("needle", needle, (0, 0, -0.1), (0, 0, -3), 1e-4)]
    for name, shape, eye, target, allowed in cases:
        for placed in (False, True):
            s = Scene()
            s.environment(radiance=1e6)
            mesh = s.mesh(inside_out(shape), s.diffuse(0.9))
            s.node(mesh=mesh)
            if placed:  # an instance, in its own space
                s.node(move(0, 1e4, 0), mesh=mesh)
            s.camera(look_at(eye, target, up=(0, 1, 0.01)), yfov=110)
            picture = render(s, (48, 48), 64, 8)
            leaks = np.count_nonzero(picture.rgb.any(-1))
            check("a closed %s%s" % (name, ", placed twice" if placed else ""),
                  picture.rgb.mean() <= allowed * 1e6, "%d pixels are lit, %g of what is outside" %
                  (leaks, picture.rgb.mean() / 1e6))


if __name__ == "__main__":
    main(test_normals_of_stretched_spheres, test_instances_are_copies, test_strips_and_fans,
         test_both_sides_are_shaded, test_nothing_leaks)
