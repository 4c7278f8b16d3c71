#!/usr/bin/env python3
"""Sampling of each material model: relative variance of one sample and time of one sample, as a
Markdown table; beside Mitsuba 3 for the models that it has too.

    CANDELA=build/candela scripts/bench_materials.py [--mitsuba PYTHON] [MODEL ...]

The scene is a floor of the material, 4 x 4 m, seen aslant, under a lamp of 0.4 x 0.4 m and a sky of
radiance 0.3 that is all around; one bounce and what it lights. PYTHON is an interpreter that can
import mitsuba. Both render in turn, BENCH_RUNS times (3); the medians count. Compilation is left
out. Needs NumPy and OpenImageIO's Python module, which are taken from PYTHON.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import scene_kit

ROOT = Path(__file__).resolve().parent.parent
CANDELA = os.environ.get("CANDELA", str(ROOT / "build" / "candela"))
RUNS = int(os.environ.get("BENCH_RUNS", "3"))
SIZE, SPP, DEPTH = 256, 64, 2
EYE, LAMP = (0, 1.6, 3), (0, 1.5, -0.6)

GOLD = {"eta": [0.143, 0.375, 1.442], "k": [3.983, 2.386, 1.603]}
RED = [0.7, 0.3, 0.2]


def microfacets(model, **members):
    """The same for both renderers: Mitsuba masks separably."""
    return dict(model=model, masking="separable", **members)


def conductor(alpha, distribution="ggx"):
    ours = microfacets("conductor", alpha=alpha, distribution=distribution, **GOLD)
    u, v = alpha if isinstance(alpha, list) else (alpha, alpha)
    return ours, {"type": "roughconductor", "alpha_u": u, "alpha_v": v,
                  "distribution": distribution,
                  **{n: {"type": "rgb", "value": GOLD[n]} for n in ("eta", "k")}}


def glass(alpha):
    return (microfacets("dielectric", alpha=alpha, ior=1.5),
            {"type": "roughdielectric", "alpha": alpha, "int_ior": 1.5, "ext_ior": 1.0,
             "distribution": "ggx"})


def color(value):
    return {"type": "rgb", "value": value}


# name: (CDL_material, Mitsuba's BSDF or None, "same" where both are the same function)
MODELS = {
    "diffuse": ({"model": "diffuse", "reflectance": RED},
                {"type": "diffuse", "reflectance": color(RED)}, "same"),
    "oren_nayar 0.5": ({"model": "oren_nayar", "reflectance": RED, "roughness": 0.5}, None, ""),
    "conductor 0.05": (*conductor(0.05), "same"),
    "conductor 0.3": (*conductor(0.3), "same"),
    "conductor 0.4 x 0.05": (*conductor([0.4, 0.05]), "same"),
    "conductor beckmann 0.3": (*conductor(0.3, "beckmann"), "same"),
    "dielectric 0": ({"model": "dielectric", "ior": 1.5},
                     {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}, "same"),
    "dielectric 0.1": (*glass(0.1), "same"),
    "dielectric 0.4": (*glass(0.4), "same"),
    "plastic 0.1": (microfacets("plastic", reflectance=RED, alpha=0.1, ior=1.5),
                    {"type": "roughplastic", "diffuse_reflectance": color(RED), "alpha": 0.1,
                     "int_ior": 1.5, "ext_ior": 1.0, "distribution": "ggx", "nonlinear": True}, ""),
    "retroreflector 0.1": ({"model": "retroreflector", "alpha": 0.1}, None, ""),
    "disney 0.4": ({"model": "disney", "baseColor": RED, "roughness": 0.4},
                   {"type": "principled", "base_color": color(RED), "roughness": 0.4,
                    "specular": 0.5}, ""),
    "disney metallic": ({"model": "disney", "baseColor": RED, "roughness": 0.3, "metallic": 1},
                        {"type": "principled", "base_color": color(RED), "roughness": 0.3,
                         "metallic": 1.0}, ""),
    "disney specTrans": ({"model": "disney", "baseColor": RED, "roughness": 0.3, "specTrans": 1},
                         {"type": "principled", "base_color": color(RED), "roughness": 0.3,
                          "spec_trans": 1.0, "eta": 1.5}, ""),
}


def write_scene(path, material):
    d = scene_kit.Document("sampling of one material")
    floor = scene_kit.quad((-2, 0, 2), (4, 0, 0), (0, 0, -4))
    d.put(floor, d.material("floor", model=material))
    d.panel_light(LAMP, (LAMP[0], 0, LAMP[2]), 0.4, 0.4, (20, 20, 20))
    d.scene("CDL_environment", {"radiance": [0.3, 0.3, 0.3]})
    d.camera(EYE, (0, 0, 0), 40, 1)
    d.write(path)


def render_candela(scene, seed, out, stats):
    subprocess.run([CANDELA, "render", scene, "-o", out, "--size", f"{SIZE}x{SIZE}", "--spp",
                    str(SPP), "--max-depth", str(DEPTH), "--seed", str(seed), "--stats", stats,
                    "--quiet"], check=True)
    times = json.loads(Path(stats).read_text())
    # The first launch of each kernel compiles it where the cache does not have it yet.
    return times["times"]["render_cpu_s"]


def mitsuba_scene(mi, bsdf):
    to_world = mi.ScalarTransform4f
    lamp = to_world().look_at(LAMP, (LAMP[0], 0, LAMP[2]), (0, 0, -1)) @ to_world().scale(0.2)
    floor = to_world().rotate([1, 0, 0], -90) @ to_world().scale(2)
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": DEPTH + 1},
        "sensor": {"type": "perspective", "fov": 40, "fov_axis": "y",
                   "to_world": to_world().look_at(EYE, (0, 0, 0), (0, 1, 0)),
                   "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE,
                            "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent"}},
        "floor": {"type": "rectangle", "to_world": floor, "bsdf": bsdf},
        "lamp": {"type": "rectangle", "to_world": lamp,
                 "emitter": {"type": "area", "radiance": color([20, 20, 20])}},
        "sky": {"type": "constant", "radiance": color([0.3, 0.3, 0.3])}})


def processor_seconds():
    t = os.times()
    return t.user + t.system


def serve_mitsuba():
    """Reads {"bsdf", "seed", "out"} line by line, renders, answers with processor seconds."""
    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    for line in sys.stdin:
        job = json.loads(line)
        scene = mitsuba_scene(mi, job["bsdf"])
        mi.render(scene, spp=1, seed=99).numpy()  # compiles
        start = processor_seconds()
        picture = mi.render(scene, spp=SPP, seed=job["seed"]).numpy()
        print(json.dumps(processor_seconds() - start), flush=True)
        mi.Bitmap(picture).write(job["out"])


def measure(pictures):
    """Prints variance of one sample over the squared mean, and the mean, for pairs of pictures."""
    import numpy as np
    import OpenImageIO as oiio
    a, b = (oiio.ImageBuf(p).get_pixels(oiio.FLOAT)[..., :3].astype(float) for p in pictures)
    mean = ((a + b) / 2).mean()
    half = np.sort((((a - b) ** 2) / 2).mean(-1).ravel())
    kept = half[:int(half.size * 0.999)]  # fireflies would decide alone
    print(json.dumps([kept.mean() / mean ** 2 * SPP, mean]))


def relative_variance(python, a, b):
    done = subprocess.run([python, __file__, "--measure", a, b], check=True, capture_output=True,
                          text=True)
    return json.loads(done.stdout.splitlines()[-1])


def one_model(name, python, server, folder):
    ours, theirs, same = MODELS[name]
    scene, stats = os.path.join(folder, "scene.gltf"), os.path.join(folder, "stats.json")
    write_scene(scene, ours)
    times = {"candela": [], "mitsuba": []}
    files = {who: [os.path.join(folder, f"{who}{s}.exr") for s in (1, 2)] for who in times}
    render_candela(scene, 3, files["candela"][0], stats)  # compiles
    for run in range(RUNS):
        seed = run % 2
        times["candela"].append(render_candela(scene, seed + 1, files["candela"][seed], stats))
        if server and theirs:
            server.stdin.write(json.dumps({"bsdf": theirs, "seed": seed + 1,
                                           "out": files["mitsuba"][seed]}) + "\n")
            server.stdin.flush()
            times["mitsuba"].append(json.loads(server.stdout.readline()))
    row = [name]
    for who in ("candela", "mitsuba"):
        if not times[who]:
            row += ["", "", ""]
            continue
        time.sleep(0.2)  # the server writes its last picture after its answer
        variance, mean = relative_variance(python, *files[who])
        nanoseconds = statistics.median(times[who]) / (SIZE * SIZE * SPP) * 1e9
        row += [f"{variance:.3g}", f"{nanoseconds:.0f}", f"{mean:.4f}"]
    if row[4]:
        ours_cost, theirs_cost = (float(row[i]) * float(row[i + 1]) for i in (1, 4))
        row.append(f"{theirs_cost / ours_cost:.2f}" + ("" if same else " *"))
    else:
        row.append("")
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mitsuba", metavar="PYTHON")
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--measure", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("models", nargs="*", choices=[[], *MODELS], metavar="MODEL")
    arguments = parser.parse_args()
    if arguments.serve:
        return serve_mitsuba()
    if arguments.measure:
        return measure(arguments.measure)
    python, server = arguments.mitsuba or sys.executable, None
    if arguments.mitsuba:
        server = subprocess.Popen([python, __file__, "--serve"], stdin=subprocess.PIPE,
                                  stdout=subprocess.PIPE, text=True)
    print("Variance of a sample over the squared mean (top 0.1 % off), processor time of a sample\n"
          "in ns, mean of the picture; efficiency is 1 / (variance x time). * not the same function.\n")
    head = ["model", "variance", "ns", "mean", "Mitsuba: variance", "ns", "mean",
            "efficiency over Mitsuba's"]
    print("| " + " | ".join(head) + " |\n|---|" + "---:|" * (len(head) - 1))
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.models or MODELS:
            print("| " + " | ".join(one_model(name, python, server, folder)) + " |", flush=True)
    print()
    return None


if __name__ == "__main__":
    main()
