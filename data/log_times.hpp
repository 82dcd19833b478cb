#pragma once
// The times of a log's samples, out of what its logger stamped.
#include <string>
#include <vector>

namespace data {

/// Times made good in place: those of a clock that started again at midnight go on. Returns how many midnights there
/// were. `of_day`: the stamps are times of day; else only seconds that fall from the end of a day to the start of one
/// count.
std::size_t pass_midnight(std::vector<double>& times, bool of_day);

/// Whether many samples share their stamp with others: it is coarser than the interval.
bool shares_stamps(const std::vector<double>& times);

/// Whether some samples in order share their stamp with the one before: the clock is as coarse as the interval, or it
/// jitters.
bool repeats_stamps(const std::vector<double>& times);

/// Spreads the samples that share stamps: evenly over the whole log where that agrees with every stamp, else evenly
/// within each. Returns "spread evenly, 0.1 s apart" or "spread evenly within each stamp".
std::string spread_stamps(std::vector<double>& times);

}  // namespace data
