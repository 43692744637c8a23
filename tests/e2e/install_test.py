#!/usr/bin/python3
"""`cmake --install` with a prefix: the installed program finds its files from any folder, also after the prefix was moved.

    tests/e2e/install_test.py --build build

The packages of Debian, in a bare root, are tested by tests/packaging/package_test.py.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path("build")
PYTHON = "/usr/bin/python3"


def state_hash(text):
    return json.loads(text)["state_hash"]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="faba-install-"))
        installed = cls.folder / "first prefix"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", installed], check=True, capture_output=True)
        cls.prefix = cls.folder / "moved prefix"
        installed.rename(cls.prefix)
        cls.empty = cls.folder / "empty"

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self):
        shutil.rmtree(self.empty, ignore_errors=True)
        self.empty.mkdir()

    def faba(self, *words, cwd=None, env=None, code=0):
        bare = {"PATH": "/usr/bin:/bin", "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run([self.prefix / "bin/faba", *words], cwd=cwd or self.empty, env=bare | (env or {}), capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_files_of_the_contract(self):
        for name in ("bin/faba", "share/man/man1/faba.1", "share/man/man1/faba-run.1", "share/bash-completion/completions/faba", "libexec/faba/faba-coil-guard",
                     "libexec/faba/faba-capture.so", "share/faba/scenes/steer.toml", "share/faba/rigs/helmholtz.toml", "share/icons/hicolor/scalable/apps/faba.svg"):
            self.assertTrue((self.prefix / name).is_file(), name)
        self.assertTrue(list((self.prefix / "share/applications").glob("*.desktop")))

    def test_libraries_are_not_searched_in_other_folders(self):
        for program in (BUILD / "faba", self.prefix / "bin/faba"):
            dynamic = subprocess.run(["readelf", "--dynamic", program], check=True, capture_output=True, text=True).stdout
            self.assertIn("NEEDED", dynamic)
            self.assertNotRegex(dynamic, "R(UN)?PATH", program)

    def test_same_bits_without_a_home_folder(self):
        words = ("run", "steer", "--seed", "1", "--duration", "1 s", "--json")
        here = subprocess.run([BUILD / "faba", *words, "--out", self.empty / "here"], check=True, capture_output=True, text=True)
        self.assertEqual(state_hash(self.faba(*words).stdout), state_hash(here.stdout))
        self.assertEqual([p.name for p in (self.empty / "runs").iterdir()], ["steer-1"])

    def test_guard_and_doctor(self):
        done = json.loads(self.faba("rig", "run", "bench", "--arm", "--duration", "1 s", "--json").stdout)
        self.assertGreater(done["frames"], 10)
        parts = {p["name"]: p for p in json.loads(self.faba("doctor", "--json").stdout)["parts"]}
        self.assertEqual(parts["coil guard"]["note"], str(self.prefix / "libexec/faba/faba-coil-guard"))
        self.assertEqual(parts["examples"]["note"], str(self.prefix / "share/faba"))
        (self.prefix / "libexec/faba/faba-coil-guard").rename(self.prefix / "libexec/faba/away")
        try:
            parts = {p["name"]: p for p in json.loads(self.faba("doctor", "--json", code=1).stdout)["parts"]}
            self.assertFalse(parts["coil guard"]["present"])
        finally:
            (self.prefix / "libexec/faba/away").rename(self.prefix / "libexec/faba/faba-coil-guard")

    def test_examples_by_name_and_as_copies(self):
        self.faba("field", "map", "helmholtz", "--current", "1,0", "--check")
        message = self.faba("run", "steeer", code=2).stderr
        self.assertIn("steer", message.split("steeer", 1)[1])
        message = self.faba("identify", "steer", code=2).stderr
        self.assertIn("is a scenario, which this command does not take", message)
        self.assertNotIn("did you mean", message)
        message = self.faba("identify", "step-response", code=3).stderr
        self.assertIn("record it first", message)
        message = self.faba("run", "scenes/steer.toml", code=2).stderr
        self.assertIn("faba init", message)
        self.faba("init")
        self.faba("run", "scenes/steer.toml", "--duration", "0.2 s", "--quiet")
        self.faba("init")  # equal copies may be written again
        (self.empty / "scenes/steer.toml").write_text("# mine\n")
        (self.empty / "scenes/drop.toml").unlink()
        self.assertIn("--force", self.faba("init", code=2).stderr)
        self.assertFalse((self.empty / "scenes/drop.toml").exists(), "a refused copy wrote files")
        self.faba("init", "--force")
        self.assertIn("[", (self.empty / "scenes/steer.toml").read_text())

    def test_a_file_has_priority_over_an_example(self):
        shutil.copy(self.prefix / "share/faba/scenes/steer.toml", self.empty / "steer")
        with (self.empty / "steer").open("a") as file:
            file.write("\nunknown_key = 1\n")
        self.assertIn("unknown_key", self.faba("run", "steer", code=2).stderr)

    def test_gallery_of_the_lab(self):
        code = ("import http.cookiejar, json, subprocess, sys, urllib.request as u; "
                "p = subprocess.Popen([sys.argv[1], 'lab', '--no-browser', '--json'], stdout=subprocess.PIPE); a = json.loads(p.stdout.readline())['address']; "
                "o = u.build_opener(u.HTTPCookieProcessor(http.cookiejar.CookieJar())); o.open(a).read(); "
                "print(o.open(a.split('/?')[0] + '/api/scenes').read().decode()); p.terminate(); p.wait()")
        done = subprocess.run([PYTHON, "-c", code, self.prefix / "bin/faba"], cwd=self.empty, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("thesis-basic", done.stdout)

    def test_python_package(self):
        package = self.prefix / "lib/python3/dist-packages"
        if not package.exists():
            self.skipTest("the Python package was not built; `make python` builds it")
        code = "import faba; s = faba.Simulation('steer', seed=1, set={'duration': '1 s'}); s.run(); print(faba.__file__); print(s.state_hash)"
        env = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(package), "PYTHONDONTWRITEBYTECODE": "1"}
        out = subprocess.run([PYTHON, "-c", code], cwd=self.empty, env=env, check=True, capture_output=True, text=True).stdout.split("\n")
        self.assertEqual(out[0], str(package / "faba/__init__.py"))
        self.assertEqual(out[1], state_hash(self.faba("run", "steer", "--seed", "1", "--duration", "1 s", "--json").stdout))
        self.assertFalse((package / "faba/measure.py").exists(), "a file of another version was installed")

    def test_manual_and_completion(self):
        if not shutil.which("man"):
            self.skipTest("man is not installed")
        shown = subprocess.run(["man", "-l", self.prefix / "share/man/man1/faba-field-map.1"], check=True, capture_output=True, text=True,
                               env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "MANWIDTH": "100"}).stdout
        self.assertIn("--current TEXT", shown)
        subprocess.run(["bash", "-n", self.prefix / "share/bash-completion/completions/faba"], check=True)

    def test_a_folder_without_permission(self):
        if os.geteuid() == 0:  # root may write everywhere, except into /proc
            self.assertIn("/proc", self.faba("run", "steer", "--duration", "1 s", "--out", "/proc/run", code=1).stderr)
            return
        self.empty.chmod(0o555)
        try:
            self.assertIn("runs", self.faba("run", "steer", "--duration", "1 s", code=1).stderr)
        finally:
            self.empty.chmod(0o755)


if __name__ == "__main__":
    cli = argparse.ArgumentParser()
    cli.add_argument("--build", type=pathlib.Path, default=BUILD)
    options, rest = cli.parse_known_args()
    BUILD = options.build.resolve()
    unittest.main(argv=[sys.argv[0], *rest])
