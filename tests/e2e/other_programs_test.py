#!/usr/bin/python3
"""Files of Faba in other programs: xarray (tracks.h5 of runs that were completed, killed, resumed, or are being written; tables of
`faba track`), tifffile (OME-TIFF and ImageJ TIFF), the CSV files for TrackMate and napari, and the RO-Crate of a run. Without the Debian
packages of xarray, h5netcdf and tifffile the exit code is 77.

    other_programs_test.py --program build/faba --root ."""

import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import h5netcdf
    import h5py
    import numpy
    import tifffile
    import xarray
except ImportError as e:
    print(f"SKIPPED: {e}; tools/setup.sh test installs it")
    sys.exit(77)

PROGRAM, ROOT = None, None


def faba(*arguments, code=0, cwd=None):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done


def scene(name):
    return ROOT / "scenes" / name


def example_of_guide(name):
    """The code below the comment `name` in docs/guide/other-programs.md."""
    return (ROOT / "docs/guide/other-programs.md").read_text().split(f"<!-- {name} -->")[1].split("```python")[1].split("```")[0]


def during_writing(file):
    """The data of a file that is being written, or whose writer was killed."""
    names = {}
    exec(example_of_guide("during a run").replace("runs/steer/tracks.h5", str(file)), names)
    return names["run"]


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.dir = pathlib.Path(self.temporary.name)


class TracksOfRuns(WithFolder):
    def check(self, dataset, file, rounded=False, writer="complete"):
        """Dimensions, units and values. `writer`: complete, killed, or running, so that the file can have more rows than the dataset."""
        positions = "position_steps" if rounded else "position_px"
        self.assertEqual(dataset[positions].dims, ("frame", "cell", "axis"))
        self.assertEqual(list(dataset.axis.values), ["x", "y"])
        self.assertEqual(dataset.cell.dtype, numpy.uint32)
        numpy.testing.assert_array_equal(dataset.cell, numpy.arange(dataset.sizes["cell"]))
        self.assertEqual(dataset.t_s.dims, ("frame",))
        self.assertIn("t_s", dataset[positions].coords)
        for name, variable in dataset.variables.items():
            self.assertTrue(variable.attrs["units"], name)
            self.assertTrue(variable.attrs["long_name"], name)
        rows = dataset.sizes["frame"]
        numpy.testing.assert_array_equal(numpy.diff(dataset.frame), dataset.attrs["every_frames"])
        with h5py.File(file, "r", swmr=writer != "complete") as f:
            for name in ("frame", "t_s", positions):
                (self.assertGreaterEqual if writer == "running" else self.assertEqual)(len(f[name]), rows, name)
            if not rounded:
                numpy.testing.assert_array_equal(dataset[positions].sel(axis="y", cell=2), f[positions][:rows, 2, 1])
        numpy.testing.assert_allclose(dataset.t_s, dataset.frame / dataset.attrs["fps"])

    def test_complete_run(self):
        faba("run", scene("steer.toml"), "--seed", 1, "--duration", "2 s", "--out", self.dir / "run", "--set", "motility.type=thesis",
             "--set", "record.video=false", "--set", "record.tracks_every=2")
        file = self.dir / "run/tracks.h5"
        with xarray.open_dataset(file, engine="h5netcdf") as data:
            self.check(data, file)
            self.assertEqual(data.responding.dims, ("frame", "cell"))
            self.assertEqual(data.frame.values[1], 2)
            self.assertEqual(data.position_px.attrs["units"], "px")

    def test_rounded_positions_decode_as_in_the_guide(self):
        common = ("run", scene("steer.toml"), "--seed", 1, "--duration", "3 s", "--set", "record.video=false")
        faba(*common, "--out", self.dir / "exact")
        faba(*common, "--out", self.dir / "rounded", "--set", "record.resolution_px=0.015625")
        names = {}
        exec(example_of_guide("rounded positions").replace("runs/long", str(self.dir / "rounded")), names)
        with xarray.open_dataset(self.dir / "exact/tracks.h5", engine="h5netcdf") as exact:
            self.assertEqual(names["position_px"].dims, exact.position_px.dims)
            self.assertLessEqual(float(abs(names["position_px"] - exact.position_px).max()), 0.5 * 0.015625 + 1e-4)
        with xarray.open_dataset(self.dir / "rounded/tracks.h5", engine="h5netcdf") as rounded:
            self.check(rounded, self.dir / "rounded/tracks.h5", rounded=True)

    def test_readable_as_soon_as_it_exists(self):
        for attempt in range(10):
            out = self.dir / f"started-{attempt}"
            running = subprocess.Popen([PROGRAM, "run", scene("steer.toml"), "--seed", "3", "--set", "record.video=false", "--quiet", "--out", out])
            file = out / "tracks.h5"
            while not file.exists() and running.poll() is None:
                pass
            running.kill()
            running.wait()
            with h5py.File(file, "r", swmr=True) as data:
                self.assertEqual(data["position_px"].shape[2], 2)

    def test_killed_read_and_resumed(self):
        out, entire = self.dir / "killed", self.dir / "entire"
        common = ("run", scene("steer.toml"), "--seed", 3, "--duration", "120 s", "--set", "record.video=false", "--set",
                  "record.checkpoint=0.2", "--threads", 1)
        running = subprocess.Popen([PROGRAM, *map(str, common), "--quiet", "--out", out])
        file = out / "tracks.h5"
        seen = 0
        deadline = time.monotonic() + 120
        while seen < 2 and time.monotonic() < deadline:  # twice while it grows
            time.sleep(0.3)
            try:
                with during_writing(file) as data:
                    if running.poll() is None and data.sizes["frame"] > 0:
                        self.check(data, file, writer="running")
                        seen += 1
            except OSError:  # not created yet
                pass
        self.assertTrue(running.poll() is not None or seen == 2)
        running.send_signal(signal.SIGKILL)
        running.wait()
        with during_writing(file) as data:
            self.check(data, file, writer="killed")
        if (out / "incomplete").exists():
            faba("resume", out, "--quiet")
        faba(*common, "--quiet", "--out", entire)
        with xarray.open_dataset(file, engine="h5netcdf") as resumed, xarray.open_dataset(entire / "tracks.h5", engine="h5netcdf") as once:
            self.check(resumed, file)
            self.assertEqual(resumed.sizes["frame"], 7200)
            xarray.testing.assert_identical(resumed, once)


