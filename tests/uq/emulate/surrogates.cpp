// Which surrogates a study needs.
#include "uq/emulate/surrogates.hpp"

#include <catch2/catch.hpp>

#include "surrogate/design.hpp"
#include "tests/uq/formula_study.hpp"

TEST_CASE("an output that is only to be predicted has a surrogate, one that nobody asks for has none", "[uq]") {
  data::Study study = formula::study({0.5}, {formula::torque(0.5, 0.5, 0.5)}, 0.1);
  data::RunTable table = data::empty_table(study);
  const Eigen::MatrixXd design = surrogate::scrambled_sobol(30, 3, 1, 0);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double a = design(i, 0), b = design(i, 1), x = design(i, 2);
    table.rows.push_back({.inputs = {a, b, x},
                          .outputs = {formula::torque(a, b, x), formula::angle(a, b, x)},
                          .standard_errors = {0.01, 0.01}});
  }
  const auto names = [&] {
    std::vector<std::string> found;
    for (const uq::FittedSurrogate& one :
         uq::fit_surrogates(study, table, {.fit = {.starts = 2}, .observed_only = true}))
      found.push_back(one.report.output);
    return found;
  };
  CHECK(names() == std::vector<std::string>{"torque"});
  study.observations.push_back({.name = "later", .outputs = {1}});
  study.unused_data = {{.name = "later", .case_index = 0, .observe = {"later"}}};
  CHECK(names() == std::vector<std::string>{"torque", "angle"});
}
