"""The keywords are the library's table, which the command line has its options from."""

import inspect
import re
from typing import get_type_hints

import pytest
from scenes import lit_square, program

import luciole
from luciole import settings

#: Keywords of Python alone, and options that aren't values of a picture.
PYTHONS = {"camera", "surface", "screen", "device", "progress"}


def same(one: str, other: str) -> bool:
    try:
        return float(one) == float(other)
    except ValueError:
        return one == other


def test_typed_keywords_are_the_tables() -> None:
    typed = {name for kind in (settings.ViewKeywords, settings.LightKeywords, settings.PictureKeywords)
             for name in kind.__annotations__}
    assert typed == set(settings.rows(False)) | PYTHONS
    assert set(settings.FileKeywords.__annotations__) == set(settings.rows(True))


def test_every_keyword_is_documented() -> None:
    for name in {**settings.rows(False), **dict.fromkeys(PYTHONS)}:
        assert re.search(rf"^ *(\w+, )*{name}(, \w+)*: ", luciole.render.__doc__ or "", re.M), name
    for name in settings.rows(True):
        assert f"    {name}: " in (luciole.Picture.save.__doc__ or "")


def test_the_command_line_has_an_option_for_each_with_the_same_value() -> None:
    shown = program("help", "render")
    for row in [*settings.rows(False).values(), *settings.rows(True).values()]:
        option = "--" + row["name"].replace("_", "-")
        found = re.search(rf"^ +(?:-\w,)?{option}\b(.*)$", shown, re.M)
        assert found, option
        if row["initial"] and not row["is_flag"] and row["name"] != "exposure":
            # CLI11 2.3 writes =phong, 2.4 [phong], and numbers each in its way.
            told = re.findall(r"=(\S+)|\[([^\]]*)\]", found[1])
            assert any(same(row["initial"], one or other) for one, other in told), (option, found[1])


def test_unknown_keywords_get_a_suggestion() -> None:
    with pytest.raises(TypeError, match=r"render\(\) got an unexpected keyword argument 'sample'; did you mean samples\?"):
        luciole.render(lit_square(), sample=3)  # type: ignore[call-arg]


@pytest.mark.parametrize(
    "keywords, message",
    [
        ({"samples": 0}, "samples: expected a whole number from 1 to 1024, got 0"),
        ({"shadows": "exat"}, "shadows: 'exat' is none of auto, off, hard, pcf, soft, exact, soft-exact; did you mean exact"),
        ({"light_error": -1.0}, "light_error: expected a number or a fraction from 0 to 1, such as 1/256, got -1.0"),
        ({"light_error": float("nan")}, "light_error: expected a number or a fraction"),
        ({"size": (0, 4)}, "size: 0x4 pixels, expected 1 to 32768 a side"),
        ({"size": (1, 2, 3)}, "size: expected WxH"),
        ({"crop": (0, 0, 9999, 1)}, "crop"),
        ({"aovs": ["dept"]}, "aov: 'dept' is none of .*did you mean depth"),
        ({"camera": 7}, "camera: 7 is none of"),
        ({"camera": "front"}, "camera: 'front' is none of"),
        ({"model": "phonk"}, "model: 'phonk'"),
        ({"model": "none.clh"}, "none.clh"),
        ({"surface": 3}, "surface: expected a file's name"),
        ({"screen": "none.clh"}, "none.clh"),
        ({"device": "no such"}, "device"),
        ({"exposure": "bright"}, "exposure: expected stops"),
        ({"samples": object()}, "samples: expected a number, a text or a list of them, got object"),
    ],
)
def test_wrong_values_have_the_command_lines_words(keywords: dict, message: str) -> None:
    scene = lit_square()
    with pytest.raises(luciole.InputError, match=message) as raised:
        luciole.render(scene, **keywords)
    assert isinstance(raised.value, ValueError)


def test_public_names_are_documented() -> None:
    for name in luciole.__all__:
        thing = getattr(luciole, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert inspect.getdoc(value), f"{name}.{member}"
    assert get_type_hints(luciole.Scene.__init__)
