"""Animations of definition files: strings, memories, symbols that act, files and options."""

import math

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import FormatError, LimitError
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import Source

NONE = "() () () () () () ()"


def animation(axiom: str, rules: str = "", head: str = "", **options) -> Animation:
    return Animation(text(axiom, rules, head), **options)


def text(axiom: str, rules: str = "", head: str = "") -> str:
    return f"{head}\nAxiom\n{axiom}\nProductions\n{rules}\nEndProductions\n"


def options(*lines: str, seconds: float = 0.04) -> str:
    told = "\n".join(lines)
    return f"Camera_AnimationParameters t_final_interval 60 {seconds}\nOptions\n{told}\n"


def symbols(made: Animation) -> str:
    return "".join(one.symbol for one in made.layers[0].string)


def rule(head: str, *alternatives: tuple[float, str]) -> str:
    made = "".join(
        f"{chance}\n{''.join(f'{one} {NONE} ' for one in word)}\nEndProb\n"
        for chance, word in alternatives
    )
    return f"{head}\n{made}End\n"


@pytest.mark.capability("NA-033", "NA-061")
def test_what_is_ephemeral_acts_once_and_is_never_in_the_string():
    rules = (
        "x (0.1) [(T0.5-)<] () ()\n1.0\ne () () () () (0 19 align 1 2 3 speed 0.5) () ()\n"
        f"h {NONE}\nx {NONE}\nEndProb\nEnd\n"
    )
    axiom = f"e () () () () (0 9 state 2) () ()\nx {NONE}"
    made = animation(axiom, rules, options("actorNbr_automata 0 0 4 fov 600"))
    stack = made.actors[0].stack
    assert [one.automaton for one in stack] == [4, 9]
    seen = []
    for _ in range(30):
        made.advance()
        assert "e" not in symbols(made)
        seen.append(len(stack))
    # One behavior per replacement, and the last pushed is popped first.
    assert len(stack) == 2 + symbols(made).count("h") > 4
    assert seen[-1] == seen[15]
    assert made.actors[0].variables["align"] == (1, 2, 3)
    assert made.actors[0].variables["fov"] == (600,)
    made.actors[0].push(bio.lsystem.animation.read_behavior("0 21 state 7", "here"))
    order = [made.actors[0].pop().automaton for _ in range(3)]
    assert order == [21, 19, 19]


@pytest.mark.capability("NA-034")
def test_positions_and_states_are_remembered_from_frame_to_frame():
    # A walk of its own: recall the state, turn and step, store the state.
    axiom = (
        "] () (1) (1) () () () ()\n+ () () () () (30) () ()\nR () () () () (2) () ()\n"
        "[ () (1) (1) () () () ()"
    )
    made = animation(axiom)
    place, angle = (0.0, 0.0), 0.0
    for _ in range(20):
        angle += 30
        place = (
            place[0] + 2 * math.cos(math.radians(angle)),
            place[1] + 2 * math.sin(math.radians(angle)),
        )
        assert made.frame.lines[0].end[:2] == pytest.approx(place, abs=1e-9)
        made.advance()
    # Positions of other branches, and of the frame before, become corners of a surface.
    axiom = (
        f"[ {NONE}\nf () () () () (3) () ()\n[ () (2) () () () () ()\n] {NONE}\n"
        f"f () () () () (1) () ()\n{{ {NONE}\n. {NONE}\n"
        f"] () (2) () () () () ()\n] () (3) () () () () ()\n}} {NONE}\n"
        "f () () () (2) (0) (T1+) (0)\n[ () (3) () () () () ()"
    )
    made = animation(axiom)
    assert made.frame.pieces[0].corners == [(1, 0, 0), (3, 0, 0), (0, 0, 0)]
    made.advance()
    assert made.frame.pieces[0].corners == [(1, 0, 0), (3, 0, 0), (0, 1, 0)]
    made.advance()
    assert made.frame.pieces[0].corners[2] == pytest.approx((0, 1.04, 0))


