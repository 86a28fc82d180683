// The measuring line of the 3D view. Its ends are points on parts, which move with the parts, the source, or the detector's centre.
'use strict';
const tape = {on: false, ends: []}; // each end: {kind}, 'source' or 'detector', or {part, point} with the point before the part was moved

// The part and the point in the world at a CSS pixel; null if there is no part. If the clip plane shows the inside of a part, the
// point is the intersection of the ray with the plane.
function surfaceAt(x, y) {
  const hit = hitAt(x, y), [a, b, c, w] = shot.cut, normal = [a, b, c];
  if (!hit) return null;
  const {from, along} = hit.ray, slope = dot(normal, along), isInside = cut.across && hit.isBack && slope !== 0;
  return {part: hit.part, point: add(from, isInside ? (w - dot(normal, from)) / slope : hit.t, along)};
}

const placeOfEnd = end => end.kind === 'source' ? scene.view.source : end.kind === 'detector' ? scene.view.centre : carry(moveOf(end.part), end.point);
const nameOfEnd = end => end.kind || scene.parts[end.part].label;

function addEnd(x, y) {
  draw(); // a key or click may come before the view is drawn as it has just been turned
  const kind = markAt(x, y), found = kind ? null : surfaceAt(x, y);
  if (!kind && !found) return showSentence('There is no part at this place; click parts, the source or the middle of the detector.');
  if (tape.ends.length > 1) tape.ends = [];
  tape.ends.push(kind ? {kind} : {part: found.part, point: carryBack(moveOf(found.part), found.point)});
  change();
}

function clearTape() {
  tape.ends = [];
  change();
}

function drawTape() {
  const box = byId('tape'), places = tape.ends.map(placeOfEnd), [a, b] = places.map(onScreen), [line, ...rest] = box.children, cross = rest.pop();
  box.toggleAttribute('hidden', !tape.on);
  byId('length').hidden = !tape.on;
  if (!tape.on) return;
  line.toggleAttribute('hidden', !a || !b);
  if (a && b) for (const [k, p] of [[1, a], [2, b]]) line.setAttribute('x' + k, p[0]), line.setAttribute('y' + k, p[1]);
  [a, b].forEach((p, i) => {
    rest[i].toggleAttribute('hidden', !p);
    if (p) rest[i].setAttribute('cx', p[0]), rest[i].setAttribute('cy', p[1]);
  });
  const isByKeys = document.activeElement === canvas && canvas.matches(':focus-visible');
  cross.setAttribute('d', isByKeys ? `M${canvas.clientWidth / 2 - 9} ${canvas.clientHeight / 2}h18m-9 -9v18` : '');
  byId('length').textContent = places.length < 2 ? `click the ${places.length ? 'second' : 'first'} point, or turn it to the middle and press Enter` :
    `${number(size(add(places[1], -1, places[0])), 4)} mm from ${nameOfEnd(tape.ends[0])} to ${nameOfEnd(tape.ends[1])}`;
}

function listenToTape() {
  byId('measure-3d').onclick = () => {
    byId('measure-3d').setAttribute('aria-pressed', tape.on = !tape.on);
    clearTape();
  };
  canvas.addEventListener('focus', change);
  canvas.addEventListener('blur', change);
}
