#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "cli/placeholder.hpp"
#include "cli/point.hpp"
#include "cli/training_table.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/edit_distance.hpp"
#include "data/run_table_files.hpp"
#include "data/terminal.hpp"
#include "dem/isa.hpp"
#include "dem/read_case.hpp"
#include "dem/target.hpp"
#include "uq/report_results.hpp"
#include "uq/surrogate_settings.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

/// Each parameter and control must name something the DEM has, in a range and unit that it can take.
void check_target(const data::Section& section, const std::string& target_name, const data::Unit& unit, double low,
                  double high) {
  const std::optional<dem::Target> target = dem::find_target(target_name);
  if (!target) {
    std::string known;
    for (const dem::Target& t : dem::targets()) known += (known.empty() ? "" : ", ") + t.name;
    section.problem("target", fmt::format("the simulation has no quantity '{}'", target_name),
                    "choose one of: " + known + ", contact.A-B.KEY, material.NAME.KEY");
    return;
  }
  if (!data::convertible(unit.symbol, target->unit)) {
    section.problem("unit", fmt::format("'{}' does not measure {} ({})", unit.symbol, target->name, target->unit),
                    "use a unit of that dimension");
    return;
  }
  const auto outside = [&](const char* key, double value) {
    if (value >= target->low && value <= target->high) return;
    section.problem(key,
                    fmt::format("{} is outside the possible range [{:g}, {:g}] of {}", with_unit(value, unit),
                                unit.from_si(target->low), unit.from_si(target->high), target->name),
                    "choose a bound inside it");
  };
  outside("low", low);
  outside("high", high);
}

/// ./STUDY-NAME, or ./STUDY-NAME-results where the study itself lies there.
std::string default_out(const data::Study& study) {
  std::error_code failure;
  const bool own = fs::weakly_canonical(study.name, failure) == fs::weakly_canonical(study.folder, failure);
  return fs::absolute(own ? study.name + "-results" : study.name).lexically_normal().string();
}

/// Lines of [training] leave_out at which no row stands.
void tell_unknown_rows(const data::Study& study, TrainingRows& rows) {
  const auto stands = [&](const std::string& label) {
    const auto named = [&](const data::RunRow& row) { return data::names_row(label, row.place); };
    return std::any_of(rows.table.rows.begin(), rows.table.rows.end(), named) ||
           (rows.low && std::any_of(rows.low->rows.begin(), rows.low->rows.end(), named));
  };
  for (const std::string& label : study.training.leave_out)
    if (!stands(label))
      rows.findings.push_back({.kind = "rows left out",
                               .place = study.training.place,
                               .severity = data::Severity::warning,
                               .what = fmt::format("leave_out names {}, where no row is read", label),
                               .remedy = "name rows as the messages do: a line of the table, or \"FILE:LINE\"",
                               .places = {}});
}

}  // namespace

CLI::Validator number_in(double low, double high, const std::string& what) {
  CLI::Validator validator(
      [low, high, what](std::string& text) {
        double value = 0.0;
        const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
        const auto [rest, error] = std::from_chars(begin, text.data() + text.size(), value);
        const bool number = error == std::errc{} && rest == text.data() + text.size() && std::isfinite(value);
        return number && value >= low && value <= high ? std::string() : fmt::format("'{}' is not {}", text, what);
      },
      "NUMBER", "");
  return validator;
}

CLI::Validator one_of(const std::vector<std::string>& choices) {
  return CLI::Validator(
      [choices](std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) return std::string();
        const auto near = data::nearest(text, choices);
        return fmt::format("'{}' is not one of {}{}", text, fmt::join(choices, ", "),
                           near ? fmt::format(" (did you mean '{}'?)", *near) : "");
      },
      fmt::format("{}", fmt::join(choices, "|")), "");
}

CLI::App* add_study_command(CLI::App& program, const std::string& name, const std::string& purpose,
                            const std::string& example, Common& common) {
  CLI::App* command = program.add_subcommand(name, purpose);
  command->add_option("STUDY", common.study, "study file, or folder that holds study.toml")->required();
  command->add_option("--out", common.out,
                      "results folder (default: ./STUDY-NAME, or ./STUDY-NAME-results beside the study)");
  command
      ->add_option_function<std::string>(
          "--seed",
          [&common](const std::string& text) {
            std::uint64_t seed = 0;
            const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
            if (error != std::errc{} || rest != text.data() + text.size())
              throw CLI::ValidationError("--seed", fmt::format("'{}' is not a whole number from 0 to 2^64 - 1", text));
            common.seed = seed;
          },
          "seed of all random streams, instead of the study's")
      ->type_name("UINT");
  command->add_flag("--quiet", common.quiet, "no progress, no summary");
  command->add_flag("--json", common.json, "the result as JSON on stdout, and nothing else there");
  command->add_option("--set", common.set, "set a key of the study: contact.restitution=0.8")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->footer("Example: " + example);
  return command;
}

