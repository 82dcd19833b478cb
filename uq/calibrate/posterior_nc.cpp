#include "uq/calibrate/posterior_nc.hpp"

#include <fmt/core.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/error.hpp"
#include "data/provenance.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {
namespace {

void check(int status, const std::string& what) {
  if (status == NC_NOERR) return;
  throw data::InputError(
      data::ExitStatus::cannot_write,
      {what, fmt::format("cannot be written: {}", nc_strerror(status)), "check the folder and the space left"});
}

/// A file that is made in memory, and written when it is whole: netCDF may crash where a disk refuses what it closes.
class File {
 public:
  File() { check(nc_create_mem("posterior", NC_NETCDF4, 0, &id_), "a posterior in memory"); }
  ~File() {
    if (open_) nc_close(id_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int id() const { return id_; }
  void write(const std::string& path) {
    open_ = false;
    NC_memio whole{};
    check(nc_close_memio(id_, &whole), path);
    const std::unique_ptr<void, decltype(&std::free)> memory(whole.memory, &std::free);
    data::write_bytes(path, {static_cast<const char*>(whole.memory), whole.size});
  }

 private:
  int id_ = -1;
  bool open_ = true;
};

/// A group with its dimensions.
class Group {
 public:
  Group(const File& file, const std::string& name) {
    check(nc_def_grp(file.id(), name.c_str(), &id_), name);
    attribute(NC_GLOBAL, "created_at", data::utc_now());
    attribute(NC_GLOBAL, "inference_library", "demcal");
    attribute(NC_GLOBAL, "inference_library_version", data::program_version());
  }

  void attribute(int variable, const std::string& name, const std::string& text) {
    check(nc_put_att_text(id_, variable, name.c_str(), text.size(), text.c_str()), name);
  }

  /// A dimension with its coordinate 0, 1, 2, ...
  void index_dimension(const std::string& name, std::size_t size) {
    int dimension = -1, variable = -1;
    check(nc_def_dim(id_, name.c_str(), size, &dimension), name);
    dimensions_[name] = dimension;
    check(nc_def_var(id_, name.c_str(), NC_INT64, 1, &dimension, &variable), name);
    std::vector<long long> values(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<long long>(i);
    check(nc_put_var_longlong(id_, variable, values.data()), name);
  }

  /// Values in row-major order over `dimensions`.
  int doubles(const std::string& name, const std::vector<std::string>& dimensions, const std::vector<double>& values,
              const std::string& unit) {
    const int variable = define(name, NC_DOUBLE, dimensions);
    if (!unit.empty()) attribute(variable, "units", unit);
    for (const auto& dimension : dimensions)
      if (const auto found = coordinates_.find(dimension); found != coordinates_.end())
        attribute(variable, "coordinates", found->second);
    check(nc_put_var_double(id_, variable, values.data()), name);
    return variable;
  }

  void integers(const std::string& name, const std::vector<std::string>& dimensions, const std::vector<int>& values) {
    check(nc_put_var_int(id_, define(name, NC_INT, dimensions), values.data()), name);
  }

  /// True and false, as xarray stores them.
  void flags(const std::string& name, const std::vector<std::string>& dimensions,
             const std::vector<signed char>& values) {
    const int variable = define(name, NC_BYTE, dimensions);
    attribute(variable, "dtype", "bool");
    check(nc_put_var_schar(id_, variable, values.data()), name);
  }

  /// Variables made from now on over `dimension` name these as its coordinates.
  void set_coordinates(const std::string& dimension, const std::string& names) { coordinates_[dimension] = names; }

 private:
  int define(const std::string& name, nc_type type, const std::vector<std::string>& dimensions) {
    std::vector<int> ids;
    for (const auto& dimension : dimensions) ids.push_back(dimensions_.at(dimension));
    int variable = -1;
    check(nc_def_var(id_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &variable), name);
    if (type == NC_DOUBLE && ids.size() > 1) check(nc_def_var_deflate(id_, variable, 1, 1, 1), name);
    return variable;
  }

  int id_ = -1;
  std::map<std::string, std::string> coordinates_;  // names of the variables that go with a dimension (CF conventions)
  std::map<std::string, int> dimensions_;
};

/// The rows of one observation set and output.
struct Block {
  std::string name, dimension;
  std::size_t set = 0, output = 0;
  std::vector<Eigen::Index> rows;   // of the model
  std::vector<std::size_t> points;  // of the set, by row
};

std::vector<Block> blocks_of(const data::Study& study, const CaseModel& model) {
  const std::vector<RowOrigin> from = origins(model);
  std::vector<Block> blocks;
  for (std::size_t row = 0; row < from.size(); ++row) {
    auto found = std::find_if(blocks.begin(), blocks.end(), [&](const Block& block) {
      return block.set == from[row].set && block.output == from[row].output;
    });
    if (found == blocks.end()) {
      const std::string& set = study.observations[from[row].set].name;
      blocks.push_back({.name = set + "_" + study.outputs[from[row].output].name,
                        .dimension = set + "_point",
                        .set = from[row].set,
                        .output = from[row].output,
                        .rows = {},
                        .points = {}});
      found = blocks.end() - 1;
    }
    found->rows.push_back(static_cast<Eigen::Index>(row));
    found->points.push_back(from[row].point);
  }
  for (Block& block : blocks)  // one dimension for all outputs of a set, but of those that some points lack
    if (block.points.size() < study.observations[block.set].points.size()) block.dimension = block.name + "_point";
  return blocks;
}

/// Point dimensions of all blocks with their controls as coordinates.
void point_dimensions(Group& group, const data::Study& study, const std::vector<Block>& blocks) {
  std::vector<std::string> done;
  for (const auto& block : blocks) {
    if (std::find(done.begin(), done.end(), block.dimension) != done.end()) continue;
    done.push_back(block.dimension);
    const data::ObservationSet& set = study.observations[block.set];
    group.index_dimension(block.dimension, block.points.size());
    const std::string owner = block.dimension.substr(0, block.dimension.rfind("_point"));
    std::string names;
    for (std::size_t c = 0; c < study.controls.size(); ++c) {
      const data::Control& control = study.controls[c];
      const std::string name = owner + "_" + control.name;
      std::vector<double> values;
      for (const std::size_t point : block.points)
        values.push_back(control.unit.from_si(set.points[point].controls[c]));
      group.doubles(name, {block.dimension}, values, control.unit.symbol);
      names += (names.empty() ? "" : " ") + name;
    }
    if (!names.empty()) group.set_coordinates(block.dimension, names);
  }
}

void chain_dimensions(Group& group, const Draws& draws) {
  group.index_dimension("chain", draws.chains.size());
  group.index_dimension("draw", static_cast<std::size_t>(draws.chains.front().x.rows()));
}

/// "zirconia-800: friction" is no name of a variable.
std::string variable_name(const Unknown& unknown) {
  std::string name = unknown.label;
  if (const auto colon = name.find(": "); colon != std::string::npos) name.replace(colon, 2, "__");
  return name;
}

void write_unknowns(const File& file, const SampledCase& sampled) {
  Group group(file, "posterior");
  chain_dimensions(group, sampled.draws);
  for (int k = 0; k < sampled.model->dimension(); ++k) {
    const Unknown& unknown = sampled.model->unknowns[k];
    const data::Parameter& parameter = unknown.prior.parameter();
    std::vector<double> values;
    for (const auto& chain : sampled.draws.chains)
      for (const double u : chain.x.col(k)) values.push_back(in_study_unit(parameter, u));
    group.doubles(variable_name(unknown), {"chain", "draw"}, values, parameter.unit.symbol);
  }
}

void write_statistics(const File& file, const Draws& draws) {
  Group group(file, "sample_stats");
  chain_dimensions(group, draws);
  group.attribute(NC_GLOBAL, "sampler", draws.sampler);
  std::vector<double> lp, acceptance, energy;
  std::vector<int> depth;
  std::vector<signed char> diverging;
  for (const auto& chain : draws.chains) {
    lp.insert(lp.end(), chain.log_density.begin(), chain.log_density.end());
    acceptance.insert(acceptance.end(), chain.acceptance.begin(), chain.acceptance.end());
    energy.insert(energy.end(), chain.energy.begin(), chain.energy.end());
    depth.insert(depth.end(), chain.tree_depth.begin(), chain.tree_depth.end());
    for (const bool diverged : chain.diverged) diverging.push_back(diverged ? 1 : 0);
  }
  group.doubles("lp", {"chain", "draw"}, lp, "");
  group.doubles("acceptance_rate", {"chain", "draw"}, acceptance, "");
  if (energy.size() == lp.size()) group.doubles("energy", {"chain", "draw"}, energy, "");
  if (depth.size() == lp.size()) group.integers("tree_depth", {"chain", "draw"}, depth);
  if (diverging.size() == lp.size()) group.flags("diverging", {"chain", "draw"}, diverging);
}

/// A variable (chain, draw, point) per block from rows of `values` (draws x model rows) in SI, shown in the unit that
/// `unit_of` names.
template <class UnitOf>
void write_blocks(Group& group, const std::vector<Block>& blocks, const Eigen::MatrixXd& values,
                  const UnitOf& unit_of) {
  for (const auto& block : blocks) {
    const data::Unit unit = unit_of(block);
    std::vector<double> flat;
    flat.reserve(static_cast<std::size_t>(values.rows()) * block.rows.size());
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      for (const Eigen::Index row : block.rows) flat.push_back(unit.from_si(values(i, row)));
    group.doubles(block.name, {"chain", "draw", block.dimension}, flat, unit.symbol);
  }
}

void write_file(const std::string& path, const data::Study& study, const SampledCase& sampled, std::uint64_t seed) {
  const CaseModel& model = *sampled.model;
  const std::vector<Block> blocks = blocks_of(study, model);
  const Eigen::MatrixXd draws = sampled.draws.pooled();
  File file;
  const std::string title = fmt::format("posterior of case {} of study {}", model.name, study.name);
  check(nc_put_att_text(file.id(), NC_GLOBAL, "title", title.size(), title.c_str()), path);
  write_unknowns(file, sampled);
  write_statistics(file, sampled.draws);
  {
    Group group(file, "posterior_predictive");
    chain_dimensions(group, sampled.draws);
    point_dimensions(group, study, blocks);
    write_blocks(group, blocks, replicates(model, draws, seed),
                 [&](const Block& block) { return study.outputs[block.output].unit; });
  }
  {
    Group group(file, "log_likelihood");
    chain_dimensions(group, sampled.draws);
    point_dimensions(group, study, blocks);
    write_blocks(group, blocks, pointwise_log_likelihoods(model, draws), [](const Block&) { return data::Unit{}; });
  }
  const Eigen::VectorXd y = observed(model), variance = observed_variance(model);
  Group measured(file, "observed_data"), constant(file, "constant_data");
  point_dimensions(measured, study, blocks);
  point_dimensions(constant, study, blocks);
  for (const auto& block : blocks) {
    const data::Unit& unit = study.outputs[block.output].unit;
    std::vector<double> values, errors;
    for (const Eigen::Index row : block.rows) {
      values.push_back(unit.from_si(y[row]));
      errors.push_back(std::sqrt(variance[row]) / unit.factor);
    }
    measured.doubles(block.name, {block.dimension}, values, unit.symbol);
    constant.doubles(block.name + "_se", {block.dimension}, errors, unit.symbol);
  }
  file.write(path);
}

}  // namespace

void write_posterior(const std::string& path, const data::Study& study, const SampledCase& sampled,
                     std::uint64_t seed) {
  data::write_atomically(path, [&](const std::string& temporary) { write_file(temporary, study, sampled, seed); });
}

std::string draws_csv(const SampledCase& sampled) {
  std::string units = "# units:", head = "chain,draw", rows;
  for (const Unknown& unknown : sampled.model->unknowns) {
    units += head == "chain,draw" ? " " : ", ";
    units += data::with_unit(variable_name(unknown), unknown.prior.parameter().unit);
    head += fmt::format(",{}", data::csv_field(variable_name(unknown)));
  }
  for (std::size_t c = 0; c < sampled.draws.chains.size(); ++c) {
    const auto& chain = sampled.draws.chains[c];
    for (Eigen::Index i = 0; i < chain.x.rows(); ++i) {
      rows += fmt::format("{},{}", c, i);
      for (int k = 0; k < sampled.model->dimension(); ++k) {
        const Unknown& unknown = sampled.model->unknowns[k];
        rows += fmt::format(",{:.10g}", in_study_unit(unknown.prior.parameter(), chain.x(i, k)));
      }
      rows += fmt::format(",{:.10g}\n", chain.log_density[i]);
    }
  }
  return units + "\n" + head + ",lp\n" + rows;
}

}  // namespace uq
