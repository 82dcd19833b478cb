// What a case's contact section becomes for each pair of materials: overrides, combined moduli, pull-off forces, and
// the time step that follows from the shortest contact.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "data/error.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "tests/dem/scene.hpp"

namespace {

using std::numbers::pi;

dem::Case sand_and_steel() {
  dem::Case c;
  c.material.name = "mix";
  dem::Component sand, steel;
  sand.material.name = "sand";
  sand.material.density = 2600.0;
  sand.material.diameter = 0.6e-3;
  sand.mass_fraction = 0.7;
  steel.material.name = "steel";
  steel.material.density = 7800.0;
  steel.material.diameter = 1.0e-3;
  steel.mass_fraction = 0.3;
  c.components = {sand, steel};
  c.rig.fill = 1500.0;
  return c;
}

const dem::ContactKind& kind(const dem::Derived& d, const std::string& first, const std::string& second) {
  for (const dem::ContactKind& k : d.kinds)
    if (k.first == first && k.second == second) return k;
  throw std::out_of_range("no contact of " + first + " with " + second);
}

std::string said(const dem::Case& c) {
  std::string text;
  for (const data::Problem& p : dem::problems(c)) text += data::describe({p}) + "\n";
  return text;
}

}  // namespace

TEST_CASE("a pair's own coefficient holds between its two materials, in either order, and nowhere else") {
  dem::Case c = sand_and_steel();
  c.contact.friction = 0.3;
  dem::set_target(c, GENERATE("contact.sand-steel.friction", "contact.steel-sand.friction"), 0.9);
  CHECK(dem::get_target(c, "contact.sand-steel.friction") == 0.9);
  CHECK(dem::get_target(c, "contact.steel-sand.friction") == 0.9);
  CHECK(dem::get_target(c, "contact.sand-sand.friction") == 0.3);
  const dem::BedCoefficients bed = dem::make_bed(c, 2);
  CHECK(bed.grain[0].friction == 0.3);
  CHECK(bed.grain[1].friction == 0.9);
  CHECK(bed.grain[2].friction == 0.9);
  CHECK(bed.grain[3].friction == 0.3);
  for (const dem::PairCoefficients& wall : bed.wall) CHECK(wall.friction == 0.3);
}

TEST_CASE("a pair names a body by its name, by its material, or every body as wall, and the last word wins") {
  dem::Case c = sand_and_steel();
  const std::vector<dem::BodyLabel> bodies{{"tool", "brass"}, {"drum", "wall"}};
  const auto friction = [&](std::string with, double mu) {
    dem::PairContact p;
    p.first = "sand";
    p.second = std::move(with);
    p.friction = mu;
    return p;
  };
  c.contact.wall_friction = 0.1;
  c.pairs = {friction("wall", 0.2)};
  CHECK(dem::make_bed(c, bodies).wall[0].friction == 0.2);
  CHECK(dem::make_bed(c, bodies).wall[1].friction == 0.2);
  c.pairs.push_back(friction("brass", 0.5));
  CHECK(dem::make_bed(c, bodies).wall[0].friction == 0.5);
  CHECK(dem::make_bed(c, bodies).wall[1].friction == 0.2);
  c.pairs.push_back(friction("drum", 0.6));
  CHECK(dem::make_bed(c, bodies).wall[1].friction == 0.6);
  CHECK(dem::make_bed(c, bodies).wall[2].friction == 0.1);  // of steel
}

TEST_CASE("every coefficient of a pair is a target that changes the settings") {
  dem::Case c = sand_and_steel();
  c.contact.resistance = dem::ResistanceLaw::constant;
  for (const dem::PairKey& k : dem::pair_keys) {
    const std::string name = "contact.sand-wall." + std::string(k.key);
    INFO(name);
    if (k.key == "work_of_adhesion") {
      CHECK_THROWS_AS(dem::set_target(c, name, 0.1), data::InputError);  // no law chosen reads it
      c.contact.cohesion = dem::Cohesion::dmt;
    }
    dem::Case changed = c;
    const dem::Target t = dem::target(name);
    const double x = std::min(t.high, std::max(2.0 * dem::get_target(c, name), 1e-3 * t.high));
    dem::set_target(changed, name, x);
    CHECK(dem::get_target(changed, name) == x);
    CHECK(dem::settings_text(changed) != dem::settings_text(c));
  }
  CHECK_THROWS_AS(dem::set_target(c, "contact.sand-glass.friction", 0.3), data::InputError);
  CHECK_FALSE(dem::find_target("contact.sand-steel.frikction").has_value());
}

