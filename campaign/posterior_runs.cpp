#include "campaign/posterior_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/time_series.hpp"
#include "uq/posterior/control_reach.hpp"

namespace campaign {
namespace {

using Eigen::Index;

const std::string left_comment = "# runs left to this campaign: ";

/// Rows in an order that does not depend on which run finished first.
data::RunTable in_order(data::RunTable table) {
  std::stable_sort(table.rows.begin(), table.rows.end(), [](const data::RunRow& a, const data::RunRow& b) {
    return std::tie(a.material, a.inputs, a.seed, a.settings) < std::tie(b.material, b.inputs, b.seed, b.settings);
  });
  return table;
}

/// The surrogate that gives an emulator.
const uq::FittedSurrogate& surrogate_of(const std::vector<uq::FittedSurrogate>& all, const std::string& material,
                                        std::size_t output) {
  return *std::find_if(all.begin(), all.end(), [&](const uq::FittedSurrogate& one) {
    return one.rows.material == material && one.rows.output == output;
  });
}

/// The expected scatter of one more run: the usual standard error of the runs, and the scatter beyond it.
uq::RunNoise noise_of(const uq::FittedSurrogate& fitted) {
  const surrogate::TrainingSet& set = fitted.rows.set;
  const bool log = fitted.process->data().scale == surrogate::OutputScale::log;
  std::vector<double> known;
  for (Index i = 0; i < set.noise_variance.size(); ++i)
    known.push_back(set.noise_variance[i] / (log ? set.y[i] * set.y[i] : 1.0));
  const double nugget_sd =
      fitted.two_level ? fitted.two_level->parameters().nugget_sd : fitted.process->hyper_parameters().nugget_sd;
  const double variance = (known.empty() ? 0.0 : data::median_of(std::move(known))) + nugget_sd * nugget_sd;
  return log ? uq::RunNoise{.absolute = 0.0, .relative = variance}
             : uq::RunNoise{.absolute = variance, .relative = 0.0};
}

/// The point that a run of the criterion stands for. What the material's surrogates do not vary keeps its value.
Point to_point(const Workspace& workspace, const std::vector<uq::FittedSurrogate>& surrogates,
               const uq::RunPoint& run) {
  const data::Study& study = workspace.study;
  std::vector<bool> varied_parameter(study.parameters.size(), false), varied_control(study.controls.size(), false);
  Point point{run.material, std::vector<double>(study.parameters.size() + study.controls.size(), 0.0)};
  for (const uq::FittedSurrogate& one : surrogates) {
    if (one.rows.material != run.material) continue;
    for (const auto& [p, value] : one.rows.constants) point.inputs[p] = value;
    for (const auto& [c, range] : one.rows.control_range) point.inputs[study.parameters.size() + c] = range.first;
    for (const uq::EmulatorInput& input : one.rows.inputs)
      (input.kind == uq::InputKind::parameter ? varied_parameter : varied_control)[input.index] = true;
  }
  for (std::size_t p = 0; p < study.parameters.size(); ++p)
    if (varied_parameter[p] && static_cast<Index>(p) < run.parameters.size())
      point.inputs[p] =
          study.parameters[p].unit.rounded(study.parameters[p].axis().from_unit(run.parameters[p]), point_digits);
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    if (varied_control[c] && static_cast<Index>(c) < run.controls.size()) {
      const data::Control& control = study.controls[c];
      point.inputs[study.parameters.size() + c] =
          control.unit.rounded(control.axis().from_unit(run.controls[c]), point_digits);
    }
  return point;
}

/// The point as the criterion sees a run there; the reverse of the function above.
uq::RunPoint to_run(const Workspace& workspace, const std::vector<uq::FittedSurrogate>& surrogates,
                    const Point& point) {
  const data::Study& study = workspace.study;
  uq::RunPoint run{point.material, Eigen::VectorXd::Zero(static_cast<Index>(study.parameters.size())),
                   Eigen::VectorXd::Zero(static_cast<Index>(study.controls.size()))};
  for (const uq::FittedSurrogate& one : surrogates) {
    if (one.rows.material != point.material) continue;
    for (const uq::EmulatorInput& input : one.rows.inputs) {
      const auto index = static_cast<Index>(input.index);
      if (input.kind == uq::InputKind::parameter)
        run.parameters[index] = study.parameters[input.index].axis().to_unit(point.inputs[input.index]);
      else
        run.controls[index] =
            study.controls[input.index].axis().to_unit(point.inputs[study.parameters.size() + input.index]);
    }
  }
  return run;
}

/// Adds points of the design from `first` on to a material's `planned` runs, until they and its rows reach each
/// measured control as far as a case asks for.
void reach_observations(const Workspace& workspace, const std::string& material, int first, const data::RunTable& table,
                        std::vector<PlannedRun>& planned) {
  const data::Study& study = workspace.study;
  const std::size_t parameters = study.parameters.size();
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const data::Control& control = study.controls[c];
    double low = HUGE_VAL, high = -HUGE_VAL, least = HUGE_VAL, most = -HUGE_VAL;
    for (const data::ObservationSet& set : study.observations)
      for (const data::Observation& point : set.points) {
        if (set.material != material || point.controls[c] < control.low || point.controls[c] > control.high) continue;
        least = std::min(least, point.controls[c]);
        most = std::max(most, point.controls[c]);
      }
    const auto reach = [&](double value) {
      low = std::min(low, value);
      high = std::max(high, value);
    };
    for (const data::RunRow& row : table.rows)
      if (row.material == material) reach(row.inputs[parameters + c]);
    for (const PlannedRun& run : planned) reach(run.point.inputs[parameters + c]);
    if (low > high) continue;
    for (const Point& point : training_design(workspace, material, first, 256)) {
      const bool below = least < low && !uq::within_reach(control, least, {low, high});
      const bool above = most > high && !uq::within_reach(control, most, {low, high});
      if (!below && !above) break;
      const double value = point.inputs[parameters + c];
      if ((below && value < low) || (above && value > high)) {
        planned.push_back({point, study.seed});
        reach(value);
      }
    }
  }
  planned = without_rows(workspace, planned, table);
}

}  // namespace

