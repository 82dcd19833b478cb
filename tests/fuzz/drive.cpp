// Inputs for a target where libFuzzer is not: seed files, changed at random. drive SECONDS SEED FILE-OR-FOLDER...
// The input at hand is kept in ./PROGRAM-input until its turn is over, so that one that ends the program can be tried
// again: PROGRAM FILE.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t largest = 1 << 19;
constexpr double slowest = 10.0;  // seconds that one input may take

Bytes read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes{std::istreambuf_iterator<char>(file), {}};
  bytes.resize(std::min(bytes.size(), largest));
  return bytes;
}

/// One change: a bit, a byte, a piece left out, doubled or taken from another seed, or a text that readers trip over.
void change(Bytes& bytes, const std::vector<Bytes>& seeds, std::mt19937_64& random) {
  static const std::vector<std::string> texts{"nan",  "-1",      "1e400", "0",    ",",        "\n", "\"", "\xff", "[",
                                              "]",    "= {}",    "inf",   "\r\n", "0x10",     "\t", ";",  "#",    "'",
                                              "1e-9", "\\u0000", "[[",    "]]",   "99999999", ".",  "..", "/",    "e"};
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  const std::size_t at = below(bytes.size());
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t length = std::min(bytes.size() - at, std::size_t{1} + below(std::size_t{1} << below(10)));
  switch (below(6)) {
    case 0:
      if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
      break;
    case 1:
      if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      bytes.erase(place, place + static_cast<std::ptrdiff_t>(length));
      break;
    case 3: {
      const Bytes piece(place, place + static_cast<std::ptrdiff_t>(length));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size() + 1)), piece.begin(), piece.end());
      break;
    }
    case 4: {
      const Bytes& other = seeds[below(seeds.size())];
      const std::size_t from = below(other.size()), count = std::min(other.size() - from, length);
      bytes.insert(place, other.begin() + static_cast<std::ptrdiff_t>(from),
                   other.begin() + static_cast<std::ptrdiff_t>(from + count));
      break;
    }
    default: {
      const std::string& text = texts[below(texts.size())];
      bytes.insert(place, text.begin(), text.end());
    }
  }
  bytes.resize(std::min(bytes.size(), largest));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) {
    const Bytes bytes = read(argv[1]);
    return LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s SECONDS SEED FILE-OR-FOLDER...\n       %s FILE\n", argv[0], argv[0]);
    return 64;
  }
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const double seconds = std::atof(argv[1]);
  std::mt19937_64 random(std::strtoull(argv[2], nullptr, 10));
  std::vector<fs::path> paths;
  for (int i = 3; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      paths.emplace_back(argv[i]);
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(argv[i]))
      if (entry.is_regular_file()) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> seeds;
  for (const fs::path& path : paths) seeds.push_back(read(path));
  const std::string kept = fs::path(argv[0]).filename().string() + "-input";

  long inputs = 0;
  double longest = 0.0;
  for (const Clock::time_point begin = Clock::now(); since(begin) < seconds; ++inputs) {
    Bytes bytes = seeds[static_cast<std::size_t>(inputs) % seeds.size()];
    if (inputs >= static_cast<long>(seeds.size()))
      for (std::uint64_t changes = 1 + random() % 8; changes > 0; --changes) change(bytes, seeds, random);
    std::ofstream(kept, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const Clock::time_point start = Clock::now();
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    longest = std::max(longest, since(start));
    if (longest > slowest) {
      std::fprintf(stderr, "an input took %.1f s: %s\n", longest, kept.c_str());
      return 1;
    }
  }
  fs::remove(kept);
  std::printf("%ld inputs from %zu seed files, the slowest %.2f s\n", inputs, seeds.size(), longest);
  return 0;
}
