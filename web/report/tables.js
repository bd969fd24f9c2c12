// Function blocks, all metrics, notes, and how to run it again.

import { h, panel } from "./dom.js";
import * as format from "./format.js";

// Blocks that have published times stand in the order of their numbers, with the times beside them.
export function blockTable(blocks) {
  const sum = (key) => blocks.reduce((total, block) => total + (block[key] ?? 0), 0);
  const total = sum("per_frame_us");
  const published = blocks.some((block) => block.article_per_frame_us !== undefined);
  const rows = published ? blocks : [...blocks].sort((a, b) => (b.per_frame_us ?? 0) - (a.per_frame_us ?? 0));
  const share = (block) => (total > 0 ? (100 * (block.per_frame_us ?? 0)) / total : 0);
  const names = ["Calls", "Mean (µs)", "Per frame (µs)", ...(published ? ["2012 article (µs)"] : [])];
  return panel("Function blocks", { note: published ? "Where a frame spends its time; the article's on an ARM of 500 MHz, without vector instructions"
    : "Where a step spends its time" },
    h("div", { class: "scroll" }, h("table", { class: "blocks" },
      h("thead", {}, h("tr", {}, h("th", {}, "Block"),
        names.map((name) => h("th", { class: "num" }, name)),
        h("th", { class: "share" }, "Share"))),
      h("tbody", {}, rows.map((block) => h("tr", {},
        h("th", { scope: "row" }, block.name),
        h("td", { class: "num" }, format.count(block.calls)),
        h("td", { class: "num" }, format.number(block.mean_us)),
        h("td", { class: "num" }, format.number(block.per_frame_us)),
        published ? h("td", { class: "num" }, format.count(block.article_per_frame_us)) : null,
        h("td", { class: "share" },
          h("span", { class: "bar", style: `--share: ${share(block).toFixed(2)}%` }),
          h("span", { class: "percent" }, `${format.fixed(share(block), share(block) < 10 ? 1 : 0)} %`))))),
      h("tfoot", {}, h("tr", {}, h("th", { colspan: 3 }, "Together"),
        h("td", { class: "num" }, format.number(total)),
        published ? h("td", { class: "num" }, format.count(sum("article_per_frame_us"))) : null,
        h("td", {}))))));
}

const SHOWN_ELSEWHERE = new Set(["blocks", "smoothed", "verdict"]);
const isTable = (value) => Array.isArray(value) && value.length > 0 && value.every(isGroup);
const isGroup = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

function metricText(value) {
  if (Number.isInteger(value)) return format.count(value);
  if (typeof value === "number") return format.plain(value, 5);
  if (value === null || value === undefined) return "–";
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

function pairsTable(name, rows) {
  return h("table", {}, h("caption", {}, name),
    h("tbody", {}, rows.map(([key, value]) => h("tr", {},
      h("th", { scope: "row" }, h("code", {}, key)), h("td", { class: "num" }, metricText(value))))));
}

function rowsTable(name, rows) {
  const keys = [...new Set(rows.flatMap(Object.keys))];
  return h("div", { class: "scroll" }, h("table", {}, h("caption", {}, name),
    h("thead", {}, h("tr", {}, keys.map((key) => h("th", { class: "num" }, h("code", {}, key))))),
    h("tbody", {}, rows.map((row) => h("tr", {}, keys.map((key) => h("td", { class: "num" }, metricText(row[key]))))))));
}

// metrics.json as it is, one table per group; keys stay as they are since scripts read them.
export function metricsTables(metrics) {
  const entries = Object.entries(metrics).filter(([name]) => !SHOWN_ELSEWHERE.has(name));
  const plain = entries.filter(([, value]) => !isGroup(value) && !isTable(value));
  const groups = entries.filter(([, value]) => isGroup(value)).map(([name, value]) =>
    [name, Object.entries(value).filter(([, entry]) => !isTable(entry))]);
  const lists = entries.flatMap(([name, value]) => (isGroup(value) ? Object.entries(value) : [[name, value]])
    .filter(([, entry]) => isTable(entry)));
  const tables = [["run", plain], ...groups];
  return panel("All metrics", { note: "As in metrics.json" },
    h("div", { class: "metric-groups" },
      tables.filter(([, rows]) => rows.length > 0).map(([name, rows]) => pairsTable(name, rows))),
    ...lists.map(([name, rows]) => rowsTable(name, rows)));
}

const DISTANCES = [
  ["Path, from the same start", "position_rmse_m", "m"],
  ["Path, aligned", "position_rmse_aligned_m", "m"],
  ["Heading", "heading_rmse_deg", "deg"],
  ["Landmarks", "landmark_rmse_m", "m"],
];

// How far the causal answer was from what the whole log allows, and both from the truth.
export function smoothedPanel(smoothed, truth) {
  const columns = [["causal from smoothed", smoothed.live], ["causal from truth", smoothed.truth ? truth : null],
    ["smoothed from truth", smoothed.truth]].filter(([, values]) => values);
  const rows = DISTANCES.filter(([, key]) => columns.some(([, values]) => format.isNumber(values[key])));
  return panel("By the whole log", { note: `${format.count(smoothed.poses)} poses and ${format.count(smoothed.observations)} observations`
      + ` estimated at once in ${format.plain(smoothed.cpu_s, 2)} s${smoothed.converged ? "" : ", not converged"}` },
    h("table", {}, h("thead", {}, h("tr", {}, h("th", {}, "RMS distance"), columns.map(([name]) => h("th", { class: "num" }, name)))),
      h("tbody", {}, rows.map(([name, key, unit]) => h("tr", {}, h("th", { scope: "row" }, `${name} (${unit})`),
        columns.map(([, values]) => h("td", { class: "num" }, metricText(values[key]))))))),
    Object.keys(smoothed.calibration ?? {}).length ? pairsTable("What the sensors were like", Object.entries(smoothed.calibration)) : null);
}

export function notesPanel(notes) {
  return h("aside", { class: "panel notes" }, h("h3", {}, "Notes"), h("ul", {}, notes.map((note) => h("li", {}, note))));
}

export function reproduce(run) {
  const copy = h("button", { type: "button", class: "chip", onclick: async () => {
    await navigator.clipboard.writeText(run.command);
    copy.textContent = "Copied";
    setTimeout(() => { copy.textContent = "Copy"; }, 1500);
  } }, "Copy");
  return panel("Run it again", { tools: run.command && navigator.clipboard ? [copy] : [] },
    run.command ? h("pre", { class: "command" }, h("code", {}, run.command)) : null,
    run.config_yaml ? h("details", {}, h("summary", {}, "Configuration in force"),
      h("pre", {}, h("code", {}, run.config_yaml))) : null);
}
