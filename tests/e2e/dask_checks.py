"""The checks of study_engines_test.py with a Dask scheduler that the command did not start."""

import signal
import subprocess
import time

SCHEDULER = """import distributed, sys
cluster = distributed.LocalCluster(n_workers=0, threads_per_worker=1, dashboard_address=None, protocol="tcp")
print(cluster.scheduler_address, flush=True)
client = distributed.Client(cluster)
for line in sys.stdin:
    cluster.scale(int(line))
    client.wait_for_workers(int(line))
    print("started", flush=True)
"""
END_S = 5  # within which a worker ends; without a request, its tasks take longer


def run(test):
    scheduler = subprocess.Popen(["/usr/bin/python3", "-c", SCHEDULER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    address = scheduler.stdout.readline().strip()
    out = "own-scheduler"
    test.write_slow(seeds=20, duration="20000 s")
    command = test.start("compare-controllers", "slow.toml", "--out", out, "--engine", "dask", "--scheduler", address)
    note = command.stderr.readline()
    test.check(f"the Dask scheduler {address} has no workers" in note, f"dask: {note.strip()}")
    print(2, file=scheduler.stdin, flush=True)
    scheduler.stdout.readline()  # on a busy machine the start of Python takes longer than the tasks
    # The first attempts measure the time of a task; the next ones take longer than END_S.
    both_compute = lambda: test.log(out).count(",complete,") >= 2 and len(test.workers(out)) == 2
    test.check(within(30, both_compute), "dask: workers that start later compute tasks")
    command.send_signal(signal.SIGINT)
    code = command.wait()
    test.check(code == 130, f"dask: interrupted, exit code {code} {command.stderr.read()}")
    test.check(within(END_S, lambda: not test.workers(out)), "dask: the workers of the scheduler end with the command")
    done = test.faba("compare-controllers", "controllers.toml", "--out", "no-scheduler", "--engine", "dask", "--scheduler", "nowhere")
    test.check(done.returncode == 1 and "nowhere was not reached" in done.stderr and "correct the address" in done.stderr, f"dask: {done.stderr.strip()}")
    scheduler.stdin.close()
    scheduler.wait()


def within(seconds, condition):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True
