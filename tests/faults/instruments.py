#!/usr/bin/python3
"""Logs as instruments, loggers and spreadsheets write them: instruments.py DEMCAL [--only TEXT]

One torque series, 20 s at 100 rpm and 20 s at 200 rpm, in many forms. `READ`: demcal observe must give its two means, 5.0595 and 5.06005 N m
(those of the series itself, to the digits written), or those that the entry names. `REFUSED`: it must refuse with the status of bad data
and every word that the entry names: what it is, and what to do.
"""
import argparse
import csv
import datetime
import io
import json
import pathlib
import subprocess
import sys
import tempfile

COUNT = 400
HEAD = "time [s],torque [N m],rpm [1/min]\n"
BEGIN = datetime.datetime(2026, 3, 2, 14)
GERMAN = ("--time", "Zeit", "--torque", "Drehmoment", "--rpm", "Drehzahl")


def torque(i):
    return f"{5 + (i * 7919 % 13) / 100:.3f}"


def speed(i):
    return "100" if i < 200 else "200"


def seconds(i):
    return f"{0.1 * i:.1f}"


def rows(time=seconds, separator=",", comma=False, torque=torque, speed=speed, behind="", end="\n", count=range(COUNT)):
    text = "".join(separator.join([time(i), torque(i), speed(i)]) + behind + end for i in count)
    return text.replace(".", ",") if comma else text


def stamp(form, step=0.1, begin=BEGIN, digits=3):
    """Of a sample, by strftime; %f has as many digits as said."""
    def text(i):
        at = begin + datetime.timedelta(seconds=step * i)
        return at.strftime(form.replace("%f", f"{at.microsecond:06d}"[:digits]))
    return text


DAY, ISO = stamp("%d.%m.%Y %H:%M:%S"), stamp("%Y-%m-%dT%H:%M:%S.%fZ")
LATE = stamp("%H:%M:%S.%f", begin=datetime.datetime(2026, 3, 2, 23, 59, 40))


def summer_time_ends(i, zone):
    at = datetime.datetime(2026, 10, 25, 0, 59, 40) + datetime.timedelta(seconds=0.1 * i)  # UTC
    summer = at.hour < 1
    local = at + datetime.timedelta(hours=2 if summer else 1)
    return local.strftime("%Y-%m-%d %H:%M:%S.") + f"{local.microsecond // 1000:03d}" + ((" CEST" if summer else " CET") if zone else "")


def every_50th(word, other=torque):
    return rows(torque=lambda i: word if i % 50 == 7 else other(i))


LVM = ("LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\nX_Columns\tOne\n"
       "Time_Pref\tRelative\nDate\t2026/03/02\nTime\t14:00:00,0\n***End_of_Header***\t\n\nChannels\t2\nSamples\t400\t400\n"
       "Date\t2026/03/02\t2026/03/02\nTime\t14:00:00,0\t14:00:00,0\nY_Unit_Label\tN m\trpm\nX_Dimension\tTime\tTime\nX0\t0,0\t0,0\n"
       "Delta_X\t0,1\t0,1\n***End_of_Header***\nX_Value\ttorque\trpm\tComment\n")
STAMPED = "time,torque [N m],rpm\n"
SPREAD = "Zeit [s];Drehmoment [Nm];Drehzahl [1/min]\n"
LARGE = dict(speed=lambda i: "1200" if i < 200 else "2400")

