#pragma once
// A key of the study that chooses one of an enum's values, by its texts (data/texts.hpp).
#include <string>
#include <string_view>
#include <vector>

#include "data/study_file.hpp"
#include "data/texts.hpp"

namespace dem {

/// `field` is the default, and stays where the key has another text, which is recorded.
template <data::HasTexts Choice>
void choose(const data::Section& s, std::string_view key, Choice& field) {
  const std::vector<std::string> texts(data::texts_of<Choice>.begin(), data::texts_of<Choice>.end());
  if (const auto chosen = data::from_text<Choice>(s.choice(key, texts, data::to_text(field)))) field = *chosen;
}

}  // namespace dem
