// The study's keys of rig, materials, contact laws, pairs, sizes, mixtures and runs: each reaches the case, changes the
// settings, and is refused by name where it cannot be.
#include <fmt/core.h>
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/reading/read_case.hpp"
#include "dem/reading/target.hpp"
#include "tests/temporary.hpp"

namespace {

struct Reading {
  dem::Case c;
  std::string said;  ///< of what is wrong
};

/// As the program reads it: the case, then every problem at once.
Reading reading(const std::string& text, const std::string& material = "mix") {
  const TemporaryFolder folder;
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text));
  Reading r{dem::read_case(file, material), ""};
  try {
    file.finish();
  } catch (const data::InputError& error) {
    r.said = error.what();
  }
  return r;
}

const std::string rig = "[rig]\nkind = \"slice\"\nfill = 900\n";
const std::string mix = rig + R"(
[materials.sand]
density = "2600 kg/m3"
sizes = [{ diameter = "0.6 mm", mass_fraction = 0.25 }, { diameter = "0.8 mm", mass_fraction = 0.75 }]
contact = { friction = 0.55, wall_friction = 0.35 }
[materials.steel]
density = "7800 kg/m3"
diameter = "1 mm"
[materials.mix]
components = [{ material = "sand", mass_fraction = 0.7 }, { material = "steel", mass_fraction = 0.3 }]
)";

std::string one_material(const std::string& contact) {
  return rig + "[materials.mix]\ndensity = \"2600 kg/m3\"\ndiameter = \"0.8 mm\"\n[contact]\n" + contact;
}

data::StudyFile study(const TemporaryFolder& folder, const std::string& text) {
  folder.write("study.toml", text);
  return data::StudyFile::open(folder.path());
}

const std::string two_materials = R"(
[rig]
kind = "slice"
pitch = "10 mm"
fill = "3 g"
rpm = "120 rpm"
[materials.steel]
density = "7800 kg/m3"
diameter = "1 mm"
[materials.glass]
density = "2500 kg/m3"
diameter = "900 um"
fill = 900
contact = { restitution = 0.9 }
[contact]
friction = 0.3
wall_friction = 0.2
hamaker = "2e-18 J"
cap = "thornton"
tension = "clamped"
wall_attraction = "derjaguin"
minimum_separation = "1 nm"
[run]
settle = "50 ms"
skin = 0.2
[training]
standard_error = 0.05
)";

}  // namespace

TEST_CASE("a study's rig, material, contact and run keys reach the case in SI, each material with its own") {
  const TemporaryFolder folder;
  const data::StudyFile file = study(folder, two_materials);
  const dem::Case steel = dem::read_case(file, "steel"), glass = dem::read_case(file, "glass");
  CHECK_NOTHROW(file.finish());
  CHECK(steel.rig.pitch == Approx(0.01));
  CHECK(steel.rig.fill_mass.value() == Approx(3e-3));
  CHECK(steel.rig.angular_velocity == Approx(12.566370614359172));
  CHECK(steel.material.name == "steel");
  CHECK(steel.material.density == 7800.0);
  CHECK_FALSE(glass.rig.fill_mass.has_value());
  CHECK(dem::get_target(glass, "fill") == 900.0);
  CHECK(glass.material.diameter == Approx(0.9e-3));
  CHECK(glass.contact.restitution == 0.9);
  CHECK(steel.contact.restitution == dem::Contact{}.restitution);
  CHECK(steel.contact.wall_friction.value() == 0.2);
  CHECK(steel.contact.cap == dem::FrictionCap::thornton);
  CHECK(steel.contact.tension == dem::DashpotTension::clamped);
  CHECK(steel.contact.wall_attraction == dem::WallAttraction::derjaguin);
  CHECK(steel.contact.minimum_separation == Approx(1e-9));
  CHECK(steel.run.settle == Approx(0.05));
  CHECK(steel.run.standard_error == 0.05);
}

TEST_CASE("a mistyped key, a wrong unit and a value out of range of the DEM's sections are all named at once") {
  const TemporaryFolder folder;
  const data::StudyFile file = study(
      folder,
      "[rig]\nkind = \"slice\"\n[contact]\nfrikction = 0.3\nfriction = -1\nhamaker = \"3 mm\"\n[run]\nskin = 0\n");
  dem::read_case(file, "");
  try {
    file.finish();
    FAIL("nothing was said");
  } catch (const data::InputError& error) {
    const std::string said = error.what();
    CHECK(error.status == data::ExitStatus::bad_study);
    CHECK_THAT(said, Catch::Contains("frikction") && Catch::Contains("contact.friction") &&
                         Catch::Contains("hamaker") && Catch::Contains("skin"));
  }
}

