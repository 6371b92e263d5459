#!/usr/bin/env bash
# Measures the tracer against Embree and prints the figures; --json FILE keeps them. Takes some
# five minutes; leave the machine alone meanwhile. Where libgwyddion20-dev and libglib2.0-dev are
# installed, measurement is raced against Gwyddion first, which takes three minutes more.
source "$(dirname "$0")/setup.sh"
install_packages scripts/packages.txt
cmake --preset release -DMEZZOTINT_BENCHMARKS=ON >/dev/null
build release mezzotint_benchmark
if grep -q '^build measurement_race:' build/release/build.ninja; then
  build release measurement_race
  build/release/measurement_race
fi
exec build/release/mezzotint_benchmark "$@"
