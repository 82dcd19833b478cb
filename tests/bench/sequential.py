"""Sequential training on PUQ's test functions, ours beside PUQ's own code: driver of tests/bench/sequential.sh.

sequential.py BENCH_PROGRAM [--repeats 30] [--noise 0.5] [--puq FOLDER --puq-repeats N] [--puq-rows FILE]

The rows of PUQ's runs are appended to FILE as they come. Called again, the benchmark goes on where it was.

PUQ's loop is that of its SEQCAL with one simulation at a time: its emulator (PCGP), its posterior, its acquisition
(eivar, 100 candidates, the 50 x 50 grid as the integral's points), called here in turn, without libEnsemble, which would
only pass the messages. Eigenvalue decompositions of batches of 1 x 1 and 2 x 2 matrices are replaced by closed forms
(checked at the start), which is 20 times faster and gives the same numbers; torch, used for one product, by numpy.
"""

import argparse
import csv
import io
import os
import subprocess
import sys
import time
import types

FUNCTIONS = ["unimodal", "banana", "bimodal", "unidentifiable"]


def run_ours(program, options):
    text = subprocess.run([program, *options], check=True, capture_output=True, text=True).stdout
    return [(r["function"], r["design"], float(r["noise"]), int(r["repeat"]), int(r["runs"]), float(r["error"]),
             float(r["cpu_seconds"])) for r in csv.DictReader(io.StringIO(text))]


def load_puq(folder):
    """PUQ's modules, with closed forms in the place of batched decompositions."""
    import numpy as np

    class Product(np.ndarray):
        def numpy(self):
            return np.asarray(self)

    torch = types.ModuleType("torch")
    torch.from_numpy = lambda a: a
    torch.matmul = lambda a, b: np.einsum("...ik,...kj->...ij", a, b).view(Product)
    sys.modules["torch"] = torch
    sys.path[:0] = [folder, os.path.join(folder, "examples", "Technometrics2024")]
    import PUQ.designmethods.gen_funcs.acquisition_funcs as acquisition
    import PUQ.designmethods.gen_funcs.acquisition_funcs_support as support
    import PUQ.posterior as posterior

    def determinants(c):
        return c[:, 0, 0].copy() if c.shape[1] == 1 else c[:, 0, 0] * c[:, 1, 1] - c[:, 0, 1] * c[:, 1, 0]

    def densities(x, means, c):
        r, d, det = x - means, c.shape[1], determinants(c)
        if d == 1:
            q = r[:, 0] ** 2 / det
        else:
            q = (c[:, 1, 1] * r[:, 0] ** 2 - 2 * c[:, 0, 1] * r[:, 0] * r[:, 1] + c[:, 0, 0] * r[:, 1] ** 2) / det
        return np.exp(-0.5 * (d * np.log(2 * np.pi) + q + np.log(det)))

    random = np.random.default_rng(1)
    for d in (1, 2):
        a = random.standard_normal((50, d, d))
        c = a @ a.transpose(0, 2, 1) + 0.1 * np.eye(d)
        m, x = random.standard_normal((50, d)), np.zeros((1, d))
        assert np.allclose(densities(x, m, c), support.multiple_pdfs(x, m, c), rtol=1e-10)
        assert np.allclose(determinants(c), support.multiple_determinants(c), rtol=1e-10)
    for module in (support, acquisition, posterior):
        module.multiple_pdfs = densities
    support.multiple_determinants = determinants


def run_puq(name, repeat, evaluations, noise):
    import warnings

    import numpy as np
    import scipy.stats as stats
    import test_funcs
    from PUQ.designmethods.gen_funcs.acquisition_funcs import eivar
    from PUQ.posterior import posterior
    from PUQ.prior import prior_dist
    from PUQ.surrogate import emulator

    warnings.filterwarnings("ignore")
    case = getattr(test_funcs, name)()
    axes = [np.linspace(low, high, 50) for low, high in case.thetalimits]
    grid = np.vstack([a.ravel() for a in np.meshgrid(*axes)]).T
    values = lambda theta: np.array([np.asarray(case.function(*t)).reshape(-1) for t in theta]).T
    exact = stats.multivariate_normal(mean=np.zeros(case.d), cov=case.obsvar).pdf(case.real_data - values(grid).T)
    prior = prior_dist(dist="uniform")(a=case.thetalimits[:, 0], b=case.thetalimits[:, 1])
    random = np.random.default_rng(1000 + repeat)
    sd = noise * np.sqrt(np.diag(case.obsvar))[:, None]
    simulate = lambda theta: values(theta) + sd * random.standard_normal((case.d, len(theta)))
    theta = prior.rnd(10, repeat)
    f = simulate(theta)
    while True:
        emu = emulator(case.x, theta, f, method="PCGP")
        if len(theta) % 5 == 0:
            density, _ = posterior(data_cls=case, emulator=emu).predict(grid)
            yield len(theta), float(np.mean(np.abs(exact - density)))
        if len(theta) >= evaluations:
            return
        new = eivar(1, case.x, case.real_x, emu, theta, f, case.real_data, case.obsvar, case.thetalimits, prior, grid, 1)
        theta, f = np.vstack((theta, new)), np.hstack((f, simulate(new)))


