// What errors common to all readings hold of a width, where it is known in closed form: n readings of a, prior N(0, 1),
// with errors of sd s each and one error of sd c that they share. The posterior's variance is 1 / (1 + 1 / (c^2 + s^2 /
// n)), and 1 / (1 + n / s^2) once the shared error is known.
#include "uq/posterior/common_share.hpp"

#include <catch2/catch.hpp>

#include "tests/uq/closed_form.hpp"

namespace {

using namespace closed_form;

constexpr double own = 0.1, shared = 0.2, readings = 4.0;
const double with = 1.0 / (1.0 + 1.0 / (shared * shared + own * own / readings));
const double without = 1.0 / (1.0 + readings / (own * own));

data::Prior normal(double mean, double sd) {
  return {.kind = data::PriorKind::normal, .low = mean - 9.0 * sd, .high = mean + 9.0 * sd, .mean = mean, .sd = sd};
}

uq::CaseModel repeated(const Formula& formula, double value) {
  return make_case({{"a", -9.0, 9.0, normal(0.0, 1.0)}}, formula, Eigen::VectorXd::Constant(4, 0.5),
                   Eigen::VectorXd::Constant(4, value), Eigen::VectorXd::Constant(4, own));
}

void add_unknown(uq::CaseModel& model, data::NuisanceKind kind, const std::string& name, double mean, double sd) {
  data::Parameter parameter{.name = name, .target = name, .low = mean - 9.0 * sd, .high = mean + 9.0 * sd};
  model.unknowns.push_back({.label = name,
                            .prior = uq::ScaledPrior(parameter, normal(mean, sd)),
                            .own = false,
                            .nuisance = kind,
                            .cut = {}});
}

uq::ReadSet& read(uq::CaseModel& model) {
  model.groups[0].measurement.sets = {{.first = 0, .count = 4, .factors = {}, .offsets = {}, .settings = {}}};
  return model.groups[0].measurement.sets[0];
}

/// Of a, with all unknowns in the middle of their ranges.
uq::CommonShare share_of(uq::CaseModel& model) {
  uq::find_coordinates(model.groups[0], model.dimension());
  return uq::common_shares(model, Eigen::MatrixXd::Constant(3, model.dimension(), 0.5)).at(0);
}

const Formula itself = [](const Eigen::VectorXd& p, double) { return p[0]; };

}  // namespace

TEST_CASE("an offset's share of a width is what knowing the offset would take away", "[uq]") {
  uq::CaseModel model = repeated(itself, 0.0);
  add_unknown(model, data::NuisanceKind::offset, "zero", 0.0, shared);
  read(model).offsets = {1};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == Approx(1.0 - without / with).epsilon(1e-4));
  REQUIRE(found.errors.size() == 1);
  CHECK(found.errors[0].kind == uq::CommonErrorKind::offset);
  CHECK(found.errors[0].name == "zero");
}

TEST_CASE("a common error that is integrated out has the share of an offset that is sampled", "[uq]") {
  uq::CaseModel model = repeated(itself, 0.0);
  read(model).common_absolute = shared;
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == Approx(1.0 - without / with).epsilon(1e-4));
  REQUIRE(found.errors.size() == 1);
  CHECK(found.errors[0].kind == uq::CommonErrorKind::meter);
}

TEST_CASE("a gain's share: of readings of 1 + a near 1, a gain's error is an offset", "[uq]") {
  uq::CaseModel model = repeated([](const Eigen::VectorXd& p, double) { return 1.0 + p[0]; }, 1.0);
  add_unknown(model, data::NuisanceKind::gain, "gain", 1.0, shared);
  read(model).factors = {1};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == Approx(1.0 - without / with).epsilon(1e-4));
  REQUIRE(found.errors.size() == 1);
  CHECK(found.errors[0].kind == uq::CommonErrorKind::gain);
}

TEST_CASE("a setting's share: known to an error that moves all readings alike", "[uq]") {
  // The reading moves with the setting by one per range; the process is asked at it plus and minus its error.
  uq::CaseModel model = repeated([](const Eigen::VectorXd& p, double x) { return p[0] + x; }, 0.5);
  uq::ReadSet& set = read(model);
  set.settings = {{.column = 1, .error = Eigen::VectorXd::Constant(4, shared), .level = Eigen::Vector4d::Zero()}};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == Approx(1.0 - without / with).epsilon(1e-4));
  REQUIRE(found.errors.size() == 1);
  CHECK(found.errors[0].kind == uq::CommonErrorKind::setting);
  // Set anew for each reading it averages out; repeats at these settings still share it, and smaller own errors leave
  // it.
  set.settings[0].level = Eigen::Vector4d(1.0, 2.0, 3.0, 4.0);
  const double anew = 1.0 / (1.0 + readings / (shared * shared + own * own));
  CHECK(share_of(model).share == Approx(1.0 - without / anew).epsilon(1e-4));
}

TEST_CASE("a discrepancy at one setting is common to the readings there", "[uq]") {
  uq::CaseModel model = repeated(itself, 0.0);
  add_unknown(model, data::NuisanceKind::discrepancy_sd, "sd", shared, 0.01);
  add_unknown(model, data::NuisanceKind::discrepancy_length, "length", 1.0, 0.01);
  read(model);
  model.groups[0].measurement.discrepancies = {
      {.first = 0, .count = 4, .sd = 1, .length = 2, .magnitude = 1.0, .controls = Eigen::MatrixXd::Zero(4, 1)}};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == Approx(1.0 - without / with).epsilon(1e-4));
  REQUIRE(found.errors.size() == 1);
  CHECK(found.errors[0].kind == uq::CommonErrorKind::discrepancy);
}

TEST_CASE("of two errors of which each does what the other does, both are named", "[uq]") {
  uq::CaseModel model = repeated(itself, 0.0);
  add_unknown(model, data::NuisanceKind::offset, "first", 0.0, 5.0);
  add_unknown(model, data::NuisanceKind::offset, "second", 0.0, 5.0);
  read(model).offsets = {1, 2};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share > 0.9);
  CHECK(found.errors.size() == 2);
}

TEST_CASE("readings that share no error have no share, and nothing is worked out", "[uq]") {
  uq::CaseModel model = repeated(itself, 0.0);
  model.groups[0].emulator.predict = {};
  const uq::CommonShare found = share_of(model);
  CHECK(found.share == 0.0);
  CHECK(found.errors.empty());
}
