#!/usr/bin/python3
"""Fails when a program that links faba_engine alone needs a library of pictures, videos or data files at run time."""

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
print("needs", ", ".join(sorted(names)))
if "fmt" not in names:
    sys.exit("the list of libraries was not understood: fmt is missing from it")
if found:
    sys.exit(f"faba_engine must not need {', '.join(found)}")
