# The rules of one experiment for plain Snakemake: by `include:`, or as a module with a `config:` of its own.
from surfexp.commands import plain_snakemake

config["plan"] = str(plain_snakemake.planned(config, workflow))


include: plain_snakemake.STAGES


views = f"{results}/{plan.settings.experiment}"


rule report:
    input:
        everything,
        asked=f"{results}/plans/{plan_path.stem}.asked",
    output:
        page=f"{views}/report.html",
        table=report(f"{views}/metrics.csv", category=plan.settings.experiment, labels={"what": "table"}),
        figures=report(
            directory(f"{views}/figures"),
            patterns=["{figure}.png", "{figure}.svg"],
            category=plan.settings.experiment,
            labels={"what": "{figure}"},
        ),
    localrule: True
    params:
        plan=lambda wildcards: plan_path,
    shell:
        "{sys.executable:q} -P -m surfexp.commands.plain_snakemake {params.plan:q}"


onstart:
    plain_snakemake.start(plan_path, workflow)


onsuccess:
    plain_snakemake.record(plan_path)


onerror:
    plain_snakemake.record(plan_path)
