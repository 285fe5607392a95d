"""The keywords of pictures. They are the command line's options, from one table of the library."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict

import numpy as np

from luciole import _luciole
from luciole._errors import InputError

if TYPE_CHECKING:
    from luciole.scene import Camera

Path: TypeAlias = str | PathLike[str]
#: Called with how much is done, of how much: bands of a picture, or pixels of a reference.
Progress: TypeAlias = Callable[[int, int], object]


class ViewKeywords(TypedDict, total=False):
    """What a picture shows."""

    size: tuple[int, int] | int
    camera: "Camera | str | int"
    crop: tuple[int, int, int, int]
    shading: Literal["flat", "gouraud", "phong"]
    samples: int
    samples_shading: Literal["shared", "all"]
    model: str
    surface: Path | Sequence[Path]
    screen: Path | Sequence[Path]
    alpha: bool
    exposure: float | Literal["auto"]


class LightKeywords(TypedDict, total=False):
    """How it is lit."""

    shadows: Literal["auto", "off", "hard", "pcf", "soft", "exact", "soft-exact"]
    cast_shadows: Literal["all", "marked", "none"]
    light_count: int | Literal["auto"]
    soft_samples: int
    pcf_width: int
    shadow_memory: int
    shadow_size: int
    culling: Literal["none", "tiles", "auto"]
    tile: Literal[4, 8, 16]
    light_error: float
    light_error_relative: float
    confidence: float
    seed: int
    light_groups: bool
    aovs: Sequence[str]


class PictureKeywords(ViewKeywords, LightKeywords, total=False):
    """All keywords of pictures; see `luciole.render`."""

    device: str
    progress: Progress


class FileKeywords(TypedDict, total=False):
    """How a picture is written; see `luciole.Picture.save`."""

    format: str
    compression: str
    dither: bool
    tone: Literal["clip", "filmic"]
    bits: Literal[8, 16]
    half: bool


class Row(TypedDict):
    """A row of the library's table."""

    name: str
    help: str
    initial: str
    choices: list[str]
    is_flag: bool
    is_list: bool
    of_file: bool


_ROWS: dict[str, Row] = {row["name"]: row for row in _luciole.settings()}


#: More than any list of a setting has.
_MOST_PARTS = 64


def rows(of_file: bool) -> dict[str, Row]:
    """The table's rows of pictures, or of files, by their keywords."""
    return {
        "aovs" if name == "aov" else name: row for name, row in _ROWS.items() if row["of_file"] == of_file
    }


def value_text(name: str, value: object) -> str:
    """A keyword's value as the table takes it: ``(1280, 720)`` as 1280x720, ``True`` as on, lists with commas."""
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, str):
        return value
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)) and len(value) <= _MOST_PARTS:
        return ("x" if name == "size" else ",").join(value_text(name, part) for part in value)
    raise InputError(f"{name}: expected a number, a text or a list of them, got {type(value).__name__}")


def texts_of(keywords: Mapping[str, Any], function: str, of_file: bool, others: Sequence[str] = ()) -> dict[str, str]:
    """The table's values that keywords mean. Raises TypeError for one that there isn't."""
    known = rows(of_file)
    texts = {}
    for name, value in keywords.items():
        if name in others:
            continue
        if name not in known:
            from difflib import get_close_matches

            near = get_close_matches(name, [*known, *others], 1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise TypeError(f"{function}() got an unexpected keyword argument '{name}'{hint}")
        if value is not None:
            texts[known[name]["name"]] = value_text(name, value)
    return texts


def initial_texts() -> dict[str, str]:
    """The table's initial values of pictures."""
    return {name: row["initial"] for name, row in _ROWS.items() if not row["of_file"]}


def paths_of(value: object, name: str) -> list[str]:
    """One path or several."""
    if value is None:
        return []
    if isinstance(value, (str, PathLike)):
        return [fspath(value)]
    if isinstance(value, (list, tuple)) and all(isinstance(path, (str, PathLike)) for path in value):
        return [fspath(path) for path in value]
    raise InputError(f"{name}: expected a file's name or a list of them, got {type(value).__name__}")


def keyword_help(of_file: bool) -> str:
    """A line for each keyword, for docstrings."""
    lines = []
    for name, row in rows(of_file).items():
        choices = "" if row["is_flag"] or not row["choices"] else f" ({', '.join(row['choices'])})"
        initial = f" Default: {row['initial']}." if row["initial"] else ""
        lines.append(f"    {name}: {row['help']}{choices}.{initial}")
    return "\n".join(lines)