TEST_CASE("each key of the contact section reaches the case, in SI, and changes the settings") {
  const std::string usual = dem::settings_text(reading(one_material("")).c);
  struct Key {
    const char* laws;  ///< under which it is read
    const char* key;
    const char* value;
    double si;
  };
  const Key keys[]{{"", "stiffness", "\"2 kN/m\"", 2000.0},
                   {"", "wall_stiffness", "\"2 kN/m\"", 2000.0},
                   {"normal = \"hertz\"", "young_modulus", "\"3 MPa\"", 3e6},
                   {"normal = \"hertz\"", "wall_young_modulus", "\"3 GPa\"", 3e9},
                   {"normal = \"hertz\"", "poisson_ratio", "0.3", 0.3},
                   {"normal = \"hertz\"", "true_young_modulus", "\"70 GPa\"", 7e10},
                   {"", "wall_restitution", "0.4", 0.4},
                   {"", "tangential_damping", "0.1", 0.1},
                   {"resistance = \"constant\"", "rolling_friction", "0.05", 0.05},
                   {"resistance = \"constant\"", "wall_rolling_friction", "0.05", 0.05},
                   {"resistance = \"spring\"", "twisting_friction", "0.05", 0.05},
                   {"resistance = \"spring\"", "rolling_stiffness_ratio", "0.5", 0.5},
                   {"resistance = \"spring\"", "rolling_damping", "0.5", 0.5},
                   {"cohesion = \"dmt\"", "work_of_adhesion", "\"5 mJ/m2\"", 5e-3},
                   {"normal = \"jkr\"", "wall_work_of_adhesion", "\"5 mJ/m2\"", 5e-3},
                   {"", "true_stiffness", "\"1 MN/m\"", 1e6}};
  for (const Key& k : keys) {
    INFO(k.key);
    const std::string laws = std::string(k.laws) + "\n";
    const Reading without = reading(one_material(laws));
    const Reading with = reading(one_material(laws + k.key + " = " + k.value + "\n"));
    CHECK(with.said.empty());
    CHECK(dem::get_target(with.c, std::string("contact.") + k.key) == Approx(k.si));
    CHECK(dem::settings_text(with.c) != dem::settings_text(without.c));
    if (!laws.empty() && laws != "\n") CHECK(dem::settings_text(without.c) != usual);
  }
}

TEST_CASE("what decides a run beside the coefficients changes the settings too") {
  const std::string usual = dem::settings_text(reading(one_material("")).c);
  for (const char* line : {"restitution_at = \"0.1 m/s\"", "[run]\ntime_step = \"1 us\"", "[run]\noverlap_limit = 0.2",
                           "[[contact.pair]]\nbetween = [\"mix\", \"mixer\"]\nfriction = 0.1"}) {
    INFO(line);
    const Reading r = reading(one_material(std::string(line) + "\n"));
    CHECK(r.said.empty());
    CHECK(dem::settings_text(r.c) != usual);
  }
}

TEST_CASE("a mixture takes density, sizes and contact of its components") {
  const Reading r = reading(mix);
  CHECK(r.said.empty());
  REQUIRE(r.c.components.size() == 2);
  CHECK(r.c.components[0].material.density == 2600.0);
  REQUIRE(r.c.components[0].material.sizes.size() == 2);
  CHECK(r.c.components[0].material.sizes[1].diameter == Approx(0.8e-3));
  CHECK(r.c.components[1].mass_fraction == 0.3);
  CHECK(dem::get_target(r.c, "contact.sand-sand.friction") == 0.55);
  CHECK(dem::get_target(r.c, "contact.sand-wall.friction") == 0.35);
  CHECK(dem::get_target(r.c, "contact.sand-steel.friction") == dem::Contact{}.friction);
  CHECK(dem::settings_text(r.c).find("material.sand.sizes.mass_fraction = 0.25") != std::string::npos);
}

TEST_CASE("walls have the study's own value unless a component states one for walls") {
  const std::string stated = "contact = { friction = 0.55, wall_friction = 0.35 }";
  for (const auto& [of_component, at_walls] :
       {std::pair{stated, 0.35}, {std::string("contact = { friction = 0.55 }"), 0.15}}) {
    std::string text = mix;
    text.replace(text.find(stated), stated.size(), of_component);
    const Reading r = reading(text + "[contact]\nwall_friction = 0.15\n");
    CHECK(r.said.empty());
    CHECK(dem::get_target(r.c, "contact.sand-wall.friction") == at_walls);
  }
}

TEST_CASE("restitution at a speed without a unit is a problem of the study, and no collision is tried with it") {
  CHECK_THAT(reading(one_material("restitution_at = 3\n")).said, Catch::Contains("restitution_at"));
}

