// Logs as loggers write them, those of shared cases among them (tests/data/files).
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numbers>

#include "data/log_faults.hpp"
#include "data/log_times.hpp"
#include "data/random.hpp"
#include "data/torque_log.hpp"
#include "tests/temporary.hpp"

using Catch::Contains;

namespace {

constexpr double rpm = std::numbers::pi / 30.0;

std::string file(const std::string& name) { return std::string(DEMCAL_SOURCE_DIR) + "/tests/data/files/" + name; }

std::vector<data::Plateau> plateaus_of(const std::string& name) {
  return data::find_plateaus(data::read_torque_log(file(name)));
}

std::string refusal(const std::string& text, const data::LogColumns& columns = {}) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] { data::read_torque_log(folder.write("log.csv", text), columns); });
}

data::TorqueLog log_of(const std::string& text, const data::LogColumns& columns = {}) {
  const TemporaryFolder folder;
  return data::read_torque_log(folder.write("log.csv", text), columns);
}

/// 60 s at 100 rpm, ten samples a second: 3 mN m with noise; `change` alters a sample.
template <class Change>
data::TorqueLog made(Change change) {
  data::RandomStream random(5, data::Purpose::test);
  std::string text = "time [s],torque [mN m],rpm\n";
  for (int i = 0; i < 600; ++i)
    text += fmt::format("{:.1f},{:.4f},100\n", 0.1 * i, change(i, 3.0 + 0.05 * random.normal()));
  return log_of(text);
}

std::vector<std::string> faults_of(const data::TorqueLog& log) {
  std::vector<std::string> words;
  for (const data::Plateau& plateau : data::find_plateaus(log))
    for (const std::string& fault : data::plateau_faults(log, plateau)) words.push_back(fault);
  return words;
}

}  // namespace

TEST_CASE("ISO times, stamps of whole seconds and a midnight give the means of the log they were made from") {
  for (const std::string name : {"d04-iso-time.csv", "d06-one-second-stamps.csv", "d07-midnight.csv"}) {
    INFO(name);
    const std::vector<data::Plateau> plateaus = plateaus_of(name);
    REQUIRE(plateaus.size() == 3);
    const double speeds[] = {50.0, 100.0, 150.0}, torques[] = {2.5, 3.0, 3.5};
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(plateaus[i].speed == Approx(speeds[i] * rpm).epsilon(1e-3));
      CHECK(std::abs(1e3 * plateaus[i].torque.mean - torques[i]) < 4e3 * plateaus[i].torque.standard_error);
    }
  }
  CHECK(data::read_torque_log(file("d06-one-second-stamps.csv")).interval == Approx(0.1).epsilon(0.01));
  CHECK(data::read_torque_log(file("d04-iso-time.csv")).interval == Approx(0.1).epsilon(1e-3));
  data::LogColumns at_rate;
  at_rate.rate = 10.0;
  CHECK(data::read_torque_log(file("d06-one-second-stamps.csv"), at_rate).interval == Approx(0.1));
}

TEST_CASE("a slow ramp is no plateau, saturation and codes are found, drop-outs do not count") {
  CHECK(plateaus_of("d12-slow-ramp.csv").empty());
  const data::TorqueLog saturated = data::read_torque_log(file("d08-saturated.csv"));
  const std::vector<data::Plateau> three = data::find_plateaus(saturated);
  REQUIRE(three.size() == 3);
  CHECK_FALSE(data::saturated_at(saturated, three[0]).has_value());
  CHECK(data::saturated_at(saturated, three[2]).has_value());
  data::TorqueLog codes = data::read_torque_log(file("d10-sentinels.csv"));
  CHECK(data::remove_no_values(codes) ==
        std::vector<std::string>{
            "4 samples with a torque of 9999 mN m, which looks like a code for 'no value', are left out"});
  CHECK(data::find_plateaus(codes)[2].torque.mean == Approx(3.5e-3).epsilon(0.01));
  data::TorqueLog zeros = data::read_torque_log(file("d11-zero-dropouts.csv"));
  CHECK(data::remove_no_values(zeros).size() == 1);
  CHECK(data::find_plateaus(zeros)[1].torque.mean == Approx(3.0e-3).epsilon(0.01));
}

