// SPDX-License-Identifier: MIT
// node replay_test.mjs FOLDER: the pages of make_replays as a reader sees them, in Debian's Chromium, without
// a network.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import test, {after} from 'node:test';
import {browse, close} from './browser.mjs';

const folder = process.argv[2];
after(close);

/// Shows a page to `look`; no fault may be seen meanwhile.
const seen = (name, options, look) =>
  browse(join(folder, name), {viewport: {width: 1280, height: 900}, ...options}, async (page, faults) => {
    await look(page);
    assert.deepEqual(faults, []);
  });

// In the scene's own units of time: seconds, but for the twins.
const time = (page) => page.locator('.gwr-time').evaluate((slider) => Number(slider.value));
const end = (page) => page.locator('.gwr-time').evaluate((slider) => Number(slider.max));
const pixels = (page) => page.locator('.gwr-stage').evaluate((canvas) => canvas.toDataURL());
const overflow = async (page) => (await page.evaluate(() => document.documentElement.scrollWidth)) - page.viewportSize().width;

test('rests until it is wanted, and plays in real time', () => seen('gate.html', {}, async (page) => {
  await page.waitForTimeout(300);
  assert.equal(await time(page), 0);
  const still = await pixels(page);
  // Between two pictures, by their own clock: a slow machine only shows fewer of them.
  await page.getByRole('button', {name: 'Play'}).click();
  await page.waitForFunction(() => document.querySelector('#replay > div').shadowRoot.querySelector('.gwr-time').value > 0.2);
  await page.getByRole('button', {name: 'Pause'}).click();
  const paused = await time(page);
  assert.notEqual(await pixels(page), still);
  await page.waitForTimeout(200);
  assert.equal(await time(page), paused);
  assert.ok(paused < await end(page));
}));

test('stops at the end, and begins again', () => seen('gate.html', {}, async (page) => {
  const started = Date.now();
  await page.getByRole('button', {name: 'Play'}).click();
  await page.locator('.gwr-ended').waitFor();
  assert.equal(await time(page), await end(page));
  assert.ok(Date.now() - started >= 1500, '2 s of the run are 2 s');
  await page.getByRole('button', {name: 'Play'}).click();  // from the start again
  await page.waitForTimeout(100);
  assert.ok(await time(page) < 1.5);
}));

test('the slider goes to any time', () => seen('gate.html', {}, async (page) => {
  await page.locator('.gwr-time').fill('1.234');
  assert.match(await page.locator('.gwr-clock').textContent(), /^1\.23 s$/);
  await page.locator('.gwr-time').fill(String(await end(page)));
  assert.equal(await page.locator('.gwr-mode').textContent(), 'ended: traversed left');
  assert.match(await page.locator('.gwr-time').getAttribute('aria-valuetext'), /2\.00 s, ended: traversed left/);
}));

test('everything can be done with the keyboard', () => seen('gate.html', {}, async (page) => {
  for (const [key, expected] of [['ArrowRight', 0.02], ['ArrowRight', 0.04], ['ArrowLeft', 0.02], ['PageUp', 1.02],
    ['End', 2], ['PageDown', 1], ['Home', 0]]) {
    await page.keyboard.press(key);
    assert.ok(Math.abs(await time(page) - expected) < 1e-9, `${key}: ${await time(page)}, not ${expected}`);
  }
  await page.keyboard.press('Space');
  await page.getByRole('button', {name: 'Pause'}).waitFor();
  await page.keyboard.press('Space');
  await page.getByRole('button', {name: 'Play'}).waitFor();
  // A key that a control has for itself is done once.
  await page.getByRole('button', {name: 'Play'}).focus();
  await page.keyboard.press('Space');
  await page.getByRole('button', {name: 'Pause'}).waitFor();
  await page.keyboard.press('Home');
  await page.getByLabel('Time in the run').focus();
  await page.keyboard.press('ArrowRight');
  assert.ok(Math.abs(await time(page) - 0.02) < 1e-9);
}));

test('speed is that of the run', () => seen('gate.html', {}, async (page) => {
  await page.getByLabel('Speed').selectOption('0.1');
  const started = Date.now();
  await page.getByRole('button', {name: 'Play'}).click();
  await page.waitForTimeout(1000);
  const shown = await time(page), passed = (Date.now() - started) / 1000;
  assert.ok(shown > 0 && shown <= 0.1 * passed, `${shown} s in ${passed} s at 0.1`);
}));

test('one of several runs, and its words', () => seen('gate.html', {}, async (page) => {
  const words = page.locator('.gwr-words');
  assert.match(await words.textContent(), /^trial 1: traversed left after 2 s\. The left beam was deflected by up to 69 degrees/);
  await page.getByRole('combobox', {name: 'Run'}).selectOption('1');
  assert.match(await words.textContent(), /^trial 2: <\/script><b>trapped<\/b>\./);
  assert.match(await page.getByRole('img', {name: /Animation/}).getAttribute('aria-label'), /trapped/);
}));

