// SPDX-License-Identifier: MIT
// The interactive page of an answer (gatewalk predict --page): a movable start, and the chain's prediction for it.
// The program computed all numbers (cli/render/answer_page.h); the page looks them up.
'use strict';

const kSvg = 'http://www.w3.org/2000/svg';
const kMarks = ['', '▲', '●', '■', '◆', '✚', '★', '▼', '○', '□', '◇', '△'];
const $ = (id) => document.getElementById(id);

function element(tag, attributes = {}, ...children) {
  const made = tag.startsWith('svg:') ? document.createElementNS(kSvg, tag.slice(4)) : document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value !== null && value !== false) made.setAttribute(key, value === true ? '' : value);
  }
  made.append(...children);
  return made;
}

// ---- Packed numbers

const kArrays = {u16: Uint16Array, i32: Int32Array, f64: Float64Array, i8: Int8Array};

async function unpacked(text, kind) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = kArrays[kind].BYTES_PER_ELEMENT, count = planes.length / size;
  const plain = new Uint8Array(planes.length);
  for (let k = 0; k < size; ++k) for (let i = 0; i < count; ++i) plain[i * size + k] = planes[k * count + i];
  return new kArrays[kind](plain.buffer);
}

/** {share, low, high}: codes of shares, by end, then by place. */
async function table(packed, places) {
  const of = {places};
  for (const key of Object.keys(packed)) of[key] = await unpacked(packed[key], 'u16');
  return of;
}

// ---- Shares as the program prints them

const kNone = 65535, kSmall = 10001, kDigits = 90;

/** The share of a code, in per cent. */
function percentOf(code) {
  if (code === kNone) return NaN;
  if (code < kSmall) return code / 100;
  const power = 3 + Math.floor((code - kSmall) / kDigits), digits = 10 + (code - kSmall) % kDigits;
  return Number(`${digits}e-${power + 1}`);
}

/** A number with two digits as C++ prints it: 0.0012, 5.3e-05. */
function twoDigits(value) {
  if (value >= 1e-4) return String(Number(value.toPrecision(2)));
  return value.toExponential(1).replace(/\.0(?=e)/, '').replace(/e-(\d)$/, 'e-0$1');
}

function textOf(code) {
  if (code === kNone) return '-';
  return code < kSmall ? (code / 100).toFixed(2) : twoDigits(percentOf(code));
}

const short = (percent) => (percent === 0 ? '' : percent < 0.05 ? '<.1' : percent < 9.95 ? percent.toFixed(1)
    : percent.toFixed(0));
/** A number with four digits. */
const plain = (value) => (value === null || !Number.isFinite(value) ? '-' : String(Number(value.toPrecision(4))));
const unitOf = (unit) => (unit === '1' ? '' : unit.replace(/ s-1$/, '/s').replace('m s-1', 'm/s'));
const minus = (text) => text.replace(/^-/, '−');

function within(table, end, place) {
  const at = end * table.places + place;
  const one = {code: table.share[at], percent: percentOf(table.share[at]), text: textOf(table.share[at])};
  if (table.low && table.low[at] !== kNone)
    one.interval = {low: percentOf(table.low[at]), high: percentOf(table.high[at]),
      text: `[${textOf(table.low[at])}, ${textOf(table.high[at])}]`};
  return one;
}

// ---- The page

class Answer {
  constructor(data, parts) {
    Object.assign(this, {data}, parts);
    this.axes = data.section.coordinates;
    this.cellWord = data.gate ? 'gate' : 'cell';
    this.start = {face: data.starts[0].face, at: [...(data.starts[0].at ?? this.axes.map(() => 0))]};
    this.seenStart = !data.starts[0].at;  // "as seen": drawn from first entries
    this.cell = this.startCell = data.start_row * data.columns + data.start_column;
    this.shows = 'start';
    this.target = data.analysis.target ?? 'crossed';
    this.ranges = this.rangesOfFields();
    this.most = this.mostShare();
    this.build();
    this.update();
  }

  // ---- The state of a start

  faceOf(face) { return this.data.states.faces.findIndex((f) => f.face === face); }

  /** {leaf, beyond} of an entry, as StateSpace::index_of gives them. */
  leafAt(face, at) {
    const f = this.faces[this.faceOf(face)];
    const beyond = at.some((x, axis) => x < f.seen[axis][0] || x > f.seen[axis][1]);
    if (f.axis) {
      let node = 0;
      while (f.axis[node] >= 0) node = at[f.axis[node]] <= f.cutOf[node] ? node + 1 : f.above[node];
      return {leaf: f.first + f.leaf[node], beyond};
    }
    let leaf = 0;
    f.edges.forEach((edges, axis) => {
      const bins = edges.length - 1;
      let bin = 0;
      while (bin + 1 < bins && at[axis] >= edges[bin + 1]) ++bin;
      leaf = leaf * bins + bin;
    });
    return {leaf: f.first + leaf, beyond};
  }

  /** The range of a state (all its leaves) along each axis. */
  rangeOf(state) {
    const all = this.axes.map(() => [Infinity, -Infinity]);
    for (const f of this.faces) for (let i = 0; i < f.ranges.length; ++i) {
      if (this.ofLeaf[f.first + i] !== state) continue;
      f.ranges[i].forEach(([low, high], axis) => {
        all[axis] = [Math.min(all[axis][0], low), Math.max(all[axis][1], high)];
      });
    }
    return all;
  }

