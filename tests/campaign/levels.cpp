// Which materials are levels of coarse graining of one powder, and which cannot be.
#include "campaign/levels.hpp"

#include <catch2/catch.hpp>

using Catch::Contains;

namespace {

/// Two materials of the powder "carrier": spheres of 0.8 mm, 20 times the grains, and of 0.4 mm, 10 times; 3 g of each.
campaign::Workspace two_levels() {
  campaign::Workspace workspace;
  workspace.study.materials = {{.name = "coarse", .powder = "carrier", .place = "study.toml:10"},
                               {.name = "fine", .powder = "carrier", .place = "study.toml:20"}};
  for (const auto& [name, enlargement] : {std::pair{"coarse", 20.0}, std::pair{"fine", 10.0}}) {
    dem::Case& one = workspace.cases[name];
    one.material.coarse_graining = enlargement;
    one.material.diameter = 40e-6 * enlargement;
    one.rig.fill_mass = 3e-3;
  }
  return workspace;
}

}  // namespace

TEST_CASE("levels of one powder know each other, and a material without a powder has none") {
  campaign::Workspace workspace = two_levels();
  const auto levels = campaign::coarse_levels(workspace);
  CHECK(levels.at("coarse") == std::vector<std::string>{"fine"});
  CHECK(levels.at("fine") == std::vector<std::string>{"coarse"});
  workspace.study.materials[1].powder.clear();
  CHECK(campaign::coarse_levels(workspace).at("coarse").empty());
}

TEST_CASE("materials that are other grains, or another fill, or equally enlarged, are refused as levels") {
  const auto refused = [](auto change, const std::string& what) {
    campaign::Workspace workspace = two_levels();
    change(workspace);
    CHECK_THROWS_WITH(campaign::coarse_levels(workspace), Contains("study.toml:10") && Contains(what));
  };
  refused([](auto& w) { w.cases["fine"].material.coarse_graining = 1.0; }, "diameter over coarse_graining");
  refused([](auto& w) { w.cases["fine"].material.density = 2500.0; }, "density");
  refused([](auto& w) { w.cases["fine"].rig.fill_mass = 1.5e-3; }, "fill is 3.001 g and 1.5 g");
  refused([](auto& w) { w.cases["fine"].material.coarse_graining = 20.0; }, "at a coarse_graining of 20");
}

TEST_CASE("the Hamaker constant of simulated spheres is no parameter of two levels") {
  campaign::Workspace workspace = two_levels();
  workspace.study.parameters = {{.name = "H", .target = "contact.hamaker", .place = "study.toml:30"}};
  CHECK_THROWS_WITH(campaign::coarse_levels(workspace), Contains("study.toml:30") && Contains("hamaker_of"));
  for (auto& [name, one] : workspace.cases) one.contact.hamaker_of = dem::HamakerOf::original;
  CHECK_NOTHROW(campaign::coarse_levels(workspace));
}
