#!/bin/bash
# Installs the peers (the product needs none of them) and runs dem.py: tests/bench/dem.sh BUILD_FOLDER [options of dem.py].
# BUILD_FOLDER is a configured build of this tree; the benchmark is plain `demcal simulate`.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: dem.sh BUILD_FOLDER [options]}
shift
source "$root/tests/bench/peers.sh"
install_peers liggghts lammps openmpi-bin
cmake --build "$build" --target demcal
exec python3 "$root/tests/bench/dem.py" "$build/cli/demcal" "$@"
