"""What fishes notice: Tu 1996, chapter 5; through worlds with one artificial fish that looks."""

import math

import numpy as np
import pytest

import bioscope as bio

LENGTH_KEY = "body_length_m"


class Things(bio.Population):
    """Living balls, 1 m across at scale 1, at given places."""

    transient = ("mesh", "material")

    def __init__(self, places, scales=0.1, species="ball", color=(0.9, 0.2, 0.1)):
        self.places = np.atleast_2d(np.asarray(places, np.float32))
        self.scales = np.broadcast_to(np.float32(scales), len(self.places)).copy()
        self.species = species
        self.mesh, self.material = ball(), bio.Material(color=color)
        self.rotations = np.tile(np.float32([0, 0, 0, 1]), (len(self.places), 1))
        self.ids = np.empty(0, np.uint32)

    def settle(self):
        return len(self.places)

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        scene.instances(
            self.species,
            self.mesh,
            self.material,
            ids=self.ids,
            positions=self.places,
            rotations=self.rotations,
            scales=self.scales,
            velocities=np.full_like(self.places, 0.25),
        )


class Morsels(bio.Population):
    """Food too small for a mesh."""

    def __init__(self, places):
        self.places = np.atleast_2d(np.asarray(places, np.float32))
        self.ids = np.empty(0, np.uint32)

    def settle(self):
        return len(self.places)

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        radii = np.full(len(self.ids), 0.003, np.float32)
        scene.points("plankton", ids=self.ids, positions=self.places, radii=radii)


class Spring(bio.Field):
    """Warm at one side."""

    def __init__(self, slope):
        self.slope = slope

    def at(self, points, time):
        return {"temperature": (self.slope * points[:, 0]).astype(np.float32)}


def ball(rings=12):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * rings), np.linspace(0, np.pi, rings))
    points = 0.5 * np.stack([np.cos(u) * np.sin(v), np.cos(v), np.sin(u) * np.sin(v)], axis=-1)
    columns = 2 * rings
    triangles = []
    for row in range(rings - 1):
        for column in range(columns - 1):
            a = row * columns + column
            triangles += [[a, a + 1, a + columns], [a + 1, a + columns + 1, a + columns]]
    return bio.Mesh(points.reshape(-1, 3).astype(np.float32), np.array(triangles, np.uint32))


class Lookout:
    """A world with one fish that hardly moves, and things put where they shall be seen from it."""

    def __init__(self, *, food=(), prepare=None, eye=False):
        self.world = bio.World(seed=3)
        if prepare:
            prepare(self.world)
        mind = bio.minds.Intentions(
            "pacifist", food=food, cruise_speed=0.0, full_speed=0.0, eye=eye
        )
        self.fish = self.world.add(
            bio.RoamingFish("anthias", 1, center=(0, 0, 0), radius=0.0, mind=mind, body="swimmer")
        )
        self.world.step(1)
        self.id = int(self.fish.values("id")[0])

    @property
    def length(self):
        return self.world.inspect(self.id)["values"][LENGTH_KEY]

    @property
    def eye(self):
        """Place of the eye and the fish's own axes: left, up, ahead."""
        camera = self.world.inspect(self.id)["eye"]
        x, y, z, w = camera.rotation

        def turned(v):
            q = np.array([x, y, z])
            v = np.array(v, float)
            return v + 2 * np.cross(q, np.cross(q, v) + w * v)

        axes = [turned((-1, 0, 0)), turned((0, 1, 0)), turned((0, 0, -1))]
        return np.array(camera.position), np.array(axes)

    def place(self, own):
        """Return the place in the world that lies there seen from the eye (left, up, ahead)."""
        origin, axes = self.eye
        return origin + np.asarray(own, float) @ axes

    def percepts(self):
        self.world.step(2)
        return self.world.inspect(self.id)["percepts"]


def at(degrees, far):
    angle = math.radians(degrees)
    return (far * math.sin(angle), 0.0, far * math.cos(angle))


