'use strict';
// The bodies of a scene in the water, drawn with three.js. model: what scene_model.h says.
//
// Lengths are metres, turned and placed as in the world frame W; all is drawn about an origin on the water, so that a
// body a thousand kilometres from W's own origin does not tremble in the graphics card's short numbers.
class WaterScene {
  static get colours() {
    return { sky: '#eaf3fa', water: '#56b4e9', dry: '#f0a30a', wet: '#0b4f8a', waterline: '#ffffff', force: '#009e73',
             weight: '#7a3b00', centre_of_buoyancy: '#009e73', centre_of_mass: '#111111', metacentre: '#cc79a7' };
  }

  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    this.up = new THREE.Vector3(...model.water.up);
    this.origin = null;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !drawn_by_the_processor() });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(WaterScene.colours.sky);
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.1, 1000);
    this.camera.up.copy(this.up);
    this.target = new THREE.Vector3();
    this.azimuth = -0.9;
    this.elevation = 0.22;
    // Two level directions, right-handed with up.
    const slant = Math.abs(this.up.x) < 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
    this.level_x = slant.addScaledVector(this.up, -slant.dot(this.up)).normalize();
    this.level_y = this.up.clone().cross(this.level_x);
    this.size = Math.max(...model.meshes.map((mesh) => mesh.diagonal));
    this.subject = this.size;  // of what the camera looks at
    this.distance = 2.4 * this.size;
    this.bodies = new Map();
    this.shapes = model.meshes.map((mesh) => this.shape(mesh));
    for (const body of model.bodies) this.bodies.set(body.id, this.body(body));
    this.add_water();
    this.listen();
    new ResizeObserver(() => this.render()).observe(canvas);
  }

  // bodies: [{id, status: or null, p, q: [w, x, y, z], f, b: or null, m: [point, point] or null}], as the messages have them.
  show(bodies) {
    for (const now of bodies) {
      const body = this.bodies.get(now.id);
      if (!body) continue;
      if (!is_pose(now.p, now.q)) {
        this.hide(body);
        continue;
      }
      if (!this.origin) this.place_origin(now.p);
      body.group.visible = true;
      body.group.position.copy(this.local(now.p));
      body.group.quaternion.set(now.q[1], now.q[2], now.q[3], now.q[0]).normalize();
      this.place_marks(body, now);
    }
  }

  hide(body) {
    for (const part of [body.group, ...Object.values(body.marks)]) part.visible = false;
  }

  // The camera goes with this body, or with the middle of all: sideways, so that heave can be seen.
  follow(id) {
    const shown = [...this.bodies.values()].filter((body) => body.group.visible && (id === null || body.description.id === id));
    if (shown.length === 0) return;
    const middle = new THREE.Vector3();
    for (const body of shown) middle.addScaledVector(body.group.position, 1 / shown.length);
    this.target.copy(middle.addScaledVector(this.up, -middle.dot(this.up)));
    let spread = 0;
    for (const body of shown) spread = Math.max(spread, body.group.position.distanceTo(middle) + 0.7 * body.size);
    const subject = id === null ? this.size : shown[0].size;
    // What was zoomed to is a part of the picture, not a distance: beside a ship a buoy would be a dot.
    if (this.zoomed) this.distance *= subject / this.subject;
    else this.distance = Math.max(2.4 * spread, 2.5 * subject);
    this.subject = subject;
    const cell = Math.pow(10, Math.round(Math.log10(0.3 * subject)));
    this.grid_cell.value = cell;
    const along = (axis) => Math.round(this.target.dot(axis) / cell) * cell;
    this.water.position.copy(this.level_x).multiplyScalar(along(this.level_x)).addScaledVector(this.level_y, along(this.level_y));
  }

  render() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
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
    // A larger body beside the one looked at is in the water too.
    this.camera.far = Math.max(80 * this.distance, 20 * this.size);
    this.fade.value = Math.max(20 * this.distance, 5 * this.size);
    this.camera.lookAt(this.target);
    this.camera.updateProjectionMatrix();
    this.size_marks(back.negate(), 2 * Math.tan(this.camera.fov * Math.PI / 360) / height);
    this.renderer.render(this.scene, this.camera);
  }

  turn(right, higher) {
    this.azimuth += right;
    this.elevation = Math.min(1.5, Math.max(-1.2, this.elevation + higher));
    this.render();
  }

  zoom(factor) {
    this.zoomed = true;
    this.distance = Math.min(500 * this.size, Math.max(0.3 * this.subject, this.distance * factor));
    this.render();
  }

  // Where a point of W is on the canvas, in CSS pixels from its upper left corner.
  project(point) {
    const at = this.local(point).project(this.camera);
    return [0.5 * (at.x + 1) * this.canvas.clientWidth, 0.5 * (1 - at.y) * this.canvas.clientHeight];
  }

  local(point) {
    return new THREE.Vector3(point[0] - this.origin[0], point[1] - this.origin[1], point[2] - this.origin[2]);
  }

  place_origin(point) {
    const up = this.model.water.up;
    const over = up[0] * point[0] + up[1] * point[1] + up[2] * point[2] - this.model.water.level;
    this.origin = point.map((coordinate, i) => coordinate - over * up[i]);
  }

  shape(mesh) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(numbers_of(mesh.positions, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(numbers_of(mesh.indices, Uint32Array), 1));
    geometry.computeBoundingSphere();
    return geometry;
  }

  body(description) {
    const colour = (name) => ({ value: new THREE.Color(WaterScene.colours[name]) });
    const mesh = this.model.meshes[description.mesh];
    const material = new THREE.ShaderMaterial({
      extensions: { derivatives: true },
      side: THREE.DoubleSide,
      uniforms: { up: { value: this.up }, dry: colour('dry'), wet: colour('wet'), waterline: colour('waterline'),
                  thinnest: { value: 0.002 * mesh.diagonal } },
      vertexShader: `
        varying vec3 at_W, at_view;
        void main() {
          vec4 world = modelMatrix * vec4(position, 1.0);
          vec4 view = viewMatrix * world;
          at_W = world.xyz;
          at_view = view.xyz;
          gl_Position = projectionMatrix * view;
        }`,
      // Faces are flat, as the solver sees them. The waterline is as wide as two pixels, whatever the slope.
      fragmentShader: `
        uniform vec3 up, dry, wet, waterline;
        uniform float thinnest;
        varying vec3 at_W, at_view;
        void main() {
          vec3 normal = normalize(cross(dFdx(at_view), dFdy(at_view)));
          float light = 0.58 + 0.42 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.8, 0.5))));
          float height = dot(at_W, up);
          float line = max(1.6 * fwidth(height), thinnest);
          vec3 colour = (height > 0.0 ? dry : wet) * light;
          gl_FragColor = vec4(abs(height) < line ? waterline : colour, 1.0);
        }`,
    });
    const drawn = new THREE.Mesh(this.shapes[description.mesh], material);
    drawn.position.set(...mesh.center);
    const group = new THREE.Group();
    group.add(drawn);
    group.visible = false;
    this.scene.add(group);
    const size = mesh.diagonal;
    const water = this.model.water;
    const marks = {
      force: this.arrow('force'),
      weight: this.arrow('weight'),
      centre_of_buoyancy: this.point('centre_of_buoyancy', new THREE.SphereGeometry(5, 20, 14)),
      centre_of_mass: this.point('centre_of_mass', new THREE.SphereGeometry(5, 20, 14)),
      // A ring, so that both are seen where it lies in the centre of mass.
      metacentre: this.point('metacentre', new THREE.RingGeometry(5, 8, 28)),
    };
    return { description, group, size, marks, whole_weight: water.density * water.gravity * Math.abs(mesh.volume) };
  }

  // Marks are seen through the hull.
  mark_material(name) {
    return new THREE.MeshBasicMaterial({ color: WaterScene.colours[name], depthTest: false, transparent: true });
  }

  // geometry: in pixels, as those of the arrows but for their length; size_marks() makes metres of them.
  point(name, geometry) {
    const point = new THREE.Mesh(geometry, this.mark_material(name));
    point.renderOrder = name === 'metacentre' ? 4 : 3;
    point.visible = false;
    this.scene.add(point);
    return point;
  }

  // Of length 1 along +y, scaled when it is shown.
  arrow(name) {
    const material = this.mark_material(name);
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

  // Marks stay as large on the screen however near the camera is, so that zooming parts what lies close together, but
  // never larger than a part of their body. ahead: where the camera looks; slope: of one pixel.
  size_marks(ahead, slope) {
    for (const { marks, size } of this.bodies.values()) {
      for (const mark of Object.values(marks)) {
        if (!mark.visible) continue;
        const pixel = Math.min(0.01 * size, slope * Math.max(this.camera.near, mark.position.clone().sub(this.camera.position).dot(ahead)));
        if (mark.head) {
          mark.head.scale.setScalar(pixel);
          mark.shaft.scale.x = mark.shaft.scale.z = pixel;
        } else {
          mark.scale.setScalar(pixel);
          mark.quaternion.copy(this.camera.quaternion);
        }
      }
    }
  }

  // length: m
  place_arrow(arrow, from, direction, length, size) {
    arrow.visible = length > 1e-3 * size;
    if (!arrow.visible) return;
    arrow.position.copy(from);
    arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction.clone().normalize());
    arrow.shaft.scale.y = length;
    arrow.shaft.position.y = 0.5 * length;
    arrow.head.position.y = length;
  }

  place_marks(body, now) {
    const at = body.group.position;
    const offset = (vector) => new THREE.Vector3(...vector).add(at);
    const place = (ball, point) => {
      ball.visible = point !== null && point.every(Number.isFinite);
      if (ball.visible) ball.position.copy(offset(point));
    };
    // A wrench without its centre of buoyancy acts at the body's origin.
    const wet = (now.status === 0 || now.status === null) && now.f.some((part) => part !== 0);
    place(body.marks.centre_of_buoyancy, wet ? now.b : null);
    const force = new THREE.Vector3(...now.f);
    const scale = 0.9 * body.size / body.whole_weight;
    if (wet) this.place_arrow(body.marks.force, offset(now.b || [0, 0, 0]), force, scale * force.length(), body.size);
    else body.marks.force.visible = false;
    place(body.marks.metacentre, now.m ? now.m[0] : null);
    const centre = body.description.center_of_mass;
    body.marks.centre_of_mass.visible = centre !== null;
    if (centre === null) return;
    body.marks.centre_of_mass.position.set(...centre).applyQuaternion(body.group.quaternion).add(at);
    const weight = (body.description.mass || 0) * this.model.water.gravity;
    this.place_arrow(body.marks.weight, body.marks.centre_of_mass.position, this.up.clone().negate(), scale * weight, body.size);
  }

  // A plane with a grid of metres, or of ten or a tenth, that fades into the sky before it ends.
  add_water() {
    this.grid_cell = { value: 1 };
    this.fade = { value: 1 };
    const material = new THREE.ShaderMaterial({
      extensions: { derivatives: true },
      side: THREE.DoubleSide,
      transparent: true,
      depthWrite: false,
      uniforms: { colour: { value: new THREE.Color(WaterScene.colours.water) }, cell: this.grid_cell, fade: this.fade },
      vertexShader: `
        uniform float fade;
        varying vec2 at;
        varying float away;
        void main() {
          at = position.xy * fade * 4.0;
          vec4 view = modelViewMatrix * vec4(at, 0.0, 1.0);
          away = length(view.xyz);
          gl_Position = projectionMatrix * view;
        }`,
      fragmentShader: `
        uniform vec3 colour;
        uniform float cell, fade;
        varying vec2 at;
        varying float away;
        void main() {
          vec2 cells = at / cell;
          vec2 width = fwidth(cells);
          vec2 lines = 1.0 - min(abs(fract(cells - 0.5) - 0.5) / max(width, 1e-6), 1.0);
          float line = max(lines.x, lines.y) * (1.0 - smoothstep(0.1, 0.5, max(width.x, width.y)));
          float clear = 1.0 - smoothstep(0.3 * fade, fade, away);
          gl_FragColor = vec4(mix(colour, 0.45 * colour, 0.5 * line), clear * (0.45 + 0.25 * line));
        }`,
    });
    this.water = new THREE.Mesh(new THREE.PlaneGeometry(1, 1, 64, 64), material);
    this.water.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
    this.water.renderOrder = 1;
    this.water.frustumCulled = false;
    this.scene.add(this.water);
  }

  // Drag turns, the wheel or two fingers zoom.
  listen() {
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
      else this.turn(-0.008 * dx, 0.008 * dy);
    });
    for (const end of ['pointerup', 'pointercancel']) {
      this.canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    }
    this.canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.001 * event.deltaY));
    }, { passive: false });
  }

  // For a page's keydown: true, it was one of the camera's keys.
  key(event) {
    const moves = { a: () => this.turn(-0.1, 0), d: () => this.turn(0.1, 0), w: () => this.turn(0, 0.08),
                    s: () => this.turn(0, -0.08), q: () => this.zoom(1 / 1.15), e: () => this.zoom(1.15) };
    const move = moves[event.key.toLowerCase()];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return false;
    move();
    return true;
  }
}

