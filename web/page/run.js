// The chosen run: its rods, live or recorded, S(t), P(theta) and its files.
import {ask, byId, bytes, complain, duration, fetched, make, number, replaceIfOther, save} from "./dom.js";
import {actionButtons, hasWorker} from "./queue.js";
import {Curve, strip} from "./charts.js";
import {Newest} from "./loader.js";
import {RodPath} from "./path.js";
import {ShownFile} from "./shown.js";
import {RodCanvas, angleToDirector, unpack, unpackText} from "./rods.js";

const kBins = 36;
const kPlayEvery = 50;  // ms
const kLegends = {
  layers: ["−90°", "90° to the director"], wheel: ["0°", "180° in the box"], tilt: ["tail up, n_z = −", ", head up"], species: ["", ""],
};

export class RunPanel {
  constructor() {
    this.id = "";
    this.job = null;
    this.order = {times: [], values: []};
    this.early = {times: [], values: []};  // S(t) of recorded frames, for the time before anybody listened
    this.recorded = null;  // {n, first_s, last_s}
    this.isLive = false;   // shows what comes, as it comes
    this.stamp = "";       // of the queue, when the run was asked about
    this.index = -1;       // of the recorded frame that is shown
    this.wished = -1;      // of the one that is to be shown, which may still be on its way
    this.orderChart = new Curve(byId("order-chart"), "t (s)", "S", {min: 0, max: 1});
    this.angleChart = new Curve(byId("angle-chart"), "θ (degrees)", "P(θ) per degree", {min: 0});
    this.orderChart.onDrag((time) => this.goTo(time));
    this.canvas = this.makeCanvas();
    window.shakenRun = this;  // for the page's tests, and for whoever looks at it with the browser's tools
    byId("colouring").onchange = () => this.redraw();
    byId("defects").onchange = () => this.redraw();
    byId("reset-view").onclick = async () => (await this.canvas)?.reset();
    byId("orbit").onclick = async () => (await this.canvas)?.toggleOrbit();
    byId("time").oninput = () => { this.stopPlaying(); this.listen(false); this.showRecorded(Number(byId("time").value)); };
    byId("play").onclick = () => (this.playing ? this.stopPlaying() : this.play());
    byId("live").onclick = () => this.listen(true);
    this.shown = new ShownFile();
    this.frames = new Newest((index) => this.fetchRecorded(index));
    byId("draw").onclick = () => this.shown.show(this.id, this.index);
  }

  async makeCanvas() {
    try {
      const canvas = new RodCanvas(byId("rods"), byId("marks"), await ask("/palettes.json"));
      window.shakenRods = canvas;  // for whoever looks at it with the browser's tools
      this.path = new RodPath(canvas, () => ({run: this.id, frame: this.isLive ? "last" : Math.max(0, this.index)}));
      canvas.onView = () => {
        canvas.draw();
        byId("orbit").setAttribute("aria-pressed", Boolean(canvas.view.orbit));
        this.nameRods(canvas);
      };
      canvas.onRod = (words, rod) => {
        byId("rod-facts").textContent = words;
        this.path.follow(rod);
      };
      return canvas;
    } catch (problem) {
      complain(problem.message);
      return null;
    }
  }

  async choose(id) {
    if (id === this.id) return;
    this.id = id;
    this.index = this.wished = -1;
    this.stopPlaying();
    this.shown.close();
    this.isLive = this.hasMeanAngles = false;
    this.job = this.recorded = null;
    this.order = {times: [], values: []};
    this.early = {times: [], values: []};
    this.orderChart.clear();
    this.angleChart.clear();
    for (const place of ["run-note", "run-facts"]) byId(place).textContent = "";
    replaceIfOther(byId("files"), "", () => []);
    replaceIfOther(byId("run-actions"), "", () => []);
    byId("scrub").hidden = true;
    byId("run-title").textContent = id ? `Run ${id}` : "Choose a run";
    byId("run").classList.toggle("without-run", !id);
    (await this.canvas)?.clear();
    this.path?.clear();
    byId("rod-facts").textContent = "";
    if (id && id === this.id) await this.load();
  }

  isRunning() { return hasWorker(this.job); }

  /** Asks for everything about the run; again when its state may have changed. */
  async load() {
    const {id} = this;
    if (!id) return;
    try {
      const {job} = await ask(`/v1/jobs/${id}`);
      if (id !== this.id) return;
      const wasRunning = this.isRunning();
      const curveNames = ["/order/time_s", "/order/order", "/angles/theta_rad", "/angles/density_per_rad"];
      const of = curveNames.map((name) => `of=${name}`).join("&"), isAtWork = hasWorker(job);
      const wanted = ["frames", "files", ...(isAtWork ? [] : [`curves?${of}`])];  // which there are at the end
      const [frames, files, curves] = await Promise.all(
        wanted.map((what) => ask(`/runs/${id}/${what}`).catch((problem) => ({problem}))));
      if (id !== this.id) return;
      this.job = job;
      this.showJob();
      this.showFiles(files);
      this.noteFrames(frames);
      if (this.isRunning()) {
        if (!wasRunning) {
          this.listen(true);
          this.askForOrder();
        }
        return;
      }
      this.listen(false);
      if (!curves.problem) this.showCurves(curves.curves);
      const last = (this.recorded?.n ?? 0) - 1;
      if (this.recorded) await this.showRecorded(this.wished >= 0 ? Math.min(this.wished, last) : last);
      else byId("run-note").textContent += `: ${frames.problem?.message ?? frames.reason}`;
    } catch (problem) {
      this.stamp = "";  // asked again soon
      complain(problem.message);
    }
  }

