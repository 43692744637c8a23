# %% [markdown]
# # Your own controller
#
# A controller in ten lines of Python: simulate it, compare it with the built-in ones, stop and resume its run, and use it on a bench, here
# a simulated one. A controller gets an estimate of the swarm and a target. It never sees the simulation, so it works on cells too.

# %%
import pathlib

import matplotlib.pyplot as plt
import numpy as np

import faba

SCENE = "../scenes/steer.toml"

# %% [markdown]
# ## Ten lines
#
# Full field towards the setpoint; near it, a weaker one. `context` has what a controller may know: coils, limits, scale, polarity.
# `currents_for_direction()` converts a direction, in field units of 23 uT, into currents along which the steered cells swim.

# %%
class Chase(faba.Controller):
    strength, near_px = 40, 20

    def update(self, estimate, target, dt):
        error = (target.position - estimate.centroid) / self.context.m_per_px  # px
        direction = error / max(np.hypot(*error), self.near_px)
        return self.context.currents_for_direction(self.strength * direction, at=estimate.centroid)


run = faba.run(SCENE, controller=Chase, seed=1, out="runs/chase", force=True)
print({name: run.metrics[name] for name in ("setpoints_reached", "settling_time_s", "steady_rms_px")})

# %% [markdown]
# It reaches all setpoints, but it does not hold the swarm as well as it could: the cells swim at full speed in any field, so they overshoot,
# turn, and overshoot again.
#
# ## A controller with memory
#
# The cells need about 50 ms to turn. This controller aims at the position predicted for 100 ms later, and modulates the duty cycle: it
# reverses the field so often that the mean speed is proportional to the error. It keeps two values between the cycles, so it has
# `state()` and `restore()`.

# %%
class Duty(faba.Controller):
    lead, gain, speed = 0.1, 0.45, 186e-6  # s; fraction of the error per frame; m/s

    def start(self):
        self.last, self.owed = None, 0.0

    def state(self):
        return {"last": self.last, "owed": self.owed}

    def restore(self, state):
        self.last, self.owed = state["last"], state["owed"]

    def update(self, estimate, target, dt):
        at = estimate.centroid
        velocity = (at - self.last) / dt if self.last is not None and dt > 0 else 0 * at
        self.last = at.tolist()
        error = target.position - at - self.lead * velocity
        distance = max(np.hypot(*error), 1e-9)
        fraction = min(self.gain * distance / (self.speed * self.context.frame_period), 1)
        self.owed += fraction
        sign = 1 if self.owed >= 0 else -1
        self.owed -= sign
        return self.context.currents_for_direction(40 * sign * error / distance, at=at)


second = faba.run(SCENE, controller=Duty, seed=1, out="runs/duty", force=True)
figure, axes = plt.subplots(1, 2, figsize=(12, 4))
for one, label in ((run, "Chase"), (second, "Duty")):
    axes[0].plot(one.series["t_s"], one.series["distance_px"], label=label)
    late = one.series[one.series["t_s"] > 9]
    axes[1].plot(late["true_centroid_x_px"], late["true_centroid_y_px"], label=label)
axes[0].set(xlabel="t, s", ylabel="distance to the setpoint, px")
axes[0].legend()
axes[1].plot(320, 240, "k+", markersize=12)
axes[1].set(xlabel="x, px", ylabel="y, px", aspect="equal", title="Mean of the swarm in the last 3 s")
axes[1].invert_yaxis()
plt.tight_layout()
plt.show()

# %% [markdown]
# ## Compare with the built-in controllers
#
# Twenty seeds of each. Give the class, not an object: every simulation needs its own. A table selects a built-in controller with its
# parameters.

# %%
FUZZY = {"type": "fuzzy", "max_output": 40}
controllers = {"Chase": Chase, "Duty": Duty, "fuzzy": FUZZY, "proportional": None}  # None: that of the scene
names = ["setpoints_reached", "steady_rms_px"]
results = {name: faba.simulate(SCENE, {}, range(20), names, controller=one)[0] for name, one in controllers.items()}

