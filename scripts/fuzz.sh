#!/bin/sh
# Fuzzes the readers of surfaces and of measured BRDFs with libFuzzer under ASan and UBSan, one after the other.
#
#   scripts/fuzz.sh [SECONDS [READER…]]     default: 120 seconds for every reader
#
# Needs clang-14 and libclang-rt-14-dev. Starts from the corpus of the repository; what it finds on the way stays in
# build/fuzz/corpus, a finding in build/fuzz/findings. Put a minimised finding into the corpus of tests/measurement/formats
# or tests/measurement/reflectance, where a test replays it.
set -eu
cd "$(dirname "$0")/.."

seconds=${1:-120}
[ $# -gt 0 ] && shift
readers=${*:-"al3d gwy x3p x3p_document sur sdf opd png tiff exr csv xyz sidecar quality_map rgl zemax fred cornell alta"}
build=build/fuzz

sanitizers="-fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all -fno-omit-frame-pointer"
cmake -S . -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang-14 -DCMAKE_CXX_COMPILER=clang++-14 \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DCMAKE_CXX_FLAGS="$sanitizers" \
  -DMEZZOTINT_FUZZ=ON -DMEZZOTINT_PROGRAM=OFF -DBUILD_TESTING=OFF ${FUZZ_CMAKE_OPTIONS:-} > /dev/null

targets=""
for reader in $readers; do targets="$targets fuzz_$reader"; done
# shellcheck disable=SC2086
cmake --build "$build" --target $targets

for reader in $readers; do
  mkdir -p "$build/corpus/$reader" "$build/findings"
  echo "== $reader, $seconds s"
  "$build/fuzz_$reader" -max_total_time="$seconds" -max_len=16384 -timeout=10 -rss_limit_mb=2048 \
    -artifact_prefix="$build/findings/$reader-" -print_final_stats=1 \
    "$build/corpus/$reader" tests/measurement/*/corpus/"$reader" 2> "$build/$reader.log" ||
    { tail -40 "$build/$reader.log"; exit 1; }
  grep -E "stat::number_of_executed_units|stat::peak_rss_mb|cov:" "$build/$reader.log" | tail -3
done
