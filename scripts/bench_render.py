#!/usr/bin/env python3
"""Times renders and prints Markdown tables: kernels under two work-group methods of PoCL, cold and
warm start, and one core against two.

    CANDELA=build/candela scripts/bench_render.py kernels|start|cores [SCENE ...]

`kernels` runs every scene alternately as usual and with everything switched off that vectorises
shading (POCL_WORK_GROUP_METHOD=loops, CANDELA_STRIP=1), and gives for each kernel the median time of
an item. `cores` and `kernels` say something about PoCL only.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CANDELA = os.environ.get("CANDELA", str(ROOT / "build" / "candela"))
RUNS = int(os.environ.get("BENCH_RUNS", "5"))
SETTINGS = ["--size", "256x256", "--spp", "16", "--max-depth", "8", "--quiet"]
FEWEST_ITEMS = 20000


def render(scene, folder, environment, settings=()):
    """The statistics of one render."""
    stats = Path(folder) / "stats.json"
    command = [CANDELA, "render", str(scene), "-o", str(Path(folder) / "image.exr"), *SETTINGS,
               *settings, "--stats", str(stats)]
    done = subprocess.run(command, env={**os.environ, **environment}, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return json.loads(stats.read_text())


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "|".join(["---"] + ["---:"] * (len(head) - 1)) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


METHODS = {"vectorised": {"POCL_WORK_GROUP_METHOD": "loopvec"},
           "scalar": {"POCL_WORK_GROUP_METHOD": "loops", "CANDELA_STRIP": "1"}}


def nanoseconds(kernel):
    """Time of an item, compilation left out, or None where there is too little to say."""
    return kernel["total_s"] / kernel["items"] * 1e9 if kernel["items"] >= FEWEST_ITEMS else None


def kernels(scenes):
    for scene in scenes:
        times = {}
        with tempfile.TemporaryDirectory() as folder:
            for run in range(RUNS + 1):
                for method, environment in METHODS.items():
                    cache = Path(folder) / method
                    cache.mkdir(exist_ok=True)
                    stats = render(scene, folder, {"XDG_CACHE_HOME": str(cache), **environment},
                                   ["--profile"])
                    for kernel in stats["kernels"] if run else []:
                        each = nanoseconds(kernel)
                        if each is not None:
                            times.setdefault(kernel["name"], {}).setdefault(method, []).append(each)
        rows = []
        for name, of in times.items():
            if len(of) == 2:
                fast, slow = (statistics.median(of[method]) for method in METHODS)
                rows.append([name, f"{fast:.1f}", f"{slow:.1f}", f"{slow / max(fast, 1e-3):.1f}"])
        print(f"**{scene.name}**: median of {RUNS} alternating runs, ns an item\n")
        table(["kernel", "vectorised", "scalar", "factor"], rows)


def first_sample(scene, folder, cache):
    """Seconds from the start of the process until one small tile is finished."""
    stats = render(scene, folder, {"XDG_CACHE_HOME": str(cache)}, ["--size", "64x64"])
    return stats["times"]["wall_s"]


def start(scenes):
    rows = []
    for scene in scenes:
        cold, warm = [], []
        for _ in range(max(RUNS // 2, 1)):
            with tempfile.TemporaryDirectory() as folder:
                cache = Path(folder) / "cache"
                cache.mkdir()
                cold.append(first_sample(scene, folder, cache))
                warm += [first_sample(scene, folder, cache) for _ in range(2)]
        rows.append([scene.name, f"{statistics.median(cold):.2f}", f"{statistics.median(warm):.2f}"])
    print("Seconds of a whole render of 64x64 pixels, 16 samples: empty and filled kernel cache\n")
    table(["scene", "cold", "warm"], rows)


def cores(scenes):
    rows = []
    for scene in scenes:
        times = {"1": [], "2": []}
        with tempfile.TemporaryDirectory() as folder:
            for run in range(RUNS + 1):
                for count in times:
                    stats = render(scene, folder, {"POCL_MAX_PTHREAD_COUNT": count}, ["--spp", "64"])
                    times[count] += [stats["times"]["render_s"]] if run else []
        one, two = (statistics.median(times[count]) for count in times)
        rows.append([scene.name, f"{one:.2f}", f"{two:.2f}", f"{one / two:.2f}"])
    print(f"Seconds of rendering, median of {RUNS} alternating runs\n")
    table(["scene", "1 core", "2 cores", "speed-up"], rows)


def main():
    what = {"kernels": kernels, "start": start, "cores": cores}
    if len(sys.argv) < 3 or sys.argv[1] not in what:
        sys.exit(__doc__)
    what[sys.argv[1]]([Path(name) for name in sys.argv[2:]])


if __name__ == "__main__":
    main()
