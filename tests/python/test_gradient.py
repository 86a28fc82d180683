"""Gradients of scenes."""
import numpy as np
import pytest

import skiagraph as sk


@pytest.fixture
def scene():
    """Two balls, one in the other, before 32 x 24 pixels."""
    made = sk.Scene()
    made.add("outer", sk.Mesh.sphere(30, 24), material="water")
    made.add("inner", sk.Mesh.sphere(9, 16), material="Al", inside="outer", pose=sk.translate(5, -3, 2))
    made.view = sk.View(source=(7, 11, -1000), detector=(0, 0, 200), column_step=(3, 0, 0), row_step=(0, 3, 0), pixels=(32, 24))
    made.beam = sk.Beam.mono(60, 1000)
    return made


def weights(shape):
    return np.random.default_rng(1).uniform(-0.5, 0.5, shape)


def loss(scene, given, **options):
    return float((scene.image(precision="double", **options) * given).sum())


def test_poses_source_and_density_against_differences(scene):
    given, step = weights((24, 32)), 1e-4
    found = scene.gradient(given, wrt=sk._gradient.NAMES, quantity="attenuation", precision="double")
    assert list(found) == list(sk._gradient.NAMES)
    part, pose = scene["inner"], scene["inner"].pose
    for axis in range(3):
        moves = np.eye(3)[axis] * step
        part.pose = sk.translate(*moves) @ pose
        ahead = loss(scene, given, quantity="attenuation")
        part.pose = sk.translate(*-moves) @ pose
        slope = (ahead - loss(scene, given, quantity="attenuation")) / (2 * step)
        part.pose = pose
        # hits that change within the step: some of 768 pixels at edges of faces, whose slopes differ
        assert found["poses"]["inner"][axis] == pytest.approx(slope, rel=2e-3, abs=2e-3)
    images = [scene.lengths(label, precision="double") for label in ("outer", "inner")]
    attenuation = scene.image("attenuation", precision="double")
    parts = [found["density"][label] for label in ("outer", "inner")]
    # the attenuation is linear in both densities
    assert sum(parts) == pytest.approx(float((attenuation * given).sum()), rel=1e-9)
    assert all(image.max() > 0 for image in images)


def test_vertices_add_up_to_the_translation(scene):
    found = scene.gradient(weights((24, 32)), wrt=("poses", "vertices"), precision="double")
    for label in ("outer", "inner"):
        assert found["vertices"][label].shape == (len(scene[label].mesh.vertices), 3)
        np.testing.assert_allclose(found["vertices"][label].sum(axis=0), found["poses"][label][:3],
                                   rtol=1e-9, atol=1e-9 * np.abs(found["poses"][label]).max())


def test_coefficients_make_up_the_density(scene):
    scene.beam = sk.Beam([40, 60, 90], [50, 80, 30])
    given = weights((24, 32))
    for label, material in (("inner", "Al"), ("inner", "Cu")):
        scene[label].material = material
        found = scene.gradient(given, wrt=("density", "mu"), precision="double")
        energies = [kev for kev, _ in scene.plan(precision="double")["energies"]]
        assert energies == [40, 60, 90] and found["mu"]["outer"].shape == (3,)
        for name, matter in (("outer", "water"), ("inner", material)):
            # a density scales the coefficients of all energies; attenuation() is in 1/cm
            assert found["mu"][name] @ sk.Material(matter).attenuation(energies) == pytest.approx(found["density"][name], rel=1e-6)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_a_part_of_the_material_around_it_has_a_density(scene, precision):
    """Such a part adds nothing to the image, but more of it would; a third part inside it, and its own child, count as well."""
    scene["inner"].material = "water"
    scene.add("core", sk.Mesh.sphere(4, 12), material="Al", inside="inner", pose=sk.translate(5, -3, 2))
    given = weights((24, 32))
    found = scene.gradient(given, wrt=("density", "poses"), quantity="attenuation", precision=precision)
    mu, tolerance = sk.Material("water").attenuation(60) / 10, {"double": 1e-9, "single": 1e-4}[precision]
    for label in ("outer", "inner"):
        length = scene.lengths(label, precision="double")
        assert found["density"][label] == pytest.approx(mu * float((length * given).sum()), rel=tolerance, abs=tolerance * mu * length.sum())
    assert (found["poses"]["inner"] == 0).all() and (found["poses"]["core"] != 0).any()


