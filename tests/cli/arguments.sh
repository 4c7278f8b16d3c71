#!/usr/bin/env bash
# Wrong arguments: each ends with the exit status of the contract and one line that names the cure.
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
    sed 's/^/  stderr: /' err
  fi
}

# STATUS WORDS ARGUMENT…: one line on standard error that holds WORDS, nothing on standard output.
refuses() {
  local status=$1 words=$2
  shift 2
  timeout 60 "$candela" "$@" > out 2> err
  local got=$? good=0
  [ $got -eq "$status" ] && [ ! -s out ] && [ "$(wc -l < err)" -eq 1 ] && grep -qF -- "$words" err &&
    good=1
  report $good "candela $*: status $got instead of $status, or no line with '$words'"
}

# WORDS ARGUMENT…: status 0, WORDS on standard output, nothing on standard error.
says() {
  local words=$1
  shift
  timeout 60 "$candela" "$@" > out 2> err
  local got=$? good=0
  [ $got -eq 0 ] && [ ! -s err ] && grep -qF -- "$words" out && good=1
  report $good "candela $*: status $got, or no '$words'"
}

render() { # WORDS ARGUMENT…: a render of a scene that is not there, refused before it is looked for
  local words=$1
  shift
  refuses 2 "$words" render scene.gltf "$@"
}

says "Usage: candela" --help
says "candela 0." --version
for command in render devices info bsdf compare merge; do
  says "Usage: candela $command" $command --help
  refuses 2 "no option '--frobnicate'" $command --frobnicate
done
says "albedo" render --aov list
says "Usage: candela info" help info
for command in "" render info; do says "candela 0." $command --version; done
refuses 2 "no command given"
refuses 2 "did you mean 'render'?" rendr
refuses 2 "no command 'frobnicate'; see candela --help" frobnicate

refuses 2 "no scene given" render
refuses 2 "no output given" render scene.gltf
refuses 2 "'b.gltf' is one too many" render a.gltf b.gltf -o x.png
render "did you mean --spp?" -o x.png --sp 4 --sppp 4
render "'--s' is the start of several" -o x.png --s 4
render "no option '-x'" -x
render "-o needs a value" -o
render "--spp needs a value" -o x.png --spp
render "--quiet takes no value" -o x.png --quiet=1
render "x.foo: unknown image format" -o x.foo
render "unknown image format" -o png

for value in 12abc -3 +3 0 1.5 "" " 4" 0x10 99999999999 18446744073709551617 nan; do
  render "--spp: '$value'" -o x.png "--spp=$value"
done
for value in 1e999 nan inf -nan 1,5 0x1p3 "" 5s " 1" -1 0; do
  render "--time: '$value'" -o x.png "--time=$value"
  render "--noise: '$value'" -o x.png "--noise=$value"
done
for value in 0x4 4x0 x axb 4 4x4x4 -4x4 65537x4 4xx; do
  [ "$value" = 4 ] || render "--size: " -o x.png "--size=$value"
done
render "65536x65536 has more than 2147483648 pixels" -o x.png --size 65536x65536
for value in 1,2,3 1,2,3,4,5 1,2,0,4 1,2,3,0 -1,2,3,4 1,,3,4 "" 1,2,3,4x; do
  render "--crop: '$value'" -o x.png "--crop=$value"
done
for value in 1,2 1,2,3,4 1,2,-3 1,2,nan a,b,c ""; do
  render "--background: '$value'" -o x.png "--background=$value"
done
render "--seed: '4294967296'" -o x.png --seed 4294967296
render "--max-depth: '4096'" -o x.png --max-depth 4096
render "--exposure: 'bright'" -o x.png --exposure bright
render "--env-strength: '-1'" -o x.png --env-strength -1
render "--at: 'now'" -o x.png --at now
render "--tonemap: 'filmic' is not none, aces, agx or neutral" -o x.png --tonemap filmic
render "--schedule: 'best' is not auto, wavefront or fused" -o x.png --schedule best
render "--bvh: '4' is not auto, 2 or 8" -o x.png --bvh 4
render "--math: 'loose' is not exact or fast" -o x.png --math loose
render "no AOV is called 'depht'" -o x.exr --aov depht
render "--aov needs an output that ends in .exr" -o x.png --aov depth
render "--env and --background" -o x.png --env a.hdr --background 1,1,1

