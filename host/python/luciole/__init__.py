"""Luciole: lights scenes by any number of lights, on any OpenCL device."""

from luciole import _opencl

_opencl.prepare()

from luciole._luciole import devices  # noqa: E402

__all__ = ["devices"]
