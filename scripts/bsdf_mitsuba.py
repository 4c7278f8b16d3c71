#!/usr/bin/env python3
"""Compares `candela bsdf --pairs` with the same material of Mitsuba 3, pair by pair.

    bsdf_mitsuba.py pairs N SEED > PAIRS.csv
    bsdf_mitsuba.py directions N SEED > VIEWS.csv
    bsdf_mitsuba.py compare MODEL PAIRS.csv VALUES.csv [--alpha X[,Y]] [--ior N] [--eta N --k K]
                    [--distribution ggx|beckmann] [--tolerance REL]

MODEL is conductor or dielectric, smooth, or roughconductor or roughdielectric. For smooth ones, which
are delta lobes, VIEWS.csv takes the place of PAIRS.csv, and VALUES.csv is what `candela bsdf --sample
1` prints for it: wi, weight, pdf; directions and weights are compared with those of Mitsuba's lobe on
the same side, and the share of reflections with Mitsuba's probability. For rough ones: Mitsuba masks separably, so the material's `masking` must
be "separable"; its reflectance and transmittance are 1. PAIRS.csv holds wo.x,wo.y,wo.z,wi.x,wi.y,
wi.z in the local frame, VALUES.csv what candela prints for it: f.r,f.g,f.b,pdf. Prints the largest
relative differences of f and of the pdf; exits with 1 where more than one f in a thousand differs by
more than the tolerance, 1e-3, or any by ten times that: beside total reflection single precision
leaves both renderers three digits. The
pdf of reflection by a conductor differs where ours bounds the visible normals, and is not judged.
Mitsuba's masking of Beckmann's facets is a rational fit, 0.35 % off for one direction; ours is exact,
so that distribution's tolerance is 8e-3 unless given. Values below 1e-5 of the largest are compared
with that.

Needs numpy and the Python package mitsuba.
"""
import argparse
import sys

import numpy as np


def write_pairs(count, seed, vectors=2):
    random = np.random.default_rng(seed)
    for _ in range(count):
        pair = random.normal(size=(vectors, 3))
        pair /= np.linalg.norm(pair, axis=1)[:, None]
        if vectors == 2:
            pair[0, 2] = abs(pair[0, 2])
        print(",".join(f"{x:.9g}" for x in pair.ravel()))


def material(options):
    scene = {"type": options.model}
    if options.model.startswith("rough"):
        scene["alpha_u"], scene["alpha_v"] = (options.alpha + options.alpha)[:2]
        scene["distribution"] = options.distribution
    if options.model.endswith("conductor"):
        scene["eta"] = {"type": "rgb", "value": [options.eta] * 3}
        scene["k"] = {"type": "rgb", "value": [options.k] * 3}
    else:
        scene["int_ior"], scene["ext_ior"] = options.ior, 1.0
    return scene


def mitsuba_values(options, pairs):
    """f without the cosine, and the pdf, of each pair."""
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    bsdf, context = mi.load_dict(material(options)), mi.BSDFContext()
    values = np.zeros((len(pairs), 2))
    for row, pair in zip(values, pairs):
        si = mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f(*pair[:3])  # Mitsuba's wi is where the radiance goes
        wi = mi.Vector3f(*pair[3:])
        row[0] = bsdf.eval(context, si, wi)[1] / abs(pair[5])
        row[1] = bsdf.pdf(context, si, wi)
    return values


def mitsuba_lobe(bsdf, view, above):
    """Direction, weight and probability of the delta lobe on one side; None where there is none."""
    import mitsuba as mi
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(*view)
    for choice in (0.0, 0.9999999):
        sample, weight = bsdf.sample(mi.BSDFContext(), si, choice, mi.Point2f(0.5, 0.5))
        if sample.pdf > 0 and (sample.wo[2] > 0) == above:
            return np.array(sample.wo), weight[0], sample.pdf
    return None


def compare_smooth(options):
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    bsdf = mi.load_dict(material(options))
    views = np.loadtxt(options.pairs, delimiter=",", ndmin=2)
    ours = np.loadtxt(options.values, delimiter=",", ndmin=2)
    if options.model == "conductor":
        ours, views = ours[views[:, 2] > 0], views[views[:, 2] > 0]
    worst, expected, variance, reflected = np.zeros(2), 0.0, 0.0, 0
    for view, row in zip(views, ours):
        lobe = mitsuba_lobe(bsdf, view, row[2] > 0)
        if lobe is None:
            print(f"from {view}: Mitsuba has no lobe along {row[:3]}")
            return 1
        mirrors = (row[2] > 0) == (view[2] > 0)
        probability = lobe[2] if mirrors else 1 - lobe[2]
        reflected, expected = reflected + mirrors, expected + probability
        variance += probability * (1 - probability)
        errors = np.abs(row[:3] - lobe[0]).max(), abs(row[3] - lobe[1]) / max(lobe[1], 1e-5)
        worst = np.maximum(worst, errors)
    off = abs(reflected - expected) / max(np.sqrt(variance), 1e-3)
    print(f"{len(views)} views: directions differ by {worst[0]:.3g}, weights by {worst[1]:.3g} of "
          f"themselves; {reflected} reflections, {expected:.1f} expected, {off:.2f} deviations off")
    tolerance = options.tolerance or 1e-3
    return int(worst[0] > tolerance or worst[1] > tolerance or off > 4.5)


def compare(options):
    pairs = np.loadtxt(options.pairs, delimiter=",", ndmin=2)
    ours = np.loadtxt(options.values, delimiter=",", ndmin=2)[:, [1, 3]]
    theirs = mitsuba_values(options, pairs)
    scale = np.maximum(np.abs(ours), np.abs(theirs))
    error = np.abs(ours - theirs) / np.maximum(scale, 1e-5 * scale.max(axis=0))
    for name, column in (("f", 0), ("pdf", 1)):
        worst = int(np.argmax(error[:, column]))
        print(f"{name}: largest relative difference {error[worst, column]:.3g}, 99.9 % below "
              f"{np.quantile(error[:, column], 0.999):.3g}; at pair {worst}: "
              f"{ours[worst, column]:.9g}, Mitsuba {theirs[worst, column]:.9g}")
    tolerance = options.tolerance or (8e-3 if options.distribution == "beckmann" else 1e-3)
    outside = np.mean(error[:, 0] > tolerance) > 1e-3 or error[:, 0].max() > 10 * tolerance
    return int(outside)


def main():
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="command", required=True)
    pairs = commands.add_parser("pairs")
    pairs.add_argument("count", type=int)
    pairs.add_argument("seed", type=int)
    views = commands.add_parser("directions")
    views.add_argument("count", type=int)
    views.add_argument("seed", type=int)
    judge = commands.add_parser("compare")
    judge.add_argument("model", choices=["conductor", "dielectric", "roughconductor",
                                         "roughdielectric"])
    judge.add_argument("pairs")
    judge.add_argument("values")
    judge.add_argument("--alpha", type=lambda s: [float(x) for x in s.split(",")], default=[0.1])
    judge.add_argument("--ior", type=float, default=1.5)
    judge.add_argument("--eta", type=float, default=0.2)
    judge.add_argument("--k", type=float, default=3.0)
    judge.add_argument("--distribution", choices=["ggx", "beckmann"], default="ggx")
    judge.add_argument("--tolerance", type=float)
    options = parser.parse_args()
    if options.command != "compare":
        write_pairs(options.count, options.seed, 2 if options.command == "pairs" else 1)
        return 0
    return compare(options) if options.model.startswith("rough") else compare_smooth(options)


if __name__ == "__main__":
    sys.exit(main())
