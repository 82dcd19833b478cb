// Raw torque logs, and the plateaus in them.
#include "data/torque_log.hpp"
#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string path = fuzz::file_of(bytes, size, "log.csv");
  fuzz::refusable([&] {
    const data::TorqueLog log = data::read_torque_log(path);
    data::find_plateaus(log);
    data::find_stretches(log);
  });
  return 0;
}
