#!/usr/bin/env python3
"""One film, bit for bit: film_sha256 of scenes that between them reach every kernel is equal on
PoCL as it is, with code for SSE2 and AVX2, in plain loops, on one thread and two and on the
basic device, on Mesa's rusticl, with both layouts of the tree, for every cut into parts that are
merged, every crop, and after every interruption.

Equal hashes leave nothing to chance. Scenes are small, since each device compiles every kernel
anew; under CDL_SOAK rusticl gets all scenes, and there are more cuts and interruptions."""
import hashlib
import json
import os
import random
import signal
import subprocess
import time

import numpy as np

from support import crowd
from support.images import read_exr
from support.render import CANDELA, FOLDER, render, run, scratch
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
    missed = {n for n in names - kernels if not n.startswith(("probe", "material_"))}
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
    main(test_scenes_show_something, test_pocl, test_rusticl, test_trees, test_parts, test_crops,
         test_interruptions)
