"""Opens a table of shotdamp as its users do, and checks that all of them see the same numbers, units and provenance."""

import json
import math
import sys

import duckdb
import pandas
import polars
import pyarrow.parquet

path = sys.argv[1]

arrow = pyarrow.parquet.read_table(path)
about = json.loads(arrow.schema.metadata[b"shotdamp"])
names = [column["name"] for column in about["columns"]]
assert arrow.column_names == names, "the file's own list names every column"
for column in about["columns"]:
    told = arrow.schema.field(column["name"]).metadata or {}
    assert told.get(b"unit", b"").decode() == column["unit"], column
    assert told.get(b"symbol", b"").decode() == column["symbol"], column
units = {column["name"]: column["unit"] for column in about["columns"] if column["unit"]}
for key in ("experiment", "title", "section", "fingerprint", "solver_version", "program"):
    assert about["provenance"][key], key

frame = pandas.read_parquet(path)
assert frame.attrs["units"] == units, "pandas knows the units"
assert {key: frame.attrs[key] for key in about["provenance"]} == about["provenance"], "and where the numbers come from"
assert list(frame.columns) == names

lazy = polars.read_parquet(path)
assert lazy.columns == names
assert json.loads(polars.read_parquet_metadata(path)["shotdamp"]) == about

database = duckdb.connect()
rows = database.execute("SELECT * FROM read_parquet(?)", [path]).fetchall()
keys = dict(database.execute("SELECT key, value FROM parquet_kv_metadata(?)", [path]).fetchall())
assert json.loads(keys[b"shotdamp"]) == about


def same(one, other):
    """Equal, with NaN like NaN and lists cell by cell."""
    if isinstance(one, float) and isinstance(other, float):
        return one == other or (math.isnan(one) and math.isnan(other))
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    return one == other


columns = {
    "pyarrow": arrow.to_pydict(),
    "pandas": {
        name: [cell.tolist() if hasattr(cell, "tolist") else cell for cell in frame[name]] for name in names
    },
    "polars": lazy.to_dict(as_series=False),
    "duckdb": {name: [row[at] for row in rows] for at, name in enumerate(names)},
}
for reader, cells in columns.items():
    for name in names:
        assert same(cells[name], columns["pyarrow"][name]), f"{reader} reads another {name}"

print(
    f"{about['provenance']['experiment']}: {len(rows)} rows, {len(names)} columns, {len(units)} with a unit: the same in "
    f"pyarrow {pyarrow.__version__}, pandas {pandas.__version__}, polars {polars.__version__}, duckdb {duckdb.__version__}"
)
