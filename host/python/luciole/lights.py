"""Lights as arrays: one row a light."""

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from luciole import _luciole
from luciole._arrays import Array, array, choice, listed, number, refuse_non_finite, vector, whole
from luciole._errors import InputError

POINT, DIRECTIONAL, SPOT = range(3)
_WINDOWS = ("smooth", "khr")
_FALLOFFS = ("exponent", "cone")
#: Of one environment or area light, at most.
MOST_SOURCE_LIGHTS = 1 << 20


def _rows(value: object, name: str, width: int, count: int) -> Array:
    """Rows of `width` numbers, one a light or one for all, as float32 or float64 whichever they are."""
    given = np.asarray(value) if not isinstance(value, (list, tuple, int, float)) else None
    is_double = given is None or given.dtype.kind != "f" or given.dtype.itemsize > 4
    dtype: npt.DTypeLike = np.float64 if is_double else np.float32
    shapes: list[Sequence[int | str]] = [("N", 3), (3,), ()] if width == 3 else [("N",), ()]
    made = array(value, name, *shapes, dtype=dtype, sides={"N": count}, finite=False)
    return made.reshape(-1, width) if made.ndim > 0 else np.full((1, width), made)


def _count(value: object, name: str) -> int:
    """How many lights an array has rows for."""
    return len(array(value, name, ("N", 3), finite=False)) if not isinstance(value, np.ndarray) else _length(value, name)


def _length(value: Array, name: str) -> int:
    if value.ndim == 2 and value.shape[1] == 3:
        return int(value.shape[0])
    raise InputError(f"{name}: expected (N, 3) float32, got {value.shape}")


def _columns(
    kind: int,
    count: int,
    *,
    position: Array | None = None,
    direction: Array | None = None,
    color: object,
    ambient: object | None,
    specular: object | None,
    attenuation: object = (1, 0, 0),
    range: object | None = None,  # noqa: A002
    window: str = "smooth",
    falloff: str = "exponent",
    cutoff: Array | None = None,
    inner_cone: Array | None = None,
    exponent: object = 0,
    radius: object = 0,
    half_angle: Array | None = None,
    cast_shadows: object = False,
    group: str = "",
) -> "_luciole.LightColumns":
    def rows(value: object, name: str, width: int, least: float | None = 0, infinite: bool = False) -> Array:
        made = _rows(value, f"lights.{name}", width, count)
        if not infinite:
            refuse_non_finite(made, f"lights.{name}")
        if least is not None and made.size > 0 and not made.min() >= least:
            raise InputError(f"lights.{name}: expected {least} or more, got {made.min()}")
        return made

    marks = np.asarray(cast_shadows)
    if marks.dtype.kind not in "biu" or marks.shape not in ((), (count,)):
        raise InputError(f"lights.cast_shadows: expected (N,) bool, with N = {count}, got {marks.shape} {marks.dtype.name}")
    nothing = np.zeros((1, 1))
    return _luciole.light_columns(
        kind=kind,
        count=count,
        position=None if position is None else rows(position, "position", 3, None),
        direction=None if direction is None else rows(direction, "direction", 3, None),
        color=rows(color, "color", 3),
        ambient=None if ambient is None else rows(ambient, "ambient", 3),
        specular=None if specular is None else rows(specular, "specular", 3),
        attenuation=rows(attenuation, "attenuation", 3),
        range=rows(np.inf if range is None else range, "range", 1, infinite=True),
        window=choice(window, "lights.window", _WINDOWS),
        falloff=_FALLOFFS.index(falloff),
        cutoff=nothing if cutoff is None else cutoff,
        inner_cone=nothing if inner_cone is None else inner_cone,
        exponent=rows(exponent, "exponent", 1),
        radius=rows(radius, "radius", 1),
        half_angle=nothing if half_angle is None else half_angle,
        cast_shadows=marks.astype(np.float32).reshape(-1, 1),
        group=str(group),
    )


class _Lights:
    """What all kinds share. Arrays of float32 and float64 are taken as they are; others are converted.

    An array of one row for all lights may be a single value: ``color=(1, 0.9, 0.8)``, ``range=5``.
    """

    def _shared(self) -> dict[str, Any]:
        """The members that mean the same in all kinds that have them."""
        of_kind = ("direction", "cutoff", "inner_cone", "angle")
        return {name: value for name, value in vars(self).items() if name not in of_kind}

    def _columns(self) -> "_luciole.LightColumns":
        raise NotImplementedError

    def __len__(self) -> int:
        raise NotImplementedError


