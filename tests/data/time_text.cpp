#include "data/time_text.hpp"

#include <catch2/catch.hpp>

TEST_CASE("times of day and dates are read as loggers stamp them") {
  const auto seconds = [](const std::string& text) {
    const auto time = data::read_time(text);
    return time ? time->seconds : -1.0;
  };
  constexpr double midnight = 1714694400.0;  // 2024-05-03, midnight, by date -u -d 2024-05-03 +%s
  CHECK(seconds("14:02:00") == 50520.0);
  CHECK(seconds("14:02:00.5") == 50520.5);
  CHECK(seconds("14:02:00,25") == 50520.25);
  CHECK(seconds("2:02:00 PM") == 50520.0);
  CHECK(seconds("12:00:00 AM") == 0.0);
  CHECK(seconds("14:02:00:500") == 50520.5);
  CHECK(seconds("2:02:00 p.m.") == 50520.0);
  CHECK(seconds("02:35.5") == 155.5);       // minutes and seconds
  CHECK(seconds("140:00:00") == 504000.0);  // a duration
  for (const char* none : {"2024-05-03 140:00:00", "2024-05-03 24:01:00", "20240503T240100", "2024-05-03 25:00:00"})
    CHECK(seconds(none) == -1.0);
  CHECK(seconds("2024-05-03 24:00:00") == midnight + 86400.0);
  for (const std::string text :
       {"2024-05-03 14:02:00", "2024-05-03T14:02:00Z", "2024/05/03 14:02:00", "03.05.2024 14:02:00",
        "3-May-2024 14:02:00", "03 Mai 2024 14:02", "May 3, 2024 2:02:00 PM", "20240503T140200", "20240503 140200.0",
        "2024-05-03 14:02:00 UTC", "2024-05-03T16:02:00+02:00", "2024-05-03T10:02:00-0400", "03.05.24 14:02:00"})
    CHECK(seconds(text) == midnight + 50520.0);
  // A day and a month that only other dates beside them tell apart.
  CHECK(data::read_time("03/05/2024 14:02:00")->day_or_month);
  CHECK(data::read_time("03/05/2024 14:02:00", data::DateOrder::day_first)->seconds == midnight + 50520.0);
  CHECK(data::read_time("05/03/2024 14:02:00", data::DateOrder::month_first)->seconds == midnight + 50520.0);
  CHECK(data::read_time("31/05/2024 14:02:00")->order == data::DateOrder::day_first);
  CHECK(data::read_time("05/31/2024 14:02:00")->order == data::DateOrder::month_first);
  // May 3, 2024 is the Friday of week 18 and day 124, by date -d 2024-05-03 +'%G-W%V-%u %j'.
  for (const std::string text :
       {"2024-W18-5T14:02:00", "2024W185 14:02:00", "2024-124T14:02:00", "2024-05-03 15:02:00 CET",
        "2024-05-03 16:02:00 CEST", "03.05.2024 16:02:00 MESZ", "03.05.2024 14:02:00 Uhr",
        "2024-05-03T16:02:00+02:00[Europe/Berlin]", "2024-05-03 23:02:00 JST"})
    CHECK(seconds(text) == midnight + 50520.0);
  // By date -d 2021-01-03 +%G-W%V-%u, and of a leap year.
  CHECK(seconds("2020-W53-7 00:00:00") == seconds("2021-01-03 00:00:00"));
  CHECK(seconds("2024-366T00:00:00") == seconds("2024-12-31 00:00:00"));
  for (const std::string none : {"2024-W54-1 14:02:00", "2024-W18-8 14:02:00", "2023-366T14:02:00", "2024-000T14:02:00",
                                 "14:02:00 BST", "14:02:00 CST"})
    CHECK_FALSE(data::read_time(none));
  CHECK(seconds("05/31/2024 00:00:01") == seconds("2024-05-31 00:00:01"));
  CHECK(seconds("31/05/2024 00:00:01") == seconds("2024-05-31 00:00:01"));
  CHECK(data::read_time("03/05/2024 14:02:00")->day_or_month);
  CHECK(data::read_time("14:02")->two_parts);
  CHECK_FALSE(data::read_time("2024-05-03 14:02")->two_parts);
  for (const std::string none :
       {"", "14", "14:60", "14:02:61", "a:b", "2024-13-03 14:02:00", "1:2:3:4", "14:02:00 x", "1.5", "14:02:00:5",
        "20241303T140200", "20240503T146200", "1234567890123456", "13-Foo-2024 10:00", "99999999 999999"})
    CHECK_FALSE(data::read_time(none));
}
