"""The report page shows texts as they are written."""

from __future__ import annotations

from surfexp.report.page import prose


def test_text_is_escaped_and_backticks_are_code() -> None:
    shown = prose("run `collect --group '(?P<class>a|b)'` where x < y & z")
    assert shown == ("run <code>collect --group &#39;(?P&lt;class&gt;a|b)&#39;</code> where x &lt; y &amp; z")
    assert prose("one ` alone") == "one ` alone"
