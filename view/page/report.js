'use strict';
// Plays a recorded run back: one time, which slider, keys and plots set and picture, clock and plots show.
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const element = (id) => document.getElementById(id);
  const speeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 50];

  const descriptions = new Map(data.model.bodies.map((body) => [body.id, body]));
  // Of each body that is shown its columns by name, as arrays over its rows.
  const bodies = data.bodies.filter((body) => body.rows > 0).map((body) => {
    const all = numbers_of(body.data, Float64Array);
    const columns = {};
    data.columns.forEach((name, i) => { columns[name] = all.subarray(i * body.rows, (i + 1) * body.rows); });
    const metacentres = body.metacenters === undefined ? null : numbers_of(body.metacenters, Float32Array);
    const description = descriptions.get(body.id);
    return { ...body, columns, metacentres, description };
  });
  const start = Math.min(...bodies.map((body) => body.columns.time[0]));
  const end = Math.max(...bodies.map((body) => body.columns.time[body.rows - 1]));
  let time = start, speed = 1, playing = false, chosen = bodies[0];

  const scene = make_water_scene(element('canvas'), { ...data.model, bodies: bodies.map((body) => body.description) });

  const place_names = ['px', 'py', 'pz'], turn_names = ['qw', 'qx', 'qy', 'qz'];
  const at_row = (body, names, row) => names.map((name) => body.columns[name][row]);
  const is_answered = (body, row) => body.columns.status[row] === 0;
  const is_posed = (body, row) => is_pose(at_row(body, place_names, row), at_row(body, turn_names, row));

  // A body at a time between two of its rows: place and turn in between, the rest as in the earlier row. Nothing is
  // between a pose and none.
  function body_at(body, when) {
    const columns = body.columns;
    const row = row_at(columns.time, when);
    const next = row + 1 < body.rows && is_posed(body, row) && is_posed(body, row + 1) ? row + 1 : row;
    const span = columns.time[next] - columns.time[row];
    const part = span > 0 ? Math.min(1, Math.max(0, (when - columns.time[row]) / span)) : 0;
    const between = (name) => columns[name][row] + part * (columns[name][next] - columns[name][row]);
    const from = at_row(body, turn_names, row), to = at_row(body, turn_names, next);
    const side = from.reduce((sum, value, i) => sum + value * to[i], 0) < 0 ? -1 : 1;
    const at = (names) => at_row(body, names, row);
    return { id: body.id, status: columns.status[row], p: place_names.map(between),
             q: from.map((value, i) => (1 - part) * value + side * part * to[i]),
             f: at(['fx', 'fy', 'fz']), t: at(['tx', 'ty', 'tz']), b: at(['bx', 'by', 'bz']),
             m: body.metacentres ? [Array.from(body.metacentres.subarray(6 * row, 6 * row + 3)), Array.from(body.metacentres.subarray(6 * row + 3, 6 * row + 6))] : null };
  }

  // stands: where a row's number says something. A response that is not OK holds zeros.
  const groups = [
    { key: 'heave', title: 'Heave', unit: 'm', columns: { 'B\'s origin over the water': 'heave' }, stands: is_posed },
    { key: 'angles', title: 'From upright', unit: 'degrees', columns: { roll: 'roll', pitch: 'pitch' }, stands: is_posed },
    { key: 'force', title: 'Buoyant force', unit: 'N', columns: { z: 'fz', x: 'fx', y: 'fy' }, stands: is_answered },
    { key: 'torque', title: 'Buoyant torque', unit: 'N m', columns: { z: 'tz', x: 'tx', y: 'ty' }, stands: is_answered },
    { key: 'energy', title: 'Mechanical energy', unit: 'J', columns: { energy: 'energy' }, stands: is_answered,
      missing: 'not known: needs velocities and the body\'s mass in the scene' },
    { key: 'round_trip', title: 'Round trip', unit: 'ms', columns: { 'request to response': 'round_trip' }, stands: () => true, scale: 1e3,
      missing: 'not recorded: a CSV knows no clock, a log of the bus does' },
  ];
  function series_of(group) {
    return Object.entries(group.columns).map(([name, column]) => ({
      name, times: chosen.columns.time,
      values: chosen.columns[column].map((value, row) => (group.stands(chosen, row) ? (group.scale || 1) * value : NaN)) }));
  }
  const plots = {};
  for (const group of groups) {
    plots[group.key] = new Plot(element('plots'), { title: group.title, unit: group.unit, series: series_of(group), on_seek: seek, missing: group.missing });
  }

  function show() {
    if (scene) {
      scene.show(bodies.map((body) => body_at(body, time)));
      scene.follow(chosen.id);
      scene.render();
    }
    element('slider').value = time;
    element('slider').setAttribute('aria-valuetext', `${time.toFixed(3)} seconds`);
    element('clock').textContent = `${time.toFixed(3)} s`;
    const status = chosen.columns.status[row_at(chosen.columns.time, time)];
    element('status').textContent = `Body ${chosen.id} ${chosen.description.name}: ${status_text(status)}`;
    element('status').classList.toggle('refused', status !== 0);
    for (const plot of Object.values(plots)) plot.show(time);
  }

  function seek(when) {
    time = Math.min(end, Math.max(start, when));
    show();
  }

  function step_row(by) {
    const times = chosen.columns.time;
    seek(times[Math.min(chosen.rows - 1, Math.max(0, row_at(times, time) + by))]);
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

  function choose(id) {
    chosen = bodies.find((body) => body.id === id) || chosen;
    element('body').value = String(chosen.id);
    for (const group of groups) plots[group.key].update(series_of(group));
    show();
  }

  function set_speed(index) {
    const kept = Math.min(speeds.length - 1, Math.max(0, index));
    speed = speeds[kept];
    element('speed').value = String(speed);
  }

  for (const factor of speeds) element('speed').add(new Option(`${factor} ×`, String(factor)));
  set_speed(3);
  for (const body of bodies) element('body').add(new Option(`${body.id} ${body.description.name}`, String(body.id)));
  element('body_choice').hidden = bodies.length < 2;
  Object.assign(element('slider'), { min: start, max: end });
  element('play').addEventListener('click', () => play(!playing));
  element('speed').addEventListener('change', (event) => set_speed(speeds.indexOf(Number(event.target.value))));
  element('body').addEventListener('change', (event) => choose(Number(event.target.value)));
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
      n: () => choose(bodies[(bodies.indexOf(chosen) + 1) % bodies.length].id),
    };
    const move = moves[event.key];
    if (move) move();
    if (move || (scene && scene.key(event))) event.preventDefault();
  });

  fill_legend(element('legend'), data.model.bodies.some((body) => body.center_of_mass !== null), bodies.some((body) => body.metacentres));
  element('title').textContent = `${data.model.scene}: ${data.file}`;
  document.title = `buoyancy: ${data.file}`;
  element('subtitle').textContent = `${shown_text(data, bodies)}, ${format_number(end - start)} s`;
  for (const notice of report_notices(data, bodies)) {
    const line = document.createElement('p');
    line.className = 'notice';
    line.textContent = notice;
    element('notices').append(line);
  }
  report_tables(data, bodies);
  element('footer').textContent = `buoyancy-report ${data.version}. Drawn with three.js. Needs no network.`;
  // page.html#t=12.5 opens there.
  function seek_to_hash() {
    const asked = new URLSearchParams(location.hash.slice(1)).get('t');
    if (asked && Number.isFinite(Number(asked))) seek(Number(asked));
  }
  window.addEventListener('hashchange', seek_to_hash);
  show();
  seek_to_hash();

  // For tests and measurements. shown_after: ms since the page was asked for.
  window.buoyancy_report = { shown_after: performance.now(), data, bodies, plots, scene, seek, play, choose, body_at,
                             state: () => ({ time, speed, playing, start, end, body: chosen.id }) };
})();
