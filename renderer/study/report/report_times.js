"use strict";
// What errors consist of, what time they take, and what each stage is worth.

const entryCell = name => `<td class="name"><i class="swatch" style="background:${entryColour(name)}"></i>${nameMarkup(name)}</td>`;

function addBias() {
  const rows = results.bias_and_variance.filter(r => r.seeds > 1);
  if (!rows.length) return;
  const left = rows.some(r => r.pixels_left_out > 0);
  const part = section("bias", "Bias and variance", "Mean squared error of the linear image in two parts: what stays however many seeds are averaged, and what averages away. The reference's own noise is taken off; a bias that is not told from 0 has an interval that holds 0. What all seeds share counts as bias." +
    (seedCount < 3 ? " Their intervals need three seeds." : "") + (left ? " Pixels that are not finite in every seed and the reference are left out." : ""));
  for (const scene of scenes.filter(s => s !== "all")) {
    const own = rows.filter(r => r.scene === scene);
    part.add(`<h3>${escapeText(scene)}</h3><table><thead><tr><th></th><th>spp</th><th>MSE</th><th>bias²</th><th>variance</th><th>share of bias</th>${left ? "<th>pixels left out</th>" : ""}</tr></thead><tbody>` +
      own.map(r => {
        const share = r.share_of_bias, percent = v => `${Math.round(100 * v)}`;
        return `<tr>${entryCell(r.entry)}<td>${r.spp}</td><td>${interval(r.mse)}</td><td>${interval(r.squared_bias)}</td><td>${interval(r.variance)}</td>` +
          `<td>${share.mean === null ? "–" : `${percent(share.mean).replace("-", "−")} %<span class="pm">${half(share) === null ? "" : `± ${percent(half(share))}`}</span>`}</td>` +
          `${left ? `<td>${r.pixels_left_out} of ${r.pixels + r.pixels_left_out}</td>` : ""}</tr>`;
      }).join("") + "</tbody></table>");
  }
}

/** A row a stage: every metric without it against the whole method, and the time. */
function addAblations() {
  if (!results.ablations || !results.ablations.length) return;
  const apart = study.methods.filter(m => m.apart).map(m => m.name);
  const samples = apart.length ? ` on the same samples (but ${escapeText(apart.join(", "))}: traced with samples of its own)` : " on the same samples";
  const part = section("ablations", "What each stage is worth", "Each stage switched off in turn, against the whole method" + samples + ": differences of the metrics and of a frame's time" +
    (seedCount > 1 ? ", with intervals over the seeds. Bold ones are told from none." : ". With one seed nothing is known of the noise."));
  for (const scene of scenes) for (const spp of sampleCounts) {
    const own = results.ablations.filter(a => a.scene === scene && a.spp === spp);
    if (!own.length) continue;
    const names = [...new Set(own.map(a => a.metric))], stages = [...new Set(own.map(a => `${a.entry}\n${a.stage}`))];
    const timed = times.ablations.filter(a => a.scene === scene && a.spp === spp);
    part.add(`<h3>${escapeText(sceneTitle(scene))}${sampleCounts.length > 1 ? ` · ${spp} spp` : ""}</h3><table><thead><tr><th>method</th><th class="text">without</th>` +
      names.map(m => `<th>Δ ${metricTitle(m)}</th>`).join("") + `${timed.length ? "<th>Δ ms a frame</th>" : ""}</tr></thead><tbody>` +
      stages.map(key => {
        const [entry, stage] = key.split("\n"), time = find(timed, { entry, stage });
        return `<tr>${entryCell(entry)}<td class="text">${escapeText(stage)}</td>` + names.map(m => {
          const effect = find(own, { entry, stage, metric: m });
          const worse = isSure(effect.difference) && (effect.difference.mean > 0) !== metrics[m].higher;
          const part = effect.whole.mean ? Math.round(100 * effect.difference.mean / Math.abs(effect.whole.mean)) : null;
          return `<td class="${worse ? "worse" : ""}">${difference(effect.difference)}${part === null || !Number.isFinite(part) ? "" : `<span class="share">${part > 0 ? "+" : ""}${String(part).replace("-", "−")} %</span>`}</td>`;
        }).join("") + `${timed.length ? `<td>${time ? difference(time.difference_ms) : "–"}</td>` : ""}</tr>`;
      }).join("") + "</tbody></table>");
  }
}

/** What no stage accounts for is grey. */
const phaseColour = (phases, i) => i === phases.length - 1 ? "var(--line)" : colourOf(i);

