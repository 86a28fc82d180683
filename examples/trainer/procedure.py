"""The procedure that the trainer simulates: needle, contrast medium, fluoroscopy and score.

The state after a tick depends on the seed and on the ticks before it alone, so that a recorded run can be repeated bit for bit.
"""
import hashlib
import math

import numpy as np

import skiagraph as sk

RATE = 8  # ticks per second, each with one pulse while the pedal is held
CENTRE = np.array([-50.0, -60.0, -80.0])  # isocentre of the C-arm in the liver, mm
SOURCE_MM, DETECTOR_MM, REFERENCE_MM = 800, 200, 650  # from the isocentre; from the source: 150 mm in front of the isocentre
PIXELS, PITCH_MM = 320, 0.7
PULSE_MAS, KVP, FILTERS = 0.1, 80, {"Al": 3.5, "Cu": 0.1}
IODINE_MG, ML_PER_S = 300, 0.5  # in 1 ml of contrast medium; from the tip
START_MM = 120  # from the skin to the tip of the library's needle, where the trainer begins with the tip on the skin
SPILL_MM, SPILL_STEP_MM = 6, 5  # radius of a deposit outside the ducts, and how far apart two are
DUCTS = ("bile ducts", "common bile duct")
LIMITS = {"depth": (0, 180), "yaw": (-60, 60), "pitch": (-60, 60), "arm": (-90, 90)}  # mm, degrees
FILL_ML = 0.5  # that shall be in the ducts


def is_inside(mesh, points):
    """Which points lie inside: where the triangles' solid angles add up to a sphere (van Oosterom and Strackee 1983)."""
    a, b, c = (mesh.vertices[corner][None] - np.asarray(points, float)[:, None] for corner in mesh.faces.T)
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    top = (a * np.cross(b, c)).sum(axis=2)
    bottom = la * lb * lc + (a * b).sum(axis=2) * lc + (b * c).sum(axis=2) * la + (c * a).sum(axis=2) * lb
    return np.arctan2(top, bottom).sum(axis=1) > math.pi  # half of 4 pi, in halves of angles


def iodine_in_water(mg_per_ml):
    grams = mg_per_ml / 1000
    return sk.Material.mixture({"H": 0.1119 / (1 + grams), "O": 0.8881 / (1 + grams), "I": grams / (1 + grams)}, 1 + grams, "contrast medium")


