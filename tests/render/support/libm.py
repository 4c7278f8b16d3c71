"""Numbers whose sine or logarithm the C library rounds otherwise on another processor.

glibc picks its functions by what the processor has, and can be told that it has less. Results
differ in the last bit of a double, and in single precision only where the exact value lies next to
the middle between two floats: such numbers are sought here, so that a film that depends on the C
library cannot be equal by luck."""
import json
import os
import subprocess
import sys

import numpy as np

# Names before and since glibc 2.33; what is unknown to it is ignored, as all is by other libraries.
OLDER = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable,"
                           "-FMA4_Usable"}
_CODE = """import json, math, sys
print(json.dumps([getattr(math, sys.argv[1])(x) for x in json.load(sys.stdin)]))"""


def _results(function, numbers, environment):
    done = subprocess.run([sys.executable, "-c", _CODE, function], input=json.dumps(list(numbers)),
                          capture_output=True, text=True, check=True,
                          env=dict(os.environ, **environment))
    return np.array(json.loads(done.stdout))


def _both(function, numbers):
    numbers = [float(n) for n in numbers]
    return _results(function, numbers, {"GLIBC_TUNABLES": ""}), _results(function, numbers, OLDER)


def _middles(low, high, count, seed):
    """Doubles halfway between neighbouring floats."""
    below = np.random.default_rng(seed).uniform(low, high, count).astype(np.float32)
    above = np.nextafter(below, np.float32(np.inf))
    return (below.astype(float) + above.astype(float)) / 2


def _beside(x):
    """x and a few doubles to both sides."""
    return np.concatenate([x + k * np.spacing(x) for k in range(-4, 5)])


def angles(function="cos"):
    """Angles between 0 and pi / 2 whose `function`, sin or cos, differs as a float."""
    inverse = {"sin": np.arcsin, "cos": np.arccos}[function]
    numbers = _beside(inverse(_middles(0.2, 0.95, 10000, 1)))
    one, other = _both(function, numbers)
    return [float(n) for n in numbers[one.astype(np.float32) != other.astype(np.float32)]]


def attenuations():
    """(colour, distance) for which the float -log(colour) / distance differs."""
    colours = np.random.default_rng(2).uniform(0.2, 0.9, 3000).astype(np.float32).astype(float)
    one, other = _both("log", colours)
    found = []
    for k in np.flatnonzero(one != other):
        distances = _beside(-one[k] / _middles(1.0, 3.0, 40, k))
        differ = np.float32(-one[k] / distances) != np.float32(-other[k] / distances)
        found += [(float(colours[k]), float(d)) for d in distances[differ]]
    return found
