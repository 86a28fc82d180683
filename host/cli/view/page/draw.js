// Drawing by WebGL 2. Opaque parts come first; then the far sides of translucent parts from the largest to the smallest, and
// their near sides from the smallest to the largest, which is the order from back to front where each holds the next.
'use strict';
const canvas = document.getElementById('canvas');
const gl = canvas.getContext('webgl2', {antialias: true, alpha: false});
const IDENTITY = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]); // of a part that stands where its file has it
const LINE = 1.6, THICK = 2.6, SOURCE = 15, POINT = 6; // CSS pixels

const shaders = {
  mesh: [`#version 300 es
uniform mat4 m, pose; uniform vec3 low, extent; uniform float between;
layout(location=0) in vec3 a; layout(location=1) in vec3 b; layout(location=2) in vec3 na; layout(location=3) in vec3 nb;
out vec3 n, world;
void main() {
  world = (pose * vec4(low + extent * mix(a, b, between), 1.0)).xyz;
  n = mat3(pose) * mix(na, nb, between);
  gl_Position = m * vec4(world, 1.0);
}`,
  `#version 300 es
precision highp float;
uniform vec4 colour, eye, cut; uniform vec3 light, glow; uniform float shine; in vec3 n, world; out vec4 shown;
void main() {
  if (dot(cut.xyz, world) > cut.w) discard;
  vec3 v = normalize(eye.w > 0.5 ? eye.xyz - world : eye.xyz), u = normalize(n);
  float facing = dot(u, v);
  if (facing < 0.0) { u = -u; facing = -facing; }
  float lit = 0.34 + 0.66 * max(dot(u, light), 0.0), rim = mix(0.62, 1.0, smoothstep(0.0, 0.45, facing));
  vec3 c = colour.rgb * lit * rim + shine * pow(max(dot(u, normalize(light + v)), 0.0), 40.0);
  float alpha = colour.a >= 1.0 ? 1.0 : 1.0 - pow(1.0 - colour.a, 1.0 / max(facing, 0.12));
  if (cut.xyz != vec3(0.0) && !gl_FrontFacing) c = 0.7 * colour.rgb; // an unlit inside looks like a solid part's section
  shown = vec4(mix(c, glow, 0.35 * float(glow != vec3(0.0))), alpha);
}`],
  // The number of the part, 24 bits.
  pick: [`#version 300 es
uniform mat4 m, pose; uniform vec3 low, extent; uniform float between;
layout(location=0) in vec3 a; layout(location=1) in vec3 b; out vec3 world;
void main() {
  world = (pose * vec4(low + extent * mix(a, b, between), 1.0)).xyz;
  gl_Position = m * vec4(world, 1.0);
}`,
  `#version 300 es
precision highp float;
uniform vec4 colour, cut; in vec3 world; out vec4 shown;
void main() {
  if (dot(cut.xyz, world) > cut.w) discard;
  shown = colour;
}`],
  line: [`#version 300 es
uniform mat4 m; uniform vec2 picture; uniform float width;
layout(location=0) in vec3 p; layout(location=1) in vec3 q; layout(location=2) in float side;
void main() {
  vec4 a = m * vec4(p, 1.0), b = m * vec4(q, 1.0);
  float na = a.z + a.w, nb = b.z + b.w; // below 0: in front of the near plane
  if (na < 0.0 && nb > 0.0) a = mix(a, b, -na / (nb - na));
  if (nb < 0.0 && na > 0.0) b = mix(b, a, -nb / (na - nb));
  vec2 along = (b.xy / b.w - a.xy / a.w) * picture;
  vec2 across = length(along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(0.0);
  gl_Position = a + vec4(across * side * width / picture * a.w, 0.0, 0.0);
}`, `#version 300 es
precision highp float;
uniform vec4 colour; out vec4 shown;
void main() { shown = colour; }`],
  point: [`#version 300 es
uniform mat4 m; uniform float width;
layout(location=0) in vec3 p;
void main() { gl_Position = m * vec4(p, 1.0); gl_PointSize = width; }`, `#version 300 es
precision highp float;
uniform vec4 colour; out vec4 shown;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0; float r = dot(at, at);
  if (r > 1.0) discard;
  shown = vec4(colour.rgb * (1.0 - 0.45 * dot(at - vec2(-0.3), at - vec2(-0.3)) / 2.0), 1.0);
}`],
  detector: [`#version 300 es
uniform mat4 m; layout(location=0) in vec3 p; layout(location=1) in vec2 at; out vec2 place;
void main() { place = at; gl_Position = m * vec4(p, 1.0); }`, `#version 300 es
precision highp float;
uniform sampler2D image; in vec2 place; out vec4 shown;
void main() { shown = vec4(vec3(texture(image, place).r), 1.0); }`],
};

