#!/usr/bin/env python3
"""Whether a wrong sign or a lost term is noticed: python3 tests/faults/mutations.py BUILD_FOLDER [--only TEXT]

Each mutation changes one expression of the contact laws, the likelihood, the profile or the planner. The sources stay
as they are: the changed file is compiled aside by the build's own command and linked before the libraries, into a copy
of a test program. Of this program one named test is run, and must fail. A mutation that passes is a hole in the tests.
BUILD_FOLDER is configured for Ninja and has the test programs built (cmake --build --preset dev).
"""
import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Mutation(NamedTuple):
    what: str
    file: str       # that is changed
    before: str     # an expression that is in it once
    after: str
    units: tuple    # sources to compile again
    program: str
    test: str       # of Catch: a name, with * at its end


CONTACT = "dem/contact/contact_law.hpp"
PARTS = "dem/contact/parts/"
LINEAR, HERTZ, JKR = (f"dem/contact/forces/{name}.cpp" for name in ("linear", "hertz", "jkr"))
POSTERIOR, GRADIENT, REPEATS = (f"uq/posterior/{name}.cpp" for name in ("posterior", "posterior_gradient", "distinct"))
PROFILE, DROP, INTERVAL = (f"uq/verdict/{name}.cpp" for name in ("profile", "interval_drop", "profile_interval"))
INFORMATION = "uq/plan/information.cpp"

