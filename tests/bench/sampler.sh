#!/bin/bash
# Installs rstan (the product does not need it), builds the benchmark and runs both: tests/bench/sampler.sh BUILD_FOLDER.
# BUILD_FOLDER is a configured build of this tree.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: sampler.sh BUILD_FOLDER}
source "$root/tests/bench/peers.sh"
install_peers r-cran-rstan r-cran-bh r-cran-rcppeigen  # the last two: what rstan compiles a model with
cmake --build "$build" --target bench_sampler
"$build/tests/bench/bench_sampler"
Rscript "$root/tests/bench/sampler.R"
