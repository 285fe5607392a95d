#!/usr/bin/env python3
"""Writes spheres.json: on four steps, four finishes (rows) over the exponent of the specular lobe (columns)."""
import json
from pathlib import Path

SHININESS = [1, 4, 16, 64, 256, 1024]
# Name, diffuse and specular colour, from the lowest step up.
ROWS = [
    ("pearl", [0.42, 0.4, 0.38], [0.18, 0.18, 0.18]),
    ("lacquer", [0.33, 0.02, 0.03], [0.4, 0.4, 0.4]),
    ("steel", [0.04, 0.05, 0.07], [0.6, 0.66, 0.75]),
    ("gold", [0.12, 0.06, 0.008], [0.95, 0.6, 0.16]),
]
SPACING = 2.6
RISE = 1.6
RUN = 2.4
DARK = [0.006, 0.008, 0.013]


def main():
    materials = {"floor": {"diffuse": [0.13, 0.135, 0.155], "specular": 0.05, "shininess": 12}}
    objects = []
    for row, (name, diffuse, specular) in enumerate(ROWS):
        # A tread and the riser behind it, in squares so that Gouraud shading has something to interpolate.
        front = RUN * (0.5 - row) + (20 if row == 0 else 0)
        back = RUN * (-0.5 - row) - (30 if row == len(ROWS) - 1 else 0)
        y = RISE * row - 1
        objects.append({"primitive": "plane", "segments": 64, "scale": [44, 1, round(front - back, 3)], "material": "floor",
                        "translate": [0, round(y, 3), round((front + back) / 2, 3)]})
        if row + 1 < len(ROWS):
            objects.append({"primitive": "plane", "segments": 64, "scale": [44, 1, RISE], "rotate": [90, 0, 0], "material": "floor",
                            "translate": [0, round(y + RISE / 2, 3), round(back, 3)]})
        for column, shininess in enumerate(SHININESS):
            materials[f"{name}_{shininess}"] = {"diffuse": diffuse, "specular": specular, "shininess": shininess}
            x = SPACING * (column - 0.5 * (len(SHININESS) - 1))
            objects.append({"primitive": "sphere", "segments": 24, "material": f"{name}_{shininess}",
                            "translate": [round(x, 3), round(RISE * row, 3), round(-RUN * row, 3)]})
    lights = [
        # Key from the upper left, cool rim from behind on the right, faint fill.
        {"type": "spot", "position": [-13, 19, 15], "target": [0, 1.5, -3.5], "inner_cone": 6, "outer_cone": 27,
         "color": [1, 0.93, 0.82], "intensity": 1.7, "shadow": True},
        {"type": "spot", "position": [16, 14, -16], "target": [0, 2, -3], "inner_cone": 10, "outer_cone": 35,
         "diffuse": [0.08, 0.13, 0.22], "specular": [0.5, 0.75, 1.2]},
        {"type": "directional", "direction": [-0.9, -0.25, -0.6], "color": [0.55, 0.7, 1], "intensity": 0.16},
    ]
    head = {
        "camera": {"eye": [0, 9.5, 27], "target": [0, 2.15, -3.6], "fov_y": 19, "near": 1, "far": 100},
        "size": [1280, 720],
        "background": DARK,
        "ambient": [0.03, 0.032, 0.04],
        "fog": {"mode": "linear", "start": 34, "end": 60, "color": DARK},
    }
    parts = [f'  "{key}": {json.dumps(value)}' for key, value in head.items()]
    parts.append('  "materials": {\n' + ",\n".join(f'    "{k}": {json.dumps(v)}' for k, v in materials.items()) + "\n  }")
    for key, values in (("objects", objects), ("lights", lights)):
        parts.append(f'  "{key}": [\n' + ",\n".join(f"    {json.dumps(v)}" for v in values) + "\n  ]")
    Path(__file__).with_name("spheres.json").write_text("{\n" + ",\n".join(parts) + "\n}\n")


main()
