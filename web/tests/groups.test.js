import assert from "node:assert/strict";
import { test } from "node:test";

import { abscissa, curvesOf, fastslamGroup } from "../sweep/groups.js";

const group = (axes, rmse) => ({ axes, figures: { rmse } });
const data = {
  axes: ["filter", "fastslam.particles"],
  groups: [
    group({ filter: "ekf" }, [1, 2, 3]),
    group({ filter: "fastslam", "fastslam.particles": "100" }, [4, 5, 6]),
    group({ filter: "fastslam", "fastslam.particles": "50" }, [7, 8, 9]),
  ],
};

test("charts run over the particles where these vary", () => {
  assert.equal(abscissa(data), "fastslam.particles");
  assert.equal(abscissa({ axes: ["filter"], groups: data.groups.slice(0, 1) }), undefined);
});

test("groups with a place on the axis are a curve in its order, others a level", () => {
  const { curves, levels } = curvesOf(data, "fastslam.particles", "rmse", 10);
  assert.deepEqual(curves, [{ label: "fastslam", points: [[50, 70, 80, 90], [100, 40, 50, 60]] }]);
  assert.deepEqual(levels, [{ label: "ekf", value: 20 }]);
});

test("a group of FastSLAM is found by what it observes", () => {
  assert.equal(fastslamGroup(data, "range-bearing", 50), data.groups[2]);
  assert.equal(fastslamGroup(data, "range", 50), undefined);
});
