// Frames of rods on a canvas that can be zoomed and moved.
import {colour as cssColour, onTheme} from "./dom.js";
import {RodPainter, suitingColouring} from "./painter.js";
import {halfTurns, kUpright, partOf, periodOf, toNearest} from "./plane.js";

/** A frame out of the bytes of docs/web.md. Throws where they contradict themselves. */
export function unpack(buffer) {
  const sizes = new DataView(buffer), size = sizes.getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  const n = head.n_rods, begin = 4 + size;
  const array = (k) => new Int16Array(buffer, begin + 2 * n * k, n);
  const many = head.outlines.length > 1, z = head.has_heights ? array(4) : null, kinds = head.species_of_outline;
  const shape = many ? new Uint8Array(buffer, begin + (z ? 10 : 8) * n, n) : new Uint8Array(n);
  return {...head, x: array(0), y: array(1), heading: array(2), n_z: array(3), z, shape,
          species: kinds.length ? shape.map((k) => kinds[k]) : shape};
}

export function unpackText(text) {
  return unpack(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
}

/** The angle of rod i to the director, in (-90, 90] degrees. */
export function angleToDirector(frame, i) {
  const angle = halfTurns(frame.heading[i]) * 180 - frame.director_rad * 180 / Math.PI;
  return angle - 180 * Math.round(angle / 180);
}

/**
 * The rod at (x, y) [mm from the middle of the view], the nearest of those that cover it, or are no further than `reach`
 * [mm] from that; -1 where there is none.
 */
export function rodAt(frame, view, x, y, reach = 0) {
  let best = -1, least = Infinity;
  const [periodX, periodY] = periodOf(frame);
  for (let i = 0; i < frame.n_rods; ++i) {
    const [length, middle, end] = frame.outlines[frame.shape[i]], theta = halfTurns(frame.heading[i]) * Math.PI;
    const off = (at, from, to, side, period) => toNearest(to - (partOf(at) - from) * side, period);
    const dx = off(frame.x[i], view.x, x, frame.box_mm[0], periodX), dy = off(frame.y[i], view.y, y, frame.box_mm[1], periodY);
    const along = dx * Math.cos(theta) + dy * Math.sin(theta), across = -dx * Math.sin(theta) + dy * Math.cos(theta);
    const flat = length * Math.sqrt(Math.max(0, 1 - (frame.n_z[i] / kUpright) ** 2));
    const beyond = Math.hypot(Math.max(0, Math.abs(along) - flat), across);
    if (beyond <= Math.max(middle, end) + reach && beyond < least) [best, least] = [i, beyond];
  }
  return best;
}

export const kWhole = {x: 0.5, y: 0.5, zoom: 1, orbit: null};
const kRest = 400;  // ms after which a picture from the side is drawn smoothly
const kFirstOrbit = [-30, 35];  // degrees, as `shaken picture --view orbit` has them

export class RodCanvas {
  constructor(canvas, marks, palettes) {
    this.canvas = canvas;
    this.marks = marks;
    this.palettes = palettes;
    this.frame = null;
    this.path = null;  // of one rod: {x_mm, y_mm}
    this.defects = [];
    this.showsDefects = true;
    this.colouring = "auto";
    this.automatic = "";
    this.view = {...kWhole};  // may be shared with other canvases: it is changed in its place
    this.onRod = null;  // what there is to say of a rod that is pointed at, and its number
    this.onView = () => this.draw();
    this.framesDrawn = 0;
    this.painter = new RodPainter(canvas, palettes);
    this.handlePointer();
    this.handleKeys();
    onTheme(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** A browser has but few places for WebGL: this one's is free for others afterwards. */
  close() { this.painter.gl.getExtension("WEBGL_lose_context")?.loseContext(); }

  clear() {
    this.frame = null;
    this.automatic = "";
    this.defects = [];
    this.draw();
  }

  set(frame) {
    this.frame = frame;
    this.automatic = suitingColouring(frame, this.palettes, this.automatic);
    this.draw();
  }

  /** By what the rods are coloured now. */
  chosenColouring() { return this.colouring === "auto" ? this.automatic || "layers" : this.colouring; }

  fitSize() {
    const size = Math.max(1, Math.round(this.canvas.clientWidth * (window.devicePixelRatio || 1)));
    for (const canvas of [this.canvas, this.marks]) {
      if (canvas.width !== size) { canvas.width = size; canvas.height = size; }
    }
    return size;
  }

  /** What has changed is drawn with the browser's next picture: however many changes there were, once. */
  draw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => { this.isDue = false; this.drawNow(); });
  }

  drawNow() {
    const size = this.fitSize(), now = performance.now(), isMoving = this.view.orbit && now - (this.drawnAt ?? 0) < kRest;
    this.drawnAt = now;
    clearTimeout(this.smoothing);
    if (isMoving) this.smoothing = setTimeout(() => this.draw(), 1.5 * kRest);
    this.painter.paint(this.frame, this.view, size, this.chosenColouring(), isMoving);
    this.drawMarks(size);
    ++this.framesDrawn;
  }

  /** Walls, posts, defects and a scale bar, over the rods. */
  drawMarks(size) {
    const {frame, view} = this, context = this.marks.getContext("2d");
    context.clearRect(0, 0, size, size);
    if (!frame) return;
    if (view.orbit) {
      this.write(context, this.viewWords(), size);
      return;
    }
    const [width, height] = frame.box_mm, perMm = size * view.zoom / Math.max(width, height);
    const [periodX, periodY] = periodOf(frame);
    const toPixel = (x, y) => {
      const dx = toNearest(x - view.x * width, periodX), dy = toNearest(y - view.y * height, periodY);
      return [size / 2 + dx * perMm, size / 2 - dy * perMm];
    };
    if (frame.walls) this.drawWalls(context, frame.walls, toPixel(width / 2, height / 2), perMm, size);
    if (frame.posts) this.drawPosts(context, frame.posts, toPixel, perMm);
    if (this.path) this.drawPath(context, toPixel, perMm);
    if (this.showsDefects) for (const one of this.defects) this.drawDefect(context, one, toPixel, size);
    const bar = [1, 2, 5, 10, 20, 50, 100, 200].filter((mm) => mm * perMm < size / 3).at(-1) ?? 1;
    this.write(context, `${bar} mm`, size);
    context.fillRect(size * 0.03, size * 0.965, bar * perMm, Math.max(2, size / 250));
  }

  /** Round the middle of the arena, at (x, y) in pixels. */
  drawWalls(context, {arena, size_mm, inner_mm, length_mm = 0, narrow_mm = 0}, /** @type {number[]} */ [x, y], perMm, size) {
    const [radius, end, narrow] = [size_mm, length_mm, narrow_mm].map((mm) => mm * perMm / 2), quarter = Math.PI / 2;
    context.strokeStyle = cssColour("edge");
    context.lineWidth = 2;
    context.beginPath();
    if (arena === "square") {
      context.rect(x - radius, y - radius, 2 * radius, 2 * radius);
    } else if (arena === "channel") {
      context.rect(-radius, y - radius, size + 2 * radius, 2 * radius);  // its ends are out of sight
    } else if (arena === "ellipse") {
      context.ellipse(x, y, end, radius, 0, 0, 2 * Math.PI);
    } else if (arena === "wedge") {
      for (const [dx, dy] of [[-end, -radius], [end, -narrow], [end, narrow], [-end, radius]]) context.lineTo(x + dx, y + dy);
      context.closePath();
    } else {
      context.arc(x + end, y, radius, -quarter, quarter);
      context.arc(x - end, y, radius, quarter, 3 * quarter);
      context.closePath();
    }
    context.stroke();
    if (arena !== "annulus") return;
    context.beginPath();
    context.arc(x, y, inner_mm * perMm / 2, 0, 2 * Math.PI);
    context.stroke();
  }

  /** Each once, at the image that is nearest to the middle of the view, and the images beside it. */
  drawPosts(context, {diameter_mm, centres_mm}, toPixel, perMm) {
    const [periodX, periodY] = periodOf(this.frame), around = (period) => (period > 0 ? [-1, 0, 1] : [0]);
    context.fillStyle = cssColour("edge");
    for (const centre of centres_mm) {
      const [x, y] = toPixel(...centre);
      for (const i of around(periodX)) {
        for (const j of around(periodY)) {
          context.beginPath();
          context.arc(x + i * periodX * perMm, y + j * periodY * perMm, diameter_mm * perMm / 2, 0, 2 * Math.PI);
          context.fill();
        }
      }
    }
  }

  /** Words in the lower left corner. */
  write(context, words, size) {
    context.fillStyle = cssColour("ink");
    context.strokeStyle = cssColour("panel");
    context.lineWidth = 4;
    context.font = `${Math.max(11, size / 45)}px sans-serif`;
    context.strokeText(words, size * 0.03, size * 0.955);
    context.fillText(words, size * 0.03, size * 0.955);
  }

  /** A line for each step, the short way round. */
  drawPath(context, toPixel, perMm) {
    const {x_mm: x, y_mm: y} = this.path, [periodX, periodY] = periodOf(this.frame);
    for (const [colour, thickness] of [[cssColour("panel"), 5], [cssColour("warm"), 2.5]]) {
      context.strokeStyle = colour;
      context.lineWidth = thickness;
      context.beginPath();
      for (let k = 1; k < x.length; ++k) {
        const [px, py] = toPixel(x[k], y[k]);
        context.moveTo(px, py);
        context.lineTo(px - toNearest(x[k] - x[k - 1], periodX) * perMm, py + toNearest(y[k] - y[k - 1], periodY) * perMm);
      }
      context.stroke();
    }
  }

  /** +1/2: a comet with its tail; -1/2: three arms. */
  drawDefect(context, [x, y, charge, direction], toPixel, size) {
    const [px, py] = toPixel(x, y), reach = Math.max(8, size / 45);
    const arms = charge > 0 ? [direction + Math.PI] : [0, 1, 2].map((k) => direction + 2 * Math.PI * k / 3);
    for (const [colour, width] of [["#000", 5], [charge > 0 ? "#ffd166" : "#8be9fd", 2.5]]) {
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = width;
      context.beginPath();
      for (const angle of arms) {
        context.moveTo(px, py);
        context.lineTo(px + reach * Math.cos(angle), py - reach * Math.sin(angle));
      }
      context.stroke();
      context.beginPath();
      context.arc(px, py, reach / 3.2 + (width > 3 ? 1.5 : 0), 0, 2 * Math.PI);
      context.fill();
    }
  }

  /** What there is to say of the rod under the pointer, if there is one. */
  describe(event) {
    const {frame, view, marks} = this;
    if (!frame || view.orbit) return;
    const width = Math.max(...frame.box_mm) / view.zoom;
    this.tell(rodAt(frame, view, (event.offsetX / marks.clientWidth - 0.5) * width, (0.5 - event.offsetY / marks.clientHeight) * width));
  }

  /** What there is to say of rod i; nothing at -1. */
  tell(i) {
    const {frame} = this, place = (at, side) => (partOf(at) * side).toFixed(2);
    if (!this.onRod) return;
    this.onRod(i < 0 ? "" : `Rod ${i}: x = ${place(frame.x[i], frame.box_mm[0])} mm, y = ${place(frame.y[i], frame.box_mm[1])} mm, ` +
      (frame.order === null ? "" : `${angleToDirector(frame, i).toFixed(1)}° to the director, `) +
      `n_z = ${(frame.n_z[i] / kUpright).toFixed(3)}`, i);
  }

  reset() {
    Object.assign(this.view, kWhole);
    this.onView();
  }

  /** Into the view from the side that was left last, or back to that from above. */
  toggleOrbit() {
    const {view} = this;
    if (view.orbit) this.lastOrbit = view.orbit;
    else if (view.zoom === 1) view.x = view.y = 0.5;
    view.orbit = view.orbit ? null : this.lastOrbit ?? kFirstOrbit;
    this.onRod?.("", -1);
    this.onView();
  }

  /** From where the rods are seen; nothing of the view from above. */
  viewWords() { return this.view.orbit ? `azimuth ${this.view.orbit[0]}°, elevation ${this.view.orbit[1]}°` : ""; }

  /** Turns the eye, by degrees round the box and upwards. */
  turn(round, upwards) {
    const {view} = this, [azimuth, elevation] = view.orbit, turned = azimuth + round;
    view.orbit = [turned - 360 * Math.round(turned / 360), Math.min(90, Math.max(1, elevation + upwards))].map((x) => Math.round(10 * x) / 10);
    this.onView();
  }

  /** How many boxes the view at zoom 1 is wide and high: 1 each of a square one. */
  viewInBoxes() { return (this.frame?.box_mm ?? [1, 1]).map((side, _, sides) => Math.max(...sides) / side); }

  /** Keeps the point under (`across`, `up`), parts of the canvas from its middle, where it is. */
  zoomTo(wanted, across = 0, up = 0) {
    const {view} = this, zoom = Math.min(40, Math.max(1, wanted));
    const [wide, high] = this.viewInBoxes();
    view.x += wide * (across / view.zoom - across / zoom);
    view.y += high * (up / view.zoom - up / zoom);
    view.zoom = zoom;
    this.onView();
  }

  /** Moves the view by parts of the canvas; in orbit, turns it: by half a turn from one side of the canvas to the other. */
  move(across, up) {
    if (this.view.orbit) return this.turn(180 * across, 180 * up);
    const {view} = this, [wide, high] = this.viewInBoxes();
    view.x += wide * across / view.zoom;
    view.y += high * up / view.zoom;
    this.onView();
  }

  handleKeys() {
    const step = 0.1, moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
    this.marks.addEventListener("keydown", (event) => {
      if (event.key === "+" || event.key === "=") this.zoomTo(this.view.zoom * 1.25);
      else if (event.key === "-") this.zoomTo(this.view.zoom / 1.25);
      else if (event.key === "0") this.reset();
      else if (event.key === "o") this.toggleOrbit();
      else if (event.key === "r") { if (this.frame) this.tell(rodAt(this.frame, this.view, 0, 0, Infinity)); }
      else if (event.key in moves) this.move(...moves[event.key]);
      else return;
      event.preventDefault();
    });
  }

  handlePointer() {
    let last = null;
    this.marks.addEventListener("wheel", (event) => {
      event.preventDefault();
      const place = [event.offsetX / this.marks.clientWidth - 0.5, 0.5 - event.offsetY / this.marks.clientHeight];
      this.zoomTo(this.view.zoom * Math.exp(-event.deltaY / 500), ...(this.view.orbit ? [] : place));
    }, {passive: false});
    this.marks.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      this.marks.setPointerCapture(event.pointerId);
    });
    this.marks.addEventListener("dblclick", () => { if (this.view.orbit) this.toggleOrbit(); });
    this.marks.addEventListener("pointerleave", () => this.onRod?.("", -1));
    this.marks.addEventListener("pointermove", (event) => {
      if (!last) return this.describe(event);
      this.move((last[0] - event.clientX) / this.marks.clientWidth, (event.clientY - last[1]) / this.marks.clientHeight);
      last = [event.clientX, event.clientY];
    });
    for (const end of ["pointerup", "pointercancel"]) this.marks.addEventListener(end, () => { last = null; });
  }
}
