#!/usr/bin/env python3
"""Writes fireflies.json and its meshes in fireflies/: a clearing, ten thousand fireflies and one moon.

The pond is a hole in the ground with the world's mirror image below it: what a perfectly still pond shows.
"""

import math
import os
import random

from forest import broadleaf, leaf_clump, conifer, grass_tuft, reeds, fern, stone, lily_pad
from meshes import Mesh, add, dot, mix, noise, octaves, scaled, smoothstep, uniforms, write_scene

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = "fireflies"

EYE = (0.2, 1.95, 8.5)
TARGET = (0.2, 1.75, -8.0)
FOV_Y = 43.0
# A walk to the pond and back in 120 frames, which end where they begin. The stage is built for the first: from
# further ahead, and a little beside it, nothing that isn't there comes into the picture.
WALK = [
    (1, EYE, TARGET),
    (31, (-0.55, 2.3, 6.6), (0.8, 1.6, -8.0)),
    (61, (0.1, 2.6, 4.7), (0.4, 1.4, -8.0)),
    (91, (1.0, 2.3, 6.6), (-0.3, 1.6, -8.0)),
    (121, EYE, TARGET),
]
BACKDROP = 45.0  # metres ahead of the eye
FOG_DENSITY = 0.034
FOG_COLOR = (0.0115, 0.0265, 0.0465)
AMBIENT = (0.022, 0.034, 0.055)
MOON = (-0.72, -0.58, 0.38)  # the way it shines


# --- The lay of the land ------------------------------------------------

PATH = [
    (12, -0.2),
    (8.5, -0.35),
    (6, -0.75),
    (3.5, -1.75),
    (0.5, -2.55),
    (-2.5, -2.3),
    (-5.5, -1.0),
    (-9, 0.55),
    (-13, 0.75),
    (-18, -0.2),
    (-26, 0.6),
    (-45, 0.2),
]


def path_x(z):
    """Catmull-Rom through PATH."""
    for i in range(1, len(PATH) - 2):
        if z >= PATH[i + 1][0]:
            break
    t = min(max((z - PATH[i][0]) / (PATH[i + 1][0] - PATH[i][0]), 0.0), 1.0)
    a, b, c, d = (PATH[i + k][1] for k in (-1, 0, 1, 2))
    return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3)


def pond(x, z):
    """Below 0 on the water, about 1 more every 3 metres."""
    return math.hypot((x - 2.9) / 3.7, (z + 0.3) / 3.0) - 1 + 0.13 * noise(0.8 * x + 7, 0.8 * z)


def height(x, z):
    shore = pond(x, z)
    on_path = math.exp(-(((x - path_x(z)) / 0.75) ** 2))
    rolling = 0.16 * octaves(0.35 * x, 0.35 * z + 4) + 0.035 * noise(2.3 * x, 2.3 * z)
    sides = 0.012 * max(abs(x - 0.5) - 6, 0) ** 2
    dry = smoothstep(0, 0.7, shore)
    return 0.10 * smoothstep(0, 0.07, shore) + dry * (
        0.16 + rolling * (1 - 0.6 * on_path) + min(sides, 2.5) - 0.06 * on_path
    )


def ground_color(x, z):
    grass = mix((0.055, 0.085, 0.026), (0.10, 0.105, 0.040), 0.5 + 0.5 * octaves(0.9 * x, 0.9 * z, 3))
    sand = mix((0.22, 0.165, 0.10), (0.30, 0.23, 0.15), 0.5 + 0.5 * noise(2.9 * x, 2.9 * z, 9))
    edge = 0.25 * noise(1.7 * x, 1.7 * z, 5)
    color = mix(grass, sand, 1 - smoothstep(0.35, 0.85, abs(x - path_x(z)) + edge))
    return mix((0.05, 0.042, 0.030), color, smoothstep(0.02, 0.22, pond(x, z)))


