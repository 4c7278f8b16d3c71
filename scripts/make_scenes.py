#!/usr/bin/env python3
"""Writes the scenes of this project: make_scenes.py [FOLDER [NAME…]], into scenes/ beside this
folder and all of them by default. Needs nothing but Python, and numpy for `fire`. README.md tells what each
is for."""
import math
import os
import sys

from scene_demo import demo, distance, strokes
from scene_volumes import bodies, fire
from scene_kit import (CLAMP, FLOAT, MIRROR, NEAREST, REPEAT, Document, add, box, circle, cross,
                       data_uri, encoded, lathe, lattice, looking, mixed, png, quad,
                       radiance_hdr, sphere, sub, times, turn, unit)

SPHERE = sphere(64, 32)
UP, RIGHT, BACK = (0, 1, 0), (1, 0, 0), (0, 0, 1)


def diffuse(d, name, color, **more):
    return d.material(name, color, model={"model": "diffuse", "reflectance": list(color)}, **more)


def cornell():
    d = Document("A box open in front: light from one lamp, colour that bleeds, mirror and glass.")
    white = diffuse(d, "white", (0.73, 0.72, 0.70))
    room = ((quad((-1, 0, 1), (2, 0, 0), (0, 0, -2)), white),
            (quad((-1, 0, -1), (2, 0, 0), (0, 2, 0)), white),
            (quad((-1, 2, -1), (2, 0, 0), (0, 0, 2)), white),
            (quad((-1, 0, 1), (0, 0, -2), (0, 2, 0)), diffuse(d, "brick", (0.62, 0.12, 0.08))),
            (quad((1, 0, -1), (0, 0, 2), (0, 2, 0)), diffuse(d, "leaf", (0.11, 0.38, 0.16))))
    for wall, material in room:
        d.put(wall, material)
    d.panel_light((0, 1.998, 0), (0, 0, 0), 0.9, 0.75, (6.4, 5.3, 4.0))
    d.put(box((-0.3, 0, -0.3), (0.3, 1.2, 0.3)), white, at=(-0.38, 0, -0.35), turned=turn(UP, 18))
    mirror = d.material("mirror", model={"model": "mirror"})
    glass = d.material("glass", model={"model": "dielectric"})
    d.put(SPHERE, mirror, at=(-0.38, 1.42, -0.35), size=0.22)
    d.put(SPHERE, glass, at=(0.42, 0.36, 0.3), size=0.36)
    d.camera((0, 1, 3.9), (0, 1, 0), 37.9, 1)
    return d


def sky(x, y):
    """A studio of 64 x 32: grey, lighter above; a warm window at +Z to -X, a cool one, a bar."""
    up = 1 - (y + 0.5) / 16
    color = mixed((0.22, 0.22, 0.22), (0.75, 0.78, 0.85), max(up, 0))
    windows = ((52, 59, 6, 12, (11, 9.6, 8)), (37, 41, 5, 14, (3, 4.4, 6.5)),
               (8, 60, 2, 4, (2, 2, 2)))
    for x0, x1, y0, y1, radiance in windows:
        if x0 <= x < x1 and y0 <= y < y1:
            color = radiance
    return color


