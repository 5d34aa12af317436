// Numbers of runs: their errors, their marks and their means over replicas, by the rules of `shaken results`.
import {kAverages, kSteadiness} from "./catalogue.js";
import {number} from "./dom.js";

/** Numbers of a summary by path: {"order.mean": 0.9, ...}. */
export function leaves(object, prefix = "", found = {}) {
  for (const [key, value] of Object.entries(object ?? {})) {
    if (typeof value === "number") found[prefix + key] = value;
    else if (value && typeof value === "object" && !Array.isArray(value)) leaves(value, `${prefix}${key}.`, found);
  }
  return found;
}

/** The marks of averages that are of no steady state or not known to be, in the order in which one is named. */
export const kMarks = Object.values(kSteadiness).map(({mark}) => mark).filter(Boolean);
/** What a mark says. */
export const wordOf = (mark) => Object.values(kSteadiness).find((row) => row.mark === mark)?.word ?? "";

/** The mark of a value of a row, "~" or "?"; empty where it is steady, or no average over time. */
export function markOf(row, path) {
  const name = path.startsWith("measured.") ? path.slice("measured.".length, -".value".length) : "";
  const own = row.summary?.measured?.[name]?.steady;
  const isAverage = kAverages.includes(path) || (path.startsWith("measured.") && path.endsWith(".value"));
  const steady = typeof own === "boolean" ? own : row.summary?.steady;
  return isAverage && Number.isFinite(row.values[path]) && steady !== undefined ? kSteadiness[String(steady)].mark : "";
}

/** A number that stands beside the value of a row, "sem" or "n_effective"; NaN where it has none. */
function beside(row, path, what) {
  const block = path === "order.mean" ? "order" : path.startsWith("measured.") ? path.replace(/\.value$/, "") : "";
  const found = block && block !== path ? row.values[`${block}.${what}`] : NaN;
  return Number.isFinite(found) ? found : NaN;
}
export const errorOf = (row, path) => beside(row, path, "sem");

/** "~0.912 ± 0.004": a value with its mark, and the digits that `decimals` of python/shaken/estimate.py gives (tests/vectors/). */
export function valueText(mark, value, error) {
  if (!Number.isFinite(value)) return "";
  if (!(error > 0)) return mark + number(value);
  const exponent = Math.floor(Math.log10(error)), leading = error / 10 ** exponent;
  const digits = Math.min(12, Math.max(0, (leading < 2 ? 1 : 0) - exponent));
  return `${mark}${value.toFixed(digits)} ± ${error.toFixed(digits)}`;
}

/** Mean of replicas and its error: the rule of python/shaken/estimate.py, and as there NaN is not known (tests/vectors/). */
export function replicaMean(values, errors) {
  const n = values.length, mean = values.reduce((sum, one) => sum + one, 0) / n, known = errors.filter(Number.isFinite);
  const within = Math.sqrt(known.reduce((sum, one) => sum + one * one, 0)) / n;
  if (n === 1) return {mean, error: known.length ? within : NaN};
  const scatter = Math.sqrt(values.reduce((sum, one) => sum + (one - mean) ** 2, 0) / (n - 1) / n), x = 1 / (n - 1);
  const student = known.length === n ? 1 : 1 + x * (0.5 + x * (0.25 + x * 0.0625));
  return {mean, error: Math.max(within, student * scatter)};
}

/** Whether a run is done, or was before it went on for longer: the rule of python/shaken/rows.py (tests/vectors/). */
const hasResults = ({state, summary}) =>
  state === "done" || summary?.exit?.state === "done" || summary?.exit?.done_before_s !== undefined;

/** What computed a row; what different versions computed is never averaged. */
const versionOf = (row) => JSON.stringify([row.summary?.versions?.shaken ?? "", row.summary?.versions?.physics ?? 0]);

