# %% [markdown]
# # Fit a coil system to a measured field
#
# The field of a coil was measured at some points. How strong is the coil really, where is it, and what is the background field? Here the
# measurement is simulated, so the true values are known. With your own measurement, replace `measured.csv` by your file.

# %%
import pathlib

import matplotlib.pyplot as plt
import numpy as np

import faba

RIG = "../rigs/flat-coil.toml"  # 130 turns of 155 mm radius, 1.04 A

# %% [markdown]
# ## The field of the formula
#
# `Field` computes the field of a coil system file at any positions: arrays (..., 2) or (..., 3) in metres; the result is (..., 3) in tesla.

# %%
coil = faba.Field(RIG)
print(coil, "with", coil.currents, "A")
z = np.linspace(-0.3, 0.3, 121)
on_axis = np.stack([0 * z, 0 * z, z], axis=-1)

plt.figure(figsize=(6, 3.4))
plt.plot(1e3 * z, 1e6 * coil.at(on_axis)[:, 2])
plt.xlabel("z, mm")
plt.ylabel("Bz on the axis, uT")
plt.tight_layout()
plt.show()

# %% [markdown]
# ## A measurement
#
# A Hall probe at 7 x 7 points. In truth the coil is 4 % stronger than its file states, its centre is at z = 4 mm of the ruler, the
# background field is -40 uT, and the probe has a noise of 2 uT.

# %%
GAIN, SHIFT, OFFSET, NOISE = 1.04, 4e-3, -40e-6, 2e-6

rho, height = (a.ravel() for a in np.meshgrid(np.linspace(0, 0.12, 7), np.linspace(-0.1, 0.2, 7)))
at = np.stack([rho, 0 * rho, height - SHIFT], axis=-1)
bz = GAIN * coil.at(at)[:, 2] + OFFSET + np.random.default_rng(1).normal(0, NOISE, len(at))

table = np.column_stack([1e3 * rho, 1e3 * height, 1e3 * bz])
np.savetxt("measured.csv", table, delimiter=",", header="rho_mm,z_mm,bz_mt", comments="", fmt="%.6g")
print(*pathlib.Path("measured.csv").read_text().splitlines()[:4], sep="\n")

# %% [markdown]
# ## The fit
#
# `field_fit()` is `faba field fit`: it reads the units from the names of the columns, and writes a coil system file.

# %%
fit = faba.field_fit(RIG, map="measured.csv", out="fitted.toml", force=True)
low, high = fit["gain_ci95"]
print(f"gain        {fit['gain']:.4f}, 95 % interval {low:.4f} to {high:.4f}, true {GAIN}")
low, high = np.multiply(fit["shift_ci95_m"][2], 1e3)
print(f"shift       {1e3 * fit['shift_m'][2]:.2f} mm, 95 % interval {low:.2f} to {high:.2f}, true {1e3 * SHIFT}")
low, high = np.multiply(fit["offset_ci95_t"][2], 1e6)
print(f"background  {1e6 * fit['offset_t'][2]:.1f} uT, 95 % interval {low:.1f} to {high:.1f}, true {1e6 * OFFSET:.1f}")
print(f"residual    {1e6 * fit['rms_t']:.2f} uT rms, true noise {1e6 * NOISE:.1f}")
print("quality    ", fit.quality)

# %% [markdown]
# The fitted file is a coil system like any other. Its residuals show whether the model is right: they should be noise.

# %%
fitted = faba.Field("fitted.toml")
points = np.stack([rho, 0 * rho, height], axis=-1)
residuals = 1e6 * (bz - fitted.at(points)[:, 2]).reshape(7, 7)

figure, axes = plt.subplots(1, 2, figsize=(11, 4))
axes[0].plot(1e3 * height[rho == 0], 1e6 * bz[rho == 0], "ko", label="measured, on the axis")
axes[0].plot(1e3 * z, 1e6 * coil.at(on_axis)[:, 2], "--", label="file")
axes[0].plot(1e3 * z, 1e6 * fitted.at(on_axis)[:, 2], label="fitted")
axes[0].set(xlabel="z, mm", ylabel="Bz, uT", xlim=(-150, 250))
axes[0].legend()
picture = axes[1].imshow(residuals, origin="lower", extent=(-10, 130, -125, 225), aspect="auto", cmap="RdBu", vmin=-6, vmax=6)
axes[1].set(xlabel="rho, mm", ylabel="z, mm", title="Residuals, uT")
figure.colorbar(picture, ax=axes[1])
plt.tight_layout()
plt.show()

# %% [markdown]
# ## A wrong measurement
#
# The same table with a wrong unit in its header: gauss in place of millitesla. The fit does not return a coil of a tenth of the strength
# without comment:

# %%
np.savetxt("gauss.csv", table, delimiter=",", header="rho_mm,z_mm,bz_gauss", comments="", fmt="%.6g")
try:
    wrong = faba.field_fit(RIG, map="gauss.csv")
    print(f"gain {wrong['gain']:.3f}, quality {wrong.quality}")
    for warning in wrong.warnings:
        print(f"- {warning['what']} ({warning['evidence']}); {warning['advice']}")
except faba.Error as e:
    print("refused:", e.what)

# %% [markdown]
# ## Four coils around a sample
#
# A zero of the field traps cells of one polarity. `null()` computes the currents that put it at a position.

# %%
four = faba.Field("../rigs/thesis-four-coils.toml")
goal = (0.3e-3, -0.2e-3)  # m
null = four.null(goal, polarity=-1)
print("currents", np.round(null["currents"], 3), "A, at most", four.max_currents, "A")
print("reachable", null["reachable"], "; gradients", np.round(null["gradient"], 4), "T/m")

x, y = np.meshgrid(np.linspace(-2e-3, 2e-3, 161), np.linspace(-2e-3, 2e-3, 161))
b = four.at(np.stack([x, y], axis=-1), null["currents"])
strength = 1e6 * np.hypot(b[..., 0], b[..., 1])

plt.figure(figsize=(5.6, 4.6))
plt.pcolormesh(1e3 * x, 1e3 * y, strength, shading="gouraud")
plt.colorbar(label="field in the plane, uT")
some = slice(None, None, 16)
plt.quiver(1e3 * x[some, some], 1e3 * y[some, some], b[some, some, 0], b[some, some, 1], color="w")
plt.plot(*np.multiply(goal, 1e3), "rx", markersize=12, markeredgewidth=2)
plt.xlabel("x, mm")
plt.ylabel("y, mm")
plt.title("A trap for south-seeking cells")
plt.gca().set_aspect("equal")
plt.tight_layout()
plt.show()
