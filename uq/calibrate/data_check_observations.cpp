// Checks of the observations by themselves: copies, standard errors that cannot be meant; beside the runs they are
// looked at in data_check_beside_runs.cpp, and for what their errors share in data_check_shared_errors.cpp. And what
// building the cases would refuse.
//
// Errors in percent: readings along one control are smooth, so their scatter about a simple curve in it says how large
// their errors can be. With residuals r_i, errors s_i and as many degrees of freedom as the curve leaves,
//   P(chi2 <= sum r_i^2 / s_i^2) below a threshold and s_i over 5 % of the value: a percentage is suspected;
//   P(chi2 >= ...) as small, not with s_i times the value, and s_i below half a per cent of it: a share is suspected.
#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "data/number_text.hpp"
#include "data/observations.hpp"
#include "data/time_series.hpp"
#include "uq/calibrate/data_columns.hpp"
#include "uq/emulate/surrogates.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

void check_copies(const data::ObservationSet& set, std::vector<Finding>& findings) {
  if (set.copies.empty()) return;
  Finding finding{.kind = data::FindingKind::copied_observations,
                  .place = {},
                  .severity = Severity::warning,
                  .what = {},
                  .remedy = {},
                  .places = {}};
  for (const data::ObservationCopy& copy : set.copies)
    finding.places.push_back(fmt::format("{}:{}", file_of(set), copy.line));
  finding.place = data::list_places(finding.places);
  finding.what = fmt::format(
      "{} of {} rows are copies of others to the last digit (line {} of line {}): each is counted once",
      set.copies.size(), set.copies.size() + set.points.size(), set.copies.front().line, set.copies.front().of);
  finding.remedy = "remove the copies; a repeated measurement differs in its last digits";
  findings.push_back(std::move(finding));
}

/// Outputs that a set's file has and that were not measured everywhere.
void check_unmeasured(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  const auto note = [&](std::string place, std::string what, std::string remedy) {
    findings.push_back({.kind = data::FindingKind::not_measured,
                        .place = std::move(place),
                        .severity = Severity::note,
                        .what = std::move(what),
                        .remedy = std::move(remedy),
                        .places = {}});
  };
  for (const std::size_t output : set.empty_outputs)
    note(file_of(set), fmt::format("the column {} holds no value: it is not used", study.outputs[output].name),
         "fill it in, or remove the column");
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    std::vector<std::string> places;
    for (const data::Observation& point : set.points)
      if (!point.has(column)) places.push_back(place_of(set, point));
    if (places.empty()) continue;
    note(data::list_places(places),
         fmt::format("{} of {} rows have no {}: they count for the outputs that they have", places.size(),
                     set.points.size(), study.outputs[set.outputs[column]].name),
         "nothing, if it was not measured there");
  }
}

/// Columns that nothing reads: one may be a condition that the runs do not share.
void check_unread(const data::ObservationSet& set, std::vector<Finding>& findings) {
  if (set.unread.empty()) return;
  findings.push_back(
      {.kind = data::FindingKind::unread_columns,
       .place = file_of(set),
       .severity = Severity::note,
       .what = fmt::format("nothing reads the {} {}", set.unread.size() == 1 ? "column" : "columns",
                           fmt::join(set.unread, ", ")),
       .remedy = "a condition among them that moves the readings belongs under [controls], and into the runs",
       .places = {}});
}

/// A file of observations that states what nobody measures is a run table.
void check_run_table(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  if (set.parameter_columns.empty() || set.parameter_columns.size() < study.parameters.size()) return;
  findings.push_back(
      {.kind = data::FindingKind::run_table,
       .place = file_of(set),
       .severity = set.file == study.training.table ? Severity::refusal : Severity::warning,
       .what = fmt::format("'{}' has columns of the parameters ({}), as a run table has, and is read as a measurement",
                           set.name, fmt::join(set.parameter_columns, ", ")),
       .remedy = "name the file of what was measured; where it is that, remove these columns",
       .places = {}});
}

/// Coefficients of the curve about which readings scatter too little: a line, or from seven points on a parabola. One
/// that bends would make scatter of bending, so readings that scatter too much do so about a curve of one more.
Eigen::Index terms_of(Eigen::Index rows) { return rows < 7 ? 2 : 3; }

