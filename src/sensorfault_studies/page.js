const HEIGHT = 380;

// A figure may leave colours, letters and margins to the page.
function place({ data, layout = {} }) {
  const figure = { data, layout };
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  dress(figure);
  delete layout.title; // it stands above the plot
  delete layout.template;
  delete layout.width;
  Object.assign(layout, {
    colorway: [1, 2, 3, 4, 5, 6, 7, 8].map((i) => color(`--c${i}`)),
    height: layout.height ?? HEIGHT,
    margin: { l: 8, r: 8, t: 8, b: 8 },
    hovermode: layout.hovermode ?? "closest",
    showlegend: data.length > 1,
    legend: { orientation: "h", x: 0, y: -0.22, yanchor: "top", bgcolor: "rgba(0,0,0,0)", font: { size: 12, color: color("--text") } },
  });
  for (const { line } of layout.shapes ?? []) if (line) line.color ??= color("--muted");
  layout.xaxis ??= {};
  layout.yaxis ??= {};
  for (const [name, axis] of Object.entries(layout)) {
    if (!/^[xy]axis\d*$/.test(name)) continue;
    Object.assign(axis, { gridcolor: color("--grid"), zerolinecolor: color("--rule"), linecolor: color("--rule"), automargin: true });
  }
  return figure;
}

async function draw() {
  for (const [id, figure] of Object.entries(read())) {
    const { data, layout } = place(figure);
    await Plotly.react(id, data, layout, { displayModeBar: false, responsive: true, showTips: false });
    await new Promise((done) => setTimeout(done));
  }
}

dark.addEventListener("change", draw);
draw();
