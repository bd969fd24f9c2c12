// Groups of runs (all seeds of one setting) as curves over one of the axes.

const PARTICLES = "fastslam.particles";

const isNumeric = (text) => text !== undefined && text !== "" && Number.isFinite(Number(text));
const distinct = (values) => [...new Set(values)];

// The axis that charts run over: the number of particles, else the first axis of several numbers.
export function abscissa(data) {
  const several = (axis) => distinct(data.groups.map((group) => group.axes[axis]).filter(isNumeric)).length > 1;
  return [PARTICLES, ...data.axes].find((axis) => data.axes.includes(axis) && several(axis));
}

// What tells a group from others, without the axis that charts run over.
function settingOf(data, x) {
  const telling = data.axes.filter((axis) => axis !== x && distinct(data.groups.map((group) => group.axes[axis])).length > 1);
  return (group) => telling.map((axis) => group.axes[axis]).filter(Boolean).join(", ") || "all runs";
}

// Curves of quartiles [{label, points: [[x, low, median, high], ...]}] and, for groups that have no place on the
// axis, levels [{label, value}].
export function curvesOf(data, x, figure, scale = 1) {
  const setting = settingOf(data, x);
  const curves = new Map();
  const levels = [];
  for (const group of data.groups) {
    const quartiles = group.figures?.[figure]?.map((value) => value * scale);
    if (!quartiles) continue;
    const label = setting(group);
    if (!isNumeric(group.axes[x])) {
      levels.push({ label, value: quartiles[1] });
      continue;
    }
    if (!curves.has(label)) curves.set(label, []);
    curves.get(label).push([Number(group.axes[x]), ...quartiles]);
  }
  return {
    curves: [...curves].map(([label, points]) => ({ label, points: points.sort((a, b) => a[0] - b[0]) })),
    levels,
  };
}

// The group of FastSLAM that observes this with so many particles.
export function fastslamGroup(data, observe, particles) {
  return data.groups.find(({ axes }) => (axes.filter ?? "fastslam") === "fastslam"
    && (axes.observe ?? "range-bearing") === observe && Number(axes[PARTICLES]) === particles);
}
