"""The body of springs: what it is made of, what it keeps, how it swims."""

import numpy as np
import pytest
from designs import DESIGN, SPECIES, changed

import bioscope as bio
from bioscope.errors import FormatError, InvalidValueError


def swum(tank: bio.fish.Tank, seconds: float, every: int = 4) -> dict[str, np.ndarray]:
    """Step and record centers, snouts, tails and headings."""
    kept: dict[str, list] = {"center": [], "snout": [], "tail": [], "yaw": []}
    for _ in range(round(seconds / tank.dt / every)):
        tank.step(steps=every)
        nodes = tank.nodes
        kept["center"].append(tank.center)
        kept["snout"].append(nodes[0])
        kept["tail"].append(nodes[-2:].mean(axis=0))
        kept["yaw"].append(tank.yaw)
    return {name: np.array(values) for name, values in kept.items()}


def elastic_rest(tank: bio.fish.Tank) -> float:
    """Return the greatest relative deformation of any unit from its length at rest."""
    ends = tank.units[:, :2].astype(int)
    lengths = np.linalg.norm(np.diff(tank.nodes[ends], axis=1)[:, 0], axis=1)
    return float(np.abs(lengths / tank.units[:, 2] - 1).max())


@pytest.mark.capability("TF-010", "TF-013", "TF-014", "TF-021", "AA-020")
def test_the_published_fish_is_made_as_published():
    tank = bio.fish.Tank("anthias", preset="published", length=0.5)
    units = tank.units
    assert tank.nodes.shape == (23, 3)
    assert units.shape == (91, 5)
    assert tank.half_bandwidth == 7
    assert tank.stored_entries == 126
    assert [tuple(ends) for ends in units[:12, :2].astype(int)] == [
        (i, i + 4) for i in range(1, 13)
    ]
    shares = tank.masses / tank.mass * 107.03
    assert shares[[0, *range(13, 21)]] == pytest.approx(1.1, rel=1e-6)
    assert shares[[*range(1, 5), *range(9, 13)]] == pytest.approx(6.6, rel=1e-6)
    assert shares[5:9] == pytest.approx(11.0, rel=1e-6)
    assert shares[21:] == pytest.approx(0.165, rel=1e-6)
    stiffness = units[:, 3] / tank.mass * tank.time_unit**2 * 107.03
    assert sorted({round(float(value)) for value in stiffness}) == [28, 30, 38]
    assert stiffness[:12] == pytest.approx(28, rel=1e-3)
    damping = units[:, 4] / tank.mass * tank.time_unit * 107.03
    assert damping == pytest.approx(0.1, rel=1e-3)
    assert np.ptp(tank.nodes[:, 2]) == pytest.approx(0.5)


@pytest.mark.capability("AA-020")
@pytest.mark.parametrize("preset", ["published", "calibrated"])
def test_the_shape_at_rest_is_an_equilibrium(preset):
    tank = bio.fish.Tank("anthias", preset=preset)
    tank.step(np.zeros(12), steps=1000)
    before = tank.nodes
    tank.step(np.zeros(12))
    assert np.abs(tank.nodes - before).max() / tank.dt < 1e-6, "metres per second"


@pytest.mark.capability("AA-022")
def test_a_push_is_braked_by_the_water_alone():
    tank = bio.fish.Tank("anthias")
    tank.kick((0, 0, tank.cruise))
    speeds = []
    for _ in range(200):
        tank.step(np.zeros(12), steps=5)
        speeds.append(np.linalg.norm(tank.velocity))
    assert (np.diff(speeds) < 0).all()
    assert speeds[-1] < 0.5 * speeds[0]


@pytest.mark.capability("AA-023")
def test_muscles_are_as_long_as_they_are_told():
    def lengths(contraction: float) -> np.ndarray:
        tank = bio.fish.Tank("anthias")
        tank.step(np.full(12, contraction), steps=1000)
        ends = tank.units[:12, :2].astype(int)
        between = np.diff(tank.nodes[ends], axis=1)[:, 0]
        return np.linalg.norm(between, axis=1) / tank.units[:12, 2]

    assert lengths(0.0) == pytest.approx(1.0, abs=1e-6)
    falling = [lengths(share).mean() for share in (0.0, 0.25, 0.5, 0.75, 1.0)]
    assert np.diff(falling) == pytest.approx(np.full(4, (falling[-1] - 1) / 4), rel=0.05)
    assert falling[-1] == pytest.approx(0.76, abs=0.02), "shortened by 24 percent at most"


