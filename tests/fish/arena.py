"""A tank of points with a heading, in which minds are tried by themselves.

Every fish notices the others as its senses would tell it (a view of 300 degrees, 15 times the size
of what is seen; smell of food; a feeler ahead) and turns, climbs and swims as it intends, within
limits of turning and acceleration. Frames are the package's: x left, y up, z ahead.
"""

import math
from dataclasses import dataclass, field

DT = 1 / 30
TURN_RATE = 5.0
"""Radians per second."""
SIGHT, SMELL = 15.0, 20.0
"""Ranges: sizes of what is seen, own body lengths."""
FEELER = 2.5


def add(a, b, scale=1.0):
    return (a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def distance(a, b):
    return math.dist(a, b)


@dataclass
class Pillar:
    """An upright cylinder without end."""

    x: float
    z: float
    radius: float

    def gap(self, place):
        """Return the distance of a place from the surface, negative inside."""
        return math.hypot(place[0] - self.x, place[2] - self.z) - self.radius

    def nearest(self, place):
        """Return the nearest point of the surface."""
        dx, dz = place[0] - self.x, place[2] - self.z
        scale = self.radius / max(math.hypot(dx, dz), 1e-9)
        return (self.x + dx * scale, place[1], self.z + dz * scale)

    def meets(self, origin, heading, reach, margin):
        """Return how far along a unit heading the pillar, grown by margin, is met; none if not."""
        dx, dz = self.x - origin[0], self.z - origin[2]
        level = math.hypot(heading[0], heading[2])
        if level < 1e-6:
            return None
        hx, hz = heading[0] / level, heading[2] / level
        along, across = dx * hx + dz * hz, dx * hz - dz * hx
        radius = self.radius + margin
        if abs(across) >= radius or along < 0:
            return None
        begin = (along - math.sqrt(radius * radius - across * across)) / level
        return max(begin, 0.0) if begin <= reach else None


@dataclass
class Fish:
    """A fish: a mind, and the point with a heading that obeys it."""

    id: int
    species: str
    mind: object
    place: tuple
    yaw: float = 0.0
    pitch: float = 0.0
    size: float = 0.1
    speed: float = 0.1
    fed: int = 0
    eaten: int = 0
    maneuvers: bool = False
    """Whether a turn, once begun, is carried through before the next, as muscles do it."""
    left: float = 0.0
    """Rest of that turn."""
    turning: float = TURN_RATE
    """Fastest turn, radians per second."""
    wanted: dict = field(default_factory=dict)
    display: dict = field(default_factory=dict)

    @property
    def heading(self):
        level = math.cos(self.pitch)
        return (math.sin(self.yaw) * level, math.sin(self.pitch), math.cos(self.yaw) * level)

    @property
    def axes(self):
        """Left, up, ahead in the tank."""
        ahead = self.heading
        left = (math.cos(self.yaw), 0.0, -math.sin(self.yaw))
        up = (
            ahead[1] * left[2] - ahead[2] * left[1],
            ahead[2] * left[0] - ahead[0] * left[2],
            ahead[0] * left[1] - ahead[1] * left[0],
        )
        return left, up, ahead

    @property
    def velocity(self):
        return tuple(one * self.speed for one in self.heading)

    @property
    def attitude(self):
        cy, sy = math.cos(self.yaw / 2), math.sin(self.yaw / 2)
        cx, sx = math.cos(-self.pitch / 2), math.sin(-self.pitch / 2)
        return (cy * sx, sy * cx, -sy * sx, cy * cx)

    @property
    def mouth(self):
        return add(self.place, self.heading, 0.48 * self.size)

    @property
    def behavior(self):
        return self.wanted.get("behavior", "")

    def own(self, vector):
        left, up, ahead = self.axes
        return (dot(vector, left), dot(vector, up), dot(vector, ahead))

    def obey(self):
        """Move by one tick as the last decision wants."""
        wanted = self.wanted
        step = self.turning * DT
        if not self.maneuvers or abs(self.left) < 1e-6:
            self.left = wanted["turn"]
        turn = max(-step, min(step, self.left))
        self.yaw += turn
        self.left -= turn
        level = 0.0 if abs(wanted["pitch"]) < 1e-3 else wanted["pitch"]
        aim = max(-1.2, min(1.2, self.pitch + level)) if level else self.pitch * 0.9
        self.pitch += max(-step, min(step, aim - self.pitch))
        goal = wanted["speed"] * self.size * (1.0 - wanted["brake"] * (wanted["speed"] > 0))
        self.speed += (goal - self.speed) * (0.35 if wanted["brake"] > 0 else 0.15)
        self.place = add(self.place, self.heading, self.speed * DT)


class Arena:
    """Fishes, food and pillars."""

    def __init__(self, fishes, *, food=None, pillars=(), surface=3.0, light=None, seed=0):
        self.fishes = list(fishes)
        self.food = dict(food or {})
        self.pillars = list(pillars)
        self.surface, self.seed, self.tick = surface, seed, 0
        self.light = light or (lambda place: 0.5)
        self.events = []

    @property
    def time(self):
        return self.tick * DT

    def percepts(self, fish):
        """Return what a fish notices."""
        eye = add(fish.place, fish.heading, 0.44 * fish.size)
        seen = []
        for other in self.fishes:
            offset = add(other.place, eye, -1.0)
            far = math.hypot(*offset)
            visible = (
                other is not fish
                and far <= SIGHT * other.size
                and dot(offset, fish.heading) >= math.cos(math.radians(150)) * far
            )
            if visible and not self.hidden(eye, other.place):
                seen.append((far, other))
        seen.sort(key=lambda one: (one[0], one[1].id))
        food = [
            (distance(place, fish.place), number, place)
            for number, place in self.food.items()
            if distance(place, fish.place) <= SMELL * fish.size
        ]
        solids = sorted(pillar.nearest(eye) for pillar in self.pillars if pillar.gap(eye) < 0.5)
        return {
            "id": fish.id,
            "time": self.time,
            "dt": DT,
            "velocity": (0.0, 0.0, fish.speed),
            "attitude": fish.attitude,
            "body_length": fish.size,
            "depth": self.surface - fish.place[1],
            "home": fish.own(add((0.0, 0.0, 0.0), fish.place, -1.0)),
            "seen": [self.sighting(fish, other) for _, other in seen[:24]],
            "smelled": [
                {
                    "id": number,
                    "species": "plankton",
                    "position": fish.own(add(place, fish.place, -1.0)),
                    "size": 0.01,
                }
                for _, number, place in sorted(food)[:8]
            ],
            "fed": fish.fed,
            "ahead": self.ahead(fish),
            "solids": [fish.own(add(one, fish.place, -1.0)) for one in solids],
            "light": self.light(fish.place),
            "temperature": 24.0,
        }

    def sighting(self, fish, other):
        return {
            "id": other.id,
            "species": other.species,
            "position": fish.own(add(other.place, fish.place, -1.0)),
            "velocity": fish.own(other.velocity),
            "heading": fish.own(other.heading),
            "size": other.size,
            "display": other.display,
        }

    def hidden(self, eye, place):
        way = add(place, eye, -1.0)
        far = math.hypot(*way)
        if far < 1e-6:
            return False
        heading = tuple(one / far for one in way)
        return any(pillar.meets(eye, heading, far, 0.0) is not None for pillar in self.pillars)

    def ahead(self, fish):
        """Return the nearest pillar ahead with a point beside it."""
        margin, found = 0.35 * fish.size, None
        for pillar in self.pillars:
            reach = FEELER * fish.size
            met = pillar.meets(fish.place, fish.heading, reach, margin)
            if met is not None and (found is None or met < found[0]):
                found = (met, pillar)
        if found is None:
            return None
        met, pillar = found
        own = fish.own(add((pillar.x, fish.place[1], pillar.z), fish.place, -1.0))
        side = -1.0 if own[0] >= 0 else 1.0
        aim = (own[0] + side * (pillar.radius + fish.size), 0.0, own[2])
        return {"distance": met, "aim": aim}

    def step(self):
        """Let all decide on what was, then all move."""
        self.tick += 1
        noticed = [self.percepts(fish) for fish in self.fishes]
        for fish, percepts in zip(self.fishes, noticed, strict=True):
            fish.fed = 0
            fish.wanted = fish.mind.decide(percepts, seed=self.seed)
            shown = fish.wanted["display"]
            fish.display = {name: one for name, one in shown.items() if one is not None}
        for fish in self.fishes:
            fish.obey()
            self.feed(fish)

    def feed(self, fish):
        """Suck in what the open mouth is after."""
        target = fish.wanted["target"]
        if fish.wanted["mouth"] < 0.5 or target is None:
            return
        place = self.food.get(target)
        if place is not None and distance(place, fish.mouth) < 0.2 * fish.size:
            del self.food[target]
            self.swallowed(fish, target)
        for prey in self.fishes:
            near = prey.id == target and distance(prey.place, fish.mouth) < 0.25 * fish.size
            if near and prey.size < 0.7 * fish.size:
                self.fishes.remove(prey)
                self.swallowed(fish, target)
                return

    def swallowed(self, fish, target):
        fish.fed += 1
        fish.eaten += 1
        self.events.append((self.time, "eaten", fish.id, target))

    def run(self, seconds, until=None):
        """Run for a time, or until something is so; returns whether it became so."""
        for _ in range(round(seconds / DT)):
            self.step()
            if until is not None and until():
                return True
        return until is None


def spread(count, seed, radius, height=0.3):
    """Return places spread in a disk, always the same for a seed."""
    golden = math.pi * (3 - math.sqrt(5))
    return [
        (
            radius * math.sqrt((index + 0.5) / count) * math.cos(golden * index + seed),
            height * math.sin(2.4 * index + seed),
            radius * math.sqrt((index + 0.5) / count) * math.sin(golden * index + seed),
        )
        for index in range(count)
    ]
