"""The pose of a glTF file at a time, worked out from its bytes and the specification alone.

    pose = Posed("Fox.glb", time=0.5, animation=2)
    pose.triangles        corners in the world, n x 3 x 3
    pose.normals          of the corners, likewise; None where the file has none
"""
import base64
import json
import os
import struct

import numpy as np

TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
FULL = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read(path):
    """(json, list of buffers)"""
    with open(path, "rb") as file:
        data = file.read()
    chunk = None
    if data[:4] == b"glTF":
        length = struct.unpack_from("<I", data, 12)[0]
        root = json.loads(data[20:20 + length])
        chunk = data[28 + length:]
    else:
        root = json.loads(data)
    buffers = []
    for entry in root.get("buffers", []):
        uri = entry.get("uri")
        if uri is None:
            buffers.append(chunk)
        elif uri.startswith("data:"):
            buffers.append(base64.b64decode(uri.split(",", 1)[1]))
        else:
            with open(os.path.join(os.path.dirname(path), uri), "rb") as file:
                buffers.append(file.read())
    return root, buffers


def quaternion_matrix(q):
    """By the product q (0, v) q* on the three axes, which is the definition."""
    x, y, z, w = np.asarray(q, float) / np.linalg.norm(q)
    left = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    right = np.array([[w, -z, y, -x], [z, w, -x, -y], [-y, x, w, -z], [x, y, z, w]])
    return (left @ right)[:3, :3]


def slerp(a, b, t):
    """As a rotation by a part of the angle, in the plane of both."""
    a, b = (np.asarray(v, float) / np.linalg.norm(v) for v in (a, b))
    if a @ b < 0:
        b = -b
    across = b - (a @ b) * a
    if np.linalg.norm(across) < 1e-9:
        return a
    across /= np.linalg.norm(across)
    angle = np.arctan2(b @ across, a @ b) * t
    return np.cos(angle) * a + np.sin(angle) * across


