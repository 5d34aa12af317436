// SPDX-License-Identifier: MIT
// The page: which sweep and which run are looked at, and who is told when that changes.
import {byId, complain} from "/page/dom.js";
import {QueuePanel} from "/page/queue.js";
import {SweepPanel} from "/page/map.js";
import {RunPanel} from "/page/run.js";

const run = new RunPanel();
const sweep = new SweepPanel((id) => choose({run: id}));
const queue = new QueuePanel((id) => choose({sweep: id, run: ""}));

/** The address holds what is looked at, so that it can be kept and reloaded: #sweep=s3&run=1f0c... */
function chosen() {
  const words = new URLSearchParams(location.hash.slice(1));
  return {sweep: words.get("sweep") ?? "", run: words.get("run") ?? ""};
}

function choose(change) {
  location.hash = new URLSearchParams({...chosen(), ...change}).toString();
}

function show() {
  const now = chosen();
  queue.choose(now.sweep);
  sweep.choose(now.sweep, now.run);
  run.choose(now.run);
}

window.addEventListener("hashchange", show);
show();

const events = new EventSource("/live");
events.addEventListener("queue", (event) => {
  const now = JSON.parse(event.data);
  if (now.error) {
    byId("daemon").textContent = now.error;
    return;
  }
  const {status} = now;
  byId("daemon").textContent = `shakend ${status.version} on ${status.host}: ${status.slots} ${status.slots === 1 ? "slot" : "slots"}, ` +
    `${status.jobs.running} running, ${status.jobs.queued} queued, ${status.jobs.done} done` +
    (status.lcm.ok ? "" : `; nothing is live: ${status.lcm.message}`);
  queue.note(now.sweeps);
  sweep.note(now.sweeps, now.jobs);
  run.note(now.jobs);
  if (!chosen().sweep && now.sweeps.length) choose({sweep: now.sweeps.at(-1).id});
});
events.onerror = () => {
  if (events.readyState === EventSource.CLOSED) complain("shaken-web answers no more: start it again and reload");
};
