"""A file on another computer's disk is refused, by the table of mounts or by its path."""

from pathlib import Path

import pytest

from shaftprint.errors import StoreError
from shaftprint.store import create_store
from shaftprint.store.database._database import network_file_system

# as /proc/self/mountinfo gives it (Linux, Documentation/filesystems/proc.rst, 3.5)
MOUNTS = """\
22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw
36 22 0:31 / /yard rw,relatime shared:2 master:7 - nfs4 server:/export rw,vers=4.2
37 36 8:2 / /yard/local rw,relatime - xfs /dev/sdb1 rw
38 22 0:32 / /office\\040share rw - cifs //server/share rw
39 22 0:33 / /over rw - nfs server:/a rw
40 22 8:3 / /over rw - ext4 /dev/sdc1 rw
41 22 0:34 / /home/me/sea rw - fuse.sshfs me@ship: rw
a line that is none
"""


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/fleet.db", None),
        ("/yard/fleet.db", "nfs4"),
        ("/yard/deep/er/fleet.db", "nfs4"),
        ("/yardstick/fleet.db", None),
        ("/yard/local/fleet.db", None),
        ("/office share/fleet.db", "cifs"),
        # what was mounted last at a place covers what was there
        ("/over/fleet.db", None),
        ("/home/me/sea/fleet.db", "fuse.sshfs"),
        ("/yard/local/../fleet.db", "nfs4"),
    ],
)
def test_the_longest_mount_point_says_what_a_disk_is(path, kind):
    assert network_file_system(Path(path), mounts=MOUNTS) == kind


@pytest.mark.parametrize("path", [r"\\server\share\fleet.db", "//server/share/fleet.db", r"\\?\UNC\server\share\f.db"])
def test_a_unc_path_is_on_another_computer(path):
    expected = None if path.startswith("//") and str(Path(path)) != path else "a UNC path"
    assert network_file_system(Path(path), mounts="") == expected


def test_a_link_leads_to_where_it_leads(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "there")
    mounts = f"36 22 0:31 / {tmp_path / 'there'} rw - nfs server:/a rw\n"
    assert network_file_system(tmp_path / "link" / "fleet.db", mounts=mounts) == "nfs"


def test_a_store_there_is_refused_with_path_and_reason():
    with pytest.raises(StoreError) as refusal:
        create_store(r"\\server\share\fleet.db")
    assert str(refusal.value).startswith(
        r"\\server\share\fleet.db: expected a disk of this computer, found a UNC path: "
    )
    assert "choose a local folder, or for several computers PostgreSQL" in str(refusal.value)