test('a click on the energies goes to that time, and says how much there is', () => seen('gate.html', {}, async (page) => {
  const chart = page.locator('.gwr-chart').first(), box = await chart.boundingBox();
  await chart.click({position: {x: box.width / 2, y: 40}});
  assert.ok(Math.abs(await time(page) - 1) < 0.2, `${await time(page)}`);
  const at = await time(page);
  const put = await page.getByRole('row', {name: /work put in/}).textContent();
  assert.equal(put, `work put in${(7 * 25 * at).toFixed(1)} J`);
}));

test('a field: the camera follows the body through its gates', () => seen('field.html', {}, async (page) => {
  assert.equal(await page.getByRole('row', {name: /^gate/}).textContent(), 'gate (column, row)0, 0');
  await page.locator('.gwr-time').fill('4.9');
  assert.equal(await page.getByRole('row', {name: /^gate/}).textContent(), 'gate (column, row)0, 2');
  const whole = await pixels(page);
  await page.getByRole('switch', {name: 'Follow the body'}).click();
  const followed = await pixels(page);
  assert.notEqual(followed, whole);
  await page.locator('.gwr-time').fill('2.5');
  assert.notEqual(await pixels(page), followed);
}));

for (const name of ['gate.html', 'field.html'])
  test(`${name} on a phone`, () => seen(name, {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true,
    deviceScaleFactor: 3}, async (page) => {
    assert.equal(await overflow(page), 0);
    const stage = await page.locator('.gwr-stage').boundingBox(), chart = await page.locator('.gwr-chart').first().boundingBox();
    assert.ok(stage.y + stage.height < chart.y, 'the picture stands above the chart');
    assert.ok(stage.width > 340);
    assert.equal(await page.locator('.gwr-stage').evaluate((canvas) => canvas.width / canvas.clientWidth), 3);
    const button = await page.getByRole('button', {name: 'Play'}).boundingBox();
    assert.ok(button.height >= 44);
    await page.getByRole('button', {name: 'Play'}).tap();
    await page.getByRole('button', {name: 'Pause'}).waitFor();
  }));

test('no text is smaller than 12 px, nothing lies beside the page from 320 px on', () => seen('gate.html', {}, async (page) => {
  const sizes = await page.locator('.gwr *').evaluateAll((all) => all.map((e) => parseFloat(getComputedStyle(e).fontSize)));
  assert.ok(Math.min(...sizes) >= 12);
  for (const width of [320, 480, 768, 1024, 1920]) {
    await page.setViewportSize({width, height: 800});
    assert.equal(await overflow(page), 0, `${width} px`);
  }
}));

test('dark and light follow the page', () => seen('gate.html', {colorScheme: 'light'}, async (page) => {
  // The page is told a moment after its colours change.
  const dark = () => page.locator('.gwr.gwr-dark').waitFor(), bright = () => page.locator('.gwr:not(.gwr-dark)').waitFor();
  const light = await pixels(page);
  await bright();
  await page.emulateMedia({colorScheme: 'dark'});
  await dark();
  assert.notEqual(await pixels(page), light);
  await page.evaluate(() => { document.documentElement.style.colorScheme = 'light'; });
  await bright();
  assert.equal(await pixels(page), light);
}));

test('several on one page keep their own time', () => seen('gate.html', {}, async (page) => {
  await page.evaluate(() => {
    const second = document.body.appendChild(document.createElement('div'));
    second.style.width = '600px';
    gatewalkReplay(second, JSON.parse(document.getElementById('film').textContent)).seek(1.5);
  });
  const times = await page.locator('.gwr-time').evaluateAll((sliders) => sliders.map((slider) => Number(slider.value)));
  assert.deepEqual(times, [0, 1.5]);
}));

