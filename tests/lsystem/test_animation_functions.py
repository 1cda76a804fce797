"""What the functions of definition files are worth while an animation runs."""

import math
from itertools import pairwise

import pytest

import bioscope as bio
from bioscope.errors import FormatError, UnknownNameError
from bioscope.lsystem import Animation

NONE = "() () () () () () ()"


def header(*options: str, constants: str = "", seconds: float = 0.04) -> str:
    return (
        f"Camera_AnimationParameters t_final_interval 60 {seconds}\nOptions\n"
        + "\n".join(options)
        + f"\nConstants\n{constants}\n"
    )


def animation(axiom: str, rules: str = "", head: str = "", **options: object) -> Animation:
    return Animation(f"{head}\nAxiom\n{axiom}\nProductions\n{rules}\nEndProductions\n", **options)


def value(expression: str, *options: str, frames: int = 0, **more: object) -> float:
    """Return what a growth expression is worth after some frames, for x, y, z = 3, 5, 7."""
    constants, seconds = str(more.pop("constants", "")), float(more.pop("seconds", 0.04))
    head = header(*options, constants=constants, seconds=seconds)
    made = animation(f"b () (3) (5) (7) ({expression}) () ()", head=head, **more)
    for _ in range(frames):
        made.advance()
    return made.layers[0].string[0].growth[0]


@pytest.mark.capability("NA-042", "NA-043")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1'2+", 3),
        ("2'3-", -1),
        ("2'3*", 6),
        ("3'4/", 0.75),
        ("3'0/", 0),
        ("2'10^", 1024),
        ("2_0.5^", 0),
        ("7_3%", 2),
        ("7'3_%", -2),
        ("2'3~", 0),
        ("3'3~", 1),
        ("3'2~", 1),
        ("1_2_~", 0),
        ("1'5<", 5),
        ("1'5<1>+", 10),
        ("1'5<2>+", 5),
        ("3_|", 3),
        ("3_", -3),
        ("30$", 0.5),
        ("60&", 0.5),
        ("0.5:", 30),
        ('0.5"', math.tanh(0.5)),
        ("3?08", 1),
        ("3_?08", 0),
        ("0.25?08", 0.25),
        ("0.5?29", 1.5625),
        ("0?44", 0),
    ],
)
def test_operators(expression: str, expected: float):
    assert value(expression, "fConst 5 2 0 10 0 0 0 0 0") == pytest.approx(expected, abs=1e-12)


@pytest.mark.capability("NA-042", "NA-064")
def test_data_channels_are_linear_between_their_values(tmp_path):
    (tmp_path / "loud.txt").write_text("0.5 4\n1 3 -2 10\n")
    (tmp_path / "pitch.txt").write_text("2 2\n0 100\n")
    text = header("NbrChannels_listOfNames 2 loud.txt pitch.txt", seconds=0.05)
    text += f"Axiom\nb () () () () (0'T?50) (1'T?50) ()\nu {NONE}\nProductions\nEndProductions\n"
    (tmp_path / "a.lm").write_text(text)
    made = Animation.read(tmp_path / "a.lm")
    for frame in range(40):
        low, share = divmod(min(made.time / 0.5, 3), 1)
        known = [1, 3, -2, 10, 10]
        expected = known[int(low)] * (1 - share) + known[int(low) + 1] * share
        growth = made.layers[0].string[0].growth
        assert growth[0] == pytest.approx(expected, abs=1e-12), frame
        assert growth[1] == pytest.approx(min(made.time, 2) * 50, abs=1e-12)
        made.advance()
    with pytest.raises(FormatError, match="up to 10 data channels"):
        Animation(
            header("NbrChannels_listOfNames 11 " + "a " * 11)
            + "Axiom\nProductions\nEndProductions\n"
        )


@pytest.mark.capability("NA-043", "NA-054")
def test_registers_belong_to_a_symbol_and_end_with_it():
    # b counts its frames in register 2; c learns the count and the growth values when it is made.
    rule = "b (0.1) [(2?44'3-)g] () ()\n1.0\nc () (2?44) (?41) (?42?43+) (2>) () ()\nEndProb\nEnd\n"
    made = animation("b () () () () (2'2>1+<) (4) (T)\nb () () () () () () ()", rule)
    for _ in range(3):
        assert [one.symbol for one in made.layers[0].string] == ["b", "b"]
        made.advance()
    counter, still = made.layers[0].string
    assert counter.symbol == "c"
    assert still.symbol == "b"
    # Three frames were drawn; growth values are those of the last.
    assert counter.parameters == pytest.approx((3, 3, 4 + 2 * 0.04))
    assert counter.growth[0] == 0


