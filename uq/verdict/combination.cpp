#include "uq/verdict/combination.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "data/random.hpp"
#include "data/shuffle.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

using Eigen::Index;

double sd_of(const Eigen::VectorXd& x) {
  return std::sqrt((x.array() - x.mean()).square().sum() / static_cast<double>(x.size()));
}

/// Spread of sum_i w_i t_i over what it would be with independent terms.
double spread_along(const Eigen::MatrixXd& terms, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd sums = terms * weights;
  double independent = 0.0;
  for (Index i = 0; i < terms.cols(); ++i) independent += std::pow(weights[i] * sd_of(terms.col(i)), 2);
  return independent > 0.0 ? sd_of(sums) / std::sqrt(independent) : 1.0;
}

/// Largest over the terms of the combination's sd in that of the term.
double share_of_least(const Eigen::MatrixXd& terms, const Eigen::VectorXd& weights) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < terms.cols(); ++i) least = std::min(least, std::abs(weights[i]) * sd_of(terms.col(i)));
  return least > 0.0 ? sd_of(terms * weights) / least : std::numeric_limits<double>::infinity();
}

/// Weights of least spread; the first one positive.
Eigen::VectorXd least_varying(const Eigen::MatrixXd& terms) {
  Eigen::MatrixXd unit = terms.rowwise() - terms.colwise().mean();
  Eigen::VectorXd sd(terms.cols());
  for (Index i = 0; i < terms.cols(); ++i) {
    sd[i] = std::max(sd_of(terms.col(i)), std::numeric_limits<double>::min());
    unit.col(i) /= sd[i];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit.transpose() * unit);
  Eigen::VectorXd weights = solver.eigenvectors().col(0).array() / sd.array();
  return weights[0] < 0.0 ? Eigen::VectorXd(-weights) : weights;
}

/// Weights in small whole proportions that hold as well as the given ones; the given ones where there are none.
Eigen::VectorXd simplified(const Eigen::MatrixXd& terms, const Eigen::VectorXd& weights, bool& simple) {
  constexpr double as_well = 1.15;  // spread, relative to the best
  constexpr int largest = 6;
  const double wanted = as_well * spread_along(terms, weights) + 1e-3;
  const double least = weights.cwiseAbs().minCoeff();
  simple = false;
  if (!(least > 0.0)) return weights;
  for (const int multiple : {1, 2, 3}) {
    Eigen::VectorXd whole(weights.size());
    for (Index i = 0; i < weights.size(); ++i) whole[i] = std::round(multiple * weights[i] / least);
    if (whole.cwiseAbs().maxCoeff() > largest || whole.cwiseAbs().minCoeff() < 1.0) continue;
    if (spread_along(terms, whole) > wanted) continue;
    simple = true;
    return whole;
  }
  return weights;
}

/// log x of each column, where all but few values are positive and clear of zero; else empty.
Eigen::MatrixXd logs_of(const Eigen::MatrixXd& values, const Eigen::VectorXd& ranges) {
  std::vector<Index> kept;
  for (Index i = 0; i < values.rows(); ++i) {
    bool clear = true;
    for (Index k = 0; k < values.cols(); ++k) clear = clear && values(i, k) > 1e-3 * ranges[k];
    if (clear) kept.push_back(i);
  }
  if (kept.size() < 4 || kept.size() < static_cast<std::size_t>(values.rows()) * 9 / 10) return {};
  Eigen::MatrixXd logs(static_cast<Index>(kept.size()), values.cols());
  for (std::size_t i = 0; i < kept.size(); ++i) logs.row(i) = values.row(kept[i]).array().log();
  return logs;
}

std::string decimal(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  return text;
}

/// "^0.9", nothing for 1.
std::string power_text(double exponent) {
  std::string text = fmt::format("{:.2f}", exponent);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "1" ? "" : "^" + text;
}

double rounded(double value, int digits) { return std::stod(decimal(value, digits)); }

}  // namespace

