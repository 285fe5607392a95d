"""Scenes from arrays."""

import time

import numpy as np
import pytest
from scenes import SCENES, lit_square, sphere, square

import luciole


def test_a_mesh_alone_is_framed_and_lit() -> None:
    picture = luciole.render(luciole.Scene(sphere()), size=(64, 48), aovs=["object_id"])
    seen = picture["object_id"] == 0
    assert 0.1 < seen.mean() < 0.9
    assert picture.rgb[seen].max() > 0.1


def test_a_million_lights_are_taken_in_a_moment_and_once() -> None:
    """0.1 s is the aim; a loaded machine gets ten times that. Memory: each light once, no second copy."""
    random = np.random.default_rng(3)
    lights = luciole.PointLights(random.random((1_000_000, 3), np.float32), random.random((1_000_000, 3), np.float32))
    scene = lit_square()
    scene.lights = lights
    times = []
    for _ in range(3):
        begun = time.perf_counter()
        scene.lights = lights
        times.append(time.perf_counter() - begun)
    assert min(times) < 1
    assert len(scene.lights[0]) == 1_000_000


def test_lights_come_back_as_they_were_set() -> None:
    scene = lit_square()
    n = 5
    random = np.random.default_rng(4)
    points = luciole.PointLights(
        random.random((n, 3)),
        random.random((n, 3), np.float32),
        range=random.random(n, np.float32) + 1,
        attenuation=random.random((n, 3), np.float32),
        cast_shadows=random.random(n) > 0.5,
        radius=random.random(n),
        window="khr",
        group="lamps",
    )
    spots = luciole.SpotLights(random.random((n, 3)), random.random((n, 3)), cutoff=np.linspace(10, 90, n), inner_cone=5)
    suns = luciole.DirectionalLights([(0, -1, 0)], (2, 1, 1), angle=0.5, cast_shadows=True)
    scene.lights = [points, spots, suns]
    back = scene.lights
    assert [type(some).__name__ for some in back] == ["DirectionalLights", "SpotLights", "PointLights"]
    for name in ("position", "color", "range", "attenuation", "cast_shadows", "radius"):
        np.testing.assert_array_equal(getattr(back[2], name), getattr(points, name), err_msg=name)
    assert back[2].window == "khr" and back[2].group == "lamps"
    np.testing.assert_allclose(back[1].cutoff, spots.cutoff, rtol=1e-15)
    np.testing.assert_allclose(back[0].angle, [0.5], rtol=1e-15)
    assert len(back[0]) == 1 and len(back[1]) == n


def test_wrong_lights_leave_the_scene_as_it_was() -> None:
    scene = lit_square()
    before = luciole.render(scene, size=(8, 8)).rgb
    with pytest.raises(luciole.InputError):
        scene.lights = [luciole.PointLights(np.zeros((3, 3))), luciole.PointLights(np.zeros((3, 100)))]
    np.testing.assert_array_equal(luciole.render(scene, size=(8, 8)).rgb, before)


def test_groups_of_lights_are_layers() -> None:
    scene = lit_square()
    scene.lights = [
        luciole.PointLights([(0, 0, 1.0)], (1, 0, 0), group="red"),
        luciole.PointLights([(0, 0, 1.0)], (0, 1, 0), group="green"),
    ]
    picture = luciole.render(scene, size=(8, 8), light_groups=True)
    assert (picture["light_groups.red"][:, :, 1] == 0).all()
    assert (picture["light_groups.green"][:, :, 1] > 0).all()


def test_instances_stand_where_their_transforms_say() -> None:
    transforms = np.tile(np.eye(4), (3, 1, 1))
    transforms[:, 0, 3] = (-1, 0, 1)
    transforms[:, :3, :3] *= 0.4
    mesh = square(transforms=transforms)
    scene = luciole.Scene(mesh, cameras=luciole.Camera(half_height=1.5, camera_to_world=np.eye(4) + 3 * np.eye(4, k=1) * [[0], [0], [1], [0]]))
    ids = luciole.render(scene, size=(60, 60), aovs=["object_id"])["object_id"]
    assert [ids[30, 10], ids[30, 30], ids[30, 50], ids[30, 20]] == [0, 1, 2, -1]
    assert scene.transforms.shape == (3, 4, 4)
    np.testing.assert_array_equal(scene.transforms, transforms)
    scene.move(1, transforms[0])
    np.testing.assert_array_equal(scene.transforms[1], transforms[0])


