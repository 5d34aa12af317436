// The chosen sweep: its phase diagram and the table of its jobs.
import {ask, byId, complain, replaceIfOther} from "./dom.js";
import {JobTable} from "./jobs.js";
import {Loader} from "./loader.js";
import {PhaseMap} from "./map.js";
import {actionButtons, countsText} from "./queue.js";
import {leaves} from "./results.js";

/** A sweep of more jobs has no map here, and its table no values: their summaries would fill the browser. */
const kMostResults = 5000;

export class SweepPanel {
  /** `choose(id, isBeside)` is called when a run is clicked; with Shift, it is to be put beside others. */
  constructor(choose) {
    this.map = new PhaseMap(choose, () => this.draw());
    this.table = new JobTable(choose);
    this.loader = new Loader(() => this.load());
    window.shakenSweep = this;  // for whoever looks at it with the browser's tools
    this.running = new Map();
    this.run = this.id = "";
    this.beside = [];
    this.forget();
  }

  forget() {
    this.jobs = [];
    this.rows = new Map();
    this.seen = "";
  }

  choose(id, run, beside, inPictures) {
    this.map.showPictures(inPictures);
    this.run = run;
    this.beside = beside;
    if (id !== this.id) {
      this.id = id;
      this.forget();
      byId("sweep-title").textContent = id ? `Sweep ${id}` : "Choose a sweep";
      byId("map-note").textContent = "";
      replaceIfOther(byId("sweep-actions"), "", () => []);
      this.map.clear(id);
      this.table.clear();
      if (this.sweeps) this.note(this.sweeps, [...this.running.values()]);
    }
    this.draw();
  }

  /** The sweeps as they are now, and the jobs that run. */
  note(sweeps, running) {
    this.sweeps = sweeps;
    this.running = new Map(running.map((job) => [job.id, job]));
    const sweep = sweeps.find((one) => one.id === this.id);
    if (!sweep) return;
    byId("sweep-title").textContent = `${sweep.id} ${sweep.name}: ${countsText(sweep.counts)}`;
    const states = new Set(Object.keys(sweep.counts).filter((state) => sweep.counts[state] > 0));
    replaceIfOther(byId("sweep-actions"), `${sweep.id} ${[...states]}`, () => actionButtons(`/v1/sweeps/${sweep.id}`, states, "all"));
    const stamp = JSON.stringify([sweep.id, sweep.counts]);
    if (stamp !== this.seen) {
      this.seen = stamp;
      this.loader.want();
    } else {
      this.drawTable();
    }
  }

  /** Asks for the jobs, and for the results of those that have ended since it was asked last. */
  async load() {
    const {id} = this;
    if (!id) return;
    try {
      const {jobs} = await ask(`/v1/sweeps/${id}`);
      if (id !== this.id) return;
      this.jobs = jobs;
      this.drawTable();
      const isTooLarge = jobs.length > kMostResults;
      byId("map-note").textContent = isTooLarge ?
        `A sweep of more than ${kMostResults} jobs has no phase diagram here: \`shaken plot ${id}\` draws it.` : "";
      if (!isTooLarge) {
        await this.loadResults(id, jobs);
        if (id !== this.id) return;
      }
      this.draw();
    } catch (problem) {
      this.seen = "";  // asked again at the next change
      complain(problem.message);
    }
  }

  /** Results of the jobs that have ended, and were not asked for since; a job may join a sweep long after its end. */
  async loadResults(id, jobs) {
    const endOf = new Map(jobs.map((job) => [job.id, job.finished_utime]));
    const missing = jobs.filter((job) => job.finished_utime > 0 && this.rows.get(job.id)?.end !== job.finished_utime);
    if (!this.rows.size || missing.length) {
      const since = this.rows.size ? Math.min(...missing.map((job) => job.finished_utime)) : 0;
      const {rows} = await ask(`/v1/results?sweep=${id}&since=${since}`);
      if (id !== this.id) return;
      for (const row of rows) this.rows.set(row.job, {...row, end: endOf.get(row.job), values: leaves(row.summary)});
    }
    for (const job of this.rows.keys()) if (!endOf.has(job)) this.rows.delete(job);
    for (const job of jobs) {
      const row = this.rows.get(job.id);
      const isOld = !row || (row.end > 0 && job.finished_utime === 0);  // it runs anew
      if (isOld) this.rows.set(job.id, {job: job.id, state: job.state, parameters: job.parameters, end: 0, values: {}});
      else row.state = job.state;
    }
  }

  draw() {
    this.map.set(this.jobs, [...this.rows.values()], this.run, this.beside);
    this.drawTable();
  }

  drawTable() {
    const {value} = this.map.axes;
    byId("jobs-value").textContent = value || "Value";
    this.table.set(this.jobs.map((old) => this.running.get(old.id) ?? old), this.rows, value, this.run, this.beside);
  }
}
