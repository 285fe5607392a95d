"""The meshes of underwater.json that stand in more than one place: the temple, and what lives in it."""

import math
import random

from meshes import Mesh, add, cross, mix, noise, octaves, rock, scaled, smoothstep, unit

# --- The temple ------------------------------------------------


def shaft(tall, broken, seed):
    """A fluted shaft on a base; its top is a capital, or a fracture. Greener where things grow on it."""
    mesh = Mesh(3, 2)
    flutes, per = 16, 3
    sides = flutes * per

    def ring(y, radius, fluted):
        corners = []
        for k in range(sides):
            a = 2 * math.pi * k / sides
            r = radius * (
                1
                - fluted * 0.085 * math.sin(math.pi * (k % per) / per) ** 0.7
                + 0.02 * noise(4 * math.cos(a), y * 2, 4 * math.sin(a) + seed)
            )
            top = y + (
                0.42 * octaves(1.6 * math.cos(a) + seed, 1.6 * math.sin(a)) if broken and y == tall else 0
            )
            grown = smoothstep(-0.05, 0.5, octaves(2.2 * math.cos(a), 1.1 * y + seed, 2.2 * math.sin(a)))
            corners.append(
                mesh.vertex(
                    (r * math.cos(a), top, r * math.sin(a)),
                    mix((0.52, 0.50, 0.44), (0.20, 0.25, 0.13), grown),
                )
            )
        return corners

    profile = [
        (-0.4, 0.66, 0),
        (0.12, 0.66, 0),
        (0.17, 0.60, 0),
        (0.24, 0.62, 0),
        (0.30, 0.52, 0),
        (0.36, 0.48, 1),
    ]
    steps = max(2, round(tall / 0.9))
    profile += [
        (0.36 + (tall - 0.36) * i / steps, 0.48 - 0.018 * tall * i / steps, 1) for i in range(1, steps + 1)
    ]
    if not broken:
        r = profile[-1][1]
        profile += [
            (tall + 0.03, r, 0),
            (tall + 0.08, r + 0.05, 0),
            (tall + 0.26, r + 0.26, 0),
            (tall + 0.30, r + 0.27, 0),
        ]
    rings = [ring(*p) for p in profile]
    for a, b in zip(rings, rings[1:]):
        for k in range(sides):
            n = (k + 1) % sides
            mesh.face((a[k], b[k], b[n], a[n]))
    for corners, y in (
        (rings[0][::-1], profile[0][0]),
        (rings[-1], tall - 0.05 if broken else profile[-1][0]),
    ):
        middle = mesh.vertex((0, y, 0), (0.34, 0.33, 0.27))
        rim = [mesh.vertex(mesh.vertices[c - 1], mesh.colors[c - 1]) for c in corners]
        for a, b in zip(rim, rim[1:] + rim[:1]):
            mesh.face((a, middle, b))
    return mesh


def block():
    """A weathered beam, 1 × 1 × 1 around its middle."""
    mesh = Mesh(3, 2)
    n = 5

    def put(axis, sign, u, v):
        p = [0.0, 0.0, 0.0]
        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = sign * 0.5, u - 0.5, v - 0.5
        worn = 1 - 0.10 * max(sum(abs(c) for c in p) - 0.95, 0) + 0.03 * octaves(5 * p[0], 5 * p[1], 5 * p[2])
        p = tuple(c * worn for c in p)
        return mesh.vertex(
            p,
            mix(
                (0.50, 0.48, 0.42),
                (0.20, 0.25, 0.13),
                smoothstep(0.0, 0.5, octaves(3 * p[0], 3 * p[1] + 4, 3 * p[2])),
            ),
        )

    for axis in range(3):
        for sign in (-1, 1):
            grid = [[put(axis, sign, i / n, j / n) for j in range(n + 1)] for i in range(n + 1)]
            for i in range(n):
                for j in range(n):
                    mesh.face((grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]))
    return mesh


def amphora():
    mesh = Mesh()
    outline = [
        (0, 0.03),
        (0.1, 0.10),
        (0.28, 0.19),
        (0.5, 0.24),
        (0.68, 0.22),
        (0.8, 0.13),
        (0.88, 0.075),
        (1.0, 0.075),
        (1.04, 0.11),
        (1.06, 0.10),
        (1.02, 0.06),
        (0.9, 0.05),
    ]
    mesh.tube([(0, y, 0) for y, _ in outline], [r for _, r in outline], 20)
    for sign in (-1, 1):
        mesh.tube(
            [(sign * x, y, 0) for x, y in ((0.07, 0.98), (0.17, 1.0), (0.24, 0.9), (0.2, 0.72))],
            [0.022] * 4,
            6,
        )
    return mesh


