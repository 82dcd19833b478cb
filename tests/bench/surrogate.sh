#!/bin/bash
# Installs the peers (the product needs none of them), builds the benchmark and runs it: tests/bench/surrogate.sh BUILD_FOLDER
# [options of surrogate.py]. BUILD_FOLDER is a configured build of this tree.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: surrogate.sh BUILD_FOLDER [options]}
shift
source "$root/tests/bench/peers.sh"
install_peers python3-sklearn python3-openturns python3-scipy libopenblas0-pthread  # OpenBLAS: the peers at their best
cmake --build "$build" --target bench_surrogate
exec /usr/bin/python3 "$root/tests/bench/surrogate.py" "$build/tests/bench/bench_surrogate" "$@"
