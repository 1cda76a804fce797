"""Definition files of behavioral L-systems that tests write."""

from bioscope.lsystem import Animation

NONE = "() () () () () () ()"
LINE = "R () () () () (1) () ()"
TURNS = "+ () () () () (40) () ()\n& () () () () (25) () ()\n$ () () () () (70) () ()"


def text(*symbols: str, head: str = "") -> str:
    return f"{head}\nAxiom\n" + "\n".join(symbols) + "\nProductions\nEndProductions\n"


def animation(*symbols: str, head: str = "", **options) -> Animation:
    return Animation(text(*symbols, head=head), **options)
