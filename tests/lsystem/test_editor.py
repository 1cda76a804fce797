"""The editor of L-systems: its page in a real browser, and its server as strangers meet it."""

import asyncio
import json
import re
import signal
import socket
import subprocess
import sys

import msgspec
import pytest
import websockets

import bioscope as bio

MODEL = """#define LENGTH 1 /* parameter: 0.5 to 4 m, length of a stroke */
lsystem: ladder
derivation length: 4
axiom: A
A --> F(LENGTH)[+F(LENGTH)]A
endlsystem
"""
EXPLODING = "lsystem: doubles\nderivation length: 60\naxiom: A\nA --> AA\nendlsystem\n"


class Server:
    """`bioscope edit` in a process of its own."""

    def __init__(self, file, *arguments):
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
        command = [sys.executable, "-m", "bioscope.cli", "edit", str(file), "--no-open"]
        self.process = subprocess.Popen(
            [*command, "--port", str(port), *arguments], stderr=subprocess.PIPE, text=True
        )
        for line in self.process.stderr:
            if found := re.search(r"editor at (http://\S+)", line):
                self.address = found[1]
                break
        self.port = int(re.search(r":(\d+)/", self.address)[1])

    def close(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(15)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("editor") / "ladder.l"


@pytest.fixture(scope="module")
def server(file):
    file.write_text(MODEL)
    server = Server(file)
    yield server
    server.close()


def talk(server, *requests, origin=None, token=None):
    """Send requests after joining; return the hello and an answer to each."""

    async def scene():
        address = f"ws://127.0.0.1:{server.port}/stream"
        async with websockets.connect(address, max_size=None, origin=origin) as link:
            await link.send(json.dumps({"do": "join", "version": bio.__version__, "token": token}))
            answers = [msgspec.msgpack.decode(await link.recv())]
            for request in requests:
                await link.send(json.dumps(request))
                answers.append(msgspec.msgpack.decode(await asyncio.wait_for(link.recv(), 60)))
            return answers

    return asyncio.run(scene())


def grow(number, text, **options):
    return {"do": "grow", "number": number, "text": text, **options}


def test_plants_grow_and_problems_have_a_place(server):
    hello, grown, step, wrong, exploding, again = talk(
        server,
        grow(1, MODEL),
        grow(2, MODEL, steps=1, homomorphism=True),
        grow(3, MODEL.replace("[+F", "[+F(")),
        grow(4, EXPLODING),
        grow(5, MODEL),
    )
    assert hello["text"] == MODEL
    assert (grown["steps"], grown["modules"], grown["segments"]) == (4, 21, 8)
    assert len(grown["mesh"]["triangles"]) > 0
    assert step["string"] == "F(1)[+F(1)]A"
    assert wrong["problems"][0]["line"] == 5
    assert wrong["problems"][0]["column"] > 1
    assert exploding["problems"][0]["line"] == 4
    assert (wrong["too_large"], exploding["too_large"]) == (False, True)
    assert "modules" in exploding["problems"][0]["message"]
    assert again["string"] == grown["string"]


def test_only_the_opened_file_is_written_and_never_over_a_change(server, file):
    changed = MODEL.replace("4", "5")
    assert talk(server, {"do": "save", "text": changed})[1]["type"] == "saved"
    assert file.read_text() == changed
    assert [one.name for one in file.parent.iterdir()] == [file.name]

    async def scene():
        async with websockets.connect(f"ws://127.0.0.1:{server.port}/stream") as link:
            await link.send(json.dumps({"do": "join", "version": bio.__version__}))
            await link.recv()
            file.write_text("/* by another hand */\n" + MODEL)
            await link.send(json.dumps({"do": "save", "text": MODEL}))
            return msgspec.msgpack.decode(await link.recv())

    answer = asyncio.run(scene())
    assert answer["type"] == "notice"
    assert "another program" in answer["text"]
    assert file.read_text().startswith("/* by another hand */")
    file.write_text(MODEL)


def test_strangers_are_refused(server):
    with pytest.raises(websockets.InvalidStatus):
        talk(server, origin="http://elsewhere.example")
    with pytest.raises(websockets.ConnectionClosedError, match="malformed"):
        talk(server, {"do": "save", "text": "", "file": "/etc/passwd"})


def until(page, condition):
    page.wait_for_function(condition, timeout=120_000)


@pytest.fixture
def page(browser, server):
    page = browser.new_page(viewport={"width": 900, "height": 500})
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    page.set_default_timeout(120_000)
    page.goto(server.address)
    until(page, "window.bioscopeEditor?.plant && window.bioscopeEditor.pictures > 0")
    yield page
    assert page.errors == []
    page.close()


@pytest.mark.browser
def test_an_error_appears_at_its_line_and_goes(page):
    assert page.evaluate("window.bioscopeEditor.plant.modules") == 21
    page.click("text=endlsystem")
    page.keyboard.press("Home")
    page.keyboard.type("B(( --> C\n")
    until(page, "window.bioscopeEditor.problems.some(one => one.line === 6)")
    page.wait_for_selector(".cm-lint-marker-error")
    assert "6:" in page.inner_text(".bio-problems")
    for _ in range(10):
        page.keyboard.press("Backspace")
    until(page, "window.bioscopeEditor.problems.length === 0")


@pytest.mark.browser
def test_sliders_change_text_and_plant(page):
    height = page.evaluate("window.bioscopeEditor.plant.height")
    field = page.locator(".bio-controls input[type=text]").nth(1)
    field.fill("2.5")
    field.press("Enter")
    until(page, f"window.bioscopeEditor.plant.height > 2 * {height}")
    assert "#define LENGTH 2.5 /*" in page.evaluate("window.bioscopeEditor.text")
    page.locator("input[type=range]").fill("2")
    until(page, "window.bioscopeEditor.plant.steps === 2")


@pytest.mark.browser
def test_a_link_opens_the_same_text(page, browser, server):
    page.click("text=endlsystem")
    page.keyboard.press("Home")
    page.keyboard.type("/* from a link */\n")
    text = page.evaluate("window.bioscopeEditor.text")
    page.click("[data-action=share]")
    until(page, "location.hash.includes('model=')")
    other = browser.new_page()
    other.goto(page.evaluate("location.href"))
    until(other, "window.bioscopeEditor?.plant")
    assert other.evaluate("window.bioscopeEditor.text") == text
    assert text != MODEL
    other.close()


@pytest.mark.browser
def test_a_text_that_explodes_is_shown_younger(page, browser):
    page.click("text=endlsystem")
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.insert_text(EXPLODING.replace("AA", "F[+A]A"))
    until(page, "window.bioscopeEditor.problems.length === 1")
    page.click("[data-action=share]")
    until(page, "location.hash.includes('model=')")
    other = browser.new_page()
    other.goto(page.evaluate("location.href"))
    until(other, "window.bioscopeEditor?.plant")
    assert other.evaluate("window.bioscopeEditor.plant.steps") == 15
    assert other.locator(".bio-step").inner_text() == "step 15 of 60"
    other.close()
