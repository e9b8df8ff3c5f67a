// SPDX-License-Identifier: MIT
// The documentation site as a reader sees it, from files, without network: light, dark, wide, narrow, by keyboard.
//   node site_test.mjs HTML
import {join} from 'node:path';
import {browse, close} from './browser.mjs';

const site = process.argv[2];
const pages = ['index', 'gallery', 'commands', 'commands/predict', 'python', 'cpp/index', 'cpp/markov', 'glossary',
  'guides/index', 'guides/markov', 'explain/model', 'reference/conventions', 'cli/scene', 'results/index', 'CHANGELOG'];
let failures = 0;
const fail = what => {
  console.log(`FAILED: ${what}`);
  failures += 1;
};

const brightness = page => page.evaluate(() => {
  const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number);
  return (r + g + b) / 3;
});

for (const name of pages) {
  for (const colorScheme of ['light', 'dark']) {
    for (const width of [1280, 400]) {
      await browse(join(site, `${name}.html`), {colorScheme, viewport: {width, height: 900}}, async (page, faults) => {
        const what = `${name}, ${colorScheme}, ${width} px wide`;
        await page.waitForLoadState();
        const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        if (over > 0) fail(`${what}: ${over} px too wide`);
        if ((await brightness(page) < 128) !== (colorScheme === 'dark')) fail(`${what}: not ${colorScheme}`);
        const unseen = await page.evaluate(() =>
          [...document.images].filter(image => image.complete && !image.naturalWidth).map(image => image.src));
        if (unseen.length) fail(`${what}: no picture ${unseen}`);
        for (const fault of faults) fail(`${what}: ${fault}`);
      });
    }
  }
}

const wide = {colorScheme: 'light', viewport: {width: 1280, height: 900}};
await browse(join(site, 'index.html'), wide, async (page, faults) => {
  await page.waitForLoadState();
  // By Tab alone: the search field, the pages, the switch between light and dark, all with a visible focus.
  const reached = new Set();
  for (let k = 0; k < 400 && !reached.has('theme-toggle'); ++k) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => {
      const at = document.activeElement;
      if (at.classList.contains('theme-toggle')) return 'theme-toggle';
      return at.name === 'q' ? 'search' : at.getAttribute('href') ?? '';
    }));
  }
  for (const what of ['search', 'gallery.html', 'python.html', 'theme-toggle']) {
    if (!reached.has(what)) fail(`Tab does not reach ${what}`);
  }
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
  if (outline === 'none') fail('the focus is not seen');
  await page.keyboard.press('Enter');
  if (await brightness(page) > 128) fail('Enter on the switch: not dark');
  const picture = await page.evaluate(() => getComputedStyle(document.images[0]).colorScheme);
  if (picture !== 'dark') fail('pictures stay light');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('ArrowRight');
  await page.waitForURL(/(tutorial|gallery)\.html$/, {timeout: 10000}).catch(() => fail('ArrowRight leads nowhere'));
  for (const fault of faults) fail(`index: ${fault}`);
});

await browse(join(site, 'search.html'), wide, async (page, faults) => {
  await page.fill('input[name=q]', 'committor');
  await page.keyboard.press('Enter');
  await page.waitForSelector('#search-results li a', {timeout: 10000}).catch(() => fail('the search finds nothing'));
  for (const fault of faults) fail(`search: ${fault}`);
});

await close();
console.log(failures ? `${failures} failures` : `${pages.length} pages: all fine`);
process.exit(failures ? 1 : 0);
