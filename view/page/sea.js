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

  significant_wave_height() {
    return 4 * Math.sqrt(0.5 * this.amplitude.reduce((sum, amplitude) => sum + amplitude * amplitude, 0));
  }
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
      const gap = Math.max(m > 0 ? x[m] - x[m - 1] : 0, m + 1 < lines ? x[m + 1] - x[m] : 0);
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

// The share of a wave that is drawn, by its wave number times the distance of the lines: all of a wave of four or more
// points, nothing of one of less than 2.5.
function shown_share(radians_per_line) {
  const points = 2 * Math.PI / radians_per_line;
  const x = Math.min(1, Math.max(0, (points - 2.5) / 1.5));
  return x * x * (3 - 2 * x);
}
