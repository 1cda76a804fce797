"""The springs of the published fish let go from a disturbed shape: ours beside MuJoCo."""

import time

import mujoco
import numpy as np

import bioscope as bio

SECONDS = 0.2
FINER = 200


class Rollout:
    """One start, one reference by small steps, two engines with the published step."""

    def __init__(self) -> None:
        self.tank = bio.fish.Tank("anthias", preset="published", water=0.0, integrator="implicit")
        self.dt = self.tank.dt
        self.steps = round(SECONDS / self.dt)
        rng = np.random.default_rng(3)
        rest = self.tank.nodes
        self.start = rest + rng.normal(0, 0.005 * self.tank.length, rest.shape)
        self.reference = self._reference()

    def _reference(self) -> np.ndarray:
        """Return the nodes at the end by symplectic steps that are 200 times finer."""
        units, masses = self.tank.units, self.tank.masses[:, None]
        a, b = units[:, 0].astype(int), units[:, 1].astype(int)
        rest, stiffness, damping = units[:, 2:].T
        place, speed = self.start.copy(), np.zeros_like(self.start)
        dt = self.dt / FINER
        for _ in range(self.steps * FINER):
            reach = place[b] - place[a]
            length = np.linalg.norm(reach, axis=1)
            ahead = reach / length[:, None]
            rate = np.einsum("ij,ij->i", speed[b] - speed[a], ahead)
            force = (stiffness * (length - rest) + damping * rate)[:, None] * ahead
            total = np.zeros_like(place)
            np.add.at(total, a, force)
            np.subtract.at(total, b, force)
            speed += dt * total / masses
            place += dt * speed
        return place

    def _error(self, nodes: np.ndarray) -> float:
        """Return the root mean square distance of the nodes from the reference, body lengths."""
        distances = np.linalg.norm(nodes - self.reference, axis=1)
        return float(np.sqrt((distances**2).mean()) / self.tank.length)

    def ours(self) -> tuple[float, float]:
        """Return the error of the implicit step and steps per second."""
        self.tank.deform(self.start)
        rest = np.zeros(12)
        self.tank.step(rest, steps=self.steps)
        error = self._error(self.tank.nodes)
        start = time.perf_counter()
        self.tank.step(rest, steps=20_000)
        return error, 20_000 / (time.perf_counter() - start)

    def mujoco(self) -> tuple[float, float]:
        """Return the same of MuJoCo: point masses on slides, tendons as springs, implicitfast."""
        model = mujoco.MjModel.from_xml_string(self._xml())
        data = mujoco.MjData(model)
        data.qpos[:] = self.start.ravel()
        for _ in range(self.steps):
            mujoco.mj_step(model, data)
        error = self._error(data.qpos.reshape(-1, 3).copy())
        start = time.perf_counter()
        mujoco.mj_step(model, data, 20_000)
        return error, 20_000 / (time.perf_counter() - start)

    def _xml(self) -> str:
        bodies = "".join(
            f'<body><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>'
            f'<joint type="slide" axis="0 0 1"/><inertial pos="0 0 0" mass="{mass!r}" '
            f'diaginertia="1e-9 1e-9 1e-9"/><site name="n{node}"/></body>'
            for node, mass in enumerate(self.tank.masses.tolist())
        )
        tendons = "".join(
            f'<spatial springlength="{rest!r}" stiffness="{stiffness!r}" damping="{damping!r}">'
            f'<site site="n{int(a)}"/><site site="n{int(b)}"/></spatial>'
            for a, b, rest, stiffness, damping in self.tank.units.tolist()
        )
        option = f'<option timestep="{self.dt!r}" gravity="0 0 0" integrator="implicitfast"/>'
        compiler = '<compiler boundmass="1e-12" boundinertia="1e-15"/>'
        return (
            f"<mujoco>{compiler}{option}<worldbody>{bodies}</worldbody>"
            f"<tendon>{tendons}</tendon></mujoco>"
        )
