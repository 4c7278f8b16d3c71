"""Runs the renderer on a scene and hands back what it wrote."""
import atexit
import json
import os
import shutil
import subprocess
import tempfile

from .images import layer, read_exr

CANDELA = os.path.abspath(os.environ.get("CANDELA", "build/candela"))
FOLDER = tempfile.mkdtemp(prefix="candela-render-test-")
atexit.register(shutil.rmtree, FOLDER, ignore_errors=True)
_count = 0


class Failed(Exception):
    """The renderer ended with another status than 0; `status` and `message` say how."""

    def __init__(self, status, message):
        super().__init__("candela ended with %d: %s" % (status, message.strip()))
        self.status, self.message = status, message


def scratch(suffix):
    """A path in the folder of this test that no other call gets."""
    global _count
    _count += 1
    return os.path.join(FOLDER, "%03d%s" % (_count, suffix))


def run(*arguments, environment=None, timeout=600):
    """`candela ARGUMENT…`; returns standard output and error."""
    process = subprocess.run([CANDELA] + [str(a) for a in arguments], stdin=subprocess.DEVNULL,
                             capture_output=True, text=True, timeout=timeout,
                             env=dict(os.environ, **(environment or {})))
    if process.returncode:
        raise Failed(process.returncode, process.stderr)
    return process.stdout, process.stderr


class Picture:
    """An EXR file and its statistics. rgb and variance (of the mean): height x width x 3."""

    def __init__(self, path, stats, notes=""):
        self.path, self.notes, self.stats = path, notes, stats
        self.channels, self.attributes = read_exr(path)
        self.rgb = layer(self.channels, "", "RGB")
        self.variance = None
        if "variance.R" in self.channels:
            self.variance = layer(self.channels, "variance", "RGB")

    def layer(self, name, letters):
        return layer(self.channels, name, letters)

    @property
    def sha256(self):
        return self.stats["film_sha256"]


def render(scene, size=(32, 32), spp=16, depth=None, seed=None, aov="variance", options=(),
           environment=None):
    """Renders a Scene, or a file by its path, to an EXR with the AOVs named."""
    path = scene if isinstance(scene, str) else scene.write(scratch(".gltf"))
    out, stats = scratch(".exr"), scratch(".json")
    arguments = ["render", path, "-o", out, "--stats", stats, "--size", "%dx%d" % size,
                 "--spp", spp]
    for option, value in (("--max-depth", depth), ("--seed", seed), ("--aov", aov)):
        if value is not None:
            arguments += [option, value]
    _, notes = run(*arguments, *options, environment=environment)
    with open(stats) as file:
        return Picture(out, json.load(file), notes)
