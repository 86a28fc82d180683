"""A trainer for percutaneous transhepatic cholangiography, as a page on this machine.

    python3 trainer.py [--folder FOLDER] [--port N] [--no-open]     serves until Ctrl-C; the first line is the address
    python3 trainer.py [--folder FOLDER] --replay RUN               repeats a recorded run; exit status 1 if its images differ
"""
import argparse
import contextlib
import csv
import hmac
import http.server
import itertools
import json
import pathlib
import secrets
import sys
import threading
import urllib.parse
import webbrowser

import numpy as np
from procedure import KVP, LIMITS, PIXELS, RATE, Procedure

import skiagraph as sk

COLUMNS = ("run", "seed", "seconds", "fluoroscopy_s", "kerma_mgy", "in_ducts_ml", "outside_ml", "tip_to_target_mm", "score")
BLACK, WHITE = 6.5, 1.5  # -ln(I/I0)
BODY_MAX = 4096  # bytes of a request
PAGE = pathlib.Path(__file__).with_name("page.html")


class Trainer:
    """The runs of a folder. All of it is used by one thread at a time."""

    def __init__(self, folder):
        self.folder, self.procedure, self.recorded = pathlib.Path(folder), None, None
        self.scene = self.folder / "thorax" / "thorax.json"
        if not self.scene.exists():
            sk.thorax(self.scene.parent, 40000)

    def begin(self, asked):
        """Begins a run, or with "replay" the repetition of a run, whose ticks are returned."""
        self.recorded = None
        if "replay" in asked:
            self.recorded = json.loads((self.folder / f"run-{int(asked['replay'])}.json").read_text(encoding="utf-8"))
        seed = self.recorded["seed"] if self.recorded else asked.get("seed", secrets.randbelow(2 ** 31))
        self.procedure = Procedure(self.scene, seed)
        return {"seed": seed, "rate": RATE, "kvp": KVP, "pixels": PIXELS, "limits": LIMITS, "ticks": self.recorded and self.recorded["ticks"]}

    def tick(self, asked):
        """The length of a text of JSON (32 bits), the text, and the grey values of the image if the pedal is held."""
        if self.procedure is None:
            raise ValueError("no run has begun")
        image = self.procedure.tick(asked)
        grey = b"" if image is None else np.clip((image - BLACK) * (255 / (WHITE - BLACK)), 0, 255).astype(np.uint8).tobytes()
        ring = self.procedure.on_detector(self.procedure.target)
        text = json.dumps({**self.procedure.state(), "ring": ring}).encode()
        return len(text).to_bytes(4, "little") + text + grey

    def end(self, _asked):
        """Ends the run: its row in runs.csv and its record. After a repetition, whether the images were the same."""
        procedure, self.procedure = self.procedure, None
        if procedure is None:
            raise ValueError("no run has begun")
        if self.recorded:
            return {**procedure.state(), "run": self.recorded["run"], "same": procedure.digest.hexdigest() == self.recorded["sha256"]}
        run = next(n for n in itertools.count(1) if not (self.folder / f"run-{n}.json").exists())
        row = {"run": run, "seed": procedure.seed, **procedure.state()}
        record = {**row, "sha256": procedure.digest.hexdigest(), "skiagraph": sk.__version__, "ticks": procedure.ticks}
        (self.folder / f"run-{run}.json").write_text(json.dumps(record), encoding="utf-8")
        with (self.folder / "runs.csv").open("a", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, COLUMNS)
            if file.tell() == 0:
                table.writeheader()
            table.writerow(row)
        return row


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        return self.answer({"/": lambda _: PAGE.read_bytes()}, {})

    def do_POST(self):
        trainer, size = self.server.trainer, self.headers.get("Content-Length", "")
        if not size.isdecimal() or int(size) > BODY_MAX:
            return self.reply(413, b"too long")
        return self.answer({"/begin": trainer.begin, "/tick": trainer.tick, "/end": trainer.end}, self.rfile.read(int(size)))

    def answer(self, acts, body):
        where = urllib.parse.urlsplit(self.path)
        token = urllib.parse.parse_qs(where.query).get("token", [""])[0]
        is_own = self.headers.get("Origin") in (None, self.server.origin)
        if not (is_own and hmac.compare_digest(token.encode(), self.server.token.encode())):
            return self.reply(403, b"the token of the address is missing or wrong")
        if where.path not in acts:
            return self.reply(404, b"there is nothing here")
        try:
            with self.server.lock:
                made = acts[where.path](json.loads(body) if body else {})
        except (ValueError, TypeError, KeyError, AttributeError, OSError, sk.Error) as error:
            return self.reply(400, f"{type(error).__name__}: {error}".encode())
        kind = "text/html; charset=utf-8" if where.path == "/" else "application/octet-stream"
        return self.reply(200, made if isinstance(made, bytes) else json.dumps(made).encode(), kind)

    def reply(self, status, data, kind="text/plain; charset=utf-8"):
        self.send_response(status)
        for name, value in (("Content-Type", kind), ("Content-Length", str(len(data))), ("Cache-Control", "no-store"),
                            ("Content-Security-Policy", "default-src 'self' 'unsafe-inline' data:"), ("Referrer-Policy", "no-referrer")):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, trainer, port=0):
        super().__init__(("127.0.0.1", port), Handler)
        self.trainer, self.token, self.lock = trainer, secrets.token_hex(16), threading.Lock()
        self.origin = f"http://127.0.0.1:{self.server_port}"
        self.url = f"{self.origin}/?token={self.token}"


def main():
    parser = argparse.ArgumentParser(description="A trainer for percutaneous transhepatic cholangiography.")
    parser.add_argument("--folder", default="trainer-runs", help="of the thorax, the table and the records; made if need be")
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--no-open", action="store_true", help="opens no browser")
    parser.add_argument("--replay", type=int, metavar="RUN")
    asked = parser.parse_args()
    trainer = Trainer(asked.folder)
    if asked.replay is not None:
        for tick in trainer.begin({"replay": asked.replay})["ticks"]:
            trainer.tick(tick)
        is_same = trainer.end({})["same"]
        print("the same images" if is_same else "other images")
        return int(not is_same)
    server = Server(trainer, asked.port)
    print(server.url, flush=True)
    if not asked.no_open:
        webbrowser.open(server.url)
    with contextlib.suppress(KeyboardInterrupt):
        server.serve_forever()
    return 0


if __name__ == "__main__":
    sys.exit(main())
