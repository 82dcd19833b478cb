#!/bin/bash
# Installs rstan (the product does not need it), builds the benchmark and runs both: tests/bench/sampler.sh BUILD_FOLDER.
# BUILD_FOLDER is a configured build of this tree.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: sampler.sh BUILD_FOLDER}
source "$root/tests/bench/peers.sh"
install_peers r-cran-rstan r-cran-bh r-cran-rcppeigen  # the last two: what rstan compiles a model with
cmake --build "$build" --target demcal_uq
march=$(grep -o -m 1 -- '-march=[^ "]*' "$build/compile_commands.json")  # as the library was compiled
g++ -std=c++20 -O2 "$march" -I "$root" $(pkg-config --cflags eigen3) "$root/tests/bench/sampler.cpp" \
  "$build/uq/libdemcal_uq.a" "$build/surrogate/libdemcal_surrogate.a" "$build/data/libdemcal_data.a" \
  $(pkg-config --libs gsl nlopt hdf5 netcdf libxxhash fmt) -ludunits2 -ltomlplusplus -o "$build/bench_sampler"
"$build/bench_sampler"
Rscript "$root/tests/bench/sampler.R"
