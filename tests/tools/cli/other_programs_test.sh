#!/usr/bin/env bash
# other_programs_test.sh LUCIOLE FOLDER blender|mitsuba: that program, as PyPI has it, renders a scene, and LUCIOLE lights its
# layers again (blender_test.py, mitsuba_test.py). It is installed into FOLDER unless it is there. Exit status 77 where it is
# neither there nor to be had.
set -euo pipefail

luciole=$(realpath "$1")
case $3 in
  blender) packages=("bpy==4.5.*") python=python3.11 module=bpy ;;  # PyPI's Blender 4.5 is for this Python alone
  mitsuba) packages=("mitsuba==3.*" numpy) python=python3 module=mitsuba ;;
esac
place=$2/$3
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")

skip() {
  echo "needs $3 ($1), which ${2}" >&2
  exit 77
}
command -v "$python" >/dev/null || skip "PyPI: ${packages[*]}" "takes $python" "$module"
if ! [[ -e $place/installed ]]; then
  # Made under another name and then moved, so that an installation that was cut off is none.
  rm -rf "$place" "$place.new"
  mkdir -p "$2"
  log=$place.log
  "$python" -m venv "$place.new" >"$log" 2>&1 || skip "PyPI: ${packages[*]}" "takes $python with its module venv" "$module"
  timeout 600 "$place.new/bin/python" -m pip install --quiet --no-cache-dir --retries 1 --timeout 10 "${packages[@]}" \
    >>"$log" 2>&1 || { rm -rf "$place.new" && skip "PyPI: ${packages[*]}" "can't be installed here: $(tail -n 1 "$log")" "$module"; }
  touch "$place.new/installed"
  mv "$place.new" "$place"
fi

folder=$(mktemp -d "${TMPDIR:-/tmp}/luciole-test-XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# The interpreter by its own place: a virtual environment that was moved is found by it.
"$place/bin/python" "$here/$3_test.py" "$luciole"
