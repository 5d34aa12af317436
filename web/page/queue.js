// The list of sweeps, and what can be asked of them and of their jobs.
import {ask, byId, complain, duration, make} from "./dom.js";
import {kJobStates} from "./catalogue.js";

/** "3 done, 2 running" of {state: n}. */
export const countsText = (counts) =>
  Object.entries(counts).filter(([, n]) => n > 0).map(([state, n]) => `${n} ${state}`).join(", ");

export const hasWorker = (job) => Boolean(kJobStates[job?.state]?.has_worker);

export class QueuePanel {
  /** `choose(id)` is called when a sweep is clicked. */
  constructor(choose) {
    this.chooseSweep = choose;
    this.chosen = "";
    this.items = new Map();
  }

  choose(id) {
    this.chosen = id;
    for (const [sweep, item] of this.items) item.button.setAttribute("aria-current", sweep === id);
  }

  note(sweeps) {
    const ids = sweeps.map(({id}) => id);
    for (const [id, {button}] of this.items) {
      if (!ids.includes(id)) this.items.delete(id) && button.parentElement.remove();
    }
    for (const sweep of sweeps) {
      let item = this.items.get(sweep.id);
      if (!item) {
        item = {name: make("span", {className: "name"}), bar: make("progress", {max: 1}),
                counts: make("span", {className: "counts"})};
        item.button = make("button", {type: "button", className: "sweep", "data-sweep": sweep.id,
                                      onclick: () => this.chooseSweep(sweep.id)}, item.name, item.bar, item.counts);
        this.items.set(sweep.id, item);
        byId("sweeps").prepend(make("li", {}, item.button));
      }
      item.name.textContent = `${sweep.id} ${sweep.name}`;
      item.bar.value = sweep.progress;
      const waits = sweep.counts.running + sweep.counts.queued > 0;
      // that of a sweep that is over, and was cancelled half way, would be empty
      item.bar.hidden = sweep.n_ended === sweep.n_jobs;
      item.counts.textContent = countsText(sweep.counts) + (waits && sweep.eta_s >= 0 ? `; ${duration(sweep.eta_s)} to go` : "");
    }
    this.choose(this.chosen);
  }
}

/** Buttons of what can be asked of a sweep or a job; `path` is /v1/sweeps/ID or /v1/jobs/ID, `thing` "all" or "run". */
export function actionButtons(path, states, thing = "") {
  const offered = new Set([...states].flatMap((state) => kJobStates[state]?.requests ?? []));
  const words = {hold: "Hold", resume: "Resume", retry: thing ? `Try ${thing} again` : "Try again", cancel: "Cancel"};
  return Object.entries(words).filter(([action]) => offered.has(action)).map(([action, word]) => make("button", {
    type: "button", "data-action": action, onclick: async (event) => {
      event.stopPropagation();
      if (action === "cancel" && !confirm(`Cancel ${path.split("/").at(-1)}? What it has measured stays.`)) return;
      try { await ask(`${path}/${action}`, {}); } catch (problem) { complain(problem.message); }
    }}, thing && action !== "retry" ? `${word} ${thing}` : word));
}