bool Assessment::settled(double most) const {
  return share() <= most &&
         std::all_of(cases.begin(), cases.end(), [](const uq::SampledCase& one) { return one.draws.converged; });
}

Assessment assess(const Workspace& workspace, const StudyRows& rows) {
  const data::Study& study = workspace.study;
  uq::SurrogateOptions options = *workspace.surrogates;
  options.fit.seed = study.seed;
  options.low = rows.low;
  options.observed_only = true;
  Assessment found;
  found.surrogates = uq::fit_surrogates(study, in_order(rows.table), options);
  const std::vector<uq::Emulator> emulators = uq::emulators_of(found.surrogates);
  for (std::size_t index = 0; index < study.cases.size(); ++index) {
    found.cases.push_back(uq::sample_case(study, emulators, index, {.surrogates = options, .seed = study.seed}));
    const uq::SampledCase& sampled = found.cases.back();
    found.shares.push_back(uq::surrogate_share(*sampled.model, sampled.draws.chains.empty()
                                                                   ? Eigen::MatrixXd(0, sampled.model->dimension())
                                                                   : sampled.draws.pooled()));
    if (found.shares.back().share > found.shares[found.worst].share) found.worst = index;
  }
  return found;
}

ChosenRuns choose_runs(const Workspace& workspace, const StudyRows& rows, const Assessment& assessment, int runs,
                       int tried) {
  const data::Study& study = workspace.study;
  uq::Acquisition acquisition;
  for (const uq::SampledCase& sampled : assessment.cases)
    acquisition.cases.push_back({.model = sampled.model,
                                 .draws = sampled.draws.chains.empty() ? Eigen::MatrixXd(0, sampled.model->dimension())
                                                                       : sampled.draws.pooled(),
                                 .log_evidence = sampled.draws.log_evidence});
  data::RunTable table = in_order(rows.table);
  std::erase_if(table.rows, [](const data::RunRow& row) { return static_cast<bool>(row.left_out); });
  for (const data::RunRow& row : table.rows)
    acquisition.existing.push_back(to_run(workspace, assessment.surrogates, Point{row.material, row.inputs}));
  acquisition.noise = [&](const uq::Emulator& emulator) {
    return noise_of(surrogate_of(assessment.surrogates, emulator.material, emulator.output));
  };
  acquisition.rounded = [&](const uq::RunPoint& run) {
    return to_run(workspace, assessment.surrogates, to_point(workspace, assessment.surrogates, run));
  };
  const std::uint64_t seed = number_from(fmt::format("{} next runs {} {}", study.seed, rows.all.rows.size(), tried));
  const uq::Batch batch = uq::next_batch(acquisition, {.runs = runs, .seed = seed, .candidates = {}, .reference = {}});
  ChosenRuns chosen;
  for (const uq::BatchRun& next : batch.runs) {
    Point point = to_point(workspace, assessment.surrogates, next.point);
    // A replicate stands where the first run does, with all its digits.
    for (std::size_t i = 0; next.replicate && i < acquisition.existing.size(); ++i)
      if (uq::same_run(acquisition.existing[i], next.point)) point.inputs = table.rows[i].inputs;
    chosen.replicates += next.replicate ? 1 : 0;
    chosen.runs.push_back({point, free_seed(workspace, rows.all, chosen.runs, point)});
  }
  if (!batch.variance_before.empty()) {
    chosen.variance_before = batch.variance_before[assessment.worst];
    chosen.variance_after_expected = batch.variance_after[assessment.worst];
  }
  return chosen;
}

