"use strict";
// Pictures, insets, LaTeX, how it was made, and the order of it all.

function addPictures() {
  if (!pictures.length) return;
  const part = section("pictures", "Images", "As the metrics see them: exposure, clamped, sRGB. Drag the line to wipe, drag the picture to pan; double click, <kbd>Ctrl</kbd>+wheel or <kbd>+</kbd> <kbd>-</kbd> zoom all pictures together. On a selected picture <kbd>Space</kbd> flips, <kbd>E</kbd> shows error maps, <kbd>1</kbd>–<kbd>9</kbd> choose, <kbd>0</kbd> fits. <kbd>Shift</kbd>+drag marks a crop and tells its place for an inset strip.");
  for (const set of pictures) new Viewer(part.add("", "card viewer"), set);
}

/** Inset strips: drawn once for paper, shown here as they are. */
function addFigures() {
  if (!figures.length) return;
  const part = section("figures", "Insets", "Chosen crops, as files beside this report too: figures/*.svg and *.png.");
  for (const figure of figures)
    part.add(`<figure class="strip">${figure.svg}<figcaption>${escapeText(figure.caption)}</figcaption></figure>`, "card strips");
}

/** The tables as LaTeX, to copy. */
function addLatex() {
  if (!latex.length) return;
  const part = section("latex", "For the paper", "The tables as LaTeX (package booktabs), as files beside this report too: tables/*.tex.");
  const card = part.add("", "card");
  for (const table of latex) {
    card.insertAdjacentHTML("beforeend", `<details class="latex"><summary>${escapeText(table.title)}<small>tables/${escapeText(table.name)}.tex</small></summary>` +
      `<button class="copy" type="button">Copy</button><pre tabindex="0">${escapeText(table.text)}</pre></details>`);
    const details = card.lastElementChild, button = details.querySelector(".copy");
    button.addEventListener("click", () => {
      const range = document.createRange();
      range.selectNodeContents(details.querySelector("pre"));
      getSelection().removeAllRanges(), getSelection().addRange(range);
      const done = document.execCommand("copy");  // works for a file that is opened from disk, where the newer interface is refused
      button.textContent = done ? "Copied" : "Selected";
      setTimeout(() => { button.textContent = "Copy"; }, 1500);
    });
  }
}

function addMethod() {
  const part = section("method", "How these numbers were made");
  if (results.tuning && results.tuning.length) part.add(`<h3>Tuned parameters</h3><table><thead><tr><th>scene</th><th class="text">entry</th><th>spp</th><th class="text">chosen on frame ${results.tuning[0].frame}, by ${results.tuning[0].metric}</th></tr></thead><tbody>` +
    results.tuning.map(t => `<tr><td>${escapeText(t.scene)}</td><td class="text">${escapeText(t.entry)}</td><td>${t.spp}</td><td class="text">${Object.entries(t.chosen).map(([k, v]) => `${escapeText(k)} = ${escapeText(v)}`).join(", ")} <span class="pm">of ${t.candidates.length} combinations${t.at_end.length ? `; at the end of its values: ${escapeText(t.at_end.join(", "))}` : ""}</span></td></tr>`).join("") + "</tbody></table>");
  const ownMetrics = [...new Set(results.references.flatMap(r => Object.keys(r.own)))];
  const details = [...new Set(results.references.flatMap(r => Object.keys(r.details)))];
  const floors = [...new Set(results.references.flatMap(r => Object.keys(r.floor)))].filter(m => metrics[m]);
  part.add(`<h3>References</h3><table><thead><tr><th>scene</th><th>frame</th><th>spp</th>${floors.map(m => `<th>${metrics[m].title}</th>`).join("")}${ownMetrics.map(m => `<th>its own ${metrics[m].title}</th>`).join("")}${details.map(d => `<th>${escapeText(d.replace(/_/g, " ").replace("hdr flip", "HDR-FLIP"))}</th>`).join("")}</tr></thead><tbody>` +
    results.references.map(r => `<tr><td>${escapeText(r.scene)}</td><td>${r.frame}</td><td>${r.spp}</td>${floors.map(m => `<td>${shown(r.floor[m])}</td>`).join("")}${ownMetrics.map(m => `<td>${shown(r.own[m])}</td>`).join("")}${details.map(d => `<td>${shown(r.details[d])}</td>`).join("")}</tr>`).join("") +
    `</tbody></table><p class="note">A reference is the mean of two halves with independent random numbers; the columns compare one half with the mean. For means of squares that is the reference's own error, which is taken off above; no other number means anything closer to the reference than this.</p>`);
  part.add(`<h3>Metrics</h3><table><tbody>${measured.map(m => `<tr><td class="name">${metricTitle(m)}</td><td class="text">${escapeText(metrics[m].definition)}</td></tr>`).join("")}</tbody></table>`);
  part.add(`<h3>Entries</h3><table><tbody>${study.methods.map(m => `<tr><td class="name"><i class="swatch" style="background:${entryColour(m.name)}"></i>${escapeText(m.name)}</td><td class="text"><code>${escapeText(m.module)}</code> ${m.set.map(v => `<code>${escapeText(v)}</code>`).join(" ")}</td></tr>`).join("")}</tbody></table>`);
}

const root = document.documentElement, themeButton = document.querySelector(".theme");
function setTheme(theme) { root.dataset.theme = theme; themeButton.textContent = theme === "dark" ? "Light" : "Dark"; }
setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
themeButton.addEventListener("click", () => setTheme(root.dataset.theme === "dark" ? "light" : "dark"));

addChecks();
if (!swept || study.methods.length <= 12) addTables();
addConvergence();
addSweep();
addFrames();
addFigures();
addPictures();
addBias();
addAblations();
addTimes();
addLatex();
addMethod();
root.dataset.ready = "yes";
