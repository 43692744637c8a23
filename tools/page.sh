#!/usr/bin/env bash
# The lab's page, from web/src. `page.sh build` writes web/dist, which is kept with the sources so that nobody needs
# Node to build Faba; `page.sh check FOLDER` builds it in FOLDER, and fails when types are wrong or web/dist is another;
# `page.sh unit` runs the unit tests in web/tests.
set -euo pipefail
cd "$(dirname "$0")/../web"
# Tests that run at the same time install the packages once.
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
  install) ;; # what has been done above: also the driver of a browser, for tests and benchmarks
  build) npm run --silent build ;;
  check)
    npm run --silent check
    npm run --silent build -- --outDir "$2" --emptyOutDir --logLevel warn
    diff -rq dist "$2" || { echo "web/dist is not what web/src gives: make page" >&2; exit 1; }
    ;;
  unit) npm run --silent unit ;;
  *) echo "page.sh install | build | check FOLDER | unit" >&2; exit 2 ;;
esac
