"""Scenes from arrays and from files."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath
from typing import Any, Literal, TypeAlias

import numpy as np

from luciole import _luciole
from luciole._arrays import MOST_SIDE, Array, Doubles, array, choice, listed, number, size_of, vector, whole
from luciole._errors import InputError
from luciole.lights import MOST_SOURCE_LIGHTS, Lights, get_lights, set_lights

#: A color: three numbers, or one for all three.
Color: TypeAlias = Sequence[float] | float
#: The names of models that materials and pictures may have.
MODELS: tuple[str, ...] = _luciole.MODELS
#: A material's textures.
_MAPS = ("diffuse_map", "emission_map", "normal_map", "alpha_map")


@dataclass
class Material:
    """How a surface reflects light, by Phong's model.

    ambient, diffuse, specular, emission: linear colours, ≥ 0. shininess: the highlight's exponent, ≥ 0. alpha: opacity, 0 to 1;
    where it, or a map's, is below alpha_cutoff the surface is a hole; with blended it is dithered by its opacity. double_sided:
    both sides are seen. model: one of MODELS, in place of the picture's. Maps: pictures as arrays (H, W), (H, W, 3) or
    (H, W, 4) of uint8 (sRGB) or floats from 0 to 1 (linear); normal_map: tangent-space normals · ½ + ½, y up. emits: how many lights, with
    shadows, take the place of an object's triangles of it that have an emission.
    """

    diffuse: Color = (0.8, 0.8, 0.8)
    specular: Color = (0.0, 0.0, 0.0)
    shininess: float = 0.0
    ambient: Color = (0.2, 0.2, 0.2)
    emission: Color = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    alpha_cutoff: float = 0.0
    blended: bool = False
    double_sided: bool = False
    model: str | None = None
    diffuse_map: Any = None
    emission_map: Any = None
    normal_map: Any = None
    alpha_map: Any = None
    normal_scale: float = 1.0
    emits: int = 0
    name: str = ""


@dataclass
class Mesh:
    """A triangle mesh, and where it stands.

    vertices: (V, 3), metres. triangles: (T, 3), indices of vertices; counter-clockwise ones face the viewer. normals: (V, 3);
    None: smooth ones, but for edges of more than 60 degrees. uvs: (V, 2), (0, 0) is a texture's top left corner.
    colors: (V, 3) or (V, 4), linear, or uint8 in sRGB; they multiply the material's. material: one, or a list of which
    triangle_materials (T,) has each triangle's.
    transforms: (4, 4) or (K, 4, 4), object to world, an instance each; None: one where it is.
    """

    vertices: Any
    triangles: Any
    normals: Any = None
    uvs: Any = None
    colors: Any = None
    material: Material | Sequence[Material] | None = None
    triangle_materials: Any = None
    transforms: Any = None
    name: str = ""

    @classmethod
    def of(cls, mesh: object, transforms: Any = None) -> "Mesh":
        """A mesh of trimesh (Trimesh) or Open3D (TriangleMesh), with its normals, colours and texture. Raises InputError for
        anything else."""
        if isinstance(mesh, Mesh):
            return mesh
        if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
            return _of_trimesh(mesh, transforms)
        if hasattr(mesh, "vertices") and hasattr(mesh, "triangles") and hasattr(mesh, "vertex_normals"):
            return _of_open3d(mesh, transforms)
        raise InputError(f"meshes: expected luciole.Mesh, or one of trimesh or Open3D, got {type(mesh).__name__}")


def _of_trimesh(mesh: Any, transforms: Any) -> Mesh:
    made = Mesh(mesh.vertices, mesh.faces, transforms=transforms)
    visual: Any = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if kind in ("vertex", "face"):
        made.material = Material(diffuse=1.0, ambient=1.0)
    if kind == "vertex":
        made.colors = np.asarray(visual.vertex_colors, dtype=np.uint8)
    elif kind == "face":
        # Corners of their own, and so flat, as trimesh shows faces of a colour.
        corners = np.asarray(mesh.faces).reshape(-1)
        made.vertices = np.asarray(mesh.vertices)[corners]
        made.triangles = np.arange(len(corners)).reshape(-1, 3)
        made.colors = np.repeat(np.asarray(visual.face_colors, dtype=np.uint8), 3, axis=0)
    elif kind == "texture":
        made.material = _trimesh_material(visual.material)
        if visual.uv is not None:
            made.uvs = np.asarray(visual.uv, dtype=np.float32) * (1, -1) + (0, 1)
    return made


def _trimesh_material(material: Any) -> Material:
    """Of SimpleMaterial, or of PBRMaterial as far as Phong's model goes."""

    def color(*names: str) -> tuple[float, ...] | None:
        for name in names:
            given = getattr(material, name, None)
            if given is not None:
                codes = np.asarray(given)
                return tuple(float(c) / (255 if codes.dtype.kind in "iu" else 1) for c in codes[:3])
        return None

    image = getattr(material, "image", None)
    if image is None:
        image = getattr(material, "baseColorTexture", None)
    diffuse = color("baseColorFactor", "diffuse") or (0.8, 0.8, 0.8)
    made = Material(diffuse=diffuse if image is None else (1, 1, 1), ambient=diffuse if image is None else (1, 1, 1))
    made.emission = color("emissiveFactor") or (0.0, 0.0, 0.0)
    made.diffuse_map = None if image is None else _picture(image)
    made.double_sided = bool(getattr(material, "doubleSided", False))
    return made


