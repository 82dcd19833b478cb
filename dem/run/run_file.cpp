#include "dem/run/run_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hdf5.hpp"
#include "data/origin.hpp"
#include "data/provenance.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/outputs.hpp"
#include "dem/run/state_file.hpp"

namespace dem {
namespace {

constexpr std::int64_t format = 3;
constexpr const char* remake = "remove it, and the run is made again";

template <class AnySeries, class Visit>
void each_series(AnySeries& s, Visit&& visit) {
  visit("time", "s", s.time);
  for (const MeanOutput& output : mean_outputs()) visit(output.name, output.unit, s.*output.series);
  visit("look_time", "s", s.look_time);
  visit("bond_order", "1", s.bond_order);
}

template <class AnySeries, class Visit>
void each_window_series(AnySeries& s, Visit&& visit) {
  visit("window_time", "s", s.window_time);
  for (const CameraOutput& output : camera_outputs()) visit(output.name, output.unit, s.*output.series);
}

/// Visits the series that only rigs with two channels have.
template <class AnySeries, class Visit>
void each_channel_series(AnySeries& s, Visit&& visit) {
  visit("mixing_index", "1", s.mixing_index);
  visit("channel_mass", "kg", s.channel_mass);
}

void write_diagnostics(const data::Hdf5Group& group, const Diagnostics& g) {
  const Derived& d = g.derived;
  const std::array<std::pair<const char*, double>, 18> numbers{
      {{"sphere_mass_kg", d.mass},
       {"weight_N", d.weight},
       {"length_scale_m", d.length_scale},
       {"pull_off_N", d.pull_off},
       {"wall_pull_off_N", d.wall_pull_off},
       {"bond_number", d.bond},
       {"wall_bond_number", d.wall_bond},
       {"hamaker_J", d.hamaker},
       {"original_hamaker_J", d.original_hamaker},
       {"contact_duration_s", d.contact_duration},
       {"time_step_s", d.time_step},
       {"skin_m", d.skin},
       {"max_overlap_of_radius", g.max_overlap},
       {"simulated_s", g.simulated},
       {"particle_steps_per_second", g.steps_per_second},
       {"state_bytes_per_particle", g.bytes_per_particle},
       {"steps", static_cast<double>(g.steps)},
       {"deep_contacts", static_cast<double>(g.deep_contacts)}}};
  for (const auto& [name, value] : numbers) group.set(name, value);
  group.set("spheres", static_cast<std::int64_t>(d.spheres));
  group.set("rebuilds", static_cast<std::int64_t>(g.rebuilds));
  group.set("threads", static_cast<std::int64_t>(g.threads));
}

void write_state(const data::Hdf5Group& group, const Summary& s) {
  group.set("reached_target", static_cast<std::int64_t>(s.reached_target));
  group.set("state", data::to_text(s.state));
  group.set("why", s.why);
  group.set("ordering", s.ordering);
  group.set("measured_from_s", s.measured_from);
  group.set("turns", s.turns);
  group.write("drift_p", s.drift_p);
}

void read_state(const data::Hdf5Group& group, Summary& s) {
  s.reached_target = group.integer("reached_target") != 0;
  s.state = data::from_text<data::FlowState>(group.text("state")).value_or(data::FlowState::too_short);
  s.why = group.text("why");
  s.ordering = group.text("ordering");
  s.measured_from = group.number("measured_from_s");
  s.turns = group.number("turns");
  s.drift_p = group.read<double>("drift_p").values;
}

void write_series(const data::Hdf5Group& group, const Series& s) {
  const auto write = [&](const char* name, const char* unit, const std::vector<double>& values) {
    group.write(name, values);
    group.set("unit", unit, name);
  };
  each_series(s, write);
  if (!s.window_time.empty()) each_window_series(s, write);
  if (!s.mixing_index.empty()) each_channel_series(s, write);
}

Series read_series(const data::Hdf5Group& group) {
  Series s;
  const auto read_if_there = [&](const char* name, const char*, std::vector<double>& values) {
    if (group.has(name)) values = group.read<double>(name).values;
  };
  each_window_series(s, read_if_there);
  each_channel_series(s, read_if_there);
  each_series(s, [&](const char* name, const char*, std::vector<double>& values) {
    // A run of before there was this output.
    if (group.has(name))
      values = group.read<double>(name).values;
    else
      values.assign(s.time.size(), std::numeric_limits<double>::quiet_NaN());
  });
  return s;
}

/// Writes a column of each number of the means, one row per output that the run saw.
void write_means(const data::Hdf5Group& group, const RunResult& result) {
  std::vector<std::string> names, units;
  constexpr std::array heads{"mean",    "standard_error", "sd",    "integrated_time", "effective_samples",
                             "dropped", "reliable",       "drifts"};
  std::array<std::vector<double>, heads.size()> columns;
  for (std::size_t k = 0; k < result.summary.mean.size(); ++k) {
    const data::SeriesMean& m = result.summary.mean[k];
    if (k >= outputs().size() - camera_outputs().size() && result.series.window_time.empty()) break;  // not seen
    names.push_back(outputs()[k].name);
    units.push_back(outputs()[k].unit);
    const std::array<double, heads.size()> row{m.mean,
                                               m.standard_error,
                                               m.sd,
                                               m.integrated_time,
                                               m.effective_samples,
                                               static_cast<double>(m.dropped),
                                               m.reliable ? 1.0 : 0.0,
                                               m.drifts ? 1.0 : 0.0};
    for (std::size_t j = 0; j < row.size(); ++j) columns[j].push_back(row[j]);
  }
  group.write_texts("names", names);
  group.write_texts("units", units);
  for (std::size_t j = 0; j < heads.size(); ++j) group.write(heads[j], columns[j]);
}

/// The means that a file has, by the outputs' names.
struct SavedMeans {
  std::vector<std::string> names;
  std::vector<data::SeriesMean> mean;

