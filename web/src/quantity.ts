// Numbers with units, as scenarios have them: "186 um/s".

type Dim = number[]; // m, kg, s, A, K, mol, px
interface Factor {
  factor: number;
  dim: Dim;
}

const kUnits: Record<string, Factor> = {
  m: { factor: 1, dim: [1, 0, 0, 0, 0, 0, 0] }, g: { factor: 1e-3, dim: [0, 1, 0, 0, 0, 0, 0] },
  s: { factor: 1, dim: [0, 0, 1, 0, 0, 0, 0] }, A: { factor: 1, dim: [0, 0, 0, 1, 0, 0, 0] },
  K: { factor: 1, dim: [0, 0, 0, 0, 1, 0, 0] }, mol: { factor: 1, dim: [0, 0, 0, 0, 0, 1, 0] },
  px: { factor: 1, dim: [0, 0, 0, 0, 0, 0, 1] }, rad: { factor: 1, dim: [0, 0, 0, 0, 0, 0, 0] },
  deg: { factor: Math.PI / 180, dim: [0, 0, 0, 0, 0, 0, 0] }, '%': { factor: 0.01, dim: [0, 0, 0, 0, 0, 0, 0] },
  Hz: { factor: 1, dim: [0, 0, -1, 0, 0, 0, 0] }, min: { factor: 60, dim: [0, 0, 1, 0, 0, 0, 0] },
  h: { factor: 3600, dim: [0, 0, 1, 0, 0, 0, 0] }, T: { factor: 1, dim: [0, 1, -2, -1, 0, 0, 0] },
  G: { factor: 1e-4, dim: [0, 1, -2, -1, 0, 0, 0] }, N: { factor: 1, dim: [1, 1, -2, 0, 0, 0, 0] },
  J: { factor: 1, dim: [2, 1, -2, 0, 0, 0, 0] }, W: { factor: 1, dim: [2, 1, -3, 0, 0, 0, 0] },
  Pa: { factor: 1, dim: [-1, 1, -2, 0, 0, 0, 0] }, V: { factor: 1, dim: [2, 1, -3, -1, 0, 0, 0] },
  ohm: { factor: 1, dim: [2, 1, -3, -2, 0, 0, 0] }, H: { factor: 1, dim: [2, 1, -2, -2, 0, 0, 0] },
  '1': { factor: 1, dim: [0, 0, 0, 0, 0, 0, 0] },
};
const kPrefixes: Record<string, number> = { f: 1e-15, p: 1e-12, n: 1e-9, u: 1e-6, µ: 1e-6, μ: 1e-6, m: 1e-3, c: 1e-2, k: 1e3, M: 1e6, G: 1e9 };

function named(name: string): Factor | null {
  const own = Object.hasOwn(kUnits, name) ? kUnits[name] : null;
  if (own) return own;
  const prefix = kPrefixes[name[0]], rest = name.slice(1);
  if (prefix && Object.hasOwn(kUnits, rest) && rest !== '1') return { factor: prefix * kUnits[rest].factor, dim: kUnits[rest].dim };
  return null;
}

/** A unit such as "um/s", "A m^2" or "1/(T s)"; null for what is none. */
export function parseUnit(text: string): Factor | null {
  let at = 0;
  const skip = () => {
    while (text[at] === ' ') ++at;
  };
  const factor = (): Factor | null => {
    skip();
    let f: Factor | null;
    if (text[at] === '(') {
      ++at;
      f = unit();
      if (text[at] !== ')') return null;
      ++at;
    } else {
      const m = /^(1|%|[a-zA-Zµμ]+)/.exec(text.slice(at));
      if (!m) return null;
      at += m[0].length;
      f = named(m[0]);
    }
    if (!f) return null;
    const p = /^ *\^ *(-?\d)/.exec(text.slice(at));
    if (!p) return f;
    at += p[0].length;
    const n = Number(p[1]);
    return { factor: f.factor ** n, dim: f.dim.map((d) => d * n) };
  };
  const unit = (): Factor | null => {
    let f = factor();
    for (skip(); f && at < text.length && text[at] !== ')'; skip()) {
      const divide = text[at] === '/';
      if (divide || text[at] === '*') ++at;
      const g = factor();
      if (!g) return null;
      const s: number = divide ? -1 : 1;
      f = { factor: f.factor * g.factor ** s, dim: f.dim.map((d, i) => d + s * g.dim[i]) };
    }
    return f;
  };
  const f = unit();
  skip();
  return f && at === text.length ? f : null;
}

/** The number in `unit` (the schema's), or what is wrong: 'number', 'unit'. A bare number is in `unit` already. */
export function parseQuantity(text: string, unit: string): number | 'number' | 'unit' {
  const m = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/.exec(text.replace(',', '.'));
  if (!m) return 'number';
  const value = Number(m[1]);
  if (!m[2]) return value;
  const own = parseUnit(m[2]), wanted = parseUnit(unit || '1');
  if (!own || !wanted || own.dim.some((d, i) => d !== wanted.dim[i])) return 'unit';
  return (value * own.factor) / wanted.factor;
}

// Units in which people of the field think.
const kUsual: Record<string, string[]> = {
  'm/s': ['um/s', 'mm/s'], m: ['um', 'mm', 'nm', 'cm'], T: ['uT', 'mT', 'nT'], s: ['s', 'ms', 'us'], A: ['A', 'mA', 'uA'], rad: ['deg'],
  'T/m': ['T/m', 'mT/m'], H: ['mH', 'uH', 'H'],
};
const kMu: Record<string, string> = { um: 'µm', 'um/s': 'µm/s', uT: 'µT', us: 'µs', uA: 'µA', uH: 'µH' };

/** As a person would write it: "186 µm/s" for 0.000186 in m/s. */
export function showQuantity(value: number, unit: string): string {
  let best = unit, scaled = value;
  if (value !== 0)
    for (const u of kUsual[unit] ?? []) {
      const v = (value * parseUnit(unit)!.factor) / parseUnit(u)!.factor;
      if (Math.abs(v) >= 0.1 && Math.abs(v) < 1000) {
        best = u;
        scaled = v;
        break;
      }
    }
  const digits = Number(scaled.toPrecision(6));
  return unit ? `${digits} ${kMu[best] ?? best}` : String(digits);
}
