#pragma once
// Random permutation: R. Durstenfeld, "Algorithm 235: Random permutation", Commun. ACM 7:420 (1964). The standard's own
// shuffle gives other orders with other standard libraries; this one gives one order with all of them.
#include <cstddef>
#include <span>
#include <utility>

#include "data/random.hpp"

namespace data {

template <class Item>
void shuffle(std::span<Item> items, RandomStream& random) {
  for (std::size_t k = items.size(); k > 1; --k)
    std::swap(items[k - 1], items[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
}

}  // namespace data
