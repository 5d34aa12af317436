// Curves and maps, drawn by Chart.js (the global Chart of /chart.js).

import {colour, number, onTheme} from "./dom.js";

/** Viridis (van der Walt & Smith 2015) at nine places, for values from low (0) to high (1). */
const kViridis = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"];
export function sequential(part) {
  const at = Math.min(Math.max(part, 0), 1) * (kViridis.length - 1), i = Math.min(Math.floor(at), kViridis.length - 2);
  const mix = (from, to) => Math.round(from + (at - i) * (to - from));
  const channels = [1, 3, 5].map((k) => mix(parseInt(kViridis[i].slice(k, k + 2), 16), parseInt(kViridis[i + 1].slice(k, k + 2), 16)));
  return `rgb(${channels.join(" ")})`;
}

const faint = () => colour("faint"), grid = () => colour("line");  // as they are when it is drawn
const axis = (text, more = {}) => ({type: "linear", title: {display: true, text, color: faint},
                                    ticks: {color: faint, maxTicksLimit: 7, includeBounds: false}, grid: {color: grid}, ...more});

const common = {animation: false, responsive: true, maintainAspectRatio: false, normalized: true,
                plugins: {legend: {display: false}, tooltip: {enabled: false}}};

/** A line across the chart at `chart.markedX`. */
const markedX = {
  id: "markedX",
  afterDatasetsDraw(chart) {
    const {ctx, chartArea: {top, bottom, left, right}, scales: {x}} = chart, at = x.getPixelForValue(chart.markedX);
    if (!Number.isFinite(chart.markedX) || at < left - 1 || at > right + 1) return;
    ctx.strokeStyle = colour("warm");
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    ctx.moveTo(at, top);
    ctx.lineTo(at, bottom);
    ctx.stroke();
  },
};

/** One curve, that is given anew as a whole. */
export class Curve {
  constructor(canvas, xTitle, yTitle, yRange = {}) {
    this.chart = new Chart(canvas, {
      type: "line",
      plugins: [markedX],
      data: {datasets: [{data: [], borderColor: () => colour("accent"), borderWidth: 1.5, pointRadius: 0, tension: 0}]},
      options: {...common, parsing: false, scales: {x: axis(xTitle), y: axis(yTitle, yRange)},
                interaction: {mode: "nearest", axis: "x", intersect: false},
                plugins: {legend: {display: false}, tooltip: {displayColors: false, callbacks: {
                  title: () => "", label: ({raw: {x, y}}) => [`${xTitle}: ${number(x)}`, `${yTitle}: ${number(y)}`]}}}},
    });
    onTheme(() => this.chart.update("none"));
  }

  /** Points of more than `most` are thinned: a screen shows no more. */
  set(xs, ys, most = 1500) {
    const step = Math.max(1, Math.ceil(xs.length / most));
    const points = [];
    for (let i = 0; i < xs.length; i += step) {
      if (Number.isFinite(xs[i]) && Number.isFinite(ys[i])) points.push({x: xs[i], y: ys[i]});
    }
    this.chart.data.datasets[0].data = points;
    const {x} = this.chart.options.scales;
    x.min = points.length ? points[0].x : undefined;
    x.max = points.length > 1 ? points.at(-1).x : undefined;
    this.chart.update("none");
  }

  clear() {
    this.mark(NaN);
    this.set([], []);
  }

  /** A line at `x`; none at NaN. */
  mark(x) {
    if (Object.is(this.chart.markedX, x)) return;
    this.chart.markedX = x;
    this.chart.draw();
  }

  /** Calls moved(x) for where the pointer is pressed or drawn along the curve. */
  onDrag(moved) {
    const {canvas} = this.chart;
    canvas.style.touchAction = "pan-y";
    const at = (event) => {
      const {chartArea: {left, right}, scales: {x}} = this.chart;
      moved(x.getValueForPixel(Math.min(Math.max(event.offsetX, left), right)));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      at(event);
    });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons & 1) at(event); });
  }
}

/** Marks of points. A bar of one standard error to either side of each that has one (`bar`), behind the points. */
const pointMarks = {
  id: "pointMarks",
  /** A hole in each point that is hollow: its colour stays to be seen around it. */
  afterDatasetsDraw(chart) {
    const {ctx, scales: {x, y}} = chart, side = 0.55 * chart.data.datasets[0].pointRadius;
    ctx.fillStyle = colour("panel");
    for (const point of chart.points ?? []) {
      if (!point.hollow) continue;
      ctx.fillRect(x.getPixelForValue(point.x) - side / 2, y.getPixelForValue(point.y) - side / 2, side, side);
    }
  },
  beforeDatasetsDraw(chart) {
    const {ctx, scales: {x, y}} = chart;
    ctx.strokeStyle = colour("faint");
    ctx.lineWidth = 1.5;
    for (const point of chart.points ?? []) {
      if (!(point.bar > 0)) continue;
      const at = x.getPixelForValue(point.x);
      ctx.beginPath();
      ctx.moveTo(at, y.getPixelForValue(point.y - point.bar));
      ctx.lineTo(at, y.getPixelForValue(point.y + point.bar));
      ctx.stroke();
    }
  },
};