@pytest.mark.capability("NA-044")
def test_constants_are_functions_of_the_global_time():
    for name in "abcdefghijklmnopqrsABCDEFGHIJKLMNOPQRS":
        constants = f"{name} 1.5 -2 0.7" if name in "EFGHIJKLMNOPQRS" else f"{name} 1.5 -2"
        for frames in (0, 1, 25):
            time = frames * 0.04
            angle = math.radians(0.7 * time)
            expected = (
                1.5 - 2 * time + 0.7 * time * time
                if name in "EFG"
                else 1.5 - 2 * math.cos(angle)
                if name in "HIJ"
                else 1.5 - 2 * math.sin(angle)
                if name in "KLMNO"
                else 1.5 - 2 * math.exp(0.7 * time)
                if name in "PQRS"
                else 1.5 - 2 * time
            )
            found = value(name, constants=constants, frames=frames)
            assert found == pytest.approx(expected, abs=1e-12), (name, frames)


# A ball at x, y, z with velocity u, v, w, and a source of the field at X, Y, Z.
BALL = """f () () () (2) ({0}) ({1}) ({2})
e () (11) () () ({6}) ({7}) ({8})
C () () (2) () ({3}) ({4}) ({5})
"""


def force(expression: str, *options: str, at=(1.0, 2.0, 3.0), constants: str = "", **more):
    """Return the own force of a ball of 2 kg, as its change of velocity says, in frame 1."""
    told = [
        f"{abs(one)}{'_' if one < 0 else ''}" for one in (*at, *more.get("velocity", (0, 0, 0)))
    ]
    head = header(*options, constants=constants, seconds=1e-6)
    made = animation(BALL.format(*told, expression, "", ""), head=head)
    before = made.particles[0].velocity[0]
    made.advance()
    return (made.particles[0].velocity[0] - before) / 1e-6 * 2


@pytest.mark.capability("NA-048", "NA-047")
def test_forces_on_a_ball():
    rise = lambda s, grown, low, high: (  # noqa: E731
        low
        + (high - low) * (3 * min(1, max(0, s / grown)) ** 2 - 2 * min(1, max(0, s / grown)) ** 3)
    )
    assert force("?18") == pytest.approx(9.81 * 2, rel=1e-6)
    # Walls: pushed in by P2 below P0 and above P1.
    for at, expected in [((-1, 2, 3), 4), ((1, 2, 3), 0), ((6, 2, 3), -4)]:
        assert force("?12", at=at, constants="P 0 5 4") == pytest.approx(expected, abs=1e-6)
    assert force("?13", at=(1, 9, 1), constants="P 0 5 4") == pytest.approx(-4)
    assert force("?14", at=(1, 1, -9), constants="P 0 5 4") == pytest.approx(4)
    # The net pushes away from its plane at x = a, within its rectangle.
    net = "fConst 1 0.5 2 2 0.1 0.3 3 4 0"
    expected = (1 - 0.5 - 3 * 0.3) / (((1 - 0.5) / 2) ** 2 + 0.1)
    assert force("?19", net, velocity=(3, 0, 0)) == pytest.approx(expected, rel=1e-4)
    assert force("?19", net, at=(1, 5, 3)) == 0
    # Ground: a rise as the ball sinks below the growth distance.
    ground = "fConst 5 2 0 10 0.5 0 0 0 0"
    for y in (0.2, 1.0, 1.7, 3.0):
        found = force("?26", ground, at=(0, y, 0))
        assert found == pytest.approx(rise(2 + 0.5 - y, 2, 0, 10), abs=1e-5), y
        found = force("?27", ground.replace("fConst 5", "fConst 6"), at=(0, y, 0))
        assert found == pytest.approx(rise(0.5 - y, 2, 0, 10), abs=1e-5), y
    assert value("?28", "fConst 5 2 0 10 0 0 0 0 0", frames=25) == pytest.approx(5)


