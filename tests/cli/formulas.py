#!/usr/bin/env python3
"""`candela bsdf` against other people's formulas at 10^4 pairs of directions, to 1e-3: those of
papers in double precision (scripts/bsdf_reference.py), and with CDL_SOAK=1 Mitsuba's
(scripts/bsdf_mitsuba.py) by the Python that MITSUBA_PYTHON names, if that has it."""
import json
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed\n0 passed, 0 failed, 1 skipped")
    sys.exit(0)

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.path.join(ROOT, "scripts")
CANDELA = os.path.abspath(os.environ.get("CANDELA", os.path.join(ROOT, "build", "candela")))
PAIRS = 10000

# Those of scripts/bsdf_reference.py.
PUBLISHED = [
    dict(model="oren_nayar", reflectance=[0.9, 0.5, 0.1], roughness=0.0),
    dict(model="oren_nayar", reflectance=[0.9, 0.5, 0.1], roughness=0.4),
    dict(model="oren_nayar", reflectance=[1, 1, 1], roughness=1.0),
    dict(model="plastic", reflectance=[0.8, 0.4, 0.1], alpha=0.2, ior=1.5),
    dict(model="plastic", reflectance=[0.8, 0.4, 0.1], alpha=[0.5, 0.1], ior=1.8),
    dict(model="plastic", reflectance=[1, 1, 1], alpha=0.4, ior=1.3, distribution="beckmann",
         masking="separable"),
    dict(model="disney", baseColor=[0.8, 0.4, 0.1], roughness=0.5),
    dict(model="disney", baseColor=[0.8, 0.4, 0.1], roughness=0.3, metallic=1, anisotropic=0.8),
    dict(model="disney", baseColor=[0.8, 0.4, 0.1], roughness=0.7, sheen=1, sheenTint=0.5,
         clearcoat=1, clearcoatGloss=0.8, specular=0.9, specularTint=0.6),
    dict(model="disney", baseColor=[0.2, 0.4, 0.9], roughness=0.8, subsurface=0.7, metallic=0.3),
    dict(model="disney", baseColor=[0.8, 0.6, 0.3], roughness=0.4, specTrans=1, ior=1.5),
    dict(model="disney", baseColor=[0.8, 0.6, 0.3], roughness=0.6, specTrans=0.5, ior=1.33,
         anisotropic=0.5),
    dict(model="disney", baseColor=[0.8, 0.6, 0.3], roughness=0.5, specTrans=0.4, ior=1.4,
         thin=True, diffTrans=1.2, flatness=0.5),
]
METAL = dict(eta=[0.2] * 3, k=[3.0] * 3)
# Material, and the arguments of scripts/bsdf_mitsuba.py.
MITSUBA = [
    (dict(METAL, model="conductor"), "conductor"),
    (dict(model="dielectric", ior=1.5), "dielectric --ior 1.5"),
    (dict(model="dielectric", ior=1.25), "dielectric --ior 1.25"),
    (dict(METAL, model="conductor", alpha=0.1), "roughconductor --alpha 0.1"),
    (dict(METAL, model="conductor", alpha=[0.5, 0.2]), "roughconductor --alpha 0.5,0.2"),
    (dict(METAL, model="conductor", alpha=0.3, distribution="beckmann"),
     "roughconductor --alpha 0.3 --distribution beckmann"),
    (dict(model="dielectric", alpha=0.3, ior=1.5), "roughdielectric --alpha 0.3 --ior 1.5"),
    (dict(model="dielectric", alpha=0.1, ior=1.33), "roughdielectric --alpha 0.1 --ior 1.33"),
    (dict(model="dielectric", alpha=[0.4, 0.2], ior=1.5, distribution="beckmann"),
     "roughdielectric --alpha 0.4,0.2 --ior 1.5 --distribution beckmann"),
]
counts = {"passed": 0, "failed": 0, "skipped": 0}


def report(verdict, what):
    counts[verdict] += 1
    print(f"{verdict}: {what}")


def bsdf(material, task, lines):
    """What the command prints for a material alone in a scene."""
    material = dict(material)
    if "alpha" in material and material["model"] in ("conductor", "dielectric"):
        material.setdefault("masking", "separable")
    with open("scene.gltf", "w", encoding="utf-8") as file:
        json.dump({"asset": {"version": "2.0"}, "extensionsUsed": ["CDL_material"], "scene": 0,
                   "scenes": [{}],
                   "materials": [{"name": "m", "extensions": {"CDL_material": material}}]}, file)
    with open(lines, encoding="utf-8") as file:
        done = subprocess.run([CANDELA, "bsdf", "scene.gltf", "--material", "m", *task], stdin=file,
                              capture_output=True, text=True, check=False)
    with open("values.csv", "w", encoding="utf-8") as file:
        file.write(done.stdout)
    if done.returncode:
        print(done.stderr.strip())
    return done.returncode == 0


def compare_published():
    sys.path.insert(0, SCRIPTS)
    import bsdf_reference
    random = np.random.default_rng(11)
    pairs = random.normal(size=(PAIRS, 2, 3))
    pairs /= np.linalg.norm(pairs, axis=2)[:, :, None]
    np.savetxt("pairs.csv", pairs.reshape(PAIRS, 6), "%.9g", ",")
    pairs = np.loadtxt("pairs.csv", delimiter=",")
    for material in PUBLISHED:
        if not bsdf(material, ["--pairs", "-"], "pairs.csv"):
            report("failed", json.dumps(material))
            continue
        got = np.loadtxt("values.csv", delimiter=",", ndmin=2)[:, :3]
        want, error = bsdf_reference.compare(material, pairs[:, :3], pairs[:, 3:6], got)
        worst = int(error.argmax())
        report("passed" if error[worst] <= 1e-3 else "failed",
               f"{json.dumps(material)}: {PAIRS} pairs, worst {error[worst]:.2e} at {pairs[worst]}: "
               f"{got[worst]}, expected {want[worst]}")


def compare_mitsuba():
    if os.environ.get("CDL_SOAK", "0") in ("", "0"):
        return report("skipped", "Mitsuba is compared by `make soak`")
    python = os.environ.get("MITSUBA_PYTHON", sys.executable)
    probe = subprocess.run([python, "-c", "import mitsuba, numpy"], capture_output=True, check=False)
    if probe.returncode:
        return report("skipped", f"{python} has no mitsuba; name another by MITSUBA_PYTHON")
    script = os.path.join(SCRIPTS, "bsdf_mitsuba.py")
    for name in ("pairs", "directions"):
        with open(name + ".csv", "w", encoding="utf-8") as file:
            subprocess.run([python, script, name, str(PAIRS), "5"], stdout=file, check=True)
    for material, arguments in MITSUBA:
        smooth = "alpha" not in material
        lines = "directions.csv" if smooth else "pairs.csv"
        done = bsdf(material, ["--sample", "1"] if smooth else ["--pairs", "-"], lines)
        model, *options = arguments.split()
        judged = subprocess.run([python, script, "compare", model, lines, "values.csv", *options],
                                capture_output=True, text=True, check=False)
        report("passed" if done and judged.returncode == 0 else "failed",
               f"Mitsuba's {arguments}: {judged.stdout.strip()} {judged.stderr.strip()[-300:]}")
    return None


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    compare_published()
    compare_mitsuba()
    os.chdir(ROOT)
print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
sys.exit(counts["failed"] > 0)
