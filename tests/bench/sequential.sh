#!/bin/bash
# Builds the benchmark of sequential training and prints its tables: tests/bench/sequential.sh BUILD_FOLDER [--puq] [options
# of sequential.py]. With --puq it fetches PUQ, which the product does not need, and runs it too: hours.
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
  puq=(--puq "$folder")
fi
cmake --build "$build" --target demcal_uq
march=$(grep -o -m 1 -- '-march=[^ "]*' "$build/compile_commands.json")  # as the library was compiled
g++ -std=c++20 -O2 "$march" -I "$root" $(pkg-config --cflags eigen3) "$root/tests/bench/sequential.cpp" \
  "$build/uq/libdemcal_uq.a" "$build/surrogate/libdemcal_surrogate.a" "$build/data/libdemcal_data.a" \
  $(pkg-config --libs gsl nlopt hdf5 netcdf libxxhash fmt) -ludunits2 -ltomlplusplus -o "$build/bench_sequential"
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
exec /usr/bin/python3 "$root/tests/bench/sequential.py" "$build/bench_sequential" "${puq[@]}" "$@"
