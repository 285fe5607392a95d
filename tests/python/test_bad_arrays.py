"""Nothing that is given crashes the interpreter: every function gets wrong shapes, types, strides, byte orders, empty and huge
arrays. Run under the address sanitizer too (python_test.sh)."""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scenes import lit_square, square

import luciole


def odd_values() -> list[Any]:
    """Values that no function expects, or that it must convert with care."""
    good = np.arange(12, dtype=np.float64).reshape(4, 3)
    huge = np.lib.stride_tricks.as_strided(np.zeros(1), shape=(1 << 40, 3), strides=(0, 0))
    values: list[Any] = [None, "text", b"bytes", 3, -1, 2.5, True, float("nan"), float("inf"), 1 << 70, object(), [], [[]], {}, ()]
    values += [[1, 2], [[1, 2], [3]], [["a", "b", "c"]], [(1, 2, 3)], [(1, 2, None)], range(3)]
    for dtype in ("f2", "f4", "f8", ">f4", ">f8", "i1", "u2", "i8", ">i4", "u8", "?", "c8", "U3", "S3", "O", "M8[s]", "m8[s]"):
        try:
            values.append(np.zeros((4, 3)).astype(dtype))
        except (TypeError, ValueError):
            values.append(np.empty((4, 3), dtype=dtype))
    values += [good[::-1], good[:, ::-1], good[::2], good.T, np.asfortranarray(good), good[:, :2], good[None], good[..., None]]
    values += [np.broadcast_to(good[:1], (4, 3)), np.zeros((0, 3)), np.zeros((3, 0)), np.zeros(()), np.zeros(3), np.zeros((4, 4))]
    values += [np.full((4, 3), np.nan), np.full((4, 3), -np.inf), np.full((4, 3), 1e300), np.full((4, 3), 2**31), -good]
    values += [np.zeros((3, 4, 4)), np.zeros((2, 3, 4)), np.tile(np.eye(4), (2, 1, 1)), np.eye(4), huge]
    values += [np.ma.masked_array(good, mask=good > 3), np.rec.fromrecords([(1, 2.0)]), memoryview(good)]
    return values


