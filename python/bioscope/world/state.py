"""How the state of populations and fields written in Python becomes bytes and back.

Plain data only: numbers, texts, truth values, none, lists, tuples, dicts and numpy arrays. Nothing
in a saved world is ever evaluated as code.
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np

from bioscope.errors import FormatError, InvalidValueError

_ARRAY = 1
_TUPLE = 2
_INTEGER = 3


def to_bytes(owner: str, state: dict[str, Any]) -> bytes:
    """Encode a state; equal states give equal bytes.

    Raises `InvalidValueError` naming the attribute that is not plain data.
    """
    parts = {}
    for name in sorted(state):
        try:
            parts[name] = msgspec.Raw(_encoder.encode(_wrapped(state[name])))
        except (TypeError, OverflowError, ValueError) as error:
            raise InvalidValueError(
                f"{owner}.{name} = {type(state[name]).__name__}: expected numbers, texts, lists, "
                f"dicts or numpy arrays (name it in `transient` to leave it out): {error}"
            ) from None
    return _encoder.encode(parts)


def from_bytes(owner: str, data: bytes) -> dict[str, Any]:
    """Decode what `to_bytes` made.

    Raises `FormatError` if the bytes are something else.
    """
    try:
        state = _decoder.decode(data)
    except (msgspec.DecodeError, ValueError, TypeError) as error:
        raise FormatError(f"{owner}: not a valid saved state ({error})") from None
    if not isinstance(state, dict):
        raise FormatError(f"{owner}: not a valid saved state (no map of attributes)")
    return state


def _wrapped(value: Any) -> Any:
    """Mark what MessagePack alone would not bring back as it was."""
    if isinstance(value, tuple):
        return msgspec.msgpack.Ext(_TUPLE, _encoder.encode([_wrapped(one) for one in value]))
    if isinstance(value, list):
        return [_wrapped(one) for one in value]
    if isinstance(value, dict):
        return {key: _wrapped(one) for key, one in value.items()}
    if isinstance(value, int) and not isinstance(value, bool) and not -(2**63) <= value < 2**64:
        return msgspec.msgpack.Ext(_INTEGER, str(value).encode())
    return value


def _encode_other(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.dtype.kind in "biufc":
        header = _encoder.encode([value.dtype.str, list(value.shape)])
        body = np.ascontiguousarray(value).tobytes()
        return msgspec.msgpack.Ext(_ARRAY, len(header).to_bytes(4, "little") + header + body)
    if isinstance(value, np.generic) and value.dtype.kind in "biufc":
        return _encode_other(np.asarray(value))
    raise TypeError(f"{type(value).__name__} is not plain data")


def _decode_other(code: int, data: memoryview) -> Any:
    if code == _TUPLE:
        return tuple(_decoder.decode(data))
    if code == _INTEGER:
        return int(bytes(data))
    if code != _ARRAY:
        raise ValueError(f"unknown extension {code}")
    length = int.from_bytes(data[:4], "little")
    dtype, shape = msgspec.msgpack.decode(data[4 : 4 + length], type=tuple[str, list[int]])
    if np.dtype(dtype).kind not in "biufc":
        raise ValueError(f"arrays of {dtype} are not plain data")
    array = np.frombuffer(data[4 + length :], dtype=dtype).reshape(shape)
    return array.copy() if shape else array[()]


_encoder = msgspec.msgpack.Encoder(enc_hook=_encode_other)
_decoder = msgspec.msgpack.Decoder(ext_hook=_decode_other)
