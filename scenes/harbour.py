"""What people made in lanterns.json: a pagoda, ships, a boat, a paper lantern. Each stands on y = 0; what would be below
the water is left out. A mesh with lamps comes with their places."""

import math

from meshes import Mesh, add, mix, noise, scaled

WHITE = (1, 1, 1)
BAMBOO = (0.3, 0.22, 0.12)


def lamp(mesh, at, size, rings, sides):
    mesh.ball(lambda d: add(at, (size * d[0], 1.25 * size * d[1], size * d[2])), rings, sides, "lamp", lambda d: WHITE)


def pagoda():
    """Seven storeys with eight sides, 44 m, and a lamp under each corner of the eaves."""
    mesh, lamps = Mesh(2, 2), []
    red, tile, stone = (0.34, 0.075, 0.045), (0.085, 0.10, 0.10), (0.42, 0.40, 0.37)

    def ring(radius, y, color, lift=0.0):
        """Eight corners, perhaps lifted, and the middles between them."""
        out = []
        for k in range(16):
            r, a = radius * (1 if k % 2 == 0 else math.cos(math.pi / 8)), math.pi * k / 8
            out.append(mesh.vertex((r * math.cos(a), y + (lift if k % 2 == 0 else 0), r * math.sin(a)), color))
        return out

    def band(low, high):
        for k in range(16):
            n = (k + 1) % 16
            mesh.face((low[k], high[k], high[n], low[n]))

    def windows(wall, low, high):
        """A little before the walls."""
        for k in range(8):
            a, flat, half = math.pi * (k + 0.5) / 4, wall * math.cos(math.pi / 8) + 0.06, 0.27 * wall
            corners = []
            for across, y in ((-half, low), (-half, high), (half, high), (half, low)):
                x, z = flat * math.cos(a) - across * math.sin(a), flat * math.sin(a) + across * math.cos(a)
                corners.append(mesh.vertex((x, y, z), WHITE))
            mesh.face(corners, "window")

    band(ring(8.6, -3.0, stone), ring(8.4, 0.6, stone))
    band(ring(8.4, 0.6, stone), ring(0.1, 0.6, stone))
    y, r = 0.6, 7.4
    for storey in range(7):
        wall, eave, h = 0.66 * r, 1.12 * r, 4.6 - 0.22 * storey
        band(ring(wall, y, red), ring(wall, y + h, red))
        windows(wall, y + 0.9, y + h - 1.1)
        band(ring(wall, y + h - 0.5, red), ring(eave, y + h - 0.7, (0.22, 0.06, 0.04), 0.9))
        band(ring(eave, y + h - 0.55, tile, 0.9), ring(0.58 * r, y + h + 0.9, tile))
        for k in range(8):
            lamps.append((eave * math.cos(math.pi * k / 4), y + h - 1.15, eave * math.sin(math.pi * k / 4)))
        y += h + 0.7
        r *= 0.915
    mesh.tube([(0, y - 0.3, 0), (0, y + 1.5, 0), (0, y + 6, 0)], [1.6, 0.35, 0], 10, color=lambda p: (0.35, 0.26, 0.1))
    for at in lamps:
        lamp(mesh, at, 0.34, 4, 6)
    return mesh, lamps


def slab(mesh, low, high, color, material="plain"):
    ends = list(zip(low, high))
    v = [mesh.vertex((ends[0][k & 1], ends[1][k >> 1 & 1], ends[2][k >> 2]), color) for k in range(8)]
    for face in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        mesh.face([v[k] for k in face], material)


def batten_sail(mesh, x, tall, width, height):
    """A fan of six battens on a mast at x."""
    rows, columns, foot = 20, 12, tall - height - 1.2
    grid = []
    for j in range(rows + 1):
        v = j / rows
        between = 0.5 - 0.5 * math.cos(10 * math.pi * v)  # 0 at a batten, 1 between two
        ahead = 0.28 * width * (1 - 0.15 * v)
        behind = 0.72 * width * (0.80 + 0.42 * v - 0.62 * v**3) - 0.35 * between
        row = []
        for i in range(columns + 1):
            u = i / columns
            y = foot + height * (v * (0.90 + 0.10 * u) + 0.048 * (u - 0.3) * (1 - v)) + 1.3 * u * v
            belly = 0.3 + (math.sin(math.pi * u) + 0.35 * between) * (1 - 0.5 * v)
            patch = 0.5 + 0.5 * noise(3 * u + x, 1.7 * math.floor(5 * v + 1e-9))
            cloth = mix((0.50, 0.17, 0.07), (0.62, 0.26, 0.10), patch)
            color = (0.22, 0.10, 0.05) if between < 0.06 else cloth
            row.append(mesh.vertex((x + ahead - u * (ahead + behind), y, belly), color))
        grid.append(row)
    for a, b in zip(grid, grid[1:]):
        for i in range(columns):
            mesh.face((a[i], a[i + 1], b[i + 1], b[i]))


