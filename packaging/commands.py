#!/usr/bin/python3
"""Writes the manual pages and the bash completion of Faba from the description that the program gives of its commands.

    packaging/commands.py PROGRAM EXAMPLES OUT [--run WORD ...]

EXAMPLES has the folders scenes, rigs and studies, whose names are completed. OUT gets man/man1/*.1 and
bash-completion/completions/faba. --run: words before PROGRAM, an emulator of the processor that it is built for.
"""

import argparse
import datetime
import json
import os
import pathlib
import re
import subprocess

FILES = """\
.TP
.I runs/
run directories and results of measurements, in the current folder
.TP
.I share/faba
examples (scenes, rigs, studies) and the documentation, under the prefix of the installation"""

ENVIRONMENT = """\
.TP
.B FABA_PROGRAM
the program that the Python package calls; default: the one that was installed with it, then
.B PATH
.TP
.B TMPDIR
folder of temporary files; default:
.I /tmp"""


def roff(text):
    """Text as roff: backslashes, hyphens of options, and dots at the start of a line are escaped."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    text = re.sub(r"`([^`]*)`", r"\\fB\1\\fR", text)
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.split("\n"))


def one_line(verb):
    return verb["description"]


def value_of(option):
    """The value of an option as it is written in a synopsis: N, TEXT or the permitted words."""
    kind = option["type"]
    if kind == "flag":
        return ""
    words = re.search(r"\{(.*)\}", kind)
    if words:
        return words[1].replace(",", "|")
    return kind.split(":")[0].replace("UINT", "N").replace("INT", "N").replace("FLOAT", "X")


def synopsis(verb):
    words = [f"\\fBfaba {roff(verb['name'])}\\fR"]
    if any(not o.get("positional") for o in verb["options"]):
        words.append("[\\fIoptions\\fR]")
    for o in verb["options"]:
        if o.get("positional"):
            word = f"\\fI{roff(o['name'])}\\fR" + (" ..." if o.get("several") else "")
            words.append(word if o.get("required") else f"[{word}]")
    return " ".join(words)


def option_entry(option):
    names = [f"\\fB{roff(n)}\\fR" for n in (option.get("short"), option["name"]) if n]
    value = value_of(option)
    head = f"\\fI{roff(option['name'])}\\fR" if option.get("positional") else ", ".join(names) + (f" \\fI{roff(value)}\\fR" if value else "")
    range_of = re.search(r":([^{]+ to .+)$", option["type"])
    text = option["description"] + (f" ({range_of[1]})" if range_of else "")
    return f".TP\n{head}\n{roff(text)}"


def footer_sections(footer):
    """The sections that the help has after the options, by their titles: {"Examples": lines, "Exit codes": lines}."""
    sections = {}
    for block in footer.strip().split("\n\n"):
        title, _, rest = block.partition(":")
        if title in ("Examples", "Exit codes"):
            sections[title] = rest.strip("\n").split("\n")
    return sections


def exit_status(lines):
    entries = [part.strip() for part in " ".join(lines).split(", ")]
    out, code = [], None
    for entry in entries:
        match = re.match(r"(\d+) (.*)", entry)
        if match:
            code = match[1]
            out.append([code, match[2]])
        else:
            out[-1][1] += ", " + entry
    return "\n".join(f".TP\n.B {code}\n{roff(text)}" for code, text in out)


def examples(lines):
    return ".nf\n" + "\n".join(roff(line.strip()) for line in lines) + "\n.fi"


def page(name, version, date, sections):
    text = f'.TH {name.upper()} 1 {date} "Faba {version}" "Faba manual"\n'
    return text + "\n".join(f".SH {title}\n{body}" for title, body in sections if body) + "\n"


def verb_page(verb, verbs, version, date):
    name = "faba-" + verb["name"].replace(" ", "-")
    inner = [v for v in verbs if v["name"].startswith(verb["name"] + " ")]
    footer = footer_sections(verb.get("footer", ""))
    arguments = [option_entry(o) for o in verb["options"] if o.get("positional")]
    options = [option_entry(o) for o in verb["options"] if not o.get("positional")]
    commands = [f".TP\n.BR faba\\-{roff(v['name'].replace(' ', '-'))} (1)\n{roff(one_line(v))}" for v in inner]
    return page(name, version, date, [
        ("NAME", f"{roff(name)} \\- {roff(verb['description'])}"),
        ("SYNOPSIS", f"\\fBfaba {roff(verb['name'])}\\fR \\fIcommand\\fR [\\fIoptions\\fR]" if inner else synopsis(verb)),
        ("DESCRIPTION", roff(verb["description"]) + "."),
        ("COMMANDS", "\n".join(commands)),
        ("ARGUMENTS", "\n".join(arguments)),
        ("OPTIONS", "\n".join(options)),
        ("EXAMPLES", examples(footer["Examples"]) if "Examples" in footer else ""),
        ("EXIT STATUS", exit_status(footer["Exit codes"]) if "Exit codes" in footer else ""),
        ("SEE ALSO", ".BR faba (1)")])


def main_page(verbs, version, date):
    top = [v for v in verbs if " " not in v["name"]]
    commands = "\n".join(f".TP\n.BR faba\\-{roff(v['name'])} (1)\n{roff(one_line(v))}" for v in top)
    codes = next(footer_sections(v["footer"])["Exit codes"] for v in verbs if "Exit codes" in footer_sections(v.get("footer", "")))
    return page("faba", version, date, [
        ("NAME", "faba \\- laboratory for magnetotactic bacteria"),
        ("SYNOPSIS", "\\fBfaba\\fR \\fIcommand\\fR [\\fIoptions\\fR]"),
        ("DESCRIPTION", roff("Faba simulates swarms of magnetotactic bacteria in the field of magnetic coils, steers them with feedback controllers, "
                             "measures their motion in microscope videos, identifies models with intervals, and runs the same controllers on a bench. "
                             "Runs are reproducible bit for bit.")),
        ("COMMANDS", commands),
        ("FILES", FILES),
        ("ENVIRONMENT", ENVIRONMENT),
        ("EXIT STATUS", exit_status(codes)),
        ("EXAMPLES", examples(["faba run steer", "faba lab", "faba init first-steps"])),
        ("SEE ALSO", ", ".join(f".BR faba\\-{roff(v['name'])} (1)" for v in top[:1]) + "\n.PP\n"
         "The documentation is in\n.IR share/faba/docs/index.html\nunder the prefix of the installation.")])


def completion(verbs, example_folder):
    """A bash completion: commands, options, permitted words, names of examples, and files."""
    names = {folder: sorted(p.stem for p in (example_folder / folder).glob("*.toml")) for folder in ("scenes", "rigs", "studies")}
    kind_of = {"scene": "scenes", "rig": "rigs", "study": "studies"}
    lines = ["# Completion of faba for bash; written by packaging/commands.py.", "_faba()", "{", "    local cur prev words cword",
             "    _init_completion || return", "    local verb=${words[1]} inner=${words[2]} options= choices= examples="]
    top = [v["name"] for v in verbs if " " not in v["name"]]
    lines += ["    if ((cword == 1)); then", f"        COMPREPLY=($(compgen -W \"{' '.join(top)} --help --version\" -- \"$cur\"))", "        return", "    fi"]
    groups = sorted({v["name"].split()[0] for v in verbs if " " in v["name"]})
    lines += ["    case $verb in"]
    for group in groups:
        inner = [v["name"].split()[1] for v in verbs if v["name"].startswith(group + " ")]
        lines += [f"        {group})", "            if ((cword == 2)); then",
                  f"                COMPREPLY=($(compgen -W \"{' '.join(inner)} --help\" -- \"$cur\"))", "                return", "            fi",
                  "            verb+=\" $inner\"", "            ;;"]
    lines += ["    esac", "    case $verb in"]
    for v in verbs:
        if v["name"] in groups:
            continue
        flags = [n for o in v["options"] if not o.get("positional") for n in (o["name"], o.get("short")) if n]
        positional = next((o["name"] for o in v["options"] if o.get("positional")), "")
        shown = names.get(kind_of.get(positional, ""), [])
        lines += [f"        \"{v['name']}\")", f"            options=\"{' '.join(flags)}\"", f"            examples=\"{' '.join(shown)}\""]
        choices = [(o, re.search(r"\{(.*)\}", o["type"])) for o in v["options"]]
        choices = [(o, m[1].replace(",", " ")) for o, m in choices if m]
        if choices:
            lines += ["            case $prev in"]
            lines += [f"                {'|'.join(n for n in (o['name'], o.get('short')) if n)}) choices=\"{words}\" ;;" for o, words in choices if not o.get("positional")]
            lines += ["            esac"]
            lines += [f"            [[ $cur == -* ]] || examples+=\" {words}\"" for o, words in choices if o.get("positional")]
        lines += ["            ;;"]
    lines += ["    esac", "    if [[ $choices ]]; then", "        COMPREPLY=($(compgen -W \"$choices\" -- \"$cur\"))",
              "    elif [[ $cur == -* ]]; then", "        COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"))", "    else", "        _filedir",
              "        [[ $prev == -* ]] || COMPREPLY+=($(compgen -W \"$examples\" -- \"$cur\"))", "    fi", "} && complete -F _faba faba"]
    return "\n".join(lines) + "\n"


def main():
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("program", type=pathlib.Path)
    cli.add_argument("examples", type=pathlib.Path)
    cli.add_argument("out", type=pathlib.Path)
    cli.add_argument("--run", nargs="*", default=[])
    o = cli.parse_args()
    command = [*o.run, str(o.program)]
    verbs = json.loads(subprocess.run([*command, "schema", "verbs"], check=True, capture_output=True).stdout)["verbs"]
    version = subprocess.run([*command, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
    # The date of the source, so that a package has the same bytes whenever it is built.
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0")) or (o.examples / "CHANGELOG.md").stat().st_mtime
    date = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc).strftime("%Y-%m-%d")
    manual = o.out / "man/man1"
    manual.mkdir(parents=True, exist_ok=True)
    (manual / "faba.1").write_text(main_page(verbs, version, date))
    for verb in verbs:
        (manual / f"faba-{verb['name'].replace(' ', '-')}.1").write_text(verb_page(verb, verbs, version, date))
    completions = o.out / "bash-completion/completions"
    completions.mkdir(parents=True, exist_ok=True)
    (completions / "faba").write_text(completion(verbs, o.examples))


if __name__ == "__main__":
    main()
