#!/usr/bin/python3
"""Malformed inputs: what demcal answers to each. malformed.py DEMCAL DATA [--table FILE]

Each entry changes one thing in a sound folder and runs one command. The answer must have the status that the entry names,
say every word that it names (the place, the value, the bound), and neither end by a signal, run on, nor call it a defect.
A folder without a change must pass, so that an entry cannot be answered for another reason.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WARNED, USAGE, DATA, MISSING, WRITE, STUDY = 2, 64, 65, 66, 73, 78
TIME_LIMIT = 20.0  # seconds


def sub(file, old, new):
    """A change of one text; the old one must be there."""
    def change(folder):
        text = (folder / file).read_text()
        assert old in text, (file, old)
        (folder / file).write_text(text.replace(old, new, 1))
    return change


def write(file, content):
    def change(folder):
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return change


def line(file, number, new):
    """Line `number` (from 1) of a file, another one."""
    def change(folder):
        lines = (folder / file).read_text().split("\n")
        lines[number - 1] = new
        (folder / file).write_text("\n".join(lines))
    return change


def column(file, name, values):
    """Values of a column from the first data row on, as texts."""
    def change(folder):
        path = folder / file
        lines = path.read_text().rstrip("\n").split("\n")
        at = next(i for i, text in enumerate(lines) if not text.startswith("#"))
        place = lines[at].split(",").index(name)
        for i, value in enumerate(values):
            cells = lines[at + 1 + i].split(",")
            cells[place] = value
            lines[at + 1 + i] = ",".join(cells)
        path.write_text("\n".join(lines) + "\n")
    return change


def gone(file):
    return lambda folder: (folder / file).unlink()


def folder_instead(file):
    def change(folder):
        (folder / file).unlink()
        (folder / file).mkdir()
    return change


def code(title, change, status, *words, command="check"):
    """An entry of the study of another code's runs."""
    return ("other-code", title, change, [command, "study"], status, words)


def dem(title, old, new, status, *words):
    """An entry of the study with a rig."""
    return ("quick", title, sub("study.toml", old, new), ["check", "study"], status, words)


def log(title, text, status, *words, options=()):
    return ("log", title, write("log.csv", text), ["observe", "log.csv", "--out", "out.csv", *options], status, words)


def call(title, arguments, status, *words, base="other-code"):
    return (base, title, None, arguments, status, words)


GOOD_LOG = "time [s],torque [mN m],rpm [rpm]\n" + "".join(
    f"{0.1 * i:.1f},{5 + (i * 7919 % 13) / 100:.3f},{100 if i < 200 else 200}\n" for i in range(400))

