"""Pictures: rendering, shading, references, and what differs between two."""

import json
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from luciole import _luciole
from luciole._arrays import MOST_SIDE, Array, Doubles, Floats, array, listed, srgb_codes, whole
from luciole._errors import InputError, MachineError
from luciole.lights import lights_of
from luciole.scene import Camera, Scene
from luciole.settings import (
    FileKeywords,
    Path,
    PictureKeywords,
    initial_texts,
    keyword_help,
    paths_of,
    rows,
    texts_of,
)

#: Layers whose channels have other names in files.
_CHANNELS = {"position": "P", "normal": "N", "depth": "Z"}
_OTHERS = ("camera", "surface", "screen", "device", "progress", "aovs")
_devices: dict[str, "_luciole.Device"] = {}


def _device(selector: str) -> "_luciole.Device":
    """The device of this selector, which is opened once."""
    if selector not in _devices:
        try:
            _devices[selector] = _luciole.open_device(selector)
        except MachineError as error:
            if _luciole.devices():
                raise
            raise MachineError(f"{error}, or Intel's from PyPI (pip install luciole[intel])") from None
    return _devices[selector]


def devices() -> list[dict[str, Any]]:
    """All OpenCL devices: platform, name, version, lanes (pixels that are shaded at a time) and compute_units of each."""
    return list(_luciole.devices())


class Picture:
    """A picture in linear light, with its layers and what it cost.

    Arrays show the picture's own memory, without a copy: change them, and ``save`` writes the change.
    """

    def __init__(self, handle: "_luciole.Picture") -> None:
        self._handle = handle
        self._pixels: Floats = handle.pixels
        self._channels: list[str] = list(handle.channels)

    @classmethod
    def of(cls, rgb: Any) -> "Picture":
        """A picture of an array (H, W, 3), linear: to save it, or to see it in a notebook. The array is copied."""
        pixels = array(rgb, "rgb", ("H", "W", 3), finite=False)
        if not (1 <= pixels.shape[0] <= MOST_SIDE and 1 <= pixels.shape[1] <= MOST_SIDE):
            raise InputError(f"rgb: expected sides from 1 to {MOST_SIDE}, got {pixels.shape}")
        return cls(_luciole.picture_of(pixels, ["R", "G", "B"]))

    def __repr__(self) -> str:
        height, width = self._pixels.shape[:2]
        return f"<luciole.Picture {width}x{height}: {', '.join(self.layers) or 'no layers'}>"

    @property
    def rgb(self) -> Floats:
        """(H, W, 3) float32, linear Rec.709, the top row first."""
        return self._pixels[:, :, :3]

    @property
    def alpha(self) -> Floats:
        """(H, W) float32: the share of each pixel that shows a surface, with ``alpha=True``. Raises KeyError without."""
        return self._layer("A")

    @property
    def layers(self) -> list[str]:
        """The names that ``picture[name]`` takes."""
        files = {channel: name for name, channel in _CHANNELS.items()}
        names = [channel.rsplit(".", 1)[0] for channel in self._channels if channel not in ("R", "G", "B", "A")]
        return list(dict.fromkeys(files.get(name, name) for name in names))

    def __getitem__(self, name: str) -> Floats:
        """A layer of ``aovs``: (H, W) or (H, W, channels) float32. Depths and positions in metres, normals in world space."""
        return self._layer(_CHANNELS.get(name, name))

    def _layer(self, name: str) -> Floats:
        places = [i for i, channel in enumerate(self._channels) if channel == name or channel.rsplit(".", 1)[0] == name]
        if not places:
            raise KeyError(f"{name}: the picture has {', '.join(self.layers) or 'no layers'}; ask for them by aovs=[…]")
        if places == list(range(places[0], places[0] + len(places))):
            part = self._pixels[:, :, places[0] : places[-1] + 1]
        else:
            part = self._pixels[:, :, places]
        return part[:, :, 0] if len(places) == 1 else part

    @property
    def stats(self) -> dict[str, Any]:
        """What the picture cost, as ``--stats`` writes it: stages and their milliseconds, counts, memory, light errors. The counts
        of lights in pixels' reach, which take time, aren't made."""
        made: dict[str, Any] = json.loads(self._handle.stats)
        return made

    def srgb8(self) -> npt.NDArray[np.uint8]:
        """(H, W, 3) uint8: sRGB codes, rounded to nearest, clipped to white."""
        made: npt.NDArray[np.uint8] = np.rint(255 * srgb_codes(self.rgb)).astype(np.uint8)
        return made

    def save(self, path: Path, **keywords: Unpack[FileKeywords]) -> None:
        """Writes the picture by the name's extension: png, exr (with all layers), npy, pfm, hdr, jpg, tif, …

        The file appears whole or not at all. Raises InputError or MachineError. Keywords, as the command line has them:

        """
        values = {**_file_texts(), **texts_of(keywords, "save", True)}
        _luciole.write_image(self._pixels, self._channels, fspath(path), _METADATA, values, "A" in self._channels)

    def _repr_png_(self) -> bytes:
        """For notebooks."""
        color = np.ascontiguousarray(self._pixels[:, :, : 4 if "A" in self._channels else 3])
        made: bytes = _luciole.png_bytes(color, self._channels[: color.shape[2]], _file_texts(), "A" in self._channels)
        return made

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Array:
        return np.array(self.rgb, dtype=dtype, copy=copy) if copy else np.asarray(self.rgb, dtype=dtype)

    def __dlpack__(self, **keywords: Any) -> Any:
        return self.rgb.__dlpack__(**keywords)

    def __dlpack_device__(self) -> Any:
        return self.rgb.__dlpack_device__()


