'use strict';
// Renders the bodies of a scene in the water with three.js. model: see scene_model.h.
//
// Lengths are in metres, axes are those of the world frame W. Everything is drawn relative to an origin on the water near
// the bodies, because the graphics card's float32 is too coarse a thousand kilometres from W's origin.
class WaterScene {
  static get colours() {
    return { sky: '#eaf3fa', water: '#56b4e9', dry: '#f0a30a', wet: '#0b4f8a', waterline: '#ffffff', force: '#009e73',
             weight: '#7a3b00', centre_of_buoyancy: '#009e73', centre_of_mass: '#111111', metacentre: '#cc79a7',
             drag: '#d55e00', water_velocity: '#5b2a86' };
  }

  // [s/m], the length of an arrow of the water's velocity, in sizes of the body.
  static get size_per_speed() { return 0.5; }
  // Beside buoyancy and weight, drag is small: its arrow is this many times as long.
  static get drag_enlarged() { return 5; }

  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    this.up = new THREE.Vector3(...model.water.up);
    this.origin = null;
    this.software_rendering = uses_software_rendering();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.software_rendering });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(WaterScene.colours.sky);
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.1, 1000);
    this.camera.up.copy(this.up);
    this.target = new THREE.Vector3();
    this.azimuth = -0.9;
    this.elevation = 0.22;
    // Two horizontal directions, right-handed with up.
    const helper = Math.abs(this.up.x) < 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
    this.level_x = helper.addScaledVector(this.up, -helper.dot(this.up)).normalize();
    this.level_y = this.up.clone().cross(this.level_x);
    this.size = Math.max(...model.meshes.map((mesh) => mesh.diagonal));
    this.subject = this.size;  // size of what the camera looks at
    this.distance = 2.4 * this.size;
    this.bodies = new Map();
    this.geometries = model.meshes.map((mesh) => this.make_geometry(mesh));
    for (const body of model.bodies) this.bodies.set(body.id, this.make_body(body));
    this.add_water();
    this.waves = null;
    this.sea_time = NaN;
    this.poses_changed = false;
    this.add_listeners();
    new ResizeObserver(() => this.render()).observe(canvas);
  }

  // sea: a Sea, which is drawn from the next render() on, or null for water at rest.
  use_sea(sea) {
    if (this.waves) this.waves.remove();
    this.waves = sea ? new WaveSurface(this, sea) : null;
  }

  // bodies: [{id, status: or null, p, q: [w, x, y, z], f, b: or null, m: [point, point] or null, loads: or null or
  // undefined}]; see snapshot_json.h.
  // sea_time: [s], of the sea in waves.
  show(bodies, sea_time = NaN) {
    this.sea_time = sea_time;
    this.poses_changed = true;
    for (const state of bodies) {
      const body = this.bodies.get(state.id);
      if (!body) continue;
      if (!is_valid_pose(state.p, state.q)) {
        this.hide(body);
        continue;
      }
      if (!this.origin) this.place_origin(state.p);
      body.group.visible = true;
      body.group.position.copy(this.local(state.p));
      body.group.quaternion.set(state.q[1], state.q[2], state.q[3], state.q[0]).normalize();
      if (body.group.inside) body.group.inside.show(this.up, state.condition);  // only with subdivision
      this.place_markers(body, state);
      if (body.group.inside) body.group.inside.place_weight(this, body, state);  // only with subdivision
    }
  }

  hide(body) {
    for (const part of [body.group, ...Object.values(body.markers)]) part.visible = false;
  }

  // Moves the camera horizontally with this body, or with the centre of all if id is null, so that heave stays visible.
  follow(id) {
    const shown = [...this.bodies.values()].filter((body) => body.group.visible && (id === null || body.description.id === id));
    if (shown.length === 0) return;
    const centre = new THREE.Vector3();
    for (const body of shown) centre.addScaledVector(body.group.position, 1 / shown.length);
    this.target.copy(centre.addScaledVector(this.up, -centre.dot(this.up)));
    let spread = 0;
    for (const body of shown) spread = Math.max(spread, body.group.position.distanceTo(centre) + 0.7 * body.size);
    const subject = id === null ? this.size : shown[0].size;
    // The zoom is relative to the subject's size: at a ship's distance a buoy would be a dot.
    if (this.zoomed) this.distance *= subject / this.subject;
    else this.distance = Math.max(2.4 * spread, 2.5 * subject);
    this.subject = subject;
    const cell = Math.pow(10, Math.round(Math.log10(0.3 * subject)));
    this.grid_cell.value = cell;
    const along = (axis) => Math.round(this.target.dot(axis) / cell) * cell;
    this.water.position.copy(this.level_x).multiplyScalar(along(this.level_x)).addScaledVector(this.level_y, along(this.level_y));
  }

  // width, height: [CSS pixels], of the picture; those of the canvas on the page unless it is to be copied.
  render(width = this.canvas.clientWidth, height = this.canvas.clientHeight) {
    if (width === 0 || height === 0) return;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const back = new THREE.Vector3()
      .addScaledVector(this.level_x, Math.cos(this.elevation) * Math.cos(this.azimuth))
      .addScaledVector(this.level_y, Math.cos(this.elevation) * Math.sin(this.azimuth))
      .addScaledVector(this.up, Math.sin(this.elevation));
    this.camera.position.copy(this.target).addScaledVector(back, this.distance / Math.min(1, this.camera.aspect));
    this.camera.near = 0.01 * this.distance;
    // Keeps larger bodies beyond the followed one visible.
    this.camera.far = Math.max(80 * this.distance, 20 * this.size);
    this.fade.value = Math.max(20 * this.distance, 5 * this.size);
    this.camera.lookAt(this.target);
    this.camera.updateProjectionMatrix();
    if (this.waves) this.waves.update(this.sea_time, this.poses_changed);
    this.poses_changed = false;
    this.size_markers(back.negate(), 2 * Math.tan(this.camera.fov * Math.PI / 360) / height);
    this.renderer.render(this.scene, this.camera);
  }

  rotate(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(1.5, Math.max(-1.2, this.elevation + elevation));
    this.render();
  }

  zoom(factor) {
    this.zoomed = true;
    this.distance = Math.min(500 * this.size, Math.max(0.3 * this.subject, this.distance * factor));
    this.render();
  }

  // Projects a point of W to the canvas, in CSS pixels from its upper left corner.
  project(point) {
    const projected = this.local(point).project(this.camera);
    return [0.5 * (projected.x + 1) * this.canvas.clientWidth, 0.5 * (1 - projected.y) * this.canvas.clientHeight];
  }

  local(point) {
    return new THREE.Vector3(point[0] - this.origin[0], point[1] - this.origin[1], point[2] - this.origin[2]);
  }

  place_origin(point) {
    const up = this.model.water.up;
    const height = up[0] * point[0] + up[1] * point[1] + up[2] * point[2] - this.model.water.level;
    this.origin = point.map((coordinate, i) => coordinate - height * up[i]);
  }

  make_geometry(mesh) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(decode_numbers(mesh.positions, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(decode_numbers(mesh.indices, Uint32Array), 1));
    geometry.computeBoundingSphere();
    return geometry;
  }

  make_body(description) {
    const mesh = this.model.meshes[description.mesh];
    const drawn = new THREE.Mesh(this.geometries[description.mesh], hull_material(this.up, mesh.diagonal));
    drawn.position.set(...mesh.center);
    drawn.mesh_index = description.mesh;
    const group = new THREE.Group();
    group.add(drawn);
    if (description.tanks) group.inside = new SubdivisionDrawing(group, drawn, description, this.model, this.geometries);  // only with subdivision
    group.visible = false;
    this.scene.add(group);
    const size = mesh.diagonal;
    const water = this.model.water;
    const markers = {
      force: this.arrow('force'),
      weight: this.arrow('weight'),
      centre_of_buoyancy: this.point('centre_of_buoyancy', new THREE.SphereGeometry(5, 20, 14)),
      centre_of_mass: this.point('centre_of_mass', new THREE.SphereGeometry(5, 20, 14)),
      // A ring, so that both are visible if it coincides with the centre of mass.
      metacentre: this.point('metacentre', new THREE.RingGeometry(5, 8, 28)),
    };
    if (description.loads) Object.assign(markers, { drag: this.arrow('drag'), water_velocity: this.arrow('water_velocity') });
    return { description, group, drawn, size, markers, displacement_weight: water.density * water.gravity * Math.abs(mesh.volume) };
  }

  // Markers are visible through the hull.
  marker_material(name) {
    return new THREE.MeshBasicMaterial({ color: WaterScene.colours[name], depthTest: false, transparent: true });
  }

  // geometry: in pixels, same as the arrows except for their length; size_markers() scales it to metres.
  point(name, geometry) {
    const point = new THREE.Mesh(geometry, this.marker_material(name));
    point.renderOrder = name === 'metacentre' ? 4 : 3;
    point.visible = false;
    this.scene.add(point);
    return point;
  }

  // An arrow of length 1 along +y; place_arrow() scales it.
  arrow(name) {
    const material = this.marker_material(name);
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(1.9, 1.9, 1, 12), material);
    shaft.position.y = 0.5;
    const head = new THREE.Mesh(new THREE.ConeGeometry(6, 16, 16), material);
    head.position.y = 1;
    const arrow = new THREE.Group();
    arrow.add(shaft, head);
    arrow.head = head;
    arrow.shaft = shaft;
    for (const part of [shaft, head]) part.renderOrder = 2;
    arrow.visible = false;
    this.scene.add(arrow);
    return arrow;
  }

  // Keeps the size of markers on the screen independent of the zoom, so that zooming in separates adjacent ones, and
  // limits it relative to their body. ahead: the viewing direction; slope: the extent of a pixel at distance 1.
  size_markers(ahead, slope) {
    for (const { markers, size } of this.bodies.values()) {
      for (const marker of Object.values(markers)) {
        if (!marker.visible) continue;
        const pixel = Math.min(0.01 * size, slope * Math.max(this.camera.near, marker.position.clone().sub(this.camera.position).dot(ahead)));
        if (marker.head) {
          marker.head.scale.setScalar(pixel);
          marker.shaft.scale.x = marker.shaft.scale.z = pixel;
        } else {
          marker.scale.setScalar(pixel);
          marker.quaternion.copy(this.camera.quaternion);
        }
      }
    }
  }

  // length: [m]
  place_arrow(arrow, from, direction, length, size) {
    arrow.visible = length > 1e-3 * size;
    if (!arrow.visible) return;
    arrow.position.copy(from);
    arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction.clone().normalize());
    arrow.shaft.scale.y = length;
    arrow.shaft.position.y = 0.5 * length;
    arrow.head.position.y = length;
  }

  place_markers(body, state) {
    const position = body.group.position;
    const offset = (vector) => new THREE.Vector3(...vector).add(position);
    const place = (marker, point) => {
      marker.visible = point !== null && point.every(Number.isFinite);
      if (marker.visible) marker.position.copy(offset(point));
    };
    // A force without a centre of buoyancy is drawn at the body's origin.
    const is_wet = (state.status === 0 || state.status === null) && state.f.some((component) => component !== 0);
    place(body.markers.centre_of_buoyancy, is_wet ? state.b : null);
    // Where the parts of the force are known, the buoyant one is drawn, and drag by itself.
    const force = new THREE.Vector3(...(state.loads ? state.loads.buoyancy.slice(0, 3) : state.f));
    const scale = 0.9 * body.size / body.displacement_weight;
    if (is_wet) this.place_arrow(body.markers.force, offset(state.b || [0, 0, 0]), force, scale * force.length(), body.size);
    else body.markers.force.visible = false;
    if (body.description.loads) this.place_loads(body, state.loads, scale);
    place(body.markers.metacentre, state.m ? state.m[0] : null);
    const centre = body.description.center_of_mass;
    body.markers.centre_of_mass.visible = centre !== null;
    if (centre === null) return;
    body.markers.centre_of_mass.position.set(...centre).applyQuaternion(body.group.quaternion).add(position);
    const weight = (body.description.mass || 0) * this.model.water.gravity;
    this.place_arrow(body.markers.weight, body.markers.centre_of_mass.position, this.up.clone().negate(), scale * weight, body.size);
  }

  // loads: may be null or undefined. scale: [m/N], of forces.
  place_loads({ description, group, markers, size }, loads, scale) {
    const center = description.loads.drag_center;
    markers.drag.visible = markers.water_velocity.visible = false;
    if (!loads) return;
    const drag = new THREE.Vector3(...loads.drag.slice(0, 3));
    if (center) {
      const from = new THREE.Vector3(...center).applyQuaternion(group.quaternion).add(group.position);
      this.place_arrow(markers.drag, from, drag, WaterScene.drag_enlarged * scale * drag.length(), size);
    }
    const velocity = new THREE.Vector3(...loads.water_velocity);
    const above = this.up.clone().multiplyScalar(0.6 * size).add(group.position);
    this.place_arrow(markers.water_velocity, above, velocity, WaterScene.size_per_speed * size * velocity.length(), size);
  }

  // A plane with a grid whose cells are a power of ten of metres; it fades into the sky before its edge.
  add_water() {
    this.grid_cell = { value: 1 };
    this.fade = { value: 1 };
    const material = water_material(this.grid_cell, this.fade, `
      uniform float fade;
      varying vec2 point;
      varying float camera_distance;
      void main() {
        point = position.xy * fade * 4.0;
        vec4 view = modelViewMatrix * vec4(point, 0.0, 1.0);
        camera_distance = length(view.xyz);
        gl_Position = projectionMatrix * view;
      }`);
    this.water = new THREE.Mesh(new THREE.PlaneGeometry(1, 1, 64, 64), material);
    this.water.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
    this.water.renderOrder = 1;
    this.water.frustumCulled = false;
    this.scene.add(this.water);
  }

  // Dragging rotates the camera; the wheel and two fingers zoom.
  add_listeners() {
    const fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    this.canvas.addEventListener('pointermove', (event) => {
      const finger = fingers.get(event.pointerId);
      if (!finger) return;
      const before = fingers.size === 2 ? spread() : 0;
      const dx = event.clientX - finger.x, dy = event.clientY - finger.y;
      finger.x = event.clientX;
      finger.y = event.clientY;
      if (fingers.size === 2) this.zoom(before / Math.max(1, spread()));
      else this.rotate(-0.008 * dx, 0.008 * dy);
    });
    for (const end of ['pointerup', 'pointercancel']) {
      this.canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    }
    this.canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.001 * event.deltaY));
    }, { passive: false });
  }

  // Handles a keydown event of the page; returns true if it was a key of the camera.
  key(event) {
    const moves = { a: () => this.rotate(-0.1, 0), d: () => this.rotate(0.1, 0), w: () => this.rotate(0, 0.08),
                    s: () => this.rotate(0, -0.08), q: () => this.zoom(1 / 1.15), e: () => this.zoom(1.15) };
    const move = moves[event.key.toLowerCase()];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return false;
    move();
    return true;
  }
}

