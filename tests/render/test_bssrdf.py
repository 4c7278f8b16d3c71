#!/usr/bin/env python3
"""Subsurface scattering by profiles: white and coloured planes under a white sky, the light around
a small lamp against the integral of the profile and against random walks, bodies against the
integral over their surface, and what files may say that makes no sense."""
import os

import numpy as np

import test_animation as animation
import test_motion as motion
from support.optics import fresnel_dielectric
from support.render import render
from support.scene import Scene
from support.shapes import box, look_at, move, quad, scale, sphere, turn
from support.verdict import check, main, near, within

METHODS = ("diffusion", "dipole")
SOAK = bool(os.environ.get("CDL_SOAK"))


def diffusion(albedo, r):
    """Christensen and Burley 2015, for light that enters diffusely; mean free path 1."""
    s = 1.9 - albedo + 3.5 * (albedo - 0.8) ** 2
    return albedo * s * (np.exp(-s * r) + np.exp(-s * r / 3)) / (8 * np.pi * r)


def dipole(albedo, r, eta=1.0):
    """Jensen et al. 2001, of the reduced albedo that gives this one; mean free path 1."""
    inner = -1.4399 / eta ** 2 + 0.7099 / eta + 0.6681 + 0.0636 * eta
    a = (1 + inner) / (1 - inner)

    def reflectance(alpha):
        root = np.sqrt(3 * (1 - alpha))
        return 0.5 * alpha * (1 + np.exp(-4 / 3 * a * root)) * np.exp(-root)
    low, high = 0.0, 1.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reflectance(middle) < albedo else (low, middle)
    sigma, total = np.sqrt(3 * (1 - low)), 0
    for z in (1, 1 + 4 / 3 * a):
        d = np.sqrt(r * r + z * z)
        total = total + z * (1 + sigma * d) * np.exp(-sigma * d) / d ** 3
    return low / (4 * np.pi) * total


def ground(s, **material):
    s.add(box((-40, -40, -40), (40, 40, 0)), s.material(cdl=dict(material, model="subsurface")))


def test_planes():
    """A plane returns what its coat reflects and `albedo` of the rest, seen from anywhere."""
    colour = np.array((0.2, 0.7, 1))
    for method in METHODS:
        for ior, degrees in ((1, 0), (1.4, 0), (1.4, 60), (1.5, 80)):
            s = Scene()
            ground(s, method=method, albedo=list(colour), ior=ior, alpha=0,
                   radius=[0.02, 0.01, 0.003])
            s.environment(radiance=1)
            angle = np.radians(degrees)
            s.camera(look_at((9 * np.sin(angle), 0, 9 * np.cos(angle)), (0, 0, 0)),
                     half_height=0.01)
            picture = render(s, (32, 32), 256, 8)
            pixels = picture.rgb.reshape(-1, 3)
            coat = fresnel_dielectric(np.cos(angle), ior) if ior > 1 else 0
            within("%s, index %g at %d degrees" % (method, ior, degrees), pixels.mean(0),
                   coat + (1 - coat) * colour, pixels.std(0) / 32, 0.01)


def lamp_rings(material, degrees, edges, spp, depth=2, seed=1):
    """The radiance in rings about a small lamp that lies on the ground, with standard errors."""
    s = Scene()
    ground(s, **material)
    s.add(quad((0, 0, 1e-4), (0, 0.5, 0), (0.5, 0, 0)), s.emitter(1))
    mu, extent = np.cos(np.radians(degrees)), edges[-1]
    height = 120
    width = max(int(height * mu), 1)
    s.camera(look_at((9 * np.sin(np.radians(degrees)), 0, 9 * mu), (0, 0, 0)), half_height=extent,
             aspect=width / height)
    picture = render(s, (width, height), spp, depth, seed).rgb
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * extent * width / height / mu
    y = ((np.arange(height) + 0.5) / height * 2 - 1) * extent
    r = np.hypot(x[None], y[:, None])
    rings = [picture[(r >= a) & (r < b)] for a, b in zip(edges, edges[1:])]
    return (np.array([p.mean(0) for p in rings]),
            np.array([p.std(0) / np.sqrt(len(p)) for p in rings]))


