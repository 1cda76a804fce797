"""Strings that grow on: in words of their own, in environments that stay, at any time."""

import re
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError, InvalidValueError, UnknownNameError

FLAGELLUM = """lsystem: flagellum
axiom: FFFF[+FF]FFA
A --> F[+F]A
{rule}
endlsystem
"""


def strokes(drawn: bio.lsystem.Interpretation) -> np.ndarray:
    """Return the strokes (n, 6), sorted."""
    rows = np.hstack([drawn.segments.start, drawn.segments.end]).round(4) + 0.0
    return rows[np.lexsort(rows.T)]


@pytest.mark.capability("PL-118", "PL-614", "PL-615")
def test_words_that_break_apart_grow_alone():
    # An internode of the trunk dies: F --> f, by a mark that the axiom sets.
    whole = FLAGELLUM.format(rule="D --> f").replace("FFFF[", "FFDF[")
    system = bio.LSystem(whole, "broken.l")
    # In one string: the dead internode stays as a gap.
    expected = strokes(bio.Turtle(angle=30).interpret(system.derive(5)))
    # In two: they part after the first step, and each derives without the other.
    words = system.derive(1).fragments("f", angle=30)
    assert [one.word.string() for one in words] == ["FF", "F[+FF]FFF[+F]A"]
    assert words[1].position == pytest.approx((0, 3, 0))
    drawn = [
        strokes(bio.Turtle(angle=30, **one.stance).interpret(system.derive(4, start=one.word)))
        for one in words
    ]
    union = np.vstack(drawn)
    assert len(drawn[0]) == 2
    assert np.allclose(union[np.lexsort(union.T)], expected, atol=1e-5)


def without_cuts(word: str) -> str:
    """Return the word without each `%` and the well-bracketed factor that follows in its branch."""
    kept, depth, cut = "", 0, None
    for symbol in word:
        depth += (symbol == "[") - (symbol == "]")
        if cut is not None and depth < cut:
            cut = None
        if symbol == "%" and cut is None:
            cut = depth
        if cut is None:
            kept += symbol
    return kept


def random_word(random: np.random.Generator, depth: int = 0) -> str:
    parts = []
    for _ in range(random.integers(1, 6)):
        inner = depth < 4 and random.random() < 0.3
        parts.append(
            f"[{random_word(random, depth + 1)}]" if inner else random.choice(list("ABF%"))
        )
    return "".join(parts)


@pytest.mark.capability("PL-612")
@pytest.mark.parametrize("seed", range(20))
def test_a_step_rewrites_what_the_cuts_leave(seed: int):
    rules = "A --> B%[A]F\nB --> A[%B]\n"
    word = random_word(np.random.default_rng(seed))
    images = {"A": "B%[A]F", "B": "A[%B]"}
    for _ in range(4):
        derived = bio.LSystem(f"axiom: {word or '*'}\n{rules}", "cut.lsys").derive(1).string()
        assert derived == "".join(images.get(symbol, symbol) for symbol in without_cuts(word))
        word = derived


def test_what_follows_a_broken_branch_stays_below():
    text = "lsystem: x\naxiom: A[BDC[E]]G[DD]\nA --> A\nendlsystem\n"
    words = bio.LSystem(text).derive(0).fragments("D")
    assert [one.word.string() for one in words] == ["A[B]G[]", "C[E]"]


def test_only_a_string_of_the_same_model_can_be_grown_on():
    text = "lsystem: x\naxiom: A\nA --> AB\nendlsystem\n"
    system, other = bio.LSystem(text), bio.LSystem(text.replace("B", "C"))
    assert system.derive(2, start=system.derive(1)).string() == system.derive(3).string()
    with pytest.raises(FormatError, match="another model"):
        system.derive(1, start=other.derive(1))


ASKING = "Lsystem: x\naxiom: A?E(0.5)\nA --> F(1)A\nendlsystem\n"


def test_an_environment_of_ones_own_is_given_as_an_object():
    class Litter(bio.environments.Environment):
        """Nutrients: apices take them from the soil, and what they took falls back as litter."""

        def __init__(self) -> None:
            self.soil, self.litter, self.total = 4.0, 0.0, []

        def exchange(self, step, messages):
            taken = min(self.soil, len(messages["positions"]))
            self.soil += 0.5 * self.litter - taken
            self.litter += taken - 0.5 * self.litter
            self.total.append(self.soil + self.litter)
            return np.full((len(messages["positions"]), 1), taken)

    litter = Litter()
    string = bio.LSystem(ASKING).derive(6, environment=litter)
    assert len(litter.total) == 7
    assert np.allclose(litter.total, 4.0), "nothing is lost in the cycle"
    assert float(string.parameters[-1]) == pytest.approx(1.0)


def test_environments_and_views_are_objects_names_or_files(tmp_path: Path):
    system = bio.LSystem(ASKING)
    sky = bio.environments.SkyLight()
    named = system.derive(2, environment="sky_light").string()
    assert system.derive(2, environment=sky).string() == named == "F(1)F(1)A?E(1)"
    (tmp_path / "x.v").write_text("angle factor: 4\n")
    turned = "Lsystem: x\naxiom: +?H(0,0)\nA --> A\nendlsystem\n"
    model, path = bio.LSystem(turned), tmp_path / "x.v"
    by_path = model.derive(0, view=path).string()
    assert model.derive(0, view=bio.ViewFile(path)).string() == by_path
    with pytest.raises(UnknownNameError, match="time"):
        model.derive(0, tima=1)


