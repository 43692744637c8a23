import { describe, expect, test } from 'vitest';
import { addressBeside, sanitised, type Clean, type Source } from '../src/results/sanitise';

const node = (localName: string, attributes: Record<string, string> = {}, children: (Source | string)[] = []): Source => ({
  nodeType: 1,
  localName,
  attributes: Object.entries(attributes).map(([name, value]) => ({ name, value })),
  childNodes: children.map((c) => (typeof c === 'string' ? { nodeType: 3, nodeValue: c, childNodes: [] } : c)),
});
const clean = (...children: Source[]) => sanitised(node('body', {}, children), 'runs/study');
/** The content of a drawing. */
const drawing = (...children: Source[]) => (clean(node('svg', {}, children))[0] as Clean).children;
const attributes = (one: Source) => Object.fromEntries((clean(one)[0] as Clean).attributes);
const drawingAttributes = (one: Source) => Object.fromEntries((drawing(one)[0] as Clean).attributes);

describe('a sanitised report', () => {
  test('keeps text, tables and drawings', () => {
    const [main] = clean(node('main', {}, [node('p', { class: 'lead' }, ['a <b>'])]));
    expect(main).toEqual({ tag: 'p', svg: false, attributes: [['class', 'lead']], children: ['a <b>'] });
    expect(drawingAttributes(node('path', { d: 'M0 0L1 1', class: 's-blue', stroke: '#0072b2', 'data-x': '0 1e-2 0 sJiO-5S' }))).toHaveProperty('data-x');
    expect(clean(node('h1', {}, ['x']))).toMatchObject([{ tag: 'h2' }]);
  });
  test('has no element that runs or loads something, and nothing of its content', () => {
    for (const tag of ['script', 'style', 'iframe', 'object', 'embed', 'link', 'meta', 'base', 'form', 'input', 'template', 'noscript', 'audio', 'source', 'math'])
      expect(clean(node(tag, {}, [node('p', {}, ['x'])])), tag).toEqual([]);
    for (const tag of ['foreignObject', 'script', 'style', 'image', 'use', 'a', 'animate', 'set', 'filter', 'pattern', 'p', 'img', 'div'])
      expect(drawing(node(tag, {}, [node('p', {}, ['x'])])), tag).toEqual([]);
  });
  test('has no handlers, styles and identifiers', () => {
    for (const name of ['onload', 'onclick', 'ONERROR', 'style', 'id', 'name', 'srcdoc', 'srcset', 'href', 'xlink:href', 'formaction', 'tabindex', 'target']) {
      expect(attributes(node('p', { [name]: 'x' })), name).toEqual({});
      expect(drawingAttributes(node('g', { [name]: 'x' })), name).toEqual({});
    }
  });
  test('has no drawing with the address of another file', () => {
    expect(drawingAttributes(node('rect', { fill: 'url(https://example.org/x)', stroke: 'URL (#a)', width: '5', transform: 'u\\72l(x)' }))).toEqual({ width: '5' });
  });
  test('has classes of reports only', () => {
    expect(attributes(node('p', { class: 'note banner hint s-blue' }))).toEqual({ class: 'note s-blue' });
  });
  test('has pictures in data addresses and files of its folder only', () => {
    const src = (value: string) => attributes(node('img', { src: value })).src;
    expect(src('data:image/png;base64,AAAA')).toBe('data:image/png;base64,AAAA');
    expect(src('video.png')).toBe('/runs/study/video.png');
    for (const bad of ['https://example.org/a.png', '//example.org/a.png', '/api/runs', '../a.png', 'x/../../a.png', 'data:image/svg+xml,<svg>', 'data:text/html,x', 'javascript:alert(1)', 'a\\b.png', '.hidden', 'a/.hidden', '%2e%2e/a.png', 'x?token=1', 'x#y'])
      expect(src(bad), bad).toBeUndefined();
  });
  test('has links to files of its folder only', () => {
    const href = (value: string) => attributes(node('a', { href: value })).href;
    expect(href('video.mp4')).toBe('/runs/study/video.mp4');
    for (const bad of ['javascript:alert(1)', ' javascript:alert(1)', 'java\nscript:alert(1)', 'data:image/png;base64,AAAA', 'https://example.org', '#/lab']) expect(href(bad), bad).toBeUndefined();
  });
  test('comments are dropped', () => {
    expect(sanitised({ nodeType: 1, childNodes: [{ nodeType: 8, nodeValue: 'x', childNodes: [] }] }, 'runs')).toEqual([]);
  });
});

test('a file beside a report has a plain relative name', () => {
  expect(addressBeside('runs/a', 'pictures/one 1.png')).toBe('/runs/a/pictures/one 1.png');
  expect(addressBeside('runs/a', 'a//b')).toBeNull();
});
