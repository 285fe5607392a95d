"""The meshes of fireflies.json that stand in more than one place: trees, grasses, stones."""

import math
import random

from meshes import Mesh, add, cross, dot, mix, noise, octaves, rock, scaled, smoothstep, sub, unit

# --- What grows ------------------------------------------------


def grow(mesh, rng, start, ahead, length, radius, depth, tips, sides):
    """A bough as a bent tube, boughs on it, and the places of its leaves in `tips`."""
    points, radii, steps = [start], [radius], 5
    end_radius = radius * (0.62 if depth else 0.3)
    for i in range(1, steps + 1):
        bend = tuple(rng.gauss(0, 0.17) for _ in range(3))
        lift = 0.10 if depth < 3 else 0.02
        ahead = unit(add(add(ahead, bend), (0, lift, 0)))
        points.append(add(points[-1], scaled(ahead, length / steps)))
        radii.append(radius + (end_radius - radius) * i / steps)
    if depth == 0:
        radii[-1] = 0
        tips.extend((points[3], points[5]))
    mesh.tube(points, radii, sides, color=bark_color)
    if depth == 0:
        return
    turn = rng.uniform(0, 6.28)
    for k in range(3 if depth > 1 else 4):
        at = points[steps - (k + 1) // 2] if k else points[-1]
        turn += 2.4 + rng.uniform(-0.4, 0.4)
        side = unit(cross(ahead, (math.cos(turn), 0.31, math.sin(turn))))
        spread = rng.uniform(0.55, 1.1)
        grow(
            mesh,
            rng,
            at,
            unit(add(ahead, scaled(side, spread))),
            length * rng.uniform(0.62, 0.8),
            end_radius * 0.72,
            depth - 1,
            tips,
            max(sides - 2, 3),
        )


def bark_color(p):
    """Streaks along the trunk, moss near the ground."""
    t = 0.5 + 0.5 * octaves(7 * p[0], 1.1 * p[1], 7 * p[2], 2)
    moss = 0.8 * smoothstep(0.9, 0.0, p[1]) * smoothstep(-0.3, 0.5, noise(5 * p[0], 3 * p[1], 5 * p[2]))
    return mix(mix((0.022, 0.018, 0.016), (0.095, 0.074, 0.056), t), (0.055, 0.085, 0.025), moss)


def broadleaf(seed, trunk, radius, lean, depth):
    """A trunk with roots and boughs. Returns its mesh and where its leaf clumps go."""
    rng = random.Random(seed)
    mesh = Mesh()
    points = [(0, -0.25, 0), (0, 0.0, 0)]
    radii = [radius * 2.0, radius * 1.55]
    for i in range(1, 15):
        t = i / 14
        points.append(
            (
                lean[0] * t * t + 0.10 * math.sin(3.1 * t + seed),
                trunk * t,
                lean[1] * t * t + 0.08 * math.sin(4 * t),
            )
        )
        radii.append(radius * (1 - 0.36 * t + 0.5 * math.exp(-9 * t)))
    mesh.tube(points, radii, 20, color=bark_color, wobble=0.26, seed=seed)
    for k in range(5):
        angle = 6.283 * k / 5 + rng.uniform(-0.3, 0.3)
        c, s, reach = math.cos(angle), math.sin(angle), radius * rng.uniform(2.6, 4.2)
        along = [0.25 * reach + 0.75 * reach * i / 5 for i in range(6)]
        mesh.tube(
            [
                (c * d, 1.5 * radius * math.exp(-2.2 * d / radius) * 2.4 - 0.10 * d / reach, s * d)
                for d in along
            ],
            [radius * (0.46 - 0.07 * i) for i in range(6)],
            6,
            color=bark_color,
        )
    tips = []
    ahead = unit(sub(points[-1], points[-2]))
    for k in range(4):
        angle = 6.283 * k / 4 + rng.uniform(-0.5, 0.5)
        out = (math.cos(angle) * 0.95, 0.45, math.sin(angle) * 0.95)
        grow(
            mesh,
            rng,
            points[-1 - 2 * (k % 3)],
            unit(add(ahead, out)),
            trunk * rng.uniform(0.5, 0.72),
            radius * 0.46,
            depth,
            tips,
            5,
        )
    return mesh, tips


def leaf_clump():
    rng = random.Random(5)
    mesh = Mesh(2)
    for _ in range(108):
        while True:
            p = tuple(rng.uniform(-1, 1) for _ in range(3))
            if dot(p, p) < 1:
                break
        at = (0.55 * p[0], 0.38 * p[1], 0.55 * p[2])
        along = unit(add(add(p, (0, -0.35, 0)), tuple(rng.gauss(0, 0.5) for _ in range(3))))
        across = unit(cross(along, tuple(rng.gauss(0, 1) for _ in range(3))))
        length, width = rng.uniform(0.13, 0.21), rng.uniform(0.035, 0.055)
        middle = add(at, scaled(along, 0.45 * length))
        mesh.face(
            [
                mesh.vertex(q)
                for q in (
                    at,
                    add(middle, scaled(across, width)),
                    add(at, scaled(along, length)),
                    sub(middle, scaled(across, width)),
                )
            ]
        )
    return mesh


def conifer():
    """Drooping boughs in whorls, each with needles as jagged wedges on both sides."""
    rng = random.Random(8)
    mesh = Mesh(2)
    tall = 10.0
    mesh.tube([(0, -0.3, 0), (0, 3, 0), (0.05, 6.5, 0), (0, tall, 0)], [0.24, 0.17, 0.09, 0], 7, "bark")
    y = 1.5
    while y < tall - 0.25:
        t = y / tall
        reach = 2.35 * (1 - t) ** 0.8 + 0.12
        for k in range(7 if t < 0.75 else 5):
            angle = rng.uniform(0, 6.283) if t > 0.9 else 6.283 * k / 7 + rng.uniform(-0.4, 0.4) + 2.1 * y
            c, s = math.cos(angle), math.sin(angle)
            length = reach * rng.uniform(0.65, 1.12)
            droop = rng.uniform(0.25, 0.5)
            spine = [
                (c * length * u, y + length * (0.10 * u - droop * u * u), s * length * u)
                for u in (0, 0.35, 0.7, 1)
            ]
            indices = [mesh.vertex(p) for p in spine]
            for i in range(3):
                half = 0.24 * length * (1 - 0.22 * i)
                for sign in (-1, 1):
                    back = add(
                        spine[i + 1],
                        (
                            c * 0.1 * length - s * sign * half,
                            -0.22 * half - rng.uniform(0, 0.12),
                            s * 0.1 * length + c * sign * half,
                        ),
                    )
                    mesh.face(
                        (
                            (indices[i], mesh.vertex(back), indices[i + 1])
                            if i < 2
                            else (indices[i], mesh.vertex(mix(back, spine[i], 0.35)), indices[i + 1])
                        ),
                        "needles",
                    )
        y += 0.36 + 0.12 * (1 - t)
    return mesh


def blade(mesh, rng, root, tall, lean, width, steps=2):
    angle = rng.uniform(0, 6.283)
    out = (math.cos(angle), math.sin(angle))
    side = (-out[1], out[0])
    rows = []
    for i in range(steps):
        t = i / steps
        w = width * (1 - 0.55 * t)
        x, y, z = (
            root[0] + out[0] * lean * t * t,
            root[1] + tall * t * (1 - 0.2 * t),
            root[2] + out[1] * lean * t * t,
        )
        rows.append(
            (
                mesh.vertex((x - side[0] * w, y, z - side[1] * w)),
                mesh.vertex((x + side[0] * w, y, z + side[1] * w)),
            )
        )
    tip = mesh.vertex((root[0] + out[0] * lean, root[1] + 0.8 * tall, root[2] + out[1] * lean))
    for (a, b), (c, d) in zip(rows, rows[1:]):
        mesh.face((a, b, d, c))
    mesh.face((rows[-1][0], rows[-1][1], tip))


def grass_tuft():
    rng = random.Random(3)
    mesh = Mesh()
    for _ in range(34):
        r, a = 0.30 * math.sqrt(rng.random()), rng.uniform(0, 6.283)
        blade(
            mesh,
            rng,
            (r * math.cos(a), -0.05, r * math.sin(a)),
            rng.uniform(0.16, 0.48) * (1.15 - r),
            rng.uniform(0.04, 0.24),
            rng.uniform(0.008, 0.014),
        )
    return mesh


def reeds():
    rng = random.Random(4)
    mesh = Mesh()
    for _ in range(16):
        r, a = 0.32 * math.sqrt(rng.random()), rng.uniform(0, 6.283)
        blade(
            mesh,
            rng,
            (r * math.cos(a), -0.05, r * math.sin(a)),
            rng.uniform(0.7, 1.35),
            rng.uniform(0.05, 0.4),
            rng.uniform(0.009, 0.014),
            3,
        )
    for _ in range(4):
        x, z, tall = rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(1.1, 1.45)
        tx, tz = x + rng.uniform(-0.1, 0.1), z + rng.uniform(-0.1, 0.1)
        mesh.tube([(x, -0.05, z), (tx, tall, tz)], [0.007, 0.005], 4)
        mesh.tube(
            [(tx, tall - 0.02, tz), (tx, tall, tz), (tx, tall + 0.15, tz), (tx, tall + 0.17, tz)],
            [0.004, 0.022, 0.022, 0.003],
            6,
            "cattail",
        )
    return mesh


def fern():
    rng = random.Random(6)
    mesh = Mesh()
    for k in range(8):
        angle = 6.283 * k / 8 + rng.uniform(-0.3, 0.3)
        c, s = math.cos(angle), math.sin(angle)
        length, tall = rng.uniform(0.45, 0.7), rng.uniform(0.28, 0.45)

        def spine(t):
            return (c * length * t, tall * (2.1 * t - 1.75 * t * t), s * length * t)

        for i in range(1, 10):
            t = i / 10
            p, q = spine(t), spine(t + 0.1)
            leaf = 0.17 * math.sin(math.pi * min(t * 0.95 + 0.12, 1)) + 0.01
            for sign in (-1, 1):
                tip = add(mix(p, q, 1.1), (-s * sign * leaf, -0.25 * leaf, c * sign * leaf))
                mesh.face((mesh.vertex(p), mesh.vertex(tip), mesh.vertex(q)))
    return mesh


def stone(seed, size, roughness):
    mesh = Mesh()
    rng = random.Random(seed)

    def moss(d):
        t = smoothstep(0.1, 0.75, d[1] + 0.45 * noise(4 * d[0], 4 * d[1], 4 * d[2] + seed))
        return mix((0.15, 0.15, 0.155), (0.060, 0.085, 0.030), t)

    rock(mesh, rng, size, roughness, 10, 16, moss)
    return mesh


def lily_pad():
    mesh = Mesh()
    middle = mesh.vertex((0, 0.01, 0))
    rim = [
        mesh.vertex((math.cos(a), 0.012 + 0.035 * (k % 2), math.sin(a)))
        for k, a in enumerate(0.16 + (6.283 - 0.32) * i / 14 for i in range(15))
    ]
    for a, b in zip(rim, rim[1:]):
        mesh.face((middle, b, a))
    return mesh
