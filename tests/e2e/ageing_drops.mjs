// Rendered videos of drops that age in air, and what is known about them.

import { copyFileSync, mkdtempSync, readFileSync, utimesSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { faba, root } from './lab_page.mjs';

export const kExposures = [100, 300, 500, 700]; // s
/** A folder of the user, outside of the lab. */
export const user = mkdtempSync(join(tmpdir(), 'faba-user-'));

/** Videos of one drop that ages in air (scenes/exposure.toml); the times of the files are those of the experiment. */
export function render(drop, seed) {
  return kExposures.map((exposure, k) => {
    const run = join(user, `${drop}-${k}`), sets = { exposure: `${exposure} s`, 'record.video': true, 'record.as_seen': true, 'record.lossless': true, 'record.flow': false };
    faba('run', 'scenes/exposure.toml', '--seed', String(seed + k), '--out', run, '--force', ...Object.entries(sets).flatMap(([key, v]) => ['--set', `${key}=${v}`]));
    const file = join(user, `drop-${drop}-${k}.avi`);
    copyFileSync(join(run, 'video.avi'), file);
    utimesSync(file, 1700000000 + exposure, 1700000000 + exposure);
    return file;
  });
}

/** A study of the recorded runs as a user of the terminal writes it. */
export function studyOfRuns() {
  const video = (drop, exposure, k) => `[[video]]\nfile = "${drop}-${k}"\nexposure = "${exposure} s"\nexperiment = "${drop}"\n`;
  const videos = ['A', 'B'].flatMap((drop) => kExposures.map((exposure, k) => video(drop, exposure, k)));
  writeFileSync(join(user, 'study.toml'), `direction = 0\nfrom = "19 s"\n${videos.join('')}`);
  return join(user, 'study.toml');
}

/** Mean slope without noise, s/s, and smallest and largest cut-off with noise, s, of the seeds of bench/exposure.py. */
export function knownExposure() {
  const seeds = JSON.parse(readFileSync(join(root, 'bench/results/exposure.json'), 'utf8'));
  const cutoffs = seeds.map((s) => s.noisy.cutoff_s);
  return { slope: seeds.reduce((sum, s) => sum + s.noise_free.peak_line.slope, 0) / seeds.length, cutoffs: [Math.min(...cutoffs), Math.max(...cutoffs)] };
}