SYNTAX = [
    code("an empty study", write("study.toml", ""), STUDY, "study.toml"),
    code("a study of spaces", write("study.toml", "  \n\n"), STUDY, "study.toml"),
    code("a bracket that is not closed", sub("study.toml", "[study]", "[study"), STUDY, "study.toml:1"),
    code("a quote that is not closed", sub("study.toml", '"other-code"', '"other-code'), STUDY, "study.toml:2"),
    code("a key without a value", sub("study.toml", "seed = 7", "seed ="), STUDY, "study.toml:3"),
    code("a key twice", sub("study.toml", "seed = 7", "seed = 7\nseed = 8"), STUDY, "study.toml:4", "seed"),
    code("a table twice", sub("study.toml", "[training]", "[study]\n[training]"), STUDY, "study"),
    code("a byte that is no UTF-8", write("study.toml", b"[study]\nname = \"a\xff\"\n"), STUDY, "study.toml"),
    code("a zero byte", write("study.toml", b"[study]\nname = \"a\0b\"\n"), STUDY, "study.toml"),
    code("a picture as study", write("study.toml", b"\x89PNG\r\n\x1a\n" + bytes(range(256))), STUDY, "study.toml"),
    code("a table of JSON", write("study.toml", '{"study": {"name": "x"}}'), STUDY, "study.toml:1"),
    code("a key that does not exist", sub("study.toml", "seed = 7", "sed = 7"), STUDY, "study.toml:3", "sed", "seed"),
    code("a table that does not exist", sub("study.toml", "[training]", "[trainig]"), STUDY, "trainig", "training"),
    code("a table instead of a value", sub("study.toml", 'name = "other-code"', "name = {}"), STUDY, "study.toml:2", "name"),
    code("a value instead of a table", sub("study.toml", "[study]\nname = \"other-code\"\nseed = 7", "study = 7"), STUDY, "study"),
    code("a list instead of a number", sub("study.toml", "low = 0.1", "low = [0.1]"), STUDY, "study.toml:5", "low"),
    code("a number as a name", sub("study.toml", 'name = "other-code"', "name = 7"), STUDY, "study.toml:2", "name"),
    code("a date as a number", sub("study.toml", "low = 0.1", "low = 2026-01-01"), STUDY, "study.toml:5", "low"),
    code("an empty study name", sub("study.toml", '"other-code"', '""'), STUDY, "name"),
    code("a path as study name", sub("study.toml", '"other-code"', '"../x"'), STUDY, "study.toml:2", "../x"),
    code("a newline in a name", sub("study.toml", '"other-code"', '"a\\nb"'), STUDY, "study.toml:2"),
    code("a seed below 0", sub("study.toml", "seed = 7", "seed = -1"), STUDY, "study.toml:3", "-1"),
    code("a seed of a half", sub("study.toml", "seed = 7", "seed = 0.5"), STUDY, "study.toml:3", "0.5"),
    code("a seed that is text", sub("study.toml", "seed = 7", 'seed = "x"'), STUDY, "study.toml:3"),
    code("a seed of 2^64", sub("study.toml", "seed = 7", "seed = 18446744073709551616"), STUDY, "study.toml:3"),
]

