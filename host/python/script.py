#!python
"""What is called `luciole` beside the interpreter; pip puts that one's path above."""

from importlib.util import find_spec
from runpy import run_path

# Its file alone: to import the package takes a fifth of a second, for NumPy and the library.
run_path(f"{find_spec('luciole').submodule_search_locations[0]}/program.py", run_name="__main__")