def integral_rings(profile, albedos, edges):
    """The same for a profile: it times the lamp's radiance over the lamp's square."""
    side = (np.arange(24) + 0.5) / 24 - 0.5
    u, v = (g.ravel() for g in np.meshgrid(side, side))
    rows = []
    for a, b in zip(edges, edges[1:]):
        r = np.sqrt(a * a + (b * b - a * a) * (np.arange(40) + 0.5) / 40)  # alike by area
        turns = 2 * np.pi * (np.arange(40) + 0.5) / 40 * 0.25
        x, y = (r[:, None] * f(turns)[None] for f in (np.cos, np.sin))
        d = np.hypot(x[..., None] - u, y[..., None] - v)
        rows.append([profile(albedo, d).mean() for albedo in albedos])  # of an area of 1
    return np.array(rows)


def test_lamps():
    """Light that enters under a lamp leaves around it as the profile says."""
    albedos, edges = (0.3, 0.6, 0.9), (0.8, 1.2, 1.8, 2.6, 3.6)
    for method, profile in (("diffusion", diffusion), ("dipole", dipole)):
        got, error = lamp_rings(dict(method=method, albedo=list(albedos), radius=1, ior=1, alpha=0),
                                0, edges, 1024)
        want = integral_rings(profile, albedos, edges)
        for k in range(len(want)):
            for c in range(3):
                within("%s of albedo %g from %g to %g" % (method, albedos[c], *edges[k:k + 2]),
                       got[k, c], want[k, c], error[k, c], 0.06, sigmas=4)


def test_walks():
    """Diffusion's profile was fitted to random walks, and is compared with ours: the light that
    leaves within a ring's edges, and each ring by itself, where the fit is up to 5 % off."""
    albedos, edges = (0.2, 0.5, 0.8), (0.8, 1.2, 1.8, 2.6, 3.6)
    want = integral_rings(diffusion, albedos, edges)
    walked, error = lamp_rings(
        dict(method="random_walk", albedo=list(albedos), radius=1, ior=1, alpha=0), 0, edges,
        2048 if SOAK else 256, 3)
    area = np.pi * np.diff(np.square(edges))[:, None]
    encircled = np.cumsum((want - walked) * area, 0) / albedos  # of all that leaves
    for c in range(3):
        ratio, noise = (want / walked)[:, c], (error / walked)[:, c]
        detail = "profile over walk %s, noise %s; encircled light %s" % (
            np.round(ratio, 3), np.round(noise, 3), np.round(encircled[:, c], 4))
        if os.environ.get("CDL_TEST_VERBOSE"):
            print("albedo %g: %s" % (albedos[c], detail))
        check("albedo %g: encircled light" % albedos[c], np.abs(encircled[:, c]).max() < 0.03,
              detail)
        check("albedo %g: rings" % albedos[c], np.all(np.abs(ratio - 1) < 0.05 + 3 * noise), detail)


def test_bodies():
    """Seen from anywhere, a ball in a white sky returns the integral of the profile over itself:
    2 pi d of area per chord d, as on a plane. Non-uniform scales and instances do not matter."""
    albedo, radius = 0.8, 0.15
    d = (np.arange(200000) + 0.5) * 1e-5
    for method, profile in (("diffusion", diffusion), ("dipole", dipole)):
        want = (2 * np.pi * d * profile(albedo, d / radius)).sum() * 1e-5 / radius ** 2
        for name, place in (("ball", [move(0, 0, 0)]),
                            ("instances", [move(0, 0, 0) @ scale(1, 0.5, 2), move(9, 0, 0)])):
            s = Scene()
            ball = sphere(1, (0, 0, 0), 256, 128, smooth=True)
            if name == "instances":
                ball["positions"] = ball["positions"] * np.array((1, 2, 0.5), np.float32)
                del ball["normals"]
            mesh = s.mesh(ball, s.material(cdl=dict(
                model="subsurface", method=method, albedo=albedo, radius=radius, ior=1, alpha=0)))
            for matrix in place:
                s.node(matrix, mesh=mesh)
            s.environment(radiance=1)
            s.camera(look_at((1, 2, 3), (0, 0, 0)), half_height=0.5)
            pixels = render(s, (48, 48), 128, 3).rgb.reshape(-1, 3)
            within("%s by %s" % (name, method), pixels.mean(0)[0], want,
                   pixels.std(0)[0] / np.sqrt(len(pixels)), 0.01)


