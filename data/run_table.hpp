#pragma once
// The run table: one row per simulated point, whoever simulated it. HDF5 (training.h5, SI with unit attributes) and CSV
// (the study's units). It is all that calibration knows of the DEM.
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "data/finding.hpp"
#include "data/study.hpp"

namespace data {

struct Column {
  std::string name;
  Unit unit;
};

/// Why a row is not learnt from; Because::nothing where it is.
struct LeftOut {
  enum class Because {
    nothing,
    study_says_so,
    its_column_says_so,
    it_failed,
    it_is_a_copy,
    it_is_far_off,
    others_contradict
  };
  Because because = Because::nothing;
  std::string words = {};  ///< "a copy of runs.csv:12"
  explicit operator bool() const { return because != Because::nothing; }
};

/// A run's mean of an output, SI.
struct OutputMean {
  double value = std::numeric_limits<double>::quiet_NaN();
  double standard_error = std::numeric_limits<double>::quiet_NaN();
};

struct RunRow {
  std::string material;                 ///< "" in a study without materials
  std::vector<double> inputs;           ///< SI: parameters, then controls, in the table's column order
  std::vector<double> outputs;          ///< SI; NaN: the run has no such output
  std::vector<double> standard_errors;  ///< SI, of the outputs' means
  std::uint64_t seed = 0;               ///< seed of the run's random streams
  std::string settings;                 ///< hash of every setting that is not an input; "" for another code's runs
  std::string isa;                      ///< instruction set of the program that made it
  std::string origin;                   ///< program and version, or file and line
  double cpu_seconds = 0.0;
  std::string state = {};  ///< "steady", or why the means are not those of the steady flow; "" where nobody said
  /// Outputs whose errors are not known, by name, separated by spaces; NAME:short where the run was only too short.
  std::string unreliable = {};
  std::map<std::string, OutputMean> others = {};  ///< outputs that the study no longer has, by name (RunTable::others)
  std::map<std::string, double> unread =
      {};                  ///< numbers of columns that are neither input nor output, as written; not stored
  std::string place = {};  ///< "runs.csv:31": where the row stands, by which the user names it; not stored
  LeftOut left_out = {};   ///< not stored
};
/// Whether the row says that its means are not those of the steady flow.
bool is_unsteady(const RunRow& row);
/// Whether the row calls the output's mean unreliable, or the run too short to know its error.
bool is_unreliable(const RunRow& row, const std::string& output);

struct RunTable {
  std::vector<Column> parameters;
  std::vector<Column> controls;
  std::vector<Column> outputs;
  std::vector<RunRow> rows;
  std::vector<Column> others = {};  ///< outputs of an earlier form of the study: learnt by nobody, and written back
};

/// Whether the row has no mean of an output and does not call it unreliable, as one that was written before it became
/// an output.
bool lacks_output(const RunTable& table, const RunRow& row);

/// An empty table with the study's columns.
RunTable empty_table(const Study& study);

/// Identity of a row: material, inputs (to 12 digits), seed and settings.
std::string row_key(const RunRow& row);

/// Rows of `first`, then the rows of `second` whose key `first` does not have. Rows of one table are never merged with
/// each other: two with the same point and seed are replicates of a code that writes no seed of its own.
RunTable merge(const RunTable& first, const RunTable& second);

/// The mark after an output's name in RunRow::unreliable which says that its mean is that of the flow, and its error at
/// least what it states.
inline constexpr const char* brief_mark = ":short";

/// Makes the outputs NaN whose means the rows call unreliable. Unless the surrogates estimate what the stated errors
/// lack (`scatter_estimated`), outputs of runs too short to know their errors become NaN, too. Says how many of each.
std::vector<std::string> drop_unreliable(RunTable& table, bool scatter_estimated);

/// Reads .h5 or .csv with the study's columns, in any column order. CSV rows with NaN or an empty cell among the
/// inputs, or in every output, are left out; one that lacks some of the outputs (NaN in the row) is kept. Both are
/// named in `left_out`. Rows that say themselves that they are none keep their place in the table and are marked
/// (RunRow::left_out): what [training] leave_out names, a status column with a word of failure, an output of exactly 0
/// with a standard error of exactly 0 among others that have errors, and copies to the last digit. `findings` says so,
/// and which columns nobody reads. A table of our own that lacks an output of the study has NaN there; outputs that the
/// study has no longer are kept in `others`. Throws InputError: 66 missing file; 65 truncated, missing column, text for
/// a number (file:line).
struct TableRead {
  RunTable table;
  std::vector<std::string> left_out;
  std::vector<Finding> findings = {};
};
TableRead read_table(const std::string& path, const Study& study);

/// Number of rows that are learnt from.
std::size_t used_rows(const RunTable& table);

/// Lines of a written CSV before its first row.
inline constexpr int run_table_head_lines = 4;

/// Writes the table, whole or not at all (temporary file, fsync, rename). Throws InputError (73).
void write_table_hdf5(const std::string& path, const RunTable& table, const Study& study);
void write_table_csv(const std::string& path, const RunTable& table, const Study& study);

}  // namespace data
