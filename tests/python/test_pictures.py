"""Pictures from Python: the command line's bits, without copies, from any thread."""

import json
import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from scenes import SCENES, lit_square, program, sphere, square

import luciole


@pytest.mark.parametrize(
    "scene, keywords",
    [
        ("cornell", {}),
        ("spheres", {"samples": 4, "model": "blinn-phong"}),
        ("fireflies", {"light_error": 1 / 256, "shadows": "off"}),
        ("colonnade", {"shadows": "pcf", "pcf_width": 3, "crop": (10, 20, 40, 30)}),
        ("city", {"shadows": "exact", "exposure": 1.5, "shading": "flat"}),
        ("cornell", {"model": "ward", "cast_shadows": "none", "camera": 0}),
    ],
)
def test_a_picture_has_the_command_lines_bits(tmp_path: Path, scene: str, keywords: dict) -> None:
    file = SCENES / f"{scene}.json"
    options = []
    for name, value in keywords.items():
        text = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
        options += ["--" + name.replace("_", "-"), text]
    program("render", file, "--size", "96x64", *options, "--quiet", "-o", tmp_path / "picture.npy")
    picture = luciole.render(luciole.load(file), size=(96, 64), **keywords)
    np.testing.assert_array_equal(picture.rgb, np.load(tmp_path / "picture.npy"))


