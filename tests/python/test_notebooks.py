"""Every cell of the notebooks and of the README runs."""

import json
import os
import re
from pathlib import Path

import pytest

PLACE = Path(__file__).resolve().parents[2] / "host" / "python"
NOTEBOOKS = sorted(PLACE.glob("notebooks/*.ipynb"))
# What a notebook shows in a minute is tested in seconds; with LUCIOLE_LONG as it is.
SMALLER = {"count = 100_000": "count = 10_000", "size=(480, 270)": "size=(160, 90)", "views = 100": "views = 10"}


def run_cells(cells: list[str], name: str) -> None:
    names: dict[str, object] = {"__name__": "__main__"}
    for number, cell in enumerate(cells):
        exec(compile(cell, f"{name}, cell {number}", "exec"), names)  # noqa: S102


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    notebook = json.loads(path.read_text())
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    if "LUCIOLE_LONG" not in os.environ:
        for large, small in SMALLER.items():
            cells = [cell.replace(large, small) for cell in cells]
    assert len(cells) >= 5
    assert not any(cell.get("outputs") for cell in notebook["cells"]), "what a run prints stays out of the checkout"
    run_cells(cells, path.name)
    assert not list(tmp_path.iterdir()), "it leaves nothing behind"


def test_there_are_three_notebooks() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["data_set", "many_lights", "your_method"]


def test_the_notebooks_have_what_is_made_smaller() -> None:
    text = "".join(path.read_text() for path in NOTEBOOKS)
    assert all(large in text for large in SMALLER)


def test_the_readmes_cells_run(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    pytest.importorskip("tqdm")
    monkeypatch.setenv("MPLBACKEND", "Agg")
    cells = re.findall(r"^```python\n(.*?)^```", (PLACE / "README.md").read_text(), re.M | re.S)
    assert len(cells) >= 8
    run_cells(cells, "README.md")
