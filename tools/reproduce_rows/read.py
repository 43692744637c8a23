"""Reads output files of the program: series, tracks, pictures, flow fields, figures of pages."""

import re
import struct
import tomllib

import h5py
import numpy as np


def series(step):
    """series.csv as arrays by column; empty fields are NaN."""
    lines = (step.folder / "series.csv").read_text().splitlines()
    rows = [[float(x) if x else np.nan for x in line.split(",")] for line in lines[1:]]
    return dict(zip(lines[0].split(","), np.array(rows).T))


def table(path):
    """A CSV file as arrays by column; columns that are not numeric are arrays of strings."""
    lines = path.read_text().splitlines()
    columns = list(zip(*(line.split(",") for line in lines[1:])))
    out = {}
    for name, column in zip(lines[0].split(","), columns):
        try:
            out[name] = np.array([float(x) if x else np.nan for x in column])
        except ValueError:
            out[name] = np.array(column)
    return out


def tracks(step):
    """Positions, shape (frames, cells, 2), in image px with y down, and the times in s."""
    with h5py.File(step.folder / "tracks.h5") as f:
        return f["position_px"][:].astype(float), f["t_s"][:]


def scenario(step):
    return tomllib.loads((step.folder / "scenario.toml").read_text())


def frames(step):
    """The frames of a lossless video.avi as PNG files in memory, in order."""
    data = (step.folder / "video.avi").read_bytes()
    found, at = [], data.find(b"\x89PNG\r\n\x1a\n")
    while at >= 0:
        end = data.find(b"IEND", at) + 8
        found.append(data[at:end])
        at = data.find(b"\x89PNG\r\n\x1a\n", end)
    return found


def flo(path):
    """The components (u, v) of a Middlebury .flo file."""
    data = path.read_bytes()
    width, height = struct.unpack("<ii", data[4:12])
    both = np.frombuffer(data, "<f4", offset=12).reshape(height, width, 2)
    return both[:, :, 0].astype(float), both[:, :, 1].astype(float)


def pgm(grey):
    """A binary PGM file of an array of grey values."""
    height, width = grey.shape
    return b"P5\n%d %d\n255\n" % (width, height) + np.clip(np.rint(grey), 0, 255).astype(np.uint8).tobytes()


def figures(page):
    """The <figure> elements of a page of the program: (heading, markup), in order."""
    found = re.findall(r"<figure[^>]*>.*?</figure>", page.read_text(), re.S)
    return [(re.search(r"<h3>(.*?)</h3>", f, re.S)[1], f) for f in found]


def figure(page, heading, title=None, caption=None):
    """The first figure whose heading starts with `heading`, at half the page width and with an optional new title and caption; or None."""
    for name, markup in figures(page):
        if name.startswith(heading):
            markup = re.sub(r"<figcaption>Figure \d+\. ", "<figcaption>", markup).replace('<figure class="wide">', "<figure>", 1)
            if title:
                markup = re.sub(r"<h3>.*?</h3>", lambda _: f"<h3>{title}</h3>", markup, count=1, flags=re.S)
            if caption is not None:
                markup = re.sub(r"<figcaption>.*?</figcaption>", lambda _: f"<figcaption>{caption}</figcaption>", markup, flags=re.S)
            return markup
    return None


def style(page):
    return re.search(r"<style>(.*?)</style>", page.read_text(), re.S)[1]
