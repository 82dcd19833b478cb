#!/usr/bin/python3
"""Fit and prediction of demcal's Gaussian process beside scikit-learn's and OpenTURNS's, in CPU seconds of one run.

    tests/bench/surrogate.py BENCH_BINARY [--runs 64,256,1024] [--seeds 1]

Needs Debian's python3-sklearn, python3-openturns and python3-scipy (tests/bench/surrogate.sh installs them). Every program
gets the same draws: T = 1 + 2 mu (1 + 0.5 log1p(H/2)) - 0.3 H w/(1+H) + 0.4 w^2, noise sd 0.02, scrambled Sobol; fits ARD
Matern 5/2 and nugget from one start; and is judged by one likelihood, evaluated by BENCH_BINARY at the hyper-parameters
that it found.
"""
import os
for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"
os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # one core for every program, its threads included
import argparse, json, subprocess, tempfile, time, warnings
import numpy as np
from scipy.stats import qmc

warnings.filterwarnings("ignore")


def torque(x):
    mu, h, w = 0.1 + 0.7 * x[:, 0], 10 * x[:, 1], x[:, 2]
    return 1 + 2 * mu * (1 + 0.5 * np.log1p(h / 2)) - 0.3 * h * w / (1 + h) + 0.4 * w**2


def timed(call, repeats):
    best, value = 1e9, None
    for _ in range(repeats):
        start = time.process_time()
        value = call()
        best = min(best, time.process_time() - start)
    return best, value


def sklearn_peer(x, y, points, repeats, _):
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

    def fit():
        kernel = ConstantKernel(1.0, (1e-4, 1e5)) * Matern([0.87] * 3, (0.02, 50), nu=2.5) + WhiteKernel(1e-3, (1e-10, 10))
        return GaussianProcessRegressor(kernel, normalize_y=True).fit(x, y)

    seconds, model = timed(fit, repeats)
    predict_seconds, (mean, _) = timed(lambda: model.predict(points, return_std=True), 3)
    k = model.kernel_
    sd = y.std()
    return dict(fit_s=seconds, predict_s=predict_seconds, mean=mean, lengths=k.k1.k2.length_scale,
                signal=sd * np.sqrt(k.k1.k1.constant_value), nugget=sd * np.sqrt(k.k2.noise_level))


def openturns_peer(x, y, points, repeats, nugget_factor):
    """OpenTURNS 1.20 cannot fit a nugget: it is given demcal's, and so has one parameter less to find."""
    import openturns as ot
    ot.TBB.Disable()
    ot.Log.Show(ot.Log.NONE)
    ot.ResourceMap.SetAsScalar("GeneralLinearModelAlgorithm-DefaultOptimizationScaleFactor", 50.0)  # length scales up to 50, not 2
    ot.ResourceMap.SetAsBool("GeneralLinearModelAlgorithm-UnbiasedVariance", False)
    sx, sy = ot.Sample(x), ot.Sample((y - y.mean())[:, None])

    def fit():
        model = ot.MaternModel([0.87] * 3, [y.std()], 2.5)
        model.setNuggetFactor(nugget_factor)
        algorithm = ot.KrigingAlgorithm(sx, sy, model, ot.Basis(0))
        algorithm.setOptimizationBounds(ot.Interval([0.02] * 3, [50.0] * 3))
        algorithm.run()
        return algorithm.getResult()

    seconds, result = timed(fit, repeats)

    def predict():
        return np.array(result.getConditionalMean(points)).ravel(), np.array(result.getConditionalMarginalVariance(points)).ravel()

    predict_seconds, (mean, _) = timed(predict, 2)
    model = result.getCovarianceModel()
    amplitude = model.getAmplitude()[0]
    return dict(fit_s=seconds, predict_s=predict_seconds, mean=mean + y.mean(), lengths=np.array(model.getScale()),
                signal=amplitude, nugget=amplitude * np.sqrt(model.getNuggetFactor()))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("binary")
    arguments.add_argument("--runs", default="64,256,1024")
    arguments.add_argument("--seeds", type=int, default=1)
    arguments.add_argument("--peers", default="sklearn,openturns", help="or none")
    arguments.add_argument("--json", help="file for the numbers")
    options = arguments.parse_args()
    names = [] if options.peers == "none" else options.peers.split(",")
    peers = {"sklearn": sklearn_peer, "openturns": openturns_peer}
    rows = []
    for runs in (int(n) for n in options.runs.split(",")):
        for seed in range(options.seeds):
            x = qmc.Sobol(3, seed=seed).random(runs)
            points = qmc.Sobol(3, seed=10_000 + seed).random(2048)
            truth = torque(points)
            y = torque(x) + 0.02 * np.random.default_rng(seed).standard_normal(runs)
            q2 = lambda mean: 1 - np.mean((np.asarray(mean) - truth) ** 2) / truth.var()
            with tempfile.TemporaryDirectory() as folder:
                np.savetxt(f"{folder}/train.csv", np.column_stack([x, y]), delimiter=",", fmt="%.17g")
                np.savetxt(f"{folder}/test.csv", points, delimiter=",", fmt="%.17g")
                call = [options.binary, f"{folder}/train.csv", f"{folder}/test.csv"]
                ours = json.loads(subprocess.check_output(call))
                row = dict(runs=runs, seed=seed, demcal=dict(fit_s=ours["fit_s"], predict_s=ours["predict_s"], q2=q2(ours["mean"]),
                                                             evidence=ours["evidence"], evaluations=ours["evaluations"], memory_mb=ours["memory_mb"]))
                for name in names:
                    peer = peers[name](x, y, points, 1 if runs > 500 else 3, ours["nugget_factor"])
                    evidence = json.loads(subprocess.check_output(
                        call + ["--lengths", ",".join(f"{v:.17g}" for v in peer["lengths"]), "--signal", f"{peer['signal']:.17g}",
                                "--nugget", f"{max(peer['nugget'], 1e-9):.17g}"]))["evidence"]
                    row[name] = dict(fit_s=peer["fit_s"], predict_s=peer["predict_s"], q2=q2(peer["mean"]), evidence=evidence)
            rows.append(row)
            for name in ("demcal", *names):
                r = row[name]
                print(f"{runs:5d} seed {seed:2d} {name:9s} fit {r['fit_s']:9.5f} s  predict {r['predict_s']:8.5f} s  "
                      f"Q2 {r['q2']:.6f}  log evidence {r['evidence']:.4f}"
                      + (f"  x{r['fit_s'] / row['demcal']['fit_s']:.1f} fit, x{r['predict_s'] / row['demcal']['predict_s']:.1f} predict"
                         if name != "demcal" else f"  ({r['evaluations']} evaluations, {r['memory_mb']:.0f} MiB at most)"), flush=True)
    if options.seeds > 1:
        for runs in sorted({row["runs"] for row in rows}):
            print(f"{runs:5d} median Q2: " + ", ".join(
                f"{name} {np.median([row[name]['q2'] for row in rows if row['runs'] == runs]):.6f}"
                for name in ("demcal", *names)))
    if options.json:
        with open(options.json, "w") as file:
            json.dump(rows, file, indent=1)


main()
