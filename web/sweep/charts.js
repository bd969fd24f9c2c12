// Medians with the band of the middle half over one axis of the sweep.

import uPlot from "uplot";
import { Chart, PADDING_PX, axis, referenceLines, seriesOptions, valueAxis, valueRange } from "../report/chart.js";
import * as format from "../report/format.js";
import { color, runColor } from "../report/theme.js";

const BAND_ALPHA = "24";
const MANY = 20; // times: from here on an axis is logarithmic

const isWide = (values) => Math.min(...values) > 0 && Math.max(...values) / Math.min(...values) >= MANY;

// Low, median and high of a curve, each over the same xs.
const columnsOf = (xs, { points }) => [1, 2, 3].map((k) => {
  const at = new Map(points.map((point) => [point[0], point[k]]));
  return xs.map((x) => at.get(x) ?? null);
});

export function sweepChart({ title, note, xLabel, curves, levels, log }) {
  const xs = [...new Set(curves.flatMap(({ points }) => points.map(([x]) => x)))].sort((a, b) => a - b);
  const columns = [xs, ...curves.flatMap((curve) => columnsOf(xs, curve))];
  const lines = levels.map(({ label, value }) => ({ label: `${label} ${format.number(value)}`, value, color: "ink" }));
  const series = curves.flatMap(({ label }, i) => [
    { label: `${label}, low`, color: runColor(i), invisible: true, hidden: true },
    { label, color: runColor(i), width: 2 },
    { label: `${label}, high`, color: runColor(i), invisible: true, hidden: true },
  ]);
  const options = (isLog) => ({
    padding: PADDING_PX,
    cursor: { y: false, drag: { x: false, y: false }, points: { size: 7 } },
    legend: { markers: { width: 2, stroke: (_, i) => `var(--${series[i - 1]?.color ?? "muted"})`, fill: () => "transparent" } },
    scales: {
      x: { time: false, distr: isWide(xs) ? 3 : 1, range: () => (isWide(xs) ? [xs[0] / 1.15, xs.at(-1) * 1.15] : [xs[0], xs.at(-1)]) },
      y: { distr: isLog ? 3 : 1, range: valueRange(isLog, lines, 0) },
    },
    axes: [
      axis({ size: 26, gap: 4, splits: () => xs, values: (_, splits) => splits.map((v) => format.plain(v)), filter: (_, splits) => splits }),
      valueAxis(isLog ? { filter: (_, splits) => splits.map((v) => (Number.isInteger(Math.round(Math.log10(v) * 1e6) / 1e6) ? v : null)) } : {}),
    ],
    series: [
      { label: xLabel, value: (_, v) => (v === null ? "–" : format.plain(v)) },
      ...series.map((s) => ({ ...seriesOptions(s), spanGaps: true, points: { show: !s.invisible, size: 5, fill: () => color(s.color), stroke: () => color(s.color) } })),
    ],
    bands: curves.map((_, i) => ({ series: [3 * i + 3, 3 * i + 1], fill: () => color(runColor(i)) + BAND_ALPHA })),
    hooks: { draw: lines.length ? [referenceLines(lines)] : [] },
  });
  return new Chart({ title, note, log, height: 240 }, options, () => columns);
}
