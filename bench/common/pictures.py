# SPDX-License-Identifier: Apache-2.0
"""Reads pictures into arrays [row from the top][column][3] of linear floats, and compares them."""

try:
    import numpy as np
except ImportError:  # enter.enter() goes on elsewhere before any function here is called
    np = None

LUMINANCE = (0.2126, 0.7152, 0.0722)
BLOCK = 8  # pixels


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().split() for _ in range(3))
        if kind != [b"PF"]:
            raise ValueError(f"{path}: not a colour PFM")
        width, height = map(int, size)
        data = np.frombuffer(file.read(), "<f4" if float(scale[0]) < 0 else ">f4", width * height * 3)
    return data.reshape(height, width, 3)[::-1].astype(np.float64)  # PFM begins with the lowest row


def read_hdr(path):
    """Radiance RGBE, run-length coded or not."""
    with open(path, "rb") as file:
        data = file.read()
    head, body = data.split(b"\n\n", 1)
    if not head.startswith(b"#?"):
        raise ValueError(f"{path}: not a Radiance picture")
    size, body = body.split(b"\n", 1)
    axis_y, height, axis_x, width = size.split()
    if (axis_y, axis_x) != (b"-Y", b"+X"):
        raise ValueError(f"{path}: unusual orientation")
    height, width = int(height), int(width)
    rgbe = np.empty((height, width, 4), np.uint8)
    at = 0
    for row in rgbe:
        if body[at:at + 2] == b"\x02\x02" and 8 <= width < 32768:
            at += 4
            for channel in range(4):
                x = 0
                while x < width:
                    count = body[at]
                    if count > 128:
                        row[x:x + count - 128, channel] = body[at + 1]
                        x, at = x + count - 128, at + 2
                    else:
                        row[x:x + count, channel] = np.frombuffer(body, np.uint8, count, at + 1)
                        x, at = x + count, at + 1 + count
        else:
            row[:] = np.frombuffer(body, np.uint8, 4 * width, at).reshape(width, 4)
            at += 4 * width
    scale = np.where(rgbe[..., 3] > 0, np.ldexp(1.0, rgbe[..., 3].astype(int) - 136), 0.0)
    return (rgbe[..., :3] + 0.5) * scale[..., None]


def luminance(picture):
    return picture @ LUMINANCE


def blocks(layer):
    """Cut into blocks: [block row][block column][pixel of the block]; what does not fill a block is left out."""
    rows, columns = (n // BLOCK for n in layer.shape[:2])
    cut = layer[:rows * BLOCK, :columns * BLOCK]
    return cut.reshape(rows, BLOCK, columns, BLOCK).swapaxes(1, 2).reshape(rows, columns, BLOCK * BLOCK)


def widen(mask):
    """The mask and every pixel that touches it, corners too."""
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    return np.any([padded[i:i + rows, j:j + columns] for i in range(3) for j in range(3)], axis=0)


def narrow(mask, by):
    """The mask without pixels that are nearer than this to one outside."""
    for _ in range(by):
        mask = ~widen(~mask)
    return mask


def second_differences(layer, axis, step):
    """f(x - step) - 2 f(x) + f(x + step) along an axis; zero where the picture ends."""
    layer = np.moveaxis(layer, axis, 0)
    out = np.zeros_like(layer)
    out[step:-step] = layer[:-2 * step] - 2 * layer[step:-step] + layer[2 * step:]
    return np.moveaxis(out, 0, axis)


def usable_blocks(left_out):
    """Blocks without a pixel of the mask, or one beside it."""
    return ~blocks(widen(left_out)).any(axis=2)


def block_errors(picture, reference, usable):
    """Block means of luminance against the reference's: RMSE over the mean, 95th percentile and largest relative
    error, and where the largest is (block row, block column)."""
    x, r = (blocks(luminance(p)).mean(axis=2) for p in (picture, reference))
    relative = np.where(usable, np.abs(x - r) / np.where(usable, r, 1), 0)
    kept = relative[usable]
    rmse = np.sqrt(np.mean((x - r)[usable] ** 2)) / np.mean(r[usable])
    return {"rmse": float(rmse), "p95": float(np.percentile(kept, 95)), "max": float(kept.max()),
            "worst": tuple(int(i) for i in np.unravel_index(relative.argmax(), relative.shape))}


def relmse(picture, reference):
    """As `sheen compare` has it."""
    return float(np.mean((picture - reference) ** 2 / (reference ** 2 + 0.01)))


def bias(picture, reference):
    return float(picture.mean() / reference.mean() - 1)


def noise_of_mean(first, second):
    """relMSE that the mean of two independent halves has by its own noise: half of their difference is distributed
    as the mean's error."""
    mean = (first + second) / 2
    return float(np.mean(((first - second) / 2) ** 2 / (mean ** 2 + 0.01)))
