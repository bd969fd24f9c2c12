// Planar transforms, bounds and covariance ellipses.

// Applies the SE(2) {x_m, y_m, theta_rad} to points {x, y, theta}; no transform leaves them as they are.
export function transformPath(path, transform) {
  if (!transform) return path;
  const c = Math.cos(transform.theta_rad);
  const s = Math.sin(transform.theta_rad);
  return {
    ...path,
    x: path.x.map((x, i) => (x === null ? null : transform.x_m + c * x - s * path.y[i])),
    y: path.y.map((y, i) => (y === null ? null : transform.y_m + s * path.x[i] + c * y)),
    theta: path.theta?.map((theta) => (theta === null ? null : theta + transform.theta_rad)),
  };
}

export function transformLandmark(landmark, transform) {
  if (!transform) return landmark;
  const c = Math.cos(transform.theta_rad);
  const s = Math.sin(transform.theta_rad);
  const { x, y, sxx, sxy, syy } = landmark;
  return {
    ...landmark,
    x: transform.x_m + c * x - s * y,
    y: transform.y_m + s * x + c * y,
    sxx: c * c * sxx - 2 * c * s * sxy + s * s * syy,
    sxy: c * s * (sxx - syy) + (c * c - s * s) * sxy,
    syy: s * s * sxx + 2 * c * s * sxy + c * c * syy,
  };
}

// Standard deviations along the principal axes, and the direction of the larger one.
export function principalAxes({ sxx, sxy, syy }) {
  const mean = (sxx + syy) / 2;
  const half = Math.hypot((sxx - syy) / 2, sxy);
  return {
    major: Math.sqrt(Math.max(0, mean + half)),
    minor: Math.sqrt(Math.max(0, mean - half)),
    angle: 0.5 * Math.atan2(2 * sxy, sxx - syy),
  };
}

export function boundsOf(pointSets) {
  const bounds = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (const { x, y } of pointSets) {
    for (let i = 0; i < x.length; ++i) {
      if (x[i] === null || y[i] === null) continue;
      bounds.left = Math.min(bounds.left, x[i]);
      bounds.right = Math.max(bounds.right, x[i]);
      bounds.bottom = Math.min(bounds.bottom, y[i]);
      bounds.top = Math.max(bounds.top, y[i]);
    }
  }
  return bounds.left <= bounds.right ? bounds : null;
}

// 1, 2 or 5 times a power of ten, at least value.
export function roundStep(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * ([1, 2, 5].find((step) => step * power >= value) ?? 10);
}
