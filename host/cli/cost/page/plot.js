"use strict";
/* Numbers in words, and the plot of error against time. */
const byId = id => document.getElementById(id);
const plain = text => String(text).replace(/[&<>"]/g, c => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})[c]);
const number = (value, digits) => value === null ? "" : value === 0 ? "0" : Number(value.toPrecision(digits || 3)).toString();
const round2 = value => value === 0 ? "0" : Math.abs(value) >= 100 ? Math.round(value).toString() : Number(value.toPrecision(2)).toString();
const scientific = value => value === null ? "not finite" : value === 0 ? "0" : value.toExponential(1);
/* 0.21 % for a fraction; very small ones have an exponent. */
const percent = share => share === null ? "not finite" : share === 0 ? "0 %" : (100 * share >= 1e-6 ? Number((100 * share).toPrecision(2)).toFixed(9).replace(/0+$/, "").replace(/[.]$/, "")
  : (100 * share).toExponential(0)) + " %";
/* 8.1 \u00b1 0.6 ms: with the uncertainty where it matters. */
const price = p => round2(p.ms) + (p.uncertainty > 0.05 * p.ms ? " \u00b1 " + round2(p.uncertainty) : "") + " ms";
/* Where the line of a mark ends. */
const slowest = s => s.price.ms + s.price.uncertainty;

const looks = { /* colour in the light, colour in the dark, path around (0, 0) */
  "scene": ["#1a1c20", "#ffffff", "M-7 0a7 7 0 1 0 14 0a7 7 0 1 0 -14 0z"],
  "precision": ["#0072b2", "#56b4e9", "M-5.5 0a5.5 5.5 0 1 0 11 0a5.5 5.5 0 1 0 -11 0z"],
  "tolerance": ["#00795a", "#2fd6a8", "M-5 -5h10v10h-10z"],
  "bins": ["#b34700", "#ff9d5c", "M0 -6.5l6 11h-12z"],
  "source samples": ["#b0558a", "#f09cc8", "M0 -7l7 7-7 7-7-7z"],
  "supersampling": ["#8a6d00", "#f0d442", "M-2.2 -6.5h4.4v4.3h4.3v4.4h-4.3v4.3h-4.4v-4.3h-4.3v-4.4h4.3z"],
  "repair": ["#7a3fb0", "#c79bf0", "M0 -7l2 5h5l-4 3.4 1.6 5.6-4.6-3.4-4.6 3.4 1.6-5.6-4-3.4h5z"],
  "triangles": ["#c22f2f", "#ff8080", "M0 6.5l6-11h-12z"],
  "several": ["#70757f", "#9aa0ab", "M-4.6 -4.6l9.2 9.2m0 -9.2l-9.2 9.2"]};
const isDark = () => document.documentElement.classList.contains("dark");
const colour = dial => (looks[dial] || looks.several)[isDark() ? 1 : 0];
const shape = (dial, x, y, more) => dial === "several"
  ? `<path ${more} transform="translate(${x} ${y})" d="${looks.several[2]}" fill="none" stroke="${colour(dial)}" stroke-width="2"/>`
  : `<path ${more} transform="translate(${x} ${y})" d="${looks[dial][2]}" fill="${colour(dial)}" stroke="${isDark() ? "#14161a" : "#fff"}" stroke-width="0.8"/>`;

/* A logarithmic axis from a to b: its decades, with 2 and 5 between them if there are few. */
function decades(a, b) {
  const low = Math.log10(a), high = Math.log10(b), marks = [], few = high - low < 2.5;
  for (let power = Math.floor(low); power <= high; power++)
    for (const digit of few ? [1, 2, 5] : [1]) {
      const v = digit * 10 ** power;
      if (v >= a * 0.999 && v <= b * 1.001) marks.push(v);
    }
  return marks;
}

const box = {left: 78, right: 660, top: 16, bottom: 410};
let isNarrow = false; /* without the scales on the right, so that the text of a phone is not small */
function makeBox() {
  const width = Math.min(Math.max(Math.round(byId("plot").clientWidth) || 820, 320), 820);
  isNarrow = width < 640;
  box.left = isNarrow ? 58 : 78;
  box.right = isNarrow ? width - 12 : width - 160;
  byId("plot").setAttribute("viewBox", `0 0 ${width} 470`);
}
let key = "rms"; /* of the error that is shown */

/* The settings that the plot shows, with their places. */
function placed() {
  const shown = study.settings.map((s, i) => ({s, i})).filter(p => p.s[key] !== null && p.s.price.ms > 0 && p.s.image !== null);
  const positive = shown.map(p => p.s[key]).filter(e => e > 0), times = shown.flatMap(p => [p.s.price.ms, slowest(p.s)]);
  if (study.noise !== null && key === "rms") positive.push(study.noise, study.noise / 10);
  const low = Math.min(...positive, 1) / 1.6, high = Math.max(...positive, 1e-9) * 1.6;
  const fast = Math.min(...times) / 1.25, slow = Math.max(...times) * 1.25;
  const x = ms => box.left + (box.right - box.left) * Math.log(ms / fast) / Math.log(slow / fast);
  const y = e => box.bottom - (box.bottom - box.top) * Math.max(Math.log(Math.max(e, low) / low) / Math.log(high / low), 0);
  for (const p of shown) p.x = x(p.s.price.ms), p.y = y(p.s[key]);
  return {shown, x, y, low, high, fast, slow};
}

/* A second scale of errors on the right: `unit` is the error that one of it is. */
function secondScale(at, unit, place, name) {
  const marks = decades(at.low / unit, at.high / unit).slice(-9);
  return `<line x1="${place}" x2="${place}" y1="${box.top}" y2="${box.bottom}" stroke="var(--rule)"/>` + marks.map(v =>
    `<line x1="${place}" x2="${place + 5}" y1="${at.y(v * unit)}" y2="${at.y(v * unit)}" stroke="var(--faint)"/>` +
    `<text class="faint" x="${place + 9}" y="${at.y(v * unit) + 4}">${v >= 1e-3 ? number(v) : v.toExponential(0)}</text>`).join("") +
    `<text class="faint" text-anchor="middle" transform="translate(${place + 62} ${(box.top + box.bottom) / 2}) rotate(90)">${name}</text>`;
}

function grid(at) {
  let text = "";
  for (const v of decades(at.fast, at.slow))
    text += `<line x1="${at.x(v)}" x2="${at.x(v)}" y1="${box.top}" y2="${box.bottom}" stroke="var(--rule)"/>` +
      `<text x="${at.x(v)}" y="${box.bottom + 19}" text-anchor="middle">${number(v)}</text>`;
  for (const v of decades(at.low, at.high))
    text += `<line x1="${box.left}" x2="${box.right}" y1="${at.y(v)}" y2="${at.y(v)}" stroke="var(--rule)"/>` +
      `<text x="${box.left - 7}" y="${at.y(v) + 4}" text-anchor="end">${percent(v).replace(" %", "")}</text>`;
  text += `<text x="${(box.left + box.right) / 2}" y="${box.bottom + 44}" text-anchor="middle">${study.frames > 1
    ? "milliseconds a frame, in batches of " + study.frames : "milliseconds an image"} ${isNarrow ? "" : study.settings[0].price.clock === "cpu" ? "on an idle machine, by processor time" : "on the wall"}</text>` +
    `<text transform="translate(15 ${(box.top + box.bottom) / 2}) rotate(-90)" text-anchor="middle">error, % of the open beam</text>`;
  if (isNarrow) return text;
  if (study.grey_levels !== null) text += secondScale(at, 1 / study.grey_levels, box.right, "grey levels of 256 in a PNG");
  if (study.noise !== null) text += secondScale(at, study.noise, box.right + 78, "sigma of the scene's noise");
  return text;
}

/* Draws the background of the marks: the noise, the uncertainty of the best image, the dials, the frontier. */
function behind(at) {
  const line = (v, name) => `<line class="noise" x1="${box.left}" x2="${box.right}" y1="${at.y(v)}" y2="${at.y(v)}" stroke="${colour("bins")}" stroke-dasharray="2 3"/>` +
    `<text class="faint" x="${box.left + 6}" y="${at.y(v) - 4}">${name}</text>`;
  let text = study.noise !== null && key === "rms" ? line(study.noise, "the scene's noise") + line(study.noise / 10, "a tenth of it") : "";
  if (study.reference_error > at.low && key === "rms")
    text += `<rect x="${box.left}" width="${box.right - box.left}" y="${at.y(study.reference_error)}" height="${box.bottom - at.y(study.reference_error)}" fill="var(--band)" opacity="0.35"/>` +
      `<text class="faint" x="${box.right - 6}" y="${box.bottom - 6}" text-anchor="end">the best image is not known better than this</text>`;
  const join = (points, style) => points.length < 2 ? "" : `<polyline fill="none" ${style} points="${points.map(p => p.x + "," + p.y).join(" ")}"/>`;
  for (const dial of Object.keys(looks).slice(1, -1)) {
    const its = at.shown.filter(p => p.s.dial === dial || p.i === study.here);
    text += join(its.sort((a, b) => a.s[key] - b.s[key]), `stroke="${colour(dial)}" stroke-opacity="0.35" stroke-width="1.5"`);
  }
  return text + join(at.shown.filter(p => p.s.best).sort((a, b) => a.x - b.x), 'id="frontier" stroke="var(--faint)" stroke-dasharray="6 4" stroke-width="1.5"');
}

function mark(p, at, chosen) {
  const far = at.x(slowest(p.s)), title = `<title>${plain(p.s.value + ": " + price(p.s.price) + ", " + percent(p.s[key]))}</title>`;
  const whisker = far - p.x > 2 ? `<line x1="${p.x}" x2="${far}" y1="${p.y}" y2="${p.y}" stroke="${colour(p.s.dial)}" stroke-opacity="0.6"/>` +
    `<line x1="${far}" x2="${far}" y1="${p.y - 3}" y2="${p.y + 3}" stroke="${colour(p.s.dial)}" stroke-opacity="0.6"/>` : "";
  const ring = p.i === chosen ? `<circle class="ring" cx="${p.x}" cy="${p.y}" r="12" fill="none" stroke="var(--mark)" stroke-width="3"/>` : "";
  return `<g class="point" data-index="${p.i}">${title}${whisker}${ring}${shape(p.s.dial, p.x, p.y, "")}</g>`;
}

function drawPlot(chosen) {
  makeBox();
  const at = placed(), here = at.shown.find(p => p.i === study.here);
  const right = here && here.x > (box.left + box.right) / 2;
  const label = here ? `<text x="${here.x + (right ? -13 : 13)}" y="${here.y - 11}" text-anchor="${right ? "end" : "start"}" font-weight="bold">you are here</text>` : "";
  byId("plot").innerHTML = grid(at) + behind(at) +
    `<rect x="${box.left}" y="${box.top}" width="${box.right - box.left}" height="${box.bottom - box.top}" fill="none" stroke="var(--faint)"/>` +
    [...at.shown].sort((a, b) => (a.s.dial !== "several") - (b.s.dial !== "several") || (a.i === study.here) - (b.i === study.here))
      .map(p => mark(p, at, chosen)).join("") + label;
  const seen = Object.keys(looks).filter(d => at.shown.some(p => p.s.dial === d));
  byId("legend").innerHTML = seen.map(d => `<span><svg viewBox="-8 -8 16 16">${shape(d, 0, 0, "")}</svg>${d === "scene" ? "this scene" : d === "several" ? "several dials changed"
    : d + " changed"}</span>`).join("") + "<span>- - the best that was found</span>";
  return at;
}
