"""What the program is made of: the modules of Fig 3.10, the window of Fig 3.20."""

import ast
import subprocess
import sys

from reproduce_rows import plot
from reproduce_rows.faba import ROOT, Failed

# A module of the thesis's figure, and the kind and name of the part that does its work here.
MODULES = (
    ("model", "basic"),
    ("model", "adapted"),
    ("field", "uniform"),
    ("field", "rig"),
    ("controller", "fuzzy"),
    ("controller", "gradient"),
    ("arena", "box"),
    ("arena", "drop"),
    ("flow", "horn_schunck"),
)


def layers():
    """Which folder may include which: the table that a test holds the sources to."""
    tree = ast.parse((ROOT / "tools/check_layers.py").read_text())
    table = next(n.value for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "MAY")
    return {name: words.split() for name, words in ast.literal_eval(table).items()}


def depth(may):
    """The level of each folder, above everything that it includes, and the folders that have none because of a circle."""
    level, left = {}, dict(may)
    while ready := [n for n, below in left.items() if all(b in level for b in below)]:
        for n in ready:
            level[n] = 1 + max((level[b] for b in left.pop(n)), default=-1)
    return level, list(left)


def violations(lab):
    """Lines that tools/check_layers.py prints of the sources: what they include is compared with the table, folder by folder."""
    words = ["tools/check_layers.py", "src"]
    lab.commands.append(" ".join(words))
    done = subprocess.run([sys.executable, *words], cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        raise Failed(f"tools/check_layers.py src: {(done.stderr or done.stdout).strip()[-600:]}")
    return done.stdout.splitlines() if done.returncode else []


def modules(lab, found):
    parts = lab.call("parts", "parts").answer
    missing = [f"{kind} {name}" for kind, name in MODULES if name not in parts.get(kind, {})]
    level, circle = depth(layers())
    wrong = violations(lab)
    found.value = (
        f"{len(level)} folders in {1 + max(level.values(), default=-1)} layers, {len(wrong)} violations; {sum(map(len, parts.values()))} parts of"
        f" {len(parts)} kinds"
    )
    found.within(
        "Modules of the thesis without a part",
        len(missing),
        0,
        0,
        "its two models, field, controllers, grid and analysis are parts of the program: " + ", ".join(" ".join(m) for m in MODULES),
    )
    found.within(
        "Layers without circles: folders that the table lets include each other",
        len(circle),
        0,
        0,
        "every folder may include lower ones only",
    )
    found.within(
        "Violations of the layers in the sources",
        len(wrong),
        0,
        0,
        "`tools/check_layers.py` compares every include of `src` with that table, and finds files that include each other in a circle",
    )
    if circle:
        return
    does = {
        "cli": "verbs and options",
        "server": "live lab",
        "study": "analysis, reports",
        "app": "scenario, loop, files",
        "rig": "simulated microscope",
        "control": "controllers",
        "sim": "bacteria, arenas",
        "vision": "pictures, flow",
        "field": "coils, fields",
        "core": "files, random numbers",
        "guard": "process of the coils",
    }
    width, places, where = 150, [], {}
    for n in sorted(level, key=lambda n: (-level[n], n)):
        row = [m for m in sorted(level) if level[m] == level[n]]
        x = 310 + (row.index(n) - (len(row) - 1) / 2) * (width + 20) - width / 2
        where[n] = len(places)
        places.append((x, 10 + 62 * (max(level.values()) - level[n]), width, f"{n}|{does.get(n, '')}"))
    # Only the arrows that no detour shows.
    may = layers()
    direct = [(a, b) for a in may for b in may[a] if not any(b in may[c] for c in may[a])]
    found.show(
        plot.boxes(
            "The program's modules",
            places,
            [(where[a], where[b]) for a, b in direct],
            "From the table in tools/check_layers.py. An arrow: may include, and all below that.",
            (620, 70 + 62 * max(level.values())),
        )
    )


# What the thesis's window sets, and where it stands in the form of the page: a path in the scenario's schema.
SETTINGS = {
    "model": "swarm.items.model",
    "controller": "controller",
    "number of cells": "swarm.items.count",
    "largest speed": "swarm.items.model:basic.max_speed",
    "setpoint": "reference:hold.setpoint_px",
    "recording": "record",
    "field model": "field",
    "manual field": "controller:manual.field",
}
SCENE = "scenes/thesis-basic.toml"


def window(lab, found):
    found.commands = [f"build/faba lab {SCENE}"]
    with lab.page(SCENE) as page:
        schema = page.get("/api/schema")
        missing = [name for name, path in SETTINGS.items() if not _in_form(schema, path)]
        found.value = f"a page in the browser with {len(SETTINGS) - len(missing)} of the {len(SETTINGS)} settings, and all others of a scenario"
        found.within("Settings of the window without a place in the form", len(missing), 0, 0, "the page makes its form of the scenario's schema")
        started = page.get("/api/scenes/thesis-basic")["scenario"]
        found.true("The published model can be chosen", started["swarm"][0]["model"]["type"] == "basic", "the scene in the gallery has it")
        picture = page.picture()
    if picture:
        found.show(plot.picture("The page, with the published model", picture, "faba lab, a few seconds after it was opened"))


def _in_form(schema, path):
    """Whether a path such as "controller:manual.field" leads somewhere: names of keys, after a colon that of a part."""
    for key in path.split("."):
        name, _, part = key.partition(":")
        schema = schema["items"] if name == "items" else schema.get("properties", {}).get(name)
        if schema is not None and part:
            schema = next((one for one in schema["oneOf"] if one.get("properties", {}).get("type", {}).get("const") == part), None)
        if schema is None:
            return False
    return True
