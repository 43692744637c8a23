#!/usr/bin/env bash
# Builds the fuzzers (clang, with address and undefined-behaviour sanitizers) and runs each for N seconds (60): scenario
# files, messages of the lab's page, and the serial line of a coil board. Findings are written to build/fuzz/; add them to
# the corpus in this folder after the fix.
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --preset fuzz --log-level=WARNING > /dev/null
cmake --build build/fuzz --target scenario_fuzz page_message_fuzz coil_line_fuzz
run() {  # target, seconds, seeds
  mkdir -p "build/fuzz/$1-corpus"
  cp -n "${@:3}" "build/fuzz/$1-corpus/"
  "build/fuzz/tests/$1" -max_total_time="$2" -max_len=4096 -timeout=5 -artifact_prefix="build/fuzz/$1-" \
    -print_final_stats=1 "build/fuzz/$1-corpus" 2>&1 | tail -15
}
run scenario_fuzz "${1:-60}" scenes/*.toml tests/fuzz/corpus/*
run page_message_fuzz "${1:-60}" tests/fuzz/page_corpus/*
run coil_line_fuzz "${1:-60}" tests/fuzz/coil_corpus/*