PARAMETERS = [
    code("a range upside down", sub("study.toml", "low = 0.1\nhigh = 0.8", "low = 0.8\nhigh = 0.1"), STUDY, "friction", "0.8", "0.1"),
    code("a range of no width", sub("study.toml", "high = 0.8", "high = 0.1"), STUDY, "friction"),
    code("a range without an end", sub("study.toml", "low = 0.1\n", ""), STUDY, "friction", "low"),
    code("an infinite range", sub("study.toml", "high = 0.8", "high = inf"), STUDY, "friction", "inf"),
    code("a range that is not a number", sub("study.toml", "high = 0.8", "high = nan"), STUDY, "friction", "nan"),
    code("a logarithmic range from 0", sub("study.toml", "low = 0\nhigh = 10", 'low = 0\nhigh = 10\nscale = "log"'), STUDY, "cohesion", "log"),
    code("a scale that does not exist", sub("study.toml", "low = 0\nhigh = 10", 'low = 0\nhigh = 10\nscale = "lg"'), STUDY, "lg", "log"),
    code("a unit that does not exist", sub("study.toml", '"mJ/m2"', '"mJ/m2x"'), STUDY, "mJ/m2x"),
    code("a range in another unit than the parameter's", sub("study.toml", "high = 10", 'high = "10 kg"'), STUDY, "10 kg"),
    code("a parameter and a control of one name", sub("study.toml", "[controls.speed]", "[controls.friction]"), STUDY, "friction"),
    code("an output named as a parameter", sub("study.toml", "[outputs.torque]", "[outputs.friction]"), STUDY, "friction"),
    code("a name with a comma", sub("study.toml", "[parameters.friction]", '[parameters."a,b"]'), STUDY, "a,b"),
    code("an empty parameter name", sub("study.toml", "[parameters.friction]", '[parameters.""]'), STUDY, "parameters"),
    code("a prior that does not exist", sub("study.toml", 'kind = "uniform"', 'kind = "gaus"'), STUDY, "gaus", "normal"),
    code("a normal prior without a mean", sub("study.toml", 'kind = "uniform"', 'kind = "normal", sd = 0.1'), STUDY, "mean"),
    code("a normal prior of no width", sub("study.toml", 'kind = "uniform"', 'kind = "normal", mean = 0.4, sd = 0'), STUDY, "sd", "0"),
    code("a normal prior of width below 0", sub("study.toml", 'kind = "uniform"', 'kind = "normal", mean = 0.4, sd = -0.1'), STUDY, "sd", "-0.1"),
    code("a prior far outside its range", sub("study.toml", 'kind = "uniform"', 'kind = "truncated_normal", mean = 40, sd = 0.1'), STUDY, "friction"),
    code("a beta prior below 0", sub("study.toml", 'kind = "uniform"', 'kind = "beta", alpha = -1, beta = 2'), STUDY, "alpha", "-1"),
    code("a uniform prior with a mean", sub("study.toml", 'kind = "uniform"', 'kind = "uniform", mean = 3'), STUDY, "mean"),
    code("a control without a range", sub("study.toml", "low = 50\nhigh = 300", "low = 50"), STUDY, "speed", "high"),
    code("no parameter", write("study.toml", '[study]\nname = "x"\n[outputs.torque]\n[training]\ntable = "runs.csv"\n'), STUDY, "parameter"),
    code("a table of runs that is not there", sub("study.toml", '"runs.csv"', '"run.csv"'), MISSING, "run.csv"),
    code("a table of runs above the study", sub("study.toml", '"runs.csv"', '"../../../../etc/passwd"'), DATA, "passwd"),
    code("an observation file that is not there", gone("bench.csv"), MISSING, "bench.csv"),
    code("a folder as observation file", folder_instead("bench.csv"), MISSING, "bench.csv", "folder"),
    code("a folder as table of runs", folder_instead("runs.csv"), MISSING, "runs.csv", "folder"),
    code("an observation set without a name", sub("study.toml", 'name = "bench"\n', ""), STUDY, "name"),
    code("an observation set without a file", sub("study.toml", 'file = "bench.csv" ', 'files = "bench.csv"'), STUDY, "file"),
    code("an empty file name", sub("study.toml", '"bench.csv"', '""'), STUDY, "file"),
    code("two observation sets of one name", sub("study.toml", "[[calibrate]]", '[[observe]]\nname = "bench"\nfile = "bench.csv"\n[[calibrate]]'), STUDY, "bench"),
    code("a case that observes what is not there", sub("study.toml", '["bench"]', '["bnch"]'), STUDY, "bnch", "bench"),
    code("a case that observes nothing", sub("study.toml", '["bench"]', "[]"), STUDY, "observe"),
    code("a case that frees nothing", sub("study.toml", '["friction", "cohesion"]', "[]"), STUDY, "free"),
    code("a case that frees what is not there", sub("study.toml", '["friction", "cohesion"]', '["fricton"]'), STUDY, "fricton", "friction"),
    code("a case that frees a control", sub("study.toml", '["friction", "cohesion"]', '["speed"]'), STUDY, "speed"),
    code("a case that frees one twice", sub("study.toml", '["friction", "cohesion"]', '["friction", "friction"]'), STUDY, "friction"),
    code("a case that leaves one open", sub("study.toml", '["friction", "cohesion"]', '["friction"]'), STUDY, "cohesion"),
    code("a parameter that is free and fixed", sub("study.toml", 'free = ["friction", "cohesion"]', 'free = ["friction", "cohesion"]\nfixed = { cohesion = 3 }'), STUDY, "cohesion"),
    code("a fixed value beyond the range", sub("study.toml", 'free = ["friction", "cohesion"]', 'free = ["friction"]\nfixed = { cohesion = 30 }'), STUDY, "cohesion", "30"),
    code("two cases of one name", sub("study.toml", "[[calibrate]]", '[[calibrate]]\nname = "powder"\nobserve = ["bench"]\nfree = ["friction", "cohesion"]\n[[calibrate]]'), STUDY, "powder"),
    code("a sampler that does not exist", sub("study.toml", 'free = ["friction", "cohesion"]', 'free = ["friction", "cohesion"]\nsampler = "nut"'), STUDY, "nut", "nuts"),
    code("a prior from a case that is not there", sub("study.toml", 'free = ["friction", "cohesion"]', 'free = ["friction", "cohesion"]\npriors = { friction = { posterior = "x" } }'), STUDY, "x"),
    code("a prior from the case itself", sub("study.toml", 'free = ["friction", "cohesion"]', 'free = ["friction", "cohesion"]\npriors = { friction = { posterior = "powder" } }'), STUDY, "powder"),
    code("a mean form that does not exist", sub("study.toml", "[outputs.torque]", '[surrogate]\nmean = "cubic"\n[outputs.torque]'), STUDY, "cubic"),
    code("a kernel that does not exist", sub("study.toml", "[outputs.torque]", '[surrogate]\nkernel = "rbff"\n[outputs.torque]'), STUDY, "rbff"),
    code("training runs below 1", sub("study.toml", "[training]", "[training]\nruns = 0"), STUDY, "runs", "0"),
    code("training runs of 10^12", sub("study.toml", "[training]", "[training]\nruns = 1000000000000"), STUDY, "runs", "1000000000000"),
]

