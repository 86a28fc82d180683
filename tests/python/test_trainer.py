"""The example examples/trainer without a browser: a run, its score, its row of the table, and its replay."""
import csv
import json
import pathlib
import subprocess
import sys
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest

import skiagraph as sk

FOLDER = pathlib.Path(__file__).parents[2] / "examples" / "trainer"
REST = {"depth": 0, "yaw": 0, "pitch": 0, "arm": 0, "pedal": False, "inject": False}


@pytest.fixture(scope="module")
def modules():
    sys.path.insert(0, str(FOLDER))
    import procedure
    import trainer
    yield procedure, trainer
    sys.path.remove(str(FOLDER))


@pytest.fixture(scope="module")
def server(modules, tmp_path_factory):
    its = modules[1].Server(modules[1].Trainer(tmp_path_factory.mktemp("runs")))
    thread = threading.Thread(target=its.serve_forever)
    thread.start()
    yield its
    its.shutdown()
    thread.join()
    its.server_close()


def ask(server, path, body=None, token=None, **headers):
    url = f"{server.origin}/{path}?token={server.token if token is None else token}"
    data = None if body is None else body if isinstance(body, bytes) else json.dumps(body).encode()
    with urllib.request.urlopen(urllib.request.Request(url, data, headers), timeout=120) as answer:
        return answer.read()


def refused(server, *words, **keys):
    with pytest.raises(urllib.error.HTTPError) as raised:
        ask(server, *words, **keys)
    return raised.value.code


def tick(server, **controls):
    """The state, and the image; None while the pedal is up."""
    data = ask(server, "tick", REST | controls)
    end = 4 + int.from_bytes(data[:4], "little")
    return json.loads(data[4:end]), np.frombuffer(data[end:], np.uint8).reshape(320, 320) if len(data) > end else None


def aim(run):
    """The controls that bring the tip to the target."""
    way = run.target - run.entry
    length = np.linalg.norm(way)
    best = None
    for yaw in np.arange(-60, 61, 1.0):
        for pitch in np.arange(-60, 61, 1.0):
            turn = sk.rotate("y", -yaw) @ sk.rotate(np.cross(run._along, (0, 1, 0)), -pitch)
            miss = np.linalg.norm(turn[:3, :3] @ run._along - way / length)
            if best is None or miss < best[0]:
                best = miss, yaw, pitch
    return {"depth": float(length), "yaw": best[1], "pitch": best[2]}


def test_a_run(server):
    assert b"</html>" in ask(server, "")
    begun = json.loads(ask(server, "begin", {"seed": 3}))
    assert begun["seed"] == 3 and begun["ticks"] is None
    state, image = tick(server)
    assert image is None and state["kerma_mgy"] == 0 and state["score"] < 50
    run = server.trainer.procedure
    near = aim(run)
    before, image = tick(server, pedal=True)
    column, row = (round(x) for x in before["ring"])
    half, there = tick(server, **near | {"depth": near["depth"] / 2}, pedal=True)
    assert half["kerma_mgy"] == pytest.approx(2 * before["kerma_mgy"], abs=1e-4) and half["tip_to_target_mm"] < before["tip_to_target_mm"]
    assert (image != there).any()
    state, there = tick(server, **near, pedal=True)
    assert state["tip_to_target_mm"] < 1.5
    around = np.s_[row - 2:row + 3, column - 2:column + 3]
    assert there[around].mean() < image[around].mean() - 2  # the needle is dark where the ring is
    for _ in range(10):
        state, _ = tick(server, **near, inject=True)
    assert state["in_ducts_ml"] == 0.625 and state["outside_ml"] == 0
    state, filled = tick(server, **near, pedal=True)
    assert filled.mean() < there.mean() - 0.01
    state, _ = tick(server, **near | {"depth": near["depth"] / 3}, inject=True)
    assert state["outside_ml"] == 0.0625
    state, turned = tick(server, **near, arm=40, pedal=True)
    assert np.abs(turned.astype(float) - filled).mean() > 3 and state["score"] > 80
    row = json.loads(ask(server, "end", {}))
    with (server.trainer.folder / "runs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows == [{key: str(value) for key, value in row.items()}] and rows[0]["run"] == "1" and float(rows[0]["score"]) == state["score"]
    assert float(rows[0]["fluoroscopy_s"]) == 5 / 8
    assert refused(server, "tick", REST) == 400


@pytest.mark.full  # test_a_run
def test_the_replay_has_the_same_images(server, modules):
    """After test_a_run: by the server, by the program, and image by image."""
    folder = server.trainer.folder
    for pedal in (True, True, False):
        begun = json.loads(ask(server, "begin", {"replay": 1}))
        for its in begun["ticks"]:
            tick(server, **its | {"pedal": its["pedal"] and pedal})
        assert json.loads(ask(server, "end", {}))["same"] is pedal
    assert len((folder / "runs.csv").read_text(encoding="utf-8").splitlines()) == 2
    first, second = (modules[0].Procedure(server.trainer.scene, begun["seed"]) for _ in range(2))
    for its in begun["ticks"]:
        one, other = first.tick(its), second.tick(its)
        assert (one is None and other is None) or one.tobytes() == other.tobytes()
    program = [sys.executable, str(FOLDER / "trainer.py"), "--folder", str(folder), "--replay", "1"]
    assert subprocess.run(program, check=True, capture_output=True, text=True).stdout == "the same images\n"
    path = folder / "run-1.json"
    record = json.loads(path.read_text(encoding="utf-8"))
    record["ticks"][2]["depth"] += 1
    path.write_text(json.dumps(record), encoding="utf-8")
    assert subprocess.run(program, check=False, capture_output=True, text=True).returncode == 1


def test_who_may_ask(server):
    assert refused(server, "", token="0" * 32) == 403 and refused(server, "tick", REST, token="") == 403
    assert refused(server, "begin", {}, Origin="http://example.com") == 403
    assert refused(server, "procedure.py") == 404 and refused(server, "../procedure.py", {}) == 404
    assert refused(server, "begin", {"replay": 99}) == 400 and refused(server, "begin", {"replay": "../1"}) == 400
    assert refused(server, "begin", b"x" * 5000) == 413 and refused(server, "begin", b"[") == 400
    ask(server, "begin", {"seed": 1})
    for bad in ({}, REST | {"depth": "x"}, REST | {"yaw": float("nan")}, [1], 3):
        assert refused(server, "tick", bad) == 400
    state, _ = tick(server, depth=1e9)
    assert state["tip_to_target_mm"] < 1000 and server.server_address[0] == "127.0.0.1"
