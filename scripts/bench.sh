#!/usr/bin/env bash
# Benchmarks, as Markdown tables on standard output: bench.sh [SCENE ...]
#
#   CANDELA             the program; build/candela by default
#   BENCH_RUNS          runs of each alternative, 5 by default; the median counts
#   CANDELA_PEERS_ENV   folder made by `sh ../shared/peers/setup.sh FOLDER`: compares with other
#                       renderers too
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
export CANDELA=${CANDELA:-$root/build/candela}
case $CANDELA in /*) ;; *) CANDELA=$PWD/$CANDELA ;; esac
bench="$root/scripts/bench_render.py"

scenes=("$@")
if [ ${#scenes[@]} -eq 0 ]; then
  shopt -s nullglob
  scenes=("$root"/scenes/*.gltf "$root"/scenes/*/*.gltf)
fi
[ ${#scenes[@]} -gt 0 ] || { echo "bench.sh: no scenes: name some" >&2; exit 2; }

echo "# Kernels: PoCL's work-item loop vectorised and not"
echo
"$bench" kernels "${scenes[@]}"
echo "# Start"
echo
"$bench" start "${scenes[0]}"
echo "# Cores"
echo
"$bench" cores "${scenes[0]}"

peers=$root/../shared/peers
if [ ! -d "$peers" ]; then
  echo "No ../shared/peers here: nothing to compare with."
elif [ -z "${CANDELA_PEERS_ENV:-}" ] || [ ! -x "$CANDELA_PEERS_ENV/venv/bin/python" ]; then
  echo "To compare with other renderers: sh ../shared/peers/setup.sh FOLDER, which downloads them,"
  echo "then CANDELA_PEERS_ENV=FOLDER make bench"
else
  echo "# Other renderers"
  echo
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  python=$CANDELA_PEERS_ENV/venv/bin/python
  "$python" "$peers/scenes.py" "$work/scenes" --assets "$root/../shared/assets" > /dev/null
  "$python" "$peers/compare.py" --scenes "$work/scenes" --out "$work/table.json" \
    --python-cycles "$CANDELA_PEERS_ENV/bvenv/bin/python" \
    --renderers "${CANDELA_PEERS:-mitsuba,luxcore,cycles},candela:$CANDELA"
  echo "# Materials"
  echo
  "$root/scripts/bench_materials.py" --mitsuba "$python"
fi
