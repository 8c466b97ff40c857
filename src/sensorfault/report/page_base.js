"use strict";
const source = document.getElementById("figures").textContent;
const narrow = matchMedia("(max-width: 700px)");
const touch = matchMedia("(pointer: coarse)");
const dark = matchMedia("(prefers-color-scheme: dark)");

function floats({ f4, from }) {
  const bytes = Uint8Array.from(atob(f4), (c) => c.charCodeAt(0));
  return Float64Array.from(new Float32Array(bytes.buffer), (value) => value + from);
}

function read() {
  const style = getComputedStyle(document.documentElement);
  return JSON.parse(source, (key, value) => {
    if (typeof value?.f4 === "string") return floats(value);
    if (key.endsWith("color") && String(value).startsWith("--")) return style.getPropertyValue(value).trim();
    return value;
  });
}

// What all figures share: the page's colours and letters.
function dress({ layout }) {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  Object.assign(layout, {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", dragmode: touch.matches ? false : "zoom",
    font: { family: style.getPropertyValue("font-family") || "sans-serif", size: 11, color: color("--muted") },
    hoverlabel: { bgcolor: color("--back"), bordercolor: color("--rule"), font: { color: color("--text"), size: 12 } },
  });
  for (const note of layout.annotations ?? []) note.font = { color: color("--text"), size: 12 };
}
