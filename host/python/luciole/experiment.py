"""Experiments with many lights: time and error against their number, with methods of one's own beside."""

import csv
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from os import fspath
from pathlib import Path as FilePath
from typing import Any, TypeAlias

import numpy as np

from luciole._arrays import array
from luciole._errors import InputError, MachineError
from luciole.program import command
from luciole.scene import Scene, load
from luciole.settings import Path

#: Gets a scene with its camera and lights, and these lights as a list of arrays; returns (H, W, 3), linear.
Method: TypeAlias = Callable[[Scene, list[Any]], Any]


def scale(
    scene: Path,
    lights: Sequence[int] | str,
    output: Path | None = None,
    *,
    against: Mapping[str, Method | str] | None = None,
    vary: Mapping[str, Sequence[Any]] | Sequence[str] = (),
    **options: Any,
) -> list[dict[str, Any]]:
    """What ``luciole scale`` measures: a row for each number of lights and variant, as pandas.DataFrame() takes them.

    scene: a file. lights: numbers of lights, or a text as "1,10,...,1000000". output: a folder, for report.html, results.csv and
    pictures; what it holds of this experiment isn't done again. None: they aren't kept. against: other methods by their names: a
    function, which is called in the same rounds as Luciole's variants with a scene and its lights, timed, and held against the
    same truth; or pictures, ``"pictures/{lights}.exr,ms=times.csv"``. vary: options to try in every combination,
    ``{"light_error": [1/64, 1/256]}``. options: the command's, ``repeat=5``, ``size=(640, 360)``, ``own_lights=True``.

    Rows have the columns of results.csv; numbers are numbers, and what a row lacks is None. Raises InputError, MachineError, and
    what a method raises.
    """
    with tempfile.TemporaryDirectory(prefix="luciole-") as made:
        folder = FilePath(made if output is None else fspath(output))
        methods = {name: method for name, method in (against or {}).items() if callable(method)}
        words = [*command(), "scale", fspath(scene), "--lights", _list(lights), "-o", str(folder), "--quiet"]
        for name, method in (against or {}).items():
            words += ["--against", f"{name}={'-' if callable(method) else method}"]
        axes = vary.items() if isinstance(vary, Mapping) else [(axis, None) for axis in vary]
        for name, values in axes:
            words += ["--vary", _option(name) if values is None else f"{_option(name)}={_list(values)}"]
        for name, value in options.items():
            words += _typed(name, value)
        status, errors = _converse(words, methods)
        if status not in (0, 1):  # 1: a bound didn't hold, which the rows tell
            raise (InputError if status == 2 else MachineError)(errors.strip().removeprefix("luciole: "))
        return _rows(folder / "results.csv")


def _option(name: str) -> str:
    return name.replace("_", "-")


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def _list(values: Any) -> str:
    return values if isinstance(values, str) else ",".join(_text(value) for value in values)


def _typed(name: str, value: Any) -> list[str]:
    if value is None or value is False:
        return []
    if value is True:
        return ["--" + _option(name)]
    if isinstance(value, Sequence) and not isinstance(value, str):
        value = ("x" if name == "size" else ",").join(_text(part) for part in value)
    return ["--" + _option(name), _text(value)]


def _converse(words: Sequence[str], methods: Mapping[str, Method]) -> tuple[int, str]:
    """Runs the program, and answers each of its questions. Returns its status and what it says on standard error."""
    scenes: dict[str, tuple[Scene, list[Any]]] = {}
    with tempfile.TemporaryFile("w+") as errors, subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, text=True
    ) as program:
        assert program.stdin is not None and program.stdout is not None
        try:
            for line in program.stdout:
                if not methods:
                    continue
                answer = _answer(json.loads(line), methods, scenes)
                program.stdin.write(json.dumps(answer) + "\n")
                program.stdin.flush()
        except BrokenPipeError:
            pass  # its status says why
        except BaseException:
            program.kill()
            raise
        program.stdin.close()
        status = program.wait()
        errors.seek(0)
        said = errors.read()
    if status == 0 and said:
        print(said, file=sys.stderr, end="")
    return status, said


def _answer(
    question: Mapping[str, Any], methods: Mapping[str, Method], scenes: dict[str, tuple[Scene, list[Any]]]
) -> dict[str, Any]:
    """Calls the method that is asked, and writes its picture where one is wanted."""
    path = question["scene"]
    if path not in scenes:
        scenes.clear()  # the program goes through the numbers of lights in order
        loaded = load(path, question.get("frame", 1))
        scenes[path] = loaded, loaded.lights
    width, height = question["size"]
    scene, lights = scenes[path]
    scene.size = (width, height)
    begun = time.perf_counter()
    made = methods[question["method"]](scene, lights)
    milliseconds = 1000 * (time.perf_counter() - begun)
    if question["round"] == 0:
        np.save(question["output"], array(made, question["method"], (height, width, 3), finite=False))
    return {"milliseconds": milliseconds}


def _rows(path: FilePath) -> list[dict[str, Any]]:
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: _value(text) for name, text in row.items()} for row in csv.DictReader(file)]


def _value(text: str | None) -> Any:
    if not text:
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
