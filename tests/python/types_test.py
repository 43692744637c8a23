"""Types: mypy --strict accepts the package and a client of it, rejects wrong calls, and the stub file agrees with the module in C++."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from common import SHARED, main

import faba
from faba import _faba

PACKAGE = pathlib.Path(faba.__file__).resolve().parent
GYMNASIUM = SHARED / "clients/gymnasium"
CLIENT = '''
import numpy as np
import numpy.typing as npt

import faba


class Mine(faba.Controller):
    def update(self, estimate: faba.Estimate, target: faba.Target, dt: float) -> npt.NDArray[np.float64]:
        return self.context.currents_for_direction(target.position - estimate.centroid, at=estimate.centroid)


class Seen(faba.Estimator):
    def update(self, observation: faba.Observation, last: npt.NDArray[np.float64]) -> faba.Estimate:
        return faba.Estimate(observation.t, observation.positions.mean(axis=0), len(observation.positions))


simulation = faba.Simulation({"swarm": []}, seed=1, set={"swarm[0].count": 3}, controller=Mine)
x: npt.NDArray[np.float32] = simulation.run(3).state["x"]
run: faba.Run = faba.run("scene.toml", controller=Mine(), estimator=Seen, progress=lambda done, total: None)
rows: int = len(run.series)
values: npt.NDArray[np.float64] = faba.simulate("scene.toml", {"seed": [1]}, range(3), "iae_px_s")
measured: faba.Measurement = faba.track(np.zeros((3, 8, 8)), fps=30, region=[0, 0, 8, 8])
quality: str = measured.quality
b: npt.NDArray[np.float64] = faba.Field("rig.toml").at([[0.0, 0.0]])
try:
    faba.resume("runs/a")
except faba.Error as e:
    code: int = e.code
'''
WRONG = [
    'faba.Simulation("scene.toml", treads=2)',
    'faba.Simulation("scene.toml").state_hash()',
    'faba.Simulation("scene.toml").turn(command="1")',
    'faba.run("scene.toml").serie',
    'faba.drop()',
    'faba.field_fit("rig.toml")',
    'faba.Drift(1)',
    'faba.Target((0, 0)).index = 3',
]


def mypy(module, *arguments, folder):
    """Runs a module of mypy on copies in a folder."""
    configuration = pathlib.Path(folder) / "mypy.ini"
    configuration.write_text("[mypy]\nstrict = True\nignore_missing_imports = True\n[mypy-gymnasium.*]\nfollow_imports = silent\n"
                             "[mypy-xarray.*]\nfollow_imports = skip\n")  # large, and its objects are Any in the package
    path = [str(PACKAGE.parent)] + ([str(GYMNASIUM)] if GYMNASIUM.is_dir() else [])
    option = "--mypy-config-file" if module == "mypy.stubtest" else "--config-file"
    words = [sys.executable, "-m", module, option, str(configuration), *map(str, arguments)]
    environment = {**os.environ, "MYPYPATH": ":".join(path), "PYTHONPATH": str(PACKAGE.parent)}
    return subprocess.run(words, capture_output=True, text=True, check=False, cwd=folder, env=environment)


@unittest.skipIf(importlib.util.find_spec("mypy") is None, "mypy is not installed: make python")
class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()  # with the cache of mypy, which all tests use
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def accepts(self, module, *arguments):
        done = mypy(module, *arguments, folder=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_package(self):
        names = [p.stem for p in PACKAGE.glob("*.py") if p.stem not in ("__init__", "environments")]
        self.assertGreater(len(names), 5)
        self.accepts("mypy", "-p", "faba._faba", "-m", "faba", *(word for n in names for word in ("-m", f"faba.{n}")))

    @unittest.skipUnless(GYMNASIUM.is_dir() or importlib.util.find_spec("gymnasium"), "gymnasium is not installed")
    def test_the_environments(self):
        self.accepts("mypy", "-m", "faba.environments")

    def test_the_stub_file_agrees_with_the_module(self):
        # pybind11 gives its classes a metaclass, and those that Python cannot make a constructor that raises.
        classes = [name for name, thing in vars(_faba).items() if isinstance(thing, type) and thing is not faba.Error]
        self.assertGreater(len(classes), 8)
        allowed = self.folder / "allowed.txt"
        allowed.write_text("".join(rf"faba\._faba\.{name}(\.__init__)?" + "\n" for name in classes))
        self.accepts("mypy.stubtest", "faba._faba", "--ignore-missing-stub", "--allowlist", allowed, "--ignore-unused-allowlist")

    def test_a_client(self):
        (self.folder / "client.py").write_text(CLIENT)
        self.accepts("mypy", "client.py")

    def test_wrong_calls_are_rejected(self):
        lines = ["import faba", *WRONG]
        (self.folder / "wrong.py").write_text("\n".join(lines) + "\n")
        done = mypy("mypy", "wrong.py", folder=self.folder)
        for number, line in enumerate(WRONG, 2):
            with self.subTest(line=line):
                self.assertIn(f"wrong.py:{number}: error", done.stdout)


if __name__ == "__main__":
    main()
