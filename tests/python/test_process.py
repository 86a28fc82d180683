"""Threads, processes, interrupts: what a program does besides."""
import concurrent.futures
import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import skiagraph as sk
from skiagraph._library import ffi
from skiagraph.scene import state_of


def image_of(scene):
    return scene.image()


def test_scenes_pickle_by_content(tmp_path, scene):
    sk.Mesh.sphere(20, 32).save(tmp_path / "ball.ply")
    (tmp_path / "mu.txt").write_text("10 1\n100 0.1\n")
    loaded = sk.Scene({"Samples": [{"Label": "table", "Path": str(tmp_path / "ball.ply"), "Unit": "mm",
                                    "Material": ["Table", str(tmp_path / "mu.txt"), "keV"]}]})
    loaded.view, loaded.beam = scene.view, scene.beam
    loaded["table"].pose = sk.translate(1, 2, 3)
    loaded.add("cube", sk.Mesh.cube(5), material=sk.Material.hu(40), inside="table", priority=2)
    expected, state = loaded.image(), pickle.dumps(loaded)
    (tmp_path / "ball.ply").unlink()
    (tmp_path / "mu.txt").unlink()
    again = pickle.loads(state)
    assert (again.image() == expected).all()
    assert again["cube"].priority == 2 and again["cube"].inside == "table"
    assert (copy.copy(again).image() == expected).all()
    with pytest.raises(OSError):
        pickle.dumps(loaded)


def test_changes_are_pickled(scene):
    scene["ball"].material = sk.Material("Ti90Al6V4", by="mass", density=4.43)
    scene["block"].mesh.vertices = scene["block"].mesh.vertices * 1.1
    scene.beam = sk.Beam.tube(80, {"Al": 3})
    assert (pickle.loads(pickle.dumps(scene)).image() == scene.image()).all()


@pytest.mark.full  # test_spawned_processes, test_breath
def test_a_breath_is_pickled(tmp_path):
    scene = sk.Scene(sk.thorax(tmp_path / "a" / "folder", 10000), settings={"Detector.NumberOfPixels": [16, 16]})
    scene.breathe(phase=0.3)
    assert (pickle.loads(pickle.dumps(scene)).image() == scene.image()).all()


def test_changed_files_are_not_pickled(tmp_path):
    sk.Mesh.cube(10).save(tmp_path / "cube.ply")
    scene = sk.Scene({"Samples": [{"Label": "a", "Path": str(tmp_path / "cube.ply"), "Unit": "mm", "Material": "Al"}]})
    sk.Mesh.sphere(10, 8).save(tmp_path / "cube.ply")
    with pytest.raises(sk.FileError, match="cube.ply: changed"):
        pickle.dumps(scene)


def test_parts_of_a_scene_pickle():
    for thing in (sk.Material("H2O", density=1.1), sk.Material.mixture({"H": 0.112, "O": 0.888}, 1), sk.Material.mu(0.3),
                  sk.Material.table([10, 100], [1, 0.1])):
        again = pickle.loads(pickle.dumps(thing))
        assert again.attenuation(60) == thing.attenuation(60) and again.name == thing.name
    beam = sk.Beam.tube(90, {"Al": 3})
    assert (pickle.loads(pickle.dumps(beam)).photons == beam.photons).all()
    mesh = sk.Mesh.sphere(10, 16)
    assert (pickle.loads(pickle.dumps(mesh)).vertices == mesh.vertices).all()


def test_spawned_processes(scene):
    with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        assert (pool.submit(image_of, scene).result() == scene.image()).all()


def test_a_forked_child_is_refused(scene):
    scene.image()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            scene.image()
        except sk.ForkError:
            os.write(writer, b"refused")
        finally:
            os._exit(0)
    os.close(writer)
    os.waitpid(child, 0)
    assert os.read(reader, 100) == b"refused"
    os.close(reader)


def test_threads_queue(scene, poses):
    expected = scene.images(poses={"ball": poses})
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        batches = list(pool.map(lambda _: scene.images(poses={"ball": poses}), range(8)))
    for batch in batches:
        assert (batch == expected).all()


