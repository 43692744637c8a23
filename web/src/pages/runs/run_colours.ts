// Colours of overlaid runs, distinguishable with colour blindness (Okabe and Ito), with at least 3:1 contrast on the plots.

const kLight = ['#0072b2', '#c44f00', '#007a59', '#a34a8a', '#7a6100', '#3d4c5a', '#1b87c9', '#b3311e'];
const kDark = ['#56b4e9', '#ff9a4d', '#2fc49a', '#e093c8', '#f0e442', '#c6d0da', '#8cc9f0', '#ff8f7a'];

/** The number of runs with different colours. */
export const kMostOverlaid = kLight.length;
export const runColour = (run: number, dark: boolean) => (dark ? kDark : kLight)[run % kMostOverlaid];
