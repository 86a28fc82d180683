"""scene.live() without a browser: messages in, texts and frames out, and the scene in between."""
import asyncio
import importlib.util
import json
import pathlib
import pickle
import struct
import sys
import threading

import numpy as np
import pytest

import skiagraph as sk
from skiagraph import _command
from skiagraph._live import hub as hubs
from skiagraph._live import page, widget

HEADER = struct.Struct("<4sIIHHdddfHBB")
PICTURE = struct.Struct("<4sIHHf")
LOOK = {"number": 7, "size": [64, 48], "target": [0, 0, 0], "distance": 300, "from": [0.2, -1, 0.3], "up": [0, 0, 1], "background": [10, 20, 30]}
SAME = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def shift(x, y=0.0, z=0.0):
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1]


class Page:
    """A view of the hub, as the page is one."""

    def __init__(self, hub, name="a"):
        self.hub, self.name, self.heard, self.files, self.frames, self.texts, self.pages = hub, name, 0, [], [], [], 0
        before = hub.send
        hub.send = lambda content, buffers: (before(content, buffers), self.take(json.loads(json.dumps(content)), buffers))
        self.say()
        self.sent = self.last("scene")["scene"]["state"]["wish"] if self.texts else 0

    def take(self, content, buffers):
        if content.get("to", self.name) != self.name:
            return
        if "text" in content:
            self.texts.append(content["text"])
            if "adopted" in content["text"]:
                self.sent = content["text"]["adopted"]["wish"]
        elif content.get("heard"):
            self.heard += 1
        elif content.get("page"):
            self.pages += 1
        else:
            (self.frames if buffers[0][:4] == b"SKLF" else self.files).append(buffers[0])

    def say(self, *messages):
        heard = self.heard
        self.hub.hear({"view": self.name, "messages": list(messages)})
        assert self.heard == heard + 1

    def ack(self):
        self.say({"ack": self.number})

    def wish(self, **keys):
        self.sent += 1
        self.say({"ack": self.number}, {"wish": self.sent, **keys})

    @property
    def number(self):
        return HEADER.unpack_from(self.frames[-1])[1]

    def picture(self, **keys):
        """The pixels that answer a look."""
        count = len(self.files)
        self.say({"look": LOOK | keys})
        assert len(self.files) == count + 1
        mark, number, columns, rows, ms = PICTURE.unpack_from(self.files[-1])
        pixels = self.files[-1][PICTURE.size:]
        assert (mark, number) == (b"SKLP", 7) and ms > 0 and len(pixels) == 4 * columns * rows
        return pixels

    def last(self, key):
        return next(text for text in reversed(self.texts) if key in text)

    def image(self):
        """The last frame as values."""
        _, _, _, columns, rows, low, step, *_ = HEADER.unpack_from(self.frames[-1])
        return low + step * np.frombuffer(self.frames[-1], "<u2", offset=HEADER.size).reshape(rows, columns)

    def check(self, scene, quantity="attenuation"):
        """The last frame is the scene's image; a number stands for values within half a step."""
        image, step = scene.image(quantity, index=0), HEADER.unpack_from(self.frames[-1])[6]
        np.testing.assert_allclose(self.image(), image, atol=0.51 * step + 1e-6 * np.abs(image).max())


@pytest.fixture
def solid(view):
    """A scene of matter that depends on the energy."""
    made = sk.Scene()
    made.add("block", sk.Mesh.cube(40), material="Water")
    made.add("ball", sk.Mesh.sphere(10, 64), material="Aluminium", inside="block")
    made.view, made.beam = view, sk.Beam.mono(60, 1000)
    return made


@pytest.fixture
def hub(solid):
    return hubs.Hub(solid._state)


def test_a_page_begins(solid, hub):
    one = Page(hub)
    assert one.last("role") == {"role": "owner"}
    its = one.last("scene")["scene"]
    assert its["parts"] == 2 and its["projections"] == 0 and its["period"] is None and its["jaws"] is None
    assert its["document"]["Source"]["Beam"] == [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]
    assert one.last("shot")["view"]["source"] == [0, 0, -1000] and one.last("shot")["beam"]["photons"] == 1000
    one.check(solid)
    html = page.html(hub._subject).decode()
    assert '"SCENE"' not in html and ">BYTES<" not in html and "<script src=" not in html


