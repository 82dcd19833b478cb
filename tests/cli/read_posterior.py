#!/usr/bin/python3
"""Reads posterior-CASE.nc as ArviZ's readers do, through both of xarray's netCDF-4 engines: read_posterior.py DEMCAL STUDY

Checked against the same draws as demcal's own CSV of them, and against the ArviZ InferenceData schema
(https://python.arviz.org/en/stable/schema/schema.html).
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy
import xarray


def read_csv(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    shape = (1 + max(int(row["chain"]) for row in rows), 1 + max(int(row["draw"]) for row in rows))
    names = [name for name in rows[0] if name not in ("chain", "draw")]
    return {name: numpy.array([float(row[name]) for row in rows]).reshape(shape) for name in names}


def check(path, draws, engine):
    groups = {}
    for name in ("posterior", "sample_stats", "posterior_predictive", "log_likelihood", "observed_data", "constant_data"):
        with xarray.open_dataset(path, group=name, engine=engine) as group:
            groups[name] = group.load()
    posterior = groups["posterior"]
    assert list(posterior.dims) == ["chain", "draw"], posterior.dims
    for name in posterior.data_vars:
        assert posterior[name].dims == ("chain", "draw"), name
        numpy.testing.assert_allclose(posterior[name].values, draws[name], rtol=1e-9)
    numpy.testing.assert_allclose(groups["sample_stats"]["lp"].values, draws["lp"], rtol=1e-9)
    assert posterior.attrs["inference_library"] == "demcal" and "created_at" in posterior.attrs
    for name, observed in groups["observed_data"].data_vars.items():
        point, = observed.dims
        for group in ("posterior_predictive", "log_likelihood"):
            assert groups[group][name].dims == ("chain", "draw", point), (group, name)
        assert groups["constant_data"].sizes[point] == observed.size
        predicted = groups["posterior_predictive"][name]
        assert predicted.attrs["units"] == observed.attrs["units"], name
        spread = predicted.std(("chain", "draw"))
        away = abs(predicted.mean(("chain", "draw")) - observed) / spread
        assert float(away.max()) < 4.0, away  # this study's model fits
    print(f"{engine}: {dict(posterior.sizes)}, {', '.join(posterior.data_vars)}")


def main():
    demcal, study = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([demcal, "sample", study, "--csv", "--quiet", "--out", folder], check=True)
        posteriors = sorted(pathlib.Path(folder).glob("posterior-*.nc"))
        assert posteriors, "no posterior was written"
        for path in posteriors:
            draws = read_csv(path.with_suffix(".csv"))
            for engine in ("netcdf4", "h5netcdf"):
                check(path, draws, engine)


main()
