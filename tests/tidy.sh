#!/usr/bin/env bash
# tidy.sh [BASE]: clang-format and clang-tidy, by .clang-format and .clang-tidy, over the C++ files that differ from commit BASE;
# over all without one. A header is looked at through the source file of its name, or else through the first that includes it.
# A file takes clang-tidy some 20 s.
# Kernels, all of them if any differs, are formatted in the same way, and get the house's warnings at every width, with all features and
# with none that are shadows of a size.
#
# Exit status: 1 for findings, which it shows; 77 where a tool is not installed, which it says.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Versions format differently: this is the one that the files are formatted with.
format=$(command -v clang-format-14 || true)
tidy=$(command -v clang-tidy-14 || true)
if [[ -z $format || -z $tidy ]] || ! command -v clang++-14 >/dev/null || ! command -v clang-14 >/dev/null; then
  echo "tidy.sh: NOT CHECKED: it takes clang-format, clang-tidy and clang++ 14 (apt install clang-format-14 clang-tidy-14 clang-14)" >&2
  exit 77
fi

kernels_status=0
if ! (($#)) || [[ -n $(git diff --name-only "$1" -- kernels tests/kernels/*.cl tests/cl/*.cl) ]]; then
  mapfile -t kernels < <(git ls-files 'kernels/*.cl' 'kernels/*.clh' 'kernels/*.h' 'tests/kernels/*.cl' 'tests/cl/*.cl')
  "$format" --dry-run --Werror "${kernels[@]}" || kernels_status=1
  # An example is a part of a program, which check-model compiles whole.
  mapfile -t alone < <(printf '%s\n' "${kernels[@]}" | grep -v '^kernels/examples/')
  for lanes in 1 4 8 16; do
    for without in 0 'FEATURE(SOFT_EXACT)' 'FEATURE(HOLES)+FEATURE(SOFT_EXACT)'; do
      clang-14 -x cl -cl-std=CL1.2 -I kernels -Xclang -finclude-default-header -Xclang -fdeclare-opencl-builtins -fsyntax-only \
        -Wall -Wextra -Wshadow -Werror -Wno-unused-parameter -Wno-unused-function -DLANES=$lanes "-DFEATURES=ALL_FEATURES-($without)" \
        "${alone[@]}" || kernels_status=1
    done
  done
fi
if (($#)); then
  mapfile -t files < <(git diff --name-only --diff-filter=d "$1" -- 'host/*.[ch]pp' 'tests/*.[ch]pp')
else
  mapfile -t files < <(git ls-files 'host/*.[ch]pp' 'tests/*.[ch]pp')
fi
((${#files[@]})) || { echo "tidy.sh: no C++ file differs from $1" && exit "$kernels_status"; }

status=$kernels_status
"$format" --dry-run --Werror "${files[@]}" || status=1

sources=()
for file in "${files[@]}"; do
  if [[ $file == *.hpp ]]; then
    if [[ -e ${file%.hpp}.cpp ]]; then
      file=${file%.hpp}.cpp
    else
      name=${file#host/}
      name=${name#include/}
      file=$(git grep -lF "#include \"${name#tests/}\"" -- '*.cpp' | head -n 1 || true)  # head ends it early
    fi
  fi
  [[ -z $file ]] || sources+=("$file")
done
mapfile -t sources < <(printf '%s\n' "${sources[@]}" | sort -u)

# The compiler's command for each file alone, with clang's own flags and without precompiled headers, which are another compiler's.
build=build/tidy
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=OFF >"$build.log" 2>&1 || { cat "$build.log" >&2 && exit 1; }
# Files that no target here compiles: the fuzz programs.
mapfile -t sources < <(for file in "${sources[@]}"; do
  if grep -qF "/$file\"" "$build/compile_commands.json"; then echo "$file"; fi
done)
printf '%s\0' "${sources[@]}" |
  xargs -0 -r -n 1 -P "$(nproc)" "$tidy" -p "$build" --quiet --warnings-as-errors='*' 2>"$build.log" || status=1
((status == 0)) && echo "tidy.sh: nothing to mend in ${#files[@]} files"
exit "$status"
