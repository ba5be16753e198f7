'use strict';
// The sea as the service computes with it: linear waves over water at rest (src/waves/sea.h). data: see sea_json.h.
//
// All numbers are doubles. At the utime of today and at positions of kilometres, the rounding errors of all phases
// together move the surface by less than 1e-5 m per metre of wave amplitude.
class Sea {
  constructor(data) {
    for (const name of ['amplitude', 'apparent_frequency', 'wave_number', 'k1', 'k2', 'phase']) this[name] = Float64Array.from(data[name]);
    for (const name of ['e1', 'e2', 'up', 'level', 'depth', 'ramp', 'pressure']) this[name] = data[name];
    this.components = this.amplitude.length;
  }

  // The share of the amplitudes that the ramp has reached. t: [s]
  amplitude_factor(t) {
    if (!(t < this.ramp) || this.ramp === 0) return 1;
    return t > 0 ? 0.5 * (1 - Math.cos(Math.PI * t / this.ramp)) : 0;
  }

  // Returns the elevation [m] of the surface above the level at the distances x1, x2 [m] along e1, e2 from W's origin.
  elevation(x1, x2, t) {
    let sum = 0;
    for (let i = 0; i < this.components; i += 1) sum += this.amplitude[i] * Math.cos(this.phase_at(i, x1, x2, t));
    return this.amplitude_factor(t) * sum;
  }

  // Returns the phase [rad] of one component within half a turn of 0, where sines are accurate and cheap.
  phase_at(i, x1, x2, t) {
    const phase = this.k1[i] * x1 + this.k2[i] * x2 - this.apparent_frequency[i] * t + this.phase[i];
    return phase - 2 * Math.PI * Math.round(phase / (2 * Math.PI));
  }

  // Returns the wave number [rad/m] above which waves hold at most 2 % of the energy; 0 in a calm sea.
  largest_relevant_wave_number() {
    const order = Array.from(this.wave_number.keys()).sort((a, b) => this.wave_number[b] - this.wave_number[a]);
    const energy = (i) => this.amplitude[i] * this.amplitude[i];
    const enough = 0.02 * order.reduce((sum, i) => sum + energy(i), 0);
    let sum = 0;
    const found = order.find((i) => { sum += energy(i); return sum > enough; });
    return found === undefined ? 0 : this.wave_number[found];
  }

  // The lines on which a picture draws this sea.
  lines_of(count) { return new SeaGrid(this, count); }

  significant_wave_height() {
    return 4 * Math.sqrt(0.5 * this.amplitude.reduce((sum, amplitude) => sum + amplitude * amplitude, 0));
  }
}

// The surface of a sea that is known on grids, at the time of the request to which it belongs: bicubic splines, evaluated
// as ElevationSpline does (src/waves/elevation_spline.h). data: see surface_json() in sea_json.h.
class SplineSea {
  constructor(data) {
    for (const name of ['e1', 'e2', 'up']) this[name] = data[name];
    this.components = 0;
    this.version = 0;
    this.take(data);
    this.wave_number = this.typical_wave_number();
  }

  // Takes another surface of the same sea.
  take(data) {
    this.level = data.level;
    this.rise = data.surface.rise;
    this.parts = data.surface.parts.map((part) => ({ ...part, c: decode_numbers(part.coefficients, Float32Array) }));
    this.version += 1;
  }

  // Returns the elevation [m] over the level at the distances x1, x2 [m] along e1, e2 from W's origin; beyond a grid 0.
  elevation(x1, x2) {
    let sum = this.rise;
    for (const part of this.parts) {
      const at1 = place_in(part, 0, x1), at2 = place_in(part, 1, x2);
      if (at1 === null || at2 === null) return 0;
      const stride = part.cells[0] + 3;
      for (let n = 0; n < 4; n += 1) {
        const row = (at2.cell + n) * stride + at1.cell;
        let along = 0;
        for (let m = 0; m < 4; m += 1) along += at1.weights[m] * part.c[row + m];
        sum += part.share * at2.weights[n] * along;
      }
    }
    return this.parts.length > 0 ? sum : 0;
  }

