"""Small scenes, and the program, for the tests."""

import subprocess
from pathlib import Path

import numpy as np

import luciole

#: The checkout's scenes.
SCENES = Path(__file__).resolve().parents[2] / "scenes"


def program(*words: object) -> str:
    """Runs the console script; returns what it prints."""
    script = Path(luciole.__file__).parent / "bin" / "luciole"
    done = subprocess.run([script, *map(str, words)], check=True, capture_output=True, text=True)
    return done.stdout


def square(side: float = 2.0, **others: object) -> luciole.Mesh:
    """A square around the origin that faces +z."""
    half = side / 2
    vertices = np.array([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], dtype=np.float32)
    return luciole.Mesh(vertices, [(0, 1, 2), (0, 2, 3)], **others)


def lit_square(**others: object) -> luciole.Scene:
    """A white square, 2 m from the camera and 1 m from a light on its axis."""
    material = luciole.Material(diffuse=1.0, ambient=0.0)
    camera = luciole.Camera.look_at((0, 0, 2), (0, 0, 0), fov_y=53.13010235415598)
    lights = luciole.PointLights([(0.0, 0.0, 1.0)])
    return luciole.Scene(square(material=material), lights, camera, **others)


def sphere(rings: int = 24) -> luciole.Mesh:
    """A unit sphere of rings × 2·rings squares."""
    v, u = np.mgrid[0 : rings + 1, 0 : 2 * rings + 1]
    polar, around = np.pi * v / rings, np.pi * u / rings
    vertices = np.stack([np.sin(polar) * np.sin(around), np.cos(polar), np.sin(polar) * np.cos(around)], axis=-1)
    row = 2 * rings + 1
    corner = (v[:-1, :-1] * row + u[:-1, :-1]).ravel()
    triangles = np.concatenate([np.stack([corner, corner + row, corner + row + 1], 1), np.stack([corner, corner + row + 1, corner + 1], 1)])
    flat = vertices.reshape(-1, 3)
    return luciole.Mesh(flat, triangles, normals=flat)
