"""mitsuba_test.py LUCIOLE: Mitsuba renders a scene, and LUCIOLE lights its layers again, with its own picture as the truth.
Works in the current folder. Exit status 1 where they differ."""

import json
import subprocess
import sys

import mitsuba as mi
import numpy

LUCIOLE = sys.argv[1]
mi.set_variant("scalar_rgb")
EYE = [3.5, 2.6, 5.0]
# At the camera's lens: what the camera sees, the light reaches, so that no shadow is in the picture.
WATTS_A_STERADIAN = 30.0
transform = mi.ScalarTransform4f
to_world = transform().look_at(origin=EYE, target=[0.2, 0.4, 0.1], up=[0, 1, 0])


def diffuse(*color):
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(color)}}}


scene = mi.load_dict({
    "type": "scene",
    "integrator": {"type": "aov", "aovs": "pos:position,nn:sh_normal,albedo:albedo,dd:depth",
                   "img": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}},
    "sensor": {"type": "perspective", "fov": 45, "to_world": to_world,
               # One sample a pixel, so that a picture's pixel and its layers are of the same point.
               "sampler": {"type": "independent", "sample_count": 1},
               "film": {"type": "hdrfilm", "width": 128, "height": 96, "component_format": "float32",
                        "rfilter": {"type": "box"}}},
    "ball": {"type": "sphere", "center": [0, 1, 0], "bsdf": diffuse(0.2, 0.5, 0.8)},
    "floor": {"type": "rectangle", "to_world": transform().rotate([1, 0, 0], -90).scale(6),
              "bsdf": diffuse(0.7, 0.6, 0.5)},
    "light": {"type": "point", "position": EYE, "intensity": {"type": "rgb", "value": WATTS_A_STERADIAN}},
})
mi.render(scene, spp=1)
film = scene.sensors()[0].film().bitmap()
film.write("layers.exr")
truth = dict(film.split())
next(picture for name, picture in truth.items() if name in ("<root>", "img")).convert(
    mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False).write("truth.exr")

mean = float(numpy.array(mi.Bitmap("truth.exr")).mean())

with open("lights.json", "w", encoding="utf-8") as file:
    json.dump({"camera": {"eye": EYE, "target": [0.2, 0.4, 0.1], "fov_y": 35}, "ambient": 0,
               "lights": [{"type": "point", "position": EYE, "color": 1, "intensity": WATTS_A_STERADIAN,
                           "attenuation": [0, 0, 1]}]}, file)
told = subprocess.run([LUCIOLE, "relight", "layers.exr", "--lights", "lights.json", "--albedo", "-o", "lit.exr"],
                      stderr=subprocess.PIPE, text=True, check=True).stderr
print(told)
figures = json.loads(subprocess.run([LUCIOLE, "compare", "truth.exr", "lit.exr", "--json", "-"], stdout=subprocess.PIPE,
                                    text=True, check=True).stdout)
print(f"mean of the truth {mean:.4f}, mean difference {figures['mean_abs']:.2e}, largest {figures['max_abs']:.2e}")
assert "named as Mitsuba's: position = pos, normal = nn, depth = dd.T, diffuse = albedo" in told, told
# Mitsuba's own arithmetic is single precision, and its sums over a few products lose some 20 roundings.
assert mean > 0.05 and figures["mean_abs"] < 1e-4 * mean, figures
