#include "data/csv.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
  CHECK(failure("torque\n\"1,5\"\n") ==
        "65: bench.csv:2: torque: '1,5' is not a number (write a plain number with a decimal point)");
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
