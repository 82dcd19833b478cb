// Lack of fit under errors of unknown size: against the F test of Draper and Smith, done here by least squares.
#include "uq/verdict/lack_of_fit.hpp"

#include <gsl/gsl_cdf.h>

#include <catch2/catch.hpp>

#include "tests/uq/closed_form.hpp"
#include "tests/uq/unknown_errors.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

using namespace closed_form;

namespace {

constexpr Eigen::Index settings = 6, repeats = 4;

/// Readings of 5 + 2 x + bend x^2: each setting has an error of its own, and each of its readings another.
struct Readings {
  Eigen::VectorXd x = Eigen::VectorXd(settings * repeats), y = x;

  Readings(double bend, double shared, double own, std::uint32_t index) {
    data::RandomStream random(31, data::Purpose::test, index);
    for (Eigen::Index j = 0; j < settings; ++j) {
      const double at = static_cast<double>(j) / (settings - 1), common = shared * random.normal();
      for (Eigen::Index i = 0; i < repeats; ++i) {
        x[j * repeats + i] = at;
        y[j * repeats + i] = 5.0 + 2.0 * at + bend * at * at + common + own * random.normal();
      }
    }
  }
};

std::optional<uq::LackOfFit> found(const Readings& readings) {
  const Formula line = [](const Eigen::VectorXd& p, double at) { return p[0] + p[1] * at; };
  uq::CaseModel model = make_case({{"level", -50.0, 60.0}, {"slope", -60.0, 60.0}}, line, readings.x, readings.y,
                                  Eigen::VectorXd::Ones(readings.x.size()));
  unknown_errors::free_noise(model);
  for (Eigen::Index i = 0; i < readings.x.size(); ++i) model.groups[0].origin.push_back({});
  uq::pool_rows(model);
  const Eigen::MatrixXd starts = Eigen::MatrixXd::Constant(1, model.dimension(), 0.5);
  return uq::lack_of_fit(model, uq::maximum_likelihood(model, starts).x);
}

double textbook_f(const Readings& readings) {
  Eigen::MatrixXd design(readings.x.size(), 2);
  design << Eigen::VectorXd::Ones(readings.x.size()), readings.x;
  const Eigen::VectorXd residual = readings.y - design * design.householderQr().solve(readings.y);
  double pure = 0.0;
  for (Eigen::Index j = 0; j < settings; ++j) {
    const auto group = readings.y.segment(j * repeats, repeats);
    pure += (group.array() - group.mean()).square().sum();
  }
  const double lack = residual.squaredNorm() - pure;
  return lack / (settings - 2) / (pure / (settings * (repeats - 1)));
}

}  // namespace

TEST_CASE("of a straight line the lack of fit is that of the textbook", "[uq]") {
  for (const Readings& readings :
       {Readings(0.0, 0.0, 0.1, 1), Readings(2.0, 0.0, 0.1, 2), Readings(0.0, 0.3, 0.1, 3)}) {
    const auto one = found(readings);
    REQUIRE(one);
    const double f = textbook_f(readings);
    CHECK(one->f == Approx(f).epsilon(0.02));
    CHECK(one->p == Approx(gsl_cdf_fdist_Q(f, settings - 2, settings * (repeats - 1))).epsilon(0.1));
    CHECK(one->settings == settings);
    CHECK(one->readings == settings * repeats);
  }
}

TEST_CASE("repeats that share an error, and a model that is off, lack fit, and clean readings do as seldom as p says",
          "[uq]") {
  int clean = 0, shared = 0, bent = 0;
  for (std::uint32_t set = 0; set < 100; ++set) {
    clean += found(Readings(0.0, 0.0, 0.1, 100 + set))->p < 0.1 ? 1 : 0;
    shared += found(Readings(0.0, 0.5, 0.1, 100 + set))->p < 0.001 ? 1 : 0;
    bent += found(Readings(2.0, 0.0, 0.1, 100 + set))->p < 0.001 ? 1 : 0;
  }
  CHECK(clean >= 3);  // 10 +- 3
  CHECK(clean <= 19);
  CHECK(shared >= 95);
  CHECK(bent >= 95);
}

TEST_CASE("readings of known error, or without repeats, have no lack of fit to tell", "[uq]") {
  const Readings readings(0.0, 0.5, 0.1, 5);
  const Formula line = [](const Eigen::VectorXd& p, double at) { return p[0] + p[1] * at; };
  uq::CaseModel known = make_case({{"level", -50.0, 60.0}, {"slope", -60.0, 60.0}}, line, readings.x, readings.y,
                                  Eigen::VectorXd::Constant(readings.x.size(), 0.1));
  CHECK(!uq::lack_of_fit(known, Eigen::Vector2d(0.5, 0.5)));
  unknown_errors::free_noise(known);  // not pooled: every row is a setting of its own
  CHECK(!uq::lack_of_fit(known, Eigen::Vector3d(0.5, 0.5, 0.5)));
}
