#!/usr/bin/env bash
# `candela bsdf`: closed forms, samples against evaluations, plots, and what is wrong said by file and
# line.
set -uo pipefail
candela=$(realpath "${CANDELA:-build/candela}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
passed=0 failed=0

cat > scene.gltf << 'END'
{"asset": {"version": "2.0"}, "extensionsUsed": ["CDL_material"], "scene": 0, "scenes": [{}],
 "textures": [{"source": 0}],
 "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg=="}],
 "materials": [
  {"name": "matt", "extensions": {"CDL_material": {"model": "diffuse", "reflectance": [0.8, 0.4, 0.2]}}},
  {"name": "glass", "extensions": {"CDL_material": {"model": "dielectric", "ior": 1.5}}},
  {"name": "mirror", "extensions": {"CDL_material": {"model": "mirror"}}},
  {"name": "brushed", "extensions": {"CDL_material":
    {"model": "conductor", "metal": "Al", "alpha": [0.1, 0.4]}}},
  {"name": "painted", "extensions": {"CDL_material":
    {"model": "diffuse", "reflectance": [1, 1, 1], "reflectanceTexture": {"index": 0}}}},
  {"name": "edge", "extensions": {"CDL_material": {"model": "interface"}}},
  {"name": "0", "extensions": {"CDL_material": {"model": "diffuse", "reflectance": [0, 0, 0]}}}]}
END

report() { # OK WHAT
  if [ "$1" -eq 1 ]; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED: $2"
    head -n 5 out err | sed 's/^/  /'
  fi
}

bsdf() { timeout 120 "$candela" bsdf scene.gltf "$@" > out 2> err; }

# AWK WHAT ARGUMENT…: status 0, and the script (of numbers a[1]…, with `close()`) finds no line bad.
holds() {
  local script=$1 what=$2
  shift 2
  bsdf --material "$@" < in
  local got=$? good=0
  [ $got -eq 0 ] && awk -F, '
    function near(x, y) { return (x - y) ^ 2 <= 1e-10 * (1 + y * y) }
    '"$script"'
    END { exit bad || !NR }' out && good=1
  report $good "$what: status $got, or other numbers"
}

refuses() { # STATUS WORDS ARGUMENT…: one line on standard error with the words, nothing else
  local status=$1 words=$2
  shift 2
  bsdf "$@" < in
  local got=$? good=0
  [ $got -eq "$status" ] && [ ! -s out ] && [ "$(wc -l < err)" -eq 1 ] && grep -qF -- "$words" err &&
    good=1
  report $good "bsdf $*: status $got instead of $status, or no line with '$words'"
}

# Lambert: reflectance / pi on both sides, cos / pi, nothing through; any length, comments, headings.
printf 'wo.x,wo.y,wo.z,wi.x,wi.y,wi.z\n# a comment\n\n0,0,1,0.6,0,0.8\n 0, 0, -3, 1.2, 0, -1.6 \n' > in
holds '!near($1, 0.8 / 3.14159265) || !near($2, 0.4 / 3.14159265) || !near($4, 0.8 / 3.14159265) { bad = 1 }
       END { if (NR != 2) bad = 1 }' "Lambert" matt --pairs -
cp in pairs.csv
holds 'NR > 2 { bad = 1 }' "pairs from a file" matt --pairs pairs.csv
printf '0,0,1,0.6,0,-0.8\n0,0,1,1,0,0\n1,0,0,0,0,1\n' > in
holds '$1 != 0 || $4 != 0 { bad = 1 }' "nothing through, nothing along the surface" matt --pairs -
holds '$1 != 0 || $4 != 0 { bad = 1 }' "delta lobes are not evaluated" glass --pairs -
holds '$1 != 0 { bad = 1 }' "names come before indices" 0 --pairs -
printf '0,0,1,0,0,1\n' > in
holds '!near($2, 0.4 / 3.14159265) { bad = 1 }' "indices" 00 --pairs -
grep -q "textures" err && report 0 "a note about textures where there are none"
bsdf --material painted --pairs - < in
grep -q "count as white" err && grep -q '^0.318' out
report $((!$?)) "textures count as white, and a note says so"

