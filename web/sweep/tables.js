// All groups with their medians, and the published figures beside ours.

import { h, panel } from "../report/dom.js";
import * as format from "../report/format.js";
import { fastslamGroup } from "./groups.js";

const FIGURES = [
  ["position_rmse_m", "Path, from start (m)"], ["position_rmse_aligned_m", "Path, aligned (m)"],
  ["landmark_rmse_m", "Landmarks (m)"], ["nees_median", "NEES"], ["step_mean_us", "Step (µs)"],
  ["frobenius_mixture_m2", "‖P‖ mixture (m²)"], ["frobenius_mean_m2", "‖P‖ mean (m²)"],
];

const cell = (quartiles) => h("td", { class: "num", title: quartiles ? `${format.number(quartiles[0])} to ${format.number(quartiles[2])}` : undefined },
  quartiles ? format.number(quartiles[1]) : "–");

export function groupTable(data) {
  return panel("All settings", { note: "Medians over the runs that differ in their seed; the middle half on hover. Diverged: worse than odometry alone" },
    h("div", { class: "scroll" }, h("table", { class: "groups" },
      h("thead", {}, h("tr", {}, data.axes.map((axis) => h("th", {}, h("code", {}, axis))),
        ["Runs", "Failed", "Diverged", ...FIGURES.map(([, title]) => title)].map((title) => h("th", { class: "num" }, title)))),
      h("tbody", {}, data.groups.map((group) => h("tr", {},
        data.axes.map((axis) => h("td", {}, group.axes[axis] ?? "–")),
        [group.runs, group.failed, group.diverged].map((value) => h("td", { class: "num" }, format.count(value))),
        FIGURES.map(([name]) => cell(group.figures?.[name]))))))));
}

// One published figure and ours.
const pair = (published, ours) => [
  h("td", { class: "num against" }, published),
  h("td", { class: "num" }, ours === undefined ? "–" : format.number(ours)),
];

export function publishedTable(data) {
  const median = (group, name, scale = 1) => (group?.figures?.[name] ? group.figures[name][1] * scale : undefined);
  const span = ([low, high]) => (low === high ? format.number(low) : `${format.number(low)}–${format.number(high)}`);
  const titles = ["Path RMSE (m)", "Landmark RMSE (m)", "Time per step (ms)", "‖P‖ of the mean covariance (m²)"];
  return panel("Beside the original FastSLAM report", { note: "FastSLAM on a Pioneer 3-DX with ArUco markers, in Python. Its columns are grey" },
    h("div", { class: "scroll" }, h("table", {},
      h("thead", {},
        h("tr", {}, h("th", {}, "Observed"), h("th", { class: "num" }, "N"), titles.map((title) => h("th", { class: "num", colspan: 2 }, title))),
        h("tr", {}, h("th", {}), h("th", {}), titles.flatMap(() => [h("th", { class: "num against" }, "report"), h("th", { class: "num" }, "here")]))),
      h("tbody", {}, data.published.map((row) => {
        const group = fastslamGroup(data, row.observe, row.particles);
        return h("tr", {}, h("th", { scope: "row" }, row.observe), h("td", { class: "num" }, format.count(row.particles)),
          pair(format.number(row.path_rmse_m), median(group, "position_rmse_aligned_m")),
          pair(format.number(row.landmark_rmse_m), median(group, "landmark_rmse_m")),
          pair(format.number(row.step_ms), median(group, "step_mean_us", 1e-3)),
          pair(span(row.frobenius_m2), median(group, "frobenius_mean_m2")));
      })))),
    h("p", { class: "hint" }, "Not the same experiment: the report drove a real robot and took the path's error against odometry after a similarity fitted on the landmarks; here the truth is known, and one rigid motion fitted on the path serves path and landmarks. The world is the simulated study, with the report's sensor limits (0.336 to 5.36 m, 49.56°)."));
}
