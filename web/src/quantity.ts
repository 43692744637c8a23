// Quantities with units, as in scenarios: "186 um/s".

type Dim = number[]; // m, kg, s, A, K, mol, px
/** A unit is factor * 10^ten. The separate power of ten makes "7 um" the same double as 7e-6, as in the program. */
export interface Factor {
  factor: number;
  ten: number;
  dim: Dim;
}

const kUnits: Record<string, Factor> = {
  m: { factor: 1, ten: 0, dim: [1, 0, 0, 0, 0, 0, 0] }, g: { factor: 1, ten: -3, dim: [0, 1, 0, 0, 0, 0, 0] },
  s: { factor: 1, ten: 0, dim: [0, 0, 1, 0, 0, 0, 0] }, A: { factor: 1, ten: 0, dim: [0, 0, 0, 1, 0, 0, 0] },
  K: { factor: 1, ten: 0, dim: [0, 0, 0, 0, 1, 0, 0] }, mol: { factor: 1, ten: 0, dim: [0, 0, 0, 0, 0, 1, 0] },
  px: { factor: 1, ten: 0, dim: [0, 0, 0, 0, 0, 0, 1] }, rad: { factor: 1, ten: 0, dim: [0, 0, 0, 0, 0, 0, 0] },
  deg: { factor: Math.PI / 180, ten: 0, dim: [0, 0, 0, 0, 0, 0, 0] }, '%': { factor: 1, ten: -2, dim: [0, 0, 0, 0, 0, 0, 0] },
  Hz: { factor: 1, ten: 0, dim: [0, 0, -1, 0, 0, 0, 0] }, min: { factor: 60, ten: 0, dim: [0, 0, 1, 0, 0, 0, 0] },
  h: { factor: 3600, ten: 0, dim: [0, 0, 1, 0, 0, 0, 0] }, T: { factor: 1, ten: 0, dim: [0, 1, -2, -1, 0, 0, 0] },
  G: { factor: 1, ten: -4, dim: [0, 1, -2, -1, 0, 0, 0] }, N: { factor: 1, ten: 0, dim: [1, 1, -2, 0, 0, 0, 0] },
  J: { factor: 1, ten: 0, dim: [2, 1, -2, 0, 0, 0, 0] }, W: { factor: 1, ten: 0, dim: [2, 1, -3, 0, 0, 0, 0] },
  Pa: { factor: 1, ten: 0, dim: [-1, 1, -2, 0, 0, 0, 0] }, V: { factor: 1, ten: 0, dim: [2, 1, -3, -1, 0, 0, 0] },
  ohm: { factor: 1, ten: 0, dim: [2, 1, -3, -2, 0, 0, 0] }, H: { factor: 1, ten: 0, dim: [2, 1, -2, -2, 0, 0, 0] },
  '1': { factor: 1, ten: 0, dim: [0, 0, 0, 0, 0, 0, 0] },
};
// Powers of ten.
const kPrefixes: Record<string, number> = { f: -15, p: -12, n: -9, u: -6, µ: -6, μ: -6, m: -3, c: -2, k: 3, M: 6, G: 9 };
const kExact = 22; // 10^22 is the largest power of ten that is exact in a double

/** v * 10^n, rounded once when |n| is at most kExact. */
function timesTen(v: number, n: number): number {
  for (; n > kExact; n -= kExact) v *= 1e22;
  for (; n < -kExact; n += kExact) v /= 1e22;
  let p = 1;
  for (let i = 0; i < Math.abs(n); ++i) p *= 10;
  return n < 0 ? v / p : v * p;
}
const converted = (v: number, from: Factor, to: Factor) => timesTen((v * from.factor) / to.factor, from.ten - to.ten);

function named(name: string): Factor | null {
  if (Object.hasOwn(kUnits, name)) return kUnits[name];
  const prefix = kPrefixes[name[0]], rest = name.slice(1);
  if (prefix === undefined || rest === '1' || !Object.hasOwn(kUnits, rest)) return null;
  const unit = kUnits[rest];
  return { ...unit, ten: unit.ten + prefix };
}

/** A unit such as "um/s", "A m^2" or "1/(T s)"; null if invalid. */
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
      const m = /^[^ */^()]+/.exec(text.slice(at));
      if (!m) return null;
      at += m[0].length;
      f = named(m[0]);
    }
    if (!f) return null;
    const p = /^ *\^ *(-?\d)/.exec(text.slice(at));
    if (!p) return f;
    at += p[0].length;
    const n = Number(p[1]);
    return { factor: f.factor ** n, ten: f.ten * n, dim: f.dim.map((d) => d * n) };
  };
  const unit = (): Factor | null => {
    let f = factor();
    for (skip(); f && at < text.length && text[at] !== ')'; skip()) {
      const divide = text[at] === '/';
      if (divide || text[at] === '*') ++at;
      const g = factor();
      if (!g) return null;
      const s: number = divide ? -1 : 1;
      f = { factor: f.factor * g.factor ** s, ten: f.ten + s * g.ten, dim: f.dim.map((d, i) => d + s * g.dim[i]) };
    }
    return f;
  };
  const f = unit();
  skip();
  return f && at === text.length ? f : null;
}

/** The number in `unit` (of the schema), or the invalid part: 'number', 'unit'. A bare number is in `unit`; a comma is a decimal separator. */
export function parseQuantity(text: string, unit: string): number | 'number' | 'unit' {
  const m = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/.exec(text.replace(',', '.'));
  if (!m) return 'number';
  const value = Number(m[1]);
  if (!Number.isFinite(value)) return 'number';
  if (!m[2]) return value;
  const own = parseUnit(m[2]), wanted = parseUnit(unit || '1');
  if (!own || !wanted || own.dim.some((d, i) => d !== wanted.dim[i])) return 'unit';
  return converted(value, own, wanted);
}

// Common units of the field for display.
const kDisplayUnits: Record<string, string[]> = {
  'm/s': ['um/s', 'mm/s'], m: ['um', 'mm', 'nm', 'cm'], T: ['uT', 'mT', 'nT'], s: ['s', 'ms', 'us'], A: ['A', 'mA', 'uA'], rad: ['deg'],
  'T/m': ['T/m', 'mT/m'], H: ['mH', 'uH', 'H'],
};
const kMu: Record<string, string> = { um: 'µm', 'um/s': 'µm/s', uT: 'µT', us: 'µs', uA: 'µA', uH: 'µH' };

/** Formats a value for display: "186 µm/s" for 0.000186 in m/s. */
export function showQuantity(value: number, unit: string): string {
  let best = unit, scaled = value;
  if (value !== 0)
    for (const u of kDisplayUnits[unit] ?? []) {
      const v = converted(value, parseUnit(unit)!, parseUnit(u)!);
      if (Math.abs(v) >= 0.1 && Math.abs(v) < 1000) {
        best = u;
        scaled = v;
        break;
      }
    }
  // A count or a seed is shown with all its digits.
  const digits = !unit && Number.isSafeInteger(scaled) ? scaled : Number(scaled.toPrecision(6));
  return unit ? `${digits} ${kMu[best] ?? best}` : String(digits);
}