OBSERVATIONS = [
    code("an empty observation file", write("bench.csv", ""), DATA, "bench.csv"),
    code("a header alone", write("bench.csv", "speed,torque,torque_se\n"), DATA, "bench.csv"),
    code("no header", write("bench.csv", "100,8.1,0.2\n200,8.3,0.2\n"), DATA, "bench.csv"),
    code("a column too few in a row", write("bench.csv", "speed,torque,torque_se\n100,8.1,0.2\n200,8.3\n"), DATA, "bench.csv:3"),
    code("a column too many in a row", write("bench.csv", "speed,torque,torque_se\n100,8.1,0.2\n200,8.3,0.2,7\n"), DATA, "bench.csv:3"),
    code("a column twice", write("bench.csv", "speed,torque,torque,torque_se\n100,8.1,8.2,0.2\n"), DATA, "torque"),
    code("the control's column is missing", write("bench.csv", "torque,torque_se\n8.1,0.2\n"), DATA, "speed"),
    code("the output's column is missing", write("bench.csv", "speed,torqe,torque_se\n100,8.1,0.2\n"), DATA, "torque"),
    code("the error's column is missing", write("bench.csv", "speed,torque\n100,8.1\n"), DATA, "torque_se"),
    code("text for a number", column("bench.csv", "torque", ["eight"]), DATA, "bench.csv:5", "eight"),
    code("a number with a letter", column("bench.csv", "torque", ["8.1x"]), DATA, "bench.csv:5", "8.1x"),
    code("a hexadecimal number", column("bench.csv", "torque", ["0x1p3"]), DATA, "bench.csv:5", "0x1p3"),
    code("two decimal points", column("bench.csv", "torque", ["8.1.2"]), DATA, "bench.csv:5", "8.1.2"),
    code("an empty torque", column("bench.csv", "torque", [""]), DATA, "bench.csv:5", "torque"),
    code("an infinite torque", column("bench.csv", "torque", ["inf"]), DATA, "bench.csv:5", "inf"),
    code("a torque of 1e400", column("bench.csv", "torque", ["1e400"]), DATA, "bench.csv:5", "1e400"),
    code("an error of 0", column("bench.csv", "torque_se", ["0"]), DATA, "bench.csv:5", "torque_se"),
    code("an error below 0", column("bench.csv", "torque_se", ["-0.2"]), DATA, "bench.csv:5", "-0.2"),
    code("an error that is not a number", column("bench.csv", "torque_se", ["nan"]), DATA, "bench.csv:5"),
    code("an infinite error", column("bench.csv", "torque_se", ["inf"]), DATA, "bench.csv:5"),
    code("a speed outside the runs", column("bench.csv", "speed", ["900"]), STUDY, "bench.csv:5", "900", "300"),
    code("a speed below 0", column("bench.csv", "speed", ["-100"]), STUDY, "bench.csv:5", "-100"),
    code("a speed that is not a number", column("bench.csv", "speed", ["nan"]), DATA, "bench.csv:5"),
    code("an unclosed quote", write("bench.csv", 'speed,torque,torque_se\n"100,8.1,0.2\n200,8.3,0.2\n'), DATA, "bench.csv"),
    code("zero bytes amid", write("bench.csv", b"speed,torque,torque_se\n100,8.\x001,0.2\n"), DATA, "bench.csv"),
    code("a picture as observation file", write("bench.csv", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4), DATA, "bench.csv"),
    code("HTML as observation file", write("bench.csv", "<!DOCTYPE html>\n<html><body>Not found</body></html>\n"), DATA, "bench.csv"),
    code("a spreadsheet as observation file", write("bench.csv", b"PK\x03\x04" + bytes(200)), DATA, "bench.csv"),
    code("a unit in the header that contradicts", write("bench.csv", "speed,torque [kg],torque_se [kg]\n100,8.1,0.2\n200,8.3,0.2\n"), DATA, "kg"),
]

