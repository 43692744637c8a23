"""The three models in float64 NumPy with array operations, the random generator of NumPy and a uniform field.
`numpy_agents.py SCENE SECONDS AGENTS...` prints a JSON line per case; SCENE is the first line printed by bench_agents. In
pixels, seconds and iterations."""

import json
import math
import sys
import time

import numpy as np


class Swarm:
    """Cells in a box of width x height pixels, one per ten pixels; `exclusion`: at most one per pixel."""

    def __init__(self, scene, model, agents, exclusion):
        self.scene, self.model, self.n, self.exclusion = scene, model, agents, exclusion
        self.random = np.random.default_rng(1)
        self.width, self.height = next((w, h) for n, w, h in scene["sizes"] if n == agents)
        self.step_index = 0
        self.cell = self.random.choice(self.width * self.height, agents, replace=False)
        self.x = (self.cell % self.width).astype(float)
        self.y = (self.cell // self.width).astype(float)
        self.occupied = np.zeros(self.width * self.height, bool)
        self.occupied[self.cell] = True
        self.claim = np.zeros(self.width * self.height, np.int64)
        self.vx, self.vy = np.zeros(agents), np.zeros(agents)
        if model == "adapted":
            self.speed = self.random.integers(0, scene["adapted_noise"] + 1, agents).astype(float)
        if model == "dipole":
            mean, sd, most = scene["speed_px_per_s"]
            speed = self.random.normal(mean, sd, agents)
            while (bad := (speed < 0) | (speed > most)).any():
                speed[bad] = self.random.normal(mean, sd, bad.sum())
            self.speed = speed
            self.set_heading(self.random.uniform(-math.pi, math.pi, agents))

    def set_heading(self, theta):
        self.theta, self.ux, self.uy = theta, np.cos(theta), np.sin(theta)

    def save(self):
        return {k: v.copy() if isinstance(v, np.ndarray) else v for k, v in vars(self).items()}

    def restore(self, saved):
        vars(self).update({k: v.copy() if isinstance(v, np.ndarray) else v for k, v in saved.items()})

    def redraw(self):
        hold, (mx, my) = self.scene["hold"], self.scene["drift"]
        sign = 1 if self.step_index % (2 * hold) < hold else -1
        noise = self.scene[self.model + "_noise"]
        kx = self.random.integers(-noise, noise + 1, self.n)
        ky = self.random.integers(-noise, noise + 1, self.n)
        if self.model == "basic":
            self.vx, self.vy = kx + sign * mx, ky + sign * my
        else:
            bx, by = sign * mx, sign * my  # the Earth's field included
            length = math.hypot(bx, by)
            self.vx, self.vy = kx + self.speed * (bx / length), ky + self.speed * (by / length)

    def swim(self):
        s = self.scene
        dt, w, spread = s["dt_s"], s["w_per_s"], 2 * s["d_r_per_s"] * s["dt_s"]
        half = 0.5 * self.theta  # the field lies along x
        turned = 2 * np.arctan2(np.sin(half) * math.exp(-w * dt / 2), np.cos(half) * math.exp(w * dt / 2))
        a = 2 * w * dt * np.cos(turned)
        small = np.abs(a) < 1e-6
        relaxed = np.where(small, 1.0, -np.expm1(-a) / np.where(small, 1.0, a))
        turn, dx, dy = self.random.standard_normal((3, self.n))
        theta = turned + np.sqrt(spread * np.minimum(relaxed, 20)) * turn
        ux, uy = self.ux, self.uy
        self.set_heading(np.remainder(theta + math.pi, 2 * math.pi) - math.pi)
        sd, reach = math.sqrt(2 * s["d_t_px2_per_s"] * dt), 0.5 * dt * self.speed
        return self.x + reach * (ux + self.ux) + sd * dx, self.y + reach * (uy + self.uy) + sd * dy

    def step(self):
        if self.model == "dipole":
            x, y = self.swim()
        else:
            if self.step_index % self.scene["hold"] == 0:
                self.redraw()
            x, y = self.x + self.vx, self.y + self.vy
        x, y = np.clip(x, 0, self.width - 1), np.clip(y, 0, self.height - 1)
        if self.exclusion:
            self.resolve(x, y)
        else:
            self.x, self.y = x, y
        self.step_index += 1

    def resolve(self, x, y):
        """Simultaneous moves: cells claim free pixels in random order, and the last claim wins."""
        wish = (y + 0.5).astype(np.int64) * self.width + (x + 0.5).astype(np.int64)
        hopeful = np.flatnonzero(~self.occupied[wish])
        shuffled = self.random.permutation(hopeful)
        self.claim[wish[shuffled]] = shuffled
        winner = hopeful[self.claim[wish[hopeful]] == hopeful]
        self.occupied[self.cell[winner]] = False
        self.occupied[wish[winner]] = True
        self.cell[winner] = wish[winner]
        moved = np.flatnonzero(self.cell == wish)
        self.x[moved], self.y[moved] = x[moved], y[moved]

    def checks(self):
        """The checks of bench_agents, with a tolerance of five standard errors."""
        n, out = self.n, []

        def check(what, value, expected, tolerance):
            ok = bool(abs(value - expected) <= tolerance)
            out.append(dict(what=what, value=float(value), expected=float(expected), tolerance=float(tolerance), ok=ok))

        if self.model == "dipole":
            angle = np.arange(4096) * (2 * math.pi / 4096)
            weight = np.exp(self.scene["alignment"] * (np.cos(angle) - 1))
            weight /= weight.sum()
            mean = (weight * np.cos(angle)).sum()
            sd = math.sqrt((weight * np.cos(angle) ** 2).sum() - mean**2)
            check("1 - <cos>", (1 - self.ux).mean(), 1 - mean, 5 * sd / math.sqrt(n) + 1e-3 * (1 - mean))
        else:
            k, (mx, my) = self.scene[self.model + "_noise"], self.scene["drift"]
            for what, v, m in (("vx", self.vx, mx), ("vy", self.vy, my)):
                u = m / math.hypot(mx, my)
                mean, variance = -m, k * (k + 1) / 3
                if self.model == "adapted":
                    mean, variance = -u * k / 2, variance + u * u * k * (k + 2) / 12
                check("mean " + what, v.mean(), mean, 5 * math.sqrt(variance / n))
                fourth = ((v - v.mean()) ** 4).mean()
                check("var " + what, v.var(), variance, 5 * math.sqrt((fourth - v.var() ** 2) / n))
        if self.exclusion:
            pixel = (self.y + 0.5).astype(np.int64) * self.width + (self.x + 0.5).astype(np.int64)
            check("occupied sites", len(np.unique(pixel)), n, 0)
        return out


def measure(swarm, seconds, least):
    """ns per agent-step of each repeat; each starts from the saved state and runs one cycle before the measurement."""
    steps = 8 if swarm.n >= 10**5 else 24
    saved, ns, begin = swarm.save(), [], time.perf_counter()
    while len(ns) < least or time.perf_counter() - begin < seconds:
        swarm.restore(saved)
        for _ in range(2 * swarm.scene["hold"]):
            swarm.step()
        start = time.perf_counter()
        for _ in range(steps):
            swarm.step()
        ns.append((time.perf_counter() - start) * 1e9 / steps / swarm.n)
    return ns


def main():
    scene, seconds, sizes = json.loads(sys.argv[1]), float(sys.argv[2]), [int(n) for n in sys.argv[3:]]
    for n in sizes:
        for model in ("basic", "adapted", "dipole"):
            headings = None
            for exclusion in (False, True):
                swarm = Swarm(scene, model, n, exclusion)
                if model == "dipole":
                    if headings is None:
                        for _ in range(scene["settling"]):
                            swarm.swim()
                        headings = swarm.theta
                    swarm.set_heading(headings)
                ns = measure(swarm, seconds, 3)
                low, median, high = np.percentile(ns, [25, 50, 75])
                print(json.dumps(dict(kind="numpy", model=model, agents=n, order="two-phase" if exclusion else "none",
                                      threads=1, ns=median, ns_low=low, ns_high=high, repeats=len(ns),
                                      checks=swarm.checks())), flush=True)


main()
