"""The turtle that goes along the string of one definition (thesis, section 2.2 and appendix C).

A symbol's growth values are computed when the turtle reaches it, once per frame: they may depend on
the particle and the actor that were last met. Where a definition is drawn repeatedly, only values
that differ from place to place are computed again, and what happens once per frame happens at the
first place.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from bioscope.lsystem.animation import shapes
from bioscope.lsystem.animation.boxes import capture
from bioscope.lsystem.animation.directing import direct
from bioscope.lsystem.animation.directives import directive
from bioscope.lsystem.animation.frame import Directive, Line, Piece
from bioscope.lsystem.animation.materials import MATERIALS, Material
from bioscope.lsystem.animation.particles import force_of
from bioscope.lsystem.animation.vectors import DOWN, ZERO, Pose, Vector, add, subtract, times

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from bioscope.lsystem.animation.animation import Animation
    from bioscope.lsystem.animation.derivation import Derivation, Instance
    from bioscope.lsystem.animation.particles import Particle
    from bioscope.lsystem.animation.placement import Placement
    from bioscope.lsystem.animation.shapes import Shape

GROUND = 2000.0
"""Edge of the ground square."""
TABLE = 7
"""Stored positions and states are numbered 1 to 6."""
DEEPEST = 100_000
"""Most open branches."""
FARTHEST = 1e9
"""Greatest coordinate of what is drawn, units of the model."""
_BENT_BEFORE, _BENT_AFTER = "RSONo", "cdpqPQs"


class Walk:
    """One drawing of one string."""

    def __init__(self, animation: Animation, layer: Derivation, index: int, at: Placement) -> None:
        self.animation, self.layer = animation, layer
        self.first = index == 0
        self.repetition = index
        self.pose, self.scale = at.pose, at.scale
        self.branches: list[tuple[Pose, int | None]] = []
        self.polygons: list[list[Vector]] = []
        self.material: Material = MATERIALS[7]
        self.color: Vector = (255.0, 255.0, 255.0)
        self.sides = shapes.SIDES
        self.particle: Particle | None = None
        self.actor = 0
        self.body: int | None = None
        """The actor whose body is drawn: from `M` or `g` to the end of their branch."""
        self.tropism: Instance | None = None
        self.rigidity = 1.0
        self.bends = False

    def run(self) -> None:
        """Go along the string."""
        for one in self.layer.string:
            act = _ACTS.get(one.symbol)
            if self.first or one.varies:
                self.grow(one)
            if act is None:
                continue
            if self.bends and one.symbol in _BENT_BEFORE:
                self.bend()
            act(self, one)
            if self.bends and one.symbol in _BENT_AFTER:
                self.bend()
            one.shown = True
            one.sensed = self.actor, self.particle

    def grow(self, one: Instance) -> None:
        """Compute the growth values of a symbol."""
        scope = self.animation.crew.scope(self.layer.layer)
        scope.age, scope.memory, scope.identity = one.age, one.memory, one.id
        scope.particle, scope.actor, scope.repetition = self.particle, self.actor, self.repetition
        scope.place = one.parameters
        if one.symbol == "C" and one.particle is not None:
            scope.particle = one.particle
            scope.place, scope.velocity = one.particle.position, one.particle.velocity
        elif one.symbol in "vC":
            scope.place = self.pose.position
        values = []
        for slot, program in enumerate(one.programs):
            scope.slot, scope.drawn = slot + 4, 0
            values.append(program(scope))
        one.growth = values[0], values[1], values[2]

    def bend(self) -> None:
        """Turn toward the tropism and the fields of particles."""
        force = self.animation.field(self.pose.position, self.animation.crew.particles)
        if self.tropism is not None:
            force = add(force, self.tropism.growth)
        self.pose = self.pose.bent(force, self.rigidity)

    def draw(
        self, one: Instance, make: Callable[..., Shape], *given: Any, smooth: bool = False
    ) -> None:
        """Add a shape of convex faces of the current material.

        It is the same piece as before if nothing has changed.
        """
        key = make, given, self.material, self.body
        if one.drawn is None:
            one.drawn = {}
        before = one.drawn.get(self.repetition)
        if before is None or before[0] != key:
            corners, faces = make(*given)
            piece = Piece(one.symbol, corners, faces, self.material, smooth, self.body, convex=True)
            if not self.is_near(one, piece.corners):
                return
            before = one.drawn[self.repetition] = key, piece
        self.animation.frame.items.append(before[1])

    def is_near(self, one: Instance, points: Iterable[Vector]) -> bool:
        """Tell whether points are not too far away to be drawn; if they are, that is remarked."""
        near = all(abs(part) <= FARTHEST for point in points for part in point)
        if not near:
            self.animation.remark(f"'{one.symbol}' draws beyond {FARTHEST:g} units; it is left out")
        return near

    def size(self, one: Instance) -> Vector:
        """Return the growth values as lengths at this place."""
        return times(one.growth, self.scale)

    def advance(self, ahead: float) -> None:
        """Go ahead."""
        self.pose = self.pose.at(self.pose.point(ahead))

    # Turns and moves.

    def _roll(self, one: Instance) -> None:
        mode = one.mode(2)
        pose = self.pose
        if mode == 0:
            self.pose = pose.rolled(one.growth[0])
        elif mode == 1:
            self.pose = pose.level()
        elif mode == 2:
            self.pose = pose.level().toward(DOWN)
        elif mode == 3:
            self.pose = Pose(pose.position)
        elif mode == 4 and self.particle is not None:
            self.pose = pose.toward(self.particle.velocity)
        elif mode == 5:
            found = self.animation.trajectory(one.mode(3))
            if found is not None:
                self.pose = pose.at(found[0]).toward(found[1])
        elif mode == 6:
            self.pose = pose.toward((pose.heading[0], 0.0, pose.heading[2]))

    def _move(self, one: Instance) -> None:
        mode = one.mode(3)
        a, b, c = self.size(one)
        if mode == 0:
            self.advance(a)
        elif mode == 1:
            self.pose = self.pose.at(add(self.pose.position, one.growth))
        elif mode == 2:
            self.pose = self.pose.at(one.growth)
        elif mode == 3:
            self.pose = self.pose.at(self.pose.point(a, b, c))

    def _begin_branch(self, one: Instance) -> None:
        mode = one.mode(1)
        if mode == 0:
            if len(self.branches) >= DEEPEST:
                self.animation.remark(f"more than {DEEPEST} open branches; one is left out")
                return
            self.branches.append((self.pose, self.body))
        elif 0 < mode < TABLE:
            if one.mode(2) == 0:
                self.animation.positions[mode] = self.pose.position
            else:
                self.animation.states[mode] = self.pose

    def _end_branch(self, one: Instance) -> None:
        mode = one.mode(1)
        if mode == 0:
            if self.branches:
                self.pose, self.body = self.branches.pop()
        elif 0 < mode < TABLE and one.mode(2) != 0:
            self.pose = self.animation.states[mode]
        elif 0 < mode < TABLE:
            self.pose = self.pose.at(self.animation.positions[mode])
            self._corner(one)

    def _ask(self, one: Instance) -> None:
        if self.first:
            one.parameters = self.pose.position

    # Shapes.

    def _cube(self, one: Instance) -> None:
        self.draw(one, shapes.box, self.pose, self.size(one))
        self.advance(self.size(one)[0])

    def _pyramid(self, one: Instance) -> None:
        self.draw(one, shapes.pyramid, self.pose, self.size(one))
        self.advance(self.size(one)[0])

    def _ball(self, one: Instance) -> None:
        a, b, c = self.size(one)
        size = (a, b, c) if one.symbol == "s" else (a, a, a)
        self.draw(one, shapes.ellipsoid, self.pose, size, self.sides, smooth=True)

    def _capsule(self, one: Instance) -> None:
        a, b, c = self.size(one)
        if one.symbol == "o":
            self.draw(one, shapes.tube, self.pose, a, (b, c), self.sides, smooth=True)
        else:
            self.draw(one, shapes.trunk, self.pose, a, (b, c), (b, c), self.sides, smooth=True)
        self.advance(a)

    def _trunk(self, one: Instance) -> None:
        a, b, c = self.size(one)
        self.draw(one, shapes.trunk, self.pose, a, (b, b), (c, c), self.sides, smooth=True)
        self.advance(a)

    def _line(self, one: Instance) -> None:
        start = self.pose.position
        self.advance(self.size(one)[0])
        if self.is_near(one, (start, self.pose.position)):
            line = Line(start, self.pose.position, self.color, self.body)
            self.animation.frame.items.append(line)

    def _begin_polygon(self, one: Instance) -> None:
        self.polygons.append([])

    def _corner(self, one: Instance) -> None:
        if self.polygons:
            self.polygons[-1].append(self.pose.position)

    def _end_polygon(self, one: Instance) -> None:
        corners = self.polygons.pop() if self.polygons else []
        if len(corners) < shapes.LEAST_SIDES:
            return
        made = shapes.extruded(
            corners,
            flipped=one.mode(1) == 1,
            parallel=one.mode(2) == 1,
            closing=one.mode(3),
            distance=self.size(one)[0],
        )
        for corners, faces in made:
            if self.is_near(one, corners):
                piece = Piece(one.symbol, corners, faces, self.material, body=self.body)
                self.animation.frame.items.append(piece)

    def _imported(self, one: Instance) -> None:
        surface = self._layer_surfaces().get(one.mode(1))
        if surface is None:
            self.animation.remark(f"surface {one.mode(1)} of 'B' is not declared")
            return
        self.draw(one, shapes.placed, surface, self.pose, self.size(one))

    def _layer_surfaces(self) -> dict[int, Shape]:
        return self.animation.surfaces[self.layer.layer]

    # Appearance.

    def _resolution(self, one: Instance) -> None:
        self.sides = min(max(one.mode(1), shapes.LEAST_SIDES), shapes.MOST_SIDES)

    def _colored(self, one: Instance) -> None:
        self.material = MATERIALS.get(one.mode(1), self.material)
        if one.mode(3) == 1:
            self.material = replace(self.material, diffuse=one.growth)
        elif one.mode(3) == 2:
            self.material = replace(self.material, lit=False)

    def _stroke(self, one: Instance) -> None:
        r, g, b = (min(255.0, max(0.0, part)) for part in one.growth)
        self.color = r, g, b

    def _camera(self, one: Instance) -> None:
        if self.first:
            direct(self.animation, one, self.particle)

    # Forces.

    def _force(self, one: Instance) -> None:
        mode = one.mode(1)
        if mode == 0:
            self.tropism = one
        elif mode == 1:
            self.rigidity = one.growth[0]
        self.bends = mode != 2

    def _particle_of(self, one: Instance) -> None:
        held = one.particle
        if held is None:
            return
        if self.first:
            self.lead(one, held)
        self.particle = held
        self.pose = self.pose.at(held.position)

    def lead(self, one: Instance, held: Particle) -> None:
        """Place a particle, and let it follow what leads it."""
        mode = one.mode(1)
        target = self.pose.position
        if mode == 1:
            target = one.growth
        elif mode == 5:
            target = self.animation.actor(round(one.growth[0])).position
        elif mode == 0:
            if held.placed:
                return
            held.velocity = one.growth
            held.mass = one.parameters[1] if one.parameters[1] > 0 else 1.0
        if held.placed and mode != 0:
            way = subtract(target, held.position)
            held.velocity = times(way, 1 / self.animation.interval)
        held.position, held.placed = target, True

    # Actors, sounds, programs.

    def _mapped(self, one: Instance) -> None:
        if one.mode(1) == 7:
            self.actor = self.body = one.mode(3)
            actor = self.animation.actor(self.actor)
            self.pose = self.pose.at(actor.position).toward(actor.heading)

    def _led(self, one: Instance) -> None:
        if one.mode(1) != 1:
            self.body = self.actor
        if not self.first:
            return
        actor = self.animation.actor(self.actor)
        place = self.pose.position
        if one.mode(1) == 1:
            actor.set_local_goal(0, place)
            return
        if one.mode(1) == 2:
            place = place[0], one.growth[0], place[2]
        actor.position, actor.heading = place, self.pose.heading

    def _ordered(self, one: Instance) -> None:
        if self.first:
            self.animation.orders.append((one.mode(1), one.mode(2), one.growth[0]))

    def _sound(self, one: Instance) -> None:
        if not self.first:
            return
        mode, number, source = one.mode(1), round(one.growth[0]), round(one.growth[1])
        air = self.animation.air
        if mode == 2:
            air.move(number, self.pose.position)
        elif not one.shown:
            air.begin(number, source, self.pose.position if mode == 1 else None)

    def _script(self, one: Instance) -> None:
        if self.first or one.mode(2) != 0:
            a, b, c = (str(int(part)) for part in one.growth)
            self.animation.run_script(one.mode(1), a, b, c)

    def _special(self, one: Instance) -> None:
        mode = one.mode(1)
        animation, frame = self.animation, self.animation.frame
        words = directive(mode, one.parameters[2], one.growth, self.pose, animation.camera)
        if animation.offline and words is not None:
            frame.items.append(Directive(words))
        elif mode == 2:
            self.draw(one, shapes.square, GROUND, (0.0, one.growth[0], 0.0))
        elif mode == 3:
            x, _, z = self.pose.position
            edge, height, _ = one.growth
            self.draw(one, shapes.square, edge, (x, height, z))
        elif mode == 20:
            animation.captured = len(frame.items)
        elif mode == 21:
            capture(animation)
        elif mode == 30:
            frame.printed.append(self.pose.position)
        elif mode == 40:
            animation.look_at = self.pose.position
        elif mode == 41:
            self._court(one)

    def _court(self, one: Instance) -> None:
        named = {material.name: material for material in MATERIALS.values()}
        parts = shapes.tennis_court()
        if one.mode(2) == 1:
            length, width = 2 * shapes.COURT_LENGTH, 2 * shapes.DOUBLES_WIDTH
            edges = [(x * length / 2, -0.002, z * width / 2) for x, z in _SURROUND]
            parts["gray"] = edges, [(0, 1, 2, 3)]
        for name, (corners, faces) in parts.items():
            flat = replace(named[name], lit=False)
            self.animation.frame.items.append(Piece(one.symbol, corners, faces, flat))


_SURROUND = ((-1, -1), (-1, 1), (1, 1), (1, -1))


def touched(particles: list[Particle], animation: Animation, place: Vector) -> Vector:
    """Return the sum of the fields of particles at a place that has no velocity of its own."""
    felt = animation.crew.scope(0)
    felt.place = place
    total = ZERO
    for source in particles:
        if source.placed and source.field is not None:
            felt.layer = source.owner.layer
            felt.velocity = source.velocity
            total = add(total, force_of(source, felt, source.position, source.velocity))
    return total


_ACTS: dict[str, Callable[[Walk, Instance], None]] = {
    "+": lambda walk, one: setattr(walk, "pose", walk.pose.turned(one.growth[0])),
    "-": lambda walk, one: setattr(walk, "pose", walk.pose.turned(-one.growth[0])),
    "&": lambda walk, one: setattr(walk, "pose", walk.pose.pitched(one.growth[0])),
    "^": lambda walk, one: setattr(walk, "pose", walk.pose.pitched(-one.growth[0])),
    "/": lambda walk, one: setattr(walk, "pose", walk.pose.rolled(-one.growth[0])),
    "$": Walk._roll,
    "f": Walk._move,
    "[": Walk._begin_branch,
    "]": Walk._end_branch,
    "?": Walk._ask,
    "c": Walk._cube,
    "d": Walk._cube,
    "p": Walk._pyramid,
    "q": Walk._pyramid,
    "a": Walk._ball,
    "s": Walk._ball,
    "O": Walk._capsule,
    "N": Walk._capsule,
    "o": Walk._capsule,
    "P": Walk._trunk,
    "Q": Walk._trunk,
    "R": Walk._line,
    "S": Walk._line,
    "{": Walk._begin_polygon,
    ".": Walk._corner,
    "}": Walk._end_polygon,
    "B": Walk._imported,
    "n": Walk._resolution,
    "m": Walk._colored,
    "r": Walk._stroke,
    "l": Walk._camera,
    "v": Walk._force,
    "C": Walk._particle_of,
    "M": Walk._mapped,
    "g": Walk._led,
    "H": Walk._ordered,
    "T": Walk._sound,
    "E": Walk._script,
    "D": Walk._special,
}
"""What the turtle does at a symbol; others are there for productions alone."""
