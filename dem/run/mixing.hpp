#pragma once
// Two channels side by side (Channels of dem/engine/simulation.hpp): how much powder is in each place of them, and how
// far the powder of one has mixed with that of the other.
//
// A place is a twelfth of a channel's length. The colour of a sphere is the channel in which it started. Of a place
// with n spheres, p is the share of the first colour; over all N spheres it is P. Lacey's index
//   M = (s0^2 - s^2) / (s0^2 - sr^2)
// compares the variance between places, s^2 = sum n (p - P)^2 / N, with that of channels which have not met,
// s0^2 = P (1 - P), and that of spheres at random, sr^2 = P (1 - P) (places - 1) / N. It is 0 at first and 1 where
// nobody can tell where a sphere started. P. M. C. Lacey, J. Appl. Chem. 4 (1954) 257, with places weighted by their
// spheres.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dem/contact/state.hpp"
#include "dem/engine/simulation.hpp"

namespace dem {

struct Series;  // dem/run/run.hpp

constexpr std::size_t places_along = 12;
constexpr std::size_t channel_places = 2 * places_along;

/// The colour of each sphere, by its number: 0 where it starts in the first channel, 1 in the second; empty without
/// channels.
std::vector<std::uint8_t> colours(const Channels& channels, std::span<const Vec3> start);

/// The bed at one moment.
struct ChannelLook {
  std::array<double, channel_places> mass{};  ///< kg, the first channel's places along it, then the second's
  double mixing_index = 0.0;                  ///< 1, not a number where all spheres have one colour
};
ChannelLook look_into(const Channels& channels, std::span<const std::uint8_t> colour, const State& state);

/// The filling and mixing of a run's channels, as its looks give them.
struct Circulation {
  std::array<double, channel_places>
      fill{};                 ///< mass in each place over the mean of all, averaged over what is measured
  double mixing_index = 0.0;  ///< at the end
};
/// The circulation over the measured part; nothing where the rig has no channels, or the run was not looked at.
std::optional<Circulation> circulation(const Series& series, double measured_from);

}  // namespace dem
