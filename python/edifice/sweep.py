"""Results of sweeps as data frames."""

import json
import pathlib


def load(folder):
    """Results of a sweep's folder (``edifice sweep collect``) as a pandas data frame: ``study, arm, instance, seed, metric, value``.

    Failed tasks have the metric ``failure`` and their reason in the column ``failure``; ``value`` is NaN there.
    """
    import pandas

    path = pathlib.Path(folder) / "results.csv"
    if not path.is_file():
        raise FileNotFoundError(f"{path}: there are no results; run `edifice sweep collect`")
    frame = pandas.read_csv(path, dtype={"instance": str, "arm": str, "value": str}, keep_default_na=False)
    failed = frame["metric"] == "failure"
    frame["failure"] = frame["value"].where(failed, "")
    frame["value"] = pandas.to_numeric(frame["value"].where(~failed), errors="coerce")
    return frame


def wide(folder):
    """The same, one row a task and one column a metric."""
    frame = load(folder)
    frame = frame[frame["metric"] != "failure"]
    return frame.pivot(index=["study", "arm", "instance", "seed"], columns="metric", values="value").reset_index()


def times(folder):
    """Measured seconds of each task: ``arm, instance, seed, seconds``."""
    import pandas

    return pandas.read_csv(pathlib.Path(folder) / "times.csv", dtype={"instance": str, "arm": str})


def plan(folder):
    """The head of a plan: study, arms with their settings and commands, instances."""
    with (pathlib.Path(folder) / "plan.jsonl").open() as lines:
        return json.loads(lines.readline())
