"""Figures of the ready-made reef: tick, retina, preview, film."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import bioscope as bio
from bioscope.bench import Figure, best_of


def tick() -> Iterator[Figure]:
    """A tick of the reef as it comes: at least 300 fishes, 100 plants, 2,000 particles."""
    world = bio.load("reef", seed=7)
    world.step(60)
    seconds = best_of(5, lambda: world.step(60)) / 60
    note = ", ".join(f"{count} {name}" for name, count in world.populations.items())
    yield Figure("reef.tick", seconds * 1000, "ms", target=4.0, note=note)


def eyes(world: bio.World, count: int) -> list[bio.Camera]:
    """Return cameras at the places of fishes, looking where they swim."""
    cameras = []
    for batch in world.scene.batches:
        if len(batch.velocities) != len(batch.ids):
            continue
        for place, velocity in zip(batch.positions, batch.velocities, strict=True):
            ahead = place + velocity / max(float(np.linalg.norm(velocity)), 1e-6)
            start, target = tuple(map(float, place)), tuple(map(float, ahead))
            cameras.append(bio.Camera.looking_at(start, target, np.radians(100.0)))
    return cameras[:count]


def retina() -> Iterator[Figure]:
    """64 x 64 colour, depth and identity from 300 fishes; a peer casts the same rays."""
    world = bio.load("reef", seed=7)
    world.step(60)
    cameras = eyes(world, 300)

    def once() -> None:
        world.step()
        bio.look_many(world.scene, cameras, (64, 64))

    seconds = best_of(5, once) - best_of(5, world.step)
    value = len(cameras) / seconds
    peer = embree_views_per_second(world, cameras)
    yield Figure(
        "retina.64",
        value,
        "views/s",
        target=2000.0,
        better="higher",
        peer="embreex (first hit of the same rays, no colour)",
        peer_value=peer,
    )


def embree_views_per_second(world: bio.World, cameras: list[bio.Camera]) -> float:
    """Cast one ray per pixel of the same views with Embree on the same triangles."""
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    points, triangles = scene_triangles(world)
    scene = rtcore_scene.EmbreeScene()
    TriangleMesh(scene, points, triangles)
    rows, columns = np.mgrid[0:64, 0:64]
    reach = np.tan(np.radians(50.0))
    x, y = ((columns + 0.5) / 32 - 1) * reach, (1 - (rows + 0.5) / 32) * reach
    local = np.stack([x, y, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    local /= np.linalg.norm(local, axis=1, keepdims=True)
    jobs = []
    for camera in cameras[:60]:
        qx, qy, qz, qw = camera.rotation
        vector = np.array([qx, qy, qz])
        turned = local + 2 * np.cross(vector, np.cross(vector, local) + qw * local)
        origins = np.broadcast_to(np.array(camera.position), turned.shape)
        jobs.append((origins.astype(np.float32), turned.astype(np.float32)))

    def cast() -> None:
        for origins, directions in jobs:
            scene.run(origins, directions, query="DISTANCE")

    return len(jobs) / best_of(3, cast)


def scene_triangles(world: bio.World) -> tuple[np.ndarray, np.ndarray]:
    """Return all triangles of the scene (meshes at rest) as one mesh."""
    points, triangles, first = [], [], 0
    for batch in world.scene.batches:
        positions = batch.mesh.positions
        for place, rotation, scale in zip(
            batch.positions, batch.rotations, batch.scales, strict=True
        ):
            vector, w = rotation[:3], rotation[3]
            turned = positions + 2 * np.cross(vector, np.cross(vector, positions) + w * positions)
            points.append(turned * scale + place)
            triangles.append(batch.mesh.triangles + first)
            first += len(positions)
    return (
        np.concatenate(points).astype(np.float32),
        np.concatenate(triangles).astype(np.int32),
    )


def preview() -> Iterator[Figure]:
    """One picture of 1280 x 720 with shadow and haze from the main camera."""
    from bioscope.film.options import FilmOptions
    from bioscope.film.renderer import renderer

    world = bio.load("reef", seed=7)
    world.step(60)
    drawing = renderer(FilmOptions(seconds=1))
    name = next(iter(world.cameras))
    drawing.render(world.scene, world.cameras.now(name))
    times = []
    for _ in range(8):
        world.step(2)
        camera = world.cameras.now(name)
        start = time.perf_counter()
        drawing.render(world.scene, camera)
        times.append(time.perf_counter() - start)
    yield Figure("preview.720p", float(np.median(times)) * 1000, "ms", target=100.0)


def film() -> Iterator[Figure]:
    """Ten seconds 1280 x 720 at 30 pictures per second with sound, the whole command."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "reef.mp4"
        command = [sys.executable, "-m", "bioscope.cli", "--quiet", "film", "reef"]
        command += ["-o", str(output), "--seconds", "10", "--seed", "7"]
        start = time.perf_counter()
        subprocess.run(command, check=True)
        yield Figure("film.reef", time.perf_counter() - start, "s", target=60.0)


def loading() -> Iterator[Figure]:
    """Time to import the package in a fresh interpreter."""

    def once() -> None:
        subprocess.run([sys.executable, "-c", "import bioscope"], check=True)

    def bare() -> None:
        subprocess.run([sys.executable, "-c", "pass"], check=True)

    seconds = best_of(5, once) - best_of(5, bare)
    yield Figure("import", seconds, "s", target=0.3)


BENCHMARKS = {
    "reef.tick": tick,
    "retina.64": retina,
    "preview.720p": preview,
    "film.reef": film,
    "import": loading,
}
