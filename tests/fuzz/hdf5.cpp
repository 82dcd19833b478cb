// HDF5: tables of runs, and files of runs.
#include "data/run_table_files.hpp"
#include "data/study.hpp"
#include "data/study_file.hpp"
#include "dem/run/run_file.hpp"
#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const data::Study study =
      data::read_study(data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code/study.toml"));
  const std::string path = fuzz::file_of(bytes, size, "input.h5");
  fuzz::refusable([&] { data::read_table_hdf5(path, study); });
  fuzz::refusable([&] { dem::read_run(path); });
  return 0;
}