def ground():
    """A fan as the camera sees it, so that triangles look alike near and far; cut along the shore."""
    columns, rows, near, far = 44, 46, 1.4, BACKDROP + 1
    mesh = Mesh()
    grid = []
    for j in range(rows + 1):
        d = near * (far / near) ** (j / rows)
        z = EYE[2] - d
        row = []
        for i in range(columns + 1):
            x = EYE[0] + (2 * i / columns - 1) * (0.78 * d + 0.6)
            row.append((x, z, pond(x, z)))
        grid.append(row)
    known = {}

    def index(x, z, wet):
        key = (round(x, 4), round(z, 4))
        if key not in known:
            known[key] = mesh.vertex((x, 0.0 if wet else height(x, z), z), ground_color(x, z))
        return known[key]

    for j in range(rows):
        for i in range(columns):
            quad = [grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]]
            corners = []
            for a, b in zip(quad, quad[1:] + quad[:1]):
                if a[2] >= 0:
                    corners.append(index(a[0], a[1], False))
                if (a[2] >= 0) != (b[2] >= 0):
                    t = a[2] / (a[2] - b[2])
                    corners.append(index(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), True))
            if len(corners) > 2:
                mesh.face(corners)
    return mesh


def sky():
    """A glow towards the moon, which stands out of the picture to the right. What the fog takes is put in
    first. Colours are radiances: the material's ambient coefficient undoes the scene's ambient light."""
    share = math.exp(-((FOG_DENSITY * BACKDROP) ** 2))
    columns, rows, half, low, top = 18, 22, 37.0, -22.0, 24.0
    mesh = Mesh(2)
    for j in range(rows + 1):
        y = low + (top - low) * j / rows
        for i in range(columns + 1):
            x = -half + 2 * half * i / columns
            up = abs(y - EYE[1]) / 20  # the pond shows the same sky
            seen = mix(FOG_COLOR, (0.0030, 0.0085, 0.0240), smoothstep(0.0, 1.05, up))
            glow = add(
                scaled((0.026, 0.043, 0.058), math.exp(-(((x - 17) / 17) ** 2 + ((abs(y) - 9) / 11) ** 2))),
                scaled((0.012, 0.018, 0.020), math.exp(-(((x - 1) / 8) ** 2 + ((abs(y) - 4) / 5) ** 2))),
            )
            seen = add(seen, scaled(glow, smoothstep(0.0, 0.15, up)))
            dim = 1.0 if y > 0 else 0.8
            color = tuple(max((dim * s - f * (1 - share)) / share, 0) for s, f in zip(seen, FOG_COLOR))
            mesh.vertex((x + EYE[0], y, EYE[2] - BACKDROP), color)
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            mesh.face((a, a + 1, a + columns + 2, a + columns + 1))
    return mesh


# --- Fireflies ------------------------------------------------


def lights_of(field):
    """A field's lights as the renderer makes them: place, colour, intensity from 0 to 1 in its interval."""
    places, looks = uniforms(field["seed"]), uniforms(~field["seed"] & (1 << 64) - 1)
    for _ in range(field["count"]):
        if "radius" not in field:
            place = tuple(a + next(places) * (b - a) for a, b in zip(field["min"], field["max"]))
        else:
            while True:
                p = tuple(2 * next(places) - 1 for _ in range(3))
                if dot(p, p) <= 1:
                    break
            place = add(field["center"], scaled(p, field["radius"]))
        color = field["colors"][int(next(looks) * len(field["colors"]))]
        intensity = next(looks)
        next(looks)  # the range
        yield place, color, intensity


WARM = [[1.0, 0.78, 0.22], [0.95, 0.92, 0.26], [0.72, 1.0, 0.28]]
AMBER = [[1.0, 0.62, 0.16], [1.0, 0.76, 0.22], [0.95, 0.9, 0.28]]
GREEN = [[0.62, 1.0, 0.32], [0.80, 1.0, 0.28], [0.95, 0.9, 0.25]]


