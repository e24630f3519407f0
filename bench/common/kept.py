# SPDX-License-Identifier: Apache-2.0
"""The converged pictures of the gallery, in bench/references: two independent halves of each scene by path tracing.

Made piece by piece: each run adds samples of new seeds to what is there. references.json says how each was made.
"""

import json
import os

import catalogue
import exr
import pictures
import running

FOLDER = os.path.join(running.ROOT, "bench", "references")
BOOK = os.path.join(FOLDER, "references.json")
WIDTH, HEIGHT = 320, 180
BITS = 7  # of a half float that are kept: a relMSE of 4e-7 by rounding, which the halves' difference includes
PROBE = 9  # samples of the run that, beside one of a single sample, tells how long one takes


def load(path):
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def store(path, data):
    """Whole or not at all, one scene a line, in order, so that changes are easy to see."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    lines = [f"{json.dumps(name)}: {json.dumps(data[name])}" for name in sorted(data)]
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write("{\n" + ",\n".join(lines) + "\n}\n")
    os.replace(path + ".new", path)


def paths(name):
    return [os.path.join(FOLDER, f"{name}-{half}.exr") for half in "ab"]


def halves(scene):
    """(first half, second half, their entry in the book), or None where there is no reference."""
    entry = load(BOOK).get(scene.name)
    if not entry:
        return None
    if entry["scene"] != catalogue.fingerprint(scene):
        running.note(f"{scene.name}: the scene has changed since its reference was made (--anew makes another)")
    return (*(exr.read(path)[0] for path in paths(scene.name)), entry)


def one_pass(scene, spp, seed):
    """A picture of new samples, and its processor seconds."""
    path = os.path.join(running.folder("references"), f"gallery-{os.getpid()}.pfm")
    run = running.render(scene.path, path, integrator="path", size=f"{WIDTH}x{HEIGHT}", spp=spp, seed=seed, threads=1,
                         filter="box")
    picture = pictures.read_pfm(path)
    os.remove(path)
    return picture, run.user


def refine(scene, seconds, most, anew):
    """Adds `seconds` of one processor, both halves together, up to `most` samples a pixel of each half."""
    book = load(BOOK)
    entry = None if anew else book.get(scene.name)
    if not entry:
        entry = {"spp": 0, "seconds": 0.0, "passes": 0, "noise": None, "scene": catalogue.fingerprint(scene)}
    start, probe = (one_pass(scene, samples, 1)[1] for samples in (1, PROBE))
    rate = max(probe - start, 0.01) / (PROBE - 1)
    spp = min(int(seconds / 2 / rate), most - entry["spp"])
    if spp < 1:
        return
    found = []
    for half, path in enumerate(paths(scene.name)):
        picture, took = one_pass(scene, spp, 1000 * (half + 1) + entry["passes"])
        if entry["spp"]:
            picture = (entry["spp"] * exr.read(path)[0] + spp * picture) / (entry["spp"] + spp)
        entry["seconds"] = round(entry["seconds"] + max(took - start, 0), 1)
        found.append(picture)
    entry.update(spp=entry["spp"] + spp, passes=entry["passes"] + 1)
    os.makedirs(FOLDER, exist_ok=True)
    for half, path in enumerate(paths(scene.name)):
        texts = {"scene": scene.shown, "integrator": "path", "spp": entry["spp"], "half": "ab"[half]}
        exr.write(path, found[half], texts, BITS)
    entry["noise"] = float(f"{pictures.noise_of_mean(*(exr.read(p)[0] for p in paths(scene.name))):.3g}")
    store(BOOK, {**load(BOOK), scene.name: entry})
    running.note(f"{scene.name}: {entry['spp']} spp a half in {entry['seconds']:.0f} s, relMSE of the mean "
                 f"{entry['noise']:.2g}")
