// A picture or a film of the chosen run, in its place on the page until it is saved or closed.
import {byId, fetched, make, offer} from "./dom.js";
import {Newest} from "./loader.js";

export class ShownFile {
  constructor() {
    this.blob = null;
    this.newest = new Newest((wish) => this.put(...wish));  // one at a time, as shaken-render is asked
    byId("shown-close").onclick = () => this.close();
    byId("shown-save").onclick = () => { if (this.blob) offer(this.blob, this.name); };
    for (const choice of ["style", "size", "format"]) byId(`draw-${choice}`).onchange = () => this.draw();
  }

  /** A picture of frame `index` of a run, as the choices have it. */
  show(run, index) {
    this.what = {run, index};
    this.draw();
  }

  draw() {
    const {run, index} = this.what, [style, size, format] = ["style", "size", "format"].map((choice) => byId(`draw-${choice}`).value);
    const query = new URLSearchParams({frame: index, size, format, ...(style ? {style} : {})});
    byId("draw-choices").hidden = false;
    this.newest.want([`/runs/${run}/picture?${query}`, `${run}-${index}.${format}`, "is being drawn"]);
  }

  film(run, name) {
    byId("draw-choices").hidden = true;
    this.newest.want([`/runs/${run}/files/${name}`, `${run}-${name}`, "is on its way"]);
  }

  async put(path, name, words) {
    const number = this.number = (this.number ?? 0) + 1, place = byId("shown-media"), begin = performance.now();
    this.blob = null;
    this.name = name;
    byId("shown").hidden = false;
    byId("shown-save").disabled = true;
    const tell = () => place.replaceChildren(make("p", {className: "note"}, `${name} ${words}: ${Math.round((performance.now() - begin) / 1000)} s`));
    tell();
    const clock = setInterval(tell, 1000);
    let shown;
    try {
      const response = await fetched(path);
      if (!response.ok) throw new Error((await response.json()).error);
      const blob = await response.blob();
      if (number !== this.number) return;
      this.blob = blob;
      if (this.address) URL.revokeObjectURL(this.address);
      this.address = URL.createObjectURL(blob);
      shown = /\.(mp4|webm)$/.test(name) ? make("video", {src: this.address, controls: true, loop: true, autoplay: true, muted: true})
        : /\.pdf$/.test(name) ? make("p", {className: "note"}, `${name} is ready to be saved.`)
        : make("img", {src: this.address, alt: `Picture of the run: ${name}`});
    } catch (problem) {
      shown = make("p", {className: "note"}, problem.message);
    } finally {
      clearInterval(clock);
    }
    if (number !== this.number) return;
    place.replaceChildren(shown);
    byId("shown-save").disabled = !this.blob;
  }

  close() {
    this.number = (this.number ?? 0) + 1;
    this.blob = this.newest.wish = null;
    byId("shown").hidden = true;
    byId("shown-media").replaceChildren();
  }
}
