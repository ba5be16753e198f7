'use strict';
// Plots the parts of the wrench on a body, stacked: buoyancy, drag, added-mass terms and weight.

const load_styles = {
  buoyancy: { colour: 'var(--third)', line: 'none' },
  drag: { colour: 'var(--second)', line: '6 3' },
  added_mass: { colour: 'var(--fourth)', line: '2 2' },
  weight: { colour: 'var(--weight)', line: '9 3 2 3' },
  sum: { colour: 'var(--text)', line: 'none' },
};

// Series stacked from zero, positive values upwards and negative ones downwards. Each has a part of load_styles; the last
// one, the sum, is drawn as a line.
class StackPlot extends Plot {
  get height() { return 190; }

  style_reading(reading, i) {
    const { part } = this.series[i];
    reading.className = part === 'sum' ? 'name' : 'name area';
    reading.style.setProperty('--line', load_styles[part].colour);
  }

  // The lower and the upper edge of a part at every row: {positive: [lower, upper], negative: [lower, upper]}.
  bands() {
    const parts = this.series.slice(0, -1);
    const count = parts.length > 0 ? parts[0].values.length : 0;
    const positive = new Float64Array(count), negative = new Float64Array(count);
    return parts.map(({ values }) => {
      const band = { positive: [positive.slice(), null], negative: [null, negative.slice()] };
      for (let n = 0; n < count; n += 1) {
        if (values[n] > 0) positive[n] += values[n];
        else negative[n] += values[n];  // NaN where the loads are not known, of all parts alike
      }
      band.positive[1] = positive.slice();
      band.negative[0] = negative.slice();
      return band;
    });
  }

  range() {
    const range = super.range();
    if (range.empty) return range;
    range.low = Math.min(range.low, 0);
    range.high = Math.max(range.high, 0);
    for (const { positive, negative } of this.bands()) {
      for (const value of positive[1]) if (value > range.high) range.high = value;
      for (const value of negative[0]) if (value < range.low) range.low = value;
    }
    return range;
  }

  draw_series(y) {
    const { times } = this.series[0];
    this.bands().forEach((band, i) => {
      const { colour, line } = load_styles[this.series[i].part];
      for (const [sign, edges] of Object.entries(band)) {
        const areas = this.areas(times, edges, this.series[i].values, y);
        if (areas === '') continue;
        svg_element('path', { class: `area ${this.series[i].part} ${sign}`, d: areas,
                              style: `fill:${colour};stroke:${colour};stroke-dasharray:${line}` }, this.svg);
      }
    });
    const zero = y(0);
    svg_element('line', { class: 'zero', x1: this.x(times[0]), x2: this.x(times[times.length - 1]), y1: zero, y2: zero }, this.svg);
    const sum = this.series[this.series.length - 1];
    let path = '', pen_up = true;
    sum.values.forEach((value, n) => {
      if (Number.isFinite(value)) path += `${pen_up ? 'M' : 'L'}${this.x(times[n]).toFixed(1)} ${y(value).toFixed(1)}`;
      pen_up = !Number.isFinite(value);
    });
    svg_element('path', { class: 'sum', d: path, fill: 'none', style: `stroke:${load_styles.sum.colour}`, 'stroke-width': 1.7,
                          'stroke-linejoin': 'round' }, this.svg);
  }

  // One closed outline for each run of rows whose loads are known and in which the band has a height.
  areas(times, [lower, upper], values, y) {
    const drawn = (n) => Number.isFinite(values[n]) && (upper[n] > lower[n] || upper[n - 1] > lower[n - 1] || upper[n + 1] > lower[n + 1]);
    let outline = '', start = -1;
    for (let n = 0; n <= values.length; n += 1) {
      if (n < values.length && drawn(n)) {
        if (start < 0) start = n;
        continue;
      }
      if (start < 0) continue;
      const forth = [], back = [];
      for (let k = start; k < n; k += 1) {
        const x = this.x(times[k]).toFixed(1);
        forth.push(`${x} ${y(upper[k]).toFixed(1)}`);
        back.push(`${x} ${y(lower[k]).toFixed(1)}`);
      }
      outline += `M${forth.concat(back.reverse()).join('L')}Z`;
      start = -1;
    }
    return outline;
  }
}

// Plots from 0 to 100 %, even if the values are constant.
class ImmersionPlot extends Plot {
  range() {
    return { ...super.range(), low: 0, high: 100 };
  }
}

const dot_product = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross_product = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Returns v rotated by the quaternion q [w, x, y, z].
function turned(q, v) {
  const norm = Math.hypot(...q);
  const [w, ...u] = q.map((component) => component / norm);
  const t = cross_product(u, v).map((component) => 2 * component);
  return cross_product(u, t).map((component, i) => v[i] + w * t[i] + component);
}

// "x" for [1, 0, 0], "-z" for [0, 0, -1], "(0.6, 0, 0.8)" for others.
function axis_text(axis) {
  const at = axis.findIndex((component) => Math.abs(Math.abs(component) - 1) < 1e-9);
  return at < 0 ? `(${axis.map((component) => Number(component.toPrecision(3))).join(', ')})` : `${axis[at] < 0 ? '-' : ''}${'xyz'[at]}`;
}

// Whether forces depend on the motion of this body, so that its energy is not conserved.
const has_hydrodynamics = (description) => Boolean(description.loads && (description.loads.drag_center || description.loads.added_mass));

