#!/usr/bin/env bash
# Makes every picture that a README shows, anew.
#
#   scenes/make_pictures.sh          all of them; the plots are measurements, which take minutes and want a quiet machine
#   scenes/make_pictures.sh PART     those with PART in their path
#
# tests/tools/cli/readme_test.cpp holds the lines below against the READMEs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
part=${1-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$root/luciole" "$root/scenes" "$root/kernels" "$work"
cd "$work"

wanted() { [[ $1 == *"$part"* ]]; }

# picture FILE COMMAND…: the command's last word is the option that takes the file's name.
picture() {
  local file=$1 name=${1##*/}
  shift
  wanted "$file" || return 0
  echo "$file"
  ./luciole "$@" "$name"
  mv -f "$name" "$root/$file"
}

picture scenes/fireflies.jpg render scenes/fireflies.json --shadows pcf --size 960x540 --samples 16 -o
picture scenes/lanterns.jpg render scenes/lanterns.json --light-error 1/256 --size 960x540 --samples 16 -o
picture scenes/colonnade.jpg render scenes/colonnade.json --shadows pcf --size 960x540 --samples 16 -o
picture scenes/colonnade_night.jpg render scenes/colonnade_night.json --light-error 1/64 --confidence 0.95 --size 960x540 --samples 4 -o
picture scenes/underwater.jpg render scenes/underwater.json --shadows pcf --size 960x540 --samples 16 -o
picture scenes/city.jpg render scenes/city.json --shadows pcf --size 960x540 --samples 16 -o
picture scenes/spheres.jpg render scenes/spheres.json --shadows pcf --size 960x540 --samples 16 -o
picture scenes/cornell.jpg render scenes/cornell.json --shadows pcf --size 960x540 --samples 16 -o

picture scenes/spheres_flat.jpg render scenes/spheres.json --shading flat --crop 190,50,450,470 --shadows pcf --size 960x540 --samples 16 -o
picture scenes/spheres_gouraud.jpg render scenes/spheres.json --shading gouraud --crop 190,50,450,470 --shadows pcf --size 960x540 --samples 16 -o
picture scenes/spheres_phong.jpg render scenes/spheres.json --shading phong --crop 190,50,450,470 --shadows pcf --size 960x540 --samples 16 -o
picture scenes/spheres_toon.jpg render scenes/spheres.json --model toon --crop 190,50,450,470 --shadows pcf --size 960x540 --samples 16 -o
picture scenes/spheres_cook.jpg render scenes/spheres.json --model cook-torrance --crop 190,50,450,470 --shadows pcf --size 960x540 --samples 16 -o

picture scenes/lesson/flat.jpg render scenes/lesson/shading.json --shading flat --shadows pcf --samples 16 -o
picture scenes/lesson/gouraud.jpg render scenes/lesson/shading.json --shading gouraud --shadows pcf --samples 16 -o
picture scenes/lesson/phong.jpg render scenes/lesson/shading.json --shading phong --shadows pcf --samples 16 -o
picture scenes/lesson/part_ambient.jpg render scenes/lesson/shading.json --set 'objects[1].segments=96' --set 'objects[2].segments=96' --set ambient=0.2 --aov ambient --shadows pcf --samples 16 -o
picture scenes/lesson/part_diffuse.jpg render scenes/lesson/shading.json --set 'objects[1].segments=96' --set 'objects[2].segments=96' --set ambient=0.2 --aov diffuse_light --shadows pcf --samples 16 -o
picture scenes/lesson/part_specular.jpg render scenes/lesson/shading.json --set 'objects[1].segments=96' --set 'objects[2].segments=96' --set ambient=0.2 --aov specular_light --shadows pcf --samples 16 -o
picture scenes/lesson/shininess.jpg render scenes/lesson/shading.json --set 'objects[1].segments=96' --set 'objects[2].segments=96' --sweep materials.red.shininess=4,16,64 --shadows pcf --samples 16 -o
picture scenes/lesson/normals_flat.jpg render scenes/lesson/shading.json --aov normal --shading flat -o
picture scenes/lesson/normals_phong.jpg render scenes/lesson/shading.json --aov normal --shading phong -o
picture scenes/lesson/moving_light.jpg render scenes/lesson/shading.json --size 300x225 --set 'objects[1].segments=96' --set 'objects[2].segments=96' --sweep 'lights[0].position[0]=-5,-1.5,2,5.5' --shadows pcf --samples 16 -o
picture scenes/lesson/spot_cutoff.jpg render scenes/lesson/spot_cutoff.json --shadows pcf --samples 16 -o
picture scenes/lesson/spot_exponent.jpg render scenes/lesson/spot_exponent.json --shadows pcf --samples 16 -o
picture scenes/lesson/attenuation.jpg render scenes/lesson/attenuation.json --shadows pcf --samples 16 -o
picture scenes/lesson/fog_linear.jpg render scenes/lesson/fog_linear.json --shadows pcf --samples 16 -o
picture scenes/lesson/fog_exp.jpg render scenes/lesson/fog_exp.json --shadows pcf --samples 16 -o
picture scenes/lesson/fog_exp2.jpg render scenes/lesson/fog_exp2.json --shadows pcf --samples 16 -o
picture scenes/lesson/shadows_hard.jpg render scenes/lesson/shadows.json --shadows hard --shadow-size 128 --samples 16 -o
picture scenes/lesson/shadows_pcf.jpg render scenes/lesson/shadows.json --shadows pcf --shadow-size 128 --samples 16 -o
picture scenes/lesson/shadows_soft.jpg render scenes/lesson/shadows.json --shadows soft --samples 16 -o
picture scenes/lesson/shadows_exact.jpg render scenes/lesson/shadows.json --shadows exact --shadow-size 128 --samples 16 -o
picture scenes/lesson/shadow_map.png shadow-map scenes/lesson/shadows.json --light 0 --shadow-size 128 -o
picture scenes/lesson/retro_phong.jpg render scenes/lesson/shaders.json --set 'lights[0].position=[0.6,3.2,7]' --samples 16 --shadows pcf -o
picture scenes/lesson/retro.jpg render scenes/lesson/shaders.json --set 'lights[0].position=[0.6,3.2,7]' --model scenes/lesson/retro.clh --samples 16 --shadows pcf -o
picture scenes/lesson/ward.jpg render scenes/lesson/shaders.json --model kernels/examples/ward.clh --samples 16 --shadows pcf -o
picture scenes/lesson/brushed.jpg render scenes/lesson/shaders.json --model kernels/examples/ward_anisotropic.clh --samples 16 --shadows pcf -o
picture scenes/lesson/minnaert.jpg render scenes/lesson/shaders.json --model kernels/examples/minnaert.clh --samples 16 --shadows pcf -o
picture scenes/lesson/cloth.jpg render scenes/lesson/shaders.json --model kernels/examples/cloth.clh --samples 16 --shadows pcf -o
picture scenes/lesson/rim.jpg render scenes/lesson/shaders.json --model kernels/examples/rim.clh --samples 16 --shadows pcf -o
picture scenes/lesson/marble.jpg render scenes/lesson/shaders.json --surface kernels/examples/marble.clh --samples 16 --shadows pcf -o
picture scenes/lesson/contours.jpg render scenes/lesson/shaders.json --model toon --screen kernels/examples/contours.clh --samples 16 --shadows pcf -o
picture scenes/lesson/hatching.jpg render scenes/lesson/shaders.json --screen kernels/examples/hatching.clh --screen kernels/examples/contours.clh --samples 16 --shadows pcf -o

picture scenes/colonnade_rays.jpg reference scenes/colonnade.json --size 960x540 -o
if wanted scenes/colonnade_error.png; then
  ./luciole reference scenes/colonnade.json --size 960x540 -o rays.exr
  ./luciole render scenes/colonnade.json --size 960x540 --shadows hard -o maps.exr
fi
picture scenes/colonnade_error.png compare rays.exr maps.exr --error-map
picture scenes/speed_against_error.svg bench --json bench.json --plot
picture scenes/scale.svg scale scenes/fireflies.json --lights 1,10,...,100000 --vary culling -o fireflies --plot
picture scenes/light_errors.svg scale scenes/cornell.json --lights 1000,2000,...,1024000 --vary light-error=0,1/64,1/256,1/1024 -o errors --plot
