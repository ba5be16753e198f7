'use strict';
// Draws a mesh before and after its repair (service/mesh/mesh_page.h), with a painter's algorithm on plain canvases: a
// repaired hull is looked at once, so that nothing else needs to be installed or loaded.

const COLOURS = { kept: [86, 140, 180], changed: [230, 130, 20], open: '#d50032' };

function decode(text, Type) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Type(bytes.buffer);
}

class MeshPicture {
  // mesh: {parts: [{positions, indices, colour}], edges: x, y, z of both ends of each open edge}
  constructor(canvas, mesh, view) {
    this.canvas = canvas;
    this.view = view;
    this.parts = mesh.parts.map(({ positions, indices, colour }) => (
      { positions: decode(positions, Float32Array), indices: decode(indices, Uint32Array), colour: COLOURS[colour] }));
    this.edges = decode(mesh.edges, Float32Array);
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // The corners [right, up, depth], in pixels.
  project(positions, scale, width, height) {
    const { azimuth, elevation, centre } = this.view;
    const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
    const projected = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y, z] = [positions[i] - centre[0], positions[i + 1] - centre[1], positions[i + 2] - centre[2]];
      const forward = ca * x + sa * y;
      projected[i] = width / 2 + scale * (-sa * x + ca * y);
      projected[i + 1] = height / 2 - scale * (ce * z - se * forward);
      projected[i + 2] = scale * (ce * forward + se * z);
    }
    return projected;
  }

  // The visible triangles of a part with their depth and shade.
  triangles(part, scale, width, height, list) {
    const p = this.project(part.positions, scale, width, height);
    for (let i = 0; i < part.indices.length; i += 3) {
      const [a, b, c] = [3 * part.indices[i], 3 * part.indices[i + 1], 3 * part.indices[i + 2]];
      const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
      const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
      const facing = ux * vy - uy * vx;  // of the screen, where up is down: negative from outside
      const size = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, facing) || 1;
      const light = 0.35 + 0.65 * Math.abs(facing) / size;
      const shade = facing < 0 ? light : 0.45 * light;  // the inside is darker
      list.push({ inside: facing >= 0, depth: p[a + 2] + p[b + 2] + p[c + 2], at: [p[a], p[a + 1], p[b], p[b + 1], p[c], p[c + 1]],
                  colour: `rgb(${part.colour.map((value) => Math.round(value * shade)).join()})` });
    }
  }

  draw() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [this.canvas.clientWidth * ratio, this.canvas.clientHeight * ratio];
    if (width === 0 || height === 0) return;
    this.canvas.width = width;
    this.canvas.height = height;
    const context = this.canvas.getContext('2d');
    const scale = 0.85 * Math.min(width, height) / this.view.size * this.view.zoom;
    const list = [];
    for (const part of this.parts) this.triangles(part, scale, width, height, list);
    // Faces seen from the inside, through holes, come first: sorted by depth alone, large faces may be out of order.
    list.sort((one, other) => other.inside - one.inside || one.depth - other.depth);
    for (const { at, colour } of list) {
      context.fillStyle = context.strokeStyle = colour;
      context.beginPath();
      context.moveTo(at[0], at[1]);
      context.lineTo(at[2], at[3]);
      context.lineTo(at[4], at[5]);
      context.closePath();
      context.fill();
      context.stroke();  // so that no gap shows between neighbours
    }
    context.strokeStyle = COLOURS.open;
    context.lineWidth = 2 * ratio;
    context.beginPath();
    const ends = this.project(this.edges, scale, width, height);
    for (let i = 0; i < ends.length; i += 6) {
      context.moveTo(ends[i], ends[i + 1]);
      context.lineTo(ends[i + 3], ends[i + 4]);
    }
    context.stroke();
  }
}

function steer(pictures, view) {
  const redraw = () => pictures.forEach((picture) => picture.draw());
  const turn = (azimuth, elevation) => {
    view.azimuth += azimuth;
    view.elevation = Math.max(-1.57, Math.min(1.57, view.elevation + elevation));
    redraw();
  };
  const zoom = (factor) => {
    view.zoom = Math.max(0.2, Math.min(50, view.zoom * factor));
    redraw();
  };
  const keys = { ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1),
                 ArrowDown: () => turn(0, -0.1), '+': () => zoom(1.2), '-': () => zoom(1 / 1.2) };
  for (const { canvas } of pictures) {
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) turn(-0.01 * event.movementX, 0.01 * event.movementY);
    });
    canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      zoom(Math.exp(-0.001 * event.deltaY));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      if (!(event.key in keys)) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}

function show() {
  const data = JSON.parse(document.getElementById('data').textContent);
  document.title = `buoyancy: ${data.name}`;
  document.getElementById('title').textContent = data.name;
  document.getElementById('subtitle').textContent = data.summary;
  document.getElementById('report').textContent = data.report;
  document.getElementById('footer').textContent = `buoyancy-mesh ${data.version}`;
  const view = { azimuth: -0.9, elevation: 0.45, zoom: 1.2, centre: data.centre, size: data.size };
  const pictures = [new MeshPicture(document.getElementById('before'), data.before, view)];
  if (data.after) pictures.push(new MeshPicture(document.getElementById('after'), data.after, view));
  document.getElementById('after_figure').hidden = !data.after;
  const legend = document.getElementById('legend');
  for (const [colour, text] of [[`rgb(${COLOURS.kept.join()})`, 'as in the file'],
    [`rgb(${COLOURS.changed.join()})`, data.after ? 'before: removed or changed; after: added or changed' : ''],
    [COLOURS.open, 'open edge']]) {
    if (!text) continue;
    const item = document.createElement('li');
    item.innerHTML = '<i></i>';
    item.firstChild.style.setProperty('--colour', colour);
    item.append(text);
    legend.append(item);
  }
  steer(pictures, view);
  window.buoyancy_mesh = { data, pictures, view };
}

show();
