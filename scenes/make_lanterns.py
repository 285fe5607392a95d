#!/usr/bin/env python3
"""Writes lanterns.json and its meshes in lanterns/: a bay at night, and 180,000 paper lanterns that rise from it.

Each lantern is a light that reaches everywhere, and is seen. Light fields of the same seed and size lie alike, so that
one mesh of a flock's lanterns stands wherever a field of its lights is. The water is a hole with the mirror image of the
world below it, lanterns and lights too: still water shows both, and throws their light back at the cliffs.
"""

import math
import os
import random

from bay import crown, overgrown, ripples, tower, tower_middle, tower_point, tower_reach
from harbour import junk, pagoda, paper_lantern, sampan
from meshes import Mesh, add, dot, mix, scaled, smoothstep, uniforms, write_scene

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = "lanterns"

EYE = (0.0, 9.0, 40.0)
TARGET = (0.0, 38.0, -300.0)
FOV_Y = 40.0
BACKDROP = 2600.0  # metres ahead of the eye
FOG_DENSITY = (0.00078, 0.00098, 0.00112)
FOG_COLOR = (0.016, 0.017, 0.037)
AMBIENT = (0.020, 0.028, 0.060)
# The moon shines along the water: it lights the world and its image alike.
MOON = {"type": "directional", "direction": [0.8, 0, 0.45], "color": [0.075, 0.125, 0.28]}
AMBER = [[1.0, 0.42, 0.10], [1.0, 0.52, 0.15], [1.0, 0.62, 0.24]]
ROSE = [[1.0, 0.25, 0.35], [1.0, 0.35, 0.42], [0.95, 0.3, 0.6]]
TEAL = [[0.2, 0.8, 1.0], [0.3, 0.9, 0.85], [0.35, 0.6, 1.0]]
FLAME = [1.0, 0.55, 0.2]

MATERIALS = {  # of the meshes: diffuse, emission
    "plain": ("1 1 1", "0 0 0"),
    "window": ("0 0 0", "1 .62 .22"),
    "lamp": ("0 0 0", "1.3 .8 .35"),
    "glow1": ("0 0 0", ".62 .21 .04"),
    "glow2": ("0 0 0", "1 .42 .09"),
    "glow3": ("0 0 0", "1.5 .8 .27"),
}

# --- Flocks of lanterns ------------------------------------------------

# Metres from the middle, lights, metres across a lantern, seeds.
FLOCKS = {
    "small": (26.0, 800, 0.62, (1, 2)),
    "middle": (60.0, 2400, 0.62, (3,)),
    "large": (140.0, 2000, 0.8, (5,)),
    "stray": (110.0, 500, 0.8, (6,)),
}


def flock_lights(radius, count, seed):
    """A light field's lights as the renderer makes them, in a cluster around the origin: place, which of 3 colours."""
    places, looks = uniforms(seed), uniforms(~seed & (1 << 64) - 1)

    def in_ball():
        while True:
            p = tuple(2 * next(places) - 1 for _ in range(3))
            if dot(p, p) <= 1:
                return p

    for _ in range(count):
        next(places)  # which cluster: there is one
        a, b = in_ball(), in_ball()
        color = int(next(looks) * 3)
        next(looks), next(looks)  # intensity and range
        yield scaled(add(a, b), 0.5 * radius), color


def flock(radius, count, size, seed):
    """A lantern as a flat shape that faces +z at each of a flock's lights; a triangle where they are many and far."""
    mesh = Mesh(1)
    rng = random.Random(seed)
    for p, color in flock_lights(radius, count, seed):
        w = 0.5 * size * rng.uniform(0.75, 1.2)
        if count < 2000:
            corners = ((-0.62 * w, -1.2 * w), (0.62 * w, -1.2 * w), (w, w), (-w, w))
        else:
            corners = ((0, -1.6 * w), (1.2 * w, w), (-1.2 * w, w))
        mesh.face([mesh.vertex(add(p, (x, y, 0))) for x, y in corners], f"glow{color + 1}")
    return mesh


