#!/usr/bin/env python3
"""Every kind of light over a plane, against closed forms: Lambert's formula for polygons,
inverse squares, the formulas of KHR_lights_punctual.

A camera without perspective looks straight down from below the lights, so each pixel shows one
known square of the plane. Power: three standard errors of a picture's mean are below 0.3 %
(agrees() asks for it), and blocks of 8 x 8 pixels show where an error that cancels in the mean
would be."""
import numpy as np

from support.optics import polygon_irradiance
from support.render import render
from support.scene import Scene
from support.shapes import joined, look_at, move, quad, scale, sphere, turn
from support.verdict import agrees, blocks_agree, check, main, near

PIXELS, HALF, ALBEDO = 32, 1.0, 0.8
DOWN = look_at((0, 0.5, 0), (0, 0, 0), up=(0, 0, -1))  # right is +X, up in the picture is -Z


def plane_points(across=3):
    """Points of the plane, `across` x `across` in each pixel: (pixels, pixels, points, 3)."""
    at = (2 * (np.arange(PIXELS * across) + 0.5) / (PIXELS * across) - 1) * HALF
    x, z = np.meshgrid(at, at)
    points = np.stack([x, 0 * x, z], -1).reshape(PIXELS, across, PIXELS, across, 3)
    return points.swapaxes(1, 2).reshape(PIXELS, PIXELS, across * across, 3)


def expected(irradiance):
    """Radiance of the plane as a picture; irradiance: a function of N x 3 points, N or N x 3."""
    points = plane_points()
    values = np.asarray(irradiance(points.reshape(-1, 3)), float)
    values = values.reshape(points.shape[:3] + (-1,)).mean(2)
    return np.broadcast_to(values * ALBEDO / np.pi, (PIXELS, PIXELS, 3))


def plane():
    s = Scene()
    s.use_every_feature()
    s.add(quad((0, 0, 0), (0, 0, 5), (5, 0, 0)), s.diffuse(ALBEDO))
    s.camera(DOWN, half_height=HALF)
    s.environment(radiance=0)
    return s


def compare(what, scene, irradiance, spp, relative=0.003):
    picture = render(scene, (PIXELS, PIXELS), spp, 1)
    want = expected(irradiance)
    agrees(what, picture, want, relative)
    blocks_agree(what + ", by blocks", picture, want)


def up(points):
    return np.broadcast_to((0.0, 1.0, 0.0), points.shape)


def polygons(shape):
    return shape["positions"][shape["indices"]]


def corner_cut(lamp):
    """A lamp of a quad's corners rather than of its triangles: the formula takes any polygon."""
    p = lamp["positions"]
    return np.array([[p[0], p[2], p[3], p[1]]])


def test_quad_light():
    s, lamp = plane(), quad((0.3, 1.5, -0.2), (0.5, 0, 0), (0, 0.1, 0.4))
    s.add(lamp, s.emitter((7, 3, 0.5)))
    compare("a quad light", s, lambda p: np.outer(
        polygon_irradiance(p, up(p), corner_cut(lamp)), (7, 3, 0.5)), 64)


def test_sphere_light():
    s, radius, center = plane(), 0.4, np.array((-0.2, 1.5, 0.1))
    ball = sphere(radius, center, 24, 12)
    s.add(ball, s.emitter(10))
    compare("a sphere light", s, lambda p: 10 * polygon_irradiance(p, up(p), polygons(ball)), 2560)
    # The formula itself against the sphere's: pi L (R / d)^2 cos; the mesh is 1.7 % smaller.
    points = plane_points(1).reshape(-1, 3)
    to = center - points
    distance = np.linalg.norm(to, axis=1)
    smooth = np.pi * (radius / distance) ** 2 * to[:, 1] / distance
    meshed = polygon_irradiance(points, up(points), polygons(ball))
    near("the mesh as a sphere", meshed / smooth, 1, 0.03)


def point_irradiance(p, position, intensity):
    to = np.array(position) - p
    d2 = np.sum(to * to, 1)
    return intensity * to[:, 1] / d2 ** 1.5, np.sqrt(d2), to / np.sqrt(d2)[:, None]