def materials():
    d = Document("Sweeps from left to right. Gold of GGX and copper of Beckmann roughness 0 … 0.8; "
                 "seven metals; glTF's own material, by roughness; glass, by index, then tinted by "
                 "CDL_medium and by KHR_materials_volume. An environment map lights it.")
    steps = range(7)
    rows = []
    for name, metal, distribution in (("gold", "Au", "ggx"), ("copper", "Cu", "beckmann")):
        rows.append([d.material("%s %d" % (name, k), model={
            "model": "conductor", "metal": metal, "distribution": distribution,
            "alpha": (0, 0.05, 0.1, 0.2, 0.35, 0.55, 0.8)[k]}) for k in steps])
    rows.append([d.material(metal, model={"model": "conductor", "metal": metal, "alpha": 0.12})
                 for metal in ("Ag", "Al", "Cr", "Fe", "Ni", "Ti", "W")])
    rows.append([d.material("paint %d" % k, (0.05, 0.22, 0.62), 1.0 if k == 6 else 0.0,
                            (0.0, 0.15, 0.3, 0.5, 0.75, 1.0, 0.3)[k]) for k in steps])
    glass = [d.material("glass of %g" % ior, model={"model": "dielectric", "ior": ior})
             for ior in (1.1, 1.33, 1.5, 2.0)]
    glass.append(d.material("wine", model={"model": "dielectric", "ior": 1.36},
                            medium={"absorption": [0.4, 3.5, 3.0]}))
    for name, color in (("amber", (0.9, 0.45, 0.08)), ("bottle", (0.15, 0.55, 0.25))):
        glass.append(d.material(name, (1, 1, 1), 0, 0, extensions={}))
        entry = d.gltf["materials"][glass[-1]]
        d.extend(entry, "KHR_materials_transmission", {"transmissionFactor": 1})
        d.extend(entry, "KHR_materials_ior", {"ior": 1.5})
        d.extend(entry, "KHR_materials_volume", {
            "thicknessFactor": 1, "attenuationDistance": 0.6, "attenuationColor": list(color)})
    rows.append(glass)
    for r, row in enumerate(rows):
        for c, material in enumerate(row):
            d.put(SPHERE, material, at=(c - 3, 4.5 - r, 0), size=0.43)
    tiles = d.texture(png(2, 2, lambda x, y: (0.72,) * 3 if (x + y) % 2 else (0.42, 0.43, 0.46)),
                      magFilter=NEAREST, minFilter=NEAREST)
    wall = d.material("tiles", (1, 1, 1), pbr={"baseColorTexture": d.textured(
        tiles, {"scale": [10, 7.5]})})
    d.put(quad((-5, -1, -1), (10, 0, 0), (0, 7.5, 0)), wall)
    d.put(quad((-5, -1, 5), (10, 0, 0), (0, 0, -6)), diffuse(d, "floor", (0.3, 0.3, 0.32)))
    d.camera((0, 2.6, 12), (0, 2.5, 0), 25.5, 7.4 / 5.4)
    d.scene("CDL_environment", {"uri": data_uri(radiance_hdr(64, 32, sky), "image/vnd.radiance"),
                                "rotation": 15})
    return d


def lights():
    d = Document("One kind of light a bay: a point light with a range, a spot, an area light, a "
                 "shape that glows with a texture; a low sun and a constant sky over all of them.")
    plaster = diffuse(d, "plaster", (0.6, 0.58, 0.55))
    d.put(quad((-4.2, 0, 2.6), (8.4, 0, 0), (0, 0, -4.2)), diffuse(d, "floor", (0.42, 0.42, 0.44)))
    d.put(quad((-4.2, 0, -1.6), (8.4, 0, 0), (0, 3.4, 0)), plaster)
    divider = box((-0.06, 0, -1.6), (0.06, 3.4, 0.4))
    wall = d.mesh(divider, plaster)
    for k in range(5):
        d.node(mesh=wall, at=(2 * k - 4, 0, 0))
    clay = d.mesh(SPHERE, d.material("clay", (0.75, 0.72, 0.68), roughness=0.35))
    for k in range(4):
        d.node(mesh=clay, at=(2 * k - 3, 0.4, -0.45), size=0.4)
    d.light("point", (1, 0.55, 0.25), 6, at=(-3.3, 1.5, -0.9), range=2.5)
    d.light("spot", (0.5, 0.75, 1), 46, looking((-1, 2.5, 0.2), (-1, 0.3, -0.5)),
            spot={"innerConeAngle": 0.22, "outerConeAngle": 0.4})
    d.panel_light((1.2, 2.2, -0.5), (1, 0.3, -0.5), 0.9, 0.7, (11, 10.4, 9.5))
    red, blue = encoded((1, 0.25, 0.5)), encoded((0.05, 0.2, 1))
    stripes = d.texture(png(8, 16, lambda x, y: red if y % 4 < 2 else blue),
                        magFilter=NEAREST, minFilter=NEAREST)
    lamp = d.material("lamp", (0, 0, 0), glow=(11, 11, 11), emissiveTexture=d.textured(stripes))
    d.put(SPHERE, lamp, at=(3.45, 1.45, -1.0), size=(0.25, 0.45, 0.25))
    d.light("directional", (1, 0.8, 0.55), 0.5, looking((6, 4.5, 9), (0, 0, 0)))
    d.camera((0, 2.3, 9.5), (0, 1.2, 0), 20.5, 2.2)
    d.scene("CDL_environment", {"radiance": [0.03, 0.04, 0.06]})
    return d