// p: position; q: quaternion [w, x, y, z]. Its norm is 1 within the tolerance of messages (body_evaluation.h).
function is_valid_pose(p, q) {
  return p.every(Number.isFinite) && Math.abs(Math.hypot(...q) - 1) <= 1e-3;
}

// Returns whether WebGL renders in software, where antialiasing costs a third of the frame rate.
function uses_software_rendering() {
  const probe = document.createElement('canvas').getContext('webgl');
  const information = probe && probe.getExtension('WEBGL_debug_renderer_info');
  const name = information ? probe.getParameter(information.UNMASKED_RENDERER_WEBGL) : '';
  const lose_context = probe && probe.getExtension('WEBGL_lose_context');
  if (lose_context) lose_context.loseContext();
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

// Decodes base64 of little-endian numbers (base64.h).
function decode_numbers(text, Type) {
  const bytes = atob(text);
  const buffer = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; i += 1) buffer[i] = bytes.charCodeAt(i);
  return new Type(buffer.buffer);
}

// Returns the scene on the canvas; without WebGL, null, and shows a message in its place.
function make_water_scene(canvas, model) {
  try {
    return new WaterScene(canvas, model);
  } catch (error) {
    const message = document.createElement('p');
    message.className = 'no-picture';
    message.textContent = 'This browser does not support WebGL, so the bodies are not drawn. Plots and tables are complete.';
    canvas.parentElement.append(message);
    return null;
  }
}

// Adds the meaning of the colours as list items. with_loads: the descriptions of the bodies whose loads can be known.
function fill_legend(list, with_mass, with_metacentre, with_loads = []) {
  const entries = [['dry', 'dry hull', ''], ['wet', 'wetted hull', ''], ['waterline', 'waterline', 'bar'], ['water', 'water', 'water'],
                   ['force', 'buoyant force, at the centre of buoyancy', 'round']];
  if (with_mass) entries.push(['weight', 'weight', 'bar'], ['centre_of_mass', 'centre of mass', 'round']);
  if (with_metacentre) entries.push(['metacentre', 'metacentre (of the softer axis)', 'ring']);
  if (with_loads.some((body) => body.loads.drag_center)) entries.push(['drag', `drag, ${WaterScene.drag_enlarged} times as long as other forces`, 'bar']);
  if (with_loads.length > 0) entries.push(['water_velocity', 'velocity of the water, half the body\'s diagonal per m/s', 'bar']);
  for (const [colour, text, shape] of entries) {
    const item = document.createElement('li');
    const sample = document.createElement('i');
    sample.className = shape;
    sample.style.setProperty('--colour', WaterScene.colours[colour]);
    item.append(sample, text);
    list.append(item);
  }
}
