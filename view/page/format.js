'use strict';
// Formats durations, body statuses and counts for display.

function seconds_text(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  const [factor, unit] = seconds < 1e-6 ? [1e9, 'ns'] : seconds < 1e-3 ? [1e6, 'µs'] : seconds < 1 ? [1e3, 'ms'] : [1, 's'];
  return `${(seconds * factor).toPrecision(3)} ${unit}`;
}

// body_statuses: [name, meaning] by BodyStatus, from the page's data (body_statuses.h).
function status_text(body_statuses, status) {
  const [name, meaning] = body_statuses[status] || [`status ${status}`, 'defined by a later version'];
  return meaning ? `${name}: ${meaning}` : name;
}

function plural(count, one, many) {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}
