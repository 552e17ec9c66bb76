"""How commands end: a sentence and an exit code for whatever the environment does to them, and no traceback."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from isomortar.cli.endings import told
from isomortar.errors import ConvergenceError, InputError

LAUNCH = Path(__file__).parents[2] / "tools" / "launch.py"
# A shell starts background jobs with SIGINT ignored, and children inherit that.
HEARS = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); print('ready', flush=True); "
# Compiled before: a traceback of what loads the program is not the program's.
RUNS = f"launch = compile(open({str(LAUNCH)!r}).read(), 'launch', 'exec'); " + HEARS + "exec(launch, {'__name__': '__main__'})"


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("is 3", "solver.max_cuts"), 2, ["solver.max_cuts: is 3"]),
        (ConvergenceError("load step 4 does not converge"), 1, ["load step 4"]),
        (OSError(28, "No space left on device"), 1, ["No space left on device"]),
        (OSError(13, "Permission denied", "a.h5"), 1, ["Permission denied: a.h5"]),
        (OSError("h5py's own"), 1, ["h5py's own"]),
        (MemoryError("Unable to allocate 3 TiB"), 1, ["memory ran out"]),
        (ImportError("libumfpack.so.5: cannot open"), 1, ["the installation is not complete", "libumfpack.so.5"]),
        (ZeroDivisionError("division by zero"), 3, ["ZeroDivisionError: division by zero", "fault of the program", "report"]),
        (KeyboardInterrupt(), 130, ["interrupted"]),
        (SystemExit(130), 130, ["interrupted"]),
    ],
)
def test_every_error_has_its_sentence_and_code(
    error: BaseException, code: int, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended, told():
        raise error
    said = capsys.readouterr().err
    assert ended.value.code == code
    assert said.startswith("isomortar: ")
    assert said.count("\n") == 1
    assert all(word in said for word in words)
    assert "None" not in said


def test_what_ends_well_is_left_alone(capsys: pytest.CaptureFixture[str]) -> None:
    with told():
        pass
    with pytest.raises(SystemExit) as ended, told():
        sys.exit(1)
    assert ended.value.code == 1
    assert capsys.readouterr().err == ""


def test_ctrl_c_while_the_program_loads(tmp_path: Path) -> None:
    """At random moments of the first 0.4 s: from the first line of the program on, no traceback."""
    chance = random.Random(3)
    for words in [["run", "press", "--output", "run.h5"], ["schema"], ["bench", "--quick", "--cases", "nowhere"]] * 4:
        with subprocess.Popen(
            [sys.executable, "-c", RUNS, *words], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as process:
            assert process.stdout is not None
            process.stdout.readline()
            time.sleep(0.4 * chance.random())
            process.send_signal(signal.SIGINT)
            _, said = process.communicate(timeout=60)
        assert "Traceback" not in said
        assert process.returncode in (0, 1, 2, 130, -signal.SIGINT)


@pytest.mark.parametrize("lost", ["def __del__(self): wait()", "weak = True"])
def test_ctrl_c_is_heard_where_python_drops_it(lost: str) -> None:
    """What is raised in a destructor, or when something is found to be gone, is printed by Python, and forgotten."""
    program = (
        "import signal, time, weakref; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from isomortar.cli.endings import told\n"
        "import isomortar.cli\n"
        "def wait(*_): print('ready', flush=True); time.sleep(20)\n"
        f"class Goes:\n    {lost}\n"
        "with told():\n"
        "    goes = Goes()\n"
        "    seen = weakref.ref(goes, wait) if hasattr(Goes, 'weak') else None\n"
        "    del goes\n"
        "    time.sleep(30)\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=15)
    assert said == "isomortar: interrupted\n"
    assert process.returncode == 130


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_is_asked_to_end_says_how_far_it_came(tmp_path: Path, number: signal.Signals) -> None:
    with subprocess.Popen([sys.executable, "-c", RUNS, "run", "iron"], cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        while "step  2/50" not in process.stderr.readline():
            pass
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    *_, left, ended = said.splitlines()
    assert left.endswith("of 50 load steps done; they are in results/iron.h5; to go on, repeat the command with --resume")
    assert ended == "isomortar: interrupted"
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["iron.h5"]


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Who runs tests in the background of a shell has Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_is_told_of_where_an_extension_makes_another_error_of_it(capsys: pytest.CaptureFixture[str]) -> None:
    def loads() -> None:
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            raise ImportError("initialization failed") from None

    with pytest.raises(SystemExit) as ended, told():
        loads()
    assert (ended.value.code, capsys.readouterr().err) == (130, "isomortar: interrupted\n")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_name_longer_than_any_path_is_shortened_in_its_sentence(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(f'format = 1\nname = "{"a" * 100_000}"\n"{"b" * 100_000}" = 1\n')
    done = subprocess.run([sys.executable, "-m", "isomortar", "run", str(scene)], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert len(done.stderr) < 5000
    assert "bbb...bbb" in done.stderr


def test_output_that_nobody_takes() -> None:
    for words in (["scenes"], ["schema"], ["--help"], ["--version"]):
        with Path("/dev/full").open("w") as full:
            done = subprocess.run([sys.executable, "-m", "isomortar", *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode == 1
        assert "No space left on device" in done.stderr
        assert "Traceback" not in done.stderr


def test_a_working_copy_that_may_not_be_built(tmp_path: Path) -> None:
    """Stands for another account: the import is refused by the system, or ends in the compiler's words."""
    (tmp_path / "isomortar").mkdir()
    for raised, words in (
        ("PermissionError(13, 'Permission denied', 'build/log.txt')", ["Permission denied: build/log.txt", "pip install ."]),
        ("ImportError('rebuilding failed')", ["rebuilding failed"]),
    ):
        (tmp_path / "isomortar" / "__init__.py").write_text(f"raise {raised}")
        done = subprocess.run(
            [sys.executable, "-S", LAUNCH], env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=False
        )
        assert done.returncode == 1
        assert "Traceback" not in done.stderr
        assert all(word in done.stderr for word in words)


def test_a_process_that_the_command_starts_is_not_the_command_again() -> None:
    """It imports the file that the command was started from, under another name."""
    again = f"import runpy; runpy.run_path({str(LAUNCH)!r}, run_name='__mp_main__')"
    done = subprocess.run([sys.executable, "-c", again, "scenes"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_output_that_is_closed() -> None:
    for words in (["scenes"], ["check", "press", "--set", "bodies.block.mesh.elements=[2,2,1]"]):
        command = f'"{sys.executable}" -m isomortar {" ".join(words)} >&-'
        done = subprocess.run(command, shell=True, stderr=subprocess.PIPE, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")


def test_a_terminal_that_lacks_letters() -> None:
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run([sys.executable, "-m", "isomortar", "--help"], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "isomortar scenes lists the scenes" in done.stdout


def test_figures_need_no_window_system_that_is_there() -> None:
    """Nor does a program of one's own lose the one that it has."""
    shown = "import matplotlib; print(matplotlib.get_backend())"
    command = (
        f"import atexit, isomortar.cli, sys; atexit.register(lambda: exec({shown!r})); sys.argv = ['', '--version']; isomortar.cli.main()"
    )
    for program, backend, expected in ((command, "nonsense", "agg"), (f"import isomortar.cli.progress; {shown}", "svg", "svg")):
        environment = os.environ | {"MPLBACKEND": backend}
        done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False)
        assert (done.stdout.splitlines()[-1], done.stderr) == (expected, "")
