"""Runs workers of a study on a Dask cluster; faba starts this program and talks to it by lines.

    dask_program.py --workers N [--scheduler ADDRESS]

Output: "workers N slots M" at first and when the number of workers of Dask or of their threads has changed, "away" when the
scheduler is lost, "end ID EXIT_CODE" for each worker that has ended, and "end ID -1 REASON" if Dask could not run it. Input: one
line of JSON for each worker, {"id": 3, "words": ["faba", "study", "work", ...], "log": "FILE"}. At the end of the input the
program cancels what runs and exits. A Dask worker that is lost makes Dask run its task again.
"""

import argparse
import json
import os
import subprocess
import sys
import threading
import time

import dask.distributed as dd


def work(words, log):
    """Runs on a Dask worker. The process ends with it: a worker that was lost must not compute on. When the client has ended or has
    cancelled the task, which Dask cannot interrupt, the process is asked to end."""
    worker = dd.get_worker()
    key = worker.get_current_task()
    with open(log, "ab") as messages:
        try:
            process = subprocess.Popen([*words, "--parent", str(os.getpid())], stdin=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL, stderr=messages)
        except OSError as error:
            messages.write(f"{words[0]}: {error.strerror}\n".encode())
            return 127  # as a shell
    while True:
        try:
            return process.wait(1)
        except subprocess.TimeoutExpired:
            task = worker.state.tasks.get(key)
            if task is None or task.state == "cancelled":
                process.terminate()
                return process.wait()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--scheduler")
    options = parser.parse_args()
    if options.scheduler:
        client = dd.Client(options.scheduler)
    else:
        cluster = dd.LocalCluster(n_workers=options.workers or os.cpu_count(), threads_per_worker=1, dashboard_address=None)
        client = dd.Client(cluster)
    lock = threading.Lock()

    def say(line):
        with lock:
            print(line, flush=True)

    def report(number, future):
        futures.pop(number, None)
        if future.status == "finished":
            say(f"end {number} {future.result()}")
        else:
            error = future.exception() if future.status == "error" else None
            reason = f"{type(error).__name__}: {error}" if error else f"Dask: {future.status}"
            say(f"end {number} -1 {' '.join(reason.split())}")

    def state():
        if client.status != "running":
            return "away"
        try:
            threads = client.nthreads()  # by worker
        except Exception:  # of many types: the connection is lost at this moment
            return "away"
        return f"workers {len(threads)} slots {options.workers or max(1, sum(threads.values()))}"

    def watch():
        before = None
        while True:
            if (now := state()) != before:
                say(now)
                before = now
            time.sleep(1)

    threading.Thread(target=watch, daemon=True).start()
    futures = {}
    for line in sys.stdin:
        job = json.loads(line)
        future = client.submit(work, job["words"], job["log"], pure=False, retries=0)
        futures[job["id"]] = future
        future.add_done_callback(lambda f, number=job["id"]: report(number, f))
    client.cancel(list(futures.values()))
    os._exit(0)  # without waiting for the workers, which end with this program


if __name__ == "__main__":
    main()