const programs = {};
function compile(name) {
  const program = gl.createProgram();
  shaders[name].forEach((text, k) => {
    const shader = gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(name + ': ' + gl.getProgramInfoLog(program));
  const at = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
    const its = gl.getActiveUniform(program, i).name;
    at[its] = gl.getUniformLocation(program, its);
  }
  programs[name] = {program, at};
}

function buffer(data, target = gl.ARRAY_BUFFER) {
  const made = gl.createBuffer();
  gl.bindBuffer(target, made);
  gl.bufferData(target, data, gl.STATIC_DRAW);
  return made;
}

function attribute(index, from, count, type, normalized, stride, offset = 0) {
  gl.bindBuffer(gl.ARRAY_BUFFER, from);
  gl.enableVertexAttribArray(index);
  gl.vertexAttribPointer(index, count, type, normalized, stride, offset);
}

// Segments [[from, to], ...] as quads that face the eye.
function makeLines(segments, colour, width) {
  const data = [];
  for (const [a, b] of segments)
    for (const [p, q, side] of [[a, b, 1], [a, b, -1], [b, a, 1], [b, a, 1], [a, b, -1], [b, a, -1]])
      data.push(...p, ...q, side);
  return {buffer: buffer(new Float32Array(data)), count: data.length / 7, colour, width};
}

let meshes = [], lines = [], points = [], detector = null, whole = {middle: [0, 0, 0], reach: 1, points: []};

function prepareParts() {
  meshes = scene.parts.map(part => {
    const mesh = makeMesh(part);
    mesh.moments = mesh.frames.map(f => f.points);
    mesh.colour = part.colour.map(x => x / 255), mesh.visible = true, mesh.pose = IDENTITY;
    mesh.volume = part.step.reduce((product, s) => product * (s || 1e-9), 1);
    return mesh;
  });
}

function uploadParts() {
  for (const mesh of meshes) {
    mesh.frames = mesh.frames.map(f => ({points: buffer(f.points), normals: buffer(f.normals)}));
    mesh.corners = buffer(mesh.numbers, gl.ELEMENT_ARRAY_BUFFER);
    mesh.array = gl.createVertexArray();
  }
}

// Measures the points that have to be in view when all is seen.
function measureWhole() {
  const v = scene.view, [low, high] = scene.box, path = scene.path.length / 3;
  const everything = [...boxPoints(low, high), ...v.strips.flat(), ...v.field, ...v.starts, ...Array.from({length: path}, (_, i) => scene.path.slice(3 * i, 3 * i + 3))];
  const middle = [0, 1, 2].map(k => (Math.min(...everything.map(p => p[k])) + Math.max(...everything.map(p => p[k]))) / 2);
  whole = {points: everything, middle, reach: 1.02 * Math.max(...everything.map(p => size(add(p, -1, middle))))};
}

function prepareMarks() {
  const v = scene.view, strips = v.strips, last = strips.length - 1, starts = v.starts;
  const beam = v.field.map((p, i) => [starts[i], p]), jaws = v.jaws;
  if (v.projection !== 'point') beam.push([starts[0], starts[1]], [starts[1], starts[2]], [starts[2], starts[3]], [starts[3], starts[0]]);
  const [low, high] = scene.box, length = 0.2 * Math.max(...high.map((x, k) => x - low[k]));
  beam.push([v.source, v.centre]);
  const sides = strips.slice(1).flatMap((s, i) => [[strips[i][0], s[0]], [strips[i][1], s[1]]]);
  const frames = [strips[0], strips[last], ...sides, ...jaws.map((p, i) => [p, jaws[(i + 1) % 4]])];
  lines = [makeLines(beam, [0.93, 0.62, 0.12, 1], LINE), makeLines(frames, [0.4, 0.43, 0.48, 1], THICK)];
  [[0.85, 0.22, 0.18, 1], [0.2, 0.62, 0.26, 1], [0.24, 0.44, 0.9, 1]].forEach((colour, k) => {
    const tip = low.map((x, i) => x + (i === k) * length), neck = low.map((x, i) => x + (i === k) * 0.82 * length);
    const wing = low.map((x, i) => neck[i] + (i === (k + 1) % 3) * 0.06 * length), other = neck.map((x, i) => 2 * x - wing[i]);
    lines.push(makeLines([[low, tip], [tip, wing], [tip, other]], colour, THICK));
  });
  const path = scene.path.length / 3, step = i => scene.path.slice(3 * i, 3 * i + 3);
  if (path > 1) lines.push(makeLines(Array.from({length: path - 1}, (_, i) => [step(i), step(i + 1)]), [0.55, 0.35, 0.82, 1], LINE));
  points = [{buffer: buffer(new Float32Array(v.source)), count: 1, colour: [0.96, 0.66, 0.14, 1], width: SOURCE}];
  if (path > 0) points.push({buffer: buffer(new Float32Array(scene.path)), count: path, colour: [0.55, 0.35, 0.82, 1], width: POINT});
  // Columns at equal angles are evenly spaced in the image.
  const area = strips.slice(1).flatMap((s, i) => [[i, 0], [i + 1, 0], [i + 1, 1], [i, 0], [i + 1, 1], [i, 1]].flatMap(([k, side]) => [...strips[k][side], k / last, side]));
  detector = {buffer: buffer(new Float32Array(area)), count: area.length / 5, texture: gl.createTexture(), frame: -1};
}

function showImage(frame) {
  const image = scene.image, count = image ? image.columns * image.rows : 1;
  if (detector.frame === frame) return;
  detector.frame = frame;
  gl.bindTexture(gl.TEXTURE_2D, detector.texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  const greys = image ? bytes.subarray(image.at + frame * count, image.at + (frame + 1) * count) : new Uint8Array([150]);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, image ? image.columns : 1, image ? image.rows : 1, 0, gl.RED, gl.UNSIGNED_BYTE, greys);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
}

// Values that every program of a picture reads.
const shot = {time: 0, m: null, eye: [0, 0, 0, 1], light: [0, 0, 1], chosen: -1, under: -1, marks: true, ground: [0.957, 0.961, 0.969], cut: [0, 0, 0, 0], aimed: null};
// cut: points p with dot(xyz, p) > w are not drawn. aimed: called after the camera was set, with the direction towards the eye.

// The two key frames around the time, and how far it is from the first to the second.
function moment(frames) {
  if (frames < 2) return [0, 0, 0];
  const x = (shot.time % 1) * frames, first = Math.min(Math.floor(x), frames - 1);
  return [first, (first + 1) % frames, x - first];
}

function drawMesh(i, program) {
  const mesh = meshes[i], part = scene.parts[i], [a, b, between] = moment(part.frames), at = program.at;
  gl.bindVertexArray(mesh.array);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.corners);
  attribute(0, mesh.frames[a].points, 3, gl.UNSIGNED_SHORT, true, 8);
  attribute(1, mesh.frames[b].points, 3, gl.UNSIGNED_SHORT, true, 8);
  if (program === programs.mesh) {
    attribute(2, mesh.frames[a].normals, 3, gl.BYTE, true, 4);
    attribute(3, mesh.frames[b].normals, 3, gl.BYTE, true, 4);
    const glow = i === shot.chosen ? [1, 0.75, 0.1] : i === shot.under ? [0.45, 0.8, 1] : [0, 0, 0];
    gl.uniform4fv(at.colour, mesh.colour);
    gl.uniform3fv(at.glow, glow);
    gl.uniform1f(at.shine, mesh.colour[3] < 1 ? 0 : 0.16);
  }
  gl.uniformMatrix4fv(at.m, false, shot.m);
  gl.uniformMatrix4fv(at.pose, false, mesh.pose);
  gl.uniform3fv(at.low, part.low);
  gl.uniform3fv(at.extent, part.step.map(s => 65535 * s));
  gl.uniform1f(at.between, between);
  gl.drawElements(gl.TRIANGLES, mesh.numbers.length, gl.UNSIGNED_INT, 0);
}