  /** The answer for a start if it has its own, else that of its state; place -1: none. */
  answer() {
    const {starts, states} = this.data, own = this.ownStart();
    if (own >= 0) return {place: states.count + own, own: starts[own]};
    const {leaf, beyond} = this.leafAt(this.start.face, this.start.at);
    const state = this.ofLeaf[leaf];
    return {place: state, state, leaf, beyond};
  }

  ownStart() {
    if (this.seenStart) return 0;
    return this.data.starts.findIndex((s) => s.at && s.face === this.start.face &&
      s.at.every((x, axis) => x === this.start.at[axis]));
  }

  rangesOfFields() {
    const ranges = this.axes.map(() => [Infinity, -Infinity]);
    const add = (axis, x) => {
      ranges[axis][0] = Math.min(ranges[axis][0], x);
      ranges[axis][1] = Math.max(ranges[axis][1], x);
    };
    for (const f of this.faces) f.seen.forEach(([low, high], axis) => { add(axis, low); add(axis, high); });
    for (const s of this.data.starts) s.at?.forEach((x, axis) => add(axis, x));
    return ranges.map(([low, high], axis) => {
      const wall = this.wall(axis);
      if (!(high > low)) return [Math.max(low - 1, -wall), Math.min(low + 1, wall)];
      const step = 10 ** Math.floor(Math.log10((high - low) / 20));
      return [Math.max(Math.floor(low / step) * step, -wall), Math.min(Math.ceil(high / step) * step, wall)]
          .map((x) => Number(x.toPrecision(12)));
    });
  }

  /** The largest distance of a disc's start from the middle of its gate. */
  wall(axis) {
    return this.data.gate && axis === 0 && this.start.face === 0 ? this.data.cell_m[0] / 2 : Infinity;
  }

  /** The step of an input, about a hundredth of its range. */
  stepOf(axis) {
    const [low, high] = this.ranges[axis];
    return 10 ** Math.floor(Math.log10((high - low) / 50));
  }

  rounded(axis, x) {
    const step = this.stepOf(axis) / 10, [low, high] = this.ranges[axis];
    return Number((Math.round(Math.min(high, Math.max(low, x)) / step) * step).toPrecision(10));
  }

  move(at, face = this.start.face) {
    this.seenStart = false;
    this.start = {face, at};
    this.update();
  }

  moveAlong(axis, x) {
    const at = [...this.start.at];
    at[axis] = this.rounded(axis, x);
    this.move(at);
  }

  mostShare() {
    let most = 0;
    for (const code of this.gates.share) if (code < kSmall && code > most) most = code;
    return Math.max(1, most / 100);
  }

  words(at, face) {
    const name = this.data.section.faces[face].name;
    return (face === this.data.states.faces[0].face ? '' : `${name} `) + this.axes.map((c, axis) =>
      `${c.name} ${minus(plain(at[axis]))} ${unitOf(c.unit)}`.trim()).join(', ');
  }

  startWord(at, face) {
    const first = face === 0 ? '' : `${this.data.section.faces[face].name}:`;
    return first + at.map((x) => String(x)).join(',');
  }

  // ---- Parts that are built once

  build() {
    const {data} = this;
    $('lead').textContent = data.gate ?
      'Where do bodies end that start here? Drag the disc or the tip of its arrow; choose a gate of the map.' :
      'Where do bodies end that enter so? Change the start; choose a cell of the map.';
    $('where-title').textContent = `Where bodies end: their last ${this.cellWord}`;
    this.buildKnown();
    if (data.gate && this.start.face === 0) this.drawing = new Drawing(this, $('drawing'));
    this.buildFields();
    this.shareRows = shareRows($('endings'), data.endings, this.target);
    const barsOf = data.chain.kind === 'trees' ?
      'Bars: 95 % intervals. They count that runs are few, and what larger states of the chain would change.' :
      'Bars: 95 % intervals for the sampling of the matrix. What its bins leave out they do not count: gatewalk validate measures that.';
    $('bars').textContent = (this.endings.low?.some((code) => code !== kNone) ? barsOf
        : 'There are no error bars: too few bodies were recorded.') +
      (data.max_gates > 0 ? ` Cut off: would go on after ${data.max_gates} ${this.cellWord}s.` : '');
    this.buildChoice();
    this.buildMap();
    this.buildLegend();
    this.buildCosts();
    this.buildWays();
    const from = data.chain;
    $('chain').textContent = `The chain: ${from.states} states (${from.kind === 'trees' ? 'leaves of trees' : 'bins'}), from ` +
      `${from.gate_runs} runs through one ${this.cellWord}. ` +
      (data.states.joined_for > 1 ? `Starts have ${data.states.count} states here: neighbours are joined until each has ` +
        `${data.states.joined_for} runs or more. ` : '') + (data.left_out ? `Left out: ${data.left_out}.` : '');
  }

  buildKnown() {
    this.known = this.data.starts.map((s) => element('button', {type: 'button', 'aria-pressed': 'false',
      onclick: () => { if (s.at) this.move([...s.at], s.face); else { this.seenStart = true; this.update(); } }},
    s.at ? this.words(s.at, s.face) : 'as bodies were seen to enter'));
    $('known').append(...this.known);
  }