# --- What lives ------------------------------------------------


def branch_coral(seed, flat, depth=4):
    """Forking tubes: a bush, or a fan where `flat`."""
    rng = random.Random(seed)
    mesh = Mesh()

    def fork(start, ahead, length, radius, level):
        bend = add(ahead, tuple(rng.gauss(0, 0.15) for _ in range(3)))
        if flat:
            bend = (bend[0], bend[1], 0.15 * bend[2])
        bend = unit(bend)
        middle, end = add(start, scaled(ahead, length / 2)), add(
            add(start, scaled(ahead, length / 2)), scaled(bend, length / 2)
        )
        mesh.tube(
            [start, middle, end, add(end, scaled(bend, 0.5 * radius))],
            [radius, radius * 0.85, radius * 0.75, 0],
            5,
        )
        if level == 0:
            return
        turn = rng.uniform(0, 6.283)
        for k in range(3 if level == depth and not flat else 2):
            if flat:
                side = ((-1) ** k * rng.uniform(0.4, 0.8), 0.1, rng.gauss(0, 0.06))
            else:
                a = turn + k * 6.283 / (3 if level == depth else 2)
                side = (0.75 * math.cos(a), 0.25, 0.75 * math.sin(a))
            fork(
                end,
                unit(add(bend, side)),
                min(length, 0.26) * rng.uniform(0.7, 0.95),
                radius * 0.74,
                level - 1,
            )

    for k in range(1 if flat else 2):
        fork((0.06 * k, -0.3, 0.05 * k), unit((0.3 * k - 0.1, 1, 0.2 * k)), 0.5, 0.05, depth)
    return mesh


def brain_coral():
    mesh = Mesh()

    def shape(d):
        r = (
            0.5
            + 0.035 * abs(math.sin(9 * noise(2.4 * d[0] + 3, 2.4 * d[1], 2.4 * d[2])))
            + 0.03 * noise(2 * d[0], 2 * d[1], 2 * d[2])
        )
        return (r * d[0], 0.75 * r * d[1], r * d[2])

    mesh.ball(shape, 18, 30)
    return mesh


def sponge():
    rng = random.Random(9)
    mesh = Mesh()
    for _ in range(7):
        x, z = rng.uniform(-0.22, 0.22), rng.uniform(-0.22, 0.22)
        tall, r = rng.uniform(0.35, 0.95), rng.uniform(0.06, 0.1)
        lx, lz = 0.9 * x, 0.9 * z
        mesh.tube(
            [
                (x, -0.1, z),
                (x + 0.3 * lx, 0.5 * tall, z + 0.3 * lz),
                (x + lx, tall, z + lz),
                (x + 1.02 * lx, tall + 0.02, z + 1.02 * lz),
                (x + lx, tall - 0.02, z + lz),
                (x + 0.8 * lx, 0.7 * tall, z + 0.8 * lz),
            ],
            [0.75 * r, r, 1.15 * r, 1.05 * r, 0.85 * r, 0.5 * r],
            13,
        )
    return mesh


def kelp():
    """A stem with long rippled leaves on both sides, 6 m tall."""
    rng = random.Random(7)
    mesh = Mesh(2)
    stem = [
        (0.25 * math.sin(0.8 * y), y - 0.2, 0.2 * math.sin(0.6 * y + 1)) for y in (0.5 * i for i in range(13))
    ]
    mesh.tube(stem, [0.028 - 0.0015 * i for i in range(13)], 5)
    for i in range(1, 48):
        t = i / 48 * 12
        at = mix(stem[int(t)], stem[min(int(t) + 1, 12)], t - int(t))
        angle = 2.4 * i + rng.uniform(-0.4, 0.4)
        out = (math.cos(angle), 0.55 + rng.uniform(-0.2, 0.2), math.sin(angle))
        across = unit(cross(out, (0.2, 1, 0.1)))
        length = rng.uniform(0.5, 0.85)
        rows = []
        for k in range(5):
            u = k / 5
            c = add(at, (out[0] * length * u, out[1] * length * u - 0.25 * u * u, out[2] * length * u))
            w = 0.085 * math.sin(math.pi * (0.12 + 0.85 * u))
            wave = 0.035 * math.sin(5 * u + i)
            rows.append(
                (
                    mesh.vertex(add(c, add(scaled(across, w), (0, wave, 0)))),
                    mesh.vertex(add(c, add(scaled(across, -w), (0, -wave, 0)))),
                )
            )
        tip = mesh.vertex(add(at, (out[0] * length, out[1] * length - 0.27, out[2] * length)))
        for (a, b), (c, d) in zip(rows, rows[1:]):
            mesh.face((a, c, d, b))
        mesh.face((rows[-1][0], tip, rows[-1][1]))
    return mesh


