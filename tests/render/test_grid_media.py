#!/usr/bin/env python3
"""Media whose density a grid gives, as whole pictures: files, placing, flights, shadows, emission
and boundaries against integrals over the dense arrays."""
import numpy as np

from support.render import render
from support.scene import Scene
from support.shapes import box, look_at, move, quad
from support.vdb import vdb_uri
from support.verdict import agrees, main, near

RED = np.array((0.3, 0.8, 1.7))
SIZE = (20, 12, 28)


def rotation(axis, degrees):
    """Rodrigues'."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross, angle = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0))), np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def noise(seed, empty=0.0):
    random = np.random.default_rng(seed)
    return (random.random(SIZE) * (random.random(SIZE) >= empty)).astype(np.float32)


def value(array, r):
    """Trilinear between centres, as the outermost beyond, 0 outside of the voxels."""
    r, size = np.asarray(r, float), np.array(array.shape[:3])
    inside = np.all((r >= -0.5) & (r <= size - 0.5), -1)
    r = np.clip(r, 0, size - 1)
    low = np.minimum(r.astype(int), np.maximum(size - 2, 0))
    part, total = r - low, 0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, part, 1 - part), -1)
        x, y, z = np.minimum(low + corner, size - 1).T
        total = total + weight * array[x, y, z]
    return np.where(inside, total, 0)


def along(array, to_index, start, end, steps=20000):
    """Densities between two points of the world, at the middles of equal steps."""
    t = (np.arange(steps) + 0.5)[:, None] / steps
    points = np.asarray(start) + t * (np.asarray(end) - np.asarray(start))
    return value(array, points @ to_index[:3, :3].T + to_index[:3, 3])


def optical(array, to_index, start, end):
    """Metres of density 1."""
    length = np.linalg.norm(np.subtract(end, start))
    return along(array, to_index, start, end).mean() * length


def to_index(matrix, voxel):
    """World to index space of a file of that voxel size, in a node."""
    return np.linalg.inv(matrix @ np.diag([voxel, voxel, voxel, 1]))


def stage(sky):
    s = Scene()
    s.use_every_feature((0, 0, -60))
    s.environment(radiance=sky)
    return s


def shell(voxel=0.1):
    """A box that just holds the voxels."""
    return box(tuple(-0.5 * voxel - 1e-4 for n in SIZE),
               tuple((n - 0.5) * voxel + 1e-4 for n in SIZE))


def filled(s, grids, voxel=0.1, matrix=None, grid=None, shape=None, **medium):
    """A box with a medium of these grids in a node."""
    entry = dict(grid or {}, uri=vdb_uri(grids, voxel))
    for name in grids:
        entry[name] = name
    material = s.interface(dict(medium, grid=entry))
    s.add(shape or shell(voxel), material, matrix)


def needle(s, start, end, spp, depth=0, size=(8, 8), **options):
    """A picture of one ray."""
    s.camera(look_at(start, end), half_height=1e-5)
    last = len(s.json["cameras"]) - 1
    return render(s, size, spp, depth, options=("--camera", str(last)), **options)


NODES = (("at rest", np.eye(4)), ("moved and turned", move(1, -2, 0.5) @ rotation((1, 2, 3), 40)),
         ("scaled and mirrored", move(0.3, 0, 0) @ np.diag([1.5, -0.7, 1, 1])))


def test_transmittance():
    """Absorption alone, along one ray; also between two other grids, so that numbers differ."""
    density = noise(1, 0.5)
    for name, matrix in NODES:
        s = stage((1, 2, 3))
        filled(s, {"density": noise(2)}, matrix=move(50, 0, 0), absorption=[1, 1, 1])
        filled(s, {"density": density, "color": np.ones(SIZE + (3,))}, matrix=matrix,
               absorption=list(RED))
        start, end = ((matrix @ (*p, 1))[:3] for p in ((-1, 0.2, -0.3), (2.6, 0.9, 3.3)))
        want = (1, 2, 3) * np.exp(-RED * optical(density, to_index(matrix, 0.1), start, end))
        agrees("transmittance of a grid " + name, needle(s, start, end, 4096), want, 0.01)


def test_camera_inside():
    density = noise(3)
    start, end = np.array((0.9, 0.5, 1.2)), np.array((3.5, 1.4, 0.1))
    s = stage(1)
    filled(s, {"density": density}, absorption=list(RED))
    want = np.exp(-RED * optical(density, to_index(np.eye(4), 0.1), start, end))
    agrees("a camera in a grid", needle(s, start, end, 4096), want, 0.01)


def test_bounds():
    """Bounds reach to the outer faces of the outer voxels, whatever the file's voxels are."""
    density, low, high = noise(4), np.array((-1, 0, 2)), np.array((1, 3, 2.5))
    s = stage(1)
    filled(s, {"density": density}, absorption=list(RED), shape=box(low - 1e-4, high + 1e-4),
           grid={"bounds": [low.tolist(), high.tolist()]})
    place = np.eye(4)
    place[:3, :3] = np.diag(SIZE / (high - low))
    place[:3, 3] = -low * SIZE / (high - low) - 0.5
    start, end = np.array((-1.5, -0.5, 1.9)), np.array((1.2, 3.5, 2.6))
    want = np.exp(-RED * optical(density, place, start, end))
    agrees("a grid in bounds", needle(s, start, end, 4096), want, 0.01)


