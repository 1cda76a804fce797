"""USD files: what was in the world is in the stage, for USD's own readers and checkers."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lagoon import Blob, Gliders, Motes, Reeds, Stones, make
from pxr import Gf, Usd, UsdGeom, UsdShade, UsdSkel, UsdValidation

import bioscope as bio
from bioscope.export import export_world
from bioscope.geometry.skinning import bent
from bioscope.geometry.transforms import matrices

RATE = 24
QUIET = {"say": lambda _: None}


def scenes(seconds, *kinds):
    """The scenes of a take, from a second world with the same seed."""
    world, found = make(*kinds), []
    for number in range(round(seconds * RATE) + 1):
        world.step(number * 2 - world.tick)
        found.append(world.scene)
    return found


def opened(path, seconds, *kinds, **options):
    export_world(make(*kinds), path, seconds, RATE, **QUIET, **options)
    return Usd.Stage.Open(str(path))


def batch(scene, name):
    return next(one for one in [*scene.batches, *scene.points] if one.name == name)


def crowd(stage, name, frame):
    """Ids and places of the visible instances of a PointInstancer."""
    prim = UsdGeom.PointInstancer.Get(stage, f"/World/{name}")
    transforms = prim.ComputeInstanceTransformsAtTime(
        frame, frame, UsdGeom.PointInstancer.ExcludeProtoXform, UsdGeom.PointInstancer.IgnoreMask
    )
    mask = prim.ComputeMaskAtTime(frame)
    ids = prim.GetIdsAttr().Get(frame)
    shown = mask or [True] * len(ids)
    return {
        one: transform.ExtractTranslation()
        for one, transform, visible in zip(ids, transforms, shown, strict=True)
        if visible
    }


def validated(stage):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 20
    return [
        f"{error.GetName()}: {error.GetMessage()}"
        for error in UsdValidation.ValidationContext(validators).Validate(stage)
    ]


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    return opened(tmp_path_factory.mktemp("usd") / "small.usdc", 1.0)


@pytest.fixture(scope="module")
def truth():
    return scenes(1.0)


def test_says_its_units_axes_and_times(stage):
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == RATE
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, RATE)
    assert stage.GetDefaultPrim().GetPath() == "/World"


@pytest.mark.parametrize("suffix", [".usdc", ".usda"])
@pytest.mark.parametrize("profile", ["default", "unity"])
def test_usd_core_finds_no_fault(tmp_path, suffix, profile):
    stage = opened(tmp_path / f"small{suffix}", 0.5, profile=profile)
    assert validated(stage) == []


@pytest.mark.parametrize("name", ["gliders", "motes"])
def test_crowds_are_where_they_were_born_and_dead_ones_apart(stage, truth, name):
    counts = set()
    for frame, scene in enumerate(truth):
        there = batch(scene, name)
        found = crowd(stage, name, frame)
        assert sorted(found) == sorted(there.ids.tolist()), frame
        for one, place in zip(there.ids.tolist(), there.positions, strict=True):
            assert Gf.IsClose(found[one], Gf.Vec3d(*map(float, place)), 1e-5)
        counts.add(len(found))
    assert len(counts) > 1


def test_what_stays_has_no_samples_and_keeps_its_tints(stage):
    stones = UsdGeom.PointInstancer.Get(stage, "/World/stones")
    for attribute in (stones.GetPositionsAttr(), stones.GetScalesAttr(), stones.GetIdsAttr()):
        assert attribute.GetNumTimeSamples() == 0
    assert list(stones.GetProtoIndicesAttr().Get()) == [0, 1, 2, 0, 0]
    colors = []
    for path in stones.GetPrototypesRel().GetTargets():
        material, _ = UsdShade.MaterialBindingAPI(stage.GetPrimAtPath(path)).ComputeBoundMaterial()
        sampler = UsdShade.Shader.Get(stage, material.GetPath().AppendChild("Picture"))
        colors.append([round(one, 3) for one in sampler.GetInput("scale").Get()])
    assert colors == [[0.8, 0.8, 0.8, 1], [0.4, 0.8, 0.8, 1], [0.8, 0.4, 0.8, 1]]


def test_pictures_lie_beside_the_stage(stage):
    sampler = UsdShade.Shader.Get(stage, "/World/Looks/stone/Picture")
    file = Path(sampler.GetInput("file").Get().resolvedPath)
    assert file.parent.name == "small_textures"
    assert file.read_bytes().startswith(b"\x89PNG")


def test_jointed_bodies_bend_as_they_did(stage, truth):
    root = stage.GetPrimAtPath("/World/reeds")
    for frame in (0, 7, 24):
        reeds = batch(truth[frame], "reeds")
        for index, one in enumerate(reeds.ids.tolist()):
            body = root.GetChild(f"i{one}")
            assert body.IsInstance()
            expected, _ = bent(reeds.mesh, reeds.poses[index])
            place = matrices(reeds.transforms[index])
            expected = expected @ place[:, :3].T + place[:, 3]
            np.testing.assert_allclose(skinned(body, frame), expected, atol=1e-4)


def skinned(body, frame):
    """World positions of a body's vertices as UsdSkel computes them."""
    cache = UsdSkel.Cache()
    root = UsdSkel.Root(body)
    cache.Populate(root, Usd.TraverseInstanceProxies())
    binding = cache.ComputeSkelBindings(root, Usd.TraverseInstanceProxies())[0]
    query = cache.GetSkelQuery(binding.GetSkeleton())
    skinning = binding.GetSkinningTargets()[0]
    mesh = UsdGeom.Mesh(skinning.GetPrim())
    points = mesh.GetPointsAttr().Get(frame)
    assert skinning.ComputeSkinnedPoints(query.ComputeSkinningTransforms(frame), points, frame)
    to_world = UsdGeom.XformCache(frame).GetLocalToWorldTransform(binding.GetSkeleton().GetPrim())
    return np.array([to_world.Transform(Gf.Vec3d(point)) for point in points])


