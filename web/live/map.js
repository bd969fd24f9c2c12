// The map from above, which follows all of it until somebody moves it.

const MARGIN = 24;
const SIGMAS = 3;

// What part of the world, in m, a canvas shows: fits all, or what was dragged and pinched; a double click fits again.
export class MapFrame {
  constructor(canvas) {
    this.canvas = canvas;
    this.moved = null;
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("dblclick", () => { this.moved = null; });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.#zoom(event.offsetX, event.offsetY, Math.exp(-event.deltaY / 400));
    }, { passive: false });
  }

  #move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before || !this.view) return;
    const now = [event.offsetX, event.offsetY];
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    this.pointers.set(event.pointerId, now);
    if (others.length > 0) {
      const distance = ([x, y]) => Math.hypot(x - others[0][0], y - others[0][1]);
      this.#zoom(...others[0], distance(now) / Math.max(distance(before), 1));
      return;
    }
    const { x, y, scale } = this.view;
    this.moved = { x: x - (now[0] - before[0]) / scale, y: y + (now[1] - before[1]) / scale, scale };
    this.view = this.moved;
  }

  #zoom(px, py, factor) {
    if (!this.view) return;
    const { x, y, scale } = this.view;
    const larger = Math.min(Math.max(scale * factor, 0.1), 5000);
    const dx = px - this.canvas.clientWidth / 2, dy = py - this.canvas.clientHeight / 2;
    this.moved = { x: x + dx / scale - dx / larger, y: y - dy / scale + dy / larger, scale: larger };
    this.view = this.moved;
  }

  fit(points) {
    if (this.moved) return this.moved;
    const xs = points.map(([x]) => x), ys = points.map(([, y]) => y);
    const [left, right, low, high] = points.length
      ? [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)] : [-1, 1, -1, 1];
    const width = Math.max(right - left, 1), height = Math.max(high - low, 1);
    return {
      x: (left + right) / 2, y: (low + high) / 2,
      scale: Math.min((this.canvas.clientWidth - 2 * MARGIN) / width, (this.canvas.clientHeight - 2 * MARGIN) / height),
    };
  }
}

const niceStep = (least) => {
  const decade = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * decade).find((step) => step >= least);
};

export function drawMap(frame, { trail, landmarks, pose }) {
  const { canvas } = frame;
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const view = frame.fit([...trail, ...landmarks.map(([, x, y]) => [x, y])]);
  frame.view = view;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`);
  const at = (x, y) => [width / 2 + (x - view.x) * view.scale, height / 2 - (y - view.y) * view.scale];

  const step = niceStep(60 / view.scale);
  context.strokeStyle = colour("grid");
  context.fillStyle = colour("muted");
  context.font = "12px system-ui, sans-serif";
  const left = view.x - width / 2 / view.scale, low = view.y - height / 2 / view.scale;
  for (let x = Math.ceil(left / step) * step; at(x, 0)[0] < width; x += step) line(context, [at(x, 0)[0], 0], [at(x, 0)[0], height]);
  for (let y = Math.ceil(low / step) * step; at(0, y)[1] > 0; y += step) line(context, [0, at(0, y)[1]], [width, at(0, y)[1]]);
  context.fillText(`grid ${Number(step.toPrecision(2))} m`, 8, height - 8);

  context.strokeStyle = colour("trail");
  context.lineWidth = 2;
  context.beginPath();
  trail.forEach(([x, y]) => context.lineTo(...at(x, y)));
  context.stroke();

  context.strokeStyle = context.fillStyle = colour("landmark");
  context.lineWidth = 1.5;
  for (const [id, x, y, major, minor, angle] of landmarks) {
    const [px, py] = at(x, y);
    ellipse(context, px, py, [major, minor, angle], view.scale);
    context.fillRect(px - 2, py - 2, 4, 4);
    if (id >= 0 && landmarks.length <= 40) context.fillText(String(id), px + 6, py - 6);
  }

  if (!pose) return;
  const [px, py] = at(pose.x_m, pose.y_m);
  context.strokeStyle = context.fillStyle = colour("ink");
  ellipse(context, px, py, pose.ellipse, view.scale);
  context.save();
  context.translate(px, py);
  context.rotate(-pose.theta_rad);
  context.beginPath();
  context.moveTo(12, 0);
  context.lineTo(-8, 7);
  context.lineTo(-4, 0);
  context.lineTo(-8, -7);
  context.fill();
  context.restore();
}

function line(context, from, to) {
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}

function ellipse(context, x, y, [major, minor, angle], scale) {
  context.beginPath();
  context.ellipse(x, y, Math.max(SIGMAS * major * scale, 3), Math.max(SIGMAS * minor * scale, 3), -angle, 0, 2 * Math.PI);
  context.stroke();
}
