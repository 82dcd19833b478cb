// Studies, with the cases of their rigs.
#include "data/study.hpp"

#include "data/study_file.hpp"
#include "dem/reading/read_case.hpp"
#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string path = fuzz::file_of(bytes, size, "study.toml");
  fuzz::refusable([&] {
    const data::StudyFile file = data::StudyFile::open(path);
    const data::Study study = data::read_study(file);
    if (file.root().child("rig").exists())
      for (const data::Material& material : study.materials) dem::read_case(file, material.name);
    file.finish();
  });
  return 0;
}
