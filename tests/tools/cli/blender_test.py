"""blender_test.py LUCIOLE: Blender renders a scene with Cycles, and LUCIOLE lights its layers again, with its own picture as
the truth. Works in the current folder. Exit status 1 where they differ."""

import json
import math
import subprocess
import sys

import bpy

LUCIOLE = sys.argv[1]
WATTS = 900
EYE = (4.2, -5.5, 4.0)
# Beside the camera's lens: what the camera sees, the light reaches, so that no shadow is in the picture.
LIGHT = EYE


def add(color):
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*color, 1)
    links.new(diffuse.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs[0])
    bpy.context.object.data.materials.append(material)


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
bpy.ops.mesh.primitive_plane_add(size=12)
add((0.7, 0.6, 0.5))
bpy.ops.mesh.primitive_cube_add(size=1.5, location=(0.4, 0.3, 0.75), rotation=(0, 0, 0.5))
add((0.2, 0.5, 0.8))
bpy.ops.mesh.primitive_cone_add(vertices=7, radius1=1, depth=2, location=(-1.8, 0.2, 1))
add((0.8, 0.3, 0.2))

light = bpy.data.lights.new("light", "POINT")
light.energy = WATTS
light.shadow_soft_size = 0
lamp = bpy.data.objects.new("light", light)
lamp.location = LIGHT
scene.collection.objects.link(lamp)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location = EYE
camera.rotation_euler = (1.05, 0.0, 0.65)
scene.collection.objects.link(camera)
scene.camera = camera

scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
# One sample a pixel, so that a picture's pixel and its layers are of the same point.
scene.cycles.samples = 1
scene.cycles.use_adaptive_sampling = False
scene.cycles.max_bounces = 0
scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1
scene.render.resolution_x, scene.render.resolution_y = 128, 96
scene.render.resolution_percentage = 100
layer = bpy.context.view_layer
layer.use_pass_position = layer.use_pass_normal = layer.use_pass_z = True
layer.use_pass_diffuse_color = layer.use_pass_glossy_color = layer.use_pass_emit = True
image = scene.render.image_settings
image.file_format = "OPEN_EXR_MULTILAYER"
image.color_depth = "32"
scene.render.filepath = "layers.exr"
bpy.ops.render.render(write_still=True)
image.file_format = "OPEN_EXR"
bpy.data.images["Render Result"].save_render("truth.exr", scene=scene)

# The camera as Blender has it: x right, y up, -z ahead. A point light's watts go evenly into all directions.
matrix = " ".join(repr(number) for row in camera.matrix_world for number in row)
with open("lights.json", "w", encoding="utf-8") as file:
    json.dump({"ambient": 0, "lights": [{"type": "point", "position": list(LIGHT), "color": 1,
                                         "intensity": WATTS / (4 * math.pi), "attenuation": [0, 0, 1]}]}, file)
told = subprocess.run([LUCIOLE, "relight", "layers.exr", "--lights", "lights.json", "--albedo", "--camera-to-world",
                       matrix, "-o", "lit.exr"], stderr=subprocess.PIPE, text=True, check=True).stderr
print(told)
figures = json.loads(subprocess.run([LUCIOLE, "compare", "truth.exr", "lit.exr", "--json", "-"], stdout=subprocess.PIPE,
                                    text=True, check=True).stdout)
pixels = bpy.data.images.load("truth.exr").pixels[:]
mean = sum(sum(pixels[c::4]) for c in range(3)) / (3 * len(pixels) / 4)
print(f"mean of the truth {mean:.4f}, mean difference {figures['mean_abs']:.2e}, largest {figures['max_abs']:.2e}")
assert "named as Blender's: position = ViewLayer.Position" in told, told
assert "in world space, camera as told\n" in told, told
# Cycles' own arithmetic is single precision, and its sums over a few products lose some 20 roundings.
assert mean > 0.05 and figures["mean_abs"] < 1e-4 * mean, figures
