import assert from "node:assert/strict";
import { test } from "node:test";

import { boundsOf, principalAxes, roundStep, transformLandmark, transformPath } from "../report/geometry.js";

const close = (actual, expected) => assert.ok(Math.abs(actual - expected) < 1e-12, `${actual} is not ${expected}`);
const quarter = { x_m: 1, y_m: 2, theta_rad: Math.PI / 2 };

test("a path is turned and moved, and keeps its holes", () => {
  const path = transformPath({ x: [1, null], y: [0, null], theta: [0, null] }, quarter);
  close(path.x[0], 1);
  close(path.y[0], 3);
  close(path.theta[0], Math.PI / 2);
  assert.deepEqual([path.x[1], path.y[1], path.theta[1]], [null, null, null]);
});

test("a landmark's covariance turns with it", () => {
  const turned = transformLandmark({ x: 0, y: 0, sxx: 4, sxy: 0.5, syy: 1 }, quarter);
  close(turned.sxx, 1);
  close(turned.sxy, -0.5);
  close(turned.syy, 4);
});

test("an ellipse has the axes of its covariance", () => {
  const { major, minor, angle } = principalAxes({ sxx: 1, sxy: 0, syy: 9 });
  close(major, 3);
  close(minor, 1);
  close(Math.abs(angle), Math.PI / 2);
  close(principalAxes({ sxx: 2, sxy: 1, syy: 2 }).angle, Math.PI / 4);
});

test("bounds pass over holes, and nothing has none", () => {
  assert.deepEqual(boundsOf([{ x: [1, null, -2], y: [3, null, 4] }]), { left: -2, right: 1, bottom: 3, top: 4 });
  assert.equal(boundsOf([{ x: [null], y: [null] }]), null);
});

test("steps of a scale are round", () => {
  assert.deepEqual([0.03, 1, 1.1, 6].map(roundStep), [0.05, 1, 2, 10]);
});
