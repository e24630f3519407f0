#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Puts the frames of an animation side by side, to look at many at once: for pops, seams and flicker.

    contact_sheet.py walk.##.png -o sheet.png --columns 6
    contact_sheet.py walk.##.png -o crops.png --crop 100,60,64,48 --scale 3
    contact_sheet.py walk.##.png -o changes.png --changes 8

Reads and writes PNG files of 8 bits RGB, as sheen writes them; needs only Python's standard library.
"""

import argparse
import glob
import os
import re
import struct
import sys
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
GAP = 4


def fail(message):
    sys.exit(f"contact_sheet.py: {message}")


def paeth(left, above, corner):
    """The neighbor that left + above - corner is nearest to; from the PNG specification."""
    p = left + above - corner
    a, b, c = abs(p - left), abs(p - above), abs(p - corner)
    return left if a <= b and a <= c else above if b <= c else corner


def unfilter(kind, row, above, step):
    """Undoes a row's filter in place."""
    if kind == 2:
        row[:] = bytes((x + b) & 255 for x, b in zip(row, above))
    elif kind:
        for i in range(len(row)):
            left = row[i - step] if i >= step else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            else:
                row[i] = (row[i] + paeth(left, above[i], above[i - step] if i >= step else 0)) & 255


def read_png(path):
    """Returns width and rows, each a bytearray of RGB."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != SIGNATURE:
        fail(f"{path}: not a PNG file")
    at, packed, header = 8, b"", None
    while at + 12 <= len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        at += size + 12
    if not header or header[2:] != (8, 2, 0, 0, 0):
        fail(f"{path}: not 8 bits RGB without interlacing")
    width, height = header[:2]
    raw = zlib.decompress(packed)
    above, rows = bytearray(3 * width), []
    for y in range(height):
        begin = y * (3 * width + 1)
        row = bytearray(raw[begin + 1:begin + 1 + 3 * width])
        unfilter(raw[begin], row, above, 3)
        rows.append(row)
        above = row
    return width, rows


def write_png(path, width, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    with open(path + ".part", "wb") as file:
        file.write(SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
    os.replace(path + ".part", path)


def find_frames(patterns):
    """Files that patterns with # stand for, in the order of their numbers."""
    paths = []
    for pattern in patterns:
        folder, name = os.path.split(pattern)
        if "#" not in name:
            paths.append(pattern)
            continue
        # Runs of # became escaped characters.
        expression = re.compile(re.sub(r"(?:\\#|#)+", r"(\\d+)", re.escape(name)))
        found = [(int(m.group(1)), p) for p in glob.glob(os.path.join(glob.escape(folder or "."), "*"))
                 if (m := expression.fullmatch(os.path.basename(p)))]
        paths += [p for _, p in sorted(found)]
    return paths


def crop_and_scale(width, rows, crop, scale):
    x, y, w, h = crop or (0, 0, width, len(rows))
    if x + w > width or y + h > len(rows):
        fail(f"--crop: outside of {width} x {len(rows)} pixels")
    out = []
    for row in rows[y:y + h]:
        part = row[3 * x:3 * (x + w)]
        wide = b"".join(bytes(part[3 * i:3 * i + 3]) * scale for i in range(w)) if scale > 1 else part
        out += [wide] * scale
    return w * scale, out


def changes(rows, before, gain):
    """Differences from the frame before about gray."""
    return [bytes(max(0, min(255, 128 + int(gain * (a - b)))) for a, b in zip(row, old))
            for row, old in zip(rows, before)]


def numbers(text):
    values = tuple(int(x) for x in text.split(","))
    if len(values) != 4 or min(values) < 0 or min(values[2:]) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not X,Y,W,H")
    return values


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("frames", nargs="+", help="PNG files, or a pattern such as walk.##.png")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--every", type=int, default=1, help="take each Nth frame only")
    parser.add_argument("--crop", type=numbers, metavar="X,Y,W,H", help="of every frame, pixels")
    parser.add_argument("--scale", type=int, default=1, help="enlarge N times")
    parser.add_argument("--changes", type=float, metavar="GAIN",
                        help="show differences from the frame before about gray, GAIN times")
    a = parser.parse_args()
    if min(a.columns, a.every, a.scale) < 1:
        fail("--columns, --every and --scale are 1 or more")
    cells, size, before = [], None, None
    for path in find_frames(a.frames)[::a.every]:
        cell = crop_and_scale(*read_png(path), a.crop, a.scale)
        if size not in (None, (cell[0], len(cell[1]))):
            fail(f"{path}: another size than the frames before")
        size = cell[0], len(cell[1])
        cells.append(changes(cell[1], before or cell[1], a.changes) if a.changes else cell[1])
        before = cell[1]
    if not cells:
        fail("there are no frames")
    columns = min(a.columns, len(cells))
    width = columns * (size[0] + GAP) + GAP
    gap_row = bytes(3 * width)
    sheet = [gap_row] * GAP
    for first in range(0, len(cells), columns):
        line = cells[first:first + columns]
        for y in range(size[1]):
            row = b"".join(bytes(3 * GAP) + bytes(cell[y]) for cell in line)
            sheet.append(row + bytes(3 * width - len(row)))
        sheet += [gap_row] * GAP
    write_png(a.output, width, sheet)


if __name__ == "__main__":
    main()
