#!/usr/bin/python3
"""Reports code that depends on the name of a part. The name of a registered part is permitted as a string in the file of
the part, in src/app/parts.cpp, and where a default is selected. Other code uses the traits of a part (src/core/traits.h).

check_parts.py --program build/faba --root .

Many names are ordinary words with other meanings, such as a key of a JSON object. These uses are listed below with
their meaning; an entry that is no longer needed is reported too."""

import argparse
import json
import pathlib
import re
import subprocess
import sys

# Files that select the default of a section or write a scenario.
CHOSEN = {
    "src/app/bench/step_response.cpp": {"image", "manual"},
    "src/app/files/from_picture.cpp": {"drop", "visible"},
    "src/app/scenario/scenario.cpp": {"mean", "image", "none", "hold"},
    "src/app/scenario/scenario.h": {"box", "uniform", "none", "fuzzy", "horn_schunck"},
    "src/app/scenario/sections/field.cpp": {"uniform"},
    "src/app/scenario/sections/swarm.cpp": {"dipole", "uniform"},
    "src/control/kalman.cpp": {"visible", "image"},  # the default of its source
    "src/rig/setup/rig_setup.cpp": {"simulated"},
    "src/study/data/flow_choice.h": {"horn_schunck"},
    "src/python/measures.cpp": {"horn_schunck"},  # the default of the program
    "src/study/identify/best_scene.cpp": {"hold"},
    "src/study/identify/episode_simulation.cpp": {"box", "drop", "dipole", "places", "none", "manual"},
    "src/study/identify/matched_look.cpp": {"dipole"},
    # The editor of coil systems draws these coils and sets their sizes.
    "web/src/coils/geometry.ts": {"solenoid", "thick_coil", "helmholtz"},
    "web/src/coils/system.ts": {"solenoid", "loop", "thick_coil", "helmholtz", "dipole"},
    "web/src/pages/Coils.svelte": {"solenoid"},
    "src/server/api/coils.cpp": {"dipole"},
}
# Other meanings of the names of parts: (name, meaning, files).
OTHER_MEANINGS = (
    ("image", "an attribute in Python", "src/python/loop_values.cpp"),
    ("visible", "an argument and an attribute in Python", "src/python/loop_values.cpp"),
    ("groups", "an attribute in Python", "src/python/loop_values.cpp"),
    ("gradient", "a key in Python", "src/python/measures.cpp"),
    ("rig", "an argument in Python", "src/python/measures.cpp"),
    ("box", "the frame of the arena in JSON", "src/server/shown/run_news.cpp src/server/recorded_run.cpp web/src/steering.svelte.ts"),
    ("box", "the frame of the picture instead of an edge", "web/src/own/own.ts web/src/own/EdgeStep.svelte web/src/own/StartStep.svelte"),
    ("box", "a shape in a figure", "src/study/plot/plot_layer_data.cpp web/src/results/plot_drawing.ts"),
    ("box", "a value of boundary", "src/study/identify/identify_study.cpp"),
    ("drop", "a value of boundary", "src/study/identify/identify_study.cpp"),
    ("drop", "the verb, or its option in `faba track`",
     "src/cli/verbs/drop.cpp src/server/jobs/job_kinds.cpp src/server/tracks/track_request.cpp"),
    ("drop", "a drop of an experiment",
     "src/server/api/bench.cpp src/server/bench/bench_recordings.cpp "
     "src/server/api/experiments.cpp src/server/experiments/experiment_changes.cpp src/server/experiments/experiment_store.cpp "
     "src/study/motion/activity_study.cpp "
     "web/src/pages/experiments/ExperimentPage.svelte web/src/pages/experiments/VideoRow.svelte"),
    ("drop", "the edge of the drop as a limit of a plan", "web/src/frame.ts"),
    ("drop", "the name of a file", "web/src/own/StartStep.svelte"),
    ("edge", "where `compact` gathers the swarm", "src/control/compact.cpp"),
    ("edge", "a layer of the picture", "web/src/bench/draw.ts web/src/i18n/bench.ts web/src/workbench/Stage.svelte web/src/video/overlays.ts web/src/video/VideoViewer.svelte"),
    ("edge", "the edge of the drop: a step, a key, a place of cells", "web/src/own/own.ts web/src/own/EdgeStep.svelte web/src/own/CellsStep.svelte"),
    ("edge", "the aspect of a warning", "src/study/motion/activity_checks.cpp src/study/quality/aspect_titles.cpp"),
    ("hold", "a parameter", "src/sim/agents/adapted.cpp src/sim/agents/basic.cpp"),
    ("hold", "the strength of a coil system, as a JSON key", "src/study/pages/field_report.cpp"),
    ("map", "a coil that is a measured map", "src/server/api/coils.cpp"),
    ("map", "the verb", "src/cli/verbs/field/map.cpp src/server/jobs/job_kinds.cpp"),
    ("mean", "the average, as a JSON key, a parameter or a heading",
     "src/app/bench/live_picture.cpp src/cli/verbs/compare.cpp src/study/identify/free_parameter.cpp "
     "src/study/pages/compare_report.cpp src/study/pages/steering/controller_report.cpp src/study/pages/identify_report.cpp "
     "src/study/pages/tracks/track_json.cpp src/study/pages/calibration/calibration_json.cpp src/study/pages/steering/tuning_report.cpp web/src/i18n/analyse.ts"),
    ("dipole", "a word of a translated message", "web/src/i18n/program/refusals/coils.ts"),
    ("lqr", "advice in a translated message", "web/src/i18n/program/refusals/studies.ts"),
    ("none", "advice in a translated message", "web/src/i18n/program/refusals/scenario.ts"),
    ("none", "no experiment, or a style of the page", "web/src/i18n/bench.ts web/src/bench/Histogram.svelte web/src/bench/ScheduleTimeline.svelte"),
    ("none", "no limit of a plan", "web/src/i18n/plan.ts"),
    ("none", "no defect", "src/rig/setup/amplifier.cpp"),
    ("none", "no fault of the guard", "src/rig/setup/coil_guard.cpp"),
    ("none", "no exclusion", "src/sim/exclusion.cpp"),
    ("none", "no evidence", "src/study/identify/evidence.cpp src/study/pages/calibration/calibration_json.cpp"),
    ("none", "a value of boundary", "src/study/identify/identify_study.cpp"),
    ("none", "an option of FFmpeg",
     "src/vision/files/av_decoder.cpp src/vision/files/frame_encoder.cpp src/vision/files/remux.cpp"),
    ("none", "a text or a style of the page",
     "web/src/parts/export.ts web/src/parts/ReportFigure.svelte web/src/i18n/analyse.ts web/src/own/PictureView.svelte "
     "web/src/pages/runs/RunTable.svelte web/src/pages/tracks/HistogramCut.svelte web/src/results/plot_export.ts "
     "web/src/video/ContrastPanel.svelte"),
    ("none", "no notifications", "web/src/pages/JobsPage.svelte"),
    ("none", "no recording that can be shown", "web/src/pages/runs/ReplayPage.svelte"),
    ("rig", "the section [rig]",
     "src/app/bench/bench_controls.cpp src/app/bench/simulated_bench.cpp src/app/bench/step_response.cpp "
     "src/app/recording/manifest.cpp src/app/scenario/scenario.h src/rig/bench/bench_rig.cpp src/server/api/gallery.cpp src/server/runs/run_card.cpp"),
    ("rig", "the verb", "src/app/bench/bench_process.cpp src/cli/verbs/rig/rig.cpp"),
    ("rig", "the file of a coil system, as an argument or a key",
     "src/app/files/library_file.cpp src/cli/options/field.cpp src/cli/verbs/field/fit.cpp src/cli/verbs/schema.cpp "
     "src/server/jobs/job_kinds.cpp src/server/jobs/job_estimate.cpp src/study/coils/field_library.cpp"),
    ("path", "the place of a file or of a value, as a JSON key",
     "src/server/api/folders.cpp src/server/api/results.cpp src/server/experiments/experiment_changes.cpp "
     "src/server/experiments/experiment_store.cpp src/study/pages/provenance_output.cpp"),
    ("path", "a feature of a track", "src/study/tracks/track_features.h"),
    ("path", "a curve that is drawn on the picture",
     "web/src/drawing.svelte.ts web/src/workbench/DrawArea.svelte web/src/workbench/DrawBar.svelte web/src/workbench/Stage.svelte"),
    ("path", "an SVG element", "web/src/results/plot_drawing.ts web/src/parts/ReportFigure.svelte"),
    ("route", "a label or a layer of a picture", "src/study/pages/run_figures.cpp web/src/workbench/Stage.svelte"),
    ("simulated", "the word of a trait", "src/core/traits.h"),
    ("thesis", "a section of the gallery", "src/server/scenarios/gallery_index.cpp web/src/gallery.ts"),
    ("visible", "a label, a parameter or a style",
     "src/sim/starts/edge.cpp src/study/pages/run_figures.cpp web/src/view/Microscope.svelte web/src/own/own.ts"),
)
# Comparison of a string with p.type, p.name() or j["type"], in either order. The empty string and the types of JSON Schema,
# of input elements and of events in the browser are not parts.
WHAT = r'(?:\.(?:type|name)(?:\(\))?|\["(?:type|name)"\])'
KIND = "(?:|number|integer|string|boolean|array|object|const|checkbox|range|pointerup|keydown)"
COMPARED = re.compile(rf'{WHAT} *[!=]==? *["\'](?!{KIND}["\'])|["\'] *[!=]==? *[\w.\[\]>-]*{WHAT}')
LIST = "src/app/parts.cpp"
SOURCES = ("src/**/*.cpp", "src/**/*.h", "web/src/**/*.ts", "web/src/**/*.svelte")