def test_forward_and_reverse_agree(scene):
    given = weights((24, 32))
    rng = np.random.default_rng(2)
    shape = scene["outer"].mesh.vertices.shape
    direction = {"poses": {"inner": rng.uniform(-1, 1, 6) * [1, 1, 1, 0.1, 0.1, 0.1]}, "source": rng.uniform(-1, 1, 3),
                 "detector": rng.uniform(-1, 1, 6) * [1, 1, 1, 0.01, 0.01, 0.01],
                 "vertices": {"outer": rng.uniform(-1, 1, shape)}}
    along = scene.derivative(direction, quantity="attenuation", precision="double")
    assert along.shape == (24, 32) and along.dtype == np.float64
    found = scene.gradient(given, wrt=tuple(direction), quantity="attenuation", precision="double")
    both = (found["poses"]["inner"] @ direction["poses"]["inner"] + found["source"] @ direction["source"]
            + found["detector"] @ direction["detector"]
            + (found["vertices"]["outer"] * direction["vertices"]["outer"]).sum())
    # integers of 28 bits below the mean slope, over 768 pixels
    assert both == pytest.approx(float((along * given).sum()), rel=1e-7, abs=1e-7 * np.abs(along * given).sum())


def test_a_list_of_directions_has_the_bits_of_each(scene):
    directions = [{"poses": {"inner": [1, 0, 0, 0, 0, 0.01]}}, {"source": [0, 1, 0]}, {"density": {"outer": 0.1}},
                  {"mu": {"inner": [0.1, 0, 0.2]}}]
    scene.beam = sk.Beam([40, 60, 90], [50, 80, 30])
    together = scene.derivative(directions, quantity="attenuation")
    assert together.shape == (4, 24, 32)
    for one, found in zip(directions, together):
        assert np.array_equal(scene.derivative(one, quantity="attenuation"), found) and found.any()
    assert scene.derivative(tuple(directions[:1]), quantity="attenuation").shape == (1, 24, 32)
    with pytest.raises(sk.ArgumentError, match="no directions"):
        scene.derivative([])
    with pytest.raises(sk.ArgumentError, match="direction 1's source is nan"):
        scene.derivative([{"source": [0, 0, 1]}, {"source": [0, 0, float("nan")]}])


def test_a_ray_through_an_edge_has_the_derivative_of_one_side():
    """Rays of a parallel beam aslant meet the edges of a box exactly: there the image has one slope on each side, and the derivative is one of the two."""
    made, step, given = sk.Scene(), 1e-4, np.random.default_rng(2).uniform(0.5, 1, (60, 60))
    made.add("box", sk.Mesh.cuboid(15, 40, 40), material="mu:0.3")
    made.view = sk.View(source=(-120, -70, -700), detector=(30, 20, 300), column_step=(1, 0, 0), row_step=(0, 1, 0), pixels=(60, 60),
                        projection="parallel")
    made.beam = sk.Beam.mono(60, 1)
    options = {"quantity": "attenuation"}
    images = []
    for moved in (step, 0, -step):
        made["box"].pose = sk.translate(moved, 0, 0)
        images.append(made.image(precision="double", **options))
    made["box"].pose = np.eye(4)
    sides = np.array([images[0] - images[1], images[1] - images[2]]) / step
    # differences of attenuations of about 1, whose rounding is divided by the step
    near = 64 * np.finfo(float).eps / step
    kinks = np.abs(sides[0] - sides[1]) > near
    assert 20 < kinks.sum() < 1000
    taken = {}
    for precision, tolerance in (("single", 1e-5), ("double", near)):  # of single: rounding of a length of 40 mm, some epsilons of float
        found = made.derivative({"poses": {"box": [1, 0, 0, 0, 0, 0]}}, precision=precision, **options)
        distance = np.abs(sides - found)
        assert distance.min(axis=0).max() < tolerance
        taken[precision] = distance.argmin(axis=0)
        back = made.gradient(given, wrt=("poses",), precision=precision, **options)["poses"]["box"][0]
        assert back == pytest.approx(float((found * given).sum()), rel=tolerance, abs=tolerance)
    assert (taken["single"] == taken["double"])[kinks].all()


def test_what_is_wrong_is_said(scene):
    with pytest.raises(sk.ArgumentError, match="'colour'"):
        scene.derivative({"colour": {"inner": 1}})
    with pytest.raises(sk.ArgumentError, match="source has the shape"):
        scene.derivative({"source": [1, 2]})
    with pytest.raises(sk.ArgumentError, match="'colour'"):
        scene.gradient(weights((24, 32)), wrt=("colour",))
    with pytest.raises(sk.ArgumentError, match="24 x 32"):
        scene.gradient(weights((32, 24)))
    with pytest.raises(sk.ArgumentError, match="shape"):
        scene.gradient(np.ones(3))
    with pytest.raises(sk.ArgumentError, match="nan"):
        scene.gradient(np.full((24, 32), np.nan))
    with pytest.raises(sk.UnsupportedError, match="scatter"):
        scene.gradient(weights((24, 32)), scatter=0.1)


