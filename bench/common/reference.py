# SPDX-License-Identifier: Apache-2.0
"""Converged pictures by path tracing, made once and kept in build/bench/references."""

import os

import pictures
import running


def fingerprint(scene, folders, options):
    """Changes when the scene, a file beside it or an option does; the program is taken to be right."""
    paths = [scene]
    for start in folders:
        for where, _, names in sorted(os.walk(start)):
            paths += [os.path.join(where, name) for name in sorted(names)]
    return running.digest(paths, repr(sorted(options.items())).encode())


def halves(name, scene, folders, spp, **options):
    """Two independent path-traced pictures of `spp` samples each, and the relMSE of their mean by its own noise.
    folders: what the scene reads beside its file."""
    where = running.folder("references")
    key = fingerprint(scene, folders, {"spp": spp, **options})
    found = []
    for seed in (1001, 1002):
        path = os.path.join(where, f"{name}-{key}-{seed}.pfm")
        if not os.path.exists(path):
            running.note(f"reference of {name}, {spp} spp, seed {seed} (once) ...")
            running.render(scene, path, integrator="path", spp=spp, seed=seed, **options)
        found.append(pictures.read_pfm(path))
    return found[0], found[1], pictures.noise_of_mean(*found)
