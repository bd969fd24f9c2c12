// The window of the map onto the world: equal aspect, x right, y up.

import { boundsOf } from "./geometry.js";

const MARGIN_PX = 36;

export class MapView {
  constructor() {
    this.width = this.height = 1;
    this.x = this.y = 0; // world point at the middle of the canvas
    this.scale = 1; // pixels per metre
    this.moved = false;
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
  }

  // Shows all of the given points.
  fit(pointSets) {
    const bounds = boundsOf(pointSets) ?? { left: -1, right: 1, bottom: -1, top: 1 };
    this.show(bounds, MARGIN_PX);
    this.moved = false;
  }

  show({ left, right, bottom, top }, margin = 0) {
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    const across = Math.max(right - left, 1e-3);
    const up = Math.max(top - bottom, 1e-3);
    this.scale = Math.min(Math.max(1, this.width - 2 * margin) / across, Math.max(1, this.height - 2 * margin) / up);
    this.moved = true;
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
    this.moved = true;
  }

  // Keeps the world point under pixel (px, py) where it is.
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.world(px, py);
    this.scale = Math.min(1e6, Math.max(1e-4, this.scale * factor));
    const [moved_x, moved_y] = this.world(px, py);
    this.x += x - moved_x;
    this.y += y - moved_y;
    this.moved = true;
  }

  pixel(x, y) {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  world(px, py) {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }
}
