// SPDX-License-Identifier: MIT
// node answer_test.mjs GATEWALK ROOT FOLDER: the page of an answer as a reader sees it, and whether it says what
// the program says; in Debian's Chromium without a network. Pages and pictures of them are left in FOLDER.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, statSync} from 'node:fs';
import {join} from 'node:path';
import test, {after, before} from 'node:test';
import {browse, close} from './browser.mjs';

const [gatewalk, root, folder] = process.argv.slice(2);
mkdirSync(folder, {recursive: true});
const at = (name) => join(folder, name);
const run = (...words) => execFileSync(gatewalk, [...words, '--quiet', '--force'],
    {stdio: ['ignore', 'pipe', 'ignore']});
const json = (...words) => JSON.parse(run(...words, '--json', '-'));
const small = ['--set', 'run.method=moreau', '--set', 'field.columns=5', '--set', 'field.rows=6'];
const desktop = {viewport: {width: 1280, height: 900}, colorScheme: 'light'};

before(() => {
  run('build', join(root, 'scenes/field.toml'), ...small, '--starts', 'all', '--accuracy', '0.15', '-o', at('tree.nc'));
  run('build', join(root, 'scenes/field.toml'), ...small, '--bins', 'paper', '--trials', '60', '-o', at('bins.nc'));
  run('predict', at('tree.nc'), '--page', at('tree.html'), '--json', at('tree.json'));
  run('analyze', at('bins.nc'), '--runs', '0', '--page', at('bins.html'), '--json', at('bins.json'));
  run('predict', join(root, 'scenes/mixed.toml'), '--accuracy', '0.1', '--set', 'run.method=moreau', '--page',
      at('mixed.html'));
});
after(close);

/// Shows a page to `look`; no fault may be seen meanwhile, and nothing is asked for.
const seen = (name, options, look) => browse(at(name), {...desktop, ...options}, async (page, faults) => {
  await page.locator('#play').waitFor();
  await look(page);
  assert.deepEqual(faults, []);
});

/// As the program prints a share.
function percents(share) {
  const percent = 100 * share;
  if (!(share > 0 && share < 5e-5)) return percent.toFixed(2);
  if (percent >= 1e-4) return String(Number(percent.toPrecision(2)));
  return percent.toExponential(1).replace(/\.0(?=e)/, '').replace(/e-(\d)$/, 'e-0$1');
}
const withInterval = (share, interval) => `${percents(share)} %` +
    (interval ? ` [${interval.map(percents).join(', ')}]` : '');
const numbersOf = (page) => page.locator('#endings .number').allTextContents();
const tileWords = (page) => page.locator('#map [data-cell]').evaluateAll((tiles) =>
  tiles.sort((a, b) => a.dataset.cell - b.dataset.cell).map((t) => t.getAttribute('aria-label').replace(/^.*: /, '')));

async function goTo(page, start) {
  for (const [axis, x] of start.entries()) await page.locator(`#at-${axis}`).fill(String(x));
}

let words = 20261125;  // the same starts in every run
const random = (low, high) => {
  words = (Math.imul(words, 1664525) + 1013904223) >>> 0;
  return Number((low + (high - low) * words / 2 ** 32).toFixed(3));
};

test('the first thing shown is what predict says', () => seen('tree.html', {}, async (page) => {
  const said = JSON.parse(readFileSync(at('tree.json')));
  assert.deepEqual(await numbersOf(page), Object.keys(said.endings).map((key) =>
      withInterval(said.endings[key], said.endings_95[key])));
  const intervals = said.final_gates_95.flat();
  assert.deepEqual(await tileWords(page), said.final_gates.flat().map((share, i) =>
    `${percents(share)} per cent [${intervals[i].map(percents).join(', ')}]`));
  assert.match(await page.locator('#state').innerText(),
      new RegExp(`a state of its own, with ${said.first_runs} runs`));
}));

