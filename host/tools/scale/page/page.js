'use strict';
// Draws the page from the JSON in #data:
//   title, scene, command, version: text; machine, settings: {name: text | number | list}, names ending in _bytes in bytes;
//   axes: [{name, values}], what was varied beside the lights, of which method says who made the picture, if others than Luciole did;
//   first: {axis: value}, the variant that times are told as multiples of; incomplete: how many points lack some or all of their runs;
//   points: [{lights, values: {axis: value}, runs, reach (of the light that reaches farthest, in metres), milliseconds: {median, low, high}, times_first: {median, low, high},
//     stages: [{name, median, low, high}],
//     pairs_evaluated, pairs_in_range, pixels_lit, list_entries, device_bytes, peak_bytes,
//     error: {max_abs, mean_abs, max_relative, mean_relative, mean_signed, mse, rmse, psnr, relmse, mape, smape, p99_abs, p999_abs, pixels}, truth, front, picture, error_map, tile_map, bound_map, reasons: {name: why it is null},
//     bounds: {max_bound, mean_bound, max_error, mean_error, max_used, mean_used, held, stated, bounded_values,
//     violations}}]:
//     low and high are quartiles, of times_first the ends of a 95 % interval; milliseconds are null where another method has none; truth says what the errors are from, front that no point of as many lights and the same
//     truth beats this one in both time and mean error, fronts the same by other errors: [name], bounds how those of clusters and samples of lights are kept (used: error over bound; held: the
//     share of pixels that are within, stated: the share that is promised, 1 where bounds are proven);
//     all but lights and milliseconds may be absent or null, and picture, error_map, tile_map and bound_map are indices into
//   pictures: [data URL];
//   violations: [text], what breaks its bounds;
//   growth: [{values, stage, a, b, c, c_low, c_high, reason}]: milliseconds ≈ a + b lights^c, 95 % confidence; numbers are
//     null where there is no fit, and the reason says why.
const data = JSON.parse(document.getElementById('data').textContent);

// ------------------------------------------------------------------------------------------------ numbers as text

const isNumber = value => typeof value === 'number' && isFinite(value);

const formatCount = value => Math.round(value).toLocaleString('en');
const digits = (value, count = 3) =>
  Math.abs(value) >= 1000 ? formatCount(value) : value.toLocaleString('en', {maximumSignificantDigits: count});

function scaled(value, units) {
  const unit = units.find(([size]) => Math.abs(value) >= size * 0.9995) || units[units.length - 1];
  return digits(value / unit[0]) + unit[1];
}

const formatTime = milliseconds =>
  milliseconds === 0 ? '0 ms' : scaled(milliseconds, [[1000, ' s'], [1, ' ms'], [1e-3, ' µs'], [1e-6, ' ns']]);
const formatShort = value => value === 0 ? '0' : scaled(value, [[1e12, 'T'], [1e9, 'G'], [1e6, 'M'], [1e3, 'K'], [1, '']]);
const formatBytes = value =>
  value === 0 ? '0 B' : scaled(value, [[2 ** 40, ' TiB'], [2 ** 30, ' GiB'], [2 ** 20, ' MiB'], [2 ** 10, ' KiB'], [1, ' B']]);
const formatPlain = value => digits(value);
const formatFixed = value => value.toFixed(2);

function formatError(value) {
  if (value === 0) return '0';
  if (value >= 0.01 && value < 1000) return digits(value, 2);
  const [mantissa, exponent] = value.toExponential(1).split('e');
  const raised = exponent.replace('+', '').replace(/[-\d]/g, sign => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(sign)]);
  return (mantissa === '1.0' ? '' : mantissa.replace('.0', '') + '\u00a0·\u00a0') + '10' + raised;
}

const orDash = (value, format) => isNumber(value) ? format(value) : '–';
const lightsText = count => formatCount(count) + (count === 1 ? ' light' : ' lights');

// ------------------------------------------------------------------------------------------------------ elements

const byId = id => document.getElementById(id);

function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {}))
    if (value !== false && value !== null) made.setAttribute(name, value === true ? '' : value);
  made.append(...children);
  return made;
}

function fillSelect(select, options) {
  select.replaceChildren(...options.map(([value, text]) => element('option', {value}, text)));
}

// ------------------------------------------------------------------------------------------ variants and their look

const points = [...data.points].sort((a, b) => a.lights - b.lights);
const axes = (data.axes || []).filter(axis => axis.values.length > 1);

const valueOf = (values, axis) => String((values || {})[axis.name] ?? '');
// '-' stands for an option that the variant leaves to another one. Another method is called by its name alone.
const variantName = values => axes.filter(axis => axis.name !== 'method' && valueOf(values, axis) !== '-')
  .map(axis => `${axis.name} ${valueOf(values, axis)}`).join(', ') || (axes.some(axis => axis.name === 'method') ? values.method : '');

const firstName = data.first ? variantName(data.first) : '';

function listVariants() {
  const order = values => axes.map(axis => axis.values.map(String).indexOf(valueOf(values, axis)));
  const found = new Map(points.map(point => [variantName(point.values), point.values]));
  const compare = (a, b) => a.map((rank, i) => rank - b[i]).find(difference => difference) || 0;
  return [...found].map(([name, values]) => ({name, values, order: order(values)}))
    .sort((a, b) => compare(a.order, b.order))
    .map(variant => ({...variant, points: points.filter(point => variantName(point.values) === variant.name)}));
}
const variants = listVariants();
const isOwn = ({values}) => ((values || {}).method ?? 'luciole') === 'luciole';
// The fastest of Luciole's own with the most lights, which the page shows first.
const mainVariant = variants.reduce((best, variant) => {
  const last = measured => measured.points[measured.points.length - 1];
  const isBetter = isOwn(best) < isOwn(variant) || (isOwn(best) === isOwn(variant) && (last(variant).lights > last(best).lights ||
    (last(variant).lights === last(best).lights && last(variant).milliseconds.median < last(best).milliseconds.median)));
  return isBetter ? variant : best;
}, variants[0]);
const lightCounts = [...new Set(points.map(point => point.lights))];
// What points are held against: pictures of different truths are meant to differ, so their errors don't compare.
const truthOf = point => point.truth || '';
const truths = [...new Set(points.map(truthOf))];
const isOneTruth = truths.length < 2;
const isTimed = point => isNumber(point.milliseconds.median);
const stageNames = [...new Set(points.flatMap(point => (point.stages || []).map(stage => stage.name)))];

const shapes = ['circle', 'rect', 'triangle', 'rectRot'];
const dashes = [[], [7, 4], [2, 3], [10, 3, 2, 3]];

// Hue, dash and marker of the nth of a kind; neighbours differ in hue and marker, so that neither is needed alone.
const lookOf = n => ({hue: n % 8, dash: Math.floor(n / 8) % 4, shape: n % 4});

// One axis has hues and markers; a second one has dashes, and the last one takes over the markers.
function lookOfVariant({order}) {
  if (order.length < 2) return lookOf(Math.max(order[0] ?? 0, 0));
  return {hue: order[0] % 8, dash: order[1] % 4, shape: order[order.length - 1] % 4};
}

