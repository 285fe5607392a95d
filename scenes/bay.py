"""What stands in the bay of lanterns.json by itself: limestone towers, and what grows on them."""

import math
import random

from meshes import Mesh, mix, noise, octaves, scaled, smoothstep


def tower_middle(seed, radius, t):
    """Where a tower, which leans, has its middle at a height t from 0 to 1: x, z."""
    lean = 0.35 * radius * t * t
    return lean * math.cos(5.1 * seed), lean * math.sin(5.1 * seed)


def ledges(seed, c, s, y):
    """0 in the cracks between a tower's ledges."""
    return abs(octaves(2.3 * c, 2.3 * s + seed, 0.085 * y, 4))


def tower_reach(seed, radius, tall, angle, t):
    """From a tower's middle to its skin: steep walls with grooves, ledges and a notch at the water, a round head."""
    c, s, y = math.cos(angle), math.sin(angle), tall * t
    shape = (1 - t**3.0) ** 0.55 * (1 - 0.25 * t)
    broad = octaves(1.1 * c + seed, 1.1 * s, 0.022 * y + seed, 2)
    grooves = abs(octaves(3.1 * c + 7 * seed, 3.1 * s, 0.018 * y, 4))
    rough = noise(11 * c + seed, 11 * s, 0.22 * y) + 0.7 * noise(23 * c + seed, 23 * s, 0.5 * y)
    bumps = 0.42 * broad - 0.45 * grooves + 0.26 * min(ledges(seed, c, s, y), 0.35) + 0.045 * rough
    return radius * (shape * (1.0 + bumps) - 0.05 * smoothstep(3.0, 0.0, y))


def tower_point(seed, radius, tall, angle, t):
    x, z = tower_middle(seed, radius, t)
    r = tower_reach(seed, radius, tall, angle, t)
    return (x + r * math.cos(angle), tall * t, z + r * math.sin(angle))


def overgrown(seed, angle, t):
    """Above 0 where a tower is green."""
    patches = octaves(2.3 * math.cos(angle) + 3 * seed, 2.3 * math.sin(angle), 5 * t + seed, 3)
    return patches + 1.5 * smoothstep(0.55, 1.0, t) - 0.15


def tower_color(seed, angle, t, y):
    c, s = math.cos(angle), math.sin(angle)
    stone = mix((0.30, 0.27, 0.235), (0.62, 0.57, 0.50), 0.5 + 0.5 * octaves(4 * c, 4 * s, 0.05 * y + seed, 3))
    streak = smoothstep(0.1, 0.5, octaves(11 * c + seed, 11 * s, 0.02 * y, 3))
    stone = mix(stone, (0.16, 0.15, 0.14), 0.7 * streak)
    stone = mix(stone, (0.12, 0.13, 0.11), smoothstep(2.5, 0.5, y))
    stone = scaled(stone, 0.45 + 0.55 * smoothstep(0.0, 0.13, ledges(seed, c, s, y)))
    green = mix((0.08, 0.105, 0.04), (0.15, 0.17, 0.07), 0.5 + 0.5 * noise(8 * c, 8 * s, 0.2 * y))
    return mix(stone, green, smoothstep(-0.1, 0.2, overgrown(seed, angle, t)))


def tower(seed, radius, tall, sides, rings):
    """From the water up, open below."""
    mesh = Mesh(1, 2)
    previous = None
    for j in range(rings):
        t = j / rings
        ring = []
        for i in range(sides):
            angle = 2 * math.pi * i / sides
            p = tower_point(seed, radius, tall, angle, t)
            ring.append(mesh.vertex(p, tower_color(seed, angle, t, p[1])))
        if previous:
            for i in range(sides):
                n = (i + 1) % sides
                mesh.face((previous[i], ring[i], ring[n], previous[n]))
        previous = ring
    tip = mesh.vertex(tower_point(seed, radius, tall, 0.0, 1.0), (0.08, 0.11, 0.045))
    for i in range(sides):
        mesh.face((previous[i], tip, previous[(i + 1) % sides]))
    return mesh


def crown(seed):
    """A tree's or bush's crown of radius 1: some tufts of leaves, dark below."""
    mesh, rng = Mesh(2, 2), random.Random(seed)
    for k in range(11):
        a, up = 2.4 * k + rng.uniform(-0.4, 0.4), rng.uniform(-0.35, 0.6) if k else 0.5
        out, size = rng.uniform(0.35, 0.75) if k else 0.0, rng.uniform(0.32, 0.5)
        shift, tint = rng.uniform(0, 40), rng.uniform(0.7, 1.3)

        def skin(d):
            r = size * (1 + 0.5 * noise(2.3 * d[0] + shift, 2.3 * d[1], 2.3 * d[2]))
            return (out * math.cos(a) + r * d[0], up + 0.8 * r * d[1], out * math.sin(a) + r * d[2])

        def leaves(d):
            return scaled(mix((0.05, 0.065, 0.026), (0.16, 0.185, 0.07), smoothstep(-0.9, 0.9, d[1] + up)), tint)

        mesh.ball(skin, 5, 7, color=leaves)
    return mesh


def ripples(rng, eye, count):
    """Slivers of water, seen from `eye`, that are tilted enough to show the dark sky instead of what stands ahead."""
    mesh = Mesh(1)
    for _ in range(count):
        d = 26 * (900 / 26) ** rng.random() ** 1.2
        x, z = eye[0] + rng.uniform(-0.72, 0.72) * d, eye[2] - d
        half, deep = rng.uniform(0.010, 0.045) * d + 0.3, rng.uniform(0.002, 0.006) * d * (1 + d / 160)
        corners = ((x - half, z), (x, z + deep), (x + half, z), (x, z - deep))
        mesh.face([mesh.vertex((a, 0.05, b)) for a, b in corners])
    return mesh