def pair(expression: str, *options: str, offset=(3.0, 4.0, 0.0)) -> tuple[float, float, float]:
    """Return the force that a source at the origin exerts on a ball of 1 kg at `offset`."""
    told = [f"{abs(one)}{'_' if one < 0 else ''}" for one in offset]
    axiom = (
        f"e () (10) () () {expression}\nC () (1) () () () () ()\n"
        "f () () () (2) ({}) ({}) ({})\nC () () (1) () () () ()\n".format(*told)
    )
    made = animation(axiom, head=header(*options, seconds=1e-6))
    made.advance()
    x, y, z = made.particles[1].velocity
    return x / 1e-6, y / 1e-6, z / 1e-6


@pytest.mark.capability("NA-048")
def test_forces_of_a_source():
    # The cosine of the direction toward the source along x; 1 at the source itself.
    assert pair("(?09) (r) ()") == pytest.approx((-0.6, 5, 0), rel=1e-6, abs=1e-6)
    source = animation("e () (10) () () (?09) () ()\nC () (1) () () () () ()")
    assert source.touch((0.0, 0.0, 0.0), actor=0) == 1
    # A generic field, and the same again.
    c0, c1, c2, c3, c4 = 2, 3, -0.1, 2, 0.5
    expected = c0 * c1 ** (c2 * 5**c3) / (5 + c4)
    found = pair("(?23) (?24) ()", f"fConst 4 {c0} {c1} {c2} {c3} {c4} 0 0 0")
    assert found == pytest.approx((expected, expected, 0), rel=1e-6, abs=1e-9)
    # A racket whose face looks along +x: away from it, in front of it alone.
    racket = "fConst 0 1 0 0 1.5 8 3 0.2 0"
    for ahead, aside, there in [(0.5, 1, 1), (-0.5, 1, -1), (0.5, 2, 0)]:
        found = pair("(?15) (?16) (?17)", racket, offset=(ahead, aside, 0))
        assert found == pytest.approx((there * 8 * 3 ** (-0.2 * 0.25), 0, 0), abs=1e-5)
    # It pushes along its normal, with all three components.
    tilted = pair("(?15) (?16) (?17)", "fConst 0 0 0.6 0.8 9 8 3 0.2 0", offset=(1, 2, 3))
    size = 8 * 3 ** (-0.2 * 3.6**2)
    assert tilted == pytest.approx((0, 0.6 * size, 0.8 * size), abs=1e-5)


@pytest.mark.capability("NA-049")
def test_swimming_beats_as_fast_as_one_swims():
    axiom = "C () () () () (3) () (4)\nb () () () () (?20) (?25) (?34)"
    made = animation(axiom, head=header(seconds=0.05))
    for frame in range(1, 30):
        made.advance()
        phase = frame * 0.2 * 5 * 0.05
        expected = 5 * math.sin(phase), 0.5 * math.sin(phase), math.degrees(phase)
        assert made.layers[0].string[1].growth == pytest.approx(expected, abs=1e-9), frame


@pytest.mark.capability("NA-050")
def test_each_repetition_has_its_own_oscillation():
    text = (
        "RepetitionParameters startp_sidel_nbr_dist 0 100 6 0.1\nOptions\n"
        "fConst 3 2 0.5 1 0.5 90 0.2 10 1\nAxiom\nR () () () () (?21) (?22) ()\n"
        "S () () () () (?22) () ()\nProductions\nEndProductions\n"
    )

    def lengths(frames: int) -> list[float]:
        made = Animation(text)
        for _ in range(frames):
            made.advance()
        return [math.dist(one.start, one.end) for one in made.frame.lines]

    still, later = lengths(0), lengths(20)
    assert len(set(still[::2])) == 6
    assert still[::2] == pytest.approx(still[1::2])
    assert lengths(20) == later != still
    # p0 + p1 sin(p2 T + p3), each within its share of the coefficient.
    assert all(2 * 0.75 - 1.25 <= one <= 2 * 1.25 + 1.25 for one in still + later)


