#!/usr/bin/env bash
# `candela render` and `candela merge` on a small scene of a bent sheet under a sky: outputs,
# statistics, parts, checkpoints and interruption. Needs an OpenCL device.
set -uo pipefail
candela=$(realpath "${CANDELA:-build/candela}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
passed=0 failed=0

check() { # WHAT CONDITION…
  local what=$1
  shift
  if "$@"; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED: $what"
    sed 's/^/  /' err 2> /dev/null
  fi
}

# Positions of four corners, then the indices of two triangles that share an edge.
floats() { # little-endian, of the values -1 0 1 only
  for value in "$@"; do
    case $value in -1) printf '\0\0\200\277' ;; 0) printf '\0\0\0\0' ;; 1) printf '\0\0\200\77' ;; esac
  done
}
data=$({ floats -1 0 1 1 0 1 1 1 -1 -1 0 -1 && printf '\0\0\1\0\2\0\0\0\2\0\3\0'; } | base64 -w 0)
cat > sheet.gltf << JSON
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
   "min": [-1, 0, -1], "max": [1, 1, 1]},
  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,$data"}]}
JSON

run() { # STATUS ARGUMENT…
  local status=$1
  shift
  timeout 300 "$candela" "$@" > out 2> err
  local got=$?
  [ $got -eq "$status" ] || echo "candela $*: status $got instead of $status" >> err
  [ $got -eq "$status" ]
}
render() { run 0 render sheet.gltf --background 1,0.5,0.25 --size 40x24 --spp 52 --quiet "$@"; }
film_of() { sed -n 's/.*"film_sha256": "\([0-9a-f]*\)".*/\1/p' "$1"; }
same_film() { [ -n "$(film_of "$1")" ] && [ "$(film_of "$1")" = "$(film_of "$2")" ]; }
has() { grep -qF -- "$2" "$1"; }

# Outputs and statistics.
check "all formats" render -o a.exr -o a.png -o a.jpg -o a.hdr -o a.tif --aov all --stats a.json
for file in a.exr a.png a.jpg a.hdr a.tif; do check "$file is there" test -s $file; done
check "nothing is said with --quiet" test ! -s out -a ! -s err
for member in version scene device platform name driver settings triangles instances lights times \
  load_s bvh_s compile_s upload_s render_s render_cpu_s write_s wall_s paths rays camera bounce shadow \
  mrays_per_s peak_rss_bytes film_sha256 kernels launches items total_s min_s median_s max_s first_s; do
  check "statistics have $member" has a.json "\"$member\":"
done
check "two triangles" has a.json '"triangles": 2'
check "a path for each sample" has a.json "\"paths\": $((40 * 24 * 52))"
check "the size follows the camera" run 0 render sheet.gltf --size 40x --spp 1 -q -o b.png
for size in 1x1 16000x1 1x16000; do
  check "$size pixels" run 0 render sheet.gltf --size $size --spp 1 -q -o b.exr -o b.tif
done
rm b.exr b.tif
check "more than JPEG holds" run 5 render sheet.gltf --size 65536x1 --spp 1 -q -o big.jpg
check "is refused in one line" test "$(wc -l < err)" -eq 1 -a ! -e big.jpg
check "nothing open but files" run 0 render sheet.gltf --size 8x8 --spp 1 -o b.exr <&-
check "a crop" render --crop 8,4,16,9 -o crop.exr --stats crop.json
check "the picture is what the film is" run 0 compare a.exr a.exr
check "a header tells the sheet's name" grep -qa "sheet.gltf" a.exr

# A name that is not UTF-8 costs its byte, not the picture; two cameras without a name are two.
bad=$'b\xffd.gltf'
lens='{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}'
sed -e 's/"nodes": \[0\]/"nodes": [0, 1, 2]/' -e "s/\"meshes\"/\"cameras\": [$lens, $lens], &/" \
  -e 's/{"mesh": 0}/&, {"camera": 0}, {"camera": 1}/' sheet.gltf > "$bad"
view=(render "$bad" --size 8x8 --spp 32 --quiet)
check "a name that is not UTF-8" run 0 "${view[@]}" -o v0.exr --samples 0:16 --camera 0 --stats v.json
check "is mended" has v.json 'b?d.gltf'
check "another camera" run 0 "${view[@]}" -o v1.exr --samples 16:16 --camera 1
check "is another picture" run 3 merge v0.exr v1.exr -o v.exr
check "by its index" has err "the index of the camera is 1 there and 0 here"

