#!/usr/bin/env bash
# Builds the Debian packages of Faba in a clean copy of the source: build/package/*.deb, with the bits of `make run`.
#   packaging/package.sh [OUT]      OUT: folder of the packages; default: build/package
# With FABA_ARCH=arm64 it cross-builds those for arm64, after those of this machine.
# The time in all files is that of the commit, so that a second call can give the same bytes (tests/packaging/same_bytes.sh).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/package}
mkdir -p "$out"
out=$(cd "$out" && pwd)

version=$(sed -n 's/^project(faba VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
  SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct 2> /dev/null || stat -c %Y "$root/CHANGELOG.md")
fi
export SOURCE_DATE_EPOCH

# The path of the source does not matter for the bytes, but every call has the same one below `out`.
source=$out/faba-$version
rm -rf "$source"
mkdir -p "$source"
if git -C "$root" rev-parse --is-inside-work-tree > /dev/null 2>&1; then
  git -C "$root" ls-files -z --cached --others --exclude-standard | (cd "$root" && tar --null --files-from=- --ignore-failed-read -cf - 2> /dev/null) | tar -C "$source" -xf -
else
  tar -C "$root" --exclude=./build --exclude=./runs --exclude=./web/node_modules -cf - . | tar -C "$source" -xf -
fi

cp -r "$source/packaging/debian" "$source/debian"
sed -e "s/@VERSION@/$version/" -e "s/@DATE@/$(date -R -u -d "@$SOURCE_DATE_EPOCH")/" "$source/packaging/debian/changelog.in" > "$source/debian/changelog"
rm "$source/debian/changelog.in"

if [ "${FABA_ARCH:-}" = arm64 ]; then
  sysroot=$root/build/arm64/sysroot
  "$root/tools/arm64_sysroot.sh" "$sysroot"
  # The libraries are not installed on this machine. Debian's packages have the same names for all processors.
  export FABA_NATIVE_PACKAGES=$out
  export FABA_CMAKE="-DCMAKE_TOOLCHAIN_FILE=$source/cmake/arm64.cmake -DFABA_SYSROOT=$sysroot"
fi

log=$out/build${FABA_ARCH:+-$FABA_ARCH}.log
echo "Building packages of Faba $version in $out; messages are in $log"
if ! (cd "$source" && dpkg-buildpackage --build=binary --no-sign --no-check-builddeps ${FABA_ARCH:+--host-arch=$FABA_ARCH}) > "$log" 2>&1; then
  tail -30 "$log" >&2
  echo "package.sh: dpkg-buildpackage failed; the messages above are from $log" >&2
  exit 1
fi
rm -rf "$source"
ls -l "$out"/*.deb
