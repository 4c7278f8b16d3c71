#!/usr/bin/env python3
"""What moves and what switches: animation, skins, morph targets, pointers, visibility, variants.

Poses are worked out a second time by support/posed.py, from the file's bytes. The renderer's side
comes out of the position and normal layers of a picture: every point that it saw must lie on a
triangle of the pose, to 1e-4 of the size, and the pose must reach as far as the renderer says that
it does. Colours that an animation or a variant gives are seen on unlit squares, without noise."""
import json
import os

import numpy as np

from support.posed import Posed, nearest
from support.render import Failed, render, run, scratch
from support.scene import FLOAT, Scene
from support.shapes import look_at, move, quad, sphere
from support.verdict import check, main, near, skip

HERE = os.path.dirname(os.path.abspath(__file__))
ASSETS = os.path.abspath(os.path.join(HERE, "../../../shared/assets"))
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5126: "<f4"}
TO_CAMERA = np.array((0.55, 0.45, 1)) / np.linalg.norm((0.55, 0.45, 1))


def check_pose(what, path, time, animation=0, options=(), normals=True, size=(48, 48)):
    """A picture of a file at a time against the pose worked out here."""
    pose = Posed(path, time, animation)
    corners = pose.triangles.reshape(-1, 3)
    low, high = corners.min(0), corners.max(0)
    extent = np.linalg.norm(high - low)
    arguments = [] if time is None else ["--at", time]
    info = json.loads(run("info", path, "--json", *arguments, *options)[0])
    near("%s: bounds" % what, np.array(info["bounds"]), np.array([low, high]), 1e-4 * extent)
    picture = render(path, size, 1, 0, aov="position,normal,depth", options=[*arguments, *options])
    seen = np.isfinite(picture.layer("depth", "Z")[..., 0])
    points, turned = picture.layer("position", "XYZ")[seen], picture.layer("normal", "XYZ")[seen]
    check("%s: enough is seen" % what, len(points) > 60, "%d pixels" % len(points))
    off, which, weight = nearest(points, pose.triangles)
    check("%s: positions" % what, off.max() <= 1e-4 * extent,
          "off by %.3g of the size" % (off.max() / extent))
    if not normals:
        return
    if pose.normals is None:
        a, b, c = (pose.triangles[which, k] for k in range(3))
        want = np.cross(b - a, c - a)
    else:
        want = np.einsum("nk,nkc->nc", weight, pose.normals[which])
    want /= np.linalg.norm(want, axis=-1, keepdims=True)
    # Normals that a path sees from behind are bent towards it, so only those count that face the
    # framing camera. Where two triangles meet the nearest may be the neighbour: a few may differ.
    facing = want @ TO_CAMERA > 0.45
    agree = np.sum(want * turned, -1)[facing] > 1 - 1e-4
    check("%s: normals" % what, agree.mean() > 0.98, "%.1f %% agree" % (100 * agree.mean()))


def test_assets():
    """The skinned files of others, at several times, before and after their keys."""
    for name, poses in (("CesiumMan.glb", ((None, 0), (0.0, 0), (0.7, 0), (1.95, 0), (9.0, 0))),
                        ("Fox.glb", ((None, 0), (1.3, 0), (0.4, 1), (0.45, 2))),
                        ("SimpleSkin/SimpleSkin.gltf", ((0.5, 0), (1.7, 0), (4.0, 0), (9.0, 0)))):
        path = os.path.join(ASSETS, name)
        if not os.path.exists(path):
            skip(name, "the shared folder is not here")
            continue
        for time, animation in poses:
            options = [] if time is None else ["--animation", animation]
            check_pose("%s at %s of %d" % (name, time, animation), path, time, animation, options)


# --- Scenes of our own.


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


