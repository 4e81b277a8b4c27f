# One named rule for each stage kind; the plan says which results exist and what each is made from.
import functools
import shlex
import sys
from pathlib import Path

from surfexp.lab.plan.kinds_of_plans import load_own_kinds
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS
from surfexp.lab.plan.plan import read_plan, stored_inputs

if "plan" in config:
    plan_path = Path(config["plan"]).resolve()
    plan = read_plan(plan_path)
    load_own_kinds(plan)
else:
    from surfexp.lab.composition import launch# which takes Hydra

    plan_path, plan = launch.plan_for_snakemake(config)
results = plan_path.parent.parent
record = f"{results}/store/{{kind}}/{{key}}/record.json"


def records(keys):
    return [record.format(kind=plan.nodes[key].kind, key=key) for key in keys]


# What is there is right, for its key says what it was made from: it has no input, so that nothing makes Snakemake run it
# again when a damaged result before it is replaced.
@functools.cache
def inputs(key):
    return [] if store.is_done(results, plan.nodes[key].kind, key) else records(stored_inputs(plan.nodes, key))


wildcard_constraints:
    key="[0-9a-f]+",


rule all:
    input:
        # not the leaves alone: a damaged result in the middle is made again though all that follows from it is there
        records(node.key for node in plan.stored),
    default_target: True


for kind in [kind.name for kind in KINDS.values() if kind.stored]:

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
            plan=str(plan_path),
            state=lambda wildcards: plan.nodes[wildcards.key].cache,
            command=shlex.join([sys.executable, "-P", "-m", "surfexp.lab.running.stage_process", str(plan_path)]),
        shell:
            "exec {params.command} {wildcards.key} > {log:q} 2>&1"