TEST_CASE("each quantity of a component is a target of its own") {
  dem::Case c = sand_and_steel();
  dem::set_target(c, "material.steel.density", 7000.0);
  dem::set_target(c, "material.sand.mass_fraction", 0.5);
  CHECK(c.components[1].material.density == 7000.0);
  CHECK(c.components[0].mass_fraction == 0.5);
  CHECK(dem::settings_text(c) != dem::settings_text(sand_and_steel()));
  CHECK_THROWS_AS(dem::set_target(c, "material.glass.density", 2500.0), data::InputError);
  CHECK_THROWS_AS(dem::set_target(c, "material.density", 2500.0), data::InputError);
}

TEST_CASE("unlike materials combine their moduli: 1/E* and 1/G* are the means of those of like pairs") {
  dem::Case c = sand_and_steel();
  c.contact.normal = dem::NormalLaw::hertz;
  c.components[0].material.young_modulus = 2e7;
  c.components[1].material.young_modulus = 3e8;
  c.components[1].material.poisson_ratio = 0.3;
  const dem::BedCoefficients bed = dem::make_bed(c, {{"tool", "steel"}, {"drum", "wall"}});
  CHECK(bed.grain[0].young_modulus == Approx(2e7 / (1.0 - 0.25 * 0.25) / 2.0));
  CHECK(1.0 / bed.grain[1].young_modulus ==
        Approx(0.5 / bed.grain[0].young_modulus + 0.5 / bed.grain[3].young_modulus));
  CHECK(1.0 / bed.grain[1].shear_modulus ==
        Approx(0.5 / bed.grain[0].shear_modulus + 0.5 / bed.grain[3].shear_modulus));
  CHECK(bed.grain[2].young_modulus == bed.grain[1].young_modulus);
  // A tool of a material in the bed is as stiff as its grains.
  CHECK(bed.wall[0].young_modulus == Approx(bed.grain[1].young_modulus));
}

TEST_CASE("pull-off is H* L / (12 h^2) with L = 4 R* of unequal spheres, 2 pi w R* for DMT, 3/2 pi w R* for JKR") {
  dem::Case c = sand_and_steel();
  const double radius = 0.3e-3 * 0.5e-3 / 0.8e-3;
  SECTION("van der Waals") {
    c.contact.hamaker = 3e-18;
    const double h = c.contact.minimum_separation;
    CHECK(kind(dem::derive(c), "sand", "steel").pull_off == Approx(3e-18 * 4.0 * radius / (12.0 * h * h)));
    // Against a wall L is the diameter.
    CHECK(kind(dem::derive(c), "sand", "mixer").pull_off == Approx(3e-18 * 0.6e-3 / (12.0 * h * h)));
    c.contact.length_scale = dem::LengthScale::radius;
    CHECK(kind(dem::derive(c), "sand", "steel").pull_off == Approx(3e-18 * 2.0 * radius / (12.0 * h * h)));
  }
  SECTION("DMT") {
    c.contact.cohesion = dem::Cohesion::dmt;
    c.contact.work_of_adhesion = 0.02;
    CHECK(kind(dem::derive(c), "sand", "steel").pull_off == Approx(2.0 * pi * 0.02 * radius));
  }
  SECTION("JKR") {
    c.contact.normal = dem::NormalLaw::jkr;
    c.contact.work_of_adhesion = 0.02;
    CHECK(kind(dem::derive(c), "sand", "steel").pull_off == Approx(1.5 * pi * 0.02 * radius));
  }
  const double mass = 2600.0 * pi / 6.0 * std::pow(0.6e-3, 3);
  const dem::ContactKind of = kind(dem::derive(c), "sand", "steel");
  CHECK(of.bond == Approx(of.pull_off / (mass * 9.81)));  // of the lighter
}

TEST_CASE("attraction is scaled by the root of the stiffness over the real grain's") {
  dem::Case c;
  c.contact.hamaker = 3e-18;
  const double before = dem::derive(c).pull_off;
  c.contact.true_stiffness = 25.0 * c.contact.stiffness;
  CHECK(dem::derive(c).pull_off == Approx(before / 5.0));
}

TEST_CASE("the time step of a mixture is that of its lightest pair") {
  const dem::Case c = sand_and_steel();
  const double mass = 2600.0 * pi / 6.0 * std::pow(0.6e-3, 3), zeta = dem::damping_ratio(c.contact.restitution);
  const double duration = pi / (std::sqrt(2.0 * c.contact.stiffness / mass) * std::sqrt(1.0 - zeta * zeta));
  CHECK(dem::derive(c).time_step == Approx(duration / c.run.steps_per_contact).epsilon(1e-12));
  dem::Case stiff = c;
  dem::set_target(stiff, "contact.steel-steel.stiffness", 1e4);
  CHECK(dem::derive(stiff).duration_of.find("steel with steel") != std::string::npos);
}

