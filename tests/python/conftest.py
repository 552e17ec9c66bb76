"""What tests of several files are given."""

import sys

import pytest


@pytest.fixture
def root(tmp_path, monkeypatch):
    """A folder of cases with one family; the test works beside it."""
    from harness_cases import GOOD  # within: most tests do not need the harness

    monkeypatch.chdir(tmp_path)
    folder = tmp_path / f"cases_{tmp_path.name}"
    family = folder / f"family_{tmp_path.name}"  # a name of its own: modules stay imported
    family.mkdir(parents=True)
    (folder / "helper.py").write_text("SCALE = 1\n")
    (family / "good.py").write_text(GOOD)
    yield folder
    for name in [n for n in sys.modules if n == "helper" or n.startswith("family_")]:
        del sys.modules[name]
    sys.path[:] = [p for p in sys.path if p != str(folder)]


@pytest.fixture
def unhashed():
    """Hashes are taken anew, in the test and after it."""
    from isomortar.harness import store  # within: as above

    def clear():
        of_program = (store.kernel_hash, store.package_hash, store.program_hash, store.identity)
        for hashed in (*of_program, store._case_hash, store._sources, store._imports_of):
            hashed.cache_clear()

    clear()
    yield clear
    clear()


@pytest.fixture
def invoke(tmp_path, monkeypatch, capsys):
    """Runs a command line in an empty folder; exit code, stdout, stderr."""
    from isomortar import cli  # within: as above

    monkeypatch.chdir(tmp_path)

    def invoke(*words):
        monkeypatch.setattr(sys, "argv", ["isomortar", *words])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        printed = capsys.readouterr()
        return int(ended.value.code or 0), printed.out, printed.err

    return invoke


@pytest.fixture(autouse=True)
def every_step_is_written(monkeypatch):
    """Load steps are on the disk when they are recorded, however long a busy machine takes to write them."""
    monkeypatch.setattr("isomortar.results.writer.BRIEF", float("inf"))
