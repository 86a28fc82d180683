// Arrows and rings at what is chosen: an arrow moves it along an axis of the world, a ring turns it about one.
'use strict';
const AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], COLOURS = ['#d9382e', '#33a043', '#3d70e6'], REACH = 80; // CSS pixels
const SNAP = {mm: 5, degrees: 15}; // with Shift
let grip = null;

const onScreen = p => place(shot.m, p, canvas.clientWidth, canvas.clientHeight);
function mmPerPixel(middle) {
  const depth = camera.parallel ? camera.distance : dot(add(eyePoint(), -1, middle), axes()[2]);
  return 2 * Math.max(depth, 1e-6) * Math.tan(FIELD / 2) / canvas.clientHeight;
}
const canTurn = () => chosen.kind === 'part' || chosen.kind === 'detector';

function drawGizmo() {
  const overlay = byId('gizmo'), middle = isOwner() ? middleOf() : null, at = middle && onScreen(middle);
  overlay.toggleAttribute('hidden', !at);
  if (!at) return;
  const length = REACH * mmPerPixel(middle);
  AXES.forEach((axis, k) => {
    const tip = onScreen(add(middle, length, axis)), arrow = overlay.querySelector(`[data-arrow="${k}"]`), ring = overlay.querySelector(`[data-ring="${k}"]`);
    arrow.setAttribute('d', tip ? `M${at}L${tip}` : '');
    const sides = [AXES[(k + 1) % 3], AXES[(k + 2) % 3]], circle = [];
    for (let i = 0; i <= 48 && canTurn(); i++) {
      const p = onScreen(add(add(middle, 0.8 * length * Math.cos(i * Math.PI / 24), sides[0]), 0.8 * length * Math.sin(i * Math.PI / 24), sides[1]));
      if (p) circle.push(p);
    }
    ring.setAttribute('d', circle.length > 2 ? 'M' + circle.join('L') : '');
  });
}

// Moves or turns what is chosen by a matrix of the world, from where it was in `begun`.
function moveChosen(by, dragging = false, begun = null) {
  const from = begun ? begun.view : scene.view, old = begun ? begun.state : null, round = p => p.map(x => Number(x.toPrecision(9)));
  if (chosen.kind === 'part') {
    const i = chosen.part, before = old ? JSON.parse(old).poses[i] || same : moveOf(i);
    alter(s => { s.poses[i] = times(by, before); }, dragging, old);
  } else if (chosen.kind === 'source') {
    if (!valueOf('Source.Position')) return say3D('The source has no Position in the scene file, so it stays.');
    set('Source.Position', [...round(carry(by, from.source)), 'mm'], dragging, old);
  } else if (chosen.kind === 'detector') {
    if (!valueOf('Detector.Position')) return say3D('The detector is fitted to the samples; a Position in the scene file makes it movable.');
    const [column, row] = from.steps.map(step => add(carry(by, step), -1, carry(by, [0, 0, 0]))), axis = step => round(unit(step));
    alter(s => {
      s.settings['Detector.Position'] = [...round(carry(by, from.centre)), 'mm'];
      if (valueOf('Detector.ColumnStep')) {
        s.settings['Detector.ColumnStep'] = [...round(column), 'mm'];
        s.settings['Detector.RowStep'] = [...round(row), 'mm'];
      } else {
        s.settings['Detector.UpVector'] = axis(row);
        s.settings['Detector.RightVector'] = axis(column);
      }
    }, dragging, old);
  }
  describe();
  change();
}

function say3D(sentence) {
  showSentence(sentence);
}

function beginGrip(kind, k, event) {
  const middle = middleOf(), at = onScreen(middle);
  grip = {kind, k, middle, at, x: event.offsetX, y: event.offsetY, begun: {state: mark(), view: scene.view}, scale: mmPerPixel(middle), matrix: shot.m};
  event.target.setPointerCapture(event.pointerId);
  event.preventDefault();
}

function gripMatrix(event) {
  const {kind, k, middle, at, x, y, scale, matrix} = grip, snap = (value, by) => event.shiftKey ? Math.round(value / by) * by : value;
  if (kind === 'arrow') {
    const tip = place(matrix, add(middle, REACH * scale, AXES[k]), canvas.clientWidth, canvas.clientHeight) || at;
    const [sx, sy] = [tip[0] - at[0], tip[1] - at[1]], length = sx * sx + sy * sy;
    if (length < 1) return same; // the axis points at the eye
    const mm = snap(((event.offsetX - x) * sx + (event.offsetY - y) * sy) / length * REACH * scale, SNAP.mm);
    return shift(AXES[k].map(a => a * mm));
  }
  const toward = dot(AXES[k], add(eyePoint(), -1, middle)) > 0 ? 1 : -1; // rows grow downwards on a screen
  const angle = toward * (Math.atan2(y - at[1], x - at[0]) - Math.atan2(event.offsetY - at[1], event.offsetX - at[0]));
  return turnAbout(middle, AXES[k], snap(angle, SNAP.degrees * Math.PI / 180));
}

function listenToGizmo() {
  const overlay = byId('gizmo'), shape = (kind, k) => {
    const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
    path.dataset[kind] = k;
    path.setAttribute('stroke', COLOURS[k]);
    if (kind === 'arrow') path.setAttribute('marker-end', `url(#tip${k})`);
    path.onpointerdown = event => beginGrip(kind, k, event);
    path.onpointermove = event => { if (grip) moveChosen(gripMatrix(event), true, grip.begun); };
    path.onpointerup = event => {
      if (!grip) return;
      const {begun} = grip, by = gripMatrix(event);
      grip = null;
      moveChosen(by, false, begun);
    };
    path.onpointercancel = () => { grip = null; };
    return path;
  };
  for (const kind of ['ring', 'arrow']) for (let k = 0; k < 3; k++) overlay.append(shape(kind, k));
}
