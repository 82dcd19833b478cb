// Curves of the predictive against a control that is itself an unknown of the case.
#include "uq/posterior/predictive.hpp"

#include <catch2/catch.hpp>

#include "tests/temporary.hpp"
#include "uq/calibrate/calibrate.hpp"

using namespace uq;

namespace {

/// torque = (friction + (fill - 100 g) / 1 kg) N m; fill is the first control.
std::vector<Emulator> formula() {
  Emulator emulator{.material = "",
                    .output = 0,
                    .inputs = {{InputKind::parameter, 0}, {InputKind::control, 0}},
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return {.mean = points.col(0) + 0.2 * (points.col(1).array() - 0.5).matrix(),
            .covariance = Eigen::MatrixXd::Zero(points.rows(), points.rows())};
  };
  return {emulator};
}

}  // namespace

TEST_CASE("a curve against a control rises as the model does, though the control is an unknown setting", "[uq]") {
  const TemporaryFolder folder;
  folder.write("bench.csv", "fill,torque,torque_se\n100,0.47,0.04\n100,0.52,0.04\n100,0.53,0.04\n");
  const data::StudyFile file = data::StudyFile::open(folder.write(
      "study.toml",
      "[study]\nname = \"s\"\nseed = 5\n[parameters.friction]\nlow = 0\nhigh = 1\n[training]\ntable = \"runs.csv\"\n"
      "[outputs.torque]\nunit = \"N m\"\n[controls.fill]\nunit = \"g\"\nlow = 0\nhigh = 200\n"
      "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n"
      "uncertainty = { fill = { sd = \"5 g\", as = \"unknown\" } }\n"
      "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\"]\n"));
  const data::Study study = data::read_study(file);
  file.finish();
  const auto model = std::make_shared<const CaseModel>(build_case(study, formula(), 0));
  REQUIRE(model->dimension() == 2);
  const Eigen::MatrixXd draws = Eigen::RowVector2d(0.5, model->unknowns[1].prior.mean()).replicate(3, 1);
  for (const auto& curves :
       {predictive_curves(study, *model, draws, 1), mean_curves(study, *model, draws.row(0).transpose())}) {
    REQUIRE(curves.size() == 1);
    const PredictiveCurve& curve = curves[0];
    CHECK(curve.control == "fill");
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      CHECK(curve.mean[i] == Approx(0.5 + (curve.x[i] - 100.0) / 1000.0).margin(1e-12));
    CHECK(curve.x.back() - curve.x.front() == Approx(200.0));
  }
}