def flocks(rng):
    """Which and where: a river of light that rises beside the pagoda's isle, and away into the depth; and strays."""

    def along(kind, count, path, stray, grow=0.0):
        for i in range(count):
            at = (len(path) - 1) * (i + 0.5) / count
            k, spread = int(at), stray + grow * i / count
            p = add(mix(path[k], path[k + 1], at - k), tuple(rng.gauss(0, spread) for _ in range(3)))
            yield kind, (p[0], max(p[1], FLOCKS[kind][0] + 1), p[2])

    rise = [(95, 14, -210), (60, 20, -240), (14, 36, -300), (-34, 58, -360), (-30, 88, -420), (30, 118, -480)]
    turn = [(15, 110, -470), (80, 145, -560), (170, 190, -680), (160, 250, -820), (10, 300, -960), (-210, 350, -1080)]
    leave = [(-100, 300, -900), (-330, 385, -1150), (-520, 470, -1400), (-300, 560, -1700), (100, 640, -2000)]
    yield from along("small", 20, rise, 7)
    yield from along("middle", 46, turn, 16, 30)
    yield from along("large", 26, leave, 50)
    for x, y, z in (
        (150, 130, -480),
        (-130, 180, -560),
        (190, 260, -760),
        (-280, 250, -900),
        (20, 111, -330),
        (-60, 111, -300),
        (110, 111, -330),
    ):
        yield "stray", (x, y, z)


# Lamps on the water, so many in a square of so many metres: middle, colours, their mesh's material if not its own.
AFLOAT_COUNT, AFLOAT_HALF, AFLOAT_SEED = 150, 34.0, 9
AFLOAT = [
    (-52, -62, ROSE, "rose"),
    (-66, -120, ROSE, "rose"),
    (18, -135, AMBER, None),
    (84, -140, TEAL, "teal"),
    (70, -215, TEAL, "teal"),
    (-10, -215, AMBER, None),
    (-75, -260, ROSE, "rose"),
    (40, -330, AMBER, None),
    (-20, -430, AMBER, None),
]


def afloat():
    """A lamp at each light of a field in a flat box."""
    mesh, places, angles = Mesh(2), uniforms(AFLOAT_SEED), (0.5, 2.6, 4.7)
    for i in range(AFLOAT_COUNT):
        x, _, z = (AFLOAT_HALF * (2 * next(places) - 1) for _ in range(3))
        low, top = (
            [mesh.vertex((x + r * math.cos(a), y, z + r * math.sin(a))) for a in angles]
            for y, r in ((-0.4, 0.26), (0.05, 0.17))
        )
        for k in range(3):
            n = (k + 1) % 3
            mesh.face((low[k], low[n], top[n], top[k]), f"glow{i % 3 + 1}")
        mesh.face(top, f"glow{i % 3 + 1}")
    return mesh


# --- Stone ------------------------------------------------

TOWERS = {  # seed, radius, height, sides, rings
    "tower1": (1.3, 40, 130, 100, 64),
    "tower2": (5.7, 42, 165, 96, 66),
    "islet": (8.2, 27, 14, 60, 14),
}
PAGODA = (-24.0, 12.6, -240.0)
# mesh, x, z, turn, factors of width and height, how many trees
STANDING = [
    ("tower1", -104, -125, 30, (0.86, 0.86), 150),
    ("tower1", 112, -170, 200, (0.72, 0.72), 110),
    ("islet", PAGODA[0], PAGODA[2], 0, (1, 1), 60),
    ("islet", 62, -120, 130, (0.4, 0.3), 16),
    ("tower2", 150, -330, 70, (0.85, 0.85), 80),
    ("tower1", -120, -390, 300, (1, 1), 80),
    ("tower1", -205, -330, 160, (1.3, 1.3), 60),
    ("tower1", 92, -560, 250, (1.1, 1.1), 50),
    ("tower2", -60, -640, 150, (1.1, 1.1), 50),
    ("tower1", 250, -560, 20, (1.4, 1.4), 40),
    ("tower2", -260, -760, 10, (1.5, 1.5), 30),
    ("tower1", 330, -900, 140, (1.8, 1.8), 0),
    ("tower2", 220, -1250, 220, (1.8, 1.8), 0),
    ("tower1", -160, -1150, 80, (1.9, 1.9), 0),
    ("tower1", -480, -1100, 310, (2.4, 2.4), 0),
    ("tower2", 560, -1300, 45, (2.2, 2.2), 0),
    ("tower1", -330, -1700, 200, (2.6, 2.6), 0),
    ("tower1", 90, -1800, 260, (2.7, 2.7), 0),
    ("tower2", -760, -1800, 120, (2.8, 2.8), 0),
    ("tower2", 700, -1900, 300, (2.8, 2.8), 0),
]


