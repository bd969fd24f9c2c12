// Charts over time with a shared cursor and zoom, and the histogram of innovations.

import uPlot from "uplot";
import { Chart, PADDING_PX, axis, referenceLines, seriesOptions, valueAxis, valueRange } from "./chart.js";
import * as format from "./format.js";
import { color } from "./theme.js";

const SYNC_KEY = "time";

// Series of different stamps stand in one table with holes: take the nearest entry that is there.
function nearestFilled(u, column, i) {
  const values = u.data[column];
  if (values[i] !== undefined) return i;
  for (let step = 1; step < 200; ++step) {
    if (values[i - step] !== undefined) return i - step;
    if (values[i + step] !== undefined) return i + step;
  }
  return i;
}

// Values over time. `series` share the stamps `t`, unless `tables` [[t, values], ...] gives each its own.
export function timeChart(timeline, { t, series, tables, lines = [], bands = [], floor, ...rest }) {
  const columns = tables ? uPlot.join(tables.map(([stamps, values]) => [timeline.shifted(stamps), values]))
    : [timeline.shifted(t), ...series.map((s) => s.values)];
  // A logarithm has no place for zero: leave it out.
  const positive = () => columns.map((column, i) => (i ? column.map((v) => (v > 0 ? v : v === undefined ? v : null)) : column));
  const whole = [timeline.first, timeline.last];
  const stamps = columns[0];
  let plots = null;

  // The chart tells the time it is pointed at, and listens to the map.
  const onPoint = ({ detail }) => {
    if (detail.source === chart || !plots || detail.source instanceof Chart) return;
    plots.setCursor({ left: plots.valToPos(detail.t, "x"), top: plots.bbox.height / devicePixelRatio / 2 }, false);
  };
  timeline.addEventListener("point", onPoint);

  const options = (log) => ({
    padding: PADDING_PX,
    cursor: {
      sync: { key: SYNC_KEY, scales: ["x", null] },
      y: false,
      drag: { x: true, y: false, dist: 4 },
      focus: { prox: -1 },
      points: { size: 7 },
      dataIdx: tables ? nearestFilled : undefined,
    },
    legend: { markers: { width: 2, stroke: (_, i) => `var(--${series[i - 1]?.color ?? "muted"})`, fill: (_, i) => (series[i - 1]?.points ? `var(--${series[i - 1].color})` : "transparent") } },
    scales: {
      x: { time: false, range: (_, min, max) => (min === null || (min === stamps[0] && max === stamps.at(-1)) ? whole : [min, max]) },
      y: { distr: log ? 3 : 1, range: valueRange(log, lines, floor) },
    },
    axes: [
      axis({ size: 26, gap: 4, space: 70, values: (_, splits) => splits.map((v) => format.plain(v)) }),
      valueAxis(log ? { filter: (u, splits) => splits.map((v) => (Number.isInteger(Math.round(Math.log10(v) * 1e6) / 1e6) ? v : null)) } : {}),
    ],
    series: [
      { label: timeline.offset ? "t since start" : "t", value: (_, v) => (v === null ? "–" : `${format.fixed(v, 2)} s`) },
      ...series.map(seriesOptions),
    ],
    bands: bands.map(({ series: pair, color: name }) => ({ series: pair, fill: () => color(name) })),
    hooks: {
      draw: lines.length ? [referenceLines(lines)] : [],
      setScale: [(u, key) => { if (key === "x" && u.scales.x.min !== null) timeline.zoom(u.scales.x.min, u.scales.x.max); }],
      setCursor: [(u) => { if (u.cursor.event && u.cursor.idx !== null) timeline.point(u.data[0][u.cursor.idx], chart); }],
      // A band has two edges and one entry in the legend.
      setSeries: [(u, i, option) => {
        const pair = bands.find((band) => band.series[0] === i);
        if (pair && option.show !== undefined) u.setSeries(pair.series[1], { show: option.show });
      }],
    },
    ready: (u) => {
      plots = u;
      if (timeline.range) u.setScale("x", { min: timeline.range[0], max: timeline.range[1] });
    },
  });
  const chart = new Chart(rest, options, (log) => (log ? positive() : columns));
  const destroy = chart.destroy.bind(chart);
  chart.destroy = () => { timeline.removeEventListener("point", onPoint); destroy(); };
  return chart;
}

