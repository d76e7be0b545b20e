import os
import pathlib
import subprocess

import pytest

import dismantle

SOURCE = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def box():
    return dismantle.Assembly.from_sample("stacked_box")


@pytest.fixture(scope="session")
def peg():
    return dismantle.Assembly.from_sample("peg_in_hole")


@pytest.fixture(scope="session")
def machine():
    return dismantle.Assembly.from_sample("machine")


@pytest.fixture(scope="session")
def program():
    """Runs the command line; returns what it printed."""

    def run(*arguments, status=0):
        done = subprocess.run([os.environ["DISMANTLE"], *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def source():
    return SOURCE
