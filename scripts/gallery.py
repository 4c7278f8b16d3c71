#!/usr/bin/env python3
"""Renders every material model into one self-contained HTML page of labelled spheres and sweeps:
gallery.py [-o PAGE.html] [--tile PIXELS] [--spp N] [--only TEXT] [--device SELECTOR] [--list]

Each row is a render of its own, of spheres in a neutral studio. $CANDELA is the renderer
(build/candela)."""
import argparse
import base64
import html
import os
import subprocess
import sys
import tempfile
import time

from scene_kit import Document, quad, radiance_hdr, sphere, data_uri, png

SPACING = 2.3  # of spheres of radius 1
METALS = ("Au", "Ag", "Cu", "Al", "Fe", "Cr", "Ti", "W", "Pt")
RED = (0.72, 0.08, 0.06)


def cdl(model, **fixed):
    """Materials of a CDL_material model: name and value of what is swept, or a dict of both."""
    return lambda **swept: {"model": {"model": model, **fixed, **swept}}


def filled(**fixed):
    """An interface around a CDL_medium."""
    return lambda **swept: {"model": {"model": "interface"}, "medium": {**fixed, **swept}}


def khr(pbr=None, **extensions):
    """Materials of glTF's own model: each extension's members; swept ones are named
    extension__member, or member for those of pbrMetallicRoughness."""
    def make(**swept):
        own, layers = dict(pbr or {}), {k: dict(v) for k, v in extensions.items()}
        for name, value in swept.items():
            extension, _, member = name.rpartition("__")
            (layers.setdefault(extension, {}) if extension else own)[member] = value
        return {"pbr": own, "extensions": {"KHR_materials_" + k: v for k, v in layers.items()}}
    return make


def sweep(name, values):
    return [("%s %s" % (name.rpartition("__")[2], label(v)), {name: v}) for v in values]


def label(value):
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (list, tuple)):
        return " ".join("%.3g" % v for v in value)
    return value if isinstance(value, str) else "%.3g" % value


ALPHAS = (0, 0.05, 0.1, 0.2, 0.4, 0.7, 1)
UNIT = (0, 0.25, 0.5, 0.75, 1)
DISNEY = {"baseColor": RED, "roughness": 0.4}
WHITE = {"metallicFactor": 0, "roughnessFactor": 0.0, "baseColorFactor": [1, 1, 1, 1]}
MATT = {"metallicFactor": 0, "roughnessFactor": 0.5, "baseColorFactor": [*RED, 1]}
BRUSHED = {"metallicFactor": 1, "roughnessFactor": 0.3, "baseColorFactor": [0.9, 0.85, 0.8, 1]}
SOLID = {"thicknessFactor": 1}

