#include "campaign/verify.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "campaign/out_files.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"

namespace campaign {
namespace {

using Eigen::Index;

/// Unknowns at which a case is verified, and what they are.
struct VerificationPoint {
  Eigen::VectorXd u;
  std::string label;
};

/// `count` draws spread over the posterior: of the nine tenths with the highest density the first is the one nearest to
/// the mean, each further one the farthest from all before, in posterior sd.
void add_spread_draws(const uq::Draws& draws, int count, std::vector<VerificationPoint>& points) {
  const Eigen::MatrixXd all = draws.pooled();
  const Eigen::VectorXd density = draws.pooled_log_density();
  const Index step = std::max<Index>(1, all.rows() / 1000);
  std::vector<double> sorted;
  for (Index i = 0; i < all.rows(); i += step) sorted.push_back(density[i]);
  std::sort(sorted.begin(), sorted.end());
  const double least = sorted[sorted.size() / 10];
  const Eigen::RowVectorXd mean = all.colwise().mean();
  const Eigen::RowVectorXd sd = (all.rowwise() - mean).array().square().colwise().mean().sqrt().max(1e-12).matrix();
  std::vector<Index> kept;
  for (Index i = 0; i < all.rows(); i += step)
    if (density[i] >= least) kept.push_back(i);
  const auto distance = [&](Index i, const Eigen::RowVectorXd& from) {
    return (all.row(i) - from).cwiseQuotient(sd).squaredNorm();
  };
  std::vector<double> nearest(kept.size(), 1e300);
  for (const VerificationPoint& point : points)
    for (std::size_t k = 0; k < kept.size(); ++k)
      nearest[k] = std::min(nearest[k], distance(kept[k], point.u.transpose()));
  for (int drawn = 0; drawn < count && !kept.empty(); ++drawn) {
    std::size_t best = 0;
    if (points.empty()) {
      for (std::size_t k = 1; k < kept.size(); ++k)
        if (distance(kept[k], mean) < distance(kept[best], mean)) best = k;
    } else {
      best = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    const Eigen::RowVectorXd chosen = all.row(kept[best]);
    points.push_back({chosen.transpose(), fmt::format("draw {}", drawn + 1)});
    for (std::size_t k = 0; k < kept.size(); ++k) nearest[k] = std::min(nearest[k], distance(kept[k], chosen));
  }
}

std::vector<VerificationPoint> points_of(const uq::CaseReport& report, const uq::SampledCase& sampled, int count) {
  std::vector<VerificationPoint> points;
  int equivalent = 0;
  for (const uq::TradedPair& traded : report.traded)
    for (const std::vector<double>& u : traded.equivalent_u) {
      if (static_cast<int>(points.size()) == count) return points;
      points.push_back({Eigen::Map<const Eigen::VectorXd>(u.data(), static_cast<Index>(u.size())),
                        fmt::format("equivalent point {}", ++equivalent)});
    }
  if (!sampled.draws.chains.empty()) add_spread_draws(sampled.draws, count - static_cast<int>(points.size()), points);
  return points;
}

/// Rows of a group at up to three settings of the controls, in the order of the first that varies.
std::vector<Index> spread_rows(const uq::RowGroup& group) {
  std::vector<Index> rows;
  for (Index i = 0; i < group.base.rows(); ++i) rows.push_back(i);
  const auto controls = [&](Index row) {
    std::vector<double> values;
    for (std::size_t k = 0; k < group.emulator.inputs.size(); ++k)
      if (group.emulator.inputs[k].kind == uq::InputKind::control)
        values.push_back(group.base(row, static_cast<Index>(k)));
    return values;
  };
  std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return controls(a) < controls(b); });
  rows.erase(std::unique(rows.begin(), rows.end(), [&](Index a, Index b) { return controls(a) == controls(b); }),
             rows.end());
  if (rows.size() <= 3) return rows;
  return {rows.front(), rows[rows.size() / 2], rows.back()};
}

/// Inputs as they are typed: a run of another code is known by them.
std::string typed(const Workspace& workspace, const std::string& material, const std::vector<double>& inputs) {
  const std::vector<data::Input> named = data::inputs_of(workspace.study);
  std::string text = material;
  for (std::size_t i = 0; i < named.size(); ++i) text += fmt::format(" {:.5g}", named[i].unit.from_si(inputs[i]));
  return text;
}

bool is_run(const Workspace& workspace, const data::RunRow& row, const PlannedRun& run) {
  if (own_engine(workspace) && row.seed != run.seed) return false;
  return typed(workspace, row.material, row.inputs) == typed(workspace, run.point.material, run.point.inputs);
}

}  // namespace