def test_strings_step_like_those_of_plants():
    """Contexts, cuts, carried ages and alternatives, as `LSystem` reads them."""
    for word, cut, rest, expected in [
        ("[a[bZc]d]", "100", "[Y]", "[a[Y]d]"),
        ("[a[bZc]d]", "1_", "", "[a[b]d]"),
        ("a[bZ[cd]k[f]]g", "2_", "", "a[b[f]]g"),
        ("a[b[c]Z[d]e]g[h]", "100_", "Y", "aYg[h]"),
        ("aZb", "100", "Y", "aYb"),
    ]:
        axiom = "\n".join(f"{one} {NONE}" for one in word)
        made = f"] () ({cut}) () () () () ()\n" + "\n".join(f"{one} {NONE}" for one in rest)
        cutting = animation(axiom, f"Z (0.01) () () ()\n1.0\n{made}\nEndProb\nEnd\n")
        cutting.advance()
        assert symbols(cutting) == expected

    def replaced(symbol: str, context: str, word: str = "A[B[C]D]E") -> bool:
        axiom = "\n".join(f"{one} {NONE}" for one in word)
        made = animation(axiom, rule(f"{symbol} (0.01) () {context}", (1.0, "Z")))
        made.advance()
        return "Z" in symbols(made)

    for symbol, context in [("B", "(A) ()"), ("C", "(B) ()"), ("D", "(B) ()"), ("E", "(A) ()")]:
        assert replaced(symbol, context), (symbol, context)
    for symbol, context in [("A", "() (B)"), ("A", "() (E)"), ("B", "() (C)"), ("B", "() (D)")]:
        assert replaced(symbol, context), (symbol, context)
    for symbol, context in [("C", "() (D)"), ("D", "() (E)"), ("E", "(D) ()")]:
        assert not replaced(symbol, context), (symbol, context)
    # What a symbol was too old goes on, so that long frames do what short ones do.
    chain = rule("b (1) () () ()", (1.0, "h")) + rule("h (1) () () ()", (1.0, "i"))
    for seconds in (0.25, 1.0, 2.5, 5.0):
        made = animation(f"b {NONE}", chain, options(seconds=seconds))
        made.run(seconds=5)
        assert symbols(made) == "i"
        assert made.layers[0].string[0].age == pytest.approx(3)
    # Shares of alternatives; what is missing to 1 means to wait.
    count = 3000
    axiom = f"b {NONE}\n" * count
    made = animation(axiom, rule("b (0.01) () () ()", (0.5, "h"), (0.2, "i")), seed=3)
    made.advance()
    for symbol, share in [("h", 0.5), ("i", 0.2), ("b", 0.3)]:
        found = symbols(made).count(symbol) / count
        assert abs(found - share) < 4 * math.sqrt(share * (1 - share) / count), symbol
    again = animation(axiom, rule("b (0.01) () () ()", (0.5, "h"), (0.2, "i")), seed=3)
    again.advance()
    assert symbols(again) == symbols(made)


def test_random_numbers_are_drawn_anew_every_frame():
    made = animation("b () (!) (!) () (!) (!!+) ()\nb () (!) () () (!) () ()", seed=1)
    drawn = []
    for _ in range(300):
        drawn.append(made.layers[0].string[0].growth[0])
        assert made.layers[0].string[0].parameters[0] == made.layers[0].string[0].parameters[0]
        made.advance()
    assert abs(np.mean(drawn) - 0.5) < 4 / math.sqrt(12 * 300)
    assert len(set(drawn)) == 300
    first, second = made.layers[0].string
    assert first.parameters[0] != first.parameters[1] != second.parameters[0]


