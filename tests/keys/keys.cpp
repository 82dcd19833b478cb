// The reference of keys (data/study_keys.hpp) and the readers of studies say the same.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "asked.hpp"
#include "data/study_keys.hpp"
#include "toml++/toml.h"

namespace {

/// Read by the program itself, which tests/cli starts.
const std::set<std::string> read_elsewhere{"training.unsteady"};

/// Choices whose default depends on other keys.
const std::set<std::string> in_words{"training.engine", "observe.rig", "observe.material", "calibrate.material",
                                     "contact.tangential"};

/// SI units of the parameters and controls of the sample that the readers are given (asked.cpp), and its outputs.
const std::set<std::string> units_of_the_sample{"1", "kg m2 s-2", "rad s-1"};
const std::vector<std::string> outputs_of_the_sample{"NAME7"};

bool is_section(const std::string& name) {
  const std::string first = name.substr(0, name.find('.'));
  return name == first || name == first + ".NAME";
}

/// "above 0 to 1", as the reference writes it.
std::string range_text(const data::Range& range) {
  std::string text;
  if (std::isfinite(range.low)) text = fmt::format("{} {:g}", range.open_low ? "above" : "from", range.low);
  if (std::isfinite(range.high))
    text += fmt::format("{}{} {:g}", text.empty() ? "" : " ", range.open_high ? "below" : "to", range.high);
  return text;
}

std::map<std::string, data::StudyKey> reference() {
  std::map<std::string, data::StudyKey> keys;
  for (const data::StudyKey& key : data::study_keys()) CHECK(keys.emplace(key.name, key).second);
  return keys;
}

}  // namespace

TEST_CASE("every key that a reader asks for or looks for is in the reference") {
  const keys::Asked readers = keys::asked_by_the_readers();
  const auto table = reference();
  for (const auto& [name, how] : readers.asked) {
    INFO(name << " (" << how.type << ")");
    CHECK((table.count(name) > 0 || is_section(name)));
  }
  for (const std::string& name : readers.looked_for) {
    INFO(name << ", read only where it is there");
    CHECK((table.count(name) > 0 || is_section(name)));
  }
}

TEST_CASE("every key in the reference is one that a reader asks for, with its type, unit, range, choices and default") {
  const keys::Asked readers = keys::asked_by_the_readers();
  for (const auto& [name, key] : reference()) {
    if (read_elsewhere.count(name) > 0) continue;
    INFO(name);
    const auto found = readers.asked.find(name);
    REQUIRE(found != readers.asked.end());
    const data::AskedKey& how = found->second;
    CHECK(std::string(key.type) == how.type);
    if (key.unit == "own") {
      CHECK(units_of_the_sample.count(how.unit) > 0);
      CHECK(name.find("NAME") != std::string::npos);
    } else {
      CHECK(std::string(key.unit) == (how.unit == "1" ? "" : how.unit));
    }
    const bool choice = how.type.starts_with("choice");
    const std::string words = how.choices == outputs_of_the_sample ? "the outputs"
                              : choice                             ? fmt::format("{}", fmt::join(how.choices, ", "))
                                                                   : range_text(how.range);
    CHECK(std::string(key.range) == words);
    // A default in words is one that depends on other keys.
    double number = 0.0;
    if (std::istringstream(how.fallback) >> number && !key.fallback.empty() && std::isdigit(key.fallback.front()))
      CHECK(std::string(key.fallback) == how.fallback);
    if (how.type == "choice" && in_words.count(name) == 0) CHECK(std::string(key.fallback) == how.fallback);
  }
}

TEST_CASE("a measurement may be of every kind of rig") {
  const keys::Asked readers = keys::asked_by_the_readers();
  CHECK(readers.asked.at("observe.rig").choices == readers.asked.at("rig.kind").choices);
}

TEST_CASE("every key has a meaning, and an example that is TOML") {
  for (const auto& [name, key] : reference()) {
    INFO(name << ": " << key.example);
    CHECK(key.meaning.size() > 10);
    if (key.example.starts_with("[["))
      CHECK_NOTHROW(toml::parse(key.example));
    else
      CHECK_NOTHROW(toml::parse(fmt::format("v = {}", key.example)));
  }
}

TEST_CASE("docs/keys.md is what the reference gives") {
  std::ifstream file(DEMCAL_SOURCE_DIR "/docs/keys.md");
  std::ostringstream text;
  text << file.rdbuf();
  CHECK(text.str() == data::study_keys_page());  // demcal help --as keys
}
