// The few things that every part of the page needs. Text that came from outside is only ever set as text.

export const byId = (id) => /** @type {any} */ (document.getElementById(id));

/** An element with properties and children: make("button", {type: "button", onclick: f}, "Hold"). */
export function make(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in element) element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

let hideComplaint = 0;
export function complain(message) {
  const place = byId("complaint");
  place.textContent = message;
  place.hidden = false;
  clearTimeout(hideComplaint);
  hideComplaint = setTimeout(() => { place.hidden = true; }, 8000);
}

// The token comes in the part of the address that is not sent, and is kept for this tab only. Each request carries it.
const inAddress = new URLSearchParams(location.hash.slice(1));
if (inAddress.has("token")) {
  sessionStorage.setItem("token", inAddress.get("token"));
  inAddress.delete("token");
  history.replaceState(null, "", `#${inAddress}`);
}

/** fetch() as one who may. */
export function fetched(path, options = {}) {
  const token = sessionStorage.getItem("token") ?? "";
  return fetch(path, {...options, headers: {...options.headers, Authorization: `Bearer ${token}`}});
}

/** What the page says where nobody answers: what a browser calls it helps nobody. */
export const kSilent = "The page's server does not answer. Start it again with: shaken web";

/** A colour of page.css by its name, as it is now: "ink". */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
/** Calls `changed` when the system's wish for light or dark does. */
export const onTheme = (changed) => matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);

/** What the server answers, as JSON. Throws an Error with the server's own words, and with `problems` if it lists any. */
export async function ask(path, body) {
  const request = body === undefined ? {} :
    {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(body)};
  const response = await fetched(path, request).catch(() => { throw new Error(kSilent); });
  const text = await response.text();
  let answer;
  try { answer = JSON.parse(text); } catch { answer = {error: text.trim() || `status ${response.status}`}; }
  if (!response.ok) throw Object.assign(new Error(answer.error), {problems: answer.problems ?? [], status: response.status});
  return answer;
}

/** Has the browser save a Blob that the page has made. */
export function offer(blob, name) {
  const address = URL.createObjectURL(blob);
  make("a", {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}

/** Has the browser save what GET `path` answers. */
export async function save(path) {
  try {
    const [plain, query] = path.split("?");
    const {ticket} = await ask(`/tickets?path=${encodeURIComponent(plain)}${query ? `&${query}` : ""}`, {});
    location.assign(`/tickets/${ticket}`);
  } catch (problem) {
    complain(problem.message);
  }
}

/**
 * Server-sent events of `path`, for as long as the page is seen: heard(name, data) for each, failed(message) where there
 * are none for a while. (The browser's own EventSource cannot carry a token.) Returns what ends it.
 */
export function listen(path, heard, failed) {
  let ended = false, request = null;
  const once = async () => {
    request = new AbortController();
    const response = await fetched(path, {signal: request.signal});
    if (!response.ok) throw new Error((await response.json()).error);
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    for (let rest = ""; ;) {
      const {value, done} = await reader.read();
      if (done || ended) return;
      const events = (rest + value).split("\n\n");
      rest = events.pop();
      for (const event of events) {
        const [, name, data] = event.match(/^event: (\w+)\ndata: (.*)$/s) ?? [];
        if (name) heard(name, data);
      }
    }
  };
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const shown = () => (document.hidden ? new Promise((done) => document.addEventListener("visibilitychange", done, {once: true})) : null);
  const hide = () => { if (document.hidden) request?.abort(); };
  document.addEventListener("visibilitychange", hide);
  (async () => {
    while (!ended) {
      await shown();
      try { await once(); } catch (problem) {
        if (ended) return;
        if (!document.hidden) {
          failed(problem instanceof TypeError ? kSilent : problem.message);
          await wait(2000);
        }
      }
    }
  })();
  return () => {
    ended = true;
    request?.abort();
    document.removeEventListener("visibilitychange", hide);
  };
}

/** Puts new children in only where they say something else: what is pressed or open stays so. */
export function replaceIfOther(place, stamp, children) {
  if (place.shownStamp === stamp) return;
  place.shownStamp = stamp;
  place.replaceChildren(...children());
}

/** Seconds as people say them: duration_text of base/text.h (tests/vectors/). */
export function duration(seconds) {
  if (!(Number.isFinite(seconds) && seconds >= 0)) return "?";  // null is 0 to a comparison
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  const s = Math.round(seconds), minutes = Math.floor((s + 30) / 60), hours = Math.floor((s + 1800) / 3600);
  const both = (n, of, large, small) => `${Math.floor(n / of)} ${large} ${String(n % of).padStart(2, "0")} ${small}`;
  if (s < 60) return `${s} s`;
  if (s < 3600) return both(s, 60, "min", "s");
  return minutes < 24 * 60 ? both(minutes, 60, "h", "min") : both(hours, 24, "d", "h");
}

/** bytes_text of base/text.h (tests/vectors/). */
export function bytes(n) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let unit = 0;
  for (; n >= 999.5 && unit < units.length - 1; ++unit) n /= 1000;
  return `${Number(n.toPrecision(3))} ${units[unit]}`;
}

export const number = (x, digits = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(digits))) : "unknown");