# A part of the film must be the same film, whatever the cut and the order.
check "part 1" render --samples 32:20 -o c.exr --aov all
check "part 2" render --samples 0:16 -o a1.exr --aov all
check "part 3" render --samples 16:16 -o b1.exr --aov all
check "they merge" run 0 merge c.exr a1.exr b1.exr -o m.exr -o m.png --stats m.json
check "into the same film" same_film a.json m.json
check "and the same picture" run 0 compare m.exr a.exr
check "with the same depth" run 0 compare m.exr a.exr --layer depth
check "and the same variance" run 0 compare m.exr a.exr --layer variance
check "one part alone is refused" run 3 merge a1.exr b1.exr -o n.exr
check "and says what is missing" has err "--samples 32:20"
check "nothing is written then" test ! -e n.exr
check "a part of another seed" render --samples 32:20 --seed 9 -o d.exr --aov all
check "is refused" run 3 merge a1.exr b1.exr d.exr -o n.exr
check "by name" has err "d.exr: does not belong to a1.exr: --seed is 9 there and 0 here"

# Interrupted at some moment, then resumed: the same film.
long=(render sheet.gltf --background 1,0.5,0.25 --size 160x96 --spp 1024 --quiet)
timeout 300 "$candela" "${long[@]}" -o stopped.exr --checkpoint c.checkpoint \
  --checkpoint-every 0.2 --stats stopped.json > out 2> err &
pid=$!
for _ in $(seq 600); do [ -e c.checkpoint ] && break; sleep 0.1; done
kill -TERM $pid # timeout hands it on; an interrupt is ignored by what a script starts behind it
wait $pid
check "an interrupted render ends with 130" test $? -eq 130
check "and says how far it is" has err "interrupted: the picture has "
check "and is written" test -s stopped.exr
check "and knows it" has stopped.json '"interrupted": true'
check "it goes on" run 0 "${long[@]}" -o resumed.exr --checkpoint c.checkpoint --resume \
  --stats resumed.json
check "a whole one" run 0 "${long[@]}" -o whole.exr --stats whole.json
check "as one that was not interrupted" same_film resumed.json whole.json
check "another scene is refused" run 3 render sheet.gltf --background 1,1,1 --size 160x96 \
  --spp 1024 -o x.exr --checkpoint c.checkpoint --resume
check "by name" has err "c.checkpoint: does not belong to this render"
# Nor is one that goes on where no tile begins, though its checksum is right.
python3 - << 'PYTHON'
import hashlib, json, struct
data = open("c.checkpoint", "rb").read()[:-32]
at = data.index(b"\n") + 1
size = struct.unpack("=I", data[at + 4:at + 8])[0]
head = json.loads(data[at + 8:at + 8 + size])
head["state"]["next_pixel"] = 160 * 96
text = json.dumps(head).encode()
data = data[:at + 4] + struct.pack("=I", len(text)) + text + data[at + 8 + size:]
open("beyond.checkpoint", "wb").write(data + hashlib.sha256(data).digest())
PYTHON
check "a state out of range is refused" run 3 "${long[@]}" -o x.exr --checkpoint beyond.checkpoint \
  --resume
check "by name" has err "beyond.checkpoint: the checkpoint is damaged: it goes on where"
head -c 1000 c.checkpoint > short.checkpoint
check "a damaged one is refused" run 3 render sheet.gltf --size 160x96 -o x.exr \
  --checkpoint short.checkpoint --resume
check "nothing is written then" test ! -e x.exr

# Limits, reports and refusals that need a scene.
check "a time limit ends it" run 0 render sheet.gltf --size 64x48 --time 0.3 -q -o t.png
check "a noise target ends it" run 0 render sheet.gltf --size 64x48 --noise 0.5 -q -o t.png \
  --stats n.json
check "early" test "$(sed -n 's/.*"most": \([0-9]*\).*/\1/p' n.json)" -lt 65536
check "a profile" render -o p.png --profile --trace p.json
check "has kernels in its table" has err "intersect"
check "a trace" python3 -m json.tool p.json /dev/null
check "no such camera" run 2 render sheet.gltf -o x.png --camera nobody
check "no such device" run 2 render sheet.gltf -o x.png --device nobody
check "a crop outside" run 2 render sheet.gltf -o x.png --size 8x8 --crop 4,4,8,8
check "no such environment" run 3 render sheet.gltf -o x.png --env none.hdr
check "an infinite environment" run 2 render sheet.gltf -o x.png --background 10,1,1 \
  --env-strength 1e38
check "leave no file" test ! -e x.png
check "no temporary file stays" test -z "$(find . -name '*.tmp*' -o -name '.*.exr*')"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
