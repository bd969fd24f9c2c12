// The page of a calibration from a log: what was found and how surely, and what it does to dead reckoning.

import { timeChart } from "../report/charts.js";
import { h, panel, section } from "../report/dom.js";
import * as format from "../report/format.js";
import { MapPanel } from "../report/map.js";
import { pageHeader } from "../report/summary.js";
import { notesPanel, reproduce } from "../report/tables.js";
import { Timeline } from "../report/timeline.js";

const SIGMAS = 3;

// Every row has a scale of its own, from the leftmost to the rightmost of what it shows.
function range({ value, sigma, before }) {
  const low = Math.min(before, value - SIGMAS * sigma);
  const high = Math.max(before, value + SIGMAS * sigma);
  const at = (x) => `${(high > low ? 4 + (92 * (x - low)) / (high - low) : 50).toFixed(2)}%`;
  const bar = (name, count) => h("i", { class: name, style: `left: ${at(value - count * sigma)}; right: calc(100% - ${at(value + count * sigma)})` });
  const mark = (name, x) => h("i", { class: name, style: `left: ${at(x)}` });
  return h("span", { class: "range" }, h("i", { class: "line" }), bar("three", SIGMAS), bar("one", 1), mark("before", before), mark("found", value));
}

function findingRow([key, finding]) {
  return h("tr", {},
    h("th", { scope: "row" }, h("code", {}, key)),
    h("td", { class: "num" }, format.number(finding.before, 5)),
    h("td", { class: `num ${finding.told ? "" : "unobservable"}` }, finding.told ? format.number(finding.value, 5) : "as assumed"),
    h("td", { class: "num" }, `± ${format.number(finding.sigma, 2)}`),
    h("td", { class: "place" }, range(finding)));
}

const findingTable = ({ found }) => panel("Found", { note: "Bars: one and three standard deviations. Ring: as configured before. Every row has its own scale" },
  h("div", { class: "scroll" }, h("table", {},
    h("thead", {}, h("tr", {}, h("th", {}, "What"), ["Before", "Found", "Uncertainty"].map((name) => h("th", { class: "num" }, name)), h("th", {}, ""))),
    h("tbody", {}, Object.entries(found).map(findingRow)))));

const DRIFT = [
  ["final_m", "At the end (m)"], ["final_heading_deg", "Heading at the end (°)"], ["percent", "% of the way"],
  ["rmse_m", "RMSE (m)"], ["rmse_aligned_m", "RMSE, aligned (m)"],
];

function driftTable(drift, reference) {
  const row = (name, colour, values) => h("tr", {},
    h("th", { scope: "row" }, h("span", { class: "swatch", style: `--swatch: var(--${colour})` }), name),
    DRIFT.map(([key]) => h("td", { class: "num" }, format.number(values[key]))));
  return panel(`Dead reckoning against ${reference}`, { note: `Both start at the same pose; the way is ${format.lengthText(drift.path_m)}` },
    h("div", { class: "scroll" }, h("table", {},
      h("thead", {}, h("tr", {}, h("th", {}, "Odometry"), DRIFT.map(([, title]) => h("th", { class: "num" }, title)))),
      h("tbody", {}, row("as configured", "dead-reckoning", drift.before), row("calibrated", "run-1", drift.after)))));
}

function distanceChart(timeline, { before, after }) {
  const series = [
    { label: "as configured", color: "dead-reckoning", dash: [5, 4], table: [before.t, before.m] },
    { label: "calibrated", color: "run-1", width: 1.75, table: [after.t, after.m] },
  ];
  return timeChart(timeline, { title: "Distance of dead reckoning from the path by the whole log (m)", id: "distance",
    series, tables: series.map(({ table }) => table), floor: 0, log: false, height: 230 });
}

const data = JSON.parse(document.getElementById("calibration-data").textContent);
const map = { ...data.map, runs: data.map?.runs ?? [] };
const timeline = new Timeline(map);
document.title = `${data.title} · Waymark`;
document.getElementById("calibration").append(...[
  pageHeader({ title: data.title, version: data.version, subtitle: `From ${data.input} alone: path, map and robot by maximum likelihood over the whole log, in ${format.count(data.runs)} runs` }),
  data.notes?.length ? notesPanel(data.notes) : null,
  section("The robot", "stack", findingTable(data)),
  section("What it does to dead reckoning", "stack",
    data.drift ? driftTable(data.drift, "the path by the whole log") : null,
    data.drift_from_truth ? driftTable(data.drift_from_truth, "the truth") : null,
    map.runs[0]?.path?.t?.length ? new MapPanel(map, timeline).element : null,
    data.distance?.after?.t?.length ? distanceChart(timeline, data.distance).element : null),
  section("Details", "stack", reproduce(data)),
].filter(Boolean));
