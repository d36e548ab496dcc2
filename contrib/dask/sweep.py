"""Dask: `pip install distributed`, then `python sweep.py PLAN.toml ROWS [SCHEDULER]`, repeated until no shard
is missing."""
import subprocess
import sys
import tomllib

from dask.distributed import Client

plan, rows, *scheduler = sys.argv[1:]


def shard(index: int, count: int) -> None:
    subprocess.run(["host-sim", "sweep", plan, "--shard", f"{index}/{count}", "--out", rows], check=True)


if __name__ == "__main__":
    with open(plan, "rb") as file:
        count = tomllib.load(file)["shards"]
    client = Client(*scheduler) if scheduler else Client(threads_per_worker=1)
    client.gather(client.map(shard, range(count), [count] * count, pure=False, retries=5))
    sys.exit(subprocess.call(["host-sim", "merge", rows]))
