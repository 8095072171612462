"""Output files: replaced whole or not at all, through links; a pipe stays a pipe."""

import os
import stat
from pathlib import Path
from threading import Thread

import pytest

from wakeline.recording.files import check_writable, replacing


def write(path, content="new"):
    with replacing(path) as fresh:
        assert fresh.suffix == path.suffix
        fresh.write_text(content)


def test_a_file_is_replaced_when_the_new_one_is_complete(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def interrupted():
        with replacing(path) as fresh:
            fresh.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_text() == "old"
    write(path)
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("there", [True, False])
def test_what_a_link_leads_to_is_replaced_and_the_link_stays(tmp_path, there):
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "target.data", tmp_path / "link.txt"
    if there:
        target.write_text("old")
    link.symlink_to(target)
    check_writable(link)
    write(link)
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert sorted(tmp_path.rglob("*.*")) == [target, link]


def test_a_pipe_takes_the_content_and_stays_a_pipe(tmp_path):
    pipe, got = tmp_path / "pipe.json", []
    os.mkfifo(pipe)
    check_writable(pipe)
    reader = Thread(target=lambda: got.append(pipe.read_text()))
    reader.start()
    write(pipe, "through")
    reader.join(10.0)
    assert got == ["through"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


def test_an_error_of_a_device_names_it():
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("there is no such device")
    with pytest.raises(OSError, match="No space") as reported:
        write(full)
    assert reported.value.filename == str(full)


def test_where_nothing_can_be_written_is_reported_by_the_path_asked_for(tmp_path):
    for path in (tmp_path, tmp_path / "none" / "a.txt"):
        with pytest.raises(OSError, match="directory") as reported:
            check_writable(path)
        assert reported.value.filename == str(path)
