#!/usr/bin/env python3
"""What moves: animation, skins and morph targets.

Poses are worked out a second time by support/posed.py, from the file's bytes. The renderer's side
comes out of the position and normal layers of a picture: every point that it saw must lie on a
triangle of the pose, to 1e-4 of the size, and the pose must reach as far as the renderer says that
it does."""
import json
import os

import numpy as np

from support.moving import COMPONENTS, Moving, refused, turned
from support.posed import Posed, nearest
from support.render import Failed, render, run, scratch
from support.scene import FLOAT
from support.shapes import move, sphere
from support.verdict import check, main, near, skip

HERE = os.path.dirname(os.path.abspath(__file__))
ASSETS = os.path.abspath(os.path.join(HERE, "../../../shared/assets"))
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
         test_mirrored_skin_keeps_its_front, test_hostile)