def morphing(weights=None, quantized=False):
    """A ball of two targets, one of them sparse, and a child node that turns."""
    s = Moving()
    ball = sphere(1, columns=24, rows=12, smooth=True)
    p, n = ball["positions"], ball["normals"]
    mesh = s.mesh(ball, s.diffuse(0.5))
    primitive = s.json["meshes"][mesh]["primitives"][0]
    where = np.flatnonzero(p[:, 1] > 0.7)
    stretch = p * (0.6, -0.3, 0.2)
    shorter = n / np.array((1.6, 0.7, 1.2))
    shorter /= np.linalg.norm(shorter, axis=-1, keepdims=True)
    primitive["targets"] = [
        {"POSITION": s.bounded(stretch, "VEC3"), "NORMAL": s.values(shorter - n, "VEC3")},
        {"POSITION": s.sparse(len(p), where, np.tile((0.1, 0.8, 0), (len(where), 1)))}]
    s.json["meshes"][mesh]["weights"] = [0.25, 0.5]
    more = {} if weights is None else {"weights": weights}
    child = s.node(root=False, mesh=mesh, scale=[1.0, 0.5, 1.5], **more)
    parent = s.node(children=[child], rotation=turned(30))
    s.animation()
    return s, parent, child


def test_morph_targets():
    """Weights of the mesh, of the node, of an animation in each interpolation."""
    for weights in (None, [1.0, 0.25]):
        s, _, _ = morphing(weights)
        s.json.pop("animations")
        check_pose("weights %s" % weights, s.write(scratch(".gltf")), None)
    times = [0.5, 1.0, 2.5]
    keys = [[0, 1], [1.2, -0.3], [0.4, 0.6]]
    for mode in ("STEP", "LINEAR", "CUBICSPLINE"):
        s, _, child = morphing([1.0, 0.25])
        if mode == "CUBICSPLINE":
            full = [[[0.5, -1], k, [0.7, 2]] for k in keys]
            output = s.values(full, "SCALAR")
        else:
            output = s.values(np.round(255 * np.clip(keys, 0, 1)), "SCALAR", 5121, True)
        s.channel((child, "weights"), times, output, mode)
        path = s.write(scratch(".gltf"))
        for time in (0.0, 0.8, 2.0, 3.0):
            check_pose("weights, %s at %g" % (mode, time), path, time)


def test_paths_and_modes():
    """Translation, rotation and scale, of floats and integers, in each interpolation."""
    times = [0.0, 0.5, 2.0]
    turns = np.array([turned(0), turned(100, (1, 1, 0)), turned(250, (0, 1, 0.5))])
    moves = np.array([(0, 0, 0), (1, 2, -1), (0.5, 0, 2)])
    sizes = np.array([(1, 1, 1), (0.5, 2, 1), (1.5, 0.75, 1)])
    for mode in ("STEP", "LINEAR", "CUBICSPLINE"):
        for kind, component, full in (("floats", FLOAT, 1), ("shorts", 5122, 32767),
                                      ("bytes", 5120, 127)):
            s, parent, child = morphing()
            rotation, others = turns, [moves, sizes]
            if mode == "CUBICSPLINE":
                slopes = 0.3 * np.array([[1, -1, 0.5, 0.2], [-0.4, 1, 1, 0], [0, 0.3, -1, 1]])
                rotation = np.stack([slopes, turns, -slopes], 1)
                others = [np.stack([slopes[:, :3], v, 2 * slopes[:, :3]], 1) for v in others]
            stored = rotation if component == FLOAT else np.round(rotation * full)
            s.channel((parent, "rotation"), times,
                      s.values(stored, "VEC4", component, component != FLOAT), mode)
            s.channel((child, "translation"), times, s.values(others[0], "VEC3"), mode)
            s.channel((child, "scale"), times, s.values(others[1], "VEC3"), mode)
            path = s.write(scratch(".gltf"))
            for time in (0.2, 1.1) if kind == "floats" else (1.3,):
                check_pose("%s of %s at %g" % (mode, kind, time), path, time, size=(32, 32))


