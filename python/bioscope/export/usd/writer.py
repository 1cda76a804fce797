"""A take as a USD stage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bioscope.errors import MissingExtraError
from bioscope.export.folder import written_folder
from bioscope.export.names import Names
from bioscope.files import written_whole
from bioscope.geometry.balls import Balls

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from pxr import Usd

    from bioscope._engine import Batch, Scene
    from bioscope.export.take import Frame, Take
    from bioscope.export.usd.bodies import Bodies
    from bioscope.export.usd.crowd import Crowd

_CLIP_SECONDS = 5.0
"""Length of a value clip."""
_LONGEST_IN_ONE_FILE = 10.0
"""Seconds beyond which samples go into value clips."""
_MOST_PRIMS = 5000
"""Individuals of one batch that get a prim each."""
_ROOT = "/World"


def write_usd(take: Take, path: Path, say: Callable[[str], object], profile: str) -> None:
    """Run a take and write it; see `bioscope.export.export_world`."""
    try:
        import pxr  # noqa: F401
    except ImportError:
        raise MissingExtraError("Export to USD", "usd") from None
    textures, clips = f"{path.stem}_textures", f"{path.stem}_clips"
    with (
        written_whole(path) as temporary,
        written_folder(path.with_name(textures)) as pictures,
        written_folder(path.with_name(clips)) as samples,
    ):
        writer = StageWriter(take, (pictures, textures), samples, say, profile)
        for frame in take.frames():
            writer.frame(frame)
        writer.finish(temporary, clips)


class StageWriter:
    """A stage that grows frame by frame."""

    def __init__(
        self,
        take: Take,
        textures: tuple[Path, str],
        clips: Path,
        say: Callable[[str], object],
        profile: str,
    ) -> None:
        from bioscope.export.usd.looks import Looks
        from bioscope.export.usd.samples import Samples

        self._take, self._say, self._profile = take, say, profile
        self._stage = _stage(take)
        rate = take.frames_per_second
        long = (take.frame_count - 1) / rate > _LONGEST_IN_ONE_FILE
        self._samples = Samples(self._stage, round(_CLIP_SECONDS * rate) if long else None, clips)
        pictures, name = textures
        base = f"../{name}" if long else f"./{name}"  # As seen from the layer that has the looks.
        self._looks = Looks(self._stage, f"{_ROOT}/Looks", pictures, base)
        self._names = Names("Looks", "Cameras", "Sun", "Sky")
        self._shown: dict[tuple[str, str], Bodies | Crowd] = {}
        self._told: set[tuple[str, str]] = set()
        self._cameras: Any = None
        self._lights: Any = None

    def frame(self, frame: Frame) -> None:
        """Add one frame."""
        self._samples.frame = frame.number
        scene = frame.scene
        if self._cameras is None:
            self._begin(scene)
        self._cameras.frame(frame.cameras)
        self._lights.frame(scene)
        present: set[tuple[str, str]] = set()
        for batch in scene.batches:
            if len(batch.ids) and len(batch.mesh.triangles):
                present.add(self._show("batch", batch))
        for points in scene.points:
            if len(points.ids):
                present.add(self._show("points", Balls(points)))
        for key in self._shown.keys() - present:
            self._shown[key].empty()
        self._samples.end_frame()

    def finish(self, path: Path, clips: str) -> None:
        """Write the stage; its clips are in the folder that will be called `clips`."""
        self._samples.finish(path, clips)

    def _begin(self, scene: Scene) -> None:
        from pxr import Gf

        from bioscope.export.usd.surroundings import Cameras, Lights

        self._cameras = Cameras(self._stage, f"{_ROOT}/Cameras", self._samples)
        self._lights = Lights(self._stage, _ROOT, scene, self._looks, self._samples)
        root = self._stage.GetPrimAtPath(_ROOT)
        root.SetCustomDataByKey("bioscope:seed", str(self._take.world.seed))
        root.SetCustomDataByKey("bioscope:start_seconds", scene.time)
        for name, value in scene.medium.items():
            if value is not None:
                number = value if isinstance(value, float) else Gf.Vec3f(*value)
                root.SetCustomDataByKey(f"bioscope:medium:{name}", number)

    def _show(self, kind: str, batch: Batch | Balls) -> tuple[str, str]:
        key = (kind, batch.name)
        if key not in self._shown:
            self._shown[key] = self._new(batch, self._path(key, batch.name))
        shown = self._shown[key]
        if not self._follows(batch, shown):
            self._once(batch.name, "it changes form; every frame has its first form")
        shown.frame(batch)
        return key

    def _new(self, batch: Batch | Balls, path: str) -> Bodies | Crowd:
        from bioscope.export.usd.bodies import Bodies
        from bioscope.export.usd.crowd import Crowd

        parts = self._stage, path, batch, self._looks, self._samples
        many = len(batch.ids) > _MOST_PRIMS
        alone = bool(batch.mesh.joints) or self._profile == "unity"
        if alone and many:
            found = f"{len(batch.ids)} individuals are more than {_MOST_PRIMS}"
            self._once(batch.name, f"{found}; they move, but do not bend")
        return Bodies(*parts) if alone and not many else Crowd(*parts)

    @staticmethod
    def _follows(batch: Batch | Balls, shown: Bodies | Crowd) -> bool:
        """Whether what shows a batch can show its present mesh."""
        return bool(getattr(shown, "mesh_key", batch.mesh.key) == batch.mesh.key)

    def _path(self, key: tuple[str, str], wish: str) -> str:
        return f"{_ROOT}/{self._names.of(key, wish)}"

    def _once(self, name: str, notice: str) -> None:
        key = (name, notice)
        if key not in self._told:
            self._told.add(key)
            self._say(f"{name}: {notice}")


def _stage(take: Take) -> Usd.Stage:
    """Return an empty stage with its units, axes and times."""
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateInMemory(".usdc")
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.meters)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    stage.SetTimeCodesPerSecond(take.frames_per_second)
    stage.SetFramesPerSecond(take.frames_per_second)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(take.frame_count - 1)
    root = UsdGeom.Xform.Define(stage, _ROOT)
    stage.SetDefaultPrim(root.GetPrim())
    UsdGeom.Scope.Define(stage, f"{_ROOT}/Looks")
    return stage
