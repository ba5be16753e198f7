'use strict';
// The notices and tables of the report: recorded rows, evaluations, statuses, scene and meshes.

// "3 bodies", "3 of 8 bodies"
function shown_text(data, bodies) {
  const recorded = data.bodies.filter((body) => body.recorded > 0).length;
  return recorded > bodies.length ? `${bodies.length.toLocaleString('en')} of ${plural(recorded, 'body', 'bodies')}` : plural(recorded, 'body', 'bodies');
}

// An id or a range of consecutive ids for --bodies, starting with the first of these bodies.
function id_range(bodies) {
  let last = 0;
  while (last + 1 < Math.min(bodies.length, 1000) && bodies[last + 1].id === bodies[last].id + 1) ++last;
  return last === 0 ? String(bodies[0].id) : `${bodies[0].id}-${bodies[last].id}`;
}

// Limitations of the displayed data.
function report_notices(data, bodies) {
  const notices = [];
  const recorded = bodies.reduce((sum, body) => sum + body.recorded, 0);
  const kept = bodies.reduce((sum, body) => sum + body.rows, 0);
  if (kept < recorded) {
    notices.push(`Decimated: the page contains ${plural(kept, 'row', 'rows')} of ${recorded.toLocaleString('en')}. They are unmodified and include ` +
      'the minimum and maximum heave, roll, pitch, force, torque, energy and round trip of every time interval.');
  }
  const others = data.bodies.filter((body) => !body.shown && body.recorded > 0);
  if (others.length > 0) {
    const reason = data.selected ? 'selected with --bodies' : 'the first in the run, up to the limit of a page';
    notices.push(`The 3D view, the plots and the evaluations show ${plural(bodies.length, 'body', 'bodies')} (${reason}). For ${plural(others.length, 'other body', 'other bodies')}, ` +
      `the table "The bodies" lists rows, statuses and the largest recorded force. To show them, write a page with --bodies, such as --bodies ${id_range(others)}.`);
  }
  const absent = data.bodies.filter((body) => body.recorded === 0).length;
  if (absent > 0) notices.push(`${plural(absent, 'body', 'bodies')} of the scene ${absent === 1 ? 'has' : 'have'} no rows in ${data.file}.`);
  if (data.computed > 0) {
    notices.push(`${plural(data.computed, 'row has', 'rows have')} no recorded response; force and torque were computed from the scene.`);
  }
  if (data.sessions > 1) notices.push(`The run contains ${plural(data.sessions, 'session', 'sessions')}; after a restart of the clock, time continues after the previous rows.`);
  if (data.unknown_bodies > 0) notices.push(`${plural(data.unknown_bodies, 'row', 'rows')} about bodies that are not in the scene.`);
  notices.push(...data.notices);
  for (const warning of data.warnings) notices.push(`Input error: ${warning}.`);
  if (data.suppressed_warnings > 0) notices.push(`${plural(data.suppressed_warnings, 'more input error', 'more input errors')} not shown.`);
  for (const mesh of data.model.meshes) {
    if (mesh.shown_triangles < mesh.triangles) {
      notices.push(`${mesh.name} is drawn with ${plural(mesh.shown_triangles, 'triangle', 'triangles')}; forces are computed with all ` +
        `${mesh.triangles.toLocaleString('en')}.`);
    }
  }
  return notices;
}

function evaluations_table(bodies) {
  const rows = [];
  let saved = 0, spent = 0;
  for (const body of bodies) {
    const { unchanged, dry, wet, crossing, rejected, bounds_ns: bounds, query_ns: query } = body.evaluations;
    const name = body.description.name;
    const total = unchanged + dry + wet + crossing + rejected;
    const add = (evaluation, count, cost) => {
      if (count === 0) return;
      const gain = query === null || cost === null ? null : Math.max(0, 1e-9 * count * (query - cost));
      saved += gain || 0;
      spent += cost === null ? 0 : 1e-9 * count * cost;
      rows.push([`${body.id} ${name}`, evaluation, count, `${(100 * count / total).toFixed(1)} %`,
                 cost === null ? '–' : seconds_text(1e-9 * cost), gain ? seconds_text(gain) : '–']);
    };
    add('partially submerged: computed', crossing, query);
    add('dry: from the bounds', dry, bounds);
    add('fully submerged: from bounds and constants', wet, bounds);
    add('unchanged pose: cached result', unchanged, query === null ? null : Math.min(bounds || 0, query));
    add('invalid pose: rejected', rejected, null);
  }
  const caption = 'How the service evaluates the poses, and the time saved compared to computing each of them ' +
    `(costs measured while this page was written; total ${seconds_text(saved)} saved, ${seconds_text(spent)} spent)`;
  return table_of(caption, ['body', 'evaluation', 'rows', 'share', 'cost per row', 'saved'], rows);
}

