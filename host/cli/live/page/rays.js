// Hits of a ray from the eye, by its intersections with the triangles: finds the part under the mouse, whoever draws the view.
'use strict';
// The ray through a CSS pixel: its start, and its direction, of length 1 along the view.
function rayAt(x, y) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight], [right, up, toward] = axes(), t = Math.tan(FIELD / 2);
  const across = (2 * x - width) / height * t, above = (1 - 2 * y / height) * t;
  const aside = (from, scale) => add(add(from, scale * across, right), scale * above, up), away = toward.map(v => -v);
  return camera.parallel ? {from: aside(add(eyePoint(), whole.reach, toward), camera.distance), along: away} : {from: eyePoint(), along: aside(away, 1)};
}

// The inverse of `carry` for a rotation and a translation.
function carryBack(m, p) {
  const from = [0, 1, 2].map(r => p[r] - m[4 * r + 3]);
  return [0, 1, 2].map(c => m[c] * from[0] + m[4 + c] * from[1] + m[8 + c] * from[2]);
}

// Whether a ray meets the box from 0 to 65535 along each axis.
function meetsBox(o, d) {
  let near = -Infinity, far = Infinity;
  for (let k = 0; k < 3; k++) {
    if (d[k] === 0) { if (o[k] < 0 || o[k] > 65535) return false; continue; }
    const a = -o[k] / d[k], b = (65535 - o[k]) / d[k];
    near = Math.max(near, Math.min(a, b)), far = Math.min(far, Math.max(a, b));
  }
  return near <= far && far > 0;
}

// The nearest triangle of part i that the clip plane leaves: {t, isBack}, at from + t along. Intersections by Moeller and Trumbore (1997),
// in the units of the part's 16-bit positions, which keep t.
function meetPart(i, {from, along}) {
  const mesh = meshes[i], part = scene.parts[i], m = moveOf(i), [a, b, between] = moment(part.frames), p = mesh.moments[a], q = mesh.moments[b];
  const start = carryBack(m, from), end = carryBack(m, add(from, 1, along)), steps = part.step.map(s => s || 1e-9);
  const o = start.map((x, k) => (x - part.low[k]) / steps[k]), d = end.map((x, k) => (x - start[k]) / steps[k]), {numbers} = mesh;
  const beyond = shot.cut[3] - dot(shot.cut, from), toward = dot(shot.cut, along);
  let best = Infinity, isBack = false;
  if (!meetsBox(o, d)) return null;
  const v = new Float64Array(9);
  for (let n = 0; n < numbers.length; n += 3) {
    for (let c = 0; c < 3; c++)
      for (let k = 0, at = 4 * numbers[n + c]; k < 3; k++) v[3 * c + k] = p[at + k] + between * (q[at + k] - p[at + k]);
    const ex = v[3] - v[0], ey = v[4] - v[1], ez = v[5] - v[2], fx = v[6] - v[0], fy = v[7] - v[1], fz = v[8] - v[2];
    const hx = d[1] * fz - d[2] * fy, hy = d[2] * fx - d[0] * fz, hz = d[0] * fy - d[1] * fx, det = ex * hx + ey * hy + ez * hz;
    if (det === 0) continue;
    const sx = o[0] - v[0], sy = o[1] - v[1], sz = o[2] - v[2], u = (sx * hx + sy * hy + sz * hz) / det;
    if (u < 0 || u > 1) continue;
    const gx = sy * ez - sz * ey, gy = sz * ex - sx * ez, gz = sx * ey - sy * ex, w = (d[0] * gx + d[1] * gy + d[2] * gz) / det;
    if (w < 0 || u + w > 1) continue;
    const t = (fx * gx + fy * gy + fz * gz) / det;
    if (t > 0 && t < best && t * toward <= beyond) best = t, isBack = det < 0;
  }
  return best < Infinity ? {t: best, isBack} : null;
}

// The surface at a CSS pixel: that of the nearest opaque part, or else of the nearest translucent one; null: none.
function hitAt(x, y) {
  const ray = rayAt(x, y);
  aim();
  for (const opaque of [true, false]) {
    let best = null;
    meshes.forEach((mesh, i) => {
      if (!mesh.visible || mesh.colour[3] === 0 || mesh.colour[3] >= 1 !== opaque) return;
      const hit = meetPart(i, ray);
      if (hit && (!best || hit.t < best.t)) best = {part: i, ...hit};
    });
    if (best) return {...best, ray};
  }
  return null;
}
const partUnder = (x, y) => (hitAt(x, y) || {part: -1}).part;
