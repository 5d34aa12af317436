// SPDX-License-Identifier: MIT
// The chosen run: its rods, live or recorded, S(t), P(theta) and its files.
import {ask, byId, bytes, complain, duration, make, number} from "/page/dom.js";
import {actionButtons} from "/page/queue.js";
import {Curve, strip} from "/page/charts.js";
import {RodCanvas, angleToDirector, unpack, unpackText} from "/page/rods.js";

const kBins = 36;
const kPlayEvery = 50;  // ms
const kLegends = {
  layers: ["−15°", "15° to the director"], wheel: ["0°", "180° in the box"], tilt: ["flat", "|n_z| = 0.5"], species: ["", ""],
};

export class RunPanel {
  constructor() {
    this.id = "";
    this.job = null;
    this.order = {times: [], values: []};
    this.recorded = null;  // {n, first_s, last_s}
    this.events = null;
    this.index = -1;
    this.orderChart = new Curve(byId("order-chart"), "t (s)", "S", {min: 0, max: 1});
    this.angleChart = new Curve(byId("angle-chart"), "θ (degrees)", "P(θ) per degree", {min: 0});
    this.canvas = this.makeCanvas();
    byId("colouring").onchange = () => this.redraw();
    byId("defects").onchange = () => this.redraw();
    byId("reset-view").onclick = async () => (await this.canvas)?.reset();
    byId("time").oninput = () => { this.stopPlaying(); this.listen(false); this.showRecorded(Number(byId("time").value)); };
    byId("play").onclick = () => (this.playing ? this.stopPlaying() : this.play());
    byId("live").onclick = () => this.listen(true);
  }

  async makeCanvas() {
    try {
      const canvas = new RodCanvas(byId("rods"), byId("marks"), await ask("/palettes.json"));
      window.shakenRods = canvas;  // for whoever looks at it with the browser's tools
      return canvas;
    } catch (problem) {
      complain(problem.message);
      return null;
    }
  }

  async choose(id) {
    if (id === this.id) return;
    this.id = id;
    this.index = -1;
    this.stopPlaying();
    this.events?.close();
    this.events = null;
    this.job = this.recorded = null;
    this.order = {times: [], values: []};
    this.orderChart.clear();
    this.angleChart.clear();
    for (const place of ["run-note", "run-facts"]) byId(place).textContent = "";
    byId("files").replaceChildren();
    byId("scrub").hidden = true;
    byId("run-title").textContent = id ? `Run ${id}` : "Choose a run";
    (await this.canvas)?.clear();
    if (id) await this.load();
  }

  /** Asks for everything about the run; again when its state changes. */
  async load() {
    const {id} = this;
    try {
      const {job} = await ask(`/v1/jobs/${id}`);
      if (id !== this.id) return;
      this.job = job;
      const [frames, curves, files] = await Promise.all([`frames`, `curves?of=/order/time_s&of=/order/order&of=/angles/theta_rad&of=/angles/density_per_rad`, `files`]
        .map((what) => ask(`/runs/${id}/${what}`).catch((problem) => ({problem}))));
      if (id !== this.id) return;
      this.showJob();
      this.showFiles(files);
      this.recorded = frames.problem ? null : frames;
      this.prepareScrubbing();
      if (job.state === "running" || job.state === "stopping") {
        this.listen(true);
      } else {
        this.listen(false);
        if (!curves.problem) this.showCurves(curves.curves);
        if (this.recorded) await this.showRecorded(this.index >= 0 ? Math.min(this.index, this.recorded.n - 1) : this.recorded.n - 1);
        else byId("run-note").textContent += ` — ${frames.problem.message}`;
      }
    } catch (problem) {
      complain(problem.message);
    }
  }

  /** Jobs that run, as the daemon tells them. */
  note(running) {
    if (!this.job) return;
    const now = running.find((job) => job.id === this.id);
    const wasRunning = this.job.state === "running" || this.job.state === "stopping";
    if (now) this.job = now;
    if (Boolean(now) !== wasRunning) this.load();
    else if (now) this.showJob();
  }

  showJob() {
    const {job} = this, progress = job.progress ?? {};
    byId("run-title").textContent = `Run ${job.id.slice(0, 8)}: ${job.label || "one point"}`;
    let note = job.state + (job.reason ? `: ${job.reason}` : "");
    if (progress.sim_time_total_s > 0) {
      note += `; ${number(progress.sim_time_s, 3)} of ${number(progress.sim_time_total_s, 3)} s simulated`;
      if (progress.eta_s >= 0) note += `, ${duration(progress.eta_s)} to go`;
    }
    byId("run-note").textContent = note;
    byId("run-actions").replaceChildren(...actionButtons(`/v1/jobs/${job.id}`, new Set([job.state])));
  }

  showFiles(answer) {
    const link = ({name, bytes: size}) => make("li", {}, make("a", {href: `/runs/${this.id}/files/${encodeURIComponent(name)}`}, name), ` ${bytes(size)}`);
    byId("files").replaceChildren(...(answer.problem ? [answer.problem.message] : answer.files.map(link)));
  }