# title, text, options, speeds and means where they are others
READ = [
    ("a German spreadsheet with its mark", "\ufeff" + SPREAD + rows(separator=";", comma=True), GERMAN),
    ("UTF-16 with tabs", ("\ufeff" + HEAD.replace(",", "\t") + rows(separator="\t", comma=True)).encode("utf-16-le"), ()),
    ("UTF-16, big end first", ("\ufeff" + HEAD + rows()).encode("utf-16-be"), ()),
    ("UTF-16 without its mark", (HEAD + rows()).encode("utf-16-le"), ()),
    ("a Chinese program's", ("测试报告：粉体\n时间(秒),扭矩(N·m),转速(转/分)\n" + rows()).encode("gbk"), ()),
    ("a Korean program's", ("시간[s],토크[N·m],회전수[rpm]\n" + rows()).encode("euc-kr"), ()),
    ("a Japanese program's", ("時間(秒),トルク(N・m),回転数(回/分)\n" + rows()).encode("cp932"), ()),
    ("a Russian program's", ("Время (с);Момент (Н·м);Скорость (об/мин)\n" + rows(separator=";", comma=True)).encode("cp1251"), ()),
    ("a Czech program's, in Windows-1250", ("Čas (s);Krouticí moment (N·m);Otáčky (ot/min)\n" + rows(separator=";", comma=True)).encode("cp1250"), ()),
    ("names that say nothing beside units that do", "Elapsed [s],Shaft 1 [N m],Drive [1/min],Work [J]\n" + rows(behind=",1"), ()),
    ("a degree of Windows-1252 in a comment", ("# 20 °C\n" + HEAD + rows()).encode("cp1252"), ()),
    ("a degree of Windows-1252 in a heading", (HEAD[:-1] + ",T [°C]\n" + rows(behind=",21.5")).encode("cp1252"), ()),
    ("statistics below the table", HEAD + rows() + "\nMean,5.06,150\nStd. dev.,0.04,50\n", ()),
    ("notes below the table", HEAD + rows() + "\nDried, sieved, conditioned\n", ()),
    ("scientific notation from the first row on", HEAD.replace(" [s]", "").replace(" [N m]", "").replace(" [1/min]", "") + "".join(f"{0.1 * i:.6e},{float(torque(i)):.6e},{float(speed(i)):.6e}\n" for i in range(COUNT)), ("--torque-unit", "N m")),
    ("R's write.table with row names", '"time [s]" "torque [N m]" "rpm [1/min]"\n' + "".join(f'"{i + 1}" {seconds(i)} {torque(i)} {speed(i)}\n' for i in range(COUNT)), ()),
    ("a third line of headings", "time,torque,rpm\ns,N m,1/min\nmeasured,filtered,encoder\n" + rows(), ()),
    ("wide brackets of a Japanese keyboard", "time（s）,torque（N・m）,rpm（1/min）\n" + rows(), ()),
    ("empty rows of a spreadsheet among the others", HEAD + rows(count=range(200)) + ",,\n" + rows(count=range(200, COUNT)), ()),
    ("a time that begins again with each section", HEAD + rows(count=range(200)) + "\n" + HEAD + rows(time=lambda i: seconds(i - 200), count=range(200, COUNT)), ()),
    ("units in a row below the names", "time,torque,rpm\ns,N m,1/min\n" + rows(), ()),
    ("units in brackets in a row", "time,torque,rpm\n[s],[Nm],[U/min]\n" + rows(), ()),
    ("line ends of both kinds", HEAD + "".join(line + ("\r\n" if i % 2 else "\n") for i, line in enumerate(rows().splitlines())), ()),
    ("line ends of old Macintoshes", (HEAD + rows()).replace("\n", "\r"), ()),
    ("line ends translated twice", (HEAD + rows()).replace("\n", "\r\r\n"), ()),
    ("headings wrapped in their cells", '"time\n[s]","torque\r\n[N m]","rpm\n[1/min]"\n' + rows(), ()),
    ("everything in quotes", '"time [s]","torque [N m]","rpm [1/min]"\n' + "".join(f'"{seconds(i)}","{torque(i)}","{speed(i)}"\n' for i in range(COUNT)), ()),
    ("thousands with points", SPREAD + rows(separator=";", comma=True, **LARGE).replace(";1200", ";1.200,0").replace(";2400", ";2.400,0"), GERMAN, (1200, 2400)),
    ("thousands with apostrophes", HEAD.replace(",", ";") + rows(separator=";", **LARGE).replace(";1200", ";1'200.0").replace(";2400", ";2'400.0"), (), (1200, 2400)),
    ("thousands with blanks", SPREAD + rows(separator=";", comma=True, **LARGE).replace(";1200", ";1 200,0").replace(";2400", ";2 400,0"), GERMAN, (1200, 2400)),
    ("thousands with narrow blanks", SPREAD + rows(separator=";", comma=True, **LARGE).replace(";1200", ";1\u202f200,0").replace(";2400", ";2\u202f400,0"), GERMAN, (1200, 2400)),
    ("ISO 8601 in UTC", STAMPED + rows(stamp("%Y-%m-%dT%H:%M:%S.%fZ")), ()),
    ("ISO 8601 with an offset", STAMPED + rows(stamp("%Y-%m-%dT%H:%M:%S.%f+01:00")), ()),
    ("ISO 8601 with the name of a place", STAMPED + rows(stamp("%Y-%m-%dT%H:%M:%S.%f+01:00[Europe/Berlin]")), ()),
    ("a zone by its name", STAMPED + rows(stamp("%Y-%m-%d %H:%M:%S.%f CET")), ()),
    ("a German zone", STAMPED + rows(stamp("%d.%m.%Y %H:%M:%S.%f MEZ")), ()),
    ("the end of summer time, said by the zone", STAMPED + rows(lambda i: summer_time_ends(i, True)), ()),
    ("weeks of ISO 8601", STAMPED + rows(stamp("%G-W%V-%uT%H:%M:%S.%f")), ()),
    ("days of the year", STAMPED + rows(stamp("%Y-%jT%H:%M:%S.%f")), ()),
    ("an American clock", STAMPED + rows(stamp("%m/%d/%Y %I:%M:%S %p", step=1)), ()),
    ("o'clock in German", STAMPED + rows(stamp("%H:%M:%S.%f Uhr")), ()),
    ("date and time in two columns", "Date,Time,torque [N m],rpm\n" + rows(stamp("%d.%m.%Y,%H:%M:%S.%f")), ()),
    ("seconds since 1970", STAMPED + rows(lambda i: f"{1772460000 + 0.1 * i:.1f}"), ()),
    ("milliseconds since 1970", "time [ms],torque [N m],rpm\n" + rows(lambda i: str(1772460000000 + 100 * i)), ()),
    ("stamps that five samples share", HEAD + rows(lambda i: seconds(i // 5 * 5)), ()),
    ("stamps of whole seconds", STAMPED + rows(stamp("%H:%M:%S")), ()),
    ("a pause of ten minutes within a hold", HEAD + rows(lambda i: seconds(i + (6000 if i >= 200 else 0))), ()),
    ("minus and plus signs of typesetters", HEAD + rows(torque=lambda i: "\u2212" + torque(i), speed=lambda i: "+" + speed(i)), (), (100, 200), -1),
    ("empty lines of separators below", HEAD + rows() + ",,\n,,\n", ()),
    ("empty columns of a spreadsheet", HEAD[:-1] + ",,,\n" + rows(behind=",,,"), ()),
    ("TwinCAT with a time for each channel", "Name\tScope\nFile\tC:\\x.svd\n\nTime\tTorque [Nm]\tTime\tSpeed [rpm]\n"
     + "".join(f"{100 * i}\t{torque(i)}\t{100 * i}\t{speed(i)}\n" for i in range(COUNT)),
     ("--time-unit", "ms", "--time", "Time", "--torque", "Torque", "--rpm", "Speed")),
    ("LabVIEW with decimal commas", LVM + rows(separator="\t", comma=True), ()),
    ("LabVIEW of Windows", (LVM + rows(separator="\t", comma=True)).replace("\n", "\r\n"), ()),
    ("a preamble of keys", "[Header]\nOperator=M\u00fcller\nDevice=T22/50Nm\n[Data]\n" + HEAD + rows(), ()),
    ("catman", ("HBM_CATMAN_DATAFILE_40 V5.4\t\nDATEI\tx.asc\nKAN\u00c4LE\t3\n\nZeit  1\tDrehmoment\tDrehzahl\ns\tNm\t1/min\n"
                + rows(separator="\t", comma=True)).encode("cp1252"), ("--time", "Zeit  1", *GERMAN[2:])),
    ("catman with rates and amplifiers below the units", ("Zeit  1 - Standardmessrate\tDrehmoment T20WN\tDrehzahl T20WN\n[s]\t[Nm]\t[1/min]\n"
                                                          "SR: 10 Hz\tSR: 10 Hz\tSR: 10 Hz\nMX840B_CH 1\tMX840B_CH 2\tMX840B_CH 3\n"
                                                          + rows(separator="\t", comma=True)).encode("cp1252"), ()),
    ("a clock of any name", "Aufgezeichnet;M1 [N m];rpm\n" + rows(stamp("%d.%m.%Y %H:%M:%S.%f"), separator=";"), ()),
    ("columns of one width", "  time [s]   torque [Nm]      rpm\n" + "".join(f"{seconds(i):>10}{torque(i):>12}{speed(i):>9}\n" for i in range(COUNT)), ()),
    ("a table of Markdown", "| time [s] | torque [N m] | rpm |\n|---|---|---|\n"
     + rows(lambda i: "| " + seconds(i), separator=" | ", behind=" |"), ()),
    ("a speed in hertz", HEAD.replace("1/min", "Hz") + rows(speed=lambda i: f"{float(speed(i)) / 60:.6f}"), ()),
    ("minutes", HEAD.replace("[s]", "[min]") + rows(lambda i: f"{0.1 * i / 60:.6f}"), ()),
    ("a heading again in other units", HEAD + rows(count=range(200)) + HEAD.replace("N m", "mN m")
     + rows(count=range(200, COUNT), torque=lambda i: f"{1000 * float(torque(i)):.1f}"), ()),
    ("zeros of a logger that lost power", (HEAD + rows()).encode() + bytes(4096), ()),
    *((f"no value: {word}", HEAD + every_50th(word), (), (100, 200), None)
      for word in ("NaN", "---", "#DIV/0!", "#NAME?", "#WERT!", "<NA>", "nil", "Bad", "I/O Timeout", "No Data")),
    ("beyond the range", HEAD + every_50th("OVER"), (), (100, 200), None),
    ("WinCC, a row for each value", '"VarName";"TimeString";"VarValue";"Validity";"Time_ms"\n' + "".join(
        f'"{name}";"{DAY(i)}";{value(i)};1;45415{i}\n' for i in range(COUNT)
        for name, value in (("Torque_Nm", lambda i: torque(i).replace(".", ",") + "0"), ("Speed_rpm", speed))), ()),
    ("a historian, values as they change", "Tag,Timestamp,Value,Quality,Units\n" + "".join(
        (f"L1.Mixer.Speed,{ISO(i)},{speed(i)},Good,1/min\n" if i in (0, 200) else "")
        + f"L1.Mixer.Torque,{ISO(i)},{torque(i)},Good,N m\nL1.Mixer.Torque,{ISO(i + 0.5)},0,Bad,N m\n" for i in range(COUNT)), ()),
    ("InfluxDB, one channel behind the other", "#group,false,false,true,false,false,true\n#datatype,string,long,dateTime:RFC3339,double,string,string\n"
     "#default,_result,,,,,\n,result,table,_time,_value,_field,_measurement\n" + "".join(
        f",,{table},{ISO(i)},{value(i)},{name},mixer\n" for table, (name, value) in enumerate((("torque_Nm", torque), ("rpm", speed)))
        for i in range(COUNT)), ()),
    ("channels past midnight", "Channel;Time;Value\n" + "".join(
        f"{name};{LATE(i)};{value(i)}\n" for i in range(COUNT) for name, value in (("Torque [N m]", torque), ("Speed [rpm]", speed))), ()),
]

# title, text, words of the answer
REFUSED = [
    ("units below the table", "time,torque,rpm\n" + rows() + "s,N m,1/min\n", ["torque", "no unit", "--torque-unit"]),
    ("thousands or decimals", HEAD.replace(",", ";") + rows(separator=";", **LARGE).replace(";1200", ";1,200").replace(";2400", ";2,400"), [":2", "'1,200'", "1.200 or 1200"]),
    ("the end of summer time, not said", STAMPED + rows(lambda i: summer_time_ends(i, False)), ["log.csv:202", "set back by an hour", "split"]),
    ("a zone that several places have", STAMPED + rows(stamp("%Y-%m-%d %H:%M:%S.%f BST")), [":2", "BST", "+02:00"]),
    ("counts of milliseconds without a unit", STAMPED + rows(lambda i: str(1772460000000 + 100 * i)), [":2", "1772460000000", "--time-unit"]),
    ("counts of Windows", STAMPED + rows(lambda i: str(133800000000000000 + 1000000 * i)), [":2", "133800000000000000", "--time-unit"]),
    ("days of a spreadsheet", STAMPED + rows(lambda i: f"{46083.5 + 0.1 * i / 86400:.9f}"), [":2", "spreadsheet's day", "--time-unit d"]),
    ("a time that goes back", HEAD + rows(lambda i: seconds(i - (50 if i >= 100 else 0))), ["log.csv:102", "5 s does not come after 9.9 s", "split"]),
    ("a minus sign behind", HEAD + rows(torque=lambda i: torque(i) + "-"), [":2", "torque", "no numbers", "'5.000-'"]),
    ("a last line that is cut off", HEAD + rows() + "40.0,5.", ["log.csv:402", "2 fields", "cut off"]),
    ("a word among the times", HEAD + rows() + "soon,5.06,150\n" + "40.1,5.06,200\n", ["log.csv:402", "soon"]),
    ("two clocks", "time [s],torque [N m],time [s],rpm\n" + "".join(f"{seconds(i)},{torque(i)},{0.1 * i + 0.05:.2f},{speed(i)}\n" for i in range(COUNT)), [":1", "time", "--time"]),
    ("LabVIEW with the other decimal mark", LVM + rows(separator="\t"), [":23", "Decimal_Separator", "'0.0'"]),
    ("LabVIEW cut in its header", LVM[:300], ["End_of_Header", "cut off"]),
    ("a separator that nothing uses", HEAD.replace(",", "*") + rows(separator="*"), [":1", "semicolons"]),
    ("JSON", "".join(json.dumps({"time": i, "torque": torque(i)}) + "\n" for i in range(COUNT)), ["JSON", "CSV"]),
    ("a spreadsheet itself", b"PK\x03\x04" + bytes(range(200)), ["spreadsheet", "CSV"]),
    ("an old spreadsheet itself", b"\xd0\xcf\x11\xe0" + bytes(range(200)), ["spreadsheet", "CSV"]),
    ("a web page called a spreadsheet", "<html><table><tr><td>time</td></tr></table></html>", ["web page", "CSV"]),
    ("TDMS", b"TDSm" + bytes(range(200)), ["TDMS", "CSV"]),
    ("gzip", b"\x1f\x8b\x08" + bytes(range(200)), ["gzip", "CSV"]),
    ("decimal commas between commas", "time,torque,rpm\n" + "".join(f"{i // 10},{i % 10},5,{i % 100:02d},{speed(i)}\n" for i in range(COUNT)), [":2", "5 fields", "semicolons"]),
    ("a torque in per cent", HEAD.replace("N m", "%") + rows(), [":1", "'%'", "torque"]),
    ("zeros amid the text", (HEAD + rows()[:3000]).encode() + bytes(100) + rows()[3000:].encode(), ["zero bytes"]),
    ("hexadecimal numbers", HEAD + rows(torque=lambda i: hex(i)), [":2", "torque", "0x0"]),
    ("digits of another script", HEAD + rows(torque=lambda i: "\u0665.\u0661"), [":2", "torque", "no numbers"]),
    ("a heading alone", HEAD, ["0 complete samples"]),
    ("a tachometer that gave nothing", HEAD + rows(speed=lambda i: "0"), ["the speed is 0 throughout", "--constant-speed"]),
    ("torque and speed exchanged", HEAD + rows(torque=speed, speed=lambda i: f"{5 + (i * 7919 % 397) / 4000:.5f}"),
     ["the torque takes 2 values and the speed 397", "exchanged", "--torque and --rpm"]),
    ("one sample", HEAD + "0,5,100\n", ["1 complete samples"]),
]


def wrong_means(text, speeds, sign):
    found = list(csv.DictReader(io.StringIO("".join(line for line in text.splitlines(True) if not line.startswith("#")))))
    if [round(float(row["rpm"])) for row in found] != list(speeds):
        return f"speeds {[row['rpm'] for row in found]}"
    wanted = [sign * 5.0595, sign * 5.06005] if sign else [5.0595, 5.0598]
    far = 1e-5 if sign else 1e-3
    if any(abs(float(row["torque"]) - mean) > far for row, mean in zip(found, wanted)):
        return f"means {[row['torque'] for row in found]}"
    return None


def observe(demcal, text, options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "log.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
        done = subprocess.run([demcal, "observe", "log.csv", "--out", "out.csv", *options], cwd=folder, capture_output=True, timeout=60)
        out = folder / "out.csv"
        return done.returncode, done.stderr.decode("utf-8", "replace"), out.read_text() if out.exists() else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal", type=pathlib.Path)
    parser.add_argument("--only", default="", help="entries whose title holds this text")
    options = parser.parse_args()
    demcal, bad = str(options.demcal.resolve()), 0
    for title, text, words, *means in READ:
        if options.only not in title:
            continue
        status, said, out = observe(demcal, text, words)
        speeds, sign = (means + [(100, 200), 1][len(means):])[:2]
        wrong = f"status {status}" if status not in (0, 2) else wrong_means(out, speeds, sign)
        if wrong:
            bad += 1
            print(f"{title}: {wrong}: {said[:300]}")
    for title, text, words in REFUSED:
        if options.only not in title:
            continue
        status, said, _ = observe(demcal, text, ())
        lacking = [word for word in words if word not in " ".join(said.split())]
        if status != 65 or lacking:
            bad += 1
            print(f"{title}: status {status}, does not say {lacking}: {said[:300]}")
    print(f"{len(READ)} logs to read, {len(REFUSED)} to refuse, {bad} not answered as they should be")
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()
