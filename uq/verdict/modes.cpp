#include "uq/verdict/modes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "uq/findings/study_units.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/curvature.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/verdict.hpp"

namespace uq {
namespace {

using Cell = std::vector<std::size_t>;

/// A value to the digits that its error leaves.
std::string rounded(double value, double error, const std::string& unit) {
  return format_value(value, rounding_of(value, error), unit, Typography::ascii);
}

Cell cell_of(const Profiles& all, const Eigen::VectorXd& u) {
  Cell cell;
  for (const Profile& profile : all.profiles)
    if (profile.parts.size() > 1) cell.push_back(part_of(profile, u[profile.unknown]));
  return cell;
}

/// Log of the posterior mass about a point, by the curvature of the likelihood and the prior's width.
double log_mass(const CaseModel& model, const Eigen::VectorXd& u) {
  const std::optional<Eigen::MatrixXd> precision = curvature(model, u, KnownBeside::all);
  if (!precision) return -std::numeric_limits<double>::infinity();
  const Eigen::LLT<Eigen::MatrixXd> factor(*precision);
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  return log_likelihood(model, u) + log_prior(model, u) - factor.matrixLLT().diagonal().array().log().sum();
}

/// An output's emulator, with the row whose other controls stay.
struct Place {
  std::size_t group = 0;
  Eigen::Index row = 0;
  std::size_t input = 0;  ///< a control
};

struct Parting {
  double errors = 0.0;  ///< difference in standard errors of a reading, all that is uncertain of it included
  double first = 0.0, second = 0.0, setting = 0.0;
  Place place;
};

/// Mean and variance, SI, of the reading in one row of a group at u, given the readings in the other rows: an error
/// that they share with it, such as the meter's, is known as far as they tell it.
struct Reading {
  double mean = 0.0, variance = 0.0;
};
Reading reading_given_others(const CaseModel& model, const RowGroup& group, Eigen::Index row,
                             const Eigen::VectorXd& u) {
  GroupLaw law = group_law(model, group, u);
  law.covariance.diagonal() += law.noise;
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < law.mean.size(); ++i)
    if (i != row) others.push_back(i);
  Reading reading{law.mean[row], law.covariance(row, row)};
  if (others.empty()) return reading;
  const Eigen::LLT<Eigen::MatrixXd> among(law.covariance(others, others));
  if (among.info() != Eigen::Success) return reading;
  const Eigen::VectorXd between = law.covariance(others, row);
  const Eigen::VectorXd weights = among.solve(between);
  reading.mean += weights.dot(group.observed(others) - law.mean(others));
  reading.variance = std::max(reading.variance - weights.dot(between), law.noise[row]);
  return reading;
}

Parting most_parting(const CaseModel& full, const Mode& a, const Mode& b) {
  constexpr int settings = 11;
  constexpr Eigen::Index rows = 4;
  const CaseModel& model = distinct_rows(full);
  Parting best;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const RowGroup& group = model.groups[g];
    const Eigen::Index n = group.base.rows();
    for (std::size_t k = 0; k < group.emulator.inputs.size(); ++k) {
      if (group.emulator.inputs[k].kind != InputKind::control) continue;
      for (Eigen::Index i = 0; i < std::min(rows, n); ++i) {
        const Eigen::Index row = i * n / std::min(rows, n);
        RowGroup moved = group;
        for (int t = 0; t < settings; ++t) {
          const double setting = t / (settings - 1.0);
          moved.base(row, k) = setting;
          const Reading first = reading_given_others(model, moved, row, a.point),
                        second = reading_given_others(model, moved, row, b.point);
          const double errors =
              std::abs(first.mean - second.mean) / std::sqrt(std::max(first.variance, second.variance));
          if (errors > best.errors)
            best = {
                .errors = errors, .first = first.mean, .second = second.mean, .setting = setting, .place = {g, row, k}};
        }
      }
    }
  }
  return best;
}

}  // namespace

