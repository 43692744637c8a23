# %% [markdown]
# # Steer a simulated swarm
#
# A swarm of magnetotactic bacteria is steered along a route in a drop. This notebook looks into the simulation, takes over the coils,
# records a run, reads its files, and repeats the experiment with several camera delays.
#
# Build the package with `make python` and start Jupyter in this folder with `PYTHONPATH=../build/python`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import faba

SCENE = "../scenes/steer.toml"

# %% [markdown]
# ## One frame
#
# A `Simulation` is a scenario in memory. `turn()` runs one control cycle: camera, estimator, reference, controller, limits, coils. It
# returns what each of them delivered. Positions are in metres, with the origin in the middle of the view and y up.

# %%
sim = faba.Simulation(SCENE, seed=1)
tick = sim.turn()
print(sim)
print(tick.estimate)
print(tick.target)
print("currents:", np.round(tick.command, 3), "A")

# %% [markdown]
# `state` has the true state of the cells as views: they show the present state, without a copy. Keep values with `.copy()`.

# %%
state = sim.state
print({name: f"{column.dtype} {column.shape}" for name, column in state.items()})
speeds = state["speed"].copy()
print(f"speed of the cells: {1e6 * speeds.mean():.0f} ± {1e6 * speeds.std():.0f} um/s")

# %% [markdown]
# ## The swarm on its route
#
# Simulate half a second at a time, and keep the positions.

# %%
def in_px(x, y):
    """Positions in pixels of the picture, with the origin at the top left and y down."""
    px = sim.context.m_per_px
    return 319.5 + x / px, 239.5 - y / px


moments = []
while not sim.finished:
    sim.run(30)
    moments.append((sim.t, sim.state["x"].copy(), sim.state["y"].copy()))

figure, axes = plt.subplots(1, 2, figsize=(12, 4.6))
axes[0].imshow(sim.drawing())
axes[0].set_axis_off()
axes[0].set_title(f"The picture of the lab at {sim.t:.0f} s")
colours = plt.cm.viridis(np.linspace(0, 1, len(moments)))
for (t, x, y), colour in zip(moments, colours):
    axes[1].plot(*in_px(x, y), ".", markersize=2, color=colour)
setpoints = np.array(sim.scenario["reference"]["setpoints_px"])
axes[1].plot(*setpoints.T, "k+", markersize=12, label="setpoints")
axes[1].set(xlim=(0, 640), ylim=(480, 0), aspect="equal", xlabel="x, px", ylabel="y, px", title="Cells every half second, from blue to yellow")
axes[1].legend()
plt.show()

# %% [markdown]
# The same scene and seed give the same bits, whatever the number of threads:

# %%
print(sim.state_hash, faba.Simulation(SCENE, seed=1, threads=2).run().state_hash)

# %% [markdown]
# ## Your own currents
#
# `turn(command=...)` sends your currents in place of those of the controller. They pass the limits of the scenario first. Here the field
# rotates at 2 Hz, so the cells swim in circles.

# %%
rotating = faba.Simulation(SCENE, seed=1)
path = []
while rotating.t < 1.0:
    angle = 2 * np.pi * 2 * rotating.t
    field = 0.5e-3 * np.array([np.cos(angle), np.sin(angle)])  # T
    rotating.turn(command=rotating.context.currents_for_field(field))
    path.append([rotating.state["x"][:3].copy(), rotating.state["y"][:3].copy()])

path = 1e6 * np.array(path)
plt.figure(figsize=(4.5, 4.5))
plt.plot(path[:, 0], path[:, 1])
plt.axis("equal")
plt.xlabel("x, um")
plt.ylabel("y, um")
plt.title("Three cells in a rotating field, 1 s")
plt.tight_layout()
plt.show()

# %% [markdown]
# ## Record a run
#
# `faba.run()` writes a run directory like `faba run`: video, series, tracks, report. `Run` reads it.

# %%
run = faba.run(SCENE, seed=1, out="runs/steer", force=True)
print(run, "complete:", run.complete)
print("same state hash:", run.state_hash == sim.state_hash)
for name in ("setpoints_reached", "settling_time_s", "steady_rms_px", "path_length_px"):
    print(f"{name:20} {run.metrics[name]:.4g}")

# %% [markdown]
# The series has one row for each frame. Columns `true_...` are known in a simulation only; `estimated_...` is what the estimator found.

# %%
series = run.series
figure, axes = plt.subplots(2, 1, figsize=(8, 5), sharex=True)
axes[0].plot(series["t_s"], series["distance_px"])
axes[0].set(ylabel="distance, px", title="Distance of the swarm to its setpoint; it jumps when the next setpoint is due")
axes[1].plot(series["t_s"], series["true_sigma_x_px"], label="x")
axes[1].plot(series["t_s"], series["true_sigma_y_px"], label="y")
axes[1].set(xlabel="t, s", ylabel="dispersion, px", title="Standard deviation of the positions of the cells")
axes[1].legend()
plt.tight_layout()
plt.show()

# %% [markdown]
# The tracks of all cells are an xarray.Dataset with named dimensions.

# %%
tracks = run.tracks
print(dict(tracks.sizes))
spread = tracks.position_px.std("cell").isel(frame=[0, -1])
print("dispersion in x and y, first and last frame, px:", spread.values.round(1).tolist())
tracks.close()

# %% [markdown]
# ## Many runs
#
# How does a camera delay change the error? `simulate()` runs all parameter sets and seeds on all cores, without files. The result has one
# row for each delay and one column for each seed.

# %%
delays = [0, 1, 2, 4, 6, 8]
errors = faba.simulate(SCENE, {"camera.delay_frames": delays}, range(10), "steady_rms_px")
print(errors.shape)

mean, se = errors.mean(axis=1), errors.std(axis=1, ddof=1) / np.sqrt(errors.shape[1])
plt.figure(figsize=(6, 3.6))
plt.errorbar(delays, mean, 1.96 * se, fmt="o-", capsize=3)
plt.xlabel("camera delay, frames at 60 Hz")
plt.ylabel("steady-state error, px rms")
plt.title("Mean of ten seeds with 95 % interval")
plt.ylim(0)
plt.tight_layout()
plt.show()