  /// The mean of an output; not a number where the file is of before there was this output.
  data::SeriesMean of(const std::string& name) const {
    const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return k < names.size() ? mean[k] : data::SeriesMean{.mean = none, .standard_error = none, .reliable = false};
  }
};

SavedMeans read_means(const data::Hdf5Group& group, const std::string& path) {
  const auto column = [&](const char* name) { return group.read<double>(name).values; };
  const std::vector<double> mean = column("mean"), error = column("standard_error"), sd = column("sd"),
                            time = column("integrated_time"), samples = column("effective_samples"),
                            dropped = column("dropped"), reliable = column("reliable");
  // Files of before there was `drifts` do not tell it from a series that is too short.
  const bool told = group.has("drifts");
  const std::vector<double> drifts = column(told ? "drifts" : "reliable");
  for (const std::vector<double>* other : {&error, &sd, &time, &samples, &dropped, &reliable, &drifts})
    if (other->size() != mean.size())
      throw data::InputError(
          data::ExitStatus::bad_data,
          {path + ": /summary", fmt::format("has columns of {} and {} values", mean.size(), other->size()), remake});
  SavedMeans saved{.names = group.read_texts("names"), .mean = {}};
  saved.names.resize(std::min(saved.names.size(), mean.size()));
  for (std::size_t k = 0; k < mean.size(); ++k)
    saved.mean.push_back({.mean = mean[k],
                          .standard_error = error[k],
                          .sd = sd[k],
                          .integrated_time = time[k],
                          .effective_samples = samples[k],
                          .dropped = static_cast<std::size_t>(dropped[k]),
                          .reliable = reliable[k] != 0.0,
                          .drifts = told ? drifts[k] != 0.0 : reliable[k] == 0.0});
  return saved;
}

/// A count that is kept as a real number.
std::uint64_t read_count(const data::Hdf5Group& group, const std::string& name) {
  const double value = group.number(name);
  return value >= 0.0 && value < 0x1p63 ? static_cast<std::uint64_t>(value) : 0;
}

RunStatus read_status(const data::Hdf5Group& file, const std::string& path) {
  const std::int64_t value = file.integer("status");
  if (value < 0 || value > static_cast<std::int64_t>(RunStatus::failed))
    throw data::InputError(data::ExitStatus::bad_data,
                           {path + ": @status", fmt::format("{} is not how a run ends", value), remake});
  return static_cast<RunStatus>(value);
}

Diagnostics read_diagnostics(const data::Hdf5Group& group) {
  Diagnostics g;
  g.steps = read_count(group, "steps");
  g.rebuilds = static_cast<std::uint64_t>(group.integer("rebuilds"));
  g.deep_contacts = read_count(group, "deep_contacts");
  g.max_overlap = group.number("max_overlap_of_radius");
  g.simulated = group.number("simulated_s");
  g.steps_per_second = group.number("particle_steps_per_second");
  g.threads = static_cast<int>(group.integer("threads"));
  return g;
}

std::uint64_t read_seed(const data::Hdf5Group& file, const std::string& path) {
  const std::string text = file.text("seed");
  std::uint64_t seed = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || rest != text.data() + text.size() || text.empty())
    throw data::InputError(data::ExitStatus::bad_data,
                           {path + ": @seed", fmt::format("'{}' is not a seed", text), remake});
  return seed;
}

}  // namespace

