"""
Noise with the power that a DQE says
====================================
A flat field of a detector whose DQE and MTF are given. The power spectrum of 128 noisy images, divided by the mean squared, times the
number of photons, over MTF squared, is 1 / DQE again.
"""
import numpy as np

import skiagraph as sk
from figure import row, show

DQE = [[0, 0.7], [1, 0.6], [2, 0.45], [5, 0.2]]
MTF = [[0, 1], [1, 0.8], [2, 0.55], [5, 0.2]]
STEP, PHOTONS, N = 0.2, 2000, 128  # mm, of a pixel, pixels
scene = sk.Scene({
    "Source": {"Position": [0, 0, -1000, "mm"], "Shape": "ParallelBeam",
               "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": PHOTONS}]},
    "Detector": {"Position": [0, 0, 0, "mm"], "UpVector": [0, 1, 0],
                 "NumberOfPixels": [N, N], "Spacing": [STEP, STEP, "mm"],
                 "MTF": MTF, "DQE": DQE,
                 "EnergyResponse": {"LUT": [[10, 10, 1, 1], [100, 100, 1, 1]]}},
    "Samples": [{"Label": "crumb", "Cube": [0.001, "mm"], "Material": "Air",
                 "Transform": [["Translation", 0, 0, -500, "mm"]]}],
    "Noise": True})
frames = np.stack([scene.image("energy", index=k) for k in range(128)])
# %%
# The section of the power spectrum along the rows is that of the sums of the columns.
sums = (frames / frames.mean() - 1).sum(axis=1)
power = (abs(np.fft.rfft(sums, axis=1)) ** 2).mean(axis=0) / N**2
frequency = np.fft.rfftfreq(N, STEP)
mtf, dqe = (np.interp(frequency, *np.transpose(table)) for table in (MTF, DQE))

(image, curve), _ = row(2, 5, 4)
show(image, frames[0], STEP, "one frame", "keV per pixel")
curve.plot(frequency[1:], power[1:] * PHOTONS, label="NPS measured")
curve.plot(frequency[1:], mtf[1:] ** 2 / dqe[1:], "--", label="MTF$^2$ / DQE as given")
curve.set_xlabel("line pairs per mm")
curve.set_ylabel("noise power x photons")
curve.legend()
# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-dqe.png'
# sphinx_gallery_start_ignore
from figure import card

card("dqe", frames[0], side=0.5)
# sphinx_gallery_end_ignore
