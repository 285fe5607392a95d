#!/usr/bin/env python3
"""Writes city.json and its meshes city_*.obj with city.mtl: an avenue after rain, at night. Lengths in metres; the avenue
runs along -z, cross streets along x."""
import json
import math
import random
from pathlib import Path

FOLDER = Path(__file__).parent
random.seed(7)

ROAD = 7.0        # half the avenue's width
WALK = 3.6        # width of a pavement
BLOCK = 44.0      # a block's length along the avenue
CROSS = 13.0      # a cross street's width
BLOCKS = 4
WARM = [1.0, 0.62, 0.28]
COOL = [0.72, 0.86, 1.0]
NEON = [[1.0, 0.08, 0.4], [0.1, 0.8, 1.0], [1.0, 0.32, 0.05], [0.55, 0.15, 1.0], [0.15, 1.0, 0.45]]

MATERIALS = {  # diffuse, emission, specular, shininess
    "brick": ([0.2, 0.11, 0.085], 0, 0, 1),
    "concrete": ([0.2, 0.205, 0.22], 0, 0, 1),
    "steel": ([0.09, 0.1, 0.125], 0, 0.12, 60),
    "trim": ([0.26, 0.25, 0.24], 0, 0, 1),
    "dark": ([0.012, 0.015, 0.02], 0, 0.2, 120),
    "warm": ([0.05, 0.04, 0.03], [0.95, 0.58, 0.24], 0, 1),
    "dim": ([0.05, 0.04, 0.03], [0.3, 0.17, 0.065], 0, 1),
    "cool": ([0.04, 0.04, 0.05], [0.55, 0.7, 0.85], 0, 1),
    "blue": ([0.02, 0.03, 0.05], [0.06, 0.14, 0.32], 0, 1),
    "shop": ([0.05, 0.04, 0.03], [1.0, 0.74, 0.42], 0, 1),
    "tyre": ([0.02, 0.02, 0.02], 0, 0.05, 8),
    "lamp": ([0, 0, 0], [1.5, 1.05, 0.6], 0, 1),
    "head": ([0.1, 0.1, 0.1], [1.6, 1.5, 1.3], 0, 1),
    "tail": ([0.1, 0.01, 0.01], [1.5, 0.05, 0.03], 0, 1),
    "paint": ([0.5, 0.5, 0.5], [0, 0, 0], 0, 1),  # city.json gives each car its own
}


class Obj:
    """Flat-sided meshes: faces by material, each vertex written once; normals are left to the reader of the file."""

    def __init__(self):
        self.vertices, self.faces = {}, {}

    def face(self, corners, material):
        indices = [self.vertices.setdefault(" ".join(f"{round(v, 3):g}" for v in p), len(self.vertices) + 1) for p in corners]
        self.faces.setdefault(material, []).append(indices)

    def slab(self, low, high, material, bottom=False):
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.face([(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)], material)
        self.face([(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)], material)
        self.face([(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)], material)
        self.face([(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)], material)
        self.face([(x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)], material)
        if bottom:
            self.face([(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)], material)

    def write(self, name):
        lines = ["mtllib city.mtl"] + [f"v {v}" for v in self.vertices] + ["s off"]
        for material, faces in self.faces.items():
            lines.append(f"usemtl {material}")
            lines += ["f " + " ".join(map(str, face)) for face in faces]
        (FOLDER / name).write_text("\n".join(lines) + "\n")


def write_materials():
    def rgb(value):
        return " ".join(f"{v:g}" for v in (value if isinstance(value, list) else [value] * 3))

    lines = []
    for name, (diffuse, emission, specular, shininess) in MATERIALS.items():
        lines += [f"newmtl {name}", f"Ka {rgb(diffuse)}", f"Kd {rgb(diffuse)}", f"Ks {rgb(specular)}", f"Ke {rgb(emission)}",
                  f"Ns {shininess}", "illum 2"]
    (FOLDER / "city.mtl").write_text("\n".join(lines) + "\n")


