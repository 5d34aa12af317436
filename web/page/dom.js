// SPDX-License-Identifier: MIT
// The few things that every part of the page needs. Text that came from outside is only ever set as text.

export const byId = (id) => document.getElementById(id);

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

/** What the server answers, as JSON. Throws an Error with the server's own words, and with `problems` if it lists any. */
export async function ask(path, body) {
  const request = body === undefined ? {} :
    {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(body)};
  const response = await fetch(path, request);
  const text = await response.text();
  let answer;
  try { answer = JSON.parse(text); } catch { answer = {error: text.trim() || `status ${response.status}`}; }
  if (!response.ok) throw Object.assign(new Error(answer.error), {problems: answer.problems ?? [], status: response.status});
  return answer;
}

/** Seconds as people say them. */
export function duration(seconds) {
  if (!(seconds >= 0)) return "unknown";
  if (seconds < 60) return `${Math.round(seconds)} s`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.round(seconds % 3600 / 60)} min`;
}

export function bytes(n) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let unit = 0;
  for (; n >= 1000 && unit < units.length - 1; ++unit) n /= 1000;
  return `${unit ? n.toFixed(1) : n} ${units[unit]}`;
}

export const number = (x, digits = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(digits))) : "unknown");