def test_point_light():
    s = plane()
    s.light("point", 4, move(0.2, 0.9, -0.4) @ turn((1, 2, 3), 50) @ scale(3))
    compare("a point light", s, lambda p: point_irradiance(p, (0.2, 0.9, -0.4), 4)[0], 32)
    s = plane()
    s.light("point", 4, move(0.2, 0.9, -0.4), range=1.3)

    def ranged(p):
        irradiance, distance, _ = point_irradiance(p, (0.2, 0.9, -0.4), 4)
        return irradiance * np.clip(1 - (distance / 1.3) ** 4, 0, 1)
    compare("a point light of range 1.3", s, ranged, 32)


def test_spot_light():
    s, position, target = plane(), (0.3, 1.2, 0.3), (-0.1, 0, -0.2)
    s.light("spot", (5, 1, 2), look_at(position, target),
            spot={"innerConeAngle": 0.25, "outerConeAngle": 0.6})
    axis = np.array(target) - np.array(position)
    axis /= np.linalg.norm(axis)

    def irradiance(p):
        full, _, to = point_irradiance(p, position, 1)
        angle = 1 / max(0.001, np.cos(0.25) - np.cos(0.6))
        cone = np.clip(-(to @ axis) * angle - np.cos(0.6) * angle, 0, 1) ** 2
        return np.outer(full * cone, (5, 1, 2))
    compare("a spot light", s, irradiance, 64)


def test_directional_light():
    s, towards = plane(), np.array((0.5, -1.0, 0.3))
    s.light("directional", (2, 3, 4), look_at(-towards, (0, 0, 0)))
    cosine = 1 / np.linalg.norm(towards)
    compare("a directional light", s, lambda p: np.outer(0 * p[:, 0] + cosine, (2, 3, 4)), 32)


def test_constant_sky():
    s = plane()
    s.environment(radiance=(0.2, 1, 3))
    compare("a constant sky", s, lambda p: np.outer(0 * p[:, 0] + np.pi, (0.2, 1, 3)), 64)


def test_all_lights():
    """Together they are the sum, whichever is chosen how often."""
    s, lamp = plane(), quad((0.3, 1.5, -0.2), (0.5, 0, 0), (0, 0, 0.4))
    s.add(lamp, s.emitter(2))
    ball = sphere(0.2, (-0.6, 1.2, 0.5), 16, 8)
    s.add(ball, s.emitter(9))
    s.light("point", 1, move(0.5, 0.9, 0.5))
    s.light("directional", 0.5, look_at((0, 0, 0), (2.6, -1.5, 0)))  # no shadow falls into view
    s.environment(radiance=0.1)
    lamps = polygons(joined(lamp, ball))

    def irradiance(p):
        radiance = np.repeat((2.0, 9.0), (2, len(lamps) - 2))
        # Each lamp hides the sky that it covers.
        polygon = sum((r - 0.1) * polygon_irradiance(p, up(p), lamps[radiance == r])
                      for r in (2, 9))
        sun = 0.5 * 1.5 / np.hypot(2.6, 1.5)
        return polygon + point_irradiance(p, (0.5, 0.9, 0.5), 1)[0] + sun + 0.1 * np.pi
    compare("all lights together", s, irradiance, 1024, 0.006)


def test_textured_emission():
    """A lamp whose left half is red and whose right half is blue, by its emissive texture."""
    s = plane()
    halves = np.array([[[255, 0, 0], [0, 0, 255]]], np.uint8)
    lamp = quad((0, 1.2, 0), (0.5, 0, 0), (0, 0, 0.5))
    info = s.texture(halves, nearest=True)
    s.add(lamp, s.material(base=0, metallic=0, roughness=1, emission=8, emissiveTexture=info))
    left = quad((-0.25, 1.2, 0), (0.25, 0, 0), (0, 0, 0.5))
    right = quad((0.25, 1.2, 0), (0.25, 0, 0), (0, 0, 0.5))

    def irradiance(p):
        red, blue = (8 * polygon_irradiance(p, up(p), polygons(half)) for half in (left, right))
        return np.stack([red, 0 * red, blue], 1)
    compare("a textured lamp", s, irradiance, 1024)


