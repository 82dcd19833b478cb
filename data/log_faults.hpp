#pragma once
// What loggers and sensors do to a torque log, found before and after its reduction.
#include <optional>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "data/time_series.hpp"
#include "data/torque_log.hpp"

namespace data {

/// Takes out samples that are no measurement: codes for "no value" (9999, -999, 32767 and their like) far from all
/// others, in torque or speed, and single torques of exactly zero amid others of a turning machine. Returns what it
/// took out, in words.
std::vector<std::string> remove_no_values(TorqueLog& log);

/// The torque [N m] at which the sensor was at its limit or stuck: the value of every torque of the plateau, or the
/// largest or smallest one where more than `most` of them have it. A torque of two or three values is that of a coarse
/// logger.
std::optional<double> saturated_at(const TorqueLog& log, const Plateau& plateau, double most = 0.5);

/// The time [s] from which a plateau has nearly no torque, below a tenth of what it had. What looks like a start-up is
/// then the measurement, and the rest a sensor or a machine that failed. None where the plateau keeps its torque.
std::optional<double> dies_at(const TorqueLog& log, const Plateau& plateau);

/// What is doubtful in a plateau's torque, in words: clipped at a limit, stuck for a while, coarse steps of the
/// resolution, spikes, a drift.
std::vector<std::string> plateau_faults(const TorqueLog& log, const Plateau& plateau);

/// Why a log of which no observation can be made may be read wrongly: its speed is 0 throughout, or its columns of
/// torque and speed are exchanged (the torque takes few values, as a set speed does, and the speed takes many). The
/// remedy names the options of `demcal observe`. None where neither is so.
std::optional<Problem> doubted_columns(const TorqueLog& log);

/// The share of a plateau from which a start-up that was left out is named.
inline constexpr double long_start_up = 0.2;

/// What was left out of a plateau, in words: spikes, and a long start-up.
std::vector<std::string> plateau_notes(const TorqueLog& log, const Plateau& plateau);

}  // namespace data
