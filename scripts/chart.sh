#!/usr/bin/env bash
# Measures error against time anew and puts the figures into docs/images. Takes some three minutes; leave the machine
# alone meanwhile.
source "$(dirname "$0")/setup.sh"
install_packages scripts/packages.txt
build release mezzotint
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build/release/mezzotint chart -o "$out"
cp "$out"/chart_*.svg docs/images/
