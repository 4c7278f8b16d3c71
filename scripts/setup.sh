#!/usr/bin/env bash
# Installs the Debian packages that are missing: setup.sh [build] [test] [bench] [check], by default
# all of them. As root, or with sudo where that asks for nothing; else it prints the command to run.
set -euo pipefail

build="gcc g++ make pkg-config pocl-opencl-icd ocl-icd-opencl-dev opencl-c-headers
  libopenimageio-dev libpng-dev libtinygltf-dev nlohmann-json3-dev libstb-dev libjansson-dev nettle-dev
  libdraco-dev libmeshoptimizer-dev libopenvdb-dev libboost-dev"
test="libcmocka-dev mesa-opencl-icd oclgrind python3 python3-numpy"
bench="libembree-dev libnanovdb-dev python3"
check="clang-format cppcheck"

[ $# -gt 0 ] || set -- build test bench check
wanted=
for group in "$@"; do
  case $group in
    build | test | bench | check) wanted+=" ${!group}" ;;
    *) echo "setup.sh: no group '$group': use build, test, bench or check" >&2; exit 2 ;;
  esac
done

if ! command -v dpkg-query > /dev/null; then
  echo "setup.sh: this is not Debian; install what these packages hold and go on:" $wanted >&2
  exit 0
fi
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2> /dev/null |
  sed -n 's/^installed //p' || true)
missing=
for package in $wanted; do
  case $'\n'$installed$'\n' in *$'\n'$package$'\n'*) ;; *) missing+=" $package" ;; esac
done
[ -n "$missing" ] || exit 0

install="apt-get install -y --no-install-recommends$missing"
as_root=
if [ "$(id -u)" -ne 0 ]; then
  if command -v sudo > /dev/null && { sudo -n true 2> /dev/null || [ -t 0 ]; }; then
    as_root=sudo
  else
    echo "setup.sh: packages are missing; run this as root:" >&2
    echo "  $install" >&2
    exit 1
  fi
fi

echo "installing:$missing"
apt() { # quiet unless it fails
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 \
    -o Acquire::Retries=3 "$@" > "$log" 2>&1
}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Package lists may be absent or out of date; they are fetched only if the install needs them.
if ! apt install --no-install-recommends $missing; then
  if ! { apt update && apt install --no-install-recommends $missing; }; then
    tail -n 20 "$log" >&2
    echo "setup.sh: the installation failed; run it by hand: $install" >&2
    exit 1
  fi
fi
