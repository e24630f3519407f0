# SPDX-License-Identifier: Apache-2.0
"""Triangle meshes for the scene generators: a few solids, their checks, and binary PLY.

A mesh is lists of positions, texture coordinates (or none) and triangles that run counter-clockwise seen from outside.
Vertices that share a position but not an index make a crease. Only the standard library is needed.
"""

import math
import struct
from array import array


class Mesh:
    def __init__(self):
        self.p, self.uv, self.t = [], [], []

    def add(self, other):
        """Appends another mesh; both have texture coordinates, or none has."""
        base = len(self.p)
        self.p += other.p
        self.uv += other.uv
        self.t += [(a + base, b + base, c + base) for a, b, c in other.t]
        return self

    def map(self, f):
        """Replaces each position (x, y, z) by f(x, y, z). Must not mirror."""
        self.p = [f(*p) for p in self.p]
        return self

    def move(self, dx, dy, dz):
        return self.map(lambda x, y, z: (x + dx, y + dy, z + dz))

    def turn(self, axis, degrees):
        """Rotates about a coordinate axis: 0, 1 or 2, counter-clockwise seen from its tip."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        i, j = (axis + 1) % 3, (axis + 2) % 3

        def rotate(*p):
            q = list(p)
            q[i], q[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
            return tuple(q)
        return self.map(rotate)

    def check_closed(self, name):
        """Every edge, with vertices welded by position, has its twin, and the volume is positive."""
        ids, weld = {}, []
        for p in self.p:
            weld.append(ids.setdefault(rounded(p), len(ids)))
        open_edges, volume = {}, 0.0
        for t in self.t:
            a, b, c = (weld[i] for i in t)
            if len({a, b, c}) < 3:
                raise ValueError(f"{name}: a triangle without area")
            for edge in ((a, b), (b, c), (c, a)):
                twin = (edge[1], edge[0])
                if open_edges.get(twin, 0):
                    open_edges[twin] -= 1
                else:
                    open_edges[edge] = open_edges.get(edge, 0) + 1
            pa, pb, pc = (self.p[i] for i in t)
            volume += dot(pa, cross(pb, pc)) / 6
        if any(open_edges.values()):
            raise ValueError(f"{name}: {sum(open_edges.values())} open edges")
        if volume <= 0:
            raise ValueError(f"{name}: inside out")
        return self

    def normals(self):
        """Vertex normals: face normals weighted by area, over the triangles that share the index."""
        total = [[0.0, 0.0, 0.0] for _ in self.p]
        for t in self.t:
            a, b, c = (self.p[i] for i in t)
            n = cross(minus(b, a), minus(c, a))
            for i in t:
                for k in range(3):
                    total[i][k] += n[k]
        return [unit(n) for n in total]

    def write_ply(self, path, smooth):
        """Little-endian binary PLY; normals when smooth, texture coordinates when the mesh has them."""
        columns = [[rounded(p) for p in self.p]]
        names = ["x", "y", "z"]
        if smooth:
            columns.append([rounded(n, 4) for n in self.normals()])
            names += ["nx", "ny", "nz"]
        if self.uv:
            columns.append(self.uv)
            names += ["u", "v"]
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(self.p)}"]
        header += [f"property float {name}" for name in names]
        header += [f"element face {len(self.t)}", "property list uchar int vertex_indices", "end_header", ""]
        vertices = array("f", (c for row in zip(*columns) for part in row for c in part))
        if struct.pack("=H", 1) != struct.pack("<H", 1):
            vertices.byteswap()
        with open(path, "wb") as file:
            file.write("\n".join(header).encode("ascii"))
            file.write(vertices.tobytes())
            file.write(b"".join(struct.pack("<Biii", 3, *t) for t in self.t))


def rounded(v, digits=5):
    """To 10 micrometres: the files do not depend on the last bits of a platform's sine."""
    return tuple(round(c, digits) + 0.0 for c in v)


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(v):
    length = math.sqrt(dot(v, v))
    return (v[0] / length, v[1] / length, v[2] / length)


