"""A coral reef where a shark stalks schools of fish among swaying plants.

Watch for: the school of fusiliers that streams through the channel, splits round the rocks and
flees in a wave when the shark comes near; kelp and sea grass that follow the swell, the tips late
and wide; bubbles that ring from vents; shrimps that crackle among the corals.

Source of the schooling: C. W. Reynolds, "Flocks, herds, and schools", SIGGRAPH 1987.
"""

import bioscope as bio
from bioscope.populations.place import Disk, Habitat, Rectangle

PLATES = {"mixed_reef": (7, 5.0, "garden")}


def world(seed: int) -> bio.World:
    """Make the reef."""
    reef = bio.World(seed=seed, dt=1 / 60, title="reef")
    swell = bio.Current(direction=(1.0, 0.0, 0.35), speed=0.08, surge=0.16, turbulence=0.05)
    reef.environment.water(surface=0.0, current=swell)
    reef.environment.set(turbidity=0.62, sun_elevation=62.0, sun_azimuth=35.0)
    _settle_ground(reef)
    _settle_plants(reef)
    _settle_animals(reef)
    _place_cameras(reef)
    return reef


def _settle_ground(reef: bio.World) -> None:
    reef.add(bio.Ground(relief={}))
    slope = Rectangle((-9.0, -8.0), (9.0, 5.0))
    reef.add(bio.Rocks(46, habitat=Habitat(area=slope, patchiness=0.5), radius=(0.15, 0.9)))
    garden = Habitat(area=Rectangle((-8.0, -7.0), (8.0, 3.0)), patchiness=0.75, patch=2.5)
    colonies = {
        "Brain": 12,
        "Lobes": 12,
        "Table": 9,
        "Bush": 22,
        "Tubes": 10,
        "Fan": 12,
        "Whips": 9,
    }
    reef.add(bio.Corals(colonies, habitat=garden))


def _settle_plants(reef: bio.World) -> None:
    sand = Habitat(area=Rectangle((-8.0, -6.0), (8.0, 6.5)), slope=(0.0, 25.0), patchiness=0.8)
    reef.add(bio.Plants("seagrass", 60, habitat=sand, size=(0.7, 1.4)))
    left = Habitat(area=Disk((-5.0, 0.5), 3.2), slope=(0.0, 40.0))
    reef.add(bio.Plants("kelp", 16, habitat=left, size=(0.8, 1.35), room=0.5))
    rocks = Habitat(area=Rectangle((-7.0, -7.0), (8.0, 3.0)), slope=(5.0, 60.0), patchiness=0.4)
    reef.add(bio.Plants("sea_fan", 16, habitat=rocks, size=(0.7, 1.3), variety=0.6))
    reef.add(bio.Plants("staghorn", 12, habitat=rocks, flexibility=0.0, flutter=0.0))


def _settle_animals(reef: bio.World) -> None:
    reef.add(bio.FishSchool("fusilier", 240, center=(0.6, -3.9, 1.0)))
    reef.add(bio.FishSchool("anthias", 70, center=(2.8, -5.2, -2.0), home_radius=2.0))
    reef.add(
        bio.RoamingFish("grey_reef_shark", 1, center=(-4.0, -3.6, -4.5), home=(0.0, -3.8, -1.5))
    )
    reef.add(bio.Plankton(1800, low=(-9.0, -9.0, -8.0), high=(9.0, -0.2, 10.0)))
    vents = Rectangle((-4.0, -4.0), (5.0, 3.0))
    reef.add(bio.Bubbles(6, area=vents, rate=1.3, cluster=16.0, radius=0.006))


def _place_cameras(reef: bio.World) -> None:
    cameras = reef.cameras
    cameras.fixed("garden", position=(0.9, -5.2, 4.7), target=(0.35, -4.45, 0.0), field_of_view=52)
    cameras.follow("school", species="fusilier", index=20, offset=(4.5, 0.8, 4.0), field_of_view=46)
    cameras.follow("shark", species="grey_reef_shark", offset=(1.1, 0.25, 0.9), field_of_view=44)
    cameras.orbit("round", target=(0.3, -4.6, -0.8), radius=5.6, height=0.8, period=80)
    cameras.fixed("upward", position=(1.5, -5.3, 2.2), target=(0.2, -2.2, -0.6), field_of_view=62)
    reef.shots = [("garden", 3.5), ("school", 3.0), ("shark", 3.5), ("upward", 3.5), ("round", 6.0)]
