// Tables: as CSV of any dialect, as observations and as runs of a study.
#include "data/csv.hpp"

#include "data/observations.hpp"
#include "data/run_table.hpp"
#include "data/run_table_files.hpp"
#include "data/study.hpp"
#include "data/study_file.hpp"
#include "tests/fuzz/target.hpp"

namespace {

const data::Study& study() {
  static const data::Study read =
      data::read_study(data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code/study.toml"));
  return read;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::refusable([&] { data::parse_csv(std::string(fuzz::text_of(bytes, size)), "input.csv"); });
  const std::string path = fuzz::file_of(bytes, size, "input.csv");
  fuzz::refusable([&] { data::read_observations(path, study(), {}); });
  fuzz::refusable([&] { data::read_table(path, study()); });
  return 0;
}
