# SPDX-License-Identifier: Apache-2.0
"""Evidence that is too large for the tree: reports, films, figures of every episode.

usage: evidence.py add FILE...          take files out of the tree, note them in the manifest
       evidence.py restore [PATH...]    write files of the manifest below build/evidence; all by default
       evidence.py pack ARCHIVE.tar.gz  the asset of a release: every file of the manifest
       evidence.py verify ARCHIVE.tar.gz

docs/results/evidence.json holds path, size and SHA-256 of each file, and the commit whose tree has
it, if there is one. `add` leaves the aggregate of an evaluation in the tree: the JSON file without
its member `episodes`. `restore` takes a file from that commit, or from `--from ARCHIVE.tar.gz`.
Every file is compared with its SHA-256 (docs/decisions/0024-large-evidence-is-kept-by-hash.md).
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tarfile

MANIFEST = "docs/results/evidence.json"
RESTORED = "build/evidence"


def fail(text):
    sys.exit(f"evidence.py: error: {text}")


def git(*words):
    return subprocess.run(("git",) + words, capture_output=True, check=False)


def read_manifest():
    if not os.path.exists(MANIFEST):
        return {}
    with open(MANIFEST, encoding="utf-8") as file:
        return {entry["path"]: entry for entry in json.load(file)["files"]}


def write_manifest(entries):
    # A line for each file: two branches that add files merge without conflicts.
    lines = ",\n".join("  " + json.dumps(entries[path]) for path in sorted(entries))
    with open(MANIFEST, "w", encoding="utf-8") as file:
        file.write('{"schema": "shoal-evidence-1", "files": [\n' + lines + "\n]}\n")


def check(entry, data, source):
    if hashlib.sha256(data).hexdigest() != entry["sha256"]:
        fail(f"'{entry['path']}' of {source} has another SHA-256 than {MANIFEST} says")


def write(path, data):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def without_episodes(data):
    """The evaluation without its list of episodes, or nothing if it has none."""
    value = json.loads(data)
    if not isinstance(value, dict) or not isinstance(value.pop("episodes", None), list):
        return None
    return json.dumps(value, indent=2, ensure_ascii=False).encode() + b"\n"


def add(files):
    entries = read_manifest()
    for path in files:
        if not path.startswith("docs/results/"):
            fail(f"'{path}' is not below docs/results")
        with open(path, "rb") as file:
            data = file.read()
        commit = git("log", "-1", "--format=%H", "--", path).stdout.decode().strip()
        kept = commit and git("show", f"{commit}:{path}").stdout == data
        entries[path] = {"path": path, "bytes": len(data), "sha256": hashlib.sha256(data).hexdigest(),
                         "commit": commit if kept else None}
        write(os.path.join(RESTORED, path), data)
        rest = without_episodes(data) if path.endswith(".json") else None
        if rest is None:
            os.remove(path)
        else:
            write(path, rest)
    write_manifest(entries)


def from_commit(entry):
    if entry["commit"] is None:
        fail(f"'{entry['path']}' is in no commit: expected --from ARCHIVE.tar.gz, the asset of a release")
    shown = git("show", f"{entry['commit']}:{entry['path']}")
    if shown.returncode:
        fail(f"git has no '{entry['path']}' of {entry['commit']} (a shallow clone?): "
             "expected --from ARCHIVE.tar.gz, the asset of a release")
    return shown.stdout


def from_archive(archive, entry):
    try:
        return archive.extractfile(entry["path"]).read()
    except KeyError:
        fail(f"'{archive.name}' has no '{entry['path']}'")


def restore(paths, archive):
    entries = read_manifest()
    for path in paths or entries:
        if path not in entries:
            fail(f"{MANIFEST} has no '{path}'")
        entry = entries[path]
        if archive:
            with tarfile.open(archive) as tar:
                data = from_archive(tar, entry)
        else:
            data = from_commit(entry)
        check(entry, data, archive or entry["commit"])
        write(os.path.join(RESTORED, path), data)
        print(os.path.join(RESTORED, path))


def pack(archive):
    with tarfile.open(archive, "w:gz") as tar:
        for path, entry in sorted(read_manifest().items()):
            restored = os.path.join(RESTORED, path)
            if not os.path.exists(restored):
                write(restored, from_commit(entry))
            with open(restored, "rb") as file:
                check(entry, file.read(), RESTORED)
            tar.add(restored, arcname=path)


def verify(archive):
    entries = read_manifest()
    with tarfile.open(archive) as tar:
        for entry in entries.values():
            check(entry, from_archive(tar, entry), archive)
    print(f"{archive}: {len(entries)} files, as {MANIFEST} says")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=("add", "restore", "pack", "verify"))
    parser.add_argument("files", nargs="*")
    parser.add_argument("--from", dest="archive")
    arguments = parser.parse_intermixed_args()
    if arguments.command in ("pack", "verify") and len(arguments.files) != 1:
        fail(f"{arguments.command}: expected one ARCHIVE.tar.gz")
    if arguments.command == "add":
        add(arguments.files)
    elif arguments.command == "restore":
        restore(arguments.files, arguments.archive)
    elif arguments.command == "pack":
        pack(arguments.files[0])
    else:
        verify(arguments.files[0])


if __name__ == "__main__":
    main()
