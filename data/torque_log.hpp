#pragma once
// A raw torque log, and the means at each of its constant speeds.
//
// A log is what a mixer's logger wrote: time, torque and speed of every sample, with the motor starting, ramps between
// the speeds, single bad samples and stops. A plateau is a stretch of constant speed; its mean torque, with the error
// that the correlation of its samples leaves (mean_with_error), is one observation.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data/time_series.hpp"
#include "data/unit.hpp"

namespace data {

/// The column in which a log keeps a quantity. A header may carry the unit: "Torque [N m]", "time (s)", "speed / rpm".
struct LogColumn {
  std::string name;  ///< name without the unit; upper and lower case count as the same
  std::string unit;  ///< "" : the header's, or, where that has none, `usual`
  std::string usual;
  std::vector<std::string> also;  ///< other names, looked for where there is no `name`
};

struct LogColumns {
  LogColumn time{.name = "time",
                 .unit = "",
                 .usual = "s",
                 .also = {"timestamp", "x_value",     "time stamp", "datetime",       "date time", "elapsed time",
                          "zeit",      "zeitstempel", "temps",      "tiempo",         "tempo",     "czas",
                          "čas",       "Čas",         "timestring", "unix timestamp", "unix time", "epoch",
                          "日時",      "時刻",        "日付/時刻",  "_time",          "tijd",      "время",
                          "Время",     "时间",        "時間",       "시간",           "t"}};
  /// No usual unit: it must be said somewhere.
  LogColumn torque{.name = "torque",
                   .unit = "",
                   .usual = "",
                   .also = {"drehmoment", "moment", "couple", "par", "coppia", "koppel", "момент", "Момент",
                            "крутящий момент", "Крутящий момент", "扭矩", "转矩", "トルク", "토크", "m"}};
  LogColumn speed{.name = "rpm",
                  .unit = "",
                  .usual = "rpm",
                  .also = {"speed",    "rotational speed", "rotation speed", "velocity", "angular velocity",
                           "drehzahl", "vitesse",          "velocidad",      "velocità", "prędkość",
                           "otáčky",   "Otáčky",           "toerental",      "скорость", "Скорость",
                           "обороты",  "Обороты",          "转速",           "轉速",     "回転数",
                           "回転速度", "회전수",           "속도",           "omega",    "n"}};
  std::optional<double> constant_speed;  ///< rad/s, speed of a log that has no column for it
  std::optional<double> rate;            ///< samples per second (1/s), whatever their stamps say
};

/// Samples in SI, in the order of time.
struct TorqueLog {
  std::string file;
  Unit torque_unit, speed_unit;       ///< the log's own
  std::vector<double> time;           ///< s
  std::vector<double> torque;         ///< N m
  std::vector<double> speed;          ///< rad/s
  std::size_t missing = 0;            ///< samples left out because a field was empty or NaN
  std::size_t missing_torque = 0;     ///< those of them whose torque was
  std::vector<std::string> took;      ///< how the file was read, where it is not plain CSV in seconds
  std::vector<std::string> notes;     ///< what was assumed of it, in words: the unit of its times
  std::vector<std::string> warnings;  ///< what is doubtful in its fields, in words: a meter beyond its range
  double interval = 0.0;              ///< s, median between samples
  double uneven_share = 0.0;          ///< share of the intervals that differ from the median by more than a fifth

  /// Whether means are taken over time, each sample counting until the next one, and not over samples.
  bool uneven() const { return uneven_share > 0.05 && interval > 0.0; }
};

/// Reads a log. Times are numbers with a unit, times of day or dates with times; those that start again at midnight go
/// on, and samples that share a stamp are spread evenly (data/log_times.hpp). Times of any clock count from the first.
/// Numbers without a unit are seconds where they can be; that stands in `notes`. Throws InputError: 66 missing; 65
/// missing column, unknown unit, a time that runs backwards, no samples.
TorqueLog read_torque_log(const std::string& path, const LogColumns& columns = {});

struct PlateauOptions {
  double tolerance = 0.02;   ///< share of the plateau's speed by which a sample may differ from it
  double shortest = 5.0;     ///< s, shortest plateau; shorter stretches are ramps
  double dead_time = 0.0;    ///< s dropped at the front of each plateau, before start-up is looked for
  double from = -INFINITY;   ///< s, the part of the log that is used
  double to = INFINITY;      ///< s
  bool spikes_count = true;  ///< spikes count in mean and error (SeriesOptions)
};

struct Plateau {
  std::size_t first = 0, count = 0;    ///< samples of constant speed
  std::size_t used_from = 0;           ///< the first sample after dead time and start-up
  bool ramp = false;                   ///< the speed changes all the time, slowly: no plateau
  double speed = 0.0, speed_sd = 0.0;  ///< rad/s, mean and standard deviation over the samples used
  double off_speed = 0.0;              ///< share of the samples used that lie off the speed by more than the tolerance
  double speed_step = 0.0;             ///< rad/s, step of the tachometer; its rounding is in speed_sd
  SeriesMean torque;                   ///< N m

  /// Number of uncorrelated samples that would tell as much: an estimate, at most the samples used.
  double independent_samples() const {
    return std::min(torque.effective_samples, static_cast<double>(first + count - used_from));
  }
};

/// The speed [rad/s] at which and below which the machine counts as standing still: five times the tachometer's scatter
/// there, but no less than a five hundredth and no more than a hundredth of the log's largest speed.
double standstill_speed(const TorqueLog& log);

/// The plateaus in the order of time. A standstill is no plateau.
std::vector<Plateau> find_plateaus(const TorqueLog& log, const PlateauOptions& options = {});

/// The plateaus, and among them the pieces of slow ramps.
std::vector<Plateau> find_stretches(const TorqueLog& log, const PlateauOptions& options = {});

/// A mean with its standard error, SI.
struct MeanTorque {
  double value = 0.0, error = 0.0;
};

/// Mean and error of the torque of a hold. The error is that of the integrated time, but comes from the slowest modes
/// (steadiness.hpp) in three cases.
/// Of few independent samples the integrated time is hardly known: means of series with 20, 30 and 50 lie 1.35, 1.2 and
/// 1.1 errors from the truth, and 1.2, 1.1 and 1.05 by modes. Where the torque hums, at the mains' or the blade's
/// frequency, Sokal's window closes on the hum, and the error of what is slower is lost (a factor of 3 to 11). So it
/// does on fast noise over a slow wander (a factor of 2 to 3: of 90 % intervals 45 to 73 hold, and 87 to 89 so): there
/// the modes have clearly more power than the integrated time says. A wander so slow that the modes do not know it
/// either leaves the mean not `reliable`.
SeriesMean mean_of_hold(std::span<const double> torque, bool spikes_count = true);

/// The idle torque at a speed, from the plateaus of a log of the empty machine: the mean, weighted by the errors, over
/// the plateaus within `tolerance` of the speed; none where there is no such plateau.
std::optional<MeanTorque> idle_at(const std::vector<Plateau>& idle, double speed, double tolerance);

}  // namespace data