def part_names(program):
    out = subprocess.run([program, "parts", "--json"], check=True, capture_output=True, text=True).stdout
    return {name for kind in json.loads(out).values() for name in kind}


def own_file(text, name):
    """Whether the file describes the part: it has a schema with this name."""
    return re.search(r'(?:Schema<[\w:]+>(?: \w+)?\(|_schema\(|return \{)\s*"' + re.escape(name) + '"', text) is not None


def strings_in(text):
    """Line number and content of the string literals in C++ or TypeScript code, without comments."""
    for number, line in enumerate(text.splitlines(), 1):
        code = re.sub(r"^\s*//.*$|(?<=[\s;{}])//.*$", "", line)
        for found in re.finditer(r'"((?:[^"\\]|\\.)*)"|\'([a-z_]+)\'', code):
            yield number, found[1] if found[1] is not None else found[2]


def misused(root, names):
    """Messages about names of parts that are not permitted where they are, and about unused entries."""
    chosen = {(file, name) for file, words in CHOSEN.items() for name in words}
    other = {(file, name) for name, _, files in OTHER_MEANINGS for file in files.split()}
    used = set()
    for file in (f for pattern in SOURCES for f in sorted(root.glob(pattern))):
        here = file.relative_to(root).as_posix()
        text = file.read_text()
        for number, line in enumerate(text.splitlines(), 1):
            if COMPARED.search(line.split("//")[0]):
                yield f"{here}:{number}: a type or a name is compared with a string; use a trait, a role or an enum"
        for number, word in strings_in(text):
            if word not in names or here == LIST or own_file(text, word):
                continue
            if (here, word) in chosen | other:
                used.add((here, word))
            else:
                yield f'{here}:{number}: "{word}" is the name of a part; use a trait, or add its other meaning to tools/check_parts.py'
    for here, word in sorted((chosen | other) - used):
        yield f'tools/check_parts.py: {here} no longer contains "{word}"; remove the entry'


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--program", required=True, help="the program, for example build/faba")
    options.add_argument("--root", type=pathlib.Path, required=True, help="folder of the project")
    o = options.parse_args()
    names = part_names(o.program)
    wrong = list(misused(o.root, names))
    print("\n".join(wrong) or f"{len(names)} names of parts, no violations")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
