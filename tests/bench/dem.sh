#!/bin/bash
# Installs the peers (the product needs none of them) and runs dem.py: tests/bench/dem.sh BUILD_FOLDER [options of dem.py].
# BUILD_FOLDER is a configured build of this tree; the benchmark is plain `demcal simulate`.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: dem.sh BUILD_FOLDER [options]}
shift
missing=()
for package in liggghts lammps openmpi-bin; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if ((${#missing[@]})); then
  if ((EUID == 0)); then apt-get install -y --no-install-recommends "${missing[@]}"; else sudo apt-get install -y --no-install-recommends "${missing[@]}"; fi
fi
cmake --build "$build" --target demcal
exec python3 "$root/tests/bench/dem.py" "$build/cli/demcal" "$@"
