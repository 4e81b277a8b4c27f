"""Lines of code of the framework: what a reader reads, without blank lines, comments and docstrings."""

from __future__ import annotations

import ast
import sys
from pathlib import Path


def lines_of_code(file: Path) -> int:
    """Lines of one Python file that hold code."""
    text = file.read_text()
    lines = {
        number for number, line in enumerate(text.splitlines(), 1) if line.strip() and not line.strip().startswith("#")
    }
    if file.suffix == ".py":
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and node.body:
                first = node.body[0]
                if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and first.end_lineno:
                    lines -= set(range(first.lineno, first.end_lineno + 1))
    return len(lines)


if __name__ == "__main__":
    folder, limit = Path(sys.argv[1]), int(sys.argv[2])
    files = [file for file in sorted(folder.iterdir()) if file.suffix in (".py", ".smk")]
    total = sum(lines_of_code(file) for file in files)
    print(f"framework ({folder}): {total} lines of code in {len(files)} files, at most {limit}")
    sys.exit(total > limit)
