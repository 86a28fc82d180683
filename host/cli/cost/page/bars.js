"use strict";
/* A bar for each source of error, and what halving it costs. */
const dialOf = {"triangles": "triangles", "precision": "precision", "bins of the spectrum": "bins", "tolerance": "tolerance", "source samples": "source samples",
                "supersampling": "supersampling", "repair": "repair"};
const extra = (ms, spread) => ms === null ? "" : ", " + (Math.abs(ms) <= spread ? "the same time within \u00b1 " + round2(spread) + " ms"
  : (ms > 0 ? "+" : "\u2212") + round2(Math.abs(ms)) + (spread > 0.05 * Math.abs(ms) ? " \u00b1 " + round2(spread) : "") + " ms");

function bar(source, i, largest) {
  const name = `<span>${plain(source.name)}${source.today ? `<br><span class="faint">${plain(source.today)}</span>` : ""}</span>`;
  if (source.error === null)
    return `${name}<span class="track"><span class="unknown"></span></span><span class="why">${plain((source.state === "not known" ? "not known: " : "") + source.reason)}</span>`;
  const buys = source.halving === null ? `<span class="faint">${plain(source.reason || "")}</span><span></span>`
    : `<span class="buys">half of it: ${plain(source.halving)}${extra(source.halving_ms, source.halving_uncertainty_ms)}</span>` +
      `<button data-copy="${plain(source.command)}" title="${plain(source.command)}">copy</button>`;
  return `${name}<button class="track" data-source="${i}" aria-label="${plain(source.name)}: ${percent(source.error)}; show where">` +
    `<span class="fill" style="width:${100 * source.error / largest}%;background:${colour(dialOf[source.name])}"></span></button>` +
    `<span class="number">${source.state === "coarse" ? "about " : ""}${percent(source.error)}</span>${buys}`;
}

function drawBars() {
  const largest = Math.max(...study.sources.map(s => s.error || 0)) || 1;
  const order = study.sources.map((s, i) => ({s, i})).filter(p => p.s.error !== 0).sort((a, b) => (b.s.error ?? -1) - (a.s.error ?? -1));
  const none = study.sources.filter(s => s.error === 0);
  const rows = order.map(p => bar(p.s, p.i, largest));
  if (none.length) rows.push(`<span>none</span><span class="gap"></span><span class="why">${none.map(s => plain(s.name + (s.reason ? " (" + s.reason + ")" : ""))).join(", ")}</span>`);
  byId("bars").innerHTML = rows.map(row => `<div class="source">${row}</div>`).join("");
}