function drawParts() {
  const program = programs.mesh, shown = [...meshes.keys()].filter(i => meshes[i].visible && meshes[i].colour[3] > 0);
  const clear = shown.filter(i => meshes[i].colour[3] < 1).sort((i, j) => meshes[j].volume - meshes[i].volume);
  gl.useProgram(program.program);
  gl.uniform4fv(program.at.eye, shot.eye);
  gl.uniform3fv(program.at.light, shot.light);
  gl.uniform4fv(program.at.cut, shot.cut);
  for (const i of shown) if (meshes[i].colour[3] >= 1) drawMesh(i, program);
  if (shot.marks) drawMarks();
  gl.useProgram(program.program);
  gl.enable(gl.BLEND), gl.enable(gl.CULL_FACE), gl.depthMask(false);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.cullFace(gl.FRONT);
  for (const i of clear) drawMesh(i, program);
  gl.cullFace(gl.BACK);
  for (const i of clear.reverse()) drawMesh(i, program);
  gl.disable(gl.BLEND), gl.disable(gl.CULL_FACE), gl.depthMask(true);
}

function drawMarks() {
  const ratio = canvas.width / canvas.clientWidth || 1;
  showImage(scene.image ? moment(scene.image.frames)[0] : 0);
  gl.bindVertexArray(null);
  gl.useProgram(programs.detector.program);
  gl.uniformMatrix4fv(programs.detector.at.m, false, shot.m);
  attribute(0, detector.buffer, 3, gl.FLOAT, false, 20);
  attribute(1, detector.buffer, 2, gl.FLOAT, false, 20, 12);
  gl.drawArrays(gl.TRIANGLES, 0, detector.count);
  for (const [program, list] of [[programs.line, lines], [programs.point, points]]) {
    gl.useProgram(program.program);
    gl.uniformMatrix4fv(program.at.m, false, shot.m);
    if (program === programs.line) gl.uniform2f(program.at.picture, canvas.width, canvas.height);
    for (const item of list) {
      gl.uniform4fv(program.at.colour, item.colour);
      gl.uniform1f(program.at.width, item.width * ratio);
      attribute(0, item.buffer, 3, gl.FLOAT, false, program === programs.line ? 28 : 12);
      if (program === programs.line) attribute(1, item.buffer, 3, gl.FLOAT, false, 28, 12), attribute(2, item.buffer, 1, gl.FLOAT, false, 28, 24);
      gl.drawArrays(program === programs.line ? gl.TRIANGLES : gl.POINTS, 0, item.count);
    }
  }
}

