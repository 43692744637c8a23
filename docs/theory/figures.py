#!/usr/bin/python3
"""Prints the numbers in the theory pages that follow from formulas, with the labels of their sections. Needs NumPy. The
output is deterministic.

    python3 docs/theory/figures.py
"""

import numpy as np

BOLTZMANN = 1.380649e-23  # J/K
KT = BOLTZMANN * 298.15
WATER = 0.89e-3  # Pa s at 25 C


def integral(y, x):
    return float(np.sum((y[1:] + y[:-1]) / 2 * np.diff(x)))


def running_integral(y, x):
    return np.concatenate([[0], np.cumsum((y[1:] + y[:-1]) / 2 * np.diff(x))])


def calibration():
    print("\nA20  ruler lines: width in um, two readings in px")
    width = np.array([30, 50, 70, 100, 200.0])
    read = np.array([[41.42, 40.31], [63.25, 64.19], [87.52, 90.10], [121.44, 122.40], [228.55, 225.66]])
    ratio = width / read.mean(axis=1)
    print(f"     width / reading: {np.round(ratio, 4)}, mean {ratio.mean():.4f}, s.d. {ratio.std(ddof=1):.4f} um/px")
    x, y = np.repeat(width, 2), read.ravel()
    design = np.stack([np.ones_like(x), x], axis=1)
    (a, b), rest = np.linalg.lstsq(design, y, rcond=None)[:2]
    cov = rest[0] / (len(x) - 2) * np.linalg.inv(design.T @ design)
    t = 2.306  # 97.5 % point of Student's t, 8 degrees of freedom
    sa, sb = t * np.sqrt(np.diag(cov))
    print(f"     reading = {a:.2f} +- {sa:.1f} px + width * {b:.4f} px/um (95 %)")
    print(f"     slope: {1 / b:.4f} um/px, 95 % [{1 / (b + sb):.3f}, {1 / (b - sb):.3f}]")


def slowing():
    print(f"\nA16  0.078 / 14.89 = {0.078 / 14.89:.5f} per s; speed left after 700 s: {1 / (1 + 0.00524 * 700):.3f}")


def cells():
    print("\nB2   cell         f_r (N m s)  D_r (1/s)  D_t (um^2/s)  m/f_r (rad/(s T))")
    presets = {"IT-1": (1e-15, 0.7e-6, 1, 186), "MSR-1": (2e-16, 1.5e-6, 3.6, 45), "MC-1": (2e-15, 0.75e-6, 1, 300)}
    for name, (m, r, factor, _) in presets.items():
        f_r = factor * 8 * np.pi * WATER * r**3
        f_t = 6 * np.pi * WATER * r
        print(f"     {name:<12} {f_r:.3e}    {KT / f_r:.4f}     {KT / f_t * 1e12:.3f}         {m / f_r:.4g}")
    print("     cell   B          kappa    w_B (1/s)  <cos>   U-turn width (um)  locked up to (Hz)")
    for name, (m, r, factor, speed) in presets.items():
        w_per_t = m / (factor * 8 * np.pi * WATER * r**3)
        for b in (23e-6, 1e-4, 1e-3):
            kappa, w = m * b / KT, w_per_t * b
            print(f"     {name:<6} {b * 1e6:6.0f} uT {kappa:8.3g} {w:10.3g} {alignment(kappa):8.3f} "
                  f"{np.pi * speed / w:14.3g} {w / 2 / np.pi:16.3g}")
    p = 5e-6 / 0.5e-6  # rod of 5 um x 0.5 um [S66]
    f_rod = np.pi * WATER * (5e-6) ** 3 / (3 * (np.log(p) - 0.662 + 0.917 / p - 0.05 / p**2))
    print(f"     rod of 5 um x 0.5 um with the moment of MSR-1: {1e-3 * 2e-16 / f_rod:.2f} rad/(mT s)")
    two_kappa = 2 * 2e-16 * 2e-3 / KT
    print(f"     mean rate of MSR-1 over a U-turn in 2 mT: {np.pi / np.log(two_kappa):.2f} w_B; w_B if 0.74 rad/(mT s) is that mean: "
          f"{0.74 * np.log(two_kappa) / np.pi:.2f} rad/(mT s)")
    print(f"     Reynolds number at 186 um/s, 1.4 um: {1000 * 186e-6 * 1.4e-6 / WATER:.1e}")


def alignment(kappa):
    t = np.linspace(0, np.pi, 100001)
    w = np.exp(kappa * (np.cos(t) - 1))
    return integral(np.cos(t) * w, t) / integral(w, t)


def first_passage(kappa):
    # w_B T = kappa int_tf^pi dy e^U(y) int_y^pi dz e^-U(z), U = -kappa cos
    y = np.linspace(0, np.pi, 400001)
    u = -kappa * np.cos(y)
    inner = running_integral(np.exp(-u - kappa)[::-1], y)[::-1]
    late = y >= 1 / np.sqrt(kappa)
    return kappa * integral((np.exp(u + kappa) * inner)[late], y[late])


