#pragma once
// The reference of study.toml: one entry for each key that a study may hold. `demcal help KEY`, docs/keys.md and the
// man page are made from it. tests/keys holds it against what the readers ask for, in both directions, with type,
// unit, range, default and choices.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace data {

struct StudyKey {
  std::string_view name;  ///< dotted, NAME for what the user names: "parameters.NAME.low"
  std::string_view type;  ///< as AskedKey::type
  std::string_view unit;  ///< SI unit whose dimension a value must have; empty: none; "own": that of the parameter or
                          ///< control that it is of, which also bare numbers have
  std::string_view
      range;  ///< in that unit: "[0, 1]", "]0, inf["; of a choice its words: "linear, log", or "the outputs"
  std::string_view fallback;  ///< in words or in that unit; empty: there is none
  std::string_view meaning;
  std::string_view example;  ///< TOML
};

/// All keys, in the order of a study file.
const std::vector<StudyKey>& study_keys();

/// The words that a choice may be, such as the kinds of "rig.kind". Throws std::out_of_range where there is no such
/// key.
std::vector<std::string> words_of(std::string_view name);

/// The entries that a user may mean by "friction", "contact.friction", "[observe]", "materials.sand.density" or
/// "parameters.friction": a key, or all keys of a section; empty when there are none.
std::vector<StudyKey> find_study_keys(const std::string& words);

/// The key or section that is nearest to a misspelt one.
std::optional<std::string> nearest_study_key(const std::string& words);

/// The first parts of the names, in order: study, parameters, ...
std::vector<std::string> study_sections();

/// An entry as text for the terminal: several lines.
std::string describe(const StudyKey& key);

/// The text of docs/keys.md.
std::string study_keys_page();

}  // namespace data