@dataclass
class PointLights(_Lights):
    """Lights that shine from a point in all directions.

    position: (N, 3), world, metres. color: (N, 3), or one colour or number for all, linear, ≥ 0, with the
    intensity multiplied in.
    range: (N,) or one number, metres, > 0: where light ends; None: nowhere. attenuation: (N, 3) or one for all: constant,
    linear (1/m) and quadratic (1/m²); light is divided by c + l·d + q·d². cast_shadows: (N,) bool or one. radius: (N,) or
    one, metres: the size that gives shadows a penumbra. specular, ambient: (N, 3), colours of highlights (default: color)
    and of light that comes from everywhere (default: none). window: how light fades out before its range, "smooth" or
    "khr". group: the name of the group of lights that they are of (see ``light_groups=True``).

    The arrays are read when a scene takes them. Raises InputError then.
    """

    position: Any
    color: Any = (1.0, 1.0, 1.0)
    range: Any = None
    attenuation: Any = (0.0, 0.0, 1.0)
    cast_shadows: Any = False
    radius: Any = 0.0
    specular: Any = None
    ambient: Any = None
    window: str = "smooth"
    group: str = ""

    def __len__(self) -> int:
        return _count(self.position, "lights.position")

    def _columns(self) -> "_luciole.LightColumns":
        return _columns(POINT, len(self), **self._shared())


@dataclass
class SpotLights(_Lights):
    """Lights that shine from a point into a cone.

    As PointLights, and: direction: (N, 3), the way they shine, of any length but 0. cutoff: (N,) or one, degrees from the
    axis to the cone's edge, 0 to 90. inner_cone: degrees: light falls off from there to the cutoff, as glTF has it.
    exponent: without inner_cone light is multiplied by the cosine of the angle to the axis to this power, as OpenGL has it.
    """

    position: Any
    direction: Any
    color: Any = (1.0, 1.0, 1.0)
    cutoff: Any = 45.0
    exponent: Any = 0.0
    inner_cone: Any = None
    range: Any = None
    attenuation: Any = (0.0, 0.0, 1.0)
    cast_shadows: Any = False
    radius: Any = 0.0
    specular: Any = None
    ambient: Any = None
    window: str = "smooth"
    group: str = ""

    def __len__(self) -> int:
        return _count(self.position, "lights.position")

    def _columns(self) -> "_luciole.LightColumns":
        count = len(self)
        inner = None if self.inner_cone is None else _angles(self.inner_cone, "inner_cone", count, 90)
        return _columns(
            SPOT,
            count,
            direction=_directions(self.direction, count),
            cutoff=_angles(self.cutoff, "cutoff", count, 90),
            inner_cone=inner,
            falloff="exponent" if inner is None else "cone",
            **self._shared(),
        )


@dataclass
class DirectionalLights(_Lights):
    """Lights that shine from far away, as the sun.

    direction: (N, 3), world: the way they shine, of any length but 0. color, specular, ambient, cast_shadows, group: as
    PointLights. angle: (N,) or one, degrees: the angle under which the light is seen, 0 to 90; the sun's is 0.53. It gives
    shadows a penumbra.
    """

    direction: Any
    color: Any = (1.0, 1.0, 1.0)
    cast_shadows: Any = False
    angle: Any = 0.0
    specular: Any = None
    ambient: Any = None
    group: str = ""

    def __len__(self) -> int:
        return _count(self.direction, "lights.direction")

    def _columns(self) -> "_luciole.LightColumns":
        count = len(self)
        return _columns(
            DIRECTIONAL,
            count,
            direction=_directions(self.direction, count),
            half_angle=_angles(self.angle, "angle", count, 90) / 2,
            **self._shared(),
        )


@dataclass
class Environment:
    """A sky all around: many directional lights take its place, and it is the background.

    image: (H, 2H, 3) float32, linear, by latitude and longitude, with −z in the middle of a row and +x to its right; or the
    path of a picture file. White of 1 all around lights a diffuse colour of 1 to 1. color: what multiplies it. rotate: degrees
    about +y, counter-clockwise as seen from above. count: how many lights. A scene has one.
    """

    image: Any
    color: Any = 1.0
    rotate: float = 0.0
    count: int = 4096
    cast_shadows: bool = True
    group: str = ""

    def _source(self) -> "_luciole.Source":
        is_path = isinstance(self.image, (str, PathLike))
        return _luciole.environment(
            fspath(self.image) if is_path else array(self.image, "lights.image", ("H", "W", 3)),
            number(self.rotate, "lights.rotate", -1e18, 1e18),
            _source_color(self.color),
            whole(self.count, "lights.count", 0, MOST_SOURCE_LIGHTS),
            bool(self.cast_shadows),
            str(self.group),
        )