def sea_grass():
    rng = random.Random(10)
    mesh = Mesh()
    for _ in range(26):
        r, a = 0.3 * math.sqrt(rng.random()), rng.uniform(0, 6.283)
        x, z, tall, width = r * math.cos(a), r * math.sin(a), rng.uniform(0.3, 0.75), rng.uniform(0.01, 0.018)
        lean, sway = rng.uniform(-0.05, 0.28), rng.uniform(0, 6.283)
        turn = rng.uniform(0, 3.14)
        rows = []
        for k in range(4):
            t = k / 4
            c = (
                x + lean * t * t + 0.04 * math.sin(4 * t + sway),
                tall * t - 0.05,
                z + 0.04 * math.sin(3 * t + sway),
            )
            w = width * (1 - 0.5 * t)
            side = (w * math.cos(turn), 0, w * math.sin(turn))
            rows.append((mesh.vertex(add(c, side)), mesh.vertex(add(c, scaled(side, -1)))))
        tip = mesh.vertex((x + lean + 0.04 * math.sin(4 + sway), tall, z))
        for (a1, b1), (c1, d1) in zip(rows, rows[1:]):
            mesh.face((a1, b1, d1, c1))
        mesh.face((rows[-1][0], rows[-1][1], tip))
    return mesh


def fish():
    """Swims towards +x, 1 long."""
    mesh = Mesh()
    outline = [
        (0.5, 0.005, 0),
        (0.42, 0.09, 0.05),
        (0.2, 0.17, 0.075),
        (-0.1, 0.14, 0.06),
        (-0.32, 0.05, 0.02),
        (-0.36, 0.045, 0.012),
    ]
    previous = None
    for x, tall, wide in outline:
        ring = [
            mesh.vertex((x, tall * math.sin(a), wide * math.cos(a)))
            for a in (6.283 * k / 8 for k in range(8))
        ]
        if previous:
            for k in range(8):
                mesh.face((previous[k], ring[k], ring[(k + 1) % 8], previous[(k + 1) % 8]))
        previous = ring
    for points in (
        ((-0.34, 0.0), (-0.52, 0.17), (-0.45, 0.0), (-0.52, -0.17)),
        ((0.15, 0.15), (-0.02, 0.27), (-0.2, 0.1), (0.0, 0.12)),
    ):
        mesh.face([mesh.vertex((x, y, 0)) for x, y in points])
    return mesh


def jellyfish():
    rng = random.Random(13)
    bell, arms = Mesh(), Mesh()
    outline = [
        (0.50, 0.02),
        (0.49, 0.14),
        (0.44, 0.28),
        (0.34, 0.41),
        (0.20, 0.49),
        (0.07, 0.54),
        (-0.06, 0.55),
        (-0.12, 0.52),
        (-0.09, 0.48),
        (0.08, 0.44),
        (0.25, 0.30),
        (0.34, 0.1),
    ]
    previous = None
    for n, (y, radius) in enumerate(outline):
        ring = []
        for k in range(32):
            a = 2 * math.pi * k / 32
            r = radius * (1 + 0.05 * math.cos(8 * a) * min(n / 6, 1))
            ring.append(bell.vertex((r * math.cos(a), y, r * math.sin(a))))
        if previous:
            for k in range(32):
                bell.face((previous[k], previous[(k + 1) % 32], ring[(k + 1) % 32], ring[k]))
        previous = ring
    for k in range(20):
        a = 6.283 * k / 20 if k < 14 else rng.uniform(0, 6.283)
        r = 0.5 if k < 14 else 0.14
        long, sway = rng.uniform(1.0, 1.9), rng.uniform(0, 6.283)
        points = [
            (
                r * (1 - 0.3 * t) * math.cos(a) + 0.09 * t * math.sin(5 * t + sway),
                -0.05 - long * t,
                r * (1 - 0.3 * t) * math.sin(a) + 0.09 * t * math.cos(4 * t + sway),
            )
            for t in (i / 9 for i in range(10))
        ]
        thick = 0.010 if k < 14 else 0.034
        arms.tube(points, [thick * (1 - 0.09 * i) if i < 9 else 0 for i in range(10)], 3 if k < 14 else 5)
    return bell, arms


def boulder(seed, size):
    mesh = Mesh()
    rng = random.Random(seed)

    def grown(d):
        t = smoothstep(0.0, 0.6, d[1] * 0.6 + octaves(2 * d[0] + seed, 2 * d[1], 2 * d[2]))
        return mix((0.17, 0.155, 0.15), (0.16, 0.20, 0.10), t)

    rock(mesh, rng, size, 0.42, 17, 26, grown)
    return mesh
