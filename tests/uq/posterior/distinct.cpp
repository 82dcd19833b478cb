// Rows measured again at the same settings count as one, and nothing changes but the time.
#include "uq/posterior/distinct.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

using namespace uq;

namespace {

const closed_form::Formula line = [](const Eigen::VectorXd& p, double x) { return p[0] + p[1] * x * x; };

/// Four settings, each measured `times` times with errors of their own; the emulator has an error that grows with p.
CaseModel repeated(int times) {
  Eigen::VectorXd x(4 * times), y(4 * times), sd(4 * times);
  data::RandomStream random(31, data::Purpose::test);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] = 0.25 * static_cast<double>(i % 4);
    sd[i] = 0.02 + 0.01 * static_cast<double>(i % 3);
    y[i] = 0.4 + 0.3 * x[i] * x[i] + sd[i] * random.normal();
  }
  CaseModel model = closed_form::make_case({{"p", 0.0, 1.0}, {"q", 0.0, 1.0}}, line, x, y, sd);
  Emulator& emulator = model.groups[0].emulator;
  emulator.predict = [exact = emulator.predict](const Eigen::MatrixXd& points) {
    surrogate::Prediction found = exact(points);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      for (Eigen::Index j = 0; j < points.rows(); ++j)
        found.covariance(i, j) = 1e-4 * (1.0 + points(i, 0)) * std::exp(-std::pow(points(i, 2) - points(j, 2), 2));
    return found;
  };
  return model;
}

/// A third unknown that multiplies the standard errors, or takes their place.
void free_noise(CaseModel& model, bool is_sd) {
  const double low = is_sd ? 0.005 : 0.2, high = is_sd ? 0.2 : 5.0;
  const data::Parameter parameter = closed_form::parameter_of({"noise", low, high});
  model.unknowns.push_back({.label = "noise",
                            .prior = ScaledPrior(parameter, parameter.prior),
                            .own = false,
                            .nuisance = is_sd ? data::NuisanceKind::noise_sd : data::NuisanceKind::noise_scale,
                            .cut = {}});
  RowGroup& group = model.groups[0];
  group.measurement.sets.push_back({.first = 0,
                                    .count = group.base.rows(),
                                    .factors = {},
                                    .noise = 2,
                                    .noise_is_sd = is_sd,
                                    .common_absolute = 0.01,
                                    .settings = {}});
  find_coordinates(group, 3);
}

void is_the_same(const CaseModel& plain) {
  CaseModel pooled = plain;
  pool_rows(pooled);
  REQUIRE(pooled.distinct);
  CHECK(distinct_rows(pooled).row_count() == 4);
  data::RandomStream random(32, data::Purpose::test);
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd u(plain.dimension());
    for (double& value : u) value = random.uniform(0.05, 0.95);
    const double exact = log_likelihood(plain, u);
    CHECK(log_likelihood(pooled, u) == Approx(exact).epsilon(1e-9));
    CHECK(log_likelihoods(pooled, u.transpose())[0] == Approx(exact).epsilon(1e-9));
    CHECK(chi_squared(pooled, u) == Approx(chi_squared(plain, u)).epsilon(1e-9));
    const Evaluation with = log_likelihood_gradient(pooled, u), without = log_likelihood_gradient(plain, u);
    CHECK(with.value == Approx(without.value).epsilon(1e-9));
    CHECK((with.gradient - without.gradient).norm() < 1e-4 * (1.0 + without.gradient.norm()));
    CHECK((pointwise_log_likelihoods(pooled, u.transpose()) - pointwise_log_likelihoods(plain, u.transpose())).norm() <
          1e-9);
    CHECK((predict(pooled, u).total() - predict(plain, u).total()).norm() < 1e-12);
    CHECK((predict(pooled, u).mean - predict(plain, u).mean).norm() < 1e-12);
    CHECK((fisher_spectrum(pooled, u).eigenvalues - fisher_spectrum(plain, u).eigenvalues).norm() <
          1e-6 * fisher_spectrum(plain, u).eigenvalues.norm());
  }
}

}  // namespace

TEST_CASE("pooled rows give the likelihood, its slope, chi squared and Fisher information of all rows", "[uq]") {
  is_the_same(repeated(5));
}

TEST_CASE("so they do where the noise is unknown", "[uq]") {
  for (const bool is_sd : {false, true}) {
    CaseModel model = repeated(6);
    free_noise(model, is_sd);
    is_the_same(model);
  }
}

TEST_CASE("replicate data of pooled rows scatter as the full law says", "[uq]") {
  CaseModel pooled = repeated(3);
  pool_rows(pooled);
  const Eigen::VectorXd u = Eigen::Vector2d(0.4, 0.3);
  const Eigen::MatrixXd made = replicates(pooled, u.transpose().replicate(20000, 1), 5);
  const StackedPrediction law = predict(repeated(3), u);
  const Eigen::MatrixXd centred = made.rowwise() - law.mean.transpose();
  const Eigen::MatrixXd covariance = centred.transpose() * centred / 20000.0, total = law.total();
  for (Eigen::Index i = 0; i < total.rows(); ++i)
    for (Eigen::Index j = 0; j < total.cols(); ++j)
      CHECK(std::abs(covariance(i, j) - total(i, j)) <
            5.0 * std::sqrt((total(i, i) * total(j, j) + total(i, j) * total(i, j)) / 20000.0));
}

TEST_CASE("1,500 observations at six settings ask for as many predictions as six", "[uq]") {
  const auto rows_predicted = [](int times) {
    CaseModel model = repeated(times);
    Eigen::Index rows = 0;
    for (RowGroup& group : model.groups)
      group.emulator.predict = [&rows, inner = group.emulator.predict](const Eigen::MatrixXd& points) {
        rows += points.rows();
        return inner(points);
      };
    pool_rows(model);
    rows = 0;
    CHECK(std::isfinite(log_likelihood(model, Eigen::Vector2d(0.4, 0.3))));
    return rows;
  };
  CHECK(rows_predicted(1) > 0);
  CHECK(rows_predicted(375) == rows_predicted(1));
}