def skinned(inverse_bind=True, component=5121, mirror=1.0):
    """A tube of four bones with two sets of influences, worn by two skins in different poses."""
    s = Moving()
    ball = sphere(1, columns=24, rows=16, smooth=True)
    p = ball["positions"]
    mesh = s.mesh(dict(ball), s.diffuse(0.5))
    attributes = s.json["meshes"][mesh]["primitives"][0]["attributes"]
    weights = np.maximum(0, 1 - np.abs(p[:, 1:2] * 2.5 - (np.arange(6) - 2.5)))
    weights = np.hstack([weights / weights.sum(1, keepdims=True), np.zeros((len(p), 2))])
    joints = np.tile([0, 1, 2, 3, 4, 5, 0, 0], (len(p), 1))
    full = {5121: 255, 5123: 65535, FLOAT: 1}[component]
    if component != FLOAT:
        weights = np.round(weights * full)
    for number in (0, 1):
        part = slice(4 * number, 4 * number + 4)
        attributes["JOINTS_%d" % number] = s.values(joints[:, part], "VEC4",
                                                    5121 if number else 5123)
        attributes["WEIGHTS_%d" % number] = s.values(weights[:, part], "VEC4", component,
                                                     component != FLOAT)
    for copy in (0, 1):
        bones = []
        for k in reversed(range(6)):
            below = [bones[-1]] if bones else []
            bones.append(s.node(root=False, translation=[0.0, 0.5 if k else -1.0, 0.0],
                                rotation=turned(6 * k * (1 - 2 * copy), (1, 0.3, 1)),
                                scale=[1.0, 1.1, 0.9 + 0.2 * copy],
                                **({"children": below} if below else {})))
        bones.reverse()
        s.node(children=[bones[0]], translation=[3.0 * copy, 0.2, 0.0],
               scale=[mirror, 1.0, 1.0])
        skin = {"joints": bones, "skeleton": bones[0]}
        if inverse_bind:
            bind = [move(0, 1 - 0.5 * k, 0).T for k in range(6)]
            skin["inverseBindMatrices"] = s.values(bind, "MAT4")
        # The node's own place does not count.
        s.node(mesh=mesh, skin=s._list("skins", skin), translation=[7.0, 8.0, 9.0])
    return s


def test_skins():
    for name, s in (("bytes", skinned()), ("shorts", skinned(component=5123)),
                    ("floats", skinned(component=FLOAT)), ("unbound", skinned(inverse_bind=False)),
                    ("mirrored", skinned(mirror=-1.0))):
        check_pose("skins, %s" % name, s.write(scratch(".gltf")), None)


def test_mirrored_skin_keeps_its_front():
    """Only fronts emit: a ball worn mirrored must be seen as bright as the other."""
    for mirror in (1.0, -1.0):
        s = skinned(mirror=mirror)
        s.json["materials"] = []
        s.emitter(1)
        picture = render(s, (32, 32), 1, 0, aov="depth")
        seen = np.isfinite(picture.layer("depth", "Z")[..., 0])
        near("mirror %g" % mirror, picture.rgb[seen].min(0), (1, 1, 1), 1e-6)


# --- Colours on unlit squares, a unit wide in a row.


def squares(count):
    s = Moving()
    s.camera(look_at((count / 2, 0.5, 5), (count / 2, 0.5, 0)), half_height=0.5, aspect=count)
    s.environment(radiance=0)
    s.animation("first")
    for k in range(count):
        s.add(quad((k + 0.5, 0.5, 0), (0.5, 0, 0), (0, 0.5, 0)), s.unlit((0.5, 0.5, 0.5, 1)))
    return s


def colours(scene, count, *options):
    """The middle of each square."""
    picture = render(scene, (8 * count, 8), 1, 1, options=options)
    return np.stack([picture.rgb[4, 8 * k + 4] for k in range(count)])


