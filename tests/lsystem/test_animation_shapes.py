"""Shapes that the turtle of an animation draws: bounds, surfaces, set pieces, files of surfaces."""

from collections import Counter

import numpy as np
import pytest
from definitions import LINE, NONE, TURNS, animation, text

import bioscope as bio
from bioscope.errors import FormatError
from bioscope.lsystem import Animation
from bioscope.lsystem.animation import Source


@pytest.mark.capability("NA-073", "NA-074")
def test_shapes_have_bounds_ends_and_resolution():
    ends = {"c": 2, "d": 2, "p": 2, "q": 2, "O": 2, "N": 2, "o": 2, "P": 2, "Q": 2, "a": 0, "s": 0}
    bounds = {
        "c": ((0, -1.5, -2), (2, 1.5, 2)),
        "p": ((0, -1.5, -2), (2, 1.5, 2)),
        "s": ((-1, -1.5, -2), (1, 1.5, 2)),
        "a": ((-1, -1, -1), (1, 1, 1)),
        "o": ((0, -1.5, -2), (2, 1.5, 2)),
        "O": ((-1.75, -1.5, -2), (3.75, 1.5, 2)),
        "P": ((-1.5, -2, -2), (4, 2, 2)),
    }
    for symbol, end in ends.items():
        made = animation("n () (64) () () () () ()", f"{symbol} () () () () (2) (3) (4)", LINE)
        assert made.frame.lines[0].start == pytest.approx((end, 0, 0)), symbol
        low, high = bounds[{"d": "c", "q": "p", "N": "O", "Q": "P"}.get(symbol, symbol)]
        corners = np.array(made.frame.pieces[0].corners)
        assert corners.min(axis=0) == pytest.approx(low, abs=1e-2), symbol
        assert corners.max(axis=0) == pytest.approx(high, abs=1e-2), symbol
        sides = edges(made.frame.pieces[0].triangles())
        if symbol != "o":
            assert all(sides[b, a] == 1 for a, b in sides), symbol
            assert volume(made.frame.pieces[0]) > 0, symbol
    for symbol in "ONPQas":
        counts = [
            len(
                animation(f"n () {n} () () () () ()", f"{symbol} () () () () (2) (3) (4)")
                .frame.pieces[0]
                .triangles()
            )
            for n in ("(2)", "(3)", "(10)", "(20)")
        ]
        assert counts[0] == counts[1] < counts[2] < counts[3], symbol
    plain = animation("a () () () () (2) () ()").frame.pieces[0]
    ten = animation("n () (10) () () () () ()", "a () () () () (2) () ()").frame.pieces[0]
    assert len(plain.triangles()) == len(ten.triangles())


def edges(triangles: list[tuple[int, int, int]]) -> Counter:
    """Return how often each directed edge occurs."""
    return Counter((one[at], one[(at + 1) % 3]) for one in triangles for at in range(3))


def volume(piece) -> float:
    corners = [np.array(one) for one in piece.corners]
    return (
        sum(
            float(np.dot(corners[a], np.cross(corners[b], corners[c])))
            for a, b, c in piece.triangles()
        )
        / 6
    )


OUTLINE = [(0, 0), (4, 0), (4, 3), (2, 1), (0, 3)]
"""A polygon with a notch, in the plane of heading and left."""


def outlined(closing: str) -> list:
    corners = "\n".join(f"f () () () (2) ({x}) ({y}) ()\n. {NONE}" for x, y in OUTLINE)
    return animation("{ " + NONE, corners, f"}} {closing}").frame.pieces


@pytest.mark.capability("NA-081", "NA-036")
def test_polygons_are_flipped_doubled_and_closed():
    area = 4 * 3 - 4 * 2 / 2
    (flat,) = outlined("() () () () () () ()")
    assert flat.corners == [(x, y, 0) for x, y in OUTLINE]
    turned = lambda piece: sum(  # noqa: E731
        np.cross(*(np.subtract(piece.corners[one], piece.corners[a]) for one in (b, c)))[2] / 2
        for a, b, c in piece.triangles()
    )
    assert turned(flat) == pytest.approx(area)
    (flipped,) = outlined("() (1) () () () () ()")
    assert turned(flipped) == pytest.approx(-area)
    (twin,) = outlined("() () (1) () (0.5) () ()")
    assert sorted({corner[2] for corner in twin.corners}) == [0, 0.5]
    assert turned(twin) == pytest.approx(0)
    assert len(twin.triangles()) == 2 * len(flat.triangles())
    # Closed by side faces: every edge has its counterpart, and Euler's 2 comes out.
    for distance, inward in [("0.5", True), ("0.5_", False)]:
        (closed,) = outlined(f"() () (1) (1) ({distance}) () ()")
        sides = edges(closed.triangles())
        assert all(count == 1 and sides[b, a] == 1 for (a, b), count in sides.items())
        assert len(closed.corners) - len(sides) // 2 + len(closed.triangles()) == 2
        assert volume(closed) == pytest.approx(-area / 2 if inward else area / 2)
    # Rimmed by cylinders that reach from one to the other.
    first, *rims = outlined("() () (1) (3) (0.5) () ()")
    assert len(rims) == len(OUTLINE)
    assert len(first.triangles()) == len(twin.triangles())
    heights = np.array([corner for rim in rims for corner in rim.corners])[:, 2]
    assert heights.min() == pytest.approx(0, abs=0.02)
    assert heights.max() == pytest.approx(0.5, abs=0.02)
    # Nested surfaces.
    inner = "\n".join(f"f () () () (2) ({x}) () ({x}'5*)\n. {NONE}" for x in (1, 2, 3))
    nested = animation(
        "{ " + NONE,
        f". {NONE}",
        "{ " + NONE,
        inner,
        "} " + NONE,
        f"f () () () (2) (9) (1) ()\n. {NONE}",
        f"f () () () (2) (9) () ()\n. {NONE}",
        "} " + NONE,
    ).frame.pieces
    assert [len(one.corners) for one in nested] == [3, 3]
    assert nested[0].corners[2] == (3, 0, 15)
    assert nested[1].corners == [(0, 0, 0), (9, 1, 0), (9, 0, 0)]