_METADATA = [("Software", "luciole")]


def _file_texts() -> dict[str, str]:
    return {row["name"]: row["initial"] for row in rows(True).values()}


def _request(
    function: str, keywords: Mapping[str, Any], scene: Scene | None, others: Sequence[str] = _OTHERS
) -> "_luciole.Request":
    values = {**initial_texts(), **texts_of(keywords, function, False, others)}
    if "aovs" in others and keywords.get("aovs") is not None:
        aovs = keywords["aovs"]
        values["aov"] = ",".join(listed(aovs, str, "aovs", "a list of names"))
    index, camera = 0, keywords.get("camera")
    made = camera._made() if isinstance(camera, Camera) else None
    if camera is not None and made is None:
        index = _camera_index(camera, scene)
    progress = keywords.get("progress")
    if progress is not None and not callable(progress):
        raise InputError(f"progress: expected a function, got {type(progress).__name__}")
    return _luciole.request(
        values=values,
        shadows_given=keywords.get("shadows") is not None,
        camera_index=index,
        camera=made,
        surfaces=paths_of(keywords.get("surface"), "surface"),
        screens=paths_of(keywords.get("screen"), "screen"),
        progress=progress,
    )


def _camera_index(camera: object, scene: Scene | None) -> int:
    names = [] if scene is None else [one.name for one in scene.cameras]
    if isinstance(camera, str) and camera in names:
        return names.index(camera)
    if isinstance(camera, (int, np.integer)) and not isinstance(camera, bool) and 0 <= camera < len(names):
        return int(camera)
    raise InputError(f"camera: {camera!r} is none of {', '.join(map(repr, names)) or 'the scene'}, expected a name or an index")


def _scene(value: object, function: str) -> Scene:
    if isinstance(value, Scene):
        return value
    raise InputError(f"{function}: expected luciole.Scene, got {type(value).__name__}")


def render(scene: Scene, **keywords: Unpack[PictureKeywords]) -> Picture:
    """A scene's picture.

    The first of a kind on a device also compiles its kernels: 0.1 s to some seconds, unless an earlier process left them in the
    cache. For several pictures of one scene a `Renderer` is quicker. Other threads run meanwhile; Ctrl-C ends it. Raises
    InputError and MachineError. Keywords, as the command line has them:

    """
    made = _scene(scene, "render")
    request = _request("render", keywords, made)
    return Picture(_luciole.render(made._handle, _device(keywords.get("device", "")), request))


class Renderer:
    """Makes pictures of one scene, one after another, and keeps between them what the next one needs as well: textures, the tree
    of triangles, shadow maps, kernels and memory. That saves time and changes no bit.

    The scene belongs to it from then on. Lights, cameras, transforms, materials and surroundings of ``renderer.scene`` may be
    changed between pictures. Any thread may use it; calls take turns. Raises InputError for a scene of another Renderer.
    """

    def __init__(self, scene: Scene, device: str = "") -> None:
        self.scene = _scene(scene, "Renderer")
        self._selector = device
        _luciole.keep(self.scene._handle, _device(device))

    def render(self, **keywords: Unpack[PictureKeywords]) -> Picture:
        """A picture, as luciole.render() makes it."""
        if keywords.get("device", self._selector) != self._selector:
            raise InputError("device: a Renderer keeps what it needs on the one that it was made with")
        keywords["device"] = self._selector
        return render(self.scene, **keywords)