function aim() {
  const aspect = canvas.width / canvas.height, [right, up, toward] = axes();
  shot.m = matrix(aspect, whole.middle, whole.reach);
  shot.eye = camera.parallel ? [...toward, 0] : [...eyePoint(), 1];
  shot.light = unit(add(add(toward, 0.5, up), -0.35, right));
  if (shot.aimed) shot.aimed(toward);
}

function drawScene() {
  aim();
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...shot.ground, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  drawParts();
}

// Draws the one pixel at a CSS pixel, by `act`. Returns its number of 24 bits.
let sensor = null;
function sense(x, y, act) {
  if (!sensor) {
    sensor = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, sensor);
    for (const [format, place] of [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT]]) {
      const store = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, store);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, store);
    }
  }
  const ratio = canvas.width / canvas.clientWidth, found = new Uint8Array(4), program = programs.pick;
  aim();
  gl.bindFramebuffer(gl.FRAMEBUFFER, sensor);
  gl.viewport(-Math.floor(x * ratio), Math.floor(y * ratio) + 1 - canvas.height, canvas.width, canvas.height);
  gl.enable(gl.DEPTH_TEST);
  gl.useProgram(program.program);
  gl.uniform4fv(program.at.cut, shot.cut);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  act(program);
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, found);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return found[0] | found[1] << 8 | found[2] << 16;
}

// The part at a CSS pixel: the nearest opaque one, or else the nearest translucent one; -1: none. Each part has its number as its
// colour.
function partAt(x, y) {
  for (const opaque of [true, false]) {
    const found = sense(x, y, program => meshes.forEach((mesh, i) => {
      if (!mesh.visible || mesh.colour[3] === 0 || mesh.colour[3] >= 1 !== opaque) return;
      gl.uniform4f(program.at.colour, (i + 1 & 255) / 255, (i + 1 >> 8 & 255) / 255, (i + 1 >> 16) / 255, 1);
      drawMesh(i, program);
    }));
    if (found > 0) return found - 1;
  }
  return -1;
}