/// The stage above its rule, the lines of the energies between the frame's ends, and how far the clock has come: what
/// a scene looks like whatever its units are.
const look = (page) => page.evaluate(async () => {
  const root = document.querySelector('#replay > div').shadowRoot, charts = new Set(root.querySelectorAll('.gwr-chart'));
  const slider = root.querySelector('.gwr-time'), lines = [], lineTo = CanvasRenderingContext2D.prototype.lineTo;
  CanvasRenderingContext2D.prototype.lineTo = function (x, y) {
    if (charts.has(this.canvas) && x !== this.canvas.clientWidth - 8) lines.push(x, y);
    lineTo.call(this, x, y);
  };
  const pictures = [];
  for (const part of [0, 0.1, 0.31, 0.62, 1])
    for (const follow of root.querySelector('[role=switch]') ? [false, true] : [false]) {
      slider.value = Number(slider.max) * part;
      slider.dispatchEvent(new Event('input'));
      if (root.querySelector('[role=switch]')?.checked !== follow) root.querySelector('[role=switch]')?.click();
      const stage = root.querySelector('.gwr-stage');
      const data = stage.getContext('2d').getImageData(0, 0, stage.width, stage.height - 34).data;
      const hash = await crypto.subtle.digest('SHA-256', data);
      pictures.push([...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join(''));
    }
  CanvasRenderingContext2D.prototype.lineTo = lineTo;
  return {pictures, points: lines.length / 2, lines: lines.join(' ')};  // a long list would travel slowly
});

for (const kind of ['gate', 'field'])
  test(`a ${kind} in other units looks the same`, async () => {
    let paper;
    const small = {viewport: {width: 480, height: 400}};  // fewer points to compare
    await seen(`${kind === 'gate' ? 'gate-one' : kind}.html`, small, async (page) => { paper = await look(page); });
    assert.equal(new Set(paper.pictures).size, paper.pictures.length, 'it moves');
    assert.ok(paper.points > 500);
    for (const twin of [2, 3, 4, 5])
      await seen(`${kind}-twin-${twin}.html`, small, async (page) => assert.deepEqual(await look(page), paper, `twin ${twin}`));
  });

test('a scene in other units takes as long to play, and says its time in units that fit', () =>
  seen('gate-twin-2.html', {}, async (page) => {  // times x 4^-5
    const started = Date.now();
    await page.getByRole('button', {name: 'Play'}).click();
    await page.locator('.gwr-ended').waitFor();
    const passed = Date.now() - started;
    assert.ok(passed >= 1500 && passed < 10000, `${passed} ms`);
    assert.equal(await page.locator('.gwr-clock').textContent(), '1.95 ms');
    assert.match(await page.locator('.gwr-keys').textContent(), /move by 977 µs/);
    assert.equal(await page.getByLabel('Speed').locator('option').nth(3).textContent(), '0.000977×');
    for (const words of await page.locator('td').allTextContents()) assert.doesNotMatch(words, /^.?0(\.0*)? (J|N|m\/s)$/);
  }));

test('a film that is incomplete says what is wrong', () => seen('broken.html', {}, async (page) => {
  const words = await page.getByRole('alert').textContent();
  for (const fault of ['run 1: left is missing', 'run 1: vy, entry 2: null is not a number',
    'run 1: contact_right has 7 entries, t has 6']) assert.ok(words.includes(fault), words);
  assert.equal(await page.locator('canvas').count(), 0);
}));

test('gates of several types have beams and propulsion of their own', async () => {
  let plain;
  await seen('field.html', {}, async (page) => {
    await page.locator('.gwr-time').fill('2.5');
    plain = await pixels(page);
  });
  await seen('mixed.html', {}, async (page) => {
    const row = page.getByRole('row', {name: /^propulsion/});
    assert.equal(await page.getByRole('status').count(), 0);
    const before = await row.textContent();
    await page.locator('.gwr-time').fill('2.5');
    assert.match(await page.getByRole('row', {name: /^gate/}).textContent(), /0, 1$/);
    assert.match(await row.textContent(), /9(\.0+)? N$/);
    assert.notEqual(await row.textContent(), before);
    assert.notEqual(await pixels(page), plain);
  });
  await seen('short-of-types.html', {}, async (page) => {
    const words = await page.getByRole('alert').textContent();
    for (const fault of ['types[0].beam_m is not a number above 0', 'type_of_gate is not a type for each gate'])
      assert.ok(words.includes(fault), words);
  });
});

test('a policy: the action that the body takes in its gate', async () => {
  await seen('mixed.html', {}, async (page) => assert.equal(await page.getByRole('row', {name: /^action/}).count(), 0));
  await seen('chosen.html', {}, async (page) => {
    const row = page.getByRole('row', {name: /^action/}), push = page.getByRole('row', {name: /^propulsion/});
    for (const [time, action, newtons] of [[0, 'gently', 7], [2.5, 'hard', 9], [4.9, 'gently', 7]]) {
      await page.locator('.gwr-time').fill(String(time));
      assert.equal(await row.textContent(), `action${action}`);
      assert.match(await push.textContent(), new RegExp(`${newtons}(\\.0+)? N$`));
    }
  });
  await seen('short-of-actions.html', {}, async (page) =>
    assert.match(await page.getByRole('alert').textContent(), /actions is not a list of names, one or several types for each/));
});

test('what the page does not know is said, the rest is shown', () => seen('unknown.html', {}, async (page) => {
  assert.match(await page.getByRole('status').textContent(), /heat_J/);
  assert.equal(await page.locator('canvas').count(), 3);
}));

test('without scripts the page says how the runs ended', () => seen('gate.html', {javaScriptEnabled: false}, async (page) => {
  assert.equal(await page.getByText('trial 1: traversed left after 2 s').isVisible(), true);
}));
