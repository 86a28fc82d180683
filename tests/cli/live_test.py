"""The server of `skiagraph live`, by a plain client.

usage: live_test.py COMMAND [TEST...]
"""
import faulthandler
import json
import math
import os
import random
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

from live_client import LIMIT, Frame, Page, Server

SCENE = {
    "Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
    "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1], "RightVector": [1, 0, 0], "NumberOfPixels": [80, 60],
                 "Size": [32, 24, "cm"]},
    "Samples": [{"Label": "tissue", "Cube": [80, "mm"], "Material": ["mu", 0.2], "Type": "outer"},
                {"Label": "bone", "Cylinder": [32, 60, 12, "mm"], "Material": ["mu", 0.5]}],
    "Scan": {"NumberOfProjections": 4, "FinalAngle": 360}}
command = sys.argv[1]
EPS = 2.0**-24  # half a step of a float of 1


def image(path, *words):
    """The pixels that the verb image computes."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "a.mha")
        subprocess.run([command, "image", path, *words, "-o", file, "--quiet"], check=True)
        with open(file, "rb") as stream:
            data = stream.read()
    head, _, pixels = data.partition(b"ElementDataFile = LOCAL\n")
    kind, size = ("f", 4) if b"MET_FLOAT" in head else ("d", 8)
    return struct.unpack(f"<{len(pixels) // size}{kind}", pixels)


def check_same(frame, pixels):
    """A frame is an image within half of a step of its 16 bits, and what rounding to float adds to that."""
    largest = max(map(abs, pixels))
    for n, pixel in zip(frame.numbers, pixels, strict=True):
        off = abs(frame.low + frame.step * n - pixel)
        assert off <= 0.51 * frame.step + 4 * EPS * largest, (off, frame.step)


def differ(a, b):
    return (a.low, a.step, a.numbers) != (b.low, b.step, b.numbers)


def join(server, **keys):
    """A page, as soon as the server has seen that pages before it have gone: it takes eight."""
    end = time.monotonic() + LIMIT
    while (page := Page(server, **keys)).status == 503 and time.monotonic() < end:
        page.close()
        time.sleep(0.01)
    assert page.status == 101
    return page


def put(path, text):
    """Another text in a file, at once, so that nobody reads a part of it."""
    with open(path + ".new", "w", encoding="ascii") as file:
        file.write(text)
    os.replace(path + ".new", path)


def token_and_origin(path):
    with Server(command, path) as server:
        for wrong in ("/", "/?token=", "/?token=" + "0" * 32, "/?token=" + server.token[:-1], "/socket", "/scene.json"):
            status, text = server.get(wrong)
            assert status == 403 and server.token not in text and "tissue" not in text, wrong
        status, text = server.get("/?token=" + server.token)
        assert status == 200 and "tissue" in text and "Content-Security-Policy: default-src 'none'" in text
        assert "http://" not in text.partition("\r\n\r\n")[2].replace("http://www.w3.org/2000/svg", "")
        for missing in ("/page.js", "/../etc/passwd", "/%2e%2e/etc/passwd", "/scene.json", "/socket"):
            assert server.get(f"{missing}?token={server.token}")[0] == 404, missing
        assert server.get("/?token=" + server.token, ["Origin: http://elsewhere.example"])[0] == 403
        assert server.get("/?token=" + server.token, method="POST")[0] == 405
        assert Page(server, token="0" * 32).status == 403
        assert Page(server, origin="http://elsewhere.example").status == 403
        assert Page(server, origin=f"http://127.0.0.1:{server.port}").status == 101
        assert server.end() == 0


def hosts(path):
    """Only the name that was bound is answered, by any port; of this machine itself, its three names."""
    for bound in ("127.0.0.1", "localhost"):
        with Server(command, path, "--bind", bound) as server:
            page = "/?token=" + server.token
            for host in ("127.0.0.1", "localhost:1", f"LOCALHOST:{server.port}", "[::1]:8765"):
                assert server.get(page, host=host)[0] == 200, host
            # CivetWeb refuses a request of HTTP 1.1 without a host by itself
            for host in ("elsewhere.example", f"elsewhere.example:{server.port}", "127.0.0.1.example", "10.0.0.1", "", "[::2]", "[", ":80"):
                status, text = server.get(page, host=host)
                assert status in (400, 421) and "tissue" not in text, (host, status)
            assert server.end() == 0 and "--bind" not in server.process.stderr.read()
    with Server(command, path, "--bind", "0.0.0.0") as server:
        page, named = "/?token=" + server.token, server.url.partition("://")[2].partition(":")[0]
        assert [server.get(page, host=host)[0] for host in (named, "10.0.0.1", "localhost", "elsewhere.example")] == [200, 200, 200, 421]
        assert server.end() == 0 and "from other machines too" in server.process.stderr.read()


def silent(path):
    """Connections that say nothing, or never end their header, do not keep the page away."""
    with Server(command, path) as server:
        idle = [socket.create_connection(("127.0.0.1", server.port), timeout=LIMIT) for _ in range(100)]
        for one in idle[:50]:
            one.sendall(b"GET / HTTP/1.1\r\nHost: ")
        # seconds: with 12 threads and 10 s a header, as it once was, this took 83
        assert server.get("/?token=" + server.token, limit=40)[0] == 200
        for one in idle:
            while one.recv(4096):
                pass
            one.close()
        assert server.end() == 0


def browser(path):
    """The browser is given a file that others cannot read: the words of a process are everybody's. It goes away at the end."""
    with tempfile.TemporaryDirectory() as folder:
        program, said = os.path.join(folder, "xdg-open"), os.path.join(folder, "said")
        with open(program, "w", encoding="ascii") as file:
            file.write(f'#!/bin/sh\necho "$*" >"{said}.new"\nmv "{said}.new" "{said}"\n')
        os.chmod(program, 0o755)
        desktop = {"PATH": folder + os.pathsep + os.environ["PATH"], "DISPLAY": ":0", "XDG_RUNTIME_DIR": folder}
        with Server(command, path, desktop=desktop) as server:
            end = time.monotonic() + LIMIT
            while not os.path.exists(said) and time.monotonic() < end:
                time.sleep(0.01)
            with open(said, encoding="utf-8") as file:
                page = file.read().strip()
            assert server.token not in page and os.stat(page).st_mode & 0o777 == 0o600
            with open(page, encoding="utf-8") as file:
                assert f"url={server.url}" in file.read()
            assert server.end() == 0 and not os.path.exists(page)


