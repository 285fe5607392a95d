"""The program ``luciole``, with all its commands: ``luciole --help``, or ``python -m luciole.program --help``."""

import os
import sys
from pathlib import Path
from runpy import run_path
from typing import NoReturn


def command() -> list[str]:
    """The words that start the program from another."""
    return [sys.executable, __file__]


def main() -> NoReturn:
    """Becomes the program, with this process's arguments. Imports nothing of the package (see script.py)."""
    here = Path(__file__).resolve().parent
    threads = run_path(str(here / "_opencl.py"))["use_intels_driver"](os.environ)
    if threads is not None:
        os.environ["LD_PRELOAD"] = ":".join(filter(None, [str(threads), os.environ.get("LD_PRELOAD")]))
    program = here / "bin" / "luciole"
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
