// Powder poured into a vessel of two chambers, cells counted by hand.
#include "dem/forecast/room.hpp"

#include <catch2/catch.hpp>
#include <numeric>

using dem::Room;

namespace {

/// A box one cell deep, five wide and six high, open at its top, with a wall three high between the second and the
/// third column.
Room two_chambers() {
  Room room{.low = {0.0, 0.0, 0.0}, .cell = {1.0, 1.0, 1.0}, .n = {1, 5, 6}, .down = {0.0, 0.0, -1.0}};
  room.walled.assign(30, 0);
  room.narrow.assign(30, 0);
  for (std::size_t k = 0; k < room.total(); ++k) {
    const auto i = room.index(k);
    const auto wall = [&](int side) { room.walled[k] |= static_cast<std::uint8_t>(1u << side); };
    wall(0);
    wall(1);
    if (i[1] == 0 || (i[1] == 2 && i[2] < 3)) wall(2);
    if (i[1] == 4 || (i[1] == 1 && i[2] < 3)) wall(3);
    if (i[2] == 0) wall(4);
  }
  return room;
}

int wet(const dem::Poured& bed) { return std::accumulate(bed.wet.begin(), bed.wet.end(), 0); }

}  // namespace

TEST_CASE("powder that starts over two chambers lies in both, and not all of it where the lowest sphere starts") {
  const Room room = two_chambers();
  const std::size_t left = room.at({0.5, 0.5, 4.5}), right = room.at({0.5, 4.5, 4.5});
  const dem::Poured both = dem::pour(room, {left, right}, 4.0);
  CHECK(both.wet[room.at({0.5, 0.5, 0.5})] == 1);
  CHECK(both.wet[room.at({0.5, 4.5, 0.5})] + both.wet[room.at({0.5, 2.5, 0.5})] >= 1);
  CHECK(wet(both) == 4);
  CHECK(both.surface == Approx(0.5 * 1.0 + 0.5 * 2.0 / 3.0));
  // As it was poured at one place.
  CHECK(dem::pour(room, left, 4.0).surface == Approx(2.0));
  CHECK(dem::pour(room, {left, left}, 4.0).surface == Approx(2.0));
}

TEST_CASE("what one chamber cannot hold runs over into the next") {
  const Room room = two_chambers();
  const std::size_t left = room.at({0.5, 0.5, 4.5}), right = room.at({0.5, 4.5, 4.5});
  // Eleven cells start on the left, which holds six below the wall's top; three start on the right.
  const dem::Poured bed = dem::pour(room, {left, left, left, left, right}, 14.0);
  CHECK(wet(bed) == 14);
  CHECK(bed.wet[room.at({0.5, 2.5, 0.5})] == 1);
  // A vessel that is full to its rim holds all cells, whoever is asked.
  CHECK(bed.held == Approx(dem::pour(room, left, 14.0).held));
}
