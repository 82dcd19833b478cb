// The stopping rule on stored series of our own DEM (series/): a bed that orders, one that does not, a cohesive one.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "data/csv.hpp"
#include "data/steadiness.hpp"
#include "dem/run/run.hpp"

namespace {

dem::Series stored(const std::string& name) {
  const data::Csv csv = data::read_csv(DEMCAL_SOURCE_DIR "/tests/dem/series/" + name + ".csv");
  const auto column = [&](const char* head) {
    std::vector<double> values;
    for (const data::CsvRow& row : csv.rows) values.push_back(csv.number(row, csv.column(head)));
    return values;
  };
  dem::Series s;
  s.time = column("time");
  s.torque = column("torque");
  s.coordination = column("coordination");
  s.kinetic_energy = column("kinetic_energy");
  const std::vector<double> order = column("bond_order");
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k] == order[k - 1]) continue;
    s.look_time.push_back(s.time[k]);
    s.bond_order.push_back(order[k]);
  }
  return s;
}

/// The part of a series from one sample on, as a run of its own.
dem::Series part(const dem::Series& whole, std::size_t from, std::size_t count) {
  dem::Series s;
  const auto cut = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<long>(from),
                               values.begin() + static_cast<long>(from + count));
  };
  s.time = cut(whole.time);
  s.torque = cut(whole.torque);
  s.coordination = cut(whole.coordination);
  s.kinetic_energy = cut(whole.kinetic_energy);
  for (std::size_t k = 0; k < whole.look_time.size(); ++k) {
    if (whole.look_time[k] < s.time.front() || whole.look_time[k] > s.time.back()) continue;
    s.look_time.push_back(whole.look_time[k]);
    s.bond_order.push_back(whole.bond_order[k]);
  }
  return s;
}

constexpr double sample = 4e-3;  // s
constexpr std::size_t samples(double time) { return static_cast<std::size_t>(time / sample + 0.5); }

}  // namespace

TEST_CASE("equal spheres that order are caught: no part of a second before they have ordered is called steady") {
  const dem::Series s = stored("equal");
  int steady = 0, windows = 0;
  for (double from = 0.2; from < 0.65; from += 0.05) {
    const dem::LookRule rule{.start_up = 0, .shortest = samples(0.6), .longest = samples(0.6), .standard_error = 0.02};
    const dem::Measured m = dem::measure(rule, part(s, samples(from), samples(0.6)), samples(0.6));
    INFO("from " << from << " s, torque " << 1e6 * m.torque.mean << " +- " << 1e6 * m.torque.standard_error
                 << " uN m, bonds rise " << m.bonds_rise);
    CHECK(m.state != data::FlowState::steady);
    steady += m.state == data::FlowState::steady;
    ++windows;
  }
  CHECK(steady == 0);
  CHECK(windows >= 9);
}

TEST_CASE("parts of steady runs of our own are called drifting in at most 5 of 100") {
  // Each third of a second from 0.3 s on; halves of the cohesive series, whose energy is correlated for longer.
  int drifting = 0, windows = 0;
  for (const auto& [name, width] : {std::pair{"spread", 0.32}, {"spread", 0.6}, {"cohesive", 0.6}}) {
    const dem::Series s = stored(name);
    const dem::LookRule rule{
        .start_up = 0, .shortest = samples(width), .longest = samples(width), .standard_error = 0.02};
    for (std::size_t from = samples(0.3); from + samples(width) <= s.time.size(); from += samples(width) / 2) {
      const dem::Measured m = dem::measure(rule, part(s, from, samples(width)), samples(width));
      INFO(name << " from " << s.time[from] << " s: p " << m.drift_p[0] << " " << m.drift_p[1] << " " << m.drift_p[2]
                << ", bonds rise " << m.bonds_rise);
      drifting += m.state == data::FlowState::drifting;
      ++windows;
    }
  }
  INFO(drifting << " of " << windows);
  CHECK(windows >= 20);
  CHECK(drifting <= std::ceil(0.05 * windows));
}

TEST_CASE("the torque of the first steady part of a run is that of all that follows, within its error") {
  for (const char* name : {"spread", "cohesive"}) {
    const dem::Series s = stored(name);
    const dem::LookRule rule{
        .start_up = samples(0.2), .shortest = samples(0.3), .longest = s.time.size(), .standard_error = 0.02};
    dem::Looks looks = dem::begin_looks(rule);
    dem::take_looks(rule, s, looks);
    CHECK(looks.last.state == data::FlowState::steady);
    CHECK(looks.next < s.time.size());
    const dem::Measured all = dem::measure(rule, s, s.time.size());
    INFO(name << ": " << 1e6 * looks.last.torque.mean << " +- " << 1e6 * looks.last.torque.standard_error << ", all "
              << 1e6 * all.torque.mean << " +- " << 1e6 * all.torque.standard_error << " uN m");
    CHECK(std::abs(looks.last.torque.mean - all.torque.mean) < 3.0 * looks.last.torque.standard_error);
  }
}

