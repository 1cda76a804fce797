"""The path tracer: small pictures of plain things, and the choice of a variant that runs."""

import math
import sys

import numpy as np
import pytest

import bioscope as bio
from bioscope import _engine
from bioscope.film import variant as variants
from bioscope.film.focus import focus_distance
from bioscope.film.path import PathRenderer
from bioscope.film.smoothing import smoothed
from bioscope.film.variant import SURE, survives, variant
from bioscope.geometry.ball import ball

pytest.importorskip("mitsuba")

SIZE = (48, 32)


class Things(bio.Population):
    """Shows whatever it is given: name, mesh, material, and keywords of `instances`."""

    transient = ("things", "grains")

    def __init__(self, things, grains=()):
        self.things, self.grains = things, grains

    def publish(self, scene):
        for number, (name, mesh, material, more) in enumerate(self.things):
            places = np.array(more.get("positions", [[0, 0, 0]]), np.float32)
            more = {**more, "positions": places}
            ids = np.arange(len(places), dtype=np.uint32) + 100 * (number + 1)
            scene.instances(name, mesh, material, ids=ids, **more)
        for name, places, radius, more in self.grains:
            places = np.array(places, np.float32)
            radii = np.full(len(places), radius, np.float32)
            ids = np.arange(len(places), dtype=np.uint32) + 900
            scene.points(name, ids=ids, positions=places, radii=radii, **more)


def picture(things, camera, *, surface=None, samples=8, grains=(), **options):
    world = bio.World(seed=1)
    if surface is not None:
        world.environment.water(surface=surface)
        world.environment.set(caustics=0.0)
    world.add(Things(things, grains))
    world.step()
    renderer = PathRenderer(SIZE, samples, mitsuba_variant=SURE, **options)
    return renderer.render(world.scene, camera).astype(int)


def camera(place=(0, 0, 6), target=(0, 0, 0)):
    return _engine.Camera.looking_at(place, target, math.radians(45))


