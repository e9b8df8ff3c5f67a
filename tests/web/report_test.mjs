// SPDX-License-Identifier: MIT
// node report_test.mjs REPORT.html [FOLDER]: is the report whole, in a browser without network, on a desktop and on
// a phone, light and dark? Into FOLDER it saves what it sees.
import assert from 'node:assert/strict';
import {mkdirSync} from 'node:fs';
import {join} from 'node:path';
import {browse, close} from './browser.mjs';

const [report, folder] = process.argv.slice(2);
if (!report) throw new Error('node report_test.mjs REPORT.html [FOLDER]');
if (folder) mkdirSync(folder, {recursive: true});

const desktop = {viewport: {width: 1300, height: 900}, colorScheme: 'light', reducedMotion: 'no-preference'};
const phone = {viewport: {width: 390, height: 844}, deviceScaleFactor: folder ? 2 : 1, isMobile: true, hasTouch: true, colorScheme: 'light'};

async function shot(what, name) {
  if (folder) await what.screenshot({path: join(folder, `${name}.png`), animations: 'disabled'});
}
async function shots(page, name) {
  if (!folder) return;
  await shot(page, `${name}-top`);
  for (const part of await page.locator('main > section').all()) await shot(part, `${name}-${await part.getAttribute('id')}`);
}

/// What is seen of every picture: its file's size, its width on the page, its colours.
const pictures = page => page.evaluate(async () => Promise.all([...document.images].map(async img => {
  await img.decode();
  const canvas = Object.assign(document.createElement('canvas'), {width: 40, height: 40});
  const drawing = canvas.getContext('2d');
  drawing.drawImage(img, 0, 0, 40, 40);
  const colours = new Set();
  const pixels = drawing.getImageData(0, 0, 40, 40).data;
  for (let i = 0; i < pixels.length; i += 4) colours.add(pixels.slice(i, i + 3).join());
  return {alt: img.alt, natural: img.naturalWidth, width: img.getBoundingClientRect().width, colours: colours.size,
    link: img.closest('a').getAttribute('href')};
})));
const none = faults => assert.deepEqual(faults, [], 'faults of the page');
const shown = page => page.locator('.claim:visible').count();

await browse(report, desktop, async (page, faults) => {
  const seen = await pictures(page);
  assert.ok(seen.length >= 13, 'a picture is missing');
  for (const p of seen) {
    assert.ok(p.alt.length > 20, `${p.link}: no words for it`);
    assert.ok(p.natural >= 500 && p.width >= 400 && p.colours > 5, `${p.link}: an empty picture`);
  }
  await shots(page, 'desktop');

  // The claims: what differs on top; the filter; a link opens what it leads to.
  const marks = await page.locator('.claim').evaluateAll(all => all.map(c => c.className.split(' ')[1]));
  const order = ['differs', 'unknown', 'agrees', 'reproduced'];
  assert.deepEqual(marks, [...marks].sort((a, b) => order.indexOf(a) - order.indexOf(b)));
  assert.equal(await shown(page), marks.length);
  await page.locator('#show-differs').check({force: true});
  assert.equal(await shown(page), marks.filter(m => m === 'differs').length);
  await shot(page.locator('#claims'), 'desktop-differs');
  const link = page.locator('.about a').first();
  await link.click();
  const claim = page.locator(`details${await link.getAttribute('href')}`);
  await page.waitForFunction(id => document.getElementById(id).open, (await link.getAttribute('href')).slice(1));
  assert.match(await claim.innerText(), /Paper[\s\S]*Here/);
  assert.equal(await shown(page), marks.length, 'a link to a claim that the filter hides');
  const lost = await page.evaluate(() =>
    [...document.querySelectorAll('a[href^="#"]')].filter(a => !document.getElementById(a.hash.slice(1))).map(a => a.hash));
  assert.deepEqual(lost, [], 'links within the page lead somewhere');

  // The animation rests until somebody wants it.
  const replay = page.locator('.replay'), time = () => replay.locator('input[type=range]').first().inputValue();
  await replay.scrollIntoViewIfNeeded();
  const before = await time();
  await page.waitForTimeout(400);
  assert.equal(await time(), before, 'the animation began unasked');
  await replay.getByRole('button', {name: /play/i}).first().click();
  await page.waitForTimeout(600);
  assert.notEqual(await time(), before, 'the animation moves');

  // Light and dark: the page, and the pictures with it.
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const corner = () => page.locator('figure img').first().screenshot();
  const light = await ground(), picture = await corner();
  await page.locator('#theme').click();
  assert.notEqual(await ground(), light, 'the button changes the colours');
  assert.ok(!picture.equals(await corner()), 'a picture stays light on a dark page');
  none(faults);
});

await browse(report, {...desktop, colorScheme: 'dark'}, async (page, faults) => {
  assert.match(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), /rgb\((\d|[1-4]\d), /, 'a dark page');
  await shots(page, 'dark');
  none(faults);
});

await browse(report, phone, async (page, faults) => {
  for (const claim of await page.locator('.claim').all()) await claim.evaluate(c => { c.open = true; });
  // A phone zooms out of a page that is too wide, so its own width is asked for.
  const wide = await page.evaluate(width => document.documentElement.scrollWidth <= width ? [] :
    [...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > width + 1 &&
      !e.closest('pre, .skip')).map(e => e.outerHTML.slice(0, 90)), phone.viewport.width);
  assert.deepEqual(wide, [], 'wider than a phone');
  for (const p of await pictures(page)) assert.ok(p.width >= 330, `${p.link}: small on a phone`);
  await page.locator('.claim').evaluateAll(all => all.forEach((c, i) => { c.open = i < 2; }));
  await shots(page, 'phone');
  none(faults);
});

// Without JavaScript all but the animation is there.
await browse(report, {...desktop, javaScriptEnabled: false}, async page => {
  assert.ok(await shown(page) > 30);
  assert.ok(await page.locator('figure img').count() >= 13);
  assert.match(await page.locator('noscript').first().innerText(), /JavaScript/);
});

await close();
console.log('The report is whole.');
