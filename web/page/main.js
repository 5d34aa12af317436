// The page: which sweep and which runs are looked at, and who is told when that changes.
import {BesidePanel, kMostBeside} from "./beside.js";
import {byId, complain, listen} from "./dom.js";
import {QueuePanel} from "./queue.js";
import {SweepPanel} from "./sweep.js";
import {RunPanel} from "./run.js";
import {SubmitForm} from "./submit.js";

const run = new RunPanel();
const sweep = new SweepPanel((id, isBeside) => (isBeside ? putBeside(id) : choose({run: id})));
const beside = new BesidePanel((ids) => choose({beside: ids.join(".")}));
const queue = new QueuePanel((id) => choose({sweep: id, run: ""}));
new SubmitForm((id) => choose({sweep: id, run: ""}));

const isRun = (id) => /^[0-9a-f]{16}$/.test(id);
/** The address holds what is looked at, so that it can be reloaded: #sweep=s3&run=1f0c...&beside=1f0c....77aa...&pictures=1 */
function chosen() {
  const words = new URLSearchParams(location.hash.slice(1)), id = words.get("run") ?? "";
  const others = [...new Set((words.get("beside") ?? "").split("."))].filter(isRun).slice(0, kMostBeside);
  return {sweep: words.get("sweep") ?? "", run: isRun(id) ? id : "", ...(others.length ? {beside: others.join(".")} : {}),
          ...(words.has("pictures") ? {pictures: "1"} : {})};
}
const idsBeside = () => chosen().beside?.split(".") ?? [];

/** Puts a run beside the others, or takes it away. */
function putBeside(id) {
  const ids = idsBeside();
  if (ids.includes(id)) choose({beside: ids.filter((one) => one !== id).join(".")});
  else if (ids.length < kMostBeside) choose({beside: [...ids, id].join(".")});
  else complain(`At most ${kMostBeside} runs are shown side by side: take one away first.`);
}
byId("map-pictures").onclick = () => choose({pictures: "pictures" in chosen() ? "" : "1"});
byId("run-beside").onclick = () => { if (chosen().run) putBeside(chosen().run); };

const tabs = /** @type {HTMLElement[]} */ ([...document.querySelectorAll("#tabs button")]);

/** Of a narrow screen, which shows one of the three. */
function showTab(tab) {
  document.querySelector("main").dataset.tab = tab;
  for (const button of tabs) button.setAttribute("aria-pressed", button.dataset.tab === tab);
}
for (const button of tabs) button.onclick = () => showTab(button.dataset.tab);
showTab("sweep");

function choose(change) {
  if (!("beside" in change || "pictures" in change)) showTab(change.run ? "run" : "sweep");
  else if (!change.beside && document.querySelector("main").dataset.tab === "beside") showTab("sweep");
  const next = {...chosen(), ...change};
  for (const key of ["beside", "pictures"]) if (!next[key]) delete next[key];
  location.hash = new URLSearchParams(next).toString();
}

let stop = null, heardRun = null;
/** One stream of events, of the queue and of the chosen run: a browser has but six connections for all of its pages. */
function listenTo(id) {
  if (id === heardRun) return;
  heardRun = id;
  stop?.();
  stop = listen(id ? `/live?run=${id}` : "/live", (name, data) => {
    if (name === "queue") noteQueue(JSON.parse(data));
    else run.note(id, name, data);
  }, gone);
}

let heardAt = null;
/** A bar over the page, for as long as what it shows is old. */
function gone(message) {
  const since = heardAt === null ? "" : ` What is shown is of ${heardAt.toLocaleTimeString()}.`;
  byId("gone").textContent = `${message}${since} The page asks again by itself.`;
  byId("gone").hidden = false;
  byId("daemon").textContent = "no connection";
  document.body.classList.add("stale");
}

function noteQueue(now) {
  if (now.error) {
    gone(now.error);
    return;
  }
  heardAt = new Date();
  byId("gone").hidden = true;
  document.body.classList.remove("stale");
  document.body.classList.toggle("without-sweeps", !now.sweeps.length);
  const {status} = now;
  byId("daemon").textContent = `shakend ${status.version} on ${status.host}: ` +
    `${status.slots} ${status.slots === 1 ? "slot" : "slots"}, ` +
    `${status.jobs.running} running, ${status.jobs.queued} queued, ${status.jobs.done} done` +
    (status.lcm.ok ? "" : `; nothing is live: ${status.lcm.message}`);
  queue.note(now.sweeps);
  sweep.note(now.sweeps, now.jobs);
  run.noteQueue(now.jobs, JSON.stringify(status.jobs));
  if (!chosen().sweep && now.sweeps.length) choose({sweep: now.sweeps.at(-1).id});
}

function show() {
  if (new URLSearchParams(location.hash.slice(1)).has("token")) location.reload();  // which takes it
  const now = chosen();
  queue.choose(now.sweep);
  sweep.choose(now.sweep, now.run, idsBeside(), "pictures" in now);
  run.choose(now.run);
  beside.choose(idsBeside());
  byId("run-beside").setAttribute("aria-pressed", idsBeside().includes(now.run));
  listenTo(now.run);
}

// as in other tables of this kind
window.addEventListener("keydown", (event) => {
  if (event.target.closest?.("input, textarea, select, dialog")) return;
  if (event.key === "/") {
    event.preventDefault();
    showTab("sweep");
    byId("jobs-search").focus();
  } else if (event.key === "b" && !event.ctrlKey && !event.metaKey && !event.altKey) {
    const id = event.target.closest?.("[data-job]")?.dataset.job ?? chosen().run;
    if (id) putBeside(id);
  } else if (event.key === "?") {
    byId("keys").showModal();
  }
});
// A click with Shift on whatever stands for a job puts it beside others, and does nothing else.
window.addEventListener("click", (event) => {
  const id = event.shiftKey && event.target.closest?.("[data-job]")?.dataset.job;
  if (!id) return;
  event.stopPropagation();
  event.preventDefault();
  putBeside(id);
}, {capture: true});
window.addEventListener("hashchange", show);
show();
