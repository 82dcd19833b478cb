// demcal observe: a raw torque log to observations, one row per plateau of constant speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/observe_figure.hpp"
#include "cli/observe_files.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/file_name.hpp"
#include "data/hash.hpp"
#include "data/log_faults.hpp"
#include "data/number_text.hpp"
#include "data/origin.hpp"
#include "data/torque_log.hpp"
#include "data/unit_text.hpp"
#include "uq/findings/wording.hpp"
#include "uq/report/gnuplot.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

constexpr double all = INFINITY;

struct Window {
  std::vector<double> seconds;  ///< none, or from and to
  double from() const { return seconds.empty() ? -all : seconds[0]; }
  double to() const { return seconds.empty() ? all : seconds[1]; }
};

struct ObserveOptions {
  Common common;
  std::string log, out, idle_log, unit, output = "torque", control = "rpm";
  data::LogColumns columns;
  data::PlateauOptions plateaus;
  Window window, idle_window;
  std::optional<double> constant_speed;    ///< in rpm or --rpm-unit
  std::optional<double> idle, idle_error;  ///< in the log's unit of torque
};

[[noreturn]] void refuse(data::ExitStatus status, const std::string& place, const std::string& what,
                         const std::string& remedy) {
  throw data::InputError(status, data::Problem{place, what, remedy});
}

/// What is taken off: nothing, one value for all rows, or the empty machine's torque at each speed.
struct Idle {
  enum class Kind { none, value, log } kind = Kind::none;
  std::vector<data::MeanTorque> at;  ///< SI, by plateau
};

Idle find_idle(const ObserveOptions& options, const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus) {
  Idle idle;
  const bool from_log = !options.idle_log.empty() || !options.idle_window.seconds.empty();
  if (options.idle && from_log)
    refuse(data::ExitStatus::usage, "--idle", "and a log of the idle torque contradict each other", "give one of them");
  if (options.idle_error && !options.idle)
    refuse(data::ExitStatus::usage, "--idle-error", "has no value that it is the error of", "give --idle, too");
  if (options.idle) {
    idle.kind = Idle::Kind::value;
    const data::MeanTorque value{log.torque_unit.to_si(*options.idle),
                                 log.torque_unit.factor * options.idle_error.value_or(0.0)};
    idle.at.assign(plateaus.size(), value);
  } else if (from_log) {
    idle.kind = Idle::Kind::log;
    data::TorqueLog empty = options.idle_log.empty() ? log : data::read_torque_log(options.idle_log, options.columns);
    if (!options.idle_log.empty())
      for (const std::string& note : empty.notes) say(options.common, fmt::format("note: {}: {}", empty.file, note));
    if (!options.idle_log.empty())
      for (const std::string& words : empty.warnings)
        say(options.common, fmt::format("warning: {}: {}", empty.file, words));
    if (!options.idle_log.empty())
      for (const std::string& words : data::remove_no_values(empty))
        say(options.common, fmt::format("warning: {}: {}", empty.file, words));
    data::PlateauOptions part = options.plateaus;
    part.from = options.idle_window.from();
    part.to = options.idle_window.to();
    const std::vector<data::Plateau> found = data::find_plateaus(empty, part);
    for (const data::Plateau& plateau : plateaus) {
      const auto value = data::idle_at(found, plateau.speed, 2.0 * options.plateaus.tolerance);
      if (!value) {
        std::string speeds;
        for (const data::Plateau& one : found)
          speeds += fmt::format("{}{:.4g}", speeds.empty() ? "" : ", ", log.speed_unit.from_si(one.speed));
        refuse(
            data::ExitStatus::bad_data, empty.file,
            fmt::format("the empty machine was not run at {:.4g} {} (its plateaus: {})",
                        log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, speeds.empty() ? "none" : speeds),
            "log it at every speed of the measurement, or give one value with --idle");
      }
      idle.at.push_back(*value);
    }
  }
  return idle;
}

/// Of one row, without the idle torque. A value that is taken off every row has an error common to all, which is stated
/// beside the rows; that of a log at each speed is the row's own.
data::MeanTorque observed_torque(const data::Plateau& plateau, const Idle& idle, std::size_t i) {
  data::MeanTorque found{plateau.torque.mean, plateau.torque.standard_error};
  if (idle.kind != Idle::Kind::none) found.value -= idle.at[i].value;
  if (idle.kind == Idle::Kind::log) found.error = std::hypot(found.error, idle.at[i].error);
  return found;
}

