#include "data/torque_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "data/log_faults.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"

namespace {

constexpr double rpm = std::numbers::pi / 30.0;

/// A logger's file: at each speed for `seconds`, a first-order sensor lag after ramps of 40 rpm/s, correlated noise of
/// the powder, speed noise, and now and then a dropout of the speed.
struct Made {
  std::vector<double> speeds{50, 100, 200};
  double seconds = 40.0, interval = 0.02, noise = 0.1, memory = 0.9;
  double torque(double speed) const { return 2.0 + 0.004 * speed; }
  std::string text(std::uint64_t seed) const {
    data::RandomStream random(seed, data::Purpose::test);
    std::string text = "time,Torque [mN m],rpm\n";
    double t = 0.0, speed = 0.0, sensor = 0.0, powder = 0.0;
    for (const double wanted : speeds)
      for (int i = 0; i * interval < seconds; ++i, t += interval) {
        speed += std::clamp(wanted - speed, -40.0 * interval, 40.0 * interval);
        sensor += (torque(speed) - sensor) * std::min(1.0, interval / 0.3);
        powder = memory * powder + std::sqrt(1.0 - memory * memory) * noise * random.normal();
        const double shown = random.uniform() < 0.002 ? 0.0 : speed + 0.1 * random.normal();
        text += fmt::format("{:.3f},{:.6f},{:.3f}\n", t, sensor + powder, shown);
      }
    return text;
  }
};

std::vector<data::Plateau> reduced(const Made& made, std::uint64_t seed, const data::PlateauOptions& options = {}) {
  const TemporaryFolder folder;
  return data::find_plateaus(data::read_torque_log(folder.write("log.csv", made.text(seed))), options);
}

std::string refusal(const std::string& text, const data::LogColumns& columns = {}) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] { data::read_torque_log(folder.write("log.csv", text), columns); });
}

}  // namespace

TEST_CASE("each constant speed of a log is one plateau, and ramps, start-up and dropouts of the speed do not count") {
  const Made made;
  const std::vector<data::Plateau> plateaus = reduced(made, 1);
  REQUIRE(plateaus.size() == made.speeds.size());
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    CHECK(plateaus[i].speed == Approx(made.speeds[i] * rpm).epsilon(1e-3));
    CHECK(plateaus[i].speed_sd < 0.5 * rpm);
    CHECK(static_cast<double>(plateaus[i].count) * made.interval > 0.85 * made.seconds);
    CHECK(plateaus[i].torque.reliable);
  }
}

TEST_CASE("the means of a log lie within their errors of the truth as often as they should") {
  const Made made{.speeds = {120}, .seconds = 30.0};
  int within_one = 0, within_two = 0;
  constexpr int logs = 200;
  for (std::uint64_t seed = 0; seed < logs; ++seed) {
    const std::vector<data::Plateau> plateaus = reduced(made, seed, {.dead_time = 2.0});
    REQUIRE(plateaus.size() == 1);
    const double z = (1e3 * plateaus[0].torque.mean - made.torque(120)) / (1e3 * plateaus[0].torque.standard_error);
    within_one += std::abs(z) < 1.0;
    within_two += std::abs(z) < 2.0;
  }
  CAPTURE(within_one, within_two);
  CHECK(std::abs(within_one - 0.683 * logs) < 3.0 * std::sqrt(logs * 0.683 * 0.317));
  CHECK(std::abs(within_two - 0.954 * logs) < 4.0 * std::sqrt(logs * 0.954 * 0.046));
}

TEST_CASE("the error of a hold of few independent samples is not too small") {
  // Holds of one minute at a sample a second, correlated over 3 s: twenty independent samples. Errors from the
  // integrated time alone give 1.33.
  const Made made{.speeds = {120}, .seconds = 75.0, .interval = 1.0, .memory = 0.5};
  double squares = 0.0;
  constexpr int logs = 300;
  for (std::uint64_t seed = 0; seed < logs; ++seed) {
    const std::vector<data::Plateau> plateaus = reduced(made, seed, {.dead_time = 15.0});
    REQUIRE(plateaus.size() == 1);
    squares += std::pow((plateaus[0].torque.mean - 1e-3 * made.torque(120)) / plateaus[0].torque.standard_error, 2);
  }
  const double spread = std::sqrt(squares / logs);
  CAPTURE(spread);
  CHECK(spread > 0.9);
  CHECK(spread < 1.25);
}