@pytest.mark.capability("NA-053")
def test_touch_is_the_force_where_a_symbol_is():
    # Two sources; their fields add up where the query stands, own terms and tropism do not count.
    axiom = (
        "e () (10) () () (Xx-) (Yy-) (Zz-)\ne () (11) () () (100) () ()\n"
        "C () (1) () () (4) () ()\n"
        "e () (10) () () (3) () ()\nC () (1) () () (0) (9) ()\n"
        "f () () () (2) (1) (2) (2)\n? () () () () () () ()\nx () () () () (?40) () ()"
    )
    made = animation(axiom)
    made.advance()
    query = made.layers[0].string[-2]
    assert query.parameters == (1, 2, 2)
    found = made.touch(query.parameters, actor=0)
    assert found == pytest.approx(math.hypot(4 - 1 + 3, -2, -2), abs=1e-9)
    rule = f"? (0.01) [(?40'6.6-)>] () ()\n1.0\nh {NONE}\nEndProb\nEnd\n"
    felt = animation(axiom, rule)
    felt.advance()
    felt.advance()
    assert "h(" in felt.string()
    weaker = animation(axiom.replace("(3) () ()\nC", "(0) () ()\nC"), rule)
    for _ in range(3):
        weaker.advance()
    assert "h(" not in weaker.string()


@pytest.mark.capability("NA-055")
def test_rules_hear_who_sounds():
    # Source 5 plays the frog, number 4, for half a second from the first frame on.
    axiom = "T () (1) () () (4) (5) ()\nb () (5) () () (?60) () ()\nc () (4) () () () () ()"
    head = header(seconds=0.1)
    rules = (
        "b (0.01) [(?61'4-)=] [(?60)>] & () ()\n1.0\nh () (?61) (?60) () () () ()\nEndProb\nEnd\n"
        "c (0.01) [(?62)g] () ()\n1.0\ni () (?62) () () () () ()\nEndProb\nEnd\n"
    )
    made = animation(axiom, rules, head, sounds={4: 0.5})
    assert made.air.count() == 1
    made.advance()
    heard, source = made.layers[0].string[1:]
    assert (heard.symbol, heard.parameters[0], heard.parameters[1]) == ("h", 4, 1)
    assert (source.symbol, source.parameters[0]) == ("i", 5)
    # It ends; who does not sound is −1.
    silent = animation(
        "T () (1) () () (4) (5) ()\nb () (5) () () (?61) () ()", "", head, sounds={4: 0.5}
    )
    for _ in range(6):
        silent.advance()
    assert silent.air.count() == 0
    assert silent.layers[0].string[1].growth[0] == -1


@pytest.mark.capability("NA-066")
def test_spoken_words_are_sounds():
    head = header("AUDIOport_host 4711 listener.example", seconds=0.1)
    axiom = "b () (1000) () () (?61) (?60) ()"
    made = animation(axiom, head=head)
    assert made.recognizer == (4711, "listener.example")
    vocabulary = bio.lsystem.animation.sounds.VOCABULARY
    assert sorted(vocabulary.values()) == list(range(29, 59))
    assert (vocabulary["move right"], vocabulary["one"], vocabulary["exit"]) == (29, 48, 58)
    for word, number in vocabulary.items():
        made = animation(axiom, head=head, sounds=dict.fromkeys(range(100), 0.25))
        made.say(word)
        heard = []
        for _ in range(5):
            made.advance()
            heard.append(made.layers[0].string[0].growth)
        # One event, heard from the frame after it was said until it ends.
        assert heard == [(-1, 0, 0), (number, 1, 0), (number, 1, 0), (-1, 0, 0), (-1, 0, 0)], word
    # The camera filters its own words out; others are heard.
    filtered = animation(axiom + "\nl () () () (11) () () ()", head=head)
    for word in ("move", "seven", "strawberry"):
        filtered.say(word)
    filtered.advance()
    assert [one.number for one in filtered.air.sounds] == [vocabulary["seven"]]
    assert filtered.remarks == ["nobody knows the word 'strawberry'"]


@pytest.mark.capability("NA-052")
def test_rules_know_the_active_automaton():
    option = "actorNbr_automata 0 0 9 state 3\nactorNbr_automata 0 0 19 align 1 2 3"
    assert value("?35", option) == 19
    made = animation("b () () () () (?35) () ()", head=header(option))
    made.actors[0].pop()
    made.advance()
    assert made.layers[0].string[0].growth[0] == 9
    assert value("?35", option, senses={"automaton": lambda actor: 7.0}) == 7