class Stacks(WithFolder):
    def check_stack(self, file, frames, um_per_px, frame_s, shape):
        with tifffile.TiffFile(file) as tif:
            data = tif.asarray()
            self.assertEqual(data.shape, shape)
            self.assertEqual(len(tif.pages), frames)
            if file.name.endswith(".ome.tif"):
                self.assertTrue(tif.is_ome)
                pixels = tifffile.xml2dict(tif.ome_metadata)["OME"]["Image"]["Pixels"]
                self.assertEqual(pixels["SizeT"], frames)
                self.assertEqual(tif.series[0].axes, "YX" if frames == 1 else "TYXS" if len(shape) == 4 else "TYX")
                if um_per_px is None:
                    self.assertNotIn("PhysicalSizeX", pixels)
                else:
                    self.assertEqual((pixels["PhysicalSizeX"], pixels["PhysicalSizeY"]), (um_per_px, um_per_px))
                    self.assertEqual((pixels["PhysicalSizeXUnit"], pixels["PhysicalSizeYUnit"]), ("\u00b5m", "\u00b5m"))
                if frame_s is None:
                    self.assertNotIn("TimeIncrement", pixels)
                else:
                    self.assertAlmostEqual(pixels["TimeIncrement"], frame_s, delta=1e-9)
                    self.assertEqual(pixels["TimeIncrementUnit"], "s")
            else:
                self.assertTrue(tif.is_imagej)
                meta = tif.imagej_metadata
                self.assertTrue(meta["ImageJ"].startswith("1.54"))
                self.assertEqual((meta["images"], meta["frames"]), (frames, frames))
                self.assertEqual(meta.get("unit"), None if um_per_px is None else "micron")
                if frame_s is None:
                    self.assertNotIn("finterval", meta)
                else:
                    self.assertAlmostEqual(meta["finterval"], frame_s, delta=1e-9)
                    self.assertAlmostEqual(meta["fps"], 1 / frame_s, delta=1e-6)
                tags = tif.pages[0].tags
                self.assertEqual("XResolution" in tags, um_per_px is not None)
                for tag in ("XResolution", "YResolution") if um_per_px else ():
                    self.assertAlmostEqual(tags[tag].value[1] / tags[tag].value[0], um_per_px, delta=1e-9)
        return data

    def test_run_to_both_kinds(self):
        run = self.dir / "run"
        faba("run", scene("as-seen.toml"), "--seed", 1, "--duration", "1 s", "--out", run, "--set", "record.lossless=true")
        manifest = json.loads((run / "manifest.json").read_text())
        frames, um = manifest["frames"], manifest["um_per_px"]
        width, height = manifest["view_px"]
        interval = manifest["duration_s"] / frames
        datas = []
        for name in ("a.ome.tif", "a.tif"):
            given = json.loads(faba("convert", run, self.dir / name, "--json").stdout)
            self.assertEqual((given["frames"], given["um_per_px"]), (frames, um))
            self.assertAlmostEqual(given["frame_s"], interval, delta=1e-9)
            datas.append(self.check_stack(self.dir / name, frames, um, given["frame_s"], (frames, height, width)))
            # and Faba reads its own file
            again = json.loads(faba("convert", self.dir / name, self.dir / f"again-{name}", "--json").stdout)
            self.assertEqual((again["um_per_px_source"], again["frames"]), ("metadata", frames))
            self.assertAlmostEqual(again["um_per_px"], um, delta=1e-6 * um)
            self.assertAlmostEqual(again["frame_s"], interval, delta=1e-6 * interval)
            numpy.testing.assert_array_equal(tifffile.imread(self.dir / f"again-{name}"), datas[-1])
        numpy.testing.assert_array_equal(datas[0], datas[1])
        self.assertGreater(datas[0].std(), 0)
        part = json.loads(faba("convert", run, self.dir / "part.tif", "--from", 0.2, "--to", 0.5, "--json").stdout)
        start = round(0.2 / interval)
        numpy.testing.assert_array_equal(tifffile.imread(self.dir / "part.tif"), datas[0][start:start + part["frames"]])

    def test_sixteen_bits_drawing_and_one_frame(self):
        faba("run", scene("as-seen.toml"), "--seed", 1, "--duration", "0.3 s", "--out", self.dir / "deep", "--set", "record.lossless=true",
             "--set", "record.video=false", "--set", "microscope.bits=16")
        faba("convert", self.dir / "deep", self.dir / "deep.ome.tif")
        data = tifffile.imread(self.dir / "deep.ome.tif")
        self.assertEqual(data.dtype, numpy.uint16)
        self.assertGreater(data.max(), 255)
        faba("run", scene("steer.toml"), "--seed", 1, "--duration", "0.1 s", "--out", self.dir / "drawn")
        frames = json.loads((self.dir / "drawn/manifest.json").read_text())["frames"]
        for name in ("drawn.ome.tif", "drawn.tif"):
            given = json.loads(faba("convert", self.dir / "drawn", self.dir / name, "--json").stdout)
            self.check_stack(self.dir / name, frames, given["um_per_px"], given["frame_s"], (frames, 480, 640, 3))
        tifffile.imwrite(self.dir / "one.tif", numpy.full((8, 9), 3, numpy.uint8))
        for name in ("one-again.ome.tif", "one-again.tif"):
            done = faba("convert", self.dir / "one.tif", self.dir / name, "--um-per-px", 0.5)
            self.assertIn("frame rate is not known", done.stderr)
            self.check_stack(self.dir / name, 1, 0.5, None, (8, 9))

    def test_unknown_scale_floats_and_refusals(self):
        stack = numpy.linspace(-3, 7, 2 * 5 * 6).reshape(2, 5, 6).astype(numpy.float32)
        tifffile.imwrite(self.dir / "f.tif", stack)
        for name in ("u.ome.tif", "u.tif"):
            done = faba("convert", self.dir / "f.tif", self.dir / name, "--fps", 4)
            self.assertIn("the scale is not known", done.stderr)
            numpy.testing.assert_array_equal(self.check_stack(self.dir / name, 2, None, 0.25, (2, 5, 6)), stack)
        tifffile.imwrite(self.dir / "signed.tif", stack.astype(numpy.int16))
        for arguments, code, words in ((("signed.tif", "s.tif"), 3, "must be between 0 and 65535"),
                                       (("f.tif", "u.tif"), 2, "already exists"),
                                       (("f.tif", "f.tif", "--force"), 2, "is an input"),
                                       (("f.tif", "noextension"), 2, "the file extension must be"),
                                       (("f.tif", "x.avi"), 2, "the file extension must be"),
                                       (("f.tif", "nowhere/x.tif"), 2, "not found"),
                                       (("missing.avi", "x.tif"), 3, "not found"),
                                       (("f.tif", "x.tif", "--fps", "4", "--from", "9"), 3, "change --from and --to")):
            done = faba("convert", *arguments, code=code, cwd=self.dir)
            self.assertIn(words, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual([f.name for f in self.dir.glob("*.tmp")], [])
        self.assertFalse((self.dir / "x.tif").exists())


class TrackTables(WithFolder):
    def setUp(self):
        super().setUp()
        rng = numpy.random.default_rng(1)
        at = rng.uniform(30, 170, (12, 2))
        y, x = numpy.mgrid[:200, :200]
        frames = []
        for k in range(10):
            frame = rng.normal(200, 1.0, (200, 200))
            for px, py in at + k * numpy.array([2.0, 1.0]):
                frame -= 90 * numpy.exp(-((x - px) ** 2 + (y - py) ** 2) / (2 * 1.5**2))
            frames.append(numpy.clip(frame, 0, 255).astype(numpy.uint8))
        tifffile.imwrite(self.dir / "film.tif", numpy.array(frames))
        self.film = ("track", self.dir / "film.tif", "--fps", 20)

    def rows(self, file):
        with open(file, newline="") as f:
            return f.readline(), numpy.loadtxt(f, delimiter=",", ndmin=2)

    def test_every_format_has_the_same_tracks(self):
        names = {"csv": "a.csv", "hdf5": "a.h5", "trackmate": "t.csv", "napari": "n.csv"}
        options = [o for f, n in names.items() for o in ("--out", self.dir / n, "--format", f)]
        given = json.loads(faba(*self.film, "--um-per-px", 0.5, "--json", *options).stdout)
        self.assertEqual([t["format"] for t in given["tables"]], list(names))
        self.assertEqual([t["length_unit"] for t in given["tables"]], ["px", "px", "um", "px"])
        self.assertEqual(given["tables"][3]["scale"], [1, 0.5, 0.5])
        header, own = self.rows(self.dir / "a.csv")
        self.assertEqual(header, "track,frame,t_s,x_px,y_px,mass,snr\n")
        self.assertGreater(len(own), 60)
        header, trackmate = self.rows(self.dir / "t.csv")
        self.assertEqual(header, "track,frame,t_s,x,y,z,quality\n")
        numpy.testing.assert_allclose(trackmate[:, :3], own[:, :3])
        numpy.testing.assert_allclose(trackmate[:, 3:5], 0.5 * own[:, 3:5], atol=0.5e-3)
        self.assertTrue((trackmate[:, 5] == 0).all())
        header, napari = self.rows(self.dir / "n.csv")
        self.assertEqual(header, "track_id,frame,y,x\n")
        numpy.testing.assert_allclose(napari, own[:, [0, 1, 4, 3]])
        self.assertEqual(napari[:, 1].min(), 0)
        first = (self.dir / "t.csv").read_text().splitlines()[1].split(",")
        self.assertTrue(first[0].isdigit() and first[1].isdigit())
        with xarray.open_dataset(self.dir / "a.h5", engine="h5netcdf") as data:
            self.assertEqual(data.x_px.dims, ("point",))
            self.assertEqual(set(data.coords), {"point", "track", "frame", "t_s"})
            for name in data.variables:
                self.assertTrue(data[name].attrs["units"], name)
            table = data.to_dataframe()
            numpy.testing.assert_allclose(table[["track", "frame", "t_s", "x_px", "y_px"]], own[:, :5], atol=0.6e-3)

    def test_unknown_scale_and_text(self):
        done = faba(*self.film, "--out", self.dir / "t.csv", "--format", "trackmate")
        self.assertIn("px: the scale is not known", done.stdout)
        done = faba(*self.film, "--um-per-px", 0.5, "--out", self.dir / "n.csv", "--format", "napari")
        self.assertIn("scale=(1, 0.5, 0.5)", done.stdout)

    def test_no_tracks(self):
        for form, extension, header in (("trackmate", "csv", "track,frame,t_s,x,y,z,quality\n"), ("napari", "csv", "track_id,frame,y,x\n"),
                                        ("hdf5", "h5", None)):
            file = self.dir / f"none-{form}.{extension}"
            faba(*self.film, "--threshold", "1000000", "--out", file, "--format", form)
            if header:
                self.assertEqual(file.read_text(), header)
            else:
                with xarray.open_dataset(file, engine="h5netcdf") as data:
                    self.assertEqual(data.sizes["point"], 0)

    def test_refusals(self):
        for options, words in ((("--format", "trackmate"), "requires --out"),
                               (("--format", "mat", "--out", "a.csv"), "is not one of csv, hdf5, trackmate, napari"),
                               (("--format", "hdf5", "--out", "a.csv"), 'the file extension must be .h5, not ".csv"'),
                               (("--format", "napari", "--out", "a"), 'the file extension must be .csv, not ""'),
                               (("--format", "csv", "--format", "napari", "--out", "a.csv"), "one format for all, or one for each --out")):
            done = faba(*self.film, *options, code=2, cwd=self.dir)
            self.assertIn(words, done.stderr)
        self.assertEqual({f.name for f in self.dir.iterdir()}, {"film.tif"})

    def test_many_videos_and_edits(self):
        second = self.dir / "second.tif"
        second.write_bytes((self.dir / "film.tif").read_bytes())
        faba(*self.film, second, "--folder", self.dir / "all", "--out", "t.csv", "--format", "trackmate", "--engine", "local", "--quiet")
        for name in ("film", "second"):
            folder = self.dir / "all/videos" / name
            self.assertEqual(self.rows(folder / "t.csv")[0], "track,frame,t_s,x,y,z,quality\n")
            self.assertEqual(json.loads((folder / "track.json").read_text())["tables"],
                             [{"file": "t.csv", "format": "trackmate", "length_unit": "px"}])
        faba(*self.film, "--um-per-px", 2, "--result", self.dir / "result", "--out", self.dir / "n.csv", "--format", "napari", "--quiet")
        self.assertEqual(self.rows(self.dir / "result/tracks.csv")[0], "track,frame,t_s,x_px,y_px,mass,snr\n")
        (self.dir / "edits.toml").write_text('[[edit]]\naction = "delete"\ntrack = 1\n')
        for form, name in (("trackmate", "e.csv"), ("napari", "f.csv"), ("hdf5", "e.h5")):
            faba("track", self.dir / "result", "--edits", self.dir / "edits.toml", "--out", self.dir / name, "--format", form)
        _, napari = self.rows(self.dir / "n.csv")
        _, edited = self.rows(self.dir / "f.csv")
        self.assertNotIn(1, edited[:, 0])
        numpy.testing.assert_allclose(edited, napari[napari[:, 0] != 1], atol=1e-9)
        _, trackmate = self.rows(self.dir / "e.csv")
        numpy.testing.assert_allclose(trackmate[:, [4, 3]], 2 * edited[:, 2:], atol=1e-9)


class Crate(WithFolder):
    def test_structure(self):
        run = self.dir / "run"
        faba("run", scene("steer.toml"), "--seed", 1, "--duration", "0.5 s", "--out", run)
        crate = json.loads((run / "ro-crate-metadata.json").read_text())
        manifest = json.loads((run / "manifest.json").read_text())
        self.assertEqual(crate["@context"], "https://w3id.org/ro/crate/1.1/context")
        entities = {e["@id"]: e for e in crate["@graph"]}
        self.assertEqual(len(entities), len(crate["@graph"]))

        def references(value):
            if isinstance(value, dict):
                if set(value) == {"@id"}:
                    yield value["@id"]
                else:
                    for v in value.values():
                        yield from references(v)
            elif isinstance(value, list):
                for v in value:
                    yield from references(v)

        for entity in crate["@graph"]:
            self.assertTrue(entity["@type"])
            for target in references({k: v for k, v in entity.items() if k != "@id"}):
                known = target in entities or target in ("https://w3id.org/ro/crate/1.1", "http://schema.org/CompletedActionStatus")
                self.assertTrue(known, target)
        descriptor, root = entities["ro-crate-metadata.json"], entities["./"]
        self.assertEqual(descriptor["@type"], "CreativeWork")
        self.assertEqual(descriptor["conformsTo"], {"@id": "https://w3id.org/ro/crate/1.1"})
        self.assertEqual(descriptor["about"], {"@id": "./"})
        self.assertEqual(root["@type"], "Dataset")
        self.assertEqual(root["datePublished"], manifest["date"])
        for key in ("name", "description", "license"):
            self.assertTrue(root[key])
        self.assertEqual(root["conformsTo"], {"@id": "https://w3id.org/ro/wfrun/process/0.5"})
        action = entities[root["mentions"]["@id"]]
        self.assertEqual(action["@type"], "CreateAction")
        self.assertNotIn("agent", action)
        self.assertLessEqual(action["startTime"], action["endTime"])
        self.assertEqual(entities[action["instrument"]["@id"]]["version"], manifest["version"])
        self.assertIn({"@id": "scenario.toml"}, action["object"])
        files = {e["@id"] for e in crate["@graph"] if e["@type"] == "File"}
        self.assertEqual(files, {f.name for f in run.iterdir()} - {"ro-crate-metadata.json"})
        self.assertEqual({p["@id"] for p in root["hasPart"]}, files)
        self.assertEqual({p["@id"] for p in action["result"]}, files - {"scenario.toml"})
        self.assertIn(manifest["state_hash"], root["description"])

    def test_equal_runs_and_incomplete_run(self):
        texts = []
        for k in range(2):
            run = self.dir / f"run-{k}"
            faba("run", scene("steer.toml"), "--seed", 4, "--duration", "0.2 s", "--out", run, "--set", "record.video=false", "--quiet")
            crate = json.loads((run / "ro-crate-metadata.json").read_text())
            for entity in crate["@graph"]:
                for key in ("datePublished", "startTime", "endTime"):
                    entity.pop(key, None)
            texts.append(json.dumps(crate))
        self.assertEqual(texts[0], texts[1])
        running = subprocess.Popen([PROGRAM, "run", str(scene("steer.toml")), "--seed", "4", "--out", str(self.dir / "stopped"), "--duration",
                                    "1000 s", "--quiet"])
        while not (self.dir / "stopped/series.csv").exists() and running.poll() is None:
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        running.wait()
        self.assertFalse((self.dir / "stopped/ro-crate-metadata.json").exists())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--root", required=True, type=pathlib.Path)
    options, rest = parser.parse_known_args()
    PROGRAM, ROOT = os.path.abspath(options.program), options.root.resolve()
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
