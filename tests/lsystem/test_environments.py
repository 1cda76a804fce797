"""What surrounds plants: each environment by itself, and models that talk to it."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio
from bioscope.environments import Environment

TIERS = """lsystem: L16_branch_tiers
derivation length: 5
environment: leaf_discs rho=0.89
#define r1 0.94
#define r2 0.87
#define a1 24.4
#define a2 36.9
#define phi 138.5
ignore: + - /
axiom: {axiom}
p1: ?E(x) < A(v) : x == 1 -->
   [+(a2)F(v*r2)?E(r2)A(v*r2)]-(a1)F(v*r1)/(180)?E(r1)A(v*r1)
p2: ?E(x) --> *
endlsystem
"""
TIER = (
    "-(90)[F(1)?E(1)A(1)]+(phi)[F(1)/(180)?E(1)A(1)]+(phi)[F(1)?E(1)A(1)]"
    "+(phi)[F(1)/(180)?E(1)A(1)]+(phi)[F(1)?E(1)A(1)]"
)
TREE = """lsystem: L19_light_tree
derivation length: 744
environment: sky_light sources=9 tau=0.25 grid=32
context: tree
#define phi 137.5
#define a0 5
#define a1 20
#define a2 32
#define W 0.02
#define VD 0.95
#define Del 30
#define LS 5
#define LP 8
#define LM 2
#define PB 0.8
#define PG 0.4
#define BM 0.32
#define BE 1.5
#define Nmin 25
consider: ?E [ ] ! L
axiom: !(W,1,1)F(2)L(1,LP,0,0)A(1,0)[!(0,0,0)]!(W,0,1)
p1: A(vig,del) : del < Del --> A(vig,del+1)
p2: L(vig,p,age,del) : (age < LS) && (del < Del-1) --> L(vig,p,age,del+1)
p3: L(vig,p,age,del) : (age < LS) && (del == Del-1) --> L(vig,p,age,del+1)?E(vig*0.5)
p4: L(vig,p,age,del) > ?E(r) : (age < LS-1) && (r*LP >= LM) && (del == Del) --> \
L(vig,LP*r-LM,age+1,0)
p5: L(vig,p,age,del) > ?E(r) : ((age >= LS-1) || (r*LP < LM)) && (del == Del) --> L(0,0,LS,0)
p6: ?E(r) < A(vig,del) : r*LP-LM > PB { vig = vig*VD; } -->
   /(phi)[+(a2)!(W,-PB,1)F(vig)L(vig,LP,0,0)A(vig,0)[!(0,0,0)]!(W,0,1)]
   -(a1)!(W,0,1)F(vig)L(vig,LP,0,0)A(vig,0)
p7: ?E(r) < A(vig,del) : r*LP-LM > PG { vig = vig*VD; } -->
   /(phi)-(a0)[!(0,0,0)]!(W,-PG,1)F(vig)L(vig,LP,0,0)A(vig,0)
p8: ?E(r) < A(vig,del) : r*LP-LM <= PG --> A(vig,0)
p9: ?E(r) --> *
p10: !(w0,p0,n0) > L(vig,pL,age,del)[!(w1,p1,n1)]!(w2,p2,n2) :
   { w = (w1^2+w2^2)^0.5; p = p1+p2+pL-BM*(w/W)^BE; }
   (p > 0) || (n1+n2 >= Nmin) --> !(w,p,n1+n2)
