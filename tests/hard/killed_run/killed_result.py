# SPDX-License-Identifier: MIT
"""What must be in the result file that write_forever leaves, whenever it was killed."""

ROWS = 90  # history records a snapshot


def check_file(file):
    """Number of snapshots in an open result file; raises when something does not fit."""
    nodes = file["mesh/nodes"].shape[0]
    names = sorted(file["snapshots"])
    for step, name in enumerate(names):
        group = file["snapshots"][name]
        assert int(name) == step == group.attrs["step"], f"snapshot {name} is out of order"
        for field, shape in (("displacement", (nodes, 2)), ("stress", (nodes, 4))):
            values = group[field][...]
            assert values.shape == shape and (values == step).all(), f"{name}/{field}"
        assert "damage" in group and group["damage"].attrs["units"] == b"1"
    states = sorted(file["restart"])
    assert len(names) - 1 <= len(states) <= len(names), f"{len(states)} states"
    for name in states:
        assert (file["restart"][name]["u"][...] == int(name)).all(), f"state {name}"
    if len(names) > 1 or "history" in file:
        series = {column: file["history"][column][...] for column in ("time", "step", "energy")}
        shortest = min(len(values) for values in series.values())
        assert shortest >= ROWS * (len(names) - 1), f"history of {shortest} records"
        for column, values in series.items():
            row = range(len(values))
            expected = {
                "time": [1 + i for i in row],
                "step": [i // ROWS for i in row],
                "energy": [2 * (i // ROWS) for i in row],
            }
            assert (values == expected[column]).all(), f"history of {column} has holes"
    return len(names)
