// The map: paths, landmarks with their 2-sigma ellipses, ground truth. A canvas that zooms, pans and answers hovering.

import { choice, download, h, toggleButton } from "./dom.js";
import * as format from "./format.js";
import { boundsOf, principalAxes, roundStep, transformLandmark, transformPath } from "./geometry.js";
import { MapView } from "./map_view.js";
import { color, onThemeChange, runColor } from "./theme.js";
import { nearestIndex } from "./timeline.js";

const HOVER_PX = 14;
const ELLIPSE_SIGMAS = 2;

export class MapPanel {
  constructor(data, timeline) {
    this.data = data;
    this.timeline = timeline;
    this.view = new MapView();
    this.selected = 0;
    this.aligned = false;
    this.shown = { truth: true, dead_reckoning: true, landmarks: true, ellipses: true, true_landmarks: true,
      smoothed: true };
    this.shown_runs = data.runs.map(() => true);
    this.time = null;
    this.box = null;
    this.canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "Map of paths and landmarks" });
    this.tooltip = h("div", { class: "tooltip", hidden: true });
    this.frame = h("div", { class: "map-frame" }, this.canvas, this.tooltip, this.zoomButtons());
    this.element = h("section", { class: "panel map", id: "map" },
      h("header", { class: "panel-head" }, h("h3", {}, "Map"), h("div", { class: "tools" }, this.tools())),
      this.frame,
      h("p", { class: "hint" }, "Wheel or pinch zooms, drag pans, Shift-drag zooms to a box, double click shows all. Hover for values."));
    this.prepare();
    this.listen();
  }

  // --- content ---------------------------------------------------------------------------------------------------

  tools() {
    const layer = (name, label, swatch) => {
      const text = h("span", {}, h("span", { class: `swatch ${swatch.shape ?? ""}`, style: `--swatch: var(--${swatch.color})` }), label);
      return toggleButton(text, true, (on) => { this.shown[name] = on; this.draw(); });
    };
    const runs = this.data.runs.map((run, i) => ({ run, i })).filter(({ run }) => run.path?.t?.length > 0);
    const landmarks = this.data.runs.some((run) => run.landmarks?.length > 0);
    const tools = [
      this.data.truth?.t?.length ? layer("truth", "Truth", { color: "truth" }) : null,
      this.data.dead_reckoning?.t?.length ? layer("dead_reckoning", "Odometry alone", { color: "dead-reckoning", shape: "dashed" }) : null,
      ...runs.map(({ run, i }) => toggleButton(
        h("span", {}, h("span", { class: "swatch", style: `--swatch: var(--${runColor(i)})` }), run.name || run.filter || "Estimate"),
        true, (on) => { this.shown_runs[i] = on; this.draw(); })),
      this.data.runs.some((run) => run.smoothed?.t?.length) ? layer("smoothed", "By the whole log", { color: "smoothed" }) : null,
      landmarks ? layer("landmarks", "Landmarks", { color: "landmark", shape: "dot" }) : null,
      landmarks ? layer("ellipses", "2σ", { color: "landmark", shape: "ring" }) : null,
      this.data.truth_landmarks?.length ? layer("true_landmarks", "True landmarks", { color: "truth", shape: "cross" }) : null,
    ];
    if (this.data.runs.some((run) => run.alignment)) {
      tools.push(choice([
        { value: false, text: "Anchored at start", title: "The estimate starts at the true start pose" },
        { value: true, text: "SE(2)-aligned", title: "The whole estimate moved by one fitted rotation and translation" },
      ], false, (aligned) => { this.aligned = aligned; this.prepare(); this.draw(); }, "Frame of the estimate"));
    }
    return tools;
  }

  zoomButtons() {
    const button = (text, title, action) =>
      h("button", { type: "button", title, "aria-label": title, onclick: () => { action(); this.draw(); } }, text);
    return h("div", { class: "zoom-buttons" },
      button("+", "Zoom in", () => this.view.zoom(1.5)),
      button("−", "Zoom out", () => this.view.zoom(1 / 1.5)),
      button("⤢", "Show all", () => this.fit()),
      button("↓", "Save as PNG", () => this.save()));
  }

  // Everything in the frame that is drawn, with paths ready to stroke at any zoom.
  prepare() {
    this.runs = this.data.runs.map((run) => {
      const transform = this.aligned ? run.alignment : null;
      return {
        path: transformPath(run.path ?? { t: [], x: [], y: [] }, transform),
        smoothed: transformPath(run.smoothed ?? { t: [], x: [], y: [] }, transform),
        landmarks: (run.landmarks ?? []).map((landmark) => transformLandmark(landmark, transform)),
      };
    });
    this.truth = this.data.truth ?? { t: [], x: [], y: [] };
    this.dead_reckoning = this.data.dead_reckoning ?? { t: [], x: [], y: [] };
    this.true_landmarks = this.data.truth_landmarks ?? [];
    const bounds = boundsOf([this.truth, ...this.runs.map((run) => run.path)]);
    // Canvas paths hold single precision: keep their numbers small.
    this.origin = bounds ? [(bounds.left + bounds.right) / 2, (bounds.bottom + bounds.top) / 2] : [0, 0];
    this.strokes = new Map([this.truth, this.dead_reckoning, ...this.runs.flatMap((run) => [run.path, run.smoothed])]
      .map((path) => [path, this.strokeOf(path)]));
  }

  strokeOf({ x, y }, first = 0, last = x.length - 1) {
    const stroke = new Path2D();
    let pen_down = false;
    for (let i = first; i <= last; ++i) {
      if (x[i] === null || y[i] === null) pen_down = false;
      else {
        stroke[pen_down ? "lineTo" : "moveTo"](x[i] - this.origin[0], y[i] - this.origin[1]);
        pen_down = true;
      }
    }
    return stroke;
  }

  select(run) {
    this.selected = run;
    this.time = null;
    this.draw();
  }

  // Odometry alone may wander far off: it decides the view only when there is nothing else.
  fit() {
    const columns = (points) => ({ x: points.map((p) => p.x), y: points.map((p) => p.y) });
    const sets = [this.truth, ...this.runs.map((run) => run.path), columns(this.true_landmarks),
      ...this.runs.map((run) => columns(run.landmarks))];
    this.view.fit(boundsOf(sets) ? sets : [this.dead_reckoning]);
  }

  // --- drawing ---------------------------------------------------------------------------------------------------

  resize() {
    const { clientWidth: width, clientHeight: height } = this.frame;
    if (width === 0 || height === 0) return;
    const ratio = Math.max(devicePixelRatio || 1, document.documentElement.classList.contains("paper") ? 2 : 1);
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.ratio = ratio;
    this.view.resize(width, height);
    if (!this.view.moved) this.fit();
    this.paint();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => { this.pending = null; this.paint(); });
  }

  paint() {
    if (!this.ratio) return;
    const ctx = this.canvas.getContext("2d");
    ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    ctx.fillStyle = color("map");
    ctx.fillRect(0, 0, this.view.width, this.view.height);
    ctx.lineJoin = ctx.lineCap = "round";
    this.paintGrid(ctx);
    if (this.shown.dead_reckoning) this.paintPath(ctx, this.dead_reckoning, "dead-reckoning", 1.25, [5, 4]);
    if (this.shown.truth) this.paintPath(ctx, this.truth, "truth", 1.5);
    this.inDrawingOrder().forEach((i) => this.paintRun(ctx, i));
    if (this.shown.smoothed && this.shown_runs[this.selected])
      this.paintPath(ctx, this.runs[this.selected].smoothed, "smoothed", 1.25);
    if (this.shown.true_landmarks) this.paintTrueLandmarks(ctx);
    this.paintEnds(ctx);
    this.paintMoment(ctx);
    this.paintScale(ctx);
    this.paintBox(ctx);
  }

  // The selected run comes last, on top of the others.
  inDrawingOrder() {
    const others = this.runs.map((_, i) => i).filter((i) => i !== this.selected);
    return [...others, this.selected].filter((i) => this.shown_runs[i]);
  }

  paintRun(ctx, i) {
    const { path, landmarks } = this.runs[i];
    const on_top = i === this.selected;
    if (this.shown.ellipses && this.shown.landmarks) landmarks.forEach((landmark) => this.paintEllipse(ctx, landmark, runColor(i)));
    ctx.globalAlpha = on_top ? 1 : 0.75;
    this.paintPath(ctx, path, runColor(i), on_top ? 2 : 1.5);
    ctx.globalAlpha = 1;
    if (on_top && this.timeline.range && path.t.length > 0) this.paintZoomed(ctx, path, runColor(i));
    if (this.shown.landmarks) landmarks.forEach((landmark) => this.paintLandmark(ctx, landmark, runColor(i)));
  }

  inWorld(ctx, paint) {
    const [x, y] = this.view.pixel(...this.origin);
    const scale = this.view.scale;
    ctx.save();
    ctx.transform(scale, 0, 0, -scale, x, y);
    paint(1 / scale);
    ctx.restore();
  }

  paintPath(ctx, path, name, width, dash = [], stroke = this.strokes.get(path)) {
    this.inWorld(ctx, (pixel) => {
      ctx.strokeStyle = color(name);
      ctx.lineWidth = width * pixel;
      ctx.setLineDash(dash.map((length) => length * pixel));
      ctx.stroke(stroke);
    });
  }

  // The part of the path that the charts are zoomed to.
  paintZoomed(ctx, path, name) {
    const [begin, end] = this.timeline.range.map((t) => nearestIndex(path.t, t + this.timeline.offset));
    ctx.globalAlpha = 0.28;
    this.paintPath(ctx, path, name, 9, [], this.strokeOf(path, begin, end));
    ctx.globalAlpha = 1;
  }

  paintEllipse(ctx, landmark, name) {
    const { major, minor, angle } = principalAxes(landmark);
    if (!Number.isFinite(major)) return;
    const [px, py] = this.view.pixel(landmark.x, landmark.y);
    const scale = ELLIPSE_SIGMAS * this.view.scale;
    ctx.beginPath();
    ctx.ellipse(px, py, major * scale, minor * scale, -angle, 0, 2 * Math.PI);
    ctx.fillStyle = ctx.strokeStyle = color(name);
    ctx.globalAlpha = 0.14;
    ctx.fill();
    ctx.globalAlpha = 0.7;
    ctx.lineWidth = 1;
    ctx.stroke();
    ctx.globalAlpha = 1;
  }

  paintLandmark(ctx, landmark, name) {
    const [px, py] = this.view.pixel(landmark.x, landmark.y);
    const chosen = landmark === this.hovered;
    ctx.beginPath();
    ctx.arc(px, py, chosen ? 5 : 3, 0, 2 * Math.PI);
    ctx.fillStyle = color(name);
    ctx.fill();
    ctx.strokeStyle = color("map");
    ctx.lineWidth = 1;
    ctx.stroke();
  }

  paintTrueLandmarks(ctx) {
    ctx.strokeStyle = color("truth");
    ctx.lineWidth = 1.25;
    ctx.beginPath();
    for (const { x, y } of this.true_landmarks) {
      const [px, py] = this.view.pixel(x, y);
      ctx.moveTo(px - 5, py);
      ctx.lineTo(px + 5, py);
      ctx.moveTo(px, py - 5);
      ctx.lineTo(px, py + 5);
    }
    ctx.stroke();
  }

  // A ring where the path begins, a square where it ends.
  paintEnds(ctx) {
    const shown = this.shown_runs[this.selected] && this.runs[this.selected];
    const path = shown && shown.path.t.length ? shown.path : this.truth;
    const ends = [0, path.t.length - 1].filter((i) => i >= 0 && path.x[i] !== null && path.y[i] !== null);
    ends.forEach((i) => {
      const [px, py] = this.view.pixel(path.x[i], path.y[i]);
      ctx.beginPath();
      if (i === 0) ctx.arc(px, py, 5.5, 0, 2 * Math.PI);
      else ctx.rect(px - 5, py - 5, 10, 10);
      ctx.fillStyle = color(i === 0 ? "map" : path === this.truth ? "truth" : runColor(this.selected));
      ctx.fill();
      ctx.strokeStyle = color(i === 0 ? (path === this.truth ? "truth" : runColor(this.selected)) : "map");
      ctx.lineWidth = i === 0 ? 2.5 : 1.5;
      ctx.stroke();
      this.paintLabel(ctx, i === 0 ? "start" : "end", px + 10, i === 0 ? py - 9 : py + 17);
    });
  }

  paintLabel(ctx, text, px, py) {
    ctx.font = `600 11px ${color("font")}`;
    ctx.lineWidth = 3;
    ctx.strokeStyle = color("map");
    ctx.strokeText(text, px, py);
    ctx.fillStyle = color("muted");
    ctx.fillText(text, px, py);
  }

  // Where everyone was at the time that is pointed at, with the error as a line.
  paintMoment(ctx) {
    if (this.time === null) return;
    const stamp = this.time + this.timeline.offset;
    const at = (path) => {
      const i = nearestIndex(path.t, stamp);
      return i < 0 || path.x[i] === null ? null : [...this.view.pixel(path.x[i], path.y[i]), path.theta?.[i]];
    };
    const estimate = this.shown_runs[this.selected] ? at(this.runs[this.selected].path) : null;
    const truth = this.shown.truth ? at(this.truth) : null;
    const dead_reckoning = this.shown.dead_reckoning ? at(this.dead_reckoning) : null;
    if (estimate && truth) {
      ctx.strokeStyle = color("bad");
      ctx.lineWidth = 1.5;
      ctx.beginPath();
      ctx.moveTo(estimate[0], estimate[1]);
      ctx.lineTo(truth[0], truth[1]);
      ctx.stroke();
    }
    if (dead_reckoning) this.paintDot(ctx, dead_reckoning, "dead-reckoning");
    if (truth) this.paintDot(ctx, truth, "truth");
    if (estimate) this.paintRobot(ctx, estimate);
  }

  paintDot(ctx, [px, py], name) {
    ctx.beginPath();
    ctx.arc(px, py, 4, 0, 2 * Math.PI);
    ctx.fillStyle = color(name);
    ctx.fill();
    ctx.strokeStyle = color("map");
    ctx.lineWidth = 1.5;
    ctx.stroke();
  }

  paintRobot(ctx, [px, py, theta]) {
    if (!format.isNumber(theta)) return this.paintDot(ctx, [px, py], runColor(this.selected));
    ctx.save();
    ctx.translate(px, py);
    ctx.rotate(-theta);
    ctx.beginPath();
    ctx.moveTo(12, 0);
    ctx.lineTo(-8, 7);
    ctx.lineTo(-4, 0);
    ctx.lineTo(-8, -7);
    ctx.closePath();
    ctx.fillStyle = color(runColor(this.selected));
    ctx.fill();
    ctx.strokeStyle = color("map");
    ctx.lineWidth = 1.5;
    ctx.stroke();
    ctx.restore();
  }

  paintGrid(ctx) {
    const { width, height, scale } = this.view;
    const step = roundStep(80 / scale);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const [left, top] = this.view.world(0, 0);
    const [right, bottom] = this.view.world(width, height);
    ctx.strokeStyle = color("grid");
    ctx.fillStyle = color("muted");
    ctx.font = `11px ${color("font")}`;
    ctx.lineWidth = 1;
    ctx.beginPath();
    const labels = [];
    for (let k = Math.ceil(left / step); k * step <= right; ++k) {
      const px = Math.round(this.view.pixel(k * step, 0)[0]) + 0.5;
      ctx.moveTo(px, 0);
      ctx.lineTo(px, height);
      labels.push([format.fixed(k * step, decimals), px + 4, height - 6]);
    }
    for (let k = Math.ceil(bottom / step); k * step <= top; ++k) {
      const py = Math.round(this.view.pixel(0, k * step)[1]) + 0.5;
      ctx.moveTo(0, py);
      ctx.lineTo(width, py);
      labels.push([format.fixed(k * step, decimals), 6, py - 4]);
    }
    ctx.stroke();
    // Corners belong to neither axis.
    labels.filter(([, px, py]) => px > 40 ? px < width - 110 : py < height - 20 && py > 14).forEach((label) => ctx.fillText(...label));
  }

  paintScale(ctx) {
    const metres = roundStep(60 / this.view.scale);
    const pixels = metres * this.view.scale;
    const right = this.view.width - 12;
    const y = this.view.height - 14;
    ctx.strokeStyle = color("ink");
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    ctx.moveTo(right - pixels, y - 4);
    ctx.lineTo(right - pixels, y);
    ctx.lineTo(right, y);
    ctx.lineTo(right, y - 4);
    ctx.stroke();
    ctx.textAlign = "center";
    this.paintLabel(ctx, metres < 1 ? `${format.plain(100 * metres)} cm` : `${format.plain(metres)} m`, right - pixels / 2, y - 6);
    ctx.textAlign = "start";
  }

  paintBox(ctx) {
    if (!this.box) return;
    const [x0, y0, x1, y1] = this.box;
    ctx.fillStyle = color("selection");
    ctx.strokeStyle = color("muted");
    ctx.lineWidth = 1;
    ctx.fillRect(x0, y0, x1 - x0, y1 - y0);
    ctx.strokeRect(x0, y0, x1 - x0, y1 - y0);
  }

  save() {
    this.paint();
    download("map.png", this.canvas.toDataURL("image/png"));
  }

  // --- interaction -----------------------------------------------------------------------------------------------

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.frame);
    onThemeChange(() => this.resize());
    this.timeline.addEventListener("point", ({ detail }) => {
      if (detail.source === this) return;
      this.time = detail.t;
      this.draw();
    });
    this.timeline.addEventListener("zoom", () => this.draw());
    this.listenToPointer();
    this.listenToWheel();
    this.canvas.addEventListener("dblclick", () => { this.fit(); this.draw(); });
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
  }

  listenToPointer() {
    const down = new Map(); // pointer id -> last position
    const at = (event) => [event.offsetX, event.offsetY];
    const release = (event) => {
      down.delete(event.pointerId);
      if (this.box) this.zoomToBox();
      this.canvas.classList.toggle("dragging", down.size > 0);
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, at(event));
      if (event.shiftKey) this.box = [...at(event), ...at(event)];
      this.canvas.classList.toggle("dragging", !this.box);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const last = down.get(event.pointerId);
      if (!last) return this.hover(...at(event));
      const now = at(event);
      if (this.box) this.box = [this.box[0], this.box[1], ...now];
      else if (down.size === 1) this.view.pan(now[0] - last[0], now[1] - last[1]);
      else this.pinch(down, event.pointerId, now);
      down.set(event.pointerId, now);
      this.draw();
    });
    this.canvas.addEventListener("pointerup", release);
    this.canvas.addEventListener("pointercancel", release);
    this.canvas.addEventListener("pointerleave", () => this.leave());
  }

  pinch(down, moving, now) {
    const other = [...down].find(([id]) => id !== moving)[1];
    const last = down.get(moving);
    const distance = ([x, y]) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
    this.view.zoom(distance(now) / distance(last), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  }

  zoomToBox() {
    const [x0, y0, x1, y1] = this.box;
    this.box = null;
    if (Math.abs(x1 - x0) > 5 && Math.abs(y1 - y0) > 5) {
      const [left, top] = this.view.world(Math.min(x0, x1), Math.min(y0, y1));
      const [right, bottom] = this.view.world(Math.max(x0, x1), Math.max(y0, y1));
      this.view.show({ left, right, bottom, top });
    }
    this.draw();
  }

  // A wheel that scrolls the page past the map must not be caught by it half way.
  listenToWheel() {
    let scrolled = -Infinity;
    addEventListener("scroll", () => { scrolled = performance.now(); }, { passive: true });
    this.canvas.addEventListener("wheel", (event) => {
      if (performance.now() - scrolled < 300) return;
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      this.view.zoom(Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0016)), event.offsetX, event.offsetY);
      this.draw();
    }, { passive: false });
  }

  onKey(event) {
    const step = 60;
    const actions = {
      "+": () => this.view.zoom(1.25), "=": () => this.view.zoom(1.25), "-": () => this.view.zoom(0.8),
      0: () => this.fit(), ArrowLeft: () => this.view.pan(step, 0), ArrowRight: () => this.view.pan(-step, 0),
      ArrowUp: () => this.view.pan(0, step), ArrowDown: () => this.view.pan(0, -step),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
    this.draw();
  }

  hover(px, py) {
    const found = this.nearestLandmark(px, py) ?? this.nearestPose(px, py);
    this.hovered = found?.landmark ?? null;
    this.time = found?.t ?? null;
    if (found?.t !== undefined) this.timeline.point(found.t, this);
    this.showTooltip(found, px, py);
    this.draw();
  }

  leave() {
    this.hovered = this.time = null;
    this.tooltip.hidden = true;
    this.draw();
  }

  nearestLandmark(px, py) {
    const candidates = this.shown.landmarks
      ? this.inDrawingOrder().flatMap((i) => this.runs[i].landmarks.map((landmark) => ({ i, landmark }))) : [];
    const truths = this.shown.true_landmarks ? this.true_landmarks.map((landmark) => ({ landmark })) : [];
    let best = null;
    let best_distance = HOVER_PX * 0.75;
    for (const candidate of [...truths, ...candidates]) {
      const [x, y] = this.view.pixel(candidate.landmark.x, candidate.landmark.y);
      const distance = Math.hypot(x - px, y - py);
      if (distance <= best_distance) [best, best_distance] = [candidate, distance];
    }
    return best && { landmark: best.landmark, lines: this.landmarkLines(best) };
  }

  landmarkLines({ i, landmark }) {
    const where = `x ${format.fixed(landmark.x, 3)} m, y ${format.fixed(landmark.y, 3)} m`;
    if (i === undefined) return [`True landmark ${landmark.id}`, where];
    const { major, minor } = principalAxes(landmark);
    const truth = this.true_landmarks.find((other) => other.id === landmark.id);
    return [
      `Landmark ${landmark.id}${this.runs.length > 1 ? ` · ${this.data.runs[i].name}` : ""}`, where,
      `σ ${format.lengthText(major)} × ${format.lengthText(minor)}`,
      format.isNumber(landmark.observations) ? `${format.count(landmark.observations)} observations` : null,
      truth ? `${format.lengthText(Math.hypot(truth.x - landmark.x, truth.y - landmark.y))} from truth` : null,
    ].filter(Boolean);
  }

  nearestPose(px, py) {
    const paths = [
      ...(this.shown.dead_reckoning ? [["Odometry alone", this.dead_reckoning]] : []),
      ...(this.shown.truth ? [["Truth", this.truth]] : []),
      ...this.inDrawingOrder().map((i) => [this.data.runs[i].name || "Estimate", this.runs[i].path]),
      ...(this.shown.smoothed && this.shown_runs[this.selected] ? [["By the whole log", this.runs[this.selected].smoothed]] : []),
    ];
    const [x, y] = this.view.world(px, py);
    let best = null;
    let best_distance = HOVER_PX / this.view.scale;
    for (const [name, path] of paths) {
      for (let i = 0; i < path.t.length; ++i) {
        const distance = Math.hypot(path.x[i] - x, path.y[i] - y);
        if (path.x[i] !== null && distance <= best_distance) [best, best_distance] = [{ name, path, i }, distance];
      }
    }
    return best && { t: best.path.t[best.i] - this.timeline.offset, lines: this.poseLines(best) };
  }

  poseLines({ name, path, i }) {
    const { offset } = this.timeline;
    return [
      name,
      `t ${format.fixed(path.t[i] - offset, 2)} s${offset ? ` (stamp ${path.t[i].toFixed(2)})` : ""}`,
      `x ${format.fixed(path.x[i], 3)} m, y ${format.fixed(path.y[i], 3)} m`,
      format.isNumber(path.theta?.[i]) ? `heading ${format.fixed(format.degrees(path.theta[i]), 1)}°` : null,
    ].filter(Boolean);
  }

  showTooltip(found, px, py) {
    this.tooltip.hidden = !found;
    if (!found) return;
    this.tooltip.replaceChildren(...found.lines.map((line, i) => h(i ? "span" : "b", {}, line)));
    const left = px + 16 + this.tooltip.offsetWidth > this.view.width ? px - 12 - this.tooltip.offsetWidth : px + 16;
    const top = Math.min(py + 12, this.view.height - this.tooltip.offsetHeight - 6);
    this.tooltip.style.transform = `translate(${Math.max(4, left)}px, ${Math.max(4, top)}px)`;
  }
}
