#!/usr/bin/env bash
# `candela compare` on pictures made by hand: metrics in closed form, verdicts and exit status.
set -uo pipefail
candela=$(realpath "${CANDELA:-build/candela}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
passed=0 failed=0

# Radiance pictures of two grey pixels, mantissas of 8 bits under the exponent 129: 128 is 1, 192 is
# 1.5.
picture() { # NAME MANTISSA MANTISSA
  printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n' > "$1"
  for mantissa in "$2" "$3"; do
    printf "%b" "$(printf '\\x%02x\\x%02x\\x%02x\\x81' "$mantissa" "$mantissa" "$mantissa")" >> "$1"
  done
}

expect() { # STATUS WORDS ARGUMENT…
  local status=$1 words=$2
  shift 2
  timeout 60 "$candela" compare "$@" > out 2> err
  local got=$?
  if [ $got -eq "$status" ] && cat out err | grep -qF -- "$words"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: compare $*: status $got instead of $status, or no '$words':"
    sed 's/^/  /' out err
  fi
}

picture a.hdr 128 128
picture same.hdr 128 128
picture b.hdr 128 192
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81' > small.hdr

expect 0 "identical, bit for bit" a.hdr same.hdr
expect 1 "rmse    0.353553" a.hdr b.hdr # sqrt(0.5^2 / 2)
expect 1 "mse     0.125" a.hdr b.hdr
expect 1 "max     0.5 at 1,0" a.hdr b.hdr
expect 1 "bias    -0.25" a.hdr b.hdr
expect 1 "mean    1 against 1.25" a.hdr b.hdr
expect 1 "psnr    9.0309" a.hdr b.hdr # 10 log10(1 / 0.125)
expect 0 "within the limits" a.hdr b.hdr --fail-over rmse=0.36
expect 1 "not within the limits" a.hdr b.hdr --fail-over rmse=0.35
expect 1 "not within the limits" a.hdr b.hdr --fail-over rmse=0.36 --fail-over max=0.4
expect 0 "within the limits" a.hdr b.hdr --fail-over bias=0.25
expect 1 "not within the limits" a.hdr b.hdr --fail-over bias=0.2
expect 0 "within the limits" a.hdr b.hdr --fail-over psnr=9
expect 1 "not within the limits" a.hdr b.hdr --fail-over psnr=10
expect 1 "not within the limits" a.hdr b.hdr --fail-over ssim=0.1 # too small to have one
expect 1 '"mse": 0.125' --json a.hdr b.hdr
expect 1 '"ssim": null' --json a.hdr b.hdr
expect 0 '"identical": true' --json a.hdr same.hdr
expect 1 "small.hdr" a.hdr small.hdr
expect 2 "only .exr files have layers" a.hdr b.hdr --layer depth

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
