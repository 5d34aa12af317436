// SPDX-License-Identifier: MIT
// The chosen sweep: its jobs, and its phase diagram, which fills in as runs finish.
import {ask, byId, complain, make, number, offer, replaceIfOther} from "/page/dom.js";
import {actionButtons, countsText} from "/page/queue.js";
import {PointMap, sequential, strip} from "/page/charts.js";

/** So many results are asked for at once; a larger sweep's table shows the first of its jobs. */
const kMostResults = 2000, kMostRows = 500;
const kPreferred = ["order.mean", "measured.theta_m_deg.value", "n_rods"];

/** Numbers of a summary by path: {"order.mean": 0.9, ...}. */
function leaves(object, prefix = "", found = {}) {
  for (const [key, value] of Object.entries(object ?? {})) {
    if (typeof value === "number") found[prefix + key] = value;
    else if (value && typeof value === "object" && !Array.isArray(value)) leaves(value, `${prefix}${key}.`, found);
  }
  return found;
}

/** The mark and the words of an average that is of no steady state, or not known to be, as in all tables (base/steadiness.h). */
const kSteadiness = {"~": "still relaxing", "?": "not known to be steady"};

/** The mark of a value of a row, "~" or "?"; empty where it is steady, or no average over time. */
function markOf(row, path) {
  const own = path.startsWith("measured.") ? row.summary?.measured?.[path.split(".")[1]]?.steady : undefined;
  const isAverage = path === "order.mean" || path === "order.std" || path.startsWith("defects.mean") ||
    (path.startsWith("measured.") && path.endsWith(".value"));
  const steady = typeof own === "boolean" ? own : row.summary?.steady;
  if (!isAverage || !Number.isFinite(row.values[path]) || steady === undefined || steady === true) return "";
  return steady === false ? "~" : "?";
}

/** The standard error of a value of a row; NaN where it has none. */
function errorOf(row, path) {
  const field = path === "order.mean" ? "order.sem" : path.startsWith("measured.") ? path.replace(/\.value$/, ".sem") : "";
  return field !== path && Number.isFinite(row.values[field]) ? row.values[field] : NaN;
}

/** "~0.912 ± 0.004": a value with its mark, and as many digits as two of its error's. */
function valueText(mark, value, error) {
  if (!Number.isFinite(value)) return "";
  if (!(error > 0)) return mark + number(value);
  const digits = Math.min(12, Math.max(0, 1 - Math.floor(Math.log10(error))));
  return `${mark}${value.toFixed(digits)} ± ${error.toFixed(digits)}`;
}

/** Mean of replicas and its error: their scatter, never below the errors within them, as `shaken results --aggregate` has it. */
function replicaMean(values, errors) {
  const n = values.length, mean = values.reduce((sum, one) => sum + one, 0) / n;
  const within = Math.sqrt(errors.reduce((sum, one) => sum + one * one, 0)) / n;
  if (n === 1) return {mean, error: within};
  const scatter = Math.sqrt(values.reduce((sum, one) => sum + (one - mean) ** 2, 0) / (n - 1) / n);
  return {mean, error: errors.every(Number.isFinite) ? Math.max(within, scatter) : NaN};
}

const sorted = (set) => [...set].sort((a, b) => a.localeCompare(b));

export class SweepPanel {
  /** `choose(id)` is called when a run is clicked. */
  constructor(choose) {
    this.chooseRun = choose;
    this.id = "";
    this.run = "";
    this.rows = [];
    this.jobs = [];
    this.running = new Map();
    this.seen = "";
    this.axes = {x: "", y: "", value: ""};
    this.map = new PointMap(byId("map"), (point) => this.chooseRun(point.jobs[0]));
    byId("map-save").onclick = () => this.savePicture();
  }

  choose(id, run) {
    this.run = run;
    if (id !== this.id) {
      this.id = id;
      this.rows = [];
      this.jobs = [];
      this.seen = "";
      this.axes = {x: "", y: "", value: ""};
      byId("sweep-title").textContent = id ? `Sweep ${id}` : "Choose a sweep";
      for (const place of ["sweep-actions", "map-choices", "map-scale"]) replaceIfOther(byId(place), "", () => []);
      this.map.set([], "", "");
      if (this.sweeps) this.note(this.sweeps, [...this.running.values()]);
    }
    this.drawTable();
  }

