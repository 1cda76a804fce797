"""Growing plants whose surroundings are written in Python, or are a program of their own."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio

STEM = """lsystem: stem
derivation length: 40
consider: ?E
axiom: A?E(0)
p1: A > ?E(room) : room > 0 --> !(0.05)F(0.1)A
p2: ?E(room) --> *
p3: A --> A?E(0)
endlsystem
"""
PROGRAM = """
import struct, sys
steps = 0
while head := sys.stdin.buffer.read(8):
    count, stride = struct.unpack("<2I", head)
    size, form = 4 + 4 * stride, f"<I{stride}f"
    rows = [struct.unpack(form, sys.stdin.buffer.read(size)) for _ in range(count)]
    sys.stdin.buffer.read(4)
    steps += 1
    if steps > LIMIT:
        ENDING
    # Address, number of parameters, parameter, then x, y, z.
    answers = b"".join(struct.pack("<If", row[0], float(row[4] < CEILING)) for row in rows)
    sys.stdout.buffer.write(struct.pack("<2I", count, 1) + answers + struct.pack("<I", 2**32 - 1))
    sys.stdout.buffer.flush()
"""


class Ceiling(bio.environments.Environment):
    """Lets plants grow up to a height; counts what it was asked."""

    def __init__(self, height: float) -> None:
        self.height = height
        self.heard = 0

    def exchange(self, step, messages):
        self.heard += len(messages["positions"])
        return (messages["positions"][:, 1:2] < self.height).astype(np.float32)


class Failing(Ceiling):
    def exchange(self, step, messages):
        if step == 6:
            raise ValueError("it hails")
        return super().exchange(step, messages)


def world_in(environment: bio.environments.Environment) -> tuple[bio.World, bio.Plants]:
    world = bio.World(seed=4, dt=1 / 30)
    area = bio.Habitat(area=[(0.0, 0.0), (2.0, 0.0)])
    plants = bio.Plants(STEM, 2, habitat=area, rate=10.0, environment=environment)
    return world, world.add(plants, "stems")


def program(folder: Path, ceiling: float, limit: int = 10**6, ending: str = "break") -> list[str]:
    text = PROGRAM.replace("CEILING", str(ceiling)).replace("LIMIT", str(limit))
    file = folder / "ceiling.py"
    file.write_text(text.replace("ENDING", ending))
    return [sys.executable, str(file)]


@pytest.mark.capability("PL-401", "PL-404", "PL-454")
def test_own_environments_of_both_kinds_guide_a_stand_alike(tmp_path):
    in_python, stems = world_in(Ceiling(0.55))
    outside = bio.environments.Pipe(program(tmp_path, 0.55))
    by_pipe, piped = world_in(outside)
    for world in (in_python, by_pipe):
        world.run(seconds=3.0)
    np.testing.assert_allclose(stems.values("height_m"), 0.6, atol=0.03)
    assert list(stems.values("string")) == list(piped.values("string"))


def test_an_environment_in_python_is_saved_with_its_world(tmp_path):
    world, _ = world_in(Ceiling(0.95))
    world.run(seconds=0.5)
    world.save(tmp_path / "stems.world")
    again = bio.World.restore(tmp_path / "stems.world")
    assert again.state_hash() == world.state_hash()
    for one in (world, again):
        one.run(seconds=2.0)
    assert again.state_hash() == world.state_hash()
    assert again.statistics()["stems.tallest_m"] == pytest.approx(1.0, abs=0.03)


def test_a_failing_environment_stops_the_step_and_the_world_survives():
    world, _ = world_in(Failing(5.0))
    with pytest.raises(bio.BioscopeError, match="Failing is gone: ValueError: it hails"):
        world.run(seconds=2.0)
    tick, state = world.tick, world.state_hash()
    assert 15 <= tick < 18
    with pytest.raises(bio.BioscopeError, match="hails"):
        world.run(seconds=2.0)
    assert (world.tick, world.state_hash()) == (tick, state)
    world.set("stems", "rate", 0.0)
    world.run(seconds=1.0)
    assert world.tick == tick + 30


@pytest.mark.parametrize(
    ("ending", "told"),
    [
        ("sys.exit(3)", "has ended|has closed its standard output"),
        ("sys.stdout.buffer.write(b'what?' * 99); sys.stdout.buffer.flush()", "answered nonsense"),
        ("import time; time.sleep(60)", "has not answered for 1 s"),
    ],
)
def test_a_process_that_dies_babbles_or_hangs_is_told_and_the_world_survives(
    tmp_path, ending, told
):
    command = program(tmp_path, 5.0, limit=4, ending=ending)
    world, stems = world_in(bio.environments.Pipe(command, seconds=1.0))
    with pytest.raises(bio.BioscopeError, match=told):
        world.run(seconds=2.0)
    tick = world.tick
    assert tick > 5
    heights = stems.values("height_m")
    assert (np.asarray(heights) > 0).all()
    world.set("stems", "rate", 0.0)
    world.run(seconds=1.0)
    assert world.tick == tick + 30


def test_a_saved_world_starts_no_program(tmp_path):
    world, _ = world_in(bio.environments.Pipe(program(tmp_path, 5.0)))
    world.run(seconds=0.5)
    world.save(tmp_path / "stems.world")
    again = bio.World.restore(tmp_path / "stems.world")
    with pytest.raises(bio.BioscopeError, match="does not come back with a saved world"):
        again.run(seconds=0.5)
    again.set("stems", "rate", 0.0)
    again.run(seconds=0.5)


def test_plants_shade_those_that_ask_in_other_steps():
    # Each asks for light every fourth step, after a delay of its own.
    text = """lsystem: turns
derivation length: 40
consider: ?E
#define DELAY 0
axiom: F(HEIGHT)W(DELAY)
W(n) : n > 0 --> W(n-1)
W(n) : n == 0 --> W(3)?E(0.5)
?E(r) --> S(r)
S(r) --> *
W(n) < ?E(r) --> S(r)
endlsystem
"""

    def light(delay: float) -> float:
        world = bio.World(seed=4, dt=1 / 30)
        sky = bio.environments.SkyLight(transmittance=0.25)
        numbers = {"DELAY": [0.0, delay], "HEIGHT": [0.1, 3.0]}
        area = bio.Habitat(area=[(0.0, 0.0), (0.0, 0.0)])
        text_own = text.replace("#define DELAY 0", "#define DELAY 0\n#define HEIGHT 1")
        plants = bio.Plants(
            text_own, 2, habitat=area, room=0.0, rate=10.0, environment=sky, numbers=numbers
        )
        stand = world.add(plants, "stems")
        found = []
        for _ in range(60):
            world.step()
            answer = re.search(r"S\(([^)]*)\)", stand.values("string")[0])
            found += [float(answer[1])] if answer else []
        return min(found)

    assert light(2) == pytest.approx(light(0), abs=1e-6)
    assert light(2) < 0.95