TEST_CASE("dead time is dropped from the front, and a window leaves out what lies outside") {
  const Made made;
  for (const data::Plateau& plateau : reduced(made, 2, {.dead_time = 5.0}))
    CHECK(static_cast<double>(plateau.used_from - plateau.first) * made.interval >= 5.0 - 1e-9);
  CHECK(reduced(made, 2, {.from = 41.0, .to = 79.0}).size() == 1);
  CHECK(reduced(made, 2, {.shortest = 41.0}).empty());
}

TEST_CASE("samples that a logger loses end no plateau, and a gap in which another could have been does") {
  const auto holds = [](double lost_from, double lost_to, int of_each_fifty) {
    data::RandomStream random(5, data::Purpose::test);
    std::string text = "time,Torque [mN m],rpm\n";
    for (int i = 0; i < 600; ++i) {
      const double t = 0.1 * i;
      if (i % 50 < of_each_fifty || (t >= lost_from && t < lost_to)) continue;
      text += fmt::format("{:.1f},{:.5f},{:.3f}\n", t, 2.0 + 0.05 * random.normal(), 50.0 + 0.05 * random.normal());
    }
    const TemporaryFolder folder;
    return data::find_plateaus(data::read_torque_log(folder.write("log.csv", text)));
  };
  for (const int lost : {0, 1, 3, 4, 10}) {
    INFO(lost << " of each 50 samples are lost");
    const std::vector<data::Plateau> found = holds(0.0, 0.0, lost);
    REQUIRE(found.size() == 1);
    CHECK(found[0].count == static_cast<std::size_t>(600 - 12 * lost));
  }
  CHECK(holds(20.0, 24.0, 0).size() == 1);
  CHECK(holds(20.0, 30.0, 0).size() == 2);
}

TEST_CASE("headers carry units in brackets, parentheses or after a slash, and an option overrides them") {
  for (const std::string head :
       {"time [s],torque [mN m],rpm", "Time,TORQUE (mN m),rpm", "time,torque / mN m,rpm [rpm]"}) {
    const TemporaryFolder folder;
    const data::TorqueLog log = data::read_torque_log(folder.write("log.csv", head + "\n0,2,60\n1,3,60\n"));
    CHECK(log.torque == std::vector<double>{2e-3, 3e-3});
    CHECK(log.speed[0] == Approx(60 * rpm));
  }
  data::LogColumns columns;
  columns.torque.unit = "N cm";
  columns.speed = {.name = "drehzahl", .unit = "rad/s", .usual = "rpm"};
  const TemporaryFolder folder;
  const data::TorqueLog log =
      data::read_torque_log(folder.write("log.csv", "time,torque [N m],Drehzahl\n0,2,3\n1,2,3\n"), columns);
  CHECK(log.torque[0] == Approx(0.02));
  CHECK(log.speed[0] == 3.0);
}

TEST_CASE("samples with a missing value are left out and counted") {
  const TemporaryFolder folder;
  const data::TorqueLog log =
      data::read_torque_log(folder.write("log.csv", "time,torque [N m],rpm\n0,2,60\n1,,60\n2,2,nan\n3,2,60\n"));
  CHECK(log.time == std::vector<double>{0.0, 3.0});
  CHECK(log.missing == 2);
}

