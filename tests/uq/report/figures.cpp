#include "uq/report/figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "data/error.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/findings/report_fixture.hpp"
#include "uq/report/density.hpp"
#include "uq/report/plot.hpp"

using namespace uq;

namespace {

struct Sample {
  std::vector<double> x, y;
};

Sample correlated(int n, double correlation) {
  data::RandomStream random(2, data::Purpose::test, 7);
  Sample sample;
  for (int i = 0; i < n; ++i) {
    const double a = random.normal(), b = random.normal();
    sample.x.push_back(a);
    sample.y.push_back(correlation * a + std::sqrt(1.0 - correlation * correlation) * b);
  }
  return sample;
}

/// Whether a point lies inside a set of closed loops (even-odd rule).
bool inside(const std::vector<Loop>& loops, double x, double y) {
  bool in = false;
  for (const Loop& loop : loops) {
    for (std::size_t i = 0, j = loop.x.size() - 1; i < loop.x.size(); j = i++) {
      if ((loop.y[i] > y) == (loop.y[j] > y)) continue;
      if (x < loop.x[i] + (y - loop.y[i]) / (loop.y[j] - loop.y[i]) * (loop.x[j] - loop.x[i])) in = !in;
    }
  }
  return in;
}

double share_inside(const std::vector<Loop>& loops, const Sample& sample) {
  double count = 0.0;
  for (std::size_t i = 0; i < sample.x.size(); ++i) count += inside(loops, sample.x[i], sample.y[i]) ? 1.0 : 0.0;
  return count / static_cast<double>(sample.x.size());
}

}  // namespace

TEST_CASE("the drawn regions hold the share of fresh draws that they name") {
  const Sample drawn = correlated(1500, 0.9);
  const PlotBox box{.x_low = -5.0, .x_high = 5.0, .y_low = -5.0, .y_high = 5.0};
  const DensityGrid grid = joint_density(drawn.x, drawn.y, box);
  Sample fresh = correlated(6000, 0.9);
  fresh.x.erase(fresh.x.begin(), fresh.x.begin() + 1500);
  fresh.y.erase(fresh.y.begin(), fresh.y.begin() + 1500);
  // A smoothed density is a little wider than the draws.
  CHECK(share_inside(contour(grid, box, grid.level50), fresh) == Approx(0.5).margin(0.12));
  CHECK(share_inside(contour(grid, box, grid.level90), fresh) == Approx(0.9).margin(0.06));
}

TEST_CASE("the density sums to one and leaks through no bound") {
  data::RandomStream random(2, data::Purpose::test, 8);
  Sample sample;
  for (int i = 0; i < 1000; ++i) {
    sample.x.push_back(-std::log(random.uniform()));
    sample.y.push_back(random.uniform());
  }
  const DensityGrid grid =
      joint_density(sample.x, sample.y, {.x_low = 0.0, .x_high = 8.0, .y_low = 0.0, .y_high = 1.0});
  double sum = 0.0, first_column = 0.0, tenth_column = 0.0;
  const std::size_t rows = grid.y.size();
  for (std::size_t i = 0; i < grid.density.size(); ++i) {
    sum += grid.density[i];
    if (i / rows == 0) first_column += grid.density[i];
    if (i / rows == 10) tenth_column += grid.density[i];
  }
  CHECK(sum == Approx(1.0).margin(1e-3));
  CHECK(first_column > tenth_column);
}

TEST_CASE("a contour of a cone is a circle that closes") {
  DensityGrid grid;
  for (int i = 0; i < 60; ++i) grid.x.push_back((i + 0.5) / 60);
  grid.y = grid.x;
  for (const double x : grid.x) {
    for (const double y : grid.y) grid.density.push_back(std::max(0.0, 0.5 - std::hypot(x - 0.5, y - 0.5)));
  }
  const auto loops = contour(grid, {}, 0.2);
  REQUIRE(loops.size() == 1);
  for (std::size_t i = 0; i < loops[0].x.size(); ++i) {
    CHECK(std::hypot(loops[0].x[i] - 0.5, loops[0].y[i] - 0.5) == Approx(0.3).margin(0.002));
    const std::size_t next = (i + 1) % loops[0].x.size();
    CHECK(std::hypot(loops[0].x[i] - loops[0].x[next], loops[0].y[i] - loops[0].y[next]) < 0.03);
  }
}

