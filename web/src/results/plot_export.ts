// Figures of a report as files.

import { saveBlob } from '../parts/export';

const kScale = 3; // pixels of a PNG per unit of the figure

/** The figure for print: in light colours, with its legend, without marks of the pointer. */
export function standalone(svg: SVGSVGElement, viewBox: string): string {
  const out = svg.cloneNode(true) as SVGSVGElement, [, , width, height] = viewBox.split(' ');
  for (const e of out.querySelectorAll('[data-pointer]')) e.remove();
  for (const g of out.querySelectorAll('g[data-legend]')) if (out.querySelector(`g[data-layer="${g.getAttribute('data-legend')}"][display="none"]`)) g.remove();
  for (const [name, value] of [['xmlns', 'http://www.w3.org/2000/svg'], ['viewBox', viewBox], ['width', width], ['height', height]]) out.setAttribute(name, value);
  return new XMLSerializer().serializeToString(out) + '\n';
}

export function saveSvg(svg: SVGSVGElement, viewBox: string, name: string) {
  saveBlob(new Blob([standalone(svg, viewBox)], { type: 'image/svg+xml' }), `${name}.svg`);
}

export async function savePng(svg: SVGSVGElement, viewBox: string, name: string) {
  const picture = new Image(), [, , width, height] = viewBox.split(' ').map(Number);
  const address = URL.createObjectURL(new Blob([standalone(svg, viewBox)], { type: 'image/svg+xml' }));
  try {
    picture.src = address;
    await picture.decode();
    const canvas = document.createElement('canvas');
    canvas.width = Math.round(kScale * width);
    canvas.height = Math.round(kScale * height);
    canvas.getContext('2d')!.drawImage(picture, 0, 0, canvas.width, canvas.height);
    const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done));
    if (blob) saveBlob(blob, `${name}.png`);
  } finally {
    URL.revokeObjectURL(address);
  }
}
