# %% [markdown]
# # Measure a video
#
# A video of which the truth is known: the simulation renders what a camera would record. The drop, the image scale, the tracks and the
# response to a field reversal are measured from it, and each result stands beside its true value. With your own video, replace `video`
# by its path.

# %%
import matplotlib.pyplot as plt
import numpy as np

import faba

SCENE = """
title = "A video with known truth"
seed = 1
duration = "4 s"

[scale]
um_per_px = 0.9164

[camera]
rate = "30 Hz"
sensor = "frames"

[microscope]
cell_diameter = "2.5 um"
contrast = -0.45

[arena]
type = "drop"
radius_px = 215

[[swarm]]
count = 60
model = { type = "dipole", preset = "IT-1", speed = "60 um/s", speed_sd = "6 um/s", speed_max = "100 um/s" }
start = { type = "disc", centre_px = [320, 240], radius_px = 110 }

[controller]
type = "manual"
field = ["1 mT", "0 T"]           # south-seeking cells swim against it, to the left

[[controller.segment]]
at = "1.5 s"
field = ["-1 mT", "0 T"]
"""

# %% [markdown]
# `as_seen=True` records the camera's view in place of a drawing; `record.lossless` writes it without compression, which would remove noise
# and faint cells. `video` of the run is then the lossless one.

# %%
run = faba.run(SCENE, as_seen=True, set={"record.lossless": True}, out="runs/measure", force=True)
video = run.video

sim = faba.Simulation(SCENE, set={"record.as_seen": True})
true_speeds = 1e6 * sim.state["speed"].copy()  # um/s
sim.run(20)
plt.figure(figsize=(6.4, 4.8))
plt.imshow(sim.picture(), cmap="gray", vmin=0, vmax=255)
plt.title("The camera's view at 0.7 s")
plt.axis("off")
plt.show()

# %% [markdown]
# ## The drop
#
# `drop()` reads a picture, or the first frame of a video. A picture may also be an array.

# %%
drop = faba.drop(video)
print(f"radius   {drop['radius_px']:.2f} ± {drop['sd_px']['radius']:.2f} px, true 215 px")
print(f"centre   {drop['center_px'][0]:.2f}, {drop['center_px'][1]:.2f} px, true 319.5, 239.5 px")
print(f"quality  {drop.quality}")
print("the same from an array:", faba.drop(sim.picture())["radius_px"] > 214)

# %% [markdown]
# ## The scale
#
# A stage micrometer with marks every 10 um, drawn here with 0.9164 um per pixel and noise.

# %%
TRUE_SCALE = 0.9164
mark = (np.arange(640) - 20.3) * TRUE_SCALE / 10
from_mark = 10 / TRUE_SCALE * np.abs(mark - np.rint(mark))  # px
dark = np.clip(2 - from_mark, 0, 1) * (np.arange(480) < 300)[:, np.newaxis]
grey = 200 - 140 * dark
ruler = np.clip(grey + np.random.default_rng(1).normal(0, 3, grey.shape), 0, 255).astype(np.uint8)

scale = faba.scale(ruler, tick="10 um")
print(f"{scale['um_per_px']:.5f} um per px, 95 % interval {scale['ci95'][0]:.5f} to {scale['ci95'][1]:.5f}, true {TRUE_SCALE}")
print(f"{scale['marks']} marks, quality {scale.quality}")

# %% [markdown]
# ## The tracks
#
# First with all defaults, on the part of the video before the field reversal:

# %%
everything = faba.track(video, to=1.4, um_per_px=scale["um_per_px"])
print(f"{everything['detection']['spots_per_frame']:.0f} spots per frame, but there are 60 cells")
print("quality", everything.quality)
for warning in everything.warnings:
    print(f"- {warning['aspect']}: {warning['what']} ({warning['evidence']}); {warning['advice']}")

# %% [markdown]
# Most of these spots lie on the edge of the drop. Always look at the detections. `drop=True` searches inside the drop only:

