// The page of the consistency study: how large the error of the pose is against what each mode says of it.

import { h, panel, section } from "../report/dom.js";
import * as format from "../report/format.js";
import { pageHeader } from "../report/summary.js";
import { reproduce } from "../report/tables.js";
import { neesChart } from "./chart.js";
import { lookOf } from "./modes.js";

const COLUMNS = ["NEES", "Inside", "RMSE"];

function modeRow(mode) {
  const [low, high] = mode.band;
  const isHonest = low <= mode.nees_mean && mode.nees_mean <= high;
  const { label, color } = lookOf(mode);
  return h("tr", {},
    h("th", { scope: "row" }, h("span", { class: "swatch", style: `--swatch: var(--${color})` }), label),
    h("td", { class: `num ${isHonest ? "good" : "bad"}` }, format.fixed(mode.nees_mean, 2)),
    h("td", { class: "num" }, `${format.fixed(100 * mode.part_inside, 1)} %`),
    h("td", { class: "num" }, `${format.fixed(mode.position_rmse_m, 3)} m`));
}

function modeTable({ modes }) {
  const [low, high] = modes[0].band;
  return panel("Modes compared", { note: `Mean NEES over all steps, steps inside the band of ${format.number(low)} to ${format.number(high)}, error of the position` },
    h("div", { class: "scroll" }, h("table", {},
      h("thead", {}, h("tr", {}, h("th", {}, "Mode"), COLUMNS.map((name) => h("th", { class: "num" }, name)))),
      h("tbody", {}, modes.map(modeRow)))));
}

function comparison(data) {
  const odometry = `${format.plain(100 * data.odometry_sigma_m)} cm and ${format.plain(data.odometry_sigma_deg)}° of noise per step`;
  return section(`Odometry with ${odometry}`, "grid wide-left", neesChart(data).element, modeTable(data));
}

const data = JSON.parse(document.getElementById("consistency-data").textContent);
const title = "Consistency of EKF-SLAM";
const [first] = data.comparisons;
document.title = `${title} · Waymark`;
document.getElementById("consistency").append(...[
  pageHeader({ title, version: data.version, subtitle: first && `${format.count(first.runs)} simulated runs of ${format.count(first.steps)} steps, each with a world of ${format.count(first.landmarks)} landmarks and noise of its own; ranges err by ${format.plain(first.range_sigma_m)} m, bearings by ${format.plain(first.bearing_sigma_deg)}°` }),
  h("p", { class: "lead" }, "NEES is the squared error of the pose in units of the covariance that the filter states. A filter above the band is surer of itself than it may be; one below it is too modest. Curves of which only one is seen lie on each other: point at a chart for their values."),
  ...data.comparisons.map(comparison),
  data.command ? section("Details", "stack", reproduce(data)) : null,
].filter(Boolean));