def junk():
    """A ship of 27 m with three sails, its bow towards +x."""
    mesh = Mesh(2, 2)
    stations, levels = 18, 6

    def hull(u, v, side):
        """u from stern to bow, v from the water up."""
        sheer = 2.3 + 9.6 * max(0.42 - u, 0) ** 1.3 + 7.5 * max(u - 0.6, 0) ** 1.6
        beam = 3.5 * (1 - abs(2 * u - 0.92) ** 2.6 * 0.62) * (0.72 + 0.28 * v)
        rake = v * (3.2 * max(u - 0.5, 0) - 2.4 * max(0.5 - u, 0))
        return (-12 + 24 * u + rake, v * sheer, side * beam)

    def planks(u, v):
        return scaled((0.25, 0.135, 0.075), 0.8 + 0.5 * noise(14 * u, 9 * v) if v < 0.86 else 1.9)

    us, vs = [i / stations for i in range(stations + 1)], [j / levels for j in range(levels + 1)]
    ends = {}
    for side in (-1, 1):
        rows = [[mesh.vertex(hull(u, v, side), planks(u, v)) for v in vs] for u in us]
        for a, b in zip(rows, rows[1:]):
            for j in range(levels):
                mesh.face((a[j], b[j], b[j + 1], a[j + 1])[::side])
        ends[side] = rows
    for i in (0, stations):
        mesh.face([*ends[-1][i], *reversed(ends[1][i])])
    deck = [[mesh.vertex(add(hull(u, 1, s), (0, -0.7, -0.15 * s)), (0.3, 0.2, 0.12)) for s in (-1, 1)] for u in us]
    for a, b in zip(deck, deck[1:]):
        mesh.face((a[0], a[1], b[1], b[0]))
    slab(mesh, (-10.5, 2.4, -2.3), (-5.2, 5.1, 2.3), (0.30, 0.10, 0.06))
    slab(mesh, (-10.9, 5.1, -2.8), (-4.8, 5.35, 2.8), (0.12, 0.12, 0.11))
    for x in (-9.6, -8.2, -6.8):
        for z in (-2.34, 2.34):
            slab(mesh, (x, 3.3, z - 0.02), (x + 0.8, 4.4, z + 0.02), WHITE, "window")
    for x, tall, width, height in ((-7.2, 16.0, 8.2, 11.5), (0.6, 23.0, 11.5, 16.0), (8.0, 15.0, 7.2, 10.0)):
        mesh.tube([(x, 1.0, 0), (x + 0.3, tall, 0)], [0.24, 0.1], 8, color=lambda p: (0.2, 0.13, 0.08))
        batten_sail(mesh, x, tall, width, height)
    lamps = [(-11.6, 6.6, 0), (-4.0, 4.6, 2.4), (-4.0, 4.6, -2.4), (3.6, 4.2, 2.4), (3.6, 4.2, -2.4), (12.4, 6.4, 0)]
    for at in lamps:
        lamp(mesh, at, 0.32, 5, 8)
    return mesh, lamps


def person(mesh, x, z, size, coat, girth):
    """Stands at x, z, or sits there, by the girth of the coat from below up."""

    def at(h):
        return (x, 0.25 + h * size, z)

    mesh.tube([at(0), at(0.5), at(1.0), at(1.38)], [g * size for g in girth], 9, color=lambda p: coat)
    mesh.ball(lambda d: add(at(1.52), scaled(d, 0.13 * size)), 6, 9, color=lambda d: (0.45, 0.30, 0.21))
    brim, rim = 0.40 * size, [k * math.pi / 7 for k in range(14)]
    hat = [mesh.vertex(add(at(1.56), (brim * math.cos(a), 0, brim * math.sin(a))), (0.46, 0.36, 0.2)) for a in rim]
    top = mesh.vertex(at(1.86), (0.5, 0.4, 0.23))
    for k in range(14):
        mesh.face((hat[k], top, hat[(k + 1) % 14]))