def test_a_deforming_mesh_has_points_over_time(stage, truth):
    mesh = UsdGeom.Mesh.Get(stage, "/World/blob_1/Prototypes/Shape")
    for frame in (0, 12, 24):
        there = batch(truth[frame], "blob/1").mesh.positions
        np.testing.assert_allclose(np.array(mesh.GetPointsAttr().Get(frame)), there, atol=1e-6)
    assert mesh.GetFaceVertexIndicesAttr().GetNumTimeSamples() == 0
    assert mesh.GetPrim().GetAttribute("primvars:displayColor").Get() is not None


def test_cameras_and_sun_are_there(stage, truth):
    world = make()
    for frame in (0, 24):
        world.step(frame * 2 - world.tick)
        expected = world.cameras.now("round")
        prim = UsdGeom.Camera.Get(stage, "/World/Cameras/round")
        camera = prim.GetCamera(frame)
        place = camera.transform.ExtractTranslation()
        assert Gf.IsClose(place, Gf.Vec3d(*expected.position), 1e-4)
        angle = np.radians(camera.GetFieldOfView(Gf.Camera.FOVVertical))
        assert angle == pytest.approx(expected.field_of_view, abs=1e-4)
    sun = UsdGeom.Xformable.Get(stage, "/World/Sun").ComputeLocalToWorldTransform(0)
    along = sun.TransformDir(Gf.Vec3d(0, 0, -1))
    expected = -np.array(truth[0].sun["direction"])
    np.testing.assert_allclose(np.array(along), expected, atol=1e-5)


def test_long_takes_go_into_clips(tmp_path):
    seconds = 11.0
    stage = opened(tmp_path / "long.usda", seconds, Gliders, Reeds, Blob, Motes)
    assert validated(stage) == []
    folder = tmp_path / "long_clips"
    assert sorted(one.name for one in folder.iterdir()) == [
        "clip_0000.usdc",
        "clip_0001.usdc",
        "clip_0002.usdc",
        "manifest.usda",
        "topology.usdc",
    ]
    truth = scenes(seconds, Gliders, Reeds, Blob, Motes)
    mesh = UsdGeom.Mesh.Get(stage, "/World/blob_1/Prototypes/Shape")
    for frame in (0, 5, 119, 120, 121, 200, 264):
        for name in ("gliders", "motes"):
            there = batch(truth[frame], name)
            found = crowd(stage, name, frame)
            assert sorted(found) == sorted(there.ids.tolist()), (name, frame)
            for one, place in zip(there.ids.tolist(), there.positions, strict=True):
                assert Gf.IsClose(found[one], Gf.Vec3d(*map(float, place)), 1e-5)
        there = batch(truth[frame], "blob/1").mesh.positions
        np.testing.assert_allclose(np.array(mesh.GetPointsAttr().Get(frame)), there, atol=1e-6)
        reeds = batch(truth[frame], "reeds")
        body = stage.GetPrimAtPath(f"/World/reeds/i{reeds.ids[1]}")
        expected, _ = bent(reeds.mesh, reeds.poses[1])
        expected = expected + reeds.positions[1]
        np.testing.assert_allclose(skinned(body, frame), expected, atol=1e-4)