class GBuffer:
    """The surfaces that a camera sees, a sample a pixel: position, normal, material.

    Made by `gbuffer`, by `GBuffer.read` or from arrays: position (H, W, 3), world, metres, where nothing is seen NaN or infinite;
    normal (H, W, 3), world; diffuse (default: 0.8), specular, ambient, emission (H, W, 3), linear; shininess (H, W). camera: by
    which they were seen. Raises InputError.
    """

    def __init__(
        self,
        position: Any,
        normal: Any,
        camera: Camera,
        *,
        diffuse: Any = None,
        specular: Any = None,
        shininess: Any = None,
        ambient: Any = None,
        emission: Any = None,
    ) -> None:
        places = array(position, "gbuffer.position", ("H", "W", 3), dtype=np.float64, finite=False)
        sides = {"H": places.shape[0], "W": places.shape[1]}
        if not (1 <= sides["H"] <= MOST_SIDE and 1 <= sides["W"] <= MOST_SIDE):
            raise InputError(f"gbuffer.position: expected sides from 1 to {MOST_SIDE}, got {places.shape}")

        def colors(value: object, name: str) -> Array | None:
            return None if value is None else array(value, f"gbuffer.{name}", ("H", "W", 3), sides=sides)

        if not isinstance(camera, Camera):
            raise InputError(f"gbuffer.camera: expected luciole.Camera, got {type(camera).__name__}")
        self._handle = _luciole.gbuffer(
            camera=camera._made(),
            position=places,
            normal=array(normal, "gbuffer.normal", ("H", "W", 3), sides=sides, finite=False),
            diffuse=colors(diffuse, "diffuse"),
            specular=colors(specular, "specular"),
            shininess=None if shininess is None else array(shininess, "gbuffer.shininess", ("H", "W"), sides=sides),
            ambient=colors(ambient, "ambient"),
            emission=colors(emission, "emission"),
        )

    @classmethod
    def _of(cls, handle: "_luciole.GBuffer") -> "GBuffer":
        made = cls.__new__(cls)
        made._handle = handle
        return made

    @classmethod
    def read(cls, path: Path) -> "GBuffer":
        """Of an EXR that Luciole, Blender, Mitsuba, pbrt, RenderMan, Arnold or 3Delight wrote: its layers are found by name."""
        return cls._of(_luciole.read_gbuffer(fspath(path)))

    def save(self, path: Path) -> None:
        """As an EXR, which shades to the same bits."""
        self._handle.write(fspath(path))

    def __repr__(self) -> str:
        return f"<luciole.GBuffer {self._handle.width}x{self._handle.height}: {', '.join(self.layers)}>"

    @property
    def camera(self) -> Camera:
        """By which the surfaces were seen: a copy."""
        return Camera._of(self._handle.camera)

    def _rows(self) -> Picture:
        if not hasattr(self, "_picture"):
            self._picture = Picture(self._handle.rows())
        return self._picture

    @property
    def layers(self) -> list[str]:
        """The names that ``gbuffer[name]`` takes: position, normal, depth, diffuse, …; Pcam and Ncam are in view space."""
        return self._rows().layers

    def __getitem__(self, name: str) -> Floats:
        """A layer: (H, W) or (H, W, channels) float32, world space; a copy that all calls share."""
        return self._rows()[name]


def gbuffer(scene: Scene, **keywords: Unpack[PictureKeywords]) -> GBuffer:
    """The surfaces that a camera sees: rasterizing alone. Keywords: as render() has them, of those that concern the view."""
    made = _scene(scene, "gbuffer")
    request = _request("gbuffer", keywords, made)
    return GBuffer._of(_luciole.draw_gbuffer(made._handle, _device(keywords.get("device", "")), request))


def _of_arrays(arrays: Mapping[str, Any], camera: object) -> GBuffer:
    names = ("position", "normal", "diffuse", "specular", "shininess", "ambient", "emission")
    if not {"position", "normal"} <= set(arrays) <= set(names):
        there = ", ".join(map(str, arrays))
        raise InputError(f"shade: expected position, normal, and of {', '.join(names[2:])} what there is, got {there}")
    if not isinstance(camera, Camera):
        raise InputError("camera: expected luciole.Camera, by which the surfaces were seen")
    return GBuffer(camera=camera, **arrays)


