// The phase diagram in pictures: each point shows the newest frame of its run.
import {ask, byId, complain, fetched, make, number, onTheme} from "./dom.js";
import {RodPainter, suitingColouring} from "./painter.js";
import {pointLines} from "./results.js";
import {kWhole, unpack} from "./rods.js";

const kPause = 150;     // ms between two loads, of which there is never more than one
const kRenewed = 3000;  // ms after which the picture of a run at work is loaded again

/** The run of a point that is shown: one at work if there is one, otherwise one that is done. */
const shownOf = (point, stateOf) => ["running", "done"].map((state) => point.jobs.find((job) => stateOf.get(job) === state))
  .find(Boolean) ?? point.jobs[0];

export class PictureMap {
  /** `choose(id)` is called when a picture is clicked. */
  constructor(choose) {
    this.chooseJob = choose;
    this.cells = [];
    this.isOn = false;
    this.grid = this.large = this.painter = null;
    this.frame = byId("pictures");
    this.sight = new IntersectionObserver((entries) => {
      for (const {target, isIntersecting} of entries) this.see(/** @type {any} */ (target).cell, isIntersecting);
    });
    this.frame.addEventListener("keydown", (event) => this.key(event));
    onTheme(() => this.cells.forEach((cell) => (cell.frame ? this.paint(cell) : cell.stamp = "")));
    window.addEventListener("scroll", () => { if (this.large) this.enlarge(this.large); }, {capture: true, passive: true});
    setInterval(() => this.load(), 500);
  }

  show(on) {
    this.isOn = on;
    this.frame.hidden = !on;
    this.enlarge(null);
    this.load();
  }

  /** The points of the diagram, the states of jobs by id, the chosen run and those beside each other. */
  set(points, axes, stateOf, run, beside) {
    const across = [...new Set(points.map((point) => point.across))].sort((a, b) => a - b);
    const up = [...new Set(points.map((point) => point.up))].sort((a, b) => b - a);
    const grid = JSON.stringify([axes.x, axes.y, across, up]);
    if (grid !== this.grid) this.build(grid, across, up, axes);
    const pointAt = new Map(points.map((point) => [`${point.across} ${point.up}`, point]));
    for (const cell of this.cells) {
      const point = pointAt.get(`${cell.across} ${cell.up}`), job = point ? shownOf(point, stateOf) : "";
      if (cell.job !== job) this.forget(cell);
      cell.button.style.visibility = point ? "" : "hidden";
      Object.assign(cell, {job, state: stateOf.get(job) ?? ""});
      if (!point) continue;
      cell.lines = pointLines(point, axes);
      cell.button.dataset.job = job;
      cell.button.setAttribute("aria-label", cell.lines.join("; "));
      cell.button.setAttribute("aria-pressed", point.jobs.includes(run));
      cell.button.dataset.beside = beside.includes(job);
      this.say(cell);
    }
  }

  build(grid, across, up, {y}) {
    this.sight.disconnect();
    this.enlarge(null);
    this.grid = grid;
    this.cells = [];
    const head = (text) => make("span", {className: "head-of-pictures"}, text), children = [];
    for (const one of up) {
      children.push(head(y ? number(one) : ""));
      for (const other of across) children.push(this.newCell(other, one).button);
    }
    children.push(head(""), ...across.map((one) => head(number(one))));
    this.frame.style.gridTemplateColumns = `minmax(3rem, 6rem) repeat(${across.length}, minmax(3.4rem, 9rem))`;
    this.frame.replaceChildren(...children);
    if (this.cells.length) this.cells[0].button.tabIndex = 0;
  }

  newCell(across, up) {
    const cell = {across, up, job: "", state: "", lines: [], seen: false, stamp: "", loaded: 0, frame: null, colouring: "", note: ""};
    cell.canvas = make("canvas", {"aria-hidden": "true"});
    cell.words = make("span");
    cell.button = make("button", {type: "button", className: "picture", tabIndex: -1,
                                  onclick: () => this.chooseJob(cell.job), onpointerenter: () => this.enlarge(cell),
                                  onpointerleave: () => this.enlarge(null), onblur: () => this.enlarge(null)},
                       cell.canvas, cell.words);
    cell.button.onfocus = () => {
      for (const one of this.cells) one.button.tabIndex = one === cell ? 0 : -1;
      this.enlarge(cell);
    };
    cell.button.cell = cell;
    this.cells.push(cell);
    this.sight.observe(cell.button);
    return cell;
  }

