# SPDX-License-Identifier: Apache-2.0
"""The scenes of the gallery: the bundled ones and those of SHEEN_SCENES, with their authors."""

import glob
import json
import os
import re
import subprocess
from dataclasses import dataclass

import running

READ = (".xml", ".obj", ".mtl", ".ply", ".serialized", ".png", ".jpg", ".hdr", ".exr", ".tga", ".bmp")
LICENCES = {"CC0": "CC0", "CC-BY": "CC BY 3.0"}
URLS = {"CC0": "https://creativecommons.org/publicdomain/zero/1.0/",
        "CC BY 3.0": "https://creativecommons.org/licenses/by/3.0/"}
# What stands beside the scenes without a sentence to read it from: folder, author.
OTHERS = {"mitsuba-tutorials": "[Mitsuba's tutorials](https://github.com/mitsuba-renderer/mitsuba-tutorials)",
          "mcguire-cornell-box": "Guedis Cardenas and Morgan McGuire, [CC BY 3.0](" + URLS["CC BY 3.0"] + ")"}

# Why one of two files of a scene is not shown, where that is not only that the other is newer.
BROKEN = {"mitsuba/veach-bidir/scene.xml": "most of its surfaces show the side on which they are black"}


@dataclass
class Scene:
    name: str  # short, for files and options
    path: str
    shown: str  # the path that readers know
    credit: str = "of this project"


def read(path):
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def credit(folder):
    """Title, author and licence as Markdown, from LICENSE.txt of a folder of Bitterli's export."""
    text = read(os.path.join(folder, "LICENSE.txt"))
    found = re.search(r"version of '(.*)' by (.*), downloaded", text)
    licence = re.search(r"under a (\S+) license", text)
    if not found or not licence:
        return OTHERS.get(os.path.basename(folder), "see the scene's folder")
    name = LICENCES.get(licence.group(1), licence.group(1))
    origin = re.search(r"obtained here: (\S+)", text)
    title = f"[“{found.group(1)}”]({origin.group(1)})" if origin else f"“{found.group(1)}”"
    return f"{title} by {found.group(2)}, [{name}]({URLS.get(name, '')})"


def bundled():
    paths = sorted(glob.glob(os.path.join(running.ROOT, "scenes", "*.xml")))
    return [Scene(os.path.splitext(os.path.basename(p))[0], p, os.path.relpath(p, running.ROOT)) for p in paths]


def shared(taken):
    """The scenes of SHEEN_SCENES, and a line for each file that is left out.
    taken: names that mean other scenes already."""
    base, found, left = running.beside("SHEEN_SCENES"), [], []

    def add(name, path):
        shown = os.path.relpath(path, base)
        found.append(Scene(name, path, shown, credit(os.path.dirname(path))))

    for folder in sorted(glob.glob(os.path.join(base, "mitsuba", "*", ""))):
        folder = folder.rstrip("/")
        name = os.path.basename(folder)
        if name == "mitsuba-tutorials":
            for path in sorted(glob.glob(os.path.join(folder, "*.xml"))):
                add("tutorials-" + os.path.splitext(os.path.basename(path))[0], path)
            continue
        newest = [p for p in (os.path.join(folder, f) for f in ("scene_v3.xml", "scene.xml")) if os.path.exists(p)]
        if newest:
            add("mitsuba-" + name if name in taken else name, newest[0])
        for path in newest[1:]:
            shown = os.path.relpath(path, base)
            left.append(f"{shown}: {BROKEN.get(shown, 'an older form')}; {os.path.basename(newest[0])} stands for it")
    for path in sorted(glob.glob(os.path.join(base, "obj", "mcguire-cornell-box", "*.obj"))):
        stem = os.path.splitext(os.path.basename(path))[0]
        if stem.startswith("CornellBox-"):
            add("mcguire-" + stem[len("CornellBox-"):].lower(), path)
        else:
            left.append(f"{os.path.relpath(path, base)}: a part of another scene")
    return found, left


def scenes(names=""):
    """All scenes, or those with the names, which commas separate; and what is left out."""
    own = bundled()
    others, left = shared({scene.name for scene in own})
    found = {scene.name: scene for scene in own + others}
    if not names:
        return list(found.values()), left
    chosen = names.split(",")
    unknown = [name for name in chosen if name not in found]
    if unknown:
        running.fail(f"no scene {', '.join(unknown)}; there are {', '.join(found)}")
    return [found[name] for name in chosen], []


def triangles(scene):
    listing = subprocess.run([running.SHEEN, "info", "--json", scene.path], capture_output=True, check=True).stdout
    return json.loads(listing)["triangles"]


def fingerprint(scene):
    """Changes when the scene or what it may read does."""
    folder, file = os.path.split(scene.path)
    if file == scene.name + ".xml":  # bundled: what it reads is in a folder of its name
        paths, folder = [scene.path], os.path.join(folder, scene.name)
    else:
        paths = [] if file.endswith(".xml") else [scene.path]
    for where, _, files in sorted(os.walk(folder)):
        paths += [os.path.join(where, f) for f in sorted(files)
                  if f.endswith(READ) and not f.startswith("TungstenRender")]
    return running.digest(paths)