Point point_at(const Workspace& workspace, const std::vector<uq::FittedSurrogate>& surrogates,
               const uq::RowGroup& group, Index row, const Eigen::VectorXd& u) {
  return to_point(workspace, surrogates, uq::run_at(group, row, u));
}

std::vector<PlannedRun> starting_runs(const Workspace& workspace, const data::RunTable& table) {
  const data::Study& study = workspace.study;
  std::vector<PlannedRun> all;
  for (const data::Material& material : study.materials) {
    const int inputs = static_cast<int>(study.parameters.size() - material.fixed.size() + study.controls.size());
    const auto rows = std::count_if(table.rows.begin(), table.rows.end(),
                                    [&](const data::RunRow& row) { return row.material == material.name; });
    const int wanted =
        std::min(std::max(10, 5 * inputs), std::max(material.runs.value_or(study.training.runs), inputs + 2));
    const std::vector<Point> design = training_design(workspace, material.name, 0, wanted);
    std::vector<PlannedRun> planned;
    for (const Point& point : design) planned.push_back({point, study.seed});
    planned = without_rows(workspace, planned, table);
    const int missing = wanted - static_cast<int>(rows);
    planned.resize(static_cast<std::size_t>(std::clamp(missing, 0, static_cast<int>(planned.size()))));
    reach_observations(workspace, material.name, wanted, table, planned);
    all.insert(all.end(), planned.begin(), planned.end());
  }
  return all;
}

std::uint64_t free_seed(const Workspace& workspace, const data::RunTable& table, const std::vector<PlannedRun>& planned,
                        const Point& point) {
  const std::string settings = own_engine(workspace) ? settings_hash(workspace, point.material) : "";
  const auto key = [&](const Point& at, std::uint64_t seed) {
    return data::row_key({.material = at.material, .inputs = at.inputs, .seed = seed, .settings = settings});
  };
  std::set<std::string> taken;
  for (const data::RunRow& row : table.rows) taken.insert(data::row_key(row));
  for (const PlannedRun& run : planned) taken.insert(key(run.point, run.seed));
  std::uint64_t seed = workspace.study.seed;
  while (taken.contains(key(point, seed))) ++seed;
  return seed;
}

std::vector<PlannedRun> without_rows(const Workspace& workspace, const std::vector<PlannedRun>& runs,
                                     const data::RunTable& table) {
  std::set<std::string> known;
  for (const data::RunRow& row : table.rows) known.insert(data::row_key(row));
  std::vector<PlannedRun> missing;
  for (const PlannedRun& run : runs)
    if (!known.contains(data::row_key({.material = run.point.material,
                                       .inputs = run.point.inputs,
                                       .seed = run.seed,
                                       .settings = settings_hash(workspace, run.point.material)})))
      missing.push_back(run);
  return missing;
}

void write_posterior_runs(const Workspace& workspace, const PosteriorRuns& next) {
  write_points(workspace, posterior_runs_path(workspace), points_of(next.runs), {seeds_of(next.runs)},
               next.left ? left_comment + std::to_string(*next.left) + "\n" : "");
}

namespace {

/// The number of runs that a list says are left.
int runs_left(const std::string& text, const std::string& path) {
  int left = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), left);
  if (error != std::errc{} || end != text.data() + text.size() || left < 0)
    throw data::InputError(data::ExitStatus::bad_data,
                           {path, fmt::format("'{}' is not a number of runs left", text), "remove the file"});
  return left;
}

}  // namespace

std::optional<PosteriorRuns> read_posterior_runs(const Workspace& workspace) {
  const std::string path = posterior_runs_path(workspace);
  if (!std::filesystem::exists(path)) return {};
  PosteriorRuns next{.runs = read_runs(workspace, path), .left = {}};
  for (const std::string& comment : data::read_csv(path).comments)
    if (const std::string line = "# " + comment; line.starts_with(left_comment))
      next.left = runs_left(line.substr(left_comment.size()), path);
  return next;
}

double median_run_time(const data::RunTable& table) {
  std::vector<double> times;
  for (const data::RunRow& row : table.rows)
    if (row.cpu_seconds > 0.0) times.push_back(row.cpu_seconds);
  return times.empty() ? 0.0 : data::median_of(std::move(times));
}

}  // namespace campaign
