"""A headless Chromium that is driven by the WebDriver protocol, with no way to any network but this machine."""

import base64
import json
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any, Self

FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--enable-unsafe-swiftshader"),
    "--proxy-server=127.0.0.1:9",
)


class Browser:
    """One page in one browser, as a context manager.

    Args:
        page: its file or its address.
        profile: folder of the browser.
        size: of the window [px].
    """

    def __init__(self, page: Path | str, profile: Path, size: tuple[int, int] = (560, 400)) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self._server = f"http://127.0.0.1:{port}"
        driver = [shutil.which("chromedriver") or "", f"--port={port}"]
        self._driver = subprocess.Popen(driver, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        options = {
            "args": [*FLAGS, f"--window-size={size[0]},{size[1]}", f"--user-data-dir={profile}"],
            "binary": shutil.which("chromium"),
        }
        waits = {"script": 180_000, "pageLoad": 180_000}  # [ms]; pictures are drawn in software, beside other work
        asked = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}, "timeouts": waits}
        wanted = {"alwaysMatch": {"browserName": "chrome", **asked}}
        self._session = ""
        try:
            self._session = f"/session/{self._started(wanted)['sessionId']}"
            self.open(page)
        except BaseException:
            self.__exit__()
            raise

    def _started(self, wanted: dict[str, Any]) -> Any:
        for _ in range(50):
            try:
                self._call("GET", "/status")
                break
            except urllib.error.URLError:
                time.sleep(0.1)
        return self._call("POST", "/session", {"capabilities": wanted})

    def _call(self, method: str, path: str, body: dict[str, Any] | None = None) -> Any:
        data = json.dumps(body or {}).encode() if method == "POST" else None
        headers = {"Content-Type": "application/json"}
        request = urllib.request.Request(self._server + self._session + path, data, headers, method=method)
        with urllib.request.urlopen(request, timeout=200) as answer:
            return json.load(answer)["value"]

    def open(self, page: Path | str) -> None:
        """Go to another page."""
        self._call("POST", "/url", {"url": page if isinstance(page, str) else page.as_uri()})

    def complaints(self) -> list[str]:
        """Errors of the console since it was last asked."""
        told = self._call("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in told if entry["level"] == "SEVERE"]

    def run(self, script: str, *given: Any) -> Any:
        """Run JavaScript in the page, with what it is given in `arguments`; gives what it returns, or its promise."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(given)})

    def show_as(self, width: int, height: int, dark: bool = False) -> None:
        """Show pages as on a screen of this size [px], also of a phone, in the colours that its owner prefers."""
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        colours = {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]}
        for command, given in (("setDeviceMetricsOverride", screen), ("setEmulatedMedia", colours)):
            self._call("POST", "/goog/cdp/execute", {"cmd": f"Emulation.{command}", "params": given})

    def wait_for(self, script: str, seconds: float = 180.0) -> Any:
        """Wait until JavaScript returns something true."""
        end = time.monotonic() + seconds
        while not (value := self.run(script)):
            assert time.monotonic() < end, f"never true in {seconds} s: {script}"
            time.sleep(0.2)
        return value

    def press(self, key: str) -> None:
        """Press a key and hold it."""
        self._act("key", [{"type": "keyDown", "value": key}])

    def release(self, key: str) -> None:
        """Let go of a key."""
        self._act("key", [{"type": "keyUp", "value": key}])

    def drag(self, *places: tuple[float, float]) -> None:
        """Press the mouse at the first place and release it at the last one [px]; a single one is a click."""
        moves = [{"type": "pointerMove", "duration": 200, "x": round(x), "y": round(y)} for x, y in places]
        down, up = ({"type": name, "button": 0} for name in ("pointerDown", "pointerUp"))
        self._act("pointer", [moves[0], {"type": "pause", "duration": 300}, down, *moves[1:], up])

    def _act(self, kind: str, actions: list[dict[str, Any]]) -> None:
        self._call("POST", "/actions", {"actions": [{"type": kind, "id": kind, "actions": actions}]})

    def resize(self, width: int, height: int) -> None:
        """Give the window another size [px]."""
        self._call("POST", "/window/rect", {"width": width, "height": height})

    def screenshot(self) -> bytes:
        """A PNG picture of the page."""
        return base64.b64decode(self._call("GET", "/screenshot"))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            if self._session:
                self._call("DELETE", "")
        finally:
            self._driver.terminate()
            self._driver.wait(timeout=20)
