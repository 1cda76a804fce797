"""Mazes of thin walls between the cells of a grid, with one exit."""

import random
from pathlib import Path

THICK, HIGH = 0.1, 0.6
STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


class Maze:
    """A maze by a seed.

    Simply connected as it is: every cell is reached in one way, and all walls hang together. With
    `holes`, so many walls less, it has circuits, and walls that stand alone.
    """

    def __init__(self, size: int, seed: int, holes: int = 0) -> None:
        self.size = size
        chance = random.Random(seed)
        self.open = {frozenset(self._exit(chance))}
        seen, way = {(0, 0)}, [(0, 0)]
        while way:
            near = [one for one in self._around(way[-1]) if one not in seen]
            if not near:
                way.pop()
                continue
            step = chance.choice(near)
            self.open.add(frozenset((way[-1], step)))
            seen.add(step)
            way.append(step)
        inner = [frozenset((a, b)) for a in sorted(seen) for b in self._around(a) if a < b]
        closed = [one for one in inner if one not in self.open]
        self.open.update(chance.sample(closed, holes))

    def _around(self, cell: tuple[int, int]) -> list[tuple[int, int]]:
        near = [(cell[0] + x, cell[1] + z) for x, z in STEPS]
        return [one for one in near if min(one) >= 0 and max(one) < self.size]

    def _exit(self, chance: random.Random) -> tuple[tuple[int, int], tuple[int, int]]:
        at, last = chance.randrange(self.size), self.size - 1
        ways = [((0, at), (-1, at)), ((last, at), (self.size, at))]
        ways += [((at, 0), (at, -1)), ((at, last), (at, self.size))]
        return chance.choice(ways)

    def walls(self) -> list[tuple[int, int, int, int]]:
        """Return x and z of the ends of all walls, each as long as a cell."""
        span, across = range(-1, self.size), range(self.size)
        up = [(x + 1, z, x + 1, z + 1) for x in span for z in across if self._wall(x, z, x + 1, z)]
        along = [
            (x, z + 1, x + 1, z + 1) for x in across for z in span if self._wall(x, z, x, z + 1)
        ]
        return up + along

    def _wall(self, x: int, z: int, to_x: int, to_z: int) -> bool:
        return frozenset(((x, z), (to_x, to_z))) not in self.open

    def islands(self) -> int:
        """Return how many groups of walls hang together, beside the first."""
        groups: list[set[tuple[int, int]]] = []
        for x, z, to_x, to_z in self.walls():
            ends = {(x, z), (to_x, to_z)}
            joined = [one for one in groups if one & ends]
            groups = [one for one in groups if not one & ends] + [ends.union(*joined)]
        return len(groups) - 1

    def clearance(self, x: float, z: float) -> float:
        """Return how far a place is from the nearest wall."""
        return min(
            ((x - min(max(x, a), c)) ** 2 + (z - min(max(z, b), d)) ** 2) ** 0.5 - THICK / 2
            for a, b, c, d in self.walls()
        )

    def write(self, path: Path) -> None:
        """Write the walls as a triangulated surface."""
        corners, triangles = [], []
        for x, z, to_x, to_z in self.walls():
            first = len(corners)
            sides = [
                (x - THICK / 2, to_x + THICK / 2),
                (0, HIGH),
                (z - THICK / 2, to_z + THICK / 2),
            ]
            corners += [(a, b, c) for a in sides[0] for b in sides[1] for c in sides[2]]
            for a, b, c, d in FACES:
                triangles += [(first + a, first + b, first + c), (first + a, first + c, first + d)]
        rows = [(f"SM {len(corners)}", len(triangles)), *corners, *triangles]
        path.write_text("".join(" ".join(map(str, row)) + "\n" for row in rows))
