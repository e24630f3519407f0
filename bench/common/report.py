# SPDX-License-Identifier: Apache-2.0
"""Prints a table on stdout and writes the same as CSV below build/bench."""

import csv
import os

from running import folder


def text(value):
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    if isinstance(value, int):
        return f"{value:,}"
    return str(value)


def percent(value):
    """A share as text, or None."""
    return None if value is None else f"{100 * value:.2f} %"


def table(title, rows, name):
    """rows: dicts with the same keys in the same order; the keys are the headings. name: of the CSV file."""
    headings = list(rows[0])
    cells = [headings] + [[text(row[h]) for h in headings] for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(len(headings))]
    print(title)
    for k, line in enumerate(cells):
        print("  " + "  ".join(c.ljust(w) if i == 0 else c.rjust(w) for i, (c, w) in enumerate(zip(line, widths))))
        if k == 0:
            print("  " + "  ".join("-" * w for w in widths))
    path = os.path.join(folder(), name + ".csv")
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(headings)
        writer.writerows([["" if row[h] is None else row[h] for h in headings] for row in rows])
    print(f"  ({os.path.relpath(path)})\n", flush=True)