render "--samples: '16' is not" -o x.exr --spp 64 --samples 16
render "--samples: '16:16:16' is not" -o x.exr --spp 64 --samples 16:16:16
render "--samples: the count is 0" -o x.exr --spp 64 --samples 16:0
render "8 is not a multiple of 16" -o x.exr --spp 64 --samples 8:16
render "17 is not a multiple of 16" -o x.exr --spp 64 --samples 16:17
render "64 is not below --spp 64" -o x.exr --spp 64 --samples 64:16
render "16 + 64 is beyond --spp 64" -o x.exr --spp 64 --samples 16:64
render "4294967280 is not below" -o x.exr --spp 64 --samples 4294967280:16
render "holds at most" -o x.exr --spp 65536 --samples 0:65536
render "--samples needs an output that ends in .exr" -o x.png --spp 64 --samples 0:16

render "--resume needs --checkpoint" -o x.png --resume
render "x.png: would be written twice" -o x.png -o x.png
render "x.exr: would be written twice" -o x.exr --stats x.exr
render "s.json: would be written twice" -o x.png --trace s.json --stats s.json
render "scene.gltf: is read" -o x.png --stats scene.gltf
render "sky.hdr: is read" --env sky.hdr -o sky.hdr
render "--checkpoint-every needs --checkpoint" -o x.png --checkpoint-every 5

refuses 3 "scene.gltf" render scene.gltf -o x.png
refuses 3 ".: /: IO_ERROR" render . -o x.png
refuses 3 ".: /: IO_ERROR" info .
refuses 3 "/dev/null: /: IO_ERROR: it cannot be read: not a regular file" info /dev/null
refuses 3 ".: not a regular file" compare . .
refuses 3 ".: not a regular file" merge . -o x.exr
refuses 5 "/dev/full: exists and is not a regular file" render scene.gltf -o x.png --stats /dev/full
mkdir folder.png
refuses 5 "folder.png: exists and is not a regular file" render scene.gltf -o folder.png
rmdir folder.png
refuses 2 "unknown image format" render scene.gltf -o /dev/full
refuses 5 "missing/x.png" render scene.gltf -o missing/x.png
refuses 5 "missing/s.json" render scene.gltf -o x.png --stats missing/s.json
refuses 5 "missing/t.json" render scene.gltf -o x.png --trace missing/t.json
refuses 5 "missing/c" render scene.gltf -o x.png --checkpoint missing/c

refuses 2 "two pictures are needed" compare a.exr
refuses 2 "'c.exr' is one too many" compare a.exr b.exr c.exr
refuses 2 "'rmse' is not METRIC=VALUE" compare a.exr b.exr --fail-over rmse
refuses 2 "'size' is not mse" compare a.exr b.exr --fail-over size=3
refuses 2 "'much' is not a number" compare a.exr b.exr --fail-over rmse=much
refuses 3 "a.exr" compare a.exr b.exr
refuses 2 "no parts given" merge -o x.exr
refuses 2 "no output given" merge a.exr
refuses 2 "unknown image format" merge a.exr -o x
refuses 3 "a.exr" merge a.exr -o x.exr
refuses 5 "missing/x.exr" merge a.exr -o missing/x.exr
refuses 2 "no scene given" info
refuses 3 "scene.gltf" info scene.gltf

# What cannot be printed is a failure, whoever prints it, and told once.
for arguments in --help --version "render --help" "render --aov list" "help merge" devices; do
  timeout 60 "$candela" $arguments > /dev/full 2> err
  got=$? good=0
  [ $got -eq 5 ] && [ "$(grep -c "standard output: could not be written" err)" -eq 1 ] &&
    [ "$(wc -l < err)" -eq 1 ] && good=1
  report $good "candela $arguments > /dev/full: status $got"
done

# Nothing above may leave a file behind.
rm -f out
left=$(ls -A | grep -v '^err$')
good=0
[ -z "$left" ] && good=1
report $good "files were left behind: $left"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
