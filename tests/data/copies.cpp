#include "data/copies.hpp"

#include <catch2/catch.hpp>

using data::copies_of;
using data::RepeatableRow;

TEST_CASE("the resolution of numbers is the last decimal that any of them uses") {
  CHECK(data::resolution({3.0, 40.0}) == 1.0);
  CHECK(data::resolution({3.1, 2.25, 4.0}) == Approx(0.01));
  CHECK(data::resolution({1.0 / 3.0}) == Approx(1e-12));
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

TEST_CASE("there may be no rows") { CHECK(copies_of({}).empty()); }
