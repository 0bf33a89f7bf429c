"""Where that which Numba compiled is kept for later processes: the extra `fast`."""

from functools import cache
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryFile

PACKAGE = Path(__file__).parent
USERS = Path("~/.cache").expanduser()  # where the package's own folder cannot be written


@cache
def folder_for(told: str) -> Path | None:
    """The folder for what is compiled from the files as they are, the first that can be written:
    in that which Numba is told, or beside this file or in the user's own; None where none can.
    """
    name = f"ekfsim-{state_of(PACKAGE)}"
    for place in (Path(told),) if told else (PACKAGE / "__pycache__", USERS):
        try:
            (place / name).mkdir(parents=True, exist_ok=True)
            TemporaryFile(dir=place / name).close()
        except OSError:
            continue
        return place / name
    return None


def state_of(package: Path) -> str:
    """A digest of every file of the package that Numba compiles: where one differs, it does."""
    digest = sha256()
    for file in sorted(package.rglob("*.py")):
        name = file.relative_to(package).with_suffix("")
        if "compiled" in name.parts:
            digest.update(f"{name.as_posix()}\0".encode() + file.read_bytes())
    return digest.hexdigest()[:16]
