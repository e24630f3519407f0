# SPDX-License-Identifier: Apache-2.0
"""Runs programs and measures them."""

import hashlib
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass, field

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.path.join(ROOT, "build", "bench")
SHEEN = os.environ.get("SHEEN_BIN", os.path.join(ROOT, "build", "release", "bin", "sheen"))


@dataclass
class Run:
    wall: float  # seconds
    user: float  # seconds of processor time of all threads, in the program and in the system for it
    memory: float = 0.0  # MiB, the most that was resident
    stats: dict = field(default_factory=dict)  # of sheen --stats

    @property
    def records(self):
        records = self.stats["records"]
        return records["irradiance"] + records["radiance"]

    @property
    def rays(self):
        return sum(self.stats["rays"].values())

    def seconds(self, *stages):
        return sum(self.stats["time"][stage] for stage in stages)


def fail(message):
    sys.exit(f"{os.path.basename(sys.argv[0])}: {message}")


def note(message):
    """Progress goes to stderr, so that stdout holds the results only."""
    print(message, file=sys.stderr, flush=True)


def folder(*parts):
    """A folder below build/bench, made when missing."""
    path = os.path.join(BUILD, *parts)
    os.makedirs(path, exist_ok=True)
    return path


def beside(variable, *parts):
    """A path in a folder that an environment variable names; by default it lies beside the project."""
    default = {"SHEEN_SCENES": "scenes", "SHEEN_PEERS": "peers"}[variable]
    base = os.environ.get(variable, os.path.join(os.path.dirname(ROOT), "shared", default))
    return os.path.join(base, *parts)


def digest(paths, start=b""):
    """A short name of what the files hold, after the bytes of `start`."""
    found = hashlib.sha256(start)
    for path in paths:
        with open(path, "rb") as data:
            found.update(data.read())
    return found.hexdigest()[:12]


def measure(command, cwd=None):
    """Runs to the end; fails with the program's last words when it does."""
    start = time.perf_counter()
    with subprocess.Popen(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        words = output.decode(errors="replace").strip().splitlines()[-3:]
        fail(f"{os.path.basename(command[0])} failed with {process.returncode}: " + " / ".join(words))
    return Run(time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def output(command):
    """What a program prints."""
    return subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.decode()


def render(scene, picture, **options):
    """sheen render; spp=4 becomes --spp 4, and of a tuple each. One or several pictures.

    Pixels are boxes unless another filter is asked for: pictures are compared with those of other programs and of
    other sizes.
    """
    options.setdefault("filter", "box")
    return sheen("render", scene, [picture] if isinstance(picture, str) else picture, **options)


def sheen(name, scene, pictures, **options):
    """A command that makes pictures of a scene."""
    if not os.access(SHEEN, os.X_OK):
        fail(f"{SHEEN} is not there; build the release preset first")
    stats = os.path.join(folder(), f"stats-{os.getpid()}.json")
    command = [SHEEN, name, scene, "--stats", stats, "--progress", "none", "--quiet"]
    for path in pictures:
        command += ["-o", path]
    for name, value in options.items():
        for each in value if isinstance(value, tuple) else (value,):
            if each is not None:
                command += ["--" + name.replace("_", "-"), str(each)]
    run = measure(command)
    with open(stats, encoding="utf-8") as file:
        run.stats = json.load(file)
    os.remove(stats)
    return run


def machine():
    """One line about where and in what company the figures were measured."""
    model = "unknown processor"
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the start"
