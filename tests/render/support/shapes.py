"""Geometry for test scenes: dicts with `positions` (N x 3), `indices` (M x 3, counter-clockwise
seen from the front) and perhaps `normals`, `uv0`, `uv1`, `colors`; and 4 x 4 matrices."""
import numpy as np


def move(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def scale(x, y=None, z=None):
    return np.diag([x, x if y is None else y, x if z is None else z, 1.0])


def turn(axis, degrees):
    """Right-handed about an axis (Rodrigues)."""
    a = np.array(axis, float) / np.linalg.norm(axis)
    angle = np.radians(degrees)
    cross = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    m = np.eye(4)
    m[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return m


def look_at(eye, target, up=(0, 1, 0)):
    """Of a node that looks along its -Z from eye to target, as cameras and lights do."""
    eye, z = np.array(eye, float), np.array(eye, float) - np.array(target, float)
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    m = np.eye(4)
    m[:3, :4] = np.stack([x, np.cross(z, x), z, eye], 1)
    return m


def quad(center, half_u, half_v, columns=1, rows=1):
    """A rectangle; its front is towards half_u x half_v. uv0 runs from 0 to 1 along half_u and,
    as in glTF, downwards against half_v."""
    c, u, v = (np.array(a, float) for a in (center, half_u, half_v))
    s, t = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    s, t = s.ravel(), t.ravel()
    positions = c + np.outer(2 * s - 1, u) + np.outer(1 - 2 * t, v)
    indices = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b = a + columns + 1
            indices += [(a, b, b + 1), (a, b + 1, a + 1)]
    return dict(positions=positions, indices=np.array(indices), uv0=np.stack([s, t], 1))


def joined(*shapes):
    """One shape of several that have positions and indices alone in common."""
    positions, indices, first = [], [], 0
    for s in shapes:
        positions.append(s["positions"])
        indices.append(np.asarray(s["indices"]) + first)
        first += len(s["positions"])
    return dict(positions=np.concatenate(positions), indices=np.concatenate(indices))


def box(low, high):
    """Closed, its front outside, flat."""
    low, high = np.array(low, float), np.array(high, float)
    c, h = (low + high) / 2, (high - low) / 2
    x, y, z = np.diag(h)
    return joined(quad(c + x, y, z), quad(c - x, z, y), quad(c + y, z, x), quad(c - y, x, z),
                  quad(c + z, x, y), quad(c - z, y, x))


def sphere(radius=1.0, center=(0, 0, 0), columns=32, rows=16, smooth=False):
    """Latitudes and longitudes, closed, its front outside."""
    theta = np.pi * np.arange(1, rows) / rows
    phi = 2 * np.pi * np.arange(columns) / columns
    ring = np.stack([np.outer(np.sin(theta), np.cos(phi)),
                     np.repeat(np.cos(theta)[:, None], columns, 1),
                     np.outer(np.sin(theta), -np.sin(phi))], -1).reshape(-1, 3)
    points = np.concatenate([[(0, 1, 0)], ring, [(0, -1, 0)]])
    south, indices = len(points) - 1, []
    for i in range(columns):
        k = (i + 1) % columns
        indices += [(0, 1 + i, 1 + k), (south, south - columns + k, south - columns + i)]
        for j in range(rows - 2):
            a, b = 1 + j * columns, 1 + (j + 1) * columns
            indices += [(a + i, b + i, b + k), (a + i, b + k, a + k)]
    shape = dict(positions=points * radius + np.array(center, float), indices=np.array(indices))
    if smooth:
        shape["normals"] = points
    return shape


def inside_out(shape):
    """The same surface with its front on the other side."""
    turned = dict(shape, indices=np.asarray(shape["indices"])[:, ::-1])
    if "normals" in shape:
        turned["normals"] = -np.asarray(shape["normals"])
    return turned