TEST_CASE("a good log has no faults, and each fault is named") {
  CHECK(faults_of(made([](int, double torque) { return torque; })).empty());
  data::TorqueLog good = made([](int, double torque) { return torque; });
  CHECK(data::remove_no_values(good).empty());
  const auto named = [](const data::TorqueLog& log, const std::string& what) {
    const std::vector<std::string> words = faults_of(log);
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& one) { return one.find(what) != std::string::npos; });
  };
  CHECK(named(made([](int, double torque) { return std::min(torque, 3.03); }),
              "clipped there, so its mean is too small"));
  CHECK(named(made([](int, double torque) { return std::max(torque, 2.97); }),
              "clipped there, so its mean is too large"));
  CHECK(named(made([](int, double torque) { return 0.1 * std::round(10.0 * torque); }), "the logger's resolution"));
  CHECK(named(made([](int i, double torque) { return i % 150 == 75 ? 40.0 : torque; }), "spikes, the largest 40 mN m"));
  CHECK(named(made([](int i, double torque) { return torque + 0.001 * i; }), "drifts"));
  CHECK(named(made([](int i, double torque) { return i >= 300 && i < 400 ? 3.05 : torque; }),
              "the torque stays at 3.05 mN m from 30 to 39.9 s, 17 % of the samples"));
  CHECK_FALSE(named(made([](int, double torque) { return 0.05 * std::round(20.0 * torque); }), "stays at"));
  double held = 0.0;  // a logger that repeats each sample ten times
  CHECK_FALSE(named(made([&](int i, double torque) { return i % 10 == 0 ? held = torque : held; }), "stays at"));
  data::TorqueLog negative = made([](int i, double torque) { return i % 100 == 3 ? -999.0 : torque; });
  CHECK(data::remove_no_values(negative).size() == 1);
  CHECK(negative.time.size() == 594);
}

TEST_CASE("an early spike is named and leaves nothing else out, and what is left out at length is said") {
  const data::TorqueLog spiked = made([](int i, double torque) { return i == 150 ? 15.0 : torque; });
  const std::vector<data::Plateau> plateaus = data::find_plateaus(spiked);
  REQUIRE(plateaus.size() == 1);
  CHECK(plateaus[0].used_from == 0);
  CHECK(data::plateau_notes(spiked, plateaus[0]).empty());
  const std::vector<std::string> faults = data::plateau_faults(spiked, plateaus[0]);
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].find("1 spike, 15 mN m at 15 s, counts in the mean 3.0") != std::string::npos);
  CHECK(faults[0].find("--without-spikes") != std::string::npos);

  const std::vector<data::Plateau> without = data::find_plateaus(spiked, {.spikes_count = false});
  CHECK(without[0].torque.mean == Approx(3e-3).epsilon(0.003));
  CHECK(data::plateau_faults(spiked, without[0]).empty());
  REQUIRE(data::plateau_notes(spiked, without[0]).size() == 1);
  CHECK(data::plateau_notes(spiked, without[0])[0].find("1 spike, 15 mN m at 15 s, left out of the mean") !=
        std::string::npos);

  const data::TorqueLog slow = made([](int i, double torque) { return i < 200 ? torque + 0.5 : torque; });
  const std::vector<std::string> notes = data::plateau_notes(slow, data::find_plateaus(slow)[0]);
  REQUIRE(notes.size() == 1);
  INFO(notes[0]);
  CHECK(notes[0].find("s of 59.9 s are left out as start-up, as the torque is 3.") != std::string::npos);
}

TEST_CASE("a torque that is truly 9999 or zero stays") {
  data::TorqueLog log = log_of("time,torque [uN m],rpm\n0,9990,50\n1,9999,50\n2,10010,50\n3,9995,50\n4,0,0\n5,0,0\n");
  CHECK(data::remove_no_values(log).empty());
}

