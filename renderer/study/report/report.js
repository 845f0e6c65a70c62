"use strict";
// Lays out the report from the data in the page.

const data = JSON.parse(document.getElementById("data").textContent);
const { study, results, times, pictures, series, metrics } = data;
const entries = [...new Set(results.summary.map(r => r.entry))];
const scenes = [...new Set(results.summary.map(r => r.scene))];
const sampleCounts = [...new Set(results.summary.map(r => r.spp))].sort((a, b) => a - b);
const measured = [...new Set(results.summary.map(r => r.metric))];
const entryColour = name => colourOf(entries.indexOf(name));
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
  return `<td class="${first ? "first" : ""}">${shown(summary.mean, 4)}<span class="pm">${half(summary) === null ? "" : `± ${shownHalf(half(summary), summary.mean)}`}</span>${rank}</td>`;
}

/** Rows are entries, columns metrics, for one scene and number of samples. */
function tableByMetric(scene, spp) {
  const shownMetrics = measured.filter(m => find(results.summary, { scene, spp, metric: m }));
  const rows = entries.filter(e => find(results.summary, { scene, spp, entry: e }));
  return `<h3>${escapeText(sceneTitle(scene))}${sampleCounts.length > 1 ? ` · ${spp} spp` : ""}</h3><table><thead><tr><th></th>` +
    shownMetrics.map(m => `<th>${metricTitle(m)}</th>`).join("") + "</tr></thead><tbody>" +
    rows.map(e => `<tr><td class="name"><i class="swatch" style="background:${entryColour(e)}"></i>${escapeText(e)}</td>` +
      shownMetrics.map(m => cell({ scene, entry: e, spp, metric: m })).join("") + "</tr>").join("") + "</tbody></table>";
}

/** Rows are entries, columns sample counts, for one scene and metric. */
function tableBySamples(scene, metric) {
  const rows = entries.filter(e => find(results.summary, { scene, entry: e, metric }));
  return `<h3>${escapeText(sceneTitle(scene))} · ${metricTitle(metric)}</h3><table><thead><tr><th>samples a pixel</th>` +
    sampleCounts.map(s => `<th>${s}</th>`).join("") + "</tr></thead><tbody>" +
    rows.map(e => `<tr><td class="name"><i class="swatch" style="background:${entryColour(e)}"></i>${escapeText(e)}</td>` +
      sampleCounts.map(s => cell({ scene, entry: e, spp: s, metric })).join("") + "</tr>").join("") + "</tbody></table>";
}

