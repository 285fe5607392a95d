"""luciole.scale: what the program measures as rows, with methods of one's own."""

import json
import time
from pathlib import Path

import numpy as np
import pytest

import luciole


@pytest.fixture
def room(tmp_path: Path) -> Path:
    file = tmp_path / "room.json"
    file.write_text(
        json.dumps(
            {
                "camera": {"eye": [0, 3, 5], "target": [0, 0, 0]},
                "materials": {"wall": {"ambient": [0, 0, 0], "diffuse": [0.7, 0.7, 0.7]}},
                "objects": [{"primitive": "box", "scale": [4, 0.1, 4], "material": "wall"}],
            }
        )
    )
    return file


OPTIONS = {"no_range": True, "size": (32, 24), "repeat": 3, "check_pixels": 64}


def test_rows_are_the_programs(room: Path, tmp_path: Path) -> None:
    rows = luciole.scale(room, [1, 10], tmp_path / "results", vary={"culling": ["none", "tiles"]}, **OPTIONS)
    assert [row["lights"] for row in rows] == [1, 1, 10, 10]
    assert (tmp_path / "results" / "report.html").exists()
    again = luciole.scale(room, [1, 10], tmp_path / "results", vary={"culling": ["none", "tiles"]}, **OPTIONS)
    assert again == rows, "what is there isn't measured again"


def test_a_function_is_timed_and_held_against_the_truth(room: Path) -> None:
    asked = []

    def exact(scene: luciole.Scene, lights: list) -> np.ndarray:
        asked.append(len(lights[0]))
        time.sleep(0.02)
        return luciole.render(scene).rgb

    def black(scene: luciole.Scene, lights: list) -> np.ndarray:
        return np.zeros((24, 32, 3))

    rows = luciole.scale(room, [1, 10], against={"mine": exact, "black": black}, **OPTIONS)
    assert asked.count(1) == 4 and asked.count(10) == 4, "once for the picture, and in each round"
    mine, dark = (next(row for row in rows if row["lights"] == 10 and row["method"] == name) for name in ("mine", "black"))
    assert mine["rmse"] < 1e-5 < dark["rmse"]
    assert mine["ms"] >= 20
    own = next(row for row in rows if row["lights"] == 10 and row["method"] not in ("mine", "black"))
    assert own["rmse"] < 1e-5
    assert mine["times_first_low"] <= mine["times_first"] <= mine["times_first_high"]


def test_a_methods_own_error_comes_through(room: Path) -> None:
    def broken(scene: luciole.Scene, lights: list) -> np.ndarray:
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        luciole.scale(room, [1], against={"broken": broken}, **OPTIONS)

    with pytest.raises(luciole.InputError, match=r"wrong: expected \(24, 32, 3\) float32, got \(3, 3\)"):
        luciole.scale(room, [1], against={"wrong": lambda scene, lights: np.zeros((3, 3))}, **OPTIONS)


def test_pictures_join_by_their_files(room: Path, tmp_path: Path) -> None:
    np.save(tmp_path / "theirs-1.npy", np.zeros((24, 32, 3), np.float32))
    rows = luciole.scale(room, [1], against={"theirs": f"{tmp_path}/theirs-{{lights}}.npy,ms=5"}, **OPTIONS)
    theirs = next(row for row in rows if row["method"] == "theirs")
    assert theirs["ms"] == 5 and theirs["rmse"] > 0


def test_the_programs_errors_are_raised(room: Path) -> None:
    with pytest.raises(luciole.InputError, match="lights"):
        luciole.scale(room, "many", **OPTIONS)
    with pytest.raises(luciole.InputError, match="nowhere.json"):
        luciole.scale("nowhere.json", [1])
