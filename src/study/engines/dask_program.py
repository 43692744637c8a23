"""Runs workers of a study on a Dask cluster; faba starts this program and talks to it by lines.

    dask_program.py --workers N [--scheduler ADDRESS]

Output: "slots N", then "end ID EXIT_CODE" for each worker that has ended, and "workers N" when the number of workers of Dask
has changed. Input: one line of JSON for each worker,
{"id": 3, "words": ["faba", "study", "work", ...], "log": "FILE"}. At the end of the input the program cancels what runs
and exits. A Dask worker that is lost makes Dask run its task again.
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
    """Runs on a Dask worker. The process ends with it: a worker that was lost must not compute on."""
    with open(log, "ab") as messages:
        return subprocess.run([*words, "--parent", str(os.getpid())], stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=messages).returncode


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--scheduler")
    options = parser.parse_args()
    if options.scheduler:
        client = dd.Client(options.scheduler)
        slots = options.workers or sum(w["nthreads"] for w in client.scheduler_info()["workers"].values())
    else:
        slots = options.workers or os.cpu_count()
        cluster = dd.LocalCluster(n_workers=slots, threads_per_worker=1, dashboard_address=None)
        client = dd.Client(cluster)
    lock = threading.Lock()

    def say(line):
        with lock:
            print(line, flush=True)

    def report(number, future):
        code = future.result() if future.status == "finished" else -1
        futures.pop(number, None)
        say(f"end {number} {code}")

    def watch():
        """Reports the number of workers; without any, nothing is computed."""
        before = None
        while True:
            if client.status == "running" and (now := len(client.scheduler_info()["workers"])) != before:
                before = now
                say(f"workers {now}")
            time.sleep(1)

    say(f"slots {max(1, slots)}")
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
