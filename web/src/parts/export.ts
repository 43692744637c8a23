// Exported files of the page.

export function saveBlob(b: Blob, name: string) {
  const a = document.createElement('a');
  a.href = URL.createObjectURL(b);
  a.download = name;
  a.click();
  setTimeout(() => URL.revokeObjectURL(a.href), 10_000);
}

const escaped = (s: string) => s.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

/** A plot as SVG: lines over time with axes, for publications. `words`: the label of the time axis, and that of an earlier run. */
export function svgOf(
  title: string,
  unit: string,
  data: ArrayLike<ArrayLike<number | null | undefined>>,
  lines: { label: string; colour: string }[],
  words: { time: string; earlier: string },
): string {
  const w = 640, h = 320, left = 70, right = 12, top = 30, bottom = 44;
  const t = data[0] as ArrayLike<number>;
  let low = Infinity, high = -Infinity;
  for (let c = 1; c < data.length; ++c)
    for (let i = 0; i < t.length; ++i) {
      const v = data[c][i];
      if (v === null || v === undefined) continue;
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  if (!(high > low)) (low -= 0.5), (high += 0.5);
  const t0 = t[0] ?? 0, t1 = Math.max(t[t.length - 1] ?? 1, t0 + 1e-9);
  const x = (v: number) => left + ((v - t0) / (t1 - t0)) * (w - left - right);
  const y = (v: number) => h - bottom - ((v - low) / (high - low)) * (h - top - bottom);
  const ticks = (a: number, b: number) => {
    const step = 10 ** Math.floor(Math.log10((b - a) / 4)), k = [5, 2, 1].find((m) => (b - a) / (m * step) >= 4) ?? 1, d = k * step;
    const all: number[] = [];
    for (let v = Math.ceil(a / d) * d; v <= b + 1e-9 * d; v += d) all.push(Number(v.toPrecision(12)));
    return all;
  };
  let out = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${w} ${h}" font-family="sans-serif" font-size="12"><rect width="${w}" height="${h}" fill="#fff"/><text x="${left}" y="18" font-weight="bold">${escaped(title)}</text>`;
  for (const v of ticks(t0, t1)) out += `<path d="M${x(v).toFixed(1)} ${h - bottom}v4" stroke="#333"/><text x="${x(v).toFixed(1)}" y="${h - bottom + 18}" text-anchor="middle">${v}</text>`;
  for (const v of ticks(low, high)) out += `<path d="M${left} ${y(v).toFixed(1)}H${w - right}" stroke="#ddd"/><text x="${left - 6}" y="${(y(v) + 4).toFixed(1)}" text-anchor="end">${v}</text>`;
  out += `<path d="M${left} ${top}V${h - bottom}H${w - right}" fill="none" stroke="#333"/><text x="${(left + w - right) / 2}" y="${h - 8}" text-anchor="middle">${escaped(words.time)}</text><text transform="translate(14 ${(top + h - bottom) / 2}) rotate(-90)" text-anchor="middle">${escaped(unit)}</text>`;
  for (let c = 1; c < data.length; ++c) {
    const l = lines[(c - 1) % lines.length];
    let d = '', pen = false;
    for (let i = 0; i < t.length; ++i) {
      const v = data[c][i];
      if (v === undefined) continue; // measured by the other run only
      if (v === null) pen = false;
      else {
        d += `${pen ? 'L' : 'M'}${x(t[i]).toFixed(1)} ${y(v).toFixed(1)}`;
        pen = true;
      }
    }
    out += `<path d="${d}" fill="none" stroke="${l.colour}" stroke-width="1.5"${c > lines.length ? ' stroke-dasharray="4 4"' : ''}/><text x="${w - right - 4}" y="${top + 14 * c}" text-anchor="end" fill="${l.colour}">${escaped(l.label)}${c > lines.length ? ` (${escaped(words.earlier)})` : ''}</text>`;
  }
  return out + '</svg>\n';
}
