"""Scenes that move: animations, skins and targets, and runs that are refused."""
import numpy as np

from .render import Failed, run
from .scene import FLOAT, Scene
from .verdict import check

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5126: "<f4"}


class Moving(Scene):
    """A scene with animations, skins and targets, of any component type."""

    def values(self, values, kind, component=FLOAT, normalized=False, **more):
        """An accessor; of integers, `values` are what is stored."""
        array = np.ascontiguousarray(values, COMPONENTS[component])
        rows = array.reshape(-1, {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind])
        self.data += b"\0" * (-len(self.data) % 4)
        view = self._list("bufferViews", {"buffer": 0, "byteOffset": len(self.data),
                                          "byteLength": array.nbytes})
        self.data += array.tobytes()
        entry = dict(more, bufferView=view, componentType=component, count=len(rows), type=kind)
        if normalized:
            entry["normalized"] = True
        return self._list("accessors", entry)

    def bounded(self, values, kind, **more):
        rows = np.asarray(values, np.float32).reshape(-1, 1 if kind == "SCALAR" else 3)
        return self.values(values, kind, min=[float(v) for v in rows.min(0)],
                           max=[float(v) for v in rows.max(0)], **more)

    def sparse(self, count, where, values):
        """Positions that are 0 but for a few."""
        index = self.values(np.asarray(where), "SCALAR", 5121)
        value = self.values(values, "VEC3")
        accessors = self.json["accessors"]
        full = np.zeros((count, 3), np.float32)
        full[where] = values
        entry = {"componentType": FLOAT, "count": count, "type": "VEC3",
                 "min": [float(v) for v in full.min(0)], "max": [float(v) for v in full.max(0)],
                 "sparse": {"count": len(where),
                            "indices": {"bufferView": accessors[index]["bufferView"],
                                        "componentType": 5121},
                            "values": {"bufferView": accessors[value]["bufferView"]}}}
        del accessors[-2:]
        return self._list("accessors", entry)

    def animation(self, name=None):
        return self._list("animations", {"channels": [], "samplers": [],
                                         **({"name": name} if name else {})})

    def channel(self, target, times, output, mode=None, animation=0):
        """`target`: (node, path), or a JSON pointer."""
        entry = self.json["animations"][animation]
        sampler = {"input": self.bounded(times, "SCALAR"), "output": output}
        if mode:
            sampler["interpolation"] = mode
        if isinstance(target, str):
            self.used.add("KHR_animation_pointer")
            where = {"path": "pointer",
                     "extensions": {"KHR_animation_pointer": {"pointer": target}}}
        else:
            where = {"node": target[0], "path": target[1]}
        entry["samplers"].append(sampler)
        entry["channels"].append({"sampler": len(entry["samplers"]) - 1, "target": where})


def turned(degrees, axis=(0, 0, 1)):
    half = np.radians(degrees) / 2
    return [*(np.sin(half) * np.asarray(axis, float) / np.linalg.norm(axis)), np.cos(half)]


def refused(what, arguments, statuses, *words):
    """A run that ends with one of these statuses, and one line with all these words."""
    try:
        run(*arguments)
        check(what, False, "it succeeded")
    except Failed as failed:
        line = failed.message.strip()
        check(what, failed.status in statuses and "\n" not in line and all(w in line for w in words),
              "%d: %s" % (failed.status, line))