function timeBars(scene) {
  const own = times.rows.filter(r => r.scene === scene), phases = ["pose", "build", "trace", ...new Set(own.flatMap(r => Object.keys(r.stages_ms))), "rest of the method"];
  const several = own.some(o => o.spp !== own[0].spp);
  const rows = own.slice(0, 40).map(r => {
    const staged = Object.values(r.stages_ms).reduce((sum, s) => sum + s.mean, 0);
    const value = p => p === "pose" ? r.pose_ms.mean : p === "build" ? r.build_ms.mean : p === "trace" ? r.trace_ms.mean : p === "rest of the method" ? Math.max(r.run_ms.mean - staged, 0) : r.stages_ms[p] ? r.stages_ms[p].mean : 0;
    return { name: several ? `${shortName(r.entry)}, ${r.spp} spp` : shortName(r.entry), parts: phases.map((p, i) => ({ name: p, value: value(p), colour: phaseColour(phases, i) })),
             note: half(r.frame_ms) === null ? "" : `± ${shownHalf(half(r.frame_ms), r.frame_ms.mean, 3)}` };
  });
  return `<figure><figcaption>${escapeText(scene)}<small>milliseconds a frame; methods that share their samples share one trace, of all signals that any of them reads</small></figcaption>${barChart({ rows, unit: "ms" })}` +
    `${legend(phases.map((name, i) => ({ name, colour: phaseColour(phases, i) })))}</figure>`;
}

/** Every phase with its interval. */
function timeTable(scene) {
  const own = times.rows.filter(r => r.scene === scene), stages = [...new Set(own.flatMap(r => Object.keys(r.stages_ms)))];
  return `<details><summary>Every stage, with intervals</summary><table><thead><tr><th></th><th>spp</th><th>frame</th><th>pose</th><th>build</th><th>trace</th><th>method</th>` +
    stages.map(s => `<th>${escapeText(s)}</th>`).join("") + `<th>rays a frame</th><th>ns a ray, whole frame</th>${own.some(r => r.tracing_ns_per_ray) ? "<th>ns a ray, tracing alone</th>" : ""}</tr></thead><tbody>` +
    own.map(r => `<tr>${entryCell(r.entry)}<td>${r.spp}</td>` + [r.frame_ms, r.pose_ms, r.build_ms, r.trace_ms, r.run_ms, ...stages.map(s => r.stages_ms[s])].map(t => `<td>${t ? interval(t) : "–"}</td>`).join("") +
      `<td>${Math.round(r.rays_per_frame.mean).toLocaleString("en")}</td>${[r.ns_per_ray, r.tracing_ns_per_ray].map(t => t ? `<td>${t.count ? interval(t) : "–"}</td>` : "").join("")}</tr>`).join("") + "</tbody></table></details>";
}

/** A table for each pair and scene: what the other reaches in the method's time, and when it reaches its value. */
function addPairs(part) {
  const reached = (r, unit) => r.count ? interval(r, unit) + ofSeeds(r) : `<span class="pm">out of range</span>`;
  const tables = [...new Set(times.pairs.map(p => `${p.scene}\n${p.entry}\n${p.against}`))].map(key => {
    const [scene, entry, against] = key.split("\n"), own = times.pairs.filter(p => p.scene === scene && p.entry === entry && p.against === against);
    return `<h3><i class="swatch" style="background:${entryColour(entry)}"></i>${escapeText(entry)} against <i class="swatch" style="background:${entryColour(against)}"></i>${escapeText(against)}<small>${escapeText(scene)}</small></h3>` +
      `<table><thead><tr><th>metric</th><th>spp</th><th>a frame</th><th>its value</th><th>the other's at equal time</th><th>difference</th><th>time for equal value</th><th>times as long</th></tr></thead><tbody>` +
      own.map(p => `<tr><td>${metrics[p.metric].title}</td><td>${p.spp}</td><td>${interval(p.frame_ms, " ms")}</td><td>${interval(p.value)}</td><td>${reached(p.against_at_equal_time)}</td>` +
        `<td>${p.against_at_equal_time.count ? difference(p.difference_at_equal_time) : "–"}</td><td>${reached(p.against_ms_at_equal_value, " ms")}</td>` +
        `<td>${p.against_ms_at_equal_value.count ? interval(p.times_as_long) : "–"}</td></tr>`).join("") + "</tbody></table>";
  });
  part.add(`<h3>Equal time and equal error</h3>${tables.join("")}<p class="note">Between the other's sample counts, seed by seed, by straight lines in log-log space. Differences in bold are told from none.</p>`);
}

function addTimes() {
  if (!times.rows.length) return;
  const part = section("times", "Times", "Wall-clock medians of a frame on the machine that ran the study: posing, tracing, then the method's stages. They differ from run to run; nothing else in this report does.");
  for (const scene of scenes.filter(s => s !== "all")) part.add(timeBars(scene) + timeTable(scene));
  if (times.pairs.length) addPairs(part);
  if (results.equivalent_samples) part.add(`<h3>Equivalent samples</h3><table><thead><tr><th>method</th><th class="text">scene</th><th>spp</th><th class="text">metric</th><th class="text">is worth</th><th>samples</th></tr></thead><tbody>` +
    results.equivalent_samples.map(e => `<tr>${entryCell(e.entry)}<td class="text">${escapeText(e.scene)}</td><td>${e.spp}</td><td class="text">${metrics[e.metric].title}</td><td class="text">${escapeText(e.against)} at</td>` +
      `<td>${interval(e.equivalent_spp)}${ofSeeds(e.equivalent_spp)}${e.extrapolated ? `<span class="pm">extrapolated</span>` : ""}</td></tr>`).join("") + "</tbody></table>");
}
