#!/usr/bin/python3
"""How fast the field of a solenoid is: ns per point beside the same formula on Boost.Math's and on SciPy's Carlson
integrals, in one call. Prints the table and a verdict on every goal; keeps both in bench/results/.

    bench/coils.py [--program build/bench/bench_coils] [--out bench/results]

Exits 1 when an answer was wrong, not when it was slow.
"""

import argparse
import datetime
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy
from scipy.special import elliprd, elliprf, elliprj

HERE = pathlib.Path(__file__).resolve().parent
RADIUS, HALF, SHEET, MU0 = 0.005, 0.02, 5000.0, 1.25663706127e-6


def solenoid(rho, z):
    """The same formula, vectorised over the points."""
    g = (RADIUS - rho) / (RADIUS + rho)
    b_rho = b_z = 0
    for side in (1, -1):
        zeta = z + side * HALF
        x = zeta**2 + (RADIUS + rho)**2
        kc2 = (zeta**2 + (RADIUS - rho)**2) / x
        rf = elliprf(0, kc2, 1)
        b_rho = b_rho + side * RADIUS / np.sqrt(x) * (rf - 2 / 3 * elliprd(0, kc2, 1))
        b_z = b_z + side * zeta / np.sqrt(x) * (rf + (g - g * g) / 3 * elliprj(0, kc2, 1, g * g))
    scale = MU0 * SHEET / np.pi
    return scale * b_rho, scale * RADIUS / (RADIUS + rho) * b_z


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/bench/bench_coils")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results")
    o = p.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        raw = pathlib.Path(folder) / "points"
        done = subprocess.run([str(o.program), str(raw)], capture_output=True, text=True)
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        if len(rows) != 3:
            sys.exit(f"coils.py: {o.program} failed:\n{done.stderr}")
        rho, z, b_rho, b_z = np.fromfile(raw).reshape(4, -1)
    times = []
    for _ in range(7):
        start = time.perf_counter()
        s_rho, s_z = solenoid(rho, z)
        times.append((time.perf_counter() - start) / rho.size * 1e9)
    error = float(np.max(np.hypot(s_rho - b_rho, s_z - b_z) / np.hypot(s_rho, s_z)))
    rows.append({"kind": "scipy", "threads": 1, "points": int(rho.size), "ns": float(np.median(times)),
                 "worst_error": error})
    one, two, boost, sci = (r["ns"] for r in rows)
    goals = [("at least 50x Boost.Math per thread", boost / one, 50), ("at least 100x SciPy per thread", sci / one, 100),
             ("2 threads at least 1.8x one", one / two, 1.8)]
    text = (f"# Speed of coil fields\n\n{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d %H:%M} UTC. One solenoid, "
            f"1e5 points, double accuracy; {rows[0]['vectors']}, SciPy {scipy.__version__}. Made by `make bench`.\n\n"
            "| program | threads | ns per point | million points/s | largest difference from ours |\n|---|---|---|---|---|\n")
    for r in rows:
        off = r["worst_error"] if r["kind"] == "scipy" else rows[0]["worst_error"] if r["kind"] == "boost" else 0
        text += f"| {r['kind']} | {r['threads']} | {r['ns']:.4g} | {1e3 / r['ns']:.4g} | {off:.2g} |\n"
    text += "\n| goal | measured | |\n|---|---|---|\n"
    for what, value, least in goals:
        text += f"| {what} | {value:.3g}x | {'met' if value >= least else 'NOT MET'} |\n"
    print(text)
    o.out.mkdir(exist_ok=True)
    (o.out / "coils.md").write_text(text)
    (o.out / "coils.json").write_text(json.dumps(rows, indent=1) + "\n")
    return 0 if done.returncode == 0 and error < 1e-11 else 1


if __name__ == "__main__":
    sys.exit(main())