  buildFields() {
    const place = $('fields');
    if (this.faces.length > 1) {
      this.faceField = element('select', {id: 'face', onchange: (e) =>
          this.move([...this.start.at], Number(e.target.value))},
        ...this.faces.map((f) => element('option', {value: f.face},
          `${this.data.section.faces[f.face].name} (${this.data.section.faces[f.face].origin})`)));
      place.append(element('div', {class: 'field of-face'}, element('label', {for: 'face'}, 'enters by'),
          this.faceField));
    }
    this.fields = this.axes.map((c, axis) => {
      const [low, high] = this.ranges[axis], step = this.stepOf(axis), name = c.words || c.name;
      const number = element('input', {type: 'number', id: `at-${axis}`, step: 'any',
          'aria-describedby': `unit-${axis}`,
        oninput: (e) => {
          const x = e.target.value === '' ? NaN : Number(e.target.value);
          const inside = Math.abs(x) <= this.wall(axis);  // false for NaN
          e.target.setAttribute('aria-invalid', String(!inside));
          if (!inside) return;
          const at = [...this.start.at];
          at[axis] = x;
          this.move(at);
        },
        onkeydown: (e) => {  // replaces the browser's own step of 1
          const by = {ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10}[e.key];
          if (!by) return;
          e.preventDefault();
          this.moveAlong(axis, this.start.at[axis] + by * step);
        }});
      const slider = element('input', {type: 'range', min: low, max: high, step: step / 10,
          'aria-label': `${name}, slider`,
        oninput: (e) => this.moveAlong(axis, Number(e.target.value))});
      place.append(element('div', {class: 'field'}, element('label', {for: `at-${axis}`, title: name}, c.name), number,
        element('span', {class: 'unit', id: `unit-${axis}`}, unitOf(c.unit)), slider));
      return {number, slider};
    });
  }

  buildChoice() {
    const choice = (value, text) => {
      const input = element('input', {type: 'radio', name: 'shows', value, onchange: () =>
          { this.shows = value; this.update(); }});
      input.checked = value === this.shows;
      return element('label', {}, input, element('span', {}, text));
    };
    this.choiceOfCell = choice('cell', '');
    $('of').append(choice('start', 'of bodies from the start'), this.choiceOfCell);
  }

  cellName(cell) {
    const {columns, start_column: middle} = this.data;
    return `i_x ${minus(String(cell % columns - middle))}, i_y ${Math.floor(cell / columns)}`;
  }

  typeOf(cell) { return this.data.types ? this.data.types[this.data.type_of_gate[cell]] : null; }

  buildMap() {
    const {columns, rows, start_column: middle, cell_m: [width, length]} = this.data;
    const chart = element('div', {class: 'chart', role: 'grid',
        'aria-label': `Last ${this.cellWord}s, per cent of bodies`,
      onkeydown: (e) => this.mapKey(e)});
    chart.style.gridTemplateColumns = `20px 22px repeat(${columns}, minmax(0, 1fr))`;
    this.tiles = [];
    for (let row = rows - 1; row >= 0; --row) {
      const line = element('div', {role: 'row'});
      if (row === rows - 1) {
        const axis = element('span', {class: 'axis axis-y', 'aria-hidden': 'true'}, `row i_y, ${plain(length)} m each`);
        axis.style.gridRow = `1 / span ${rows}`;
        axis.style.gridColumn = '1';
        line.append(axis);
      }
      const number = element('span', {class: 'axis', role: 'rowheader', 'aria-label': `row ${row}`}, String(row));
      number.style.gridColumn = '2';
      line.append(number);
      for (let column = 0; column < columns; ++column) {
        const cell = row * columns + column;
        const tile = element('button', {type: 'button', role: 'gridcell', tabindex: '-1', 'data-cell': cell,
          class: cell === this.startCell ? 'first' : null, onclick: () => this.choose(cell)},
        element('span', {class: 'number'}), element('span', {class: 'mark', 'aria-hidden': 'true'}, this.data.types
            ? kMarks[this.data.type_of_gate[cell] % kMarks.length] : ''));
        tile.style.aspectRatio = `${width} / ${length}`;
        this.tiles[cell] = tile;
        line.append(tile);
      }
      chart.append(line);
    }
    const below = element('div', {role: 'row'});
    for (let column = 0; column < columns; ++column) {
      const number = element('span', {class: 'axis', role: 'columnheader', 'aria-label': `column ${column - middle}`},
          minus(String(column - middle)));
      number.style.gridColumn = String(column + 3);
      below.append(number);
    }
    const title = element('span', {class: 'axis axis-x', 'aria-hidden': 'true'}, `column i_x, ${plain(width)} m each`);
    title.style.gridColumn = `3 / span ${columns}`;
    chart.append(below, title);
    this.overlay = element('svg:svg', {'aria-hidden': 'true'});
    chart.append(this.overlay);
    $('map').append(chart);
    this.chart = chart;
    new ResizeObserver(() => this.drawWay()).observe(chart);
  }