  // [rad/m], of a regular wave with the same ratio of slope and elevation; 0 in a calm sea.
  typical_wave_number() {
    let slopes = 0, elevations = 0;
    for (const { c, cells, spacing } of this.parts.slice(0, 1)) {
      const stride = cells[0] + 3, mean = c.reduce((sum, value) => sum + value, 0) / c.length;
      for (let i = stride; i < c.length; i += 1) {
        if (i % stride === 0) continue;
        slopes += ((c[i] - c[i - 1]) / spacing[0]) ** 2 + ((c[i] - c[i - stride]) / spacing[1]) ** 2;
        elevations += (c[i] - mean) ** 2;
      }
    }
    return elevations > 0 ? Math.sqrt(slopes / elevations) : 0;
  }
  largest_relevant_wave_number() { return 1.5 * this.wave_number; }

  lines_of(count) { return new SplineGrid(this, count); }
}

// The cell of a spline at a coordinate [m] along e1 or e2 (axis 0 or 1), and the weights of its four coefficients there;
// null beyond the grid.
function place_in(part, axis, x) {
  const cells = part.cells[axis], position = (x - part.origin[axis]) / part.spacing[axis];
  let cell = Math.floor(position), t = position - cell;
  if (part.periodic) {
    cell -= cells * Math.floor(cell / cells);
  } else {
    if (!(position >= 0 && position <= cells)) return null;
    cell = Math.min(cell, cells - 1);
    t = position - cell;
  }
  const s = 1 - t;
  return { cell, weights: [s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6, (4 - 6 * s * s + 3 * s * s * s) / 6, t * t * t / 6] };
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The elevation of a sea over a grid: at the points (x[m], x[n]) relative to an anchor, at one time.
//
// A wave is a sum of two products, each of a function of one coordinate: with the phase p at the anchor,
// a cos(p + k1 x1 + k2 x2) = a cos(p + k2 x2) cos(k1 x1) - a sin(p + k2 x2) sin(k1 x1). The functions of x1 are tabulated
// once per grid. They are even and odd, and the lines are symmetric about the anchor, so that two points share each of
// the products: a new time costs a multiplication and an addition per point and component.
class SeaGrid {
  // lines: along either axis, an odd number. Nothing is allocated after the constructor.
  constructor(sea, lines) {
    const half = (lines + 1) / 2;
    this.sea = sea;
    this.lines = lines;
    this.half = half;
    this.x = new Float64Array(lines);  // [m], ascending, the same along both axes
    const table = (size) => new Float64Array(sea.components * size);
    this.cos1 = table(half);  // [component, line from the middle one on]
    this.sin1 = table(half);
    this.cos2 = table(lines);  // [component, line]
    this.sin2 = table(lines);
    this.anchor_cos = table(1);  // amplitude and phase at the anchor
    this.anchor_sin = table(1);
    this.even = new Float64Array(half);  // of one line of x2
    this.odd = new Float64Array(half);
    this.elevation = new Float32Array(lines * lines);  // [m], by line of x2, then line of x1
  }

  // coordinates: of the lines [m], ascending, symmetric about 0. Waves that the lines are too far apart to show are left
  // out there.
  place_lines(coordinates) {
    const { x, sea, lines, half } = this;
    x.set(coordinates);
    for (let m = 0; m < lines; m += 1) {
      const gap = this.gap_at(m);
      for (let i = 0; i < sea.components; i += 1) {
        const share = shown_share(sea.wave_number[i] * gap);
        this.cos2[i * lines + m] = share * Math.cos(sea.k2[i] * x[m]);
        this.sin2[i * lines + m] = share * Math.sin(sea.k2[i] * x[m]);
        if (m + 1 < half) continue;
        const at = i * half + m + 1 - half;
        this.cos1[at] = share * Math.cos(sea.k1[i] * x[m]);
        this.sin1[at] = share * Math.sin(sea.k1[i] * x[m]);
      }
    }
  }

  // [m], the largest distance of a line from those beside it.
  gap_at(m) {
    const { x, lines } = this;
    return Math.max(m > 0 ? x[m] - x[m - 1] : 0, m + 1 < lines ? x[m + 1] - x[m] : 0);
  }

  // Evaluates the sea at time t with the anchor at (anchor1, anchor2), [m] along e1 and e2 from W's origin.
  evaluate(anchor1, anchor2, t) {
    const { sea, lines, half, even, odd, elevation } = this;
    const factor = sea.amplitude_factor(t);
    for (let i = 0; i < sea.components; i += 1) {
      const phase = sea.phase_at(i, anchor1, anchor2, t);
      this.anchor_cos[i] = factor * sea.amplitude[i] * Math.cos(phase);
      this.anchor_sin[i] = factor * sea.amplitude[i] * Math.sin(phase);
    }
    for (let n = 0; n < lines; n += 1) {
      this.sum_line(n);
      const middle = n * lines + half - 1;
      for (let m = 0; m < half; m += 1) {
        elevation[middle + m] = even[m] - odd[m];
        elevation[middle - m] = even[m] + odd[m];
      }
    }
  }

  // Sums the even and the odd parts of all waves on one line of x2.
  sum_line(n) {
    const { even, odd, half, lines, cos1, sin1, cos2, sin2, anchor_cos, anchor_sin } = this;
    const components = this.sea.components;
    even.fill(0);
    odd.fill(0);
    const cosine = (i) => anchor_cos[i] * cos2[i * lines + n] - anchor_sin[i] * sin2[i * lines + n];
    const sine = (i) => anchor_sin[i] * cos2[i * lines + n] + anchor_cos[i] * sin2[i * lines + n];
    let i = 0;
    for (; i + 3 < components; i += 4) {  // four at a time, since each pass reads and writes the sums
      const a = i * half, b = a + half, c = b + half, d = c + half;
      const ca = cosine(i), cb = cosine(i + 1), cc = cosine(i + 2), cd = cosine(i + 3);
      const sa = sine(i), sb = sine(i + 1), sc = sine(i + 2), sd = sine(i + 3);
      for (let m = 0; m < half; m += 1) {
        even[m] += ca * cos1[a + m] + cb * cos1[b + m] + (cc * cos1[c + m] + cd * cos1[d + m]);
        odd[m] += sa * sin1[a + m] + sb * sin1[b + m] + (sc * sin1[c + m] + sd * sin1[d + m]);
      }
    }
    for (; i < components; i += 1) {
      const c = cosine(i), s = sine(i);
      for (let m = 0; m < half; m += 1) {
        even[m] += c * cos1[i * half + m];
        odd[m] += s * sin1[i * half + m];
      }
    }
  }

  // The index of the line at or before a coordinate, such that there is a line after it.
  line_before(coordinate) {
    const { x, half } = this;
    // The lines around the middle are equally spaced.
    const near = half - 1 + Math.floor(coordinate / (x[half] - x[half - 1]));
    if (near >= 0 && near + 1 < this.lines && x[near] <= coordinate && coordinate < x[near + 1]) return near;
    let low = 0, high = this.lines - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (x[middle] <= coordinate) low = middle;
      else high = middle;
    }
    return low;
  }

  // [m], on the surface as it is drawn: each cell consists of two triangles, divided by the diagonal from its corner
  // (m + 1, n) to (m, n + 1). u, v: [m] from the anchor; beyond the last line the surface goes on level.
  drawn_elevation(u, v) {
    const { x, lines, elevation } = this;
    const m = this.line_before(u), n = this.line_before(v);
    const a = Math.min(1, Math.max(0, (u - x[m]) / (x[m + 1] - x[m])));
    const b = Math.min(1, Math.max(0, (v - x[n]) / (x[n + 1] - x[n])));
    const at = n * lines + m;
    const right = elevation[at + 1], ahead = elevation[at + lines];
    if (a + b <= 1) {
      const corner = elevation[at];
      return corner + a * (right - corner) + b * (ahead - corner);
    }
    const corner = elevation[at + lines + 1];
    return corner + (1 - a) * (ahead - corner) + (1 - b) * (right - corner);
  }
}

// The same of a SplineSea: point by point, flatter where the lines are too far apart to show its waves.
class SplineGrid extends SeaGrid {
  place_lines(coordinates) {
    super.place_lines(coordinates);
    const wave_number = this.sea.largest_relevant_wave_number();
    this.share = Array.from(this.x, (_, m) => shown_share(wave_number * this.gap_at(m)));
  }

  evaluate(anchor1, anchor2) {
    const { sea, lines, x, share, elevation } = this;
    for (let n = 0; n < lines; n += 1) {
      for (let m = 0; m < lines; m += 1) {
        const shown = Math.min(share[m], share[n]);
        elevation[n * lines + m] = shown > 0 ? shown * sea.elevation(anchor1 + x[m], anchor2 + x[n]) : 0;
      }
    }
  }
}

// The share of a wave that is drawn, by its wave number times the distance of the lines: all of a wave of four or more
// points, nothing of one of less than 2.5.
function shown_share(radians_per_line) {
  const points = 2 * Math.PI / radians_per_line;
  const x = Math.min(1, Math.max(0, (points - 2.5) / 1.5));
  return x * x * (3 - 2 * x);
}
