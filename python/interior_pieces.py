# SPDX-License-Identifier: Apache-2.0
"""The furniture of scenes/interior.xml: each function returns a mesh, or several by material name.

Pieces stand on y = 0 and sink 2 mm into what they stand on, so that no two faces coincide. Metres.
"""

import math
import random

from scene_mesh import Mesh, box, lathe, pillow, prism, ring, rounded_box, sheet, tube

SINK = 0.002


def cushion(sx, sy, sz, r, puff, flat=(18, 2, 18)):
    """A rounded box whose top and bottom swell by `puff` in the middle."""
    def swell(x, y, z):
        u, v = 2 * x / sx, 2 * z / sz
        return x, y + (1 if y > 0 else -1) * puff * max(0.0, 1 - u * u) * max(0.0, 1 - v * v) * abs(2 * y / sy), z
    return rounded_box(sx, sy, sz, r, 5, flat).map(swell)


def sofa():
    """2.2 m wide, its back toward -z, the middle of its seat edge at z = 0.95."""
    cloth, feet = Mesh(), Mesh()
    parts = [rounded_box(2.1, 0.2, 0.86, 0.04, 4).move(0, 0.22, 0.48)]
    for side in (-1, 1):
        parts.append(cushion(0.2, 0.5, 0.92, 0.085, 0.012, (3, 6, 18)).move(side * 0.99, 0.37, 0.47))
    parts.append(rounded_box(1.84, 0.62, 0.18, 0.08, 5).turn(0, -8).move(0, 0.5, 0.12))
    for i in (-1, 0, 1):
        parts.append(cushion(0.595, 0.17, 0.68, 0.06, 0.022).move(0.598 * i, 0.395, 0.58))
        parts.append(cushion(0.59, 0.17, 0.46, 0.065, 0.035).turn(0, 78).move(0.598 * i, 0.68, 0.3))
    for part in parts:
        cloth.add(part.check_closed("sofa"))
    for x in (-0.95, 0.95):
        for z in (0.12, 0.84):
            feet.add(lathe([[(0, -SINK), (0.016, -SINK)], [(0.016, -SINK), (0.026, 0.14)], [(0.026, 0.14), (0, 0.14)]],
                           20).check_closed("sofa foot").move(x, 0, z))
    return {"sofa": cloth, "dark-wood": feet}


def throw_pillows():
    first = pillow(0.46, 0.46, 0.2, 32).turn(2, 8).turn(0, -22).turn(1, 24).move(-0.66, 0.72, 0.5)
    second = pillow(0.42, 0.42, 0.18, 32).turn(2, -12).turn(0, -24).turn(1, -30).move(0.7, 0.7, 0.48)
    return {"rust": first.check_closed("pillow"), "cream": second.check_closed("pillow")}


def turned_leg(height, top, foot, n=24):
    """A tapered leg with a slight swell, from -SINK up."""
    wall = [(foot + (top - foot) * s + 0.15 * top * math.sin(math.pi * s) ** 2, -SINK + (height + SINK) * s)
            for s in (k / 12 for k in range(13))]
    return lathe([[(0, -SINK), wall[0]], wall, [wall[-1], (0, height)]], n).check_closed("leg")


def table(width, depth, height):
    top = rounded_box(width, 0.034, depth, 0.012, 4).move(0, height - 0.017, 0).check_closed("table top")
    mesh = Mesh().add(top)
    x, z = width / 2 - 0.09, depth / 2 - 0.09
    for sx in (-1, 1):
        for sz in (-1, 1):
            mesh.add(turned_leg(height - 0.03, 0.03, 0.018).move(sx * x, 0, sz * z))
        mesh.add(rounded_box(0.022, 0.07, 2 * z, 0.004, 2).move(sx * x, height - 0.064, 0))
    for sz in (-1, 1):
        mesh.add(rounded_box(2 * x, 0.066, 0.022, 0.004, 2).move(0, height - 0.064, sz * z))
    return mesh


