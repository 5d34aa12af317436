// SPDX-License-Identifier: MIT
// The page: which sweep and which run are looked at, and who is told when that changes.
import {byId, listen} from "/page/dom.js";
import {QueuePanel} from "/page/queue.js";
import {SweepPanel} from "/page/sweep.js";
import {RunPanel} from "/page/run.js";
import {SubmitForm} from "/page/submit.js";

const run = new RunPanel();
const sweep = new SweepPanel((id) => choose({run: id}));
const queue = new QueuePanel((id) => choose({sweep: id, run: ""}));
new SubmitForm((id) => choose({sweep: id, run: ""}));

/** The address holds what is looked at, so that it can be reloaded: #sweep=s3&run=1f0c... */
function chosen() {
  const words = new URLSearchParams(location.hash.slice(1)), id = words.get("run") ?? "";
  return {sweep: words.get("sweep") ?? "", run: /^[0-9a-f]{16}$/.test(id) ? id : ""};
}

/** Of a narrow screen, which shows one of the three. */
function showTab(tab) {
  document.querySelector("main").dataset.tab = tab;
  for (const button of document.querySelectorAll("#tabs button")) button.setAttribute("aria-pressed", button.dataset.tab === tab);
}
for (const button of document.querySelectorAll("#tabs button")) button.onclick = () => showTab(button.dataset.tab);
showTab("sweep");

function choose(change) {
  showTab(change.run ? "run" : "sweep");
  location.hash = new URLSearchParams({...chosen(), ...change}).toString();
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
  sweep.choose(now.sweep, now.run);
  run.choose(now.run);
  listenTo(now.run);
}

// as in other tables of this kind
window.addEventListener("keydown", (event) => {
  if (event.target.closest?.("input, textarea, select, dialog")) return;
  if (event.key === "/") {
    event.preventDefault();
    showTab("sweep");
    byId("jobs-search").focus();
  } else if (event.key === "?") {
    byId("keys").showModal();
  }
});
window.addEventListener("hashchange", show);
show();