void add_isa_option(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--isa", dem::pin_isa,
          "instruction set of the contact forces: x86-64, x86-64-v3 or x86-64-v4 (default: the widest that the "
          "processor has); the result does not depend on it")
      ->check(one_of({"x86-64", "x86-64-v3", "x86-64-v4"}));
}

Workspace open_workspace(const Common& common) {
  const data::StudyFile file = data::StudyFile::open(common.study, common.set);
  Workspace workspace{.study = data::read_study(file), .cases = {}, .surrogates = {}, .out = {}, .plan = {}};
  workspace.surrogates =
      std::make_shared<const uq::SurrogateOptions>(uq::read_surrogate_options(file, workspace.study));
  data::Study& study = workspace.study;
  workspace.changes = common.set;
  if (common.seed) {
    study.seed = *common.seed;
    workspace.changes.push_back(fmt::format("study.seed={}", study.seed));
  }
  if (file.root().child("rig").exists()) {
    for (const data::Material& material : study.materials)
      workspace.cases[material.name] = dem::read_case(file, material.name);
    for (const data::Parameter& p : study.parameters)
      check_target(file.root().child("parameters").child(p.name), p.target, p.unit, p.low, p.high);
    for (const data::Control& c : study.controls)
      check_target(file.root().child("controls").child(c.name), c.target, c.unit, c.low, c.high);
    for (const data::Output& output : study.outputs)
      if (!dem::has_output(output.name))
        file.root().child("outputs").problem(output.name, fmt::format("the simulation has no output '{}'", output.name),
                                             "choose one of: " + dem::output_names());
  }
  workspace.unsteady = file.root().child("training").choice("unsteady", {"leave_out", "use"}, "leave_out") == "use"
                           ? Unsteady::use
                           : Unsteady::leave_out;
  workspace.plan = data::read_plan(file, study);
  file.finish();
  // How tables were read that are not plain CSV; what is wrong with them was said before.
  for (const data::ObservationSet& set : study.observations)
    if (const std::string how = data::read_csv(set.file).took_line(); !how.empty()) say(common, how);
  if (const std::string& table = study.training.table;
      !table.empty() && fs::path(table).extension() == ".csv" && fs::exists(table))
    if (const std::string how = data::read_csv(table).took_line(); !how.empty()) say(common, how);
  workspace.out = common.out.empty() ? default_out(study) : fs::absolute(common.out).lexically_normal().string();
  return workspace;
}

void require_rig(const Workspace& workspace) {
  if (!workspace.cases.empty()) return;
  throw data::InputError(data::ExitStatus::bad_study,
                         {workspace.study.file, "has no [rig], so there is nothing to simulate",
                          "add a [rig] section (demcal new shows one)"});
}

void make_out(const Workspace& workspace, const std::string& subfolder) {
  const fs::path out = workspace.out;
  std::error_code failure;
  if (fs::weakly_canonical(out, failure) == fs::weakly_canonical(workspace.study.folder, failure))
    throw data::InputError(data::ExitStatus::cannot_write,
                           {workspace.out, "is the study's own folder, and nothing is ever written there",
                            "start demcal elsewhere, or give --out DIR"});
  fs::create_directories(out / subfolder, failure);
  if (failure)
    throw data::InputError(
        data::ExitStatus::cannot_write,
        {(out / subfolder).string(), "cannot be made: " + failure.message(), "give another folder with --out DIR"});
  if (::access((out / subfolder).c_str(), W_OK | X_OK) != 0)
    throw data::InputError(data::ExitStatus::cannot_write,
                           {(out / subfolder).string(), fmt::format("cannot be written: {}", std::strerror(errno)),
                            "give another folder with --out DIR"});
}

namespace {

/// Two studies of one name have one results folder by default, and the second must not replace the first's results.
/// A study that was moved or renamed still owns its own.
void require_own_results(const Workspace& workspace) {
  const fs::path results = fs::path(workspace.out) / "results.json";
  std::error_code failure;
  if (!fs::exists(results, failure)) return;
  std::string of;
  try {
    of = uq::load_results(results.string()).study_file;
  } catch (const data::InputError&) {  // damaged or of another version: it says of nobody whose it is
    return;
  }
  if (of.empty() || !fs::exists(of, failure) || fs::equivalent(of, workspace.study.file, failure)) return;
  throw data::InputError(data::ExitStatus::cannot_write,
                         {workspace.out, fmt::format("holds the results of another study, {}", of),
                          "give another folder with --out DIR, give this study a name of its own ([study] name), or "
                          "move those results away"});
}

}  // namespace