# Heading, then rows: what they show, how a material is made, and its labels and swept members.
GALLERY = [
    ("diffuse and oren_nayar", [
        ("diffuse reflectance", cdl("diffuse"),
         sweep("reflectance", [[r] * 3 for r in (0.05, 0.2, 0.5, 0.8, 1)])),
        ("oren_nayar roughness", cdl("oren_nayar", reflectance=[0.8, 0.5, 0.3]),
         sweep("roughness", UNIT))]),
    ("conductor", [
        ("metals, alpha 0.1", cdl("conductor", alpha=0.1), sweep("metal", METALS)),
        ("smooth metals", cdl("conductor"), sweep("metal", METALS)),
        ("alpha, GGX", cdl("conductor", metal="Au"), sweep("alpha", ALPHAS)),
        ("alpha, Beckmann", cdl("conductor", metal="Au", distribution="beckmann"),
         sweep("alpha", ALPHAS)),
        ("alpha along and across the tangent", cdl("conductor", metal="Al"),
         sweep("alpha", [[0.1, 0.1], [0.2, 0.1], [0.4, 0.1], [0.8, 0.1], [0.1, 0.4], [0.1, 0.8]])),
        ("energy compensation at alpha 0.5 and 1", cdl("conductor", metal="Cu"),
         [("alpha %g, %s" % (a, label(on)), {"alpha": a, "energyCompensation": on})
          for a in (0.5, 1) for on in (False, True)])]),
    ("mirror and retroreflector", [
        ("mirror reflectance", cdl("mirror"),
         sweep("reflectance", [[r] * 3 for r in (0.2, 0.5, 1)])),
        ("retroreflector alpha", cdl("retroreflector", reflectance=[0.9, 0.9, 0.9]),
         sweep("alpha", (0.02, 0.05, 0.1, 0.2, 0.4, 0.7))),
        ("retroreflector ior", cdl("retroreflector", alpha=0.2),
         sweep("ior", (1, 1.3, 1.5, 2, 2.5)))]),
    ("dielectric", [
        ("ior", cdl("dielectric"), sweep("ior", (1.05, 1.2, 1.33, 1.5, 1.8, 2.4))),
        ("alpha, GGX", cdl("dielectric"), sweep("alpha", (0, 0.05, 0.1, 0.2, 0.4, 0.7, 1))),
        ("alpha, Beckmann", cdl("dielectric", distribution="beckmann"),
         sweep("alpha", (0, 0.05, 0.1, 0.2, 0.4, 0.7, 1))),
        ("Abbe's number, ior 1.7", cdl("dielectric", ior=1.7), sweep("abbe", (60, 30, 15, 8))),
        ("transmittance", cdl("dielectric"),
         sweep("transmittance", [[1, 1, 1], [0.9, 0.6, 0.3], [0.4, 0.8, 0.5], [0.3, 0.4, 0.9]])),
        ("thin, alpha", cdl("dielectric", thin=True), sweep("alpha", (0, 0.1, 0.2, 0.4, 0.7)))]),
    ("plastic", [
        ("alpha", cdl("plastic", reflectance=RED), sweep("alpha", ALPHAS)),
        ("ior", cdl("plastic", reflectance=RED, alpha=0.05),
         sweep("ior", (1.05, 1.2, 1.5, 2, 2.5, 3))),
        ("reflectance", cdl("plastic", alpha=0.1),
         sweep("reflectance", [[r] * 3 for r in (0, 0.2, 0.5, 0.8, 1)]))]),
    ("subsurface", [
        ("albedo", cdl("subsurface", radius=0.05),
         sweep("albedo", [[a] * 3 for a in (0.1, 0.4, 0.7, 0.95)])),
        ("radius, m", cdl("subsurface", albedo=[0.9, 0.6, 0.45]),
         sweep("radius", (0.005, 0.03, 0.1, 0.3, 1))),
        ("method", cdl("subsurface", albedo=[0.9, 0.6, 0.45], radius=0.1),
         sweep("method", ("random_walk", "diffusion", "dipole"))),
        ("radius by channel", cdl("subsurface", albedo=[0.85, 0.6, 0.5], alpha=0.2),
         sweep("radius", [[0.1, 0.05, 0.03], [0.3, 0.1, 0.05], [0.6, 0.12, 0.04]])),
        ("alpha", cdl("subsurface", albedo=[0.9, 0.85, 0.7], radius=0.1),
         sweep("alpha", (0, 0.1, 0.3, 0.6, 1))),
        ("ior", cdl("subsurface", albedo=[0.9, 0.85, 0.7], radius=0.1, alpha=0.1),
         sweep("ior", (1, 1.2, 1.4, 1.8)))]),
    ("media in an interface", [
        ("scattering, 1/m", filled(), [("%g" % s, {"scattering": s}) for s in (0.3, 1, 3, 10)]),
        ("absorption over scattering", filled(scattering=3),
         [("%g" % a, {"absorption": a}) for a in (0, 0.5, 2, 8)]),
        ("phase function", filled(scattering=2), [
            (name, {"phase": phase}) for name, phase in (
                ("isotropic", {"type": "isotropic"}), ("hg 0.8", {"type": "hg", "g": 0.8}),
                ("hg -0.8", {"type": "hg", "g": -0.8}), ("rayleigh", {"type": "rayleigh"}),
                ("draine 0.6, 2", {"type": "draine", "g": 0.6, "alpha": 2}),
                ("two_term_hg", {"type": "two_term_hg", "g": [0.9, -0.4], "weight": 0.3}),
                ("droplets 15 um", {"type": "droplets", "diameter": 15}))])]),
    ("disney", [(name, cdl("disney", **{**DISNEY, **fixed}), sweep(name, values))
                for name, values, fixed in (
                    ("metallic", UNIT, {}), ("roughness", UNIT, {}), ("specular", UNIT, {}),
                    ("specularTint", UNIT, {"specular": 1}),
                    ("anisotropic", UNIT, {"metallic": 1}),
                    ("sheen", UNIT, {"roughness": 0.8}),
                    ("sheenTint", UNIT, {"roughness": 0.8, "sheen": 1}),
                    ("clearcoat", UNIT, {"roughness": 0.6}),
                    ("clearcoatGloss", UNIT, {"roughness": 0.6, "clearcoat": 1}),
                    ("subsurface", UNIT, {}), ("specTrans", UNIT, {"baseColor": [1, 0.9, 0.7]}),
                    ("ior", (1.1, 1.3, 1.5, 1.8, 2.2),
                     {"specTrans": 1, "roughness": 0.1, "baseColor": [1, 1, 1]}),
                    ("diffTrans", (0, 0.5, 1, 1.5, 2), {"thin": True}),
                    ("flatness", UNIT, {"thin": True}))]),
    ("glTF", [
        ("roughness, metallic 0", khr(MATT), sweep("roughnessFactor", UNIT)),
        ("roughness, metallic 1", khr({**BRUSHED, "baseColorFactor": [1, 0.77, 0.34, 1]}),
         sweep("roughnessFactor", UNIT)),
        ("metallic", khr({**MATT, "roughnessFactor": 0.3}), sweep("metallicFactor", UNIT)),
        ("ior", khr({**MATT, "roughnessFactor": 0.2}), sweep("ior__ior", (1, 1.2, 1.5, 2, 2.5))),
        ("specular", khr({**MATT, "roughnessFactor": 0.2}),
         sweep("specular__specularFactor", UNIT)),
        ("specular colour", khr({**MATT, "roughnessFactor": 0.2}, ior={"ior": 1.8}),
         sweep("specular__specularColorFactor", [[1, 1, 1], [1, 0.5, 0.2], [0.2, 0.5, 1]])),
        ("clearcoat", khr({**MATT, "roughnessFactor": 0.7}),
         sweep("clearcoat__clearcoatFactor", UNIT)),
        ("clearcoat roughness", khr({**MATT, "roughnessFactor": 0.7},
                                    clearcoat={"clearcoatFactor": 1}),
         sweep("clearcoat__clearcoatRoughnessFactor", UNIT)),
        ("sheen roughness", khr({**MATT, "roughnessFactor": 1},
                                sheen={"sheenColorFactor": [0.9, 0.8, 0.7]}),
         sweep("sheen__sheenRoughnessFactor", (0.1, 0.3, 0.5, 0.7, 1))),
        ("iridescence thickness, nm", khr({**MATT, "roughnessFactor": 0.1,
                                           "baseColorFactor": [0.02, 0.02, 0.02, 1]},
                                          iridescence={"iridescenceFactor": 1,
                                                       "iridescenceIor": 1.6}),
         sweep("iridescence__iridescenceThicknessMaximum", (100, 200, 300, 400, 600, 800))),
        ("iridescence on metal, ior", khr(BRUSHED, iridescence={
            "iridescenceFactor": 1, "iridescenceThicknessMaximum": 450}),
         sweep("iridescence__iridescenceIor", (1.1, 1.3, 1.6, 2, 2.5))),
        ("anisotropy", khr(BRUSHED), sweep("anisotropy__anisotropyStrength", UNIT)),
        ("anisotropy rotation", khr(BRUSHED, anisotropy={"anisotropyStrength": 0.8}),
         sweep("anisotropy__anisotropyRotation", (0, 0.4, 0.8, 1.2, 1.57))),
        ("transmission, thin", khr({**WHITE, "baseColorFactor": [0.9, 0.6, 0.4, 1]}),
         sweep("transmission__transmissionFactor", UNIT)),
        ("transmission through a volume, roughness",
         khr(WHITE, transmission={"transmissionFactor": 1}, volume=SOLID),
         sweep("roughnessFactor", UNIT)),
        ("attenuation distance", khr(WHITE, transmission={"transmissionFactor": 1}, volume={
            **SOLID, "attenuationColor": [0.3, 0.8, 0.5]}),
         sweep("volume__attenuationDistance", (0.3, 0.7, 1.5, 3, 8))),
        ("dispersion, ior 1.7", khr(WHITE, transmission={"transmissionFactor": 1}, volume=SOLID,
                                    ior={"ior": 1.7}),
         sweep("dispersion__dispersion", (0, 0.3, 1, 2, 4))),
        ("diffuse transmission", khr({**MATT, "roughnessFactor": 0.8}),
         sweep("diffuse_transmission__diffuseTransmissionFactor", UNIT)),
        ("retroreflection", khr(BRUSHED),
         sweep("retroreflection__retroreflectionFactor", UNIT))]),
]