FittedCombination fit_combination(const Eigen::MatrixXd& values, const Eigen::VectorXd& ranges) {
  const Index m = values.cols();
  FittedCombination best;
  double best_score = std::numeric_limits<double>::infinity();
  // `handicap` is the margin by which a form must win over the plain ones.
  const auto consider = [&](const Eigen::MatrixXd& terms, CombinationForm form, const std::vector<double>& powers,
                            double handicap) {
    const Eigen::VectorXd free = least_varying(terms);
    bool simple = false;
    const Eigen::VectorXd weights = simplified(terms, free, simple);
    FittedCombination found{.form = form,
                            .terms = {},
                            .spread = spread_along(terms, weights),
                            .share = share_of_least(terms, weights),
                            .exact_numbers = simple};
    const double score = (found.spread + 1e-4) * handicap * (simple ? 1.0 : 1.05);
    if (score >= best_score) return;
    best_score = score;
    for (Index i = 0; i < m; ++i) {
      if (form == CombinationForm::product)
        found.terms.push_back({.power = weights[i], .coefficient = 1.0});
      else
        found.terms.push_back({.power = powers[i], .coefficient = weights[i]});
    }
    best = std::move(found);
  };
  consider(values, CombinationForm::sum, std::vector<double>(static_cast<std::size_t>(m), 1.0), 1.0);
  if (const Eigen::MatrixXd logs = logs_of(values, ranges); logs.size() > 0)
    consider(logs, CombinationForm::product, {}, 1.0);
  if (m == 2)
    for (const auto& [first, second] : {std::pair{1.0, 2.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 3.0}, {3.0, 1.0}}) {
      Eigen::MatrixXd terms = values;
      for (Index i = 0; i < values.rows(); ++i) {
        terms(i, 0) = std::pow(values(i, 0), first);
        terms(i, 1) = std::pow(values(i, 1), second);
      }
      consider(terms, CombinationForm::sum, {first, second}, 1.5);
    }
  return best;
}

double evaluate(const FittedCombination& combination, const Eigen::VectorXd& row) {
  const bool product = combination.form == CombinationForm::product;
  double value = product ? 1.0 : 0.0;
  for (Index i = 0; i < row.size(); ++i) {
    const CombinationTerm& term = combination.terms[i];
    const double raised = std::pow(row[i], term.power);
    value = product ? value * raised : value + term.coefficient * raised;
  }
  return value;
}

double filled_share(const Eigen::MatrixXd& values) {
  // A chain that stays repeats its values: each counts once.
  constexpr Index most = 400;
  std::vector<Index> order(static_cast<std::size_t>(values.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return values(a, 0) < values(b, 0); });
  order.erase(std::unique(order.begin(), order.end(), [&](Index a, Index b) { return values(a, 0) == values(b, 0); }),
              order.end());
  const auto unique = static_cast<Index>(order.size()), n = std::min(unique, most);
  if (n < 50) return 1.0;
  const Index m = values.cols();
  Eigen::MatrixXd ranks(n, m);
  for (Index k = 0; k < m; ++k) {
    std::vector<std::pair<double, Index>> sorted;
    for (Index i = 0; i < n; ++i) sorted.emplace_back(values(order[static_cast<std::size_t>(i * unique / n)], k), i);
    std::sort(sorted.begin(), sorted.end());
    for (Index i = 0; i < n; ++i) ranks(sorted[i].second, k) = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  }
  const auto log_distance = [&](const Eigen::MatrixXd& points) {
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (Index j = 0; j < n; ++j)
        if (j != i) least = std::min(least, (points.row(i) - points.row(j)).squaredNorm());
      sum += 0.5 * std::log(std::max(least, 1e-12));
    }
    return sum / static_cast<double>(n);
  };
  Eigen::MatrixXd shuffled = ranks;
  data::RandomStream random(1, data::Purpose::shuffled_points);
  for (Index k = 1; k < m; ++k) data::shuffle(std::span(shuffled.col(k).data(), static_cast<std::size_t>(n)), random);
  return std::exp(static_cast<double>(m) * (log_distance(ranks) - log_distance(shuffled)));
}

namespace {

/// Columns as they are printed: names in units of a power of ten near their values, where units would be mixed.
struct PrintedColumns {
  std::vector<std::string> names, own;  ///< with that unit, and without
  std::vector<double> scales;           ///< of it