// Rows by status of the bodies with a status other than OK; null if there are none.
function status_table(data, bodies) {
  const rows = [];
  for (const body of bodies) {
    const counts = new Map();
    for (const status of body.columns.status) counts.set(status, (counts.get(status) || 0) + 1);
    if (counts.get(0) === body.rows) continue;
    for (const [status, count] of [...counts].sort(([a], [b]) => a - b)) {
      rows.push([`${body.id} ${body.description.name}`, status_text(data.body_statuses, status), count, `${(100 * count / body.rows).toFixed(1)} %`]);
    }
  }
  if (rows.length === 0) return null;
  const caption = 'Rows of this page by the status of their response. A status other than OK carries zeros, which the plots omit';
  return table_of(caption, ['body', 'status', 'rows', 'share'], rows);
}

function bodies_table(data) {
  const descriptions = new Map(data.model.bodies.map((body) => [body.id, body]));
  const statuses_text = (body) => {
    const known = body.statuses.reduce((sum, count) => sum + count, 0);
    const parts = body.statuses.map((count, status) => [status < data.body_statuses.length ? data.body_statuses[status][0] : 'defined by a later version', count]);
    return [...parts, ['no response recorded', body.recorded - known]].filter(([, count]) => count > 0)
      .map(([name, count]) => `${name} ${count.toLocaleString('en')}`).join(', ') || '–';
  };
  const rows = data.bodies.map((body) => [String(body.id), descriptions.get(body.id).name, body.recorded, statuses_text(body), body.max_force, body.shown && body.rows > 0 ? 'yes' : 'no']);
  const caption = 'All bodies of the scene. For a body that is not shown in the 3D view and the plots, only recorded values are listed';
  return table_of(caption, ['id', 'name', 'rows', 'rows by status', 'largest force, N', 'shown'], rows);
}

// The waves of a run in a sentence; empty in water at rest.
function waves_text(seas, surfaces) {
  if (surfaces) return `Waves: surfaces on grids, of which ${surfaces.length} are drawn. `;
  if (seas.length === 0) return '';
  if (seas.length > 1) return `Waves: ${seas.length} different seas, received one after the other. `;
  const sea = seas[0];
  const depth = sea.depth === null ? 'deep water' : `a depth of ${format_number(sea.depth)} m`;
  return `Waves: ${plural(sea.components, 'component', 'components')}, significant wave height ${format_number(sea.significant_wave_height())} m, ` +
    `${depth}, ${sea.pressure} pressure. `;
}

// The current in a sentence; empty where no body has loads.
function current_text({ loads }) {
  return loads && loads.current.some((component) => component !== 0) ? `Current: [${loads.current.map(format_number).join(', ')}] m/s. ` : '';
}

function report_tables(data, bodies, seas) {
  const { water, bodies: described, meshes, simd_target: target } = data.model;
  const section = (title, ...content) => {
    const heading = document.createElement('h2');
    heading.textContent = title;
    document.getElementById('tables').append(heading, ...content);
  };
  section('The bodies', bodies_table(data));
  const evaluations = bodies.every((body) => body.evaluations) ? evaluations_table(bodies) : null;
  const statuses = status_table(data, bodies);
  if (evaluations || statuses) section('Evaluations', ...[evaluations, statuses].filter((table) => table !== null));
  if (data.status) {
    const status = data.status;
    section('Service status', table_of('The last status in the log, totals since the service was started', ['field', 'value'], [
      ['version', status.version], ['uptime', `${format_number(status.uptime)} s`],
      ['requests', status.requests.toLocaleString('en')], ['computed', status.computed.toLocaleString('en')],
      ['retries', status.retries.toLocaleString('en')], ['superseded', status.superseded.toLocaleString('en')],
      ['rejected', status.rejected.toLocaleString('en')],
      ['bodies dry, fully submerged, partially submerged, unchanged', [status.dry, status.wet, status.crossing, status.unchanged].map((count) => count.toLocaleString('en')).join(', ')],
      ['latency, median, 99 %, maximum', [status.p50, status.p99, status.max].map(seconds_text).join(', ')]]));
  }
  section('The scene', table_of(
    `Water: level ${format_number(water.level)} m along [${water.up.join(', ')}], ${format_number(water.density)} kg/m³, gravity ${format_number(water.gravity)} m/s². ${waves_text(seas, data.surfaces)}${current_text(data.model)}` +
    `Instructions: ${target}.`,
    ['id', 'name', 'mesh', 'method', 'tolerance', 'mass, kg', 'density, kg/m³'],
    described.map((body) => [String(body.id), body.name, meshes[body.mesh].name, body.method, body.tolerance, body.mass, body.density])));
  section('The meshes', table_of('Properties after loading', ['mesh', 'triangles', 'drawn', 'volume, m³', 'area, m²', 'diagonal, m', 'components', 'findings'],
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
  if (mesh.turned) findings.push('was inside out: the winding of all faces was reversed');
  return findings.join('; ');
}
