#!/usr/bin/env python3
"""What animations point at and what switches: factors, lights, lenses, visibility, variants, and
which of several animations is shown. Colours are seen on unlit squares, without noise."""
import json
import os

import numpy as np

from support.moving import Moving, refused
from support.render import render, run, scratch
from support.shapes import look_at, quad
from support.verdict import check, main, near


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


if __name__ == "__main__":
    main(test_pointers, test_pointers_to_lights_and_lenses, test_visibility, test_variants,
         test_which_animations)
