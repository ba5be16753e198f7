'use strict';
// Draws compartments and tanks inside a translucent hull, and lists their condition. Only pages of scenes that have some
// contain this file.
//
// A condition is {flooded: [0 to 1, of each compartment], liquid_volumes: [m³, of each tank]}. Where it is undefined, the
// one of the scene file holds; null: it is unknown.

const subdivision_colours = { compartment: '#8a949c', flooded: '#cc2936', tank: '#454f58', liquid: '#7a1fa2', liquid_surface: '#ce93d8' };

// Returns the condition that holds for a body, with NaN if it is unknown. description: of the body, see scene_model.h.
function values_of({ compartments, tanks }, condition) {
  if (condition) return condition;
  const known = condition === undefined;
  return { flooded: compartments.map(({ flooded }) => (known ? flooded : NaN)),
           liquid_volumes: tanks.map(({ liquid_volume }) => (known ? liquid_volume : NaN)) };
}

// The part of a closed mesh below a plane with a given normal. As in the service, a vertex on the plane is above it.
class LevelCut {
  constructor(geometry) {
    this.points = geometry.getAttribute('position').array;
    this.corners = geometry.getIndex().array;
    this.heights = new Float64Array(this.points.length / 3);
    this.areas = new Float64Array(this.corners.length / 3);  // projected along the normal, negative at the bottom
  }

  // up: the normal [x, y, z], of length 1.
  turn(up) {
    const { points, corners, heights, areas } = this;
    this.up = up;
    for (let i = 0; i < heights.length; i += 1) heights[i] = up[0] * points[3 * i] + up[1] * points[3 * i + 1] + up[2] * points[3 * i + 2];
    this.lowest = heights.reduce((low, height) => Math.min(low, height), Infinity);
    this.highest = heights.reduce((high, height) => Math.max(high, height), -Infinity);
    const side = (from, to, axis) => points[3 * to + axis] - points[3 * from + axis];
    for (let t = 0; t < areas.length; t += 1) {
      const a = corners[3 * t], b = corners[3 * t + 1], c = corners[3 * t + 2];
      const ux = side(a, b, 0), uy = side(a, b, 1), uz = side(a, b, 2), vx = side(a, c, 0), vy = side(a, c, 1), vz = side(a, c, 2);
      areas[t] = 0.5 * (up[0] * (uy * vz - uz * vy) + up[1] * (uz * vx - ux * vz) + up[2] * (ux * vy - uy * vx));
    }
    this.volume = this.below(Infinity).volume;
  }

  // The volume below a level, and the area of the section there: the volume is the integral of the height over the level,
  // along the normal, over what is below.
  below(level) {
    const { corners, heights, areas } = this;
    const from = Math.min(level, this.highest + 1);
    let volume = 0, area = 0;
    for (let t = 0; t < areas.length; t += 1) {
      let a = heights[corners[3 * t]] - from, b = heights[corners[3 * t + 1]] - from, c = heights[corners[3 * t + 2]] - from;
      const below = (a < 0) + (b < 0) + (c < 0);
      if (below === 0) continue;
      let share = 1, mean = (a + b + c) / 3;
      if (below < 3) {  // a: the corner that is alone on its side
        const alone = below === 1;
        if ((b < 0) === alone) [a, b, c] = [b, c, a];
        else if ((c < 0) === alone) [a, b, c] = [c, a, b];
        const corner = a / (a - b) * (a / (a - c));
        share = alone ? corner : 1 - corner;
        mean = alone ? corner * a / 3 : mean - corner * a / 3;
      }
      volume += areas[t] * mean;
      area -= areas[t] * share;
    }
    return { volume, area };
  }

  // The level that has `volume` below it, from 0 to this.volume: Newton's method between bounds.
  level_of(volume) {
    let low = this.lowest, high = this.highest, level = 0.5 * (low + high);
    const tolerance = 1e-13 * (high - low);
    for (let i = 0; i < 100 && high - low > tolerance; i += 1) {
      const found = this.below(level);
      if (found.volume < volume) low = level;
      else high = level;
      const next = level + (volume - found.volume) / found.area;
      const step = next > low && next < high ? next : 0.5 * (low + high);
      if (Math.abs(step - level) <= tolerance) return step;
      level = step;
    }
    return level;
  }

