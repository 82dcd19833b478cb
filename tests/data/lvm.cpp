// Files as LabVIEW writes them, by National Instruments' "Specification for the LabVIEW Measurement File": the headers
// below have its tags and the separators behind the last column that LabVIEW leaves.
#include "data/lvm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "data/csv.hpp"
#include "data/torque_log.hpp"
#include "tests/temporary.hpp"

namespace {

constexpr double rpm = std::numbers::pi / 30.0;

struct Made {
  std::string separator = "Tab", decimal = ".", x_columns = "One", headings = "No", preference = "Relative";
  std::string samples = "4", units = "rpm\tN m", names = "Speed\tTorque", delta = "0.100000", dimension = "Time";

  std::string file_header() const {
    return fmt::format(
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\t{}\nDecimal_Separator\t{}\n"
        "Multi_Headings\t{}\nX_Columns\t{}\nTime_Pref\t{}\nOperator\tlab\nDate\t2024/04/10\nTime\t23:59:58.5\n"
        "***End_of_Header***\t\n\t\n",
        separator, decimal, headings, x_columns, preference);
  }
  std::string segment(const std::string& rows, const std::string& time = "23:59:58.500000",
                      const std::string& date = "2024/04/10", const std::string& x0 = "0.0000000000000000E+0") const {
    return fmt::format(
               "Channels\t2\t\t\nSamples\t{0}\t{0}\t\nDate\t{1}\t{1}\t\nTime\t{2}\t{2}\t\nY_Unit_Label\t{3}\t\n"
               "X_Dimension\t{4}\t{4}\t\nX0\t{5}\t{5}\t\nDelta_X\t{6}\t{6}\t\n***End_of_Header***\t\t\t\nX_Value\t{7}"
               "\tComment\n",
               samples, date, time, units, dimension, x0, delta, names) +
           rows;
  }
  /// In the separator and decimal mark of the file.
  std::string text(std::string made) const {
    if (decimal == ",") std::replace(made.begin(), made.end(), '.', ',');
    if (separator == "Comma") std::replace(made.begin(), made.end(), '\t', ',');
    return made;
  }
  std::string one(const std::string& rows) const { return text(file_header() + segment(rows)); }
};

const std::string four = "0.0\t60.0\t1.5\n0.1\t60.5\t1.25\tstarted\n0.2\t61.0\t1.75\n0.3\t60.0\t2.0\n";

data::TorqueLog log_of(const std::string& text, const data::LogColumns& columns = {}) {
  const TemporaryFolder folder;
  return data::read_torque_log(folder.write("log.lvm", text), columns);
}

std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] { data::read_torque_log(folder.write("log.lvm", text)); });
}

void check_four(const data::TorqueLog& log) {
  CHECK(log.torque == std::vector<double>{1.5, 1.25, 1.75, 2.0});
  REQUIRE(log.time.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(log.time[i] == Approx(0.1 * static_cast<double>(i)).margin(1e-12));
  CHECK(log.speed[2] == Approx(61.0 * rpm));
}

}  // namespace

TEST_CASE(
    "a LabVIEW file with one column of X values, parted by tabs or commas, with points or commas as decimal marks") {
  check_four(log_of(Made{}.one(four)));
  check_four(log_of(Made{.decimal = ","}.one(four)));
  check_four(log_of(Made{.separator = "Comma"}.one(four)));
  std::string plus = four;
  plus.replace(plus.find("0.1"), 3, "+0.1");
  check_four(log_of(Made{}.one(plus)));
  const data::Csv csv = data::parse_csv(Made{.decimal = ","}.one(four), "log.lvm");
  CHECK(csv.columns == std::vector<std::string>{"X_Value", "Speed", "Torque"});
  CHECK(csv.units == std::vector<std::string>{"s", "rpm", "N m"});
  CHECK(csv.took_line() == "log.lvm: read as: a LabVIEW measurement file, decimal commas, comments of 1 rows left out");
  std::string windows = Made{}.one(four);
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.insert(at, "\r");
  check_four(log_of(windows));
}

TEST_CASE("a LabVIEW file without X values has its times by X0 and Delta_X, one for each channel by any that agree") {
  const std::string rows = "\t60.0\t1.5\n\t60.5\t1.25\tstarted\n\t61.0\t1.75\n\t60.0\t2.0\n";
  check_four(log_of(Made{.x_columns = "No"}.one(rows)));
  check_four(log_of(Made{.decimal = ",", .x_columns = "No"}.one(rows)));
  Made multi{.x_columns = "Multi", .headings = "Yes"};
  multi.units = "rpm\t\tN m";
  multi.names = "Speed\tX_Value\tTorque";
  const std::string twice = "0.0\t60.0\t0.0\t1.5\n0.1\t60.5\t0.1\t1.25\n0.2\t61.0\t0.2\t1.75\n0.3\t60.0\t0.3\t2.0\n";
  check_four(log_of(multi.one(twice)));
  CHECK(refusal(multi.one("0.0\t60.0\t0.0\t1.5\n0.1\t60.5\t0.25\t1.25\n")) ==
        "65: log.lvm:25: the channels are sampled at different times, 0.1 s and 0.25 s (write them on one clock "
        "(X_Columns One), or each into a file of its own)");
}

