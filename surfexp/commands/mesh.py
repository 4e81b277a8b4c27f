"""`surfexp mesh check` and `surfexp mesh repair`."""

from __future__ import annotations

from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError


def command(name: str, arguments: list[str]) -> int:
    """Report every defect of a mesh file, or mend it and say what was changed."""
    parser = Parser(f"surfexp {name}", description=__doc__)
    parser.add_argument("action", choices=["check", "repair"])
    parser.add_argument("file", type=Path)
    parser.add_argument(
        "--output", type=Path, help="where the repaired mesh goes; default: NAME-repaired.ply beside it"
    )
    parser.add_argument("--largest-component", action="store_true", help="keep the largest component only")
    given = parser.parse_args(arguments)
    from surfexp.io.reading import read_mesh
    from surfexp.io.writing import write_mesh
    from surfexp.mesh.repair import repair
    from surfexp.mesh.validate import validate

    try:
        vertices, faces, _ = read_mesh(given.file)
        report = validate(vertices, faces)
        if given.action == "check":
            print("\n".join([f"{given.file}: {len(vertices)} vertices, {len(faces)} faces", *report.lines()]))
            return 0 if report.ok else 2
        repaired = repair(vertices, faces, largest_component=given.largest_component)
    except ValueError as error:
        raise UserError(str(error)) from None
    if not repaired.changes:
        print(f"{given.file}: nothing to repair")
        return 0
    output = given.output or given.file.with_name(f"{given.file.stem}-repaired.ply")
    write_mesh(output, repaired.mesh)
    print("\n".join([*(f"repaired: {change}" for change in repaired.changes), f"written: {output}"]))
    return 0