def test_what_is_dragged_is_in_the_scene(solid, hub):
    one = Page(hub)
    first = one.image()
    one.wish(poses={"1": shift(5)}, settings={"Source.Position": [3, 0, -900, "mm"]}, drag=True)
    assert (solid["ball"].pose == sk.translate(5, 0, 0)).all() and solid.view.source.tolist() == [3, 0, -900]
    one.check(solid)
    one.wish(settings={"Detector.Position": [0, 0, 150, "mm"], "Detector.ColumnStep": [0, 2, 0, "mm"], "Detector.RowStep": [2, 0, 0, "mm"]})
    assert solid.view.detector.tolist() == [0, 0, 150] and solid.view.column_step.tolist() == [0, 2, 0]
    assert (solid["ball"].pose == np.eye(4)).all()
    one.check(solid)
    one.wish()
    assert (one.image() == first).all() and solid.view.source.tolist() == [0, 0, -1000]


def test_beam_and_options_are_in_the_scene(solid, hub, tmp_path):
    one = Page(hub)
    settings = {"Source.Beam": {"kVp": 80, "mAs": 1, "Filter": [["Al", 2.5, "mm"]]}, "Source.Shape": ["Disc", 2, "mm"],
                "Collimation": {"Field": "detector", "Margin": [-20, "mm"]}, "Tolerance": 0.01}
    one.wish(settings=settings, quantity="transmission")
    assert solid.beam.absolute and 30 < solid.beam.quality["mean_kev"] < 60
    one.check(solid, "transmission")
    its = one.last("scene")["scene"]
    assert its["jaws"] == {"margin": -20} and its["spot"] == {"shape": 4, "extent": [2, 2]} and its["document"]["Source"]["Shape"] == "PointSource"
    image = solid.image()
    solid.save(tmp_path / "scene.json")
    assert (sk.Scene(tmp_path / "scene.json").image() == image).all()
    assert (pickle.loads(pickle.dumps(solid)).image() == image).all()
    assert json.loads((tmp_path / "scene.json").read_text())["Source"]["Beam"]["kVp"] == 80
    one.wish()
    assert len(solid.beam.energies) == 1 and one.last("scene")["scene"]["jaws"] is None


@pytest.mark.parametrize("message, sentence", [
    (7, "no JSON"), ([], "no JSON object"), ({}, "key wish, ack"), ({"wish": "x"}, "no number of a wish"),
    ({"wish": -1}, "no number"), ({"wish": True}, "no number"), ({"wish": 1, "drag": 1}, "neither true nor false"), ({"wish": 1, "what": 2}, 'no key "what"'),
    ({"wish": 1, "settings": [1]}, "no object"), ({"wish": 1, "settings": {"": 1}}, "no key of a scene file"),
    ({"wish": 1, "settings": {"a=b": 1}}, "no key of a scene file"), ({"wish": 1, "poses": {"x": SAME}}, "no number of a part"),
    ({"wish": 1, "poses": {"0": SAME[:15]}}, "16 numbers"), ({"wish": 1, "poses": {"0": [*SAME[:12], 0, 0, 0, 2]}}, "16 numbers"),
    ({"wish": 1, "poses": {"0": [float("nan"), *SAME[1:]]}}, "no JSON"), ({"wish": 1, "phase": 1.5}, "below 1"),
    ({"wish": 1, "projection": 0.5}, "whole number"), ({"wish": 1, "quantity": ["energy"]}, "quantity"), ({"ack": None}, "number of a frame"),
    ({"probe": [1]}, "column, row"), ({"take": "exe"}, "png, tif or mha"), ({"look": 1}, '"size" is missing'),
    *(({"look": LOOK | bad}, f'"look": "{next(iter(bad))}" is') for bad in (
        {"size": [0, 1]}, {"size": [4096, 4096]}, {"size": [64, True]}, {"distance": 0}, {"distance": [1]}, {"target": [1, 2]}, {"up": "x"}, {"what": 1},
        {"cut": [1, 2, 3]}, {"parts": {"x": [1, 2, 3, 4]}}, {"parts": {"0": [1, 2, 3, 256]}}, {"parts": []}, {"number": -1}, {"parallel": 1})), ({"measure": True}, "skiagraph live"),
    ({"register": 1}, "scene.register"), ({"reconstruct": None}, "sk.reconstruct")])
