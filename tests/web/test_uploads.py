"""Files that come in: whole or not at all, within their limits, below the folder that is theirs."""

import hashlib

import pytest
from tests.web.client import form_of
from tests.web.conftest import ADA

LINE = f"{ADA}/port"


def kept(site):
    """Return the content of what was uploaded by the test itself."""
    folders = [one for one in site.service.recordings.iterdir() if one.name not in site.uploads.values()]
    return [path for folder in folders for path in folder.iterdir()]


@pytest.mark.parametrize("size", [1, 2, 3, 7, 40, 200, 5000])
def test_a_form_gives_its_file_byte_by_byte_however_it_is_cut(site, size):
    browser = site.person("tester-ada")
    content = b"\r\n--frontie\r\n--frontier-x\r\r\n\n--" + bytes(range(256)) * 3
    kind, body = form_of({"token": browser.known(), "line": LINE}, "log.nc", content)
    pieces = [body[start : start + size] for start in range(0, len(body), size)]
    answer = browser.ask("POST", "/upload", pieces=pieces, heads=[("content-type", kind)])
    assert answer.status == 303, answer.text
    (path,) = kept(site)
    # a line that only begins as a boundary does is none
    assert path.read_bytes() == content
    shown = browser.get(answer.heads["location"].replace("/recordings", "/api/v1/recordings")).json["upload"]
    assert shown["sha256"] == hashlib.sha256(content).hexdigest()
    assert shown["size"] == len(content)


def test_a_file_is_put_as_it_is(site):
    browser = site.person("tester-ada")
    answer = browser.put(f"/api/v1/recordings/log.nc?line={LINE}", b"abc")
    assert answer.status == 201
    # FIPS 180-2, appendix B.1
    assert answer.json["sha256"] == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    (path,) = kept(site)
    assert (path.name, path.read_bytes()) == ("log.nc", b"abc")


def test_a_file_that_is_too_large_leaves_nothing(made):
    site = made(most_upload=1000)
    browser = site.person("tester-ada")
    token = browser.known()
    pieces = [b"x" * 400] * 3
    for heads in ([], [("content-length", "70000")]):
        sent = browser.ask(
            "PUT", f"/api/v1/recordings/a.nc?line={LINE}", pieces=pieces, heads=[("x-csrf-token", token), *heads]
        )
        assert sent.status == 413
    assert kept(site) == []


def test_a_form_that_is_cut_off_leaves_nothing(site):
    browser = site.person("tester-ada")
    kind, body = form_of({"token": browser.known(), "line": LINE}, "log.nc", b"x" * 900)
    for end in (60, 300, len(body) - 30):
        sent = browser.ask("POST", "/upload", body=body[:end], heads=[("content-type", kind)])
        assert sent.status == 400, end
    assert kept(site) == []


@pytest.mark.parametrize(
    ("name", "status"),
    [
        ("../../etc/passwd", 201), ("..%2f..%2fx.nc", 201), ("C:\\x\\log.nc", 201), ("log.nc", 201),
        (".hidden.nc", 201),
        ("my_line.py", 400), ("a.PY", 400), ("all.zip", 400), ("x.pickle", 400), ("", 400), ("..", 400),
        ("n" * 200, 400),
        ("a\nb.nc", 201), ("a\u202eb.nc", 201),
    ],
)  # fmt: skip
def test_names_stay_below_the_folder_and_programs_stay_outside(site, name, status):
    browser = site.person("tester-ada")
    kind, body = form_of({"token": browser.known(), "line": LINE}, name, b"x")
    answer = browser.ask("POST", "/upload", body=body, heads=[("content-type", kind)])
    assert answer.status == (303 if status == 201 else status), answer.text
    paths = kept(site)
    assert len(paths) == (status == 201)
    for path in paths:
        assert path.resolve().parent.parent == site.service.recordings.resolve()
        assert path.name.isprintable()
        assert not path.name.startswith(".")


def test_an_empty_file_is_refused(site):
    assert site.person("tester-ada").put(f"/api/v1/recordings/a.nc?line={LINE}", b"").status == 400


def test_only_what_lies_in_an_allowed_folder_is_found(made, tmp_path):
    root, beside = tmp_path / "yard", tmp_path / "beside"
    for folder in (root / "2026", beside):
        folder.mkdir(parents=True)
        (folder / "log.nc").write_bytes(b"x")
    (root / ".hidden").write_bytes(b"x")
    (root / "out").symlink_to(beside)
    (root / "out.nc").symlink_to(beside / "log.nc")
    (root / "in.nc").symlink_to(root / "2026" / "log.nc")
    site = made(folders=(root,))
    tester = site.person("tester-all")
    listed = [one["name"] for one in tester.get("/api/v1/folders/0/").json["entries"]]
    assert listed == ["2026", "in.nc"]
    assert tester.get("/folders/0/2026/log.nc").status == 200
    for path in ("0/out", "0/out/log.nc", "0/out.nc", "0/.hidden", "0/../beside/log.nc", "0/2026/../../beside", "1/",
                 "0//etc/passwd", "0/%2e%2e/beside", "0/2026/log.nc/x", "-1/", "0/a%00b", "٠/"):  # fmt: skip
        assert tester.get(f"/folders/{path}").status == 404, path
    # a folder holds files of any ship
    assert site.person("tester-ada").get("/folders/0/2026/log.nc").status == 404
    job = {"source": "folder:0:out/log.nc", "vessel": "stan-tug-1205", "campaign": "short"}
    assert tester.post("/jobs", job).status == 404


def test_new_lines_need_a_number_that_checks_itself(site):
    tester = site.person("tester-all")
    put = "/api/v1/recordings/a.nc?line=port&ship=New&imo="
    # the example of IMO resolution A.1117(30), and one digit changed
    assert tester.put(f"{put}9074729", b"x").status == 201
    assert tester.put(f"{put}9074728", b"x").status == 400
    assert tester.put("/api/v1/recordings/a.nc?line=port&ship=New", b"x").status == 201
    assert tester.put("/api/v1/recordings/a.nc?line=port", b"x").status == 400


def test_the_page_of_a_settings_file_says_what_it_is_for(site):
    tester = site.person("tester-ada")
    for text, words in (
        (b"offset_v = 1.0", "A campaign file: choose it in the form"),
        (b"draught_m = 1.8", "A conditions file, which the form of a recording does not take."),
        (b"x", "No vessel or campaign file that can be read: choose it in the form"),
    ):
        number = tester.put(f"/api/v1/recordings/a.toml?line={LINE}", text).json["id"]
        assert words in tester.get(f"/recordings/{number}").text


def test_settings_that_a_job_does_not_take_are_not_offered(made, tmp_path):
    folder = tmp_path / "lies-here"
    folder.mkdir()
    for name in ("day.nc", "vessel.toml", ".hidden.toml"):
        (folder / name).write_bytes(b"x")
    page = made(folders=(folder,)).person("tester-all").get("/folders/0/day.nc").text
    assert "folder:0:vessel.toml" in page
    assert ".hidden.toml" not in page
