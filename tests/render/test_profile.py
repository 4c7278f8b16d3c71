#!/usr/bin/env python3
"""What a profile says must add up: time to the wall clock, launches to the trace, and items and
rays to what scenes of known light paths take: a mirror or a diffuse sheet that fills the picture."""
import json
import re

from support.crowd import fog, plain
from support.render import run, scratch
from support.scene import Scene
from support.shapes import look_at, quad
from support.verdict import check, main

SIZE, SPP = (64, 48), 48
SAMPLES = SIZE[0] * SIZE[1] * SPP
PAD = 64  # queues are filled up to multiples of this
REST = ("compilation", "transfers", "host")


def profiled(scene, *options, size=SIZE, spp=SPP):
    """(statistics, rows of the printed table, trace) of one render."""
    stats, trace = scratch(".json"), scratch(".json")
    _, table = run("render", scene.write(scratch(".gltf")), "-o", scratch(".exr"), "--quiet",
                   "--size", "%dx%d" % size, "--spp", spp, "--profile", "--stats", stats,
                   "--trace", trace, *options)
    with open(stats) as file, open(trace) as events:
        return json.load(file), rows_of(table), json.load(events)["traceEvents"]


def rows_of(table):
    """{name: numbers of the row}; a * behind a name says that the host took the times."""
    rows = {}
    for line in table.splitlines()[1:]:
        found = re.match(r"([a-z_]+(?: [a-z]+)?)\*? +([-0-9. ]+)$", line)
        if found:
            rows[found[1]] = [float(n) for n in found[2].split()]
    return rows


def by_name(stats):
    return {kernel["name"]: kernel for kernel in stats["kernels"]}


def close(a, b, relative=1e-3, absolute=0.0):
    return abs(a - b) <= relative * max(abs(a), abs(b)) + absolute


def check_time(what, stats, rows):
    kernels, times = by_name(stats), stats["times"]
    total = 1e3 * sum(k["total_s"] for k in kernels.values())
    check(what + ": kernels add up", close(rows["all kernels"][0], total, absolute=0.02),
          "%s ms in rows, %s ms in all" % (total, rows["all kernels"][0]))
    parts = rows["all kernels"][0] + sum(rows[name][0] for name in REST)
    check(what + ": the parts add up to the wall time",
          close(parts, rows["wall time"][0], absolute=0.05),
          "%s ms of %s ms" % (parts, rows["wall time"][0]))
    shares = sum(rows[name][1] for name in ("all kernels",) + REST)
    check(what + ": shares add up to 100 %", abs(shares - 100) < 0.25, str(shares))
    least = 1e3 * (times["compile_s"] + times["upload_s"] + times["render_s"])
    check(what + ": the wall time is that of the statistics",
          0.999 * least - 0.02 <= rows["wall time"][0] <= 1e3 * times["wall_s"],
          "%s ms, not from %s to %s s" % (rows["wall time"][0], least, times["wall_s"]))
    # Kernels run one after the other, so that they cannot take longer than there was.
    check(what + ": kernels within the render's time", total <= 1050 * times["render_s"],
          "%s ms of %s s" % (total, times["render_s"]))


def check_kernels(what, stats, rows, trace):
    kernels = by_name(stats)
    for name, k in kernels.items():
        at = "%s: %s: " % (what, name)
        launches, items, total = rows[name][:3]
        check(at + "table and statistics agree", launches == k["launches"] and
              items == k["items"] and close(total, 1e3 * k["total_s"], absolute=0.01))
        check(at + "min, median and max are in order",
              0 < k["min_s"] <= k["median_s"] <= k["max_s"], str(k))
        others = k["launches"] - 1
        check(at + "launches add up to the total",
              others * k["min_s"] <= k["total_s"] * 1.001 and
              k["total_s"] <= (k["first_s"] + others * k["max_s"]) * 1.001, str(k))
        events = [e for e in trace if e["name"] == name and "items" in e.get("args", ())]
        if name == "camera_medium":  # launched once, before a trace can begin
            continue
        check(at + "the trace has every launch", len(events) == k["launches"] and
              sum(e["args"]["items"] for e in events) == k["items"] and
              close(1e-6 * sum(e["dur"] for e in events), k["total_s"],
                    absolute=1e-6 * len(events)))
    named = set(rows) - {"all kernels", "wall time", *REST}
    check(what + ": the table has the same kernels", named == set(kernels),
          str(named ^ set(kernels)))


