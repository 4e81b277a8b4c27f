"""Snakemake's executor for stages on this machine: it hands them to warm processes and hears when they have ended.

Nothing is polled: a thread for each warm process waits for its replies and calls Snakemake back.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from snakemake.benchmark import BenchmarkRecord, write_benchmark_records
from snakemake_interface_executor_plugins.executors.base import SubmittedJobInfo
from snakemake_interface_executor_plugins.executors.real import RealExecutor
from snakemake_interface_executor_plugins.settings import CommonSettings, ExecMode

from surfexp.lab.plan.plan import read_plan
from surfexp.lab.running.stage_process import death, write_death

common_settings = CommonSettings(
    non_local_exec=False,
    implies_no_shared_fs=False,
    job_deploy_sources=False,
    auto_deploy_default_storage_provider=False,
)


class WarmProcess:
    """One process that forks stages, for one state of the code, and the jobs that it has not finished."""

    def __init__(self, executor: Executor, plan_path: Path, state: str) -> None:
        self.executor, self.plan_path = executor, plan_path
        self.jobs: dict[str, SubmittedJobInfo] = {}
        self.lost = False
        self.turn = threading.Lock()
        command = [
            sys.executable,
            "-P",
            "-m",
            "surfexp.lab.running.stage_server",
            str(plan_path),
            state,
            str(os.getpid()),
        ]
        self.process = subprocess.Popen(  # noqa: S603, this interpreter, this package, no shell
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()

    def submit(self, key: str, info: SubmittedJobInfo) -> bool:
        """Send one job; False if the process has died."""
        with self.turn:
            if self.lost:
                return False
            self.jobs[key] = info
        request = json.dumps({"key": key, "log": str(info.job.log[0])})
        try:
            assert self.process.stdin is not None  # noqa: S101, narrows a type
            self.process.stdin.write(request.encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # the listener hears of it as well and fails the job
        return True

    def _listen(self) -> None:
        assert self.process.stdout is not None  # noqa: S101, narrows a type
        for line in self.process.stdout:
            reply = json.loads(line)
            self.executor.ended(self.jobs.pop(reply["key"]), reply)
        with self.turn:
            self.lost = True
        reason = f"the process that forks stages ended: {death(self.process.wait())}"
        results = self.plan_path.parent.parent
        for key, info in self.jobs.items():
            with contextlib.suppress(OSError):  # on a full disk Snakemake has to hear of it all the same
                write_death(results, read_plan(self.plan_path).nodes[key], reason)
            self.executor.report_job_error(info, msg=reason)

    def end(self, kill: bool = False) -> None:
        """End the process, and with it the stages that it runs."""
        if kill:
            self.process.kill()
        assert self.process.stdin is not None  # noqa: S101, narrows a type
        self.process.stdin.close()
        self.process.wait()


class Executor(RealExecutor):
    """Runs the jobs of `rules.smk`, and those of other rules by their shell command; some rules only collect."""

    def __post_init__(self) -> None:
        """See Snakemake."""
        self.warm: dict[tuple[Path, str], WarmProcess] = {}
        self.plan = functools.cache(read_plan)

    @property
    def cores(self) -> Any:
        """See Snakemake."""
        return self.workflow.resource_settings.cores

    def get_exec_mode(self) -> ExecMode:
        """See Snakemake; no job is a Snakemake process of its own."""
        return ExecMode.SUBPROCESS

    def get_python_executable(self) -> str:
        """See Snakemake."""
        return sys.executable

    def run_job(self, job: Any) -> None:
        """Hand a stage to the warm process of its plan and state of the code."""
        info = SubmittedJobInfo(job=job)
        self.report_job_submission(info, register_job=False)
        if job.rule.norun:
            self.report_job_success(info)
            return
        if "key" not in job.wildcards_dict:
            threading.Thread(target=self._by_shell, args=[info], daemon=True).start()
            return
        path = Path(job.params.plan)
        warm = path, self.plan(path).nodes[job.wildcards.key].cache
        while warm not in self.warm or not self.warm[warm].submit(job.wildcards.key, info):
            self.warm[warm] = WarmProcess(self, *warm)

    def _by_shell(self, info: SubmittedJobInfo) -> None:
        done = subprocess.run(info.job.shellcmd, shell=True, check=False)  # noqa: S602, a rule's command is shell code
        if done.returncode:
            self.report_job_error(info)
        else:
            self.report_job_success(info)

    def ended(self, info: SubmittedJobInfo, reply: dict[str, Any]) -> None:
        """Tell Snakemake that a stage has ended, and what it took."""
        record = BenchmarkRecord(
            running_time=reply["seconds"], max_rss=round(reply["memory"], 2), cpu_time=reply["processor"]
        )
        record.data_collected, record.cpu_usage = True, 100.0 * reply["processor"]
        if info.job.benchmark:
            with contextlib.suppress(OSError):  # what is not written there is no reason to wait for ever
                Path(str(info.job.benchmark)).parent.mkdir(parents=True, exist_ok=True)
                write_benchmark_records([record], str(info.job.benchmark), False)
        if reply["code"]:
            self.report_job_error(info)
        else:
            self.report_job_success(info)

    def shutdown(self) -> None:
        """See Snakemake."""
        for process in self.warm.values():
            process.end()

    def cancel(self) -> None:
        """See Snakemake."""
        for process in self.warm.values():
            process.end(kill=True)