// p, q: [w, x, y, z]; as recorded.
function is_pose(p, q) {
  return p.every(Number.isFinite) && q.every(Number.isFinite) && q.some((part) => part !== 0);
}

// Smooth edges cost a processor that draws by itself a third of its frames.
function drawn_by_the_processor() {
  const probe = document.createElement('canvas').getContext('webgl');
  const information = probe && probe.getExtension('WEBGL_debug_renderer_info');
  const name = information ? probe.getParameter(information.UNMASKED_RENDERER_WEBGL) : '';
  const unneeded = probe && probe.getExtension('WEBGL_lose_context');
  if (unneeded) unneeded.loseContext();
  return /swiftshader|llvmpipe|softpipe|basic render/i.test(name);
}

// base64 of little-endian numbers, as base64.h writes them.
function numbers_of(text, Type) {
  const bytes = atob(text);
  const buffer = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; i += 1) buffer[i] = bytes.charCodeAt(i);
  return new Type(buffer.buffer);
}

// The scene on the canvas, or where the browser has no WebGL null and a sentence in its place.
function make_water_scene(canvas, model) {
  try {
    return new WaterScene(canvas, model);
  } catch (error) {
    const sentence = document.createElement('p');
    sentence.className = 'no-picture';
    sentence.textContent = 'This browser offers no WebGL, so the bodies are not drawn; plots and tables are all there.';
    canvas.parentElement.append(sentence);
    return null;
  }
}

// What the colours mean, as list items.
function fill_legend(list, with_mass, with_metacentre) {
  const entries = [['dry', 'hull, dry', ''], ['wet', 'hull, wetted', ''], ['waterline', 'waterline', 'bar'], ['water', 'water', ''],
                   ['force', 'buoyant force, at the centre of buoyancy', 'round']];
  if (with_mass) entries.push(['weight', 'weight', 'bar'], ['centre_of_mass', 'centre of mass', 'round']);
  if (with_metacentre) entries.push(['metacentre', 'metacentre (of the softer axis)', 'ring']);
  for (const [colour, text, shape] of entries) {
    const item = document.createElement('li');
    const sample = document.createElement('i');
    sample.className = shape;
    sample.style.setProperty('--colour', WaterScene.colours[colour]);
    item.append(sample, text);
    list.append(item);
  }
}
