"""The checks of study_engines_test.py on hosts of GNU parallel. A program with the name ssh stands for the hosts of a laboratory: `lab1` is
this computer; on `bare` the path of the program leads nowhere, on `apart` that of the study; no other host is reached."""

import os
import shutil

SSH = """#!/bin/bash
while [ "$1" != -- ]; do host=$1; shift; done
shift
echo "$host" >> FOLDER/ssh.log
case $host in
  lab1) [ -e FOLDER/lost ] || exec bash -c "$*" ;;
  bare | apart) SHELL=FOLDER/bin/$host exec bash -c "$*" ;;
esac
echo "ssh: connect to host $host port 22: No route to host" >&2
exit 255
"""

# The shell of a host on which a path leads nowhere. GNU parallel gives it a file with the command.
SHELL = """#!/bin/bash
command=$(< "$1")
exec bash -c "${command//"PATH"//absent}"
"""


def run(test):
    path = os.environ["PATH"]
    programs = test.folder / "bin"
    programs.mkdir()
    scripts = {
        "ssh": SSH.replace("FOLDER", str(test.folder)),
        "bare": SHELL.replace("PATH", str(test.program)),
        "apart": SHELL.replace("PATH", str(test.folder / "hosts")),
    }
    for name, text in scripts.items():
        (programs / name).write_text(text)
        (programs / name).chmod(0o755)
    os.environ["PATH"] = f"{programs}:{path}"
    try:
        hosts(test)
        refused(test)
        lost(test)
    finally:
        os.environ["PATH"] = path


def command(out, *hosts):
    return ("compare-controllers", "controllers.toml", "--quiet", "--out", out, "--engine", "parallel",
            *(word for host in hosts for word in ("--sshlogin", host)))


def hosts(test):
    """Workers on two hosts."""
    done = test.faba(*command("two-hosts", "1/user@lab1", "1/:"))
    test.check(done.returncode == 0, f"parallel, two hosts {done.stderr}")
    test.equal("controllers", "two-hosts", "parallel, two hosts")
    log = test.log("two-hosts")
    test.check("host user@lab1: exit code 0" in log and "this computer: exit code 0" in log, "parallel: both hosts computed tasks")


def refused(test):
    """A host that cannot compute tasks is named before anything is computed."""
    expected = {"off": "host off was not reached (ssh: connect to host off port 22: No route to host)",
                "bare": f"host bare has no program {test.program}",
                "apart": "host apart cannot read the directory"}
    for host, message in expected.items():
        done = test.faba(*command(f"hosts/{host}", "1/:", f"2/{host}"))
        test.check(done.returncode == 2 and message in done.stderr, f"parallel: {done.stderr.strip()}")
        test.check(not any((test.folder / f"hosts/{host}/results").glob("*")), f"parallel, {host}: nothing was computed")


def lost(test):
    """A host is lost in the middle: the other one computes its attempts."""
    out, mark, log = "lost-host", test.folder / "lost", test.folder / "ssh.log"
    test.write_slow(seeds=10, duration="2000 s")
    test.compute("slow")
    words = command(out, "1/lab1", "1/:")
    run = test.start(words[0], "slow.toml", *words[2:])
    test.wait_for_results(run, out, 100)
    mark.touch()
    calls = log.read_text().count("lab1")
    code = run.wait()
    test.check(log.read_text().count("lab1") > calls, "parallel: the lost host was given tasks")
    mark.unlink()
    test.check(code == 0 and "exit code 255" not in test.log(out), f"parallel: a host was lost, exit code {code} {run.stderr.read()}")
    test.equal("slow", out, "parallel, a host was lost")
    shutil.rmtree(test.folder / out)
