"""The checks of study_engines_test.py that need Slurm: a cluster of three nodes on this machine."""

import shutil
import signal
import subprocess
import time

import slurm_cluster

RECOVERY_S = 300  # of Slurm itself, from the loss of its controller; beyond it the check cannot run


def run(test, kills):
    why = slurm_cluster.missing()
    if why:
        return test.skip(f"slurm: {why}")
    cluster = slurm_cluster.Cluster(test.folder / "slurm")
    try:
        test.engine("slurm", "--workers", 3)
        test.interrupt_calibration("slurm", "--workers", 3)
        twice(test)
        settings(test)
        if kills:
            test.kill_workers("slurm", "--workers", 3)
            signal_jobs(test)
            kill_node(test, cluster)
            kill_controller(test, cluster)
    finally:
        cluster.stop()


def twice(test):
    """One study in two directories at the same time: neither command cancels the jobs of the other."""
    outs = ("twice-1", "twice-2")
    runs = [test.start("compare-controllers", "controllers.toml", "--quiet", "--out", out, "--engine", "slurm", "--workers", 3) for out in outs]
    for out, run in zip(outs, runs):
        test.check(run.wait() == 0, f"slurm, {out}")
        test.equal("controllers", out, f"slurm, {out}")
        test.check("left tasks" not in test.log(out), f"slurm, {out}: no attempt left tasks")


def settings(test):
    """What a user meets on a new cluster: settings that it does not have, unusual paths, jobs that never start or fail."""
    command = ("compare-controllers", "controllers.toml", "--quiet", "--engine", "slurm", "--workers", 3)
    folder = test.folder / "my lab's 50%a"
    folder.mkdir()
    for name in ("controllers.toml", "steer.toml"):
        shutil.copy(test.folder / name, folder)
    done = test.faba(*command, "--out", "my study", cwd=folder)
    test.check(done.returncode == 0, f"slurm: blank, apostrophe and percent sign in the path {done.stderr}")
    test.equal("controllers", folder / "my study", "slurm, unusual path")

    for setting, key in (("partition=none", "partition"), ('options=["--mem=900G"]', "options"), ('options=["--nonsense"]', "options")):
        done = test.faba(*command, "--out", "refused-jobs", "--engine-set", setting)
        test.check(done.returncode == 2 and f"correct {key} in [engine]" in done.stderr, f"slurm, {setting}: {done.stderr.strip()}")

    done = test.faba(*command, "--out", "environment", "--engine-set", 'environment=["module load none"]')
    logs = [log for log in (test.folder / "environment/jobs").glob("*") if log.suffix != ".log" or not log.stat().st_size]
    test.check(done.returncode == 0 and "module: command not found" in (test.folder / "environment/attempts.csv").read_text(),
               f"slurm: messages of the environment lines are recorded {done.stderr}")
    test.check(not logs, f"slurm: scripts, lists and empty logs are removed {logs}")

    # Jobs above the time limit of the partition wait for ever; then the coordinator is killed, and another engine completes the study.
    run = test.start(*command, "--out", "brief", "--engine-set", "partition=brief")
    attempts = test.folder / "brief/attempts.csv"
    for _ in range(200):
        if attempts.exists() and "all jobs of Slurm wait: Partition" in attempts.read_text():
            break
        time.sleep(0.1)
    test.check("all jobs of Slurm wait: Partition" in attempts.read_text(), "slurm: the reason of waiting is recorded")
    marker = (test.folder / "brief/incomplete").read_text()
    test.check("--engine slurm --engine-set partition=brief --workers 3" in marker, f"the command that resumes has the engine: {marker}")
    run.kill()
    run.wait()
    done = test.faba("compare-controllers", "controllers.toml", "--out", "brief", "--engine", "local")
    left = subprocess.run(["squeue", "--noheader", "--states=PENDING,RUNNING"], capture_output=True, text=True).stdout
    test.check(done.returncode == 0 and "cancelled the Slurm jobs" in done.stderr and not left.strip(), f"slurm: jobs of a killed command are cancelled {left}")
    test.equal("controllers", "brief", "slurm, then local")


def signal_jobs(test):
    """The signal of Slurm before the time limit reaches the worker, which keeps its results."""
    run = test.start("compare-controllers", "controllers.toml", "--quiet", "--out", "signal", "--engine", "slurm", "--workers", 3)
    test.wait_for_results(run, "signal", 20000)
    subprocess.run("squeue -h --states=RUNNING --array -o %F_%K | xargs -n 1 scancel --batch --signal=TERM", shell=True)
    code = run.wait()
    log = (test.folder / "signal/attempts.csv").read_text()
    test.check(code == 0 and "stopped after" in log and "left tasks" in log, f"slurm: signal to all jobs, exit code {code}")
    test.equal("controllers", "signal", "slurm, signal")


def kill_node(test, cluster):
    out = "kill-node"
    run = test.start("compare-controllers", "controllers.toml", "--quiet", "--out", out, "--engine", "slurm", "--workers", 3)
    for node, size in (("node1", 100), ("node2", 2000)):
        test.wait_for_results(run, out, size)
        cluster.kill_node(node)
        cluster.start_node(node)
    code = run.wait()
    test.check(code == 0, f"slurm: two nodes killed, exit code {code}")
    test.equal("controllers", out, "slurm, nodes killed")


def kill_controller(test, cluster):
    out = "kill-controller"
    command = ("compare-controllers", "controllers.toml", "--quiet", "--out", out, "--engine", "slurm", "--workers", 3)
    subprocess.run(["scancel", "--user", "root"])  # requeued jobs of the study before, whose nodes were killed
    cluster.wait_until_idle()
    try:
        with cluster.administrator():
            for size in (100, 2000):
                run = test.start(*command)
                test.wait_for_results(run, out, size, RECOVERY_S)
                cluster.kill_controller()
                time.sleep(1)
                run.send_signal(signal.SIGTERM)
                run.wait()
                cluster.start_controller()
            done = test.faba(*command, timeout=RECOVERY_S)
    except (TimeoutError, subprocess.TimeoutExpired):
        run.kill()
        return test.skip(f"slurm: the nodes took no jobs within {RECOVERY_S} s after the controller was killed\n{slurm_cluster.state()}")
    test.check(done.returncode == 0, f"slurm: controller killed twice, command started again {done.stderr}")
    test.equal("controllers", out, "slurm, controller killed")
