#!/usr/bin/python3
"""Runs a command in namespaces in which the kernel starts arm64 programs by qemu-user; nothing else on the machine changes.

    tests/packaging/arm64_namespace.py COMMAND [ARGUMENT ...]

All users are mapped to themselves, so that the command can use chroot and the owners of a root file system. Needs root, Linux 6.7 or newer and the
package qemu-user-static. Exit code 77: that is not possible here.
"""

import ctypes
import os
import pathlib
import shutil
import sys

NEW_MOUNTS, NEW_USERS, NEW_PROCESSES = 0x00020000, 0x10000000, 0x20000000  # CLONE_NEWNS, CLONE_NEWUSER, CLONE_NEWPID
PRIVATE = 0x4000 | 0x40000  # MS_REC | MS_PRIVATE
REGISTER = pathlib.Path("/proc/sys/fs/binfmt_misc/register")
# Magic number and mask of 64-bit little-endian ELF programs of machine 0xb7, as in Debian's qemu-user-static. F: the interpreter is opened now.
MAGIC = rb"\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00"
MASK = rb"\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff"

libc = ctypes.CDLL(None, use_errno=True)


def skip(reason):
    print(f"SKIPPED: {reason}", file=sys.stderr)
    sys.exit(77)


def checked(result, what):
    if result:
        skip(f"{what}: {os.strerror(ctypes.get_errno())}")


def mount(kind, target, flags=0):
    return libc.mount(kind, str(target).encode(), kind, flags, None)


def enter(interpreter):
    """In the child, after its users are mapped: mounts, the registration, and a process that has the new process numbers."""
    os.setgid(0)
    os.setuid(0)
    checked(libc.mount(None, b"/", None, PRIVATE, None), "mounts cannot be made private")
    checked(mount(b"binfmt_misc", REGISTER.parent), "binfmt_misc cannot be mounted in a user namespace (Linux 6.7 or newer)")
    try:
        REGISTER.write_bytes(b":faba-arm64:M::" + MAGIC + b":" + MASK + b":" + interpreter.encode() + b":F")
    except OSError as error:
        skip(f"arm64 programs cannot be registered: {error}")


def child(ready, go, interpreter, command):
    checked(libc.unshare(NEW_USERS | NEW_MOUNTS | NEW_PROCESSES), "user namespaces are not permitted")
    os.write(ready, b"x")
    os.read(go, 1)
    enter(interpreter)
    inner = os.fork()  # the first process of the new namespace; when it ends, all others are killed
    if inner == 0:
        os.execvp(command[0], command)
    status = os.waitpid(inner, 0)[1]
    os._exit(os.waitstatus_to_exitcode(status) % 256)


def main():
    command = sys.argv[1:]
    if not command:
        sys.exit(__doc__)
    if os.geteuid() != 0:
        skip("namespaces with all users need root")
    interpreter = shutil.which("qemu-aarch64-static")
    if not interpreter:
        skip("qemu-aarch64-static not found; install the package qemu-user-static")
    ready_out, ready = os.pipe()
    go, go_in = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(ready_out)
        os.close(go_in)
        child(ready, go, interpreter, command)
    os.close(ready)
    os.close(go)
    if os.read(ready_out, 1):  # empty if the child ended
        for kind in ("uid", "gid"):
            pathlib.Path(f"/proc/{pid}/{kind}_map").write_text("0 0 65536\n")
        os.write(go_in, b"x")
    sys.exit(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))


if __name__ == "__main__":
    main()