  /** The jobs that run, as the daemon tells them; `stamp` changes when the state of any job does. */
  noteQueue(running, stamp) {
    if (!this.id) return;
    const now = running.find((job) => job.id === this.id);
    if (stamp !== this.stamp || !this.job || Boolean(now) !== this.isRunning()) {
      this.stamp = stamp;
      this.load();
    } else if (now) {
      this.job = now;
      this.showJob();
      this.askForFrames();
    }
  }

  /** A run at work records ever more frames. */
  async askForFrames() {
    const {id} = this, now = Date.now();
    if (now < (this.nextAsk ?? 0)) return;
    this.nextAsk = now + 5000;
    const frames = await ask(`/runs/${id}/frames`).catch(() => null);
    if (id === this.id) this.noteFrames(frames);
  }

  /** S(t) of a run at work, of what it has recorded: the bus tells nothing of the time before. */
  async askForOrder() {
    const {id} = this;
    if (!this.recorded) return;
    const answer = await ask(`/runs/${id}/order`).catch(() => null);
    if (!answer || id !== this.id || !this.isRunning()) return;
    this.early = {times: answer.time_s, values: answer.order};
    this.drawOrder();
  }

  drawOrder() {
    const {order, early} = this, begin = order.times[0] ?? Infinity, n = early.times.filter((time) => time < begin).length;
    this.orderChart.set([...early.times.slice(0, n), ...order.times], [...early.values.slice(0, n), ...order.values]);
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
    replaceIfOther(byId("run-actions"), `${job.id} ${job.state}`, () => actionButtons(`/v1/jobs/${job.id}`, new Set([job.state]), "run"));
  }

  showFiles(answer) {
    const {id} = this;
    const link = ({name, bytes: size}) => make("li", {}, make("button", {
      type: "button", onclick: () => save(`/runs/${id}/files/${name}`)}, name), ` ${bytes(size)}`,
      ...(/\.(mp4|webm)$/.test(name) ? [" ", make("button", {type: "button", onclick: () => this.shown.film(id, name)}, "Play")] : []));
    // Buttons that are made anew while one is pressed would lose the press.
    replaceIfOther(byId("files"), id + (answer.problem?.message ?? JSON.stringify(answer.files)),
      () => answer.problem ? [answer.problem.message] : answer.files.map(link));
  }

  showCurves(curves) {
    const {"/order/time_s": times, "/order/order": values} = curves;
    if (times && values) {
      this.order = {times, values};
      this.early = {times: [], values: []};
      this.drawOrder();
    }
    const {"/angles/theta_rad": theta, "/angles/density_per_rad": density} = curves;
    this.hasMeanAngles = Boolean(theta && density);
    if (this.hasMeanAngles) this.angleChart.set(theta.map((t) => t * 180 / Math.PI), density.map((p) => p * Math.PI / 180));
  }

  listen(on) {
    byId("live").hidden = on || !this.isRunning();
    this.isLive = on;
    byId("defects").disabled = !on;
    byId("defects-word").textContent = on ? "Defects" : "Defects (of live rods only)";
    this.traffic = null;
    byId("run-rate").textContent = "";
    if (!on) return;
    this.stopPlaying();
    this.index = this.wished = -1;
    this.hasMeanAngles = false;
  }

  /** What the bus tells of run `id`. */
  async note(id, name, data) {
    if (id !== this.id) return;
    if (name === "order") {
      const {time_s: times, order: values} = JSON.parse(data);
      if (!this.isRunning() && !times.length) return;
      this.order = {times, values};
      this.drawOrder();
    } else if (name === "observables") {
      this.noteObservables(JSON.parse(data));
    } else if (this.isLive && name === "defects") {
      const canvas = await this.canvas;
      if (canvas && this.isLive && id === this.id) canvas.defects = JSON.parse(data).defects;
    } else if (this.isLive && name === "frame") {
      this.noteTraffic(data.length);
      await this.showFrame(unpackText(data), id);
    }
  }