@pytest.mark.parametrize("convention", ["opengl", "opencv"])
def test_a_cameras_matrix_projects_as_its_convention_says(convention: str) -> None:
    """Each pixel's position, projected by K (R X + t), is the pixel's middle. A position is a float: its error of some 2^-22 of
    3 m is 1e-6 m, which is 1e-3 pixels at 600 pixels of focal length and 1 m."""
    turn = 0.3
    rotation = np.array([(np.cos(turn), 0, np.sin(turn)), (0, 1, 0), (-np.sin(turn), 0, np.cos(turn))])
    world_to_camera = np.eye(4)
    world_to_camera[:3, :3] = rotation if convention == "opengl" else np.diag([1, -1, -1]) @ rotation
    world_to_camera[:3, 3] = (0.1, -0.05, -2.0) if convention == "opengl" else (0.1, 0.05, 2.0)
    size = (64, 48)
    K = np.array([(70.0, 0, 30.3), (0, 66.0, 25.8), (0, 0, 1)])
    camera = luciole.Camera.from_intrinsics(K, size, world_to_camera=world_to_camera, convention=convention)
    scene = luciole.Scene(square(8.0), cameras=camera)
    picture = luciole.render(scene, size=size, aovs=["position", "depth"])
    seen = picture["depth"] < 10
    assert seen.mean() > 0.5
    places = picture["position"][seen].astype(np.float64)
    of_camera = places @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
    if convention == "opengl":
        of_camera = of_camera * (1, -1, -1)
    projected = of_camera @ K.T
    y, x = np.nonzero(seen)
    np.testing.assert_allclose(projected[:, :2] / projected[:, 2:], np.stack([x, y], 1), atol=1e-3)
    np.testing.assert_allclose(picture["depth"][seen], of_camera[:, 2], rtol=1e-5)


def test_cameras_come_back_as_they_were_set() -> None:
    scene = lit_square()
    given = [
        luciole.Camera.look_at((1, 2, 3), (0, 0, 0), fov_y=30, near=0.5, far=50, name="front"),
        luciole.Camera(half_height=2.0, name="plan"),
    ]
    scene.cameras = given
    for one, back in zip(given, scene.cameras):
        np.testing.assert_array_equal(back.camera_to_world, one.camera_to_world)
        assert (back.name, back.near, back.far, back.half_height) == (one.name, one.near, one.far, one.half_height)
        assert back.fov_y == pytest.approx(one.fov_y, rel=1e-15)
    by_name = luciole.render(scene, size=(16, 16), camera="plan").rgb
    np.testing.assert_array_equal(luciole.render(scene, size=(16, 16), camera=1).rgb, by_name)
    np.testing.assert_array_equal(luciole.render(scene, size=(16, 16), camera=given[1]).rgb, by_name)


def test_colours_and_textures_multiply() -> None:
    """Codes 188 of a texture are 0.5029 of linear light, by the definition of sRGB."""
    picture = np.full((8, 8, 3), 188, dtype=np.uint8)
    plain = lit_square()
    material = luciole.Material(diffuse=1.0, ambient=0.0, diffuse_map=picture)
    mesh = square(material=material, uvs=[(0, 1), (1, 1), (1, 0), (0, 0)], colors=np.full((4, 3), 0.5))
    textured = luciole.Scene(mesh, plain.lights, plain.cameras)
    ratio = luciole.render(textured, size=(16, 16)).rgb / luciole.render(plain, size=(16, 16)).rgb
    linear = ((188 / 255 + 0.055) / 1.055) ** 2.4
    # Texels are kept as 16-bit numbers, the coarser of which hold square roots: 2^-16 twice over.
    np.testing.assert_allclose(ratio, 0.5 * linear, rtol=1e-4)
    codes = square(material=luciole.Material(diffuse=1.0, ambient=0.0), colors=np.full((4, 3), 188, dtype=np.uint8))
    of_codes = luciole.render(luciole.Scene(codes, plain.lights, plain.cameras), size=(16, 16)).rgb
    np.testing.assert_allclose(of_codes / luciole.render(plain, size=(16, 16)).rgb, linear, rtol=1e-5)