@pytest.mark.capability("TF-011", "TF-026")
def test_an_impulse_dies_away_and_the_shape_returns():
    tank = bio.fish.Tank("anthias")
    assert tank.energy < 1e-10
    rng = np.random.default_rng(4)
    for _ in range(60):
        tank.step(rng.uniform(0, 1, 12))
    assert elastic_rest(tank) > 0.01
    tank.step(np.zeros(12), steps=60)
    before = tank.energy
    for _ in range(200):
        tank.step(np.zeros(12), steps=10)
        after = tank.energy
        assert after <= before * (1 + 1e-9)
        before = after
    assert elastic_rest(tank) < 0.005


@pytest.mark.capability("TF-012")
def test_a_contracted_side_is_the_inner_side():
    tank = bio.fish.Tank("anthias", water=0.2)
    left = np.tile([1.0, 1.0, 0.0, 0.0], 3)
    tank.step(left, steps=2000)
    assert tank.contraction == pytest.approx(left)
    nodes = tank.nodes
    chord = 0.5 * (nodes[0] + nodes[-2:].mean(axis=0))
    middle = nodes[5:9].mean(axis=0)
    left_of_body = nodes[5:7].mean(axis=0) - nodes[7:9].mean(axis=0)
    assert np.dot(chord - middle, left_of_body) > 0
    ends = tank.units[:12, :2].astype(int)
    lengths = np.linalg.norm(np.diff(nodes[ends], axis=1)[:, 0], axis=1) / tank.units[:12, 2]
    assert (lengths[np.tile([True, True, False, False], 3)] < 0.95).all()


@pytest.mark.capability("TF-016")
def test_the_greatest_girth_is_just_before_the_middle():
    for preset in ("calibrated", "published"):
        nodes = bio.fish.Tank("anthias", preset=preset).nodes
        rings = nodes[1:21].reshape(5, 4, 3)
        areas = np.ptp(rings[:, :, 0], axis=1) * np.ptp(rings[:, :, 1], axis=1)
        place = (nodes[0, 2] - rings[areas.argmax(), 0, 2]) / np.ptp(nodes[:, 2])
        assert 0.35 <= place <= 0.5


@pytest.mark.capability("TF-017", "AA-022")
def test_swimming_has_the_measures_of_a_carangiform_swimmer():
    tank = bio.fish.Tank("anthias")
    length, speed = tank.length, tank.cruise
    tank.swim(speed)
    tank.kick((0, 0, speed))
    tank.run(5)
    beat = np.interp(speed, tank.strokes[:, 0], tank.strokes[:, 1])
    track = swum(tank, 20 / beat)
    way = track["center"][-1] - track["center"][0]
    mean_speed = np.linalg.norm(way) / (len(track["center"]) * 4 * tank.dt)
    side = np.cross([0, 1, 0], way / np.linalg.norm(way))
    tail = np.ptp((track["tail"] - track["center"][0]) @ side)
    recoil = np.ptp((track["snout"] - track["center"][0]) @ side)
    assert 0.2 <= beat * tail / mean_speed <= 0.45
    assert mean_speed / beat >= 0.3 * length
    assert recoil < 0.1 * length
    half = len(track["yaw"]) // 2
    assert abs(track["yaw"][half:].mean() - track["yaw"][:half].mean()) < np.radians(5)
    lateral = (track["center"] - track["center"][0]) @ side
    assert abs(np.polyfit(np.arange(len(lateral)), lateral, 1)[0] * len(lateral)) < 0.1 * length
    assert mean_speed == pytest.approx(speed, rel=0.15)


@pytest.mark.capability("TF-018", "TF-024")
def test_without_water_the_tail_beats_in_place():
    def moved(water: float) -> tuple[float, float]:
        tank = bio.fish.Tank("anthias", water=water)
        tank.feedback(False)
        tank.swim(tank.cruise)
        track = swum(tank, 4)
        swing = np.ptp((track["tail"] - track["center"])[:, 0])
        return float(np.linalg.norm(track["center"][-1])) / tank.length, float(swing)

    still, wide = moved(0.0)
    swims, narrow = moved(1.0)
    thick, _ = moved(3.0)
    assert still < 1e-6
    assert swims > 1
    assert abs(thick - swims) > 0.02 * swims
    assert wide > narrow