def own_files(path):
    """A page names files of the scene's folder only: sentences would show it the starts of others."""
    folder, secret = os.path.dirname(path), "a secret of the user"
    with tempfile.TemporaryDirectory() as other:
        outside = os.path.join(other, "secret.txt")
        for name in (outside, os.path.join(folder, "inside.txt")):
            with open(name, "w", encoding="ascii") as file:
                file.write(secret)
        os.symlink(outside, os.path.join(folder, "link.txt"))
        with Server(command, path) as server:
            page = Page(server)
            page.frame()
            for name in (outside, os.path.relpath(outside, folder), "link.txt", "a/../../" + outside):
                for settings in ({"Source.Beam": {"Text": [name]}}, {"Source.Beam": name}, {"Detector.LSF": name},
                                 {"Samples": [{"Label": "a", "Path": name, "Material": "Water"}]}):
                    wish = page.wish(settings=settings)
                    error = page.text("error")
                    assert error["wish"] == wish and "outside of the scene's folder" in error["error"], error
                    assert secret not in error["error"]
            page.wish(settings={"Detector.LSF": "inside.txt"})
            assert "outside" not in page.text("error")["error"]
            assert server.end() == 0


def wishes(path):
    """Each kind of wish makes another image, and it is that of the verb image."""
    with Server(command, path) as server:
        page = Page(server)
        first = page.frame()
        assert (first.columns, first.rows) == (80, 60)
        check_same(first, image(path, "--quantity", "attenuation"))
        for key, value in (("Source.Position", [8, -400, 4, "mm"]), ("Detector.Position", [16, 100, 8, "mm"]),
                           ("Detector.UpVector", [0.5, 0, -1]), ("Detector.RightVector", [1, 0, 0.5]), ("Source.Beam", {"kVp": 90, "Filter": [["Al", 2, "mm"]]}),
                           ("Samples.bone.Material", ["mu", 0.9]), ("Samples.bone.Transform", [["Translation", 8, 0, 0, "mm"]]),
                           ("Detector.Oversampling", 2), ("Noise", True), ("Tolerance", 0.01), ("Precision", "double"),
                           ("Detector.NumberOfPixels", [40, 60])):
            settings = {"Source.Beam": {"kVp": 80}, key: value} if key == "Tolerance" else {key: value}
            if key == "Tolerance":
                first = page.frame(page.wish(settings={"Source.Beam": {"kVp": 80}}))
            if key in ("Detector.UpVector", "Detector.RightVector"): # perpendicular, which .mha files need
                settings = {"Detector.UpVector": [0.5, 0, -1], "Detector.RightVector": [1, 0, 0.5]}
            frame = page.frame(page.wish(settings=settings))
            # a cylinder of two colours along the beam: a tolerance moves what passes by little, but it moves it
            assert key in ("Precision", "Tolerance") or differ(frame, first), key
            check_same(frame, image(path, "--quantity", "attenuation",
                                    *(word for k, v in settings.items() for word in ("--set", f"{k}={json.dumps(v)}"))))
        moved = [1, 0, 0, 16, 0, 1, 0, 0, 0, 0, 1, -8, 0, 0, 0, 1]
        frame = page.frame(page.wish(poses={"1": moved}))
        check_same(frame, image(path, "--quantity", "attenuation", "--set",
                                'Samples.bone.Transform=[["Translation", 16, 0, -8, "mm"]]'))
        back = page.frame(page.wish())
        assert not differ(back, page.frame(page.wish())) and differ(back, frame)
        energy = page.frame(page.wish(quantity="energy"))
        check_same(energy, image(path))
        assert energy.flat == 60000  # 1000 photons of 60 keV
        turned = page.frame(page.wish(projection=1))
        assert differ(turned, back)
        check_same(turned, image(path, "--quantity", "attenuation", "--set", "Scan.StartAngle=90"))
        # a sample with Poses stands where its projection has it, as one that was dragged there
        poses = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, z, 1] for x, z in ((0, 0), (16, -8), (0, 0), (0, 0))]
        stands = page.frame(page.wish(settings={"Samples.bone.Poses": poses}, projection=1))
        assert differ(stands, turned) and not differ(stands, page.frame(page.wish(poses={"1": moved}, projection=1)))


