#!/usr/bin/python3
"""Frames of a run, read by VTK's own reader of VTKHDF, which is ParaView's: read_frames.py DEMCAL STUDY FOLDER"""
import pathlib
import shutil
import subprocess
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader


def read(path):
    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path)), path
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    arrays["points"] = vtk_to_numpy(grid.GetPoints().GetData())
    arrays["types"] = numpy.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
    return arrays


def simulate(program, study, out, *more):
    done = subprocess.run([program, "simulate", study, "--out", str(out), "--at", "rpm=120", "--quiet", "--set", "rig.fill=200",
                           "--set", 'run.longest="0.5 s"', *more])
    assert done.returncode in (0, 2), done.returncode


def main(program, study, keep):
    out = pathlib.Path(keep)
    shutil.rmtree(out, ignore_errors=True)
    simulate(program, study, out, "--frames", "3")
    files = sorted((out / "frames").iterdir())
    assert [file.name for file in files] == ["0000.vtkhdf", "0001.vtkhdf", "0002.vtkhdf"], files
    frames = [read(file) for file in files]
    for frame in frames:
        spheres = frame["material"] >= 0
        assert spheres.sum() == 200 and (frame["types"] == 1).sum() == 200 and (frame["types"] == 5).sum() > 100
        assert (frame["radius"][spheres] > 0).all() and (frame["radius"][~spheres] == 0).all()
        assert set(frame["material"][~spheres]) == {-1, -2}  # mixer and trough
        assert 0.5 < frame["coordination"][spheres].mean() < 6
        assert numpy.isfinite(frame["velocity"]).all() and numpy.isfinite(frame["force"]).all()
        # Every touching pair counted from the positions alone; across the periodic ends there are a few more.
        at, radius = frame["points"][spheres].astype(float), frame["radius"][spheres].astype(float)
        gap = numpy.linalg.norm(at[:, None] - at[None], axis=2) - radius[:, None] - radius[None]
        touching = (gap < 0).sum() - len(at)
        assert 0.8 * frame["coordination"].sum() <= touching <= frame["coordination"].sum(), (touching, frame["coordination"].sum())
    first, last = frames[0], frames[-1]
    mixer, trough = first["material"] == -1, first["material"] == -2
    assert numpy.array_equal(first["points"][trough], last["points"][trough])
    assert not numpy.allclose(first["points"][mixer], last["points"][mixer])
    distance = [numpy.hypot(*frame["points"][mixer][:, 1:].T) for frame in (first, last)]
    assert numpy.allclose(*distance, atol=1e-8), "the mixer turns about the x axis"
    speed = 2 * numpy.pi * 120 / 60
    assert numpy.allclose(numpy.hypot(*last["velocity"][mixer][:, 1:].T), speed * distance[1], rtol=1e-4, atol=1e-7)

    # A frame that was deleted is made again, the same; the others stay.
    before = files[0].stat().st_mtime_ns
    simulate(program, study, out, "--frames", "3")
    assert files[0].stat().st_mtime_ns == before, "a finished run is not made again for frames that are there"
    files[1].unlink()
    simulate(program, study, out, "--frames", "3")
    again = read(files[1])
    assert all(numpy.array_equal(again[name], frames[1][name]) for name in again)

    # A picture of one, in POV-Ray, with something on it.
    picture = out / "picture.png"
    for colour in ("material", "speed"):  # the second takes the place of the first
        drawn = subprocess.run([program, "render", str(files[2]), "--out", str(picture), "--width", "300", "--by", colour],
                               capture_output=True, text=True)
        assert drawn.returncode == 0 and drawn.stdout.strip() == str(picture), drawn
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" and picture.stat().st_size > 5000
    print("3 frames of 200 spheres, mixer and trough, read by VTK")


if __name__ == "__main__":
    main(*sys.argv[1:])