/** Ticks at `values`, at every second or third of many; wherever Chart.js likes them if there are none. */
function putTicks(scale, values) {
  const most = 8, step = Math.ceil(values.length / most), at = values.filter((_, k) => k % step === 0).map((value) => ({value}));
  scale.afterBuildTicks = at.length ? (built) => { built.ticks = at; } : undefined;
  scale.ticks.callback = at.length ? (value) => number(value) : undefined;
  scale.ticks.maxTicksLimit = most;
}

/** Points with a value each, shown by colour; or against the value where there is only one parameter. */
export class PointMap {
  constructor(canvas, choose) {
    this.points = [];
    this.chart = new Chart(canvas, {
      type: "scatter",
      plugins: [pointMarks],
      data: {datasets: [{data: [], pointRadius: 9, pointHoverRadius: 11, pointStyle: "rect", borderWidth: 2}]},
      options: {...common, parsing: false,
                onClick: (event, hits) => { if (hits.length) choose(this.points[hits[0].index], event.native.shiftKey); },
                onHover: (event, hits) => { event.native.target.style.cursor = hits.length ? "pointer" : "default"; },
                plugins: {legend: {display: false},
                          tooltip: {callbacks: {label: (item) => this.points[item.dataIndex].text}}},
                scales: {x: axis(""), y: axis("")}},
    });
  }

  /** A PNG of the map under a line of words; null if there is none. */
  picture(words) { return pictureOf(this.chart, words); }

  /**
   * points: [{x, y, fill, border, text: [lines], bar, hollow}]; `bar` is a standard error of y, NaN for none. `isGrid`: y is
   * a parameter, too.
   */
  set(points, xTitle, yTitle, isGrid) {
    this.points = this.chart.points = points;
    const [set] = this.chart.data.datasets;
    set.data = points.map(({x, y}) => ({x, y}));
    set.backgroundColor = points.map(({fill}) => fill);
    set.borderColor = points.map(({border}) => border);
    // as large as leaves room between neighbours
    const {width = 400, height = 240} = this.chart.chartArea ?? {}, rooms = {x: width, y: height};
    const room = Math.min(...["x", "y"].map((name) => 0.8 * rooms[name] / new Set(points.map((point) => point[name])).size));
    set.pointRadius = yTitle && points.some(({bar}) => bar > 0) ? 7 : Math.max(3, Math.min(9, room / 2));
    for (const [name, title] of [["x", xTitle], ["y", yTitle]]) {
      const scale = this.chart.options.scales[name];
      scale.title.text = title;
      scale.offset = true;
      putTicks(scale, name === "x" || isGrid ? [...new Set(points.map((point) => point[name]))].sort((a, b) => a - b) : []);
      const reach = (point) => name === "y" && point.bar > 0 ? point.bar : 0;
      const values = points.flatMap((point) => [point[name] - reach(point), point[name] + reach(point)]).filter(Number.isFinite);
      const low = Math.min(...values), high = Math.max(...values), margin = (high - low || Math.abs(low) || 1) * 0.08;
      scale.min = values.length ? low - margin : undefined;
      scale.max = values.length ? high + margin : undefined;
    }
    this.chart.update("none");
  }
}

/** A PNG of what `chart` shows, on the page's ground and with a line of words above it; null if there is none. */
export function pictureOf(chart, words) {
  const {canvas} = chart, size = Math.max(12, Math.round(canvas.height / 24)), top = 2 * size;
  const sheet = document.createElement("canvas");
  sheet.width = canvas.width;
  sheet.height = canvas.height + top;
  const context = sheet.getContext("2d");
  context.fillStyle = colour("panel");
  context.fillRect(0, 0, sheet.width, sheet.height);
  context.fillStyle = colour("ink");
  context.font = `${size}px sans-serif`;
  context.fillText(words, size, 1.4 * size, sheet.width - 2 * size);
  context.drawImage(canvas, 0, top);
  return new Promise((done) => sheet.toBlob(done, "image/png"));
}

/** Draws a strip of colours; colour(part) for part from 0 to 1. */
export function strip(canvas, colour) {
  canvas.width = 128;
  canvas.height = 1;
  const context = canvas.getContext("2d");
  for (let i = 0; i < canvas.width; ++i) {
    context.fillStyle = colour(i / (canvas.width - 1));
    context.fillRect(i, 0, 1, 1);
  }
}
