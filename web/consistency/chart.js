// NEES over the steps with its band.

import { Chart, PADDING_PX, axis, referenceLines, seriesOptions, valueAxis, valueRange } from "../report/chart.js";
import * as format from "../report/format.js";
import { color } from "../report/theme.js";
import { lookOf } from "./modes.js";

const IDEAL = [{ value: 3, label: "", color: "muted" }];
const isPowerOfTen = (v) => Number.isInteger(Math.round(Math.log10(v) * 1e6) / 1e6);

export function neesChart({ runs, steps, modes }) {
  const [low, high] = modes[0].band;
  const xs = Array.from({ length: steps }, (_, i) => i + 1);
  const edge = { color: "band-edge", invisible: true };
  const series = [
    { ...edge, label: "99 % band", text: () => `${format.number(low)} to ${format.number(high)}` },
    { ...edge, label: "band, low", hidden: true },
    ...modes.map(lookOf),
  ];
  const columns = [xs, xs.map(() => high), xs.map(() => low), ...modes.map((mode) => mode.nees)];
  const options = (isLog) => ({
    padding: PADDING_PX,
    cursor: { sync: { key: "step", scales: ["x", null] }, y: false, drag: { x: true, y: false, dist: 4 }, points: { size: 7 } },
    legend: { markers: { width: 2, stroke: (_, i) => `var(--${series[i - 1]?.color ?? "muted"})`, fill: (_, i) => (i === 1 ? "var(--band)" : "transparent") } },
    scales: { x: { time: false }, y: { distr: isLog ? 3 : 1, range: valueRange(isLog, IDEAL, 0) } },
    axes: [
      axis({ size: 24, gap: 4, space: 60, label: "Step", values: (_, splits) => splits.map((v) => format.plain(v)) }),
      valueAxis({ label: `Pose NEES, mean of ${format.count(runs)} runs`, ...(isLog ? { filter: (_, splits) => splits.map((v) => (isPowerOfTen(v) ? v : null)) } : {}) }),
    ],
    series: [{ label: "Step", value: (_, v) => (v === null ? "–" : format.plain(v)) }, ...series.map(seriesOptions)],
    bands: [{ series: [1, 2], fill: () => color("band") }],
    hooks: { draw: [referenceLines(IDEAL)] },
  });
  return new Chart({ title: "Pose NEES over the drive", log: false, height: 320,
    note: "Dashed: the ideal, 3. Grey: where the mean of so many runs lies at 99 of 100 steps when the filter is honest" }, options, () => columns);
}