TEST_CASE("units of a LabVIEW file are those in the names, then the labels that are units") {
  Made made;
  made.units = "Volts\tAmplitude";
  made.names = "Speed (1/min)\tTorque [mN m]";
  CHECK(log_of(made.one(four)).torque[0] == Approx(1.5e-3));
  made.names = "Speed (1/min)\tTorque";
  CHECK(refusal(made.one(four)) ==
        "65: log.lvm:23: the column 'Torque' has no unit (write it in the header, 'torque [N m]', or give "
        "--torque-unit)");
  made.units = "rpm\tVolts";
  CHECK(refusal(made.one(four)) ==
        "65: log.lvm:23: 'Volts' is not a unit of torque (a unit like 'N m'; --torque-unit overrides the header)");
}

TEST_CASE("segments of a LabVIEW file go on one clock, past midnight, and what cannot be joined is refused") {
  const Made made{.headings = "Yes"};
  const std::string first = made.file_header() + made.segment(four);
  const std::string rows = "0.0\t60.0\t3.0\n0.1\t60.0\t3.5\n";
  const data::TorqueLog log = log_of(first + "\t\n" + made.segment(rows, "00:00:03.250000", "2024/04/11"));
  REQUIRE(log.time.size() == 6);
  CHECK(log.time[4] == Approx(4.75).margin(1e-6));
  CHECK(log.time[5] == Approx(4.85).margin(1e-6));
  CHECK(log.took.back() == "comments of 1 rows left out");
  CHECK(std::count(log.took.begin(), log.took.end(), "2 segments joined") == 1);

  CHECK(refusal(first + made.segment(rows)) ==
        "65: log.lvm: the segment of line 37 begins at 0 s, but the one above it ends at 0.3 s (give the samples per "
        "second with --rate, if they are even all through)");
  data::LogColumns columns;
  columns.rate = 10.0;
  CHECK(log_of(first + made.segment(rows), columns).torque.size() == 6);
  Made other = made;
  other.names = "Speed\tForce";
  CHECK(
      refusal(first + other.segment(rows, "00:00:03.25", "2024/04/11")) ==
      "65: log.lvm:37: the segment has the channels Speed, Force, that of line 23 has Speed, Torque (write each into a "
      "file of its own)");
  other = made;
  other.units = "rpm\tmN m";
  CHECK(refusal(first + other.segment(rows, "00:00:03.25", "2024/04/11"))
            .find("'Torque' is in 'mN m' in this segment and in 'N m' in that of line 23") != std::string::npos);
}

TEST_CASE("a LabVIEW file that does not say its times is refused, and taken with a rate") {
  const std::string rows = "\t60.0\t1.5\n\t60.5\t1.25\n\t61.0\t1.75\n\t60.0\t2.0\n";
  // LabVIEW writes a Delta_X of 1 where a packet has one sample.
  const Made single{.x_columns = "No", .samples = "1", .delta = "1.000000"};
  CHECK(
      refusal(single.one(rows)) ==
      "65: log.lvm: X_Columns is No, and more rows than the 1 of a packet (Samples) follow: nothing says when the next "
      "packet begins (give the samples per second with --rate, if they are even all through)");
  data::LogColumns columns;
  columns.rate = 10.0;
  check_four(log_of(single.one(rows), columns));
  CHECK(refusal(Made{.dimension = "Frequency"}.one(four)).find("its X values are 'Frequency', no time") !=
        std::string::npos);
}

TEST_CASE("absolute times, special blocks and packets without headings of a LabVIEW file are read, a cut one is not") {
  const Made absolute{.preference = "Absolute", .samples = "2"};
  const std::string since_1904 =
      "3795465598.5\t60.0\t1.5\n3795465598.6\t60.5\t1.25\n3795465598.7\t61.0\t1.75\n3795465598.8\t60.0\t2.0\n";
  const data::TorqueLog log = log_of(absolute.one(since_1904));
  CHECK(log.time[0] == 0.0);
  CHECK(log.time[3] == Approx(0.3).margin(1e-3));
  std::string special = Made{.samples = "2"}.one(four);
  special.insert(special.find("Channels"), "***Start_Special***\nWaveform\tx\n***End_Special***\n");
  check_four(log_of(special));
  CHECK(refusal(Made{}.one(four + "0.4\t60")) ==
        "65: log.lvm:28: has 2 fields where the line of names has 3 (complete the line; the file may have been cut off "
        "here)");
  CHECK(refusal(Made{}.file_header()).find("has no segment with samples") != std::string::npos);
}
