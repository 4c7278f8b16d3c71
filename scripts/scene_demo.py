"""The demo: the five materials of an introduction to light side by side, one of them in fog."""
import math

from scene_kit import (CLAMP, Document, add, circle, cross, encoded, flipped, lathe, lattice,
                       looking, mixed, png, rounded_cylinder, sphere, sub, times, torus, turn, unit)

SPHERE = sphere()

# ---- Lettering: strokes on a grid 4 wide and 6 high, y down; a stroke is a chain of points.

LETTERS = {
    "A": "06 20 46|14 34", "D": "00 20 41 45 26 06 00", "E": "40 00 06 46|03 33",
    "F": "40 00 06|03 33", "G": "41 30 10 01 05 16 36 45 43 23", "I": "20 26", "L": "00 06 46",
    "M": "06 00 23 40 46", "O": "10 30 41 45 36 16 05 01 10", "R": "06 00 30 41 42 33 03|23 46",
    "S": "41 30 10 01 02 13 33 44 45 36 16 05", "T": "00 40|20 26", "U": "00 05 16 36 45 40",
    "Y": "00 23 40|23 26"}


def strokes(text):
    """Segments (x0, y0, x1, y1) of a line of text, and its width."""
    left, segments = 0.0, []
    for letter in text:
        narrow = 2 if letter == "I" else 0
        for chain in LETTERS[letter].split("|"):
            points = [(left + int(p[0]) - narrow, int(p[1])) for p in chain.split()]
            segments += [(*a, *b) for a, b in zip(points, points[1:])]
        left += 1.9 if narrow else 5.9
    return segments, left - 1.9


def distance(x, y, segment):
    x0, y0, x1, y1 = segment
    dx, dy = x1 - x0, y1 - y0
    t = min(max(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0), 1)
    return math.hypot(x - x0 - t * dx, y - y0 - t * dy)


def lettering(text, ground, ink, width=256, height=48):
    """A picture of a word in the middle, its strokes smooth at the edge."""
    segments, length = strokes(text)
    scale = height / 12

    def pixel(x, y):
        at = ((x + 0.5 - width / 2) / scale + length / 2, (y + 0.5 - height / 2) / scale + 3)
        away = min(distance(*at, s) for s in segments) - 0.42
        return mixed(ink, ground, min(max(away * scale + 0.5, 0), 1))

    return png(width, height, pixel)


# ---- The scene

DEMO = [
    ("DIFFUSE", {"model": "diffuse", "reflectance": [0.80, 0.22, 0.13]}),
    ("GLOSSY", {"model": "conductor", "metal": "Au", "alpha": 0.22}),
    ("MIRROR", {"model": "mirror", "reflectance": [0.94, 0.95, 0.96]}),
    ("GLASS", {"model": "dielectric", "ior": 1.5}),
    ("RETRO", {"model": "retroreflector", "reflectance": [0.55, 0.95, 0.12], "alpha": 0.08})]


def honeycomb(x, y, across=26):
    """0 inside a cell, 1 at its border; `across` cells in a width of 1."""
    u, v = x * across, y * across * 2 / math.sqrt(3)
    row, column = math.floor(v), math.floor(u)
    near = sorted(math.hypot(u - (c + 0.5 * (r % 2)), (v - r) * math.sqrt(3) / 2)
                  for r in (row, row + 1) for c in (column - 1, column, column + 1))
    return 1 - min((near[1] - near[0]) / 0.22, 1)


def studio(d):
    """A floor with a chequer that fades, and a backdrop that it runs up to in a curve."""
    dark, light, plain = (0.27, 0.29, 0.34), (0.74, 0.72, 0.69), (0.50, 0.60, 0.66)

    def fading(y):
        return min(max((-1.2 - (y / 256 * 16 - 8)) / 1.8, 0), 1)

    def chequer(x, y):
        odd = (math.floor(x / 256 * 20) + math.floor(y / 256 * 20)) % 2
        return mixed(light if odd else dark, plain, fading(y))

    def sweep(u, v):
        x, bend = (u - 0.5) * 20, min(max(3 * v - 1, 0), 1)
        c, s = circle(bend / 4)
        y, z = 3 - 3 * c + max(v * 3 - 2, 0) * 5, 10 - 13 * min(3 * v, 1) - 3 * s
        shade = 1 - 0.55 * min(y / 5, 1)
        return {"position": (x, y, z), "normal": (0, c, s), "uv": ((x + 8) / 16, (z + 8) / 16),
                "color": (shade * 0.92, shade * 0.97, shade)}

    picture = d.texture(png(256, 256, chequer), CLAMP)
    polish = d.texture(png(1, 64, lambda x, y: (0, 0.3 + 0.7 * fading(4 * y), 0)), CLAMP)
    ground = d.material("ground", (1, 1, 1), pbr={
        "baseColorTexture": d.textured(picture), "metallicRoughnessTexture": d.textured(polish)})
    d.put(flipped(lattice(2, 36, sweep)), ground)


