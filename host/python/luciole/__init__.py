"""Luciole lights scenes by any number of lights, without a display or a GPU, and says how wrong its pictures are.

    import luciole
    scene = luciole.load("sponza.obj")
    scene.lights = luciole.PointLights(position, color)      # arrays (N, 3)
    picture = luciole.render(scene, size=(1280, 720), light_error=1/256, aovs=["depth"])
    picture.rgb, picture["depth"], picture.stats

Lengths are metres, angles degrees, colours linear Rec.709. Pixel (0, 0) is the top left one.
"""

from luciole import _opencl

_opencl.prepare()

from luciole._errors import InputError, MachineError  # noqa: E402
from luciole.experiment import scale  # noqa: E402
from luciole.lights import AreaLight, DirectionalLights, Environment, PointLights, SpotLights  # noqa: E402
from luciole.picture import (  # noqa: E402
    GBuffer,
    Picture,
    Renderer,
    bake,
    compare,
    devices,
    gbuffer,
    read,
    reference,
    relight,
    render,
    shade,
)
from luciole.scene import Camera, Fog, Material, Mesh, Scene, load  # noqa: E402

__all__ = [
    "AreaLight",
    "Camera",
    "DirectionalLights",
    "Environment",
    "Fog",
    "GBuffer",
    "InputError",
    "MachineError",
    "Material",
    "Mesh",
    "Picture",
    "PointLights",
    "Renderer",
    "Scene",
    "SpotLights",
    "bake",
    "compare",
    "devices",
    "gbuffer",
    "load",
    "read",
    "reference",
    "relight",
    "render",
    "scale",
    "shade",
]
