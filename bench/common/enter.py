# SPDX-License-Identifier: Apache-2.0
"""Goes on in a Python that has numpy: this one, or the one named by SHEEN_BENCH_PYTHON, or the virtual environment that
bench/peers/setup makes. Called after the arguments are read, so that --help works everywhere."""

import importlib.util
import os
import sys

from running import ROOT, fail


def enter():
    if importlib.util.find_spec("numpy"):
        return
    python = os.environ.get("SHEEN_BENCH_PYTHON", os.path.join(ROOT, "build", "peers-venv", "bin", "python"))
    if os.environ.get("SHEEN_BENCH_ENTERED") or not os.access(python, os.X_OK):
        fail("needs numpy; run bench/peers/setup first")
    os.environ["SHEEN_BENCH_ENTERED"] = "1"
    os.execv(python, [python, *sys.argv])
