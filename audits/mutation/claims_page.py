"""The table of all claims and the faults that turn them; what an earlier page says of a claim is kept until more is known."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from audits.mutation import ROOT
from audits.mutation.claims import OUTCOMES, ClaimFault, Trial, faults, recorded_trials
from surfexp.lab.experiment.claim import NOT_COMPARABLE, claims_of
from surfexp.reproduction.page import cells_of_line

PAGE = ROOT / "docs" / "claim_faults.md"
NOT_RUN = "not run"
HEAD = """# Mutants that flip claims

Made by `python -m audits.mutation claims`. A claim that no mutant of the code can flip says nothing. What is
not comparable (docs/verdicts.md) has no verdict to flip and is not listed. Each mutant changes a copy
of the code; its experiment is run again, and all claims of the experiment are judged again.

- *Turned*: the verdict flipped, by a number. Lines of code are quoted as they were on the day of that run.
- *Stopped*: a certificate, a check or an error left the claim not computed.
- *Untouched*: no mutant that was run changed the verdict.
- *Not run*: the data have to be brought (TOSCA), or the mutants have not been run yet.

If several mutants flip a claim, the table shows the one that names the claim in `audits/mutation/claims.yaml`, or else the
first. A row stays until a later run says more. `python -m audits.mutation claims --open` runs only mutants that name a claim
which is not flipped yet.

**{summary}**

| experiment | claim | fault | without it | with it | outcome |
|---|---|---|---|---|---|
"""


def write_page() -> None:
    """Write the table of all claims: of each the row of a trial here or of the page as it is, whichever says more."""
    trials, earlier = recorded_trials(), rows_of_page()
    found = [
        min(_row(name, claim, trials), earlier.get((name, claim), (NOT_RUN, _not_run(name, claim))), key=_rank)
        for name, claim in _stated()
    ]
    counts = Counter(outcome for outcome, _ in found)
    told = [f"{counts[outcome]} {outcome}" for outcome in (*OUTCOMES, NOT_RUN)]
    summary = f"Of {len(found)} claims {', '.join(told)}."
    PAGE.write_text(HEAD.format(summary=summary) + "".join(line for _, line in found), encoding="utf-8")


def rows_of_page() -> dict[tuple[str, str], tuple[str, str]]:
    """Outcome and line of each claim on the page, by experiment and claim."""
    found = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = cells_of_line(line)
        if line.startswith("| ") and len(cells) == 6 and cells[-1] in (*OUTCOMES, NOT_RUN):
            found[cells[0], cells[1]] = cells[-1], line + "\n"
    return found


def open_faults(words: Sequence[str] = ()) -> list[ClaimFault]:
    """The faults that name a claim which the page does not call turned, of the experiments that `faults` gives."""
    turned = [row for row, (outcome, _) in rows_of_page().items() if outcome == OUTCOMES[0]]

    def is_turned(fault: ClaimFault) -> bool:
        return any(name == fault.experiment and claim.startswith(fault.claim) for name, claim in turned)

    return [fault for fault in faults(words) if fault.claim and not is_turned(fault)]


def _rank(found: tuple[str, str]) -> int:
    return (*OUTCOMES, NOT_RUN).index(found[0])


def _stated() -> list[tuple[str, str]]:
    """Return (experiment, claim) of every claim with a verdict to turn; what is not comparable has none."""
    files = sorted((ROOT / "conf" / "experiment").glob("*.yaml"))
    return [
        (file.stem, entry["claim"]) for file in files for entry in claims_of(file) if entry["between"] != NOT_COMPARABLE
    ]


def _row(name: str, claim: str, trials: list[Trial]) -> tuple[str, str]:
    """Return outcome and line of a claim, from the trial that says most about it."""
    own = [trial for trial in trials if trial.fault.experiment == name and claim in trial.before]
    if not own:
        return NOT_RUN, _not_run(name, claim)
    best = min(own, key=lambda trial: (OUTCOMES.index(trial.outcome(claim)), trial.named != claim))
    outcome = best.outcome(claim)
    before = " ".join(best.before[claim][:2])
    if outcome not in ("turned", "stopped"):
        count = len({trial.fault.change for trial in own})
        return outcome, _line(name, claim, f"{count} fault{'s' if count > 1 else ''}", before, before, outcome)
    fault = best.fault
    change = f"{fault.path}: `{_code(fault.old)}` → `{_code(fault.new)}`"
    return outcome, _line(name, claim, change, before, " ".join(best.of(claim)[:2]), outcome)


def _not_run(name: str, claim: str) -> str:
    return _line(name, claim, "–", "–", "–", NOT_RUN)


def _line(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _code(text: str) -> str:
    return " ".join(text.split())
