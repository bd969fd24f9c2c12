// The page of a sensor's calibration: what was found, and how its errors lie by range and by bearing.

import { h, panel, section } from "../report/dom.js";
import * as format from "../report/format.js";
import { Chart, PADDING_PX, axis, referenceLines, seriesOptions, valueAxis } from "../report/chart.js";
import { pageHeader } from "../report/summary.js";
import { notesPanel, reproduce } from "../report/tables.js";
import { color } from "../report/theme.js";

const number = (value, digits = 5) => h("td", { class: "num" }, format.isNumber(value) ? format.number(value, digits) : "");
const table = (heads, rows) => h("div", { class: "scroll" }, h("table", {},
  h("thead", {}, h("tr", {}, heads.map((head, i) => h("th", { class: i ? "num" : null }, head)))), h("tbody", {}, rows)));

const findingTable = ({ found }) => panel("Found", { note: "One standard deviation" },
  table(["What", "Before", "Found", "Uncertainty"], found.map(({ name, before, value, sigma }) => h("tr", {},
    h("th", { scope: "row" }, h("code", {}, name)), number(before), number(value),
    h("td", { class: "num" }, sigma > 0 ? `± ${format.number(sigma, 2)}` : "")))));

// A bar of one standard deviation to either side of each mean.
function errorBars(points) {
  return (u) => {
    const { ctx } = u;
    ctx.save();
    ctx.strokeStyle = color("accent");
    ctx.lineWidth = 1.5 * devicePixelRatio;
    ctx.beginPath();
    for (const { at, mean, sigma } of points) {
      const x = u.valToPos(at, "x", true);
      ctx.moveTo(x, u.valToPos(mean - sigma, "y", true));
      ctx.lineTo(x, u.valToPos(mean + sigma, "y", true));
    }
    ctx.stroke();
    ctx.restore();
  };
}

function errorChart({ title, note, x, y, points }) {
  const xs = points.map(({ at }) => at);
  const [least, most] = [Math.min(...xs), Math.max(...xs)];
  const margin = 0.05 * (most - least || 1);
  const reach = 1.1 * Math.max(...points.map(({ mean, sigma }) => Math.abs(mean) + sigma), 1e-9);
  const line = { label: `mean error, ${y}`, color: "accent", points: true, size: 6 };
  const options = () => ({
    padding: PADDING_PX,
    cursor: { y: false, drag: { x: false, y: false }, points: { size: 7 } },
    scales: { x: { time: false, range: () => [least - margin, most + margin] }, y: { range: () => [-reach, reach] } },
    axes: [axis({ size: 26, gap: 4, space: 60, values: (_, splits) => splits.map((v) => format.plain(v, 3)) }), valueAxis()],
    series: [{ label: x, value: (_, v) => (v === null ? "–" : format.number(v, 4)) }, seriesOptions(line)],
    hooks: { drawAxes: [referenceLines([{ value: 0, label: "", color: "muted" }])], draw: [errorBars(points)] },
  });
  return new Chart({ title, note, height: 230 }, options, () => [xs, points.map(({ mean }) => mean)]);
}

const data = JSON.parse(document.getElementById("sensor-data").textContent);
document.title = `${data.title} · Waymark`;
document.getElementById("sensor").append(...[
  pageHeader({ title: data.title, version: data.version, subtitle: data.subtitle }),
  data.notes.length ? notesPanel(data.notes) : null,
  section("The sensor", "stack", data.found.length ? findingTable(data) : null),
  section("Its errors: mean, and one standard deviation to either side", "grid",
    data.charts.filter(({ points }) => points.length).map((chart) => errorChart(chart).element)),
  section("Details", "stack", reproduce(data)),
].filter(Boolean));