def test_malformed_messages_are_refused(hub, message, sentence):
    one = Page(hub)
    frames, files = len(one.frames), len(one.files)
    one.say(message)
    assert sentence in one.last("refused")["refused"] and (len(one.frames), len(one.files)) == (frames, files)
    for nothing in (None, 3, {}, {"view": 1}, {"view": "a"}, {"view": "a", "messages": 1}):
        hub.hear(nothing)


@pytest.mark.parametrize("keys, sentence", [
    ({"settings": {"Source.Beem": 1}}, "Beem"), ({"settings": {"Samples.ball.Density": 3}}, "changed by Python"), ({"poses": {"2": SAME}}, "no part 2"),
    ({"phase": 0.5}, "does not breathe"), ({"projection": 3}, "no projection 3"), ({"poses": {"0": [0.0] * 15 + [1]}}, "part")])
def test_an_error_keeps_the_last_frame(solid, hub, keys, sentence):
    one = Page(hub)
    one.wish(poses={"1": shift(4)})
    frames = len(one.frames)
    one.wish(**keys)
    assert sentence in one.last("error")["error"] and one.last("error")["wish"] == one.sent and len(one.frames) == frames
    assert (solid["ball"].pose == sk.translate(4, 0, 0)).all() or "poses" in keys
    one.wish(poses={"1": shift(6)})
    assert len(one.frames) == frames + 1
    one.check(solid)


def test_bands_are_shown_one_at_a_time(solid, hub):
    solid.beam = sk.Beam.tube(80, mas=1)
    one = Page(hub)
    one.wish(bands=[20, 40, 60], channel=1)
    both, step = solid.image("attenuation", bands=[20, 40, 60], index=0), HEADER.unpack_from(one.frames[-1])[6]
    np.testing.assert_allclose(one.image(), both[1], atol=0.51 * step + 1e-6 * np.abs(both[1]).max())
    assert np.abs(both[0] - both[1]).max() > 100 * step
    frames = len(one.frames)
    one.wish(bands=[20, 40, 60], channel=2)
    assert "no band 2" in one.last("error")["error"] and len(one.frames) == frames
    one.wish(bands=[40, 20])
    assert '"bands": edge 2' in one.last("refused")["refused"]
    one.wish()
    one.check(solid)


def test_frames_that_are_not_taken_are_dropped(solid, hub):
    one = Page(hub)
    one.ack()
    for x in (1, 2, 3, 4):
        one.sent += 1
        one.say({"wish": one.sent, "poses": {"1": shift(x)}})
    assert len(one.frames) == 3  # the first, and two under way
    assert one.last("shot")["wish"] == one.sent - 2
    one.ack()
    assert len(one.frames) == 4 and one.last("shot")["wish"] == one.sent
    one.check(solid)


def test_what_python_assigns_is_shown(solid, hub):
    one = Page(hub)
    one.wish(poses={"0": shift(1), "1": shift(2)})
    solid["ball"].pose = sk.translate(0, 3, 0)
    late = one.sent + 1
    hub.refresh()
    adopted = one.last("adopted")
    assert adopted["adopted"]["poses"] == {"0": shift(1), "1": shift(0, 3)} and not adopted["fresh"]
    one.check(solid)
    frames = len(one.frames)
    one.say({"wish": late, "poses": {}})  # sent before the page knew
    assert solid["ball"].pose[1, 3] == 3 and len(one.frames) == frames
    hub.refresh()
    assert len(one.frames) == frames  # nothing has changed
    solid["ball"].material = "Iron"
    hub.refresh()
    assert len(one.frames) == frames + 1
    one.check(solid)


def test_view_and_beam_that_python_assigns_are_a_new_beginning(solid, hub):
    one = Page(hub)
    one.wish(poses={"1": shift(2)}, settings={"Source.Position": [5, 0, -1000, "mm"], "Noise": True})
    solid.view.source[1] = 40
    hub.refresh()
    assert one.last("adopted")["fresh"] and one.last("adopted")["adopted"]["settings"] == {}
    document = one.last("scene")["scene"]["document"]
    assert document["Source"]["Position"] == [5, 40, -1000, "mm"] and document["Noise"] is True
    one.check(solid)
    solid.beam = sk.Beam.tube(90, filters={"Al": 2})
    hub.refresh()
    assert "Bins" in one.last("scene")["scene"]["document"]["Source"]["Beam"]
    one.wish(settings={"Noise": False})
    one.check(solid)
    assert len(solid.beam.energies) > 10 and solid["ball"].pose[0, 3] == 2


