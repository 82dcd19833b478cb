#pragma once
// Runs the program as a user would, in a folder of the test's own.
#include <filesystem>
#include <string>
#include <vector>

#include "tests/temporary.hpp"

namespace test {

struct Outcome {
  int status = 0;
  std::string out, err;
};

/// The words, each setting behind a --set.
std::vector<std::string> with_settings(std::vector<std::string> words, const std::vector<std::string>& settings);

/// An empty folder that goes with the object.
class Folder {
  TemporaryFolder temporary_;

 public:
  Folder();

  std::filesystem::path path = temporary_.path();
  /// Copies a shipped study (data/NAME) here and returns its place.
  std::filesystem::path study(const std::string& name) const;
  void write(const std::string& file, const std::string& text) const;
  std::string read(const std::string& file) const;
  /// Replaces a text that must be in the file.
  void replace(const std::string& file, const std::string& old_text, const std::string& new_text) const;

  /// The program, started in this folder. `stop_when` (a file) ends it by SIGINT as soon as the file exists.
  Outcome demcal(const std::vector<std::string>& arguments, const std::string& stop_when = "") const;
  /// What the program says on stderr; checks that it ends with this status.
  std::string says(const std::vector<std::string>& arguments, int status) const;
  /// A shell's command line, started in this folder, with the program as "$demcal".
  Outcome shell(const std::string& command) const;

 private:
  Outcome start(std::vector<std::string> words, const std::string& stop_when) const;
};

}  // namespace test