def _picture(image: Any) -> Array:
    """Of PIL: palettes and grey with alpha as RGBA."""
    mode = getattr(image, "mode", "RGB")
    return np.asarray(image if mode in ("L", "RGB", "RGBA") else image.convert("RGBA"))


def _of_open3d(mesh: Any, transforms: Any) -> Mesh:
    made = Mesh(np.asarray(mesh.vertices), np.asarray(mesh.triangles), transforms=transforms)
    if mesh.has_vertex_normals():
        made.normals = np.asarray(mesh.vertex_normals)
    if mesh.has_vertex_colors():
        made.colors = np.asarray(mesh.vertex_colors)
        made.material = Material(diffuse=1.0, ambient=1.0)
    if mesh.has_triangle_uvs() and mesh.has_textures():
        corners = made.triangles.reshape(-1)
        made.vertices = made.vertices[corners]
        made.normals = None if made.normals is None else made.normals[corners]
        made.colors = None if made.colors is None else made.colors[corners]
        made.triangles = np.arange(len(corners)).reshape(-1, 3)
        made.uvs = np.asarray(mesh.triangle_uvs, dtype=np.float32) * (1, -1) + (0, 1)
        made.material = [Material(diffuse=1.0, ambient=1.0, diffuse_map=np.asarray(one)) for one in mesh.textures]
        made.triangle_materials = np.asarray(mesh.triangle_material_ids)
    return made