  // Triangles below a level, three numbers per corner: {walls, surface}, the surface seen from above.
  cut(level) {
    const { points, corners, heights } = this;
    const walls = [];
    const links = new Map();  // the outline of the surface, anticlockwise: edge to {point, next edge}
    const key = (i, j) => (i < j ? i * heights.length + j : j * heights.length + i);
    const point = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
    // Interpolates from the lower to the upper vertex, so that both triangles of an edge have the same point.
    const crossing = (i, j) => {
      const [low, high] = heights[i] < heights[j] ? [i, j] : [j, i];
      const fraction = (level - heights[low]) / (heights[high] - heights[low]);
      const from = point(low);
      return point(high).map((coordinate, axis) => from[axis] + fraction * (coordinate - from[axis]));
    };
    for (let t = 0; t < corners.length; t += 3) {
      const below = [];
      let enters = -1, leaves = -1, at = null;
      for (let n = 0; n < 3; n += 1) {
        const i = corners[t + n], j = corners[t + (n + 1) % 3];
        const is_below = heights[i] < level;
        if (is_below) below.push(point(i));
        if (is_below === (heights[j] < level)) continue;
        const cut = crossing(i, j);
        below.push(cut);
        if (is_below) {
          leaves = key(i, j);
        } else {
          enters = key(i, j);
          at = cut;
        }
      }
      for (let n = 2; n < below.length; n += 1) walls.push(...below[0], ...below[n - 1], ...below[n]);
      if (at) links.set(enters, { point: at, next: leaves });
    }
    return { walls, surface: this.fill(this.outlines(links)) };
  }

  // Returns the links as closed sequences of points.
  outlines(links) {
    const found = [];
    while (links.size > 0) {
      const outline = [];
      let [edge] = links.keys();
      while (links.has(edge)) {  // a mesh that was reduced for drawing may have an edge of one triangle
        const link = links.get(edge);
        links.delete(edge);
        outline.push(link.point);
        edge = link.next;
      }
      if (outline.length > 2) found.push(outline);
    }
    return found;
  }

  // Triangles inside outlines, of which those that run clockwise are holes in the others.
  fill(outlines) {
    const [x, y, z] = this.up;
    const first = new THREE.Vector3(...(Math.abs(x) < 0.9 ? [1, 0, 0] : [0, 1, 0])).cross(new THREE.Vector3(x, y, z)).normalize();
    const second = new THREE.Vector3(x, y, z).cross(first);
    const flat = ([px, py, pz]) => new THREE.Vector2(first.x * px + first.y * py + first.z * pz, second.x * px + second.y * py + second.z * pz);
    const rings = outlines.map((points) => ({ points, flat: points.map(flat) }));
    const is_hole = (ring) => THREE.ShapeUtils.isClockWise(ring.flat);
    const triangles = [];
    for (const ring of rings) {
      if (is_hole(ring)) continue;
      const holes = rings.filter((other) => is_hole(other) && is_inside(other.flat[0], ring.flat));
      const faces = THREE.ShapeUtils.triangulateShape(ring.flat, holes.map((hole) => hole.flat));
      const all = [ring, ...holes].flatMap(({ points, flat: used }) => points.slice(0, used.length));  // a repeated last point is not used
      for (const face of faces) {
        for (const corner of face) triangles.push(...all[corner]);
      }
    }
    return triangles;
  }
}

// Returns whether a point is inside a polygon.
function is_inside(point, polygon) {
  let inside = false;
  polygon.forEach((to, i) => {
    const from = polygon[(i + polygon.length - 1) % polygon.length];
    if ((from.y > point.y) !== (to.y > point.y) && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x)) inside = !inside;
  });
  return inside;
}