TEST_CASE("the duration of a Hertz impact at the tip's speed is that of the collision integrated by CVODE") {
  dem::Case c;
  c.contact.normal = dem::NormalLaw::hertz;
  c.contact.young_modulus = 1e8;
  c.contact.restitution = 1.0;
  c.rig.angular_velocity = 200.0;
  const dem::Derived d = dem::derive(c);
  CHECK(d.conditions.speed == Approx(200.0 * c.rig.blade_radius));
  REQUIRE(d.duration_of.find("impact") != std::string::npos);
  dem::Encounter e;
  e.sphere = {.mass = d.mass, .radius = 0.5 * c.material.diameter, .material = 0, .velocity = {}, .spin = {}};
  e.sphere.velocity.z = -d.conditions.speed;
  e.partner = e.sphere;
  e.partner->velocity = {};
  CHECK(kind(d, "grain", "grain").duration ==
        Approx(dem::collide(*dem::make_force_pass(d.bed), e).duration).epsilon(1e-4));
}

TEST_CASE("the time step is at most a fifth of a Rayleigh time of the smallest sphere, however slow the rig") {
  dem::Case c;
  c.contact.normal = dem::NormalLaw::hertz;
  c.contact.young_modulus = 1e8;
  c.rig.angular_velocity = 0.01;
  c.rig.fill = 2.0;
  const double shear = 1e8 / (2.0 * 1.25);
  const double rayleigh =
      pi * 0.5 * c.material.diameter * std::sqrt(c.material.density / shear) / (0.1631 * 0.25 + 0.8766);
  CHECK(dem::derive(c).time_step <= rayleigh / 5.0 * (1.0 + 1e-12));
}

TEST_CASE("a time step past the contact's limit is refused with the limit") {
  dem::Case c;
  const double duration = dem::derive(c).contact_duration;
  c.run.time_step = duration / 14.0;
  CHECK_THAT(said(c), Catch::Contains("run.time_step") && Catch::Contains("at most"));
  c.run.time_step = duration / 16.0;
  CHECK(said(c).empty());
  CHECK(dem::derive(c).time_step == duration / 16.0);
}

TEST_CASE("laws that do not go together, and coefficients that none of them reads, are named") {
  dem::Case c;
  dem::Contact& k = c.contact;
  SECTION("mindlin with linear") {
    k.tangential = dem::TangentialLaw::mindlin;
    CHECK_THAT(said(c), Catch::Contains("contact.tangential"));
  }
  SECTION("jkr with linear tangential") {
    k.normal = dem::NormalLaw::jkr;
    k.tangential = dem::TangentialLaw::linear;
    CHECK_THAT(said(c), Catch::Contains("contact.tangential"));
  }
  SECTION("jkr with another attraction") {
    k.normal = dem::NormalLaw::jkr;
    k.cohesion = dem::Cohesion::dmt;
    CHECK_THAT(said(c), Catch::Contains("contact.cohesion"));
  }
  SECTION("jkr with a Hamaker constant") {
    k.normal = dem::NormalLaw::jkr;
    k.hamaker = 1e-18;
    CHECK_THAT(said(c), Catch::Contains("contact.hamaker"));
  }
  SECTION("work of adhesion beside van der Waals, of walls too") {
    k.work_of_adhesion = 0.01;
    k.wall_work_of_adhesion = 0.01;
    CHECK_THAT(said(c),
               Catch::Contains("contact.work_of_adhesion") && Catch::Contains("contact.wall_work_of_adhesion"));
  }
  SECTION("rolling friction without a law of rolling") {
    k.rolling_friction = 0.1;
    CHECK_THAT(said(c), Catch::Contains("contact.rolling_friction"));
  }
  SECTION("the true stiffness of a Hertz contact") {
    k.normal = dem::NormalLaw::hertz;
    k.true_stiffness = 1e5;
    CHECK_THAT(said(c), Catch::Contains("contact.true_stiffness"));
  }
}

TEST_CASE("a stiffness that the fill or the attraction presses flat is refused with one that holds") {
  dem::Case c;
  c.contact.hamaker = 1e-17;
  c.contact.stiffness = 3.0;
  const std::string text = said(c);
  CHECK_THAT(text, Catch::Contains("contact.stiffness") && Catch::Contains("raise it to"));
  c.contact.stiffness = std::stod(text.substr(text.find("raise it to") + 12));
  c.contact.stiffness *= 1.01;  // the message rounds
  CHECK(said(c).empty());
}

