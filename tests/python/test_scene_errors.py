"""Bad scenes: each is refused before any work, by the dotted path of the wrong key and what is allowed there."""

from __future__ import annotations

import codecs
import re
from itertools import combinations
from pathlib import Path

import pytest
from told.wrong.keys import CASES, GOOD

from isomortar.errors import InputError
from isomortar.model.messages import IN_BRACES, NAMES
from isomortar.scene import Scene
from isomortar.scene.keys import settable_keys
from isomortar.scene.schema import SceneTable
from isomortar.scene.source import parse
from isomortar.scene.toml_text import dump
from isomortar.scene.types import OF_THE_FILE
from isomortar.told.before.faces import of_faces


def test_the_scene_that_the_cases_change_is_good() -> None:
    assert Scene.from_toml(GOOD).problem().name == "good"


@pytest.mark.parametrize(("old", "new", "field", "said"), CASES.values(), ids=CASES.keys())
def test_bad_scene(old: str, new: str, field: str, said: str) -> None:
    assert GOOD.count(old) >= 1
    with pytest.raises(InputError) as error:
        Scene.from_toml(GOOD.replace(old, new, 1)).problem()
    assert error.value.field == field
    assert said in str(error.value)
    assert str(error.value).startswith(f"{field}: ")


#: Keys of a scene whose values are truth values.
TRUE_OR_FALSE = {"rigid"}


@pytest.mark.parametrize("source", ["iron", "tire"])
def test_a_truth_value_is_no_number_and_no_name(source: str) -> None:
    """True is equal to 1, and was taken for it as the format."""
    taken = []
    for key, _ in settable_keys(source):
        try:
            Scene.load(source, {key: True})
        except InputError:
            continue
        taken.append(key)
    assert {key.rpartition(".")[2] for key in taken} == TRUE_OR_FALSE


def test_what_stands_above_all_tables_is_every_table_and_list_of_a_scene() -> None:
    assert set(OF_THE_FILE) == SceneTable.model_fields.keys() - {"format", "name", "title"}


def test_a_free_body_without_contact_is_named() -> None:
    text = GOOD[: GOOD.index("[contacts.pair]")] + GOOD[GOOD.index("[supports.top]") :].replace(
        'face = "upper.w1"', 'face = "upper.w1"\ncomponents = ["z"]'
    )
    with pytest.raises(InputError, match="its supports leave a rigid motion") as error:
        Scene.from_toml(text).problem()
    assert error.value.field == "bodies.upper"


def test_a_plane_holds_nobody() -> None:
    text = Scene.load("press").to_toml()
    text = text[: text.index("[supports.top]")] + '[[stages]]\nname = "rest"\nsteps = 1\n'
    with pytest.raises(InputError, match="is free: it has no support and no load presses it on the plane that it touches"):
        Scene.from_toml(text).problem()


def test_a_closed_ring_has_no_faces_at_its_seam() -> None:
    with pytest.raises(InputError, match="tire is closed in u") as error:
        Scene.load("tire", ["contacts.road.slave=tire.u0"]).problem()
    assert error.value.field == "contacts.road.slave"


def test_supports_that_agree_may_share_control_points() -> None:
    both = GOOD.replace('face = "lower.w0"\n[[', 'face = "lower.w0"\n[supports.side]\nface = "lower.u0"\n[[')
    assert len(Scene.from_toml(both).problem().supports) == 3


