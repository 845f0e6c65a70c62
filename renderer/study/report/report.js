"use strict";
// Lays out the report from the data in the page: tables, and plots of errors.

const data = JSON.parse(document.getElementById("data").textContent);
const { study, results, times, pictures, series, metrics, figures, latex } = data;
const everything = [...new Set(results.summary.map(r => r.entry))];
/** Without those that lack a stage: they have a table of their own. */
const entries = everything.filter(name => !study.methods.some(m => m.name === name && m.stage));
const scenes = [...new Set(results.summary.map(r => r.scene))];
const sampleCounts = [...new Set(results.summary.map(r => r.spp))].sort((a, b) => a - b);
const measured = [...new Set(results.summary.map(r => r.metric))];
const entryColour = name => colourOf(everything.indexOf(name));
const sceneTitle = name => name === "all" ? "All scenes together" : name;
const main = document.querySelector("main"), contents = document.querySelector("nav.contents");
const swept = study.axes.length > 0;

function section(id, title, text) {
  const element = document.createElement("section");
  element.innerHTML = `<h2 id="${id}">${escapeText(title)}</h2>${text ? `<p>${text}</p>` : ""}`;
  main.insertBefore(element, document.querySelector("footer"));
  contents.insertAdjacentHTML("beforeend", `<a href="#${id}">${escapeText(title)}</a>`);
  return { add(html, className = "card") { element.insertAdjacentHTML("beforeend", className ? `<div class="${className}">${html}</div>` : html); return element.lastElementChild; } };
}
const find = (list, wanted) => list.find(r => Object.entries(wanted).every(([k, v]) => r[k] === v));
const half = r => r.low === null ? null : (r.high - r.low) / 2;
/** A number with the half-width of its interval. */
const interval = (r, unit = "") => r.mean === null || r.mean === undefined ? "–"
  : `${shown(r.mean, 4)}${unit}<span class="pm">${half(r) === null ? "" : `± ${shownHalf(half(r), r.mean)}`}</span>`;
/** A difference: marked where the interval tells it from none. */
const isSure = r => r.low !== null && (r.low > 0 || r.high < 0);
const difference = (r, unit = "") => r.mean === null ? "–" : `<span class="${isSure(r) ? "sure" : ""}">${r.mean > 0 ? "+" : ""}${shown(r.mean, 3)}${unit}</span>` +
  `<span class="pm">${half(r) === null ? "" : `± ${shownHalf(half(r), r.mean, 3)}`}</span>`;
const seedCount = study.seeds.length;
/** Of how many seeds a number is, where that is not all of them. */
const ofSeeds = r => r.count === seedCount ? "" : `<span class="pm" title="In the other seeds it is out of range">${r.count} of ${seedCount} seeds</span>`;
const missing = n => n ? `<span class="gap" title="Images without a finite value; they do not count, and pairs with them neither">${n} without</span>` : "";
const metricTitle = id => metrics[id].title + (metrics[id].higher ? " ↑" : " ↓");

/** One number with its interval and its place among the entries. */
function cell(wanted) {
  const summary = find(results.summary, wanted);
  if (!summary) return "<td>–</td>";
  const ranking = find(results.rankings, { scene: wanted.scene, spp: wanted.spp, metric: wanted.metric });
  const place = ranking && find(ranking.places, { entry: wanted.entry });
  const known = half(summary) !== null && place;
  const rank = known ? `<span class="rank" title="Places that the intervals allow">${place.best_rank === place.worst_rank
    ? place.best_rank : `${place.best_rank}–${place.worst_rank}`}</span>` : "";
  const first = known && place.best_rank === 1 && place.worst_rank === 1;
  return `<td class="${first ? "first" : ""}">${interval(summary)}${rank}${missing(summary.missing)}</td>`;
}

/** Rows are entries, columns metrics, for one scene and number of samples. */
function tableByMetric(scene, spp) {
  const shownMetrics = measured.filter(m => find(results.summary, { scene, spp, metric: m }));
  const rows = entries.filter(e => find(results.summary, { scene, spp, entry: e }));
  return `<h3>${escapeText(sceneTitle(scene))}${sampleCounts.length > 1 ? ` · ${spp} spp` : ""}</h3><table><thead><tr><th></th>` +
    shownMetrics.map(m => `<th>${metricTitle(m)}</th>`).join("") + "</tr></thead><tbody>" +
    rows.map(e => `<tr><td class="name"><i class="swatch" style="background:${entryColour(e)}"></i>${nameMarkup(e)}</td>` +
      shownMetrics.map(m => cell({ scene, entry: e, spp, metric: m })).join("") + "</tr>").join("") + "</tbody></table>";
}

