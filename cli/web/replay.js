// SPDX-License-Identifier: MIT
// Animates runs of a body among beams: gatewalkReplay(element, film) builds the animation inside `element` and
// returns {play, pause, seek, key}. cli/film/replay.h describes a film. The animation lives in a shadow tree, so
// that styles and names cannot clash with the page around it.
'use strict';

const gatewalkReplay = (() => {
  const kSeries = {
    body_J: {name: 'body, kinetic', colour: 'text', dash: []},
    beams_J: {name: 'beams, kinetic', colour: 'sky', dash: [5, 3]},
    elastic_J: {name: 'beams, elastic', colour: 'green', dash: []},
    work_J: {name: 'work put in', colour: 'orange', dash: []},
    lost_J: {name: 'lost', colour: 'purple', dash: [6, 3]},
    lost_in_hits_J: {name: 'of it in hits', colour: 'purple', dash: [2, 3]},
  };
  const kPanels = [
    {title: 'Energy stored now', keys: ['body_J', 'beams_J', 'elastic_J']},
    {title: 'Put in and lost since the start', keys: ['work_J', 'lost_J', 'lost_in_hits_J']},
  ];
  const kFilmKeys = ['title', 'scale', 'radius_m', 'beam_m', 'joint_x_m', 'joint_y_m', 'gate_m', 'columns', 'rows',
    'start_column', 'runs'];
  const kOptionalFilmKeys = ['types', 'type_of_gate', 'actions'];
  const kArrays = ['t', 'gx', 'gy', 'x', 'y', 'vx', 'vy', 'left', 'right', 'contact_left', 'contact_right',
    'random_N', 'body_J', 'beams_J', 'elastic_J', 'work_J', 'lost_J'];
  const kOptionalArrays = ['lost_in_hits_J', 'type'];
  const kContacts = ['free', 'hit', 'held'];
  // In the scene's own units of time:
  const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10];  // a second
  const kFlash = 0.25;    // a hit stays visible; longer at high speed
  const kSmooth = 0.75;   // before and after, for the mean place of the following camera
  const kWake = 1.5;      // of the track that is drawn strongly

  const kStyle = `
    :host { display: block; }
    .gwr { --text: #1b1f24; --muted: #59626d; --line: #d5dae0; --card: #ffffff; --stage: #f5f7f9; --blue: #0072b2;
      --red: #c8401c; --orange: #d98300; --grey: #7b858f; --green: #00805c; --sky: #2b8fc9; --purple: #a8447f;
      --disc: #dfe4ea; --edge: #2c333b; --accent: #0b63a5; --warn: #fff4d6;
      color: var(--text); font-size: 15px; line-height: 1.4; text-align: left; container-type: inline-size; }
    .gwr.gwr-dark { --text: #e9ebee; --muted: #a7b0ba; --line: #3a424c; --card: #171b21; --stage: #1e232a; --blue: #56b4e9;
      --red: #ff7f5c; --orange: #f2b134; --grey: #98a2ad; --green: #35c299; --sky: #6cc4f5; --purple: #e08cbd;
      --disc: #38414c; --edge: #cfd5dc; --accent: #7cc4ff; --warn: #453a17; }
    .gwr * { box-sizing: border-box; }
    .gwr-message { background: var(--warn); border-left: 4px solid var(--orange); padding: 8px 12px; margin: 0 0 12px; }
    .gwr-message ul { margin: 4px 0 0; padding-left: 20px; }
    .gwr-columns { display: grid; grid-template-columns: minmax(0, 1fr); gap: 20px; }
    @container (min-width: 760px) { .gwr-columns { grid-template-columns: minmax(0, 1.3fr) minmax(320px, 1fr); gap: 28px; } }
    .gwr-status { display: flex; align-items: baseline; gap: 8px 20px; flex-wrap: wrap; min-height: 34px; }
    .gwr-clock { font-size: 22px; font-weight: 600; font-variant-numeric: tabular-nums; min-width: 92px; }
    .gwr-mode { color: var(--muted); }
    @container (max-width: 420px) { .gwr-mode { flex-basis: 100%; } }  /* never one line and then two */
    .gwr-ended { color: var(--text); font-weight: 600; }
    canvas { display: block; width: 100%; border-radius: 8px; }
    .gwr-stage { background: var(--stage); cursor: pointer; }
    .gwr-chart { cursor: crosshair; touch-action: pan-y; height: 128px; }
    .gwr :focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
    .gwr-bar { display: flex; flex-wrap: wrap; align-items: center; gap: 10px 16px; margin-top: 10px; }
    .gwr button, .gwr select { font: inherit; color: var(--text); background: var(--card); border: 1px solid var(--muted);
      border-radius: 8px; min-height: 44px; padding: 6px 12px; max-width: 100%; }
    .gwr button { min-width: 92px; cursor: pointer; font-weight: 600; }
    .gwr-play { background: var(--accent) !important; color: var(--card) !important; border-color: var(--accent) !important; }
    .gwr-time { flex: 1 1 160px; min-width: 0; height: 44px; margin: 0; accent-color: var(--accent); cursor: pointer; }
    .gwr label { display: inline-flex; align-items: center; gap: 8px; min-height: 44px; min-width: 0; }
    .gwr-run { margin-bottom: 6px; max-width: 100%; }
    .gwr-run select { min-width: 0; flex: 0 1 auto; text-overflow: ellipsis; }
    .gwr input[type=checkbox] { width: 20px; height: 20px; accent-color: var(--accent); margin: 0; }
    .gwr h3 { font-size: 14px; font-weight: 600; margin: 0 0 4px; }
    .gwr-panel { margin-bottom: 14px; }
    .gwr table { border-collapse: collapse; width: 100%; font-size: 14px; margin-bottom: 4px; }
    .gwr th, .gwr td { padding: 1px 0; border: 0; background: none; color: inherit; text-align: left; font-weight: 400; }
    .gwr td { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
    .gwr-blank { display: inline-block; width: 34px; }
    .gwr svg { vertical-align: middle; margin-right: 8px; }
    .gwr-keys { font-size: 13px; color: var(--muted); margin: 6px 0 0; }
    @media (hover: none) { .gwr-keys { display: none; } }
    .gwr-words { margin: 12px 0 0; max-width: 75ch; }
    .gwr-hidden { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
  `;

  // ---- What a film must hold

  /** Faults that prevent showing the film, and parts that are only left out. */
  function examined(film) {
    const faults = [], remarks = [];
    if (film === null || typeof film !== 'object' || Array.isArray(film))
      return {faults: ['there is no film'], remarks};
    const number = (name, value, low) => {
      if (!Number.isFinite(value) || value < low) faults.push(`${name} is not a number of at least ${low}`);
    };
    const positive = (name, value) => {
      if (!Number.isFinite(value) || !(value > 0)) faults.push(`${name} is not a number above 0`);
    };
    if (typeof film.title !== 'string') faults.push('title is missing');
    for (const name of ['length_m', 'mass_kg', 'time_s']) positive(`scale.${name}`, film.scale?.[name]);
    for (const name of ['radius_m', 'beam_m']) positive(name, film[name]);
    for (const name of ['joint_x_m', 'joint_y_m']) number(name, film[name], 0);
    if (!Array.isArray(film.gate_m) || film.gate_m.length !== 2) faults.push('gate_m is not [width, depth]');
    else film.gate_m.forEach((side) => positive('gate_m', side));
    for (const name of ['columns', 'rows']) {
      number(name, film[name], 1);
      if (!Number.isInteger(film[name])) faults.push(`${name} is not a whole number`);
    }
    if (!Number.isInteger(film.start_column) || film.start_column < 0 || film.start_column >= film.columns)
      faults.push('start_column is no column of the field');
    for (const name of Object.keys(film)) if (![...kFilmKeys, ...kOptionalFilmKeys].includes(name)) remarks.push(name);
    if (film.types !== undefined) {
      if (!Array.isArray(film.types) || film.types.length === 0) faults.push('types is not a list');
      else film.types.forEach((type, i) => {
        positive(`types[${i}].beam_m`, type?.beam_m);
        number(`types[${i}].propulsion_N`, type?.propulsion_N, 0);
      });
      if (!Array.isArray(film.type_of_gate) || film.type_of_gate.length !== film.columns * film.rows ||
          !film.type_of_gate.every((type) => film.types?.[type] !== undefined))
        faults.push('type_of_gate is not a type for each gate');
    }
    if (film.actions !== undefined && (!Array.isArray(film.actions) || film.actions.length === 0 ||
        !film.actions.every((name) => typeof name === 'string') || film.types?.length % film.actions.length !== 0))
      faults.push('actions is not a list of names, one or several types for each');
    if (!Array.isArray(film.runs) || film.runs.length === 0) faults.push('runs is missing or empty');
    else film.runs.forEach((run, index) => examineRun(run, `run ${index + 1}: `, film, faults, remarks));
    return {faults, remarks: [...new Set(remarks)]};
  }

  function examineRun(run, where, film, faults, remarks) {
    if (run === null || typeof run !== 'object') return void faults.push(`${where}is no run`);
    for (const name of ['label', 'ending']) if (typeof run[name] !== 'string') faults.push(`${where}${name} is missing`);
    if (!Number.isFinite(run.propulsion_N)) faults.push(`${where}propulsion_N is not a number`);
    const length = Array.isArray(run.t) ? run.t.length : 0;
    if (length === 0) return void faults.push(`${where}t is missing or empty`);
    const before = faults.length;
    for (const name of [...kArrays, ...kOptionalArrays]) {
      const values = run[name];
      if (values === undefined && kOptionalArrays.includes(name)) continue;
      if (!Array.isArray(values)) faults.push(`${where}${name} is missing`);
      else if (values.length !== length) faults.push(`${where}${name} has ${values.length} entries, t has ${length}`);
      else {
        const bad = values.findIndex((value) => !Number.isFinite(value));
        if (bad >= 0) faults.push(`${where}${name}, entry ${bad}: ${values[bad]} is not a number`);
      }
    }
    const known = [...kArrays, ...kOptionalArrays, 'label', 'ending', 'propulsion_N'];
    for (const name of Object.keys(run)) if (!known.includes(name)) remarks.push(name);
    if (faults.length > before) return;
    const expect = (name, fine, what) => {
      const bad = run[name].findIndex((value, i) => !fine(value, i));
      if (bad >= 0) faults.push(`${where}${name}, entry ${bad}: ${run[name][bad]} ${what}`);
    };
    const first = -film.start_column;
    expect('t', (t, i) => i === 0 || t >= run.t[i - 1], 's goes back in time');
    expect('gx', (i) => Number.isInteger(i) && i >= first && i < first + film.columns, 'is no column of the field');
    expect('gy', (i) => Number.isInteger(i) && i >= 0 && i < film.rows, 'is no row of the field');
    for (const name of ['contact_left', 'contact_right'])
      expect(name, (c) => kContacts[c] !== undefined, 'is none of 0 (free), 1 (hit), 2 (held)');
    if (run.type) expect('type', (type) => film.types?.[type] !== undefined, 'is none of the types');
    else if (film.actions) faults.push(`${where}type is missing`);
  }

  // ---- The state at a time

  /** Adds to a run what every frame needs: places in the field, their running integrals, the last hit. */
  function prepared(run, film) {
    const [width, depth] = film.gate_m;
    const X = run.x.map((x, i) => x + width * run.gx[i]);
    const Y = run.y.map((y, i) => y + depth * run.gy[i]);
    const integral = (values) => {
      const sums = new Float64Array(values.length);
      for (let i = 1; i < values.length; ++i)
        sums[i] = sums[i - 1] + 0.5 * (values[i] + values[i - 1]) * (run.t[i] - run.t[i - 1]);
      return sums;
    };
    const lastHits = (contacts) => {  // -1: none so far
      let last = -1;
      return contacts.map((contact, i) => (last = contact === 1 ? i : last));
    };
    return {...run, X, Y, sumX: integral(X), sumY: integral(Y), end: run.t.length - 1,
      lastHit: {left: lastHits(run.contact_left), right: lastHits(run.contact_right)}};
  }

  /** The index of the last entry at or before time t. */
  function indexAt(t, time) {
    let low = 0, high = t.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (t[middle] <= time) low = middle; else high = middle - 1;
    }
    return low;
  }

  /** Place, angles and energies at a time: linear between two entries; a force or contact holds until the next. */
  function stateAt(run, time) {
    const i = indexAt(run.t, time), j = Math.min(i + 1, run.end);
    const step = run.t[j] - run.t[i];
    const part = step > 0 ? Math.min(1, Math.max(0, (time - run.t[i]) / step)) : 0;
    const between = (values) => values[i] + part * (values[j] - values[i]);
    // In another gate other beams move. Until then, the beams that the body leaves keep their last angle.
    const sameGate = run.gx[i] === run.gx[j] && run.gy[i] === run.gy[j];
    const angle = (values) => (sameGate ? between(values) : values[i]);
    const state = {time, i, gx: run.gx[i], gy: run.gy[i], X: between(run.X), Y: between(run.Y),
      vx: between(run.vx), vy: between(run.vy), left: angle(run.left), right: angle(run.right),
      contact: {left: run.contact_left[i], right: run.contact_right[i]}, random: run.random_N[i]};
    for (const key of Object.keys(kSeries)) if (run[key]) state[key] = between(run[key]);
    return state;
  }

  /** The body's mean place around a time, at which a calm camera looks. */
  function calmPlace(run, time, scale) {
    const smooth = kSmooth * scale.time_s;
    const low = Math.max(run.t[0], time - smooth), high = Math.min(run.t[run.end], time + smooth);
    const reach = Math.min(time - low, high - time);  // the same before and after, so that the ends are not cut off
    const upTo = (sums, values, at) => {
      const i = indexAt(run.t, at), j = Math.min(i + 1, run.end), step = run.t[j] - run.t[i], h = at - run.t[i];
      return step > 0 ? sums[i] + h * (values[i] + 0.5 * (values[j] - values[i]) * h / step) : sums[i];
    };
    const mean = (sums, values) =>
      (upTo(sums, values, time + reach) - upTo(sums, values, time - reach)) / (2 * reach);
    if (!(reach > 1e-6 * scale.time_s)) { const s = stateAt(run, time); return [s.X, s.Y]; }
    return [mean(run.sumX, run.X), mean(run.sumY, run.Y)];
  }

  /** The numbers in which a gate differs; `types` lists them in a field of several types. */
  function typeOf(film, gx, gy) {
    return film.types?.[film.type_of_gate[gy * film.columns + gx + film.start_column]] ?? {};
  }

  /** The numbers of the gate that the body is in at a step; a policy chooses its type. */
  function typeAt(film, run, i) {
    return run.type ? film.types[run.type[i]] : typeOf(film, run.gx[i], run.gy[i]);
  }

  function propulsionAt(film, run, state) {
    return typeAt(film, run, state.i).propulsion_N ?? run.propulsion_N;
  }

  /** Joint and tip of a beam in a gate. At rest the tip lies on the line between the joints. */
  function beamOf(film, gx, gy, side, angle, type = typeOf(film, gx, gy)) {
    const sign = side === 'left' ? 1 : -1, length = type.beam_m ?? film.beam_m;
    const x = -sign * film.joint_x_m + film.gate_m[0] * gx, y = film.joint_y_m + film.gate_m[1] * gy;
    return [x, y, x + sign * length * Math.cos(angle), y + length * Math.sin(angle)];
  }

  function nearest([x0, y0, x1, y1], x, y) {
    const dx = x1 - x0, dy = y1 - y0;
    const part = Math.max(0, Math.min(1, ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy)));
    return [x0 + part * dx, y0 + part * dy];
  }

  /** The area that a full view shows: the field, or a single gate with all places that the runs visit. */
  function boundsOf(film, runs) {
    const [width, depth] = film.gate_m, margin = 3 * film.scale.length_m;
    if (film.columns * film.rows > 1) {
      const first = -film.start_column;
      return {x0: (first - 0.5) * width - margin, x1: (first + film.columns - 0.5) * width + margin,
        y0: -film.radius_m - margin, y1: film.rows * depth + film.radius_m + margin};
    }
    const box = {x0: -film.joint_x_m, x1: film.joint_x_m, y0: 0, y1: film.joint_y_m + film.beam_m};
    const r = film.radius_m;
    for (const run of runs) for (let i = 0; i <= run.end; ++i) {
      box.x0 = Math.min(box.x0, run.X[i] - r); box.x1 = Math.max(box.x1, run.X[i] + r);
      box.y0 = Math.min(box.y0, run.Y[i] - r); box.y1 = Math.max(box.y1, run.Y[i] + r);
    }
    const half = Math.max(-box.x0, box.x1);
    return {x0: -half - margin, x1: half + margin, y0: box.y0 - margin, y1: box.y1 + margin};
  }

  // ---- Words

  /** A number's text with a true minus sign. */
  const minus = (text) => text.replace(/^(>?)-/, '$1\u2212');
  /** A whole number with a true minus sign, and no minus before zero. */
  const whole = (x) => minus(String(Math.round(x) || 0));

  /** The units in which a unit's numbers can be shown, from small to large: [size, name]. */
  function sizesOf(unit) {
    const sizes = [...'afpnµm'].map((prefix, i) => [10 ** (3 * i - 18), prefix + unit]);
    sizes.push([1, unit]);
    if (unit === 's') sizes.push([60, 'min'], [3600, 'h'], [86400, 'd']);
    else [...'kMGTPE'].forEach((prefix, i) => sizes.push([10 ** (3 * i + 3), prefix + unit]));
    return sizes;
  }
  const largestWithin = (unit, most) => sizesOf(unit).findLast(([size]) => size <= most * (1 + 1e-9)) ?? [1, unit];

  /** The unit in which numbers up to `most` are short: readable_unit of cli/render/quantity.h. */
  function readableUnit(unit, most) {
    if (most === 0 || (most >= 0.01 && most < 1e4)) return [1, unit];
    const found = largestWithin(unit, most);
    return most / found[0] < 1e4 ? found : [1, unit];
  }

  /** "15 m", "20.12 mJ": a number with at most this many significant digits. */
  function quantity(x, unit, significant = 4) {
    const rounded = Number(x.toPrecision(significant)), [size, name] = readableUnit(unit, Math.abs(rounded));
    return `${minus(String(Number((rounded / size).toPrecision(significant))))} ${name}`;
  }

  /** The unit and decimals of numbers whose smallest relevant difference is `step`: reading() of cli/render/quantity.h. */
  function readingUnit(unit, step) {
    const power = Math.round(Math.log10(step)), last = 10 ** power, typical = 100 * last;
    const plain = power >= -4 && power <= 0;
    let [size, name] = plain ? [1, unit] : largestWithin(unit, typical);
    name = ` ${name}`;
    if (!plain && (typical / size < 0.9 || typical / size > 999)) {  // no prefix is large or small enough
      const exponent = 3 * Math.floor((power + 2) / 3);
      size = 10 ** exponent;
      name = `e${exponent} ${unit}`;
    }
    return {size, name, decimals: Math.max(0, Math.round(Math.log10(size / last)))};
  }

  /** The text of one such number. A number other than zero is not shown as zero: "<0.1 J". */
  function reading(x, {size, name, decimals}) {
    let text = (x / size).toFixed(decimals);
    if (Number(text) === 0) {
      const least = (10 ** -decimals).toFixed(decimals);
      text = x > 0 ? `<${least}` : x < 0 ? `>-${least}` : (0).toFixed(decimals);
    }
    return minus(text) + name;
  }

  /** Units of a scene's readings, exact to a hundredth of its unit of time and a tenth of its other units. */
  function unitsOf({length_m: length, mass_kg: mass, time_s: time}, runs) {
    const force = mass * length / (time * time);
    const joules = (keys) => {
      const most = Math.max(...runs.flatMap((run) => keys.filter((key) => run[key]).map((key) => largest(run[key]))));
      return readingUnit('J', Math.max(0.1 * force * length, 1e-5 * most));
    };
    return {
      time: readingUnit('s', 0.01 * time),
      force: readingUnit('N', 0.1 * force),
      speed: readingUnit('m/s', 0.1 * length / time),
      energies: kPanels.map(({keys}) => joules(keys)),
    };
  }
  const largest = (values) => values.reduce((a, b) => Math.max(a, b), 0);

  /** A description of a run for users who do not see it. */
  function told(run, film, units) {
    const degrees = (angles) => Math.round(largest(angles) * 180 / Math.PI);
    const joules = (energy) => reading(energy, units.energies[1]);
    const gates = new Set(run.gx.map((gx, i) => `${gx} ${run.gy[i]}`)).size;
    const where = film.columns * film.rows > 1
      ? `It was in ${gates} of ${film.columns} x ${film.rows} gates, at last in column ${whole(run.gx[run.end])}, row ${run.gy[run.end]}.`
      : `The left beam was deflected by up to ${degrees(run.left)} degrees, the right one by up to ${degrees(run.right)} degrees.`;
    const work = run.work_J[run.end], lost = run.lost_J[run.end];
    return `${run.label}${run.label.includes(run.ending) ? '' : `: ${run.ending}`}. ${where} ` +
      `Propulsion and random force put in ${joules(work)}; ${joules(lost)} were lost.`;
  }

  // ---- The picture

  /** Draws the run at a time on a canvas of w x h points with colours c. */
  function drawStage(ctx, w, h, c, font, scene, time) {
    const {film, run, bounds, follow, arrow, flash} = scene;
    const state = stateAt(run, time), field = film.columns * film.rows > 1;
    const [width, depth] = film.gate_m;
    let scale, cx, cy;
    if (follow) {
      scale = Math.min(w / (2.3 * width), h / (1.9 * depth));
      [cx, cy] = calmPlace(run, time, film.scale);
    } else {
      scale = Math.min(w / (bounds.x1 - bounds.x0), h / (bounds.y1 - bounds.y0));
      cx = 0.5 * (bounds.x0 + bounds.x1); cy = 0.5 * (bounds.y0 + bounds.y1);
    }
    const px = (x) => 0.5 * w + (x - cx) * scale, py = (y) => 0.5 * h - (y - cy) * scale;
    const unit = film.scale.length_m * scale;  // points
    const thick = Math.max(1.5, Math.min(5, 0.9 * unit));
    const line = (points, colour, width_, dash = []) => {
      ctx.beginPath();
      points.forEach(([x, y], k) => (k ? ctx.lineTo(px(x), py(y)) : ctx.moveTo(px(x), py(y))));
      ctx.strokeStyle = colour; ctx.lineWidth = width_; ctx.setLineDash(dash); ctx.stroke(); ctx.setLineDash([]);
    };
    ctx.clearRect(0, 0, w, h);
    ctx.lineCap = 'round'; ctx.lineJoin = 'round';

    // Borders of the gates in sight, and their beams at rest. A single gate has only side borders.
    const first = -film.start_column;
    const x0 = cx - 0.5 * w / scale, x1 = cx + 0.5 * w / scale, y0 = cy - 0.5 * h / scale, y1 = cy + 0.5 * h / scale;
    const columns = [Math.max(first, Math.floor(x0 / width - 0.5)), Math.min(first + film.columns - 1, Math.ceil(x1 / width + 0.5))];
    const rows = [Math.max(0, Math.floor(y0 / depth - 1)), Math.min(film.rows - 1, Math.ceil(y1 / depth))];
    const dash = width * scale > 60 ? [5, 5] : [3, 3];
    ctx.globalAlpha = follow || !field ? 0.7 : 0.5;
    const [bottom, top] = field ? [rows[0] * depth, (rows[1] + 1) * depth] : [y0, y1];
    if (width * scale > 6)
      for (let k = columns[0]; k <= columns[1] + 1; ++k)
        line([[(k - 0.5) * width, bottom], [(k - 0.5) * width, top]], c.green, 1, dash);
    if (field && depth * scale > 6)
      for (let k = rows[0]; k <= rows[1] + 1; ++k)
        line([[(columns[0] - 0.5) * width, k * depth], [(columns[1] + 0.5) * width, k * depth]], c.green, 1, dash);
    ctx.globalAlpha = 1;
    if (field && width * scale > 12)
      for (let gx = columns[0]; gx <= columns[1]; ++gx)
        for (let gy = rows[0]; gy <= rows[1]; ++gy) {
          if (gx === state.gx && gy === state.gy) continue;
          for (const side of ['left', 'right']) {
            const [ax, ay, bx, by] = beamOf(film, gx, gy, side, 0);
            ctx.globalAlpha = 0.45;
            line([[ax, ay], [bx, by]], side === 'left' ? c.blue : c.red, Math.max(1.2, 0.6 * thick));
          }
        }
    ctx.globalAlpha = 1;

    // The track: all of it faintly, the last part strongly.
    const trail = (from, colour, size, alpha) => {
      ctx.beginPath();
      let lastX = px(run.X[from]), lastY = py(run.Y[from]);
      ctx.moveTo(lastX, lastY);
      for (let k = from + 1; k <= state.i; ++k) {
        const x = px(run.X[k]), y = py(run.Y[k]);
        if (Math.abs(x - lastX) + Math.abs(y - lastY) < 0.7) continue;
        ctx.lineTo(lastX = x, lastY = y);
      }
      ctx.lineTo(px(state.X), py(state.Y));
      ctx.globalAlpha = alpha; ctx.strokeStyle = colour; ctx.lineWidth = size; ctx.stroke(); ctx.globalAlpha = 1;
    };
    ctx.beginPath(); ctx.arc(px(run.X[0]), py(run.Y[0]), 3.5, 0, 2 * Math.PI);
    ctx.strokeStyle = c.muted; ctx.lineWidth = 1.5; ctx.stroke();
    trail(0, c.text, 1.6, 0.5);
    trail(indexAt(run.t, time - kWake * film.scale.time_s), c.text, 2.2, 0.5);

    // The body.
    const r = film.radius_m * scale;
    ctx.beginPath(); ctx.arc(px(state.X), py(state.Y), r, 0, 2 * Math.PI);
    ctx.globalAlpha = 0.88; ctx.fillStyle = c.disc; ctx.fill(); ctx.globalAlpha = 1;
    ctx.strokeStyle = c.edge; ctx.lineWidth = Math.max(1.2, Math.min(2, 0.4 * unit)); ctx.stroke();

    // The beams of the body's gate, with their contacts.
    for (const side of ['left', 'right']) {
      const beam = beamOf(film, state.gx, state.gy, side, state[side], typeAt(film, run, state.i)), colour = side === 'left' ? c.blue : c.red;
      const held = state.contact[side] === 2;
      line([[beam[0], beam[1]], [beam[2], beam[3]]], colour, held ? 1.5 * thick : thick);
      ctx.beginPath(); ctx.arc(px(beam[0]), py(beam[1]), 1.1 * thick, 0, 2 * Math.PI);
      ctx.fillStyle = c.edge; ctx.fill();
      if (held) {
        const [x, y] = nearest(beam, state.X, state.Y);
        ctx.beginPath(); ctx.arc(px(x), py(y), 1.5 * thick, 0, 2 * Math.PI);
        ctx.fillStyle = c.stage; ctx.fill(); ctx.strokeStyle = colour; ctx.lineWidth = 0.7 * thick; ctx.stroke();
      }
    }
    for (const side of ['left', 'right']) {
      const i = run.lastHit[side][state.i], age = time - run.t[i];
      if (i < 0 || age > flash) continue;
      const beam = beamOf(film, run.gx[i], run.gy[i], side, run[side][i], typeAt(film, run, i));
      const [x, y] = nearest(beam, run.X[i], run.Y[i]), grown = age / flash;
      ctx.beginPath(); ctx.arc(px(x), py(y), thick * (1.6 + 2.6 * grown), 0, 2 * Math.PI);
      ctx.globalAlpha = 0.9 * (1 - grown); ctx.strokeStyle = side === 'left' ? c.blue : c.red; ctx.lineWidth = 2;
      ctx.stroke(); ctx.globalAlpha = 1;
    }

    // The forces.
    const drawArrow = (dx, dy, colour) => {
      const length = Math.hypot(dx, dy) * scale;
      if (length < 1) return;
      const ax = px(state.X), ay = py(state.Y), ux = dx * scale / length, uy = -dy * scale / length;
      const head = Math.min(0.6 * length, Math.max(6, 2.6 * thick)), bx = ax + ux * length, by = ay + uy * length;
      ctx.strokeStyle = ctx.fillStyle = colour; ctx.lineWidth = Math.max(1.5, 0.7 * thick);
      ctx.beginPath(); ctx.moveTo(ax, ay); ctx.lineTo(bx - 0.8 * head * ux, by - 0.8 * head * uy); ctx.stroke();
      ctx.beginPath(); ctx.moveTo(bx, by);
      ctx.lineTo(bx - head * ux - 0.5 * head * uy, by - head * uy + 0.5 * head * ux);
      ctx.lineTo(bx - head * ux + 0.5 * head * uy, by - head * uy - 0.5 * head * ux);
      ctx.closePath(); ctx.fill();
    };
    drawArrow(arrow * state.random, 0, c.grey);
    drawArrow(0, arrow * propulsionAt(film, run, state), c.orange);
    ctx.beginPath(); ctx.arc(px(state.X), py(state.Y), Math.max(1.5, 0.6 * thick), 0, 2 * Math.PI);
    ctx.fillStyle = c.edge; ctx.fill();

    // A scale bar: the longest of 1, 2, 5, 10, ... m that takes at most a fifth of the width.
    const wanted = 0.2 * w / scale, power = 10 ** Math.floor(Math.log10(wanted));
    const length = power * [5, 2, 1].find((k) => k * power <= wanted);
    ctx.globalAlpha = 0.85; ctx.fillStyle = c.stage; ctx.fillRect(6, h - 32, length * scale + 12, 28); ctx.globalAlpha = 1;
    ctx.fillStyle = c.muted; ctx.font = `12px ${font}`; ctx.textAlign = 'left'; ctx.textBaseline = 'bottom';
    ctx.fillText(quantity(length, 'm'), 12, h - 14);
    ctx.beginPath(); ctx.moveTo(12, h - 10); ctx.lineTo(12 + length * scale, h - 10);
    ctx.strokeStyle = c.muted; ctx.lineWidth = 2; ctx.lineCap = 'butt'; ctx.stroke();
  }

  /** A step that cuts `span` into at most `most` parts: 1, 2 or 5 times a power of ten. */
  function tickStep(span, most) {
    const power = 10 ** Math.floor(Math.log10(span / most));
    return power * [1, 2, 5, 10].find((k) => k * power >= 0.999 * span / most);
  }

  const kLeft = 46, kRight = 8, kTop = 6, kBottom = 24;  // the chart's frame, in points

  /** The energies' range (J), never empty: from zero or below to the largest. */
  function energyRange(run, keys, scale) {
    let low = 0, high = 0;
    for (const key of keys) for (const e of run[key]) { if (e > high) high = e; if (e < low) low = e; }
    if (high > low) return [low, high];
    const {length_m: length, mass_kg: mass, time_s: time} = scale;
    return [low, low + mass * length * length / (time * time)];
  }

  /** Draws the energies over time; the future is faint. */
  function drawChart(ctx, w, h, c, font, run, keys, scale, unitOfEnergy, time) {
    const t0 = run.t[0], t1 = run.t[run.end], span = t1 - t0 || scale.time_s;
    const [low, high] = energyRange(run, keys, scale);
    const x = (t) => kLeft + (w - kLeft - kRight) * (t - t0) / span;
    const y = (e) => h - kBottom - (h - kTop - kBottom) * (e - low) / (high - low);
    ctx.clearRect(0, 0, w, h);
    ctx.font = `12px ${font}`; ctx.fillStyle = c.muted; ctx.strokeStyle = c.line; ctx.lineWidth = 1;
    ctx.textAlign = 'right'; ctx.textBaseline = 'middle';
    const joules = unitOfEnergy.size;
    const step = joules * tickStep((high - low) / joules, 3);
    for (let k = Math.ceil(low / step); k * step <= high; ++k) {
      const at = Math.round(y(k * step)) + 0.5;
      ctx.beginPath(); ctx.moveTo(kLeft, at); ctx.lineTo(w - kRight, at); ctx.stroke();
      ctx.fillText(minus(String(Number((k * step / joules).toPrecision(6)))), kLeft - 6, at, kLeft - 8);
    }
    ctx.textBaseline = 'top';
    const [unit, name] = readableUnit('s', Math.max(Math.abs(t0), Math.abs(t1)));
    const seconds = unit * tickStep(span / unit, Math.max(2, Math.floor((w - kLeft) / 60)));
    for (let k = Math.ceil(t0 / seconds - 1e-9); k * seconds <= t1 + 1e-9 * seconds; ++k) {
      const text = `${minus(String(Number((k * seconds / unit).toPrecision(6))))} ${name}`, at = x(k * seconds);
      ctx.textAlign = at + 0.5 * ctx.measureText(text).width > w ? 'right' : 'center';
      ctx.fillText(text, ctx.textAlign === 'right' ? w - 1 : at, h - kBottom + 8);
    }
    const lines = (alpha) => {
      ctx.globalAlpha = alpha; ctx.lineWidth = 1.7; ctx.lineJoin = 'round';
      const stride = Math.max(1, Math.floor(run.end / 4000));
      for (const key of keys) {
        ctx.beginPath();
        for (let i = 0; i <= run.end; i += i + stride > run.end && i < run.end ? run.end - i : stride)
          ctx.lineTo(x(run.t[i]), y(run[key][i]));
        ctx.strokeStyle = c[kSeries[key].colour]; ctx.setLineDash(kSeries[key].dash); ctx.stroke();
      }
      ctx.setLineDash([]); ctx.globalAlpha = 1;
    };
    const part = (from, to, alpha) => {
      ctx.save(); ctx.beginPath(); ctx.rect(from, 0, to - from, h); ctx.clip(); lines(alpha); ctx.restore();
    };
    const now = x(time);
    part(0, now, 1);
    part(now, w, 0.35);
    ctx.beginPath(); ctx.moveTo(now, kTop - 4); ctx.lineTo(now, h - kBottom); ctx.strokeStyle = c.accent;
    ctx.lineWidth = 2; ctx.stroke();
  }

  // ---- The widget

  function made(tag, name, attributes = {}, ...children) {
    const element = document.createElement(tag);
    if (name) element.className = name;
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  }

  /** A short line for a legend. */
  function swatch(colour, dash, arrow) {
    const box = made('span');
    box.innerHTML = `<svg width="26" height="10" aria-hidden="true"><path d="M1 5H${arrow ? 18 : 25}" stroke="var(--${colour})" ` +
      `stroke-width="3" stroke-dasharray="${dash.join(' ')}"/>` +
      (arrow ? `<path d="M17 0L26 5L17 10Z" fill="var(--${colour})"/>` : '') + '</svg>';
    return box;
  }

  function refusal(root, faults) {
    const list = made('ul', '', {}, ...faults.slice(0, 6).map((fault) => made('li', '', {}, fault)));
    if (faults.length > 6) list.append(made('li', '', {}, `and ${faults.length - 6} more`));
    root.append(made('div', 'gwr-message', {role: 'alert'}, 'This run cannot be shown:', list));
  }

  return function gatewalkReplay(element, film) {
    const host = made('div');
    element.append(host);
    const shadow = host.attachShadow({mode: 'open'});
    const root = made('div', 'gwr', {role: 'group'});
    shadow.append(made('style', '', {}, kStyle), root);

    const {faults, remarks} = examined(film);
    if (faults.length > 0) {
      watchTheme(() => {});
      refusal(root, faults);
      const nothing = () => {};
      return {play: nothing, pause: nothing, seek: nothing, key: nothing};
    }
    root.setAttribute('aria-label', `Replay: ${film.title}`);
    if (remarks.length > 0)
      root.append(made('div', 'gwr-message', {role: 'status'},
        `This page does not know ${remarks.join(', ')}: shown without.`));

    const runs = film.runs.map((run) => prepared(run, film));
    const field = film.columns * film.rows > 1;
    const bounds = boundsOf(film, runs), unit = film.scale.time_s, units = unitsOf(film.scale, runs);
    let run = runs[0], time = run.t[0], playing = false, last = 0, colours = {}, font = 'sans-serif', frame = 0;

    // All runs have the same scale of arrows. The longer of two spans two radii: propulsion, and the random force that
    // few draws exceed.
    const draws = runs.flatMap((r) => r.random_N.map(Math.abs)).sort((a, b) => a - b);
    const strong = Math.max(draws[Math.floor(0.95 * (draws.length - 1))], ...runs.map((r) => Math.abs(r.propulsion_N)));
    const arrow = strong > 0 ? 2 * film.radius_m / strong : 0;

    // Controls
    const chooser = made('select', '', {}, ...runs.map((r, i) => made('option', '', {value: i}, r.label)));
    if (runs.length > 1) root.append(made('label', 'gwr-run', {}, 'Run', chooser));
    const clock = made('span', 'gwr-clock'), mode = made('span', 'gwr-mode');
    const stage = made('canvas', 'gwr-stage', {tabindex: 0, role: 'img'});
    const stageBox = made('div', '', {}, stage);
    const play = made('button', 'gwr-play', {type: 'button'}, 'Play');
    const slider = made('input', 'gwr-time', {type: 'range', step: 'any', 'aria-label': 'Time in the run'});
    const speed = made('select', '', {title: 'times as fast as real'},
      ...kSpeeds.map((s) => made('option', '', {value: s}, `${Number((s * unit).toPrecision(3))}×`)));
    speed.value = '1';
    const follow = made('input', '', {type: 'checkbox', role: 'switch'});
    const bar = made('div', 'gwr-bar', {}, play, slider, made('label', '', {}, 'Speed', speed));
    if (field) bar.append(made('label', '', {}, follow, 'Follow the body'));
    const legend = made('table');
    const said = made('div', 'gwr-hidden', {'aria-live': 'polite'});
    const words = made('p', 'gwr-words');

    // Energies
    const values = {};
    const row = (key, icon, name) => {
      values[key] = made('td');
      return made('tr', '', {}, made('th', '', {scope: 'row'}, icon, name), values[key]);
    };
    const panels = kPanels.map(({title, keys}, i) => {
      const shown = keys.filter((key) => runs.every((r) => r[key]));
      const canvas = made('canvas', 'gwr-chart', {role: 'img'});
      const table = made('table', '', {}, ...shown.map((key) =>
        row(key, swatch(kSeries[key].colour, kSeries[key].dash), kSeries[key].name)));
      return {keys: shown, canvas, title, unit: units.energies[i], box: made('section', 'gwr-panel', {'aria-label': title},
        made('h3', '', {}, `${title}, ${units.energies[i].name.trim()}`), table, canvas)};
    });
    legend.append(row('left', swatch('blue', []), 'left beam'), row('right', swatch('red', []), 'right beam'),
      row('propulsion', swatch('orange', [], true), 'propulsion'), row('random', swatch('grey', [], true), 'random force'),
      row('speed', made('span', 'gwr-blank'), 'speed of the body'),
      ...(field ? [row('gate', made('span', 'gwr-blank'), 'gate (column, row)')] : []),
      ...(film.actions ? [row('action', made('span', 'gwr-blank'), 'action')] : []));
    root.append(
      made('div', 'gwr-columns', {},
        made('div', '', {}, made('div', 'gwr-status', {}, clock, mode), stageBox, bar,
          made('p', 'gwr-keys', {}, 'Keys: space plays and pauses, arrows step, page up and down move by ' + `${quantity(unit, 's', 3)}, home and end.`)),
        made('div', '', {}, made('section', 'gwr-panel', {'aria-label': 'Beams and forces'}, legend), ...panels.map((p) => p.box))),
      words, said);

    // Drawing
    const sized = (canvas, height) => {
      const dpr = window.devicePixelRatio || 1, w = canvas.clientWidth;
      const wide = Math.round(w * dpr), high = Math.round(height * dpr);
      if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
      const ctx = canvas.getContext('2d');
      ctx.setTransform(dpr, 0, 0, dpr, 0, 0);
      return [ctx, w, height];
    };
    const put = (node, text) => { if (node.textContent !== text) node.textContent = text; };
    // While a run plays, words and numbers change at most ten times a second, and a hit is named for a moment, so that
    // they can be read. At rest they are those of the step shown.
    const contactWord = (state, side) => {
      const hit = run.lastHit[side][state.i];
      return kContacts[playing && state.contact[side] === 0 && hit >= 0 && state.time - run.t[hit] < 0.1 * Number(speed.value) * unit ? 1 : state.contact[side]];
    };
    let toldAt = -Infinity;

    function stageHeight() {
      const most = Math.max(320, Math.min(0.72 * window.innerHeight, 680));
      return Math.round(Math.min(most, stageBox.clientWidth * (bounds.y1 - bounds.y0) / (bounds.x1 - bounds.x0)));
    }

    function show() {
      if (stageBox.clientWidth === 0) return;  // not laid out: hidden, or not in the page yet
      const state = stateAt(run, time), ended = time >= run.t[run.end];
      const height = stageHeight();
      stage.style.height = `${height}px`;
      drawStage(...sized(stage, height), colours, font, {film, run, bounds, follow: field && follow.checked, arrow,
        flash: kFlash * Math.max(1, Number(speed.value)) * unit}, time);
      for (const {keys, canvas, unit: joules} of panels)
        drawChart(...sized(canvas, canvas.clientHeight), colours, font, run, keys, film.scale, joules, time);
      put(clock, reading(time, units.time));
      slider.value = time / unit;
      if (playing && performance.now() - toldAt < 100) return;
      toldAt = performance.now();
      put(mode, ended ? `ended: ${run.ending}` : ['left', 'right'].map((side) => `${side} beam ${contactWord(state, side)}`).join(', '));
      mode.classList.toggle('gwr-ended', ended);
      if (!playing) slider.setAttribute('aria-valuetext', `${reading(time, units.time)}, ${mode.textContent}`);
      for (const {keys, unit: joules} of panels) for (const key of keys) put(values[key], reading(state[key], joules));
      for (const side of ['left', 'right'])
        put(values[side], `${contactWord(state, side)}, ${whole(state[side] * 180 / Math.PI)}°`);
      put(values.propulsion, reading(propulsionAt(film, run, state), units.force));
      put(values.random, reading(state.random, units.force));
      put(values.speed, reading(Math.hypot(state.vx, state.vy), units.speed));
      if (field) put(values.gate, `${whole(state.gx)}, ${state.gy}`);
      if (film.actions) put(values.action, film.actions[run.type[state.i] % film.actions.length]);
    }

    function tick(now) {
      // After the page was hidden, the run continues where it was.
      time = Math.min(run.t[run.end], time + Math.min(0.1, Math.max(0, now - last) / 1000) * Number(speed.value) * unit);
      last = now;
      if (time >= run.t[run.end]) { pause(); put(said, `Ended: ${run.ending}`); return; }
      show();
      frame = requestAnimationFrame(tick);
    }
    function start() {
      if (playing) return;
      if (time >= run.t[run.end]) time = run.t[0];
      playing = true;
      put(play, 'Pause'); put(said, '');
      last = performance.now();
      frame = requestAnimationFrame(tick);
    }
    function pause() {
      playing = false;
      cancelAnimationFrame(frame);
      put(play, 'Play');
      show();
    }
    const toggle = () => (playing ? pause() : start());
    function seek(to) {
      time = Math.max(run.t[0], Math.min(run.t[run.end], to));
      show();
    }
    function choose(index) {
      run = runs[index];
      time = run.t[0];
      slider.min = run.t[0] / unit; slider.max = run.t[run.end] / unit;  // in units: a slider keeps few digits of small numbers
      put(words, told(run, film, units));
      stage.setAttribute('aria-label', `Animation of the body among the beams. ${told(run, film, units)}`);
      panels.forEach(({canvas, title, unit: joules, keys}) => canvas.setAttribute('aria-label', `${title} over time. At the end: ` +
        keys.map((key) => `${kSeries[key].name} ${reading(run[key][run.end], joules)}`).join(', ')));
      show();
    }

    /** Handles a key; returns whether the key is one of ours. */
    function key(event) {
      if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey) return false;
      const at = event.composedPath()[0], tag = at.tagName;
      if (tag === 'SELECT') return false;
      const i = indexAt(run.t, time);
      const jumps = {ArrowRight: run.t[Math.min(i + 1, run.end)],
        ArrowLeft: time > run.t[i] ? run.t[i] : run.t[Math.max(i - 1, 0)],
        PageUp: time + unit, PageDown: time - unit, Home: run.t[0], End: run.t[run.end]};
      if (event.key === ' ' && tag !== 'BUTTON' && at.type !== 'checkbox') toggle();
      else if (event.key in jumps) { if (playing) pause(); seek(jumps[event.key]); }
      else return false;
      event.preventDefault();
      return true;
    }

    play.addEventListener('click', toggle);
    stage.addEventListener('click', toggle);
    slider.addEventListener('input', () => { if (playing) pause(); seek(Number(slider.value) * unit); });
    chooser.addEventListener('change', () => { if (playing) pause(); choose(Number(chooser.value)); });
    follow.addEventListener('change', show);
    root.addEventListener('keydown', key);
    for (const {canvas} of panels) {
      const jump = (event) => {
        const box = canvas.getBoundingClientRect();
        const part = (event.clientX - box.left - kLeft) / (box.width - kLeft - kRight);
        seek(run.t[0] + part * (run.t[run.end] - run.t[0]));
      };
      canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); jump(event); });
      canvas.addEventListener('pointermove', (event) => { if (canvas.hasPointerCapture(event.pointerId)) jump(event); });
    }

    /** Dark or light follows the surrounding `color-scheme`: the page's switch, or the system's. */
    function watchTheme(changed) {
      const system = window.matchMedia('(prefers-color-scheme: dark)');
      const look = () => {
        const scheme = getComputedStyle(host).colorScheme;
        root.classList.toggle('gwr-dark', scheme.includes('dark') && (system.matches || !scheme.includes('light')));
        changed();
      };
      system.addEventListener('change', look);
      for (const node of [document.documentElement, document.body])
        new MutationObserver(look).observe(node, {attributes: true});
      look();
    }
    watchTheme(() => {
      const style = getComputedStyle(root);
      for (const name of ['text', 'muted', 'line', 'stage', 'blue', 'red', 'orange', 'grey', 'green', 'sky', 'purple', 'disc',
        'edge', 'accent']) colours[name] = style.getPropertyValue(`--${name}`).trim();
      font = style.fontFamily;
      if (time !== undefined && slider.max) show();
    });
    choose(0);
    new ResizeObserver(show).observe(stageBox);
    // Out of sight the animation pauses.
    new IntersectionObserver(([entry]) => {
      if (entry.intersectionRatio === 0 && playing) pause();
    }, {threshold: [0, 0.5]}).observe(stage);
    return {play: start, pause, seek, key};
  };
})();
