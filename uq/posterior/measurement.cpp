#include "uq/posterior/measurement.hpp"

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

double factor_of(const ReadSet& set, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& u) {
  double factor = set.factor;
  for (const int s : set.factors) factor *= unknowns[s].value(u[s]);
  return factor;
}

double offset_of(const ReadSet& set, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& u) {
  double offset = 0.0;
  for (const int s : set.offsets) offset += unknowns[s].value(u[s]);
  return offset;
}

Eigen::VectorXd factors_of(const Measurement& measurement, const std::vector<Unknown>& unknowns,
                           const Eigen::VectorXd& u, Eigen::Index rows) {
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(rows);
  for (const ReadSet& set : measurement.sets)
    factors.segment(set.first, set.count).setConstant(factor_of(set, unknowns, u));
  return factors;
}

/// Half the change of the prediction between the two shifted copies number `shift` of all rows, without the factor.
Eigen::VectorXd half_change(const Eigen::VectorXd& extended, Eigen::Index rows, std::size_t shift) {
  const auto at = static_cast<Eigen::Index>(1 + 2 * shift) * rows;
  return 0.5 * (extended.segment(at, rows) - extended.segment(at + rows, rows));
}

/// Calls add(set, shift number, setting) for each uncertain control.
template <class Add>
void for_each_setting(const Measurement& measurement, const Add& add) {
  for (const ReadSet& set : measurement.sets)
    for (std::size_t q = 0; q < set.settings.size(); ++q) add(set, q, set.settings[q]);
}

/// a b' + b a' of a set's rows.
Eigen::MatrixXd pair_of(const ReadSet& set, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.segment(set.first, set.count), y = b.segment(set.first, set.count);
  return x * y.transpose() + y * x.transpose();
}

auto block_of(Eigen::MatrixXd& covariance, const ReadSet& set) {
  return covariance.block(set.first, set.first, set.count, set.count);
}

/// d correlation / d length.
Eigen::MatrixXd correlation_slope(const Eigen::MatrixXd& controls, double length) {
  Eigen::MatrixXd slope(controls.rows(), controls.rows());
  for (Eigen::Index i = 0; i < controls.rows(); ++i)
    for (Eigen::Index j = 0; j < controls.rows(); ++j) {
      const double r = std::sqrt(5.0) * (controls.row(i) - controls.row(j)).norm() / length;
      slope(i, j) = r * r / (3.0 * length) * (1.0 + r) * std::exp(-r);
    }
  return slope;
}

/// Change of mean and covariance with factors df, prediction dm (rows and copies) and emulator covariance dC.
struct Change {
  Eigen::VectorXd factors, mean;
  Eigen::MatrixXd covariance;
};

struct State {
  const Measurement& measurement;
  Eigen::VectorXd factors, mean;  // mean: of the emulator, rows and copies
  Eigen::MatrixXd covariance;     // of the emulator, rows alone
};

void add_change(const State& state, const Change& change, LawGradient& sum) {
  const Eigen::Index rows = state.factors.size();
  const Eigen::VectorXd& f = state.factors;
  const Eigen::VectorXd& df = change.factors;
  const Eigen::VectorXd m = state.mean.head(rows), dm = change.mean.head(rows);
  const Eigen::VectorXd read = f.cwiseProduct(m), dread = df.cwiseProduct(m) + f.cwiseProduct(dm);
  const Eigen::MatrixXd mixed = df * f.transpose();
  Eigen::MatrixXd covariance =
      (mixed + mixed.transpose()).cwiseProduct(state.covariance) + (f * f.transpose()).cwiseProduct(change.covariance);
  for (const ReadSet& set : state.measurement.sets)
    if (set.common_relative > 0.0)
      block_of(covariance, set) += std::pow(set.common_relative, 2) * pair_of(set, read, dread);
  for_each_setting(state.measurement, [&](const ReadSet& set, std::size_t q, const SettingShift& setting) {
    const Eigen::VectorXd h = half_change(state.mean, rows, q), dh = half_change(change.mean, rows, q);
    const Eigen::VectorXd t = f.cwiseProduct(h), dt = df.cwiseProduct(h) + f.cwiseProduct(dh);
    block_of(covariance, set) += pair_of(set, t, dt).cwiseProduct(same_level(setting.level, setting.level));
  });
  sum.mean.push_back(dread);
  sum.covariance.push_back(std::move(covariance));
}

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

