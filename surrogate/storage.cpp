#include "surrogate/storage.hpp"

#include <algorithm>
#include <filesystem>
#include <span>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hdf5.hpp"
#include "data/origin.hpp"

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::int64_t format = 4;

void write(const data::Hdf5Group& group, const std::string& name, const MatrixXd& matrix) {
  const RowMatrix rows = matrix;
  group.write<double>(name, std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())),
                      {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())});
}

MatrixXd read_matrix(const data::Hdf5Group& group, const std::string& name) {
  const data::Array<double> array = group.read<double>(name);
  if (array.shape.size() != 2)
    throw data::InputError(data::ExitStatus::bad_data,
                           {group.place(name), "is not a matrix", "delete the file, it is made again"});
  return Eigen::Map<const RowMatrix>(array.values.data(), static_cast<Index>(array.shape[0]),
                                     static_cast<Index>(array.shape[1]));
}

VectorXd read_vector(const data::Hdf5Group& group, const std::string& name) {
  const data::Array<double> array = group.read<double>(name);
  return Eigen::Map<const VectorXd>(array.values.data(), static_cast<Index>(array.values.size()));
}

std::vector<int> read_integers(const data::Hdf5Group& group, const std::string& name) {
  return group.read<std::int32_t>(name).values;
}

std::span<const double> numbers(const VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

void save(const data::Hdf5Group& group, const FitDiagnostics& diagnostics) {
  group.set("converged", std::int64_t{diagnostics.converged});
  group.set("jitter", diagnostics.jitter);
  group.set("agreeing_starts", std::int64_t{diagnostics.agreeing_starts});
  const auto starts = static_cast<Index>(diagnostics.starts.size());
  const Index count = starts ? diagnostics.starts.front().start.size() : 0;
  MatrixXd outcomes(starts, 6), from(starts, count), to(starts, count);
  for (Index i = 0; i < starts; ++i) {
    const StartOutcome& s = diagnostics.starts[i];
    outcomes.row(i) << s.objective, s.gradient_norm, s.evaluations, s.converged ? 1.0 : 0.0, s.points,
        s.agrees ? 1.0 : 0.0;
    from.row(i) = s.start;
    to.row(i) = s.end;
  }
  write(group, "starts", outcomes);
  write(group, "start_from", from);
  write(group, "start_to", to);
  std::vector<std::string> names;
  MatrixXd hits(static_cast<Index>(diagnostics.bound_hits.size()), 5);
  for (Index i = 0; i < hits.rows(); ++i) {
    const BoundHit& hit = diagnostics.bound_hits[i];
    names.push_back(hit.parameter);
    hits.row(i) << (hit.upper ? 1.0 : 0.0), hit.value, (hit.harmless ? 1.0 : 0.0), hit.input, hit.effect;
  }
  group.write_texts("bound_names", names);
  write(group, "bound_hits", hits);
}

void save(const data::Hdf5Group& group, const GaussianProcess& process) {
  const Standardised& data = process.data();
  group.set("kernel", to_text(process.kernel()));
  group.set("mean", to_text(process.mean()));
  group.set("scale", to_text(data.scale));
  group.set("nugget", std::int64_t{process.nugget()});
  group.set("shift", data.shift);
  group.set("unit", data.unit);
  group.set("log_jacobian", data.log_jacobian);
  write(group, "points", data.points);
  group.write<double>("z", numbers(data.z));
  group.write<double>("noise", numbers(data.noise));
  group.write<double>("low", numbers(data.low));
  group.write<double>("high", numbers(data.high));
  group.write<std::int32_t>("point_of_run", data.point_of_run);
  group.write<std::int32_t>("active", data.active);

  MatrixXd gaps(static_cast<Index>(data.gaps.size()), 4);
  for (Index i = 0; i < gaps.rows(); ++i)
    gaps.row(i) << data.gaps[i].input, data.gaps[i].low, data.gaps[i].high, data.gaps[i].sd;
  write(group, "gaps", gaps);

  const std::vector<Conditioned>& parts = process.parts();
  MatrixXd lengths(static_cast<Index>(parts.size()), data.points.cols());
  std::vector<double> signal, nugget, weight;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    lengths.row(static_cast<Index>(i)) = parts[i].parameters.length_scales;
    signal.push_back(parts[i].parameters.signal_variance);
    nugget.push_back(parts[i].parameters.nugget_variance);
    weight.push_back(parts[i].weight);
  }
  write(group, "length_scales", lengths);
  group.write("signal_variance", signal);
  group.write("nugget_variance", nugget);
  group.write("weight", weight);
  save(group, process.diagnostics());
}