def test_the_interpreter_runs_meanwhile(scene):
    """Another thread gets on while images are computed."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    scene.images(poses={"ball": np.eye(4)[None].repeat(50, 0)})
    after = counted[0]
    stop.set()
    thread.join()
    assert after > before


def test_an_interrupt_ends_scatter(view):
    """SIGINT comes while the scatter of a frame is computed, for minutes: so many histories are asked for, because a tolerance that
    cannot be met is given up early."""
    made = sk.Scene()
    made.add("block", sk.Mesh.cube(40), material="Water")
    made.view, made.beam = view, sk.Beam.mono(60, 1000)
    before = made.image(scatter=0.05)
    timer = threading.Timer(1, lambda: signal.pthread_kill(threading.main_thread().ident, signal.SIGINT))
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        made.image(scatter={"histories": 2**30})
    timer.join()
    assert time.monotonic() - begun < 120
    assert (made.image(scatter=0.05) == before).all()


def test_an_interrupt_ends_a_batch(scene):
    """SIGINT comes in the middle of more frames than anybody would wait for."""
    expected, seen = scene.image(), []

    def interrupt(done, of):
        if not seen:
            signal.raise_signal(signal.SIGINT)
        seen.append(done)

    with pytest.raises(KeyboardInterrupt):
        scene.images(poses={"ball": np.eye(4)[None].repeat(100000, 0)}, progress=interrupt)
    assert not seen
    assert state_of(scene).device._unfinished  # nobody waited for what is under way
    assert (scene.image() == expected).all()


def test_distances_and_volumes_are_cancelled(scene):
    """A function that returns False, one that raises, and Ctrl-C; the first call and one in the middle."""
    def at(first, what):
        return lambda done, of: what() if done >= first * of else None

    def fail():
        raise RuntimeError("enough")

    meshes = sk.Mesh.sphere(10, 48), sk.Mesh.sphere(11, 48)
    scan = sk.Scan(scene.view, 24, axis="y")
    images = scene.images(quantity="attenuation", views=scan)
    for work in (lambda progress: sk.distance(*meshes, progress=progress),
                 lambda progress: sk.reconstruct(scan, images, size=4, axis="y", progress=progress)):
        seen = []
        work(lambda done, of: seen.append((done, of)))
        assert len(seen) > 3 and seen[-1][0] == seen[-1][1]
        for first in (0, 0.5):
            for what, error in ((lambda: False, sk.CancelledError), (fail, RuntimeError),
                                (lambda: signal.raise_signal(signal.SIGINT), KeyboardInterrupt)):
                with pytest.raises(error):
                    work(at(first, what))
        work(False)


def test_warnings_may_be_errors(scene):
    program = """if True:
        import skiagraph as sk, warnings
        warnings.simplefilter("error")
        try:
            sk.Beam.tube(100)
        except sk.SkiagraphWarning as warning:
            print("caught")
    """
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "caught\n" and done.stderr == ""


def test_closing(scene):
    with sk.Device("device=cpu threads=1") as device:
        other = sk.Scene(device=device)
        other.add("cube", sk.Mesh.cube(10), material="Al")
        other.view, other.beam = scene.view, scene.beam
        assert other.image().shape == scene.view.shape
        other.close()
        other.close()
    with pytest.raises(sk.ArgumentError, match="closed"):
        sk.Scene(device=device)
    assert "closed" in repr(other) and "closed" in repr(device)


def test_many_scenes_leave_nothing(scene):
    """Plans are freed with their scenes: a device would soon be full."""
    for _ in range(50):
        with sk.Scene() as one:
            one.add("cube", sk.Mesh.cube(10), material="Al")
            one.view, one.beam = scene.view, scene.beam
            one.image()
    assert not sk._device.device_of(None)._garbage


def test_a_data_loader_of_pytorch():
    torch = pytest.importorskip("torch")
    loader = torch.utils.data.DataLoader(Turned(4), batch_size=2, num_workers=2, multiprocessing_context="spawn")
    batches = [batch for batch in loader]
    expected = [Turned(4)[k] for k in range(4)]
    assert [tuple(batch.shape) for batch in batches] == [(2, *expected[0].shape)] * 2
    for k, image in enumerate(expected):
        assert (batches[k // 2][k % 2].numpy() == image).all()


def test_a_data_set_opens_its_scene_where_it_is_used():
    """A worker of a DataLoader receives a data set whose scene was not opened yet, and one whose scene was."""
    turned = Turned(2)
    fresh = pickle.dumps(turned)
    expected = [turned[k] for k in range(2)]
    for copied in (pickle.loads(fresh), pickle.loads(pickle.dumps(turned))):
        assert all((copied[k] == expected[k]).all() for k in range(2))
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, context) as pool:
        assert (pool.submit(turned.__getitem__, 1).result(120) == expected[1]).all()


class Turned:
    """A data set: a cube that turns, one image for each number."""

    def __init__(self, count):
        self.count, self.scene = count, None

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        if self.scene is None:  # in the process that computes
            self.scene = sk.Scene(device="device=cpu threads=1")
            self.scene.add("cube", sk.Mesh.cube(40), material="water")
            self.scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(4, 0, 0), row_step=(0, 4, 0),
                                      pixels=(32, 24))
            self.scene.beam = sk.Beam.mono(60, 1000)
        self.scene["cube"].pose = sk.rotate("y", 20 * index)
        return self.scene.image()


def test_an_interrupt_ends_the_making_of_a_plan(scene):
    """SIGINT comes while samples of the source are looked for that never suffice; the next image is not touched."""
    before, over = scene.image(), threading.Event()

    def interrupt():
        while not over.is_set():
            if any(thread.name == "skiagraph-plan" for thread in threading.enumerate()):
                signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
                return

    thread = threading.Thread(target=interrupt)
    with pytest.raises(KeyboardInterrupt):
        thread.start()
        scene.image(spot={"shape": "disc", "extent": 5.0, "tolerance": 1e-12, "samples_max": 65536})
    over.set()
    thread.join()
    assert (scene.image() == before).all()


def test_an_interrupt_while_the_thread_of_a_plan_starts(scene, monkeypatch):
    """The interrupt comes before the thread counts as alive; nothing goes on afterwards."""
    wait, pending, log = threading.Event.wait, [True], []

    def interrupt(event, timeout=None):
        if pending and sys._getframe(1).f_code is threading.Thread.start.__code__:
            pending.clear()
            raise KeyboardInterrupt
        return wait(event, timeout)

    def work():
        log.append("begun")
        time.sleep(0.2)
        log.append("done")
        return ffi.NULL

    monkeypatch.setattr(threading.Event, "wait", interrupt)
    with pytest.raises(KeyboardInterrupt):
        state_of(scene).device.interruptible("skg_plan", work)
    assert log in ([], ["begun", "done"])
    found = list(log)
    time.sleep(0.4)
    assert log == found and not pending
