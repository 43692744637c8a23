"""Rendered material: runs of the program, and defects that the renderer does not have, made in the frames with numpy.

Pictures and frames are float arrays (rows, columns) with grey levels 0 to 255; positions are (x, y) in px, y down.
"""

import hashlib
import json
import pathlib
import shutil
import struct
import subprocess
import zlib

import h5py
import numpy

WIDTH, HEIGHT = 320, 240


def digest(*parts):
    """A key of the contents of all parts, which JSON can represent."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()[:20]


def as_bytes(frames):
    return numpy.clip(numpy.rint(frames), 0, 255).astype(numpy.uint8)


def write_pgm(path, picture):
    grey = as_bytes(picture)
    path.write_bytes(b"P5\n%d %d\n255\n" % (grey.shape[1], grey.shape[0]) + grey.tobytes())
    return path


def write_tiff(path, frames):
    """An uncompressed grey TIFF with a page for each frame."""
    grey = as_bytes(frames)
    n, height, width = grey.shape
    out = bytearray(b"II*\0\x08\0\0\0")
    for k in range(n):
        tags = [(256, width), (257, height), (258, 8), (259, 1), (262, 1), (273, 0), (277, 1), (278, height), (279, width * height)]
        here = len(out)
        data = here + 2 + 12 * len(tags) + 4
        out += struct.pack("<H", len(tags))
        for tag, value in tags:
            out += struct.pack("<HHII", tag, 4, 1, data if tag == 273 else value)
        end = data + width * height
        end += end % 2
        out += struct.pack("<I", end if k + 1 < n else 0) + grey[k].tobytes()
        out += bytes(end - len(out))
    path.write_bytes(out)
    return path


def write_flo(path, u, v):
    """A flow in the Middlebury format; not a number is unknown."""
    both = numpy.stack([u, v], axis=-1).astype("<f4")
    both[~numpy.isfinite(both)] = 2e9
    path.write_bytes(struct.pack("<fii", 202021.25, u.shape[1], u.shape[0]) + both.tobytes())
    return path


def png_grey(data):
    """A grey PNG without prediction, as the program writes it."""
    at, width, height, packed = 8, 0, 0, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IHDR":
            width, height = struct.unpack(">II", data[at + 8:at + 16])
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw = numpy.frombuffer(zlib.decompress(packed), numpy.uint8)
    rows = raw.reshape(height, -1)
    if rows[:, 0].any():
        raise ValueError("the picture is coded with prediction")
    return rows[:, 1:].reshape(height, width, -1)[:, :, 0]


def read_avi(path):
    """The frames of a lossless video of the program, uint8."""
    data, frames = path.read_bytes(), []
    at = data.index(b"movi") + 4
    while at + 8 <= len(data):
        name, size = struct.unpack("<4sI", data[at:at + 8])
        if name == b"00dc" or name == b"00db":
            frames.append(png_grey(data[at + 8:at + 8 + size]))
        elif not name.startswith(b"ix"):
            break
        at += 8 + size + size % 2
    return numpy.stack(frames)


class Kit:
    """Calls the program; keeps rendered runs in a folder, by the contents of scene and seed."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.folder.mkdir(parents=True, exist_ok=True)

    def call(self, *words, cwd=None):
        done = subprocess.run([str(self.program), *map(str, words)], cwd=cwd, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def json(self, *words, cwd=None):
        """The result of a verb, or {"refused": reason} when it gives none."""
        code, out, error = self.call(*words, "--json", "--quiet", cwd=cwd)
        if code == 0:
            return json.loads(out)
        if code == 3:  # the material is unsuitable; all other codes are errors of the call or the program
            return {"refused": error.strip().splitlines()[-1]}
        raise RuntimeError(f"faba {' '.join(map(str, words))}: exit code {code}: {error}")

    def made(self, key, make):
        """A folder of material: make(folder) fills it unless it is there already."""
        folder = self.folder / key
        if not folder.exists():
            part = self.folder / f"{key}.part"
            shutil.rmtree(part, ignore_errors=True)
            part.mkdir(parents=True)
            make(part)
            part.rename(folder)
        return folder

    def run(self, text, seed):
        """The run directory of a scene."""
        def make(folder):
            (folder / "scene.toml").write_text(text)
            code, _, error = self.call("run", "scene.toml", "--seed", seed, "--out", "film", "--quiet", "--threads", 1, cwd=folder)
            if code:
                raise RuntimeError(f"{error}\n{text}")
        return self.made("run-" + digest(text, seed), make) / "film"

    def frames(self, run):
        return read_avi(run / "video.avi")

    def positions(self, run):
        """(frame, cell, x and y)."""
        with h5py.File(run / "tracks.h5") as f:
            return f["position_px"][:].astype(float)

    def film(self, frames, *key):
        """A TIFF stack of the frames; `key` identifies them."""
        return self.made("film-" + digest(*key), lambda folder: write_tiff(folder / "film.tif", frames)) / "film.tif"


def scene(cells=120, speed=60, speed_sd=None, rate=30, duration=2.0, field=1000, reversal=None, start='"visible"', arena=None, motile=1.0,
          contrast=-0.4, noise=0.008, diameter=3.0, psf=0.6, extra="", swarm="", microscope="", um_per_px=1.0, size=(WIDTH, HEIGHT)):
    """Cells in the entire picture or at the edge of a drop; field in uT to the right in the picture, 0 for none; the field has the
    opposite direction until `reversal` (s)."""
    speed_sd = 0.15 * speed if speed_sd is None else speed_sd
    arena = arena or f"radius_px = 900\ncentre_px = [{size[0] / 2}, {size[1] / 2}]"
    # Cells are south-seeking: they swim against the field. y points up in the world.
    before = "field = [\"0 T\", \"0 T\"]" if field == 0 else f'field = ["{field if reversal else -field} uT", "0 T"]'
    lines = [f'duration = "{duration} s"', f"[scale]\num_per_px = {um_per_px}", f'[camera]\nrate = "{rate} Hz"',
             f'[microscope]\ncell_diameter = "{diameter} um"\npsf_sd = "{psf} um"\ncontrast = {contrast}\nnoise = {noise}\n'
             f'exposure_time = "2 ms"\n{microscope}',
             f'[arena]\ntype = "drop"\nview_px = [{size[0]}, {size[1]}]\n{arena}',
             f'[[swarm]]\ncount = {cells}\nmodel = {{ type = "dipole", speed = "{speed} um/s", speed_sd = "{speed_sd} um/s", motile = {motile} '
             f'{extra} }}\nstart = {start if start.startswith("{") else "{ type = " + start + " }"}\n{swarm}',
             f'[controller]\ntype = "manual"\n{before}']
    if reversal:
        lines.append(f'[[controller.segment]]\nat = "{reversal} s"\nfield = ["{-field} uT", "0 T"]')
    return "\n".join(lines + ["[record]\nas_seen = true\nlossless = true\n"])


def smooth(picture, sd):
    """Gaussian smoothing with periodic borders."""
    rows, columns = picture.shape
    k = numpy.exp(-2 * (numpy.pi * sd) ** 2 * (numpy.fft.fftfreq(rows)[:, None] ** 2 + numpy.fft.rfftfreq(columns)[None, :] ** 2))
    return numpy.fft.irfft2(numpy.fft.rfft2(picture) * k, s=picture.shape)


def blurred(picture, sd):
    """Gaussian blur with mirrored borders."""
    m = int(4 * sd) + 1
    return smooth(numpy.pad(picture, m, mode="reflect"), sd)[m:-m, m:-m]


def texture(rng, shape, length):
    """A random smooth pattern of this correlation length (px), mean 0, standard deviation 1."""
    p = smooth(rng.standard_normal(shape), length)
    return (p - p.mean()) / p.std()


def shifted(picture, dx, dy):
    """Moves a picture with periodic borders by a fraction of px."""
    fy, fx = numpy.fft.fftfreq(picture.shape[0])[:, None], numpy.fft.rfftfreq(picture.shape[1])[None, :]
    return numpy.fft.irfft2(numpy.fft.rfft2(picture) * numpy.exp(-2j * numpy.pi * (fx * dx + fy * dy)), s=picture.shape)


def warped(picture, x, y):
    """The picture at other positions, bilinear; outside it, its border."""
    x, y = numpy.clip(x, 0, picture.shape[1] - 1.001), numpy.clip(y, 0, picture.shape[0] - 1.001)
    c, r = x.astype(int), y.astype(int)
    fx, fy = x - c, y - r
    top = (1 - fx) * picture[r, c] + fx * picture[r, c + 1]
    return (1 - fy) * top + fy * ((1 - fx) * picture[r + 1, c] + fx * picture[r + 1, c + 1])


def grid(shape):
    y, x = numpy.mgrid[0:shape[0], 0:shape[1]].astype(float)
    return x, y


# The luminance table of JPEG (ITU-T T.81, table K.1).
JPEG = numpy.array([[16, 11, 10, 16, 24, 40, 51, 61], [12, 12, 14, 19, 26, 58, 60, 55], [14, 13, 16, 24, 40, 57, 69, 56],
                    [14, 17, 22, 29, 51, 87, 80, 62], [18, 22, 37, 56, 68, 109, 103, 77], [24, 35, 55, 64, 81, 104, 113, 92],
                    [49, 64, 78, 87, 103, 121, 120, 101], [72, 92, 95, 98, 112, 100, 103, 99]], float)


def coded(picture, strength):
    """Rounds the cosine coefficients of blocks of 8 x 8 px as in JPEG; `strength` 1: quality 50, larger is coarser."""
    k = numpy.arange(8)
    basis = numpy.cos((2 * k[None, :] + 1) * k[:, None] * numpy.pi / 16) * numpy.where(k[:, None] == 0, numpy.sqrt(1 / 8), 0.5)
    h, w = picture.shape[0] // 8 * 8, picture.shape[1] // 8 * 8
    blocks = picture[:h, :w].reshape(h // 8, 8, w // 8, 8).transpose(0, 2, 1, 3) - 128
    c = basis @ blocks @ basis.T
    q = JPEG * strength
    out = picture.copy()
    out[:h, :w] = (basis.T @ (numpy.rint(c / q) * q) @ basis + 128).transpose(0, 2, 1, 3).reshape(h, w)
    return out


def coded_video(frames, strength, rng=None):
    """Codes the differences of successive frames, as video codecs do: a block that changes little is repeated."""
    out = [coded(frames[0], strength)]
    for f in frames[1:]:
        out.append(out[-1] + coded(f - out[-1] + 128, strength) - 128)
    return numpy.stack(out)


def flickering(frames, sd, rng):
    return frames * (1 + sd * rng.standard_normal(len(frames)))[:, None, None]


def drifting(frames, dx, dy):
    """The view moves by (dx, dy) px per frame: its borders are mirrored."""
    x, y = grid(frames[0].shape)
    h, w = frames[0].shape
    mirror = lambda p, n: (n - 1) - numpy.abs((p % (2 * (n - 1))) - (n - 1))
    return numpy.stack([warped(f, mirror(x - k * dx, w), mirror(y - k * dy, h)) for k, f in enumerate(frames)])


def on_texture(frames, amplitude, length, rng):
    """Multiplies all frames by one static texture, relative standard deviation `amplitude`."""
    return frames * (1 + amplitude * texture(rng, frames[0].shape, length))[None]


def spots(shape, at, sd, depth):
    """Gaussian spots of grey `depth` at the positions (n, 2), in a picture of zeros."""
    out = numpy.zeros(shape)
    m = int(numpy.ceil(4 * sd)) + 1
    for px, py in at:
        c, r = int(numpy.floor(px)), int(numpy.floor(py))
        x0, x1, y0, y1 = max(0, c - m), min(shape[1], c + m + 2), max(0, r - m), min(shape[0], r + m + 2)
        if x0 >= x1 or y0 >= y1:
            continue
        gx = numpy.exp(-((numpy.arange(x0, x1) - px) / sd) ** 2 / 2)
        gy = numpy.exp(-((numpy.arange(y0, y1) - py) / sd) ** 2 / 2)
        out[y0:y1, x0:x1] += depth * gy[:, None] * gx[None, :]
    return out