void save(const data::Hdf5Group& group, const HighLevel& high) {
  group.set("discrepancy_mean", to_text(high.discrepancy_mean));
  write(group, "x", high.runs.x);
  group.write<double>("y", numbers(high.runs.y));
  group.write<double>("noise_variance", numbers(high.runs.noise_variance));
  MatrixXd settings(static_cast<Index>(high.settings.size()), 5);
  for (Index i = 0; i < settings.rows(); ++i) {
    const TwoLevelParameters& p = high.settings[i];
    settings.row(i) << p.weight, p.rho, p.length_factor, p.discrepancy_sd, p.nugget_sd;
  }
  write(group, "settings", settings);
  save(group, high.diagnostics);
}

template <data::HasTexts Enum>
Enum read_choice(const data::Hdf5Group& group, const std::string& attribute) {
  const std::string text = group.text(attribute);
  if (const auto value = data::from_text<Enum>(text)) return *value;
  throw data::InputError(
      data::ExitStatus::bad_data,
      {group.place(), attribute + " is \"" + text + "\", which is unknown", "delete the file, it is made again"});
}

void require(bool condition, const data::Hdf5Group& group, const std::string& what) {
  if (!condition)
    throw data::InputError(data::ExitStatus::bad_data, {group.place(), what, "delete the file, it is made again"});
}

FitDiagnostics load_diagnostics(const data::Hdf5Group& group) {
  FitDiagnostics diagnostics;
  diagnostics.converged = group.integer("converged") != 0;
  diagnostics.jitter = group.number("jitter");
  diagnostics.agreeing_starts = static_cast<int>(group.integer("agreeing_starts"));
  const MatrixXd outcomes = read_matrix(group, "starts"), from = read_matrix(group, "start_from"),
                 to = read_matrix(group, "start_to");
  require(outcomes.cols() == 6 && from.rows() == outcomes.rows() && to.rows() == outcomes.rows(), group,
          "its starts do not fit together");
  for (Index i = 0; i < outcomes.rows(); ++i)
    diagnostics.starts.push_back({from.row(i), to.row(i), outcomes(i, 0), outcomes(i, 1),
                                  static_cast<int>(outcomes(i, 2)), outcomes(i, 3) != 0.0,
                                  static_cast<int>(outcomes(i, 4)), outcomes(i, 5) != 0.0});
  const std::vector<std::string> names = group.read_texts("bound_names");
  const MatrixXd hits = read_matrix(group, "bound_hits");
  require(hits.cols() == 5 && hits.rows() == static_cast<Index>(names.size()), group, "its bounds do not fit together");
  for (Index i = 0; i < hits.rows(); ++i)
    diagnostics.bound_hits.push_back(
        {names[i], hits(i, 0) != 0.0, hits(i, 1), hits(i, 2) != 0.0, static_cast<int>(hits(i, 3)), hits(i, 4)});
  return diagnostics;
}

GaussianProcess load(const data::Hdf5Group& group) {
  const auto kernel = read_choice<Kernel>(group, "kernel");
  const auto mean = read_choice<MeanBasis>(group, "mean");
  const bool nugget = group.integer("nugget") != 0;
  Standardised data;
  data.scale = read_choice<OutputScale>(group, "scale");
  data.shift = group.number("shift");
  data.unit = group.number("unit");
  data.log_jacobian = group.number("log_jacobian");
  data.points = read_matrix(group, "points");
  data.z = read_vector(group, "z");
  data.noise = read_vector(group, "noise");
  data.low = read_vector(group, "low");
  data.high = read_vector(group, "high");
  data.point_of_run = read_integers(group, "point_of_run");
  data.active = read_integers(group, "active");
  const Index n = data.z.size(), points = data.points.rows(), d = data.low.size();
  require(data.noise.size() == n && static_cast<Index>(data.point_of_run.size()) == n && data.high.size() == d &&
              static_cast<Index>(data.active.size()) == data.points.cols(),
          group, "its arrays do not fit together");
  data.runs_of_point.assign(static_cast<std::size_t>(points), 0);
  for (const int point : data.point_of_run) {
    require(point >= 0 && point < points, group, "a run belongs to a point that is not there");
    ++data.runs_of_point[point];
  }
  for (const int k : data.active) require(k >= 0 && k < d, group, "an input is not there");
  const MatrixXd gaps = read_matrix(group, "gaps");
  require(gaps.cols() == 4, group, "its gaps are incomplete");
  for (Index i = 0; i < gaps.rows(); ++i) {
    require(gaps(i, 0) >= 0.0 && gaps(i, 0) < static_cast<double>(data.active.size()), group,
            "a gap's input is not there");
    data.gaps.push_back({static_cast<int>(gaps(i, 0)), gaps(i, 1), gaps(i, 2), gaps(i, 3)});
  }

  const MatrixXd lengths = read_matrix(group, "length_scales");
  const VectorXd signal = read_vector(group, "signal_variance"), nuggets = read_vector(group, "nugget_variance"),
                 weight = read_vector(group, "weight");
  require(lengths.rows() >= 1 && lengths.cols() == data.points.cols() && signal.size() == lengths.rows() &&
              nuggets.size() == lengths.rows() && weight.size() == lengths.rows(),
          group, "its hyper-parameters do not fit its points");
  Likelihood likelihood(data, kernel, mean, nugget);
  std::vector<Conditioned> parts;
  for (Index i = 0; i < lengths.rows(); ++i) {
    Conditioned part;
    part.weight = weight[i];
    part.parameters = {lengths.row(i), signal[i], nuggets[i]};
    part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
    part.factorised = likelihood.factorise(part.parameters);
    require(part.factorised.ok, group, "its covariance cannot be factorised");
    parts.push_back(std::move(part));
  }

  return {kernel, mean, nugget, std::move(data), std::move(parts), load_diagnostics(group)};
}

