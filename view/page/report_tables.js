'use strict';
// The report's text beside picture and plots: what was recorded, what the scene and its meshes are, what was skipped.

// "3 bodies", "3 of 8 bodies".
function shown_text(data, bodies) {
  const recorded = data.bodies.filter((body) => body.recorded > 0).length;
  return recorded > bodies.length ? `${bodies.length.toLocaleString('en')} of ${plural(recorded, 'body', 'bodies')}` : plural(recorded, 'body', 'bodies');
}

// Ids that --bodies takes: the first of these bodies, as far as they follow one another.
function id_range(bodies) {
  let last = 0;
  while (last + 1 < Math.min(bodies.length, 1000) && bodies[last + 1].id === bodies[last].id + 1) ++last;
  return last === 0 ? String(bodies[0].id) : `${bodies[0].id}-${bodies[last].id}`;
}

// What the reader has to know before believing the plots.
function report_notices(data, bodies) {
  const notices = [];
  const recorded = bodies.reduce((sum, body) => sum + body.recorded, 0);
  const kept = bodies.reduce((sum, body) => sum + body.rows, 0);
  if (kept < recorded) {
    notices.push(`Thinned: ${plural(kept, 'row', 'rows')} of ${recorded.toLocaleString('en')} are in this page. Every row is as it was ` +
      'recorded, and the least and largest heave, roll, pitch, force, torque, energy and round trip of every stretch of time are among them.');
  }
  const others = data.bodies.filter((body) => !body.shown && body.recorded > 0);
  if (others.length > 0) {
    const why = data.selected ? 'those that --bodies chose' : 'the first that the run names, as many as fit into a page';
    notices.push(`Picture, plots and what was skipped are of ${plural(bodies.length, 'body', 'bodies')}: ${why}. Of ${plural(others.length, 'more', 'more')} ` +
      `the table "The bodies" says rows, statuses and the largest recorded force. To see others write a page with --bodies, such as --bodies ${id_range(others)}.`);
  }
  const absent = data.bodies.filter((body) => body.recorded === 0).length;
  if (absent > 0) notices.push(`${plural(absent, 'body', 'bodies')} of the scene ${absent === 1 ? 'has' : 'have'} no rows in ${data.file}.`);
  if (data.computed > 0) {
    notices.push(`${plural(data.computed, 'row has', 'rows have')} no recorded response: force and torque were computed from the scene.`);
  }
  if (data.sessions > 1) notices.push(`${plural(data.sessions, 'session', 'sessions')} asked; a clock that began again goes on behind the one before.`);
  if (data.unknown_bodies > 0) notices.push(`${plural(data.unknown_bodies, 'row', 'rows')} about bodies that the scene has not.`);
  for (const warning of data.warnings) notices.push(`Could not be read: ${warning}.`);
  if (data.suppressed_warnings > 0) notices.push(`${plural(data.suppressed_warnings, 'more place', 'more places')} could not be read.`);
  for (const mesh of data.model.meshes) {
    if (mesh.shown_triangles < mesh.triangles) {
      notices.push(`${mesh.name} is drawn with ${plural(mesh.shown_triangles, 'triangle', 'triangles')}; its forces are those of all ` +
        `${mesh.triangles.toLocaleString('en')}.`);
    }
  }
  return notices;
}

function skipped_table(bodies) {
  const rows = [];
  let saved = 0, spent = 0;
  for (const body of bodies) {
    const { unchanged, dry, wet, crossing, refused, bounds_ns: bounds, query_ns: query } = body.skipped;
    const name = body.description.name;
    const total = unchanged + dry + wet + crossing + refused;
    const add = (what, count, cost) => {
      if (count === 0) return;
      const gain = query === null || cost === null ? null : Math.max(0, 1e-9 * count * (query - cost));
      saved += gain || 0;
      spent += cost === null ? 0 : 1e-9 * count * cost;
      rows.push([`${body.id} ${name}`, what, count, `${(100 * count / total).toFixed(1)} %`,
                 cost === null ? '–' : seconds_text(1e-9 * cost), gain === null ? '–' : seconds_text(gain)]);
    };
    add('crosses the surface: computed', crossing, query);
    add('clear of the water: bounds alone', dry, bounds);
    add('wholly under water: bounds and constants', wet, bounds);
    add('same pose as before: last response', unchanged, query === null ? null : Math.min(bounds || 0, query));
    add('no response to its pose', refused, null);
  }
  const caption = 'What the poses let the service leave out, and what that saves beside computing every one ' +
    `(costs measured while this page was made; saved in all ${seconds_text(saved)}, spent ${seconds_text(spent)})`;
  return table_of(caption, ['body', 'its pose', 'rows', 'share', 'one costs', 'saved'], rows);
}

