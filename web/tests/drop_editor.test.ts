// The editor as HTML, rendered without a browser: the scale of a picture is never assumed.
import { render } from 'svelte/server';
import { expect, test } from 'vitest';
import { words } from '../src/i18n';
import DropEditor from '../src/parts/DropEditor.svelte';

const drop = { picture: 'drop.png', url: '/x', image_size: [640, 480] as [number, number], center_px: [320, 231] as [number, number], radius_px: 150, found: true };
const kNothing = () => {};

/** The value of the input for the scale: empty if it has none, null if there is no such input. */
function scaleInput(html: string): string | null {
  const input = html.match(/<input[^>]*min="0\.001"[^>]*>/)?.[0];
  return input === undefined ? null : (input.match(/ value="([^"]*)"/)?.[1] ?? '');
}
const editor = (um_per_px?: number | null) => render(DropEditor, { props: { say: words('en'), drop: { ...drop, um_per_px }, may: true, onstart: kNothing, oncancel: kNothing } }).body;

test('a picture without a scale has an empty input for it, and the drop can be started', () => {
  for (const scale of [undefined, null]) {
    const html = editor(scale);
    expect(scaleInput(html)).toBe('');
    expect(html).toContain(words('en')('gallery.no_scale'));
    expect(html).not.toContain('disabled');
  }
});
test('the scale of the metadata of a picture is in its input', () => {
  const html = editor(0.65);
  expect(scaleInput(html)).toBe('0.65');
  expect(html).not.toContain(words('en')('gallery.no_scale'));
});
