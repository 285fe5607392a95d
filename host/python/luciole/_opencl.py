"""Lets Intel's OpenCL from PyPI be found where the system has no OpenCL device: ``pip install luciole[intel]``.

OpenCL's loader looks for drivers in ``/etc/OpenCL/vendors`` alone, and pip can't write there. So where nothing is there, and
the user names no driver either, the loader is told the place by environment variables, before it is first called.
"""

import ctypes
import os
from collections.abc import MutableMapping
from pathlib import Path

SYSTEM_DRIVERS = Path("/etc/OpenCL/vendors")

#: What OpenCL's loaders read: ocl-icd the first and the third, Khronos' the first and the second.
VARIABLES = ("OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "OPENCL_VENDOR_PATH")


def _installed(distribution: str, name: str) -> Path | None:
    """The file of that name of a distribution, wherever pip has put it (also with ``--user`` or ``--target``)."""
    from importlib.metadata import PackageNotFoundError, files  # 20 ms, for those alone who have no driver

    try:
        found = [file for file in files(distribution) or [] if file.name == name]
    except PackageNotFoundError:
        return None
    path = Path(str(found[0].locate())).resolve() if found else None
    return path if path and path.exists() else None


def use_intels_driver(environment: MutableMapping[str, str]) -> Path | None:
    """Names Intel's driver in `environment` where it is installed and there is no other.

    Returns the threading library that must be loaded before Luciole's, which may link to one of the same name that is too old for
    the driver. None where Intel's driver isn't used.
    """
    named = [environment[name] for name in VARIABLES if name in environment]
    if not named and any(SYSTEM_DRIVERS.glob("*.icd")):
        return None
    driver = _installed("intel-opencl-rt", "libintelocl.so")
    threads = _installed("tbb", "libtbb.so.12")
    # A process that had it named here starts its children with these variables.
    if driver is None or threads is None or named not in ([], [str(driver)] * 2):
        return None
    # ocl-icd takes a driver for a folder of them. Khronos' loader looks into the folder, which is none, and takes the other.
    environment["OCL_ICD_VENDORS"] = environment["OCL_ICD_FILENAMES"] = str(driver)
    return threads


def prepare() -> None:
    """For this process; called before ``luciole._luciole`` is loaded."""
    threads = use_intels_driver(os.environ)
    if threads is not None:
        ctypes.CDLL(str(threads))
