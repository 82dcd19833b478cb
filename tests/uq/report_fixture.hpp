#pragma once
// A made-up calibration with the shape of the default study: one parameter identified, one identified with a linked
// case, and two on a ridge. The numbers are invented; only their form matters to the tests of the report.
#include <filesystem>
#include <string>

#include "uq/results.hpp"

namespace report_fixture {

uq::CalibrationReport three_cases();

/// One case with four parameters, of which two are traded; no units.
uq::CalibrationReport four_parameters();

/// One case that no parameter value reproduces, although its parameter claims to be identified.
uq::CalibrationReport misfit();

/// A fresh folder that goes away with the object.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& file) const { return (path_ / file).string(); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string read(const std::string& path);
std::size_t count(const std::string& text, const std::string& piece);

}  // namespace report_fixture
