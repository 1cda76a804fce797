"""A species of one's own: from an empty folder to a plant that meets its pictures."""

import numpy as np
import pytest

from bioscope import _engine, gallery
from bioscope.lsystem.species import overlap, silhouette_of_picture

AGES = (8, 16, 30)
WIDTH, HEIGHT, GROUND = 400, 420, 400
"""Pixels of a drawing, a millimetre each, and the row of the ground."""

TULIP = """/* Tulip: three leaves, then a stalk with a flower; measured in the drawings of the test.

   kind          flower
   source        ours, after drawings
   watch         leaves first, then the stalk
   modules       A(n,t) tip;  L(n,t) leaf;  S(t) stalk;  K(t) flower
   colors        1 stalk, 2 leaf, 3 petal
   metres; one step is one day; base at the origin */

lsystem: tulip
derivation length: 30
#define LEAVES 3
#define PAUSE 4
#define STALK 0.26
#define FLOWER 0.075
#define grown(t,d) (1-exp(-3*(t)/(d)))
array LENGTH[3] = {0.17, 0.19, 0.15}
array BREADTH[3] = {0.045, 0.05, 0.04}
array LEAN[3] = {28, -31, 13}
axiom: [L(0,0)]A(1,0)
p1: A(n,t) : t < PAUSE-1 --> A(n,t+1)
p2: A(n,t) : n < LEAVES --> [L(n,0)]A(n+1,0)
p3: A(n,t) --> S(0)
p4: L(n,t) --> L(n,t+1)
p5: S(t) --> S(t+1)

homomorphism
maximum depth: 2
L(n,t) : t > 0 { g = grown(t,9); } -->
   ;(2)+(LEAN[n]*(0.4+0.6*g))~l(BREADTH[n]/0.41*g,LENGTH[n]*g,0.02)
S(t) : t > 0 --> ;(1)!(0.008)G(STALK*grown(t,10))K(t-5)
K(t) : t > 0 { g = grown(t,8); } --> ;(3)petal(14*g)petal(0)petal(-14*g)
endlsystem
""".replace(
    "petal(14*g)petal(0)petal(-14*g)",
    "".join(f"[+({lean}*g)~l(0.04/0.41*g,FLOWER*g,0.01)]" for lean in (14, 0, -14)),
)


def grown(days: float, time: float) -> float:
    """Return how much of its size an organ has at this age, in the drawings."""
    return 0.0 if days <= 0 else 1 - float(np.exp(-3 * days / time))


def blade(foot: float, degrees: float, length: float, breadth: float) -> np.ndarray:
    """Draw the outline of a leaf: two arcs that meet at its ends; metres."""
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    x, y = (columns - WIDTH / 2) / 1000, (GROUND - rows) / 1000 - foot
    turn = np.radians(degrees)
    along, across = x * np.sin(turn) + y * np.cos(turn), x * np.cos(turn) - y * np.sin(turn)
    share = np.clip(along / max(length, 1e-9), 0, 1)
    return (along >= 0) & (along <= length) & (abs(across) <= 2 * breadth * share * (1 - share))


