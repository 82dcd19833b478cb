#pragma once
// Texts of an enum's values, the same in files, messages and reports. An enum gets them beside its definition:
//   template <>
//   inline constexpr std::array data::texts_of<Colour> = {"red", "green"};
// in the order of its values, which count from 0.
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace data {

template <class Enum>
inline constexpr std::nullptr_t texts_of = nullptr;

template <class T>
concept HasTexts = std::is_enum_v<T> && requires {
  texts_of<T>.size();
};

template <HasTexts Enum>
constexpr const char* to_text(Enum value) {
  return texts_of<Enum>[static_cast<std::size_t>(value)];
}

/// The value that has this text; nothing where none has.
template <HasTexts Enum>
constexpr std::optional<Enum> from_text(std::string_view text) {
  for (std::size_t i = 0; i < texts_of<Enum>.size(); ++i)
    if (text == texts_of<Enum>[i]) return static_cast<Enum>(i);
  return {};
}

}  // namespace data
