# SPDX-License-Identifier: Apache-2.0
"""The three pictures of scenes/interior.xml, painted by formula, and a PNG writer. Colours are sRGB, 0 to 255."""

import math
import random
import struct
import zlib


def write_png(path, width, height, pixel):
    """pixel(x, y) -> (r, g, b), y from the top."""
    rows = bytearray()
    for y in range(height):
        rows.append(1)  # filter: difference from the left, which suits grain along x
        left = (0, 0, 0)
        for x in range(width):
            p = tuple(max(0, min(255, int(c + 0.5))) for c in pixel(x, y))
            rows += bytes((c - d) & 255 for c, d in zip(p, left))
            left = p

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def mix(a, b, s):
    return tuple(p + (q - p) * s for p, q in zip(a, b))


def noise(seed, nx, ny):
    """Smooth noise in [0, 1] on a torus: f(u, v) for u, v in [0, 1)."""
    rng = random.Random(seed)
    values = [[rng.random() for _ in range(nx)] for _ in range(ny)]

    def at(u, v):
        x, y = u * nx, v * ny
        i, j = int(math.floor(x)), int(math.floor(y))
        s, t = x - i, y - j
        s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
        top, low = values[j % ny], values[(j + 1) % ny]
        a = top[i % nx] + (top[(i + 1) % nx] - top[i % nx]) * s
        b = low[i % nx] + (low[(i + 1) % nx] - low[i % nx]) * s
        return a + (b - a) * t
    return at


def planks(path, size=512, rows=8):
    """Oak boards along x that repeat in both directions."""
    rng = random.Random(3)
    shade = [[rng.uniform(-1, 1) for _ in range(3)] for _ in range(rows)]
    joint = [[(rng.random() + k / 3) % 1 for k in range(3)] for _ in range(rows)]
    grain, streak = noise(5, 6, 96), noise(6, 20, 256)

    def pixel(x, y):
        u, v = x / size, y / size
        row = int(v * rows)
        cuts = sorted(joint[row])
        board = sum(c <= u for c in cuts) % 3
        dark = 0.0
        if (v * rows - row) * size / rows < 1.2 or min(abs(u - c) for c in cuts) * size < 0.8:
            dark = 0.55
        g = 0.6 * grain((u + 0.37 * board + 0.61 * row) % 1, v) + 0.4 * streak((u + 0.2 * board) % 1, v)
        wood = mix((150, 112, 76), (196, 158, 114), g)
        wood = tuple(c * (1 + 0.07 * shade[row][board]) for c in wood)
        return tuple(4 * round(c / 4) for c in mix(wood, (60, 42, 30), dark))
    write_png(path, size, size, pixel)


def rug(path, width=384, height=256):
    """A border, and a field of diamonds."""
    field, line, ground, accent = (70, 84, 104), (222, 208, 182), (176, 82, 58), (198, 152, 82)
    weave = noise(9, 96, 64)

    def pixel(x, y):
        u, v = abs(2 * (x + 0.5) / width - 1) * width / height, abs(2 * (y + 0.5) / height - 1)
        edge = min(width / height - u, 1 - v)
        if edge < 0.04 or 0.17 < edge < 0.2:
            colour = line
        elif edge < 0.17:
            tooth = abs(((u if edge == 1 - v else v) * 9) % 1 - 0.5) * 2
            colour = ground if (edge - 0.04) / 0.13 < tooth else accent
        else:
            d = abs((u * 3.2) % 1 - 0.5) + abs((v * 3.2) % 1 - 0.5)
            colour = field if d > 0.42 else line if d > 0.34 else ground if d > 0.14 else accent
        return tuple(4 * round(c * (0.94 + 0.1 * weave(x / width, y / height)) / 4) for c in colour)
    write_png(path, width, height, pixel)


def painting(path, width=320, height=240):
    """Hills under a sun."""
    paper = noise(12, 40, 30)

    def pixel(x, y):
        u, v = x / width, y / height
        colour = mix((236, 214, 182), (214, 150, 108), v * 1.1)
        if math.hypot((u - 0.68) * width / height, v - 0.3) < 0.13:
            colour = (196, 76, 48)
        hills = ((0.50, 0.06, 2.2, 0.4, (126, 140, 146)), (0.60, 0.07, 1.5, 2.6, (86, 108, 112)),
                 (0.72, 0.06, 2.0, 4.1, (52, 74, 78)), (0.85, 0.04, 1.3, 5.6, (34, 44, 52)))
        for level, swing, wave, phase, tint in hills:
            if v > level + swing * math.sin(2 * math.pi * wave * u + phase):
                colour = mix(tint, (224, 196, 164), 0.25 * max(0.0, 1 - (v - level) * 6))
        return tuple(2 * round(c * (0.96 + 0.07 * paper(u, v)) / 2) for c in colour)
    write_png(path, width, height, pixel)