p11: !(w0,p0,n0) > L(vig,pL,age,del)[!(w1,p1,n1)]!(w2,p2,n2) --> !(w0,0,0)L%
endlsystem
"""


def counts(string: bio.ModuleString) -> dict[str, int]:
    """Return how often each symbol occurs."""
    found: dict[str, int] = {}
    numbers = np.bincount(string.kinds, minlength=len(string.symbols))
    for symbol, number in zip(string.symbols, numbers, strict=False):
        found[symbol] = found.get(symbol, 0) + int(number)
    return found


@pytest.mark.capability("PL-410", "PL-411", "PL-403")
def test_two_tiers_have_the_published_numbers():
    axiom = f"[f(0){TIER}][-(90)f(4.8)+(90){TIER}]"
    system = bio.LSystem(TIERS.replace("{axiom}", axiom))
    centers = [(0, 0, 0), (4.8, 0, 0)]
    clusters = bio.environments.Collision(0.89, centers)
    string = bio.environments.derive(system, environment=clusters)
    assert counts(string)["F"] == 138


@pytest.mark.capability("PL-412")
def test_tiers_grow_away_from_their_neighbor():
    alone = bio.LSystem(TIERS.replace("{axiom}", TIER))
    free = bio.Turtle().interpret(bio.environments.derive(alone, 5)).segments.end
    axiom = f"[f(0){TIER}][-(90)f(4.8)+(90){TIER}]"
    system = bio.LSystem(TIERS.replace("{axiom}", axiom))
    clusters = bio.environments.Collision(0.89, [(0, 0, 0), (4.8, 0, 0)])
    ends = bio.Turtle().interpret(bio.environments.derive(system, environment=clusters)).segments
    left = ends.end[ends.end[:, 0] < 2.4]
    right = ends.end[ends.end[:, 0] > 2.4] - (4.8, 0, 0)
    assert left[:, 0].mean() < free[:, 0].mean() < right[:, 0].mean()


@pytest.mark.capability("PL-441")
def test_clusters_shade_each_other_by_the_area_they_cover():
    sky = bio.environments.SkyLight()
    ((alone,),) = sky.ask([[0.5]], [(0, 0, 0)])
    assert alone == pytest.approx(1.0)
    below, above = sky.ask([[0.5], [0.5]], [(0, 0, 0), (0, 4, 0)])
    zenith = 1 - math.cos(math.radians(22.5))
    ring = (1 + math.sqrt(2)) / 3 * math.cos(math.radians(22.5))
    assert below[0] == pytest.approx(1 - 0.75 * zenith / (zenith + ring), abs=1e-5)
    assert above[0] == pytest.approx(1.0)
    # Covered in all nine directions: a quarter remains.
    half = math.sqrt(0.5)
    around = [
        (
            4 * half * math.cos(math.radians(45 * k)),
            4 * half,
            4 * half * math.sin(math.radians(45 * k)),
        )
        for k in range(8)
    ]
    covered = sky.ask([[0.5]] * 10, [(0, 0, 0), (0, 4, 0), *around])
    assert covered[0][0] == pytest.approx(0.25, abs=1e-4)


@pytest.mark.capability("PL-440", "PL-442")
def test_the_tree_in_light_has_the_reference_sizes():
    system = bio.LSystem(TREE)
    # Segments, clusters (that ask) and terminals in the last step but one of each year.
    for year, expected in {
        4: (15, 15, 8),
        7: (127, 124, 64),
        8: (252, 240, 126),
        9: (476, 427, 235),
    }.items():
        found = counts(bio.environments.derive(system, 31 * year - 1))
        assert (found["F"], found["?E"], found["A"]) == expected
    assert 235 < 2 * 126


@pytest.mark.capability("PL-421", "PL-422")
def test_leaves_on_the_ground_shade_until_they_die():
    light = bio.environments.PatchLight()
    here = (-16, -16, 0)
    question, birth, death = [0, 9], [1, 1.2], [2, 1.2]
    assert light.ask([question], [here])[0][1] == 1.0
    assert light.ask([question, birth], [here, here])[0][1] == 0.0
    assert light.ask([question, death], [here, here])[0][1] == 1.0
    assert light.ask([question], [(99, 0, 0)])[0][1] == 0.0
    painted = np.zeros((10, 20), np.float32)
    painted[2, 15] = 0.7
    meadow = bio.environments.PatchLight(painted, low=(0, 0), size=(20, 10))
    assert meadow.ask([question], [(15.5, 2.5, 0)])[0][1] == pytest.approx(0.7)


@pytest.mark.capability("PL-431")
def test_water_is_granted_and_spreads():
    soil = bio.environments.SoilWater((40, 40), diffusion=0.2, amount=1.0)
    ((granted, _),) = soil.ask([[0.4, 0]], [(0.5, 0.5, 0)])
    assert granted == pytest.approx(0.4)
    drunk = sum(soil.ask([[9.0, 0]], [(0.5, 0.5, 0)])[0][0] for _ in range(30))
    assert 1.0 < drunk < 40, "water flows in from around"
    poor = bio.environments.SoilWater((40, 40), amount=0, sources=[(10, -20, -1, 20, 20, 1, 5.0)])
    for _ in range(400):
        poor.ask([[0.0, 0]], [(0.5, 0.5, 0)])
    ((_, angle),) = poor.ask([[0.0, 1e6]], [(9.5, 0.5, 0)], [(0, -1, 0)])
    assert angle == pytest.approx(90, abs=2), "to its left, where the water is"


@pytest.mark.capability("PL-407", "PL-408")
def test_runners_go_around_obstacles():
    source = (
        "lsystem: runner\naxiom: ?E(0.05,0,0)A\n"
        "p1: ?E(l,y,p) < A --> +(y)&(p)F(l)?E(0.05,0,0)A\np2: ?E(l,y,p) --> *\nendlsystem\n"
    )
    ball = bio.environments.Obstacles(ball=(0.1, 1.0, 0.0, 0.5))
    string = bio.environments.derive(bio.LSystem(source), 100, environment=ball)
    ends = bio.Turtle().interpret(string).segments.end
    depth = 0.5 - np.linalg.norm(ends - (0.1, 1.0, 0.0), axis=1)
    assert depth.max() < 1e-3
    assert np.linalg.norm(ends[-1]) > 1.5


@pytest.mark.capability("PL-119")
def test_queries_are_told_where_the_turtle_is():
    source = (
        "lsystem: L13_query\nderivation length: 3\nangle: 90\naxiom: A\n"
        "p1: A --> F(1)?P(0,0)-A\np2: F(k) --> F(k+1)\nendlsystem\n"
    )
    system = bio.LSystem(source)
    assert [bio.environments.derive(system, steps).string() for steps in (1, 2, 3)] == [
        "F(1)?P(0,1)-A",
        "F(2)?P(0,2)-F(1)?P(1,2)-A",
        "F(3)?P(0,3)-F(2)?P(2,3)-F(1)?P(2,2)-A",
    ]


class Warmth(Environment):
    """An environment of one's own: growth follows the warmth of a hearth."""

    def __init__(self) -> None:
        self.log: list[int] = []

    def exchange(self, step, messages):
        """Tell how warm it is here."""
        self.log.append(len(messages["positions"]))
        distance = np.linalg.norm(messages["positions"] - (0, 3, 0), axis=1)
        return (1 / (1 + distance))[:, None]


