// Images of the run with what was looked for in them: search ellipses, matches, candidates, new corners.

import { h, panel } from "./dom.js";
import * as format from "./format.js";
import { principalAxes } from "./geometry.js";
import { nearestIndex } from "./timeline.js";

const ELLIPSE_SIGMAS = 3;
const FRAME_MS = 300;
const LEGEND = [
  ["found", "found"], ["rejected", "found, not believed"], ["missed", "not found"], ["candidate", "candidate on its ray"],
  ["new", "new corner"], ["not-tried", "not looked for"],
];

// Where it was expected, and where it was, as markup.
function shapes(look) {
  const { candidate, result, u, v, predicted_u, predicted_v } = look;
  const kind = candidate && result === "found" ? "candidate" : result.replace(" ", "-");
  const { major, minor, angle } = principalAxes(look);
  const ellipse = `<ellipse rx="${ELLIPSE_SIGMAS * major}" ry="${ELLIPSE_SIGMAS * minor}"
    transform="translate(${predicted_u} ${predicted_v}) rotate(${format.degrees(angle)})"${candidate ? ' class="dashed"' : ""}/>`;
  const match = `<path d="M${predicted_u} ${predicted_v}L${u} ${v}M${u - 2.5} ${v}h5M${u} ${v - 2.5}v5"/>`;
  const corner = `<rect x="${u - 3}" y="${v - 3}" width="6" height="6"/>`;
  return `<g class="${kind}"><title>${candidate ? "candidate" : "landmark"} ${look.id}: ${result}</title>${major > 0 ? ellipse : ""}${
    result === "found" || result === "rejected" ? match : ""}${result === "new" ? corner : ""}</g>`;
}

export class ImageStripPanel {
  constructor(frames, timeline) {
    this.frames = frames;
    this.timeline = timeline;
    this.t = timeline.shifted(frames.map((frame) => frame.t));
    const { width, height } = frames[0];
    this.image = h("img", { alt: "Image of the camera", width, height });
    this.overlay = h("div");
    this.slider = h("input", { type: "range", min: 0, max: frames.length - 1, value: 0, "aria-label": "SharedImage",
      oninput: () => this.show(Number(this.slider.value), true) });
    this.play = h("button", { type: "button", class: "chip", onclick: () => this.toggle() }, "Play");
    this.caption = h("span", { class: "note" });
    this.element = panel("Images", { id: "image_strip", note: `${frames.length} of the run; ellipses are ${ELLIPSE_SIGMAS}σ of where something was expected` },
      h("div", { class: "strip-frame", style: `aspect-ratio: ${width} / ${height}` }, this.image, this.overlay),
      h("div", { class: "strip-controls" }, this.play, this.slider, this.caption),
      h("p", { class: "strip-legend" }, LEGEND.map(([kind, text]) => h("span", {}, h("i", { class: kind }), text))));
    this.onPoint = ({ detail }) => { if (detail.source !== this) this.show(nearestIndex(this.t, detail.t), false); };
    timeline.addEventListener("point", this.onPoint);
    this.show(Math.floor(frames.length / 2), false);
  }

  show(index, tell) {
    const { png, search_records, width, height } = this.frames[index];
    this.slider.value = index;
    this.image.src = `data:image/png;base64,${png}`;
    this.overlay.innerHTML = `<svg viewBox="-0.5 -0.5 ${width} ${height}">${search_records.map(shapes).join("")}</svg>`;
    const found = search_records.filter((look) => look.result === "found").length;
    this.caption.textContent = `${format.fixed(this.t[index], 1)} s, ${found} found`;
    if (tell) this.timeline.point(this.t[index], this);
  }

  toggle() {
    this.timer = this.timer ? clearInterval(this.timer)
      : setInterval(() => this.show((Number(this.slider.value) + 1) % this.frames.length, true), FRAME_MS);
    this.play.textContent = this.timer ? "Stop" : "Play";
  }

  destroy() {
    clearInterval(this.timer);
    this.timeline.removeEventListener("point", this.onPoint);
  }
}
