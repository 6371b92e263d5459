#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, runs the quick-start experiment, and says where its report lies.
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages scripts/packages.txt
build release mezzotint

say "Running experiments/quickstart.toml"
build/release/mezzotint run experiments/quickstart.toml --out runs/quickstart
say "Open $(pwd)/runs/quickstart/report.html in a browser"
