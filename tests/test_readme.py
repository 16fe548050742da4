"""The README: what it shows is what the program shows, and what it lists runs."""

import importlib.metadata
import io
import re
from contextlib import redirect_stdout

import pytest
from test_chart import printed

from airtrack import parse
from films import HERE, film

Capture = pytest.CaptureFixture[str]
README = (HERE / "README.md").read_text(encoding="utf-8")
LISTINGS: list[str] = re.findall(r"^```\w*\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def listing(part: str) -> str:
    """The one listing that has the part."""
    found, = [text for text in LISTINGS if part in text]
    return found


def test_the_one_pager_is_a_page_and_shows_what_the_program_shows(
        monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    code, slept_s = listing("def settle("), []

    def sleep(seconds: float) -> None:
        slept_s.append(seconds)
        if len(slept_s) == 600:
            raise KeyboardInterrupt

    monkeypatch.setattr("time.sleep", sleep)
    with redirect_stdout(io.StringIO()) as out, pytest.raises(KeyboardInterrupt):
        exec(code, {})
    assert code.count("\n") <= 40
    assert set(slept_s) == {0.015}
    shown = film(capsys, "--frames", "600").lines
    assert [line[:126] for line in out.getvalue().splitlines()] == [line[:126] for line in shown]


def test_the_lines_of_python_print_what_it_says() -> None:
    with redirect_stdout(io.StringIO()) as out:
        exec(listing("from airtrack import"), {})
    assert out.getvalue() == listing("after 11.9 s")


def test_the_map_and_the_chart_s_errors_are_those_of_the_program() -> None:
    assert listing("X  thrown") in printed("stability", "10")
    figures = [re.findall("[0-9.]+e[+-][0-9]+", text) for text in (
        listing("FPS  error m"), printed("chart", "10"))]
    assert len(figures[0]) == 45
    assert figures[0] == figures[1][-45:]


@pytest.mark.parametrize("words", sorted(set(
    re.findall(r"python airtrack\.py ?([^`\[\n]*?)(?=`| *\n|$)", README))))
def test_every_command_line_is_one(words: str) -> None:
    assert callable(parse([word for word in words.split() if word != "--save"
                           and not word.endswith(".png")]))


def test_pip_install_brings_the_dependencies_alone() -> None:
    try:
        files = importlib.metadata.files("airtrack") or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the project is not installed")
    assert [file.name for file in files if file.suffix == ".py"] == []


def test_it_does_not_grow() -> None:
    text = re.sub(r"^```.*?^```$|^\|.*?$", "", README, flags=re.MULTILINE | re.DOTALL)
    assert 1000 < len(text.split()) <= 2000
