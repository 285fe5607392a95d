#!/usr/bin/env python3
"""Writes colonnade.json and its meshes: colonnade_column.obj, colonnade_entablature.obj, colonnade_urn.obj,
colonnade_statue.obj, colonnade_cypress.obj. And colonnade_night.json: the same place, lit by a stream of sparks, of which those in
colonnade_sparks.csv are seen, as colonnade_sparks.obj. Lengths in metres; the portico runs along -z, the court lies on its right (+x)."""
import json
import math
import random
from pathlib import Path

FOLDER = Path(__file__).parent

BAY = 3.4
BAYS = 16
FIRST = 1  # bays behind the camera
COLUMN_HEIGHT = 6.4
WALL_X = -3.6
COLUMN_X = 2.6


class Obj:
    """Vertices and faces with shared numbers, each distinct vertex written once."""

    def __init__(self):
        self.positions, self.normals, self.faces = {}, {}, []

    def add(self, corners):
        """A face of (position, normal) corners, counter-clockwise from outside."""
        indices = []
        for position, normal in corners:
            p = " ".join(f"{round(v, 3) + 0:g}" for v in position)
            n = " ".join(f"{round(v, 3) + 0:g}" for v in normal)
            i = self.positions.setdefault(p, len(self.positions) + 1)
            if i not in [index for index, _ in indices]:
                indices.append((i, self.normals.setdefault(n, len(self.normals) + 1)))
        if len(indices) > 2:
            self.faces.append(" ".join(f"{p}//{n}" for p, n in indices))

    def write(self, name):
        lines = [f"v {p}" for p in self.positions] + [f"vn {n}" for n in self.normals] + [f"f {f}" for f in self.faces]
        (FOLDER / name).write_text("\n".join(lines) + "\n")


def normalized(v):
    length = math.sqrt(sum(c * c for c in v)) or 1
    return tuple(c / length for c in v)


def turn(obj, profile, around):
    """A profile of (radius, height) points from the bottom up, turned around the y axis. A point given twice makes a sharp
    edge."""
    normals = smooth_normals(profile)
    for i in range(len(profile) - 1):
        (r0, y0), (r1, y1) = profile[i], profile[i + 1]
        if (r0, y0) == (r1, y1):
            continue
        for k in range(around):
            corners = []
            for step, j in ((k, i), (k + 1, i), (k + 1, i + 1), (k, i + 1)):
                a = -2 * math.pi * (step % around) / around
                (r, y), (nr, ny) = profile[j], normals[j]
                corners.append(((r * math.cos(a), y, r * math.sin(a)),
                                normalized((nr * math.cos(a), ny, nr * math.sin(a)))))
            obj.add(corners)


def smooth_normals(profile):
    """Normals (radial, up) at a profile's points, averaged over the two sides unless the point is doubled."""
    def side(i):
        dr, dy = profile[i + 1][0] - profile[i][0], profile[i + 1][1] - profile[i][1]
        return (dy, -dr)

    normals = []
    for i in range(len(profile)):
        sides = [side(j) for j in (i - 1, i) if 0 <= j < len(profile) - 1 and side(j) != (0, 0)]
        total = [sum(normalized(s)[c] for s in sides) for c in (0, 1)]
        normals.append(normalized(total))
    return normals


def arc(center, radius, start, end, steps):
    """Points on a circle in a profile, degrees from the outward direction."""
    points = []
    for i in range(steps + 1):
        a = math.radians(start + (end - start) * i / steps)
        points.append((center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)))
    return points


def slab(obj, low, high):
    """A box from corner to corner."""
    for axis in range(3):
        for sign in (-1, 1):
            normal = [0, 0, 0]
            normal[axis] = sign
            u, v = (axis + 1) % 3, (axis + 2) % 3
            order = [(0, 0), (1, 0), (1, 1), (0, 1)] if sign > 0 else [(0, 0), (0, 1), (1, 1), (1, 0)]
            corners = []
            for du, dv in order:
                p = [0, 0, 0]
                p[axis] = high[axis] if sign > 0 else low[axis]
                p[u] = high[u] if du else low[u]
                p[v] = high[v] if dv else low[v]
                corners.append((p, normal))
            obj.add(corners)