RUNS = [
    code("an empty table of runs", write("runs.csv", ""), DATA, "runs.csv"),
    code("a table of runs of a header alone", write("runs.csv", "friction,cohesion,speed,torque,torque_se\n"), MISSING, "runs.csv"),
    code("a table of runs without a parameter", write("runs.csv", "friction,speed,torque,torque_se\n0.3,100,8,0.1\n"), DATA, "cohesion"),
    code("a table of runs without an output", write("runs.csv", "friction,cohesion,speed,torq,torque_se\n0.3,1,100,8,0.1\n"), DATA, "torque"),
    code("three runs", write("runs.csv", "friction,cohesion,speed,torque,torque_se\n0.3,1,100,8,0.1\n0.4,2,200,9,0.1\n0.5,3,250,9.5,0.1\n"), WARNED, "29 % of the range of friction"),
    code("text in a run", column("runs.csv", "torque", ["high"]), DATA, "runs.csv:5", "high"),
    code("a cell too few in a run", line("runs.csv", 6, "0.3,1,100"), DATA, "runs.csv:6"),
    code("a cell too many in a run", line("runs.csv", 6, "0.3,1,100,8,0.1,7"), DATA, "runs.csv:6"),
    code("an error below 0 in a run", column("runs.csv", "torque_se", ["-0.1"]), DATA, "runs.csv:5", "-0.1"),
    code("an infinite parameter in a run", column("runs.csv", "friction", ["inf"]), WARNED, "runs.csv:5", "inf", "left out"),
    code("all runs the same", column("runs.csv", "torque", ["8"] * 80), WARNED, "runs.csv:5", "does not respond"),
    code("all runs failed", column("runs.csv", "torque", ["nan"] * 80), MISSING, "runs.csv:5", "nan"),
    code("a header twice", write("runs.csv", "friction,friction,cohesion,speed,torque,torque_se\n0.3,0.4,1,100,8,0.1\n"), DATA, "friction"),
    code("a unit in the header that contradicts the study", write("runs.csv", "friction,cohesion [kg],speed,torque,torque_se\n0.3,1,100,8,0.1\n"), DATA, "kg"),
    code("a table of runs that is a log", write("runs.csv", GOOD_LOG), DATA, "runs.csv"),
]

