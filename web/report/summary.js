// The first screen: what ran, how well, how fast.

import { h, panel } from "./dom.js";
import * as format from "./format.js";
import { runColor } from "./theme.js";

export function pageHeader(data) {
  return h("header", { class: "page-head" },
    h("div", {},
      h("h1", {}, data.title || "Waymark run"),
      data.subtitle ? h("p", { class: "subtitle" }, data.subtitle) : null),
    h("p", { class: "version" }, ["Waymark", data.version].filter(Boolean).join(" ")));
}

export function runSummary(data, run) {
  const m = run.metrics ?? {};
  const using = [m.observe, m.associate && `${m.associate} association`].filter(Boolean).join(", ");
  const parts = [
    data.input || m.input,
    [run.name || run.filter, using && `(${using})`].filter(Boolean).join(" "),
    format.isNumber(m.duration_s) ? format.duration(m.duration_s) : null,
    format.isNumber(m.realtime_factor) ? `${format.times(m.realtime_factor)} real time` : null,
  ].filter(Boolean);
  return h("p", { class: "run-summary" }, parts.flatMap((part, i) => (i ? [h("i", {}, "·"), part] : [part])));
}

export function tile(label, [value, unit], note, { state, title } = {}) {
  return h("div", { class: `tile ${state ?? ""}`, title },
    h("dt", {}, label),
    h("dd", { class: "value" }, value, unit ? h("small", {}, unit) : null),
    h("dd", { class: "note" }, note || "\u00a0"));
}

// Where the truth is known it outranks the innovations.
function consistency(nis, nees) {
  if (nees > 6) return { note: `overconfident: NEES ${format.number(nees)}, ideal 3`, state: "warn", title: "Errors are larger than the filter expects" };
  if (nis > 1.5) return { note: "overconfident, ideal 1", state: "warn", title: "Innovations are larger than the filter expects" };
  if (nis < 0.6) return { note: "cautious, ideal 1", state: "warn", title: "Innovations are smaller than the filter expects" };
  return { note: "consistent, ideal 1", state: "good" };
}

// The numbers that answer "did it work": only those that the run has.
export function tiles(run) {
  const m = run.metrics ?? {};
  const truth = m.truth ?? {};
  const step = m.step_us ?? {};
  const has = format.isNumber;
  const list = [];
  if (has(truth.position_rmse_m)) {
    list.push(tile("Position RMSE", format.length(truth.position_rmse_m),
      has(truth.position_rmse_aligned_m) && `${format.lengthText(truth.position_rmse_aligned_m)} aligned`,
      { title: "Anchored at the true start pose; aligned: after one SE(2) fit of the trajectory" }));
  }
  if (has(truth.heading_rmse_deg)) {
    list.push(tile("Heading RMSE", [`${format.number(truth.heading_rmse_deg)}°`],
      has(truth.nees_mean) && `pose NEES ${format.number(truth.nees_mean)}, ideal 3`));
  }
  const landmark_rmse_m = truth.landmark_rmse_m ?? truth.landmark_rmse_self_m;
  if (has(landmark_rmse_m)) {
    const lost = [[truth.landmarks_missed, "missed"], [truth.landmarks_spurious, "spurious"]]
      .filter(([value]) => has(value)).map(([value, word]) => `${format.count(value)} ${word}`).join(", ");
    list.push(tile("Landmark RMSE", format.length(landmark_rmse_m), lost,
      { title: has(truth.landmark_rmse_m) ? "Moved by the SE(2) that aligns the path" : "Landmarks aligned by themselves" }));
  }
  if (has(truth.final_error_m)) {
    list.push(tile("Final error", format.length(truth.final_error_m), has(truth.path_m) && truth.path_m > 0
      && `${format.number((100 * truth.final_error_m) / truth.path_m, 2)} % of ${format.lengthText(truth.path_m)}`));
  }
  if (has(truth.odometry_position_rmse_m)) {
    list.push(tile("Odometry alone", format.length(truth.odometry_position_rmse_m), has(truth.position_rmse_m)
      && truth.position_rmse_m > 0
      && `${format.times(truth.odometry_position_rmse_m / truth.position_rmse_m)} the RMSE of the estimate`));
  }
  if (has(m.nis_per_dof)) {
    const { note, ...look } = consistency(m.nis_per_dof, truth.nees_mean);
    list.push(tile("NIS per dof", [format.number(m.nis_per_dof)], note, look));
  }
  if (has(step.p50)) {
    list.push(tile("Time per step", format.microseconds(step.p50), [
      has(step.p99) ? `p99 ${format.microsecondsText(step.p99)}` : null,
      has(step.max) ? `max ${format.microsecondsText(step.max)}` : null].filter(Boolean).join(", "),
    { title: "Median of thread CPU time" }));
  }
  if (has(m.landmarks)) {
    list.push(tile("Landmarks mapped", [format.count(m.landmarks)],
      has(m.observations) && `from ${format.count(m.observations)} observations`));
  }
  return list.length > 0 ? h("dl", { class: "tiles", style: `--columns: ${Math.min(4, list.length)}` }, list) : null;
}

// One unit down a column, so that rows compare at a glance.
const metres = (value) => (format.isNumber(value) ? `${format.number(value)} m` : "–");

const COLUMNS = [
  ["Position RMSE", (m) => metres(m.truth?.position_rmse_m)],
  ["Aligned", (m) => metres(m.truth?.position_rmse_aligned_m)],
  ["Heading RMSE", (m) => (format.isNumber(m.truth?.heading_rmse_deg) ? `${format.number(m.truth.heading_rmse_deg)}°` : "–")],
  ["Landmark RMSE", (m) => metres(m.truth?.landmark_rmse_m)],
  ["Final error", (m) => metres(m.truth?.final_error_m)],
  ["NIS / dof", (m) => format.number(m.nis_per_dof)],
  ["Step p50", (m) => format.microsecondsText(m.step_us?.p50)],
  ["Step p99", (m) => format.microsecondsText(m.step_us?.p99)],
  ["Real time", (m) => format.times(m.realtime_factor)],
];

// All runs side by side, with dead reckoning as the one to beat.
export function comparison(data) {
  const rows = data.runs.map((run, i) => ({ name: run.name, color: runColor(i), metrics: run.metrics ?? {} }));
  const truth = rows.map((row) => row.metrics.truth).find((t) => format.isNumber(t?.odometry_position_rmse_m));
  if (truth) {
    rows.push({ name: "Odometry alone", color: "dead-reckoning", metrics: { truth: {
      position_rmse_m: truth.odometry_position_rmse_m, final_error_m: truth.odometry_final_error_m } } });
  }
  const columns = COLUMNS.filter(([, cell]) => rows.some((row) => cell(row.metrics) !== "–"));
  return panel("Runs compared", {}, h("div", { class: "scroll" }, h("table", {},
    h("thead", {}, h("tr", {}, h("th", {}, "Run"), columns.map(([name]) => h("th", { class: "num" }, name)))),
    h("tbody", {}, rows.map((row) => h("tr", {},
      h("th", { scope: "row" }, h("span", { class: "swatch", style: `--swatch: var(--${row.color})` }), row.name),
      columns.map(([, cell]) => h("td", { class: "num" }, cell(row.metrics)))))))));
}