@pytest.mark.capability("NA-057")
def test_no_more_particles_than_allowed():
    rules = f"x (0.04) () () ()\n1.0\nC () () () () (1) () ()\nx {NONE}\nEndProb\nEnd\n"
    made = animation(f"x {NONE}", rules, options("MaxPart 5"))
    for _ in range(12):
        made.advance()
    assert len(made.particles) == 5
    assert symbols(made).count("C") == 12
    (said,) = made.remarks
    assert said == "<text>.lm:10:1: no particle for 'C': there are 5, as many as MaxPart allows"
    # Who goes makes room.
    dying = rules + "C (0.08) () () ()\n1.0\nEndProb\nEnd\n"
    made = animation(f"x {NONE}", dying, options("MaxPart 5"))
    for _ in range(12):
        made.advance()
        assert len(made.particles) == symbols(made).count("C") <= 3
    assert not made.remarks


@pytest.mark.capability("NA-058", "NA-084")
def test_programs_get_their_words():
    ran = []
    head = options(
        "command_file 0 before.sh a b",
        "command_file 1 after.sh c d",
        "command_file 4 shoot.sh film 7",
    )
    axiom = "E () (4) () () (T100*) (2.9) (3_)"
    made = animation(axiom, "", head, scripts=ran.append)
    assert ran == [["shoot.sh", "0", "film", "7", "0", "2", "-3"]]
    ran.clear()
    made.advance()
    assert ran == [
        ["before.sh", "1", "a", "b"],
        ["shoot.sh", "1", "film", "7", "4", "2", "-3"],
        ["after.sh", "1", "c", "d"],
    ]
    # Once per frame wherever a string is drawn, or each time if the second parameter says so.
    many = "RepetitionParameters startp_sidel_nbr_dist 0 10 3 0\n" + head.split("\n", 1)[1]
    for second, times in [("()", 1), ("(1)", 3)]:
        ran.clear()
        animation(f"E () (4) {second} () () () ()", "", many, scripts=ran.append)
        assert len(ran) == times
    # A rule that calls them: when a symbol is replaced.
    ran.clear()
    rules = "x (0.1) () () ()\n1.0\nE () (4) () () (7) () ()\nEndProb\nEnd\n"
    rules += "E (0.04) () () ()\n1.0\nEndProb\nEnd\n"
    made = animation(f"x {NONE}", rules, head, scripts=ran.append)
    made.run(seconds=1)
    assert [one for one in ran if one[0] == "shoot.sh"] == [
        ["shoot.sh", "3", "film", "7", "7", "0", "0"]
    ]
    # Without a host nothing runs.
    assert animation(axiom, "", head).remarks == []
    assert "command file 9" in animation("E () (9) () () () () ()").remarks[0]


@pytest.mark.capability("NA-062")
def test_the_sound_log_follows_its_grammar(tmp_path):
    head = options(
        "Sound_event_file noises.log INIT_source 5 0 0 0 0 0 0 INIT_mic 1 0 1 0 0 0 0 "
        "INIT_dist_matrix"
    )
    axiom = (
        "T () (1) () () (2) (5) ()\nf () () () () (T) () ()\nT () (2) () () (5) () ()\n"
        "l () () (1) (8) (T) (2) (3)"
    )
    made = animation(axiom, "", head)
    made.run(seconds=0.12, folder=tmp_path)
    lines = (tmp_path / "noises.log").read_text().splitlines()
    assert lines == made.sound_log.splitlines()
    assert lines[0] == "INIT_source 5 0 0 0 0 0 0 INIT_mic 1 0 1 0 0 0 0 INIT_dist_matrix"
    assert lines[1] == "TIME 0 SP 5 0 0 0 PLAY 5 cricket.aiff SP 5 0 0 0 MP 1 0 2 3"
    assert lines[4] == "TIME 0.12 SP 5 0.12 0 0 MP 1 0.12 2 3"
    counts = {"INIT_source": 7, "INIT_mic": 7, "INIT_dist_matrix": 0, "TIME": 1, "SP": 4}
    counts |= {"MP": 4, "PLAY": 2}
    for line in lines:
        words = line.split()
        while words:
            count = counts[words.pop(0)]
            assert len(words) >= count
            del words[:count]
    with pytest.raises(FormatError, match="sound command 'SPX'"):
        animation(axiom, "", options("Sound_event_file a.log SPX 3 4 5 6"))


