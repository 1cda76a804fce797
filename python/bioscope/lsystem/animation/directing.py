"""What the symbol `l` does: it directs camera, lights and microphones (thesis, appendix C.2)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope.lsystem.animation.files import record
from bioscope.lsystem.animation.vectors import add, times, unit
from bioscope.lsystem.animation.viewing import VOICE

if TYPE_CHECKING:
    from bioscope.lsystem.animation.animation import Animation
    from bioscope.lsystem.animation.derivation import Instance
    from bioscope.lsystem.animation.particles import Particle


def direct(animation: Animation, one: Instance, particle: Particle | None) -> None:
    """Let a symbol `l` direct; `particle` is the current one."""
    camera, mode, told = animation.camera, one.mode(3), one.growth
    if mode in (0, 8, 10):
        camera.eye = told
    elif mode == 1:
        camera.target = told
    elif mode == 2:
        camera.angle, camera.aspect, camera.twist = told[0] / 10, told[1], told[2]
    elif mode == 3:
        animation.light.position = told
    elif mode == 4 and particle is not None:
        camera.eye = particle.position
    elif mode == 5 and particle is not None:
        ahead = unit(particle.velocity)
        if ahead is not None:
            camera.target = add(particle.position, times(ahead, told[0]))
    elif mode in (6, 7):
        _track(animation, mode, round(told[0]))
    elif mode == 9:
        camera.follow(animation.device)
    elif mode == 11:
        camera.hear([word for word in animation.words if word in VOICE])
        animation.words = [word for word in animation.words if word not in VOICE]
    if mode == 10:
        camera.target = animation.look_at
    if mode in (8, 10):
        animation.air.microphone(one.mode(2), camera.eye)


def _track(animation: Animation, mode: int, number: int) -> None:
    """Look with the eyes of an actor, or at it."""
    actor = animation.actor(number)
    if mode == 7:
        animation.camera.target = actor.position
        return
    animation.camera.eye = actor.position
    animation.camera.target = add(actor.position, actor.heading)
    if number in animation.traces:
        line = record(number, actor.state, animation.time, actor.position)
        animation.traces[number].append(line)
