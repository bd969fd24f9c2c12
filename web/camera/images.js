// Corners and errors as drawings, in pixels of the images.

import { h, panel } from "../report/dom.js";
import * as format from "../report/format.js";

// Only numbers go into the markup.
function drawing(width, height, className, shapes) {
  const box = h("div", { class: className });
  box.innerHTML = `<svg viewBox="-0.5 -0.5 ${width} ${height}">${shapes.join("")}</svg>`;
  return box;
}

// So that a usual error is about a fortieth of the image.
export function magnification(data) {
  const wanted = data.width_px / 40 / Math.max(data.rms_px, 1e-6);
  const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  return steps.filter((step) => step <= wanted).at(-1) ?? 1;
}

export function errorImage(view, data, times) {
  const [width, height] = view.size;
  const stroke = width / 320;
  const errors = view.residuals.map(([u, v, du, dv]) => {
    const look = Math.hypot(du, dv) > 2 * data.rms_px ? "large" : "usual";
    return `<line class="${look}" x1="${u}" y1="${v}" x2="${u - times * du}" y2="${v - times * dv}" stroke-width="${1.2 * stroke}"/>`
      + `<circle class="${look}" cx="${u}" cy="${v}" r="${1.6 * stroke}"/>`;
  });
  const frame = `<image href="data:image/png;base64,${view.png}" x="-0.5" y="-0.5" width="${width}" height="${height}"/>`;
  return drawing(width, height, "image", [frame, ...errors]);
}

// Where corners were, over how well the lens is known there.
export function coverage(data) {
  const { columns, rows, places } = data.projection;
  const sigmas = places.map(([, , sigma]) => sigma);
  const [smallest, largest] = [Math.min(...sigmas), Math.max(...sigmas)];
  const [width, height] = [data.width_px / columns, data.height_px / rows];
  const cells = places.map(([u, v, sigma]) => `<rect class="cell" x="${u - width / 2}" y="${v - height / 2}" width="${width}" height="${height}"`
    + ` fill-opacity="${(0.85 * Math.min(1, sigma / largest)).toFixed(3)}"><title>${format.number(sigma, 2)} px</title></rect>`);
  const dot = data.width_px / 240;
  const corners = data.views.filter(({ verdict }) => verdict === "used").flatMap(({ residuals }) =>
    residuals.map(([u, v]) => `<circle class="corner" cx="${u}" cy="${v}" r="${dot}"/>`));
  const arm = data.width_px / 40;
  const [cu, cv] = [data.intrinsics[2].value, data.intrinsics[3].value];
  const cross = `<path class="principal" d="M${cu - arm} ${cv}h${2 * arm}M${cu} ${cv - arm}v${2 * arm}" stroke-width="${dot}"/>`;
  return panel("Corners of all views", { note: `Over how well the lens is known there: from ${format.number(smallest, 2)} px (light) to ${format.number(largest, 2)} px (dark), one standard deviation. The cross is the principal point` },
    drawing(data.width_px, data.height_px, "coverage", [...cells, ...corners, cross]));
}