// An error inside its own 3-sigma band.
export function errorChart(timeline, { title, note, t, error, sigma, unit, color: name }) {
  const scaled = (factor) => sigma.map((s) => (s === null ? null : factor * s));
  const with_unit = (_, value) => `${format.number(value, 3)} ${unit}`;
  const series = [{ label: "error", values: error, color: name, text: with_unit }];
  const bands = [];
  if (sigma.length > 0) {
    series.unshift(
      { label: "±3σ", values: scaled(3), color: "band-edge", invisible: true, text: with_unit },
      { label: "−3σ", values: scaled(-3), color: "band-edge", invisible: true, hidden: true });
    bands.push({ series: [1, 2], color: "band" });
  }
  return timeChart(timeline, { title, note, t, series, bands, lines: [{ value: 0, label: "", color: "axis" }] });
}

// Every innovation against the gate. Few lie far above it: they are drawn at the upper edge, with their value on hover.
export function innovationChart(timeline, { t, nis, accepted, landmark, gate }, color_name) {
  const top = gate > 0 ? 2 * gate : Infinity;
  const high = nis.filter((value) => value > top).length;
  const pick = (wanted) => nis.map((value, i) => (value !== null && Boolean(accepted[i] ?? 1) === wanted ? Math.min(value, top) : null));
  const text = (i) => [format.number(nis[i], 3), landmark?.[i] ? `(landmark ${landmark[i]})` : ""].join(" ").trim();
  const rejected = pick(false);
  const series = [{ label: "accepted", values: pick(true), color: color_name, points: true, text }];
  if (rejected.some((value) => value !== null)) {
    series.push({ label: "rejected", values: rejected, color: "bad", points: true, size: 5, text });
  }
  return timeChart(timeline, {
    title: "Innovations", id: "innovations",
    note: `NIS of each observation${high ? `; ${format.count(high)} above the axis are drawn at its edge` : ""}`,
    t, series, lines: gate > 0 ? [{ value: gate, label: `gate ${format.number(gate, 3)}`, color: "bad" }] : [],
    floor: 0, log: false, height: 210,
  });
}

// Density of NIS against the chi-square density that it has when the filter is consistent.
export function innovationHistogram({ dof, bin_width, density, expected }, color_name) {
  const centers = density.map((_, i) => (i + 0.5) * bin_width);
  const options = () => ({
    padding: PADDING_PX,
    cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
    legend: { markers: { width: 2, stroke: (_, i) => `var(--${i === 1 ? color_name : "ink"})`, fill: (_, i) => (i === 1 ? `var(--${color_name})` : "transparent") } },
    scales: { x: { time: false, range: () => [0, density.length * bin_width] }, y: { range: (_, min, max) => [0, max > 0 ? max * 1.06 : 1] } },
    axes: [axis({ size: 26, gap: 4, space: 40 }), valueAxis()],
    series: [
      { label: "NIS", value: (_, v) => (v === null ? "–" : `${format.number(v - bin_width / 2, 3)} to ${format.number(v + bin_width / 2, 3)}`) },
      { ...seriesOptions({ label: "seen", color: color_name, filled: true, paths: uPlot.paths.bars({ size: [0.86, Infinity] }) }), width: 0 },
      seriesOptions({ label: "expected", color: "ink", width: 1.5, paths: uPlot.paths.spline() }),
    ],
  });
  return new Chart({ title: "NIS against χ²", note: `Density for ${dof} degree${dof === 1 ? "" : "s"} of freedom`, height: 210 },
    options, () => [centers, density, expected]);
}

export function stepChart(timeline, { t, us, budget_us }, summary, color_name) {
  const lines = [
    ["p50", summary?.p50, "muted"], ["p99", summary?.p99, "muted"], ["budget", budget_us, "bad"],
  ].filter(([, value]) => value > 0).map(([name, value, line_color]) =>
    ({ value, label: `${name} ${format.microsecondsText(value)}`, color: line_color }));
  const largest = us.reduce((max, value) => Math.max(max, value ?? 0), 0);
  return timeChart(timeline, {
    title: "Time per step (µs)", id: "steps", note: "Thread CPU time", t,
    series: [{ label: "step", values: us, color: color_name, width: 1, text: (_, value) => format.microsecondsText(value) }],
    lines, floor: 0, log: largest > 20 * (summary?.p50 ?? Infinity), height: 210,
  });
}