def turned(turn, x, z):
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    return c * x + s * z, c * z - s * x


def buttresses(rng, x, z, size):
    """Pillars that lean on the side of a tower that the camera sees; more and thinner ones on a near tower."""
    for k in range(22 if z > -200 else 6):
        a, r = -0.2 + 3.5 * (k * 0.618034 % 1), 36 * size * rng.uniform(0.80, 1.02)
        wide = size * (rng.uniform(0.1, 0.26) if k > 7 else rng.uniform(0.24, 0.52))
        tall = wide * rng.uniform(0.9, 1.7)
        at = (x + r * math.cos(a), z + r * math.sin(a))
        yield rng.choice(("tower1", "tower2")), *at, rng.uniform(0, 360), (wide, tall), 9


def rocks(rng, x, z, r, count):
    """Around the side of an islet that the camera sees."""
    for _ in range(count):
        a, size = rng.uniform(-0.3, 3.4), rng.uniform(0.06, 0.13)
        yield "tower2", x + r * math.cos(a), z + r * math.sin(a), rng.uniform(0, 360), (1.6 * size, size), 3


def inside(standing, p, gap):
    """Whether a point is in a tower's stone, or less than `gap` metres before it."""
    for mesh, x, z, turn, (wide, high), _ in standing:
        seed, radius, tall, _, _ = TOWERS[mesh]
        t = p[1] / (tall * high)
        if t < 1:
            dx, dz = turned(-turn, (p[0] - x) / wide, (p[2] - z) / wide)
            mx, mz = tower_middle(seed, radius, t)
            reach = tower_reach(seed, radius, tall, math.atan2(dz - mz, dx - mx), t)
            if math.hypot(dx - mx, dz - mz) < reach + gap / wide:
                return True
    return False


def trees(rng, mesh, x, z, turn, factors, count):
    """Crowns on the green parts of a tower that the camera may see."""
    seed, radius, tall, _, _ = TOWERS[mesh]
    wide, high = factors
    made, tries = 0, 0
    while made < count and tries < 40 * count:
        tries += 1
        angle, t = rng.uniform(0, 2 * math.pi), rng.random() ** 0.5 * 0.985
        if overgrown(seed, angle, t) < 0.2 + 0.5 * (1 - t) or t * tall * high < 5:
            continue
        px, py, pz = tower_point(seed, radius, tall, angle, t)
        dx, dz = turned(turn, wide * px, wide * pz)
        if dx * (EYE[0] - x) + dz * (EYE[2] - z) < -0.3 * radius * wide * (EYE[2] - z):
            continue
        made += 1
        size = rng.uniform(0.9, 2.4) * (1 + 0.6 * smoothstep(150, 600, -z))
        crowns = rng.choice(("crown1", "crown2"))
        yield place(crowns, (x + dx, high * py + 0.1 * size, z + dz), rng.uniform(0, 360), size)


def sky():
    """Dusk that is nearly over. What the fog takes is put in first; the material undoes the ambient light."""
    share = [math.exp(-d * BACKDROP) for d in FOG_DENSITY]
    columns, rows, half, top = 20, 24, 2100.0, 1500.0
    mesh = Mesh(1, 3)
    for j in range(rows + 1):
        y = top * (2 * j / rows - 1)
        for i in range(columns + 1):
            x = half * (2 * i / columns - 1)
            seen = mix(FOG_COLOR, (0.003, 0.008, 0.030), smoothstep(0.0, 780.0, abs(y)))
            wide = math.exp(-(((x - 60) / 1500) ** 2 + (y / 600) ** 2))
            near = math.exp(-(((x + 60) / 420) ** 2 + ((abs(y) - 250) / 420) ** 2))
            seen = add(seen, add(scaled((0.16, 0.070, 0.050), wide), scaled((0.11, 0.050, 0.022), near)))
            color = tuple(max((s - f * (1 - k)) / k, 0) for s, f, k in zip(seen, FOG_COLOR, share))
            mesh.vertex((x, y, EYE[2] - BACKDROP), color)
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            mesh.face((a, a + 1, a + columns + 2, a + columns + 1))
    return mesh


