# SPDX-License-Identifier: Apache-2.0
"""Writes and reads small OpenEXR files of three half floats a pixel, compressed by zlib, with text attributes, and reads
the layers of those that the program writes.

Half floats have 11 significant bits; `write` can keep fewer, since bits below the noise of a picture only cost room.
The layout is that of the OpenEXR file format: scan lines in blocks of 16, the bytes of each block separated into even
and odd ones, each byte the difference from the one before, then deflated.
"""

import struct
import zlib

try:
    import numpy as np
except ImportError:  # enter.enter() goes on elsewhere before any function here is called
    np = None

LINES = 16  # of a block
MAGIC = struct.pack("<II", 20000630, 2)
LONG_NAMES = 0x400
HALF, FLOAT, ZIP = 1, 2, 3
CHANNELS = "BGR"  # in the file, by the alphabet


def rounded(picture, bits):
    """The picture as half floats with `bits` significant bits after the first. Rounded once: to half floats first and
    then to fewer bits would meet every second value in the middle, and lift it."""
    mantissa, exponent = np.frexp(picture)
    value = np.ldexp(np.rint(mantissa * 2.0 ** (bits + 1)), exponent - (bits + 1))
    largest = (2 - 2.0 ** -bits) * 2.0 ** 15
    return np.clip(value, -largest, largest).astype(np.float16).view(np.uint16)


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value


def header(width, height, texts):
    channels = b"".join(c.encode() + b"\0" + struct.pack("<IB3xII", HALF, 0, 1, 1) for c in CHANNELS) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    parts = [attribute("channels", "chlist", channels), attribute("compression", "compression", bytes([ZIP])),
             attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
             attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
             attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
             attribute("screenWindowWidth", "float", struct.pack("<f", 1))]
    parts += [attribute(name, "string", str(value).encode()) for name, value in texts.items()]
    return MAGIC + b"".join(parts) + b"\0"


def deflate(raw):
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    data[1:] = data[1:] - data[:-1] + np.uint8(128)
    packed = zlib.compress(data.tobytes(), 9)
    return packed if len(packed) < len(raw) else raw


def inflate(packed, size):
    if len(packed) == size:
        return packed
    data = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    data[1:] -= 128
    data = np.cumsum(data).astype(np.uint8)
    out = np.empty(size, np.uint8)
    out[0::2], out[1::2] = data[:(size + 1) // 2], data[(size + 1) // 2:]
    return out.tobytes()


def write(path, picture, texts=None, bits=10):
    """picture: [row from the top][column][3]; texts: attributes by name."""
    height, width, _ = picture.shape
    # In the file a line holds all of its blue, then green, then red.
    lines = rounded(picture, bits)[:, :, ::-1].swapaxes(1, 2).astype("<u2")
    start = header(width, height, texts or {})
    blocks = [deflate(lines[y:y + LINES].tobytes()) for y in range(0, height, LINES)]
    at, offsets, body = len(start) + 8 * len(blocks), [], []
    for k, block in enumerate(blocks):
        offsets.append(struct.pack("<Q", at))
        body.append(struct.pack("<iI", k * LINES, len(block)) + block)
        at += len(body[-1])
    with open(path, "wb") as file:
        file.write(start + b"".join(offsets) + b"".join(body))


def channel_list(value):
    """(name, type) of each channel."""
    found = []
    while len(value) > 1:
        name, rest = value.split(b"\0", 1)
        found.append((name.decode(), struct.unpack_from("<I", rest)[0]))
        value = rest[16:]
    return found


def planes(path):
    """All channels of a file compressed by zlib whose pixels are all of one type: an array [row][column][channel] of
    float64, their names, and the text attributes."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != MAGIC[:4] or struct.unpack_from("<I", data, 4)[0] & ~LONG_NAMES != 2:
        raise ValueError(f"{path}: not an OpenEXR file of one part in scan lines")
    at, attributes = 8, {}
    while data[at]:
        name, kind, _ = data[at:at + 512].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<I", data, at)
        attributes[name.decode()] = (kind.decode(), data[at + 4:at + 4 + size])
        at += 4 + size
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = channel_list(attributes["channels"][1])
    kinds = {kind for _, kind in channels}
    if attributes["compression"][1] != bytes([ZIP]) or len(kinds) != 1 or not kinds <= {HALF, FLOAT}:
        raise ValueError(f"{path}: not of floats of one size compressed in blocks")
    lines = np.empty((height, len(channels), width), "<f2" if kinds == {HALF} else "<f4")
    count = -(-height // LINES)
    for offset in struct.unpack_from(f"<{count}Q", data, at + 1):
        y, size = struct.unpack_from("<iI", data, offset)
        block = lines[y - y0:y - y0 + LINES]
        block[:] = np.frombuffer(inflate(data[offset + 8:offset + 8 + size], block.nbytes),
                                 lines.dtype).reshape(block.shape)
    texts = {name: value.decode() for name, (kind, value) in attributes.items() if kind == "string"}
    return lines.swapaxes(1, 2).astype(np.float64), [name for name, _ in channels], texts


def read(path):
    """A file of `write`: the picture as float64, and the text attributes."""
    pixels, names, texts = planes(path)
    return pixels[:, :, [names.index(c) for c in "RGB"]], texts


def layers(path):
    """A file of sheen: by name its layers, the colour as "", each [row][column][channel] in the file's order of RGB, XYZ
    and so on."""
    pixels, names, _ = planes(path)
    found = {}
    for index, name in enumerate(names):
        layer, _, channel = name.rpartition(".")
        found.setdefault(layer, []).append(("RGBXYZUV".find(channel), index))
    return {layer: pixels[:, :, [index for _, index in sorted(parts)]] for layer, parts in found.items()}
