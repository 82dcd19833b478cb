#include "data/file_name.hpp"

#include <algorithm>

#include "data/hash.hpp"

namespace data {
namespace {

constexpr std::size_t longest = 100;

bool plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-' || c == '.';
}

}  // namespace

bool is_file_name(std::string_view text) {
  return !text.empty() && text.size() <= longest && text.front() != '.' && text.front() != '-' &&
         std::all_of(text.begin(), text.end(), plain);
}

std::string file_name(std::string_view text) {
  if (is_file_name(text)) return std::string(text);
  std::string name;
  for (const char c : text.substr(0, 60)) name += plain(c) ? c : '_';
  if (name.empty() || name.front() == '.' || name.front() == '-') name.insert(0, "_");
  return name + "-" + hash_text(text).substr(0, 8);
}

std::string shell_word(std::string_view text) {
  const auto bare = [](char c) { return plain(c) || c == '/' || c == '+' || c == '=' || c == ':' || c == ','; };
  if (!text.empty() && text.front() != '-' && std::all_of(text.begin(), text.end(), bare)) return std::string(text);
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace data