@dataclass
class AreaLight:
    """A flat face that shines from its front alone and isn't seen: many lights take its place.

    position: of its middle, world, metres. direction: the way it shines. width, height: metres; the height goes about the way
    of `up`. color: its radiance. disc: an ellipse instead of a rectangle. count: how many lights.
    """

    position: Any
    direction: Any
    width: float = 1.0
    height: float = 1.0
    color: Any = 1.0
    up: Any = None
    disc: bool = False
    count: int = 256
    cast_shadows: Any = False
    group: str = ""

    def _source(self) -> "_luciole.Source":
        direction = vector(self.direction, "lights.direction")
        length = float(np.linalg.norm(direction))
        steep = abs(direction[1]) > 0.9 * length
        up = ((0.0, 0.0, -1.0) if steep else (0.0, 1.0, 0.0)) if self.up is None else vector(self.up, "lights.up")
        if not np.linalg.norm(np.cross(up, direction)) > 1e-8 * length * float(np.linalg.norm(up)):
            raise InputError("lights.up: expected a direction that isn't parallel to `direction`")
        return _luciole.face(
            bool(self.disc),
            vector(self.position, "lights.position"),
            direction,
            up,
            number(self.width, "lights.width", 1e-18, 1e18),
            number(self.height, "lights.height", 1e-18, 1e18),
            _source_color(self.color),
            whole(self.count, "lights.count", 0, MOST_SOURCE_LIGHTS),
            bool(self.cast_shadows),
            str(self.group),
        )


def _source_color(value: object) -> tuple[float, float, float]:
    made = vector(value, "lights.color")
    if min(made) < 0:
        raise InputError(f"lights.color: expected 0 or more, got {min(made):g}")
    return made


Lights: TypeAlias = PointLights | SpotLights | DirectionalLights | Environment | AreaLight


def _angles(degrees: object, name: str, count: int, most: float) -> Array:
    """Radians, a row a light or one for all."""
    made = _rows(degrees, f"lights.{name}", 1, count)
    refuse_non_finite(made, f"lights.{name}")
    if made.size > 0 and not (made.min() >= 0 and made.max() <= most):
        wrong = made.min() if made.min() < 0 else made.max()
        raise InputError(f"lights.{name}: expected 0 to {most:g} degrees, got {wrong:g}")
    return np.radians(made.astype(np.float64))


def _directions(value: object, count: int) -> Array:
    made = _rows(value, "lights.direction", 3, count)
    if made.size > 0 and not np.abs(made).max(axis=1).min() > 0:
        raise InputError("lights.direction: expected directions of any length but 0")
    return made


def lights_of(value: object) -> list[Lights]:
    """`value`, lights or a sequence of them, as a list."""
    kinds = (PointLights, SpotLights, DirectionalLights, Environment, AreaLight)
    expected = "PointLights, SpotLights, DirectionalLights, Environment, AreaLight or a list of them"
    return [] if value is None else listed(value, kinds, "lights", expected)


def set_lights(scene: "_luciole.Scene", value: object) -> None:
    """Replaces a scene's lights. Where one of them is wrong, the scene keeps those that it has."""
    lights = lights_of(value)
    if sum(isinstance(some, Environment) for some in lights) > 1:
        raise InputError("lights: two environments; a scene has one")
    scene.set_lights(
        [some._columns() for some in lights if isinstance(some, _Lights)],
        [some._source() for some in lights if isinstance(some, (Environment, AreaLight))],
    )


def get_lights(scene: "_luciole.Scene") -> list[Lights]:
    """A scene's lights as arrays, copies, by kind. Lights of a kind that differ in how they fade, or in their group, are
    arrays of their own."""
    found: list[Lights] = []
    for window, falloff, group in scene.light_families():
        for kind in (POINT, SPOT, DIRECTIONAL):
            a = scene.light_arrays(kind, window, falloff, group)
            if len(a["color"]) == 0:
                continue
            shared = {name: a[name] for name in ("color", "cast_shadows", "specular", "ambient")}
            faded = {name: a[name] for name in ("position", "range", "attenuation", "radius")}
            if kind == POINT:
                found.append(PointLights(**shared, **faded, window=_WINDOWS[window], group=group))
            elif kind == SPOT:
                inner = np.degrees(a["inner_cone"]) if falloff == _FALLOFFS.index("cone") else None
                found.append(
                    SpotLights(
                        **shared,
                        **faded,
                        direction=a["direction"],
                        cutoff=np.degrees(a["cutoff"]),
                        inner_cone=inner,
                        exponent=a["exponent"],
                        window=_WINDOWS[window],
                        group=group,
                    )
                )
            else:
                found.append(
                    DirectionalLights(
                        **shared, direction=a["direction"], angle=np.degrees(2 * a["half_angle"]), group=group
                    )
                )
    for of in scene.sources():
        found.append(Environment(**of) if "image" in of else AreaLight(**of))
    return found