/// What the meter reads at standstill, where no idle torque is taken off and it is more than the rows' errors allow.
std::string standstill_reading(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                               const data::PlateauOptions& options) {
  const double standstill = data::standstill_speed(log);
  double least_error = INFINITY;
  for (const data::Plateau& plateau : plateaus) least_error = std::min(least_error, plateau.torque.standard_error);
  const auto stands = [&](std::size_t i) {
    return i < log.time.size() && std::abs(log.speed[i]) <= standstill && log.time[i] >= options.from &&
           log.time[i] <= options.to;
  };
  std::vector<std::string> readings;
  data::SeriesMean first;
  bool matters = false, zero_moves = false;
  for (std::size_t begin = 0; begin < log.time.size(); ++begin) {
    if (!stands(begin)) continue;
    std::size_t last = begin;
    while (stands(last + 1)) ++last;
    if (log.time[last] - log.time[begin] >= options.shortest) {
      const data::SeriesMean zero = data::mean_of_hold({log.torque.data() + begin, last - begin + 1});
      matters = matters || std::abs(zero.mean) > 3.0 * std::hypot(zero.standard_error, least_error);
      if (readings.empty()) first = zero;
      zero_moves = zero_moves || std::abs(zero.mean - first.mean) >
                                     5.0 * std::hypot(zero.standard_error, first.standard_error, least_error);
      readings.push_back(fmt::format("{:.4g} +- {:.2g} {} from {:.4g} s on", log.torque_unit.from_si(zero.mean),
                                     zero.standard_error / log.torque_unit.factor, log.torque_unit.symbol,
                                     log.time[begin]));
    }
    begin = last;
  }
  if (!matters) return {};
  if (zero_moves)
    return fmt::format(
        "at standstill the meter reads {}: its zero moves, and no one value can be taken off. Read the empty machine "
        "before and after each speed, or state what it may be off by (common_error)",
        fmt::join(readings, ", "));
  return fmt::format(
      "at standstill the meter reads {}, and nothing is taken off: if that is its zero, and not powder that "
      "leans on the mixer, take it off (--idle {:.4g})",
      fmt::join(readings, ", "), log.torque_unit.from_si(first.mean));
}

std::vector<std::string> warnings_of(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                                     const Idle& idle) {
  std::vector<std::string> warnings;
  for (const data::Plateau& plateau : plateaus)
    for (std::string& fault : data::plateau_faults(log, plateau)) warnings.push_back(std::move(fault));
  std::size_t negative = 0;
  for (std::size_t i = 0; i < plateaus.size(); ++i) negative += observed_torque(plateaus[i], idle, i).value < 0.0;
  if (negative > 0)
    warnings.push_back(fmt::format("{} negative: is the sign of the sensor right{}?",
                                   negative == plateaus.size()
                                       ? "every torque is"
                                       : fmt::format("{} of {} torques are", negative, plateaus.size()),
                                   idle.kind == Idle::Kind::none ? "" : ", and is so much idle torque meant"));
  if (log.missing > 0)
    warnings.push_back(fmt::format(
        "{} samples without all three values are left out: where the sensor was beyond its range then, means are too "
        "small",
        log.missing));
  for (const data::Plateau& plateau : plateaus)
    if (!plateau.torque.reliable)
      warnings.push_back(fmt::format(
          "{:.4g} {} at {:.4g} s: too short for its correlation ({:.0f} independent samples), or still drifting: its "
          "error is too small; measure longer",
          log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first],
          plateau.torque.effective_samples));
  return warnings;
}

/// A unit that a study reads, too: the log's own, or N m where that is a spelling of instruments.
data::Unit unit_of_studies(const data::Unit& unit) {
  try {
    if (data::convertible(unit.symbol, "N m")) return data::parse_unit(unit.symbol);
  } catch (const std::invalid_argument&) {
  }
  return data::parse_unit("N m");
}

/// A name within a line of comment.
std::string in_comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

