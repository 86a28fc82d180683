"""Meshes, materials, beams and matrices."""
import pickle
import types

import numpy as np
import pytest

import skiagraph as sk
from skiagraph.mesh import as_mesh

VERTICES = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def volume_of(value):
    return as_mesh(value).health["volume"]


@pytest.mark.parametrize("positions", [np.float64, np.float32, np.int16])
@pytest.mark.parametrize("corners", [np.int32, np.int64, np.uint8])
def test_arrays_of_any_type(positions, corners):
    mesh = sk.Mesh(VERTICES.astype(positions), FACES.astype(corners))
    assert mesh.health["volume"] == pytest.approx(1 / 6, rel=1e-15)  # a few roundings
    assert (mesh.vertices == VERTICES).all() and (mesh.faces == FACES).all()


def test_strided_and_reversed_arrays():
    wide = np.zeros((4, 7))
    wide[:, 2:5] = VERTICES
    assert volume_of((wide[:, 2:5], FACES)) == volume_of((VERTICES, FACES))
    assert volume_of((VERTICES[::-1], 3 - FACES)) == pytest.approx(1 / 6, rel=1e-15)
    assert volume_of((np.asfortranarray(VERTICES), np.asfortranarray(FACES))) == volume_of((VERTICES, FACES))


def test_components_that_face_the_wrong_way():
    two = sk.Mesh(np.vstack([VERTICES, VERTICES + 5]), np.vstack([FACES, 4 + FACES[:, ::-1]]))
    assert two.nesting["inverted"] == 1
    assert two.oriented().nesting["inverted"] == 0
    assert two.oriented().health["volume"] == pytest.approx(2 / 6, rel=1e-14)  # a few roundings


def test_mixed_winding_is_turned_with_a_warning():
    cube = sk.Mesh.cube(20)
    faces = cube.faces.copy()
    faces[[0, 1, 7]] = faces[[0, 1, 7], ::-1]
    with pytest.warns(sk.SkiagraphWarning, match="3 of 12 triangles were turned"):
        turned = sk.Mesh(cube.vertices, faces)
    assert turned.health["closed"] and turned.health["volume"] == pytest.approx(8000)
    assert not sk.Mesh(cube.vertices, faces, as_wound=True).health["closed"]


def test_units():
    assert sk.Mesh(VERTICES, FACES, unit_mm=10).health["volume"] == pytest.approx(1000 / 6, rel=1e-14)  # roundings


@pytest.mark.parametrize("vertices, faces, words", [
    (VERTICES[:, :2], FACES, "vertices has the shape (4, 2) and the type float64"),
    (VERTICES, FACES[0], "faces has the shape (3,)"),
    (VERTICES, FACES + 0.5, "faces has the shape (4, 3) and the type float64; give whole numbers"),
    (VERTICES, FACES + 2**40, "numbers beyond 2147483647"),
    ([["a", "b", "c"]], FACES, "real numbers"),
    (VERTICES + 1j, FACES, "complex128"),
])
def test_wrong_arrays_are_named(vertices, faces, words):
    with pytest.raises(sk.ArgumentError) as caught:
        sk.Mesh(vertices, faces)
    assert words in str(caught.value)


def test_corners_out_of_range_are_the_librarys():
    with pytest.raises(sk.MeshError):
        sk.Mesh(VERTICES, FACES + 1)


def test_meshes_of_other_packages():
    trimesh = types.SimpleNamespace(vertices=VERTICES, faces=FACES)
    meshio = types.SimpleNamespace(points=VERTICES, cells_dict={"triangle": FACES, "line": np.zeros((1, 2), int)})
    pyvista = types.SimpleNamespace(points=VERTICES.astype(np.float32),
                                    faces=np.hstack([np.full((4, 1), 3), FACES]).ravel())
    for value in (trimesh, meshio, pyvista):
        assert volume_of(value) == pytest.approx(1 / 6, rel=1e-7)  # floats
    meshio.cells_dict["polygon"] = np.zeros((1, 5), int)
    with pytest.raises(sk.ArgumentError, match="polygon"):
        as_mesh(meshio)
    open3d = types.SimpleNamespace(vertices=VERTICES.tolist(), triangles=FACES.tolist())
    scene = types.SimpleNamespace(geometry={}, dump=lambda concatenate: trimesh)
    for value in (open3d, scene):
        assert sk.Mesh.from_object(value).health["volume"] == pytest.approx(1 / 6)
    pyvista.faces = np.array([4, 0, 1, 2, 3])
    with pytest.raises(sk.ArgumentError, match="triangulate"):
        as_mesh(pyvista)
    pyvista.faces = np.tile([4, 0, 1, 2, 3], 4)
    with pytest.raises(sk.ArgumentError, match="triangulate"):
        as_mesh(pyvista)
    with pytest.raises(sk.ArgumentError, match="mesh is a int"):
        as_mesh(3)