RIG = [
    dem("a rig that does not exist", 'kind = "slice"', 'kind = "slize"', STUDY, "slize", "slice"),
    dem("a shaft below 0", 'shaft_radius = "1.5 mm"', 'shaft_radius = "-1.5 mm"', STUDY, "shaft_radius", "-1.5"),
    dem("a shaft beyond the blade", 'shaft_radius = "1.5 mm"', 'shaft_radius = "4 mm"', STUDY, "shaft_radius"),
    dem("a blade beyond the trough", 'blade_radius = "3.6 mm"', 'blade_radius = "7 mm"', STUDY, "blade_radius", "trough"),
    dem("a blade of no thickness", 'blade_thickness = "0.8 mm"', "blade_thickness = 0", STUDY, "blade_thickness"),
    dem("a pitch of 0", 'pitch = "4.8 mm"', "pitch = 0", STUDY, "pitch"),
    dem("a pitch of a kilometre", 'pitch = "4.8 mm"', 'pitch = "1 km"', STUDY, "pitch"),
    dem("a length in kilograms", 'pitch = "4.8 mm"', 'pitch = "7.2 kg"', STUDY, "7.2 kg"),
    dem("a fill of 0", "fill = 480", "fill = 0", STUDY, "fill"),
    dem("a fill below 0", "fill = 480", "fill = -5", STUDY, "fill", "-5"),
    dem("a fill of half a sphere", "fill = 480", "fill = 0.5", STUDY, "fill", "0.5"),
    dem("a fill beyond the vessel", "fill = 480", "fill = 42000", STUDY, "fill"),
    dem("a fill of minus 5 kg", "fill = 480", 'fill = "-5 kg"', STUDY, "fill", "-5"),
    dem("a fill in metres", "fill = 480", 'fill = "5 m"', STUDY, "5 m"),
    dem("a density of 0", '"6090 kg/m3"', '"0 kg/m3"', STUDY, "density"),
    dem("a density below 0", '"6090 kg/m3"', '"-6090 kg/m3"', STUDY, "density", "-6090"),
    dem("shares that are not one", "mass_fraction = 0.3334", "mass_fraction = 0.9", STUDY, "mass fractions", "1.5666"),
    dem("a share below 0", "mass_fraction = 0.3334", "mass_fraction = -0.3", STUDY, "mass_fraction"),
    dem("a diameter of 0", 'diameter = "0.72 mm"', "diameter = 0", STUDY, "diameter"),
    dem("a diameter larger than the gap", 'diameter = "0.72 mm"', 'diameter = "9 mm"', STUDY, "0.009 m"),
    dem("no sizes", 'sizes = [', 'size = [', STUDY, "size"),
    dem("a stiffness of 0", '"300 N/m"', '"0 N/m"', STUDY, "stiffness"),
    dem("a stiffness below 0", '"300 N/m"', '"-300 N/m"', STUDY, "stiffness", "-300"),
    dem("a restitution above 1", "restitution = 0.7", "restitution = 1.7", STUDY, "restitution", "1.7"),
    dem("a restitution below 0", "restitution = 0.7", "restitution = -0.7", STUDY, "restitution", "-0.7"),
    dem("a friction range below 0", "low = 0.1", "low = -0.1", STUDY, "friction", "-0.1"),
    dem("a target that does not exist", '"contact.friction"', '"contact.fricton"', STUDY, "contact.fricton", "contact.friction"),
    dem("a target that is no number", '"contact.friction"', '"rig.kind"', STUDY, "rig.kind"),
    dem("two parameters of one target", '"contact.hamaker"', '"contact.friction"', STUDY, "contact.friction"),
    dem("an output that the rig has not", "[outputs.torque]", "[outputs.heat]", DATA, "bench.csv:5", "heat"),
    dem("an output's unit of another kind", 'unit = "uN m"', 'unit = "kg"', STUDY, "kg"),
    dem("steps in a contact below the least", "steps_per_contact = 15", "steps_per_contact = 1", STUDY, "steps_per_contact", "1"),
    dem("a longest run of 0", 'longest = "6 s"', 'longest = "0 s"', STUDY, "longest"),
    dem("a longest run below the shortest", 'longest = "6 s"', 'longest = "6 s"\nshortest = "9 s"', WARNED, "run.longest", "9 s"),
    dem("a sampling interval beyond the run", 'longest = "6 s"', 'longest = "6 s"\nsample_interval = "10 s"', STUDY, "sample_interval"),
    dem("a settling time below 0", 'settle = "0.05 s"', 'settle = "-1 s"', STUDY, "settle", "-1"),
    dem("an error wanted of 0", "standard_error = 0.05", "standard_error = 0", STUDY, "standard_error"),
    dem("an error wanted above 1", "standard_error = 0.05", "standard_error = 5", STUDY, "standard_error", "5"),
    dem("a speed range of 0 to 0", "low = 100\nhigh = 300", "low = 0\nhigh = 0", STUDY, "rpm"),
    dem("an observation of a material that is not there", 'material = "powder"', 'material = "power"', STUDY, "power", "powder"),
    dem("a material named as a path", "[materials.powder]", '[materials."../x"]', STUDY, "../x"),
    dem("an overlap limit of 0", "overlap_limit = 0.2", "overlap_limit = 0", STUDY, "overlap_limit"),
]

