#!/usr/bin/env bash
# Runs an arm64 program, and all arm64 programs that it starts, with qemu-aarch64 and the libraries of a folder.
# Usage: tools/emulate_arm64.sh SYSROOT PROGRAM [ARGUMENT ...]. If the kernel of this machine does not start arm64
# programs yet (binfmt_misc), it does so in namespaces of their own (Linux 6.7 or newer), so that nothing else on the
# machine changes. Exit code 77: neither is possible.
set -euo pipefail

QEMU_LD_PREFIX=$(realpath "${1:?usage: tools/emulate_arm64.sh SYSROOT PROGRAM [ARGUMENT ...]}")
export QEMU_LD_PREFIX
shift

# The dynamic loader is a program that needs no libraries.
starts() { "$QEMU_LD_PREFIX/lib/ld-linux-aarch64.so.1" --version > /dev/null 2>&1; }

if [ "${FABA_EMULATE_IN_NAMESPACE:-}" = 1 ]; then
  unset FABA_EMULATE_IN_NAMESPACE
  register=/proc/sys/fs/binfmt_misc/register
  { mount -t binfmt_misc none /proc/sys/fs/binfmt_misc &&
    # Magic number and mask of 64-bit little-endian ELF programs of machine 0xb7, as in Debian's qemu-user-static.
    printf '%s' ':faba-arm64:M::\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00:\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff:'"$(command -v qemu-aarch64)"':F' > $register; } 2> /dev/null || true
  if ! starts; then
    echo "SKIPPED: this kernel has no binfmt_misc in user namespaces (Linux 6.7 or newer), and arm64 programs are not registered (package qemu-user-static)" >&2
    exit 77
  fi
  exec "$@"
fi

starts && exec "$@"
if ! unshare --user --map-root-user --mount true 2> /dev/null; then
  echo "SKIPPED: user namespaces are not permitted, and arm64 programs are not registered (package qemu-user-static)" >&2
  exit 77
fi
FABA_EMULATE_IN_NAMESPACE=1 exec unshare --user --map-root-user --mount "$0" "$QEMU_LD_PREFIX" "$@"
