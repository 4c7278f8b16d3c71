#!/usr/bin/env python3
"""The scenes of ../shared/references, rendered twice with seeds of their own and judged by the
statistics of its compare.py: pixels by a z-test (1 % over all pixels, 99.75 % accepted), the mean
(3 standard errors or 0.5 %), blocks of 8 x 8 pixels (4 standard errors or 3 %, 99 %). Noise is
taken once from the difference of both renders, smoothed, and once from the variance that the
renders carry themselves.

Power, at 1024 samples a pixel and more in all: the standard error of the mean is 0.1 % or less, so
the mean is asked for more than compare.py does, to 4 standard errors or 0.15 %; and blocks find an
alpha wrong by 5 %. Skipped where ../shared is absent."""
import glob
import importlib.util
import json
import os

import numpy as np

from support.render import render
from support.verdict import check, main, skip

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.abspath(os.path.join(HERE, "../../../shared/references"))
SPP = {"veach_mis": 1024}  # 512 for all others


def scenes():
    """Every scene of the folder, by name, and everything that is there to go with one."""
    names = set()
    for path in glob.glob(os.path.join(FOLDER, "*.*")):
        name, end = os.path.splitext(os.path.basename(path))
        if end in (".gltf", ".glb", ".json", ".exr"):
            names.add(name[:-len("_var")] if name.endswith("_var") else name)
    return sorted(names)


def statistics():
    """compare.py, as a module."""
    spec = importlib.util.spec_from_file_location("compare", os.path.join(FOLDER, "compare.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def judge(what, tools, rendered, variance, reference, reference_variance):
    with np.errstate(invalid="ignore"):
        result = tools.compare(rendered, variance, reference, reference_variance)
    bias = "  ".join("%+.2f %% +- %.2f" % pair for pair in zip(result["bias"], result["error"]))
    detail = "%.3f %% of the pixels accepted, bias %s, %.2f %% of the blocks off" % (
        100 * result["accepted"], bias, 100 * result["blocks_off"])
    print("%s: %s" % (what, detail), flush=True)
    check(what, result["pixels_ok"] and result["bias_ok"] and result["blocks_ok"], detail)
    off, error = np.abs(result["bias"]), result["error"]
    check(what + ": mean", np.all((off <= 4 * error) | (off <= 0.15)), detail)


def compare_scene(tools, name, spp):
    with open(os.path.join(FOLDER, name + ".json")) as file:
        about = json.load(file)
    path = os.path.join(FOLDER, name + ".gltf")
    a, b = (render(path, tuple(about["size"]), spp, about["max_depth"], seed) for seed in (1, 2))
    reference = tools.read_exr(os.path.join(FOLDER, name + ".exr"))
    variance = tools.read_exr(os.path.join(FOLDER, name + "_var.exr"))
    both = (a.rgb + b.rgb) / 2
    by_difference = tools.smooth((a.rgb - b.rgb) ** 2) / 4
    judge(name, tools, both, by_difference, reference, variance)
    judge(name + ", by its own variance", tools, both, (a.variance + b.variance) / 4, reference,
          variance)
    check(name + ": no bad samples", a.stats["bad_samples"] == b.stats["bad_samples"] == 0)


def test_references():
    if not os.path.isdir(FOLDER):
        skip("references", "%s is absent" % FOLDER)
        return
    tools, names = statistics(), scenes()
    check("there are scenes", names, FOLDER)
    for name in names:
        missing = [end for end in (".gltf", ".json", ".exr", "_var.exr")
                   if not os.path.exists(os.path.join(FOLDER, name + end))]
        if check(name + ": is complete", not missing, "no %s" % ", ".join(missing)):
            compare_scene(tools, name, SPP.get(name, 512))


if __name__ == "__main__":
    main(test_references)