TEST_CASE("columns are found by their usual names, in several languages and units") {
  const data::TorqueLog log = log_of("Zeit;Drehmoment [mNm];Drehzahl [1/min]\n0,0;2,5;60\n0,5;2,6;60\n");
  CHECK(log.torque[0] == Approx(2.5e-3));
  CHECK(log.torque[1] == Approx(2.6e-3));
  CHECK(log.time == std::vector<double>{0.0, 0.5});
  CHECK(log.speed[0] == Approx(60.0 * rpm));
  CHECK(log_of("Time [ms],Torque [Ncm],Speed [Hz]\n0,1,2\n100,1,2\n").speed[0] == Approx(120.0 * rpm));
  CHECK(log_of("Time [ms],Torque [Ncm],Speed [Hz]\n0,1,2\n100,1,2\n").time[1] == Approx(0.1));
  CHECK(refusal("time,torque [Nm],speed,drehzahl\n0,1,1,1\n1,1,1,1\n")
            .find("both 'speed' and 'drehzahl' may be the column 'rpm'") != std::string::npos);
  for (const std::string heading :
       {"Time_s,Torque_Nm,Speed_rpm", "t in s,M in Nm,n in 1/min", "Time {s},Torque {Nm},Speed {rpm}",
        "t / s,M / Nm,n / (1/min)", "Temps [s],Couple [N.m],Vitesse [tr/min]", "t [s],M [Nm],omega [rpm]"}) {
    INFO(heading);
    const data::TorqueLog read = log_of(heading + "\n0,2,60\n3,2,60\n");
    CHECK(read.time[1] == 3.0);
    CHECK(read.torque[0] == Approx(2.0));
    CHECK(read.speed[0] == Approx(60.0 * rpm));
    CHECK(read.notes.empty());
  }
  CHECK(log_of("time [s],torque [oz-in],rpm\n0,2,60\n3,2,60\n").torque_unit.symbol == "oz-in");
  CHECK(log_of("Time (hh:mm:ss),torque [Nm],rpm\n00:00:01,2,60\n00:00:02,2,60\n").time[1] == 1.0);
  data::LogColumns constant;
  constant.constant_speed = 50.0 * rpm;
  CHECK(log_of("time,torque [Nm]\n0,1\n1,1\n", constant).speed[1] == Approx(50.0 * rpm));
}

TEST_CASE("columns of names unknown are found where they alone have a unit of the quantity, and that is said") {
  const data::TorqueLog log =
      log_of("Laufzeit [s];Motorwelle [mN m];Antrieb [1/min];Energie [J];Scherrate [1/s]\n0;5;100;1;2\n1;6;100;2;3\n");
  CHECK(log.torque == std::vector<double>{5e-3, 6e-3});
  CHECK(log.speed[0] == Approx(100.0 * rpm));
  for (const char* took :
       {"'Laufzeit [s]' as the time", "'Motorwelle [mN m]' as the torque", "'Antrieb [1/min]' as the speed"})
    CHECK(std::any_of(log.took.begin(), log.took.end(), [&](const std::string& one) { return one.starts_with(took); }));
  // Two of them are asked back; a shear rate is no speed, and a name that is given must be there.
  CHECK_THAT(refusal("time [s],set [N m],read [N m],rpm\n0,1,2,3\n1,1,2,3\n"),
             Contains("'torque' is missing") && Contains("'set [N m]' and 'read [N m]' are in a unit of it"));
  CHECK_THAT(refusal("time [s],torque [N m],rate [1/s]\n0,1,2\n1,1,2\n"), Contains("'rpm' is missing"));
  data::LogColumns named;
  named.torque.name = "shaft";
  named.torque.also.clear();
  CHECK_THAT(refusal("time [s],motor [N m],rpm\n0,1,2\n1,1,2\n", named), Contains("'shaft' is missing"));
}