def shade(surfaces: GBuffer | Mapping[str, Any], lights: Any, **keywords: Unpack[PictureKeywords]) -> Picture:
    """Lights a G-buffer.

    surfaces: of gbuffer(), GBuffer.read() or of arrays: ``GBuffer(position, normal, camera)``, or a dict of them,
    ``{"position": …, "normal": …}``, with the keyword camera. lights: a scene, whose lights,
    ambient light and fog count and whose objects cast shadows; or lights alone. Keywords: as render() has them, of those that
    concern light.
    """
    if isinstance(surfaces, Mapping):
        surfaces = _of_arrays(surfaces, keywords.get("camera"))
    if not isinstance(surfaces, GBuffer):
        raise InputError(f"shade: expected luciole.GBuffer or arrays, got {type(surfaces).__name__}")
    if isinstance(lights, Scene):
        scene = lights
    else:
        scene = Scene([], lights_of(lights), surfaces.camera)
    request = _request("shade", keywords, scene)
    return Picture(_luciole.shade(scene._handle, _device(keywords.get("device", "")), surfaces._handle, request))


def relight(path: Path, lights: Any, **keywords: Unpack[PictureKeywords]) -> Picture:
    """Lights another program's EXR by its layers of positions and normals: shade() of GBuffer.read()."""
    return shade(GBuffer.read(path), lights, **keywords)


def reference(scene: Scene, pixels: Any = None, **keywords: Unpack[PictureKeywords]) -> Doubles:
    """A picture in double precision, every light on every pixel, shadows by rays: slow and right.

    pixels: (n, 2) whole numbers, x and y from the top left; then the colours are (n, 3). None: all, (H, W, 3) float64, linear.
    Takes about a millisecond for a pixel, a sample and a thousand lights. Keywords: as render() has them, of those that concern
    the view, the model and shadow casters; exposure isn't applied.
    """
    made = _scene(scene, "reference")
    for name in ("surface", "screen"):
        if keywords.get(name):
            raise InputError(f"{name}: is of render(); the command luciole reference takes --surface")
    request = _request("reference", keywords, made)
    if pixels is not None:
        places = array(pixels, "pixels", ("N", 2), dtype=np.int32)
        return _reference(made, places, request)
    width, height = _luciole.window(made._handle, request)
    y, x = np.mgrid[0:height, 0:width]
    places = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.int32)
    return _reference(made, places, request).reshape(height, width, 3)


def _reference(scene: Scene, places: Array, request: "_luciole.Request") -> Doubles:
    made: Doubles = _luciole.reference(scene._handle, places, request)
    return made


def bake(
    scene: Scene,
    object: str | int,  # noqa: A002
    *,
    eye: Sequence[float] | None = None,
    irradiance: bool = False,
    **keywords: Unpack[PictureKeywords],
) -> Picture:
    """The light on an object as a map in texture space, (H, W): its texture coordinates must lie apart.

    object: its name or index. eye: a place of the world from which highlights are seen; None: no highlights. irradiance: the
    light that arrives, to be multiplied by the surface's own colours. size: default 1024 × 1024. Keywords: as render() has them.
    """
    made = _scene(scene, "bake")
    names = made.objects
    if isinstance(object, str):
        if names.count(object) != 1:
            raise InputError(f"object: {names.count(object)} objects are called '{object}', expected one of {', '.join(names[:12])}")
        object = names.index(object)  # noqa: A001
    index = whole(object, "object", 0, len(names) - 1)
    keywords.setdefault("size", (1024, 1024))
    request = _request("bake", keywords, made)
    place = None if eye is None else tuple(float(c) for c in array(eye, "eye", (3,), dtype=np.float64))
    return Picture(
        _luciole.bake(made._handle, _device(keywords.get("device", "")), index, place, bool(irradiance), request)
    )


def read(path: Path) -> Picture:
    """A picture from a file: png, exr, npy, pfm and whatever OpenImageIO reads; integers as sRGB, made linear."""
    return Picture(_luciole.read_image(fspath(path)))


