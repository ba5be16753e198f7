'use strict';
// The tables of the page of buoyancy-hydrostatics, from its results as --json prints them.

const degrees_text = (value) => (value === null ? '–' : `${value.toFixed(4)}°`);

function attitude_rows(results) {
  const families = { curve: 'one of a curve of attitudes of equal energy', sphere: 'any attitude has the same energy', none: '' };
  return results.attitudes.map((at, i) => [i + 1, at.stable ? 'stable' : 'unstable', at.heel, at.trim, at.draft, ...at.metacentric_heights, at.energy,
    at.residual_force / at.force_bound, at.residual_torque / at.torque_bound, at.reason || families[at.family]]);
}

const attitude_heads = ['', '', 'heel, °', 'trim, °', 'draft, m', 'smaller GM, m', 'larger GM, m', 'energy, J', 'force / bound', 'torque / bound', 'remarks'];

// The characteristic heels of the curve, such as that of the largest arm, for either side.
function heel_rows(results) {
  const rows = [];
  const add = (text, starboard, port) => rows.push([text, degrees_text(starboard), degrees_text(port)]);
  const heel_of = (arm) => (arm === null ? null : arm.heel);
  // The range ends where the arm vanishes, or where water comes in before.
  const end_of_range = (side) => {
    const ends = [results[`vanishing_${side}`], results.downflooding && heel_of(results.downflooding[side])].filter((end) => end !== null);
    return ends.length === 0 ? null : ends.reduce((a, b) => (Math.abs(a) < Math.abs(b) ? a : b));
  };
  add('range of stability ends', end_of_range('starboard'), end_of_range('port'));
  add('largest righting arm', heel_of(results.max_starboard), heel_of(results.max_port));
  const of_points = (text, immersions) => { if (immersions) add(text, heel_of(immersions.starboard), heel_of(immersions.port)); };
  of_points('deck edge goes under water', results.deck_edge);
  of_points('downflooding', results.downflooding);
  for (const { heel, returns } of results.crossings) {
    const text = `GZ vanishes, and the body ${returns ? 'returns to' : 'turns away from'} this heel`;
    add(text, heel > 0 ? heel : null, heel > 0 ? null : heel);
  }
  return rows;
}

function criteria_rows(criteria) {
  return criteria.values.map(({ name, value, required, unit, met }) => [name, value, required, unit, met ? 'met' : 'NOT met']);
}

function weather_rows({ source, outside, ...values }) {
  const text = (value) => (typeof value === 'boolean' ? (value ? 'met' : 'NOT met') : value);
  return [...Object.entries(values).map(([name, value]) => [name, text(value)]), ...outside.map((limit) => ['outside the ships of the formulae', limit])];
}

// The rows of the page, or an evenly chosen part of many, since a browser takes seconds for a hundred thousand cells.
function value_table(data, columns) {
  const max_rows = 500;
  const count = Math.min(data.rows, max_rows);
  const heads = data.columns.map(({ name, unit }) => (unit ? `${name}, ${unit}` : name));
  const rows = Array.from({ length: count }, (_, i) => {
    const row = count < data.rows ? Math.round(i * (data.rows - 1) / (count - 1)) : i;
    return data.columns.map(({ name }) => columns[name][row]);
  });
  const caption = count < data.all_rows ? `${count.toLocaleString('en')} of ${plural(data.all_rows, 'row', 'rows')}, evenly chosen` : plural(count, 'row', 'rows');
  return table_of(caption, heads, rows);
}

function hydrostatics_tables(data, columns, parent) {
  const section = (title, ...content) => {
    const heading = document.createElement('h2');
    heading.textContent = title;
    parent.append(heading, ...content);
  };
  const { results } = data;
  if (data.command === 'equilibrium' && data.rows > 0) {
    section('Attitudes', table_of('The lowest energy first. Force and torque are what is left of weight and buoyancy, relative to their error bounds', attitude_heads, attitude_rows(results)));
  }
  if (data.command === 'gz') {
    section('Heels', table_of('Where the righting arm and the points of the body reach a limit', ['', 'to starboard', 'to port'], heel_rows(results)));
    const criteria = criteria_rows(results.criteria);
    if (criteria.length > 0) {
      section('General criteria', table_of(results.criteria.source, ['criterion', 'value', 'required', 'unit', ''], criteria));
    }
    const weather = results.weather_criterion;
    if (weather) section('Weather criterion', table_of(weather.source, ['value', ''], weather_rows(weather)));
    section('Righting arms', value_table(data, columns));
  }
  if (data.command === 'table') {
    section('Hydrostatic table', value_table(data, columns));
    const lengths = `K ${format_number(results.keel)} m along up and midship ${format_number(results.midship)} m along forward from the origin of the mesh, ` +
      `Lpp ${format_number(results.length_between_perpendiculars)} m`;
    section('Origins', table_of(`${lengths}. LCB and LCF from midship, forward; TCB to port; KB and KM over K`, ['column', 'meaning', 'unit'],
      data.columns.map(({ name, title, unit }) => [name, title, unit])));
  }
  const { water, meshes: [mesh] } = data.model;
  section('The body', table_of(
    `Water: level ${format_number(water.level)} m along [${water.up.join(', ')}], ${format_number(water.density)} kg/m³, gravity ${format_number(water.gravity)} m/s²`,
    ['name', 'mass, kg', 'with liquids in tanks, kg', 'centre of mass without liquids, m', 'volume, m³', 'triangles', 'drawn'],
    [[data.name, data.mass, data.total_mass, data.center_of_mass.map(format_number).join(', '), mesh.volume, mesh.triangles, mesh.shown_triangles]]));
}
