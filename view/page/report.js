'use strict';
// Plays back a recorded run: the slider, keys and plots set the time; the 3D view, clock and plots show that time.
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const element = (id) => document.getElementById(id);
  const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 50];

  const descriptions = new Map(data.model.bodies.map((body) => [body.id, body]));
  // The bodies that are shown, with their columns by name as arrays over the rows.
  const bodies = data.bodies.filter((body) => body.rows > 0).map((body) => {
    const values = decode_numbers(body.data, Float64Array);
    const columns = {};
    data.columns.forEach((name, i) => { columns[name] = values.subarray(i * body.rows, (i + 1) * body.rows); });
    const metacentres = body.metacenters === undefined ? null : decode_numbers(body.metacenters, Float32Array);
    const description = descriptions.get(body.id);
    const loads = body.loads ? new RecordedLoads(body, columns) : null;
    return { ...body, columns, metacentres, description, loads };
  });
  const start = Math.min(...bodies.map((body) => body.columns.time[0]));
  const end = Math.max(...bodies.map((body) => body.columns.time[body.rows - 1]));
  let time = start, speed = 1, playing = false, selected = bodies[0];

  const scene = make_water_scene(element('canvas'), { ...data.model, bodies: bodies.map((body) => body.description) });

  const seas = data.seas.map((sea) => new Sea(sea));
  // A sea on grids has one of these surfaces from its time on.
  const surfaces = data.surfaces || [], surface_times = surfaces.map((surface) => surface.time);
  const sea_on_grids = surfaces.length > 0 ? new SplineSea(surfaces[0]) : null;
  let shown_surface = 0;

  const position_names = ['px', 'py', 'pz'], quaternion_names = ['qw', 'qx', 'qy', 'qz'];
  const at_row = (body, names, row) => names.map((name) => body.columns[name][row]);
  const is_ok = (body, row) => body.columns.status[row] === 0;
  const has_pose = (body, row) => is_valid_pose(at_row(body, position_names, row), at_row(body, quaternion_names, row));

  // The state of a body at a time: position and orientation are interpolated between two rows with valid poses, the
  // other values are those of the earlier row.
  function body_at(body, when) {
    const columns = body.columns;
    const row = row_at(columns.time, when);
    const next = row + 1 < body.rows && has_pose(body, row) && has_pose(body, row + 1) ? row + 1 : row;
    const span = columns.time[next] - columns.time[row];
    const fraction = span > 0 ? Math.min(1, Math.max(0, (when - columns.time[row]) / span)) : 0;
    const interpolated = (name) => columns[name][row] + fraction * (columns[name][next] - columns[name][row]);
    const from = at_row(body, quaternion_names, row), to = at_row(body, quaternion_names, next);
    const sign = from.reduce((sum, value, i) => sum + value * to[i], 0) < 0 ? -1 : 1;  // q and -q are the same rotation
    const between = from.map((value, i) => (1 - fraction) * value + sign * fraction * to[i]);
    const norm = next > row ? Math.hypot(...between) : 1;  // a row by itself is as recorded, so that its norm is checked
    const at = (names) => at_row(body, names, row);
    return { id: body.id, status: columns.status[row], p: position_names.map(interpolated),
             q: between.map((value) => value / norm),
             f: at(['fx', 'fy', 'fz']), t: at(['tx', 'ty', 'tz']), b: at(['bx', 'by', 'bz']),
             loads: body.loads && body.loads.at(row),
             condition: condition_of_row(body, row),  // only with subdivision
             m: body.metacentres ? [Array.from(body.metacentres.subarray(6 * row, 6 * row + 3)), Array.from(body.metacentres.subarray(6 * row + 3, 6 * row + 6))] : null };
  }

  // Returns the sea at a time of the run and its own time [s], from the last row of the selected body before then and
  // the time since that row. In water at rest, and where the sea is not known, they are null and NaN.
  function sea_at(when) {
    if (sea_on_grids && when >= surface_times[0]) {
      const at = row_at(surface_times, when);
      if (at !== shown_surface) sea_on_grids.take(surfaces[shown_surface = at]);
      return { sea: sea_on_grids, sea_time: surface_times[at] };
    }
    if (seas.length === 0) return { sea: null, sea_time: NaN };
    const { time: times, sea_time: sea_times, sea: places } = selected.columns;
    const row = row_at(times, when);
    return Number.isNaN(places[row]) ? { sea: null, sea_time: NaN } : { sea: seas[places[row]], sea_time: sea_times[row] + (when - times[row]) };
  }
  let drawn_sea = null;

  const diagonal = (body) => data.model.meshes[body.description.mesh].diagonal;
  const largest_force = (body) => ['fx', 'fy', 'fz'].reduce((most, name) =>
    body.columns[name].reduce((a, b) => (Math.abs(b) > a ? Math.abs(b) : a), most), 0);
  // scale_of_body: of a body's values, see Plot. is_valid: whether a row's value has a meaning; a response whose status is not OK holds zeros.
  const groups = [
    { key: 'heave', title: 'Heave', unit: 'm', columns: { [`height of the body's origin above the ${seas.length + surfaces.length > 0 ? 'still water level' : 'water'}`]: 'heave' }, is_valid: has_pose,
      scale_of_body: diagonal },
    { key: 'angles', title: 'Roll and pitch, 0 upright', unit: 'degrees', scale_of_body: () => 180, columns: { roll: 'roll', pitch: 'pitch' }, is_valid: has_pose },
    { key: 'force', title: 'Buoyant force', moving: 'Force of the water', unit: 'N', columns: { z: 'fz', x: 'fx', y: 'fy' }, is_valid: is_ok, scale_of_body: largest_force },
    { key: 'torque', title: 'Buoyant torque', moving: 'Torque of the water', unit: 'N m', columns: { z: 'tz', x: 'tx', y: 'ty' }, is_valid: is_ok,
      scale_of_body: (body) => largest_force(body) * diagonal(body) },
    { key: 'energy', title: 'Mechanical energy', moving: 'Mechanical energy, not conserved', unit: 'J', columns: { energy: 'energy' }, is_valid: is_ok,
      missing: 'unknown: requires velocities and the mass of the body in the scene' },
    { key: 'round_trip', title: 'Round trip', unit: 'ms', columns: { 'request to response': 'round_trip' }, is_valid: () => true, scale: 1e3,
      missing: 'not recorded: requires an LCM log' },
  ];
  function series_of(group) {
    return Object.entries(group.columns).map(([name, column]) => ({
      name, times: selected.columns.time,
      values: selected.columns[column].map((value, row) => (group.is_valid(selected, row) ? (group.scale || 1) * value : NaN)) }));
  }
  // A plot's title for the selected body: that in `moving` if drag or added mass contribute.
  const title_of = (group) => (group.moving && selected.loads && has_hydrodynamics(selected.description) ? group.moving : group.title);
  const scale_of = (group) => (group.scale_of_body ? group.scale_of_body(selected) : 0);
  const plots = {};
  for (const group of groups) {
    plots[group.key] = new Plot(element('plots'), { title: title_of(group), unit: group.unit, series: series_of(group), on_seek: seek,
                                                       scale: scale_of(group), missing: group.missing });
  }
  if (data.model.loads) plots.loads = new LoadPlots(element('plots'), plots.force.figure, data.model, seek);
  function update_loads() {
    if (!plots.loads) return;
    plots.loads.box.hidden = selected.loads === null;
    if (selected.loads) plots.loads.update(selected.description, selected.columns.time, (row) => selected.loads.at(row), selected.loads.source_text());
  }
  update_loads();

  function show() {
    if (scene) {
      const { sea, sea_time } = sea_at(time);
      if (sea !== drawn_sea) {
        scene.use_sea(sea);
        drawn_sea = sea;
      }
      scene.show(bodies.map((body) => body_at(body, time)), sea_time);
      scene.follow(selected.id);
      scene.render();
    }
    element('slider').value = time;
    element('slider').setAttribute('aria-valuetext', `${time.toFixed(3)} seconds`);
    element('clock').textContent = `${time.toFixed(3)} s`;
    const status = selected.columns.status[row_at(selected.columns.time, time)];
    element('status').textContent = `Body ${selected.id} ${selected.description.name}: ${status_text(data.body_statuses, status)}`;
    element('status').classList.toggle('not-ok', status !== 0);
    show_recorded_condition(element('subdivision'), selected, time);  // only with subdivision
    for (const plot of Object.values(plots)) plot.show(time);
  }

  function seek(when) {
    time = Math.min(end, Math.max(start, when));
    show();
  }

  function step_row(by) {
    const times = selected.columns.time;
    seek(times[Math.min(selected.rows - 1, Math.max(0, row_at(times, time) + by))]);
  }

  function play(on) {
    playing = on;
    element('play').textContent = on ? 'Pause' : 'Play';
    element('play').setAttribute('aria-pressed', String(on));
    if (!on) return;
    if (time >= end) time = start;
    let last = null;
    const frame = (now) => {
      if (!playing) return;
      if (last !== null) seek(time + 1e-3 * (now - last) * speed);
      last = now;
      if (time >= end) play(false);
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  function select(id) {
    selected = bodies.find((body) => body.id === id) || selected;
    element('body').value = String(selected.id);
    for (const group of groups) {
      plots[group.key].scale = scale_of(group);
      plots[group.key].update(series_of(group), title_of(group));
    }
    update_loads();
    show();
  }

  function set_speed(index) {
    speed = speeds[Math.min(speeds.length - 1, Math.max(0, index))];
    element('speed').value = String(speed);
  }

  for (const factor of speeds) element('speed').add(new Option(`${factor} ×`, String(factor)));
  set_speed(3);
  for (const body of bodies) element('body').add(new Option(`${body.id} ${body.description.name}`, String(body.id)));
  element('body_choice').hidden = bodies.length < 2;
  Object.assign(element('slider'), { min: start, max: end });
  element('play').addEventListener('click', () => play(!playing));
  element('speed').addEventListener('change', (event) => set_speed(speeds.indexOf(Number(event.target.value))));
  element('body').addEventListener('change', (event) => select(Number(event.target.value)));
  element('slider').addEventListener('input', (event) => seek(Number(event.target.value)));

  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT') return;
    const hundredth = 0.01 * (end - start);
    const moves = {
      ' ': () => play(!playing),
      ArrowLeft: () => (event.shiftKey ? step_row(-1) : seek(time - hundredth)),
      ArrowRight: () => (event.shiftKey ? step_row(1) : seek(time + hundredth)),
      Home: () => seek(start),
      End: () => seek(end),
      '+': () => set_speed(speeds.indexOf(speed) + 1),
      '-': () => set_speed(speeds.indexOf(speed) - 1),
      n: () => select(bodies[(bodies.indexOf(selected) + 1) % bodies.length].id),
    };
    const move = moves[event.key];
    if (move) move();
    if (move || (scene && scene.key(event))) event.preventDefault();
  });

  fill_legend(element('legend'), data.model.bodies.some((body) => body.center_of_mass !== null), bodies.some((body) => body.metacentres),
              bodies.filter((body) => body.loads).map((body) => body.description));
  element('title').textContent = `${data.model.scene}: ${data.file}`;
  document.title = `buoyancy: ${data.file}`;
  element('subtitle').textContent = `${shown_text(data, bodies)}, ${format_number(end - start)} s`;
  for (const notice of report_notices(data, bodies)) {
    const line = document.createElement('p');
    line.className = 'notice';
    line.textContent = notice;
    element('notices').append(line);
  }
  report_tables(data, bodies, seas);
  fill_subdivision_legend(element('legend'), data.model.bodies);  // only with subdivision
  element('footer').textContent = `buoyancy-report ${data.version}. Rendered with three.js. Requires no network.`;
  // page.html#t=12.5 opens at that time.
  function seek_to_hash() {
    const requested = new URLSearchParams(location.hash.slice(1)).get('t');
    if (requested && Number.isFinite(Number(requested))) seek(Number(requested));
  }
  window.addEventListener('hashchange', seek_to_hash);
  show();
  seek_to_hash();

  // [m], over the level: the elevation that is drawn at the distances x and y along the sea's axes from W's origin.
  window.buoyancyPage = { surfaceHeight: (x, y) => {
    const { sea, sea_time } = sea_at(time);
    return sea ? sea.elevation(x, y, sea_time) : 0;
  } };
  // For tests and measurements. shown_after: [ms] since the navigation started.
  window.buoyancy_report = { shown_after: performance.now(), data, bodies, plots, scene, seek, play, select, body_at,
                             state: () => ({ time, speed, playing, start, end, body: selected.id }) };
})();
