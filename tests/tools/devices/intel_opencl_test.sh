#!/usr/bin/env bash
# intel_opencl_test.sh LUCIOLE FOLDER CLI_TEST: on Intel's OpenCL for CPUs, as PyPI has it, LUCIOLE's check finds the same bits, and so do
# CLI_TEST's hashes of the shipped scenes, and a picture that Intel's and PoCL make together. It is installed into FOLDER unless it is
# there, and the kernels are kept there. Exit status 77 where it is neither there nor to be had.
set -euo pipefail

luciole=$(realpath "$1")
devices_test=$(realpath "$3")
place=$2/intel_opencl
packages=(intel-opencl-rt intel-cmplr-lib-rt tbb tcmlib)

skip() {
  echo "needs Intel's OpenCL (PyPI: ${packages[*]}), which $1" >&2
  exit 77
}
[[ $(uname -m) == x86_64 ]] || skip "is for x86-64"
if ! [[ -e $place/installed ]]; then
  # Made under another name and then moved, so that an installation that was cut off is none.
  rm -rf "$place" "$place.new"
  mkdir -p "$2"
  log=$place.log
  python3 -m venv "$place.new" >"$log" 2>&1 || skip "takes python3 with its module venv"
  timeout 600 "$place.new/bin/python" -m pip install --quiet --no-cache-dir --retries 1 --timeout 10 "${packages[@]}" \
    >>"$log" 2>&1 || { rm -rf "$place.new" && skip "can't be installed here: $(tail -n 1 "$log")"; }
  touch "$place.new/installed"
  mv "$place.new" "$place"
fi
place=$(realpath "$place")
mkdir -p "$place/vendors"
echo "$place/lib/libintelocl.so" >"$place/vendors/intel.icd"
export OCL_ICD_VENDORS=$place/vendors XDG_CACHE_HOME=$place/cache LD_LIBRARY_PATH=$place/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}

"$luciole" devices --check
"$devices_test" --gtest_filter='Scenes/SceneHashes.*'

# With PoCL beside it, where that is.
icds=(/etc/OpenCL/vendors/pocl*.icd)
[[ -e ${icds[0]} ]] || exit 0
cp "${icds[0]}" "$place/vendors/pocl.icd"
trap 'rm -rf "$place/vendors/pocl.icd" "$folder"' EXIT
folder=$(mktemp -d "${TMPDIR:-/tmp}/luciole-test-XXXXXX")
scene=$(dirname "${BASH_SOURCE[0]}")/../../../scenes/city.json
hashOf() {
  "$luciole" render "$scene" --size 96x540 --shadows hard --hash --quiet --device "$1" --stats "$folder/stats.json" -o "$folder/a.exr" | cut -c1-64
}
"$luciole" devices
one=$(hashOf 0) other=$(hashOf 1) both=$(hashOf all)
echo "Intel and PoCL: $one $other, together: $both"
[[ $one == "$other" && $one == "$both" && $(grep -c '"rows"' "$folder/stats.json") == 2 ]]
