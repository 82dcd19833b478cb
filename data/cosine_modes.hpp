#pragma once
// The slowest cosine modes of a series, whose powers say what its mean's variance is made of (data/steadiness.cpp).
#include <cstddef>
#include <span>
#include <vector>

namespace data {

/// c_j = sqrt(2)/n sum_k (x_k - mean) cos(j pi (k - 1/2)/n), j = 1 ... count. n c_j^2 is the spectrum at that mode.
std::vector<double> cosine_modes(std::span<const double> x, double mean, std::size_t count);

}  // namespace data