def quads(rows, wrap=False):
    """Triangles between rows of vertex indices. Rows of one vertex are poles. With wrap, rows are rings.
    The front side is that of (along the row) x (to the next row)."""
    triangles = []
    for low, high in zip(rows, rows[1:]):
        n = max(len(low), len(high))
        for i in range(n if wrap else n - 1):
            j = (i + 1) % n
            a, b = low[i % len(low)], low[j % len(low)]
            c, d = high[j % len(high)], high[i % len(high)]
            if a != b:
                triangles.append((a, b, c))
            if c != d:
                triangles.append((a, c, d))
    return triangles


def sheet(nu, nv, f, uv=False):
    """The image of the unit square, cut nu x nv: f(u, v) -> (x, y, z). v = 1 is the top of a picture on it; in a PLY
    file of Mitsuba that is texture coordinate 0."""
    mesh = Mesh()
    rows = []
    for j in range(nv + 1):
        rows.append(range(len(mesh.p), len(mesh.p) + nu + 1))
        for i in range(nu + 1):
            mesh.p.append(f(i / nu, j / nv))
            if uv:
                mesh.uv.append((i / nu, 1 - j / nv))
    mesh.t = quads(rows)
    return mesh


def lathe(runs, n=32):
    """Turns a profile about the y axis. runs: lists of (radius, y), smooth inside, with a crease between one and the
    next, which begins where the last ended. Seen with y up and the axis at the left, the solid lies to the left of the
    way: a closed solid begins on the axis below and ends on it above. Radius 0 is a pole."""
    mesh = Mesh()
    for run in runs:
        rows = []
        for r, y in run:
            count = n if r > 0 else 1
            rows.append(range(len(mesh.p), len(mesh.p) + count))
            for i in range(count):
                a = 2 * math.pi * i / n
                mesh.p.append((r * math.cos(a), y, -r * math.sin(a)))
        mesh.t += quads(rows, wrap=True)
    return mesh


def tube(path, radius, n=12):
    """A round rod along points, with half-sphere ends. radius: a number or a function of the share of the way."""
    thickness = radius if callable(radius) else lambda s: radius
    tangents = []
    for i in range(len(path)):
        tangents.append(unit(minus(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)])))
    side = unit(cross(tangents[0], (0.3, 0.2, 0.93) if abs(tangents[0][2]) < 0.8 else (0.93, 0.2, 0.3)))
    rings = []  # centre, tangent, radius
    for k in range(4, 0, -1):
        a = math.pi / 2 * k / 4
        rings.append((0, -math.sin(a) * thickness(0), math.cos(a) * thickness(0)))
    rings += [(i, 0.0, thickness(i / (len(path) - 1))) for i in range(len(path))]
    for k in range(1, 5):
        a = math.pi / 2 * k / 4
        rings.append((len(path) - 1, math.sin(a) * thickness(1), math.cos(a) * thickness(1)))
    mesh = Mesh()
    rows = []
    for k, (i, along, r) in enumerate(rings):
        t = tangents[i]
        side = unit(minus(side, tuple(dot(side, t) * c for c in t)))  # carried along without twist
        other = cross(t, side)
        pole = k in (0, len(rings) - 1)
        rows.append(range(len(mesh.p), len(mesh.p) + (1 if pole else n)))
        for m in range(1 if pole else n):
            a = 2 * math.pi * m / n
            c, s = (0, 0) if pole else (r * math.cos(a), r * math.sin(a))
            mesh.p.append(tuple(path[i][d] + along * t[d] + c * side[d] + s * other[d] for d in range(3)))
    mesh.t = quads(rows, wrap=True)
    return mesh