function addTables() {
  const seeds = study.seeds.length;
  const part = section("tables", "Results", `Means over ${study.frames} and ${seeds} seed${seeds > 1 ? "s" : ""}` + (seeds > 1
    ? `, with the half-width of the ${Math.round(study.level * 100)}% interval. The number in the oval is a method's place; a range of places means that the noise does not tell the methods apart.`
    : ". With one seed nothing is known of the noise, so nothing is ranked."));
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
  const part = section("frames", "Over time", "Each measured frame; metrics of consecutive frames at every frame. Means over seeds.");
  const plots = part.add("", "plots");
  const plot = (scene, spp, title, lines, label) => plots.insertAdjacentHTML("beforeend",
    `<figure class="card"><figcaption>${escapeText(scene)}<small>${escapeText(title)}${sampleCounts.length > 1 ? ` · ${spp} spp` : ""}</small></figcaption>` +
    lineChart({ series: lines, xLabel: "frame", yLabel: label }) + legend(lines) + "</figure>");
  for (const scene of scenes.filter(s => s !== "all"))
    for (const spp of sampleCounts) {
      if (frames.length > 2) for (const metric of measured.filter(m => !metrics[m].temporal))
        plot(scene, spp, metrics[metric].title, entries.map(name => ({ name, colour: entryColour(name), points: byFrame.filter(r =>
          r.scene === scene && r.entry === name && r.spp === spp && r.metric === metric).map(r => ({ x: r.frame, y: r.mean, low: r.low, high: r.high })) }))
          .filter(l => l.points.length), metrics[metric].title);
      for (const metric of measured.filter(m => metrics[m].temporal)) {
        const lines = series.filter(s => s.scene === scene && s.spp === spp && s.metric === metric)
          .map(s => ({ name: s.entry, colour: entryColour(s.entry), points: s.values.map((y, i) => ({ x: study.temporal_begin + i, y })) }));
        if (lines.length) plot(scene, spp, metrics[metric].title, lines, metrics[metric].title);
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

function addBias() {
  const rows = results.bias_and_variance.filter(r => r.seeds > 1);
  if (!rows.length) return;
  const part = section("bias", "Bias and variance", "Mean squared error of the linear image in two parts: what stays however many seeds are averaged, and what averages away. The reference's own noise is taken off; a bias that is not told from 0 has an interval that holds 0.");
  for (const scene of scenes.filter(s => s !== "all")) {
    const own = rows.filter(r => r.scene === scene);
    part.add(`<h3>${escapeText(scene)}</h3><table><thead><tr><th></th><th>spp</th><th>MSE</th><th>bias²</th><th>variance</th><th>share of bias</th></tr></thead><tbody>` +
      own.map(r => `<tr><td class="name"><i class="swatch" style="background:${entryColour(r.entry)}"></i>${escapeText(r.entry)}</td><td>${r.spp}</td>` +
        `<td>${shown(r.mse.mean)}<span class="pm">${half(r.mse) === null ? "" : `± ${shown(half(r.mse), 2)}`}</span></td>` +
        `<td>${shown(r.squared_bias.mean)}<span class="pm">${half(r.squared_bias) === null ? "" : `± ${shown(half(r.squared_bias), 2)}`}</span></td>` +
        `<td>${shown(r.variance)}</td><td>${r.mse.mean > 0 ? `${Math.round(100 * Math.max(0, r.squared_bias.mean) / r.mse.mean)} %` : "–"}</td></tr>`).join("") + "</tbody></table>");
  }
}

function addTimes() {
  if (!times.rows.length) return;
  const part = section("times", "Times", "Wall-clock medians of a frame on the machine that ran the study: posing, tracing, then the method's stages. They differ from run to run; nothing else in this report does.");
  for (const scene of scenes.filter(s => s !== "all")) {
    const own = times.rows.filter(r => r.scene === scene), phases = ["pose", "trace", ...new Set(own.flatMap(r => Object.keys(r.stages_ms))), "rest of the method"];
    const rows = own.slice(0, 40).map(r => {
      const staged = Object.values(r.stages_ms).reduce((a, b) => a + b, 0);
      const value = p => p === "pose" ? r.pose_ms : p === "trace" ? r.trace_ms : p === "rest of the method" ? Math.max(r.run_ms - staged, 0) : r.stages_ms[p] || 0;
      return { name: own.some(o => o.spp !== r.spp) ? `${r.entry}, ${r.spp} spp` : r.entry, parts: phases.map((p, i) => ({ name: p, value: value(p), colour: colourOf(i) })) };
    });
    part.add(`<figure><figcaption>${escapeText(scene)}<small>milliseconds a frame</small></figcaption>${barChart({ rows, unit: "ms" })}` +
      `${legend(phases.map((name, i) => ({ name, colour: colourOf(i) })))}</figure>`);
  }
  if (times.pairs.length) part.add(`<h3>Equal time and equal error</h3><table><thead><tr><th>method</th><th class="text">scene</th><th>spp</th><th>frame</th><th class="text">metric</th><th>its value</th>` +
    `<th class="text">against</th><th>at equal time</th><th>time for equal value</th></tr></thead><tbody>` + times.pairs.map(p =>
      `<tr><td class="name">${escapeText(p.entry)}</td><td class="text">${escapeText(p.scene)}</td><td>${p.spp}</td><td>${shown(p.equal_time_ms)} ms</td><td class="text">${metrics[p.of].title}</td>` +
      `<td>${shown(p.metric)}</td><td class="text">${escapeText(p.against)}</td><td>${shown(p.against_at_equal_time)}</td><td>${p.against_ms_at_equal_metric === null ? "outside its range" : `${shown(p.against_ms_at_equal_metric)} ms`}</td></tr>`).join("") +
    `</tbody></table><p class="note">Between the other's sample counts, by straight lines in log-log space.</p>`);
  if (results.equivalent_samples) part.add(`<h3>Equivalent samples</h3><table><thead><tr><th>method</th><th class="text">scene</th><th>spp</th><th class="text">metric</th><th class="text">is worth</th><th>samples</th></tr></thead><tbody>` +
    results.equivalent_samples.map(e => `<tr><td class="name">${escapeText(e.entry)}</td><td class="text">${escapeText(e.scene)}</td><td>${e.spp}</td><td class="text">${metrics[e.metric].title}</td><td class="text">${escapeText(e.against)} at</td>` +
      `<td>${shown(e.equivalent_spp.mean)}<span class="pm">${half(e.equivalent_spp) === null ? "" : `± ${shown(half(e.equivalent_spp), 2)}`}${e.extrapolated ? ", extrapolated" : ""}</span></td></tr>`).join("") + "</tbody></table>");
}

function addPictures() {
  if (!pictures.length) return;
  const part = section("pictures", "Images", "As the metrics see them: exposure, clamped, sRGB. Drag the line to wipe, drag the picture to pan; double click, <kbd>Ctrl</kbd>+wheel or <kbd>+</kbd> <kbd>-</kbd> zoom all pictures together. On a selected picture <kbd>Space</kbd> flips, <kbd>E</kbd> shows error maps, <kbd>1</kbd>–<kbd>9</kbd> choose, <kbd>0</kbd> fits.");
  for (const set of pictures) new Viewer(part.add("", "card viewer"), set);
}

function addMethod() {
  const part = section("method", "How these numbers were made");
  if (results.tuning && results.tuning.length) part.add(`<h3>Tuned parameters</h3><table><thead><tr><th>scene</th><th class="text">entry</th><th>spp</th><th class="text">chosen on frame ${results.tuning[0].frame}, by ${results.tuning[0].metric}</th></tr></thead><tbody>` +
    results.tuning.map(t => `<tr><td>${escapeText(t.scene)}</td><td class="text">${escapeText(t.entry)}</td><td>${t.spp}</td><td class="text">${Object.entries(t.chosen).map(([k, v]) => `${escapeText(k)} = ${escapeText(v)}`).join(", ")} <span class="pm">of ${t.candidates.length} combinations</span></td></tr>`).join("") + "</tbody></table>");
  const floors = [...new Set(results.references.flatMap(r => Object.keys(r.floor)))].filter(m => metrics[m]);
  part.add(`<h3>References</h3><table><thead><tr><th>scene</th><th>frame</th><th>spp</th>${floors.map(m => `<th>${metrics[m].title}</th>`).join("")}</tr></thead><tbody>` +
    results.references.map(r => `<tr><td>${escapeText(r.scene)}</td><td>${r.frame}</td><td>${r.spp}</td>${floors.map(m => `<td>${shown(r.floor[m])}</td>`).join("")}</tr>`).join("") +
    `</tbody></table><p class="note">A reference is the mean of two halves with independent random numbers; the columns compare one half with the mean. For means of squares that is the reference's own error, which is taken off above; no other number means anything closer to the reference than this.</p>`);
  part.add(`<h3>Metrics</h3><table><tbody>${measured.map(m => `<tr><td class="name">${metricTitle(m)}</td><td class="text">${escapeText(metrics[m].definition)}${metrics[m].squared ? " The reference's own error is taken off." : ""}</td></tr>`).join("")}</tbody></table>`);
  part.add(`<h3>Entries</h3><table><tbody>${study.methods.map(m => `<tr><td class="name"><i class="swatch" style="background:${entryColour(m.name)}"></i>${escapeText(m.name)}</td><td class="text"><code>${escapeText(m.module)}</code> ${m.set.map(v => `<code>${escapeText(v)}</code>`).join(" ")}</td></tr>`).join("")}</tbody></table>`);
}

const root = document.documentElement, themeButton = document.querySelector(".theme");
function setTheme(theme) { root.dataset.theme = theme; themeButton.textContent = theme === "dark" ? "Light" : "Dark"; }
setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
themeButton.addEventListener("click", () => setTheme(root.dataset.theme === "dark" ? "light" : "dark"));

if (!swept || study.methods.length <= 12) addTables();
addConvergence();
addSweep();
addFrames();
addPictures();
addBias();
addTimes();
addMethod();
root.dataset.ready = "yes";
