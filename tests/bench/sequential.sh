#!/bin/bash
# Builds the benchmark of sequential training and prints its tables: tests/bench/sequential.sh BUILD_FOLDER [--puq] [options
# of sequential.py]. With --puq it fetches PUQ, which the product does not need, and runs the repeats that
# sequential_puq.csv lacks: 90 CPU seconds each, 30 times four functions.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: sequential.sh BUILD_FOLDER [--puq] [options]}
shift
puq=()
if [ "${1:-}" = --puq ]; then
  shift
  source "$root/tests/bench/peers.sh"
  install_peers python3-scipy python3-sklearn cython3 git
  folder=$build/puq
  [ -d "$folder" ] || git clone https://github.com/parallelUQ/PUQ "$folder"
  git -C "$folder" checkout -q 074f80f
  (cd "$folder" && /usr/bin/python3 setup.py -q build_ext --inplace)
  puq=(--puq "$folder" --puq-rows "$root/tests/bench/sequential_puq.csv")
fi
cmake --build "$build" --target bench_sequential
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
exec /usr/bin/python3 "$root/tests/bench/sequential.py" "$build/tests/bench/bench_sequential" "${puq[@]}" "$@"