@pytest.mark.parametrize(
    ("override", "field", "said"),
    [
        ("bodies.slave.mesh", None, "is not of the form KEY=VALUE"),
        ("bodies.slav.mesh.order=3", "bodies.slav", "bodies there: slave, master"),
        ("stages.darg.steps=3", "stages.darg", "allowed: 0 to 1, drag, press"),
        ("stages.2.steps=3", "stages.2", "allowed: 0 to 1, press, drag"),
        ("bodies.slave.mesh.elements.3=3", "bodies.slave.mesh.elements.3", "allowed: 0 to 2"),
        ("name.first=3", "name.first", "name is the single value 'iron'"),
        ("solver.max_cuts=[3", None, "is not a TOML value"),
        ("solver.max_cuts=3\nsolver.max_iterations = 5", None, "is not a TOML value"),
        ("solver.max_cuts=3\n[solver]", None, "is not a TOML value"),
        ("solver.max_cut=3", "solver.max_cut", "unknown key; allowed here: max_cuts"),
        ("bodies.slave.mesh.odrer=3", "bodies.slave.mesh.odrer", "unknown key; allowed here: order"),
    ],
)
def test_bad_override(override: str, field: str | None, said: str) -> None:
    with pytest.raises(InputError) as error:
        Scene.load("iron", [override])
    assert error.value.field == field
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("path", "value", "field", "said"),
    [
        ("bodies.slave.mesh=", 3, None, "is no path of keys, e.g. solver.max_cuts"),
        ("solver.max_cuts", None, "solver.max_cuts", "is None; allowed: what a scene file can hold"),
        ("supports.top.axis", [1, 0, 1j], "supports.top.axis", "is 1j; allowed"),
        ("solver.max_cuts", "many", "solver.max_cuts", "is 'many'; allowed: a whole number"),
    ],
)
def test_bad_override_by_path(path: str, value: object, field: str | None, said: str) -> None:
    with pytest.raises(InputError) as error:
        Scene.load("iron", {path: value})
    assert error.value.field == field
    assert said in str(error.value)


def test_several_faults_are_told_at_once() -> None:
    with pytest.raises(InputError) as error:
        Scene.from_toml(GOOD.replace("steps = 3", "steps = 0").replace("max_cuts = 4", "max_cuts = -1"))
    assert str(error.value).splitlines() == [
        "stages.press.steps: is 0; allowed: greater than or equal to 1",
        "solver.max_cuts: is -1; allowed: greater than or equal to 0",
    ]


def test_sources_that_are_no_scene() -> None:
    with pytest.raises(InputError, match=r"there is no scene file 'irn', and the bundled scenes are: iron, block, iron-round, press"):
        Scene.load("irn")


#: Texts that are no TOML, the line that is told, and the last words of what is said.
NO_TOML = {
    "value": ("format = = 1", "format = = 1", "a key has = behind it"),
    "comma": ("format = 1\nfriction = 0,4\nname = 'a'\n", "friction = 0,4", "a key has = behind it"),
    "unit": ("a = 1 mm\nb = 2\n", "a = 1 mm", "a key has = behind it"),
    "colon": ("a = 1\nb: 2\nc = 3\n", "b: 2", "a key has = behind it"),
    "comma in braces": ("a = 1\nb = { c = 1, d = 0,4 }\ne = 3\n", "b = { c = 1, d = 0,4 }", "a key has = behind it"),
    "point without digits": ("a = { b = 5., c = 1 }\nd = 1\n", "a = { b = 5., c = 1 }", "in braces one line"),
    "comma at the end": ("a = { b = 1, }\nc = 1\n", "a = { b = 1, }", "no comma at its end"),
    "end": ("format = 1\nname\n\n", "name", "a key has = behind it"),
    "open": ("format = 1\nbodies = [1\n", "bodies = [1", "digits on both sides of a point"),
    "blanks": (f"bodies = {{a=1{' ' * 90}", "bodies = {a=1", "a table in braces one line"),
    "another blank": ("a = 1\nb = [1, 2\u00a0", "b = [1, 2", "digits on both sides of a point"),
    "twice": ("a = 1\na = 2\nb = 1\n", "a = 2", "stands once"),
    "twice at the end": ("a = 1\na = 2", "a = 2", "stands once"),
    "quote": ('format = 1\nname = "a\n[bodies]\n', 'name = "a', "unless they are three"),
    "other quote": ("format = 1\nname = 'a\n[bodies]\n", "name = 'a", "unless they are three"),
    "quotes": ('format = 1\ntitle = """a\n[bodies]\n', 'title = """a', "unless they are three"),
    "other quotes": ("format = 1\ntitle = '''a\n[bodies]\n", "title = '''a", "unless they are three"),
    "quote at the end": ('format = 1\nname = "a', 'name = "a', "unless they are three"),
    "braces": ("format = 1\na = { b = 1,\nc = 2 }\n", "a = { b = 1,", "no comma at its end"),
    "no key": ("a. = 1\n", "a. = 1", "'a. = 1'"),
    "table twice": ("[a]\n[a]\nb = 1\n", "[a]", "stands once"),
}