def sampan():
    """A boat of 7 m, its bow towards +x, with a mat roof, a boatman and a child; places for two paper lanterns."""
    mesh = Mesh(2, 2)
    stations = 14

    def rib(u):
        x, half = -3.5 + 7 * u, 0.85 * (1 - abs(2 * u - 1) ** 2.4) ** 0.6 + 0.06
        top = 0.42 + 3.0 * abs(u - 0.5) ** 2.2
        side = [(0, 0.75), (top, 1.0), (top - 0.08, 0.86), (0.18, 0.6)]
        return [(x, y, -w * half) for y, w in side] + [(x, y, w * half) for y, w in reversed(side)]

    rows = [[mesh.vertex(p, (0.21, 0.12, 0.07)) for p in rib(i / stations)] for i in range(stations + 1)]
    for a, b in zip(rows, rows[1:]):
        for j in range(7):
            mesh.face((a[j], b[j], b[j + 1], a[j + 1]))
    mesh.face(rows[0])
    mesh.face(rows[-1])

    def hoop(i):
        color, arc = ((0.30, 0.21, 0.11), (0.22, 0.15, 0.11))[i % 2], [k * math.pi / 8 for k in range(9)]
        return [mesh.vertex((-1.5 + 0.4 * i, 0.35 + 1.15 * math.sin(a), 0.86 * math.cos(a)), color) for a in arc]

    roof = [hoop(i) for i in range(6)]
    for a, b in zip(roof, roof[1:]):
        for k in range(8):
            mesh.face((a[k], b[k], b[k + 1], a[k + 1]))

    blue, red = (0.10, 0.13, 0.24), (0.5, 0.1, 0.07)
    person(mesh, -2.6, 0.0, 1.0, blue, (0.19, 0.24, 0.23, 0.10))
    mesh.tube([(-2.35, 1.35, 0.1), (-2.1, 1.25, 0.35)], [0.07, 0.05], 5, color=lambda p: blue)
    mesh.tube([(-1.9, 2.3, 0.35), (-3.4, 0.0, 0.55)], [0.03, 0.03], 5, color=lambda p: BAMBOO)
    mesh.tube([(-3.1, 0.9, -0.3), (-3.2, 2.3, -0.3), (-2.7, 2.5, -0.2)], [0.03, 0.025, 0.02], 4, color=lambda p: BAMBOO)
    person(mesh, 1.9, 0.1, 0.72, red, (0.34, 0.3, 0.22, 0.1))
    for side in (-0.12, 0.12):
        mesh.tube([(2.0, 0.98, 0.1 + side), (2.42, 1.25, 0.1 + 0.6 * side)], [0.06, 0.04], 5, color=lambda p: red)
    return mesh, [(2.62, 1.75, 0.1), (-2.7, 2.2, -0.2)]


def paper_lantern():
    """A sky lantern of radius 1, open below, brightest near its flame. Colours are what it shows."""
    mesh, sides = Mesh(2, 3), 20
    below = ((-1.25, 0.66), (-1.0, 0.74), (-0.6, 0.86), (-0.1, 0.97))
    above = ((0.4, 1.0), (0.8, 0.93), (1.08, 0.74), (1.24, 0.42))

    def glow(y, angle):
        rib = 0.86 + 0.14 * abs(math.cos(2.5 * angle)) ** 0.5
        return scaled(mix((0.62, 0.16, 0.03), (1.25, 0.70, 0.24), math.exp(-((y + 0.95) ** 2))), rib)

    previous, angles = None, [2 * math.pi * k / sides for k in range(sides)]
    for y, r in below + above:
        ring = [mesh.vertex((r * math.cos(a), y, r * math.sin(a)), glow(y, a)) for a in angles]
        if previous:
            for k in range(sides):
                n = (k + 1) % sides
                mesh.face((previous[k], ring[k], ring[n], previous[n]))
        previous = ring
    tip = mesh.vertex((0, 1.3, 0), glow(1.3, 0))
    for k in range(sides):
        mesh.face((previous[k], tip, previous[(k + 1) % sides]))
    flame, around = (1.6, 1.3, 0.8), [k * math.pi / 3 for k in range(6)]
    foot = [mesh.vertex((0.25 * math.cos(a), -1.15, 0.25 * math.sin(a)), flame) for a in around]
    mesh.face(foot)
    mesh.face((foot[0], mesh.vertex((0, -0.75, 0), flame), foot[3]))
    return mesh
