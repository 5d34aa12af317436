// The table of a sweep's jobs: all of them, filtered and sorted; only the rows that are seen are elements of the page.
import {byId, make, number, replaceIfOther} from "./dom.js";
import {actionButtons} from "./queue.js";
import {errorOf, markOf, valueText, wordOf} from "./results.js";

const kRow = 28;     // px: the height of a row (page.css)
const kBeyond = 8;   // rows above and below those that are seen
const kColumns = ["id", "state", "value", "label"];

/** "a1b2 running 85": whether all words are somewhere in the job. */
const matches = (job, words) => {
  const text = `${job.id} ${job.state} ${job.label} ${job.reason ?? ""}`.toLowerCase();
  return words.every((word) => text.includes(word));
};

/** "rods.length=3 box.gap=1.2" without the names of the blocks, for a narrow column. */
const shortened = (label) => label.replace(/(^| )(?:[a-z0-9_]+\.)+/g, "$1");

export class JobTable {
  /** `choose(id)` is called when a job is chosen. */
  constructor(choose) {
    this.chooseJob = choose;
    this.frame = byId("jobs-frame");
    this.body = byId("jobs");
    this.order = {column: "", descending: false};
    this.at = 0;  // the row that has the keyboard's focus, among those that are listed
    this.set([], new Map(), "", "", []);
    this.frame.addEventListener("scroll", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.frame);
    byId("jobs-search").oninput = byId("jobs-state").onchange = () => { this.frame.scrollTop = this.at = 0; this.list(); };
    for (const column of kColumns) byId(`sort-${column}`).onclick = () => this.sortBy(column);
    this.body.addEventListener("keydown", (event) => this.key(event));
  }

  /** jobs: as the daemon has them; rows: results by job; value: the name of the one that is shown. */
  set(jobs, rows, value, chosen, beside) {
    this.jobs = jobs;
    this.rows = rows;
    this.value = value;
    this.chosen = chosen;
    this.beside = beside;
    this.list();
  }

  clear() {
    byId("jobs-search").value = byId("jobs-state").value = "";
    this.frame.scrollTop = this.at = 0;
    this.order = {column: "", descending: false};
  }

  sortBy(column) {
    const {order} = this;
    if (order.column !== column) this.order = {column, descending: false};
    else this.order = order.descending ? {column: "", descending: false} : {column, descending: true};
    this.list();
  }

  /** What is listed, in its order. */
  list() {
    const words = byId("jobs-search").value.toLowerCase().split(/\s+/).filter(Boolean), state = byId("jobs-state").value;
    const listed = this.jobs.filter((job) => (!state || job.state === state) && matches(job, words));
    const {column, descending} = this.order, sign = descending ? -1 : 1;
    const valueOf = (job) => this.rows.get(job.id)?.values[this.value] ?? NaN;
    if (column === "value") {  // what has no value comes last, whichever way
      listed.sort((a, b) => Number(Number.isNaN(valueOf(a))) - Number(Number.isNaN(valueOf(b))) || sign * (valueOf(a) - valueOf(b)) || 0);
    } else if (column) {
      listed.sort((a, b) => sign * String(a[column]).localeCompare(String(b[column]), undefined, {numeric: true}));
    }
    this.listed = listed;
    for (const each of kColumns) {
      byId(`sort-${each}`).parentElement.setAttribute("aria-sort",
        each !== column ? "none" : descending ? "descending" : "ascending");
    }
    const states = [...new Set(this.jobs.map((job) => job.state))].sort();
    replaceIfOther(byId("jobs-state"), states.join(), () => [["", "all states"], ...states.map((each) => [each, each])].map(
      ([word, text]) => make("option", {value: word, selected: word === state}, text)));
    byId("jobs-tools").hidden = this.jobs.length < 2;
    const isFiltered = listed.length < this.jobs.length;
    byId("jobs-count").textContent = isFiltered ? `${listed.length} of ${this.jobs.length} jobs` : `${this.jobs.length} jobs`;
    byId("jobs-table").setAttribute("aria-rowcount", listed.length + 1);
    this.at = Math.max(0, Math.min(this.at, listed.length - 1));
    this.draw();
  }

  draw() {
    const {listed, frame, body} = this;
    const n = Math.ceil((frame.clientHeight || 320) / kRow) + 2 * kBeyond;
    const first = Math.max(0, Math.min(Math.floor(frame.scrollTop / kRow) - kBeyond, listed.length - n));
    const shown = listed.slice(first, first + n);
    byId("jobs-above").style.height = `${first * kRow}px`;
    byId("jobs-below").style.height = `${(listed.length - first - shown.length) * kRow}px`;
    // Rows stay: one that is being clicked must not be replaced.
    while (body.children.length > shown.length) body.lastElementChild.remove();
    while (body.children.length < shown.length) body.append(this.newRow());
    shown.forEach((job, i) => this.fill(body.children[i], job, first + i));
  }

  newRow() {
    const row = make("tr", {}, ...["", "", "", "", ""].map(() => make("td")));
    row.onclick = () => { this.at = row.at; this.chooseJob(row.dataset.job); };
    row.onfocus = () => { this.at = row.at; this.draw(); };
    return row;
  }

  fill(row, job, at) {
    const {value} = this, [id, state, told, label, actions] = row.children, result = this.rows.get(job.id);
    const total = job.progress?.sim_time_total_s;
    const part = job.state !== "done" && total > 0 ? ` ${Math.floor(100 * job.progress.sim_time_s / total)} %` : "";
    const mark = result ? markOf(result, value) : "";
    row.at = at;
    row.dataset.job = job.id;
    row.tabIndex = at === this.at ? 0 : -1;
    row.setAttribute("aria-rowindex", at + 2);
    row.setAttribute("aria-selected", String(job.id === this.chosen));
    row.dataset.beside = this.beside.includes(job.id);
    const put = (cell, text, title = "") => {
      if (cell.textContent !== text) cell.textContent = text;
      if (cell.title !== title) cell.title = title;
    };
    put(id, job.id.slice(0, 8));
    put(state, job.state + part, job.reason);
    put(told, result ? valueText(mark, result.values[value], errorOf(result, value)) : "", mark && wordOf(mark));
    put(label, (job.reason ? `${job.reason}; ` : "") + shortened(job.label), [job.reason, job.label].filter(Boolean).join("; "));
    replaceIfOther(actions, `${job.id} ${job.state}`, () => actionButtons(`/v1/jobs/${job.id}`, new Set([job.state])));
  }

  key(event) {
    if (event.target.tagName !== "TR") return;  // a button in a row
    const page = Math.max(1, Math.floor(this.frame.clientHeight / kRow) - 2), last = this.listed.length - 1;
    const steps = {ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity};
    if (event.key === "Enter" || event.key === " ") this.chooseJob(this.listed[this.at].id);
    else if (event.key in steps) this.go(Math.max(0, Math.min(last, this.at + steps[event.key])));
    else return;
    event.preventDefault();
  }

  /** Moves the focus to a row, and brings it into sight. */
  go(at) {
    const {frame} = this, top = at * kRow, seen = frame.clientHeight - kRow;  // less the head, which stays
    this.at = at;
    if (top < frame.scrollTop) frame.scrollTop = top;
    if (top + kRow > frame.scrollTop + seen) frame.scrollTop = top + kRow - seen;
    this.draw();
    [.../** @type {any} */ (this.body.children)].find((row) => row.at === at)?.focus();
  }
}