@dataclass
class Camera:
    """A camera at camera_to_world (4, 4): x to the right, y up, looking along its −z, as OpenGL's.

    fov_y: the picture's height as an angle, degrees. near, far: metres. half_height: metres; makes it orthographic. shift: where
    the axis meets the picture, in halves of its size from its middle, x right, y up. pixel_aspect: width by height of what a
    pixel shows. target: what it looks at, where that is known.
    """

    camera_to_world: Any = field(default_factory=lambda: np.eye(4))
    fov_y: float = 45.0
    near: float = 0.1
    far: float = 1000.0
    half_height: float | None = None
    shift: tuple[float, float] = (0.0, 0.0)
    pixel_aspect: float = 1.0
    target: Sequence[float] | None = None
    up: Sequence[float] = (0.0, 1.0, 0.0)
    name: str = ""

    @classmethod
    def look_at(
        cls, eye: Sequence[float], target: Sequence[float], up: Sequence[float] = (0.0, 1.0, 0.0), **others: Any
    ) -> "Camera":
        """A camera at `eye` that looks at `target`, world, metres. others: fov_y and the like."""
        places = vector(eye, "eye"), vector(target, "target"), vector(up, "up")
        along = np.subtract(places[1], places[0])
        if not np.linalg.norm(np.cross(along, places[2])) > 1e-12 * np.linalg.norm(along) * np.linalg.norm(places[2]):
            raise InputError("up: expected a direction that isn't parallel to the view")
        return cls(_luciole.look_at(*places), target=places[1], up=places[2], **others)

    @classmethod
    def from_matrix(
        cls,
        camera_to_world: Any = None,
        *,
        world_to_camera: Any = None,
        convention: Literal["opengl", "opencv"] = "opengl",
        **others: Any,
    ) -> "Camera":
        """A camera by one of its two matrices, (4, 4), or (3, 4) as OpenCV's [R | t].

        convention: "opengl": x right, y up, looking along −z, as OpenGL, glTF, Blender and pyrender. "opencv": x right, y down,
        looking along +z, as OpenCV, COLMAP and Open3D.
        """
        if (camera_to_world is None) == (world_to_camera is None):
            raise InputError("camera: expected one of camera_to_world and world_to_camera")
        is_opencv = choice(convention, "convention", ("opengl", "opencv"))
        name = "world_to_camera" if camera_to_world is None else "camera_to_world"
        given = world_to_camera if camera_to_world is None else camera_to_world
        matrix = array(given, name, (4, 4), (3, 4), dtype=np.float64)
        if matrix.shape[0] == 3:
            matrix = np.vstack([matrix, (0, 0, 0, 1)])
        # Exact where a rotation is exact; a general inverse would lose digits.
        rotation, translation = matrix[:3, :3], matrix[:3, 3]
        if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-4) or np.linalg.det(rotation) < 0:
            raise InputError(f"{name}: expected a rotation and a translation")
        if camera_to_world is None:
            rotation, translation = rotation.T, -rotation.T @ translation
        if is_opencv:
            rotation = rotation * (1, -1, -1)
        made = np.eye(4)
        made[:3, :3], made[:3, 3] = rotation, translation
        return cls(made, **others)

    @classmethod
    def from_intrinsics(
        cls,
        K: Any,  # noqa: N803
        size: tuple[int, int],
        camera_to_world: Any = None,
        *,
        world_to_camera: Any = None,
        convention: Literal["opengl", "opencv"] = "opencv",
        **others: Any,
    ) -> "Camera":
        """A camera of a calibrated lens: K = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], in pixels of a picture of this size (width,
        height). As OpenCV has it, the middle of the top left pixel is (0, 0). Render with the same size, or one of its shape.
        Raises InputError for skew. Matrices: see from_matrix; without one the camera is at the origin.
        """
        k = array(K, "K", (3, 3), dtype=np.float64)
        width, height = size_of(size)
        (fx, skew, cx), (low, fy, cy) = k[0], k[1]
        if skew != 0 or low != 0 or not np.array_equal(k[2], (0, 0, 1)):
            raise InputError("K: expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], without skew")
        if not (fx > 0 and fy > 0):
            raise InputError(f"K: expected focal lengths above 0, got {fx:g} and {fy:g}")
        if camera_to_world is None and world_to_camera is None:
            camera_to_world = np.eye(4)
        lens = {
            "fov_y": float(np.degrees(2 * np.arctan(height / (2 * fy)))),
            "shift": (2 * (cx + 0.5) / width - 1, 1 - 2 * (cy + 0.5) / height),
            "pixel_aspect": fy / fx,
        }
        return cls.from_matrix(
            camera_to_world, world_to_camera=world_to_camera, convention=convention, **{**lens, **others}
        )

    def _made(self) -> "_luciole.Camera":
        shift = array(self.shift, "camera.shift", (2,), dtype=np.float64)
        return _luciole.camera(
            name=self.name,
            camera_to_world=array(self.camera_to_world, "camera.camera_to_world", (4, 4), dtype=np.float64),
            orthographic=self.half_height is not None,
            fov_y=np.radians(number(self.fov_y, "camera.fov_y")),
            half_height=1.0 if self.half_height is None else number(self.half_height, "camera.half_height"),
            shift=(float(shift[0]), float(shift[1])),
            pixel_aspect=number(self.pixel_aspect, "camera.pixel_aspect"),
            near=number(self.near, "camera.near"),
            far=number(self.far, "camera.far"),
            target=None if self.target is None else vector(self.target, "camera.target"),
            up=vector(self.up, "camera.up"),
        )

    @classmethod
    def _of(cls, made: "_luciole.Camera") -> "Camera":
        return cls(
            made.camera_to_world,
            fov_y=float(np.degrees(made.fov_y)),
            near=made.near,
            far=made.far,
            half_height=made.half_height if made.orthographic else None,
            shift=made.shift,
            pixel_aspect=made.pixel_aspect,
            target=made.target,
            up=made.up,
            name=made.name,
        )