def test_the_host_answers_for_eyes():
    numbers = {"30": "distance", "31": "obstacle", "32": "looks_at_goal", "33": "near_goal"}
    numbers |= {"36": "interest", "37": "color_of_interest", "39": "at_goal"}
    numbers |= {"38": "color_of_interest_as_goal"}
    for number, name in numbers.items():
        asked = []
        found = value(f"?{number}", senses={name: lambda actor, of=asked: of.append(actor) or 2.5})
        assert found == 2.5, name
        assert asked == [0]
        with pytest.raises(FormatError, match=rf"<text>.lm:8:18: '\?{number}'.*'{name}'"):
            value(f"?{number}")
    # Whose eyes: the actor that the turtle was last mapped to.
    axiom = "M () (7) () (3) () () ()\nb () () () () (?30) () ()"
    made = animation(axiom, senses={"distance": lambda actor: 10.0 * actor})
    assert made.layers[0].string[1].growth[0] == 30
    with pytest.raises(UnknownNameError, match="unknown senses taste; known: distance"):
        animation(axiom, senses={"taste": lambda actor: 1.0})


def test_a_rule_walks_until_it_sees_a_wall():
    """A sensor in a condition: an actor goes ahead, and turns where it would touch a wall."""

    def distance(actor: int) -> float:
        place, heading = made.actors[actor].position, made.actors[actor].heading
        ways = [
            (edge - at) / along
            for at, along in ((place[0], heading[0]), (place[2], heading[2]))
            for edge in (-5, 5)
            if along and (edge - at) / along > 0
        ]
        return min(ways, default=99.0)

    turn = "f (0.01) [(?30'1.5-)<] () ()\n1.0\n+ () () () () (90) () ()\n"
    turn += "f () () () () (1) () ()\nEndProb\nEnd\n+ (0.01) () () ()\n1.0\nEndProb\nEnd\n"
    axiom = f"M () (7) () (0) () () ()\nf () () () () (1) () ()\ng {NONE}"
    made = animation(axiom, turn, senses={"distance": distance})
    visited = []
    for _ in range(60):
        made.advance()
        visited.append(made.actors[0].position)
    assert max(abs(part) for place in visited for part in place) <= 5
    assert len({(round(x), round(z)) for x, _, z in visited}) > 12
    steps = [math.dist(a, b) for a, b in pairwise(visited)]
    assert steps == pytest.approx([1.0] * 59)


def test_what_is_no_number_is_said():
    for expression, message in [
        ("1'0/", "division by 0"),
        ("1'0%", "division by 0"),
        ("2_0.5^", "is no finite number"),
        ("2:", "is no finite number"),
    ]:
        made = animation(f"b () () () () ({expression}) () ()")
        assert made.layers[0].string[0].growth[0] == 0
        assert message in made.remarks[0]
        assert "<text>.lm:3:" in made.remarks[0]
    deep = "|" * 300
    for broken, message in [
        ("?99", "'\\?99'.*means nothing"),
        ("a", "constant 'a' is not declared"),
        ("?12", "needs the constant 'P'"),
        ("?23", "needs the constants 'fConst 4'"),
        ("?01", "spline 1 is not declared"),
        ("1'2", "2 numbers are left over"),
        ("+", "too few numbers"),
        (f"1{deep}", "nested too deeply"),
    ]:
        with pytest.raises(FormatError, match=rf"<text>.lm:\d+:\d+: .*{message}"):
            animation(f"b () () () () ({broken}) () ()")


def test_both_readings_of_a_plant_agree():
    tree = (
        "Axiom\n+ () () () () (90) () ()\nR () (1) () () (6xt**) () ()\nProductions\n"
        "R (1) [(z)=] () ()\n1.0\nR () (x) () (1) (6x*t+) () ()\n"
        f"[ {NONE}\n+ () () () () (90) () ()\nR () (x2/) () () (6xt**) () ()\n] {NONE}\n"
        f"[ {NONE}\n- () () () () (90) () ()\nR () (x2/) () () (6xt**) () ()\n] {NONE}\n"
        "EndProb\nEnd\nEndProductions\n"
    )
    made = Animation(tree)
    made.run(seconds=2.4)
    plant = bio.LSystem.from_definition(tree)
    drawn = bio.Turtle().interpret(plant.derive(time=2.4)).segments
    assert len(made.frame.lines) == len(drawn.start)
    for line, start, end in zip(made.frame.lines, drawn.start, drawn.end, strict=True):
        assert line.start == pytest.approx(start.tolist(), abs=1e-4)
        assert line.end == pytest.approx(end.tolist(), abs=1e-4)