def test_lights_from_arrays_give_the_bits_of_the_same_lights_in_a_file(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    position = random.uniform(-1, 1, (3000, 3)).astype(np.float32) + np.float32([0, 1, 0])
    color = random.uniform(0, 0.002, (3000, 3)).astype(np.float32)
    lights = [
        {"type": "point", "position": p, "color": c, "attenuation": [0, 0, 1]}
        for p, c in zip(position.astype(float).tolist(), color.astype(float).tolist())
    ]
    box = {"primitive": "box", "scale": [2, 0.1, 2]}
    scene = {"camera": {"eye": [0, 2, 4], "target": [0, 0.5, 0]}, "objects": [box], "lights": lights}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    options = ["--size", "80x60", "--light-error", "1/64", "--quiet"]
    program("render", tmp_path / "scene.json", *options, "-o", tmp_path / "picture.npy")
    of_file = luciole.load(tmp_path / "scene.json")
    of_file.lights = luciole.PointLights(position, color)
    picture = luciole.render(of_file, size=(80, 60), light_error=1 / 64)
    np.testing.assert_array_equal(picture.rgb, np.load(tmp_path / "picture.npy"))


def test_arrays_show_the_pictures_own_memory() -> None:
    picture = luciole.render(lit_square(), size=(33, 17), aovs=["depth", "normal", "object_id"])
    assert picture.rgb.shape == (17, 33, 3) and picture.rgb.dtype == np.float32
    assert picture["depth"].shape == (17, 33)
    assert picture["normal"].shape == (17, 33, 3)
    assert set(picture.layers) == {"depth", "normal", "object_id"}
    assert np.shares_memory(picture["depth"], picture["normal"]) or np.may_share_memory(picture["depth"], picture.rgb)
    picture.rgb[3, 4] = (1, 2, 3)
    assert tuple(picture.rgb[3, 4]) == (1, 2, 3)
    assert np.shares_memory(np.from_dlpack(picture), picture.rgb)
    kept = picture["depth"]
    del picture
    assert kept[8, 16] == 2, "the memory stays as long as an array of it"


def test_a_layer_that_was_not_asked_for_says_so() -> None:
    picture = luciole.render(lit_square(), size=(8, 8))
    with pytest.raises(KeyError, match="aovs"):
        picture["depth"]


def test_stats_say_what_a_picture_cost() -> None:
    stats = luciole.render(lit_square(), size=(16, 16)).stats
    assert stats["image"] == {"width": 16, "height": 16, "samples": 1}
    assert stats["scene"]["lights"] == 1
    assert stats["picture_milliseconds"] > 0
    assert {stage["name"] for stage in stats["stages"]} >= {"rasterize"}


def test_pictures_are_written_and_shown(tmp_path: Path) -> None:
    picture = luciole.render(lit_square(), size=(16, 16), aovs=["depth"])
    for name in ("a.png", "a.exr", "a.npy"):
        picture.save(tmp_path / name)
    np.testing.assert_array_equal(np.load(tmp_path / "a.npy"), picture.rgb)
    back = luciole.read(tmp_path / "a.exr")
    np.testing.assert_array_equal(back.rgb, picture.rgb)
    np.testing.assert_array_equal(back["depth"], picture["depth"])
    picture.save(tmp_path / "b.png", dither=False)
    codes = luciole.read(tmp_path / "b.png").srgb8()
    np.testing.assert_array_equal(codes, picture.srgb8())
    assert picture._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(luciole.InputError, match="tone: 'x' is none of clip, filmic"):
        picture.save(tmp_path / "c.png", tone="x")  # type: ignore[arg-type]
    with pytest.raises(luciole.InputError):
        picture.save(tmp_path / "nowhere" / "c.png")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.exr", "a.npy", "a.png", "b.png"]


def test_the_light_on_a_square_is_its_closed_form() -> None:
    """Kd · N·L / d², at pixels whose middles hit (x, y, 0): d² = x² + y² + 1, N·L = 1/d. Positions are floats, relative error
    2^-23, and so is each of some 20 operations of the kernel: 1e-5 is 4 times that."""
    picture = luciole.render(lit_square(), size=(32, 32))
    # 53.13° high, 2 m away: 2 m are 32 pixels.
    x = (np.arange(32) + 0.5) / 16 - 1
    d2 = x[None, :] ** 2 + x[:, None] ** 2 + 1
    np.testing.assert_allclose(picture.rgb, np.broadcast_to((d2**-1.5)[:, :, None], (32, 32, 3)), rtol=1e-5)


def test_a_reference_agrees_and_takes_pixels() -> None:
    scene = lit_square()
    whole = luciole.reference(scene, size=(16, 12))
    assert whole.shape == (12, 16, 3) and whole.dtype == np.float64
    some = luciole.reference(scene, pixels=[(3, 4), (15, 11)], size=(16, 12))
    np.testing.assert_array_equal(some, [whole[4, 3], whole[11, 15]])
    picture = luciole.render(scene, size=(16, 12))
    np.testing.assert_allclose(picture.rgb, whole, rtol=1e-5)
    with pytest.raises(luciole.InputError):
        luciole.reference(scene, pixels=[(16, 0)], size=(16, 12))
    with pytest.raises(luciole.InputError, match="screen"):
        luciole.reference(scene, size=(16, 12), screen="hatching.clh")


def test_a_renderer_makes_the_bits_of_single_pictures() -> None:
    def scene() -> luciole.Scene:
        random = np.random.default_rng(5)
        lights = luciole.PointLights(random.uniform(-3, 3, (8, 3)) + (0, 4, 0), 0.5, cast_shadows=True)
        floor = luciole.Mesh([(-9, -1, -9), (-9, -1, 9), (9, -1, 9), (9, -1, -9)], [(0, 1, 2), (0, 2, 3)])
        camera = luciole.Camera.look_at((0, 2, 6), (0, 0, 0))
        return luciole.Scene([sphere(), floor], lights, camera)

    kept = luciole.Renderer(scene())
    alone = scene()
    for step in range(3):
        for one in (kept.scene, alone):
            turned = np.eye(4)
            turned[:3, 3] = (0.3 * step, 0.1 * step, 0)
            one.move(0, turned)
            one.lights = luciole.PointLights(
                [(step - 1.0, 3, 1), (1, 4, step)], (0.5, 0.6, 0.7), cast_shadows=[True, step > 0]
            )
            one.cameras = luciole.Camera.look_at((step, 2, 6), (0, 0, 0))
        np.testing.assert_array_equal(kept.render(size=(64, 48)).rgb, luciole.render(alone, size=(64, 48)).rgb)


def test_a_scene_is_of_one_renderer() -> None:
    scene = lit_square()
    luciole.Renderer(scene)
    with pytest.raises(luciole.InputError, match="copy"):
        luciole.Renderer(scene)
    luciole.Renderer(scene.copy())
    assert luciole.render(scene, size=(8, 8)).rgb.max() > 0


def test_settings_for_a_picture_leave_the_scene_alone() -> None:
    scene = lit_square()
    before = luciole.render(scene, size=(16, 16)).rgb
    luciole.render(scene, size=(16, 16), model="ward", cast_shadows="all", shadows="exact")
    np.testing.assert_array_equal(luciole.render(scene, size=(16, 16)).rgb, before)
    with pytest.raises(luciole.InputError, match="none.clh"):
        luciole.render(scene, size=(16, 16), model="none.clh", cast_shadows="all")
    assert not scene.lights[0].cast_shadows.any()


def test_threads_have_renderers_of_their_own() -> None:
    wanted = luciole.render(lit_square(), size=(48, 48)).rgb
    wrong = []

    def work() -> None:
        renderer = luciole.Renderer(lit_square())
        for _ in range(5):
            if not np.array_equal(renderer.render(size=(48, 48)).rgb, wanted):
                wrong.append(threading.get_ident())

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_progress_is_told_and_its_errors_end_the_picture() -> None:
    seen = []
    luciole.render(lit_square(), size=(16, 16), progress=lambda done, of: seen.append((done, of)))
    assert seen and seen[-1][0] == seen[-1][1]

    def fail(done: int, of: int) -> None:
        raise ZeroDivisionError

    scene = lit_square()
    with pytest.raises(ZeroDivisionError):
        luciole.render(scene, size=(16, 16), progress=fail)
    assert luciole.render(scene, size=(16, 16)).rgb.max() > 0, "the scene is as it was"
    with pytest.raises(luciole.InputError, match="progress"):
        luciole.render(scene, size=(16, 16), progress=lambda done, of: scene.lights)
    with pytest.raises(luciole.InputError, match="progress: expected a function"):
        luciole.render(scene, progress=3)  # type: ignore[arg-type]


def test_ctrl_c_ends_a_long_picture_and_the_scene_stays() -> None:
    scene = lit_square()
    scene.lights = luciole.PointLights(np.random.default_rng(2).uniform(-1, 1, (20000, 3)) + (0, 0, 2), 1e-4)
    luciole.render(scene, size=(16, 16))  # compiled
    # Whoever starts tests in the background has them ignore it, and Python then keeps that.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            luciole.render(scene, size=(1920, 1080), samples=16, samples_shading="all")
    assert time.monotonic() - begun < 60
    timer.join()
    signal.signal(signal.SIGINT, before)
    assert luciole.render(scene, size=(16, 16)).rgb.max() > 0


def test_a_gbuffer_is_shaded_to_the_bits_of_the_picture(tmp_path: Path) -> None:
    scene = luciole.load(SCENES / "cornell.json")
    picture = luciole.render(scene, size=(64, 64), shadows="off")
    surfaces = luciole.gbuffer(scene, size=(64, 64))
    np.testing.assert_array_equal(luciole.shade(surfaces, scene, shadows="off").rgb, picture.rgb)
    surfaces.save(tmp_path / "g.exr")
    np.testing.assert_array_equal(luciole.relight(tmp_path / "g.exr", scene, shadows="off").rgb, picture.rgb)
    assert surfaces["normal"].shape == (64, 64, 3)
    assert surfaces["depth"].shape == (64, 64)


def test_arrays_of_surfaces_are_lit() -> None:
    """The square again, of arrays: 1/d³. Tolerance: see the closed form above."""
    scene = lit_square()
    y, x = np.mgrid[0:32, 0:32]
    position = np.stack([(x + 0.5) / 16 - 1, 1 - (y + 0.5) / 16, np.zeros((32, 32))], axis=-1)
    position[0, 0] = np.nan
    normal = np.broadcast_to((0.0, 0.0, 2.0), position.shape)
    surfaces = luciole.GBuffer(position, normal, scene.cameras[0], diffuse=np.ones_like(position))
    picture = luciole.shade(surfaces, luciole.PointLights([(0.0, 0.0, 1.0)]))
    wanted = ((position[:, :, :2] ** 2).sum(-1) + 1) ** -1.5
    of_dict = {"position": position, "normal": normal, "diffuse": np.ones_like(position)}
    same = luciole.shade(of_dict, luciole.PointLights([(0.0, 0.0, 1.0)]), camera=scene.cameras[0])
    np.testing.assert_array_equal(same.rgb, picture.rgb)
    with pytest.raises(luciole.InputError, match="camera"):
        luciole.shade(of_dict, [])
    with pytest.raises(luciole.InputError, match="expected position, normal"):
        luciole.shade({"positions": position}, [], camera=scene.cameras[0])
    assert (picture.rgb[0, 0] == 0).all(), "nothing is seen there"
    wanted[0, 0] = 0
    np.testing.assert_allclose(picture.rgb, np.broadcast_to(wanted[:, :, None], (32, 32, 3)), rtol=1e-5)


def test_light_is_baked() -> None:
    uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]
    mesh = square(material=luciole.Material(diffuse=1.0, ambient=0.0), uvs=uvs, name="wall")
    scene = luciole.Scene(mesh, luciole.PointLights([(0.0, 0.0, 1.0)]))
    baked = luciole.bake(scene, "wall", size=(32, 32))
    x = (np.arange(32) + 0.5) / 16 - 1
    d2 = x[None, :] ** 2 + x[:, None] ** 2 + 1
    np.testing.assert_allclose(baked.rgb[:, :, 0], d2**-1.5, rtol=1e-5)
    with pytest.raises(luciole.InputError, match="'floor'"):
        luciole.bake(scene, "floor")


