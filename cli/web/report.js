// Draws the charts of the report into its .chart elements when they come into view, anew when the width or
// the colours change. The data stand in the page; cli/paper/page.cpp wrote all that is text.
'use strict';

(() => {
  const data = JSON.parse(document.getElementById('data').textContent);

  // Okabe and Ito's colours, adapted to either background; grey stands for what is compared with.
  const kColours = {
    blue: ['#0072b2', '#5cb8ee'], orange: ['#d55e00', '#ff8f45'], green: ['#009e73', '#3fcb9f'],
    purple: ['#a5487f', '#e29cc4'], grey: ['#8a929c', '#8d96a1'], gold: ['#b87a00', '#f0b93a'],
  };
  const kGroups = ['blue', 'orange', 'green', 'purple', 'gold', 'grey'];
  const kShares = [['#eef2f6', '#9ecae1', '#2c7fb8', '#08306b'], ['#262c34', '#1f4f7c', '#4a97d0', '#d6eeff']];

  let dark = false;
  const colour = name => kColours[name][dark ? 1 : 0];

  /// A colour of report.css as a value, for drawings that know no CSS.
  function css(name) {
    const probe = document.body.appendChild(document.createElement('i'));
    probe.style.color = `var(--${name})`;
    const value = getComputedStyle(probe).color;
    probe.remove();
    return value;
  }

  // --- Elements -----------------------------------------------------------------------------------

  function add(parent, tag, attributes = {}, text) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    return parent.appendChild(element);
  }

  /// A row of choices, one of which holds; calls `changed` with it. Answers nothing where there is no choice.
  let choices = 0;
  function choice(parent, legend, options, changed) {
    if (options.length < 2) return;
    const set = add(parent, 'fieldset');
    add(set, 'legend', {}, legend);
    const row = add(set, 'div', {class: 'segments'});
    const name = `choice-${++choices}`;
    options.forEach(([value, label], i) => {
      const box = add(row, 'label');
      const input = add(box, 'input', {type: 'radio', name});
      input.checked = i === 0;
      input.addEventListener('change', () => changed(value));
      add(box, 'span', {}, label);
    });
  }

  const kSymbols = {
    line: c => `<path d="M0 6h22" stroke="${c}" stroke-width="2.5"/>`,
    dash: c => `<path d="M0 6h22" stroke="${c}" stroke-width="2.5" stroke-dasharray="5 3"/>`,
    dot: c => `<circle cx="11" cy="6" r="5" fill="${c}"/>`,
    bar: c => `<rect x="3" width="16" height="12" fill="${c}"/>`,
    diamond: c => `<path d="M11 0l6 6-6 6-6-6z" fill="none" stroke="${c}" stroke-width="2"/>`,
    tick: c => `<path d="M11 0v12" stroke="${c}" stroke-width="3"/>`,
  };
  function keys(list, entries) {
    list.replaceChildren();
    for (const [symbol, c, label] of entries) {
      const item = add(list, 'li');
      if (symbol) item.innerHTML = `<svg width="22" height="12" aria-hidden="true">${kSymbols[symbol](c)}</svg>`;
      item.append(label);
    }
  }

  /// Starts a script library that the page carries as text, once.
  function library(...names) {
    for (const name of names) {
      const source = document.getElementById(name);
      if (!source) continue;
      add(document.head, 'script', {}, source.textContent);
      source.remove();
    }
  }

  // --- Drawings -----------------------------------------------------------------------------------

  // A drawing is made by `make(width)`: {spec, keys} for Vega-Lite, {traces, camera, ...} in 3D. It is stale
  // until drawn as things are now; in view, stale ones are drawn at once.
  const drawings = [];

  function drawing(chart, {title, note, height, three, wide, make}) {
    const plot = add(chart.plots, 'div', {class: wide ? 'plot wide' : 'plot'});
    if (title) add(plot, 'h3', {}, title);
    const list = add(plot, 'ul', {class: 'keys'});
    const box = add(plot, 'div', {class: three ? 'drawing three' : 'drawing', role: 'img',
      'aria-label': title ?? chart.alt, style: `min-height: ${height}px`});
    if (note) add(plot, 'p', {class: 'note'}, note);
    const one = {box, list, height, three, make, stale: true, seen: false, turn: 0};
    box.drawing = one;
    drawings.push(one);
    chart.drawings.push(one);
    observer.observe(box);
    return one;
  }

  function renew(some) {
    for (const one of some) {
      one.stale = true;
      if (one.seen) draw(one);
    }
  }

  async function draw(one) {
    one.stale = false;
    const turn = ++one.turn;  // a newer drawing takes over
    const width = Math.floor(one.box.clientWidth);
    if (width === 0) return;
    one.width = width;
    const made = one.make(width);
    keys(one.list, made.keys ?? []);
    if (one.three) {
      draw3d(one, made, width);
    } else {
      library('vega.min.js', 'vega-lite.min.js', 'vega-embed.min.js');
      const place = document.createElement('div');
      const result = await vegaEmbed(place, {
        $schema: 'https://vega.github.io/schema/vega-lite/v6.json',  // a name, never fetched
        background: null, width, height: made.height ?? one.height, autosize: {type: 'fit', contains: 'padding'}, config: look(), ...made.spec,
      }, {actions: false, renderer: 'svg', defaultStyle: false, tooltip: {disableDefaultStyle: true}});
      if (turn !== one.turn) return result.finalize();
      one.finalize?.();
      one.finalize = () => result.finalize();
      one.box.replaceChildren(place);
    }
    one.box.dataset.drawn = '';
  }

  const observer = new IntersectionObserver(entries => {
    for (const {target, isIntersecting} of entries) {
      const one = target.drawing;
      one.seen = isIntersecting;
      if (isIntersecting && one.stale) draw(one);
      // Browsers keep only some 8 to 16 drawings in 3D: those out of sight make room.
      if (!isIntersecting && one.three && !one.stale) {
        delete one.box.dataset.drawn;
        one.stale = true;
        one.plotted.then(() => one.seen || Plotly.purge(one.box));  // not while it is being drawn
      }
    }
  }, {rootMargin: '300px 0px'});

  function look() {
    const ink = css('ink'), muted = css('muted'), line = css('line');
    const font = getComputedStyle(document.body).fontFamily;
    return {
      font, padding: 2, view: {stroke: null},
      axis: {labelColor: muted, titleColor: muted, labelFontSize: 13, titleFontSize: 13, titleFontWeight: 'normal',
        gridColor: line, domainColor: line, tickColor: line, labelPadding: 5, labelFlush: false, titlePadding: 9, labelLimit: 300},
      text: {color: ink, font, fontSize: 13}, rule: {color: muted}, line: {strokeWidth: 2.2}, point: {filled: true, size: 60},
    };
  }

  /// n colours in order, from dark to bright or, on a dark ground, the other way to be seen.
  const sequence = n => ramp('viridis', ...(dark ? [0.3, 1] : [0, 0.82]), n);
  function ramp(name, low, high, n) {
    library('vega.min.js');
    return Array.from({length: n}, (_, i) => vega.scheme(name)(n < 2 ? low : low + (high - low) * i / (n - 1)));
  }

  const distinct = (rows, field) => [...new Set(rows.map(r => r[field]))].sort((a, b) => a - b);
  const percent = (x, digits = 1) => x === null ? '–' : `${(100 * x).toFixed(digits)} %`;
  const interval = r => r.low === null || r.low === undefined ? '' : `[${percent(r.low)}, ${percent(r.high)}]`;
  const three = x => Number(x.toPrecision(3)).toString();
  const tip = (field, title) => ({field, title, type: 'nominal'});

  function seconds_text(s) {
    for (const [from, unit, size = from] of [[31557600, 'years'], [10 * 86400, 'days', 86400], [3600, 'h'], [60, 'min'], [1, 's'], [1e-3, 'ms']]) {
      if (s >= from) return `${three(s / size)} ${unit}`;
    }
    return `${three(s * 1e6)} µs`;
  }

  /// Cells with their numbers in them. rows: {x, y, value, text, pale (says little), ...tooltip fields}.
  function heat(rows, {x, y, range, domain, bright, tooltip, width, descending = true, size = 13}) {
    const limit = domain[0] + bright.from * (domain[1] - domain[0]);
    return {
      data: {values: rows},
      encoding: {
        x: {field: 'x', type: 'ordinal', title: x, axis: {labelAngle: 0, ticks: false, domain: false, labelOverlap: true}},
        y: {field: 'y', type: 'ordinal', title: y, sort: descending ? 'descending' : 'ascending', axis: {ticks: false, domain: false}},
        tooltip,
      },
      layer: [
        {mark: {type: 'rect', stroke: css('card'), strokeWidth: width < 420 ? 1 : 2},
          encoding: {color: {field: 'value', type: 'quantitative', scale: {range, domain, clamp: true}, legend: null},
            opacity: {condition: {test: 'datum.pale', value: 0.3}, value: 1}}},
        {mark: {type: 'text', fontSize: size},
          encoding: {text: {field: 'text'},
            color: {condition: [{test: 'datum.value === null || datum.pale', value: css('ink')}, {test: `datum.value > ${limit}`, value: bright.above}],
              value: bright.below}}},
      ],
    };
  }
  const sharesLook = () => ({range: kShares[dark ? 1 : 0],
    bright: dark ? {from: 0.62, above: '#0b1a2b', below: '#e6edf5'} : {from: 0.5, above: '#ffffff', below: '#1c2127'}});

  /// Lines with 95 % bands, one per value of `by`.
  function bands(rows, {x, xTitle, by, byTitle, tooltip}) {
    const values = distinct(rows, by), colours = sequence(values.length);
    return {
      keys: [[null, null, byTitle], ...values.map((v, i) => ['line', colours[i], `${v} N`])],
      spec: {
        data: {values: rows},
        encoding: {
          x: {field: x, type: 'quantitative', title: xTitle, axis: {grid: false, values: distinct(rows, x)}, scale: {zero: false}},
          color: {field: by, type: 'ordinal', scale: {domain: values, range: colours}, legend: null},
        },
        layer: [
          {mark: {type: 'area', opacity: 0.16}, encoding: {y: {field: 'low', type: 'quantitative', title: 'traversed, % of trials',
            axis: {labelExpr: 'round(100*datum.value)', tickCount: 5}, scale: {domain: [0, 1]}}, y2: {field: 'high'}}},
          {mark: {type: 'line', point: {size: 45, filled: true}}, encoding: {y: {field: 'traversed', type: 'quantitative'}}},
          {mark: {type: 'point', size: 300, opacity: 0}, encoding: {y: {field: 'traversed', type: 'quantitative'}, tooltip}},
        ],
      },
    };
  }

  // --- 3D -----------------------------------------------------------------------------------------

  const kCameras = {
    slanted: {eye: {x: -1.0, y: -1.4, z: 0.95}, center: {x: 0, y: 0, z: -0.16}},
    above: {eye: {x: 0, y: -0.01, z: 1.3}, projection: {type: 'orthographic'}},
    side: {eye: {x: -1.8, y: 0, z: 0.2}, center: {x: 0, y: 0, z: -0.08}},
    front: {eye: {x: 0, y: -1.8, z: 0.3}, center: {x: 0, y: 0, z: -0.08}},
  };

  /// The camera, farther away where there is little width for the axes' names.
  function from(name, width) {
    const {eye, ...rest} = kCameras[name], far = width < 440 ? 1.12 : 1;
    return {eye: {x: eye.x * far, y: eye.y * far, z: eye.z * far}, up: {x: 0, y: 0, z: 1}, ...rest};
  }

  function draw3d(one, {traces, camera}, width) {
    library('plotly-gl3d.min.js');
    const ink = css('ink'), line = css('line'), height = Math.min(one.height, Math.round(0.95 * width));
    one.box.style.minHeight = `${height}px`;
    const axis = (title, more) => ({title: {text: title, font: {size: 13}}, color: ink, gridcolor: line, zerolinecolor: line,
      showbackground: false, tickfont: {size: 12}, showspikes: false, ...more});
    const flat = camera === 'above', size = flat ? 1.35 : 1;  // without perspective, the size is that of the box itself
    const layout = {
      width, height, margin: {l: 0, r: 0, t: 0, b: 0}, showlegend: false, paper_bgcolor: 'rgba(0,0,0,0)',
      font: {family: getComputedStyle(document.body).fontFamily, color: ink, size: 13},
      hoverlabel: {bgcolor: css('card'), bordercolor: line, font: {color: ink, size: 14}},
      scene: {
        xaxis: axis('x (m)', {nticks: 6, ...(flat ? {tickangle: 0} : {})}), yaxis: axis('y (m)', {nticks: 7}),
        zaxis: axis(flat || width < 440 ? '' : 'energy (J)', {nticks: 5, showticklabels: !flat, ticksuffix: width < 440 ? ' J' : ''}),
        aspectmode: 'manual', aspectratio: {x: size, y: 1.2 * size, z: 0.6 * size}, camera: from(camera, width), dragmode: 'turntable',
      },
    };
    one.plotted = Plotly.react(one.box, traces, layout, {displayModeBar: false, scrollZoom: true});
  }

  // Wheel and fingers move the page; a drawing in 3D takes them only after a click or a tap into it.
  const in3d = event => event.target.closest?.('.three')?.drawing;
  for (const type of ['wheel', 'touchstart', 'touchmove', 'touchend']) {
    addEventListener(type, event => {
      const one = in3d(event);
      if (one && !one.held) event.stopPropagation();
    }, {capture: true, passive: true});
  }
  for (const type of ['pointerdown', 'click']) {
    addEventListener(type, event => {
      const hit = in3d(event), asked = type === 'click' || event.pointerType === 'mouse';
      for (const one of drawings) {
        one.held = one === hit && (one.held || asked);
        one.box.classList.toggle('held', one.held);
      }
    }, true);
  }

  /// The energy landscape, cut at `ceiling` to be seen (the numbers shown are the true ones), with lines every 5 m.
  function surface({x, y, z}, {ceiling, opacity = 1, scale = false, colours} = {}) {
    const cut = v => v === null ? null : Math.min(v, ceiling ?? Infinity);
    const shown = z.map(row => row.map(cut));
    const lines = {x: [], y: [], z: []};
    const line = points => {
      for (const [i, j] of points) for (const [to, v] of [[lines.x, x[i]], [lines.y, y[j]], [lines.z, shown[j][i]]]) to.push(v);
      for (const to of Object.values(lines)) to.push(null);
    };
    const every5m = places => [...places.keys()].filter(i => Math.floor(places[i] / 5 + 1e-9) !== Math.floor((places[i - 1] ?? -1e9) / 5 + 1e-9));
    for (const j of every5m(y)) line([...x.keys()].map(i => [i, j]));
    for (const i of every5m(x)) line([...y.keys()].map(j => [i, j]));
    return [{
      type: 'surface', x, y, z: shown, text: z.map(row => row.map(v => v === null ? '' : v.toFixed(0))),
      hovertemplate: 'x %{x:.1f} m, y %{y:.1f} m<br>%{text} J<extra></extra>', opacity, showscale: scale,
      colorbar: {thickness: 12, len: 0.8, title: {text: 'J', side: 'top'}, outlinewidth: 0},
      colorscale: colours ?? 'Viridis', lighting: {ambient: 0.72, diffuse: 0.5, specular: 0.04, roughness: 0.9},
      contours: Object.fromEntries(['x', 'y', 'z'].map(axis => [axis, {highlight: false}])),
    }, {type: 'scatter3d', mode: 'lines', ...lines, hoverinfo: 'skip', line: {width: 1, color: colours ? (dark ? '#717a86' : '#a3aab2') : '#8a93a5'}}];
  }
  const faint = () => dark ? [[0, '#2a3038'], [1, '#8b96a3']] : [[0, '#eceae6'], [1, '#9aa1a9']];

  /// Buttons for where to look from, for all drawings of a chart that keep no view of their own.
  function views(chart, state) {
    choice(chart.controls, 'Seen', [['slanted', 'slanted'], ['above', 'from above'], ['side', 'from the left'], ['front', 'from the start']],
      v => { state.camera = v; renew(chart.drawings); });
    add(chart.box, 'p', {class: 'remark'}, 'Drag to turn; after a click the wheel zooms. On a phone, tap a drawing before you turn it.');
  }

  // --- The kinds of charts ------------------------------------------------------------------------

  const kinds = {};

  kinds.outcomes = (chart, {rows}) => {
    const dampings = distinct(rows, 'damping').reverse();
    let damping = dampings[0];
    choice(chart.controls, 'Beam damping', dampings.map(d => [d, `${d} N·m·s/rad`]), v => { damping = v; renew(chart.drawings); });
    const now = () => rows.filter(r => r.damping === damping).map(r => ({...r, x: r.propulsion, y: r.random, value: r.traversed,
      text: `${Math.round(100 * r.traversed)}`, Traversed: `${percent(r.traversed)} ${interval(r)}`, Left: percent(r.exited),
      Stuck: percent(r.trapped)}));
    const tooltip = [tip('propulsion', 'Propulsive force, N'), tip('random', 'Random force, N'), tip('Traversed', 'Traversed, 95 %'),
      tip('Left', 'Left sideways'), tip('Stuck', 'Stuck'), tip('trials', 'Trials')];
    drawing(chart, {title: 'Traversed, % of trials', height: 330,
      make: width => ({spec: heat(now(), {x: 'propulsive force (N)', y: 'random force (N)', domain: [0, 1], ...sharesLook(), tooltip, width})})});
    drawing(chart, {title: 'More propulsion', height: 310, make: () => bands(now(), {x: 'propulsion', xTitle: 'propulsive force (N)',
      by: 'random', byTitle: 'random force', tooltip})});
    drawing(chart, {title: 'More random force', height: 310, make: () => bands(now(), {x: 'random', xTitle: 'random force (N)',
      by: 'propulsion', byTitle: 'propulsive force', tooltip})});
  };

  kinds.right_share = (chart, {rows}) => {
    chart.least = 400;
    const dampings = distinct(rows, 'damping').reverse();
    let damping = dampings[0];
    choice(chart.controls, 'Beam damping', dampings.map(d => [d, `${d} N·m·s/rad`]), v => { damping = v; renew(chart.drawings); });
    const few = r => r.successes < 10;
    const high = Math.max(0.5, ...rows.filter(r => !few(r)).map(r => r.right ?? 0));
    for (const propulsion of distinct(rows, 'propulsion')) {
      drawing(chart, {title: `Propulsive force ${propulsion} N: right, % of those that traversed`, height: 330,
        note: 'Darker: fewer on the right. Pale: fewer than 10 traversed, so chance decides; how many of them on the right. –: none traversed.',
        make: width => ({spec: heat(rows.filter(r => r.damping === damping && r.propulsion === propulsion).map(r => ({...r,
          x: r.k_left, y: r.random, value: r.right, pale: few(r), text: r.right === null ? '–' : few(r) ? `${Math.round(r.right * r.successes)}/${r.successes}` : `${Math.round(100 * r.right)}`,
          Right: r.right === null ? 'none traversed' : `${percent(r.right)} ${interval(r)}`, Of: `${r.successes} of ${r.trials} trials`})),
        {x: 'left beam stiffness (N·m/rad)', y: 'random force (N)', range: ramp('viridis', 0, 1, 9), domain: [0, high],
          bright: {from: 0.6, above: '#111111', below: '#ffffff'}, width,
          tooltip: [tip('k_left', 'Left stiffness, N·m/rad'), tip('random', 'Random force, N'), tip('Right', 'Right, 95 %'),
            tip('Of', 'Traversed')]})})});
    }
  };

  kinds.landscapes = (chart, {panels, ceiling}) => {
    chart.least = 420;
    const state = {camera: 'slanted'};
    views(chart, state);
    for (const panel of panels) {
      const above = panel.name === 'B';  // the paper's B is A from above
      drawing(chart, {title: `${panel.name}: ${panel.title}`, height: 400, three: true, make: () => ({
        traces: surface(panel, {ceiling, scale: above}), camera: above ? 'above' : state.camera})});
    }
  };

  kinds.barriers = (chart, {rows}) => {
    let field = 'above_basin_J';
    choice(chart.controls, 'Barrier above', [['above_basin_J', 'the basin before the beams'], ['above_start_J', 'the start']],
      v => { field = v; renew(chart.drawings); });
    const dampings = distinct(rows, 'damping').reverse();
    drawing(chart, {height: 380, make: width => {
      const colours = dampings.map((_, i) => colour(kGroups[i]));
      const values = rows.filter(r => r[field] !== null).map(r => ({...r, barrier: r[field], name: `${r.k_left}`,
        Barrier: `${three(r[field])} J`, Traversed: `${percent(r.traversed)} ${interval(r)}`}));
      const y = {field: 'traversed', type: 'quantitative', title: 'traversed, % of trials',
        axis: {labelExpr: 'round(100*datum.value)', tickCount: 5}, scale: {domain: [0, 1]}};
      const tooltip = [tip('k_left', 'Left stiffness, N·m/rad'), tip('damping', 'Damping, N·m·s/rad'), tip('Barrier', 'Barrier'),
        tip('Traversed', 'Traversed, 95 %')];
      return {
        keys: dampings.map((d, i) => ['line', colours[i], `damping ${d} N·m·s/rad`]),
        spec: {
          data: {values},
          encoding: {
            x: {field: 'barrier', type: 'quantitative', title: `highest point of the lowest way, above ${field === 'above_start_J' ? 'the start' : 'the basin'} (J)`, axis: {grid: false, tickCount: Math.min(10, Math.floor(width / 60))}, scale: {zero: false, nice: true}},
            color: {field: 'damping', type: 'ordinal', scale: {domain: dampings, range: colours}, legend: null},
          },
          layer: [
            {mark: {type: 'line', opacity: 0.45}, encoding: {y}},
            {mark: {type: 'rule', strokeWidth: 2}, encoding: {y: {field: 'low', type: 'quantitative'}, y2: {field: 'high'}}},
            {mark: {type: 'point', size: 80, opacity: 1}, encoding: {y, tooltip}},
            ...haloed({transform: [{filter: `datum.damping == ${dampings[0]}`}], mark: {type: 'text', dy: -10, dx: 7, align: 'left', fontSize: 12},
              encoding: {y, text: {field: 'name'}, color: {value: css('muted')}}}),
          ],
        },
      };
    }, note: 'Numbers at the points: stiffness of the left beam, N·m/rad.'});
  };

  kinds.penetration = (chart, d) => {
    chart.least = 420;
    const lines = [['landscape', 'landscape, both beams', 'grey', 'dash'], ['landscape_right', 'landscape, right beam alone', 'green', 'dash'],
      ['potential', 'of the system', 'blue', 'line']];
    const stride = Math.ceil(d.t.length / 1000);
    const values = d.t.map((t, i) => ({t, potential: d.potential[i], landscape: d.landscape[i], landscape_right: d.landscape_right[i],
      top: Math.max(d.potential[i], d.landscape[i])})).filter((_, i) => i % stride === 0);
    const state = {camera: 'slanted'};
    views(chart, state);
    drawing(chart, {title: 'Potential energy against time', height: 330, wide: true,
      note: 'Shaded: the system lies below the landscape of both beams, its trajectory penetrates the surface.', make: width => ({
        keys: lines.map(([, label, c, symbol]) => [symbol, colour(c), label]),
        spec: {
          data: {values},
          encoding: {x: {field: 't', type: 'quantitative', title: 'time (s)', axis: {grid: false, tickCount: Math.floor(width / 90)}, scale: {nice: false}}},
          layer: [
            {mark: {type: 'area', opacity: 0.25, color: colour('orange')}, encoding: {y: {field: 'potential', type: 'quantitative',
              title: 'energy (J)'}, y2: {field: 'top'}}},
            ...lines.map(([field, , c, symbol]) => ({mark: {type: 'line', color: colour(c), ...(symbol === 'dash' ? {strokeDash: [6, 4]} : {})},
              encoding: {y: {field, type: 'quantitative'}}})),
            {params: [{name: 'near', select: {type: 'point', on: 'pointerover', nearest: true, encodings: ['x'], clear: 'pointerout'}}],
              mark: {type: 'rule', color: css('muted')},
              encoding: {opacity: {condition: {param: 'near', empty: false, value: 0.7}, value: 0},
                tooltip: [{field: 't', title: 'Time, s', format: '.2f'},
                  ...lines.map(([field, label]) => ({field, title: `${label}, J`, format: '.1f'}))]}},
          ],
        },
      })});
    for (const one of d.surfaces) {
      drawing(chart, {title: one.title, height: 400, three: true, make: () => ({
        traces: [...surface(one, {ceiling: d.ceiling, opacity: 0.85, colours: faint()}), path(d.x, d.y, d.potential, colour('blue'), 'the system')],
        camera: state.camera})});
    }
  };

  const path = (x, y, z, c, name) => ({type: 'scatter3d', mode: 'lines', x, y, z, name, line: {width: 5, color: c},
    hovertemplate: `${name}<br>x %{x:.1f} m, y %{y:.1f} m<br>%{z:.0f} J<extra></extra>`});

  kinds.trajectories = (chart, {panels, ceiling}) => {
    chart.least = 320;
    const state = {camera: 'slanted'};
    views(chart, state);
    for (const panel of panels) {
      // The runs of a side are one line with gaps.
      const joined = (side, field) => panel.runs.filter(r => r.side === side).flatMap(r => [...r[field], null]);
      const of = (side, c) => path(joined(side, 'x'), joined(side, 'y'), joined(side, 'e').map(e => e === null ? null : Math.min(e, ceiling ?? e)),
        c, side);
      drawing(chart, {title: panel.title, height: 360, three: true, note: `Traversed left ${panel.left}, right ${panel.right}.`, make: () => ({
        keys: [['line', colour('blue'), 'left'], ['line', colour('orange'), 'right']],
        traces: [...surface(panel, {ceiling, opacity: 0.85, colours: faint()}),
          ...[of('left', colour('blue')), of('right', colour('orange'))].map(t => panel.runs.length > 20 ?
            {...t, opacity: 0.6, line: {...t.line, width: 1.5}} : {...t, line: {...t.line, width: 3}})],
        camera: state.camera})});
    }
  };

  kinds.final_gates = (chart, {starts}) => {
    chart.least = 340;
    let start = starts[0];
    choice(chart.controls, 'Start', starts.map(s => [s, s.label]), v => { start = v; renew(chart.drawings); });
    const cells = () => start.dynamics.flatMap((row, iy) => row.map((share, ix) => {
      const left = ix - (row.length - 1) / 2;
      return {x: left, y: iy, dynamics: share, chain: start.chain[iy][ix], gate: `(${left}, ${iy})`, Dynamics: percent(share, 2),
        Chain: percent(start.chain[iy][ix], 2)};
    }));
    const tooltip = [tip('gate', 'Gate (i_x, i_y)'), tip('Dynamics', 'Full dynamics'), tip('Chain', 'Markov chain')];
    for (const [field, title] of [['chain', 'Markov chain'], ['dynamics', 'Full dynamics']]) {
      drawing(chart, {title: `${title}: ended here, % of trials`, height: 400, make: width => {
        const all = cells();
        const most = Math.max(...all.flatMap(c => [c.dynamics, c.chain]));
        return {spec: heat(all.map(c => ({...c, value: c[field], text: c[field] < 0.0005 ? '' : (100 * c[field]).toFixed(1)})),
          {x: 'i_x', y: 'i_y', domain: [0, most], ...sharesLook(), tooltip, width, size: 12})};
      }});
    }
    drawing(chart, {title: 'Gate by gate, most frequent first', height: 320, wide: true, make: width => {
      const some = cells().sort((a, b) => b.dynamics - a.dynamics).slice(0, Math.max(10, Math.min(40, Math.floor((width - 60) / 20))));
      const x = {field: 'gate', type: 'nominal', sort: null, title: 'gate (i_x, i_y)', axis: {labelAngle: -90, labelFontSize: 12, ticks: false}};
      return {
        keys: [['bar', dark ? '#4b5563' : '#c9ced5', 'full dynamics'], ['dot', colour('orange'), 'Markov chain']],
        spec: {
          data: {values: some}, encoding: {x, tooltip},
          layer: [
            {mark: {type: 'bar', color: dark ? '#4b5563' : '#c9ced5'}, encoding: {y: {field: 'dynamics', type: 'quantitative',
              title: 'ended here, % of trials', axis: {labelExpr: 'format(100*datum.value, ".3~g")', tickCount: 6}}}},
            {mark: {type: 'point', color: colour('orange'), size: 60, opacity: 1}, encoding: {y: {field: 'chain', type: 'quantitative'}}},
          ],
        },
      };
    }});
  };

  kinds.table4 = (chart, {rows}) => {
    for (const [field, title, better] of [['corrcoef', 'Correlation coefficient', 'right is better'], ['rmse', 'RMSE, trials per 100', 'left is better']]) {
      const values = rows.map((r, i) => ({i, label: r.start, paper: r[`paper_${field}`], ours: r[field], floor: r[`${field}_floor`],
        low: r[field] - r[`${field}_sd`], high: r[field] + r[`${field}_sd`],
        Ours: `${r[field].toFixed(3)} ± ${r[`${field}_sd`].toFixed(3)}`}));
      const spot = (f, yOffset, mark) => ({mark: {yOffset, opacity: 1, ...mark}, encoding: {x: {field: f, type: 'quantitative'},
        tooltip: [tip('label', 'Start'), tip('paper', 'Paper'), tip('Ours', 'Here ± sd'), {field: 'floor', title: 'Noise floor', format: '.3f'}]}});
      drawing(chart, {title: `${title} (${better})`, height: 70 + 48 * rows.length, make: width => ({
        keys: [['diamond', css('ink'), 'paper'], ['dot', colour('blue'), 'here ± sd'], ['tick', colour('grey'), 'noise floor']],
        ...lanes(values, {x: {title: title.replace('Corr', 'corr'), scale: {zero: false}}, width, label: 'label', marks: below => [
          {mark: {type: 'rule', yOffset: below, strokeWidth: 2.5, color: colour('blue')}, encoding: {x: {field: 'low', type: 'quantitative'}, x2: {field: 'high'}}},
          spot('floor', below, {type: 'tick', color: colour('grey'), thickness: 3, size: 20}),
          spot('ours', below, {type: 'point', color: colour('blue'), size: 90}),
          spot('paper', below, {type: 'point', shape: 'diamond', filled: false, color: css('ink'), size: 110, strokeWidth: 2}),
        ]}),
      })});
    }
  };

  /// Text that lines pass behind.
  const haloed = layer => [
    {...layer, mark: {...layer.mark, stroke: css('card'), strokeWidth: 5, strokeJoin: 'round', color: css('card')},
      encoding: {...layer.encoding, color: {value: css('card')}}}, layer];

  /// Rows with their name above, so that long names need no room at the side, and a value: at the right, or below the
  /// name where there is little width. `marks` puts the marks `below` pixels below the middle of a row.
  function lanes(values, {x, width, label, value, marks}) {
    const narrow = value && width < 620, below = narrow ? 18 : 9;
    const y = {field: 'i', type: 'ordinal', axis: null, scale: {paddingInner: 0, paddingOuter: 0.1}};
    const text = (field, right, yOffset, more) => haloed({mark: {type: 'text', baseline: 'bottom', yOffset, align: right ? 'right' : 'left',
      limit: width - (value && !narrow ? 190 : 12), ...more}, encoding: {text: {field}, x: {value: right ? 'width' : 2}}});
    return {
      height: 70 + (narrow ? 62 : 48) * values.length,
      spec: {
        data: {values},
        encoding: {y, x: {type: 'quantitative', axis: {grid: true, tickCount: Math.max(3, Math.floor(width / 110)), ...x.axis}, title: x.title, scale: x.scale ?? {}}},
        layer: [
          {mark: {type: 'rule', yOffset: below, color: css('line')}, encoding: {x: {value: 0}, x2: {value: 'width'}}},
          ...marks(below), ...text(label, false, narrow ? -10 : -2), ...(value ? text(value, !narrow, narrow ? 8 : -2, {fontWeight: 600}) : []),
        ],
      },
    };
  }

  const groups_of = rows => [...new Set(rows.map(r => r.group ?? ''))];
  const by_group = groups => ({field: 'group', type: 'nominal', legend: null,
    scale: {domain: groups, range: groups.map((_, i) => colour(kGroups[i % kGroups.length]))}});
  const group_keys = groups => groups.length < 2 ? [] : groups.map((g, i) => ['dot', by_group(groups).scale.range[i], g]);

  kinds.rates = (chart, {rows, marks = [], unit}) => {
    const share = unit === 'share';
    const show = v => share ? percent(v) : three(v);
    const groups = groups_of(rows);
    const values = rows.map((r, i) => ({...r, i, group: r.group ?? '',
      number: show(r.value) + (r.low === null || r.low === undefined ? '' : share ?
        ` [${(100 * r.low).toFixed(1)}, ${(100 * r.high).toFixed(1)}]` : ` [${three(r.low)}, ${three(r.high)}]`)}));
    if (rows.length > 14) return many_rates(chart, values, groups, marks, share);
    drawing(chart, {height: 70 + 48 * rows.length, make: width => {
      const c = by_group(groups);
      const of_mark = m => groups.includes(m.group) ? c.scale.range[groups.indexOf(m.group)] : css('muted');
      const tooltip = [tip('label', ' '), tip('number', 'Value, 95 %')];
      return {
        keys: [...group_keys(groups), ...marks.map(m => ['dash', of_mark(m), m.label])],
        ...lanes(values, {width, label: 'label', value: 'number', x: {title: share ? '%' : unit,
          axis: share ? {labelExpr: 'format(100*datum.value, ".3~g")'} : {}, scale: {zero: true}}, marks: below => [
          ...marks.map(m => ({data: {values: [m]}, mark: {type: 'rule', strokeDash: [5, 4], strokeWidth: 2, color: of_mark(m)},
            encoding: {x: {field: 'value', type: 'quantitative'}, y: null, tooltip: [tip('label', ' ')]}})),
          {mark: {type: 'rule', yOffset: below, strokeWidth: 2.5}, encoding: {x: {field: 'low', type: 'quantitative'}, x2: {field: 'high'}, color: c, tooltip}},
          {mark: {type: 'point', yOffset: below, size: 90, opacity: 1}, encoding: {x: {field: 'value', type: 'quantitative'}, color: c, tooltip}},
        ]}),
      };
    }});
  };

  /// Too many rows to give each two lines: names at the side, groups below their headings, values to hover for.
  function many_rates(chart, values, groups, marks, share) {
    const lines = groups.flatMap((g, i) => [{key: `g${i}|${g}`}, ...values.filter(r => r.group === g).map(r => ({...r, key: `r${r.i}|${r.label}`}))]);
    drawing(chart, {height: 70 + 22 * lines.length, make: width => ({
      keys: marks.map(m => ['dash', css('muted'), m.label]),
      spec: {
        data: {values: lines},
        encoding: {
          y: {field: 'key', type: 'nominal', sort: null, scale: {domain: lines.map(r => r.key)}, axis: {title: null, domain: false, ticks: false, grid: true,
            labelExpr: "slice(datum.label, indexof(datum.label, '|') + 1)", labelLimit: width / 2, labelPadding: 10,
            labelFontWeight: {condition: {test: "datum.label[0] == 'g'", value: 'bold'}, value: 'normal'},
            labelColor: {condition: {test: "datum.label[0] == 'g'", value: css('ink')}, value: css('muted')}}},
          tooltip: [tip('group', 'Varied'), tip('label', 'Value'), tip('number', 'Share, 95 %')],
        },
        layer: [
          ...marks.map(m => ({data: {values: [m]}, mark: {type: 'rule', strokeDash: [5, 4], strokeWidth: 2},
            encoding: {x: {field: 'value', type: 'quantitative'}, y: null, tooltip: [tip('label', ' ')]}})),
          {mark: {type: 'rule', strokeWidth: 2.5, color: colour('blue')}, encoding: {x: {field: 'low', type: 'quantitative', title: share ? '%' : null,
            axis: {orient: 'bottom', tickCount: 6, ...(share ? {labelExpr: 'format(100*datum.value, ".3~g")'} : {})}}, x2: {field: 'high'}}},
          {mark: {type: 'point', size: 70, opacity: 1, color: colour('blue')}, encoding: {x: {field: 'value', type: 'quantitative'}}},
        ],
      },
    })});
  }

  kinds.speed = (chart, {rows}) => {
    const groups = groups_of(rows);
    const values = rows.map((r, i) => ({...r, i, group: r.group ?? '', number: seconds_text(r.seconds)}));
    drawing(chart, {height: 70 + 48 * rows.length, make: width => ({keys: group_keys(groups), ...lanes(values, {width, label: 'label', value: 'number',
      x: {title: 'time (logarithmic)', scale: {type: 'log'}, axis: {values: [1e-6, 1e-3, 1, 60, 3600, 86400, 31557600],
        labelExpr: '{"0.000001": "1 µs", "0.001": "1 ms", "1": "1 s", "60": "1 min", "3600": "1 h", "86400": "1 day", "31557600": "1 year"}[datum.value]'}},
      marks: below => [{mark: {type: 'point', yOffset: below, size: 100, opacity: 1},
        encoding: {x: {field: 'seconds', type: 'quantitative'}, color: by_group(groups), tooltip: [tip('label', ' '), tip('number', 'Time')]}}]})})});
  };

  kinds.histogram = (chart, {rows, marks = [], axis = ''}) => {
    drawing(chart, {height: 320, make: () => ({
      keys: marks.map((m, i) => ['dash', colour(kGroups[(i + 1) % kGroups.length]), m.label]),
      spec: {
        data: {values: rows.map(r => ({...r, Range: `${three(r.from)} to ${three(r.to)}`, Share: percent(r.share, 2)}))},
        layer: [
          {mark: {type: 'bar', color: colour('blue'), opacity: 0.85, stroke: css('card'), strokeWidth: 1}, encoding: {
            x: {field: 'from', type: 'quantitative', title: axis, axis: {grid: false}, bin: {binned: true}}, x2: {field: 'to'},
            y: {field: 'share', type: 'quantitative', title: '%', axis: {labelExpr: 'format(100*datum.value, ".3~g")'}},
            tooltip: [tip('Range', 'From, to'), tip('Share', 'Share')]}},
          ...marks.map((m, i) => ({data: {values: [m]}, mark: {type: 'rule', strokeDash: [6, 4], strokeWidth: 2.5, color: colour(kGroups[(i + 1) % kGroups.length])},
            encoding: {x: {field: 'value', type: 'quantitative'}, tooltip: [tip('label', ' '), tip('value', 'At')]}})),
        ],
      },
    })});
  };

  kinds.replay = (chart, {film}) => {
    const box = add(chart.plots, 'div', {class: 'replay', style: 'min-height: 480px'});
    new IntersectionObserver((entries, self) => {
      if (!entries.some(e => e.isIntersecting)) return;
      self.disconnect();
      gatewalkReplay(box, film);
      box.style.minHeight = '';
      box.dataset.drawn = '';
    }, {rootMargin: '300px 0px'}).observe(box);
  };

  // --- The page -----------------------------------------------------------------------------------

  const root = document.documentElement;
  const system = matchMedia('(prefers-color-scheme: dark)');
  const button = document.getElementById('theme');
  function show_theme() {
    dark = root.dataset.theme ? root.dataset.theme === 'dark' : system.matches;
    button.textContent = dark ? 'Light page' : 'Dark page';
  }
  button.hidden = false;
  button.addEventListener('click', () => {
    root.dataset.theme = dark ? 'light' : 'dark';
    show_theme();
    renew(drawings);
  });
  system.addEventListener('change', () => {
    show_theme();
    renew(drawings);
  });
  show_theme();

  for (const box of document.querySelectorAll('.chart')) {
    const chart = {box, alt: box.dataset.alt, drawings: [], controls: add(box, 'div', {class: 'controls'}),
      plots: add(box, 'div', {class: 'plots', role: 'group', 'aria-label': box.dataset.alt})};
    kinds[box.dataset.kind](chart, data[box.dataset.section]);
    if (chart.least) chart.plots.style.setProperty('--least', `${chart.least}px`);
    if (!chart.controls.hasChildNodes()) chart.controls.remove();
  }

  let waiting;
  addEventListener('resize', () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => renew(drawings.filter(one => one.width !== Math.floor(one.box.clientWidth))), 150);
  });
})();
