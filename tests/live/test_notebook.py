"""A world in a notebook: the widget, and the stream that it carries."""

import time

import msgspec
import pytest
from conftest import small_world

import bioscope as bio
from bioscope.live.notebook import Watch, in_notebook, widget


class Cell:
    """The kernel's side of a widget, with a page that is a test."""

    def __init__(self):
        self.got = []

    def on_msg(self, callback):
        self.say = lambda **command: callback(self, command, [])

    def send(self, content, buffers):
        assert content == {}
        self.got += [msgspec.msgpack.decode(bytes(one)) for one in buffers]

    def until(self, wanted, seconds=30.0):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            for message in [*self.got]:
                if wanted(message):
                    return message
            time.sleep(0.02)
        raise AssertionError([one["type"] for one in self.got])

    def kinds(self):
        return [one["type"] for one in self.got]


@pytest.fixture
def cell():
    cell = Cell()
    cell.watch = Watch(small_world(), cell)
    yield cell
    cell.watch.close()


def test_a_cell_gets_the_stream_once_it_has_joined(cell):
    time.sleep(0.2)
    assert cell.got == []
    cell.say(do="join", version=bio.__version__)
    cell.until(lambda one: one["type"] == "frame")
    kinds = cell.kinds()
    assert kinds[0] == "hello"
    assert kinds.index("layout") < kinds.index("frame")


def test_nothing_comes_before_the_greeting_of_a_slow_world(cell, monkeypatch):
    greeting = cell.watch.session.greeting

    def slow():
        time.sleep(0.3)
        return greeting()

    monkeypatch.setattr(cell.watch.session, "greeting", slow)
    cell.say(do="join", version=bio.__version__)
    assert cell.until(lambda one: one["type"] == "frame")
    assert cell.kinds()[0] == "hello"


def test_a_cell_is_sent_no_more_than_it_shows(cell):
    cell.say(do="join", version=bio.__version__)
    cell.until(lambda one: one["type"] == "frame")
    cell.say(do="select", id=1, retina=[16, 16])
    cell.until(lambda one: one["type"] == "inspection")
    time.sleep(1.0)
    assert cell.kinds().count("frame") <= 2
    assert cell.kinds().count("inspection") == 1
    cell.say(do="inspected")
    cell.say(do="seen", tick=0)
    deadline = time.monotonic() + 30
    while cell.kinds().count("inspection") < 2 and time.monotonic() < deadline:
        time.sleep(0.02)
    assert cell.kinds().count("inspection") == 2


def test_nonsense_is_answered(cell):
    cell.say(do="fly")
    assert "malformed" in cell.until(lambda one: one["type"] == "notice")["text"]


def test_a_widget_is_as_high_as_asked(world):
    assert not in_notebook()
    view = widget(world, height=420)
    try:
        assert view.height == 420
        assert "export" in view._esm
    finally:
        view.watch.close()
