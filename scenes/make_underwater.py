#!/usr/bin/env python3
"""Writes underwater.json and its meshes in underwater/: a drowned temple under a rippled surface.

The ripples' light is real: a ceiling of cells out of sight above the camera lets the sun through in the gaps
between them, and the sun's shadow map paints the bright net on sand and stone.
"""

import math
import os
import random

from reef import (
    shaft,
    block,
    amphora,
    branch_coral,
    brain_coral,
    sponge,
    kelp,
    sea_grass,
    fish,
    jellyfish,
    boulder,
)
from meshes import Mesh, add, mix, noise, octaves, scaled, smoothstep, write_scene

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = "underwater"

EYE = (0.0, 1.55, 7.2)
TARGET = (0.25, 2.25, -6.0)
FOV_Y = 50.0
BACKDROP = 27.0  # metres ahead of the eye
FOG_DENSITY = (0.21, 0.068, 0.050)
FOG_COLOR = (0.003, 0.046, 0.078)
AMBIENT = (0.05, 0.105, 0.135)
SUN = (-0.36, -1.0, -0.28)  # the way it shines
CEILING = 16.0


# --- The seabed ------------------------------------------------


def height(x, z):
    dune = 0.28 * octaves(0.23 * x + 3, 0.23 * z, count=2) + 0.012 * max(abs(x) - 3.5, 0) ** 2
    near = smoothstep(11, 3, EYE[2] - z)
    crest = z * 2 * math.pi / 0.46 + 2.4 * noise(0.5 * x, 0.5 * z, 3) + 0.9 * x
    return dune + 0.024 * near * (math.sin(crest) + 0.3 * math.sin(2 * crest + 1)) * (
        0.7 + 0.5 * noise(0.8 * x, 0.8 * z, 8)
    )


def sand():
    columns, rows, near, far = 38, 68, 1.5, BACKDROP + 1
    mesh = Mesh()
    for j in range(rows + 1):
        d = near * (far / near) ** (j / rows)
        for i in range(columns + 1):
            x, z = EYE[0] + (2 * i / columns - 1) * (0.92 * d + 0.5), EYE[2] - d
            mesh.vertex((x, height(x, z), z))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            mesh.face((a, a + 1, a + columns + 2, a + columns + 1))
    return mesh


def backdrop():
    """Water far away: brighter towards the surface, with rays fanning out from the sun. What the fog takes is
    put in first. Colours are radiances: the material's ambient coefficient undoes the ambient light."""
    share = [math.exp(-f * BACKDROP) for f in FOG_DENSITY]
    columns, rows, half, low, top = 56, 14, 27.0, -6.0, 19.0
    mesh = Mesh(2)
    for j in range(rows + 1):
        y = low + (top - low) * j / rows
        for i in range(columns + 1):
            x = -half + 2 * half * i / columns
            up = smoothstep(1.5, 19, y)
            fan = (x - 6) / (34 - y) * 30
            ray = smoothstep(-0.15, 0.9, octaves(0.42 * fan, 3.3, 1.0, 2)) * math.exp(-(((x - 2) / 13) ** 2))
            light = up * (0.55 * math.exp(-(((x - 3) / 16) ** 2)) + 0.45) + 0.75 * ray * smoothstep(0, 12, y)
            seen = add(FOG_COLOR, scaled((0.012, 0.155, 0.170), light))
            mesh.vertex(
                (x, y, EYE[2] - BACKDROP),
                tuple(max((s - f * (1 - k)) / k, 0) for s, f, k in zip(seen, FOG_COLOR, share)),
            )
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            mesh.face((a, a + 1, a + columns + 2, a + columns + 1))
    return mesh


