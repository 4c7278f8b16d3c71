#!/usr/bin/env python3
"""One film, bit for bit: film_sha256 of scenes that between them reach every kernel is equal on
PoCL as it is, with code for SSE2 and AVX2, in plain loops, on one thread and two and on the
basic device, on Mesa's rusticl, with both layouts of the tree, on processors for which the C
library has other functions, for every cut into parts that are merged, every crop, and after every
interruption.

Equal hashes leave nothing to chance. Scenes are small, since each device compiles every kernel
anew; under CDL_SOAK rusticl gets all scenes, and there are more cuts and interruptions."""
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time

import numpy as np

import test_animation as moving
from support import crowd, libm
from support.images import read_exr
from support.render import CANDELA, FOLDER, render, run, scratch
from support.shapes import look_at, move, quad, sphere
from support.verdict import check, main, skip

SOAK = bool(os.environ.get("CDL_SOAK"))
SIZE, SPP, DEPTH = (48, 32), 36, 8
RUSTICL = {"RUSTICL_ENABLE": "llvmpipe"}
_files, _films = {}, {}


def scene(name):
    if name not in _files:
        _files[name] = getattr(crowd, name)().write(os.path.join(FOLDER, name + ".gltf"))
    return _files[name]


def film(name, options=(), environment=None, aov=None):
    return render(scene(name), SIZE, SPP, DEPTH, 5, aov, options, environment)


def whole(name):
    """The film that all others are to equal."""
    if name not in _films:
        _films[name] = film(name)
    return _films[name]


def same(what, name, options=(), environment=None, device=None):
    picture = film(name, options, environment)
    where = picture.stats["device"]
    if device:
        check("%s runs on %s" % (what, device), device in where["name"] + where["platform"],
              "%(platform)s, %(name)s" % where)
    equal = check("%s: %s" % (name, what), picture.sha256 == whole(name).sha256,
                  "%s on %s instead of %s" % (picture.sha256[:16], where["name"],
                                              whole(name).sha256[:16]))
    if not equal:
        different = np.argwhere((picture.rgb != whole(name).rgb).any(-1))
        print("  %d pixels differ, first at x %d, y %d" % (len(different), *different[0][::-1]))
    return picture


def test_scenes_show_something():
    """Hashes of black or broken pictures would prove nothing; seeds matter."""
    for name in ("everything", "layers", "fog", "plain"):
        picture = whole(name)
        check("%s is not dark" % name, 0.05 < picture.rgb.mean() < 5, "%g" % picture.rgb.mean())
        check("%s has no bad samples" % name, picture.stats["bad_samples"] == 0)
        other = render(scene(name), SIZE, SPP, DEPTH, 6, None)
        check("%s depends on the seed" % name, other.sha256 != picture.sha256)
    kernels = {k["name"] for name in ("everything", "layers", "fog")
               for k in whole(name).stats["kernels"]}
    listed = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                          "../../host/device/kernels.def")
    with open(listed) as file:
        names = {line[len("CDL_KERNEL("):].split(",")[0] for line in file
                 if line.startswith("CDL_KERNEL(")}
    layers = film("everything", aov="all")
    check("layers change nothing", layers.sha256 == whole("everything").sha256)
    kernels |= {k["name"] for k in layers.stats["kernels"]}
    # Those of the checks of a device and of `candela bsdf` are no part of a render.
    missed = names - kernels - {"probe_arithmetic", "probe_index", "material_evaluate",
                                "material_sample"}
    check("every kernel runs", not missed, "not %s" % ", ".join(sorted(missed)))


def cpu_has(flag):
    with open("/proc/cpuinfo") as file:
        return (" %s " % flag) in file.read().replace("\n", " ")


def test_pocl():
    for name in ("everything", "layers", "fog", "plain"):
        same("SSE2", name, environment={"POCL_KERNELLIB_NAME": "sse2"}, device="athlon64")
    if cpu_has("avx2"):
        same("AVX2", "everything", environment={"POCL_KERNELLIB_NAME": "avx2"}, device="haswell")
    else:
        skip("AVX2", "this processor has none")
    same("plain loops", "everything", environment={"POCL_WORK_GROUP_METHOD": "loops"})
    same("the basic device", "fog", environment={"POCL_DEVICES": "basic"}, device="basic")
    for name in ("everything", "layers", "fog", "plain"):
        for threads in "12":
            same("%s threads" % threads, name, environment={"POCL_MAX_PTHREAD_COUNT": threads})


def test_rusticl():
    listed, _ = run("devices", "--json", environment=RUSTICL)
    if "llvmpipe" not in listed:
        skip("rusticl", "no llvmpipe device; mesa-opencl-icd has it")
        return
    more = ("everything", "layers") if SOAK else ()
    for name in ("plain", "fog", "without_gloss") + more:
        same("rusticl", name, ("--device", "rusticl"), RUSTICL, "llvmpipe")


def test_trees():
    """Neither layout of the tree nor the reports change a bit."""
    for name in ("everything", "layers", "plain"):
        for width in "28":
            same("--bvh %s" % width, name, ("--bvh", width))
    same("with --profile and --trace", "plain", ("--profile", "--trace", scratch(".json")))