def test_volume_cells_give_their_skin():
    x, y, z = np.meshgrid([0, 1, 2], [0, 1], [0, 1], indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1).astype(float)
    number = np.arange(12).reshape(3, 2, 2)

    def brick(i):
        low, high = number[i], number[i + 1]
        return [low[0, 0], high[0, 0], high[1, 0], low[1, 0], low[0, 1], high[0, 1], high[1, 1], low[1, 1]]

    bricks = types.SimpleNamespace(points=points, cells_dict={"hexahedron": np.array([brick(0), brick(1)]),
                                                              "quad": np.array([[0, 1, 2, 3]])})
    mesh = sk.Mesh.from_object(bricks, unit_mm=10)
    health = mesh.health
    assert health["closed"] and health["triangles"] == 20 and health["volume"] == pytest.approx(2000)
    assert health["turned"] == 0 and not health["flipped"]
    wedge = types.SimpleNamespace(points=points, cells_dict={"wedge": np.array([[0, 4, 2, 1, 5, 3]]),
                                                             "tetra": np.array([[4, 8, 6, 5]])})
    assert sk.Mesh.from_meshio(wedge).health["volume"] == pytest.approx(1 / 2 + 1 / 6)


@pytest.mark.parametrize("units, mm", [("meters", 1000), ("inches", 25.4), ("millimeters", 1), ("mm", 1), (None, 1), ("", 1)])
def test_units_of_trimesh(units, mm):
    mesh = types.SimpleNamespace(vertices=VERTICES, faces=FACES, units=units)
    assert sk.Mesh.from_object(mesh).health["volume"] == pytest.approx(mm**3 / 6)
    assert volume_of(mesh) == pytest.approx(mm**3 / 6)
    assert sk.Mesh.from_object(mesh, unit_mm=2).health["volume"] == pytest.approx(8 / 6)  # a named unit wins


def test_units_that_are_none_are_said():
    mesh = types.SimpleNamespace(vertices=VERTICES, faces=FACES, units="parsnips")
    with pytest.warns(UserWarning, match="'parsnips' of the mesh are no unit"):
        assert volume_of(mesh) == pytest.approx(1 / 6)


def test_cells_beside_triangles_of_another_body():
    points = np.concatenate([VERTICES, VERTICES + 10, [[99, 99, 99]]])
    faces = np.concatenate([FACES[:1], FACES + 4])  # the first is a face of the volume cell
    both = types.SimpleNamespace(points=points, cells_dict={"tetra": np.array([[0, 1, 2, 3]]), "triangle": faces})
    health = sk.Mesh.from_meshio(both).health
    assert health["closed"] and health["triangles"] == 8 and health["vertices"] == 8
    assert health["volume"] == pytest.approx(2 / 6) and max(health["bounds"]) == 11


def test_trimesh_itself():
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(radius=10)
    assert volume_of(ball) == pytest.approx(ball.volume, rel=1e-12)  # summed in another order


def test_meshio_itself():
    meshio = pytest.importorskip("meshio")
    assert volume_of(meshio.Mesh(VERTICES, [("triangle", FACES)])) == pytest.approx(1 / 6, rel=1e-15)  # roundings


def test_files_keep_the_bits(tmp_path):
    mesh = sk.Mesh(VERTICES / 3, FACES)
    mesh.save(tmp_path / "tetrahedron.ply")
    assert (as_mesh(tmp_path / "tetrahedron.ply").vertices == mesh.vertices).all()
    assert sk.Mesh.load(tmp_path / "tetrahedron.ply", unit_mm=3).name == "tetrahedron.ply"


def test_offsets_outlive_the_mesh():
    offsets = sk.Mesh(VERTICES, FACES).offsets
    assert offsets.shape == (4, 3) and offsets.dtype == np.float32
    assert np.ptp(offsets, axis=0).tolist() == [1, 1, 1]