/// One row per plateau; beside the columns that a study reads, what the mean rests on. Names are plain, for programs that
/// look for them; the comment of units is read also as a spreadsheet saves it again.
std::string to_csv(const ObserveOptions& options, const data::TorqueLog& log,
                   const std::vector<data::Plateau>& plateaus, const Idle& idle, const data::Unit& unit) {
  std::string text = fmt::format("# {}\n# from {} (XXH3 {}), by demcal observe\n", data::blank_mark(),
                                 in_comment(fs::path(options.log).filename().string()), data::hash_file(options.log));
  text += fmt::format(
      "# units: {} [{}], {} [{}]; seconds: length of the part used; independent: its uncorrelated samples\n",
      options.control, log.speed_unit.symbol, options.output, unit.symbol);
  if (idle.kind == Idle::Kind::value) {
    text +=
        fmt::format("# idle torque {:.6g} {} taken off every row", unit.from_si(idle.at.front().value), unit.symbol);
    text += options.idle_error
                ? fmt::format("; its error is common to all of them: common_error = \"{:.3g} {}\" in [[observe]]\n",
                              idle.at.front().error / unit_of_studies(unit).factor, unit_of_studies(unit).symbol)
                : std::string("\n");
  } else if (idle.kind == Idle::Kind::log) {
    text +=
        fmt::format("# idle torque of the empty machine taken off at each speed ({}); its error is in {}_se\n",
                    options.idle_log.empty() ? "same log" : in_comment(fs::path(options.idle_log).filename().string()),
                    options.output);
  }
  text += fmt::format("{},{},{},idle,from_s,seconds,independent,{}\n", data::csv_field(options.control),
                      data::csv_field(options.output), data::csv_field(options.output + "_se"),
                      data::csv_field(options.control + "_sd"));
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const data::Plateau& plateau = plateaus[i];
    const data::MeanTorque found = observed_torque(plateau, idle, i);
    const double off = idle.kind == Idle::Kind::none ? 0.0 : idle.at[i].value;
    text += fmt::format("{:.6g},{:.6g},{:.3g},{:.6g},{:.6g},{:.6g},{:.0f},{:.3g}\n",
                        log.speed_unit.from_si(plateau.speed), found.value / unit.factor, found.error / unit.factor,
                        off / unit.factor, log.time[plateau.used_from],
                        log.time[plateau.first + plateau.count - 1] - log.time[plateau.used_from],
                        plateau.torque.effective_samples, plateau.speed_sd / log.speed_unit.factor);
  }
  return text;
}

/// Takes the pieces of slow ramps out of the plateaus; returns their length, s.
double take_ramps(const data::TorqueLog& log, std::vector<data::Plateau>& plateaus,
                  std::vector<std::string>& warnings) {
  double seconds = 0.0;
  std::erase_if(plateaus, [&](const data::Plateau& plateau) {
    if (plateau.ramp) seconds += log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
    return plateau.ramp;
  });
  if (seconds > 0.0)
    warnings.push_back(
        fmt::format("{:.4g} s in which the speed changes slowly are no constant speed and are left out", seconds));
  return seconds;
}

/// Where less than two thirds of the turning belong to a plateau: by how much, and the remedy.
std::string left_over(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                      const data::PlateauOptions& options, double ramps) {
  const double standstill = data::standstill_speed(log);
  double turning = 0.0, held = 0.0;
  for (std::size_t i = 1; i < log.time.size(); ++i)
    if (std::abs(log.speed[i]) > standstill && log.time[i] >= options.from && log.time[i] <= options.to &&
        log.time[i] - log.time[i - 1] <= std::max(4.0 * log.interval, options.shortest))  // else nothing was logged
      turning += log.time[i] - log.time[i - 1];
  for (const data::Plateau& plateau : plateaus)
    held += log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
  if (turning - ramps < 1.5 * held) return {};
  return fmt::format(
      "{:.3g} s of {:.3g} s of turning belong to no speed that stays within {:g} %: where the tachometer scatters by "
      "more, widen that (--tolerance {:g})",
      turning - held, turning, 100.0 * options.tolerance, 500.0 * options.tolerance);
}

