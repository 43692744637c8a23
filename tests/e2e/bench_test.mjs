// The page Bench on a simulated bench: captures, step responses, runs and jog; arming, and the coils off from every page; the
// first-run assistant. With --pictures FOLDER it saves screenshots of the page in FOLDER.
//
//   node tests/e2e/bench_test.mjs --program build/faba --root . [--pictures FOLDER]

import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { address, complaints, context, finish, kJobPatience, lab, page, read, shot, step, tab, until, workspace } from './lab_page.mjs';

const kPeriod = 4; // s between step responses; one takes 2.5 s
// Long deadlines of the guard: the bench is simulated, and the computer need not be a real-time system.
writeFileSync(
  join(workspace, 'scenes/console.toml'),
  readFileSync(join(workspace, 'scenes/bench.toml'), 'utf8').replace('rate = "60 Hz"', 'rate = "30 Hz"') +
    '\n[rig.guard]\nheartbeat_deadline = "1 s"\ncommand_deadline = "1 s"\n\n[rig.step_response]\ngather = "1 s"\nbefore = "0.5 s"\nrecord = "1 s"\nfield = "20 uT"\n',
);
const send = (path, body, on = page) =>
  on.evaluate(([p, b]) => fetch(p, b === undefined ? {} : { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(b) }).then(async (r) => ({ status: r.status, ...(await r.json()) })), [path, body]);
const bench = () => send('/api/bench');
const part = (name) => page.getByRole('navigation', { name: 'Bench' }).getByRole('link', { name, exact: true }).click();
const button = (name, on = page) => on.getByRole('button', { name, exact: true });
const bar = (on = page) => on.getByRole('region', { name: 'Coils' });
const word = (text, on = page) => bar(on).getByRole('status').filter({ hasText: text }).waitFor();
const toml = (name) => readFileSync(join(workspace, `experiments/${name}/experiment.toml`), 'utf8');
const idle = async () => {
  const end = Date.now() + kJobPatience;
  while (Date.now() < end) {
    const state = await bench();
    if (!state.activity) return state;
    await page.waitForTimeout(100);
  }
  assert.fail('the activity does not end');
};
/** Opens the dialog with a button of the page, and confirms it. */
async function arm(open, confirm, on = page) {
  await button(open, on).click();
  const dialog = on.getByRole('dialog');
  await dialog.getByLabel('I can see the coils').check();
  await button(confirm, dialog).click();
  await dialog.waitFor({ state: 'detached' });
}
/** The browser reports refused requests on the console. */
const refusedOnPurpose = () => (complaints.length = 0);

await step('the camera opens, with picture, estimate and histogram; the bar shows disarmed coils', async () => {
  await page.goto(address);
  await tab('Bench');
  assert.equal(await bar().count(), 0);
  await page.getByLabel('Scene with a bench').selectOption('console');
  await button('Open the camera').click();
  const picture = page.getByAltText('Camera picture');
  await until(() => picture.evaluate((i) => i.naturalWidth === 640).catch(() => false), 'a picture is shown');
  await word('Coils disarmed');
  await until(async () => /estimate: \d+ cells at \(\d+, \d+\) px/.test(await page.locator('.caption').textContent()), 'the estimate is shown');
  const before = (await read('frames'))[0];
  await until(async () => (await read('frames'))[0] > before, 'the frames are counted');
  await page.getByRole('img', { name: /^Histogram of the grey levels: mean \d+ of 255/ }).waitFor();
  await shot('console');
});

await step('the air exposure of the sample is a clock', async () => {
  assert.equal(await page.locator('[data-read="exposure"]').textContent(), 'unknown');
  await button('The sample was put on the slide now').click();
  await until(async () => /^0:0[2-9]$/.test(await page.locator('[data-read="exposure"]').textContent()), 'the clock runs');
  await page.getByLabel('or exposed for').fill('5');
  await button('Set').click();
  await until(async () => /^5:0\d$/.test(await page.locator('[data-read="exposure"]').textContent()), 'the exposure is set');
});