LOGS = [
    log("an empty log", "", DATA, "log.csv"),
    log("a log of a header alone", "time [s],torque [mN m],rpm [rpm]\n", DATA, "log.csv"),
    log("a log without time", GOOD_LOG.replace("time [s]", "counter"), DATA, "time"),
    log("a log without torque", GOOD_LOG.replace("torque [mN m]", "force [N]"), DATA, "torque"),
    log("a log of three rows", "\n".join(GOOD_LOG.split("\n")[:4]) + "\n", DATA, "log.csv"),
    log("a log of text", "lorem ipsum\n" * 50, DATA, "log.csv"),
    log("a log whose torque is always a fault", re.sub(r",5\.\d+,", ",NaN,", GOOD_LOG), DATA, "log.csv"),
    log("a log of one time", re.sub(r"(?m)^\d+\.\d,", "1.0,", GOOD_LOG), DATA, "time"),
    log("a log that is a picture", "\x89PNG\r\n\x1a\n" + "\x00\x01\x02" * 90, DATA, "log.csv"),
    log("a tolerance that is not a number", GOOD_LOG, USAGE, "tolerance", options=("--tolerance", "nan")),
    log("a tolerance below 0", GOOD_LOG, USAGE, "tolerance", options=("--tolerance", "-1")),
    log("an idle torque that is not a number", GOOD_LOG, USAGE, "idle", options=("--idle", "nan")),
    log("an idle log that is not there", GOOD_LOG, USAGE, "idle.csv", "--idle-log", options=("--idle", "idle.csv")),
    log("a dead time below 0", GOOD_LOG, USAGE, "dead-time", options=("--dead-time", "-3")),
    ("log", "a result over the log itself", write("log.csv", GOOD_LOG), ["observe", "log.csv", "--out", "log.csv"], WRITE, ("log.csv",)),
    ("log", "a log that is not there", write("log.csv", GOOD_LOG), ["observe", "lag.csv"], MISSING, ("lag.csv",)),
]

CALLS = [
    call("a command that does not exist", ["calibrat", "study"], USAGE, "calibrat"),
    call("a study that is not there", ["check", "stduy"], MISSING, "stduy"),
    call("an option that does not exist", ["check", "study", "--sed", "1"], USAGE, "--sed"),
    call("no study", ["check"], USAGE, "STUDY"),
    call("two studies", ["check", "study", "study"], USAGE, "study"),
    call("a seed below 0 on the command line", ["calibrate", "study", "--seed", "-1"], USAGE, "seed"),
    call("a seed of text", ["calibrate", "study", "--seed", "x"], USAGE, "seed"),
    call("a --set without a value", ["check", "study", "--set", "study.seed"], USAGE, "study.seed"),
    call("a --set of a key that does not exist", ["check", "study", "--set", "study.sed=1"], STUDY, "study.sed"),
    call("a --set beyond its bound", ["check", "study", "--set", "study.seed=-1"], STUDY, "study.seed", "-1"),
    call("a sampler that does not exist on the command line", ["calibrate", "study", "--sampler", "hmc"], USAGE, "hmc"),
    call("no draws", ["sample", "study", "--sbc", "0"], USAGE, "sbc"),
    call("a simulation without a rig", ["simulate", "study"], STUDY, "rig"),
    call("a training without a rig", ["train", "study"], STUDY, "rig"),
    call("a plan of no candidates", ["plan", "study", "--batch", "0"], USAGE, "batch"),
    call("a plan about what is not there", ["plan", "study", "--about", "x"], USAGE, "x"),
    call("results in a file", ["fit", "study", "--out", "study/study.toml"], WRITE, "study.toml"),
    call("a report without results", ["report", "study"], MISSING, "calibrate"),
    call("help of what is not there", ["help", "fricton"], USAGE, "fricton"),
    call("a picture of a frame that is not there", ["render", "none.vtkhdf"], MISSING, "none.vtkhdf"),
    call("a picture of a file that is no frame", ["render", "study/runs.csv"], DATA, "runs.csv"),
    call("a point that is not there", ["simulate", "study", "--at", "fricton=0.4"], USAGE, "fricton", base="quick"),
    call("a point that is no number", ["simulate", "study", "--at", "friction=x"], USAGE, "friction", base="quick"),
    call("a point without a value", ["simulate", "study", "--at", "friction"], USAGE, "friction", base="quick"),
    call("a friction below 0", ["simulate", "study", "--at", "friction=-1"], USAGE, "friction", "-1", base="quick"),
    call("a material that is not there", ["simulate", "study", "--material", "sand"], USAGE, "sand", base="quick"),
    call("frames below 0", ["simulate", "study", "--frames", "-1"], USAGE, "frames", base="quick"),
    call("an instruction set that does not exist", ["simulate", "study", "--isa", "sse9"], USAGE, "sse9", base="quick"),
    call("no jobs", ["train", "study", "--jobs", "0"], USAGE, "jobs", base="quick"),
    call("runs below 1", ["design", "study", "--runs", "0"], USAGE, "runs", base="quick"),
    call("a time that is none", ["train", "study", "--until", "posterior", "--for", "soon"], USAGE, "soon", base="quick"),
    call("a time without a unit", ["train", "study", "--until", "posterior", "--for", "1"], USAGE, "'1'", "2h", base="quick"),
    call("a share that is no number", ["train", "study", "--until", "posterior", "--share", "nan"], USAGE, "share", "nan", base="quick"),
    call("a scale below 0", ["check", "study", "--set", "rig.scale={ mean = -7.1, sd = 0.9 }"], STUDY, "scale.mean", "-7.1", base="quick"),
    call("a key of no entry", ["check", "study", "--set", "calibrate.noise=unknown"], STUDY, "calibrate.powder.noise", base="quick"),
    call("training until something else", ["train", "study", "--until", "friday"], USAGE, "friday", base="quick"),
    call("an export to another engine", ["export", "study", "case", "--to", "abaqus"], USAGE, "abaqus", base="quick"),
    call("an export that LIGGGHTS has not", ["export", "study", "case", "--to", "liggghts", "--at", "hamaker=1e-18"], STUDY, "hamaker", base="quick"),
    call("a collection of what was not exported", ["export", "study", "none", "--collect"], MISSING, "none", base="quick"),
    call("a new study where one is", ["new", "study"], WRITE, "study"),
    call("a new study without a name", ["new", ""], USAGE, "FOLDER"),
]