def test_mirrored_and_instanced_lamps():
    """A lamp placed twice, once mirrored and sheared by its parent's scale: its front stays its
    front."""
    s = plane()
    lamp = quad((0, 0, 0), (0.3, 0, 0), (0, 0, 0.2))
    lamp["positions"][0, 0] -= 0.2  # without symmetry
    mesh = s.mesh(lamp, s.emitter(6))
    first = move(-0.4, 1.3, 0.2) @ turn((0, 1, 0), 30)
    outer, inner = move(0.4, 1.1, -0.3) @ scale(-1.2, 1, 0.7), turn((0, 1, 0), 20)
    s.node(first, mesh=mesh)
    s.node(outer, children=[s.node(inner, root=False, mesh=mesh)])

    def irradiance(p):
        total = 0
        for place in (first, outer @ inner):
            moved = lamp["positions"] @ place[:3, :3].T + place[:3, 3]
            corners = moved[lamp["indices"]]
            total = total + polygon_irradiance(
                p, up(p), corners if np.linalg.det(place) > 0 else corners[:, ::-1])
        return 6 * total
    compare("two places of a lamp, one mirrored", s, irradiance, 128)


def test_sides_of_emission():
    """A triangle emits from its front, a double-sided material from both sides, directly and as
    a light."""
    for name, double, turned, shines in (("front", False, False, 1), ("back", False, True, 0),
                                         ("back, double-sided", True, True, 1)):
        s = plane()
        lamp = quad((0, 1.5, 0), (0.5, 0, 0), (0, 0, 0.5))
        if turned:
            lamp["indices"] = lamp["indices"][:, ::-1]
        s.add(lamp, s.emitter(5, doubleSided=double))
        compare("light from the %s of a lamp" % name, s, lambda p: 5 * shines * polygon_irradiance(
            p, up(p), corner_cut(quad((0, 1.5, 0), (0.5, 0, 0), (0, 0, 0.5)))), 64)
        s.camera(look_at((0, 1, 0), (0, 2, 0), up=(0, 0, 1)), half_height=0.4, name="upwards")
        seen = render(s, (8, 8), 4, 0, options=("--camera", "upwards"))
        near("the %s of a lamp" % name, seen.rgb, 5 * shines, 1e-5)


def test_zero_light():
    """A plane that nothing lights is black, and no sample is bad."""
    s = plane()
    s.light("point", 0, move(0, 1, 0))
    picture = render(s, (8, 8), 16, 3)
    near("a plane without light", picture.rgb, 0, 0)
    check("no bad samples", picture.stats["bad_samples"] == 0)


def test_coated_emitter():
    """A clear coat keeps what it reflects of the light from below (KHR_materials_clearcoat), seen
    directly and by what it lights."""
    for cosine in (1.0, 0.5, 0.2):
        s = Scene()
        s.add(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)),
              s.material(base=(0, 0, 0, 1), metallic=0, roughness=1, emission=(0.5, 0.5, 0.5),
                         extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 0.8}}))
        s.environment(radiance=0)
        s.camera(look_at((3 * np.sqrt(1 - cosine ** 2), 0, 3 * cosine), (0, 0, 0)),
                 half_height=0.1)
        fresnel = 0.04 + 0.96 * (1 - cosine) ** 5
        near("an emitter under a coat at cosine %g" % cosine, render(s, (8, 8), 16, 0).rgb.mean(),
             0.5 * (1 - 0.8 * fresnel), 1e-4)


if __name__ == "__main__":
    main(test_quad_light, test_sphere_light, test_point_light, test_spot_light,
         test_directional_light, test_constant_sky, test_all_lights, test_textured_emission,
         test_mirrored_and_instanced_lamps, test_sides_of_emission, test_zero_light,
         test_coated_emitter)
