"""scene.live() in JupyterLab: a cell is run, a part is dragged, its pose is read back, and what a cell assigns is shown.

usage: notebook_page.py FOLDER [FOLDER for pictures]
With the interpreter that has jupyterlab, anywidget and the package. FOLDER: for the notebook and the settings of Jupyter.
"""
import json
import os
import pathlib
import secrets
import socket
import subprocess
import sys
import time
import urllib.request

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))
import chromium  # noqa: E402

MAKE = """import skiagraph as sk
scene = sk.Scene()
scene.add("block", sk.Mesh.cube(40), material="Water")
scene.add("ball", sk.Mesh.sphere(10, 64), material="Aluminium", inside="block")
scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(0.5, 0, 0), row_step=(0, 0.5, 0), pixels=(160, 120))
scene.beam = sk.Beam.mono(60, 1000)
live = scene.live()
live"""
READ = "print('pose', scene['block'].pose[:3, 3].tolist())"
ASSIGN = "scene['block'].pose = sk.translate(0, -7, 0)\nprint('assigned')"
BUSY = """import pathlib, time
print('began', flush=True)
while not pathlib.Path("go-on").exists():
    time.sleep(0.05)
print('slept', scene['ball'].pose[0, 3])"""
SOURCE = "print('source', scene.view.source.tolist(), scene.beam)"
failures = []


def check(name, is_right, what=""):
    if not is_right:
        failures.append(f"{name} {what}")


def cell(number, source):
    return {"cell_type": "code", "execution_count": None, "id": f"cell{number}", "metadata": {}, "outputs": [], "source": source}


def free_port():
    with socket.socket() as its:
        its.bind(("127.0.0.1", 0))
        return its.getsockname()[1]


