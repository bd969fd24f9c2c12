// The page of a camera's calibration: may it be trusted, what is it like, and what did each image say.

import { h, panel, section } from "../report/dom.js";
import * as format from "../report/format.js";
import { pageHeader, tile } from "../report/summary.js";
import { reproduce } from "../report/tables.js";
import { coverage, errorImage, magnification } from "./images.js";

const px = (value, digits = 2) => (format.isNumber(value) ? `${format.fixed(value, digits)} px` : "–");
const range = ([low, high]) => `${format.fixed(low, 1)} to ${format.fixed(high, 1)} px`;

function verdict(data) {
  if (!data.weak) {
    return h("section", { class: "verdict good" }, h("h2", {}, "Good"),
      h("p", {}, "The views are enough, differ enough, and agree: the camera may be trusted."));
  }
  return h("section", { class: "verdict bad" }, h("h2", {}, "Weak"),
    h("p", {}, "camera.yaml was written, but these views do not settle what the camera is like:"),
    h("ul", {}, data.weaknesses.map(({ what, advice }) => h("li", {}, h("strong", {}, what), h("br"), `Next: ${advice}.`))));
}

function tiles(data) {
  const { held_out: held } = data;
  const list = [
    tile("Reprojection RMS", [format.fixed(data.rms_px, 3), "px"], `${format.count(data.views_used)} views`),
    held && tile("On views left out", [format.fixed(held.rms_px, 3), "px"], `${held.folds} folds, poses fitted, camera not`),
    held && tile("Focal length", [format.fixed((data.intrinsics[0].value + data.intrinsics[1].value) / 2, 1), "px"], `${range(held.focal_px)} without some views`),
    tile("Image covered", [format.fixed(100 * data.covered, 0), "%"], "8 × 6 cells with corners in them"),
  ].filter(Boolean);
  return h("dl", { class: "tiles", style: `--columns: ${list.length}` }, list);
}

const MEANINGS = {
  fu_px: "focal length along rows", fv_px: "along columns", cu_px: "principal point, column", cv_px: "row",
  k1: "radial", k2: "radial, 4th order", p1: "tangential", p2: "tangential", k3: "radial, 6th order",
};

function intrinsicsTable(data) {
  const k3 = data.intrinsics.some(({ name }) => name === "k3") ? "" : ` k3 is 0: ${Math.abs(data.k3_in_sigmas) < 3
    ? `estimated, it is ${format.fixed(Math.abs(data.k3_in_sigmas), 1)} standard deviations from 0` : "it does not help on views left out"}.`;
  return panel("Intrinsics", { note: `Standard deviations: from the residuals, and between fits without some of the views.${k3}` },
    h("div", { class: "scroll" }, h("table", {},
      h("thead", {}, h("tr", {}, h("th", {}, ""), ["Value", "± residuals", "± views"].map((name) => h("th", { class: "num" }, name)))),
      h("tbody", {}, data.intrinsics.map((row) => h("tr", {},
        h("th", { scope: "row", title: MEANINGS[row.name] }, h("code", {}, row.name)),
        h("td", { class: "num" }, format.plain(row.value)),
        h("td", { class: "num" }, format.number(row.sigma, 2)),
        h("td", { class: "num" }, data.held_out ? format.number(row.held_out_sigma, 2) : "–")))))));
}

function viewRow(view, largest, unit) {
  const share = format.isNumber(view.rms_px) ? Math.min(100, (100 * view.rms_px) / largest) : 0;
  return h("tr", { class: view.verdict === "used" ? null : "dropped" },
    h("th", { scope: "row" }, view.name),
    h("td", { class: "share" }, h("span", { class: "bar", style: `--share: ${share.toFixed(1)}%` }), h("span", { class: "percent" }, format.fixed(view.rms_px, 2))),
    h("td", { class: "num" }, format.fixed(view.held_out_rms_px, 2)),
    h("td", { class: "num" }, format.fixed(view.edge_px, 1)),
    h("td", { class: "num" }, format.isNumber(view.tilt_deg) ? `${format.fixed(view.tilt_deg, 0)}°` : "–"),
    h("td", { class: "num" }, format.isNumber(view.distance_m) ? `${format.number(view.distance_m, 2)} ${unit}` : "–"),
    h("td", {}, view.verdict === "used" ? "used" : `${view.verdict}: ${view.why}`));
}

function viewTable(data) {
  const used = data.views.filter(({ verdict: fate }) => fate === "used");
  const largest = Math.max(...used.map((view) => view.rms_px));
  const missing = data.images - data.views.length;
  const note = ["Errors are root mean squares of the distance between a corner and where the camera puts it, in pixels; edge is how wide the board's edges are",
    missing > 0 && `${format.count(missing)} frames without the board, or like others, are not listed`].filter(Boolean).join(". ");
  return panel("Views", { note }, h("div", { class: "scroll" }, h("table", { class: "blocks" },
    h("thead", {}, h("tr", {}, h("th", {}, "SharedImage"), h("th", { class: "share" }, "Error (px)"),
      ["Left out (px)", "Edge (px)", "Tilt", "Distance"].map((name) => h("th", { class: "num" }, name)), h("th", {}, "Verdict"))),
    h("tbody", {}, data.views.map((view) => viewRow(view, largest, data.has_scale ? "m" : "squares"))))));
}

function errorImages(data) {
  const times = magnification(data);
  const shown = data.views.filter(({ png }) => png);
  return panel("Errors in the images", { note: `From each corner to where the camera puts it, ${times} times as long as it is` },
    h("div", { class: "images" }, shown.map((view) => h("figure", { class: view.verdict === "used" ? null : "dropped" },
      errorImage(view, data, times),
      h("figcaption", {}, h("strong", {}, view.name), ` ${view.verdict === "used" ? px(view.rms_px) : view.verdict}`)))));
}

const data = JSON.parse(document.getElementById("camera-data").textContent);
const title = "Camera calibration";
document.title = `${title} · Waymark`;
document.getElementById("camera").append(...[
  pageHeader({ title, version: data.version, subtitle: `${format.count(data.views_used)} of ${format.count(data.images)} images of ${data.width_px} × ${data.height_px} pixels, ${data.board}` }),
  verdict(data),
  tiles(data),
  section("Camera", "grid wide-left", coverage(data), intrinsicsTable(data)),
  section("Images", "stack", viewTable(data), errorImages(data)),
  data.command ? section("Details", "stack", reproduce(data)) : null,
].filter(Boolean));