for name, values in results.items():
    reached, error = values.T
    se = error.std(ddof=1) / np.sqrt(len(error))
    print(f"{name:13} reached {reached.mean():.1f} of 4, steady-state error {error.mean():6.2f} ± {1.96 * se:.2f} px")

plt.figure(figsize=(6, 3.4))
plt.boxplot([values[:, 1] for values in results.values()], labels=list(results))
plt.yscale("log")
plt.ylabel("steady-state error, px rms")
plt.title("Twenty seeds")
plt.tight_layout()
plt.show()

# %% [markdown]
# `compare_controllers()` is `faba compare-controllers`: it varies models and camera delays too, with equal seeds for all controllers, and
# can write a page. It reads a study file.

# %%
pathlib.Path("study.toml").write_text('''
scene = "../scenes/steer.toml"
seeds = 5
delays = [0, 3]

[[controller]]
name = "fuzzy"
type = "fuzzy"
max_output = 40
''')
comparison = faba.compare_controllers("study.toml", {"Duty": Duty}, page="comparison.html")
for one in comparison["combinations"]:
    error = one["metrics"]["steady_rms_px"]
    print(f"{one['controller']:8} delay {one['delay_frames']}: {error['mean']:.2f} px rms")

# %% [markdown]
# ## Stop and resume
#
# Ctrl-C, or in a notebook *Interrupt*, stops a run with a checkpoint. An exception in `progress` does the same; here it stops the run
# after a third of its frames. The resumed run has the bits of one that was never stopped, because Duty has `state()` and `restore()`.

# %%
def stop_early(done, total):
    if done > total / 3:
        raise KeyboardInterrupt


LONG = {"duration": "60 s", "set": {"record.video": False}}
whole = faba.run(SCENE, controller=Duty, seed=1, out="runs/whole", force=True, **LONG)
try:
    faba.run(SCENE, controller=Duty, seed=1, out="runs/stopped", force=True, progress=stop_early, **LONG)
except KeyboardInterrupt:
    print(faba.Run("runs/stopped"))

resumed = faba.resume("runs/stopped", controller=Duty)
print(resumed, "same bits:", resumed.state_hash == whole.state_hash)

# %% [markdown]
# ## On the bench
#
# `faba.bench()` runs the same class on the camera and the coils of the table `[rig]` of a scene. `scenes/bench.toml` has a simulated bench:
# a microscope and coils in real time, in a process of their own. `arm=True` permits current. A second process, the guard, checks every
# current, and switches the coils off when the controller raises, blocks or dies.

# %%
on_bench = faba.bench("../scenes/bench.toml", arm=True, controller=Duty, duration="6 s", out="runs/bench", force=True,
                      set={"record.lossless": True})
series = on_bench.series
currents = np.stack([series[f"current_{i}_a"] for i in range(4)])
first, last = series["distance_px"][0], series["distance_px"][-60:].mean()
print("complete:", on_bench.complete)
print("at most 0.4 A:", bool(np.abs(currents).max() <= 0.4))
print("the swarm came closer:", bool(last < first / 5))

# %% [markdown]
# The controller depends on the pictures only. `replay()` computes all its commands again from the recorded video and compares their bits:

# %%
print("same commands:", faba.replay("runs/bench", controller=Duty)["same"])

# %% [markdown]
# A controller that fails cannot leave current in the coils. The exception reaches you with its traceback, and the run is incomplete:

# %%
class Fails(Chase):
    def update(self, estimate, target, dt):
        if estimate.t > 1:
            raise ZeroDivisionError("after a second")
        return super().update(estimate, target, dt)


try:
    faba.bench("../scenes/bench.toml", arm=True, controller=Fails, out="runs/fails", force=True)
except ZeroDivisionError as e:
    print("raised:", e)
    print("complete:", faba.Run("runs/fails").complete)
