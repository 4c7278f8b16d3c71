"""Counting what holds and what does not, and comparing pictures with what they should be."""
import math
import os
import sys
import traceback

import numpy as np

passed = failed = skipped = 0


def check(what, holds, detail=""):
    global passed, failed
    if holds:
        passed += 1
    else:
        failed += 1
        print("FAILED: %s%s" % (what, ": " + detail if detail else ""), flush=True)
    return bool(holds)


def skip(what, why):
    global skipped
    skipped += 1
    print("SKIPPED: %s: %s" % (what, why), flush=True)


def near(what, got, want, tolerance):
    """Every value within `tolerance`, absolute; NaN fails."""
    got, want = np.asarray(got, float), np.asarray(want, float)
    worst = float(np.max(np.abs(got - want))) if np.isfinite(got).all() else math.inf
    return check(what, worst <= tolerance, "%s instead of %s: off by %.3g, not %.3g" %
                 (_short(got), _short(want), worst, tolerance))


def _short(values):
    values = np.asarray(values, float)
    if values.size <= 6:
        return np.array2string(values, precision=6)
    return "mean %s" % np.array2string(values.reshape(-1, values.shape[-1]).mean(0), precision=6)


def agrees(what, picture, want, relative=0.003, sigmas=3.0, region=None, power=True):
    """The mean of a picture (of a `region`: a mask) in every channel against a closed form, a
    number or an image: within `relative` of it and within `sigmas` standard errors of the
    picture's own noise. With `power`, three standard errors must be smaller than `relative` as
    well, or the test could not see what it is for."""
    want = np.broadcast_to(np.asarray(want, float), picture.rgb.shape)
    mask = np.ones(picture.rgb.shape[:2], bool) if region is None else region
    count = int(mask.sum())
    got, want = picture.rgb[mask].mean(0), want[mask].mean(0)
    error = np.sqrt(picture.variance[mask].sum(0)) / count
    return within(what, got, want, error, relative, sigmas, power)


def within(what, got, want, error, relative=0.003, sigmas=3.0, power=True):
    """The same for values with a standard error of their own, by channel."""
    got, want, error = (np.asarray(v, float) for v in (got, want, error))
    off = np.abs(got - want)
    # Single precision leaves a little even where there is no noise at all.
    allowed = np.minimum(sigmas * error + 2e-5 * np.abs(want), relative * np.abs(want)) + 1e-7
    strong = not power or np.all(sigmas * error <= relative * np.abs(want) + 1e-7)
    detail = "%s instead of %s, off by %s %%, three standard errors are %s %%" % (
        _short(got), _short(want), _percent(off, want), _percent(3 * error, want))
    if os.environ.get("CDL_TEST_VERBOSE"):
        print("%s: %s" % (what, detail))
    if np.isfinite(got).all() and not strong:
        return check(what, False, "too noisy to tell: " + detail)
    return check(what, np.isfinite(got).all() and np.all(off <= allowed), detail)


def _percent(value, of):
    return np.array2string(100 * value / np.maximum(np.abs(of), 1e-30), precision=3)


def blocks_agree(what, picture, want, relative=0.01, side=8):
    """A picture against an image, by blocks of side x side pixels: every block within `relative`
    of it (or of a tenth of the picture's mean) or within the noise, at 1 % over all blocks and
    channels (Sidak)."""
    height, width = (n // side * side for n in picture.rgb.shape[:2])
    want = np.broadcast_to(np.asarray(want, float), picture.rgb.shape)

    def blocks(image):
        cut = image[:height, :width].reshape(height // side, side, width // side, side, -1)
        return cut.mean((1, 3))

    got, want = blocks(picture.rgb), blocks(want)
    error = np.sqrt(blocks(picture.variance)) / side
    limit = z_limit(0.01, got.size)
    size = np.maximum(np.abs(want), 0.1 * np.abs(want).mean())
    excess = np.abs(got - want) / (np.maximum(limit * error, relative * size) + 1e-7)
    excess = np.where(np.isfinite(excess), excess, np.inf)
    bad, worst = excess > 1, np.unravel_index(np.argmax(excess), excess.shape)
    return check(what, not bad.any(), "%d of %d blocks are off, worst %s: %g, not %g +- %g" %
                 (bad.sum(), bad.size, worst, got[worst], want[worst], error[worst]))


def z_limit(alpha, tests):
    """|z| that `tests` normal variables together pass with probability alpha (two-sided, Sidak)."""
    each = 1 - (1 - alpha) ** (1 / tests)
    low, high = 0.0, 40.0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if math.erfc(middle / math.sqrt(2)) > each else (low, middle)
    return low


def main(*tests):
    """Runs test functions one after the other, whatever happens in them, and prints the counts."""
    only = sys.argv[1:]
    for test in tests:
        if only and not any(name in test.__name__ for name in only):
            continue
        try:
            test()
        except Exception:
            check(test.__name__, False, traceback.format_exc())
    print("%d passed, %d failed%s" % (passed, failed, ", %d skipped" % skipped if skipped else ""))
    sys.exit(1 if failed else 0)
