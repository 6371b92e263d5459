#!/usr/bin/env bash
# Measures error against time anew and puts the figures into docs/images. Takes some ten minutes; leave the machine
# alone meanwhile. The panel of 4096² cells needs 5 GB of memory.
source "$(dirname "$0")/setup.sh"
install_packages scripts/packages.txt
build release mezzotint
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build/release/mezzotint chart -o "$out"
build/release/mezzotint chart -o "$out/large" --subject scattering --families gaussian --gradients 0.3 --incidences 60 --cells 4096
cp "$out"/chart_*.svg docs/images/
cp "$out/large/chart_gaussian.svg" docs/images/chart_large.svg
