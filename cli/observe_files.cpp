#include "cli/observe_files.hpp"

#include <fmt/core.h>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/file_name.hpp"

namespace cli {
namespace fs = std::filesystem;

std::vector<fs::path> observe_pictures(const fs::path& out) {
  const fs::path folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  const std::string stem = data::file_name(out.stem().string());
  return {folder / (stem + ".svg"), folder / (stem + ".gp"), folder / (stem + ".dat")};
}

void check_observe_targets(const fs::path& out, const std::vector<std::string>& logs) {
  const std::vector<fs::path> pictures = observe_pictures(out);
  for (const fs::path& file : pictures)
    if (file.filename() == out.filename())
      throw data::InputError(
          data::ExitStatus::usage,
          {"--out", fmt::format("'{}' is the name of one of the picture's files", out.string()), "end it in .csv"});
  std::vector<fs::path> targets = pictures;
  targets.push_back(out);
  for (const std::string& log : logs)
    for (const fs::path& target : targets) {
      std::error_code ignored;
      if (!log.empty() && fs::equivalent(target, log, ignored))
        throw data::InputError(data::ExitStatus::cannot_write,
                               {target.string(), "is the log itself", "choose another --out"});
    }
  data::require_replaceable(out.string(), data::Changed::refuse);
  for (const fs::path& file : pictures) data::require_replaceable(file.string());
}

}  // namespace cli