TEST_CASE("a log-normal distribution is read with its bounds") {
  const Reading r =
      reading(rig +
              "[materials.mix]\ndistribution = { kind = \"log_normal\", median = \"0.7 mm\", geometric_sd "
              "= 1.2, low = \"0.5 mm\", high = \"1 mm\" }\n");
  CHECK(r.said.empty());
  REQUIRE(r.c.material.log_normal.has_value());
  CHECK(r.c.material.diameter == Approx(0.7e-3));
  CHECK(r.c.material.log_normal->geometric_sd == 1.2);
  CHECK(r.c.material.log_normal->high == Approx(1e-3));
}

TEST_CASE("a bed that cannot be is named with its key") {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = mix;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return reading(text.replace(at, from.size(), to)).said;
  };
  CHECK_THAT(changed("mass_fraction = 0.7 }", "mass_fraction = 0.5 }"), Catch::Contains("sum to 0.8"));
  CHECK_THAT(changed("mass_fraction = 0.25 }", "mass_fraction = 0.35 }"), Catch::Contains("sum to 1.1"));
  CHECK_THAT(changed("material = \"steel\"", "material = \"glass\""), Catch::Contains("glass"));
  CHECK_THAT(changed("diameter = \"1 mm\"", "diameter = \"1 mm\"\ncoarse_graining = 2"),
             Catch::Contains("coarse_graining") && Catch::Contains("mix"));
  CHECK_THAT(changed("[materials.mix]\n", "[materials.mix]\ndensity = \"1 g/cm3\"\n"),
             Catch::Contains("density") && Catch::Contains("component"));
  CHECK_THAT(changed("wall_friction = 0.35", "normal = \"hertz\""), Catch::Contains("laws"));
}

TEST_CASE("a key that the chosen laws do not read, and a pair of no such material, are refused where they stand") {
  CHECK_THAT(reading(one_material("work_of_adhesion = \"1 mJ/m2\"\n")).said,
             Catch::Contains("contact.work_of_adhesion") && Catch::Contains("jkr"));
  CHECK_THAT(reading(one_material("normal = \"jkr\"\nhamaker = \"1e-19 J\"\n")).said,
             Catch::Contains("contact.hamaker"));
  CHECK_THAT(reading(one_material("tangential = \"mindlin\"\n")).said, Catch::Contains("contact.tangential"));
  CHECK_THAT(reading(one_material("normal = \"stiff\"\n")).said, Catch::Contains("hertz"));
  CHECK_THAT(reading(one_material("[[contact.pair]]\nbetween = [\"mix\", \"glass\"]\nfriction = 0.1\n")).said,
             Catch::Contains("glass") && Catch::Contains("mixer"));
  CHECK_THAT(reading(one_material("[[contact.pair]]\nbetween = [\"mix\"]\nfriction = 0.1\n")).said,
             Catch::Contains("between"));
  CHECK_THAT(reading(one_material("[[contact.pair]]\nbetween = [\"mix\", \"wall\"]\nfriction = \"2 mm\"\n")).said,
             Catch::Contains("friction"));
  // Meshes never touch each other: what is said of them would be read and never used.
  for (const char* between : {"\"mixer\", \"trough\"", "\"wall\", \"wall\""})
    CHECK_THAT(reading(one_material(fmt::format("[[contact.pair]]\nbetween = [{}]\nfriction = 0.1\n", between))).said,
               Catch::Contains("contact.pair") && Catch::Contains("meshes never touch each other"));
}

TEST_CASE("a rig is judged at the values that the runs give it, and not at a default that no run has") {
  // The small slice of data/quick has room for some 1,000 spheres; without a fill 2,400 are the default.
  const TemporaryFolder folder;
  const std::string text =
      "[rig]\nkind = \"slice\"\nshaft_radius = \"1.5 mm\"\nblade_radius = \"3.6 mm\"\nblade_thickness = \"0.8 mm\"\n"
      "trough_radius = \"6.0 mm\"\npitch = \"4.8 mm\"\n[materials.mix]\ndensity = \"6090 kg/m3\"\ndiameter = \"0.8 mm\"\n";
  const auto said = [&](const std::vector<dem::SetValue>& set) {
    const data::StudyFile file = study(folder, text);
    dem::read_case(file, "mix", set);
    try {
      file.finish();
    } catch (const data::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(said({}), Catch::Contains("makes 2400 spheres"));
  CHECK(said({{"rig.fill", 450.0}}).empty());
  CHECK_THAT(said({{"rig.fill", 3000.0}}), Catch::Contains("makes 3000 spheres"));
}
