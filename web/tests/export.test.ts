import { describe, expect, test } from 'vitest';
import { svgOf } from '../src/parts/export';

const kTexts = { time: 'tempo (s)', earlier: 'previous run' };
const kLine = [{ label: 'Bx', colour: '#123456' }];
const paths = (svg: string) => [...svg.matchAll(/<path d="([^"]*)" fill="none" stroke="#123456"/g)].map((m) => m[1]);
const tickLabels = (svg: string) => [...svg.matchAll(/text-anchor="(?:middle|end)">(-?[\d.e-]+)</g)].map((m) => Number(m[1]));

describe('a plot as SVG', () => {
  test('spans the axes from the lowest to the highest value', () => {
    const svg = svgOf('Field', 'uT', [[0, 1, 2], [-5, 0, 5]], kLine, kTexts);
    expect(paths(svg)).toEqual(['M70.0 276.0L349.0 153.0L628.0 30.0']);
  });
  test('a missing value interrupts the line', () => {
    const svg = svgOf('Field', 'uT', [[0, 1, 2, 3, 4], [0, 1, null, 3, 4]], kLine, kTexts);
    expect(paths(svg)[0].match(/M/g)).toHaveLength(2);
  });
  test('times of another run do not interrupt the line, and the other run is dashed', () => {
    const svg = svgOf('Field', 'uT', [[0, 1, 2], [0, undefined, 4], [undefined, 2, undefined]], kLine, kTexts);
    expect(paths(svg)[0]).toBe('M70.0 276.0L628.0 30.0');
    expect(svg.match(/stroke-dasharray/g)).toHaveLength(1);
    expect(svg).toContain('Bx (previous run)');
  });
  test('ticks are round numbers within the axes', () => {
    const labels = tickLabels(svgOf('Field', 'uT', [[0, 10], [0, 0.7]], kLine, kTexts));
    expect(labels).toEqual([0, 2, 4, 6, 8, 10, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
  });
  test('a constant and an empty plot have finite coordinates', () => {
    expect(svgOf('Field', 'uT', [[0, 1], [3, 3]], kLine, kTexts)).not.toMatch(/NaN|Infinity/);
    expect(svgOf('Field', 'uT', [[], []], kLine, kTexts)).not.toMatch(/NaN|Infinity/);
  });
  test('text is escaped', () => {
    const svg = svgOf('a < b & c', '<px>', [[0, 1], [0, 1]], kLine, kTexts);
    expect(svg).toContain('a &lt; b &amp; c');
    expect(svg).toContain('&lt;px>');
  });
});
