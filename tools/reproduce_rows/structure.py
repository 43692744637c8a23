"""What the program is made of: the modules of Fig 3.10, the window of Fig 3.20."""

import ast

from reproduce_rows import plot
from reproduce_rows.faba import ROOT

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
    """The level of each folder: above everything that it includes; the table has no circles or this would not end."""
    level, left = {}, dict(may)
    while left:
        ready = [n for n, below in left.items() if all(b in level for b in below)]
        if not ready:
            raise ValueError(f"tools/check_layers.py lets {', '.join(left)} include each other")
        for n in ready:
            level[n] = 1 + max((level[b] for b in left.pop(n)), default=-1)
    return level


def modules(lab, found):
    parts = lab.call("parts", "parts").answer
    missing = [f"{kind} {name}" for kind, name in MODULES if name not in parts.get(kind, {})]
    level = depth(layers())
    found.value = f"{len(level)} folders in {1 + max(level.values())} layers; {sum(map(len, parts.values()))} parts of {len(parts)} kinds"
    found.within(
        "Modules of the thesis without a part",
        len(missing),
        0,
        0,
        "its two models, field, controllers, grid and analysis are parts of the program: " + ", ".join(" ".join(m) for m in MODULES),
    )
    found.true(
        "Layers without circles",
        len(level) == len(layers()),
        "every folder includes lower ones only; `tools/check_layers.py` holds the sources to it",
    )
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
