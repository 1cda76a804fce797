"""Binary glTF: what was in the world is in the file, for Khronos' validator and for three.js."""

import json
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from lagoon import Blob, Gliders, Motes, Reeds, Stones, make

import bioscope as bio
from bioscope.export import export_world
from bioscope.geometry.skinning import bent

RATE = 24
HERE = Path(__file__).parent
WEB = HERE.parent.parent / "web"
QUIET = {"say": lambda _: None}

needs_node = pytest.mark.skipif(
    shutil.which("node") is None or not (WEB / "node_modules" / "gltf-validator").is_dir(),
    reason="needs node and the page's packages: make setup",
)


def exported(path, seconds, *kinds):
    export_world(make(*kinds), path, seconds, RATE, **QUIET)
    return path


def node(script, *arguments):
    command = ["node", str(HERE / script), str(WEB), *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def scene_at(frame, *kinds):
    world = make(*kinds)
    world.step(2 * frame)
    return {one.name: one for one in [*world.scene.batches, *world.scene.points]}


class Glb:
    """A file taken apart."""

    types = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20 : 20 + size])
        self.bytes = data[28 + size :]

    def numbers(self, accessor):
        entry = self.json["accessors"][accessor]
        view = self.json["bufferViews"][entry["bufferView"]]
        width = self.widths[entry["type"]]
        dtype = self.types[entry["componentType"]]
        values = np.frombuffer(self.bytes, dtype, entry["count"] * width, view["byteOffset"])
        return values.reshape(-1, width)

    def nodes(self, name):
        """The nodes of a batch's individuals by their ids."""
        group = next(one for one in self.json["nodes"] if one.get("name") == name)
        nodes = [(number, self.json["nodes"][number]) for number in group["children"]]
        return {one["extras"]["id"]: (number, one) for number, one in nodes}

    def track(self, number, path):
        """Times and values of a node's channel; none if it stays."""
        animation = self.json["animations"][0]
        for channel in animation["channels"]:
            if channel["target"] == {"node": number, "path": path}:
                sampler = animation["samplers"][channel["sampler"]]
                return self.numbers(sampler["input"])[:, 0], self.numbers(sampler["output"])
        return None


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    return exported(tmp_path_factory.mktemp("glb") / "small.glb", 1.0)


@needs_node
def test_the_validator_finds_nothing_to_say(small):
    report = node("validate_glb.mjs", small)
    assert report["issues"]["messages"] == []
    assert report["info"]["hasSkins"]
    assert report["info"]["hasMorphTargets"]
    assert report["info"]["hasTextures"]


def test_nothing_is_required(small):
    document = Glb(small).json
    assert "extensionsRequired" not in document
    assert document["extensionsUsed"] == ["KHR_lights_punctual", "KHR_materials_ior"]


@pytest.mark.parametrize("name", ["gliders", "motes"])
def test_moving_things_are_nodes_that_come_and_go(small, name):
    file = Glb(small)
    nodes = file.nodes(name)
    for frame in (0, 10, 13, 24):
        there = scene_at(frame)[name]
        shown = []
        for one, (number, entry) in nodes.items():
            times, scales = file.track(number, "scale") or ([0.0], [entry.get("scale", [1.0] * 3)])
            now = np.searchsorted(times, frame / RATE + 1e-4, "right") - 1
            if scales[now][0] > 0:
                shown.append(one)
        assert sorted(shown) == sorted(there.ids.tolist()), frame
        for one, place in zip(there.ids.tolist(), there.positions, strict=True):
            number, entry = nodes[one]
            track = file.track(number, "translation")
            found = entry.get("translation", [0.0] * 3) if track is None else track[1][frame]
            np.testing.assert_allclose(found, place, atol=1e-6)


def test_what_stays_has_no_channels(small):
    file = Glb(small)
    for number, _ in file.nodes("stones").values():
        assert all(
            file.track(number, path) is None for path in ("translation", "rotation", "scale")
        )
    for number, entry in file.nodes("reeds").values():
        assert all(
            file.track(number, path) is None for path in ("translation", "rotation", "scale")
        )
        [root] = entry["children"]
        [tip] = file.json["nodes"][root]["children"]
        assert file.track(tip, "rotation") is not None
        assert file.track(tip, "translation") is None


def test_tints_are_materials_on_shared_geometry(small):
    file = Glb(small)
    meshes = [file.json["meshes"][entry["mesh"]] for _, entry in file.nodes("stones").values()]
    primitives = [mesh["primitives"][0] for mesh in meshes]
    assert len({json.dumps(one["attributes"]) for one in primitives}) == 1
    colors = [
        file.json["materials"][one["material"]]["pbrMetallicRoughness"]["baseColorFactor"]
        for one in primitives
    ]
    expected = [[0.8, 0.8, 0.8], [0.4, 0.8, 0.8], [0.8, 0.4, 0.8], [0.8] * 3, [0.8] * 3]
    np.testing.assert_allclose(np.array(colors)[:, :3], expected, atol=1e-6)


