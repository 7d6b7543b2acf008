'use strict';
// Draws what study.json holds. State is what the controls show; every change draws anew.
const study = JSON.parse(document.getElementById('data').textContent);
const byId = id => document.getElementById(id);
const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};

// Okabe and Ito (2008): told apart by the colour-blind, on light and on dark ground.
const COLORS = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#8C6BB1', '#999999'];
const AXES = { samples: ['samples per pixel', ''], cpuSeconds: ['CPU time', ' s'], wallSeconds: ['wall time', ' s'] };
const KINDS = { picture: 'picture', error: 'error', samples: 'sample counts' };

const names = study.settings.configurations.map(c => c.name);
const state = {
  scene: 0,
  axis: study.deviceIsCpu ? 'cpuSeconds' : 'wallSeconds',
  baseline: study.scenes[0].summary.baseline,
  hidden: new Set(),
  sort: { column: 0, up: true },
  at: null, // [configuration, point] that the readout tells of
  kind: 'picture',
};
const colorOf = name => COLORS[names.indexOf(name) % COLORS.length];
const clock = () => state.axis === 'wallSeconds' || (state.axis === 'samples' && !study.deviceIsCpu) ? 'wall' : 'cpu';
const scene = () => study.scenes[state.scene];
const configurations = () => scene().summary.configurations;
const shown = () => configurations().filter(c => !state.hidden.has(c.name));