@pytest.mark.capability("NA-063", "NA-083")
def test_scenes_of_the_offline_renderer(tmp_path):
    head = options("rs_file_path_name /elsewhere/films shot", "rs_switch 2 3 5 5 9 8")
    modes = {
        "0": "grid 1.5 2 -3 ",
        "1": "end ",
        "2": "plane 0 1.5 0 0 1 0",
        "4": "scale 1.5 2 -3",
        "5": "window 0 180 0 144",
        "6": "name obj1.5 list",
        "7": "object obj1.5",
        "8": "translate 1.5 2 -3",
        "9": "rotate 1.5 2 -3",
        "10": "texture marble",
        "11": "texture bump",
        "12": "window 8 1.5 2 -3",
        "13": "name obj1.5",
        "14": "list ",
        "15": "sphere ambient 0.9 0.9 0.9 6000 0 0 0 texture sky 1 0.5 2.0 6 0.85 0.45 "
        "scale 1.5 2 -3",
        "16": "list sphere ambient 0.1 0.25 0.05 1 0 0 0 texture cloud 1 0.5 2 6 0.1 0.9 10.3 "
        "scale 0.5 1 1 end",
        "17": '#include "plane.ray" transform 1.5 0 0 0 2 0 0 0 -3 0 0 0',
        "18": "light 0.5 0.5 0.5 point 0 15 130 noshadow",
        "60": '#include "actor8.ray" transform 1.5 0 0 0 2 0 0 0 -3 0 0 0',
    }
    axiom = "\n".join(f"D () ({one}) () (8) (1.5) (2) (3_)" for one in modes)
    axiom += "\nm () (4) () () () () ()\nc () () () () (1) (1) (1)"
    made = animation(axiom, "", head)
    made.run(seconds=0.4, folder=tmp_path)
    assert sorted(one.name for one in tmp_path.iterdir()) == [
        "shot.0002.ray",
        "shot.0003.ray",
        "shot.0005.ray",
    ]
    lines = (tmp_path / "shot.0005.ray").read_text().splitlines()
    begin = lines.index(modes["0"])
    assert lines[begin : begin + len(modes)] == list(modes.values())
    assert sum(one.startswith("triangle red_") for one in lines) == 12
    # Outside the intervals `D` draws.
    assert len(animation("D () (2) () () () () ()", "", head).frame.pieces) == 1


@pytest.mark.capability("NA-065")
def test_trajectories_are_written_and_read_again(tmp_path):
    (tmp_path / "walk.lm").write_text(
        options("NBR_actors 3", "trace_actor 2 path.txt")
        + text(
            "M () (7) () (2) () () ()\nf () () () (2) (T7*) (K) (1)\ng " + NONE + "\n"
            "l () () () (6) (2) () ()",
            "",
            "Constants\nK 0.3 2.7 77",
        )
    )
    first = Animation.read(tmp_path / "walk.lm")
    walked = [first.actors[2].position]
    for _ in range(20):
        first.advance()
        walked.append(first.actors[2].position)
    first.write(tmp_path)
    records = [line.split() for line in (tmp_path / "path.txt").read_text().splitlines()]
    assert len(records) == 21
    assert records[3][:2] == ["2", "0"]
    assert float(records[3][2]) == pytest.approx(0.12)
    (tmp_path / "again.lm").write_text(
        options("import_trace 2 path.txt")
        + text("$ () () (5) (2) () () ()\nD () (30) () () () () ()\nR () () () () (1) () ()")
    )
    second = Animation.read(tmp_path / "again.lm")
    for frame in range(20):
        assert second.frame.printed[0] == pytest.approx(walked[frame], abs=1e-6)
        line = second.frame.lines[0]
        heading = np.subtract(line.end, line.start)
        way = np.subtract(walked[frame + 1], walked[frame])
        assert heading == pytest.approx(way / np.linalg.norm(way), abs=1e-4)
        second.advance()
    for broken, message in [("1 2 3\n", "path.txt:1: expected"), ("", "no records of actor 2")]:
        (tmp_path / "path.txt").write_text(broken)
        with pytest.raises(FormatError, match=message):
            Animation.read(tmp_path / "again.lm")


