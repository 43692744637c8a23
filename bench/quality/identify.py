"""Videos of step responses for `faba identify`: models that the study does not contain, and defects of the videos."""

from . import film, material as m
from .outcome import inside, outcome

INTERVAL = ("the 90 % interval of the speed of the dipole model, the only one of the study, widened by 1.19 about its median. With 400 simulations")
WIDER = 1.96 / 1.645
SEGMENT, FIRST, SEGMENTS = 1.4, 0.7, 4
FIELD, RATE, SCALE = 115, 15, 1.16


def scene(t):
    """Cells at the left edge of a drop swim away and back."""
    extra = t.get("extra", "")
    inset, radius = t["inset"], t["radius"]
    text = m.scene(cells=t["cells"], speed=t["speed"], speed_sd=t.get("speed_sd", 0.2 * t["speed"]), rate=RATE, duration=FIRST + SEGMENTS * SEGMENT,
                   field=FIELD, reversal=FIRST, start='{ type = "edge", direction = "180 deg", visible = true }',
                   arena=f"radius_px = {radius}\ncentre_px = [{radius + inset}, {m.HEIGHT / 2}]", um_per_px=SCALE, diameter=2.5, psf=0.46,
                   noise=t["noise"], contrast=t["contrast"], motile=t.get("motile", 1.0), extra=extra, swarm=t.get("swarm", ""))
    head, tail = text.split("[record]")
    for k in range(1, SEGMENTS):
        sign = -1 if k % 2 == 0 else 1
        head += f'\n[[controller.segment]]\nat = "{FIRST + k * SEGMENT} s"\nfield = ["{sign * FIELD} uT", "0 T"]\n'
    return head + "[record]" + tail


def draw(rng, **other):
    return {"cells": int(rng.integers(150, 350)), "speed": round(rng.uniform(70, 160), 1), "noise": round(rng.uniform(0.006, 0.015), 4),
            "contrast": round(rng.uniform(-0.6, -0.4), 2), "radius": int(rng.integers(350, 600)), "inset": int(rng.integers(20, 40)), **other}


def study(file, fps, field, scale, segments):
    lines = ["seed = 1", "simulations = 400", 'boundary = "drop"', f'field_strength = "{field} uT"', f"um_per_px = {scale}", "[[video]]",
             f'file = "{file}"']
    if fps:
        lines.append(f"fps = {fps}")
    for k in range(SEGMENTS) if segments else []:
        lines.append(f"[[video.segment]]\nfrom = \"{FIRST + k * SEGMENT} s\"\nto = \"{FIRST + (k + 1) * SEGMENT} s\"\ndirection = \"{180 * (k % 2)} deg\"")
    lines += ["[[model]]", 'name = "dipole"', 'type = "dipole"',
              'free = { "swarm[0].model.speed" = ["20 um/s", "300 um/s"], "swarm[0].model.speed_sd" = ["0 um/s", "120 um/s"], "swarm[0].count" = [50, 1200] }']
    return "\n".join(lines) + "\n"


def measured(kit, rng, t, change=None, file=None, field=FIELD, scale=SCALE):
    text, seed = scene(t), int(rng.integers(1, 1 << 30))
    run = kit.run(text, seed)
    fps = None
    video = run
    if change:
        frames = change(kit.frames(run).astype(float), rng)
        video, fps = kit.film(frames, text, seed, float(frames.sum()), float(frames.std())), RATE
    if file:
        video = run / file
    folder = kit.folder / ("identify-" + m.digest(text, seed, str(video), field, scale, rng.integers(1 << 60)))
    folder.mkdir(exist_ok=True)
    (folder / "study.toml").write_text(study(video, fps, field, scale, bool(change or file)))
    a = kit.json("identify", "study.toml", "--out", "out", "--threads", 1, cwd=folder)
    truth = t["speed"]
    true_value = f"dipole, {truth:g} um/s"
    if "refused" in a:
        return outcome(a, False, true_value, "", "")
    fit = next(x for x in a["models"] if x["name"] == "dipole")
    if "failed" in fit:
        return outcome({"refused": fit["failed"]}, False, true_value, "", "")
    p = fit["parameters"]["swarm[0].model.speed"]
    value, low, high = (1e6 * x for x in (p["median"], *p["ci90"]))
    low, high = value - WIDER * (value - low), value + WIDER * (high - value)
    return outcome(a, not inside(low, truth, high), true_value, f"{value:.0f} um/s", f"{low:.0f} to {high:.0f}")


def suitable(kit, rng, k):
    return measured(kit, rng, draw(rng))


def misspecified(**changes):
    def case(kit, rng, k):
        return measured(kit, rng, draw(rng, **{name: v(rng) for name, v in changes.items()}))
    return case


def defect(change):
    return lambda kit, rng, k: measured(kit, rng, draw(rng), change)


def h264(kit, rng, k):
    return measured(kit, rng, draw(rng, contrast=-0.12), file="video.mp4")


def drifting(frames, rng):
    return m.drifting(frames, rng.choice([-1, 1]) * rng.uniform(0.1, 0.4), rng.uniform(-0.2, 0.2))


def wrong_field(kit, rng, k):
    return measured(kit, rng, draw(rng), field=FIELD * rng.choice([10, 0.2]))


KINDS = {"suitable": (suitable, 10),
         "half not motile": (misspecified(motile=lambda r: r.uniform(0.4, 0.6)), 3),
         "tumbling": (misspecified(extra=lambda r: ', tumble_rate = "2 1/s"'), 2),
         "reversing": (misspecified(extra=lambda r: ', reversal_rate = "0.5 1/s"'), 2),
         "not responding": (misspecified(swarm=lambda r: f"responding = {r.uniform(0.3, 0.6):.2f}"), 2),
         "spread of moments": (misspecified(extra=lambda r: ", moment_spread = 1.5"), 1),
         "coded": (h264, 2), "textured background": (defect(film.textured), 2), "illumination flicker": (defect(film.flickering), 2),
         "drift": (defect(drifting), 2), "wrong focus": (defect(film.unfocused), 2), "noise": (defect(film.noisy), 2),
         "wrong field strength": (wrong_field, 2)}