  mapKey(e) {
    const {columns, rows} = this.data;
    const by = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[e.key];
    let column = this.cell % columns, row = Math.floor(this.cell / columns);
    if (by) { column += by[0]; row += by[1]; }
    else if (e.key === 'Home') column = 0;
    else if (e.key === 'End') column = columns - 1;
    else if (e.key === 'PageUp') row = rows - 1;
    else if (e.key === 'PageDown') row = 0;
    else return;
    e.preventDefault();
    column = Math.min(columns - 1, Math.max(0, column));
    row = Math.min(rows - 1, Math.max(0, row));
    this.choose(row * columns + column);
    this.tiles[this.cell].focus();
  }

  choose(cell) {
    this.cell = cell;
    this.update();
  }

  buildLegend() {
    const ticks = [0, ...[0.1, 1, 5, 10, 20, 40, 70].filter((x) => x < 0.75 * this.most), this.most];
    const at = (x) => `${100 * Math.sqrt(x / this.most)}%`;
    const places = element('div', {class: 'ticks'});
    for (const x of ticks) {
      const tick = element('span', {}, `${Number(x.toFixed(1))} %`);
      tick.style.left = at(x);
      if (x === 0 || x === this.most || Math.sqrt(x / this.most) > 0.12) places.append(tick);
    }
    this.ramp = element('div', {class: 'ramp'});
    const types = this.data.types?.map((name, type) =>
        `${kMarks[type % kMarks.length] || 'no mark'}: "${name}"`).join('; ');
    $('legend').append(this.ramp, places, element('div', {},
        `Per cent of bodies; the colour goes with its square root. The bar below marks the ${this.cellWord} where bodies start.` +
      (types ? ` Types of ${this.cellWord}s: ${types}.` : '')));
  }

  buildCosts() {
    const a = this.data.analysis, by = a.by_ending ?? {}, place = $('costs-card');
    const costs = Object.keys(by.all ?? {}).filter((key) => key.startsWith('mean_')).map((key) => key.slice(5));
    if (costs.length === 0 || !costs.some((c) => Number.isFinite(by.all[`mean_${c}`]))) {
      place.append(element('p', {}, `${this.cellWord === 'gate' ? 'The matrix' : 'What the runs were made of'} does not know how long they took.`));
      return;
    }
    const s = this.data.starts[0];
    const kNames = {time_s: 'time, s', forward_m: 'way forward, m', work_J: 'work of the propulsion, J',
      random_work_J: 'work of the random force, J', lost_J: 'lost, J'};
    place.append(element('p', {}, `Of bodies from ${s.at ? this.words(s.at, s.face) : 'all first entries'}, by how they end: means${a.expected_gates_95 && Number.isFinite(a.expected_gates_95[0]) ? ', with 95 % intervals' : '; no intervals are known'}.`));
    const name = (key) => this.data.endings.find((e) => e.key === key)?.name ?? 'all';
    const rows = Object.keys(by).map((key) => {
      const interval = (c) => {
        const all = key === 'all', of = all ? a : by[key];
        const mean = all ? `expected_${c === 'time_s' && a.expected_seconds !== undefined ? 'seconds' : c}` : `mean_${c}`;
        const known = of[`${mean}_95`], why = of.why_no_interval?.[mean];
        if (known) return element('small', {}, `[${plain(known[0])}, ${plain(known[1])}]`);
        return why ? element('small', {title: why}, 'no interval') : '';
      };
      const q = by[key].quantiles_time_s;
      return element('tr', {'data-ending': key}, element('th', {scope: 'row'}, name(key)),
        ...costs.map((c) => element('td', {'data-cost': c}, plain(by[key][`mean_${c}`]), interval(c))),
        ...(q ? [element('td', {}, q[2] === null ? '-' : plain(q[2]), q[0] === null ? ''
            : element('small', {}, `${plain(q[0])} to ${plain(q[4])}`))] : []));
    });
    const hasQuantiles = Boolean(by.all.quantiles_time_s);
    const sheet = element('table', {}, element('thead', {}, element('tr', {}, element('td', {}),
      ...costs.map((c) => element('th', {scope: 'col'}, kNames[c] ?? c.replaceAll('_', ' '))),
      ...(hasQuantiles ? [element('th', {scope: 'col'}, 'median of the time, 5 to 95 % of them, s')] : []))),
          element('tbody', {}, ...rows));
    place.append(element('div', {class: 'wide', tabindex: '0', role: 'group', 'aria-label': 'Times and work'}, sheet));
    if (Number.isFinite(a.expected_gates))
      place.append(element('p', {class: 'remark'},
          `${plain(a.expected_gates)} ${this.cellWord}s are visited on average` +
        (a.expected_gates_95 ? ` [${plain(a.expected_gates_95[0])}, ${plain(a.expected_gates_95[1])}].` : '.')));
  }

  buildWays() {
    const a = this.data.analysis, paths = (a.paths ?? []).filter((p) => p.gates.length > 0);
    if (paths.length === 0) return;
    const name = this.data.endings.find((e) => e.key === this.target)?.name ?? this.target;
    $('ways').hidden = false;
    $('ways-title').textContent = `The most frequent ways: ${name}`;
    this.way = -1;
    this.wayButtons = paths.map((p, i) => element('button', {type: 'button', 'aria-pressed': 'false', onclick: () => {
      this.way = this.way === i ? -1 : i;
      this.wayButtons.forEach((b, k) => b.setAttribute('aria-pressed', String(k === this.way)));
      this.drawWay();
    }}, `${i + 1}: ${p.gates.length} ${this.cellWord}s, ${twoDigits(100 * p.probability)} %`));
    $('ways-card').append(element('p', {},
        `Per cent of bodies from ${this.data.starts[0].at ? this.words(this.data.starts[0].at, this.data.starts[0].face) : 'all first entries'}. Choose one to see it on the map.`),
      element('div', {}, ...this.wayButtons));
    if (a.paths_complete === false)
      $('ways-card').append(element('p', {class: 'remark'},
          'There may be more frequent ones: the search was given up.'));
    this.paths = paths;
  }