def column():
    """Attic base, shaft of 20 flutes with entasis, Roman Doric capital."""
    obj = Obj()
    slab(obj, (-0.62, 0, -0.62), (0.62, 0.16, 0.62))
    base = [(0.52, 0.16), *arc((0.52, 0.25), 0.09, -90, 90, 6), (0.5, 0.34), (0.5, 0.34), (0.5, 0.37), (0.5, 0.37),
            *[(0.46 + 0.035 * (2 * t - 1) ** 2, 0.37 + 0.07 * t) for t in (0, 0.25, 0.5, 0.75, 1)], (0.49, 0.44),
            (0.49, 0.46), (0.49, 0.46), *arc((0.47, 0.51), 0.05, -90, 90, 5), (0.46, 0.56), (0.46, 0.58), (0.46, 0.58),
            (0.42, 0.58)]
    turn(obj, base, 40)

    flutes, per_flute = 20, 5
    low, high = 0.58, COLUMN_HEIGHT - 0.62

    def radius(t):
        return 0.44 - 0.075 * t ** 1.7

    def depth(t):
        """Of the flutes, which end in a curve at both ends."""
        end = min(t, 1 - t) * (high - low) / 0.16
        return 0.045 * math.sqrt(1 - (1 - min(end, 1)) ** 2)

    rings = [0, 0.006, 0.016, 0.03, 0.2, 0.4, 0.6, 0.8, 0.97, 0.984, 0.994, 1]
    points = []
    for t in rings:
        ring = []
        for k in range(flutes * per_flute):
            s = (k % per_flute) / per_flute  # the first fifth is the fillet between two flutes
            across = max(0.0, (s - 0.2) / 0.8)
            r = radius(t) - depth(t) * math.sin(math.pi * across)
            a = -2 * math.pi * k / (flutes * per_flute)
            ring.append((r * math.cos(a), low + (high - low) * t, r * math.sin(a)))
        points.append(ring)
    count = flutes * per_flute
    for i in range(len(rings) - 1):
        for k in range(count):
            n = (k + 1) % count
            fillet = k % per_flute == 0
            corners = []
            for j, m in ((i, k), (i, n), (i + 1, n), (i + 1, k)):
                p = points[j][m]
                if fillet:
                    before, after = points[j][k], points[j][n]
                else:
                    before = points[j][(m - 1) % count] if m % per_flute != 1 else p
                    after = points[j][(m + 1) % count] if m % per_flute != 0 else p
                along = (before[2] - after[2], after[0] - before[0])
                corners.append((p, normalized((along[0], 0.0, along[1]))))
            obj.add(corners)

    top = high
    capital = [(0.365, top), *arc((0.37, top + 0.03), 0.03, -90, 90, 4), (0.365, top + 0.06), (0.365, top + 0.06),
               (0.365, top + 0.2), (0.365, top + 0.2), (0.4, top + 0.2), (0.4, top + 0.2), (0.4, top + 0.24),
               (0.4, top + 0.24), *[(0.4 + 0.15 * math.sin(t * 0.4 * math.pi), top + 0.24 + 0.16 * t ** 1.3)
                                    for t in (0, 0.2, 0.4, 0.6, 0.8, 1)]]
    turn(obj, capital, 40)
    slab(obj, (-0.58, top + 0.4, -0.58), (0.58, top + 0.54, 0.58))
    slab(obj, (-0.63, top + 0.54, -0.63), (0.63, COLUMN_HEIGHT, 0.63))
    obj.write("colonnade_column.obj")


def extrude(obj, profile, z0, z1):
    """A profile of (x, y) points, seen from +z counter-clockwise around the solid, along z; flat sides, no ends."""
    for (x0, y0), (x1, y1) in zip(profile, profile[1:]):
        normal = normalized((y1 - y0, x0 - x1, 0))
        obj.add([((x0, y0, z0), normal), ((x0, y0, z1), normal), ((x1, y1, z1), normal), ((x1, y1, z0), normal)][::-1])