data::ExitStatus observe(ObserveOptions options) {
  const fs::path out = options.out.empty() ? fs::path(options.log).stem().string() + "-observed.csv" : options.out;
  check_observe_targets(out, {options.log, options.idle_log});
  if (options.constant_speed) {
    const std::string& symbol = options.columns.speed.unit;
    const auto unit = data::unit_meant(symbol.empty() ? "rpm" : symbol, "rpm");
    if (!unit)
      refuse(data::ExitStatus::usage, "--rpm-unit", fmt::format("'{}' is not a unit of speed", symbol), "like rpm");
    options.columns.constant_speed = unit->to_si(*options.constant_speed);
  }
  data::TorqueLog log = data::read_torque_log(options.log, options.columns);
  if (!log.took.empty()) say(options.common, fmt::format("{}: read as: {}", log.file, fmt::join(log.took, ", ")));
  for (const std::string& note : log.notes) say(options.common, "note: " + note);
  std::vector<std::string> warnings = log.warnings;
  for (std::string& words : data::remove_no_values(log)) warnings.push_back(std::move(words));
  options.plateaus.from = options.window.from();
  options.plateaus.to = options.window.to();
  std::vector<data::Plateau> plateaus = data::find_stretches(log, options.plateaus);
  const double ramps = take_ramps(log, plateaus, warnings);
  if (!options.idle_window.seconds.empty() && options.idle_log.empty())  // the machine was still empty there
    std::erase_if(plateaus, [&](const data::Plateau& plateau) {
      return log.time[plateau.first] <= options.idle_window.to() &&
             log.time[plateau.first + plateau.count - 1] >= options.idle_window.from();
    });
  if (plateaus.empty() && ramps > 0.0)
    refuse(data::ExitStatus::bad_data, log.file,
           fmt::format("the speed changes slowly all the time ({:.4g} s of it): there is no constant speed", ramps),
           "hold each speed for a while, or cut out with --window what is constant");
  const std::size_t before = plateaus.size();
  std::erase_if(plateaus, [&](const data::Plateau& plateau) {
    const std::optional<double> limit = data::saturated_at(log, plateau);
    if (!limit) return false;
    warnings.push_back(
        fmt::format("{:.4g} {} at {:.4g} s: the torque stays at {:.5g} {}: the sensor is saturated or stuck there, "
                    "and no observation is made of it",
                    log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first],
                    log.torque_unit.from_si(*limit), log.torque_unit.symbol));
    return true;
  });
  if (plateaus.empty() && before > 0)
    refuse(data::ExitStatus::bad_data, log.file, warnings.back(), "check the sensor's range");
  if (plateaus.empty())
    refuse(data::ExitStatus::bad_data, log.file,
           fmt::format("has no stretch of {:g} s in which the speed stays within {:g} %", options.plateaus.shortest,
                       100.0 * options.plateaus.tolerance),
           "look at the log; then try a smaller --shortest or a larger --tolerance");
  const data::Unit unit = options.unit.empty() ? log.torque_unit : data::parse_unit(options.unit);
  const Idle idle = find_idle(options, log, plateaus);

  data::write_atomically(out.string(), to_csv(options, log, plateaus, idle, unit), data::Changed::refuse);
  std::vector<double> off;
  for (const data::MeanTorque& one : idle.at) off.push_back(one.value);
  const fs::path folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  uq::draw(log_figure(log, plateaus, off, unit, data::file_name(out.stem().string())), folder.string(), {});

  nlohmann::json json{{"observations", out.string()}, {"rows", nlohmann::json::array()}};
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const data::Plateau& plateau = plateaus[i];
    const data::MeanTorque found = observed_torque(plateau, idle, i);
    const double mean = found.value / unit.factor, error = found.error / unit.factor;
    const uq::Rounding rounding = uq::rounding_of(mean, error);
    const auto shown = [&](double value) { return uq::format_value(value, rounding, "", uq::Typography::ascii); };
    answer(options.common,
           fmt::format("{:>8.4g} {}: {} +- {} {} ({:.4g} s, {:.0f} independent samples)",
                       log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, shown(mean), shown(error),
                       unit.symbol, log.time[plateau.first + plateau.count - 1] - log.time[plateau.used_from],
                       plateau.torque.effective_samples));
    json["rows"].push_back({{options.control, log.speed_unit.from_si(plateau.speed)},
                            {options.control + "_unit", log.speed_unit.symbol},
                            {options.output, mean},
                            {options.output + "_se", error},
                            {"unit", unit.symbol},
                            {"from_s", log.time[plateau.used_from]},
                            {"left_out_s", log.time[plateau.used_from] - log.time[plateau.first]}});
  }
  if (idle.kind == Idle::Kind::none)
    if (std::string zero = standstill_reading(log, plateaus, options.plateaus); !zero.empty())
      warnings.push_back(std::move(zero));
  for (std::string& warning : warnings_of(log, plateaus, idle)) warnings.push_back(std::move(warning));
  std::vector<std::string> notes;
  for (const data::Plateau& plateau : plateaus)
    for (std::string& note : data::plateau_notes(log, plateau)) notes.push_back(std::move(note));
  if (std::string note = left_over(log, plateaus, options.plateaus, ramps); !note.empty())
    notes.push_back(std::move(note));
  for (const std::string& note : notes) say(options.common, "note: " + note);
  for (const std::string& warning : warnings) say(options.common, "warning: " + warning);
  answer(options.common, fmt::format("{}: {} (picture: {})", data::counted(plateaus.size(), "observation"),
                                     out.string(), observe_pictures(out).front().string()));
  json["warnings"] = warnings;
  notes.insert(notes.begin(), log.notes.begin(), log.notes.end());
  json["notes"] = notes;
  print_json(options.common, json);
  return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

