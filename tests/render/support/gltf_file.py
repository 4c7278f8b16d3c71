"""Where a glTF file puts its triangles: read from the specification, apart from the renderer.

Triangles of the default scene at rest, in the world: node trees, instances
(EXT_mesh_gpu_instancing), skins. Morph targets are left out."""
import base64
import json
import os
import struct
from urllib.parse import unquote

import numpy as np

TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read_json(path):
    """(the JSON of a .gltf or .glb file, the binary chunk or None)"""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"glTF":
        return json.loads(data), None
    size = struct.unpack_from("<I", data, 12)[0]
    rest = data[20 + size:]
    return json.loads(data[20:20 + size]), rest[8:] or None


class File:
    """`instances`: one (world matrix or None, triangles M x 3 x 3) for each placed primitive;
    without a matrix the triangles are in the world already."""

    def __init__(self, path):
        self.path = path
        self.json, self.chunk = read_json(path)
        self.buffers = [self._buffer(b) for b in self.json.get("buffers", [])]
        self.world, self.instances = {}, []
        scene = self.json["scenes"][self.json.get("scene", 0)]
        for node in scene.get("nodes", []):
            self._place(node, np.eye(4))
        for number, matrix in sorted(self.world.items()):
            self._add(self.json["nodes"][number], matrix)

    def _buffer(self, entry):
        uri = entry.get("uri")
        if uri is None:
            return self.chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(os.path.dirname(self.path), unquote(uri)), "rb") as file:
            return file.read()

    def accessor(self, index):
        a = self.json["accessors"][index]
        dtype, width = np.dtype(TYPES[a["componentType"]]), WIDTHS[a["type"]]
        values = np.zeros((a["count"], width), dtype)
        if "bufferView" in a:
            view = self.json["bufferViews"][a["bufferView"]]
            stride = view.get("byteStride", width * dtype.itemsize)
            first = view.get("byteOffset", 0) + a.get("byteOffset", 0)
            values = np.ndarray((a["count"], width), dtype, self.buffers[view["buffer"]], first,
                                (stride, dtype.itemsize))
        assert "sparse" not in a, "sparse accessors are not read here"
        if a.get("normalized"):
            values = np.maximum(values / np.iinfo(dtype).max, -1)
        return values.astype(float)

    def _place(self, number, parent):
        node = self.json["nodes"][number]
        if "matrix" in node:
            local = np.array(node["matrix"], float).reshape(4, 4).T
        else:
            local = placed(node.get("translation", (0, 0, 0)), node.get("rotation", (0, 0, 0, 1)),
                           node.get("scale", (1, 1, 1)))
        self.world[number] = parent @ local
        for child in node.get("children", []):
            self._place(child, self.world[number])

    def _matrices(self, node, world):
        gpu = node.get("extensions", {}).get("EXT_mesh_gpu_instancing")
        if not gpu:
            return [world]
        given = {k: self.accessor(i) for k, i in gpu["attributes"].items()}
        count = len(next(iter(given.values())))
        parts = [given.get(k, np.broadcast_to(np.array(rest, float), (count, len(rest))))
                 for k, rest in (("TRANSLATION", (0, 0, 0)), ("ROTATION", (0, 0, 0, 1)),
                                 ("SCALE", (1, 1, 1)))]
        return [world @ placed(*trs) for trs in zip(*parts)]

    def _skinned(self, node, attributes, positions):
        """Joints alone place a skinned mesh, not its node (glTF 2.0, 3.7.3.3)."""
        skin = self.json["skins"][node["skin"]]
        joints = [self.world[j] for j in skin["joints"]]
        if "inverseBindMatrices" in skin:
            inverse = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4)
            joints = [j @ m.T for j, m in zip(joints, inverse)]
        which = self.accessor(attributes["JOINTS_0"]).astype(int)
        weights = self.accessor(attributes["WEIGHTS_0"])
        weights = weights / weights.sum(1, keepdims=True)
        blended = np.einsum("nk,nkij->nij", weights, np.array(joints)[which])
        return np.einsum("nij,nj->ni", blended, homogeneous(positions))[:, :3]

    def _add(self, node, world):
        if "mesh" not in node:
            return
        for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
            attributes = primitive["attributes"]
            positions = self.accessor(attributes["POSITION"])
            order = np.arange(len(positions))
            if "indices" in primitive:
                order = self.accessor(primitive["indices"])[:, 0].astype(int)
            corners = triangles(primitive.get("mode", 4), order)
            if "skin" in node and "JOINTS_0" in attributes:
                positions = self._skinned(node, attributes, positions)
                self.instances.append((None, positions[corners]))
                continue
            for matrix in self._matrices(node, world):
                self.instances.append((matrix, positions[corners]))

    def triangle_count(self):
        return sum(len(t) for _, t in self.instances)

    def bounds(self):
        """2 x 3"""
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for matrix, corners in self.instances:
            p = transformed(matrix, corners.reshape(-1, 3))
            low, high = np.minimum(low, p.min(0)), np.maximum(high, p.max(0))
        return np.array([low, high])


def placed(translation, rotation, scale):
    """The matrix of glTF's translation, rotation (a quaternion x, y, z, w) and scale."""
    x, y, z, w = np.array(rotation, float) / np.linalg.norm(rotation)
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, :3] = m[:3, :3] * np.array(scale, float)
    m[:3, 3] = translation
    return m


def triangles(mode, order):
    """M x 3 indices of corners; lines and points have none."""
    if mode == 4:
        return order[:len(order) // 3 * 3].reshape(-1, 3)
    n = np.arange(max(len(order) - 2, 0))
    if mode == 5:
        return order[np.stack([n, n + 1 + n % 2, n + 2 - n % 2], 1)]
    return order[np.stack([n * 0, n + 1, n + 2], 1)] if mode == 6 else np.zeros((0, 3), int)


def homogeneous(points):
    return np.concatenate([points, np.ones((len(points), 1))], 1)


def transformed(matrix, points):
    return points if matrix is None else (homogeneous(points) @ matrix.T)[:, :3]


def distance_to_triangles(point, corners):
    """From a point to the nearest of M triangles: to their planes where it is above them, to their
    edges where it is not."""
    a, b, c = (corners[:, k] for k in range(3))
    best = np.inf
    for p, q in ((a, b), (b, c), (c, a)):
        edge = q - p
        t = np.sum((point - p) * edge, 1) / np.maximum(np.sum(edge * edge, 1), 1e-300)
        near = p + np.clip(t, 0, 1)[:, None] * edge
        best = min(best, np.linalg.norm(point - near, axis=1).min())
    normal = np.cross(b - a, c - a)
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    height = np.abs(np.sum((point - a) * normal, 1)) / length
    inside = np.ones(len(a), bool)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.sum(np.cross(q - p, point - p) * normal, 1) >= 0
    return min(best, height[inside].min()) if inside.any() else best
