"""A page in headless Chromium, by its DevTools protocol."""
import asyncio
import base64
import json
import pathlib
import shutil
import subprocess
import tempfile
import time
import urllib.request

import websockets

CHROMIUM = shutil.which("chromium")


class Page:
    """One page. Use with `with`."""

    def __init__(self, url, width=1100, height=900):
        self.url, self.size = url, (width, height)
        self.loop = asyncio.new_event_loop()
        self.number = 0
        self.errors = []  # exceptions and console errors of the page

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.browser = subprocess.Popen(
            [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--hide-scrollbars", "--remote-debugging-port=0", "--remote-allow-origins=*",
             f"--user-data-dir={self.folder.name}", "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.socket = self._run(self._connect())
        for domain in ("Page", "Runtime", "Log", "Accessibility"):
            self.do(domain + ".enable")
        self.resize(*self.size)
        self.open(self.url)
        return self

    def __exit__(self, *_):
        self._run(self.socket.close())
        self.browser.terminate()
        self.browser.wait(20)
        self.loop.close()
        self.folder.cleanup()

    def _run(self, step):
        return self.loop.run_until_complete(step)

    async def _connect(self):
        port_file = pathlib.Path(self.folder.name) / "DevToolsActivePort"
        end = time.monotonic() + 60
        while not port_file.exists() or not port_file.read_text():
            if time.monotonic() > end or self.browser.poll() is not None:
                raise RuntimeError("chromium does not start")
            await asyncio.sleep(0.1)
        port = port_file.read_text().split()[0]
        pages = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
        address = next(page for page in pages if page["type"] == "page")["webSocketDebuggerUrl"]
        return await websockets.connect(address, max_size=None)

    async def _do(self, method, parameters):
        self.number += 1
        await self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(await asyncio.wait_for(self.socket.recv(), 60))
            if message.get("method") == "Runtime.exceptionThrown":
                self.errors.append(message["params"]["exceptionDetails"])
            if message.get("method") == "Log.entryAdded" and message["params"]["entry"]["level"] == "error":
                self.errors.append(message["params"]["entry"]["text"])
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(message["error"])
                return message["result"]

    def do(self, method, **parameters):
        return self._run(self._do(method, parameters))

    def open(self, url):
        self.do("Page.navigate", url=url)
        self.wait_for("location.href !== 'about:blank' && document.readyState === 'complete'")

    def resize(self, width, height, phone=False):
        self.do("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def scheme(self, name):
        self.do("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def value(self, expression):
        result = self.do("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"])
        return result["result"].get("value")

    def text(self, selector):
        return self.value(f"document.querySelector({json.dumps(selector)})?.textContent")

    def wait_for(self, expression, longest_s=30):
        """The first value of the expression that is true (an object is none: say what of it)."""
        end = time.monotonic() + longest_s
        while time.monotonic() < end:
            value = self.value(expression)
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"not within {longest_s} s: {expression}")

    def press(self, key, code, text=""):
        for kind in ("keyDown", "keyUp"):
            self.do("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, text=text if kind == "keyDown" else "")

    def screenshot(self, path):
        pathlib.Path(path).write_bytes(base64.b64decode(self.do("Page.captureScreenshot", format="png")["data"]))
