// What the map and the charts share: the time that is pointed at, and the interval that is zoomed to.

export class Timeline extends EventTarget {
  constructor(data) {
    super();
    const ranges = [data.truth, data.dead_reckoning, ...data.runs.flatMap((run) => [run.path, run.errors, run.steps])]
      .map((series) => series?.t ?? []).filter((t) => t.length > 0);
    this.begin = Math.min(...ranges.map((t) => t[0]));
    this.end = Math.max(...ranges.map((t) => t.at(-1)));
    if (ranges.length === 0) this.begin = this.end = 0;
    // Stamps since 1970 make unreadable axes: show those since the start of the run.
    this.offset = this.begin > 1e6 ? this.begin : 0;
    this.range = null;
  }

  get first() { return this.begin - this.offset; }
  get last() { return this.end - this.offset; }

  shifted(t) { return this.offset ? t.map((stamp) => stamp - this.offset) : t; }

  point(t, source) {
    this.dispatchEvent(new CustomEvent("point", { detail: { t, source } }));
  }

  zoom(min, max) {
    const whole = min <= this.first && max >= this.last;
    this.range = whole ? null : [min, max];
    this.dispatchEvent(new CustomEvent("zoom", { detail: this.range }));
  }
}

// Index of the entry of the ascending array t that is nearest to value, -1 when t is empty.
export function nearestIndex(t, value) {
  let low = 0;
  let high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] < value) low = middle;
    else high = middle;
  }
  return high > low && Math.abs(t[high] - value) < Math.abs(t[low] - value) ? high : low > high ? -1 : low;
}
