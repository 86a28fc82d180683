"""Chromium without a window, driven over its debugging socket: $CHROMIUM, or chromium."""
import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.parse

from live_client import LIMIT, Socket


def program():
    """The browser's path; None: there is none."""
    return shutil.which(os.environ.get("CHROMIUM", "chromium"))


class PageLeft(RuntimeError):
    """The page went away while it was asked: it is loaded anew, or another one."""


class Browser:
    """One page of a browser."""

    def __init__(self, url, size=(1280, 800)):
        self.folder = tempfile.mkdtemp(prefix="skg-browser-")
        words = [program(), "--headless", "--no-sandbox", "--remote-debugging-port=0", "--remote-allow-origins=*",
                 f"--user-data-dir={self.folder}", f"--window-size={size[0]},{size[1]}", "--use-gl=angle",
                 "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--hide-scrollbars", "about:blank"]
        self.process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        env={**os.environ, "HOME": self.folder})
        port, path = self.wait_for_port()
        self.socket = Socket(port, path)
        self.calls, self.session, self.events = 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Page.enable")
        self.call("Runtime.enable")
        self.size(*size)
        self.go(url)

    def wait_for_port(self):
        end = time.monotonic() + LIMIT
        while time.monotonic() < end and self.process.poll() is None:
            try:
                with open(os.path.join(self.folder, "DevToolsActivePort"), encoding="ascii") as file:
                    lines = file.read().split("\n")
                if len(lines) > 1:
                    return int(lines[0]), lines[1]
            except OSError:
                pass
            time.sleep(0.1)
        raise RuntimeError("the browser does not start")

    def call(self, method, **parameters):
        self.calls += 1
        message = {"id": self.calls, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.socket.send(message)
        while True:
            answer = json.loads(self.socket.receive_raw()[1])
            if answer.get("id") == self.calls:
                if "error" in answer:
                    left = any(word in answer["error"].get("message", "") for word in ("navigated", "context was destroyed"))
                    raise (PageLeft if left else RuntimeError)(f"{method}: {answer['error']}")
                return answer["result"]
            if answer.get("method") == "Runtime.exceptionThrown":
                self.events.append(answer["params"]["exceptionDetails"])

    def go(self, url):
        self.call("Page.navigate", url=url)

    def size(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def run(self, script):
        """The value of an expression of JavaScript in the page."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(json.dumps(result["exceptionDetails"])[:1500])
        return result["result"].get("value")

    def until(self, script, seconds=LIMIT):
        """Waits until an expression is true, also of a page that is being loaded."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if self.run(script):
                    return
            except PageLeft:
                pass
            time.sleep(0.03)
        raise TimeoutError(f"{script} stays false; errors: {json.dumps(self.events)[:2000]}")

    def mouse(self, kind, x, y, buttons=0):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left" if buttons or kind == "mouseReleased" else "none",
                  buttons=buttons, clickCount=1)

    def drag(self, x, y, dx, dy, steps=6):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, 1)
        for i in range(1, steps + 1):
            self.mouse("mouseMoved", x + dx * i / steps, y + dy * i / steps, 1)
        self.mouse("mouseReleased", x + dx, y + dy)

    def key(self, key, modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers)

    def picture(self, path):
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        with open(path, "wb") as file:
            file.write(data)

    def close(self):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