// Of the bodies that were not always answered; null: all were.
function status_table(bodies) {
  const rows = [];
  for (const body of bodies) {
    const counts = new Map();
    for (const status of body.columns.status) counts.set(status, (counts.get(status) || 0) + 1);
    if (counts.get(0) === body.rows) continue;
    for (const [status, count] of [...counts].sort(([a], [b]) => a - b)) {
      rows.push([`${body.id} ${body.description.name}`, status_text(status), count, `${(100 * count / body.rows).toFixed(1)} %`]);
    }
  }
  if (rows.length === 0) return null;
  const caption = 'Rows of this page by the status of their response: one that is not OK holds zeros, which the plots leave out';
  return table_of(caption, ['body', 'status', 'rows', 'share'], rows);
}

// Of every body of the scene.
function bodies_table(data) {
  const descriptions = new Map(data.model.bodies.map((body) => [body.id, body]));
  const statuses_text = (body) => {
    const known = body.statuses.reduce((sum, count) => sum + count, 0);
    const parts = body.statuses.map((count, status) => [status < statuses.length ? statuses[status][0] : 'of a later version', count]);
    return [...parts, ['no response recorded', body.recorded - known]].filter(([, count]) => count > 0)
      .map(([name, count]) => `${name} ${count.toLocaleString('en')}`).join(', ') || '–';
  };
  const rows = data.bodies.map((body) => [String(body.id), descriptions.get(body.id).name, body.recorded, statuses_text(body), body.largest_force, body.shown && body.rows > 0 ? 'yes' : 'no']);
  const caption = 'All bodies of the scene. Of a body that is not shown in picture and plots nothing was computed that its rows do not say';
  return table_of(caption, ['id', 'name', 'rows', 'rows by status', 'largest force, N', 'shown'], rows);
}

function report_tables(data, bodies) {
  const { water, bodies: described, meshes, simd_target: target } = data.model;
  const section = (title, ...content) => {
    const heading = document.createElement('h2');
    heading.textContent = title;
    document.getElementById('tables').append(heading, ...content);
  };
  section('The bodies', bodies_table(data));
  section('What was skipped', ...[skipped_table(bodies), status_table(bodies)].filter((table) => table !== null));
  if (data.status) {
    const status = data.status;
    section('Service status', table_of('The last status in the log, totals since its start', ['what', 'value'], [
      ['version', status.version], ['up for', `${format_number(status.uptime)} s`],
      ['requests', status.requests.toLocaleString('en')], ['computed', status.computed.toLocaleString('en')],
      ['retries', status.retries.toLocaleString('en')], ['superseded', status.superseded.toLocaleString('en')],
      ['rejected', status.rejected.toLocaleString('en')],
      ['bodies dry, wet, crossing, unchanged', [status.dry, status.wet, status.crossing, status.unchanged].map((count) => count.toLocaleString('en')).join(', ')],
      ['response time, median, 99 %, longest', [status.p50, status.p99, status.max].map(seconds_text).join(', ')]]));
  }
  section('The scene', table_of(
    `Water: level ${format_number(water.level)} m along [${water.up.join(', ')}], ${format_number(water.density)} kg/m³, gravity ${format_number(water.gravity)} m/s². ` +
    `Instructions: ${target}.`,
    ['id', 'name', 'mesh', 'method', 'tolerance', 'mass, kg', 'density, kg/m³'],
    described.map((body) => [String(body.id), body.name, meshes[body.mesh].name, body.method, body.tolerance, body.mass, body.density])));
  section('The meshes', table_of('As they were loaded', ['mesh', 'triangles', 'drawn', 'volume, m³', 'area, m²', 'diagonal, m', 'parts', 'what was found'],
    meshes.map((mesh) => [mesh.name, mesh.triangles, mesh.shown_triangles, mesh.volume, mesh.area, mesh.diagonal, mesh.components.length, mesh_findings(mesh)])));
}

function mesh_findings(mesh) {
  const findings = [mesh.closed ? 'closed' : `open: ${plural(mesh.boundary_edges, 'boundary edge', 'boundary edges')}`];
  const add = (count, one, many) => { if (count) findings.push(plural(count, one, many)); };
  add(mesh.non_manifold_edges, 'non-manifold edge', 'non-manifold edges');
  add(mesh.misoriented_edges, 'misoriented edge', 'misoriented edges');
  add(mesh.degenerate_faces, 'face without area', 'faces without area');
  add(mesh.dropped_faces, 'face dropped', 'faces dropped');
  add(mesh.duplicate_faces, 'duplicate face', 'duplicate faces');
  add(mesh.intersecting_pairs, 'pair of faces intersects', 'pairs of faces intersect');
  if (mesh.turned) findings.push('was inside out and has been turned');
  return findings.join('; ');
}