def check_items(what, stats, size=SIZE, spp=SPP):
    """Rays of the statistics against items of the kernels that trace them."""
    kernels, rays = by_name(stats), stats["rays"]
    samples = size[0] * size[1] * spp
    check(what + ": a path and a camera ray for each sample",
          stats["paths"] == rays["camera"] == samples, str(rays))
    traced = {"intersect": rays["camera"] + rays["bounce"], "occlude": rays["shadow"]}
    for name, count in traced.items():
        k = kernels.get(name, {"items": 0, "launches": 0})
        check("%s: %s has its rays" % (what, name), k.get("rays", 0) == count <= k["items"],
              "%s of %d" % (k, count))
        if count:
            check("%s: %s: Mray/s" % (what, name),
                  close(k["mrays_per_s"], 1e-6 * count / k["total_s"]))
    ray_kernels = {name for name, k in kernels.items() if "mrays_per_s" in k}
    check(what + ": Mray/s of ray kernels alone",
          ray_kernels == {name for name, count in traced.items() if count}, str(ray_kernels))
    check(what + ": Mray/s of all", close(
        stats["mrays_per_s"], 1e-6 * sum(rays.values()) / stats["times"]["render_s"]))
    for name in ("generate", "queue_move"):
        k = kernels[name]
        check("%s: %s: no path is missing" % (what, name), k["items"] >= samples)
    pads = kernels["generate"]["items"] - samples
    check(what + ": generate makes the samples and pads alone",
          pads < PAD * kernels["generate"]["launches"], "%d pads" % pads)
    check(what + ": film", kernels["film"]["items"] % (size[0] * size[1]) == 0)


def sheet(material):
    """A sheet in front of an orthographic camera, wider than the picture, that sees the sky."""
    s = Scene()
    s.environment(radiance=1)
    s.add(quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), material(s))
    s.camera(look_at((0, 0, 5), (0, 0, 0)), half_height=1, aspect=4 / 3)
    return s


def test_mirror():
    """Every camera ray meets the mirror, and goes on into the sky; no light is sampled."""
    stats, rows, trace = profiled(sheet(lambda s: s.material({"model": "mirror"})))
    check("mirror: rays", stats["rays"] == {"camera": SAMPLES, "bounce": SAMPLES, "shadow": 0},
          str(stats["rays"]))
    check_time("mirror", stats, rows)
    check_kernels("mirror", stats, rows, trace)
    check_items("mirror", stats)
    check("mirror: shade_mirror", by_name(stats)["shade_mirror"]["items"] == SAMPLES)
    check("mirror: nothing shades otherwise",
          [n for n in by_name(stats) if n.startswith("shade_")] == ["shade_mirror"])


def test_diffuse():
    """Every camera ray samples the sky once by a shadow ray and once by going on. A few go on so
    close to the sheet that nothing is left of them."""
    stats, rows, trace = profiled(sheet(lambda s: s.diffuse(0.5)), "--max-depth", 1)
    rays = stats["rays"]
    check("diffuse: rays", 0.99 * SAMPLES <= rays["bounce"] <= SAMPLES and
          0.45 * SAMPLES <= rays["shadow"] <= SAMPLES and rays["camera"] == SAMPLES, str(rays))
    check_time("diffuse", stats, rows)
    check_kernels("diffuse", stats, rows, trace)
    check_items("diffuse", stats)
    check("diffuse: shade_diffuse", by_name(stats)["shade_diffuse"]["items"] == SAMPLES)


def test_nothing_scatters():
    """No event, no bounce, no shadow."""
    stats, _, _ = profiled(sheet(lambda s: s.diffuse(0.5)), "--max-depth", 0)
    check("depth 0: rays", stats["rays"] == {"camera": SAMPLES, "bounce": 0, "shadow": 0},
          str(stats["rays"]))


def test_whole_scenes():
    """Rooms and fog, of a size that is no multiple of anything; a part of them is its share."""
    for name, scene in (("room", plain()), ("fog", fog())):
        size, spp = (61, 37), 35
        stats, rows, trace = profiled(scene, size=size, spp=spp)
        check_time(name, stats, rows)
        check_kernels(name, stats, rows, trace)
        check_items(name, stats, size, spp)
        check(name + ": light is looked for", 0 < stats["rays"]["shadow"] and
              0 < stats["rays"]["bounce"], str(stats["rays"]))


def test_without():
    """Nobody asked: no times are taken."""
    stats, out = scratch(".json"), scratch(".exr")
    path = plain().write(scratch(".gltf"))
    _, said = run("render", path, "-o", out, "--size", "8x8", "--spp", 1, "--quiet")
    check("no table without --profile", said == "", said)
    run("render", path, "-o", out, "--size", "8x8", "--spp", 1, "--quiet", "--stats", stats)
    with open(stats) as file:
        check("--stats alone has kernels", len(json.load(file)["kernels"]) > 5)


if __name__ == "__main__":
    main(test_mirror, test_diffuse, test_nothing_scatters, test_whole_scenes, test_without)
