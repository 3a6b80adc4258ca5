"""The page's scripts without a browser, in the node that comes with playwright."""

from __future__ import annotations

import json
import shutil
import subprocess
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

from playwright._impl._driver import compute_driver_executable

from .serving import WAIT


def result_of(folder: Path, code: str, given: Any = None) -> Any:
    """Return the value of `result` after a module has run with `given` from the test.

    Parameters
    ----------
    folder : Path
        An empty folder, to which the scripts of the page are copied: the module imports from ``./``.
    code : str
        The module.
    given : anything that JSON holds, optional
        Value of `given` in the module.
    """
    with as_file(files("stridula.app").joinpath("page")) as page:
        shutil.copytree(page, folder, dirs_exist_ok=True)
    (folder / "package.json").write_text('{"type": "module"}')
    last = "process.stdout.write(JSON.stringify(result));"
    (folder / "module.js").write_text(f"const given = {json.dumps(given)};\nlet result;\n{code}\n{last}\n", "utf-8")
    node = compute_driver_executable()[0]
    done = subprocess.run([node, "module.js"], cwd=folder, capture_output=True, text=True, timeout=WAIT, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)
