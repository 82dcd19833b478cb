#include "dem/run/run_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <type_traits>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hdf5.hpp"
#include "data/origin.hpp"
#include "data/provenance.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/outputs.hpp"

namespace dem {
namespace {

constexpr std::int64_t format = 3;

/// Calls visit(name, vector) for each vector of the state; rows are plain data.
template <class AnyState, class Visit>
void each_vector(AnyState& s, Visit&& visit) {
  visit("position", s.position);
  visit("motion", s.motion);
  visit("half", s.half);
  visit("load", s.load);
  visit("reference", s.reference);
  visit("id", s.id);
  visit("ghost", s.ghost);
  visit("pair", s.pair);
  visit("partner_load", s.partner_load);
  visit("in_range", s.in_range);
  visit("history_at", s.history_at);
  visit("chunk_first", s.chunk_first);
  visit("chunk_pair", s.chunk_pair);
  visit("chunk_wall", s.chunk_wall);
  visit("halo_owner", s.halo_owner);
  visit("halo_part", s.halo_part);
  visit("wall", s.wall);
  visit("features", s.features);
  visit("feature_gap", s.feature_gap);
}

/// The chunks' pools, one after the other.
template <class Row>
struct Pooled {
  std::vector<Row> rows;
  std::vector<std::uint32_t> free, size;  ///< size: width, rows and places given back of each chunk
};
template <class Row>
Pooled<Row> pooled(const std::vector<Pool<Row>>& pools) {
  Pooled<Row> all;
  for (const Pool<Row>& pool : pools) {
    all.rows.insert(all.rows.end(), pool.rows.begin(), pool.rows.end());
    all.free.insert(all.free.end(), pool.free.begin(), pool.free.end());
    for (const std::size_t size : {std::size_t{pool.width}, pool.rows.size(), pool.free.size()})
      all.size.push_back(static_cast<std::uint32_t>(size));
  }
  return all;
}
template <class Row>
std::vector<Pool<Row>> unpooled(const Pooled<Row>& all) {
  std::vector<Pool<Row>> pools;
  auto row = all.rows.begin();
  auto free = all.free.begin();
  for (std::size_t k = 0; k + 2 < all.size.size(); k += 3) {
    const auto rows = static_cast<std::ptrdiff_t>(all.size[k + 1]),
               places = static_cast<std::ptrdiff_t>(all.size[k + 2]);
    if (rows > all.rows.end() - row || places > all.free.end() - free) break;
    pools.push_back({all.size[k], {row, row + rows}, {free, free + places}});
    row += rows;
    free += places;
  }
  return pools;
}
/// Calls visit(name, vector) for the parts of the two kinds of pool.
template <class AnyHistory, class AnyMemory, class Visit>
void each_pooled(AnyHistory& history, AnyMemory& memory, Visit&& visit) {
  visit("history", history.rows);
  visit("history_free", history.free);
  visit("history_size", history.size);
  visit("wall_memory", memory.rows);
  visit("wall_memory_free", memory.free);
  visit("wall_memory_size", memory.size);
}

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

void write_checkpoint(const data::Hdf5Group& group, const Checkpoint& now) {
  group.set("step", static_cast<std::int64_t>(now.state.step));
  group.set("rebuilds", static_cast<std::int64_t>(now.state.rebuilds));
  group.set("dissipated_J", now.state.dissipated);
  group.set("rebuild_step", static_cast<std::int64_t>(now.state.rebuild_step));
  const auto write = [&](const char* name, const auto& rows) {
    const std::size_t row = sizeof(rows[0]);
    std::vector<std::uint8_t> bytes(rows.size() * row);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto one = rows[i];
#if __has_builtin(__builtin_clear_padding)                                          // clang-tidy reads this file, too
      if constexpr (std::is_class_v<decltype(one)>) __builtin_clear_padding(&one);  // equal runs give equal files
#endif
      std::memcpy(bytes.data() + i * row, &one, row);
    }
    group.write(name, bytes, {rows.size(), row});
  };
  each_vector(now.state, write);
  const Pooled<VectorRow> history = pooled(now.state.history);
  const Pooled<WallMemory> memory = pooled(now.state.wall_memory);
  each_pooled(history, memory, write);
  const Progressing& p = now.under_way;
  group.write("under_way", std::vector<double>{static_cast<double>(p.steps), static_cast<double>(p.deep_contacts),
                                               p.max_overlap, p.cpu_seconds});
  group.write("sums_under_way", p.sums);
  group.set("pictures_under_way", std::int64_t{p.exposure.pictures});
  group.write("covered_under_way", p.exposure.covered);
}

Checkpoint read_checkpoint(const data::Hdf5Group& group) {
  Checkpoint now;
  now.state.step = static_cast<std::uint64_t>(group.integer("step"));
  now.state.rebuilds = static_cast<std::uint64_t>(group.integer("rebuilds"));
  now.state.dissipated = group.number("dissipated_J");
  now.state.rebuild_step = static_cast<std::uint64_t>(group.integer("rebuild_step"));
  const auto read = [&](const char* name, auto& rows) {
    const auto bytes = group.read<std::uint8_t>(name);
    const std::size_t row = sizeof(rows[0]);
    if (bytes.shape.size() != 2 || bytes.shape[1] != row) {
      throw data::InputError(data::ExitStatus::bad_data, {group.place(name), "is a checkpoint of another build",
                                                          "start the run again from the beginning"});
    }
    rows.resize(bytes.shape[0]);
    if (!rows.empty()) std::memcpy(static_cast<void*>(rows.data()), bytes.values.data(), bytes.values.size());
  };
  each_vector(now.state, read);
  Pooled<VectorRow> history;
  Pooled<WallMemory> memory;
  each_pooled(history, memory, read);
  now.state.history = unpooled(history);
  now.state.wall_memory = unpooled(memory);
  const std::vector<double> p = group.read<double>("under_way").values;
  if (p.size() != 4)
    throw data::InputError(data::ExitStatus::bad_data, {group.place("under_way"), "is a checkpoint of another build",
                                                        "start the run again from the beginning"});
  if (!group.has("covered_under_way")) return {};  // of before there were silhouettes
  now.under_way = {.steps = static_cast<std::uint64_t>(p[0]),
                   .sums = group.read<double>("sums_under_way").values,
                   .deep_contacts = static_cast<std::uint64_t>(p[1]),
                   .max_overlap = p[2],
                   .cpu_seconds = p[3],
                   .exposure = {.pictures = static_cast<int>(group.integer("pictures_under_way")),
                                .covered = group.read<std::uint8_t>("covered_under_way").values}};
  // The file is from before there was one of the outputs, or of a steady run that was kept without its last state.
  if (now.under_way.sums.size() != mean_outputs().size()) return {};
  return now;
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
    const data::Hdf5Group series = file.create_group("series");
    const auto write = [&](const char* name, const char* unit, const std::vector<double>& values) {
      series.write(name, values);
      series.set("unit", unit, name);
    };
    each_series(result.series, write);
    if (!result.series.window_time.empty()) each_window_series(result.series, write);
    if (!result.series.mixing_index.empty()) each_channel_series(result.series, write);
    const data::Hdf5Group summary = file.create_group("summary");
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
    summary.write_texts("names", names);
    summary.write_texts("units", units);
    for (std::size_t j = 0; j < heads.size(); ++j) summary.write(heads[j], columns[j]);
    write_state(summary, result.summary);
    write_diagnostics(file.create_group("diagnostics"), result.diagnostics);
    write_checkpoint(file.create_group("checkpoint"), result.checkpoint);
    file.flush();
  });
}

