#include "data/csv.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/origin.hpp"
#include "tests/temporary.hpp"

namespace {
std::string failure(const std::string& text) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] {
    const data::Csv csv = data::parse_csv(text, "bench.csv");
    for (const data::CsvRow& row : csv.rows) csv.number(row, csv.column("torque"));
  });
}
}  // namespace

TEST_CASE("header, comments, quotes, blanks, CRLF and a byte-order mark are read") {
  const data::Csv csv = data::parse_csv(
      "\xEF\xBB\xBF# made by hand\r\n#second\r\n\r\n\"speed\", torque ,note\r\n50, 1.5 ,\"a, \"\"b\"\"\nc\"\r\n# "
      "later\r\n"
      "+60,-2e-3,\r\n",
      "x.csv");
  CHECK(csv.comments == std::vector<std::string>{"made by hand", "second"});
  CHECK(csv.columns == std::vector<std::string>{"speed", "torque", "note"});
  REQUIRE(csv.rows.size() == 2);
  CHECK(csv.rows[0].fields[2] == "a, \"b\"\nc");
  CHECK(csv.rows[0].line == 5);
  CHECK(csv.rows[1].line == 8);
  CHECK(csv.number(csv.rows[1], 0) == 60.0);
  CHECK(csv.number(csv.rows[1], 1) == -2e-3);
  CHECK(std::isnan(csv.number(csv.rows[1], 2)));
  CHECK(csv.header_line == 4);
}

TEST_CASE("what is wrong with a CSV is named with file, line and column") {
  CHECK(failure("speed,torqe\n1,2\n") ==
        "65: bench.csv:1: the column 'torque' is missing (the columns are speed, torqe; is 'torqe' meant?)");
  CHECK(failure("speed,torque\n1,2\n3,1.2.3\n") ==
        "65: bench.csv:3: torque: '1.2.3' is not a number (write a plain number with a decimal point)");
  CHECK(failure("n,torque\n1,low\n").find("65: bench.csv:2: torque: 'low' is not a number") == 0);
  CHECK(
      failure("speed,torque\n1,2\n3") ==
      "65: bench.csv:3: has 1 fields where the header has 2 (complete the line; the file may have been cut off here)");
  CHECK(failure("torque,torque\n1,2\n") ==
        "65: bench.csv:1: the column 'torque' is there twice (rename or remove one)");
  CHECK(failure("torque\n\"1\n") == "65: bench.csv:2: a quoted field does not end (add the closing quote)");
  CHECK(failure("# only this\n") ==
        "65: bench.csv: is empty: there is no header line (the first line names the columns)");
  CHECK(failure("torque\n1e999\n").find("65: bench.csv:2: torque: '1e999' is too large") == 0);
}

TEST_CASE("fields and numbers read back as they were written") {
  for (const std::string text : {"plain", "a,b", "a \"quoted\" one", " blank ", "#no comment", "two\nlines", ""}) {
    const data::Csv csv = data::parse_csv("name,x\n" + data::csv_field(text) + ",1\n", "x.csv");
    CHECK(csv.rows.at(0).fields.at(0) == text);
  }
  for (const double value : {0.1, 1.0 / 3.0, 2e-18, -1.7976931348623157e308, 5e-324, 0.0}) {
    const data::Csv csv = data::parse_csv("x\n" + data::shortest(value) + "\n", "x.csv");
    CHECK(csv.number(csv.rows.at(0), 0) == value);
  }
}