  drawWay() {
    this.overlay.replaceChildren();
    if (!this.paths || this.way < 0) return;
    const box = this.chart.getBoundingClientRect();
    Object.assign(this.overlay.style, {left: '0', top: '0', width: `${box.width}px`, height: `${box.height}px`});
    const {columns, start_column: middle} = this.data;
    const points = this.paths[this.way].gates.map((g) => {
      const tile = this.tiles[g.i_y * columns + g.i_x + middle].getBoundingClientRect();
      return [tile.left + tile.width / 2 - box.left, tile.top + tile.height / 2 - box.top];
    });
    this.overlay.append(element('svg:polyline', {points: points.map((p) => p.join(',')).join(' ')}));
    const [x, y] = points[0];
    this.overlay.append(element('svg:circle', {cx: x, cy: y, r: 5}));
  }

  // ---- Parts that follow the start and the chosen cell

  update() {
    const answer = this.answer();
    this.updateFields();
    this.known.forEach((button, i) => button.setAttribute('aria-pressed', String(this.ownStart() === i)));
    this.updateState(answer);
    fillShares(this.shareRows, this.data.endings.map((_, e) =>
        (answer.place < 0 ? null : within(this.endings, e, answer.place))));
    this.updateRest(answer);
    this.updateMap(answer);
    this.updateCell(answer);
    this.drawing?.update(answer);
    clearTimeout(this.saying);
    this.saying = setTimeout(() => {
      if (answer.place < 0) return;
      $('said').textContent = this.data.endings.map((e, i) =>
          `${e.name} ${within(this.endings, i, answer.place).text} per cent`).join(', ');
    }, 600);
  }

  /** Shares that the endings leave out, if larger than their rounding. */
  updateRest({place}) {
    const rest = place < 0 ? 0
        : this.data.endings.reduce((left, _, e) => left - within(this.endings, e, place).percent, 100);
    $('rest').hidden = rest < 0.1;
    $('rest').textContent = `The other ${rest.toFixed(1)} % reach a state that was never sampled, or were still under way when ` +
      'the sum was stopped: how these end is not known.';
  }

  updateFields() {
    this.fields.forEach(({number, slider}, axis) => {
      const x = this.start.at[axis];
      if (Number(number.value) !== x || number.value === '') number.value = String(x);
      number.setAttribute('aria-invalid', 'false');
      slider.value = String(x);
      slider.setAttribute('aria-valuetext', `${x} ${unitOf(this.axes[axis].unit)}`);
    });
    if (this.faceField) this.faceField.value = String(this.start.face);
  }

  updateState({place, own, state, leaf, beyond}) {
    const {chain} = this.data, note = $('state'), says = [];
    const command = (more = '') => element('code', {},
        `gatewalk predict ${chain.asked} --start ${this.startWord(this.start.at, this.start.face)}${more}`);
    if (own) {
      const sure = own.error_95 === null ? ''
          : ` At most ${Number((100 * own.error_95).toPrecision(2))} % of the bodies end in another ${this.cellWord} than said, 95 times in 100.`;
      if (own.answer_from === 'matrix') says.push(this.stateWords(this.leafAt(own.face, own.at)));
      else says.push(element('p', {}, (own.at
          ? `This start is a state of its own, with ${own.first_runs} runs of its own through the first ${this.cellWord}. ` : `All first entries of ${own.first_runs} bodies. `) +
        (own.answer_from === 'trials' ? 'The answer is the shares of its own trials.'
            : 'The answer is the chain\'s.') + sure));
    } else if (place < 0) {
      says.push(element('p', {class: 'warning'}, 'No run entered so: the chain says nothing of this start.'));
    } else {
      says.push(this.stateWords({leaf, state}));
      if (beyond) says.push(element('p', {class: 'warning'},
          'This start lies beyond all entries that were seen. The answer is that of the nearest state, which may be far off.'));
      if (chain.kind === 'bins') says.push(element('p', {}, 'All starts in this bin have this answer: ', command()));
      else if (!chain.can_run) says.push(element('p', {},
          'All starts in this state have this answer; no other runs were recorded: ', command()));
      else says.push(element('p', {},
          'No run began here: the answer is that of the state, from its few runs, so it jumps from state to state within its bars. ',
        command(), ' gives this start\'s own: some 500 runs through the first gate more, and full trials until its error bar is small.'));
    }
    note.replaceChildren(...says);
  }

  /** A state's name, the range of its entries, and their number. */
  stateWords({leaf, state = this.ofLeaf[leaf]}) {
    const {chain, states} = this.data, name = this.data.section.faces[this.start.face].name;
    const range = this.rangeOf(state);
    const text = this.axes.map((c, axis) => {
      const [least, most] = this.rangeSeen(axis), [low, high] = range[axis];
      return `${c.name} ${minus(plain(low === -Infinity ? least : low))} to ${minus(plain(high === Infinity ? most : high))} ${unitOf(c.unit)}`.trim();
    }).join(', ');
    const joined = states.joined_for > 1 ? 'a state of leaves that are joined' : `state ${leaf + 1} of ${chain.states}`;
    return element('p', {}, element('b', {}, `${name}, ${joined}: `), `${text}. ${this.runs[state]} runs entered so.`);
  }

