#!/usr/bin/env bash
# Builds the page of the live lab from web/src. `page.sh build` writes web/dist, which is committed so that building Faba
# does not need Node; `page.sh check FOLDER` builds into FOLDER and fails if types are wrong or the result differs from
# web/dist; `page.sh unit` runs the unit tests in web/tests; `page.sh install` only installs the npm packages.
set -euo pipefail
cd "$(dirname "$0")/../web"
# The lock lets tests that run in parallel install the packages once.
install_packages() {
  local installed=node_modules/.package-lock.json
  flock 9
  if [ ! -e "$installed" ] || [ package-lock.json -nt "$installed" ]; then
    npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
    touch "$installed"
  fi
}
(install_packages) 9<package-lock.json
case ${1:-} in
  install) ;; # done above; the packages include the browser driver of tests and benchmarks
  build) npm run --silent build ;;
  check)
    npm run --silent check
    npm run --silent build -- --outDir "$2" --emptyOutDir --logLevel warn
    diff -rq dist "$2" || { echo "page.sh: web/dist differs from the build of web/src; run: make page" >&2; exit 1; }
    ;;
  unit) npm run --silent unit ;;
  *) echo "usage: page.sh install | build | check FOLDER | unit" >&2; exit 2 ;;
esac
