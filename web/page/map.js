// The phase diagram of a sweep, which fills in as runs finish.
import {byId, colour, complain, make, number, offer, onTheme, replaceIfOther} from "./dom.js";
import {PointMap, sequential, strip} from "./charts.js";
import {PictureMap} from "./pictures.js";
import {kMarks, pointLines, pointsOf, sweptParameters, wordOf} from "./results.js";

const kPreferred = ["order.mean", "measured.theta_m_deg.value", "n_rods"];
const sorted = (set) => [...set].sort((a, b) => a.localeCompare(b));

export class PhaseMap {
  /** `choose(id, isBeside)` is called when a run is clicked, `changed()` when another number is to be shown. */
  constructor(choose, changed) {
    this.changed = changed;
    // of replicas the one after the chosen one
    this.map = new PointMap(byId("map"), ({jobs}, isBeside) => choose(jobs[(jobs.indexOf(this.run) + 1) % jobs.length], isBeside));
    this.pictures = new PictureMap(choose);
    onTheme(() => this.draw(this.run));
    byId("map-save").onclick = () => this.savePicture();
    this.clear("");
  }

  /** The diagram in pictures of the rods, or in numbers. */
  showPictures(on) {
    if (on === this.pictures.isOn) return;
    byId("map-pictures").setAttribute("aria-pressed", on);
    this.pictures.show(on);
    this.draw(this.run);
  }

  clear(sweep) {
    this.sweep = sweep;
    this.rows = [];
    this.swept = [];
    this.beside = [];
    this.axes = {x: "", y: null, value: "", fixed: {}};
    for (const place of ["map-choices", "map-scale"]) replaceIfOther(byId(place), "", () => []);
    this.draw("");
  }

  /** The results that there are, of these jobs, the chosen run among them. */
  set(jobs, rows, run, beside) {
    this.rows = rows;
    this.beside = beside;
    this.swept = sweptParameters(jobs);
    this.drawChoices();
    this.draw(run);
  }

  drawChoices() {
    const {axes} = this, keys = this.swept.map(({key}) => key), measured = new Set(this.rows.flatMap((row) => Object.keys(row.values)));
    if (!keys.includes(axes.x)) axes.x = keys[0] ?? "";
    const isUpKnown = axes.y === "" || (keys.includes(axes.y) && axes.y !== axes.x);  // "": the value itself
    if (!isUpKnown) axes.y = keys.find((key) => key !== axes.x) ?? null;
    if (!measured.has(axes.value)) axes.value = kPreferred.find((name) => measured.has(name)) ?? sorted(measured)[0] ?? "";
    this.drawFixed();
    const select = (name, title, words, blank) => make("label", {}, `${title} `, make("select", {
      id: `map-${name}`, onchange: (event) => this.choose(name, event.target.value),
    }, ...words.map((word) => make("option", {value: word, selected: word === axes[name]}, word || blank))));
    replaceIfOther(byId("map-choices"), JSON.stringify([keys, sorted(measured)]), () => keys.length ? [
      select("x", "Across", keys), select("y", "Up", ["", ...keys], "the value"), select("value", "Colour", sorted(measured))] : []);
  }

  /** One value for each parameter that is on no axis: a mean over different systems would say nothing. */
  drawFixed() {
    const {axes} = this, further = this.swept.filter(({key}) => key !== axes.x && key !== axes.y);
    axes.fixed = Object.fromEntries(further.map(({key, values}) =>
      [key, values.includes(axes.fixed[key]) ? axes.fixed[key] : values[0]]));
    replaceIfOther(byId("map-fixed"), JSON.stringify([further, axes.fixed]), () => further.map(({key, values}) =>
      make("label", {}, `${key} `, make("select", {
        onchange: (event) => { axes.fixed[key] = values[event.target.selectedIndex]; this.draw(this.run); },
      }, ...values.map((each) => make("option", {selected: each === axes.fixed[key]}, String(each)))))));
  }

  choose(name, word) {
    this.axes[name] = word;
    this.drawFixed();
    this.draw(this.run);
    this.changed();
  }

  draw(run) {
    this.run = run;
    const {axes} = this, {x, y, value} = axes, all = pointsOf(this.rows, axes);
    const means = all.filter(({n}) => n).map(({mean}) => mean), low = Math.min(...means), high = Math.max(...means);
    this.range = [low, high];
    const points = all.filter(({n}) => y || n).map((point) => ({
      x: point.across, y: y ? point.up : point.mean, jobs: point.jobs, text: pointLines(point, axes), bar: y ? NaN : point.error,
      hollow: Boolean(point.mark),
      fill: point.n ? sequential(high > low ? (point.mean - low) / (high - low) : 0.5) : "transparent",
      border: colour(point.states.has("running") ? "warm" : point.states.has("failed") ? "alarm" :
        point.jobs.includes(run) ? "ink" : "edge"),
    }));
    const met = kMarks.filter((mark) => all.some(({marks}) => marks.has(mark)));
    byId("map-marks").textContent = met.length ? `hollow: ${met.map(wordOf).join(" or ")}` : "";
    const inPictures = this.pictures.isOn;
    byId("map-kind").hidden = !all.length;
    byId("map-frame").hidden = byId("map-save").hidden = byId("map-scale").hidden = inPictures || !points.length;
    byId("map-marks").hidden = inPictures;
    if (inPictures) this.pictures.set(all, axes, new Map(this.rows.map((row) => [row.job, row.state])), run, this.beside);
    byId("map").setAttribute("role", "img");
    byId("map").setAttribute("aria-label", `Phase diagram: ${value} against ${x}${y ? ` and ${y}` : ""}, ${points.length} points`);
    this.map.set(points, x, y || value, Boolean(y));
    const bar = make("canvas");
    strip(bar, sequential);
    byId("map-scale").shownStamp = undefined;
    byId("map-scale").replaceChildren(...(means.length && y ? [`${value}: ${number(low)}`, bar, number(high)] : []));
  }

  /** The map as a PNG, as fine as the screen has it, with what it shows and the ends of the colours' scale. */
  async savePicture() {
    const {axes, range: [low, high] = []} = this, note = byId("map-marks").textContent;
    const scale = axes.y && Number.isFinite(low) ? ` from ${number(low)} (dark) to ${number(high)} (bright)` : "";
    const fixed = Object.entries(axes.fixed).map(([key, at]) => `; ${key} = ${at}`).join("");
    const picture = await this.map.picture(`${this.sweep}: ${axes.value}${scale}${fixed}${note ? `; ${note}` : ""}`);
    if (picture) offer(picture, `${this.sweep}-${axes.value}.png`);
    else complain("the browser could not draw the picture");
  }
}
