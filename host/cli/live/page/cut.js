// The clip plane of the 3D view: perpendicular to an axis of the world, or to the direction of view, with which it turns.
'use strict';
const cut = {across: '', at: 0, side: 1}; // at: mm along the axis, or from the middle of the parts towards the eye. side: 1 or -1

// Minimum and maximum of all parts along a direction, mm.
function reachOf(direction) {
  const places = scene.parts.flatMap((part, i) => boxPoints(part.low, meshes[i].high).map(p => dot(direction, carry(moveOf(i), p))));
  return [Math.min(...places), Math.max(...places)];
}
const middleAlong = direction => reachOf(direction).reduce((a, b) => (a + b) / 2);

function aimCut(toward) {
  if (!cut.across) { shot.cut = [0, 0, 0, 0]; return; }
  const isView = cut.across === 'view', normal = isView ? toward : AXES[cut.across], at = isView ? middleAlong(toward) + cut.at : cut.at;
  shot.cut = [...normal.map(x => cut.side * x), cut.side * at];
}

function placeCut(mm) {
  cut.at = mm;
  byId('cut-slider').value = mm, byId('cut-mm').value = number(mm);
  change();
}

function setCut(across) {
  const slider = byId('cut-slider');
  cut.across = byId('cut').value = across;
  byId('cut-row').hidden = byId('cut-side').disabled = !across;
  if (across) {
    const [low, high] = across === 'view' ? [-1, 1].map(s => s * size(AXES.map(axis => { const [a, b] = reachOf(axis); return b - a; })) / 2) : reachOf(AXES[across]);
    slider.min = low, slider.max = high;
    placeCut((low + high) / 2);
  }
  change();
}

function nextCut() {
  const names = [...byId('cut').options].map(option => option.value);
  setCut(names[(names.indexOf(cut.across) + 1) % names.length]);
}

function listenToCut() {
  const slider = byId('cut-slider'), mm = byId('cut-mm');
  shot.aimed = aimCut;
  byId('cut').onchange = () => setCut(byId('cut').value);
  byId('cut-side').onclick = () => { cut.side = -cut.side; change(); };
  slider.oninput = () => placeCut(Number(slider.value));
  mm.onchange = () => { if (mm.value !== '' && Number.isFinite(Number(mm.value))) placeCut(Number(mm.value)); };
}
