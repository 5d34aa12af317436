"""The page with a sweep of 1,000 jobs that finish all the time, in a headless Chromium. The daemon is made up here, so
that nothing depends on how fast runs are.

usage: page_of_many_jobs.py WEB-FOLDER SCREENSHOT
WEB-FOLDER is web/ of the source. Exits 1 at the first thing that is wrong."""
import base64
import colorsys
import http.server
import json
import math
import os
import pathlib
import re
import shutil
import signal
import struct
import sys
import tempfile
import threading
import time
import urllib.parse

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

from page import browser, check, eventually

N_JOBS = 1000
VECTORS = pathlib.Path(__file__).resolve().parents[1] / "vectors"
CHART = "/usr/share/javascript/chart.js/chart.min.js"
TYPES = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".html": "text/html"}


# The least contrast of texts to what is behind them, and of the edges of controls, by WCAG 2.1's relative luminance.
CONTRASTS = """
  const channel = (c) => (c /= 255, c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const parsed = (css) => { const n = css.match(/[\\d.]+/g).map(Number); return n.length < 4 || n[3] > 0 ? n.slice(0, 3) : null; };
  const behind = (element) => {
    for (; element; element = element.parentElement) {
      const ground = parsed(getComputedStyle(element).backgroundColor);
      if (ground) return ground;
    }
    return [255, 255, 255];
  };
  const contrast = (a, b) => { const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p); return (x + 0.05) / (y + 0.05); };
  const least = {text: [99, ""], edge: [99, ""]};
  const note = (kind, value, element) => { if (value < least[kind][0]) least[kind] = [value, element.outerHTML.slice(0, 90)]; };
  for (const element of document.querySelectorAll("body *")) {
    if (!element.checkVisibility({checkOpacity: true, checkVisibilityCSS: true}) || element.disabled) continue;
    const style = getComputedStyle(element);
    const hasText = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
    if (hasText) note("text", contrast(parsed(style.color), behind(element)), element);
    if (element.matches("button:not(.head), select, input:not([type=checkbox], [type=range]), textarea"))
      note("edge", contrast(parsed(style.borderTopColor), behind(element.parentElement)), element);
  }
  return least;"""


# What is further to the right than the window, or than the panel that it is in.
STICKS_OUT = """
  const most = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > most) return ["the page"];
  return [...document.querySelectorAll("section, section > *, .chart, canvas, select, button, code")].filter(
    (one) => one.checkVisibility() && !one.closest("#jobs-frame, #pictures") && one.getBoundingClientRect().right >
      Math.min(most, one.parentElement.closest("section")?.getBoundingClientRect().right ?? most) + 0.5
  ).map((one) => one.outerHTML.slice(0, 60));"""


N_FRAMES, N_RODS, BOX_MM = 31, 100, 30
EVERY_S = 0.1


