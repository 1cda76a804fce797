"""Every model of the gallery: what it says of itself, that it grows, and its shape."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery
from bioscope.errors import InvalidValueError, UnknownNameError
from bioscope.lsystem.specimen import palette_beside, portrait

KINDS = {
    "tree": (0.3, 16.0),
    "fern": (0.2, 4.0),
    "grass": (0.3, 9.0),
    "flower": (0.03, 2.5),
    "inflorescence": (0.2, 5.0),
    "vine": (0.5, 4.0),
    "kelp": (0.2, 6.0),
    "coral": (0.3, 2.0),
    "clone": (1.0, 20.0),
    "fractal": (0.3, 2.0),
    "diagram": (0.5, 3.0),
    "example": (1.0, 6.0),
}
OURS = [name for name in gallery.names() if gallery.model(name).source.startswith("ours")]
# These ask their surroundings what they find, or listen to branches; they have tests of their own.
LISTENERS = [
    name
    for name in gallery.names()
    if re.search(r"\?[EP]\(|^context:", gallery.path(name).read_text(), re.M)
]
ALONE = [name for name in gallery.names() if name not in LISTENERS]


@pytest.mark.capability("PL-602")
@pytest.mark.parametrize("name", gallery.names())
def test_a_model_says_what_it_is(name):
    model = gallery.model(name)
    assert model.title
    assert 20 <= len(model.description) <= 100
    assert model.watch
    assert model.kind in {*KINDS, "root", "stand"}
    assert model.architecture or model.kind != "tree"
    assert model.path.with_suffix(".colors").is_file()


@pytest.mark.capability("PL-603")
@pytest.mark.parametrize("name", gallery.names())
def test_every_letter_that_is_rewritten_is_explained(name):
    source = gallery.path(name).read_text(encoding="utf-8")
    rules = source[source.index("axiom:") :].split("homomorphism")[0]
    letters = set()
    for line in rules.splitlines()[1:]:
        if "-->" in line:
            predecessor = re.sub(r"^p\d+\w?:", "", line.split("-->")[0]).split(" : ")[0]
            letters |= set(re.findall(r"[A-Z]", re.sub(r"\(.*?\)", "", predecessor)))
    explained = gallery.model(name).modules
    assert not [one for one in letters if not re.search(rf"(?<![A-Za-z]){one}\b", explained)]


@pytest.mark.parametrize("name", OURS)
def test_parameters_of_our_own_models_are_declared(name):
    declared = gallery.parameters(name)
    assert len(declared) >= 5
    constants = gallery.read(name).constants
    for one in declared:
        assert one.low < one.high
        assert one.low <= one.value <= one.high
        assert one.meaning
        assert constants[one.name] == pytest.approx(one.value)


@pytest.mark.parametrize("name", ALONE)
def test_a_model_grows_to_a_sensible_shape(name):
    system = gallery.read(name)
    assert system.warnings == []
    string = system.derive()
    mesh = bio.Turtle().interpret(string).mesh(palette=palette_beside(gallery.path(name)))
    assert len(string) < 200_000
    assert 100 < len(mesh.triangles) < 400_000
    assert np.isfinite(mesh.positions).all()
    assert np.isfinite(mesh.normals).all()
    size = (mesh.positions.max(axis=0) - mesh.positions.min(axis=0)).max()
    least, most = KINDS[gallery.model(name).kind]
    assert least <= size <= most
    # No plant has one color only, unless it has wilted.
    if gallery.model(name).kind not in ("example", "fractal") and name != "insect":
        assert (mesh.colors != mesh.colors[0]).any()


@pytest.mark.parametrize("name", OURS)
def test_our_own_models_grow_little_by_little(name):
    """A film of growth has neither jumps nor pauses: most of the steps change the shape."""
    system = gallery.read(name)
    steps = np.linspace(1, system.steps, min(8, system.steps)).astype(int)
    turtle = bio.Turtle()
    shapes = [turtle.interpret(system.derive(int(step))).mesh() for step in steps]
    sizes = [
        float(np.ptp(one.positions, axis=0).max()) if len(one.positions) else 0 for one in shapes
    ]
    assert sizes[-1] > 1.3 * sizes[0] or name == "morning_glory"  # its cane is there from the start
    assert len({len(one.triangles) for one in shapes}) + len(set(sizes)) > len(steps)


@pytest.mark.parametrize("name", ["maple", "wheat", "elkhorn_coral"])
def test_no_two_individuals_are_alike(name):
    system = gallery.read(name)
    first, second = (system.derive(seed=seed).string() for seed in (1, 2))
    assert first != second
    assert first == system.derive(seed=1).string()


@pytest.mark.parametrize("name", LISTENERS)
def test_models_that_ask_their_surroundings_are_in_order(name):
    system = gallery.read(name)
    assert system.warnings == []
    assert len(system.derive(2).string()) > 0
    if "?E(" in gallery.path(name).read_text(encoding="utf-8"):
        assert system.environment


def test_a_parameter_changes_the_plant():
    def height(**values):
        mesh = bio.Turtle().interpret(gallery.read("tulip", **values).derive()).mesh()
        return float(mesh.positions[:, 1].max())

    assert height(HEIGHT=0.6) > height(HEIGHT=0.2) + 0.2


def test_what_is_no_parameter_is_refused():
    with pytest.raises(UnknownNameError, match="no parameter 'SPEED'"):
        gallery.text("tulip", SPEED=1)
    with pytest.raises(InvalidValueError, match=r"0.15 to 0.6"):
        gallery.text("tulip", HEIGHT=7)
    with pytest.raises(InvalidValueError):
        gallery.text("tulip", HEIGHT=float("nan"))
    with pytest.raises(UnknownNameError, match="unknown gallery model 'triffid'"):
        gallery.model("triffid")


def test_names_and_files_are_kept_apart(bioscope, tmp_path):
    (tmp_path / "tulip.l").write_text("lsystem: mine\naxiom: A\nA --> AB\nendlsystem\n")
    assert bioscope("derive", "tulip.l", "--steps", 2).stdout == "ABB\n"
    assert "A(2)" in bioscope("derive", "tulip", "--steps", 2).stdout
    assert bioscope("derive", "./tulip.l", "--steps", 1).stdout == "AB\n"
    missing = bioscope("derive", "triffid")
    assert missing.returncode == 1
    assert "unknown plant model 'triffid'" in missing.stderr
    listed = bioscope("list").stdout
    assert all(re.search(rf"^{name} ", listed, re.M) for name in gallery.names())


def test_a_gallery_plant_is_painted(bioscope, tmp_path):
    done = bioscope("grow", "tulip", "-o", "tulip.png")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "tulip.png").read_bytes().startswith(b"\x89PNG")


def test_a_portrait_shows_the_whole_plant():
    mesh = (
        bio.Turtle()
        .interpret(gallery.read("tulip").derive())
        .mesh(palette=palette_beside(gallery.path("tulip")))
    )
    picture = portrait(mesh, 96, 96)[..., :3].astype(int)
    red = (picture[..., 0] > 120) & (picture[..., 1] < 90)
    rows = np.flatnonzero(red.any(axis=1))
    assert len(rows) > 8
    assert rows[0] > 0
    assert rows[-1] < 60


def test_plants_of_a_world_may_come_from_the_gallery():
    world = bio.World(seed=1)
    plants = bio.Plants("daisy", count=3, variants=1)
    world.add(plants, "daisies")
    world.run(seconds=0.1)
    assert len(world.scene.batches) > 0
