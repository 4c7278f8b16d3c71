"""Many small scenes in one picture, so that many materials share one render and its kernels.

Cells lie side by side in the picture of an orthographic camera that looks along -Z. Behind each
other they are DEPTH apart, so that no cell sees more of another than (1 / DEPTH)^2 / 4 of its sky.
In its own coordinates a cell reaches from -1 to 1 across and upwards, and +Z is the camera.

    c = Cells(6, 3)
    c.add(quad(…), c.material(…), tilted(30))
    picture = c.render(spp=64)
    picture.rgb[c.region(0)]
"""
import numpy as np

from .render import render
from .scene import Scene
from .shapes import look_at, move, quad, turn

DEPTH = 60.0


def tilted(degrees):
    """Turns the normal from the camera to the right."""
    return turn((0, 1, 0), degrees)


def direction(degrees):
    """From a cell, in its horizontal plane: 0 is the camera, 90 the right."""
    return np.array([np.sin(np.radians(degrees)), 0, np.cos(np.radians(degrees))])


# Each layer that glTF's material may have, and each model but glTF's own.
LAYERS = {"clearcoat": {"clearcoatFactor": 1}, "sheen": {"sheenColorFactor": [1, 1, 1]},
          "iridescence": {"iridescenceFactor": 1}, "anisotropy": {"anisotropyStrength": 0.5},
          "transmission": {"transmissionFactor": 0.5}, "volume": {"thicknessFactor": 1},
          "diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
          "retroreflection": {"retroreflectionFactor": 0.5}, "dispersion": {"dispersion": 1}}
MODELS = [{"model": name} for name in ("diffuse", "oren_nayar", "mirror", "retroreflector",
                                       "conductor", "dielectric", "plastic", "disney")]


def layers(**values):
    """The member `extensions` of a glTF material; each argument is a layer's own members."""
    return {"extensions": {"KHR_materials_" + name: value for name, value in values.items()}}


class Cells(Scene):
    def __init__(self, columns, rows, pixels=8, depth=DEPTH):
        """`depth` is to be greater where light goes almost straight through."""
        super().__init__()
        self.columns, self.rows, self.pixels, self.cell = columns, rows, pixels, -1
        self.depth, self.height = depth, depth * columns * rows
        self.use_every_feature((0, -rows - 3, 0))
        self.use_every_material((0, -rows - 3, 0))

    def use_every_material(self, at):
        """Has one set of kernels compiled for all of these tests: see use_every_feature."""
        tiny = quad((0, 0, 0), (1e-3, 0, 0), (0, 0, 1e-3))
        every = [dict(cdl=m) for m in MODELS] + [{}, layers(**LAYERS)]
        every.append(dict(cdl={"model": "dielectric", "alpha": 0.1, "energyCompensation": True}))
        every.append(dict(cdl={"model": "conductor", "alpha": [0.1, 0.2]}))
        for i, material in enumerate(every):
            super().add(tiny, self.material(**material), move(*at) @ move(0.1 + 0.01 * i, 0, 0))

    def place(self, cell=None):
        cell = self.cell if cell is None else cell
        column, row = cell % self.columns, cell // self.columns
        return move(2 * column + 1 - self.columns, self.rows - 1 - 2 * row,
                    self.depth * cell - self.height / 2)

    def next(self):
        self.cell += 1
        assert self.cell < self.columns * self.rows, "more cells than the picture has"
        return self.cell

    def put(self, shape, material, matrix=np.eye(4)):
        """Into the cell begun last."""
        return super().add(shape, material, self.place() @ matrix)

    def show(self, shape, material, matrix=np.eye(4)):
        """In a cell of its own, whose number is returned."""
        cell = self.next()
        self.put(shape, material, matrix)
        return cell

    def sun(self, degrees, irradiance=1.0, up=0.0):
        """A directional light from direction(degrees), raised by `up`."""
        self.light("directional", irradiance,
                   look_at(direction(degrees) + (0, up, 0), (0, 0, 0), up=(0, 1, 1e-3)))

    def region(self, cell, left=0.0, right=1.0, bottom=0.0, top=1.0):
        """A mask of the part of the picture that shows a cell, or a part of it."""
        p, (row, column) = self.pixels, divmod(cell, self.columns)
        y, x = np.mgrid[:self.rows * p, :self.columns * p] + 0.5
        x, y = x / p - column, row + 1 - y / p
        return (x > left) & (x < right) & (y > bottom) & (y < top)

    def render(self, spp=16, depth=1, **options):
        self.camera(look_at((0, 0, self.height), (0, 0, 0)), half_height=self.rows,
                    aspect=self.columns / self.rows)
        size = (self.columns * self.pixels, self.rows * self.pixels)
        return render(self, size, spp, depth, options=("--camera", len(self.json["cameras"]) - 1),
                      **options)


def front_and_back(front, back, columns=64):
    """A sky that has one radiance where the camera is (+Z) and another beyond the cells."""
    image = np.empty((4, columns, 3))
    image[:, :columns // 2], image[:, columns // 2:] = back, front
    return image