def test_pointers():
    """Factors, strengths, elements of arrays, texture transforms, lights, lenses, visibility."""
    s = squares(6)
    s.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
    s.channel("/materials/0/pbrMetallicRoughness/baseColorFactor", [0, 1],
              s.values([[1, 0, 0, 1], [0, 1, 0.5, 1]], "VEC4"))
    s.channel("/materials/1/pbrMetallicRoughness/baseColorFactor/2", [0, 1],
              s.values([0, 255], "SCALAR", 5121, True))
    s.channel("/nodes/3/extensions/KHR_node_visibility/visible", [0, 0.5, 1],
              s.values([1, 0, 1], "SCALAR", 5121), "STEP")
    s.json["nodes"][3]["extensions"] = {"KHR_node_visibility": {"visible": True}}
    s.used.add("KHR_node_visibility")
    glow = s.emitter((2, 2, 2))
    s.json["meshes"][3]["primitives"][0]["material"] = glow
    s.channel("/materials/%d/extensions/KHR_materials_emissive_strength/emissiveStrength" % glow,
              [0, 1], s.values([2, 10], "SCALAR"))
    ramp = np.zeros((1, 4, 4), np.uint8)
    ramp[0, :, 3], ramp[0, 2, 0] = 255, 255
    info = s.texture(ramp, nearest=True, transform={"scale": [0.0, 1.0]})
    shape = dict(quad((4.5, 0.5, 0), (0.5, 0, 0), (0, 0.5, 0)))
    shape["uv0"] = np.full((len(shape["positions"]), 2), 0.1)
    s.json["nodes"][5]["mesh"] = s.mesh(shape, s.unlit((1, 1, 1, 1), info))
    s.channel("/materials/%d/pbrMetallicRoughness/baseColorTexture/extensions/"
              "KHR_texture_transform/offset" % (len(s.json["materials"]) - 1),
              [0, 1], s._accessor([[0.1, 0], [1.1, 0]], "VEC2"))
    s.channel("/nodes/6/translation", [0, 1], s.values([[0, 0, 0], [0, 2, 0]], "VEC3"))
    rest = colours(s, 6)
    near("at rest", rest, [(0, 0, 0), (0.5,) * 3, (0.5,) * 3, (2,) * 3, (0, 0, 0), (0.5,) * 3],
         1e-6)
    got = colours(s, 6, "--at", 0.5)
    near("a factor", got[0], (0.5, 0.5, 0.25), 1e-6)
    near("one element of it", got[1], (0.5, 0.5, 0.5), 1e-6)
    near("hidden", got[2], (0, 0, 0), 1e-6)
    near("an emissive strength", got[3], (6, 6, 6), 1e-5)
    near("an offset of a texture", got[4], (1, 0, 0), 1e-6)
    near("a translation by pointer", got[5], (0, 0, 0), 1e-6)
    near("one element, at the end", colours(s, 6, "--at", 1)[1], (0.5, 0.5, 1), 1e-6)
    used = json.loads(run("info", s.write(scratch(".gltf")), "--json")[0])["extensions"]["used"]
    check("they are listed", {"KHR_animation_pointer", "KHR_node_visibility"} <= set(used))


def test_pointers_to_lights_and_lenses():
    s = Moving()
    s.add(quad((0, 0, 0), (2, 0, 0), (0, 2, 0)), s.diffuse(1))
    s.camera(look_at((0, 0, 5), (0, 0, 0)), yfov=90)
    s.environment(radiance=0)
    s.light("directional", 1, look_at((0, 0, 3), (0, 0, 0)))
    s.animation()
    s.channel("/extensions/KHR_lights_punctual/lights/0/intensity", [0, 1],
              s.values([0, 2], "SCALAR"))
    s.channel("/cameras/0/perspective/yfov", [0, 1],
              s.values([np.pi / 2, np.radians(20)], "SCALAR"))
    picture = render(s, (16, 16), 1, 1, options=["--at", 1])
    near("seen close, in twice the light", picture.rgb, np.full((16, 16, 3), 2 / np.pi), 1e-6)
    check("seen from far, in no light", render(s, (16, 16), 1, 1, options=["--at", 0]).rgb.max()
          == 0)


def test_visibility():
    """Hidden are a node and all below it, meshes and lights, but no cameras."""
    s = Moving()
    child = s.node(root=False, mesh=s.mesh(quad((0, 0, 0), (2, 0, 0), (0, 2, 0)),
                                           s.unlit((1, 0, 0, 1))),
                   extensions={"KHR_node_visibility": {"visible": True}})
    s.used.add("KHR_node_visibility")
    s.camera(look_at((0, 0, 5), (0, 0, 0)), half_height=0.5)
    camera = s.json["scenes"][0]["nodes"].pop()
    s.light("point", 1)
    light = s.json["scenes"][0]["nodes"].pop()
    s.environment(radiance=(0, 0, 1))
    hidden = {"KHR_node_visibility": {"visible": False}}
    s.node(children=[child, camera, light], extensions=hidden)
    near("hidden", render(s, (4, 4), 1, 1).rgb, np.tile((0, 0, 1), (4, 4, 1)), 1e-6)
    path = s.write(scratch(".gltf"))
    about = json.loads(run("info", path, "--json")[0])
    check("no light, but a camera", about["light_kinds"]["punctual"] == 0
          and len(about["cameras"]) == 1 and about["instances"] == 0)
    s.json["nodes"][-1]["extensions"]["KHR_node_visibility"]["visible"] = True
    near("shown", render(s, (4, 4), 1, 1).rgb, np.tile((1, 0, 0), (4, 4, 1)), 1e-6)