// Plots the stacked loads along an axis that the reader selects, and the immersion.
//
// Loads are {immersion, buoyancy, drag, added_mass: [6], a force and a torque about the reference point, q}, or null where
// they are not known; see snapshot_json.h.
class LoadPlots {
  // model: see scene_model.h. before: an element of parent in front of which the plots appear.
  constructor(parent, before, model, on_seek) {
    this.model = model;
    const { e1, e2, waves } = model.loads;
    const { up } = model.water;
    this.buoyancy_text = waves ? 'wave load' : 'buoyancy';
    this.axes = [[`up (${axis_text(up)})`, up], [axis_text(e1), e1], [axis_text(e2), e2]];
    this.box = document.createElement('div');
    this.box.className = 'loads';
    parent.insertBefore(this.box, before);
    const controls = document.createElement('div');
    controls.className = 'controls';
    this.choice = document.createElement('select');
    this.choice.id = 'load_axis';
    for (const torque of [false, true]) {
      this.axes.forEach(([text], i) => {
        const label = torque ? `Torque about ${text}` : `Force along ${text}`;
        this.choice.add(new Option(label, `${torque ? 't' : 'f'}${i}`));
      });
    }
    this.motion_only = document.createElement('input');
    this.motion_only.type = 'checkbox';
    this.motion_only.id = 'loads_of_motion';
    const labelled = (control, before_text, after_text) => {
      const label = document.createElement('label');
      label.append(before_text, control, after_text);
      return label;
    };
    this.motion_label = labelled(this.motion_only, '', ' Drag and added mass only');
    controls.append(labelled(this.choice, 'Loads: ', ''), this.motion_label);
    this.box.append(controls);
    const none = [{ part: 'sum', name: 'sum', times: [], values: [] }];
    this.stack = new StackPlot(this.box, { title: 'Loads', unit: 'N', series: none, on_seek, missing: 'no loads' });
    this.immersion = new ImmersionPlot(this.box, { title: 'Immersion', unit: '%', series: [{ name: 'of drag and added mass', times: [], values: [] }], on_seek, missing: 'no loads' });
    this.note = document.createElement('p');
    this.note.className = 'soft';
    this.box.append(this.note);
    for (const control of [this.choice, this.motion_only]) control.addEventListener('change', () => this.draw());
  }

  // description: of the body. times: of its rows. loads(n): the loads of a row. note: text below the plots.
  update(description, times, loads, note = '') {
    Object.assign(this, { description, times, loads });
    this.note.textContent = note;
    this.draw();
  }

  // The body's parts in the order of the stack, [key, name].
  parts() {
    const { drag_center, added_mass } = this.description.loads;
    const motion = [...(drag_center ? [['drag', 'drag']] : []), ...(added_mass ? [['added_mass', 'added mass']] : [])];
    if (motion.length > 0 && this.motion_only.checked) return motion;
    const weight = this.description.center_of_mass !== null && this.description.mass !== null;
    return [['buoyancy', this.buoyancy_text], ...motion, ...(weight ? [['weight', 'weight']] : [])];
  }

  weight(q) {
    const { mass, center_of_mass, reference_point } = this.description;
    const force = this.model.water.up.map((component) => -component * mass * this.model.water.gravity);
    return [...force, ...cross_product(turned(q, center_of_mass.map((c, i) => c - reference_point[i])), force)];
  }

  draw() {
    const of_motion = has_hydrodynamics(this.description);
    this.motion_label.hidden = !of_motion;
    const is_torque = this.choice.value[0] === 't';
    const [, axis] = this.axes[Number(this.choice.value[1])];
    const known = Array.from(this.times, (_, n) => this.loads(n));
    const component = (part, loads) => {
      if (loads === null) return NaN;
      const wrench = part === 'weight' ? this.weight(loads.q) : loads[part];
      return dot_product(is_torque ? wrench.slice(3) : wrench.slice(0, 3), axis);
    };
    const series = this.parts().map(([part, name]) => ({ part, name, times: this.times, values: known.map((loads) => component(part, loads)) }));
    series.push({ part: 'sum', name: 'sum', times: this.times,
                  values: known.map((_, n) => series.reduce((sum, { values }) => sum + values[n], 0)) });
    this.stack.update(series, this.choice.selectedOptions[0].textContent, is_torque ? 'N m' : 'N');
    this.immersion.update([{ name: of_motion ? 'of drag and added mass' : 'of the volume', times: this.times,
                             values: known.map((loads) => (loads === null ? NaN : 100 * loads.immersion)) }]);
  }

  show(time) {
    this.stack.show(time);
    this.immersion.show(time);
  }
}

// The loads of a recorded run's body. columns: of its rows by name.
class RecordedLoads {
  constructor(body, columns) {
    const values = decode_numbers(body.loads.data, Float32Array);
    this.columns = columns;
    this.column = (i) => values.subarray(i * body.rows, (i + 1) * body.rows);  // as in LoadColumn, run.h
    this.source = body.loads;
  }

  at(row) {
    const immersion = this.column(0)[row];
    if (Number.isNaN(immersion)) return null;
    const six = (first) => [0, 1, 2, 3, 4, 5].map((i) => this.column(first + i)[row]);
    return { immersion, buoyancy: six(1), drag: six(7), added_mass: six(13), water_velocity: [19, 20, 21].map((i) => this.column(i)[row]),
             q: ['qw', 'qx', 'qy', 'qz'].map((name) => this.columns[name][row]) };
  }

  source_text() {
    const { recorded, computed, without_velocities } = this.source;
    const rows = (count) => plural(count, 'row', 'rows');
    const source = recorded === 0 ? 'The loads were computed from the scene.'
      : computed === 0 ? 'The loads are those that the service sent.'
        : `The loads of ${rows(recorded)} are those that the service sent; for ${rows(computed)} they were computed from the scene.`;
    return without_velocities && computed > 0 ? `${source} Where the run holds no velocities, they are those of a body at rest.` : source;
  }
}