class Posed:
    def __init__(self, path, time=None, animation=0):
        self.root, self.buffers = read(path)
        self.nodes = [dict(n) for n in self.root["nodes"]]
        if time is not None:
            for channel in self.root["animations"][animation]["channels"]:
                self._animate(self.root["animations"][animation], channel, time)
        self._place()
        triangles, normals = [], []
        for i, node in enumerate(self.nodes):
            if "mesh" in node and self.world[i] is not None:
                for primitive in self.root["meshes"][node["mesh"]]["primitives"]:
                    p, n, corners = self._primitive(i, node, primitive)
                    triangles.append(p[corners])
                    normals.append(None if n is None else n[corners])
        self.triangles = np.concatenate(triangles)
        self.normals = None if any(n is None for n in normals) else np.concatenate(normals)

    # --- Data.

    def view(self, index, offset, count, width, component):
        entry = self.root["bufferViews"][index]
        dtype = np.dtype(TYPES[component])
        stride = entry.get("byteStride", width * dtype.itemsize)
        start = entry.get("byteOffset", 0) + offset
        data = self.buffers[entry["buffer"]]
        return np.stack([np.frombuffer(data, dtype, width, start + k * stride)
                         for k in range(count)])

    def accessor(self, index):
        a = self.root["accessors"][index]
        width, component = WIDTH[a["type"]], a["componentType"]
        values = np.zeros((a["count"], width))
        if "bufferView" in a:
            values[:] = self.view(a["bufferView"], a.get("byteOffset", 0), a["count"], width,
                                  component)
        if "sparse" in a:
            s = a["sparse"]
            where = self.view(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0),
                              s["count"], 1, s["indices"]["componentType"])[:, 0]
            values[where] = self.view(s["values"]["bufferView"], s["values"].get("byteOffset", 0),
                                      s["count"], width, component)
        if a.get("normalized"):
            values = np.maximum(values / FULL[component], -1)
        return values

    # --- Animation: appendix C of the specification.

    def _animate(self, animation, channel, time):
        sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
        path = target["path"]
        times = self.accessor(sampler["input"])[:, 0]
        mode = sampler.get("interpolation", "LINEAR")
        keys = self.accessor(sampler["output"]).ravel().reshape(len(times), -1)
        if mode == "CUBICSPLINE":
            incoming, keys, outgoing = np.split(keys, 3, 1)
        time = min(max(time, times[0]), times[-1])
        k = max(int(np.searchsorted(times, time, side="right")) - 1, 0)
        last = k == len(times) - 1
        t = 0.0 if last else (time - times[k]) / (times[k + 1] - times[k])
        if mode == "STEP" or last:
            value = keys[k]
        elif mode == "CUBICSPLINE":
            # The cubic that has these values and these slopes at both ends, solved for.
            d = times[k + 1] - times[k]
            system = np.array([[0, 0, 0, 1], [1, 1, 1, 1], [0, 0, 1, 0], [3, 2, 1, 0]], float)
            ends = np.stack([keys[k], keys[k + 1], d * outgoing[k], d * incoming[k + 1]])
            value = np.array([t ** 3, t ** 2, t, 1]) @ np.linalg.solve(system, ends)
        elif path == "rotation":
            value = slerp(keys[k], keys[k + 1], t)
        else:
            value = (1 - t) * keys[k] + t * keys[k + 1]
        node = self.nodes[target["node"]]
        node.pop("matrix", None)
        node[path] = value

    # --- Nodes.

    def local(self, node):
        if "matrix" in node:
            return np.array(node["matrix"], float).reshape(4, 4).T
        out = np.eye(4)
        out[:3, :3] = quaternion_matrix(node.get("rotation", (0, 0, 0, 1)))
        out[:3, :3] *= np.asarray(node.get("scale", (1, 1, 1)), float)
        out[:3, 3] = node.get("translation", (0, 0, 0))
        return out

    def _place(self):
        self.world = [None] * len(self.nodes)

        def walk(i, above):
            self.world[i] = above @ self.local(self.nodes[i])
            for child in self.nodes[i].get("children", []):
                walk(child, self.world[i])

        for i in self.root["scenes"][self.root.get("scene", 0)]["nodes"]:
            walk(i, np.eye(4))

    # --- Vertices.

    def _primitive(self, index, node, primitive):
        attributes = primitive["attributes"]
        p = self.accessor(attributes["POSITION"])
        n = self.accessor(attributes["NORMAL"]) if "NORMAL" in attributes else None
        mesh = self.root["meshes"][node["mesh"]]
        weights = node.get("weights", mesh.get("weights", []))
        for weight, target in zip(weights, primitive.get("targets", [])):
            if "POSITION" in target:
                p = p + weight * self.accessor(target["POSITION"])
            if "NORMAL" in target and n is not None:
                n = n + weight * self.accessor(target["NORMAL"])
        to = np.broadcast_to(self.world[index], (len(p), 4, 4))
        if "skin" in node and "JOINTS_0" in attributes:
            to = self._skin(self.root["skins"][node["skin"]], attributes)
        p = np.einsum("vrc,vc->vr", to[:, :3, :3], p) + to[:, :3, 3]
        if n is not None:
            n = np.einsum("vcr,vc->vr", np.linalg.inv(to[:, :3, :3]), n)
            n /= np.linalg.norm(n, axis=-1, keepdims=True)
        if "indices" in primitive:
            corners = self.accessor(primitive["indices"])[:, 0].astype(int)
        else:
            corners = np.arange(len(p))
        return p, n, corners.reshape(-1, 3)

    def _skin(self, skin, attributes):
        bind = np.tile(np.eye(4), (len(skin["joints"]), 1, 1))
        if "inverseBindMatrices" in skin:
            bind = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        matrices = np.stack([self.world[j] @ b for j, b in zip(skin["joints"], bind)])
        total = 0
        for number in range(sum(name.startswith("JOINTS_") for name in attributes)):
            joints = self.accessor(attributes["JOINTS_%d" % number]).astype(int)
            weights = self.accessor(attributes["WEIGHTS_%d" % number])
            total = total + np.einsum("vk,vkrc->vrc", weights, matrices[joints])
        return total / total[:, 3:, 3:]


def nearest(points, triangles):
    """Of each point the distance to the nearest triangle, which one, and the point's barycentric
    coordinates in it (n x 3), clamped to the triangle."""
    a, b, c = (triangles[:, k] for k in range(3))
    edges = (b - a, c - a)
    g = np.array([[np.sum(u * v, -1) for v in edges] for u in edges])
    det = g[0, 0] * g[1, 1] - g[0, 1] ** 2
    best = (np.full(len(points), np.inf), np.zeros(len(points), int), np.zeros((len(points), 3)))
    for i, point in enumerate(points):
        d = point - a
        r = [np.sum(d * e, -1) for e in edges]
        with np.errstate(divide="ignore", invalid="ignore"):
            v = (g[1, 1] * r[0] - g[0, 1] * r[1]) / det
            w = (g[0, 0] * r[1] - g[0, 1] * r[0]) / det
        v = np.clip(np.nan_to_num(v), 0, 1)
        w = np.clip(np.nan_to_num(w), 0, 1)
        over = np.maximum(v + w, 1)
        v, w = v / over, w / over
        off = np.linalg.norm(d - v[:, None] * edges[0] - w[:, None] * edges[1], axis=-1)
        k = int(np.argmin(off))
        best[0][i], best[1][i], best[2][i] = off[k], k, (1 - v[k] - w[k], v[k], w[k])
    return best
