"""Where the turtle goes and what it leaves behind, by what the specifications demand."""

import math

import numpy as np
import pytest

import bioscope as bio


def string(word: str, angle: float = 90.0) -> bio.ModuleString:
    """Return the string of one word."""
    source = f"lsystem: word\nangle: {angle}\naxiom: {word}\nZ --> Z\nendlsystem\n"
    return bio.LSystem(source).derive(steps=0)


def draw(word: str, **options) -> bio.Interpretation:
    """Return what one word draws."""
    return bio.Turtle(**options).interpret(string(word))


def ends(word: str, **options) -> np.ndarray:
    """Return the ends of its strokes."""
    return draw(word, **options).segments.end


@pytest.mark.capability("PL-201", "NA-070")
def test_a_million_rotations_leave_the_frame_straight():
    source = (
        "lsystem: turns\naxiom: T(19)[F(1)][+(90)F(1)][^(90)F(1)]\n"
        "T(n) : n > 0 --> T(n-1)T(n-1)\nT(n) : n == 0 --> +(37)&(11)/(73)\nendlsystem\n"
    )
    turned = bio.LSystem(source).derive(steps=20)
    assert len(turned) > 1_000_000
    probe = bio.Turtle().interpret(turned).segments.end
    assert np.abs(probe @ probe.T - np.eye(3)).max() < 1e-6
    assert np.allclose(np.cross(probe[0], probe[1]), probe[2], atol=1e-6)


@pytest.mark.capability("PL-203")
def test_turns_have_the_signs_of_the_source():
    for word, expected in {
        "F(2)": (0, 2, 0),
        "+(90)F(1)": (-1, 0, 0),
        "-(90)F(1)": (1, 0, 0),
        "&(90)F(1)": (0, 0, -1),
        "^(90)F(1)": (0, 0, 1),
        "/(90)+(90)F(1)": (0, 0, -1),
        "\\(90)+(90)F(1)": (0, 0, 1),
        "|F(1)": (0, -1, 0),
    }.items():
        assert np.allclose(ends(word)[-1], expected, atol=1e-6), word


@pytest.mark.capability("PL-204", "NA-035")
def test_brackets_bring_back_the_whole_state_bit_by_bit():
    plain = draw("+(33)&(7)!(0.3);(4)F(1)F(1)").segments
    branched = draw("+(33)&(7)!(0.3);(4)F(1)[/(3)+(50)!(2);(6)F(3)[&(1)F]]F(1)").segments
    assert branched.end[-1].tobytes() == plain.end[-1].tobytes()
    assert branched.radii[-1].tobytes() == plain.radii[-1].tobytes()
    assert branched.color[-1] == plain.color[-1]


@pytest.mark.capability("PL-202")
def test_strokes_balls_and_discs():
    drawn = draw("F(2)f(1)F(1)@O(0.25)+(90)f(3)@o(0.5)@c(0.75)")
    assert len(drawn.segments.end) == 2
    assert np.allclose(drawn.segments.start[1], (0, 3, 0))
    assert drawn.balls.radius.tolist() == [0.25]
    assert np.allclose(drawn.balls.center, [[0, 4, 0]])
    assert drawn.discs.radius.tolist() == [0.5, 0.75]
    assert np.allclose(np.abs(drawn.discs.normal), [[0, 0, 1], [0, 0, 1]], atol=1e-6)


