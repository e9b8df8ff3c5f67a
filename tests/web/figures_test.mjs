// SPDX-License-Identifier: MIT
// node figures_test.mjs FOLDER|FILE.svg...: can the figures be read where they are printed 3.5 inches wide? No text
// overlaps another, a frame or a legend's lines, none is cut off or below 6 points, and series can be told apart by
// who sees no red and green, and in grey. Of figures in a FOLDER, just drawn, also: numbers of an axis stand close to
// it, and the axis has a name.
import assert from 'node:assert/strict';
import {existsSync, readdirSync, statSync, readFileSync, writeFileSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {constants, inflateSync} from 'node:zlib';
import {browse, close} from './browser.mjs';

const drawn = process.argv.slice(2).filter(p => statSync(p).isDirectory())
  .flatMap(p => readdirSync(p).filter(f => f.endsWith('.svg')).map(f => join(p, f)));
const files = [...drawn, ...process.argv.slice(2).filter(p => !statSync(p).isDirectory())];
assert.ok(files.length > 0, 'node figures_test.mjs FOLDER|FILE.svg...');

const kFarthestNumber = 11;  // from its tick, of kWidth: 5.5 points in print
const kWidth = 504, kPrintedPoints = 252, kLeastPoints = 5.99, kLeastDistance = 0.075;

/// In the page: what is wrong with the texts of the SVG in it.
function texts_of({width, points, least}) {
  const svg = document.querySelector('svg'), faults = [];
  const shrunk = r => ({left: r.left + 1, right: r.right - 1, top: r.top + 0.16 * r.height, bottom: r.bottom - 0.16 * r.height});
  const boxes = [];
  for (const text of svg.querySelectorAll('text')) {
    if (!text.textContent.trim()) continue;
    for (const part of [text, ...text.querySelectorAll('tspan')]) {
      const own = [...part.childNodes].some(n => n.nodeType === 3 && n.data.trim());
      const printed = parseFloat(getComputedStyle(part).fontSize) * points / width;
      if (own && printed < least) faults.push(`"${text.textContent}" has ${printed.toFixed(2)} points in print`);
    }
    boxes.push({words: text.textContent.trim(), ...shrunk(text.getBoundingClientRect())});
  }
  const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  boxes.forEach((a, i) => boxes.slice(i + 1).forEach(b => {
    if (meet(a, b)) faults.push(`"${a.words}" overlaps "${b.words}"`);
  }));
  const whole = svg.getBoundingClientRect();
  for (const b of boxes)
    if (b.left < whole.left - 1 || b.right > whole.right + 1 || b.top < whole.top - 1 || b.bottom > whole.bottom + 1)
      faults.push(`"${b.words}" is cut off`);
  // Straight lines outside the plots themselves: frames, tics; and the samples of a legend.
  for (const path of svg.querySelectorAll('path')) {
    if (path.closest('[id^=gnuplot_plot]') || path.closest('defs') || !path.getAttribute('d')) continue;
    if (getComputedStyle(path).stroke === 'none') continue;
    const m = path.getScreenCTM();
    const points = [...path.getAttribute('d').matchAll(/([ML])\s*(-?[\d.]+),(-?[\d.]+)/g)]
      .map(([, kind, x, y]) => ({kind, x: m.a * x + m.c * y + m.e, y: m.b * x + m.d * y + m.f}));
    points.forEach((p, i) => {
      if (i === 0 || p.kind === 'M') return;
      const q = points[i - 1];
      const line = {left: Math.min(p.x, q.x), right: Math.max(p.x, q.x), top: Math.min(p.y, q.y), bottom: Math.max(p.y, q.y)};
      if (line.right - line.left > 0.5 && line.bottom - line.top > 0.5) return;  // oblique: none of a frame
      for (const b of boxes) if (meet(b, {...line, right: line.right + 0.01, bottom: line.bottom + 0.01})) faults.push(`a line goes through "${b.words}"`);
    });
  }
  // Series that carry a name.
  const series = [...svg.querySelectorAll('g[id^=gnuplot_plot]')].map(g => {
    const drawn = [...g.querySelectorAll('path, use, polygon, circle')].map(e => [e.localName, getComputedStyle(e)]);
    const colours = new Set(drawn.flatMap(([name, s]) => name === 'polygon' ? [s.fill] : [s.stroke, s.color])
      .filter(c => c && c.startsWith('rgb(')));
    return {name: g.querySelector('title')?.textContent.trim() ?? '', colours: [...colours]};
  }).filter(s => s.name && !/^gnuplot_plot| using /.test(s.name));
  return {faults: [...new Set(faults)], series};
}

/// In the page: what is wrong with the axes of the SVG in it. A tick is a short line with its number behind it.
function axes_of({farthest}) {
  const svg = document.querySelector('svg'), faults = [], axes = new Map(), numbers = new Set();
  for (const path of svg.querySelectorAll('path')) {
    const text = path.nextElementSibling?.querySelector?.('text'), box = path.getBoundingClientRect();
    if (!text?.textContent.trim() || Math.max(box.width, box.height) > 8 || path.closest('[id^=gnuplot_plot]')) continue;
    const t = text.getBoundingClientRect(), upright = box.height > box.width, below = t.top > box.top - 2;
    const right = t.left > box.left;
    const gap = upright ? (below ? t.top + 0.16 * t.height - box.bottom : box.top - t.bottom)
      : (right ? t.left - box.right : box.left - t.right);
    const words = text.textContent.trim();
    numbers.add(text);
    if (!/^[-+]?[\d.]+(e[-+]?\d+)?$/.test(words)) continue;
    if (gap > farthest) faults.push(`the number "${words}" is ${gap.toFixed(1)} from its tick`);
    if (!upright && right) continue;  // those of a bar of colours
    const key = upright ? `x ${Math.round(box.top)}` : `y ${Math.round(box.right)}`;
    const axis = axes.get(key) ?? {upright, left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity, numbers: []};
    axis.left = Math.min(axis.left, t.left);
    axis.right = Math.max(axis.right, t.right);
    axis.top = Math.min(axis.top, t.top);
    axis.bottom = Math.max(axis.bottom, t.bottom);
    axis.numbers.push(words);
    axes.set(key, axis);
  }
  const names = [...svg.querySelectorAll('text')].filter(t => t.textContent.trim() && !numbers.has(t))
    .map(t => ({turned: /rotate/.test(t.closest('g[transform]')?.getAttribute('transform') ?? ''), ...t.getBoundingClientRect().toJSON()}));
  for (const a of axes.values()) {
    if (a.numbers.length < 3) continue;  // or names that happen to be numbers
    const tall = a.bottom - a.top;
    const named = a.upright
      ? names.some(n => !n.turned && n.top >= a.top + 4 && n.right > a.left && n.left < a.right)
      : names.some(n => n.turned && n.left < a.left && n.bottom > a.top - tall && n.top < a.bottom + tall);
    if (!named) faults.push(`the axis ${a.numbers.join(' ')} has no name`);
  }
  return faults;
}

const linear = rgb => rgb.map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
/// Viénot, Brettel and Mollon (1999): what is seen without the receptors for middle wavelengths.
const deutan = ([r, g, b]) => {
  const l = 17.8824 * r + 43.5161 * g + 4.11935 * b, s = 0.0299566 * r + 0.184309 * g + 1.46709 * b;
  const m = 0.494207 * l + 1.24827 * s;
  return [0.0809444479 * l - 0.130504409 * m + 0.116721066 * s,
    -0.0102485335 * l + 0.0540193266 * m - 0.113614708 * s, -0.000365296938 * l - 0.00412161469 * m + 0.693511405 * s];
};
/// Oklab (Ottosson 2020), in which distances look about as large as they are.
const oklab = ([r, g, b]) => {
  const [l, m, s] = [0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b,
    0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b, 0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b].map(Math.cbrt);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
};
const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

let wrong = 0, least = Infinity;
const scratch = mkdtempSync(join(tmpdir(), 'gatewalk-figures-'));
try {
  // One browser shows all of them, one after the other.
  const shown = join(scratch, 'figure.html');
  writeFileSync(shown, '');
  await browse(shown, {}, async (page, faults) => {
    for (const file of files) {
      const svg = readFileSync(file, 'utf8'), width = Number(/<svg[^>]*?\bviewBox="0 0 (\d+)/s.exec(svg)?.[1] ?? /<svg[^>]*?\bwidth="(\d+)/s.exec(svg)[1]);
      writeFileSync(shown, `<!doctype html><meta charset="utf-8"><body style="margin:0">${svg.replace(/^[^]*?<svg/, `<svg style="width:${width}px"`)}`);
      await page.setViewportSize({width: width + 20, height: 1000});
      await page.reload();
      const seen = await page.evaluate(texts_of, {width, points: kPrintedPoints, least: kLeastPoints});
      if (drawn.includes(file)) seen.faults.push(...await page.evaluate(axes_of, {farthest: kFarthestNumber}));
      const colours = seen.series.flatMap(s => s.colours.slice(0, 1).map(c => ({name: s.name, rgb: linear(c.match(/\d+/g).slice(0, 3).map(Number))})));
      colours.forEach((a, i) => colours.slice(i + 1).forEach(b => {
        if (a.name === b.name || `${a.rgb}` === `${b.rgb}`) return;
        const d = Math.min(distance(oklab(deutan(a.rgb)), oklab(deutan(b.rgb))), distance(oklab(a.rgb), oklab(b.rgb)));
        least = Math.min(least, d);
        if (d < kLeastDistance) seen.faults.push(`"${a.name}" and "${b.name}" look alike without green (${d.toFixed(3)})`);
      }));
      for (const f of [...faults.splice(0), ...seen.faults]) {
        console.error(`${file}: ${f}`);
        ++wrong;
      }
    }
  });
} finally {
  await close();
  rmSync(scratch, {recursive: true, force: true});
}

/// Sizes of the letters in a PDF, in points.
const sizes_of = pdf => {
  const sizes = new Set();
  for (const {index, 0: begin} of pdf.toString('latin1').matchAll(/stream\r?\n/g)) {
    let text = '';
    try {
      text = inflateSync(pdf.subarray(index + begin.length), {finishFlush: constants.Z_SYNC_FLUSH}).toString('latin1');
    } catch {
      continue;  // "endstream", or no deflated text
    }
    for (const [, a, b] of text.matchAll(/([-\d.]+) ([-\d.]+) [-\d.]+ [-\d.]+ [-\d.]+ [-\d.]+ Tm/g)) sizes.add(Math.hypot(a, b));
  }
  return [...sizes];
};

/// An update at the end of a PDF must lead to its objects, and chunks of a PNG must keep their checksums.
const crc = bytes => {
  let c = ~0;
  for (const b of bytes) {
    c ^= b;
    for (let k = 0; k < 8; ++k) c = c >>> 1 ^ (c & 1 ? 0xedb88320 : 0);
  }
  return ~c >>> 0;
};
const folder = process.argv.slice(2).find(p => statSync(p).isDirectory());
for (const name of folder ? readdirSync(folder) : []) {
  if (!/\.(pdf|png)$/.test(name)) continue;
  const file = join(folder, name), bytes = readFileSync(file);
  if (name.endsWith('.pdf')) {
    const text = bytes.toString('latin1'), table = Number(/startxref\s+(\d+)\s+%%EOF\s*$/.exec(text)?.[1]);
    const entry = /^xref\n(\d+) 1\n(\d{10}) 00000 n/.exec(text.slice(table));
    assert.ok(entry, `${file}: no table where startxref leads`);
    assert.ok(text.slice(Number(entry[2])).startsWith(`${entry[1]} 0 obj`), `${file}: no object where the table leads`);
    const svg = file.replace(/pdf$/, 'svg');
    if (existsSync(svg)) {
      const seen = [...readFileSync(svg, 'utf8').matchAll(/font-size="([\d.]+)/g)].map(m => m[1] * kPrintedPoints / kWidth);
      const printed = sizes_of(bytes);
      assert.ok(printed.length > 0, `${file}: no letters found`);
      for (const size of printed)
        assert.ok(seen.some(s => Math.abs(s - size) < 0.01), `${file}: letters of ${size} points, in the SVG ${[...new Set(seen)]}`);
    }
    assert.match(text.slice(table), new RegExp(`/Info ${entry[1]} 0 R`), `${file}: trailer`);
  }
  if (name.endsWith('.png')) {
    const seen = [];
    for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
      const size = bytes.readUInt32BE(at), body = bytes.subarray(at + 4, at + 8 + size);
      seen.push(body.toString('latin1', 0, 4));
      assert.equal(crc(body), bytes.readUInt32BE(at + 8 + size), `${file}: checksum of ${seen.at(-1)}`);
    }
    assert.ok(seen[0] === 'IHDR' && seen.includes('iTXt') && seen.includes('pHYs') && seen.at(-1) === 'IEND', `${file}: ${seen}`);
  }
}
console.log(`${files.length} figures, ${wrong} faults; least distance of colours ${least === Infinity ? 'none' : least.toFixed(3)}`);
process.exit(wrong ? 1 : 0);
