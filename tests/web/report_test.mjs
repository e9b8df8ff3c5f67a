// node report_test.mjs REPORT.html [FOLDER]: is the report whole, in a browser without network, on a desktop and on
// a phone? Into FOLDER it saves what it sees. Any report will do; the tests take the sample's.
import assert from 'node:assert/strict';
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {browse} from './browser.mjs';

const [report, folder] = process.argv.slice(2);
if (!report) throw new Error('node report_test.mjs REPORT.html [FOLDER]');
if (folder) mkdirSync(folder, {recursive: true});

const desktop = {viewport: {width: 1300, height: 900}, colorScheme: 'light'};
const phone = {viewport: {width: 390, height: 844}, deviceScaleFactor: folder ? 2 : 1, isMobile: true, hasTouch: true, colorScheme: 'light'};

/// Every chart, one after the other, scrolled to and drawn: marks of Vega or a canvas of some size.
async function see_all_charts(page, shots) {
  const charts = await page.locator('.chart').all();
  assert.ok(charts.length > 0, 'no charts');
  for (const chart of charts) {
    const name = await chart.getAttribute('data-section');
    const places = await chart.locator('.drawing, .replay').all();
    assert.ok(places.length > 0, `${name}: nothing is drawn`);
    for (const place of places) {
      await place.scrollIntoViewIfNeeded();
      await place.and(page.locator('[data-drawn]')).waitFor({timeout: 60000});
      const seen = await place.evaluate(box => {
        const area = e => e ? e.getBoundingClientRect().width * e.getBoundingClientRect().height : 0;
        const within = box.querySelector('canvas, svg') ? [box] : [...box.querySelectorAll('*'), box].map(e => e.shadowRoot).filter(Boolean);
        const all = selector => within.flatMap(w => [...w.querySelectorAll(selector)]);
        return {kind: box.className, marks: all('.mark-rect path, .mark-symbol path, .mark-line path, .mark-rule line').length,
          svg: Math.max(0, ...all('svg').map(area)), canvas: Math.max(0, ...all('canvas').map(area))};
      });
      if (seen.kind === 'drawing') assert.ok(seen.marks > 2 && seen.svg > 10000, `${name}: an empty drawing`);
      else assert.ok(seen.canvas > 10000, `${name}: an empty canvas`);
    }
    if (shots) await shot(chart.locator('xpath=ancestor::section'), `${shots}-${name}`);
  }
}

async function shot(what, name) {
  if (folder) await what.screenshot({path: join(folder, `${name}.png`), animations: 'disabled'});
}

const none = faults => assert.deepEqual(faults, [], 'faults of the page');

await browse(report, desktop, async (page, faults) => {
  const claims = await page.evaluate(() => ({rows: document.querySelectorAll('.claims tbody tr').length,
    tally: [...document.querySelectorAll('.tally b')].reduce((sum, b) => sum + Number(b.textContent), 0),
    lost: [...document.querySelectorAll('a[href^="#"]')].filter(a => !document.getElementById(a.hash.slice(1))).map(a => a.hash)}));
  assert.ok(claims.rows > 0 && claims.rows === claims.tally, 'the claims table has a row per claim');
  assert.deepEqual(claims.lost, [], 'links within the page lead somewhere');
  await shot(page, 'desktop-top');
  for (const part of ['#claims', 'nav', '#made-by']) await shot(page.locator(part), `desktop-${part.replace('#', '')}`);
  await see_all_charts(page, 'desktop');

  // A number shows where the pointer is.
  for (const kind of ['outcomes', 'final_gates']) {
    const chart = page.locator(`.chart[data-kind=${kind}]`).first();
    if (await chart.count() === 0) continue;
    const cell = chart.locator('.mark-rect path').nth(5);
    await cell.scrollIntoViewIfNeeded();
    await cell.hover({force: true});  // the number on it shows the same
    const tip = page.locator('#vg-tooltip-element.visible');
    await tip.waitFor({timeout: 5000});
    assert.match(await tip.innerText(), /\d/, `${kind}: the tooltip has a number`);
    await shot(page, `desktop-hover-${kind}`);
    await page.mouse.move(0, 0);
  }

  // A choice changes what is drawn.
  const options = page.locator('.chart[data-kind=outcomes] .segments input');
  if (await options.count() > 1) {
    const picture = () => page.locator('.chart[data-kind=outcomes] .drawing').first().innerHTML();
    await page.locator('.chart[data-kind=outcomes]').scrollIntoViewIfNeeded();
    const before = await picture();
    await options.nth(1).check({force: true});
    await page.waitForTimeout(500);
    assert.notEqual(await picture(), before, 'the choice of damping changes the chart');
  }

  // The wheel moves the page, not what is below the pointer, unless that was clicked.
  const solid = page.locator('.three').first();
  if (await solid.count() > 0) {
    const eye = () => solid.evaluate(box => JSON.stringify(box._fullLayout.scene._scene.getCamera().eye));
    await solid.evaluate(box => box.scrollIntoView({block: 'center', behavior: 'instant'}));
    await solid.and(page.locator('[data-drawn]')).waitFor({timeout: 60000});
    const before = await eye(), top = await page.evaluate(() => scrollY);
    await solid.hover({force: true});
    await page.mouse.wheel(0, 40);
    await page.waitForFunction(y => scrollY !== y, top);
    assert.equal(await eye(), before, 'the wheel leaves the drawing alone');
    await solid.click({force: true});
    await page.mouse.wheel(0, 40);
    await page.waitForTimeout(300);
    assert.notEqual(await eye(), before, 'after a click the wheel zooms');
  }

  // The animation moves by itself and can be moved.
  const replay = page.locator('.replay').first();
  if (await replay.count() > 0) {
    await replay.scrollIntoViewIfNeeded();
    const time = () => replay.locator('input[type=range]').first().inputValue();
    const before = await time();
    await replay.getByRole('button', {name: /play/i}).first().click();
    await page.waitForTimeout(600);
    assert.notEqual(await time(), before, 'the animation moves');
  }

  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.locator('#theme').click();
  assert.notEqual(await ground(), light, 'the button changes the colours');
  none(faults);
});

await browse(report, {...desktop, colorScheme: 'dark'}, async (page, faults) => {
  assert.match(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), /rgb\((\d|[1-4]\d), /, 'a dark page');
  if (folder) {
    await shot(page, 'dark-top');
    await see_all_charts(page, 'dark');
  }
  none(faults);
});

await browse(report, phone, async (page, faults) => {
  await shot(page, 'phone-top');
  await shot(page.locator('#claims'), 'phone-claims');
  await see_all_charts(page, folder && 'phone');
  // A phone zooms out of a page that is too wide, so its own width is asked for.
  const wide = await page.evaluate(width => document.documentElement.scrollWidth <= width ? [] :
    [...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > width + 1 &&
      !e.closest('.scroll, pre, .drawing, .skip, thead')).map(e => e.outerHTML.slice(0, 90)), phone.viewport.width);
  assert.deepEqual(wide, [], 'wider than a phone');
  none(faults);
});

// Without JavaScript all that is text is there.
await browse(report, {...desktop, javaScriptEnabled: false}, async page => {
  assert.ok(await page.locator('.claims tbody tr').count() > 0);
  assert.match(await page.locator('noscript').first().innerText(), /JavaScript/);
});

console.log('The report is whole.');
