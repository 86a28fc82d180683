"use strict";
/* The chosen setting: its numbers, command and pictures, and the controls that choose it. */
const frontier = study.settings.map((s, i) => ({s, i})).filter(p => p.s.best && p.s.image).sort((a, b) => a.s.price.ms - b.s.price.ms);
let chosen = study.here, source = -1; /* source: whose difference is shown instead of the setting's; -1: none */
let painting = null;                  /* the promise of the picture of differences */

function head() {
  byId("scene").textContent = "What accuracy costs: " + study.scene + ", " + study.columns + " x " + study.rows + " pixels, " +
    study.triangles.toLocaleString("en") + " triangles";
  byId("summary").textContent = study.summary.replace(/\+-/g, "\u00b1");
  byId("trust").textContent = (study.stopped ? "Stopped by hand: what was measured until then is shown. " : "") + study.settings.length + " settings in " +
    Math.round(study.seconds) + " s on " + study.device + ", " + study.date + ". " + (study.unrest === null ? "" :
    "Prices are " + (study.settings[0].price.clock === "cpu" ? "processor time" : "time on the wall") + "; that of the same image varied by " +
    Math.round(100 * study.unrest) + " % (middle half of its runs). ") +
    (study.left_out ? study.left_out + " settings did not fit in the given time (--within). " : "");
  document.querySelector("#compared tbody").innerHTML = study.references.filter(r => r)
    .map(r => "<tr><td>" + plain(r.dials) + "</td><td>" + plain(r.text) + "</td></tr>").join("");
  byId("notes").innerHTML = study.notes.map(note => "<p>" + plain(note) + "</p>").join("");
  byId("show-buy").hidden = study.buy === null;
  for (const id of ["accept", "have"]) byId(id).max = frontier.length - 1;
}

function advise() {
  document.querySelector("#advice tbody").innerHTML = study.advice.map(a => {
    const met = a.reason === null, its = a.settings_index === null ? null : study.settings[a.settings_index];
    const text = its ? its.setting.text : "as in the command";
    return `<tr><td class="${met ? "met" : ""}">${percent(a.tolerance)}<br><span class="faint">${a.tolerance.toExponential()}</span></td>` +
      `<td>${its ? price(its.price) : "not timed: it takes too long"}</td>` +
      `<td>${plain(text)}${a.bar > a.tolerance ? `<br><span class="faint">a tenth of the noise, ${percent(a.bar)}, is enough</span>` : ""}` +
      `${met ? "" : "<br><b>not reached</b>: " + plain(a.reason)}</td><td><button data-copy="${plain(a.whole_command)}">copy</button> <code>${plain(a.whole_command)}</code></td></tr>`;
  }).join("");
}

const isModel = p => p.dial === "relaxation" || p.dial === "hysteresis";

function list() {
  const cells = cells => cells.map(cell => "<td>" + plain(cell) + "</td>").join("");
  byId("rows").innerHTML = study.points.map((p, i) => isModel(p) ? "" : `<tr data-index="${p.settings_index}">` +
    cells([p.dial + (p.frontier ? " *" : ""), p.setting.text, p.nodes, p.planes, ...[p.price.ms, p.wall_now_ms, p.plan_ms].map(ms => number(ms)), scientific(p.max_open),
           scientific(p.rms_open), scientific(p.max_ref), scientific(p.rms_ref), p.max_mm === null ? "" : scientific(p.max_mm), p.rms_mm === null ? "" : scientific(p.rms_mm)]) + "</tr>").join("");
  const models = study.points.filter(isModel);
  byId("models").hidden = !models.length;
  document.querySelector("#moved tbody").innerHTML = models.map(p => "<tr>" + cells([p.dial, p.setting[p.dial], number(p.price.ms), number(p.max_mm), number(p.rms_mm),
    percent(p.rms_open)]) + "</tr>").join("");
}

/* How much the image changes when a part moves. */
function listSensitivity() {
  const its = study.sensitivity;
  byId("sensitive").hidden = !its;
  if (!its) return;
  document.querySelector("#sensitivity tbody").innerHTML = its.parts.map(p => "<tr>" + [p.part, ...[p.x, p.y, p.z, p.largest].map(percent),
    p.direction.map(d => d.toFixed(3)).join(", ")].map(cell => "<td>" + plain(cell) + "</td>").join("") + "</tr>").join("");
  byId("insensitive").textContent = (its.reason || "") + (its.saturated ? its.saturated + " slopes of faces were cut off, and the changes are larger than shown. " : "") +
    (!its.reason && its.parts.length < its.of ? "Stopped by hand: " + (its.of - its.parts.length) + " parts are missing." : "");
}

