// demcal observe: a raw torque log to observations, one row per plateau of constant speed.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/command.hpp"
#include "cli/observe_csv.hpp"
#include "cli/observe_figure.hpp"
#include "cli/observe_files.hpp"
#include "cli/observe_idle.hpp"
#include "cli/observe_options.hpp"
#include "cli/observe_warnings.hpp"
#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/file_name.hpp"
#include "data/log_faults.hpp"
#include "data/number_text.hpp"
#include "data/torque_log.hpp"
#include "data/unit_text.hpp"
#include "uq/findings/wording.hpp"
#include "uq/report/gnuplot.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

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

/// The plateaus of which observations are made.
struct Observed {
  std::vector<data::Plateau> plateaus;
  double ramps = 0.0;                 ///< s in which the speed changed slowly
  double refused = 0.0;               ///< s of holds of which no observation is made
  std::vector<std::string> warnings;  ///< warnings of what was left out
};

/// Throws InputError (65) where none is left.
Observed find_observed(const ObserveOptions& options, const data::TorqueLog& log) {
  Observed found;
  std::vector<data::Plateau>& plateaus = found.plateaus;
  std::vector<std::string>& warnings = found.warnings;
  plateaus = data::find_stretches(log, options.plateaus);
  found.ramps = take_ramps(log, plateaus, warnings);
  if (!options.idle_window.seconds.empty() && options.idle_log.empty())  // the machine was still empty there
    std::erase_if(plateaus, [&](const data::Plateau& plateau) {
      return log.time[plateau.first] <= options.idle_window.to() &&
             log.time[plateau.first + plateau.count - 1] >= options.idle_window.from();
    });
  if (plateaus.empty() && found.ramps > 0.0)
    data::refuse_data(
        log.file,
        fmt::format("the speed changes slowly all the time ({:.4g} s of it): there is no constant speed", found.ramps),
        fmt::format("hold each speed for a while, or cut out with --window what is constant; holds of speeds less than "
                    "{:g} % apart are told from each other by a smaller --tolerance",
                    100.0 * options.plateaus.tolerance));
  const std::size_t before = plateaus.size();
  std::erase_if(plateaus, [&](const data::Plateau& plateau) {
    const double held = log.time[plateau.first + plateau.count - 1] - log.time[plateau.first];
    if (const std::optional<double> end = data::dies_at(log, plateau)) {
      warnings.push_back(fmt::format(
          "{:.4g} {} at {:.4g} s: the torque falls to nearly nothing at {:.4g} s and stays there: the sensor or the "
          "machine failed, and no observation is made of it; cut out what is right with --window",
          log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first], *end));
      found.refused += held;
      return true;
    }
    const std::optional<double> limit = data::saturated_at(log, plateau);
    if (!limit) return false;
    warnings.push_back(
        fmt::format("{:.4g} {} at {:.4g} s: the torque stays at {:.5g} {}: the sensor is saturated or stuck there, "
                    "and no observation is made of it",
                    log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, log.time[plateau.first],
                    log.torque_unit.from_si(*limit), log.torque_unit.symbol));
    found.refused += held;
    return true;
  });
  if (plateaus.empty())
    if (const std::optional<data::Problem> columns = data::doubted_columns(log))
      throw data::InputError(data::ExitStatus::bad_data, *columns);
  if (plateaus.empty() && before > 0) data::refuse_data(log.file, warnings.back(), "check the sensor's range");
  if (plateaus.empty())
    data::refuse_data(log.file,
                      fmt::format("has no stretch of {:g} s in which the speed stays within {:g} %",
                                  options.plateaus.shortest, 100.0 * options.plateaus.tolerance),
                      "look at the log; then try a smaller --shortest or a larger --tolerance");
  return found;
}

/// The speed of a log without a column for it [rad/s].
std::optional<double> constant_speed_of(const ObserveOptions& options) {
  if (!options.constant_speed) return {};
  const std::string& symbol = options.columns.speed.unit;
  const auto unit = data::unit_meant(symbol.empty() ? "rpm" : symbol, "rpm");
  if (!unit)
    throw data::InputError(data::ExitStatus::usage,
                           data::Problem{"--rpm-unit", fmt::format("'{}' is not a unit of speed", symbol),
                                         "give one, such as rpm, rad/s or 1/min"});
  return unit->to_si(*options.constant_speed);
}

