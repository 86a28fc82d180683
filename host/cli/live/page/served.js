// The 3D view as the server draws it, where this browser's WebGL is software or missing. One picture at a time is asked for, and only
// if it would differ from the last one.
'use strict';
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
const FLUENT = 20, CALM = 250; // ms that a picture may take while the view moves; ms after which it no longer does
// by: 'auto', 'browser' or 'server'. asked: what the last picture was asked with. ms: what a picture of all pixels takes.
const served = {by: 'auto', number: 0, waits: false, missed: false, asked: '', reduced: false, ms: 0, camera: '', moved: 0, stamp: 0};

function rendererName() {
  const names = gl && gl.getExtension('WEBGL_debug_renderer_info');
  return gl ? String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER)) : 'no WebGL 2';
}
const isSlow = !gl || SOFTWARE.test(rendererName());
const isServed = () => !gl || (served.by === 'auto' ? isSlow : served.by === 'server');

// {"PART": [red, green, blue, opacity]} of the parts that are hidden, chosen, pointed at, or of another opacity than at first.
function coloursNow() {
  return Object.fromEntries(meshes.flatMap((mesh, i) => {
    const glow = i === shot.chosen ? [255, 191, 26] : i === shot.under ? [115, 204, 255] : null, colour = scene.parts[i].colour;
    const now = [0, 1, 2].map(k => Math.round(glow ? 0.65 * colour[k] + 0.35 * glow[k] : colour[k]));
    now.push(mesh.visible ? Math.round(255 * mesh.colour[3]) : 0);
    return now.some((x, k) => x !== colour[k]) ? [[i, now]] : [];
  }));
}

function lookNow() {
  const [, up, toward] = axes(), isMoving = performance.now() - served.moved < CALM || fingers.size > 0 || !!grip || state.play;
  const share = isMoving && served.ms > FLUENT ? Math.max(Math.sqrt(FLUENT / served.ms), 0.4) : 1;
  const ratio = (isMoving ? 1 : Math.min(window.devicePixelRatio || 1, 2)) * share;
  const look = {
    size: [canvas.clientWidth, canvas.clientHeight].map(x => Math.max(1, Math.round(ratio * x))),
    target: camera.target, distance: camera.distance, from: toward, up, parallel: camera.parallel,
    grey: xray.inverted ? [xray.high, xray.low] : [xray.low, xray.high], background: shot.ground.map(x => Math.round(255 * x)), parts: coloursNow(),
  };
  if (cut.across) look.cut = shot.cut;
  served.reduced = isMoving;
  return look;
}

function askPicture() {
  const eye = JSON.stringify([camera, shot.cut]);
  if (eye !== served.camera) served.camera = eye, served.moved = performance.now();
  const look = lookNow(), asked = JSON.stringify([look, xray.stamp]);
  if (asked === served.asked) return;
  if (served.waits) { served.missed = true; return; }
  if (!say({look: {number: ++served.number, ...look}})) return;
  served.asked = asked, served.waits = true, served.missed = false;
}

// "SKLP", number, columns and rows (16 bits), ms, and the pixels: live_picture_header of host/cli/live/picture.h.
function showPicture(buffer) {
  const view = new DataView(buffer), columns = view.getUint16(8, true), rows = view.getUint16(10, true), sheet = byId('picture');
  served.waits = false;
  if (columns) {
    const whole = canvas.clientWidth * canvas.clientHeight;
    served.ms = view.getFloat32(12, true) * Math.max(1, whole / (columns * rows));
    if (sheet.width !== columns || sheet.height !== rows) sheet.width = columns, sheet.height = rows;
    sheet.getContext('2d', {alpha: false}).putImageData(new ImageData(new Uint8ClampedArray(buffer, 16), columns, rows), 0, 0);
    served.stamp++;
  }
  if (served.missed) change();
}

// After the view has moved, all pixels follow.
function calmPicture() {
  if (served.reduced && !served.waits && performance.now() - served.moved >= CALM) change();
}

// The server knows nothing of what was asked for before: after a new connection, or when the user chooses who draws.
function restartPictures() {
  Object.assign(served, {waits: false, asked: ''});
  byId('picture').hidden = !isServed();
  if (!isServed()) prepareGL();
  change();
}

function listenToServed() {
  const box = byId('drawer');
  try { served.by = localStorage.getItem('drawer') || 'auto'; } catch (error) { /* private windows may have none */ }
  box.value = served.by;
  const server = isNotebook ? 'the kernel' : 'the server';
  box.options[0].textContent = `automatically: ${isSlow ? server : 'this browser'}`;
  box.options[2].textContent = `by ${server}`;
  box.options[1].disabled = !gl;
  box.title = rendererName();
  box.onchange = () => {
    served.by = box.value;
    try { localStorage.setItem('drawer', served.by); } catch (error) { /* likewise */ }
    restartPictures();
  };
  restartPictures();
}