def variants():
    s = squares(2)
    s.json.pop("animations")
    s.used.add("KHR_materials_variants")
    s.json.setdefault("extensions", {})["KHR_materials_variants"] = {
        "variants": [{"name": "by day"}, {"name": "by night"}]}
    red, blue = s.unlit((1, 0, 0, 1)), s.unlit((0, 0, 1, 1))
    s.json["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {
        "mappings": [{"material": red, "variants": [0]}, {"material": blue, "variants": [1]}]}}
    return s


def refused(what, arguments, statuses, *words):
    """A run that ends with one of these statuses, and one line with all these words."""
    try:
        run(*arguments)
        check(what, False, "it succeeded")
    except Failed as failed:
        line = failed.message.strip()
        check(what, failed.status in statuses and "\n" not in line and all(w in line for w in words),
              "%d: %s" % (failed.status, line))


def test_variants():
    s = variants()
    grey, red, blue = (0.5,) * 3, (1, 0, 0), (0, 0, 1)
    near("the default", colours(s, 2), [grey, grey], 1e-6)
    near("the first", colours(s, 2, "--variant", "by day"), [red, grey], 1e-6)
    near("the second", colours(s, 2, "--variant", "by night"), [blue, grey], 1e-6)
    path, out = s.write(scratch(".gltf")), scratch(".png")
    for command in (["render", path, "-o", out], ["info", path]):
        refused("an unknown one", [*command, "--variant", "dusk"], (2,), "by day", "by night")
    check("no picture is left", not os.path.exists(out))
    about = json.loads(run("info", path, "--json")[0])
    check("they are listed", about["variants"] == ["by day", "by night"])
    check("the extension is used", "KHR_materials_variants" in about["extensions"]["used"])
    check("and told to people", "by night" in run("info", path)[0])


def test_which_animations():
    """All that move different things are shown; one that contradicts is left out, by name shown."""
    s = squares(3)
    s.channel("/materials/0/pbrMetallicRoughness/baseColorFactor", [0, 1],
              s.values([[0, 0, 0, 1], [1, 0, 0, 1]], "VEC4"))
    for name, target, colour in (("second", 1, (0, 1, 0)), ("third", 0, (0, 0, 1))):
        index = s.animation(name)
        s.channel("/materials/%d/pbrMetallicRoughness/baseColorFactor" % target, [0, 1],
                  s.values([[0, 0, 0, 1], [*colour, 1]], "VEC4"), animation=index)
    grey = (0.5,) * 3
    near("together", colours(s, 3, "--at", 1), [(1, 0, 0), (0, 1, 0), grey], 1e-6)
    near("by name", colours(s, 3, "--at", 1, "--animation", "third"), [(0, 0, 1), grey, grey], 1e-6)
    near("by index", colours(s, 3, "--at", 1, "--animation", 1), [grey, (0, 1, 0), grey], 1e-6)
    near("alone, from its start", colours(s, 3, "--animation", 0), [(0, 0, 0), grey, grey], 1e-6)
    path = s.write(scratch(".gltf"))
    refused("an unknown one", ["info", path, "--animation", "fourth"], (2,), "first", "third")
    about = json.loads(run("info", path, "--json")[0])["animations"]
    check("they are listed", [(a["name"], a["begin"], a["end"]) for a in about]
          == [("first", 0, 1), ("second", 0, 1), ("third", 0, 1)])