def test_other_parts_are_another_page(solid, hub):
    one = Page(hub)
    solid.add("rod", sk.Mesh.cylinder(3, 60, 24), material="Iron")
    hub.refresh()
    assert one.pages == 1
    one.say()
    assert one.last("scene")["scene"]["parts"] == 3
    one.check(solid)
    solid["block"].mesh.vertices = 1.2 * solid["block"].mesh.vertices
    hub.refresh()
    assert one.pages == 2
    one.say()
    solid.close()
    hub.refresh()
    assert "closed" in one.last("error")["error"]
    count = len(one.texts)
    hub.refresh()
    assert len(one.texts) == count


def test_the_newest_of_several_pages_changes_the_scene(solid, hub):
    first = Page(hub, "first")
    second = Page(hub, "second")
    assert first.last("role")["role"] == "reader" and second.last("role")["role"] == "owner"
    first.wish(poses={"1": shift(9)})
    assert "another page" in first.last("refused")["refused"] and solid["ball"].pose[0, 3] == 0
    second.wish(poses={"1": shift(9)})
    assert first.frames[-1] == second.frames[-1] and solid["ball"].pose[0, 3] == 9
    hub.hear({"view": "second", "gone": True})
    assert first.last("role")["role"] == "owner"


def test_probe_and_files(solid, hub):
    one = Page(hub)
    one.say({"probe": [32, 24]})
    found = dict(one.last("probed")["parts"])
    assert found == pytest.approx({label: lengths[24, 32] for label, lengths in solid.lengths().items()}, abs=1e-4)
    one.say({"probe": [64, 0]})
    assert "no such pixel" in one.last("error")["error"]
    for ending in ("png", "tif", "mha"):
        one.say({"take": ending})
        length = struct.unpack_from("<I", one.files[-1], 4)[0]
        assert one.files[-1][:4] == b"SKLB" and one.files[-1][8:8 + length].decode() == f"image.{ending}"


def test_pictures_of_the_3d_view(solid, hub):
    one = Page(hub, "first")
    first = one.picture()
    assert first[:4] == bytes([10, 20, 30, 255]) and one.picture() == first
    others = [one.picture(**keys) for keys in (
        {"from": [0.1, -1, 0]}, {"up": [0.1, 0, 1]}, {"target": [5, 0, 0]}, {"distance": 420}, {"parallel": True}, {"background": [10, 20, 31]},
        {"cut": [0, -1, 0, 0]}, {"parts": {"0": [1, 2, 3, 255]}}, {"parts": {"0": [1, 2, 3, 0]}}, {"distance": 900, "grey": [0, 3]},
        {"distance": 900, "grey": [3, 0]}, {"size": [31, 17]})]
    assert len(set(others)) == len(others) and first not in others
    one.wish(poses={"0": shift(16, 0, -8)})
    assert one.picture() != first
    one.wish()
    assert one.picture() == first and one.picture(parts={"0": [0] * 4, "1": [0] * 4}) != first
    second = Page(hub, "second")
    assert second.picture() == first and one.picture() == first  # a page that only shows the scene may look, too
    solid.close()
    assert one.picture() == b"" and "closed" in one.last("refused")["refused"]


