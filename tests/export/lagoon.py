"""A small world with one population of each kind that a file can hold."""

import numpy as np

import bioscope as bio


def box() -> bio.Mesh:
    """A box of 2 × 2 × 2 m with a texture coordinate at each corner."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    triangles = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
        [1, 5, 7],
        [1, 7, 3],
    ]
    uvs = (corners[:, :2] + 1) / 2
    return bio.Mesh(corners, np.array(triangles, np.uint32), uvs=uvs)


def picture(cutout: bool = False) -> np.ndarray:
    pixels = np.zeros((4, 8, 4), np.uint8)
    pixels[:, :4] = (200, 40, 30, 255)
    pixels[:, 4:] = (30, 60, 200, 0 if cutout else 255)
    return pixels


class Stones(bio.Population):
    """Rigid things that stay, in three tints."""

    transient = ("mesh", "material")
    count = 5

    def settle(self):
        return self.count

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        if not hasattr(self, "mesh"):
            self.mesh, self.material = box(), bio.Material("stone", texture=picture())
        across = np.arange(self.count, dtype=np.float32)
        places = np.stack([across * 3, across * 0, across * 0 - 5], axis=1)
        tints = np.array([[1, 1, 1], [0.5, 1, 1], [1, 0.5, 1], [1, 1, 1], [1, 1, 1]], np.float32)
        scene.instances(
            "stones",
            self.mesh,
            self.material,
            ids=self.ids,
            positions=places,
            scales=np.full(self.count, 0.5, np.float32),
            tints=tints,
            alive=False,
        )


class Gliders(bio.Population):
    """Rigid things that move; one dies at 0.3 s, one is born at 0.5 s."""

    transient = ("mesh", "material")

    def settle(self):
        self.time = 0.0
        return 3

    def born(self, ids):
        if not hasattr(self, "ids"):
            self.ids, self.places = ids, np.zeros((3, 3), np.float32)
            self.places[:, 0] = [0, 1, 2]
        else:
            self.ids = np.append(self.ids, ids)
            self.places = np.append(self.places, [[9, 0, 0]], axis=0).astype(np.float32)

    def move(self, dt):
        self.time += dt
        self.places[:, 1] += 2.0 * dt

    def grow(self):
        if len(self.ids) == 3 and 0.3 <= self.time < 0.4:
            self.ids, self.places = self.ids[1:], self.places[1:]
        return 1 if len(self.ids) == 2 and self.time >= 0.5 else 0

    def publish(self, scene):
        if not hasattr(self, "mesh"):
            self.mesh = box()
            self.material = bio.Material("foil", specular=0.5, texture=picture(True), cutout=True)
        velocities = np.zeros_like(self.places)
        velocities[:, 1] = 2.0
        scene.instances(
            "gliders",
            self.mesh,
            self.material,
            ids=self.ids,
            positions=self.places,
            velocities=velocities,
        )


def reed() -> bio.Mesh:
    """A strip of 2 m with two joints, the upper one halfway."""
    heights = np.repeat(np.linspace(0, 2, 5), 2)
    across = np.tile([-0.1, 0.1], 5)
    positions = np.stack([across, heights, heights * 0], axis=1).astype(np.float32)
    rows = [[2 * i, 2 * i + 1, 2 * i + 3] for i in range(4)]
    rows += [[2 * i, 2 * i + 3, 2 * i + 2] for i in range(4)]
    upper = np.clip(heights - 0.5, 0, 1).astype(np.float32)
    weights = np.stack([1 - upper, upper, upper * 0, upper * 0], axis=1)
    rest = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    above = (0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    return bio.Mesh(
        positions,
        np.array(rows, np.uint32),
        joints=[("root", None, rest), ("tip", 0, above)],
        joint_indices=np.tile(np.array([0, 1, 0, 0], np.uint8), (10, 1)),
        joint_weights=weights,
    )


class Reeds(bio.Population):
    """Jointed things: the tip nods about z, each reed in its own phase."""

    transient = ("mesh", "material")
    count = 4

    def settle(self):
        self.time = 0.0
        return self.count

    def born(self, ids):
        self.ids = ids

    def move(self, dt):
        self.time += dt

    def publish(self, scene):
        if not hasattr(self, "mesh"):
            self.mesh, self.material = reed(), bio.Material("reed", two_sided=True)
        across = np.arange(self.count, dtype=np.float32)
        angle = 0.5 * np.sin(self.time * 4 + across)
        poses = np.zeros((self.count, 2, 7), np.float32)
        poses[:, :, 6] = 1
        poses[:, 1, 1] = 1
        poses[:, 1, 5], poses[:, 1, 6] = np.sin(angle / 2), np.cos(angle / 2)
        tints = np.array([[1, 1, 1], [0.5, 1, 0.5], [1, 1, 1], [0.5, 1, 0.5]], np.float32)
        places = np.stack([across, across * 0, across * 0 + 2], axis=1)
        scene.instances(
            "reeds",
            self.mesh,
            self.material,
            ids=self.ids,
            positions=places,
            poses=poses,
            tints=tints,
        )


class Blob(bio.Population):
    """A body whose mesh deforms: the box breathes in height; vertex colors."""

    def settle(self):
        self.time = 0.0
        return 1

    def born(self, ids):
        self.ids = ids

    def move(self, dt):
        self.time += dt

    def publish(self, scene):
        form = box()
        positions = form.positions * np.array([1, 1 + 0.5 * self.time, 1], np.float32)
        colors = (form.positions + 1) / 2
        mesh = bio.Mesh(positions.astype(np.float32), form.triangles, colors=colors)
        place = np.array([[0, 0, 6]], np.float32)
        scene.instances("blob/1", mesh, bio.Material("jelly"), ids=self.ids, positions=place)


class Motes(bio.Population):
    """Points that rise; a new one each 0.2 s, none lives longer than 0.5 s."""

    def settle(self):
        self.time, self.due = 0.0, 0.2
        return 2

    def born(self, ids):
        places = np.zeros((len(ids), 3), np.float32)
        places[:, 0] = ids % 7
        if not hasattr(self, "ids"):
            self.ids, self.places, self.ages = ids, places, np.zeros(len(ids))
        else:
            self.ids = np.append(self.ids, ids)
            self.places = np.append(self.places, places, axis=0)
            self.ages = np.append(self.ages, np.zeros(len(ids)))

    def move(self, dt):
        self.time += dt
        self.ages = self.ages + dt
        self.places[:, 1] += dt

    def grow(self):
        old = self.ages > 0.5
        self.ids, self.places, self.ages = self.ids[~old], self.places[~old], self.ages[~old]
        if self.time >= self.due:
            self.due += 0.2
            return 1
        return 0

    def publish(self, scene):
        radii = np.full(len(self.ids), 0.05, np.float32)
        scene.points(
            "motes",
            ids=self.ids,
            positions=self.places,
            radii=radii,
            color=[0.9, 0.9, 1.0],
            opacity=0.5,
            glassy=True,
        )


def make(*kinds: type, seed: int = 3) -> bio.World:
    world = bio.World(seed=seed, dt=1 / 48)
    world.environment.water(surface=5.0)
    for kind in kinds or (Stones, Gliders, Reeds, Blob, Motes):
        world.add(kind())
    world.cameras.fixed("wide", position=(0, 2, 12), target=(0, 1, 0))
    world.cameras.orbit("round", target=(0, 1, 0), radius=9, period=20)
    return world