@dataclass
class Fog:
    """OpenGL's fog: mode "linear" from start to end (metres), "exp" or "exp2" by density (1/m, one number or three).

    radial: by the distance from the eye instead of the depth.
    """

    mode: Literal["none", "linear", "exp", "exp2"] = "exp2"
    density: Color = 1.0
    color: Color = (0.0, 0.0, 0.0)
    start: float = 0.0
    end: float = 1.0
    radial: bool = False

    MODES = ("none", "linear", "exp", "exp2")


class _Builder:
    """Fills a scene with meshes; a material or a texture that stands several times is made once."""

    def __init__(self, scene: "_luciole.Scene") -> None:
        self.scene = scene
        self.materials: dict[int, int] = {}
        self.textures: dict[tuple[int, str], int] = {}
        self.kept: list[object] = []  # so that no other object gets its identity

    def texture(self, picture: object, name: str) -> int:
        if picture is None:
            return -1
        key = id(picture), name
        if key not in self.textures:
            self.kept.append(picture)
            self.textures[key] = _add_texture(self.scene, picture, name)
        return self.textures[key]

    def material(self, material: Material | None) -> int:
        given = Material() if material is None else material
        key = 0 if material is None else id(given)
        if key not in self.materials:
            self.kept.append(given)
            maps = [self.texture(getattr(given, name), name) for name in _MAPS]
            self.materials[key] = _set_material(self.scene, -1, given, maps)
        return self.materials[key]

    def mesh(self, mesh: Mesh) -> None:
        vertices = array(mesh.vertices, "mesh.vertices", ("V", 3))
        sides = {"V": len(vertices)}
        triangles = array(mesh.triangles, "mesh.triangles", ("T", 3), dtype=np.uint32)
        if triangles.size > 0 and triangles.max() >= len(vertices):
            raise InputError(f"mesh.triangles: refers to vertex {triangles.max()}, but the mesh has {len(vertices)}")

        def rows(value: object, name: str, width: int) -> Array | None:
            return None if value is None else array(value, f"mesh.{name}", ("V", width), sides=sides)

        several = listed(mesh.material, (Material, type(None)), "mesh.material", "luciole.Material or a list of them")
        materials = np.array([self.material(one) for one in several], dtype=np.uint32)
        if len(materials) == 0:
            raise InputError("mesh.material: expected one at least")
        if mesh.triangle_materials is None:
            of_triangle = np.full(len(triangles), materials[0], dtype=np.uint32)
        else:
            chosen = array(
                mesh.triangle_materials, "mesh.triangle_materials", ("T",), dtype=np.int64, sides={"T": len(triangles)}
            )
            if chosen.size > 0 and not (0 <= chosen.min() and chosen.max() < len(materials)):
                raise InputError(f"mesh.triangle_materials: expected 0 to {len(materials) - 1}")
            of_triangle = materials[chosen]
        index = self.scene.add_mesh(
            name=mesh.name,
            positions=vertices,
            normals=_unit(rows(mesh.normals, "normals", 3)),
            uvs=rows(mesh.uvs, "uvs", 2),
            colors=_colors(mesh.colors, sides),
            triangles=triangles,
            triangle_materials=of_triangle,
        )
        transforms = np.eye(4) if mesh.transforms is None else mesh.transforms
        self.scene.add_objects(index, _transforms(transforms, "mesh.transforms"), -1, mesh.name)


