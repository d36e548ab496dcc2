"""HyperQueue: `pip install hyperqueue`, then `python sweep.py PLAN.toml ROWS`, repeated until no shard is missing.

With a server of your own (`hq server start`, `hq worker start` on each node):
`hq submit --array=0-13 host-sim sweep PLAN.toml --out ROWS`."""
import subprocess
import sys
import tomllib

from hyperqueue import Job, LocalCluster

plan, rows = sys.argv[1:]
with open(plan, "rb") as file:
    shards = tomllib.load(file)["shards"]
with LocalCluster() as cluster:
    cluster.start_worker()
    job = Job(max_fails=None)
    for _ in range(shards):  # HQ_TASK_ID selects the shard of each task.
        job.program(["host-sim", "sweep", plan, "--out", rows], env={"RAYON_NUM_THREADS": "1"}, cwd=".")
    client = cluster.client()
    client.wait_for_jobs([client.submit(job)])
sys.exit(subprocess.call(["host-sim", "merge", rows]))
