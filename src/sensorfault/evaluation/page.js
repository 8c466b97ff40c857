"use strict";
const source = document.getElementById("figures").textContent;
const narrow = matchMedia("(max-width: 700px)");
const touch = matchMedia("(pointer: coarse)");
const dark = matchMedia("(prefers-color-scheme: dark)");
const drawn = new Map(); // id -> figure
let whole = null;
let shown = null; // from, to [s]

function floats(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Float64Array(bytes.buffer);
}

function read() {
  const style = getComputedStyle(document.documentElement);
  return JSON.parse(source, (key, value) => {
    if (typeof value?.f8 === "string") return floats(value.f8);
    if (key.endsWith("color") && String(value).startsWith("--")) return style.getPropertyValue(value).trim();
    return value;
  });
}

// The y axes that show all that lies between two times, and little else.
function heights(figure, [from, to]) {
  const spans = {};
  for (const { x, y, yaxis } of figure.fit ? figure.data : []) {
    const log = figure.layout["yaxis" + yaxis.slice(1)].type === "log";
    const span = (spans["yaxis" + yaxis.slice(1)] ??= { low: Infinity, high: -Infinity, log });
    for (let i = 0; i < x.length; i++) {
      if (!(x[Math.min(i + 1, x.length - 1)] >= from && x[Math.max(i - 1, 0)] <= to)) continue;
      if (!Number.isFinite(y[i]) || (log && y[i] <= 0)) continue;
      span.low = Math.min(span.low, y[i]);
      span.high = Math.max(span.high, y[i]);
    }
  }
  const change = {};
  for (const [axis, { low, high, log }] of Object.entries(spans)) {
    if (low > high) continue;
    const [a, b] = log ? [Math.log10(low), Math.log10(high)] : [low, high];
    const margin = 0.1 * (b - a) || 0.01 * Math.abs(b) || 1;
    change[axis + ".range"] = [a - margin, b + margin];
  }
  return change;
}

function clock(seconds) {
  const tenths = Math.round(Math.abs(seconds) * 10);
  const [h, m, s] = [Math.floor(tenths / 36000), Math.floor(tenths / 600) % 60, ((tenths % 600) / 10).toFixed(1).padStart(4, "0")];
  return (seconds < 0 ? "−" : "") + (h ? `${h}:${String(m).padStart(2, "0")}:${s}` : `${m}:${s}`);
}

function show(from, to) {
  shown = to > from ? [from, to] : whole;
  document.getElementById("shown").textContent = `${clock(shown[0])} to ${clock(shown[1])} of ${clock(whole[1])}`;
  for (const [id, figure] of drawn) Plotly.relayout(id, { "xaxis.range": [...shown], ...heights(figure, shown) });
}

function dress(figure) {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  const { layout } = figure;
  Object.assign(layout, {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", showlegend: false, dragmode: touch.matches ? false : "zoom",
    margin: { l: narrow.matches ? 54 : 78, r: 10, t: 4, b: 34 }, hovermode: layout.hovermode ?? "x unified", hoversubplots: "axis",
    font: { family: style.getPropertyValue("font-family") || "sans-serif", size: 11, color: color("--muted") },
    hoverlabel: { bgcolor: color("--back"), bordercolor: color("--rule"), font: { color: color("--text"), size: 12 } },
  });
  for (const note of layout.annotations ?? []) note.font = { color: color("--text"), size: 12 };
  layout.xaxis.range = [...shown];
  for (const [axis, range] of Object.entries(heights(figure, shown))) layout[axis.split(".")[0]].range = range;
  return figure;
}

function listen(plot) {
  plot.on("plotly_relayout", (change) => {
    if ("xaxis.range[0]" in change) show(change["xaxis.range[0]"], change["xaxis.range[1]"]);
  });
  plot.on("plotly_doubleclick", () => show(...whole));
}

// One figure after the other, so that the top of the page is there at once.
async function draw() {
  for (const [id, figure] of Object.entries(read())) {
    whole ??= [...figure.layout.xaxis.range];
    shown ??= whole;
    const fresh = !drawn.has(id);
    drawn.set(id, dress(figure));
    await Plotly.react(id, figure.data, figure.layout, { displayModeBar: false, responsive: true, doubleClick: false });
    if (fresh) listen(document.getElementById(id));
    await new Promise((done) => setTimeout(done));
  }
  show(...shown);
}

function visit(row) {
  const [from, to] = [Number(row.dataset.from), Number(row.dataset.to)];
  const margin = Math.max(2, 0.5 * (to - from));
  show(Math.max(whole[0], from - margin), Math.min(whole[1], to + margin));
}

for (const row of document.querySelectorAll("tr[data-from]")) {
  row.addEventListener("click", () => visit(row));
  row.addEventListener("keydown", (event) => event.key === "Enter" && visit(row));
}
document.getElementById("all").addEventListener("click", () => show(...whole));
dark.addEventListener("change", draw);
draw();