def spoil(s, semantic, edit, component):
    """Writes a scene whose attribute was changed; the accessors of the file itself are replaced."""
    accessors = s.json["accessors"]
    index = s.json["meshes"][0]["primitives"][0]["attributes"][semantic]
    view = s.json["bufferViews"][accessors[index]["bufferView"]]
    at = view["byteOffset"]
    part = np.frombuffer(s.data, COMPONENTS[component], view["byteLength"] //
                         np.dtype(COMPONENTS[component]).itemsize, at).copy()
    edit(part)
    s.data = s.data[:at] + part.tobytes() + s.data[at + view["byteLength"]:]
    return s.write(scratch(".gltf"))


def test_hostile():
    """Damaged skins, targets and animations: one line and status 3, or a picture."""
    def put(value):
        def edit(part):
            part[2] = value
        return edit

    s = skinned(component=FLOAT)
    refused("a joint that is not there", ["info", spoil(s, "JOINTS_0", put(6), 5123)], (3,),
            "ACCESSOR_JOINTS_INDEX_OOB", "/meshes/0/primitives/0/attributes/JOINTS_0")
    for value, code in ((np.nan, "ACCESSOR_INVALID_FLOAT"), (np.inf, "ACCESSOR_INVALID_FLOAT"),
                        (-1, "ACCESSOR_WEIGHTS_NEGATIVE")):
        s = skinned(component=FLOAT)
        refused("a weight of %g" % value, ["info", spoil(s, "WEIGHTS_0", put(value), FLOAT)], (3,),
                code)
    s = skinned(component=FLOAT)
    none = spoil(s, "WEIGHTS_0", lambda part: part.fill(0), FLOAT)
    picture = render(none, (16, 16), 1, 1)
    check("no weights: a picture", np.isfinite(picture.rgb).all())
    s = skinned()
    bones = s.json["skins"][0]["joints"]
    s.json["nodes"][bones[-1]]["children"] = [bones[0]]
    refused("a skeleton in a circle", ["info", s.write(scratch(".gltf"))], (3,), "NODE_")
    s, _, child = morphing()
    s.channel((child, "weights"), [0, 2, 1], s.values([0] * 6, "SCALAR"))
    refused("times out of order", ["info", s.write(scratch(".gltf"))], (3,),
            "ACCESSOR_ANIMATION_INPUT_NON_INCREASING")
    for owner, code in (("nodes", "NODE_WEIGHTS_INVALID"), ("meshes", "MESH_INVALID_WEIGHTS_COUNT")):
        s, _, child = morphing()
        s.json.pop("animations")
        s.json[owner][0]["weights"] = [1.0, 2.0, 3.0]
        refused("weights for no target", ["info", s.write(scratch(".gltf"))], (3,), code)
    for pointer, code in (("/materials/0/emissiveFactor", "INVALID_COUNT"),
                          ("/nodes/0/weights/7", "UNRESOLVED_REFERENCE")):
        s, _, _ = morphing()
        s.channel(pointer, [0, 1], s.values([0, 1], "SCALAR"))
        refused("pointer %s" % pointer, ["info", s.write(scratch(".gltf")), "--at", 0.5], (3,), code)
    for pointer in ("/materials/9/alphaCutoff", "/accessors/0/count", "", "/", "/nodes/0/matrix",
                    "/nodes/0/children/0", "/nodes/~2/scale", "/nodes/00000000000001/scale",
                    "/extensions/KHR_none/x", "/materials/0/" + 300 * "x", "/nodes/0/scale/1/2"):
        s, _, _ = morphing()
        s.channel(pointer, [0, 1], s.values([[0] * 3, [1] * 3], "VEC3"))
        try:
            run("info", s.write(scratch(".gltf")), "--at", 0.5)
            check("pointer %.30s" % pointer, True)
        except Failed as failed:
            check("pointer %.30s" % pointer, failed.status == 3, failed.message)


if __name__ == "__main__":
    main(test_assets, test_morph_targets, test_paths_and_modes, test_skins,
         test_mirrored_skin_keeps_its_front, test_pointers, test_pointers_to_lights_and_lenses,
         test_visibility, test_variants, test_which_animations, test_hostile)
