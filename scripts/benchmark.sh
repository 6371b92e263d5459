#!/usr/bin/env bash
# Measures the tracer against Embree and prints the figures; --json FILE keeps them. Takes some
# five minutes; leave the machine alone meanwhile.
source "$(dirname "$0")/setup.sh"
install_packages scripts/packages.txt
cmake --preset release -DMEZZOTINT_BENCHMARKS=ON >/dev/null
build release mezzotint_benchmark
exec build/release/mezzotint_benchmark "$@"