std::unique_ptr<data::FolderLock> hold_out(const Workspace& workspace, Writes files, const std::string& command) {
  make_out(workspace);
  const char* const name = files == Writes::training ? "training" : files == Writes::results ? "results" : "run";
  auto lock = std::make_unique<data::FolderLock>(workspace.out, name, "demcal " + command);
  std::vector<std::string> written;
  if (files == Writes::training) written = {"training.h5", "training.csv", "design.csv"};
  if (files == Writes::results) {
    require_own_results(workspace);
    written = {"surrogate.h5", "results.json", "report.json", "report.html", "plan.json"};
    for (const data::CalibrationCase& one : workspace.study.cases) written.push_back("posterior-" + one.name + ".nc");
  }
  for (const std::string& file : written) data::require_replaceable((fs::path(workspace.out) / file).string());
  return lock;
}

namespace {

void leave_out_unsteady(const Workspace& workspace, TrainingRows& rows) {
  if (workspace.unsteady == Unsteady::use) return;
  std::map<std::string, int> left_out;
  std::erase_if(rows.table.rows, [&](const data::RunRow& row) {
    const bool unsteady = data::is_unsteady(row);
    if (unsteady) ++left_out[row.state];
    return unsteady;
  });
  for (const auto& [state, count] : left_out)
    rows.notes.push_back(fmt::format(
        "{} of {} runs are not of the steady flow ({}) and are left out: raise run.longest and train again, "
        "or set training.unsteady = \"use\"",
        count, rows.all.rows.size(), state));
  for (std::string& note : data::drop_unreliable(rows.table)) rows.notes.push_back(std::move(note));
}

}  // namespace

TrainingRows training_rows(const Workspace& workspace) {
  const data::Study& study = workspace.study;
  TrainingRows result{data::empty_table(study), {}, {}, {}};
  std::map<std::string, std::string> settings;
  for (const auto& [material, unused] : workspace.cases) settings[material] = settings_hash(workspace, material);
  const auto add = [&](const std::string& path, const data::TableRead& read) {
    for (const std::string& left_out : read.left_out) result.notes.push_back(left_out);
    result.findings.insert(result.findings.end(), read.findings.begin(), read.findings.end());
    data::RunTable usable = read.table;
    const bool own = path != study.training.table;
    std::size_t stale = std::erase_if(usable.rows, [&](const data::RunRow& row) {
      const auto known = settings.find(row.material);
      const bool other = known != settings.end() && !row.settings.empty() && row.settings != known->second;
      if (other && own) result.kept.push_back(row);
      return other;
    });
    if (stale > 0)
      result.notes.push_back(
          fmt::format("{}: {} of {} rows were simulated under other settings than the study's and are left out (demcal "
                      "train makes them again)",
                      path, stale, read.table.rows.size()));
    result.all = data::merge(result.all, usable);
  };
  if (!study.training.table.empty()) add(study.training.table, data::read_table(study.training.table, study));
  const std::string own = (fs::path(workspace.out) / "training.h5").string();
  if (fs::exists(own)) add(own, read_own_table(workspace, result.notes));
  result.table = result.all;
  leave_out_unsteady(workspace, result);
  if (!study.training.low.empty()) {
    data::TableRead read = data::read_table(study.training.low, study);
    for (std::string& left_out : read.left_out) result.notes.push_back(std::move(left_out));
    result.findings.insert(result.findings.end(), read.findings.begin(), read.findings.end());
    result.low = std::move(read.table);
  }
  tell_unknown_rows(study, result);
  for (data::Finding& finding : placeholders(study)) result.findings.push_back(std::move(finding));
  return result;
}

std::string with_unit(double si, const data::Unit& unit) {
  return fmt::format("{:.5g}{}{}", unit.from_si(si), unit.symbol.empty() ? "" : " ", unit.symbol);
}

void say(const Common& common, const std::string& text) {
  if (!common.quiet) data::tell(text);
}

void answer(const Common& common, const std::string& text) {
  if (common.quiet) return;
  if (common.json)
    data::tell(text);
  else
    data::print_answer(text);
}

void print_json(const Common& common, const nlohmann::json& result) {
  if (!common.json) return;
  // Controls of C1 are valid in JSON as they are, but a terminal may obey them.
  std::string text;
  for (const char c : result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    const bool control = !text.empty() && text.back() == '\xc2' && static_cast<unsigned char>(c) < 0xa0 &&
                         static_cast<unsigned char>(c) >= 0x80;
    if (control)
      text.replace(text.size() - 1, 1, fmt::format("\\u{:04x}", static_cast<unsigned char>(c)));
    else
      text += c == '\x7f' ? std::string("\\u007f") : std::string(1, c);
  }
  data::print_result(text);
}

}  // namespace cli