def bands(path):
    """A band is a channel of the verb image; its number may be out of range."""
    beam = {"Source.Beam": {"kVp": 80}}
    with Server(command, path) as server:
        page = Page(server)
        pixels = image(path, "--quantity", "attenuation", "--bands", "20,40,80", "--set", 'Source.Beam={"kVp": 80}')
        for band in (1, 0):
            check_same(page.frame(page.wish(settings=beam, bands=[20, 40, 80], channel=band)), pixels[band::2])
        page.wish(settings=beam, bands=[20, 40, 80], channel=2)
        assert "no band 2" in page.text("error")["error"]
        page.send({"take": "mha"})
        for bad in ([20], [20, 20], [-1, 20], "x", [20, "40"], list(range(18))):
            page.wish(settings=beam, bands=bad)
            assert "bands" in page.text("refused")["refused"], bad


def lag(path):
    """The ghost of the last view is in the next frames as GreyValues.Lag has it, and frames follow until it has faded."""
    share, constant = 0.4, 1.0
    put(path, json.dumps({**SCENE, "Detector": {**SCENE["Detector"], "GreyValues": {"Lag": [[share, constant]]}}}))
    moved = {"Source.Position": [80, -400, 0, "mm"]}
    old = [math.exp(-x) for x in image(path, "--quantity", "attenuation")]
    new = [math.exp(-x) for x in image(path, "--quantity", "attenuation", "--set", 'Source.Position=[80, -400, 0, "mm"]')]
    with Server(command, path) as server:
        page = Page(server)

        def off(frame, pixels):
            shown = (math.exp(-(frame.low + frame.step * n)) for n in frame.numbers)
            return max(abs(a - b) for a, b in zip(shown, pixels, strict=True))

        # a detector at rest shows 0.6 of the first frame; frames follow by themselves until it is steady
        while off(page.frame(), old) > 1 / 1024:
            pass
        time.sleep(0.5)  # the frames that are under way
        wish = page.wish(settings=moved)
        first = page.frame(wish)
        held = share
        for _ in range(4):
            # what the last view has left, within what steadiness and 16 bits leave open
            assert off(first, [b + held * (a - b) for a, b in zip(old, new, strict=True)]) < 2e-3, held
            last, first = first, page.frame()
            held *= math.exp(-(first.number - last.number) / constant)
        while off(page.frame(), new) > 1 / 1024:
            pass


def doses(path):
    """A frame has the dose of the verb `dose` for the scene as it stands; a tube without mAs has no number of photons."""
    def verb(*words):
        run = subprocess.run([command, "dose", path, "--histories", "0", "--json", "--quiet", *words], check=True, stdout=subprocess.PIPE)
        found = json.loads(run.stdout)
        return [found["kerma"][0]["air_kerma_uGy"], *(found[name] for name in ("kap_uGy_cm2", "detector_air_kerma_uGy", "exposure_index"))]

    def check(found, wanted):
        names = ("air_kerma_uGy", "kap_uGy_cm2", "detector_air_kerma_uGy", "exposure_index")
        for name, value in zip(names, wanted, strict=True):
            assert abs(found[name] - value) <= 1e-6 * value, (name, found[name], value)  # floats of the image at the detector

    put(path, json.dumps({key: SCENE[key] for key in SCENE if key != "Scan"}))  # of which the verb adds up the projections
    position = [40, -400, 0, "mm"]
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        check(page.text("dosed")["dosed"], verb())
        wish = page.wish(settings={"Source.Position": position})
        same = page.frame(wish)
        check(page.text("dosed")["dosed"], verb("--set", f"Source.Position={json.dumps(position)}"))
        # the frames that follow are those of the plan as it was
        check_same(page.frame(page.wish(settings={})), image(path, "--quantity", "attenuation"))
        page.text("dosed")
        assert not differ(page.frame(page.wish(settings={"Source.Position": position})), same)
        check(page.text("dosed")["dosed"], verb("--set", f"Source.Position={json.dumps(position)}"))
        page.wish(settings={"Source.Beam": {"kVp": 80}})
        assert page.text("dosed")["dosed"] is None


