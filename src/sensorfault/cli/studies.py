"""The installed studies, found by entry point: any package can offer some in the group `sensorfault.studies`.

An entry point names a study, several of them, or a function that returns either. What a study must have: `Study`.
"""

from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import entry_points
from typing import Any, Protocol, runtime_checkable

from sensorfault.core.extras import MissingLibrary, sentence_of_missing
from sensorfault.logs.table import LogError

GROUP = "sensorfault.studies"


@runtime_checkable
class Printed(Protocol):
    """A table as text. `numbers`: the columns that hold numbers."""

    @property
    def heading(self) -> str: ...
    @property
    def columns(self) -> Sequence[str]: ...
    @property
    def rows(self) -> Sequence[Sequence[str]]: ...
    @property
    def numbers(self) -> Sequence[str]: ...


@runtime_checkable
class Reproduction(Protocol):
    """What a study found: sentences, numbers for JSON, tables, and a page of HTML (`facts`: what it ran on)."""

    @property
    def remarks(self) -> Sequence[str]: ...
    def records(self) -> list[dict[str, Any]]: ...
    def tables(self) -> Iterable[Printed]: ...
    def page(self, facts: str) -> str: ...


@runtime_checkable
class Point(Protocol):
    """What is asked of an entry point."""

    @property
    def name(self) -> str: ...
    @property
    def value(self) -> str: ...
    @property
    def dist(self) -> Any: ...
    def load(self) -> Any: ...


@runtime_checkable
class Study(Protocol):
    """The experiments of one paper. `tell` is called with what is being done and the share that is done, 0 to 1."""

    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def paper(self) -> str: ...
    def reproduce(self, seeds: int, quick: bool, tell: Callable[[str, float], None]) -> Reproduction: ...


def installed() -> dict[str, Study]:
    """Every installed study by its name.

    Raises:
        LogError: there is none, two have one name, or an entry point does not give studies.
    """
    found: dict[str, Study] = {}
    offered: dict[str, str] = {}
    for point in entry_points(group=GROUP):
        for study in _given(point):
            if study.name in offered:
                first, second = offered[study.name], _words(point)
                raise LogError(f"two studies are called {study.name}, by {first} and by {second}; rename one.")
            found[study.name], offered[study.name] = study, _words(point)
    if not found:
        raise LogError(f"no study is installed (no entry point {GROUP}); run `pip install sensorfault` again.")
    return found


def _missing(error: BaseException | None) -> str | None:
    """The sentence, where a library of an extra is what an import or its cause lacks."""
    while error is not None:
        if isinstance(error, ImportError) and (sentence := sentence_of_missing(error, "the study")) is not None:
            return sentence
        error = error.__cause__
    return None


def _given(point: Point) -> list[Study]:
    try:
        given = point.load()
        given = given() if callable(given) and not isinstance(given, Study) else given
        studies = [given] if isinstance(given, Study) else list(given)
    except Exception as error:  # whatever another package does
        missing = _missing(error)
        if missing is not None:
            raise MissingLibrary(missing) from error
        reason = str(error) if isinstance(error, ImportError) else f"{type(error).__name__}: {error}"
        raise LogError(f"{_words(point)} cannot be loaded ({reason}); repair or uninstall its package.") from error
    wrong = next((one for one in studies if not isinstance(one, Study)), None)
    if wrong is not None:
        raise LogError(f"{_words(point)} gives a {type(wrong).__name__}, which is no study; repair its package.")
    return studies


def _words(point: Point) -> str:
    """The entry point, as a sentence names it."""
    package = f" of {point.dist.name}" if point.dist is not None else ""
    return f"the entry point {point.name} = {point.value}{package}"
