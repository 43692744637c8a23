// Units of lengths and currents in the readouts and plots, sizes of files, and the sign of the prefix micro.

export type LengthChoice = 'um' | 'px';
export interface LengthUnit {
  name: 'µm' | 'px';
  /** Length of a pixel in this unit. */
  perPixel: number;
}

/** Micrometres if they are chosen and the scale is known, otherwise pixels. */
export function lengthUnit(umPerPx: number | null | undefined, choice: LengthChoice): LengthUnit {
  return choice === 'um' && umPerPx ? { name: 'µm', perPixel: umPerPx } : { name: 'px', perPixel: 1 };
}

/** A number of pixels in the unit, with one decimal place; "–" if it is not finite. */
export const lengthText = (px: number, unit: LengthUnit) => (Number.isFinite(px) ? (px * unit.perPixel).toFixed(1) : '–');

/** A current with three digits at most, in mA below 1 A; "–" if it is not finite. */
export function currentText(amperes: number): string {
  if (!Number.isFinite(amperes)) return '–';
  const minus = (text: string) => text.replace('-', '−');
  const milliamperes = amperes * 1e3;
  if (Math.abs(milliamperes) >= 999.5) return `${minus(amperes.toFixed(2))} A`;
  const text = milliamperes.toFixed(Math.abs(milliamperes) < 9.95 ? 1 : 0);
  return `${minus(Number(text) === 0 ? '0' : text)} mA`;
}

/** "12.4 MB" with decimal prefixes, as file managers have. */
export function bytesText(bytes: number): string {
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let k = 0, v = bytes;
  while (v >= 999.5 && k < units.length - 1) (v /= 1000), ++k;
  return `${k === 0 || v >= 99.95 ? v.toFixed(0) : v >= 9.995 ? v.toFixed(1) : v.toFixed(2)} ${units[k]}`;
}

/**
 * Writes the prefix micro as µ: "23 uT" becomes "23 µT". Keys such as um_per_px do not change. `us` is a unit only after a
 * number.
 */
export const micro = (text: string) => microAfterNumber(
  text.replace(/(?<![\w.`-])u(?=(?:m|T|A|H|V|N|Pa|W)(?!\w))/g, 'µ'));
/** Likewise, only after a number: in a text of another language "um" can be a word. */
export const microAfterNumber = (text: string) => text.replace(/(?<=\d )u(?=(?:m|T|A|H|V|N|Pa|W)(?!\w))|(?<=\d ?)u(?=s\b)/g, 'µ');
