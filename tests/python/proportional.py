"""The built-in controller `proportional` in Python: the same operations in the same order give the same bits."""

import math

import faba


def norm(x, y):
    return math.sqrt(x * x + y * y)


class Proportional(faba.Controller):
    def __init__(self, gain=0.45, integral_gain=0.0, max_output=5.0, dead_zone_px=0.0, hold_frames=2, actuation="magnitude",
                 speed=186e-6, lead=None):
        self.gain, self.integral_gain, self.max_output, self.dead_zone_px = gain, integral_gain, max_output, dead_zone_px
        self.hold_frames, self.duty, self.speed, self.lead = hold_frames, actuation == "duty", speed, lead

    def start(self):
        c = self.context
        self.k_p = self.gain / (self.hold_frames + c.delay_frames)
        self.horizon = 0.0 if self.lead is None else self.lead + c.delay_frames * c.frame_period
        self.integral, self.residual, self.last = (0.0, 0.0), 0.0, None
        if self.duty:
            self.max_drift = self.speed * c.frame_period / c.m_per_px
        else:
            self.max_drift = self.max_output * c.frame_period / c.iteration

    def state(self):
        return {"integral": self.integral, "residual": self.residual, "last": self.last}

    def restore(self, state):
        self.integral, self.residual, self.last = state["integral"], state["residual"], state["last"]

    def send(self, at, x, y):
        return self.context.currents_for_direction((x, y), at=at)

    def update(self, estimate, target, dt):
        c = self.context
        at = (float(estimate.centroid[0]), float(estimate.centroid[1]))
        moved = (0.0, 0.0)
        if self.last is not None and dt > 0:
            moved = (self.horizon / dt * (at[0] - self.last[0]), self.horizon / dt * (at[1] - self.last[1]))
        self.last = at if estimate.visible > 0 and math.isfinite(norm(*at)) else None
        goal = (float(target.position[0]), float(target.position[1]))
        per_m = 1 / c.m_per_px
        error = (per_m * (goal[0] - at[0] - moved[0]), per_m * (goal[1] - at[1] - moved[1]))
        distance = norm(*error)
        if self.last is None or not math.isfinite(distance) or distance <= self.dead_zone_px:
            return self.send(at, 0.0, 0.0)
        summed = (self.integral[0] + error[0], self.integral[1] + error[1])
        wanted = tuple(self.k_p * (e + self.integral_gain * s) for e, s in zip(error, summed))
        size = norm(*wanted)
        if size <= self.max_drift:
            self.integral = summed
        if size == 0:
            return self.send(at, 0.0, 0.0)
        along = (1 / size * wanted[0], 1 / size * wanted[1])
        fraction = min(size / self.max_drift, 1.0)
        factor = fraction * self.max_output
        if self.duty:
            self.residual = min(max(self.residual + fraction, -2.0), 2.0)
            sign = 1.0 if self.residual >= 0 else -1.0
            self.residual -= sign
            factor = sign * self.max_output
        return self.send(at, factor * along[0], factor * along[1])
