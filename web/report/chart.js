// A chart in a panel: frame, axes, scales, saving as an image. Drawing is uPlot's.

import uPlot from "uplot";
import { download, h, panel, toggleButton } from "./dom.js";
import * as format from "./format.js";
import { color, onThemeChange } from "./theme.js";

const HEIGHT_PX = 180;
export const PADDING_PX = [10, 10, 0, 0];

const axisFont = () => `11px ${color("font")}`;

export function axis(options = {}) {
  return {
    stroke: () => color("muted"),
    font: axisFont(),
    labelFont: axisFont(),
    labelGap: 2,
    labelSize: 18,
    grid: { stroke: () => color("grid"), width: 1 },
    ticks: { show: false },
    ...options,
  };
}

// As wide as its longest number.
const axisWidth = (_, texts) => 14 + 6.5 * Math.max(3, ...(texts ?? []).map((text) => text.length));

export const valueAxis = (options) => axis({
  size: axisWidth, gap: 6, space: 32, values: (_, splits) => splits.map((v) => (v === null ? "" : format.plain(v))), ...options });

// Dashed lines at given values, with their names at the right end.
export function referenceLines(lines) {
  return (u) => {
    const { ctx, bbox } = u;
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineWidth = ratio;
    ctx.setLineDash([4 * ratio, 4 * ratio]);
    ctx.font = `${11 * ratio}px ${color("font")}`;
    ctx.textAlign = "right";
    for (const { value, label, color: name } of lines) {
      const y = Math.round(u.valToPos(value, "y", true));
      ctx.strokeStyle = ctx.fillStyle = color(name);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      const above = y - 4 * ratio > bbox.top + 10 * ratio;
      ctx.strokeStyle = color("panel");
      ctx.save();
      ctx.setLineDash([]);
      ctx.lineWidth = 3 * ratio;
      ctx.strokeText(label, bbox.left + bbox.width - 4 * ratio, above ? y - 4 * ratio : y + 12 * ratio);
      ctx.restore();
      ctx.fillText(label, bbox.left + bbox.width - 4 * ratio, above ? y - 4 * ratio : y + 12 * ratio);
    }
    ctx.restore();
  };
}

export function seriesOptions(series) {
  return {
    label: series.label,
    class: series.hidden ? "hidden" : undefined,
    scale: "y",
    stroke: () => (series.invisible ? "transparent" : color(series.color)),
    fill: series.filled ? () => color(series.color) : undefined,
    width: series.points || series.invisible ? 0 : series.width ?? 1.5,
    dash: series.dash,
    paths: series.paths ?? (series.points ? () => null : undefined),
    points: series.points
      ? { show: true, size: series.size ?? 3.5, width: 0, fill: () => color(series.color), stroke: () => color(series.color) }
      : { show: false },
    value: (u, value, _, i) => (i === null || value === null || value === undefined ? "–" : series.text?.(i, value) ?? format.number(value, 4)),
  };
}

export function valueRange(log, lines, floor) {
  return (_, min, max) => {
    const values = lines.map((line) => line.value).filter((value) => !log || value > 0);
    const low = Math.min(min ?? Infinity, ...values);
    const high = Math.max(max ?? -Infinity, ...values);
    if (!Number.isFinite(low) || !Number.isFinite(high)) return log ? [0.1, 10] : [0, 1];
    if (log) return uPlot.rangeLog(low, Math.max(high, low * 1.01), 10, false);
    const [nice_low, nice_high] = uPlot.rangeNum(low, high === low ? low + 1 : high, 0.08, true);
    return [floor === undefined ? nice_low : Math.max(floor, nice_low), nice_high];
  };
}

// A chart as a panel that follows the size of its frame and can be drawn again on another scale.
export class Chart {
  constructor({ title, note, id, log, height = HEIGHT_PX }, options, data) {
    this.frame = h("div", { class: "chart", style: `--height: ${height}px` });
    this.height = height;
    this.log = log ?? false;
    this.options = options;
    this.data = data;
    const tools = [h("button", { type: "button", class: "chip", title: "Save as PNG", "aria-label": "Save as PNG", onclick: () => this.save(title) }, "↓")];
    if (log !== undefined) tools.unshift(toggleButton("log", this.log, (on) => { this.log = on; this.build(); }, "Logarithmic axis"));
    this.element = panel(title, { note, tools, id }, this.frame);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.frame);
    this.endThemeChange = onThemeChange(() => this.resize());
  }

  build() {
    this.plot?.destroy();
    const options = this.options(this.log);
    this.plot = new uPlot({ ...options, width: this.frame.clientWidth, height: this.height }, this.data(this.log), this.frame);
    options.ready?.(this.plot);
  }

  resize() {
    if (this.frame.clientWidth === 0) return;
    if (!this.plot) this.build();
    else {
      this.plot.setSize({ width: this.frame.clientWidth, height: this.height });
      this.plot.redraw();
    }
  }

  save(title) {
    const source = this.plot.ctx.canvas;
    const copy = h("canvas", { width: source.width, height: source.height });
    const ctx = copy.getContext("2d");
    ctx.fillStyle = color("panel");
    ctx.fillRect(0, 0, copy.width, copy.height);
    ctx.drawImage(source, 0, 0);
    download(`${title.toLowerCase().replace(/[^a-z0-9]+/g, "-")}.png`, copy.toDataURL("image/png"));
  }

  destroy() {
    this.observer.disconnect();
    this.endThemeChange();
    this.plot?.destroy();
  }
}