def _pixels(value: object, name: str) -> tuple[Array, list[str]]:
    """Pixels and channels of a picture, a file or an array."""
    if isinstance(value, (str, PathLike)):
        value = read(value)
    if isinstance(value, Picture):
        return np.ascontiguousarray(value._pixels), value._channels
    given = array(value, name, ("H", "W", 3), ("H", "W"), ("H", "W", 4), finite=False)
    if given.size == 0:
        raise InputError(f"{name}: has no pixels")
    if given.ndim == 2:
        return given[:, :, np.newaxis], ["Y"]
    return given, list("RGBA"[: given.shape[2]])


def compare(a: Any, b: Any, metrics: Sequence[str] | None = None) -> dict[str, Any]:
    """How picture b differs from picture a: Picture, arrays (H, W, 3) or (H, W), or files.

    metrics: names; None: all of the library. "flip" (NVIDIA's perceptual error, mean) and "ssim" (structural similarity) are
    computed where they are named, by ``pip install flip-evaluator`` and ``scikit-image``. Over all pixels and channels that both
    have, linear; coverage doesn't count:

    """
    pixels_a, channels_a = _pixels(a, "a")
    pixels_b, channels_b = _pixels(b, "b")
    made: dict[str, Any] = _luciole.difference(pixels_a, channels_a, pixels_b, channels_b)
    if metrics is None:
        return made
    chosen = {}
    for name in listed(metrics, str, "metrics", "a list of names"):
        if name in _OTHER_METRICS:
            chosen[name] = _OTHER_METRICS[name](pixels_a, pixels_b)
        elif name in made:
            chosen[name] = made[name]
        else:
            raise InputError(f"metrics: '{name}' is none of {', '.join([*made, *_OTHER_METRICS])}")
    return chosen


def _codes(pixels: Array) -> Floats:
    """sRGB from 0 to 1, three channels."""
    codes = srgb_codes(pixels[:, :, :3])
    return np.ascontiguousarray(np.broadcast_to(codes, (*codes.shape[:2], 3)), dtype=np.float32)


def _flip(a: Array, b: Array) -> float:
    """Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020; of sRGB, 67 pixels a degree."""
    try:
        from flip_evaluator import evaluate  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        raise InputError("metrics: flip needs a package: pip install flip-evaluator") from None
    return float(evaluate(_codes(a), _codes(b), "LDR", inputsRGB=True, applyMagma=False)[1])


def _ssim(a: Array, b: Array) -> float:
    """Wang et al., "Image quality assessment: from error visibility to structural similarity", 2004; of sRGB."""
    try:
        from skimage.metrics import structural_similarity  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        raise InputError("metrics: ssim needs a package: pip install scikit-image") from None
    if min(a.shape[:2]) < 7:
        raise InputError("metrics: ssim needs 7 pixels a side")
    return float(structural_similarity(_codes(a), _codes(b), channel_axis=2, data_range=1.0))


_OTHER_METRICS = {"flip": _flip, "ssim": _ssim}

_ABOUT = """    camera: a Camera, or one of the scene's by name or index. Default: the first.
    surface, screen: files *.clh of one's own, or lists of them.
    aovs: names of layers, which picture[name] has.
    device: an index, or a part of a name of devices(). Default: PoCL.
    progress: a function that is called with how much is done, of how much.
"""


def _document() -> None:
    """Adds the table's keywords to docstrings."""
    skipped = ("camera", "aovs")
    lines = [line for line in keyword_help(False).split("\n") if not line.strip().startswith(skipped)]
    layers = [line for line in keyword_help(False).split("\n") if line.strip().startswith("aovs")]
    render.__doc__ = f"{render.__doc__}{chr(10).join([*lines, *layers])}\n{_ABOUT}"
    Picture.save.__doc__ = f"{Picture.save.__doc__}{keyword_help(True)}\n"
    compare.__doc__ = f"{compare.__doc__}{_METRICS}"


_METRICS = """    mse: mean of (b − a)²; rmse: its root; psnr: dB, peak 1.
    relmse: mean of (b − a)² / (a² + 10⁻²). mape: mean of |b − a| / (|a| + 10⁻²).
    smape: mean of 2 |b − a| / (|a| + |b| + 10⁻²).
    mean_abs, max_abs, mean_signed (of b − a: the bias), mean_relative, max_relative (by a's largest magnitude).
    p99_abs, p999_abs: what 99 % and 99.9 % of the pixels differ by at most. worst_pixel: (x, y) of max_abs.
    nonfinite: pairs of which one isn't finite, and that aren't the same.
"""
_document()
