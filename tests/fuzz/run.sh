#!/usr/bin/env bash
# Builds the scenario fuzzer with clang, address and undefined-behaviour sanitizers, and runs it for N seconds (60).
# A finding is left in build/fuzz/ and belongs, once mended, into tests/fuzz/corpus/.
set -euo pipefail
cd "$(dirname "$0")/../.."
mkdir -p build/fuzz/corpus
objects=()
for source in tests/fuzz/scenario_fuzz.cpp src/core/{error,hash,parallel,philox_row,portable_math,schema,toml,units}.cpp src/field/*.cpp \
  src/sim/*.cpp src/sim/*/*.cpp src/control/*.cpp src/app/{scenario,parts,loop}.cpp; do
  [ -e "$source" ] || continue
  object=build/fuzz/$(echo "$source" | tr / _).o
  objects+=("$object")
  if [ ! -e "$object" ] || [ "$source" -nt "$object" ] || [ -n "$(find src -name '*.h' -newer "$object" -print -quit)" ]; then
    echo "$source $object"
  fi
done | xargs -r -P "$(nproc)" -n 2 bash -c 'clang++ -std=c++20 -O1 -g -fsanitize=fuzzer-no-link,address,undefined \
  -fno-sanitize-recover=undefined -DFABA_ONE_ISA -Isrc -w -c "$0" -o "$1"'
clang++ -fsanitize=fuzzer,address,undefined build/fuzz/*.o -lfmt -lpthread -o build/fuzz/scenario_fuzz
cp -n scenes/*.toml tests/fuzz/corpus/* build/fuzz/corpus/ 2> /dev/null || true
build/fuzz/scenario_fuzz -max_total_time="${1:-60}" -max_len=4096 -timeout=5 -artifact_prefix=build/fuzz/ \
  -print_final_stats=1 build/fuzz/corpus 2>&1 | tail -15
