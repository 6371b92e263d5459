#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, and runs every test: formatting; the readers of other people's
# files under AddressSanitizer and UBSan; then everything in the release build.
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages scripts/packages.txt scripts/packages-test.txt

say "Format"
git ls-files '*.cpp' '*.h' | xargs clang-format-14 --dry-run --Werror

build release

# What reads other people's files; the tests feed it damaged ones.
sanitized='tests_measurement_formats tests_measurement_reflectance tests_fabrication_job tests_fabrication_part tests_fabrication_slicing tests_forward_optics tests_fabrication_projector tests_fabrication_stage tests_fabrication_session'
build sanitize $sanitized
say "Tests (sanitized)"
for program in $sanitized; do "build/sanitize/$program" --gtest_brief=1; done

say "Tests"
ctest --preset release -j 2 --no-tests=error