  /** The sweeps as they are now, and the jobs that run. */
  note(sweeps, running) {
    this.sweeps = sweeps;
    this.running = new Map(running.map((job) => [job.id, job]));
    const sweep = sweeps.find((one) => one.id === this.id);
    if (!sweep) return;
    byId("sweep-title").textContent = `${sweep.id} ${sweep.name}: ${countsText(sweep.counts)}`;
    const states = new Set(Object.keys(sweep.counts).filter((state) => sweep.counts[state] > 0));
    const stamp = JSON.stringify([sweep.id, sweep.counts]);
    if (stamp !== this.seen) {
      this.seen = stamp;
      replaceIfOther(byId("sweep-actions"), `${sweep.id} ${[...states]}`, () => actionButtons(`/v1/sweeps/${sweep.id}`, states));
      this.load(sweep);
    } else {
      this.drawTable();
    }
  }

  async load(sweep) {
    const number = this.loads = (this.loads ?? 0) + 1;  // a later one is not written over
    try {
      const {jobs} = await ask(`/v1/sweeps/${sweep.id}`);
      const rows = sweep.n_jobs <= kMostResults ? (await ask(`/v1/results?sweep=${sweep.id}`)).rows : [];
      if (sweep.id !== this.id || number !== this.loads) return;
      this.jobs = jobs;
      this.rows = rows.map((row) => ({...row, values: leaves(row.summary)}));
      byId("map-note").textContent = sweep.n_jobs > kMostResults ?
        `a sweep of more than ${kMostResults} jobs has no map here: use \`shaken plot ${sweep.id}\`` : "";
      this.drawChoices();
      this.drawMap();
      this.drawTable();
    } catch (problem) {
      this.seen = "";  // asked again at the next change
      complain(problem.message);
    }
  }

  /** Parameters that differ between jobs and are numbers; the seed is no axis. */
  swept() {
    const values = new Map();
    for (const {parameters} of this.jobs) {
      for (const [key, value] of Object.entries(parameters)) {
        if (typeof value === "number" && key !== "time.seed") values.set(key, (values.get(key) ?? new Set()).add(value));
      }
    }
    return [...values].filter(([, set]) => set.size > 1).sort(([, a], [, b]) => b.size - a.size).map(([key]) => key);
  }

  drawChoices() {
    const swept = this.swept(), measured = new Set(this.rows.flatMap((row) => Object.keys(row.values)));
    const {axes} = this;
    if (!swept.includes(axes.x)) axes.x = swept[0] ?? "";
    if (!swept.includes(axes.y)) axes.y = swept[1] ?? "";
    if (!measured.has(axes.value)) axes.value = kPreferred.find((name) => measured.has(name)) ?? sorted(measured)[0] ?? "";
    const select = (name, title, words) => make("label", {}, `${title} `, make("select", {
      id: `map-${name}`, onchange: (event) => { axes[name] = event.target.value; this.drawMap(); this.drawTable(); },
    }, ...words.map((word) => make("option", {value: word, selected: word === axes[name]}, word || "the value"))));
    replaceIfOther(byId("map-choices"), JSON.stringify([swept, sorted(measured)]), () => [
      ...(swept.length ? [select("x", "Across", swept), select("y", "Up", ["", ...swept]),
                          select("value", "Colour", sorted(measured))] : [])]);
  }

