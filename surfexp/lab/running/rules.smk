# One named rule for each stage kind; the plan says which results exist and what each is made from. `surfexp run` takes
# this file as it is; other workflows take `surfexp.commands.plain_snakemake.SNAKEFILE`, which includes it.
import functools
import sys
from pathlib import Path

from surfexp.lab.errors import UserError
from surfexp.lab.plan.kinds_of_plans import load_own_kinds
from surfexp.lab.plan.plan import read_plan, stored_inputs
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS

if "plan" not in config:
    raise UserError("this Snakefile is of an earlier version: remove it, then `surfexp init` writes the present one")
plan_path = Path(config["plan"]).resolve()
plan = read_plan(plan_path)
load_own_kinds(plan)
results = plan_path.parent.parent
if Path.cwd() in results.parents:  # so that a target can be typed, and a folder can be moved
    results = results.relative_to(Path.cwd())
record = f"{results}/store/{{kind}}/{{key}}/record.json"


def records(keys):
    return [record.format(kind=plan.nodes[key].kind, key=key) for key in keys]


# `surfexp run` knows what is missing: what is there has no input then, so that nothing makes Snakemake run it again when a
# lost result before it is replaced. Others see the whole graph.
only_missing = "only_missing" in config


@functools.cache
def inputs(key):
    done = only_missing and store.is_done(plan_path.parent.parent, plan.nodes[key].kind, key)
    return [] if done else records(stored_inputs(plan.nodes, key))


# not the leaves alone: a damaged result in the middle is made again though all that follows from it is there
everything = records(node.key for node in plan.stored)


wildcard_constraints:
    key="[0-9a-f]+",


rule stages:
    input:
        everything,
    default_target: True


for kind in [kind.name for kind in KINDS.values() if kind.stored]:

    # What is there is right, for its key says what it was made from. So neither times, nor another plan with the same stage
    # are reasons to run: inputs are ancient, and Snakemake does not compare a parameter that is a path.
    rule:
        name:
            kind
        input:
            lambda wildcards: [ancient(path) for path in inputs(wildcards.key)],
        output:
            record.format(kind=kind, key="{key}"),
        log:
            f"{results}/logs/{kind}/{{key}}.log",
        benchmark:
            f"{results}/logs/{kind}/{{key}}.benchmark.tsv"
        threads: 1
        params:
            plan=lambda wildcards: plan_path,
        shell:
            "exec {sys.executable:q} -P -m surfexp.lab.running.stage_process {params.plan:q} {wildcards.key} > {log:q} 2>&1"
