"""Debian's Chromium without a window, by the WebDriver protocol over plain HTTP."""

import base64
import io
import json
import re
import shutil
import subprocess
import time
import urllib.error
import urllib.request

_ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_NO_GL = ["--disable-gpu", "--disable-3d-apis"]
_CATEGORIES = "devtools.timeline,disabled-by-default-devtools.timeline"
_TRACE = {"enableNetwork": False, "enablePage": False, "traceCategories": _CATEGORIES}
KEYS = {"Enter": "\ue007", "Escape": "\ue00c", "Right": "\ue014", "Down": "\ue015"}


def is_there():
    """Whether the browser and its driver are installed."""
    return bool(shutil.which("chromium") and shutil.which("chromedriver"))


class Driver:
    """A driver process, which starts browsers."""

    def __init__(self):
        self._process = subprocess.Popen(
            ["chromedriver", "--port=0", "--log-level=SEVERE"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        for line in self._process.stdout:
            found = re.search(r"started successfully on port (\d+)", line)
            if found:
                self.url = f"http://127.0.0.1:{found[1]}"
                return
        raise RuntimeError("chromedriver did not start")

    def browser(self, width=1280, height=800, *, gl=True, traces=False):
        """A new browser whose page has the given size; `traced` needs one that traces."""
        return Browser(self.url, width, height, gl, traces)

    def close(self):
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()


class Browser:
    """A browser with one page."""

    def __init__(self, driver_url, width, height, gl, traces):
        arguments = [
            "--headless=new",
            "--no-sandbox",
            "--disable-dev-shm-usage",
            "--hide-scrollbars",
            "--force-device-scale-factor=1",
            f"--window-size={width},{height}",
            *(_GL if gl else _NO_GL),
        ]
        wanted = {
            "capabilities": {
                "alwaysMatch": {
                    "browserName": "chrome",
                    "goog:chromeOptions": {"args": arguments},
                    "goog:loggingPrefs": {"browser": "ALL"},
                }
            }
        }
        if traces:
            options = wanted["capabilities"]["alwaysMatch"]
            options["goog:loggingPrefs"]["performance"] = "ALL"
            options["goog:chromeOptions"]["perfLoggingPrefs"] = _TRACE
        self._url = driver_url
        self._session = ""
        self._session = "/session/" + self._call("POST", "/session", wanted)["sessionId"]
        self.resize(width, height)

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(
            self._url + self._session + path,
            data,
            {"Content-Type": "application/json"},
            method=method,
        )
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(json.load(error)["value"]["message"]) from None

    def close(self):
        self._call("DELETE", "")

    def resize(self, width, height):
        """Give the page, not the window, the size."""
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.devtools("Emulation.setDeviceMetricsOverride", **metrics)

    def devtools(self, name, **parameters):
        body = {"cmd": name, "params": parameters}
        return self._call("POST", "/goog/cdp/execute", body)

    def open(self, url):
        self._call("POST", "/url", {"url": "about:blank"})
        self._call("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """The value of a JavaScript expression."""
        body = {"script": f"return ({script});", "args": list(arguments)}
        return self._call("POST", "/execute/sync", body)

    def wait_for(self, script, *arguments, within_s=10.0):
        """Wait until an expression is true."""
        until = time.monotonic() + within_s
        while True:
            value = self.run(script, *arguments)
            if value:
                return value
            assert time.monotonic() < until, f"not within {within_s} s: {script}"
            time.sleep(0.05)

    def pixels(self):
        """The page as an array (height, width, 3) of 0 to 255."""
        from matplotlib.image import imread

        png = base64.b64decode(self._call("GET", "/screenshot"))
        return (imread(io.BytesIO(png))[:, :, :3] * 255).round().astype(int)

    def save(self, path):
        """Save the page as a picture."""
        path.write_bytes(base64.b64decode(self._call("GET", "/screenshot")))

    def click(self, x, y, *, double=False):
        self.drag((x, y), (x, y), repeat=2 if double else 1)

    def drag(self, start, end, *, repeat=1, kind="mouse"):
        """Press at a place of the page, move to another, release."""
        steps = [{"type": "pointerMove", "duration": 0, "x": round(start[0]), "y": round(start[1])}]
        for _ in range(repeat):
            steps.append({"type": "pointerDown", "button": 0})
            if end != start:
                for share in (0.3, 0.7, 1.0):
                    x, y = (round(a + share * (b - a)) for a, b in zip(start, end, strict=True))
                    steps.append({"type": "pointerMove", "duration": 15, "x": x, "y": y})
            steps.append({"type": "pointerUp", "button": 0})
        pointer = {"pointerType": kind}
        source = {"type": "pointer", "id": kind, "parameters": pointer, "actions": steps}
        self._call("POST", "/actions", {"actions": [source]})

    def press(self, selector):
        """Click an element."""
        element = self._call("POST", "/element", {"using": "css selector", "value": selector})
        self._call("POST", f"/element/{element[_ELEMENT]}/click", {})

    def type(self, selector, text):
        """Replace the text of a field."""
        element = self._call("POST", "/element", {"using": "css selector", "value": selector})[
            _ELEMENT
        ]
        self._call("POST", f"/element/{element}/clear", {})
        self._call("POST", f"/element/{element}/value", {"text": text})

    def keys(self, *keys):
        """Press and release keys."""
        steps = []
        for key in keys:
            value = KEYS.get(key, key)
            steps += [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]
        source = {"type": "key", "id": "keyboard", "actions": steps}
        self._call("POST", "/actions", {"actions": [source]})

    def choose(self, selector, value):
        """Choose an option, or the value of a slider."""
        self.run(
            "((node) => { node.value = arguments[1];"
            " node.dispatchEvent(new Event('input', {bubbles: true}));"
            " node.dispatchEvent(new Event('change', {bubbles: true})); return true; })"
            "(document.querySelector(arguments[0]))",
            selector,
            str(value),
        )

    def traced(self, seconds):
        """Events (thread, name, ms of processor) of some seconds, but for those inside one of the
        same name; leaves the page."""
        self._log("performance")
        time.sleep(seconds)
        self._call("POST", "/url", {"url": "about:blank"})
        messages = [json.loads(one["message"])["message"] for one in self._log("performance")]
        events = [one["params"] for one in messages if one["method"] == "Tracing.dataCollected"]
        thread = {
            (one["pid"], one["tid"]): one["args"]["name"]
            for one in events
            if one["name"] == "thread_name"
        }
        ends = {}
        for one in sorted((one for one in events if one["ph"] == "X"), key=lambda one: one["ts"]):
            place, name = (one["pid"], one["tid"]), one["name"]
            if one["ts"] >= ends.get((place, name), 0.0):
                ends[place, name] = one["ts"] + one["dur"]
                yield thread.get(place, ""), name, 1e-3 * one.get("tdur", 0.0)

    def _log(self, kind):
        return self._call("POST", "/se/log", {"type": kind})

    def errors(self):
        """Messages of errors that the page has logged."""
        return [one["message"] for one in self._log("browser") if one["level"] == "SEVERE"]