def _transforms(value: object, name: str) -> Doubles:
    return array(value, name, ("K", 4, 4), (4, 4), dtype=np.float64).reshape(-1, 4, 4)


def _unit(given: Array | None) -> Array | None:
    """Normals of length 1."""
    if given is None:
        return None
    lengths = np.linalg.norm(given, axis=1, keepdims=True)
    if given.size > 0 and not lengths.min() > 0:
        raise InputError(f"mesh.normals[{int(lengths.argmin())}]: expected a direction of any length but 0")
    made: Array = (given / lengths).astype(np.float32)
    return made


def _linear(codes: Array) -> Array:
    """The linear light of sRGB codes from 0 to 1 (IEC 61966-2-1)."""
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def _colors(value: object, sides: Mapping[str, int]) -> Array | None:
    if value is None:
        return None
    codes = np.asarray(value).dtype == np.uint8
    given = array(value, "mesh.colors", ("V", 4), ("V", 3), sides=sides)
    made = np.ones((len(given), 4), dtype=np.float32)
    made[:, : given.shape[1]] = given
    if codes:
        made[:, : given.shape[1]] /= 255
        made[:, :3] = _linear(made[:, :3])
    return made


def _add_texture(scene: "_luciole.Scene", picture: object, name: str) -> int:
    is_codes = np.asarray(picture).dtype == np.uint8
    given = array(picture, f"material.{name}", ("H", "W"), ("H", "W", 3), ("H", "W", 4), dtype=np.uint8 if is_codes else np.float32)
    if given.ndim == 2:
        given = given[:, :, np.newaxis].repeat(3, axis=2)
    height, width, channels = given.shape
    if not (1 <= height <= MOST_SIDE and 1 <= width <= MOST_SIDE):
        raise InputError(f"material.{name}: expected sides from 1 to {MOST_SIDE}, got {given.shape}")
    texels = np.full((height, width, 4), 65535, dtype=np.uint16)
    if is_codes:
        texels[:, :, :channels] = given.astype(np.uint16) * 257
    else:
        texels[:, :, :channels] = np.rint(np.clip(given, 0, 1) * 65535)
    return int(scene.add_texture(texels, name == "normal_map", not is_codes, name))


def _set_material(scene: "_luciole.Scene", index: int, given: Material, maps: Sequence[int]) -> int:
    model = -1 if given.model is None else choice(given.model, "material.model", MODELS)

    def color(name: str) -> tuple[float, float, float]:
        made = vector(getattr(given, name), f"material.{name}")
        if min(made) < 0:
            raise InputError(f"material.{name}: expected 0 or more, got {min(made):g}")
        return made

    return int(
        scene.set_material(
            index,
            given.name,
            color("ambient"),
            color("diffuse"),
            color("specular"),
            color("emission"),
            number(given.shininess, "material.shininess", 0, 1e9),
            number(given.alpha, "material.alpha", 0, 1),
            number(given.alpha_cutoff, "material.alpha_cutoff", 0, 1),
            given.blended,
            given.double_sided,
            model,
            list(maps),
            number(given.normal_scale, "material.normal_scale", -1000, 1000),
            whole(given.emits, "material.emits", 0, MOST_SOURCE_LIGHTS),
        )
    )


