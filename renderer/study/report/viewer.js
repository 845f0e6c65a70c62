"use strict";
// Pictures under a wipe, flipped, or side by side, with one zoom for all views of the page.

const view = { scale: 1, x: 0, y: 0, listeners: [] };

/** Keeps the picture over its frame; x and y are shares of the frame's size. */
function setView(scale, x, y) {
  view.scale = Math.min(Math.max(scale, 1), 64);
  view.x = Math.min(0, Math.max(1 - view.scale, x));
  view.y = Math.min(0, Math.max(1 - view.scale, y));
  for (const listener of view.listeners) listener();
}
function zoomAt(factor, px, py) {
  const scale = Math.min(Math.max(view.scale * factor, 1), 64), real = scale / view.scale;
  setView(scale, px - (px - view.x) * real, py - (py - view.y) * real);
}
const placed = image => { image.style.transform = `translate(${view.x * 100}%, ${view.y * 100}%) scale(${view.scale})`; };

class Viewer {
  constructor(root, set) {
    this.set = set, this.wipe = 0.5, this.mode = "wipe", this.flipped = false, this.errors = false;
    const methods = set.images.filter(i => i.kind === "method"), reference = set.images.find(i => i.kind === "reference");
    // Whole methods to begin with; those without a stage are a click away.
    const whole = methods.filter(i => !study.methods.some(m => m.name === i.name && m.stage));
    this.left = (whole[0] || reference).name;
    this.right = (whole.length > 1 ? whole[whole.length - 1] : reference).name;
    root.innerHTML = `
      <div class="bar"><h3>${escapeText(set.scene)}<small>frame ${set.frame} · ${set.spp} spp · ${set.width}×${set.height}</small></h3>
        <select class="left-select" aria-label="Left picture"></select><select class="right-select" aria-label="Right picture"></select>
        <span class="group"><button data-mode="wipe">Wipe</button><button data-mode="flip">Flip</button><button data-mode="pair">Side by side</button></span>
        <button class="errors">Error maps</button><button class="reset">Fit</button>
        <span class="scale" hidden><span class="low"></span><i></i><span class="high"></span></span></div>
      <div class="stage" tabindex="0"><div class="pane a"><img alt=""></div><div class="pane b"><img alt=""></div>
        <div class="divider" role="slider" aria-label="Wipe" tabindex="0"></div><span class="tag left"></span><span class="tag right"></span><div class="mark" hidden></div></div>
      <p class="crop" hidden>Crop for <code>"figures"</code> in the study file: <code class="box" tabindex="0"></code></p>
      <div class="tiles"></div>`;
    this.root = root, this.stage = root.querySelector(".stage"), this.divider = root.querySelector(".divider");
    this.stage.style.aspectRatio = `${set.width} / ${set.height}`;
    for (const select of root.querySelectorAll("select"))
      select.innerHTML = set.images.filter(i => i.kind !== "error").map(i => `<option>${escapeText(i.name)}</option>`).join("");
    this.addTiles();
    this.listen();
    view.listeners.push(() => this.place());
    this.show();
  }

  /** What stands for a name: the picture, or its error map where those are shown. */
  picture(name) {
    const map = this.errors && this.set.images.find(i => i.kind === "error" && i.of === name);
    return map || this.set.images.find(i => i.kind !== "error" && i.name === name);
  }

  addTiles() {
    const tiles = this.root.querySelector(".tiles");
    for (const image of this.set.images.filter(i => i.kind !== "error")) {
      const tile = document.createElement("button");
      tile.className = "tile", tile.dataset.name = image.name, tile.title = "Click: on the right; Shift+click: on the left";
      tile.innerHTML = `<span class="frame" style="aspect-ratio:${this.set.width}/${this.set.height}"><img alt="${escapeText(image.name)}"></span>` +
        `<span class="caption" title="${escapeText(image.name)}">${escapeText(shortName(image.name))}</span>`;
      tile.addEventListener("click", event => { this[event.shiftKey ? "left" : "right"] = image.name; this.show(); });
      tiles.append(tile);
    }
  }