/// Squared residuals about a polynomial of so many terms in the one control that varies, or in its logarithm or its
/// reciprocal, whichever comes nearest; nothing where there is no such line of points.
std::optional<Eigen::ArrayXd> residuals2(const data::Study& study, const data::ObservationSet& set, std::size_t column,
                                         Eigen::Index terms) {
  const auto rows = static_cast<Eigen::Index>(set.points.size());
  if (rows < 5) return {};
  std::size_t varied = study.controls.size();
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    Extent extent;
    for (const data::Observation& point : set.points) extent.add(point.controls[c]);
    if (!(extent.high - extent.low > 1e-9 * std::abs(extent.high))) continue;
    if (varied < study.controls.size()) return {};  // a surface, not a line
    varied = c;
  }
  if (varied == study.controls.size()) return {};
  Eigen::ArrayXd x(rows), y(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const data::Observation& point = set.points[i];
    x[i] = point.controls[varied];
    y[i] = point.values[column];
  }
  std::vector<Eigen::ArrayXd> scales{x};
  if (x.minCoeff() > 0.0) scales.insert(scales.end(), {x.log(), x.inverse()});
  Eigen::ArrayXd least;
  for (Eigen::ArrayXd& scale : scales) {
    scale = (scale - scale.minCoeff()) / (scale.maxCoeff() - scale.minCoeff());
    Eigen::MatrixXd basis(rows, terms);
    for (Eigen::Index k = 0; k < terms; ++k) basis.col(k) = scale.pow(static_cast<double>(k));
    const Eigen::ArrayXd squares =
        (y.matrix() - basis * basis.colPivHouseholderQr().solve(y.matrix())).array().square();
    if (least.size() == 0 || squares.sum() < least.sum()) least = squares;
  }
  return least;
}

/// Relative errors that are taken for absolute ones are as large for a large reading as for a small one; a column that
/// follows its readings holds absolute errors.
bool follows(const Eigen::ArrayXd& error, const Eigen::ArrayXd& value) {
  const auto spread = [](const Eigen::ArrayXd& x) { return (x.log() - x.log().mean()).square().sum(); };
  return spread(error / value) < spread(error);
}

/// Whether the readings follow a curve once a single one is left out: then that one is off, and not the errors.
bool one_spoils_all(const data::Study& study, const data::ObservationSet& set, std::size_t column) {
  for (std::size_t out = 0; out < set.points.size(); ++out) {
    data::ObservationSet rest = set;
    rest.points.erase(rest.points.begin() + static_cast<std::ptrdiff_t>(out));
    const auto rows = static_cast<Eigen::Index>(rest.points.size());
    const auto found = residuals2(study, rest, column, terms_of(rows));
    if (!found) return false;
    double chi2 = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) chi2 += (*found)[i] / std::pow(rest.points[i].standard_errors[column], 2);
    if (gsl_cdf_chisq_Q(chi2, static_cast<double>(rows - terms_of(rows))) > 1e-3) return true;
  }
  return false;
}

/// Readings whose standard error is far smaller than the others', as it stands and as a share of the value: a slipped
/// digit or another unit. Such a reading outweighs all others.
void check_outweighing(const data::Study& study, const data::ObservationSet& set, std::vector<Finding>& findings) {
  constexpr double far_smaller = 50.0;
  constexpr std::size_t least = 4;  // readings, for the others to have a size
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    if (data::noise_instead(study, set, set.outputs[column]) != nullptr) continue;  // nothing reads them
    const std::vector<std::size_t> rows = data::points_with(set, column);
    std::vector<double> errors, shares;
    for (const std::size_t i : rows) {
      errors.push_back(set.points[i].standard_errors[column]);
      shares.push_back(set.points[i].standard_errors[column] / std::abs(set.points[i].values[column]));
    }
    if (rows.size() < least) continue;
    const double error = data::median_of(errors), share = data::median_of(shares);
    const data::Output& output = study.outputs[set.outputs[column]];
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double times = std::min(error / errors[k], share / shares[k]);
      if (!(times > far_smaller) || !(errors[k] > 0.0)) continue;
      findings.push_back(
          {.kind = data::FindingKind::standard_errors,
           .place = fmt::format("{}: {}_se", place_of(set, set.points[rows[k]]), output.name),
           .severity = Severity::warning,
           .what = fmt::format(
               "the standard error, {:.3g}{}, is {:.0f} times smaller than the other readings' ({:.3g} in the "
               "middle): this reading outweighs all others",
               errors[k] / output.unit.factor, behind_number(output.unit.symbol), times, error / output.unit.factor),
           .remedy = "look for a slipped digit or another unit; where it is meant, give the reading a file of its own",
           .places = {}});
    }
  }
}