def box(x0, y0, z0, x1, y1, z1):
    """Eight shared vertices: for flat shading."""
    mesh = Mesh()
    mesh.p = [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        mesh.t += [(a, b, c), (a, c, d)]
    return mesh


def stations(half, r, arc, flat):
    """Cuts of one side of a rounded box: even angles on the rounding, even steps between."""
    ends = [half - r + r * math.tan(math.pi / 4 * k / arc) for k in range(arc + 1)]
    middle = [(half - r) * (2 * k / flat - 1) for k in range(1, flat)]
    return [-e for e in reversed(ends)] + middle + ends


def rounded_box(sx, sy, sz, r, arc=3, flat=(1, 1, 1)):
    """A box about the origin with edges of radius r, without creases. flat: cuts of the flat part along each axis, to
    bend it."""
    half = (sx / 2, sy / 2, sz / 2)
    cuts = [stations(h, r, arc, f) for h, f in zip(half, flat)]
    mesh, ids = Mesh(), {}

    def vertex(q):
        key = rounded(q, 7)
        if key not in ids:
            core = [max(-(h - r), min(h - r, c)) for c, h in zip(q, half)]
            d = unit(minus(q, core))
            ids[key] = len(mesh.p)
            mesh.p.append(tuple(c + r * e for c, e in zip(core, d)))
        return ids[key]

    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for sign in (-1, 1):
            rows = []
            for b in cuts[j]:
                row = []
                for a in cuts[i][::sign]:
                    q = [0.0, 0.0, 0.0]
                    q[axis], q[i], q[j] = sign * half[axis], a, b
                    row.append(vertex(q))
                rows.append(row)
            mesh.t += quads(rows)
    return mesh


def pillow(w, h, thickness, n=24):
    """A stuffed square in the xy plane about the origin: thick in the middle, thin at the seam, corners drawn out."""
    mesh = Mesh()
    ids = {}
    for side in (1, -1):
        rows = []
        for j in range(n + 1):
            row = []
            for i in range(n + 1):
                # Denser towards the seam, where the surface turns.
                s, t = (math.sin(math.pi / 2 * (2 * k / n - 1)) for k in (i, j))
                key = (i, j) if i in (0, n) or j in (0, n) else (i, j, side)
                if key not in ids:
                    ids[key] = len(mesh.p)
                    puff = math.sqrt(max(0.0, (1 - s * s) * (1 - t * t))) ** 0.9
                    x = s * (1 - 0.08 * (1 - t * t) * abs(s) ** 3)
                    y = t * (1 - 0.08 * (1 - s * s) * abs(t) ** 3)
                    mesh.p.append((x * w / 2, y * h / 2, side * thickness / 2 * puff))
                row.append(ids[key])
            rows.append(row[::side])
        mesh.t += quads(rows)
    return mesh


def ring(profile, u0, v0, u1, v1):
    """Sweeps a closed polygon around the rectangle (u0, v0)-(u1, v1) with mitred corners. The polygon is a list of
    (d, z): d outward from the rectangle's edge in its plane, z across it, counter-clockwise with d to the right and z
    up. The rectangle lies in the xy plane, x = u, y = v. For flat shading."""
    mesh = Mesh()
    corners = ((u0, v0, -1, -1), (u1, v0, 1, -1), (u1, v1, 1, 1), (u0, v1, -1, 1))
    rows = []
    for d, z in profile:
        rows.append(range(len(mesh.p), len(mesh.p) + 4))
        mesh.p += [(u + su * d, v + sv * d, z) for u, v, su, sv in corners]
    mesh.t = [t for t in quads(rows + [rows[0]], wrap=True)]
    return mesh


def prism(polygon, y0, y1):
    """Extrudes a convex polygon of (x, z), counter-clockwise seen from above, from y0 to y1. For flat shading."""
    mesh = Mesh()
    n = len(polygon)
    mesh.p = [(x, y, z) for y in (y0, y1) for x, z in polygon]
    mesh.t = quads([range(n), range(n, 2 * n)], wrap=True)
    for i in range(1, n - 1):
        mesh.t += [(0, i + 1, i), (n, n + i, n + i + 1)]
    return mesh