def media():
    d = Document("Fog fills the scene, the camera is in it, and a lamp draws beams through a "
                 "window; outside, a boundary keeps the air clear. Media nested (a white cloud in "
                 "amber glass), overlapping (cyan and yellow), and one that glows.")
    wall = diffuse(d, "wall", (0.32, 0.33, 0.36))
    d.put(quad((-9, 0, 9), (18, 0, 0), (0, 0, -12)), diffuse(d, "floor", (0.36, 0.34, 0.31)))
    for low, high in (((-9, 0), (-2.7, 7)), ((1.1, 0), (9, 7)), ((-2.7, 0), (1.1, 1.5)),
                      ((-2.7, 3.5), (1.1, 7)), ((-1.55, 1.5), (-1.35, 3.5)),
                      ((-0.25, 1.5), (-0.05, 3.5))):
        d.put(box((*low, -3.2), (*high, -3)), wall)

    def inside(name, medium, ior=None):
        model = {"model": "dielectric", "ior": ior} if ior else {"model": "interface"}
        return d.material(name, model=model, medium=medium)

    amber, left = {"absorption": [0.06, 0.35, 1.1]}, (-1.75, 0.8, 0.6)
    cloud = {"scattering": [9, 9, 9], "absorption": [0.02, 0.02, 0.02],
             "phase": {"type": "hg", "g": 0.2}}
    d.put(SPHERE, inside("amber", amber, 1.4), at=left, size=0.8)
    d.put(SPHERE, inside("cloud", cloud), at=left, size=0.4)
    cyan, yellow = [3, 0.1, 0.15], [0.05, 0.12, 3]
    for name, x, absorption in (("cyan", -0.05, cyan), ("yellow", 0.75, yellow)):
        d.put(SPHERE, inside(name, {"absorption": absorption, "scattering": [1.2, 1.2, 1.2]}),
              at=(x, 0.7, 0.6), size=0.65)
    d.put(SPHERE, inside("ember", {"emission": [1.6, 0.42, 0.06], "absorption": [0.2, 0.5, 0.9],
                                   "scattering": [0.5, 0.5, 0.5]}), at=(2.45, 0.6, 0.9), size=0.5)
    d.put(box((-12, -3, -16), (12, 15, -3.1)), inside("clear air", None))
    d.light("spot", (1, 0.86, 0.66), 800, looking((-2.6, 5.9, -8), (-0.2, 1.2, 0)),
            spot={"innerConeAngle": 0.4, "outerConeAngle": 0.5})
    d.panel_light((2, 5.5, 6), (0, 0, 0), 7, 4, (2.6, 3.0, 3.8))
    d.camera((0.3, 1.7, 7.6), (0.25, 1.35, 0), 27)
    d.scene("CDL_medium", {"scattering": [0.09, 0.09, 0.094], "phase": {"type": "hg", "g": 0.6}})
    return d


def letter_r(x, y, size=96):
    """A picture that shows which way it lies: an R, a light corner, a dark frame."""
    u, v = (x + 0.5) / size, (y + 0.5) / size
    ground = mixed((0.95, 0.55, 0.20), (0.12, 0.35, 0.60), (u + v) / 2)
    away = min(distance(u * 9 - 2.5, v * 9 - 1.5, s) for s in strokes("R")[0])
    edge = min(u, v, 1 - u, 1 - v)
    return mixed((0.09, 0.30, 0.34) if edge < 0.05 else (0.97, 0.96, 0.92), ground,
                 min(max((away - 0.45) * 10 + 0.5, 0), 1) if edge >= 0.05 else 0)


