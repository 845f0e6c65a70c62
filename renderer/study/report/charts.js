"use strict";
// Plots as SVG text. Every function returns markup; colours are the page's own variables.

const kColours = 8;
const colourOf = index => `var(--c${index % kColours})`;
const escapeText = text => String(text).replace(/[&<>"]/g, c => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

/** A number with as many digits as a reader needs. */
function shown(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const raised = String(Number(exponent)).replace(/[-0-9]/g, c => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
    return `${mantissa}·10${raised}`.replace("-", "−");
  }
  return value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size)))).replace("-", "−");
}

/** A half-width with as many decimals as its number has, or as it takes to see it. */
function shownHalf(half, mean, digits = 4) {
  const decimals = (shown(mean, digits).split(".")[1] || "").length;
  const text = Math.abs(mean) >= 1e-3 && Math.abs(mean) < 1e5 ? half.toFixed(decimals) : "0";
  return Number(text) === 0 ? shown(half, 1) : text;
}

/** Positions of ticks and a map from values to pixels. */
function axisScale(values, log, from, to, includeZero = false) {
  let low = Math.min(...values), high = Math.max(...values);
  if (log) {
    low = Math.log10(low), high = Math.log10(high);
    const margin = Math.max((high - low) * 0.06, 0.05);
    low -= margin, high += margin;
    const at = v => from + (to - from) * (Math.log10(v) - low) / (high - low);
    const ticks = [];
    for (let power = Math.floor(low) - 1; power <= Math.ceil(high); ++power)
      for (const digit of high - low < 1.4 ? [1, 2, 5] : [1]) {
        const value = digit * 10 ** power, place = Math.log10(value);
        if (place >= low - 1e-9 && place <= high + 1e-9) ticks.push(value);
      }
    return { at, ticks };
  }
  if (includeZero) low = Math.min(0, low);
  if (high === low) high = low + (Math.abs(low) || 1);
  const margin = (high - low) * 0.06;
  if (!(includeZero && low === 0)) low -= margin;
  high += margin;
  const at = v => from + (to - from) * (v - low) / (high - low);
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find(f => f * power >= raw) * power;
  const ticks = [];
  for (let value = Math.ceil(low / step) * step; value <= high + step * 1e-6; value += step) ticks.push(Math.abs(value) < step * 1e-6 ? 0 : value);
  return { at, ticks };
}