Eigen::MatrixXd same_level(const Eigen::VectorXd& rows, const Eigen::VectorXd& columns) {
  Eigen::MatrixXd same(rows.size(), columns.size());
  for (Eigen::Index j = 0; j < columns.size(); ++j) same.col(j) = (rows.array() == columns[j]).cast<double>();
  return same;
}

int Measurement::shifts() const {
  std::size_t most = 0;
  for (const ReadSet& set : sets) most = std::max(most, set.settings.size());
  return static_cast<int>(2 * most);
}

void place_shifts(const Measurement& measurement, Eigen::MatrixXd& points, Eigen::Index first, Eigen::Index rows) {
  for (Eigen::Index copy = 1; copy <= measurement.shifts(); ++copy)
    points.middleRows(first + copy * rows, rows) = points.middleRows(first, rows);
  for_each_setting(measurement, [&](const ReadSet& set, std::size_t q, const SettingShift& setting) {
    const Eigen::Index up = first + static_cast<Eigen::Index>(1 + 2 * q) * rows + set.first;
    points.col(setting.column).segment(up, set.count) += setting.error;
    points.col(setting.column).segment(up + rows, set.count) -= setting.error;
  });
}

Eigen::MatrixXd discrepancy_correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double length) {
  Eigen::MatrixXd correlation(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
      const double r = std::sqrt(5.0) * (a.row(i) - b.row(j)).norm() / length;
      correlation(i, j) = (1.0 + r + r * r / 3.0) * std::exp(-r);
    }
  return correlation;
}

Meter meter_at(const Measurement& measurement, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& u,
               Eigen::Index row) {
  for (const ReadSet& set : measurement.sets) {
    if (row < set.first || row >= set.first + set.count) continue;
    return {.factor = factor_of(set, unknowns, u), .offset = offset_of(set, unknowns, u)};
  }
  return {};
}

Eigen::VectorXd noise_of(const Measurement& measurement, const std::vector<Unknown>& unknowns,
                         const Eigen::VectorXd& variance, const Eigen::VectorXd& u) {
  Eigen::VectorXd noise = variance;
  for (const ReadSet& set : measurement.sets) {
    if (set.noise < 0) continue;
    const double k = unknowns[set.noise].value(u[set.noise]);
    if (set.noise_is_sd) {
      noise.segment(set.first, set.count).setConstant(k * k);
    } else {
      noise.segment(set.first, set.count) *= k * k;
    }
  }
  return noise;
}

GroupLaw law_of(const Measurement& measurement, const std::vector<Unknown>& unknowns, const Eigen::VectorXd& variance,
                const surrogate::Prediction& prediction, const Eigen::VectorXd& u) {
  const Eigen::Index rows = variance.size();
  const auto value = [&](int s) { return unknowns[s].value(u[s]); };
  const Eigen::VectorXd f = factors_of(measurement, unknowns, u, rows);
  GroupLaw law{.mean = f.cwiseProduct(prediction.mean.head(rows)),
               .covariance = (f * f.transpose()).cwiseProduct(prediction.covariance.topLeftCorner(rows, rows)),
               .noise = noise_of(measurement, unknowns, variance, u)};
  for (const ReadSet& set : measurement.sets) {
    if (set.common_relative > 0.0)
      block_of(law.covariance, set) += 0.5 * std::pow(set.common_relative, 2) * pair_of(set, law.mean, law.mean);
    block_of(law.covariance, set).array() += set.common_absolute * set.common_absolute;
  }
  for_each_setting(measurement, [&](const ReadSet& set, std::size_t q, const SettingShift& setting) {
    const Eigen::VectorXd t = f.cwiseProduct(half_change(prediction.mean, rows, q));
    block_of(law.covariance, set) += 0.5 * pair_of(set, t, t).cwiseProduct(same_level(setting.level, setting.level));
    law.settings.emplace_back(t.segment(set.first, set.count));
  });
  for (const DiscrepancyRows& part : measurement.discrepancies)
    law.covariance.block(part.first, part.first, part.count, part.count) +=
        std::pow(value(part.sd) * part.magnitude, 2) *
        discrepancy_correlation(part.controls, part.controls, value(part.length));
  for (const ReadSet& set : measurement.sets)  // last: a relative error is of the meter's reading without its offset
    law.mean.segment(set.first, set.count).array() += offset_of(set, unknowns, u);
  return law;
}