  listen() {
    const { root, stage } = this;
    root.querySelector(".left-select").addEventListener("change", e => { this.left = e.target.value; this.show(); });
    root.querySelector(".right-select").addEventListener("change", e => { this.right = e.target.value; this.show(); });
    for (const button of root.querySelectorAll("[data-mode]"))
      button.addEventListener("click", () => {
        this.flipped = this.mode === "flip" && button.dataset.mode === "flip" && !this.flipped;
        this.mode = button.dataset.mode;
        this.show();
      });
    root.querySelector(".errors").addEventListener("click", () => { this.errors = !this.errors; this.show(); });
    root.querySelector(".reset").addEventListener("click", () => setView(1, 0, 0));
    const place = event => {
      const box = stage.getBoundingClientRect();
      return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height };
    };
    // Plain wheel scrolls the page; with Ctrl (a pinch on touchpads) or on a focused picture it zooms.
    stage.addEventListener("wheel", event => {
      if (!event.ctrlKey && document.activeElement !== stage) return;
      event.preventDefault();
      const at = place(event);
      zoomAt(2 ** (-event.deltaY / 240), at.x, at.y);
    }, { passive: false });
    let drag = null;
    stage.addEventListener("pointerdown", event => {
      drag = { wipe: event.target === this.divider, mark: event.shiftKey && this.mode !== "pair", ...place(event), from: { ...view } };
      stage.setPointerCapture(event.pointerId);
    });
    const follow = event => {
      if (!drag) return;
      const at = place(event);
      if (drag.mark) this.markCrop(drag, at);
      else if (drag.wipe) { this.wipe = Math.min(Math.max(at.x, 0), 1); this.place(); }
      else setView(view.scale, drag.from.x + at.x - drag.x, drag.from.y + at.y - drag.y);
    };
    stage.addEventListener("dragstart", event => event.preventDefault());
    stage.addEventListener("pointermove", follow);
    stage.addEventListener("pointerup", event => { follow(event); drag = null; });
    stage.addEventListener("pointercancel", () => { drag = null; });
    stage.addEventListener("dblclick", event => { const at = place(event); view.scale > 1 ? setView(1, 0, 0) : zoomAt(4, at.x, at.y); });
    stage.addEventListener("keydown", event => this.key(event));
  }

  /** A box on the picture, as a figure of the study file names it: shares of the whole picture. */
  markCrop(from, to) {
    const inside = v => Math.min(Math.max(v, 0), 1), shares = p => [inside((p.x - view.x) / view.scale), inside((p.y - view.y) / view.scale)];
    const [x0, y0] = shares(from), [x1, y1] = shares(to);
    this.crop = { x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) };
    if (this.crop.width * this.set.width < 2 || this.crop.height * this.set.height < 2) this.crop = null;
    this.place();
  }

  placeCrop() {
    const { root, crop } = this, mark = root.querySelector(".mark"), line = root.querySelector(".crop");
    mark.hidden = line.hidden = !crop || this.mode === "pair";
    if (!crop) return;
    mark.style.left = `${100 * (view.x + crop.x * view.scale)}%`, mark.style.top = `${100 * (view.y + crop.y * view.scale)}%`;
    mark.style.width = `${100 * crop.width * view.scale}%`, mark.style.height = `${100 * crop.height * view.scale}%`;
    const box = [crop.x, crop.y, crop.width, crop.height].map(v => Number(v.toFixed(4)));
    line.querySelector(".box").textContent = `{"scene": "${this.set.scene}", "frame": ${this.set.frame}, "spp": ${this.set.spp}, "crops": [{"box": [${box.join(", ")}]}]}`;
  }

  key(event) {
    const names = this.set.images.filter(i => i.kind !== "error").map(i => i.name);
    if (event.key === " ") { this.mode = "flip"; this.flipped = !this.flipped; }
    else if (event.key === "e") this.errors = !this.errors;
    else if (event.key === "0") setView(1, 0, 0);
    else if (event.key === "+" || event.key === "-") zoomAt(event.key === "+" ? 1.5 : 1 / 1.5, 0.5, 0.5);
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight")
      this.wipe = Math.min(Math.max(this.wipe + (event.key === "ArrowLeft" ? -0.02 : 0.02), 0), 1);
    else if (/^[1-9]$/.test(event.key) && names[event.key - 1]) this.right = names[event.key - 1];
    else return;
    event.preventDefault();
    this.show();
  }

  show() {
    const { root } = this, left = this.picture(this.left), right = this.picture(this.right);
    root.querySelector(".a img").src = left.png, root.querySelector(".b img").src = right.png;
    root.querySelector(".tag.left").textContent = left.title || left.name;
    root.querySelector(".tag.right").textContent = right.title || right.name;
    root.querySelector(".left-select").value = this.left, root.querySelector(".right-select").value = this.right;
    for (const button of root.querySelectorAll("[data-mode]")) button.setAttribute("aria-pressed", button.dataset.mode === this.mode);
    root.querySelector(".errors").setAttribute("aria-pressed", this.errors);
    for (const tile of root.querySelectorAll(".tile")) {
      const name = tile.dataset.name;
      tile.querySelector("img").src = this.picture(name).png;
      tile.dataset.side = `${name === this.left ? "left" : ""} ${name === this.right ? "right" : ""}`;
    }
    const scale = root.querySelector(".scale"), map = this.set.error_map;
    scale.hidden = !this.errors;
    scale.querySelector(".low").textContent = shown(map.low, 2), scale.querySelector(".high").textContent = `${shown(map.high, 2)} ${map.title}`;
    scale.querySelector("i").style.background = `linear-gradient(90deg, ${map.colours.join(", ")})`;
    this.place();
  }

  place() {
    this.placeCrop();
    const { root, mode } = this, a = root.querySelector(".pane.a"), b = root.querySelector(".pane.b");
    // Enlarged pixels stay squares: what is between them was never computed.
    root.classList.toggle("pixels", this.stage.clientWidth * view.scale >= 1.5 * this.set.width);
    for (const image of root.querySelectorAll("img")) placed(image);
    this.divider.hidden = mode === "flip", this.divider.style.display = mode === "wipe" ? "" : "none";
    this.divider.style.left = `${this.wipe * 100}%`, this.divider.setAttribute("aria-valuenow", Math.round(this.wipe * 100));
    a.style.cssText = b.style.cssText = "";
    const leftTag = root.querySelector(".tag.left"), rightTag = root.querySelector(".tag.right");
    leftTag.hidden = rightTag.hidden = false;
    this.stage.style.aspectRatio = `${this.set.width * (mode === "pair" ? 2 : 1)} / ${this.set.height}`;
    if (mode === "wipe") b.style.clipPath = `inset(0 0 0 ${this.wipe * 100}%)`;
    else if (mode === "pair") a.style.right = "50%", b.style.left = "50%";
    else {
      (this.flipped ? a : b).style.visibility = "hidden";
      (this.flipped ? leftTag : rightTag).hidden = true;
    }
  }
}
