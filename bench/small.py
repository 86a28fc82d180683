"""Times a call of Python for one small image, and a frame of a batch; bench/run calls it.

usage: small.py [--quick] SCENE.json
"""
import sys
import time

import numpy as np

import skiagraph


def least(work, repeats):
    """(all of it, of the calling thread), us, the least of so many runs each."""
    best = [float("inf"), float("inf")]
    for _ in range(repeats):
        begun = time.perf_counter(), time.thread_time()
        work()
        best = [min(b, now - then) for b, now, then in zip(best, (time.perf_counter(), time.thread_time()), begun)]
    return [1e6 * b for b in best]


def main():
    quick = "--quick" in sys.argv
    scene = skiagraph.Scene(sys.argv[-1])
    part, shape = next(iter(scene)), scene.view.shape
    out, steps = np.empty(shape, np.float32), [skiagraph.translate(0.01 * k, 0, 0) @ part.pose for k in range(100)]
    poses = {part.label: np.array(steps)}
    stack = np.empty((len(steps), *shape), np.float32)
    place = iter(steps * 1000)

    def moved():
        part.pose = next(place)
        scene.image(out=out)

    rows = {"`scene.image()`": (lambda: scene.image(), 1), "`scene.image(out=)`": (lambda: scene.image(out=out), 1),
            "`part.pose = ...; scene.image(out=)`": (moved, 1),
            f"a frame of `scene.images(poses=)` of {len(steps)}": (lambda: scene.images(poses=poses, out=stack), len(steps))}
    print(f"{shape[1]} x {shape[0]} pixels, {len(scene)} parts. Least times in us: all of it, and of the calling thread.\n")
    print("| | all of it | calling thread |\n|---|---:|---:|")
    for name, (work, count) in rows.items():
        for _ in range(3):
            work()
        whole, own = least(work, (100 if quick else 1000) // (1 if count == 1 else 10))
        print(f"| {name} | {whole / count:.1f} | {own / count:.1f} |")


if __name__ == "__main__":
    main()