/* Channels of a colour of the style sheet. */
const channels = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim().match(/^#(..)(..)(..)$/)?.slice(1).map(h => parseInt(h, 16)) || [255, 255, 255];

/* v from -1 to 1: blue is less than the best image, red is more. */
function tinter() {
  const middle = channels("--middle"), less = channels("--less"), more = channels("--more");
  return v => middle.map((m, k) => m + Math.min(Math.abs(v), 1) * ((v < 0 ? less : more)[k] - m));
}

function paint(canvas, values) {
  const context = canvas.getContext("2d"), data = context.createImageData(canvas.width, canvas.height), tint = tinter();
  for (let i = 0; i < data.data.length / 4; i++) data.data.set([...tint(values(i)), 255], 4 * i);
  context.putImageData(data, 0, 0);
}

/* The picture holds cube roots of the differences; middle grey is none. */
async function paintDifference(p) {
  const canvas = byId("difference"), picture = new Image();
  await new Promise(done => { picture.onload = done; picture.src = p.difference; });
  if ((source >= 0 ? study.sources[source] : study.settings[chosen]) !== p) return; /* another one was chosen meanwhile */
  canvas.width = picture.naturalWidth;
  canvas.height = picture.naturalHeight;
  const context = canvas.getContext("2d", {willReadFrequently: true});
  context.drawImage(picture, 0, 0);
  const grey = context.getImageData(0, 0, canvas.width, canvas.height).data;
  paint(canvas, i => Math.abs(grey[4 * i] - 127.5) < 1 ? 0 : (grey[4 * i] - 127.5) / 127.5);
  paint(byId("bar"), i => (i - 120) / 120);
}

function showPictures() {
  const s = study.settings[chosen], p = source >= 0 ? study.sources[source] : s, pictured = study.settings[chosen].image ? s : study.settings[study.here];
  byId("pictures").hidden = !p.difference;
  byId("missing").hidden = Boolean(p.difference);
  if (!p.difference) return;
  byId("image").src = pictured.image;
  byId("ends").innerHTML = [-1, 0, 1].map(v => "<span>" + (v > 0 ? "+" : v < 0 ? "\u2212" : "") + (v ? percent(p.range) : "0") + "</span>").join("");
  byId("caption").textContent = (source >= 0 ? "What " + p.name + " alone does to this scene's image" : "Difference from the best image") +
    ", of the open beam: the largest of each block. The scale is a cube root, so that small ones show.";
  painting = paintDifference(p);
}

/* Shows a setting; everything on the page follows. */
function choose(index, itsSource = -1) {
  chosen = index;
  source = itsSource;
  const s = study.settings[index];
  byId("name").textContent = index === study.here ? "This scene" : index === study.buy ? "Best buy: " + s.value : s.value;
  byId("numbers").textContent = price(s.price) + (s.rms === null ? "" : ", " + percent(s.rms) + " off (" + percent(s.max) + " at the worst pixel)");
  byId("command").textContent = s.command;
  for (const row of byId("rows").children) row.classList.toggle("chosen", Number(row.dataset.index) === index);
  const exact = frontier.findIndex(p => p.i === index);
  /* not the best: the sliders stand where its error would be cheapest, and say so */
  const at = exact >= 0 ? exact : Math.max(frontier.findIndex(p => p.s.rms <= s.rms), 0);
  byId("accept").value = frontier.length - 1 - at;
  byId("have").value = at;
  byId("accept").ariaValueText = byId("accepted").textContent = (exact >= 0 ? "" : "\u2248 ") + percent(s.rms);
  byId("have").ariaValueText = byId("had").textContent = (exact >= 0 ? "" : "\u2248 ") + price({ms: s.price.ms, uncertainty: 0});
  showPictures();
  drawPlot(chosen);
}

const slide = place => { if (frontier[place]) choose(frontier[place].i); };

async function copy(text, button) {
  let done = true;
  try { await navigator.clipboard.writeText(text); } catch (error) { /* a page from a file may not be allowed to */
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    done = document.execCommand("copy");
    area.remove();
  }
  const before = button.dataset.says || (button.dataset.says = button.textContent);
  button.textContent = done ? "copied" : "select it and press Ctrl-C";
  setTimeout(() => { button.textContent = before; }, 1500);
}

/* The next slower (1) or faster (-1) setting of the plot. */
function step(by) {
  const order = placed().shown.filter(p => p.s.difference).sort((a, b) => a.x - b.x || b.y - a.y);
  const at = order.findIndex(p => p.i === chosen), next = order[Math.min(Math.max(at + by, 0), order.length - 1)];
  if (next) choose(next.i);
}

function setDark(dark) {
  document.documentElement.classList.toggle("dark", dark);
  byId("dark").setAttribute("aria-pressed", dark);
  drawBars();
  choose(chosen, source);
}

function listenToKeys() {
  document.addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest("select, textarea")) return;
    const act = {e: () => byId("accept").focus(), t: () => byId("have").focus(), h: () => choose(study.here), c: () => copy(study.settings[chosen].command, byId("copy")),
                 b: () => { if (study.buy !== null) choose(study.buy); }, d: () => setDark(!isDark())}[event.key.toLowerCase()];
    if (act) act();
  });
  byId("plot").addEventListener("keydown", event => {
    const by = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[event.key];
    if (by) event.preventDefault(), step(by);
  });
}

function listen() {
  const pick = event => {
    const at = event.target.closest("[data-index]");
    if (at) choose(Number(at.dataset.index));
  };
  byId("rows").addEventListener("click", pick);
  byId("plot").addEventListener("click", pick);
  byId("accept").addEventListener("input", () => slide(frontier.length - 1 - Number(byId("accept").value)));
  byId("have").addEventListener("input", () => slide(Number(byId("have").value)));
  addEventListener("resize", () => drawPlot(chosen));
  byId("error").addEventListener("change", () => { key = byId("error").value; drawPlot(chosen); });
  byId("home").addEventListener("click", () => choose(study.here));
  byId("show-buy").addEventListener("click", () => choose(study.buy));
  byId("dark").addEventListener("click", () => setDark(!isDark()));
  byId("copy").addEventListener("click", () => copy(study.settings[chosen].command, byId("copy")));
  document.addEventListener("click", event => {
    const button = event.target.closest("[data-copy]"), track = event.target.closest("[data-source]");
    if (button) copy(button.dataset.copy, button);
    if (track) choose(study.here, Number(track.dataset.source));
  });
}

head();
advise();
list();
listSensitivity();
listen();
listenToKeys();
setDark(matchMedia("(prefers-color-scheme: dark)").matches);