std::vector<ListedRun> verification_runs(const Workspace& workspace, const StudyRows& rows,
                                         const uq::Calibration& calibration, int points) {
  std::vector<ListedRun> listed;
  std::vector<PlannedRun> planned;
  for (std::size_t index = 0; index < calibration.cases.size(); ++index) {
    const uq::SampledCase& sampled = calibration.cases[index];
    for (const VerificationPoint& point : points_of(calibration.report.cases[index], sampled, points)) {
      std::set<std::string> known;  // one run gives all outputs of a material
      for (const uq::RowGroup& group : sampled.model->groups)
        for (const Index row : spread_rows(group)) {
          const Point at = point_at(workspace, calibration.surrogates, group, row, point.u);
          if (!known.insert(typed(workspace, at.material, at.inputs)).second) continue;
          // Another seed than the training runs', so that the run is no copy of one.
          std::uint64_t seed = free_seed(workspace, rows.all, planned, at);
          if (seed == workspace.study.seed) ++seed;
          planned.push_back({at, seed});
          listed.push_back({planned.back(), workspace.study.cases[index].name, point.label});
        }
    }
  }
  return listed;
}

void write_verify_runs(const Workspace& workspace, const std::vector<ListedRun>& runs) {
  std::vector<PlannedRun> planned;
  PointColumn cases{"case", {}}, labels{"point", {}};
  for (const ListedRun& one : runs) {
    planned.push_back(one.run);
    cases.values.push_back(one.case_name);
    labels.values.push_back(one.label);
  }
  write_points(workspace, verify_runs_path(workspace), points_of(planned), {seeds_of(planned), cases, labels});
}

std::vector<ListedRun> read_verify_runs(const Workspace& workspace) {
  const std::string path = verify_runs_path(workspace);
  if (!std::filesystem::exists(path)) return {};
  const std::vector<PlannedRun> planned = read_runs(workspace, path);
  const data::Csv csv = data::read_csv(path);
  const std::size_t of_case = csv.column("case"), label = csv.column("point");
  std::vector<ListedRun> runs;
  for (std::size_t i = 0; i < planned.size(); ++i)
    runs.push_back({.run = planned[i], .case_name = csv.rows[i].fields[of_case], .label = csv.rows[i].fields[label]});
  return runs;
}

bool HeldBack::complete() const {
  return std::all_of(listed.begin(), listed.end(), [](const auto& row) { return row.has_value(); });
}

HeldBack hold_back(const Workspace& workspace, const data::RunTable& table, const std::vector<ListedRun>& runs) {
  HeldBack held{.others = table, .listed = std::vector<std::optional<data::RunRow>>(runs.size())};
  held.others.rows.clear();
  for (const data::RunRow& row : table.rows) {
    bool found = false;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (is_run(workspace, row, runs[i].run)) {
        held.listed[i] = row;
        found = true;
      }
    if (!found) held.others.rows.push_back(row);
  }
  return held;
}

std::vector<uq::VerificationReport> verify_cases(const Workspace& workspace,
                                                 const std::vector<uq::FittedSurrogate>& surrogates,
                                                 const std::vector<ListedRun>& runs, const HeldBack& held) {
  std::vector<uq::VerificationReport> reports;
  const std::string simulation = own_engine(workspace) ? "the DEM" : "your code";
  for (const data::CalibrationCase& one : workspace.study.cases) {
    std::vector<uq::VerificationRun> own;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (runs[i].case_name == one.name && held.listed[i]) own.push_back({*held.listed[i], runs[i].label});
    reports.push_back(uq::verify(workspace.study, surrogates, own));
    reports.back().sentence = uq::verification_sentence(reports.back(), simulation);
  }
  return reports;
}

}  // namespace campaign