class Jupyter:
    """JupyterLab, running, with a notebook of these cells."""

    def __init__(self, folder, cells):
        self.folder, self.token = pathlib.Path(folder), secrets.token_hex(16)
        self.folder.mkdir(parents=True, exist_ok=True)
        notebook = {"cells": [cell(i, source) for i, source in enumerate(cells)], "nbformat": 4, "nbformat_minor": 5, "metadata": {
            "kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}}
        (self.folder / "live.ipynb").write_text(json.dumps(notebook), encoding="utf-8")
        settings = self.folder / "settings" / "@jupyterlab" / "apputils-extension" / "notification.jupyterlab-settings"
        settings.parent.mkdir(parents=True, exist_ok=True)
        settings.write_text('{"fetchNews": "false"}', encoding="utf-8")
        self.log = (self.folder / "jupyter.log").open("w", encoding="utf-8")
        for _ in range(10):  # another process may take the port before it does
            self.start()
            if self.is_there():
                return
        raise RuntimeError("JupyterLab does not start: " + (self.folder / "jupyter.log").read_text(encoding="utf-8")[-2000:])

    def start(self):
        self.port = free_port()
        words = ["-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", f"--port={self.port}", "--ServerApp.port_retries=0",
                 f"--IdentityProvider.token={self.token}", f"--ServerApp.root_dir={self.folder}", "--LabApp.expose_app_in_browser=True",
                 "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
        home = {f"JUPYTER_{name}_DIR": str(self.folder / name.lower()) for name in ("CONFIG", "DATA", "RUNTIME")}
        self.process = subprocess.Popen([sys.executable, *words], env={**os.environ, **home, "IPYTHONDIR": str(self.folder / "ipython"),
            "JUPYTERLAB_SETTINGS_DIR": str(self.folder / "settings"), "JUPYTERLAB_WORKSPACES_DIR": str(self.folder / "workspaces")},
            stdout=self.log, stderr=self.log)

    def is_there(self):
        """Waits until it answers. False: it has ended."""
        end = time.monotonic() + 120
        while time.monotonic() < end and self.process.poll() is None:
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{self.port}/api?token={self.token}", timeout=10).close()
                return True
            except OSError:
                time.sleep(0.1)
        self.process.kill()
        self.process.wait()
        return False

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}/lab/tree/live.ipynb?token={self.token}&reset"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            request = urllib.request.Request(f"http://127.0.0.1:{self.port}/api/shutdown?token={self.token}", method="POST")
            urllib.request.urlopen(request, timeout=10).close()  # with its kernels
            self.process.wait(20)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
        self.process.wait()
        self.log.close()


class Lab:
    """The notebook in a browser, and the frame of its widget."""

    def __init__(self, browser):
        self.browser = browser
        browser.until("!!(window.jupyterapp && jupyterapp.shell.currentWidget && jupyterapp.shell.currentWidget.content &&"
                      " jupyterapp.shell.currentWidget.content.widgets)", 120)
        browser.until("jupyterapp.shell.currentWidget.sessionContext.session?.kernel?.status === 'idle'", 120)

    def choose(self, number):
        self.browser.run(f"jupyterapp.shell.currentWidget.content.activeCellIndex = {number}")

    def start(self, number):
        self.choose(number)
        self.browser.run("jupyterapp.commands.execute('notebook:run-cell'), 0")

    def text(self, number):
        return self.browser.run(f"jupyterapp.shell.currentWidget.content.widgets[{number}].outputArea.node.innerText")

    def cell(self, number, end):
        """Runs a cell. What it has printed, once that contains `end`."""
        self.start(number)
        self.browser.until(f"jupyterapp.shell.currentWidget.content.widgets[{number}].outputArea.node.innerText.includes({json.dumps(end)})")
        return self.text(number)

    def run(self, script):
        """The value of an expression in the page of the widget."""
        return self.browser.run(f"(() => {{ const f = document.querySelector('.jp-OutputArea iframe'); return f && f.contentWindow.eval({json.dumps(script)}); }})()")

    def until(self, script, seconds=120):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if self.run(script):
                    return
            except RuntimeError:
                pass  # the frame is not loaded yet
            time.sleep(0.05)
        raise TimeoutError(f"{script} stays false in the widget; it says {self.run('document.body.innerText.slice(0, 300)')}")

    def place(self, script):
        """A place of the page in the window."""
        x, y = json.loads(self.run(f"JSON.stringify({script})"))
        left, top = json.loads(self.browser.run("(() => { const r = document.querySelector('.jp-OutputArea iframe').getBoundingClientRect();"
                                                " return JSON.stringify([r.left, r.top]); })()"))
        return left + x, top + y


ARROW = """(() => { draw(); const r = canvas.getBoundingClientRect(), t = onScreen(add(middleOf(), REACH * 0.7 * mmPerPixel(middleOf()), AXES[0]));
  return [r.left + t[0], r.top + t[1]]; })()"""
SUM = "xray.frame.numbers.reduce((s, x) => (Math.imul(s, 31) + x) | 0, 7)"
COLOURS = """(() => { const s = byId('picture'), d = s.getContext('2d').getImageData(0, 0, s.width, s.height).data;
  return new Set(new Uint32Array(d.buffer)).size; })()"""
SETTLED = "xray.frame && live && net.role === 'owner' && xray.frame.wish === net.sent && !net.waits"


def tried(lab, pictures):
    lab.start(0)
    lab.until("typeof xray !== 'undefined' && " + SETTLED, 180)
    check("an image", lab.run("new Set(xray.frame.numbers).size") > 20)
    check("3D", lab.run("meshes.length") == 2)
    lab.until("served.stamp > 0 && !served.waits")  # WebGL is software here
    check("3D by the kernel", lab.run("isServed() && !byId('picture').hidden && byId('drawer').options[0].textContent.endsWith('the kernel')"))
    check("a picture", lab.run(COLOURS) > 20, str(lab.run(COLOURS)))
    lab.browser.run("document.querySelector('.jp-OutputArea iframe').scrollIntoView({block: 'end'})")
    if pictures:
        time.sleep(0.5)  # the picture is for people
        lab.browser.picture(os.path.join(pictures, "notebook-begin.png"))
    lab.run("choose('part', 0)")
    before, (x, y) = lab.run(SUM), lab.place(ARROW)
    lab.browser.drag(x, y, 30, 0)
    lab.until(SETTLED)
    check("dragged", lab.run(SUM) != before)
    moved = lab.run("state.poses[0] && state.poses[0][3]")
    check("moved along x", moved and abs(moved) > 1, str(moved))
    pose = json.loads(lab.cell(1, "pose").split("pose ")[1])
    check("pose read back", pose[0] == moved and pose[1:] == [0, 0], f"{pose} {moved}")
    before = lab.run(SUM)
    lab.cell(2, "assigned")
    lab.until("state.poses[0] && state.poses[0][7] === -7")
    lab.until(SETTLED)
    check("what Python assigns is shown", lab.run(SUM) != before)


def busy(lab, folder):
    """While a cell runs, which ends when a file is there, what is changed waits, and the page says so. Keys move what is chosen."""
    lab.run("choose('part', 1)")
    lab.cell(3, "began")  # the kernel is busy with messages of the widget, too: a key may be taken before the cell
    lab.run("canvas.focus()")
    for _ in range(3):
        lab.browser.key("ArrowRight", 1)
    lab.until("byId('role').textContent.includes('the kernel is busy')")
    check("it waits", "slept" not in lab.text(3))
    (pathlib.Path(folder) / "go-on").touch()
    lab.until("byId('role').textContent === ''")
    lab.until(SETTLED)
    check("nothing moved meanwhile", "slept 0.0" in lab.text(3), lab.text(3))
    check("keys moved it", lab.run("state.poses[1] && state.poses[1][3]") == 3, str(lab.run("JSON.stringify(state.poses)")))
    lab.run("set('Source.Position', [5, 0, -900, 'mm']); set('Source.Beam', {kVp: 80, Filter: [['Al', 2.5, 'mm']]})")
    lab.until(SETTLED)
    said = lab.cell(4, "source")
    check("source and beam read back", "source [5.0, 0.0, -900.0]" in said and "energies" in said, said)


def looks(lab, pictures):
    """Light and dark, wide and narrow; and after the browser's page was loaded anew."""
    browser = lab.browser
    for theme, is_dark in (("JupyterLab Dark", "true"), ("JupyterLab Light", "false")):
        browser.run(f"jupyterapp.commands.execute('apputils:change-theme', {{theme: {json.dumps(theme)}}}), 0")
        lab.until(f"document.documentElement.classList.contains('dark') === {is_dark}")
        browser.run("jupyterapp.shell.collapseLeft()")
        for width in (1300, 430):
            browser.size(width, 1000)
            browser.run("document.querySelector('.jp-OutputArea iframe').scrollIntoView({block: 'start'}), 0")
            lab.until("Math.abs(canvas.width - canvas.clientWidth) < 1 && !dirty")
            check("no scrolling sideways", lab.run("document.documentElement.scrollWidth <= document.documentElement.clientWidth"), str(width))
            if pictures:
                browser.picture(os.path.join(pictures, f"notebook-{theme[11:].lower()}-{width}.png"))
    browser.size(1300, 1000)
    browser.run("jupyterapp.commands.execute('docmanager:save')")
    poses = lab.run("JSON.stringify(state.poses)")
    browser.run("window.isOld = true")
    browser.call("Page.reload")
    browser.until("!window.isOld")
    lab = Lab(browser)
    lab.until("typeof xray !== 'undefined' && " + SETTLED, 120)
    check("the same after a reload", lab.run("JSON.stringify(state.poses)") == poses)


def main():
    folder, pictures = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    if not chromium.program():
        print("no chromium; CHROMIUM names another browser of that kind")
        return 77
    with Jupyter(folder, [MAKE, READ, ASSIGN, BUSY, SOURCE]) as jupyter, chromium.Browser(jupyter.url, (1300, 1000)) as browser:
        lab = Lab(browser)
        try:
            tried(lab, pictures)
            busy(lab, folder)
            looks(lab, pictures)
            check("no exception", not browser.events, json.dumps(browser.events)[:800])
        finally:
            if pictures:
                browser.picture(os.path.join(pictures, "notebook-end.png"))
    for failure in failures:
        print("failed:", failure)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