def delicate(textures=(0.5,), brushes=(0.3,), glasses=((0.5, 0.7),)):
    """What the host takes sines, arc tangents and logarithms for: rotated textures, brushed
    surfaces, colours of glass, a spot, a turned sky, a lens of blades, and slerps of bones and
    nodes under an open shutter. Angles, and (colour, distance) of glass, are the caller's."""
    s = moving.skinned(component=moving.FLOAT)
    for number, angle in enumerate(textures):
        codes = np.random.default_rng(number).integers(0, 256, (16, 16, 3)).astype(np.uint8)
        paper = s.material(metallic=0, pbrMetallicRoughness={
            "baseColorTexture": s.texture(codes, transform={"rotation": angle})})
        tile = quad((0, 0, 0), (0.5, 0, 0), (0, 0.5, 0))
        tile["uv0"] = tile["positions"][:, :2] + 0.7
        s.add(tile, paper, move(1.1 * number, 2, -0.5))
    ball = sphere(0.5, (0, 0, 0), 24, 12, smooth=True)
    ball["uv0"] = ball["positions"][:, :2]
    for number, angle in enumerate(brushes):
        brushed = s.material(metallic=1, roughness=0.4, extensions={"KHR_materials_anisotropy": {
            "anisotropyStrength": 0.8, "anisotropyRotation": angle}})
        s.add(ball, brushed, move(1.1 * number - 0.5, -1.5, 0.5))
    for number, (colour, distance) in enumerate(glasses):
        glass = s.material(metallic=0, roughness=0.1, extensions={
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": distance,
                                     "attenuationColor": [colour, 0.8, 1]}})
        s.add(ball, glass, move(1.1 * number + 2, -1.5, 0.5))
    s.animation()
    for skin in s.json["skins"]:
        s.channel((skin["joints"][2], "rotation"), [0, 1],
                  s.values([moving.turned(10), moving.turned(70, (1, 2, 1))], "VEC4"))
    s.add(ball, s.interface({"scattering": [1, 2, 3], "absorption": [0.1, 0, 0],
                             "phase": {"type": "hg", "g": 0.4}}), move(-1, 0.5, 0.5))
    s.light("spot", (80, 70, 60), look_at((3, 4, 5), (1, 0, 0)),
            spot={"innerConeAngle": 0.2, "outerConeAngle": 0.45})
    s.environment(image=np.random.default_rng(4).uniform(0, 1, (16, 32, 3)), rotation=77)
    s.camera(look_at((1.5, 0.5, 8), (1.5, 0, 0)), yfov=33, aspect=1.5, apertureRadius=0.05,
             focusDistance=7.5, blades=7, shutter=[0.0, 0.1])
    return s


def test_c_library():
    """The films of a processor with fused multiply-add and of one without, as far as the C library
    goes; kernels are compiled alike. Scenes have the very angles and colours for which its results
    differ in single precision, if there are any, so that its use would show."""
    angles, glasses = libm.angles("cos") + libm.angles("sin"), libm.attenuations()
    if not angles or not glasses:
        skip("numbers that the C library rounds otherwise", "none found; it may have one variant")
    chance = random.Random(5)
    for what, given in (
            ("as it comes", {}),
            ("rotated textures", {"textures": chance.sample(angles, min(4, len(angles)))}),
            ("brushed surfaces", {"brushes": chance.sample(angles, min(3, len(angles)))}),
            ("coloured glass", {"glasses": chance.sample(glasses, min(3, len(glasses)))})):
        if given and not list(given.values())[0]:
            continue
        path = delicate(**given).write(scratch(".gltf"))
        one, other = (render(path, SIZE, SPP, DEPTH, 5, None, ("--at", "0.37"), environment)
                      for environment in ({"GLIBC_TUNABLES": ""}, libm.OLDER))
        check("%s: is not dark" % what, 0.05 < one.rgb.mean() < 5, "%g" % one.rgb.mean())
        check("%s: on an older processor" % what, one.sha256 == other.sha256,
              "%d pixels differ" % (one.rgb != other.rgb).any(-1).sum())
    for name in ("everything", "layers", "fog"):
        same("on an older processor", name, environment=libm.OLDER)


def test_symbols():
    """No part of the host asks the C library for a function that is not exact, but for those that
    draw pictures of a film and measure them."""
    archive = os.path.join(os.path.dirname(CANDELA), "libcandela.a")
    if not os.path.exists(archive) or not shutil.which("nm"):
        skip("what is asked of the C library", "libcandela.a or nm is not here")
        return
    listed = subprocess.run(["nm", "--undefined-only", "--print-file-name", archive],
                            capture_output=True, text=True, check=True).stdout
    functions = r"(?:a?(?:sin|cos|tan)h?|atan2|sincos|(?:exp|log)(?:2|10|m1|1p)?|pow|cbrt|hypot)"
    inexact = re.compile(r"(\w+)\.c(?:pp)?\.o: +U (?:__)?(%s[fl]?)(?:_finite)?(?:@.*)?$" %
                         functions, re.M)
    asked = set(inexact.findall(listed))
    pictures = {"bsdf_plot", "canvas", "compare", "ssim", "tonemap"}
    # OpenVDB's headers bring rotations of its maps along, which reading a grid does not call.
    asked -= {("vdb", "pow"), ("vdb", "sincos")}
    check("this test sees what is asked", ("tonemap", "powf") in asked)
    wrong = sorted("%s.c: %s" % pair for pair in asked if pair[0] not in pictures)
    check("nothing inexact is asked of the C library", not wrong, ", ".join(wrong))