def entablature():
    """One bay, y from 0 at the columns' top: architrave of two bands, frieze with triglyphs, dentils and cornice. The
    inner side faces the walk."""
    obj = Obj()
    outer = [(0.42, 0), (0.42, 0.3), (0.46, 0.3), (0.46, 0.62), (0.52, 0.64), (0.52, 0.72), (0.42, 0.72), (0.42, 1.42),
             (0.5, 1.44), (0.5, 1.5), (0.5, 1.66), (0.72, 1.7), (0.95, 1.72), (0.95, 1.86), (1.02, 1.9), (1.1, 2.02),
             (1.1, 2.08), (0.2, 2.2)]
    inner = [(-0.42, 1.5), (-0.42, 0.95), (-0.52, 0.9), (-0.52, 0.82), (-0.46, 0.8), (-0.46, 0.42), (-0.42, 0.42), (-0.42, 0)]
    extrude(obj, [*inner, *outer], -BAY / 2, BAY / 2)
    for center in (0, BAY / 2):
        for stripe in (-0.2, 0, 0.2):
            slab(obj, (0.42, 0.74, center + stripe - 0.07), (0.48, 1.4, center + stripe + 0.07))
        slab(obj, (0.42, 1.34, center - 0.3), (0.49, 1.42, center + 0.3))
        slab(obj, (0.46, 0.56, center - 0.3), (0.51, 0.62, center + 0.3))
    for i in range(14):
        z = -BAY / 2 + BAY * (i + 0.5) / 14
        slab(obj, (0.5, 1.5, z - 0.07), (0.66, 1.66, z + 0.07))
    obj.write("colonnade_entablature.obj")


def urn():
    obj = Obj()
    slab(obj, (-0.34, 0, -0.34), (0.34, 0.7, 0.34))
    slab(obj, (-0.4, 0.7, -0.4), (0.4, 0.78, 0.4))
    body = [(0.22, 0.78), (0.23, 0.82), (0.23, 0.82), (0.2, 0.86), (0.1, 0.93), (0.09, 0.98), (0.16, 1.03), (0.27, 1.14),
            (0.345, 1.3), (0.36, 1.42), (0.33, 1.53), (0.25, 1.6), (0.2, 1.66), (0.19, 1.72), (0.24, 1.8), (0.31, 1.84),
            (0.33, 1.85), (0.33, 1.85), (0.33, 1.88), (0.33, 1.88), (0.26, 1.86), (0.18, 1.76)]
    turn(obj, body, 36)
    obj.write("colonnade_urn.obj")


def ellipsoid(obj, center, radii, around=20, rings=12):
    def point(i, k):
        a, b = math.pi * i / rings, -2 * math.pi * (k % around) / around
        unit = (math.sin(a) * math.cos(b), -math.cos(a), math.sin(a) * math.sin(b))
        return (tuple(c + r * u for c, r, u in zip(center, radii, unit)), normalized([u / r for u, r in zip(unit, radii)]))

    for i in range(rings):
        for k in range(around):
            obj.add([point(i, k), point(i, k + 1), point(i + 1, k + 1), point(i + 1, k)])


