#include "data/number_text.hpp"

#include <catch2/catch.hpp>

using data::DecimalMark;
using data::Evidence;

TEST_CASE("numbers as the world writes them become plain decimals, and what is none stays none") {
  const auto point = [](const std::string& text) { return data::plain_number(text, DecimalMark::point).value_or("-"); };
  const auto comma = [](const std::string& text) { return data::plain_number(text, DecimalMark::comma).value_or("-"); };
  CHECK(point("1.5") == "1.5");
  CHECK(point("-2e-3") == "-2e-3");
  CHECK(point("+1.5") == "1.5");
  CHECK(point("+ 1.5") == "1.5");
  CHECK(comma("+1,5") == "1.5");
  CHECK(point("1.0D+00") == "1.0E+00");
  CHECK(point("1D-3") == "1E-3");
  CHECK(point("2.5-101") == "2.5E-101");
  CHECK(point("1,234.5") == "1234.5");
  CHECK(point("\xe2\x88\x92"
              "3.5") == "-3.5");
  CHECK(point("12'345.5") == "12345.5");
  CHECK(point("12\xc2\xa0"
              "345") == "12345");
  CHECK(comma("1,5") == "1.5");
  CHECK(comma("-0,204") == "-0.204");
  CHECK(comma("1.234,5") == "1234.5");
  CHECK(comma("1,5e3") == "1.5e3");
  for (const std::string none : {"1.2.3", "1,2,3", "abc", "", "-", "2024-05-03", "1 2", "12.34,5.6", "0x10", "1,5",
                                 "e5", "1d5", "12d3456", "4f2d17e9", "5 %"})
    CHECK(point(none) == "-");
  for (const std::string none : {"1,2,3", "12.34,5", "1.5.", "1,23.4"}) CHECK(comma(none) == "-");
}

TEST_CASE("a number is read with the unit behind it, as it stands, or not at all") {
  const auto parts = [](const std::string& text) {
    const auto found = data::number_with_unit(text);
    return found ? found->digits + "|" + found->unit : "none";
  };
  CHECK(parts("2e-18 J") == "2e-18|J");
  CHECK(parts(" 0.4") == "0.4|");
  CHECK(parts("+90min ") == "90|min");
  CHECK(parts("0x10") == "0|x10");  // no unit: refused by whoever asked
  for (const char* none : {"", "J", "= 0.4", "1e999", "- 3"}) CHECK(parts(none) == "none");
}

TEST_CASE("a number says which decimal mark it has, or that it may be read in two ways") {
  CHECK(data::decimal_evidence("0,345347") == Evidence::comma);
  CHECK(data::decimal_evidence("12,5") == Evidence::comma);
  CHECK(data::decimal_evidence("0,345") == Evidence::comma);  // no thousands begin with a zero
  CHECK(data::decimal_evidence("1234,567") == Evidence::comma);
  CHECK(data::decimal_evidence("1.234,5") == Evidence::comma);
  CHECK(data::decimal_evidence("1,234.5") == Evidence::point);
  CHECK(data::decimal_evidence("1,234,567") == Evidence::point);
  CHECK(data::decimal_evidence("9.95952") == Evidence::point);
  CHECK(data::decimal_evidence("1,234") == Evidence::maybe_comma);
  CHECK(data::decimal_evidence("1.234") == Evidence::maybe_point);
  CHECK(data::decimal_evidence("1234") == Evidence::none);
  CHECK(data::decimal_evidence("1.2.3") == Evidence::none);
}

TEST_CASE("the words for no value are known, and numbers and names are none of them") {
  for (const std::string word :
       {"",          "  ",   "nan",  "NaN",     "-nan",  "N/A",    "NA",      "-",       "--",
        "---",       "#N/A", "#NV",  "#DIV/0!", "NULL",  "null",   "1.#QNAN", "-1.#IND", "1.#INF",
        "1.#QNAN00", "****", "None", ".",       "#####", "---.--", "?"})
    CHECK(data::is_missing(word));
  for (const std::string word : {"0", "-1", "powder", "n", "1.5", "x-", "inf"}) CHECK_FALSE(data::is_missing(word));
}

TEST_CASE("the words of meters beyond their range are known") {
  for (const std::string word : {"OL", "O.L", "OVL", "-OL", "Over", "OVERLOAD", "over range", "+++++", "inf", "-Inf"})
    CHECK(data::is_overload(word));
  for (const std::string word : {"", "-", "---", "1", "oil", "Error", "<0.01", "old"})
    CHECK_FALSE(data::is_overload(word));
}

TEST_CASE("letters of ASCII are made small, and no byte of another letter changes") {
  CHECK(data::lower_case("X_Columns NO 1.#QNAN") == "x_columns no 1.#qnan");
  const std::string others = "\xc3\x84\xce\xa9 \xc4\xff@[`{";  // in UTF-8 and in Latin-1, and what borders on A to Z
  CHECK(data::lower_case(others) == others);
}
