#!/usr/bin/env bash
# make_hashes.sh LUCIOLE >hashes.json: the hashes that scene_hashes_test.cpp asks of every device, as the default one gives them. For a
# change that means to change pictures.
set -euo pipefail
luciole=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../../../scenes"
folder=$(mktemp -d "${TMPDIR:-/tmp}/luciole-test-XXXXXX")
trap 'rm -rf "$folder"' EXIT

echo "{"
comma=
for scene in city colonnade cornell fireflies spheres underwater; do
  for shadows in hard exact; do
    hash=$("$luciole" render "$scene.json" --size 96x54 --shadows "$shadows" --hash --quiet -o "$folder/a.exr")
    printf '%s  "%s %s": "%s"' "$comma" "$scene" "$shadows" "${hash%% *}"
    comma=$',\n'
  done
done
printf '\n}\n'