/** Lines with intervals. series: [{name, colour, points: [{x, y, low, high}]}]; guide: slope of a dashed line in log-log. */
function lineChart({ series, xLabel, yLabel, xLog, yLog, xTicks, xWhole, guide, height = 290 }) {
  const width = 520, box = { left: 62, right: width - 12, top: 14, bottom: height - 44 };
  const usable = p => Number.isFinite(p.y) && (!yLog || p.y > 0);
  const points = series.flatMap(s => s.points).filter(usable);
  if (!points.length) return "";
  const ends = points.flatMap(p => [p.low, p.high].filter(v => Number.isFinite(v) && (!yLog || v > 0)));
  const x = axisScale(points.map(p => p.x), xLog, box.left, box.right);
  const y = axisScale(points.map(p => p.y).concat(ends), yLog, box.bottom, box.top);
  let out = "";
  for (const tick of y.ticks)
    out += `<line class="grid" x1="${box.left}" x2="${box.right}" y1="${y.at(tick)}" y2="${y.at(tick)}"/>` +
      `<text x="${box.left - 8}" y="${y.at(tick) + 4}" text-anchor="end">${shown(tick, 2)}</text>`;
  for (const tick of xTicks || (xWhole ? x.ticks.filter(Number.isInteger) : x.ticks))
    out += `<line class="axis" x1="${x.at(tick)}" x2="${x.at(tick)}" y1="${box.bottom}" y2="${box.bottom + 4}"/>` +
      `<text x="${x.at(tick)}" y="${box.bottom + 18}" text-anchor="middle">${Number.isInteger(tick) ? tick : shown(tick, 2)}</text>`;
  out += `<line class="axis" x1="${box.left}" x2="${box.right}" y1="${box.bottom}" y2="${box.bottom}"/>` +
    `<text class="label" x="${(box.left + box.right) / 2}" y="${height - 6}" text-anchor="middle">${escapeText(xLabel)}</text>` +
    `<text class="label" x="${box.left}" y="${4}" text-anchor="start">${escapeText(yLabel)}</text>`;
  if (guide && points.length > 1) {
    const first = points.reduce((a, b) => (b.x < a.x || (b.x === a.x && b.y > a.y) ? b : a)), last = Math.max(...points.map(p => p.x));
    const end = first.y * (last / first.x) ** guide.slope;
    out += `<clipPath id="clip${++lineChart.count}"><rect x="${box.left}" y="${box.top - 8}" width="${box.right - box.left}" ` +
      `height="${box.bottom - box.top + 8}"/></clipPath><g clip-path="url(#clip${lineChart.count})"><path class="guide" ` +
      `d="M${x.at(first.x)} ${y.at(first.y)}L${x.at(last)} ${y.at(end)}"/></g>`;
  }
  series.forEach(({ points: own, colour, name }, index) => {
    const aside = (index - (series.length - 1) / 2) * Math.min(3, 24 / series.length);  // so that intervals do not hide each other
    const good = own.filter(usable);
    out += `<path fill="none" stroke="${colour}" stroke-width="2" stroke-linejoin="round" d="${good.map((p, i) =>
      `${i ? "L" : "M"}${x.at(p.x).toFixed(1)} ${y.at(p.y).toFixed(1)}`).join("")}"/>`;
    for (const p of good) {
      if (Number.isFinite(p.low) && Number.isFinite(p.high) && (!yLog || p.low > 0))
        out += `<line stroke="${colour}" stroke-opacity=".55" stroke-width="1.5" x1="${x.at(p.x) + aside}" x2="${x.at(p.x) + aside}" y1="${y.at(p.low)}" y2="${y.at(p.high)}"/>`;
      if (good.length <= 40)
        out += `<circle cx="${x.at(p.x)}" cy="${y.at(p.y)}" r="3.2" fill="${colour}"><title>${escapeText(name)}: ${shown(p.y, 4)} at ${p.x}</title></circle>`;
    }
  });
  return `<svg viewBox="0 -8 ${width} ${height + 8}" role="img">${out}</svg>`;
}
lineChart.count = 0;

/** A method's name without the ids of what is swept: "svgf [4, true]". */
const shortName = name => name.replace(/\[.*\]/, part => part.replace(/[\w.-]+=/g, ""));

/** The name in full, or short where the page is narrow. */
const nameMarkup = name => shortName(name) === name ? escapeText(name)
  : `<span class="wide">${escapeText(name)}</span><span class="narrow" title="${escapeText(name)}">${escapeText(shortName(name))}</span>`;

/** Horizontal stacked bars. rows: [{name, parts: [{name, value, colour}], note}]. */
function barChart({ rows, unit }) {
  const width = 1040, rowHeight = 30, left = 20 + 7.3 * Math.max(...rows.map(r => Math.min(r.name.length, 44))), right = width - 120;
  const total = row => row.parts.reduce((sum, p) => sum + Math.max(p.value, 0), 0);
  const most = Math.max(...rows.map(total), 1e-9);
  const x = axisScale([0, most], false, left, right, true);
  const height = rows.length * rowHeight + 26;
  let out = "";
  for (const tick of x.ticks)
    out += `<line class="grid" x1="${x.at(tick)}" x2="${x.at(tick)}" y1="2" y2="${height - 22}"/>` +
      `<text x="${x.at(tick)}" y="${height - 6}" text-anchor="middle">${shown(tick, 2)}</text>`;
  rows.forEach((row, i) => {
    const y = i * rowHeight + 5;
    let at = 0;
    out += `<text class="label" x="${left - 10}" y="${y + 14}" text-anchor="end">${escapeText(row.name.length > 44 ? row.name.slice(0, 43) + "…" : row.name)}<title>${escapeText(row.name)}</title></text>`;
    for (const part of row.parts) {
      const value = Math.max(part.value, 0);
      out += `<rect x="${x.at(at)}" y="${y}" width="${Math.max(x.at(at + value) - x.at(at), 0)}" height="20" rx="2" fill="${part.colour}">` +
        `<title>${escapeText(part.name)}: ${shown(part.value)} ${unit}</title></rect>`;
      at += value;
    }
    out += `<text x="${x.at(at) + 8}" y="${y + 14}">${shown(total(row))} ${unit}${row.note ? " " + escapeText(row.note) : ""}</text>`;
  });
  return `<svg viewBox="0 0 ${width} ${height}" role="img">${out}</svg>`;
}