def slices(path):
    """A slice is reconstructed beside the frames and the 3D view; what is newer ends it, and so does the end."""
    scene = {**SCENE, "Scan": {"NumberOfProjections": 90, "FinalAngle": 360}}
    scene["Samples"] = [{"Label": "ball", "Sphere": [12, 20, "mm"], "Material": ["mu", 0.2]}]
    put(path, json.dumps(scene))
    switches = {"spectrum": True, "noise": False, "scatter": False, "motion": False}
    water = {"Samples.ball.Material": "Water"}  # of which there is scatter, for seconds

    def middle(page, **changed):
        """The mean of the middle, and the figures."""
        page.send({"reconstruct": {**switches, **changed}})
        assert page.text("reconstructing")
        data = page.find(lambda m: isinstance(m, bytes) and m[:4] == b"SKLS")
        its = Frame(data, b"SKLS")
        return sum(its.value(c, r) for c in range(60, 68) for r in range(60, 68)) / 64, page.text("reconstructed")["reconstructed"]

    with Server(command, path) as server:
        page = Page(server)
        without = page.text("scene")["scene"]["without"]
        assert "one energy" in without["spectrum"] and "breathe" in without["motion"], without
        page.frame()
        value, figures = middle(page)
        assert abs(value - 0.2) < 0.02 * 0.2, value  # of the method with 80 columns
        assert figures["projections"] == 90 and figures["across"] == "z" and "error" not in figures, figures
        noisy, figures = middle(page, noise=True)
        assert noisy != value and figures["noise"] is True
        frame = page.frame(page.wish(poses={"0": [1, 0, 0, 40, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}))
        assert frame.wish == 1 and middle(page)[0] < 0.19  # the middle of the box is no longer that of the ball
        page.send({"reconstruct": {**switches, "at": 100}})
        assert "sees slices from" in page.text("reconstructed")["reconstructed"]["error"]
        for bad in ({}, {**switches, "noise": 1}, {**switches, "at": "1"}, {**switches, "At": 1}, [], True):
            page.send({"reconstruct": bad})
            assert "reconstruct" in page.text("refused")["refused"], bad
        for settings, said in (({"Scan.FinalAngle": 90}, "180 degrees"), ({"Scan.NumberOfProjections": 1}, "two or more projections")):
            page.wish(settings=settings)
            page.send({"reconstruct": switches})
            assert said in page.text("reconstructed")["reconstructed"]["error"]
        for newer in (lambda: page.wish(settings={}), lambda: page.send({"reconstruct": None})):
            page.wish(settings=water)
            page.send({"reconstruct": {**switches, "scatter": True}})
            page.text("reconstructing")
            newer()
            assert "newer" in page.text("reconstructed")["reconstructed"]["error"]
        page.wish(settings=water)
        page.send({"reconstruct": {**switches, "scatter": True}})
        page.text("reconstructing")
        page.send({"look": LOOK})
        came = page.find(lambda m: isinstance(m, bytes) and m[:4] == b"SKLP" or isinstance(m, dict) and "reconstructed" in m)
        assert isinstance(came, bytes), came  # the view is drawn while the slice is under way
        assert server.end(60) == 0


def answers(path):
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        page.send({"probe": [40, 30]})
        parts = dict(page.text("probed")["parts"])
        # a cube of 80 mm with a cylinder of 60 mm in it, 1.5 mm off the axis of the beam: in mm
        assert abs(parts["bone"] - 60) < 0.01 and abs(parts["tissue"] - 20) < 0.01, parts
        page.send({"probe": [400, 30]})
        assert "no such pixel" in page.text("error")["error"]
        page.wish(settings={"Source.Position": [8, -400, 0, "mm"]})
        page.send({"take": "mha"})
        file = page.find(lambda m: isinstance(m, bytes))
        assert file[:4] == b"SKLB" and file[8:17] == b"image.mha"
        pixels = file.partition(b"ElementDataFile = LOCAL\n")[2]
        assert struct.unpack(f"<{len(pixels) // 4}f", pixels) == image(path, "--set", 'Source.Position=[8, -400, 0, "mm"]')
        page.send({"take": "png"})
        assert page.find(lambda m: isinstance(m, bytes))[17:25] == b"\x89PNG\r\n\x1a\n"
        page.send({"measure": True})
        names = []
        while (message := page.text("measured"))["measured"]:
            names.append(message["measured"])
            assert message["ms"] is None or message["ms"] > 0
        assert "as it is" in names and "2 x 2 rays a pixel" in names


def long_frames(path):
    """A frame of minutes is dropped for a newer wish, and for the end."""
    slow = {"Source.Shape": ["Disc", 1, "mm"], "Source.Samples": 65536, "Detector.Oversampling": 8}
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        page.wish(settings=slow)
        page.text("scene")
        time.sleep(0.2)  # the frame is under way by then, or will be: both must end
        newer = page.wish(settings={"Source.Position": [8, -400, 4, "mm"]})
        assert page.frame(newer).wish == newer
        page.wish(settings=slow)
        page.text("scene")
        time.sleep(0.2)
        assert server.end(60) == 0


def errors(path):
    """A wish that fails keeps the last image, and the sentence says why."""
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        for settings, word in (({"Source.Beem": 1}, "Beem"), ({"Samples.bone.Material": "unobtainium"}, "unobtainium"),
                               ({"Samples.7.Density": 1}, "--set"), ({"Detector.NumberOfPixels": [0, 1]}, "0 columns"),
                               ({"Source.Position": [0, "x"]}, "Position")):
            wish = page.wish(settings=settings)
            error = page.text("error")
            assert error["wish"] == wish and word in error["error"], error
        wish = page.wish(poses={"9": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})
        assert "no part 9" in page.text("error")["error"]
        assert page.wish(phase=0.5) and "breathe" in page.text("error")["error"]
        assert page.wish(projection=4) and "projection" in page.text("error")["error"]
        frame = page.frame(page.wish(settings={"Source.Position": [8, -400, 0, "mm"]}))
        assert frame.wish == page.wishes
        # warnings of what a page makes go to the pages
        page.wish(settings={"Source.Beam": {"kVp": 12}, "Source.Position": [8, -400, 0, "mm"]})
        assert any("12 kV" in sentence for sentence in page.text("scene")["scene"]["warnings"])
        assert server.end() == 0 and "12 kV" not in server.process.stderr.read()


def malformed(path, seconds=4):
    """Messages at random: each gets a sentence, and the server goes on."""
    random.seed(1)
    good = [{"wish": 1, "settings": {"Tolerance": 0.1}, "poses": {}, "drag": True}, {"ack": 1}, {"probe": [1, 2]}, {"take": "png"}, {"look": LOOK}, {"register": 1}, {"reconstruct": None}]
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        for bad in ("", "x", "[]", "{}", '{"wish": -1}', '{"wish": 1, "wish": 2}', '{"wish": 1, "poses": {"1": [1]}}', '{"take": "exe"}',
                    '{"wish": 1, "phase": 2}', '{"wish": 1, "phase": "a"}', '{"wish": 1, "settings": {"a=b": 1}}', '{"probe": [1]}',
                    '{"wish": 1, "what": 1}', '{"wish": 1, "quantity": "x"}', '{"ack": "1"}', '{"wish": 1, "drag": 1}', '[' * 5000,
                    '{"wish": 1, "projection": 0.5}', '{"wish": 1, "poses": {"1": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}}'):
            page.send_raw(1, bad.encode())
            assert page.text("refused")["refused"], bad
        page.send_raw(2, b"\x00\x01")
        assert page.text("refused")
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            page = join(server)
            for _ in range(60):
                data = bytearray(json.dumps(random.choice(good)).encode())
                for _ in range(random.randrange(6)):
                    at = random.randrange(len(data))
                    data[at:at + random.randrange(3)] = random.choice([b"", b'"', b"{", b"]", b"-", b"9e999", b"\xff", b"\x00", b"null"])
                try:
                    page.send_raw(random.choice([1, 1, 1, 1, 2, 0, 5, 9]), bytes(data), random.random() > 0.05)
                except OSError:
                    break
            page.close()
        assert server.process.poll() is None
        assert join(server).frame().columns
        assert server.end() == 0


def second_page(path):
    with Server(command, path) as server:
        first = Page(server)
        assert first.text("role")["role"] == "owner"  # greeted, before the second page comes
        second = Page(server)
        assert second.text("role")["role"] == "reader"
        second.frame()
        second.wish(settings={"Source.Position": [8, -400, 0, "mm"]})
        assert "another page" in second.text("refused")["refused"]
        first.frame()
        wish = first.wish(settings={"Source.Position": [8, -400, 4, "mm"]})
        frame = shot = None
        while not (frame and shot):  # in either order
            message = first.receive()
            if isinstance(message, Frame):
                frame = frame or (message if message.wish >= wish else None)
            elif "shot" in message and message["wish"] == wish:
                shot = message
        assert frame.wish == second.frame(wish).wish == wish
        third = Page(server)  # is told where source and detector are, without another frame
        assert third.text("shot")["view"]["source"] == [8, -400, 4]
        first.close()
        assert second.text("role")["role"] == "owner"
        second.wishes = wish
        assert second.frame(second.wish()).wish == wish + 1


def one_owner(path):
    """Pages that come at the same time, in whatever order they are greeted."""
    for _ in range(5):
        with Server(command, path) as server:
            pages = [None] * 4
            comers = [threading.Thread(target=lambda i: pages.__setitem__(i, Page(server)), args=[i]) for i in range(len(pages))]
            for comer in comers:
                comer.start()
            for comer in comers:
                comer.join()
            roles = [page.text("role")["role"] for page in pages]
            assert sorted(roles) == ["owner", "reader", "reader", "reader"], roles


LOOK = {"number": 7, "size": [60, 40], "target": [0, 0, 0], "distance": 400, "from": [0, -1, 0], "up": [0, 0, 1], "background": [10, 20, 30]}


def scatter(path):
    """Scatter comes in steps with less and less error, the last as the scene asks for it; a newer wish ends them."""
    beam = {"Source.Beam": {"kVp": 80, "mAs": 1}, "Samples.tissue.Material": "Water", "Samples.bone.Material": "Aluminium"}
    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        wish, shots, frames = page.wish(settings=beam | {"Scatter": 0.04}), {}, {}
        while not frames or frames[max(frames)].notes & 8 or max(frames) not in shots:
            message = page.receive()
            if isinstance(message, Frame) and message.wish == wish:
                frames[message.number] = message
            elif isinstance(message, dict) and message.get("wish") == wish and "shot" in message:
                shots[message["shot"]] = message["scatter"]
        histories = [shots[k]["histories"] for k in sorted(shots)]
        assert len(histories) > 1 and histories == sorted(histories) and histories[0] < 20000, histories
        errors = [shots[k]["sigma"] / shots[k]["mean"] for k in sorted(shots)]
        assert errors[-1] < errors[0], errors
        words = [word for key, value in (beam | {"Scatter": 0.04}).items() for word in ("--set", f"{key}={json.dumps(value)}")]
        check_same(frames[max(frames)], image(path, "--quantity", "attenuation", *words))


def interrupted(path):
    """A wish ends a step of scatter; so does Ctrl-C."""
    beam = {"Source.Beam": {"kVp": 80, "mAs": 1}, "Samples.tissue.Material": "Water", "Samples.bone.Material": "Aluminium"}
    with Server(command, path) as server:
        page = Page(server)
        for i in range(2):
            wish = page.wish(settings=beam | {"Scatter": 1e-4, "Detector.Position": [0, 10 + i, 0, "cm"]})
            shot = page.find(lambda m: isinstance(m, dict) and m.get("wish") == wish and (m.get("scatter") or {}).get("histories", 0) > 2**19)
            page.send({"ack": shot["shot"]})
            worked, end = server.processor_seconds(), time.monotonic() + LIMIT
            while server.processor_seconds() < worked + 0.5 and time.monotonic() < end:  # of a step that takes longer
                time.sleep(0.01)
            if i == 0:
                newer = page.wish()
                last = page.find(lambda m: isinstance(m, Frame) and m.wish >= newer or
                                 isinstance(m, dict) and (m.get("scatter") or {}).get("sigma", 1) < 1e-4 * (m.get("scatter") or {}).get("mean", 0))
                assert isinstance(last, Frame)  # the step was not followed to its end
        assert server.end() == 0


def looks(path):
    """Pictures of the 3D view: for the page that asks, as it asks."""
    def picture(page, **keys):
        page.send({"look": LOOK | keys})
        data = page.find(lambda m: isinstance(m, bytes) and m[:4] == b"SKLP")
        number, columns, rows, ms = struct.unpack_from("<IHHf", data, 4)
        assert number == 7 and len(data) == 16 + 4 * columns * rows and ms > 0
        assert (columns, rows) == tuple((LOOK | keys)["size"])
        return data[16:]

    with Server(command, path) as server:
        page = Page(server)
        page.frame()
        first = picture(page)
        assert first[:4] == bytes([10, 20, 30, 255]) and picture(page) == first
        middle = first[4 * (20 * 60 + 33):][:3]
        assert max(middle) - min(middle) > 20 or max(middle) > 60  # the tissue
        others = [picture(page, **keys) for keys in (
            {"from": [0.1, -1, 0]}, {"up": [0.1, 0, 1]}, {"target": [5, 0, 0]}, {"distance": 420}, {"parallel": True}, {"background": [10, 20, 31]},
            {"cut": [0, -1, 0, 0]}, {"parts": {"0": [1, 2, 3, 255]}}, {"parts": {"0": [1, 2, 3, 0]}}, {"distance": 900, "grey": [0, 3]},
            {"distance": 900, "grey": [3, 0]})]
        assert len(set(others)) == len(others) and first not in others
        moved = [1, 0, 0, 16, 0, 1, 0, 0, 0, 0, 1, -8, 0, 0, 0, 1]
        page.frame(page.wish(poses={"0": moved}))
        assert picture(page) != first
        page.frame(page.wish())
        assert picture(page) == first
        assert picture(page, parts={"0": [0, 0, 0, 0], "1": [0, 0, 0, 0]}) != first  # without parts there are source and detector
        for bad in ({"size": [0, 1]}, {"size": [4096, 4096]}, {"distance": 0}, {"target": [1, 2]}, {"up": "x"}, {"what": 1}, {"cut": [1, 2, 3]},
                    {"parts": {"x": [1, 2, 3, 4]}}, {"parts": {"0": [1, 2, 3, 256]}}, {"number": -1}, {"parallel": 1}):
            page.send({"look": LOOK | bad})
            assert "look" in page.text("refused")["refused"], bad
        page.send({"look": 1})
        assert page.text("refused")
        other = Page(server)  # a reader may look from elsewhere
        assert picture(other, size=[31, 17]) and picture(page) == first


# A block that lies askew in another one, seen by 64 x 64 pixels that are means of 3 x 3 rays.
BLOCKS = {
    "Source": {"Position": [0, -600, 0, "mm"], "Shape": "PointSource", "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
    "Detector": {"Position": [0, 200, 0, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [64, 64], "Spacing": [3, 3, "mm"], "Oversampling": 3},
    "Scan": {"NumberOfProjections": 2, "AngleStep": 90},
    "Samples": [{"Label": "skin", "Cube": [90, "mm"], "Type": "outer", "Material": ["mu", 0.2], "Transform": [["Rotation", 10, 1, 2, 3]]},
                {"Label": "bone", "Cuboid": [20, 34, 40, "mm"], "Material": ["mu", 0.5], "Transform": [["Rotation", 12, 1, -2, 1]]},
                {"Label": "away", "Cube": [5, "mm"], "Material": ["mu", 0.5], "Transform": [["Translation", 0, 0, 900, "mm"]]}]}
BONE = 1
MOVED = [1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1]  # what the radiograph shows: the bone beside its place, mm


def write_blocks(folder):
    """The scene, and radiographs of where the bone is: of the scene's own view, and of each projection."""
    paths = [os.path.join(folder, name) for name in ("blocks.json", "own.mha", "scan.mha")]
    with open(paths[0], "w", encoding="ascii") as file:
        json.dump(BLOCKS, file)
    where = 'Samples.bone.Transform=[["Translation", 4, 0, 2, "mm"], ["Rotation", 12, 1, -2, 1]]'
    subprocess.run([command, "image", paths[0], "--set", where, "-o", paths[1], "--quiet"], check=True)
    subprocess.run([command, "scan", paths[0], "--set", where, "-o", paths[2], "--quiet"], check=True)
    return paths


class Radiograph(Frame):
    """An image of --fixed as pages get it."""

    def __init__(self, data):
        assert data[:4] == b"SKLR"
        super().__init__(b"SKLF" + data[4:])


def registered(page, part, seconds=LIMIT):
    """The result of a registration, and the images that came meanwhile."""
    page.send({"register": part})
    images = []
    while True:
        message = page.find(lambda m: isinstance(m, Frame) or isinstance(m, dict) and ("registered" in m or "refused" in m), seconds)
        if not isinstance(message, Frame):
            return message.get("registered", message), images
        images.append(message)


def fixed(path):
    """A radiograph goes to each page, a part is registered to it, and images go on meanwhile."""
    scene, own, scan = write_blocks(os.path.dirname(path))
    with Server(command, scene, "--fixed", own) as server:
        page = Page(server)
        assert page.text("scene")["scene"]["fixed"] == {"path": own, "projection": None}
        shown = Radiograph(page.find(lambda m: isinstance(m, bytes)))
        with open(own, "rb") as file:
            pixels = file.read().partition(b"ElementDataFile = LOCAL\n")[2]
        check_same(shown, struct.unpack("<4096f", pixels))
        assert shown.flat == max(struct.unpack("<4096f", pixels)) and (shown.columns, shown.rows) == (64, 64)
        page.frame()
        found, _ = registered(page, BONE)
        # a tenth of a pixel of 2.2 mm at the bone; along the beam, here y, one view says little
        assert all(abs(found["pose"][k] - MOVED[k]) < 0.2 for k in (3, 11)), found
        assert found["part"] == BONE and found["label"] == "bone" and found["verdict"] and len(found["sigma"]) == 6
        assert found["status"] in ("agrees", "not determined") and found["warnings"] == []
        # the same from where it was dragged, with a turn about the beam: the pose is over that of the file, the motion after that of the drag
        page.frame(page.wish(poses={str(BONE): [0.96, 0, 0.28, -3, 0, 1, 0, 0, -0.28, 0, 0.96, 9, 0, 0, 0, 1]}))
        again, _ = registered(page, BONE)
        assert "pose" in again and all(abs(again["pose"][k] - MOVED[k]) < 0.2 for k in (3, 11)), again
        # another projection, another size, no such part, what does not show: a sentence each
        for keys, part, word in (({"projection": 1}, BONE, "the page shows projection 1"), ({"settings": {"Detector.NumberOfPixels": [32, 64]}}, BONE, "64 x 64 pixels"),
                                 ({}, 9, "part"), ({}, 2, "away")):
            page.frame(page.wish(**keys))
            refused, _ = registered(page, part)
            assert word in refused["error"], refused
        for bad in ({"register": -1}, {"register": "bone"}, {"register": 0.5}):
            page.send(bad)
            assert "register" in page.text("refused")["refused"], bad
        page.send({"register": None})
        assert "no registration" in page.text("refused")["refused"]
        reader = join(server)
        assert Radiograph(reader.find(lambda m: isinstance(m, bytes))).numbers == shown.numbers
        reader.send({"register": BONE})
        assert "another page" in reader.text("refused")["refused"]
        assert server.end() == 0
    with Server(command, scene, "--fixed", scan + "@1") as server:
        page = Page(server)
        assert page.text("scene")["scene"]["state"]["projection"] == 1
        found, _ = registered(page, BONE, LIMIT) if page.frame(page.wish(projection=1)) else None
        assert abs(found["pose"][11] - MOVED[11]) < 0.2, found  # z, as above; from the side x is along the beam
        assert server.end() == 0
    for words, flat, share in ((["--flat", "70000"], 70000, 1), (["--flat", own], 1, None), (["--quantity", "transmission"], 1, 1)):
        with Server(command, scene, "--fixed", own, *words) as server:
            other = Radiograph(Page(server).find(lambda m: isinstance(m, bytes)))
            assert other.flat == flat, words  # of an image of flat fields, here the radiograph itself, transmissions are made
            assert other.numbers == shown.numbers if share else abs(other.low - 1) < EPS and abs(other.step) < EPS, words
            assert server.end() == 0
    with Server(command, scene) as server:
        page = Page(server)
        page.frame()
        assert "--fixed" in registered(page, BONE)[0]["refused"] and server.end() == 0


def stopped(path):
    """A registration that takes long: images follow wishes meanwhile, a second one is refused, and it is stopped; so does the end."""
    scene, own, _ = write_blocks(os.path.dirname(path))
    slow = {"Detector.Oversampling": 16, "Precision": "double"}
    with Server(command, scene, "--fixed", own) as server:
        page = Page(server)
        page.frame()
        for is_last in (False, True):
            page.frame(page.wish(settings=slow))
            page.send({"register": BONE})
            assert page.text("registering")["registering"]["part"] == BONE
            page.frame(page.wish(settings={"Source.Position": [8, -600, 0, "mm"]}))
            if is_last:
                break
            page.send({"register": BONE})
            assert "under way" in page.text("refused")["refused"]
            page.send({"register": None})
            found = page.text("registered")["registered"]
            assert found.get("status") == "stopped" or "before the search" in found.get("error", ""), found
        assert server.end() == 0


def lost_pages(path):
    """Pages that are killed, that come 100 times, and one that takes no frames."""
    with Server(command, path, "--set", "Detector.NumberOfPixels=[400,300]") as server:
        for i in range(100):
            page = join(server)
            if i % 3 == 0:
                page.frame()
            if i % 3 == 1:
                page.wish(settings={"Tolerance": 0.1})
            page.close()
        page = join(server)
        page.find(lambda m: isinstance(m, dict) and m.get("role") == "owner")
        page.frame()
        slow = join(server, receive_buffer=4096)
        before, last = server.memory(), 0
        for _ in range(300):
            page.wish(settings={"Source.Position": [random.random(), -400, 0, "mm"]}, drag=True)
            last = page.frame(page.wishes).number
        # 72 MB of frames, none of which the slow page has taken: two are on their way to it, and some are in the server
        assert server.memory() - before < 32, (before, server.memory())
        slow.acknowledges = False
        seen = [slow.frame().number, slow.frame().number]
        slow.send({"ack": seen[-1]})
        newest = slow.frame().number
        assert newest >= last and newest - seen[-1] > 5, (seen, newest, last)  # those between were dropped
        threads = len(os.listdir(f"/proc/{server.process.pid}/task"))
        assert threads < 60 + 128, threads  # 128 of the server wait for requests


def ends(path):
    with Server(command, path, "--idle", "4") as server:
        try:
            Page(server).frame()
        except (OSError, EOFError):
            pass  # the machine is so busy that the page came too late
        assert server.process.wait(LIMIT) == 0 and "--idle" in server.process.stderr.read()
    with Server(command, path) as server:
        pages = [Page(server) for _ in range(8)]
        pages[0].frame()
        assert Page(server).status == 503  # the ninth
        assert server.end() == 0
    with Server(command, path) as server:
        server.process.send_signal(1)  # its terminal is closed
        assert server.process.wait(LIMIT) == 0


def prints_json(path):
    process = subprocess.Popen([command, "live", path, "--no-open", "--json", "--quiet"], stdout=subprocess.PIPE, text=True)
    decoder, text = json.JSONDecoder(), ""
    while True:
        text += process.stdout.readline()
        try:
            found = decoder.decode(text)
            break
        except ValueError:
            assert len(text) < 2000
    assert found["url"] == f"http://127.0.0.1:{found['port']}/?token={found['token']}" and len(found["token"]) == 32
    process.send_signal(15)
    assert process.wait(LIMIT) == 0


def changed_file(path):
    with Server(command, path) as server:
        page = Page(server)
        first = page.frame()
        with open(path, encoding="ascii") as file:
            text = file.read()
        put(path, text.replace("0.5", "oops"))
        assert page.text("error")["error"]
        put(path, text.replace("0.5", "0.9"))
        page.text("scene")
        assert page.find(lambda m: isinstance(m, Frame) and differ(m, first))
        page.send({"probe": [40, 30]})
        assert page.text("probed")


def fails(path):
    """Command lines that are refused."""
    for name, columns, rows, at in (("small.mha", 4, 4, None), ("nan.mha", 80, 60, 2 * 80 + 5)):
        head = f"ObjectType = Image\nNDims = 2\nDimSize = {columns} {rows}\nElementType = MET_FLOAT\nElementSpacing = 4 4\nElementDataFile = LOCAL\n"
        values = [float("nan") if k == at else 1 + k % 7 for k in range(columns * rows)]
        with open(os.path.join(os.path.dirname(path), name), "wb") as file:
            file.write(head.encode() + struct.pack(f"<{len(values)}f", *values))
    for words, status, word in ((["-"], 2, "standard input"), ([path, "--bind", "a b"], 2, "--bind"), ([path, "--port", "70000"], 2, "--port"),
                                ([path, "--set", "Nonsense=1"], 3, "Nonsense"), ([path + "x"], 3, "cannot be read"),
                                ([path, "--quantity", "intensity"], 2, "--fixed"), ([path, "--fixed", path + ".mha"], 3, path + ".mha"),
                                ([path, "--fixed", "small.mha"], 3, "4 x 4 pixels"), ([path, "--fixed", "small.mha@9"], 3, "4 projections"),
                                ([path, "--fixed", "nan.mha", "--quantity", "attenuation"], 3, "row 2, column 5"),
                                ([path, "--fixed", "a.mha", "--fixed", "b.mha"], 2, "twice")):
        run = subprocess.run([command, "live", *words, "--no-open"], capture_output=True, text=True, timeout=LIMIT, cwd=os.path.dirname(path))
        assert run.returncode == status and word in run.stderr, (words, run)
    with Server(command, path) as server:
        run = subprocess.run([command, "live", path, "--no-open", "--port", str(server.port)], capture_output=True, text=True, timeout=LIMIT)
        assert run.returncode == 4 and "cannot listen" in run.stderr, run


TESTS = [token_and_origin, hosts, silent, browser, own_files, wishes, bands, lag, doses, slices, answers, looks, fixed, stopped, scatter, interrupted, long_frames, errors, malformed, second_page, one_owner, lost_pages, ends, prints_json, changed_file, fails]


def has_server(path):
    run = subprocess.run([command, "live", path, "--no-open", "--idle", "0.1"], capture_output=True, text=True, timeout=LIMIT)
    return "libcivetweb-dev" not in run.stderr


def main():
    chosen = [test for test in TESTS if not sys.argv[2:] or test.__name__ in sys.argv[2:]]
    for test in chosen:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.json")
            with open(path, "w", encoding="ascii") as file:
                json.dump(SCENE, file)
            if test is chosen[0] and not has_server(path):
                print("this build has no CivetWeb")
                return 77
            began = time.monotonic()
            watchdog = threading.Timer(5 * LIMIT, lambda: (faulthandler.dump_traceback(), os._exit(3)))
            watchdog.daemon = True
            watchdog.start()
            test(path)
            watchdog.cancel()
            print(f"{test.__name__}: {time.monotonic() - began:.1f} s", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