SavedRun read_run(const std::string& path) {
  data::require_file(path);
  data::require_unchanged(path, "remove it, and the run is made again", data::Strict::yes);
  const data::Hdf5Group file = data::open_hdf5(path);
  if (!file.has_attribute("format") || file.integer("format") != format) {
    throw data::InputError(data::ExitStatus::bad_data,
                           {path, "is not a run of this program", "remove it, and the run is made again"});
  }
  SavedRun saved;
  RunResult& r = saved.result;
  saved.settings = file.text("settings");
  if (file.has_attribute("rule")) saved.rule = static_cast<int>(file.integer("rule"));
  const std::string seed = file.text("seed");
  if (const auto [rest, error] = std::from_chars(seed.data(), seed.data() + seed.size(), r.seed);
      error != std::errc{} || rest != seed.data() + seed.size() || seed.empty())
    throw data::InputError(data::ExitStatus::bad_data, {path + ": @seed", fmt::format("'{}' is not a seed", seed),
                                                        "remove it, and the run is made again"});
  r.status = static_cast<RunStatus>(file.integer("status"));
  r.reason = file.text("reason");
  r.warnings = file.read_texts("warnings");
  r.summary.cpu_seconds = file.number("cpu_seconds");
  const data::Hdf5Group series = file.group("series");
  const auto read_if_there = [&](const char* name, const char*, std::vector<double>& values) {
    if (series.has(name)) values = series.read<double>(name).values;
  };
  each_window_series(r.series, read_if_there);
  each_channel_series(r.series, read_if_there);
  each_series(r.series, [&](const char* name, const char*, std::vector<double>& values) {
    // A run of before there was this output.
    if (series.has(name))
      values = series.read<double>(name).values;
    else
      values.assign(r.series.time.size(), std::numeric_limits<double>::quiet_NaN());
  });
  const data::Hdf5Group summary = file.group("summary");
  const auto column = [&](const char* name) { return summary.read<double>(name).values; };
  const std::vector<double> mean = column("mean"), error = column("standard_error"), sd = column("sd"),
                            time = column("integrated_time"), samples = column("effective_samples"),
                            dropped = column("dropped"), reliable = column("reliable");
  // Files of before there was `drifts` do not tell it from a series that is too short.
  const bool told = summary.has("drifts");
  const std::vector<double> drifts = column(told ? "drifts" : "reliable");
  for (const std::vector<double>* other : {&error, &sd, &time, &samples, &dropped, &reliable, &drifts})
    if (other->size() != mean.size())
      throw data::InputError(
          data::ExitStatus::bad_data,
          {path + ": /summary", fmt::format("has columns of {} and {} values", mean.size(), other->size()),
           "remove it, and the run is made again"});
  saved.outputs = summary.read_texts("names");
  saved.outputs.resize(std::min(saved.outputs.size(), mean.size()));
  for (const Output& wanted : mean.empty() ? std::vector<Output>{} : outputs()) {
    const auto k = static_cast<std::size_t>(std::find(saved.outputs.begin(), saved.outputs.end(), wanted.name) -
                                            saved.outputs.begin());
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (k == saved.outputs.size())
      r.summary.mean.push_back({.mean = unknown, .standard_error = unknown, .reliable = false});
    else
      r.summary.mean.push_back({.mean = mean[k],
                                .standard_error = error[k],
                                .sd = sd[k],
                                .integrated_time = time[k],
                                .effective_samples = samples[k],
                                .dropped = static_cast<std::size_t>(dropped[k]),
                                .reliable = reliable[k] != 0.0,
                                .drifts = told ? drifts[k] != 0.0 : reliable[k] == 0.0});
  }
  read_state(summary, r.summary);
  r.checkpoint = read_checkpoint(file.group("checkpoint"));
  r.checkpoint.series = r.series;
  Diagnostics& g = r.diagnostics;
  const data::Hdf5Group diagnostics = file.group("diagnostics");
  g.steps = static_cast<std::uint64_t>(diagnostics.number("steps"));
  g.rebuilds = static_cast<std::uint64_t>(diagnostics.integer("rebuilds"));
  g.deep_contacts = static_cast<std::uint64_t>(diagnostics.number("deep_contacts"));
  g.max_overlap = diagnostics.number("max_overlap_of_radius");
  g.simulated = diagnostics.number("simulated_s");
  g.steps_per_second = diagnostics.number("particle_steps_per_second");
  g.threads = static_cast<int>(diagnostics.integer("threads"));
  g.isa = file.text("isa");
  return saved;
}

}  // namespace dem
