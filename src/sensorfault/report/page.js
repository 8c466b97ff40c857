const drawn = new Map(); // id -> figure
let whole = null;
let shown = null; // from, to [s]

// How many of the rising numbers x lie below a limit.
function rank(x, limit) {
  let [low, high] = [0, x.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < limit) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Of a line, what a screen can show between two times: the least and the greatest value of each of many stretches.
function thin(trace, [from, to]) {
  const { x, y } = trace;
  let [first, last] = [rank(x, from), rank(x, to)];
  if (first > 0 && first < x.length) first -= 1; // the line comes in from the left
  if (last > 0 && last < x.length) last += 1;
  const width = Math.ceil((last - first) / 1500);
  if (width <= 2) return { ...trace, x: x.slice(first, last), y: y.slice(first, last) };
  const kept = [];
  for (let i = first; i < last; i += width) {
    let [low, high, gap] = [i, i, i];
    for (let j = i; j < Math.min(i + width, last); j++) {
      if (Number.isNaN(y[j])) gap = j;
      if (y[j] < y[low] || Number.isNaN(y[low])) low = j;
      if (y[j] > y[high] || Number.isNaN(y[high])) high = j;
    }
    kept.push(...new Set([low, high, gap].sort((a, b) => a - b)));
  }
  return { ...trace, x: kept.map((i) => x[i]), y: kept.map((i) => y[i]) };
}

// Each y axis as high as what is drawn on it between two times.
function fit(layout, data, [from, to]) {
  const spans = {};
  for (const { x, y, yaxis } of data) {
    const name = "yaxis" + yaxis.slice(1);
    const span = (spans[name] ??= { low: Infinity, high: -Infinity });
    y.forEach((value, i) => {
      if (!Number.isFinite(value) || x[i] < from || x[i] > to || (layout[name].type === "log" && value <= 0)) return;
      span.low = Math.min(span.low, value);
      span.high = Math.max(span.high, value);
    });
  }
  for (const [name, { low, high }] of Object.entries(spans)) {
    if (low > high) continue;
    const [a, b] = layout[name].type === "log" ? [Math.log10(low), Math.log10(high)] : [low, high];
    const margin = 0.1 * (b - a) || 0.01 * Math.abs(b) || 1;
    layout[name].range = [a - margin, b + margin];
  }
}

function clock(seconds) {
  const tenths = Math.round(Math.abs(seconds) * 10);
  const [h, m, s] = [Math.floor(tenths / 36000), Math.floor(tenths / 600) % 60, ((tenths % 600) / 10).toFixed(1).padStart(4, "0")];
  return (seconds < 0 ? "-" : "") + (h ? `${h}:${String(m).padStart(2, "0")}:${s}` : `${m}:${s}`);
}

function paint(id, figure) {
  const data = figure.fit ? figure.data.map((trace) => thin(trace, shown)) : figure.data;
  const layout = structuredClone(figure.layout);
  layout.xaxis.range = [...shown];
  if (figure.fit) fit(layout, data, shown);
  return Plotly.react(id, data, layout, { displayModeBar: false, responsive: true, doubleClick: false, showTips: false });
}

function say() {
  document.getElementById("shown").textContent = `${clock(shown[0])} to ${clock(shown[1])} of ${clock(whole[1])}`;
}

function show(from, to) {
  shown = to > from ? [from, to] : whole;
  say();
  for (const [id, figure] of drawn) paint(id, figure);
}

function place(figure) {
  dress(figure);
  Object.assign(figure.layout, {
    showlegend: false, hovermode: figure.layout.hovermode ?? "x unified", hoversubplots: "axis",
    margin: { l: narrow.matches ? 54 : 78, r: 10, t: 4, b: 34 },
  });
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
    say();
    const fresh = !drawn.has(id);
    drawn.set(id, place(figure));
    await paint(id, figure);
    if (fresh) listen(document.getElementById(id));
    await new Promise((done) => setTimeout(done));
  }
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
