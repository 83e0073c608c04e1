// SPDX-License-Identifier: Apache-2.0
// A run's curves, drawn by dygraphs: a small chart each, all over env steps.

const drawn = new Map();  // id of a chart -> {chart, graph, labels, box}

const compact = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 4 });
const exact = new Intl.NumberFormat("en", { maximumSignificantDigits: 4 });
const steps = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Rows [x, y of the first series, y of the second, ...]; null where a series has no point at x.
// The rows at 0 and at `end` have no points: they give all charts of a run the same x axis.
function rowsOf(series, end) {
  const rows = new Map([0, end].map((x) => [x, [x, ...series.map(() => null)]]));
  series.forEach((one, i) => {
    for (const [x, y] of one.points) {
      if (!rows.has(x)) rows.set(x, [x, ...series.map(() => null)]);
      rows.get(x)[i + 1] = y;
    }
  });
  return [...rows.values()].sort((a, b) => a[0] - b[0]);
}

const text = (chart, y) => chart.id === "success" ? Math.round(1000 * y) / 10 + " %" : exact.format(y);

// The newest point of each series, or those under the pointer. No HTML is made of what the server
// says: text alone.
function legendOf(chart, data) {
  const parts = document.createDocumentFragment();
  if (data.x !== undefined) parts.append("at " + steps.format(data.x) + " env steps: ");
  data.series.forEach((one, i) => {
    const points = chart().series[i].points;
    const y = data.x === undefined ? points[points.length - 1][1] : one.y;
    if (y === undefined || y === null) return;
    const name = document.createElement("span");
    name.textContent = one.label;
    name.style.color = one.color;
    parts.append(name, " " + text(chart(), y) + " ");
  });
  return parts;
}

function options(chart) {
  const share = chart.id === "success";
  const perSeries = {};
  for (const one of chart.series) {
    if (one.name === "evaluations") perSeries[one.name] = { drawPoints: true, pointSize: 3, strokeWidth: 2 };
  }
  return {
    labels: ["env steps", ...chart.series.map((one) => one.name)],
    colors: [colour("--curve-1"), colour("--curve-2")],
    axisLineColor: colour("--line"),
    gridLineColor: colour("--line"),
    valueRange: share ? [-0.04, 1.05] : null,
    xRangePad: 6,
    includeZero: chart.id.endsWith("_per_second"),
    connectSeparatedPoints: true,
    strokeWidth: 1.5,
    legend: "always",
    legendFormatter: (data) => legendOf(() => drawn.get(chart.id).chart, data),
    axisLabelFontSize: 12,
    axes: {
      x: { axisLabelFormatter: (x) => compact.format(x), pixelsPerLabel: 45 },
      y: {
        axisLabelFormatter: (y) => share ? Math.round(100 * y) + " %" : compact.format(y),
        axisLabelWidth: 52,
      },
    },
    series: perSeries,
  };
}

function makeBox(chart) {
  const box = document.createElement("figure");
  box.dataset.chart = chart.id;
  const title = document.createElement("figcaption");
  title.textContent = chart.title;
  title.title = chart.meaning;
  const legend = document.createElement("div");
  legend.className = "legend";
  const area = document.createElement("div");
  area.className = "chart";
  area.setAttribute("role", "img");
  box.append(title, legend, area);
  return box;
}

// In words, for who cannot see it.
function describe(chart) {
  return chart.title + ": " + chart.series.map((one) => {
    const [x, y] = one.points[one.points.length - 1];
    return one.name + " " + exact.format(y) + " at " + steps.format(x) + " env steps";
  }).join(", ");
}

function draw(chart, end, parent) {
  const rows = rowsOf(chart.series, end);
  let known = drawn.get(chart.id);
  if (!known) {
    const box = makeBox(chart);
    parent.append(box);
    known = { box, graph: null };
    drawn.set(chart.id, known);
  }
  known.chart = chart;
  const area = known.box.querySelector(".chart");
  area.setAttribute("aria-label", describe(chart));
  const labels = chart.series.map((one) => one.name).join();
  if (known.graph && known.labels === labels) {
    known.graph.updateOptions({ file: rows });
    return;
  }
  known.graph?.destroy();
  known.labels = labels;
  known.graph = new Dygraph(area, rows,
    { ...options(chart), labelsDiv: known.box.querySelector(".legend") });
}

export function showCharts(charts, parent) {
  for (const [id, known] of drawn) {
    if (charts.some((chart) => chart.id === id)) continue;
    forget(id, known);
  }
  const ends = charts.flatMap((chart) => chart.series.map((one) => one.points.at(-1)[0]));
  const end = ends.reduce((most, x) => Math.max(most, x), 0);
  for (const chart of charts) draw(chart, end, parent);
}

function forget(id, known) {
  known.graph?.destroy();
  known.box.remove();
  drawn.delete(id);
}

export function forgetCharts() {
  for (const [id, known] of drawn) forget(id, known);
}

// Colours follow the browser's scheme, also when it changes.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  for (const { graph } of drawn.values()) {
    graph?.updateOptions({
      colors: [colour("--curve-1"), colour("--curve-2")],
      axisLineColor: colour("--line"),
      gridLineColor: colour("--line"),
    });
  }
});
