#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Folds the measured spectra of the Cornell box to linear sRGB and prints the values of scenes/cornell-box.xml.

Data: Cornell University Program of Computer Graphics, "Cornell Box Data"
(graphics.cornell.edu/online/box/data.html): reflectances of the three paints at 400, 404 ... 700 nm, and the lamp's
emission at four wavelengths, linear in between.

Observer: CIE 1931, 2 degrees, in the analytic fit of Wyman, Sloan and Shirley, "Simple Analytic Approximations to the
CIE XYZ Color Matching Functions", JCGT 2(2), 2013, eq. (4).

White balance: an equal-energy spectrum is RGB (1, 1, 1), by one factor a channel.

Emission: the balanced RGB of the lamp, scaled so that its luminance is that of the spectrum, where an equal-energy
spectrum of 1 has luminance 1.

Reflectance: for each channel, the light of the lamp that the paint reflects over the light of the lamp. The first
bounce in RGB is then what a spectral renderer shows; only later bounces are approximate. The factors of the white
balance cancel. A channel below zero (a colour outside of the sRGB gamut) would be set to zero; with these paints there
is none.

The lamp's own diffuse reflectance is published as 0.78 at all wavelengths.
"""

import math

FIRST, STEP, LAST = 400, 4, 700  # nm

PAINTS = {
    "white": """
        .343 .445 .551 .624 .665 .687 .708 .723 .715 .710 .745 .758 .739 .767 .777 .765 .751 .745 .748
        .729 .745 .757 .753 .750 .746 .747 .735 .732 .739 .734 .725 .721 .733 .725 .732 .743 .744 .748
        .728 .716 .733 .726 .713 .740 .754 .764 .752 .736 .734 .741 .740 .732 .745 .755 .751 .744 .731
        .733 .744 .731 .712 .708 .729 .730 .727 .707 .703 .729 .750 .760 .751 .739 .724 .730 .740 .737""",
    "green": """
        .092 .096 .098 .097 .098 .095 .095 .097 .095 .094 .097 .098 .096 .101 .103 .104 .107 .109 .112
        .115 .125 .140 .160 .187 .229 .285 .343 .390 .435 .464 .472 .476 .481 .462 .447 .441 .426 .406
        .373 .347 .337 .314 .285 .277 .266 .250 .230 .207 .186 .171 .160 .148 .141 .136 .130 .126 .123
        .121 .122 .119 .114 .115 .117 .117 .118 .120 .122 .128 .132 .139 .144 .146 .150 .152 .157 .159""",
    "red": """
        .040 .046 .048 .053 .049 .050 .053 .055 .057 .056 .059 .057 .061 .061 .060 .062 .062 .062 .061
        .062 .060 .059 .057 .058 .058 .058 .056 .055 .056 .059 .057 .055 .059 .059 .058 .059 .061 .061
        .063 .063 .067 .068 .072 .080 .090 .099 .124 .154 .192 .255 .287 .349 .402 .443 .487 .513 .558
        .584 .620 .606 .609 .651 .612 .610 .650 .638 .627 .620 .630 .628 .642 .639 .657 .639 .635 .642""",
}
LAMP = ((400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4))

# Lobes of the observer: factor, centre in nm, 1 / width below the centre, 1 / width above it.
OBSERVER = (
    ((0.362, 442.0, 0.0624, 0.0374), (1.056, 599.8, 0.0264, 0.0323), (-0.065, 501.1, 0.0490, 0.0382)),
    ((0.821, 568.8, 0.0213, 0.0247), (0.286, 530.9, 0.0613, 0.0322)),
    ((1.217, 437.0, 0.0845, 0.0278), (0.681, 459.0, 0.0385, 0.0725)),
)
# IEC 61966-2-1: XYZ to linear sRGB.
SRGB = ((3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570))
LUMINANCE = (0.2126, 0.7152, 0.0722)


def observer(nm):
    """CIE 1931 x, y, z at a wavelength."""
    return [sum(k * math.exp(-0.5 * ((nm - centre) * (below if nm < centre else above)) ** 2)
                for k, centre, below, above in lobes) for lobes in OBSERVER]


def piecewise(points, x):
    """Linear between the points, which span x."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    raise ValueError(x)


def paint(name):
    values = [float(v) for v in PAINTS[name].split()]
    assert len(values) == (LAST - FIRST) // STEP + 1
    points = [(FIRST + STEP * i, v) for i, v in enumerate(values)]
    return lambda nm: piecewise(points, nm)


def lamp(nm):
    return piecewise(LAMP, nm)


def xyz(spectrum):
    """Tristimulus values; an equal-energy spectrum of 1 has Y = 1. The range of the data ends where the eye's nearly
    does: 0.3 % of X, 0.1 % of Y and 0.5 % of Z lie outside of it. Trapezoids of 1 nm."""
    total, norm = [0.0, 0.0, 0.0], 0.0
    for nm in range(FIRST, LAST + 1):
        weight = 0.5 if nm in (FIRST, LAST) else 1.0
        bars = observer(nm)
        norm += weight * bars[1]
        value = spectrum(nm)
        for i in range(3):
            total[i] += weight * value * bars[i]
    return [t / norm for t in total]


def rgb(spectrum):
    """Linear sRGB, not balanced."""
    v = xyz(spectrum)
    return [sum(m * c for m, c in zip(row, v)) for row in SRGB]


def emission():
    """The lamp's radiance: balanced, at the luminance of the spectrum."""
    white = rgb(lambda nm: 1.0)
    balanced = [c / w for c, w in zip(rgb(lamp), white)]
    scale = xyz(lamp)[1] / sum(k * c for k, c in zip(LUMINANCE, balanced))
    return [scale * c for c in balanced]


def reflectance(name):
    """Reflected over incident light of the lamp in each channel."""
    spectrum = paint(name)
    reflected = rgb(lambda nm: spectrum(nm) * lamp(nm))
    return [max(0.0, r / i) for r, i in zip(reflected, rgb(lamp))]


def equal_energy_reflectance(name):
    """The same under an equal-energy light, for comparison."""
    return [r / i for r, i in zip(rgb(paint(name)), rgb(lambda nm: 1.0))]


def text(values, digits=4):
    return " ".join(f"{v:.{digits}f}" for v in values)


def main():
    print("lamp  emission     ", text(emission(), 3), " luminance", f"{xyz(lamp)[1]:.3f}")
    for name in PAINTS:
        print(f"{name:5s} reflectance  ", text(reflectance(name)),
              " (under equal energy", text(equal_energy_reflectance(name)) + ")")


if __name__ == "__main__":
    main()
