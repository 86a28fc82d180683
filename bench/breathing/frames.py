"""Times the steps of a frame of the breathing thorax of ./demo, on one thread and on all; bench/run calls it.

usage: frames.py COMMAND
"""
import json
import os
import subprocess
import sys
import tempfile


def run(*words):
    return subprocess.run([sys.argv[1], *words, "--quiet"], check=True, capture_output=True, text=True).stdout


def main():
    with tempfile.TemporaryDirectory() as folder:
        thorax = os.path.join(folder, "thorax.json")
        run("thorax", "-o", folder)
        columns = []
        for threads in sorted({1, os.cpu_count()}):
            device = ["--device", f"cpu threads={threads}"]
            os.environ["OMP_NUM_THREADS"] = str(threads)
            still = json.loads(run("image", thorax, *device, "--repeat", "300", "--json", "-o", os.path.join(folder, "a.mha")))
            films = [json.loads(run("breathe", thorax, *device, "--seconds", "12", "--fps", "15", "--json", "-o", os.path.join(folder, "film")))
                     for _ in range(5)]
            film = max(films, key=lambda f: f["frames_per_s"])
            rows = {name: times["min"] for name, times in still["stages"].items()}
            rows["a frame of the scene at rest"] = still["frame_ms"]["min"]
            rows["a pose"] = film["pose_ms"]
            rows["a breathing frame, its pose made meanwhile"] = 1000 / film["frames_per_s"]
            rows["breathing frames per second"] = film["frames_per_s"]
            columns.append((threads, rows))
    print("The thorax of `./demo`: 113 parts, 43,250 triangles, 512 x 512 pixels. Least times in ms; stages by the device's own clock.\n")
    print("| |" + "".join(f" {threads} thread{'s' * (threads > 1)} |" for threads, _ in columns))
    print("|---|" + "---:|" * len(columns))
    for name in columns[0][1]:
        print(f"| {name} |" + "".join(f" {rows.get(name, 0):.{0 if 'second' in name else 2}f} |" for _, rows in columns))


if __name__ == "__main__":
    main()