// Returns a material with flat shading, as that of hulls has it.
function inner_material(colour, opacity) {
  return new THREE.ShaderMaterial({
    extensions: { derivatives: true },
    side: THREE.DoubleSide,
    transparent: true,
    depthWrite: opacity === 1,
    uniforms: { colour: { value: new THREE.Color(colour) }, opacity: { value: opacity } },
    vertexShader: `
      varying vec3 position_view;
      void main() {
        vec4 view = modelViewMatrix * vec4(position, 1.0);
        position_view = view.xyz;
        gl_Position = projectionMatrix * view;
      }`,
    fragmentShader: `
      uniform vec3 colour;
      uniform float opacity;
      varying vec3 position_view;
      void main() {
        vec3 normal = normalize(cross(dFdx(position_view), dFdy(position_view)));
        gl_FragColor = vec4(colour * (0.7 + 0.3 * abs(dot(normal, normalize(vec3(-0.4, 0.8, 0.5))))), opacity);
      }`,
  });
}

// Draws what is inside one body. renderOrder puts the liquids first, and the translucent hull over everything.
class SubdivisionDrawing {
  // group: of the body, in its frame. hull: its mesh, of hull_material(). model: see scene_model.h.
  constructor(group, hull, description, model, geometries) {
    this.group = group;
    this.description = description;
    hull.material.transparent = true;
    hull.material.side = THREE.FrontSide;
    hull.material.uniforms.opacity.value = 0.35;
    const add = (mesh, material, order, geometry = geometries[mesh]) => {
      const drawn = new THREE.Mesh(geometry, material);
      drawn.position.set(...model.meshes[mesh].center);
      drawn.renderOrder = order;
      group.add(drawn);
      return drawn;
    };
    const add_edges = (mesh, colour) => {
      const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometries[mesh], 20), new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.7 }));
      edges.position.set(...model.meshes[mesh].center);
      edges.renderOrder = -1;
      group.add(edges);
    };
    this.compartments = description.compartments.map(({ mesh }) => {
      add_edges(mesh, subdivision_colours.compartment);
      return add(mesh, inner_material(subdivision_colours.compartment, 0.3), -2);
    });
    this.tanks = description.tanks.map(({ mesh, capacity, density, piston_axis }) => {
      add_edges(mesh, subdivision_colours.tank);
      add(mesh, inner_material(subdivision_colours.tank, 0.12), -2);
      const part = (colour) => {
        const drawn = add(mesh, inner_material(colour, 1), -3, new THREE.BufferGeometry());
        drawn.frustumCulled = false;
        return drawn;
      };
      return { cut: new LevelCut(geometries[mesh]), centre: model.meshes[mesh].center, capacity, density, piston_axis, walls: part(subdivision_colours.liquid),
               surface: part(subdivision_colours.liquid_surface), shown: '' };
    });
  }

  // up_W: a vector. Precondition: the body's group has its pose.
  show(up_W, condition) {
    const { flooded, liquid_volumes } = values_of(this.description, condition);
    this.compartments.forEach(({ material }, i) => {
      const { colour, opacity } = material.uniforms;
      colour.value.set(subdivision_colours.compartment).lerp(new THREE.Color(subdivision_colours.flooded), flooded[i] || 0);
      opacity.value = 0.2 + 0.5 * (flooded[i] || 0);
    });
    if (this.tanks.length === 0) return;
    const up = up_W.clone().applyQuaternion(this.group.quaternion.clone().conjugate()).toArray();
    this.tanks.forEach((tank, i) => this.fill(tank, tank.piston_axis || up, liquid_volumes[i] || 0));
  }

  // up: in the body's frame, or the axis of a piston.
  fill(tank, up, volume) {
    const shown = [...up, volume].join(' ');
    if (tank.shown === shown) return;
    tank.shown = shown;
    const { cut } = tank;
    const share = volume / tank.capacity;  // the drawing of a large mesh is reduced, and has a volume of its own
    cut.turn(up);
    tank.level = cut.level_of(share * cut.volume);
    const { walls, surface } = share > 0 ? cut.cut(share < 1 ? tank.level : Infinity) : { walls: [], surface: [] };
    const replace = (mesh, numbers) => mesh.geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(numbers), 3));
    replace(tank.walls, walls);
    replace(tank.surface, surface);
    tank.mass = tank.density * volume;
    tank.moment = centroid([...walls, ...surface]).map((coordinate, axis) => tank.mass * (tank.centre[axis] + coordinate));
  }

  // A response's force is that of the water with the weight of the liquids. The picture has the force of the water, and the
  // weight of body and liquids at their common centre of mass.
  place_weight(scene, { description, markers, size, displacement_weight, group }, state) {
    const liquids = this.tanks.reduce((sum, { mass }) => sum + mass, 0);
    if (liquids === 0) return;
    const { gravity } = scene.model.water;
    const scale = 0.9 * size / displacement_weight;
    const is_wet = (state.status === 0 || state.status === null) && state.f.some((component) => component !== 0);
    if (is_wet && state.b) {
      const force = new THREE.Vector3(...state.f).addScaledVector(scene.up, liquids * gravity);
      scene.place_arrow(markers.force, new THREE.Vector3(...state.b).add(group.position), force, scale * force.length(), size);
    }
    if (description.center_of_mass === null || description.mass === null) return;
    const mass = description.mass + liquids;
    const centre = description.center_of_mass.map((coordinate, axis) => (
      (description.mass * coordinate + this.tanks.reduce((sum, { moment }) => sum + moment[axis], 0)) / mass));
    markers.centre_of_mass.position.set(...centre).applyQuaternion(group.quaternion).add(group.position);
    scene.place_arrow(markers.weight, markers.centre_of_mass.position, scene.up.clone().negate(), scale * mass * gravity, size);
  }
}