def chair():
    """Faces +z; the back is at -z. The seat is 0.45 m high."""
    mesh = Mesh()

    def hollow(x, y, z):
        dip = 0.012 * max(0.0, 1 - (x / 0.2) ** 2) * max(0.0, 1 - (z / 0.2) ** 2)
        return x * (1 + 0.18 * z), y - (dip if y > 0 else 0.4 * dip), z
    mesh.add(rounded_box(0.43, 0.034, 0.42, 0.016, 4, (12, 1, 12)).map(hollow).move(0, 0.45, 0).check_closed("seat"))
    for sx in (-1, 1):
        mesh.add(turned_leg(0.445, 0.018, 0.012, 20).turn(0, -4).turn(2, sx * 4).move(sx * 0.2, 0, 0.185))
        post = [(sx * (0.17 + 0.01 * s), -SINK + 0.92 * s, -0.185 - 0.13 * max(0.0, s - 0.5) ** 1.5 - 0.03 * (1 - s))
                for s in (k / 20 for k in range(21))]
        mesh.add(tube(post, 0.015, 16).check_closed("chair post"))
    for y, z in ((0.62, -0.2), (0.73, -0.212), (0.85, -0.232)):
        def bend(x, h, d):
            return x, h, d - 0.03 * (1 - (x / 0.18) ** 2)
        slat = rounded_box(0.36, 0.055, 0.012, 0.005, 3, (12, 1, 1)).map(bend)
        mesh.add(slat.turn(0, -6).move(0, y, z).check_closed("slat"))
    for y in (0.2, 0.3):
        mesh.add(tube([(-0.185, y, 0.19), (0, y + 0.002, 0.19), (0.185, y, 0.19)], 0.008, 10))
    return mesh


def coffee_table():
    mesh = lathe([[(0, 0.36), (0.4, 0.36), (0.415, 0.364), (0.425, 0.375), (0.415, 0.387), (0.4, 0.391), (0, 0.391)]],
                 96).check_closed("coffee table")
    for i in range(3):
        leg = turned_leg(0.365, 0.02, 0.013).turn(2, 12).move(0.3, 0, 0)
        mesh.add(leg.turn(1, 120 * i + 30))
    return mesh


def book(width, height, depth):
    """Stands on y = 0 with a round back at +z; x is its thickness."""
    back = [(width / 2 * math.cos(a), depth / 2 + 0.22 * width * math.sin(a))
            for a in (math.pi * k / 6 for k in range(7))]
    return prism([(-width / 2, -depth / 2)] + back[::-1] + [(width / 2, -depth / 2)], 0, height)


BOOK_COLOURS = ("rust", "navy", "cream", "moss", "ochre", "dark-wood")


def bookshelf(width, height, depth, shelves):
    """Its back is at z = 0. The boards end inside of the sides."""
    rng = random.Random(7)
    t = 0.024
    wood = Mesh()
    for x in (-width / 2, width / 2 - t):
        wood.add(box(x, -SINK, 0.001, x + t, height, depth))
    wood.add(box(-width / 2 + 0.005, -SINK, -SINK, width / 2 - 0.005, height - 0.005, 0.012))
    step = (height - 0.08) / shelves
    parts = {"white-wood": wood}
    for i in range(shelves + 1):
        y = 0.05 + i * step
        wood.add(box(-width / 2 + 0.004, y, 0.006, width / 2 - 0.004, y + t, depth - 0.004))
        if i == shelves:
            break
        x, end = -width / 2 + t + 0.004, width / 2 - t - 0.004
        end -= rng.choice((0.0, 0.12, 0.3)) * (width - 2 * t) if i else 0.45 * width
        while True:
            w = rng.uniform(0.014, 0.045)
            if x + w > end:
                break
            h, d = rng.uniform(0.62, 0.88) * (step - t), rng.uniform(0.62, 0.8) * depth
            colour = rng.choice(BOOK_COLOURS)
            one = book(w, h, d).move(x + w / 2, y + t - SINK, 0.02 + d / 2 + rng.uniform(0, 0.01))
            parts.setdefault(colour, Mesh()).add(one.check_closed("book"))
            x += w + 0.0012
        if end - x < 0.05 and width / 2 - end > 0.15:  # a short pile in the gap
            top = y + t - SINK
            for k in range(rng.randint(2, 4)):
                w = rng.uniform(0.02, 0.04)
                one = book(w, rng.uniform(0.17, 0.2), 0.15).turn(2, 90).turn(1, rng.uniform(-12, 12))
                colour = BOOK_COLOURS[(i + k) % len(BOOK_COLOURS)]
                parts.setdefault(colour, Mesh()).add(one.move(end + 0.205, top + w / 2, depth / 2))
                top += w + 0.0008
    return parts


