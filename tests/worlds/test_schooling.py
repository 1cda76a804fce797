"""The world `schooling`: a school follows its leader, parts at a pillar and closes again."""

import numpy as np
import pytest

import bioscope as bio

PILLAR, RADIUS = np.array([0.0, 0.0]), 0.24


def batch(world, species):
    return next(one for one in world.scene.batches if one.species == species)


def components(places, link):
    """Return the groups whose members are linked by less than a distance, the smallest first."""
    left, groups = set(range(len(places))), []
    while left:
        group = edge = [left.pop()]
        while edge:
            one = edge[0]
            near = {other for other in left if np.linalg.norm(places[one] - places[other]) < link}
            left -= near
            edge = edge[1:] + sorted(near)
            group = group + sorted(near)
        groups.append(group)
    return sorted(groups, key=len)


class Course:
    """Places and velocities of school and leader, four times a second."""

    def __init__(self, seed, seconds):
        world = bio.load("schooling", seed=seed)
        self.length = world.inspect(int(batch(world, "yellow_tang").ids[0]))["values"][
            "body_length_m"
        ]
        self.times, self.places, self.speeds, self.leader, self.groups = [], [], [], [], []
        while world.time < seconds:
            world.run(0.25)
            school = batch(world, "yellow_tang")
            self.times.append(world.time)
            self.places.append(np.array(school.positions))
            self.speeds.append(np.linalg.norm(school.velocities, axis=1))
            self.leader.append(np.array(batch(world, "blue_tang").positions[0]))
            self.groups.append(components(self.places[-1], 2 * self.length))

    def nearest(self, index):
        places = self.places[index]
        gaps = np.linalg.norm(places[:, None] - places[None], axis=2)
        np.fill_diagonal(gaps, np.inf)
        return gaps.min(axis=1) / self.length


SETTLED = 8.0
"""Seconds after which those who began at rest, heading anywhere, are a school."""


@pytest.fixture(scope="module")
def course():
    return Course(bio.worlds.films()["schooling"], 36)


@pytest.mark.capability("TF-203", "TF-127", "TF-128")
def test_the_school_parts_at_the_pillar_and_closes_again(course):
    late = [index for index, time in enumerate(course.times) if time > SETTLED]
    at_pillar = [
        index
        for index in late
        if np.linalg.norm(course.places[index].mean(axis=0)[[0, 2]] - PILLAR) < 1.2
    ]
    first = next(
        index
        for index in at_pillar
        if len(course.groups[index]) >= 2 and len(course.groups[index][0]) >= 2
    )
    before = [index for index in late if index < first]
    assert len(before) > 20
    assert all(course.nearest(index).max() < 3 for index in before)
    # One again, and for a second at least.
    closed = next(
        index
        for index in range(first + 1, len(course.times))
        if all(len(groups) == 1 for groups in course.groups[index : index + 4])
    )
    assert course.times[closed] - course.times[first] <= 10
    hurry = []
    for index in range(first, closed):
        apart = sorted(one for group in course.groups[index][:-1] for one in group)
        if apart:
            hurry.append(course.speeds[index][apart].mean() / course.speeds[index].mean())
    assert np.mean(hurry) > 1, "those behind catch up"


@pytest.mark.capability("TF-117", "TF-167")
def test_nobody_enters_the_pillar(course):
    for places in course.places:
        away = np.linalg.norm(places[:, [0, 2]] - PILLAR, axis=1)
        assert (away > RADIUS).all()


@pytest.mark.capability("TF-128", "TF-211")
def test_the_school_goes_where_its_leader_leads(course):
    late = [index for index, time in enumerate(course.times) if time > SETTLED]
    gaps = [
        np.linalg.norm(course.places[index].mean(axis=0) - course.leader[index]) for index in late
    ]
    assert np.mean(gaps) < 8 * course.length
    ways = course.places[late[-1]].mean(axis=0) - course.places[0].mean(axis=0)
    assert ways[0] < -4, "from one side of the pillar to the other, metres"