def test_the_unity_profile_has_neither_instancers_nor_sampled_points(tmp_path):
    notices = []
    export_world(make(), tmp_path / "u.usdc", 0.5, RATE, say=notices.append, profile="unity")
    stage = Usd.Stage.Open(str(tmp_path / "u.usdc"))
    prims = list(stage.TraverseAll())
    assert not [prim for prim in prims if prim.IsA(UsdGeom.PointInstancer)]
    meshes = [UsdGeom.Mesh(prim) for prim in prims if prim.IsA(UsdGeom.Mesh)]
    assert meshes
    assert not any(mesh.GetPointsAttr().GetNumTimeSamples() for mesh in meshes)
    assert any(notice.startswith("blob/1: it changes form") for notice in notices)
    truth = scenes(0.5)[12]
    gliders = batch(truth, "gliders")
    for one, place in zip(gliders.ids.tolist(), gliders.positions, strict=True):
        prim = UsdGeom.Xformable.Get(stage, f"/World/gliders/i{one}")
        found = prim.ComputeLocalToWorldTransform(12).ExtractTranslation()
        assert Gf.IsClose(found, Gf.Vec3d(*map(float, place)), 1e-5)
    gone = min(set(batch(scenes(0.1)[0], "gliders").ids.tolist()) - set(gliders.ids.tolist()))
    dead = UsdGeom.Imageable.Get(stage, f"/World/gliders/i{gone}")
    assert dead.ComputeVisibility(12) == "invisible"
    assert dead.ComputeVisibility(3) == "inherited"


def test_a_world_exports_itself(tmp_path):
    world = make(Stones)
    world.export(tmp_path / "stones.usda", seconds=0.5)
    assert world.time == pytest.approx(0.5)
    stage = Usd.Stage.Open(str(tmp_path / "stones.usda"))
    assert stage.GetPrimAtPath("/World/stones").IsA(UsdGeom.PointInstancer)


@pytest.mark.parametrize(
    ("name", "options", "error", "words"),
    [
        ("a.fbx", {}, bio.BioscopeError, "expected a name that ends in .usdc, .usda or .glb"),
        ("a.usdc", {"profile": "nobody"}, bio.BioscopeError, "expected one of default, unity"),
        ("a.usdc", {"seconds": 0}, bio.BioscopeError, "seconds = 0"),
        ("a.usdc", {"frames_per_second": -1}, bio.BioscopeError, "frames per second = -1"),
        ("none/a.usdc", {}, FileNotFoundError, "make the folder first"),
        ("none/a.glb", {}, FileNotFoundError, "make the folder first"),
    ],
)
def test_says_what_is_wrong(tmp_path, name, options, error, words):
    with pytest.raises(error, match=words):
        export_world(make(Stones), tmp_path / name, **{"seconds": 0.2, **options}, **QUIET)
    assert list(tmp_path.iterdir()) == []


def test_names_the_extra_if_it_is_missing(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(bio.BioscopeError, match=r'pip install "bioscope\[usd\]"'):
        export_world(make(Stones), tmp_path / "a.usdc", 0.2, **QUIET)


FULL_DISK = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
sys.path.insert(0, sys.argv[2])
from lagoon import make
from bioscope.export import export_world
world = make()
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
try:
    export_world(world, sys.argv[1], 0.5, 24)
except OSError as error:
    print("refused:", error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit on the size of files")
@pytest.mark.parametrize("suffix", [".usdc", ".glb"])
def test_a_full_disk_leaves_nothing_half_written(tmp_path, suffix):
    target = tmp_path / f"small{suffix}"
    target.write_bytes(b"old")
    result = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(target), str(Path(__file__).parent)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "refused:" in result.stdout, result.stderr
    assert target.read_bytes() == b"old"
    assert [one.name for one in tmp_path.iterdir()] == [target.name]