def test_shadow():
    """Light through a grid to a plane, direct light alone."""
    density = noise(5, 0.3)
    spot, lamp = np.array((1.0, 0.6, -1)), np.array((0.7, 0.4, 4))
    for kind, matrix in (("point", move(*lamp)), ("directional", look_at(lamp, spot))):
        s = stage(0)
        s.add(quad((0, 0, -1), (0, 50, 0), (-50, 0, 0)), s.diffuse(0.5))
        filled(s, {"density": density}, absorption=list(RED), scattering=[1, 1, 1])
        s.light(kind, 30, matrix)
        away = np.linalg.norm(lamp - spot)
        light = 30 * (lamp - spot)[2] / away / (away ** 2 if kind == "point" else 1)
        want = 0.5 / np.pi * light * np.exp(
            -(RED + 1) * optical(density, to_index(np.eye(4), 0.1), spot, lamp))
        picture = needle(s, spot + (0, 0, 0.5), spot, 4096, 1)
        agrees("%s light through a grid" % kind, picture, want, 0.02)


def inside(start, direction, voxel=0.1):
    """Where a ray of a resting grid enters and leaves its voxels, in lengths of `direction`."""
    faces = (np.array(((-0.5,) * 3, np.array(SIZE) - 0.5)) * voxel - start) / direction
    return faces.min(0).max(), faces.max(0).min()


def test_single_scattering():
    """One event under a distant light: the integral over the ray of what is scattered."""
    density, color = noise(6, 0.3), np.random.default_rng(7).random(SIZE + (3,), np.float32)
    place, scattering, steps = to_index(np.eye(4), 0.1), np.array((0.5, 1, 2)), 1000
    start, end, to_light = np.array((1.0, 0.6, 3.2)), np.array((0.8, 0.7, -0.3)), (0.6, 1e-9, 0.8)
    s = stage(0)
    filled(s, {"density": density, "color": color}, scattering=list(scattering),
           absorption=list(RED))
    s.light("directional", 5, look_at((3, 0, 4), (0, 0, 0)))
    first, last = inside(start, end - start)
    t = first + (np.arange(steps) + 0.5)[:, None] / steps * (last - first)
    way = start + t * (end - start)
    step = np.linalg.norm(end - start) * (last - first) / steps
    there = value(density, way @ place[:3, :3].T + place[:3, 3])
    before = np.cumsum(there) * step - 0.5 * there * step
    want = np.zeros(3)
    for point, rho, depth in zip(way, there, before):
        away = inside(point, np.array(to_light))[1]
        lit = along(density, place, point, point + np.array(to_light) * away, 500).mean() * away
        tint = np.array([along(color[..., c], place, point, point, 1)[0] for c in range(3)])
        want += np.exp(-(scattering + RED) * (depth + lit)) * scattering * tint * rho * step
    picture = needle(s, start, end, 16384, 1)
    agrees("single scattering in a coloured grid", picture, want * 5 / (4 * np.pi), 0.01)


def test_white_grid():
    """Where nothing is absorbed a white sky stays white, whatever is in front of it."""
    for g in (0, 0.8, -0.5):
        for name, scattering, spp in (("grey", (3, 3, 3), 128), ("coloured", (2, 4, 6), 1024)):
            s = stage(1)
            filled(s, {"density": noise(8, 0.5)}, scattering=scattering,
                   phase={"type": "hg", "g": g}, matrix=rotation((1, 1, 0), 30))
            s.camera(look_at((4, 3, 6), (1, 0.6, 1.4)), yfov=25)
            picture = render(s, (24, 24), spp, 1000)
            agrees("a white %s grid, g %g" % (name, g), picture, 1, 0.003)


def test_constant_emission():
    """A grid of 1 is a medium that is the same everywhere."""
    s = stage(0)
    filled(s, {"density": np.ones(SIZE)}, absorption=list(RED), emission=[1, 2, 3])
    picture = needle(s, (1, 0.5, 5), (1, 0.5, 0), 4096)
    want = (1, 2, 3) * (1 - np.exp(-RED * 2.8)) / RED
    agrees("a glowing grid", picture, want, 0.005)


def test_temperature():
    """A black body of 1500 K has the luminance 1; temperatureScale makes kelvins of the grid."""
    s = stage(0)
    filled(s, {"density": noise(9, 0.5), "temperature": np.full(SIZE, 0.5)}, emission=[1, 1, 1],
           grid={"temperatureScale": 3000})
    picture = needle(s, (1, 0.5, 5), (1, 0.5, 0), 64)
    luminance = picture.rgb.mean((0, 1)) @ (0.2126, 0.7152, 0.0722)
    near("the luminance of 1500 K", luminance / 2.8, 1, 0.01)


def test_parts_of_a_surface():
    """A box of two primitives of one node is one body: what goes in by one comes out by the
    other."""
    density, hull = noise(10), shell()
    means = []
    for cut in (None, 6):
        s = stage(1)
        material = s.interface({"absorption": [1, 1, 1], "grid": {
            "uri": vdb_uri({"density": density}, 0.1), "density": "density"}})
        mesh = s.mesh(dict(hull, indices=hull["indices"][:cut]), material)
        if cut:
            rest = s.mesh(dict(hull, indices=hull["indices"][cut:]), material)
            s.json["meshes"][mesh]["primitives"] += s.json["meshes"].pop(rest)["primitives"]
        s.node(mesh=mesh)
        picture = needle(s, (-1, 0.6, 1.3), (3, 0.5, 1.4), 1024)
        means.append(picture.rgb.mean((0, 1)))
    near("a grid behind a surface of two parts", means[1] / means[0], (1, 1, 1), 0.02)


main(test_transmittance, test_camera_inside, test_bounds, test_shadow, test_single_scattering,
     test_white_grid, test_constant_emission, test_temperature,
     test_parts_of_a_surface)
