'use strict';
// Plots over time, or over another quantity, as SVG, and tables. Every value of the given arrays is drawn.

// Multiples of a round step (1, 2 or 5 times a power of ten) from low to high, about max_ticks of them.
function round_ticks(low, high, max_ticks) {
  const rough = (high - low) / max_ticks;
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) ticks.push(i * step);
  return { ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

// Formats a number with at most four significant digits, but a whole number below a million with all of its digits.
function format_number(value) {
  return Number.isInteger(value) && Math.abs(value) < 1e6 ? (value || 0).toLocaleString('en') : format_digits(value, 1);
}

// Formats a number with four significant digits, so that one that changes keeps its width.
const format_fixed = (value) => format_digits(value, 4);

function format_digits(value, least) {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';  // also for -0
  const magnitude = Math.abs(value);
  if (magnitude < 1e-3 || magnitude >= 1e6) return value.toExponential(3);
  return value.toLocaleString('en', { minimumSignificantDigits: least, maximumSignificantDigits: 4 });
}

function svg_element(name, attributes, parent) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
}

class Plot {
  // parent: the containing element. series: [{name, times, values}], at most sixteen. on_seek(time): called when the user
  // points at a time. scale: values below 1e-9 of it are rounding, shown as 0. missing: text shown if there are no values. across: the quantity that `times` are, if not the time.
  // marks: [{time, text}], vertical lines, ascending in time.
  constructor(parent, { title, unit, series, on_seek, scale = 0, missing = 'not recorded', across = { name: 'time', unit: ' s' }, marks = [] }) {
    this.missing = missing;
    this.scale = scale;
    this.across = across;
    this.marks = marks;
    this.figure = document.createElement('figure');
    this.caption = document.createElement('figcaption');
    this.heading = document.createElement('b');
    this.caption.append(this.heading);
    this.readings = [];
    this.set(series, title, unit);
    this.svg = svg_element('svg', { role: 'img', tabindex: '-1' });
    this.figure.append(this.caption, this.svg);
    parent.append(this.figure);
    this.svg.addEventListener('pointerdown', (event) => this.point(event, on_seek));
    this.svg.addEventListener('pointermove', (event) => { if (event.buttons) this.point(event, on_seek); });
    new ResizeObserver(() => this.draw()).observe(this.figure);
    this.draw();
  }

  static get colours() { return ['var(--first)', 'var(--second)', 'var(--third)', 'var(--fourth)']; }
  get height() { return 104; }

  // The dashes of the i-th line: with four colours, sixteen lines differ.
  static dashes(i) { return ['none', '6 3', '2 2', '9 3 2 3'][(i + (i >> 2)) % 4]; }
  static colour(i) { return Plot.colours[i % 4]; }

  // The series, the title and the unit may change, the number of series too.
  update(series, title = this.title, unit = this.unit) {
    this.set(series, title, unit);
    this.draw();
  }

  set(series, title, unit) {
    this.series = series;
    this.title = title;
    this.unit = unit;
    this.heading.textContent = unit ? `${title}, ${unit}` : title;
    while (this.readings.length > series.length) this.readings.pop().remove();
    while (this.readings.length < series.length) {
      const reading = document.createElement('span');
      this.caption.append(reading);
      this.readings.push(reading);
    }
    this.readings.forEach((reading, i) => this.style_reading(reading, i));
  }

  style_reading(reading, i) {
    reading.className = `name ${['', 'dashed', 'dotted', 'dashed'][(i + (i >> 2)) % 4]}`;
    reading.style.setProperty('--line', Plot.colour(i));
  }

  range() {
    let low = Infinity, high = -Infinity, start = Infinity, end = -Infinity;
    for (const { times, values } of this.series) {
      for (let i = 0; i < values.length; i += 1) {
        start = Math.min(start, times[i]);
        end = Math.max(end, times[i]);
        if (!Number.isFinite(values[i])) continue;
        low = Math.min(low, values[i]);
        high = Math.max(high, values[i]);
      }
    }
    return { low, high, start, end, empty: low > high };
  }

  draw() {
    const width = Math.max(160, this.figure.clientWidth), height = this.height;
    const left = 58, right = 16, top = 6, bottom = 20;
    const range = this.range();
    this.svg.replaceChildren();
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.svg.setAttribute('height', height);
    this.describe(range);
    this.figure.classList.toggle('empty', range.empty);
    if (range.empty) {
      this.now = null;
      this.readings.forEach((reading, i) => { reading.textContent = i === 0 ? this.missing : ''; });
      return;
    }
    // A constant series is drawn in the middle instead of magnifying its rounding errors.
    const middle = 0.5 * (range.low + range.high);
    const half = Math.max(0.5 * (range.high - range.low), 1e-9 * Math.abs(middle), 1e-9 * this.scale, 1e-12);
    const low = middle - 1.08 * half, high = middle + 1.08 * half;
    const end = range.end > range.start ? range.end : range.start + 1;
    this.x = (time) => left + (time - range.start) / (end - range.start) * (width - left - right);
    this.time = (x) => range.start + (x - left) / (width - left - right) * (end - range.start);
    const y = (value) => top + (high - value) / (high - low) * (height - top - bottom);
    const rows = round_ticks(low, high, Math.round(height / 26));
    for (const tick of rows.ticks) {
      svg_element('line', { class: 'rule', x1: left, x2: width - right, y1: y(tick), y2: y(tick) }, this.svg);
      const label = svg_element('text', { x: left - 5, y: y(tick) + 4, 'text-anchor': 'end' }, this.svg);
      label.textContent = Math.abs(tick) >= 1e6 ? tick.toExponential(1) : rows.digits > 6 ? tick.toExponential(2) : tick.toFixed(rows.digits);
    }
    const columns = round_ticks(range.start, end, Math.max(2, Math.floor(width / 90)));
    for (const tick of columns.ticks) {
      const text = `${tick.toFixed(columns.digits)}${this.across.unit}`;
      const half_width = 3.4 * text.length;  // of digits of 11 px
      const x = Math.min(this.x(tick), width - half_width);
      svg_element('text', { x, y: height - 5, 'text-anchor': 'middle' }, this.svg).textContent = text;
    }
    this.draw_marks(range, top, height - bottom);
    this.draw_series(y);
    this.now = svg_element('line', { class: 'now', y1: top, y2: height - bottom, x1: -9, x2: -9 }, this.svg);
    this.show(this.shown_time);
  }