  forget(cell) {
    Object.assign(cell, {stamp: "", frame: null, colouring: "", note: ""});
    cell.canvas.width = 1;
  }

  /** Frames are kept only of what is in sight: there may be thousands. The small picture stays. */
  see(cell, isSeen) {
    cell.seen = isSeen;
    if (isSeen) this.load();
    else {
      cell.frame = null;
      if (cell === this.large) this.enlarge(null);
    }
  }

  say(cell) {
    const text = cell.note || (cell.state === "done" ? "" : cell.state);
    if (cell.words.textContent !== text) cell.words.textContent = text;
  }

  /** Of what is in sight: the first that has no picture of its present state, or the oldest picture of a run at work. */
  next() {
    const seen = this.cells.filter((cell) => cell.seen && cell.job && cell.state !== "queued");
    const isOld = (cell) => cell.state === "running" && performance.now() - cell.loaded > kRenewed;
    return seen.find((cell) => cell.stamp !== `${cell.job} ${cell.state}`) ??
      seen.filter(isOld).sort((a, b) => a.loaded - b.loaded)[0];
  }

  async load() {
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      for (let cell; this.isOn && !document.hidden && (cell = this.next());) {
        await this.loadOne(cell);
        await new Promise((done) => setTimeout(done, kPause));
      }
    } catch (problem) {
      this.isOn = false;  // this browser cannot draw
      complain(problem.message);
    } finally {
      this.isBusy = false;
    }
  }

  async loadOne(cell) {
    const {job} = cell;
    cell.stamp = `${job} ${cell.state}`;
    cell.loaded = performance.now();
    const response = await fetched(`/runs/${job}/newest`).catch(() => null);
    const frame = response?.ok ? unpack(await response.arrayBuffer()) : null;
    if (cell.job !== job) return;
    cell.note = frame || cell.canvas.width > 1 ? "" : "no rods";
    this.say(cell);
    if (!frame) return;
    cell.frame = frame;
    this.painter ??= new RodPainter(this.ground = make("canvas"), await ask("/palettes.json"));
    cell.colouring = suitingColouring(frame, this.painter.palettes, cell.colouring);
    this.paint(cell);
  }

  paint(cell) {
    this.paintOn(cell.canvas, cell);
    if (cell === this.large) this.paintOn(byId("picture-large"), cell);
  }

  paintOn(canvas, {frame, colouring}) {
    const size = Math.max(1, Math.round(canvas.clientWidth * (window.devicePixelRatio || 1)));
    for (const one of [this.ground, canvas]) if (one.width !== size || one.height !== size) one.width = one.height = size;
    this.painter.paint(frame, kWhole, size, colouring);
    canvas.getContext("2d").drawImage(this.ground, 0, 0);
  }

  /** Shows a cell larger, beside it; none at null. */
  enlarge(cell) {
    this.large = cell;
    const place = byId("picture");
    place.hidden = !cell?.frame;
    if (place.hidden) return;
    byId("picture-words").replaceChildren(...[`t = ${cell.frame.time_s.toFixed(3)} s`, ...cell.lines].map((line) => make("div", {}, line)));
    this.paintOn(byId("picture-large"), cell);
    const at = cell.button.getBoundingClientRect(), {offsetWidth: width, offsetHeight: height} = place, gap = 6;
    const left = at.right + gap + width < innerWidth ? at.right + gap : at.left - gap - width;
    const isBeside = left >= 0;
    place.style.left = `${isBeside ? left : Math.max(0, (innerWidth - width) / 2)}px`;
    const top = isBeside ? at.top : at.bottom + gap + height < innerHeight ? at.bottom + gap : at.top - gap - height;
    place.style.top = `${Math.max(gap, Math.min(top, innerHeight - height - gap))}px`;
  }

  key(event) {
    const n = JSON.parse(this.grid ?? "[0,0,[]]")[2].length, at = this.cells.findIndex(({button}) => button === event.target);
    const steps = {ArrowRight: 1, ArrowLeft: -1, ArrowDown: n, ArrowUp: -n};
    if (event.key === "Escape") this.enlarge(null);
    else if (event.key in steps) {
      const isAcross = Math.abs(steps[event.key]) === 1;
      for (let to = at + steps[event.key]; this.cells[to]; to += steps[event.key]) {
        if (isAcross && Math.floor(to / n) !== Math.floor(at / n)) break;
        if (!this.cells[to].job) continue;
        this.cells[to].button.focus();
        break;
      }
    } else return;
    event.preventDefault();
  }
}