def statue():
    """A draped figure on a plinth, looking along +x."""
    obj = Obj()
    slab(obj, (-0.42, 0, -0.42), (0.42, 0.9, 0.42))
    slab(obj, (-0.47, 0.9, -0.47), (0.47, 1.0, 0.47))
    around, rings = 40, 20
    outline = [(0.0, 0.31), (0.1, 0.29), (0.45, 0.235), (0.62, 0.19), (0.72, 0.215), (0.8, 0.245), (0.845, 0.2),
               (0.87, 0.11), (0.9, 0.062), (0.94, 0.06)]

    def robe(t, k):
        for (t0, r0), (t1, r1) in zip(outline, outline[1:]):
            if t <= t1:
                s = (t - t0) / (t1 - t0)
                r = r0 + (r1 - r0) * s * s * (3 - 2 * s)
                break
        a = -2 * math.pi * (k % around) / around
        folds = 0.035 * max(0, 1 - t / 0.6) * math.sin(9 * a + 5 * t) + 0.012 * max(0, 1 - t / 0.85) * math.sin(14 * a - 22 * t)
        wide = 1.0 if t > 0.86 else 1.22
        x = (r + folds) * math.cos(a) * 0.8 + 0.05 * math.sin(3 * t)
        return (x, 1.0 + 1.78 * t, (r + folds) * math.sin(a) * wide + 0.04 * math.sin(4 * t))

    def corner(t, k):
        p, e = robe(t, k), 1e-3
        up = [b - a for a, b in zip(robe(max(t - e, 0), k), robe(min(t + e, 0.94), k))]
        side = [b - a for a, b in zip(robe(t, k - 1), robe(t, k + 1))]
        return p, normalized((side[1] * up[2] - side[2] * up[1], side[2] * up[0] - side[0] * up[2],
                              side[0] * up[1] - side[1] * up[0]))

    for i in range(rings):
        t0, t1 = 0.94 * i / rings, 0.94 * (i + 1) / rings
        for k in range(around):
            obj.add([corner(t0, k), corner(t0, k + 1), corner(t1, k + 1), corner(t1, k)])
    ellipsoid(obj, (0.045, 2.8, -0.02), (0.11, 0.15, 0.1))
    ellipsoid(obj, (0.02, 2.835, -0.02), (0.115, 0.125, 0.108))
    ellipsoid(obj, (-0.11, 2.85, -0.02), (0.06, 0.055, 0.06))
    ellipsoid(obj, (0.1, 2.2, 0.27), (0.07, 0.26, 0.07))
    ellipsoid(obj, (0.21, 2.02, 0.18), (0.17, 0.06, 0.06))
    ellipsoid(obj, (-0.01, 2.1, -0.3), (0.075, 0.36, 0.07))
    obj.write("colonnade_statue.obj")


def cypress():
    obj = Obj()
    turn(obj, [(0.14, 0), (0.12, 0.7), (0.12, 0.7), (0.5, 0.75), (0.72, 1.3), (0.82, 2.2), (0.8, 3.4), (0.66, 4.7), (0.4, 6.0),
               (0.16, 6.8), (0, 7.2)], 14)
    obj.write("colonnade_cypress.obj")