  rangeSeen(axis) { return this.faces[this.faceOf(this.start.face)].seen[axis]; }

  updateMap({place}) {
    const ofCell = this.shows === 'cell', at = ofCell ? this.cell : place, from = ofCell ? this.cellGates : this.gates;
    this.choiceOfCell.querySelector('span').textContent = `of those who come to ${this.cellName(this.cell)}`;
    this.tiles.forEach((tile, cell) => {
      const share = at < 0 ? null : within(from, cell, at);
      const percent = share && Number.isFinite(share.percent) ? share.percent : 0;
      const part = Math.min(1, Math.sqrt(percent / this.most));
      tile.style.background = `color-mix(in oklab, var(--high) ${(100 * part).toFixed(1)}%, var(--low))`;
      tile.style.color = part > 0.5 ? 'var(--on-high)' : 'var(--ink)';
      tile.firstChild.textContent = share && Number.isFinite(share.percent) ? short(percent) : '';
      const chosen = cell === this.cell;
      tile.setAttribute('aria-selected', String(chosen));
      tile.tabIndex = chosen ? 0 : -1;
      tile.setAttribute('aria-label',
          `${this.cellWord} ${this.cellName(cell)}${this.typeOf(cell) ? `, ${this.typeOf(cell)}` : ''}: ` +
        (share ? `${share.text} per cent${share.interval ? ` ${share.interval.text}` : ''}` : 'not known'));
    });
  }

  updateCell({place}) {
    const {data, cell} = this, card = $('gate-card');
    $('gate-title').textContent = `The chosen ${this.cellWord}: ${this.cellName(cell)}${this.typeOf(cell) ? `, ${this.typeOf(cell)}` : ''}`;
    const says = [];
    if (place >= 0) {
      const here = within(this.gates, cell, place);
      says.push(element('p', {id: 'here'}, element('b', {}, `${here.text} %`),
          ` ${here.interval ? here.interval.text : ''} of the bodies from the start end here.`));
    }
    const [visits, low, high] = data.cells.visits[cell], s = data.starts[0];
    const from = s.at ? this.words(s.at, s.face) : 'all first entries';
    if (!(visits > 1e-9)) {
      says.push(element('p', {}, `Of bodies from ${from} next to none come here.`));
      card.replaceChildren(...says);
      return;
    }
    says.push(element('p', {}, `A body from ${from} comes here ${plain(visits)}${low === null ? '' : ` [${plain(low)}, ${plain(high)}]`} times on average. From here, of each visit:`));
    const ends = element('div', {id: 'from-here'}), next = element('div', {id: 'next'});
    fillShares(shareRows(ends, data.endings, this.target), data.endings.map((_, e) => within(this.cellEndings, e,
        cell)));
    const arrow = ([dx, dy]) => ({'0,1': '↑ up', '1,0': '→ right', '-1,0': '← left',
        '0,-1': '↓ back'}[`${dx},${dy}`] ?? `by ${dx}, ${dy}`);
    const moves = [...data.cells.moves.map((m) => ({key: m.join(','), name: arrow(m)})),
        {key: 'trapped', name: 'trapped here'}];
    fillShares(shareRows(next, moves), moves.map((_, m) => within(this.cellNext, m, cell)));
    says.push(element('h3', {}, 'How they end'), ends, element('h3', {}, `Where they go next`), next);
    card.replaceChildren(...says);
  }
}

/** Rows of name, bar with whisker, and number. */
function shareRows(place, names, target = null) {
  const rows = names.map((n) => {
    const bar = element('i'), whisker = element('b'), number = element('span', {class: 'number'});
    return {bar, whisker, number, row: element('div', {'data-key': n.key},
      element('span', {class: n.key === target ? 'target' : null}, n.name),
          element('span', {class: 'share', 'aria-hidden': 'true'}, bar, whisker), number)};
  });
  place.append(element('div', {class: 'shares'}, ...rows.map((r) => r.row)));
  return rows;
}

function fillShares(rows, shares) {
  rows.forEach(({bar, whisker, number}, i) => {
    const s = shares[i];
    bar.style.width = `${s && Number.isFinite(s.percent) ? s.percent : 0}%`;
    whisker.hidden = !s?.interval;
    if (s?.interval) {
      whisker.style.left = `${s.interval.low}%`;
      whisker.style.width = `${Math.max(0, s.interval.high - s.interval.low)}%`;
    }
    number.replaceChildren(s ? `${s.text} %` : '-', ...(s?.interval ? [' ', element('small', {}, s.interval.text)]
        : []));
  });
}

// ---- The gate to scale, with the start

