"""plotly's script with fewer kinds of traces: what is taken out, and that nothing else is touched."""

import json
import re
import shutil
import subprocess

import pytest

from shaftprint.report.charts._quick_script import quick_script
from shaftprint.report.charts._script import plotly_script

# A bundle in the form of plotly's, small enough to be read: five kinds of traces, one in two steps, and calendars.
BUNDLE = b"""/** plotly.js v9.9.9 */
(
 function(root, factory) {
  root.moduleName = factory();
} (typeof self !== "undefined" ? self : this, () => {
"use strict";var Plotly=(()=>{var W=(e,t)=>()=>(t||e((t={exports:{}}).exports,t),t.exports);\
var b1=W((e,t)=>{t.exports={moduleType:"trace",name:"bar",meta:{}}});\
var b2=W((e,t)=>{"use strict";t.exports=b1()});\
var p1=W((e,t)=>{ran.push("pie");t.exports={moduleType:"trace",name:"pie",meta:{}}});\
var p2=W((e,t)=>{"use strict";t.exports=p1()});\
var g1=W((e,t)=>{ran.push("gl");t.exports={moduleType:"trace",name:"scattergl",meta:{}}});\
var g2=W((e,t)=>{"use strict";var $x=g1();$x.plot=1;t.exports=$x});\
var g3=W((e,t)=>{"use strict";t.exports=g2()});\
var c1=W((e,t)=>{t.exports={moduleType:"component",name:"calendars"}});\
var s1=W(e=>{"use strict";e.moduleType="trace";e.name="unusual"});\
var core=W((e,t)=>{var found=[];t.exports={found,register:some=>found.push(...some)}});\
var all=W((e,t)=>{var r=core();r.register([b2(),p2(),g3(),c1(),s1()]);t.exports=r});return all();})();

window.Plotly = Plotly;
return Plotly;
}));
"""
RUN = "globalThis.ran = []; globalThis.window = {}; %s; console.log(JSON.stringify([window.Plotly.found, ran]))"


def test_kinds_that_no_report_draws_leave_the_list_and_all_else_stays():
    found = quick_script(BUNDLE).decode()
    assert "register([b2(),c1(),s1()])" in found
    assert 'this, (() => {\n"use strict"' in found
    assert found.rstrip().endswith("})));")
    # Put back by hand, it is what it was.
    back = found.replace("[b2(),c1(),s1()]", "[b2(),p2(),g3(),c1(),s1()]").replace("(() => {\n", "() => {\n")
    assert back.replace("})));", "}));") == BUNDLE.decode()


@pytest.mark.skipif(shutil.which("node") is None, reason="node runs the small bundle")
def test_the_rest_runs_and_what_was_taken_out_does_not():
    for script, kinds, ran in (
        (BUNDLE, ["bar", "pie", "scattergl", "calendars", "unusual"], ["pie", "gl"]),
        (quick_script(BUNDLE), ["bar", "calendars", "unusual"], []),
    ):
        done = subprocess.run(["node", "-e", RUN % script.decode()], capture_output=True, text=True, check=True)
        registered, started = json.loads(done.stdout)
        assert [kind.get("name", "unusual") for kind in registered] == kinds
        assert started == ran


@pytest.mark.parametrize(
    "other",
    [
        b"nothing",
        b"\xff\xfe no text",
        # Two things of one name: which is meant cannot be told.
        BUNDLE.replace(b"var p1=", b"var p2=").replace(b"g3(),", b"").replace(b"this, ()", b"self, ()"),
        # Another shape of the wrapper is left alone.
        re.sub(rb"register\(\[.*?\]\)", b"register(b2())", BUNDLE).replace(b"}));\n", b"}), 1);\n"),
    ],
)
def test_what_is_not_recognised_stays_as_it_is(other):
    assert quick_script(other) == other


def test_the_installed_script_is_recognised():
    """Of some 46 kinds one stays in the list beside what is no kind of trace; only the list and the wrapper change."""
    whole = plotly_script()
    quick = quick_script(whole)
    lists = [max(re.findall(rb"register\(\[([^\]]*)\]\)", script), key=len) for script in (whole, quick)]
    assert lists[0].count(b"()") > 40
    assert lists[1].count(b"()") <= 3
    back = quick.replace(b"[%s]" % lists[1], b"[%s]" % lists[0]).replace(b"this, (() =>", b"this, () =>")
    assert re.sub(rb"\}\)\)\);(?=\s*$)", b"}));", back) == whole
