#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes and the sky of bench/papers/scenes: a teapot, and the sails of a metal building.

The teapot is Martin Newell's of 1975 by its published control points: pot, rim and lid are surfaces of revolution, the
handle and the spout are two Bezier patches each with their mirror images. It is written in parts, so that the lid's
knob can have its own material, with y up and 3.15 units high.

The building is a stand-in for a concert hall whose model is not public: free-form sails of sheet metal that lean out
and curl, in metres.
"""

import math
import os
import sys

from scene_mesh import Mesh, lathe, quads, sheet

# Profiles as (radius, height), cubic Bezier curves one after the other.
POT = (((0, 0), (1.425, 0), (1.5, 0.075), (1.5, 0.15)), ((1.5, 0.15), (1.5, 0.225), (2, 0.45), (2, 0.9)),
       ((2, 0.9), (2, 1.35), (1.75, 1.875), (1.5, 2.4)))
RIM = (((1.5, 2.4), (1.4375, 2.53125), (1.3375, 2.53125), (1.4, 2.4)),)
LID = (((1.3, 2.4), (1.3, 2.55), (0.4, 2.55), (0.2, 2.7)),)
KNOB = (((0.2, 2.7), (0, 2.85), (0.8, 3.15), (0, 3.15)),)

# Patches as rows of (along, sideways, height), from one end to the other; the second of a pair begins with the last
# row of the first.
HANDLE = (((-1.6, 0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0, 2.25)),
          ((-2.3, 0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0, 2.25)),
          ((-2.7, 0, 2.025), (-2.7, -0.3, 2.025), (-3, -0.3, 2.25), (-3, 0, 2.25)),
          ((-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3, -0.3, 1.8), (-3, 0, 1.8)),
          ((-2.7, 0, 1.575), (-2.7, -0.3, 1.575), (-3, -0.3, 1.35), (-3, 0, 1.35)),
          ((-2.5, 0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0, 0.9375)),
          ((-2, 0, 0.9), (-2, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0, 0.6)))
SPOUT = (((1.7, 0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0, 0.6)),
         ((2.6, 0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0, 0.825)),
         ((2.3, 0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0, 2.025)),
         ((2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4)),
         ((2.8, 0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0, 2.49375)),
         ((2.9, 0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0, 2.5125)),
         ((2.8, 0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0, 2.4)))

# Sails: four points of a curve on the ground, how far the top leans out and shifts along, and the heights of its ends.
SAILS = ((((-18, 4), (-14, -6), (-4, -8), (-1, 2)), (3.0, -2.0), (9, 14)),
         (((-6, 6), (-2, -7), (6, -9), (10, -1)), (4.0, 2.0), (15, 11)),
         (((4, 5), (7, -4), (14, -7), (19, 3)), (3.0, 3.0), (8, 12)),
         (((-12, 9), (-8, 1), (2, 0), (6, 8)), (2.0, 0.5), (17, 20)),
         (((-3, -6), (0, -11), (4, -11), (8, -7)), (1.5, -1.0), (5, 7)))
SKY, CITY = (0.30, 0.42, 0.75), (0.30, 0.22, 0.14)


def bezier(points, t):
    s = 1 - t
    weights = (s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t)
    return tuple(sum(w * p[k] for w, p in zip(weights, points)) for k in range(len(points[0])))


def profile(curves, steps):
    points = [curves[0][0]]
    for curve in curves:
        points += [bezier(curve, i / steps) for i in range(1, steps + 1)]
    return points


def turned(curves, steps, around):
    return lathe([profile(curves, steps)], around)


def pipe(rows, steps, around):
    """Patches of half a pipe and their mirror images, closed around."""
    mesh, rings = Mesh(), []
    for first in (0, 3):
        for i in range(0 if first == 0 else 1, steps + 1):
            corners = [bezier([rows[first + k][column] for k in range(4)], i / steps) for column in range(4)]
            half = [bezier(corners, j / around) for j in range(around + 1)]
            ring = half + [(x, -y, z) for x, y, z in half[-2:0:-1]]
            rings.append(range(len(mesh.p), len(mesh.p) + len(ring)))
            mesh.p += [(x, z, -y) for x, y, z in ring]
    mesh.t = quads(rings, wrap=True)
    return mesh


def teapot():
    pot = turned(POT, 10, 48).add(turned(RIM, 6, 48))
    return {"teapot-pot": pot.add(pipe(HANDLE, 8, 8)).add(pipe(SPOUT, 8, 10)), "teapot-lid": turned(LID, 10, 48),
            "teapot-knob": turned(KNOB, 8, 32)}


def sail(curve, lean, heights):
    """Leans out more the higher, and most in the middle."""
    def point(u, v):
        x, z = bezier(curve, u)
        height = heights[0] + (heights[1] - heights[0]) * u + 1.5 * math.sin(3 * math.pi * u)
        out = lean[0] * v * v * math.sin(math.pi * u)
        return (x + lean[1] * v, height * v, z - out + 0.6 * math.sin(2 * math.pi * (u + 0.5 * v)))
    return sheet(28, 12, point)


def building():
    mesh = Mesh()
    for sail_of in SAILS:
        mesh.add(sail(*sail_of))
    return {"metal-building": mesh}


def rgbe(colour):
    exponent = math.ceil(math.log2(max(colour)))
    return bytes(min(255, round(c / 2 ** (exponent - 8))) for c in colour) + bytes([exponent + 128])


def write_sky(path, rows=16):
    """Even above the horizon, even below: 4 pixels a row."""
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X 4\n".encode())
        for row in range(rows):
            file.write(rgbe(SKY if row < rows // 2 else CITY) * 4)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", "bench", "papers", "scenes")
    meshes = os.path.join(folder, "meshes")
    os.makedirs(meshes, exist_ok=True)
    for name, mesh in {**teapot(), **building()}.items():
        mesh.write_ply(os.path.join(meshes, name + ".ply"), smooth=True)
    write_sky(os.path.join(meshes, "city-sky.hdr"))


if __name__ == "__main__":
    main()