MUTATIONS = [
    Mutation("the dashpot drives instead of damps", PARTS + "normal.hpp", "elastic - damping * normal_velocity",
             "elastic + damping * normal_velocity", (LINEAR,), "test_dem", "spheres rebound from each other*"),
    Mutation("Hertz's force has 1/3 for 4/3", PARTS + "normal.hpp", "4.0 / 3.0 * modulus", "1.0 / 3.0 * modulus",
             (HERTZ,), "test_dem", "Chung & Ooi 1*"),
    Mutation("JKR pulls off at twice its force", PARTS + "normal.hpp", "C(1.5 * std::numbers::pi * w * radius)",
             "C(3.0 * std::numbers::pi * w * radius)", (JKR,), "test_dem", "JKR: a sphere comes off a plane*"),
    Mutation("what a torn JKR contact gives up is lost", PARTS + "normal.hpp",
             "held * (1.0 - touch) * energy_at(break_root)", "0.0 * held", ("tests/dem/contact/parts.cpp",), "test_dem",
             "a JKR contact that tears*"),
    Mutation("the spring does not lead", PARTS + "slider.hpp", "(0.5 + lead) * reach", "0.5 * reach", (LINEAR,),
             "test_dem", "an elastic oblique collision*"),
    Mutation("friction does not follow the load", CONTACT, "push.total + cap_weight * pull", "push.elastic",
             ("tests/dem/contact/cohesion.cpp",), "test_dem", "the adhesive load enters the Coulomb limit*"),
    Mutation("tangential force along the slip", PARTS + "slider.hpp", "return {-force,", "return {force,", (LINEAR,),
             "test_dem", "a sliding sphere rolls*"),
    Mutation("Mindlin's spring is not scaled when it unloads", PARTS + "tangential.hpp",
             "select(normal.radius < radius_before, T(normal.radius / radius_before), T(1.0))", "T(1.0)",
             ("tests/dem/contact/parts.cpp",), "test_dem", "Mindlin's spring*"),
    Mutation("the rolling couple has the other sign", PARTS + "resistance.hpp", "T(radius) * cross(n, roll.force)",
             "T(radius) * cross(roll.force, n)", (LINEAR,), "test_dem", "a sphere spinning in place*"),
    Mutation("constant resistance twists the wrong way", PARTS + "resistance.hpp", "- T(twist * along) * n",
             "+ T(twist * along) * n", (LINEAR,), "test_dem", "a sphere spinning about the normal*"),
    Mutation("attraction falls with 1/h instead of 1/h^2", PARTS + "attraction.hpp",
             "T(pull_off * nearness * nearness)", "T(pull_off * nearness)", (LINEAR,), "test_dem",
             "spheres a gap h apart*"),
    Mutation("attraction does not pull", CONTACT, "push.total - pull", "push.total", (LINEAR,), "test_dem",
             "a constant attraction holds spheres*"),
    Mutation("the likelihood lacks its determinant", POSTERIOR, "-0.5 * whitened.squaredNorm() - log_root -",
             "-0.5 * whitened.squaredNorm() -", (POSTERIOR,), "test_uq_posterior", "the linear-Gaussian posterior*"),
    Mutation("the likelihood lacks the measurement's variance", POSTERIOR,
             "    covariance.diagonal() += group.variance;\n", "", (POSTERIOR,), "test_uq_posterior",
             "the linear-Gaussian posterior*"),
    Mutation("a setting's error is shared by rows at other settings", "uq/posterior/measurement.cpp",
             "pair_of(set, t, t).cwiseProduct(same_level(setting.level, setting.level))", "pair_of(set, t, t)",
             ("uq/posterior/measurement.cpp",), "test_uq_posterior", "a control's error enters by the slope*"),
    Mutation("the gradient lacks the covariance's slope", GRADIENT,
             "a.dot(slope * a) - inverse.cwiseProduct(slope).sum()", "0.0 * a.dot(slope * a)", (GRADIENT,),
             "test_uq_posterior", "the gradient of the posterior*"),
    Mutation("the gradient of the mean has the other sign", GRADIENT, "a.dot(slopes.mean[k]) +",
             "-a.dot(slopes.mean[k]) +", (GRADIENT,), "test_uq_posterior", "the gradient of the posterior*"),
    Mutation("the scatter of repeats counts twice", REPEATS, "repeats.log_constant - 0.5 * chi",
             "repeats.log_constant - chi", (REPEATS,), "test_uq_posterior", "so they do where the noise*"),
    Mutation("the profile holds another unknown", PROFILE, "box, starts, {Held{k, values",
             "box, starts, {Held{0, values", (PROFILE,), "test_uq_verdict",
             "profile intervals of LikelihoodProfiler.jl's curved*"),
    Mutation("the profile climbs from the draws alone", PROFILE,
             "const int from_box = model.row_count() > many_rows ? 0 : 12;", "const int from_box = 0;", (PROFILE,),
             "test_uq_verdict", "a narrow second maximum*"),
    Mutation("the profile forgets other maxima", PROFILE, "found.maxima.push_back(one);", "", (PROFILE,),
             "test_uq_verdict", "a narrow second maximum*"),
    Mutation("the deviance lacks its two", "uq/verdict/profile_interval.cpp",
             "(2.0 * (all.best.value - profile.log_likelihood.array())", "((all.best.value - profile.log_likelihood.array())",
             ("uq/verdict/profile_interval.cpp",), "test_uq_verdict",
             "profile intervals of LikelihoodProfiler.jl's sep*"),
    Mutation("the interval's ends do not know that the errors' size is unknown", DROP,
             "std::max(drop, 2.0 * (level.maxCoeff() - there))", "drop", (DROP,), "test_uq_verdict",
             "with an unknown sd of the readings*"),
    Mutation("the surrogate's ignorance excludes", INTERVAL, "profile.deviance[i] - std::max(grown, 0.0) > profile.drop",
             "profile.deviance[i] > profile.drop", (INTERVAL,), "test_uq_verdict", "what only the surrogate's ignorance*"),
    Mutation("a bound at 0 is a bound like any other", PROFILE, "parameter.low == 0.0 &&", "parameter.low == 1.0 &&",
             (PROFILE,), "test_uq_verdict", "a parameter against its physical bound*"),
    Mutation("information has the wrong sign", INFORMATION, "return -extrapolated(density, b);",
             "return extrapolated(density, b);", (INFORMATION,), "test_uq_plan", "the information of all unknowns*"),
    Mutation("the halves are not taken off", INFORMATION,
             "return 2.0 * mean_log(densities.all, {.left_out = left_out}) -",
             "return 2.0 * mean_log(densities.all, {.left_out = left_out}) - 0.0 *", (INFORMATION,), "test_uq_plan",
             "the information of all unknowns*"),
    Mutation("a reading has no noise of its own", INFORMATION, "ensemble.mean.row(i) + whiten",
             "ensemble.mean.row(i) + 0.0 * whiten", (INFORMATION,), "test_uq_plan", "the information of all unknowns*"),
    Mutation("a window takes in everything", INFORMATION,
             "std::max<Index>(static_cast<Index>(windows[w] * static_cast<double>(n)), window_least)", "n",
             (INFORMATION,), "test_uq_plan", "information about one of two*"),
    Mutation("a stretched input's gradient forgets the stretch", "uq/emulate/learnt_scale.cpp",
             "found.mean_gradient[i] *= slope;", "", ("uq/emulate/learnt_scale.cpp",), "test_uq_emulate",
             "predictions and gradients of a stretched*"),
    Mutation("a stretch takes the wrong end", "surrogate/stretch.cpp", "std::log1p((ratio - 1.0) * u) / std::log(ratio)",
             "std::log1p((1.0 / ratio - 1.0) * u) / -std::log(ratio)", ("surrogate/stretch.cpp",), "test_surrogate",
             "the stretch by the ratio*"),
    Mutation("between two hills a cut law is likely", "uq/posterior/cut_law.cpp",
             "if (!several) return law;", "return law;", ("uq/posterior/cut_law.cpp",), "test_uq_posterior",
             "between two hills*"),
]


