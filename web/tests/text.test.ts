import { beforeAll, describe, expect, test } from 'vitest';
import { RequestError } from '../src/connection';
import { words } from '../src/i18n';
import { loadTexts } from '../src/i18n/program/catalogue';
import { failureText, grouped, jobTitle, placeInFile, programText, reason, withCode } from '../src/text';
import { micro } from '../src/units';

const en = words('en'), pt = words('pt');
beforeAll(() => loadTexts('pt'));

describe('units of the program', () => {
  test.each([
    ['5 field units of 23 uT each', '5 field units of 23 µT each'],
    ['thesis: 186 um/s', 'thesis: 186 µm/s'],
    ['(900 um) and 3 uA, 2 us', '(900 µm) and 3 µA, 2 µs'],
    ['0.5um', '0.5um'],
    ['um_per_px, tick_um and field_x_ut', 'um_per_px, tick_um and field_x_ut'],
    ['tell us', 'tell us'],
    ['must be in um', 'must be in µm'],
  ])('%s', (text, shown) => {
    expect(micro(text)).toBe(shown);
  });
});

describe('fixed texts of the program', () => {
  test('are translated; others and English ones are unchanged', () => {
    expect(programText('simulating', pt)).toBe('simulando');
    expect(programText('simulating', en)).toBe('simulating');
    expect(programText('900 um is out of range', pt)).toBe('900 µm is out of range');
    expect(programText('constructor', pt)).toBe('constructor');
    expect(programText('falta; escolha um valor', pt)).toBe('falta; escolha um valor');
  });
  test('the verb of a job is translated, its file is not', () => {
    expect(jobTitle('field map: simulating.toml', pt)).toBe('mapa do campo: simulating.toml');
    expect(jobTitle('field map: x.toml', en)).toBe('field map: x.toml');
    expect(jobTitle('By-hand (0123)', pt)).toBe('By-hand (0123)');
  });
});

describe('failures', () => {
  test('have the place and the reason', () => {
    expect(failureText({ where: 'swarm[0].count', what: '-1 is out of range' }, en)).toBe('swarm[0].count: -1 is out of range');
    expect(failureText({ where: '', what: 'no run; start a scenario first' }, pt)).toBe('nenhuma execução; inicie antes um cenário');
  });
  test('of the page itself are in its language', () => {
    expect(reason(new RequestError('', 'The server does not answer.', 'no_answer'), pt)).toBe(pt('no_answer'));
    expect(reason(new RequestError('current', 'wrong'), pt)).toBe('current: wrong');
    expect(reason(new Error('3 um'), en)).toBe('3 µm');
  });
});

describe('the place of an error in an imported file', () => {
  test.each([
    ['bad1.toml:2', 'bad1.toml:2'],
    ['bad1.toml:2: swarm[0].count', 'bad1.toml:2: swarm[0].count'],
    ['bad1.toml', 'bad1.toml'],
    ['swarm[0].count', 'bad1.toml: swarm[0].count'],
    ['', 'bad1.toml'],
  ])('%s', (where, shown) => {
    expect(placeInFile('bad1.toml', where)).toBe(shown);
  });
});

describe('a description with code', () => {
  const code = (text: string) => ({ text, code: true }), plain = (text: string) => ({ text, code: false });
  test.each([
    ['no code, 5 um', [plain('no code, 5 µm')]],
    ['run `faba run --set a="5 um"` now', [plain('run '), code('faba run --set a="5 um"'), plain(' now')]],
    ['`a` and `b`', [code('a'), plain(' and '), code('b')]],
    ['one ` backtick', [plain('one ` backtick')]],
    ['`a` one ` more', [code('a'), plain(' one ` more')]],
    ['', []],
  ])('%s', (text, parts) => {
    expect(withCode(text, en)).toEqual(parts);
  });
});

test('large numbers have narrow spaces between groups of three digits', () => {
  expect([7, 1000, 10000, 1000000].map(grouped)).toEqual(['7', '1000', '10\u202f000', '1\u202f000\u202f000']);
});
