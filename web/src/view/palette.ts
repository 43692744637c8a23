// Colour-blind-safe colours of the microscope view (Okabe and Ito), light and dark.

import type { Rgb, Style } from './cells';
import type { Palette, Scene } from './overlay';

const kSwarms: Record<'light' | 'dark', Rgb[]> = {
  light: [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167]],
  dark: [[86, 180, 233], [230, 159, 0], [0, 200, 150], [230, 150, 195]],
};
const kCell = 1.25; // um, radius of a dot

export const cellColours = (dark: boolean): Pick<Style, 'colours' | 'mute' | 'ground'> => ({
  colours: kSwarms[dark ? 'dark' : 'light'],
  mute: dark ? [96, 104, 112] : [160, 166, 172],
  ground: dark ? [11, 16, 23] : [240, 243, 246],
});
/** Radius of a dot, image px. */
export const cellRadius = (view: Scene['view']) => kCell / (view.um_per_px ?? view.nominal_um_per_px ?? 1);

export const overlayColours = (dark: boolean): Palette =>
  dark
    ? { edge: '#8fa3b8', outside: 'rgba(4, 8, 14, 0.45)', text: '#d8e0ea', field: '#d5b83c', swarm: '#2fd08c', target: '#d48bff', wrong: '#ff9b80', halo: 'rgba(11, 16, 23, 0.75)' }
    : { edge: '#5a6b7d', outside: 'rgba(120, 130, 140, 0.18)', text: '#26323d', field: '#8a6d00', swarm: '#00784f', target: '#8a2bb8', wrong: '#a8321b', halo: 'rgba(246, 248, 250, 0.75)' };
