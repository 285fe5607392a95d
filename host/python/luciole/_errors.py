"""The two kinds of errors, as the command line has them."""


class InputError(ValueError):
    """What was given is wrong. The message names the place and what was expected."""


class MachineError(RuntimeError):
    """The machine can't: no OpenCL device, memory or disk full."""
