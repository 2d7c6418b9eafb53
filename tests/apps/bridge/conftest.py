"""Plants and controllers in processes of their own."""

import json
import signal
import subprocess
import sys
import time

import pytest


class Bridge:
    """Starts both sides in a folder.

    Attributes:
        address: of the plant that was served last.
    """

    def __init__(self, folder):
        self.folder, self.address, self._started = folder, "", []

    def start(self, *arguments):
        """A command under way."""
        process = subprocess.Popen(
            [sys.executable, "-m", "surefoot", *arguments],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        self._started.append(process)
        return process

    def serve(self, *arguments):
        """A plant that waits for a controller."""
        process = self.start("serve", *arguments, "--port", "0")
        self.address = process.stdout.readline().partition(" ")[0]
        assert self.address, process.stderr.read()
        return process

    def walk(self, *arguments):
        """A controller on it."""
        return self.start("walk", *arguments, "--on", self.address, "--json")

    def under_way(self, controller, least=200_000):
        """Wait until a controller has written so much of its log [B]."""
        deadline = time.monotonic() + 120.0
        while time.monotonic() < deadline and controller.poll() is None:
            if any(log.stat().st_size > least for log in self.folder.rglob("log.mcap")):
                return
            time.sleep(0.02)
        raise AssertionError(controller.communicate())

    def end(self, process, timeout=120):
        """Exit code, standard output and what was said."""
        out, said = process.communicate(timeout=timeout)
        return process.returncode, out, said

    def result(self, controller):
        """Exit code, verdict and what was said by a controller."""
        code, out, said = self.end(controller)
        return code, json.loads(out) if out else {}, said

    def close(self):
        for process in self._started:
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.communicate()


@pytest.fixture(name="bridge")
def bridge_fixture(tmp_path, heeding):
    bridge = Bridge(tmp_path)
    yield bridge
    bridge.close()
