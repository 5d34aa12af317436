"""Uses the page as a person does, in a headless Chromium, and says what is not as it should be.

usage: page.py ADDRESS SCREENSHOT [--live]
ADDRESS is what shaken-web prints. A sweep "waits" of one held job that takes long must be there; the rest is submitted
here. With --live the bus must work. Exits 1 at the first thing that is wrong; the screenshot shows the end."""
import json
import os
import shutil
import signal
import sys
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

SWEEP = json.dumps({
    "scene": {"rods": {"length": 3, "area_fraction": 0.7}, "box": {"side": "20 mm"},
              "time": {"steady": "0 s", "measure": "3 s"}, "measure": {"order": {"every": "5 ms"}, "angles": {}},
              "trajectory": {"every": "50 ms"}, "stream": {"rate": 20}},
    "sweep": {"grid": {"rods.area_fraction": [0.3, 0.5], "rods.length": [3.0, 3.5]}}})
PATIENCE = 90  # s


def browser(profile, downloads):
    options = Options()
    options.add_experimental_option("prefs", {"download.default_directory": downloads})
    options.binary_location = "/usr/bin/chromium"
    for word in ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", "--window-size=1600,1300", "--user-data-dir=" + profile]:
        options.add_argument(word)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def check(condition, what):
    print("ok" if condition else "WRONG", "-", what, flush=True)
    if not condition:
        raise SystemExit(1)


def eventually(condition, what):
    end, last = time.monotonic() + PATIENCE, ""
    while time.monotonic() < end:
        try:
            if condition():
                return check(True, what)
        except Exception as problem:  # an element that is being replaced, most often
            last = f"; {problem}"
        time.sleep(0.1)
    check(False, what + f" (not after {PATIENCE} s{last})")


def main(address, screenshot, live):
    signal.signal(signal.SIGALRM, lambda *_: sys.exit("the page takes too long"))
    signal.alarm(500)
    profile = tempfile.mkdtemp(prefix="shaken-page.")
    downloads = os.path.join(profile, "downloads")
    os.mkdir(downloads)
    page = browser(profile, downloads)
    try:
        use(page, address, live, downloads)
    finally:
        page.save_screenshot(screenshot)
        page.quit()
        shutil.rmtree(profile, ignore_errors=True)