  /** Jobs at the same place are replicas: their mean is shown. A run that is listed twice counts once. */
  drawMap() {
    const {x, y, value} = this.axes;
    const places = new Map();
    for (const row of this.rows) {
      const across = row.parameters[x], up = y ? row.parameters[y] : undefined;
      const key = JSON.stringify([across, up]);
      const place = places.get(key) ?? {across, up, jobs: [], values: [], errors: [], states: new Set(), marks: new Set()};
      places.set(key, place);
      if (place.jobs.includes(row.job)) continue;
      place.jobs.push(row.job);
      place.states.add(row.state);
      if (Number.isFinite(row.values[value])) {
        place.values.push(row.values[value]);
        place.errors.push(errorOf(row, value));
        const mark = markOf(row, value);
        if (mark) place.marks.add(mark);
      }
    }
    const all = [...places.values()].filter((place) => Number.isFinite(place.across));
    const means = all.filter(({values}) => values.length).map(({values, errors}) => replicaMean(values, errors).mean);
    const low = Math.min(...means), high = Math.max(...means);
    this.range = [low, high];
    const points = all.filter((place) => y || place.values.length).map((place) => {
      const {mean: average, error} = place.values.length ? replicaMean(place.values, place.errors) : {mean: NaN, error: NaN};
      const mark = ["~", "?"].find((each) => place.marks.has(each)) ?? "";
      const colour = Number.isFinite(average) ? sequential(high > low ? (average - low) / (high - low) : 0.5) : "transparent";
      const border = place.states.has("running") ? "#ff9000" : place.states.has("failed") ? "#ff5f5f" :
        place.jobs.includes(this.run) ? "#e4e6ea" : mark ? "#949aa5" : "#3a404a";
      const words = [`${x} = ${place.across}`, ...(y ? [`${y} = ${place.up}`] : []),
                     `${value} = ${valueText(mark, average, error) || "unknown"}` + (place.values.length > 1 ? ` (mean of ${place.values.length})` : ""),
                     ...[...place.marks].map((each) => `${each} ${kSteadiness[each]}`), [...place.states].join(", ")];
      return {x: place.across, y: y ? place.up : average, jobs: place.jobs, border, text: words.join("; "), bar: y ? NaN : error,
              hollow: Boolean(mark), fill: colour};
    });
    const met = ["~", "?"].filter((mark) => all.some(({marks}) => marks.has(mark)));
    byId("map-marks").textContent = met.length ? `hollow: ${met.map((mark) => kSteadiness[mark]).join(" or ")}` : "";
    byId("map-frame").hidden = byId("map-save").hidden = !points.length;
    this.map.set(points, x, y || value);
    const bar = make("canvas");
    strip(bar, sequential);
    byId("map-scale").shownStamp = undefined;
    byId("map-scale").replaceChildren(...(means.length && y ? [`${value}: ${number(low)}`, bar, number(high)] : []));
  }

  /** The map as a PNG, as fine as the screen has it, with what it shows and the ends of the colours' scale. */
  async savePicture() {
    const {axes, id, range: [low, high] = []} = this, note = byId("map-marks").textContent;
    const scale = axes.y && Number.isFinite(low) ? ` from ${number(low)} (dark) to ${number(high)} (bright)` : "";
    const picture = await this.map.picture(`${id}: ${axes.value}${scale}${note ? `; ${note}` : ""}`);
    if (picture) offer(picture, `${id}-${axes.value}.png`);
    else complain("the browser could not draw the picture");
  }

  drawTable() {
    const {value} = this.axes, rows = new Map(this.rows.map((row) => [row.job, row]));
    byId("jobs-value").textContent = value;
    const jobs = this.jobs.slice(0, kMostRows).map((old) => this.running.get(old.id) ?? old);
    // Rows stay: one that is being clicked must not be replaced.
    const body = byId("jobs");
    if (body.children.length !== jobs.length) body.replaceChildren(...jobs.map(() => make("tr")));
    jobs.forEach((job, i) => {
      const done = job.progress && job.state !== "done" && job.progress.sim_time_total_s > 0 ?
        ` ${Math.floor(100 * job.progress.sim_time_s / job.progress.sim_time_total_s)} %` : "";
      const row = body.children[i], state = job.state + done, result = rows.get(job.id);
      const mark = result ? markOf(result, value) : "";
      const told = result ? valueText(mark, result.values[value], errorOf(result, value)) : "";
      row.setAttribute("aria-selected", String(job.id === this.run));
      row.title = job.reason || job.label;
      row.onclick = () => this.chooseRun(job.id);
      if (row.dataset.job === job.id && row.dataset.state === job.state) {
        row.children[1].textContent = state;
        row.children[2].textContent = told;
        row.children[2].title = kSteadiness[mark] ?? "";
        return;
      }
      row.dataset.job = job.id;
      row.dataset.state = job.state;
      row.replaceChildren(make("td", {}, job.id.slice(0, 8)), make("td", {}, state), make("td", {title: kSteadiness[mark] ?? ""}, told), make("td", {}, job.label),
                          make("td", {}, ...actionButtons(`/v1/jobs/${job.id}`, new Set([job.state]))));
    });
  }
}
