// A profile: the values of the image along a line, which also measures.
'use strict';
const profile = {on: false, drags: false, from: [0.1, 0.5], to: [0.9, 0.5]};

// mm on the detector between two fractions of the image; along the cylinder of a curved one.
function lengthOnDetector(a, b) {
  const v = scene.view, [column, row] = v.steps;
  return size(add(column.map(x => (b[0] - a[0]) * v.columns * x), (b[1] - a[1]) * v.rows, row));
}

function drawProfile() {
  const line = byId('line'), canvas = byId('plot'), frame = xray.frame, draw = canvas.getContext('2d');
  byId('ruler').toggleAttribute('hidden', !profile.on);
  byId('profile').hidden = !profile.on;
  if (!profile.on || !frame) return;
  const {from, to} = profile, count = 400, values = [];
  for (const [k, p] of [[1, from], [2, to]]) line.setAttribute('x' + k, 100 * p[0] + '%'), line.setAttribute('y' + k, 100 * p[1] + '%');
  for (let i = 0; i < count; i++) {
    const t = i / (count - 1), at = [0, 1].map(k => clamp(from[k] + t * (to[k] - from[k]), 0, 0.999999));
    values.push(shownOf(frame, numberAt(frame, at)));
  }
  const low = Math.min(...values), high = Math.max(...values), scale = (canvas.height - 8) / (high - low || 1);
  draw.clearRect(0, 0, canvas.width, canvas.height);
  draw.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue('--mark');
  draw.lineWidth = 1.5;
  draw.beginPath();
  values.forEach((v, i) => draw.lineTo(i / (count - 1) * canvas.width, canvas.height - 4 - (v - low) * scale));
  draw.stroke();
  byId('measured').textContent = `-ln(I/I0) from ${number(low)} to ${number(high)} over ${number(lengthOnDetector(from, to))} mm of the detector`;
}

function listenToProfile() {
  byId('profiles').onclick = () => {
    byId('profiles').setAttribute('aria-pressed', profile.on = !profile.on);
    drawProfile();
  };
  film.addEventListener('pointerdown', event => {
    const at = placeOn(event);
    if (!profile.on || !at) return;
    film.setPointerCapture(event.pointerId);
    profile.drags = true, profile.from = profile.to = at;
    drawProfile();
  });
  film.addEventListener('pointermove', event => {
    const at = placeOn(event);
    if (!profile.drags || !at) return;
    profile.to = at;
    drawProfile();
  });
  film.addEventListener('pointerup', () => { profile.drags = false; });
}