@pytest.mark.capability("NA-069")
def test_every_command_of_an_automaton_sets_its_variable():
    push = bio.lsystem.animation.read_behavior
    commands = {
        "KEYFRAMEdef 3 walk.track": ("KEYFRAMEdef 3", (3, "walk.track")),
        "coll_test_func 2": ("coll_test_func", (2,)),
        "heuristic 4": ("heuristic", (4,)),
        "rel_search_level 1": ("rel_search_level", (1,)),
        "rgb_interest 255 0 10 1": ("rgb_interest", (255, 0, 10, 1)),
        "eps_arrived 1 2.5": ("eps_arrived 1", (1, 2.5)),
        "eps_look_at_goal 0 0.9": ("eps_look_at_goal 0", (0, 0.9)),
        "eps_look_at 0 0.8": ("eps_look_at_goal 0", (0, 0.8)),
        "turtle 2": ("turtle", (2,)),
        "mem_displ_cubes": ("mem_displ", ("cubes",)),
        "mem_displ_points": ("mem_displ", ("points",)),
        "mem_no_displ": ("mem_displ", ("no_displ",)),
        "vis_mem_on": ("vis_mem", (1,)),
        "vis_mem_off": ("vis_mem", (0,)),
        "obs 0 0 50": ("obs", (0, 0, 50)),
        "lat 1 2 3": ("lat", (1, 2, 3)),
        "align -1 2 3": ("align", (-1, 2, 3)),
        "init 10 -20 300 2.0": ("init", (10, -20, 300, 2)),
        "fov 600": ("fov", (600,)),
        "interest 1 2": ("interest 2", (1, 2)),
        "size_actor 1.5": ("size_actor", (1.5,)),
        "dist_coll 0.5": ("dist_coll", (0.5,)),
        "tennis_state 3": ("tennis_state", (3,)),
        "optim_rate 5": ("optim_rate", (5,)),
        "speed 1.4": ("speed", (1.4,)),
        "inertia 0.3": ("inertia", (0.3,)),
        "ahead 4": ("ahead", (4,)),
        "optim_ahead 6": ("optim_ahead", (6,)),
        "vision_range 0.1 100 30": ("vision_range", (0.1, 100, 30)),
        "motor_init 1200 0.001 1": ("motor_init", (1200, 0.001, 1)),
    }
    for words, (name, expected) in commands.items():
        actor = bio.lsystem.animation.Actor()
        actor.push(push(f"0 9 {words}", "here"))
        assert actor.variables == {name: expected}, words
    actor = bio.lsystem.animation.Actor()
    actor.push(push("0 9 goal 1 2 3 goal 4 5 6 local_goal 1 7 8 9 state 11", "here"))
    assert actor.goals == [(1, 2, 3), (4, 5, 6)]
    assert actor.local_goals == {1: (7, 8, 9)}
    assert actor.state == 11
    # What is not told keeps its value.
    actor.push(push("0 19 reset_goal speed 2", "here"))
    assert (actor.goals, actor.state, actor.automaton) == ([], 11, 19)
    for broken, message in [
        ("0", "numbers of actor and automaton"),
        ("0 9 fly 1", "unknown command 'fly'"),
        ("0 9 goal 1 2", "'goal' has 3 arguments, found 2"),
        ("0 9 fov wide", "'fov' expects a number, found 'wide'"),
        ("0 9 fov 1.5", "'fov' expects a number"),
    ]:
        with pytest.raises(FormatError, match=f"here: .*{message}"):
            push(broken, "here")


