#!/usr/bin/python3
"""Writes the SPDX 2.3 bill of materials of a build: what the program contains, and the libraries that it loads.

    packaging/bill_of_materials.py SOURCE BUILD OUT

Versions of libraries that are compiled in are those of Debian's packages on this machine, those of the page are from web/package-lock.json. The
shared libraries are read from the programs in BUILD. The time is SOURCE_DATE_EPOCH, so that equal builds have equal files.
"""

import argparse
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess

# Libraries of which code is in the programs: Debian's package and the licence of that code.
COMPILED_IN = {"libtomlplusplus-dev": "MIT", "nlohmann-json3-dev": "MIT", "libcli11-dev": "BSD-3-Clause", "libeigen3-dev": "MPL-2.0",
               "libnanoflann-dev": "BSD-2-Clause", "liblemon-dev": "BSL-1.0", "libboost-dev": "BSL-1.0", "libopencv-video-dev": "Apache-2.0",
               "libhdf5-dev": "BSD-3-Clause", "pybind11-dev": "BSD-3-Clause"}
# Packages of the page of which code is in web/dist.
IN_PAGE = {"svelte": "MIT", "uplot": "MIT", "clsx": "MIT", "esm-env": "MIT"}
PROGRAMS = ("faba", "faba-coil-guard", "faba-capture.so")


def debian_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else "NOASSERTION"


def shared_libraries(build):
    """Debian's packages of the libraries that the programs link, without their own dependencies."""
    names = set()
    for program in PROGRAMS:
        if (build / program).exists():
            listed = subprocess.run(["readelf", "-d", build / program], check=True, capture_output=True, text=True).stdout
            names |= set(re.findall(r"NEEDED.*\[(.*)\]", listed))
    packages = set()
    for name in names:
        found = subprocess.run(["dpkg-query", "-S", f"*/{name}"], capture_output=True, text=True).stdout
        owners = {line.split(":")[0] for line in found.splitlines() if "-cross" not in line}
        packages |= owners
    return sorted(packages)


def package(name, version, licence, purpose):
    return {"SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": licence, "licenseDeclared": licence, "copyrightText": "NOASSERTION", "comment": purpose}


def bill(source, build):
    version = re.search(r"project\(faba VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text())[1]
    lock = json.loads((source / "web/package-lock.json").read_text())["packages"]
    main = package("faba", version, "Apache-2.0", "the program, the guard, the camera module and the Python package")
    inside = [package(name, debian_version(name), licence, "compiled in") for name, licence in COMPILED_IN.items()]
    inside += [package(name, lock[f"node_modules/{name}"]["version"], licence, "in the page of the lab") for name, licence in IN_PAGE.items()]
    loaded = [package(name, debian_version(name), "NOASSERTION", "shared library, loaded at run time") for name in shared_libraries(build)]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-faba")]
    relations += [("SPDXRef-faba", "CONTAINS", p["SPDXID"]) for p in inside] + [("SPDXRef-faba", "DYNAMIC_LINK", p["SPDXID"]) for p in loaded]
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    packages = [main, *inside, *loaded]
    digest = hashlib.sha256(json.dumps(packages).encode()).hexdigest()
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"faba-{version}",
            "documentNamespace": f"urn:faba:{version}:{digest[:32]}",
            "creationInfo": {"created": datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
                             "creators": ["Organization: The Faba developers", "Tool: bill_of_materials.py"]},
            "packages": packages,
            "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in relations]}


def main():
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("source", "build", "out"):
        cli.add_argument(name, type=pathlib.Path)
    o = cli.parse_args()
    o.out.write_text(json.dumps(bill(o.source, o.build), indent=1) + "\n")


if __name__ == "__main__":
    main()