@pytest.mark.parametrize("what", NO_TOML)
def test_text_that_is_no_toml_is_named_by_its_file_as_it_was_given_and_its_line(tmp_path: Path, what: str) -> None:
    (text, line, end), path = NO_TOML[what], tmp_path / "my scene.toml"
    path.write_text(text)
    for read in (Scene.load, lambda file: list(settable_keys(str(file)))):
        with pytest.raises(InputError) as error:
            read(path)
        assert str(error.value).startswith(f"{path} is not valid TOML: ")
        assert f"where it says {line!r}" in str(error.value)
        assert str(error.value).endswith(end)


#: By the name that a message is to give it: how editors save what they call "Unicode" or "ANSI".
OTHERS = {
    "UTF-16": [codecs.BOM_UTF16_LE + "ö".encode("utf-16-le"), codecs.BOM_UTF16_BE + "a".encode("utf-16-be"), "# a".encode("utf-16-le")],
    "UTF-32": [codecs.BOM_UTF32_LE + "a".encode("utf-32-le"), codecs.BOM_UTF32_BE + "a".encode("utf-32-be")],
    "Latin-1 or Windows-1252": ["# Höhe".encode("latin-1"), "# 5 €".encode("cp1252")],
}


@pytest.mark.parametrize("kind", ["scene", "geometry"])
def test_text_of_another_encoding_is_named_with_its_place_and_the_cure(tmp_path: Path, kind: str) -> None:
    """In every file of text that a scene is made of. A byte-order mark before UTF-8 says nothing, and is no part of it."""
    start, stop = GOOD.index("[bodies.lower.patch]"), GOOD.index("[contacts.pair]")
    patch = GOOD[start:stop].replace("[bodies.lower.patch]", "").encode()
    scene = (GOOD[:start] + GOOD[stop:]).replace('material = "cork"', 'material = "cork"\nfile = "lower.toml"', 1).encode()
    files = {"scene": tmp_path / "scene.toml", "geometry": tmp_path / "lower.toml"}
    for name, content in (("scene", scene), ("geometry", patch)):
        files[name].write_bytes(codecs.BOM_UTF8 + content if name == kind else content)
    assert len(Scene.load(files["scene"]).problem().bodies) == 2
    assert Scene.from_toml(Scene.load(files["scene"]).to_toml()).problem().name == "good"
    for encoding, contents in OTHERS.items():
        for content in contents:
            files[kind].write_bytes(content)
            with pytest.raises(InputError, match=rf"{files[kind].name} is {encoding} text.*save it as UTF-8"):
                Scene.load(files["scene"]).problem()
    files[kind].write_bytes(b"# one\n# t\xf6")
    with pytest.raises(InputError, match="byte 0xf6 in line 2"):
        Scene.load(files["scene"]).problem()