def swarms():
    """The light fields: along the path into the depth, over the water, around trees, over the meadow."""
    fields = []

    def swarm(count, colors, intensity, reach, **shape):
        shape = {k: v if isinstance(v, float) else [round(c, 2) for c in v] for k, v in shape.items()}
        if "radius" in shape:
            shape = {"shape": "ball", **shape}
        fields.append(
            {
                "count": count,
                "seed": 100 + len(fields),
                **shape,
                "colors": colors,
                "intensity": intensity,
                "range": reach,
                "attenuation": [0.12, 0, 7],
            }
        )

    z = 6.8
    while z > -22:
        x = path_x(z)
        swarm(
            110 if z > 0 else 170,
            AMBER,
            [0.06, 0.26],
            [0.5, 1.0],
            min=(x - 0.9, height(x, z) + 0.08, z - 1.1),
            max=(x + 0.9, height(x, z) + (0.55 if z > 0 else 0.9), z + 1.1),
        )
        z -= 2.2
    swarm(700, WARM, [0.08, 0.3], [0.5, 1.0], min=(-0.6, 0.07, -3.8), max=(6.6, 0.75, 2.8))
    swarm(500, GREEN, [0.1, 0.35], [0.5, 1.0], center=(-4.6, 1.5, 2.6), radius=2.2)
    swarm(420, WARM, [0.1, 0.35], [0.5, 1.1], center=(6.6, 1.2, 0.2), radius=2.0)
    swarm(1100, AMBER, [0.3, 0.9], [0.8, 1.6], center=(0.6, 1.3, -16.0), radius=3.6)
    swarm(700, GREEN, [0.1, 0.4], [0.6, 1.2], center=(-7.0, 1.6, -5.5), radius=3.4)
    swarm(700, WARM, [0.1, 0.4], [0.6, 1.2], center=(8.2, 1.6, -7.0), radius=3.4)
    swarm(900, WARM, [0.06, 0.3], [0.5, 1.0], min=(-9, 0.15, -5), max=(-1.5, 1.0, 6.5))
    swarm(230, WARM, [0.06, 0.3], [0.5, 1.0], min=(0.4, 0.2, 2.6), max=(5.5, 0.8, 6.6))
    swarm(260, GREEN, [0.3, 0.9], [0.7, 1.3], center=(3.7, 5.4, -6.2), radius=2.3)
    swarm(200, GREEN, [0.3, 0.9], [0.7, 1.3], center=(-5.2, 5.2, -4.0), radius=2.2)
    swarm(120, WARM, [0.3, 0.8], [0.6, 1.1], center=(-2.4, 4.0, 1.6), radius=1.5)
    left = 10000 - sum(f["count"] for f in fields)
    swarm(left // 2, GREEN, [0.1, 0.45], [0.7, 1.4], min=(-18, 0.2, -26), max=(-2, 3.2, -6))
    swarm(left - left // 2, WARM, [0.1, 0.45], [0.7, 1.4], min=(2, 0.2, -26), max=(18, 3.2, -5))
    assert sum(f["count"] for f in fields) == 10000
    return fields


def flies(fields, share):
    """A tiny glowing diamond at the first lights of each field, larger far away so that none falls between
    pixels; and the materials, one a colour."""
    mesh, glows = Mesh(), {}
    for field in fields:
        for i, (p, color, intensity) in enumerate(lights_of(field)):
            if i >= share * field["count"]:
                break
            d = EYE[2] - p[2]
            dry = pond(p[0], p[2]) > 0
            if d < 2.4 or abs(p[0] - EYE[0]) > 0.72 * d or p[1] < (height(p[0], p[2]) if dry else 0.03):
                continue
            r = (max(0.007, 0.0010 * d) + 0.001) * (0.75 + 0.8 * intensity**3)
            glow = glows.setdefault(tuple(color), f"glow{len(glows) + 1}")
            top, low = mesh.vertex(add(p, (0, 1.25 * r, 0))), mesh.vertex(add(p, (0, -1.25 * r, 0)))
            rim = [mesh.vertex(add(p, q)) for q in ((r, 0, 0.5 * r), (0, 0, -r), (-r, 0, 0.5 * r))]
            for a, b in zip(rim, rim[1:] + rim[:1]):
                mesh.face((top, a, b), glow)
                mesh.face((low, b, a), glow)
    return mesh, glows


# --- The scene ------------------------------------------------


def place(mesh, at, turn=0.0, size=1.0, tilt=None, material=None):
    entry = {"mesh": f"{FOLDER}/{mesh}.obj", "translate": [round(c, 2) for c in at]}
    if turn or tilt:
        x, z = tilt or (0, 0)
        entry["rotate"] = [round(x), round(turn) % 360, round(z)]
    if size != 1.0:
        entry["scale"] = round(size, 2) if isinstance(size, float) else [round(s, 2) for s in size]
    if material:
        entry["material"] = material
    return entry


def mirror(entry):
    """The pond's image of an object that stands upright."""
    size = entry.get("scale", 1)
    size = list(size) if isinstance(size, list) else [size] * 3
    image = dict(entry)
    x, y, z = entry["translate"]
    image["translate"] = [x, -y, z]
    image["scale"] = [size[0], -size[1], size[2]]
    if "rotate" in entry:
        a, b, c = entry["rotate"]
        image["rotate"] = [-a, b, -c]
    return image


def main():
    os.makedirs(os.path.join(HERE, FOLDER), exist_ok=True)
    rng = random.Random(2024)

    def save(name, mesh, mtl=None, smooth=True):
        mesh.write(os.path.join(HERE, FOLDER, name + ".obj"), mtl, smooth)

    objects = [place("sky", (0, 0, 0), material="sky"), place("ground", (0, 0, 0), material="ground")]
    objects.append(mirror(objects[1]))
    save("sky", sky())
    save("ground", ground())
    save("clump", leaf_clump(), smooth=False)
    save("conifer", conifer(), "conifer.mtl", smooth=False)
    save("tuft", grass_tuft())
    save("reeds", reeds(), "reeds.mtl")
    save("fern", fern(), smooth=False)
    save("lily", lily_pad(), smooth=False)
    save("stone1", stone(1, (1.0, 0.62, 0.8), 0.35))
    save("stone2", stone(2, (1.0, 0.8, 0.9), 0.5))
    save("slab", stone(3, (1.0, 0.22, 0.75), 0.30))
    with open(os.path.join(HERE, FOLDER, "conifer.mtl"), "w") as out:
        out.write(
            "newmtl bark\nKa .07 .055 .045\nKd .07 .055 .045\nillum 1\n"
            "newmtl needles\nKa .03 .05 .035\nKd .035 .06 .032\nillum 1\n"
        )
    with open(os.path.join(HERE, FOLDER, "reeds.mtl"), "w") as out:
        out.write(
            "newmtl plain\nKa .07 .1 .035\nKd .10 .14 .045\nillum 1\n"
            "newmtl cattail\nKa .06 .03 .015\nKd .10 .05 .025\nillum 1\n"
        )

    trees = {"oak": broadleaf(11, 3.1, 0.46, (0.7, 0.3), 2), "ash": broadleaf(4, 3.9, 0.25, (-0.5, 0.2), 2)}
    for name, (mesh, _) in trees.items():
        save(name, mesh)

    def tree(name, at, turn, size, images=False, dense=1.0):
        parts = [
            place(
                name,
                (at[0], height(*at), at[1]),
                turn,
                size,
                material="oak_bark" if name == "oak" else "bark",
            )
        ]
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        for tip in trees[name][1]:
            x, y, z = scaled(tip, size)
            beside = abs(at[0] + c * x + s * z - EYE[0]) - 0.8 * (EYE[2] - at[1] + s * x - c * z)
            if rng.random() > dense or beside > 2:
                continue
            parts.append(
                place(
                    "clump",
                    (at[0] + c * x + s * z, parts[0]["translate"][1] + y, at[1] - s * x + c * z),
                    rng.uniform(0, 360),
                    size * rng.uniform(0.6, 1.15),
                    material=rng.choice(("leaf", "leaf", "leaf2")),
                )
            )
        objects.extend(parts)
        if images:
            objects.extend(mirror(p) for p in parts)

    tree("oak", (-3.55, 2.5), 200, 0.9)
    tree("ash", (6.9, -1.2), 40, 1.0, images=True)
    tree("ash", (-5.6, -4.0), 120, 1.05)
    tree("ash", (3.9, -6.2), 260, 0.95, images=True)
    tree("ash", (-3.6, -9.5), 310, 1.1, dense=0.8)
    tree("ash", (7.4, 4.4), 10, 0.9)

    placed = []
    while len(placed) < 70:
        z = rng.uniform(-33, -7.5)
        half = 0.76 * (EYE[2] - z)
        x = rng.uniform(-half, half)
        gap = 2.2 + 0.02 * abs(z)
        shade = z - x * MOON[2] / MOON[0]  # where its shadow crosses the middle
        if 2 < x < 13 and -6.5 < shade < 6 and rng.random() > 0.12:
            continue
        if (
            abs(x - path_x(z)) < gap
            or (z > -12 and abs(x) < 7.5)
            or any(math.hypot(x - a, z - b) < 1.5 for a, b in placed)
        ):
            continue
        placed.append((x, z))
        fir = place("conifer", (x, height(x, z) - 0.05, z), rng.uniform(0, 360), rng.uniform(0.6, 1.12))
        objects.append(fir)
        if 1 < x < 13 and z > -26:
            objects.append(mirror(fir))

    def scatter(mesh, count, near, far, spread, fits, sizes, material=None, images=False, sink=0.0):
        made = 0
        while made < count:
            d = near * (far / near) ** rng.random()
            x, z = EYE[0] + rng.uniform(-spread, spread) * (d + 0.8), EYE[2] - d
            if not fits(x, z):
                continue
            made += 1
            size = rng.uniform(*sizes)
            entry = place(
                mesh, (x, height(x, z) - sink * size, z), rng.uniform(0, 360), size, material=material
            )
            objects.append(entry)
            if images and pond(x, z) < 0.25:
                objects.append(mirror(entry))

    def off_path(x, z):
        return pond(x, z) > 0.03 and abs(x - path_x(z)) > 0.62 + 0.3 * noise(x, z)

    scatter(
        "tuft",
        620,
        2.6,
        26,
        0.74,
        lambda x, z: off_path(x, z) and noise(0.7 * x, 0.7 * z, 7) > -0.25,
        (0.5, 0.95),
        "grass",
        images=True,
    )
    scatter(
        "tuft",
        90,
        2.0,
        20,
        0.74,
        lambda x, z: pond(x, z) > 0.03 and 0.45 < abs(x - path_x(z)) < 0.9,
        (0.4, 0.75),
        "grass",
    )
    scatter("tuft", 130, 2.5, 6.5, 0.7, lambda x, z: x > 0.3 and off_path(x, z), (0.3, 0.6), "grass")
    scatter(
        "tuft", 70, 4.5, 7.5, 0.7, lambda x, z: 0.02 < pond(x, z) < 0.13, (0.35, 0.65), "grass", images=True
    )
    scatter(
        "fern",
        60,
        3.0,
        20,
        0.72,
        lambda x, z: off_path(x, z) and abs(x) > 2 and pond(x, z) > 0.2,
        (0.55, 1.0),
        "fern",
    )
    scatter(
        "reeds",
        15,
        5.0,
        14,
        0.72,
        lambda x, z: 0.0 < pond(x, z) < 0.07 and (x > 4.2 or z < -1.5),
        (0.6, 1.0),
        images=True,
    )
    scatter(
        "reeds",
        5,
        5.0,
        9,
        0.72,
        lambda x, z: 0.0 < pond(x, z) < 0.12 and x < 0.1 and z > 0.3,
        (0.55, 0.85),
        images=True,
    )
    for k in range(26):
        angle = rng.uniform(0, 6.283)
        for r in (i * 0.05 for i in range(120)):
            x, z = 2.9 + r * math.cos(angle), -0.3 + r * math.sin(angle)
            if pond(x, z) > -0.02:
                break
        size = rng.choice((0.10, 0.14, 0.18, 0.26, 0.36))
        entry = place(
            rng.choice(("stone1", "stone2")), (x, 0.02, z), rng.uniform(0, 360), size, material="stone"
        )
        objects.extend((entry, mirror(entry)))
    for x, z, size, turn in (
        (-2.5, 5.2, 0.42, 30),
        (-2.95, 5.75, 0.22, 80),
        (1.35, 5.5, 0.30, 130),
        (-0.2, -4.6, 0.55, 20),
        (0.5, -4.9, 0.3, 100),
        (5.2, 3.4, 0.5, 240),
    ):
        objects.append(
            place(
                "stone2" if size > 0.3 else "stone1",
                (x, height(x, z) + 0.05, z),
                turn,
                size,
                material="stone",
            )
        )
    z = 6.6
    while z > -14:
        x = path_x(z) + rng.uniform(-0.16, 0.16)
        objects.append(
            place(
                "slab",
                (x, height(x, z) + 0.005, z),
                rng.uniform(0, 360),
                rng.uniform(0.24, 0.33),
                material="stone",
            )
        )
        z -= rng.uniform(0.62, 0.8)
    for _ in range(40):
        x, z = rng.gauss(3.6, 0.9), rng.gauss(0.6, 0.7)
        if pond(x, z) < -0.1:
            objects.append(
                place("lily", (x, 0, z), rng.uniform(0, 360), rng.uniform(0.10, 0.2), material="lily")
            )

    fields = swarms()
    mesh, glows = flies(fields, 0.09)
    save("flies", mesh, "flies.mtl", smooth=False)
    with open(os.path.join(HERE, FOLDER, "flies.mtl"), "w") as out:
        for (red, green, blue), name in glows.items():
            out.write(
                f"newmtl {name}\nKd 0 0 0\nKe {1.4 * red:.3g} {1.35 * green:.3g} {0.75 * blue:.3g}\nillum 1\n"
            )
    objects.append(place("flies", (0, 0, 0)))
    objects.append({**mirror(objects[-1]), "material": "firefly_image"})

    def matte(color):
        return {"diffuse": color, "double_sided": True}

    scene = {
        "camera": {
            "eye": EYE,
            "target": TARGET,
            "fov_y": FOV_Y,
            "near": 0.2,
            "far": BACKDROP + 3,
            "interpolation": "smooth",
            "keys": [{"frame": frame, "eye": eye, "target": target} for frame, eye, target in WALK],
        },
        "size": [1280, 720],
        "background": FOG_COLOR,
        "ambient": AMBIENT,
        "fog": {"mode": "exp2", "density": FOG_DENSITY, "color": FOG_COLOR},
        "materials": {
            "sky": {"diffuse": 0, "ambient": [round(1 / a, 4) for a in AMBIENT], "double_sided": True},
            "ground": matte([1, 1, 1]),
            "stone": {**matte([1, 1, 1]), "specular": 0.12, "shininess": 24},
            "bark": matte([1, 1, 1]),
            "leaf": matte([0.075, 0.12, 0.035]),
            "leaf2": matte([0.11, 0.125, 0.036]),
            "grass": matte([0.085, 0.135, 0.035]),
            "fern": matte([0.06, 0.125, 0.035]),
            "lily": matte([0.06, 0.13, 0.05]),
            "oak_bark": matte([0.6, 0.6, 0.6]),
            "firefly_image": {"diffuse": 0, "emission": [0.62, 0.46, 0.12]},
        },
        "objects": objects,
        "lights": [
            {
                "type": "directional",
                "direction": MOON,
                "color": [0.46, 0.70, 1.0],
                "intensity": 2.6,
                "shadow": True,
            }
        ],
        "light_fields": fields,
    }
    write_scene(os.path.join(HERE, "fireflies.json"), scene, "make_fireflies.py")


main()
