'use strict';
// Draws a sea in a WaterScene: the moving surface, and the heights of the hulls' vertices over it, from which the
// hull's shader takes what is dry, what is wetted, and the waterline.
//
// The surface is a grid of lines along e1 and e2: equally spaced around the point that the camera looks at, and farther
// and farther apart from there to where the water fades into the sky.
class WaveSurface {
  static get min_lines() { return 45; }
  // Software rendering takes about a microsecond per point.
  static max_lines(software_rendering) { return software_rendering ? 101 : 145; }
  // The maximum number of points times components; evaluating them takes a few milliseconds.
  static get max_work() { return 4e6; }

  constructor(water_scene, sea) {
    this.water_scene = water_scene;
    this.sea = sea;
    this.e1 = new THREE.Vector3(...sea.e1);
    this.e2 = new THREE.Vector3(...sea.e2);
    this.up = new THREE.Vector3(...sea.up);
    const affordable = Math.sqrt(WaveSurface.max_work / Math.max(1, sea.components));
    const max_lines = WaveSurface.max_lines(water_scene.software_rendering);
    const lines = 2 * Math.floor(0.5 * Math.min(max_lines, Math.max(WaveSurface.min_lines, affordable))) + 1;
    this.outer_lines = Math.round(0.15 * lines);  // on each side
    this.core_lines = lines - 2 * this.outer_lines;
    this.grid = sea.lines_of(lines);
    this.coordinates = new Float64Array(lines);
    this.wavelength = 2 * Math.PI / sea.largest_relevant_wave_number();
    this.spacing = this.reach = this.anchor1 = this.anchor2 = this.time = NaN;  // of what is drawn
    this.version = 0;
    this.add_surface(lines);
    for (const body of water_scene.bodies.values()) this.add_heights(body);
  }

  // [m], over that of the scene: a received sea has a level of its own.
  get level() { return this.sea.level - this.water_scene.model.water.level; }

  // Draws water at rest again.
  remove() {
    this.water_scene.scene.remove(this.surface);
    this.surface.geometry.dispose();
    this.surface.material.dispose();
    for (const { drawn } of this.water_scene.bodies.values()) {
      drawn.geometry.dispose();
      drawn.geometry = this.water_scene.geometries[drawn.mesh_index];
      delete drawn.material.defines.WAVES;
      drawn.material.needsUpdate = true;
    }
    this.water_scene.water.visible = true;
  }

  // To be called before each frame; computes only what has changed. time: [s], of the sea; NaN: not known yet.
  update(time, poses_changed) {
    const { origin, target, water } = this.water_scene;
    const is_known = origin !== null && Number.isFinite(time);
    this.surface.visible = is_known;
    water.visible = !is_known;
    if (!is_known) return;
    const grid_changed = this.place_grid();
    // The anchor is on a multiple of the spacing, so that points stay in their places when the camera moves.
    const anchor1 = this.spacing * Math.round(target.dot(this.e1) / this.spacing);
    const anchor2 = this.spacing * Math.round(target.dot(this.e2) / this.spacing);
    const version = this.sea.version || 0;  // of a SplineSea
    const changed = grid_changed || time !== this.time || version !== this.version || anchor1 !== this.anchor1 || anchor2 !== this.anchor2;
    if (changed) {
      Object.assign(this, { time, version, anchor1, anchor2 });
      this.grid.evaluate(dot(this.sea.e1, origin) + anchor1, dot(this.sea.e2, origin) + anchor2, time);
      this.fill_surface();
    }
    if (!changed && !poses_changed) return;
    for (const body of this.water_scene.bodies.values()) {
      if (body.group.visible) this.fill_heights(body);
    }
  }