def test_events():
    """Entering and leaving are one event; what the coat reflects onto the body is another."""
    for method in METHODS:
        means = []
        for depth in (1, 2, 6):
            s = Scene()
            ground(s, method=method, albedo=0.7, radius=0.01, ior=1.4, alpha=0.2)
            s.environment(radiance=1)
            s.camera(look_at((0, 0, 9), (0, 0, 0)), half_height=0.01)
            means.append(render(s, (16, 16), 256, depth).rgb.mean())
        near("%s: one event is all" % method, means[0], means[2], 0.01)
        near("%s: two as well" % method, means[1], means[2], 0.01)


def test_two_bodies():
    """Light does not go from one body to another of the same material, however near."""
    for method in METHODS:
        levels = []
        for gap in (0, 0.01):
            s = Scene()
            body = s.material(cdl=dict(model="subsurface", method=method, albedo=0.9, radius=0.2,
                                       ior=1, alpha=0))
            if gap:
                s.add(box((-1, -1, -1), (-gap, 1, 0)), body)
                s.add(box((gap, -1, -1), (1, 1, 0)), body)
            else:
                s.add(box((-1, -1, -1), (1, 1, 0)), body)
            s.add(quad((0.3, 0, 1e-4), (0, 0.2, 0), (0.2, 0, 0)), s.emitter(1))
            s.camera(look_at((-0.2, 0, 9), (-0.2, 0, 0)), half_height=0.1)
            levels.append(render(s, (24, 24), 64, 1).rgb.mean())
        check("%s: within one body light spreads" % method, levels[0] > 0.01, "%g" % levels[0])
        check("%s: and stays there" % method, levels[1] < 1e-6, "%g" % levels[1])


def test_moving():
    """Bodies that turn while the shutter is open look like the mean of what stands still."""
    def make(method):
        def moving(shutter):
            s = motion.film(shutter)
            mesh = s.mesh(box((-0.4, -0.2, -0.3), (0.4, 0.2, 0.3)), s.material(cdl=dict(
                model="subsurface", method=method, albedo=[0.8, 0.5, 0.3], radius=0.05)))
            arm = s.node(children=[s.node(move(x, 0, 0), root=False, mesh=mesh) for x in (-1, 1)],
                         scale=[1.0, 1.5, 0.7])
            s.channel((arm, "rotation"), [0, 1], s.values(
                [animation.turned(0), animation.turned(120, (0.2, 0.3, 1))], "VEC4"))
            motion.lit(s)
            return s
        return moving
    for method in METHODS if SOAK else METHODS[:1]:
        motion.compare("%s: turning" % method, make(method), relative=0.03)


def test_hostile():
    """Nothing that a file may say gives a sample that is no number, or light from nowhere."""
    for method in METHODS:
        for more in (dict(radius=0), dict(radius=1e30),
                     dict(radius=[0, 1e-20, 1e9], albedo=[0, 1, 1]),
                     dict(albedo=0), dict(albedo=1, ior=3, alpha=1), dict(ior=0.01), dict(g=1),
                     dict(g=-1, radius=[1e-12, 1, 1e12]), dict(alpha=[0.001, 1], ior=1)):
            s = Scene()
            material = s.material(cdl=dict(dict(albedo=0.8, radius=0.1), method=method,
                                           model="subsurface") | more)
            s.add(sphere(0.5, (0, 0, 0), 24, 12, smooth=True), material, turn((1, 2, 3), 30))
            s.add(sphere(1e-4, (0.7, 0, 0), 24, 12), material)
            s.add(quad((0, 0, -1), (2, 0, 0), (0, 2, 0)), material)
            s.environment(radiance=1)
            s.camera(look_at((0, 0.4, 3), (0, 0, 0)), yfov=40)
            picture = render(s, (24, 24), 16, 12)
            worst = picture.rgb.reshape(-1, 3).mean(0).max()
            check("%s, %s: finite" % (method, more),
                  picture.stats["bad_samples"] == 0 and np.isfinite(picture.rgb).all())
            check("%s, %s: no more than arrives" % (method, more), worst < 1.02, "%g" % worst)


if __name__ == "__main__":
    main(test_planes, test_lamps, test_walks, test_bodies, test_events, test_two_bodies,
         test_moving, test_hostile)
