// Test of the plan of a controller in the live lab: predicted path, error of the estimate, active limits; obstacles and paths are
// drawn by pointer and keyboard.
//
//   node tests/e2e/plan_test.mjs --program build/faba --root . [--pictures FOLDER] [--www web/dist]

import assert from 'node:assert/strict';
import { address, finish, page, place, read, shot, step, until } from './lab_page.mjs';

const lab = (what) => page.evaluate((name) => JSON.parse(JSON.stringify(document.querySelector('canvas.over').lab[name])), what);
const controller = async () => (await lab('scenario')).controller;
const corners = async () => ((await controller()).obstacle ?? []).map((o) => o.corners_px);
const plan = async () => (await lab('frame'))?.plan ?? null;
const button = (name) => page.getByRole('button', { name, exact: true });
const click = async (q) => page.mouse.click(...(await place(...q)));
/** Whether a point is inside a box of left, top, right, bottom. */
const within = ([x, y], [left, top, right, bottom]) => x > left && x < right && y > top && y < bottom;
const near = (a, b, reach) => a.length === b.length && a.every((v, i) => Math.abs(v - b[i]) <= reach);
/** The overlay on the picture, for comparison. */
const drawn = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(document.querySelector('canvas.over').toDataURL())))));

const kWall = [280, 180, 360, 300]; // between the swarm and its setpoint

await step('a controller without a plan shows none', async () => {
  await page.goto(address);
  await page.getByRole('button', { name: 'Steer a swarm along a route' }).click();
  await until(async () => (await read('swarm'))[0] > 0, 'the swarm is shown');
  await button('Close').click();
  assert.equal(await page.locator('[data-read="plan"]').count(), 0);
  assert.equal(await page.getByLabel('Plan', { exact: true }).count(), 0);
  assert.equal(await plan(), null);
});

await step('an obstacle is drawn with the mouse; the page asks for a controller that avoids it', async () => {
  await button('Draw obstacle').click();
  const [left, top, right, bottom] = kWall;
  for (const q of [[left, top], [right, top], [right, bottom]]) await click(q);
  await page.locator('[data-read="drawing"]').getByText('corners: 3').waitFor();
  await page.mouse.dblclick(...(await place(left, bottom)));
  await page.getByText('The present controller (proportional) does not avoid obstacles.').waitFor();
  assert.equal((await controller()).type, 'proportional');
  await shot('plan-switch');
  await button('Switch to mpc').click();
  await until(async () => (await controller()).type === 'mpc', 'the controller is exchanged');
  assert.ok(near((await corners())[0].flat(), [left, top, right, top, right, bottom, left, bottom], 3), JSON.stringify(await corners()));
  await button('✕ Remove obstacle 1').waitFor();
});

await step('the predicted path and the error of the estimate are shown', async () => {
  await page.evaluate(() => document.querySelector('canvas.over').lab.exchange({ estimator: { type: 'kalman' } }));
  await click([500, 240]);
  await until(async () => Number(await page.locator('[data-read="plan"]').getAttribute('data-points')) > 2, 'a plan');
  await until(async () => /^semi-axes [\d.]+ × [\d.]+ px \(at the time of the command\)$/.test(await page.locator('[data-read="error"]').textContent()), 'an ellipse');
  const [major, minor] = await read('error'), [sx] = await read('spread');
  assert.ok(major >= minor && minor > 0 && major < sx, `the error of the centroid is smaller than the swarm: ${major}, ${minor}, ${sx} px`);
  // Of one frame: a slow machine draws several between two readings. The controller sees the cells in view, and the drop is larger than
  // it. Frames in which the solver of the controller does not converge have no plan.
  let now = null;
  await until(async () => {
    now = await page.evaluate(() => {
      const { frame, scene } = document.querySelector('canvas.over').lab, { box, view } = scene;
      if (!frame?.plan) return null;
      const kx = (box.right - box.left) / 65535, ky = (box.bottom - box.top) / 65535;
      const all = Array.from({ length: frame.cells }, (_, i) => [box.left + kx * frame.xy[2 * i], box.top + ky * frame.xy[2 * i + 1]]);
      const seen = all.filter(([x, y]) => x >= 0 && y >= 0 && x < view.width && y < view.height);
      return { ...frame.plan, swarm: [0, 1].map((k) => seen.reduce((sum, q) => sum + q[k], 0) / seen.length) };
    });
    return now;
  }, 'a frame with a plan');
  const { path, step: dt, swarm } = now;
  assert.ok(Math.hypot(path[0][0] - swarm[0], path[0][1] - swarm[1]) < 25, `the path does not begin at the swarm: ${path[0]}, ${swarm}`);
  assert.ok(dt > 0);
});

