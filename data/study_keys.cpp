#include "data/study_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "data/edit_distance.hpp"

namespace data {
namespace {

std::vector<std::string> parts_of(std::string_view dotted) {
  std::vector<std::string> parts;
  std::istringstream stream{std::string(dotted)};
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

/// Without brackets and blanks: "[[observe]]" is "observe".
std::string bare(std::string words) {
  std::erase_if(words, [](char c) { return c == '[' || c == ']' || c == ' '; });
  return words;
}

/// Whether the words' parts begin the key's name; NAME stands for any part.
bool begins(const std::vector<std::string>& words, const std::vector<std::string>& name) {
  if (words.empty() || words.size() > name.size()) return false;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (name[i] != "NAME" && name[i] != words[i]) return false;
  return true;
}

/// "quantity in m, above 0", "number from 0 to 1", "one of linear, log".
std::string kind_of(const StudyKey& key) {
  std::string text(key.type);
  if (text.starts_with("choice")) return fmt::format("one of {}{}", key.range, text.substr(6));
  if (key.unit == "own")
    text += " in its own unit";
  else if (!key.unit.empty())
    text += fmt::format(" with a unit of {}", key.unit);
  if (!key.range.empty()) text += fmt::format(", {}", key.range);
  return text;
}

std::string escaped(std::string_view text) {
  std::string shown;
  for (const char c : text) shown += c == '|' ? std::string("\\|") : std::string(1, c);
  return shown;
}

bool is_header(const StudyKey& key) { return key.example.starts_with("[["); }

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  const std::vector<StudyKey>& keys = study_keys();
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const StudyKey& one) { return one.name == name; });
  if (key == keys.end()) throw std::out_of_range(fmt::format("no key named {}", name));
  std::vector<std::string> words;
  std::istringstream stream{std::string(key->range)};
  for (std::string word; std::getline(stream >> std::ws, word, ',');) words.push_back(word);
  return words;
}

std::vector<StudyKey> find_study_keys(const std::string& words) {
  const std::vector<std::string> wanted = parts_of(bare(words));
  std::vector<StudyKey> found;
  if (wanted.empty()) return found;
  for (const StudyKey& key : study_keys())
    if (parts_of(key.name) == wanted) return {key};
  for (const StudyKey& key : study_keys())
    if (begins(wanted, parts_of(key.name))) found.push_back(key);
  if (found.size() == 1 || !found.empty()) {
    // The user's own names: materials.sand.density is one key, not a section.
    for (const StudyKey& key : found)
      if (parts_of(key.name).size() == wanted.size()) return {key};
    return found;
  }
  for (const StudyKey& key : study_keys())
    if (parts_of(key.name).back() == wanted.back() && wanted.size() == 1) found.push_back(key);
  return found;
}

std::optional<std::string> nearest_study_key(const std::string& words) {
  std::vector<std::string> known = study_sections();
  for (const StudyKey& key : study_keys()) {
    known.emplace_back(key.name);
    known.push_back(parts_of(key.name).back());
  }
  return nearest(bare(words), known);
}

std::vector<std::string> study_sections() {
  std::vector<std::string> sections;
  for (const StudyKey& key : study_keys()) {
    const std::string first = parts_of(key.name).front();
    if (std::find(sections.begin(), sections.end(), first) == sections.end()) sections.push_back(first);
  }
  return sections;
}

std::string describe(const StudyKey& key) {
  std::string text = fmt::format("{}\n  {}\n  {}", key.name, key.meaning, kind_of(key));
  if (!key.fallback.empty()) text += fmt::format("; default: {}", key.fallback);
  const std::string last = parts_of(key.name).back();
  text += is_header(key) ? fmt::format("\n  example: {}", key.example)
                         : fmt::format("\n  example: {} = {}", last == "NAME" ? "friction" : last, key.example);
  return text;
}

std::string study_keys_page() {
  std::string page =
      "# The keys of study.toml\n\n"
      "Made from the table that `demcal help KEY` shows (`data/study_keys_table.cpp`). NAME stands for a name of your\n"
      "choosing. A value with a unit is written as text, `\"800 um\"`; ranges are in the unit given. A bare number is\n"
      "dimensionless, or in the section's `unit`. `[[observe]]`, `[[calibrate]]`, `[[rig.mesh]]`, `[[contact.pair]]` "
      "are\n"
      "lists: each table begins with its name in two brackets.\n";
  std::string section;
  for (const StudyKey& key : study_keys()) {
    if (const std::string first = parts_of(key.name).front(); first != section) {
      section = first;
      page += fmt::format("\n## {}\n\n| key | what | type | default | example |\n|---|---|---|---|---|\n", section);
    }
    page += fmt::format("| `{}` | {} | {} | {} | `{}` |\n", key.name, escaped(key.meaning), escaped(kind_of(key)),
                        key.fallback, escaped(key.example));
  }
  return page;
}

}  // namespace data
