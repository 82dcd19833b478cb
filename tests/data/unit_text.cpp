#include "data/unit_text.hpp"

#include <catch2/catch.hpp>
#include <numbers>

TEST_CASE("units as they are spelled on instruments mean what they can only mean") {
  const auto factor = [](const std::string& text, const std::string& dimension) {
    const auto unit = data::unit_meant(text, dimension);
    return unit ? unit->factor : 0.0;
  };
  for (const std::string text : {"Nm", "N m", "N\xc2\xb7m", "N.m", "N*m", "N\xe2\x8b\x85m"})
    CHECK(factor(text, "N m") == Approx(1.0));
  for (const std::string text : {"mNm", "mN m", "mN\xc2\xb7m", "mN.m", "mN\xe3\x83\xbbm"})
    CHECK(factor(text, "N m") == Approx(1e-3));
  for (const std::string text : {"Н·м", "Н м", "牛·米", "牛米"}) CHECK(factor(text, "N m") == Approx(1.0));
  for (const std::string text : {"мН·м", "毫牛米"}) CHECK(factor(text, "N m") == Approx(1e-3));
  for (const std::string text : {"об/мин", "转/分", "转/分钟", "回転/分", "회/분"})
    CHECK(factor(text, "rpm") == Approx(std::numbers::pi / 30.0));
  for (const std::string text : {"с", "сек", "秒", "초"}) CHECK(factor(text, "s") == Approx(1.0));
  for (const std::string text : {"мин", "分", "分钟"}) CHECK(factor(text, "s") == Approx(60.0));
  for (const std::string text : {"uNm", "\xc2\xb5Nm", "\xc2\xb5N\xc2\xb7m", "\xce\xbcN m"})
    CHECK(factor(text, "N m") == Approx(1e-6));
  for (const std::string text : {"Ncm", "N cm",
                                 "N\xc2\xb7"
                                 "cm"})
    CHECK(factor(text, "N m") == Approx(1e-2));
  for (const std::string text : {"kgf cm", "kgfcm",
                                 "kgf\xc2\xb7"
                                 "cm",
                                 "kp cm"})
    CHECK(factor(text, "N m") == Approx(9.80665e-2));
  for (const std::string text : {"kg cm", "kgcm"}) CHECK(factor(text, "N m") == Approx(9.80665e-2));
  for (const std::string text : {"deg", "Deg", "degree", "\xc2\xb0"})
    CHECK(factor(text, "degree") == Approx(factor("degree", "degree")));
  CHECK(factor("deg", "N m") == 0.0);
  CHECK(factor("gf cm", "N m") == Approx(9.80665e-5));
  CHECK(factor("dyn cm", "N m") == Approx(1e-7));
  for (const std::string text : {"lb in", "lb-in", "lbf in", "in-lb", "in lb", "in\xc2\xb7lb", "in-lbf"})
    CHECK(factor(text, "N m") == Approx(0.1129848).epsilon(1e-6));
  for (const std::string text : {"ft lb", "ft-lb", "lb-ft", "ft\xc2\xb7lbf"})
    CHECK(factor(text, "N m") == Approx(1.3558179).epsilon(1e-6));
  for (const std::string text : {"oz-in", "ounce-inch"})
    CHECK(factor(text, "N m") == Approx(7.0615518e-3).epsilon(1e-6));
  for (const std::string text : {"in-lbs", "lbs in", "inch-pounds"})
    CHECK(factor(text, "N m") == Approx(0.1129848).epsilon(1e-6));
  for (const std::string text : {"ft-lbs", "foot-pounds"})
    CHECK(factor(text, "N m") == Approx(1.3558179).epsilon(1e-6));
  for (const std::string text : {"N\xc3\x97m", "NM", "N.M", "Newtonmeter", "Newton-Meter", "newton metres"})
    CHECK(factor(text, "N m") == Approx(1.0));
  CHECK(factor("dNm", "N m") == Approx(0.1));
  CHECK(factor("daNm", "N m") == Approx(10.0));
  CHECK(factor("mN\xc3\x97m", "N m") == Approx(1e-3));
  for (const std::string text : {"g cm",
                                 "g\xc2\xb7"
                                 "cm",
                                 "gcm", "g-cm"})
    CHECK(factor(text, "N m") == Approx(9.80665e-5));
  // Superscripts: mJ m^-2, g s^-2, cm^2.
  for (const std::string text :
       {"mJ\xc2\xb7m\xe2\x81\xbb\xc2\xb2", "mJ m\xe2\x81\xbb\xc2\xb2", "g s\xe2\x81\xbb\xc2\xb2"})
    CHECK(factor(text, "mJ/m2") == Approx(1e-3));
  CHECK(factor("cm\xc2\xb2", "m2") == Approx(1e-4));
  for (const std::string text :
       {"rpm", "RPM", "1/min", "min-1", "min^-1", "min\xe2\x81\xbb\xc2\xb9", "U/min", "r/min", "rev/min", "Upm"})
    CHECK(factor(text, "rpm") == Approx(std::numbers::pi / 30.0));
  for (const std::string text : {"Hz", "1/s", "s-1", "rps", "U/s"})
    CHECK(factor(text, "rpm") == Approx(2.0 * std::numbers::pi));
  for (const std::string text : {"tr/min", "tours/min", "revs/min", "U/Min."})
    CHECK(factor(text, "rpm") == Approx(std::numbers::pi / 30.0));
  CHECK(factor("kHz", "rpm") == Approx(2000.0 * std::numbers::pi));
  CHECK(factor("mHz", "rpm") == Approx(0.002 * std::numbers::pi));
  CHECK(factor("deg/s", "rpm") == Approx(std::numbers::pi / 180.0));
  CHECK(factor("rad/s", "rpm") == Approx(1.0));
  CHECK(factor("ms", "s") == Approx(1e-3));
  CHECK(factor("sec", "s") == Approx(1.0));
  for (const std::string text : {"min", "mins", "min.", "Minutes"}) CHECK(factor(text, "s") == Approx(60.0));
  for (const std::string text : {"h", "hrs", "hr"}) CHECK(factor(text, "s") == Approx(3600.0));
  for (const std::string text : {"N", "kg", "furlong pints", "", "%", "gm", "nm", "mnm", "MHz"})
    CHECK_FALSE(data::unit_meant(text, "N m"));
  CHECK_FALSE(data::unit_meant("Hz", "s"));
  CHECK_FALSE(data::unit_meant("1/min", "N m"));
}

