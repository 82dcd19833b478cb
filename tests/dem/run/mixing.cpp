// Channels side by side: the mixing index against counted and random colours, and what a run says of them.
#include "dem/run/mixing.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "data/random.hpp"
#include "dem/run/run.hpp"

namespace {

const dem::Channels channels{.along = {-1.0, 0.0, 0.0},
                             .across = {0.0, 1.0, 0.0},
                             .middle = 0.0,
                             .from = -1.2,
                             .to = 0.0,
                             .flow_from = -1.1,
                             .flow_to = -0.1};

/// Spheres of 1 kg all over both channels.
struct Bed {
  dem::State state;
  std::vector<dem::Vec3> start;
  explicit Bed(std::size_t spheres) {
    data::RandomStream random(11, data::Purpose::test);
    for (std::size_t i = 0; i < spheres; ++i)
      start.push_back({random.uniform(0.0, 1.2), random.uniform(-1.0, 1.0), 0.0});
    state.position.resize(spheres);
    state.motion.resize(spheres);
    state.half.resize(spheres);
    for (std::size_t i = 0; i < spheres; ++i) {
      state.id.push_back(static_cast<std::uint32_t>(i));
      state.position[i].at = start[i];
      state.motion[i].mass = 1.0;
    }
  }
  dem::ChannelLook look(const std::vector<std::uint8_t>& colour) const {
    return dem::look_into(channels, colour, state);
  }
};

}  // namespace

TEST_CASE("channels that have not met have the mixing index 0, and spheres of random colours about 1") {
  const Bed bed(20000);
  CHECK(bed.look(dem::colours(channels, bed.start)).mixing_index == Approx(0.0).margin(1e-12));
  data::RandomStream random(3, data::Purpose::test);
  double sum = 0.0;
  constexpr int draws = 200;
  for (int k = 0; k < draws; ++k) {
    std::vector<std::uint8_t> colour;
    for (std::size_t i = 0; i < bed.start.size(); ++i) colour.push_back(random.uniform() < 0.3 ? 0 : 1);
    sum += bed.look(colour).mixing_index;
  }
  CHECK(sum / draws == Approx(1.0).margin(2e-4));  // an index scatters by 3.5e-4
}

TEST_CASE("a quarter of each channel exchanged with the other is a mixing index of 3/4") {
  const Bed bed(40000);
  std::vector<std::uint8_t> colour = dem::colours(channels, bed.start);
  // Every fourth sphere of each place changes its colour: p is 3/4 and 1/4, s^2 a quarter of s0^2.
  std::array<int, dem::channel_places> met{};
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const auto place = static_cast<std::size_t>((1.2 - bed.start[i].x) / 0.1);
    int& count = met[static_cast<std::size_t>(channels.of(bed.start[i])) * dem::places_along +
                     std::min(place, dem::places_along - 1)];
    if (++count % 4 == 0) colour[i] = 1 - colour[i];
  }
  CHECK(bed.look(colour).mixing_index == Approx(0.75).margin(2e-3));
}

TEST_CASE("the masses of the places along the channels are those of the spheres there") {
  Bed bed(3);
  bed.state.position[0].at = {0.05, -0.5, 0.0};  // the end of the first channel, which flows towards -x
  bed.state.position[1].at = {1.15, -0.5, 0.0};  // its start
  bed.state.position[2].at = {1.35, 0.5, 0.0};   // beyond the start of the second: its first place
  bed.state.motion[2].mass = 5.0;
  const dem::ChannelLook look = bed.look({0, 0, 1});
  CHECK(look.mass[dem::places_along - 1] == 1.0);
  CHECK(look.mass[0] == 1.0);
  CHECK(look.mass[dem::places_along] == 5.0);
  CHECK(std::accumulate(look.mass.begin(), look.mass.end(), 0.0) == 7.0);
}

TEST_CASE("circulation averages the looks of what was measured, and has none without channels") {
  dem::Series series;
  CHECK_FALSE(dem::circulation(series, 0.0));
  for (const double time : {0.05, 0.1, 0.15}) {
    series.look_time.push_back(time);
    series.mixing_index.push_back(time);
    for (std::size_t k = 0; k < dem::channel_places; ++k)
      series.channel_mass.push_back(time < 0.06 ? 100.0 : k < dem::places_along ? 3.0 : 1.0);
  }
  const auto found = dem::circulation(series, 0.05);
  REQUIRE(found);
  CHECK(found->mixing_index == 0.15);
  CHECK(found->fill.front() == Approx(1.5));
  CHECK(found->fill.back() == Approx(0.5));
}
