// The plane that rods are in, and how it repeats itself.

/** The n_z of a rod that stands, in frames (proto/frame_t.lcm). */
export const kUpright = 32767;

/** After what it does so along x and y [mm]; 0 where side walls end it. */
export function periodOf({box_mm: [width, height], walls}) {
  return walls ? [walls.arena === "channel" ? width : 0, 0] : [width, height];
}

/** A distance to the nearest image. */
export const toNearest = (d, period) => (period > 0 ? d - period * Math.round(d / period) : d);