// The colours that the style sheet has now, for what is drawn by script.
function theme() {
  const style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue('--' + name).trim();
  return {ink: colour('ink'), muted: colour('muted'), line: colour('line'), ground: colour('ground'), raised: colour('raised'),
    series: colour('series').split(',').map(text => text.trim())};
}

const hueOf = (look, colours) => look.hue === undefined ? colours.ink : colours.series[look.hue];

// ---------------------------------------------------------------------------------------------- logarithmic axes

// Zero has no place on a logarithmic axis: it is drawn at a floor of its own, well below all else, which the axis
// names 0 and a dashed line sets apart.
function logAxis(values, format) {
  const positive = values.filter(value => value > 0);
  if (!positive.length) return {from: 0.5, to: 2, floor: 1, ticks: [1]};
  const low = Math.min(...positive), high = Math.max(...positive);
  const margin = Math.max((high / low) ** 0.04, 1.15), to = high * margin;
  if (high === low && !values.includes(0)) return {from: low / 3, to: high * 3, floor: null, ticks: [low]};
  if (!values.includes(0)) return {from: low / margin, to, floor: null, ticks: ticksBetween(low / margin, to, format)};
  const floor = low / Math.max((high / low) ** 0.2, 2);
  return {from: floor / margin, to, floor, ticks: [floor, ...ticksBetween(low / 1.1, to, format)]};
}

// Bytes are counted in powers of 2, all else in decades.
function ticksBetween(low, high, format) {
  const base = format === formatBytes ? 2 : 10, powers = Math.log(high / low) / Math.log(base);
  const first = Math.floor(Math.log(low) / Math.log(base)), last = first + Math.ceil(powers) + 1;
  const steps = powers > 2.5 ? [1] : base === 2 ? [1, 1.25, 1.5, 1.75] : powers > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
  const stride = Math.ceil(powers / 9);
  const ticks = [];
  for (let exponent = first; exponent <= last; ++exponent)
    if (exponent % stride === 0) ticks.push(...steps.map(step => step * base ** exponent));
  return ticks.filter(tick => tick >= low && tick <= high);
}

function chartAxis(axis, title, format, colours) {
  return {
    type: 'logarithmic', min: axis.from, max: axis.to,
    title: {display: true, text: title, color: colours.muted, font: {size: 13}},
    grid: {color: colours.line, borderColor: colours.muted, drawTicks: false},
    afterBuildTicks: scale => { scale.ticks = axis.ticks.map(value => ({value})); },
    ticks: {color: colours.ink, font: {size: 12}, padding: 6, maxRotation: 0, autoSkipPadding: 8,
      callback: value => value === axis.floor ? '0' : format(value)},
  };
}

// --------------------------------------------------------------------------------------- what Chart.js doesn't draw

const spreadBars = {
  id: 'spreadBars',
  afterDatasetDraw(chart, {index, meta}) {
    const context = chart.ctx, dataset = chart.data.datasets[index], scale = chart.scales.y;
    context.save();
    context.strokeStyle = dataset.borderColor;
    context.lineWidth = 1.5;
    context.beginPath();
    meta.data.forEach(({x}, i) => {
      const {low, high} = dataset.data[i];
      if (!(low > 0 && high > low)) return;
      for (const value of [low, high]) {
        context.moveTo(x - 4, scale.getPixelForValue(value));
        context.lineTo(x + 4, scale.getPixelForValue(value));
      }
      context.moveTo(x, scale.getPixelForValue(low));
      context.lineTo(x, scale.getPixelForValue(high));
    });
    context.stroke();
    context.restore();
  },
};

const zeroLine = {
  id: 'zeroLine',
  beforeDatasetsDraw(chart, _, {floor, colour}) {
    if (!floor) return;
    const context = chart.ctx, y = chart.scales.y.getPixelForValue(floor), {left, right} = chart.chartArea;
    context.save();
    context.strokeStyle = colour;
    context.setLineDash([3, 4]);
    context.beginPath();
    context.moveTo(left, y);
    context.lineTo(right, y);
    context.stroke();
    context.restore();
  },
};

// Whether a line between two points goes through a box: its parts between the box's edges, in x and in y, overlap.
function crosses(box, a, b) {
  const part = (from, to, low, high) => {
    if (from === to) return from > low && from < high ? [0, 1] : [1, 0];
    return [(low - from) / (to - from), (high - from) / (to - from)].sort((s, t) => s - t);
  };
  const [x, y] = [part(a.x, b.x, box.left, box.right), part(a.y, b.y, box.top, box.bottom)];
  return Math.max(x[0], y[0], 0) < Math.min(x[1], y[1], 1);
}

// Names points that have a label, each at the first place around it where it covers no other label, point or line.
const pointLabels = {
  id: 'pointLabels',
  afterDatasetsDraw(chart, _, {ink, ground}) {
    const context = chart.ctx, area = chart.chartArea;
    const shown = chart.data.datasets.flatMap((dataset, i) => chart.isDatasetVisible(i)
      ? chart.getDatasetMeta(i).data.map((at, j) => ({x: at.x, y: at.y, label: dataset.data[j].label})) : []);
    const taken = shown.map(({x, y}) => ({left: x - 4, right: x + 4, top: y - 4, bottom: y + 4}));
    const lines = chart.data.datasets.flatMap((dataset, i) => !dataset.showLine || !chart.isDatasetVisible(i) ? []
      : chart.getDatasetMeta(i).data.slice(1).map((at, j) => [chart.getDatasetMeta(i).data[j], at]));
    context.save();
    context.font = `12px ${Chart.defaults.font.family}`;
    context.textBaseline = 'middle';
    for (const {x, y, label} of shown.filter(point => point.label)) {
      const width = context.measureText(label).width;
      const places = [[x + 9, y], [x - 9 - width, y], [x - width / 2, y - 14], [x - width / 2, y + 14], [x + 7, y - 13],
        [x + 7, y + 13], [x - 7 - width, y - 13], [x - 7 - width, y + 13], [x + 16, y - 2], [x - 16 - width, y + 2]];
      const boxes = places.map(([left, middle]) => ({left, right: left + width, top: middle - 7, bottom: middle + 7}));
      const box = boxes.find(b => b.left >= area.left && b.right <= area.right && b.top >= area.top && b.bottom <= area.bottom &&
        taken.every(t => b.right < t.left || b.left > t.right || b.bottom < t.top || b.top > t.bottom) &&
        !lines.some(([from, to]) => crosses(b, from, to)));
      if (!box) continue;
      taken.push(box);
      context.lineWidth = 3;
      context.strokeStyle = ground;
      context.strokeText(label, box.left, box.top + 7);
      context.fillStyle = ink;
      context.fillText(label, box.left, box.top + 7);
    }
    context.restore();
  },
};

// ---------------------------------------------------------------------------------------------- tables and CSV