# --- The scene ------------------------------------------------


def place(mesh, at, turn=0.0, factors=1.0, material=None):
    entry = {"mesh": f"{FOLDER}/{mesh}.obj", "translate": [round(c, 1) for c in at]}
    if turn:
        entry["rotate"] = [0, round(turn) % 360, 0]
    if isinstance(factors, tuple):
        entry["scale"] = [round(factors[k], 2) for k in (0, 1, 0)]
    elif factors != 1.0:
        entry["scale"] = round(factors, 2)
    if material:
        entry["material"] = material
    return entry


def mirror(entry, flocking):
    """The water's image of an object that stands upright, a flock's somewhat dimmer."""
    size = entry.get("scale", 1)
    size = size if isinstance(size, list) else [size] * 3
    x, y, z = entry["translate"]
    image = {**entry, "translate": [x, -y, z], "scale": [size[0], -size[1], size[2]]}
    return {**image, "material": "glow"} if flocking else image


def is_reflected(entry):
    """Whether its image is worth a place; of far trees it isn't, and of high ones it lies below the picture."""
    x, y, z = entry["translate"]
    return "crown" not in entry["mesh"] or (z > -270 and y + EYE[1] < 0.29 * (EYE[2] - z))


def mirror_field(field):
    """Where the images are: they lie otherwise there, by the same density."""
    (x0, y0, z0), (x1, y1, z1) = field["min"], field["max"]
    return {**field, "min": [x0, -y1, z0], "max": [x1, -y0, z1]}


def write_meshes(rng):
    folder = os.path.join(HERE, FOLDER)
    os.makedirs(folder, exist_ok=True)

    def save(name, mesh, mtl="lanterns.mtl", smooth=True):
        mesh.write(os.path.join(folder, name + ".obj"), mtl, smooth)

    with open(os.path.join(folder, "lanterns.mtl"), "w") as out:
        for name, (diffuse, emission) in MATERIALS.items():
            out.write(f"newmtl {name}\nKa {diffuse}\nKd {diffuse}\nKe {emission}\nillum 1\n")
    for name, shape in TOWERS.items():
        save(name, tower(*shape))
    save("crown1", crown(1))
    save("crown2", crown(2))
    save("junk", junk()[0])
    save("sampan", sampan()[0])
    save("pagoda", pagoda()[0], smooth=False)
    save("afloat", afloat(), smooth=False)
    for name, (radius, count, size, seeds) in FLOCKS.items():
        for seed in seeds:
            save(f"{name}{seed}", flock(radius, count, size, seed), smooth=False)
    save("sky", sky(), None)
    save("lantern", paper_lantern(), None)
    save("ripples", ripples(rng, EYE, 1350), None, smooth=False)


def near_lanterns(rng, standing):
    """Those that are seen as more than dots: place, radius. None is before the pagoda or the nearest ship."""
    yield from (((-9, 19, 2), 0.55), ((-14.5, 12.2, -18), 0.6), ((13, 23, -12), 0.6), ((19, 13.5, -26), 0.6))
    yield from (((4.5, 29, -40), 0.7), ((-26, 33, -44), 0.7), ((33, 36, -50), 0.7))
    for k in range(115):
        z = -rng.uniform(50, 190)
        x = rng.uniform(-0.62, 0.62) * (EYE[2] - z)
        if k > 90:  # before the cliff on the right
            x, z = rng.uniform(58, 112), rng.uniform(-145, -95)
        y = rng.uniform(7, 0.42 * (EYE[2] - z))
        if math.hypot(x - 34, y - 14) > 16 and abs(x + 24) > 9 and not inside(standing, (x, y, z), 4.0):
            yield (x, y, z), rng.uniform(0.6, 0.85)


