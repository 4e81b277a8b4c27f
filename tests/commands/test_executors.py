"""Executors that are not there, jobs that were not taken, and the jobs that the profile for Kubernetes makes."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.commands.executors import check_executor, said_at_submission
from surfexp.commands.slurm_jobs import settings_of
from surfexp.lab.errors import UserError
from surfexp.lab.registry.folders import package_folder

KUBERNETES = package_folder("surfexp.profiles") / "kubernetes"
LOG = """\
Building DAG of jobs...
[Sat Nov 28 05:55:07 2026]
rule surface:
    output: results/store/surface/6d08/record.json
{said}[Sat Nov 28 05:55:07 2026]
    message: Error in group preparation
    jobs:
        rule surface:
At least one job did not complete successfully.
"""
# in place of kubectl: keeps what it is given, and says what KUBECTL_SAYS holds
KUBECTL = """#!/bin/sh
echo "$@" > asked
[ "$1" = create ] && cat > manifest
[ "$KUBECTL_SAYS" = nothing ] && exit 1
echo "$KUBECTL_SAYS"
"""


def test_an_executor_that_is_not_installed_is_refused_with_the_way_to_it() -> None:
    with pytest.raises(
        UserError, match="far takes Snakemake's executor a-cloud, which is not installed: pip install snak"
    ):
        check_executor("far", {"executor": "a-cloud"})
    check_executor("near", {"executor": "local"})
    check_executor("near", {})


def test_what_a_command_of_submission_said_is_the_reason() -> None:
    assert said_at_submission(LOG.format(said="submit.sh: no such image\n")) == "submit.sh: no such image"
    assert said_at_submission(LOG.format(said="")) == ""
    assert said_at_submission("snakemake.py: error: argument --jobs: invalid\n") == ""


@pytest.fixture
def pod(tmp_path: Path) -> dict[str, str]:
    kubectl = tmp_path / "kubectl"
    kubectl.write_text(KUBECTL)
    kubectl.chmod(0o755)
    names = {"SURFEXP_IMAGE": "registry.example.org/surfexp:1", "SURFEXP_CLAIM": "brains", "SURFEXP_VOLUME": "/work"}
    return {"PATH": f"{tmp_path}:/usr/bin:/bin", "KUBECTL_SAYS": "job.batch/surfexp-1", **names}


def shell(script: str, pod: dict[str, str], folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["sh", str(KUBERNETES / script), *arguments]
    return subprocess.run(command, cwd=folder, env=pod, capture_output=True, text=True, check=False)


def test_a_job_of_kubernetes_has_the_volume_the_folder_and_what_its_stages_ask_for(
    pod: dict[str, str], tmp_path: Path
) -> None:
    done = shell("submit.sh", pod, tmp_path, "2", "4000", "60", "/work/a b/snakejob.sh")
    assert (done.returncode, done.stdout) == (0, "job.batch/surfexp-1\n"), done.stderr
    job: dict[str, Any] = yaml.safe_load((tmp_path / "manifest").read_text())
    stage = job["spec"]["template"]["spec"]
    (container,), (volume,) = stage["containers"], stage["volumes"]
    assert container["command"] == ["sh", "/work/a b/snakejob.sh"] and container["workingDir"] == str(tmp_path)
    assert container["resources"] == {"requests": {"cpu": "2", "memory": "4000M"}, "limits": {"memory": "4000M"}}
    assert container["volumeMounts"] == [{"name": volume["name"], "mountPath": "/work"}]
    assert volume["persistentVolumeClaim"] == {"claimName": "brains"}
    assert container["image"] == "registry.example.org/surfexp:1"
    assert job["spec"]["activeDeadlineSeconds"] == 3600 and job["spec"]["backoffLimit"] == 0


@pytest.mark.parametrize("name", ["SURFEXP_IMAGE", "SURFEXP_CLAIM", "SURFEXP_VOLUME"])
def test_what_a_pod_has_to_know_is_asked_for_by_name(name: str, pod: dict[str, str], tmp_path: Path) -> None:
    del pod[name]
    done = shell("submit.sh", pod, tmp_path, "1", "2000", "60", "snakejob.sh")
    assert done.returncode != 0 and not done.stdout
    assert name in done.stderr and "e.g." in done.stderr and not (tmp_path / "manifest").exists()


@pytest.mark.parametrize(
    ("conditions", "status"),
    [
        ("found", "running"),
        ("found SuccessCriteriaMet Complete", "success"),
        ("found FailureTarget", "running"),
        ("found Failed", "failed"),
        ("", "failed"),
        ("nothing", "running"),
    ],
)
def test_conditions_of_a_job_are_the_words_of_snakemake(
    conditions: str, status: str, pod: dict[str, str], tmp_path: Path
) -> None:
    """A job that is not found has failed; where no server answers it is asked for again."""
    done = shell("status.sh", pod | {"KUBECTL_SAYS": conditions}, tmp_path, "job.batch/surfexp-1")
    assert (done.returncode, done.stdout.split()) == (0, [status])
    assert "get job.batch/surfexp-1" in (tmp_path / "asked").read_text()


def test_the_profile_takes_these_scripts() -> None:
    settings = settings_of(KUBERNETES)
    assert settings["executor"] == "cluster-generic"
    for key in ("submit", "status"):
        assert (KUBERNETES / Path(settings[f"cluster-generic-{key}-cmd"].split()[1]).name).exists()
    assert "requirements.lock" in (KUBERNETES / "Containerfile").read_text()
