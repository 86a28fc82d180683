// The 3D view: what is chosen, and where parts, source and detector stand now.
'use strict';
const chosen = {kind: '', part: -1}; // kind: '', 'part', 'source' or 'detector'
const times = (a, b) => Array.from({length: 16}, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * (i >> 2) + k] * b[4 * k + (i & 3)], 0));
const same = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const shift = t => [1, 0, 0, t[0], 0, 1, 0, t[1], 0, 0, 1, t[2], 0, 0, 0, 1];
const carry = (m, p) => [0, 1, 2].map(r => m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]);
const moveOf = i => state.poses[i] || same;

// A turn by an angle about an axis through the origin, by Rodrigues' formula; row by row.
function turn(axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), [x, y, z] = axis, d = 1 - c;
  return [c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0, y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0,
    z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0, 0, 0, 0, 1];
}
const turnAbout = (centre, axis, angle) => times(shift(centre), times(turn(axis, angle), shift(centre.map(x => -x))));

function resize() {
  resizeTo(Math.min(window.devicePixelRatio || 1, 2));
  nextDraw = 0; // the canvas may be empty now
  change();
}

function draw() {
  shot.time = state.phase === null ? 0 : state.phase;
  if (isServed()) {
    aim();
    askPicture();
  } else {
    meshes.forEach((mesh, i) => { mesh.pose = new Float32Array([0, 1, 2, 3].flatMap(c => [0, 1, 2, 3].map(r => moveOf(i)[4 * r + c]))); });
    paintDetector();
    drawScene();
  }
  drawGizmo();
  drawTape();
  dirty = false;
}

// Where the view takes long, as WebGL in software does, it is drawn less often, so that the X-ray image stays fluent.
let nextDraw = 0;
function step3D() {
  if (isServed()) {
    calmPicture();
    if (dirty) draw();
  } else if (dirty && performance.now() >= nextDraw) {
    const began = performance.now();
    draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    const took = performance.now() - began, isFluent = took < 20 || fingers.size > 0 || grip;
    nextDraw = began + took + (isFluent ? 0 : Math.min(6 * took, 1000));
  }
  requestAnimationFrame(step3D);
}

// Source, beam and detector as the server has them for the last image.
function takeView(view) {
  const old = [...lines, ...points, detector];
  scene.view = view;
  measureWhole();
  if (detector) {
    for (const item of old) gl.deleteBuffer(item.buffer);
    gl.deleteTexture(detector.texture);
    prepareMarks();
  }
  if (greyImage) greyImage.isNew = true;
  change();
}

let greyImage = null;
function showOnDetector(small, columns, rows) {
  greyImage = {small, columns, rows, isNew: true};
  change();
}
function paintDetector() {
  if (!detector || !greyImage || !greyImage.isNew) return;
  greyImage.isNew = false;
  showImage(0);
  gl.bindTexture(gl.TEXTURE_2D, detector.texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, greyImage.columns, greyImage.rows, 0, gl.RED, gl.UNSIGNED_BYTE, greyImage.small);
}

function choose(kind, part = -1) {
  Object.assign(chosen, {kind, part});
  shot.chosen = part;
  showRows();
  describe();
  showRegister();
  change();
}

// The middle of what is chosen, in the world; null: nothing is.
function middleOf() {
  if (chosen.kind === 'source') return scene.view.projection === 'parallel' && !valueOf('Source.Position') ? null : scene.view.source;
  if (chosen.kind === 'detector') return scene.view.centre;
  if (chosen.kind !== 'part') return null;
  const part = scene.parts[chosen.part], mesh = meshes[chosen.part];
  return carry(moveOf(chosen.part), part.low.map((x, k) => (x + mesh.high[k]) / 2));
}

let lastPoint = 0;
function point(event) {
  if (event.timeStamp - lastPoint < 60) return;
  lastPoint = event.timeStamp;
  const i = partUnder(event.offsetX, event.offsetY);
  if (i === shot.under) return;
  shot.under = i;
  canvas.title = i >= 0 ? scene.parts[i].label : '';
  change();
}

// 'source' or 'detector' if its middle is near a place of the view.
function markAt(x, y) {
  const near = p => { const at = place(shot.m, p, canvas.clientWidth, canvas.clientHeight); return at && Math.hypot(at[0] - x, at[1] - y) < 14; };
  return near(scene.view.source) ? 'source' : near(scene.view.centre) ? 'detector' : '';
}

// Chooses what stands at a place of the view, the source and the detector's middle before the parts; or measures from there.
function pick(x, y) {
  if (tape.on) return addEnd(x, y);
  draw(); // as addEnd
  const mark = markAt(x, y), part = mark ? -1 : partUnder(x, y);
  choose(mark || (part >= 0 ? 'part' : ''), part);
}