def frame(k, f):
    """Frame f of job k, as web/packed_frame.h has it: rods on a lattice that drift to the right, out of order by k."""
    spread, side = 0.3 + 1.2 * (k % 9) / 9, 10
    x = [-32768 + (6554 * (i % side) + 3000 + 400 * f) % 65536 for i in range(N_RODS)]
    y = [-32768 + 6554 * (i // side) + 3000 for i in range(N_RODS)]
    angles = [spread * math.sin(7.3 * i + 0.02 * f) for i in range(N_RODS)]
    order = math.hypot(sum(math.cos(2 * a) for a in angles), sum(math.sin(2 * a) for a in angles)) / N_RODS
    head = json.dumps({"time_s": EVERY_S * f, "box_mm": [BOX_MM, BOX_MM], "order": order, "director_rad": 0.0, "n_rods": N_RODS,
                       "outlines": [[1.1, 0.4, 0.25]], "species_of_outline": [], "gap_mm": 1.2, "has_heights": True, "walls": None}).encode()
    head += b" " * (-len(head) % 4)
    values = x + y + [round(a / math.pi * 32768) for a in angles] + [1000 * (i % 5) for i in range(N_RODS)]
    values += [4000 * (i % 5 - 2) for i in range(N_RODS)]  # heights around the middle of the gap
    return struct.pack("<I", len(head)) + head + struct.pack(f"<{len(values)}h", *values)


def path(rod, last):
    """The way of that rod: to the right, once around."""
    frames = range(max(0, last - 59), last + 1)
    return {"time_s": [EVERY_S * f for f in frames], "y_mm": [BOX_MM * (6554 * (rod // 10) + 3000) / 65536] * len(frames),
            "x_mm": [BOX_MM * ((6554 * (rod % 10) + 3000 + 400 * f) % 65536) / 65536 for f in frames],
            "n_z": [0.1 * math.sin(f) for f in frames]}


class Daemon:
    """A sweep over area fraction, length and gap with two replicas; its jobs end one after the other when asked about."""

    def __init__(self):
        self.lock = threading.Lock()
        self.n_done = 10
        self.in_flight = self.most_in_flight = 0
        self.loads = []    # times at which the jobs were asked for
        self.since = []    # what results were asked for
        self.is_there = True
        self.old_has_joined = False  # the last job turns out to have ended long ago
        self.is_empty = False
        self.stands = False  # no further job ends
        self.most_rods_in_flight = self.rods_in_flight = 0
        self.newest = []     # of which jobs the newest frame was asked for

    def job(self, k):
        is_old = self.old_has_joined and k == N_JOBS - 1
        is_done = k < self.n_done or is_old
        point = k // 2
        parameters = {"rods.area_fraction": 0.4 + 0.02 * (point % 25), "rods.length": 2.5 + 0.5 * (point // 25 % 10),
                      "box.gap": 1.2 + 0.1 * (point // 250)}
        return {"id": f"{(k * 0x9e3779b97f4a7c15) % 2**64:016x}", "sweep": "s1",
                "state": "done" if is_done else "running" if k == self.n_done else "queued", "reason": "",
                "label": " ".join(f"{key}={value:.4g}" for key, value in parameters.items()), "parameters": parameters,
                "replica": k % 2, "finished_utime": 5 if is_old else 1_000_000 + k if is_done else 0}

    def row(self, k):
        job = self.job(k)
        summary = None
        if job["state"] == "done":
            order = job["parameters"]["rods.area_fraction"] + 0.002 * (k % 2)
            summary = {"n_rods": 433, "sim_seconds": 20.0 if k % 7 else 30.0, "steady": k % 3 > 0,
                       "order": {"mean": order, "sem": 0.01, "n_effective": 12.0},
                       "effects": {"an_observable_with_a_name_that_is_wider_than_any_panel_of_the_page": order}}
        return {**{key: job[key] for key in ("state", "label", "parameters", "replica", "sweep")}, "job": job["id"],
                "directory": "", "summary": summary}

    def counts(self):
        return {"queued": N_JOBS - self.n_done - 1, "held": 0, "running": 1, "stopping": 0, "done": self.n_done, "failed": 0}

    def news(self):
        """What the page's stream says: each time a job more has ended."""
        with self.lock:
            if not self.is_there:
                return {"error": "no daemon: start one with: shakend --root /tmp/x"}
            self.n_done = min(self.n_done + (not self.stands), N_JOBS - 1)
            sweeps = [{"id": "s1", "name": "many", "n_jobs": N_JOBS, "n_ended": self.n_done, "counts": self.counts(),
                       "progress": self.n_done / N_JOBS, "eta_s": 100}]
            return {"status": {"version": "0", "host": "nowhere", "slots": 1, "jobs": {**self.counts()},
                               "lcm": {"ok": True}}, "sweeps": [] if self.is_empty else sweeps, "jobs": [self.job(self.n_done)]}

    def index_of(self, run):
        """Of the job with that id."""
        return int(run, 16) * pow(0x9e3779b97f4a7c15, -1, 2**64) % 2**64

    def of_run(self, run, what, query):
        """What the files of a run hold: bytes of a frame, or JSON."""
        k = self.index_of(run)
        if self.job(k)["state"] == "queued":
            return None
        if what == "newest":
            with self.lock:
                self.newest.append(k)
                self.rods_in_flight += 1
                self.most_rods_in_flight = max(self.most_rods_in_flight, self.rods_in_flight)
            time.sleep(0.02)
            with self.lock:
                self.rods_in_flight -= 1
            return frame(k, N_FRAMES - 1 if self.job(k)["state"] == "done" else len(self.newest) % N_FRAMES)
        if what == "path":
            return path(int(query["rod"][0]), N_FRAMES - 1 if query["frame"] == ["last"] else int(query["frame"][0]))
        if what.startswith("frames/"):
            return frame(k, int(what.split("/")[1]))
        return {"frames": {"n": N_FRAMES, "first_s": 0, "last_s": EVERY_S * (N_FRAMES - 1)}, "files": {"files": []},
                "order": {"time_s": [0, 1, 2, 3], "order": [0.9, 0.8, 0.7, 0.6]}}.get(what)

    def answer(self, path, query):
        of_run = re.fullmatch("/runs/([0-9a-f]{16})/(.*)", path)
        if of_run:
            return self.of_run(*of_run.groups(), query)
        if path.startswith("/v1/jobs/"):
            return {"job": self.job(self.index_of(path.split("/")[-1]))}
        with self.lock:
            self.in_flight += 1
            self.most_in_flight = max(self.most_in_flight, self.in_flight)
        try:
            if path == "/v1/sweeps/s1":
                self.loads.append(time.monotonic())
                return {"jobs": [self.job(k) for k in range(N_JOBS)]}
            if path == "/v1/results":
                since = int(query.get("since", ["0"])[0])
                self.since.append(since)
                return {"rows": [self.row(k) for k in range(N_JOBS) if self.job(k)["finished_utime"] >= since]}
            return {"/v1/sweeps": {"name": "<b>many</b>", "n_jobs": 12, "n_done": 3, "n_rods": [98, 433], "simulated_s": 240.0},
                    "/examples": {"examples": [{"name": "a small box", "text": "{}"}]},
                    "/cost": {"levels": [
                        {"name": name, "cpu_seconds": cpu, "disk_bytes": 3.4e7}
                        for name, cpu in (("as written", 1234.5), ("draft", 160), ("desk", 740.7), ("paper", 1234.5))]}}.get(path)
        finally:
            with self.lock:
                self.in_flight -= 1


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    daemon = None
    folder = None

    def log_message(self, *_):
        pass

    def reply(self, body, type_, status=200):
        self.send_response(status)
        self.send_header("Content-Type", type_)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        url = urllib.parse.urlsplit(self.path)
        if url.path == "/live":
            return self.stream(urllib.parse.parse_qs(url.query).get("run", [""])[0])
        if url.path == "/palettes.json":
            hues = [sum(round(255 * c) << 8 * n for n, c in enumerate(colorsys.hsv_to_rgb(h / 24, 0.6, 0.9))) for h in range(24)]
            return self.reply(json.dumps({name: hues for name in ("layers", "wheel", "tilt", "species", "others")}
                                         | {"floor": 0, "wall": 0, "order_of_layers": 0.7, "order_margin": 0.1, "full_tilt": 0.3}).encode(), "application/json")
        if url.path.startswith(("/v1/", "/runs/", "/examples", "/cost")):
            answer = self.daemon.answer(url.path, urllib.parse.parse_qs(url.query))
            if isinstance(answer, bytes):
                return self.reply(answer, "application/octet-stream")
            status = 404 if answer is None else 200
            return self.reply(json.dumps(answer or {"error": "not in this test"}).encode(), "application/json", status)
        name = {"/": "page/index.html", "/chart.js": CHART}.get(url.path, url.path[1:])
        file = pathlib.Path(name) if name.startswith("/usr") else self.folder / name
        if not file.is_file():
            return self.reply(b"no such file", "text/plain", 404)
        return self.reply(file.read_bytes(), TYPES[file.suffix])

    def do_POST(self):
        self.rfile.read(int(self.headers["Content-Length"]))
        self.do_GET()

    def stream(self, run):
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        try:
            if run and self.daemon.job(self.daemon.index_of(run))["state"] == "running":
                self.say("order", json.dumps({"time_s": [1.5, 2, 2.5], "order": [0.5, 0.4, 0.3]}))
                self.say("frame", base64.b64encode(frame(self.daemon.index_of(run), 25)).decode())
            while True:
                self.say("queue", json.dumps(self.daemon.news()))
                time.sleep(0.1)
        except OSError:  # the browser has gone
            self.close_connection = True


    def say(self, event, data):
        self.wfile.write(f"event: {event}\ndata: {data}\n\n".encode())
        self.wfile.flush()


def use(page, address, daemon):
    def find(css):
        return page.find_element(By.CSS_SELECTOR, css)

    def rows():
        return page.find_elements(By.CSS_SELECTOR, "#jobs tr")

    def shown():
        return page.execute_script("return [...document.querySelectorAll('#jobs tr')].map((row) => row.innerText)")

    def count():
        return find("#jobs-count").text

    page.get(address + "#sweep=s1")
    eventually(lambda: rows() and count() == f"{N_JOBS} jobs", "all jobs are listed while they end all the time")
    check(len(rows()) < 60, f"by as many rows as are seen: {len(rows())}")
    done = daemon.n_done
    eventually(lambda: page.execute_script("return Chart.getChart('map').points.filter((p) => p.fill !== 'transparent').length") > 5,
               "the phase diagram has its first points")
    eventually(lambda: daemon.n_done > done + 20 and len(daemon.loads) > 2, "it is asked again as they end")
    check(daemon.most_in_flight == 1, f"never two questions at a time: {daemon.most_in_flight}")
    gaps = [b - a for a, b in zip(daemon.loads, daemon.loads[1:])]
    check(min(gaps) > 0.9, f"at most once a second: {gaps}")
    eventually(lambda: sum(since > 0 for since in daemon.since) > 1, "later only for what has ended since")
    check(find("#map-fixed").text.startswith("box.gap"), "a third parameter has one value: no mean over different systems")
    words = page.execute_script("return Chart.getChart('map').points[0].text")
    check(any("(mean of 2 runs)" in line for line in words), f"replicas are one point: {words}")
    check(any("24 independent samples" in line for line in words) and any("20 to 30 s simulated" in line for line in words),
          f"with their samples and lengths: {words}")
    check(any(line.startswith("order.mean = ~0.4") and "±" in line for line in words), f"and a mark and an error: {words}")

    wrong = page.execute_async_script("""
        const [cases, done] = arguments, isEqual = (a, b) => b === null ? Number.isNaN(a) : Math.abs(a - b) <= 1e-14;
        import("/page/results.js").then(({replicaMean}) => done(cases.filter(({values, errors, mean, error}) => {
          const found = replicaMean(values, errors.map((each) => each ?? NaN));
          return !isEqual(found.mean, mean) || !isEqual(found.error, error);
        }).map(({why}) => why)));""", json.loads((VECTORS / "replica_mean.json").read_text()))
    check(not wrong, f"means and errors are those of `shaken results`: {wrong}")
    wrong = page.execute_async_script("""
        const [cases, done] = arguments;
        import("/page/results.js").then(({leaves, pointsOf}) => done(cases.filter(({rows, value, mean, n, mark}) => {
          const [point] = pointsOf(rows.map((row) => ({...row, values: leaves(row.summary)})), {x: "x", value});
          return point.mean !== mean || point.n !== n || point.mark !== mark;
        }).map(({why}) => why)));""", json.loads((VECTORS / "points.json").read_text()))
    check(not wrong, f"points are those of `shaken results --aggregate`: {wrong}")
    wrong = page.execute_async_script("""
        const [{value_text}, done] = arguments;
        import("/page/results.js").then(({valueText}) => done(value_text.filter(
          ([value, error, text]) => valueText("", value, error) !== text)));""", json.loads((VECTORS / "words.json").read_text()))
    check(not wrong, f"values and errors have the digits of Python's: {wrong}")
    wrong = page.execute_async_script("""
        const [{duration_text, bytes_text}, done] = arguments;
        import("/page/dom.js").then(({bytes, duration}) => done([...duration_text.filter(([n, text]) => duration(n) !== text),
          ...bytes_text.filter(([n, text]) => bytes(n) !== text)]));""", json.loads((VECTORS / "words.json").read_text()))
    check(not wrong, f"times and sizes are written as on the terminal: {wrong}")
    point = page.execute_async_script("""
        const done = arguments[0], row = (job, physics, mean) => ({job, state: "done", parameters: {x: 1},
          summary: {versions: {shaken: "0.1.0", physics}, steady: true}, values: {"order.mean": mean}});
        import("/page/results.js").then(({pointsOf}) => done(pointsOf(
          [row("a", 3, 0.1), row("b", 4, 0.5), row("c", 4, 0.7), row("c", 4, 0.7)], {x: "x", value: "order.mean"})[0]));""")
    check(abs(point["mean"] - 0.6) < 1e-12 and point["n"] == 2 and point["nOthers"] == 1, f"no mean over versions: {point}")

    click = "Chart.getChart('map').options.onClick({native: {}}, [{index: 0}]); return location.hash"
    seen = set()
    for _ in range(2):
        before = page.current_url
        page.execute_script(click)
        eventually(lambda: page.current_url != before, "a click on a point chooses a run")
        time.sleep(0.2)
        seen.add(page.current_url.split("run=")[1][:16])
    check(seen == {daemon.job(0)["id"], daemon.job(1)["id"]}, f"another click the next replica: {seen}")
    ticks = page.execute_script("return Chart.getChart('map').scales.x.ticks.map(({value}) => value)")
    swept = {daemon.job(k)["parameters"]["rods.area_fraction"] for k in range(N_JOBS)}
    check(len(ticks) > 3 and set(ticks) <= swept, f"ticks are at values that were swept: {ticks}")

    find("#jobs-search").send_keys("running")
    eventually(lambda: count() == f"1 of {N_JOBS} jobs", "words filter the table")
    find("#jobs-search").clear()
    find("#jobs-search").send_keys("fraction=0.88 length=7")
    eventually(lambda: count() == f"4 of {N_JOBS} jobs" and all("0.88" in text for text in shown()), "all of them count")
    find("#jobs-search").clear()
    find("#jobs-search").send_keys(" ")
    Select(find("#jobs-state")).select_by_value("queued")
    eventually(lambda: all("queued" in text for text in shown()) and "of" in count(), "so does a state")
    Select(find("#jobs-state")).select_by_value("")

    daemon.old_has_joined = True
    find("#jobs-search").send_keys(daemon.job(N_JOBS - 1)["id"])
    eventually(lambda: len(shown()) == 1 and "0.88" in shown()[0].split("fraction")[0],
               "a job that joins after its end has its result, too")
    find("#jobs-search").clear()
    find("#jobs-search").send_keys(" ")
    find("#sort-value").click()
    find("#sort-value").click()
    eventually(lambda: "0.88" in shown()[0] and find("th:nth-child(3)").get_attribute("aria-sort") == "descending",
               "a click on a column's head sorts, another one the other way")
    find("#sort-value").click()
    eventually(lambda: find("th:nth-child(3)").get_attribute("aria-sort") == "none", "a third one leaves the order as it was")

    with daemon.lock:  # no job ends between
        daemon.stands = True
        running = daemon.job(daemon.n_done)["id"]
    page.execute_script("location.hash = arguments[0]", f"sweep=s1&run={running}")
    eventually(lambda: page.execute_script("""return Chart.getChart("order-chart").data.datasets[0].data.map(({x, y}) => `${x} ${y}`)""")
               == ["0 0.9", "1 0.8", "1.5 0.5", "2 0.4", "2.5 0.3"], "S(t) of a run at work begins with what it has recorded")
    daemon.stands = False

    first = page.execute_script("return document.querySelector('#jobs tr').dataset.job")
    find("#jobs tr[tabindex='0']").send_keys(Keys.ARROW_DOWN)
    check(page.execute_script("return document.activeElement.dataset.job") == daemon.job(1)["id"], "an arrow goes to the next job")
    page.switch_to.active_element.send_keys(Keys.END)
    last = daemon.job(N_JOBS - 1)["id"]
    eventually(lambda: page.execute_script("return document.activeElement.dataset.job") == last, "the last job can be reached")
    check(page.execute_script("""const row = document.activeElement.getBoundingClientRect();
        const frame = document.getElementById("jobs-frame").getBoundingClientRect();
        return row.top >= frame.top && row.bottom <= frame.bottom + 1;"""), "and is seen")
    page.switch_to.active_element.send_keys(Keys.ENTER)
    eventually(lambda: f"run={last}" in page.current_url, "Enter chooses it")
    eventually(lambda: find("#jobs tr[aria-selected='true']").get_attribute("data-job") == last, "it is marked")
    page.switch_to.active_element.send_keys(Keys.HOME)
    eventually(lambda: page.execute_script("return document.activeElement.dataset.job") == first, "Home goes back")
    page.switch_to.active_element.send_keys("/")
    check(page.switch_to.active_element.get_attribute("id") == "jobs-search", "/ goes to the search")
    images = page.execute_async_script("""
        const done = arguments[arguments.length - 1];
        import("/page/painter.js").then(({instancesOf}) => {
          const n = 2000, place = (k) => Int16Array.from({length: n}, (_, i) => ((i * k) % 65536) - 32768);
          const frame = {n_rods: n, box_mm: [80, 80], walls: null, outlines: [[2, 0.4, 0.25]], x: place(7919), y: place(104729),
                         heading: place(31), n_z: new Int16Array(n), shape: new Uint8Array(n)};
          const whole = instancesOf(frame, {x: 0.5, y: 0.5, zoom: 1}), shifted = instancesOf(frame, {x: 0.1, y: 0.9, zoom: 1});
          // the slow twin: every image of every rod
          const seen = (view, high = 2) => {
            let count = 0;
            for (let i = 0; i < n; ++i) for (let dx = -2; dx <= 2; ++dx) for (let dy = -high; dy <= high; ++dy) {
              const off = (at, middle, d) => Math.abs((at / 65536 + 0.5 - middle + d) * 80);
              count += off(frame.x[i], view.x, dx) <= 42.25 && off(frame.y[i], view.y, dy) <= 42.25;
            }
            return count;
          };
          done([whole.count, seen({x: 0.5, y: 0.5}), shifted.count, seen({x: 0.1, y: 0.9}),
                instancesOf({...frame, walls: {}}, {x: 0.5, y: 0.5, zoom: 1}).count,
                instancesOf({...frame, walls: {arena: "channel"}}, {x: 0.1, y: 0.9, zoom: 1}).count, seen({x: 0.1, y: 0.9}, 0)]);
        });""")
    check(images[0] == images[1] and images[2] == images[3] and 2000 < images[0] < 2400 and images[4] == 2000
          and images[5] == images[6],
          f"of a rod only those images are drawn that are seen: {images}")
    drawn = page.execute_async_script("""
        const done = arguments[arguments.length - 1], canvas = window.shakenRods, before = canvas.framesDrawn;
        for (let k = 0; k < 20; ++k) canvas.clear();
        requestAnimationFrame(() => requestAnimationFrame(() => done(canvas.framesDrawn - before)));""")
    check(drawn == 1, f"many changes are one picture: {drawn}")
    daemon.n_done = max(daemon.n_done, 300)  # however often the page has asked by now
    daemon.stands = True
    find("#map-pictures").click()
    drawn = """return [...document.querySelectorAll("#pictures .picture")].filter((one) => one.querySelector("canvas").width > 20)
        .map((one) => one.dataset.job)"""
    eventually(lambda: len(page.execute_script(drawn)) > 12, "the phase diagram is shown in pictures of the rods")
    in_sight = page.execute_script("""const seen = [...document.querySelectorAll("#pictures .picture")].filter((one) => {
        const {top, left, right, bottom} = one.getBoundingClientRect(), frame = document.getElementById("pictures").getBoundingClientRect();
        return right > frame.left && left < frame.right && bottom > frame.top && top < Math.min(innerHeight, frame.bottom); });
      return [seen, seen.filter((one) => !one.innerText.includes("queued"))].map((ones) => ones.map((one) => one.dataset.job))""")
    in_sight, begun = map(set, in_sight)  # a queued one may begin while this waits
    check(daemon.most_rods_in_flight == 1, "never two at a time")
    eventually(lambda: begun <= set(page.execute_script(drawn)) <= in_sight, f"of all that are in sight and have begun: {len(begun)}")
    time.sleep(1.5)
    asked = {daemon.job(k)["id"] for k in daemon.newest}
    check(asked <= in_sight and len(in_sight) < 200, "and of no others")
    renewed = len(set(daemon.newest)), len(daemon.newest)
    time.sleep(1)
    check(len(set(daemon.newest)) == renewed[0] and len(daemon.newest) - renewed[1] <= 1,
          "what is done is loaded once, what is at work every three seconds")
    of_jobs = [find(f"#pictures [data-job='{job}']") for job in page.execute_script(drawn)]
    cell = next(one for one in of_jobs if one.text == "")  # done
    ActionChains(page).move_to_element(cell).perform()
    eventually(lambda: "t = 3.000 s" in find("#picture").text and "order.mean" in find("#picture").text and page.execute_script(
        "return document.getElementById('picture-large').width") > 200, "the picture under the pointer is shown large, with its numbers")
    page.execute_script("arguments[0].focus()", cell)
    cell.send_keys(Keys.ARROW_RIGHT)
    other = page.switch_to.active_element
    check(other.get_attribute("class") == "picture" and other != cell, "an arrow goes to the next picture")
    other.send_keys(Keys.ESCAPE)
    check(not find("#picture").is_displayed(), "Escape hides the large one")
    other.send_keys(Keys.ENTER)
    eventually(lambda: f"run={other.get_attribute('data-job')}" in page.current_url, "Enter chooses its run")
    side_by_side(page, daemon, other.get_attribute("data-job"))
    find("#map-pictures").click()
    eventually(lambda: find("#map-frame").is_displayed() and not find("#pictures").is_displayed(), "and the numbers are there again")
    daemon.stands = False
    errors = [line["message"] for line in page.get_log("browser") if line["level"] == "SEVERE" and "404" not in line["message"]]
    check(not errors, f"the browser complains of nothing: {errors}")


def side_by_side(page, daemon, chosen):
    """Runs that are chosen with the keyboard and with Shift, on one clock."""
    def find(css):
        return page.find_element(By.CSS_SELECTOR, css)

    def notes():
        return [one.text for one in page.find_elements(By.CSS_SELECTOR, ".pane .note")]

    def heads():
        return [one.text for one in page.find_elements(By.CSS_SELECTOR, ".pane h3")]

    page.switch_to.active_element.send_keys("b")
    eventually(lambda: f"beside={chosen}" in page.current_url and len(heads()) == 1, "b puts a run beside others")
    cells = page.find_elements(By.CSS_SELECTOR, "#pictures .picture[data-beside='false']")
    shown = [one for one in cells if one.text == "" and one.get_attribute("data-job")]
    ActionChains(page).key_down(Keys.SHIFT).click(shown[1]).key_up(Keys.SHIFT).perform()
    eventually(lambda: len(notes()) == 2 and all("t = 3.000 s, S = " in note for note in notes()), "so does a click with Shift")
    check(f"run={chosen}" in page.current_url, "which does not choose it")
    eventually(lambda: all(re.search("(area_fraction|length) = ", head) and "gap" not in head for head in heads()),
               f"each headline says what differs: {heads()}")
    page.refresh()
    eventually(lambda: len(notes()) == 2 and all("t = 3.000 s" in note for note in notes()), "the address keeps them")
    check(find("#pictures").is_displayed() and "pictures=1" in page.current_url, "and that the diagram is in pictures")
    for theme in ("light", "dark"):
        page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": theme}]})
        time.sleep(0.3)
        least = page.execute_script(CONTRASTS)
        check(least["text"][0] >= 4.5 and least["edge"][0] >= 3, f"{theme}: pictures and runs side by side are legible: {least}")
    page.find_elements(By.CSS_SELECTOR, ".pane .marks")[1].send_keys("+", "o")
    seen = page.execute_script("return window.shakenBeside.panes.map(({canvas}) => canvas.view)")
    check(seen[0] == seen[1] and seen[0]["zoom"] > 1 and seen[0]["orbit"], f"runs side by side have one view: {seen}")
    check(find("#beside-orbit").get_attribute("aria-pressed") == "true", "of which a button tells")
    page.find_elements(By.CSS_SELECTOR, ".pane .marks")[0].send_keys("0")
    find("#beside-time").send_keys(Keys.HOME)
    eventually(lambda: all("t = 0.000 s" in note for note in notes()), "one slider moves all, by keys too")
    find("#beside-time").send_keys(Keys.ARROW_RIGHT)
    eventually(lambda: all("t = 0.100 s" in note for note in notes()), "frame by frame")
    find("#beside-play").click()
    eventually(lambda: all("t = 3.000 s" in note for note in notes()) and find("#beside-play").text == "Play", "they play to the end")
    kinds = "return window.shakenBeside.panes.map(({canvas}) => canvas.chosenColouring())"
    check(len(set(page.execute_script(kinds))) == 1, "in the same colours")
    Select(find("#beside-colouring")).select_by_value("tilt")
    check(page.execute_script(kinds) == ["tilt", "tilt"], "whichever are chosen")
    running = daemon.job(daemon.n_done)["id"]
    page.execute_script("location.hash = location.hash.replace(/beside=[^&]*/, `$&.${arguments[0]}`)", running)
    eventually(lambda: len(heads()) == 3 and "(running)" in heads()[2], "a run at work is put beside them")
    before = notes()[2] if len(notes()) > 2 else ""
    eventually(lambda: len(notes()) == 3 and notes()[2] not in ("", before), "and is live")
    page.execute_script("for (const k of [1, 2]) document.querySelectorAll('#jobs tr')[k].dispatchEvent("
                        "new KeyboardEvent('keydown', {key: 'b', bubbles: true}))")
    eventually(lambda: "At most 4" in find("#complaint").text or len(heads()) == 4, "there are four at most")
    eventually(lambda: len(heads()) <= 4 and page.current_url.split("beside=")[1].count(".") <= 3, "also in the address")
    find(".pane button").click()
    eventually(lambda: f"beside={chosen}" not in page.current_url, "one is taken away")
    find("#beside-close").click()
    eventually(lambda: "beside" not in page.current_url and not find("#beside").is_displayed(), "then all")


def use_by_everybody(page, daemon, pictures):
    """Small and large screens, light and dark, without a daemon, without a sweep, without a mouse."""
    def find(css):
        return page.find_element(By.CSS_SELECTOR, css)

    for theme in ("light", "dark"):
        page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": theme}]})
        for width in (390, 768, 1024, 1440):
            page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                 {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
            time.sleep(0.3)
            for tab in page.find_elements(By.CSS_SELECTOR, "#tabs button:not([hidden])") if width < 700 else [None]:
                if tab:
                    tab.click()
                    time.sleep(0.2)
                try:
                    eventually(lambda: not page.execute_script(STICKS_OUT), f"{theme}, {width} pixels, {tab.text if tab else 'all'}: nothing sticks out")
                finally:
                    page.save_screenshot(f"{pictures}-{theme}-{width}{'-' + tab.text if tab else ''}.png")
            if width in (390, 1440):
                page.execute_script("document.getElementById('open-submit').click()")
                find("#submit-text").clear()
                find("#submit-text").send_keys('{"rods": {"area_fraction": 0.7}}')
                find("#submit-check").click()
                eventually(lambda: "12 jobs, 3 of them done already" in find("#submit-state").text and "20 min 35 s" in
                           find("#submit-cost").text, f"{theme}, {width} pixels: a scene is checked, with its cost")
                check(not page.execute_script(STICKS_OUT), "and nothing sticks out")
                page.save_screenshot(f"{pictures}-{theme}-{width}-submit.png")
                if width == 1440:
                    least = page.execute_script(CONTRASTS)
                    check(least["text"][0] >= 4.5 and least["edge"][0] >= 3, f"{theme}: the form is legible: {least}")
                find("#submit-close").click()
        least = page.execute_script(CONTRASTS)
        check(least["text"][0] >= 4.5, f"{theme}: every text is legible: {least['text']}")
        check(least["edge"][0] >= 3, f"{theme}: every control has an edge: {least['edge']}")

    find("#marks").send_keys("r")
    eventually(lambda: "° to the director, n_z = " in find("#rod-facts").text, "the rod in the middle says its numbers by a key")
    lines = "return Chart.getChart('rod-chart').data.datasets[0].data.length"
    eventually(lambda: find("#rod-chart").is_displayed() and page.execute_script(lines) == N_FRAMES, "its n_z(t) is drawn")
    check(page.execute_script("return window.shakenRods.path.x_mm.length") == N_FRAMES, "and its path")
    page.save_screenshot(f"{pictures}-path.png")
    page.execute_script("const time = document.getElementById('time'); time.value = 9; time.dispatchEvent(new Event('input'))")
    eventually(lambda: page.execute_script(lines) == 10, "up to the frame that is shown")
    ActionChains(page).move_to_element(find("#rod-chart")).perform()
    eventually(lambda: page.execute_script("const {opacity, body} = Chart.getChart('rod-chart').tooltip;"
                                           "return opacity > 0 && body[0].lines.join(' ')").startswith("t (s): "),
               "the curve under the pointer says its numbers")
    before = page.execute_script("return window.shakenRods.view.zoom")
    find("#marks").send_keys("+")
    find("#marks").send_keys(Keys.ARROW_RIGHT)
    view = page.execute_script("return window.shakenRods.view")
    check(view["zoom"] > before and view["x"] > 0.5, f"rods are zoomed and moved by keys: {view}")
    find("#marks").send_keys("0")
    check(page.execute_script("return window.shakenRods.view.zoom") == 1, "and seen as a whole again")
    from_the_side(page, pictures)
    find("#marks").send_keys("?")
    eventually(lambda: find("#keys").is_displayed(), "? shows the keys")
    find("#keys button").click()
    nameless = page.execute_script("""return [...document.querySelectorAll("canvas, input, select, textarea, dialog")].filter(
        (one) => one.id && !one.getAttribute("aria-label") && !one.getAttribute("aria-labelledby") && !one.closest("label")
          && one.getAttribute("aria-hidden") !== "true").map((one) => one.id);""")
    check(not nameless, f"what is no text has a name: {nameless}")

    daemon.is_there = False
    eventually(lambda: "shakend --root /tmp/x" in find("#gone").text and "What is shown is of" in find("#gone").text,
               "a bar says that the daemon is gone, and what to type")
    page.save_screenshot(f"{pictures}-gone.png")
    daemon.is_there = True
    eventually(lambda: not find("#gone").is_displayed(), "and goes when it is back")
    daemon.is_empty = True
    eventually(lambda: "shaken submit" in find("#no-sweeps").text and not find("#sweep").is_displayed(),
               "without a sweep the page says how to make one, and shows no empty charts")
    check(not page.execute_script(STICKS_OUT) and page.execute_script("return document.querySelectorAll('#sweeps li').length") == 0,
          "nor a sweep of before, and its words stay in their panel")
    page.save_screenshot(f"{pictures}-empty.png")


ORBIT = """
  const done = arguments[arguments.length - 1];
  import("/page/orbit.js").then(({cameraOf, edgesOf, matrixOf, placesOf}) => {
    const eyes = [[0, 30], [90, 30], [0, 90]].map((orbit) => cameraOf({box_mm: [10, 10], gap_mm: 2}, {x: 0.5, y: 0.5, zoom: 1, orbit}));
    // how far the corners of the box are from the middle of the picture, in halves of it
    const outermost = (orbit) => {
      const look = matrixOf(cameraOf({box_mm: [10, 10], gap_mm: 2}, {x: 0.5, y: 0.5, zoom: 1, orbit}));
      const seen = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [0, 1, 2, 3].map((row) =>
        look[row] * 10 * (k & 1) + look[4 + row] * 10 * (k >> 1 & 1) + look[8 + row] * 2 * (k >> 2) + look[12 + row]));
      return [Math.max(...seen.map(([x, y, , w]) => Math.max(Math.abs(x), Math.abs(y)) / w)),
              Math.max(...seen.map(([, , z, w]) => Math.abs(z) / w))];
    };
    const frame = {n_rods: 2, box_mm: [20, 40], gap_mm: 2, x: [0, -16384], y: [16384, 0], heading: [16384, 0], walls: null};
    const places = [null, [-32767, 0]].map((z) => Array.from(placesOf({...frame, z})));
    const posts = edgesOf({...frame, posts: {diameter_mm: 4, centres_mm: [[3, 30], [7, 8]]}});
    const [ellipse, wedge] = ["ellipse", "wedge"].map((arena) =>
      edgesOf({...frame, walls: {arena, size_mm: 8, inner_mm: 0, length_mm: 16, narrow_mm: 2}}));
    done([eyes.map(({eye}) => eye), eyes[2].up, [[-30, 35], [77, 1], [200, 90]].map(outermost), places,
          [posts.length, posts[1].map(([x, y]) => Math.hypot(x - 3, y - 30))],
          [ellipse[0].map(([x, y]) => Math.hypot((x - 10) / 8, (y - 20) / 4)), wedge]]);
  });"""


def from_the_side(page, pictures):
    """The rods between their plates, seen from where `shaken picture --view orbit:AZ,EL` sees them (camera_test.cpp)."""
    def find(css):
        return page.find_element(By.CSS_SELECTOR, css)

    def view():
        return page.execute_script("return window.shakenRods.view")

    def drawn():
        return page.execute_script("return document.getElementById('rods').toDataURL()")

    (front, right, above), up, reach, places, (n_edges, radii), (ellipse, wedge) = page.execute_async_script(ORBIT)
    check(places[0] == [10, 30, 1, 0.5, 5, 20, 1, 0], f"rods are where they are in the box, half way up: {places[0]}")
    check(places[1][2::4] == [-1, 1], f"or at their heights: {places[1]}")
    check(n_edges == 3 and all(abs(radius - 2) < 1e-9 for radius in radii), f"posts are edges beside the box's: {radii}")
    check(len(ellipse) > 60 and all(abs(part - 1) < 1e-9 for part in ellipse), f"so is an ellipse: {ellipse}")
    check(wedge == [[[2, 16], [18, 19], [18, 21], [2, 24]]], f"and a wedge: {wedge}")
    check(front[1] < 0 and abs(front[0] - 5) < 1e-9 and right[0] > 10 and abs(right[1] - 5) < 1e-9,
          "azimuth 0 is from below the picture from above, 90 from its right")
    check(abs(above[0] - 5) + abs(above[1] - 5) < 1e-9 and abs(up[1] - 1) < 1e-9, "elevation 90 is from above")
    check(all(0.9 < side <= 1 and depth < 1 for side, depth in reach), f"the box just fits: {reach}")
    from_above = drawn()
    find("#orbit").click()
    eventually(lambda: find("#orbit").get_attribute("aria-pressed") == "true" and drawn() != from_above, "rods are seen from the side")
    check("azimuth -30°, elevation 35°" in find("#marks").get_attribute("aria-label"), "which the name of the canvas says")
    rods = find("#marks")
    ActionChains(page).move_to_element(rods).click_and_hold().move_by_offset(40, 20).release().perform()
    turned = view()["orbit"]
    check(turned[0] < -30 and turned[1] > 35 and view()["x"] == 0.5, f"drawing turns them: {turned}")
    rods.send_keys(Keys.ARROW_UP)
    check(view()["orbit"][1] > turned[1] and view()["orbit"][0] == turned[0], "so do arrows")
    for colouring in ("layers", "wheel", "tilt", "species"):
        before = drawn()
        Select(find("#colouring")).select_by_value(colouring)
        if colouring != "layers":  # which may be what there was
            eventually(lambda: drawn() != before, f"coloured by {colouring}")
    rods.send_keys("+")
    check(view()["zoom"] > 1, "+ enlarges")
    page.save_screenshot(f"{pictures}-orbit.png")
    def is_from_above_after_a_double_click():  # which is two clicks where the machine is busy
        ActionChains(page).double_click(rods).perform()
        return view()["orbit"] is None and find("#orbit").get_attribute("aria-pressed") == "false"
    eventually(is_from_above_after_a_double_click, "a double click is from above again")
    rods.send_keys("o")
    check(view()["orbit"] is not None, "o goes there, too")
    rods.send_keys("0")
    check(view() == {"x": 0.5, "y": 0.5, "zoom": 1, "orbit": None}, "0 shows the whole box from above")
    Select(find("#colouring")).select_by_value("auto")
    found = False
    for k in range(20):
        ActionChains(page).move_to_element_with_offset(rods, 5 * k - 100, 3 * k - 60).perform()
        found = found or "n_z = " in find("#rod-facts").text
    check(found, "where a rod under the pointer says its numbers")


def main(folder, screenshot):
    signal.signal(signal.SIGALRM, lambda *_: sys.exit("the page takes too long"))
    signal.alarm(500)
    Handler.daemon, Handler.folder = Daemon(), pathlib.Path(folder)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    profile = tempfile.mkdtemp(prefix="shaken-page.")
    page = browser(profile, os.path.join(profile, "downloads"))
    try:
        use(page, f"http://127.0.0.1:{server.server_port}/", Handler.daemon)
        use_by_everybody(page, Handler.daemon, screenshot.removesuffix(".png"))
    finally:
        page.save_screenshot(screenshot)
        page.quit()
        shutil.rmtree(profile, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