/** Rows are entries, columns sample counts, for one scene and metric. */
function tableBySamples(scene, metric) {
  const rows = entries.filter(e => find(results.summary, { scene, entry: e, metric }));
  return `<h3>${escapeText(sceneTitle(scene))} · ${metricTitle(metric)}</h3><table><thead><tr><th>samples a pixel</th>` +
    sampleCounts.map(s => `<th>${s}</th>`).join("") + "</tr></thead><tbody>" +
    rows.map(e => `<tr><td class="name"><i class="swatch" style="background:${entryColour(e)}"></i>${nameMarkup(e)}</td>` +
      sampleCounts.map(s => cell({ scene, entry: e, spp: s, metric })).join("") + "</tr>").join("") + "</tbody></table>";
}

/** NaN and infinity are said first: whoever reads a mean has to know what it leaves out. */
function addNonFinite(part) {
  const broken = results.references.filter(r => r.nonfinite_pixels > 0);
  if (!results.nonfinite.length && !broken.length) return;
  part.add(`<h3>Pixels that are not finite</h3><p>NaN and infinity count in no metric: the means below leave these pixels out.</p><table><thead><tr><th></th><th class="text">scene</th><th>spp</th><th>pixels</th><th>in images</th></tr></thead><tbody>` +
    results.nonfinite.map(n => `<tr><td class="name">${escapeText(n.entry)}</td><td class="text">${escapeText(n.scene)}</td><td>${n.spp}</td><td>${n.pixels}</td><td>${n.images} of ${n.of_images}</td></tr>`).join("") +
    broken.map(r => `<tr><td class="name">Reference</td><td class="text">${escapeText(r.scene)}</td><td>${r.spp}</td><td>${r.nonfinite_pixels}</td><td>frame ${r.frame}</td></tr>`).join("") +
    "</tbody></table>", "card warning");
}

/** Claims of the study file, and whether the numbers hold them. */
function addChecks() {
  const claims = [...(results.checks || []), ...(times.checks || [])];
  if (!claims.length) return;
  const part = section("checks", "What was claimed", `Against several methods: the one that it holds worst against. "Within the noise": the intervals do not tell what the means say from its contrary. "Unknown": a seed or scene has no value, or a method to compare with did not run at this sample count.`);
  const kinds = { "holds": "holds", "holds within the noise": "close", "fails within the noise": "close", "fails": "fails", "unknown": "fails" };
  part.add(`<table><thead><tr><th>claim</th><th class="text">scene</th>${sampleCounts.length > 1 ? "<th>spp</th>" : ""}<th>value</th><th class="text">against</th><th>ratio</th><th>bound</th><th class="text">verdict</th></tr></thead><tbody>` +
    claims.map(c => `<tr><td class="name claim">${escapeText(c.claim)}</td><td class="text">${escapeText(sceneTitle(c.scene))}</td>${sampleCounts.length > 1 ? `<td>${c.spp}</td>` : ""}<td>${interval(c.value)}</td>` +
      `<td class="text">${escapeText(c.against || "–")}</td><td>${c.ratio ? interval(c.ratio) : "–"}</td><td>${c.at_most === undefined ? `≥ ${shown(c.at_least)}` : `≤ ${shown(c.at_most)}`}</td>` +
      `<td class="text"><span class="verdict ${kinds[c.verdict]}">${c.verdict}</span></td></tr>`).join("") + "</tbody></table>");
}

function addTables() {
  const seeds = study.seeds.length;
  const part = section("tables", "Results", `Means over ${study.frames} and ${seeds} seed${seeds > 1 ? "s" : ""}` + (seeds > 1
    ? `, with the half-width of the ${Math.round(study.level * 100)}% interval. The number in the oval is a method's place; a range of places means that the noise does not tell the methods apart.`
    : ". With one seed nothing is known of the noise, so nothing is ranked."));
  addNonFinite(part);
  for (const scene of scenes) {
    if (sampleCounts.length <= 2) for (const spp of sampleCounts) part.add(tableByMetric(scene, spp));
    else for (const metric of measured) part.add(tableBySamples(scene, metric));
  }
}

function addConvergence() {
  if (sampleCounts.length < 3) return;
  const part = section("convergence", "Convergence", "Error against samples a pixel, both axes logarithmic; bars are intervals over seeds. The dashed line falls as independent samples would.");
  const plots = part.add("", "plots");
  for (const scene of scenes.filter(s => s !== "all"))
    for (const metric of measured.filter(m => !metrics[m].higher && !metrics[m].temporal)) {
      const own = entries.filter(e => find(results.summary, { scene, entry: e, metric }));
      const lines = own.map(name => ({ name, colour: entryColour(name), points: results.summary.filter(r => r.scene === scene && r.entry === name && r.metric === metric)
        .map(r => ({ x: r.spp, y: r.mean, low: r.low, high: r.high })) }));
      const slopes = own.map(name => {
        const slope = find(results.convergence, { scene, entry: name, metric });
        return { colour: entryColour(name), name: slope ? `${name}: slope ${slope.mean.toFixed(2).replace("-", "−")}${half(slope) === null ? "" : ` ± ${half(slope).toFixed(half(slope) < 0.01 ? 3 : 2)}`}` : name };
      });
      plots.insertAdjacentHTML("beforeend", `<figure class="card"><figcaption>${escapeText(scene)}<small>${metrics[metric].title}</small></figcaption>` +
        lineChart({ series: lines, xLabel: "samples a pixel", yLabel: metrics[metric].title, xLog: true, yLog: true, xTicks: sampleCounts,
                    guide: { slope: metrics[metric].squared === "mean" ? -1 : -0.5 } }) + legend(slopes) + "</figure>");
    }
}

