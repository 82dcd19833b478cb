#include "dem/run/mixing.hpp"

#include <algorithm>
#include <cmath>

#include "dem/run/run.hpp"

namespace dem {

std::vector<std::uint8_t> colours(const Channels& channels, std::span<const Vec3> start) {
  std::vector<std::uint8_t> colour;
  if (channels.exist())
    for (const Vec3 at : start) colour.push_back(static_cast<std::uint8_t>(channels.of(at)));
  return colour;
}

ChannelLook look_into(const Channels& channels, std::span<const std::uint8_t> colour, const State& state) {
  ChannelLook look;
  std::array<double, channel_places> spheres{}, first{};
  for (std::size_t i = 0; i < state.particles(); ++i) {
    const Vec3 at = state.position[i].at;
    const double share = (dot(channels.along, at) - channels.from) / (channels.to - channels.from);
    const double place = std::clamp(std::floor(share * places_along), 0.0, places_along - 1.0);
    const std::size_t k = static_cast<std::size_t>(channels.of(at)) * places_along + static_cast<std::size_t>(place);
    look.mass[k] += state.motion[i].mass;
    spheres[k] += 1.0;
    first[k] += colour[state.id[i]] == 0 ? 1.0 : 0.0;
  }
  double all = 0.0, all_first = 0.0, places = 0.0;
  for (std::size_t k = 0; k < channel_places; ++k) {
    all += spheres[k];
    all_first += first[k];
    places += spheres[k] > 0.0 ? 1.0 : 0.0;
  }
  const double share = all_first / all, apart = share * (1.0 - share);
  double variance = 0.0;
  for (std::size_t k = 0; k < channel_places; ++k)
    if (spheres[k] > 0.0) variance += spheres[k] / all * std::pow(first[k] / spheres[k] - share, 2);
  look.mixing_index = (apart - variance) / (apart - apart * (places - 1.0) / all);
  return look;
}

std::optional<Circulation> circulation(const Series& series, double measured_from) {
  const std::size_t looks = series.mixing_index.size();
  if (looks == 0 || series.look_time.size() != looks || series.channel_mass.size() != looks * channel_places) return {};
  const auto from = std::upper_bound(series.look_time.begin(), series.look_time.end(), measured_from);
  // A run that measured less than the time between looks has its last one.
  const std::size_t first = std::min(static_cast<std::size_t>(from - series.look_time.begin()), looks - 1);
  Circulation found{.mixing_index = series.mixing_index.back()};
  double all = 0.0;
  for (std::size_t look = first; look < looks; ++look)
    for (std::size_t k = 0; k < channel_places; ++k) {
      found.fill[k] += series.channel_mass[look * channel_places + k];
      all += series.channel_mass[look * channel_places + k];
    }
  for (double& fill : found.fill) fill *= channel_places / all;
  return found;
}

}  // namespace dem
