"""Scenes as glTF files with all data in data: URIs.

    s = Scene()
    s.add(quad(…), s.diffuse(0.5), move(0, 1, 0))
    s.camera(look_at(…), yfov=40)
    s.write("name.gltf")
"""
import base64
import json

import numpy as np

from .images import exr_bytes, png_bytes
from .shapes import move, quad

FLOAT, USHORT, UINT = 5126, 5123, 5125
REPEAT, MIRROR, CLAMP = 10497, 33648, 33071
NEAREST, LINEAR = 9728, 9729
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def _uri(kind, data):
    return "data:%s;base64,%s" % (kind, base64.b64encode(data).decode())


def rgb(value):
    return [float(v) for v in np.broadcast_to(value, 3)]


class Scene:
    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        self.used = set()

    # --- Parts of the file.

    def _list(self, name, entry):
        entries = self.json.setdefault(name, [])
        entries.append(entry)
        return len(entries) - 1

    def _extension(self, owner, name, value):
        self.used.add(name)
        owner.setdefault("extensions", {})[name] = value
        return value

    def _accessor(self, values, kind, component=FLOAT):
        dtype = {FLOAT: "<f4", USHORT: "<u2", UINT: "<u4"}[component]
        array = np.ascontiguousarray(values, dtype).reshape(-1, WIDTH[kind])
        self.data += b"\0" * (-len(self.data) % 4)
        view = self._list("bufferViews", {"buffer": 0, "byteOffset": len(self.data),
                                          "byteLength": array.nbytes})
        self.data += array.tobytes()
        entry = {"bufferView": view, "componentType": component, "count": len(array), "type": kind}
        if kind == "VEC3" and component == FLOAT:
            entry["min"] = [float(v) for v in array.min(0)]
            entry["max"] = [float(v) for v in array.max(0)]
        return self._list("accessors", entry)

    # --- Materials. Each returns its index.

    def material(self, cdl=None, medium=None, base=None, metallic=None, roughness=None,
                 emission=None, **members):
        """A glTF material; `cdl` and `medium` are the extensions, `members` go in as they are."""
        entry = dict(members)
        pbr = entry.setdefault("pbrMetallicRoughness", {})
        if base is not None:
            alpha = float(base[3]) if np.size(base) == 4 else 1.0
            pbr["baseColorFactor"] = rgb(base if np.size(base) < 4 else base[:3]) + [alpha]
        if metallic is not None:
            pbr["metallicFactor"] = metallic
        if roughness is not None:
            pbr["roughnessFactor"] = roughness
        if emission is not None:
            strength = max(1.0, float(np.max(emission)))
            entry["emissiveFactor"] = rgb(np.asarray(emission) / strength)
            self._extension(entry, "KHR_materials_emissive_strength",
                            {"emissiveStrength": strength})
        if cdl:
            self._extension(entry, "CDL_material", cdl)
        if medium:
            self._extension(entry, "CDL_medium", medium)
        for name in entry.get("extensions", {}):
            self.used.add(name)
        return self._list("materials", entry)

    def diffuse(self, reflectance, **more):
        return self.material({"model": "diffuse", "reflectance": rgb(reflectance)}, **more)

    def emitter(self, radiance, **more):
        """Black but for what it emits."""
        return self.diffuse(0, emission=radiance, **more)

    def interface(self, medium=None):
        return self.material({"model": "interface"}, medium)

    def unlit(self, color=(1, 1, 1, 1), texture=None, **more):
        self.used.add("KHR_materials_unlit")
        more.setdefault("extensions", {})["KHR_materials_unlit"] = {}
        pbr = {"baseColorTexture": texture} if texture else {}
        return self.material(base=color, pbrMetallicRoughness=pbr, **more)

    def texture(self, pixels, wrap=(REPEAT, REPEAT), nearest=False, uv=0, transform=None, **more):
        """A textureInfo of an image of 8 or 16 bits, height x width x 3 or 4."""
        image = self._list("images", {"uri": _uri("image/png", png_bytes(pixels))})
        sampler = self._list("samplers", {"wrapS": wrap[0], "wrapT": wrap[1],
                                          "magFilter": NEAREST if nearest else LINEAR})
        info = dict(more, index=self._list("textures", {"source": image, "sampler": sampler}))
        if uv:
            info["texCoord"] = uv
        if transform:
            self._extension(info, "KHR_texture_transform", transform)
        return info

    # --- What stands in the scene.

    def mesh(self, shape, material):
        attributes = {"POSITION": self._accessor(shape["positions"], "VEC3")}
        for name, key, kind in (("NORMAL", "normals", "VEC3"), ("TEXCOORD_0", "uv0", "VEC2"),
                                ("TEXCOORD_1", "uv1", "VEC2"), ("COLOR_0", "colors", "VEC4"),
                                ("TANGENT", "tangents", "VEC4")):
            if key in shape:
                attributes[name] = self._accessor(shape[key], kind)
        primitive = {"attributes": attributes, "material": material,
                     "indices": self._accessor(shape["indices"], "SCALAR", UINT)}
        return self._list("meshes", {"primitives": [primitive]})

    def node(self, matrix=None, root=True, **members):
        entry = dict(members)
        if matrix is not None:
            entry["matrix"] = [float(v) for v in np.asarray(matrix, float).T.ravel()]
        index = self._list("nodes", entry)
        if root:
            self.json["scenes"][0]["nodes"].append(index)
        return index

    def add(self, shape, material, matrix=None):
        """A shape of its own; returns the node."""
        return self.node(matrix, mesh=self.mesh(shape, material))

    def camera(self, matrix, yfov=None, half_height=None, name="", aspect=1.0, **lens):
        """Perspective with yfov in degrees, or orthographic; `lens`: members of CDL_camera."""
        if half_height is None:
            entry = {"type": "perspective", "name": name,
                     "perspective": {"yfov": float(np.radians(yfov)), "znear": 0.01,
                                     "aspectRatio": aspect}}
        else:
            entry = {"type": "orthographic", "name": name,
                     "orthographic": {"xmag": half_height * aspect, "ymag": half_height,
                                      "znear": 0.01, "zfar": 1000.0}}
        if lens:
            self._extension(entry, "CDL_camera", lens)
        return self.node(matrix, camera=self._list("cameras", entry))

    def light(self, kind, color, matrix=None, **more):
        """KHR_lights_punctual, shining along the node's -Z; `color` includes the intensity."""
        strength = max(float(np.max(color)), 1e-30)
        entry = dict(more, type=kind, intensity=strength, color=rgb(np.asarray(color) / strength))
        self.used.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual",
                                                                   {"lights": []})["lights"]
        lights.append(entry)
        return self.node(matrix, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def environment(self, radiance=None, image=None, **more):
        """A constant one, or a latitude-longitude image: height x width x 3."""
        value = dict(more)
        if radiance is not None:
            value["radiance"] = rgb(radiance)
        if image is not None:
            value["uri"] = _uri("application/octet-stream", exr_bytes(image))
        self._extension(self.json["scenes"][0], "CDL_environment", value)

    def medium(self, **value):
        """What fills the scene."""
        self._extension(self.json["scenes"][0], "CDL_medium", value)

    def use_every_feature(self, at=(0, -4, 0)):
        """Has kernels compiled as they are for a scene that has everything, so that many scenes
        share one compilation. What is added is a millimetre across, of no power, and out of
        sight at `at`. It is not far away: the power of a sky grows with the size of the scene."""
        tiny = quad((0, 0, 0), (1e-3, 0, 0), (0, 0, 1e-3))
        white = np.full((1, 1, 4), 255, np.uint8)
        colored = dict(tiny, colors=np.ones((len(tiny["positions"]), 4)))
        glow = self.material(base=(1, 1, 1), emission=1e-6, emissiveTexture=self.texture(white),
                             pbrMetallicRoughness={"baseColorTexture": self.texture(white)})
        place = move(*at)
        self.add(colored, glow, place)
        self.add(tiny, self.interface({"absorption": [1, 1, 1]}), place @ move(0.01, 0, 0))
        leaf = self.material(alphaMode="BLEND", base=(0, 0, 0, 0.5))
        self.add(tiny, leaf, place @ move(0.02, 0, 0))
        self.light("point", 0, place)

    def write(self, path):
        root = dict(self.json)
        root["buffers"] = [{"byteLength": len(self.data),
                            "uri": _uri("application/octet-stream", self.data)}]
        if self.used:
            root["extensionsUsed"] = sorted(self.used)
        with open(path, "w") as file:
            json.dump(root, file)
        return path