  // The text runs along its line from the bottom, or from the top if another text is there already. If both places are
  // taken, only the line's tooltip, which every line has, shows it.
  draw_marks(range, top, bottom) {
    const width = 12, ends = [{ y: bottom, anchor: 'start', dx: 4, last: -Infinity }, { y: top, anchor: 'end', dx: -4, last: -Infinity }];
    for (const { time, text } of this.marks) {
      if (!(time >= range.start && time <= range.end)) continue;
      const x = this.x(time);
      const line = svg_element('line', { class: 'mark', x1: x, x2: x, y1: top, y2: bottom }, this.svg);
      svg_element('title', {}, line).textContent = text;
      const end = ends.find(({ last }) => x - last >= width);
      if (!end) continue;
      end.last = x;
      svg_element('text', { x, y: end.y, dx: end.dx, dy: -3, 'text-anchor': end.anchor, transform: `rotate(-90 ${x} ${end.y})` }, this.svg).textContent = text;
    }
  }

  // y: maps values to pixels, as this.x maps times.
  draw_series(y) {
    this.series.forEach(({ times, values }, i) => {
      let path = '', dots = '', pen_up = true;
      for (let n = 0; n < values.length; n += 1) {
        if (!Number.isFinite(values[n])) { pen_up = true; continue; }
        const point = `${this.x(times[n]).toFixed(1)} ${y(values[n]).toFixed(1)}`;
        path += `${pen_up ? 'M' : 'L'}${point}`;
        if (pen_up && !Number.isFinite(values[n + 1])) dots += `M${point}h0`;  // an isolated value has no line
        pen_up = false;
      }
      svg_element('path', { d: path, fill: 'none', style: `stroke:${Plot.colour(i)}`, 'stroke-width': 1.7,
                            'stroke-linejoin': 'round', 'stroke-dasharray': Plot.dashes(i) }, this.svg);
      if (dots) svg_element('path', { class: 'lone', d: dots, style: `stroke:${Plot.colour(i)}` }, this.svg);
    });
  }

  // Sets the text alternative for screen readers.
  describe(range) {
    const parts = this.series.map(({ name, values }) => {
      const finite = Array.from(values).filter(Number.isFinite);
      if (finite.length === 0) return `${name} was not recorded`;
      const min = finite.reduce((a, b) => Math.min(a, b)), max = finite.reduce((a, b) => Math.max(a, b));
      return `${name} from ${format_number(min)} to ${format_number(max)}, at the end ${format_number(finite[finite.length - 1])}`;
    });
    const span = range.empty ? '' : ` from ${format_number(range.start)} to ${format_number(range.end)}${this.across.unit}`;
    const unit = this.unit ? ` in ${this.unit}` : '';
    const marks = this.marks.map(({ time, text }) => `; ${text} at ${format_number(time)}${this.across.unit}`).join('');
    this.svg.setAttribute('aria-label', `${this.title}${unit} over ${this.across.name}${span}: ${parts.join('; ')}${marks}`);
  }

  // Marks the time and displays the values of the last row that is not later.
  show(time) {
    this.shown_time = time;
    if (time === undefined || !this.now) return;
    this.now.setAttribute('x1', this.x(time));
    this.now.setAttribute('x2', this.x(time));
    this.series.forEach(({ name, times, values }, i) => {
      const value = values[row_at(times, time)];
      this.readings[i].textContent = `${name} ${format_fixed(Math.abs(value) < 1e-9 * this.scale ? 0 : value)}`;
    });
  }

  point(event, on_seek) {
    if (!on_seek || !this.time) return;
    const box = this.svg.getBoundingClientRect();
    on_seek(this.time(event.clientX - box.left));
  }
}

// The last row that is not later than time, or the first if all are later. times: ascending.
function row_at(times, time) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

// A table with a caption, column headings and rows of cells. A column of numbers is right-aligned.
function table_of(caption, heads, rows) {
  const table = document.createElement('table');
  const text = document.createElement('span');
  text.textContent = caption;
  table.createCaption().append(text);
  const head = table.createTHead().insertRow();
  const numeric = heads.map((_, i) => rows.length > 0 && rows.every((row) => typeof row[i] === 'number' || row[i] === null));
  heads.forEach((text, i) => {
    const cell = document.createElement('th');
    cell.scope = 'col';
    cell.textContent = text;
    if (numeric[i]) cell.className = 'number';
    head.append(cell);
  });
  const body = table.createTBody();
  for (const row of rows) {
    const line = body.insertRow();
    row.forEach((value, i) => {
      const cell = line.insertCell();
      cell.textContent = value === null ? '–' : typeof value === 'number' ? format_number(value) : value;
      if (numeric[i]) cell.className = 'number';
    });
  }
  const box = document.createElement('div');
  box.className = 'scroll';
  box.tabIndex = 0;
  box.setAttribute('role', 'region');
  box.setAttribute('aria-label', caption);
  box.append(table);
  return box;
}
