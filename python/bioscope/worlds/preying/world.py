"""A hungry shark hunts fusiliers over sand, and lets the angelfishes be.

Watch for: the shark that picks the prey it meets alone; the school that bursts apart when it comes
near and gathers again; the angelfishes that feed on undisturbed, for the shark does not eat them.

Source: X. Tu, "Artificial animals for computer animation", 1996, section 9.3, "Preying behavior".
"""

import bioscope as bio
from bioscope.populations.place import Disk, Habitat, Rectangle

_SHARK, _PREY = "blacktip_shark", "fusilier"


def world(seed: int) -> bio.World:
    """Make the hunting ground."""
    ground = bio.World(seed=seed, dt=1 / 30, title="preying")
    ground.environment.water(surface=0.0, current=bio.Current(speed=0.04, surge=0.08))
    ground.environment.set(turbidity=0.55, sun_elevation=66.0)
    ground.add(bio.Ground(relief={}))
    slope = Rectangle((-7.0, -7.0), (7.0, 4.0))
    ground.add(bio.Rocks(14, habitat=Habitat(area=slope, patchiness=0.6), radius=(0.15, 0.6)))
    garden = Habitat(area=Disk((0.0, -2.0), 6.0), slope=(0.0, 35.0), patchiness=0.7)
    ground.add(bio.Plants("seagrass", 40, habitat=garden, size=(0.7, 1.3)))
    _settle_animals(ground)
    _place_cameras(ground)
    return ground


def _settle_animals(ground: bio.World) -> None:
    prey = bio.minds.Intentions(
        "prey", enemies=[_SHARK], food=["plankton"], habits=["school"], home_range=3.0
    )
    ground.add(bio.FishSchool(_PREY, 5, center=(1.5, -3.6, -0.5), half=(0.5, 0.3, 0.5), mind=prey))
    ground.add(bio.FishSchool(_PREY, 4, center=(-1.5, -3.4, 1.0), half=(2.0, 0.6, 2.0), mind=prey))
    peaceful = bio.minds.Intentions("pacifist", food=["plankton"])
    ground.add(
        bio.FishSchool(
            "emperor_angelfish", 3, center=(0.5, -4.2, 0.5), half=(1.0, 0.3, 1.0), mind=peaceful
        )
    )
    hunter = bio.minds.Intentions(
        "predator", food=[_PREY], stagger=0.0, appetite=2.0, home_range=5.0
    )
    ground.add(
        bio.RoamingFish(
            _SHARK, 1, center=(-4.0, -3.6, -3.5), radius=0.3, home=(0.0, -3.6, 0.0), mind=hunter
        )
    )
    ground.add(bio.Plankton(500, low=(-4.0, -6.0, -4.0), high=(4.0, -1.0, 4.0)))


def _place_cameras(ground: bio.World) -> None:
    cameras = ground.cameras
    cameras.fixed("wide", position=(2.6, -4.3, 3.2), target=(0.6, -3.9, -0.8), field_of_view=58)
    cameras.follow("shark", species=_SHARK, offset=(1.1, 0.25, 0.9), field_of_view=48)
    cameras.follow("prey", species=_PREY, index=2, offset=(1.2, 0.3, 1.2), field_of_view=48)
    ground.shots = [("wide", 4.0), ("shark", 4.0), ("prey", 3.0), ("wide", 6.0)]
