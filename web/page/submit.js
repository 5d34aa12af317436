// The form in which scenes and sweeps are written, checked and submitted. Only a text that the daemon has found good can
// be submitted: each change of it asks for another check.
import {ask, byId, bytes, complain, duration, make, number} from "./dom.js";

const kLargest = 8 << 20;  // bytes of a file; the daemon takes no larger ones
const cpuText = (seconds) => (seconds < 10 ? `${number(seconds, 2)} s` : duration(seconds));

export class SubmitForm {
  /** `submitted(id)` is called with the sweep that has come of it. */
  constructor(submitted) {
    this.submitted = submitted;
    this.file = "the text";
    this.given = "";    // the text as it was opened: one that was changed since is not replaced without a question
    this.checked = "";  // the request that was found good
    this.place = byId("submit");
    byId("open-submit").onclick = byId("first-submit").onclick = () => this.open();
    byId("submit-close").onclick = () => this.place.close();
    byId("submit-check").onclick = () => this.check();
    byId("submit-send").onclick = () => this.send();
    byId("submit-open").onclick = () => byId("submit-file").click();
    byId("submit-file").onchange = ({target}) => { this.read(target.files[0]); target.value = ""; };
    byId("submit-example").onchange = ({target}) => this.begin(target.value);
    for (const name of ["text", "name", "replicas"]) byId(`submit-${name}`).oninput = () => this.forget();
    this.place.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || !event.ctrlKey) return;
      event.preventDefault();
      if (this.isChecked()) this.send();
      else this.check();
    });
    window.addEventListener("dragover", (event) => { if (event.dataTransfer.types.includes("Files")) event.preventDefault(); });
    window.addEventListener("drop", (event) => {
      const [file] = event.dataTransfer.files;
      if (!file) return;
      event.preventDefault();
      this.open();
      this.read(file);
    });
    this.forget();
  }

  async open() {
    if (!this.place.open) this.place.showModal();
    if (this.examples) return;
    try {
      this.examples = (await ask("/examples")).examples;
      byId("submit-example").append(...this.examples.map(({name}) => make("option", {value: name}, name)));
    } catch (problem) {
      complain(problem.message);
    }
  }

  begin(name) {
    const example = this.examples.find((one) => one.name === name);
    if (example) this.put(example.text, "the text");
    byId("submit-example").value = "";
  }

  async read(file) {
    if (!file) return;
    if (file.size > kLargest) this.tell(`${file.name} has ${bytes(file.size)}: no scene is as large`);
    else this.put(await file.text(), file.name);
  }

  put(text, file) {
    const box = byId("submit-text"), isOthers = box.value.trim() && box.value !== this.given;
    if (isOthers && !confirm("Replace the text that you have changed?")) return;
    this.file = file;
    box.value = this.given = text;
    box.setSelectionRange(0, 0);
    box.scrollTop = 0;
    box.focus();
    this.forget();
  }

  request() {
    const name = byId("submit-name").value, replicas = byId("submit-replicas").value;
    return {text: byId("submit-text").value, file: this.file, ...(name && {name}), ...(replicas && {replicas: Number(replicas)})};
  }

  isChecked() { return this.checked !== "" && this.checked === JSON.stringify(this.request()); }

  /** What was found out is of another text now. */
  forget() {
    this.checked = "";
    byId("submit-send").disabled = true;
    for (const place of ["submit-problems", "submit-cost"]) byId(place).replaceChildren();
    this.tell("");
  }

  tell(words) { byId("submit-state").textContent = words; }

  async check() {
    this.forget();
    const request = this.request(), stamp = JSON.stringify(request), isSame = () => stamp === JSON.stringify(this.request());
    this.tell("is being checked");
    try {
      const found = await ask("/v1/sweeps", {...request, dry_run: true});
      if (!isSame()) return;
      this.checked = stamp;
      byId("submit-send").disabled = false;
      const jobs = `${found.n_jobs} ${found.n_jobs === 1 ? "job" : "jobs"}${found.n_done ? `, ${found.n_done} of them done already` : ""}`;
      const [fewest, most] = found.n_rods, rods = fewest === most ? `${most} rods` : `${fewest} to ${most} rods each`;
      this.tell(`${found.name}: nothing is wrong with it. ${jobs}; ${rods}; ${duration(found.simulated_s)} simulated in all.`);
      await this.showCost(request, isSame);
    } catch (problem) {
      if (isSame()) this.showProblems(problem);
    }
  }

  async showCost({text, replicas}, isSame) {
    const place = byId("submit-cost"), note = (words) => place.replaceChildren(make("p", {className: "note"}, words));
    note("What it costs is being measured.");
    while (isSame()) {
      try {
        const cost = await ask("/cost", replicas ? {text, replicas} : {text});
        if (isSame()) place.replaceChildren(this.costTable(cost));
        return;
      } catch (problem) {
        if (!isSame()) return;
        if (problem.status !== 429) return note(`What it costs is not known: ${problem.message}`);
        await new Promise((done) => setTimeout(done, 500));
      }
    }
  }

  costTable({levels}) {
    const row = (tag, ...texts) => make("tr", {}, ...texts.map((text) => make(tag, {}, text)));
    return make("table", {}, make("caption", {className: "note"}, "On this machine, on one core; of a sweep by the run in its middle"),
      make("thead", {}, row("th", "Accuracy", "CPU time", "Disk")),
      make("tbody", {}, ...levels.map((level) => row("td", level.name, cpuText(level.cpu_seconds), bytes(Math.round(level.disk_bytes))))));
  }

  /** All that is wrong, each with its place, to which a click goes. */
  showProblems(problem) {
    const found = problem.problems?.length ? problem.problems : [problem];
    this.tell(problem.problems?.length ? `${found.length} ${found.length === 1 ? "thing is" : "things are"} wrong:` : "");
    byId("submit-problems").replaceChildren(...found.map(({line, column, path, message}) => {
      const words = `${line ? `line ${line}: ` : ""}${path ? `${path}: ` : ""}${message}`;
      return make("li", {}, line ? make("button", {type: "button", onclick: () => this.goTo(line, column)}, words) : words);
    }));
  }

  /** Chooses line `line` of the text from `column` on, both from 1, and brings it into sight. */
  goTo(line, column) {
    const box = byId("submit-text"), lines = box.value.split("\n"), before = lines.slice(0, line - 1).join("\n");
    const start = before.length + (line > 1 ? 1 : 0), length = lines[line - 1]?.length ?? 0;
    box.focus();
    box.setSelectionRange(start + Math.min(length, Math.max(0, (column || 1) - 1)), start + length);
    box.scrollTop = box.scrollHeight * (line - 1) / lines.length - box.clientHeight / 2;
  }

  async send() {
    if (!this.isChecked()) return;
    byId("submit-send").disabled = true;
    try {
      const {sweep} = await ask("/v1/sweeps", JSON.parse(this.checked));
      this.place.close();
      this.submitted(sweep.id);
      this.forget();
    } catch (problem) {
      this.checked = "";
      this.showProblems(problem);
    }
  }
}