TEST_CASE("a unit in a heading holds however its column is found, by its name, by the command line or by the unit") {
  const std::string rows = "\n0,2000,0.8\n100,2010,0.8\n200,2005,0.8\n";
  const auto first_of = [&](const std::string& heading, const char* time, const char* torque, const char* speed) {
    data::LogColumns columns;
    const auto name = [](data::LogColumn& column, const char* given) {
      if (given == nullptr) return;
      column.name = given;
      column.also.clear();
    };
    name(columns.time, time);
    name(columns.torque, torque);
    name(columns.speed, speed);
    const data::TorqueLog log = log_of(heading + rows, columns);
    CHECK(log.time[1] == Approx(0.1));
    CHECK(log.torque[0] == Approx(2.0));
    return log.speed[0];
  };
  constexpr double hertz = 2.0 * std::numbers::pi;
  CHECK(first_of("t_ms,torque_mNm,speed_Hz", nullptr, nullptr, nullptr) == Approx(0.8 * hertz));
  CHECK(first_of("t_ms,torque_mNm,speed_Hz", "t_ms", "torque_mNm", "speed_Hz") == Approx(0.8 * hertz));
  CHECK(first_of("t_ms,torque_mNm,speed_rad_s", nullptr, nullptr, nullptr) == Approx(0.8));
  CHECK(first_of("t_ms,drive_torque_mNm,drum_speed_rad_s", nullptr, nullptr, nullptr) == Approx(0.8));
  CHECK(first_of("t_ms,torque_mN_m,omega_rad_per_s", nullptr, nullptr, "omega_rad_per_s") == Approx(0.8));
  CHECK(first_of("t_ms,torque_mNm,speed in rad/s", nullptr, nullptr, "speed in rad/s") == Approx(0.8));
  const data::TorqueLog bare = log_of("time [ms],torque [mN m],omega" + rows);
  CHECK(bare.speed[0] == Approx(0.8 * rpm));
  REQUIRE_FALSE(bare.notes.empty());
  CHECK_THAT(bare.notes.back(), Contains("'omega' has no unit, and is taken as rpm"));
}

TEST_CASE("a unit behind every number is that of the column, signs may stand apart, and no end is too much") {
  const data::TorqueLog log = log_of(
      "Time,Torque [N m],rpm\n0 sec,+  1.5,100\n0.1 sec,-  0.5,100\n0.2 sec,\xe2\x88\x9e,100\n0.3 sec,1.0,100\n");
  REQUIRE(log.time.size() == 3);
  CHECK(log.time[1] == Approx(0.1));
  CHECK(log.torque[0] == 1.5);
  CHECK(log.torque[1] == -0.5);
  CHECK(log.missing == 1);
  CHECK_THAT(fmt::format("{}", fmt::join(log.took, ", ")), Contains("'Time' in sec, which every cell says"));
  REQUIRE(log.warnings.size() == 1);
  CHECK_THAT(log.warnings[0], Contains("beyond its range"));
  CHECK_THAT(refusal("Time,Torque [N m],rpm\n0 sec,1,100\n0.1 min,1,100\n"), Contains("'0 sec' is not a number"));
}

TEST_CASE("samples that a log itself calls bad are left out, and that is said") {
  const std::string rows = "\n0;1,0;GOOD;100;GOOD\n1;9,9;BAD;100;GOOD\n2;1,2;GOOD;7;Uncertain\n3;1,1;GOOD;100;GOOD\n";
  const data::TorqueLog log = log_of("time [s];torque [N m];Torque_Quality;rpm;Speed_Quality" + rows);
  CHECK(log.torque == std::vector<double>{1.0, 1.1});
  CHECK(log.missing == 0);
  REQUIRE(log.notes.size() == 2);
  CHECK_THAT(log.notes[0], Contains("Torque_Quality says 'BAD' (1)") && Contains("the first in line 3"));
  // Another tag's quality is none of ours, and a status of another kind is no quality.
  CHECK(log_of(
            "time [s];torque [N m];rpm;Flow;Flow_Quality;x;X_Quality\n0;1,0;100;5;GOOD;1;GOOD\n1;1,5;100;5;BAD;1;BAD\n")
            .torque.size() == 2);
  CHECK(log_of("time [s],torque [N m],rpm,status\n0,1,100,ramp\n1,1,100,hold\n").torque.size() == 2);
  CHECK(log_of("time [s],torque [N m],rpm,status\n0,1,100,OK\n1,1,100,BAD\n2,1,100,OK\n").torque.size() == 2);
}