def rotation(kappa, omega):
    # Drift of a Brownian particle in a tilted cosine potential (Stratonovich), D_r = 1; x = angle behind the field.
    x = np.linspace(0, 2 * np.pi, 200001)
    v = -kappa * np.cos(x) - omega * x
    tail = running_integral(np.exp(v - v.max())[::-1], -x[::-1])[::-1]  # int_x^2pi, small values kept exact
    # int_x^{x+2pi} e^V = tail(x) + e^{-2 pi omega} (tail(0) - tail(x))
    window = tail + np.exp(-2 * np.pi * omega) * (tail[0] - tail)
    slip = 2 * np.pi * (1 - np.exp(-2 * np.pi * omega)) / integral(np.exp(v.max() - v) * window, x)
    return omega - slip


def oracles():
    print("\nB3.1 <cos>: " + ", ".join(f"kappa {k}: {alignment(k):.6f}" for k in (1, 5, 10, 20, 100)))
    print("B3.3 w_B T of a U-turn: " + ", ".join(f"kappa {k}: {first_passage(k):.4f}" for k in (5, 20, 100)))
    print("B3.4 <r^2>, v = D_r = 1: " + ", ".join(f"t {t}: {2 * (t - 1 + np.exp(-t)):.6f}" for t in (0.1, 1, 5)))
    print("B3.6 mean rotation, kappa 10, D_r = 1: " +
          ", ".join(f"Omega {o}: {rotation(10, o):.5f}" for o in (5, 9, 12, 20)))


def oxygen():
    d = {t: 10 ** (-4.410 + 773.8 / (t + 273.15) - (506.4 / (t + 273.15)) ** 2) * 1e-4 for t in (20, 25, 30)}
    print("\nB5   oxygen in water: " + ", ".join(f"{t} C {v:.2e} m^2/s" for t, v in d.items()))
    # 1/2 = 1 - 2 sum exp(-l_n^2 s) / (l_n J1(l_n)) at the centre; first three zeros of J0 and J1 there
    zeros, j1 = np.array([2.404826, 5.520078, 8.653728]), np.array([0.519147, -0.340265, 0.271452])
    s = np.linspace(0.05, 0.5, 100001)
    centre = 1 - 2 * np.sum(np.exp(-np.outer(s, zeros**2)) / (zeros * j1), axis=1)
    half = s[np.argmax(centre >= 0.5)]
    print(f"     centre of a disc half saturated at t = {half:.4f} R^2/D: " +
          ", ".join(f"R {r} mm {half * (r * 1e-3) ** 2 / 2e-9:.0f} s" for r in (0.5, 1, 2)))


def integrators():
    print("\nD1   error of 1 - <cos> at kappa = 200, per scheme (columns: w_B dt)")
    kappa, h = 200.0, 0.001
    grid = np.arange(-0.7, 0.7 + h / 2, h)
    exact = 1 - alignment(kappa)
    g = np.linspace(-6, 6, 241)
    weight = np.exp(-g * g / 2)
    weight /= weight.sum()

    def drift(t, wdt):  # exact solution of d theta = -sin theta d(w t)
        return 2 * np.arctan2(np.sin(t / 2) * np.exp(-wdt / 2), np.cos(t / 2) * np.exp(wdt / 2))

    def euler(t, n, wdt, s):
        return t - wdt * np.sin(t) + s * n

    def heun(t, n, wdt, s):
        return t - wdt / 2 * (np.sin(t) + np.sin(euler(t, n, wdt, s))) + s * n

    def exact_ou(t, n, wdt, s):
        t1 = drift(t, wdt)
        a = 2 * wdt * np.cos(t1)
        return t1 + s * np.sqrt(np.minimum(-np.expm1(-a) / a, 20)) * n

    def mean_after_many(step, wdt):
        s = np.sqrt(2 * wdt / kappa)  # sqrt(2 D_r dt)
        to = (step(grid[:, None], g[None, :], wdt, s) - grid[0]) / h
        low = np.clip(to.astype(int), 0, len(grid) - 2)
        part = np.clip(to - low, 0, 1)
        mass = np.exp(kappa * np.cos(grid))
        mass /= mass.sum()
        for _ in range(max(30, int(6 / wdt))):
            m = mass[:, None] * weight
            mass = (np.bincount(low.ravel(), (m * (1 - part)).ravel(), len(grid)) +
                    np.bincount(low.ravel() + 1, (m * part).ravel(), len(grid)))
        return float(np.sum(mass * (1 - np.cos(grid))))

    for name, step in (("Euler-Maruyama", euler), ("Heun", heun), ("exact drift + OU noise", exact_ou)):
        row = []
        for wdt in (0.1, 0.5, 1.0, 3.0):
            stable = step is exact_ou or wdt < 2
            row.append(f"{mean_after_many(step, wdt) / exact - 1:+8.1%}" if stable else "unstable")
        print(f"     {name:<24}" + " ".join(f"{c:>9}" for c in row))


calibration()
slowing()
cells()
oracles()
oxygen()
integrators()
