// The report page: reads the embedded data, shows one run at a time and all of them on the map.

import { errorChart, innovationChart, innovationHistogram, stepChart, timeChart } from "./charts.js";
import { choice, h, section } from "./dom.js";
import { ImageStripPanel } from "./image_strip.js";
import { MapPanel } from "./map.js";
import { comparison, pageHeader, runSummary, tiles } from "./summary.js";
import { blockTable, metricsTables, notesPanel, reproduce, smoothedPanel } from "./tables.js";
import { runColor } from "./theme.js";
import { Timeline } from "./timeline.js";
import { verdictPanel } from "./verdict.js";

const filled = (series) => (series?.t?.length ?? 0) > 0;

// Distance from the truth of every run and of odometry alone, in one chart.
function positionErrorChart(timeline, data, selected) {
  const { t_error, error_m } = data.dead_reckoning ?? {};
  const curves = [
    ...(t_error?.length && error_m?.length ? [{ label: "odometry alone", color: "dead-reckoning", dash: [5, 4], table: [t_error, error_m] }] : []),
    ...data.runs.map((run, i) => ({ run, i })).filter(({ run }) => filled(run.errors) && run.errors.position_m?.length)
      .sort((a, b) => (a.i === selected) - (b.i === selected))
      .map(({ run, i }) => ({ label: run.name || "estimate", color: runColor(i), width: i === selected ? 1.75 : 1, table: [run.errors.t, run.errors.position_m] })),
  ];
  if (curves.length === 0) return null;
  return timeChart(timeline, { title: "Position error (m)", note: "Distance from the truth, anchored at the start", id: "position-error",
    series: curves, tables: curves.map((curve) => curve.table), floor: 0, log: false, height: 230 });
}

function errorCharts(timeline, run, color) {
  const e = run.errors;
  if (!filled(e)) return [];
  const charts = [
    ["x error (m)", e.x_m, e.sigma_x_m, "m"], ["y error (m)", e.y_m, e.sigma_y_m, "m"],
    ["Heading error (°)", e.heading_deg, e.sigma_heading_deg, "°"],
  ].filter(([, error]) => error?.length > 0).map(([title, error, sigma, unit]) =>
    errorChart(timeline, { title, note: "With the filter's 3σ band", t: e.t, error, sigma: sigma ?? [], unit, color }));
  if (e.nees?.length > 0) {
    charts.push(timeChart(timeline, { title: "Pose NEES", note: "3 degrees of freedom: mean 3 when consistent", t: e.t,
      series: [{ label: "NEES", values: e.nees, color, width: 1.25 }],
      lines: [{ value: 7.815, label: "95 %", color: "bad" }, { value: 3, label: "ideal mean", color: "muted" }], floor: 0, log: true }));
  }
  return charts;
}

class Report {
  constructor(data, root) {
    this.data = { ...data, runs: data.runs ?? [] };
    this.timeline = new Timeline(this.data);
    this.map = this.hasMap() ? new MapPanel(this.data, this.timeline) : null;
    this.charts = [];
    this.top = h("div");
    this.bottom = h("div");
    const several = this.data.runs.length > 1;
    root.append(...[pageHeader(this.data), several ? this.tabs() : null, this.top, this.map?.element,
      several ? comparison(this.data) : null, this.bottom].filter(Boolean));
    document.title = [data.title, "Waymark"].filter(Boolean).join(" · ");
    this.show(0);
  }

  hasMap() {
    return filled(this.data.truth) || filled(this.data.dead_reckoning) || this.data.truth_landmarks?.length > 0
      || this.data.runs.some((run) => filled(run.path) || run.landmarks?.length > 0);
  }

  tabs() {
    const options = this.data.runs.map((run, i) => ({ value: i,
      text: h("span", {}, h("span", { class: "swatch", style: `--swatch: var(--${runColor(i)})` }), run.name || `Run ${i + 1}`) }));
    return h("nav", { class: "tabs" }, choice(options, 0, (i) => this.show(i), "Run"));
  }

  show(index) {
    this.charts.forEach((chart) => chart.destroy());
    this.charts = [];
    const run = this.data.runs[index];
    if (!run) return;
    document.documentElement.style.setProperty("--accent", `var(--${runColor(index)})`);
    this.top.replaceChildren(...[run.metrics?.verdict ? verdictPanel(run.metrics.verdict) : null, runSummary(this.data, run), tiles(run),
      run.notes?.length ? notesPanel(run.notes) : null].filter(Boolean));
    const details = this.details(run, index).filter(Boolean);
    if (details.length === 0 && !this.map) details.push(h("p", { class: "note" }, "This run has nothing to show."));
    this.bottom.replaceChildren(...details);
    this.map?.select(index);
  }

  details(run, index) {
    const color = runColor(index);
    const keep = (chart) => {
      if (chart) this.charts.push(chart);
      return chart?.element;
    };
    const { innovations, steps } = run;
    return [
      section("Camera", "stack", run.image_strip?.length ? keep(new ImageStripPanel(run.image_strip, this.timeline)) : null),
      section("Errors over time", "grid", keep(positionErrorChart(this.timeline, this.data, index)),
        errorCharts(this.timeline, run, color).map(keep)),
      section("Innovations", "grid wide-left",
        filled(innovations) ? keep(innovationChart(this.timeline, innovations, color)) : null,
        innovations?.histogram?.density?.length ? keep(innovationHistogram(innovations.histogram, color)) : null),
      section("Time", "grid", filled(steps) ? keep(stepChart(this.timeline, steps, run.metrics?.step_us, color)) : null,
        run.blocks?.length ? blockTable(run.blocks) : null),
      section("With the whole log", "stack", run.metrics?.smoothed ? smoothedPanel(run.metrics.smoothed, run.metrics.truth) : null),
      section("Details", "stack", run.metrics && Object.keys(run.metrics).length ? metricsTables(run.metrics) : null,
        run.command || run.config_yaml ? reproduce(run) : null),
    ];
  }
}

const data = JSON.parse(document.getElementById("report-data").textContent);
new Report(data, document.getElementById("report"));
