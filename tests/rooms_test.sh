#!/usr/bin/env bash
# The rooms of host/ stand on each other as host/CMakeLists.txt says.
#
#   rooms_test.sh                draws them, each in a row above all that it stands on
#   rooms_test.sh TEST           runs one of the tests below
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# folder_of: by the target's name. stands_on: by the folder, the folders that it may include from, " a b ".
declare -A folder_of stands_on
order=()

readRooms() {
  local line words name room
  while read -r line; do
    line=${line#luciole_room(}
    read -r -a words <<<"${line%)*}"
    name=${words[0]}
    room=${words[1]}
    folder_of[$name]=$room
    order+=("$room")
    stands_on[$room]=" "
    local word below in_rooms=
    for word in "${words[@]:2}"; do
      case $word in
        ROOMS) in_rooms=yes ;;
        LIBRARIES | INCLUDES | FILES | WITHOUT) in_rooms= ;;
        *)
          [[ $in_rooms ]] || continue
          for below in ${folder_of[$word]} ${stands_on[${folder_of[$word]}]}; do
            [[ ${stands_on[$room]} == *" $below "* ]] || stands_on[$room]+="$below "
          done
          ;;
      esac
    done
  done < <(grep "^luciole_room(" host/CMakeLists.txt)
}

# The highest room first; those of a row don't know each other.
drawRooms() {
  local -A height rows
  local room below highest=0 row
  for room in "${order[@]}"; do
    height[$room]=0
    for below in ${stands_on[$room]}; do
      ((height[$room] > height[$below])) || height[$room]=$((height[$below] + 1))
    done
    rows[${height[$room]}]+="   $room"
    ((highest >= height[$room])) || highest=${height[$room]}
  done
  echo "    tools/cli"
  for ((row = highest; row >= 0; --row)); do echo "    ${rows[$row]#   }"; done
}

# A public header belongs to the room that has a source of its name. What has none is data for all.
roomOfPublic() {
  local source
  source=$(find host -path host/tools -prune -o -name "$(basename "$1" .hpp).cpp" -printf '%P\n')
  echo "${source:-.}"
}

PublicHeadersIncludeEachOtherAlone() {
  ! grep -nE '^#include ("|<(CL|tbb|nlohmann|fmt)/)' host/include/luciole/*.hpp | grep -v '"luciole/' &&
    ! grep -nE '^ *#define' host/include/luciole/*.hpp | grep -v ' LUCIOLE_' &&
    (($(find host/include -name '*.hpp' | wc -l) <= 25))
}

# It is built against an installed library, too.
PythonKnowsPublicHeadersAlone() {
  ! grep -rE '^#include' host/python/src | grep -vE '#include (<[a-z_]+>|<sys/[a-z]+[.]h>|<(nanobind|glm|luciole)/[a-z_/.]+>|"[a-z_]+[.]hpp")$'
}

# An installed library has no other files.
PublicHeadersNameNoFileOfARoom() {
  ! sed 's|^#include.*||; s|luciole/[a-z_]*[.]hpp||g' host/include/luciole/*.hpp |
    grep -E '[a-z_]+[.](hpp|cpp|clh?)\b|(host|kernels)/'
}

RoomsIncludeOnlyFromWhatTheyStandOn() {
  local file room other status=0
  while IFS=: read -r file other; do
    room=${file#host/}
    room=${room%/*}
    other=${other#*\"}
    [[ $other == luciole/* ]] && other=$(roomOfPublic "$other")
    other=${other%/*}
    [[ $room == include/luciole || $room == python/src ]] && continue
    case $other in . | kernels | kernels/* | "$room") continue ;; esac
    [[ $room == tools/cli ]] && continue
    [[ ${stands_on[$room]-} == *" $other "* ]] || {
      echo "$file includes from $other, on which $room doesn't stand"
      status=1
    }
  done < <(grep -rE '^#include "' host --include='*.cpp' --include='*.hpp')
  return $status
}

EveryFolderIsARoom() {
  local folder status=0
  while read -r folder; do
    [[ $folder == tools/cli || $folder == include/luciole || $folder == python/src || -v stands_on[$folder] ]] || {
      echo "host/$folder has sources and is no room of host/CMakeLists.txt"
      status=1
    }
  done < <(find host -name '*.[ch]pp' -printf '%P\n' | sed 's|/[^/]*$||' | sort -u)
  return $status
}

OnlyTheirRoomsKnowLibraries() {
  local status=0
  allow() { # allow HEADER ROOM…: who may include it
    local header=$1 file room
    shift
    while read -r file; do
      room=${file#host/}
      room=${room%/*}
      [[ " $* " == *" $room "* ]] || {
        echo "$file includes $header"
        status=1
      }
    done < <(grep -rlE "^#include <$header" host)
  }
  allow OpenImageIO image
  allow embree rays
  allow CL/ cl
  allow nettle base
  allow half.h image tools/viewing
  return $status
}

LibraryKnowsNoOptions() {
  # Its messages name fields; tools/cli/option_names.cpp has the options for them.
  ! grep -rnE '"[^"]*(--[a-z]|luciole (render|relight|devices|shade|info) )' host --include='*.[ch]pp' --exclude-dir=tools
}

DrawingIsWhatCMakeLinks() {
  local drawn
  drawn=$(drawRooms)
  [[ $(<host/README.md) == *"$drawn"* ]] || {
    printf 'host/README.md lacks the drawing of the rooms as they are:\n%s\n' "$drawn"
    return 1
  }
}

readRooms
if (($# == 0)); then drawRooms; else "$1"; fi