TEST_CASE("draws that do not vary or are few have no density") {
  const std::vector<double> same(100, 0.5);
  CHECK(joint_density(same, same, {}).density.empty());
  CHECK(joint_density({0.1, 0.2}, {0.3, 0.4}, {}).density.empty());
}

TEST_CASE("an axis of very small or large numbers has its power of ten in its label") {
  CHECK(plot::axis_for("hamaker", "J", 2e-17).label == "hamaker (10\u207b\u00b9\u2078 J)");
  CHECK(plot::axis_for("hamaker", "J", 2e-17).scale == Approx(1e18));
  CHECK(plot::axis_for("torque", "mN m", 150.0).label == "torque (mN m)");
  CHECK(plot::axis_for("friction", "", 0.8).label == "friction");
}

TEST_CASE("traded pairs are drawn first, then pairs by falling correlation") {
  const CalibrationReport report = report_fixture::four_parameters();
  const auto pairs = pairs_to_draw(report.cases[0], 3);
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0] == std::pair<std::size_t, std::size_t>{0, 2});
  CHECK(pairs[1] == std::pair<std::size_t, std::size_t>{1, 3});
}

TEST_CASE("what gnuplot says is shown when it fails") {
  const TemporaryFolder folder;
  const Figure broken{.stem = "broken", .script = "plot nonsense(", .data = "", .alt = ""};
  try {
    draw(broken, folder.path(), {});
    FAIL("no error");
  } catch (const data::InputError& error) {
    CHECK(std::string(error.what()).find("nonsense") != std::string::npos);
    CHECK(std::string(error.what()).find("broken.gp") != std::string::npos);
  }
}

TEST_CASE("ids of two inlined figures differ and references follow them") {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 1 1\"><title>t</title><script>x</script><g id=\"a\"/>"
      "<use xlink:href='#a'/><path fill=\"url(#a)\"/></svg>";
  CHECK(inline_svg(svg, "f", "a & b") ==
        "<svg role=\"img\" aria-label=\"a &amp; b\" viewBox=\"0 0 1 1\"><g id=\"f-a\"/><use xlink:href='#f-a'/>"
        "<path fill=\"url(#f-a)\"/></svg>");
}

TEST_CASE("data that the case has not used are drawn beside its curve, those of its output and control alone") {
  CaseReport result;
  const PredictiveCurve curve{.output = "torque",
                              .unit = "N m",
                              .control = "rpm",
                              .control_unit = "rpm",
                              .observation_set = "bench",
                              .x = {10.0, 50.0},
                              .mean = {1.0, 2.0},
                              .q05 = {0.9, 1.9},
                              .q95 = {1.1, 2.1}};
  CHECK(predictive_figure(result, curve, "f").data.find("# unused") == std::string::npos);
  const auto point = [](const std::string& output, std::map<std::string, double> controls, double value) {
    return PredictedPoint{.point = {.controls = std::move(controls),
                                    .output = output,
                                    .unit = {},
                                    .observed = value,
                                    .standard_error = 0.5,
                                    .observation_set = "other"}};
  };
  result.predictions.push_back(
      {.name = "other",
       .points = {point("torque", {{"rpm", 30.0}}, 7.25), point("axial_flow", {{"rpm", 30.0}}, 8.25),
                  point("torque", {{"rpm", 30.0}, {"fill", 1.0}}, 9.25)}});
  const Figure figure = predictive_figure(result, curve, "f");
  const std::string unused = figure.data.substr(figure.data.find("# unused"));
  CHECK(unused.find("30 7.25 0.5") != std::string::npos);
  CHECK(figure.data.find("8.25") == std::string::npos);
  CHECK(figure.data.find("9.25") == std::string::npos);
  CHECK(figure.script.find("set yrange") != std::string::npos);
  CHECK(figure.script.find("not used") != std::string::npos);
}
