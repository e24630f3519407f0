#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/cornell-box.xml and its meshes from the published measurements of the Cornell box.

Vertices are in millimetres as published (see cornell_spectra.py for the source), and written in metres. The walls are
not quite parallelograms and the red one is not quite planar, so they are meshes; the lamp is a rectangle.
"""

import math
import os
import sys

import cornell_spectra as spectra

# Each quadrilateral runs counter-clockwise as seen from the side that light falls on.
FLOOR = ((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2))
CEILING = ((556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0))
BACK = ((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2))
RIGHT = ((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2))
LEFT = ((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0))
LAMP_X, LAMP_Y, LAMP_Z = (213, 343), 548.0, (227, 332)
SHORT_TOP = ((130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114))
TALL_TOP = ((423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406))

EYE, TARGET = (278, 273, -800), (278, 273, 0)
FOCAL_LENGTH, FILM_WIDTH = 0.035, 0.025
LAMP_REFLECTANCE = 0.78


def block(top):
    """Top and four sides; the bottom stands on the floor and is left out."""
    return [top] + [((b[0], 0, b[2]), b, a, (a[0], 0, a[2])) for a, b in zip(top, top[1:] + top[:1])]


MESHES = {
    "room": ("white", [FLOOR, CEILING, BACK]),
    "left-wall": ("red", [LEFT]),
    "right-wall": ("green", [RIGHT]),
    "short-block": ("white", block(SHORT_TOP)),
    "tall-block": ("white", block(TALL_TOP)),
}


def obj(quads):
    """Vertices are not shared, so that no reader smooths the corners."""
    lines = ["# Written by python/make_cornell_box.py. Metres."]
    for quad in quads:
        lines += ["v " + " ".join(f"{c / 1000:.4f}" for c in p) for p in quad]
    lines += [f"f {i + 1} {i + 2} {i + 3} {i + 4}" for i in range(0, 4 * len(quads), 4)]
    return "\n".join(lines) + "\n"


def metres(p):
    return ", ".join(f"{c / 1000:.4g}" for c in p)


def shapes():
    return "\n".join(f"""\
    <shape type="obj" id="{name}">
        <string name="filename" value="cornell-box/{name}.obj"/>
        <boolean name="face_normals" value="true"/>
        <ref id="{paint}"/>
    </shape>""" for name, (paint, _) in MESHES.items())


def paints():
    return "\n".join(f"""\
    <bsdf type="diffuse" id="{name}">
        <rgb name="reflectance" value="{spectra.text(spectra.reflectance(name))}"/>
    </bsdf>""" for name in spectra.PAINTS)


def lamp_matrix():
    """The unit rectangle [-1, 1]^2 with normal +z, laid under the ceiling with its normal down."""
    sx, sz = ((b - a) / 2000 for a, b in (LAMP_X, LAMP_Z))
    cx, cz = ((a + b) / 2000 for a, b in (LAMP_X, LAMP_Z))
    return f"{sx:.6g} 0 0 {cx:.6g}  0 0 -1 {LAMP_Y / 1000:.6g}  0 {sz:.6g} 0 {cz:.6g}  0 0 0 1"


def xml():
    fov = math.degrees(2 * math.atan(FILM_WIDTH / 2 / FOCAL_LENGTH))
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!--
    The Cornell box from its measurements (Cornell University Program of Computer Graphics, "Cornell Box Data").
    Written by python/make_cornell_box.py.

    Geometry: the published vertices; 1 unit is 1 m here, 1 mm there. The lamp hangs 0.8 mm under the ceiling. The box
    is open toward the camera, which stands outside: light that leaves there is lost.

    Camera: focal length 0.035, film 0.025 wide: fov = 2 atan(0.025 / 2 / 0.035).

    Colours (python/cornell_spectra.py): the measured spectra under the CIE 1931 observer to linear sRGB, with an
    equal-energy spectrum as (1, 1, 1). The lamp's radiance keeps the luminance of its spectrum, {spectra.xyz(spectra.lamp)[1]:.2f}
    where an equal-energy spectrum of 1 has luminance 1. A reflectance is, for each channel, the lamp's light that the
    paint reflects over the lamp's light: the first bounce is what the spectra give, later bounces are approximate.
-->
<scene version="3.0.0">
    <integrator type="path"/>

    <sensor type="perspective" id="front">
        <transform name="to_world">
            <lookat origin="{metres(EYE)}" target="{metres(TARGET)}" up="0, 1, 0"/>
        </transform>
        <float name="fov" value="{fov:.4f}"/>
        <string name="fov_axis" value="x"/>
        <sampler type="independent">
            <integer name="sample_count" value="64"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="512"/>
            <integer name="height" value="512"/>
            <rfilter type="box"/>
        </film>
    </sensor>

{paints()}
    <bsdf type="diffuse" id="lamp-housing">
        <rgb name="reflectance" value="{LAMP_REFLECTANCE} {LAMP_REFLECTANCE} {LAMP_REFLECTANCE}"/>
    </bsdf>

{shapes()}
    <shape type="rectangle" id="lamp">
        <transform name="to_world">
            <matrix value="{lamp_matrix()}"/>
        </transform>
        <ref id="lamp-housing"/>
        <emitter type="area">
            <rgb name="radiance" value="{spectra.text(spectra.emission(), 3)}"/>
        </emitter>
    </shape>
</scene>
"""


def main():
    scenes = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "..", "scenes")
    folder = os.path.join(scenes, "cornell-box")
    os.makedirs(folder, exist_ok=True)
    for name, (_, quads) in MESHES.items():
        with open(os.path.join(folder, name + ".obj"), "w", encoding="ascii") as file:
            file.write(obj(quads))
    with open(os.path.join(scenes, "cornell-box.xml"), "w", encoding="utf-8") as file:
        file.write(xml())


if __name__ == "__main__":
    main()