def puq_rows(path, repeats):
    """Rows of PUQ's repeats, read from `path` where they are there and appended to it as they are made."""
    rows = []
    if path and os.path.exists(path):
        with open(path, newline="") as file:
            rows = [(f, "PUQ", float(noise), int(repeat), int(runs), float(error), float(seconds))
                    for f, _, noise, repeat, runs, error, seconds in csv.reader(file)]
    for repeat in range(1, repeats + 1):
        for function in FUNCTIONS:
            if any(r[0] == function and r[3] == repeat for r in rows):
                continue
            start, new = time.process_time(), []
            for runs, error in run_puq(function, repeat, 210, 0.0):
                new.append((function, "PUQ", 0.0, repeat, runs, error, time.process_time() - start))
            rows += new
            if path:
                with open(path, "a", newline="") as file:
                    csv.writer(file).writerows(new)
    return rows


def quantile(values, share):
    values = sorted(values)
    at = share * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def median_at(rows, function, design, noise, runs):
    return [r[5] for r in rows if r[:3] == (function, design, noise) and r[4] == runs]


def first_below(rows, function, design, noise, error):
    """Fewest runs at which the median error is at most `error`, and stays so."""
    counts = sorted({r[4] for r in rows if r[:3] == (function, design, noise)}, reverse=True)
    best = None
    for runs in counts:
        if quantile(median_at(rows, function, design, noise, runs), 0.5) > error:
            break
        best = runs
    return best


def cell(values):
    return f"{quantile(values, 0.5):.2e} ({quantile(values, 0.25):.1e}, {quantile(values, 0.75):.1e})" if values else ""


def table(rows, noise, runs, filling):
    puq = any(r[1] == "PUQ" and r[2] == noise for r in rows)
    print(f"\nRun noise {noise:g} of the measurement's sd; median error (quartiles) over the repeats, density units.\n")
    print("| function | start, 10 | sequential, 55 | sequential, %d | filling, 55 | filling, %d | filling, %d | %s filling's last error had at |"
          % (runs, runs, filling, "PUQ, 210 (repeats) | PUQ's error had at: sequential, filling |" if puq else ""))
    print("|---|---|---|---|---|---|---|---|" + ("---|---|" if puq else ""))
    for f in FUNCTIONS:
        get = lambda design, n: median_at(rows, f, design, noise, n)
        line = [f, cell(get("sequential", 10)), cell(get("sequential", 55)), cell(get("sequential", runs)),
                cell(get("filling", 55)), cell(get("filling", runs)), cell(get("filling", filling))]
        if puq:
            theirs = get("PUQ", 210)
            line.append(f"{cell(theirs)} ({len(theirs)})")
            line.append(", ".join(str(first_below(rows, f, design, noise, quantile(theirs, 0.5)) or "not by the end")
                                  for design in ("sequential", "filling")) if theirs else "")
        last = get("filling", filling)
        line.append(str(first_below(rows, f, "sequential", noise, quantile(last, 0.5)) or "not by the end") if last else "")
        print("| " + " | ".join(line) + " |")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--repeats", type=int, default=30)
    parser.add_argument("--runs", type=int, default=105)
    parser.add_argument("--filling", type=int, default=210)
    parser.add_argument("--noise", type=float, default=0.5)
    parser.add_argument("--puq", default="")
    parser.add_argument("--puq-repeats", type=int, default=30)
    parser.add_argument("--puq-rows", default="", help="CSV file that keeps the rows of PUQ's runs")
    options = parser.parse_args()
    rows = []
    for noise in (0.0, options.noise):
        rows += run_ours(options.program, [f"repeats={options.repeats}", f"runs={options.runs}",
                                           f"filling={options.filling}", f"noise={noise}"])
    if options.puq:
        load_puq(options.puq)
        rows += puq_rows(options.puq_rows, options.puq_repeats)
    for noise in (0.0, options.noise):
        table(rows, noise, options.runs, options.filling)


main()