TEST_CASE("what is wrong with a log is named with its place and a remedy") {
  CHECK(refusal("time,torque,rpm\n0,1,1\n1,1,1\n") ==
        "65: log.csv:1: the column 'torque' has no unit (write it in the header, 'torque [N m]', or give "
        "--torque-unit)");
  CHECK(refusal("time,torque [N m],swiftness\n0,1,1\n") ==
        "65: log.csv:1: the column 'rpm' is missing (the columns are time, torque [N m], swiftness) (name it with "
        "--rpm, or give the speed of the whole log with --constant-speed)");
  CHECK(refusal("time,torque [N],rpm\n0,1,1\n") ==
        "65: log.csv:1: 'N' is not a unit of torque (a unit like 'N m'; --torque-unit overrides the header)");
  CHECK(refusal("time,torque [N m],rpm\n0,1,1\n1,1,1\n1,1,1\n") ==
        "65: log.csv:4: time: 1 s does not come after 1 s of the sample before (sort the log by time, remove repeated "
        "lines, or split a log that was restarted)");
  CHECK(refusal("time,torque [N m],rpm\n0,1,1\n") ==
        "65: log.csv: has 1 complete samples (a log has time, torque and speed of many samples)");
}

TEST_CASE("the idle torque at a speed is the weighted mean of the empty machine's plateaus there") {
  const auto plateau = [](double speed, double mean, double error) {
    data::Plateau one;
    one.speed = speed;
    one.torque.mean = mean;
    one.torque.standard_error = error;
    return one;
  };
  const std::vector<data::Plateau> idle{plateau(10.0, 1.0, 0.1), plateau(10.1, 2.0, 0.2), plateau(20.0, 5.0, 0.1)};
  const auto at = data::idle_at(idle, 10.0, 0.02);
  REQUIRE(at);
  CHECK(at->value == Approx(1.2));
  CHECK(at->error == Approx(1.0 / std::sqrt(125.0)));
  CHECK_FALSE(data::idle_at(idle, 15.0, 0.02));
}

namespace {

/// A log of samples every `interval` s with torque and speed given by their numbers.
template <class Torque, class Speed>
data::TorqueLog log_of(int samples, double interval, Torque torque, Speed speed) {
  data::TorqueLog log;
  log.file = "log.csv";
  log.torque_unit = data::parse_unit("mN m");
  log.speed_unit = data::parse_unit("rpm");
  log.interval = interval;
  for (int i = 0; i < samples; ++i) {
    log.time.push_back(interval * i);
    log.torque.push_back(log.torque_unit.to_si(torque(i)));
    log.speed.push_back(log.speed_unit.to_si(speed(i)));
  }
  return log;
}

}  // namespace

TEST_CASE("the error of a mean is that of the slow noise, whatever hums on top of it") {
  // Autoregressive noise of sd 0.3 and memory 0.99: var(mean) = sd^2 (1 + 0.99)/(1 - 0.99)/n.
  for (const double hum : {0.0, 0.3, 1.0, 3.0}) {
    constexpr int n = 8000, draws = 60;
    double squares = 0.0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, 9);
      std::vector<double> series;
      double slow = 0.3 * random.normal();
      const double phase = 6.283 * random.uniform();
      for (int i = 0; i < n; ++i) {
        slow = 0.99 * slow + 0.3 * std::sqrt(1.0 - 0.99 * 0.99) * random.normal();
        series.push_back(slow + hum * std::sin(phase + 6.283185307 * 0.05 * i));
      }
      const data::SeriesMean mean = data::mean_of_hold(series);
      squares += std::pow(mean.mean / mean.standard_error, 2) / draws;
    }
    INFO("hum " << hum);
    CHECK(std::sqrt(squares) > 0.7);
    CHECK(std::sqrt(squares) < 1.3);
  }
}

TEST_CASE("a wander below fast noise that is too slow for its hold is told, and plain noise is none") {
  // An autoregressive wander of an integrated time of 10 s, in holds of 60 and 2400 s at 100 samples a second.
  const auto told = [](double wander, int n) {
    constexpr int draws = 40;
    int unreliable = 0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, 14);
      std::vector<double> series;
      double slow = random.normal();
      constexpr double memory = 0.998;  // (1 + 0.998)/(1 - 0.998) samples are 10 s
      for (int i = 0; i < n; ++i) {
        slow = memory * slow + std::sqrt(1.0 - memory * memory) * random.normal();
        series.push_back(wander * slow + random.normal());
      }
      unreliable += !data::mean_of_hold(series).reliable;
    }
    return unreliable / static_cast<double>(draws);
  };
  CHECK(told(0.3, 6000) > 0.5);
  CHECK(told(0.3, 240000) < 0.1);
  CHECK(told(0.0, 6000) == 0.0);
}