def best_isa():
    """The widest contact forces that this processor runs, which the tests take."""
    flags = set(re.search(r"^flags\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    if {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"} <= flags:
        return "x86_64_v4"
    return "x86_64_v3" if {"avx2", "fma", "bmi2"} <= flags else "x86_64"


class Build:
    def __init__(self, folder):
        self.folder = folder
        self.commands = json.loads(subprocess.run(["ninja", "-C", folder, "-t", "compdb"], check=True,
                                                  capture_output=True, text=True).stdout)

    def compiling(self, unit):
        """Compilation of a source: of contact forces that of the instruction set in use."""
        source = str(ROOT / unit)
        found = [c for c in self.commands if c["file"] == source and c["output"].endswith(".o")]
        if "/forces/" in unit:
            found = [c for c in found if f"forces_{best_isa()}.dir" in c["output"]]
        if len(found) != 1:
            sys.exit(f"{unit}: {len(found)} compilations in {self.folder}; is it built?")
        return found[0]

    def commands_for(self, output):
        """The build's last step towards a file; several commands joined by &&."""
        lines = subprocess.run(["ninja", "-C", self.folder, "-t", "commands", "-s", output], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        return lines[-1]

    def linking(self, program):
        output = f"tests/{program}"
        return next(part for part in self.commands_for(output).split(" && ") if f"-o {output} " in part)

    def joining(self, source, changed, target):
        """Makes the one object of all contact forces (dem/dem.cmake), `changed` in the place of that of `source`."""
        entry = f"dem/demcal_forces_{best_isa()}.o"
        commands = self.commands_for(entry)
        original = next(word for word in shlex.split(commands) if word.endswith(f"/{pathlib.Path(source).name}.o"))
        return commands.replace(original, changed).replace(f"{self.folder}/{entry}", target)


def outcome(build, mutation, scratch):
    """None where the test notices; else what came."""
    text = (ROOT / mutation.file).read_text()
    if text.count(mutation.before) != 1:
        return f"'{mutation.before}' is {text.count(mutation.before)} times in {mutation.file}: mend this list"
    changed = scratch / "overlay" / mutation.file
    changed.parent.mkdir(parents=True)
    changed.write_text(text.replace(mutation.before, mutation.after))
    objects, replaced = [], {}
    for number, unit in enumerate(mutation.units):
        compile_it = build.compiling(unit)
        target = scratch / f"{number}.o"
        words = shlex.split(compile_it["command"])
        source = str(changed) if unit == mutation.file else compile_it["file"]
        words = [source if w == compile_it["file"] else str(target) if w == compile_it["output"] else w for w in words]
        first = next(i for i, w in enumerate(words) if w.startswith("-I"))
        words[first:first] = [f"-I{scratch / 'overlay'}"]
        done = subprocess.run(words, cwd=compile_it["directory"], capture_output=True, text=True)
        if done.returncode:
            errors = [line for line in done.stderr.splitlines() if "error" in line]
            return "does not compile: " + (errors or [done.stderr[-300:]])[0]
        if "/forces/" in unit:
            joined = str(scratch / "forces.o")
            subprocess.run(["sh", "-c", build.joining(unit, str(target), joined)], check=True)
            target = joined
        if unit.startswith("tests/"):
            replaced[compile_it["output"]] = str(target)
        else:
            objects.append(str(target))
    program = scratch / "mutant"
    words = [replaced.get(word, word) for word in shlex.split(build.linking(mutation.program))]
    output = words.index("-o") + 1
    words[output] = str(program)
    words[output + 1:output + 1] = objects
    done = subprocess.run(words, cwd=build.folder, capture_output=True, text=True)
    if done.returncode:
        return "does not link: " + done.stderr[-300:]
    run = [str(program), mutation.test, "--warn", "NoTests"]
    done = subprocess.run(run, cwd=build.folder, capture_output=True, text=True, errors="replace", timeout=1800)
    if "No test cases matched" in done.stdout + done.stderr:
        return f"{mutation.program} has no test '{mutation.test}'"
    return None if done.returncode else f"passes '{mutation.test}'"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--only", default="", help="mutations whose words have this text")
    options = parser.parse_args()
    build = Build(str(pathlib.Path(options.build).resolve()))
    holes = 0
    for mutation in MUTATIONS:
        if options.only not in mutation.what:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            missed = outcome(build, mutation, pathlib.Path(scratch))
        holes += missed is not None
        words = "noticed " if missed is None else "MISSED  "
        print(words, mutation.what + (f": {missed}" if missed else ""), flush=True)
    sys.exit(1 if holes else 0)


main()
