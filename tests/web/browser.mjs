// SPDX-License-Identifier: MIT
// A page in Debian's Chromium without any network: what it asks for or complains about is a fault.
import {createRequire} from 'node:module';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const {chromium} = createRequire(import.meta.url)('playwright-core');

let browser;  // one for all pages of a process
const launched = () => browser ??= chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
    '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

/// Ends the browser, without which the process does not end.
export const close = async () => (await browser)?.close();

/// Opens the file `path` as one who was never there before; `use(page, faults)` gets the page and a list that
/// faults are added to.
export async function browse(path, options, use) {
  const context = await (await launched()).newContext(options);
  const faults = [];
  try {
    await context.route(url => !['file:', 'data:', 'blob:'].includes(url.protocol), route => {
      faults.push(`asks for ${route.request().url()}`);
      return route.abort();
    });
    await context.setOffline(true);
    const page = await context.newPage();
    page.on('pageerror', error => faults.push(`exception: ${error.stack ?? error}`));
    page.on('console', message => {
      // Chromium's remarks on speed (drawing in software, reading canvases) are no faults.
      if (['error', 'warning'].includes(message.type()) &&
          !/GPU stall|GL Driver Message|willReadFrequently/.test(message.text())) {
        faults.push(`console ${message.type()}: ${message.text()}`);
      }
    });
    page.on('crash', () => faults.push('the page crashed'));
    await page.goto(pathToFileURL(resolve(path)).href);
    await use(page, faults);
  } catch (error) {
    throw faults.length ? new Error(`${error.message}\nFaults so far:\n${faults.join('\n')}`) : error;
  } finally {
    await context.close();
  }
}
