'use strict';
// Displays the snapshots that buoyancy-view sends as /events: 3D view, summary strip, plots and tables.
(async () => {
  const element = (id) => document.getElementById(id);
  const history_length = 60;    // [s], same as BusMonitor::kSecondsKept
  const track_interval = 0.1;   // [s] between two points of a body's plots
  const text_interval = 200;    // [ms]
  const plot_interval = 500;    // [ms]
  const stale_timeout = 2000;   // [ms] without a snapshot

  const states = {
    answering: ['●', 'The service answers'],
    idle: ['○', 'The service is idle'],
    'not answering': ['▲', 'The service does not answer'],
    offline: ['■', 'The service is offline'],
    connecting: ['…', 'No connection to buoyancy-view; reconnecting'],
  };

  async function fetch_model() {
    const response = await fetch('model', { cache: 'no-store' });
    if (!response.ok) throw new Error(`cannot fetch the model: HTTP status ${response.status}`);
    return response.text();
  }

  const model_text = await fetch_model();
  const { model, version, body_statuses } = JSON.parse(model_text);
  const up = model.water.up;
  // [m], heave: height of B's origin above the level. The client's table has that of the centre of mass.
  const heave = (p) => p[0] * up[0] + p[1] * up[1] + p[2] * up[2] - model.water.level;
  const along_up = (f) => f[0] * up[0] + f[1] * up[1] + f[2] * up[2];
  const scene = make_water_scene(element('canvas'), model);
  const view = { snapshots: 0, renders: 0, connections: 0, last: null, state: 'connecting', history: [], paused: false,
                 selected: model.bodies[0].id, following: false, model, body_statuses };
  window.buoyancyView = view;

  let sea = null, sea_time = NaN;      // of the picture
  let newest_sea = model.sea || null;  // data that is not in the picture yet, see sea_json.h: of the scene, or received
  function use_newest_sea() {
    if (newest_sea === null) return;
    const data = newest_sea;
    newest_sea = null;
    if (data.surface && sea) {
      sea.take(data);
      return;
    }
    sea = data.surface ? new SplineSea(data) : new Sea(data);
    if (scene) scene.use_sea(sea);
  }
  // [m], over the level: the elevation that is drawn at the distances x and y along the sea's axes from W's origin.
  window.buoyancyPage = { surfaceHeight: (x, y) => (sea && Number.isFinite(sea_time) ? sea.elevation(x, y, sea_time) : 0) };

  // Time series of the bodies' plots, with one point per track_interval.
  const tracks = { times: [], bodies: new Map() };
  let announced = '';

  function set_state(state) {
    view.state = state;
    const [sign, text] = states[state];
    element('state').dataset.state = state;
    element('state_sign').textContent = sign;
    if (announced !== text) element('state_text').textContent = text;  // screen readers announce each assignment
    announced = text;
  }

  function add_second(second) {
    const newest = view.history[view.history.length - 1];
    if (!second || (newest && newest.number === second.number)) return;
    if (newest && second.number < newest.number) view.history = [];  // buoyancy-view has restarted
    view.history.push(second);
    if (view.history.length > history_length) view.history.shift();
  }

  function track(snapshot) {
    const now = snapshot.listening;
    const newest = tracks.times[tracks.times.length - 1];
    if (newest !== undefined && now < newest) {
      tracks.times = [];
      tracks.bodies.clear();
    } else if (newest !== undefined && now < newest + track_interval) {
      return;
    }
    tracks.times.push(now);
    for (const body of snapshot.bodies) {
      if (!tracks.bodies.has(body.id)) {
        const missed = (value) => new Array(tracks.times.length - 1).fill(value);
        tracks.bodies.set(body.id, { heave: missed(NaN), force: missed(NaN), loads: missed(null) });
      }
      const body_track = tracks.bodies.get(body.id);
      body_track.heave.push(heave(body.p));
      body_track.force.push(body.f && !body.status ? along_up(body.f) : NaN);  // a status other than OK carries zeros
      body_track.loads.push(body.loads ? { ...body.loads, q: body.q } : null);
    }
    while (tracks.times.length > 0 && tracks.times[0] < now - history_length) {
      tracks.times.shift();
      for (const body_track of tracks.bodies.values()) {
        for (const column of Object.values(body_track)) column.shift();
      }
    }
  }

  const no_data = 'no data yet';
  const bus_series = (columns) => () => {
    const newest = view.history.length > 0 ? view.history[view.history.length - 1].number : 0;
    const times = view.history.map((second) => second.number - newest);
    return columns.map(([name, value]) => ({ name, times, values: view.history.map(value) }));
  };
  const body_series = (name, column) => () => {
    const newest = tracks.times[tracks.times.length - 1];
    const body_track = tracks.bodies.get(view.selected);
    // Copies: a plot may be drawn again, in another size, after the track has grown.
    return [{ name, times: tracks.times.map((time) => time - newest), values: body_track ? [...body_track[column]] : [] }];
  };
  const milliseconds = (value) => (value === null ? NaN : 1e3 * value);
  const plots = [
    { title: 'Request to response', unit: 'ms', missing: 'no responses yet',
      make: bus_series([['median', (second) => milliseconds(second.p50)], ['99 %', (second) => milliseconds(second.p99)]]) },
    { title: 'Messages', unit: '1/s', missing: no_data,
      make: bus_series([['requests', (second) => second.requests], ['responses', (second) => second.responses], ['unanswered', (second) => second.unanswered]]) },
    { title: 'Heave of the body', unit: 'm', missing: no_data, make: body_series('height of the body\'s origin above the still water level', 'heave') },
    { title: model.loads ? 'Force of the water on the body' : 'Buoyant force on the body', unit: 'N', missing: no_data, make: body_series('upwards', 'force') },
  ];
  for (const plot of plots) {
    plot.plot = new Plot(element('plots'), { title: plot.title, unit: plot.unit, series: plot.make(), missing: plot.missing });
  }

  const described = () => model.bodies.find((body) => body.id === view.selected);
  const with_loads = model.bodies.filter((body) => body.loads && body.loads.published);
  const load_plots = with_loads.length > 0 ? new LoadPlots(element('plots'), null, model) : null;
  view.load_plots = load_plots;

  function draw_plots() {
    for (const { plot, make } of plots) {
      plot.update(make());
      plot.show(0);
    }
    if (load_plots) draw_loads();
  }

  function draw_loads() {
    load_plots.box.hidden = !with_loads.includes(described());
    if (load_plots.box.hidden) return;
    const newest = tracks.times[tracks.times.length - 1];
    const body_track = tracks.bodies.get(view.selected);
    load_plots.update(described(), tracks.times.map((time) => time - newest), (n) => (body_track ? body_track.loads[n] : null));
    load_plots.show(0);
  }

  const age_text = (age) => (age === null ? 'never' : age < 1 ? 'now' : `${seconds_text(age)} ago`);
  const count_text = (count) => count.toLocaleString('en');

  function strip_entries(now) {
    const status = now.status;
    const second = now.second || { requests: 0, responses: 0, p50: null, p99: null, max: null };
    const time = (value) => (value === null ? '–' : seconds_text(value));
    const entries = [
      ['requests', `${count_text(second.requests)} per second`], ['responses', `${count_text(second.responses)} per second`],
      ['median', time(second.p50)], ['99 %', time(second.p99)], ['slowest', time(second.max)],
      ['unanswered', count_text(now.counts.unanswered)], ['missed by this view', count_text(now.counts.requests_missed)], ['packets dropped', count_text(now.counts.packets_dropped)],
    ];
    if (!status) return entries;
    return entries.concat([
      ['service', status.version], ['mode', status.mode], ['uptime', seconds_text(status.uptime)],
      ['status', age_text(now.status_age)], ['rejected', count_text(status.rejected)], ['send failures', count_text(status.send_failures)],
    ]);
  }

  function fill_strip(entries) {
    const strip = element('strip');
    while (strip.children.length > entries.length) strip.lastElementChild.remove();
    while (strip.children.length < entries.length) {
      const item = document.createElement('li');
      item.append(document.createElement('span'), ' ', document.createElement('b'));
      strip.append(item);
    }
    entries.forEach(([name, value], i) => {
      const [label, number] = [strip.children[i].children[0], strip.children[i].children[1]];
      if (label.textContent !== name) label.textContent = name;
      if (number.textContent !== value) number.textContent = value;
    });
  }

  function notices(now) {
    const found = [];
    if (now.services.length > 1) {
      found.push(`${now.services.length} services are on this bus (${now.services.join(', ')}). If they use the same channels, each of them ` +
        'responds to every request: stop all but one, or configure separate channels.');
    }
    if (now.state === 'offline') {
      found.push(now.status
        ? `No message from the service: its last status arrived ${age_text(now.status_age)}. The page shows the last state received.`
        : 'No message from the service since this view was started.');
    }
    if (now.state === 'not answering') found.push(`Requests are on the bus; the last response arrived ${age_text(now.response_age)}.`);
    if (now.counts.bodies_not_in_scene > 0) {
      found.push(`${plural(now.counts.bodies_not_in_scene, 'body', 'bodies')} in requests not found in ${model.scene}: the service may use a different scene.`);
    }
    if (now.status && now.status.scene_bodies !== model.bodies.length) {
      found.push(`The service's scene has ${plural(now.status.scene_bodies, 'body', 'bodies')}, the scene shown here has ${model.bodies.length}.`);
    }
    // The status holds a path on the service's machine; only the file name is comparable.
    const scene_of_service = now.status ? now.status.scene.split('/').pop() : model.scene;
    if (scene_of_service !== model.scene) found.push(`The service's scene is ${scene_of_service}, the scene shown here is ${model.scene}.`);
    if (now.status && now.status.injected_faults) found.push(`The service injects faults on purpose: ${now.status.injected_faults}.`);
    return found;
  }

  function fill_notices(found) {
    const box = element('notices');
    const shown = [...box.children].map((line) => line.textContent);
    if (shown.join('\n') === found.join('\n')) return;
    box.replaceChildren(...found.map((text) => {
      const line = document.createElement('p');
      line.className = 'notice';
      line.textContent = text;
      return line;
    }));
  }

  function body_table(now) {
    const body = now.bodies.find((one) => one.id === view.selected);
    const description = described();
    if (!body) return table_of(`Body ${description.id} ${description.name}: no request yet`, [], []);
    const vector = (values) => (values ? values.map(format_number).join(', ') : '–');
    const rows = [
      ['status', body.status === null ? (body.f ? 'unknown: force and torque only' : 'requested, no response yet') : status_text(body_statuses, body.status)],
      ['position, m', vector(body.p)], ['quaternion w, x, y, z', vector(body.q)],
      ['force, N', vector(body.f)], ['torque, N m', vector(body.t)],
      ['error bounds, N and N m', body.force_bound !== null ? `${format_number(body.force_bound)}, ${format_number(body.torque_bound)}` : '–'],
      ['submerged volume, m³', body.volume !== null ? format_number(body.volume) : '–'],
    ];
    if (body.gm) rows.push(['metacentric heights, m', body.gm.map((height) => (height === null ? '–' : format_number(height))).join(', ')]);
    if (body.loads) {
      rows.push(['immersion, %', format_number(100 * body.loads.immersion)], ['drag, N', vector(body.loads.drag.slice(0, 3))],
                ['drag, N m', vector(body.loads.drag.slice(3))], ['added-mass terms, N', vector(body.loads.added_mass.slice(0, 3))],
                ['added-mass terms, N m', vector(body.loads.added_mass.slice(3))], ['velocity of the water, m/s', vector(body.loads.water_velocity)]);
    }
    rows.push(['latest request', age_text(body.age)]);
    return table_of(`Body ${description.id} ${description.name}`, ['', ''], rows);
  }

  function counter_tables(now) {
    const counts = now.counts;
    const observed = [
      ['requests', counts.requests], ['retries', counts.requests_repeated], ['responses', counts.responses],
      ['duplicate responses', counts.responses_repeated], ['responses without a request', counts.responses_without_request],
      ['unanswered', counts.unanswered], ['requests missed by this view', counts.requests_missed], ['sessions', counts.sessions],
      ...Object.entries(counts.malformed).map(([cause, count]) => [`malformed: ${cause}`, count]),
      ['packets dropped by the kernel', counts.packets_dropped], ['fragments of incomplete messages', counts.fragments_dropped], ['services started', counts.services_started],
      ['seas rejected', counts.seas_rejected],
      ['conditions rejected', counts.conditions_rejected],  // only with subdivision
    ];
    const tables = [table_of('Observed on the bus', ['since this view was started', ''], observed)];
    if (!now.status) return tables;
    const status = now.status;
    tables.push(table_of('Reported by the service', ['since it was started', ''], [
      ['requests', status.requests], ['computed', status.computed], ['retries', status.retries], ['conflicting retries', status.conflicting_retries],
      ['stale', status.stale], ['superseded', status.superseded], ['rejected', status.rejected], ['send failures', status.send_failures],
      ['seas received', status.seas_received], ['seas rejected', status.seas_rejected],
      ['conditions received', status.conditions_received], ['conditions rejected', status.conditions_rejected],  // only with subdivision
      ['packets dropped', status.packets_dropped], ['fragments dropped', status.fragments_dropped], ['incomplete messages evicted', status.partial_messages_evicted],
      ['requests in several slices', status.requests_sliced], ['outputs too large to send', status.outputs_too_large],
      ['bytes retained', status.retained_bytes], ['stored replies evicted', status.replies_evicted],
      ['contradicting motions', status.motions_contradicting], ['quaternions in the order x, y, z, w', status.quaternions_xyzw],
      ['sessions', status.sessions], ['sessions evicted', status.sessions_evicted], ['reloads', status.reloads], ['reloads failed', status.reloads_failed],
    ]));
    tables.push(table_of('Bodies evaluated', ['', 'count'], [
      ['skipped: dry', status.bodies_dry], ['skipped: fully submerged', status.bodies_wet],
      ['skipped: unchanged', status.bodies_unchanged], ['computed: partially submerged', status.bodies_crossing],
      ...Object.entries(status.bodies),
      ['waves: work capped', status.bodies_work_capped], ['waves: too steep for linear theory', status.bodies_sea_too_steep], ['waves: below the sea bed', status.bodies_below_bed], ['waves: patches', status.wave_patches],
      ['quaternions normalised', status.quaternions_normalised], ['hydrostatics', status.hydrostatics],
    ]));
    tables.push(table_of('Service latency', ['from receipt to publication', 'ms'], [
      ['median', 1e3 * status.latency.p50], ['99 %', 1e3 * status.latency.p99], ['99.9 %', 1e3 * status.latency.p999],
      ['slowest', 1e3 * status.latency.max], ['maximum queue wait, last second', 1e3 * status.queue_wait],
    ]));
    return tables;
  }

  function show_state(now) {
    set_state(now.service);
    fill_notices(notices({ ...now, state: now.service }));
    document.body.classList.toggle('offline', now.service === 'offline');
  }

  function show_text(now) {
    show_state(now);
    fill_strip(strip_entries(now));
    element('subtitle').textContent = now.status ? `${model.scene}, instance ${now.status.instance_id}` : model.scene;
    element('body_facts').replaceChildren(body_table(now));
    show_observed_condition(element('body_facts'), described(), now);  // only with subdivision
    element('counters').replaceChildren(...counter_tables(now));
  }

  function show_bodies(now) {
    use_newest_sea();
    sea_time = typeof now.sea_time === 'number' ? now.sea_time : NaN;
    if (!scene) return;
    scene.show(now.bodies.map((body) => ({ ...body, f: body.f || [0, 0, 0], t: body.t || [0, 0, 0] })), sea_time);
    scene.follow(view.following ? view.selected : null);
    scene.render();
    view.renders += 1;
  }

  let frame_requested = false, text_time = -Infinity, plots_time = -Infinity, received = -Infinity;
  function show_latest(time) {
    frame_requested = false;
    const text_due = time >= text_time + text_interval;
    if (text_due) text_time = time;
    if (view.paused) {
      if (text_due) show_state(view.last);  // the state is shown even while the 3D view is paused
      return;
    }
    show_bodies(view.last);
    if (text_due) show_text(view.last);
    if (time >= plots_time + plot_interval) { draw_plots(); plots_time = time; }
  }

  function on_snapshot(snapshot) {
    view.last = snapshot;
    view.snapshots += 1;
    received = performance.now();
    element('canvas').classList.remove('stale');
    add_second(snapshot.second);
    track(snapshot);
    if (!frame_requested) { frame_requested = true; requestAnimationFrame(show_latest); }
  }

  function select(id) {
    view.selected = id;
    element('body').value = String(id);
    text_time = plots_time = -Infinity;
    if (view.last) { draw_plots(); show_text(view.last); show_bodies(view.last); }
  }
  function select_next(by) {
    const at = model.bodies.findIndex((body) => body.id === view.selected);
    select(model.bodies[(at + by + model.bodies.length) % model.bodies.length].id);
  }
  function pause(on) {
    view.paused = on;
    element('pause').textContent = on ? 'Resume' : 'Pause';
    element('pause').setAttribute('aria-pressed', String(on));
  }
  function follow(on) {
    view.following = on;
    element('follow').checked = on;
    if (view.last) show_bodies(view.last);
  }
  Object.assign(view, { scene, select, pause, follow });

  for (const body of model.bodies) element('body').add(new Option(`${body.id} ${body.name}`, String(body.id)));
  element('body').addEventListener('change', (event) => select(Number(event.target.value)));
  element('pause').addEventListener('click', () => pause(!view.paused));
  element('follow').addEventListener('change', (event) => follow(event.target.checked));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT') return;
    if (event.key === ' ' && ['BUTTON', 'INPUT', 'SUMMARY'].includes(event.target.tagName)) return;  // Space activates these
    const moves = { ' ': () => pause(!view.paused), n: () => select_next(1), p: () => select_next(-1), f: () => follow(!view.following) };
    const move = moves[event.key.toLowerCase()];
    if (move) move();
    if (move || (scene && scene.key(event))) event.preventDefault();
  });

  element('title').textContent = model.scene;
  document.title = `buoyancy: ${model.scene}, live`;
  element('footer').textContent = `buoyancy-view ${version}. Rendered with three.js. Publishes nothing on the bus.`;
  fill_legend(element('legend'), model.bodies.some((body) => body.center_of_mass !== null), model.bodies.some((body) => body.outputs.includes('hydrostatics')), with_loads);
  fill_subdivision_legend(element('legend'), model.bodies);  // only with subdivision

  function connect() {
    const events = new EventSource('events');
    events.addEventListener('open', async () => {
      view.connections += 1;
      if (view.connections === 1) return;
      // buoyancy-view may have restarted with another scene.
      try {
        if (await fetch_model() !== model_text) location.reload();
      } catch (error) {
        // The connection is lost again; the error event of EventSource handles it.
      }
    });
    events.addEventListener('history', (event) => { view.history = JSON.parse(event.data); });
    events.addEventListener('sea', (event) => { newest_sea = JSON.parse(event.data); });
    events.addEventListener('message', (event) => on_snapshot(JSON.parse(event.data)));
    events.addEventListener('error', () => {
      set_state('connecting');
      if (events.readyState !== EventSource.CLOSED) return;  // EventSource reconnects
      events.close();
      setTimeout(connect, 2000);
    });
  }
  setInterval(() => {
    if (performance.now() < received + stale_timeout) return;
    element('canvas').classList.add('stale');
    set_state('connecting');
  }, 500);
  connect();
})();