class Drawing {
  constructor(answer, place) {
    this.answer = answer;
    const {gate, cell_m: [width, length], types, type_of_gate} = answer.data;
    Object.assign(this, {width, length, radius: gate.radius_m});
    const margin = 0.12 * length, below = gate.radius_m + margin;
    this.scale = 400 / (width + 2 * margin);
    this.x0 = -width / 2 - margin;
    this.y1 = length + 0.6 * margin;
    const speed = Math.hypot(...(answer.data.starts[0].at ?? [0, 0, 0]).slice(1)) ||
      Math.max(...answer.ranges.slice(1).flat().map(Math.abs));
    const seconds = 0.4 * length / speed, power = 10 ** Math.floor(Math.log10(seconds));
    this.seconds = [1, 2, 5].map((k) => k * power).filter((t) => t <= seconds).pop();
    const w = 400, h = (this.y1 + below) * this.scale;
    const beam = gate.beam_m[types ? type_of_gate[answer.startCell] : 0];
    const svg = element('svg:svg', {viewBox: `0 0 ${w} ${h.toFixed(1)}`, role: 'group',
        'aria-label': 'The first gate from above, to scale; bodies enter from below'});
    const line = (cls, x0, y0, x1, y1) => element('svg:line',
        {class: cls, x1: this.px(x0), y1: this.py(y0), x2: this.px(x1), y2: this.py(y1)});
    const text = (x, y, words, anchor = 'middle') => element('svg:text', {x, y, 'text-anchor': anchor}, words);
    svg.append(element('svg:rect', {class: 'ground', x: 0, y: 0, width: w, height: h}),
      element('svg:rect', {class: 'frame', x: this.px(-width / 2), y: this.py(length), width: width * this.scale,
          height: length * this.scale}));
    this.stateBox = element('svg:rect', {class: 'state'});
    this.speedBox = element('svg:rect', {class: 'state'});
    svg.append(this.stateBox, line('entrance', -width / 2, 0, width / 2, 0));
    for (const side of [-1, 1]) {
      const x = side * gate.joint_x_m;
      svg.append(line('beam', x, gate.joint_y_m, x - side * beam, gate.joint_y_m),
        element('svg:circle', {class: 'joint', cx: this.px(x), cy: this.py(gate.joint_y_m), r: 5}));
    }
    svg.append(text(this.px(0), 14,
        `${plain(width)} x ${plain(length)} m; beams ${plain(beam)} m; radius ${plain(gate.radius_m)} m`),
      text(this.px(0), h - 6, `arrow: the way of ${plain(this.seconds)} s at this speed`));
    this.disc = element('svg:circle', {class: 'disc', r: this.radius * this.scale});
    this.discRing = element('svg:circle', {class: 'ring', r: this.radius * this.scale + 4});
    this.arrow = element('svg:line', {class: 'arrow'});
    this.head = element('svg:path', {class: 'head', d: 'M 0 0 L -13 -7 L -13 7 Z'});
    this.grip = element('svg:circle', {class: 'grip', r: 20});
    this.gripRing = element('svg:circle', {class: 'ring', r: 12});
    this.place = element('svg:g', {role: 'slider', tabindex: '0', 'aria-label': 'place of the start'}, this.disc,
        this.discRing);
    this.speed = element('svg:g', {role: 'slider', tabindex: '0', 'aria-label': 'velocity of the start'}, this.grip,
        this.gripRing);
    svg.append(this.place, this.speedBox, this.arrow, this.head, this.speed);
    place.append(svg);
    this.svg = svg;
    this.listen(this.place, (x) => answer.moveAlong(0, x), [0, 0]);
    this.listen(this.speed, (x, y) => {
      const at = [...answer.start.at];
      at[1] = answer.rounded(1, (x - at[0]) / this.seconds);
      at[2] = answer.rounded(2, y / this.seconds);
      answer.move(at);
    }, [1, 2]);
  }

  px(x) { return (x - this.x0) * this.scale; }
  py(y) { return (this.y1 - y) * this.scale; }