class Scene:
    """Everything a picture is made of.

    meshes: Mesh, or meshes of trimesh and Open3D, or a list of them. lights: PointLights, SpotLights, DirectionalLights,
    Environment, AreaLight, or a list of them; None: some that show the meshes; []: none. cameras: Camera or a list; none: one that sees all. background,
    ambient: linear colours. fog: Fog. size: of pictures that don't say theirs. lighting: False shows surfaces unlit.

    Lights, cameras, transforms, materials and surroundings may be changed at any time. Any thread may use a scene; calls take
    turns. Raises InputError.
    """

    def __init__(
        self,
        meshes: Any = (),
        lights: Any = None,
        cameras: Any = (),
        *,
        background: Color = (0.0, 0.0, 0.0),
        ambient: Color = (0.0, 0.0, 0.0),
        fog: Fog | None = None,
        size: tuple[int, int] | None = None,
        lighting: bool = True,
    ) -> None:
        self._handle = _luciole.Scene()
        builder = _Builder(self._handle)
        for mesh in meshes if isinstance(meshes, (list, tuple)) else [meshes]:
            for one, transforms in _parts(mesh):
                builder.mesh(Mesh.of(one, transforms))
        self._handle.finish_meshes()
        if lights is not None:
            self.lights = lights
        self.cameras = cameras
        if size is not None:
            self.size = size
        self._set_surroundings(background, ambient, lighting, fog)
        self._handle.complete(lights is not None)

    @classmethod
    def _of(cls, handle: "_luciole.Scene") -> "Scene":
        made = cls.__new__(cls)
        made._handle = handle
        return made

    def __repr__(self) -> str:
        counts = self._handle.counts()
        parts = [f"{counts[name]} {name}" for name in ("meshes", "objects", "triangles", "materials")]
        return f"<luciole.Scene {self.name}: {', '.join(parts)}, {self._handle.light_count()} lights>"

    @property
    def name(self) -> str:
        """The file, of a scene that was loaded."""
        return str(self._handle.name())

    @property
    def warnings(self) -> list[str]:
        """What in its file was repaired or isn't shown, a line each."""
        return list(self._handle.warnings())

    @property
    def lights(self) -> list[Lights]:
        """The lights as arrays: copies, by kind, degrees where people write degrees. Set it to replace them all."""
        return get_lights(self._handle)

    @lights.setter
    def lights(self, value: Any) -> None:
        set_lights(self._handle, value)

    @property
    def cameras(self) -> list[Camera]:
        """The cameras: copies. Set it to replace them; of several the first is a picture's unless it says another."""
        return [Camera._of(camera) for camera in self._handle.cameras()]

    @cameras.setter
    def cameras(self, value: Any) -> None:
        cameras = listed(value, Camera, "cameras", "luciole.Camera or a list of them")
        self._handle.set_cameras([camera._made() for camera in cameras])

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height in pixels of a picture that doesn't say them; None: 1280 × 720."""
        made = self._handle.size()
        return None if made is None else (made[0], made[1])

    @size.setter
    def size(self, value: tuple[int, int]) -> None:
        self._handle.set_size(*size_of(value))

    @property
    def transforms(self) -> Doubles:
        """Where the objects are: (K, 4, 4), object to world, a copy. Set it to move them all."""
        made: Doubles = self._handle.transforms()
        return made

    @transforms.setter
    def transforms(self, value: Any) -> None:
        count = self._handle.counts()["objects"]
        made = array(value, "transforms", ("K", 4, 4), dtype=np.float64, sides={"K": count})
        self._handle.set_transforms(0, made)

    def move(self, first: int, transforms: Any) -> None:
        """Moves objects from the index `first` on: (4, 4) or (K, 4, 4), object to world."""
        count = self._handle.counts()["objects"]
        self._handle.set_transforms(whole(first, "first", 0, count), _transforms(transforms, "transforms"))

    @property
    def objects(self) -> list[str]:
        """The objects' names. Their indices are those of the layer object_id."""
        return list(self._handle.object_names())

    def set_material(self, index: int, material: Material) -> None:
        """Replaces a material, but for its maps."""
        last = int(self._handle.counts()["materials"]) - 1
        if not isinstance(material, Material):
            raise InputError(f"material: expected luciole.Material, got {type(material).__name__}")
        if any(getattr(material, name) is not None for name in _MAPS):
            raise InputError("material: its maps can't be replaced; leave them out to keep those that it has")
        _set_material(self._handle, whole(index, "index", 0, last), material, [-2] * len(_MAPS))

    def _set_surroundings(self, background: Color, ambient: Color, lighting: bool, fog: Fog | None) -> None:
        given = Fog("none") if fog is None else fog
        if not isinstance(given, Fog):
            raise InputError(f"fog: expected luciole.Fog, got {type(given).__name__}")
        self._handle.set_surroundings(
            vector(background, "background"),
            vector(ambient, "ambient"),
            bool(lighting),
            choice(given.mode, "fog.mode", Fog.MODES),
            bool(given.radial),
            vector(given.density, "fog.density"),
            number(given.start, "fog.start"),
            number(given.end, "fog.end"),
            vector(given.color, "fog.color"),
        )

    @property
    def background(self) -> tuple[float, float, float]:
        """Linear."""
        return self._surroundings()[0]

    @background.setter
    def background(self, value: Color) -> None:
        _, ambient, lighting, fog = self._surroundings()
        self._set_surroundings(value, ambient, lighting, fog)

    @property
    def ambient(self) -> tuple[float, float, float]:
        """The light that comes from everywhere, linear."""
        return self._surroundings()[1]

    @ambient.setter
    def ambient(self, value: Color) -> None:
        background, _, lighting, fog = self._surroundings()
        self._set_surroundings(background, value, lighting, fog)

    @property
    def fog(self) -> Fog | None:
        """The fog, a copy."""
        return self._surroundings()[3]

    @fog.setter
    def fog(self, value: Fog | None) -> None:
        background, ambient, lighting, _ = self._surroundings()
        self._set_surroundings(background, ambient, lighting, value)

    def _surroundings(
        self,
    ) -> tuple[tuple[float, float, float], tuple[float, float, float], bool, Fog | None]:
        background, ambient, lighting, mode, radial, density, start, end, color = self._handle.surroundings()
        fog = Fog(Fog.MODES[mode], tuple(density), tuple(color), start, end, radial) if mode else None  # type: ignore[arg-type]
        return tuple(background), tuple(ambient), lighting, fog

    def pose(self, frame: float) -> None:
        """Shows a scene that moves as it is at a frame, which may be fractional."""
        self._handle.pose(number(frame, "frame"))

    def copy(self) -> "Scene":
        """Another scene that is the same, in no Renderer."""
        return Scene._of(self._handle.copy())


