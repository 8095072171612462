"""What all tests share: no deadlines, as a busy machine is no defect, and pictures or none."""

import pytest
from hypothesis import settings

settings.register_profile("wakeline", deadline=None)
settings.load_profile("wakeline")


@pytest.fixture
def no_pictures(request, monkeypatch):
    """Pictures take most of the time; they are drawn where a test asks for `pictures`."""
    if "pictures" not in request.fixturenames:
        monkeypatch.setattr("wakeline.cli.outputs.can_draw", lambda: False)


@pytest.fixture
def pictures():
    pytest.importorskip("matplotlib")