def test_materials():
    water = sk.Material("water")
    # NIST: 0.2059 cm2/g at 60 keV, to four digits
    assert water.attenuation(60) == pytest.approx(0.2059, abs=5e-5)
    assert water.attenuation([30, 60]).shape == (2,)
    assert water.coefficients(60)["total"] == pytest.approx(float(water.attenuation(60)), rel=1e-15)  # density 1
    assert water.hounsfield(70) == pytest.approx(0, abs=1e-9)  # roundings of 1000
    assert sk.Material.hu(52).density > 1
    assert sk.Material("Fe").edges == pytest.approx([7.112], abs=1e-3)  # K edge, keV, to the table's digits
    assert "Fe" in sk.Material("Fe").elements
    assert sk.Material.table([10, 100], [1, 0.1]).attenuation(10) == 1
    assert sk.Material.mixture({"H": 0.112, 8: 0.888}, 1).elements.keys() == {"H", "O"}


def test_form_factors_of_molecules():
    water = sk.Material("water")
    assert water.form_factor is None
    x = np.linspace(0, 0.6, 31)
    bound = water.with_form_factor(x, 1 + x).at_density(0.9)
    momenta, squares = bound.form_factor
    assert momenta == pytest.approx(x, abs=0)
    assert squares / squares[0] == pytest.approx(1 + x, rel=1e-12)  # roundings
    assert bound.attenuation(60) == pytest.approx(0.9 * float(water.attenuation(60)), rel=1e-12)  # as many photons scatter
    again = pickle.loads(pickle.dumps(bound))
    assert again.form_factor[1] == pytest.approx(squares, rel=1e-12)  # roundings
    assert again.density == 0.9
    with pytest.raises(sk.MaterialError, match="has to reach 0.4"):
        water.with_form_factor([0, 0.3], [1, 2])
    with pytest.raises(sk.ArgumentError, match="alike"):
        water.with_form_factor([0, 0.3, 0.5], [1, 2])


def test_by_mass_or_by_atoms():
    with pytest.raises(sk.MaterialError, match="100"):
        sk.Material("Ti90Al6V4")
    assert sk.Material("Ti90Al6V4", by="mass", density=4.43).elements["Ti"] == pytest.approx(0.9, abs=1e-12)  # roundings
    with pytest.raises(sk.ArgumentError, match="'weight'"):
        sk.Material("H2O", by="weight")


def test_beams():
    beam = sk.Beam.tube(100, filters={"Al": 2.5}, target_angle=12, mas=2)
    twice = sk.Beam.tube(100, filters={sk.Material("Al"): 2.5})
    assert beam.photons.sum() == pytest.approx(2 * twice.photons.sum(), rel=1e-12)  # summed in another order
    assert beam.filtered({"Cu": 0.1}).quality["mean_kev"] > beam.quality["mean_kev"]
    assert beam.scaled(0.5).photons.sum() == pytest.approx(twice.photons.sum(), rel=1e-12)  # likewise
    with pytest.warns(sk.SkiagraphWarning, match="2.5 mm"):
        sk.Beam.tube(100)
    with pytest.raises(sk.BeamError, match="kV"):
        sk.Beam.tube(1)
    with pytest.raises(sk.ArgumentError, match="the field of a tube 'anod' is unknown; did you mean 'anode'"):
        sk.Beam.tube(80, {"Al": 3}, anod=74)
    with pytest.raises(sk.ArgumentError, match=r"kev has the shape \(2,\) and photons \(1,\)"):
        sk.Beam([1, 2], [3])


def test_copies_are_read_only(view):
    """Assignments to a copy would be lost."""
    beam, scan, mesh = sk.Beam.mono(60, 1000), sk.Scan(view, 4), sk.Mesh.cube(1)
    molecules = sk.Material("water").with_form_factor([0, 0.2, 0.5], [9, 4, 1])
    for array in (beam.photons, beam.energies, beam.scaled(2).photons, scan.angles, scan.times, *scan.axis, mesh.vertices, mesh.faces, mesh.origin,
                  sk.Material("Pb").edges, *molecules.form_factor):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 5
    assert pickle.loads(pickle.dumps(beam)).photons.tolist() == [1000] and pickle.loads(pickle.dumps(molecules)).name == molecules.name


def test_plots_with_matplotlib():
    pytest.importorskip("matplotlib").use("Agg")
    axes = sk.Beam.tube(100, {"Al": 2.5}).plot()
    assert "keV" in axes.get_xlabel()


