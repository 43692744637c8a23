#!/usr/bin/env bash
# Builds the packages a second time, in another folder and without the compiler cache, and compares their bytes with those
# in build/package. Takes as long as the first build.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
again=$(mktemp -d "${TMPDIR:-/tmp}/faba-again-XXXXXX")
trap 'rm -rf "$again"' EXIT
CCACHE_DISABLE=1 "$root/packaging/package.sh" "$again" > /dev/null
different=0
for first in "$root"/build/package/*_"$(dpkg --print-architecture)".deb; do
  if cmp "$first" "$again/$(basename "$first")"; then
    echo "ok $(basename "$first"): both builds have the SHA-256 $(sha256sum < "$first" | cut -c1-16)..."
  else
    different=1
    echo "FAILED $(basename "$first"): the two builds differ"
  fi
done
exit $different