TEST_CASE("a heading is a name and a unit in brackets, in parentheses, after a slash or a comma") {
  const auto split = [](const std::string& text) {
    const data::Heading heading = data::read_heading(text);
    return heading.name + "|" + heading.unit;
  };
  CHECK(split("Torque [mN m]") == "Torque|mN m");
  CHECK(split("Torque (mNm)") == "Torque|mNm");
  CHECK(split("torque / mN m") == "torque|mN m");
  CHECK(split("torque/mNm") == "torque|mNm");
  CHECK(split("Torque, mNm") == "Torque|mNm");
  CHECK(split("speed / 1/min") == "speed|1/min");
  CHECK(split("n in rpm") == "n in rpm|");
  CHECK(split("Torque {Nm}") == "Torque|Nm");
  CHECK(split("n / (1/min)") == "n|1/min");
  CHECK(split("omega/(rad/s)") == "omega|rad/s");
  CHECK(split("M/(mN m)") == "M|mN m");
  CHECK(split("f/(x)") == "f/(x)|");
  CHECK(split("Time (hh:mm:ss)") == "Time|hh:mm:ss");
  CHECK(split("torque [banana]") == "torque|banana");  // refused where the unit is needed
  CHECK(split("torque (mean)") == "torque (mean)|");
  CHECK(split("run (2)") == "run (2)|");
  CHECK(split("torque") == "torque|");
  CHECK(split("") == "|");
}

TEST_CASE("a unit at the end of a heading is one where it measures what is looked for") {
  const auto split = [](const std::string& text, const std::string& dimension) {
    const auto heading = data::heading_with_unit(text, dimension);
    return heading ? heading->name + "|" + heading->unit : std::string();
  };
  CHECK(split("Torque_Nm", "N m") == "Torque|Nm");
  CHECK(split("Torque in Nm", "N m") == "Torque|Nm");
  CHECK(split("n in 1/min", "rpm") == "n|1/min");
  CHECK(split("Time s", "s") == "Time|s");
  CHECK(split("Time <s>", "s") == "Time|s");
  CHECK(split("torque_se", "N m").empty());
  CHECK(split("Torque_Nm", "s").empty());
}