TEST_CASE("a row for each value of each channel is a log whose rows are those of the torque") {
  const data::TorqueLog log = log_of(
      "Tag,Timestamp,Value,Unit\nMixer.Speed,0,100,rpm\nMixer.Torque,1,0.5,N m\nMixer.Torque,2,0.6,N m\n"
      "Mixer.Speed,2.5,200,rpm\nPump.Flow,2.6,3,l/h\nMixer.Torque,3,0.7,N m\n");
  CHECK(log.time == std::vector{1.0, 2.0, 3.0});
  CHECK(log.torque == std::vector{0.5, 0.6, 0.7});
  CHECK(log.speed[1] == Approx(100.0 * std::numbers::pi / 30.0));  // as last written
  CHECK(log.speed[2] == Approx(200.0 * std::numbers::pi / 30.0));
  CHECK_THAT(log.took.front(), Contains("3 channels as columns") && Contains("'Mixer.Torque'"));
  // One channel behind the other: of two values at one time each counts from there on.
  CHECK(log_of("name,time,value\ntorque_Nm,0,1\ntorque_Nm,1,2\nrpm,0,100\nrpm,1,200\n").speed ==
        log_of("time,torque_Nm,rpm\n0,1,100\n1,2,200\n").speed);
  // A table with a torque is none of these, whatever else it has, and the channels are named where none is the torque.
  CHECK(log_of("name,value,time,torque_Nm,rpm\na,7,0,1,100\nb,8,1,2,100\n").torque == std::vector{1.0, 2.0});
  CHECK_THROWS_WITH(log_of("name,time,value\nM1,0,1\nM1,1,2\nM2,0,100\nM2,1,200\n"),
                    Contains("M1, M2") && Contains("--torque"));
}

TEST_CASE("an instrument's export of one section a hold is one log") {
  std::string text = "Filename\tpowder\nOperator\tA\n";
  for (int hold = 0; hold < 3; ++hold) {
    text += fmt::format("[step]\nPeak hold - {}\nTime\tTorque\tVelocity\tTime\ns\tmN.m\trad/s\ts\n", hold + 1);
    for (int i = 0; i < 10 * (3 - hold); ++i) {
      const double time = 100.0 * hold + i;
      text += fmt::format("{:.1f}\t{:.1f}\t5.25\t{:.1f}\n", time, 1.0 + hold, time);
    }
    text += "\n";
  }
  const data::TorqueLog log = log_of(text);
  CHECK(log.time.size() == 60);
  CHECK(log.torque.back() == Approx(3e-3));
  CHECK(log.speed.front() == Approx(5.25));
}

TEST_CASE("sections whose time begins again follow each other") {
  std::string text = "time [s],torque [mN m],rpm\n";
  for (int hold = 0; hold < 3; ++hold) {
    if (hold > 0) text += "time [s],torque [mN m],rpm\n";
    for (int i = 0; i < 40; ++i) text += fmt::format("{},{},{}\n", 0.5 * i, 1 + hold, 50 * (1 + hold));
  }
  const data::TorqueLog log = log_of(text);
  REQUIRE(log.time.size() == 120);
  for (std::size_t i = 0; i < log.time.size(); ++i) CHECK(log.time[i] == Approx(0.5 * static_cast<double>(i)));
  CHECK_THAT(fmt::format("{}", fmt::join(log.took, "; ")), Catch::Contains("begins again with each heading"));
  // Without a heading between them it may be a log that was started again, or a clock set back.
  CHECK(refusal("time [s],torque [mN m],rpm\n0,1,50\n1,1,50\n0,1,50\n").find("does not come after") !=
        std::string::npos);
}

