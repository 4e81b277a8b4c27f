"""Make the library of pages whose surfaces turn: what `entry.js` names of three.js, in one file, the same to the byte.

Needs npm and node. Packages are those of `pins.json` by version and hash; anything else is refused.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import shutil
import subprocess
import tarfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
WORK = HERE.parent / "build" / "viewer"
TARGET = HERE.parent / "surfexp" / "viewer" / "assets"
OPTIONS = ["--bundle", "--minify", "--format=iife", "--global-name=THREE", "--target=es2022", "--legal-comments=none"]


def main() -> None:
    """Write `three.bundle.js` and the licence of what it holds."""
    shutil.rmtree(WORK, ignore_errors=True)
    pins = json.loads((HERE / "pins.json").read_text())
    for name, pin in pins.items():
        unpack(name, pin["version"], pin["integrity"])
    modules = WORK / "node_modules"
    command = ["node", modules / "esbuild-wasm" / "bin" / "esbuild", HERE / "entry.js", *OPTIONS]
    head = f"// three.js {pins['three']['version']}, MIT licence: three.LICENSE.txt. Made by `make viewer`."
    made = subprocess.run(
        [*command, f"--banner:js={head}"],
        env={**os.environ, "NODE_PATH": str(modules)},
        stdout=subprocess.PIPE,
        check=True,
    )
    (TARGET / "three.bundle.js").write_bytes(made.stdout)
    shutil.copyfile(modules / "three" / "LICENSE", TARGET / "three.LICENSE.txt")
    print(f"three.bundle.js: {len(made.stdout):,} bytes, sha256 {hashlib.sha256(made.stdout).hexdigest()}")


def unpack(name: str, version: str, integrity: str) -> None:
    """Fetch a package and unpack it, if its hash is the one that is pinned."""
    WORK.mkdir(parents=True, exist_ok=True)
    asked = ["npm", "pack", f"{name}@{version}", "--silent", "--pack-destination", str(WORK)]
    subprocess.run(asked, check=True, stdout=subprocess.DEVNULL)
    archive = WORK / f"{name}-{version}.tgz"
    found = f"sha512-{base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode()}"
    if found != integrity:
        raise SystemExit(f"{archive.name} has the hash {found}, pinned is {integrity}: it is not used")
    with tarfile.open(archive) as packed:
        packed.extractall(WORK / "unpacked", filter="data")
    target = WORK / "node_modules" / name
    target.parent.mkdir(exist_ok=True)
    (WORK / "unpacked" / "package").rename(target)


if __name__ == "__main__":
    main()
