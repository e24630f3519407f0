#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scenes/interior.xml, its meshes (binary PLY) and its textures (PNG): a living room by daylight.

The room is a closed solid with two openings: its inner and outer faces share their edges, so that no light leaks.
What stands on something sinks into it a little, so that no two faces coincide. Every solid is checked to be closed.
"""

import os
import sys

import interior_pieces as pieces
import interior_textures as textures
from scene_mesh import Mesh, box, ring, rounded_box, unit

WIDTH, HEIGHT, DEPTH, WALL = 5.4, 2.7, 4.8, 0.25  # x, y, z of the room; thickness of its walls
WINDOW_Y, WINDOW_Z = (0.85, 2.35), (1.0, 3.0)     # in the wall x = 0
SKYLIGHT_X, SKYLIGHT_Z = (3.55, 4.4), (3.0, 3.85)  # in the ceiling
SKY, SUN, BULB = (4.4, 5.1, 6.0), (17, 14.6, 11.2), (105, 70, 37)
SUN_WAY, SUN_DISTANCE = (-0.36, -0.8, -0.49), 40.0
MIRROR = (2.08, 1.75, 0)
BULB_PLACE, BULB_RADIUS = (4.98, 1.5, 0.42), 0.035

COLOURS = {
    "walls": (0.76, 0.72, 0.65), "accent": (0.36, 0.46, 0.43), "ceiling": (0.84, 0.83, 0.80),
    "shell": (0.5, 0.5, 0.5), "trim": (0.82, 0.80, 0.76), "white-wood": (0.78, 0.75, 0.70), "oak": (0.46, 0.31, 0.18),
    "dark-wood": (0.13, 0.075, 0.045), "brass": (0.50, 0.36, 0.15), "shade": (0.80, 0.72, 0.58),
    "sofa": (0.20, 0.29, 0.38), "rust": (0.50, 0.17, 0.08), "navy": (0.05, 0.09, 0.18), "cream": (0.74, 0.66, 0.52),
    "moss": (0.16, 0.22, 0.09), "ochre": (0.62, 0.36, 0.08), "linen": (0.74, 0.68, 0.58), "leaf": (0.10, 0.24, 0.06),
    "stem": (0.16, 0.22, 0.08), "terracotta": (0.52, 0.24, 0.14), "apple": (0.50, 0.05, 0.04),
}


class Room:
    """Collects meshes by material and kind of shading."""

    def __init__(self):
        self.smooth, self.flat = {}, {}

    def add(self, parts, flat=False, material=None):
        if material:
            parts = {material: parts}
        for name, mesh in parts.items():
            (self.flat if flat else self.smooth).setdefault(name, Mesh()).add(mesh)


def place(parts, turn, x, y, z):
    """Turns a piece, or each of its parts, about y and moves it."""
    for mesh in parts.values() if isinstance(parts, dict) else (parts,):
        mesh.turn(1, turn).move(x, y, z)
    return parts


def quad(a, b, c, d):
    mesh = Mesh()
    mesh.p, mesh.t = [a, b, c, d], [(0, 1, 2), (0, 2, 3)]
    return mesh


def collar(outer, inner):
    """The quadrilateral `outer` less `inner`: corner joins to corner, so that edges meet whole."""
    mesh = Mesh()
    for i in range(4):
        j = (i + 1) % 4
        mesh.add(quad(outer[i], outer[j], inner[j], inner[i]))
    return mesh


def tunnel(a, b):
    """Joins the quadrilateral a, counter-clockwise seen from the room, to b behind it; the front side is inside."""
    mesh = Mesh()
    for i in range(4):
        j = (i + 1) % 4
        mesh.add(quad(a[i], a[j], b[j], b[i]))
    return mesh


def faces(x0, y0, z0, x1, y1, z1):
    """The six faces of a box by name, counter-clockwise seen from inside."""
    return {
        "floor": ((x0, y0, z1), (x1, y0, z1), (x1, y0, z0), (x0, y0, z0)),
        "ceiling": ((x0, y1, z0), (x1, y1, z0), (x1, y1, z1), (x0, y1, z1)),
        "left": ((x0, y0, z1), (x0, y0, z0), (x0, y1, z0), (x0, y1, z1)),
        "right": ((x1, y0, z0), (x1, y0, z1), (x1, y1, z1), (x1, y1, z0)),
        "back": ((x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)),
        "front": ((x1, y0, z1), (x0, y0, z1), (x0, y1, z1), (x1, y1, z1)),
    }


def build_walls(room):
    """Inner faces, outer faces and the sides of the two openings, one closed solid together."""
    inside = faces(0, 0, 0, WIDTH, HEIGHT, DEPTH)
    outside = faces(-WALL, -WALL, -WALL, WIDTH + WALL, HEIGHT + WALL, DEPTH + WALL)
    (y0, y1), (z0, z1) = WINDOW_Y, WINDOW_Z
    window = [((x, y0, z1), (x, y0, z0), (x, y1, z0), (x, y1, z1)) for x in (0, -WALL)]
    (x0, x1), (z0, z1) = SKYLIGHT_X, SKYLIGHT_Z
    skylight = [((x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)) for y in (HEIGHT, HEIGHT + WALL)]
    holes = {"left": window, "ceiling": skylight}

    material = {"back": "accent", "ceiling": "ceiling"}
    whole = Mesh()
    for name, corners in inside.items():
        if name == "floor":
            whole.add(quad(*corners))
            continue
        wall = quad(*corners)
        if name in holes:
            wall = collar(corners, holes[name][0]).add(tunnel(*holes[name]))
        room.add(wall, True, material.get(name, "walls"))
        whole.add(wall)
    for name, corners in outside.items():
        shell = quad(*corners[::-1])
        if name in holes:
            shell = collar(corners[::-1], holes[name][1][::-1])
        room.add(shell, True, "shell")
        whole.add(shell)
    whole.check_closed("walls")


def floor():
    mesh = quad(*faces(0, 0, 0, WIDTH, HEIGHT, DEPTH)["floor"])
    mesh.uv = [(z / 2.4 + 0.1, x / 1.12) for x, _, z in mesh.p]
    return mesh


def build_trim(room):
    """Skirting, cornice, window frame and sill, curtains."""
    skirting = [(0, -0.002), (0.02, -0.002), (0.02, 0.09), (0.012, 0.09), (0.004, 0.082), (0, 0.07)]
    cornice = [(0, -0.03), (0.012, -0.045), (0.03, -0.07), (0.052, -0.07), (0.052, 0.002), (0, 0.002)]
    for profile, inset, y in ((skirting, 0.018, 0), (cornice, 0.05, HEIGHT)):
        run = ring(profile, inset, -DEPTH + inset, WIDTH - inset, -inset).check_closed("skirting")
        room.add(run.map(lambda u, v, w, y=y: (u, y + w, -v)), True, "trim")

    bar, thick = 0.055, 0.05
    (y0, y1), (z0, z1) = WINDOW_Y, WINDOW_Z
    inset = bar - pieces.SINK
    profile = [(0, 0.008), (0.012, 0), (bar, 0), (bar, thick), (0.012, thick), (0, thick - 0.008)]
    frame = ring(profile, -z1 + inset, y0 + inset, -z0 - inset, y1 - inset).check_closed("window")
    room.add(frame.map(lambda u, v, w: (w - 0.16, v, -u)), True, "trim")
    middle = (z0 + z1) / 2
    for z in (middle - 0.5, middle, middle + 0.5):
        half = 0.024 if z == middle else 0.014
        room.add(box(-0.15, y0 + 0.04, z - half, -0.122, y1 - 0.04, z + half), True, "trim")
    room.add(box(-0.146, 1.8, z0 + 0.04, -0.126, 1.828, z1 - 0.04), True, "trim")
    room.add(box(-0.07, y0 - 0.025, z0 - 0.08, 0.05, y0 + 0.004, z1 + 0.08), True, "trim")

    room.add(pieces.curtain(2.44, 0.56, 6, 1).move(0.115, 0.035, 0.46), material="linen")
    room.add(pieces.curtain(2.44, 0.56, 6, 2).move(0.115, 0.035, 2.98), material="linen")
    room.add(place(pieces.curtain_pole(3.3, 0.012), 0, 0.115, 2.49, 0.35), material="brass")
    for z in (0.42, 3.58):
        room.add(rounded_box(0.14, 0.02, 0.02, 0.006, 2).move(0.06, 2.49, z), material="brass")


def build_furniture(room):
    room.add(place(pieces.sofa(), 0, 3.45, 0, 0.06))
    room.add(place(pieces.throw_pillows(), 0, 3.45, 0, 0.06))
    room.add(place(pieces.coffee_table(), 20, 3.4, 0.01, 1.82), material="oak")
    room.add(place(pieces.cup(), 140, 3.25, 0.391, 1.95), material="white-wood")
    for i, colour in enumerate(("navy", "rust", "cream")):
        tome = pieces.book(0.028, 0.27 - 0.02 * i, 0.19 - 0.015 * i).turn(2, 90).move(0.13, 0, 0)
        place(tome, 65 - 9 * i, 3.52, 0.403 + 0.0285 * i, 1.72)
        room.add(tome, True, colour)

    room.add(place(pieces.table(0.92, 1.6, 0.75), 0, 1.28, 0, 2.0), material="oak")
    for x, z, turn in ((0.62, 1.6, 90), (0.6, 2.38, 84), (2.02, 1.64, -96), (2.16, 2.45, -72)):
        room.add(place(pieces.chair(), turn, x, 0, z), material="white-wood")
    room.add(place(pieces.fruit_bowl(), 30, 1.2, 0.75, 1.66))
    room.add(place(pieces.twigs(4), 0, 1.42, 0.7506, 2.36))
    room.add(place(pieces.plant(11), 40, 2.04, 0, 0.42))
    room.add(place(pieces.floor_lamp(BULB_PLACE[1]), 15, BULB_PLACE[0], 0, BULB_PLACE[2]))

    shelf = place(pieces.bookshelf(1.3, 2.05, 0.3, 5), 0, 0.95, 0, 0)
    room.add(shelf, True)
    board = place(pieces.sideboard(1.5, 0.72, 0.42), 180, 1.0, 0, DEPTH)
    room.add({"oak": board.pop("oak")}, True)
    room.add(board)
    room.add(place(pieces.frame(1.3, 0.78, 0.05, 0.03), 0, 3.58, 1.62, 0), True, "dark-wood")
    room.add(place(pieces.frame(0.5, 1.0, 0.035, 0.025), 0, *MIRROR), True, "brass")


def mesh_shape(name, material, flat):
    normals = '\n        <boolean name="face_normals" value="true"/>' if flat else ""
    return f"""\
    <shape type="ply" id="{name}-mesh">
        <string name="filename" value="interior/{name}.ply"/>{normals}
        <ref id="{material}"/>
    </shape>"""


def diffuse(name, reflectance):
    return f"""\
    <bsdf type="twosided" id="{name}">
        <bsdf type="diffuse">
            {reflectance}
        </bsdf>
    </bsdf>"""


def spaced(values, digits=6):
    return " ".join(f"{v:.{digits}g}" for v in values)


def commas(values):
    return ", ".join(f"{v:.6g}" for v in values)


def xml(shapes):
    colours = [diffuse(n, f'<rgb name="reflectance" value="{spaced(c)}"/>') for n, c in COLOURS.items()]
    colours += [diffuse(n, f"""<texture type="bitmap" name="reflectance">
                <string name="filename" value="interior/{n}.png"/>
            </texture>""") for n in ("planks", "rug", "painting")]
    (y0, y1), (z0, z1) = WINDOW_Y, WINDOW_Z
    halves = f'x="{(z1 - z0) / 2 + 0.002:.6g}" y="{(y1 - y0) / 2 + 0.002:.6g}"'
    skylight = (sum(SKYLIGHT_X) / 2, HEIGHT, sum(SKYLIGHT_Z) / 2)
    sun = [c - SUN_DISTANCE * d for c, d in zip(skylight, unit(SUN_WAY))]
    newline = "\n"
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!--
    A living room by daylight. Written by python/make_interior.py, which also says how it is built.

    Light: the sky is a rectangle that fills the outer end of the window, as bright as an overcast sky would be behind
    it; the sun comes through a skylight above the camera; a bulb burns in the floor lamp's shade. The sun is a spot
    light {SUN_DISTANCE:.0f} m away that covers the skylight: a light that the roof hides from all else of the room would be tried in
    vain everywhere.
-->
<scene version="3.0.0">
    <integrator type="path"/>

    <sensor type="perspective" id="room">
        <transform name="to_world">
            <lookat origin="4.35, 1.48, 4.66" target="2.72, 0.97, 1.0" up="0, 1, 0"/>
        </transform>
        <float name="fov" value="68"/>
        <string name="fov_axis" value="x"/>
        <sampler type="independent">
            <integer name="sample_count" value="256"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="1280"/>
            <integer name="height" value="720"/>
            <rfilter type="box"/>
        </film>
    </sensor>

{newline.join(colours)}
    <bsdf type="twosided" id="mirror">
        <bsdf type="conductor">
            <string name="material" value="none"/>
            <rgb name="specular_reflectance" value="0.92 0.93 0.92"/>
        </bsdf>
    </bsdf>
    <bsdf type="dielectric" id="glass">
        <float name="int_ior" value="1.5"/>
        <float name="ext_ior" value="1"/>
    </bsdf>

{newline.join(shapes)}
    <shape type="rectangle" id="mirror-pane">
        <transform name="to_world">
            <scale x="0.256" y="0.506"/>
            <translate x="{MIRROR[0]}" y="{MIRROR[1]}" z="{MIRROR[2] + 0.004}"/>
        </transform>
        <ref id="mirror"/>
    </shape>

    <shape type="rectangle" id="sky">
        <transform name="to_world">
            <scale {halves}/>
            <rotate y="1" angle="90"/>
            <translate x="{0.005 - WALL:.6g}" y="{(y0 + y1) / 2:.6g}" z="{(z0 + z1) / 2:.6g}"/>
        </transform>
        <ref id="shell"/>
        <emitter type="area">
            <rgb name="radiance" value="{spaced(SKY)}"/>
        </emitter>
    </shape>
    <emitter type="spot" id="sun">
        <transform name="to_world">
            <lookat origin="{commas(sun)}" target="{commas(skylight)}" up="0, 0, 1"/>
        </transform>
        <rgb name="intensity" value="{spaced([SUN_DISTANCE ** 2 * c for c in SUN])}"/>
        <float name="cutoff_angle" value="1.2"/>
        <float name="beam_width" value="1.15"/>
    </emitter>
    <shape type="sphere" id="bulb">
        <point name="center" x="{BULB_PLACE[0]}" y="{BULB_PLACE[1]}" z="{BULB_PLACE[2]}"/>
        <float name="radius" value="{BULB_RADIUS}"/>
        <ref id="shade"/>
        <emitter type="area">
            <rgb name="radiance" value="{spaced(BULB)}"/>
        </emitter>
    </shape>
</scene>
"""