def ceiling():
    """A tile of 5 m that repeats: the cells of random points (Voronoi), shrunk, their corners rounded."""
    rng = random.Random(12)
    size, n = 5.0, 9
    points = [
        ((i + rng.uniform(0.1, 0.9)) * size / n, (j + rng.uniform(0.1, 0.9)) * size / n)
        for i in range(n)
        for j in range(n)
    ]
    around = [(x + a * size, z + b * size) for x, z in points for a in (-1, 0, 1) for b in (-1, 0, 1)]
    mesh = Mesh()
    for x, z in points:
        inset = rng.choice((0.005, 0.012, 0.025))
        cell = [(x - 2, z - 2), (x + 2, z - 2), (x + 2, z + 2), (x - 2, z + 2)]
        for u, v in around:
            dx, dz = u - x, v - z
            d = math.hypot(dx, dz)
            if d == 0 or d > 3:
                continue

            def beyond(p):
                return ((p[0] - x) * dx + (p[1] - z) * dz) / d - (d / 2 - inset)

            cut = []
            for a, b in zip(cell, cell[1:] + cell[:1]):
                if beyond(a) <= 0:
                    cut.append(a)
                if (beyond(a) > 0) != (beyond(b) > 0):
                    cut.append(mix(a, b, beyond(a) / (beyond(a) - beyond(b))))
            cell = cut
        for _ in range(2):  # Chaikin's corner cutting
            cell = [p for a, b in zip(cell, cell[1:] + cell[:1]) for p in (mix(a, b, 0.25), mix(a, b, 0.75))]
        if len(cell) > 2:
            mesh.face([mesh.vertex((a - size / 2, 0, b - size / 2)) for a, b in cell])
    return mesh


# --- The scene ------------------------------------------------


