#pragma once
#include <string>
#include <vector>

namespace uq {

/// "a", "a and b", "a, b and c"; of text, or of what text becomes (uq/report/element.hpp).
template <class Text>
Text listed(const std::vector<Text>& names) {
  Text text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace uq