def main():
    scenes = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "..", "scenes")
    folder = os.path.join(scenes, "interior")
    os.makedirs(folder, exist_ok=True)
    room = Room()
    build_walls(room)
    build_trim(room)
    build_furniture(room)

    shapes, triangles = [], 0

    def save(name, mesh, material, flat):
        nonlocal triangles
        mesh.write_ply(os.path.join(folder, name + ".ply"), not flat)
        shapes.append(mesh_shape(name, material, flat))
        triangles += len(mesh.t)
    for name, mesh in room.flat.items():
        save(name if name not in room.smooth else name + "-flat", mesh, name, True)
    for name, mesh in room.smooth.items():
        save(name, mesh, name, False)
    save("floor", floor(), "planks", True)
    save("rug", place(pieces.rug(2.3, 1.6), 0, 3.5, 0, 1.86), "rug", False)
    save("painting", pieces.picture(1.33, 0.81).move(3.58, 1.62, 0.004), "painting", True)
    save("vase", pieces.vase().move(1.42, 0.7506 + 0.0006, 2.36), "glass", False)
    for name in ("planks", "rug", "painting"):
        getattr(textures, name)(os.path.join(folder, name + ".png"))
    with open(os.path.join(scenes, "interior.xml"), "w", encoding="utf-8") as file:
        file.write(xml(shapes))
    print(f"{triangles} triangles")


if __name__ == "__main__":
    main()