  /** How many live frames come, and how many are drawn: said anew every two seconds. */
  async noteTraffic(bytesOfFrame) {
    const now = performance.now(), canvas = await this.canvas, drawn = canvas?.framesDrawn ?? 0;
    this.traffic ??= {since: now, frames: 0, bytes: 0, drawn};
    const {traffic} = this, seconds = (now - traffic.since) / 1000;
    ++traffic.frames;
    traffic.bytes += bytesOfFrame;
    if (seconds < 2) return;
    byId("run-rate").textContent = `Live: ${number(traffic.frames / seconds, 2)} frames/s, ${bytes(Math.round(traffic.bytes / seconds))}/s; ` +
      `${number((drawn - traffic.drawn) / seconds, 2)} pictures/s`;
    this.traffic = null;
  }

  noteObservables(now) {
    if (now.order === null) return;  // spheres have none
    const {times, values} = this.order;
    if (times.length && now.time_s < times.at(-1)) {  // back to a checkpoint
      times.length = values.length = 0;
      this.askForOrder();
    }
    if (times.length === 0 || now.time_s > times.at(-1)) {
      times.push(now.time_s);
      values.push(now.order);
      this.drawOrder();
    }
  }

  async showFrame(frame, id) {
    const canvas = await this.canvas;
    if (id !== this.id) return;
    byId("run-facts").textContent = `t = ${frame.time_s.toFixed(3)} s, ${frame.n_rods} rods in ${[...new Set(frame.box_mm)].map((side) => number(side)).join(" × ")} mm` +
      (frame.order === null ? "" : `, S = ${frame.order.toFixed(3)}`);
    this.orderChart.mark(frame.time_s);
    if (!canvas) return;
    this.nameRods(canvas);
    canvas.set(frame);
    this.path.renew();
    this.showLegend(canvas);
    if (this.hasMeanAngles || frame.order === null) return;
    const counts = new Array(kBins).fill(0), width = 180 / kBins;
    for (let i = 0; i < frame.n_rods; ++i) {
      if (frame.species[i] === 0) ++counts[Math.min(kBins - 1, Math.floor((angleToDirector(frame, i) + 90) / width))];
    }
    const total = counts.reduce((sum, n) => sum + n, 0) || 1;
    this.angleChart.set(counts.map((n, k) => -90 + (k + 0.5) * width), counts.map((n) => n / total / width));
  }

  nameRods(canvas) {
    const words = [`Rods: ${byId("run-facts").textContent}`, canvas.viewWords()].filter(Boolean);
    byId("marks").setAttribute("aria-label", words.join("; "));
  }

  showLegend(canvas) {
    const kind = canvas.chosenColouring(), colours = canvas.palettes[kind];
    const [low, high] = kLegends[kind], limit = kind === "tilt" ? canvas.palettes.full_tilt : "";
    if (kind === this.legend) return;
    this.legend = kind;
    const bar = make("canvas"), css = (ink) => `#${ink.toString(16).padStart(6, "0")}`;
    strip(bar, (part) => css(colours[Math.min(colours.length - 1, Math.floor(part * colours.length))]));
    byId("legend").replaceChildren(low + limit, bar, limit + high);
  }

  async redraw() {
    const canvas = await this.canvas;
    if (!canvas) return;
    canvas.colouring = byId("colouring").value;
    canvas.showsDefects = byId("defects").checked;
    canvas.draw();
    this.showLegend(canvas);
  }

  /** Shows the recorded frame that is nearest to a time. */
  goTo(time) {
    const {recorded} = this;
    if (!recorded) return;
    const {n, first_s: first, last_s: last} = recorded, part = last > first ? (time - first) / (last - first) : 0;
    this.stopPlaying();
    this.listen(false);
    this.showRecorded(Math.round(Math.min(Math.max(part, 0), 1) * (n - 1)));
  }

  noteFrames(frames) {
    this.recorded = frames?.n > 0 ? frames : null;
    byId("scrub").hidden = !this.recorded;
    if (!this.recorded) return;
    byId("time").max = frames.n - 1;
    byId("play").disabled = frames.n < 2;
  }

  /** Shows recorded frame `index`, as soon as it is there. */
  showRecorded(index) {
    this.wished = index;
    return this.frames.want(index);
  }

  async fetchRecorded(index) {
    const {id} = this;
    if (this.isLive) return;
    try {
      const response = await fetched(`/runs/${id}/frames/${index}`);
      const bytesOf = response.ok ? await response.arrayBuffer() : (await response.json()).error;
      if (id !== this.id || this.isLive) return;
      if (!response.ok) throw new Error(bytesOf);
      const canvas = await this.canvas;
      if (canvas) canvas.defects = [];
      if (id !== this.id) return;
      this.index = index;
      await this.showFrame(unpack(bytesOf), id);
      if (id === this.id) byId("time").value = index;
    } catch (problem) {
      complain(problem.message);
      this.stopPlaying();
    }
  }

  play() {
    this.listen(false);
    if (this.index >= this.recorded.n - 1) this.index = -1;
    byId("play").textContent = "Stop";
    this.playing = setInterval(() => {
      if (this.frames.isBusy) return;
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