def parts(total, chance):
    """A random cut of the samples: (first, count), multiples of 16 but for the end."""
    blocks = -(-total // 16)
    cuts = sorted(chance.sample(range(1, blocks), chance.randint(1, blocks - 1)))
    edges = [0] + cuts + [blocks]
    return [(16 * a, min(16 * b, total) - 16 * a) for a, b in zip(edges, edges[1:])]


def test_parts():
    """Every cut into --samples blocks, merged in any order, layers and variance included."""
    chance = random.Random(3)
    for name, total, rounds in (("everything", 84, 2), ("fog", 52, 2), ("plain", 100, 4)):
        path, at_once = scene(name), render(scene(name), SIZE, total, DEPTH, 5, "all")
        for _ in range(3 * rounds if SOAK else rounds):
            cut = parts(total, chance)
            chance.shuffle(cut)
            files = []
            for first, count in cut:
                files.append(render(path, SIZE, total, DEPTH, 5, "all",
                                    ("--samples", "%d:%d" % (first, count))).path)
            out, stats = scratch(".exr"), scratch(".json")
            run("merge", *files, "-o", out, "--stats", stats)
            with open(stats) as file:
                merged = json.load(file)
            what = "%s: merged from %s" % (name, ", ".join("%d:%d" % c for c in cut))
            check(what, merged["film_sha256"] == at_once.sha256)
            channels = read_exr(out)[0]
            check(what + ", all layers", all(np.array_equal(channels[c], plane, equal_nan=True)
                                             for c, plane in at_once.channels.items()))


def test_crops():
    """Crops that tile the picture are the picture: a pixel does not know what is rendered beside
    it."""
    for name, columns, rows in (("everything", (0, 11, 30, 48), (0, 5, 32)),
                                ("fog", (0, 1, 48), (0, 31, 32))):
        tiled = np.empty_like(np.stack([whole(name).channels[c] for c in "RGB"], -1))
        for x0, x1 in zip(columns, columns[1:]):
            for y0, y1 in zip(rows, rows[1:]):
                crop = "%d,%d,%d,%d" % (x0, y0, x1 - x0, y1 - y0)
                tile = film(name, ("--crop", crop))
                tiled[y0:y1, x0:x1] = np.stack([tile.channels[c] for c in "RGB"], -1)
        digest = hashlib.sha256(tiled.astype("<f4").tobytes()).hexdigest()
        check("%s: crops put together" % name, digest == whole(name).sha256)


def interrupt(arguments, delay, number):
    """Starts a render and signals it after `delay`; returns its exit status."""
    process = subprocess.Popen([CANDELA] + arguments, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        _, message = process.communicate(timeout=delay)
    except subprocess.TimeoutExpired:
        process.send_signal(number)
        _, message = process.communicate(timeout=120)
    return process.returncode, message


def test_interruptions():
    """Ctrl-C again and again at random moments, each time gone on from the checkpoint."""
    chance = random.Random(11)
    for name, samples in (("plain", 4096), ("everything", 1024)) if SOAK else (("plain", 4096),):
        settings = ["render", scene(name), "--size", "96x64", "--spp", str(samples),
                    "--max-depth", "4", "--quiet"]
        clock = time.monotonic()
        at_once, stats = scratch(".json"), scratch(".json")
        run(*settings, "-o", scratch(".exr"), "--stats", at_once)
        seconds = time.monotonic() - clock
        checkpoint, out = scratch(".checkpoint"), scratch(".exr")
        resumable = settings + ["-o", out, "--checkpoint", checkpoint, "--resume", "--stats", stats]
        statuses = []
        for number in [signal.SIGINT] * 3 + [signal.SIGTERM]:
            status, message = interrupt(resumable, chance.uniform(0.2, 0.5) * seconds, number)
            statuses.append(status)
            if status not in (0, 130):
                break
        check("%s: interrupted renders end with 130" % name, statuses[0] == 130 and
              set(statuses) <= {0, 130}, "%s %s" % (statuses, message))
        run(*resumable)
        with open(at_once) as a, open(stats) as b:
            films = [json.load(a)["film_sha256"], json.load(b)["film_sha256"]]
        check("%s: gone on after %d interruptions" % (name, statuses.count(130)),
              films[0] == films[1])


if __name__ == "__main__":
    main(test_scenes_show_something, test_pocl, test_rusticl, test_trees, test_c_library,
         test_symbols, test_parts, test_crops, test_interruptions)