@pytest.mark.capability("PL-205", "NA-036")
def test_polygons_have_the_area_of_the_turtles_walk():
    drawn = draw("{.f(3)+f(2)+f(3)}")
    ((corners, _),) = drawn.polygons
    assert len(corners) == 4
    mesh = drawn.mesh()
    a, b, c = (mesh.positions[mesh.triangles[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(6.0, rel=1e-5)


@pytest.mark.capability("PL-207")
def test_a_flat_grid_of_control_points_tessellates_to_a_plane():
    points = "".join(
        f"[+f({column})-f({row})@PC(1,{row},{column})]" for row in range(4) for column in range(4)
    )
    for basis in (1, 2, 3):
        drawn = draw(f"@PS(1,{basis}){points}@PD(1,5,7)")
        mesh = drawn.mesh()
        assert len(mesh.triangles) == 2 * 5 * 7
        assert np.abs(mesh.positions[:, 2]).max() < 1e-6
        assert np.abs(mesh.normals[:, 2]).min() > 0.999
    assert drawn.patches.points.shape == (1, 16, 3)


@pytest.mark.capability("PL-208")
def test_widths_and_colors_are_set_and_stepped():
    options = {"width": 1.0, "width_step": 0.25, "color": 3, "color_step": 2}
    segments = draw("F!F#F#(4)F;F,F;(7)F", **options).segments
    assert (2 * segments.radii[:, 1]).tolist() == [1.0, 0.75, 1.0, 4.0, 4.0, 4.0, 4.0]
    assert segments.color.tolist() == [3, 3, 3, 3, 5, 3, 7]


@pytest.mark.capability("PL-210")
def test_the_default_angle_changes_every_bare_turn():
    for angle in (10.0, 30.0, 77.0):
        end = bio.Turtle().interpret(string("+F(1)", angle)).segments.end[0]
        assert np.allclose(end, (-math.sin(math.radians(angle)), math.cos(math.radians(angle)), 0))


@pytest.mark.capability("PL-211")
def test_bent_tapering_cylinders_have_no_cracks():
    stem = "!(0.4)F+(20)!(0.3)F&(30)!(0.3)F/(50)+(40)!(0.2)F!(0.1)F"
    mesh = draw(stem).mesh(sides=12)
    _, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    triangles = place.reshape(-1)[mesh.triangles]
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forward = {tuple(edge) for edge in edges.tolist()}
    assert len(forward) == len(edges)
    assert all((b, a) in forward for a, b in forward)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-4)


def test_axes_over_control_points_are_smooth():
    word = "!(1)@Gs+(40)f(2)@Gc(8)+(40)!(0.5)f(2)@Ge(8)"
    segments = draw(word, cpfg=True).segments
    assert len(segments.end) == 16
    way = segments.end - segments.start
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    bends = np.degrees(np.arccos(np.clip((way[1:] * way[:-1]).sum(axis=1), -1, 1)))
    assert bends.max() < 25
    assert segments.radii[0, 0] == pytest.approx(0.5)
    assert segments.radii[-1, 1] == pytest.approx(0.25)


def test_cpfg_means_diameters_and_tapers_to_the_next_width():
    drawn = draw("!(2)F(1)!(1)F(1)@O(3)", cpfg=True)
    assert np.allclose(drawn.segments.radii, [[1, 0.5], [0.5, 0.5]])
    assert drawn.balls.radius.tolist() == [1.5]


def test_tropism_turns_the_way_towards_its_direction():
    word = "+(60)@Td(0,-1,0)@Ts(0.2)" + "F(0.1)" * 40
    segments = draw(word).segments
    way = segments.end - segments.start
    assert way[-1][1] / np.linalg.norm(way[-1]) < -0.99


@pytest.mark.capability("PL-206", "PL-306")
def test_the_stylised_flower_has_its_parts_and_fivefold_symmetry():
    flower = bio.LSystem(
        "lsystem: L08_flower\nderivation length: 3\nangle: 18\naxiom: /(154)B\n"
        "p1: B --> [&(72)#F(5)!P]\np2: P --> [S/(72)S/(72)S/(72)S/(72)S]\n"
        "p3: S --> [^(103)~s][^(72)~p][^(34)F(1)#[-F(1)][+F(1)]]\nendlsystem\n"
    )
    drawn = bio.Turtle().interpret(flower.derive())
    names = [name for name, *_ in drawn.surfaces]
    assert (names.count("s"), names.count("p")) == (5, 5)
    assert len(drawn.segments.end) == 16
    stalk = drawn.segments.end[0]
    axis = stalk / np.linalg.norm(stalk)
    tips = drawn.segments.end[1:].reshape(5, 3, 3) - stalk
    around = math.radians(72)
    for sector in range(5):
        turned = (
            tips[sector] * math.cos(around)
            + np.cross(axis, tips[sector]) * math.sin(around)
            + axis * (tips[sector] @ axis)[:, None] * (1 - math.cos(around))
        )
        nearest = min(np.abs(turned - tips[other]).max() for other in range(5))
        assert nearest < 1e-5


def test_unknown_options_and_sides_are_refused():
    with pytest.raises(bio.BioscopeError, match="unknown turtle option"):
        draw("F", colour=3)
    with pytest.raises(bio.BioscopeError, match="3 to 64"):
        draw("F").mesh(sides=2)


def test_balls_are_round_and_closed():
    text = "axiom: A\nA --> f(2)@O(1.5)[+(90)f(4)@O(0.5)]"
    drawn = bio.Turtle().interpret(bio.LSystem(text, "balls.l").derive(1))
    mesh = drawn.mesh()
    for center, radius in [((0, 2, 0), 1.5), ((-4, 2, 0), 0.5)]:
        away = np.linalg.norm(mesh.positions - center, axis=1)
        own = away < 2 * radius
        assert away[own] == pytest.approx(radius, rel=0.02)
        corners = mesh.positions - center
        a, b, c = (corners[mesh.triangles[own[mesh.triangles[:, 0]], at]] for at in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        # An inscribed polyhedron that is nearly the ball, and closed.
        assert 0.9 < volume / (4 / 3 * np.pi * radius**3) < 1
        outward = np.einsum("ij,ij->i", mesh.normals[own], corners[own] / away[own, None])
        # All but the tiny caps at the poles looks smooth.
        assert outward.min() > 0.7
        assert np.median(outward) > 0.97