def test_triangles_choose_materials_and_materials_change() -> None:
    red, green = (luciole.Material(diffuse=c, ambient=0.0) for c in ((1, 0, 0), (0, 1, 0)))
    scene = lit_square()
    mesh = square(material=[red, green], triangle_materials=[1, 0])
    two = luciole.Scene(mesh, scene.lights, scene.cameras)
    before = luciole.render(two, size=(16, 16)).rgb
    assert before[12, 12, 1] > 0 and before[12, 12, 0] == 0
    assert before[3, 3, 0] > 0 and before[3, 3, 1] == 0
    two.set_material(1, luciole.Material(diffuse=(0, 0, 1), ambient=0.0))
    assert luciole.render(two, size=(16, 16)).rgb[12, 12, 2] > 0


def test_fog_hides() -> None:
    scene = lit_square(fog=luciole.Fog("linear", start=0, end=1, color=(0.25, 0.5, 0.75)))
    np.testing.assert_array_equal(luciole.render(scene, size=(4, 4)).rgb[2, 2], (0.25, 0.5, 0.75))
    assert scene.fog.mode == "linear"
    scene.fog = None
    assert scene.fog is None
    scene.background = (1, 2, 3)
    assert scene.background == (1, 2, 3) and scene.ambient == (0, 0, 0)


def test_normals_are_smooth_where_none_are_given() -> None:
    ball = sphere(16)
    ball.normals = None
    layer = luciole.render(luciole.Scene(ball), size=(64, 64), aovs=["normal", "position", "object_id"])
    seen = layer["object_id"] == 0
    # A smooth normal differs from the ball's by less than half of a facet's angle, π/32 radians.
    cosine = (layer["normal"][seen] * layer["position"][seen]).sum(-1) / np.linalg.norm(layer["position"][seen], axis=-1)
    assert np.quantile(cosine, 0.01) > np.cos(np.pi / 32)


def test_edges_are_sharp_where_boxes_have_them() -> None:
    """Eight corners that all faces share: each face's normal is its own. And a box that is below another is in its shadow."""
    x = np.array([(i & 1, i >> 1 & 1, i >> 2) for i in range(8)], dtype=np.float32) * 2 - 1
    faces = [(0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6)]
    box = luciole.Mesh(x, faces)
    below = luciole.Mesh(x * (4, 0.1, 4) - (0, 3, 0), faces)
    lights = luciole.PointLights([(0.0, 5, 0)], 20.0, cast_shadows=True)
    camera = luciole.Camera.look_at((6, 2, 9), (0, -1, 0), fov_y=60)
    picture = luciole.render(luciole.Scene([box, below], lights, camera), size=(64, 64), aovs=["normal", "object_id", "position"])
    seen = picture["object_id"] >= 0
    # They went through view space: a rotation rounds by some 2^-23.
    np.testing.assert_allclose(np.sort(np.abs(picture["normal"][seen]), axis=1), np.tile((0, 0, 1), (seen.sum(), 1)), atol=1e-6)
    floor = (picture["object_id"] == 1) & (picture["normal"][:, :, 1] > 0.9)
    # The light is 5 m up, the box 1 m, the floor 2.9 m below: the shadow is 2 · 7.9 / 4 m wide.
    inside = floor & (np.abs(picture["position"][:, :, (0, 2)]).max(axis=2) < 1.9)
    outside = floor & (np.abs(picture["position"][:, :, (0, 2)]).max(axis=2) > 2.05)
    assert inside.any() and picture.rgb[inside].max() == 0
    assert outside.any() and picture.rgb[outside].min() > 0


def test_files_are_loaded_with_changes() -> None:
    scene = luciole.load(SCENES / "cornell.json", set={"ambient": [0.5, 0.5, 0.5]})
    assert scene.ambient == (0.5, 0.5, 0.5)
    assert "cornell.json" in repr(scene)
    with pytest.raises(luciole.InputError, match="nowhere.json"):
        luciole.load("nowhere.json")


