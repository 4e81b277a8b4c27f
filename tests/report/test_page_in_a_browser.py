"""The page in a browser: tables sort, filter and hide columns, and nothing but our own script runs."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from browser import browser

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.report.page import write_report

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="needs chromium")
HEAD = """
const said = [], table = document.querySelector("table.rows"), heads = [...table.tHead.rows[0].cells];
const column = (name) => heads.findIndex((head) => head.dataset.name === name);
const values = (name) => [...table.tBodies[0].rows].filter((row) => !row.hidden)
  .map((row) => row.cells[column(name)].dataset.value ?? row.cells[column(name)].textContent);
const click = (name) => heads[column(name)].querySelector("button").click();
const type = (text) => { const box = document.querySelector(".tools input[type=search]");
  box.value = text; box.dispatchEvent(new Event("input")); };
"""


def page_of(tmp_path: Path, **changes: Any) -> Path:
    plan = plan_of({**sweep(24), **changes}, tmp_path)
    fill(plan, tmp_path)
    return write_report(plan, tmp_path) / "report.html"


def driven(page: Path, script: str) -> Any:
    """What a script returns in the page, whose policy forbids it: so it runs in a copy without one."""
    text = re.sub(r"<meta http-equiv[^>]*>", "", page.read_text())
    answer = f"<script>{HEAD}document.title = JSON.stringify((() => {{ {script} }})());</script></body>"
    copy = page.with_name("driven.html")
    copy.write_text(text.replace("</body>", answer))
    found = re.search(r"<title>(.*?)</title>", shown(copy))
    assert found
    return json.loads(found[1].replace("&amp;", "&"))


def shown(page: Path) -> str:
    """The page as a browser has it after its scripts."""
    assert BROWSER is not None
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={page.parent / 'profile'}"]
    done = subprocess.run([BROWSER, *options, "--dump-dom", page.as_uri()], capture_output=True, text=True, timeout=120)
    return done.stdout


def test_a_table_sorts_by_all_digits_and_goes_back(tmp_path: Path) -> None:
    script = """
      const start = values("rmse"); click("rmse"); const up = values("rmse");
      click("rmse"); const down = values("rmse");
      click("rmse"); return [start, up, down, values("rmse"), heads[column("rmse")].getAttribute("aria-sort")];
    """
    start, up, down, back, state = driven(page_of(tmp_path), script)
    numbers = sorted(map(float, start))
    assert [*map(float, up)] == numbers and [*map(float, down)] == numbers[::-1] and numbers != [*map(float, start)]
    assert back == start and state is None


def test_rows_are_filtered_and_columns_hidden(tmp_path: Path) -> None:
    script = """
      const all = values("solver tolerance"); type(all[3]); const some = values("solver tolerance");
      const box = [...document.querySelectorAll(".tools label")].find((one) => one.textContent.includes("rmse"));
      box.querySelector("input").click();
      return [all, some, [...table.rows].every((row) => row.cells[column("rmse")].hidden)];
    """
    rows, kept, hidden = driven(page_of(tmp_path), script)
    assert rows[3] in kept and len(kept) < len(rows) == 24 and hidden


def test_no_text_of_an_experiment_runs(tmp_path: Path) -> None:
    evil = "</title></style></script><script>document.title='run'</script><img src=x onerror=document.title='run'>"
    page = page_of(tmp_path, title=evil, description=f"`{evil}`", comparison=evil, caption=evil)
    for file in (page, tmp_path / "index.html"):
        open_to_all = re.sub(r"<meta http-equiv[^>]*>", "", file.read_text())
        for text in (file.read_text(), open_to_all):  # with the policy of the page, and by its escaping alone
            copy = file.with_name("copy.html")
            copy.write_text(text)
            seen = shown(copy)
            assert "<h1>" in seen and "<title>run</title>" not in seen
    # and if a text did get into the page, its policy would stop it
    injected = page.read_text().replace("</body>", "<script>document.title='run'</script></body>")
    page.write_text(injected.replace("<h1>", "<h1><img src='x' onerror=\"document.title='run'\">"))
    assert "<title>run</title>" not in shown(page) and 'class="tools"' in shown(page)


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="needs pdftotext")
def test_no_number_breaks_on_paper(tmp_path: Path) -> None:
    page = page_of(tmp_path)
    # many columns: each number six times
    wide = re.sub(
        r'(<td class="number.*?</td>|<th scope="col" class="number.*?</th>)',
        6 * r"\1",
        page.read_text(),
        flags=re.DOTALL,
    )
    page.write_text(wide)
    numbers = set(re.findall(r'<td class="number[^>]*>([\d.e\u202f−-]{4,})', page.read_text()))
    assert BROWSER is not None and len(numbers) > 10
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    paper = tmp_path / "page.pdf"
    subprocess.run([BROWSER, *options, f"--print-to-pdf={paper}", page.as_uri()], capture_output=True, timeout=120)
    text = subprocess.run(["pdftotext", "-layout", paper, "-"], capture_output=True, text=True, check=True).stdout
    assert text.count("\n") and not numbers - {*text.split()}


def test_a_table_wider_than_the_page_says_how_many_columns_are_hidden(tmp_path: Path) -> None:
    page, note = page_of(tmp_path), "document.querySelector('.wider')"
    with browser(tmp_path / "profile") as tab:
        tab.open(page, 1280)
        tab.wait(f"{note}.textContent && {note}.hidden")
        tab.run("document.querySelector('table.rows').style.width = '3000px'")
        tab.wait(f"!{note}.hidden")
        beyond = tab.run(
            "[...document.querySelectorAll('thead th')].filter((head) => head.getBoundingClientRect().right > "
            "document.querySelector('.scroll').getBoundingClientRect().right).length"
        )
        assert beyond > 1 and f"for {beyond} more columns" in tab.run(f"{note}.textContent")


def test_every_head_of_every_table_says_what_it_heads(tmp_path: Path) -> None:
    grid = {"image.seed": list(range(6)), "operator": ["fem", "libigl"]}
    claims = [{"claim": "small", "quantity": {"all": "rmse"}, "between": [0, 1]}]
    html = page_of(tmp_path, grid=grid, columns=["rmse"], claims=claims).read_text()
    assert html.count("<table") == 4  # claims, means, rows, ranks
    assert html.count("<th ") == html.count('<th scope="col"') + html.count('<th scope="row"') and "<th>" not in html
    assert html.count('<th scope="row"') == html.count("<tr") - 4
    assert html.count('<div class="scroll"') == html.count(
        '<div class="scroll" tabindex="0" role="group" aria-label="Table: '
    )


def test_a_telephone_shows_units_where_there_is_no_head(tmp_path: Path) -> None:
    html = page_of(tmp_path, columns=["rmse", "seconds"]).read_text()
    assert html.count('data-name="seconds" data-unit="s"') == html.count('<td class="number" data-name="seconds"')


def test_what_a_pointer_is_told_stands_on_the_page_too(tmp_path: Path) -> None:
    claim = {"claim": "small", "quantity": {"all": "rmse"}, "between": [0, 99], "because": "A `tenth` & more."}
    html = page_of(tmp_path, columns=["rmse"], claims=[claim]).read_text()
    text = re.sub(r"<(?!/?code)[^>]*>", " ", html.partition("<main>")[2])  # without attributes
    assert "why that interval A <code>tenth</code> &amp; more." in text
    meaning = re.search(r'data-name="rmse" title="([^";]+)', html)
    assert meaning and f"rmse: {meaning[1]}" in text


def test_what_failed_is_red(tmp_path: Path) -> None:
    plan = plan_of(sweep(3), tmp_path)
    page = write_report(plan, tmp_path) / "report.html"
    with browser(tmp_path / "profile") as tab:
        tab.open(page)
        colour = "getComputedStyle(document.querySelector('{}')).color"
        assert tab.run(colour.format(".note.bad")) == tab.run(colour.format("tr.bad"))