@needs_node
def test_threejs_sees_the_bodies_bend(tmp_path):
    kinds = (Reeds, Blob, Motes)
    path = exported(tmp_path / "bodies.glb", 1.0, *kinds)
    frame = 12
    found = node("read_glb.mjs", path, frame / RATE)
    truth = scene_at(frame, *kinds)
    reeds = truth["reeds"]
    seen = sorted((one for one in found if "body" in one["name"]), key=lambda one: one["name"])
    assert len(seen) == len(reeds.ids)
    for index, one in enumerate(seen):
        expected, _ = bent(reeds.mesh, reeds.poses[index])
        np.testing.assert_allclose(one["vertices"], expected + reeds.positions[index], atol=1e-4)
    [blob] = [one for one in found if one["parent"] == "blob1"]
    expected = truth["blob/1"].mesh.positions + truth["blob/1"].positions[0]
    np.testing.assert_allclose(blob["vertices"], expected, atol=1e-3)
    motes = [one for one in found if one["parent"] == "motes"]
    motes = [one for one in motes if np.ptp(one["vertices"], axis=0).max() > 1e-3]
    assert sorted(one["id"] for one in motes) == sorted(truth["motes"].ids.tolist())


class Pebbles(Stones):
    """So many that they are instanced by the extension, over an area of several cells."""

    count = 300

    def publish(self, scene):
        across = np.arange(self.count, dtype=np.float32)
        places = np.stack([across % 20 * 2, across * 0, across // 20 * 2], axis=1)
        turned = np.tile(np.array([0, 0.6, 0, 0.8], np.float32), (self.count, 1))
        if not hasattr(self, "mesh"):
            corners = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], np.float32)
            self.mesh = bio.Mesh(corners, np.array([[0, 2, 1]], np.uint32))
            self.material = bio.Material("pebble")
        scene.instances(
            "pebbles", self.mesh, self.material, ids=self.ids, positions=places, rotations=turned
        )


@needs_node
def test_great_numbers_are_instanced_and_one_of_each_cell_shows_without_the_extension(tmp_path):
    path = exported(tmp_path / "pebbles.glb", 0.1, Pebbles)
    report = node("validate_glb.mjs", path)
    assert (report["issues"]["numErrors"], report["issues"]["numWarnings"]) == (0, 0)
    document = Glb(path).json
    assert "EXT_mesh_gpu_instancing" in document["extensionsUsed"]
    assert "extensionsRequired" not in document
    truth = scene_at(0, Pebbles)["pebbles"]
    cells = [one for one in document["nodes"] if "EXT_mesh_gpu_instancing" in str(one)]
    assert len(cells) == 6
    places = dict(zip(truth.ids.tolist(), truth.positions.tolist(), strict=True))
    ids = []
    for cell in cells:
        first = cell["extras"]["ids"][0]
        np.testing.assert_allclose(cell.get("translation", [0, 0, 0]), places[first], atol=1e-6)
        ids += cell["extras"]["ids"]
    assert sorted(ids) == sorted(truth.ids.tolist())
    seen = [one for one in node("read_glb.mjs", path, 0) if one["parent"] == "pebbles"]
    assert sum(one["instances"] for one in seen) == 300


def test_a_jointed_vertex_never_names_a_joint_twice():
    from bioscope.export.gltf.meshes import bindings

    corners = np.zeros((2, 3), np.float32)
    rest = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    mesh = bio.Mesh(
        corners,
        np.array([[0, 1, 0]], np.uint32),
        joints=[("a", None, rest), ("b", 0, rest)],
        joint_indices=np.array([[1, 1, 0, 0], [0, 1, 1, 1]], np.uint8),
        joint_weights=np.array([[0.25, 0.25, 0.5, 0], [1, 0, 0, 0]], np.float32),
    )
    indices, weights = bindings(mesh)
    assert indices.tolist() == [[1, 0, 0, 0], [0, 0, 0, 0]]
    assert weights.tolist() == [[0.5, 0, 0.5, 0], [1, 0, 0, 0]]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"joints": [("a", 0, (0, 0, 0, 1, 0, 0, 0, 1))]}, "parent of joints"),
        ({"joints": [("a", None, (0, 0, 0, 0, 0, 0, 0, 1))]}, "rest of joints"),
        ({"joint_indices": np.full((3, 4), 7, np.uint8)}, "joint numbers below 1"),
        ({"joint_weights": np.zeros((3, 4), np.float32)}, "not all 0"),
        ({"joint_weights": None}, "joint_indices and joint_weights with them"),
    ],
)
def test_a_skin_that_makes_no_sense_is_refused(change, words):
    good = {
        "joints": [("a", None, (0, 0, 0, 1, 0, 0, 0, 1))],
        "joint_indices": np.zeros((3, 4), np.uint8),
        "joint_weights": np.tile(np.array([1, 0, 0, 0], np.float32), (3, 1)),
    }
    corners = np.eye(3, dtype=np.float32)
    with pytest.raises(bio.BioscopeError, match=words):
        bio.Mesh(corners, np.array([[0, 1, 2]], np.uint32), **{**good, **change})


def test_it_refuses_to_grow_beyond_what_readers_open(tmp_path, monkeypatch):
    from bioscope.export.gltf import recording

    monkeypatch.setattr(recording, "_MOST_BYTES", 2000)
    with pytest.raises(bio.BioscopeError, match=r"reeds moves too much for a \.glb"):
        export_world(make(Gliders, Reeds), tmp_path / "a.glb", 1.0, RATE, **QUIET)
    assert list(tmp_path.iterdir()) == []