TEST_CASE("a tachometer that counts in coarse steps is named, wanted speeds are not") {
  const auto with_speeds = [](auto speed) {
    data::RandomStream random(5, data::Purpose::test);
    std::string text = "time [s],torque [mN m],rpm\n";
    for (int i = 0; i < 900; ++i)
      text += fmt::format("{:.1f},{:.4f},{}\n", 0.1 * i, 3.0 + 0.05 * random.normal(), speed(i));
    return log_of(text);
  };
  const auto ramp = [](int i) {
    return i % 300 < 40 ? 50 * (i / 300) + 50.0 * (i % 300) / 40.0 : 50.0 * (1 + i / 300);
  };
  const data::TorqueLog coarse = with_speeds([&](int i) { return 6 * std::floor(ramp(i) / 6.0); });
  const std::vector<std::string> words = faults_of(coarse);
  REQUIRE(words.size() == 3);
  CHECK_THAT(words.front(), Catch::Contains("steps of 6 rpm"));
  for (const data::Plateau& plateau : data::find_plateaus(coarse))
    CHECK(plateau.speed_sd == Approx(6.0 * M_PI / 30.0 / std::sqrt(12.0)).epsilon(0.01));
  CHECK(faults_of(with_speeds([](int i) { return 50 * (1 + i / 300); })).empty());
  CHECK(faults_of(with_speeds([&](int i) { return 0.1 * std::round(10.0 * ramp(i)); })).empty());
}

TEST_CASE("times that can be read in two ways are asked back") {
  CHECK(refusal("time,torque [Nm],rpm\n14:02,1,1\n14:03,1,1\n")
            .find("'14:02' may be hours and minutes, or minutes and seconds") != std::string::npos);
  CHECK(refusal("time,torque [Nm],rpm\n45415.584722,1,1\n45415.584723,1,1\n45415.584724,1,1\n")
            .find("looks like a spreadsheet's day") != std::string::npos);
  CHECK(refusal("time,torque [Nm],rpm\n14:02:01,1,1\n7,1,1\n").find("'7' is no time like those before") !=
        std::string::npos);
}

TEST_CASE("times without a unit are seconds where they can be, and that is said") {
  const auto log = [](double first, double step) {
    std::string text = "time,torque [Nm],rpm\n";
    for (int i = 0; i < 6; ++i) text += fmt::format("{:.9f},1,1\n", first + step * i);
    return text;
  };
  REQUIRE(log_of(log(0.0, 10.0)).notes.size() == 1);
  CHECK(
      log_of(log(0.0, 10.0)).notes[0].find("time taken as s, as nothing states its unit: 6 samples every 10 s, 50 s") ==
      0);
  CHECK(log_of("time [s],torque [Nm],rpm\n0,1,1\n1,1,1\n2,1,1\n").notes.empty());
  CHECK(log_of("time,torque [Nm],rpm\n14:00:00,1,1\n14:00:01,1,1\n14:00:02,1,1\n").notes.empty());
  data::LogColumns in_days;
  in_days.time.unit = "d";
  CHECK(log_of(log(739375.58, 1e-5), in_days).notes.empty());
  CHECK(refusal(log(0.0, 1000.0))
            .find("65: log.csv:2: time: has no unit, and taken as seconds the samples lie 1e+03 s apart") == 0);
  CHECK(refusal(log(0.0, 1000.0)).find("--time-unit s, ms, min or d") != std::string::npos);
  CHECK(refusal(log(0.58, 1e-7)).find("less than 1e-6 s") != std::string::npos);         // a day's share
  CHECK(refusal(log(739375.58, 1.2e-7)).find("less than 1e-6 s") != std::string::npos);  // MATLAB's datenum
  CHECK(refusal(log(1714730520000.0, 10.0)).find("too large for the seconds") != std::string::npos);  // ms since 1970
  CHECK(refusal(log(133591041200000000.0, 100000.0)).find("too large for the seconds") !=
        std::string::npos);  // FILETIME
}

