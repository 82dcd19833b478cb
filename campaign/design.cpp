#include "campaign/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

#include "campaign/out_files.hpp"
#include "campaign/run_point.hpp"
#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/file_name.hpp"
#include "data/hash.hpp"
#include "surrogate/design.hpp"

namespace campaign {
namespace {

std::string key_of(const Workspace& workspace, const Point& point, const std::string& settings) {
  // Another code's rows have no seed and settings of ours: the point alone tells them apart.
  if (!own_engine(workspace)) return data::row_key({.material = point.material, .inputs = point.inputs});
  return data::row_key(
      {.material = point.material, .inputs = point.inputs, .seed = workspace.study.seed, .settings = settings});
}

std::string point_key(const Workspace& workspace, const Point& point) {
  return key_of(workspace, point, settings_hash(workspace, point.material));
}

/// Whether the run that the row is of would stop where it stopped.
bool cannot_do_better(const Workspace& workspace, const data::RunRow& row) {
  const Point point{row.material, row.inputs};
  return is_done(workspace, point, run_path(workspace, point));
}

constexpr const char* seed_column = "seed";

/// Number of parameters and controls that a material's runs vary.
int varied_inputs(const data::Study& study, const std::string& material) {
  return static_cast<int>(study.parameters.size() - study.material(material).fixed.size() + study.controls.size());
}

std::string made_again(const std::string& path) {
  return fmt::format("correct the line, or remove {}: it is made again",
                     std::filesystem::path(path).filename().string());
}

}  // namespace

std::vector<Point> training_design(const Workspace& workspace, const std::string& material, int first, int runs) {
  const data::Study& study = workspace.study;
  const data::Material& rows = study.material(material);
  const int dimension = varied_inputs(study, material);
  if (dimension == 0) runs = first == 0 ? std::min(runs, 1) : 0;  // one point is all there is
  const std::uint64_t seed = number_from(fmt::format("{} {}", study.seed, material));
  const Eigen::MatrixXd cube =
      dimension > 0 ? surrogate::scrambled_sobol(runs, dimension, seed, first) : Eigen::MatrixXd(runs, 0);
  std::vector<Point> points;
  for (int run = 0; run < runs; ++run) {
    Point point{material, {}};
    int column = 0;
    for (const data::Parameter& p : study.parameters) {
      const auto fixed = rows.fixed.find(p.name);
      point.inputs.push_back(fixed != rows.fixed.end()
                                 ? fixed->second
                                 : p.unit.rounded(p.axis().from_unit(cube(run, column++)), point_digits));
    }
    for (const data::Control& c : study.controls)
      point.inputs.push_back(c.unit.rounded(c.axis().from_unit(cube(run, column++)), point_digits));
    points.push_back(std::move(point));
  }
  return points;
}

Campaign plan_campaign(const Workspace& workspace, const data::RunTable& table, int runs) {
  std::set<std::string> known;
  const bool simulated = own_engine(workspace);
  std::map<std::string, int> rows_of;
  std::vector<Point> lacking;  // points whose rows lack an output that the study has by now
  for (const data::RunRow& row : table.rows) {
    if (simulated && !row.settings.empty() && row.seed == workspace.study.seed && data::lacks_output(table, row)) {
      lacking.push_back({row.material, row.inputs});
      continue;
    }
    if (!data::is_unsteady(row) || workspace.unsteady == Unsteady::use || cannot_do_better(workspace, row))
      known.insert(simulated ? data::row_key(row) : data::row_key({.material = row.material, .inputs = row.inputs}));
    ++rows_of[row.material];
  }
  Campaign campaign;
  const auto add_missing = [&](const std::vector<Point>& points) {
    for (const Point& point : points)
      if (known.insert(point_key(workspace, point)).second) campaign.points.push_back(point);
  };
  std::map<std::string, int> next;
  std::size_t left = 0;  // of the points, those that the list had
  if (simulated) {
    const std::vector<Point> listed = read_design(workspace);
    add_missing(listed);
    left = campaign.points.size();
    add_missing(lacking);
    campaign.continues = !listed.empty();  // also where all of them were made, and only their end was not written
    for (const data::Material& material : workspace.study.materials) {
      next[material.name] = material.runs.value_or(workspace.study.training.runs);
      add_missing(training_design(workspace, material.name, 0, next[material.name]));
    }
  } else {
    // Another code's design is not ours to complete: further points, past as many of the sequence as there are rows.
    constexpr int usual = 16;
    if (runs == 0) runs = usual;
    for (const data::Material& material : workspace.study.materials) next[material.name] = rows_of[material.name];
  }
  // Further points go to the materials in turn, each continuing its own sequence past what is known already.
  std::vector<std::string> varied;
  for (const data::Material& material : workspace.study.materials)
    if (varied_inputs(workspace.study, material.name) > 0) varied.push_back(material.name);
  const bool further = !campaign.continues && !varied.empty();
  for (std::size_t turn = 0; further && static_cast<int>(campaign.points.size()) < runs; ++turn) {
    const std::string& material = varied[turn % varied.size()];
    for (std::size_t before = campaign.points.size(); campaign.points.size() == before;)
      add_missing(training_design(workspace, material, next[material]++, 1));
  }
  if (runs > 0 && static_cast<int>(campaign.points.size()) > runs) {
    const auto most = static_cast<std::size_t>(runs);
    if (left > most) campaign.later.assign(campaign.points.begin() + runs, campaign.points.begin() + left);
    campaign.points.resize(most);
  }
  return campaign;
}

std::vector<Point> Campaign::listed(std::vector<Point> now) const {
  now.insert(now.end(), later.begin(), later.end());
  return now;
}

std::vector<Point> read_design(const Workspace& workspace) {
  const std::string path = design_path(workspace);
  if (!std::filesystem::exists(path)) return {};
  return read_points(workspace, path);
}

namespace {

/// The material that a list names; the study's first where the list has no such column or leaves it empty.
std::string listed_material(const data::Study& study, const data::Csv& csv, const data::CsvRow& row,
                            const std::string& path) {
  const std::optional<std::size_t> column = csv.find("material");
  if (!column || row.fields[*column].empty()) return study.materials.front().name;
  const std::string& name = row.fields[*column];
  std::vector<std::string> known;
  for (const data::Material& material : study.materials) {
    if (material.name == name) return name;
    known.push_back(material.name);
  }
  throw data::InputError(
      data::ExitStatus::bad_data,
      {csv.place(row, *column), fmt::format("the study has no material '{}' (it has {})", name, fmt::join(known, ", ")),
       fmt::format("give the material that name again, {}", made_again(path))});
}

}  // namespace

std::vector<Point> read_points(const Workspace& workspace, const std::string& path) {
  const data::Study& study = workspace.study;
  const data::Csv csv = data::read_csv(path);
  std::vector<Point> points;
  for (const data::CsvRow& row : csv.rows) {
    Point point{listed_material(study, csv, row, path), {}};
    const auto read = [&](const std::string& name, const data::Unit& unit) {
      const std::size_t column = csv.column(name);
      if (!std::isfinite(csv.number(row, column)))
        throw data::InputError(
            data::ExitStatus::bad_data,
            {csv.place(row, column), fmt::format("'{}' is not a value", row.fields[column]), made_again(path)});
      point.inputs.push_back(csv.unit(column, unit).to_si(row.fields[column]));
    };
    for (const data::Parameter& p : study.parameters) read(p.name, p.unit);
    for (const data::Control& c : study.controls) read(c.name, c.unit);
    points.push_back(std::move(point));
  }
  return points;
}

void write_design(const Workspace& workspace, const std::vector<Point>& points) {
  write_points(workspace, design_path(workspace), points);
}

Campaign plan_at_posterior(const Workspace& workspace, const data::RunTable& table, int runs) {
  const std::string path = next_runs_path(workspace);
  if (!std::filesystem::exists(path))
    throw data::InputError(data::ExitStatus::missing_input,
                           {path, "is not there: nothing is known of a posterior yet", "run demcal calibrate first"});
  std::set<std::string> known;
  for (const data::RunRow& row : table.rows) known.insert(data::row_key(row));
  const std::vector<Point> listed = read_points(workspace, path), left = read_design(workspace);
  const auto is_in = [&](const std::vector<Point>& points, const Point& point) {
    return std::any_of(points.begin(), points.end(),
                       [&](const Point& one) { return point_key(workspace, one) == point_key(workspace, point); });
  };
  // Points of the list that an interrupted call left are done first, and then no further points.
  std::vector<Point> unfinished;
  for (const Point& point : left)
    if (is_in(listed, point)) unfinished.push_back(point);
  Campaign campaign;
  campaign.continues = !unfinished.empty();
  for (const Point& point : campaign.continues ? unfinished : listed)
    if (static_cast<int>(campaign.points.size()) < runs && known.insert(point_key(workspace, point)).second)
      campaign.points.push_back(point);
  for (const Point& point : left)
    if (known.insert(point_key(workspace, point)).second) campaign.later.push_back(point);
  return campaign;
}

void write_points(const Workspace& workspace, const std::string& path, const std::vector<Point>& points,
                  const std::vector<PointColumn>& more, const std::string& head) {
  const data::Study& study = workspace.study;
  const bool has_materials = study.materials.size() > 1 || !study.materials.front().name.empty();
  std::vector<std::string> fields, units;
  if (has_materials) fields.push_back("material");
  const auto add = [&](const std::string& name, const data::Unit& unit) {
    fields.push_back(name);
    units.push_back(data::with_unit(name, unit));
  };
  for (const data::Parameter& p : study.parameters) add(p.name, p.unit);
  for (const data::Control& c : study.controls) add(c.name, c.unit);
  for (const PointColumn& one : more) fields.push_back(one.name);
  for (std::string& field : fields) field = data::csv_field(field);
  std::string text = head + fmt::format("# units: {}\n{}\n", fmt::join(units, ", "), fmt::join(fields, ","));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    fields.clear();
    if (has_materials) fields.push_back(data::csv_field(point.material));
    std::size_t column = 0;
    for (const data::Parameter& p : study.parameters) fields.push_back(p.unit.digits(point.inputs[column++]));
    for (const data::Control& c : study.controls) fields.push_back(c.unit.digits(point.inputs[column++]));
    for (const PointColumn& one : more) fields.push_back(data::csv_field(one.values[i]));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  data::write_atomically(path, text);
}

std::vector<Point> points_of(const std::vector<PlannedRun>& runs) {
  std::vector<Point> points;
  for (const PlannedRun& run : runs) points.push_back(run.point);
  return points;
}

PointColumn seeds_of(const std::vector<PlannedRun>& runs) {
  PointColumn seeds{seed_column, {}};
  for (const PlannedRun& run : runs) seeds.values.push_back(std::to_string(run.seed));
  return seeds;
}

std::vector<PlannedRun> read_runs(const Workspace& workspace, const std::string& path) {
  const std::vector<Point> points = read_points(workspace, path);
  const data::Csv csv = data::read_csv(path);
  const std::size_t column = csv.column(seed_column);
  std::vector<PlannedRun> runs;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string& text = csv.rows[i].fields[column];
    PlannedRun run{points[i]};
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), run.seed);
    if (error != std::errc{} || rest != text.data() + text.size())
      throw data::InputError(data::ExitStatus::bad_data,
                             {csv.place(csv.rows[i], column), fmt::format("'{}' is no seed", text), made_again(path)});
    runs.push_back(std::move(run));
  }
  return runs;
}

std::string run_name(const Workspace& workspace, const Point& point) {
  const std::string key = key_of(workspace, point, course_hash(workspace, point.material));
  return (point.material.empty() ? "run" : data::file_name(point.material)) + "-" + data::hash_text(key).substr(0, 12);
}

std::string run_path(const Workspace& workspace, const Point& point) {
  return (std::filesystem::path(workspace.out) / "runs" / (run_name(workspace, point) + ".h5")).string();
}

}  // namespace campaign
