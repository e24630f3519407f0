# SPDX-License-Identifier: Apache-2.0
"""Writes docs/gallery.md and its small pictures, and the list of references, from the figures that are kept."""

import os

import judge
import kept
import running
from pictures import LUMINANCE, np

DOCS = os.path.join(running.ROOT, "docs")
SMALL = os.path.join(DOCS, "pictures", "gallery")
BRIGHT = 0.6  # what nine tenths of the small picture's pixels are below, in linear luminance

TOP = """# Gallery

Every bundled scene, and scenes by other people, as `sheen render` shows them by default at 640 × 360 ({integrators}),
beside path tracing. `bench/gallery` renders, measures and writes this page; `build/gallery.html`, which it writes too,
shows all pictures beside their references with a slider, the map of errors and an exposure.

- **s** is the time of the whole program, loading included: wall clock / processor, the better of {runs} runs, on
  {threads} threads of a machine with a load of {load} when the run began.
- **relMSE** is judged at 320 × 180, each pixel the mean of four, against path-traced references
  ([how each was made](../bench/references/README.md)): the mean over pixels and channels of (x − r)² / (r² + 0.01). The
  noise of the reference is taken off: the square is the product of the differences from its two independent halves.
  ± is the standard error, from the scatter over patches of 20 × 20 pixels.
- **bias** is mean(x) / mean(r) − 1, ± with the noise of the reference and the scatter of the runs.
- **path** is the time that `--integrator path` needs for the same relMSE, from runs of {path_spp} samples a pixel that
  are judged in the same way: the error falls as 1 / samples, the time rises linearly. **×** is the ratio of the times,
  wall clock / processor. “>” stands where the error is not known from zero: the bound is for its value plus two
  standard errors.
- All pixels are averaged with a box. The small pictures are brightened by whole and half stops, each for itself.

"""


def small_picture(name, picture):
    """Writes the small picture. Returns the stops by which it is brightened."""
    from PIL import Image  # only here: figures can be had without

    level = float(np.percentile(picture @ np.array(LUMINANCE), 90))
    stops = float(np.clip(round(2 * np.log2(BRIGHT / max(level, 1e-6))) / 2, -4, 4))
    x = np.clip(picture * 2.0 ** stops, 0, 1)
    srgb = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    os.makedirs(SMALL, exist_ok=True)
    image = Image.fromarray(np.rint(255 * srgb).astype(np.uint8))
    image.resize((240, 135), Image.LANCZOS).save(os.path.join(SMALL, name + ".jpg"), quality=85, optimize=True)
    return stops


def seconds(wall, user):
    return f"{number(wall)} / {number(user)}"


def number(x):
    """Two or three digits, without exponents."""
    return f"{x:,.0f}" if abs(x) >= 100 else f"{x:.3g}" if abs(x) >= 10 else f"{x:.2g}"


def scientific(x):
    """Like 1.2·10⁻⁴."""
    if x == 0:
        return "0"
    mantissa, exponent = f"{x:.1e}".split("e")
    return f"{mantissa}·10" + str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def row(name, entry, integrator, first):
    found = entry["cached"][integrator]
    cells = [f"![{name}](pictures/gallery/{name}.jpg)" if first else "",
             f"**{name}**<br>{entry['credit']}<br>`{entry['scene']}`" if first else "", integrator,
             f"{entry['triangles']:,}", f"{found['records']:,}", seconds(found["wall"], found["user"]),
             f"{scientific(found['relmse'])} ± {scientific(found['relmse_error'])}",
             f"{100 * found['bias']:+.2f} ± {100 * found['bias_error']:.2f} %"]
    if "path" in entry:
        other = judge.beside(found, entry["path"])
        bound = "" if other["known"] else "> "
        cells += [bound + seconds(other["path_wall"], other["path_user"]),
                  bound + seconds(other["ratio_wall"], other["ratio_user"])]
    else:
        cells += ["-", "-"]
    return "| " + " | ".join(cells) + " |\n"


def write_references(book):
    """The list beside the references."""
    text = ("# Converged pictures for the gallery\n\n"
            f"By path tracing (`--integrator path --size {kept.WIDTH}x{kept.HEIGHT} --filter box`, all else default),\n"
            "two halves of each scene with different seeds, so that their difference tells the noise. `bench/gallery\n"
            "--references SECONDS` adds samples to them. Half floats, of which the lowest bits are rounded away: they\n"
            "are below the noise. `references.json` holds the figures of this table; `figures.json` those of\n"
            "[the gallery](../../docs/gallery.md).\n\n"
            "| scene | samples a pixel of each half | processor seconds of both | relMSE of the mean by its noise |\n"
            "| --- | --- | --- | --- |\n")
    for name, entry in sorted(book.items()):
        text += f"| {name} | {entry['spp']:,} | {entry['seconds']:.0f} | {scientific(entry['noise'])} |\n"
    os.makedirs(kept.FOLDER, exist_ok=True)
    with open(os.path.join(kept.FOLDER, "README.md"), "w", encoding="utf-8") as file:
        file.write(text)


def spread(values):
    low, high = min(values), max(values)
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def write(figures, book, left):
    write_references(book)
    if not figures:
        return
    entries = list(figures.values())
    integrators = sorted({integrator for entry in entries for integrator in entry["cached"]})
    text = TOP.format(integrators=", ".join(f"`--integrator {i}`" for i in integrators),
                      load=spread([entry["load"] for entry in entries]),
                      threads=spread([entry["threads"] for entry in entries]),
                      runs=spread([entry["runs"] for entry in entries]),
                      path_spp=" and ".join(sorted({s for e in entries for s in e.get("path_spp", "").split(",") if s},
                                                   key=int)))
    text += "| | scene | integrator | triangles | records | s | relMSE | bias | path: s | × |\n"
    text += "| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
    for name in sorted(figures):
        for k, integrator in enumerate(sorted(figures[name]["cached"])):
            text += row(name, figures[name], integrator, k == 0)
    if left:
        text += "\nNot shown:\n\n" + "".join(f"- {line}\n" for line in left)
    with open(os.path.join(DOCS, "gallery.md"), "w", encoding="utf-8") as file:
        file.write(text)