@pytest.mark.capability("NA-078")
def test_set_pieces():
    (ground,) = animation("D () (2) () () (1.5) () ()").frame.pieces
    corners = np.array(ground.corners)
    assert corners.min(axis=0).tolist() == [-1000, 1.5, -1000]
    assert corners.max(axis=0).tolist() == [1000, 1.5, 1000]
    a, b, c = (corners[one] for one in ground.triangles()[0])
    assert np.cross(b - a, c - a)[1] > 0
    (square,) = animation("f () () () (2) (5) (6) (7)", "D () (3) () () (4) (2) ()").frame.pieces
    corners = np.array(square.corners)
    assert corners.min(axis=0).tolist() == [3, 2, 5]
    assert corners.max(axis=0).tolist() == [7, 2, 9]
    court = {
        one.material.name: np.array(one.corners)
        for one in animation(f"D () (41) {NONE[6:]}").frame.pieces
    }
    length, doubles = 23.77, 10.97
    assert np.ptp(court["green"], axis=0) == pytest.approx((length, 0, doubles))
    assert court["green"].mean(axis=0) == pytest.approx((0, 0, 0))
    # The net stands in the plane x = 0, 0.91 m high.
    assert np.ptp(court["grey1"], axis=0) == pytest.approx((0, 0.91, doubles))
    assert court["grey1"][:, 0].tolist() == [0] * 4
    lines = court["white"].reshape(-1, 4, 3)
    found = {tuple(strip.mean(axis=0).round(3)[[0, 2]]) for strip in lines}
    for place in [(0, 4.115), (0, -4.115), (6.4, 0), (-6.4, 0), (11.885, 0), (0, 5.485), (0, 0)]:
        assert place in found
    assert all(not one.material.lit for one in animation("D () (41) () () () () ()").frame.pieces)
    surrounded = animation("D () (41) (1) () () () ()").frame.pieces
    assert {one.material.name for one in surrounded} == {"green", "white", "grey1", "gray"}


@pytest.mark.capability("NA-079")
def test_a_box_around_what_was_drawn(tmp_path):
    symbols = [
        "s () () () () (9) (9) (9)",
        "D () (20) () () () () ()",
        TURNS,
        "c () () () () (2) (3) (0.4)",
        "a () () () () (1.7) () ()",
        LINE,
        "D () (21) () () () () ()",
        "s () () () () (9) (9) (9)",
    ]
    made = animation(*symbols)
    drawn = [*made.frame.pieces[1].corners, *made.frame.pieces[2].corners]
    drawn += [made.frame.lines[0].start, made.frame.lines[0].end]
    made.write(tmp_path)
    (path,) = tmp_path.glob("*.lm")
    assert path.name == "box1.0000.lm"
    low, high = Animation.read(path).frame.bounds()
    assert low == pytest.approx(np.min(drawn, axis=0), abs=1e-6)
    assert high == pytest.approx(np.max(drawn, axis=0), abs=1e-6)
    # A plant of the other reading, too.
    string = bio.LSystem.read(path).derive(0)
    corners = np.vstack([one for one, _ in bio.Turtle().interpret(string).polygons])
    assert corners.min(axis=0) == pytest.approx(low, abs=1e-5)
    assert animation("D () (21) () () () () ()").remarks


@pytest.mark.capability("NA-080")
def test_surfaces_are_imported_and_the_scene_exported(tmp_path):
    (tmp_path / "rock.sm").write_text("SM 4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 2 1\n0 1 3\n0 3 2\n")
    head = "Surfaces\nfig_sm 7 rock.sm"
    symbols = ["f () () () (2) (5) () ()", "B () (7) () () (2) (3) (4)", LINE]
    made = Animation(Source(text(*symbols, head=head), "a.lm", tmp_path))
    assert made.frame.bounds() == ((5, 0, 0), (7, 3, 4))
    assert len(made.frame.pieces[0].triangles()) == 3
    # Its corners are those of the file, and it moves nothing.
    assert made.frame.pieces[0].corners == [(5, 0, 0), (7, 0, 0), (5, 3, 0), (5, 0, 4)]
    assert made.frame.lines[0].start == (5, 0, 0)
    # The whole scene of frame 10, as one surface that can be imported again.
    scene = text(TURNS, "c () () () () (T10*) (2) (3)", "a () () () () (2) () ()", head="Splines\n")
    first = Animation(scene)
    first.run(seconds=0.4)
    assert first.frame.number == 10
    (tmp_path / "rock.sm").write_text(first.surface())
    second = Animation(Source(text("B () (7) () () (1) (1) (1)", head=head), "a.lm", tmp_path))
    expected = sum(len(one.triangles()) for one in first.frame.pieces)
    assert len(second.frame.pieces[0].triangles()) == expected
    assert np.array(second.frame.bounds()) == pytest.approx(
        np.array(first.frame.bounds()), abs=1e-6
    )
    with pytest.raises(FormatError, match="there is no file"):
        Animation(Source(text("B " + NONE, head="Surfaces\nfig_sm 1 no.sm"), "a.lm", tmp_path))