def test_faults_of_a_geometry_file_name_the_file(tmp_path: Path) -> None:
    scene = GOOD.replace('material = "cork"', 'material = "cork"\nfile = "lower.toml"', 1)
    start, stop = scene.index("[bodies.lower.patch]"), scene.index("[contacts.pair]")
    patch = scene[start:stop].replace("[bodies.lower.patch]", "")
    scene = scene[:start] + scene[stop:]
    (tmp_path / "lower.toml").write_text(patch)
    assert len(Scene.from_toml(scene, tmp_path).problem().bodies) == 2
    for old, new, said in (
        ("order", "orders", "in lower.toml, orders: unknown key"),
        ("0.5", "-0.5", "in lower.toml, knots: must not decrease"),
    ):
        (tmp_path / "lower.toml").write_text(patch.replace(old, new, 1))
        with pytest.raises(InputError, match=said) as error:
            Scene.from_toml(scene, tmp_path).problem()
        assert error.value.field == "bodies.lower.file"


@pytest.mark.parametrize("wrong", ["5.", ".5", "1 2", "1;2", "True", "1.e3", "1d0"])
@pytest.mark.parametrize("before", [0, 10, 40, 200])
@pytest.mark.parametrize("braces", ["a = [{}]", "a = {{ b = [{}] }}"])
def test_the_place_that_is_wrong_is_shown_with_what_may_be_wanted(wrong: str, before: int, braces: str) -> None:
    """Of a long line its beginning was shown, and nothing was said of a list."""
    with pytest.raises(InputError) as error:
        Scene.from_toml(braces.format(f"{before * '1, '}{wrong}{before * ', 1'}"))
    said = re.search(r"where it says '([^']*)'\. .*digits on both sides of a point", str(error.value))
    assert said
    assert wrong in said[1]


@pytest.mark.filterwarnings("error")
def test_a_size_that_no_number_holds_is_refused_without_a_warning_of_a_library() -> None:
    with pytest.raises(InputError, match="not finite"):
        Scene.load("press", ["bodies.block.geometry.top=1e308"]).problem()


@pytest.mark.parametrize(
    ("key", "path"),
    [
        ("plane", "contacts.floor.plane"),
        ("force", "supports.top.force"),
        ("mesh", "bodies.block.mesh"),
        ("geometry", "bodies.block.geometry"),
        ("motion", "stages.press.motions.top"),
    ],
)
def test_how_a_table_is_written_is_a_way_to_write_it(key: str, path: str) -> None:
    Scene.load("press", [f"{path}={IN_BRACES[key]}"])
    with pytest.raises(InputError, match=re.escape(f"{path}: is 3; allowed: a table, as {IN_BRACES[key]}")):
        Scene.load("press", [f"{path}=3"])
    with pytest.raises(InputError, match=r"bodies.block: is 3; allowed: a table$"):
        Scene.load("press", ["bodies.block=3"])


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("contacts.interface.slave", "slave.w0"),
        ("contacts.interface.master", "master.w1"),
        ("supports.top.face", "slave.w1"),
        ("bodies.slave.material", "rubber"),
    ],
)
@pytest.mark.parametrize("value", ["3", "{ young = 3 }", "true"])
def test_names_that_something_else_stands_for_are_told_as_names(path: str, name: str, value: str) -> None:
    """Of a slave it was said that a list is allowed, of a material that a text is."""
    allowed = NAMES[path.rpartition(".")[2]]
    given = re.search(r'as "(\w+)', allowed)
    assert given
    assert not path.endswith("material") or given[1] == name
    Scene.load("iron", [f"{path}={name}"])
    with pytest.raises(InputError, match=re.escape(f"{path}: is {'a table' if value[0] == '{' else value}; allowed: {allowed}")):
        Scene.load("iron", [f"{path}={value}"])


def test_of_many_planes_behind_one_each_is_told_once() -> None:
    """And not once for each that lies before it."""
    data = parse(Scene.load("press").to_toml(), "press")
    behind = {
        f"p{k}": {"slave": "block.w0", "plane": {"point": [0, 0, -0.1 * k], "normal": [0, 0, 1]}, "friction": 0.0} for k in range(1, 8)
    }
    data["contacts"] |= behind
    said = [told for told in of_faces(Scene.from_toml(dump(data)).problem()) if "in common" in told]
    assert len(said) == len(behind)
    assert all(sum(f"of '{name}' is at or behind" in told for told in said) == 1 for name in behind)