namespace {

constexpr const char* plain = "speed,torque,torque_se\n50,9.95952,0.204\n100,9.37955,0.192\n150,1234.5,0.18\n";

/// Every number of the three columns, whatever the table around them.
std::vector<double> numbers_of(const std::string& text) {
  const data::Csv csv = data::parse_csv(text, "bench.csv");
  std::vector<double> numbers;
  for (const data::CsvRow& row : csv.rows)
    for (const char* name : {"speed", "torque", "torque_se"}) numbers.push_back(csv.number(row, csv.column(name)));
  return numbers;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string in_utf16(const std::string& text) {
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += std::string{c, '\0'};
  return wide;
}

std::string decimal_commas(const std::string& text, const std::string& separator) {
  std::string changed = with(text, ",", "\x01");
  changed = with(changed, ".", ",");
  return with(changed, "\x01", separator);
}

}  // namespace

TEST_CASE("a table gives the same numbers however it is written, and says how it was read") {
  const std::vector<double> expected = numbers_of(plain);
  REQUIRE(expected.size() == 9);
  const std::string rows = std::string(plain).substr(std::string(plain).find('\n') + 1);
  const std::vector<std::pair<std::string, std::string>> written{
      {decimal_commas(plain, ";"), "separated by semicolons"},
      {decimal_commas(plain, "\t"), "decimal commas"},
      {with(decimal_commas(plain, ";"), "1234,5", "1.234,5"), "decimal commas"},
      {with(plain, ",", "\t"), "separated by tabs"},
      {with(plain, ",", " | "), "separated by vertical bars"},
      {with(plain, ",", "   "), "separated by blanks"},
      {with(with(plain, ",", "\",\""), "\n", "\"\n\"").insert(0, "\"") + "\"", ""},
      {in_utf16(plain), "UTF-16"},
      {in_utf16(with(plain, ",", "\t")), "separated by tabs"},
      {"# R\xfchrwerk\n" + std::string(plain), "Latin-1"},
      {"# " + std::string(plain), "the heading in the comment of line 1"},
      {"% made by a script\n% " + std::string(plain), "the heading in the comment of line 2"},
      {"// " + std::string(plain), "the heading in the comment"},
      {"sep=,\n" + std::string(plain), ""},
      {"SEP=;\n" + with(plain, ",", ";"), "separated by semicolons"},
      {"sep=;\r\n" + with(with(plain, ",", ";"), "\n", "\r\n"), "separated by semicolons"},
      {with(plain, "\n", "\r"), ""},
      {with(plain, "\n", ",\n"), ""},
      {"speed,torque,torque_se\n" + with(rows, "\n", ",,\n"), "separators behind the last column"},
      {std::string(plain) + ",,\n,,\n\n", ""},
      {"speed,torque,torque_se\nrpm,mN m,mN m\n" + rows, "units in line 2"},
      {"speed,torque,torque_se\n[rpm],[mNm],[mNm]\n" + rows, "units in line 2"},
      {"Instrument,AR-G2\nOperator,B. Muster\nSample,\"powder, dry\"\n\n" + std::string(plain),
       "the heading in line 5, below a preamble"},
      {"Mass (g),12.5\nDate,2024-05-03\n\n" + std::string(plain), "below a preamble"},
      {"[step]\nFlow sweep - 1\n" + with(plain, ",", "\t"), "below a preamble"},
      {"Measurement 1\nspeed\ttorque\ttorque_se\n[1/min]\t[mN\xc2\xb7m]\t[mN\xc2\xb7m]\n" + with(rows, ",", "\t"),
       "units in line 3"},
      {std::string(plain) + std::string(64, '\0'), "64 zero bytes"},
      {std::string(plain) + "200,8.0" + std::string(9, '\0'), "the line that breaks off there left out"},
      {with(plain, "9.95952", "9.95952D+00"), ""},
      {with(plain, "1234.5", "1'234.5"), ""},
      {std::string(plain) + "End of file\n", "1 line of words below the table left out"},
      {std::string(plain) + "\nAverage,9.9,0.2\nStd. dev.:,1.5,0\n",
       "2 lines of statistics below the table left out (Average, Std. dev.:)"},
      {"sample,speed,torque,torque_se\nA,50,9.95952,0.204\nB,100,9.37955,0.192\nmax,150,1234.5,0.18\n\nMean,,9.5,\n",
       "1 line of statistics below the table left out (Mean)"},
      {"speed [rpm],torque (mNm),\"torque_se, mNm\"\n" + rows, ""},
      {"speed,torque,torque_se\n5.00E+01,9.95952E+00,2.04E-01\n1.00E+02,9.37955e+00,1.92e-01\n150,1.2345E3,.18\n", ""},
      {std::string(plain) + "\nNote: dried, sieved and conditioned.\n* by hand, in air\n", "2 lines of words below"},
      {"\"speed\" \"torque\" \"torque_se\"\n" + with(rows, ",", " "), "separated by blanks"},
      {"\"speed\" \"torque\" \"torque_se\"\n\"1\" 50 9.95952 0.204\n\"2\" 100 9.37955 0.192\n\"3\" 150 1234.5 0.18\n",
       "separated by blanks"},
      {"speed,torque,torque_se\nrpm,mN m,mN m\nset,measured,of the mean\n" + rows, "units in line 2"},
      {with(plain, "100,", ",,\n100,"), ""},
      {"speed\xef\xbc\x88rpm\xef\xbc\x89,torque\xef\xbc\xbbmN m\xef\xbc\xbd,torque_se\n" + rows, ""},
      {"speed\x81\x69rpm\x81\x6a,torque,torque_se\n" + rows, "Shift-JIS"},
      {with(plain, "100,", "speed,torque,torque_se\n100,"), "the heading again in line 3: the rows joined"},
  };
  for (const auto& [text, took] : written) {
    INFO(text);
    CHECK(numbers_of(text) == expected);
    CHECK(data::parse_csv(text, "bench.csv").took_line().find(took) != std::string::npos);
  }
  CHECK(data::parse_csv(plain, "bench.csv").took_line().empty());
}

TEST_CASE("blanks part columns of words, too, below a heading, and no lines of prose") {
  const TemporaryFolder folder;
  const auto table = [&](const std::string& text) { return data::read_csv(folder.write("t.dat", text)); };
  const data::Csv dakota = table(
      "%eval_id interface   mu_s    torque \n1  NO_ID  0.63  12.2 \n2  NO_ID  0.49  13.5 \n3  NO_ID  0.11  5.9 \n");
  CHECK(dakota.headings == std::vector<std::string>{"eval_id", "interface", "mu_s", "torque"});
  REQUIRE(dakota.rows.size() == 3);
  CHECK(dakota.rows[1].fields == std::vector<std::string>{"2", "NO_ID", "0.49", "13.5"});
  const data::Csv log =
      table("Date Time Torque[Nm] Status\n2024-05-03 14:02:00.0 1.02 OK\n2024-05-03 14:02:00.1 1.10 OK\n");
  CHECK(log.columns == std::vector<std::string>{"Date", "Time", "Torque", "Status"});
  CHECK(log.rows.size() == 2);
  const data::Csv prose = table("a,b\nsee page 3,1 of 2\nsee page 4,2 of 2\n");
  CHECK(prose.headings == std::vector<std::string>{"a", "b"});
}

TEST_CASE("a column of another error than the standard error, or with an unknown unit, is named with what to do") {
  const auto missing = [](const std::string& heading, const char* column) {
    try {
      data::parse_csv(heading + "\n1,2,3\n", "t.csv").column(column);
    } catch (const data::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(missing("speed,torque,torque_sd", "torque_se"), Catch::Contains("divided by the root of the number"));
  CHECK_THAT(missing("speed,torque,torque_ci95", "torque_se"), Catch::Contains("divided by 1.96"));
  CHECK_THAT(missing("speed,torque (%FS),n", "torque"), Catch::Contains("the unit in 'torque (%FS)' is unknown"));
}

TEST_CASE(
    "a row with one field more than the heading is no row with a name, unless its first one counts or is a word") {
  CHECK(data::parse_csv("a\tb\nx\t1\t2\ny\t3\t4\n", "t.txt").columns.size() == 3);
  CHECK(data::parse_csv("a\tb\n1\t1\t2\n2\t3\t4\n", "t.txt").columns.size() == 3);
  CHECK(data::parse_csv("a\tb\n1\t2\t\n3\t4\t\n", "t.txt").columns.size() == 2);
  CHECK_THROWS_WITH(data::parse_csv("a\tb\n0.1\t1\t2\n0.2\t3\t4\n", "t.txt"), Catch::Contains("3 fields"));
}

TEST_CASE("a per cent in the row of units is a unit, and in a comment it begins one") {
  CHECK(data::parse_csv("share,torque\n%,mN m\n40,2\n", "t.csv").units == std::vector<std::string>{"%", "mN m"});
  CHECK(data::parse_csv("% by hand\nshare,torque\n40,2\n", "t.csv").comments == std::vector<std::string>{"by hand"});
}

TEST_CASE("units in a comment are read where a spreadsheet has quoted every cell") {
  const data::Csv csv =
      data::parse_csv("\"# units: speed [rpm]\",\" torque [N m]\"\n\"speed\",\"torque\"\n\"50\",\"2\"\n", "t.csv");
  CHECK(csv.units == std::vector<std::string>{"rpm", "N m"});
}

namespace {

/// The numbers of a column, one row after the other.
std::vector<double> column_of(const std::string& text, const std::string& name) {
  const data::Csv csv = data::parse_csv(text, "bench.csv");
  std::vector<double> numbers;
  for (const data::CsvRow& row : csv.rows) numbers.push_back(csv.number(row, csv.column(name)));
  return numbers;
}

}  // namespace

TEST_CASE("rows below each heading of a file are joined, whichever block is the longest") {
  const std::vector<double> expected{1.0, 2.0, 3.0, 4.0, 5.0};
  const std::string more = "3,3\n4,4\n5,5\n";
  for (const std::string between :
       {"\nspeed,torque\n", ",\nspeed,torque\n", "speed,torque\n", "\n# speed,torque\n", "\n\nSpeed,Torque\n",
        "\n[step]\nPeak hold - 2\nspeed,torque\n", "\nHold:,2,120\nspeed,torque\n", "\n\n# hold 2\n"}) {
    INFO(between);
    CHECK(column_of("speed,torque\n1,1\n2,2\n" + between + more, "torque") == expected);
  }
  const std::string units = "speed,torque\nrpm,mN m\n";
  CHECK(column_of(units + "1,1\n2,2\n" + units + more, "torque") == expected);
  CHECK(column_of("# speed,torque\n# hold 1\n1,1\n2,2\n\n# speed,torque\n" + more, "torque") == expected);
}

TEST_CASE("a block in other units is converted to those of the first, and one without is refused") {
  const std::vector<double> expected{1000.0, 2000.0, 3000.0};
  CHECK(column_of("rpm,torque [mN m]\n1,1000\n\nrpm,torque [N m]\n2,2\n3,3\n", "torque") == expected);
  CHECK(column_of("rpm,torque\nrpm,mNm\n1,1000\nrpm,torque\nrpm,Nm\n2,2\n3,3\n", "torque") == expected);
  CHECK(column_of("# rpm torque[mNm]\n1 1000\n\n\n# rpm torque[Nm]\n2 2\n3 3\n", "torque") == expected);
  CHECK(column_of("# units: torque [mN m]\nrpm,torque\n1,1000\n# units: torque [N m]\nrpm,torque\n2,2\n3,3\n",
                  "torque") == expected);
  const TemporaryFolder folder;
  CHECK(
      failure_of(folder, [&] { column_of("rpm,torque [mN m]\n1,1\n\nrpm,torque\n2,2\n3,3\n", "torque"); }) ==
      "65: bench.csv:4: torque: is without a unit in the 2 rows below, but in 'mN m' in the 1 rows below line 1 (write "
      "the unit into both headings)");
  CHECK(failure_of(folder, [&] {
          column_of("rpm,torque [mN m]\n1,1\n\nrpm,torque [kg]\n2,2\n", "torque");
        }).find("is in 'kg' in the 1 rows below, but in 'mN m'") != std::string::npos);
}

TEST_CASE("a second table is refused with both headings, and numbers of a preamble are named") {
  const TemporaryFolder folder;
  CHECK(failure_of(folder, [&] { column_of("rpm,torque\n1,1\n2,2\n\nspeed,flow\n1,1\n2,2\n3,3\n", "flow"); }) ==
        "65: bench.csv:1: a heading with 2 rows (rpm, torque) is another than that of line 5 with 3 rows (speed, flow) "
        "(name the columns alike in both, in one order, or put each table into a file of its own)");
  CHECK(failure_of(folder, [&] {
          column_of("1,1\n2,2\n\nrpm,torque\n1,1\n2,2\n3,3\n", "torque");
        }).find("65: bench.csv:1: there are numbers where the header line belongs, in 2 lines above") == 0);
  CHECK(failure_of(folder, [&] {
          column_of("rpm,torque,x\n1,1,1\n2,2\nrpm,torque,x\n3,3,3\n", "torque");
        }).find("65: bench.csv:3: has 2 fields where the header has 3") == 0);
  CHECK(failure_of(folder, [&] {
          column_of("case,state,mu,torque\na,ok,1,1\nb,ok,2,2\n\ncase,state,flow,x\na,ok,1,1\nb,ok,2,2\n", "torque");
        }).find("65: bench.csv:5: a heading with 2 rows (case, state, flow, x) is another than that of line 1") == 0);
  const std::string preamble = "Parameter,Value,Unit\nFill,250,g\nTemperature,25,C\nrpm,torque,torque_se\n1,1,1\n";
  CHECK(data::parse_csv(preamble, "bench.csv").took_line().find("below a preamble (numbers in lines 2, 3 left out)") !=
        std::string::npos);
}

TEST_CASE("an unknown unit among others leaves the row of units one") {
  const data::Csv csv = data::parse_csv(
      "Time;Torque;Humidity;Level;Clock\ns;mNm;% r.F.;Skt;hh:mm:ss\n0,5;1,5;45;1;12:00:00\n1,0;1,5;45;1;12:00:01\n",
      "x.csv");
  CHECK(csv.columns.front() == "Time");
  CHECK(csv.units == std::vector<std::string>{"s", "mNm", "% r.F.", "Skt", "hh:mm:ss"});
  CHECK(csv.rows.size() == 2);
}

TEST_CASE("a heading in a comment is found above lines and remarks of gnuplot") {
  for (const std::string below : {"# -----------------\n", "# hold 1\n", "# measured by hand\n"}) {
    INFO(below);
    CHECK(column_of("# time [s]   torque [mN m]   rpm\n" + below + "0 1 50\n1 2 50\n\n\n# hold 2\n2 3 50\n",
                    "torque") == std::vector<double>{1.0, 2.0, 3.0});
  }
}

TEST_CASE("remarks that hold a separator or a decimal comma change neither") {
  const std::vector<double> expected{1.5, 2.5, 3.5};
  CHECK(column_of("a;torque;fill\n1;1.5;\n1;2.5;2,5 kg\n1;3.5;2,5\n", "torque") == expected);
  CHECK(column_of("a,torque,event\n1,1.5,\n1,2.5,start; 50 rpm\n1,3.5,ok; go\n", "torque") == expected);
}

TEST_CASE("a column is found whatever its capitals, and an error in a field is asked for a column of its own") {
  CHECK(column_of("Speed,Torque [mN m]\n1,2\n", "torque") == std::vector<double>{2.0});
  CHECK(column_of("torque,Torque\n1,2\n", "torque") == std::vector<double>{1.0});
  CHECK(failure("M,Speed\n1,2\n").find("the column 'torque' is missing") != std::string::npos);
  CHECK(failure("speed,torque\n1,9.42 \xc2\xb1 0.28\n") ==
        "65: bench.csv:2: torque: '9.42 \xc2\xb1 0.28' is a number with an error (write the error into a column of its "
        "own, torque_se, if it is the standard error of the mean)");
}

TEST_CASE("a heading of several words is found by the name that a study can have") {
  const data::Csv csv = data::parse_csv("Static Friction,A:mu,Run-Time [s],torque\n0.4,1,2,3\n", "edem.csv");
  CHECK(csv.column("static_friction") == 0);
  CHECK(csv.column("A_mu") == 1);
  CHECK(csv.column("run_time") == 2);
  CHECK_FALSE(csv.find("static_friction"));
  CHECK_THROWS_WITH(data::parse_csv("a b,a-b,c\n1,2,3\n", "t.csv").column("a_b"), Catch::Contains("is there twice"));
}

TEST_CASE("a name that two columns have matters where it is asked for and they differ") {
  CHECK(column_of("torque,status,status\n1,0,1\n", "torque") == std::vector<double>{1.0});
  CHECK(column_of("time [s],torque,time [s],rpm\n1,2,1,3\n2,2,2,3\n", "time") == std::vector<double>{1.0, 2.0});
  CHECK(failure("torque,torque\n1,2\n").find("the column 'torque' is there twice") != std::string::npos);
}

TEST_CASE("what can be read in two ways is asked back, not guessed") {
  const auto refused = [](const std::string& text) {
    const TemporaryFolder folder;
    return failure_of(folder, [&] { data::parse_csv(text, "bench.csv"); });
  };
  // Decimal commas between commas.
  CHECK(refused("speed,torque,torque_se\n50,9,95952,0,204\n100,9,37955,0,192\n")
            .find("cannot be told apart: part the columns by semicolons") != std::string::npos);
  // Thousands or decimals.
  CHECK(refused("speed;torque\n50;1,234\n100;2,345\n").find("65: bench.csv:2: '1,234' may be 1.234 or 1234") == 0);
  CHECK(refused("speed;torque\n50;1,5\n100;2.5\n")
            .find("'1,5' has a decimal comma, but '2.5' in line 3 a decimal point") != std::string::npos);
  CHECK(refused("speed;torque\n50;1,5\n1.500;2,5\n").find("'1.500' may be a decimal number or thousands") !=
        std::string::npos);
  // Between commas, too: decimal commas in quotes, as a spreadsheet writes them in German.
  CHECK(refused("speed,torque\n50,\"12,383\"\n100,\"12,5\"\n").empty());
  CHECK(refused("speed,torque\n50,\"12,383\"\n100,\"11,941\"\n")
            .find("65: bench.csv:2: '12,383' may be 12.383 or 12383") == 0);
  CHECK(refused("speed,torque,x\n50,\"12,383\",0.5\n").find("'12,383' may be 12.383 or 12383") != std::string::npos);
  // Whole numbers beside thousands with a point.
  CHECK(refused("speed;torque\n50;950\n100;1.012\n") ==
        "65: bench.csv:3: '1.012' may be 1012, like the whole numbers of its column, or 1.012 (write 1012 or 1.0120)");
  CHECK(refused("speed;torque\n50;10\n100;9.419\n").empty());
  CHECK(refused("speed;torque\n50;950\n100;1.0120\n").empty());
  CHECK(refused("50,1\n100,2\n").find("65: bench.csv:1: there are numbers where the header line belongs") == 0);
  CHECK(refused(std::string("speed,torque\n50,1\0\0,2\n60,2\n", 27)).find("65: bench.csv:2: holds zero bytes") == 0);
}

TEST_CASE("a number with both marks says what they are in the numbers with one") {
  CHECK(column_of("time\ttorque\n900\t980.9\n1,000\t1,012.3\n", "time") == std::vector<double>{900.0, 1000.0});
  CHECK(column_of("speed,torque\n\"1,050\",\"9,418.8\"\n", "speed") == std::vector<double>{1050.0});
}

TEST_CASE("a comment among the rows that names the columns in other units counts as a heading") {
  CHECK(column_of("# time [s] torque [mN m]\n0 1000\n1 2000\n\n# time [s] torque [N m]\n2 3\n", "torque") ==
        std::vector<double>{1000.0, 2000.0, 3.0e3});
}

TEST_CASE("words for no value are no numbers, and other words are named") {
  const data::Csv csv = data::parse_csv("a,b\n1,N/A\n2,-\n3,#N/A\n4,1.#QNAN\n5,****\n6,NULL\n7,7\n8,low\n", "x.csv");
  for (std::size_t i = 0; i < 6; ++i) CHECK(std::isnan(csv.number(csv.rows[i], 1)));
  CHECK(csv.number(csv.rows[6], 1) == 7.0);
  CHECK_THROWS_AS(csv.number(csv.rows[7], 1), data::InputError);
}

TEST_CASE("the unit of a column is the heading's, that of a row below it, or that of demcal's own comment") {
  const data::Unit wanted = data::parse_unit("uN m");
  const auto factor = [&](const std::string& text) {
    const data::Csv csv = data::parse_csv(text, "x.csv");
    return csv.unit(csv.column("torque"), wanted).factor;
  };
  CHECK(factor("rpm,torque\n50,1\n") == Approx(1e-6));
  CHECK(factor("rpm,torque [mN m]\n50,1\n") == Approx(1e-3));
  CHECK(factor("rpm,torque\n1/min,mNm\n50,1\n") == Approx(1e-3));
  CHECK(factor("rpm\ttorque\tstatus\n[1/min]\t[mNm]\t[]\n50\t1\tM-\n") == Approx(1e-3));
  CHECK(
      factor("# from log.csv, by demcal observe\n# units: rpm [rpm], torque [mN m]; seconds: s\nrpm,torque\n50,1\n") ==
      Approx(1e-3));
  // Saved again by a spreadsheet, which put the comment into cells.
  CHECK(factor("# units: rpm [rpm];\"torque [mN m]; seconds: length\";;\nrpm;torque;seconds\n50;1,5;2\n") ==
        Approx(1e-3));
  const TemporaryFolder folder;
  CHECK(failure_of(folder, [&] { factor("rpm,torque [kg]\n50,1\n"); }) ==
        "65: x.csv:1: torque: is in 'kg', which does not measure what the study's 'uN m' does (correct the unit in the "
        "table or in the study)");
}

TEST_CASE("a heading of 100,000 columns and a preamble of 20,000 lines are read in time") {
  std::string names, values, words;
  for (int i = 0; i < 100000; ++i) {
    names += "c" + std::to_string(i) + ",";
    values += "1,";
    if (i < 20000) words += "word\n";
  }
  CHECK(data::parse_csv(names + "z\n" + values + "1\n", "x.csv").columns.size() == 100001);
  CHECK(data::parse_csv(words + plain, "x.csv").rows.size() == 3);
}

TEST_CASE("a heading that a spreadsheet wrapped in its cell is one line") {
  const data::Csv csv = data::parse_csv("\"time\n[s]\",\"torque\r\n[N m]\"\n0,1\n1,2\n", "x.csv");
  CHECK(csv.columns == std::vector<std::string>{"time", "torque"});
  CHECK(csv.units == std::vector<std::string>{"s", "N m"});
}

TEST_CASE("thousands parted by a blank, and a historian's words for no value, are read") {
  const data::Csv csv = data::parse_csv("a;b\n1 200,5;Bad\n12 345 678,0;I/O Timeout\n7,5;<NA>\n7,25;1\n", "x.csv");
  CHECK(csv.number(csv.rows[0], 0) == 1200.5);
  CHECK(csv.number(csv.rows[1], 0) == 12345678.0);
  for (const std::size_t row : {0, 1, 2}) CHECK(std::isnan(csv.number(csv.rows[row], 1)));
}

TEST_CASE("a file of another kind is named for what it is") {
  for (const auto& [bytes, what] :
       {std::pair("PK\x03\x04zip", "spreadsheet"), std::pair("<html><td>1</td>", "web page"),
        std::pair("{\"time\": 1}", "JSON"), std::pair("TDSm....", "TDMS"), std::pair("\x1f\x8b\x08", "gzip"),
        std::pair("%PDF-1.7", "PDF"), std::pair("{\\rtf1\\ansi", "word processor"),
        std::pair("\xd0\xcf\x11\xe0", "xls"), std::pair("MATLAB 5.0 MAT-file", "MATLAB"), std::pair("MDF 4.10", "MDF"),
        std::pair("<?xml version", "XML"), std::pair("<!DOCTYPE html>", "web page"), std::pair("[{\"t\": 1}]", "JSON")})
    CHECK_THROWS_WITH(data::parse_csv(bytes, "x.csv"),
                      Catch::Contains("x.csv: is ") && Catch::Contains(what) && Catch::Contains("CSV"));
}

TEST_CASE("a table that was changed since demcal wrote it says so") {
  std::string text = data::with_mark("a,b\n1,2\n3,4\n", "t.csv");
  CHECK(data::parse_csv(text, "t.csv").took.empty());
  text[text.find("3,4")] = '5';
  CHECK_THAT(data::parse_csv(text, "t.csv").took_line(), Catch::Contains("t.csv: read as: it stands, though changed"));
}