  // Chooses the lines for the camera's distance; returns whether they have changed.
  place_grid() {
    const { distance, fade } = this.water_scene;
    // Eight points per wavelength, or as many as fit what the camera looks at; at least a point per ten pixels or so.
    const core = this.core_lines - 1;
    const wanted = Math.min(4 * distance / core, Math.max(this.wavelength / 8, 1.2 * distance / core));
    const in_steps = (length) => Math.pow(2, 0.5 * Math.round(2 * Math.log2(length)));  // zooming changes few grids
    const spacing = in_steps(wanted), reach = in_steps(1.5 * fade.value);
    if (spacing === this.spacing && reach === this.reach) return false;
    Object.assign(this, { spacing, reach });
    const half = 0.5 * core * spacing;
    const growth = growth_to_reach((reach - half) / spacing, this.outer_lines);
    const lines = this.coordinates.length;
    for (let m = 0; m < this.core_lines; m += 1) this.coordinates[this.outer_lines + m] = m * spacing - half;
    let outer = half, gap = spacing;
    for (let m = 0; m < this.outer_lines; m += 1) {
      gap *= growth;
      outer += gap;
      this.coordinates[this.outer_lines + this.core_lines + m] = outer;
      this.coordinates[this.outer_lines - 1 - m] = -outer;
    }
    this.grid.place_lines(this.coordinates);
    const position = this.surface.geometry.attributes.position;
    for (let n = 0, at = 0; n < lines; n += 1) {
      for (let m = 0; m < lines; m += 1, at += 3) {
        position.array[at] = this.coordinates[m];
        position.array[at + 1] = this.coordinates[n];
      }
    }
    position.needsUpdate = true;
    return true;
  }

  add_surface(lines) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(3 * lines * lines), 3));
    // Elevation, and its slopes along e1 and e2.
    const water = new THREE.BufferAttribute(new Float32Array(3 * lines * lines), 3);
    geometry.setAttribute('water', water.setUsage(THREE.DynamicDrawUsage));
    const indices = new Uint16Array(6 * (lines - 1) * (lines - 1));
    for (let n = 0, at = 0; n + 1 < lines; n += 1) {
      for (let m = 0; m + 1 < lines; m += 1, at += 6) {
        const corner = n * lines + m;
        indices.set([corner, corner + 1, corner + lines, corner + 1, corner + lines + 1, corner + lines], at);
      }
    }
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    this.anchor = { value: new THREE.Vector2() };
    const { grid_cell, fade } = this.water_scene;
    const material = water_material(grid_cell, fade, `
      attribute vec3 water;
      uniform vec2 anchor;
      varying vec2 point;
      varying float camera_distance, light;
      void main() {
        point = anchor + position.xy;
        light = clamp(1.0 + dot(water.yz, vec2(0.9, -0.6)), 0.6, 1.4);
        vec4 view = modelViewMatrix * vec4(position.xy, water.x, 1.0);
        camera_distance = length(view.xyz);
        gl_Position = projectionMatrix * view;
      }`, { WAVES: true }, { anchor: this.anchor });
    this.surface = new THREE.Mesh(geometry, material);
    this.surface.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(this.e1, this.e2, this.up));
    this.surface.renderOrder = 1;
    this.surface.frustumCulled = false;
    this.water_scene.scene.add(this.surface);
  }

  fill_surface() {
    const { x, elevation, lines } = this.grid;
    const water = this.surface.geometry.attributes.water;
    for (let n = 0, at = 0; n < lines; n += 1) {
      const before = Math.max(0, n - 1), after = Math.min(lines - 1, n + 1);
      for (let m = 0; m < lines; m += 1, at += 3) {
        const left = Math.max(0, m - 1), right = Math.min(lines - 1, m + 1);
        water.array[at] = this.level + elevation[n * lines + m];
        water.array[at + 1] = (elevation[n * lines + right] - elevation[n * lines + left]) / (x[right] - x[left]);
        water.array[at + 2] = (elevation[after * lines + m] - elevation[before * lines + m]) / (x[after] - x[before]);
      }
    }
    water.needsUpdate = true;
    this.anchor.value.set(this.anchor1, this.anchor2);
    this.surface.position.copy(this.e1).multiplyScalar(this.anchor1).addScaledVector(this.e2, this.anchor2);
  }

  // The shape of a mesh with triangles small enough for a curved waterline.
  refined_geometry(mesh_index) {
    const { geometries, model, bodies } = this.water_scene;
    const shape = geometries[mesh_index];
    if (shape.refined) return shape.refined;
    const max_edge = model.meshes[mesh_index].diagonal / 32, max_added = 20000 / bodies.size;
    const { positions, indices } = refined_triangles(shape.attributes.position.array, shape.index.array, max_edge, max_added);
    shape.refined = new THREE.BufferGeometry();
    shape.refined.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    shape.refined.setIndex(new THREE.BufferAttribute(indices, 1));
    return shape.refined;
  }

  // Gives the body a geometry of its own, with the heights of its vertices over the water.
  add_heights(body) {
    const { drawn } = body;
    const shared = this.refined_geometry(drawn.mesh_index);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', shared.attributes.position);
    geometry.setIndex(shared.index);
    const heights = new THREE.BufferAttribute(new Float32Array(shared.attributes.position.count), 1);
    geometry.setAttribute('height_over_water', heights.setUsage(THREE.DynamicDrawUsage));
    geometry.boundingSphere = this.water_scene.geometries[drawn.mesh_index].boundingSphere;
    drawn.geometry = geometry;
    drawn.material.defines.WAVES = true;
    drawn.material.needsUpdate = true;
  }

  // Sets s = zeta - eta at the vertices, with eta of the surface as it is drawn, so that the waterline is where the two
  // meet.
  fill_heights(body) {
    const { position, height_over_water: heights } = body.drawn.geometry.attributes;
    const { matrix, along1, along2, upwards } = WaveSurface.scratch;
    body.group.updateMatrixWorld();
    matrix.copy(body.drawn.matrixWorld).transpose();
    // The height along an axis is linear in the vertex: axis . (R v + p) = (R^T axis) . v + axis . p.
    const linear = (axis, out) => {
      out.set(axis.x, axis.y, axis.z, 0).applyMatrix4(matrix);
      return out;
    };
    linear(this.e1, along1);
    linear(this.e2, along2);
    linear(this.up, upwards);
    const vertices = position.array, count = position.count;
    for (let i = 0, at = 0; i < count; i += 1, at += 3) {
      const x = vertices[at], y = vertices[at + 1], z = vertices[at + 2];
      const u = along1.x * x + along1.y * y + along1.z * z + along1.w - this.anchor1;
      const v = along2.x * x + along2.y * y + along2.z * z + along2.w - this.anchor2;
      const zeta = upwards.x * x + upwards.y * y + upwards.z * z + upwards.w;
      heights.array[i] = zeta - this.level - this.grid.drawn_elevation(u, v);
    }
    heights.needsUpdate = true;
  }
}
WaveSurface.scratch = { matrix: new THREE.Matrix4(), along1: new THREE.Vector4(), along2: new THREE.Vector4(), upwards: new THREE.Vector4() };

