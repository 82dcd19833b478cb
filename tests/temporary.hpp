#pragma once
// A folder of its own for a test's files, removed at the end.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "data/error.hpp"

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "demcal-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

 private:
  std::string path_;
};

/// The message of the InputError that an action throws, "status: message"; "" when it throws none. Paths inside
/// `folder` are shortened to their names.
template <class Action>
std::string failure_of(const TemporaryFolder& folder, Action action) {
  try {
    action();
  } catch (const data::InputError& error) {
    std::string text = std::to_string(static_cast<int>(error.status)) + ": " + error.what();
    const std::string prefix = folder.path() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }
  return "";
}
