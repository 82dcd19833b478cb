// demcal export: a point's case for another engine, and what that engine made of it as a row of a table.
#include <fmt/format.h>

#include <algorithm>

#include <cmath>
#include <filesystem>
#include <limits>

#include "campaign/foretell.hpp"
#include "cli/command.hpp"
#include "cli/point_options.hpp"
#include "data/atomic_file.hpp"
#include "data/origin.hpp"
#include "data/provenance.hpp"
#include "data/run_table.hpp"
#include "dem/exchange/liggghts.hpp"

namespace cli {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  Common common;
  PointOptions point;
  std::string folder, to;
  bool collect = false;
};

constexpr const char* record = "point.json";

/// "friction=0.4", in the study's units, each with all digits.
std::vector<std::string> at_of(const Workspace& workspace, const Point& point) {
  std::vector<std::string> at;
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    at.push_back(fmt::format("{}={:.17g}", inputs[i].name, inputs[i].unit.from_si(point.inputs[i])));
  return at;
}

data::ExitStatus write(const ExportOptions& options, const Workspace& workspace) {
  const Point point = point_of(workspace, options.point);
  for (const std::string& warning : foretell(workspace, point).forecast.warnings)
    say(options.common, "note: " + warning);
  std::error_code failed;
  fs::create_directories(options.folder, failed);
  if (failed)
    throw data::InputError(data::ExitStatus::cannot_write,
                           {options.folder, "cannot be made: " + failed.message(), "choose another folder"});
  const nlohmann::json json{{"format", 1},
                            {"demcal", data::program_version()},
                            {"engine", "liggghts"},
                            {"study", workspace.study.name},
                            {"material", point.material},
                            {"seed", workspace.study.seed},
                            {"settings", settings_hash(workspace, point.material)},
                            {"at", at_of(workspace, point)}};
  std::vector<std::string> files =
      dem::write_liggghts(case_at(workspace, point), run_seed(workspace, point), options.folder);
  data::write_atomically((fs::path(options.folder) / record).string(), json.dump(1) + "\n");
  files.push_back(record);
  answer(options.common,
         fmt::format("{}: {}\nRun it there with: liggghts -in in.liggghts (or mpirun -np 2 liggghts -in in.liggghts)\n"
                     "Then bring its torque back with: demcal export {} {} --collect",
                     options.folder, fmt::join(files, ", "), options.common.study, options.folder));
  print_json(options.common, {{"folder", options.folder}, {"files", files}});
  return data::ExitStatus::done;
}

/// The point that the folder was written for. Throws InputError (65, 66) where it was for another study.
Point point_of(const ExportOptions& options, Workspace& workspace) {
  const std::string path = (fs::path(options.folder) / record).string();
  data::require_unchanged(path, "write the folder again: demcal export STUDY FOLDER --to liggghts");
  const nlohmann::json json = nlohmann::json::parse(data::read_file(path), nullptr, false);
  const auto wrong = [&](const std::string& what) {
    return data::InputError(data::ExitStatus::bad_data,
                            {path, what, "write the folder again: demcal export STUDY FOLDER --to liggghts"});
  };
  try {
    workspace.study.seed = json.at("seed").get<std::uint64_t>();
    const std::string material = json.at("material");
    if (json.at("study") != workspace.study.name)
      throw wrong(fmt::format("is of the study '{}'", json.at("study").get<std::string>()));
    if (std::none_of(workspace.study.materials.begin(), workspace.study.materials.end(),
                     [&](const data::Material& one) { return one.name == material; }))
      throw wrong(fmt::format("is of the material '{}', which the study no longer has", material));
    if (json.at("settings") != settings_hash(workspace, material))
      throw wrong("was written with other settings than the study has now");
    return parse_point(workspace, material, json.at("at").get<std::vector<std::string>>());
  } catch (const nlohmann::json::exception&) {
    throw wrong("is no record of an exported point");
  }
}

data::ExitStatus collect(const ExportOptions& options, Workspace workspace) {
  const Point point = point_of(options, workspace);
  const auto& outputs = workspace.study.outputs;
  const auto torque =
      std::find_if(outputs.begin(), outputs.end(), [](const data::Output& o) { return o.name == "torque"; });
  if (torque == outputs.end())
    throw data::InputError(data::ExitStatus::bad_study,
                           {"[outputs]", "has no torque, which is what comes back", "add [outputs.torque]"});
  const dem::Measured measured = dem::read_liggghts(case_at(workspace, point), options.folder);
  if (!std::isfinite(measured.torque.mean) || !std::isfinite(measured.torque.standard_error))
    throw data::InputError(data::ExitStatus::bad_data,
                           {options.folder, "holds too little turning to know a mean torque and its error",
                            "let LIGGGHTS run longer: -var nrun N"});
  data::RunRow row{.material = point.material, .inputs = point.inputs, .seed = workspace.study.seed};
  row.origin = "LIGGGHTS";
  row.state = data::to_text(measured.state);
  row.outputs.assign(outputs.size(), std::numeric_limits<double>::quiet_NaN());
  row.standard_errors = row.outputs;
  const auto column = static_cast<std::size_t>(torque - outputs.begin());
  row.outputs[column] = measured.torque.mean;
  row.standard_errors[column] = measured.torque.standard_error;

  const auto held = hold_out(workspace, Writes::training, "export");
  const std::string path = (fs::path(workspace.out) / "liggghts.csv").string();
  data::require_unchanged(path, "move it away, and collect its folders again");
  data::RunTable table = data::empty_table(workspace.study);
  table.rows.push_back(row);
  if (fs::exists(path)) table = data::merge(table, data::read_table(path, workspace.study).table);
  data::require_replaceable(path);
  data::write_table_csv(path, table, workspace.study);
  const data::Unit& unit = torque->unit;
  answer(options.common,
         fmt::format("{}: torque {:.4g} +- {:.2g} {}, {}\nRow {} of {}", describe(workspace.study, point),
                     unit.from_si(measured.torque.mean), measured.torque.standard_error / unit.factor, unit.symbol,
                     row.state, table.rows.size(), path));
  print_json(options.common, {{"torque",
                               {{"mean", unit.from_si(measured.torque.mean)},
                                {"standard_error", measured.torque.standard_error / unit.factor},
                                {"unit", unit.symbol}}},
                              {"state", row.state},
                              {"table", path}});
  if (measured.state == data::FlowState::steady) return data::ExitStatus::done;
  say(options.common,
      "warning: this is not known to be the torque of the steady flow; the row says so, and calibrate leaves it out. "
      "Let LIGGGHTS run longer: -var nrun N");
  return data::ExitStatus::warning;
}

}  // namespace

Action add_export(CLI::App& program) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      add_study_command(program, "export", "the case of a point for LIGGGHTS, and its torque back",
                        "demcal export data/developer lig --to liggghts --material zirconia-800", options->common);
  command->add_option("FOLDER", options->folder, "what LIGGGHTS reads and writes")->required();
  CLI::Option* to = command->add_option("--to", options->to, "write the case into FOLDER for this engine")
                        ->check(one_of({"liggghts"}));
  add_point_options(*command, options->point);
  command->add_flag("--collect", options->collect, "read the torque in FOLDER into OUT/liggghts.csv")->excludes(to);
  return [options] {
    const Workspace workspace = open_workspace(options->common);
    require_rig(workspace);
    if (options->collect) return collect(*options, workspace);
    if (options->to.empty())
      throw data::InputError(data::ExitStatus::usage,
                             {"--to", "says for which engine the case is written", "add --to liggghts, or --collect"});
    return write(*options, workspace);
  };
}

}  // namespace cli