def test_meshes_of_trimesh_are_taken() -> None:
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    box.visual.face_colors = [255, 0, 0, 255]
    scene = luciole.Scene(box)
    picture = luciole.render(scene, size=(32, 32), aovs=["object_id"])
    lit = picture.rgb[picture["object_id"] == 0]
    assert lit[:, 0].max() > 0.1 and lit[:, 1].max() == 0
    placed = trimesh.Scene()
    placed.add_geometry(box, transform=trimesh.transformations.translation_matrix((3, 0, 0)))
    placed.add_geometry(trimesh.creation.icosphere())
    assert len(luciole.Scene(placed).objects) == 2


def test_meshes_of_open3d_are_taken() -> None:
    """By an object that has what Open3D's has: its own is 400 MB."""

    class TriangleMesh:
        vertices = sphere().vertices
        triangles = sphere().triangles
        vertex_normals = sphere().normals
        vertex_colors = np.tile((0.0, 1.0, 0.0), (len(sphere().vertices), 1))

        def has_vertex_normals(self) -> bool:
            return True

        has_vertex_colors = has_vertex_normals

        def has_triangle_uvs(self) -> bool:
            return False

        has_textures = has_triangle_uvs

    picture = luciole.render(luciole.Scene(TriangleMesh()), size=(32, 32), aovs=["object_id"])
    lit = picture.rgb[picture["object_id"] == 0]
    assert lit[:, 1].max() > 0.1 and lit[:, 0].max() == 0


def test_a_scene_that_moves_is_posed_and_loses_what_moved_what_is_replaced() -> None:
    scene = luciole.load(SCENES / "fireflies.json")
    first = luciole.render(scene, size=(32, 18)).rgb
    scene.pose(40.5)
    assert (luciole.render(scene, size=(32, 18)).rgb != first).any()
    scene.lights = luciole.PointLights([(0.0, 3.0, 0.0)])
    scene.cameras = luciole.Camera.look_at((0, 2, 8), (0, 1, 0))
    scene.pose(50)
    assert len(scene.lights[0]) == 1 and luciole.render(scene, size=(32, 18)).rgb.shape == (18, 32, 3)


def test_skies_and_faces_are_many_lights() -> None:
    corners = [(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)]
    floor = luciole.Mesh(corners, [(0, 1, 2), (0, 2, 3)], material=luciole.Material(diffuse=1.0))
    above = luciole.Camera.look_at((0, 3, 0.01), (0, 0, 0), fov_y=10)
    white = luciole.Environment(np.ones((8, 16, 3), np.float32), count=1024, cast_shadows=False)
    scene = luciole.Scene(floor, lights=white, cameras=above)
    lit = luciole.render(scene, size=(16, 16)).rgb
    assert np.abs(lit - 1).max() < 0.03  # the horizon cuts some of the 1024 cells
    few = luciole.render(scene, size=(16, 16), light_count=15).rgb
    assert not np.array_equal(few, lit)  # 15 cells can't meet at the horizon, as 16 do
    assert np.array_equal(luciole.render(scene, size=(16, 16)).rgb, lit)
    panel = luciole.AreaLight((0, 1, 0), (0, -1, 0), 0.5, 0.5, color=2.0, count=64)
    scene.lights = [panel, luciole.PointLights([(0, 2, 0)])]
    kinds = [type(lights).__name__ for lights in scene.lights]
    assert kinds == ["PointLights", "AreaLight"]
    assert luciole.render(scene, size=(16, 16)).rgb.max() > 0.25
    with pytest.raises(luciole.InputError, match="two environments"):
        scene.lights = [white, white]
    with pytest.raises(luciole.InputError, match="count"):
        scene.lights = luciole.AreaLight((0, 1, 0), (0, -1, 0), count=10**7)


def test_what_glows_lights() -> None:
    lamp = luciole.Material(emission=3.0, emits=64)
    corners = [(-0.3, 1, -0.3), (0.3, 1, -0.3), (0.3, 1, 0.3), (-0.3, 1, 0.3)]
    glow = luciole.Mesh(corners, [(0, 1, 2), (0, 2, 3)], material=lamp)
    floor = luciole.Mesh([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)], [(0, 1, 2), (0, 2, 3)])
    scene = luciole.Scene([glow, floor], lights=[], cameras=luciole.Camera.look_at((0, 0.6, 3), (0, 0, 0), fov_y=30))
    assert luciole.render(scene, size=(32, 32)).rgb[16:].max() > 0.05