def pedestals(d, places):
    """Plinths with their words, and a ring on each that a sphere lies in."""
    stone = (0.035, 0.037, 0.042)

    def label(u, v):
        s, c = math.sin((u - 0.5) * 1.9), math.cos((u - 0.5) * 1.9)
        return {"position": (0.503 * s, 0.34 - 0.178 * v, 0.503 * c), "normal": (s, 0, c),
                "uv": (u, v)}

    plate = lattice(16, 1, label)
    body = d.mesh(rounded_cylinder(0.5, 0.5, 0.04), d.material("stone", stone, roughness=0.35))
    ring = d.mesh(torus(0.33, 0.035, 48, 16), d.material("copper", model={
        "model": "conductor", "metal": "Cu", "alpha": 0.2}))
    for word, at in places:
        picture = d.texture(lettering(word, encoded(stone), (0.85, 0.82, 0.75)), CLAMP)
        d.node(mesh=body, at=at)
        d.node(mesh=ring, at=add(at, (0, 0.52, 0)))
        d.put(plate, d.material(word + " label", (1, 1, 1), roughness=0.35,
                                pbr={"baseColorTexture": d.textured(picture)}), at=at)


def beam(d, lamp, aim):
    """A spot with a tube in front of it: a narrow beam of a light whose power tells."""
    back = unit(sub(lamp, aim))
    d.light("spot", (1, 0.93, 0.8), 230, looking(lamp, aim),
            spot={"innerConeAngle": 0.9, "outerConeAngle": 1.0})
    tube = lathe([(0.135, 1.4, 1, 0), (0.135, 0, 1, 0)], 32)
    d.put(tube, d.material("tube", (0, 0, 0)), at=add(lamp, times(back, -1.3)),
          turned=turn(cross((0, 1, 0), back), math.degrees(math.acos(back[1]))))


def demo():
    d = Document("The five materials of an introduction to light side by side: diffuse, glossy, "
                 "mirror, glass, retro-reflective (lit from beside the camera); fog around the "
                 "first, with a beam of light in it; area lights, a spot, textures.")
    studio(d)
    places = [((k - 2) * 1.45, 0, 0.09 * ((k - 2) * 1.45) ** 2) for k in range(5)]
    pedestals(d, zip((name for name, _ in DEMO), places))
    cells = d.texture(png(416, 208, lambda x, y: (1 - 0.6 * honeycomb(x / 416, y / 416),) * 3))
    DEMO[4][1]["reflectanceTexture"] = d.textured(cells)
    for (name, model), at in zip(DEMO, places):
        d.put(SPHERE, d.material(name, model=model), at=add(at, (0, 1.08, 0)), size=0.6)
    fog = d.material("fog", model={"model": "interface"}, medium={
        "scattering": [0.5, 0.51, 0.53], "phase": {"type": "hg", "g": 0.65}})
    d.put(SPHERE, fog, at=add(places[0], (0, 2.3, 0)), size=(0.95, 2.29, 0.95))
    beam(d, (-2.95, 6.0, -1.4), add(places[0], (0, 1.08, 0)))
    d.camera((0, 2.1, 10.5), (0, 0.98, 0), 21, 2)
    d.panel_light((0, 3.0, 11), (0.8, 1, 0), 1.2, 1.2, (14, 13.6, 13))
    d.panel_light((-4.5, 6.5, 5), (0, 0.5, 0), 6, 4, (7, 6, 4.8))
    d.panel_light((7, 3.5, 2), (0, 0.8, 0), 2, 5, (2.6, 3.8, 6.0))
    d.panel_light((0, 8.5, 0), (0, 0, 0), 12, 7, (0.9, 0.96, 1.05))
    return d
