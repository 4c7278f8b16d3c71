"""Scenes of grids and of bodies that light goes into; scene_fire needs numpy."""
import math

from scene_kit import Document, box, circle, quad, rounded_cylinder, sphere, torus

GROUND = {"model": "diffuse", "reflectance": [0.22, 0.19, 0.16]}


def noise(numpy, points, octaves=4):
    """Smooth noise of about [-1, 1] at points [..., 3], halved in size from octave to octave."""
    random, total = numpy.random.default_rng(7), 0
    table = random.uniform(-1, 1, (32, 32, 32))
    for octave in range(octaves):
        scaled = points * 2 ** octave + 5.2 * octave
        cell = numpy.floor(scaled).astype(int)
        part = scaled - cell
        part = part * part * (3 - 2 * part)
        value = 0
        for corner in range(8):
            bits = numpy.array([corner & 1, corner >> 1 & 1, corner >> 2])
            at = (cell + bits) % 32
            weight = numpy.where(bits, part, 1 - part).prod(-1)
            value = value + weight * table[at[..., 0], at[..., 1], at[..., 2]]
        total = total + value / 2 ** octave
    return total


def flames():
    """Density of smoke, and temperature in kelvin, [x, y, z] over a box of 2 x 4 x 2 m."""
    import numpy
    size = (30, 60, 30)
    grid = numpy.stack(numpy.meshgrid(*[(numpy.arange(n) + 0.5) / n for n in size], indexing="ij"),
                       -1)
    x, y, z = 2 * grid[..., 0] - 1, grid[..., 1], 2 * grid[..., 2] - 1
    swirl = noise(numpy, numpy.stack([x * 1.3, 4 * y - 3, z * 1.3], -1), 3)
    sway = 0.16 * numpy.sin(7 * y + 2 * swirl) * y
    radius = numpy.hypot(x - sway + 0.1 * swirl * y, z + 0.5 * sway)
    width = 0.22 + 0.42 * y
    plume = numpy.clip(1.1 - radius / width + 0.55 * swirl * (0.3 + y), 0, 1)
    smoke = plume * numpy.clip((y - 0.22) / 0.25, 0, 1) * numpy.clip((1 - y) / 0.15, 0, 1)
    core = numpy.clip(1.15 - radius / (0.30 * (1 - y / 0.62).clip(0.02)) + 0.75 * swirl, 0, 1)
    fire = core * (y < 0.6) * numpy.clip(y / 0.03, 0, 1)
    heat = numpy.where(fire > 0.05, 900 + 1050 * fire * (1 - 0.45 * y), 0)
    return {"density": smoke.astype("f4"), "heat": heat.astype("f4")}


def fire():
    from vdb_file import vdb_uri
    d = Document("A fire in the open: smoke and heat on grids of one file, black bodies by "
                 "temperature, lit by nothing but themselves and the evening sky; logs around it.")
    d.put(quad((-30, 0, 30), (60, 0, 0), (0, 0, -60)), d.material("ground", model=GROUND))
    wood = d.material("wood", model={"model": "oren_nayar", "reflectance": [0.10, 0.06, 0.04],
                                     "roughness": 0.9})
    log = rounded_cylinder(0.13, 1.5, 0.03)
    for k in range(5):
        c, s = circle(k / 5 + 0.04)
        d.put(log, wood, at=(0.72 * c, 0.05, 0.72 * s), turned=(
            math.sin(math.pi / 3.1) * s * -1, 0, math.sin(math.pi / 3.1) * c,
            math.cos(math.pi / 3.1)))
    plume = {"scattering": [5, 5, 5], "absorption": [3.5, 3.7, 4.0], "emission": [16, 16, 16],
             "phase": {"type": "hg", "g": 0.4},
             "grid": {"uri": vdb_uri(flames()), "density": "density", "temperature": "heat",
                      "bounds": [[-1, 0, -1], [1, 4, 1]]}}
    shell = d.material("fire", model={"model": "interface"}, medium=plume)
    d.put(box((-1.001, -0.001, -1.001), (1.001, 4.001, 1.001)), shell, at=(0, 0.05, 0))
    d.camera((0.6, 1.3, 8.2), (0, 1.75, 0), 31, aspect=1)
    d.scene("CDL_environment", {"radiance": [0.02, 0.035, 0.07]})
    return d


def bodies():
    d = Document("Bodies that light goes into: milk, wax, marble and skin by random walks, jade by "
                 "Christensen and Burley's profile, cream by the dipole's; lit from behind.")
    d.put(quad((-20, 0, 20), (40, 0, 0), (0, 0, -40)),
          d.material("table", model={"model": "diffuse", "reflectance": [0.16, 0.15, 0.15]}))

    def body(name, albedo, radius, **more):
        return d.material(name, model={"model": "subsurface", "albedo": albedo, "radius": radius,
                                       **more})
    ball, ring = sphere(64, 32), torus(0.42, 0.16)
    block = rounded_cylinder(0.42, 0.9, 0.06)
    milk = body("milk", [0.93, 0.91, 0.85], [0.06, 0.05, 0.035], ior=1.33, alpha=0.05)
    wax = body("wax", [0.92, 0.72, 0.42], [0.22, 0.12, 0.05], ior=1.45, alpha=0.25)
    marble = body("marble", [0.88, 0.87, 0.84], [0.05, 0.05, 0.045], ior=1.5, alpha=0.12)
    skin = body("skin", [0.80, 0.58, 0.48], [0.09, 0.035, 0.02], ior=1.4, alpha=0.3)
    jade = body("jade", [0.30, 0.66, 0.38], [0.05, 0.09, 0.05], ior=1.6, alpha=0.15,
                method="diffusion")
    cream = body("cream", [0.94, 0.86, 0.70], [0.06, 0.05, 0.03], ior=1.35, alpha=0.3,
                 method="dipole")
    for x, material in ((-1.95, milk), (-0.65, wax), (0.65, marble), (1.95, skin)):
        d.put(ball, material, at=(x, 0.55, 0), size=0.55)
    d.put(ring, jade, at=(-1.3, 0.17, 1.15))
    d.put(block, cream, at=(1.25, 0.0, 1.25), size=0.5)
    d.panel_light((1.5, 3.2, -4), (0, 0.5, 0), 2.4, 1.6, (26, 25, 23))
    d.panel_light((-4, 3, 3), (0, 0.5, 0), 2, 2, (3.2, 3.6, 4.2))
    d.camera((0, 2.0, 7.2), (0, 0.42, 0.3), 27)
    d.scene("CDL_environment", {"radiance": [0.03, 0.035, 0.042]})
    return d