def scene():
    length = BAY * BAYS
    far_z, near_z = -BAY * (BAYS - FIRST) + BAY / 2, BAY * FIRST + BAY / 2
    middle = (far_z + near_z) / 2
    objects = []

    def box(low, high, material):
        objects.append({"primitive": "box", "scale": [round(h - l, 3) for l, h in zip(low, high)],
                        "translate": [round((h + l) / 2, 3) for l, h in zip(low, high)], "material": material})

    # The court's ground, steps down to it, the walk's pavement, the wall with its plinth and string course.
    box((COLUMN_X + 2.0, -1.0, far_z), (COLUMN_X + 16, -0.75, near_z), "ground")
    box((COLUMN_X + 15.5, -0.75, far_z), (COLUMN_X + 16, 1.5, near_z), "step")
    for i in range(5):
        box((WALL_X - 0.5, -0.15 * (i + 1), far_z), (COLUMN_X + 0.75 + 0.36 * i, -0.15 * i, near_z), "step")
    for i in range(BAYS):
        z = near_z - BAY * (i + 1)
        for x, width in ((WALL_X, 1.5), (WALL_X + 1.5, 1.5), (WALL_X + 3.0, 1.5), (WALL_X + 4.5, 1.1)):
            for half in (0, 1):
                dark = (i * 2 + half + int((x - WALL_X) / 1.5)) % 2
                box((x + 0.012, -0.02, z + half * BAY / 2 + 0.012), (x + width - 0.012, 0.015, z + (half + 1) * BAY / 2 - 0.012),
                    "slab_dark" if dark else "slab_light")
    box((WALL_X - 0.6, 0, far_z), (WALL_X, COLUMN_HEIGHT + 1.45, near_z), "wall")
    box((WALL_X, 0, far_z), (WALL_X + 0.12, 0.9, near_z), "stone")
    box((WALL_X, 0.9, far_z), (WALL_X + 0.17, 1.0, near_z), "stone")
    box((WALL_X, COLUMN_HEIGHT - 0.1, far_z), (WALL_X + 0.2, COLUMN_HEIGHT + 0.12, near_z), "stone")
    # The ceiling and its beams.
    box((WALL_X - 0.6, COLUMN_HEIGHT + 1.45, far_z), (COLUMN_X + 0.3, COLUMN_HEIGHT + 1.65, near_z), "wood")
    for i in range(BAYS):
        z = BAY * (FIRST - i)
        objects.append({"mesh": "colonnade_column.obj", "translate": [COLUMN_X, 0, round(z, 3)], "material": "stone"})
        objects.append({"mesh": "colonnade_entablature.obj", "translate": [COLUMN_X, COLUMN_HEIGHT, round(z, 3)], "material": "stone"})
        box((WALL_X, 0.0, z - 0.4), (WALL_X + 0.22, COLUMN_HEIGHT - 0.35, z + 0.4), "stone")
        box((WALL_X, COLUMN_HEIGHT - 0.35, z - 0.5), (WALL_X + 0.32, COLUMN_HEIGHT, z + 0.5), "stone")
        box((WALL_X, COLUMN_HEIGHT + 0.98, z - 0.22), (COLUMN_X, COLUMN_HEIGHT + 1.45, z + 0.22), "wood")
        for j in (-1, 0, 1):
            joist = z + BAY / 2 + 0.75 * j
            box((WALL_X, COLUMN_HEIGHT + 1.25, joist - 0.09), (COLUMN_X, COLUMN_HEIGHT + 1.45, joist + 0.09), "wood")
        objects.append({"mesh": "colonnade_cypress.obj", "translate": [COLUMN_X + 11.5, -0.75, round(z, 3)],
                        "rotate": [0, 77 * i % 360, 0], "scale": [1, 1 + 0.07 * (i * 5 % 4), 1], "material": "cypress"})
        if i % 2 and i > 1:
            objects.append({"mesh": "colonnade_statue.obj", "translate": [WALL_X + 0.62, 0, round(z + BAY / 2, 3)], "material": "marble"})
        elif i % 4 == 0:
            objects.append({"mesh": "colonnade_urn.obj", "translate": [COLUMN_X + 0.1, 0, round(z + BAY / 2, 3)], "material": "terracotta"})
    haze = [0.4, 0.53, 0.73]
    head = {
        "camera": {"eye": [-1.7, 1.65, 4.6], "target": [1.9, 2.3, -10], "fov_y": 50, "near": 0.1, "far": round(near_z - far_z + 5)},
        "size": [1280, 720],
        "background": haze,
        "ambient": [0.06, 0.075, 0.11],
        "fog": {"mode": "exp", "density": [0.014, 0.0195, 0.029], "color": haze},
    }
    materials = {
        "stone": {"diffuse": [0.72, 0.64, 0.52], "specular": 0.03, "shininess": 12},
        "wall": {"diffuse": [0.62, 0.4, 0.28]},
        "wood": {"diffuse": [0.36, 0.2, 0.1]},
        "step": {"diffuse": [0.56, 0.5, 0.42]},
        "ground": {"diffuse": [0.58, 0.5, 0.38]},
        "slab_light": {"diffuse": [0.66, 0.58, 0.47], "specular": 0.12, "shininess": 40},
        "slab_dark": {"diffuse": [0.5, 0.4, 0.31], "specular": 0.12, "shininess": 40},
        "marble": {"diffuse": [0.78, 0.75, 0.7], "specular": 0.12, "shininess": 30},
        "cypress": {"diffuse": [0.07, 0.11, 0.045]},
        "terracotta": {"diffuse": [0.55, 0.26, 0.14], "specular": 0.06, "shininess": 16},
    }
    lights = [
        # The late sun, and what the sky, the court and the walk's floor send back.
        {"type": "directional", "direction": [-0.82, -0.46, 0.14], "color": [1, 0.68, 0.38], "intensity": 1.85, "shadow": True},
        {"type": "directional", "direction": [-0.9, -0.25, -0.35], "color": [0.45, 0.6, 0.9], "specular": 0, "intensity": 0.16},
        {"type": "directional", "direction": [-0.35, 0.9, -0.25], "color": [1, 0.7, 0.42], "specular": 0, "intensity": 0.4},
        {"type": "directional", "direction": [0.6, 0.1, -0.8], "color": [1, 0.66, 0.45], "specular": 0, "intensity": 0.1},
    ]
    write_scene("colonnade.json", head, materials, objects, lights)
    night(head, materials, objects)