@pytest.mark.capability("TF-070", "TF-168", "AA-030")
def test_temperature_is_that_of_the_water_at_the_body():
    def warm(world):
        world.environment.add(Spring(40.0))
        world.environment.set(temperature=20.0)

    lookout = Lookout(prepare=warm)
    lookout.world.step(5)
    x = lookout.world.scene.batches[0].positions[0][0]
    # It moves by less than a millimetre in the tick between the two.
    assert lookout.percepts()["temperature_degc"] == pytest.approx(20 + 40 * x, abs=0.2)


@pytest.mark.capability("TF-071", "AA-031")
@pytest.mark.parametrize(("degrees", "visible"), [(0, 1), (149, 1), (151, 0), (-149, 1), (180, 0)])
def test_the_field_of_view_is_300_degrees(degrees, visible):
    lookout = Lookout()
    lookout.world.add(Things(lookout.place(at(degrees, 0.6))))
    assert lookout.percepts()["seen"] == visible


@pytest.mark.capability("TF-071", "TF-073", "AA-031")
@pytest.mark.parametrize("size", [0.05, 0.1, 0.4])
def test_the_distance_of_detection_grows_with_the_size(size):
    for share, visible in ((0.97, 1), (1.03, 0)):
        lookout = Lookout()
        lookout.world.add(Things(lookout.place((0, 0, 15 * size * share)), size))
        assert lookout.percepts()["seen"] == visible


@pytest.mark.capability("TF-072")
def test_food_is_smelled_farther_than_fish_are_seen_and_behind():
    lookout = Lookout(food=["plankton"])
    far = 17 * lookout.length
    lookout.world.add(
        Morsels([lookout.place(at(180, far)), lookout.place(at(0, far + lookout.length))])
    )
    lookout.world.add(Things(lookout.place(at(180, far)), lookout.length))
    percepts = lookout.percepts()
    assert (percepts["smelled"], percepts["seen"]) == (2, 0)
    picky = Lookout(food=["algae"])
    picky.world.add(Morsels(picky.place(at(0, 0.1))))
    assert picky.percepts()["smelled"] == 0


@pytest.mark.capability("TF-074", "AA-031")
@pytest.mark.parametrize(
    ("case", "base", "top", "hidden"),
    [
        ("through the middle", (0, -1, 0.5), (0, 1, 0.5), True),
        ("over the top", (0, -1, 0.5), (0, -0.2, 0.5), False),
        ("beyond the target", (0, -1, 1.5), (0, 1, 1.5), False),
        ("beside the way", (0.4, -1, 0.5), (0.4, 1, 0.5), False),
        ("in at the cap, out at the base", (0, -0.1, 0.5), (0, 0.1, 0.5), True),
    ],
)
def test_cylinders_hide_what_is_behind_them(case, base, top, hidden):
    lookout = Lookout()
    lookout.world.environment.cylinder(tuple(lookout.place(base)), tuple(lookout.place(top)), 0.15)
    lookout.world.add(Things(lookout.place((0, 0, 1.0)), 0.1))
    assert lookout.percepts()["seen"] == (0 if hidden else 1), case


@pytest.mark.capability("TF-075")
def test_a_part_that_shows_is_enough():
    def seen(radius):
        lookout = Lookout()
        lookout.world.environment.cylinder(
            tuple(lookout.place((0, -4, 1.0))), tuple(lookout.place((0, 4, 1.0))), radius
        )
        # Two metres long and turned sideways, with a pillar before its middle.
        left = lookout.place((1, 0, 0)) - lookout.place((0, 0, 0))
        turn = np.append(np.cross((0, 0, 1), left), 1 + left[2])
        things = Things(lookout.place((0, 0, 2.0)), 2.0)
        things.rotations = np.float32([turn / np.linalg.norm(turn)])
        lookout.world.add(things)
        return lookout.percepts()["seen"]

    assert (seen(0.2), seen(0.9)) == (1, 0)


