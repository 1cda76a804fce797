"""The world `preying`: what a hungry shark, its prey and those it spares do."""

import bioscope as bio


def hunger(world: bio.World, species: str) -> float:
    (batch,) = (one for one in world.scene.batches if one.species == species)
    return float(world.inspect(int(batch.ids[0]))["values"]["hunger"])


def test_the_shark_eats_its_fill_of_fusiliers_and_spares_the_angelfishes():
    world = bio.load("preying", seed=8)
    before = hunger(world, "blacktip_shark")
    prey = {
        int(one)
        for batch in world.scene.batches
        if batch.species == "fusilier"
        for one in batch.ids
    }
    caught = []
    hungers = [before]
    while world.time < 20.0:
        world.run(seconds=0.5)
        caught += [event for event in world.drain_events() if event.kind == "caught"]
        hungers.append(hunger(world, "blacktip_shark"))
    assert caught
    assert {event.subject for event in caught} <= prey
    assert min(hungers) < 0.3, "who has eaten its fill does not care for food"
    populations = world.populations
    assert populations["fusilier"] + populations["fusilier-2"] == 9 - len(caught)
    assert len(caught) < 9, "some get away"
    assert populations["emperor_angelfish"] == 3


def test_the_prey_schools_and_flees():
    world = bio.load("preying", seed=8)
    world.run(seconds=12)
    kinds = {event.kind for event in world.events}
    assert {"schooled", "escaped"} <= kinds