def spot(made: Animation) -> tuple[float, float, float]:
    """Return where the camera sees the middle of the first piece, by rendering it."""
    piece = made.frame.pieces[0]
    world = bio.World()
    world.add(bio.Props(np.array(piece.corners), np.array(piece.triangles())))
    world.step()
    width, height = 500, 400
    eye = made.camera.view()
    ((_, _, ids),) = bio._engine.Rasterizer().look(world.scene, [eye], width, height)
    rows, columns = np.nonzero(ids)
    return 2 * (columns.mean() + 0.5) / width - 1, 1 - 2 * (rows.mean() + 0.5) / height, len(rows)


@pytest.mark.capability("NA-068")
def test_the_camera_of_the_file_sees_what_it_projects():
    head = (
        "Camera_AnimationParameters\nprefpos_x1_x2_y1_y2 10 510 20 420 observer 3 4 12 "
        "lookatPoint 1 2 -1\ntwist {} viewAngle {} aspectRatio 1.25 near 1 far 30 "
        "swapinterval 1 nbrCalcStep_seed 4 34743 t_final_interval 60 0.04\n"
    )
    for twist, angle, place in [
        (0, 500, (1, 2, -1)),
        (0, 500, (4, 1, 0)),
        (0, 300, (2, 4, -3)),
        (30, 500, (4, 1, 0)),
        (-75, 700, (-2, 5, 1)),
    ]:
        x, y, z = (f"{abs(one)}{'_' if one < 0 else ''}" for one in place)
        axiom = f"f () () () (2) ({x}) ({y}) ({z})\na () () () () (0.2) () ()"
        made = animation(axiom, "", head.format(twist, angle))
        camera = made.camera
        assert camera.window == (10, 510, 20, 420)
        assert (camera.eye, camera.target) == ((3, 4, 12), (1, 2, -1))
        assert (camera.angle, camera.aspect, camera.near, camera.far) == (angle / 10, 1.25, 1, 30)
        right, up, pixels = spot(made)
        assert pixels > 15
        assert camera.project(place) == pytest.approx((right, up), abs=2 / 400)
    assert camera.project((3, 4, 11.5)) is None
    assert camera.project((1, 2, -40)) is None


def test_broken_files_are_refused_with_their_place(tmp_path):
    (tmp_path / "bad.sm").write_text("SM 3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 7\n")
    (tmp_path / "short.sm").write_text("SM 3 1\n0 0 0\n")
    (tmp_path / "bad.txt").write_text("0.5 3\n1 2\n")
    for surface, message in [
        ("bad.sm", "a corner that is not there"),
        ("short.sm", "are 12 numbers, found 3"),
        ("none.sm", "there is no file"),
        ("../../etc/passwd", "outside the folder"),
    ]:
        source = Source(text("b " + NONE, "", f"Surfaces\nfig_sm 0 {surface}"), "a.lm", tmp_path)
        with pytest.raises(FormatError, match=message):
            Animation(source)
    channel = text("b " + NONE, "", "Options\nNbrChannels_listOfNames 1 bad.txt")
    with pytest.raises(FormatError, match=r"bad\.txt: expected a time step"):
        Animation(Source(channel, "a.lm", tmp_path))
    with pytest.raises(FormatError, match="has no folder"):
        Animation(channel)
    for broken, message in [
        ("Options\nMaxPart many\n", "2:9: expected a whole number of 'MaxPart', found 'many'"),
        ("Options\nfConst 5 2 0\n", "3:1: expected a number of 'fConst', found 'Axiom'"),
        ("Options\nNBR_actors 1000\n", "at most 64 actors"),
        ("Options\nactorNbr_automata 0 0 9 fly 1\n", "unknown command 'fly'"),
    ]:
        with pytest.raises((FormatError, LimitError), match=message):
            Animation(broken + text("b " + NONE).lstrip())
    grows = "b (0.001) () () ()\n1.0\n" + f"b {NONE}\n" * 4 + "EndProb\nEnd\n"
    with pytest.raises(LimitError, match=r"<text>.lm:5:1: .*production of 'b' explodes"):
        animation(f"b {NONE}", grows).run(seconds=1)