def test_matrices():
    turn = sk.rotate((1, 1, 0), 180, about=(0, 0, 5))
    np.testing.assert_allclose(turn @ (1, 0, 5, 1), (0, 1, 5, 1), atol=1e-12)  # roundings of 5
    with pytest.raises(sk.ArgumentError, match="'w'"):
        sk.rotate("w", 1)
    with pytest.raises(sk.ArgumentError, match="no direction"):
        sk.rotate((0, 0, 0), 1)
    with pytest.raises(sk.ArgumentError, match=r"axis has the shape \(2,\)"):
        sk.rotate((0, 1), 1)


def test_views(view):
    view.check()
    assert sk.translate(0, 0, 0) @ view == view
    moved = sk.translate(1, 2, 3) @ view
    assert moved != view and moved.source.tolist() == [1, 2, -997] and moved.column_step.tolist() == [2, 0, 0]
    view.projection = "parallel_from_infinity"
    assert (sk.translate(1, 2, 3) @ view).source.tolist() == [0, 0, -1000]  # a direction
    view.projection = "point"
    view.row_step = view.column_step
    with pytest.raises(sk.SceneError, match="parallel"):
        view.check()
    view.projection = "fish-eye"
    with pytest.raises(sk.ArgumentError, match="'fish-eye'"):
        view.check()


@pytest.mark.parametrize("call, words", [
    (lambda: sk.Mesh.sphere(5, 3.5), "segments is 3.5; give a whole number"),
    (lambda: sk.Mesh.sphere(5, 2 ** 70), "segments is .*, 0 to 9223372036854775807"),
    (lambda: sk.Mesh.sphere("a", 5), "radius is 'a'; give a number"),
    (lambda: sk.Mesh.cuboid(1, 2, "a"), "z is 'a'; give a number"),
    (lambda: sk.Mesh.star(10, 1, 7.5, 1), "spokes is 7.5; give a whole number"),
    (lambda: sk.Mesh.gyroid("a", 5), "box has .*; give real numbers"),
    (lambda: sk.Mesh.load(5), "path is 5; give a text"),
    (lambda: sk.translate("a", 0, 0), "x is 'a'; give a number"),
    (lambda: sk.rotate("z", None), "degrees is None; give a number"),
    (lambda: sk.Beam.mono("a", 1), "kev is 'a'; give a number"),
    (lambda: sk.Beam.tube(80, {"Al": "a"}), "thickness of a filter is 'a'"),
    (lambda: sk.Material("Al").attenuation("a"), "kev has .*; give real numbers"),
    (lambda: sk.Material.mixture({"H": "a"}, 1), "fraction of H is 'a'"),
    (lambda: sk.Counter("CdTe", 1, 0.1, [20]).spread(60, 1.5), "the number of a window is 1.5"),
    (lambda: sk.Lag([[0.1, 2]], full="a"), "full is 'a'"),
    (lambda: sk.distance(sk.Mesh.cube(1), sk.Mesh.cube(1), spacing="a"), "spacing is 'a'"),
])
def test_wrong_numbers_are_named(call, words):
    """None is cut to a whole number, and none is an error of Python's own."""
    with pytest.raises(sk.ArgumentError, match=words):
        call()


def test_bodies():
    foam = sk.Mesh.foam((20, 20, 20), 1, 0.1, spread=0.1, seed=3)
    assert foam.health["closed"] and (foam.vertices == sk.Mesh.foam((20, 20, 20), 1, 0.1, spread=0.1, seed=3).vertices).all()
    assert sk.Mesh.spheres([(0, 0, 0), (5, 0, 0)], [1, 2]).health["components"] == 2
    assert sk.Mesh.spheres([(0, 0, 0), (5, 0, 0)], 1).health["bounds"][3] == 6
    assert sk.Mesh.fibres((20, 20, 10), 0.5, 30, tilt=20, seed=1).health["components"] == 30
    assert sk.Mesh.gyroid(10, 5).health["closed"] and sk.Mesh.star(20, 1, 36, 0.5).health["components"] == 36
    assert sk.Mesh.line_pairs([1, 2], 3, 10, 1).health["volume"] == pytest.approx(3 * 10 * 0.75, rel=1e-12)  # roundings
    assert sk.Mesh.isosurface(np.ones((3, 4, 5)), 0.5, (1, 2, 3)).health["bounds"][3:] == pytest.approx((2.5, 4, 4.5))
    with pytest.raises(sk.ArgumentError, match="give .z, y, x."):
        sk.Mesh.isosurface(np.ones((3, 4)), 0.5)
    with pytest.raises(sk.MeshError, match="no place is left"):
        sk.Mesh.foam((20, 20, 20), 2, 0.6)
