// What cannot be simulated is named, with its key.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/run/run.hpp"

TEST_CASE("what cannot be simulated is named before it is tried") {
  dem::Case c;
  CHECK(dem::problems(c).empty());
  c.contact.stiffness = 1e-3;
  c.rig.blade_radius = 8e-3;
  c.rig.angular_velocity = 0.0;
  CHECK(dem::problems(c).size() == 3);
  CHECK_THROWS_AS(dem::run(c, 1), data::InputError);
}

TEST_CASE("real grains softer than the simulated ones are refused, where their law reads them") {
  for (const auto normal : {dem::NormalLaw::linear, dem::NormalLaw::hertz}) {
    dem::Case c;
    c.contact.normal = normal;
    const bool linear = normal == dem::NormalLaw::linear;
    std::optional<double>& real = linear ? c.contact.true_stiffness : c.contact.true_young_modulus;
    const double used = linear ? c.contact.stiffness : c.contact.young_modulus;
    real = used;
    CHECK(dem::problems(c).empty());
    real = 0.01 * used;
    REQUIRE(dem::problems(c).size() == 1);
    CHECK(dem::problems(c)[0].place == (linear ? "contact.true_stiffness" : "contact.true_young_modulus"));
  }
}

TEST_CASE("sample, window and length of a run that do not fit into each other are refused, each by name") {
  const auto said = [](double sample, double window, double longest) {
    dem::Case c;
    c.run.sample_interval = sample;
    c.run.window = window;
    c.run.longest = longest;
    std::string all;
    for (const data::Problem& p : dem::problems(c)) all += p.place + " " + p.what + "; ";
    return all;
  };
  CHECK_THAT(said(10.0, 0.02, 0.3), Catch::Contains("run.sample_interval is 10 s, longer than run.window"));
  CHECK_THAT(said(1e-3, 0.5, 1.0), Catch::Contains("run.window is 0.5 s, of which fewer than 8"));
  CHECK_THAT(said(1e-3, 0.02, 0.1), Catch::Contains("run.longest leaves nothing to measure"));
  CHECK_THAT(said(1e-3, 0.02, 1.0), !Catch::Contains("run.sample") && !Catch::Contains("run.window"));
}