TEST_CASE("the error of a mean is that of a slow wander below fast noise") {
  // White noise of sd 4 over an autoregressive wander of sd 1 and memory 0.99. Without either, the error stays honest.
  struct Noise {
    double fast, slow;
  };
  for (const Noise noise : {Noise{4.0, 1.0}, {3.0, 1.5}, {4.0, 0.0}, {0.0, 1.0}}) {
    constexpr int n = 6000, draws = 80;
    const double variance = (noise.fast * noise.fast + noise.slow * noise.slow * 1.99 / 0.01) / n;
    double squares = 0.0, stated = 0.0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, 12);
      std::vector<double> series;
      double slow = random.normal();
      for (int i = 0; i < n; ++i) {
        slow = 0.99 * slow + std::sqrt(1.0 - 0.99 * 0.99) * random.normal();
        series.push_back(noise.slow * slow + noise.fast * random.normal());
      }
      const data::SeriesMean mean = data::mean_of_hold(series);
      squares += std::pow(mean.mean / mean.standard_error, 2) / draws;
      stated += mean.standard_error / std::sqrt(variance) / draws;
    }
    INFO("fast " << noise.fast << ", slow " << noise.slow);
    CHECK(std::sqrt(squares) > 0.75);
    CHECK(std::sqrt(squares) < 1.25);
    CHECK(stated > 0.9);
    CHECK(stated < 1.25);
  }
}

TEST_CASE("a slow wander below fast noise is no drift, and a drift below it is one") {
  constexpr int n = 6000, draws = 40;
  const auto called = [](double slope) {
    int drifts = 0;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, 16);
      double slow = random.normal();
      const data::TorqueLog log = log_of(
          n, 0.01,
          [&](int i) {
            slow = 0.99 * slow + std::sqrt(1.0 - 0.99 * 0.99) * random.normal();
            return 100.0 + slow + 3.0 * random.normal() + slope * i / n;
          },
          [](int) { return 100.0; });
      for (const data::Plateau& plateau : data::find_plateaus(log))
        for (const std::string& fault : data::plateau_faults(log, plateau))
          drifts += fault.find("drifts") != std::string::npos;
    }
    return drifts;
  };
  CHECK(called(0.0) <= 1);
  CHECK(called(10.0) > 30);
}

TEST_CASE("a hold a hundred times slower than the fastest is one, and standstill with its scatter is none") {
  const auto speeds = [](int i) { return i < 600 ? 1.0 : i < 1200 ? 200.0 : 0.0; };
  data::RandomStream random(3, data::Purpose::test, 10);
  const data::TorqueLog slow = log_of(
      1800, 0.1, [](int) { return 5.0; }, [&](int i) { return speeds(i) + 0.01 * random.normal(); });
  const std::vector<data::Plateau> found = data::find_plateaus(slow);
  REQUIRE(found.size() == 2);
  CHECK(found[0].speed == Approx(1.0 * rpm).epsilon(0.01));
  const data::TorqueLog noisy = log_of(
      1800, 0.1, [](int) { return 5.0; }, [&](int i) { return i < 900 ? 200.0 : 0.5 * random.normal(); });
  CHECK(data::find_plateaus(noisy).size() == 1);
}

TEST_CASE("a spike of the tachometer does not make slow holds standstill") {
  const data::TorqueLog log = log_of(
      1200, 0.1, [](int) { return 5.0; }, [](int i) { return i == 700  ? 8000.0
                                                             : i < 600 ? 50.0
                                                                       : 100.0; });
  CHECK(data::find_plateaus(log).size() == 2);
}

