// Steps of lab_test.mjs on the workbench: undo, header, units, history of the plots, columns, keys, small screens.

import assert from 'node:assert/strict';
import { page, place, read, shot, step, tab, until } from './lab_page.mjs';

/** In a run of the scene `steer`, with a controller in charge that replaced the manual field. */
export async function workbenchSteps() {
  await step('the last change is undone with Ctrl+Z and with the button', async () => {
    const setpoint = () => page.evaluate(() => document.querySelector('canvas.over').lab.scene.setpoints.flat().map(Math.round).join());
    const first = await setpoint();
    await page.mouse.click(...(await place(400, 200)));
    await until(async () => (await setpoint()) === '400,200', 'another setpoint');
    await page.keyboard.press('Control+z');
    await until(async () => (await setpoint()) === first, 'the setpoint is undone');
    assert.match(await page.locator('[data-read="controller"]').textContent(), /^feedback/);
    await page.getByRole('button', { name: 'Undo change' }).click(); // the setpoint, and the controller in place of the manual field
    await until(async () => (await page.locator('[data-read="controller"]').textContent()) === 'manual field', 'the manual field is in charge again');
    await page.mouse.click(...(await place(250, 300)));
    await until(async () => (await setpoint()) === '250,300', 'the setpoint is set again');
  });

  await step('the header, units, and currents of the coils', async () => {
    assert.equal(await page.locator('[data-read="title"]').textContent(), 'Steer a swarm along a route');
    assert.match(await page.locator('[data-read="model"]').textContent(), /^dipole/);
    assert.match(await page.locator('[data-read="rate"]').textContent(), /^60 Hz$/);
    await until(async () => (await read('real-time'))[0] > 0, 'the real-time factor is shown');
    await page.getByRole('button', { name: 'µm', exact: true }).click();
    const ratio = await page.evaluate(() => document.querySelector('canvas.over').lab.scene.view.um_per_px);
    await until(async () => {
      const px = await page.evaluate(() => document.querySelector('canvas.over').lab.series.newest('true_centroid_x_px'));
      return Math.abs((await read('swarm'))[0] - px * ratio) < 3;
    }, 'the position is in micrometres');
    assert.match(await page.locator('[data-read="swarm"]').textContent(), / µm$/);
    await page.reload();
    await until(async () => (await page.locator('[data-read="swarm"]').textContent()).endsWith('µm'), 'the unit is remembered');
    await page.getByRole('button', { name: 'px', exact: true }).click();
    assert.match(await page.locator('[data-read="current-0"]').textContent(), /^−?[\d.]+ m?A$/);
  });

  await step('plots keep their history when the page is reloaded', async () => {
    const start = () => page.evaluate(() => document.querySelector('canvas.over').lab.series.of('t_s')[0]);
    assert.ok((await start()) < 0.1, 'the page was open since the start');
    await page.reload();
    await until(async () => (await start()) < 0.1, 'the rows since the start of the run are there again');
  });

  await step('columns are moved by keyboard and pointer, and their widths are remembered', async () => {
    const setup = page.locator('#workbench-setup'), width = async () => (await setup.boundingBox()).width;
    const separator = page.getByRole('separator', { name: 'Width of the set-up' });
    const first = await width();
    await separator.focus();
    await page.keyboard.press('ArrowRight');
    assert.equal(await width(), first + 16);
    const box = await separator.boundingBox();
    await page.mouse.move(box.x + 4, 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 44, 300, { steps: 4 });
    await page.mouse.up();
    assert.ok(Math.abs((await width()) - first - 56) <= 1, `${await width()} px`);
    await page.reload();
    await setup.waitFor();
    assert.ok(Math.abs((await width()) - first - 56) <= 1, 'the width is remembered');
    await separator.dblclick();
    await until(async () => (await width()) === first, 'a double click resets the width');
    assert.ok(await page.locator('#workbench-plots canvas').first().isVisible(), 'plots are beside the picture');
  });

  await step('the keys are listed', async () => {
    await page.keyboard.press('?');
    await page.getByRole('dialog').getByText('docs/guide/lab.md').waitFor();
    await shot('keys');
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').waitFor({ state: 'detached' });
  });
}

/** In a window as wide as a phone, in Portuguese. */
export async function phoneSteps() {
  for (const name of ['Controle', 'Cenário', 'Gráficos', 'Tarefas']) {
    await page.getByRole('tab', { name }).click();
    await page.locator('fieldset.panel').waitFor();
  }
  // A start from far down the gallery, and a restart from the form: the picture is in view.
  await tab('Galeria');
  const last = page.locator('.cards li button:enabled').nth(8);
  await last.scrollIntoViewIfNeeded();
  assert.ok((await page.evaluate(() => scrollY)) > 300, 'the gallery is scrolled');
  await last.click();
  await page.locator('[data-read="title"]').waitFor();
  await until(async () => (await page.evaluate(() => scrollY)) === 0, 'the page is at its top after a start');
  await page.getByRole('tab', { name: 'Cenário' }).click();
  const seed = page.getByRole('button', { name: 'Outra semente' });
  await seed.scrollIntoViewIfNeeded();
  await page.evaluate(() => scrollBy(0, 200));
  await seed.click();
  await until(async () => (await page.evaluate(() => scrollY)) === 0, 'the page is at its top after a restart');
}
