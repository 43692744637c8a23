"""A Slurm cluster of three nodes on this machine, for tests: one controller and three slurmd, as root, without an accounting
database. The processes end with stop()."""

import contextlib
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import threading
import time

NODES = ("node1", "node2", "node3")
FIRST_PORT = 16817

CONFIGURATION = """ClusterName=fabatest
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
SlurmctldPort={port}
StateSaveLocation={dir}/state
SlurmdSpoolDir={dir}/spool-%n
SlurmctldPidFile={dir}/slurmctld.pid
SlurmdPidFile={dir}/slurmd-%n.pid
SlurmctldLogFile={dir}/slurmctld.log
SlurmdLogFile={dir}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=10
KillWait=2
MpiDefault=none
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
PartitionName=main Nodes=node[1-3] Default=YES MaxTime=INFINITE State=UP
PartitionName=brief Nodes=node[1-3] MaxTime=1 State=UP
"""


def missing():
    """Why no cluster can be started; empty if it can."""
    for program in ("slurmctld", "slurmd", "sbatch", "munged"):
        if not shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin"):
            return f"{program} is not installed"
    return "" if os.geteuid() == 0 else "Slurm daemons need root"


def missing_package(engine):
    """What another engine needs and is not installed; empty if nothing."""
    if engine == "parallel" and not shutil.which("parallel"):
        return "GNU parallel is not installed"
    if engine == "dask" and subprocess.run(["/usr/bin/python3", "-c", "import distributed"], capture_output=True).returncode:
        return "python3-distributed is not installed"
    return ""


class Cluster:
    def __init__(self, folder):
        self.dir = pathlib.Path(folder)
        (self.dir / "state").mkdir(parents=True)
        host = socket.gethostname()
        text = CONFIGURATION.format(host=host, dir=self.dir, port=FIRST_PORT)
        for k, node in enumerate(NODES):
            text += f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={FIRST_PORT + 1 + k} CPUs=1 State=UNKNOWN\n"
        (self.dir / "slurm.conf").write_text(text)
        os.environ["SLURM_CONF"] = str(self.dir / "slurm.conf")
        os.environ["PATH"] += ":/usr/sbin"
        self.start_munge()
        self.start_controller()
        for node in NODES:
            self.start_node(node)
        self.wait_until_idle()

    def start_munge(self):
        if subprocess.run("munge -n | unmunge", shell=True, capture_output=True).returncode == 0:
            return
        subprocess.run(["install", "-d", "-o", "munge", "-g", "munge", "-m", "755", "/run/munge"], check=True)
        subprocess.run(["runuser", "-u", "munge", "--", "/usr/sbin/munged"], check=True)

    def start_controller(self):
        subprocess.run(["slurmctld"], check=True)

    def start_node(self, node):
        subprocess.run(["slurmd", "-N", node], check=True)

    def wait_until_idle(self, seconds=60):
        for _ in range(seconds * 10):
            out = subprocess.run(["sinfo", "-h", "-t", "idle", "-o", "%D"], capture_output=True, text=True).stdout.split()
            if out == [str(len(NODES))]:
                return
            time.sleep(0.1)
        raise RuntimeError("the nodes of the Slurm cluster do not become idle")

    @contextlib.contextmanager
    def administrator(self):
        """Resumes drained nodes meanwhile. A node whose job cannot be launched because the controller dies at this moment is drained,
        possibly long after the failure; with all three nodes drained, jobs would wait for ever."""
        done = threading.Event()

        def resume():
            while not done.wait(2):
                for node in NODES:
                    subprocess.run(["scontrol", "update", f"nodename={node}", "state=resume"], capture_output=True)

        thread = threading.Thread(target=resume)
        thread.start()
        try:
            yield
        finally:
            done.set()
            thread.join()

    def daemon(self, name):
        """Process id of slurmctld, or of the slurmd of a node."""
        return int((self.dir / f"{name}.pid").read_text())

    def kill_controller(self):
        os.kill(self.daemon("slurmctld"), signal.SIGKILL)

    def kill_node(self, node):
        """Kills slurmd, its steps and their tasks."""
        pid = self.daemon(f"slurmd-{node}")
        steps = [p for p in processes() if f"[{node}" in command(p) or (str(self.dir) in environment(p) and f"SLURMD_NODENAME={node}" in environment(p))]
        for p in [pid, *steps]:
            try:
                os.kill(p, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def stop(self):
        """Ends all daemons, and returns when they do not write to the folder any more."""
        subprocess.run(["scancel", "--user", "root"], capture_output=True)
        daemons = []
        for name in ["slurmctld", *(f"slurmd-{n}" for n in NODES)]:
            try:
                daemons.append(self.daemon(name))
                os.kill(daemons[-1], signal.SIGTERM)
            except (FileNotFoundError, ProcessLookupError, ValueError):
                pass
        for pid in daemons:
            for _ in range(100):
                if not os.path.exists(f"/proc/{pid}"):
                    break
                time.sleep(0.1)
            else:
                os.kill(pid, signal.SIGKILL)


def state():
    """Jobs and nodes, for messages."""
    return "".join(subprocess.run(words, capture_output=True, text=True).stdout for words in (["squeue", "--array"], ["sinfo", "-N", "-l"]))


def processes():
    return [int(p) for p in os.listdir("/proc") if p.isdigit() and int(p) != os.getpid()]


def read(path):
    try:
        return pathlib.Path(path).read_bytes().decode(errors="replace").replace("\0", " ")
    except OSError:
        return ""


def command(pid):
    return read(f"/proc/{pid}/cmdline")


def environment(pid):
    return read(f"/proc/{pid}/environ")


def parent(pid):
    """Process id of the parent of a process; 0 when the process has ended."""
    stat = read(f"/proc/{pid}/stat")
    return int(stat.rsplit(")", 1)[1].split()[1]) if stat else 0