TEST_CASE("the speed of a coarse tachometer is the mean of its steps, and that is said") {
  data::RandomStream random(4, data::Purpose::test, 11);
  const data::TorqueLog log = log_of(
      1200, 0.1, [](int i) { return 3.0 + 0.1 * std::sin(0.7 * i); },
      [&](int) { return random.uniform() < 0.3 ? 6.0 : 5.0; });
  double mean = 0.0;
  for (const double speed : log.speed) mean += speed / 1200.0;
  for (const data::Plateau& hold : data::find_plateaus(log)) {
    CHECK(hold.speed == Approx(mean).epsilon(0.05));
    CHECK(hold.off_speed > 0.1);
  }
}

TEST_CASE("a speed that swings about one mean is one hold, and steps that rise are as many as there are") {
  const data::TorqueLog swings = log_of(
      1200, 0.1, [](int) { return 3.0; }, [](int i) { return 100.0 + 3.0 * std::sin(2.0 * 3.14159 * 0.005 * i); });
  const std::vector<data::Plateau> one = data::find_plateaus(swings);
  REQUIRE(one.size() == 1);
  CHECK(one[0].speed == Approx(100.0 * rpm).epsilon(0.005));
  const data::TorqueLog steps = log_of(
      1200, 0.1, [](int) { return 3.0; }, [](int i) { return 100.0 + 4.0 * (i / 300); });
  CHECK(data::find_plateaus(steps).size() == 4);
}

TEST_CASE("a tachometer that reads nothing for some milliseconds ends no hold") {
  const data::TorqueLog log = log_of(
      20000, 0.001, [](int) { return 3.0; }, [](int i) { return i % 2000 < 8 ? 0.0 : 100.0; });
  CHECK(data::find_plateaus(log).size() == 1);
}

namespace {

/// The hold of a log with samples at these times, all at 120 rpm.
data::Plateau hold_of(const std::vector<double>& times, const std::vector<double>& torques) {
  std::string text = "time [s],torque [N m],rpm\n";
  for (std::size_t i = 0; i < times.size(); ++i) text += fmt::format("{:.4f},{:.6f},120\n", times[i], torques[i]);
  const TemporaryFolder folder;
  const std::vector<data::Plateau> found =
      data::find_plateaus(data::read_torque_log(folder.write("log.csv", text)), {.shortest = 5.0});
  REQUIRE(found.size() == 1);
  return found.front();
}

}  // namespace

TEST_CASE("a log of changes gives means over time: a sample counts until the next one") {
  // 3 N m, with half a second of 4 N m every ten seconds that has as many samples as the rest.
  std::vector<double> times, torques;
  data::RandomStream random(3, data::Purpose::test);
  for (int period = 0; period < 60; ++period) {
    for (int i = 0; i < 10; ++i) {
      times.push_back(10.0 * period + 0.95 * i);
      torques.push_back(3.0 + 0.01 * random.normal());
    }
    for (int i = 0; i < 10; ++i) {
      times.push_back(10.0 * period + 9.5 + 0.05 * i);
      torques.push_back(4.0 + 0.01 * random.normal());
    }
  }
  const data::Plateau hold = hold_of(times, torques);
  CHECK(hold.torque.mean == Approx(3.05).epsilon(0.005));
  CHECK(hold.used_from == hold.first);
}

TEST_CASE("means of samples at uneven times lie within their errors of the truth as often as they should") {
  // Noise of sd 0.2 and correlation time 2 s, read every 0.02 to 0.4 s for two minutes.
  constexpr int logs = 60;
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < logs; ++seed) {
    data::RandomStream random(seed, data::Purpose::test, 21);
    std::vector<double> times, torques;
    double noise = 0.2 * random.normal();
    for (double t = 0.0; t < 120.0;) {
      times.push_back(t);
      torques.push_back(3.0 + noise);
      const double step = 0.02 * std::pow(20.0, random.uniform());
      const double memory = std::exp(-step / 2.0);
      noise = memory * noise + 0.2 * std::sqrt(1.0 - memory * memory) * random.normal();
      t += step;
    }
    const data::SeriesMean mean = hold_of(times, torques).torque;
    squares += std::pow((mean.mean - 3.0) / mean.standard_error, 2) / logs;
  }
  CHECK(std::sqrt(squares) > 0.7);
  CHECK(std::sqrt(squares) < 1.3);
}
