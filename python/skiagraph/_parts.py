"""The parts of a scene as a list, and a table of what is measured of them. Private."""
from __future__ import annotations

from typing import Any

from ._breath import weighed
from ._library import listed, make, number, release
from ._state import State
from .part import Part


class Parts(list[Part]):
    """The parts of a scene, in their order. Changes of this list do not change the scene."""

    def __init__(self, state: State) -> None:
        super().__init__(state.parts())
        self._state = state

    def __call__(self, **options: Any) -> dict[str, Any]:
        """The table that `skiagraph parts --json` prints: "energy_keV", the mean energy of the beam, and "parts", for each part its "label",
        "material", "density_g_cm3", "volume_mm3", "mass_g", "mean_path_mm", the mean net length of the rays that meet it, and
        "share" of the attenuation at that energy. What is not known is None. options: as of image().
        """
        state = self._state
        with state.calls(), weighed(state):
            plan = state.plan({"precision": "single", "scatter": False, **options})
            table = make("skg_part_table_create", "skg_part_table", plan)
            try:
                rows = listed("skg_part_row", "skg_part_row", table)
                return {"energy_keV": number("skg_part_table_energy_get", table),
                        "parts": [{"label": part.label, "material": part.material.name, **_known(row)}
                                  for part, row in zip(state.parts(), rows)]}
            finally:
                release("skg_part_table", table)


def _known(row: dict[str, Any]) -> dict[str, Any]:
    return {name: None if value != value else value for name, value in row.items()}
