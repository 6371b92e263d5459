#!/usr/bin/env bash
# Takes every method to the place where it breaks (tests/stability), and writes docs/where-methods-fail.md and its figure
# anew from what was measured. Takes a minute once everything is built.
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages scripts/packages.txt scripts/packages-test.txt
build release tests_stability
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT
say "Taking methods to their limits"
MEZZOTINT_FAILURES=$rows build/release/tests_stability --gtest_brief=1
node scripts/where-methods-fail.mjs "$rows" docs/where-methods-fail.md docs/images/where-methods-fail.svg