def facade(obj, place, width, bottom, floors, floor_height, columns, window, wall, lights):
    """Rows of windows set 0.25 m into a wall; place(u, v, depth) is a point u along, v up, depth in. `window` is the share
    of a cell that is glass, across and up; `lights` are the materials to choose from."""
    w, inset = width / columns, 0.25
    gap_u, gap_v = w * (1 - window[0]) / 2, floor_height * (1 - window[1]) / 2
    top = bottom + floors * floor_height

    def quad(u0, v0, u1, v1, material, depth=0.0):
        obj.face([place(u0, v0, depth), place(u1, v0, depth), place(u1, v1, depth), place(u0, v1, depth)], material)

    for row in range(floors):
        v0, v1 = bottom + row * floor_height + gap_v, bottom + (row + 1) * floor_height - gap_v
        for column in range(columns):
            u0, u1 = column * w + gap_u, (column + 1) * w - gap_u
            # Strips above and below with all the corners of their neighbours on their edges, so that no crack opens.
            left, right = column * w, (column + 1) * w
            for v, end in ((v0, v0 - gap_v), (v1, v1 + gap_v)):
                strip = [(left, end), (right, end), (right, v), (u1, v), (u0, v), (left, v)]
                obj.face([place(a, b, 0) for a, b in (strip if end < v else strip[::-1])], wall)
            quad(u0 - gap_u, v0, u0, v1, wall)
            quad(u1, v0, u1 + gap_u, v1, wall)
            quad(u0, v0, u1, v1, random.choice(lights), inset)
            quad((u0 + u1) / 2 - 0.05, v0, (u0 + u1) / 2 + 0.05, v1, "trim", inset - 0.06)
            obj.face([place(u0, v0, 0), place(u1, v0, 0), place(u1, v0, inset), place(u0, v0, inset)], wall)
            obj.face([place(u0, v1, inset), place(u1, v1, inset), place(u1, v1, 0), place(u0, v1, 0)], wall)
            obj.face([place(u0, v0, 0), place(u0, v0, inset), place(u0, v1, inset), place(u0, v1, 0)], wall)
            obj.face([place(u1, v0, inset), place(u1, v0, 0), place(u1, v1, 0), place(u1, v1, inset)], wall)
    return top