VINE = """timed: 0.5
modules: p(x), q(x)
growth: p = 6*x*age
growth: q = 6*x+age
axiom: p(1)
p1: p(x) after 1 --> q(x)[+(90)p(x/2)][-(90)p(x/2)]
"""


@pytest.mark.capability("NA-026", "NA-027")
def test_a_timed_model_is_derived_to_any_time():
    system = bio.LSystem(VINE, "vine.lsys")
    for time in np.linspace(0.05, 3.95, 14):
        string = system.derive(time=float(time))
        text, live = string.string(), int(time + 1e-9)
        assert text.count("p(") == 2**live, time
        ages = [float(one) for one in re.findall(r"p\(([-\d.e]+),", text)]
        assert np.allclose(ages, time - live, atol=1e-5)
    # Identities last for life, and none is used twice.
    early, late = system.derive(time=1.2), system.derive(time=1.7)
    assert early.ids.tolist() == late.ids.tolist()
    for time in (0.5, 1.5, 2.5, 3.5):
        ids = system.derive(time=time).ids
        assert len(set(ids.tolist())) == len(ids)
    with pytest.raises(InvalidValueError, match="timed"):
        bio.LSystem(ASKING).derive(time=1.0)
    with pytest.raises(InvalidValueError, match="steps"):
        system.derive(time=1e300)


def test_equal_branches_are_drawn_once():
    text = """lsystem: x
axiom: F(1,1)
F(s,t) : t == 1 --> F(s,2)[-F(s,1)][+F(s,1)]F(s,2)F(s,1)
F(s,t) : t == 2 --> F(2*s,2)
endlsystem
"""
    string = bio.LSystem(text).derive(7)
    turtle = bio.Turtle(angle=45)
    whole, plant = turtle.interpret(string).segments, turtle.share(string)
    placed = [plant.rest.segments.end]
    for part in plant.parts:
        axis, w = part.rotations[:, None, :3], part.rotations[:, None, 3:]
        ends = part.drawn.segments.end[None]
        turned = ends + 2 * np.cross(axis, np.cross(axis, ends) + w * ends)
        placed.append((turned + part.positions[:, None]).reshape(-1, 3))
    placed = np.vstack(placed)
    stored = len(plant.rest.segments.end)
    stored += sum(len(part.drawn.segments.end) for part in plant.parts)
    assert len(placed) == len(whole.end)
    assert stored < len(whole.end) / 2
    assert np.allclose(placed.mean(axis=0), whole.end.mean(axis=0), atol=1e-3)
    assert np.allclose(np.sort(placed[:, 1]), np.sort(whole.end[:, 1]), atol=1e-2)


def test_an_animate_file_says_which_steps_are_shown(tmp_path: Path):
    file = tmp_path / "plant.a"
    file.write_text("swap interval: 3\nfirst frame: 2\nlast frame: 8\nstep: 3\nwobble: on\n")
    animation = bio.lsystem.AnimateFile(file)
    assert animation.frames(99) == [2, 5, 8]
    assert animation.swap_interval == 3
    assert animation.switches == ["double buffer", "clear between frames"]
    assert animation.warnings[0].startswith(f"{file}:5:1: unknown animate")
    file.write_text("frame intervals: 1-3, 10-20 step 5\n")
    assert bio.lsystem.AnimateFile(file).frames(0) == [1, 2, 3, 10, 15, 20]


def test_seed_lines_that_undo_the_order_of_productions_are_doubtful():
    text = "seed: 1\naxiom: AB\nA < B --> C\nB --> D\nA --> A\n"
    (warning,) = bio.LSystem(text, "seed.l").warnings
    assert warning.startswith("seed.l:4:1: 'seed:' lets chance decide")
    assert bio.LSystem(text.replace("D", "D : 1"), "seed.l").warnings == []
    assert bio.LSystem(text.replace("seed: 1\n", ""), "seed.l").warnings == []


@pytest.mark.capability("PL-402", "PL-406")
def test_environments_are_sent_what_they_ask_for():
    class Listener(bio.environments.Environment):
        def exchange(self, step, messages):
            self.heard = messages

    text = "lsystem: x\naxiom: F(1)[?E(1,2)B(7,8)]?E(3)[+F(1)?E(4)]\nC --> C\nendlsystem\n"
    everything, few = Listener(), Listener()
    few.fields = ("positions", "following")
    bio.LSystem(text).derive(0, environment=everything)
    bio.LSystem(text).derive(0, environment=few)
    assert len(everything.heard) == 8
    assert everything.heard["parameters"].shape == (3, 2)
    # What follows in the branch: a module with its numbers, a branch, nothing.
    assert everything.heard["following"] == [("B", [7, 8]), ("[", []), None]
    assert set(few.heard) == {"positions", "following"}
    assert few.heard["positions"].nbytes == 3 * 3 * 4
    few.fields = ("colour",)
    with pytest.raises(FormatError, match="unknown field of a message 'colour'"):
        bio.LSystem(text).derive(0, environment=few)
