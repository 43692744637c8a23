import { describe, expect, test } from 'vitest';
import { automatic, histogramPath, limited, sliderRange, sliderStep, type Histogram } from '../src/video/contrast';

const dim: Histogram = { least: 58, most: 337, step: 70, low: 61, high: 290, counts: [4, 0, 16, 1] };

describe('the sliders', () => {
  test('range over the grey scale of 8 bits', () => {
    expect(sliderRange(8, dim, { low: 10, high: 20 })).toEqual({ low: 0, high: 255 });
  });
  test('range over the values in the picture of more bits, and include the present contrast', () => {
    expect(sliderRange(16, dim, { low: 61, high: 290 })).toEqual({ low: 58, high: 337 });
    expect(sliderRange(16, dim, { low: 0, high: 65535 })).toEqual({ low: 0, high: 65535 });
  });
  test('have steps of one grey value, smaller ones for float pictures', () => {
    expect(sliderStep({ low: 58, high: 337 })).toBe(1);
    expect(sliderStep({ low: 0, high: 1 })).toBe(0.001);
    expect(sliderStep({ low: 3, high: 3 })).toBeGreaterThan(0);
  });
  test('do not pass each other', () => {
    expect(limited({ low: 300, high: 200 }, 'low', 1)).toEqual({ low: 199, high: 200 });
    expect(limited({ low: 300, high: 200 }, 'high', 1)).toEqual({ low: 300, high: 301 });
    expect(limited({ low: 10, high: 200 }, 'low', 1)).toEqual({ low: 10, high: 200 });
  });
});

test('automatic contrast uses the quantiles, and is never empty', () => {
  expect(automatic(dim)).toEqual({ low: 61, high: 290 });
  expect(automatic({ ...dim, low: 60, high: 60 })).toEqual({ low: 58, high: 337 });
  expect(automatic({ ...dim, least: 7, most: 7, low: 7, high: 7 })).toEqual({ low: 7, high: 8 });
});

test('the histogram has a bar for each count, and the largest is as high as the plot', () => {
  const path = histogramPath(dim, { low: 58, high: 337 }, 279, 100);
  expect(path.match(/V/g)!.length).toBe(dim.counts.length + 1);
  expect(path).toContain('V0.0H210.0');
  expect(path).toContain('V50.0H70.0'); // sqrt(4) of sqrt(16)
});
