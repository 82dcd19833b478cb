#pragma once
// XXH3 with 128 bits, as 32 hexadecimal digits: identity of settings and of files, not a defence against forgery.
#include <string>
#include <string_view>

namespace data {

std::string hash_text(std::string_view text);

/// Throws InputError (66) when the file is missing.
std::string hash_file(const std::string& path);

}  // namespace data
