'use strict';
// Shows where and how a body floats: the hull in the water at each row of the results, plots and tables. The data are
// those of hydrostatics_page.h.

// A plot with a line at zero.
class ArmPlot extends Plot {
  get height() { return 260; }

  draw_series(y) {
    const zero = y(0);
    const box = { x1: this.x(this.range().start), x2: this.x(this.range().end), y1: zero, y2: zero };
    if (zero > 0 && zero < this.height) svg_element('line', { class: 'zero', ...box }, this.svg);
    super.draw_series(y);
  }
}

(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const element = (id) => document.getElementById(id);
  const titles = { equilibrium: 'attitudes at rest', gz: 'righting arms', table: 'hydrostatic table' };
  const max_lines = 16;

  const values = decode_numbers(data.values, Float64Array);
  const columns = {};
  data.columns.forEach(({ name }, i) => { columns[name] = values.subarray(i * data.rows, (i + 1) * data.rows); });
  const numbers = decode_numbers(data.states, Float64Array);
  const state_size = 19;

  // Places the body in the picture: at a row, or at rest. state: the numbers of hydrostatics_page.h.
  function place(state) {
    const part = (from, count) => Array.from(state.slice(from, from + count));
    const { description } = scene.bodies.get(1);
    if (description.center_of_mass !== null) description.center_of_mass = part(16, 3);  // liquids move
    scene.show([{ id: 1, status: 0, p: part(0, 3), q: part(3, 4), f: part(7, 3), b: part(10, 3), m: [part(13, 3)] }]);
    scene.follow(1);
  }
  const state_of_row = (row) => numbers.subarray(row * state_size, (row + 1) * state_size);

  const angle = (value) => `${format_number(Math.abs(value) < 5e-5 ? 0 : Number(value.toFixed(4)))}°`;
  const attitude_text = (heel, trim, draft) => `heel ${angle(heel)}, trim ${angle(trim)}, draft ${format_number(draft)} m`;
  // The attitudes with a picture each: [{state, text, row}], row null where no row has it.
  const row_at_heel = (heel) => { const row = columns.heel.findIndex((other) => Math.abs(other - heel) < 1e-9); return row < 0 ? null : row; };
  const rests = data.command === 'gz' ? data.rests.map((rest) => ({ ...rest, text: attitude_text(rest.heel, rest.trim, rest.draft), row: row_at_heel(rest.heel) })) : [];
  if (data.command === 'equilibrium') {
    data.results.attitudes.forEach((at, row) => {
      if (at.stable) rests.push({ state: state_of_row(row), text: attitude_text(at.heel, at.trim, at.draft), row });
    });
  }

  const groups = Array.from({ length: data.rows / (data.group_rows || 1) }, (_, i) => i * data.group_rows);  // their first rows
  const shown = { row: 0, rest: null };
  const scene = data.rows > 0 ? make_water_scene(element('canvas'), data.model) : null;
  if (scene) {
    // Heel is seen from astern, trim from starboard.
    if (data.command === 'gz') [scene.azimuth, scene.elevation] = [Math.PI + 0.25, 0.12];
    if (data.command === 'table') [scene.azimuth, scene.elevation] = [-0.5 * Math.PI, 0.08];
    Object.assign(scene, { zoomed: true, distance: 1.5 * scene.size });
  }

  function row_text(row) {
    if (data.command === 'table') return `draft ${format_number(columns.draft[row])} m, trim ${angle(columns.trim[row])}`;
    const text = attitude_text(columns.heel[row], columns.trim[row], columns.draft[row]);
    return data.command === 'gz' ? text : `${data.results.attitudes[row].stable ? 'stable' : 'unstable'}: ${text}`;
  }

  const plots = {};
  const across = { gz: { column: 'heel', name: 'heel', unit: '°' }, table: { column: 'draft', name: 'draft', unit: ' m' } }[data.command];
  const group_of = (row) => groups.findLast((first) => first <= row);

  // Rounding errors of zeros are not drawn.
  const smallest = { m: 1e-12 * data.model.meshes[0].diagonal, '°': 1e-9 };
  const without_rounding = (values, unit) => values.map((value) => (Math.abs(value) < (smallest[unit] || 0) ? 0 : value));

  // With many groups, some of them are drawn.
  function series_of({ name, title, unit }) {
    const drawn = groups.filter((_, i) => groups.length <= max_lines || Math.floor(i * max_lines / groups.length) !== Math.floor((i - 1) * max_lines / groups.length));
    const part = (column, first) => columns[column].subarray(first, first + data.group_rows);
    return drawn.map((first) => ({ name: data.command === 'table' ? `trim ${angle(columns.trim[first])}` : title.split(',')[0],
                                   times: part(across.column, first), values: without_rounding(part(name, first), unit) }));
  }

  function marks_of_arms() {
    const { crossings, deck_edge, downflooding, max_starboard, max_port } = data.results;
    const marks = crossings.map(({ heel, returns }) => ({ time: heel, text: `${returns ? 'rests' : 'GZ vanishes'} at ${heel.toFixed(2)}°` }));
    const add = (text, at) => { if (at) marks.push({ time: at.heel, text: `${text} at ${at.heel.toFixed(2)}°` }); };
    add('largest arm', max_starboard);
    add('largest arm', max_port);
    for (const [text, sides] of [['deck edge', deck_edge], ['downflooding', downflooding]]) {
      if (!sides) continue;
      add(text, sides.starboard);
      add(text, sides.port);
    }
    return marks.sort((a, b) => a.time - b.time);
  }

  function make_plots() {
    const on_seek = (when) => {
      const first = group_of(shown.row);
      const times = columns[across.column].subarray(first, first + data.group_rows);
      let nearest = 0;
      times.forEach((time, i) => { if (Math.abs(time - when) < Math.abs(times[nearest] - when)) nearest = i; });
      show_row(first + nearest);
    };
    for (const column of data.columns) {
      if (column.name === across.column || (data.command === 'table' && column.name === 'trim')) continue;
      const options = { title: column.title, unit: column.unit, series: series_of(column), on_seek, missing: 'no values', across };
      if (options.series.every(({ values }) => values.every((value) => value === 0))) {
        Object.assign(options, { series: [{ name: '', times: [], values: [] }], missing: '0 throughout' });
      }
      plots[column.name] = column.name === 'gz' ? new ArmPlot(element('plots'), { ...options, marks: marks_of_arms() }) : new Plot(element('plots'), options);
    }
  }

  // Shows an attitude, and its pose in the keys of a scene file.
  function show_facts(row) {
    const at = data.results.attitudes[row];
    const facts = table_of('The attitude shown', ['', ''], [
      ['attitude', `${row + 1} of ${data.rows}, ${at.stable ? 'stable' : 'unstable'}`], ['heel', angle(at.heel)], ['trim', angle(at.trim)],
      ['draft of the lowest point', `${format_number(at.draft)} m`], ['GM about the two axes of the waterplane', `${at.metacentric_heights.map(format_number).join(' and ')} m`],
      ['m g GM', `${at.stiffness.map(format_number).join(' and ')} N m`], ['displaced volume', `${format_number(at.displacement_volume)} m³`],
      ['energy', `${format_number(at.energy)} J`]]);
    const pose = document.createElement('pre');
    pose.textContent = `[body.client]\nposition = [${at.position.join(', ')}]\norientation = [${at.quaternion_wxyz.join(', ')}]`;
    const text = document.createElement('p');
    text.className = 'soft';
    text.textContent = 'To start a simulation at this attitude:';
    element('plots').replaceChildren(facts, text, pose);
  }

  function draw(state) {
    if (!scene) return;
    place(state);
    scene.render();
  }

  function press(rest) {
    [...element('attitudes').children].forEach((button, i) => button.setAttribute('aria-pressed', String(rests[i] === rest)));
  }

  function show_row(row) {
    Object.assign(shown, { row: Math.min(data.rows - 1, Math.max(0, row)), rest: null });
    const first = group_of(shown.row), text = row_text(shown.row);
    draw(state_of_row(shown.row));
    element('slider').value = shown.row - first;
    element('slider').setAttribute('aria-valuetext', text);
    element('group').value = String(first);
    const position = across ? columns[across.column][shown.row] : null;
    element('position').textContent = across ? `${format_number(position)}${across.unit}` : `${shown.row + 1} of ${data.rows}`;
    element('status').textContent = text;
    for (const plot of Object.values(plots)) plot.show(position);
    if (data.command === 'equilibrium') show_facts(shown.row);
    press(rests.find((rest) => rest.row === shown.row));
  }

  function show_rest(rest) {
    if (rest.row !== null) {
      show_row(rest.row);
      return;
    }
    shown.rest = rest;
    draw(rest.state);
    element('position').textContent = angle(rest.heel);
    element('status').textContent = `at rest: ${rest.text}`;
    for (const plot of Object.values(plots)) plot.show(rest.heel);
    press(rest);
  }

  // Makes a picture of each attitude at rest, as a button that shows it.
  function make_pictures() {
    const size = [340, 208];
    for (const rest of rests) {
      const button = document.createElement('button');
      button.type = 'button';
      button.addEventListener('click', () => show_rest(rest));
      if (scene) {
        const picture = document.createElement('canvas');
        [picture.width, picture.height] = size;
        place(rest.state);
        scene.distance *= 0.75;
        scene.render(...size);
        scene.distance /= 0.75;
        picture.getContext('2d').drawImage(element('canvas'), 0, 0, ...size);
        button.append(picture);
      }
      button.append(rest.text);
      element('attitudes').append(button);
    }
  }

  function next() {
    if (rests.length > 0) {
      const current = rests.findIndex((rest) => (shown.rest ? rest === shown.rest : rest.row === shown.row));
      show_rest(rests[(current + 1) % rests.length]);
    } else {
      const first = group_of(shown.row);
      show_row(groups[(groups.indexOf(first) + 1) % groups.length] + shown.row - first);
    }
  }

  function add_listeners() {
    element('slider').addEventListener('input', (event) => show_row(group_of(shown.row) + Number(event.target.value)));
    element('group').addEventListener('change', (event) => show_row(Number(event.target.value) + shown.row - group_of(shown.row)));
    document.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT') return;
      const first = group_of(shown.row), last = first + data.group_rows - 1;
      const moves = {
        ArrowLeft: () => show_row(Math.max(first, shown.row - 1)),
        ArrowRight: () => show_row(Math.min(last, shown.row + 1)),
        Home: () => show_row(first),
        End: () => show_row(last),
        n: next,
      };
      const move = moves[event.key];
      if (move) move();
      if (move || (scene && scene.key(event))) event.preventDefault();
    });
  }

  function notices() {
    const lines = [];
    if (data.outcome_text) lines.push(data.outcome_text);
    if (data.results.truncated) lines.push('There are more attitudes, of higher energy.');
    if (data.rows < data.all_rows) {
      lines.push(`The page has ${plural(data.rows, 'row', 'rows')} of ${data.all_rows.toLocaleString('en')}, evenly chosen. --csv and --json have all of them.`);
    }
    if (groups.length > max_lines) lines.push(`The plots show ${max_lines} of ${groups.length} trims.`);
    const [mesh] = data.model.meshes;
    if (mesh.shown_triangles < mesh.triangles) {
      lines.push(`The picture shows a hull of ${mesh.shown_triangles.toLocaleString('en')} triangles. The results are those of all ${mesh.triangles.toLocaleString('en')}.`);
    }
    return lines;
  }

  element('title').textContent = `${data.name}: ${titles[data.command]}`;
  document.title = `buoyancy: ${data.name}, ${titles[data.command]}`;
  for (const notice of notices()) {
    const line = document.createElement('p');
    line.className = 'notice';
    line.textContent = notice;
    element('notices').append(line);
  }
  hydrostatics_tables(data, columns, element('tables'));
  element('footer').textContent = `buoyancy-hydrostatics ${data.version}. Rendered with three.js. Requires no network.`;
  if (data.rows > 0) {
    element('slider').max = data.group_rows - 1;
    element('slider').setAttribute('aria-label', across ? across.name : 'attitude');
    for (const first of groups) element('group').add(new Option(data.command === 'table' ? angle(columns.trim[first]) : '', String(first)));
    element('group_choice').hidden = groups.length < 2;
    fill_legend(element('legend'), data.model.bodies[0].center_of_mass !== null, true);
    if (across) make_plots();
    make_pictures();
    add_listeners();
    // Shows the upright ship, at the middle draft, or the first attitude.
    const upright = (angles) => angles.reduce((best, angle, i) => (Math.abs(angle) < Math.abs(angles[best]) ? i : best), 0);
    show_row({ equilibrium: 0, gz: upright(columns.heel || []), table: upright(columns.trim) + Math.floor(data.group_rows / 2) }[data.command]);
  } else {
    element('stage').hidden = true;
  }
  // For tests.
  window.buoyancy_hydrostatics = { data, columns, plots, scene, rests, shown, show_row, show_rest };
})();
