#!/usr/bin/env bash
# package_test.sh BUILD TEST: runs the function TEST, which installs what BUILD, a finished build folder, holds. Exit status 0 where it
# keeps its promise.
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "$1" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Installed to one place and moved to another, of which nothing can know.
install() {
  cmake --install "$build" --prefix "$folder/before" >"$folder/log" || { cat "$folder/log" && exit 1; }
  mv "$folder/before" "$folder/prefix"
}

configure() { # configure SOURCES OPTIONS…
  cmake -G Ninja -S "$1" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release "${@:2}" >"$folder/log" 2>&1 || { cat "$folder/log" && exit 1; }
}

FindPackageGivesTheLibraryAndItLights() {
  install
  configure "$checkout/tests/package" -DCMAKE_PREFIX_PATH="$folder/prefix"
  cmake --build "$folder/build"
  cd "$folder"
  build/check
  build/mesh
  [[ -s sphere.png ]]
  [[ $(build/planes) == "red in the middle: 2.9"* ]]
  [[ $(build/no_device) == *", "*$'\n'"device: gpu: no device has this in its name" ]]
  # No driver at all.
  [[ $(OCL_ICD_VENDORS=$folder/none build/no_device) == "no OpenCL device: "* ]]
}

# Built it would be the same objects again, which takes minutes: what Ninja would do must do.
AddSubdirectoryGivesTheSameTarget() {
  local commands
  configure "$checkout/tests/package" -DLUCIOLE_CHECKOUT="$checkout"
  commands=$(ninja -C "$folder/build" -t commands mesh)
  [[ $commands == *" $checkout/host/render/"* || $commands == *luciole_render.dir/Unity* ]] || { echo "no room is compiled" && return 1; }
  [[ $commands == *"-o mesh "*"libluciole.so"* ]] || { echo "the library isn't linked" && return 1; }
  [[ $commands != *gtest* && $commands != */host/tools/cli/* ]] || { echo "more than the library is built" && return 1; }
}

# Each by itself, with every warning, by whatever GLM the user has set.
EveryInstalledHeaderCompiles() {
  install
  [[ -z $(find "$folder/prefix/include" -name '*.h*' -not -path '*/include/luciole/*') ]] || { echo "others are installed" && return 1; }
  local headers header
  mapfile -t headers < <(find "$folder/prefix/include/luciole" -name '*.hpp' -printf '%f\n')
  ((${#headers[@]} > 15 && ${#headers[@]} <= 25)) || { echo "${#headers[@]} headers" && return 1; }
  local check=(g++ -x c++ -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I "$folder/prefix/include" -)
  for header in "${headers[@]}"; do echo "#include <luciole/$header>" | "${check[@]}"; done
  printf '#include <luciole/%s>\n' "${headers[@]}" | "${check[@]}" -DGLM_FORCE_CTOR_INIT -DGLM_FORCE_RADIANS
}

InstalledProgramNeedsNeitherCheckoutNorBuildFolder() {
  install
  local place
  # A checkout at /luciole, as in a bare root, is itself a part of other paths; what lies in it isn't.
  for place in "$checkout"/{host,kernels,scenes,tests} "$build" "$folder/before"; do
    ! grep -rlF "$place/" "$folder/prefix"/{bin,include,lib} || { echo "these know of $place" && return 1; }
  done
  # (Pictures of scenes tell the command that made them.) Nor is it there while the program runs, where this may be hidden from it.
  local alone=()
  if unshare --mount true 2>/dev/null; then
    # shellcheck disable=SC2016
    alone=(unshare --mount bash -c 'for place in "$1" "$2"; do mount -t tmpfs none "$place"; done; shift 2; exec "$@"' bash "$build" "$checkout")
  fi
  mkdir "$folder/cache"
  # A helper would outlive it, and write while the folder is removed.
  (cd / && "${alone[@]}" env -i PATH="$PATH" HOME="$folder" POCL_CACHE_DIR="$folder/cache" LUCIOLE_HELPERS=0 "$folder/prefix/bin/luciole" \
    render "$folder/prefix/share/luciole/scenes/fireflies.json" --size 96x54 -o "$folder/installed.exr")
  [[ $(zcat "$folder"/prefix/share/man/man1/luciole.1.gz) == "$("$build/luciole" man)" ]] || { echo "the manual is another program's" && return 1; }
  "$build/luciole" render "$checkout/scenes/fireflies.json" --size 96x54 -o "$folder/built.exr"
  "$build/luciole" compare "$folder/installed.exr" "$folder/built.exr" --max-abs 0
}

# Built it would take minutes: what Ninja would do makes each file that installing looks for first.
LaunchersBuildHasAllThatIsInstalled() {
  local target file commands files
  target=$(sed -n 's/^ *programIsCurrent || setUp //p' "$checkout/luciole")
  commands=" $(ninja -C "$build" -t commands "$target" | tr '\n' ' ') "
  mapfile -t files < <(grep '^ *foreach(file "' "$build/cmake_install.cmake" | grep -oE '"[^"]+"' | tr -d '"')
  ((${#files[@]} >= 11)) || { echo "installing looks for ${files[*]}" && return 1; }
  for file in "${files[@]#"$build/"}"; do
    file=${file/luciole.1.gz/luciole.1}
    [[ $commands == *"-o $file "* || $commands == *"> $build/$file "* ]] || { echo "$target doesn't build $file" && return 1; }
  done
}

WhereSomethingIsntBuiltNothingIsInstalled() {
  local status=0
  # What cmake --install reads, of a build folder without texts.
  sed "s|$build/texts/|$folder/no texts/|" "$build/cmake_install.cmake" >"$folder/cmake_install.cmake"
  cmake -DCMAKE_INSTALL_PREFIX="$folder/prefix" -P "$folder/cmake_install.cmake" >"$folder/log" 2>&1 || status=$?
  ((status)) || { echo "it installs without its texts" && return 1; }
  tr -s ' \n' ' ' <"$folder/log" | grep -q "isn't built; nothing is installed" || { cat "$folder/log" && return 1; }
  [[ ! -e $folder/prefix ]] || { find "$folder/prefix" && return 1; }
}

"$2"