def drawing(age: int) -> np.ndarray:
    """Draw a tulip with a pencil, not with a turtle: which pixels it covers."""
    tulip = np.zeros((HEIGHT, WIDTH), bool)
    for number, (lean, long, broad) in enumerate([(-28, 170, 45), (31, 190, 50), (-13, 150, 40)]):
        size = grown(age - 4 * number, 9)
        lean_now = lean * (0.4 + 0.6 * size)
        tulip |= blade(0, lean_now, size * long / 1000, size * broad / 1000)
    stalk = 0.26 * grown(age - 12, 10)
    tulip[GROUND - round(stalk * 1000) : GROUND, WIDTH // 2 - 4 : WIDTH // 2 + 4] = True
    size = grown(age - 17, 8)
    for lean in (-14, 0, 14):
        tulip |= blade(stalk, lean * size, 0.075 * size, 0.04 * size)
    return tulip


def photograph(covered: np.ndarray) -> bytes:
    """Return a picture of the drawing in green before a grainy pale wall."""
    random = np.random.default_rng(4)
    pixels = random.integers(205, 235, (*covered.shape, 3)).astype(np.uint8)
    pixels[covered] = random.integers(40, 90, (int(covered.sum()), 3)) + np.array([0, 40, 0])
    return _engine.encode_png(pixels)


@pytest.fixture
def folder(bioscope, tmp_path):
    done = bioscope("new", "species", "tulip_of_mine")
    assert done.returncode == 0, done.stderr
    made = tmp_path / "tulip_of_mine"
    for age in AGES:
        (made / "photographs" / f"{age}.png").write_bytes(photograph(drawing(age)))
    return made


def overlaps(output: str) -> dict[int, float]:
    rows = [line.split("\t") for line in output.splitlines()]
    return {int(age): float(share) for age, share in rows}


@pytest.mark.capability("PL-617")
def test_the_template_grows_as_it_is(bioscope, tmp_path):
    assert bioscope("new", "species", "herb").returncode == 0
    files = {str(path.relative_to(tmp_path / "herb")) for path in (tmp_path / "herb").rglob("*.*")}
    assert files == {"README.md", "herb.colors", "herb.lsys", "photographs/README.md"}
    model = tmp_path / "herb" / "herb.lsys"
    checked = bioscope("derive", model, "--check")
    assert "no doubtful places" in checked.stderr
    picture = bioscope("grow", model, "-o", "herb.png")
    assert picture.returncode == 0, picture.stderr
    again = bioscope("new", "species", "herb")
    assert again.returncode == 1
    assert "nothing was written" in again.stderr
    assert bioscope("new", "species", "../herb").returncode == 1


@pytest.mark.capability("PL-617")
def test_a_measured_species_meets_its_pictures_at_three_ages(bioscope, folder):
    (folder / "tulip_of_mine.lsys").write_text(TULIP)
    done = bioscope("compare", folder, "-o", "sheet.png")
    assert done.returncode == 0, done.stderr
    found = overlaps(done.stdout)
    assert tuple(found) == AGES
    assert min(found.values()) >= 0.7, found
    sheet = _engine.decode_png((folder.parent / "sheet.png").read_bytes())
    assert len(np.unique(sheet.reshape(-1, 4), axis=0)) == 4


@pytest.mark.capability("PL-617")
def test_another_species_does_not(bioscope, folder):
    first = overlaps(bioscope("compare", folder).stdout)
    assert np.mean(list(first.values())) < 0.6, "the template is no tulip yet"
    (folder / "tulip_of_mine.lsys").write_text(gallery.text("basitonic"))
    other = overlaps(bioscope("compare", folder).stdout)
    assert max(other.values()) < 0.6


def test_true_heights_are_compared_where_they_are_told(bioscope, folder):
    (folder / "tulip_of_mine.lsys").write_text(TULIP.replace("STALK 0.26", "STALK 0.60"))
    for age in AGES:
        (folder / "photographs" / f"{age}.png").unlink()
    rows = np.flatnonzero(drawing(30).any(axis=1))
    height = (rows[-1] - rows[0] + 1) / 1000
    name = f"30-{height:.3f}m.png"
    (folder / "photographs" / name).write_bytes(photograph(drawing(30)))
    too_high = overlaps(bioscope("compare", folder).stdout)[30]
    (folder / "tulip_of_mine.lsys").write_text(TULIP)
    assert overlaps(bioscope("compare", folder).stdout)[30] >= 0.7 > too_high


def test_pictures_that_cannot_be_used_are_told(bioscope, folder):
    (folder / "photographs" / "young.png").write_bytes(photograph(drawing(8)))
    done = bioscope("compare", folder)
    assert done.returncode == 1
    assert "tells the age" in done.stderr
    (folder / "photographs" / "young.png").unlink()
    (folder / "photographs" / "8.png").write_bytes(b"\x89PNG\r\n\x1a\nnothing")
    broken = bioscope("compare", folder)
    assert broken.returncode == 1
    assert "picture" in broken.stderr


def test_outlines_overlap_as_they_should():
    shape = drawing(16)
    cut = np.full((*shape.shape, 4), 255, np.uint8)
    cut[~shape, 3] = 0
    assert np.array_equal(silhouette_of_picture(cut), shape)
    assert overlap(shape, shape) == 1.0
    assert overlap(shape, np.ones((40, 40), bool)) < 0.7
