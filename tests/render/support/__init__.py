"""What the render tests share: scenes made in memory, renders of them, and verdicts.

    scene.py    writes glTF files          shapes.py   geometry and matrices
    images.py   reads and writes EXR, PNG  render.py   runs the renderer
    verdict.py  counts what holds          optics.py   closed forms and quadrature
"""
import os
import sys

sys.dont_write_bytecode = True

try:
    import numpy  # noqa: F401
except ImportError:
    # A python3 of the user's own may come before Debian's, which has python3-numpy.
    if os.path.exists("/usr/bin/python3") and not os.environ.get("CDL_TEST_PYTHON"):
        os.environ["CDL_TEST_PYTHON"] = "1"
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
    sys.exit("the render tests need numpy: apt-get install python3-numpy")
