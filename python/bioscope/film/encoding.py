"""Encoding: pictures and sound to H.264 and AAC in MP4, by PyAV or by an ffmpeg on the path.

A film is encoded in segments, each a whole file, so that what is finished survives any
interruption; the segments are joined without encoding them again.
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import wave
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from bioscope.errors import BioscopeError, MissingExtraError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

_QUALITY = "20"
"""Constant rate factor of x264: 18 looks perfect, 23 is its default."""
_SOUND_BITS_PER_SECOND = 192_000


class Encoder(Protocol):
    """Writes segments and joins them."""

    def segment(self, path: Path, pictures: Iterable[NDArray[np.uint8]], rate: float) -> None:
        """Write pictures (height, width, 3) as one H.264 file."""

    def join(self, segments: list[Path], sound: Path, path: Path) -> None:
        """Join segments and a WAV file to one MP4."""


def encoder() -> Encoder:
    """Return the encoder that is installed.

    Raises
    ------
    MissingExtraError
        If there is neither PyAV nor ffmpeg.
    """
    if importlib.util.find_spec("av"):
        return AvEncoder()
    if program := shutil.which("ffmpeg"):
        return FfmpegEncoder(program)
    raise MissingExtraError("A film in MP4 (or use --frames for pictures)", "film")


def write_wav(path: Path, blocks: Iterable[NDArray[np.float32]], rate: int) -> None:
    """Write blocks of stereo samples (n, 2), full scale 1, as a 16-bit WAV file."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(rate)
        for block in blocks:
            whole = np.clip(np.rint(block * 32767.0), -32768, 32767).astype("<i2")
            file.writeframes(whole.tobytes())


class AvEncoder:
    """PyAV, the libraries of ffmpeg in the process."""

    def segment(self, path: Path, pictures: Iterable[NDArray[np.uint8]], rate: float) -> None:
        """Write pictures as one H.264 file."""
        import av

        with av.open(str(path), "w", format="mp4") as container:
            stream: Any = None
            for picture in pictures:
                if stream is None:
                    stream = self._video(container, picture.shape, rate)
                frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
                container.mux(stream.encode(frame))
            if stream is not None:
                container.mux(stream.encode())

    @staticmethod
    def _video(container: Any, shape: tuple[int, ...], rate: float) -> Any:
        options = {"crf": _QUALITY, "preset": "veryfast", "bf": "0"}
        stream = container.add_stream(
            "libx264", rate=Fraction(rate).limit_denominator(1001), options=options
        )
        stream.width, stream.height = shape[1], shape[0]
        stream.pix_fmt = "yuv420p"
        return stream

    def join(self, segments: list[Path], sound: Path, path: Path) -> None:
        """Join segments and a WAV file to one MP4."""
        import av

        with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as out:
            with av.open(str(segments[0])) as first:
                video = out.add_stream_from_template(first.streams.video[0])
            with av.open(str(sound)) as source:
                track = source.streams.audio[0]
                audio: Any = out.add_stream("aac", rate=track.rate)
                audio.bit_rate = _SOUND_BITS_PER_SECOND
                for frame in source.decode(track):
                    out.mux(audio.encode(frame))
                out.mux(audio.encode())
            offset = 0
            for segment in segments:
                offset = self._append(segment, out, video, offset)

    @staticmethod
    def _append(segment: Path, out: Any, video: Any, offset: int) -> int:
        """Copy a segment's packets, `offset` of its time base later; return the next offset."""
        import av

        with av.open(str(segment)) as source:
            stream = source.streams.video[0]
            length = 0
            for packet in source.demux(stream):
                if packet.dts is None:
                    continue
                length = max(length, (packet.pts or 0) + (packet.duration or 0))
                packet.pts = (packet.pts or 0) + offset
                packet.dts += offset
                packet.stream = video
                out.mux(packet)
        return offset + length


class FfmpegEncoder:
    """The ffmpeg program, fed through a pipe."""

    def __init__(self, program: str) -> None:
        self._program = program

    def segment(self, path: Path, pictures: Iterable[NDArray[np.uint8]], rate: float) -> None:
        """Write pictures as one H.264 file."""
        process: subprocess.Popen[bytes] | None = None
        for picture in pictures:
            if process is None:
                height, width = picture.shape[:2]
                source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
                source += ["-r", str(Fraction(rate).limit_denominator(1001)), "-i", "-"]
                result = ["-c:v", "libx264", "-crf", _QUALITY, "-preset", "veryfast", "-bf", "0"]
                result += ["-pix_fmt", "yuv420p", "-f", "mp4", str(path)]
                process = self._start([*source, *result])
            assert process.stdin is not None
            process.stdin.write(np.ascontiguousarray(picture).data)
        if process is not None:
            self._finish(process)

    def join(self, segments: list[Path], sound: Path, path: Path) -> None:
        """Join segments and a WAV file to one MP4."""
        listing = sound.with_suffix(".txt")
        names = "".join(f"file '{one.resolve()}'\n" for one in segments)
        listing.write_text(names, encoding="utf-8")
        source = ["-f", "concat", "-safe", "0", "-i", str(listing), "-i", str(sound)]
        result = ["-c:v", "copy", "-c:a", "aac", "-b:a", str(_SOUND_BITS_PER_SECOND)]
        result += ["-movflags", "+faststart", "-f", "mp4", str(path)]
        self._finish(self._start([*source, *result]))

    def _start(self, arguments: list[str]) -> subprocess.Popen[bytes]:
        command = [self._program, "-y", "-loglevel", "error", *arguments]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)

    @staticmethod
    def _finish(process: subprocess.Popen[bytes]) -> None:
        _, errors = process.communicate()
        if process.returncode:
            told = errors.decode(errors="replace").strip().splitlines()
            raise BioscopeError(f"ffmpeg failed: {told[-1] if told else process.returncode}")
