// Up to four runs side by side, live or recorded, on one clock.
import {ask, byId, complain, fetched, make, number} from "./dom.js";
import {Newest} from "./loader.js";
import {suitingColouring} from "./painter.js";
import {RodCanvas, kWhole, unpack} from "./rods.js";

export const kMostBeside = 4;
const kPlayEvery = 50;   // ms
const kLivePause = 200;  // ms between two live frames, of which one is asked for at a time
const kAskEvery = 5000;  // ms, how much a run at work has recorded

/** "length = 3, replica 1" of each job: what is not the same in all of them. Keys are short where that is clear. */
export function differences(jobs) {
  const keys = [...new Set(jobs.flatMap((job) => Object.keys(job.parameters)))], last = (key) => key.split(".").at(-1);
  const named = (key) => (keys.filter((other) => last(other) === last(key)).length > 1 ? key : last(key));
  const valued = (value) => (typeof value === "number" ? number(value, 6) : value ?? "as in the scene");
  const facts = jobs.map((job) => new Map(/** @type {[string, string][]} */ ([
    ...keys.map((key) => [key, `${named(key)} = ${valued(job.parameters[key])}`]),
    ["sweep", `sweep ${job.sweep}`], ["replica", `replica ${job.replica}`]])));
  const differ = [...(facts[0]?.keys() ?? [])].filter((key) => new Set(facts.map((fact) => fact.get(key))).size > 1);
  return facts.map((fact) => differ.map((key) => fact.get(key)).join(", "));
}

class Pane {
  /** `seen` has the view of all panes, and draws them: {view, draw()}. */
  constructor(id, palettes, leave, seen) {
    this.id = id;
    this.job = this.recorded = this.frame = null;
    this.kind = "";
    this.nextAsk = 0;
    this.newest = new Newest((wish) => this.fetch(wish));
    this.title = make("h3", {}, id.slice(0, 8));
    this.note = make("p", {className: "note"});
    const rods = make("canvas", {"aria-hidden": "true"}), marks = make("canvas", {tabIndex: 0, role: "img", "aria-label": `Rods of ${id}`});
    const button = make("button", {type: "button", "aria-label": `Take ${id} away`, onclick: leave}, "×");
    this.element = make("div", {className: "pane"}, make("div", {className: "pane-head"}, this.title, button),
                        make("div", {className: "stage"}, rods, marks), this.note);
    this.canvas = new RodCanvas(rods, marks, palettes);
    Object.assign(this.canvas, {view: seen.view, onView: seen.draw});
    marks.classList.add("marks");
  }

  isRunning() { return this.job?.state === "running"; }

  async ask() {
    this.nextAsk = performance.now() + kAskEvery;
    const [{job}, recorded] = await Promise.all([ask(`/v1/jobs/${this.id}`), ask(`/runs/${this.id}/frames`).catch(() => null)]);
    this.job = job;
    this.recorded = recorded?.n > 0 ? recorded : null;
  }

  /** The frame of `path`, shown as soon as it is there. */
  show(path, shown) { return this.newest.want({path, shown}); }

  async fetch({path, shown}) {
    try {
      const response = await fetched(`/runs/${this.id}/${path}`);
      if (!response.ok) throw new Error((await response.json()).error);
      this.frame = unpack(await response.arrayBuffer());
      this.kind = suitingColouring(this.frame, this.canvas.palettes, this.kind);
      this.canvas.set(this.frame);
      shown();
    } catch (problem) {
      this.note.textContent = problem.message;
    }
  }

  indexAt(time) {
    const {n, first_s: first, last_s: last} = this.recorded;
    return Math.round(Math.min(1, Math.max(0, last > first ? (time - first) / (last - first) : 0)) * (n - 1));
  }
}

export class BesidePanel {
  /** `change(ids)` is called when a run is taken away. */
  constructor(change) {
    this.change = change;
    this.palettes = null;
    this.ids = [];
    this.panes = [];
    this.time = this.playing = 0;
    this.isLive = false;
    this.seen = {view: {...kWhole}, draw: () => this.draw()};
    byId("beside-orbit").onclick = () => this.panes[0]?.canvas.toggleOrbit();
    window.shakenBeside = this;  // for whoever looks at it with the browser's tools
    byId("beside-time").oninput = () => {
      this.stop();
      this.goTo(this.range().first + Number(byId("beside-time").value) * this.range().step);
    };
    byId("beside-play").onclick = () => (this.playing ? this.stop() : this.play());
    byId("beside-live").onclick = () => this.listen();
    byId("beside-colouring").append(...[...byId("colouring").options].map((one) => one.cloneNode(true)));
    byId("beside-colouring").onchange = () => this.colour();
    byId("beside-close").onclick = () => this.change([]);
    setInterval(() => this.refresh(), 1000);
  }