def test_projections_follow_the_source():
    made = sk.Scene({"Source": {"Position": [0, 0, -1000, "mm"], "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
                     "Detector": {"Position": [0, 0, 200, "mm"], "UpVector": [0, 1, 0], "NumberOfPixels": [64, 48], "Size": [128, 96, "mm"]},
                     "Scan": {"NumberOfProjections": 4, "AngleStep": 90}})
    made.add("block", sk.Mesh.cube(40), material="Water")
    one = Page(hubs.Hub(made._state))
    its = one.last("scene")["scene"]
    assert its["projections"] == 4 and np.allclose(its["angles"], [0, 90, 180, 270])
    one.wish(projection=1)
    seen = np.array(one.last("shot")["view"]["source"])
    one.wish(projection=1, settings={"Source.Position": [0, 0, -1200, "mm"]})
    assert np.allclose(np.linalg.norm(one.last("shot")["view"]["source"]), 1200) and not np.allclose(seen, one.last("shot")["view"]["source"])
    assert made.view.source.tolist() == [0, 0, -1200]  # the scene's own view


def test_a_scene_breathes(tmp_path):
    sk.thorax(tmp_path, 10000, simple=True)
    scene = sk.Scene(tmp_path / "thorax.json", settings={"Detector.NumberOfPixels": [60, 60], "Tolerance": 0})
    before = [part.mesh.vertices for part in scene]
    one = Page(hubs.Hub(scene._state))
    its = one.last("scene")["scene"]
    assert its["period"] > 1
    first = one.image()
    one.wish(phase=0.5)
    assert scene._state.breath == {"phase": 0.5} and np.abs(one.image() - first).max() > 0.01
    one.check(scene)
    scene.breathe(phase=0.25)
    one.hub.refresh()
    assert one.last("adopted")["adopted"]["phase"] == 0.25
    one.wish(phase=0.25, play=True)
    for _ in range(3):
        one.ack()
    assert one.last("shot")["phase"] > 0.25
    one.wish(play=False)
    assert (one.image() == first).all() and all((part.mesh.vertices == old).all() for part, old in zip(scene, before))
    assert one.pages == 0
    scene.remove("needle" if "needle" in [part.label for part in scene] else next(iter(scene)).label)
    one.hub.refresh()  # the breath links the parts of the file, so that it has ended
    one.say()
    assert one.pages == 1 and one.last("scene")["scene"]["period"] is None
    one.check(scene)


CONVERSATION = pathlib.Path(__file__).parents[1] / "cli" / "live_conversation.json"
#: What differs from one run to the next, or is the transport's own: times, numbers of frames, memory of the device at that moment, and
#: what only one of the two knows.
OTHERS = {"ms", "stages", "shot", "load_ms", "plan_ms", "device_mib", "geometry", "document", "path", "without", "dose", "warnings"}


def client():
    """The plain client of the command's tests."""
    path = pathlib.Path(__file__).parents[1] / "cli" / "live_client.py"
    spec = importlib.util.spec_from_file_location("live_client", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def bare(value):
    return {key: bare(its) for key, its in value.items() if key not in OTHERS} if isinstance(value, dict) else value


def without_times(message):
    """A message to a page as bytes, without numbers that differ from one run to the next."""
    if isinstance(message, dict):
        return json.dumps(bare(message)).encode()
    mark, data = message[:4], bytearray(message)
    if mark == b"SKLF":
        data[4:8] = data[40:44] = bytes(4)  # number of the frame, ms
    elif mark == b"SKLP":
        data[12:16] = bytes(4)  # ms
    return bytes(data)


class Command:
    """A page of the command's server, with the calls of a notebook's."""

    def __init__(self, server, module):
        self.page, self.module = module.Page(server), module
        self.page.find(lambda m: isinstance(m, dict) and "shot" in m)

    def ask(self, message, marks):
        """Sends a message. Its answers, of which there is one that begins with each of the marks, in their order."""
        self.page.send_raw(1, json.dumps(message).encode())
        found = {}
        while len(found) < len(marks):
            code, data = self.page.receive_raw()
            if data[:4] == b"SKLF":
                self.page.send({"ack": struct.unpack_from("<I", data, 4)[0]})
            answer = json.loads(data) if code == 1 else data
            mark = mark_of(answer)
            wish = message.get("wish") if isinstance(message, dict) else None
            if mark in marks and mark not in found and (wish is None or of_wish(answer) in (None, wish)):
                found[mark] = without_times(answer)
        return [found[mark] for mark in marks]


def mark_of(answer):
    return next(iter(answer)) if isinstance(answer, dict) else answer[:4].decode()


def of_wish(answer):
    """The wish that an answer is about; None: it is about none."""
    if isinstance(answer, dict):
        return answer["scene"]["state"]["wish"] if "scene" in answer else answer.get("wish")
    return HEADER.unpack_from(answer)[2] if answer[:4] == b"SKLF" else None


def ask(page, message, marks):
    """Sends a message to a page in a notebook, and gets the answers as from the command's."""
    counts = len(page.texts), len(page.frames), len(page.files)
    page.ack()
    page.say(message)
    answers = page.texts[counts[0]:] + page.frames[counts[1]:] + page.files[counts[2]:]
    found = {mark_of(answer): without_times(answer) for answer in answers}
    return [found[mark] for mark in marks]


@pytest.mark.parametrize("radius", [0, 150])  # flat, and curved
def test_a_conversation_is_the_same_with_the_command(command, solid, tmp_path, radius):
    """Both transports answer a conversation byte for byte, times and numbers of frames aside."""
    solid.view.radius = radius
    solid.save(tmp_path / "scene.json")
    scene = json.loads((tmp_path / "scene.json").read_text())
    (tmp_path / "scene.json").write_text(json.dumps(scene | {"Scan": {"NumberOfProjections": 4, "AngleStep": 90}}))
    one = Page(hubs.Hub(sk.Scene(tmp_path / "scene.json")._state))
    module = client()
    try:
        server = module.Server(_command.path(), str(tmp_path / "scene.json"))
    except RuntimeError as error:
        pytest.skip(str(error))
    first = one.sent + 1  # of a notebook's page, whose numbers go on from it
    with server:
        other = Command(server, module)
        for step in json.loads(CONVERSATION.read_text()):
            if radius and step.get("flat"):
                continue
            message, marks = step["say"], step["answers"]
            if isinstance(message, dict) and type(message.get("wish")) is int and message["wish"] >= 0:
                message = message | {"wish": first + message["wish"]}
            for mark, mine, its in zip(marks, ask(one, message, marks), other.ask(message, marks), strict=True):
                assert mine == its, (mark, message)
        other.page.close()
    assert one.last("shot")["view"]["strips"] and len(one.last("shot")["view"]["strips"]) == (24 if radius else 2)


def test_a_large_scene_is_shown_by_fewer_triangles():
    ball = sk.Mesh.sphere(10, 256)
    origin, faces = page._thin(ball.vertices, ball.faces, 0.1)
    assert 0.02 * len(ball.faces) < len(faces) < 0.3 * len(ball.faces) and faces.max() < len(origin)
    assert np.allclose(np.linalg.norm(ball.vertices[origin], axis=1), 10)


def test_without_anywidget_it_says_what_to_install(solid, monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    widget._kind.cache_clear()
    with pytest.raises(sk.UnsupportedError, match=r"pip install \"skiagraph\[notebook\]\""):
        solid.live()
    widget._kind.cache_clear()


def test_the_widget(solid):
    pytest.importorskip("anywidget")
    made = solid.live(height=500)
    told = []
    made.send = lambda content, buffers=None: told.append((content, buffers))
    made._handle_custom_msg({"view": "a", "page": True}, [])
    assert made.height == 500 and told[-1][0]["page"] and b"</html>" in told[-1][1][0]
    made._handle_custom_msg({"view": "a", "messages": []}, [])
    made._handle_custom_msg({"view": "a", "messages": [{"wish": 2 ** 17, "poses": {"1": shift(5)}}]}, [])
    assert solid["ball"].pose[0, 3] == 5
    told.clear()
    solid["ball"].pose = np.eye(4)
    made.refresh()
    assert any("adopted" in content.get("text", {}) for content, _ in told)
    made.close()


def test_messages_wait_for_the_thread_of_cells(solid):
    """Kernels with subshells deliver them in another thread, also while a cell runs."""
    pytest.importorskip("anywidget")

    async def cell():
        made = solid.live()
        message = {"view": "a", "messages": [{"wish": 2 ** 17, "poses": {"1": shift(5)}}]}
        thread = threading.Thread(target=made._handle_custom_msg, args=(message, []))
        thread.start()
        thread.join()
        assert solid["ball"].pose[0, 3] == 0
        await asyncio.sleep(0.01)
        assert solid["ball"].pose[0, 3] == 5
        made.close()

    asyncio.run(cell())


def test_a_scene_that_was_pickled(solid, tmp_path):
    solid.save(tmp_path / "scene.json")
    scene = pickle.loads(pickle.dumps(sk.Scene(tmp_path / "scene.json")))
    one = Page(hubs.Hub(scene._state))
    one.wish(settings={"Noise": True}, poses={"0": shift(1)})
    one.check(scene)


def test_nobody_is_shown_nothing(solid, hub):
    """A widget whose cell was run again makes no images."""
    one = Page(hub)
    hub.hear({"view": "a", "gone": True})
    solid["ball"].pose = sk.translate(1, 0, 0)
    frames = len(one.frames)
    hub.refresh()
    assert len(one.frames) == frames
    one.say()
    assert one.last("shot")["state"]["poses"] == {"1": shift(1)}
    one.check(solid)


def test_a_scene_that_cannot_be_shown_fails_at_once():
    with pytest.raises(sk.SceneError, match="no beam"):
        hubs.Hub(sk.Scene()._state)
