#!/usr/bin/env bash
# bare_root.sh RELEASE COMMAND…: runs the command in a copy of this checkout, as its files are, in a bare Debian of that release
# (bookworm, trixie), which is made for it and removed afterwards. The shared files that tests use are seen there too, read-only.
#
# Exit status: the command's; 77 where no root can be made (no root rights, no debootstrap, no packages), with the reason.
set -euo pipefail

release=${1?the name of a Debian release}
(($# > 1)) || { echo "bare_root.sh RELEASE COMMAND…: no command" >&2 && exit 2; }
PATH=$PATH:/usr/sbin:/sbin

cannot() {
  printf 'bare_root.sh: no root of %s can be made here: %s\n' "$release" "$*" >&2
  exit 77
}

# Mounts in a name space of its own go when this process does, however it ends.
if [[ ! -v LUCIOLE_IN_BARE_ROOT ]]; then
  ((EUID == 0)) || cannot "it takes root's rights"
  command -v debootstrap >/dev/null || cannot "no debootstrap (apt install debootstrap)"
  unshare --mount true 2>/dev/null || cannot "nothing may be mounted"
  LUCIOLE_IN_BARE_ROOT=1 exec unshare --mount --propagation private bash "$0" "$@"
fi
unset LUCIOLE_IN_BARE_ROOT
shift
checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
shared=$(realpath "${LUCIOLE_SHARED:-$checkout/../shared}")

root=$(mktemp -d "${TMPDIR:-/var/tmp}/luciole-root-XXXXXX")
# Services that are installed there run as users of their own: a root that is root's alone keeps them from their files.
chmod 755 "$root"
# shellcheck disable=SC2317  # the trap calls it
cleanUp() {
  # The last mounted first; /dev and its like must be gone before anything is removed.
  local place
  while read -r place; do umount -l "$place"; done < <(awk -v root="$root/" 'index($2, root) == 1 { print $2 }' /proc/self/mounts | tac)
  ! grep -q " $root/" /proc/self/mounts && rm -rf --one-file-system "$root"
}
trap cleanUp EXIT
trap 'exit 1' INT TERM HUP

mirror=http://deb.debian.org/debian
security=http://deb.debian.org/debian-security
log=$root.log
debootstrap --variant=minbase "$release" "$root" "$mirror" </dev/null >"$log" 2>&1 || {
  tail -n 5 "$log" >&2
  cannot "debootstrap failed"
}
rm -f "$log"
for part in "$release" "$release-updates"; do echo "deb $mirror $part main"; done >"$root/etc/apt/sources.list"
echo "deb $security $release-security main" >>"$root/etc/apt/sources.list"
# How this machine's administrator reaches packages (proxies, checks of dates), Debian's and PyPI's.
cp /etc/apt/apt.conf.d/99* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
place=()
if [[ -r ${PIP_CERT-} ]]; then
  cp "$PIP_CERT" "$root/etc/pip.crt"
  place+=(PIP_CERT=/etc/pip.crt)
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"

mkdir "$root/luciole"
git -C "$checkout" ls-files -z --cached --others --exclude-standard |
  tar -C "$checkout" --null --files-from=- --ignore-failed-read -cf - | tar -C "$root/luciole" --no-same-owner -xf -
# PoCL asks /sys for the processor, and gives up without.
for folder in proc sys dev; do mount --rbind "/$folder" "$root/$folder"; done
if [[ -d $shared ]]; then
  mkdir "$root/shared"
  mount --bind "$shared" "$root/shared"
  mount -o remount,bind,ro "$root/shared"
  place+=(LUCIOLE_SHARED=/shared)
fi

status=0
chroot "$root" env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  "${place[@]}" ${CI+CI="$CI"} bash -c 'cd /luciole && exec "$@"' bash "$@" || status=$?
exit "$status"