// The factor by which gaps have to grow from 1, such that `count` of them have the length `reach`.
function growth_to_reach(reach, count) {
  let low = 1, high = 8;
  for (let step = 0; step < 50; step += 1) {
    const growth = 0.5 * (low + high);
    let length = 0, gap = 1;
    for (let i = 0; i < count; i += 1) { gap *= growth; length += gap; }
    if (length < reach) low = growth;
    else high = growth;
  }
  return low;
}

// Divides triangles with an edge longer than max_edge into equal parts, since a waterline is straight within a triangle;
// into fewer if that makes more than max_added triangles. Returns { positions, indices }.
function refined_triangles(positions, indices, max_edge, max_added) {
  const corner = (index) => [positions[3 * index], positions[3 * index + 1], positions[3 * index + 2]];
  const longest_edges = [];
  for (let at = 0; at < indices.length; at += 3) {
    const [a, b, c] = [corner(indices[at]), corner(indices[at + 1]), corner(indices[at + 2])];
    longest_edges.push(Math.max(distance_of(a, b), distance_of(b, c), distance_of(c, a)));
  }
  const parts_of = (edge) => Math.max(1, Math.ceil(edge / max_edge));
  const added = () => longest_edges.reduce((sum, edge) => sum + parts_of(edge) ** 2 - 1, 0);
  while (added() > max_added) max_edge *= 1.25;
  const refined_positions = Array.from(positions), refined_indices = [];
  for (let at = 0; at < indices.length; at += 3) {
    const [a, b, c] = [corner(indices[at]), corner(indices[at + 1]), corner(indices[at + 2])];
    const parts = parts_of(longest_edges[at / 3]);
    if (parts === 1) {
      refined_indices.push(indices[at], indices[at + 1], indices[at + 2]);
      continue;
    }
    // Rows of points parallel to the side from a to b; row i has parts - i + 1 points.
    let row = refined_positions.length / 3;
    for (let i = 0; i <= parts; i += 1) {
      const next = row + parts - i + 1;
      for (let j = 0; j + i <= parts; j += 1) {
        for (let k = 0; k < 3; k += 1) refined_positions.push(a[k] + (j * (b[k] - a[k]) + i * (c[k] - a[k])) / parts);
        if (j + i < parts) refined_indices.push(row + j, row + j + 1, next + j);
        if (j + i + 1 < parts) refined_indices.push(row + j + 1, next + j + 1, next + j);
      }
      row = next;
    }
  }
  return { positions: Float32Array.from(refined_positions), indices: Uint32Array.from(refined_indices) };
}

function distance_of(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
