#pragma once
// The name that somebody who mistyped one may have meant.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace data {

/// Smallest number of insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`. Upper and
/// lower case count as the same.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `name`, if any is near enough to be meant.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace data
