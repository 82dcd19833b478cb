// What the scan of other measurement errors makes up: data of the model itself, whatever their errors have in common.
#include <catch2/catch.hpp>

#include "tests/uq/formula_study.hpp"
#include "uq/calibrate/calibrate.hpp"

using namespace uq;

TEST_CASE("the scan's data fit the model that they are made of, also where errors of two outputs go together", "[uq]") {
  // A correlation of 0.95: independent errors would be several of the difference's own sds apart at each speed.
  data::Study study = formula::study({}, {}, 0.1);
  data::ObservationSet& set = study.observations[0];
  set.outputs = {0, 1};
  for (int i = 0; i < 8; ++i) {
    const double x = i / 7.0;
    set.points.push_back({.controls = {x},
                          .values = {formula::torque(0.4, 0.6, x), formula::angle(0.4, 0.6, x)},
                          .standard_errors = {0.3, 0.3}});
  }
  set.correlations = {{.output = 0, .other_output = 1, .other_set = set.name, .value = 0.95}};
  const CalibrateOptions options{.error_scan = {0.01, 0.03, 0.05}, .quadrature = false};
  const SampledCase sampled = sample_case(study, formula::emulators(), 0, options);
  const std::vector<ErrorScan> scans = scan_errors(study, sampled, 0, options);
  REQUIRE(scans.size() == 3);
  for (const ErrorScan& scan : scans) {
    INFO("at " << scan.relative_error);
    CHECK(scan.ppp > 0.01);
  }
}