for (const [name, more] of [['tree', ['--first-runs', '0']], ['bins', []]])
  test(`starts drawn at random: the shares of predict ${name}.nc --start`, () =>
      seen(`${name}.html`, {}, async (page) => {
    const starts = Array.from({length: 6}, () => [random(-25, 25), random(-25, 25), random(10, 20)].map((x, i) =>
        (name === 'bins' && i === 1 ? x / 2 : x)));
    const said = json('predict', at(`${name}.nc`), ...more, ...starts.flatMap((s) => ['--start', s.join(',')])).starts;
    const answers = new Set();
    for (const [i, start] of starts.entries()) {
      await goTo(page, start);
      const numbers = await numbersOf(page);
      answers.add(numbers.join());
      assert.deepEqual(numbers.map((text) => text.replace(/ \[.*/, '')),
          Object.values(said[i].endings).map((share) => `${percents(share)} %`), start.join());
      assert.deepEqual((await tileWords(page)).map((text) => text.replace(/ .*/, '')),
          said[i].final_gates.flat().map(percents), start.join());
      if (name === 'bins')
        assert.deepEqual(numbers, Object.keys(said[i].endings).map((key) =>
            withInterval(said[i].endings[key], said[i].endings_95[key])));
      else assert.ok(numbers.every((text) => / \[.+, .+\]$/.test(text)), 'a bar for each');
      const state = await page.locator('#state').innerText();
      assert.ok(state.includes(`gatewalk predict ${at(`${name}.nc`)} --start ${start.join(',')}`), state);
    }
    assert.ok(answers.size > 3, 'different starts, different answers');
  }));

test('drag the disc, drag the arrow: the answer follows at once', () => seen('tree.html', {}, async (page) => {
  const fields = () => page.locator('#fields input[type=number]').evaluateAll((all) => all.map((i) => Number(i.value)));
  const middle = async (what) => { const b = await page.locator(what).boundingBox();
      return [b.x + b.width / 2, b.y + b.height / 2]; };
  const drag = async (what, dx, dy) => {
    const [x, y] = await middle(what);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx, y + dy, {steps: 4});
    await page.waitForTimeout(50);
    await page.mouse.up();
  };
  const before = [await fields(), await numbersOf(page), await tileWords(page)];
  assert.deepEqual(before[0], [0, 0, 15]);
  await drag('#drawing .disc', 60, 0);
  const moved = [await fields(), await numbersOf(page), await tileWords(page)];
  const scale = await page.evaluate(() => document.querySelector('#drawing .frame').getBoundingClientRect().width / 50);
  assert.ok(Math.abs(moved[0][0] - 60 / scale) < 1, `${moved[0][0]} m`);
  assert.deepEqual(moved[0].slice(1), [0, 15]);
  assert.notDeepEqual(moved[1], before[1]);
  assert.notDeepEqual(moved[2], before[2]);
  await page.screenshot({path: at('dragged.png'), fullPage: true});
  await drag('#drawing .grip', 40, -20);
  const aimed = await fields();
  assert.ok(aimed[1] > 2 && aimed[2] > 15 && aimed[0] === moved[0][0], aimed.join());
  const ms = await page.evaluate(() => {
    const times = [];
    for (let i = 0; i < 60; ++i) {
      const begun = performance.now();
      window.gatewalkAnswer.move([i / 3 - 10, 0, 15]);
      document.body.getBoundingClientRect();  // laid out
      times.push(performance.now() - begun);
    }
    return times.sort((a, b) => a - b)[30];
  });
  console.log(`an update takes ${ms.toFixed(1)} ms (median of 60)`);
  assert.ok(ms < 100, `${ms} ms`);
  await page.locator('#known button').first().click();
  assert.deepEqual(await numbersOf(page), before[1]);
}));

test('everything can be done with the keyboard', () => seen('tree.html', {}, async (page) => {
  const at0 = () => page.locator('#at-0').inputValue().then(Number);
  const order = [];
  for (let i = 0; i < 14; ++i) {
    await page.keyboard.press('Tab');
    const [name, outline] = await page.evaluate(() => {
      const e = document.activeElement, ring = e.querySelector?.('.ring');
      return [e.id || e.getAttribute('aria-label') || e.textContent.trim(), ring ? getComputedStyle(ring).stroke
          : getComputedStyle(e).outlineStyle];
    });
    order.push(name);
    assert.ok(!['none', 'rgba(0, 0, 0, 0)'].includes(outline) || name === 'start', `${name}: no focus seen`);
  }
  for (const name of ['place of the start', 'velocity of the start', 'at-0', 'at-1',
      'at-2']) assert.ok(order.includes(name), `${name} among ${order}`);
  const place = page.getByRole('slider', {name: 'place of the start'});
  await place.focus();
  await page.keyboard.press('ArrowRight');
  assert.ok(await at0() > 0);
  assert.match(await place.getAttribute('aria-valuetext'), /^d .* m$/);
  await page.keyboard.press('Home');
  assert.ok(await at0() <= -24);
  await page.getByRole('slider', {name: 'velocity of the start'}).focus();
  await page.keyboard.press('ArrowUp');
  assert.ok(Number(await page.locator('#at-2').inputValue()) > 15);
  await page.locator('#at-0').focus();
  await page.keyboard.press('ArrowUp');
  assert.ok(await at0() > -25);
  // The map is one stop; arrows move in it, and what is chosen is told.
  const tile = page.locator('#map [tabindex="0"]');
  assert.equal(await tile.count(), 1);
  await tile.focus();
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('ArrowRight');
  assert.match(await page.locator('#gate-title').textContent(), /i_x 1, i_y 1$/);
  assert.equal(await page.evaluate(() => document.activeElement.dataset.cell), '8');
}));

