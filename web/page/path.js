// The path of one rod over the picture, and its n_z(t), from the recorded frames before the present one.
import {Curve} from "./charts.js";
import {ask, byId} from "./dom.js";
import {Loader} from "./loader.js";

export class RodPath {
  /** `now()` is {run, frame}: what is shown, with the number of the recorded frame, or "last". */
  constructor(canvas, now) {
    this.canvas = canvas;
    this.now = now;
    this.rod = -1;
    this.chart = new Curve(byId("rod-chart"), "t (s)", "n_z");
    this.loader = new Loader(() => this.load(), 200);
  }

  /** The rod that is pointed at; none at -1. */
  follow(rod) {
    if (rod === this.rod) return;
    this.rod = rod;
    this.canvas.path = null;
    this.canvas.draw();
    this.renew();
  }

  /** Another frame is shown. */
  renew() { if (this.rod >= 0) this.loader.want(); }

  clear() {
    this.follow(-1);
    byId("rod-curve").hidden = true;
  }

  async load() {
    const {rod} = this, {run, frame} = this.now();
    if (rod < 0) return;
    const path = await ask(`/runs/${run}/path?rod=${rod}&frame=${frame}`).catch(() => null);  // nothing may be recorded
    if (!path || rod !== this.rod || run !== this.now().run) return;
    this.canvas.path = path;
    this.canvas.draw();
    byId("rod-curve").hidden = false;
    byId("rod-title").textContent = `Rod ${rod}: n_z(t), and its path over the picture`;
    this.chart.set(path.time_s, path.n_z);
  }
}