void check_errors(const data::Study& study, const data::ObservationSet& whole, const DataCheckThresholds& t,
                  std::vector<Finding>& findings) {
  for (std::size_t column = 0; column < whole.outputs.size(); ++column) {
    if (data::noise_instead(study, whole, whole.outputs[column]) != nullptr) continue;  // nothing reads them
    data::ObservationSet set = whole;
    std::erase_if(set.points, [column](const data::Observation& point) { return !point.has(column); });
    const auto points = static_cast<Eigen::Index>(set.points.size());
    const auto found = residuals2(study, set, column, terms_of(points));
    const auto bent = residuals2(study, set, column, terms_of(points) + 1);
    if (!found) continue;
    const data::Output& output = study.outputs[set.outputs[column]];
    const Eigen::Index rows = found->size();
    Eigen::ArrayXd error(rows), value(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      error[i] = set.points[i].standard_errors[column] / output.unit.factor;
      value[i] = std::abs(output.unit.from_si(set.points[i].values[column]));
    }
    const double dof = static_cast<double>(rows - terms_of(rows));
    const auto chi2 = [&](const Eigen::ArrayXd& residuals2, const Eigen::ArrayXd& s) {
      return (residuals2 / (output.unit.factor * output.unit.factor) / s.square()).sum();
    };
    const Eigen::ArrayXd percent = error * value / 100.0, share = error * value;
    const double below = gsl_cdf_chisq_P(chi2(*found, error), dof);
    const double above = gsl_cdf_chisq_Q(chi2(*bent, error), dof - 1.0);
    const double least = (error / value).minCoeff();
    const bool too_large = below < t.unlikely_scatter && least > 0.05;
    const auto misfit = [](double chi2_of_dof) { return std::abs(std::log(std::max(chi2_of_dof, 1e-300))); };
    const bool percent_fits =
        gsl_cdf_chisq_Q(chi2(*found, percent), dof) > 1e-3 && chi2(*found, percent) > chi2(*found, error);
    const double left = gsl_cdf_chisq_Q(chi2(*bent, share), dof - 1.0);
    const bool share_fits = left > 1e-3 && left < 1.0 - 1e-3;  // nor are the readings too close for such errors
    // Torque meters are hardly better; errors that are not as small may be meant, and the readings drift or scatter.
    constexpr double meters_best = 0.005;
    const bool too_small = above < 1e-9 && share_fits && value.minCoeff() > 1.5 &&
                           (error / value).maxCoeff() < meters_best && !follows(error, value) &&
                           !one_spoils_all(study, set, column);
    if (!(too_large && percent_fits) && !too_small) continue;
    const double scatter =
        too_small ? std::sqrt(chi2(*bent, error) / (dof - 1.0)) : std::sqrt(chi2(*found, error) / dof);
    Finding finding{.kind = data::FindingKind::standard_errors,
                    .place = fmt::format("{}: {}_se", place_of(set, set.points.front()), output.name),
                    .severity = Severity::warning,
                    .what = {},
                    .remedy = {},
                    .places = {}};
    if (too_small) {
      finding.what = fmt::format(
          "the readings scatter {:.3g} times more than their standard errors ({:.3g}{}) say; as shares of the value "
          "they would fit. Are they relative?",
          scatter, error.mean(), behind_number(output.unit.symbol));
      finding.remedy = fmt::format("multiply the column by {}", output.name);
    } else if (misfit(chi2(*found, error / 1000.0) / dof) < misfit(chi2(*found, percent) / dof)) {
      finding.what = fmt::format(
          "the readings scatter {:.3g} times less than their standard errors ({:.3g}{}, {:.0f} % of the value) say; a "
          "thousandth of them would fit. Are they in another unit than {}, by one prefix (m, k)?",
          1.0 / scatter, error.mean(), behind_number(output.unit.symbol), 100.0 * (error / value).mean(), output.name);
      finding.remedy = fmt::format("write the unit of {}_se in its heading", output.name);
    } else {
      finding.what = fmt::format(
          "the readings scatter {:.3g} times less than their standard errors ({:.3g}{}, {:.0f} % of the value) say; "
          "as percentages they would fit. Are they in percent?",
          1.0 / scatter, error.mean(), behind_number(output.unit.symbol), 100.0 * (error / value).mean());
      finding.remedy = fmt::format("multiply the column by {} / 100", output.name);
    }
    findings.push_back(std::move(finding));
  }
}

}  // namespace

std::vector<Finding> check_observations(const data::Study& study, const data::RunTable& table,
                                        const DataCheckThresholds& thresholds) {
  std::vector<Finding> findings;
  for (const data::ObservationSet& set : study.observations) {
    check_run_table(study, set, findings);
    check_unread(set, findings);
    check_copies(set, findings);
    check_unmeasured(study, set, findings);
    if (set.points.empty()) continue;
    check_beside_runs(study, table, set, findings);
    check_errors(study, set, thresholds, findings);
    check_outweighing(study, set, findings);
    check_shared_errors(study, set, findings);
  }
  check_errors_of_sets(study, findings);
  return findings;
}

std::vector<Finding> check_cases(const data::Study& study, const data::RunTable& table,
                                 const std::optional<data::RunTable>& low) {
  std::vector<Finding> findings;
  std::vector<Emulator> emulators;
  try {
    emulators = outlines_of(study, table, low);
  } catch (const data::InputError&) {
    return findings;  // too few runs, which is said elsewhere
  }
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    if (study.cases[i].observe.empty()) continue;
    try {
      build_case(study, emulators, i);
    } catch (const data::InputError& error) {
      for (const data::Problem& problem : error.problems) {
        const bool told = std::any_of(findings.begin(), findings.end(), [&](const Finding& known) {
          return known.place == problem.place && known.what == problem.what;
        });
        if (!told)
          findings.push_back({.kind = data::FindingKind::contradicted_case,
                              .place = problem.place,
                              .severity = Severity::refusal,
                              .what = problem.what,
                              .remedy = problem.remedy,
                              .places = {}});
      }
    }
  }
  return findings;
}

}  // namespace uq
