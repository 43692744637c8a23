"""Measurements from Python: arrays and files, equal to the program and to known truth."""

import pathlib
import tempfile
import unittest

import numpy as np
from common import ROOT, SMALL, faba as program, main

import faba


class Fields(unittest.TestCase):
    def test_the_field_is_that_of_the_program(self):
        currents = [0.3, -0.2, 0.1, 0.4]
        text = (ROOT / "rigs/thesis-four-coils.toml").read_text()
        for current in currents:  # default currents, which the program uses
            text = text.replace("[[coil]]\n", f"[[ coil ]]\ncurrent = {current}\n", 1)
        with tempfile.TemporaryDirectory() as folder:
            rig, points = pathlib.Path(folder) / "rig.toml", pathlib.Path(folder) / "points.csv"
            rig.write_text(text)
            points.write_text("x_m,y_m,z_m\n0,0,0\n1e-3,-2e-3,0.5e-3\n")
            wanted = program("field", "at", rig, "--points", points)
            f = faba.Field(rig)
        self.assertEqual(list(f.currents), currents)
        b = f.at([[0, 0, 0], [1e-3, -2e-3, 0.5e-3]])
        np.testing.assert_allclose(b, wanted["b_t"], rtol=1e-12)
        self.assertGreater(np.abs(b).max(), 1e-6)
        np.testing.assert_array_equal(f.at(np.zeros((2, 3, 2))).shape, (2, 3, 3))
        one = f.at([0.0, 0.0], currents=[1, 0, 0, 0]) - f.at([0.0, 0.0], currents=[0, 0, 0, 0])
        two = f.at([0.0, 0.0], currents=[2, 0, 0, 0]) - f.at([0.0, 0.0], currents=[0, 0, 0, 0])
        np.testing.assert_allclose(two, 2 * one, rtol=1e-9)

    def test_currents_for_a_field_and_a_zero(self):
        f = faba.Field(ROOT / "rigs/thesis-four-coils.toml")
        wanted = np.array([1e-4, -5e-5])
        currents = f.currents_for(wanted)
        made = f.at([0.0, 0.0], currents) - f.at([0.0, 0.0], np.zeros(f.coils))
        np.testing.assert_allclose(made[:2], wanted, rtol=1e-9)
        null = f.null((3e-4, 0.0), polarity=-1)
        self.assertTrue(null["reachable"])
        self.assertLess(np.abs(f.at([3e-4, 0.0], null["currents"])[:2]).max(), 1e-9)


class Pictures(unittest.TestCase):
    def test_flow_of_a_moved_pattern(self):
        y, x = np.mgrid[0:96, 0:128].astype(float)

        def pattern(dx, dy):
            return 128 + 50 * np.sin((x - dx) / 6) + 40 * np.cos((y - dy) / 7)

        flow = faba.flow(pattern(0, 0), pattern(0.4, -0.3), options={"alpha2": 1})
        self.assertEqual(flow.shape, (96, 128, 2))
        inner = flow[20:-20, 20:-20].reshape(-1, 2).mean(axis=0)
        # Horn and Schunck is biased towards zero; a tenth of the displacement is far above its error here.
        np.testing.assert_allclose(inner, [0.4, -0.3], atol=0.04)
        np.testing.assert_array_equal(flow, faba.flow(pattern(0, 0), pattern(0.4, -0.3), options={"alpha2": 1}, threads=1))

    def test_distance_of_histograms(self):
        with tempfile.TemporaryDirectory() as folder:
            p, q = np.array([1.0, 5, 2, 0]), np.array([0.0, 3, 4, 1])
            for name, values in (("p", p), ("q", q)):
                np.savetxt(pathlib.Path(folder) / name, values)
            wanted = program("distance", pathlib.Path(folder) / "p", pathlib.Path(folder) / "q")["distance"][0]
        self.assertAlmostEqual(faba.distance(p, q), wanted, places=14)
        self.assertEqual(faba.distance(p, p), 0)

    def test_a_drop_of_an_array_is_that_of_the_file(self):
        s = faba.Simulation(SMALL, set={"record.as_seen": True})
        s.turn()
        picture = s.picture()
        found = faba.drop(picture)
        self.assertAlmostEqual(found["radius_px"], 220, delta=3)  # the scene has 220 px
        self.assertIn(found.quality, ("good", "doubtful", "poor"))

    def test_tracks_of_an_array_of_frames(self):
        s = faba.Simulation(SMALL, set={"record.as_seen": True, "swarm[0].count": 20, "swarm[0].start.radius_px": 120}, duration="2 s")
        frames = []
        while not s.finished:
            s.turn()
            frames.append(s.picture().copy())
        result = faba.track(np.array(frames), fps=30)
        self.assertIn("t_s", result.tracks.dtype.names)
        self.assertGreater(len(np.unique(result.tracks["track"])), 5)


class Described(unittest.TestCase):
    def test_parts_and_schema(self):
        self.assertIn("proportional", faba.parts("controller"))
        self.assertEqual(faba.parts()["model"]["dipole"]["properties"]["speed"]["x-unit"], "m/s")
        self.assertIn("swarm", faba.schema()["properties"])
        with self.assertRaises(faba.Error):
            faba.parts("controler")

    def test_help_names_the_options(self):
        for function in (faba.track, faba.activity, faba.identify, faba.scale, faba.drop):
            self.assertIn("Returns a Measurement", function.__doc__)
        self.assertIn("um_per_px", faba.track.__doc__)


class Errors(unittest.TestCase):
    def test_an_error_has_code_place_and_reason(self):
        with self.assertRaises(faba.Error) as caught:
            faba.Simulation(SMALL, set={"swarm[0].model.speed": "3 kg"})
        self.assertEqual(caught.exception.code, 2)
        self.assertIn("swarm[0].model.speed", caught.exception.where)
        self.assertIn("kg", caught.exception.what)
        with self.assertRaises(faba.Error) as caught:
            faba.identify("missing.toml")
        self.assertIn("missing.toml", caught.exception.where)


if __name__ == "__main__":
    main()