def make_scene(make, tiles, path):
    """A row of spheres before a chequered wall, on a floor, between two lamps and under the sky."""
    doc = Document("A row of the gallery of materials.")
    chequers = doc.texture(png(16, 16, lambda x, y: [(80, 80, 82), (125, 125, 127)][(x + y) % 2]))
    half = SPACING * len(tiles) / 2 + 8
    wall = quad((-half, -8, -3), (2 * half, 0, 0), (0, 16, 0), uv=((0, 1), (half / 4, 0)))
    floor = quad((-half, -1.001, 8), (2 * half, 0, 0), (0, 0, -11))
    wall["normal"] = [(0, 0, 1)] * 4
    floor["normal"] = [(0, 1, 0)] * 4
    textured = {"baseColorTexture": doc.textured(chequers)}
    doc.put(wall, doc.material("wall", (1, 1, 1), pbr=textured))
    doc.put(floor, doc.material("floor", (0.2, 0.2, 0.2)))
    ball = sphere(96, 64)
    for i, (_, swept) in enumerate(tiles):
        made = make(**swept)
        material = doc.material("ball %d" % i, pbr=made.get("pbr", ()), model=made.get("model"))
        if "medium" in made:
            doc.extend(doc.gltf["materials"][material], "CDL_medium", made["medium"])
        for name, value in made.get("extensions", {}).items():
            doc.extend(doc.gltf["materials"][material], name, value)
        doc.put(ball, material, at=((i - (len(tiles) - 1) / 2) * SPACING, 0, 0))
    # One lamp for each sphere, so that all look alike.
    for i in range(len(tiles)):
        x = (i - (len(tiles) - 1) / 2) * SPACING
        doc.panel_light((x - 1.2, 4.5, 4), (x, 0, 0), 1.4, 1.4, (7, 6.8, 6.4))
    sky = radiance_hdr(16, 8, lambda x, y: [0.5 - 0.04 * y] * 3)
    doc.scene("CDL_environment", {"uri": data_uri(sky, "image/vnd.radiance")})
    doc.flat_camera((0, 1.6, 8), (0, 0.0, 0), SPACING * len(tiles), SPACING)
    doc.write(path)


