// The page of a sweep: error, time and certainty against one axis, a curve for every other setting.

import { h, panel, section } from "../report/dom.js";
import * as format from "../report/format.js";
import { sweepChart } from "./charts.js";
import { abscissa, curvesOf } from "./groups.js";
import { groupTable, publishedTable } from "./tables.js";

const CHARTS = [
  { heading: "Error", charts: [
    { title: "RMSE of the path (m)", note: "Anchored at the true start pose", figure: "position_rmse_m", log: false },
    { title: "RMSE of the landmarks (m)", note: "Under the rigid motion fitted on the path", figure: "landmark_rmse_m", log: false }] },
  { heading: "Time", charts: [
    { title: "Time per step (ms)", note: "Thread CPU time from one correction to the next, mean of a run", figure: "step_mean_us", scale: 1e-3, log: true }] },
  { heading: "Certainty", charts: [
    { title: "Frobenius norm, mixture (m²)", note: "Of the mean landmark covariance, with the spread between particles", figure: "frobenius_mixture_m2", log: true },
    { title: "Frobenius norm, mean covariance (m²)", note: "Without that spread, as the FastSLAM report had it", figure: "frobenius_mean_m2", log: true }] },
];

const X_LABELS = { "fastslam.particles": "N" };

function charts(data) {
  const x = abscissa(data);
  if (!x) return [];
  return CHARTS.map(({ heading, charts: list }) => section(heading, "grid", list.map(({ figure, scale, ...rest }) => {
    const { curves, levels } = curvesOf(data, x, figure, scale);
    return curves.length ? sweepChart({ ...rest, curves, levels, xLabel: X_LABELS[x] ?? x }).element : null;
  })));
}

function header(data) {
  return h("header", { class: "page-head" },
    h("div", {},
      h("h1", {}, `Sweep over ${data.input}`),
      h("p", { class: "subtitle" }, `${format.count(data.runs)} runs; lines are medians, bands the middle half of the runs that differ in their seed`)),
    h("p", { class: "version" }, ["Waymark", data.version].filter(Boolean).join(" ")));
}

const data = JSON.parse(document.getElementById("sweep-data").textContent);
const isStudy = data.input === "sim:study" && data.axes.includes("fastslam.particles");
document.title = `Sweep over ${data.input} · Waymark`;
document.getElementById("sweep").append(...[
  header(data), ...charts(data),
  section("Details", "stack", isStudy ? publishedTable(data) : null, groupTable(data),
    data.command ? panel("Run it again", {}, h("pre", { class: "command" }, h("code", {}, data.command))) : null),
].filter(Boolean));