  std::string raised(std::size_t i, double power, bool divides = false) const {
    const std::string exponent = power_text(power);
    const bool brackets = (!exponent.empty() || divides) && names[i] != own[i];
    return (brackets ? "(" + names[i] + ")" : names[i]) + exponent;
  }
};

/// `plain`: the combination has a unit of its own, or none of the columns has one.
PrintedColumns printed(const std::vector<CombinationColumn>& columns, bool plain, bool product) {
  PrintedColumns all;
  for (const CombinationColumn& column : columns) {
    double scale = 1.0;
    std::string name = column.name;
    const double decade = column.typical > 0.0 ? std::floor(std::log10(column.typical)) : 0.0;
    if (!plain && !is_bare(column.unit)) {
      if (decade < -2.0 || decade > 3.0) scale = std::pow(10.0, decade);
      name += scale == 1.0 ? fmt::format("/({})", column.unit) : fmt::format("/({:.0e} {})", scale, column.unit);
    } else if (plain && is_bare(column.unit) && !product && (decade < -3.0 || decade > 4.0)) {
      scale = std::pow(10.0, decade);
      name += fmt::format("/{:.0e}", scale);
    }
    all.names.push_back(name);
    all.own.push_back(column.name);
    all.scales.push_back(scale);
  }
  return all;
}

/// The smaller exponent of a pair is one, unless all are whole.
void round_powers(std::vector<CombinationTerm>& terms) {
  const double first = std::abs(terms[0].power);
  const double reference =
      terms.size() == 2 && std::abs(terms[1].power) < 0.667 * first ? std::abs(terms[1].power) : first;
  for (CombinationTerm& term : terms) term.power = std::round(100.0 * term.power / reference) / 100.0;
}

/// Writes a product: factors first, the one with the plain exponent in front, then divisors.
void write_product(const PrintedColumns& columns, CombinationText& out) {
  std::vector<CombinationTerm>& terms = out.written.terms;
  const bool flip = std::all_of(terms.begin(), terms.end(), [](const auto& term) { return term.power < 0.0; });
  for (CombinationTerm& term : terms) term.power = flip ? -term.power : term.power;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (terms[i].power > 0.0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return terms[a].power == 1.0 && terms[b].power != 1.0; });
  for (const std::size_t i : order) out.text += (out.text.empty() ? "" : " * ") + columns.raised(i, terms[i].power);
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (terms[i].power < 0.0) out.text += " / " + columns.raised(i, -terms[i].power, true);
  for (std::size_t i = 0; i < terms.size(); ++i) out.scale *= std::pow(columns.scales[i], -terms[i].power);
}

/// The first coefficient is one; the others are those that are printed.
void write_sum(const PrintedColumns& columns, int digits, CombinationText& out) {
  std::vector<CombinationTerm>& terms = out.written.terms;
  const double first = terms[0].coefficient * std::pow(columns.scales[0], terms[0].power);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const double unit = std::pow(columns.scales[i], terms[i].power);
    const double shown = i == 0 ? 1.0 : rounded(terms[i].coefficient * unit / first, digits);
    terms[i].coefficient = shown / unit;
    const double size = std::abs(shown);
    if (i > 0) out.text += shown < 0.0 ? " - " : " + ";
    if (size != 1.0) out.text += decimal(size, digits) + " x ";
    out.text += columns.raised(i, terms[i].power);
  }
}

}  // namespace

CombinationText write_combination(const FittedCombination& combination, const std::vector<CombinationColumn>& columns) {
  CombinationText out{.text = {}, .unit = {}, .scale = 1.0, .written = combination};
  std::vector<CombinationTerm>& terms = out.written.terms;
  const bool product = combination.form == CombinationForm::product;
  const auto with_unit = std::count_if(columns.begin(), columns.end(),
                                       [&](const CombinationColumn& column) { return !is_bare(column.unit); });
  const bool same_unit = std::all_of(columns.begin(), columns.end(), [&](const CombinationColumn& column) {
    return column.unit == columns.front().unit || (is_bare(column.unit) && is_bare(columns.front().unit));
  });
  if (product && !combination.exact_numbers) round_powers(terms);
  if (!product && same_unit) out.unit = columns.front().unit;
  for (std::size_t i = 0; product && i < terms.size(); ++i)
    if (!is_bare(columns[i].unit) && with_unit == 1 && terms[i].power == 1.0) out.unit = columns[i].unit;
  const PrintedColumns shown = printed(columns, !out.unit.empty() || with_unit == 0, product);
  if (product)
    write_product(shown, out);
  else
    write_sum(shown, combination.spread < 0.02 ? 3 : 2, out);
  return out;
}

}  // namespace uq