ENTRIES = SYNTAX + PARAMETERS + OBSERVATIONS + RUNS + RIG + LOGS + CALLS


def base_folder(data, base, folder):
    if base == "log":
        (folder / "log.csv").write_text(GOOD_LOG)
        return
    shutil.copytree(data / base, folder / "study")


def run(demcal, arguments, folder):
    try:
        done = subprocess.run([str(demcal), *arguments], cwd=folder, capture_output=True, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        return None, "ran on"
    return done.returncode, (done.stderr + b"\n" + done.stdout).decode("utf-8", "replace")


def faults_of(entry, demcal, data):
    base, title, change, arguments, status, words = entry
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        base_folder(data, base, folder)
        if change:
            change(folder if base == "log" else folder / "study")
        rc, text = run(demcal, arguments, folder)
    plain = " ".join(text.split())
    faults = []
    if rc != status:
        faults.append(f"status {rc} instead of {status}")
    faults += [f"does not say '{word}'" for word in words if word not in plain]
    if "defect of the program" in plain:
        faults.append("calls it a defect")
    return rc, plain, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--table", type=pathlib.Path, help="every input with its status and message")
    parser.add_argument("--only", default="", help="entries whose title holds this text")
    options = parser.parse_args()
    demcal, data = options.demcal.resolve(), options.data.resolve()

    bad = 0
    for base, arguments in (("other-code", ["check", "study"]), ("quick", ["check", "study"]),
                            ("log", ["observe", "log.csv", "--out", "out.csv"])):
        _, text, faults = faults_of((base, "as it is", None, arguments, 0, ()), demcal, data)
        if faults:
            bad += 1
            print(f"{base} as it is: {'; '.join(faults)}\n    {text}")
    rows = []
    for entry in ENTRIES:
        if options.only not in entry[1]:
            continue
        rc, text, faults = faults_of(entry, demcal, data)
        rows.append((entry[1], " ".join(entry[3]), rc, text))
        if faults:
            bad += 1
            print(f"{entry[1]}: {'; '.join(faults)}\n    {text[:400]}")
    if options.table:
        options.table.write_text("input\tcommand\tstatus\tanswer\n" + "".join("\t".join(map(str, row)) + "\n" for row in rows))
    print(f"{len(rows)} malformed inputs, {bad} not answered as they should be")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
