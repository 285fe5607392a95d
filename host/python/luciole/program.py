"""The program ``luciole``, with all its commands: ``luciole --help``."""

import os
import sys
from pathlib import Path
from typing import NoReturn

from luciole._opencl import use_intels_driver

PROGRAM = Path(__file__).resolve().parent / "bin" / "luciole"


def main() -> NoReturn:
    """Becomes the program, with this process's arguments."""
    threads = use_intels_driver(os.environ)
    if threads is not None:
        os.environ["LD_PRELOAD"] = ":".join(filter(None, [str(threads), os.environ.get("LD_PRELOAD")]))
    os.execv(PROGRAM, ["luciole", *sys.argv[1:]])


if __name__ == "__main__":
    main()
