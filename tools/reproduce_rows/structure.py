"""Structure of the program: the modules of Fig 3.10 and the window of Fig 3.20."""

import ast
import subprocess
import sys

from reproduce_rows import plot
from reproduce_rows.faba import ROOT, Failed

# Parts (kind, name) that correspond to the modules in the figure of the thesis.
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
    """The permitted includes per folder: the table of tools/check_layers.py, which a test enforces."""
    tree = ast.parse((ROOT / "tools/check_layers.py").read_text())
    table = next(n.value for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "MAY")
    return {name: words.split() for name, words in ast.literal_eval(table).items()}


def depth(may):
    """The level of each folder, above all folders that it may include; and the folders without a level, which are in a cycle."""
    level, left = {}, dict(may)
    while ready := [n for n, below in left.items() if all(b in level for b in below)]:
        for n in ready:
            level[n] = 1 + max((level[b] for b in left.pop(n)), default=-1)
    return level, list(left)


def violations(lab):
    """The violations that tools/check_layers.py prints: includes in the sources that the table does not permit."""
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
        "Modules of the thesis without a corresponding part",
        len(missing),
        0,
        0,
        "the two models, the field, the controllers, the grid and the analysis are parts of the program: "
        + ", ".join(" ".join(m) for m in MODULES),
    )
    found.within(
        "Folders in an include cycle of the table of layers",
        len(circle),
        0,
        0,
        "a folder may include only folders of lower layers",
    )
    found.within(
        "Violations of the layers in the sources",
        len(wrong),
        0,
        0,
        "`tools/check_layers.py` compares all includes in `src` with the table and reports include cycles of files",
    )
    if circle:
        return
    purpose = {
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
        "guard": "coil watchdog process",
    }
    width, places, where = 150, [], {}
    for n in sorted(level, key=lambda n: (-level[n], n)):
        row = [m for m in sorted(level) if level[m] == level[n]]
        x = 310 + (row.index(n) - (len(row) - 1) / 2) * (width + 20) - width / 2
        where[n] = len(places)
        places.append((x, 10 + 62 * (max(level.values()) - level[n]), width, f"{n}|{purpose.get(n, '')}"))
    # Without arrows that follow from a path over another folder.
    may = layers()
    direct = [(a, b) for a in may for b in may[a] if not any(b in may[c] for c in may[a])]
    found.show(
        plot.boxes(
            "Modules of the program",
            places,
            [(where[a], where[b]) for a, b in direct],
            "From the table in tools/check_layers.py. Arrow: may include this folder and all folders below it.",
            (620, 70 + 62 * max(level.values())),
        )
    )


# Settings in the window of the thesis, and their paths in the scenario schema, from which the page builds its form.
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
        found.value = (
            f"a page in the browser with {len(SETTINGS) - len(missing)} of the {len(SETTINGS)} settings, and all other settings of a scenario"
        )
        found.within(
            "Settings of the window that are missing in the form", len(missing), 0, 0, "the page builds its form from the scenario schema"
        )
        started = page.get("/api/scenes/thesis-basic")["scenario"]
        found.true("The published model can be selected", started["swarm"][0]["model"]["type"] == "basic", "a scene of the gallery uses it")
        picture = page.picture()
    if picture:
        found.show(plot.picture("The page with the published model", picture, "faba lab, a few seconds after the page was opened."))


def _in_form(schema, path):
    """Whether the schema has a path such as "controller:manual.field": names of keys, and after a colon the type of a part."""
    for key in path.split("."):
        name, _, part = key.partition(":")
        schema = schema["items"] if name == "items" else schema.get("properties", {}).get(name)
        if schema is not None and part:
            schema = next((one for one in schema["oneOf"] if one.get("properties", {}).get("type", {}).get("const") == part), None)
        if schema is None:
            return False
    return True