  /** Lets the user move `group` by dragging and by arrow keys, each direction along one axis. */
  listen(group, moved, [across, up]) {
    const {answer} = this;
    let offset = null;
    const at = (e) => {
      const p = new DOMPoint(e.clientX, e.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
      return [p.x / this.scale + this.x0, this.y1 - p.y / this.scale];
    };
    group.addEventListener('pointerdown', (e) => {
      const [x, y] = at(e), [d, vx, vy] = answer.start.at;
      offset = across === 0 ? [d - x, 0] : [d + vx * this.seconds - x, vy * this.seconds - y];
      group.setPointerCapture(e.pointerId);
      group.focus({preventScroll: true});
      e.preventDefault();
    });
    group.addEventListener('pointermove', (e) => {
      if (!offset) return;
      const [x, y] = at(e);
      const next = [x + offset[0], y + offset[1]];
      cancelAnimationFrame(this.frame);
      this.frame = requestAnimationFrame(() => moved(...next));
    });
    for (const end of ['pointerup', 'pointercancel']) group.addEventListener(end, () => { offset = null; });
    group.addEventListener('keydown', (e) => {
      const many = e.shiftKey ? 10 : 1;
      const [axis, by] = {ArrowLeft: [across, -1], ArrowRight: [across, 1], ArrowDown: [up, -1],
          ArrowUp: [up, 1]}[e.key] ?? [];
      if (axis === undefined) {
        if (e.key === 'Home' || e.key === 'End') {
          e.preventDefault();
          answer.moveAlong(across, answer.ranges[across][e.key === 'Home' ? 0 : 1]);
        }
        return;
      }
      e.preventDefault();
      answer.moveAlong(axis, answer.start.at[axis] + by * many * answer.stepOf(axis));
    });
  }

  update({state}) {
    const [d, vx, vy] = this.answer.start.at, {axes} = this.answer;
    const x = this.px(d), y = this.py(0), tipX = this.px(d + vx * this.seconds), tipY = this.py(vy * this.seconds);
    for (const circle of [this.disc, this.discRing]) { circle.setAttribute('cx', x); circle.setAttribute('cy', y); }
    const far = Math.hypot(tipX - x, tipY - y), angle = Math.atan2(tipY - y, tipX - x);
    const short = Math.max(0, far - 9);
    this.arrow.setAttribute('x1', x); this.arrow.setAttribute('y1', y);
    this.arrow.setAttribute('x2', x + short * Math.cos(angle));
        this.arrow.setAttribute('y2', y + short * Math.sin(angle));
    this.head.setAttribute('transform', `translate(${tipX} ${tipY}) rotate(${angle * 180 / Math.PI})`);
    for (const circle of [this.grip, this.gripRing]) { circle.setAttribute('cx', tipX);
        circle.setAttribute('cy', tipY); }
    const say = (group, axis, words) => {
      const [low, high] = this.answer.ranges[axis];
      group.setAttribute('aria-valuemin', low); group.setAttribute('aria-valuemax', high);
      group.setAttribute('aria-valuenow', this.answer.start.at[axis]);
      group.setAttribute('aria-valuetext', words);
    };
    say(this.place, 0, `${axes[0].name} ${d} ${unitOf(axes[0].unit)}`);
    say(this.speed, 1, `${axes[1].name} ${vx}, ${axes[2].name} ${vy} ${unitOf(axes[1].unit)}`);
    // The state: the range of its entries' places and velocities.
    const known = state !== undefined && state >= 0;
    for (const box of [this.stateBox, this.speedBox]) box.setAttribute('visibility', known ? 'visible' : 'hidden');
    if (!known) return;
    const [[low, high], [vx0, vx1], [vy0, vy1]] = this.answer.rangeOf(state).map(([from, to], axis) => {
      const [least, most] = this.answer.rangeSeen(axis);
      return [Math.max(from, least), Math.min(to, most)];
    });
    const put = (box, x0, y0, x1, y1) => {
      const least = 3;  // points, to be visible
      const at = {x: this.px(x0), y: this.py(y1), width: Math.max(least, (x1 - x0) * this.scale),
          height: Math.max(least, (y1 - y0) * this.scale)};
      for (const [key, value] of Object.entries(at)) box.setAttribute(key, value);
    };
    const thick = 4 / this.scale, t = this.seconds;
    put(this.stateBox, low, -thick, high, thick);
    put(this.speedBox, d + vx0 * t, vy0 * t, d + vx1 * t, vy1 * t);
  }
}

// ---- Reading

/** Prepares a face's tree for look-ups: where the part above each cut begins, the leaves, their ranges. */
async function readFace(face, axes) {
  if (!face.axis) {
    let ranges = [[]];
    for (const edges of face.edges)
      ranges = ranges.flatMap((r) => edges.slice(1).map((high, i) => [...r, [edges[i], high]]));
    return {...face, ranges};
  }
  const axis = await unpacked(face.axis, 'i8'), cuts = face.cut ? await unpacked(face.cut, 'f64') : [];
  const cutOf = new Float64Array(axis.length), above = new Int32Array(axis.length), leaf = new Int32Array(axis.length),
      ranges = [];
  let cut = 0;
  const open = [];  // nodes whose upper part is still to come, with its range
  let range = Array.from({length: axes}, () => [-Infinity, Infinity]);
  for (let node = 0; node < axis.length; ++node) {
    const a = axis[node];
    if (a >= 0) {
      cutOf[node] = cuts[cut++];
      const [low, high] = range[a];
      open.push({node, range: range.map((r, k) => (k === a ? [cutOf[node], high] : r))});
      range = range.map((r, k) => (k === a ? [low, cutOf[node]] : r));
      continue;
    }
    leaf[node] = ranges.length;
    ranges.push(range);
    const back = open.pop();
    if (!back) continue;
    above[back.node] = node + 1;
    range = back.range;
  }
  return {...face, axis, cutOf, above, leaf, ranges};
}

async function read() {
  const data = JSON.parse($('data').textContent), count = data.states.count, cells = data.columns * data.rows;
  const places = count + data.starts.length;
  const parts = {
    faces: await Promise.all(data.states.faces.map((f) => readFace(f, data.section.coordinates.length))),
    ofLeaf: await unpacked(data.states.of_leaf, 'i32'),
    runs: await unpacked(data.states.runs, 'i32'),
    endings: await table(data.answers.endings, places),
    gates: await table(data.answers.gates, places),
    cellEndings: await table(data.cells.endings, cells),
    cellGates: await table(data.cells.gates, cells),
    cellNext: await table(data.cells.next, cells),
  };
  $('play').hidden = false;
  return new Answer(data, parts);
}

read().then((answer) => { window.gatewalkAnswer = answer; }, (error) => {
  $('failed').hidden = false;
  $('failed').textContent = typeof DecompressionStream === 'undefined' ?
    'This browser is too old for the page: it needs Chrome 80, Firefox 113, Safari 16.4 or newer.'
        : `The page is broken: ${error.message}`;
});