await step('a capture of a number of frames writes numbered pictures', async () => {
  await part('Capture');
  await page.getByRole('radio', { name: 'a number of frames' }).check();
  const frames = page.getByRole('textbox', { name: 'a number of frames' });
  await frames.fill('2.5');
  await page.getByRole('alert').filter({ hasText: '“2.5” is not valid; it must be an integer' }).waitFor();
  assert.ok(await button('Start the capture').isDisabled());
  await frames.fill('20');
  await page.getByRole('radio', { name: 'one of this number of frames' }).check();
  await page.getByRole('textbox', { name: 'one of this number of frames' }).fill('4');
  await page.getByLabel('Format').selectOption('pgm');
  await page.getByLabel('Name').fill('still');
  await button('Start the capture').click();
  const last = (await idle()).finished[0];
  assert.deepEqual([last.ok, last.taken, last.kept], [true, 20, 5]);
  const folder = readdirSync(join(workspace, 'captures'));
  assert.equal(folder.length, 1);
  assert.match(folder[0], /^still-\d{8}-\d{6}$/);
  assert.equal(readdirSync(join(workspace, 'captures', folder[0])).filter((f) => f.endsWith('.pgm')).length, 5);
});

await step('a capture until stopped counts live, and is a video of an experiment with its drop and exposure', async () => {
  await send('/api/experiments', { title: 'Bench' });
  await page.reload();
  await button('Start the capture').waitFor(); // the address has the part
  await page.getByRole('radio', { name: 'until stopped' }).check();
  await page.getByRole('radio', { name: 'all', exact: true }).check();
  await page.getByLabel('Format').selectOption('avi');
  await page.getByLabel('Name').fill('film');
  await page.getByLabel('Experiment').selectOption('bench');
  await page.getByLabel('Drop').fill('A');
  await button('Start the capture').click();
  await until(async () => (await read('count-kept'))[0] > 10, 'kept frames are counted');
  assert.equal((await read('count-corrupt'))[0], 0);
  assert.match(await page.locator('[data-read="memory"]').textContent(), /used, .* free/);
  assert.ok(await button('Close the camera').isDisabled());
  await shot('capture');
  await button('Stop and save').click();
  const last = (await idle()).finished[0];
  assert.equal(last.ok, true);
  assert.match(last.out, /^experiments\/bench\/videos\/film-\d{8}-\d{6}\.avi$/);
  assert.ok(existsSync(join(workspace, last.out)));
  assert.match(toml('bench'), /drop = "A"/);
  assert.match(toml('bench'), /exposure = "3\d\d\.\d s"/);
  await page.getByRole('link', { name: last.out }).click();
  await page.getByText(/640 × 480/).first().waitFor();
  await page.goBack();
});

await step('arming is deliberate: Cancel has the focus, and the button needs the confirmation', async () => {
  await part('Closed loop');
  await button('Run the control loop …').click();
  const dialog = page.getByRole('dialog');
  await dialog.getByText('The permit is valid for').waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Cancel');
  assert.ok(await button('Arm the coils and run', dialog).isDisabled());
  await dialog.getByText('±400 mA').first().waitFor();
  await shot('arm');
  await page.keyboard.press('Enter');
  await dialog.waitFor({ state: 'detached' });
  assert.equal((await bench()).activity, null);
});

await step('a run continues when its page is reloaded, and the bar shows it on every page', async () => {
  await page.getByLabel('Duration').fill('60');
  await arm('Run the control loop …', 'Arm the coils and run');
  await word('Coils armed');
  await shot('armed');
  await page.reload();
  await word('Coils armed');
  await tab('Gallery');
  await bar().getByText('Closed loop').waitFor();
  await bar().getByText(/\d+:\d\d left/).waitFor();
});