def render(args, make, tiles, folder):
    scene, picture = os.path.join(folder, "row.gltf"), os.path.join(folder, "row.png")
    make_scene(make, tiles, scene)
    command = [os.environ.get("CANDELA", "build/candela"), "render", scene, "-o", picture,
               "--size", "%dx%d" % (args.tile * len(tiles), args.tile), "--spp", str(args.spp),
               "--max-depth", "16", "--tonemap", "neutral", "--quiet"]
    if args.device:
        command += ["--device", args.device]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit("gallery.py: %s" % done.stderr.strip())
    with open(picture, "rb") as file:
        return file.read()


STYLE = """body{font:14px sans-serif;margin:2em;background:#fff;color:#222}
figure{margin:0 0 1.2em}figcaption{margin:.2em 0;font-weight:bold}
.labels{display:flex}.labels span{text-align:center;font-size:11px;color:#444}
img{display:block}h2{margin:1.4em 0 .4em}"""


def figure(args, model, caption, tiles, picture):
    labels = "".join('<span style="width:%dpx">%s</span>' % (args.tile, html.escape(name))
                     for name, _ in tiles)
    return ('<figure><figcaption>%s</figcaption><img width="%d" height="%d" alt="%s" '
            'src="data:image/png;base64,%s"><div class="labels">%s</div></figure>\n'
            % (html.escape(caption), args.tile * len(tiles), args.tile,
               html.escape("%s: %s" % (model, caption)), base64.b64encode(picture).decode(),
               labels))


def main():
    parser = argparse.ArgumentParser(description="Renders a page of all materials.")
    parser.add_argument("-o", "--output", default="build/gallery.html")
    parser.add_argument("--tile", type=int, default=112, help="pixels of a sphere")
    parser.add_argument("--spp", type=int, default=96)
    parser.add_argument("--only", help="rows whose heading or caption has this text")
    parser.add_argument("--device")
    parser.add_argument("--list", action="store_true", help="print the rows and end")
    args = parser.parse_args()
    rows = [(model, *row) for model, entries in GALLERY for row in entries
            if not args.only or args.only in "%s: %s" % (model, row[0])]
    if args.list:
        for model, caption, _, tiles in rows:
            print("%s: %s: %s" % (model, caption, ", ".join(name for name, _ in tiles)))
        return
    start, body, heading = time.time(), [], None
    with tempfile.TemporaryDirectory() as folder:
        for done, (model, caption, make, tiles) in enumerate(rows):
            if sys.stderr.isatty():
                print("\r\033[K%d of %d: %s: %s" % (done + 1, len(rows), model, caption), end="",
                      file=sys.stderr, flush=True)
            if model != heading:
                body.append("<h2>%s</h2>\n" % html.escape(model))
                heading = model
            body.append(figure(args, model, caption, tiles, render(args, make, tiles, folder)))
    page = ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Candela: materials'
            "</title><style>%s</style></head><body><h1>Materials of Candela</h1>\n%s</body></html>\n"
            % (STYLE, "".join(body)))
    with open(args.output, "w", encoding="utf-8") as file:
        file.write(page)
    print("%s: %d rows, %d spheres, %.0f s" % (args.output, len(rows),
                                               sum(len(r[3]) for r in rows), time.time() - start))


main()
