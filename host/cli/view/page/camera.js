// The eye: vectors of three numbers, and a camera that turns about an upright axis. Lengths are in mm.
'use strict';
const add = (a, s, b) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const size = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => { const s = size(a); return s > 0 ? [a[0] / s, a[1] / s, a[2] / s] : [0, 0, 1]; };
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

const FIELD = 28 * Math.PI / 180, FILLED = 0.92;
const camera = {
  target: [0, 0, 0], distance: 1, // the point that it looks at
  up: [0, 0, 1], ahead: [0, -1, 0], // the upright axis, and the direction of azimuth 0, across it
  azimuth: 0, elevation: 0, parallel: false,
};

// Right, up and towards the eye.
function axes() {
  const side = cross(camera.up, camera.ahead), e = camera.elevation;
  const flat = add(camera.ahead.map(x => x * Math.cos(camera.azimuth)), Math.sin(camera.azimuth), side);
  const toward = add(flat.map(x => x * Math.cos(e)), Math.sin(e), camera.up);
  const right = cross(camera.up, flat);
  return [right, cross(toward, right), toward];
}

// Looks from a direction, with this axis upright.
function look(from, up) {
  camera.up = unit(up);
  const toward = unit(from), flat = add(toward, -dot(toward, camera.up), camera.up);
  camera.elevation = Math.asin(clamp(dot(toward, camera.up), -1, 1));
  if (size(flat) > 1e-6) camera.ahead = unit(flat);
  else { // straight from above or below: -y is then at the bottom
    const any = Math.abs(camera.up[1]) < 0.9 ? [0, -1, 0] : [-1, 0, 0];
    camera.ahead = unit(add(any, -dot(any, camera.up), camera.up));
  }
  camera.azimuth = 0;
}

// Moves the eye until all points are in the picture, and no farther.
function fit(points, aspect) {
  const basis = axes(), t = Math.tan(FIELD / 2) * FILLED, tangent = [t * aspect, t];
  const high = [-Infinity, -Infinity], low = [Infinity, Infinity];
  let near = -Infinity, far = Infinity;
  for (const p of points) {
    const z = dot(basis[2], p);
    near = Math.max(near, z), far = Math.min(far, z);
    for (let k = 0; k < 2; k++) {
      const x = dot(basis[k], p), shift = camera.parallel ? 0 : z * tangent[k];
      high[k] = Math.max(high[k], x + shift), low[k] = Math.min(low[k], x - shift);
    }
  }
  const half = k => (high[k] - low[k]) / 2, eye = Math.max(half(0) / tangent[0], half(1) / tangent[1], 1e-6);
  const depth = camera.parallel ? (near + far) / 2 : Math.min((near + far) / 2, eye - 1e-3 * eye);
  camera.distance = camera.parallel ? eye : eye - depth;
  camera.target = basis[2].map(x => x * depth);
  for (let k = 0; k < 2; k++) camera.target = add(camera.target, (high[k] + low[k]) / 2, basis[k]);
}

const eyePoint = () => add(camera.target, camera.distance, axes()[2]);

// Column-major matrix from the world to clip coordinates; everything lies within `reach` of `middle`.
function matrix(aspect, middle, reach) {
  const [x, y, z] = axes(), eye = eyePoint(), d = camera.distance, t = Math.tan(FIELD / 2);
  const beyond = d - dot(add(middle, -1, camera.target), z); // of the middle, from the eye
  const far = beyond + reach, near = camera.parallel ? beyond - reach : Math.max(beyond - reach, 2e-3 * Math.max(far, d));
  const v = [[...x, -dot(x, eye)], [...y, -dot(y, eye)], [...z, -dot(z, eye)]];
  const sx = 1 / (t * aspect), sy = 1 / t, out = new Float32Array(16);
  for (let c = 0; c < 4; c++) {
    out[4 * c] = v[0][c] * sx, out[4 * c + 1] = v[1][c] * sy;
    if (camera.parallel) {
      out[4 * c] /= d, out[4 * c + 1] /= d;
      out[4 * c + 2] = -2 * v[2][c] / (far - near), out[4 * c + 3] = 0;
    } else {
      out[4 * c + 2] = -v[2][c] * (far + near) / (far - near), out[4 * c + 3] = -v[2][c];
    }
  }
  if (camera.parallel) out[14] -= (far + near) / (far - near), out[15] = 1;
  else out[14] -= 2 * far * near / (far - near);
  return out;
}

// Where a point is on the canvas, in CSS pixels; null behind the eye.
function place(m, point, width, height) {
  const clip = k => m[k] * point[0] + m[4 + k] * point[1] + m[8 + k] * point[2] + m[12 + k];
  const w = clip(3);
  return w > 0 ? [(1 + clip(0) / w) * width / 2, (1 - clip(1) / w) * height / 2] : null;
}

function orbit(dx, dy) {
  camera.azimuth -= dx;
  camera.elevation = clamp(camera.elevation + dy, -Math.PI / 2, Math.PI / 2);
}

// By fractions of the height of the picture.
function pan(dx, dy) {
  const [x, y] = axes(), height = 2 * camera.distance * Math.tan(FIELD / 2);
  camera.target = add(add(camera.target, -dx * height, x), dy * height, y);
}

// Zooms about a point of the picture: fractions of the height from its middle, up and to the right.
function zoom(factor, right, up) {
  pan(-right * (1 - factor), up * (1 - factor));
  camera.distance = clamp(camera.distance * factor, 1e-3 * whole.reach, 50 * whole.reach);
}
