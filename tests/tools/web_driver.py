"""A headless Chromium driven by the WebDriver protocol (https://www.w3.org/TR/webdriver2), with nothing
but Python's standard library and Debian's chromium-driver."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the protocol's name for an element's reference


def missing_programs():
    return [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]


class Browser:
    """A browser window; a context manager."""

    def __init__(self, width=1200, height=1600):
        self.profile = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(
            ["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
            env={**os.environ, "HOME": self.profile.name})
        self.session = None
        try:
            self.base = f"http://127.0.0.1:{self._port()}"
            arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                         f"--window-size={width},{height}", f"--user-data-dir={self.profile.name}/p"]
            options = {"args": arguments, "binary": shutil.which("chromium")}
            answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome", "goog:chromeOptions": options,
                "goog:loggingPrefs": {"browser": "ALL"}}}})
            self.session = f"/session/{answer['sessionId']}"
        except BaseException:
            self.close()
            raise

    def _port(self):
        for line in self.driver.stdout:
            match = re.search(r"started successfully on port (\d+)", line)
            if match:
                return int(match.group(1))
        raise RuntimeError("chromedriver did not start")

    def _call(self, method, path, body=None):
        data = None if method == "GET" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"},
                                         method=method)
        try:
            # Local, and no proxy of the environment; as long as a busy machine takes.
            opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
            with opener.open(request, timeout=300) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from error

    def command(self, path, body=None, method="POST"):
        return self._call(method, self.session + path, body)

    def devtools(self, command, parameters):
        """A command of the Chrome DevTools Protocol."""
        return self.command("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, url):
        self.command("/url", {"url": url})

    def run(self, script, *arguments):
        return self.command("/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector):
        return self.command("/element", {"using": "css selector", "value": selector})

    def click(self, selector):
        self.command(f"/element/{self.find(selector)[ELEMENT]}/click")

    def drag(self, selector, begin, end):
        """Presses the mouse on an element, moves it, lets it go; offsets are from its middle."""
        element = self.find(selector)

        def move(offset):
            return {"type": "pointerMove", "duration": 50, "origin": element, "x": offset[0],
                    "y": offset[1]}

        self.command("/actions", {"actions": [{
            "type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
            "actions": [move(begin), {"type": "pointerDown", "button": 0}, move(end),
                        {"type": "pointerUp", "button": 0}]}]})

    def console_errors(self):
        """What the page logged as an error, failed requests and uncaught exceptions included."""
        return [entry["message"] for entry in self.command("/se/log", {"type": "browser"})
                if entry["level"] == "SEVERE"]

    def close(self):
        try:
            if self.session:
                self._call("DELETE", self.session)
        except (RuntimeError, OSError):
            pass  # the driver's end ends the browser as well
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.driver.stdout.close()
            self.profile.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