TEST_CASE("times of any clock count from the log's first sample") {
  const std::vector<double> expected{0.0, 1.0, 2.0};
  for (const std::string text :
       {"timestamp,torque [Nm],rpm\n1714730520,1,1\n1714730521,1,1\n1714730522,1,1\n",
        "time [ms],torque [Nm],rpm\n1714730520000,1,1\n1714730521000,1,1\n1714730522000,1,1\n",
        "time [s],torque [Nm],rpm\n3797575320,1,1\n3797575321,1,1\n3797575322,1,1\n",
        "time,torque [Nm],rpm\n14:02:00,1,1\n14:02:01,1,1\n14:02:02,1,1\n",
        "time,torque [Nm],rpm\n2024-05-03 14:02:00,1,1\n2024-05-03 14:02:01,1,1\n2024-05-03 14:02:02,1,1\n"}) {
    INFO(text);
    CHECK(log_of(text).time == expected);
  }
  CHECK(log_of("time [s],torque [Nm],rpm\n5,1,1\n6,1,1\n7,1,1\n").time.front() == 5.0);
}

TEST_CASE("days stand in a column of their own beside times of day") {
  const data::TorqueLog log =
      log_of("Date,Time,torque [Nm],rpm\n2024-05-03,23:59:58,1,1\n2024-05-03,23:59:59,1,1\n2024-05-05,00:00:01,1,1\n");
  CHECK(log.time == std::vector<double>{0.0, 1.0, 86403.0});
  CHECK(refusal("Date,Time,torque [Nm],rpm\n2024-05-03,23:59:58,1,1\n2024-13-03,23:59:59,1,1\n")
            .find("65: log.csv:3: Date: '2024-13-03' is no date like those before") == 0);
}

TEST_CASE("a clock that jitters is spread, and a line that is there twice is refused") {
  std::string text = "time [s],torque [mN m],rpm\n";
  const int stamps[] = {0, 1, 2, 3, 4, 5, 7, 7, 8, 9, 10, 12, 12, 13, 14};
  for (int i = 0; i < 15; ++i) text += fmt::format("{:.3f},{:.1f},100\n", 0.001 * stamps[i], 10.0 + 0.1 * i);
  const data::TorqueLog log = log_of(text);
  REQUIRE(log.time.size() == 15);
  for (std::size_t i = 1; i < 15; ++i) CHECK(log.time[i] - log.time[i - 1] == Approx(0.001).epsilon(0.1));
  CHECK(refusal("time [s],torque [mN m],rpm\n0,1,1\n1,1,1\n1,1,1\n2,1,1\n3,1,1\n4,1,1\n5,1,1\n")
            .find("does not come after") != std::string::npos);
}

TEST_CASE("samples that share a stamp before a gap stay near it") {
  std::vector<double> times{0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 5000.0, 5000.0};
  CHECK(data::spread_stamps(times) == "samples that share a stamp spread evenly within it");
  CHECK(times[5] == 2.5);
}

TEST_CASE("a meter's words for no value and for too much are taken for that, and all others are named at once") {
  const std::string head = "time [s],torque [mN m],rpm\n0,1,50\n";
  for (const std::string word : {"#####", "---.--", "?", "NaN"}) {
    const data::TorqueLog log = log_of(head + "1," + word + ",50\n2,1,50\n");
    CHECK(log.missing == 1);
    CHECK(log.warnings.empty());
  }
  for (const std::string word : {"OVL", "OL", "+++++", "Over", "inf"}) {
    const data::TorqueLog log = log_of(head + "1," + word + ",50\n2,1,50\n");
    CHECK(log.time.size() == 2);
    REQUIRE(log.warnings.size() == 1);
    CHECK(log.warnings[0].find("torque: 1 samples that say the meter was beyond its range, '" + word +
                               "' (1), are left out, "
                               "the first in line 3") == 0);
  }
  CHECK(refusal(head + "1,Poor,50\n2,<0.01,50\n3,Poor,50\n") ==
        "65: log.csv:3: torque: 3 fields from here on are no numbers: '<0.01' (1), 'Poor' (2) (write numbers with a "
        "decimal point, and nothing where there is no value)");
  CHECK(refusal(head + "1,low,50\n").find("65: log.csv:3: torque: 'low' is not a number") == 0);
}

