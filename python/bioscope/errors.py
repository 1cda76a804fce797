"""What Bioscope raises: one tree, so that `except bioscope.BioscopeError` catches it all."""


class BioscopeError(Exception):
    """Base of all errors of Bioscope's own; the message names the thing and what was expected."""


class InvalidValueError(BioscopeError, ValueError):
    """A parameter, option or argument has a value outside its meaning."""


class UnknownNameError(BioscopeError, LookupError):
    """A species, world, parameter or camera of this name does not exist; known names are listed."""


class FormatError(BioscopeError, ValueError):
    """A file or text is not in the format it should have; the message says where and why."""


class LimitError(BioscopeError, RuntimeError):
    """A bound on time, memory or count was reached."""


class CallbackError(BioscopeError, RuntimeError):
    """Code of the user's own failed and its exception could not be passed on as it was."""


class MissingExtraError(BioscopeError, ImportError):
    """An optional part is not installed; the message says how to install it."""

    def __init__(self, what: str, extra: str) -> None:
        super().__init__(f'{what} needs an optional part: pip install "bioscope[{extra}]"')