// A table is {columns: [{name, unit, format, text}], rows: [[value]]}: values as they are in the data, which a
// column's format makes readable (or its `show`, which gives an element); a column of text stands left.

const csvField = value => {
  const text = value === null || value === undefined ? '' : String(value);
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};
const columnTitle = column => column.unit ? `${column.name}, ${column.unit}` : column.name;

// As RFC 4180 has it.
const csvOf = table => [table.columns.map(columnTitle), ...table.rows]
  .map(row => row.map(csvField).join(',') + '\r\n').join('');

function tableCell(column, value, isHead) {
  const content = column.show ? column.show(value) : column.format ? orDash(value, column.format) : value ?? '';
  return element(isHead ? 'th' : 'td', {class: column.text ? 'text' : null, scope: isHead ? 'row' : null}, content);
}

function tableElement(table, caption, headOf = column => column.name) {
  const head = table.columns.map((column, i) => {
    const cell = element('th', {scope: 'col', class: column.text ? 'text' : null});
    cell.append(headOf(column, i));
    return cell;
  });
  const rows = table.rows.map(row => element('tr', null, ...row.map((value, i) => tableCell(table.columns[i], value, i === 0))));
  const made = element('table', {'aria-label': caption}, element('thead', null, element('tr', null, ...head)), element('tbody', null, ...rows));
  return element('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption}, made);
}

// Gives a file of what `now` returns when it is pressed: {title, table}.
function csvButton(now) {
  const button = element('button', {type: 'button', 'aria-label': `CSV: ${now().title}`}, 'CSV');
  button.addEventListener('click', () => {
    const {title, table} = now();
    const address = URL.createObjectURL(new Blob([csvOf(table)], {type: 'text/csv'}));
    element('a', {href: address, download: `${title.toLowerCase().replace(/[^a-z0-9]+/g, '-')}.csv`}).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  });
  return button;
}

// ---------------------------------------------------------------------------------------------------------- plots

// Each draws itself anew from its description: after a choice, a change of theme, and for paper.
const plots = [];
const redraw = () => plots.forEach(plot => plot.draw());

function legendSwatch(look, hasLine, colours) {
  const colour = hueOf(look, colours);
  const marker = {
    circle: '<circle cx="16" cy="7" r="4"/>', rect: '<path d="M12 3h8v8h-8z"/>', triangle: '<path d="M16 2l5 9h-10z"/>',
    rectRot: '<path d="M16 2l5 5-5 5-5-5z"/>',
  }[shapes[look.shape]];
  const line = hasLine ? `<path d="M0 7h32" fill="none" stroke="${colour}" stroke-width="2" stroke-dasharray="${dashes[look.dash].join(' ')}"/>` : '';
  const box = element('span');
  box.innerHTML = `<svg width="32" height="14" aria-hidden="true">${line}<g fill="${colour}">${marker}</g></svg>`;
  return box.firstChild;
}

// The name of a series, which shows or hides it.
function legendItem(series, colours, hidden, toggle) {
  const button = element('button', {type: 'button'}, legendSwatch(series.look, series.line !== false, colours), series.name);
  const showState = () => button.setAttribute('aria-pressed', String(!hidden.has(series.name)));
  button.addEventListener('click', () => {
    toggle(series.name);
    showState();
  });
  showState();
  return element('li', null, button);
}

function datasetOf(series, axisX, axisY, colours, isHidden) {
  const place = (value, axis) => value === 0 ? axis.floor : value;
  const colour = hueOf(series.look, colours);
  return {
    label: series.name, hidden: isHidden,
    data: series.values.map(value => ({...value, x: place(value.x, axisX), y: place(value.y, axisY)})),
    showLine: series.line !== false, borderColor: colour, backgroundColor: colour, borderDash: dashes[series.look.dash],
    borderWidth: series.look.hue === undefined ? 2.75 : 2, pointStyle: shapes[series.look.shape],
    pointRadius: series.bare ? 0 : 4, pointHoverRadius: series.bare ? 0 : 6, pointBorderWidth: 0, pointHitRadius: series.bare ? 0 : 8,
    order: series.bare ? 1 : 0,
  };
}

function chartConfig(plot, colours, hidden) {
  const values = plot.series.flatMap(series => series.values);
  const axisX = logAxis(values.map(value => value.x), plot.formatX);
  const axisY = logAxis(values.flatMap(value => [value.y, value.low, value.high]).filter(isNumber), plot.formatY);
  const tooltipLine = item => {
    const {low, high} = item.raw;
    const value = plot.formatY(item.raw.y === axisY.floor ? 0 : item.raw.y);
    return `${item.dataset.label}: ${value}` + (high > low ? ` (${plot.formatY(low)} to ${plot.formatY(high)})` : '');
  };
  return {
    type: 'line',
    data: {datasets: plot.series.map(series => datasetOf(series, axisX, axisY, colours, hidden.has(series.name)))},
    options: {
      animation: false, maintainAspectRatio: false, responsive: true, parsing: false, normalized: false,
      devicePixelRatio: document.documentElement.classList.contains('paper') ? 3 : undefined,
      interaction: {mode: 'nearest', axis: plot.byColumn ? 'x' : 'xy', intersect: false},
      scales: {x: chartAxis(axisX, plot.titleX, plot.formatX, colours), y: chartAxis(axisY, plot.titleY, plot.formatY, colours)},
      plugins: {
        legend: {display: false},
        tooltip: {usePointStyle: true, backgroundColor: colours.raised, titleColor: colours.ink, bodyColor: colours.ink,
          borderColor: colours.muted, borderWidth: 1, padding: 10, boxPadding: 4,
          callbacks: {title: items => items.length ? items[0].raw.note : '', label: tooltipLine}},
        zeroLine: {floor: axisY.floor, colour: colours.muted}, pointLabels: colours,
      },
    },
    plugins: [spreadBars, zeroLine, pointLabels],
  };
}

// What a plot shows, in words.
function plotText(plot) {
  const ofSeries = ({name, values}) => {
    if (!values.length) return `${name}: nothing`;
    const say = value => `${plot.formatY(value.y)} at ${plot.formatX(value.x)}`;
    return `${name}: ${say(values[0])}` + (values.length > 1 ? ` to ${say(values[values.length - 1])}` : '');
  };
  const named = plot.series.filter(series => !series.bare);
  const more = named.length > 8 ? `, and ${named.length - 8} more` : '';
  return `Plot of ${plot.titleY} against ${plot.titleX}. ${named.slice(0, 8).map(ofSeries).join('; ')}${more}. The table below has all values.`;
}

// Puts a plot into a figure: its title, legend, canvas, CSV button and table. `describe` gives what it shows now:
// {title, titleX, titleY, formatX, formatY, byColumn, series: [{name, look, values: [{x, y, low, high, note, label}],
// line, bare}], table}. A bare series is a line without points or name.
function addPlot(figure, describe) {
  const title = element('figcaption', {class: 'plot-title'});
  const legend = element('ul', {class: 'legend'});
  const canvas = element('canvas', {role: 'img'});
  const details = element('details', null, element('summary', null, 'Table'));
  const csv = csvButton(describe), under = element('div', {class: 'under'}, csv, details);
  figure.append(title, legend, element('div', {class: 'canvas'}, canvas), under);
  const hidden = new Set();
  let chart = null;

  const toggle = name => {
    if (!hidden.delete(name)) hidden.add(name);
    chart.setDatasetVisibility(chart.data.datasets.findIndex(dataset => dataset.label === name), !hidden.has(name));
    chart.update();
  };
  const fillTable = plot => {
    details.replaceChildren(details.firstChild);
    if (details.open) details.append(tableElement(plot.table, plot.title));
  };
  const draw = () => {
    const plot = describe(), colours = theme();
    title.textContent = plot.title;
    canvas.setAttribute('aria-label', plotText(plot));
    csv.setAttribute('aria-label', `CSV: ${plot.title}`);
    const named = plot.series.filter(series => !series.bare);
    legend.replaceChildren(...(named.length > 1 ? named.map(series => legendItem(series, colours, hidden, toggle)) : []));
    legend.classList.toggle('long', named.length > 8);
    fillTable(plot);
    if (chart) chart.destroy();
    chart = new Chart(canvas, chartConfig(plot, colours, hidden));
  };
  details.addEventListener('toggle', () => fillTable(describe()));
  plots.push({draw});
}

// ------------------------------------------------------------------------------------------------------- header

// "tile_size" as "Tile size".
const readable = name => (name[0].toUpperCase() + name.slice(1)).replace(/[_-]/g, ' ');

function readableValue(name, value) {
  if (name.endsWith('_bytes') && isNumber(value)) return formatBytes(value);
  if (name === 'size' && Array.isArray(value)) return value.join(' × ');
  if (Array.isArray(value)) return value.join(', ');
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  return isNumber(value) ? value.toLocaleString('en', {maximumSignificantDigits: 12}) : String(value);
}

function fillConditions(box, values) {
  const entries = Object.entries(values || {}).filter(([, value]) => value !== null && value !== '');
  box.hidden = !entries.length;
  box.querySelector('dl').replaceChildren(...entries.flatMap(([name, value]) =>
    [element('dt', null, readable(name.replace(/_bytes$/, ''))), element('dd', null, readableValue(name, value))]));
}

// What the experiment says, in a sentence for each truth: variants of two don't make the same picture, one faster than the other.
function summary() {
  if (!points.some(isTimed)) return 'No point has been measured yet.';
  const told = truths.slice(0, 4), more = truths.length - told.length;
  const sentences = told.map(truth => sentenceOn(points.filter(point => isTimed(point) && truthOf(point) === truth), isOneTruth ? '' : `${readable(truth)}: `));
  return [...sentences, ...(more ? [`${more} more ${more === 1 ? 'picture is' : 'pictures are'} below.`] : [])].join(' ');
}

// Of points of one truth, after its name.
function sentenceOn(rivals, name) {
  const most = rivals[rivals.length - 1].lights;
  const measured = rivals.filter(point => point.lights === most).sort((a, b) => a.milliseconds.median - b.milliseconds.median);
  const best = measured[0], worst = measured[measured.length - 1], fastest = variantName(best.values);
  const first = rivals.find(point => variantName(point.values) === fastest);
  const parts = [`${lightsText(most)} take${most === 1 ? 's' : ''} ${formatTime(best.milliseconds.median)}`];
  if (measured.length > 1) parts[0] = `${name ? 'with' : 'With'} ${fastest}, the fastest of ${measured.length} variants, ${parts[0]}`;
  if (first.lights < most && first.milliseconds.median > 0)
    parts.push(`${formatPlain(best.milliseconds.median / first.milliseconds.median)} times as long as ${lightsText(first.lights)}`);
  if (isNumber(errorOf(best, 'mean_abs')))
    parts.push(best.error.mean_abs === 0 ? 'without error' : `with a mean error of ${formatError(best.error.mean_abs)}`);
  const contrast = measured.length > 1 ? `; ${variantName(worst.values)}, the slowest, takes ${formatTime(worst.milliseconds.median)}` : '';
  return name + parts.join(', ') + contrast + '.';
}

function fillHeader() {
  document.title = `${data.title} · Luciole`;
  byId('title').textContent = data.title;
  byId('version').textContent = data.version || '';
  byId('summary').textContent = summary();
  const violations = data.violations || [];
  byId('violations').hidden = !violations.length;
  byId('violations').textContent = `Bounds are broken, which is a fault of the program: ${violations.slice(0, 8).join('; ')}${violations.length > 8 ? ' …' : ''}.`;
  byId('truths').hidden = isOneTruth;
  byId('truths').textContent = `The variants are meant to make ${truths.length} different pictures, and each is held against a ` +
    `reference of its own: ${truths.slice(0, 8).join('; ')}${truths.length > 8 ? ' …' : ''}. Errors compare, and fronts are drawn, ` +
    'only between points held against the same one.';
  byId('incomplete').hidden = !data.incomplete;
  byId('incomplete').textContent = data.incomplete === 1 ? 'One point has not been measured in full.' :
    `${formatCount(data.incomplete || 0)} points have not been measured in full.`;
  byId('command').hidden = !data.command;
  byId('command').querySelector('code').textContent = data.command || '';
  fillConditions(byId('machine'), data.machine);
  const fixed = (data.axes || []).filter(axis => axis.values.length === 1).map(axis => [axis.name, axis.values[0]]);
  fillConditions(byId('settings'), {...data.settings, ...Object.fromEntries(fixed)});
}

// ----------------------------------------------------------------------------------------------------- the filter

const chosen = new Map();  // axis name → value; absent: all of them
const isShown = values => axes.every(axis => !chosen.has(axis.name) || chosen.get(axis.name) === valueOf(values, axis));
const shownVariants = () => variants.filter(variant => isShown(variant.values));

// With one axis the plots' legends do as much.
function fillFilter(update) {
  byId('filter').hidden = axes.length < 2;
  if (axes.length < 2) return;
  for (const axis of axes) {
    const select = element('select');
    fillSelect(select, [['', 'all'], ...axis.values.map(value => [String(value), String(value)])]);
    select.addEventListener('change', () => {
      if (select.value === '') chosen.delete(axis.name);
      else chosen.set(axis.name, select.value);
      update();
    });
    byId('filter').append(element('label', null, axis.name + ' ', select));
  }
}

// --------------------------------------------------------------------------------- quantities against lights

const lightsColumn = {name: 'Lights', format: formatCount};
const axisColumns = axes.map(axis => ({name: readable(axis.name), text: true}));
const axisCells = values => axes.map(axis => valueOf(values, axis));
const spreadOf = value => value && isNumber(value.median) ? {y: value.median, low: value.low, high: value.high} : null;
const plainOf = value => isNumber(value) ? {y: value} : null;
const stageOf = (point, name) => spreadOf((point.stages || []).find(stage => stage.name === name));

const timeQuantity = (name, of) => ({name, unit: 'ms', format: formatTime, of});
const quantities = [
  timeQuantity('Total time', point => spreadOf(point.milliseconds)),
  ...stageNames.map(stage => timeQuantity(`Time of ${stage}`, point => stageOf(point, stage))),
  {name: 'Pairs evaluated', format: formatShort, of: point => plainOf(point.pairs_evaluated)},
  {name: 'Pairs evaluated per pair in range', format: formatPlain, of: point => plainOf(pairRatio(point))},
  {name: 'List entries', format: formatShort, of: point => plainOf(point.list_entries)},
  {name: 'Device memory', unit: 'bytes', format: formatBytes, of: point => plainOf(point.device_bytes)},
  {name: 'Peak memory', unit: 'bytes', format: formatBytes, of: point => plainOf(point.peak_bytes)},
  {name: 'Mean error', format: formatError, of: point => plainOf(point.error && point.error.mean_abs)},
  {name: 'Largest error', format: formatError, of: point => plainOf(point.error && point.error.max_abs)},
  {name: 'relMSE', format: formatError, of: point => plainOf(point.error && point.error.relmse)},
  {name: 'SMAPE', format: formatError, of: point => plainOf(point.error && point.error.smape)},
  {name: 'Mean bound', format: formatError, of: point => plainOf(boundOf(point, 'mean_bound'))},
  {name: 'Largest bound', format: formatError, of: point => plainOf(boundOf(point, 'max_bound'))},
].filter(quantity => points.some(quantity.of));

function boundOf(point, name) {
  return point.bounds ? point.bounds[name] : null;
}

// Whether its bounds hold with a confidence.
function isStated(point) {
  return boundOf(point, 'stated') < 1 && isNumber(boundOf(point, 'stated'));
}

function pairRatio(point) {
  return point.pairs_in_range > 0 && isNumber(point.pairs_evaluated) ? point.pairs_evaluated / point.pairs_in_range : null;
}

function valuesOf(measured, of) {
  return measured.map(point => ({x: point.lights, note: lightsText(point.lights), ...of(point)})).filter(value => isNumber(value.y));
}

// The plot of some series against lights. Their table has a row for each value, `cells` first.
function againstLights({title, titleY, format, unit, series, columns, byColumn}) {
  const rows = series.flatMap(({cells, values}) => values.map(value => [value.x, ...cells, value.y, value.low, value.high]));
  const hasSpread = rows.some(row => isNumber(row[row.length - 1]));
  const table = {
    columns: [lightsColumn, ...columns, {name: 'Median', unit, format}, {name: 'Lower quartile', unit, format}, {name: 'Upper quartile', unit, format}],
    rows,
  };
  if (!hasSpread) {
    table.columns = [...table.columns.slice(0, -3), {name: 'Value', unit, format}];
    table.rows = rows.map(row => row.slice(0, -2));
  }
  return {title, titleX: 'lights', titleY, formatX: formatShort, formatY: format, byColumn, series, table};
}

function describeCompared() {
  const quantity = quantities.find(({name}) => name === byId('quantity').value) || quantities[0];
  const series = shownVariants().map(variant => ({name: variant.name, look: lookOfVariant(variant), cells: axisCells(variant.values),
    values: valuesOf(variant.points, quantity.of)})).filter(({values}) => values.length);
  return againstLights({title: `${quantity.name} of each variant`, titleY: quantity.name.toLowerCase(), format: quantity.format,
    unit: quantity.unit, series, columns: axisColumns});
}

function addCompared() {
  if (variants.length < 2) return;
  byId('compared').hidden = false;
  fillSelect(byId('quantity'), quantities.map(({name}) => [name, name.toLowerCase()]));
  addPlot(byId('compared_plot'), describeCompared);
  byId('quantity').addEventListener('change', redraw);
}

// One variant's plot of several quantities, without those that are zero throughout, such as a stage that it doesn't have.
function describeOne(title, titleY, format, unit, parts) {
  const variant = variants[byId('variant').value || 0];
  const series = parts.map(part => ({name: part.name, look: part.look, cells: [part.name], values: valuesOf(variant.points, part.of)}))
    .filter(({values}) => values.some(value => value.y > 0));
  return againstLights({title: variant.name ? `${title}: ${variant.name}` : title, titleY, format, unit, series,
    columns: [{name: 'What', text: true}], byColumn: true});
}

const stageParts = [
  {name: 'total', look: {shape: 0, dash: 0}, of: point => spreadOf(point.milliseconds)},
  ...stageNames.map((name, i) => ({name, look: lookOf(i), of: point => stageOf(point, name)})),
];
const pairParts = [
  {name: 'evaluated', look: lookOf(0), of: point => plainOf(point.pairs_evaluated)},
  {name: 'in range', look: lookOf(1), of: point => plainOf(point.pairs_in_range)},
  {name: 'list entries', look: lookOf(2), of: point => plainOf(point.list_entries)},
];
const memoryParts = [
  {name: 'device', look: lookOf(3), of: point => plainOf(point.device_bytes)},
  {name: 'peak of the program', look: lookOf(5), of: point => plainOf(point.peak_bytes)},
];

function addStages() {
  if (!variants.some(isOwn)) return;
  byId('stages').hidden = false;
  // Of other methods no parts are known.
  const own = variants.filter(isOwn);
  fillSelect(byId('variant'), own.map(variant => [variants.indexOf(variant), variant.name]));
  byId('variant').value = variants.indexOf(mainVariant);
  byId('variant').closest('p').hidden = own.length < 2;
  byId('variant').addEventListener('change', redraw);
  addPlot(byId('stage_plot'), () => describeOne('Time by stage', 'time', formatTime, 'ms', stageParts));
  const addIfMeasured = (id, parts, ...rest) => {
    byId(id).hidden = !points.some(point => parts.some(part => part.of(point)));
    if (!byId(id).hidden) addPlot(byId(id), () => describeOne(...rest, parts));
  };
  addIfMeasured('pairs_plot', pairParts, 'Pairs of a pixel and a light', 'pairs', formatShort, '');
  addIfMeasured('memory_plot', memoryParts, 'Memory', 'bytes', formatBytes, 'bytes');
}

// ----------------------------------------------------------------------------------------------- growth exponents

const growth = data.growth || [];
// The whole, and stages that grow.
const growthStages = [...new Set(growth.filter(fit => fit.stage === 'total' || isNumber(fit.c)).map(fit => fit.stage))];

const growthTable = () => ({
  columns: [...axisColumns, {name: 'Stage', text: true}, {name: 'a', unit: 'ms', format: formatPlain}, {name: 'b', unit: 'ms', format: formatPlain},
    {name: 'c', format: formatFixed}, {name: 'c, low', format: formatFixed}, {name: 'c, high', format: formatFixed},
    {name: 'Reason', text: true}],
  rows: growth.map(fit => [...axisCells(fit.values), fit.stage, fit.a, fit.b, fit.c, fit.c_low, fit.c_high, fit.reason]),
});

function exponentCell(fit) {
  if (!fit) return '–';
  if (!isNumber(fit.c)) return element('span', {class: 'aside'}, fit.reason || '–');
  const interval = isNumber(fit.c_low) && isNumber(fit.c_high) ? ` (${formatFixed(fit.c_low)} to ${formatFixed(fit.c_high)})` : '';
  return element('span', null, formatFixed(fit.c), element('span', {class: 'aside'}, interval));
}

// A row for each variant, a column for each stage.
function exponentTable() {
  const names = [...new Set(growth.map(fit => variantName(fit.values)))];
  const fitOf = (name, stage) => growth.find(fit => fit.stage === stage && variantName(fit.values) === name);
  return {
    columns: [{name: variants.length > 1 ? 'Variant' : '', text: true}, ...growthStages.map(name => ({name, show: exponentCell}))],
    rows: names.map(name => [name || 'Exponent', ...growthStages.map(stage => fitOf(name, stage))]),
  };
}

function addGrowth() {
  if (!growth.length) return;
  byId('growth').hidden = false;
  const details = element('details', null, element('summary', null, 'All coefficients'), tableElement(growthTable(), 'Coefficients of growth'));
  byId('growth_table').append(tableElement(exponentTable(), 'Exponents of growth'),
    element('div', {class: 'under'}, csvButton(() => ({title: 'Growth', table: growthTable()})), details));
}

// ---------------------------------------------------------------------------------------------- error against time

// As `luciole compare --help` defines them. The axis is logarithmic, so it shows how large a bias is.
const errorNames = {mean_abs: 'mean absolute error', max_abs: 'largest absolute error', p99_abs: 'error that 99 % of the pixels keep',
  mean_signed: 'bias: |mean signed error|', mse: 'mean square error (MSE)', rmse: 'root mean square error (RMSE)', relmse: 'relative mean square error (relMSE)',
  mape: 'mean absolute share (MAPE)', smape: 'symmetric mean absolute share (SMAPE)'};
const errorOf = (point, kind) => !point.error || !isNumber(point.error[kind]) ? null : Math.abs(point.error[kind]);
const hasError = point => Object.keys(errorNames).some(kind => isNumber(errorOf(point, kind)));

function errorLabel(point, isOneCount) {
  const name = variantName(point.values);
  if (!name) return formatShort(point.lights);
  return isOneCount ? name : `${formatShort(point.lights)}, ${name}`;
}

const isOnFront = (point, kind) => kind === 'mean_abs' ? point.front : (point.fronts || []).includes(kind);

// How many times as long as the first variant, with the interval.
function ratioText(point) {
  const ratio = point.times_first;
  return ratio ? `${formatPlain(ratio.median)} (${formatPlain(ratio.low)} to ${formatPlain(ratio.high)}) times ${firstName}` : '';
}

// The front's line for each number of lights and each truth: different pictures don't compete.
function frontLines(measured, place, kind) {
  const pictures = lightCounts.flatMap(count => truths.map(truth => ({count, truth})));
  return pictures.map(({count, truth}) => ({name: `front at ${lightsText(count)}${isOneTruth ? '' : `, ${truth}`}`, look: {dash: 0, shape: 0}, bare: true,
    values: measured.filter(point => isOnFront(point, kind) && point.lights === count && truthOf(point) === truth).map(place).sort((a, b) => a.x - b.x)}))
    .filter(({values}) => values.length > 1);
}

function describeError() {
  const kind = byId('error_kind').value || 'mean_abs', count = byId('error_lights').value, truth = byId('error_truth').value;
  const isChosen = point => (count === '' || point.lights === Number(count)) && (truth === '' || truthOf(point) === truths[truth]);
  const measured = points.filter(point => isTimed(point) && isNumber(errorOf(point, kind)) && isShown(point.values) && isChosen(point));
  const place = point => ({x: point.milliseconds.median, y: errorOf(point, kind)});
  const series = shownVariants().map(variant => ({name: variant.name || 'points', look: lookOfVariant(variant), line: false,
    values: variant.points.filter(point => measured.includes(point)).map(point => ({...place(point),
      note: [lightsText(point.lights), formatTime(point.milliseconds.median), ratioText(point)].filter(part => part).join(', '), label: isOnFront(point, kind) ? errorLabel(point, count !== '') : null}))}))
    .filter(({values}) => values.length);
  const lines = frontLines(measured, place, kind);
  const truthColumn = isOneTruth ? [] : [{name: 'Held against', text: true}], truthCell = point => isOneTruth ? [] : [truthOf(point)];
  return {
    title: isOneTruth || truth === '' ? 'Error against time' : `Error against time: ${truths[truth]}`, titleX: 'time', titleY: errorNames[kind], formatX: formatTime, formatY: formatError,
    series: [...series, ...lines],
    table: {
      columns: [lightsColumn, ...axisColumns, {name: 'Time', unit: 'ms', format: formatTime}, {name: readable(errorNames[kind]), format: formatError},
        ...truthColumn, {name: 'Front', text: true}],
      rows: measured.map(point => [point.lights, ...axisCells(point.values), point.milliseconds.median, errorOf(point, kind), ...truthCell(point),
        isOnFront(point, kind) ? 'yes' : 'no']),
    },
  };
}

function addError() {
  const measured = points.filter(point => isTimed(point) && hasError(point));
  if (!measured.length) return;
  byId('error').hidden = false;
  byId('front_note').hidden = variants.length < 2;
  const kinds = Object.entries(errorNames).filter(([kind]) => measured.some(point => isNumber(errorOf(point, kind))));
  fillSelect(byId('error_kind'), kinds);
  const counts = [...new Set(measured.map(point => point.lights))];
  fillSelect(byId('error_lights'), [['', 'all'], ...counts.map(count => [count, formatCount(count)])]);
  if (variants.length > 1) byId('error_lights').value = counts[counts.length - 1];
  // Only points of one truth share a plot, unless that is asked for; at first those of the truth that most have.
  fillSelect(byId('error_truth'), [...truths.map((truth, i) => [i, truth]), ['', 'each its own, all in one plot']]);
  const countOf = truth => measured.filter(point => truthOf(point) === truth).length;
  byId('error_truth').value = truths.reduce((best, truth, i) => countOf(truth) > countOf(truths[best]) ? i : best, 0);
  byId('error_truth').closest('label').hidden = isOneTruth;
  addPlot(byId('error_plot'), describeError);
  for (const id of ['error_kind', 'error_lights', 'error_truth']) byId(id).addEventListener('change', redraw);
}

// ------------------------------------------------------------------------------------------------ bounds against time

const lightErrorAxis = axes.find(axis => axis.name === 'light-error');
// "1/256" as a number.
const shareOf = text => text.split('/').reduce((over, under) => over / under);
const lightErrorOf = point => lightErrorAxis ? valueOf(point.values, lightErrorAxis) : '';
const withoutLightError = values => lightErrorAxis ? {...values, [lightErrorAxis.name]: '-'} : values;

const boundKinds = {max: 'the largest', mean: 'the mean'};

// A line for the bounds, and one for the true errors, of each variant through its light errors.
function describeBounds() {
  const kind = byId('bound_kind').value || 'max', count = Number(byId('bound_lights').value);
  const measured = points.filter(point => point.bounds && point.lights === count && isShown(point.values));
  const rests = [...new Set(measured.map(point => variantName(withoutLightError(point.values))))];
  const lineOf = (rest, name, figure, i) => ({
    name: rest ? `${rest}, ${name}` : name, look: {hue: i % 8, dash: figure === 'error' ? 1 : 0, shape: i % 4},
    values: measured.filter(point => variantName(withoutLightError(point.values)) === rest)
      .map(point => ({x: point.milliseconds.median, y: boundOf(point, `${kind}_${figure}`), label: lightErrorOf(point),
        note: `${lightsText(point.lights)}, ${formatTime(point.milliseconds.median)}`}))
      .filter(value => isNumber(value.y)).sort((a, b) => a.x - b.x),
  });
  return {
    title: `Bound and true error against time: ${boundKinds[kind]}, ${lightsText(count)}`, titleX: 'time', titleY: 'share of the larger of 1 and the pixel',
    formatX: formatTime, formatY: formatError,
    series: rests.flatMap((rest, i) => [lineOf(rest, 'bound', 'bound', 2 * i), lineOf(rest, 'true error', 'error', 2 * i + 1)]),
    table: {
      columns: [lightsColumn, ...axisColumns, {name: 'Time', unit: 'ms', format: formatTime}, ...boundColumns.map(({of, ...column}) => column)],
      rows: measured.map(point => [point.lights, ...axisCells(point.values), point.milliseconds.median, ...boundColumns.map(column => column.of(point))]),
    },
  };
}

const boundColumns = [
  {name: 'Largest bound', format: formatError, of: point => boundOf(point, 'max_bound')},
  {name: 'Mean bound', format: formatError, of: point => boundOf(point, 'mean_bound')},
  {name: 'Largest true error', format: formatError, of: point => boundOf(point, 'max_error')},
  {name: 'Mean true error', format: formatError, of: point => boundOf(point, 'mean_error')},
  {name: 'Largest error over bound', format: formatFixed, of: point => boundOf(point, 'max_used')},
  {name: 'Mean error over bound', format: formatFixed, of: point => boundOf(point, 'mean_used')},
  {name: 'Bounds broken', format: formatCount, of: point => boundOf(point, 'violations')},
  ...(points.some(isStated) ? [
    {name: 'Pixels within', unit: '%', format: formatFixed, of: point => 100 * boundOf(point, 'held')},
    {name: 'Stated', unit: '%', format: formatFixed, of: point => 100 * boundOf(point, 'stated')}] : []),
];

function addBounds() {
  const counts = [...new Set(points.filter(point => point.bounds).map(point => point.lights))];
  if (!counts.length) return;
  byId('bounds').hidden = false;
  fillSelect(byId('bound_kind'), Object.entries(boundKinds));
  fillSelect(byId('bound_lights'), counts.map(count => [count, formatCount(count)]));
  byId('bound_lights').value = counts[counts.length - 1];
  addPlot(byId('bound_plot'), describeBounds);
  for (const id of ['bound_kind', 'bound_lights']) byId(id).addEventListener('change', redraw);
}

// -------------------------------------------------------------------------------------------------------- pictures

const pictureKinds = {picture: 'Picture', error_map: 'Error map', bound_map: 'Bound map', tile_map: 'Tile heat map'};
const pictureOf = (point, kind) => isNumber(point[kind]) ? (data.pictures || [])[point[kind]] : undefined;
const kindsOf = point => Object.keys(pictureKinds).filter(kind => pictureOf(point, kind));

const hasPicture = point => kindsOf(point).length > 0;
const pointName = point => [lightsText(point.lights), variantName(point.values)].filter(part => part).join(', ');

function captionOf(point, kind) {
  const parts = [pictureKinds[kind], lightsText(point.lights), variantName(point.values), isTimed(point) ? formatTime(point.milliseconds.median) : ''];
  if (hasError(point) && isNumber(point.error.mean_abs)) parts.push(`mean error ${formatError(point.error.mean_abs)}`);
  if (isNumber(boundOf(point, 'max_bound'))) parts.push(`largest bound ${formatError(point.bounds.max_bound)}`);
  return parts.filter(part => part).join(' · ');
}

// Shows what one side's selects say, of the kinds that its point has.
function showSide(side) {
  const point = points[byId(`point_${side}`).value], kinds = kindsOf(point), select = byId(`kind_${side}`);
  const kind = kinds.includes(select.value) ? select.value : kinds[0];
  fillSelect(select, kinds.map(name => [name, pictureKinds[name]]));
  select.value = kind;
  byId(`picture_${side}`).src = pictureOf(point, kind);
  byId(`picture_${side}`).alt = captionOf(point, kind);
  byId(`caption_${side}`).textContent = `${side.toUpperCase()}: ${captionOf(point, kind)}`;
  showLightError(side, point);
}

// The pictures of as many lights that differ from a point's in the light error alone, the largest first.
function lightErrorRow(point) {
  const isOfRow = other => other.lights === point.lights && hasPicture(other) &&
    variantName(withoutLightError(other.values)) === variantName(withoutLightError(point.values));
  return points.filter(isOfRow).sort((a, b) => shareOf(lightErrorOf(b)) - shareOf(lightErrorOf(a)));
}

// Puts a side's slider, which goes through a row of light errors, where its point is.
function showLightError(side, point) {
  const slider = byId(`error_${side}`), row = lightErrorAxis ? lightErrorRow(point) : [];
  slider.parentElement.hidden = row.length < 2;
  if (row.length < 2) return;
  slider.max = row.length - 1;
  slider.value = row.indexOf(point);
  slider.setAttribute('aria-valuetext', lightErrorOf(point));
  byId(`error_${side}_value`).textContent = lightErrorOf(point);
}

function chooseLightError(side) {
  const row = lightErrorRow(points[byId(`point_${side}`).value]);
  byId(`point_${side}`).value = points.indexOf(row[byId(`error_${side}`).value]);
  showSide(side);
}

function split() {
  const share = byId('split').value;
  byId('viewer').style.setProperty('--split', share + '%');
  byId('split').setAttribute('aria-valuetext', `A up to ${share} %, B beyond`);
}

function splitAtPointer(event) {
  const {left, width} = byId('viewer').getBoundingClientRect();
  byId('split').value = 100 * (event.clientX - left) / width;
  split();
}

function listenToViewer() {
  const viewer = byId('viewer');
  const isBeside = () => viewer.classList.contains('beside');
  viewer.addEventListener('pointerdown', event => {
    if (isBeside() || event.button !== 0) return;
    viewer.setPointerCapture(event.pointerId);
    splitAtPointer(event);
  });
  viewer.addEventListener('pointermove', event => {
    if (viewer.hasPointerCapture(event.pointerId)) splitAtPointer(event);
  });
  viewer.addEventListener('dragstart', event => event.preventDefault());
  byId('split').addEventListener('input', split);
  byId('beside').addEventListener('change', () => viewer.classList.toggle('beside', byId('beside').checked));
}

// At first the most lights of the main variant, and beside them where they are wrong, or may be.
function addPictures() {
  const shown = variants.flatMap(variant => variant.points.filter(hasPicture));
  if (!shown.length) return;
  byId('pictures').hidden = false;
  const first = mainVariant.points.filter(hasPicture).pop() || shown[shown.length - 1];
  for (const side of ['a', 'b']) {
    fillSelect(byId(`point_${side}`), shown.map(point => [points.indexOf(point), pointName(point)]));
    byId(`point_${side}`).value = points.indexOf(first);
    showSide(side);
    for (const id of [`point_${side}`, `kind_${side}`]) byId(id).addEventListener('change', () => showSide(side));
    byId(`error_${side}`).addEventListener('input', () => chooseLightError(side));
  }
  const kinds = kindsOf(first);
  byId('kind_b').value = kinds.includes('bound_map') ? 'bound_map' : kinds[1] || kinds[0];
  showSide('b');
  listenToViewer();
  split();
}

// ------------------------------------------------------------------------------------------------------ all points

const pointColumns = [
  {...lightsColumn, of: point => point.lights},
  ...axisColumns.map((column, i) => ({...column, of: point => axisCells(point.values)[i]})),
  {name: 'Reach', unit: 'm', format: value => digits(value) + ' m', of: point => point.reach},
  {name: 'Runs', format: formatCount, of: point => point.runs},
  {name: 'Time', unit: 'ms', format: formatTime, of: point => point.milliseconds.median},
  {name: 'Lower quartile', unit: 'ms', format: formatTime, of: point => point.milliseconds.low},
  {name: 'Upper quartile', unit: 'ms', format: formatTime, of: point => point.milliseconds.high},
  {name: 'Times the first', format: formatPlain, of: point => (point.times_first || {}).median},
  {name: '95 %, from', format: formatPlain, of: point => (point.times_first || {}).low},
  {name: '95 %, to', format: formatPlain, of: point => (point.times_first || {}).high},
  ...stageNames.map(name => ({name: readable(name), unit: 'ms', format: formatTime, of: point => (stageOf(point, name) || {}).y})),
  {name: 'Pairs evaluated', format: formatCount, of: point => point.pairs_evaluated},
  {name: 'Pairs in range', format: formatCount, of: point => point.pairs_in_range},
  {name: 'Evaluated per in range', format: formatPlain, of: pairRatio},
  {name: 'Pixels lit', format: formatCount, of: point => point.pixels_lit},
  {name: 'List entries', format: formatCount, of: point => point.list_entries},
  {name: 'Device memory', unit: 'bytes', format: formatBytes, of: point => point.device_bytes},
  {name: 'Peak memory', unit: 'bytes', format: formatBytes, of: point => point.peak_bytes},
  {name: 'Mean error', format: formatError, of: point => errorOf(point, 'mean_abs')},
  {name: 'Largest error', format: formatError, of: point => errorOf(point, 'max_abs')},
  {name: 'RMS error', format: formatError, of: point => errorOf(point, 'rmse')},
  {name: 'relMSE', format: formatError, of: point => errorOf(point, 'relmse')},
  {name: 'MAPE', format: formatError, of: point => errorOf(point, 'mape')},
  {name: 'SMAPE', format: formatError, of: point => errorOf(point, 'smape')},
  {name: 'PSNR', unit: 'dB', format: formatFixed, of: point => point.error ? point.error.psnr : null},
  ...boundColumns,
  {name: 'Held against', text: true, of: point => isOneTruth ? null : truthOf(point)},
  {name: 'Front', text: true, of: point => isNumber(errorOf(point, 'mean_abs')) ? (point.front ? 'yes' : 'no') : null},
].filter(column => points.some(point => (column.of(point) ?? '') !== ''));

const order = {column: 0, sign: 1};

function compareCells(a, b) {
  if (isNumber(a) && isNumber(b)) return a - b;
  return String(a ?? '').localeCompare(String(b ?? ''), 'en', {numeric: true});
}

function pointsTable() {
  const rows = points.filter(point => isShown(point.values)).map(point => pointColumns.map(column => column.of(point)));
  return {columns: pointColumns, rows: rows.sort((a, b) => order.sign * compareCells(a[order.column], b[order.column]))};
}

// Why some of the table's cells are dashes.
function reasons() {
  const found = new Set(points.flatMap(point => Object.values(point.reasons || {})));
  if (points.some(point => !isTimed(point))) found.add('another method whose times are not known');
  if (!points.every(isOwn)) found.add("another method's pictures have neither stages nor counts");
  if (firstName && points.some(point => point.times_first)) found.add(`the first is ${firstName}, of which no multiple is told, nor of fewer than three rounds`);
  if (points.some(point => point.pairs_in_range === 0)) found.add('no light is in range of a pixel');
  return found.size ? `–: ${[...found].join('; ')}.` : '';
}

function drawPointsTable() {
  const box = byId('points_table'), kept = box.querySelector('.scroll');
  const head = (column, i) => {
    const button = element('button', {type: 'button'}, column.name);
    button.addEventListener('click', () => {
      order.sign = order.column === i ? -order.sign : 1;
      order.column = i;
      drawPointsTable();
      box.querySelectorAll('thead button')[i].focus();
    });
    return button;
  };
  const made = tableElement(pointsTable(), 'All points', head);
  made.querySelectorAll('th[scope=col]')[order.column].setAttribute('aria-sort', order.sign > 0 ? 'ascending' : 'descending');
  if (kept) {
    kept.replaceWith(made);
    made.scrollLeft = kept.scrollLeft;
  } else {
    box.append(made, element('p', {hidden: !reasons()}, reasons()), element('div', {class: 'under'}, csvButton(() => ({title: 'Points', table: pointsTable()}))));
  }
}

function addPoints() {
  byId('points').hidden = !points.length;
  if (points.length) drawPointsTable();
}

// ---------------------------------------------------------------------------------------------------- the whole page

function fillContents() {
  const shown = [...document.querySelectorAll('main > section')].filter(section => !section.hidden);
  byId('contents').append(...shown.map(section => element('a', {href: '#' + section.id}, section.querySelector('h2').textContent)));
}

// A canvas keeps its pixels on paper: it is drawn anew in the light theme, in the paper's width and finer.
function setPaper(isPaper) {
  document.documentElement.classList.toggle('paper', isPaper);
  redraw();
}

function start() {
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  fillHeader();
  fillFilter(() => {
    redraw();
    drawPointsTable();
  });
  addCompared();
  addStages();
  addGrowth();
  addError();
  addBounds();
  addPictures();
  addPoints();
  fillContents();
  redraw();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  addEventListener('beforeprint', () => setPaper(true));
  addEventListener('afterprint', () => setPaper(false));
}

start();
