// The page of a tuning: what moved, how flat the optimum is, and what it is worth on data that it was not fitted to.

import { h, section, panel } from "../report/dom.js";
import * as format from "../report/format.js";
import { pageHeader } from "../report/summary.js";
import { reproduce } from "../report/tables.js";
import { FALL, profile } from "./charts.js";

const FIGURES = [
  ["nis_per_dof", "NIS per dof (ideal 1)", (v) => Math.abs(Math.log(v))],
  ["position_rmse_m", "Path, from start (m)", (v) => v],
  ["position_rmse_aligned_m", "Path, aligned (m)", (v) => v],
  ["landmark_rmse_m", "Landmarks (m)", (v) => v],
  ["nees_median", "NEES (ideal 2.37)", (v) => Math.abs(Math.log(v / 2.366))],
];

const number = (value) => h("td", { class: "num" }, format.number(value, 4));

// Two cells; the second says by its colour whether it is better. `loss` is the less the better.
function beforeAfter(before, after, loss) {
  if (!format.isNumber(before) || !format.isNumber(after)) return [number(before), number(after)];
  const change = loss(after) - loss(before);
  const verdict = change < 0 ? "better" : change > 0 ? "worse" : "";
  return [h("td", { class: "num against" }, format.number(before, 4)), h("td", { class: `num ${verdict}` }, format.number(after, 4))];
}

const table = (head, rows) => h("div", { class: "scroll" }, h("table", {}, h("thead", {}, head), h("tbody", {}, rows)));
const heads = (first, titles) => h("tr", {}, h("th", {}, first), titles.map((title) => h("th", { class: "num" }, title)));

function keyTable({ keys, idle_keys: idle }) {
  const times = (key) => (key.logarithmic ? `${format.number(key.after / key.before, 3)}×` : "");
  return panel("What moved", { note: `Good: from where to where the score falls by no more than ${FALL} units while the other keys follow${idle.length ? `. Left out because they make no difference here: ${idle.join(", ")}` : ""}` },
    table(heads("Key", ["Before", "After", "Change", "Good"]), keys.map((key) => h("tr", {},
      h("th", { scope: "row" }, h("code", {}, key.name)), number(key.before), number(key.after),
      h("td", { class: "num" }, times(key)), h("td", { class: "num" }, key.good)))));
}

function heldOutTable(data, loss) {
  if (!data.held_out.length) return null;
  return panel("Where it was left out of the fit", { note: `${data.score}, of each part with values that were fitted to the other parts alone` },
    table(heads("Part", ["Before", "After"]), data.held_out.map((part) => h("tr", {},
      h("th", { scope: "row" }, part.name), beforeAfter(part.before, part.after, loss)))));
}

function logTable(data, loss) {
  if (!data.logs.length) return null;
  const shown = FIGURES.filter(([name]) => data.logs.some((log) => format.isNumber(log.before[name])));
  return panel("Each log before and after", { note: "Run as a whole; grey before, green where it is better, red where it is worse" },
    table(h("tr", {}, h("th", {}, "Log"), [data.score, ...shown.map(([, title]) => title)].map((title) => h("th", { class: "num", colspan: 2 }, title))),
      data.logs.map((log) => h("tr", {}, h("th", { scope: "row" }, log.name), beforeAfter(...log.score, loss),
        shown.flatMap(([name, , badness]) => beforeAfter(log.before[name], log.after[name], badness))))));
}

const data = JSON.parse(document.getElementById("tune-data").textContent);
const title = "Tuning";
const loss = data.by === "likelihood" ? (v) => -v : (v) => v;
const unit = data.by === "likelihood" ? "of log-likelihood" : "percent of RMSE";
document.title = `${title} · Waymark`;
document.getElementById("tune").append(...[
  pageHeader({ title, version: data.version, subtitle: `${data.stopped ? "Stopped before the end. " : ""}By ${data.by}: ${format.count(data.keys.length)} keys over ${format.count(data.observations)} observations, ${format.count(data.runs)} runs` }),
  section("Result", "stack", keyTable(data), heldOutTable(data, loss), logTable(data, loss)),
  section(`How flat it is: units ${unit} below the best, along one key while the others stay`, "grid",
    data.keys.filter((key) => key.slice.length > 1).map((key) => profile(key).element)),
  data.command ? section("Details", "stack", reproduce(data)) : null,
].filter(Boolean));
