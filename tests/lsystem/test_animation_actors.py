"""Actors whose behavior is rules alone: out of mazes, at random between walls, to what they see."""

import math
import random
import re

import numpy as np
import pytest
from mazes import Maze

from bioscope import gallery
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import Source

NONE = "() () () () () () ()"
ESCAPE = gallery.animations()["escape"]
START = "obs 3.5 0.3 3.5 lat 4.5 0.3 3.5"


def escape(maze: Maze, folder, start: tuple[float, float], angle: float) -> Animation:
    """Return the actor of the gallery in a maze, heading so many degrees left of x."""
    maze.write(folder / "escape.sm")
    text = ESCAPE.read_text(encoding="utf-8")
    assert START in text
    x, z = start
    to_x, to_z = x + math.cos(math.radians(angle)), z - math.sin(math.radians(angle))
    told = f"obs {x} 0.3 {z} lat {to_x:.9f} 0.3 {to_z:.9f}"
    return Animation(Source(text.replace(START, told), "escape.lm", folder))


@pytest.mark.capability("NA-037", "NA-051")
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("holes", [0, 6], ids=["simply", "multiply"])
def test_the_actor_escapes_from_every_maze(seed: int, holes: int, tmp_path):
    maze = Maze(5, seed, holes)
    assert (maze.islands() > 0) == (holes > 0)
    chance = random.Random(seed)
    start = chance.randrange(5) + 0.5, chance.randrange(5) + 0.5
    made = escape(maze, tmp_path, start, chance.randrange(360))
    for _ in range(5000):
        made.advance()
        x, _, z = made.actors[0].position
        assert maze.clearance(x, z) > 0.05
        if not (-0.5 < x < 5.5 and -0.5 < z < 5.5):
            break
    else:
        pytest.fail(f"still in the maze, at {x:.2f}, {z:.2f}")


@pytest.mark.capability("NA-037")
def test_an_actor_that_only_keeps_to_walls_does_not_escape(tmp_path):
    """The maze of the gallery is a trap: without the count of turns the actor goes round."""
    text = ESCAPE.read_text(encoding="utf-8")
    surface = ESCAPE.with_suffix(".sm").read_text(encoding="utf-8")
    (tmp_path / "escape.sm").write_text(surface)

    def outside_after(text: str, frames: int) -> int:
        made = Animation(Source(text, "escape.lm", tmp_path))
        for frame in range(frames):
            made.advance()
            x, _, z = made.actors[0].position
            if not (-0.5 < x < 7.5 and -0.5 < z < 7.5):
                return frame
        return frames

    needed = outside_after(text, 4000)
    assert needed < 4000
    # It never lets go of a wall: turns that cancel out mean nothing to it.
    keeps = text.replace("- () [(xt225*-1-)<] (M)", "- () [(1)<] (M)")
    keeps = keeps.replace("f (0.12) [(x1-)>] (M)", "f (0.12) [(x)!] (M)")
    assert outside_after(keeps, 2 * needed) == 2 * needed


@pytest.mark.capability("NA-037")
@pytest.mark.parametrize("seed", [1, 2])
def test_a_random_walk_turns_where_walls_are_felt(seed: int):
    made = Animation.read(gallery.animations()["wander"], seed=seed)
    places, headings, cries = [], [], []
    for frame in range(1500):
        made.advance()
        pose = made.states[1]
        places.append(pose.position)
        headings.append(pose.heading)
        cries += [frame for one in made.air.sounds if one.start == made.time and one.number == 12]
    felt = [max(abs(x), abs(z)) > 4 for x, _, z in places]
    met = [frame for frame in range(1, 1450) if felt[frame] and not felt[frame - 1]]
    assert len(met) >= 3
    for frame in met:
        # Within a fifth of a second it cries out, and backs off at once.
        cry = next(one for one in cries if one >= frame)
        assert cry - frame <= 6
        back = [a - b for a, b in zip(places[cry + 4], places[cry - 1], strict=True)]
        ahead = headings[cry - 1]
        assert sum(a * b for a, b in zip(back, ahead, strict=True)) == pytest.approx(-0.3, abs=0.01)
        # A second later it has turned round.
        after = headings[cry + 29]
        turned = math.degrees(math.acos(-sum(a * b for a, b in zip(ahead, after, strict=True))))
        assert turned <= 1
    assert max(max(abs(x), abs(z)) for x, _, z in places) < 4.5
    assert all(y == 0 for _, y, _ in places)
    # It gets about, and by chance.
    assert len({(round(x), round(z)) for x, _, z in places}) > 20


# Where the flowers of the gallery stand that the bee is to visit, in this order.
RED, YELLOW, VIOLET = (1.7, 4.7), (3.2, -3.8), (-4.9, -0.9)
OTHERS = [(-3.2, 3.8), (-1.7, -4.7), (4.9, 0.9)]


@pytest.mark.capability("NA-037", "NA-051")
def test_a_bee_goes_to_the_colors_it_has_in_mind():
    made = Animation.read(gallery.animations()["nectar"])
    bee = made.actors[0]
    visited, sips, way, last = [], False, 0.0, bee.position
    for _ in range(900):
        made.advance()
        way += math.dist(bee.position, last)
        last = bee.position
        x, y, z = last
        assert y == pytest.approx(1.5, abs=1e-6)
        assert min(math.dist((x, z), one) for one in OTHERS) > 1.5
        before, sips = sips, any(one.symbol == "h" for one in made.layers[0].string)
        if sips and not before:
            visited.append((x, z))
    assert len(visited) >= 4
    for place, flower in zip(visited, [RED, YELLOW, VIOLET, RED], strict=False):
        assert math.dist(place, flower) < 1.5
    direct = math.dist((0, 0), RED) + math.dist(RED, YELLOW)
    direct += math.dist(YELLOW, VIOLET) + math.dist(VIOLET, RED)
    assert way < 2 * direct


def test_the_same_is_seen_again():
    first, second = (Animation.read(gallery.animations()["nectar"]) for _ in range(2))
    for _ in range(60):
        first.advance()
        second.advance()
        assert first.string() == second.string()
        seen = [one.windows[0] for one in (first, second)]
        for part in ("color", "depth", "identity"):
            assert np.array_equal(*(getattr(one, part) for one in seen))


def test_animations_of_the_gallery_are_shown_by_name(bioscope, tmp_path):
    listed = bioscope("list").stdout
    for name in ("escape", "nectar", "wander"):
        assert re.search(rf"^{name} +Animation: \w.{{20,}}", listed, re.M)
        assert Animation.check(gallery.animations()[name]) == []
    done = bioscope("grow", "nectar", "-o", "bee.png", "--seconds", 0.2, "--size", "64x64")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "bee.png").stat().st_size > 500
    film = bioscope("grow", "wander", "-o", "walk.mp4", "--seconds", 0.2, "--size", "64x64")
    assert film.returncode == 0, film.stderr
    assert (tmp_path / "walk.mp4").stat().st_size > 500
    for name in ("nectar", gallery.animations()["nectar"]):
        ran = bioscope("run", name, "--seconds", 0.4, "--seed", 3, "--hash", "--save", "a.world")
        assert ran.returncode == 0, ran.stderr
    again = bioscope("run", "a.world", "--seconds", 0.4, "--hash")
    whole = bioscope("run", "nectar", "--seconds", 0.8, "--seed", 3, "--hash")
    assert again.stdout == whole.stdout != ran.stdout
    for wrong in (["-o", "bee.glb"], ["-o", "bee.png", "--steps", 3]):
        assert bioscope("grow", "nectar", *wrong).returncode != 0
