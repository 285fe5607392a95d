"""What pip has installed: the package, its library and its program."""

import os
import re
import subprocess
import sys
import sysconfig
from importlib.metadata import version
from pathlib import Path

import luciole

PACKAGE = Path(luciole.__file__).parent
SCRIPT = Path(sysconfig.get_path("scripts")) / "luciole"
CHECKOUT = Path(__file__).resolve().parents[2]


def run(*command, **environment):
    return subprocess.run(
        [str(part) for part in command],
        env={"PATH": os.environ["PATH"], "HOME": "/nonexistent", **environment},
        capture_output=True,
        text=True,
        cwd="/",
    )


def test_script_and_package_have_the_version_of_the_checkout():
    stated = re.search(r"project\(luciole VERSION ([0-9.]+)", (CHECKOUT / "CMakeLists.txt").read_text())[1]
    assert version("luciole") == stated
    assert run(SCRIPT, "--version").stdout == f"luciole {stated}\n"


def test_script_has_the_status_and_the_words_of_the_program():
    done = run(SCRIPT, "render", "none.json", "-o", "none.png")
    assert done.returncode == 2
    assert done.stderr.startswith("luciole: none.json: ")


def test_library_of_the_package_is_used():
    mapped = Path("/proc/self/maps").read_text()
    libraries = {Path(line.split()[-1]) for line in mapped.splitlines() if "libluciole.so" in line}
    if "LUCIOLE_TEST_SANITIZED" in os.environ:
        return
    assert [path.parent for path in libraries] == [PACKAGE / "lib"]


def test_program_of_the_package_finds_its_library_by_itself():
    lines = run("ldd", PACKAGE / "bin" / "luciole").stdout
    found = re.search(r"libluciole\.so\S* => (\S+)", lines)[1]
    assert Path(found).resolve().parent == (PACKAGE / "lib").resolve()


def test_types_of_the_compiled_part_are_told():
    assert (PACKAGE / "py.typed").exists()
    assert "def devices(" in (PACKAGE / "_luciole.pyi").read_text()


def test_devices_are_those_of_the_program():
    listed = run(SCRIPT, "devices").stdout.splitlines()
    assert [device["name"] for device in luciole.devices()] == [
        re.match(r"[* ] *\d+ +(.*) \(", line)[1] for line in listed if re.match(r"[* ] *\d", line)
    ]


def test_intels_driver_is_named_only_where_there_is_no_other(tmp_path, monkeypatch):
    from luciole import _opencl

    driver, threads = tmp_path / "libintelocl.so", tmp_path / "libtbb.so.12"
    found = {"libintelocl.so": driver, "libtbb.so.12": threads}
    monkeypatch.setattr(_opencl, "_installed", lambda distribution, name: found.get(name))
    monkeypatch.setattr(_opencl, "SYSTEM_DRIVERS", tmp_path)
    named = {"OCL_ICD_VENDORS": str(driver), "OCL_ICD_FILENAMES": str(driver)}

    environment = {}
    assert _opencl.use_intels_driver(environment) == threads
    assert environment == named
    # A child process finds the variables set, and still needs the library.
    assert _opencl.use_intels_driver(environment) == threads
    assert environment == named

    environment = {"OCL_ICD_VENDORS": "/elsewhere"}
    assert _opencl.use_intels_driver(environment) is None
    assert environment == {"OCL_ICD_VENDORS": "/elsewhere"}

    (tmp_path / "pocl.icd").write_text("libpocl.so.2\n")
    environment = {}
    assert _opencl.use_intels_driver(environment) is None
    assert environment == {}

    (tmp_path / "pocl.icd").unlink()
    found.clear()
    assert _opencl.use_intels_driver(environment) is None
    assert environment == {}


def test_package_is_imported_in_half_a_second_of_work():
    def seconds(what):
        # Of the processor, so that what else the machine does counts little.
        before = os.times()
        subprocess.run([sys.executable, "-c", what], check=True, cwd="/")
        after = os.times()
        return after.children_user + after.children_system - before.children_user - before.children_system

    package, numpy = (min(seconds(what) for _ in range(3)) for what in ("import luciole", "import numpy"))
    print(f"import luciole: {package:.3f} s, of which numpy alone takes {numpy:.3f} s")
    assert package < numpy + 0.5


def test_where_there_is_no_device_the_error_says_what_helps():
    code = """
import luciole
try:
    luciole.render(luciole.Scene(luciole.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])))
except luciole.MachineError as error:
    print(isinstance(error, RuntimeError), error)
"""
    done = run(sys.executable, "-c", code, OCL_ICD_VENDORS="/nonexistent", OCL_ICD_FILENAMES="", PYTHONPATH=os.environ.get("PYTHONPATH", ""))
    assert done.stdout.startswith("True "), done.stdout + done.stderr
    assert "apt install pocl-opencl-icd" in done.stdout and "pip install luciole[intel]" in done.stdout