// Returns the centroid of what closed triangles enclose, three numbers per corner; the origin if they enclose nothing.
function centroid(triangles) {
  let volume = 0;
  const moment = [0, 0, 0];
  for (let i = 0; i < triangles.length; i += 9) {
    const [ax, ay, az, bx, by, bz, cx, cy, cz] = triangles.slice(i, i + 9);
    const part = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    volume += part;
    moment[0] += part * (ax + bx + cx) / 4;
    moment[1] += part * (ay + by + cy) / 4;
    moment[2] += part * (az + bz + cz) / 4;
  }
  return volume > 0 ? moment.map((coordinate) => coordinate / volume) : moment.fill(0);
}

// The compartments and tanks of a body with their condition, which may be undefined.
function subdivision_table(description, condition) {
  const { flooded, liquid_volumes } = values_of(description, condition);
  const rows = [
    ...description.compartments.map(({ name, volume, permeability }, i) => [
      name, 'compartment', volume, `permeability ${format_number(permeability)}`, 100 * flooded[i], null, null]),
    ...description.tanks.map(({ name, capacity, density }, i) => [
      name, 'tank', capacity, `${format_number(density)} kg/m³`, null, liquid_volumes[i], 100 * liquid_volumes[i] / capacity]),
  ];
  return table_of(`Compartments and tanks of body ${description.id} ${description.name}`,
                  ['name', '', 'volume, m³', '', 'flooded, %', 'liquid, m³', 'fill, %'], rows);
}

// The condition in a row of a recorded run. body: of the report's data, with its `conditions` if there were others than that
// of the scene file (report_page.h).
function condition_of_row({ conditions }, row) {
  if (!conditions) return undefined;
  if (!conditions.of_rows) conditions.of_rows = decode_numbers(conditions.rows, Uint32Array);
  return conditions.list[conditions.of_rows[row]];
}

// Shows the table of a body of the report at a time; for a body without compartments and tanks, the box is empty.
function show_recorded_condition(box, body, time) {
  const condition = condition_of_row(body, row_at(body.columns.time, time));
  box.replaceChildren(...(body.description.tanks ? [subdivision_table(body.description, condition)] : []));
}

// Adds the table of a body of the live view. now: its snapshot (snapshot_json.h).
function show_observed_condition(box, description, now) {
  if (!description.tanks) return;
  const body = now.bodies.find(({ id }) => id === description.id);
  box.append(subdivision_table(description, body && body.condition));
}

// Adds the meaning of the colours as list items.
function fill_subdivision_legend(list, bodies) {
  const has = (kind) => bodies.some((body) => body[kind] && body[kind].length > 0);
  const entries = [...(has('compartments') ? [['compartment', 'compartment'], ['flooded', 'flooded compartment']] : []),
                   ...(has('tanks') ? [['liquid', 'liquid in a tank'], ['liquid_surface', 'its free surface, or a piston']] : [])];
  for (const [colour, text] of entries) {
    const item = document.createElement('li');
    const sample = document.createElement('i');
    sample.style.setProperty('--colour', subdivision_colours[colour]);
    item.append(sample, text);
    list.append(item);
  }
}