TEST_CASE("what two materials do to each other is the same in either order, in every field") {
  dem::Case c = sand_and_steel();
  c.components[0].material.young_modulus = 5e6;
  c.components[1].material.young_modulus = 5e7;
  c.components[0].material.poisson_ratio = 0.2;
  c.components[1].material.poisson_ratio = 0.35;
  c.contact.true_young_modulus = 1e9;
  c.contact.work_of_adhesion = 0.05;
  c.contact.hamaker = 4e-18;
  const auto normal = GENERATE(dem::NormalLaw::linear, dem::NormalLaw::hertz, dem::NormalLaw::jkr);
  c.contact.normal = normal;
  c.contact.cohesion = GENERATE(dem::Cohesion::van_der_waals, dem::Cohesion::dmt);
  dem::PairContact own;
  own.first = "steel";
  own.second = "sand";
  own.friction = 0.7;
  own.restitution = 0.4;
  c.pairs = {own};
  const dem::BedCoefficients bed = dem::make_bed(c, 1);
  const dem::PairCoefficients &ab = bed.grain[1], &ba = bed.grain[2];
  CHECK(ab.stiffness == ba.stiffness);
  CHECK(ab.young_modulus == ba.young_modulus);
  CHECK(ab.shear_modulus == ba.shear_modulus);
  CHECK(ab.damping_ratio == ba.damping_ratio);
  CHECK(ab.tension == ba.tension);
  CHECK(ab.tangential_stiffness == ba.tangential_stiffness);
  CHECK(ab.tangential_damping == ba.tangential_damping);
  CHECK(ab.friction == ba.friction);
  CHECK(ab.cap_weight == ba.cap_weight);
  CHECK(ab.rolling_friction == ba.rolling_friction);
  CHECK(ab.twisting_friction == ba.twisting_friction);
  CHECK(ab.rolling_damping == ba.rolling_damping);
  CHECK(ab.rolling_stiffness == ba.rolling_stiffness);
  CHECK(ab.adhesion == ba.adhesion);
  CHECK(ab.pull_off == ba.pull_off);
  CHECK(ab.minimum_separation == ba.minimum_separation);
  CHECK(ab.cut_off == ba.cut_off);
}

TEST_CASE(
    "attraction is scaled by the pair's effective modulus: between that of either alone, and theirs where alike") {
  dem::Case c = sand_and_steel();
  c.contact.normal = dem::NormalLaw::hertz;
  c.contact.cohesion = dem::Cohesion::dmt;
  c.contact.work_of_adhesion = 0.05;
  c.contact.true_young_modulus = 1e9;
  c.components[0].material.young_modulus = 5e6;
  c.components[1].material.young_modulus = 5e7;
  const dem::BedCoefficients bed = dem::make_bed(c, 1);
  const auto scaling = [&](std::size_t k) { return bed.grain[k].pull_off / (2.0 * pi * 0.05); };
  CHECK(scaling(0) == Approx(std::pow(5e6 / 1e9, 0.4)));
  CHECK(scaling(3) == Approx(std::pow(5e7 / 1e9, 0.4)));
  // E* of the pair over E* of two real grains: Poisson's ratios are alike here and fall out.
  const double alike = 1.0 / (2.0 * (1.0 - 0.25 * 0.25) / 1e9);
  CHECK(scaling(1) == Approx(std::pow(bed.grain[1].young_modulus / alike, 0.4)));
  // A wall is softened as the grain that it meets, also where it stays rigid.
  CHECK(bed.wall[1].pull_off / (2.0 * pi * 0.05) == Approx(scaling(3)));
  c.contact.wall_young_modulus = std::numeric_limits<double>::infinity();
  CHECK(dem::make_bed(c, 1).wall[1].pull_off == bed.wall[1].pull_off);
}

TEST_CASE("a pair with a wall follows what is said of the wall, as the coefficients do") {
  dem::Case c = sand_and_steel();
  c.contact.friction = 0.3;
  c.contact.wall_friction = 0.1;
  const auto friction = [&](const char* pair) {
    return dem::get_target(c, std::string("contact.") + pair + ".friction");
  };
  CHECK(friction("sand-wall") == 0.1);
  CHECK(friction("mixer-sand") == 0.1);
  CHECK(friction("sand-steel") == 0.3);
  CHECK(friction("sand-wall") == dem::derive(c).bed.wall[0].friction);
  dem::set_target(c, "contact.sand-wall.friction", 0.6);
  CHECK(friction("sand-mixer") == 0.6);  // what holds at every wall holds at this one
  CHECK(friction("steel-mixer") == 0.1);
  dem::set_target(c, "contact.sand-mixer.friction", 0.7);
  CHECK(friction("sand-mixer") == 0.7);
  CHECK(friction("sand-wall") == 0.6);
  CHECK(friction("sand-mixer") == dem::derive(c).bed.wall[0].friction);
  CHECK(friction("sand-trough") == dem::derive(c).bed.wall[1].friction);
}
