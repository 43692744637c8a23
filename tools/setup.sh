#!/usr/bin/env bash
# Installs what building Faba needs on Debian 12 and says what it does. With a word (test, bench, lint, ...) also what
# that needs. Does nothing, in a few milliseconds, when all is there.
set -euo pipefail

packages=(g++ cmake ninja-build ccache pkg-config libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev
  libeigen3-dev libnlopt-cxx-dev libnanoflann-dev zlib1g-dev libhdf5-dev libopencv-core-dev libopencv-imgproc-dev libopencv-video-dev libopencv-videoio-dev
  liblemon-dev libavformat-dev libavcodec-dev libavutil-dev libswscale-dev libtiff-dev libboost-dev)
for what in "$@"; do
  case $what in
    test)
      packages+=(doctest-dev python3 python3-numpy python3-h5py chromium)
      # Node may have come from elsewhere than Debian.
      command -v node > /dev/null || packages+=(nodejs)
      command -v npm > /dev/null || packages+=(npm)
      ;;
    bench) packages+=(python3 python3-numpy python3-scipy octave libboost-math-dev) ;;
    lint) packages+=(clang-format clang-tidy) ;;
    docs) packages+=(python3 ffmpeg) ;;
    fuzz) packages+=(clang libclang-rt-14-dev) ;;
    *) echo "setup.sh: nothing is known of \"$what\"" >&2; exit 2 ;;
  esac
done

missing=()
installed=$(dpkg-query -W -f '${Package} ${Status}\n' 2>/dev/null | awk '$4 == "installed" { print $1 }')
for p in "${packages[@]}"; do
  grep -qxF "$p" <<< "$installed" || missing+=("$p")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || { echo "setup.sh: as root, run: apt-get install ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
command -v apt-get > /dev/null || { echo "setup.sh: needs Debian's apt; please install: ${missing[*]}" >&2; exit 1; }
echo "Installing with apt: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y \
  --no-install-recommends "${missing[@]}"; } > "$log" 2>&1; then
  tail -20 "$log" >&2
  echo "setup.sh: apt could not install the packages above" >&2
  exit 1
fi
