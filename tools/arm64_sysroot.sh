#!/usr/bin/env bash
# Unpacks the arm64 packages that the program is built with and runs with into a folder, for --sysroot of the cross
# compiler and -L of qemu-aarch64. Usage: tools/arm64_sysroot.sh FOLDER [PACKAGE ...]. Nothing is installed on this
# machine: apt-get gets a state of its own in FOLDER.apt and downloads from the mirrors that this machine is configured
# with. Does nothing if FOLDER already has the packages. Exit code 77: the packages cannot be downloaded.
set -euo pipefail

sysroot=${1:?usage: tools/arm64_sysroot.sh FOLDER [PACKAGE ...]}
shift
# What tools/setup.sh installs for a build and for the tests, and an interpreter for the Python module.
mapfile -t libraries < <("$(dirname "$0")/setup.sh" --print python | grep -- '-dev$')
packages=(libc6-dev libstdc++-12-dev doctest-dev python3-numpy "${libraries[@]}" "$@")
wanted="${packages[*]}"
[ "$(cat "$sysroot/.packages" 2> /dev/null)" = "$wanted" ] && exit 0

mkdir -p "$sysroot.apt"/{state/lists/partial,cache/archives/partial}
apt=$(cd "$sysroot.apt" && pwd)
: > "$apt/status"  # no package is installed: apt-get downloads all dependencies
options=(-o "Dir::State=$apt/state" -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt/cache" -o APT::Architecture=arm64
  -o APT::Architectures=arm64 -o APT::Sandbox::User=root -o Binary::apt-get::APT::Keep-Downloaded-Packages=true
  -o APT::Install-Recommends=false -o Debug::NoLocking=true)
if ! { apt-get "${options[@]}" update && apt-get "${options[@]}" install -y --download-only "${packages[@]}"; } > "$apt/log" 2>&1; then
  grep -E '^[EW]:' "$apt/log" | tail -5 >&2 || tail -5 "$apt/log" >&2
  echo "arm64_sysroot.sh: the arm64 packages cannot be downloaded (log: $apt/log)" >&2
  exit 77
fi

rm -rf "$sysroot"
# The merged /usr of Debian: some packages still contain /lib.
mkdir -p "$sysroot/usr/lib"
ln -s usr/lib "$sysroot/lib"
for file in "$apt"/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$file" | tar -x -C "$sysroot" --keep-directory-symlink --no-same-owner \
    --exclude=./usr/share/doc --exclude=./usr/share/locale --exclude=./usr/share/man
done
# No maintainer script ran: these links are made by update-alternatives.
folder=$sysroot/usr/lib/aarch64-linux-gnu
for name in blas lapack; do
  ln -sf "$name/lib$name.so.3" "$folder/lib$name.so.3"
done
# Absolute links in the packages would point to files of this machine.
find "$sysroot" -type l -lname '/*' -printf '%p\t%l\n' | while IFS=$'\t' read -r link target; do
  ln -sfn "$(realpath -m --relative-to="$(dirname "$link")" "$sysroot$target")" "$link"
done
echo "$wanted" > "$sysroot/.packages"
echo "arm64_sysroot.sh: $(ls "$apt"/cache/archives/*.deb | wc -l) packages in $sysroot"
