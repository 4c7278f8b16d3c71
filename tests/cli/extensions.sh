#!/usr/bin/env bash
# What `candela info` says of the extensions in a file, and what becomes of one that is required.
set -uo pipefail
candela=$(realpath "${CANDELA:-build/candela}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
passed=0 failed=0

report() { # OK WHAT
  if [ "$1" -eq 1 ]; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED: $2"
    sed 's/^/  stdout: /' out
    sed 's/^/  stderr: /' err
  fi
}

scene() { # USED REQUIRED MORE: a file of that
  printf '{"asset":{"version":"2.0"},"extensionsUsed":[%s]%s%s}\n' "$1" \
    "${2:+,\"extensionsRequired\":[$2]}" "$3" > scene.gltf
}

used='"KHR_draco_mesh_compression","EXT_meshopt_compression","KHR_meshopt_compression"'
used+=',"KHR_mesh_quantization","EXT_texture_webp"'
quiet='"KHR_xmp_json_ld","KHR_texture_basisu"'
strange='"ABC_unheard_of","KHR_gaussian_splatting"'

# In JSON: three lists, each in the order of the file.
scene "$used,$quiet,$strange" '' ''
"$candela" info --json scene.gltf > out 2> err
status=$? good=0
lists=$(tr -d ' \n' < out | grep -o '"extensions":{[^}]*}')
[ "$lists" = "\"extensions\":{\"used\":[$used],\"ignored\":[$quiet],\"unsupported\":[$strange]}" ] &&
  [ $status -eq 0 ] && good=1
report $good "info --json: status $status, $lists"

# In words.
"$candela" info scene.gltf > out 2> err
status=$? good=0
[ $status -eq 0 ] && grep -q '^used .*KHR_draco_mesh_compression' out &&
  grep -q '^ignored .*KHR_xmp_json_ld' out && grep -q '^unsupported .*ABC_unheard_of' out && good=1
report $good "info: status $status"

# All that is used or ignored may be required; what is not supported may not, and is named.
scene "$used,$quiet" "$used,$quiet" ''
"$candela" info scene.gltf > out 2> err
status=$? good=0
[ $status -eq 0 ] && good=1
report $good "what is supported is required: status $status"

for name in ABC_unheard_of KHR_gaussian_splatting; do
  scene "$used,\"$name\"" "\"KHR_mesh_quantization\",\"$name\"" ''
  for command in "info scene.gltf" "render scene.gltf -o x.png --spp 1 --size 4x4"; do
    timeout 60 "$candela" $command > out 2> err
    status=$? good=0
    [ $status -eq 3 ] && [ ! -s out ] && [ ! -e x.png ] && [ "$(wc -l < err)" -eq 1 ] &&
      grep -q "scene.gltf: /extensionsRequired/1: UNSUPPORTED_EXTENSION: .*$name" err && good=1
    report $good "$command, which requires $name: status $status"
  done
done

# An object that nobody declared, deep down.
scene '"KHR_texture_transform"' '' ',"textures":[{}],"materials":[{"pbrMetallicRoughness":{
  "baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"extensions":{"ABC_x":{}}}}}}}]'
"$candela" info scene.gltf > out 2> err
status=$? good=0
at=/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform
[ $status -eq 3 ] && grep -q "$at/extensions/ABC_x: UNDECLARED_EXTENSION" err && good=1
report $good "an undeclared extension: status $status"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