def main():
    os.makedirs(os.path.join(HERE, FOLDER), exist_ok=True)
    rng = random.Random(77)
    bell, arms = jellyfish()
    meshes = {
        "sand": sand(),
        "backdrop": backdrop(),
        "ceiling": ceiling(),
        "column": shaft(5.2, False, 1),
        "stump": shaft(2.1, True, 5),
        "drum": shaft(2.6, True, 9),
        "block": block(),
        "amphora": amphora(),
        "coral": branch_coral(3, False),
        "fan": branch_coral(8, True, 5),
        "brain": brain_coral(),
        "sponge": sponge(),
        "kelp": kelp(),
        "seagrass": sea_grass(),
        "fish": fish(),
        "bell": bell,
        "arms": arms,
        "rock1": boulder(1, (1.0, 0.7, 0.85)),
        "rock2": boulder(6, (1.0, 0.9, 0.75)),
    }
    for name, mesh in meshes.items():
        mesh.write(os.path.join(HERE, FOLDER, name + ".obj"), smooth=True)

    objects = []

    def place(mesh, at, turn=(0, 0, 0), size=1.0, material=None):
        entry = {"mesh": f"{FOLDER}/{mesh}.obj", "translate": [round(c, 2) for c in at]}
        if any(turn):
            entry["rotate"] = [round(t) for t in turn]
        if size != 1.0:
            entry["scale"] = [round(s, 2) for s in size] if isinstance(size, tuple) else round(size, 2)
        entry["material"] = material or "stone"
        objects.append(entry)

    def stand(mesh, x, z, turn=0, size=1.0, material=None, sink=0.0, tilt=(0, 0)):
        place(mesh, (x, height(x, z) - sink, z), (tilt[0], turn, tilt[1]), size, material)

    place("sand", (0, 0, 0), material="sand")
    place("backdrop", (0, 0, 0), material="backdrop")
    for i in range(-2, 6):
        for j in range(6):
            place("ceiling", (5.0 * i + 1, CEILING, 12.0 - 5.0 * j), material="stone")

    # Two rows of columns lead into the blue.
    for k, z in enumerate((2.6, -1.4, -5.4, -9.4, -13.4)):
        if k != 1:
            stand("column", -3.7, z, 40 * k)
        if k not in (0, 2):
            stand("column", 3.9, z, 25 * k)
    stand("stump", -3.7, -1.4, 70)
    stand("stump", 3.9, -5.4, 200, 0.9)
    stand("stump", 4.15, 2.3, 20, 0.95)
    for x, z in ((-3.7, -7.4), (-3.7, -11.4), (3.9, -11.4)):
        place("block", (x, height(x, z) + 5.85, z), (0, 0, 0), (1.15, 0.75, 5.0))
    stand("block", 2.2, -3.6, 24, (0.95, 0.8, 3.0), sink=-0.12, tilt=(6, 12))
    place("drum", (0.9, 0.22, -6.6), (0, 28, 88))
    place("drum", (-2.35, 0.27, 1.0), (0, 205, 93), 0.8)
    stand("amphora", 0.95, 2.7, 40, 0.68, "clay", sink=-0.10, tilt=(0, 74))

    # The reef in front, right; a smaller one, left.
    for mesh, x, z, size, turn, sink in (
        ("rock1", 2.45, 3.35, 0.95, 30, 0.1),
        ("rock2", 3.55, 4.1, 0.8, 100, 0.1),
        ("rock2", 2.0, 2.6, 0.5, 210, 0.1),
        ("rock1", -2.15, 3.5, 0.72, 160, 0.15),
        ("rock2", -2.85, 2.9, 0.7, 20, 0.1),
        ("rock1", 5.5, -1.2, 1.6, 50, 0.2),
        ("rock2", -6.0, -2.0, 1.7, 80, 0.2),
        ("rock1", -1.2, -8.8, 1.2, 10, 0.2),
        ("rock2", 7.5, -7.0, 2.4, 10, 0.3),
        ("rock1", -8.5, -9.0, 2.8, 75, 0.3),
    ):
        stand(mesh, x, z, turn, size, sink=sink)
    for mesh, x, y, z, size, turn, material in (
        ("coral", 2.1, 0.58, 3.4, 0.75, 20, "orange"),
        ("coral", 2.7, 0.45, 3.4, 0.9, 140, "crimson"),
        ("fan", 3.1, 0.25, 3.3, 1.0, 15, "violet"),
        ("sponge", 1.6, 0.05, 2.95, 0.8, 60, "yellow"),
        ("brain", 1.4, 0.1, 3.6, 0.45, 0, "ochre"),
        ("brain", 2.95, 0.05, 4.35, 0.42, 90, "rose"),
        ("coral", -2.0, 0.36, 3.55, 0.7, 200, "crimson"),
        ("fan", -2.5, 0.34, 3.25, 0.95, -20, "orange"),
        ("sponge", -2.75, 0.36, 3.2, 0.75, 10, "violet"),
        ("brain", -1.45, 0.05, 3.75, 0.42, 30, "rose"),
        ("coral", -3.6, 2.0, -1.35, 0.7, 90, "rose"),
        ("fan", 4.0, 1.6, -5.2, 1.2, 20, "crimson"),
        ("coral", 4.2, 1.85, 2.35, 0.6, 30, "yellow"),
        ("sponge", 5.3, 0.75, -0.9, 1.1, 30, "orange"),
        ("coral", -5.6, 1.3, -1.7, 1.2, 10, "orange"),
    ):
        place(mesh, (x, y + height(x, z), z), (0, turn, 0), size, material)
    for x, z, size in (
        (-4.7, 2.0, 1.0),
        (-5.2, 1.2, 1.15),
        (-4.9, 0.3, 0.9),
        (-5.9, -0.4, 1.25),
        (5.4, 1.4, 1.1),
        (5.9, 0.6, 1.25),
        (5.2, 0.2, 0.95),
        (-6.5, -5.0, 1.4),
        (-7.4, -6.0, 1.3),
        (7.0, -4.0, 1.35),
        (7.8, -5.2, 1.5),
        (1.9, -11.0, 1.3),
        (1.2, -12.0, 1.1),
    ):
        stand("kelp", x, z, rng.uniform(0, 360), size, "kelp")
    made = 0
    while made < 110:
        d = 2.6 * (16 / 2.6) ** rng.random()
        x, z = rng.uniform(-0.8, 0.8) * d, EYE[2] - d
        if (
            noise(0.55 * x + 9, 0.55 * z, 2) < 0.12
            or (-1.5 < x < 1.3 and z > -4)
            or d < 3.4
            or (-3.2 < x < -1.1 and z > 2.5)
        ):
            continue
        made += 1
        stand("seagrass", x, z, rng.uniform(-30, 30), rng.uniform(0.6, 1.1), "seagrass")

    for _ in range(64):  # a school that turns around the middle
        a, r = rng.uniform(-2.3, 0.6), rng.gauss(3.0, 0.35)
        at = (
            1.2 + r * math.cos(a),
            4.3 + 1.0 * math.sin(a + 0.4) + rng.gauss(0, 0.3),
            -3.2 + 0.8 * r * math.sin(a),
        )
        place(
            "fish",
            at,
            (rng.gauss(0, 6), -math.degrees(a) + 90 + rng.gauss(0, 8), rng.gauss(12, 6)),
            rng.uniform(0.30, 0.48),
            "fish",
        )
    for at, turn, size in (
        ((-0.9, 1.15, 3.4), 15, 0.24),
        ((-1.25, 1.0, 3.1), 25, 0.2),
        ((2.1, 1.55, 3.9), 190, 0.22),
    ):
        place("fish", at, (0, turn, 5), size, "clownfish")

    lights = [
        {
            "type": "directional",
            "direction": SUN,
            "color": [1.0, 0.97, 0.80],
            "intensity": 1.6,
            "shadow": True,
        },
        {"type": "directional", "direction": SUN, "color": [0.62, 0.95, 0.90], "intensity": 0.40},
    ]
    hues = {"cyan": [0.25, 0.85, 1.0], "pink": [1.0, 0.30, 0.85], "lilac": [0.55, 0.45, 1.0]}
    for at, size, hue, lean, shadow in (
        ((-0.75, 3.0, 0.4), 0.62, "cyan", 14, True),
        ((0.75, 2.15, 1.9), 0.36, "pink", -18, True),
        ((1.9, 3.9, -2.0), 0.6, "lilac", 10, False),
        ((-2.1, 2.2, -3.6), 0.5, "pink", 20, False),
        ((0.3, 2.4, -8.0), 0.8, "cyan", -8, False),
        ((-1.2, 4.8, -6.0), 0.6, "lilac", 12, False),
    ):
        for part in ("bell", "arms"):
            place(part, at, (lean, 30, lean), size, f"{hue}_{part}")
        lights.append(
            {
                "type": "point",
                "position": [at[0], round(at[1] - 0.3 * size, 2), at[2]],
                "color": hues[hue],
                "intensity": round(3.2 * size + 0.6, 2),
                "range": round(3 + 3 * size, 2),
                "attenuation": [0.25, 0, 1.4],
                **({"shadow": True} if shadow else {}),
            }
        )
    for at, color in (
        ((2.4, 1.15, 3.95), [1.0, 0.45, 0.12]),
        ((-1.75, 0.85, 3.95), [1.0, 0.35, 0.45]),
        ((1.5, 0.6, 3.5), [0.4, 1.0, 0.5]),
    ):
        lights.append(
            {
                "type": "point",
                "position": at,
                "color": color,
                "intensity": 0.5,
                "range": 1.6,
                "attenuation": [0.2, 0, 4],
            }
        )

    def matte(color, **more):
        return {"diffuse": color, "double_sided": True, **more}

    materials = {
        "sand": matte([0.62, 0.55, 0.40]),
        "stone": matte([1, 1, 1]),
        "clay": matte([0.55, 0.24, 0.12], specular=0.15, shininess=20),
        "backdrop": {"diffuse": 0, "ambient": [round(1 / a, 3) for a in AMBIENT], "double_sided": True},
        "orange": matte([0.95, 0.36, 0.08]),
        "crimson": matte([0.85, 0.08, 0.12]),
        "violet": matte([0.52, 0.20, 0.75]),
        "yellow": matte([0.9, 0.68, 0.12]),
        "ochre": matte([0.62, 0.46, 0.20]),
        "rose": matte([0.85, 0.36, 0.48]),
        "kelp": matte([0.16, 0.20, 0.045]),
        "seagrass": matte([0.10, 0.30, 0.08]),
        "fish": matte([0.55, 0.62, 0.65], specular=0.8, shininess=18),
        "clownfish": matte([0.95, 0.45, 0.08], specular=0.4, shininess=30),
    }
    for hue, c in hues.items():
        materials[f"{hue}_bell"] = matte(
            [0.5 * v for v in c], emission=[round(0.42 * v, 3) for v in c], specular=0.5, shininess=40
        )
        materials[f"{hue}_arms"] = matte([0.5 * v for v in c], emission=[round(0.26 * v, 3) for v in c])
    scene = {
        "camera": {"eye": EYE, "target": TARGET, "fov_y": FOV_Y, "near": 0.2, "far": BACKDROP + 3},
        "size": [1280, 720],
        "background": FOG_COLOR,
        "ambient": AMBIENT,
        "fog": {"mode": "exp", "density": FOG_DENSITY, "color": FOG_COLOR},
        "materials": materials,
        "objects": objects,
        "lights": lights,
    }
    write_scene(os.path.join(HERE, "underwater.json"), scene, "make_underwater.py")


main()