void add_window(CLI::App& command, const std::string& name, Window& window, const std::string& help) {
  command.add_option(name, window.seconds, help)
      ->expected(2)
      ->check(number_in(-1e15, 1e15, "a number of seconds"))
      ->type_name("FROM TO");
}

}  // namespace

Action add_observe(CLI::App& program) {
  const auto options = std::make_shared<ObserveOptions>();
  CLI::App* command = program.add_subcommand(
      "observe", "a raw torque log (time, torque, rpm) to observations: one mean with its error per constant speed");
  command->footer("Example: demcal observe bench-log.csv --idle-log empty.csv --out observed/bench.csv");
  command
      ->add_option("LOG", options->log,
                   "the log, a CSV with a header; units in the header ('torque [N m]') or by option")
      ->required();
  command->add_option("--out", options->out, "the observations; the picture goes beside (default: ./LOG-observed.csv)");
  const auto column = [&](const std::string& name, data::LogColumn& wanted) {
    command->add_option_function<std::string>(
        "--" + name,
        [&wanted](const std::string& text) {
          wanted.name = text;
          wanted.also.clear();
        },
        fmt::format("column of the {} (default: {})", name, wanted.name));
    command->add_option("--" + name + "-unit", wanted.unit, "its unit, instead of the header's");
  };
  column("time", options->columns.time);
  column("torque", options->columns.torque);
  column("rpm", options->columns.speed);
  command
      ->add_option_function<double>(
          "--constant-speed", [options](double value) { options->constant_speed = value; },
          "the speed of a log without a column for it, in rpm or --rpm-unit")
      ->check(number_in(-1e6, 1e6, "a speed"));
  command
      ->add_option_function<double>(
          "--rate", [options](double value) { options->columns.rate = value; },
          "samples per second, evenly: the log's stamps are not used")
      ->check(number_in(1e-6, 1e9, "a number above 0"));
  command->add_option("--unit", options->unit, "unit of the torque written (default: the log's)")
      ->check([](const std::string& unit) {
        try {
          if (data::parse_unit(unit); data::convertible(unit, "N m")) return std::string();
        } catch (const std::invalid_argument&) {
        }
        return "'" + unit + "' is not a unit of torque, like 'mN m'";
      });
  command->add_option("--control", options->control, "name of the speed in the study (default: rpm)");
  command->add_option("--output", options->output, "name of the torque in the study (default: torque)");
  command->add_option("--idle", options->idle, "torque of the empty machine at any speed, in the log's unit; taken off")
      ->check(number_in(-1e30, 1e30, "a finite number (a log of the empty machine is given by --idle-log)"));
  command->add_option("--idle-error", options->idle_error, "its standard error, common to all rows")
      ->check(number_in(0.0, 1e30, "a number from 0"));
  command->add_option("--idle-log", options->idle_log, "a log of the empty machine at the same speeds, instead");
  add_window(*command, "--idle-window", options->idle_window,
             "the seconds of that log, or without --idle-log of LOG, in which the machine was empty");
  add_window(*command, "--window", options->window, "the seconds of LOG that are used (default: all)");
  command
      ->add_option("--dead-time", options->plateaus.dead_time,
                   "seconds dropped after each change of speed (default: 0)")
      ->check(number_in(0.0, 1e12, "a number of seconds from 0"));
  command->add_option("--shortest", options->plateaus.shortest, "seconds; shorter stretches are ramps (default: 5)")
      ->check(number_in(1e-9, 1e12, "a number of seconds above 0"));
  command
      ->add_option_function<double>(
          "--tolerance", [options](double percent) { options->plateaus.tolerance = percent / 100.0; },
          "percent by which a constant speed may vary (default: 2)")
      ->check(number_in(0.01, 50.0, "a number from 0.01 to 50"));
  command->add_flag_callback(
      "--without-spikes", [options] { options->plateaus.spikes_count = false; },
      "samples far from those around them are no torque: they hold the median of these instead");
  command->add_flag("--quiet", options->common.quiet, "no summary");
  command->add_flag("--json", options->common.json, "the result as JSON on stdout, and nothing else there");
  return [options] { return observe(*options); };
}

}  // namespace cli