@pytest.mark.capability("TF-076", "TF-080", "TF-082", "AA-032")
def test_what_is_told_of_things_is_true():
    class Witness(bio.Mind):
        def decide(self, percepts):
            self.seen = [dict(one) for one in percepts["seen"]]
            self.solids = list(percepts["solids"])
            self.attitude = percepts["attitude"]
            return {"behavior": "look", "speed": 0.0}

    witnesses = []

    def mind():
        witnesses.append(Witness())
        return witnesses[-1]

    world = bio.World(seed=1)
    world.add(bio.RoamingFish("anthias", 1, center=(0, 0, 0), radius=0.0, mind=mind))
    places = [(0.4, 0.1, 0.9), (-0.3, 0.0, 0.8), (0.1, -0.2, 1.1)]
    things = world.add(Things(places, (0.1, 0.2, 0.3), color=(0.5, 0.25, 0.75)))
    world.environment.cylinder((0.2, -1, 0.0), (0.2, 1, 0.0), 0.05)
    world.step(1)
    attitude = np.array(
        witnesses[0].attitude if hasattr(witnesses[0], "attitude") else (0, 0, 0, 1)
    )
    world.step(1)
    fish = world.scene.batches[0].positions[0]
    q, w = attitude[:3], attitude[3]
    for one in witnesses[0].seen:
        index = list(things.ids).index(one["id"])
        own = np.array(one["position"])
        place = fish + own + 2 * np.cross(q, np.cross(q, own) + w * own)
        assert place == pytest.approx(things.places[index], abs=0.02)
        assert one["size"] == pytest.approx(things.scales[index], rel=0.02)
        assert one["color"] == pytest.approx((0.5, 0.25, 0.75), abs=1e-5)
        assert np.linalg.norm(one["velocity"]) == pytest.approx(0.25 * math.sqrt(3), abs=1e-3)
        assert one["species"] == "ball"
    assert len(witnesses[0].solids) == 1


@pytest.mark.capability("TF-083", "AA-034", "TF-194")
def test_two_eyes_see_with_disparity_and_pan_and_tilt():
    lookout = Lookout()
    near, far = lookout.place((0, 0, 0.4)), lookout.place((0.8, 0, 3.9))
    things = lookout.world.add(Things([near, far], (0.08, 0.5)))
    lookout.world.step(1)
    scene = lookout.world.scene

    def column(camera, one):
        identity = bio.look(scene, camera, (300, 300)).identity
        return float(np.mean(np.nonzero(identity == things.ids[one])[1]))

    left, right = bio.senses.eyes(lookout.world, lookout.id, apart=0.5)
    disparity = [column(left, one) - column(right, one) for one in (0, 1)]
    # What is nearer lies farther to the right in the left eye.
    assert disparity[0] > disparity[1] + 1 > 0
    panned, _ = bio.senses.eyes(lookout.world, lookout.id, apart=0.0, pan=40)
    straight, _ = bio.senses.eyes(lookout.world, lookout.id, apart=0.0)
    assert column(panned, 1) > column(straight, 1) + 30
    with pytest.raises(LookupError, match="12345"):
        bio.senses.eyes(lookout.world, 12345)


@pytest.mark.capability("TF-084", "TF-195")
def test_identity_maps_color_individuals_apart_and_species_alike():
    lookout = Lookout()
    first = [lookout.place((0.3 * x, 0.3 * y, 2.0)) for x in range(-3, 4) for y in range(-3, 4)]
    second = [lookout.place((0.3 * x, 1.5, 2.0)) for x in range(-3, 4)]
    lookout.world.add(Things(first))
    lookout.world.add(Things(second, species="other"))
    lookout.world.step(1)
    camera = lookout.world.inspect(lookout.id)["eye"]
    view = bio.look(lookout.world.scene, camera, (400, 400))
    picture = view.identity_map(lookout.world.scene)
    by_id = {}
    for one in np.unique(view.identity):
        colors = np.unique(picture[view.identity == one].reshape(-1, 3), axis=0)
        assert len(colors) == 1
        by_id[int(one)] = tuple(int(c) for c in colors[0])
    assert len(set(by_id.values())) == len(by_id)
    assert by_id[0] == (0, 0, 0)
    import colorsys

    def hues(batch):
        found = [by_id[int(one)] for one in batch.ids if int(one) in by_id]
        return [colorsys.rgb_to_hsv(*(c / 255 for c in color))[0] for color in found]

    batches = {batch.species: hues(batch) for batch in lookout.world.scene.batches}
    assert np.ptp(batches["ball"]) < 0.03
    assert np.ptp(batches["other"]) < 0.03
    assert abs(np.mean(batches["ball"]) - np.mean(batches["other"])) > 0.1