@pytest.mark.capability("PL-120", "PL-401", "PL-451", "PL-454")
def test_an_environment_of_ones_own_in_few_lines():
    source = (
        "lsystem: seeker\naxiom: A?E(1)\n"
        "p1: A > ?E(w) : w < 0.9 --> F(1)A?E(1)\np2: A > ?E(w) --> B\np3: ?E(w) --> *\nendlsystem\n"
    )
    warmth = Warmth()
    string = bio.environments.derive(bio.LSystem(source), 10, environment=warmth)
    assert string.string() == "F(1)F(1)F(1)B"
    assert warmth.log[:4] == [1, 1, 1, 1]
    assert sum(warmth.log) == 4


def test_what_goes_wrong_in_ones_own_environment_is_told():
    class Broken(Environment):
        def exchange(self, step, messages):
            raise ValueError("no idea")

    system = bio.LSystem("lsystem: x\naxiom: ?E(1)\nZ --> Z\nendlsystem\n")
    with pytest.raises(bio.BioscopeError, match="Broken is gone: ValueError: no idea"):
        bio.environments.derive(system, 1, environment=Broken())


ECHO = """
import struct, sys
source, drain = sys.stdin.buffer, sys.stdout.buffer
while head := source.read(8):
    count, stride = struct.unpack("<2I", head)
    answers = b""
    for _ in range(count):
        (address,) = struct.unpack("<I", source.read(4))
        numbers = struct.unpack(f"<{stride}f", source.read(4 * stride))
        # The distance of the place from the hearth, after the number of parameters and they.
        x, y, z = numbers[stride - 13 : stride - 10]
        far = (x * x + (y - 3) ** 2 + z * z) ** 0.5
        answers += struct.pack("<If", address, 1 / (1 + far))
    source.read(4)
    drain.write(struct.pack("<2I", count, 1) + answers + struct.pack("<I", 0xFFFFFFFF))
    drain.flush()
"""


@pytest.mark.capability("PL-404")
def test_a_program_at_the_other_end_of_a_pipe_gives_the_same(tmp_path: Path):
    source = (
        "lsystem: seeker\naxiom: A?E(1)\n"
        "p1: A > ?E(w) : w < 0.9 --> F(1)[+(50)?E(1)]A?E(1)\nendlsystem\n"
    )
    system = bio.LSystem(source)
    program = tmp_path / "hearth.py"
    program.write_text(ECHO)
    pipe = bio.environments.Pipe([sys.executable, str(program)], seconds=20)
    outside = bio.environments.derive(system, 6, environment=pipe).string()
    assert outside == bio.environments.derive(system, 6, environment=Warmth()).string()
    assert outside.count("F") == 3


def test_programs_that_fail_are_told():
    system = bio.LSystem("lsystem: x\naxiom: ?E(1)\nZ --> Z\nendlsystem\n")
    for command, told in {
        ("sh", "-c", "exit 3"): "is gone",
        ("sh", "-c", "sleep 9"): "has not answered for 0.2 s",
        ("yes",): "answered nonsense",
    }.items():
        seconds = 0.2 if "sleep 9" in command else 5.0
        pipe = bio.environments.Pipe(list(command), seconds)
        with pytest.raises(bio.BioscopeError, match=told):
            bio.environments.derive(system, 1, environment=pipe)
    with pytest.raises(bio.BioscopeError, match="/no/such"):
        bio.environments.Pipe("/no/such/program")


def test_environment_files_of_cpfg_are_read_and_nothing_is_run(tmp_path: Path):
    (tmp_path / "plant.e").write_text(
        "executable: honda81 -e plant.e density.spec\ncommunication type: memory\n"
        "turtle position:P:%.4f %.0f %.4f\n"
    )
    (tmp_path / "density.spec").write_text("verbose: off\nradius:  0.5\n")
    honda = bio.environments.read(tmp_path / "plant.e")
    answers = honda.ask([[0.9], [0.8], [0.9]], [(0, 0, 0), (0.4, 7, 0), (0, 0, 0.6)])
    assert np.ravel(answers).tolist() == [1, 0, 1]
    (tmp_path / "evil.e").write_text("executable: rm -rf /\n")
    with pytest.raises(bio.BioscopeError, match="no such environment is built in"):
        bio.environments.read(tmp_path / "evil.e")
    assert {"chiba", "clover", "takenaka", "density3d"} <= set(bio.environments.names())


def test_settings_that_do_not_exist_are_refused():
    with pytest.raises(bio.BioscopeError, match="no setting 'radios'"):
        bio.environments.Field("honda81", radios=3)
