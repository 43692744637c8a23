"""Plots that the program does not draw, as SVG in the colours of its pages, and PNG pictures of arrays."""

import base64
import html
import math
import re
import struct
import zlib

import numpy as np

MINUS = "\u2212"
INKS = ("blue", "vermillion", "green", "purple")
LIGHT = {"blue": "#0072b2", "vermillion": "#d55e00", "green": "#009e73", "purple": "#cc79a7", "text": "#1d2329", "muted": "#5c6670"}


def figure(heading, content, caption="", wide=False):
    kind = ' class="wide"' if wide else ""
    return (
        f"<figure{kind}>\n<h3>{html.escape(heading)}</h3>\n{content}"
        f"<figcaption>{html.escape(re.sub(r'(?<![A-Za-z0-9_.])-(?=[0-9])', MINUS, caption))}</figcaption>\n</figure>\n"
    )


def picture(heading, png, caption="", wide=False):
    """A figure with a PNG picture, given as bytes or as a path."""
    data = png if isinstance(png, bytes) else png.read_bytes()
    src = base64.b64encode(data).decode()
    return figure(heading, f'<img alt="{html.escape(heading)}" src="data:image/png;base64,{src}" />\n', caption, wide)


def png(grey, zoom=1):
    """A greyscale PNG of an array with values from 0 to 255."""
    pixels = np.kron(np.clip(np.rint(grey), 0, 255).astype(np.uint8), np.ones((zoom, zoom), np.uint8))
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def ticks(low, high):
    step = 10 ** math.floor(math.log10((high - low) / 4))
    step = next(step * k for k in (1, 2, 5, 10) if (high - low) / (step * k) <= 6)
    return [step * k for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def number(v):
    return f"{v:.6g}".replace("-", MINUS)


def plot(heading, x_label, y_label, layers, caption="", wide=False, x=None, y=None, rules=()):
    """A figure of layers (kind, name, x, y); kind is line, dashed, dots or bars. `x` and `y` set the axis ranges; `rules` are vertical
    lines (x, label)."""
    layers = [(k, n, np.asarray(a, float), np.asarray(b, float)) for k, n, a, b in layers]
    xs, ys = (np.concatenate([layer[i] for layer in layers]) for i in (2, 3))
    x, y = (given or _range(values, any(k == "bars" for k, *_ in layers) and values is ys) for given, values in ((x, xs), (y, ys)))
    w, h, left, top, bottom = 620 if wide else 480, 270, 62, 30, 46

    def at_x(v):
        return left + (v - x[0]) / (x[1] - x[0]) * (w - left - 12)

    def at_y(v):
        return h - bottom - (v - y[0]) / (y[1] - y[0]) * (h - bottom - top)

    out = [
        f'<svg class="faba-plot own" viewBox="0 0 {w} {h}" role="img" aria-label="{html.escape(heading)}" '
        'xmlns="http://www.w3.org/2000/svg" font-size="12" fill="none">\n'
    ]
    for v in ticks(*y):
        out.append(
            f'<path class="grid" stroke="#d9dde1" d="M{left} {at_y(v):.1f}H{w - 12}"/>'
            f'<text class="f-muted" fill="#5c6670" x="{left - 6}" y="{at_y(v) + 4:.1f}" text-anchor="end">{number(v)}</text>\n'
        )
    for v in ticks(*x):
        out.append(
            f'<text class="f-muted" fill="#5c6670" x="{at_x(v):.1f}" y="{h - bottom + 17}" text-anchor="middle">{number(v)}</text>\n'
        )
    out.append(f'<path class="s-muted" stroke="#5c6670" d="M{left} {top}V{h - bottom}H{w - 12}"/>\n')
    for v, words in rules:
        out.append(
            f'<path class="s-muted" stroke="#5c6670" stroke-dasharray="3 3" d="M{at_x(v):.1f} {top}V{h - bottom}"/>'
            f'<text class="f-muted" fill="#5c6670" x="{at_x(v) + 4:.1f}" y="{top + 12}">{html.escape(words)}</text>\n'
        )
    legend = left
    for i, (kind, name, a, b) in enumerate(layers):
        ink = INKS[i % len(INKS)]
        stroke, fill = f'class="s-{ink}" stroke="{LIGHT[ink]}"', f'class="f-{ink}" fill="{LIGHT[ink]}"'
        good = np.isfinite(a) & np.isfinite(b)
        places = [(at_x(p), at_y(q)) for p, q in zip(a[good], b[good])]
        if kind in ("line", "dashed"):
            dash = ' stroke-dasharray="6 4"' if kind == "dashed" else ""
            out.append(f'<path {stroke} stroke-width="1.6"{dash} d="M' + "L".join(f"{p:.1f} {q:.1f}" for p, q in places) + '"/>\n')
        elif kind == "dots":
            out += [f'<circle {fill} cx="{p:.1f}" cy="{q:.1f}" r="3"/>' for p, q in places] + ["\n"]
        else:
            wide_bar = 0.8 * (w - left - 12) / (x[1] - x[0]) * (np.min(np.diff(a)) if len(a) > 1 else 1)
            out += [
                f'<rect {fill} opacity="0.55" x="{p - wide_bar / 2:.1f}" y="{min(q, at_y(0)):.1f}" width="{wide_bar:.1f}" '
                f'height="{abs(at_y(0) - q):.1f}"/>'
                for p, q in places
            ] + ["\n"]
        if name:
            dash = ' stroke-dasharray="6 4"' if kind == "dashed" else ""
            sign = (
                f'<path {stroke} stroke-width="2"{dash} d="M{legend} 14h18"/>'
                if kind in ("line", "dashed")
                else f'<circle {fill} cx="{legend + 9}" cy="14" r="4"/>'
            )
            out.append(f'{sign}<text class="f-text" fill="#1d2329" x="{legend + 23}" y="18">{html.escape(name)}</text>\n')
            legend += 23 + 6.6 * len(name) + 16
    out.append(
        f'<text class="f-text" fill="#1d2329" x="{(left + w - 12) / 2}" y="{h - 8}" text-anchor="middle">{html.escape(x_label)}</text>'
        f'<text class="f-text" fill="#1d2329" transform="translate(14 {(h - bottom + top) / 2}) rotate(-90)" '
        f'text-anchor="middle">{html.escape(y_label)}</text>\n</svg>\n'
    )
    return figure(heading, "".join(out), caption, wide)


def _range(values, from_zero):
    values = values[np.isfinite(values)]
    low, high = float(values.min()), float(values.max())
    if from_zero:
        low, high = min(0.0, low), max(0.0, high)
    pad = 0.05 * (high - low) or 0.5
    return (low if from_zero and low == 0 else low - pad), high + pad


def boxes(heading, places, arrows, caption="", size=(620, 260), around=False):
    """A block diagram. `places` are boxes (x, y, width, label), with | as line break; `arrows` are pairs of box indices (from, to).
    `around`: arrows between rows start or end at the side of a box."""
    out = [
        f'<svg class="faba-plot own" viewBox="0 0 {size[0]} {size[1]}" role="img" aria-label="{html.escape(heading)}" '
        'xmlns="http://www.w3.org/2000/svg" font-size="12" fill="none">\n'
    ]
    for a, b in arrows:
        out.append(f'<path class="s-muted" stroke="#5c6670" d="{_arrow(places[a][:3], places[b][:3], around)}"/>\n')
    for x, y, w, words in places:
        out.append(f'<rect class="s-blue box" stroke="#0072b2" fill="#f4f6f7" x="{x}" y="{y}" width="{w}" height="40" rx="5"/>\n')
        lines = words.split("|")
        for i, line in enumerate(lines):
            strong = ' font-weight="600"' if i == 0 and len(lines) > 1 else ""
            out.append(
                f'<text class="f-text" fill="#1d2329" x="{x + w / 2}" y="{y + 24.5 + 15 * (i - (len(lines) - 1) / 2):.1f}" '
                f'text-anchor="middle"{strong}>{html.escape(line)}</text>\n'
            )
    return figure(heading, "".join(out) + "</svg>\n", caption, wide=True)


def _arrow(a, b, around):
    """SVG path of an arrow between two boxes of height 40. In a row: straight. `around`: down and into a side, or out of a side and up.
    Otherwise: from the bottom edge to the top edge, or outside the rows between the boxes."""
    (ax, ay, aw), (bx, by, bw) = a, b
    x1, x2, right = ax + aw / 2, bx + bw / 2, bx > ax
    if ay == by or (around and by > ay):
        end = bx if right else bx + bw
        begin = f"M{ax + aw if right else ax} {ay + 20}" if ay == by else f"M{x1} {ay + 40}V{by + 20}"
        return f"{begin}H{end}" + _head(end, by + 20, 1 if right else -1, 0)
    if around:
        return f"M{ax + aw if right else ax} {ay + 20}H{x2}V{by + 40}" + _head(x2, by + 40, 0, -1)
    if by - ay > 80:  # there is a row between the two boxes: outside of it
        begin, side, out = (ax + aw, bx + bw, 1) if x2 >= x1 else (ax, bx, -1)
        return f"M{begin} {ay + 20}H{side + 14 * out}V{by + 20}H{side}" + _head(side, by + 20, -out, 0)
    start, end = (ay + 40, by) if by > ay else (ay, by + 40)
    return f"M{x1} {start}V{(start + end) / 2}H{x2}V{end}" + _head(x2, end, 0, 1 if by > ay else -1)


def _head(x, y, dx, dy):
    return f"M{x - 6 * dx - 4 * dy} {y - 6 * dy - 4 * dx}L{x} {y}L{x - 6 * dx + 4 * dy} {y - 6 * dy + 4 * dx}"
