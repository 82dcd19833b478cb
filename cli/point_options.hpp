#pragma once
// --material and --at: the one point of a study that a command is about.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "campaign/point.hpp"

namespace cli {

struct PointOptions {
  std::string material;
  std::vector<std::string> at;
};

inline void add_point_options(CLI::App& command, PointOptions& options) {
  command.add_option("--material", options.material, "which of the study's materials (default: the first)");
  command
      .add_option("--at", options.at,
                  "NAME=VALUE of parameters and controls, separated by commas; the others take the material's fixed "
                  "value or the middle of their range")
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// Throws data::InputError (64) for a material, name or value that the study has not.
inline campaign::Point point_of(const campaign::Workspace& workspace, const PointOptions& options) {
  return campaign::parse_point(workspace, campaign::choose_material(workspace.study, options.material), options.at);
}

}  // namespace cli