  showCurves(curves) {
    const {"/order/time_s": times, "/order/order": values} = curves;
    if (times && values) {
      this.order = {times, values};
      this.orderChart.set(times, values);
    }
    const {"/angles/theta_rad": theta, "/angles/density_per_rad": density} = curves;
    this.hasMeanAngles = Boolean(theta && density);
    if (this.hasMeanAngles) this.angleChart.set(theta.map((t) => t * 180 / Math.PI), density.map((p) => p * Math.PI / 180));
  }

  listen(on) {
    byId("live").hidden = on || !this.job || !["running", "stopping"].includes(this.job.state);
    if (!on) {
      this.events?.close();
      this.events = null;
      return;
    }
    if (this.events) return;
    this.stopPlaying();
    this.index = -1;
    const events = new EventSource(`/live/${this.id}`);
    this.events = events;
    this.hasMeanAngles = false;
    const on_event = (name, take) => events.addEventListener(name, (event) => { if (this.events === events) take(event.data); });
    on_event("order", (data) => {
      const {time_s: times, order: values} = JSON.parse(data);
      this.order = {times, values};
      this.orderChart.set(times, values);
    });
    on_event("observables", (data) => this.noteObservables(JSON.parse(data)));
    on_event("defects", async (data) => {
      const canvas = await this.canvas;
      if (canvas) canvas.defects = JSON.parse(data).defects;
    });
    on_event("frame", (data) => this.showFrame(unpackText(data)));
  }

  noteObservables(now) {
    const {times, values} = this.order;
    if (times.length && now.time_s < times.at(-1)) times.length = values.length = 0;  // back to a checkpoint
    if (times.length === 0 || now.time_s > times.at(-1)) {
      times.push(now.time_s);
      values.push(now.order);
      this.orderChart.set(times, values);
    }
  }

  async showFrame(frame) {
    const canvas = await this.canvas;
    byId("run-facts").textContent = `t = ${frame.time_s.toFixed(3)} s, ${frame.n_rods} rods in ${number(frame.box_side_mm)} mm, S = ${frame.order.toFixed(3)}`;
    if (!canvas) return;
    canvas.set(frame);
    this.showLegend(canvas);
    if (this.hasMeanAngles) return;
    const counts = new Array(kBins).fill(0), width = 180 / kBins;
    for (let i = 0; i < frame.n_rods; ++i) {
      if (frame.species[i] === 0) ++counts[Math.min(kBins - 1, Math.floor((angleToDirector(frame, i) + 90) / width))];
    }
    const total = counts.reduce((sum, n) => sum + n, 0) || 1;
    this.angleChart.set(counts.map((n, k) => -90 + (k + 0.5) * width), counts.map((n) => n / total / width));
  }

  showLegend(canvas) {
    const kind = canvas.chosenColouring(), colours = canvas.palettes[kind];
    if (kind === this.legend) return;
    this.legend = kind;
    const bar = make("canvas"), css = (ink) => `#${ink.toString(16).padStart(6, "0")}`;
    strip(bar, (part) => css(colours[Math.min(colours.length - 1, Math.floor(part * colours.length))]));
    byId("legend").replaceChildren(kLegends[kind][0], bar, kLegends[kind][1]);
  }

  async redraw() {
    const canvas = await this.canvas;
    if (!canvas) return;
    canvas.colouring = byId("colouring").value;
    canvas.showsDefects = byId("defects").checked;
    canvas.draw();
    this.showLegend(canvas);
  }

  prepareScrubbing() {
    byId("scrub").hidden = !this.recorded;
    if (!this.recorded) return;
    byId("time").max = this.recorded.n - 1;
    byId("play").disabled = this.recorded.n < 2;
  }

  /** Shows recorded frame `index`; while one is fetched only the newest wish is kept. */
  async showRecorded(index) {
    this.wanted = index;
    if (this.isFetching) return;
    this.isFetching = true;
    try {
      while (this.wanted !== null && !this.events) {
        const {id, wanted} = this;
        this.wanted = null;
        const response = await fetch(`/runs/${id}/frames/${wanted}`);
        if (id !== this.id) break;
        if (!response.ok) throw new Error((await response.json()).error);
        const frame = unpack(await response.arrayBuffer());
        const canvas = await this.canvas;
        if (canvas) canvas.defects = [];  // they are measured live only
        await this.showFrame(frame);
        this.index = wanted;
        byId("time").value = wanted;
        byId("draw").href = `/runs/${id}/picture?frame=${wanted}`;
      }
    } catch (problem) {
      complain(problem.message);
      this.stopPlaying();
    } finally {
      this.isFetching = false;
    }
  }

  play() {
    this.listen(false);
    if (this.index >= this.recorded.n - 1) this.index = -1;
    byId("play").textContent = "Stop";
    this.playing = setInterval(() => {
      if (this.isFetching) return;
      if (this.index + 1 >= this.recorded.n) this.stopPlaying();
      else this.showRecorded(this.index + 1);
    }, kPlayEvery);
  }

  stopPlaying() {
    clearInterval(this.playing);
    this.playing = 0;
    byId("play").textContent = "Play";
  }
}
