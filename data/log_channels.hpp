#pragma once
// Logs with a row for each value of each channel, as control systems, historians and time-series databases export them:
//
//   "VarName";"TimeString";"VarValue"
//   "Torque_Nm";"03.05.2024 14:02:00";1,8945
//   "Speed_rpm";"03.05.2024 14:02:00";50,0
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "data/csv.hpp"
#include "data/torque_log.hpp"

namespace data {

/// The columns that say of a row which channel it is of, and what its value is.
struct ChannelColumns {
  std::size_t channel = 0, value = 0;
};

/// The two columns of such a log, by their usual headings, whose names and units are parted (part_headings); nothing
/// where the table has a column of the torque.
std::optional<ChannelColumns> find_channels(const Csv& csv, const LogColumns& columns);

/// The log with a column for each channel. A channel "Mixer.Torque" is the column "Torque" where no other ends so. The
/// rows are those of the torque, in the order of time; each holds of every other channel what was last written of it,
/// since such systems write a value when it changes. `took` says so. Throws InputError (65) where no channel is the
/// torque.
Csv with_channels_as_columns(const Csv& csv, const ChannelColumns& at, const LogColumns& columns,
                             std::vector<std::string>& took);

}  // namespace data
