#include "uq/emulate/surrogate_file.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "data/error.hpp"
#include "data/hash.hpp"
#include "data/provenance.hpp"
#include "surrogate/storage.hpp"
#include "uq/findings/report_file.hpp"

namespace uq {
namespace {

/// The edition of how surrogates are chosen, fitted and judged in words: those of another one are fitted again.
constexpr int fit_edition = 5;

surrogate::SurrogateKey key_of(const data::Study& study, const data::RunTable& table, const SurrogateOptions& options) {
  std::string text = fmt::format("{} {} {}\n", data::program_version(), report_edition, fit_edition);
  for (const data::Input& one : data::inputs_of(study))
    text += fmt::format("{} {} {} {} {}\n", one.name, one.unit.symbol, one.axis.low, one.axis.high,
                        one.axis.scale == data::Scale::log);
  for (const data::Output& output : study.outputs) text += fmt::format("{} {}\n", output.name, output.unit.symbol);
  const surrogate::FitOptions& fit = options.fit;
  text +=
      fmt::format("{} {} {} {} {} {} {} {}\n", to_text(fit.kernel), to_text(fit.mean), to_text(fit.scale), fit.nugget,
                  fit.starts, fit.seed, static_cast<int>(fit.estimate), static_cast<int>(fit.hyper_uncertainty));
  text += fmt::format("between runs {}, at most {}\n", static_cast<int>(fit.between_runs), options.runs_most);
  if (!options.stretch) text += "inputs on their own scales\n";
  for (const std::string& name : options.log_outputs) text += "log " + name + "\n";
  return {.study_hash = data::hash_text(text),
          .table_hash = table_hash(table) + (options.low ? " over " + table_hash(*options.low) : "")};
}

}  // namespace

std::string table_hash(const data::RunTable& table) {
  std::string text;
  for (const data::RunRow& row : table.rows) {
    text += data::row_key(row) + (row.left_out ? " left out" : "");
    for (std::size_t i = 0; i < row.outputs.size(); ++i)
      text += fmt::format(" {} {}", row.outputs[i], row.standard_errors[i]);
    text += "\n";
  }
  return data::hash_text(text);
}

void save_surrogates(const std::string& path, const data::Study& study, const data::RunTable& table,
                     const SurrogateOptions& options, const std::vector<FittedSurrogate>& fitted) {
  surrogate::ProcessSet processes;
  for (const std::vector<FittedSurrogate>* items : {&fitted, &options.known})
    for (const FittedSurrogate& item : *items) {
      surrogate::SavedProcess saved{*item.process, std::nullopt, to_text(item.report)};
      if (item.two_level) saved.high = item.two_level->high();
      processes.emplace(surrogate_name(study, item.rows), std::move(saved));
    }
  surrogate::save_processes(path, processes, key_of(study, table, options));
}

SavedSurrogates load_surrogates(const std::string& path, const data::Study& study, const data::RunTable& table,
                                const SurrogateOptions& options) {
  SavedSurrogates result;
  if (!std::filesystem::exists(path)) return result;
  try {
    const surrogate::LoadedProcesses loaded = surrogate::load_processes(path, key_of(study, table, options));
    if (!loaded.processes) return {{}, loaded.reason};
    for (TrainingRows& rows : training_rows(study, table, options.low)) {
      const auto found = loaded.processes->find(surrogate_name(study, rows));
      if (found == loaded.processes->end()) continue;
      const surrogate::SavedProcess& saved = found->second;
      FittedSurrogate item{.rows = std::move(rows),
                           .process = std::make_shared<const surrogate::GaussianProcess>(saved.process),
                           .two_level = {},
                           .report = surrogate_report_from(saved.remarks, path)};
      stretch_rows(item.rows, item.report.stretches);
      if (saved.high) item.two_level = std::make_shared<const surrogate::TwoLevelProcess>(saved.process, *saved.high);
      result.fitted.push_back(std::move(item));
    }
  } catch (const data::InputError& damage) {
    return {{}, fmt::format("it cannot be read ({})", damage.what())};
  }
  return result;
}

}  // namespace uq