@pytest.mark.capability("TF-018", "TF-024")
def test_without_water_fins_move_and_right_nothing():
    for order in (lambda tank: tank.ascend(0.8), lambda tank: tank.backward(0.1), None):
        tank = bio.fish.Tank("anthias", water=0.0)
        tank.place(roll=0.5)
        if order:
            order(tank)
        tank.run(5)
        assert np.linalg.norm(tank.center) < 1e-6 * tank.length
        assert tank.roll == pytest.approx(0.5, abs=1e-3)


@pytest.mark.capability("TF-017", "TF-026")
@pytest.mark.parametrize("water", [0.0, 1.0])
def test_a_passive_body_never_gains_energy(water):
    rng = np.random.default_rng(1)
    tank = bio.fish.Tank("clownfish", water=water)
    tank.deform(tank.nodes + rng.normal(0, 0.02 * tank.length, (23, 3)))
    tank.kick((0.05, 0.02, -0.1))
    energy = [tank.energy]
    for _ in range(2000):
        tank.step(np.zeros(12))
        energy.append(tank.energy)
    assert np.diff(energy).max() <= 1e-9 * energy[0]


@pytest.mark.capability("TF-019", "TF-025", "TF-170", "AA-027")
def test_a_passive_fish_floats_and_is_carried_by_the_current():
    tank = bio.fish.Tank("anthias")
    tank.run(10)
    assert np.abs(tank.center).max() < 1e-6
    tank.flow((0.1, 0, 0.02))
    tank.run(60)
    assert tank.velocity == pytest.approx([0.1, 0, 0.02], abs=0.01)
    assert abs(tank.center[1]) < 0.1 * tank.length


@pytest.mark.capability("TF-019", "TF-170")
def test_a_current_is_felt_where_the_fish_is():
    tank = bio.fish.Tank("anthias")
    tank.flow(bio.Current((1, 0, 0), speed=0.2, surge=0.0, turbulence=0.0))
    # The water's hold on it falls with the square of what is still missing.
    tank.run(60)
    assert tank.velocity == pytest.approx([0.2, 0, 0], abs=0.02)
    eddies = bio.fish.Tank("anthias")
    eddies.flow(bio.Current((1, 0, 0), speed=0.0, surge=0.0, turbulence=0.3, eddy_size=0.5))
    eddies.run(10)
    assert np.linalg.norm(eddies.center) > eddies.length


@pytest.mark.capability("TF-015")
def test_other_masses_and_muscles_swim_worse(tmp_path):
    def speed(preset: str) -> float:
        """Speed of a fish that beats blindly as the nominal one does in easy swimming."""
        tank = bio.fish.Tank("anthias", preset=preset)
        tank.feedback(False)
        tank.kick((0, 0, tank.cruise))
        tank.swim(tank.cruise)
        tank.run(4)
        start = tank.center
        tank.run(6)
        return float(np.linalg.norm(tank.center - start)) / 6

    masses = r"^masses = .*$"
    heavy = changed(
        DESIGN, tmp_path / "heavy.toml", masses, "masses = [2.2, 6.6, 6.6, 6.6, 6.6, 6.6, 3.3]"
    )
    weak = changed(DESIGN, tmp_path / "weak.toml", r"^shortening = .*$", "shortening = 0.08")
    nominal = speed(str(DESIGN))
    assert speed(heavy) < 0.95 * nominal
    assert speed(weak) < 0.7 * nominal


@pytest.mark.capability("TF-022")
def test_the_numbering_of_the_nodes_decides_the_bandwidth():
    tank = bio.fish.Tank("anthias")
    ends = tank.units[:, :2].astype(int)
    assert np.abs(np.diff(ends, axis=1)).max() == tank.half_bandwidth == 7
    moved = np.where(ends == 22, 1, np.where(ends == 0, 0, ends + 1))
    assert np.abs(np.diff(moved, axis=1)).max() == 21


