#!/usr/bin/env bash
# Runs test programs and scripts and adds up their counts: run.sh LOG_DIR PROGRAM…
#
# A program says what it did by cmocka's closing lines, a script by a last line "N passed, N failed"
# (", N skipped"). The last line printed here has the sums in the same form. The exit status is 0
# only if something passed and nothing failed.
#   TEST_TIMEOUT  seconds that each may take, 900 by default
#   TEST_JOBS     how many run at once, 2 by default
set -uo pipefail

# One program: prints its line at once and leaves "passed failed skipped" in its .count file.
run_one() { # LOG_DIR PROGRAM
  local program=$2 name log start status seconds passed failed skipped
  name=$(echo "$program" | sed -e 's,^.*tests/,,' -e 's,\.[a-z]*$,,')
  log=$1/log/${name//\//_}.log
  start=$(date +%s%N)
  case $program in
    *.sh) set -- bash "$program" ;;
    *.py) set -- python3 "$program" ;;
    */*) set -- "$program" ;;
    *) set -- "./$program" ;;
  esac
  timeout -k 10 "${TEST_TIMEOUT:-900}" "$@" > "$log" 2>&1 < /dev/null
  status=$?
  seconds=$((($(date +%s%N) - start) / 100000000))
  read -r passed failed skipped < <(count "$log")
  if [ $status -eq 124 ] || [ $status -eq 137 ]; then
    echo "run.sh: stopped after ${TEST_TIMEOUT:-900} s" >> "$log"
    failed=$((failed + 1))
  elif [ $status -ne 0 ] && [ "$failed" -eq 0 ]; then
    echo "run.sh: exit status $status" >> "$log"
    failed=1
  elif [ $((passed + failed + skipped)) -eq 0 ]; then
    echo "run.sh: no test ran" >> "$log"
    failed=1
  fi
  echo "$passed $failed $skipped" > "${log%.log}.count"
  { # one write, so that lines of concurrent programs do not mix
    printf '%-4s %-36s %4d passed, %d failed' \
      "$([ "$failed" -eq 0 ] && echo ok || echo FAIL)" "$name" "$passed" "$failed"
    [ "$skipped" -eq 0 ] || printf ', %d skipped' "$skipped"
    printf '  %d.%d s\n' $((seconds / 10)) $((seconds % 10))
    [ "$failed" -eq 0 ] || sed 's/^/     | /' "$log" | tail -n 60
  } > "${log%.log}.line"
  cat "${log%.log}.line"
}

count() { # LOG: "passed failed skipped"
  awk '
    /^\[  PASSED  \] [0-9]+ test\(s\)/ { passed += $4 }
    /^\[  FAILED  \] [0-9]+ test\(s\)/ { failed += $4 }
    /^\[  SKIPPED \] [0-9]+ test\(s\)/ { skipped += $4 }
    /^[0-9]+ passed, [0-9]+ failed(, [0-9]+ skipped)?$/ { p = $1; f = $3; s = $5; summary = 1 }
    END { if (summary) { passed += p; failed += f; skipped += s }
          print passed + 0, failed + 0, skipped + 0 }' "$1"
}

logs=$1
shift
if [ "${RUN_ONE:-}" ]; then
  run_one "$logs" "$1"
  exit 0
fi

rm -rf "$logs/log"
mkdir -p "$logs/log"
printf '%s\n' "$@" | RUN_ONE=1 xargs -r -n 1 -P "${TEST_JOBS:-2}" bash "$0" "$logs"
passed=0 failed=0 skipped=0
for program in "$@"; do
  name=$(echo "$program" | sed -e 's,^.*tests/,,' -e 's,\.[a-z]*$,,' -e 's,/,_,g')
  read -r p f s 2> /dev/null < "$logs/log/$name.count" || { p=0 f=1 s=0; }
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
done
summary="$passed passed, $failed failed"
[ $skipped -eq 0 ] || summary+=", $skipped skipped"
echo "$summary"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
