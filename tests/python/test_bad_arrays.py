"""Nothing that is passed in crashes the interpreter; it raises. Also run under the address sanitizer."""

import luciole
import pytest


def test_devices_take_no_arguments():
    with pytest.raises(TypeError):
        luciole.devices(1)
    assert isinstance(luciole.devices(), list)
