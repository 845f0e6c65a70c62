"""A headless Chromium, driven over the pipe that it offers for that, with nothing but the standard library."""
import base64
import fcntl
import itertools
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find_browser():
    """Debian's Chromium, or None."""
    return shutil.which("chromium")


class Browser:
    """Messages are JSON with a NUL behind each; the browser reads them from descriptor 3 and answers on 4."""

    def __init__(self, width=1200, height=900):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        theirs_in, self.to = os.pipe()
        self.source, theirs_out = os.pipe()
        high_in, high_out = (fcntl.fcntl(fd, fcntl.F_DUPFD, 20) for fd in (theirs_in, theirs_out))
        os.close(theirs_in), os.close(theirs_out)
        command = [find_browser(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                   "--no-first-run", "--disable-extensions", "--disable-background-networking", "--force-device-scale-factor=1",
                   "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{high_in} 4>&{high_out}', "bash", *command],
                                        pass_fds=(high_in, high_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(high_in), os.close(high_out)
        self.numbers, self.pending, self.session, self.exceptions = itertools.count(1), b"", None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Page.enable")
        self.call("Runtime.enable")
        self.resize(width, height)

    def resize(self, width, height):
        """Of the page, in pixels."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.to), os.close(self.source)
        self.profile.cleanup()

    def _message(self, until):
        while b"\0" not in self.pending:
            ready, _, _ = select.select([self.source], [], [], max(until - time.monotonic(), 0))
            if not ready:
                raise TimeoutError("the browser does not answer")
            data = os.read(self.source, 1 << 20)
            if not data:
                raise ConnectionError("the browser ended")
            self.pending += data
        text, self.pending = self.pending.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, timeout=90, **parameters):
        number = next(self.numbers)
        message = {"id": number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + timeout
        while True:
            answer = self._message(until)
            if answer.get("method") == "Runtime.exceptionThrown":
                self.exceptions.append(answer["params"]["exceptionDetails"]["text"])
            if answer.get("id") != number:
                continue
            if "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            return answer["result"]

    def open(self, path, ready="true", timeout=90):
        self.call("Page.navigate", url=path.resolve().as_uri())
        until = time.monotonic() + timeout
        while not self.value(f"document.documentElement !== null && document.readyState === 'complete' && ({ready})"):
            assert time.monotonic() < until, f"{path} is not ready: {self.exceptions}"
            time.sleep(0.1)

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, f"{expression}: {result['exceptionDetails']}"
        return result["result"].get("value")

    def box(self, selector):
        """x, y, width and height on the page."""
        return self.value(f"(() => {{ const r = document.querySelector({json.dumps(selector)}).getBoundingClientRect();"
                          "return [r.x + scrollX, r.y + scrollY, r.width, r.height]; })()")

    def mouse(self, kind, x, y, pressed=0, **more):
        """x and y on the screen."""
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=pressed, clickCount=1, **more)

    def drag(self, x0, y0, x1, y1, **more):
        self.mouse("mousePressed", x0, y0, 1, **more)
        for part in (0.5, 1):
            self.mouse("mouseMoved", x0 + part * (x1 - x0), y0 + part * (y1 - y0), 1, **more)
        self.mouse("mouseReleased", x1, y1, **more)
        self.settle()

    def key(self, key):
        """Presses and releases a key that has one letter."""
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, text=key if kind == "keyDown" else "")
        self.settle()

    def settle(self):
        """Until what happened so far is on the screen."""
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def click(self, selector):
        self.value(f"document.querySelector({json.dumps(selector)}).click()")

    def shot(self, path, box=None):
        """A PNG of a box on the page, by default of the whole page."""
        if box is None:
            size = self.call("Page.getLayoutMetrics")["cssContentSize"]
            box = (0, 0, size["width"], size["height"])
        self.settle()
        clip = dict(zip(("x", "y", "width", "height"), box), scale=1)
        data = self.call("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)["data"]
        path.write_bytes(base64.b64decode(data))
        return path
