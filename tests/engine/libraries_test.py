#!/usr/bin/python3
"""Fails if a program that links only faba_engine depends on a shared library for pictures, videos or data files."""

import re
import subprocess
import sys

UNWANTED = "opencv avcodec avformat avutil swscale hdf5 tiff z zstd boost".split()


def needed(program):
    """Names of the shared libraries of a program: "libfmt.so.9" as "fmt"."""
    out = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    return {re.sub(r"\.so.*", "", line.split()[0].split("/")[-1]).removeprefix("lib") for line in out.splitlines() if line.strip()}


names = needed(sys.argv[1])
found = sorted(n for n in names if any(n == u or n.startswith(u + "_") for u in UNWANTED))
print("shared libraries:", ", ".join(sorted(names)))
if "fmt" not in names:
    sys.exit("unexpected output of ldd: libfmt is missing")
if found:
    sys.exit(f"faba_engine must not depend on {', '.join(found)}")