await step('each layer can be switched off', async () => {
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('button', { name: 'Resume' }).waitFor();
  await until(async () => {
    if (await plan()) return true;
    await page.getByRole('button', { name: 'Next frame' }).click();
    await page.waitForTimeout(200);
    return false;
  }, 'a paused frame with a plan');
  let complete = null; // the last frame may still be on its way
  await until(async () => {
    const before = await drawn();
    await page.waitForTimeout(300);
    complete = await drawn();
    return complete === before;
  }, 'a picture of a paused run that does not change');
  for (const layer of ['Plan', 'Error of the estimate', 'Obstacles']) {
    const box = page.getByLabel(layer, { exact: true });
    await box.uncheck();
    await until(async () => (await drawn()) !== complete, `${layer} is not drawn`);
    await box.check();
    await until(async () => (await drawn()) === complete, `${layer} is drawn again`);
  }
  await shot('plan');
  await page.getByRole('button', { name: 'Resume' }).click();
});

await step('the swarm and its plan go around the obstacle, and the limits are named', async () => {
  await until(async () => (await read('goal'))[0] < 20, 'the swarm is at the right of the obstacle');
  await click([140, 240]);
  await until(async () => (await read('goal'))[0] > 200, 'a setpoint behind the obstacle');
  const limits = new Set();
  await until(async () => {
    const { path } = (await plan()) ?? { path: [] };
    for (const q of path) assert.ok(!within(q, [kWall[0] + 4, kWall[1] + 4, kWall[2] - 4, kWall[3] - 4]), `the plan enters the obstacle at ${q}`);
    for (const one of await page.locator('[data-limit]').evaluateAll((all) => all.map((e) => e.dataset.limit))) limits.add(one);
    const swarm = await read('swarm');
    assert.ok(!within(swarm, kWall), `the swarm is in the obstacle at ${swarm}`);
    return (await read('goal'))[0] < 12;
  }, 'the setpoint is reached');
  assert.ok(limits.size > 0, 'no limit was active on the way');
  // At the setpoint the command is small.
  await until(async () => (await page.locator('[data-read="limits"]').textContent()).trim() === 'none', 'no limit is active at the setpoint');
});

await step('an obstacle is drawn, cancelled and removed by keyboard', async () => {
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
  };
  const before = await corners();
  await button('Draw obstacle').focus();
  await press('Enter');
  await page.getByRole('application', { name: 'Drawing area: Draw obstacle' }).waitFor();
  const running = await lab('running');
  await press('ArrowRight', ' ', 'Escape');
  await page.getByRole('application').waitFor({ state: 'detached' });
  await button('Draw obstacle').focus();
  await press('Enter');
  await press(...Array(10).fill('ArrowUp'), ' ', ' ', ...Array(4).fill('ArrowRight'), ' ', 'Enter');
  await page.getByText('An obstacle needs at least 3 corners.').waitFor();
  await press(...Array(3).fill('ArrowUp'), 'Shift+ArrowUp', ' ');
  await page.locator('[data-read="drawing"]').getByText('corners: 3, cross-hair at').waitFor();
  await shot('plan-keyboard');
  await press('Enter');
  await until(async () => (await corners()).length === 2, 'the second obstacle');
  const [a, b, c] = (await corners())[1];
  assert.deepEqual([b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]], [40, 0, 0, -31]);
  assert.equal(await lab('running'), running, 'Space did not pause the run');
  assert.equal((await controller()).type, 'mpc');
  await button('✕ Remove obstacle 2').focus();
  await press('Enter');
  await until(async () => (await corners()).length === 1, 'the obstacle is removed');
  assert.deepEqual(await corners(), before);
  await press('Control+z');
  await until(async () => (await corners()).length === 2, 'the removal is undone');
});

await step('a path is drawn and followed', async () => {
  await button('Draw path').click();
  const points = [[480, 200], [420, 150], [360, 130]];
  for (const q of points) await click(q);
  await page.locator('[data-read="drawing"]').getByText('points: 3').waitFor();
  await shot('plan-path');
  await page.keyboard.press('Enter');
  await until(async () => {
    const { reference } = await lab('scenario'), sent = reference.points_px ?? reference.setpoints_px;
    return sent?.length === 3 && near(sent.flat(), points.flat(), 3);
  }, 'the path is in the scenario');
  await until(async () => (await read('swarm'))[0] < 440, 'the swarm follows the path');
});

await finish();