/** Whether `key` is the same in all jobs of a stage, as what the stages of a protocol set is: no axis beside theirs. */
function isSetByStages(key, jobs) {
  const values = new Map();
  return key !== "stage" && jobs.every(({parameters}) => {
    const {stage} = parameters;
    if (!values.has(stage)) values.set(stage, parameters[key]);
    return stage !== undefined && values.get(stage) === parameters[key];
  });
}

/** Parameters that differ between jobs and are numbers, those with most values first; the seed is no axis. */
export function sweptParameters(jobs) {
  const values = new Map();
  for (const {parameters} of jobs) {
    for (const [key, value] of Object.entries(parameters)) {
      if (typeof value === "number" && key !== "time.seed") values.set(key, (values.get(key) ?? new Set()).add(value));
    }
  }
  return [...values].filter(([key, set]) => set.size > 1 && !isSetByStages(key, jobs)).sort(([, a], [, b]) => b.size - a.size)
    .map(([key, set]) => ({key, values: [...set].sort((a, b) => a - b)}));
}

/**
 * The points of a phase diagram: rows at the same place are replicas, and a run that is listed twice counts once. Where
 * several versions computed them those of the newest count; `nOthers` are left out.
 * `fixed` holds the value of each further parameter: other rows are left out.
 * Returns [{across, up, jobs, states, mean, error, n, nOthers, nEffective, seconds: [shortest, longest], mark, marks}].
 */
export function pointsOf(rows, {x, y, value, fixed = {}}) {
  const places = new Map();
  for (const row of rows) {
    if (!Number.isFinite(row.parameters[x])) continue;
    if (Object.entries(fixed).some(([key, at]) => row.parameters[key] !== at)) continue;
    const across = row.parameters[x], up = y ? row.parameters[y] : undefined, key = JSON.stringify([across, up]);
    const place = places.get(key) ?? {across, up, jobs: [], states: new Set(), found: []};
    places.set(key, place);
    if (place.jobs.includes(row.job)) continue;
    place.jobs.push(row.job);
    place.states.add(row.state);
    if (hasResults(row) && Number.isFinite(row.values[value])) place.found.push(row);
  }
  return [...places.values()].map(({found, ...place}) => {
    const newest = found.map(versionOf).sort((a, b) => a.localeCompare(b, "en", {numeric: true})).at(-1), rows = found.filter((row) => versionOf(row) === newest);
    const marks = new Set(rows.map((row) => markOf(row, value)).filter(Boolean));
    return {
      ...place, n: rows.length, nOthers: found.length - rows.length, marks,
      ...(rows.length ? replicaMean(rows.map((row) => row.values[value]), rows.map((row) => errorOf(row, value))) :
        {mean: NaN, error: NaN}),
      nEffective: rows.map((row) => beside(row, value, "n_effective")).filter(Number.isFinite).reduce((sum, n) => sum + n, 0),
      seconds: rows.map((row) => row.values.sim_seconds).filter(Number.isFinite),
      mark: kMarks.find((each) => marks.has(each)) ?? "",
    };
  });
}

/** What a point's tooltip says, a line each. */
export function pointLines(point, {x, y, value}) {
  const [shortest, longest] = [Math.min(...point.seconds), Math.max(...point.seconds)];
  return [`${x} = ${point.across}`, ...(y ? [`${y} = ${point.up}`] : []),
          `${value} = ${valueText(point.mark, point.mean, point.error) || "unknown"}` +
            (point.n > 1 ? ` (mean of ${point.n} runs)` : ""),
          ...(point.nOthers ? [`${point.nOthers} of other versions left out`] : []),
          ...[...point.marks].map((mark) => `${mark} ${wordOf(mark)}`),
          ...(point.nEffective > 0 ? [`${number(point.nEffective, 3)} independent samples`] : []),
          ...(point.seconds.length ? [`${shortest === longest ? "" : `${number(shortest)} to `}${number(longest)} s simulated` +
            (shortest === longest ? "" : ": runs of different length")] : []),
          [...point.states].join(", ")];
}
