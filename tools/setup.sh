#!/usr/bin/env bash
# Installs the packages for building Faba on Debian 12, and those for the purposes given as arguments (test, bench, lint,
# docs, fuzz, engines, python, torch, arm64, portability, demo, package). Prints the packages that it installs; does nothing if all of them are installed.
# With --print as the first argument it only prints the names of the packages, one per line.
set -euo pipefail

print=
if [ "${1:-}" = --print ]; then
  print=1
  shift
fi

packages=(g++ cmake ninja-build ccache pkg-config libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev
  libeigen3-dev libnlopt-cxx-dev libnanoflann-dev zlib1g-dev libssl-dev libhdf5-dev libdeflate-dev libopencv-core-dev libopencv-imgproc-dev libopencv-video-dev libopencv-videoio-dev
  liblemon-dev libavformat-dev libavcodec-dev libavutil-dev libswscale-dev libtiff-dev libboost-dev)
for what in "$@"; do
  case $what in
    demo) packages+=(emscripten) ;;&  # and those of the next case
    test | demo)
      packages+=(doctest-dev python3 python3-numpy python3-h5py python3-xarray python3-h5netcdf python3-tifffile chromium)
      # Node may be installed without a Debian package.
      command -v node > /dev/null || packages+=(nodejs)
      command -v npm > /dev/null || packages+=(npm)
      ;;
    python)
      packages+=(python3 python3-dev pybind11-dev python3-numpy mypy python3-matplotlib python3-h5py python3-xarray python3-h5netcdf python3-pandas
        python3-tifffile python3-cloudpickle python3-typing-extensions python3-nbclient python3-nbconvert python3-ipykernel)
      ;;
    bench) packages+=(python3 python3-numpy python3-scipy python3-h5py octave libboost-math-dev ffmpeg hdf5-tools) ;;
    lint) packages+=(clang-format clang-tidy) ;;
    docs) packages+=(python3 ffmpeg) ;;
    fuzz) packages+=(clang libclang-rt-14-dev) ;;
    engines) packages+=(python3 slurmctld slurmd slurm-client munge parallel python3-distributed) ;;
    package) packages+=(dpkg-dev debhelper dh-python python3-all lintian pandoc bash-completion man-db debootstrap desktop-file-utils appstream) ;;
    torch) packages+=(python3-torch) ;;
    arm64) packages+=(doctest-dev python3 g++-aarch64-linux-gnu qemu-user qemu-user-static) ;;
    portability) packages+=(doctest-dev python3 clang-16) ;;
    *) echo "setup.sh: \"$what\" is not one of test, bench, lint, docs, fuzz, engines, python, torch, arm64, portability, demo, package" >&2; exit 2 ;;
  esac
done

if [ -n "$print" ]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

missing=()
installed=$(dpkg-query -W -f '${Package} ${Status}\n' 2>/dev/null | awk '$4 == "installed" { print $1 }')
for p in "${packages[@]}"; do
  grep -qxF "$p" <<< "$installed" || missing+=("$p")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || { echo "setup.sh: sudo not found; run as root: apt-get install ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
command -v apt-get > /dev/null || { echo "setup.sh: apt-get not found; install these packages: ${missing[*]}" >&2; exit 1; }
echo "Installing with apt: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y \
  --no-install-recommends "${missing[@]}"; } > "$log" 2>&1; then
  tail -20 "$log" >&2
  echo "setup.sh: apt-get failed to install the packages above" >&2
  exit 1
fi