function addFrames() {
  const byFrame = results.summary_by_frame, frames = [...new Set(byFrame.map(r => r.frame))];
  if (frames.length < 3 && !series.length) return;
  const part = section("frames", "Over time", "Each measured frame; metrics of sequences at every frame. Means over seeds, bars are their intervals.");
  const plots = part.add("", "plots");
  const plot = (scene, spp, title, lines, label) => plots.insertAdjacentHTML("beforeend",
    `<figure class="card"><figcaption>${escapeText(scene)}<small>${escapeText(title)}${sampleCounts.length > 1 ? ` · ${spp} spp` : ""}</small></figcaption>` +
    lineChart({ series: lines, xLabel: "frame", yLabel: label, xWhole: true }) + legend(lines) + "</figure>");
  for (const scene of scenes.filter(s => s !== "all"))
    for (const spp of sampleCounts) {
      if (frames.length > 2) for (const metric of measured.filter(m => !metrics[m].temporal))
        plot(scene, spp, metrics[metric].title, entries.map(name => ({ name, colour: entryColour(name), points: byFrame.filter(r =>
          r.scene === scene && r.entry === name && r.spp === spp && r.metric === metric).map(r => ({ x: r.frame, y: r.mean, low: r.low, high: r.high })) }))
          .filter(l => l.points.length), metrics[metric].title);
      for (const metric of measured.filter(m => metrics[m].temporal)) {
        const lines = series.filter(s => s.scene === scene && s.spp === spp && s.metric === metric && entries.includes(s.entry))
          .map(s => ({ name: s.entry, colour: entryColour(s.entry), points: s.values.map((y, i) => ({ x: s.begin + i, y, low: s.low[i], high: s.high[i] })) }));
        if (lines.length) plot(scene, spp, metric === "lag" ? "Response to the step" : metrics[metric].title, lines, metric === "lag" ? "share of the step" : metrics[metric].title);
      }
    }
}

function addSweep() {
  if (!swept) return;
  const [first, second] = study.axes;
  const part = section("sweep", "Sweep", second ? "Every combination of the two parameters; brighter is larger. Framed cells share the first place: the noise does not tell them apart."
    : "The metric against the parameter; bars are intervals over seeds.");
  const places = study.methods.filter(m => m.coordinates.length), plots = part.add("", "plots");
  for (const scene of scenes) for (const spp of sampleCounts) for (const metric of measured)
    for (const entry of [...new Set(places.map(m => m.entry))]) {
      const at = (i, j) => places.find(m => m.entry === entry && m.coordinates[0] === first.values[i] && (!second || m.coordinates[1] === second.values[j]));
      const value = (i, j) => (at(i, j) && find(results.summary, { scene, spp, metric, entry: at(i, j).name })) || { mean: NaN, low: null };
      const caption = `<figcaption>${escapeText(entry)}<small>${escapeText(sceneTitle(scene))} · ${metrics[metric].title} · ${spp} spp</small></figcaption>`;
      if (second) {
        const ranking = find(results.rankings, { scene, spp, metric });
        const bestRank = (i, j) => { const place = ranking && at(i, j) && find(ranking.places, { entry: at(i, j).name }); return place ? place.best_rank : Infinity; };
        const ranks = first.values.flatMap((_, i) => second.values.map((__, j) => bestRank(i, j))), least = Math.min(...ranks);
        if (!first.values.some((_, i) => second.values.some((__, j) => Number.isFinite(value(i, j).mean)))) continue;
        plots.insertAdjacentHTML("beforeend", `<figure class="card">${caption}${heatMap({ columns: first.values, rows: second.values, columnLabel: first.id, rowLabel: second.id,
          value: (i, j) => { const r = value(i, j); return { mean: r.mean, half: half(r), best: Number.isFinite(least) && study.seeds.length > 1 && bestRank(i, j) === least }; } })}</figure>`);
      } else {
        const numeric = first.values.every(v => v.trim() !== "" && Number.isFinite(Number(v)));
        const points = first.values.map((v, i) => { const r = value(i); return { x: numeric ? Number(v) : i, y: r.mean, low: r.low, high: r.high }; });
        if (!points.some(p => Number.isFinite(p.y))) continue;
        const spread = Math.max(...points.map(p => p.x)) / Math.min(...points.map(p => p.x));
        plots.insertAdjacentHTML("beforeend", `<figure class="card">${caption}${lineChart({ series: [{ name: entry, colour: colourOf(0), points }], xLabel: numeric ? first.id
          : `${first.id}: ${first.values.join(", ")}`, yLabel: metrics[metric].title, xTicks: points.map(p => p.x), xLog: numeric && spread > 20, yLog: false })}</figure>`);
      }
    }
}