def domes(x, y):
    """Half spheres, 4 x 4 in 128 x 128, as a normal map."""
    u, v = (x + 0.5) / 16 % 2 - 1, 1 - (y + 0.5) / 16 % 2
    r = math.hypot(u, v)
    n = (u * 0.9, v * 0.9, math.sqrt(1 - 0.81 * r * r)) if r < 0.95 else (0, 0, 1)
    return tuple(0.5 + 0.5 * c for c in n)


def textures():
    d = Document("From the top left: wrap modes repeat, mirrored, clamped; KHR_texture_transform; "
                 "alpha mask; alpha blend; a normal map; vertex colours; two UV sets (a glow on "
                 "the second). Seen by an orthographic camera.")
    picture = png(96, 96, letter_r)
    full, spread = ((0, 1), (1, 0)), ((-1, 2), (2, -1))
    disc = d.texture(png(64, 64, lambda x, y: (*letter_r(x * 1.5, y * 1.5),
                                               1.25 - math.hypot(x - 31.5, y - 31.5) / 32)))
    veil = d.texture(png(64, 8, lambda x, y: (0.9, 0.25, 0.2, x / 63)), CLAMP)
    ring = d.texture(png(64, 64, lambda x, y: (
        max(1 - abs(math.hypot(x - 31.5, y - 31.5) - 20) / 6, 0),) * 3), CLAMP)

    def panel(name, uv=full, base=None, transform=None, color=(1, 1, 1), **members):
        pbr = {"baseColorTexture": d.textured(base, transform)} if base is not None else {}
        return quad((-0.5, -0.5, 0), RIGHT, UP, uv), d.material(name, color, pbr=pbr, **members)

    repeated, mirrored, clamped = (d.texture(picture, wrap) for wrap in (REPEAT, MIRROR, CLAMP))
    panels = [panel("repeat", spread, repeated), panel("mirror", spread, mirrored),
              panel("clamp", spread, clamped),
              panel("transform", full, repeated,
                    {"offset": [0.2, 0.1], "rotation": 0.5, "scale": [2.5, 2.5]}),
              panel("mask", ((0, 2), (2, 0)), disc, alphaMode="MASK", alphaCutoff=0.5),
              panel("blend", full, veil, alphaMode="BLEND"),
              panel("normals", color=(0.55, 0.57, 0.6), roughness=0.4,
                    normalTexture={"index": d.texture(png(128, 128, domes))}),
              panel("colours"),
              panel("two sets", spread, repeated, glow=(1.6, 0.9, 0.3),
                    emissiveTexture={"index": ring, "texCoord": 1})]
    panels[7][0]["color"] = [(0.9, 0.05, 0.05), (0.9, 0.8, 0.05), (0.05, 0.6, 0.2),
                             (0.05, 0.15, 0.8)]
    panels[8][0]["uv1"] = quad((0, 0, 0), RIGHT, UP)["uv"]
    for k, (shape, material) in enumerate(panels):
        d.put(shape, material, at=(k % 3 * 1.15 - 1.15, 1.15 - k // 3 * 1.15, 0.1))
    board = d.texture(png(2, 2, lambda x, y: (0.35 if (x + y) % 2 else 0.6,) * 3),
                      magFilter=NEAREST)
    d.put(quad((-1.8, -1.8, 0), (3.6, 0, 0), (0, 3.6, 0)), d.material("board", (1, 1, 1), pbr={
        "baseColorTexture": d.textured(board, {"scale": [18, 18]})}))
    d.light("directional", (1, 0.96, 0.9), 2.2, looking((-3, 3, 3), (0, 0, 0)))
    d.flat_camera((0, 0, 5), (0, 0, 0), 3.6, 3.6)
    d.scene("CDL_environment", {"radiance": [0.35, 0.37, 0.4]})
    return d


def drop():
    """A drop from y = 0 to 1, its tip up, 0.5 across."""
    profile = []
    for k in range(17):
        t = math.pi * k / 16
        y, r = (1 + math.cos(t)) / 2, 0.25 * math.sin(t) * math.sin(t / 2) ** 1.5 * 1.3
        profile.append([r if 0 < k < 16 else 0.0, y])
    for k, p in enumerate(profile):
        (r0, y0), (r1, y1) = profile[max(k - 1, 0)][:2], profile[min(k + 1, 16)][:2]
        p += unit((y0 - y1, r1 - r0)) if 0 < k < 16 else (0, 1 if k == 0 else -1)
    return lathe(profile, 24)


def horn():
    """A tube that winds up and thins out: it is not its own mirror image."""

    def middle(v):
        (c, s), r = circle(2.5 * v), 0.5 - 0.42 * v
        return (r * c, 1.7 * v ** 1.2, -r * s)

    def point(u, v):
        c, s = circle(u)
        along = unit(sub(middle(v + 1e-3), middle(max(v - 1e-3, 0))))
        aside = unit(cross(along, UP))
        out = add(times(aside, c), times(cross(aside, along), s))
        return {"position": add(middle(v), times(out, 0.19 * (1 - v) + 0.004)), "normal": out}

    return lattice(20, 120, point)


def instances():
    d = Document("600 drops of three meshes by EXT_mesh_gpu_instancing, turned, scaled unevenly; "
                 "one horn and its mirror image, by a negative scale, of one mesh; a lens of "
                 "finite aperture.")
    d.put(quad((-40, 0, 40), (80, 0, 0), (0, 0, -80)), diffuse(d, "ground", (0.30, 0.27, 0.25)))
    petal, colors = drop(), ((0.85, 0.30, 0.06), (0.90, 0.62, 0.10), (0.45, 0.05, 0.12))
    for m, color in enumerate(colors):
        placed = {"TRANSLATION": [], "ROTATION": [], "SCALE": []}
        for k in range(40 + m, 640, 3):
            c, s = circle(k * (3 - math.sqrt(5)) / 2)
            r = 0.115 * math.sqrt(k)
            placed["TRANSLATION"].append((r * c, 0, -r * s))
            placed["ROTATION"].append(turn((-s, 0, -c), 52 * k / 640))
            placed["SCALE"].append((0.42, 0.35 + 0.85 * k / 640, 0.42))
        mesh = d.mesh(petal, d.material("petal %d" % m, color, roughness=0.35))
        node = d.node(mesh=mesh)
        attributes = {key: d.accessor(rows, FLOAT, "VEC%d" % len(rows[0]))
                      for key, rows in placed.items()}
        d.extend(d.gltf["nodes"][node], "EXT_mesh_gpu_instancing", {"attributes": attributes})
    gold = d.mesh(horn(), d.material("gold", model={
        "model": "conductor", "metal": "Au", "alpha": 0.15}))
    d.node(mesh=gold, at=(-0.7, 0, 0), size=(1.2, 1.3, 1.2))
    d.node(mesh=gold, at=(0.7, 0, 0), size=(-1.2, 1.3, 1.2))
    d.light("directional", (1, 0.86, 0.68), 3.2, looking((-5, 4.5, 3), (0, 0, 0)))
    d.camera((0, 4.2, 7.6), (0, 0.45, 0.2), 30,
             lens={"apertureRadius": 0.05, "focusDistance": 8.2})
    d.scene("CDL_environment", {"radiance": [0.42, 0.52, 0.68]})
    return d


SCENES = {f.__name__: f for f in (demo, cornell, materials, lights, media, textures, instances,
                                 bodies, fire)}


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", "scenes")
    for name in sys.argv[2:] or SCENES:
        size = SCENES[name]().write(os.path.join(folder, name + ".gltf"))
        print("%s.gltf: %d bytes" % (name, size))


if __name__ == "__main__":
    main()
