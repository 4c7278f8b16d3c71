#!/usr/bin/env python3
"""Models that others made, of ../shared/assets: each loads, `candela info` says of it what a
reading of the file by NumPy says, and names what is not supported; and a small render shows its triangles
where they are. Skipped where the folder is absent."""
import glob
import json
import os

import numpy as np

from support.gltf_file import File, distance_to_triangles, read_json, transformed
from support.render import Failed, render, run, scratch
from support.verdict import check, main, near, skip

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.abspath(os.path.join(HERE, "../../../shared/assets"))
SKY = (1, 0.75, 0.5)  # some models have a bulb alone, which four samples may miss
POINTS = 24  # of each picture, that are looked for among the triangles


def models():
    return sorted(path for suffix in ("gltf", "glb") for depth in ("*", "*/*")
                  for path in glob.glob(os.path.join(FOLDER, depth + "." + suffix)))


def info(path):
    said, notes = run("info", path, "--json")
    return json.loads(said), notes


def extensions_in(value):
    """Names of all extensions that some object of the file really has."""
    if isinstance(value, list):
        return set().union(*map(extensions_in, value), set())
    if not isinstance(value, dict):
        return set()
    return set(value.get("extensions", {})).union(*map(extensions_in, value.values()), set())


def check_extensions(name, about, notes, root):
    lists = about["extensions"]
    used = set(root.get("extensionsUsed", []))
    if any(image.get("uri", "").endswith(".ktx2") for image in root.get("images", [])):
        used.add("KHR_texture_basisu")  # what such pictures need, said or not
    listed = [e for kind in ("used", "ignored", "unsupported") for e in lists[kind]]
    check(name + ": extensions are listed once", sorted(listed) == sorted(used),
          "%s, the file uses %s" % (lists, sorted(used)))
    for extension in extensions_in(root) & set(lists["unsupported"]):
        check("%s: a note tells of %s" % (name, extension), extension in notes, notes)


def on_triangles(file, points, scale):
    """How far the points are from the triangles, at most."""
    best = np.full(len(points), np.inf)
    for matrix, corners in file.instances:
        world = transformed(matrix, corners.reshape(-1, 3)).reshape(-1, 3, 3)
        low, high = world.min((0, 1)) - scale, world.max((0, 1)) + scale
        for i in np.flatnonzero(np.all((points >= low) & (points <= high), 1)):
            best[i] = min(best[i], distance_to_triangles(points[i], world))
    return best.max()


def check_picture(name, file, picture):
    bounds = file.bounds()
    size = np.linalg.norm(bounds[1] - bounds[0])
    check(name + ": no bad samples", picture.stats["bad_samples"] == 0)
    check(name + ": all is finite", np.isfinite(picture.rgb).all())
    seen = np.isfinite(picture.layer("depth", "Z")[..., 0])
    check(name + ": something is in view", seen.mean() > 0.02, "%g of the pixels" % seen.mean())
    shown = picture.rgb[seen].mean()
    check(name + ": not black", shown > 0.01, str(shown))
    check(name + ": what is seen has a number",
          np.array_equal(seen, picture.layer("object", ["id"])[..., 0] > 0))
    points = picture.layer("position", "XYZ")[seen]
    chosen = points[np.random.default_rng(1).permutation(len(points))[:POINTS]]
    off = on_triangles(file, chosen, 1e-4 * size)
    check(name + ": what is seen is on triangles", off < 2e-5 * size,
          "%g off, the model is %g across" % (off, size))


def test_models():
    for path in models():
        name = os.path.relpath(path, FOLDER)
        file, (about, notes) = File(path), info(path)
        bounds = file.bounds()
        size = np.linalg.norm(bounds[1] - bounds[0])
        check(name + ": triangles", about["triangles"] == file.triangle_count(),
              "%d, not %d" % (about["triangles"], file.triangle_count()))
        check(name + ": instances", about["instances"] == len(file.instances))
        near(name + ": bounds", about["bounds"], bounds, 1e-5 * size)
        check_extensions(name, about, notes, file.json)
        picture = render(path, (64, 48), 4, aov="position,depth,object",
                         options=("--background", "%g,%g,%g" % SKY))
        check(name + ": light was given", "no light" not in picture.notes, picture.notes)
        check_picture(name, file, picture)


def test_unheard_of():
    """An extension that nobody supports is named; one that is required is refused."""
    root, _ = read_json(os.path.join(FOLDER, "SimpleSkin/SimpleSkin.gltf"))
    root["extensionsUsed"] = root.get("extensionsUsed", []) + ["EXT_unheard_of"]
    root["meshes"][0].setdefault("extensions", {})["EXT_unheard_of"] = {}
    path = scratch(".gltf")
    with open(path, "w") as file:
        json.dump(root, file)
    about, _ = info(path)
    check("an unheard-of extension is unsupported",
          about["extensions"]["unsupported"] == ["EXT_unheard_of"], str(about["extensions"]))
    root["extensionsRequired"] = ["EXT_unheard_of"]
    with open(path, "w") as file:
        json.dump(root, file)
    try:
        run("info", path)
        check("a required extension is refused", False)
    except Failed as refusal:
        check("a required extension is refused", refusal.status == 3 and
              "EXT_unheard_of" in refusal.message and refusal.message.count("\n") == 1,
              str(refusal))


def test_unsupported_is_told_once():
    """KTX2 pictures that several materials show: a line for each picture, not for each use."""
    path = os.path.join(FOLDER, "AnisotropyBarnLamp/AnisotropyBarnLamp.gltf")
    root, _ = read_json(path)
    _, notes = info(path)
    told = [line.split(": ")[2] for line in notes.splitlines() if "KTX2" in line]
    wanted = {"/images/%d" % i for i, image in enumerate(root["images"])
              if image.get("uri", "").endswith(".ktx2")}
    check("KTX2 images are told of once", len(told) == len(set(told)) and set(told) <= wanted and
          told, "%s of %s" % (told, sorted(wanted)))


if __name__ == "__main__":
    if models():
        main(test_models, test_unheard_of, test_unsupported_is_told_once)
    skip("models", "%s is not there" % FOLDER)
    main()