HighLevel load_high(const data::Hdf5Group& group) {
  HighLevel high;
  high.discrepancy_mean = read_choice<MeanBasis>(group, "discrepancy_mean");
  high.runs = {read_matrix(group, "x"), read_vector(group, "y"), read_vector(group, "noise_variance")};
  require(high.runs.x.rows() == high.runs.y.size() && high.runs.noise_variance.size() == high.runs.y.size(), group,
          "its arrays do not fit together");
  const MatrixXd settings = read_matrix(group, "settings");
  require(settings.rows() >= 1 && settings.cols() == 5, group, "its settings are incomplete");
  for (Index i = 0; i < settings.rows(); ++i)
    high.settings.push_back({settings(i, 0), settings(i, 1), settings(i, 2), settings(i, 3), settings(i, 4)});
  high.diagnostics = load_diagnostics(group);
  return high;
}

}  // namespace

void save_processes(const std::string& path, const ProcessSet& processes, const SurrogateKey& key) {
  data::write_atomically(path, [&](const std::string& temporary) {
    const data::Hdf5Group root = data::create_hdf5(temporary);
    root.set("format", format);
    root.set("kind", "demcal surrogate");
    root.set("study_hash", key.study_hash);
    root.set("table_hash", key.table_hash);
    std::vector<std::string> names;
    int index = 0;
    for (const auto& [name, saved] : processes) {  // names may hold a slash: groups are numbered
      names.push_back(name);
      const data::Hdf5Group group = root.create_group("process" + std::to_string(index++));
      save(group, saved.process);
      if (saved.high) save(group.create_group("second_level"), *saved.high);
      group.write_texts("remarks", {saved.remarks});
    }
    root.write_texts("names", names);
    root.flush();
  });
}

LoadedProcesses load_processes(const std::string& path, const SurrogateKey& key) {
  if (!std::filesystem::exists(path)) return {std::nullopt, "there is no saved surrogate"};
  data::require_file(path);
  data::require_unchanged(path, "it is made again", data::Strict::yes);
  const data::Hdf5Group root = data::open_hdf5(path);
  require(root.has_attribute("kind") && root.text("kind") == "demcal surrogate", root, "is not a saved surrogate");
  if (root.integer("format") != format) return {std::nullopt, "the saved surrogate is of another format"};
  if (root.text("study_hash") != key.study_hash)
    return {std::nullopt, "the study has changed since the surrogate was saved"};
  if (root.text("table_hash") != key.table_hash)
    return {std::nullopt, "the run table has changed since the surrogate was saved"};
  LoadedProcesses result;
  result.processes.emplace();
  int index = 0;
  for (const std::string& name : root.read_texts("names")) {
    const data::Hdf5Group group = root.group("process" + std::to_string(index++));
    const std::vector<std::string> remarks = group.read_texts("remarks");
    require(remarks.size() == 1, group, "its remarks are missing");
    SavedProcess saved{load(group), std::nullopt, remarks.front()};
    if (group.has("second_level")) saved.high = load_high(group.group("second_level"));
    result.processes->emplace(name, std::move(saved));
  }
  return result;
}

}  // namespace surrogate