await step('another page sees the state, cannot arm, and can switch the coils off', async () => {
  const other = await context.newPage();
  await other.goto(new URL('/#/bench/run', address).href);
  await word('Coils armed', other);
  await other.getByText('this page shows the bench and can switch the coils off').waitFor();
  assert.ok(await button('Run the control loop …', other).isDisabled());
  assert.ok((await send('/api/bench/permit', { page: 1, what: 'run' }, other)).status >= 400);
  await bar(other).getByRole('button', { name: 'Coils off' }).click();
  await word('Coils disarmed', other);
  await word('Coils disarmed');
  await other.close();
  const last = (await idle()).finished[0];
  assert.equal(last.what, 'stopped by the user');
  assert.ok(existsSync(join(workspace, last.out, 'report.html')));
  refusedOnPurpose();
});

await step('F9 switches the coils off, also from an input', async () => {
  await tab('Bench');
  await part('Closed loop');
  await arm('Run the control loop …', 'Arm the coils and run');
  await word('Coils armed');
  await page.getByLabel('or exposed for').focus();
  await page.keyboard.press('F9');
  await word('Coils disarmed');
  await idle();
});

await step('step responses on a schedule are videos of an experiment with field, reversal and polarity', async () => {
  await part('Step responses');
  await page.getByLabel('Responses', { exact: true }).fill('2');
  await page.getByLabel('One every').fill('2');
  await page.getByRole('alert').filter({ hasText: '2 s is shorter than one response, which takes 2.5 s' }).waitFor();
  assert.ok(await button('Record step responses …').isDisabled());
  await page.getByLabel('One every').fill(String(kPeriod));
  await page.getByRole('img', { name: 'Schedule of 2 step responses, 0:06 in total' }).waitFor();
  await page.getByLabel('Experiment').selectOption('bench');
  await page.getByLabel('Drop').fill('B');
  await shot('response');
  await arm('Record step responses …', 'Arm the coils and record');
  await word('Coils armed');
  const state = await idle();
  assert.equal(state.finished[0].ok, true, state.finished[0].what);
  const text = toml('bench');
  assert.equal(text.match(/field_strength = "20 uT"/g)?.length, 2);
  // In the time of the video: 0.5 s, or less if the camera has dropped frames before.
  const reversals = [...text.matchAll(/reversal = "([\d.]+) s"/g)].map((m) => Number(m[1]));
  assert.equal(reversals.length, 2);
  assert.ok(reversals.every((t) => t > 0.2 && t <= 0.5 + 1 / 30), reversals.join());
  assert.match(text, /name = "B"\s+polarity = "(north|south)"|polarity = "(north|south)"\s+name = "B"/);
});

await step('jog: the sensed current follows, and the coils are off when the panel is left', async () => {
  await part('Jog');
  await arm('Jog …', 'Arm the coils and jog');
  await word('Coils armed');
  const current = page.getByLabel('Coil 1, current in mA');
  await current.fill('100');
  await current.press('Enter');
  await until(async () => Math.abs((await bench()).coils[0].sensed_a - 0.1) < 0.01, 'the current is sensed');
  await page.locator('fieldset.coil').first().getByText(/^sensed (9|10)\d mA$/).waitFor();
  await shot('jog');
  await current.fill('9999');
  await current.press('Enter');
  // A current above the limit is not sent: a decimal point may be missing.
  await page.getByRole('alert').filter({ hasText: '“9999” was not sent' }).waitFor();
  assert.equal(await current.inputValue(), '100');
  await page.locator('h2').first().click();
  await button('Coil 2: +20 mA').click();
  await until(async () => (await bench()).coils[1].current_a > 0.019, 'a step of another coil');
  await page.keyboard.press(' '); // the focus is on the button: the key does not press it again
  await until(async () => (await bench()).coils.every((c) => c.current_a === 0), 'all currents are zero');
  await tab('Gallery');
  await word('Coils disarmed');
  assert.equal((await idle()).armed, false);
});

