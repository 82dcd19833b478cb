#pragma once
#include <string>
#include <vector>

namespace uq {

/// The names as a list in words: "a", "a and b", "a, b and c". They are texts, or what texts become
/// (uq/report/element.hpp).
template <class Text>
Text listed(const std::vector<Text>& names) {
  Text text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace uq
