"""Files of results as the disk has them: sealed, so that damage is seen before HDF5 reads any of it, and held by one run at a time."""

from __future__ import annotations

import fcntl
import hashlib
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from isomortar.errors import ResultsError

#: A results file begins with so many bytes that HDF5 leaves to its user: the mark, and the digest of all that follows.
SEAL_SIZE = 512
_MARK = b"isomortar results file; SHA-256 of all bytes from 512 on: "


def sealed(content: bytes) -> bytes:
    """The content of a results file with the seal in its first bytes, which are free for it."""
    return seal(memoryview(content)[SEAL_SIZE:]) + content[SEAL_SIZE:]


def seal(content: bytes | memoryview) -> bytes:
    """The first bytes of a results file, before its content."""
    return _with_digest(hashlib.sha256(content).hexdigest())


def is_marked(path: Path) -> bool:
    """Whether a file begins as results files do, be it whole or damaged."""
    with path.open("rb") as file:
        return file.read(len(_MARK)) == _MARK


def is_whole(path: Path) -> bool:
    """Whether each byte of a file is the one that was written, by its seal."""
    with path.open("rb") as file:
        return file.read(SEAL_SIZE) == _with_digest(hashlib.file_digest(file, "sha256").hexdigest())


def read(path: Path) -> bytes:
    """The content of a results file.

    Raises
    ------
    ResultsError
        It is gone, damaged, or the system refuses it.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise ResultsError(f"{path} cannot be read: {error.strerror or error}") from error
    if sealed(content) != content:
        raise ResultsError(f"{path} cannot be read: it is damaged, or was changed by something else")
    return content


def _with_digest(digest: str) -> bytes:
    return (_MARK + digest.encode() + b"\n").ljust(SEAL_SIZE, b"\0")


@contextmanager
def named(path: Path) -> Iterator[None]:
    """What the system refuses while `path` is written becomes an error that names it."""
    try:
        yield
    except OSError as error:
        raise ResultsError(f"{path} cannot be written: {error.strerror or error}") from error


@contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Where to write what is `path` once it is whole: whatever happens meanwhile, no part of it has that name, and what had it stays.

    Half a film looks like a whole one, and a kill takes nothing away.
    """
    whole = path.resolve()
    fresh = whole.with_name(f".{whole.stem}.{os.getpid()}-{threading.get_native_id()}.new{whole.suffix}")
    try:
        with named(path):
            yield fresh
            _put(fresh, whole)
    finally:
        with suppress(OSError):
            fresh.unlink()


def write_whole(path: Path, text: str) -> None:
    """Write a file so that a reader finds the old or the new one, never a part, in a folder that is made where it is not there.

    Raises
    ------
    ResultsError
        The system refused; the old file stands, and no part of the new one is left.
    """
    make_folder(path.parent)
    with writing(path) as fresh:
        fresh.write_text(text, encoding="utf-8")


def place_for(path: Path) -> None:
    """See that a file can be made, in a folder that is made where it is not there: never in the place of a results file.

    Raises
    ------
    ResultsError
        There is a results file; or the folder cannot be made.
    """
    if path.is_file() and is_marked(path):
        raise ResultsError(f"{path} is a results file, so it is not overwritten: name another file with --output")
    make_folder(path.parent)


def make_folder(path: Path) -> None:
    """Make a folder and those above it, where they are not there."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        file = next(above for above in (path, *path.parents) if above.exists())
        raise ResultsError(f"folder {path} cannot be made: {file} is a file, and no folder") from error
    except OSError as error:
        raise ResultsError(f"folder {path} cannot be made: {error.strerror or error}") from error


def replace(path: Path, *parts: bytes) -> None:
    """Put a whole file, given in parts, in the place of another, or of none: whatever happens meanwhile, the name stands for one of them.

    Raises
    ------
    ResultsError
        The system refused; the old file stands.
    """
    fresh = path.with_name(f".{path.name}.new")
    make_folder(path.parent)
    try:
        with fresh.open("wb") as file:
            file.writelines(parts)
        _put(fresh, path)
    except OSError as error:
        raise ResultsError(f"{path} cannot be written: {error.strerror or error}") from error
    finally:
        with suppress(OSError):
            fresh.unlink()


@contextmanager
def claimed(path: Path) -> Iterator[None]:
    """Hold a results file against other runs; the system lets go of it when the process ends, however it ends.

    The lock is on a file beside it, `.NAME.lock`, since the results file itself is replaced at every load step.

    Raises
    ------
    ResultsError
        Another run holds it, or the folder cannot be written.
    """
    lock = path.with_name(f".{path.name}.lock")
    make_folder(path.parent)
    try:
        descriptor = _locked(lock)
    except BlockingIOError as error:
        raise ResultsError(f"another run is writing {path}: let it end, or name another results file") from error
    except OSError as error:
        raise ResultsError(f"{path} cannot be written: {error.strerror or error}") from error
    try:
        yield
    finally:
        with suppress(OSError):
            lock.unlink()
        os.close(descriptor)


def _locked(lock: Path) -> int:
    """Descriptor of the lock file, with the lock on it; a file that its last holder removed meanwhile is not the one to hold."""
    while True:
        descriptor = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(descriptor), lock.stat()):
                    return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _put(fresh: Path, whole: Path) -> None:
    """Give a new file its name once the disk has all of it, and have the disk know the name."""
    _flush(fresh)
    fresh.replace(whole)
    _flush(whole.parent)


def _flush(path: Path) -> None:
    """Have the operating system put a file, or a folder's entries, on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
