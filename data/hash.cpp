#include "data/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include "data/atomic_file.hpp"

namespace data {

std::string hash_text(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hash_file(const std::string& path) { return hash_text(read_file(path)); }

}  // namespace data
