#include "tests/cli/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

namespace test {
namespace fs = std::filesystem;
namespace {

std::string content(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

std::vector<std::string> with_settings(std::vector<std::string> words, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

Folder::Folder() { REQUIRE(fs::is_empty(path)); }

fs::path Folder::study(const std::string& name) const {
  fs::copy(fs::path(DEMCAL_SOURCE_DIR) / "data" / name, path / "study", fs::copy_options::recursive);
  return path / "study";
}

void Folder::write(const std::string& file, const std::string& text) const { std::ofstream(path / file) << text; }

std::string Folder::read(const std::string& file) const { return content(path / file); }

void Folder::replace(const std::string& file, const std::string& old_text, const std::string& new_text) const {
  std::string text = read(file);
  const std::size_t at = text.find(old_text);
  REQUIRE(at != std::string::npos);
  write(file, text.replace(at, old_text.size(), new_text));
}

Outcome Folder::demcal(const std::vector<std::string>& arguments, const std::string& stop_when) const {
  std::vector<std::string> words{DEMCAL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return start(std::move(words), stop_when);
}

std::string Folder::says(const std::vector<std::string>& arguments, int status) const {
  const Outcome outcome = demcal(arguments);
  CAPTURE(arguments);
  INFO(outcome.err);
  CHECK(outcome.status == status);
  return outcome.err;
}

Outcome Folder::shell(const std::string& command) const {
  return start({"/bin/sh", "-c", "demcal='" DEMCAL_PROGRAM "'; " + command}, "");
}

Outcome Folder::start(std::vector<std::string> words, const std::string& stop_when) const {
  const fs::path out = path / ".stdout", err = path / ".stderr";
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const bool ready = chdir(path.c_str()) == 0 &&
                       dup2(open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), 1) == 1 &&
                       dup2(open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), 2) == 2;
    if (ready) execv(argv[0], argv.data());
    _exit(127);
  }
  int state = 0;
  if (!stop_when.empty()) {
    while (!fs::exists(path / stop_when) && waitpid(child, &state, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(child, SIGINT);
  }
  waitpid(child, &state, 0);
  return {WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state), content(out), content(err)};
}

}  // namespace test
