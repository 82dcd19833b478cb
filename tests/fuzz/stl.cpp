// Triangle meshes, ASCII and binary.
#include "dem/walls/stl.hpp"

#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::refusable([&] { dem::parse_stl(fuzz::text_of(bytes, size), "input.stl", 1e-3); });
  return 0;
}