@pytest.mark.capability("TF-020", "TF-023")
def test_the_implicit_step_holds_where_the_others_break():
    def holds(integrator: str, step: float, count: int = 4000) -> bool:
        unit = bio.fish.Tank("anthias", preset="published").time_unit
        tank = bio.fish.Tank("anthias", preset="published", integrator=integrator, dt=step * unit)
        tank.swim(tank.cruise)
        try:
            tank.step(steps=count)
        except bio.BioscopeError:
            return False
        return bool(np.isfinite(tank.nodes).all()) and elastic_rest(tank) < 0.5

    assert holds("implicit", 0.44, 1000)
    assert holds("implicit", 0.055)
    assert holds("semi_implicit", 0.03)
    assert not holds("semi_implicit", 0.2)
    assert holds("explicit", 0.001)
    assert not holds("explicit", 0.03)


@pytest.mark.capability("TF-020", "AA-021")
@pytest.mark.parametrize("preset", ["calibrated", "published"])
def test_random_activation_is_survived_for_a_hundred_thousand_published_steps(preset):
    step = 0.055 * bio.fish.Tank("anthias", preset=preset).time_unit
    tank = bio.fish.Tank("anthias", preset=preset, dt=step)
    rng = np.random.default_rng(1)
    for _ in range(2500):
        tank.step(rng.uniform(0, 1, 12), steps=40)
    assert np.isfinite(tank.nodes).all()
    tank.step(np.zeros(12), steps=9000)
    assert elastic_rest(tank) < 0.01


@pytest.mark.capability("TF-017", "TF-020")
def test_the_published_fish_swims_as_fast_as_its_table_says():
    tank = bio.fish.Tank("anthias", preset="published")
    tank.swim(tank.cruise)
    tank.kick((0, 0, tank.cruise))
    tank.run(40 * tank.length / tank.cruise)
    start = tank.center
    tank.run(10 * tank.length / tank.cruise)
    speed = np.linalg.norm(tank.center - start) / (10 * tank.length / tank.cruise)
    assert speed == pytest.approx(tank.cruise, rel=0.1)


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda tank: tank.step(steps=-1), "steps"),
        (lambda tank: tank.step(steps=10**30), "steps"),
        (lambda tank: tank.step(steps=1.5), "steps"),
        (lambda tank: tank.step("fast"), "activations"),
        (lambda tank: tank.run(-1.0), "seconds"),
        (lambda tank: tank.swim("fast"), "speed"),
        (lambda tank: tank.swim(None), "speed"),
        (lambda tank: tank.turn(float("inf")), "angle"),
        (lambda tank: tank.kick((1, 2)), "velocity"),
        (lambda tank: tank.kick(None), "velocity"),
        (lambda tank: tank.flow((0, 0, float("nan"))), "velocity"),
        (lambda tank: tank.deform("flat"), "nodes"),
        (lambda _: bio.fish.Tank(None), "species"),
        (lambda _: bio.fish.Tank(preset=None), "preset"),
        (lambda _: bio.fish.Tank(dt="short"), "dt"),
        (lambda _: bio.fish.Tank(length=float("nan")), "length"),
        (lambda _: bio.fish.Tank(water="salt"), "water"),
    ],
)
def test_wrong_orders_are_refused_by_the_name_of_the_field(call, field):
    tank = bio.fish.Tank("anthias")
    with pytest.raises(InvalidValueError, match=field):
        call(tank)
    tank.step()


def test_species_are_known_by_other_spellings_and_by_files(tmp_path):
    def length(species):
        return bio.fish.Tank(species).length

    assert length("Emperor Angelfish") == length("emperor_angelfish")
    assert length("butterfly fish") == length("butterfly-fish") == length("butterflyfish")
    assert length("shark") == length("blacktip_shark")
    mine = changed(SPECIES, tmp_path / "mine.toml", r"^length = .*$", "length = 0.5")
    assert length(mine) == length(tmp_path / "mine.toml") == pytest.approx(0.5)
    (tmp_path / "noise.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(FormatError, match=r"noise\.toml"):
        length(tmp_path / "noise.toml")


def test_the_calibrated_fish_strides_longer_than_the_published_one():
    published = bio.fish.Tank("anthias", preset="published")
    calibrated = bio.fish.Tank("anthias")
    stride = [
        tank.strokes[1:, 0] / tank.strokes[1:, 1] / tank.length for tank in (published, calibrated)
    ]
    assert stride[1].max() > stride[0].max()