std::size_t part_of(const Profile& profile, double u) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < profile.parts.size(); ++i) {
    const double distance = std::max({profile.parts[i].low - u, u - profile.parts[i].high, 0.0});
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

std::vector<Mode> find_modes(const Profiles& all, const Eigen::MatrixXd& draws, const VerdictThresholds& thresholds) {
  std::map<Cell, std::vector<Eigen::Index>> members;
  for (Eigen::Index i = 0; i < draws.rows(); ++i) members[cell_of(all, draws.row(i).transpose())].push_back(i);
  std::vector<Mode> modes;
  for (const auto& [cell, rows] : members) {
    Mode mode{.weight = static_cast<double>(rows.size()) / static_cast<double>(draws.rows()),
              .mean = Eigen::VectorXd::Zero(draws.cols()),
              .sd = Eigen::VectorXd::Zero(draws.cols()),
              .point = {}};
    if (mode.weight < thresholds.mode_weight) continue;
    for (const Eigen::Index i : rows) mode.mean += draws.row(i).transpose();
    mode.mean /= static_cast<double>(rows.size());
    for (const Eigen::Index i : rows) mode.sd += (draws.row(i).transpose() - mode.mean).cwiseAbs2();
    mode.sd = (mode.sd / static_cast<double>(rows.size())).cwiseSqrt();
    double least = std::numeric_limits<double>::infinity();
    for (const Profile& profile : all.profiles)
      for (Eigen::Index i = 0; i < profile.u.size(); ++i)
        if (profile.deviance[i] < least && cell_of(all, profile.path.row(i).transpose()) == cell) {
          least = profile.deviance[i];
          mode.point = profile.path.row(i).transpose();
        }
    if (mode.point.size() > 0) modes.push_back(std::move(mode));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.weight > b.weight; });
  return modes;
}

std::vector<std::string> unvisited(const CaseModel& model, const Profiles& all, const Eigen::MatrixXd& draws) {
  constexpr double noticed = 0.05, visited = 0.002;
  std::vector<std::string> names;
  for (const Profile& profile : all.profiles) {
    if (profile.parts.size() < 2) continue;
    std::vector<double> share(profile.parts.size(), 0.0), mass;
    for (const double u : draws.col(profile.unknown))
      share[part_of(profile, u)] += 1.0 / static_cast<double>(draws.rows());
    for (const ProfilePart& part : profile.parts)
      mass.push_back(log_mass(model, profile.path.row(part.best).transpose()));
    const double largest = *std::max_element(mass.begin(), mass.end());
    double sum = 0.0;
    for (const double value : mass) sum += std::exp(value - largest);
    for (std::size_t i = 0; i < profile.parts.size(); ++i) {
      if (share[i] >= visited || std::exp(mass[i] - largest) / sum < noticed) continue;
      const Unknown& unknown = model.unknowns[profile.unknown];
      const data::Unit& unit = unknown.prior.parameter().unit;
      const double width = (profile.parts[i].high - profile.parts[i].low) *
                           std::abs(unknown.slope(profile.u[profile.parts[i].best])) / unit.factor;
      names.push_back(
          unknown.label + " near " +
          rounded(in_study_unit(unknown.prior.parameter(), profile.u[profile.parts[i].best]), 0.25 * width, ""));
    }
  }
  return names;
}

std::string parted_by(const data::Study& study, const CaseModel& model, const std::vector<Mode>& modes) {
  if (modes.size() < 2) return {};
  // The pair of modes that is hardest to part.
  Parting found;
  bool first = true;
  for (std::size_t a = 0; a < modes.size(); ++a)
    for (std::size_t b = a + 1; b < modes.size(); ++b) {
      const Parting one = most_parting(model, modes[a], modes[b]);
      if (first || one.errors < found.errors) found = one;
      first = false;
    }
  if (!(found.errors > 1.0))
    return "measure another kind of quantity: none that was measured parts the values at any setting inside the runs";
  const RowGroup& group = model.groups[found.place.group];
  const data::Output& output = study.outputs.at(group.emulator.output);
  const data::Control& control = study.controls.at(group.emulator.inputs[found.place.input].index);
  const double setting = in_study_unit(control, found.setting);
  const double sd = std::abs(found.first - found.second) / found.errors / output.unit.factor;
  return fmt::format("measure {} at {} {}, where the values part: {} against {}, {:.1f} standard errors", output.name,
                     control.name, fmt::format("{:.4g}", setting) + behind_number(control.unit.symbol),
                     rounded(output.unit.from_si(found.first), sd, ""),
                     rounded(output.unit.from_si(found.second), sd, output.unit.symbol), found.errors);
}

}  // namespace uq