def main():
    rng = random.Random(19)
    write_meshes(rng)
    standing = list(STANDING)
    for mesh, x, z, _, (wide, _), count in STANDING:
        if mesh == "islet":
            standing.extend(rocks(rng, x, z, 25 * wide, round(9 * wide)))
        elif count:
            standing.extend(buttresses(rng, x, z, wide))

    objects, lamps = [], []
    for mesh, x, z, turn, factors, count in standing:
        objects.append(place(mesh, (x, 0, z), turn, factors))
        objects.extend(trees(rng, mesh, x, z, turn, factors, count))

    def lamp(at, intensity):
        lamps.append({"type": "point", "position": [round(c, 2) for c in at], "color": FLAME, "intensity": intensity})

    def with_lamps(name, places, at, turn, intensity, material=None):
        objects.append(place(name, at, turn, material=material))
        for x, y, z in places:
            dx, dz = turned(turn, x, z)
            lamp(add(at, (dx, y, dz)), intensity)

    with_lamps("pagoda", pagoda()[1], PAGODA, 0, 5)
    for x, z, turn in ((34, -78, 205), (-38, -150, 20), (12, -330, 160), (-62, -300, 10), (70, -420, 200)):
        with_lamps("junk", junk()[1], (x, 0, z), turn, 14)
    with_lamps("sampan", sampan()[1], (-8, 0, -3), -14, 2.5, "plain")
    for (x, y, z), size in zip(sampan()[1], (0.34, 0.2)):
        dx, dz = turned(-14, x, z)
        objects.append(place("lantern", (-8 + dx, y, -3 + dz), 0, size, "paper"))
    for at, size in near_lanterns(rng, standing):
        objects.append(place("lantern", at, rng.uniform(0, 360), size, "paper"))
        lamp(add(at, (0, -0.4 * size, 0)), 24)

    fields, swarm = [], []
    for i, (kind, at) in enumerate(flocks(rng)):
        radius, count, _, seeds = FLOCKS[kind]
        seed, at = seeds[i % len(seeds)], [round(c, 1) for c in at]
        swarm.append(place(f"{kind}{seed}", at))
        field = {"count": count, "seed": seed, "shape": "clusters", "clusters": 1, "min": at, "max": at, "radius": radius}
        fields.append({**field, "colors": AMBER, "intensity": [0.4, 1.4]})
    for x, z, colors, material in AFLOAT:
        objects.append(place("afloat", (x, 0.4, z), material=material))
        box = {"min": [x - AFLOAT_HALF, 0.35, z - AFLOAT_HALF], "max": [x + AFLOAT_HALF, 0.45, z + AFLOAT_HALF]}
        fields.append({"count": AFLOAT_COUNT, "seed": AFLOAT_SEED, **box, "colors": colors, "intensity": [0.8, 2.4]})

    lamps += [{**one, "position": [one["position"][0], -one["position"][1], one["position"][2]]} for one in lamps]
    fields += [mirror_field(one) for one in fields]
    everywhere = {"attenuation": [0, 0, 1]}
    shown = [1 / a for a in AMBIENT]  # by ambient light: the very colours of a mesh
    scene = {
        "camera": {"eye": list(EYE), "target": list(TARGET), "fov_y": FOV_Y, "near": 1.0, "far": 4000.0},
        "size": [1920, 1080],
        "background": list(FOG_COLOR),
        "ambient": list(AMBIENT),
        "fog": {"mode": "exp", "density": list(FOG_DENSITY), "color": list(FOG_COLOR)},
        "materials": {
            "sky": {"diffuse": 0, "ambient": shown, "double_sided": True},
            "paper": {"diffuse": 0, "ambient": shown, "double_sided": True},
            "plain": {"diffuse": 1, "double_sided": True},
            "water": {"diffuse": [0.02, 0.03, 0.05], "emission": [0.014, 0.016, 0.034], "double_sided": True},
            "glow": {"diffuse": 0, "emission": [0.78, 0.34, 0.08], "double_sided": True},
            "rose": {"diffuse": 0, "emission": [1.0, 0.35, 0.45], "double_sided": True},
            "teal": {"diffuse": 0, "emission": [0.35, 0.95, 1.0], "double_sided": True},
        },
        "objects": [
            place("sky", (0, 0, 0), material="sky"),
            *objects,
            *swarm,
            *(mirror(one, False) for one in objects if is_reflected(one)),
            *(mirror(one, True) for one in swarm),
            place("ripples", (0, 0, 0), material="water"),
        ],
        "lights": [MOON, *({**one, **everywhere} for one in lamps)],
        "light_fields": [{**one, **everywhere} for one in fields],
    }
    write_scene(os.path.join(HERE, "lanterns.json"), scene, "make_lanterns.py")


if __name__ == "__main__":
    main()