def curtain(height, width, folds, seed):
    """A hanging cloth in the plane x = 0, from z = 0 to z = width; one sheet, to be shaded from both sides."""
    rng = random.Random(seed)
    phase = [rng.uniform(0, 2 * math.pi) for _ in range(3)]

    def fold(u, v):
        drop = 1 - v  # 0 at the top
        a = 0.022 + 0.018 * drop
        wave = math.sin(2 * math.pi * folds * u + 0.5 * math.sin(3 * drop + phase[0]))
        slow = math.sin(2 * math.pi * 1.7 * u + phase[1] + 0.8 * drop)
        z = width * (u + 0.012 * math.sin(4 * math.pi * folds * u + phase[2]) * (0.4 + drop))
        return (a * wave + 0.02 * drop * slow, height * v, z)
    return sheet(folds * 18, 48, fold)


def curtain_pole(length, radius):
    """Along z, from 0 to length, with a ball at each end."""
    pole = tube([(0, 0, 0), (0, 0, length / 2), (0, 0, length)], radius, 16)
    for z in (0, length):
        ball = [(0.028 * math.sin(math.pi * k / 14), -0.028 * math.cos(math.pi * k / 14)) for k in range(15)]
        ball[0], ball[-1] = (0, ball[0][1]), (0, ball[-1][1])
        pole.add(lathe([ball], 20).check_closed("ball").turn(0, 90).move(0, 0, z))
    return pole


def floor_lamp(height):
    """The bulb is at y = height; the shade is open above and below."""
    metal = lathe([[(0, -SINK), (0.15, -SINK)], [(0.15, -SINK), (0.15, 0.012), (0.145, 0.02), (0.06, 0.028),
                                                 (0.02, 0.04), (0.009, 0.06)],
                   [(0.009, 0.06), (0.009, height - 0.09)],
                   [(0.009, height - 0.09), (0.018, height - 0.088), (0.018, height - 0.05)],
                   [(0.018, height - 0.05), (0, height - 0.05)]], 40).check_closed("lamp stand")
    for i in range(3):  # the shade's carrier
        metal.add(tube([(0.012, height - 0.07, 0), (0.12, height - 0.1, 0), (0.2266, height - 0.1025, 0)], 0.003, 6)
                  .turn(1, 120 * i))
    lower, upper, y0, y1, t = 0.23, 0.17, height - 0.12, height + 0.16, 0.003
    shade = Mesh().add(lathe([[(lower, y0), (upper, y1)], [(upper, y1), (upper - t, y1)],
                              [(upper - t, y1), (lower - t, y0)], [(lower - t, y0), (lower, y0)]], 96))
    return {"brass": metal, "shade": shade.check_closed("shade")}


def vase():
    """A thick-walled glass, outside then inside."""
    outside = [(0.036 + 0.022 * math.sin(math.pi * (s * 1.15 - 0.05)) ** 2 - 0.012 * s, 0.006 + 0.264 * s)
               for s in (k / 40 for k in range(41))]
    foot = [(0, -0.0006), (0.03, -0.0006), (0.034, 0.001)]
    lip = [(outside[-1][0] - 0.0005, 0.2714), (outside[-1][0] - 0.002, 0.2719), (outside[-1][0] - 0.0035, 0.2714)]
    inside = [(r - 0.004, y) for r, y in outside[::-1] if y > 0.03]
    bottom = [(inside[-1][0] - 0.006, 0.022), (0.012, 0.0185), (0, 0.018)]
    return lathe([foot + outside + lip + inside + bottom], 64).check_closed("vase")


