#!/bin/bash
# Builds and runs plan_loops.cpp: tests/bench/plan_loops.sh BUILD_FOLDER [LOOPS] [FIRST SEED]. BUILD_FOLDER is a configured
# build of this tree.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: plan_loops.sh BUILD_FOLDER [LOOPS] [FIRST SEED]}
cmake --build "$build" --target demcal_plan
march=$(grep -o -m 1 -- '-march=[^ "]*' "$build/compile_commands.json")  # as the library was compiled
g++ -std=c++20 -O2 "$march" -DFMT_SHARED -I "$root" $(pkg-config --cflags eigen3) "$root/tests/bench/plan_loops.cpp" \
  "$build/uq/libdemcal_plan.a" "$build/uq/libdemcal_uq.a" "$build/surrogate/libdemcal_surrogate.a" "$build/data/libdemcal_data.a" \
  $(pkg-config --libs gsl nlopt hdf5 netcdf libxxhash fmt) -ludunits2 -ltomlplusplus -o "$build/bench_plan_loops"
"$build/bench_plan_loops" "${@:2}"
