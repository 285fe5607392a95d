"""Checks of arrays: what passes has the shape, type and layout that the compiled half takes."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from luciole._errors import InputError

Array: TypeAlias = npt.NDArray[Any]
Floats: TypeAlias = npt.NDArray[np.float32]
Doubles: TypeAlias = npt.NDArray[np.float64]

#: More numbers than any array that a picture needs: a size that a slip of the pen gives.
MOST_NUMBERS = 1 << 40
#: Pixels a side.
MOST_SIDE = 32768


def _shape_text(shape: Sequence[int | str]) -> str:
    return "(" + ", ".join(str(side) for side in shape) + ("," if len(shape) == 1 else "") + ")"


def _fits(shape: Sequence[int], expected: Sequence[int | str], sides: dict[str, int]) -> bool:
    """Whether a shape is the expected one. A letter is any side, but the same wherever it stands; `sides` has those known."""
    if len(shape) != len(expected):
        return False
    for side, wanted in zip(shape, expected):
        if isinstance(wanted, int):
            if side != wanted:
                return False
        elif sides.setdefault(wanted, side) != side:
            return False
    return True


def array(
    value: object,
    name: str,
    *shapes: Sequence[int | str],
    dtype: npt.DTypeLike = np.float32,
    sides: Mapping[str, int] | None = None,
    finite: bool = True,
) -> Array:
    """`value` as a C-contiguous array of `dtype`, without a copy where it is one.

    `shapes`: those that are allowed; a letter stands for any number, or for the one that `sides` says. Numbers of other types
    are converted, where none is lost: integers and floats to floats, whole numbers to integers. Raises InputError as
    ``lights.position: expected (N, 3) float32, got (3, 100)``.
    """
    wanted = np.dtype(dtype)
    expected = " or ".join(_shape_text(shape) for shape in shapes) + f" {wanted.name}"
    try:
        given = np.asarray(value)
    except (ValueError, TypeError, OverflowError, MemoryError) as error:
        raise InputError(f"{name}: expected {expected}, got {type(value).__name__} ({error})") from None
    if given.dtype.kind not in "fiu" or (given.dtype.kind == "f" and wanted.kind in "iu" and given.size > 0):
        raise InputError(f"{name}: expected {expected}, got {_shape_text(given.shape)} {given.dtype.name}")
    if not any(_fits(given.shape, shape, dict(sides or {})) for shape in shapes):
        known = "".join(f", with {letter} = {side}" for letter, side in (sides or {}).items())
        raise InputError(f"{name}: expected {expected}{known}, got {_shape_text(given.shape)}")
    if given.size > MOST_NUMBERS:
        raise InputError(f"{name}: {given.size} numbers are more than memory holds")
    if wanted.kind in "iu" and given.size > 0:
        least, most = int(given.min()), int(given.max())
        limits = np.iinfo(wanted)
        if least < limits.min or most > limits.max:
            raise InputError(f"{name}: expected {limits.min} to {limits.max}, got {least if least < limits.min else most}")
    with np.errstate(over="ignore"):  # what is too large is infinite, and refused below
        made = np.ascontiguousarray(given, dtype=wanted)
    if finite and wanted.kind == "f":
        refuse_non_finite(made, name)
    return made.reshape(given.shape)  # of one number it has made a row


def refuse_non_finite(values: Array, name: str) -> None:
    """Raises InputError that names the first element that isn't finite."""
    # A sum is finite unless an element isn't, or it overflows; then all are looked at.
    with np.errstate(all="ignore"):
        if np.isfinite(np.sum(values)):
            return
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong) > 0:
        place = ", ".join(str(i) for i in wrong[0])
        raise InputError(f"{name}[{place}]: expected finite numbers, got {values[tuple(wrong[0])]}")


def choice(value: object, name: str, choices: Sequence[str]) -> int:
    """The index of a text among those that there are."""
    if isinstance(value, str) and value in choices:
        return choices.index(value)
    got = f"'{value}'" if isinstance(value, str) else type(value).__name__
    raise InputError(f"{name}: {got} is none of {', '.join(choices)}")


def listed(value: object, kinds: type | tuple[type, ...], name: str, expected: str) -> list[Any]:
    """One of these kinds, or a list of them, as a list."""
    if isinstance(value, kinds):
        return [value]
    if isinstance(value, (list, tuple)) and all(isinstance(one, kinds) for one in value):
        return list(value)
    raise InputError(f"{name}: expected {expected}, got {type(value).__name__}")


def size_of(value: object) -> tuple[int, int]:
    """Width and height in pixels."""
    width, height = array(value, "size", (2,), dtype=np.int64)
    return whole(width, "size", 1, MOST_SIDE), whole(height, "size", 1, MOST_SIDE)


def vector(value: object, name: str) -> tuple[float, float, float]:
    """Three finite numbers; one number stands for three."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = (value, value, value)
    x, y, z = array(value, name, (3,), dtype=np.float64)
    return float(x), float(y), float(z)


def number(value: object, name: str, least: float = -np.inf, greatest: float = np.inf) -> float:
    """One number in a range."""
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        if least <= float(value) <= greatest:
            return float(value)
        raise InputError(f"{name}: expected {least:g} to {greatest:g}, got {value}")
    raise InputError(f"{name}: expected a number, got {type(value).__name__}")


def whole(value: object, name: str, least: int, greatest: int) -> int:
    """One whole number in a range."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and least <= value <= greatest:
        return int(value)
    got = value if isinstance(value, (int, float, np.number)) else type(value).__name__
    raise InputError(f"{name}: expected a whole number from {least} to {greatest}, got {got}")


def srgb_codes(pixels: Array) -> Doubles:
    """The sRGB codes, from 0 to 1, of linear light (IEC 61966-2-1); NaN is black."""
    light = np.clip(np.nan_to_num(pixels.astype(np.float64), nan=0.0), 0, 1)
    codes: Doubles = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return codes