def board(width, height):
    """An upright rectangle that faces +Z."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) / 2
    corners *= np.array([width, height, 1], np.float32)
    uvs = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)
    return bio.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), uvs=uvs)


RED = bio.Material("red", color=[0.8, 0.02, 0.02])
GRAY = bio.Material("gray", color=[0.3, 0.3, 0.3], roughness=1.0)
WHITE = bio.Material("white", color=[0.8, 0.8, 0.8], roughness=1.0)


def test_a_red_ball_in_the_middle_is_red():
    seen = picture([("ball", ball(8, 16), RED, {})], camera())
    assert seen.shape == (32, 48, 3)
    red, green, blue = seen[13:19, 21:27].reshape(-1, 3).mean(axis=0)
    assert red > 100
    assert red > 3 * max(green, blue)
    sky = seen[2, 2]
    assert sky[2] > sky[0]


def test_a_shadow_is_darker_than_the_ground_about_it():
    flat = np.array([[-20, 0, -20], [-20, 0, 20], [20, 0, 20], [20, 0, -20]], np.float32)
    ground = bio.Mesh(flat, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    above = {"positions": [[0, 4, 0]]}
    things = [("ground", ground, GRAY, {}), ("ball", ball(8, 16), WHITE, above)]
    sun = np.array(bio.World(seed=1).scene.sun["direction"])
    across = -sun[[0, 2]] / sun[1] * 4
    spot = _engine.Camera.looking_at(
        (float(across[0]), 2.0, float(across[1]) + 0.01),
        (float(across[0]), 0.0, float(across[1])),
        math.radians(45),
    )
    shadow = picture(things, spot)[12:20, 20:28].mean()
    lit = picture(things[:1], spot)[12:20, 20:28].mean()
    assert shadow < 0.75 * lit
    assert shadow > 10, "the sky still reaches it"


def test_water_takes_red_first_and_more_with_distance():
    wide = board(40, 40)
    means = []
    for distance in (2.0, 12.0):
        far = {"positions": [[0, -3, -distance]], "alive": False}
        view = camera((0, -3, 0), (0, -3, -1))
        seen = picture([("board", wide, WHITE, far)], view, surface=0.0)
        means.append(seen[13:19, 21:27].reshape(-1, 3).mean(axis=0))
    near, far = means
    assert far[0] < 0.4 * near[0]
    assert far[0] < 0.3 * far[2]


def test_deep_water_is_darker():
    wide = board(40, 40)
    means = []
    for depth in (2.0, 20.0):
        there = {"positions": [[0, -depth, -2]], "alive": False}
        view = camera((0, -depth, 0), (0, -depth, -1))
        means.append(picture([("board", wide, WHITE, there)], view, surface=0.0).mean())
    assert means[1] < 0.8 * means[0]


def test_agrees_with_the_preview_on_a_plain_scene():
    things = [("ball", ball(8, 16), WHITE, {"positions": [[0, -3, 0]]})]
    world = bio.World(seed=1)
    world.environment.water(surface=0.0)
    world.environment.set(caustics=0.0, shafts=0.0)
    world.add(Things(things))
    world.step()
    view = camera((0, -3, 6), (0, -3, 0))
    traced = PathRenderer(SIZE, 16, mitsuba_variant=SURE).render(world.scene, view)
    preview = _engine.Rasterizer(picture=True).picture(world.scene, view, *SIZE)
    difference = np.abs(traced.astype(int) - preview.astype(int))
    assert difference.mean() < 12


def test_a_picture_on_a_mesh_is_the_right_way_up():
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[0] = (0, 220, 0)
    pixels[1] = (220, 0, 0)
    pictured = bio.Material("pictured", texture=pixels, color=[1, 1, 1], roughness=1.0)
    seen = picture([("board", board(3, 3), pictured, {})], camera(), depth_of_field=False)
    high, low = seen[9, 24], seen[22, 24]
    assert high[1] > 2 * high[0]
    assert low[0] > 2 * low[1]


def test_vertex_colors_tints_holes_and_instances_show():
    colored = board(2, 2)
    colors = np.tile(np.array([0, 0.7, 0], np.float32), (4, 1))
    colored = bio.Mesh(colored.positions, colored.triangles, colors=colors)
    hole = np.full((2, 2, 4), 255, np.uint8)
    hole[..., 3] = 0
    gone = bio.Material("gone", texture=hole, cutout=True)
    tints = np.array([[1.0, 0.1, 0.1]], np.float32)
    seen = picture(
        [
            ("green", colored, WHITE, {"positions": [[-1.5, 0, 0]]}),
            ("tinted", board(2, 2), WHITE, {"positions": [[1.5, 0, 0]], "tints": tints}),
            ("gone", board(20, 20), gone, {"positions": [[0, 0, 2]]}),
        ],
        camera(),
        depth_of_field=False,
    )
    left, right = seen[14:18, 12:16].mean(axis=(0, 1)), seen[14:18, 32:36].mean(axis=(0, 1))
    assert left[1] > 2 * max(left[0], left[2])
    assert right[0] > 2 * max(right[1], right[2])


def test_many_instances_are_where_the_few_would_be(monkeypatch):
    from bioscope.film import staging

    places = {"positions": [[-1.5, 0, 0], [1.5, 0.5, 0]]}
    things = [("balls", ball(8, 16), RED, places)]
    few = picture(things, camera())
    monkeypatch.setattr(staging, "_MOST_MERGED", 0)
    many = picture(things, camera())
    assert np.abs(few - many).mean() < 2


def test_grains_are_seen():
    grains = [("motes", [[0, 0, 0]], 1.0, {"color": [0.9, 0.1, 0.1], "opacity": 1.0})]
    seen = picture([], camera(), grains=grains)
    assert seen[16, 24, 0] > 2 * seen[16, 24, 2]
    bubbles = [("bubbles", [[0, -3, 0]], 1.0, {"glassy": True})]
    under = camera((0, -3, 6), (0, -3, 0))
    clear = picture([], under, surface=0.0)
    assert np.abs(picture([], under, grains=bubbles, surface=0.0) - clear).max() > 15


def test_bent_bodies_are_drawn_bent():
    rest = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    plain = board(1.5, 1.5)
    jointed = bio.Mesh(
        plain.positions,
        plain.triangles,
        joints=[("one", None, rest)],
        joint_indices=np.zeros((4, 4), np.uint8),
        joint_weights=np.tile(np.array([1, 0, 0, 0], np.float32), (4, 1)),
    )
    pose = np.array([[[1.6, 0, 0, 0, 0, 0, 1]]], np.float32)
    seen = picture([("body", jointed, RED, {"poses": pose})], camera(), depth_of_field=False)
    assert seen[16, 35, 0] > 2 * seen[16, 35, 1]
    assert seen[16, 12, 0] < seen[16, 12, 2]


def test_focus_is_on_what_lives_near_the_middle():
    things = [
        ("fish", ball(), RED, {"positions": [[0, 0, 0]]}),
        ("rock", ball(), WHITE, {"positions": [[0, 0, 4]], "alive": False}),
        ("stray", ball(), RED, {"positions": [[-30, 0, 4]]}),
    ]
    world = bio.World(seed=1)
    world.add(Things(things))
    world.step()
    assert focus_distance(world.scene, camera()) == pytest.approx(6.0, rel=0.05)
    empty = bio.World(seed=1)
    assert focus_distance(empty.scene, camera()) is None


def test_smoothing_takes_noise_and_leaves_edges():
    random = np.random.default_rng(1)
    light = np.ones((40, 40, 3), np.float32)
    light[:, 20:] = 3.0
    noisy = light + random.normal(0, 0.5, light.shape).astype(np.float32)
    normals = np.zeros((40, 40, 3), np.float32)
    normals[:, :20, 0] = normals[:, 20:, 1] = 1.0
    distances = np.ones((40, 40), np.float32)
    result = smoothed(noisy, normals, distances, 3)
    assert np.abs(result - light).mean() < 0.3 * np.abs(noisy - light).mean()


def test_a_fish_eye_is_refused():
    fisheye = _engine.Camera((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 3.0, True)
    with pytest.raises(bio.BioscopeError, match="fish-eye"):
        picture([], fisheye)


def test_a_variant_that_kills_its_process_is_not_used(monkeypatch):
    variant.cache_clear()
    monkeypatch.setattr(variants, "_TRIAL", "import os; os.abort()")
    assert not survives("llvm_ad_rgb")
    assert variant() == SURE
    monkeypatch.setattr(variants, "_TRIAL", "raise ImportError('no such driver')")
    assert not survives("cuda_ad_rgb")
    monkeypatch.setattr(variants, "_TRIAL", "import time; time.sleep(60)")
    monkeypatch.setattr(variants, "_SECONDS", 0.5)
    assert not survives("llvm_ad_rgb")
    variant.cache_clear()


def test_the_trial_passes_where_a_variant_works(monkeypatch):
    assert survives(SURE)
    variant.cache_clear()
    tried = []
    monkeypatch.setattr(variants, "survives", lambda name: tried.append(name) or True)
    assert variant() == "cuda_ad_rgb"
    assert variant() == "cuda_ad_rgb"
    assert tried == ["cuda_ad_rgb"]
    variant.cache_clear()


def test_names_the_extra_if_it_is_missing(monkeypatch):
    variant.cache_clear()
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    monkeypatch.setattr("platform.machine", lambda: "x86_64")
    with pytest.raises(bio.BioscopeError, match=r'pip install "bioscope\[film\]"'):
        PathRenderer(SIZE)
    monkeypatch.setattr("platform.machine", lambda: "aarch64")
    if sys.platform == "linux":
        with pytest.raises(bio.BioscopeError, match="use --renderer preview"):
            PathRenderer(SIZE)
    variant.cache_clear()


def test_the_water_looks_as_in_the_preview():
    flat = np.array([[-20, 0, -20], [-20, 0, 20], [20, 0, 20], [20, 0, -20]], np.float32)
    ground = bio.Mesh(flat, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    world = bio.World(seed=1)
    world.environment.water(surface=4.0)
    world.environment.set(shafts=0.0)
    world.add(Things([("ground", ground, GRAY, {"alive": False})]))
    world.step()
    for place, target in (((0, 2.5, 0.1), (0, 0, 0)), ((0, 1, 0), (0, 1.3, -1))):
        view = _engine.Camera.looking_at(place, target, math.radians(60))
        traced = PathRenderer(SIZE, 16, mitsuba_variant=SURE).render(world.scene, view)
        preview = _engine.Rasterizer(picture=True).picture(world.scene, view, *SIZE)
        one, other = traced.astype(float), preview.astype(float)
        assert np.abs(one - other).mean() < 12
        ripples = np.corrcoef(one[..., 1].ravel(), other[..., 1].ravel())[0, 1]
        assert ripples > 0.8


def test_water_is_as_long_as_the_way_through_a_hole():
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[:, ::2, 3] = 0
    lattice = bio.Material("lattice", texture=pixels, cutout=True)
    holes = np.full((2, 2, 4), 255, np.uint8)
    holes[..., 3] = 0
    nothing = bio.Material("nothing", texture=holes, cutout=True)
    wall = ("wall", board(40, 40), WHITE, {"positions": [[0, -3, -9]], "alive": False})
    before = {"positions": [[0, -3, -2]], "alive": False}
    view = camera((0, -3, 0), (0, -3, -1))
    free = picture([wall], view, surface=0.0)
    through = picture([wall, ("net", board(9, 9), nothing, before)], view, surface=0.0)
    assert np.abs(free - through).mean() < 3
    netted = picture([wall, ("net", board(9, 9), lattice, before)], view, surface=0.0)
    assert np.abs(free - netted).mean() > 5
