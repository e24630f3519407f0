# SPDX-License-Identifier: Apache-2.0
"""Errors of pictures against a reference of two independent halves, and how path tracing would do at the same error."""

from dataclasses import dataclass

import pictures
from pictures import np

PATCH = 20  # pixels of the patches whose scatter tells how well a mean error is known


def short(x, digits=3):
    return float(f"{x:.{digits}g}")


def halved(picture):
    """Each pixel the mean of four."""
    rows, columns, _ = picture.shape
    return picture.reshape(rows // 2, 2, columns // 2, 2, 3).mean(axis=(1, 3))


def error_of_mean(values):
    """Of values by pixel and channel, in which neighbors may err together: from the means of patches."""
    rows, columns = (n // PATCH for n in values.shape[:2])
    patches = values[:rows * PATCH, :columns * PATCH].reshape(rows, PATCH, columns, PATCH, 3).mean(axis=(1, 3, 4))
    return float(patches.std(ddof=1) / np.sqrt(patches.size))


@dataclass
class Reference:
    first: "np.ndarray"
    second: "np.ndarray"

    def __post_init__(self):
        self.mean = (self.first + self.second) / 2
        self.noise = pictures.noise_of_mean(self.first, self.second)
        error = ((self.first - self.second) / 2).sum(axis=2)
        self.mean_error = float(np.sqrt((error ** 2).sum()) / self.mean.sum())  # of the whole picture, relative

    def relmse(self, picture):
        """relMSE without the reference's noise, by pixel and channel: each half errs on its own, so that the product
        of the differences is in the mean the square of the difference from the truth."""
        return (picture - self.first) * (picture - self.second) / (self.mean ** 2 + 0.01)


def cached(runs, reference):
    """Figures of runs of different seeds: (run, picture) each."""
    errors = np.mean([reference.relmse(picture) for _, picture in runs], axis=0)
    biases = [pictures.bias(picture, reference.mean) for _, picture in runs]
    scatter = np.std(biases, ddof=1) / np.sqrt(len(runs)) if len(runs) > 1 else 0.0
    return {"wall": short(min(run.seconds("total") for run, _ in runs)), "user": short(min(r.user for r, _ in runs)),
            "records": runs[0][0].records, "relmse": short(errors.mean()),
            "relmse_error": short(error_of_mean(errors), 2), "bias": short(np.mean(biases)),
            "bias_error": short(np.hypot(scatter, reference.mean_error), 2)}


def line(points):
    """Start and slope of a straight line; through 0 where none with a start is to be had: with one point, or where a
    busy machine disturbed the runs."""
    x, y = max(points)
    rate, start = np.polyfit(*np.array(points, float).T, 1) if len(points) > 1 else (0.0, 0.0)
    if not (rate > 0 and start >= 0):
        return [0.0, short(y / x, 4)]
    return [short(start), short(rate, 4)]


def path(runs, reference):
    """What path tracing costs: runs are (samples, run, picture). `one` is the error of one sample a pixel, from all
    runs, each weighed by its samples."""
    errors = [(spp, float(reference.relmse(picture).mean())) for spp, _, picture in runs]
    one = sum(spp * spp * error for spp, error in errors) / sum(spp for spp, _ in errors)
    return {"one": short(one), "wall": line([(spp, run.seconds("total")) for spp, run, _ in runs]),
            "user": line([(spp, run.user) for spp, run, _ in runs])}


def beside(found, traced):
    """Seconds that path tracing needs for the error of the cached picture, and the ratio; of wall clock and processor.
    Where the error is not known from 0, the seconds are a lower bound, at the largest error that it may have."""
    error = found["relmse"]
    known = error > 2 * found["relmse_error"]
    if not known:
        error = max(error, 0.0) + 2 * found["relmse_error"]
    spp = traced["one"] / max(error, 1e-12)
    wall, user = (start + rate * spp for start, rate in (traced["wall"], traced["user"]))
    return {"known": known, "path_spp": short(spp), "path_wall": short(wall), "path_user": short(user),
            "ratio_wall": short(wall / found["wall"]), "ratio_user": short(user / found["user"])}
