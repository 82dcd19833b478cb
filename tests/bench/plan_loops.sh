#!/bin/bash
# Builds and runs plan_loops.cpp: tests/bench/plan_loops.sh BUILD_FOLDER [LOOPS] [FIRST SEED] [REDONE] [STUDY]. BUILD_FOLDER is a configured
# build of this tree.
set -eu
build=${1:?usage: plan_loops.sh BUILD_FOLDER [LOOPS] [FIRST SEED] [REDONE] [STUDY]}
cmake --build "$build" --target bench_plan_loops
"$build/tests/bench/bench_plan_loops" "${@:2}"