def calls() -> dict[str, Callable[[Any], object]]:
    """Functions of one odd value each."""
    camera = luciole.Camera.look_at((0, 0, 2), (0, 0, 0))

    def lights(kind: Any, name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            scene = lit_square()
            given: dict[str, Any] = {"position": np.zeros((4, 3)), "direction": np.ones((4, 3))}
            given = {key: given[key] for key in given if key in kind.__dataclass_fields__}
            scene.lights = kind(**{**given, name: value})
            return luciole.render(scene, size=(2, 2))

        return call

    def mesh(name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            given = square()
            setattr(given, name, value)
            return luciole.render(luciole.Scene(given), size=(2, 2))

        return call

    def material(name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            given = luciole.Material(**{name: value})
            return luciole.render(luciole.Scene(square(material=given, uvs=np.zeros((4, 2)))), size=(2, 2))

        return call

    def of_camera(name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            return luciole.render(lit_square(), size=(2, 2), camera=luciole.Camera(**{name: value}))

        return call

    def surfaces(name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            given: dict[str, Any] = {"position": np.zeros((2, 2, 3)), "normal": np.ones((2, 2, 3)), "camera": camera}
            return luciole.shade(luciole.GBuffer(**{**given, name: value}), luciole.PointLights([(0.0, 0, 1)]))

        return call

    def scene(name: str) -> Callable[[Any], object]:
        def call(value: Any) -> object:
            made = lit_square()
            setattr(made, name, value)
            return luciole.render(made, size=(2, 2))

        return call

    made: dict[str, Callable[[Any], object]] = {}
    for kind in (luciole.PointLights, luciole.SpotLights, luciole.DirectionalLights):
        for name in kind.__dataclass_fields__:
            made[f"{kind.__name__}.{name}"] = lights(kind, name)
    for name in luciole.Mesh.__dataclass_fields__:
        made[f"Mesh.{name}"] = mesh(name)
    for name in luciole.Material.__dataclass_fields__:
        made[f"Material.{name}"] = material(name)
    for name in luciole.Camera.__dataclass_fields__:
        made[f"Camera.{name}"] = of_camera(name)
    for name in ("position", "normal", "camera", "diffuse", "specular", "shininess", "ambient", "emission"):
        made[f"GBuffer.{name}"] = surfaces(name)
    for name in ("lights", "cameras", "size", "transforms", "background", "ambient", "fog"):
        made[f"Scene.{name}"] = scene(name)
    plain = lit_square()
    image = np.ones((4, 3), dtype=np.float32)
    made.update(
        {
            "Scene": luciole.Scene,
            "Renderer": luciole.Renderer,
            "render": luciole.render,
            "gbuffer": luciole.gbuffer,
            "reference": luciole.reference,
            "shade": lambda value: luciole.shade(value, plain),
            "shade lights": lambda value: luciole.shade(luciole.gbuffer(plain, size=(2, 2)), value),
            "load": luciole.load,
            "read": luciole.read,
            "reference pixels": lambda value: luciole.reference(plain, value, size=(4, 4)),
            "compare a": lambda value: luciole.compare(value, image),
            "compare b": lambda value: luciole.compare(image, value),
            "compare metrics": lambda value: luciole.compare(image, image, value),
            "bake object": lambda value: luciole.bake(plain, value, size=(2, 2)),
            "bake eye": lambda value: luciole.bake(plain, 0, eye=value, size=(2, 2)),
            "move": lambda value: plain.move(0, value),
            "move first": lambda value: plain.move(value, np.eye(4)),
            "pose": plain.pose,
            "set_material": lambda value: plain.set_material(0, value),
            "set_material index": lambda value: plain.set_material(value, luciole.Material()),
            "look_at": lambda value: luciole.Camera.look_at(value, (0, 0, 0)),
            "from_matrix": lambda value: luciole.Camera.from_matrix(value),
            "from_intrinsics": lambda value: luciole.Camera.from_intrinsics(value, (4, 4)),
            "from_intrinsics size": lambda value: luciole.Camera.from_intrinsics(np.eye(3), value),
            "Mesh.of": luciole.Mesh.of,
        }
    )
    for name in ("size", "crop", "samples", "aovs", "camera", "seed", "light_error", "exposure", "model", "shadow_size", "progress"):
        made[f"render {name}"] = lambda value, name=name: luciole.render(plain, **{"size": (2, 2), name: value})
    return made


@pytest.mark.parametrize("function", calls())
def test_odd_values_are_taken_or_refused(function: str) -> None:
    call = calls()[function]
    for value in odd_values():
        try:
            call(value)
        except (luciole.InputError, luciole.MachineError, TypeError, AttributeError, KeyError, IndexError, OverflowError, OSError):
            pass
        except ValueError as error:
            assert "_luciole" not in str(error), f"the checks let {value!r} through: {error}"


def test_messages_name_argument_and_shapes() -> None:
    scene = lit_square()
    for lights, message in [
        (luciole.PointLights(np.zeros((3, 100))), r"lights.position: expected \(N, 3\) float32, got \(3, 100\)"),
        (luciole.PointLights(np.zeros((2, 3)), np.zeros((5, 3))), r"lights.color: expected \(N, 3\) or \(3,\) or \(\) float64, with N = 2, got \(5, 3\)"),
        (luciole.PointLights([(0, 0, np.nan)]), r"lights.position\[0, 2\]: expected finite numbers, got nan"),
        (luciole.PointLights([("a", "b", "c")]), r"lights.position: expected"),
        (luciole.PointLights(np.zeros((1, 3)), -1.0), r"lights.color: expected 0 or more, got -1"),
        (luciole.SpotLights(np.zeros((1, 3)), np.zeros((1, 3))), r"lights.direction: expected directions of any length but 0"),
        (luciole.SpotLights(np.zeros((1, 3)), np.ones((1, 3)), cutoff=91), r"lights.cutoff: expected 0 to 90 degrees, got 91"),
    ]:
        with pytest.raises(luciole.InputError, match=message):
            scene.lights = lights
    with pytest.raises(luciole.InputError, match=r"mesh.triangles: refers to vertex 9, but the mesh has 4"):
        luciole.Scene(luciole.Mesh(square().vertices, [(0, 1, 9)]))
    with pytest.raises(luciole.InputError, match=r"mesh.vertices: expected \(V, 3\) float32, got \(3, 100\)"):
        luciole.Scene(luciole.Mesh(np.zeros((3, 100)), [(0, 1, 2)]))
    with pytest.raises(luciole.InputError, match=r"mesh.vertices: expected \(V, 3\) float32, got \(4, 3\) complex128"):
        luciole.Scene(luciole.Mesh(np.zeros((4, 3), complex), [(0, 1, 2)]))


def test_layouts_and_byte_orders_give_the_same_bits() -> None:
    random = np.random.default_rng(6)
    position, color = random.random((50, 3)), random.random((50, 3))
    scene = lit_square()
    scene.lights = luciole.PointLights(position, color)
    wanted = luciole.render(scene, size=(16, 16)).rgb
    for change in (np.asfortranarray, lambda a: a.astype(">f8"), lambda a: np.repeat(a, 2, axis=0)[::2], np.ndarray.tolist):
        scene.lights = luciole.PointLights(change(position), change(color))
        np.testing.assert_array_equal(luciole.render(scene, size=(16, 16)).rgb, wanted)


def test_random_calls_leave_the_scene_usable() -> None:
    random = np.random.default_rng(7)
    values, scene = odd_values(), lit_square()
    names = ["position", "color", "range", "attenuation", "cast_shadows", "radius", "specular", "ambient"]
    for _ in range(300):
        chosen = {name: values[random.integers(len(values))] for name in random.choice(names, 2, replace=False)}
        try:
            scene.lights = luciole.PointLights(**{"position": np.zeros((4, 3)), **chosen})
        except (ValueError, TypeError):
            pass
    scene.lights = luciole.PointLights([(0.0, 0, 1)])
    assert luciole.render(scene, size=(4, 4)).rgb.max() > 0


def test_memory_of_arrays_outlives_what_made_it() -> None:
    kept = []
    for _ in itertools.repeat(None, 20):
        scene = lit_square()
        picture = luciole.render(scene, size=(8, 8), aovs=["depth"])
        kept += [picture["depth"], scene.transforms, scene.cameras[0].camera_to_world, scene.lights[0].position]
        del scene, picture
    assert all(np.isfinite(array).all() for array in kept)