def leaf(length, width, bend):
    """A pointed oval along +z that bends down: one sheet, to be shaded from both sides."""
    def blade(u, v):
        s = 2 * u - 1
        half = width / 2 * math.sin(math.pi * min(1.0, 0.02 + 0.98 * v) ** 0.75)
        droop = -bend * length * v * v
        return (half * s, droop + 0.25 * half * s * s + 0.012 * length * math.sin(9 * v) * s, length * v)
    return sheet(8, 14, blade)


def twigs(seed, count=7):
    """Branches in the vase, from its bottom up and out, with small leaves."""
    rng = random.Random(seed)
    wood, leaves = Mesh(), Mesh()
    for i in range(count):
        turn = 2 * math.pi * (i + rng.uniform(-0.2, 0.2)) / count
        reach, height = rng.uniform(0.1, 0.24), rng.uniform(0.42, 0.66)
        path = []
        for k in range(13):
            s = k / 12
            out = 0.016 * min(1.0, s * 3) + reach * max(0.0, s - 0.3) ** 1.6 / 0.7 ** 1.6
            path.append((out * math.cos(turn + 0.4 * s), 0.024 + height * s, out * math.sin(turn + 0.4 * s)))
        wood.add(tube(path, lambda s: 0.0028 - 0.0016 * s, 8).check_closed("twig"))
        for k in range(6, 13):
            for side in (-1, 1):
                one = leaf(rng.uniform(0.045, 0.07), rng.uniform(0.018, 0.028), rng.uniform(0.1, 0.5))
                one.turn(0, rng.uniform(-45, 0)).turn(1, math.degrees(-turn) + 90 + side * rng.uniform(40, 90))
                leaves.add(one.move(*path[k]))
    return {"dark-wood": wood, "leaf": leaves}


def plant(seed):
    """A tall pot plant with big leaves."""
    rng = random.Random(seed)
    pot = lathe([[(0, -SINK), (0.12, -SINK)], [(0.12, -SINK), (0.125, 0.004), (0.165, 0.33)],
                 [(0.165, 0.33), (0.15, 0.33)], [(0.15, 0.33), (0.145, 0.28)]], 64)
    soil = lathe([[(0, 0.02), (0.13, 0.02)], [(0.13, 0.02), (0.148, 0.285), (0.1, 0.292), (0, 0.296)]], 48)
    pot.add(lathe([[(0.145, 0.28), (0, 0.28)]], 64))
    stems, leaves = Mesh(), Mesh()
    for i in range(26):
        turn = 2.399963 * i  # the golden angle
        rise, reach = rng.uniform(0.35, 1.0) * (0.6 + 0.4 * i / 26), rng.uniform(0.1, 0.34) * (1.15 - 0.5 * i / 26)
        path = [(reach * s ** 1.7 * math.cos(turn) + 0.02 * math.cos(3 * i), 0.27 + rise * s,
                 reach * s ** 1.7 * math.sin(turn) + 0.02 * math.sin(3 * i)) for s in (k / 10 for k in range(11))]
        stems.add(tube(path, lambda s: 0.006 - 0.003 * s, 8).check_closed("stem"))
        blade = leaf(rng.uniform(0.2, 0.3), rng.uniform(0.1, 0.15), rng.uniform(0.25, 0.6))
        leaves.add(blade.turn(0, rng.uniform(-50, -15)).turn(1, 90 - math.degrees(turn)).move(*path[-1]))
    return {"terracotta": pot.check_closed("pot"), "dark-wood": soil.check_closed("soil"),
            "stem": stems, "leaf": leaves}