# %%
tracks = faba.track(video, to=1.4, um_per_px=scale["um_per_px"], drop=True)

figure, axes = plt.subplots(1, 2, figsize=(12, 4.6), sharex=True, sharey=True)
for axis, result, title in zip(axes, (everything, tracks), ("all defaults", "drop=True")):
    axis.scatter(result.tracks["x_px"], result.tracks["y_px"], s=1, c=result.tracks["t_s"])
    axis.set(xlim=(0, 640), ylim=(480, 0), aspect="equal", xlabel="x, px", title=f"{title}: {result['tracks']} tracks")
axes[0].set_ylabel("y, px")
plt.tight_layout()
plt.show()

moving = tracks["populations"][0]
low, high = np.multiply(moving["ci90"], scale["um_per_px"])  # the interval is in px/s
print(f"{tracks['tracks']} tracks; {100 * moving['fraction']:.0f} % {moving['motion']}")
print(f"median speed {moving['speed_um_per_s']:.1f} um/s, 90 % interval {low:.1f} to {high:.1f}; true {np.median(true_speeds):.1f}")
print("quality", tracks.quality, [warning["aspect"] for warning in tracks.warnings])

# %% [markdown]
# Each row of `tracks.tracks` is a detection. The speed of every track, from its ends, beside the true speeds of the cells:

# %%
rows = tracks.tracks
measured = []
for number in np.unique(rows["track"]):
    one = rows[rows["track"] == number]
    if len(one) >= 10:
        length = np.hypot(one["x_px"][-1] - one["x_px"][0], one["y_px"][-1] - one["y_px"][0])
        measured.append(scale["um_per_px"] * length / (one["t_s"][-1] - one["t_s"][0]))

bins = np.arange(40, 81, 2.5)
plt.figure(figsize=(6, 3.6))
plt.hist(true_speeds, bins, alpha=0.5, label=f"true, mean {np.mean(true_speeds):.1f}")
plt.hist(measured, bins, histtype="step", linewidth=2, color="k", label=f"measured, mean {np.mean(measured):.1f}")
plt.xlabel("speed, um/s")
plt.ylabel("cells")
plt.legend()
plt.tight_layout()
plt.show()

# %% [markdown]
# ## The response to the field reversal
#
# `activity()` measures how much moves in the direction of the response, from the optical flow.

# %%
activity = faba.activity(video, reversal=1.5)["videos"][0]
low, high = activity["onset_ci90"]
print(f"onset {activity['onset_s']:.3f} s, 90 % interval {low:.3f} to {high:.3f}; the field is reversed at 1.5 s")
direction = (activity["direction_deg"] + 180) % 360 - 180
print(f"direction {direction:.1f} degrees clockwise in the picture, true 0 (to the right)")
low, high = activity["responding_fraction_ci90"]
print(f"responding fraction {activity['responding_fraction']:.2f}, 90 % interval {low:.2f} to {high:.2f}, true 1")
print("quality", activity["quality"])
for warning in activity["warnings"]:
    print(f"- {warning['aspect']}: {warning['what']}")

# %% [markdown]
# ## When a measurement is not valid
#
# A hundred times as many cells, at half the frame rate: detections are linked to other cells. The answer says so. Check `quality` and
# `warnings` before you use a value.

# %%
crowd = faba.run(SCENE, as_seen=True, out="runs/crowd", force=True, duration="1 s",
                 set={"record.lossless": True, "swarm[0].count": 6000, "camera.rate": "15 Hz"})
result = faba.track(crowd.video, um_per_px=TRUE_SCALE, drop=True)
print(f"speeds {[round(p['speed_um_per_s'], 1) for p in result['populations']]} um/s, true {np.median(true_speeds):.1f}")
print("quality", result.quality)
for warning in result.warnings:
    print(f"- {warning['aspect']}: {warning['what']}; {warning['advice']}")
