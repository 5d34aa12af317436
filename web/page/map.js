// SPDX-License-Identifier: MIT
// The chosen sweep: its jobs, and its phase diagram, which fills in as runs finish.
import {ask, byId, complain, make, number, replaceIfOther} from "/page/dom.js";
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

/** What is to be said of an average of a row: a word where it still relaxes or that is not known, as in tables. */
function warning(row, path) {
  const own = path.startsWith("measured.") ? row.summary?.measured?.[path.split(".")[1]]?.steady : undefined;
  const isAverage = path === "order.mean" || path === "order.std" || path.startsWith("measured.");
  const steady = typeof own === "boolean" ? own : row.summary?.steady;
  if (!isAverage || !row.summary || steady === true) return "";
  return steady === false ? "~ still relaxing" : "? too short to tell whether it is steady";
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
      id: `map-${name}`, onchange: (event) => { axes[name] = event.target.value; this.drawMap(); },
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
      const place = places.get(key) ?? {across, up, jobs: [], values: [], states: new Set(), warnings: new Set()};
      places.set(key, place);
      if (place.jobs.includes(row.job)) continue;
      place.jobs.push(row.job);
      place.states.add(row.state);
      if (Number.isFinite(row.values[value])) {
        place.values.push(row.values[value]);
        const told = warning(row, value);
        if (told) place.warnings.add(told);
      }
    }
    const mean = (values) => values.reduce((sum, one) => sum + one, 0) / values.length;
    const all = [...places.values()].filter((place) => Number.isFinite(place.across));
    const means = all.filter(({values}) => values.length).map(({values}) => mean(values));
    const low = Math.min(...means), high = Math.max(...means);
    const points = all.filter((place) => y || place.values.length).map((place) => {
      const average = place.values.length ? mean(place.values) : NaN;
      const border = place.states.has("running") ? "#ff9000" : place.states.has("failed") ? "#ff5f5f" :
        place.jobs.includes(this.run) ? "#e4e6ea" : "#3a404a";
      const words = [`${x} = ${place.across}`, ...(y ? [`${y} = ${place.up}`] : []),
                     `${value} = ${number(average)}` + (place.values.length > 1 ? ` (mean of ${place.values.length})` : ""),
                     ...place.warnings, [...place.states].join(", ")];
      return {x: place.across, y: y ? place.up : average, jobs: place.jobs, border, text: words.join("; "),
              fill: Number.isFinite(average) ? sequential(high > low ? (average - low) / (high - low) : 0.5) : "transparent"};
    });
    byId("map-frame").hidden = !points.length;
    this.map.set(points, x, y || value);
    const bar = make("canvas");
    strip(bar, sequential);
    byId("map-scale").shownStamp = undefined;
    byId("map-scale").replaceChildren(...(means.length && y ? [`${value}: ${number(low)}`, bar, number(high)] : []));
  }

  drawTable() {
    const jobs = this.jobs.slice(0, kMostRows).map((old) => this.running.get(old.id) ?? old);
    // Rows stay: one that is being clicked must not be replaced.
    const body = byId("jobs");
    if (body.children.length !== jobs.length) body.replaceChildren(...jobs.map(() => make("tr")));
    jobs.forEach((job, i) => {
      const done = job.progress && job.state !== "done" && job.progress.sim_time_total_s > 0 ?
        ` ${Math.floor(100 * job.progress.sim_time_s / job.progress.sim_time_total_s)} %` : "";
      const row = body.children[i], state = job.state + done;
      row.setAttribute("aria-selected", String(job.id === this.run));
      row.title = job.reason || job.label;
      row.onclick = () => this.chooseRun(job.id);
      if (row.dataset.job === job.id && row.dataset.state === job.state) {
        row.children[1].textContent = state;
        return;
      }
      row.dataset.job = job.id;
      row.dataset.state = job.state;
      row.replaceChildren(make("td", {}, job.id.slice(0, 8)), make("td", {}, state), make("td", {}, job.label),
                          make("td", {}, ...actionButtons(`/v1/jobs/${job.id}`, new Set([job.state]))));
    });
  }
}