/** The viridis map, at eleven places. */
const kViridis = ["#440154", "#482475", "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151", "#bddf26", "#fde725"];
function viridis(t) {
  const place = Math.min(Math.max(t, 0), 1) * 10, index = Math.min(Math.floor(place), 9), part = place - index;
  const channel = k => Math.round(parseInt(kViridis[index].slice(k, k + 2), 16) * (1 - part) + parseInt(kViridis[index + 1].slice(k, k + 2), 16) * part);
  return { colour: `rgb(${channel(1)} ${channel(3)} ${channel(5)})`, dark: t < 0.62 };
}

/** A table of coloured cells. value(i, j) gives {mean, half, best}: may it be the best? Columns vary with the first axis. */
function heatMap({ columns, rows, columnLabel, rowLabel, value }) {
  const cell = { width: Math.max(64, Math.min(120, 860 / columns.length)), height: 40 };
  const left = 18 + 7.2 * Math.max(...rows.map(r => String(r).length), rowLabel.length), top = 44;
  const cells = rows.map((_, j) => columns.map((_, i) => value(i, j)));
  const means = cells.flat().map(c => c.mean).filter(Number.isFinite);
  const low = Math.min(...means), high = Math.max(...means);
  const useLog = low > 0 && high / low > 8;
  const part = v => high === low ? 0.5 : useLog ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
  let out = `<text class="label" x="${left + columns.length * cell.width / 2}" y="12" text-anchor="middle">${escapeText(columnLabel)}</text>` +
    `<text class="label" x="${left - 10}" y="${top - 10}" text-anchor="end">${escapeText(rowLabel)}</text>`;
  columns.forEach((name, i) => { out += `<text x="${left + (i + .5) * cell.width}" y="${top - 10}" text-anchor="middle">${escapeText(name)}</text>`; });
  rows.forEach((name, j) => {
    out += `<text x="${left - 10}" y="${top + (j + .5) * cell.height + 4}" text-anchor="end">${escapeText(name)}</text>`;
    columns.forEach((_, i) => {
      const { mean, half, best } = cells[j][i];
      if (!Number.isFinite(mean)) return;
      const { colour, dark } = viridis(part(mean)), x = left + i * cell.width, y = top + j * cell.height;
      out += `<rect x="${x + 1}" y="${y + 1}" width="${cell.width - 2}" height="${cell.height - 2}" rx="4" fill="${colour}" ` +
        `${best ? 'stroke="var(--ink)" stroke-width="2.5"' : ""}/>` +
        `<text class="${dark ? "on-dark" : "on-light"}" x="${x + cell.width / 2}" y="${y + (half ? 18 : 24)}" text-anchor="middle">${shown(mean)}</text>`;
      if (half) out += `<text class="${dark ? "on-dark" : "on-light"}" style="font-size:9.5px;opacity:.85" x="${x + cell.width / 2}" y="${y + 31}" text-anchor="middle">± ${shown(half, 2)}</text>`;
    });
  });
  const width = left + columns.length * cell.width + 4;
  return `<svg viewBox="0 0 ${width} ${top + rows.length * cell.height + 4}" style="max-width:${width}px" role="img">${out}</svg>`;
}

const legend = items => `<div class="legend">${items.map(i => `<span><i class="swatch" style="background:${i.colour}"></i>${escapeText(i.name)}</span>`).join("")}</div>`;
