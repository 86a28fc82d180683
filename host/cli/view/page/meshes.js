// The parts as WebGL draws them. Corners at which faces meet in a crease get several vertices, each with its own normal.
'use strict';
const scene = JSON.parse(document.getElementById('scene').textContent);
const text = atob(document.getElementById('bytes').textContent.trim()), bytes = new Uint8Array(text.length);
for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
const CREASE = Math.SQRT1_2; // faces that differ by more than 45 degrees

// [vertices][3] of 16 bits and [frames - 1][vertices][3] changes of 8, or of 16 where a part jumps, [triangles][3], and [columns x rows] greys, as they lie in the bytes.
const shorts = (at, count) => new Uint16Array(bytes.buffer, at, count);
const cornersOf = part => part.wide ? new Uint32Array(bytes.buffer, part.corners, 3 * part.shown) : shorts(part.corners, 3 * part.shown);

// [frames][vertices][3] of 16 bits.
function positionsOf(part) {
  const count = 3 * part.vertices, all = new Uint16Array(count * part.frames);
  const changes = new (part.jumps ? Uint16Array : Int8Array)(bytes.buffer, part.positions + 2 * count, count * (part.frames - 1));
  all.set(shorts(part.positions, count));
  for (let i = count; i < all.length; i++) all[i] = all[i - count] + changes[i - count] * (part.jumps ? 1 : part.unit[i % 3]); // jumps wrap around
  return all;
}

function faceNormals(corners, positions, step) {
  const normals = new Float32Array(corners.length);
  for (let t = 0; t < corners.length; t += 3) {
    const p = k => [0, 1, 2].map(i => positions[3 * corners[t + k] + i] * step[i]), a = p(0);
    normals.set(cross(add(p(1), -1, a), add(p(2), -1, a)), t); // its length is twice the area
  }
  return normals;
}

// Numbers of vertices for the corners: those of one vertex whose faces hang together without a crease share a number.
// origin: the vertex of the file of each.
function split(corners, faces, vertices) {
  const starts = new Uint32Array(vertices + 1), around = new Uint32Array(corners.length);
  for (const v of corners) starts[v]++;
  for (let v = 0, sum = 0; v <= vertices; v++) { const n = starts[v]; starts[v] = sum; sum += n; }
  const next = starts.slice();
  corners.forEach((v, i) => { around[next[v]++] = i; });
  const numbers = new Uint32Array(corners.length), origin = [];
  const smooth = (i, j) => {
    const a = faces.subarray(i - i % 3, i - i % 3 + 3), b = faces.subarray(j - j % 3, j - j % 3 + 3);
    return dot(a, b) >= CREASE * size(a) * size(b);
  };
  for (let v = 0; v < vertices; v++) {
    const open = around.slice(starts[v], starts[v + 1]);
    let left = open.length;
    while (left > 0) { // one group: the last corner, and all that it reaches
      const group = [open[--left]], number = origin.length;
      origin.push(v);
      while (group.length) {
        const i = group.pop();
        numbers[i] = number;
        for (let k = left - 1; k >= 0; k--)
          if (smooth(i, open[k])) { group.push(open[k]); open[k] = open[--left]; }
      }
    }
  }
  return [numbers, Uint32Array.from(origin)];
}

function vertexNormals(numbers, faces, count) {
  const sums = new Float32Array(3 * count), normals = new Int8Array(4 * count);
  for (let i = 0; i < numbers.length; i++)
    for (let k = 0; k < 3; k++) sums[3 * numbers[i] + k] += faces[i - i % 3 + k];
  for (let v = 0; v < count; v++) {
    const n = unit(sums.subarray(3 * v, 3 * v + 3));
    for (let k = 0; k < 3; k++) normals[4 * v + k] = Math.round(127 * n[k]);
  }
  return normals;
}

// Of each frame the positions and normals of the vertices after splitting.
function makeMesh(part) {
  const corners = cornersOf(part), all = positionsOf(part), frames = [];
  const ofFrame = f => all.subarray(3 * part.vertices * f, 3 * part.vertices * (f + 1));
  const [numbers, origin] = split(corners, faceNormals(corners, ofFrame(0), part.step), part.vertices);
  for (let f = 0; f < part.frames; f++) {
    const positions = ofFrame(f), points = new Uint16Array(4 * origin.length);
    for (let v = 0; v < origin.length; v++)
      for (let k = 0; k < 3; k++) points[4 * v + k] = positions[3 * origin[v] + k];
    frames.push({points, normals: vertexNormals(numbers, faceNormals(corners, positions, part.step), origin.length)});
  }
  const high = part.low.map((x, k) => x + 65535 * part.step[k]);
  return {numbers, frames, centre: part.low.map((x, k) => (x + high[k]) / 2), high};
}

// The corners of a box, for fitting.
const boxPoints = (low, high) => [0, 1, 2, 3, 4, 5, 6, 7].map(i => [0, 1, 2].map(k => i >> k & 1 ? high[k] : low[k]));
