// The score along one key, the others held at their best.

import uPlot from "uplot";
import { Chart, PADDING_PX, axis, referenceLines, seriesOptions, valueAxis } from "../report/chart.js";
import * as format from "../report/format.js";
import { color } from "../report/theme.js";

export const FALL = 2; // units that an interval allows
const MANY = 20; // times: from here on an axis is logarithmic
const DEPTH = 5; // times FALL: what of a profile is shown

// Vertical lines at the old and the new value, and the interval shaded.
function marks({ before, after, low, high }) {
  return (u) => {
    const { ctx, bbox } = u;
    const ratio = devicePixelRatio;
    const place = (value) => u.valToPos(value, "x", true);
    const within = (x) => Math.min(Math.max(x, bbox.left), bbox.left + bbox.width);
    const left = low === null ? bbox.left : within(place(low));
    const right = high === null ? bbox.left + bbox.width : within(place(high));
    ctx.save();
    ctx.fillStyle = color("band");
    ctx.fillRect(left, bbox.top, right - left, bbox.height);
    for (const [value, name] of [[before, "dead-reckoning"], [after, "accent"]]) {
      const x = within(place(value));
      ctx.strokeStyle = color(name);
      ctx.lineWidth = 2 * ratio;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
  };
}

export function profile(key) {
  const points = key.slice.filter(([, score]) => score >= -DEPTH * FALL);
  const xs = [...points.map(([x]) => x), key.before, key.after];
  const [least, most] = [Math.min(...xs), Math.max(...xs)];
  const wide = key.logarithmic && most / least >= MANY;
  const margin = 0.03 * (most - least);
  const line = { label: "score less the best", color: "accent", width: 2 };
  const options = () => ({
    padding: PADDING_PX,
    cursor: { y: false, drag: { x: false, y: false }, points: { size: 7 } },
    legend: { markers: { width: 2, stroke: () => "var(--accent)", fill: () => "transparent" } },
    scales: {
      x: { time: false, distr: wide ? 3 : 1, range: () => (wide ? [least / 1.1, most * 1.1] : [least - margin, most + margin]) },
      y: { range: () => [-DEPTH * FALL, FALL] },
    },
    axes: [
      axis({ size: 26, gap: 4, space: 60, values: (_, splits) => splits.map((v) => (v === null ? "" : format.plain(v, 3))),
        ...(wide ? { filter: (_, splits) => splits.map((v) => (Number.isInteger(Math.round(Math.log10(v) * 1e6) / 1e6) ? v : null)) } : {}) }),
      valueAxis(),
    ],
    series: [{ label: "value", value: (_, v) => (v === null ? "–" : format.number(v, 4)) },
      { ...seriesOptions(line), paths: uPlot.paths.linear(), points: { show: true, size: 5, fill: () => color("accent"), stroke: () => color("accent") } }],
    hooks: { drawAxes: [marks(key)], draw: [referenceLines([{ value: -FALL, label: "", color: "muted" }])] },
  });
  return new Chart({ title: key.name, note: `${format.plain(key.before, 4)} before (grey), ${format.plain(key.after, 4)} after${key.good ? `; ${key.good}` : ""}`, height: 200 },
    options, () => [points.map(([x]) => x), points.map(([, score]) => score)]);
}
