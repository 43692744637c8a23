"""Calls the program and caches its output: a step with the same program, arguments and input files is not repeated."""

import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import tempfile
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
WRITES_A_FOLDER = ("run", "identify", "compare-controllers")
SHOWN = 60_000  # characters of an input that the page shows


class Failed(Exception):
    """A call of the program failed."""


@dataclasses.dataclass
class Step:
    """One call of the program: its output folder, and its standard output as parsed JSON (or as text)."""

    folder: pathlib.Path
    answer: object
    key: str


class Lab:
    """Runs and caches steps. An argument "@FILE" is a file in the folder of the step, "@NAME/FILE" one in the folder of the step NAME."""

    def __init__(self, program, out, force, progress):
        self.program, self.force, self.progress = program, force, progress
        self.out = pathlib.Path(os.path.relpath(out, ROOT)) if out.is_relative_to(ROOT) else out
        self.commands, self.files, self.steps, self.written = [], [], {}, {}
        tables = sorted(p for folder in ("scenes", "studies", "rigs") for p in (ROOT / folder).glob("*.toml"))
        self.base = _digest(program.read_bytes(), *(p.read_bytes() for p in tables))
        self.version = self._run(["--version"]).stdout.strip()

    def at(self, name, file=""):
        return self.out / name / file

    def write(self, name, file, content, shown=True):
        """Writes an input file to OUT/NAME/FILE; gives the path to pass to the program."""
        path = ROOT / self.at(name, file)
        path.parent.mkdir(parents=True, exist_ok=True)
        data = content.encode() if isinstance(content, str) else content
        if not path.exists() or path.read_bytes() != data:
            path.write_bytes(data)
        self.written[str(self.at(name, file))] = _digest(data)
        if shown and isinstance(content, str) and len(content) < SHOWN:
            self.files.append((str(self.at(name, file)), content))
        return str(self.at(name, file))

    def call(self, name, *words, after=(), text=False):
        """Runs the step NAME; `after` are the steps whose output files an input file refers to."""
        return self.all([(name, *words)], after=after, text=text)[0]

    def run(self, name, scene, *words, seed=1, after=()):
        """Runs `faba run`; words of the form PATH=VALUE become `--set PATH=VALUE`."""
        return self.all([self.a_run(name, scene, *words, seed=seed)], after=after)[0]

    @staticmethod
    def a_run(name, scene, *words, seed=1):
        options = [w for word in words for w in (("--set", word) if "=" in word else (word,))]
        return (name, "run", scene, "--seed", str(seed), *options)

    def all(self, calls, after=(), text=False):
        """Runs independent steps in parallel."""
        jobs = [self._job(name, words, after, text) for name, *words in calls]
        self.commands += ["build/faba " + shlex.join(words) for _, words, _, _ in jobs]
        with concurrent.futures.ThreadPoolExecutor(min(len(jobs), os.cpu_count() or 1)) as pool:
            work = [pool.submit(self._do, job, len(jobs) > 1) for job in jobs]
            try:
                steps = [w.result() for w in work]
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        self.steps |= {name: step for (name, *_), step in zip(jobs, steps)}
        return steps

    def _job(self, name, words, after, text):
        words = [self._path(name, w) for w in words]
        if words[0] in WRITES_A_FOLDER:
            words += ["--out", str(self.at(name)), "--force"]
        needs = [s.key for s in after] + [self.written.get(w) or self._key_of(w, name) for w in words]
        return name, words, text, _digest(self.base, json.dumps([words, needs, text]))

    def _do(self, job, several):
        name, words, text, key = job
        marker, folder = ROOT / self.out / "steps" / f"{name.replace('/', '-')}.json", ROOT / self.at(name)
        fresh = name in self.steps and self.steps[name].key == key  # already computed in this call: --force need not repeat it
        if marker.exists() and folder.exists() and (fresh or not self.force):
            kept = json.loads(marker.read_text())
            if kept["key"] == key:
                return Step(folder, kept["answer"], key)
        self.progress(name)
        marker.unlink(missing_ok=True)
        if words[0] in WRITES_A_FOLDER:  # the program creates the folder and refuses one that it did not create
            shutil.rmtree(folder, ignore_errors=True)
            folder.parent.mkdir(parents=True, exist_ok=True)
        else:
            folder.mkdir(parents=True, exist_ok=True)
        started = time.monotonic()
        quietly = ["--quiet", *([] if text else ["--json"]), *(["--threads", "1"] if several and words[0] == "run" else [])]
        done = self._run([*words, *quietly])
        if done.returncode:
            raise Failed(f"build/faba {shlex.join(words)}: {(done.stderr or done.stdout).strip()[-600:]}")
        kept = {"key": key, "seconds": round(time.monotonic() - started, 2), "answer": done.stdout if text else json.loads(done.stdout)}
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.with_suffix(".tmp").write_text(json.dumps(kept))
        marker.with_suffix(".tmp").rename(marker)
        return Step(folder, kept["answer"], key)

    def page(self, scene):
        """A running live lab, as a context manager: `with lab.page("scenes/x.toml") as page`."""
        return Page(self.program, scene)

    def help(self, verb):
        return self._run([verb, "--help"]).stdout

    def _path(self, name, word):
        if not word.startswith("@"):
            return word
        other, _, file = word[1:].rpartition("/")
        return str(self.at(other or name, file))

    def _key_of(self, word, own):
        """The key of the step whose file `word` names; "" if it names no file of another step."""
        within, _, path = word.partition(f"{self.out}/")
        parts = [] if within else path.split("/")
        for n in range(len(parts), 0, -1):
            name = "/".join(parts[:n])
            if name in self.steps and name != own:
                return self.steps[name].key
        return ""

    def _run(self, words):
        return subprocess.run([str(self.program), *words], cwd=ROOT, capture_output=True, text=True)


def _digest(*parts):
    h = hashlib.sha256()
    for p in parts:
        h.update(p if isinstance(p, bytes) else p.encode())
        h.update(b"\0")
    return h.hexdigest()


class Page:
    """A client of `faba lab`."""

    def __init__(self, program, scene):
        self.program, self.scene = program, scene

    def __enter__(self):
        words = [str(self.program), "lab", self.scene, "--no-browser", "--json"]
        self.server = subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        self.address = json.loads(self.server.stdout.readline())["address"]
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def get(self, path):
        """The JSON response of a GET request."""
        origin, token = self.address.split("/?token=")
        request = urllib.request.Request(origin + path, headers={"Authorization": "Bearer " + token})
        with urllib.request.urlopen(request) as answer:
            return json.load(answer)

    def picture(self):
        """A screenshot of the page as PNG; None if no browser is installed."""
        browser = shutil.which("chromium")
        if not browser:
            return None
        with tempfile.TemporaryDirectory() as folder:
            png = pathlib.Path(folder) / "page.png"
            subprocess.run(
                [browser, "--headless", "--no-sandbox", "--hide-scrollbars", f"--user-data-dir={folder}/profile", "--window-size=1280,800",
                 "--virtual-time-budget=6000", f"--screenshot={png}", self.address],
                capture_output=True, timeout=120,
            )  # fmt: skip
            return png.read_bytes() if png.exists() else None