  /** Shows these runs, and no others. */
  async choose(ids) {
    if (ids.join() === this.ids.join()) return;
    this.ids = ids;
    byId("beside").hidden = byId("tab-beside").hidden = !ids.length;
    this.stop();
    this.isLive = false;
    try {
      this.palettes ??= ask("/palettes.json");
      const palettes = await this.palettes;
      if (ids !== this.ids) return;
      const old = new Map(this.panes.map((pane) => [pane.id, pane]));
      this.panes = ids.map((id) => old.get(id) ?? new Pane(id, palettes, () => this.change(this.ids.filter((one) => one !== id)), this.seen));
      for (const pane of old.values()) if (!this.panes.includes(pane)) pane.canvas.close();
      byId("beside-runs").replaceChildren(...this.panes.map(({element}) => element));
      await Promise.all(this.panes.map((pane) => pane.ask()));
      if (ids !== this.ids) return;
      this.tell();
      if (this.panes.some((pane) => pane.isRunning())) this.listen();
      else this.goTo(this.time || this.range().last);
    } catch (problem) {
      complain(problem.message);
    }
  }

  /** What is recorded of all runs: from the first frame of any to the last, in the finest steps of any. */
  range() {
    const all = this.panes.map(({recorded}) => recorded).filter(Boolean);
    if (!all.length) return {first: 0, last: 0, step: 1, n: 0};
    const first = Math.min(...all.map(({first_s: at}) => at)), last = Math.max(...all.map(({last_s: at}) => at));
    const steps = all.filter(({n}) => n > 1).map(({n, first_s: from, last_s: to}) => (to - from) / (n - 1));
    const step = steps.length ? Math.min(...steps) : 1;
    return {first, last, step, n: Math.round((last - first) / step)};
  }

  tell() {
    const words = differences(this.panes.map(({job}) => job).filter(Boolean));
    this.panes.forEach((pane, i) => {
      if (!pane.job) return;
      pane.title.textContent = (words[i] || pane.job.label || pane.id.slice(0, 8)) + (pane.job.state === "done" ? "" : ` (${pane.job.state})`);
      pane.title.title = `${pane.id} ${pane.job.label}`;
      if (!pane.recorded && !pane.isRunning()) pane.note.textContent = "This run has recorded no rods.";
    });
    const {n} = this.range();
    byId("beside-time").max = n;
    byId("beside-time").disabled = byId("beside-play").disabled = n === 0;
    byId("beside-live").hidden = this.isLive || !this.panes.some((pane) => pane.isRunning());
  }

  /** Runs at work record ever more, and end. */
  async refresh() {
    const due = document.hidden ? [] : this.panes.filter((pane) => pane.isRunning() && performance.now() > pane.nextAsk);
    if (!due.length) return;
    await Promise.all(due.map((pane) => pane.ask().catch(() => null)));
    this.tell();
  }

  /** Every run at the recorded frame that is nearest to a time. */
  goTo(time) {
    const {first, last, step} = this.range();
    this.isLive = false;
    this.time = Math.min(last, Math.max(first, time));
    byId("beside-time").value = Math.round((this.time - first) / step);
    byId("beside-clock").textContent = `t = ${this.time.toFixed(2)} s`;
    for (const pane of this.panes) if (pane.recorded) pane.show(`frames/${pane.indexAt(this.time)}`, () => this.shown(pane));
    this.tell();
  }

  /** Runs at work as they are now, one after the other; the others at their last frame. */
  async listen() {
    this.stop();
    this.goTo(this.range().last);
    this.isLive = true;
    byId("beside-clock").textContent = "live";
    this.tell();
    const turn = this.turn = (this.turn ?? 0) + 1;
    const goesOn = () => this.isLive && turn === this.turn && this.panes.some((pane) => pane.isRunning());
    while (goesOn()) {
      for (const pane of this.panes.filter((one) => one.isRunning())) {
        if (goesOn() && !document.hidden) await pane.show("newest", () => this.shown(pane));
        await new Promise((done) => setTimeout(done, kLivePause));
      }
    }
  }

  shown(pane) {
    const {frame, recorded} = pane;
    pane.note.textContent = `t = ${frame.time_s.toFixed(3)} s` + (frame.order === null ? "" : `, S = ${frame.order.toFixed(3)}`) +
      (!this.isLive && recorded && this.time > recorded.last_s + this.range().step / 2 ? ": its last frame" : "");
    this.colour();
  }

  /** All runs in one view. */
  draw() {
    for (const {canvas} of this.panes) canvas.draw();
    byId("beside-orbit").setAttribute("aria-pressed", Boolean(this.seen.view.orbit));
  }

  /** The same colours for all runs: by the angle to the director where all are in order, otherwise by that in the box. */
  colour() {
    const chosen = byId("beside-colouring").value, kinds = this.panes.filter(({frame}) => frame).map(({kind}) => kind);
    const common = kinds.includes("wheel") ? "wheel" : "layers";
    for (const {canvas, kind} of this.panes) {
      canvas.colouring = chosen !== "auto" ? chosen : kind === "species" ? kind : common;
      canvas.draw();
    }
  }

  play() {
    if (this.isLive || this.time >= this.range().last) this.goTo(this.range().first);
    byId("beside-play").textContent = "Stop";
    this.playing = setInterval(() => {
      if (this.panes.some(({newest}) => newest.isBusy)) return;
      const {last, step} = this.range();
      if (this.time >= last) this.stop();
      else this.goTo(this.time + step);
    }, kPlayEvery);
  }

  stop() {
    clearInterval(this.playing);
    this.playing = 0;
    byId("beside-play").textContent = "Play";
  }
}
