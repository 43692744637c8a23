#!/usr/bin/env bash
# Builds the demonstration into build/demo: a page that runs scenes in the browser, opened from that folder or from any static
# file server. `demo.sh engine` builds only its engine, build/engine-wasm/faba_demo.js. Needs Emscripten and Node
# (tools/setup.sh demo).
set -euo pipefail
cd "$(dirname "$0")/.."
command -v em++ > /dev/null || { echo "demo.sh: em++ not found; run: tools/setup.sh demo" >&2; exit 2; }
# Debian's Emscripten finds its modules with NODE_PATH, and its scripts fail if Node has a function fetch().
export NODE_PATH=/usr/share/nodejs NODE_OPTIONS=--no-experimental-fetch
cmake --preset demo --log-level=WARNING > /dev/null
cmake --build build/engine-wasm -j "${JOBS:-$(nproc)}" --target faba_demo
unset NODE_PATH NODE_OPTIONS
[ "${1:-}" = engine ] && exit
tools/page.sh install
(cd web && npx vite build --config vite.demo.config.ts --outDir ../build/demo --emptyOutDir --logLevel warn)
cp web/public/icon.svg LICENSE build/demo/
# The licences of the libraries in the page. That of Boost requires no copy with compiled code.
for library in libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libeigen3-dev libnanoflann-dev emscripten; do
  printf '\n===== %s =====\n\n' "$library"
  cat "/usr/share/doc/$library/copyright"
done > build/demo/LICENSES.txt
for library in svelte uplot; do
  printf '\n===== %s =====\n\n' "$library"
  cat web/node_modules/$library/LICENSE*
done >> build/demo/LICENSES.txt
echo "build/demo: the page loads $(cat build/demo/{index.html,demo.js,demo.css,icon.svg} | gzip -9 | wc -c | awk '{ printf "%.0f kB", $1 / 1000 }') compressed; open build/demo/index.html"
