#!/usr/bin/env bash
# deb.sh RELEASE FILE.deb: builds the package in a bare Debian of that release (bookworm, trixie), whose libraries it then asks for,
# installs it in a second one, as apt does, and renders a scene there. As root, with debootstrap; it takes a quarter of an hour.
set -euo pipefail
release=${1?the name of a Debian release} file=${2?the file to write}
in_root="$(dirname "${BASH_SOURCE[0]}")/../tests/bare_root.sh"

# shellcheck disable=SC2016  # what follows is for the shells in there
"$in_root" "$release" bash -euc '
  exec 3>&1 >&2
  source <(sed -n "/^packages=(/,/)$/p" luciole)
  apt-get update
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends dpkg-dev file "${packages[@]}"
  cmake --preset package
  cmake --build --preset package
  cat build/package/*.deb >&3' >"$file"

# shellcheck disable=SC2016
"$in_root" "$release" bash -euc '
  cat >/package.deb
  rm -rf /luciole
  cd /
  apt-get update
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /package.deb
  luciole --version
  luciole devices
  luciole render /usr/share/luciole/scenes/fireflies.json -o fireflies.png' <"$file"
