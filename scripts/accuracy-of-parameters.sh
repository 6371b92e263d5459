#!/usr/bin/env bash
# Compares parameters of defined and of random surfaces with their closed forms (tests/measurement/texture), and writes
# docs/accuracy-of-parameters.md anew from what was found. Takes seconds once everything is built.
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages scripts/packages.txt scripts/packages-test.txt
build release tests_measurement_texture
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT
say "Comparing parameters with closed forms"
for suite in DefinedWaves DefinedBodies DefinedProfiles RandomSurfaces; do  # in the order of the page
  MEZZOTINT_ACCURACY=$rows build/release/tests_measurement_texture --gtest_brief=1 --gtest_filter="$suite.*"
done
node scripts/accuracy-of-parameters.mjs "$rows" docs/accuracy-of-parameters.md