class Procedure:
    """One run. path: the scene file of sk.thorax."""

    def __init__(self, path, seed):
        self.seed, self.ticks, self.pulses = int(seed), [], 0
        self.kerma_mgy = self.in_ducts_ml = self.outside_ml = 0.0
        self.spills, self.digest = [], hashlib.sha256()
        scene = self.scene = sk.Scene(path)
        scene.beam = sk.Beam.tube(KVP, filters=FILTERS, mas=PULSE_MAS)
        for label in DUCTS:
            scene[label].material = "Water, Liquid"  # bile
        self.duct_ml = sum(scene[label].mesh.health["volume"] for label in DUCTS) / 1000
        vertices = scene["needle"].mesh.vertices
        line = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2][0]
        self._along = line if line[0] > 0 else -line
        self._tip = vertices[np.argmax(vertices @ self._along)]
        self.entry = self._tip - START_MM * self._along
        self.controls = dict.fromkeys(LIMITS, 0.0)
        self.target = self._choose_target()
        self._aim()

    def _choose_target(self):
        """A place inside a duct of the right half of the liver that the needle can reach."""
        mesh, random = self.scene["bile ducts"].mesh, np.random.default_rng(self.seed)
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        high[0] = min(high[0], -20.0)
        while True:
            points = random.uniform(low, high, (2000, 3))
            inside = points[is_inside(mesh, points) & (np.linalg.norm(points - self.entry, axis=1) < LIMITS["depth"][1])]
            if len(inside):
                return inside[0]

    def _aim(self):
        """Needle and C-arm to the controls."""
        now, across = self.controls, np.cross(self._along, (0, 1, 0))
        turn = sk.rotate("y", -now["yaw"]) @ sk.rotate(across, -now["pitch"])  # up, and to the front
        self.tip = self.entry + now["depth"] * (turn[:3, :3] @ self._along)
        self.scene["needle"].pose = sk.translate(*self.tip) @ turn @ sk.translate(*-self._tip)
        arm = sk.rotate("z", now["arm"])[:3, :3]
        self.scene.view = sk.View(source=CENTRE + arm @ (0, -SOURCE_MM, 0), detector=CENTRE + arm @ (0, DETECTOR_MM, 0),
                                  column_step=arm @ (PITCH_MM, 0, 0), row_step=(0, 0, -PITCH_MM), pixels=(PIXELS, PIXELS))

    def tick(self, asked):
        """An eighth of a second with these controls. Returns the image, or None while the pedal is up."""
        controls = {key: float(asked[key]) for key in LIMITS}
        if not all(math.isfinite(x) for x in controls.values()):
            raise ValueError("a control is not finite")
        self.controls = {key: min(max(controls[key], low), high) for key, (low, high) in LIMITS.items()}
        self.ticks.append({**self.controls, **{key: asked.get(key) is True for key in ("pedal", "inject")}})
        self._aim()
        if self.ticks[-1]["inject"]:
            self._inject(ML_PER_S / RATE)
        return self._pulse() if self.ticks[-1]["pedal"] else None

    def _inject(self, ml):
        if is_inside(self.scene["bile ducts"].mesh, self.tip[None])[0]:
            self.in_ducts_ml += ml  # mixes with the bile at once
            matter = iodine_in_water(IODINE_MG * self.in_ducts_ml / (self.duct_ml + self.in_ducts_ml))
            for label in DUCTS:
                self.scene[label].material = matter
            return
        self.outside_ml += ml
        spill = next((its for its in self.spills if np.linalg.norm(its["at"] - self.tip) < SPILL_STEP_MM), None)
        if spill is None:
            spill = {"at": self.tip, "ml": 0.0, "label": f"spill {len(self.spills)}"}
            self.spills.append(spill)
            self.scene.add(spill["label"], sk.Mesh.sphere(SPILL_MM, 16), material="Water, Liquid", priority=1, pose=sk.translate(*self.tip))
        spill["ml"] += ml
        self.scene[spill["label"]].material = iodine_in_water(IODINE_MG * min(1, spill["ml"] / (4e-3 / 3 * math.pi * SPILL_MM ** 3)))

    def _pulse(self):
        scene = self.scene
        image = scene.image("attenuation", noise=True, noise_seed=self.seed, index=self.pulses, overlaps=0, tolerance=0)
        self.pulses += 1
        quality = scene.beam.resolved(scene.view).quality  # of the photons of a pixel, as if they were those of 1 mm2
        at_detector = quality["air_kerma_ugy"] / PITCH_MM ** 2
        self.kerma_mgy += at_detector / 1000 * ((SOURCE_MM + DETECTOR_MM) / REFERENCE_MM) ** 2
        self.digest.update(image.tobytes())
        return image

    def on_detector(self, point):
        """Column and row where the image shows a point."""
        view, ray = self.scene.view, np.asarray(point) - self.scene.view.source
        steps = np.stack([view.column_step, view.row_step, ray], axis=1)
        column, row, _ = np.linalg.solve(steps, point - view.detector)
        return [float(column) + (PIXELS - 1) / 2, float(row) + (PIXELS - 1) / 2]

    def state(self):
        seconds = sum(tick["pedal"] for tick in self.ticks) / RATE
        distance = float(np.linalg.norm(self.tip - self.target))
        score = 100 - 5 * distance - 5 * self.kerma_mgy - 0.5 * seconds - 10 * self.outside_ml - 40 * max(0, FILL_ML - self.in_ducts_ml)
        return {"seconds": len(self.ticks) / RATE, "fluoroscopy_s": seconds, "kerma_mgy": round(self.kerma_mgy, 4),
                "in_ducts_ml": round(self.in_ducts_ml, 4), "outside_ml": round(self.outside_ml, 4), "tip_to_target_mm": round(distance, 2),
                "score": round(max(0.0, score), 1)}