def use(page, address, live, downloads):
    def find(css):
        return page.find_element(By.CSS_SELECTOR, css)

    def text(css):
        return find(css).text

    def rows(state):
        return [row for row in page.find_elements(By.CSS_SELECTOR, "#jobs tr") if state in row.text]

    def colours():
        """How many different colours the canvas of the rods has, of every 16th pixel."""
        return page.execute_script("""
            const gl = document.getElementById("rods").getContext("webgl2");
            const {width, height} = gl.canvas, pixels = new Uint8Array(4 * width * height), seen = new Set();
            gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            for (let i = 0; i < pixels.length; i += 64) seen.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
            return seen.size;""")

    def click_text(selector, words):
        """Clicks what is found by `selector` and has `words` in it, and may be replaced meanwhile."""
        def found():
            return [each for each in page.find_elements(By.CSS_SELECTOR, selector) if words in each.text]
        eventually(lambda: (found()[0].click(), True)[1], f"{words} is clicked")

    def click(css_rows, state, which=0):
        """Clicks a row of the table of jobs, which may be replaced meanwhile."""
        eventually(lambda: (css_rows(state)[which].click(), True)[1], f"a job that is {state} is clicked")

    root = address.split("#")[0]
    page.get(root)
    eventually(lambda: "shaken web" in text("#gone"), "without the token nothing is seen but what to do")
    page.get("about:blank")
    page.get(root + "#token=" + 32 * "0")
    eventually(lambda: "shaken web" in text("#gone"), "a wrong token is refused")
    page.get_log("browser")  # these two are errors on purpose
    page.get("about:blank")

    page.get(address)
    eventually(lambda: "shakend" in text("#daemon"), "the daemon is there")
    check("token" not in page.current_url, "the token leaves the address")
    eventually(lambda: "waits" in text("#sweeps"), "the sweep that was there is listed")

    find("#open-submit").click()
    box = find("#submit-text")
    box.send_keys('{"scene": {\n"rods": {"lenght": 3}}}')
    check(not find("#submit-send").is_enabled(), "nothing is submitted unchecked")
    find("#submit-check").click()
    eventually(lambda: "line 2: /rods/lenght: " in text("#submit-problems") and "length" in text("#submit-problems"),
               "a scene that is refused says why, and where")
    check(not find("#submit-send").is_enabled(), "and is not submitted")
    find("#submit-problems button").click()
    check(page.execute_script("return arguments[0].value.slice(arguments[0].selectionStart, arguments[0].selectionEnd)", box)
          .startswith('"lenght"'), "a click on a problem goes to its place")
    box.clear()
    eventually(lambda: len(page.find_elements(By.CSS_SELECTOR, "#submit-example option")) > 4, "there are scenes to begin from")
    Select(find("#submit-example")).select_by_visible_text("quickstart")
    eventually(lambda: "A small box of shaken rods" in box.get_attribute("value"), "one of them is there")
    opened = os.path.join(downloads, "opened.json")
    with open(opened, "w", encoding="utf-8") as file:
        file.write(SWEEP)
    find("#submit-file").send_keys(opened)
    eventually(lambda: box.get_attribute("value") == SWEEP, "a file is opened")
    os.remove(opened)
    find("#submit-name").send_keys("<img src=x onerror=alert(1)>")
    box.send_keys(Keys.CONTROL + Keys.ENTER)
    eventually(lambda: "<img src=x onerror=alert(1)>: nothing is wrong with it. 4 jobs; " in text("#submit-state"),
               "a sweep that is good is checked by keys, and its jobs are counted")
    eventually(lambda: "as written" in text("#submit-cost") and "CPU time" in text("#submit-cost"), "what it costs is estimated")
    box.send_keys(" ")
    check(not find("#submit-send").is_enabled() and not text("#submit-cost"), "a text that is changed must be checked again")
    find("#submit-check").click()
    eventually(lambda: find("#submit-send").is_enabled(), "which it is")
    find("#submit-send").click()
    eventually(lambda: "<img src=x onerror=alert(1)>" in text("#sweeps"), "a hostile name is text")
    check(not page.execute_script("return document.images.length"), "and no picture")
    eventually(lambda: len(page.find_elements(By.CSS_SELECTOR, "#jobs tr")) == 4, "the new sweep is chosen: four jobs")

    eventually(lambda: len(rows("done")) == 4, "all jobs are done")
    eventually(lambda: page.execute_script(
        "return Chart.getChart('map').points.filter((p) => p.fill.startsWith('rgb')).length"
    ) == 4, "the phase diagram has four points with a value")
    marked = [row.text for row in rows("done") if "~0." in row.text or "?0." in row.text]
    hollow = page.execute_script("return Chart.getChart('map').points.filter((p) => p.hollow).length")
    check(hollow == len(marked), f"what is marked in the table is hollow in the diagram: {hollow}, {marked}")
    check(("hollow: " in text("#map-marks")) == bool(marked), "and is explained")
    find("#map-save").click()
    eventually(lambda: any(name.endswith("-order.mean.png") for name in os.listdir(downloads)), "the phase diagram is saved")
    saved = next(name for name in os.listdir(downloads) if name.endswith("-order.mean.png"))
    with open(os.path.join(downloads, saved), "rb") as picture:
        check(picture.read(8) == b"\x89PNG\r\n\x1a\n", "as a PNG")
    Select(find("#map-y")).select_by_value("")
    check(page.execute_script("return Chart.getChart('map').options.scales.y.title.text") == "order.mean",
          "against one parameter, the value goes up")
    if any("±" in row.text for row in rows("done")):
        check(page.execute_script("return Chart.getChart('map').points.some((p) => p.bar > 0)"), "with its errors")

    find("#map-pictures").click()
    eventually(lambda: page.execute_script("""return [...document.querySelectorAll("#pictures .picture")].filter(
        (one) => one.querySelector("canvas").width > 20 && one.innerText === "").length""") == 2, "and in pictures of the rods")
    find("#map-pictures").click()
    for row in (0, 3):
        page.execute_script("document.querySelectorAll('#jobs tr')[arguments[0]].dispatchEvent("
                            "new KeyboardEvent('keydown', {key: 'b', bubbles: true}))", row)
    eventually(lambda: [note.text.split(",")[0] for note in page.find_elements(By.CSS_SELECTOR, ".pane .note")] ==
               2 * ["t = 3.000 s"], "two runs are side by side")
    find("#beside-close").click()

    click(rows, "done", 1)
    eventually(lambda: "t = 3.000 s" in text("#run-facts"), "a finished run shows its last frame")
    check(page.execute_script("return Chart.getChart('order-chart').data.datasets[0].data.length") > 100, "S(t) is drawn")
    check(page.execute_script("return Chart.getChart('angle-chart').data.datasets[0].data.length") > 10, "P(theta) is drawn")
    eventually(lambda: colours() > 50, "rods are drawn")
    page.execute_script("""const time = document.getElementById("time"); time.value = 0; time.dispatchEvent(new Event("input"));""")
    eventually(lambda: "t = 0.000 s" in text("#run-facts"), "scrubbed back to the beginning")
    # asked about anew, as when any job changes its state, while the frame that is wished for is on its way
    page.execute_script("""
        const fetchNow = window.fetch, time = document.getElementById("time");
        window.fetch = async (what, ...more) => {
          const answer = await fetchNow(what, ...more);
          if (String(what).endsWith("/frames/1")) await new Promise((go) => setTimeout(go, 1500));
          return answer;
        };
        time.value = 1;
        time.dispatchEvent(new Event("input"));
        window.shakenRun.load().finally(() => { window.fetch = fetchNow; });""")
    eventually(lambda: "t = 0.050 s" in text("#run-facts"), "scrubbed to the second frame")
    time.sleep(2)
    check("t = 0.050 s" in text("#run-facts"), "and it stays there")
    chart = find("#order-chart")
    ActionChains(page).move_to_element_with_offset(chart, 0, 0).click_and_hold().move_by_offset(20, 0).release().perform()
    eventually(lambda: "t = 0.050 s" not in text("#run-facts"), "drawing along S(t) moves the rods")
    marked = page.execute_script("return Chart.getChart('order-chart').markedX")
    eventually(lambda: f"t = {page.execute_script('return Chart.getChart(arguments[0]).markedX', 'order-chart'):.3f} s" in
               text("#run-facts") and 1 < marked < 3, f"where the pointer is: {marked}")
    rods = find("#marks")
    found = False
    for k in range(40):  # a part of the box is empty
        ActionChains(page).move_to_element_with_offset(rods, 5 * k - 100, 3 * k - 60).perform()
        found = found or "° to the director, n_z = " in text("#rod-facts")
    check(found, "a rod under the pointer says its numbers")
    page.execute_script("""const time = document.getElementById("time"); time.value = 0; time.dispatchEvent(new Event("input"));""")
    eventually(lambda: "t = 0.000 s" in text("#run-facts"), "and back again")
    find("#play").click()
    eventually(lambda: "t = 0.000 s" not in text("#run-facts"), "it plays")
    find("#play").click()
    before = page.execute_script("return document.getElementById('rods').toDataURL()")
    Select(find("#colouring")).select_by_value("tilt")
    eventually(lambda: page.execute_script("return document.getElementById('rods').toDataURL()") != before,
               "another colouring is another picture")
    check("summary.json" in text("#files") and "trajectory.h5" in text("#files"), "its files can be saved")
    check("lock" not in text("#files") and "checkpoint" not in text("#files"), "but not what the program keeps for itself")
    picture = page.execute_async_script("""
        const done = arguments[arguments.length - 1];
        import("/page/dom.js").then(async ({fetched}) => {
          const run = new URLSearchParams(location.hash.slice(1)).get("run");
          const answer = await fetched(`/runs/${run}/picture?frame=0`);
          done([answer.status, answer.headers.get("Content-Type"), (await answer.arrayBuffer()).byteLength]);
        });""")
    axes = page.execute_async_script("""
        const done = arguments[arguments.length - 1];
        const stages = [[1, 0.4, 1.2], [2, 0.5, 1.2], [3, 0.4, 1.2], [1, 0.4, 1.4], [2, 0.5, 1.4], [3, 0.4, 1.4]];
        import("/page/results.js").then(({sweptParameters}) => done(sweptParameters(stages.map(
          ([stage, fraction, gap]) => ({parameters: {stage, "rods.area_fraction": fraction, "box.gap": gap}})))
          .map(({key}) => key)));""")
    check(axes == ["stage", "box.gap"], f"what the stages of a protocol set is no axis beside them: {axes}")
    check(picture[0] == 200 and picture[1] == "image/png" and picture[2] > 10000, f"a frame is drawn as a PNG: {picture}")
    find("#draw").click()
    eventually(lambda: page.execute_script("return document.querySelector('#shown img')?.naturalWidth") == 1280,
               "a frame is drawn in its place on the page")
    Select(find("#draw-style")).select_by_visible_text("tilt")
    Select(find("#draw-size")).select_by_visible_text("1000x1000")
    eventually(lambda: page.execute_script("return document.querySelector('#shown img')?.naturalHeight") == 1000,
               "in another style and size")
    find("#shown-save").click()
    eventually(lambda: any(name.endswith("-0.png") or ".png" in name and "order" not in name for name in os.listdir(downloads)),
               "and saved")
    find("#shown-close").click()
    click_text("#files button", "summary.json")
    eventually(lambda: any(name.endswith("-summary.json") for name in os.listdir(downloads)), "a file is saved")

    click_text("button.sweep", "waits")
    eventually(lambda: rows("held"), "the other sweep's job is held")
    find("#sweep-actions [data-action=resume]").click()
    eventually(lambda: rows("running"), "it runs after a click")
    click(rows, "running")
    if live:
        before = page.execute_script("return window.shakenRods.framesDrawn")
        eventually(lambda: page.execute_script("return window.shakenRods.framesDrawn") > before + 10, "live frames are drawn")
        eventually(lambda: colours() > 50, "with rods on them")
        eventually(lambda: page.execute_script("return Chart.getChart('order-chart').data.datasets[0].data.length") > 10,
                   "S(t) grows")
    find("#sweep-actions [data-action=cancel]").click()
    page.switch_to.alert.accept()
    eventually(lambda: rows("cancelled"), "it is cancelled by a click")
    eventually(lambda: "records no rods" in text("#run-note"), "what it has not is said")
    eventually(lambda: not find("button.sweep[aria-current=true] progress").is_displayed(), "a sweep that is over has no empty bar")
    check(text("#run-actions") == "Try run again" and text("#sweep-actions") == "Try all again", "two buttons for two things")
    check(not find("#scrub").is_displayed() and not find("#map-frame").is_displayed(), "and not offered")

    errors = [line["message"] for line in page.get_log("browser") if line["level"] == "SEVERE"
              and "/curves" not in line["message"] and "/v1/sweeps" not in line["message"]]
    check(not errors, f"the browser complains of nothing: {errors}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], "--live" in sys.argv)
