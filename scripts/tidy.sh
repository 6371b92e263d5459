#!/usr/bin/env bash
# clang-tidy on the sources that have changed since BASE (default: the last commit's parent).
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages scripts/packages.txt scripts/packages-test.txt
build release
changed=$(git diff --name-only --diff-filter=d "${BASE:-HEAD~1}" -- '*.cpp' ':!tests')
[ -n "$changed" ] || { say "No source has changed"; exit 0; }
say "clang-tidy"
printf '%s\n' "$changed" | xargs -P 2 -n 4 clang-tidy-14 --quiet -p build/release