def fruit_bowl():
    outside = [(0.05, 0.004), (0.09, 0.02), (0.125, 0.045), (0.15, 0.078)]
    inside = [(0.144, 0.079), (0.12, 0.05), (0.085, 0.028), (0.04, 0.016), (0, 0.014)]
    bowl = lathe([[(0, -SINK), (0.048, -SINK)], [(0.048, -SINK)] + outside, [outside[-1], inside[0]], inside], 64)
    parts = {"white-wood": bowl.check_closed("bowl")}
    places = ((0.055, 0.058, 0.02), (-0.05, 0.057, 0.035), (0.0, 0.056, -0.06), (0.005, 0.122, 0.0), (-0.075, 0.088, -0.04))
    for i, (x, y, z) in enumerate(places):
        r = 0.036 + 0.002 * (i % 3)
        skin = []
        for k in range(17):
            a = math.pi * k / 16
            dent = 0.22 * math.exp(-((math.pi - a) / 0.32) ** 2) + 0.1 * math.exp(-(a / 0.4) ** 2)
            skin.append((r * math.sin(a) * (1 + 0.05 * math.cos(a - 2.2)), -r * math.cos(a) * (1 - dent)))
        skin[0], skin[-1] = (0, skin[0][1]), (0, skin[-1][1])
        fruit = lathe([skin], 24).check_closed("fruit").turn(0, 20 * i - 30).turn(2, 35 * i - 60).move(x, y, z)
        parts.setdefault("apple" if i % 2 else "ochre", Mesh()).add(fruit)
    return parts


def cup():
    wall = [(0.022, 0.0), (0.03, 0.006), (0.037, 0.03), (0.04, 0.075)]
    inner = [(0.0375, 0.0755), (0.0345, 0.031), (0.027, 0.01), (0, 0.008)]
    mesh = lathe([[(0, -SINK), (0.022, -SINK)], [(0.022, -SINK)] + wall, [wall[-1], inner[0]], inner], 40)
    mesh.check_closed("cup")
    handle = [(0.035 + 0.024 * math.sin(math.pi * s), 0.06 - 0.036 * s - 0.006 * math.sin(2 * math.pi * s), 0)
              for s in (k / 14 for k in range(15))]
    return mesh.add(tube(handle, 0.0045, 10).check_closed("handle"))


def frame(width, height, bar, depth):
    """A picture frame in the xy plane about the origin, its back SINK behind z = 0; the opening is width x height."""
    profile = [(0, -SINK), (bar, -SINK), (bar, depth * 0.6), (bar * 0.75, depth), (bar * 0.3, depth), (0, depth * 0.55)]
    return ring(profile, -width / 2, -height / 2, width / 2, height / 2).check_closed("frame")


def sideboard(width, height, depth):
    """Its back is at z = 0. Doors stand 4 mm apart before the body."""
    mesh = box(-width / 2, 0.12, -SINK, width / 2, height - 0.02, depth - 0.02)
    mesh.add(box(-width / 2 - 0.012, height - 0.024, -SINK, width / 2 + 0.012, height, depth + 0.012))
    third = width / 3
    for i in range(3):
        x = -width / 2 + i * third
        mesh.add(box(x + 0.002, 0.123, depth - 0.024, x + third - 0.002, height - 0.028, depth))
    knobs, feet = Mesh(), Mesh()
    for i in range(3):
        knob = lathe([[(0, 0), (0.006, 0)], [(0.006, 0), (0.006, 0.012), (0.013, 0.017), (0.013, 0.023), (0.008, 0.027),
                                             (0, 0.028)]], 20)
        knobs.add(knob.check_closed("knob").turn(0, 90).move(-width / 2 + (i + 0.85) * third, height * 0.6, depth - 0.002))
    for x in (-width / 2 + 0.08, width / 2 - 0.08):
        for z in (0.06, depth - 0.08):
            feet.add(turned_leg(0.13, 0.02, 0.012).move(x, 0, z))
    return {"oak": mesh, "brass": knobs, "dark-wood": feet}


def rug(width, depth):
    """A thick carpet with a soft edge; its pattern spans the top."""
    def cloth(u, v):
        s, t = 2 * u - 1, 2 * v - 1
        edge = min(1.0, 14 * min(1 - abs(s), 1 - abs(t)))
        lift = 0.012 * math.sqrt(max(0.0, edge * (2 - edge))) + 0.0012 * math.sin(23 * u) * math.sin(17 * v) * edge
        return (s * width / 2, lift - SINK, -t * depth / 2)
    return sheet(96, 64, cloth, uv=True)


def picture(width, height):
    return sheet(1, 1, lambda u, v: ((u - 0.5) * width, (v - 0.5) * height, 0), uv=True)