TEST_CASE("five parts in a hundred more torque at the end than at the start of a second are caught in 9 of 10") {
  // As ordering does it: the coordination moves against it by as much, by which it is seen.
  const dem::Series s = stored("spread");
  int caught = 0, windows = 0;
  for (double from = 0.3; from + 1.0 <= s.time.back(); from += 0.1) {
    dem::Series p = part(s, samples(from), samples(1.0));
    for (std::size_t k = 0; k < p.time.size(); ++k) {
      const double way = static_cast<double>(k) / static_cast<double>(p.time.size()) - 0.5;
      p.torque[k] *= 1.0 - 0.05 * way;
      p.coordination[k] *= 1.0 + 0.05 * way;
    }
    const dem::LookRule rule{.start_up = 0, .shortest = samples(1.0), .longest = samples(1.0), .standard_error = 0.02};
    caught += dem::measure(rule, p, samples(1.0)).state == data::FlowState::drifting;
    ++windows;
  }
  INFO(caught << " of " << windows);
  CHECK(caught >= 0.9 * windows);
}

TEST_CASE("two turns of a slow cohesive bed know their error: their means scatter by it") {
  // Outside the estimate: thirty turns of two seeds say how far means of two turns scatter. The bed's torque has
  // motions slower than a turn, which an error made of faster ones does not see (1.39 with sixteen modes).
  const data::Csv csv = data::read_csv(DEMCAL_SOURCE_DIR "/tests/dem/series/slow.csv");
  constexpr std::size_t two_turns = 200;
  double squares = 0.0;
  std::size_t freedom = 0;
  for (const char* seed : {"seed_5001", "seed_5002"}) {
    std::vector<double> torque;
    for (const data::CsvRow& row : csv.rows) torque.push_back(csv.number(row, csv.column(seed)));
    std::vector<data::SeriesMean> parts;
    for (std::size_t from = 0; from + two_turns <= torque.size(); from += two_turns)
      parts.push_back(data::steadiness(std::span(torque).subspan(from, two_turns)).mean);
    double whole = 0.0;
    for (const data::SeriesMean& mean : parts) whole += mean.mean / static_cast<double>(parts.size());
    for (const data::SeriesMean& mean : parts) squares += std::pow((mean.mean - whole) / mean.standard_error, 2);
    freedom += parts.size() - 1;
  }
  const double spread = std::sqrt(squares / static_cast<double>(freedom));
  INFO("standard deviation of means over their errors " << spread << ", of " << freedom << " degrees of freedom");
  REQUIRE(freedom == 12);
  CHECK(spread > 0.8);
  CHECK(spread < 1.3);
}

TEST_CASE("after the start-up that is dropped torque is at its level at any speed, and before it is not") {
  // Means over seeds of parts of a turn, at three materials and two speeds; the last part of each point is its level.
  const data::Csv csv = data::read_csv(DEMCAL_SOURCE_DIR "/tests/dem/series/start_up.csv");
  const auto number = [&](const data::CsvRow& row, const char* head) { return csv.number(row, csv.column(head)); };
  struct Part {
    double from, torque, error;
  };
  std::map<std::string, std::vector<Part>> points;
  for (const data::CsvRow& row : csv.rows)
    points[row.fields[csv.column("material")] + row.fields[csv.column("rpm")]].push_back(
        {number(row, "from_turns"), number(row, "torque"), number(row, "torque_se")});
  REQUIRE(points.size() == 6);
  const double dropped = dem::RunControl{}.start_up_turns;
  double chi_squared = 0.0;
  int parts_after = 0;
  for (const auto& [point, parts] : points) {
    const Part& level = parts.back();
    double highest = 0.0;
    for (std::size_t k = 0; k + 1 < parts.size(); ++k) {
      const double above = parts[k].torque / level.torque - 1.0;
      INFO(point << " from " << parts[k].from << " turns: " << 100.0 * above << " % above the level");
      if (parts[k].from < dropped) {
        highest = std::max(highest, above);
      } else {
        const double z = (parts[k].torque - level.torque) / std::hypot(parts[k].error, level.error);
        chi_squared += z * z;
        ++parts_after;
        CHECK(std::abs(above) < 0.03);
      }
    }
    CHECK(highest > 0.05);  // what a quarter of a turn would let in
  }
  CHECK(parts_after == 12);
  CHECK(chi_squared < 26.2);  // 99 % of chi-squared with 12
}