def write_scene(name, head, materials, objects, lights, fields=()):
    parts = [f'  "{key}": {json.dumps(value)}' for key, value in head.items()]
    parts.append('  "materials": {\n' + ",\n".join(f'    "{k}": {json.dumps(v)}' for k, v in materials.items()) + "\n  }")
    for key, values in (("objects", objects), ("lights", lights), ("light_fields", fields)):
        if values:
            parts.append(f'  "{key}": [\n' + ",\n".join(f"    {json.dumps(v)}" for v in values) + "\n  ]")
    (FOLDER / name).write_text("{\n" + ",\n".join(parts) + "\n}\n")


# What the stream of sparks goes through, and how far they stray from it.
STREAM = ((3.2, 0.5, 6), (0.6, 0.6, -1), (-1.9, 1.1, -5.5), (0.9, 2.3, -10), (4.5, 1.2, -15), (1.2, 3.2, -20), (-1.6, 1.6, -26),
          (1.8, 2.6, -33), (0.2, 4.6, -42), (0.0, 3.0, -52))
STRAY = 0.55
EMBERS = ((1, 0.55, 0.16), (1, 0.42, 0.1), (1, 0.7, 0.3))


def along_stream(t):
    """Catmull-Rom: 0 is the first point, 1 the next."""
    i = min(int(t), len(STREAM) - 2)
    u = t - i
    p = [STREAM[min(max(k, 0), len(STREAM) - 1)] for k in range(i - 1, i + 3)]
    return tuple(0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u * u + (3 * b - a - 3 * c + d) * u ** 3)
                 for a, b, c, d in zip(*p))


def sparks():
    """Sparks that are seen: a triangle each, which faces the camera, and a light two centimetres above."""
    rng = random.Random(7)
    obj = Obj()
    lines = ["x,y,z,r,g,b,constant,linear,quadratic"]
    for _ in range(2500):
        x, y, z = along_stream(rng.random() * (len(STREAM) - 1))
        away = normalized([rng.gauss(0, 1) for _ in range(3)])
        r = STRAY * 1.3 * rng.random()
        x, y, z = x + r * away[0], y + r * away[1], z + r * away[2]
        size = 0.003 + 0.006 * rng.random() ** 3
        obj.add([((x - size, y - 0.6 * size, z), (0, 0, 1)), ((x + size, y - 0.6 * size, z), (0, 0, 1)), ((x, y + size, z), (0, 0, 1))])
        strength = 0.5 * size
        red, green, blue = (round(strength * c, 6) for c in rng.choice(EMBERS))
        lines.append(f"{x:.3f},{y + 0.02:.3f},{z:.3f},{red},{green},{blue},0,0,1")
    obj.write("colonnade_sparks.obj")
    (FOLDER / "colonnade_sparks.csv").write_text("\n".join(lines) + "\n")


def night(head, materials, objects):
    sparks()
    dark = [0.006, 0.008, 0.02]
    head = {**head, "background": dark, "ambient": [0.0025, 0.0035, 0.0075],
            "fog": {"mode": "exp", "density": [0.008, 0.01, 0.013], "color": dark}}
    materials = {**materials, "spark": {"diffuse": 0, "emission": [4, 2, 0.6]}}
    moon = {"type": "directional", "direction": [-0.6, -0.7, -0.35], "color": [0.35, 0.5, 0.9], "intensity": 0.05, "shadow": True}
    falls_off = {"attenuation": [0, 0, 1], "shadow": True}
    fields = (
        {"csv": "colonnade_sparks.csv", "shadow": True},
        # What is too small to be seen: embers in the walk, and wisps above the court.
        {"shape": "curve", "count": 117500, "seed": 11, "radius": STRAY, "points": STREAM, "colors": EMBERS,
         "intensity": [0.00004, 0.0012], **falls_off},
        {"shape": "clusters", "count": 80000, "seed": 5, "clusters": 30, "radius": 0.8, "min": [3.6, 0.3, -46], "max": [13, 3.2, 1],
         "colors": [[0.2, 0.9, 0.75], [0.3, 0.6, 1.0]], "intensity": [0.00004, 0.0016], **falls_off},
    )
    write_scene("colonnade_night.json", head, materials, [*objects, {"mesh": "colonnade_sparks.obj", "material": "spark"}], [moon], fields)


column()
entablature()
urn()
statue()
cypress()
scene()
