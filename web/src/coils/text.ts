// Numbers of the coil editor, with as many digits as `faba field` prints.

const minus = (text: string) => text.replace('-', '−');
/** With at most n significant digits, without zeros at the end; "–" if it is not known. */
export const significant = (v: number | null | undefined, n: number) => (v == null || !Number.isFinite(v) ? '–' : minus(String(Number(v.toPrecision(n)))));
/** A field in µT or mT with four digits. */
export function fieldText(tesla: number | null | undefined): string {
  if (tesla == null || !Number.isFinite(tesla)) return '–';
  return Math.abs(tesla) >= 0.9995e-3 ? `${significant(tesla * 1e3, 4)} mT` : `${significant(tesla * 1e6, 4)} µT`;
}
/** A length in µm or mm with three digits. */
export function lengthText(metres: number | null | undefined): string {
  if (metres == null || !Number.isFinite(metres)) return '–';
  return Math.abs(metres) >= 0.9995e-3 ? `${significant(metres * 1e3, 3)} mm` : `${significant(metres * 1e6, 3)} µm`;
}
/** Of a zero, in mm with the four decimal places of `faba field map`. */
export const placeText = (metres: number) => minus((Math.round(metres * 1e7) / 1e4 + 0).toFixed(4));
export const degreesText = (rad: number) => `${Math.round(((((rad * 180) / Math.PI) % 360) + 360) % 360)}°`;