@pytest.mark.parametrize("size", ["1e300", "1e-300", "1e155", "1e77"])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_sizes_that_no_number_holds_are_refused_before_they_are_squared(size: str) -> None:
    with pytest.raises(InputError, match=r"bodies\.block: body 'block' is .* long; allowed: 1e-76 to 1e\+76"):
        Scene.load("press", [f"bodies.block.geometry={{ kind = 'box', lower = [0, 0, 0], upper = [{size}, {size}, {size}] }}"]).problem()


def test_names_of_other_letters_say_which_letters_names_have() -> None:
    with pytest.raises(InputError, match=r"not valid TOML.*Names have letters from a to z, digits, _ and -$"):
        Scene.from_toml("format = 1\nbodies.klötzchen = {}\n")


#: A block, and four of what has a name: stages, curves of a record, supports that push; and loads beside these.
MANY = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports.base.face = "block.w0"
"""
PLACES = ("w1.u0", "w1.u1", "w1.v0", "w1.v1")
WEIGHTS = "".join(f'loads.{name} = {{ body = "block", weight = [0, 0, -1] }}\n' for name in ("kept", "other"))
PUSHED = 'supports.{} = {{ edge = "block.{}", components = ["x"], force.z = -0.1 }}\n'


@pytest.mark.parametrize(("first", "second"), [*combinations(range(4), 2)])
def test_a_name_that_comes_twice_is_refused_wherever_it_stands(first: int, second: int) -> None:
    names = ["one", "two", "three", "four"]
    names[second] = names[first]
    stages = "stages = [{}]\n".format(", ".join(f'{{ name = "{name}", steps = 1 }}' for name in names))
    curves = "".join(f'[[record.curves]]\nname = "{name}"\nsupport = "base"\n' for name in names)
    for text, field, said in (
        (stages, f"stages.{second}.name", f"{names[first]!r} is the name of two stages"),
        (
            'stages = [{ name = "rest", steps = 1 }]\n' + curves,
            f"record.curves.{second}.name",
            f"{names[first]!r} is the name of two curves",
        ),
    ):
        with pytest.raises(InputError, match=said) as error:
            Scene.from_toml(MANY + text).problem()
        assert error.value.field == field


@pytest.mark.parametrize("which", range(4))
def test_each_support_that_pushes_is_looked_for_among_loads(which: int) -> None:
    names = ["one", "two", "three", "four"]
    names[which] = "other"
    supports = "".join(PUSHED.format(name, place) for name, place in zip(names, PLACES, strict=True))
    with pytest.raises(InputError, match="is the name of a load as well") as error:
        Scene.from_toml(MANY + supports + WEIGHTS + 'stages = [{ name = "push", steps = 1 }]').problem()
    assert error.value.field == "supports.other"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("bloc.w0", "there is no body 'bloc'; allowed: BODY.FACE with BODY one of block, a"),
        ("w0", "names no face; allowed: BODY.FACE with BODY one of a, block"),
        ("block.w0.x", "there is no body 'block.w0'; allowed: BODY.FACE with BODY one of block, a"),
        ("blo.w0", "there is no body 'blo'; allowed: BODY.FACE with BODY one of block, a"),
    ],
)
def test_a_face_of_no_body_names_the_bodies_the_nearest_first(text: str, said: str) -> None:
    a = 'bodies.a.geometry = { kind = "box", lower = [5, 0, 0], upper = [6, 1, 1] }\n'
    scene = MANY.replace("bodies.block", a + "bodies.block", 1) + f'supports.side.face = "{text}"\nstages = [{{ name = "s", steps = 1 }}]'
    with pytest.raises(InputError) as error:
        Scene.from_toml(scene).problem()
    assert said in str(error.value)
    assert error.value.field == "supports.side.face"
