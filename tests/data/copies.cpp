#include "data/copies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"

using data::copies_of;
using data::RepeatableRow;

TEST_CASE("the resolution of numbers is the last decimal that any of them uses") {
  CHECK(data::resolution({3.0, 40.0}) == 1.0);
  CHECK(data::resolution({3.1, 2.25, 4.0}) == Approx(0.01));
  CHECK(data::resolution({1.0 / 3.0}) == Approx(1e-12));
}

TEST_CASE("numbers of a meter of few bits have its step, whatever the digits they are written with") {
  CHECK(data::resolution({0.05, 0.15, 0.2, 0.45, 0.8, 1.0}) == Approx(0.05));
  // Twelve bits of 100 mN m, to four decimals.
  std::vector<double> readings;
  for (const double steps : {7.0, 8.0, 11.0, 40.0, 41.0, 300.0, 301.0, 2047.0})
    readings.push_back(std::round(1e4 * steps * 100.0 / 4096.0) / 1e4);
  CHECK(data::resolution(readings) == Approx(100.0 / 4096.0).epsilon(1e-3));
  // Five numbers lie on a grid by chance, and others on none.
  CHECK(data::resolution({0.05, 0.15, 0.2, 0.45, 0.8}) == Approx(0.01));
  CHECK(data::resolution({0.05, 0.15, 0.2, 0.45, 0.8, 1.0, 1.03}) == Approx(0.01));
}

TEST_CASE("replicates of a coarse meter agree by chance") {
  // Steps of 0.05 at an error of 0.06: two readings agree with probability 0.24.
  const std::vector<double> readings{1.00, 1.05, 1.05, 1.10, 0.95, 1.05, 1.10, 1.00, 1.20, 1.15, 1.05, 1.25};
  std::vector<RepeatableRow> rows;
  for (std::size_t i = 0; i < readings.size(); ++i)
    rows.push_back({{static_cast<double>(i / 4)}, {readings[i]}, {0.06}});
  for (const auto& copy : copies_of(rows)) CHECK_FALSE(copy);
}

TEST_CASE("a row that is equal in all digits to a reading of the same point is a copy of the first of them") {
  const std::vector<RepeatableRow> rows{
      {{50.0}, {9.95952}, {0.2}}, {{100.0}, {9.37955}, {0.2}}, {{50.0}, {9.95952}, {0.2}}, {{50.0}, {9.95952}, {0.2}}};
  const auto found = copies_of(rows);
  CHECK_FALSE(found[0]);
  CHECK_FALSE(found[1]);
  CHECK(found[2] == 0u);
  CHECK(found[3] == 0u);
}

TEST_CASE("replicates differ, and readings of another point are no copies whatever they say") {
  CHECK(copies_of({{{50.0}, {9.95}, {0.2}}, {{50.0}, {9.71}, {0.2}}}) ==
        std::vector<std::optional<std::size_t>>(2, std::nullopt));
  CHECK(copies_of({{{50.0}, {9.95952}, {0.2}}, {{60.0}, {9.95952}, {0.2}}}) ==
        std::vector<std::optional<std::size_t>>(2, std::nullopt));
  CHECK(copies_of({{{50.0}, {9.95952}, {0.2}}, {{50.0}, {9.95952}, {0.3}}}) ==
        std::vector<std::optional<std::size_t>>(2, std::nullopt));
}

TEST_CASE("coarse readings that agree now and then are chance, and the same readings pasted ten times are not") {
  // To 0.1 with an error of 0.2 two readings agree with probability 0.14.
  std::vector<RepeatableRow> rows{{{50.0}, {9.9}, {0.2}}, {{50.0}, {9.9}, {0.2}}, {{50.0}, {9.7}, {0.2}}};
  CHECK_FALSE(copies_of(rows)[1]);
  for (int i = 0; i < 9; ++i) rows.push_back(rows.front());
  CHECK(copies_of(rows)[1] == 0u);
}

TEST_CASE("samples that scatter less than their errors say agree by chance more often, and pasted ones still do not") {
  // 200 samples at each of six points, to three decimals, of scatter 0.05 where 0.5 is stated: 20,000 pairs a point, of
  // which 0.6 % agree.
  data::RandomStream random(11, data::Purpose::test, 0);
  std::vector<RepeatableRow> rows;
  for (int i = 0; i < 1200; ++i) {
    const double reading = 9.0 + 0.05 * random.normal();
    rows.push_back({{50.0 * (i % 6)}, {std::round(1e3 * reading) / 1e3}, {0.5}});
  }
  for (const auto& copy : copies_of(rows)) CHECK_FALSE(copy);
  const std::vector<RepeatableRow> once(rows.begin(), rows.begin() + 120);
  std::vector<RepeatableRow> pasted;
  for (int i = 0; i < 10; ++i) pasted.insert(pasted.end(), once.begin(), once.end());
  CHECK(copies_of(pasted)[120] == 0u);
}

TEST_CASE("there may be no rows") { CHECK(copies_of({}).empty()); }