void check_order(const char* option, const Window& window) {
  if (!(window.from() < window.to()))
    throw data::InputError(data::ExitStatus::usage,
                           {option, fmt::format("begins at {:g} s and ends at {:g} s", window.from(), window.to()),
                            "give the earlier time first"});
}

/// Says an observation on a line, and gives it as JSON.
nlohmann::json say_observation(const ObserveOptions& options, const data::TorqueLog& log, const data::Plateau& plateau,
                               const data::MeanTorque& found, const data::Unit& unit) {
  const double mean = found.value / unit.factor, error = found.error / unit.factor;
  const uq::Rounding rounding = uq::rounding_of(mean, error);
  const auto shown = [&](double value) { return uq::format_value(value, rounding, "", uq::Typography::ascii); };
  answer(options.common,
         fmt::format("{:>8.4g} {}: {} +- {} {} ({:.4g} s, {:.0f} independent samples)",
                     log.speed_unit.from_si(plateau.speed), log.speed_unit.symbol, shown(mean), shown(error),
                     unit.symbol, log.time[plateau.first + plateau.count - 1] - log.time[plateau.used_from],
                     plateau.independent_samples()));
  return {{options.control, log.speed_unit.from_si(plateau.speed)},
          {options.control + "_unit", log.speed_unit.symbol},
          {options.output, mean},
          {options.output + "_se", error},
          {"unit", unit.symbol},
          {"from_s", log.time[plateau.used_from]},
          {"left_out_s", log.time[plateau.used_from] - log.time[plateau.first]}};
}

data::ExitStatus observe(ObserveOptions options) {
  const fs::path out = options.out.empty() ? fs::path(options.log).stem().string() + "-observed.csv" : options.out;
  check_observe_targets(out, {options.log, options.idle_log});
  options.columns.constant_speed = constant_speed_of(options);
  data::TorqueLog log = data::read_torque_log(options.log, options.columns);
  if (!log.took.empty()) say(options.common, fmt::format("{}: read as: {}", log.file, fmt::join(log.took, ", ")));
  for (const std::string& note : log.notes) say(options.common, "note: " + note);
  std::vector<std::string> warnings = log.warnings;
  for (std::string& words : data::remove_no_values(log)) warnings.push_back(std::move(words));
  check_order("--window", options.window);
  check_order("--idle-window", options.idle_window);
  options.plateaus.from = options.window.from();
  options.plateaus.to = options.window.to();
  auto [plateaus, ramps, refused, of_plateaus] = find_observed(options, log);
  for (std::string& words : of_plateaus) warnings.push_back(std::move(words));
  const data::Unit unit = options.unit.empty() ? log.torque_unit : data::parse_unit(options.unit);
  const Idle idle = find_idle(options, log, plateaus);
  warnings.insert(warnings.end(), idle.warnings.begin(), idle.warnings.end());

  data::write_atomically(out.string(), observations_csv(options, log, plateaus, idle, unit), data::Changed::refuse);
  std::vector<double> off;
  for (const data::MeanTorque& one : idle.at) off.push_back(one.value);
  const fs::path folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  uq::draw(log_figure(log, plateaus, off, unit, data::file_name(out.stem().string())), folder.string(), {});

  nlohmann::json json{{"observations", out.string()}, {"rows", nlohmann::json::array()}};
  for (std::size_t i = 0; i < plateaus.size(); ++i)
    json["rows"].push_back(say_observation(options, log, plateaus[i], observed_torque(plateaus[i], idle, i), unit));
  if (idle.kind == Idle::Kind::none)
    if (std::string zero = standstill_reading(log, plateaus, options.plateaus); !zero.empty())
      warnings.push_back(std::move(zero));
  for (std::string& warning : warnings_of(log, plateaus, idle)) warnings.push_back(std::move(warning));
  std::vector<std::string> notes;
  for (const data::Plateau& plateau : plateaus)
    for (std::string& note : data::plateau_notes(log, plateau)) notes.push_back(std::move(note));
  if (std::string note = left_over(log, plateaus, options.plateaus, ramps + refused); !note.empty())
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