LawGradient law_gradient(const Measurement& measurement, const std::vector<Unknown>& unknowns,
                         const Eigen::VectorXd& variance, const surrogate::PredictionGradient& prediction,
                         const std::pair<std::vector<int>, Eigen::VectorXd>& along_and_u) {
  const auto& [along, u] = along_and_u;
  const Eigen::Index rows = variance.size(), extended = prediction.value.mean.size();
  const State state{.measurement = measurement,
                    .factors = factors_of(measurement, unknowns, u, rows),
                    .mean = prediction.value.mean,
                    .covariance = prediction.value.covariance.topLeftCorner(rows, rows)};
  LawGradient found{.along = along, .mean = {}, .covariance = {}};
  for (std::size_t k = 0; k < along.size(); ++k)
    add_change(state,
               {.factors = Eigen::VectorXd::Zero(rows),
                .mean = prediction.mean_gradient[k],
                .covariance = prediction.covariance_gradient[k].topLeftCorner(rows, rows)},
               found);

  for (int s = 0; s < static_cast<int>(unknowns.size()); ++s) {
    const Unknown& unknown = unknowns[s];
    if (!unknown.nuisance || contains(along, s)) continue;
    const double value = unknown.value(u[s]), slope = unknown.slope(u[s]);
    Eigen::VectorXd factors = Eigen::VectorXd::Zero(rows), offset = Eigen::VectorXd::Zero(rows);
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(rows);
    for (const ReadSet& set : measurement.sets) {
      if (contains(set.factors, s))
        factors.segment(set.first, set.count) = state.factors.segment(set.first, set.count) * (slope / value);
      if (contains(set.offsets, s)) offset.segment(set.first, set.count).setConstant(slope);
      if (set.noise != s) continue;
      if (set.noise_is_sd) {
        noise.segment(set.first, set.count).setConstant(2.0 * value * slope);
      } else {
        noise.segment(set.first, set.count) = 2.0 * value * slope * variance.segment(set.first, set.count);
      }
    }
    found.along.push_back(s);
    add_change(
        state,
        {.factors = factors, .mean = Eigen::VectorXd::Zero(extended), .covariance = Eigen::MatrixXd::Zero(rows, rows)},
        found);
    found.mean.back() += offset;
    found.covariance.back().diagonal() += noise;
    for (const DiscrepancyRows& part : measurement.discrepancies) {
      if (part.sd != s && part.length != s) continue;
      const double square = part.magnitude * part.magnitude;
      const double sd = unknowns[part.sd].value(u[part.sd]);
      const double length = unknowns[part.length].value(u[part.length]);
      Eigen::MatrixXd change(part.count, part.count);
      if (part.sd == s) {
        change = 2.0 * sd * slope * square * discrepancy_correlation(part.controls, part.controls, length);
      } else {
        change = sd * sd * square * slope * correlation_slope(part.controls, length);
      }
      found.covariance.back().block(part.first, part.first, part.count, part.count) += change;
    }
  }
  return found;
}

}  // namespace uq
