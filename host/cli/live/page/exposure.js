// Focal spot and jaws. The server sends both in mm, whatever the units of the scene file, and the page writes mm.
'use strict';

// Calls `show` when the server has sent a new scene, or when the key was changed by anything but these controls, such as undo or a
// refused value. Returns the function by which the controls set the key.
function follow(key, show) {
  let seen, written;
  watch(() => {
    const now = JSON.stringify(valueOf(key));
    if (!live || (live === seen && now === written)) return;
    seen = live, written = now;
    show();
  });
  return (value, dragging = false, begun = null) => { written = JSON.stringify(value); set(key, value, dragging, begun); };
}

// Names of enum skg_spot_shape in scene files, and the shapes that have a width and a height.
const SPOTS = ['PointSource', 'Line', 'Rectangle', 'Cube', 'Disc', 'Sphere', 'Gaussian'], OBLONG = ['Rectangle', 'Gaussian'];

function fillSpot() {
  const shape = byId('spot-shape'), slider = byId('spot-slider'), width = byId('spot-width'), height = byId('spot-height');
  let begun = null;
  shape.replaceChildren(...SPOTS.map(name => new Option(name === 'PointSource' ? 'point' : name.toLowerCase(), name)));
  const hide = () => {
    for (const box of [slider, width, byId('spot-mm')]) box.hidden = shape.value === 'PointSource';
    height.hidden = !OBLONG.includes(shape.value);
  };
  const write = follow('Source.Shape', () => {
    byId('spot').hidden = !live.spot;
    if (!live.spot || begun) return;
    shape.value = SPOTS[live.spot.shape];
    if (live.spot.extent && shape.value !== 'PointSource')
      slider.value = width.value = number(live.spot.extent[0], 6), height.value = number(live.spot.extent[1], 6);
    hide();
  });
  const put = (dragging = false, old = null) => {
    const sizes = (OBLONG.includes(shape.value) ? [width, height] : [width]).map(box => Number(box.value));
    hide();
    write(shape.value === 'PointSource' ? shape.value : [shape.value, ...sizes, 'mm'], dragging, old);
  };
  shape.onchange = () => {
    for (const box of [width, height]) if (!(Number(box.value) > 0)) box.value = slider.value = 1;
    put();
  };
  slider.oninput = () => { begun = begun || mark(); width.value = slider.value; put(true, begun); };
  slider.onchange = () => { const old = begun; begun = null; width.value = slider.value; put(false, old); };
  width.onchange = () => { slider.value = width.value; put(); };
  height.onchange = () => put();
}

// Default of a rectangle: jaws halfway to the detector, open for 80 % of its width and height.
function someJaws() {
  const v = scene.view, half = [v.columns * size(v.steps[0]), v.rows * size(v.steps[1])].map(length => 0.4 * length);
  const isParallel = scene.view.projection !== 'point', share = isParallel ? 1 : 0.5;
  const [x, y] = half.map(length => Number((share * length).toPrecision(4)));
  return {edges: [-x, x, -y, y], distance: 0.5 * size(add(scene.view.centre, -1, scene.view.source))};
}

function fillJaws() {
  const kind = byId('jaws'), slider = byId('margin-slider'), margin = byId('margin'), names = ['left', 'right', 'bottom', 'top', 'distance'];
  const edges = names.map(name => byId('jaws-' + name));
  let begun = null;
  const hide = () => {
    byId('jaws-field').hidden = kind.value !== 'field', byId('jaws-edges').hidden = kind.value !== 'edges';
    edges[4].parentNode.hidden = scene.view.projection !== 'point';
  };
  const showEdges = ({edges: [...four], distance}) => [...four, distance].forEach((mm, i) => { edges[i].value = number(mm, 6); });
  const write = follow('Collimation', () => {
    if (begun) return;
    kind.value = !live.jaws ? 'open' : live.jaws.edges ? 'edges' : 'field';
    if (live.jaws && live.jaws.edges) showEdges(live.jaws);
    else if (live.jaws) slider.value = margin.value = number(live.jaws.margin, 6);
    hide();
  });
  const put = (dragging = false, old = null) => {
    const [left, right, bottom, top, distance] = edges.map(box => Number(box.value));
    const rectangle = {Rectangle: [[left, right], [bottom, top], 'mm'], ...(live.spot ? {Distance: [distance, 'mm']} : {})};
    hide();
    write(kind.value === 'open' ? 'open' : kind.value === 'field' ? {Field: 'detector', Margin: [Number(margin.value), 'mm']} : rectangle, dragging, old);
  };
  kind.onchange = () => { if (kind.value === 'edges') showEdges(someJaws()); put(); };
  slider.oninput = () => { begun = begun || mark(); margin.value = slider.value; put(true, begun); };
  slider.onchange = () => { const old = begun; begun = null; margin.value = slider.value; put(false, old); };
  margin.onchange = () => { slider.value = margin.value; put(); };
  for (const box of edges) box.onchange = () => put();
}

// The open beam at the detector.
function showExposure(beam) {
  byId('photons').textContent = `${number(beam.photons, 3)} photons a pixel, mean ${number(beam.mean_kev, 3)} keV`;
  byId('kerma').textContent = `air kerma at the detector ${number(beam.air_kerma_ugy, 3)} \u00b5Gy`;
}