TEST_CASE("clocks go on past midnight, and stamps are spread as their order allows") {
  std::vector<double> times{86398.0, 86399.0, 0.0, 1.0};
  CHECK(data::pass_midnight(times, true) == 1);
  CHECK(times == std::vector<double>{86398.0, 86399.0, 86400.0, 86401.0});
  std::vector<double> back{100.0, 101.0, 50.0};
  CHECK(data::pass_midnight(back, false) == 0);
  // True times i * 0.23, cut to whole seconds.
  std::vector<double> stamps, truth;
  for (int i = 0; i < 500; ++i) {
    truth.push_back(0.23 * i);
    stamps.push_back(std::floor(truth.back()));
  }
  CHECK(data::shares_stamps(stamps));
  CHECK_FALSE(data::shares_stamps(truth));
  CHECK(data::spread_stamps(stamps).find("spread evenly, 0.23") != std::string::npos);
  for (std::size_t i = 1; i < stamps.size(); ++i) CHECK(stamps[i] - stamps[i - 1] == Approx(0.23).epsilon(0.01));
  CHECK(std::abs(stamps[250] - truth[250]) < 0.3);
}

TEST_CASE("a standstill of 200,000 samples is no plateau") {
  // Were the search quadratic, the test would run into its time limit.
  data::TorqueLog log{.file = "log.csv"};
  log.interval = 0.001;
  for (int i = 0; i < 200000; ++i) {
    log.time.push_back(0.001 * i);
    log.torque.push_back(0.0);
    log.speed.push_back(i < 190000 ? 0.0 : 10.0);
  }
  CHECK(data::find_plateaus(log).size() == 1);
}

TEST_CASE("a dead sensor makes no observation, and what it read before is no start-up") {
  data::TorqueLog log;
  data::RandomStream random(1, data::Purpose::test);
  for (int i = 0; i < 400; ++i) {
    log.time.push_back(0.1 * i);
    log.torque.push_back(0.0);
    log.speed.push_back(200.0 * rpm);
  }
  const data::Plateau all{.first = 0, .count = 400, .used_from = 0};
  CHECK(data::saturated_at(log, all) == 0.0);
  // Alive for 15 s of 40, then the noise of an amplifier.
  for (int i = 0; i < 400; ++i)
    log.torque[static_cast<std::size_t>(i)] = (i < 150 ? 7e-3 : 0.0) + 2e-6 * random.normal();
  const std::vector<data::Plateau> found = data::find_plateaus(log);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].torque.dropped > 0);  // the live part, taken for a start-up
  REQUIRE(data::dies_at(log, found[0]).has_value());
  CHECK(*data::dies_at(log, found[0]) == Approx(15.0).margin(1.0));
  // A start-up from twice the torque is one.
  for (int i = 0; i < 400; ++i)
    log.torque[static_cast<std::size_t>(i)] = 3e-3 * (1.0 + std::exp(-i / 20.0)) + 2e-5 * random.normal();
  for (const data::Plateau& plateau : data::find_plateaus(log)) CHECK_FALSE(data::dies_at(log, plateau).has_value());
}

TEST_CASE("a torque of two values is a coarse logger's, not a saturated sensor's") {
  data::TorqueLog log;
  for (int i = 0; i < 400; ++i) {
    log.time.push_back(0.1 * i);
    log.torque.push_back(i % 11 == 0 ? 1.5e-3 : 2.0e-3);
    log.speed.push_back(200.0 * rpm);
  }
  const data::Plateau all{.first = 0, .count = 400, .used_from = 0};
  CHECK_FALSE(data::saturated_at(log, all).has_value());
  for (const std::string& words : data::plateau_faults(log, all)) CHECK(words.find("clipped") == std::string::npos);
  // Cut off at 2 mN m, of a torque that takes many values below it.
  for (int i = 0; i < 400; ++i)
    log.torque[static_cast<std::size_t>(i)] = std::min(2e-3, 1.6e-3 + 1e-6 * (7 * i % 1000));
  REQUIRE(data::saturated_at(log, all).has_value());
  CHECK(*data::saturated_at(log, all) == 2e-3);
}
