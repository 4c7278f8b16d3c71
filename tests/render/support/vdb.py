"""Volume files, by the writer that scenes are made with."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../scripts"))

from vdb_file import vdb_bytes, vdb_uri  # noqa: E402,F401