@pytest.mark.capability("TF-085")
def test_range_maps_darken_with_distance():
    lookout = Lookout()
    lookout.world.add(Things([lookout.place((x, 0, 1.5 + x)) for x in (-1, 0, 1)], 0.4))
    lookout.world.step(1)
    view = bio.look(lookout.world.scene, lookout.world.inspect(lookout.id)["eye"], (200, 200))
    picture = view.range_map(6.0)
    near = np.argsort(view.depth[np.isfinite(view.depth)])
    greys = picture[np.isfinite(view.depth)][near].astype(int)
    assert (np.diff(greys) <= 0).all()
    assert greys[0] > greys[-1] + 60
    assert (picture[~np.isfinite(view.depth)] == 0).all()


@pytest.mark.capability("TF-086")
def test_what_the_retina_shows_is_what_is_seen():
    lookout = Lookout()
    lookout.world.environment.cylinder(
        tuple(lookout.place((0, -2, 0.9))), tuple(lookout.place((0, 2, 0.9))), 0.2
    )
    places = [lookout.place(at(angle, 1.4)) for angle in range(-140, 141, 20)]
    things = lookout.world.add(Things(places, 0.2))
    seen = lookout.percepts()["seen"]
    # The cylinder is not drawn by itself: a pillar of the scene stands where it is.
    view = bio.look(lookout.world.scene, lookout.world.inspect(lookout.id)["eye"], (600, 600))
    shown = set(np.unique(view.identity)) & {int(one) for one in things.ids}
    assert len(shown) == len(places)
    assert seen == len(places) - 1, "only the one straight behind the pillar is hidden"


@pytest.mark.capability("TF-081", "AA-033")
def test_brightness_is_the_mean_of_the_retinal_image():
    rows, columns = np.indices((32, 32)) + 0.5
    within = (rows - 16) ** 2 + (columns - 16) ** 2 <= 16**2
    levels = []
    for sunlight in (0.0, 1.0, 2.0):
        # The same fish at the same moment each time: it swims on.
        lookout = Lookout(eye=True)
        lookout.world.add(Things([lookout.place(at(a, 0.5)) for a in range(-120, 121, 30)], 0.2))
        lookout.world.environment.set(sunlight=sunlight)
        light = lookout.percepts()["light"]
        # The eye saw the scene of the tick before; nothing but the fish itself has moved since.
        camera = lookout.world.inspect(lookout.id)["eye"]
        color = bio.look(lookout.world.scene, camera, (32, 32)).color
        mean = float((color @ (0.2126, 0.7152, 0.0722))[within].mean())
        assert light == pytest.approx(mean / 0.5, rel=0.05)
        levels.append(light)
    assert levels[0] < levels[1] < levels[2]
    # What the sky gives is there without the sun; the rest doubles with the sun's intensity.
    sunlit = [level - levels[0] for level in levels]
    assert sunlit[2] == pytest.approx(2 * sunlit[1], rel=0.01)


@pytest.mark.capability("TF-079", "TF-077")
def test_a_crowd_elsewhere_changes_nothing():
    def percepts(crowd):
        lookout = Lookout(food=["plankton"])
        lookout.world.add(Things([lookout.place(at(a, 0.7)) for a in range(-120, 121, 40)]))
        if crowd:
            grid = np.stack(np.meshgrid(*[np.arange(12) * 0.3] * 3), axis=-1).reshape(-1, 3)
            lookout.world.add(Things(grid + np.array((40, 0, 0)), 0.1, species="crowd"))
        return lookout.percepts()

    assert percepts(False) == percepts(True)
