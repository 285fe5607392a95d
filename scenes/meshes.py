"""What the scripts beside this file build scenes from: tubes, rocks, smooth noise, OBJ and scene files.

Everything is deterministic: the same Python 3 writes the same bytes.
"""

import json
import math
import struct


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scaled(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(dot(a, a)))


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def lattice(x, y, z):
    """In [-1, 1], the same for the same integers."""
    n = (x * 374761393 + y * 668265263 + z * 2147483647) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((n ^ (n >> 16)) & 0xFFFF) / 32767.5 - 1


def noise(x, y, z=0.0):
    """Smooth value noise in [-1, 1] with features of size 1."""
    cell = [math.floor(c) for c in (x, y, z)]
    f = [c - i for c, i in zip((x, y, z), cell)]
    f = [t * t * (3 - 2 * t) for t in f]
    total = 0.0
    for corner in range(8):
        offset = (corner & 1, corner >> 1 & 1, corner >> 2)
        weight = 1.0
        for o, t in zip(offset, f):
            weight *= t if o else 1 - t
        total += weight * lattice(*(c + o for c, o in zip(cell, offset)))
    return total


def octaves(x, y, z=0.0, count=3):
    return sum(noise(x * 2**i, y * 2**i, z * 2**i) / 2**i for i in range(count)) / (2 - 2.0 ** (1 - count))


def uniforms(state):
    """SplitMix64 as numbers in [0, 1): what the renderer places the lights of light fields by."""
    mask = (1 << 64) - 1
    while True:
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        yield ((z ^ (z >> 31)) >> 11) / 2**53


def srgb_text(linear):
    """A linear value as OBJ files have it, in sRGB: the fewest digits that stand for the same float."""
    def as_float(value):
        return struct.pack("f", value)

    def decoded(code):
        return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4

    code = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    for digits in range(17):
        text = f"{code:.{digits}f}"
        if as_float(decoded(float(text))) == as_float(linear):
            return text
    return repr(code)


class Mesh:
    """Vertices, perhaps coloured (linear), and faces by material; smooth where faces share vertices."""

    def __init__(self, digits=3, color_digits=3):
        self.digits = digits
        self.color_digits = color_digits
        self.vertices = []
        self.colors = []
        self.faces = {}

    def vertex(self, position, color=None):
        self.vertices.append(position)
        if color:
            self.colors.append(color)
        return len(self.vertices)

    def face(self, corners, material="plain"):
        self.faces.setdefault(material, []).append(corners)

    def tube(self, points, radii, sides, material="plain", color=None, wobble=0.0, seed=0.0):
        """Skin around a polyline, perhaps coloured by position; closes to a point if the last radius is 0."""
        side = unit(cross(sub(points[1], points[0]), (0.31, 0.17, 0.93)))
        previous = None
        for i, (point, radius) in enumerate(zip(points, radii)):
            ahead = unit(sub(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]))
            side = unit(sub(side, scaled(ahead, dot(side, ahead))))
            other = cross(ahead, side)
            if radius == 0:
                tip = self.vertex(point, color and color(point))
                for k in range(sides):
                    self.face((previous[k], previous[(k + 1) % sides], tip), material)
                return
            ring = []
            for k in range(sides):
                angle = 2 * math.pi * k / sides
                r = radius * (
                    1 + wobble * noise(3 * math.cos(angle) + seed, 3 * math.sin(angle), point[1] * 1.5)
                )
                place = add(point, add(scaled(side, r * math.cos(angle)), scaled(other, r * math.sin(angle))))
                ring.append(self.vertex(place, color and color(place)))
            if previous:
                for k in range(sides):
                    n = (k + 1) % sides
                    self.face((previous[k], previous[n], ring[n], ring[k]), material)
            previous = ring

    def ball(self, shape, rings, sides, material="plain", color=None):
        """A closed surface: shape takes a unit direction and returns the point there, color likewise."""

        def put(direction):
            return self.vertex(shape(direction), color and color(direction))

        top, previous = put((0.0, 1.0, 0.0)), None
        for i in range(1, rings):
            polar = math.pi * i / rings
            ring = [
                put(
                    (
                        math.sin(polar) * math.cos(2 * math.pi * k / sides),
                        math.cos(polar),
                        math.sin(polar) * math.sin(2 * math.pi * k / sides),
                    )
                )
                for k in range(sides)
            ]
            for k in range(sides):
                n = (k + 1) % sides
                if previous:
                    self.face((previous[k], previous[n], ring[n], ring[k]), material)
                else:
                    self.face((top, ring[n], ring[k]), material)
            previous = ring
        bottom = put((0.0, -1.0, 0.0))
        for k in range(sides):
            self.face((previous[k], previous[(k + 1) % sides], bottom), material)

    def write(self, path, mtl=None, smooth=True):
        def text(values, digits):
            return " ".join(f"{v:.{digits}f}".rstrip("0").rstrip(".") for v in values)

        with open(path, "w") as out:
            if mtl:
                out.write(f"mtllib {mtl}\n")
            for i, v in enumerate(self.vertices):
                color = ""
                if self.colors:
                    color = " " + " ".join(srgb_text(round(c, self.color_digits)) for c in self.colors[i])
                out.write(f"v {text(v, self.digits)}{color}\n")
            out.write("s 1\n" if smooth else "s off\n")
            for material, faces in self.faces.items():
                if mtl:
                    out.write(f"usemtl {material}\n")
                for face in faces:
                    out.write("f " + " ".join(map(str, face)) + "\n")


def rock(mesh, rng, size, roughness, rings, sides, color=None):
    """An uneven ball whose radii along the axes are `size`."""
    shift = rng.uniform(0, 50)

    def shape(d):
        r = 1 + roughness * octaves(1.3 * d[0] + shift, 1.3 * d[1], 1.3 * d[2], 4)
        return (size[0] * r * d[0], size[1] * r * d[1], size[2] * r * d[2])

    mesh.ball(shape, rings, sides, color=color)


def write_scene(path, scene, author):
    """One line an object, light or material."""
    parts = []
    for key, value in scene.items():
        if isinstance(value, list) and isinstance(value[0], dict):
            body = "[\n" + ",\n".join("    " + json.dumps(v, separators=(",", ":")) for v in value) + "\n  ]"
        elif key == "materials":
            body = (
                "{\n"
                + ",\n".join(f"    {json.dumps(k)}: {json.dumps(v)}" for k, v in value.items())
                + "\n  }"
            )
        else:
            body = json.dumps(value)
        parts.append(f"  {json.dumps(key)}: {body}")
    with open(path, "w") as out:
        out.write(f"// Written by {author}.\n{{\n" + ",\n".join(parts) + "\n}\n")