void write_run(const std::string& path, const Case& c, const RunResult& result) {
  data::write_atomically(path, [&](const std::string& temporary) {
    const data::Hdf5Group file = data::create_hdf5(temporary);
    file.set("format", format);
    for (const auto& [name, value] : data::provenance()) file.set(name, value);
    file.set("isa", result.diagnostics.isa);
    file.set("seed", fmt::format("{}", result.seed));
    file.set("status", static_cast<std::int64_t>(result.status));
    file.set("reason", result.reason);
    file.set("material", c.material.name);
    file.set("settings", settings_text(c));
    file.set("rule", std::int64_t{look_rule_version});
    file.set("cpu_seconds", result.summary.cpu_seconds);
    file.write_texts("warnings", result.warnings);
    write_series(file.create_group("series"), result.series);
    const data::Hdf5Group summary = file.create_group("summary");
    write_means(summary, result);
    write_state(summary, result.summary);
    write_diagnostics(file.create_group("diagnostics"), result.diagnostics);
    write_checkpoint(file.create_group("checkpoint"), result.checkpoint);
    file.flush();
  });
}

SavedRun read_run(const std::string& path) {
  data::require_file(path);
  data::require_unchanged(path, remake, data::Strict::yes);
  const data::Hdf5Group file = data::open_hdf5(path);
  if (!file.has_attribute("format") || file.integer("format") != format)
    throw data::InputError(data::ExitStatus::bad_data, {path, "is not a run of this program", remake});
  SavedRun saved;
  RunResult& r = saved.result;
  saved.settings = file.text("settings");
  if (file.has_attribute("rule")) saved.rule = static_cast<int>(file.integer("rule"));
  r.seed = read_seed(file, path);
  r.status = read_status(file, path);
  r.reason = file.text("reason");
  r.warnings = file.read_texts("warnings");
  r.summary.cpu_seconds = file.number("cpu_seconds");
  r.series = read_series(file.group("series"));
  const data::Hdf5Group summary = file.group("summary");
  const SavedMeans means = read_means(summary, path);
  saved.outputs = means.names;
  if (!means.mean.empty())
    for (const Output& wanted : outputs()) r.summary.mean.push_back(means.of(wanted.name));
  read_state(summary, r.summary);
  r.checkpoint = read_checkpoint(file.group("checkpoint"));
  r.checkpoint.series = r.series;
  r.diagnostics = read_diagnostics(file.group("diagnostics"));
  r.diagnostics.isa = file.text("isa");
  return saved;
}

}  // namespace dem