# Snell's law, Fresnel's reflectance at 0 degrees, and radiance over the square of the index.
printf '0,0,1\n' > in
holds '{ n++; through += $3 < 0 } $8 != 1 || $7 != 0 || $1 != 0 { bad = 1 }
       $3 < 0 && !near($4, 1 / 2.25) { bad = 1 }
       END { if (n != 10000 || (through / n - 0.96) ^ 2 > 1e-5) bad = 1 }' \
  "glass from outside" glass --sample 10000
printf '0.3,0,-0.953939201\n' > in
holds '$3 > 0 && (!near($1, -0.45) || !near($4, 2.25)) || $3 < 0 && (!near($1, -0.3) || !near($4, 1)) { bad = 1 }' \
  "glass from inside" glass --sample 1000
printf '0.6,0,0.8\n0,-0.6,-0.8\n' > in
holds 'NR <= 7 && (!near($1, -0.6) || !near($3, 0.8)) || NR > 7 && (!near($2, 0.6) || !near($3, -0.8)) { bad = 1 }
       END { if (NR != 14) bad = 1 }' "a mirror on both sides" mirror --sample 7

# Samples evaluated: weight = f cos / pdf, and the same pdf.
printf '0.5,0.2,0.8\n-0.3,0.1,-0.2\n' > in
bsdf --material brushed --sample 500 --seed 3 < in && cp out drawn &&
  awk -F, 'function d(l) { return l <= 500 ? "0.5,0.2,0.8" : "-0.3,0.1,-0.2" }
           { print d(NR) "," $1 "," $2 "," $3 }' drawn > in && bsdf --material brushed --pairs - < in &&
  paste -d, drawn out | awk -F, 'function abs(x) { return x < 0 ? -x : x }
    $7 > 0 { n++; for (c = 0; c < 3; c++)
      if (abs($(9 + c) * abs($3) - $(4 + c) * $7) > 1e-3 * $(4 + c) * $7) bad = 1
      if (abs($7 - $12) > 1e-3 * $12) bad = 1 }
    END { exit bad || n < 900 }'
report $((!$?)) "weights and densities of samples are those of pairs"
printf '0.5,0.2,0.8\n' > in
bsdf --material brushed --sample 500 --seed 3 < in && cmp -s out <(head -n 500 drawn)
report $((!$?)) "the same seed gives the same samples"
bsdf --material brushed --sample 500 --seed 4 < in && ! cmp -s out <(head -n 500 drawn)
report $((!$?)) "another seed gives others"

for material in brushed glass; do
  bsdf --material $material --plot $material.png < /dev/null && [ ! -s out ] &&
    [ "$(head -c 4 $material.png | od -An -tx1 | tr -d ' ')" = 89504e47 ]
  report $((!$?)) "a plot of $material"
done

printf '0,0,1,0,0\n' > in
refuses 3 "standard input:1: a number is missing or damaged; a line is wo.x,wo.y,wo.z,wi.x,wi.y,wi.z" --material matt --pairs -
printf '# one\n0,0,1,0,0,0\n' > in
refuses 3 "standard input:2: a direction must be finite and have a length" --material matt --pairs -
printf '0,0,nan\n' > in
refuses 3 "standard input:1: a direction" --material matt --sample 1
printf '0,0,1,2\n' > in
refuses 3 "more than its numbers" --material matt --sample 1
printf '0,0,1x\n' > in
refuses 3 "more than its numbers" --material matt --sample 1
refuses 3 "absent.csv: cannot be opened" --material matt --pairs absent.csv
refuses 2 "choose one by name or index: 0: matt" --material absent --sample 1
refuses 2 "has no material '7'" --material 7 --sample 1
refuses 2 "is interface: it scatters no light" --material edge --sample 1
refuses 2 "no material given" --sample 1
refuses 2 "nothing to do" --material matt
refuses 2 "exclude each other" --material matt --sample 1 --pairs -
refuses 2 "--sample: '0'" --material matt --sample 0
refuses 2 "must end in" --material matt --plot plot.txt
refuses 5 "no/folder" --material matt --plot no/folder/plot.png
refuses 2 "no OpenCL device matches" --material matt --plot p.png --device absent-device

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