class Tensor:
    """A tensor as image() asks for it, for a machine without PyTorch."""

    def __init__(self, array):
        self.array = array

    def detach(self):
        return self

    cpu = detach

    def numpy(self):
        return self.array


def test_a_pose_has_the_derivative_of_its_entries(scene):
    given, step = weights((24, 32)), 1e-4
    by_vertices = scene.gradient(given, wrt=("vertices",), precision="double")["vertices"]["inner"]
    found = sk.torch._affine(scene, "inner", by_vertices)
    pose = np.array(scene["inner"].pose)
    slopes = np.zeros((3, 4))
    for row in range(3):
        for column in range(4):
            sums = []
            for sign in (1, -1):
                moved = pose.copy()
                moved[row, column] += sign * step * (1 if column == 3 else 0.1)  # an arm of 9 mm
                sk.torch._set(scene, ["inner"], [], False, [Tensor(moved)])
                sums.append(loss(scene, given))
            slopes[row, column] = (sums[0] - sums[1]) / (2 * step * (1 if column == 3 else 0.1))
    # hits that change within the step, as above
    np.testing.assert_allclose(found[:3], slopes, rtol=0, atol=5e-3 * np.abs(slopes).max())
    assert (found[3] == 0).all()
    with pytest.raises(sk.ArgumentError, match="poses"):
        sk.torch._set(scene, ["inner"], [], False, [Tensor(np.eye(3))])


def test_torch(scene):
    torch = pytest.importorskip("torch")
    pose = torch.tensor(np.array(scene["inner"].pose), requires_grad=True)
    source = torch.tensor([7.0, 11.0, -1000.0], dtype=torch.float64, requires_grad=True)
    vertices = torch.tensor(np.array(scene["outer"].mesh.vertices), requires_grad=True)
    given = torch.tensor(weights((24, 32)))
    made = sk.torch.image(scene, poses={"inner": pose}, vertices={"outer": vertices}, source=source,
                          precision="double")
    (made * given).sum().backward()
    found = scene.gradient(given.numpy(), wrt=("poses", "source", "vertices"), precision="double")
    np.testing.assert_allclose(pose.grad[:3, 3], found["poses"]["inner"][:3], rtol=1e-9)
    np.testing.assert_allclose(source.grad, found["source"])
    np.testing.assert_allclose(vertices.grad, found["vertices"]["outer"])


def test_torch_by_its_own_check(scene):
    torch = pytest.importorskip("torch")
    rows = torch.tensor(np.array(scene["inner"].pose)[:3], requires_grad=True)
    last = torch.tensor([[0.0, 0.0, 0.0, 1.0]], dtype=torch.float64)
    source = torch.tensor([7.0, 11.0, -1000.0], dtype=torch.float64, requires_grad=True)
    given = torch.tensor(weights((24, 32)))

    def loss(by_rows, by_source):
        made = sk.torch.image(scene, poses={"inner": torch.cat((by_rows, last))}, source=by_source, precision="double", quantity="attenuation")
        return (made * given).sum().reshape(1)

    # central differences over 2e-5 mm: a hit that changes its face changes its slope by that much, and the sum over 768 pixels
    # of numbers of order 1 is rounded by 1e-13, which is 1e-8 of the differences; torch's own tolerances are 1e-3 and 1e-5
    assert torch.autograd.gradcheck(loss, (rows, source), eps=1e-5, atol=1e-5, rtol=1e-3)


def test_directions_of_density_and_coefficients(scene):
    scene.beam = sk.Beam([40, 60, 90], [50, 80, 30])
    given = weights((24, 32))
    options = {"quantity": "attenuation", "precision": "double"}
    found = scene.gradient(given, wrt=("density", "mu"), **options)
    along = scene.derivative({"density": {"inner": 0.5}}, **options)
    size = np.abs(given * along).sum()
    # the same sums forward and back
    assert float((given * along).sum()) == pytest.approx(0.5 * found["density"]["inner"], abs=1e-9 * size)
    change = np.array([0.01, 0.0, 0.02])
    along = scene.derivative({"mu": {"outer": change}}, **options)
    size = np.abs(given * along).sum()
    assert float((given * along).sum()) == pytest.approx(float(change @ found["mu"]["outer"]), abs=1e-9 * size)
    with pytest.raises(sk.ArgumentError, match="the direction has 'colour'"):
        scene.derivative({"colour": 1})
    with pytest.raises(sk.ArgumentError, match="mu"):
        scene.derivative({"mu": {"outer": [1, 2]}}, **options)
    with pytest.raises(sk.ArgumentError, match="it has to be finite"):
        scene.derivative({"density": {"outer": float("nan")}}, **options)