def _parts(mesh: object) -> list[tuple[object, Any]]:
    """The meshes of trimesh's Scene, each with its transforms; any other mesh by itself."""
    graph, geometry = getattr(mesh, "graph", None), getattr(mesh, "geometry", None)
    if graph is None or geometry is None:
        return [(mesh, None)]
    placed: dict[str, list[Any]] = {}
    for node in graph.nodes_geometry:
        transform, name = graph[node]
        placed.setdefault(name, []).append(transform)
    return [(geometry[name], np.stack(transforms)) for name, transforms in placed.items()]


def load(
    path: str | PathLike[str],
    frame: float = 1,
    *,
    missing_textures: Literal["error", "warn"] = "error",
    strict: bool = False,
    search: Sequence[str | PathLike[str]] = (),
    variant: str = "",
    animation: str = "",
    tangents: bool = False,
    set: Mapping[str, Any] | Sequence[str] = (),  # noqa: A002
    environment: str | PathLike[str] = "",
) -> Scene:
    """A scene from a file: Luciole's .json, .obj, .gltf or .glb, completed by a camera and lights where it has none.

    frame: at which a scene that moves is shown. missing_textures: "warn" draws without them. strict: what breaks the format's
    rules is refused, not repaired. search: folders of files that aren't where the scene says. variant, animation: of a glTF
    file, by name. tangents: also where no normal map needs them, for surface files. set: other values in places of the file,
    ``{"lights[0].intensity": 4}`` or ``["lights[0].intensity=4"]``. environment: a picture of the sky, in place of the scene's (see Environment). Raises InputError, or MachineError where it doesn't fit
    into memory.
    """
    warns = choice(missing_textures, "missing_textures", ("error", "warn")) == 1
    if isinstance(set, Mapping):
        changes = [f"{place}={value if isinstance(value, str) else json.dumps(value)}" for place, value in set.items()]
    else:
        changes = [str(change) for change in set]
    return Scene._of(
        _luciole.load(
            path=fspath(path),
            frame=number(frame, "frame"),
            missing_textures_warn=warns,
            strict=strict,
            search=[fspath(folder) for folder in search],
            variant=variant,
            animation=animation,
            tangents=tangents,
            changes=changes,
            environment=fspath(environment),
        )
    )