def test_differences_have_closed_forms(tmp_path: Path) -> None:
    a = np.full((4, 5, 3), 0.5, dtype=np.float32)
    b = a + np.float32(0.25)
    d = luciole.compare(a, b)
    assert d["mse"] == 0.0625 and d["rmse"] == 0.25 and d["mean_signed"] == 0.25 and d["max_abs"] == 0.25
    assert d["relmse"] == pytest.approx(0.0625 / 0.26, rel=1e-12)
    assert d["psnr"] == pytest.approx(10 * np.log10(1 / 0.0625), rel=1e-12)
    assert luciole.compare(a, a)["max_abs"] == 0
    assert list(luciole.compare(a, b, ["rmse", "psnr"])) == ["rmse", "psnr"]
    with pytest.raises(luciole.InputError, match="rmsee"):
        luciole.compare(a, b, ["rmsee"])
    np.save(tmp_path / "a.npy", a)
    assert luciole.compare(tmp_path / "a.npy", b)["rmse"] == 0.25


@pytest.mark.parametrize("name, module", [("flip", "flip_evaluator"), ("ssim", "skimage")])
def test_perceptual_metrics_come_where_their_package_is(name: str, module: str) -> None:
    a = luciole.render(lit_square(), size=(32, 32)).rgb
    try:
        __import__(module)
    except ImportError:
        with pytest.raises(luciole.InputError, match="pip install"):
            luciole.compare(a, a, [name])
        return
    same, other = luciole.compare(a, a, [name])[name], luciole.compare(a, a * 0.5, [name])[name]
    assert same == pytest.approx(0 if name == "flip" else 1, abs=1e-6)
    assert other > same if name == "flip" else other < same


def test_a_small_picture_costs_few_milliseconds() -> None:
    """3 ms is the aim for 64 × 64 pixels and a light; the best of some gets ten times that on a loaded machine."""
    renderer = luciole.Renderer(lit_square())
    renderer.render(size=(64, 64))
    times = []
    for _ in range(20):
        begun = time.perf_counter()
        renderer.render(size=(64, 64))
        times.append(time.perf_counter() - begun)
    assert min(times) < 0.03