def building(name, width, depth, floors, floor_height, columns, window, wall, lights, shops=True, crown="flat"):
    """Centred, its front facing +z. Windows on the front and both sides; the back is blank."""
    obj = Obj()
    hw, hd, ground = width / 2, depth / 2, 4.6
    sides = [(lambda u, v, d: (-hw + u, v, hd - d), width, columns),
             (lambda u, v, d: (hw - d, v, hd - u), depth, max(2, round(columns * depth / width))),
             (lambda u, v, d: (-hw + d, v, -hd + u), depth, max(2, round(columns * depth / width)))]
    for i, (place, length, count) in enumerate(sides):
        shop = ["shop", "shop", "cool", "dark"] if shops and i == 0 else ["dark", "dark", "dim"]
        facade(obj, place, length, 0, 1, ground, max(2, count // 2), (0.8, 0.66), "trim", shop)
        top = facade(obj, place, length, ground, floors, floor_height, count, window, wall, lights)
    obj.face([(hw, 0, -hd), (-hw, 0, -hd), (-hw, top, -hd), (hw, top, -hd)], wall)
    obj.face([(-hw, top, hd), (hw, top, hd), (hw, top, -hd), (-hw, top, -hd)], "trim")
    obj.slab((-hw - 0.2, ground - 0.25, -hd - 0.05), (hw + 0.2, ground + 0.1, hd + 0.3), "trim", True)
    obj.slab((-hw - 0.3, top - 0.3, -hd - 0.3), (hw + 0.3, top + 0.7, hd + 0.3), "trim", True)
    if crown == "steps":
        for i in range(1, 4):
            obj.slab((-hw + 2.2 * i, top + 4 * (i - 1), -hd + 2.2 * i), (hw - 2.2 * i, top + 4 * i, hd - 2.2 * i), wall)
    else:
        obj.slab((-hw * 0.4, top, -hd * 0.5), (hw * 0.1, top + 3, 0), "concrete")
    obj.write(name)


def street_lamp():
    obj = Obj()
    obj.slab((-0.16, 0, -0.16), (0.16, 0.9, 0.16), "steel")
    obj.slab((-0.08, 0.9, -0.08), (0.08, 7.1, 0.08), "steel")
    obj.slab((-0.08, 7.1, -0.05), (2.3, 7.2, 0.05), "steel", True)
    obj.slab((1.45, 7.0, -0.17), (2.35, 7.1, 0.17), "lamp", True)
    obj.write("city_lamp.obj")


def car():
    """Body (to be given a colour) and the rest; 4.4 m long, driving towards +z, wheels on y = 0."""
    body, rest = Obj(), Obj()
    half = 0.88
    side = [(-2.18, 0.32), (2.15, 0.32), (2.2, 0.62), (2.05, 0.8), (1.0, 0.95), (-2.0, 0.98), (-2.2, 0.85)]
    cabin = [(0.95, 0.95), (0.3, 1.42), (-1.1, 1.45), (-1.75, 0.98)]

    def hull(obj, outline, widths, materials):
        """Sides on ±x and the band around; `widths` are half-widths at the outline's points."""
        n = len(outline)
        left = [(-w, y, z) for (z, y), w in zip(outline, widths)]
        right = [(w, y, z) for (z, y), w in zip(outline, widths)]
        obj.face(right[::-1], materials[0])
        obj.face(left, materials[0])
        for i in range(n):
            j = (i + 1) % n
            obj.face([left[j], left[i], right[i], right[j]], materials[1 + i % (len(materials) - 1)])

    hull(body, side, [half - 0.06, half - 0.06, half - 0.08, half - 0.06, half, half, half - 0.05], ["paint", "paint"])
    hull(rest, cabin, [half - 0.08, half - 0.22, half - 0.22, half - 0.08], ["dark", "dark"])
    body.slab((-half + 0.26, 1.42, -1.05), (half - 0.26, 1.47, 0.25), "paint")
    for x in (-1, 1):
        for z in (-1.38, 1.38):
            ring = [(0.33 * math.cos(2 * math.pi * k / 14), 0.33 * math.sin(2 * math.pi * k / 14)) for k in range(14)]
            outer, inner = x * (half + 0.01), x * (half - 0.24)
            rim = [(outer, 0.33 + b, z - x * a) for a, b in ring]
            rest.face(rim, "tyre")
            rest.face([(outer + 0.005 * x, 0.33 + 0.6 * b, z - x * 0.6 * a) for a, b in ring], "trim")
            for k in range(14):
                (a0, b0), (a1, b1) = ring[k], ring[(k + 1) % 14]
                rest.face([(outer, 0.33 + b0, z - x * a0), (inner, 0.33 + b0, z - x * a0), (inner, 0.33 + b1, z - x * a1),
                           (outer, 0.33 + b1, z - x * a1)], "tyre")
        rest.slab((min(x * 0.5, x * 0.8), 0.6, 2.0), (max(x * 0.5, x * 0.8), 0.74, 2.24), "head", True)
        rest.slab((min(x * 0.5, x * 0.82), 0.68, -2.25), (max(x * 0.5, x * 0.82), 0.84, -2.1), "tail", True)
    body.write("city_car_body.obj")
    rest.write("city_car_rest.obj")


BUILDINGS = [  # width, depth, floors, floor height, columns, window share, wall, windows, crown
    (16, 14, 5, 3.4, 8, (0.5, 0.58), "brick", ["dark"] * 6 + ["warm", "dim", "dim"], "flat"),
    (14, 14, 8, 3.3, 6, (0.55, 0.6), "concrete", ["dark"] * 5 + ["warm", "dim", "cool"], "flat"),
    (14, 14, 14, 3.6, 7, (0.84, 0.7), "steel", ["dark"] * 4 + ["blue", "blue", "cool", "dim", "warm"], "flat"),
    (18, 16, 10, 3.5, 7, (0.46, 0.66), "brick", ["dark"] * 5 + ["warm", "dim"], "steps"),
]


def scene():
    random.seed(4)
    objects, lights = [], []
    length = BLOCKS * (BLOCK + CROSS)

    def put(x, y, z, turned=0, **keys):
        entry = dict(keys)
        entry["translate"] = [round(v, 3) for v in (x, y, z)]
        if turned:
            entry["rotate"] = [0, round(turned, 2), 0]
        objects.append(entry)

    def box(low, high, material):
        objects.append({"primitive": "box", "scale": [round(h - l, 3) for l, h in zip(low, high)],
                        "translate": [round((h + l) / 2, 3) for l, h in zip(low, high)], "material": material})

    def spot(position, direction, color, intensity, reach, near, **cone):
        """Those near the camera cast shadows."""
        lights.append({"type": "spot", "position": [round(v, 3) for v in position], "direction": direction, **cone,
                       "color": color, "intensity": intensity, "attenuation": [0.4, 0, 0.05], "range": reach})
        if near:
            lights[-1]["shadow"] = True

    def point(position, color, intensity, reach):
        lights.append({"type": "point", "position": [round(v, 3) for v in position], "color": color, "intensity": intensity,
                       "attenuation": [0.2, 0, 0.6], "range": reach})

    def glint(position, color, intensity, reach=70):
        """What the wet street mirrors of something bright: a highlight and no more."""
        lights.append({"type": "point", "position": [round(v, 3) for v in position], "diffuse": 0, "specular": color,
                       "intensity": intensity, "range": reach})

    def lamp(x, z, turned):
        """A pole, an arm and a head, which reaches towards +x when not turned; the light is a soft cone."""
        put(x, 0.15, z, turned, mesh="city_lamp.obj")
        a = math.radians(turned)
        x, z = x + 1.9 * math.cos(a), z - 1.9 * math.sin(a)
        spot((x, 7.1, z), [0, -1, 0], WARM, 4.2, 17, -26 < z < 20 and abs(x) < ROAD, inner_cone=20, outer_cone=60)
        point((x, 7.1, z), WARM, 2.6, 14)
        glint((x, 7.1, z), WARM, 0.2)

    objects.append({"primitive": "plane", "scale": [150, 1, length + 60],
                    "translate": [0, 0, round(-length / 2 + 30, 3)], "material": "asphalt"})
    for block in range(-1, BLOCKS):
        z0 = -block * (BLOCK + CROSS) - CROSS / 2  # the block's near end
        z1 = z0 - BLOCK
        for side in (-1, 1):
            inner, outer = side * ROAD, side * (ROAD + 40)
            box((min(inner, outer), 0, z1), (max(inner, outer), 0.15, z0), "pavement")
            # Buildings along the avenue, then a second row that closes the view along the cross streets.
            for row in (0, 1) if block < 2 else (0,):
                z = z0
                while z - z1 > 13.5:
                    kind = random.choice([0, 1, 1, 3] if row == 0 else [1, 2, 2, 3])
                    width, depth = BUILDINGS[kind][:2]
                    width = min(width, z - z1)
                    stretch = width / BUILDINGS[kind][0]
                    x = side * (ROAD + WALK + depth / 2 + row * 19)
                    keys = {"scale": [round(stretch, 3), 1, 1]} if stretch < 1 else {}
                    put(x, 0.15, z - width / 2, -90 * side, mesh=f"city_building{kind}.obj", **keys)
                    if row == 0:
                        front = side * (ROAD + WALK - 0.35)
                        color = random.choice(NEON)
                        # What the shops' windows and a neon sign throw on the pavement.
                        for k in (0.25, 0.75):
                            point((front - side * 0.5, 2.2, z - width * k), [1, 0.7, 0.4], 1.1, 8)
                        if random.random() < 0.75:
                            y, at = random.uniform(5.5, 8.5), z - width * random.uniform(0.2, 0.8)
                            material = f"neon{NEON.index(color)}"
                            if random.random() < 0.5:
                                box((min(front, front - side * 0.9), y, at - 0.09), (max(front, front - side * 0.9), y + 3.2, at + 0.09), material)
                            else:
                                objects.append({"primitive": "torus", "segments": 32, "minor_radius": 0.1, "scale": 0.9,
                                                "translate": [round(front - side * 1.2, 3), round(y + 1, 3), round(at, 3)],
                                                "rotate": [90, 0, 0], "material": material})
                            point((front - side * 1.3, y + 0.8, at), color, 5, 15)
                            glint((front - side * 1.3, y + 0.8, at), color, 0.45)
                    z -= width
            # Street lamps, along the avenue and the cross street.
            for k in range(4):
                lamp(side * (ROAD + 0.5), z0 - BLOCK * (k + 0.5) / 4, 0 if side < 0 else 180)
            for k in (6.5, 21):
                lamp(side * (ROAD + k), z0 - 0.5, 270)
                lamp(side * (ROAD + k + 6), z1 + 0.5, 90)
            # Traffic lights at the corners.
            for z, facing in ((z0 - 0.8, 1), (z1 + 0.8, -1)):
                x = side * (ROAD + 0.4)
                box((x - 0.07, 0.15, z - 0.07), (x + 0.07, 3.6, z + 0.07), "pole")
                box((x - 0.17, 2.6, z - 0.17), (x + 0.17, 3.6, z + 0.17), "pole")
                go = facing * side > 0
                y = 2.78 if go else 3.42
                objects.append({"primitive": "sphere", "segments": 12, "scale": 0.13, "translate": [round(x, 3), y, round(z + 0.16 * facing, 3)],
                                "material": "go" if go else "stop"})
                color = [0.1, 1, 0.5] if go else [1, 0.06, 0.03]
                point((x, y, z + 0.5 * facing), color, 1.2, 6)
                glint((x, y, z + 0.5 * facing), color, 0.45)
        # Lane marks and zebra crossings.
        for k in range(7):
            z = z0 - 5 - 5.6 * k
            objects.append({"primitive": "plane", "scale": [0.16, 1, 2.6], "translate": [0, 0.012, round(z, 3)], "material": "paint_white"})
        for z in (z0 + 1.6, z1 - 1.6):
            for k in range(12):
                objects.append({"primitive": "plane", "scale": [0.55, 1, 2.2], "translate": [round(-6.3 + 1.145 * k, 3), 0.012, round(z, 3)],
                                "material": "paint_white"})

    # A tower where the avenue ends.
    put(0, 0, -length - 16, mesh="city_building3.obj", scale=[1.3, 1.5, 1.3])
    for x in (-9, 0, 9):
        lights.append({"type": "spot", "position": [x, 34, round(-length + 6, 3)], "direction": [0, 0.9, -0.4], "cutoff": 40,
                       "exponent": 6, "color": [1, 0.6, 0.32], "intensity": 3})
    objects.append({"primitive": "sphere", "segments": 16, "scale": 0.9, "translate": [0, 78.5, round(-length - 16, 3)], "material": "stop"})

    paints = ["car0", "car1", "car2", "car3", "car4"]

    def drive(x, z, towards, lit=True):
        turned = 0 if towards > 0 else 180
        material = paints[(len(objects) // 2 + 1) % 5]
        put(x, 0, z, turned, mesh="city_car_body.obj", material=material)
        put(x, 0, z, turned, mesh="city_car_rest.obj")
        if lit:
            for s in (-0.65, 0.65):
                spot((x + s, 0.7, z + 2.3 * towards), [0, -0.12, towards], [1, 0.93, 0.78], 2, 26, z > -9, cutoff=32, exponent=20)
                point((x + s, 0.75, z - 2.9 * towards), [1, 0.04, 0.02], 0.6, 6)
                glint((x + s, 0.75, z - 2.4 * towards), [1, 0.04, 0.02], 0.5, 20)

    drive(2.1, 4.2, -1)
    drive(-2.1, -3, 1)
    z = -12.0
    while z > -length:
        if random.random() < 0.75:
            drive(-2.0 + random.uniform(-0.15, 0.15), z, 1)
        if random.random() < 0.75:
            drive(2.0 + random.uniform(-0.15, 0.15), z - 6, -1)
        if random.random() < 0.6 and (z % (BLOCK + CROSS)) > CROSS:
            drive(random.choice([-1, 1]) * 5.7, z - 3, random.choice([-1, 1]), lit=False)
        z -= random.uniform(11, 19)

    night = [0.022, 0.027, 0.045]
    head = {
        "camera": {"eye": [0.9, 3.1, 19.6], "target": [-1.2, 5.2, -30], "fov_y": 42, "near": 0.3, "far": 420},
        "size": [1280, 720],
        "background": night,
        "ambient": [0.05, 0.06, 0.1],
        "fog": {"mode": "exp2", "density": 0.0046, "color": night},
    }
    materials = {
        # Wet: dark, with a strong and long highlight.
        "asphalt": {"diffuse": [0.05, 0.052, 0.058], "specular": 0.75, "shininess": 220},
        "pavement": {"diffuse": [0.15, 0.15, 0.155], "specular": 0.14, "shininess": 50},
        "paint_white": {"diffuse": [0.5, 0.5, 0.48], "specular": 0.4, "shininess": 150},
        "pole": {"diffuse": [0.05, 0.055, 0.06], "specular": 0.3, "shininess": 30},
        "stop": {"diffuse": 0, "emission": [1.4, 0.07, 0.04]},
        "go": {"diffuse": 0, "emission": [0.1, 1.2, 0.6]},
    }
    for i, color in enumerate(NEON):
        materials[f"neon{i}"] = {"diffuse": 0, "emission": [round(1.3 * c, 3) for c in color]}
    for i, color in enumerate([[0.3, 0.02, 0.02], [0.03, 0.05, 0.12], [0.3, 0.3, 0.32], [0.02, 0.02, 0.022], [0.42, 0.28, 0.02]]):
        materials[f"car{i}"] = {"diffuse": color, "specular": 0.6, "shininess": 80}
    parts = [f'  "{key}": {json.dumps(value)}' for key, value in head.items()]
    parts.append('  "materials": {\n' + ",\n".join(f'    "{k}": {json.dumps(v)}' for k, v in materials.items()) + "\n  }")
    for key, values in (("objects", objects), ("lights", lights)):
        parts.append(f'  "{key}": [\n' + ",\n".join(f"    {json.dumps(v, separators=(',', ':'))}" for v in values) + "\n  ]")
    (FOLDER / "city.json").write_text("{\n" + ",\n".join(parts) + "\n}\n")


write_materials()
for i, (width, depth, floors, height, columns, window, wall, windows, crown) in enumerate(BUILDINGS):
    building(f"city_building{i}.obj", width, depth, floors, height, columns, window, wall, windows, crown=crown)
street_lamp()
car()
scene()
