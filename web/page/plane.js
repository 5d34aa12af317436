// The plane that rods are in, and how it repeats itself.

// In frames (proto/frame_t.lcm) a place is a part of the box's side, a heading one of a turn, in so many steps;
const kSteps = 65536;
/** and this is the n_z of a rod that stands, and the height of one at the lid. */
export const kUpright = 32767;

/** The place on a side of the box, 0 to 1. */
export const partOf = (at) => at / kSteps + 0.5;
/** The angle of a heading, in half turns. */
export const halfTurns = (heading) => 2 * heading / kSteps;

/** After what it does so along x and y [mm]; 0 where side walls end it. */
export function periodOf({box_mm: [width, height], walls}) {
  return walls ? [walls.arena === "channel" ? width : 0, 0] : [width, height];
}

/** A distance to the nearest image. */
export const toNearest = (d, period) => (period > 0 ? d - period * Math.round(d / period) : d);
