"""What all tests share: no deadlines, as a busy machine is no defect, and pictures or none."""

import pytest
from hypothesis import settings

settings.register_profile("wakeline", deadline=None)
settings.load_profile("wakeline")


@pytest.fixture(autouse=True, scope="session")
def coarse_pictures():
    """Most of the time that a picture takes is that of its dots."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("wakeline.plot.style._DOTS_PER_IN", 50)
        yield


@pytest.fixture
def no_pictures(request, monkeypatch):
    """Pictures take most of the time; they are drawn where a test asks for `pictures`."""
    if "pictures" not in request.fixturenames:
        monkeypatch.setattr("wakeline.cli.outputs.can_draw", lambda: False)


@pytest.fixture
def pictures():
    pytest.importorskip("matplotlib")


@pytest.fixture
def file(tmp_path):
    """Writes text to a named file in a fresh folder and gives its path."""

    def write(text, name="plots.csv"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write
