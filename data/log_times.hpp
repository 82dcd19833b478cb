#pragma once
// The times of a log's samples, made from what its logger stamped.
#include <cstddef>
#include <string>
#include <vector>

namespace data {

/// Puts the sections of a log one behind the other, in place (`starts`: the first sample of each section but the
/// first). Where a section's time begins again, it follows the section before by that section's usual interval. Returns
/// whether any did. Samples without a time are NaN.
bool join_sections(std::vector<double>& times, const std::vector<std::size_t>& starts);

/// Lets the times of a clock that started again at midnight go on, in place. Returns how many midnights there were.
/// `of_day`: the stamps are times of day; else only seconds that fall from the end of a day to the start of one count.
std::size_t pass_midnight(std::vector<double>& times, bool of_day);

/// Whether many samples share their stamp with others: the stamp is then coarser than the interval between samples.
bool shares_stamps(const std::vector<double>& times);

/// Whether some samples in order share their stamp with the one before: the clock is as coarse as the interval, or it
/// jitters.
bool repeats_stamps(const std::vector<double>& times);

/// Spreads the samples that share stamps: evenly over the whole log where that agrees with every stamp, else evenly
/// within each. Returns in words how, "samples that share a stamp spread evenly, 0.1 s apart"; nothing where there are
/// fewer than three stamps, which tell no interval.
std::string spread_stamps(std::vector<double>& times);

}  // namespace data