const number = (value, digits = 3) => {
  if (value === null || value === undefined || !isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(digits - 1);
  return String(Number(value.toPrecision(digits)));
};

// ---- Choices: buttons of which one is pressed.

function choices(parent, values, current, choose) {
  parent.querySelectorAll('button').forEach(b => b.remove());
  for (const [value, label] of values)
    parent.append(make('button', {
      type: 'button', textContent: label, ariaPressed: String(value === current),
      onclick: () => { choose(value); draw(); },
    }));
}

function options(select, values, current) {
  select.replaceChildren(...values.map(([value, label]) =>
    make('option', { value, textContent: label, selected: value === current })));
}

/// Keeps the focus where it was when a button is made anew.
function keepingFocus(work) {
  const active = document.activeElement, parent = active && active.parentElement;
  const index = parent ? [...parent.children].indexOf(active) : -1;
  work();
  if (index >= 0 && !document.contains(active) && document.contains(parent) && parent.children[index])
    parent.children[index].focus();
}

// ---- Plot

let plot = null;

function drawBands(u, list, target) {
  const ctx = u.ctx;
  ctx.save();
  ctx.beginPath();
  ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
  ctx.clip();
  for (const c of list) {
    const points = c.points.filter(p => p.relMse.low !== null && p.relMse.low > 0 && p[state.axis] > 0)
      .sort((a, b) => a[state.axis] - b[state.axis]);
    if (points.length < 1) continue;
    const x = p => u.valToPos(p[state.axis], 'x', true), y = v => u.valToPos(v, 'y', true);
    ctx.fillStyle = colorOf(c.name) + '2e';
    ctx.beginPath();
    points.forEach((p, i) => ctx[i ? 'lineTo' : 'moveTo'](x(p), y(p.relMse.high)));
    [...points].reverse().forEach(p => ctx.lineTo(x(p), y(p.relMse.low)));
    ctx.fill();
  }
  if (target > 0) {
    const y = u.valToPos(target, 'y', true);
    ctx.setLineDash([6, 5]);
    ctx.strokeStyle = getComputedStyle(document.body).color;
    ctx.globalAlpha = 0.5;
    ctx.beginPath();
    ctx.moveTo(u.bbox.left, y);
    ctx.lineTo(u.bbox.left + u.bbox.width, y);
    ctx.stroke();
  }
  ctx.restore();
}

function drawPoints(u, list) {
  const ctx = u.ctx, ratio = devicePixelRatio;
  const ground = getComputedStyle(document.documentElement).getPropertyValue('--card');
  ctx.save();
  for (const c of list)
    c.points.forEach((p, i) => {
      if (!(p.relMse.value > 0) || !(p[state.axis] > 0)) return;
      const x = u.valToPos(p[state.axis], 'x', true), y = u.valToPos(p.relMse.value, 'y', true);
      if (x < u.bbox.left - 1 || x > u.bbox.left + u.bbox.width + 1) return;
      const chosen = state.at && state.at[0] === c.name && state.at[1] === i;
      ctx.beginPath();
      ctx.arc(x, y, (chosen ? 6.5 : 4) * ratio, 0, 2 * Math.PI);
      ctx.fillStyle = p.limitedByReference ? ground : colorOf(c.name);
      ctx.strokeStyle = chosen ? getComputedStyle(document.body).color : colorOf(c.name);
      ctx.lineWidth = 2 * ratio;
      ctx.fill();
      ctx.stroke();
    });
  ctx.restore();
}

/// uPlot wants one column of x for all: each configuration has a table of its own, joined.
function plotData(list) {
  const tables = list.map(c => {
    const points = c.points.filter(p => p.relMse.value > 0 && p[state.axis] > 0)
      .sort((a, b) => a[state.axis] - b[state.axis]);
    return [points.map(p => p[state.axis]), points.map(p => p.relMse.value)];
  }).map(t => t[0].length ? t : [[1], [null]]);
  return tables.length ? uPlot.join(tables) : [[1, 10], [null, null]];
}

function tick(value) {
  const power = Math.log10(value);
  if (Math.abs(power - Math.round(power)) > 1e-9) return '';
  if (value >= 1e-3 && value < 1e5) return String(Number(value.toPrecision(3)));
  return '1e' + Math.round(power);
}

function drawPlot() {
  if (plot) plot.destroy();
  plot = newPlot(byId('plot'), byId('plot').clientWidth, Math.max(320, Math.min(520, innerHeight * 0.55)));
}

/// The plot of the scene and configurations that are chosen now; uPlot draws it later.
function newPlot(parent, width, height) {
  const list = shown(), target = scene().summary.targetError;
  const styles = getComputedStyle(document.documentElement);
  const ink = styles.getPropertyValue('--soft'), line = styles.getPropertyValue('--line');
  const axis = label => ({
    label, stroke: ink, grid: { stroke: line, width: 1 }, ticks: { stroke: line },
    values: (u, splits) => splits.map(v => v === null ? '' : tick(v)),
    font: '13px system-ui, sans-serif', labelFont: '13px system-ui, sans-serif',
  });
  const series = list.length ? list.map(c => ({
    label: c.name, stroke: colorOf(c.name), width: 2, spanGaps: true, points: { show: false },
  })) : [{ label: 'nothing' }];
  const logarithmic = { distr: 3, log: 10 };
  return new uPlot({
    width, height,
    scales: { x: { time: false, ...logarithmic }, y: logarithmic },
    series: [{}, ...series],
    axes: [axis(AXES[state.axis][0] + AXES[state.axis][1].replace(' s', ' in seconds')), { ...axis('relMSE'), size: 66 }],
    legend: { show: false },
    cursor: { drag: { x: true, y: true, uni: 30 }, points: { show: false } },
    hooks: {
      drawAxes: [u => drawBands(u, list, target)], draw: [u => drawPoints(u, list)],
      setCursor: [u => readNearest(u, list)],
    },
  }, plotData(list), parent);
}

function readNearest(u, list) {
  const { left, top } = u.cursor;
  if (left === null || left < 0) return;
  let best = null, distance = 40; // CSS pixels
  for (const c of list)
    c.points.forEach((p, i) => {
      if (!(p.relMse.value > 0) || !(p[state.axis] > 0)) return;
      const d = Math.hypot(u.valToPos(p[state.axis], 'x') - left, u.valToPos(p.relMse.value, 'y') - top);
      if (d < distance) [best, distance] = [[c.name, i], d];
    });
  if (best && String(best) !== String(state.at)) { state.at = best; tell(); u.redraw(false); }
}

function tell() {
  const c = state.at && configurations().find(k => k.name === state.at[0]), p = c && c.points[state.at[1]];
  byId('readout').textContent = p
    ? `${c.name}: relMSE ${number(p.relMse.value)}` +
      (p.relMse.low === null ? '' : ` (${number(p.relMse.low)} to ${number(p.relMse.high)})`) +
      ` with ${number(p.samples)} samples a pixel, ${number(p.cpuSeconds)} s CPU, ${number(p.wallSeconds)} s wall` +
      (p.limitedByReference ? '; limited by the reference' : '')
    : '';
}

byId('plot').addEventListener('keydown', event => {
  const visible = shown();
  if (event.key === '0') return drawPlot();
  const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
  if (!step || !visible.length) return;
  event.preventDefault();
  const row = visible.findIndex(c => state.at && c.name === state.at[0]);
  const next = row < 0 ? 0 : (row + step[0] + visible.length) % visible.length;
  const last = visible[next].points.length - 1;
  const column = row < 0 ? 0 : Math.min(Math.max(state.at[1] + step[1], 0), last);
  state.at = [visible[next].name, column];
  tell();
  plot.redraw(false);
});

// ---- Table

const ratioTo = (name, what) => {
  if (name === state.baseline) return { value: 1, low: null, high: null };
  const found = scene().summary.ratios[clock()].find(r => r.of === state.baseline && r.to === name);
  return found ? found[what] : null;
};

/// Heading, its explanation, the value that is sorted by, what is shown.
const COLUMNS = [
  ['configuration', 'options of render', c => c.name, null],
  ['slope', 'of log relMSE against log samples', c => c.slope && c.slope.value, c => figure(c.slope)],
  ['time to target', 'seconds to the target error', c => c[clock()].timeToTarget,
    c => [c[clock()].timeToTarget === null ? '–' : number(c[clock()].timeToTarget) + ' s' + (c[clock()].extrapolated ? ' *' : '')]],
  ['speed-up', 'time of the baseline to the target error over its own', c => (ratioTo(c.name, 'time') || {}).value,
    c => figure(ratioTo(c.name, 'time'), 1, ' ×')],
  ['less error', 'error of the baseline at equal time over its own', c => (ratioTo(c.name, 'error') || {}).value,
    c => figure(ratioTo(c.name, 'error'), 1, ' ×')],
  ['efficiency', '1 / (relMSE × time) at the target error, per second', c => c[clock()].efficiency,
    c => [number(c[clock()].efficiency)]],
  ['bias', 'of the picture\'s mean, percent', c => c.bias.value, c => figure(c.bias, 100, ' %', 2)],
];

function figure(e, scale = 1, unit = '', digits = 3) {
  if (!e) return ['–'];
  const text = number(scale * e.value, digits) + unit;
  return e.low === null ? [text]
    : [text, make('small', { textContent: `${number(scale * e.low, digits)} to ${number(scale * e.high, digits)}` })];
}

function drawTable() {
  const { column, up } = state.sort;
  byId('figures').tHead.replaceChildren(make('tr', {}, ...COLUMNS.map(([heading, title], i) => {
    const cell = make('th', { scope: 'col' }, make('button', {
      type: 'button', textContent: heading, title,
      onclick: () => { state.sort = { column: i, up: i === column ? !up : i === 0 }; draw(); focusHeading(i); },
    }));
    if (i === column) cell.ariaSort = up ? 'ascending' : 'descending';
    return cell;
  })));
  const value = COLUMNS[column][2];
  const order = (a, b) => {
    const [x, y] = [value(a), value(b)];
    if (x === y) return 0;
    if (x === null || x === undefined) return 1; // what there is no figure for comes last
    if (y === null || y === undefined) return -1;
    return (x < y ? -1 : 1) * (up ? 1 : -1);
  };
  const list = column === 0 && up ? configurations() : [...configurations()].sort(order);
  byId('figures').tBodies[0].replaceChildren(...list.map(c => make('tr',
    { className: c.name === state.baseline ? 'baseline' : '' },
    make('td', { title: c.what }, swatch(c.name), c.name, make('small', {}, make('code', { textContent: c.options }))),
    ...COLUMNS.slice(1).map(k => make('td', {}, ...k[3](c))))));
  byId('target').textContent = scene().summary.targetError > 0
    ? `Target: relMSE ${number(scene().summary.targetError)}, that of ${scene().summary.baseline} with ` +
      `${study.settings.targetSamples} samples. Times: ${clock() === 'cpu' ? 'CPU' : 'wall'}, of sampling alone.`
    : 'The baseline has not been measured.';
}
const focusHeading = i => byId('figures').tHead.rows[0].cells[i].firstChild.focus();
const swatch = name => {
  const s = make('span', { className: 'swatch' });
  s.style.background = colorOf(name);
  return s;
};

// ---- Pictures

const LEGENDS = {
  picture: 'As render writes it: sRGB, no exposure.',
  samples: 'Samples taken, of the most a pixel has: blue few, green half, red the most.',
};

function pictureOf(side) {
  const name = byId(side).value;
  return { name, ...(name === 'reference' ? scene().pictures.reference : scene().pictures[name]) };
}

function drawPictures() {
  const available = ['reference', ...configurations().map(c => c.name).filter(n => scene().pictures[n])];
  for (const [side, fallback] of [['left', available[1] || available[0]], ['right', available[available.length - 1]]]) {
    const kept = byId(side).value;
    options(byId(side), available.map(n => [n, n]), available.includes(kept) ? kept : fallback);
  }
  choices(byId('kind'), Object.entries(KINDS), state.kind, kind => { state.kind = kind; });
  for (const side of ['left', 'right']) {
    const p = pictureOf(side), source = p[state.kind], image = byId('image-' + side);
    image.src = source || p.picture;
    image.alt = `${p.name}, ${source ? KINDS[state.kind] : 'picture'}`;
    image.style.width = scene().width * byId('zoom').value + 'px';
    image.style.height = scene().height * byId('zoom').value + 'px';
    const about = p.name === 'reference' ? `${scene().reference.samples} samples`
      : `${number(p.samplesPerPixel)} samples, ${number(p.cpuSeconds)} s CPU, relMSE ${number(p.relMse)}`;
    byId('caption-' + side).textContent = `${p.name}: ${about}` +
      (source ? '' : ` (no ${KINDS[state.kind]}; the picture is shown)`);
  }
  if (state.kind === 'error') {
    const stops = Array.from({ length: 17 }, (_, i) => cubehelix(i / 16)).join(',');
    const ramp = make('span', { className: 'ramp' });
    ramp.style.background = `linear-gradient(to right,${stops})`;
    byId('legend').replaceChildren('Root of relMSE, means of 2 × 2 pixels: 0 ', ramp, ' 1 and more.');
  } else byId('legend').textContent = LEGENDS[state.kind];
  drawDivider();
}

/// Green's cubehelix (2011), with the parameters of host/compare/flip.cpp.
function cubehelix(t) {
  const angle = 2 * Math.PI * (0.5 / 3 + 1 - 1.5 * t), a = t * (1 - t) / 2;
  const [x, y] = [Math.cos(angle), Math.sin(angle)];
  const c = [t + a * (-0.14861 * x + 1.78277 * y), t + a * (-0.29227 * x - 0.90649 * y), t + a * 1.97294 * x];
  return `rgb(${c.map(v => Math.round(255 * Math.min(Math.max(v, 0), 1))).join(' ')})`;
}

function drawDivider() {
  const share = byId('slider').value / 10;
  byId('image-right').style.clipPath = `inset(0 0 0 ${share}%)`;
  byId('divider').style.left = share + '%';
}

byId('slider').addEventListener('input', drawDivider);
const drag = event => {
  if (!(event.buttons & 1)) return;
  const box = byId('frame').getBoundingClientRect();
  byId('slider').value = 1000 * (event.clientX - box.left) / box.width;
  drawDivider();
};
for (const kind of ['pointerdown', 'pointermove']) byId('frame').addEventListener(kind, drag);
for (const id of ['left', 'right', 'zoom']) byId(id).addEventListener('change', drawPictures);
byId('baseline').addEventListener('change', event => { state.baseline = event.target.value; draw(); });

/// The largest zoom at which the pictures fit the window.
function firstZoom() {
  const fits = [4, 2, 1].find(z => z * scene().width <= byId('compare').clientWidth) || 1;
  byId('zoom').value = fits;
}

// ---- Circumstances

function drawCircumstances() {
  const c = study.circumstances;
  byId('machine').textContent = `${c.device} on ${c.cpu}, ${c.threads || c.cores} threads · ${c.date}`;
  const rows = [['command', make('code', { textContent: c.command })], ['device', c.device], ['driver', c.driver],
    ['machine', `${c.cpu}, ${c.cores} cores, ${c.system}`], ['program', `Stromboli ${c.version}, ${c.compiler}`],
    ['every picture', make('code', { textContent: study.settings.commonOptions })],
    ['seeds', `1 to ${study.settings.seeds}`],
    ...study.scenes.map(s => [`reference of ${s.name}`,
      `${s.reference.samples} samples, its own relMSE ${number(s.reference.relMse)}, options `])];
  byId('circumstances').replaceChildren(...rows.flatMap(([name, value]) =>
    [make('dt', { textContent: name }), make('dd', {}, value)]));
  study.scenes.forEach((s, i) => byId('circumstances').querySelectorAll('dd')[rows.length - study.scenes.length + i]
    .append(make('code', { textContent: s.reference.options })));
  byId('how').replaceChildren(...[
    'relMSE is the mean over pixels and channels of (x − r)² / (r² + 0.01 m²): r is the reference, m its mean. The ' +
    'constant makes a pixel darker than a tenth of the mean count by its absolute error, and the figure the same in ' +
    'every unit of radiance. The reference’s own error, known from its variances, is taken away; points where it is ' +
    'the larger part are hollow, and no figure uses them.',
    'Times are of sampling alone: the scene is loaded, the kernel compiled and warm. CPU time is that of all threads, ' +
    'the driver’s too, and suffers less from other work on the machine than wall time. Counts of samples grow within ' +
    'one render where every pixel has as many paths and each its own camera ray; all else is a render of its own. ' +
    'Times at equal error are read between points on the straight ' +
    'line of the logarithms, seed by seed.',
    'Intervals are of 95 %: Student’s t over seeds for slopes and bias, on the logarithmic axis for errors, Welch’s ' +
    'test for ratios. The interval of the bias has the uncertainty of the reference’s mean in it.',
  ].map(text => make('p', { textContent: text })));
}

// ---- All of it

function drawSeries() {
  byId('series').replaceChildren(...configurations().map(c => {
    const button = make('button', {
      type: 'button', textContent: c.name, title: c.what, ariaPressed: String(!state.hidden.has(c.name)),
      onclick: () => { state.hidden.has(c.name) ? state.hidden.delete(c.name) : state.hidden.add(c.name); draw(); },
    });
    button.style.setProperty('--swatch', colorOf(c.name));
    return button;
  }));
}

function draw() {
  keepingFocus(() => {
    choices(byId('scenes'), study.scenes.map((s, i) => [i, s.name]), state.scene, i => { state.scene = i; state.at = null; });
    choices(byId('axis'), Object.entries(AXES).map(([k, v]) => [k, v[0]]), state.axis, a => { state.axis = a; });
    options(byId('baseline'), configurations().map(c => [c.name, c.name]), state.baseline);
    drawSeries();
    drawPlot();
    tell();
    drawTable();
    drawPictures();
  });
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
let resizing = 0;
/// "report.html#figure": the plots of all scenes side by side and nothing else, to take a picture of.
function drawFigure() {
  const row = make('div', { id: 'figure' });
  document.body.replaceChildren(row);
  study.scenes.forEach((s, i) => {
    const legend = make('p', {}, ...s.summary.configurations.flatMap(c => [swatch(c.name), c.name + '   ']));
    const parent = make('div');
    row.append(make('div', {}, make('h2', { textContent: s.name }), legend, parent));
    state.scene = i;
    newPlot(parent, innerWidth / study.scenes.length - 30, 360);
  });
}

addEventListener('resize', () => { clearTimeout(resizing); resizing = setTimeout(drawPlot, 100); }); // ms
if (location.hash === '#figure') drawFigure();
else {
  drawCircumstances();
  firstZoom();
  draw();
}
document.documentElement.dataset.state = 'ready';