test('a chosen gate: where bodies go from there', () => seen('tree.html', {}, async (page) => {
  const analysis = json('analyze', at('tree.nc'), '--runs', '0');
  for (const [column, row] of [[2, 0], [1, 1], [3, 2]]) {
    await page.locator(`[data-cell="${row * 5 + column}"]`).click();
    const text = await page.locator('#gate-card').innerText();
    const visits = Number(analysis.expected_visits[row][column].toPrecision(4));
    assert.ok(text.includes(`comes here ${visits} [`), `${visits}: ${text}`);
    const next = (await page.locator('#next .number').allTextContents()).map((t) => Number(t.split(' ')[0]));
    assert.ok(Math.abs(next.reduce((a, b) => a + b) - 100) < 0.05, next.join());
    const ends = (await page.locator('#from-here .number').allTextContents());
    assert.ok(Math.abs(ends.reduce((a, t) => a + Number(t.split(' ')[0]), 0) - 100) < 0.05, ends.join());
    assert.ok(ends.every((t) => /\[.*\]/.test(t)));
  }
  const before = await tileWords(page);
  await page.locator('input[value=cell]').check({force: true});
  const after = await tileWords(page);
  assert.notDeepEqual(after, before);
  assert.ok(Math.abs(after.reduce((a, t) => a + Number(t.split(' ')[0]), 0) - 100) < 0.2);
  assert.ok(after.slice(0, 10).every((t) => t.startsWith('0.00')), 'nobody goes back');
  await page.screenshot({path: at('chosen.png'), fullPage: true});
  // Times and works are analyze's.
  const cell = page.locator('#costs tr[data-ending=trapped] [data-cost=time_s]');
  assert.match(await cell.textContent(),
      new RegExp(`^${Number(analysis.by_ending.trapped.mean_time_s.toPrecision(4))}\\[`));
  await page.locator('#ways button').first().click();
  assert.ok(await page.locator('#map svg polyline').count() === 1);
}));

test('of bins: the state, and no bars that are not known', () => seen('bins.html', {}, async (page) => {
  assert.match(await page.locator('#state').innerText(), /^EN, state \d+ of 87: d .* 60 runs entered so/);
  const text = await page.locator('#gate-card').innerText();
  assert.ok(!/NaN|\[/.test(text), text);
}));

test('a start that nobody saw is said to be one', () => seen('tree.html', {}, async (page) => {
  await goTo(page, [0, 0, 400]);
  assert.match(await page.locator('#state .warning').textContent(), /beyond all entries/);
  await page.locator('#at-0').fill('');
  assert.equal(await page.locator('#at-0').getAttribute('aria-invalid'), 'true');
}));

test('gates of several types are marked', () => seen('mixed.html', {}, async (page) => {
  assert.match(await page.locator('#legend').innerText(), /Types of gates: .*: /);
  const marks = await page.locator('#map .mark').allTextContents();
  assert.ok(new Set(marks).size > 1, marks.join());
}));

test('dark, and 400 px wide by touch', async () => {
  const ground = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await seen('tree.html', {}, async (page) => {
    const light = await ground(page);
    await page.screenshot({path: at('light.png'), fullPage: true});
    await page.locator('#theme').click();
    assert.notEqual(await ground(page), light);
  });
  await seen('tree.html', {colorScheme: 'dark'}, async (page) => {
    assert.match(await ground(page), /rgb\((\d|[1-4]\d), /);
    await page.screenshot({path: at('dark.png'), fullPage: true});
  });
  await seen('tree.html', {viewport: {width: 400, height: 800}, isMobile: true, hasTouch: true,
      reducedMotion: 'reduce'}, async (page) => {
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 400, 'wider than the screen');
    const before = await numbersOf(page);
    const b = await page.locator('#drawing .disc').boundingBox();
    const touch = await page.context().newCDPSession(page);
    const send = (type, x) => touch.send('Input.dispatchTouchEvent',
        {type, touchPoints: type === 'touchEnd' ? [] : [{x, y: b.y + b.height / 2}]});
    await send('touchStart', b.x + b.width / 2);
    for (const by of [20, 40, 60]) await send('touchMove', b.x + b.width / 2 + by);
    await page.waitForTimeout(50);
    await send('touchEnd');
    assert.notDeepEqual(await numbersOf(page), before);
    await page.screenshot({path: at('narrow.png'), fullPage: true});
    assert.equal(await page.locator('.chart button').first().evaluate((e) => getComputedStyle(e).transitionDuration),
        '0s');
  });
});

test('one file of at most 2 MB; without scripts its words', async () => {
  for (const name of ['tree.html', 'bins.html', 'mixed.html']) assert.ok(statSync(at(name)).size <= 2e6, name);
  await browse(at('tree.html'), {...desktop, javaScriptEnabled: false}, async (page) => {
    assert.match(await page.locator('noscript').innerText(), /trapped +\d/);
  });
});