await step('the permit of a page that was reloaded does not arm', async () => {
  const number = () => page.evaluate(() => window.__page);
  await page.addInitScript(() => {
    const Plain = WebSocket;
    window.WebSocket = class extends Plain {
      constructor(...args) {
        super(...args);
        this.addEventListener('message', (m) => typeof m.data === 'string' && JSON.parse(m.data).say === 'hello' && (window.__page = JSON.parse(m.data).page));
      }
    };
  });
  await page.reload();
  await until(async () => (await number()) > 0, 'the page has a number');
  const old = await number();
  const { permit } = await send('/api/bench/permit', { page: old, what: 'run' });
  assert.match(permit, /^[0-9a-f]{16,}$/);
  await page.reload();
  await until(async () => (await number()) > old, 'the page has another number');
  for (const asked of [old, await number()]) assert.ok((await send('/api/bench/run', { page: asked, permit, duration_s: 5, name: 'x' })).status >= 400);
  assert.equal((await bench()).activity, null);
  refusedOnPurpose();
});

await step('the first-run assistant checks a coil and writes the coil table as a scene', async () => {
  await tab('Bench');
  await part('First run');
  await arm('Jog …', 'Arm the coils and jog');
  const wait = word('Coils armed');
  await button('Coil 1: +20 mA').click();
  await wait;
  await page.getByLabel('Only the lamp of this coil.').check();
  await button('2. Polarity').click();
  await page.getByLabel('No, in the opposite direction.').check();
  await button('3. Current sensing').click();
  await button('Measure').click();
  await page.getByText(/^The largest difference is .* within sense_tolerance = 50 mA/).waitFor();
  await shot('assistant');
  await button('4. Calibration').click();
  await page.getByText('The output is at 2.5 V').waitFor();
  for (const [i, pair] of [['0', '-0.52'], ['2.5', '0.01'], ['5', '0.005']].entries()) {
    await button('Add an empty row').click();
    await page.getByLabel(`Volts, row ${i + 1}`).fill(pair[0]);
    await page.getByLabel(`Amperes, row ${i + 1}`).fill(pair[1]);
  }
  await page.getByRole('alert').filter({ hasText: 'From 2.5 V to 5 V the current changes from 0.01 A to 0.005 A' }).waitFor();
  await page.getByLabel('Amperes, row 3').fill('0.49');
  await page.getByRole('img', { name: 'Amperes against volts, 3 pairs' }).waitFor();
  await button('End, coils off').click();
  await word('Coils disarmed');
  await page.reload(); // the results are kept
  await button('5. Coil table').click();
  await page.getByText('Coil 2: Lamp, Polarity, Current sensing, Calibration').waitFor();
  assert.match(await page.locator('[data-read="coils"]').textContent(), /^\[\[rig\.coil\]\]\nchannel = "0"\npolarity = -1\ntable = \[\[0, -0\.52\], \[2\.5, 0\.01\], \[5, 0\.49\]\]\n/);
  await page.getByLabel('Name of the new scene').fill('measured');
  await button('Save as scene').click();
  await page.getByText('Saved as scenes/measured.toml').waitFor();
  const saved = readFileSync(join(workspace, 'scenes/measured.toml'), 'utf8');
  assert.equal(saved.match(/\[\[rig\.coil\]\]/g).length, 4);
  assert.match(saved, /One scenario for simulation and bench/);
  await button('Save as scene').click();
  await page.getByRole('alert').filter({ hasText: 'exists; choose another name' }).waitFor();
  refusedOnPurpose();
});

await step('without the server the state of the coils is unknown', async () => {
  await part('Closed loop');
  await arm('Run the control loop …', 'Arm the coils and run');
  await word('Coils armed');
  lab.kill('SIGKILL');
  await word('Coils: state unknown');
  await bar().getByText('The guard switches them off without the server').waitFor();
  await bar().getByRole('button', { name: 'Coils off' }).click();
  await page.getByRole('alert').filter({ hasText: 'use the switch of the power supply' }).first().waitFor();
  await shot('unknown');
  refusedOnPurpose();
});

await finish();
