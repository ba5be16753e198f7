'use strict';
// Numbers as people read them.

function seconds_text(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  const [factor, unit] = seconds < 1e-6 ? [1e9, 'ns'] : seconds < 1e-3 ? [1e6, 'µs'] : seconds < 1 ? [1e3, 'ms'] : [1, 's'];
  return `${(seconds * factor).toPrecision(3)} ${unit}`;
}

// BodyStatus by value, as body_wrench_t has it.
const statuses = [
  ['OK', ''],
  ['UNKNOWN_BODY', 'the scene has no body with this id'],
  ['NON_FINITE_POSE', 'NaN or infinity in position or quaternion'],
  ['BAD_QUATERNION', 'the quaternion\'s norm is not 1'],
  ['NON_FINITE_TWIST', 'NaN or infinity in a velocity'],
  ['BAD_LEAD_TIME', 'the lead time is NaN or infinite'],
  ['OPEN_EDGE_WET', 'the mesh is open and its boundary is not wholly dry'],
  ['OUT_OF_RANGE', 'the response is beyond double\'s range'],
];

function status_text(status) {
  const [name, meaning] = statuses[status] || [`status ${status}`, 'of a later version'];
  return meaning ? `${name}: ${meaning}` : name;
}

function plural(count, one, many) {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}
